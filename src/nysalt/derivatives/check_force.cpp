// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/check_force.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "force_source.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/detail/rounding.hpp"

namespace nysalt {

namespace {

std::string where(Eigen::Index coordinate) {
  return coordinate < 0 ? "along a direction at random it" : fmt::format("coordinate {}", coordinate + 1);
}

}  // namespace

std::string force_check::report() const {
  if (passed()) return fmt::format("the force is {}", has_potential ? "-grad V" : "conservative");
  if (!passes_beside) return objection();
  return objection() +
         "; a little beside these points nothing is wrong, as where there is a kink or a pole at one of them";
}

std::string force_check::objection() const {
  if (!finite) return "the force or velocity is not finite at one of the points, or not differentiable there";
  if (gradient_defect > tolerance) {
    return fmt::format(
        "the force is not -grad V: {} is off by {:.2e} of the largest force; check its sign and formula",
        where(coordinate), gradient_defect);
  }
  if (kick_defect > kick_tolerance) {
    return fmt::format(
        "the kick is not p += c force(q): {} is off by {:.2e} of the largest force; check its formula, or "
        "leave it out",
        where(kick_coordinate), kick_defect);
  }
  if (range_defect > kick_tolerance) {
    if (!std::isfinite(range_defect)) {
      return fmt::format(
          "force_in_range reads sites beyond reach() from the range: {} is not finite where these are not; "
          "check reach() and the formula",
          where(range_coordinate));
    }
    return fmt::format(
        "force_in_range or kick_in_range is not the force: {} is off by {:.2e} of the largest force; check "
        "its "
        "formula at the ends of ranges",
        where(range_coordinate), range_defect);
  }
  if (soft_defect > kick_tolerance) {
    return fmt::format(
        "the soft_force is not the force without the quadratic part that modes() declares: {} is off by "
        "{:.2e} of the largest force; check both",
        where(soft_coordinate), soft_defect);
  }
  if (derivative_defect > derivative_tolerance) {
    return fmt::format(
        "force_derivative is not f'(q) v: it is off by {:.2e} of the largest entry of f'; check its sign "
        "and formula, or leave it out",
        derivative_defect);
  }
  if (asymmetry > asymmetry_tolerance) {
    return fmt::format("the force is not conservative: its Jacobian is asymmetric by {:.2e}", asymmetry);
  }
  if (velocity_defect > velocity_tolerance) {
    return fmt::format(
        "the velocity is not grad K: {} is off by {:.2e} of the largest velocity; check its sign and "
        "formula",
        where(velocity_coordinate), velocity_defect);
  }
  return fmt::format("the velocity is not the gradient of any K: its Jacobian is asymmetric by {:.2e}",
                     velocity_asymmetry);
}

}  // namespace nysalt

// Compares, at one point after the other, what a system says of its force in several ways.

namespace nysalt::detail {

namespace {

/// Up to this number of coordinates each is a direction of a check.
constexpr Eigen::Index examined_singly = 64;

/// Along coordinates, each as far as its length, or four at random, the same at every point. A defect d of
/// some coordinates is seen along these as |d|/sqrt(N) or so; a tolerance of 2e-4, that of differences, still
/// shows one whole coordinate in 10^6. Sums over N terms of either sign err by eps sqrt(N) of their size.
std::vector<Eigen::VectorXd> directions_to_examine(const Eigen::VectorXd& lengths) {
  const Eigen::Index n = lengths.size();
  std::vector<Eigen::VectorXd> result;
  if (n <= examined_singly) {
    for (Eigen::Index j = 0; j < n; ++j) result.push_back(lengths[j] * Eigen::VectorXd::Unit(n, j));
    return result;
  }
  std::minstd_rand random(1);
  constexpr double middle = 0.5 * static_cast<double>(std::minstd_rand::max());
  for (int j = 0; j < 4; ++j) {
    Eigen::VectorXd direction(n);
    for (double& x : direction) x = static_cast<double>(random()) - middle;
    result.push_back(lengths.cwiseProduct(direction.normalized()));
  }
  return result;
}

/// Forces are compared as the energies that they are over the lengths of coordinates, and velocities over
/// those of momenta: then no unit of a coordinate matters.
class force_examination {
  using column = Eigen::VectorXd;

