// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/oscillator.hpp"

#include <fmt/format.h>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace nysalt {

detail::bernstein_polynomial detail::half_trace(const nysalt::word& word,
                                                const std::vector<double>& coefficients, double theta,
                                                double low, double high) {
  const auto times_k = [](const detail::bernstein_polynomial& x) { return x.times_x(); };
  const detail::bernstein_polynomial one(low, high, 1.0);
  const detail::bernstein_polynomial zero(low, high, 0.0);
  return detail::oscillator_matrix(word, coefficients, theta, zero, one, times_k).half_trace();
}

namespace {

/// A and B + C of a step.
struct turn_of_step {
  double half_trace;
  double defect;

  turn_of_step(const nysalt::word& word, const std::vector<double>& coefficients, double z) {
    const auto m = detail::matrix_on_oscillator(word, coefficients, z * z);
    half_trace = m.half_trace();
    defect = m.qp * z + m.pq / z;
  }
  /// 1 - A^2, of which the sign says whether the step turns.
  double rotation() const { return (1.0 - half_trace) * (1.0 + half_trace); }
};

turn_of_step turn_of_plain(const nysalt::word& word, const std::vector<double>& coefficients, double z) {
  if (word.rotates() || word.is_processed() || word.stochastic_letters > 0) {
    throw std::invalid_argument(fmt::format(
        "energy_error_on_oscillator: the word must have no rotation, no letter O and no processor, got {}",
        word.letters()));
  }
  word.require_one_for_each_slot(coefficients);
  return {word, coefficients, z};
}

}  // namespace

namespace detail {

/// The matrix of a word is affine in each coefficient, so that a difference over a step of 1 is the
/// derivative.
energy_defect energy_defect_on_oscillator(const nysalt::word& word, const std::vector<double>& coefficients,
                                          double z) {
  const turn_of_step turn = turn_of_plain(word, coefficients, z);
  energy_defect result{std::numeric_limits<double>::infinity(),
                       Eigen::VectorXd::Zero(std::ssize(coefficients))};
  const double rotation = turn.rotation();
  if (!(rotation > 0.0)) return result;
  const double factor = 1.0 / (std::numbers::sqrt2 * std::sqrt(rotation));
  result.value = factor * turn.defect;
  auto changed = coefficients;
  for (std::size_t i = 0; i < changed.size(); ++i) {
    changed[i] += 1.0;
    const turn_of_step other(word, changed, z);
    changed[i] = coefficients[i];
    const double by_trace = turn.defect * turn.half_trace * (other.half_trace - turn.half_trace) / rotation;
    result.slopes[static_cast<Eigen::Index>(i)] = factor * (other.defect - turn.defect + by_trace);
  }
  return result;
}

}  // namespace detail

double detail::energy_error_on_oscillator(const nysalt::word& word, const std::vector<double>& coefficients,
                                          double z) {
  const turn_of_step turn = turn_of_plain(word, coefficients, z);
  const double rotation = turn.rotation();
  if (!(rotation > 0.0)) return std::numeric_limits<double>::infinity();
  return 0.5 * turn.defect * turn.defect / rotation;
}

std::optional<detail::resonance> detail::near_resonance(const nysalt::word& word,
                                                        const std::vector<double>& coefficients,
                                                        const std::vector<frequency_band>& bands,
                                                        double step) {
  if (word.rotates()) return std::nullopt;
  constexpr int samples = 16;
  for (const auto& band : bands) {
    if (!(band.low > 0.0)) continue;
    for (int i = 0; i <= samples; ++i) {
      const double z = step * (band.low + (band.high - band.low) * i / samples);
      const double half_turns = std::max(1.0, std::round(z / std::numbers::pi));
      const double width = detail::resonance_distance * half_turns * std::numbers::pi;
      if (!(std::abs(z - half_turns * std::numbers::pi) < width)) continue;
      const double trace = std::abs(detail::matrix_on_oscillator(word, coefficients, z * z).half_trace());
      if (trace > std::cos(std::min(width, 0.5 * std::numbers::pi))) {
        return detail::resonance{band, static_cast<int>(half_turns)};
      }
    }
  }
  return std::nullopt;
}

