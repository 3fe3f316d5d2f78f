// SPDX-License-Identifier: BSL-1.0
// Trajectories side by side go as each would alone: to the bit, to the step at which it diverges, and in what
// an observer is shown.
#include "nysalt/detail/lockstep.hpp"

#include <boost/test/unit_test.hpp>

#include <bit>
#include <cstdint>
#include <tuple>
#include <vector>

#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "support/allocations.hpp"
#include "support/draws.hpp"
#include "support/refusal.hpp"
#include "support/systems.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using scalars = std::tuple<double, pack<double, 1>, pack<double, 3>, pack<double, 8>, pack<double, 16>>;

struct at_most_four : henon_heiles {
  static constexpr int lanes = 4;
};
template <int N>
struct watched {
  std::vector<std::int64_t> steps;
  std::vector<phase_point<double, N>> states;
  std::optional<std::int64_t> diverged_at;
};

/// What an observer of one trajectory sees from its first step on.
template <class Stepper, int N>
watched<N> alone(const Stepper& stepper, const phase_point<double, N>& start, std::int64_t steps,
                 std::int64_t every) {
  watched<N> result;
  const auto observe = [&](std::int64_t n, double, const auto& x) {
    if (n == 0) return;
    result.steps.push_back(n);
    result.states.push_back(x);
  };
  result.diverged_at = integrate(stepper, start, steps, observe, every).diverged_at;
  return result;
}

/// The same of each lane, `until` by `until`.
template <class T, class Stepper, int N>
std::vector<watched<N>> together(const Stepper& stepper, const std::vector<phase_point<double, N>>& starts,
                                 std::int64_t steps, std::int64_t every) {
  const auto n = static_cast<std::size_t>(starts.front().size());
  std::vector<watched<N>> result(starts.size());
  const auto count = static_cast<int>(starts.size());
  const auto start = gather<T, N>(count, [&](int k) { return starts[static_cast<std::size_t>(k)]; });
  lockstep<Stepper, T> all(stepper, start, count);
  const auto read = [&](const auto& x, std::span<T> numbers) {
    for (std::size_t i = 0; i < n; ++i) {
      numbers[i] = x.q[static_cast<Eigen::Index>(i)];
      numbers[n + i] = x.p[static_cast<Eigen::Index>(i)];
    }
  };
  const auto take = [&](std::int64_t step, std::span<const T> numbers, const auto& live) {
    for (int k = 0; k < count; ++k) {
      if (!lane(live, k)) continue;
      auto& trajectory = result[static_cast<std::size_t>(k)];
      phase_point<double, N> x = starts.front();
      for (std::size_t i = 0; i < n; ++i) {
        x.q[static_cast<Eigen::Index>(i)] = lane(numbers[i], k);
        x.p[static_cast<Eigen::Index>(i)] = lane(numbers[n + i], k);
      }
      trajectory.steps.push_back(step);
      trajectory.states.push_back(x);
    }
  };
  all.go_on(steps, every, 2 * n, read, take);
  for (int k = 0; k < count; ++k) result[static_cast<std::size_t>(k)].diverged_at = all.diverged_at(k);
  return result;
}

template <int N>
bool agree(const watched<N>& a, const watched<N>& b) {
  const auto same = [](const auto& x, const auto& y) { return x.q == y.q && x.p == y.p; };
  return a.steps == b.steps && a.diverged_at == b.diverged_at &&
         std::equal(a.states.begin(), a.states.end(), b.states.begin(), b.states.end(), same);
}

/// How many of several starts diverge; each must go as it would alone.
template <class T, System S, Method M, int N>
int diverged_of(const S& system, const M& method, double step, std::vector<phase_point<double, N>> starts,
                std::int64_t steps, std::int64_t every) {
  starts.resize(std::min<std::size_t>(starts.size(), lanes_in<T>));
  const auto stepper = make_stepper(system, method, step);
  const auto all = together<T>(stepper, starts, steps, every);
  int diverged = 0;
  for (std::size_t k = 0; k < starts.size(); ++k) {
    const auto expected = alone(stepper, starts[k], steps, every);
    BOOST_TEST(agree(all[k], expected), describe(system) << ", lane " << k << " of " << lanes_in<T>);
    diverged += expected.diverged_at ? 1 : 0;
  }
  return diverged;
}

std::vector<phase_point<double, 6>> chain_starts(const fpu_chain<3>& chain, std::size_t count) {
  std::vector<phase_point<double, 6>> starts;
  for (std::size_t m = 0; m < count; ++m) starts.push_back(fpu_law<3>(chain)(1, m));
  return starts;
}

