// SPDX-License-Identifier: BSL-1.0

#include "nysalt/derivatives/check_force.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "nysalt/core/rounding.hpp"
#include "nysalt/derivatives/spectrum.hpp"
#include "nysalt/kernels/site_kernels.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

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

// Derivatives of the functions of a model: automatic ones, or differences.

namespace nysalt::detail {

namespace {

using column = Eigen::VectorXd;

/// Exact derivatives of a formula of a hundred operations, whose terms exceed their sum up to 7e5 times, err
/// by less than 100 * 7e5 eps = sqrt(eps) of it.
double tolerance_of_exact() { return std::sqrt(std::numeric_limits<double>::epsilon()); }

/// Adapted differences err by 1e-7 of what they differentiate for one that is some r = |V|/(L |f|) = 1 of it,
/// and by r times their rounding, 1e-11: below this for r < 10^7.
double tolerance_of_differences() { return 30.0 * std::cbrt(std::numeric_limits<double>::epsilon()); }

/// The derivative of function(vector) along a direction whose size is that of a displacement of the motion.
/// Errors of the function's entries count with the weights.
column difference_along(const auto& function, const column& x, const column& direction,
                        const column& weights) {
  const auto value_at = [&](double s, column& y) { y = function(x + s * direction); };
  const column middle = function(x);
  const double noise = noise_of_forces * weights.cwiseAbs().dot(middle.cwiseAbs());
  column result = middle;
  adapted_difference(value_at, middle, weights, noise, farthest_from(x, direction), result);
  return result;
}

/// The same of a function with one value.
double slope_by_difference(const auto& function, const column& x, const column& direction) {
  const auto value = [&](const column& at) { return column::Constant(1, function(at)).eval(); };
  return difference_along(value, x, direction, column::Ones(1))[0];
}

vector<slopes, Eigen::Dynamic> lifted(const column& x, const column& v) {
  vector<slopes, Eigen::Dynamic> result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    result[i] = slopes(x[i]);
    result[i].derivative[0] = v[i];
  }
  return result;
}
column first_slopes(const vector<slopes, Eigen::Dynamic>& x) {
  column result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) result[i] = x[i].derivative[0];
  return result;
}

/// Whether slopes of the force are automatic derivatives, and so those of its potential.
bool has_exact_force(const model_facts& facts) { return !facts.is_black_box; }
bool has_exact_potential(const model_facts& facts) {
  return facts.has_potential_over_slopes && !facts.is_black_box;
}
/// Whether slopes of the velocity, or of the kinetic energy that it comes from, are automatic derivatives.
bool has_exact_velocity(const model_facts& facts) {
  return facts.has_own_kinetic_energy ? facts.has_kinetic_energy_over_slopes : facts.has_velocity_over_slopes;
}

/// Of the force along v, which is as long as a displacement of the motion, as all directions are.
void force_slope(const model& system, const column& q, const column& v, column& g) {
  if (system.facts().is_black_box) {
    column f(q.size());
    system.force(q, f);
    directional_derivative(system, q, v, f, g);
  } else {
    vector<slopes, Eigen::Dynamic> result(q.size());
    system.force(lifted(q, v), result);
    g = first_slopes(result);
  }
}

double potential_slope(const model& system, const column& q, const column& v) {
  if (system.facts().has_potential_over_slopes) return system.potential(lifted(q, v)).derivative[0];
  return slope_by_difference([&](const column& x) { return system.potential(x); }, q, v);
}

void velocity_slope(const model& system, const column& p, const column& v, column& g) {
  if (system.facts().has_velocity_over_slopes) {
    vector<slopes, Eigen::Dynamic> result(p.size());
    system.kernels<slopes>().velocity(lifted(p, v), result);
    g = first_slopes(result);
  } else {
    const auto at = [&](const column& x) {
      column result(x.size());
      system.kernels<double>().velocity(x, result);
      return result;
    };
    g = difference_along(at, p, v, v);
  }
}

