// SPDX-License-Identifier: BSL-1.0
// Derivatives by dual numbers are those of calculus and, for functions of one and of two numbers, those of
// differences, the second ones too; through a step they are those of Ceres' Jets, which are scalars like any
// other. What functions are where derivatives end. Truncated power series multiply and divide as polynomials
// do.
#include <ceres/jet.h>

#include "../../examples/systems/compensated.hpp"
#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "../support/systems.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/scalars/dual.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/systems/fpu_chain.hpp"

using namespace nysalt;
using namespace examples;
using namespace nysalt::test;

namespace {

using D = dual<double, 1>;
using DD = dual<D, 1>;
using D2 = dual<double, 2>;
using DD2 = dual<D2, 2>;

/// f of a dual against f and f' in closed form: a handful of roundings in each.
void check(const char* name, double x, double value, double slope, const auto& f) {
  BOOST_TEST_CONTEXT(name << " at " << x << ", seed " << draws::seed) {
    const D y = f(D::variable(x, 0));
    BOOST_TEST(std::abs(y.value - value) <= 4.0 * eps * std::max(1.0, std::abs(value)));
    BOOST_TEST(std::abs(y.derivative[0] - slope) <= 8.0 * eps * std::max(1.0, std::abs(slope)));
    BOOST_TEST(y.value == f(x));  // the branch without derivatives is the same number
  }
}

using jet = ceres::Jet<double, 2>;
static_assert(Scalar<jet> && Scalar<D2> && Scalar<series<3>> && Scalar<double>);
static_assert(CoefficientOf<jet, jet> && CoefficientOf<double, jet>);
static_assert(!CoefficientOf<jet, D2> && !CoefficientOf<D2, jet> && !CoefficientOf<jet, double>);

/// How far two numbers with two derivatives are apart.
double distance_of(const D2& a, const jet& b) {
  return std::max(
      {std::abs(a.value - b.a), std::abs(a.derivative[0] - b.v[0]), std::abs(a.derivative[1] - b.v[1])});
}

using S = series<4>;

/// A spring whose stiffness is the variable.
struct spring {
  static constexpr int dimension = 1;
  void force(const vector<S, 1>& q, vector<S, 1>& f) const { f[0] = -(S::variable() * q[0]); }
};

using std::abs, std::acos, std::asin, std::sqrt, std::atan2, std::cbrt, std::erf, std::floor, std::hypot,
    std::max, std::min, std::pow;

void each_function_of_two(const auto& f) {
  f("atan2", [](const auto& x, const auto& y) { return atan2(y, x); });
  f("hypot", [](const auto& x, const auto& y) { return hypot(x, y); });
  f("min", [](const auto& x, const auto& y) { return min(x, y); });
  f("max", [](const auto& x, const auto& y) { return max(x, y); });
  f("mod", [](const auto& x, const auto& y) { return mod(x, y); });
}
/// All functions, f(name, function of x and y); those of one number read x.
void each_function(const auto& f) {
  f("asin", [](const auto& x, const auto&) { return asin(x * 0.5); });
  f("acos", [](const auto& x, const auto&) { return acos(x * 0.5); });
  f("cbrt", [](const auto& x, const auto&) { return cbrt(x); });
  f("erf", [](const auto& x, const auto&) { return erf(x); });
  f("floor", [](const auto& x, const auto&) { return floor(x * 3.0); });
  f("sign", [](const auto& x, const auto&) { return sign(x); });
  f("heaviside", [](const auto& x, const auto&) { return heaviside(x); });
  each_function_of_two(f);
  f("pow", [](const auto& x, const auto& y) { return pow(x * x + 0.5, y); });
  f("quotient",
    [](const auto& x, const auto& y) { return abs(x - y * 2.0) * sqrt(x * x + 1.0) / (y * y + 1.0); });
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

BOOST_AUTO_TEST_CASE(elementary_functions_have_their_derivatives) {
  draws random;
  using std::abs, std::atan, std::cos, std::cosh, std::exp, std::expm1, std::log, std::pow, std::sin,
      std::sinh, std::sqrt, std::tan, std::tanh;
  for (int n = 0; n < 50; ++n) {
    const double x = random.uniform(0.1, 1.4);
    const double y = random.uniform(-1.4, 1.4);
    const double sech = 1.0 / cosh(y);
    check("sqrt", x, sqrt(x), 0.5 / sqrt(x), [](const auto& a) { return sqrt(a); });
    check("log", x, log(x), 1.0 / x, [](const auto& a) { return log(a); });
    check("pow", x, pow(x, 2.5), 2.5 * pow(x, 1.5), [](const auto& a) { return pow(a, 2.5); });
    check("exp", y, exp(y), exp(y), [](const auto& a) { return exp(a); });
    for (const double z : {y, 1e-12 * y})
      check("expm1", z, expm1(z), exp(z), [](const auto& a) { return expm1(a); });
    check("sin", y, sin(y), cos(y), [](const auto& a) { return sin(a); });
    check("cos", y, cos(y), -sin(y), [](const auto& a) { return cos(a); });
    check("tan", y, tan(y), 1.0 / (cos(y) * cos(y)), [](const auto& a) { return tan(a); });
    check("atan", y, atan(y), 1.0 / (1.0 + y * y), [](const auto& a) { return atan(a); });
    check("sinh", y, sinh(y), cosh(y), [](const auto& a) { return sinh(a); });
    check("cosh", y, cosh(y), sinh(y), [](const auto& a) { return cosh(a); });
    check("tanh", y, tanh(y), sech * sech, [](const auto& a) { return tanh(a); });
    check("abs", y, abs(y), y < 0.0 ? -1.0 : 1.0, [](const auto& a) { return abs(a); });
  }
  BOOST_TEST(abs(D::variable(0.0, 0)).derivative[0] == 1.0);  // from the right
}

BOOST_AUTO_TEST_CASE(arithmetic_follows_the_product_and_quotient_rules) {
  draws random;
  for (int n = 0; n < 50; ++n) {
    const double x = random.uniform(0.5, 2.0);
    const double y = random.uniform(0.5, 2.0);
    const D2 a = D2::variable(x, 0);
    const D2 b = D2::variable(y, 1);
    BOOST_TEST(((a * b).derivative == std::array{y, x}));
    BOOST_TEST(((a + b).derivative == std::array{1.0, 1.0}));
    BOOST_TEST(((a - b).derivative == std::array{1.0, -1.0}));
    BOOST_TEST(((-a).derivative == std::array{-1.0, 0.0}));
    BOOST_TEST(std::abs((a / b).derivative[0] - 1.0 / y) <= 4.0 * eps / y);
    BOOST_TEST(std::abs((a / b).derivative[1] + x / (y * y)) <= 4.0 * eps * x / (y * y));
    BOOST_TEST(std::abs((2.0 / b).derivative[1] + 2.0 / (y * y)) <= 8.0 * eps / (y * y));
    BOOST_TEST((3.0 * a).derivative[0] == 3.0);
    BOOST_TEST((3.0 - a).derivative[0] == -1.0);
    D2 c = a;
    c += b;
    c *= b;
    c -= a;
    c /= b;  // ((a + b) b - a)/b = a + b - a/b
    BOOST_TEST(std::abs(c.derivative[0] - (1.0 - 1.0 / y)) <= 16.0 * eps);
    BOOST_TEST(std::abs(c.derivative[1] - (1.0 + x / (y * y))) <= 64.0 * eps);
  }
}

// Derivatives come for nothing: the values beside them are those of a run without.
BOOST_AUTO_TEST_CASE(values_follow_the_arithmetic_of_double_to_the_bit) {
  draws random;
  for (int n = 0; n < 10'000; ++n) {
    const double x = random.uniform(-10.0, 10.0);
    const double c = random.uniform(-10.0, 10.0);
    const auto same = [&](const char* name, const auto& f) {
      const double expected = f(x, c);
      const D a = D::variable(x, 0);
      const D b = D::variable(c, 0);
      const DD aa = DD::variable(a, 0);
      const DD bb = DD::variable(b, 0);
      const bool all = f(a, b).value == expected && f(a, c).value == expected && f(x, b).value == expected &&
                       f(aa, bb).value.value == expected && f(aa, c).value.value == expected &&
                       f(x, bb).value.value == expected;
      BOOST_TEST(all, x << ' ' << name << ' ' << c << ", seed " << draws::seed);
    };
    same("+", [](const auto& a, const auto& b) { return a + b; });
    same("-", [](const auto& a, const auto& b) { return a - b; });
    same("*", [](const auto& a, const auto& b) { return a * b; });
    same("/", [](const auto& a, const auto& b) { return a / b; });
    const auto compound = [](auto a, const auto& b) {
      a += b;
      a /= b;
      a *= b;
      a -= b;
      return -a;
    };
    BOOST_TEST(compound(D::variable(x, 0), c).value == compound(x, c));
    BOOST_TEST((D::variable(x, 0) / c).derivative[0] == 1.0 / c);
  }
}

BOOST_AUTO_TEST_CASE(nested_duals_have_second_derivatives) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const double x = random.uniform(0.1, 1.4);
    const DD a = DD::variable(D::variable(x, 0), 0);
    const DD y = sin(a) * a;  // (x sin x)'' = 2 cos x - x sin x
    BOOST_TEST(std::abs(y.derivative[0].derivative[0] - (2.0 * std::cos(x) - x * std::sin(x))) <= 8.0 * eps);
    BOOST_TEST(y.derivative[0].value == y.value.derivative[0]);
    const DD power = pow(a, 3.0) + sqrt(a) * 0.0 + 1.0 / a;
    BOOST_TEST(std::abs(power.derivative[0].derivative[0] - (6.0 * x + 2.0 / (x * x * x))) <=
               32.0 * eps * (6.0 * x + 2.0 / (x * x * x)));
  }
}