std::string detail::in_words(const detail::resonance& near) {
  return fmt::format(
      "a step turns oscillations of the frequencies {:.4g} to {:.4g} by {}pi, to within {:g} %: in runs of "
      "more "
      "than {} steps energies may drift; take another step for these",
      near.band.low, near.band.high, near.half_turns == 1 ? "" : fmt::format("{} ", near.half_turns),
      100.0 * detail::resonance_distance, detail::long_run);
}

double detail::growth_of_pair(const nysalt::word& word, const std::vector<double>& coefficients,
                              const Eigen::Array2d& theta, const Eigen::Matrix2d& k) {
  const auto times_k = [&](const Eigen::Array2d& x) -> Eigen::Array2d { return (k * x.matrix()).array(); };
  Eigen::Matrix4d step;
  for (Eigen::Index j = 0; j < 4; ++j) {
    Eigen::Array2d q = Eigen::Array2d::Zero();
    Eigen::Array2d p = Eigen::Array2d::Zero();
    (j < 2 ? q : p)[j % 2] = 1.0;
    detail::step_on_oscillator(word, coefficients, theta, times_k, q, p);
    step.col(j) << q, p;
  }
  if (!step.allFinite()) return std::numeric_limits<double>::infinity();
  const double a = step.trace();
  const double b = 0.5 * (a * a - (step * step).trace());
  const std::complex<double> root = std::sqrt(std::complex<double>(0.25 * a * a - b + 2.0));
  double growth = 0.0;
  for (const double sign : {1.0, -1.0}) {
    const std::complex<double> half = 0.5 * (0.5 * a + sign * root);  // of y
    const std::complex<double> lambda = half + std::sqrt(half * half - 1.0);
    growth = std::max(growth, std::abs(std::log(std::abs(lambda))));
  }
  return growth;
}

