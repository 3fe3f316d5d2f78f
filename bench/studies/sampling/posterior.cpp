// SPDX-License-Identifier: BSL-1.0
// A logistic regression of 25 coefficients, where no word gains much.
#include <fmt/format.h>

#include <cmath>

#include "chapters.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt::sampling_benchmark {

namespace {

/// q_i^2 with mean and variance of long chains.
statistic squares_by(const target& of, double step, const contest_options& options, std::int64_t draws) {
  constexpr std::size_t chains = 16;
  const Eigen::Index n = size(of.system);
  std::vector<Eigen::VectorXd> first(chains, Eigen::VectorXd::Zero(n));
  std::vector<Eigen::VectorXd> second = first;
  hmc(of.system, bcss3{}, of.starts,
      {.step = step,
       .length = options.length,
       .chains = chains,
       .burn_in = 100,
       .draws = draws,
       .seed = 7,
       .execution = {.threads = options.threads}},
      [&](const hmc_draw& draw) {
        const auto m = static_cast<std::size_t>(draw.chain);
        first[m] += draw.q.cwiseAbs2();
        second[m] += draw.q.cwiseAbs2().cwiseAbs2();
      });
  for (std::size_t m = 1; m < chains; ++m) {
    first[0] += first[m];
    second[0] += second[m];
  }
  const double count = static_cast<double>(chains) * static_cast<double>(draws);
  statistic result{
      [](const Eigen::VectorXd& q, Eigen::VectorXd& f) { f = q.cwiseAbs2(); }, first[0] / count, {}};
  result.variance = second[0] / count - result.mean.cwiseAbs2();
  return result;
}

}  // namespace

void add_posterior(const extent& how, page& to, table& rows) {
  const model system = bundled("logistic_regression");
  const Eigen::Index n = size(system);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(n);
  target of{system, normal_around<Eigen::Dynamic>({rest, rest}, 0.1, 1.0)};
  const contest_options typical{.length = 0.2, .pilot = 400, .threads = how.threads};
  say("pilot chains of the posterior");
  const double pilot_step = step_with_error(of, bcss3{}, 0.1, energy_error_at(0.95), typical);
  of.starts = reached_by(of, bcss3{}, pilot_step, 16, 200, 40, typical);
  const statistic measured = squares_by(of, pilot_step, typical, how.quick ? 2000 : 12'000);
  std::vector<contender> words{{verlet{}, 0.05}, {mclachlan2{}, 0.1}, {bcss3{}, 0.15}, {omelyan5v{}, 0.2}};
  say("learning bab3");
  const auto learned = learned_bab(3, {of, 1.0}, 0.18, typical);
  words.push_back({learned.word, learned.step});
  const std::int64_t draws = how.quick ? 2000 : 4000;
  const race found = run_race("logistic_regression, 25 coefficients", of, words, measured,
                              &error_curve::largest, {{0.1, draws}, {0.2, draws}, {0.3, draws}}, how);
  to.heading("Few dimensions");
  to.text(
      "The posterior of a logistic regression on 500 rows of 24 predictors and an intercept, the example "
      "that "
      "`logistic_regression` uses without `--data`. In so few dimensions an acceptance of 0.9 is reached at "
      "steps near the end of stability, where the order of a word does not count: a word of three stages "
      "such "
      "as `bcss3` saves gradients, and learning gains only what exceeds the errors in the table.");
  to.text(fmt::format("Trajectories of mean length {:g}, of those tried the best for all words together:",
                      found.length));
  add_race(found, to, rows, true);
}

}  // namespace nysalt::sampling_benchmark
