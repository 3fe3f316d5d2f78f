// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

#include "../commands.hpp"
#include "../mpi_session.hpp"
#include "../output.hpp"
#include "comparison/checks.hpp"
#include "comparison/interruption.hpp"
#include "comparison/judging.hpp"
#include "comparison/learning.hpp"
#include "comparison/progress.hpp"
#include "comparison/sampled_run.hpp"
#include "nysalt/communicator.hpp"
#include "program/output/planned_run.hpp"
#include "program/output/run_output.hpp"
#include "report/plot.hpp"
#include "report/result_file.hpp"

namespace nysalt::program {

namespace {

/// Steps between two looks for a signal, some seconds, where the run can be gone on with and takes longer.
std::optional<std::int64_t> segment_of(const run_command& command, const trajectories_plan& plan,
                                       std::int64_t dimension) {
  if (command.output.empty()) return std::nullopt;
  const std::int64_t some_seconds = 10 * short_segment(dimension);
  if (!command.every && !command.keep_work && plan.steps <= some_seconds / plan.count) return std::nullopt;
  return std::min(command.every.value_or(some_seconds), some_seconds);
}

/// Refuses what would fill the memory, before any work: `run` keeps the samples of a block of trajectories,
/// and a JSON document all of them.
void require_room(const run_command& command, const trajectories_plan& plan, std::int64_t dimension,
                  bool whole_document) {
  constexpr double most = 1e8;  // numbers: about a gigabyte
  const auto columns = static_cast<double>(command.observables.size());
  // A row of a document takes some 210 bytes, and 70 for each observable, its text included.
  const double numbers = whole_document ? 27.0 + 9.0 * columns : columns;
  const std::int64_t at_once = longest_segment(plan.steps, segment_of(command, plan, dimension));
  const std::int64_t apart = at_once / command.sample_every;
  const auto samples = static_cast<double>(apart + 1);
  const std::int64_t at_a_time =
      whole_document ? plan.count : std::int64_t{pack<double>::lanes} * plan.threads;
  const auto trajectories = static_cast<double>(std::min(plan.count, at_a_time));
  if (numbers * samples * trajectories <= most) return;
  refuse(
      "run: samples must fit into memory, got {:g} of each of {} trajectories; take a larger "
      "--sample-every{}",
      samples, plan.count, command.output.empty() ? ", or --output to a file" : ", or --every fewer steps");
}

/// NAME.svg and NAME.png beside the output NAME.csv: the observables along the first trajectory, in some
/// 2000 points.
void draw_run(const run_command& command, const run_output& output, std::int64_t steps) {
  const std::size_t columns = command.observables.size();
  const auto trajectory = output.read_first((steps / command.sample_every + 1) / 2000 + 1);
  const std::string y_label = columns == 1 ? command.observables.front() : "";
  panel only{fmt::format("{}, step {:g}", command.method, command.step), "t", y_label, false, {}};
  for (std::size_t k = 0; k < columns; ++k) {
    curve& values = only.curves.emplace_back();
    values.label = command.observables[k];
    values.emphasised = k == 0;
    values.x = trajectory.t;
    values.y = trajectory.values[k];
  }
  if (const auto warning = write_pictures({picture_name(command.output), {only}}, folder_of(command.output));
      !warning.empty())
    warn(warning);
}

/// Throws refusal for bad options of the files of a run, before any work.
void require_files(const run_command& command) {
  require_table(command.output, command.plot, true);
  if (command.every) require_at_least_one("every", *command.every);
  if (!command.output.empty()) return;
  if (command.every)
    refuse("--every must come with --output; name a file, as printed results cannot be continued");
  if (command.keep_work) refuse("--keep-work must come with --output; name the file of the results");
}

/// Where a trajectory diverged.
struct diverged_at_time : diverged_trajectory {
  double t;
};
std::vector<diverged_at_time> with_times(std::vector<diverged_trajectory> lost, double step) {
  std::ranges::sort(lost, {}, &diverged_trajectory::trajectory);
  std::vector<diverged_at_time> all;
  for (const auto& one : lost) all.push_back({one, static_cast<double>(one.step) * step});
  return all;
}

/// The run for machines; rows only where they are not in a file.
struct run_result {
  std::string system;
  std::string method;
  double step;
  std::int64_t trajectories;
  std::int64_t sample_every;
  std::string starts;
  std::vector<diverged_at_time> diverged;
  std::optional<fitted_frequency> frequency;
  std::vector<std::string> columns{};
  json rows{};
  std::string output{};
  std::int64_t steps = 0;
  std::uint64_t seed = 0;
  std::optional<std::int64_t> evaluations{};  // nothing: not counted again
  double seconds = 0.0;
  double energy_error = 0.0;
  nysalt::judgement judgement{};
  std::vector<std::string> warnings{};
};

/// In words, instead of the document.
void print_result(const run_command& command, std::int64_t trajectories, const run_result& document,
                  bool was_finished) {
  constexpr std::size_t enough = 20;  // lines of warnings
  if (was_finished) {
    print(fmt::format("{} is finished already: nothing was done; a longer --horizon prolongs it\n",
                      of_letters(command.output)));
  } else if (!command.output.empty()) {
    print(fmt::format("{} trajectories of {} steps, {} force evaluations each, {:.3g} s\n", trajectories,
                      document.steps, document.evaluations.value_or(0), document.seconds) +
          line_of_written(command.output));
  }
  const auto& diverged = document.diverged;
  for (const auto& one : std::span(diverged).first(std::min(diverged.size(), enough)))
    warn(fmt::format("trajectory {} diverged at step {}, t = {:g}", one.trajectory, one.step, one.t));
  if (diverged.size() > enough) {
    warn(fmt::format("and {} more of {} trajectories diverged: --json names them", diverged.size() - enough,
                     trajectories));
  }
}

/// What rank 0 decides, all know.
bool agreed(bool at_first) {
  broadcast(all_ranks(), at_first);
  return at_first;
}

}  // namespace

NYSALT_DESCRIBED(diverged_at_time, trajectory, step, t)
NYSALT_DESCRIBED(run_result, system, method, step, trajectories, sample_every, starts, diverged, frequency,
                 columns, rows, output, steps, seed, evaluations, seconds, energy_error, judgement, warnings)

json schema_of_run() { return whole_schema<run_result>("nysalt run"); }

int run(const run_command& asked, const common_settings& common) {
  const planned_run planned(asked, common);
  const run_command& command = planned.command;
  prepared_problem& system = *planned.system;
  const trajectories_plan& plan = planned.plan;
  on_first(all_ranks(), [&] { require_files(command); });
  require_room(command, plan, system.dimension(), common.json && command.output.empty());

  const auto began = std::chrono::steady_clock::now();
  require_agreement("methods", planned.question().dump(-1, ' ', false, json::error_handler_t::replace));
  progress shown;
  json question = planned.question();
  question.erase("steps");  // a finished run can be prolonged
  const auto work = begin_work(command.output, question, command.resume);
  std::optional<run_output> output;  // at rank 0; from now on the run can be gone on with
  on_first(all_ranks(), [&] { output.emplace(planned, work.get(), common.json); });
  tell_of_origin(work.get());
  const bool was_finished = agreed(output && output->is_finished());
  warn_of_threads(common);
  std::vector<std::string> warnings = planned.warnings;
  double energy_error = 0.0;
  if (!was_finished || common.json) {
    prepare_starts(system, common, shown, warnings);
    if (command.checks) shown.part("judging the step");
    for (const auto& text : planned.warnings_of_steps()) warnings.push_back(text);
  }
  shown.clear();
  if (!was_finished) {
    if (!common.json) {  // only now: a refusal is one line
      for (const auto& text : warnings) warn(text);
    }
    sampled_plan sampled{plan, command.observables, command.sample_every,
                         segment_of(command, plan, system.dimension())};
    on_first(all_ranks(), [&] { output->begin(sampled); });
    const bool prints_rows = command.output.empty() && !common.json;
    const auto take = [&](std::int64_t m, const record& one) {
      if (prints_rows) shown.step_aside();
      output->take(m, one);
    };
    shown.part("running");
    std::optional<signals_are_noted> noted;
    if (work) noted.emplace();
    energy_error = run(system, *planned.method, sampled, take, shown.counter(1000));
    shown.clear();
  }

  on_first(all_ranks(), [&] {
    if (was_finished) energy_error = output->energy_error();
    if (const auto text = planned.warning_of_energy(energy_error); text && (!was_finished || common.json)) {
      if (!common.json) warn(*text);
      warnings.push_back(*text);
    }
    const auto diverged = with_times(output->lost(), command.step);
    if (!was_finished) {
      output->commit();
      if (command.plot) draw_run(command, *output, plan.steps);
      output->finish();
    }
    run_result document{
        system.description(), command.method,  command.step, plan.count,
        command.sample_every, system.starts(), diverged,     frequency_of(planned.source, system)};
    json rows;
    output->describe(document.columns, rows);
    document.output = command.output;
    document.steps = plan.steps;
    document.seed = common.seed;
    if (!was_finished || common.json) {
      const std::int64_t further_observations =
          std::max<std::int64_t>(plan.steps / command.sample_every - 1, 0);  // one is counted with the run
      document.evaluations = system.count_evaluations(*planned.method, plan) +
                             further_observations * planned.method->letters().evaluations_to_observe;
    }
    document.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
    document.energy_error = energy_error;
    document.judgement = planned.judged();
    document.warnings = warnings;
    if (common.json) {
      json all = whole_document(document);
      all["rows"] = std::move(rows);  // which may fill much of the memory
      print(text_of(all));
    } else {
      print_result(command, plan.count, document, was_finished);
    }
    if (was_finished && output->was_changed()) {
      warn(fmt::format("{} was changed after the run had finished", command.output));
    }
  });
  const bool all_diverged = agreed(output && std::ssize(output->lost()) == plan.count);
  return all_diverged && !was_finished ? no_result : done;
}

}  // namespace nysalt::program
