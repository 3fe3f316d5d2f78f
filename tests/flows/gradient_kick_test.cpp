// SPDX-License-Identifier: BSL-1.0
// G and H are their formula, p += b h f + 2 c h^3 f'(q) M^-1 f, and cost two evaluations, of a black box
// three. D is p += b h f(q + c h^2 M^-1 f(q)), keeps volume, runs back, and is not symplectic.
#include "nysalt/flows/gradient_kick.hpp"

#include <boost/test/unit_test.hpp>

#include "../laws/laws.hpp"
#include "../support/systems.hpp"
#include "nysalt/derivatives/taylor_order.hpp"
#include "nysalt/families/fd_chin.hpp"
#include "nysalt/families/fg4.hpp"
#include "nysalt/families/fg_chin.hpp"
#include "nysalt/flows/displaced_kick.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/counted.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double h = 0.4;
constexpr double b = 0.7;
constexpr double c = 0.013;

using split_masses = with_quadratic_part<two_masses>;
split_masses split() { return {two_masses(), Eigen::MatrixXd{{1.0, -1.0}, {-1.0, 1.0}}}; }

template <class W, SeparableSystem S>
auto kicked(const S& system, phase_point<double, S::dimension> x, double of_f = b, double of_g = c) {
  stepper<S, W>(system, {of_f, of_g}, h).step(x);
  return x;
}

/// The same by a word as data.
template <SeparableSystem S>
auto kicked_by(const char* letter, const S& system, phase_point<double, S::dimension> x) {
  stepper(system, run_time_word(letter), {b, c}, h).step(x);
  return x;
}

/// With the force and its derivative by hand.
phase_point<double, 2> expected(phase_point<double, 2> x, const vector<double, 2>& f,
                                const Eigen::Matrix2d& slope) {
  const vector<double, 2> v(f[0], 0.25 * f[1]);  // masses 1 and 4
  const vector<double, 2> g = slope * v;
  x.p += f * (b * h) + g * (2.0 * c * h * h * h);
  return x;
}

constexpr double rounding = 30.0 * eps;  // some 30 operations on numbers below 2

}  // namespace

BOOST_AUTO_TEST_CASE(with_the_whole_force_the_kick_is_that_of_the_formula) {
  draws random;
  for (int n = 0; n < 10; ++n) {
    const auto x = random.state(two_masses(), 1.0);
    const double elongation = x.q[1] - x.q[0];
    const vector<double, 2> cubes = x.q.array().cube();
    const vector<double, 2> f = vector<double, 2>(elongation, -elongation) - cubes;
    const Eigen::Matrix2d slope{{-1.0 - 3.0 * x.q[0] * x.q[0], 1.0}, {1.0, -1.0 - 3.0 * x.q[1] * x.q[1]}};
    const auto y = expected(x, f, slope);
    BOOST_TEST_CONTEXT("seed " << draws::seed) {
      BOOST_TEST(distance(kicked<word<gradient_kick>>(two_masses(), x), y) <= rounding);
      BOOST_TEST(distance(kicked_by("G", two_masses(), x), y) <= rounding);
      BOOST_TEST(distance(kicked<word<gradient_kick>>(two_masses(), x, b, 1.01 * c), y) > 1e3 * rounding);
    }
  }
}

BOOST_AUTO_TEST_CASE(with_the_soft_force_the_kick_is_that_of_the_formula) {
  draws random;
  for (int n = 0; n < 10; ++n) {
    const auto x = random.state(two_masses(), 1.0);
    const vector<double, 2> cubes = x.q.array().cube();
    const Eigen::Matrix2d slope = (-3.0 * x.q.cwiseAbs2()).asDiagonal();
    const auto y = expected(x, -cubes, slope);
    BOOST_TEST_CONTEXT("seed " << draws::seed) {
      BOOST_TEST(distance(kicked<word<soft_gradient_kick>>(split(), x), y) <= rounding);
      BOOST_TEST(distance(kicked_by("H", split(), x), y) <= rounding);
      BOOST_TEST(distance(kicked<word<gradient_kick>>(split(), x), y) > 1e-6);  // G is of the whole force
    }
  }
}

