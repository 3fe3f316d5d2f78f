// SPDX-License-Identifier: BSL-1.0
// Initial states from a Gibbs distribution: by burn-in, in closed form of linear forces, or from one long
// trajectory.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "nysalt/ensemble.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/model.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

/// 0 is for what is to be found.
struct burn_in_options {
  double friction =
      0.0;            ///< friction of the chains; 0: the one of four with the shortest autocorrelation time
  double step = 0.0;  ///< initial step; 0: omega h = 1/2 at the highest frequency, declared or at the starts
  double length = 0.0;  ///< a time; 0: 20 times the longest autocorrelation time, or more from hot starts
  int pilots = 256;     ///< number of chains that are measured
  std::int64_t most_steps = 10'000'000;  ///< largest number of steps of a pilot until it is stationary
  std::uint64_t seed = 1;                ///< seed of the pilots
  nysalt::execution execution{};         ///< of the pilots; only the number of threads is used
};

namespace detail {

inline constexpr std::size_t watched_numbers = 4;  ///< number of watched observables
/// Names of the observed quantities in messages.
inline constexpr std::array watched_names = {"half-step kinetic temperature", "virial", "potential energy",
                                             "energy of the slowest mode"};

/// Values, one for each watched observable, in the order of `watched`.
template <class T>
using of_watched = std::array<T, watched_numbers>;

}  // namespace detail

/// Length and parameters of a burn-in, and what the pilots showed.
struct burn_in_report {
  /// The observed quantities, all in units of kT: the kinetic temperature between two steps, the virial
  /// -sum_i q_i f_i / N, whose mean is 1 where the motion is confined, V/N, and the energy of the slowest
  /// mode where it is known, else 0.
  enum class watched : std::uint8_t { kinetic, virial, potential, slowest };

  /// A mean over independent chains whose expectation is 0, and its standard error.
  struct discrepancy {
    double mean = 0.0;            ///< mean over chains
    double standard_error = 0.0;  ///< standard error of that mean
    /// Whether the mean is significant: 4.5 standard errors, which chance exceeds once in 150'000 times. One
    /// whose numbers have overflowed is.
    bool shows() const { return !(std::abs(mean) <= 4.5 * standard_error && std::isfinite(standard_error)); }
  };

  double friction = 0.0;   ///< friction of the chains; the distribution of q does not depend on it
  double step = 0.0;       ///< h of BAOAB
  std::int64_t steps = 0;  ///< steps of every chain
  double length = 0.0;     ///< steps * step
  /// Longest integrated autocorrelation time, 2 int_0^inf rho(t) dt, of what is watched.
  double tau = 0.0;
  bool confined = false;  ///< whether the motion is confined; else the virial means nothing
  int halvings = 0;       ///< halvings of the first step until no bias showed
  detail::of_watched<discrepancy> bias = {};  ///< means with this step, less those with half of it
  detail::of_watched<discrepancy> excess =
      {};  ///< mean at the end of the burn-in, less the value of equipartition
  detail::of_watched<discrepancy> to_forget =
      {};                ///< mean at the end of the burn-in, less that in an equally long time after it
  double seconds = 0.0;  ///< wall time that finding this took

  /// Entry of bias, excess or to_forget.
  const discrepancy& of(const detail::of_watched<discrepancy>& all, watched what) const {
    return all[static_cast<std::size_t>(what)];
  }
};

namespace detail {

/// The ends of burnt-in chains, of a dimension that is known at run time.
class gibbs_states {
 public:
  gibbs_states(const model& in_bath, const initial_states& from, const burn_in_options& options);

  /// The burn-in of the chains, and what was checked.
  const burn_in_report& report() const { return report_; }
  phase_point<double, Eigen::Dynamic> start(std::uint64_t seed, std::uint64_t n) const {
    return chains_(seed, n);
  }
  std::string description() const { return chains_.description(); }

 protected:
  burn_in_report report_;
  initial_states chains_;
};

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
class gibbs : public detail::in_dimension<detail::gibbs_states, N> {
 public:
  /// The Gibbs distribution of a system in a bath. Throws std::invalid_argument if the bath has no
  /// temperature or that is zero, if an option is out of range, or if there are neither a step nor
  /// frequencies or forces at the starts; std::runtime_error if chains diverge, do not become stationary, or
  /// a check fails.
  template <HasBath S, Ensemble<S> E>
    requires(NystromSystem<S> && S::dimension == N)
  gibbs(const S& system, const E& from, const burn_in_options& options = {})
      : detail::in_dimension<detail::gibbs_states, N>(system, from, options) {}