/// Half of them stay in the well, below its saddle at energy 1/6; others leave it.
std::vector<phase_point<double, 2>> near_the_saddle() {
  draws random;
  std::vector<phase_point<double, 2>> starts;
  for (int m = 0; m < 11; ++m) starts.push_back(random.state(henon_heiles(), m % 2 == 0 ? 0.2 : 1.5));
  return starts;
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(lanes_go_as_each_would_alone, T, scalars) {
  const fpu_chain<3> chain(50.0);
  const fpu_chain<> of_any_size(3, 50.0);
  const auto starts = chain_starts(chain, 13);
  std::vector<phase_point<double, Eigen::Dynamic>> dynamic;
  for (const auto& x : starts) dynamic.push_back({x.q, x.p});
  for (const std::int64_t every : {1, 7, 64, 100, 1000}) {
    BOOST_TEST(diverged_of<T>(chain, verlet(), .02, starts, 200, every) == 0);
    BOOST_TEST(diverged_of<T>(chain, srkn6b(), .03, starts, 130, every) == 0);
    BOOST_TEST(diverged_of<T>(chain, tabulated(member<nystrom>({.5, .4})), .03, starts, 130, every) == 0);
    BOOST_TEST(diverged_of<T>(of_any_size, verlet(), .02, dynamic, 130, every) == 0);
  }
  BOOST_TEST(diverged_of<T>(chain, verlet(), .05, starts, 200, 1) > 0);
}

// Else the test above could not tell.
BOOST_AUTO_TEST_CASE(another_trajectory_does_not_agree) {
  const fpu_chain<3> chain(50.0);
  const auto starts = chain_starts(chain, 8);
  const auto stepper = make_stepper(chain, verlet(), .02);
  const auto all = together<pack<double, 8>>(stepper, starts, 100, 7);
  BOOST_TEST(agree(all[0], alone(stepper, starts[0], 100, 7)));
  BOOST_TEST(!agree(all[0], alone(stepper, starts[1], 100, 7)));
  BOOST_TEST(!agree(all[0], alone(stepper, starts[0], 100, 8)));
}

// Here each leaves at a time of its own, and others stay.
BOOST_AUTO_TEST_CASE_TEMPLATE(a_lane_that_diverges_leaves_the_others_alone, T, scalars) {
  const auto starts = near_the_saddle();
  for (const std::int64_t every : {1, 5}) {
    const int diverged = diverged_of<T>(henon_heiles(), verlet(), .05, starts, 2000, every);
    if (lanes_in < T >> 8) {
      BOOST_TEST(diverged > 0);
      BOOST_TEST(diverged < 11);
    }
  }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(any_system_goes_in_lanes, T, scalars) {
  draws random;
  const auto some = [&](const auto& system) {
    std::vector<phase_point<double, std::remove_cvref_t<decltype(system)>::dimension>> starts;
    for (int m = 0; m < 5; ++m) starts.push_back(random.state(system, 0.5));
    return starts;
  };
  const linear_chain masses(Eigen::MatrixXd{{3.0, -1.0}, {-1.0, 2.0}}, Eigen::VectorXd{{1.0, 4.0}});
  diverged_of<T>(pendulum(), verlet(), .1, some(pendulum()), 100, 3);
  diverged_of<T>(masses, verlet(), .1, some(masses), 100, 3);
  diverged_of<T>(two_masses(), verlet(), .1, some(two_masses()), 100, 3);
  diverged_of<T>(relativistic(), verlet(), .1, some(relativistic()), 100, 3);
}

// In parts or at once: the same, as long as the parts end where divergence is looked for.
BOOST_AUTO_TEST_CASE(parts_make_a_whole) {
  using T = pack<double, 8>;
  const fpu_chain<3> chain(50.0);
  const auto stepper = make_stepper(chain, verlet(), .03);
  const auto start = sound_starts<T>(chain, fpu_law<3>(chain), 1, 0, 8);
  lockstep<decltype(stepper), T> whole(stepper, start, 8);
  lockstep<decltype(stepper), T> parts(stepper, start, 8);
  whole.go_on(256);
  for (int end = 64; end <= 256; end += 64) parts.go_on(end);
  BOOST_TEST(parts.step() == 256);
  for (int k = 0; k < 8; ++k) BOOST_TEST((lane(whole.synchronous(), k).q == lane(parts.synchronous(), k).q));
}

BOOST_AUTO_TEST_CASE(the_number_of_lanes_follows_from_the_system) {
  static_assert(lanes_of<henon_heiles> == default_lanes);
  static_assert(lanes_of<at_most_four> == 4);
  static_assert(lanes_of<black_box> == 1);
  static_assert(std::is_same_v<scalar_of_lanes<1>, double>);
  static_assert(std::is_same_v<scalar_of_lanes<4>, pack<double, 4>>);
}

// A thousand steps, watched at each: what is allocated is allocated before.
BOOST_AUTO_TEST_CASE(the_loop_allocates_nothing) {
  using T = pack<double, 8>;
  const fpu_chain<3> chain(50.0);
  const auto stepper = make_stepper(chain, verlet(), .01);
  const auto start = sound_starts<T>(chain, fpu_law<3>(chain), 1, 0, 8);
  lockstep<decltype(stepper), T> all(stepper, start, 8);
  T sum(0.0);
  const auto read = [&](const auto& x, std::span<T> numbers) { numbers[0] = chain.stiff_energy(x); };
  const auto add = [&](std::int64_t, std::span<const T> numbers, const auto&) { sum += numbers[0]; };
  all.go_on(64, 1, 1, read, add);  // finds its room
  const auto before = allocations;
  all.go_on(1064, 1, 1, read, add);
  BOOST_TEST(allocations == before);
  BOOST_TEST(sum[7] > 0.0);
}