 public:
  force_examination(const force_source& source, const column& lengths, const column& lengths_of_momenta)
      : source_(source),
        lengths_(lengths),
        lengths_of_momenta_(lengths_of_momenta),
        along_(directions_to_examine(lengths)),
        along_momenta_(directions_to_examine(lengths_of_momenta)),
        f_(source.size),
        other_(source.size) {
    found_.has_potential = source.has_potential;
    found_.tolerance = source.has_exact_potential ? tolerance_of_exact() : tolerance_of_differences();
    found_.asymmetry_tolerance = source.has_exact_force ? tolerance_of_exact() : tolerance_of_differences();
    found_.kick_tolerance = tolerance_of_exact();
    found_.derivative_tolerance = tolerance_of_differences();
    found_.velocity_tolerance = source.has_exact_velocity ? tolerance_of_exact() : tolerance_of_differences();
  }

  void examine(const column& q, const column& p) {
    source_.force(q, f_);
    keep(energies(f_), largest_force_);
    if (source_.has_potential) examine_potential(q);
    if (source_.has_kick) examine_kick(q);
    if (source_.has_ranges) examine_ranges(q);
    if (source_.has_soft_force && source_.size <= examined_singly) examine_soft_force(q);
    const auto slope = [&](const column& v) { source_.force_slope(q, v, other_); };
    examine_symmetry(along_, lengths_, slope, found_.asymmetry, largest_slope_);
    if (source_.has_derivative) examine_derivative(q);
    if (source_.has_velocity) examine_velocity(p);
  }

  force_check result() const {
    force_check result = found_;
    // Where all is at rest: what a small displacement would make, of a part cbrt(eps) of the lengths.
    const double rest = std::cbrt(std::numeric_limits<double>::epsilon()) * largest_slope_;
    const double scale = std::max(largest_force_, rest);
    result.gradient_defect /= scale;
    result.kick_defect /= scale;
    result.range_defect /= scale;
    result.soft_defect /= scale;
    result.derivative_defect /= largest_slope_;
    result.asymmetry /= largest_slope_;
    result.velocity_defect /= largest_velocity_;
    result.velocity_asymmetry /= largest_velocity_slope_;
    return result;
  }

 private:
  void examine_potential(const column& q) {
    for (std::size_t j = 0; j < along_.size(); ++j) {
      const double defect = f_.dot(along_[j]) + source_.potential_slope(q, along_[j]);
      note_along(defect, j, found_.gradient_defect, found_.coordinate);
    }
  }

  void examine_kick(const column& q) {
    other_ = f_;
    source_.kick(q, other_);
    note(energies(other_ - 1.5 * f_), found_.kick_defect, found_.kick_coordinate);
  }

  void examine_ranges(const column& q) {
    other_ = f_;
    source_.kick_in_ranges(q, other_);
    const column defects = energies(other_ - 1.5 * f_);
    for (Eigen::Index i = 0; i < defects.size(); ++i) {
      const double defect =
          std::isfinite(defects[i]) ? std::abs(defects[i]) : std::numeric_limits<double>::infinity();
      if (defect <= found_.range_defect) continue;
      found_.range_defect = defect;
      found_.range_coordinate = i;
    }
  }

  /// With K q = M^{1/2} U omega^2 x, x = U^T M^{1/2} q.
  void examine_soft_force(const column& q) {
    const auto modes = source_.modes();
    const column rest = column::Zero(source_.size);
    column x(source_.size);
    column y(source_.size);
    modes->to_modes(q, rest, x, y);
    for (Eigen::Index k = 0; k < source_.size; ++k) {
      const double omega = modes->frequencies()[static_cast<std::size_t>(k)];
      y[k] = omega * omega * x[k];
    }
    column back(source_.size);  // q itself
    column quadratic(source_.size);
    modes->from_modes(x, y, back, quadratic);
    source_.soft_force(q, other_);
    note(energies(other_ - f_ - quadratic), found_.soft_defect, found_.soft_coordinate);
  }

  void examine_derivative(const column& q) {
    const auto force_at = [&](const column& x) {
      column y(x.size());
      source_.force(x, y);
      return y;
    };
    for (const auto& v : along_) {
      source_.derivative(q, v, other_);
      const column differences = difference_along(force_at, q, v);
      keep(energies(other_), largest_slope_);
      keep(energies(differences), largest_slope_);
      found_.derivative_defect = std::max(found_.derivative_defect, largest(energies(other_ - differences)));
    }
  }

  void examine_velocity(const column& p) {
    column v(source_.size);
    source_.velocity(p, v);
    keep(v.cwiseProduct(lengths_of_momenta_), largest_velocity_);
    if (!source_.has_kinetic_energy) {
      const auto slope = [&](const column& along) { source_.velocity_slope(p, along, other_); };
      examine_symmetry(along_momenta_, lengths_of_momenta_, slope, found_.velocity_asymmetry,
                       largest_velocity_slope_);
      return;
    }
    for (std::size_t j = 0; j < along_momenta_.size(); ++j) {
      const double defect = v.dot(along_momenta_[j]) - source_.kinetic_slope(p, along_momenta_[j]);
      note_along(defect, j, found_.velocity_defect, found_.velocity_coordinate);
    }
  }

