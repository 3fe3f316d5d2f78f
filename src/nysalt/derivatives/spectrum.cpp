// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/spectrum.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/noises/counter_noise.hpp"

namespace nysalt {

namespace {

/// M^{-1/2} of a system with a quadratic kinetic energy.
Eigen::VectorXd inverse_root_masses(const model& system) {
  Eigen::VectorXd root(system.size());
  for (Eigen::Index i = 0; i < root.size(); ++i) root[i] = std::sqrt(system.inverse_mass(i));
  return root;
}

}  // namespace

namespace detail {

Eigen::VectorXd lengths_of(const std::vector<Eigen::VectorXd>& points) {
  Eigen::VectorXd low = points.front();
  Eigen::VectorXd high = points.front();
  for (const auto& x : points) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const Eigen::VectorXd size = low.cwiseAbs().cwiseMax(high.cwiseAbs());
  constexpr double rounding = 1e-9;  // of where a coordinate is: less cannot be divided into steps
  Eigen::VectorXd result = high - low;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (!(result[i] > rounding * size[i])) result[i] = 0.0;
  }
  double instead = result.maxCoeff();
  if (!(instead > 0.0)) instead = size.maxCoeff();
  if (!(instead > 0.0) || !std::isfinite(instead)) instead = 1.0;
  for (double& length : result) {
    if (!(length > 0.0) || !std::isfinite(length)) length = instead;
  }
  return result;
}

Eigen::MatrixXd kinetic_factor(const model& system, const Eigen::VectorXd& p) {
  if (system.facts().has_quadratic_kinetic) return inverse_root_masses(system).asDiagonal();
  const Eigen::MatrixXd hessian = system.kinetic_hessian(p);
  if (!hessian.allFinite()) return {};
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(0.5 * (hessian + hessian.transpose()));
  const Eigen::VectorXd& squares = solver.eigenvalues();
  constexpr double rounding = 1e-12;  // a coordinate that runs at constant speed has none
  if (squares.minCoeff() < -rounding * std::abs(squares.maxCoeff())) return {};
  return solver.eigenvectors() * squares.cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

}  // namespace detail

detail::force_jacobian::force_jacobian(const model& system, const phase_points& states, field of)
    : system_(system),
      field_(of),
      differs_(of == field::whole && system.facts().derivative_calls == 2),
      room_(system.size()),
      q_(Eigen::VectorXd::Zero(system.size())),
      v_(q_),
      f_(q_),
      g_(q_) {
  if (!differs_ || states.empty()) return;
  std::vector<Eigen::VectorXd> points;
  for (const auto& state : states) points.emplace_back(state.q);
  lengths_ = detail::lengths_of(points);
}

void detail::force_jacobian::move_to(const Eigen::VectorXd& q) {
  q_ = q;
  if (differs_) system_.force(q_, f_);
}

const Eigen::VectorXd& detail::force_jacobian::times(const Eigen::VectorXd& v) {
  if (differs_) {
    const double displacements = v.cwiseQuotient(lengths_).cwiseAbs().maxCoeff();
    v_ = v / displacements;
    directional_derivative(system_, q_, v_, f_, g_);
    g_ *= displacements;
  } else {
    system_.kernels<double>().force_along(field_, q_, v, g_, room_, detail::part_of_displacement);
  }
  return g_;
}

Eigen::MatrixXd detail::force_jacobian::potential_hessian(const Eigen::VectorXd& q) {
  const Eigen::Index n = q.size();
  move_to(q);
  Eigen::MatrixXd hessian(n, n);
  for (Eigen::Index j = 0; j < n; ++j) hessian.col(j) = -times(Eigen::VectorXd::Unit(n, j));
  return 0.5 * (hessian + hessian.transpose());
}

namespace {

/// An orthonormal basis of v, A v, A^2 v, ..., in which the symmetric A is tridiagonal.
class krylov_space {
 public:
  explicit krylov_space(const Eigen::VectorXd& start) : next_(start.normalized()) {}

  /// By one product. Orthogonal to all directions before it, twice: once leaves rounding.
  void extend(const detail::symmetric_map& multiply) {
    if (!basis_.empty()) beside_.push_back(rest_);
    basis_.push_back(next_);
    next_ = multiply(basis_.back());
    diagonal_.push_back(basis_.back().dot(next_));
    for (int pass = 0; pass < 2; ++pass) {
      for (const auto& v : basis_) next_ -= v.dot(next_) * v;
    }
    rest_ = next_.norm();
    if (rest_ > 0.0) next_ /= rest_;
  }

  Eigen::Index size() const { return static_cast<Eigen::Index>(basis_.size()); }
  bool is_finite() const { return std::isfinite(rest_) && std::isfinite(diagonal_.back()); }
  /// A leads no further: what is left is rounding.
  bool is_closed() const {
    double largest = 0.0;
    for (const double a : diagonal_) largest = std::max(largest, std::abs(a));
    for (const double b : beside_) largest = std::max(largest, b);
    return rest_ <= 1e-12 * largest;
  }

