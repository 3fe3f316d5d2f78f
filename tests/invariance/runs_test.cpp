// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 9 s at -O0, 0.5 s at -O1.
// Trajectories have the same bits on any number of threads, in any lanes, on any ranks, and cut.
#include "law.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/ensembles/gibbs.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;

const normal_around<1> around_0({vector<double, 1>(0.0), vector<double, 1>(0.0)}, 1.0, 1.0);
constexpr std::int64_t steps = 200;
constexpr std::int64_t every = 7;

/// Of these some leave the well, at steps of their own.
const initial_states wide =
    normal_around<2>({vector<double, 2>::Zero(), vector<double, 2>::Zero()}, 0.45, 0.45);
model galaxy_in_noise(const division& how) {
  return divided(henon_heiles(), bath::of_sigma(0.05, 0.05), how);
}
auto obabo_of(const model& system, double step, std::uint64_t seed) {
  return make_stepper(system, method(obabo()), step, counter_noise(seed));
}
template <class T>
const auto read_first = [](const auto& x, std::span<T> first) { first[0] = x.q[0]; };

/// What is seen of trajectories; kept from several threads.
struct sightings {
  explicit sightings(std::int64_t count) : of_each(static_cast<std::size_t>(count)) {}
  auto take() {
    return [this](std::int64_t m, std::int64_t n, std::span<const double> seen) {
      of_each[static_cast<std::size_t>(m)] << n << seen;
    };
  }
  result with(const auto& diverged_at) const {
    result all;
    all.of_all << diverged_at;
    for (std::size_t m = 0; m < of_each.size(); ++m) {
      if (!of_each[m].empty()) all.of_each[static_cast<std::int64_t>(m)] = of_each[m];
    }
    return all;
  }
  std::vector<numbers> of_each;
};

result resumed_ensemble(const division& how, std::uint64_t seed) {
  sightings seen(trajectories);
  saved_runs saved;
  const auto go_on = [&](const division& part, std::int64_t end) {
    const model system = galaxy_in_noise(part);
    const auto stepper = obabo_of(system, 0.1, seed);
    detail::with_scalar_of(system, [&]<class T>(T) {
      using run_type = ensemble_run<T, std::remove_const_t<decltype(stepper)>>;
      const execution in_threads{.threads = part.threads};
      auto run = saved.step == 0 ? run_type(stepper, wide, seed, 0, trajectories, in_threads)
                                 : run_type(stepper, wide, seed, 0, trajectories, saved, in_threads);
      run.go_on(end, every, 1, read_first<T>, seen.take(), in_threads);
      saved = run.save();
    });
  };
  if (how.is_cut) go_on({.threads = 2, .in_lanes = !how.in_lanes}, steps_between_checks);
  go_on(how, steps);
  result all = seen.with(saved.diverged_at);
  all.of_all << saved.numbers;
  return all;
}

/// Cut between trajectories.
result followed_ensemble(const division& how, std::uint64_t seed, const model& system,
                         const initial_states& starts) {
  const auto stepper = obabo_of(system, 0.1, seed);
  sightings seen(trajectories);
  std::vector<std::optional<std::int64_t>> diverged_at;
  const auto follow = [&](std::int64_t first, std::int64_t count) {
    ensemble_options options{.trajectories = count,
                             .steps = steps,
                             .every = every,
                             .seed = seed,
                             .execution = {.threads = how.threads, .ranks = how.ranks}};
    options.first = first;
    detail::with_scalar_of(system, [&]<class T>(T) {
      const auto part = integrate_ensemble<T>(stepper, starts, options, 1, read_first<T>, seen.take());
      diverged_at.insert(diverged_at.end(), part.begin(), part.end());
    });
  };
  if (how.is_cut) follow(0, 10);
  follow(how.is_cut ? 10 : 0, trajectories - (how.is_cut ? 10 : 0));
  return seen.with(diverged_at);
}

