// SPDX-License-Identifier: BSL-1.0
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "../commands.hpp"
#include "../output.hpp"
#include "../systems.hpp"
#include "comparison/checks.hpp"
#include "comparison/learning.hpp"
#include "comparison/method_source.hpp"
#include "comparison/progress.hpp"
#include "comparison/refusal.hpp"
#include "comparison/seeds.hpp"
#include "nysalt/hmc.hpp"
#include "report/manifest.hpp"
#include "report/table.hpp"

namespace nysalt::program {

namespace {

/// All draws: scalar 0 is the potential, the others are coordinates.
class kept_draws {
 public:
  kept_draws(std::int64_t chains, std::int64_t draws, std::int64_t coordinates)
      : width_(static_cast<std::size_t>(coordinates) + 1),
        of_chain_(static_cast<std::size_t>(chains),
                  std::vector<double>(static_cast<std::size_t>(draws) * width_)) {}

  void take(const hmc_draw& draw) {
    double* at = of_chain_[static_cast<std::size_t>(draw.chain)].data() +
                 static_cast<std::size_t>(draw.number) * width_;
    *at++ = draw.potential;
    std::copy(draw.q.begin(), draw.q.begin() + static_cast<std::ptrdiff_t>(width_) - 1, at);
  }
  std::size_t scalars() const { return width_; }
  static std::string name(std::size_t scalar) {
    return scalar == 0 ? "potential" : fmt::format("q{}", scalar);
  }

  std::vector<std::vector<double>> chains_of(std::size_t scalar) const {
    std::vector<std::vector<double>> result;
    for (const auto& all : of_chain_) {
      auto& one = result.emplace_back();
      for (std::size_t n = scalar; n < all.size(); n += width_) one.push_back(all[n]);
    }
    return result;
  }

  std::string csv() const {
    std::string text = "chain,draw";
    for (std::size_t k = 0; k < width_; ++k) fmt::format_to(std::back_inserter(text), ",{}", name(k));
    text += '\n';
    for (std::size_t m = 0; m < of_chain_.size(); ++m) {
      for (std::size_t n = 0; n < of_chain_[m].size(); n += width_) {
        fmt::format_to(std::back_inserter(text), "{},{}", m, n / width_);
        for (std::size_t k = 0; k < width_; ++k) {
          fmt::format_to(std::back_inserter(text), ",{}", of_chain_[m][n + k]);
        }
        text += '\n';
      }
    }
    return text;
  }

