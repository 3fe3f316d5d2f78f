// SPDX-License-Identifier: BSL-1.0
// The subcommands. Each prints its results and returns the program's exit code.
#pragma once

#include "comparison/json.hpp"
#include "settings.hpp"

namespace nysalt::program {

inline constexpr int done = 0;
inline constexpr int bad_input = 2;
inline constexpr int no_result =
    3;  // every trajectory diverged, the fit is not usable, or no method is accepted
inline constexpr int not_written = 4;  // the disk is full, or the standard output is closed

json schema_of_run();
json schema_of_sample();
json schema_of_stability();

int build(const build_command& command, const common_settings& common);
int cite(const cite_command& command, const common_settings& common);
int export_method(const export_command& command, const common_settings& common);
int list(const list_command& command, const common_settings& common);
int learn(const learn_command& command, const common_settings& common);
int new_system(const new_command& command, const common_settings& common);
int run(const run_command& command, const common_settings& common);
int compare(const compare_command& command, const common_settings& common);
int sample(const sample_command& command, const common_settings& common);
int recommend(const recommend_command& command, const common_settings& common);
int stability(const stability_command& command, const common_settings& common);

}  // namespace nysalt::program
