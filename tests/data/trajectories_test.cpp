// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.1 s at -O0, 0.1 s at -O1.
// What an observer of many trajectories is given is what an observer of each would see, in a bath too, in
// whatever lanes. That they go on where they were saved is a law of invariance/runs_test.cpp. The pairs that
// are learned from: made as told, in a bath with the noise that leads from one to the other, and refused when
// they are not whole.
#include <atomic>
#include <set>

#include "../../src/nysalt/learning/data_of_problem.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/ensembles/distributions.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/integrate_ensemble.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::int64_t trajectories = 37;  // fill no number of lanes
constexpr std::int64_t steps = 300;

/// Some of these leave the well, at times of their own.
const henon_heiles galaxy;
const normal_around<2> law_of_type({vector<double, 2>::Zero(), vector<double, 2>::Zero()}, 0.45, 0.45);
const initial_states star_law = law_of_type;

/// Samples of each trajectory, taken every k-th step by several threads.
struct seen {
  std::int64_t every = 7;
  std::vector<std::vector<double>> values{static_cast<std::size_t>(trajectories)};
  std::vector<std::optional<std::int64_t>> diverged_at{};
  friend bool operator==(const seen&, const seen&) = default;

  auto take() {
    return [this](std::int64_t m, std::int64_t n, std::span<const double> numbers) {
      auto& samples = values[static_cast<std::size_t>(m)];
      if (2 * n != every * std::ssize(samples)) throw std::logic_error("out of the order of time");
      samples.insert(samples.end(), numbers.begin(), numbers.end());
    };
  }
};

template <class T>
const auto read_two = [](const auto& x, std::span<T> numbers) {
  numbers[0] = x.q[0];
  numbers[1] = x.p[1];
};

/// By integrate, one after the other, with the noise of trajectory m + shift.
seen alone(const auto& stepper, std::int64_t every = 7, std::uint64_t shift = 0) {
  seen all{every};
  for (std::uint64_t m = 0; m < trajectories; ++m) {
    const auto observe = [&](std::int64_t, double, const auto& x) {
      all.values[m].insert(all.values[m].end(), {x.q[0], x.p[1]});
    };
    all.diverged_at.push_back(
        integrate(stepper, star_law(1, m), steps, observe, every, m + shift).diverged_at);
  }
  return all;
}

template <class T>
seen together(const auto& stepper, std::int64_t every = 7) {
  seen all{every};
  const ensemble_options options{
      .trajectories = trajectories, .steps = steps, .every = every, .execution = {.threads = 2}};
  all.diverged_at = integrate_ensemble<T>(stepper, star_law, options, 2, read_two<T>, all.take());
  return all;
}

using state = phase_point<double, Eigen::Dynamic>;

constexpr double fine = 1e-3;
const model quiet = fpu_chain<3>(50.0);
const bath heat_bath = bath::of_sigma(2.0, 0.3);
const model warm = in_bath(fpu_chain<3>(50.0), heat_bath);
const initial_states law = fpu_law<3>(fpu_chain<3>(50.0));

flow_map_data made(const data_options& options) {
  return make_flow_map_data(quiet, law, fine_steps(fine), options);
}
flow_map_data made_in_bath(const data_options& options) {
  return make_flow_map_data(warm, law, fine_paths(fine), options);
}

bool same_pairs(const flow_map_data& a, const flow_map_data& b) {
  return a.start == b.start && a.finish == b.finish && a.first_of == b.first_of && a.noise == b.noise &&
         a.energies->low == b.energies->low && a.energies->high == b.energies->high;
}
/// No force, and then one without bounds.
struct cliff {
  static constexpr int dimension = 1;
  static void force(const vector<double, 1>& q, vector<double, 1>& f) { f[0] = q[0] > 1.1 ? infinite : 0.0; }
};