double kinetic_slope(const model& system, const column& p, const column& v) {
  if (system.facts().has_kinetic_energy_over_slopes) {
    return system.kernels<slopes>().kinetic_energy(lifted(p, v)).derivative[0];
  }
  return slope_by_difference([&](const column& x) { return system.kernels<double>().kinetic_energy(x); }, p,
                             v);
}

/// The kick p += force(q)/2 of some sites, by the kick or by the force. What is beyond the reach of the range
/// is not a number.
void kick_in_range(const site_kernels& sites, Eigen::Index begin, Eigen::Index end, bool by_force,
                   const column& q, column& p) {
  const site_layout layout = sites.layout();
  const auto is_there = [&](Eigen::Index i) { return layout.is_periodic || (0 <= i && i < layout.sites); };
  Eigen::Index first = begin - layout.reach;
  Eigen::Index last = end + layout.reach;
  if (!is_there(first)) first = 0;
  if (!is_there(last - 1)) last = layout.sites;
  const Eigen::Index margin = 3 * layout.reach + 16;
  const Eigen::Index stride = last - first + 2 * margin;
  std::vector<double> values(static_cast<std::size_t>(3 * layout.components * stride),
                             std::numeric_limits<double>::quiet_NaN());
  const auto part = [&](Eigen::Index number) {
    return columns(values.data() + number * layout.components * stride, first - margin, stride);
  };
  const tile x{
      part(0), part(1), part(2), first, last, first == begin - layout.reach, last == end + layout.reach};
  for (Eigen::Index c = 0; c < layout.components; ++c) {
    for (Eigen::Index i = first; i < last; ++i) {
      const Eigen::Index site = (i % layout.sites + layout.sites) % layout.sites;
      x.q(c, i) = q[layout.components * site + c];
      x.p(c, i) = p[layout.components * site + c];
    }
  }
  const std::array<tile_letter, 1> letter{{{.coefficient = 0.5, .is_kick = true, .keeps_force = by_force}}};
  sites.advance(x, letter);
  for (Eigen::Index c = 0; c < layout.components; ++c) {
    for (Eigen::Index i = begin; i < end; ++i) p[layout.components * i + c] = x.p(c, i);
  }
}

