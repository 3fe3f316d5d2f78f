// SPDX-License-Identifier: BSL-1.0
// A run along a recorded path sees that path's noise, each letter O that of its own part of the step.
#include "nysalt/noises/along_path.hpp"
#include "nysalt/langevin.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/detail/lockstep.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using state = phase_point<double, 2>;
constexpr double tau = 0.02;   // an interval of the path
constexpr double step = 0.12;  // six of them
const bath warm = bath::of_sigma(2.0, 0.1);
const in_bath galaxy(henon_heiles(), warm);
const state start{{0.1, 0.05}, {-0.05, 0.1}};

const auto symmetric = thermostat<placement::symmetric>(mclachlan2());
const auto end = thermostat<placement::end>(mclachlan2());
const auto middle = thermostat<placement::middle>(mclachlan2());
const tabulated thirds("thirds", run_time_word("OABOBAO"),
                       std::vector<double>{1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0, 0.5, 0.5, 1.0 / 3.0}, {});

template <class T = double>
recorded_path<T, 2> path_of(std::uint64_t trajectory, std::int64_t intervals) {
  recorded_path<T, 2> path(tau, warm.friction(), trajectory);
  for (std::int64_t n = 0; n < intervals; ++n) {
    vector<T, 2> xi;
    counter_noise(7).normals(noise_place{trajectory, n, 0}, xi);
    path.add(xi);
  }
  return path;
}
template <class T, Method M>
along_path<T, 2> noise_of(const recorded_path<T, 2>& path, const M& method, double h = step) {
  return {path, intervals_of_noise(word_of(method), method.coefficients()), h};
}
template <class T, Method M>
auto stepper_of(const recorded_path<T, 2>& path, const M& method, double h = step) {
  return make_stepper(galaxy, method, h, noise_of(path, method, h));
}

/// Some steps letter by letter, whose letters O are told by hand: the momentum goes through one interval of
/// the path after the other.
template <Method M>
state by_hand(const recorded_path<double, 2>& path, const M& method, int steps, state x) {
  const auto c = method.coefficients();
  const std::string letters = word_of(method).letters();
  std::int64_t interval = 0;
  for (int n = 0; n < steps; ++n) {
    for (std::size_t i = 0; i < letters.size(); ++i) {
      vector<double, 2> f;
      force<double>(galaxy, x.q, f);
      if (letters[i] == 'A') x.q += x.p * (c[i] * step);
      if (letters[i] == 'B') x.p += f * (c[i] * step);
      if (letters[i] != 'O') continue;
      for (std::int64_t left = std::llround(c[i] * step / tau); left > 0; --left, ++interval) {
        vector<double, 2> xi;
        path.over(interval, interval + 1, xi);
        x.p = x.p * warm.decay(tau) + xi * warm.deviation(tau);
      }
    }
  }
  return x;
}

template <Method M>
void check_by_hand(const M& method) {
  const auto path = path_of(3, 60);
  const auto along = stepper_of(path, method);
  auto run = along.open(start, 3);
  along.advance(run, 10);
  const state found = along.synchronous(run);
  // Some thirty operations a step of numbers below 1, which grow little in a time of 1.2.
  BOOST_TEST(distance(found, by_hand(path, method, 10, start)) <= 10 * 30 * eps);
  BOOST_TEST(distance(found, by_hand(path_of(4, 60), method, 10, start)) > 1e-3);
  state plain = start;
  for (int n = 0; n < 10; ++n) along.step(plain, 3, n);
  BOOST_TEST(distance(found, plain) <= 10 * 30 * eps);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_sees_the_noise_of_its_path) {
  check_by_hand(baoab());
  check_by_hand(obabo());
  check_by_hand(aboba());
  check_by_hand(baoab_2x());
  check_by_hand(end);
  check_by_hand(symmetric);
  check_by_hand(middle);
  check_by_hand(thirds);
}

BOOST_AUTO_TEST_CASE(halves_come_from_the_path) {
  // A word that does nothing but O: after n steps the momentum is that of the path itself, not a bridge's.
  const tabulated halves("halves", run_time_word("OABAO"), std::vector<double>{.5, 0.0, 0.0, 0.0, .5}, {});
  const auto path = path_of(0, 30);
  const auto along = stepper_of(path, halves);
  auto run = along.open(start);
  for (int n = 1; n <= 5; ++n) {
    along.advance(run, 1);
    vector<double, 2> xi;
    path.over(0, 6 * n, xi);
    const vector<double, 2> expected = start.p * warm.decay(n * step) + xi * warm.deviation(n * step);
    BOOST_TEST((along.synchronous(run).p - expected).cwiseAbs().maxCoeff() <= 6 * n * 4 * eps);
  }
}

