// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <utility>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/ensembles/burn_in.hpp"

namespace nysalt {

namespace detail {
/// kT. Throws std::invalid_argument unless the bath has a temperature, and that is positive.
double temperature_to_sample(const bath& its);
}  // namespace detail

/// Independent states from exp(-H/kT) of a system in a bath that has a temperature: each is the end of a
/// chain of its own, which begins at a state of another ensemble with fresh momenta and follows BAOAB. The
/// law does not depend on the friction, so the chains have a stronger one than the bath, and forget their
/// starts much sooner. BAOAB is exact in the law of q for harmonic systems, up to h omega = 2, so their step
/// is large. At the end the momenta are drawn from Maxwell's law, p_i ~ N(0, m_i kT): only the law of q has
/// an error.
///
/// Friction, step and length are found by pilot chains when the ensemble is made (burn_in.hpp): the length is
/// 20 times the longest autocorrelation time of kinetic energy, potential energy, virial and, where the
/// system declares modes that all have a frequency, the energy of the slowest; the step is halved until no
/// bias against half of it shows, and equipartition is checked; report() tells. What none of the pilots sees
/// in its time is not sampled: valleys behind barriers that no chain crosses. Nor do means over all tell of
/// one motion among very many that is much slower than most and is no declared mode.
///
/// Cost of a state: report().steps steps of BAOAB; many trajectories at a time in the lanes of packs.
template <NystromSystem S, Ensemble<S> E>
class gibbs {
 public:
  /// Throws std::invalid_argument if the bath has no temperature or that is zero, if an option cannot be, or
  /// if there is neither a step nor frequency_bands(); std::runtime_error if chains diverge, do not become
  /// stationary, or a check fails.
  gibbs(const detail::bathed_system<S>& system, E from, const burn_in_options& options = {})
      : alone_(system.alone()),
        from_(std::move(from)),
        temperature_(detail::temperature_to_sample(system.bath())) {
    report_ = burn_in_search<S, E>(alone_, temperature_, from_, options).find();
  }

  /// How chains are burned in, and what was checked.
  const burn_in_report& report() const { return report_; }

  /// The start of trajectory n. Throws std::runtime_error if its chain diverges.
  phase_point<double, S::dimension> operator()(std::uint64_t seed, std::uint64_t n) const {
    return block<double>(seed, static_cast<std::int64_t>(n), 1);
  }

  /// Those of `count` trajectories from the first on, one in each lane of T, with the bits that each has
  /// alone. Throws std::runtime_error if one diverges.
  template <class T>
  phase_point<T, S::dimension> block(std::uint64_t seed, std::int64_t first, int count) const {
    const burn_in_chains<S> chains(alone_, temperature_, report_.friction, report_.step, seed);
    auto run = chains.open(sound_starts<T>(alone_, from_, seed, first, count), first, count);
    run.go_on(report_.steps);
    for (int k = 0; k < count; ++k) {
      if (!run.diverged_at(k)) continue;
      throw std::runtime_error(sentence(
          "gibbs: chain {} of seed {} diverged at time {}: the motion of {} is not confined", first + k, seed,
          in_digits(static_cast<double>(*run.diverged_at(k)) * report_.step, 6), describe(alone_)));
    }
    auto x = run.synchronous();
    chains.draw_momenta(x, first, report_.steps);
    return x;
  }

  std::string description() const {
    return sentence("gibbs(temperature={}, from {}, burned in for {} with friction {} and step {})",
                    in_digits(temperature_, 6), from_.description(), in_digits(report_.length, 4),
                    in_digits(report_.friction, 4), in_digits(report_.step, 4));
  }

 private:
  S alone_;
  E from_;
  double temperature_;
  burn_in_report report_;
};

/// Deduced from the system in its bath and the ensemble.
template <NystromSystem S, class E>
gibbs(const in_bath<S>&, E) -> gibbs<S, E>;
/// Deduced likewise.
template <NystromSystem S, class E>
gibbs(const in_bath<S>&, E, const burn_in_options&) -> gibbs<S, E>;

}  // namespace nysalt