/// p += force(q)/2 in four ranges of sites, by the kick and by the force in turn.
void kick_in_ranges(const site_kernels& sites, const column& q, column& p) {
  const site_layout layout = sites.layout();
  const Eigen::Index rows = layout.sites / layout.sites_of_row;
  constexpr Eigen::Index ranges = 4;
  for (Eigen::Index k = 0; k < ranges; ++k) {
    kick_in_range(sites, layout.sites_of_row * (rows * k / ranges),
                  layout.sites_of_row * (rows * (k + 1) / ranges), k % 2 == 1, q, p);
  }
}

}  // namespace

}  // namespace nysalt::detail

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
 public:
  force_examination(const model& system, const column& lengths, const column& lengths_of_momenta)
      : system_(system),
        facts_(system.facts()),
        lengths_(lengths),
        lengths_of_momenta_(lengths_of_momenta),
        along_(directions_to_examine(lengths)),
        along_momenta_(directions_to_examine(lengths_of_momenta)),
        f_(facts_.size),
        other_(facts_.size) {
    found_.has_potential = facts_.has_potential;
    found_.tolerance = has_exact_potential(facts_) ? tolerance_of_exact() : tolerance_of_differences();
    found_.asymmetry_tolerance = has_exact_force(facts_) ? tolerance_of_exact() : tolerance_of_differences();
    found_.kick_tolerance = tolerance_of_exact();
    found_.derivative_tolerance = tolerance_of_differences();
    found_.velocity_tolerance =
        has_exact_velocity(facts_) ? tolerance_of_exact() : tolerance_of_differences();
  }

  void examine(const column& q, const column& p) {
    system_.force(q, f_);
    keep(energies(f_), largest_force_);
    if (facts_.has_potential) examine_potential(q);
    if (facts_.has_own_kick) examine_kick(q);
    if (system_.sites() != nullptr) examine_ranges(q);
    if (facts_.has_quadratic_part && facts_.size <= examined_singly) examine_soft_force(q);
    const auto slope = [&](const column& v) { force_slope(system_, q, v, other_); };
    examine_symmetry(along_, lengths_, slope, found_.asymmetry, largest_slope_);
    if (facts_.has_own_derivative) examine_derivative(q);
    if (facts_.has_own_velocity) examine_velocity(p);
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
      const double defect = f_.dot(along_[j]) + potential_slope(system_, q, along_[j]);
      note_along(defect, j, found_.gradient_defect, found_.coordinate);
    }
  }

  void examine_kick(const column& q) {
    other_ = f_;
    system_.own_kick(q, other_, 0.5);
    note(energies(other_ - 1.5 * f_), found_.kick_defect, found_.kick_coordinate);
  }

  void examine_ranges(const column& q) {
    other_ = f_;
    kick_in_ranges(*system_.sites(), q, other_);
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
    const auto modes = modal_coordinates::of(system_);
    const column rest = column::Zero(facts_.size);
    column x(facts_.size);
    column y(facts_.size);
    modes->to_modes(q, rest, x, y);
    for (Eigen::Index k = 0; k < facts_.size; ++k) {
      const double omega = modes->frequencies()[static_cast<std::size_t>(k)];
      y[k] = omega * omega * x[k];
    }
    column back(facts_.size);  // q itself
    column quadratic(facts_.size);
    modes->from_modes(x, y, back, quadratic);
    system_.soft_force(q, other_);
    note(energies(other_ - f_ - quadratic), found_.soft_defect, found_.soft_coordinate);
  }

  void examine_derivative(const column& q) {
    const auto force_at = [&](const column& x) {
      column y(x.size());
      system_.force(x, y);
      return y;
    };
    for (const auto& v : along_) {
      system_.force_derivative(q, v, other_);
      const column differences = difference_along(force_at, q, v, v);
      keep(energies(other_), largest_slope_);
      keep(energies(differences), largest_slope_);
      found_.derivative_defect = std::max(found_.derivative_defect, largest(energies(other_ - differences)));
    }
  }

  void examine_velocity(const column& p) {
    column v(facts_.size);
    system_.kernels<double>().velocity(p, v);
    keep(v.cwiseProduct(lengths_of_momenta_), largest_velocity_);
    if (!facts_.has_own_kinetic_energy) {
      const auto slope = [&](const column& along) { velocity_slope(system_, p, along, other_); };
      examine_symmetry(along_momenta_, lengths_of_momenta_, slope, found_.velocity_asymmetry,
                       largest_velocity_slope_);
      return;
    }
    for (std::size_t j = 0; j < along_momenta_.size(); ++j) {
      const double defect = v.dot(along_momenta_[j]) - kinetic_slope(system_, p, along_momenta_[j]);
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
    coordinate = facts_.size <= examined_singly ? static_cast<Eigen::Index>(j) : -1;
  }

  const model& system_;
  const model_facts& facts_;
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

}  // namespace nysalt::detail

namespace nysalt {

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
  const detail::usual_rounding rounding;
  std::vector<Eigen::VectorXd> places = points;
  std::vector<Eigen::VectorXd> all_momenta = momenta;
  for (const auto& x : seen) {
    places.emplace_back(x.q);
    all_momenta.emplace_back(x.p);
  }
  const Eigen::VectorXd lengths = detail::lengths_of(places);
  const Eigen::VectorXd lengths_of_momenta = detail::lengths_of(all_momenta);
  const auto examined = [&](double away) {
    detail::force_examination examination(system, lengths, lengths_of_momenta);
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

force_check check_force(const model& system, const std::vector<Eigen::VectorXd>& points) {
  return check_force(system, points, points);
}

}  // namespace nysalt
