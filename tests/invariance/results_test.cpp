// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 56 s at -O0, 4 s at -O1.
// Statistics, errors, draws and fits have the same bits on any number of threads, in any lanes, on any ranks,
// and cut.
#include "../../src/nysalt/losses/after_steps.hpp"
#include "law.hpp"
#include "nysalt/analysis/acceptance.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/error_measures.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/hmc.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

const initial_states around_0 =
    normal_around<6>({vector<double, 6>::Zero(), vector<double, 6>::Zero()}, 0.05, 1.0);
constexpr double unstable = 0.04;  // z = 2: in 20 steps some trajectories diverge

void require_some_of_both(std::size_t diverged, std::size_t all) {
  if (diverged == 0 || diverged == all) throw std::logic_error("some must diverge, and not all");
}

/// Of groups of one trajectory, or of 32 with a part of one at the end.
result statistics(const division& how, std::uint64_t seed, std::int64_t count) {
  ensemble_options options{.trajectories = count,
                           .steps = 20,
                           .seed = seed,
                           .execution = {.threads = how.threads, .ranks = how.ranks}};
  options.first = 5;
  const model system = in_noise(how);
  const auto found = ensemble_statistics(make_stepper(system, method(obabo()), unstable, counter_noise(seed)),
                                         law, options, over_lanes([](const auto& x) { return x.q[0]; }),
                                         {.histogram = equal_bins{-1.0, 1.0, 50},
                                          .lags = 12,
                                          .moments = true,
                                          .kinetic_temperature = true,
                                          .half_step_kinetic_temperature = true});
  require_some_of_both(found.lost.size(), static_cast<std::size_t>(count));
  result all;
  all.of_all << found.counted << found.samples << found.lost << found.histogram->counts() << found.mean
             << found.variance << found.effective_sample_size << found.kinetic_temperature
             << found.half_step_kinetic_temperature;
  for (const auto& group : found.histogram_of_groups) all.of_all << group.counts();
  for (std::size_t lag = 0; lag < 12; ++lag) all.of_all << found.autocovariance->covariance(lag);
  return all;
}

trajectory_options options_of(const division& how, std::uint64_t seed, double step) {
  return {.step = step,
          .steps = 20,
          .trajectories = trajectories,
          .seed = seed,
          .execution = {.threads = how.threads, .ranks = how.ranks}};
}

result accepted(const division& how, std::uint64_t seed) {
  const auto found = acceptance(divided(chain, how), method(verlet()), law, options_of(how, seed, unstable));
  require_some_of_both(found.diverged_at.size(), found.of_each.size());
  result all;
  all.of_all << found.probability << found.of_each << found.diverged_at;
  return all;
}

/// With the null model and the predictability, which have runs of their own.
result errors(const division& how, std::uint64_t seed, const model& system, const auto& reference,
              const std::vector<method>& methods) {
  trajectory_options options = options_of(how, seed, unstable);
  options.null_model = true;
  options.perturbation = 1e-3;
  const std::vector<error_measure> measures{state_measure(system),
                                            path_measure(system, [](const auto& x) { return x.q[0]; }),
                                            energy_measure(system)};
  result all;
  for (const auto& found : trajectory_errors(system, reference, law, methods, measures, options)) {
    require_some_of_both(found.methods[0].diverged_at.size(), found.methods[0].of_each.size());
    all.of_all << found.reference_error << found.null_model << found.predictable_until << found.unit;
    for (const auto& one : found.methods) {
      all.of_all << one.error << one.diverged_at << one.of_each << one.spread.median << one.spread.quantiles;
    }
  }
  return all;
}

