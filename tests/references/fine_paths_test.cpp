// SPDX-License-Identifier: BSL-1.0
// Compiled with -O1: 10 s at -O0, 0.2 s at -O1.
// Paths in a bath: the states, the noise that goes with them, and the same path seen more finely.
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/seeds.hpp"
#include "../support/statistics.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using wrong = std::invalid_argument;
using galaxy = in_bath<henon_heiles>;
using state = phase_point<double, 2>;
using numbers = vector<double, Eigen::Dynamic>;
using noise = std::vector<numbers>;

const galaxy warm(henon_heiles(), bath::of_sigma(2.0, 0.1));
const state start{{0.1, 0.05}, {-0.05, 0.1}};
const normal_around<2> starts({{0.0, 0.0}, {0.0, 0.0}}, 0.1, 0.1);

struct followed {
  state x = start;
  noise xi;
};
/// `times` times t further, with the noise of each in that many parts.
followed follow(const reference& along, double t, int times, int parts, const path_place& at = {7, 3, 0},
                const galaxy& system = warm) {
  followed result;
  const auto run =
      along.open<double>(system, {start.q, start.p}, {.length = t, .at = at, .noise_parts = parts});
  for (int n = 0; n < times; ++n) {
    run->advance();
    result.xi.insert(result.xi.end(), run->noise().begin(), run->noise().end());
  }
  result.x = {run->state().q, run->state().p};
  return result;
}
double distance(const noise& a, const noise& b) {
  double worst = a.size() == b.size() ? 0.0 : INFINITY;
  for (std::size_t n = 0; n < std::min(a.size(), b.size()); ++n) {
    worst = std::max(worst, (a[n] - b[n]).cwiseAbs().maxCoeff());
  }
  return worst;
}

/// Root of the mean square distance, over many trajectories, of a path at time 1 from another on the same
/// noise.
double distance_between(const reference& along, const reference& other, const bath& heat_bath) {
  using T = detail::lanes;
  constexpr int lanes = lanes_in<T>;
  constexpr int blocks = 400 / lanes;
  const galaxy system(henon_heiles(), heat_bath);
  double sum = 0.0;
  for (int block = 0; block < blocks; ++block) {
    const path_place at{seed(7), static_cast<std::uint64_t>(block * lanes), 0};
    auto x =
        detail::gather<T, 2>(lanes, [&](int k) { return starts(seed(1), at.trajectory + std::uint64_t(k)); });
    auto y = x;
    along.advance(system, x, 1.0, at);
    other.advance(system, y, 1.0, at);
    for (int k = 0; k < lanes; ++k) {
      const auto a = lane(x, k);
      const auto b = lane(y, k);
      sum += (a.q - b.q).squaredNorm() + (a.p - b.p).squaredNorm();
    }
  }
  return std::sqrt(sum / (lanes * blocks));
}
double half_step_change(const reference& along, const bath& heat_bath) {
  return distance_between(along, along.finer(), heat_bath);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_path_is_a_run_with_fresh_noise) {
  const auto found = follow(fine_paths(0.01), 0.3, 1, 3);
  const auto stepper = make_stepper(warm, baoab(), 0.01, counter_noise(7));
  auto run = stepper.open(start, 3);
  stepper.advance(run, 30);
  // The step is computed as .3/30, which may differ in its last bit: 30 steps of some 30 operations.
  BOOST_TEST(test::distance(found.x, stepper.synchronous(run)) <= 30 * 30 * eps);
  noise expected(3, numbers(2));
  for (std::int64_t part = 0; part < 3; ++part) {
    noise fine(10, numbers(2));
    for (std::int64_t n = 0; n < 10; ++n) {
      counter_noise(7).normals(noise_place{3, 10 * part + n, 0}, fine[static_cast<std::size_t>(n)]);
    }
    detail::coarse_graining(2.0 * 0.01)
        .over(std::span<const numbers>(fine), expected[static_cast<std::size_t>(part)]);
  }
  BOOST_TEST(distance(found.xi, expected) <= 10 * 4 * eps);
  const auto other = follow(fine_paths(0.01), 0.3, 1, 3, {8, 3, 0});
  BOOST_TEST(test::distance(other.x, found.x) > 1e-3);
  BOOST_TEST(distance(other.xi, expected) > 1e-3);
}

