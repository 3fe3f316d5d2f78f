// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>

#include "../checks.hpp"
#include "../commands.hpp"
#include "../learning.hpp"
#include "../method_source.hpp"
#include "../output.hpp"
#include "../progress.hpp"
#include "../seeds.hpp"
#include "nysalt/report/atomic_file.hpp"
#include "nysalt/report/plot.hpp"

namespace nysalt::program {

namespace {

/// Refuses what would fill the memory, before any work: `run` keeps the samples of a block of trajectories,
/// and a JSON document all of them.
void require_room(const run_command& command, std::int64_t steps, bool whole_document, int threads) {
  constexpr double most = 1e8;  // numbers: about a gigabyte, some more in a document
  const auto columns = static_cast<double>(command.observables.size());
  const auto samples = static_cast<double>(steps / command.sample_every + 1);
  const std::int64_t at_a_time = whole_document ? command.trajectories : default_lanes * threads;
  const auto trajectories = static_cast<double>(std::min(command.trajectories, at_a_time));
  if (columns * samples * trajectories <= most) return;
  refuse("{:g} samples of {} trajectories would not fit into memory: take a larger --sample-every{}", samples,
         command.trajectories, whole_document ? ", or --output to a file" : "");
}

/// Where the samples go: lines of CSV into a file or onto standard output, or rows of the JSON document.
class samples {
 public:
  samples(const run_command& command, bool as_json) : command_(command), as_json_(as_json) {
    if (!command.output.empty()) file_.emplace(command.output);
    for (const auto& name : command.observables) columns_.push_back(name);
    if (is_csv()) {
      text_ = fmt::format("trajectory,step,t,{}\n", fmt::join(command.observables, ","));
    }
  }

  void take(std::int64_t trajectory, const record& its) {
    const std::size_t width = command_.observables.size();
    for (std::size_t i = 0; i < its.values.size(); i += width) {
      const std::int64_t n = static_cast<std::int64_t>(i / width) * command_.sample_every;
      add(trajectory, n, std::span(its.values).subspan(i, width));
    }
    if (its.diverged_at) {
      const double t = static_cast<double>(*its.diverged_at) * command_.step;
      diverged_.push_back({{"trajectory", trajectory}, {"step", *its.diverged_at}, {"t", t}});
    }
    flush();
  }

  /// What is written becomes the file.
  void commit() {
    flush();
    if (file_) file_->commit();
  }

  const json& columns() const { return columns_; }
  const json& rows() const { return rows_; }
  const json& diverged() const { return diverged_; }

 private:
  bool is_csv() const { return file_ || !as_json_; }

  void add(std::int64_t trajectory, std::int64_t n, std::span<const double> values) {
    const double t = static_cast<double>(n) * command_.step;
    if (is_csv()) {
      text_ += fmt::format("{},{},{}", trajectory, n, t);
      for (const double x : values) text_ += std::isfinite(x) ? fmt::format(",{}", x) : std::string(",");
      text_ += '\n';
      if (text_.size() > 1U << 20U) flush();
    } else {
      json& row = rows_.emplace_back(json{trajectory, n, t});
      for (const double x : values) row.push_back(x);
    }
  }

  void flush() {
    if (file_) {
      file_->write(text_);
    } else if (!text_.empty()) {
      print(text_);
    }
    text_.clear();
  }

