// SPDX-License-Identifier: BSL-1.0
// Functions of one and of two numbers: their first and second derivatives are those that differences find,
// the values are those of double, and so are packs and compensated numbers; what they are where derivatives
// end.
#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/scalars/compensated.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/scalars/pack.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using D = dual<double, 2>;
using DD = dual<D, 2>;
using std::acos, std::asin, std::atan2, std::cbrt, std::erf, std::floor, std::hypot, std::max, std::min,
    std::pow;

constexpr double infinite = std::numeric_limits<double>::infinity();

/// All functions, f(name, function of x and y); those of one number read x.
void each_function(const auto& f) {
  f("asin", [](const auto& x, const auto&) { return asin(x * 0.5); });
  f("acos", [](const auto& x, const auto&) { return acos(x * 0.5); });
  f("cbrt", [](const auto& x, const auto&) { return cbrt(x); });
  f("erf", [](const auto& x, const auto&) { return erf(x); });
  f("floor", [](const auto& x, const auto&) { return floor(x * 3.0); });
  f("sign", [](const auto& x, const auto&) { return sign(x); });
  f("heaviside", [](const auto& x, const auto&) { return heaviside(x); });
  f("atan2", [](const auto& x, const auto& y) { return atan2(y, x); });
  f("hypot", [](const auto& x, const auto& y) { return hypot(x, y); });
  f("min", [](const auto& x, const auto& y) { return min(x, y); });
  f("max", [](const auto& x, const auto& y) { return max(x, y); });
  f("mod", [](const auto& x, const auto& y) { return mod(x, y); });
  f("pow", [](const auto& x, const auto& y) { return pow(x * x + 0.5, y); });
}

/// A point in any quadrant, whose distance from jumps and from singularities is 1e-3 at least.
std::array<double, 2> drawn_point(draws& random) {
  for (;;) {
    const auto one = [&] {
      return random.uniform(0.4, 1.4) * (random.uniform(-1.0, 1.0) < 0.0 ? -1.0 : 1.0);
    };
    const double x = one();
    const double y = one();
    const auto is_far = [](double z) { return std::abs(z - std::round(z)) > 1e-2; };
    if (is_far(3.0 * x) && is_far(x / y) && std::abs(x - y) > 1e-2) return {x, y};
  }
}

// Differences over 2h leave out h^2/6 of a third derivative, here below 300 (of pow at y = -1.4, and of the
// second derivatives of atan2 and cbrt): 5e-9. Rounding is below 8 eps of values below 30, over h: 5e-9.
constexpr double h = 1e-5;
constexpr double tolerance = 1e-8;

}  // namespace

BOOST_AUTO_TEST_CASE(first_and_second_derivatives_are_those_of_differences) {
  draws random;
  for (int n = 0; n < 50; ++n) {
    const std::array<double, 2> drawn = drawn_point(random);
    const double x = drawn[0];
    const double y = drawn[1];
    const auto first = [&](const auto& f, double a, double b) {
      return f(D::variable(a, 0), D::variable(b, 1)).derivative;
    };
    each_function([&](const char* name, const auto& f) {
      BOOST_TEST_CONTEXT(name << " at " << x << ", " << y << ", seed " << draws::seed) {
        const D found = f(D::variable(x, 0), D::variable(y, 1));
        BOOST_TEST(found.value == f(x, y));
        const double by_x = (f(x + h, y) - f(x - h, y)) / (2.0 * h);
        const double by_y = (f(x, y + h) - f(x, y - h)) / (2.0 * h);
        BOOST_TEST(std::abs(found.derivative[0] - by_x) <= tolerance);
        BOOST_TEST(std::abs(found.derivative[1] - by_y) <= tolerance);
        const DD second = f(DD::variable(D::variable(x, 0), 0), DD::variable(D::variable(y, 1), 1));
        for (std::size_t i = 0; i < 2; ++i) {
          const double xx = (first(f, x + h, y)[i] - first(f, x - h, y)[i]) / (2.0 * h);
          const double xy = (first(f, x, y + h)[i] - first(f, x, y - h)[i]) / (2.0 * h);
          BOOST_TEST(second.derivative[i].value == found.derivative[i]);
          BOOST_TEST(std::abs(second.derivative[i].derivative[0] - xx) <= tolerance);
          BOOST_TEST(std::abs(second.derivative[i].derivative[1] - xy) <= tolerance);
        }
      }
    });
    // The tolerance tells derivatives apart: that of acos is not that of asin.
    const double rise = (std::asin(0.5 * (x + h)) - std::asin(0.5 * (x - h))) / (2.0 * h);
    BOOST_TEST(std::abs(acos(D::variable(x, 0) * 0.5).derivative[0] - rise) > 1e3 * tolerance);
  }
}

