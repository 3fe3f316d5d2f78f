// SPDX-License-Identifier: BSL-1.0
#include "run_state.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

json head_of(const run_state& state) {
  json batch = json::array();
  for (const auto& step : state.at.batch.diverged_at) batch.push_back(step ? json(*step) : json(nullptr));
  json diverged = json::array();
  for (const auto& one : state.lost) diverged.push_back({{"trajectory", one.trajectory}, {"step", one.step}});
  return {{"steps", state.steps},
          {"first", state.at.first},
          {"step", state.at.batch.step},
          {"wave", batch},
          {"energy_error", state.at.energy_error},
          {"diverged", diverged},
          {"began", state.began},
          {"keeps_all", state.keeps_all},
          {"length", state.written.length},
          {"sum", state.written.crc},
          {"in_order", state.in_order},
          {"finished", state.finished}};
}

/// Throws std::exception unless it is a whole number, and not negative.
std::int64_t count_in(const json& value) {
  const auto number = value.get_ref<const json::number_integer_t&>();
  if (number < 0) throw std::out_of_range("a count must not be negative");
  return number;
}

run_state state_of(const json& head) {
  run_state state;
  state.steps = count_in(head.at("steps"));
  state.at.first = count_in(head.at("first"));
  state.at.batch.step = count_in(head.at("step"));
  for (const auto& step : head.at("wave")) {
    state.at.batch.diverged_at.push_back(step.is_null() ? std::nullopt : std::optional(count_in(step)));
  }
  for (const auto& one : head.at("diverged")) {
    state.lost.push_back({count_in(one.at("trajectory")), count_in(one.at("step"))});
  }
  state.at.energy_error = head.at("energy_error").get<double>();
  state.began = count_in(head.at("began"));
  state.keeps_all = head.at("keeps_all").get<bool>();
  state.written.length = static_cast<std::uint64_t>(count_in(head.at("length")));
  state.written.crc = static_cast<std::uint32_t>(count_in(head.at("sum")));
  state.in_order = head.at("in_order").get<bool>();
  state.finished = head.at("finished").get<bool>();
  return state;
}

/// Throws std::exception for parts that are not of one run.
void require_sound(const run_state& state, std::int64_t trajectories) {
  const std::int64_t steps = state.steps;
  const std::int64_t step = state.at.batch.step;
  const auto& batch = state.at.batch.diverged_at;
  const bool is_of_it = std::ranges::all_of(state.lost, [&](const diverged_trajectory& one) {
    return one.trajectory < trajectories && one.step <= steps;
  });
  const bool is_no_cut = step % steps_between_checks != 0 && step != steps;
  const bool has_begun = state.began % steps_between_checks == 0 && state.began <= steps &&
                         (state.keeps_all || state.began == 0) && (batch.empty() || step >= state.began);
  if (state.at.first > trajectories - std::ssize(batch) || step > steps || is_no_cut || !has_begun ||
      !is_of_it) {
    throw std::out_of_range("state");
  }
}

/// Throws refusal if a run of that many steps cannot continue from the saved state.
void require_longer(const run_state& state, std::int64_t steps) {
  if (!state.finished) {
    refuse("--horizon must be that of the run that was stopped, {} steps, got {}; finish that run first",
           state.steps, steps);
  }
  if (steps < state.steps) {
    refuse("--horizon must not be shorter than that of the finished run, {} steps, got {} steps", state.steps,
           steps);
  }
  if (!state.keeps_all) {
    refuse(
        "cannot prolong the run: its trajectories take more than {} MB, which are not kept; take --start "
        "with "
        "the output, or begin anew",
        most_numbers_of_all * 8 >> 20U);
  }
}

/// How many trajectories the numbers of a state are of.
std::int64_t trajectories_with_numbers(const run_state& state, std::int64_t trajectories) {
  const std::int64_t of_batch = std::ssize(state.at.batch.diverged_at);
  if (!state.keeps_all) return of_batch;
  if (state.began > 0) return trajectories;
  // Of fewer steps than are between two checks a longer run begins anew.
  const bool has_no_check = last_check(state.steps) == 0;
  return has_no_check ? of_batch : state.at.first + of_batch;
}

}  // namespace

saved_runs runs_of(const run_state& state, std::int64_t step, std::int64_t first, std::int64_t count,
                   std::int64_t dimension) {
  const std::int64_t each = 3 * dimension;  // q, p and force
  const auto begin = state.numbers.begin() + first * each;
  saved_runs result{step, {begin, begin + count * each}, {}};
  result.diverged_at.resize(static_cast<std::size_t>(count));
  for (const auto& one : state.lost) {
    if (one.trajectory >= first && one.trajectory < first + count)
      result.diverged_at[static_cast<std::size_t>(one.trajectory - first)] = one.step;
  }
  return result;
}

constexpr const char* of_state = "state";

void save(const run_state& state, work_file& work) { work.replace(of_state, head_of(state), state.numbers); }

run_state saved_in(const work_file& work, std::int64_t steps, std::int64_t trajectories,
                   std::int64_t dimension) {
  const json head = work.result_of(of_state);
  try {
    run_state state = state_of(head);
    require_sound(state, trajectories);
    if (state.steps != steps) require_longer(state, steps);
    const std::int64_t each = 3 * dimension;  // q, p and force
    const std::int64_t count = trajectories_with_numbers(state, trajectories) * each;
    state.numbers = work.numbers();
    if (std::ssize(state.numbers) != count) throw std::out_of_range("numbers");
    if (const std::int64_t of_batch = std::ssize(state.at.batch.diverged_at); of_batch > 0) {
      const auto begin = state.numbers.begin() + (state.keeps_all ? state.at.first * each : 0);
      state.at.batch.numbers = {begin, begin + of_batch * each};
    }
    return state;
  } catch (const refusal&) {
    throw;
  } catch (const std::exception&) {
    work.refuse_edited(of_state);
  }
}

}  // namespace nysalt::program