result proposals(const division& how, std::uint64_t seed) {
  const model system = divided(chain, how);
  result all;
  for (const double larger : {1.0, 40.0}) {
    const proposal_options options{.length = 0.1,
                                   .times_larger = larger,
                                   .states = 45,
                                   .seed = seed,
                                   .execution = {.threads = how.threads, .ranks = how.ranks}};
    const auto found = detail::acceptance_of_proposals(system, method(bcss3()), 0.03, law, options);
    all.of_all << found.probability << found.of_each;
    const auto step = step_at_acceptance(
        system, [](double) { return method(bcss3()); }, 0.8, 0.02, law, options);
    all.of_all << step.step << step.log_step << step.log_of_each;
  }
  return all;
}

/// Cut in the burn-in, by one rank with one thread.
result draws_of_chains(const division& how, std::uint64_t seed) {
  hmc_options options{.step = 0.02,
                      .length = 0.1,
                      .chains = trajectories,
                      .burn_in = 100,
                      .draws = 8,
                      .acceptance = 0.9,
                      .diagonal_masses = true,
                      .seed = seed,
                      .keep_every = 40};
  const model system = divided(chain, how);
  std::vector<hmc_state> kept;
  options.keep = [&](const hmc_state& state) { kept.push_back(state); };
  result all;
  if (how.is_cut) hmc(system, method(bcss3()), around_0, options, [](const hmc_draw&) {});
  const hmc_state before = how.is_cut ? kept.front() : hmc_state();
  if (how.is_cut) options.from = &before;
  options.execution = {.threads = how.threads, .ranks = how.ranks};
  std::vector<numbers> of_each(static_cast<std::size_t>(trajectories));
  const auto found = hmc(system, method(bcss3()), around_0, options, [&](const hmc_draw& draw) {
    of_each[static_cast<std::size_t>(draw.chain)] << draw.number << draw.q << draw.potential;
  });
  all.of_all << kept.back().trajectories << kept.back().numbers;
  all.of_all << found.step << found.acceptance << found.square_of_energy_error << found.diverged
             << found.evaluations_of_draw << found.evaluations_of_burn_in << found.deviations;
  for (std::size_t m = 0; m < of_each.size(); ++m) {
    if (!of_each[m].empty()) all.of_each[static_cast<std::int64_t>(m)] = of_each[m];
  }
  return all;
}

flow_map_data data_of(const division& how, std::uint64_t seed, const model& system, const auto& reference) {
  return make_flow_map_data(system, law, reference,
                            {.step = 0.03,
                             .horizon = 0.15,
                             .trajectories = trajectories,
                             .seed = seed,
                             .noise_parts = system.bath().acts() ? 2 : 0,
                             .execution = {.threads = how.threads, .ranks = how.ranks}});
}

/// Of windows of three steps, whatever the residuals.
result sums_over_windows(const division& how, const model& system, const flow_map_data& data,
                         const family& family) {
  const metric measure(system, data, coordinates::qp);
  result all;
  const auto add = [&]<Scalar R>(R) {
    const after_steps<R> loss(family, system, data, state_error<R>(measure),
                              {.steps = {1, 3}, .execution = {.threads = how.threads}});
    const Eigen::Vector2d theta(0.45, 0.38);
    const squares found = loss.at(theta);
    all.of_all << found.value << found.half_gradient << found.normal_matrix.reshaped()
               << loss.by_trajectory(theta);
    for (const auto& gradient : loss.gradients(theta)) all.of_all << gradient.reshaped();
  };
  how.in_lanes ? add(detail::lanes(0.0)) : add(0.0);
  return all;
}

numbers numbers_of(const fit& learned) {
  const fit_summary& found = learned.summary;
  numbers all;
  all << learned.theta << found.loss << found.held_out_loss << found.held_out_start_loss
      << found.held_out_noise << found.expected_excess << found.deciding_trajectories << found.condition
      << found.one_step_error << found.trajectory_error << found.reference_error << found.samples
      << found.trajectories << found.held_out_samples << found.learning_evaluations << found.iterations
      << found.usable;
  for (const auto& one : found.parameters) all << one.value << one.standard_error;
  return all;
}