BOOST_AUTO_TEST_CASE(however_the_force_is_written_it_is_the_same) {
  const phase_point<double, 1> x{vector<double, 1>(0.8), vector<double, 1>(0.1)};
  const double f = -std::sin(0.8);
  const double p = 0.1 + b * h * f + 2.0 * c * h * h * h * -std::cos(0.8) * f;
  const auto off = [&](const auto& system) {
    return std::abs(kicked<word<gradient_kick>>(system, x).p[0] - p);
  };
  BOOST_TEST(off(black_box_with_derivative()) <= rounding);
  // A central difference along h^2 f errs by s^2 (h^2 f)^2/6 and eps/(s h^2) of its size, which is below
  // .001.
  constexpr double s = detail::part_of_displacement;
  const double size = std::abs(2.0 * c * h * h * h * std::cos(0.8) * f);
  const double differences = s * s * h * h * h * h * f * f / 6.0 + 2.0 * eps / (s * h * h);
  BOOST_TEST(off(black_box()) <= size * differences + rounding * size);
}

// Coefficients of dual numbers: dp/db = h f, dp/dc = 2 h^3 f' f.
BOOST_AUTO_TEST_CASE(derivatives_by_both_coefficients_flow_through_it) {
  using D = dual<double, 2>;
  const auto slopes = [](const auto& system) {
    phase_point<D, 1> x{vector<D, 1>(D(0.8)), vector<D, 1>(D(0.1))};
    using S = std::decay_t<decltype(system)>;
    stepper<S, word<gradient_kick>, D>(system, {D::variable(b, 0), D::variable(c, 1)}, h).step(x);
    return x.p[0].derivative;
  };
  const double f = -std::sin(0.8);
  const double by_b = h * f;
  const double by_c = 2.0 * h * h * h * -std::cos(0.8) * f;
  const auto exact = slopes(black_box_with_derivative());
  BOOST_TEST(std::abs(exact[0] - by_b) <= rounding);
  BOOST_TEST(std::abs(exact[1] - by_c) <= rounding);
  const auto boxed = slopes(black_box());
  BOOST_TEST(std::abs(boxed[0] - by_b) <= rounding);
  constexpr double s = detail::part_of_displacement;
  BOOST_TEST(std::abs(boxed[1] - by_c) <= std::abs(by_c) * (s * s + 2.0 * eps / (s * h * h)));
}