namespace {

/// Largest singular value. Of two rows the square of the Frobenius norm and the determinant give both.
template <class Matrix>
double spectral_norm(const Matrix& m) {
  if (m.rows() == 2) {
    const double a = m(0, 0), b = m(0, 1), c = m(1, 0), d = m(1, 1);
    const double squares = a * a + b * b + c * c + d * d;
    const double twice = 2.0 * std::abs(a * d - b * c);
    return 0.5 * (std::sqrt(squares + twice) + std::sqrt(std::max(0.0, squares - twice)));
  }
  const Eigen::MatrixXd square = m.transpose() * m;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(square, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

}  // namespace

double detail::transient_growth(const nysalt::word& word, const std::vector<double>& coefficients,
                                double theta, double k, std::int64_t steps) {
  const auto m = detail::matrix_on_oscillator(word, coefficients, k, theta);
  // M - trace/2 = (a, b; c, -a) in (omega q, p); its determinant is sin^2 t.
  const double omega = std::sqrt(theta * theta + k);
  const double sign = m.qq + m.pp < 0.0 ? -1.0 : 1.0;
  const double a = sign * 0.5 * (m.qq - m.pp);
  const double b = sign * omega * m.qp;
  const double c = sign * m.pq / omega;
  const double square = -a * a - b * c;
  const double sine = std::sqrt(std::abs(square));

  const auto n = static_cast<double>(steps);
  double cosine = 1.0;  // of n t
  double ratio = n;     // sin(n t)/sin t
  if (sine > std::numeric_limits<double>::min() && square > 0.0) {
    const double angle = std::min(n * std::asin(std::min(sine, 1.0)), 0.5 * std::numbers::pi);
    cosine = std::cos(angle);
    ratio = std::sin(angle) / sine;
  } else if (sine > std::numeric_limits<double>::min()) {
    const double angle = n * std::asinh(sine);
    cosine = std::cosh(angle);
    ratio = std::sinh(angle) / sine;
  }
  const double last =
      spectral_norm(Eigen::Matrix2d{{cosine + ratio * a, ratio * b}, {ratio * c, cosine - ratio * a}});
  return last < 1.0 ? 1.0 : last;
}

namespace {

using complex = std::complex<double>;

struct signed_phase {
  double phase;
  bool is_positive;
};

/// i X^* Omega X, which is Hermitian.
Eigen::MatrixXcd krein_form(const Eigen::MatrixXcd& vectors) {
  const Eigen::Index n = vectors.rows() / 2;
  Eigen::MatrixXcd turned(vectors.rows(), vectors.cols());
  turned.topRows(n) = vectors.bottomRows(n);
  turned.bottomRows(n) = -vectors.topRows(n);
  return complex(0.0, 1.0) * (vectors.adjoint() * turned);
}

double distance(double a, double b) {
  const double apart = std::abs(a - b);
  return std::min(apart, 2.0 * std::numbers::pi - apart);
}

}  // namespace

detail::symplectic_spectrum detail::spectrum_of(const Eigen::MatrixXd& step) {
  if (step.rows() != step.cols() || step.rows() % 2 != 0) {
    throw std::invalid_argument(
        fmt::format("spectrum_of: the matrix must be square with an even number of rows, "
                    "got {} rows and {} columns",
                    step.rows(), step.cols()));
  }
  detail::symplectic_spectrum result;
  if (step.rows() == 0) return result;
  if (!step.allFinite()) {
    result.growth = std::numeric_limits<double>::infinity();
    result.krein_distance = 0.0;
    return result;
  }
  const Eigen::EigenSolver<Eigen::MatrixXd> solver(step);
  const Eigen::VectorXcd& values = solver.eigenvalues();
  const Eigen::MatrixXcd vectors = solver.eigenvectors();
  double of_farthest = 0.0;
  for (const complex& value : values) {
    const double growth = std::abs(std::log(std::abs(value)));
    if (!(growth > result.growth)) continue;
    result.growth = growth;
    of_farthest = std::arg(value);
  }
  if (!result.is_on_circle()) {
    result.krein_distance = 0.0;
    result.first = of_farthest;
    result.second = of_farthest;
    return result;
  }
  constexpr double same = detail::symplectic_spectrum::rounding;
  std::vector<signed_phase> all;
  std::vector<bool> is_done(static_cast<std::size_t>(values.size()), false);
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (is_done[static_cast<std::size_t>(i)]) continue;
    std::vector<Eigen::Index> cluster;
    for (Eigen::Index j = i; j < values.size(); ++j) {
      if (std::abs(values[j] - values[i]) > same) continue;
      cluster.push_back(j);
      is_done[static_cast<std::size_t>(j)] = true;
    }
    Eigen::MatrixXcd space(values.size(), std::ssize(cluster));
    for (std::size_t k = 0; k < cluster.size(); ++k)
      space.col(static_cast<Eigen::Index>(k)) = vectors.col(cluster[k]);
    const Eigen::HouseholderQR<Eigen::MatrixXcd> basis(space);
    space = basis.householderQ() * Eigen::MatrixXcd::Identity(space.rows(), space.cols());
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXcd> form(krein_form(space), Eigen::EigenvaluesOnly);
    const double phase = std::arg(values[i]);
    for (const double sign : form.eigenvalues()) all.push_back({phase, sign > 0.0});
  }
  for (const auto& one : all) {
    for (const auto& other : all) {
      if (!one.is_positive || other.is_positive) continue;
      const double apart = distance(one.phase, other.phase);
      if (apart > result.krein_distance) continue;
      result.krein_distance = apart;
      result.first = one.phase;
      result.second = other.phase;
    }
  }
  return result;
}

double detail::largest_power(const Eigen::MatrixXd& step, std::int64_t steps) {
  constexpr double without_bound = 1e6;
  double largest = 1.0;
  Eigen::MatrixXd power = step;
  for (std::int64_t n = 1; n <= steps; n *= 2) {
    const double norm = power.allFinite() ? spectral_norm(power) : std::numeric_limits<double>::infinity();
    if (!(norm < without_bound)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, norm);
    power = (power * power).eval();
  }
  return largest;
}

}  // namespace nysalt
