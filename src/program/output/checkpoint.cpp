// SPDX-License-Identifier: BSL-1.0
#include "checkpoint.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

#include "checkpoint_file.hpp"
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
  state.output = head.value("output", std::string());
  state.written.length = static_cast<std::uint64_t>(count_in(head.at("length")));
  state.written.crc = static_cast<std::uint32_t>(count_in(head.at("sum")));
  state.in_order = head.at("in_order").get<bool>();
  state.laid_out = head.value("laid_out", true);  // older ones do not say
  state.finished = head.at("finished").get<bool>();
  state.version = head.at("nysalt").get<std::string>();
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
  if (state.at.first > trajectories - std::ssize(batch) || step > steps || is_no_cut || !is_of_it) {
    throw std::out_of_range("checkpoint");
  }
}

}  // namespace

void write_checkpoint(const std::filesystem::path& file, const checkpoint& state,
                      const std::function<void()>& check) {
  write_checkpoint_file(file, head_of(state), state.at.batch.numbers, check);
}

checkpoint read_checkpoint(const std::filesystem::path& file, const json& question, std::int64_t dimension) {
  const json head = head_of_checkpoint(file, "run");
  try {
    checkpoint state = state_of(head);
    require_question(state.question, question, file);
    require_sound(state);
    const std::size_t of_trajectory = 3 * static_cast<std::size_t>(dimension);  // q, p and force
    state.at.batch.numbers = numbers_of_checkpoint(file, state.at.batch.diverged_at.size() * of_trajectory);
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