BOOST_AUTO_TEST_CASE(comparisons_are_those_of_the_values) {
  const D one = D::variable(1.0, 0);
  const D also_one(1.0);
  const D two(2.0);
  BOOST_TEST((one == also_one));
  BOOST_TEST((one != two));
  BOOST_TEST((one < two && two > one && one <= also_one && one >= also_one));
  BOOST_TEST((one < 2.0 && 2.0 > one && one == 1.0 && 0.5 < one));
  const D not_a_number(std::numeric_limits<double>::quiet_NaN());
  BOOST_TEST(!(not_a_number < one));
  BOOST_TEST(!(not_a_number >= one));
  BOOST_TEST((DD(one) < DD(two) && DD(one) < 1.5));
}

// By theta: coefficients and states over Jets; where the force comes from the potential, over duals of Jets.
BOOST_AUTO_TEST_CASE(derivatives_through_a_step_are_the_same_over_jets) {
  draws random;
  const auto check = [&](const auto& system) {
    using S = std::remove_cvref_t<decltype(system)>;
    const double b1 = random.uniform(0.4, 0.6);
    const double beta1 = random.uniform(0.3, 0.5);
    const auto c = nystrom::coefficients(std::array{D2::variable(b1, 0), D2::variable(beta1, 1)});
    const auto same = nystrom::coefficients(std::array{jet(b1, 0), jet(beta1, 1)});
    const stepper<S, D2> with_dual(system, nystrom::letters, {c.begin(), c.end()}, 0.05);
    const stepper<S, jet> with_jet(system, nystrom::letters, {same.begin(), same.end()}, 0.05);
    const auto x = random.state(system, 0.5);
    auto a = x.template cast<D2>();
    auto b = x.template cast<jet>();
    with_dual.step(a);
    with_jet.step(b);
    // Five letters of 20 operations; numbers are below 50, coefficients change by 1/b1^2 < 6.25 times theta.
    const double rounding = 5.0 * 20.0 * eps * 50.0 * 6.25;
    double moved = 0.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      BOOST_TEST(distance_of(a.q[i], b.q[i]) <= rounding);
      BOOST_TEST(distance_of(a.p[i], b.p[i]) <= rounding);
      for (int k = 0; k < 2; ++k) moved = std::max(moved, std::abs(b.p[i].v[k]));
    }
    BOOST_TEST(moved > 1e3 * rounding);  // there is something to compare
  };
  check(fpu_chain<3>(10.0));
  check(fpu_chain<>(3, 10.0));
  check(two_masses());
  check(relativistic());
}

