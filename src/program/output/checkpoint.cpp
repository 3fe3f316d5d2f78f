// SPDX-License-Identifier: BSL-1.0
#include "checkpoint.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "checkpoint_file.hpp"
#include "comparison/origin.hpp"
#include "comparison/refusal.hpp"

namespace nysalt::program {

namespace {

json head_of(const checkpoint& state) {
  json batch = json::array();
  for (const auto& step : state.at.batch.diverged_at) batch.push_back(step ? json(*step) : json(nullptr));
  json diverged = json::array();
  for (const auto& one : state.lost) diverged.push_back({{"trajectory", one.trajectory}, {"step", one.step}});
  return {{"command", "run"},
          {"question", state.question},
          {"first", state.at.first},
          {"step", state.at.batch.step},
          {"wave", batch},
          {"energy_error", state.at.energy_error},
          {"diverged", diverged},
          {"began", state.began},
          {"keeps_all", state.keeps_all},
          {"is_copied", state.is_copied},
          {"output", state.output},
          {"length", state.written.length},
          {"sum", state.written.crc},
          {"in_order", state.in_order},
          {"laid_out", state.laid_out},
          {"finished", state.finished}};
}

checkpoint state_of(const json& head) {
  checkpoint state;
  state.question = head.at("question");
  state.at.first = count_in(head.at("first"));
  state.at.batch.step = count_in(head.at("step"));
  for (const auto& step : head.at("wave")) {
    state.at.batch.diverged_at.push_back(step.is_null() ? std::nullopt : std::optional(count_in(step)));
  }
  for (const auto& one : head.at("diverged")) {
    state.lost.push_back({count_in(one.at("trajectory")), count_in(one.at("step"))});
  }
  state.at.energy_error = head.at("energy_error").get<double>();
  state.began = count_in(head.value("began", json(0)));  // older ones do not say, and keep the batch alone
  state.keeps_all = head.value("keeps_all", false);
  state.is_copied = head.value("is_copied", false);
  state.output = head.value("output", std::string());
  state.written.length = static_cast<std::uint64_t>(count_in(head.at("length")));
  state.written.crc = static_cast<std::uint32_t>(count_in(head.at("sum")));
  state.in_order = head.at("in_order").get<bool>();
  state.laid_out = head.value("laid_out", true);  // older ones do not say
  state.finished = head.at("finished").get<bool>();
  return state;
}

/// Throws std::exception for parts that are not of one run.
void require_sound(const checkpoint& state) {
  const std::int64_t trajectories = count_in(state.question.at("trajectories"));
  const std::int64_t steps = count_in(state.question.at("steps"));
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
    throw std::out_of_range("checkpoint");
  }
}

/// Throws refusal unless the run of the question prolongs that of the state, which differs in nothing else.
void require_longer(const checkpoint& state, std::int64_t steps, const std::filesystem::path& file) {
  const auto steps_then = count_in(state.question.at("steps"));
  if (!state.finished) {
    refuse(
        "--horizon must be that of the run of {} until the run ends, {} steps, got {}; finish that run first",
        file.string(), steps_then, steps);
  }
  if (steps < steps_then) {
    refuse("--horizon must not be shorter than the finished run of {}, {} steps, got {} steps", file.string(),
           steps_then, steps);
  }
  if (!state.keeps_all) {
    refuse(
        "cannot prolong the run of {}: the checkpoint does not keep where its trajectories end, as an older "
        "nysalt wrote it or they take more than {} MB; take --start with the output, or begin anew",
        file.string(), most_numbers_of_all * 8 >> 20U);
  }
}

/// How many trajectories the numbers of a checkpoint are of.
std::int64_t trajectories_with_numbers(const checkpoint& state) {
  const std::int64_t of_batch = std::ssize(state.at.batch.diverged_at);
  if (!state.keeps_all) return of_batch;
  if (state.began > 0) return count_in(state.question.at("trajectories"));
  // Of fewer steps than are between two checks a longer run begins anew.
  const bool has_no_check = last_check(count_in(state.question.at("steps"))) == 0;
  return has_no_check ? of_batch : state.at.first + of_batch;
}

}  // namespace

saved_runs runs_of(const checkpoint& state, std::int64_t step, std::int64_t first, std::int64_t count,
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

void write_checkpoint(const std::filesystem::path& file, const checkpoint& state,
                      const std::function<void()>& check) {
  write_checkpoint_file(file, head_of(state), state.numbers, check);
}

checkpoint read_checkpoint(const std::filesystem::path& file, const json& question, std::int64_t dimension) {
  const json head = head_of_checkpoint(file, "run");
  try {
    checkpoint state = state_of(head);
    state.warning = warning_of_origin(head, file);
    json of_steps_then = as_kept(question);
    of_steps_then["steps"] = state.question.at("steps");
    if (state.question == of_steps_then && state.question != as_kept(question)) {
      require_sound(state);
      require_longer(state, question.at("steps").get<std::int64_t>(), file);
    } else {
      require_question(state.question, question, file);
      require_sound(state);
    }
    const std::int64_t each = 3 * dimension;  // q, p and force
    const auto count = static_cast<std::size_t>(trajectories_with_numbers(state) * each);
    state.numbers = numbers_of_checkpoint(file, count);
    if (const std::int64_t of_batch = std::ssize(state.at.batch.diverged_at); of_batch > 0) {
      const auto begin = state.numbers.begin() + (state.keeps_all ? state.at.first * each : 0);
      state.at.batch.numbers = {begin, begin + of_batch * each};
    }
    return state;
  } catch (const refusal&) {
    throw;
  } catch (const std::exception&) {
    refuse_edited_checkpoint(file);
  }
}

bool is_of_unfinished_run(const std::filesystem::path& file) {
  const json head = head_of_checkpoint(file, "run");
  const json finished = head.value("finished", json());
  if (!finished.is_boolean()) refuse_edited_checkpoint(file);
  return !finished.get<bool>();
}

}  // namespace nysalt::program
