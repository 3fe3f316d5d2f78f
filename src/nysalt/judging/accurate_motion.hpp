// SPDX-License-Identifier: BSL-1.0
// The motion itself, by an accurate method: its kinetic energy, and states along it.
#pragma once

#include <cstdint>
#include <vector>

#include "nysalt/judgement.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt::detail {

using states = std::vector<phase_point<double, Eigen::Dynamic>>;

/// Median of some numbers, which are put into another order; 0 of none.
double median_of(std::vector<double>& numbers);

/// Parts of a step that an accurate method takes: of the highest frequency that is declared less than a
/// radian each, far inside its window.
double parts_of_step(const model& system, double step);
/// Beyond this number of parts no accurate motion is computed: nothing is known of what is lost.
constexpr double most_parts = 64.0;

/// What an accurate motion shows.
struct accurate_motion {
  double kinetic_energy = 0.0;  // median over trajectories and times; 0: not known
  states seen;                  // states along it, typical ones first
};

/// Without a bath. Cost: an eighth of `evaluations`.
accurate_motion follow(const model& system, const states& starts, double step, std::int64_t evaluations,
                       const judging_options& options);

}  // namespace nysalt::detail