 private:
  std::size_t width_;
  std::vector<std::vector<double>> of_chain_;
};

/// What is known of a scalar.
struct summary {
  std::string name;
  double mean = 0.0;
  double deviation = 0.0;
  double effective = 0.0;
  double reduction = 0.0;
  double standard_error() const { return deviation / std::sqrt(effective); }
};

summary summary_of(const kept_draws& draws, std::size_t scalar) {
  const auto chains = draws.chains_of(scalar);
  summary result{.name = kept_draws::name(scalar)};
  double count = 0.0;
  for (const auto& chain : chains) {
    for (const double x : chain) {
      count += 1.0;
      result.mean += (x - result.mean) / count;
    }
  }
  for (const auto& chain : chains) {
    for (const double x : chain) result.deviation += (x - result.mean) * (x - result.mean) / count;
  }
  result.deviation = std::sqrt(result.deviation);
  result.effective = effective_draws(chains);
  result.reduction = potential_scale_reduction(chains);
  return result;
}

std::string number_or_dash(const char* format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

json number_or_null(double value) { return std::isfinite(value) ? json(value) : json(); }

constexpr double converged = 1.01;  // R-hat [vehtari_and_others_2021]

hmc_options options_of(const sample_command& command, const prepared_problem& system,
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
                      .threads = common.threads};
  if (!command.length && !command.diagonal_masses) {
    refuse("--length: how long should a trajectory be? A quarter of the slowest period is a good start");
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

}  // namespace

int sample(const sample_command& command, const common_settings& common) {
  if (command.step) require_positive("--step", *command.step);
  if (command.length) require_positive("--length", *command.length);
  require_positive("--hmc-temperature", command.temperature);
  require_at_least_one("--chains", command.chains);
  require_at_least_one("--draws", command.draws);
  require_table(command.output, false, command.method);
  const auto system = make_system(command.system);
  if (system->heat_bath().acts()) refuse("sample: --hmc-temperature is the temperature: leave the bath away");
  method_source source = find_method(command.method);
  charge(source, *system);
  if (source.family) {
    refuse(
        "{} must be learned first: nysalt learn --family {} --loss acceptance --step STEP --output "
        "scheme.json",
        source.typed, *source.family);
  }
  hmc_options options = options_of(command, *system, source, common);
  if (options.acceptance && !source.fixed && !common.force) {
    refuse("{} is valid at its own step: give --step without --acceptance, or --force", source.typed);
  }
  std::vector<std::string> warnings;
  const tabulated method = source.fixed
                               ? *source.fixed
                               : coefficients_at(source, *system, options.step, common.force, {}, warnings);
  system->require_served(method.letters());
  constexpr double most = 1e8;  // numbers: about a gigabyte
  const std::int64_t shown = std::min<std::int64_t>(system->dimension(), 1000);
  const double numbers = static_cast<double>(command.chains) * static_cast<double>(command.draws) *
                         static_cast<double>(shown + 1);
  if (numbers > most) {
    refuse("{:g} draws of {} coordinates would not fit into memory: take fewer --draws or --chains",
           static_cast<double>(command.chains) * static_cast<double>(command.draws), shown);
  }

  progress line;
  warn_of_threads(common);
  prepare_starts(*system, common, line);
  line.part("sampling");
  options.progress = line.counter(command.chains * (command.burn_in + command.draws));
  kept_draws draws(command.chains, command.draws, shown);
  hmc_result found;
  try {
    found = hmc(system->definition().system, method, system->prepared_starts(), options,
                [&](const hmc_draw& draw) { draws.take(draw); });
  } catch (const std::invalid_argument& problem) {
    refuse("{}", problem.what());
  } catch (const std::runtime_error& problem) {
    refuse("{}", problem.what());
  }
  line.clear();

  std::vector<summary> all;
  for (std::size_t k = 0; k < draws.scalars(); ++k) all.push_back(summary_of(draws, k));
  const auto worst = std::ranges::max_element(
      all, {}, [](const summary& one) { return std::isfinite(one.reduction) ? one.reduction : 0.0; });
  const bool is_converged =
      std::ranges::all_of(all, [](const summary& one) { return one.reduction < converged; });
  const double evaluations = found.evaluations_of_draw * static_cast<double>(command.chains * command.draws);

  json document{{"method", source.typed},
                {"system", system->description()},
                {"temperature", command.temperature},
                {"step", found.step},
                {"length", options.length},
                {"chains", command.chains},
                {"burn_in", command.burn_in},
                {"draws", command.draws},
                {"acceptance", found.acceptance.mean},
                {"energy_error", number_or_null(std::sqrt(found.square_of_energy_error.mean))},
                {"diverged", found.diverged},
                {"evaluations_of_draw", found.evaluations_of_draw},
                {"evaluations_of_burn_in", found.evaluations_of_burn_in},
                {"converged", is_converged},
                {"scalars", json::array()},
                {"warnings", warnings}};
  for (const auto& one : all) {
    document["scalars"].push_back({{"name", one.name},
                                   {"mean", one.mean},
                                   {"standard_error", number_or_null(one.standard_error())},
                                   {"deviation", one.deviation},
                                   {"effective_draws", number_or_null(one.effective)},
                                   {"r_hat", number_or_null(one.reduction)}});
  }
  if (!found.deviations.empty()) document["deviations"] = found.deviations;
  if (!command.output.empty()) {
    write_result(command.output, draws.csv(), common);
    document["output"] = command.output;
  }
  if (common.json) {
    print(text_of(document));
    return done;
  }
  for (const auto& warning : warnings) warn(warning);
  std::string text =
      fmt::format("{} on {}: exp(-V/kT), kT = {:g}, {} chains of {} draws after {}\n", source.typed,
                  system->description(), command.temperature, command.chains, command.draws, command.burn_in);
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
  table rows(
      {"scalar", "mean", "standard error", "deviation", "effective draws", "per 1000 evaluations", "R"});
  for (std::size_t k = 0; k < std::min(all.size(), most_rows); ++k) {
    const summary& one = all[k];
    rows.add({one.name, fmt::format("{:.5g}", one.mean), number_or_dash("{:.1e}", one.standard_error()),
              fmt::format("{:.4g}", one.deviation), number_or_dash("{:.0f}", one.effective),
              number_or_dash("{:.3g}", 1000.0 * one.effective / evaluations),
              number_or_dash("{:.3f}", one.reduction)});
  }
  text += rows.text();
  if (all.size() > most_rows) text += fmt::format("and {} more coordinates\n", all.size() - most_rows);
  text += is_converged
              ? fmt::format("R is below {} for all: the chains agree\n", converged)
              : fmt::format(
                    "R of {} is {}: chains have not converged; take more --burn-in and --draws, or a larger "
                    "--length\n",
                    worst->name, number_or_dash("{:.3f}", worst->reduction));
  if (!command.output.empty()) text += fmt::format("Written: {}\n", command.output);
  print(text);
  return done;
}

}  // namespace nysalt::program