BOOST_AUTO_TEST_CASE(a_double_beside_a_number_is_a_constant) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const std::array<double, 2> drawn = drawn_point(random);
    const double x = drawn[0];
    const double y = drawn[1];
    const D a = D::variable(x, 0);
    const D b = D::variable(y, 1);
    const auto check = [&](const char* name, const auto& f) {
      const D of_both = f(a, b);
      BOOST_TEST_CONTEXT(name << " at " << x << ", " << y << ", seed " << draws::seed) {
        BOOST_TEST(f(a, y).value == of_both.value);
        BOOST_TEST(f(x, b).value == of_both.value);
        BOOST_TEST(f(a, y).derivative[0] == of_both.derivative[0]);
        BOOST_TEST(f(x, b).derivative[1] == of_both.derivative[1]);
        BOOST_TEST(f(a, y).derivative[1] == 0.0);
        BOOST_TEST(f(x, b).derivative[0] == 0.0);
      }
    };
    check("atan2", [](const auto& p, const auto& q) { return atan2(p, q); });
    check("hypot", [](const auto& p, const auto& q) { return hypot(p, q); });
    check("min", [](const auto& p, const auto& q) { return min(p, q); });
    check("max", [](const auto& p, const auto& q) { return max(p, q); });
    check("mod", [](const auto& p, const auto& q) { return mod(p, q); });
  }
  BOOST_TEST(pow(2.0, D::variable(3.0, 0)).derivative[0] == 8.0 * std::log(2.0));
}