  /// Initial states of `count` trajectories from the first on, one in each lane of T, with the bits that each
  /// has without the others. Throws std::runtime_error if one diverges.
  template <class T>
  phase_point<T, N> block(std::uint64_t seed, std::int64_t first, int count) const {
    const auto x = this->chains_.template block<T>(seed, first, count);
    return {x.q, x.p};
  }
};

/// Takes the dimension from the system.
template <HasBath S, class E>
gibbs(const S&, const E&) -> gibbs<S::dimension>;
/// Takes the dimension from the system.
template <HasBath S, class E>
gibbs(const S&, const E&, const burn_in_options&) -> gibbs<S::dimension>;

namespace detail {

/// The law of gibbs_of_modes.
class modal_gibbs {
 public:
  modal_gibbs(const model& system, double temperature);
  phase_point<double, Eigen::Dynamic> start(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  double temperature_;
  std::shared_ptr<const modal_coordinates> modes_;
};

}  // namespace detail

/// Independent states from exp(-H/kT) of a linear system, mode by mode: omega_k x_k and y_k are normal with
/// variance kT. Exact, and nothing has to be burned in.
template <int N>
class gibbs_of_modes : public detail::in_dimension<detail::modal_gibbs, N> {
 public:
  /// Throws std::invalid_argument unless the force is the linear one of the modes, all of these have a
  /// frequency, and the temperature is finite and positive.
  template <HasModes S>
    requires(S::dimension == N)
  gibbs_of_modes(const S& system, double temperature)
      : detail::in_dimension<detail::modal_gibbs, N>(system, temperature) {}
};

/// Length of the trajectory, and the number of states kept.
struct long_trajectory_options {
  double length = 25'000.0;            ///< a time, burn-in included
  double burn_in = 0.0;                ///< a time at its beginning, of which no state is kept
  double step = 0.0;                   ///< h of BAOAB; 0: omega h = 0.1 at the highest frequency
  std::int64_t most_states = 100'000;  ///< largest number of states kept, evenly thinned; at most 100000
  std::uint64_t seed = 1;              ///< seed of the start and the noise
};

namespace detail {

/// The law of one_long_trajectory.
class long_trajectory {
 public:
  long_trajectory(const model& in_bath, const initial_states& from, const long_trajectory_options& options);

  std::size_t states() const { return states_->size(); }  ///< number of states kept
  /// One of the states.
  const phase_point<double, Eigen::Dynamic>& start(std::uint64_t seed, std::uint64_t n) const;
  std::string description() const;

 private:
  long_trajectory_options options_;
  std::string from_;
  double step_ = 0.0;
  std::shared_ptr<const std::vector<phase_point<double, Eigen::Dynamic>>> states_;
};

}  // namespace detail

/// States picked at random, with repetition, from one trajectory of a system in its bath, by BAOAB from start
/// 0 of another ensemble [li_lu_tao_ye_2023]. They depend on each other as far as the trajectory remembers:
/// of friction gamma it holds no more than about gamma T/2 independent ones, and without a burn-in its way
/// down from the start stays among them; independent states of the invariant distribution are gibbs. On-step
/// momenta have the distribution of BAOAB, whose variance is low by (omega h)^2/4. Memory: the states that
/// are kept.
template <int N>
class one_long_trajectory : public detail::in_dimension<detail::long_trajectory, N> {
 public:
  /// Throws std::invalid_argument if the options are out of range, or there are neither a step nor
  /// frequencies or forces at the starts; std::runtime_error if the trajectory diverges.
  template <HasBath S, Ensemble<S> E>
    requires(S::dimension == N)
  one_long_trajectory(const S& system, const E& from, const long_trajectory_options& options = {})
      : detail::in_dimension<detail::long_trajectory, N>(system, from, options) {}
};

/// Takes the dimension from the system.
template <HasBath S, class E>
one_long_trajectory(const S&, const E&) -> one_long_trajectory<S::dimension>;
/// Takes the dimension from the system.
template <HasBath S, class E>
one_long_trajectory(const S&, const E&, const long_trajectory_options&) -> one_long_trajectory<S::dimension>;

}  // namespace nysalt
