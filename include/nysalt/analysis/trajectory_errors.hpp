// SPDX-License-Identifier: BSL-1.0
// Errors of methods at one step against one reference, along many trajectories.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <ranges>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/divergence.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

namespace detail {

/// All coordinates times 1 + relative * (normal numbers of their own), each a pure function of seed and
/// trajectory; lane 0 holds number `first`. What is 0 stays so.
template <class T, int N>
phase_point<T, N> perturbed(phase_point<T, N> x, double relative, std::uint64_t seed, std::uint64_t first) {
  phase_point<T, N> normals = x;
  noise_counter at = {.trajectory = first, .purpose = noise_purpose::perturbation};
  standard_normals(seed, at, normals.q);
  at.slot += slots_for(static_cast<std::uint64_t>(x.size()));
  standard_normals(seed, at, normals.p);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    x.q[i] = x.q[i] * (normals.q[i] * relative + 1.0);
    x.p[i] = x.p[i] * (normals.p[i] * relative + 1.0);
  }
  return x;
}

/// Number of the sample, in each lane, since which the errors of perturbed starts so far exceed half of the
/// null model's, to the end: a quarter of them where they are squares, so that roots are halved. A sum that
/// falls behind again begins anew: what hardly moves at first leaves the null model without errors for a few
/// samples.
template <class T>
class predictable_samples {
 public:
  /// `how` says whether sums of errors are of squares: all but averaging::mean.
  explicit predictable_samples(averaging how) : share_(how == averaging::mean ? 0.5 : 0.25) {}

  /// Takes the sums of errors over the samples up to i = 1, 2, ..., in this order.
  void add(std::int64_t i, const T& perturbed, const T& null_model) {
    const auto within = perturbed <= null_model * share_;  // not if a sum has gone to NaN
    exceeded_at_.reset(within);
    exceeded_at_.take(!within, i);
  }

  /// The first sample in lane k from which on the errors are not within; infinite if they are to the end.
  double until(int k) const {
    const auto& exceeded_at = exceeded_at_[k];
    return exceeded_at ? static_cast<double>(*exceeded_at) : std::numeric_limits<double>::infinity();
  }

 private:
  double share_;
  first_in_lanes<T> exceeded_at_{};
};

}  // namespace detail

// Errors of the runs of one method.

namespace detail {

/// The quantiles of errors that are reported.
inline constexpr std::array shown_quantiles{0.05, 0.25, 0.5, 0.75, 0.95};

}  // namespace detail

/// Error and cost of a method.
struct method_error {
  /// Spread of the errors of single trajectories about the one number that is made of them: each is the error
  /// that this trajectory would have without the others, in the unit of the whole.
  struct distribution {
    tail largest{};     ///< largest score; the error is the mean of the scores
    estimate median{};  ///< median with its standard error
    std::array<double, detail::shown_quantiles.size()> quantiles{};  ///< scores at shown_quantiles
  };

  estimate error;                                ///< mean over the trajectories that did not diverge
  std::int64_t diverged = 0;                     ///< number of trajectories that diverged
  std::vector<diverged_trajectory> diverged_at;  ///< steps of divergence, in the order of the trajectories
  double evaluations_per_time = 0.0;             ///< force evaluations per unit time, start-up included
  std::vector<double> of_each{};  ///< contribution of each trajectory to the error; NaN if it diverged
  std::vector<double> own{};      ///< the error of each by itself, in the unit of the whole; NaN likewise
  distribution spread{};          ///< spread of the trajectories that did not diverge
};

// Errors of methods, and of their reference, along many trajectories by one measure.

/// Errors of all methods by one measure, with null model and reference error.
struct trajectory_errors_result {
  std::vector<method_error> methods;        ///< methods in the order in which they were given
  std::optional<estimate> reference_error;  ///< against its finer self; nothing if no reference was needed
  std::string reference;                    ///< description of the reference, or empty
  std::optional<estimate> null_model;       ///< error of the prediction that nothing moves, if requested
  std::optional<double> predictable_until;  ///< a time, perhaps infinite, if asked for
  double unit = 1.0;                        ///< divisor of the errors: a mean over all trajectories
};