BOOST_AUTO_TEST_CASE(a_path_goes_on_where_it_was) {
  const auto reference = fine_paths(0.01);
  const auto at_once = follow(reference, 0.6, 1, 6);
  const auto bit_by_bit = follow(reference, 0.1, 6, 1);
  // Stopped five times, kicks that were one are two.
  BOOST_TEST(test::distance(at_once.x, bit_by_bit.x) <= 60 * 30 * eps);
  BOOST_TEST(distance(at_once.xi, bit_by_bit.xi) <= 10 * 4 * eps);
  auto again_and_again = start;
  for (int n = 0; n < 6; ++n) {
    reference.advance(warm, again_and_again, 0.1, path_place{7, 3, 0});
  }
  BOOST_TEST(test::distance(at_once.x, again_and_again) > 1e-3);  // with the first noise six times
}

BOOST_AUTO_TEST_CASE(finer_sees_the_same_path) {
  const auto coarse = fine_paths(0.01);
  BOOST_TEST(coarse.finer().description() == "baoab with step 0.005");
  const auto expected = follow(coarse, 0.1, 10, 2);
  auto reference = coarse;
  for (int halvings = 1; halvings <= 3; ++halvings) {
    reference = reference.finer();
    const auto finer = follow(reference, 0.1, 10, 2);
    BOOST_TEST(distance(finer.xi, expected.xi) <= 5 * (1 << halvings) * 4 * 4 * eps);
    // Sigma .1 and a step of .01: paths differ by sigma h/sqrt(12) after a time of 1, but for a factor.
    const double change = test::distance(finer.x, expected.x);
    BOOST_TEST(change < 0.1 * 0.01);
    BOOST_TEST(change > 0.1 * 0.01 / 100.0);
  }
  // Half the step with its own noise is another path.
  const auto independent = follow(fine_paths(0.005), 0.1, 10, 2);
  BOOST_TEST(distance(independent.xi, expected.xi) > 0.1);
  BOOST_TEST(test::distance(independent.x, expected.x) > 0.1 * 0.1);
}

BOOST_AUTO_TEST_CASE(the_error_falls_with_the_step) {
  // With noise by two: within a step the path is not known, which q feels as sigma h^{3/2}. A root mean
  // square of 400 trajectories in four coordinates has a standard error of 2.5 % at most.
  const bath noisy = bath::of_sigma(2.0, 0.1);
  const double first = half_step_change(fine_paths(0.04), noisy);
  const double second = half_step_change(fine_paths(0.04).finer(), noisy);
  const double third = half_step_change(fine_paths(0.04).finer().finer(), noisy);
  const auto near = boost::test_tools::tolerance(standard_errors(false_alarms / 2) * std::sqrt(2.0) * 0.025);
  BOOST_TEST(first / second == 2.0, near);
  BOOST_TEST(second / third == 2.0, near);
  BOOST_TEST(first / third != 2.0, near);
  // Without noise by four, but for terms of h^2.
  const bath damped = bath::of_sigma(2.0, 0.0);
  const double still = half_step_change(fine_paths(0.04), damped);
  BOOST_TEST(still / half_step_change(fine_paths(0.02), damped) == 4.0, boost::test_tools::tolerance(0.01));
}

