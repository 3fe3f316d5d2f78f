// SPDX-License-Identifier: BSL-1.0
// Force evaluations of a trajectory.
#pragma once

#include <cstdint>

#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

namespace detail {
std::int64_t evaluations_of_run(const model& system, const tabulated& method, double step, std::int64_t steps,
                                const phase_point<double, Eigen::Dynamic>& start);
}  // namespace detail

/// Force evaluations of one whole trajectory of `steps` steps that is observed once, at the end, start-up
/// included: those that follow from the word; of a black box counted over the first two steps, as every step
/// after them costs the same.
template <SeparableSystem S, Method M>
std::int64_t evaluations_of_run(const S& system, const M& method, double step, std::int64_t steps,
                                const phase_point<double, S::dimension>& start) {
  return detail::evaluations_of_run(system, detail::table_for(method, system, step), step, steps,
                                    {start.q, start.p});
}

}  // namespace nysalt
