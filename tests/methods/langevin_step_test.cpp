// SPDX-License-Identifier: BSL-1.0
// Methods and families that are thermostatted: what they say. One step of each Langevin method on the damped
// oscillator, as a matrix and a covariance: against the word spelled out, against the solution without noise,
// and the law that it keeps. The oracle of these tests is checked by formulas that it does not use.
#include "../support/draws.hpp"
#include "../support/langevin.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "nysalt/families/aba.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr auto end = placement::end;
constexpr auto symmetric = placement::symmetric;
constexpr auto middle = placement::middle;

template <placement P, class M>
using in = thermostatted_method<P, M>;
using at_end = thermostatted_family<nystrom, end>;
using both_ends = thermostatted_family<nystrom, symmetric>;
using inside = thermostatted_family<nystrom, middle>;
using aba2_inside = thermostatted_family<aba<2>, middle>;

bool same(const tabulated& one, const tabulated& other) {
  return one.letters().letters() == other.letters().letters() && one.coefficients() == other.coefficients() &&
         one.order == other.order && one.symmetric == other.symmetric &&
         one.requires_quadratic_kinetic == other.requires_quadratic_kinetic;
}

}  // namespace

static_assert(Method<baoab> && Method<in<end, verlet>> && Method<in<symmetric, pefrl>>);
static_assert(baoab::order == 2 && baoab::symmetric);
static_assert(in<end, pefrl>::order == 1 && !in<end, pefrl>::symmetric);
static_assert(in<symmetric, pefrl>::order == 2 && in<symmetric, pefrl>::symmetric);
static_assert(in<middle, pefrl>::order == 2 && in<middle, pefrl>::symmetric);
static_assert(Family<at_end> && Family<both_ends> && Family<inside> && Family<aba2_inside>);
static_assert(at_end::name == "nystrom_end" && both_ends::name == "nystrom_symmetric" &&
              inside::name == "nystrom_middle");
static_assert(at_end::order == 1 && both_ends::order == 2);
// The middle of what is not symmetric is no middle.
static_assert(inside::order == 1 && aba2_inside::order == 2);
static_assert(!at_end::symmetric && !both_ends::symmetric && !inside::symmetric);  // nor is every nystrom
static_assert(aba2_inside::symmetric && !thermostatted_family<aba<2>, end>::symmetric);
static_assert(at_end::parameters == 2 && at_end::parameter_names == nystrom::parameter_names);

