// SPDX-License-Identifier: BSL-1.0
// Initial distributions of the bundled systems.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/detail/fingerprint.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/lennard_jones.hpp"
#include "nysalt/systems/lennard_jones_liquid.hpp"
#include "nysalt/systems/textbook.hpp"

namespace nysalt {

/// Positions of a list, such as the draws of a sampler, with momenta of Maxwell's distribution, p_i ~ N(0,
/// m_i kT). Each start takes a position of the list at random, so that starts of one list may share it.
template <int N>
class thermal_positions {
 public:
  /// Positions for a system, whose masses scale the momenta. Throws std::invalid_argument if there is no
  /// position, one does not fit the system or is not finite, or kT is not positive and finite.
  template <SeparableSystem S>
    requires(S::dimension == N)
  thermal_positions(const S& system, std::vector<vector<double, N>> positions, double temperature) {
    if (!(temperature > 0.0) || !std::isfinite(temperature)) {
      throw std::invalid_argument(
          sentence("thermal_positions: kT must be positive and finite, got {}", temperature));
    }
    if (positions.empty())
      throw std::invalid_argument("thermal_positions: there must be a position, got none");
    for (std::size_t n = 0; n < positions.size(); ++n) {
      if (positions[n].size() == nysalt::size(system) && positions[n].allFinite()) continue;
      throw std::invalid_argument(
          sentence("thermal_positions: position {} must be {} finite numbers", n + 1, nysalt::size(system)));
    }
    for (Eigen::Index i = 0; i < nysalt::size(system); ++i) {
      double mass = 1.0;
      if constexpr (HasInverseMass<S>) mass = 1.0 / system.inverse_mass(i);
      deviations_.push_back(std::sqrt(mass * temperature));
    }
    detail::fingerprint sum;
    for (const auto& q : positions) sum.add_all(q);
    description_ = sentence("thermal_positions({} positions, temperature={}, fingerprint={})",
                            positions.size(), in_digits(temperature, 6), sum.text());
    positions_ = std::make_shared<const std::vector<vector<double, N>>>(std::move(positions));
  }

  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    const auto size = static_cast<Eigen::Index>(deviations_.size());
    vector<double, Eigen::Dynamic> normals(size + 1);
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
    const double uniform = 0.5 * std::erfc(-normals[size] / std::sqrt(2.0));
    const auto last = positions_->size() - 1;
    const auto number = static_cast<std::size_t>(uniform * static_cast<double>(positions_->size()));
    phase_point<double, N> x{(*positions_)[std::min(number, last)], vector<double, N>(size)};
    for (Eigen::Index i = 0; i < size; ++i) {
      x.p[i] = normals[i] * deviations_[static_cast<std::size_t>(i)];
    }
    return x;
  }
  std::string description() const { return description_; }

 private:
  std::shared_ptr<const std::vector<vector<double, N>>> positions_;
  std::vector<double> deviations_;  // of the momenta
  std::string description_;
};

/// Initial states of the soft springs.
struct soft_motion {
  double displacement = 1.0;  ///< x_0 of every pair
  double velocity = 1.0;      ///< y_0 of every pair
};

/// States of the FPU chain [li_lu_tao_ye_2023, equation (5.5)]: x_0 and y_0 as given, and x_1 = 1/omega +
/// zeta, y_1 = 1 + eta, with zeta and eta normal of standard deviation spread/omega. The paper's spread, x_0
/// and y_0 are 1: nearly harmonic states. Those of soft_dominated are not.
template <int Pairs>
class fpu_law {
 public:
  /// Throws std::invalid_argument if the spread is negative, or it or the soft motion not finite.
  explicit fpu_law(const fpu_chain<Pairs>& chain, double spread = 1.0, const soft_motion& soft = {})
      : pairs_(chain.pairs()), omega_(chain.omega()), spread_(spread), soft_(soft) {
    const bool finite =
        std::isfinite(spread) && std::isfinite(soft.displacement) && std::isfinite(soft.velocity);
    if (spread >= 0.0 && finite) return;
    throw std::invalid_argument(
        sentence("fpu_law: the spread must be finite and not negative, and the soft motion finite, got {}, "
                 "{} and {}",
                 spread, soft.displacement, soft.velocity));
  }

