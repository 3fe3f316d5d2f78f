// SPDX-License-Identifier: BSL-1.0
// The demonstration: learn an integrator for the FPU chain at large steps, and show its speed against its
// error, beside the classical methods.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/learner.hpp"
#include "nysalt/nysalt.hpp"

namespace {

using namespace nysalt;
using chain = fpu_chain<3>;
using state = phase_point<double, chain::dimension>;

constexpr double fine_step = 1e-4;
constexpr double horizon = 0.5;
constexpr std::array steps{0.0025, 0.005, 0.01, 0.015, 0.02, 0.03, 0.04};
constexpr std::uint64_t training_seed = 1;
constexpr std::uint64_t held_out_seed = 2;
constexpr std::uint64_t test_seed = 3;
constexpr std::int64_t test_trajectories = 400;
constexpr int timing_rounds = 15;

/// On a terminal only; a pipe stays quiet.
void progress(const std::string& what) {
  if (isatty(STDERR_FILENO) != 0) fmt::print(stderr, "\r\033[K{}", what.empty() ? what : what + " ...");
}

struct stiff_energy {
  const chain& system;
  double operator()(const state& x) const { return system.stiff_energy(x); }
};

/// A row of the table, and the run that is timed for it.
struct experiment {
  work_precision_row row;
  std::function<void()> run;
  double simulated_time;  // of one run, all trajectories together
};

/// Accurate paths at one step, and methods against them.
class comparison {
 public:
  comparison(const chain& system, double step, const std::vector<state>& starts)
      : system_(system),
        step_(step),
        starts_(starts),
        steps_(static_cast<std::int64_t>(horizon / step + 1e-9)),
        accurate_(step / std::ceil(step / fine_step - 1e-9)),
        reference_(reference_paths(system_, accurate_, step_, steps_, starts_, stiff_energy{system_})) {}

  template <Method M>
  experiment operator()(const M& method) const {
    const auto result = path_error(system_, method, step_, starts_, reference_, stiff_energy{system_});
    // Steps alone are timed: no one watches, and what diverges runs on.
    const auto run = [&system = system_, &starts = starts_, step = step_, steps = steps_, method] {
      const auto stepper = make_stepper(system, method, step);
      for (const auto& start : starts) {
        auto open = stepper.open(start);
        stepper.advance(open, steps);
        end_of_run = stepper.synchronous(open).q[0];
      }
    };
    const auto count = static_cast<std::int64_t>(starts_.size());
    return {{method.name(), step_, result.evaluations_per_time, 0.0, result.error, result.diverged, count},
            run,
            static_cast<double>(count * steps_) * step_};
  }

  /// The error of the reference itself, in the same measure, on a few trajectories.
  double reference_error() const {
    const std::vector<state> few(starts_.begin(), starts_.begin() + 16);
    const auto finer = reference_paths(system_, accurate_.finer(), step_, steps_, few, stiff_energy{system_});
    double sum = 0.0;
    for (std::size_t m = 0; m < few.size(); ++m) {
      sum += relative_rms(reference_.values[m], finer.values[m]);
    }
    return sum / static_cast<double>(few.size());
  }

 private:
  inline static volatile double end_of_run = 0.0;  // so that no run can be left out as useless

