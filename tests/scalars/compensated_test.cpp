// SPDX-License-Identifier: BSL-1.0
// Sums keep what rounding takes from them; all else is as it is without.
#include <boost/test/unit_test.hpp>

#include <cmath>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/scalars/compensated.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/kepler.hpp"

using namespace nysalt;
using nysalt::test::draws;
using nysalt::test::eps;

namespace {

using number = compensated<double>;
using lanes = pack<double, 4>;

static_assert(Scalar<number>);
static_assert(Scalar<compensated<lanes>>);
static_assert(CoefficientOf<double, number>);

}  // namespace

BOOST_AUTO_TEST_CASE(a_long_sum_is_right_to_the_last_bit) {
  constexpr int terms = 1'000'000;
  number kept(1.0);
  double plain = 1.0;
  for (int n = 0; n < terms; ++n) kept += 1e-16;
  for (int n = 0; n < terms; ++n) plain += 1e-16;
  // Each summand, 1e-16 plus a carry below eps, rounds by less than eps^2: 1e6 of them by 5e-26.
  BOOST_TEST(std::abs(kept.value - (1.0 + 1e-10)) <= eps);
  BOOST_TEST(plain == 1.0);
  for (int n = 0; n < terms; ++n) kept -= 1e-16;
  BOOST_TEST(kept.value == 1.0);
  BOOST_TEST(std::abs(kept.carry) <= 2.0 * terms * eps * eps);
}

BOOST_AUTO_TEST_CASE(nothing_is_lost_whichever_summand_is_larger) {
  draws random;
  for (int n = 0; n < 1000; ++n) {
    const double a = random.uniform(-1.0, 1.0);
    const double b = std::ldexp(random.uniform(-1.0, 1.0), static_cast<int>(random.uniform(-40.0, 40.0)));
    number sum(a);
    sum += b;
    BOOST_TEST(sum.value == a + b);
    const long double rest =
        static_cast<long double>(a) + b - sum.value;  // 64 bits: of the carry the first 11
    BOOST_TEST(std::abs(static_cast<double>(rest - sum.carry)) <=
               std::ldexp(std::max(std::abs(a), std::abs(b)), -63));
  }
}

BOOST_AUTO_TEST_CASE(all_else_reads_the_value) {
  number x(3.0);
  x += 1e-17;
  BOOST_TEST(x.carry == 1e-17);
  BOOST_TEST((x * 2.0).value == 6.0);
  BOOST_TEST((x * 2.0).carry == 0.0);
  BOOST_TEST((1.0 / x - x + 0.5).value == 1.0 / 3.0 - 3.0 + 0.5);
  BOOST_TEST((-x).value == -3.0);
  BOOST_TEST(sqrt(x).value == std::sqrt(3.0));
  BOOST_TEST(pow(x, 1.5).value == std::pow(3.0, 1.5));
  BOOST_TEST((x > 2.0 && x < 4.0 && x == number(3.0)));
  BOOST_TEST(static_cast<double>(x) == 3.0);
  BOOST_TEST(select(x > 2.0, x, number(0.0)).carry == 1e-17);
}

BOOST_AUTO_TEST_CASE(a_lane_has_the_bits_that_it_has_alone) {
  draws random;
  compensated<lanes> all(0.5);
  number one(0.5);
  for (int n = 0; n < 100; ++n) {
    const double summand = random.uniform(-1e-3, 1e-3);
    lanes summands(0.1);
    summands.set(2, summand);
    all += summands;
    one += summand;
  }
  BOOST_TEST(all.value[2] == one.value);
  BOOST_TEST(all.carry[2] == one.carry);
  BOOST_TEST(all.value[1] != one.value);
}

BOOST_AUTO_TEST_CASE(a_step_is_the_plain_one_but_for_rounding) {
  draws random;
  const auto try_on = [&](const auto& system, const auto& start) {
    const auto fixed = make_stepper(system, verlet{}, 0.01);
    auto plain = fixed.open(start);
    auto kept = fixed.open(start.template cast<number>());
    fixed.advance(plain, 10);
    fixed.advance(kept, 10);
    const auto x = fixed.synchronous(plain);
    const auto y = fixed.synchronous(kept).template cast<double>();
    // 10 steps of 3 letters, each rounding a coordinate of size up to 2 by eps, on bounded motion of rate up
    // to 10 over a time of 0.1: what they did grows threefold at most.
    BOOST_TEST(test::distance(x, y) <= 10.0 * 3.0 * 2.0 * eps * 3.0);
    BOOST_TEST(!test::same_bits(x, y));
  };
  const fpu_chain<2> chain(10.0);
  try_on(chain, random.state(chain, 0.5));
  try_on(kepler(), phase_point<double, 2>{vector<double, 2>(1.0, 0.0), vector<double, 2>(0.0, 1.1)});
}

BOOST_AUTO_TEST_CASE(looking_does_not_change_a_run) {
  const fpu_chain<2> chain(10.0);
  draws random;
  const auto start = random.state(chain, 0.5).cast<number>();
  const auto fixed = make_stepper(chain, verlet{}, 0.01);
  auto at_once = fixed.open(start);
  fixed.advance(at_once, 20);
  auto watched = fixed.open(start);
  for (int n = 0; n < 20; ++n) {
    fixed.advance(watched, 1);
    fixed.synchronous(watched);
  }
  for (int i = 0; i < 4; ++i) {
    BOOST_TEST(at_once.state.q[i].value == watched.state.q[i].value);
    BOOST_TEST(at_once.state.q[i].carry == watched.state.q[i].carry);
  }
}
