// SPDX-License-Identifier: BSL-1.0
// A pack computes in each lane what double computes, to the bit, in any number of lanes. Compensated sums
// keep what rounding takes from them; all else is as it is without.
#include <bit>

#include "../../examples/systems/compensated.hpp"
#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/textbook.hpp"

using namespace nysalt;
using namespace examples;
using namespace nysalt::test;

namespace {

template <int W>
using lanes = std::integral_constant<int, W>;
using all_widths = std::tuple<lanes<1>, lanes<2>, lanes<3>, lanes<7>, lanes<8>, lanes<16>>;

bool same_number(double a, double b) {
  return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
}

/// Numbers of all kinds, the odd ones among them.
template <int W>
pack<double, W> drawn(draws& random, bool with_odd_ones = true) {
  constexpr double odd[] = {0.0, -0.0, infinite, -infinite, 1e-310, 1e300};
  pack<double, W> result;
  for (int k = 0; k < W; ++k) {
    const double x = random.uniform(-3.0, 3.0);
    const bool is_odd = with_odd_ones && random.uniform(0.0, 1.0) < 0.3;
    result.set(k, is_odd ? odd[static_cast<std::size_t>(random.uniform(0.0, 5.999))] : x);
  }
  return result;
}

/// f over packs against f over double; NaN is as good as NaN.
template <int W>
void must_agree(const auto& f, const pack<double, W>& a, const pack<double, W>& b) {
  const pack<double, W> result = f(a, b);
  for (int k = 0; k < W; ++k) {
    const double expected = f(a[k], b[k]);
    const bool agrees = same_number(result[k], expected) || (std::isnan(result[k]) && std::isnan(expected));
    if (!agrees) BOOST_ERROR(W << " lanes, lane " << k << ": " << result[k] << " not " << expected);
  }
}

static_assert(Scalar<pack<double, 1>> && Scalar<pack<double, 3>> && Scalar<pack<double>>);
static_assert(Scalar<dual<pack<double, 16>, 2>> && Scalar<dual<dual<pack<double, 4>, 1>, 3>>);
static_assert(CoefficientOf<double, pack<double, 8>> && CoefficientOf<pack<double, 8>, pack<double, 8>>);
static_assert(!CoefficientOf<pack<double, 8>, pack<double, 16>> && !CoefficientOf<pack<double, 8>, double>);
static_assert(pack<double>::lanes == 2 * detail::native_lanes && pack<double>::lanes <= 16);

using number = compensated<double>;
using four = pack<double, 4>;

static_assert(Scalar<number>);
static_assert(Scalar<compensated<four>>);
static_assert(CoefficientOf<double, number>);

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(arithmetic_has_the_bits_of_double, Lanes, all_widths) {
  constexpr int W = Lanes::value;
  draws random;
  for (int trial = 0; trial < 20; ++trial) {
    const auto a = drawn<W>(random);
    const auto b = drawn<W>(random);
    must_agree<W>([](const auto& x, const auto& y) { return x + y; }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return x - y; }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return x * y; }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return x / y; }, a, b);
    must_agree<W>([](const auto& x, const auto&) { return -x; }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return 2.5 * x - y / 3.0 + 1.0; }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return x * y + x; }, a, b);  // not fused
    must_agree<W>([](auto x, const auto& y) { return ((x += y) -= 0.5) *= y; }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return select(x < y, x, y); }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return select(x <= y, y, -x); }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return select(x == y, x, y + 1.0); }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return select(x != y, x, y); }, a, a);
    must_agree<W>([](const auto& x, const auto& y) { return select(x > y, x, y); }, a, b);
    must_agree<W>([](const auto& x, const auto& y) { return select(x >= y, x, y); }, a, a);
  }
}

BOOST_AUTO_TEST_CASE_TEMPLATE(elementary_functions_have_the_bits_of_double, Lanes, all_widths) {
  constexpr int W = Lanes::value;
  using std::abs, std::atan, std::cos, std::cosh, std::exp, std::expm1, std::log, std::pow, std::sin;
  using std::sinh, std::sqrt, std::tan, std::tanh;
  draws random;
  const auto a = drawn<W>(random, false);
  const auto odd = drawn<W>(random);
  const auto agree = [&](const auto& f) {
    must_agree<W>([&](const auto& x, const auto&) { return f(x); }, a, a);
    must_agree<W>([&](const auto& x, const auto&) { return f(x); }, odd, odd);
  };
  agree([](const auto& x) { return sqrt(x); });
  agree([](const auto& x) { return abs(x); });
  agree([](const auto& x) { return exp(x); });
  agree([](const auto& x) { return expm1(x); });
  agree([](const auto& x) { return log(x * x); });
  agree([](const auto& x) { return sin(x); });
  agree([](const auto& x) { return cos(x); });
  agree([](const auto& x) { return tan(x); });
  agree([](const auto& x) { return atan(x); });
  agree([](const auto& x) { return sinh(x); });
  agree([](const auto& x) { return cosh(x); });
  agree([](const auto& x) { return tanh(x); });
  agree([](const auto& x) { return pow(x * x, 1.5); });
}

BOOST_AUTO_TEST_CASE_TEMPLATE(masks_say_which, Lanes, all_widths) {
  constexpr int W = Lanes::value;
  detail::lane_mask<W> none(false);
  BOOST_TEST(!any(none));
  BOOST_TEST(any(detail::lane_mask<W>(true)));
  for (int k = 0; k < W; ++k) {
    auto one = none;
    one.set(k, true);
    BOOST_TEST(any(one));
    for (int j = 0; j < W; ++j) {
      BOOST_TEST(one[j] == (j == k));
      BOOST_TEST((!one)[j] == (j != k));
      BOOST_TEST((one & !one)[j] == false);
      BOOST_TEST((one | !one)[j] == true);
    }
  }
}

// As users write a force: with Eigen's operators and constants in double.
BOOST_AUTO_TEST_CASE(eigen_multiplies_vectors_of_packs_by_doubles) {
  constexpr int W = 3;
  draws random;
  const Eigen::Matrix2d stiffness{{2.0, -1.0}, {-1.0, 3.0}};
  Eigen::Matrix<pack<double, W>, 2, 1> q;
  for (auto& x : q) x = drawn<W>(random, false);
  const Eigen::Matrix<pack<double, W>, 2, 1> f = -2.0 * q + q * 0.5 - q / 3.0 + stiffness * q;
  for (int k = 0; k < W; ++k) {
    const double x = q[0][k];
    const double y = q[1][k];
    BOOST_TEST(same_number(f[0][k], -2.0 * x + x * 0.5 - x / 3.0 + (2.0 * x + -1.0 * y)));
    BOOST_TEST(same_number(f[1][k], -2.0 * y + y * 0.5 - y / 3.0 + (-1.0 * x + 3.0 * y)));
  }
}

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
    BOOST_TEST(distance(x, y) <= 10.0 * 3.0 * 2.0 * eps * 3.0);
    BOOST_TEST(!same_bits(x, y));
  };
  const fpu_chain<2> chain(10.0);
  try_on(chain, random.state(chain, 0.5));
  try_on(kepler(), phase_point<double, 2>{vector<double, 2>(1.0, 0.0), vector<double, 2>(0.0, 1.1)});
}