/// Cut where further trajectories are added to the data of fewer.
result pairs(const division& how, std::uint64_t seed, const model& system, const auto& reference, int parts) {
  data_options options{.step = 0.02,
                       .horizon = 0.1,
                       .trajectories = trajectories,
                       .seed = seed,
                       .noise_parts = parts,
                       .execution = {.threads = how.threads, .ranks = how.ranks}};
  flow_map_data data;
  if (how.is_cut) {
    options.trajectories = 20;
    detail::extend_data(system, law, reference, options, data);
    options.trajectories = trajectories;
    detail::extend_data(system, law, reference, options, data);
  } else {
    data = make_flow_map_data(system, law, reference, options);
  }
  result all;
  all.of_all << data.energies->low << data.energies->high << data.all_pairs();
  for (const auto& x : data.further_starts) all.of_all << x;
  const std::int64_t first = data.share().first();
  for (std::size_t m = 0; m < data.trajectories(); ++m) {
    numbers& of_one = all.of_each[first + static_cast<std::int64_t>(m)];
    for (std::size_t n = data.first_of[m]; n < data.first_of[m + 1]; ++n) {
      of_one << data.start[n] << data.finish[n];
      for (int k = 0; k < parts; ++k) {
        of_one << data.noise[n * static_cast<std::size_t>(parts) + static_cast<std::size_t>(k)];
      }
    }
  }
  return all;
}

/// Of data that were made at once: those that grew have more checks.
result checks_of_pairs(const division& how, std::uint64_t seed) {
  const auto data = make_flow_map_data(in_noise(how), law, fine_paths(1e-3),
                                       {.step = 0.02,
                                        .horizon = 0.1,
                                        .trajectories = trajectories,
                                        .seed = seed,
                                        .execution = {.threads = how.threads, .ranks = how.ranks}});
  result all;
  all.of_all << data.evaluations;
  for (const auto& [pair, finish] : data.finer) {
    all.of_each[static_cast<std::int64_t>(data.first_pair() + pair)] << finish;
  }
  return all;
}

result starts_after_a_burn_in(const division& how, std::uint64_t seed) {
  const in_bath warm(harmonic_oscillator(3.0), bath::of_temperature(0.01, 0.7));
  const gibbs ensemble(warm, around_0,
                       {.friction = 6.0, .pilots = 50, .seed = seed, .execution = {.threads = how.threads}});
  const burn_in_report& report = ensemble.report();
  result all;
  all.of_all << report.tau << report.length;
  for (const auto* means : {&report.bias, &report.excess, &report.to_forget}) {
    for (const auto& one : *means) all.of_all << one.mean << one.standard_error;
  }
  constexpr int count = 5;
  const auto block = ensemble.block<detail::lanes>(seed, 3, std::min(count, pack<double>::lanes));
  for (int k = 0; k < count; ++k) {
    const bool from_block = how.in_lanes && k < pack<double>::lanes;
    all.of_all << (from_block ? lane(block, k) : ensemble(seed, static_cast<std::uint64_t>(3 + k)));
  }
  return all;
}

