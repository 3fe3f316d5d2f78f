// SPDX-License-Identifier: BSL-1.0
// Learning as `learn` does it, and `compare` for its learned rows.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "learned_row.hpp"
#include "prepared_problem.hpp"
#include "progress.hpp"

namespace nysalt::program {

/// Throws refusal for settings that are invalid at any step; `prefix` is that of their names.
void require_sound(const learning_options& how, const std::string& prefix);

/// Throws refusal for what cannot be learned, before any work is done.
learned_scheme learn_with(const prepared_problem& system, const learn_plan& plan, progress& shown,
                          double work = 0.0);

/// At each of several steps: from the largest down, where the search is the plan's own, each from the optimum
/// at the one before, so that theta goes along one branch. In the order of the steps.
std::vector<learned_scheme> learn_curve(const prepared_problem& system, learn_plan plan,
                                        std::vector<double> steps, progress& shown);

/// The fitted values, in the order of the family's parameters.
std::vector<double> theta_of(const fit_summary& fit);

/// Training and held-out seeds are the roles of the user's.
learn_plan plan_for(const std::string& family, std::optional<placement> where, double step,
                    const learning_options& how, const common_settings& common);

/// Before learning or running; with a burn-in that can take a moment. A warning is added where trajectories
/// do not begin where they usually do.
void prepare_starts(prepared_problem& system, const common_settings& common, progress& shown,
                    std::vector<std::string>& warnings);

}  // namespace nysalt::program
