// SPDX-License-Identifier: BSL-1.0
// The commands: names, examples, and what options must go together.
#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "../commands.hpp"
#include "../systems.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/comparison.hpp"
#include "comparison/purpose.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/export_to.hpp"
#include "subcommand.hpp"

namespace nysalt::program {

namespace {

int stability_on_first_rank(const stability_command& command, const common_settings& common) {
  int code = done;
  on_first(all_ranks(), [&] { code = stability(command, common); });
  broadcast(all_ranks(), code);
  return code;
}

/// The system is asked for where one of its options is given, or a step.
void complete_stability(const CLI::App& command, stability_command& asked) {
  const auto is_given = [&](const option_row& row) { return command.count(spelled(row.field)) > 0; };
  if (!asked.step && asked.system->parameters.empty() &&
      std::ranges::none_of(system_rows(*asked.system), is_given))
    asked.system.reset();
}

void complete_compare(const CLI::App& command, compare_command& asked) {
  require_fitting(asked, [&](const char* field) { return command.count(spelled(field)) > 0; });
}

void complete_recommend(const CLI::App& command, recommend_command& asked) {
  if (asked.learning.purpose == for_sampling) {
    for (const char* option : {"--budget", "--budget-seconds", "--error", "--horizon", "--metric",
                               "--observable", "--looks", "--reversible", "--placement"}) {
      if (command.count(option) > 0)
        refuse("{0} must come with another purpose than --for sampling; leave {0} out", option);
    }
    if (command.count("--length") == 0) {
      refuse("--length must be given with --for sampling; a quarter of the slowest period is a good start");
    }
    sampling_options& sampling = asked.sampling;
    sampling.temperature = asked.hmc_temperature;
    sampling.trajectories = asked.trajectories;
    sampling.families = asked.families;
    sampling.learning = asked.learning;
    sampling.starts_are_thermal = is_file_of_starts(asked.system.start);
    auto& of_momenta = asked.system.bath.temperature;  // of the starts in a file
    if (sampling.starts_are_thermal && of_momenta.value_or(sampling.temperature) != sampling.temperature) {
      refuse("--temperature {} must be the --hmc-temperature, got {}", *of_momenta, sampling.temperature);
    }
    if (sampling.starts_are_thermal) of_momenta = sampling.temperature;
    return;
  }
  for (const char* option : {"--length", "--acceptance", "--times-larger"}) {
    if (command.count(option) > 0) refuse("{} must come with --for sampling; leave {} out", option, option);
  }
  if (command.count("--horizon") == 0) refuse("--horizon must be given; name the length of the runs to come");
  const auto belongs = [&](const char* option, const char* metric) {
    if (command.count(option) == 0 || asked.metric == metric) return;
    refuse("{} must come with the metric {}, got {}", option, metric, asked.metric);
  };
  belongs("--observable", "path");
  belongs("--hmc-temperature", "acceptance");
}

std::string hosts() {
  std::string all;
  for (const auto& host : export_hosts()) all += fmt::format("  {:14} {}\n", host.name, host.what);
  return all;
}

}  // namespace

std::vector<subcommand> offer_all(CLI::App& app, common_settings& common) {
  app.set_help_all_flag("--help-all", "print this help, and all options of each command");
  try {
    return {
        offered<list_command>(app, common, "list", "systems, methods, families and metrics", &list,
                              "Examples:\n  nysalt list\n  nysalt list --json"),
        offered<learn_command>(
            app, common, "learn", "fit a family to a system at a step", &learn,
            "Examples:\n"
            "  nysalt learn --system fpu --step 0.03 --output scheme.json\n"
            "  nysalt learn --system oscillator --parameter omega=50 --step 0.02 --coordinates energy --fix "
            "b1=0.5 --json\n"
            "  nysalt learn --system fpu --friction 0.01 --sigma 0.05 --placement symmetric --step 0.02\n"
            "  nysalt learn --system fpu --family fg4 --steps 0.04,0.05,0.06,0.07 --output curve.json"),
        offered<run_command>(
            app, common, "run", "trajectories of a method, sampled into a table", &run,
            "Examples:\n"
            "  nysalt run --system fpu --method verlet --step 0.01 --horizon 1 --sample-every 10\n"
            "  nysalt run --system pendulum --method srkn6b --step 0.5 --horizon 100 --trajectories 8 "
            "--observables energy,q1 --output out.csv\n"
            "  nysalt run --system fpu --method verlet --step 0.001 --horizon 1e5 --sample-every 1000 "
            "--output long.csv --resume"),
        offered<compare_command>(
            app, common, "compare", "errors of methods beside their cost", &compare,
            "Examples:\n"
            "  nysalt compare --system fpu --methods verlet,bcss2,learned:nystrom --steps 0.02,0.03 "
            "--trajectories 100\n"
            "  nysalt compare --system fpu --methods all,learned:bab6 --steps 0.005,0.01 --equal-cost "
            "--metric state --json\n"
            "  nysalt compare --system fpu --friction 0.01 --sigma 0.05 --steps 0.019 --horizon 1 "
            "--methods baoab,baoab_2x,learned:nystrom@end,learned:nystrom@symmetric\n"
            "  nysalt compare --system henon_heiles --methods verlet,srkn6b,learned:fg4 --steps 0.2,0.4 "
            "--equal-cost --horizon 10 --learn-horizon 20 --trajectories 48 --metric state,energy --output "
            "report",
            complete_compare),
        offered<recommend_command>(
            app, common, "recommend", "the best method at a cost, or for an error", &recommend,
            "Examples:\n"
            "  nysalt recommend --system fpu --budget 80 --horizon 5 --output scheme.json\n"
            "  nysalt recommend --system henon_heiles --error 1e-4 --horizon 10 --reversible\n"
            "  nysalt recommend --for sampling --system phi4 --length 1 --families bab5 --times-larger 100",
            complete_recommend),
        offered<stability_command>(
            app, common, "stability", "for which z = h omega a method is stable", &stability_on_first_rank,
            "Examples:\n"
            "  nysalt stability --family nystrom --parameters 0.5,0.4\n"
            "  nysalt stability --method bcss3 --system fpu --step 0.04\n"
            "  nysalt stability --method mclachlan2 --system kepler --step 0.1 --output trace.csv --plot",
            complete_stability),
        offered<sample_command>(
            app, common, "sample", "draws from exp(-V/kT) by Hybrid Monte Carlo", &sample,
            "Examples:\n"
            "  nysalt sample --system phi4 --parameter masses=64 --length 1 --method omelyan5v\n"
            "  nysalt sample --potential '(x^2 + 100*y^2)/2' --variables x,y --diagonal-masses --output "
            "draws.csv\n"
            "  nysalt sample --system phi4_lattice --parameter side=8 --length 0.5 --output draws.csv "
            "--resume\n"
            "  nysalt sample --system pendulum --method verlet --step 0.5 --length 2 --draws 10000"),
        offered<new_command>(app, common, "new", "begin a system of your own: a commented source that builds",
                             &new_system, "Examples:\n  nysalt new morse_chain"),
        offered<build_command>(
            app, common, "build", "compile a system of your own, for --system", &build,
            "A source is code that runs as you: build what you trust. --system SOURCE.hpp builds it too.\n\n"
            "Examples:\n"
            "  nysalt build morse_chain.hpp\n"
            "  nysalt build morse_chain.hpp --output systems/morse_chain.so"),
        offered<export_command>(
            app, common, "export", "write a method as source for another language or code", &export_method,
            "Hosts:\n" + hosts() +
                "\nEach file has a self-test: ten steps that must end where nysalt's own do.\n\n"
                "Examples:\n"
                "  nysalt export srkn6b --to python --output srkn6b.py\n"
                "  nysalt export fg4_processed --to c --displaced\n"
                "  nysalt export bcss3 --to blackjax"),
        offered<cite_command>(app, common, "cite", "the works that a set-up rests on, as BibTeX", &cite,
                              "Examples:\n"
                              "  nysalt cite --system fpu --methods srkn6b,learned:nystrom --metric path\n"
                              "  nysalt cite --system pendulum --bath --methods baoab")};
  } catch (const CLI::OptionAlreadyAdded& problem) {  // by the parameters of a system that was loaded
    std::string name = problem.what();                // "...: NAME is already added"
    name = name.substr(name.rfind(": ") == std::string::npos ? 0 : name.rfind(": ") + 2);
    refuse("a parameter of the system must not have the name of an option, got '{}'; choose another name",
           name.substr(0, name.find(' ')));
  }
}

}  // namespace nysalt::program