  /// An initial distribution with the soft energy omega^2, half in motion (m y_0^2/2) and half in the two
  /// springs at the ends (x_0^4/2 together; those between start at rest).
  static fpu_law soft_dominated(const fpu_chain<Pairs>& chain) {
    const auto m = static_cast<double>(chain.pairs());
    return fpu_law(chain, 1.0, {std::sqrt(chain.omega()), chain.omega() / std::sqrt(m)});
  }

  phase_point<double, fpu_chain<Pairs>::dimension> operator()(std::uint64_t seed, std::uint64_t n) const {
    using state = vector<double, fpu_chain<Pairs>::dimension>;
    phase_point<double, fpu_chain<Pairs>::dimension> start{state(2 * pairs_), state(2 * pairs_)};
    state normals(2 * pairs_);
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, normals);
    const double half = std::sqrt(0.5);
    for (Eigen::Index i = 0; i < pairs_; ++i) {
      const double x1 = (1.0 + spread_ * normals[2 * i]) / omega_;
      const double y1 = 1.0 + spread_ * normals[2 * i + 1] / omega_;
      start.q[2 * i] = (soft_.displacement - x1) * half;
      start.q[2 * i + 1] = (soft_.displacement + x1) * half;
      start.p[2 * i] = (soft_.velocity - y1) * half;
      start.p[2 * i + 1] = (soft_.velocity + y1) * half;
    }
    return start;
  }
  std::string description() const {
    std::string text = sentence("fpu_law(omega={}", omega_);
    if (spread_ != 1.0) text += sentence(", spread={}", spread_);
    if (soft_.displacement != 1.0 || soft_.velocity != 1.0) {
      text += sentence(", x_0={}, y_0={}", soft_.displacement, soft_.velocity);
    }
    return text + ")";
  }

 private:
  Eigen::Index pairs_;
  double omega_;
  double spread_;
  soft_motion soft_;
};

/// Ellipses of semi-major axis 1 and one eccentricity, run through counterclockwise: their orientation is
/// uniform, and so is the time since the pericentre, as the mean anomaly M. With E - e sin E = M,
///   q = (cos E - e, sqrt(1 - e^2) sin E),  p = (-sin E, sqrt(1 - e^2) cos E)/(1 - e cos E)
/// [hairer_lubich_wanner_2006, section I.2], turned. All have H = -1/2.
class kepler_law {
 public:
  /// Throws std::invalid_argument unless 0 <= eccentricity < 1.
  explicit kepler_law(double eccentricity);

  phase_point<double, 2> operator()(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  /// E of M in -pi..pi, by Newton's method from +-pi: where E - e sin E - M has a curvature of one sign, it
  /// comes nearer from one side until rounding stops it.
  double eccentric_anomaly(double mean) const;

  double eccentricity_;
};

/// A Lennard-Jones cluster at rest is struck: every start is cluster_at_rest with normal momenta of variance
/// kT, projected to where the whole neither moves nor turns. Each of the other directions has kinetic energy
/// kT/2 in the mean, and shares it with the potential later. From some kT = 0.3 on atoms leave.
template <int Space, int Atoms>
class lennard_jones_law {
  using state = vector<double, lennard_jones<Space, Atoms>::dimension>;

 public:
  /// Throws std::invalid_argument if the temperature, an energy, is negative or not finite.
  lennard_jones_law(const lennard_jones<Space, Atoms>& system, double temperature)
      : rest_(cluster_at_rest(system)), temperature_(temperature) {
    if (!(temperature >= 0.0) || !std::isfinite(temperature)) {
      throw std::invalid_argument(sentence(
          "lennard_jones_law: the temperature must be finite and not negative, got {}", temperature));
    }
    find_rigid_motions(system.space());
  }

  phase_point<double, lennard_jones<Space, Atoms>::dimension> operator()(std::uint64_t seed,
                                                                         std::uint64_t n) const {
    state p(rest_.size());
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, p);
    for (Eigen::Index i = 0; i < p.size(); ++i) p[i] *= std::sqrt(temperature_);
    for (const state& motion : rigid_motions_) remove(motion, p);
    return {rest_, p};
  }
  std::string description() const {
    return sentence("lennard_jones_law(temperature={})", in_digits(temperature_, 6));
  }

