// SPDX-License-Identifier: BSL-1.0
// The equations of phase fitting, and their solution.

#include "nysalt/methods/phase_fitted.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <stdexcept>

#include "nysalt/core/sentence.hpp"
#include "nysalt/derivatives/oscillator.hpp"
#include "nysalt/scalars/polynomial.hpp"

namespace nysalt::detail {

namespace {

/// sum_j (-x)^j/(2j + k)!, Stumpff's function c_k: what cos z and sin z/z, z^2 = x, are beyond their first
/// terms.
double stumpff(int k, double x) {
  double term = 1.0;
  for (int i = 2; i <= k; ++i) term /= i;
  double sum = 0.0;
  for (int j = 0; sum + term != sum; ++j) {
    sum += term;
    term *= -x / ((2.0 * j + k + 1.0) * (2.0 * j + k + 2.0));
  }
  return sum;
}

using polynomials = oscillator_matrix<dense_polynomial>;

polynomials matrix_of(const word& letters, const std::vector<double>& coefficients) {
  const auto times_x = [](const dense_polynomial& a) { return a.times_x(); };
  return {letters, coefficients, 0.0, {{0.0}}, {{1.0}}, times_x};
}

Eigen::VectorXd defects_at(const polynomials& m, bool symmetric, double x) {
  Eigen::VectorXd defects(symmetric ? 3 : 4);
  defects[0] = m.half_trace().tail(2, x) - stumpff(4, x);
  defects[1] = m.qp.tail(1, x) + stumpff(3, x);
  defects[2] = m.pq.tail(2, x) - stumpff(3, x);
  if (!symmetric) {
    dense_polynomial half_difference = 0.5 * m.qq;
    half_difference += -0.5 * m.pp;
    defects[3] = half_difference.tail(1, x);
  }
  return defects;
}

}  // namespace

std::vector<rotation_defects> defects_of_rotation(const family& family, const Eigen::VectorXd& theta,
                                                  const std::vector<double>& all_x) {
  auto coefficients = family.coefficients(theta);
  const polynomials here = matrix_of(family.letters, coefficients);
  std::vector<polynomials> beside;
  for (double& c : coefficients) {
    const double before = c;
    c = before + 1.0;
    beside.push_back(matrix_of(family.letters, coefficients));
    c = before;
  }
  const Eigen::MatrixXd slopes = family.jacobian(theta);
  std::vector<rotation_defects> all;
  for (const double x : all_x) {
    const Eigen::VectorXd values = defects_at(here, family.symmetric, x);
    Eigen::MatrixXd by_coefficient(values.size(), std::ssize(beside));
    for (std::size_t i = 0; i < beside.size(); ++i) {
      by_coefficient.col(static_cast<Eigen::Index>(i)) = defects_at(beside[i], family.symmetric, x) - values;
    }
    all.push_back({values, by_coefficient * slopes});
  }
  return all;
}

namespace {

/// The solution nearest to `nearest`, from a guess close to it: each iteration solves the linearised
/// equations with the least distance. Nothing where that does not converge.
std::optional<Eigen::VectorXd> nearest_phase_fitted(const family& family, const Eigen::VectorXd& nearest,
                                                    Eigen::VectorXd theta, double x) {
  constexpr int most = 100;
  constexpr double small = 1e-10;     // from here on a change that no longer falls is rounding
  constexpr double solved = 1e-10;    // else it is the least of the defects, and not zero
  constexpr double redundant = 1e-9;  // pivots of the equation that follows from the others
  double last = std::numeric_limits<double>::infinity();
  for (int i = 0; i < most; ++i) {
    const auto [defect, slope] = defects_of_rotation(family, theta, {x}).front();
    Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
    solver.setThreshold(redundant);
    solver.compute(slope);
    const Eigen::VectorXd next = nearest + solver.solve(slope * (theta - nearest) - defect);
    const double change = (next - theta).lpNorm<Eigen::Infinity>();
    if (!next.allFinite() || !family.is_defined(next) || change > farthest_parameter) return std::nullopt;
    theta = next;
    if (change == 0.0 || (change <= small && change >= 0.9 * last)) {
      return defect.lpNorm<Eigen::Infinity>() <= solved ? std::optional(theta) : std::nullopt;
    }
    last = change;
  }
  return std::nullopt;
}

}  // namespace

phase_fitting fit_phase(const family& family, const Eigen::VectorXd& nearest, double z) {
  constexpr double longest = 0.5;
  constexpr double shortest = 1e-4;
  constexpr double farthest_move = 0.25;  // a solution that jumps belongs to another branch
  if (family.letters.reads != field::whole || family.parameters() < (family.symmetric ? 2 : 3)) {
    return {std::nullopt, 0.0};
  }
  auto theta = nearest_phase_fitted(family, nearest, nearest, 0.0);
  if (!theta) return {std::nullopt, 0.0};
  double reached = 0.0;
  double stride = longest;
  while (reached < z) {
    const double further = std::min(reached + stride, z);
    const auto next = nearest_phase_fitted(family, nearest, *theta, further * further);
    if (next && family.is_in_range(*next) && (*next - *theta).lpNorm<Eigen::Infinity>() <= farthest_move) {
      reached = further;
      theta = next;
      stride = std::min(longest, 2.0 * stride);
    } else if (stride *= 0.5; stride < shortest) {
      return {std::nullopt, reached};
    }
  }
  return {theta, z};
}

}  // namespace nysalt::detail