result judged(const division& how, std::uint64_t seed, const model& system, const method& method) {
  phase_points starts;
  for (std::uint64_t m = 0; m < 100; ++m) starts.push_back(law(seed, m));  // more than a block
  const judgement found = judge(system, starts, method, 0.04,
                                {.steps = 128, .seed = seed, .execution = {.threads = how.threads}});
  result all;
  all.of_all << found.trajectories << found.lost << found.diverged << found.kinetic_energy
             << found.energy_error.median << found.energy_error.most << found.energy_error.largest
             << found.drift << found.growth << found.farthest << found.unconfined << found.highest_frequency;
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(no_trajectory_depends_on_how_it_was_divided) {
  const auto quiet = [](const division& how) { return divided(chain, how); };
  require_invariance({
      {"an ensemble that is resumed", by_threads + by_lanes + by_cuts, resumed_ensemble},
      {"an ensemble", by_threads + by_lanes + by_ranks + by_cuts,
       [](const auto& how, auto seed) { return followed_ensemble(how, seed, galaxy_in_noise(how), wide); }},
      {"an ensemble of a black box", by_threads + by_ranks + by_cuts,
       [](const auto& how, auto seed) {
         return followed_ensemble(how, seed, in_bath(black_box(), bath::of_sigma(0.5, 0.3)), around_0);
       }},
      {"pairs", by_threads + by_lanes + by_ranks + by_cuts,
       [&](const auto& how, auto seed) { return pairs(how, seed, quiet(how), fine_steps(1e-3), 0); }},
      {"pairs in a bath", by_threads + by_lanes + by_ranks + by_cuts,
       [](const auto& how, auto seed) { return pairs(how, seed, in_noise(how), fine_paths(1e-3), 2); }},
      {"checks of pairs", by_threads + by_lanes + by_ranks, checks_of_pairs},
      {"starts after a burn-in", by_threads + by_lanes, starts_after_a_burn_in},
      {"a judgement", by_threads + by_lanes,
       [&](const auto& how, auto seed) { return judged(how, seed, quiet(how), method(verlet())); }},
      {"a judgement in a bath", by_threads + by_lanes,
       [](const auto& how, auto seed) { return judged(how, seed, in_noise(how), method(obabo())); }},
  });
}

// A sum in the order of threads or ranks, a result that says how many lanes there were, and a run that is
// closed and opened where it is cut.
BOOST_AUTO_TEST_CASE(a_computation_that_depends_on_its_division_is_found) {
  const auto shows = [](const std::string& name, unsigned divides, const auto& of) {
    const computation planted{name, divides, of};
    BOOST_TEST(!divisions_that_show(planted).empty(), name);
  };
  const auto sum_in_parts = [](int parts) {
    double whole = 0.0;
    for (int part = 0; part < parts; ++part) {
      double sum = 0.0;
      for (int n = 1 + part * 1000 / parts; n <= (part + 1) * 1000 / parts; ++n) sum += 1.0 / n;
      whole += sum;
    }
    result all;
    all.of_all << whole;
    return all;
  };
  shows("threads", by_threads, [&](const auto& how, auto) { return sum_in_parts(how.threads); });
  shows("lanes", by_lanes, [&](const auto& how, auto) { return sum_in_parts(how.in_lanes ? 8 : 1); });
  shows("ranks", by_ranks, [&](const auto& how, auto) { return sum_in_parts(how.ranks->size()); });
  shows("a rank's own", by_ranks, [](const auto& how, auto) {
    result all;
    all.of_all << how.ranks->rank();
    return all;
  });
  shows("two ranks with one trajectory", by_ranks, [](const auto&, auto) {
    result all;
    all.of_each[3] << 1.0;
    return all;
  });
  shows("a cut", by_cuts, [](const auto& how, auto seed) {
    const model system = divided(chain, how);
    const auto fixed = make_stepper(system, method(verlet()), 0.01);
    auto run = fixed.open(law(seed, 0));
    for (int n = 0; n < 41; ++n) {
      fixed.advance(run, 1);
      if (how.is_cut) run = fixed.open(fixed.synchronous(run));
    }
    result all;
    all.of_all << fixed.synchronous(run);
    return all;
  });
}

namespace {

/// Fowler, Noll and Vo's hash FNV-1a of the bits of the ends of 37 trajectories, whose starts no generator
/// and no library function has a part in.
std::uint64_t hash_of_ends(const model& system, const method& method, double step) {
  const auto fixed = make_stepper(system, method, step, counter_noise(1));
  const auto part = [](std::int64_t k) { return static_cast<double>(k % 101) / 202.0 - 0.25; };
  std::uint64_t hash = 0xcbf29ce484222325U;  // offset basis and prime for 64 bits
  for (std::int64_t m = 0; m < 37; ++m) {
    state x{Eigen::VectorXd(size(system)), Eigen::VectorXd(size(system))};
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      x.q[i] = part(37 * m + 11 * i + 5);
      x.p[i] = part(53 * m + 29 * i + 17);
    }
    const auto end = integrate(
                         fixed, x, 1000, [](auto&&...) {}, 1000, static_cast<std::uint64_t>(m))
                         .finish;
    for (const auto* numbers : {&end.q, &end.p}) {
      for (const double u : *numbers) hash = (hash ^ std::bit_cast<std::uint64_t>(u)) * 0x100000001b3U;
    }
  }
  return hash;
}

}  // namespace

// Systems made of + - * / and sqrt; the exponentials of the bath are of one library.
BOOST_AUTO_TEST_CASE(every_compiler_makes_the_same_bits) {
  BOOST_TEST(hash_of_ends(chain, member(nystrom(), {0.51, 0.4}), 0.03) == 0x72d20a23d494d637U);
  BOOST_TEST(hash_of_ends(henon_heiles(), method(srkn11b()), 0.1) == 0xbbe778e91101a5f4U);
  const in_bath warm(chain, bath::of_sigma(0.01, 0.05));
  BOOST_TEST(hash_of_ends(warm, method(obabo()), 0.01) == 0x825a4393124ca5b3U);
  // One bit of one number is enough to be seen.
  const fpu_chain<3> other(std::nextafter(50.0, 51.0));
  BOOST_TEST(hash_of_ends(other, member(nystrom(), {0.51, 0.4}), 0.03) != 0x72d20a23d494d637U);
}
