// SPDX-License-Identifier: BSL-1.0
// Methods at one step against one reference, along many trajectories, by one measure or several.
#pragma once

#include <ranges>
#include <span>
#include <utility>
#include <vector>

#include "nysalt/analysis/trajectory_errors_result.hpp"
#include "nysalt/analysis/trajectory_options.hpp"
#include "nysalt/detail/any_reference.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// A vector, array or span of methods of one type.
template <class C>
concept Methods =
    std::ranges::contiguous_range<C> && std::ranges::sized_range<C> && Method<std::ranges::range_value_t<C>>;

namespace detail {

/// In how many parts of a step methods need the noise of a path: 0 if the system is in no noisy bath.
int parts_of_noise(const model& system, std::span<const tabulated> methods);

std::vector<trajectory_errors_result> trajectory_errors(const model& system, const reference_value& reference,
                                                        const initial_states& ensemble,
                                                        std::span<const tabulated> methods,
                                                        std::span<const error_measure> measures,
                                                        const trajectory_options& options);

}  // namespace detail

/// Errors by each of several measures, in their order: runs the reference once along each trajectory, and
/// every method beside it, as many trajectories at a time as there are lanes; all measures read the same
/// runs. In a bath all see the reference's noise, each in the parts of a step that its letters O cover. The
/// reference's own error is taken on the first 16 trajectories, along noisy paths with error_over_difference.
/// If no measure needs a reference, none runs but for its noise. Neither lanes, threads nor ranks change a
/// bit, nor does a measure those of another.
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
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Methods Given>
std::vector<trajectory_errors_result> trajectory_errors(const S& system, const R& reference,
                                                        const E& ensemble, const Given& methods,
                                                        std::span<const error_measure> measures,
                                                        const trajectory_options& options) {
  std::vector<tabulated> tables;
  for (const auto& method : methods) tables.push_back(detail::table_for(method, system, options.step));
  return detail::trajectory_errors(system, detail::reference_value(detail::reference_of(system, reference)),
                                   ensemble, tables, measures, options);
}

/// Errors by one measure.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Methods Given>
trajectory_errors_result trajectory_errors(const S& system, const R& reference, const E& ensemble,
                                           const Given& methods, const error_measure& measure,
                                           const trajectory_options& options) {
  return std::move(
      trajectory_errors(system, reference, ensemble, methods, std::span(&measure, 1), options).front());
}

/// Errors of one method, by one measure or several.
template <SeparableSystem S, Reference<S> R, Ensemble<S> E, Method M>
auto trajectory_errors(const S& system, const R& reference, const E& ensemble, const M& method,
                       const auto& measures, const trajectory_options& options) {
  return trajectory_errors(system, reference, ensemble, std::span<const M>(&method, 1), measures, options);
}

}  // namespace nysalt