// Against a 64th of the step, which is as good as exact. Of order two the error is 4/3 of the difference;
// where noise makes those of successive halvings independent, sqrt(4/3) = 1.155. Within 5 %: 400
// trajectories.
BOOST_AUTO_TEST_CASE(the_error_is_told_from_the_difference) {
  const auto reference = fine_paths(1.0 / 16.0);
  auto exact = reference;
  for (int n = 0; n < 6; ++n) exact = exact.finer();
  for (const double friction : {0.01, 0.1, 1.0}) {
    const bath heat_bath = bath::of_sigma(friction, 0.1);
    const double error = distance_between(reference, exact, heat_bath);
    const double ratio = error / half_step_change(reference, heat_bath);
    BOOST_TEST(ratio <= 1.05 * detail::error_over_difference, "friction " << friction << ": " << ratio);
    BOOST_TEST(ratio >= 0.95 * std::sqrt(4.0 / 3.0), "friction " << friction << ": " << ratio);
  }
}

BOOST_AUTO_TEST_CASE(other_methods_with_one_letter_follow_the_same_path) {
  const auto expected = follow(fine_paths(0.01), 0.1, 10, 2);
  const auto check = [&](const auto& method) {
    const auto found = follow(fine_paths(0.01, method), 0.1, 10, 2);
    BOOST_TEST(distance(found.xi, expected.xi) == 0.0);  // the noise is no method's
    BOOST_TEST(test::distance(found.x, expected.x) < 0.1 * 0.01 * 2.0);
    BOOST_TEST(test::distance(found.x, expected.x) > 1e-9);
  };
  check(aboba());
  check(thermostat(mclachlan2(), placement::end));
  check(thermostat(mclachlan2(), placement::middle));
}

BOOST_AUTO_TEST_CASE(without_sigma_there_is_no_noise) {
  for (const double friction : {0.0, 2.0}) {
    const galaxy quiet(henon_heiles(), bath::of_sigma(friction, 0.0));
    const auto found = follow(fine_paths(0.01), 0.1, 1, 2, {7, 3, 0}, quiet);
    BOOST_TEST(distance(found.xi, noise(2, Eigen::Vector2d::Zero())) == 0.0);
    BOOST_TEST(same_bits(found.x, follow(fine_paths(0.01), 0.1, 1, 2, {8, 9, 4}, quiet).x));
  }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_followed_is_refused) {
  const auto refused = [](double step, double t, int parts, std::initializer_list<std::string_view> words) {
    return refuses<wrong>([&] { follow(fine_paths(step), t, 1, parts); }, words);
  };
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  for (const method& method : {nysalt::method(obabo()), nysalt::method(verlet())}) {
    BOOST_TEST(refuses([&] { fine_paths(0.1, method); }, {"one letter O", method.name()}));
  }
  BOOST_TEST(refused(0.0, 0.1, 0, {"positive and finite", "got 0"}));
  BOOST_TEST(refused(-0.1, 0.1, 0, {"positive and finite", "-0.1"}));
  BOOST_TEST(refused(nan, 0.1, 0, {"positive and finite", "nan"}));
  BOOST_TEST(refused(0.01, 0.105, 0, {"0.105 in the 1 equal parts", "fine step 0.01"}));
  BOOST_TEST(refused(0.01, 0.11, 2, {"0.11 in the 2 equal parts", "fine step 0.01"}));
  BOOST_TEST(!refused(0.01, 0.12, 2, {}));
  BOOST_TEST(refused(0.01, 0.005, 0, {"0.005", "a multiple"}));
  BOOST_TEST(refused(0.01, -0.1, 0, {"-0.1", "a multiple"}));
  BOOST_TEST(refused(0.01, nan, 0, {"nan", "a multiple"}));
  BOOST_TEST(refuses<wrong>([] { fine_paths(0.1, obabo()); }, {"one letter O", "obabo with 2"}));
  const auto far = [] { follow(fine_paths(0.01), 0.1, 1, 1, {7, 3, std::int64_t{1} << 45}); };
  BOOST_TEST(refuses<wrong>(far, {"step", "2^48"}));  // ten fine steps each
}