  const chain& system_;
  double step_;
  const std::vector<state>& starts_;
  std::int64_t steps_;
  fine_steps<> accurate_;
  observable_paths reference_;
};

/// Energies of the three stiff springs, and their sum, over [0, 500]: the paper's first figure.
template <Method M>
panel stiff_energies(const chain& system, const M& method, double step, const std::string& title) {
  constexpr double length = 500.0;
  panel result{.title = title, .x_label = "t", .y_label = "stiff energy", .curves = {}, .y_range = "[0:4]"};
  for (const char* label : {"I", "I1", "I2", "I3"})
    result.curves.push_back({.label = label, .x = {}, .y = {}});
  result.curves[0].emphasised = true;
  const auto steps = static_cast<std::int64_t>(length / step + 0.5);
  const auto watch = [&](std::int64_t, double t, const state& x) {
    for (auto& curve : result.curves) curve.x.push_back(t);
    result.curves[0].y.push_back(system.stiff_energy(x));
    for (std::size_t j = 0; j < 3; ++j)
      result.curves[j + 1].y.push_back(system.stiff_energy(x, Eigen::Index(j)));
  };
  const auto every = std::max<std::int64_t>(1, steps / 2500);
  integrate(system, method, step, fpu_law<3>(system)(test_seed, 0), steps, watch, every);
  return result;
}

std::vector<work_precision_row> timed(std::vector<experiment>& experiments) {
  std::vector<std::function<void()>> runs;
  for (const auto& e : experiments) runs.push_back(e.run);
  const auto seconds = interleaved_medians(runs, timing_rounds);
  std::vector<work_precision_row> rows;
  for (std::size_t i = 0; i < experiments.size(); ++i) {
    experiments[i].row.seconds_per_time = seconds[i] / experiments[i].simulated_time;
    rows.push_back(experiments[i].row);
  }
  return rows;
}

/// The learned scheme beside the best classical one at the cost of each of its rows.
table at_equal_cost(const std::vector<work_precision_row>& rows, const std::string& learned_name,
                    const std::vector<std::string>& classical) {
  table result({"evaluations/time", "learned", "best classical", "its error", "its error / learned"});
  for (const auto& row : rows) {
    if (row.method != learned_name) continue;
    std::string best = "-";
    double best_error = std::numeric_limits<double>::infinity();
    for (const auto& name : classical) {
      const auto error = error_at_cost(rows, name, row.evaluations_per_time);
      if (error && *error < best_error) {
        best = name;
        best_error = *error;
      }
    }
    const auto number = [](const char* format, double x) {
      return fmt::format(fmt::runtime(std::isfinite(x) ? format : "-"), x);
    };
    result.add({fmt::format("{:.0f}", row.evaluations_per_time), number("{:.2e}", row.error.mean), best,
                number("{:.2e}", best_error), number("{:.2g}", best_error / row.error.mean)});
  }
  return result;
}

void draw_all(const chain& system, const std::vector<work_precision_row>& rows,
              const tuned_method<nystrom>& learned, const std::filesystem::path& folder) {
  const std::string y_label = "average relative error of the total stiff energy";
  figure evaluations{"error_against_evaluations",
                     {work_precision_panel(rows, learned.name(), "force evaluations per unit time",
                                           &work_precision_row::evaluations_per_time)}};
  figure seconds{"error_against_seconds",
                 {work_precision_panel(rows, learned.name(), "seconds per unit time",
                                       &work_precision_row::seconds_per_time)}};
  evaluations.panels[0].y_label = seconds.panels[0].y_label = y_label;
  const double step = learned.step();
  const figure energies{
      "stiff_energies",
      {stiff_energies(system, verlet{}, fine_step, fmt::format("verlet, step {:g}", fine_step)),
       stiff_energies(system, verlet{}, step, fmt::format("verlet, step {:g}", step)),
       stiff_energies(system, learned, step, fmt::format("{}, step {:g}", learned.name(), step))},
      1500,
      460};
  for (const auto& picture : {evaluations, seconds, energies}) {
    if (!draw(picture, folder)) {
      fmt::print("gnuplot could not draw {0}: is it installed? {0}.gp and {0}.dat are there.\n",
                 picture.name);
    }
  }
}

void demonstrate(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  write_file(folder / "table.csv", "");  // a folder that cannot be written is told now, not after the work
  const chain system(50.0);
  const fpu_law<3> law(system);
  const fine_steps<> reference(fine_step);
  std::vector<state> starts;
  for (std::uint64_t m = 0; m < test_trajectories; ++m) starts.push_back(law(test_seed, m));
  fmt::print("{}, starts by {}, reference: {}\n\n", system.description(), law.description(),
             reference.description());

  std::vector<experiment> experiments;
  std::map<double, tuned_method<nystrom>> tuned;
  table fits({"step", "b1", "+-", "beta1", "+-", "loss", "held-out loss", "usable", "seconds"});
  double reference_own_error = 0.0;
  for (const double step : steps) {
    progress(fmt::format("step {:g}: learning and comparing", step));
    const auto data = make_flow_map_data(system, law, reference, {.step = step, .seed = training_seed});
    const auto held_out = make_flow_map_data(system, law, reference, {.step = step, .seed = held_out_seed});
    const auto [method, fit] = learn(nystrom{}, system, data, held_out);
    tuned.emplace(step, method);
    const auto& b1 = fit.parameters[0];
    const auto& beta1 = fit.parameters[1];
    fits.add({fmt::format("{:g}", step), fmt::format("{:.5f}", b1.value),
              fmt::format("{:.0e}", b1.standard_error), fmt::format("{:.5f}", beta1.value),
              fmt::format("{:.0e}", beta1.standard_error), fmt::format("{:.2e}", fit.loss),
              fmt::format("{:.2e}", fit.held_out_loss), fit.usable ? "yes" : fit.reason,
              fmt::format("{:.2f}", fit.data_seconds + fit.fit_seconds)});
    const comparison here(system, step, starts);
    experiments.push_back(here(method));
    experiments.push_back(here(verlet{}));
    experiments.push_back(here(verlet_2x{}));
    experiments.push_back(here(mclachlan2{}));
    experiments.push_back(here(bcss2{}));
    experiments.push_back(here(srkn6b{}));
    reference_own_error = std::max(reference_own_error, here.reference_error());
    // Methods of more stages at the step that makes them cost the same.
    experiments.push_back(comparison(system, 1.5 * step, starts)(bcss3{}));
    experiments.push_back(comparison(system, 2.0 * step, starts)(pefrl{}));
    const comparison at_six_stages(system, 3.0 * step, starts);
    experiments.push_back(at_six_stages(blanes_moan_s6{}));
    const bool is_there =
        std::any_of(steps.begin(), steps.end(), [&](double s) { return std::abs(s - 3.0 * step) < 1e-12; });
    if (!is_there) experiments.push_back(at_six_stages(srkn6b{}));
  }
  progress("timing");
  const auto rows = timed(experiments);

  progress("");

  const auto& shown = tuned.at(0.02);
  const auto comparison_table = work_precision_table(rows);
  const auto equal_cost = at_equal_cost(
      rows, shown.name(),
      {"verlet", "verlet_2x", "mclachlan2", "bcss2", "bcss3", "pefrl", "blanes_moan_s6", "srkn6b"});
  fmt::print("Learned from 100 trajectories of length {:g}:\n\n{}\n", horizon, fits.text());
  fmt::print(
      "Error of the total stiff energy on {} new trajectories of length {:g}\n"
      "(average relative RMS; the reference's own error is {:.0e}):\n\n{}\n",
      test_trajectories, horizon, reference_own_error, comparison_table.text());
  fmt::print("At the cost of each learned step (a ratio above 1: the learned scheme is better):\n\n{}\n",
             equal_cost.text());
  write_file(folder / "table.csv", comparison_table.csv());
  write_file(folder / "table.md", "Learned parameters:\n\n" + fits.markdown() + "\nSpeed against error:\n\n" +
                                      comparison_table.markdown() + "\nAt equal cost:\n\n" +
                                      equal_cost.markdown());
  progress("drawing");
  draw_all(system, rows, shown, folder);
  progress("");
  fmt::print(
      "Table: {0}/table.md and table.csv\nPictures: {0}/error_against_evaluations, error_against_seconds, "
      "stiff_energies (.svg and .png)\n",
      folder.string());
}

constexpr std::string_view usage =
    "usage: nysalt_demo [--output FOLDER]\n\n"
    "Learns an integrator for the FPU chain at steps up to 0.04 and compares it with classical ones.\n"
    "Writes table and pictures into FOLDER (default: demo).\n";

/// 0 if all that was printed has arrived, else 2 and a line.
int printed() {
  if (std::fflush(stdout) == 0) return 0;
  fmt::print(stderr, "nysalt_demo: the standard output cannot be written\n");
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  std::filesystem::path folder = "demo";
  for (int i = 1; i < argc; ++i) {
    const std::string_view argument = argv[i];
    if (argument == "--help") {
      fmt::print("{}", usage);
      return printed();
    }
    if (argument != "--output" || i + 1 == argc) {
      fmt::print(stderr, "nysalt_demo: cannot make sense of '{}'; it takes --output FOLDER\n", argument);
      return 2;
    }
    folder = argv[++i];
    if (folder.empty()) {
      fmt::print(stderr, "nysalt_demo: --output needs the name of a folder\n");
      return 2;
    }
  }
  try {
    demonstrate(folder);
  } catch (const std::exception& problem) {
    fmt::print(stderr, "nysalt_demo: {}\n", problem.what());
    return 2;
  }
  return printed();
}
