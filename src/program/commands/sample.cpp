// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "../commands.hpp"
#include "../mpi_session.hpp"
#include "../output.hpp"
#include "../output/kept_draws.hpp"
#include "../systems.hpp"
#include "comparison/all_ranks.hpp"
#include "comparison/checks.hpp"
#include "comparison/learning.hpp"
#include "comparison/method_source.hpp"
#include "comparison/progress.hpp"
#include "comparison/refusal.hpp"
#include "comparison/seeds.hpp"
#include "nysalt/communicator.hpp"
#include "nysalt/hmc.hpp"
#include "report/result_file.hpp"
#include "report/table.hpp"

namespace nysalt::program {

namespace {

std::string number_or_dash(const char* format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

constexpr double converged = 1.01;  // R-hat [vehtari_and_others_2021]

bool has_converged(const std::vector<summary_of_scalar>& all) {
  return std::ranges::all_of(all, [](const summary_of_scalar& one) { return one.reduction < converged; });
}

hmc_options hmc_options_of(const sample_command& command, const prepared_problem& system,
                           const method_source& source, const common_settings& common) {
  hmc_options options{.step = command.step.value_or(0.0),
                      .length = command.length.value_or(0.5 * std::numbers::pi),
                      .temperature = command.temperature,
                      .chains = command.chains,
                      .burn_in = command.burn_in,
                      .draws = command.draws,
                      .acceptance = command.acceptance,
                      .diagonal_masses = command.diagonal_masses,
                      .seed = seed_for(role::test, common.seed),
                      .execution = {.threads = common.execution.threads, .ranks = &all_ranks()}};
  if (!command.length && !command.diagonal_masses) {
    refuse(
        "--length must be given without --diagonal-masses; a quarter of the slowest period is a good start");
  }
  if (!command.step) {
    if (!options.acceptance) options.acceptance = 0.9;
    const double fastest = system.definition().frequency;  // a fifth of a radian an evaluation
    const double angle = 0.2 * source.evaluations_per_step;
    options.step = std::min(options.length, fastest > 0.0 ? angle / fastest : 0.1 * options.length);
  }
  if (options.diagonal_masses && !options.acceptance) options.acceptance = 0.9;
  return options;
}

/// Throws refusal for bad options of files, before any work.
void require_files(const sample_command& command) {
  require_table(command.output, false, false);
  if (!command.every) return;
  require_at_least_one("every", *command.every);
  if (command.output.empty()) refuse("--every must come with --output; name the file of the draws");
}

/// All that decides the bytes of the output.
json question_of(const sample_command& command, const prepared_problem& system, const method& method,
                 const hmc_options& options) {
  return {{"system", system.parameters()},
          {"description", system.description()},
          {"starts", system.starts()},
          {"letters", method.letters().letters()},
          {"coefficients", method.coefficients()},
          {"step", options.step},
          {"acceptance", options.acceptance ? json(*options.acceptance) : json()},
          {"length", options.length},
          {"temperature", options.temperature},
          {"chains", options.chains},
          {"burn_in", options.burn_in},
          {"draws", options.draws},
          {"diagonal_masses", command.diagonal_masses},
          {"seed", options.seed}};
}

std::int64_t draws_before(const sample_command& command, std::int64_t trajectories) {
  return std::max<std::int64_t>(0, trajectories - command.burn_in);
}

constexpr const char* of_state = "state";

/// The state in a work file, and its draws.
hmc_state state_in(const sample_command& command, const work_file& work, kept_draws& draws) {
  hmc_state state;
  std::size_t of_chains = 0;
  on_first(all_ranks(), [&] { state.numbers = work.numbers(); });
  broadcast(all_ranks(), state.numbers);
  try {
    const json head = work.result_of(of_state);
    state.trajectories = head.at("trajectories").get<std::int64_t>();
    of_chains = head.at("numbers").get<std::size_t>();
  } catch (const json::exception&) {
    work.refuse_edited(of_state);
  }
  const std::int64_t drawn = draws_before(command, state.trajectories);
  const std::size_t of_draws =
      static_cast<std::size_t>(command.chains) * static_cast<std::size_t>(drawn) * draws.scalars();
  if (state.trajectories < 0 || drawn > command.draws || of_chains + of_draws != state.numbers.size())
    work.refuse_edited(of_state);
  draws.restore(std::span(state.numbers).last(of_draws), drawn);
  state.numbers.resize(of_chains);
  return state;
}

/// Where that takes no more than a twentieth of the time, or is asked for.
void save(const sample_command& command, const hmc_state& state, kept_draws& draws, work_file& work) {
  bool is_due = command.every.has_value() || work.is_due();
  broadcast(all_ranks(), is_due);
  if (!is_due) return;
  draws.gather(all_ranks());
  on_first(all_ranks(), [&] {
    std::vector<double> numbers = state.numbers;
    const auto drawn = draws.first(draws_before(command, state.trajectories));
    numbers.insert(numbers.end(), drawn.begin(), drawn.end());
    work.replace(of_state, {{"trajectories", state.trajectories}, {"numbers", state.numbers.size()}},
                 std::move(numbers));
  });
}

/// The results for machines.
struct sample_result {
  std::string method;
  std::string system;
  double temperature;
  double step;
  double length;
  std::int64_t chains;
  std::int64_t burn_in;
  std::int64_t draws;
  double acceptance;
  double energy_error;
  std::int64_t diverged;
  double evaluations_of_draw;
  double evaluations_of_burn_in;
  bool converged;
  std::vector<summary_of_scalar> scalars;
  std::vector<double> deviations;  // of the momenta, where masses were found
  std::vector<std::string> warnings;
  std::string output;
};

sample_result result_of(const sample_command& command, const method_source& source,
                        const prepared_problem& system, const hmc_options& options, const hmc_result& found,
                        const std::vector<summary_of_scalar>& all) {
  return {source.typed,
          system.description(),
          command.temperature,
          found.step,
          options.length,
          command.chains,
          command.burn_in,
          command.draws,
          found.acceptance.mean,
          std::sqrt(found.square_of_energy_error.mean),
          found.diverged,
          found.evaluations_of_draw,
          found.evaluations_of_burn_in,
          has_converged(all),
          all,
          found.deviations,
          {},
          {}};
}

/// The same in words.
std::string text_of(const sample_command& command, const method_source& source,
                    const prepared_problem& system, const hmc_options& options, const hmc_result& found,
                    const std::vector<summary_of_scalar>& all) {
  std::string text =
      fmt::format("{} on {}: exp(-V/kT), kT = {:g}, {} chains of {} draws after {}\n", source.typed,
                  system.description(), command.temperature, command.chains, command.draws, command.burn_in);
  text += fmt::format(
      "step {:.4g}{}, trajectories of mean length {:.4g}{}\n", found.step,
      options.acceptance ? fmt::format(", tuned to an acceptance of {:g}", *options.acceptance) : "",
      options.length, command.diagonal_masses ? ", in the unit of time of the masses" : "");
  text += fmt::format(
      "acceptance {:.3f} +- {:.1g}, (H' - H)/kT {} root mean square, {} of {} trajectories diverged\n",
      found.acceptance.mean, found.acceptance.standard_error,
      number_or_dash("{:.2e}", std::sqrt(found.square_of_energy_error.mean)), found.diverged,
      command.chains * command.draws);
  text += fmt::format("{:.1f} evaluations a draw, {:.0f} for the burn-in of a chain\n\n",
                      found.evaluations_of_draw, found.evaluations_of_burn_in);
  constexpr std::size_t most_rows = 20;
  const double evaluations = found.evaluations_of_draw * static_cast<double>(command.chains * command.draws);
  table rows(
      {"scalar", "mean", "standard error", "deviation", "effective draws", "per 1000 evaluations", "R"});
  for (std::size_t k = 0; k < std::min(all.size(), most_rows); ++k) {
    const summary_of_scalar& one = all[k];
    rows.add({one.name, fmt::format("{:.5g}", one.mean), number_or_dash("{:.1e}", one.standard_error()),
              fmt::format("{:.4g}", one.deviation), number_or_dash("{:.0f}", one.effective),
              number_or_dash("{:.3g}", 1000.0 * one.effective / evaluations),
              number_or_dash("{:.3f}", one.reduction)});
  }
  text += rows.text();
  if (all.size() > most_rows) text += fmt::format("and {} more coordinates\n", all.size() - most_rows);
  if (has_converged(all)) {
    return text + fmt::format("R is below {} for all: the chains agree\n", converged);
  }
  const auto worst = std::ranges::max_element(all, {}, [](const summary_of_scalar& one) {
    return std::isfinite(one.reduction) ? one.reduction : 0.0;
  });
  return text +
         fmt::format(
             "R of {} is {}, and must be below {} for all: the chains are not shown to agree; take more "
             "--draws or, where R stays, more --burn-in or a larger --length\n",
             worst->name, number_or_dash("{:.3f}", worst->reduction), converged);
}

/// The method at its step. Throws refusal for what cannot be sampled with.
method method_for(const method_source& source, const prepared_problem& system, const hmc_options& options,
                  bool force, std::vector<std::string>& warnings) {
  if (source.family) {
    refuse(
        "{} must be learned first: nysalt learn --system SYSTEM --family {} --loss acceptance --step STEP "
        "--output "
        "scheme.json",
        source.typed, *source.family);
  }
  if (options.acceptance && !source.fixed && !force) {
    refuse("{} must run at its own step; give --step without --acceptance, or --force", source.typed);
  }
  nysalt::method method =
      source.fixed ? *source.fixed : coefficients_at(source, system, options.step, force, {}, warnings);
  system.require_served(method.letters());
  return method;
}

void require_numbers(const sample_command& command) {
  if (command.step) require_positive("step", *command.step);
  if (command.length) require_positive("length", *command.length);
  require_positive("hmc_temperature", command.temperature);
  require_at_least_one("chains", command.chains);
  require_at_least_one("draws", command.draws);
  constexpr std::int64_t most = std::int64_t{1} << 48U;  // trajectories with noise of their own
  const auto of_chain = static_cast<double>(command.burn_in) + static_cast<double>(command.draws);
  if (static_cast<double>(command.chains) * of_chain > static_cast<double>(most)) {
    refuse(
        "--chains times --burn-in and --draws must be at most 2^48 = {} trajectories, got {} times {} and "
        "{}; "
        "take fewer",
        most, command.chains, command.burn_in, command.draws);
  }
}

void require_room(const sample_command& command, std::int64_t shown) {
  constexpr double most = 1e8;  // numbers: about a gigabyte
  const double numbers = static_cast<double>(command.chains) * static_cast<double>(command.draws) *
                         static_cast<double>(shown + 1);
  if (numbers <= most) return;
  refuse("sample: draws must fit into memory, got {:g} of {} coordinates; take fewer --draws or --chains",
         static_cast<double>(command.chains) * static_cast<double>(command.draws), shown);
}

}  // namespace

constexpr auto members(of<summary_of_scalar>) {
  using scalar = summary_of_scalar;
  return std::tuple(NYSALT_MEMBERS(scalar, name, mean, standard_error, deviation),
                    item{"effective_draws", &scalar::effective}, item{"r_hat", &scalar::reduction});
}
NYSALT_DESCRIBED(sample_result, method, system, temperature, step, length, chains, burn_in, draws, acceptance,
                 energy_error, diverged, evaluations_of_draw, evaluations_of_burn_in, converged, scalars,
                 deviations, warnings, output)

json schema_of_sample() { return whole_schema<sample_result>("nysalt sample"); }

int sample(const sample_command& command, const common_settings& common) {
  require_numbers(command);
  const auto system = make_system(command.system);
  if (system->heat_bath().acts())
    refuse(
        "sample: the system must have no bath, as --hmc-temperature is the temperature; leave --friction "
        "away");
  method_source source;
  collectively(all_ranks(), [&] { source = find_method(command.method, {}, system->letters()); });
  on_first(all_ranks(), [&] { require_files(command); });
  charge(source, *system);
  hmc_options options = hmc_options_of(command, *system, source, common);
  std::vector<std::string> warnings;
  const nysalt::method method = method_for(source, *system, options, common.force, warnings);
  const std::int64_t shown = std::min<std::int64_t>(system->dimension(), 1000);
  require_room(command, shown);

  progress line;
  warn_of_threads(common);
  prepare_starts(*system, common, line, warnings);
  const json question = question_of(command, *system, method, options);
  require_agreement("chains", question.dump(-1, ' ', false, json::error_handler_t::replace));
  kept_draws draws(command.chains, command.draws, shown);
  hmc_state from;
  const auto work = begin_work(command.output, question, command.resume);
  if (work && work->has(of_state)) {
    from = state_in(command, *work, draws);
    options.from = &from;
  }
  tell_of_origin(work.get());
  if (work) {
    constexpr std::int64_t times = 200;  // to look at the clock
    options.keep_every = command.every.value_or((command.burn_in + command.draws) / times + 1);
    options.keep = [&](const hmc_state& state) { save(command, state, draws, *work); };
  }
  line.part("sampling");
  options.execution.progress = line.counter(command.chains * (command.burn_in + command.draws));
  const hmc_result found = hmc(system->definition().system, method, system->prepared_starts(), options,
                               [&](const hmc_draw& draw) { draws.take(draw); });
  line.clear();
  draws.gather(all_ranks());

  on_first(all_ranks(), [&] {
    std::vector<summary_of_scalar> all;
    for (std::size_t k = 0; k < draws.scalars(); ++k) all.push_back(summary_of(draws, k));
    const auto write = [&] {
      if (command.output.empty()) return;
      json made = written_by("nysalt sample");
      made["method"] = source.typed;
      made.update(question);
      write_result(command.output, first_line_of_table(made) + draws.csv());
      work->remove();
    };
    write_and_print(write, [&](bool written) {
      const bool is_there = written && !command.output.empty();
      if (common.json) {
        sample_result result = result_of(command, source, *system, options, found, all);
        result.warnings = warnings;
        if (is_there) result.output = command.output;
        print(text_of(whole_document(result)));
        return;
      }
      for (const auto& warning : warnings) warn(warning);
      print(text_of(command, source, *system, options, found, all) +
            (is_there ? line_of_written(command.output) : ""));
    });
  });
  return done;
}

}  // namespace nysalt::program
