// SPDX-License-Identifier: BSL-1.0
// What the library calls of a local system whose type it does not know.
#pragma once

#include <span>

#include "nysalt/local_system.hpp"

namespace nysalt::detail {

/// A drift or a kick, with the step folded into the coefficient.
struct tile_letter {
  double coefficient = 0.0;
  bool is_kick = false;
  bool keeps_force = false;  ///< of a kick: the force is left in f
};

/// Consecutive sites in a buffer. Next to a neighbour the buffer begins or ends with a halo of sites whose
/// values expire: each kick changes reach() sites fewer than it reads.
struct tile {
  columns q;
  columns p;
  columns f;
  Eigen::Index begin;       ///< the first site of the buffer
  Eigen::Index end;         ///< one past the last site
  bool has_left_neighbour;  ///< no: the system ends there
  bool has_right_neighbour;
};

/// How the sites of a system are arranged.
struct site_layout {
  Eigen::Index sites = 0;
  Eigen::Index components = 1;
  Eigen::Index reach = 1;
  Eigen::Index sites_of_row = 1;
  bool is_periodic = false;
  bool has_energy = false;
};

/// The layout, with a reach of at least 1. Throws std::invalid_argument unless sites and components make up
/// `size` coordinates, the reach is not negative, and the sites are whole rows.
site_layout required(const site_layout& layout, Eigen::Index size);

/// The functions of a local system on tiles.
class site_kernels {
 public:
  virtual ~site_kernels() = default;
  virtual site_layout layout() const = 0;
  /// Applies the letters. A halo must be as wide as all kicks together reach.
  virtual void advance(const tile& x, std::span<const tile_letter> letters) const = 0;
  /// K + V of sites begin .. end - 1; of layouts that have an energy.
  virtual double energy(const tile& x, Eigen::Index begin, Eigen::Index end) const = 0;
};

/// The site kernels of S.
template <LocalSystem S>
class typed_site_kernels final : public site_kernels {
 public:
  /// Refers to the system. Throws std::invalid_argument if its sites do not make up its coordinates.
  explicit typed_site_kernels(const S& system)
      : system_(&system), layout_(required(layout_of(system), size(system))) {}

  site_layout layout() const final { return layout_; }

  void advance(const tile& x, std::span<const tile_letter> letters) const final {
    const Eigen::Index reach = layout_.reach;
    Eigen::Index begin = x.begin;
    Eigen::Index end = x.end;
    for (const tile_letter& letter : letters) {
      if (!letter.is_kick) {
        drift(x, letter.coefficient, begin, end);
        continue;
      }
      if (x.has_left_neighbour) begin += reach;
      if (x.has_right_neighbour) end -= reach;
      kick(x, letter, begin, end);
    }
  }

  double energy(const tile& x, Eigen::Index begin, Eigen::Index end) const final {
    double twice = 0.0;
    for (Eigen::Index i = begin; i < end; ++i) {
      for (Eigen::Index c = 0; c < S::components; ++c) {
        double square = x.p(c, i) * x.p(c, i);
        if constexpr (HasInverseMass<S>) square *= inverse_mass(c, i);
        twice += square;
      }
    }
    if constexpr (HasPotentialInRange<S>) {
      return 0.5 * twice + system_->template potential_in_range<double>(x.q, begin, end);
    }
    return 0.5 * twice;
  }

 private:
  static site_layout layout_of(const S& system) {
    site_layout result{system.sites(),       S::components,         system.reach(), 1,
                       system.is_periodic(), HasPotentialInRange<S>};
    if constexpr (requires { system.sites_of_row(); }) result.sites_of_row = system.sites_of_row();
    return result;
  }
  double inverse_mass(Eigen::Index c, Eigen::Index i) const {
    const Eigen::Index sites = system_->sites();
    const Eigen::Index site = (i % sites + sites) % sites;  // of an image
    return system_->inverse_mass(S::components * site + c);
  }

  // The same operations as drift::apply and kick_of::apply, for the same bits.
  void drift(const tile& x, double coefficient, Eigen::Index begin, Eigen::Index end) const {
    for (Eigen::Index c = 0; c < S::components; ++c) {
      for (Eigen::Index i = begin; i < end; ++i) {
        if constexpr (HasInverseMass<S>) {
          x.q(c, i) += x.p(c, i) * (coefficient * inverse_mass(c, i));
        } else {
          x.q(c, i) += x.p(c, i) * coefficient;
        }
      }
    }
  }
  void kick(const tile& x, const tile_letter& letter, Eigen::Index begin, Eigen::Index end) const {
    if constexpr (HasKickInRange<S>) {
      if (!letter.keeps_force) {
        return system_->template kick_in_range<double>(x.q, x.p, letter.coefficient, begin, end);
      }
    }
    system_->template force_in_range<double>(x.q, x.f, begin, end);
    for (Eigen::Index c = 0; c < S::components; ++c) {
      for (Eigen::Index i = begin; i < end; ++i) x.p(c, i) += x.f(c, i) * letter.coefficient;
    }
  }

  const S* system_;
  site_layout layout_;
};

}  // namespace nysalt::detail
