// SPDX-License-Identifier: BSL-1.0
#include "command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <sstream>

#include "build_info.hpp"
#include "checks.hpp"
#include "commands.hpp"
#include "comparison.hpp"
#include "number.hpp"
#include "nysalt/together.hpp"
#include "options_file.hpp"
#include "output.hpp"
#include "refusal.hpp"
#include "world.hpp"

namespace nysalt::program {

namespace {

constexpr const char* three_commands =
    "nysalt: learned symplectic integrators. Three commands to try:\n\n"
    "  nysalt list\n"
    "  nysalt learn --system fpu --step 0.03\n"
    "  nysalt compare --system fpu --steps 0.02,0.03 --methods "
    "verlet,verlet_2x,bcss2,srkn6b,learned:nystrom\n\n"
    "nysalt --help tells of all.\n";

/// "a,b" and "c" become a, b, c.
std::vector<std::string> split(const std::vector<std::string>& texts, const char* option) {
  std::vector<std::string> parts;
  for (const auto& text : texts) {
    std::size_t from = 0;
    for (std::size_t comma = 0; comma != std::string::npos; from = comma + 1) {
      comma = text.find(',', from);
      parts.push_back(text.substr(from, comma - from));
      if (parts.back().empty()) refuse("{}: there is an empty entry in '{}'", option, text);
    }
  }
  return parts;
}

std::vector<double> numbers(const std::vector<std::string>& texts, const char* option) {
  std::vector<double> values;
  for (const auto& part : split(texts, option)) values.push_back(number_of<double>(option, part));
  return values;
}

/// Options as they are typed; lists are taken apart when all is read.
struct typed {
  common_settings common;
  learn_command learn;
  run_command run;
  compare_command compare;
  recommend_command recommend;
  stability_command stability;
  reproduce_command reproduce;
  cite_command cite;
  system_settings stability_system;
  std::vector<std::string> methods, steps, learn_steps, observables, parameters, range, families, metrics,
      levels;
};

template <class T>
struct plain {
  using type = T;
};
template <class T>
struct plain<std::optional<T>> {
  using type = T;
};

/// An option that takes a number. Read here, as CLI11 takes an empty text for 0, 010 for 8, and a number that
/// is too large for the largest.
template <class T>
CLI::Option* add_number(CLI::App& command, const std::string& name, T& value, const std::string& what) {
  using number = typename plain<T>::type;
  const auto take = [name, &value](const CLI::results_t& texts) {
    value = number_of<number>(name, texts.back());
    return true;
  };
  CLI::Option* option = command.add_option(name, take, what);
  option->type_name(std::is_floating_point_v<number> ? "NUMBER" : "INTEGER");
  if constexpr (std::is_same_v<T, number>) option->default_str(fmt::format("{}", value));
  return option;
}

/// A text that is empty is a variable of the shell that was never set, not a wish.
void refuse_empty_texts(CLI::App& command) {
  const auto objection = [](const std::string& text) { return text.empty() ? "it is empty" : ""; };
  for (CLI::Option* option : command.get_options()) option->check(objection);
}

void add_common(CLI::App& command, common_settings& common) {
  add_number(command, "--seed", common.seed, "of all random numbers");
  add_number(command, "--threads", common.threads, "at most so many; results do not depend on it")
      ->default_str("all cores");
  command.add_flag("--json", common.json, "one JSON document on standard output");
  command.fallthrough();  // for --config, which belongs to the program
}

void add_force(CLI::App& command, common_settings& common, const char* what) {
  command.add_flag("--force", common.force, what);
}

void add_system(CLI::App& command, system_settings& system) {
  command.add_option("--system", system.name, "nysalt list shows all")->capture_default_str();
  add_number(command, "--pairs", system.pairs, "fpu: pairs of masses [3]");
  add_number(command, "--omega", system.omega, "fpu, oscillator: stiff frequency [50]");
  add_number(command, "--masses", system.masses, "linear_chain [8], phi4 [16]");
  add_number(command, "--spring", system.spring, "linear_chain [1]");
  add_number(command, "--atoms", system.atoms, "lennard_jones [7]");
  add_number(command, "--space", system.space, "lennard_jones: 2 or 3 dimensions [2]");
}

/// What a system is in.
void add_bath(CLI::App& command, system_settings& system) {
  add_number(command, "--friction", system.bath.friction, "of a bath: gamma; with --sigma or --temperature");
  add_number(command, "--sigma", system.bath.sigma, "of its noise");
  add_number(command, "--temperature", system.bath.temperature, "kT = sigma^2/(2 gamma), an energy");
}

/// Where trajectories start in it, and how methods meet it.
void add_starts_and_placement(CLI::App& command, system_settings& system, std::string& placement) {
  add_number(command, "--eccentricity", system.eccentricity, "kepler: of the starts [0.6]");
  add_number(command, "--spread", system.spread, "of the law of starts: multiplies its deviations [1]");
  command.add_option("--start", system.start, "law, gibbs or trajectory [gibbs in a bath, else law]");
  command.add_option("--placement", placement,
                     "of O in a word that has none: end, symmetric or middle [symmetric]");
}

void add_search(CLI::App& command, learn_settings& how, const std::string& prefix) {
  add_number(command, prefix + "trajectories", how.trajectories, "to learn from");
  command.add_option("--coordinates", how.coordinates, "of the loss: qp, modes or energy")
      ->capture_default_str();
  command.add_option("--fix", how.fix, "keep a parameter: b1=0.5");
  command.add_option(prefix + "loss", how.loss, "state:K, energy:K after K steps, or covariance")
      ->capture_default_str();
  add_number(command, prefix + "random-starts", how.random_starts, "of the search, beside the family's own");
}

void add_learning(CLI::App& command, learn_settings& how, const std::string& prefix) {
  add_number(command, "--fine-step", how.fine_step,
             "of the reference; must divide the step [omega h <= 5e-3]");
  add_number(command, prefix + "horizon", how.horizon, "length of each");
  add_search(command, how, prefix);
}

void add_cite(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("cite", "the works that a set-up rests on, as BibTeX");
  command.add_option("files", to.cite.files, "schemes, or results whose manifests say how they were made");
  command.add_option("--system", to.cite.system, "nysalt list shows all");
  command.add_option("--methods", to.methods, "names, learned:FAMILY, files; joined by commas");
  command.add_option("--metric", to.metrics, "as compare takes it");
  command.add_flag("--bath", to.cite.in_bath, "the system is in a bath");
  add_common(command, to.common);
  command.footer(
      "Examples:\n"
      "  nysalt cite --system fpu --methods srkn6b,learned:nystrom --metric path\n"
      "  nysalt cite --system pendulum --bath --methods baoab");
}

void add_list(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("list", "systems, methods, families and metrics");
  add_common(command, to.common);
  command.footer("Examples:\n  nysalt list\n  nysalt list --json");
}

void add_learn(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("learn", "fit a family to a system at a step");
  add_system(command, to.learn.system);
  add_bath(command, to.learn.system);
  add_starts_and_placement(command, to.learn.system, to.learn.placement);
  command.add_option("--family", to.learn.family, "to learn")->capture_default_str();
  add_number(command, "--step", to.learn.step, "to learn for");
  command.add_option("--steps", to.learn_steps, "joined by commas: a curve of parameters");
  add_learning(command, to.learn.learning, "--");
  add_number(command, "--enough", to.learn.enough,
             "as many trajectories as it takes: share of the loss that their number may add to it");
  command.add_option("--output", to.learn.output, "write a scheme file");
  add_common(command, to.common);
  add_force(command, to.common, "write the scheme even if the fit is not usable");
  command.footer(
      "Examples:\n"
      "  nysalt learn --system fpu --step 0.03 --output scheme.json\n"
      "  nysalt learn --system oscillator --omega 50 --step 0.02 --coordinates energy --fix b1=0.5 --json\n"
      "  nysalt learn --system fpu --friction 0.01 --sigma 0.05 --placement symmetric --step 0.02\n"
      "  nysalt learn --system fpu --family fg4 --steps 0.04,0.05,0.06,0.07 --output curve.json");
}

void add_run(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("run", "trajectories of a method, sampled into a table");
  add_system(command, to.run.system);
  add_bath(command, to.run.system);
  add_starts_and_placement(command, to.run.system, to.run.placement);
  command.add_option("--method", to.run.method, "a name of nysalt list, or the file of a scheme or table")
      ->required();
  add_number(command, "--step", to.run.step, "of the method")->default_str("")->required();
  add_number(command, "--horizon", to.run.horizon, "length of each trajectory")->default_str("")->required();
  add_number(command, "--trajectories", to.run.trajectories, "how many");
  command.add_option("--observables", to.observables, "what to sample [that of the system]");
  add_number(command, "--sample-every", to.run.sample_every, "so many steps");
  command.add_option("--output", to.run.output, "file: CSV, or .h5, .npy [standard output]");
  command.add_flag("--plot", to.run.plot, "draw the first trajectory beside the output");
  command.add_option("--checkpoint", to.run.checkpoint, "file to go on from if the run is stopped");
  add_number(command, "--every", to.run.every, "so many steps a checkpoint is made");
  command.add_flag("--resume", to.run.resume, "go on from the checkpoint");
  add_common(command, to.common);
  add_force(command, to.common, "run a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt run --system fpu --method verlet --step 0.01 --horizon 1 --sample-every 10\n"
      "  nysalt run --system pendulum --method srkn6b --step 0.5 --horizon 100 --trajectories 8 "
      "--observables energy,q1 --output out.csv\n"
      "  nysalt run --system fpu --method verlet --step 0.001 --horizon 1e5 --sample-every 1000 --output "
      "out.csv "
      "--checkpoint out.checkpoint --every 1000000");
}

void add_compare(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("compare", "errors of methods beside their cost");
  add_system(command, to.compare.system);
  add_bath(command, to.compare.system);
  add_starts_and_placement(command, to.compare.system, to.compare.placement);
  command.add_option("--methods", to.methods, "names, learned:FAMILY, files; joined by commas")->required();
  command.add_option("--steps", to.steps, "joined by commas")->required();
  command.add_flag("--equal-cost", to.compare.equal_cost, "steps are per force evaluation");
  add_number(command, "--horizon", to.compare.horizon, "length of each trajectory");
  add_number(command, "--trajectories", to.compare.trajectories, "to compare on");
  command.add_option("--metric", to.metrics,
                     "path, state, exchange, energy, acceptance, distribution or acf, joined by commas; "
                     "path:OBSERVABLE names that of one [path]");
  command.add_option("--observable", to.compare.observable,
                     "of path, distribution and acf [that of the system]");
  command.add_option("--range", to.range, "LOW,HIGH of the histogram [of the starts]");
  add_number(command, "--bins", to.compare.bins, "of the histogram");
  command.add_option("--levels", to.levels, "errors, joined by commas, whose cost the report tells [0.01]");
  add_number(command, "--longest-lag", to.compare.longest_lag, "of the autocovariance, a time");
  add_number(command, "--hmc-temperature", to.compare.hmc_temperature, "kT of the acceptance, an energy");
  add_learning(command, to.compare.learning, "--learn-");
  command.add_option("--output", to.compare.output, "folder for the report, its tables and pictures");
  command.add_flag("--resume", to.compare.resume, "go on where a run into the same folder was stopped");
  add_common(command, to.common);
  add_force(command, to.common, "use a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt compare --system fpu --methods verlet,bcss2,learned:nystrom --steps 0.02,0.03 "
      "--trajectories 100\n"
      "  nysalt compare --system fpu --methods verlet,mclachlan2,srkn6b --steps 0.005,0.01 --equal-cost "
      "--metric state --json\n"
      "  nysalt compare --system fpu --friction 0.01 --sigma 0.05 --steps 0.019 --horizon 1 "
      "--methods baoab,baoab_2x,learned:nystrom@end,learned:nystrom@symmetric\n"
      "  nysalt compare --system henon_heiles --methods verlet,srkn6b,learned:fg4 --steps 0.2,0.4 "
      "--equal-cost "
      "--horizon 10 --learn-horizon 20 --trajectories 48 --metric state,energy --output report");
}

void add_recommend(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("recommend", "the best method at a cost, or for an error");
  add_system(command, to.recommend.system);
  add_bath(command, to.recommend.system);
  add_starts_and_placement(command, to.recommend.system, to.recommend.placement);
  add_number(command, "--budget", to.recommend.budget, "force evaluations per unit time");
  add_number(command, "--error", to.recommend.error, "to stay below, at the least cost");
  add_number(command, "--horizon", to.recommend.horizon, "length of each trajectory")
      ->default_str("")
      ->required();
  add_number(command, "--trajectories", to.recommend.trajectories, "to rank on");
  command.add_option("--metric", to.recommend.metric, "path, state, exchange, energy or acceptance")
      ->capture_default_str();
  command.add_option("--observable", to.recommend.observable, "of path [that of the system]");
  add_number(command, "--hmc-temperature", to.recommend.hmc_temperature, "kT of the acceptance, an energy");
  command.add_flag("--reversible", to.recommend.reversible, "symmetric methods alone");
  command.add_option("--families", to.families, "to learn, joined by commas [all that suit]");
  add_search(command, to.recommend.learning, "--learn-");
  add_number(command, "--learn-horizon", to.recommend.learn_horizon,
             "length of each [0.5, or ten steps if that is more]");
  command.add_option("--output", to.recommend.output, "write the winner's scheme file");
  add_common(command, to.common);
  command.footer(
      "Examples:\n"
      "  nysalt recommend --system fpu --budget 80 --horizon 5 --output scheme.json\n"
      "  nysalt recommend --system henon_heiles --error 1e-4 --horizon 10 --reversible");
}

void add_stability(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("stability", "for which z = h omega a method is stable");
  command.add_option("--method", to.stability.method, "a name, or the file of a scheme or table");
  command.add_option("--family", to.stability.family, "with --parameters");
  command.add_option("--parameters", to.parameters, "of the family, joined by commas");
  add_system(command, to.stability_system);
  add_bath(command, to.stability_system);
  add_number(command, "--eccentricity", to.stability_system.eccentricity, "kepler: of the starts [0.6]");
  add_number(command, "--spread", to.stability_system.spread,
             "of the law of starts: multiplies its deviations [1]");
  command.add_option("--start", to.stability_system.start,
                     "law, gibbs or trajectory: as run takes it; frequencies are those of law");
  add_number(command, "--step", to.stability.step, "with --system: is the system stable there?");
  command.add_option("--output", to.stability.output, "write trace/2 over z as CSV");
  command.add_flag("--plot", to.stability.plot, "draw it beside the output: windows, and the system's z");
  add_common(command, to.common);
  add_force(command, to.common, "look at a scheme at another step or system than it was learned for");
  command.footer(
      "Examples:\n"
      "  nysalt stability --family nystrom --parameters 0.5,0.4\n"
      "  nysalt stability --method bcss3 --system fpu --step 0.04\n"
      "  nysalt stability --method mclachlan2 --system kepler --step 0.1 --output trace.csv --plot");
}

void add_reproduce(CLI::App& app, typed& to) {
  auto& command = *app.add_subcommand("reproduce", "the paper's tables and figures beside our own");
  command.add_option("parts", to.reproduce.parts, "linear, deterministic, langevin [all; some ten minutes]");
  command.add_option("--output", to.reproduce.output,
                     "folder for paper.md, paper.html, paper.json and pictures");
  command.add_flag("--quick", to.reproduce.quick, "few trajectories and steps, to see it run");
  add_common(command, to.common);
  command.footer(
      "Examples:\n"
      "  nysalt reproduce linear\n"
      "  nysalt reproduce deterministic langevin --quick --output results");
}

bool given(const CLI::App& command, const std::string& option) { return command.count(option) > 0; }

int run_parsed(const CLI::App& command, typed& to) {
  const std::string name = command.get_name();
  require_sound(to.common);
  if (name == "list") return list(to.common);
  if (name == "cite") {
    to.cite.methods = split(to.methods, "--methods");
    to.cite.metrics = split(to.metrics, "--metric");
    return cite(to.cite, to.common);
  }
  if (name == "learn") {
    to.learn.steps = numbers(to.learn_steps, "--steps");
    if (given(command, "--enough") && given(command, "--trajectories")) {
      refuse("--enough finds how many trajectories it takes: leave --trajectories away");
    }
    return learn(to.learn, to.common);
  }
  if (name == "run") {
    to.run.observables = split(to.observables, "--observables");
    return run(to.run, to.common);
  }
  if (name == "compare") {
    to.compare.methods = split(to.methods, "--methods");
    to.compare.steps = numbers(to.steps, "--steps");
    to.compare.range = numbers(to.range, "--range");
    if (given(command, "--metric")) to.compare.metrics = split(to.metrics, "--metric");
    if (given(command, "--levels")) to.compare.levels = numbers(to.levels, "--levels");
    require_fitting(to.compare, [&](const char* option) { return given(command, option); });
    return compare(to.compare, to.common);
  }
  if (name == "reproduce") return reproduce(to.reproduce, to.common);
  if (name == "recommend") {
    to.recommend.families = split(to.families, "--families");
    const auto belongs = [&](const char* option, const char* metric) {
      if (!given(command, option) || to.recommend.metric == metric) return;
      refuse("{} belongs to the metric {}, not to {}", option, metric, to.recommend.metric);
    };
    belongs("--observable", "path");
    belongs("--hmc-temperature", "acceptance");
    return recommend(to.recommend, to.common);
  }
  to.stability.parameters = numbers(to.parameters, "--parameters");
  for (const char* option :
       {"--system", "--pairs", "--omega", "--masses", "--spring", "--atoms", "--space", "--eccentricity",
        "--spread", "--start", "--friction", "--sigma", "--temperature", "--step"}) {
    if (given(command, option)) to.stability.system = to.stability_system;
  }
  int code = done;
  on_first(world(), [&] { code = stability(to.stability, to.common); });
  broadcast(world(), code);
  return code;
}

/// As a shell would take it again.
std::string as_typed(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    const std::string argument = argv[i];
    const bool plain =
        !argument.empty() && argument.find_first_of(" '\"\\$&|;<>()*?#~\n\t") == std::string::npos;
    if (i > 0) text += ' ';
    if (plain) {
      text += argument;
    } else {
      text += '\'';
      for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
      text += '\'';
    }
  }
  return text;
}

/// Words on the command line that nothing takes.
[[noreturn]] void refuse_extras(const CLI::App& app) {
  const auto extras = app.remaining(true);
  const auto is_option = [](const std::string& word) { return word.starts_with('-'); };
  const auto option = std::find_if(extras.begin(), extras.end(), is_option);
  const std::string& first = option == extras.end() ? extras.front() : *option;
  const auto asked = app.get_subcommands();
  if (asked.empty()) refuse("unknown command '{}': it is one of {}", first, listed(command_names(app)));
  const CLI::App& command = *asked.front();
  refuse("unknown {} '{}': nysalt {} takes {}", is_option(first) ? "option" : "argument", first,
         command.get_name(), listed(option_names(command)));
}

/// Ranks may have different numbers of threads.
std::string without_threads(const std::string& options) {
  std::istringstream lines(options);
  std::string result;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("threads=") == std::string::npos) result += line + '\n';
  }
  return result;
}

}  // namespace

