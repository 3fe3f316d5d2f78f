// SPDX-License-Identifier: BSL-1.0
#include "own_problem.hpp"

#include <utility>
#include <vector>

#include "comparison/checks.hpp"
#include "comparison/user_system_checks.hpp"

namespace nysalt::program {

std::unique_ptr<prepared_problem> prepared(initial_value_problem problem) {
  const std::string name = describe(problem.system);
  const nysalt::bath in = problem.system.bath();
  const bool is_warm = in.acts() && in.has_temperature() && in.temperature() > 0.0;
  const start where = is_warm ? start::gibbs : start::law;
  examine(problem, name);
  return std::make_unique<prepared_problem>(std::move(problem), std::vector<named_value>{{"name", name}},
                                            surroundings{.bath = in, .start = where, .is_start_usual = true});
}

told_caller::told_caller(const common_options& common) {
  if (!common.progress_of_parts) return;
  caller_.hears = common.progress_of_parts;
  work_.emplace(caller_);
}

common_settings settings_of(const common_options& common) {
  common_settings settings;
  static_cast<common_options&>(settings) = common;
  require_sound(settings);
  return settings;
}

}  // namespace nysalt::program
