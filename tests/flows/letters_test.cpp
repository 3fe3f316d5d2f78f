// SPDX-License-Identifier: BSL-1.0
// What a letter states of itself is true of its flow, for each letter that a word as data can name.
#include <boost/test/unit_test.hpp>

#include <cmath>
#include <string>
#include <tuple>
#include <vector>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/detail/served_letters.hpp"
#include "nysalt/detail/step_on_oscillator.hpp"
#include "nysalt/run_time_word.hpp"
#include "nysalt/stepper.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// q'' = -(omega^2 + kappa) q, of which omega^2 is the quadratic part.
struct spring_and_rest {
  static constexpr int dimension = 1;
  static constexpr double omega = 1.3;
  static constexpr double kappa = 2.0;
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

/// One that declares no quadratic part.
struct without_parts {
  static constexpr int dimension = 1;
  void force(const vector<double, 1>& q, vector<double, 1>& f) const { f[0] = -q[0]; }
};

/// f(flow) for all letters but that of the bath.
void for_each_hamiltonian(const auto& f) {
  const auto unless_of_bath = [&](auto flow) {
    if constexpr (!StochasticFlow<decltype(flow)>) f(flow);
  };
  std::apply([&](auto... flow) { (unless_of_bath(flow), ...); }, known_letters{});
}

std::vector<double> random_coefficients(draws& random, std::size_t slots) {
  std::vector<double> c(slots);
  for (double& x : c) x = random.uniform(0.2, 1.0);
  return c;
}

struct state {
  double q = 0.4;
  double p = -0.9;
  /// As far from another as ten roundings of numbers up to 10 lead.
  bool is_near(const state& other) const {
    return std::abs(q - other.q) <= 100.0 * eps && std::abs(p - other.p) <= 100.0 * eps;
  }
};

state after(const run_time_word& word, const std::vector<double>& c, state x) {
  step_on_oscillator(
      word, c, spring_and_rest::omega, [](double y) { return spring_and_rest::kappa * y; }, x.q, x.p);
  return x;
}

state after_stepping(const run_time_word& word, const std::vector<double>& c, const state& x) {
  const spring_and_rest system;
  phase_point<double, 1> z{vector<double, 1>(x.q), vector<double, 1>(x.p)};
  stepper<spring_and_rest, run_time_word>(system, word, c, 1.0).step(z);
  return {z.q[0], z.p[0]};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_action_on_an_oscillator_is_that_of_the_flow) {
  draws random;
  for_each_hamiltonian([&](auto flow) {
    const run_time_word word(std::string(1, flow.letter));
    auto c = random_coefficients(random, flow.slots);
    BOOST_TEST_CONTEXT("letter " << flow.letter) {
      BOOST_TEST(after(word, c, {}).is_near(after_stepping(word, c, {})));
      c.back() += 0.01;
      const auto other = after_stepping(word, c, {});
      c.back() -= 0.01;
      BOOST_TEST(!after(word, c, {}).is_near(other));
    }
  });
}

BOOST_AUTO_TEST_CASE(negated_coefficients_take_an_invertible_letter_back) {
  draws random;
  for_each_hamiltonian([&](auto flow) {
    const std::string letter(1, flow.letter);
    const auto c = random_coefficients(random, flow.slots);
    auto forth_and_back = c;
    auto twice = c;
    for (const double x : c) {
      forth_and_back.push_back(-x);
      twice.push_back(x);
    }
    BOOST_TEST_CONTEXT("letter " << letter) {
      const bool is_taken_back = after(run_time_word(letter + letter), forth_and_back, {}).is_near({});
      BOOST_TEST(is_taken_back == flow.invertible);
      BOOST_TEST(!after(run_time_word(letter + letter), twice, {}).is_near({}));
    }
  });
  BOOST_TEST(!ornstein_uhlenbeck::invertible);
  BOOST_TEST(!displaced_kick::invertible);
}

BOOST_AUTO_TEST_CASE(additive_letters_add_up) {
  draws random;
  for_each_hamiltonian([&](auto flow) {
    if constexpr (decltype(flow)::additive) {
      const std::string letter(1, flow.letter);
      const auto c = random_coefficients(random, 2);
      const auto one = after(run_time_word(letter), {c[0] + c[1]}, {});
      BOOST_TEST(after(run_time_word(letter + letter), c, {}).is_near(one), letter);
    }
  });
}

BOOST_AUTO_TEST_CASE(letters_of_a_quadratic_part_are_those_that_need_one) {
  for_each_hamiltonian([&](auto flow) {
    using L = decltype(flow);
    const bool is_of_part = L::splits == splitting::quadratic_part_and_rest;
    BOOST_TEST(is_of_part == !(L::template serves<without_parts, double>), flow.letter);
    BOOST_TEST(is_of_part == run_time_word(std::string(1, flow.letter)).rotates(), flow.letter);
    BOOST_TEST((L::same_order_as::splits == splitting::kinetic_and_potential), flow.letter);
    BOOST_TEST(L::slots == L::same_order_as::slots, flow.letter);
    BOOST_TEST(L::moves_q == L::same_order_as::moves_q, flow.letter);
  });
  BOOST_TEST((ornstein_uhlenbeck::splits == splitting::any));
  BOOST_TEST(run_time_word("OSO").rotates());
  BOOST_TEST(!run_time_word("OSO").reads_modes);
  BOOST_TEST(has_rotation(run_time_word("ORO")));
  BOOST_TEST(!run_time_word("OBAGO").rotates());
  static_assert(word<soft_kick, rotation, soft_kick>::rotates());
  static_assert(!word<kick, drift, kick>::rotates());
}