  /// An eigenvalue lies within |A v - value v| = residual of the value.
  struct ritz_pair {
    double value;
    double residual;
    Eigen::VectorXd in_basis;
  };
  /// The lowest and the highest.
  std::array<ritz_pair, 2> ends() const {
    const Eigen::Map<const Eigen::VectorXd> diagonal(diagonal_.data(), size());
    const Eigen::Map<const Eigen::VectorXd> beside(beside_.data(), size() - 1);
    Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver;
    solver.computeFromTridiagonal(diagonal, beside);
    const auto pair = [&](Eigen::Index j) -> ritz_pair {
      const double last = solver.eigenvectors()(size() - 1, j);
      return {solver.eigenvalues()[j], rest_ * std::abs(last), solver.eigenvectors().col(j)};
    };
    return {pair(0), pair(size() - 1)};
  }
  Eigen::VectorXd direction(const ritz_pair& pair) const {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(next_.size());
    for (Eigen::Index i = 0; i < size(); ++i) sum += pair.in_basis[i] * basis_[static_cast<std::size_t>(i)];
    return sum;
  }

 private:
  std::vector<Eigen::VectorXd> basis_;
  std::vector<double> diagonal_;
  std::vector<double> beside_;
  Eigen::VectorXd next_;
  double rest_ = 0.0;
};

}  // namespace

detail::spectrum_ends detail::ends_of_spectrum(const detail::symmetric_map& multiply,
                                               const Eigen::VectorXd& start, double relative_error) {
  const Eigen::Index most = std::min<Eigen::Index>(start.size(), 100);
  const Eigen::Index least = std::min<Eigen::Index>(start.size(), 8);  // a start may know another eigenvalue
  krylov_space space(start);
  while (true) {
    space.extend(multiply);
    if (!space.is_finite()) break;
    const bool is_last = space.size() == most || space.is_closed();
    if (space.size() < least && !is_last) continue;
    const auto [low, high] = space.ends();
    const double size = std::max(std::abs(low.value), std::abs(high.value));
    const bool is_known = low.residual <= relative_error * size &&
                          high.residual <= relative_error * std::max(high.value, 0.01 * size);
    if (!is_known && !is_last) continue;
    return {low.value - low.residual, high.value + high.residual, space.direction(low), space.direction(high),
            static_cast<int>(space.size())};
  }
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  return {nan, nan, start, start, static_cast<int>(space.size())};
}

stiffness_range hessian_spectrum(const model& system, const phase_points& states, field of) {
  if (states.empty()) throw std::invalid_argument("hessian_spectrum: states must hold one or more, got none");
  const Eigen::VectorXd root = inverse_root_masses(system);
  // Every start has a part of chance, the same for all, so that no end can hide from it; and of the ends of
  // the state before, which are near.
  std::mt19937_64 bits{1};
  Eigen::VectorXd chance(root.size());
  for (double& x : chance) x = detail::uniform_by_bits(bits()) - 0.5;
  chance.normalize();
  Eigen::VectorXd start = chance;

  stiffness_range found;
  detail::force_jacobian jacobian(system, states, of);
  for (const auto& state : states) {
    jacobian.move_to(state.q);
    const auto multiply = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd {
      return -root.cwiseProduct(jacobian.times(root.cwiseProduct(x)));
    };
    const auto ends = detail::ends_of_spectrum(multiply, start);
    if (!std::isfinite(ends.lowest) || !std::isfinite(ends.highest)) {
      throw std::invalid_argument(
          sentence("hessian_spectrum: the force must have a finite derivative at each state, got none "
                   "at state {}; leave that state out",
                   found.states));
    }
    found.lowest = std::min(found.lowest, ends.lowest);
    found.highest = std::max(found.highest, ends.highest);
    found.highest_of_state.push_back(ends.highest);
    found.evaluations += ends.products;
    ++found.states;
    start = chance + ends.lowest_direction + ends.highest_direction;
  }
  return found;
}

namespace {

std::vector<double> frequencies_of(const model& system, detail::force_jacobian& jacobian,
                                   const phase_point<double, Eigen::Dynamic>& state) {
  const Eigen::MatrixXd factor = detail::kinetic_factor(system, state.p);
  if (factor.size() == 0) return {};
  const Eigen::MatrixXd stiffness = factor.transpose() * jacobian.potential_hessian(state.q) * factor;
  if (!stiffness.allFinite()) {
    throw std::invalid_argument(
        "frequencies_at: the force must have a finite derivative at the state, got none");
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(stiffness);
  std::vector<double> result;
  for (const double x : solver.eigenvalues()) result.push_back(std::sqrt(std::max(0.0, x)));
  return result;
}

}  // namespace

std::vector<double> detail::frequencies_at(const model& system,
                                           const phase_point<double, Eigen::Dynamic>& state) {
  detail::force_jacobian jacobian(system, std::vector{state});
  return frequencies_of(system, jacobian, state);
}

detail::frequencies_along detail::frequencies_of_states(const model& system, const phase_points& states) {
  detail::frequencies_along result;
  const auto& facts = system.facts();
  if (facts.size <= detail::most_for_all_frequencies && facts.has_differentiable_velocity) {
    result.are_complete = true;
    detail::force_jacobian jacobian(system, states);
    for (const auto& state : states) result.of_state.push_back(frequencies_of(system, jacobian, state));
  } else if (!states.empty() && facts.has_quadratic_kinetic) {
    for (const double square : hessian_spectrum(system, states).highest_of_state) {
      result.of_state.push_back({std::sqrt(std::max(0.0, square))});
    }
  }
  return result;
}

}  // namespace nysalt