namespace {

/// Evaluations of a plain step, and of ten steps of a run.
template <SeparableSystem S, Word W>
std::array<std::int64_t, 2> evaluations_of(const S& system, const W& word,
                                           const typename W::template coefficients<double>& coefficients) {
  const counted<S> watched(system);
  const stepper one(watched, word, coefficients, 0.01);
  auto x = phase_point<double, S::dimension>{make_vector<double>(system), make_vector<double>(system)};
  x.q.setConstant(0.3);
  x.p.setConstant(0.2);
  auto y = x;
  one.step(y);
  const std::int64_t plain = watched.evaluations;
  auto run = one.open(x);
  one.advance(run, 10);
  return {plain, watched.evaluations - plain};
}

template <Family F>
void check_cost(const auto& system, std::int64_t plain, std::int64_t ten_steps) {
  using W = typename F::word;
  const auto coefficients = F::coefficients(F::start());
  const std::array expected_of{plain, ten_steps};
  BOOST_TEST_CONTEXT(F::name << " on " << describe(system)) {
    BOOST_TEST((evaluations_of(system, W(), coefficients) == expected_of));
    BOOST_TEST((evaluations_of(system, run_time_word(W()), {coefficients.begin(), coefficients.end()}) ==
                expected_of));
    using S = std::decay_t<decltype(system)>;
    const int more = (derivative_calls<S> - 1) * W::force_derivatives;  // than what the word says of others
    BOOST_TEST(W::evaluations_of_plain_step + more == plain);
    BOOST_TEST(W::evaluations_to_open + 10 * (W::evaluations_per_step + more) == ten_steps);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_costs_two_evaluations_and_by_differences_three) {
  const std::array alone{std::int64_t{2}, std::int64_t{11}};  // the force is known: q does not move
  BOOST_TEST((evaluations_of(two_masses(), word<gradient_kick>(), {b, c}) == alone));
  // fg_chin: the last kick's force is the first one's of the next step.
  check_cost<fg_chin>(dynamic_potential(), 4, 1 + 10 * 3);
  check_cost<fg_chin>(black_box(), 5, 1 + 10 * 4);
  check_cost<fg_chin>(black_box_with_derivative(), 4, 1 + 10 * 3);
  check_cost<fg4>(two_masses(), 4, 10 * 4);
  check_cost<r_fg4>(split(), 4, 10 * 4);  // rotations cost none
}

BOOST_AUTO_TEST_CASE(a_displaced_kick_is_that_of_the_formula) {
  draws random;
  const two_masses system;
  constexpr double of_g = 0.13;
  for (int n = 0; n < 10; ++n) {
    const auto x = random.state(system, 1.0);
    vector<double, 2> f;
    vector<double, 2> displaced;
    force<double>(system, x.q, f);
    const vector<double, 2> q(x.q[0] + of_g * h * h * f[0],
                              x.q[1] + of_g * h * h * 0.25 * f[1]);  // masses 1, 4
    force<double>(system, q, displaced);
    const vector<double, 2> expected = x.p + b * h * displaced;
    auto of_type = x;
    stepper<two_masses, word<displaced_kick>>(system, {b, of_g}, h).step(of_type);
    auto of_data = x;
    stepper(system, run_time_word("D"), {b, of_g}, h).step(of_data);
    BOOST_TEST((of_type.p - expected).norm() <= 2.0 * rounding);
    BOOST_TEST(same_bits(of_type, of_data));
    const vector<double, 2> without_masses = x.q + of_g * h * h * f;
    force<double>(system, without_masses, displaced);
    BOOST_TEST((x.p + b * h * displaced - expected).norm() > 2e4 * rounding);
  }
}

BOOST_AUTO_TEST_CASE(a_displaced_kick_costs_two_evaluations_of_a_black_box_too) {
  const counted<black_box> system{black_box()};
  const auto evaluations = [&](const auto& method, int steps) {
    const auto stepper = make_stepper(system, method, 0.1);
    auto run = stepper.open(phase_point<double, 1>{vector<double, 1>(0.3), vector<double, 1>(0.2)});
    system.evaluations = 0;
    stepper.advance(run, steps);
    return system.evaluations;
  };
  BOOST_TEST(evaluations(chin4a_displaced{}, 10) == 30);
  BOOST_TEST(evaluations(chin4a{}, 10) == 40);  // differences take two
  BOOST_TEST(run_time_word("BADAB").evaluations_per_step == 3);
  BOOST_TEST(word<displaced_kick>::evaluations_of_plain_step == 2);
}

BOOST_AUTO_TEST_CASE(a_displaced_kick_keeps_volume_and_runs_back_but_is_not_symplectic) {
  draws random;
  const auto& galaxy = specimen_of("henon_heiles");
  const auto& spring = specimen_of("harmonic_oscillator");
  const tabulated method(member<fd_chin>({0.17, 0.05}));
  for (int n = 0; n < 5; ++n) {
    const auto x = galaxy.at_random(random);
    BOOST_TEST(volume_broken(galaxy.system, method, h, x) <= 1.0);
    BOOST_TEST(reversibility_broken(galaxy.system, method, h, x) <= 1.0);
    BOOST_TEST(symplecticity_broken(galaxy.system, method, h, x) > 1e3);
    BOOST_TEST(symplecticity_broken(spring.system, method, h, spring.at_random(random)) <= 1.0);
  }
  BOOST_TEST(!word_of(fd_chin()).is_symplectic);
  BOOST_TEST(!run_time_word("BADAB").is_symplectic);
  BOOST_TEST(run_time_word("BAGAB").is_symplectic);
}

// To leading order D(b, c) is G(b, b c/2): one is the other with the force's Taylor polynomial.
BOOST_AUTO_TEST_CASE(its_order_is_that_of_the_gradient_kick_up_to_four) {
  BOOST_TEST((taylor_order(chin4a_displaced{}) == taylor_order(chin4a{})));
  BOOST_TEST(taylor_order(chin4a_displaced{}).quadratic_kinetic == 4);
  BOOST_TEST(taylor_order(run_time_word("BADAB"), {1.0 / 6.0, 0.5, 2.0 / 3.0, 0.04, 0.5, 1.0 / 6.0})
                 .quadratic_kinetic == 2);
}
