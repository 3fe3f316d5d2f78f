// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensemble.hpp"
#include "nysalt/noises/counter_based.hpp"
#include "nysalt/systems/lennard_jones_liquid.hpp"

namespace nysalt {

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