/// The noise of a path from one fine step to another, drawn again.
Eigen::VectorXd noise_between(std::uint64_t seed, std::uint64_t trajectory, std::int64_t from,
                              std::int64_t to) {
  std::vector<vector<double, 6>> each(static_cast<std::size_t>(to - from));
  for (auto& xi : each) counter_noise(seed).normals(noise_place{trajectory, from++, 0}, xi);
  vector<double, 6> whole;
  detail::coarse_graining(heat_bath.friction() * fine).over(std::span<const vector<double, 6>>(each), whole);
  return whole;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_trajectory_is_as_if_alone) {
  const model quiet = galaxy;
  const model warm = in_bath(galaxy, bath::of_sigma(0.05, 0.05));
  for (const auto& [system, method] : {std::pair(&quiet, nysalt::method(verlet())),
                                       {&warm, nysalt::method(baoab())},
                                       {&warm, nysalt::method(obabo())}}) {
    BOOST_TEST_CONTEXT(describe(*system) << ", " << method.name()) {
      const auto stepper = make_stepper(*system, method, 0.1, counter_noise(5));
      const auto expected = alone(stepper);
      std::int64_t diverged = 0;
      for (const auto& at : expected.diverged_at) diverged += at ? 1 : 0;
      BOOST_TEST(diverged > 2);
      BOOST_TEST(diverged < trajectories - 2);
      BOOST_TEST((together<double>(stepper) == expected));
      BOOST_TEST((together<detail::lanes>(stepper) == expected));
      BOOST_TEST((alone(stepper, 7, 1) == expected) == (system == &quiet));  // each has its own noise
    }
  }
  for (const std::int64_t every : {1, 64, 1000}) {
    const auto stepper = make_stepper(quiet, nysalt::method(verlet()), 0.1);
    BOOST_TEST((together<detail::lanes>(stepper, every) == alone(stepper, every)));
  }
}

// Lanes of any number, by the types of system and method.
BOOST_AUTO_TEST_CASE(an_observable_is_read_in_any_number_of_lanes) {
  const auto by = [](const auto& system) {
    std::vector<std::vector<double>> values(static_cast<std::size_t>(trajectories));
    const auto diverged_at = integrate_ensemble(
        system, verlet(), 0.1, law_of_type, {.trajectories = trajectories, .steps = steps, .every = 7},
        [](const auto& x) { return x.q[0]; },
        [&](std::int64_t m, std::int64_t, double value) {
          values[static_cast<std::size_t>(m)].push_back(value);
        });
    return std::pair(values, diverged_at);
  };
  const model system = galaxy;
  const auto expected = alone(make_stepper(system, method(verlet()), 0.1));
  const auto found = by(in_lanes<henon_heiles, 3>(galaxy));
  BOOST_TEST((by(galaxy) == found));
  BOOST_TEST((found.second == expected.diverged_at));
  BOOST_TEST(found.first[0][1] == expected.values[0][2]);  // of which two are kept
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const model& system, const method& method, const initial_states& starts,
                          const ensemble_options& options, auto... said) {
    const auto follow = [&] {
      integrate_ensemble(
          system, method, 0.1, starts, options, [](const auto& x) { return x.q[0]; },
          [](std::int64_t, std::int64_t, double) {});
    };
    BOOST_TEST(refuses(follow, {said...}));
  };
  const nysalt::method by_verlet{verlet()};
  ensemble_options before_the_first;
  before_the_first.first = -3;
  refused(galaxy, by_verlet, star_law, {.trajectories = 0}, "trajectories 0");
  refused(galaxy, by_verlet, star_law, {.trajectories = std::int64_t{1} << 60}, "trajectories");
  refused(galaxy, by_verlet, star_law, before_the_first, "first -3");
  refused(galaxy, by_verlet, star_law, {.steps = -1}, "steps -1");
  refused(galaxy, by_verlet, star_law, {.every = 0}, "every 0");
  refused(galaxy, by_verlet, star_law, {.execution = {.threads = 0}}, "thread");
  const listed<2> states({{{0.0, 0.0}, {0.0, 0.0}}, {{NAN, 0.0}, {0.0, 0.0}}});
  refused(galaxy, by_verlet, states, {.trajectories = 2}, "start 1 ", "must be finite");
  // By its method an ensemble has no source of noise.
  const in_bath warm(galaxy, bath::of_sigma(0.05, 0.05));
  refused(warm, nysalt::method(baoab()), star_law, {.trajectories = 2}, "source of noise", "counter_noise");
  const model system = galaxy;
  const auto stepper = make_stepper(system, by_verlet, 0.1);
  using run = ensemble_run<double, std::remove_const_t<decltype(stepper)>>;
  const saved_runs saved = run(stepper, star_law, 1, 0, 5).save();
  BOOST_TEST(saved.numbers.size() == 5U * 3U * 2U);
  BOOST_TEST(refuses([&] { run(stepper, star_law, 1, 0, 6, saved); },
                     {"must hold 36 numbers of 6 trajectories", "got 30 numbers of 5"}));
  BOOST_TEST(
      refuses([&] { run(stepper, star_law, 1, 0, 0); }, {"trajectories must be >= 1", "trajectories 0"}));
}