BOOST_AUTO_TEST_CASE(products_drop_what_lies_beyond_and_division_undoes_them) {
  const S x = S::variable();
  const S y = (1.0 + x) * (1.0 + x) * (1.0 - x);  // 1 + x - x^2 - x^3
  BOOST_TEST((y.coefficient == std::array{1.0, 1.0, -1.0, -1.0, 0.0}));
  BOOST_TEST((x * x * x * x * x).coefficient[4] == 0.0);
  BOOST_TEST((x * x * (x * x)).coefficient[4] == 1.0);
  BOOST_TEST(((S(1.0) / (1.0 - x)).coefficient == std::array{1.0, 1.0, 1.0, 1.0, 1.0}));
  // (2 + 3 x) (2 - x - x^2) = 4 + 4 x - 5 x^2 - 3 x^3
  BOOST_TEST(((4.0 + x * 4.0 - x * x * 5.0 - x * x * x * 3.0) / (2.0 - x - x * x)).coefficient ==
                 (S(2.0) + 3.0 * x).coefficient,
             per_element());
}

BOOST_AUTO_TEST_CASE(a_step_over_series_is_its_taylor_expansion) {
  const spring system;
  const stepper<spring> one(system, verlet().letters(), verlet().coefficients(), 1.0);
  phase_point<S, 1> x{vector<S, 1>(S(1.0)), vector<S, 1>(S(0.0))};
  one.step(x);
  BOOST_TEST((x.q[0].coefficient == std::array{1.0, -0.5, 0.0, 0.0, 0.0}));
  BOOST_TEST((x.p[0].coefficient == std::array{0.0, -1.0, 0.25, 0.0, 0.0}));
}