BOOST_AUTO_TEST_CASE(looking_and_cutting_change_no_bit) {
  const auto path = path_of(0, 60);
  const auto along = stepper_of(path, symmetric);
  auto whole = along.open(start);
  along.advance(whole, 10);
  auto watched = along.open(start);
  along.advance(watched, 4, 1, [](auto&&...) {});
  along.advance(watched, 6);
  BOOST_TEST(same_bits(along.synchronous(watched), along.synchronous(whole)));
}

BOOST_AUTO_TEST_CASE(lanes_are_singles_to_the_bit) {
  using T = pack<double, 8>;
  const auto path = path_of<T>(40, 60);
  const auto check = [&](const auto& method) {
    const auto along = stepper_of(path, method);
    const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.1);
    const auto all = gather<T, 2>(8, [&](int k) { return starts(1, static_cast<std::uint64_t>(k)); });
    lockstep<std::remove_cvref_t<decltype(along)>, T> together(along, all, 8, 40);
    together.go_on(10);
    for (int k = 0; k < 8; ++k) {
      const auto trajectory_of_lane = 40 + static_cast<std::uint64_t>(k);
      const auto alone = [&](std::uint64_t trajectory) {
        const auto own = path_of(trajectory, 60);
        const auto single = stepper_of(own, method);
        auto run = single.open(lane(all, k), trajectory);
        single.advance(run, 10);
        return single.synchronous(run);
      };
      BOOST_TEST(same_bits(lane(together.synchronous(), k), alone(trajectory_of_lane)));
      BOOST_TEST(!same_bits(lane(together.synchronous(), k), alone(trajectory_of_lane + 1)));
      auto one_of_several = along.open(lane(all, k), trajectory_of_lane);  // each lane is stepped by itself
      along.advance(one_of_several, 10);
      BOOST_TEST(same_bits(along.synchronous(one_of_several), alone(trajectory_of_lane)));
    }
  };
  check(baoab());
  check(symmetric);
}

BOOST_AUTO_TEST_CASE(a_path_that_is_too_short_is_refused) {
  const auto path = path_of(0, 59);  // ten steps need sixty
  const auto along = stepper_of(path, baoab());
  auto run = along.open(start);
  along.advance(run, 9);
  BOOST_TEST(refuses<wrong>([&] { along.advance(run, 1); }, {"0 to 59", "for 54 to 60", "longer"}));
  const auto by_halves = stepper_of(path, symmetric);
  auto other = by_halves.open(start);
  by_halves.advance(other, 10);  // the last half is still to come
  BOOST_TEST(refuses<wrong>([&] { by_halves.synchronous(other); }, {"for 57 to 60"}));
}

BOOST_AUTO_TEST_CASE(the_path_of_another_trajectory_is_refused) {
  const auto path = path_of(3, 60);
  const auto along = stepper_of(path, baoab());
  for (const std::uint64_t other : {0U, 2U, 4U}) {
    auto run = along.open(start, other);
    BOOST_TEST(
        refuses<wrong>([&] { along.advance(run, 1); }, {"trajectory 3", "not of " + std::to_string(other)}));
  }
  using T = pack<double, 4>;
  const auto four = path_of<T>(3, 60);
  const auto together = stepper_of(four, baoab());
  auto shifted = together.open(start.cast<T>(), 4);  // would see its neighbours' noise
  BOOST_TEST(refuses<wrong>([&] { together.advance(shifted, 1); }, {"trajectory 3", "not of 4"}));
  auto beyond = together.open(start, 7);
  BOOST_TEST(refuses<wrong>([&] { together.advance(beyond, 1); }, {"trajectory 3", "not of 7"}));
  auto last = together.open(start, 6);
  together.advance(last, 1);
}

BOOST_AUTO_TEST_CASE(steps_are_whole_intervals_in_the_parts_that_are_needed) {
  const auto path = path_of(0, 6);
  const auto refused = [&](const auto& method, double h, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { noise_of(path, method, h); }, words);
  };
  BOOST_TEST(!refused(baoab(), 0.06, {}));
  BOOST_TEST(refused(symmetric, 0.06, {"the step 0.06 in the 2 parts", "whole intervals 0.02"}));
  BOOST_TEST(refused(baoab(), 0.05, {"the step 0.05 in the 1 parts"}));
  BOOST_TEST(refused(baoab(), 0.01, {"the step 0.01"}));
  BOOST_TEST(refused(baoab(), -0.02, {"the step -0.02"}));
  BOOST_TEST(!refused(thirds, 0.06, {}));
  BOOST_TEST(refused(thirds, 0.04, {"in the 3 parts"}));
}