BOOST_AUTO_TEST_CASE(pairs_follow_the_reference_trajectory_by_trajectory) {
  const auto data = made({.step = 0.02, .horizon = 0.1, .trajectories = 3, .seed = 7});
  BOOST_TEST(data.pairs() == 15U);
  BOOST_TEST(data.trajectories() == 3U);
  for (std::size_t m = 0; m < 3; ++m) {
    BOOST_TEST((data.start[data.first_of[m]].q == law(7, m).q));
    for (std::size_t n = data.first_of[m]; n + 1 < data.first_of[m + 1]; ++n) {
      BOOST_TEST((data.finish[n].q == data.start[n + 1].q));
    }
  }
  state x = data.start[4];
  fine_steps(fine).advance(quiet, x, 0.02);
  BOOST_TEST((x.p == data.finish[4].p));
  BOOST_TEST((data.start[5].q != data.finish[4].q));  // a new trajectory begins there
  BOOST_TEST(data.finer.size() <= 16U);
  // 15 pairs of 20 steps of 11 and one more to open; the checks take twice the steps.
  BOOST_TEST(data.evaluations == 15 * 221 + static_cast<std::int64_t>(data.finer.size()) * 441);
  require_valid(data, quiet);
}

BOOST_AUTO_TEST_CASE(a_pair_knows_its_trajectory) {
  flow_map_data data;
  data.first_of = {0, 2, 2, 5};  // the second holds no pair
  const std::vector<std::size_t> expected{0, 0, 2, 2, 2};
  for (std::size_t n = 0; n < 5; ++n) BOOST_TEST(data.trajectory_of(n) == expected[n]);
}

BOOST_AUTO_TEST_CASE(more_trajectories_of_the_same_are_those_made_at_once) {
  data_options options{.step = 0.012, .horizon = 0.06, .trajectories = 21, .seed = 7, .noise_parts = 3};
  const auto at_once = made_in_bath(options);
  flow_map_data grown;
  for (const std::int64_t trajectories : {5, 13, 21}) {
    options.trajectories = trajectories;
    detail::extend_data(warm, law, fine_paths(fine), options, grown);
    BOOST_TEST(grown.trajectories() == static_cast<std::size_t>(trajectories));
    require_valid(grown, warm);
  }
  BOOST_TEST(same_pairs(grown, at_once));
  BOOST_TEST(grown.finer.size() > at_once.finer.size());  // some of each part
  // Each is of its own path: that of another would be farther off than the reference errs.
  for (const auto& [pair, finish] : grown.finer) {
    BOOST_TEST((finish.p - grown.finish[pair].p).norm() < 0.01 * (finish.p - grown.start[pair].p).norm());
  }
  options.trajectories = 4;
  detail::extend_data(warm, law, fine_paths(fine), options, grown);
  BOOST_TEST(grown.trajectories() == 21U);  // there are enough
}