// A start of a search where the highest frequency is known.

namespace nysalt {

std::optional<named_parameters> phase_fitted_start(const family& family, double z) {
  if (!(z > 0.0) || !std::isfinite(z)) {
    throw std::invalid_argument(sentence(
        "phase_fitted_start: z = step * frequency must be positive and finite, got {}; fit to a mode that "
        "moves",
        z));
  }
  const auto is_classical = [](const named_parameters& one) {
    return one.name != "start" && one.name != "further start";
  };
  for (const bool classical : {true, false}) {
    for (const auto& one : family.starts) {
      if (is_classical(one) != classical) continue;
      if (const auto fit = detail::fit_phase(family, one.theta, z); fit.theta) {
        return named_parameters{"phase_fitted", *fit.theta};
      }
    }
  }
  return std::nullopt;
}

namespace {

/// The start of the family that has the coefficients of the method; nothing if there is none.
std::optional<Eigen::VectorXd> parameters_of_method(const family& family, const nysalt::method& method) {
  constexpr double rounding = 1e-14;  // sums of some coefficients of order one
  const auto& wanted = method.coefficients();
  for (const auto& one : family.starts) {
    const auto c = family.coefficients(one.theta);
    const bool is_equal =
        std::ranges::equal(c, wanted, [](double x, double y) { return std::abs(x - y) <= rounding; });
    if (is_equal) return one.theta;
  }
  return std::nullopt;
}

}  // namespace

method phase_fitted(const family& family, const method& classical, double z) {
  const std::string name = "phase_fitted_" + classical.name();
  if (!(family.letters == classical.letters()) || !family.symmetric || family.parameters() < 2 ||
      family.letters.reads != field::whole || classical.order < 4) {
    throw std::invalid_argument(sentence(
        "{}: the family must be symmetric, with two parameters or more and without rotations, and of "
        "the word {} of a method of order 4 or more, got {} and a method of order {}",
        name, classical.letters().letters(), family.name, classical.order));
  }
  if (!(z > 0.0) || !std::isfinite(z)) {
    throw std::invalid_argument(sentence(
        "{}: z = step * frequency must be positive and finite, got {}; fit to a mode that moves", name, z));
  }
  const auto nearest = parameters_of_method(family, classical);
  if (!nearest) {
    throw std::invalid_argument(
        sentence("{}: the method must be a start of the family {}, got another", name, family.name));
  }
  const auto fit = detail::fit_phase(family, *nearest, z);
  if (!fit.theta) {
    throw std::invalid_argument(sentence(
        "{}: z = step * frequency must be at most {}, where its coefficients end, got {}; take a smaller "
        "step",
        name, std::floor(1000.0 * fit.reached) / 1000.0, std::round(1000.0 * z) / 1000.0));
  }
  return {name,
          family.letters,
          family.coefficients(*fit.theta),
          {classical.order, true, classical.requires_quadratic_kinetic || family.requires_quadratic_kinetic}};
}

double frequency_to_fit(const model& system) {
  if (has_modes(system)) return system.modes().frequencies.maxCoeff();
  return highest_frequency(system.frequency_bands());
}

}  // namespace nysalt
