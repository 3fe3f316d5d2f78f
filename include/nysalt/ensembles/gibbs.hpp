// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <concepts>
#include <cstdint>
#include <memory>
#include <string>

#include "nysalt/detail/over_scalars.hpp"
#include "nysalt/ensembles/burn_in_report.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

namespace detail {

/// The chains of gibbs.
class gibbs_chains {
 public:
  gibbs_chains(const model& in_bath, initial_states from, const burn_in_options& options);

  const burn_in_report& report() const { return report_; }
  template <class T>
  phase_point<T, Eigen::Dynamic> block(std::uint64_t seed, std::int64_t first, int count) const;
  std::string description() const;

 private:
  model base_;
  initial_states from_;
  double temperature_;
  burn_in_report report_;
};

extern template phase_point<double, Eigen::Dynamic> gibbs_chains::block<double>(std::uint64_t, std::int64_t,
                                                                                int) const;
extern template phase_point<lanes, Eigen::Dynamic> gibbs_chains::block<lanes>(std::uint64_t, std::int64_t,
                                                                              int) const;

}  // namespace detail

/// Independent states from exp(-H/kT) of a system in a bath that has a temperature: each is the end of a
/// chain of its own, which begins at a state of another ensemble with fresh momenta and follows BAOAB. The
/// distribution does not depend on the friction, so the chains have a stronger one than the bath, and forget
/// their starts much sooner. BAOAB is exact in the distribution of q for harmonic systems, up to h omega = 2,
/// so their step is large. At the end the momenta are drawn from Maxwell's distribution, p_i ~ N(0, m_i kT):
/// only the distribution of q has an error.
///
/// Friction, step and length are found by pilot chains when the ensemble is made (burn_in.hpp): the length is
/// 20 times the longest autocorrelation time of kinetic energy, potential energy, virial and, where the
/// system declares modes that all have a frequency, the energy of the slowest; the step is halved until no
/// bias against half of it shows, and equipartition is checked; see report(). What none of the pilots sees
/// in its time is not sampled: valleys behind barriers that no chain crosses. Nor do means over all show
/// one motion among very many that is much slower than most and is no declared mode.
///
/// Cost of a state: report().steps steps of BAOAB; many trajectories at a time in the lanes of packs.
template <int N>
class gibbs {
 public:
  /// The Gibbs distribution of a system in a bath. Throws std::invalid_argument if the bath has no
  /// temperature or that is zero, if an option is out of range, or if there are neither a step nor
  /// frequencies or forces at the starts; std::runtime_error if chains diverge, do not become stationary, or
  /// a check fails.
  template <HasBath S, Ensemble<S> E>
    requires(NystromSystem<S> && S::dimension == N)
  gibbs(const S& system, const E& from, const burn_in_options& options = {})
      : chains_(std::make_shared<detail::gibbs_chains>(system, from, options)) {}

  /// The burn-in of the chains, and what was checked.
  const burn_in_report& report() const { return chains_->report(); }

  /// The start of trajectory n. Throws std::runtime_error if its chain diverges.
  phase_point<double, N> operator()(std::uint64_t seed, std::uint64_t n) const {
    return block<double>(seed, static_cast<std::int64_t>(n), 1);
  }

  /// Initial states of `count` trajectories from the first on, one in each lane of T, with the bits that each
  /// has without the others. Throws std::runtime_error if one diverges.
  template <class T>
  phase_point<T, N> block(std::uint64_t seed, std::int64_t first, int count) const {
    if constexpr (std::same_as<T, double> || std::same_as<T, detail::lanes>) {
      const auto x = chains_->block<T>(seed, first, count);
      return {x.q, x.p};
    } else {
      return gather<T, N>(count, [&](int k) { return (*this)(seed, static_cast<std::uint64_t>(first + k)); });
    }
  }

  std::string description() const { return chains_->description(); }

 private:
  std::shared_ptr<const detail::gibbs_chains> chains_;
};

/// Takes the dimension from the system.
template <HasBath S, class E>
gibbs(const S&, const E&) -> gibbs<S::dimension>;
/// Takes the dimension from the system.
template <HasBath S, class E>
gibbs(const S&, const E&, const burn_in_options&) -> gibbs<S::dimension>;

}  // namespace nysalt