BOOST_AUTO_TEST_CASE(checks_see_the_same_path_at_half_the_step) {
  const auto data =
      made_in_bath({.step = 0.012, .horizon = 0.06, .trajectories = 21, .seed = 7, .noise_parts = 1});
  BOOST_TEST(data.finer.size() == 16U);
  std::set<std::size_t> sixteenths;  // of 105 pairs
  for (const auto& [pair, finish] : data.finer) {
    BOOST_TEST(sixteenths.insert((16 * pair + 15) / 105).second);
    const auto finer = [&, first = pair](const path_place& at) {
      state x = data.start[first];
      fine_paths(fine).finer().advance(warm, x, 0.012, at);
      return x;
    };
    const std::uint64_t m = pair / 5;
    const auto n = static_cast<std::int64_t>(pair % 5);
    BOOST_TEST(same_bits(finish, finer({7, m, n})));
    BOOST_TEST(!same_bits(finish, finer({7, m, n + 1})));
    // The same noise: sigma h in momenta as kicks feel it, not sigma sqrt(step).
    BOOST_TEST(distance(finish, state(data.finish[pair])) < 0.3 * 0.1 * std::sqrt(0.012));
  }
  // Twelve evaluations a step and one to open, for 105 pairs; twice the steps for the checks.
  BOOST_TEST(data.evaluations == 105 * 13 + 16 * 25);
}

