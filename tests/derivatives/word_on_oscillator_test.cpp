// SPDX-License-Identifier: BSL-1.0
// The matrix of a word on the oscillator is that of a step.
#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/word_on_oscillator.hpp"
#include "nysalt/detail/step_on_oscillator.hpp"
#include "nysalt/stepper.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// q'' = -(omega^2 + kappa) q, of which kappa is called soft.
struct split_oscillator {
  static constexpr int dimension = 1;
  double omega;
  double kappa;
  template <class T>
  void force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * -(omega * omega + kappa);
  }
  template <class T>
  void soft_force(const vector<T, 1>& q, vector<T, 1>& f) const {
    f[0] = q[0] * -kappa;
  }
  normal_modes modes() const { return {Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Constant(1, omega)}; }
};

}  // namespace

BOOST_AUTO_TEST_CASE(letters_act_as_in_a_step) {
  draws random;
  for (const char* letters : {"ABA", "BAGAB", "ABABABA", "RSR", "RSRSRSR", "SRHRS"}) {
    for (const double omega : {0.0, 1.3}) {
      const run_time_word word{std::string(letters)};
      std::vector<double> c(word.slots);
      for (double& x : c) x = random.uniform(-0.5, 1.0);
      const double h = 0.7;
      const split_oscillator system{omega, 2.0};
      const stepper<split_oscillator, run_time_word> one(system, word, c, h);
      phase_point<double, 1> x{vector<double, 1>(0.4), vector<double, 1>(-0.9)};
      double q = x.q[0];
      double p = h * x.p[0];  // in units of q/h
      one.step(x);
      step_on_oscillator(
          word, c, h * omega, [&](double y) { return h * h * system.kappa * y; }, q, p);
      BOOST_TEST_CONTEXT("word " << letters << ", omega " << omega) {
        // Some ten operations a letter, on numbers that grow to 10 at most.
        const double rounding = 100.0 * static_cast<double>(word.length) * eps;
        BOOST_TEST(std::abs(q - x.q[0]) <= rounding);
        BOOST_TEST(std::abs(p - h * x.p[0]) <= rounding);
      }
    }
  }
}

// Velocity Verlet: trace/2 = 1 - z^2/2. Impulses: cos theta - k sin(theta)/(2 theta).
BOOST_AUTO_TEST_CASE(traces_are_the_known_ones) {
  const auto verlet = half_trace(run_time_word("BAB"), {0.5, 1.0, 0.5}, 0.0, 1.0, 9.0);
  BOOST_TEST(std::abs(verlet.at_low() - 0.5) < 10.0 * eps);
  BOOST_TEST(std::abs(verlet.at_high() + 3.5) < 100.0 * eps);
  const auto impulse = half_trace(run_time_word("SRS"), {0.5, 1.0, 0.5}, 2.0, 0.0, 3.0);
  BOOST_TEST(std::abs(impulse.at_low() - std::cos(2.0)) < 10.0 * eps);
  BOOST_TEST(std::abs(impulse.at_high() - (std::cos(2.0) - 0.75 * std::sin(2.0))) < 10.0 * eps);
}

// Takahashi and Imada's: 1 - z^2/2 + z^4/24 in the trace.
BOOST_AUTO_TEST_CASE(gradient_kicks_have_two_coefficients) {
  const auto trace = half_trace(run_time_word("AGA"), {0.5, 1.0, 1.0 / 24.0, 0.5}, 0.0, 1.0, 4.0);
  BOOST_TEST(std::abs(trace.at_low() - (0.5 + 1.0 / 24.0)) < 10.0 * eps);
  BOOST_TEST(std::abs(trace.at_high() - (-1.0 + 16.0 / 24.0)) < 20.0 * eps);
}

BOOST_AUTO_TEST_CASE(the_bath_is_left_out) {
  const auto with = half_trace(run_time_word("BAOAB"), {0.5, 0.5, 1.0, 0.5, 0.5}, 0.0, 1.0, 4.0);
  const auto without = half_trace(run_time_word("BAAB"), {0.5, 0.5, 0.5, 0.5}, 0.0, 1.0, 4.0);
  BOOST_TEST(with.at_low() == without.at_low());
  BOOST_TEST(with.at_high() == without.at_high());
}