/// All that a rank does: data, search and judgement.
result fitted(const division& how, std::uint64_t seed, const model& system, const auto& reference,
              const family& family) {
  const auto data = data_of(how, seed, system, reference);
  const auto held_out = data_of(how, seed + 100, system, reference);
  const fit_options options{.random_starts = 1, .planned_steps = 500, .execution = {.threads = how.threads}};
  result all;
  all.of_all = numbers_of(learn(family, system, data, held_out, options));
  return all;
}

/// By an error of one's own.
result learned_by_own_loss(const division& how, std::uint64_t seed) {
  const own_loss of_place{"place", 2,
                          []<class T>(const phase_point<T, 6>&, const phase_point<T, 6>& finish,
                                      const phase_point<T, 6>& wanted) -> std::array<T, 2> {
                            return {finish.q[0] - wanted.q[0], finish.p[3] - wanted.p[3]};
                          }};
  const auto fit_of = [&](const auto& system) {
    const auto data = data_of(how, seed, system, fine_steps(1e-3));
    const fit_options options{
        .random_starts = 0, .planned_steps = 500, .execution = {.threads = how.threads}};
    result all;
    all.of_all = numbers_of(learn(family(nystrom()), system, data, data, options, of_place));
    return all;
  };
  return how.in_lanes ? fit_of(chain) : fit_of(in_lanes<fpu_chain<3>, 1>(chain));
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_result_depends_on_how_it_was_divided) {
  const auto steps = fine_steps(1e-3);
  const auto paths = fine_paths(1e-3);
  const nysalt::family family{nystrom()};
  const nysalt::family with_o = thermostatted(family, placement::symmetric);
  constexpr unsigned by_all_but_cuts = by_threads + by_lanes + by_ranks;
  require_invariance({
      {"statistics", by_all_but_cuts,
       [](const auto& how, auto seed) { return statistics(how, seed, trajectories); }},
      {"statistics of groups", by_all_but_cuts,
       [](const auto& how, auto seed) { return statistics(how, seed, 1100); }},
      {"acceptance", by_all_but_cuts, accepted},
      {"errors", by_all_but_cuts,
       [&](const auto& how, auto seed) {
         return errors(how, seed, divided(chain, how), steps, {method(verlet()), method(bcss2())});
       }},
      {"errors in a bath", by_all_but_cuts,
       [&](const auto& how, auto seed) {
         return errors(how, seed, in_noise(how), paths, {method(baoab()), method(obabo())});
       }},
      {"acceptance of proposals", by_all_but_cuts, proposals},
      {"draws of chains", by_all_but_cuts + by_cuts, draws_of_chains},
      {"a fit", by_all_but_cuts,
       [&](const auto& how, auto seed) { return fitted(how, seed, divided(chain, how), steps, family); }},
      {"a fit in a bath", by_all_but_cuts,
       [&](const auto& how, auto seed) { return fitted(how, seed, in_noise(how), paths, with_o); }},
      {"a fit by an own loss", by_all_but_cuts, learned_by_own_loss},
  });
  for (const bool noisy : {false, true}) {
    const auto data = [&](std::uint64_t seed) {
      return noisy ? data_of({}, seed, in_noise({}), paths) : data_of({}, seed, divided(chain, {}), steps);
    };
    // Trajectories of different lengths, among them empty ones.
    const auto uneven = [&](std::uint64_t seed) {
      auto result = data(seed);
      result.first_of = {0, 0, 1, 3, 3, 20, 37, 60, 61, 61, result.pairs()};
      return result;
    };
    const std::array of_seed{uneven(1), uneven(2)};
    require_invariance({{"sums over windows", by_threads + by_lanes, [&](const auto& how, auto seed) {
                           const model system = noisy ? in_noise(how) : divided(chain, how);
                           return sums_over_windows(how, system, of_seed[seed - 1], noisy ? with_o : family);
                         }}});
  }
}
