// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 1.1 s at -O0, 0.1 s at -O1.
// What an observer of many trajectories is given is what an observer of each would see, in a bath too, in
// whatever lanes. That they go on where they were saved is a law of invariance/runs_test.cpp.
#include "../support/refusal.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensemble_run.hpp"
#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/initial_states.hpp"
#include "nysalt/integrate_ensemble.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
constexpr std::int64_t trajectories = 37;  // fill no number of lanes
constexpr std::int64_t steps = 300;

/// Some of these leave the well, at times of their own.
const henon_heiles galaxy;
const normal_around<2> law_of_type({vector<double, 2>::Zero(), vector<double, 2>::Zero()}, 0.45, 0.45);
const initial_states law = law_of_type;

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
    all.diverged_at.push_back(integrate(stepper, law(1, m), steps, observe, every, m + shift).diverged_at);
  }
  return all;
}

template <class T>
seen together(const auto& stepper, std::int64_t every = 7) {
  seen all{every};
  const ensemble_options options{.trajectories = trajectories, .steps = steps, .every = every, .threads = 2};
  all.diverged_at = integrate_ensemble<T>(stepper, law, options, 2, read_two<T>, all.take());
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_trajectory_is_as_if_alone) {
  const model quiet = galaxy;
  const model warm = in_bath(galaxy, bath::of_sigma(0.05, 0.05));
  for (const auto& [system, method] :
       {std::pair(&quiet, tabulated(verlet())), {&warm, tabulated(baoab())}, {&warm, tabulated(obabo())}}) {
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
    const auto stepper = make_stepper(quiet, tabulated(verlet()), 0.1);
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
  const auto expected = alone(make_stepper(system, tabulated(verlet()), 0.1));
  const auto found = by(in_lanes<henon_heiles, 3>(galaxy));
  BOOST_TEST((by(galaxy) == found));
  BOOST_TEST((found.second == expected.diverged_at));
  BOOST_TEST(found.first[0][1] == expected.values[0][2]);  // of which two are kept
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto refused = [](const model& system, const tabulated& method, const initial_states& starts,
                          const ensemble_options& options, auto... said) {
    const auto follow = [&] {
      integrate_ensemble(
          system, method, 0.1, starts, options, [](const auto& x) { return x.q[0]; },
          [](std::int64_t, std::int64_t, double) {});
    };
    BOOST_TEST(refuses<wrong>(follow, {said...}));
  };
  const tabulated by_verlet{verlet()};
  ensemble_options before_the_first;
  before_the_first.first = -3;
  refused(galaxy, by_verlet, law, {.trajectories = 0}, "trajectories 0");
  refused(galaxy, by_verlet, law, {.trajectories = std::int64_t{1} << 60}, "trajectories");
  refused(galaxy, by_verlet, law, before_the_first, "first -3");
  refused(galaxy, by_verlet, law, {.steps = -1}, "steps -1");
  refused(galaxy, by_verlet, law, {.every = 0}, "every 0");
  refused(galaxy, by_verlet, law, {.threads = 0}, "thread");
  const listed<2> states({{{0.0, 0.0}, {0.0, 0.0}}, {{NAN, 0.0}, {0.0, 0.0}}});
  refused(galaxy, by_verlet, states, {.trajectories = 2}, "start 1 ", "must be finite");
  // By its method an ensemble has no source of noise.
  const in_bath warm(galaxy, bath::of_sigma(0.05, 0.05));
  refused(warm, tabulated(baoab()), law, {.trajectories = 2}, "source of noise", "counter_noise");
  const model system = galaxy;
  const auto stepper = make_stepper(system, by_verlet, 0.1);
  using run = ensemble_run<double, std::remove_const_t<decltype(stepper)>>;
  const saved_runs saved = run(stepper, law, 1, 0, 5).save();
  BOOST_TEST(saved.numbers.size() == 5U * 3U * 2U);
  BOOST_TEST(refuses<wrong>([&] { run(stepper, law, 1, 0, 6, saved); },
                            {"must hold 36 numbers of 6 trajectories", "got 30 numbers of 5"}));
  BOOST_TEST(
      refuses<wrong>([&] { run(stepper, law, 1, 0, 0); }, {"trajectories must be >= 1", "trajectories 0"}));
}
