// SPDX-License-Identifier: BSL-1.0
#include "contest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

namespace nysalt::sampling_benchmark {

namespace {

hmc_options options_of(double step, const contest_options& options) {
  return {.step = step,
          .length = options.length,
          .burn_in = 0,
          .draws = options.pilot,
          .execution = {.threads = options.threads}};
}

double energy_error(const target& of, const method& word, double step, const contest_options& options) {
  const auto found = hmc(of.system, word, of.starts, options_of(step, options), [](const hmc_draw&) {});
  return found.diverged > 0 ? std::numeric_limits<double>::infinity()
                            : std::sqrt(found.square_of_energy_error.mean);
}

template <int Drifts>
std::pair<method, bool> fitted(const small_target& small, double step, const contest_options& options) {
  const double whole = std::max(1.0, std::round(2.0 * options.length / step));
  data_options training{.step = step,
                        .horizon = (whole + 0.5) * step,  // that many steps
                        .trajectories = 200,
                        .execution = {.threads = options.threads}};
  data_options others = training;
  others.seed = 2;
  const auto reference = fine_steps(step / 40.0);
  const auto data = make_flow_map_data(small.of.system, small.of.starts, reference, training);
  const auto unseen = make_flow_map_data(small.of.system, small.of.starts, reference, others);
  const auto found = learn(bab<Drifts>{}, small.of.system, data, unseen,
                           {.loss = loss_named("acceptance"),
                            .planned_steps = static_cast<std::int64_t>(4.0 * whole),
                            .execution = {.threads = options.threads}});
  return {found.method.anywhere(), found.summary.usable};
}

std::pair<method, bool> fitted(int drifts, const small_target& small, double step,
                               const contest_options& options) {
  switch (drifts) {
    case 2:
      return fitted<2>(small, step, options);
    case 3:
      return fitted<3>(small, step, options);
    case 4:
      return fitted<4>(small, step, options);
    case 5:
      return fitted<5>(small, step, options);
    default:
      return fitted<6>(small, step, options);
  }
}

}  // namespace

double energy_error_at(double acceptance) { return std::sqrt(8.0) * boost::math::erfc_inv(acceptance); }

double step_with_error(const target& of, const method& word, double guess, double wanted,
                       const contest_options& options) {
  const auto is_below = [&](double step) { return energy_error(of, word, step, options) < wanted; };
  // The error of a word need not rise with the step: from above, the first step that is small enough.
  constexpr double ratio = 1.06;
  double step = guess;
  while (is_below(step)) step *= 1.2;
  while (!is_below(step)) step /= ratio;
  double above = step * ratio;
  for (int n = 0; n < 3; ++n) {
    const double middle = std::sqrt(step * above);
    (is_below(middle) ? step : above) = middle;
  }
  return std::sqrt(step * above);
}

double foretold_step(const small_target& small, const method& word, double guess,
                     const contest_options& options) {
  contest_options many = options;
  many.pilot = 400;
  return step_with_error(small.of, word, guess, energy_error_at(0.9) / std::sqrt(small.ratio), many);
}

learned_word learned_bab(int drifts, const small_target& small, double guess,
                         const contest_options& options) {
  contest_options many = options;
  many.pilot = 400;
  const double wanted = energy_error_at(0.9) / std::sqrt(small.ratio);
  constexpr double ratio = 1.12;
  std::optional<learned_word> best;
  double step = guess;
  for (int n = 0; n < 8; ++n) {
    const auto [word, usable] = fitted(drifts, small, step, options);
    const bool is_below = energy_error(small.of, word, step, many) < wanted;
    if (!is_below && best) break;  // the one before was good enough
    if (is_below || n == 7) {
      const std::string name = fmt::format("learned bab{}{}", drifts, usable ? "" : " (not usable)");
      best = {method(name, word.letters(), word.coefficients(), word), step};
    }
    if (is_below && step < guess) break;  // the one before was not
    step = is_below ? step * ratio : step / ratio;
  }
  return *best;
}

outcome run_chains(const target& of, const method& word, double step, const statistic& measured,
                   std::int64_t draws, const contest_options& options) {
  hmc_options chains = options_of(step, options);
  chains.burn_in = 20;
  chains.draws = draws;
  chains.seed = 100;
  running_errors errors(measured, chains.chains);
  const auto found =
      hmc(of.system, word, of.starts, chains, [&](const hmc_draw& draw) { errors.take(draw.chain, draw.q); });
  // The force at the start of a trajectory is that at the end of the one before, and not counted.
  const double evaluations =
      found.evaluations_of_draw - word.letters().evaluations_to_open - word.letters().evaluations_to_observe;
  const auto cost = [&](std::vector<double> error_curve::*which) {
    return estimate{draws_to_low_error(errors.curves(), which) * evaluations,
                    deviation_of_draws(errors.curves(), which) * evaluations};
  };
  return {.step = step,
          .acceptance = found.acceptance.mean,
          .evaluations_of_draw = evaluations,
          .to_mean_error = cost(&error_curve::mean),
          .to_largest_error = cost(&error_curve::largest),
          .mean_errors = median_curve(errors.curves(), &error_curve::mean)};
}

initial_states reached_by(const target& of, const method& word, double step, std::int64_t chains,
                          std::int64_t burn_in, std::int64_t draws, const contest_options& options) {
  hmc_options how = options_of(step, options);
  how.chains = chains;
  how.burn_in = burn_in;
  how.draws = draws;
  std::vector<Eigen::VectorXd> positions(static_cast<std::size_t>(chains * draws));
  hmc(of.system, word, of.starts, how, [&](const hmc_draw& draw) {
    positions[static_cast<std::size_t>(draw.chain * draws + draw.number)] = draw.q;
  });
  return thermal_positions(of.system, std::move(positions), 1.0);
}

}  // namespace nysalt::sampling_benchmark
