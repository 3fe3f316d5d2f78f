// SPDX-License-Identifier: BSL-1.0
// One step of each Langevin method on the damped oscillator, as a matrix and a covariance: against the word
// spelled out, against the solution without noise, and the law that it keeps. The oracle of these tests is
// checked by formulas that it does not use. In a bath that does not act a method has the bits of its word
// without O.
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <complex>
#include <stdexcept>

#include "../support/draws.hpp"
#include "../support/langevin_methods.hpp"
#include "../support/rounding.hpp"
#include "nysalt/systems/henon_heiles.hpp"

using namespace nysalt;
using namespace nysalt::test;

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

const std::vector<spelled> spelled_baoab{{'B', .5}, {'A', .5}, {'O', 1.0}, {'A', .5}, {'B', .5}};

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

BOOST_AUTO_TEST_CASE(without_friction_the_noise_has_a_limit) {
  const damped_oscillator free{1e-9, 0.0, 2.0};  // Brownian motion and its integral
  const double t = 1.5;
  square<2> noise;
  noise << t * t * t / 3.0, t * t / 2.0, t * t / 2.0, t;
  BOOST_TEST(difference(free.exact(t).covariance, 4.0 * noise) <= 100.0 * eps * 4.0);
}

BOOST_AUTO_TEST_CASE(many_fine_intervals_are_a_coarse_one) {
  for (const auto& x : oscillators) {
    const auto fine = x.exact_with_bath(1e-3);
    gaussian_step<3> composed;
    for (int n = 0; n < 100; ++n) composed = then(composed, fine);
    const auto coarse = x.exact_with_bath(0.1);
    const double rounding = 100.0 * 40.0 * eps * (1.0 + x.omega * x.omega);
    BOOST_TEST(difference(composed.map, coarse.map) <= rounding);
    BOOST_TEST(difference(composed.covariance, coarse.covariance) <= rounding * x.sigma * x.sigma);
    // Its factor gives it back, and an interval of another length is told apart.
    const square<3> L = cholesky(fine.covariance);
    BOOST_TEST(difference(L * L.transpose(), fine.covariance) <= 4.0 * eps * x.sigma * x.sigma);
    BOOST_TEST(difference(composed.covariance, x.exact_with_bath(0.101).covariance) >
               1e-4 * x.sigma * x.sigma);
  }
}

BOOST_AUTO_TEST_CASE(solution_and_error_are_those_of_the_parts) {
  for (const auto& x : oscillators) {
    const double h = 1.0 / x.omega;
    const auto both = step_with_error(x, spelled_baoab, h);
    const auto word = word_step(x, spelled_baoab, h);
    const auto exact = x.exact(h);
    Eigen::Matrix<double, 2, 4> sum;  // solution + error = word
    sum << 1.0, 0.0, 1.0, 0.0, 0.0, 1.0, 0.0, 1.0;
    const double rounding = 200.0 * eps * (1.0 + x.omega * x.omega);
    BOOST_TEST(difference(both.map.topLeftCorner(2, 2), exact.map) <= rounding);
    BOOST_TEST(difference(both.covariance.topLeftCorner(2, 2), exact.covariance) <= rounding);
    BOOST_TEST(difference(sum * both.map.leftCols(2), word.map) <= rounding);
    BOOST_TEST(difference(both.map.bottomRightCorner(2, 2), word.map) <= rounding);
    BOOST_TEST(difference(sum * both.covariance * sum.transpose(), word.covariance) <= rounding);
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

BOOST_AUTO_TEST_CASE(verlet_in_a_bath_has_other_names) {
  static_assert(std::is_same_v<bathed_verlet<placement::middle>::word, baoab::word>);
  static_assert(std::is_same_v<bathed_verlet<placement::symmetric>::word, obabo::word>);
  BOOST_TEST((bathed_verlet<placement::middle>().coefficients() == baoab::coefficients()));
  BOOST_TEST((bathed_verlet<placement::symmetric>().coefficients() == obabo::coefficients()));
}

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
  using middle = member<thermostatted_family<nystrom, placement::middle>>;
  using symmetric = member<thermostatted_family<nystrom, placement::symmetric>>;
  BOOST_TEST(std::abs(measured_order(tabulated(middle({0.5, 0.41}))) - 2.0) <= 0.02);
  BOOST_TEST(std::abs(measured_order(tabulated(middle({0.45, 0.385}))) - 1.0) <= 0.05);
  BOOST_TEST(std::abs(measured_order(tabulated(symmetric({0.45, 0.385}))) - 2.0) <= 0.02);
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
      check(tabulated(bathed_verlet<placement::end>()), z, g, 1.0 / v, 1.0);
      check(tabulated(baoab_2x()), z, g, 1.0, 1.0 - z * z / 16.0);
      const double beta1 = 0.41;  // docs/theory-langevin-optimum.md
      const double n = 1.0 - z * z * (beta1 - 0.25);
      const double x = 1.0 - 2.0 * z * z * beta1 * (1.0 - 2.0 * beta1) +
                       z * z * z * z * (1.0 - 2.0 * beta1) * (1.0 - 2.0 * beta1) * (beta1 - 0.25);
      check(tabulated(two_stages<placement::end>()), z, g, x / n, 1.0);
      check(tabulated(two_stages<placement::symmetric>()), z, g, x / n, 1.0);
    }
  }
}