  const run_command& command_;
  bool as_json_;
  std::optional<atomic_file> file_;
  std::string text_;
  json columns_{"trajectory", "step", "t"};
  json rows_ = json::array();
  json diverged_ = json::array();
};

/// NAME.svg and NAME.png beside the output NAME.csv: the observables along the first trajectory, in some
/// 2000 points.
void draw_run(const record& first, const run_command& command, const common_settings& common) {
  const std::size_t columns = command.observables.size();
  const std::size_t samples = first.values.size() / columns;
  const std::size_t every = samples / 2000 + 1;
  const std::string y_label = columns == 1 ? command.observables.front() : "";
  panel its{fmt::format("{}, step {:g}", command.method, command.step), "t", y_label, false, {}};
  for (std::size_t k = 0; k < columns; ++k) {
    curve& values = its.curves.emplace_back();
    values.label = command.observables[k];
    values.emphasised = k == 0;
    for (std::size_t i = 0; i < samples; i += every) {
      values.x.push_back(static_cast<double>(i * static_cast<std::size_t>(command.sample_every)) *
                         command.step);
      values.y.push_back(first.values[i * columns + k]);
    }
  }
  const std::filesystem::path output(command.output);
  figure picture{output.stem().string(), {its}};
  for (char& c : picture.name) c = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' ? c : '_';
  write_pictures(picture, folder_of(output), common);
}

json document(const run_command& command, const bundled_system& system, const samples& taken) {
  json result{{"system", system.description()},
              {"method", command.method},
              {"step", command.step},
              {"trajectories", command.trajectories},
              {"sample_every", command.sample_every},
              {"starts", system.starts()},
              {"diverged", taken.diverged()},
              {"columns", taken.columns()}};
  if (command.output.empty()) {
    result["rows"] = taken.rows();
  } else {
    result["output"] = command.output;
  }
  return result;
}

}  // namespace

int run(const run_command& asked, const common_settings& common) {
  run_command command = asked;
  require_positive("--step", command.step);
  require_at_least_one("--trajectories", command.trajectories);
  require_at_least_one("--sample-every", command.sample_every);
  const std::int64_t steps = steps_within("--horizon", command.horizon, command.step);
  if (command.plot && command.output.empty()) refuse("--plot needs --output: the picture goes beside it");
  if (!command.output.empty()) require_writable(command.output);
  std::error_code ignored;
  if (std::filesystem::equivalent(command.method, command.output, ignored)) {
    refuse("--output {} is the file of the method: name another", command.output);
  }
  const std::string ending = std::filesystem::path(command.output).extension();
  if (command.plot && (ending == ".svg" || ending == ".png" || ending == ".dat" || ending == ".gp")) {
    refuse("--plot makes a file {} of its own: let the --output end in .csv", ending);
  }
  const auto system = make_system(command.system);
  if (command.observables.empty()) command.observables = {system->default_observable()};
  for (std::size_t i = 1; i < command.observables.size(); ++i) {
    const auto earlier = std::span(command.observables).first(i);
    if (std::ranges::find(earlier, command.observables[i]) == earlier.end()) continue;
    refuse("--observables names {} twice", command.observables[i]);
  }
  require_room(command, steps, common.json && command.output.empty(), common.threads);

  std::vector<std::string> warnings;
  const method_source source = find_method(command.method);
  const tabulated method = coefficients_at(source, *system, command.step, common.force,
                                           placement_asked(command.placement), warnings);
  if (!common.json) {
    for (const auto& text : warnings) warn(text);
  }

  samples taken(command, common.json);
  std::optional<record> first;
  const auto take = [&](std::int64_t m, const record& its) {
    taken.take(m, its);
    if (command.plot && m == 0) first = its;
  };
  const trajectories_plan plan{command.step, steps, command.trajectories, seed_for(role::test, common.seed),
                               common.threads};
  progress shown;
  prepare_starts(*system, common, shown);
  if (const auto of_energies = warning_of_energies(source, *system, plan)) {
    if (!common.json) warn(*of_energies);
    warnings.push_back(*of_energies);
  }
  shown.part("running");
  const auto began = std::chrono::steady_clock::now();
  system->run(method, plan, command.observables, command.sample_every, take,
              shown.counter(command.trajectories));
  taken.commit();
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
  shown.clear();
  if (!command.output.empty()) write_manifest(command.output, common);
  if (first) draw_run(*first, command, common);

  const std::int64_t evaluations = system->count_evaluations(method, plan);
  if (common.json) {
    json result = document(command, *system, taken);
    result["steps"] = steps;
    result["seed"] = common.seed;
    result["evaluations"] = evaluations;
    result["seconds"] = seconds;
    result["warnings"] = warnings;
    print(text_of(result));
  } else {
    if (!command.output.empty()) {
      print(fmt::format("{} trajectories of {} steps, {} force evaluations each, {:.3g} s\nWritten: {}\n",
                        command.trajectories, steps, evaluations, seconds, command.output));
    }
    for (const auto& one : taken.diverged()) {
      warn(fmt::format("trajectory {} diverged at step {}, t = {:g}", one["trajectory"].get<std::int64_t>(),
                       one["step"].get<std::int64_t>(), one["t"].get<double>()));
    }
  }
  return std::ssize(taken.diverged()) == command.trajectories ? no_result : done;
}

}  // namespace nysalt::program