BOOST_AUTO_TEST_CASE(a_method_is_thermostatted_by_its_type_as_by_its_table) {
  const auto check = [](placement where, const auto& by_type, const char* name) {
    BOOST_TEST(same(thermostat(tabulated(pefrl()), where), tabulated(by_type)), name);
    BOOST_TEST(by_type.name() == name);
  };
  check(end, thermostat<end>(pefrl()), "pefrl_end");
  check(symmetric, thermostat<symmetric>(pefrl()), "pefrl_symmetric");
  check(middle, thermostat<middle>(pefrl()), "pefrl_middle");
  BOOST_TEST(same(tabulated(thermostat<middle>(verlet())), tabulated(baoab())));
  BOOST_TEST(same(tabulated(thermostat<symmetric>(verlet())), tabulated(obabo())));
  BOOST_TEST(same(tabulated(thermostat<middle>(verlet_aba())), tabulated(aboba())));
  BOOST_TEST(!same(tabulated(thermostat<end>(verlet())), tabulated(baoab())));
  const tabulated euler("euler", run_time_word("BA"), {1.0, 1.0}, {1, false, false});
  BOOST_TEST(thermostat(euler, symmetric).order == 1);
  BOOST_TEST(!thermostat(euler, symmetric).symmetric);
  BOOST_TEST(refuses<std::invalid_argument>([&] { thermostat(euler, middle); }, {"central letter"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { thermostat(tabulated(baoab{}), end); },
                                            {"must have no letters O"}));
}

BOOST_AUTO_TEST_CASE(a_thermostatted_family_is_the_family_with_the_bath_between) {
  BOOST_TEST((at_end::start() == nystrom::start()));
  for (std::size_t k = 0; k < 2; ++k) {
    const auto ours = both_ends::ranges()[k];
    const auto theirs = nystrom::ranges()[k];
    BOOST_TEST((ours.low == theirs.low && ours.high == theirs.high && ours.open == theirs.open));
  }
  BOOST_TEST(member<both_ends>::word::letters() == "OABABAO");
  BOOST_TEST(refuses<std::invalid_argument>([] { member<inside>({1.5, 0.4}); }, {"nystrom_middle", "b1"}));
}

// On the damped oscillator.

namespace {

// Under-damped, nearly undamped, critical, over-damped.
const std::vector<damped_oscillator> oscillators{
    {3.0, 1.0, .7}, {3.0, .01, .7}, {50.0, .01, .05}, {3.0, 6.0, .7}, {3.0, 10.0, .7}};

/// e^{-gamma t/2} (cos w t + (A + gamma/2) sin(w t)/w) with w^2 = omega^2 - gamma^2/4.
square<2> closed_map(const damped_oscillator& x, double t) {
  const std::complex<double> w =
      std::sqrt(std::complex<double>(x.omega * x.omega - 0.25 * x.gamma * x.gamma));
  const double c = std::cos(w * t).real();
  const double s = w == 0.0 ? t : (std::sin(w * t) / w).real();
  square<2> map;
  map << c + 0.5 * x.gamma * s, s, -x.omega * x.omega * s, c - 0.5 * x.gamma * s;
  return std::exp(-0.5 * x.gamma * t) * map;
}

double difference(const auto& a, const auto& b) { return (a - b).cwiseAbs().maxCoeff(); }

}  // namespace

BOOST_AUTO_TEST_CASE(the_solution_has_closed_form) {
  for (const auto& x : oscillators) {
    for (const double t : {1e-3, .3, 7.0}) {
      // The doublings multiply the rounding errors of the first piece, some 20 eps, by 4 |A| t at most.
      const double size = 1.0 + x.omega * x.omega + x.gamma;
      const double rounding = 20.0 * eps * size * (1.0 + 4.0 * size * t);
      const auto step = x.exact(t);
      const square<2> map = closed_map(x, t);
      const square<2> law = x.invariant();
      BOOST_TEST_CONTEXT("omega " << x.omega << ", gamma " << x.gamma << ", t " << t) {
        BOOST_TEST(difference(step.map, map) <= rounding);
        // The invariant law stays: C = Sigma - map Sigma map^T.
        const square<2> noise = law - map * law * map.transpose();
        BOOST_TEST(difference(step.covariance, noise) <= 2.0 * rounding * law.maxCoeff());
        // The Lyapunov equation divides by what a step forgets, 1 - det(map).
        const double forgotten = -std::expm1(-x.gamma * t);
        BOOST_TEST(difference(stationary(step), law) <= 4.0 * rounding / forgotten * law.maxCoeff());
        const double eta = x.exact_with_bath(t).covariance(2, 2);
        const double variance = -x.sigma * x.sigma * std::expm1(-2.0 * x.gamma * t) / (2.0 * x.gamma);
        BOOST_TEST(std::abs(eta - variance) <= rounding * variance);
      }
    }
  }
}

namespace {

/// Error of the map over a time 2 in that many steps of the merged loop, without noise.
double error_in(std::int64_t steps, const tabulated& method) {
  const damped_oscillator x{2.0, 0.7, 0.0};
  const auto system = bathed_system(x);
  const auto stepper = make_stepper(system, method, 2.0 / static_cast<double>(steps));
  const auto finish = [&](double q, double p) {
    auto run = stepper.open(point(q, p));
    stepper.advance(run, steps);
    return coordinates_of(stepper.synchronous(run));
  };
  square<2> map;
  map << finish(1.0, 0.0), finish(0.0, 1.0);
  return (map - x.exact(2.0).map).norm();
}
double measured_order(const tabulated& method) {
  return std::log2(error_in(512, method) / error_in(1024, method));
}

/// Variances of omega q and p, and their covariance, over kT.
struct law_kept {
  double q, p, both;
};
/// At z = h omega and gamma = g omega.
law_kept kept_by(const tabulated& method, double z, double g) {
  const double omega = 3.0;
  const damped_oscillator x{omega, g * omega, 0.7};
  const double kT = x.invariant()(1, 1);
  const square<2> law = stationary(library_step(x, method, z / omega));
  return {law(0, 0) * omega * omega / kT, law(1, 1) / kT, law(0, 1) * omega / kT};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_the_word_spelled_out) {
  draws random;
  for (const tabulated& method : langevin_methods()) {
    for (int n = 0; n < 10; ++n) {
      const damped_oscillator x{random.uniform(0.5, 3.0), random.uniform(0.0, 5.0), random.uniform(0.1, 2.0)};
      const double h = random.uniform(0.05, 1.0);
      const auto step = library_step(x, method, h);
      const auto word = word_step(x, spell(method), h);
      // Each of 9 letters multiplies by 1 + omega^2 h < 10 at most, and the word never by more than 100.
      const double rounding = 9.0 * 100.0 * eps;
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", draw " << n << ", " << method.name()) {
        BOOST_TEST(difference(step.map, word.map) <= rounding);
        BOOST_TEST(difference(step.covariance, word.covariance) <= 100.0 * rounding);
        const auto other = word_step({x.omega, x.gamma, 1.01 * x.sigma}, spell(method), h);
        BOOST_TEST(difference(step.covariance, other.covariance) > 1e-6);
      }
    }
  }
}

// The slope over the last halving is off by a term of the next order, some h = 2/1024 of it. A family
// declares what all its members have; that at b1 = 1/2 is symmetric, and has order 2 in the middle too.
BOOST_AUTO_TEST_CASE(without_noise_a_method_has_its_order) {
  for (const tabulated& method : langevin_methods()) {
    const int order = method.name() == "nystrom_middle" ? 2 : method.order;
    BOOST_TEST(std::abs(measured_order(method) - order) <= 0.02, method.name());
  }
}

// O in the middle is in the middle of the time only if the word is symmetric.
BOOST_AUTO_TEST_CASE(the_middle_of_a_word_that_is_not_symmetric) {
  BOOST_TEST(std::abs(measured_order(tabulated(member<inside>({0.5, 0.41}))) - 2.0) <= 0.02);
  BOOST_TEST(std::abs(measured_order(tabulated(member<inside>({0.45, 0.385}))) - 1.0) <= 0.05);
  BOOST_TEST(std::abs(measured_order(tabulated(member<both_ends>({0.45, 0.385}))) - 2.0) <= 0.02);
}

// kT/omega^2 and kT times these, whatever the friction; q and p are independent. Without O a step keeps
// (omega q)^2 n + p^2 x, which makes S, and so every word of S and O, keep a normal law. BAOAB and ABOBA are
// such words seen from elsewhere; for them q has the exact law, for OBABO p has.
BOOST_AUTO_TEST_CASE(the_law_that_is_kept) {
  const auto check = [](const tabulated& method, double z, double g, double of_q, double of_p) {
    const law_kept is = kept_by(method, z, g);
    // Rounding of a step, some 10 eps, over what it forgets: g z, or z/g of a strongly damped position; it
    // grows towards the edge of stability.
    const double forgotten = std::min(g * z, z / g);
    const double rounding = 20.0 * eps * (1.0 + 1.0 / forgotten) * (1.0 + 1.0 / std::abs(1.0 - z * z / 4.0));
    BOOST_TEST_CONTEXT(method.name() << ", z " << z << ", g " << g) {
      BOOST_TEST(std::abs(is.q / of_q - 1.0) <= rounding);
      BOOST_TEST(std::abs(is.p / of_p - 1.0) <= rounding);
      BOOST_TEST(std::abs(is.both) <= rounding * std::sqrt(of_q * of_p));
    }
  };
  for (const double z : {0.1, 0.5, 1.0, 1.5, 1.9, 1.99}) {
    for (const double g : {0.01, 0.3, 1.0, 5.0}) {
      const double v = 1.0 - z * z / 4.0;
      check(tabulated(baoab()), z, g, 1.0, v);
      check(tabulated(aboba()), z, g, 1.0, 1.0 / v);
      check(tabulated(obabo()), z, g, 1.0 / v, 1.0);
      check(tabulated(bathed_verlet<end>()), z, g, 1.0 / v, 1.0);
      check(tabulated(baoab_2x()), z, g, 1.0, 1.0 - z * z / 16.0);
      const double beta1 = 0.41;  // docs/theory-langevin-optimum.md
      const double n = 1.0 - z * z * (beta1 - 0.25);
      const double x = 1.0 - 2.0 * z * z * beta1 * (1.0 - 2.0 * beta1) +
                       z * z * z * z * (1.0 - 2.0 * beta1) * (1.0 - 2.0 * beta1) * (beta1 - 0.25);
      check(tabulated(two_stages<end>()), z, g, x / n, 1.0);
      check(tabulated(two_stages<symmetric>()), z, g, x / n, 1.0);
    }
  }
}