/// Number, length and seed of the trajectories to compare.
struct trajectory_options {
  double step;                      ///< samples are at t_i = i step, i = 1..steps
  std::int64_t steps;               ///< steps of each trajectory
  std::int64_t trajectories = 400;  ///< independent starts
  std::uint64_t seed = 1;           ///< seed of the starts and the noise
  nysalt::execution execution{};    ///< threads, ranks and progress
  bool null_model = false;          ///< whether to measure it; what is left out costs nothing
  /// Relative, of starts: how long are trajectories predictable? Nothing: that is not measured.
  std::optional<double> perturbation = {};
  /// Errors are means over [0, horizon], which ends within the last step (sample_weights), so that methods of
  /// other steps are judged over the same time. Nothing: over all samples alike.
  std::optional<double> horizon = {};
};

namespace detail {

/// Throws std::invalid_argument unless there are steps and trajectories, and a score of each method, measure
/// and trajectory, and an interval of samples of `width` numbers (of all measures) for each method and
/// thread, fit into the memory of a rank: the scores of all trajectories come to each of them.
void require_room(const trajectory_options& options, std::size_t methods, std::size_t width,
                  std::size_t measures = 1);

}  // namespace detail

// Methods at one step against one reference, along many trajectories, by one measure or several.

/// A vector, array or span of methods of one type.
template <class C>
concept Methods =
    std::ranges::contiguous_range<C> && std::convertible_to<std::ranges::range_value_t<C>, nysalt::method>;

namespace detail {

/// In how many parts of a step methods need the noise of a path: 0 if the system is in no noisy bath.
int parts_of_noise(const model& system, std::span<const nysalt::method> methods);

std::vector<trajectory_errors_result> trajectory_errors(const model& system, const reference& reference,
                                                        const initial_states& ensemble,
                                                        std::span<const nysalt::method> methods,
                                                        std::span<const error_measure> measures,
                                                        const trajectory_options& options);

}  // namespace detail

/// Errors by each of several measures, in their order: runs the reference once along each trajectory, and
/// every method beside it, as many trajectories at a time as there are lanes; all measures read the same
/// runs. In a bath all see the reference's noise, each in the parts of a step that its letters O cover. The
/// reference's own error is taken on the first 16 trajectories, along noisy paths with error_over_difference.
/// If no measure needs a reference, none runs but for its noise. Neither lanes, threads nor ranks change a
/// bit, nor does one measure change a bit of another.
///
/// For the measures that need a reference, if the options ask for it:
///   null_model         the error of what stays as it was at the start, over all trajectories;
///   predictable_until  a second reference starts from q_i (1 + perturbation xi_i), p_i likewise, with normal
///                      xi and the same noise, on the first 16 trajectories. There a trajectory is
///                      predictable until the errors so far of that run exceed half of the null model's, by
///                      root mean squares (by means for averaging::mean), and do so to the end; this is the
///                      median. Infinite if that does not come to pass, so a longer horizon can give more.
///
/// System, reference, ensemble and measures are used by several threads at once. Ranks share the trajectories
/// by whole leaves, and all get the results. Memory: 24 bytes for each measure, method and trajectory on each
/// rank, 16 for each measure and trajectory, and none that grows with the steps. Messages: once at the end,
/// these bytes. Throws std::invalid_argument if there is not one measure, step or trajectory, they do not fit
/// into memory, the perturbation is not positive, the horizon is not within the last step, a start does not
/// fit, or what method, reference and measure refuse; std::runtime_error if the reference is not finite. Of
/// several trajectories in trouble it is the first that is named.
template <SeparableSystem S, Ensemble<S> E, Methods Given>
std::vector<trajectory_errors_result> trajectory_errors(const S& system, const reference& reference,
                                                        const E& ensemble, const Given& methods,
                                                        std::span<const error_measure> measures,
                                                        const trajectory_options& options) {
  std::vector<nysalt::method> tables;
  for (const auto& method : methods) tables.push_back(method);
  return detail::trajectory_errors(system, reference, ensemble, tables, measures, options);
}

/// Errors by one measure.
template <SeparableSystem S, Ensemble<S> E, Methods Given>
trajectory_errors_result trajectory_errors(const S& system, const reference& reference, const E& ensemble,
                                           const Given& methods, const error_measure& measure,
                                           const trajectory_options& options) {
  return std::move(
      trajectory_errors(system, reference, ensemble, methods, std::span(&measure, 1), options).front());
}

/// Errors of one method, by one measure or several.
template <SeparableSystem S, Ensemble<S> E>
auto trajectory_errors(const S& system, const reference& reference, const E& ensemble,
                       const nysalt::method& method, const auto& measures,
                       const trajectory_options& options) {
  return trajectory_errors(system, reference, ensemble, std::span<const nysalt::method>(&method, 1), measures,
                           options);
}

}  // namespace nysalt