 private:
  static double product(const state& x, const state& y) {
    double sum = 0.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) sum += x[i] * y[i];
    return sum;
  }
  static void remove(const state& unit, state& from) {
    const double along = product(unit, from);
    for (Eigen::Index i = 0; i < from.size(); ++i) from[i] -= along * unit[i];
  }

  /// An orthonormal basis of shifts and turns, by Gram and Schmidt. Atoms on a line have a turn less.
  void find_rigid_motions(Eigen::Index space) {
    const auto add = [&](state motion) {
      for (const state& other : rigid_motions_) remove(other, motion);
      const double length = std::sqrt(product(motion, motion));
      constexpr double rounding = 1e-9;
      if (length > rounding) rigid_motions_.push_back(motion / length);
    };
    for (Eigen::Index axis = 0; axis < space; ++axis) {
      state shift = state::Zero(rest_.size());
      for (Eigen::Index i = axis; i < shift.size(); i += space) shift[i] = 1.0;
      add(shift);
    }
    for (Eigen::Index a = 0; a < space; ++a) {
      for (Eigen::Index b = a + 1; b < space; ++b) {
        state turn = state::Zero(rest_.size());
        for (Eigen::Index i = 0; i < turn.size(); i += space) {
          turn[i + a] = -rest_[i + b];
          turn[i + b] = rest_[i + a];
        }
        add(turn);
      }
    }
  }

  state rest_;
  double temperature_;
  std::vector<state> rigid_motions_;
};

/// A crystal that is heated: atoms on a face-centred cubic lattice that fills the box, with normal momenta of
/// variance kT, less their mean. Where there are fewer atoms than sites, 4 n^3, vacancies are spread evenly.
/// Half of the kinetic energy goes into the potential when the crystal melts: kT = 1.44 becomes some 0.72 at
/// the density 0.8442.
class lennard_jones_liquid_law {
 public:
  /// Throws std::invalid_argument if the temperature, an energy, is negative or not finite.
  lennard_jones_liquid_law(const lennard_jones_liquid& system, double temperature)
      : atoms_(system.atoms()), side_(system.side()), temperature_(temperature) {
    if (!(temperature >= 0.0) || !std::isfinite(temperature)) {
      throw std::invalid_argument(sentence(
          "lennard_jones_liquid_law: the temperature must be finite and not negative, got {}", temperature));
    }
    while (4 * cells_ * cells_ * cells_ < atoms_) ++cells_;
  }

  phase_point<double, Eigen::Dynamic> operator()(std::uint64_t seed, std::uint64_t n) const {
    phase_point<double, Eigen::Dynamic> start{Eigen::VectorXd(3 * atoms_), Eigen::VectorXd(3 * atoms_)};
    const Eigen::Index sites = 4 * cells_ * cells_ * cells_;
    for (Eigen::Index i = 0; i < atoms_; ++i) {
      // The largest site with site atoms <= i sites, in two parts, as the product of both may not fit.
      const Eigen::Index site = i * (sites / atoms_) + i * (sites % atoms_) / atoms_;
      for (Eigen::Index axis = 0; axis < 3; ++axis) start.q[3 * i + axis] = site_on_axis(site, axis);
    }
    standard_normals(seed, {.trajectory = n, .purpose = noise_purpose::initial_state}, start.p);
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      double sum = 0.0;
      for (Eigen::Index i = axis; i < start.p.size(); i += 3) sum += start.p[i];
      const double mean = sum / static_cast<double>(atoms_);
      for (Eigen::Index i = axis; i < start.p.size(); i += 3) {
        start.p[i] = (start.p[i] - mean) * std::sqrt(temperature_);
      }
    }
    return start;
  }
  std::string description() const {
    return sentence("lennard_jones_liquid_law(temperature={})", in_digits(temperature_, 6));
  }

 private:
  /// Four sites a cell: a corner, and the middles of the three faces that meet there.
  double site_on_axis(Eigen::Index site, Eigen::Index axis) const {
    const Eigen::Index of_cell = site % 4;
    const Eigen::Index cell = site / 4;
    const Eigen::Index place = axis == 0   ? cell % cells_
                               : axis == 1 ? cell / cells_ % cells_
                                           : cell / (cells_ * cells_);
    const bool is_moved = of_cell != 0 && of_cell != axis + 1;
    return side_ * (static_cast<double>(place) + (is_moved ? 0.5 : 0.0)) / static_cast<double>(cells_);
  }

  Eigen::Index atoms_;
  double side_;
  double temperature_;
  Eigen::Index cells_ = 1;  // along each axis
};

}  // namespace nysalt