BOOST_AUTO_TEST_CASE(functions_are_defined_where_derivatives_end) {
  const auto at = [](double x, int k = 0) { return D::variable(x, k); };
  // acos and asin at the ends of their range, and beyond.
  BOOST_TEST(acos(at(1.0)).value == 0.0);
  BOOST_TEST(acos(at(1.0)).derivative[0] == -infinite);
  BOOST_TEST(acos(at(-1.0)).value == std::acos(-1.0));
  BOOST_TEST(acos(at(-1.0)).derivative[0] == -infinite);
  BOOST_TEST(asin(at(1.0)).derivative[0] == infinite);
  BOOST_TEST(asin(at(-1.0)).derivative[0] == infinite);
  BOOST_TEST(std::isnan(acos(at(1.5)).value));
  BOOST_TEST(cbrt(at(-8.0)).value == -2.0);
  BOOST_TEST(cbrt(at(0.0)).derivative[0] == infinite);
  // Axes, and the cut on the negative one.
  for (const auto& [y, x] : {std::pair{0.0, 2.0}, {2.0, 0.0}, {0.0, -2.0}, {-0.0, -2.0}, {-2.0, 0.0}}) {
    const D angle = atan2(at(y, 0), at(x, 1));
    BOOST_TEST(angle.value == std::atan2(y, x));
    BOOST_TEST(angle.derivative[0] == 0.25 * x);
    BOOST_TEST(angle.derivative[1] == -0.25 * y);
  }
  BOOST_TEST(std::isnan(atan2(at(0.0, 0), at(0.0, 1)).derivative[0]));
  BOOST_TEST(hypot(at(0.0, 0), at(0.0, 1)).value == 0.0);
  BOOST_TEST((hypot(at(0.0, 0), at(0.0, 1)).derivative == std::array{0.0, 0.0}));
  for (const double size : {1e200, 1e-200}) {  // three roundings
    BOOST_TEST(std::abs(hypot(at(-3.0 * size, 0), at(4.0 * size, 1)).derivative[0] + 0.6) <= 3.0 * eps);
  }
  // Powers of zero and of negative numbers.
  BOOST_TEST(pow(at(0.0), D(2.0)).derivative[0] == 0.0);
  BOOST_TEST(pow(at(0.0), D(1.0)).derivative[0] == 1.0);
  BOOST_TEST(pow(at(0.0), D(0.0)).derivative[0] == 0.0);
  BOOST_TEST(pow(at(-2.0), D(3.0)).value == -8.0);
  BOOST_TEST(pow(at(-2.0), D(3.0)).derivative[0] == 12.0);
  BOOST_TEST(pow(D(0.0), at(2.0)).derivative[0] == 0.0);
  BOOST_TEST(std::isnan(pow(at(-2.0), D(0.5)).value));
  // Remainders have the sign of the divisor.
  BOOST_TEST(mod(-0.25, 1.0) == 0.75);
  BOOST_TEST(mod(5.5, -2.0) == -0.5);
  BOOST_TEST(mod(-6.0, 3.0) == 0.0);
  BOOST_TEST(mod(6.5, infinite) == 6.5);
  BOOST_TEST(std::isnan(mod(1.0, 0.0)));
  BOOST_TEST(mod(at(-0.25, 0), at(1.0, 1)).derivative[1] == 1.0);
  // Ties take the first, and jumps have the derivative 0.
  BOOST_TEST((min(at(1.0, 0), at(1.0, 1)).derivative == std::array{1.0, 0.0}));
  BOOST_TEST((max(at(1.0, 0), at(1.0, 1)).derivative == std::array{1.0, 0.0}));
  BOOST_TEST(sign(at(-0.0)).value == 0.0);
  BOOST_TEST(heaviside(at(0.0)).value == 1.0);
  BOOST_TEST(heaviside(at(0.0)).derivative[0] == 0.0);
  BOOST_TEST(floor(at(-0.5)).value == -1.0);
  BOOST_TEST(floor(at(2.0)).derivative[0] == 0.0);
}

BOOST_AUTO_TEST_CASE(packs_and_compensated_numbers_have_the_bits_of_double) {
  constexpr int W = 5;
  using P = pack<double, W>;
  draws random;
  for (int n = 0; n < 20; ++n) {
    P x;
    P y;
    for (int k = 0; k < W; ++k) {
      const std::array<double, 2> drawn = drawn_point(random);
      x.set(k, drawn[0]);
      y.set(k, n % 4 == 0 && k == 0 ? 0.0 : drawn[1]);
    }
    each_function([&](const char* name, const auto& f) {
      const P found = f(x, y);
      const auto derived = f(dual<P, 2>::variable(x, 0), dual<P, 2>::variable(y, 1));
      for (int k = 0; k < W; ++k) {
        BOOST_TEST_CONTEXT(name << " at " << x[k] << ", " << y[k] << ", seed " << draws::seed) {
          const double expected = f(x[k], y[k]);
          const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
          BOOST_TEST(same(found[k], expected));
          BOOST_TEST(same(f(compensated<double>(x[k]), compensated<double>(y[k])).value, expected));
          const D slopes = f(D::variable(x[k], 0), D::variable(y[k], 1));
          BOOST_TEST(same(derived.value[k], expected));
          BOOST_TEST(same(derived.derivative[0][k], slopes.derivative[0]));
          BOOST_TEST(same(derived.derivative[1][k], slopes.derivative[1]));
        }
      }
    });
  }
}