// Of M trajectories of S steps: a stride of M S/16 would see starts alone where M = 16 k - 1 and S = 16.
BOOST_AUTO_TEST_CASE(checks_are_spread_over_trajectories_and_along_them) {
  for (std::size_t trajectories = 1; trajectories <= 400; trajectories += trajectories < 70 ? 1 : 11) {
    for (const std::size_t steps : {1U, 2U, 3U, 5U, 8U, 16U, 17U, 32U, 50U, 1000U}) {
      const std::size_t all = trajectories * steps;
      const auto pairs = detail::spread_pairs(all, 16);
      std::set<std::size_t> whose;
      std::set<std::size_t> when;  // in eighths of a trajectory
      std::size_t starts = 0;
      for (std::size_t k = 0; k < pairs.size(); ++k) {
        if (pairs[k] >= all || (k > 0 && pairs[k - 1] >= pairs[k])) BOOST_ERROR("pairs do not rise");
        whose.insert(pairs[k] / steps);
        when.insert(pairs[k] % steps * 8 / steps);
        starts += pairs[k] % steps == 0 ? 1U : 0U;
      }
      BOOST_TEST_CONTEXT(trajectories << " trajectories of " << steps << " steps") {
        BOOST_TEST(pairs.size() == std::min<std::size_t>(16, all));
        BOOST_TEST(whose.size() + 1 >= std::min<std::size_t>(8, trajectories));
        if (steps < 8 || all < 128) continue;
        // Sixteen places at random miss more than half of eight eighths once in 10^6; starts are at most
        // half.
        BOOST_TEST(when.size() >= 4U);
        BOOST_TEST(starts <= 8U);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_reference_that_diverges_is_told_with_the_lowest_trajectory_and_the_step) {
  // Trajectory n starts at n/4 - 10 with velocity 1: in ten steps of 1/2 it passes the cliff if n >= 25.
  std::vector<phase_point<double, 1>> starts;
  for (int n = 0; n < 40; ++n) starts.push_back({vector<double, 1>(0.25 * n - 10.0), vector<double, 1>(1.0)});
  const auto make = [&](std::size_t known, std::int64_t trajectories, int threads) {
    starts.resize(known);
    return make_flow_map_data(
        cliff(), listed<1>(starts), fine_steps(0.05),
        {.step = 0.5, .horizon = 5.0, .trajectories = trajectories, .execution = {.threads = threads}});
  };
  for (const int threads : {1, 5}) {
    BOOST_TEST(refuses<std::runtime_error>([&] { make(40, 40, threads); },
                                           {"trajectory 25 ", "srkn11b", "diverged at step 10: q1 is "}));
    const auto sound = make(40, 25, threads);
    BOOST_TEST(sound.pairs() == 250U);
    BOOST_TEST(!sound.energies.has_value());  // a force alone has no energy
  }
  // Whatever is thrown: of the starts that the list does not hold, the first.
  BOOST_TEST(refuses<std::out_of_range>([&] { make(2, 40, 5); }, {"number 3 of"}));
}

// Monotone progress reports from several threads: analysis/trajectory_errors_test.cpp.
BOOST_AUTO_TEST_CASE(the_range_of_energies_is_that_of_all_starts_and_finishes) {
  std::atomic<std::int64_t> most = 0;
  const auto tell = [&](std::int64_t done) {
    if (done > most) most = done;
  };
  const auto data =
      made({.step = 0.02, .horizon = 0.1, .trajectories = 20, .execution = {.threads = 2, .progress = tell}});
  BOOST_TEST(most == 20);
  energy_range all;
  for (const auto* states : {&data.start, &data.finish}) {
    for (const auto& x : *states) all.include(energy<double>(quiet, state(x)));
  }
  BOOST_REQUIRE(data.energies.has_value());
  BOOST_TEST((data.energies->low == all.low && data.energies->high == all.high));
  BOOST_TEST(all.low < all.high);
}

BOOST_AUTO_TEST_CASE(the_noise_is_that_of_the_path_in_parts_which_change_no_state) {
  const auto with = [](int parts) {
    return made_in_bath(
        {.step = 0.012, .horizon = 0.06, .trajectories = 21, .seed = 7, .noise_parts = parts});
  };
  const auto none = with(0);
  BOOST_TEST(none.noise.size() == 0U);
  for (const std::int64_t parts : {1, 2, 3, 4, 6, 12}) {
    const auto data = with(static_cast<int>(parts));
    BOOST_TEST((data.finish == none.finish));
    BOOST_TEST(data.noise.size() == 105U * static_cast<std::size_t>(parts));
    require_valid(data, warm);
    const std::int64_t each = 12 / parts;  // fine steps
    for (std::size_t m = 0; m < 21; ++m) {
      for (std::int64_t part = 0; part < 5 * parts; ++part) {
        const auto off = [&](std::int64_t begin) {
          const auto at = parts * static_cast<std::int64_t>(data.first_of[m]) + part;
          const Eigen::VectorXd xi = data.noise[static_cast<std::size_t>(at)];
          return (xi - noise_between(7, m, begin, begin + each)).cwiseAbs().maxCoeff();
        };
        BOOST_TEST(off(each * part) <= static_cast<double>(each) * 4 * eps);  // additions of numbers below 4
        BOOST_TEST(off(each * part + each) > 1e-3);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_made_is_refused) {
  const auto refused = [](const data_options& options, said words) {
    BOOST_TEST(refuses([&] { made(options); }, words));
  };
  refused({.step = 0.02, .horizon = 0.01}, {"at least a step", "over 0.01 with the step 0.02"});
  refused({.step = 0.02, .trajectories = 0}, {"trajectories must be at least 1", "got 0"});
  refused({.step = -0.02}, {"positive", "-0.02"});
  refused({.step = not_a_number}, {"positive"});
  refused({.step = 0.02, .horizon = not_a_number}, {"finite"});
  refused({.step = 0.02, .horizon = 1e300}, {"memory"});
  refused({.step = 0.0205}, {"a multiple"});
  refused({.step = 0.02, .first = -1}, {"number -1"});
  refused({.step = 0.02, .execution = {.threads = 0}}, {"threads must be at least one", "0"});
  const model four = linear_chain::between_walls(4, 1.0);
  const initial_states of_two =
      normal_around<Eigen::Dynamic>({Eigen::VectorXd::Zero(2), Eigen::VectorXd::Zero(2)}, 0.1, 0.1);
  BOOST_TEST(refuses([&] { make_flow_map_data(four, of_two, fine_steps(0.1), {.step = 0.1}); },
                     {"start 0", "dimension"}));
  const auto noise_refused = [](const model& system, const auto& reference, int parts, said words) {
    const data_options options{.step = 0.012, .trajectories = 1, .noise_parts = parts};
    return refuses([&] { make_flow_map_data(system, law, reference, options); }, words);
  };
  BOOST_TEST(noise_refused(quiet, fine_steps(fine), 1, {"srkn11b", "must have noise", "take fine_paths"}));
  BOOST_TEST(!noise_refused(quiet, fine_steps(fine), 0, {}));
  BOOST_TEST(
      noise_refused(warm, fine_steps(fine), 0, {"bath(friction=2, sigma=0.3)", "must have a letter O"}));
  BOOST_TEST(noise_refused(warm, fine_steps(fine), 1, {"must have noise", "take fine_paths"}));
  BOOST_TEST(noise_refused(warm, fine_paths(fine), 5, {"0.012 in the 5 equal parts", "fine step 0.001"}));
  BOOST_TEST(noise_refused(warm, fine_paths(fine), -1, {"noise_parts must be >= 0, got -1"}));
  BOOST_TEST(noise_refused(warm, fine_paths(0.005), 1, {"0.012 in the 1 equal parts", "fine step 0.005"}));
  // An exact flow is of no bath.
  const in_bath oscillator(harmonic_oscillator(1.0), bath::of_sigma(0.1, 0.0));
  BOOST_TEST(refuses([&] { exact_linear(oscillator); }, {"exact_linear", "in no bath"}));
  const reference of_the_alone = exact_linear(oscillator.base());
  phase_point<double, 1> x{vector<double, 1>(1.0), vector<double, 1>(0.0)};
  BOOST_TEST(
      refuses([&] { of_the_alone.advance(oscillator, x, 0.1); },
              {"the one that the reference was made for, harmonic_oscillator", "in bath(friction=0.1"}));
}

BOOST_AUTO_TEST_CASE(data_that_are_not_whole_are_refused_with_the_pair) {
  const auto whole = made({.step = 0.02, .horizon = 0.1, .trajectories = 2});
  const auto noisy = made_in_bath({.step = 0.012, .horizon = 0.06, .trajectories = 2, .noise_parts = 2});
  const auto refused = [](flow_map_data data, const model& system, const auto& spoil, said words) {
    spoil(data);
    return refuses([&] { require_valid(data, system); }, words);
  };
  const auto spoilt = [&](const auto& spoil, said words) { BOOST_TEST(refused(whole, quiet, spoil, words)); };
  spoilt([](auto& d) { d.finish[3].q[1] = not_a_number; },
         {"must be finite: q2 is nan", "finish of pair 3", "trajectory 0"});
  spoilt([](auto& d) { d.start[7].p[0] = -infinite; },
         {"must be finite: p1 is -inf", "start of pair 7", "trajectory 1"});
  spoilt([](auto& d) { d.finer[1].second.p[5] = not_a_number; },
         {"p6 is nan", fmt::format("finer finish of pair {}", whole.finer[1].first)});
  spoilt([](auto& d) { d.finer[0].first = 10; }, {"must be whole", "pair 10 of 10"});
  spoilt([](auto& d) { d.step = not_a_number; }, {"step of the data", "nan"});
  spoilt([](auto& d) { d.step = 0.0; }, {"step of the data", "got 0"});
  spoilt([](auto& d) { d.finish.resize(9); }, {"must be whole", "9 finishes"});
  spoilt([](auto& d) { d.first_of.clear(); }, {"must be whole", "0 trajectories"});
  spoilt([](auto& d) { d = {}; }, {"the data must be of"});
  spoilt([](auto& d) { d.first_of.back() = 3; }, {"must be whole"});
  BOOST_TEST(refused(whole, fpu_chain<3>(49.0), [](auto&) {}, {"omega=50", "omega=49"}));
  const auto spoilt_noise = [&](const auto& spoil, said words) {
    BOOST_TEST(refused(noisy, warm, spoil, words));
  };
  spoilt_noise([](auto& d) { d.noise.resize(19, 6); }, {"10 pairs with noise in 2 parts that hold 19"});
  spoilt_noise([](auto& d) { d.noise_parts = 1; }, {"in 1 parts that hold 20"});
  spoilt_noise([](auto& d) { d.noise_parts = -2; }, {"in -2 parts"});
  spoilt_noise([](auto& d) { d.noise[13][2] = not_a_number; },
               {"must be finite", "coordinate 3 of noise 13 = nan", "in pair 6 of trajectory 1"});
  BOOST_TEST(!refused(noisy, warm, [](auto&) {}, {}));
  BOOST_TEST(refused(noisy, quiet, [](auto&) {}, {"in bath(friction=2"}));
}