// Exactness in q is a property of few words.
BOOST_AUTO_TEST_CASE(most_words_do_not_keep_the_law_of_q) {
  BOOST_TEST(std::abs(kept_by(tabulated(obabo()), 1.0, 0.3).q - 1.0) > 0.3);
  BOOST_TEST(std::abs(kept_by(tabulated(two_stages<placement::symmetric>()), 1.0, 0.3).q - 1.0) > 0.02);
  BOOST_TEST(std::abs(kept_by(tabulated(two_stages<placement::middle>()), 1.0, 0.3).q - 1.0) > 0.05);
}

namespace {

using state = phase_point<double, 2>;
constexpr double idle_step = 0.1;
constexpr std::int64_t idle_steps = 1000;

bool same_bits(const state& x, const state& y) { return x.q == y.q && x.p == y.p; }

/// No random number may be drawn.
struct unasked {
  static constexpr bool is_memoryless = true;
  template <class T, int N>
  void normals(const noise_place&, vector<T, N>&) const {
    throw std::logic_error("a number was drawn");
  }
  template <class T, int N>
  void halving(const noise_place&, vector<T, N>&) const {
    throw std::logic_error("a number was drawn");
  }
};

/// After all steps of the merged loop, unobserved; the sum of what is seen on the way comes on top.
struct run_of {
  state finish, seen;
};
run_of run(const auto& stepper, const state& x) {
  run_of result{x, x};
  auto open = stepper.open(x);
  stepper.advance(open, idle_steps);
  result.finish = stepper.synchronous(open);
  auto watched = stepper.open(x);
  stepper.advance(watched, idle_steps, 7, [&](std::int64_t, const state& y) {
    result.seen.q += y.q;
    result.seen.p += y.p;
  });
  return result;
}
bool same_bits(const run_of& a, const run_of& b) {
  return same_bits(a.finish, b.finish) && same_bits(a.seen, b.seen);
}

/// The letters without O, made by hand and stepped as data.
tabulated deleted(const tabulated& method) {
  std::string letters;
  std::vector<double> coefficients;
  for (const auto& [letter, c] : spell(method)) {
    if (letter == 'O') continue;
    letters += letter;
    coefficients.push_back(c);
  }
  return {"deleted", run_time_word(letters), coefficients, {1, false, false}};
}

const henon_heiles alone;
in_bath<henon_heiles> coupled(const bath& b) { return {alone, b}; }

}  // namespace

BOOST_AUTO_TEST_CASE(an_idle_bath_changes_no_bit) {
  draws random;
  for (const tabulated& method : langevin_methods()) {
    const auto x = random.state(alone, 0.25);
    const auto plain = run(make_stepper(alone, deleted(method), idle_step), x);
    const auto in = [&](const bath& b) {
      const auto system = coupled(b);
      return run(make_stepper(system, method, idle_step, unasked()), x);
    };
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name()) {
      for (const auto& idle : {bath::of_sigma(0.0, 0.0), bath::of_temperature(0.0, 1.5)}) {
        const auto system = coupled(idle);
        BOOST_TEST(same_bits(run(make_stepper(system, method, idle_step), x), plain));
        BOOST_TEST(same_bits(in(idle), plain));
      }
      BOOST_TEST(same_bits(run(make_stepper(alone, method, idle_step), x), plain));  // and in none at all
      // The least friction is noticed, and draws nothing where there is no noise.
      BOOST_TEST(!same_bits(in(bath::of_sigma(1e-13, 0.0)), plain));
      BOOST_CHECK_THROW(in(bath::of_sigma(0.0, 1e-13)), std::logic_error);
    }
  }
  // And as types.
  const auto x = random.state(alone, 0.25);
  const auto plain = run(make_stepper(alone, deleted(tabulated(obabo())), idle_step), x);
  const auto idle = coupled(bath::of_temperature(0.0, 1.5));
  BOOST_TEST(same_bits(run(make_stepper(idle, obabo(), idle_step, unasked()), x), plain));
  BOOST_TEST(same_bits(run(make_stepper(alone, obabo(), idle_step), x), plain));
}
