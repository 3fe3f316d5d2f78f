// SPDX-License-Identifier: BSL-1.0
// One step of each Langevin method on the damped oscillator, as a matrix and a covariance: against the word
// spelled out, against the solution without noise, and the law that it keeps.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/langevin_methods.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

double difference(const auto& a, const auto& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// Error of the map over a time 2 in that many steps of the merged loop, without noise.
double error_in(std::int64_t steps, const Method auto& method) {
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
double measured_order(const Method auto& method) {
  return std::log2(error_in(512, method) / error_in(1024, method));
}

/// Variances of omega q and p, and their covariance, over kT.
struct law_kept {
  double q, p, both;
};
/// At z = h omega and gamma = g omega.
law_kept kept_by(const Method auto& method, double z, double g) {
  const double omega = 3.0;
  const damped_oscillator x{omega, g * omega, 0.7};
  const double kT = x.invariant()(1, 1);
  const square<2> law = stationary(library_step(x, method, z / omega));
  return {law(0, 0) * omega * omega / kT, law(1, 1) / kT, law(0, 1) * omega / kT};
}

}  // namespace

BOOST_AUTO_TEST_CASE(verlet_in_a_bath_has_other_names) {
  static_assert(std::is_same_v<bathed_verlet<placement::middle>::word, baoab::word>);
  static_assert(std::is_same_v<bathed_verlet<placement::symmetric>::word, obabo::word>);
  BOOST_TEST((bathed_verlet<placement::middle>().coefficients() == baoab::coefficients()));
  BOOST_TEST((bathed_verlet<placement::symmetric>().coefficients() == obabo::coefficients()));
}

BOOST_AUTO_TEST_CASE_TEMPLATE(a_step_is_the_word_spelled_out, M, langevin_methods) {
  draws random;
  for (int n = 0; n < 10; ++n) {
    const damped_oscillator x{random.uniform(0.5, 3.0), random.uniform(0.0, 5.0), random.uniform(0.1, 2.0)};
    const double h = random.uniform(0.05, 1.0);
    const auto step = library_step(x, M(), h);
    const auto word = word_step(x, spell(M()), h);
    // Each of 9 letters multiplies by 1 + omega^2 h < 10 at most, and the word never by more than 100.
    const double rounding = 9.0 * 100.0 * eps;
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", draw " << n << ", " << M().name()) {
      BOOST_TEST(difference(step.map, word.map) <= rounding);
      BOOST_TEST(difference(step.covariance, word.covariance) <= 100.0 * rounding);
      const auto other = word_step({x.omega, x.gamma, 1.01 * x.sigma}, spell(M()), h);
      BOOST_TEST(difference(step.covariance, other.covariance) > 1e-6);
    }
  }
}

// The slope over the last halving is off by a term of the next order, some h = 2/1024 of it. A family
// declares what all its members have; that at b1 = 1/2 is symmetric, and has order 2 in the middle too.
BOOST_AUTO_TEST_CASE_TEMPLATE(without_noise_a_method_has_its_order, M, langevin_methods) {
  const bool is_symmetric_member = M().name() == "nystrom_middle";
  const int order = is_symmetric_member ? 2 : M::order;
  BOOST_TEST_CONTEXT(M().name()) { BOOST_TEST(std::abs(measured_order(M()) - order) <= 0.02); }
}

// O in the middle is in the middle of the time only if the word is symmetric.
BOOST_AUTO_TEST_CASE(the_middle_of_a_word_that_is_not_symmetric) {
  using middle = member<thermostatted_family<nystrom, placement::middle>>;
  using symmetric = member<thermostatted_family<nystrom, placement::symmetric>>;
  BOOST_TEST(std::abs(measured_order(middle({0.5, 0.41})) - 2.0) <= 0.02);
  BOOST_TEST(std::abs(measured_order(middle({0.45, 0.385})) - 1.0) <= 0.05);
  BOOST_TEST(std::abs(measured_order(symmetric({0.45, 0.385})) - 2.0) <= 0.02);
}

// kT/omega^2 and kT times these, whatever the friction; q and p are independent. Without O a step keeps
// (omega q)^2 n + p^2 x, which makes S, and so every word of S and O, keep a normal law. BAOAB and ABOBA are
// such words seen from elsewhere; for them q has the exact law, for OBABO p has.
BOOST_AUTO_TEST_CASE(the_law_that_is_kept) {
  const auto check = [](const Method auto& method, double z, double g, double of_q, double of_p) {
    const law_kept is = kept_by(method, z, g);
    // Rounding of a step, some 10 eps, over what it forgets, g z or less; it grows towards the edge of
    // stability.
    const double rounding = 20.0 * eps * (1.0 + 1.0 / (g * z)) * (1.0 + 1.0 / std::abs(1.0 - z * z / 4.0));
    BOOST_TEST_CONTEXT(method.name() << ", z " << z << ", g " << g) {
      BOOST_TEST(std::abs(is.q / of_q - 1.0) <= rounding);
      BOOST_TEST(std::abs(is.p / of_p - 1.0) <= rounding);
      BOOST_TEST(std::abs(is.both) <= rounding * std::sqrt(of_q * of_p));
    }
  };
  for (const double z : {0.1, 0.5, 1.0, 1.5, 1.9, 1.99}) {
    for (const double g : {0.01, 0.3, 1.0, 5.0}) {
      const double v = 1.0 - z * z / 4.0;
      check(baoab(), z, g, 1.0, v);
      check(aboba(), z, g, 1.0, 1.0 / v);
      check(obabo(), z, g, 1.0 / v, 1.0);
      check(bathed_verlet<placement::end>(), z, g, 1.0 / v, 1.0);
      check(baoab_2x(), z, g, 1.0, 1.0 - z * z / 16.0);
      const double beta1 = 0.41;  // docs/theory-langevin-optimum.md
      const double n = 1.0 - z * z * (beta1 - 0.25);
      const double x = 1.0 - 2.0 * z * z * beta1 * (1.0 - 2.0 * beta1) +
                       z * z * z * z * (1.0 - 2.0 * beta1) * (1.0 - 2.0 * beta1) * (beta1 - 0.25);
      check(two_stages<placement::end>(), z, g, x / n, 1.0);
      check(two_stages<placement::symmetric>(), z, g, x / n, 1.0);
    }
  }
}

// Exactness in q is a property of few words.
BOOST_AUTO_TEST_CASE(most_words_do_not_keep_the_law_of_q) {
  BOOST_TEST(std::abs(kept_by(obabo(), 1.0, 0.3).q - 1.0) > 0.3);
  BOOST_TEST(std::abs(kept_by(two_stages<placement::symmetric>(), 1.0, 0.3).q - 1.0) > 0.02);
  BOOST_TEST(std::abs(kept_by(two_stages<placement::middle>(), 1.0, 0.3).q - 1.0) > 0.05);
}
