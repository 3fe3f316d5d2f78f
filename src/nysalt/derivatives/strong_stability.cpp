// SPDX-License-Identifier: BSL-1.0
#include "nysalt/derivatives/strong_stability.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <vector>

#include "nysalt/detail/sentence.hpp"

namespace nysalt {

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

/// Largest singular value.
double spectral_norm(const Eigen::MatrixXd& m) {
  const Eigen::MatrixXd square = m.transpose() * m;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(square, Eigen::EigenvaluesOnly);
  return std::sqrt(std::max(0.0, solver.eigenvalues().maxCoeff()));
}

}  // namespace

symplectic_spectrum spectrum_of(const Eigen::MatrixXd& step) {
  if (step.rows() != step.cols() || step.rows() % 2 != 0) {
    throw std::invalid_argument(
        sentence("spectrum_of: the matrix must be square with an even number of rows, "
                 "got {} rows and {} columns",
                 step.rows(), step.cols()));
  }
  symplectic_spectrum result;
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
  constexpr double same = symplectic_spectrum::rounding;
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

double largest_power(const Eigen::MatrixXd& step, std::int64_t steps) {
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
