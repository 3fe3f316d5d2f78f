// SPDX-License-Identifier: BSL-1.0
// R is the exact flow of the quadratic part, with masses and with a frequency of zero.
#include "nysalt/flows/rotation.hpp"

#include <boost/test/unit_test.hpp>

#include "../support/draws.hpp"
#include "../support/rounding.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/stepper.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

constexpr int dynamic = Eigen::Dynamic;

/// Three masses on two springs, held by nothing: frequencies 0, 1.2 and 2.2.
linear_chain free_chain() {
  const Eigen::MatrixXd stiffness{{2.0, -2.0, 0.0}, {-2.0, 5.0, -3.0}, {0.0, -3.0, 3.0}};
  return linear_chain(stiffness, Eigen::Vector3d(1.0, 2.0, 5.0));
}

template <class W, class... Number>
auto after(const linear_chain& chain, double h, phase_point<double, dynamic> x, const W& word, Number... c) {
  const stepper<linear_chain, W> one(chain, word, {c...}, h);
  one.step(x);
  return x;
}

/// To the modes and back each sums three products of numbers below 10, both ways of reckoning alike.
constexpr double rounding = 2.0 * (2.0 * 3.0 + 6.0) * eps * 10.0;

}  // namespace

BOOST_AUTO_TEST_CASE(on_a_linear_system_it_is_the_exact_flow) {
  const auto chain = free_chain();
  const exact_linear exact(chain);
  draws random;
  for (const double h : {1e-3, 0.3, 2.0, -0.7}) {
    for (int n = 0; n < 5; ++n) {
      const auto x = random.state(chain, 1.0);
      auto expected = x;
      exact.advance(chain, expected, h);
      BOOST_TEST_CONTEXT("seed " << draws::seed << ", step " << h) {
        BOOST_TEST(distance(after(chain, h, x, word<rotation>(), 1.0), expected) <= rounding);
        BOOST_TEST(distance(after(chain, h, x, run_time_word("R"), 1.0), expected) <= rounding);
        BOOST_TEST(distance(after(chain, h, x, word<rotation>(), 1.0 + 1e-9), expected) > rounding);
        // What is soft is nothing: all words with one rotation in all are the same.
        using impulse = word<soft_kick, rotation, soft_kick>;
        BOOST_TEST(distance(after(chain, h, x, impulse(), 0.5, 1.0, 0.5), expected) <= rounding);
        BOOST_TEST(distance(after(chain, h, x, run_time_word("RSR"), 0.3, 1.0, 0.7), expected) <=
                   2.0 * rounding);
      }
    }
  }
}

// A rotation that merges with that of the next step is one; each may add its rounding.
BOOST_AUTO_TEST_CASE(a_run_of_many_steps_is_the_exact_flow) {
  const auto chain = free_chain();
  const exact_linear exact(chain);
  draws random;
  const auto x = random.state(chain, 1.0);
  const double h = 0.4;
  const auto run_of = [&](const auto& word, const auto& c) {
    const stepper one(chain, word, c, h);
    auto run = one.open(x);
    one.advance(run, 50);
    return one.synchronous(run);
  };
  auto expected = x;
  exact.advance(chain, expected, 50 * h);
  // Positions of the centre of mass go on with their velocity: 20 times it.
  const double allowed = 50.0 * 2.0 * rounding * 20.0;
  const std::array c{0.5, 1.0, 0.5};
  BOOST_TEST(distance(run_of(word<rotation, soft_kick, rotation>(), c), expected) <= allowed);
  BOOST_TEST(distance(run_of(run_time_word("RSR"), std::vector(c.begin(), c.end())), expected) <= allowed);
  auto later = expected;
  exact.advance(chain, later, 1e-6);
  BOOST_TEST(distance(later, expected) > 100.0 * allowed);
}

BOOST_AUTO_TEST_CASE(of_unit_frequencies_it_is_a_turn_in_each_plane) {
  const with_quadratic_part galaxy(henon_heiles(), Eigen::MatrixXd::Identity(2, 2));
  draws random;
  const auto x = random.state(galaxy, 0.5);
  auto y = x;
  stepper<with_quadratic_part<henon_heiles>, word<rotation>>(galaxy, {1.0}, 0.6).step(y);
  const vector<double, 2> q = x.q * std::cos(0.6) + x.p * std::sin(0.6);
  const vector<double, 2> p = x.p * std::cos(0.6) - x.q * std::sin(0.6);
  BOOST_TEST(distance(y, {q, p}) <= rounding);
  BOOST_TEST(distance(y, x) > 0.1);
}

// d/dc of the flow over c h is h times the field where it ends.
BOOST_AUTO_TEST_CASE(derivatives_by_the_coefficient_flow_through_it) {
  using D = dual<double, 1>;
  const auto chain = free_chain();
  draws random;
  const auto x = random.state(chain, 1.0);
  const double h = 0.7;
  auto lifted = x.cast<D>();
  stepper<linear_chain, word<rotation>, D>(chain, {D::variable(0.6, 0)}, h).step(lifted);
  const auto end = after(chain, h, x, word<rotation>(), 0.6);
  Eigen::VectorXd f(3);
  force<double>(chain, end.q, f);
  for (Eigen::Index i = 0; i < 3; ++i) {
    BOOST_TEST(std::abs(lifted.q[i].value - end.q[i]) <= rounding);
    BOOST_TEST(std::abs(lifted.q[i].derivative[0] - h * end.p[i] * chain.inverse_mass(i)) <= 4.0 * rounding);
    BOOST_TEST(std::abs(lifted.p[i].derivative[0] - h * f[i]) <= 4.0 * rounding);
    BOOST_TEST(std::abs(f[i]) > 1e-3);
  }
}