BOOST_AUTO_TEST_CASE(first_and_second_derivatives_are_those_of_differences) {
  draws random;
  for (int n = 0; n < 50; ++n) {
    const std::array<double, 2> drawn = drawn_point(random);
    const double x = drawn[0];
    const double y = drawn[1];
    const auto first = [&](const auto& f, double a, double b) {
      return f(D2::variable(a, 0), D2::variable(b, 1)).derivative;
    };
    each_function([&](const char* name, const auto& f) {
      BOOST_TEST_CONTEXT(name << " at " << x << ", " << y << ", seed " << draws::seed) {
        const D2 found = f(D2::variable(x, 0), D2::variable(y, 1));
        BOOST_TEST(found.value == f(x, y));
        const double by_x = (f(x + h, y) - f(x - h, y)) / (2.0 * h);
        const double by_y = (f(x, y + h) - f(x, y - h)) / (2.0 * h);
        BOOST_TEST(std::abs(found.derivative[0] - by_x) <= tolerance);
        BOOST_TEST(std::abs(found.derivative[1] - by_y) <= tolerance);
        const DD2 second = f(DD2::variable(D2::variable(x, 0), 0), DD2::variable(D2::variable(y, 1), 1));
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
    BOOST_TEST(std::abs(acos(D2::variable(x, 0) * 0.5).derivative[0] - rise) > 1e3 * tolerance);
  }
}

BOOST_AUTO_TEST_CASE(a_double_beside_a_number_is_a_constant) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const std::array<double, 2> drawn = drawn_point(random);
    const double x = drawn[0];
    const double y = drawn[1];
    const D2 a = D2::variable(x, 0);
    const D2 b = D2::variable(y, 1);
    each_function_of_two([&](const char* name, const auto& f) {
      const D2 of_both = f(a, b);
      BOOST_TEST_CONTEXT(name << " at " << x << ", " << y << ", seed " << draws::seed) {
        BOOST_TEST(f(a, y).value == of_both.value);
        BOOST_TEST(f(x, b).value == of_both.value);
        BOOST_TEST(f(a, y).derivative[0] == of_both.derivative[0]);
        BOOST_TEST(f(x, b).derivative[1] == of_both.derivative[1]);
        BOOST_TEST(f(a, y).derivative[1] == 0.0);
        BOOST_TEST(f(x, b).derivative[0] == 0.0);
      }
    });
  }
  BOOST_TEST(pow(2.0, D2::variable(3.0, 0)).derivative[0] == 8.0 * std::log(2.0));
}

BOOST_AUTO_TEST_CASE(functions_are_defined_where_derivatives_end) {
  const auto at = [](double x, int k = 0) { return D2::variable(x, k); };
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
    const D2 angle = atan2(at(y, 0), at(x, 1));
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
  BOOST_TEST(pow(at(0.0), D2(2.0)).derivative[0] == 0.0);
  BOOST_TEST(pow(at(0.0), D2(1.0)).derivative[0] == 1.0);
  BOOST_TEST(pow(at(0.0), D2(0.0)).derivative[0] == 0.0);
  BOOST_TEST(pow(at(-2.0), D2(3.0)).value == -8.0);
  BOOST_TEST(pow(at(-2.0), D2(3.0)).derivative[0] == 12.0);
  BOOST_TEST(pow(D2(0.0), at(2.0)).derivative[0] == 0.0);
  BOOST_TEST(std::isnan(pow(at(-2.0), D2(0.5)).value));
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
          const auto same = [](double a, double b) {
            return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b) ||
                   (std::isnan(a) && std::isnan(b));
          };
          BOOST_TEST(same(found[k], expected));
          BOOST_TEST(same(f(compensated<double>(x[k]), compensated<double>(y[k])).value, expected));
          const D2 slopes = f(D2::variable(x[k], 0), D2::variable(y[k], 1));
          BOOST_TEST(same(derived.value[k], expected));
          BOOST_TEST(same(derived.derivative[0][k], slopes.derivative[0]));
          BOOST_TEST(same(derived.derivative[1][k], slopes.derivative[1]));
        }
      }
    });
  }
}