  /// Of the matrix that slope_along multiplies a direction with, into other_.
  void examine_symmetry(const std::vector<column>& along, const column& lengths, const auto& slope_along,
                        double& most, double& largest_slope) {
    std::vector<column> slopes;
    for (const auto& v : along) {
      slope_along(v);
      keep(other_.cwiseProduct(lengths), largest_slope);
      slopes.push_back(other_);
    }
    for (std::size_t j = 0; j < along.size(); ++j) {
      for (std::size_t i = 0; i < j; ++i) {
        most = std::max(most, std::abs(along[i].dot(slopes[j]) - along[j].dot(slopes[i])));
      }
    }
  }

  column energies(const column& forces) const { return forces.cwiseProduct(lengths_); }
  static double largest(const column& entries) { return entries.cwiseAbs().maxCoeff(); }
  void keep(const column& entries, double& most) {
    found_.finite = found_.finite && entries.allFinite();
    most = std::max(most, largest(entries));
  }
  void note(const column& defects, double& most, Eigen::Index& coordinate) {
    found_.finite = found_.finite && defects.allFinite();
    for (Eigen::Index i = 0; i < defects.size(); ++i) {
      if (std::abs(defects[i]) <= most) continue;
      most = std::abs(defects[i]);
      coordinate = i;
    }
  }
  void note_along(double defect, std::size_t j, double& most, Eigen::Index& coordinate) {
    found_.finite = found_.finite && std::isfinite(defect);
    if (std::abs(defect) <= most) return;
    most = std::abs(defect);
    coordinate = source_.size <= examined_singly ? static_cast<Eigen::Index>(j) : -1;
  }

  const force_source& source_;
  column lengths_;
  column lengths_of_momenta_;
  std::vector<column> along_;
  std::vector<column> along_momenta_;
  column f_;
  column other_;
  force_check found_;
  double largest_force_ = std::numeric_limits<double>::min();
  double largest_slope_ = largest_force_;
  double largest_velocity_ = largest_force_;
  double largest_velocity_slope_ = largest_force_;
};

}  // namespace

/// At all points; what fails is checked once more at a small distance from them.
force_check check_force(const model& system, const std::vector<Eigen::VectorXd>& points,
                        const std::vector<Eigen::VectorXd>& momenta, const phase_points& seen) {
  if (points.empty()) throw std::invalid_argument("check_force: points must be one or more, got none");
  if (momenta.size() != points.size()) {
    throw std::invalid_argument(
        fmt::format("check_force: momenta must be one for each point, got {} points with {} momenta",
                    points.size(), momenta.size()));
  }
  for (std::size_t m = 0; m < points.size(); ++m) {
    for (const auto* x : {&points[m], &momenta[m]}) {
      if (x->size() == size(system)) continue;
      throw std::invalid_argument(
          fmt::format("check_force: point {} must have {} coordinates, as the system has, got {}", m + 1,
                      size(system), x->size()));
    }
  }
  if (!seen.empty() && seen.dimension() != size(system)) {
    throw std::invalid_argument(
        fmt::format("check_force: a state must have {} coordinates, as the system has, got {}", size(system),
                    seen.dimension()));
  }
  const usual_rounding rounding;
  std::vector<Eigen::VectorXd> places = points;
  std::vector<Eigen::VectorXd> all_momenta = momenta;
  for (const auto& x : seen) {
    places.emplace_back(x.q);
    all_momenta.emplace_back(x.p);
  }
  const Eigen::VectorXd lengths = lengths_of(places);
  const Eigen::VectorXd lengths_of_momenta = lengths_of(all_momenta);
  const force_source source(system);
  const auto examined = [&](double away) {
    force_examination examination(source, lengths, lengths_of_momenta);
    std::minstd_rand random(1);
    const auto beside = [&](Eigen::VectorXd x, const Eigen::VectorXd& length) {
      for (Eigen::Index i = 0; i < x.size(); ++i) x[i] += (random() % 2 == 0 ? away : -away) * length[i];
      return x;
    };
    for (std::size_t m = 0; m < points.size(); ++m) {
      const Eigen::VectorXd q = beside(points[m], lengths);
      examination.examine(q, beside(momenta[m], lengths_of_momenta));
    }
    return examination.result();
  };
  force_check result = examined(0.0);
  constexpr double little = 1e-3;  // farther than differences reach
  if (!result.passed()) result.passes_beside = examined(little).passed();
  rounding.require();
  return result;
}

}  // namespace nysalt::detail