int run_command_line(int argc, char** argv) {
  typed to;
  to.common.threads = usual_threads();
  to.common.command = as_typed(argc, argv);
  CLI::App app("Learned symplectic integrators: learn one for a system and a step, run it, compare it.",
               "nysalt");
  app.set_version_flag("--version", version);
  app.require_subcommand(0, 1);
  app.get_formatter()->column_width(34);
  app.set_config("--config", "", "TOML file of options, as typed without the dashes");
  app.config_formatter(std::make_shared<options_file>(app));
  app.allow_config_extras(CLI::config_extras_mode::error);
  add_list(app, to);
  add_learn(app, to);
  add_run(app, to);
  add_compare(app, to);
  add_recommend(app, to);
  add_stability(app, to);
  add_reproduce(app, to);
  add_cite(app, to);
  for (auto* command : app.get_subcommands({})) {
    command->footer("--config FILE holds options, as typed without the dashes (TOML).\n\n" +
                    command->get_footer());
  }
  refuse_empty_texts(app);
  for (CLI::App* command : app.get_subcommands({})) refuse_empty_texts(*command);
  app.footer(
      "nysalt COMMAND --help tells of each.\nExit codes: 0 done, 2 bad input, 3 every trajectory diverged or "
      "the fit is not usable.");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto asked = app.get_subcommands();
    print(asked.empty() ? app.help() : asked.front()->help("nysalt"));
    return done;
  } catch (const CLI::CallForVersion&) {
    print(fmt::format("nysalt {}\n", version));
    return done;
  } catch (const CLI::ConfigError& problem) {
    refuse("--config: {}; is the file TOML, and is each name an option of the command?", problem.what());
  } catch (const CLI::ExtrasError&) {
    refuse_extras(app);
  } catch (const CLI::RequiredError& problem) {
    if (!app.remaining(true).empty()) refuse_extras(app);  // a mistyped option is why
    refuse("{}; nysalt {} --help tells what it takes", problem.what(),
           app.get_subcommands().front()->get_name());
  } catch (const CLI::ParseError& problem) {
    const auto asked = app.get_subcommands();
    const std::string where = asked.empty() ? "nysalt" : "nysalt " + asked.front()->get_name();
    refuse("{}; {} --help tells what it takes", problem.what(), where);
  }
  to.common.options = app.config_to_str();
  require_agreement("options", without_threads(to.common.options));
  const auto asked = app.get_subcommands();
  if (asked.empty()) {
    print(three_commands);
    return done;
  }
  return run_parsed(*asked.front(), to);
}

}  // namespace nysalt::program
