// SPDX-License-Identifier: BSL-1.0
// What an observer of many trajectories is given is what an observer of each would see.
#include "nysalt/integrate_ensemble.hpp"

#include <boost/test/unit_test.hpp>

#include <vector>

#include "nysalt/ensembles/listed.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "support/in_lanes.hpp"
#include "support/ranks_as_threads.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr std::int64_t trajectories = 37;  // fill no number of lanes
constexpr std::int64_t steps = 300;
constexpr std::int64_t every = 7;

/// Some of these leave the well, at times of their own.
const normal_around<2> law({vector<double, 2>::Zero(), vector<double, 2>::Zero()}, 0.5, 0.5);
const auto first_coordinate = [](const auto& x) { return x.q[0]; };

struct seen {
  std::vector<std::vector<double>> values{static_cast<std::size_t>(trajectories)};
  std::vector<std::optional<std::int64_t>> diverged_at;
};

template <class S>
seen by(const S& system, int threads, const communicator& ranks = one_rank) {
  seen result;
  const ensemble_options options{
      .trajectories = trajectories, .steps = steps, .every = every, .threads = threads, .ranks = &ranks};
  const auto take = [&](std::int64_t m, std::int64_t n, double value) {
    auto& samples = result.values[static_cast<std::size_t>(m)];
    if (n != every * std::ssize(samples)) throw std::logic_error("out of the order of time");
    samples.push_back(value);
  };
  result.diverged_at = integrate_ensemble(system, verlet(), 0.1, law, options, first_coordinate, take);
  return result;
}

bool operator==(const seen& a, const seen& b) {
  return a.values == b.values && a.diverged_at == b.diverged_at;
}

const henon_heiles galaxy;

}  // namespace

BOOST_AUTO_TEST_CASE(each_trajectory_is_as_if_alone) {
  seen singly;
  const auto stepper = make_stepper(galaxy, verlet(), 0.1);
  int diverged = 0;
  for (std::int64_t m = 0; m < trajectories; ++m) {
    const auto observe = [&](std::int64_t, double, const auto& x) {
      singly.values[static_cast<std::size_t>(m)].push_back(x.q[0]);
    };
    const auto end = integrate(stepper, law(1, static_cast<std::uint64_t>(m)), steps, observe, every);
    singly.diverged_at.push_back(end.diverged_at);
    diverged += end.diverged_at ? 1 : 0;
  }
  BOOST_TEST(diverged > 0);
  BOOST_TEST(diverged < trajectories);
  for (const int threads : {1, 2, 3}) {
    BOOST_TEST((by(galaxy, threads) == singly));
    BOOST_TEST((by(in_lanes<henon_heiles, 1>(galaxy), threads) == singly));
    BOOST_TEST((by(in_lanes<henon_heiles, 3>(galaxy), threads) == singly));
    BOOST_TEST((by(in_lanes<henon_heiles, 8>(galaxy), threads) == singly));
  }
}

// There are three leaves: of five ranks two have nothing to follow.
BOOST_AUTO_TEST_CASE(each_trajectory_is_followed_by_one_rank) {
  const auto whole = by(galaxy, 1);
  for (const int size : {2, 3, 5}) {
    std::vector<seen> parts(static_cast<std::size_t>(size));
    run_ranks(size, [&](const communicator& ranks) {
      parts[static_cast<std::size_t>(ranks.rank())] = by(galaxy, 1, ranks);
    });
    seen all;
    for (const seen& part : parts) {
      BOOST_TEST((part.diverged_at == whole.diverged_at));
      for (std::size_t m = 0; m < all.values.size(); ++m) {
        if (part.values[m].empty()) continue;
        BOOST_TEST(all.values[m].empty());
        all.values[m] = part.values[m];
      }
    }
    BOOST_TEST((all.values == whole.values));
  }
}

// A part of an ensemble is that part of the whole.
BOOST_AUTO_TEST_CASE(an_ensemble_can_be_followed_in_parts) {
  const auto whole = by(galaxy, 1);
  ensemble_options options{.trajectories = 11, .steps = steps, .every = every};
  options.first = 20;
  std::vector<std::vector<double>> part(11);
  const auto take = [&](std::int64_t m, std::int64_t, double value) {
    part[static_cast<std::size_t>(m - 20)].push_back(value);
  };
  const auto diverged_at =
      integrate_ensemble(galaxy, verlet(), 0.1, law, options, over_lanes(first_coordinate), take);
  for (std::size_t i = 0; i < 11; ++i) {
    BOOST_TEST((part[i] == whole.values[20 + i]));
    BOOST_TEST((diverged_at[i] == whole.diverged_at[20 + i]));
  }
}

BOOST_AUTO_TEST_CASE(no_steps_show_the_starts) {
  int looks = 0;
  const auto take = [&](std::int64_t m, std::int64_t n, double value) {
    BOOST_TEST(n == 0);
    BOOST_TEST(value == law(1, static_cast<std::uint64_t>(m)).q[0]);
    ++looks;
  };
  integrate_ensemble(galaxy, verlet(), 0.1, law, {.trajectories = 5, .steps = 0}, first_coordinate, take);
  BOOST_TEST(looks == 5);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused) {
  const auto no_observer = [](std::int64_t, std::int64_t, double) {};
  const auto refused = [&](const ensemble_options& options, auto... words) {
    return refuses<std::invalid_argument>(
        [&] { integrate_ensemble(galaxy, verlet(), 0.1, law, options, first_coordinate, no_observer); },
        {words...});
  };
  BOOST_TEST(refused({.trajectories = 0}, "trajectories 0"));
  BOOST_TEST(refused({.trajectories = std::int64_t{1} << 60}, "trajectories"));
  ensemble_options before_the_first;
  before_the_first.first = -3;
  BOOST_TEST(refused(before_the_first, "first -3"));
  BOOST_TEST(refused({.steps = -1}, "steps -1"));
  BOOST_TEST(refused({.every = 0}, "every 0"));
  BOOST_TEST(refused({.threads = 0}, "thread"));
  const listed<2> states({{{0.0, 0.0}, {0.0, 0.0}}, {{NAN, 0.0}, {0.0, 0.0}}});
  BOOST_TEST(refuses<std::invalid_argument>(
      [&] {
        integrate_ensemble(galaxy, verlet(), 0.1, states, {.trajectories = 2}, first_coordinate, no_observer);
      },
      {"start 1 ", "must be finite"}));
}
