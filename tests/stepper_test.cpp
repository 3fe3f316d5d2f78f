// SPDX-License-Identifier: BSL-1.0
// What a stepper refuses, and what it is for words that are not palindromes.
#include <boost/test/unit_test.hpp>

#include "laws/models.hpp"
#include "laws/run_laws.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/thermostatted.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/scalars/pack.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "support/refusal.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Symplectic Euler, kick first: nothing merges, nothing is reused.
struct euler_b {
  using word = nysalt::word<kick, drift>;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "euler_b"; }
  static std::array<double, 2> coefficients() { return {1.0, 1.0}; }
};
static_assert(Method<euler_b>);

phase_point<double, 1> somewhere() { return {vector<double, 1>(0.7), vector<double, 1>(-0.4)}; }

}  // namespace

BOOST_AUTO_TEST_CASE(a_step_is_finite_and_not_zero) {
  const pendulum system;
  for (const double step :
       {0.0, -0.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    BOOST_TEST(refuses<std::invalid_argument>([&] { make_stepper(system, verlet(), step); },
                                              {"step", "finite and not zero"}));
  }
  BOOST_TEST(make_stepper(system, verlet(), -0.1).step_size() == -0.1);
}

BOOST_AUTO_TEST_CASE(a_word_that_does_not_merge_runs_as_its_plain_steps_to_the_bit) {
  const pendulum system;
  const auto fixed = make_stepper(system, euler_b(), 0.1);
  auto run = fixed.open(somewhere());
  auto x = somewhere();
  BOOST_TEST(same_bits(fixed.synchronous(run), x));
  for (int n = 0; n < 50; ++n) fixed.step(x);
  fixed.advance(run, 50);
  BOOST_TEST(run.step == 50);
  BOOST_TEST(same_bits(fixed.synchronous(run), x));
  BOOST_TEST(evaluations_of_run(system, euler_b(), 0.1, somewhere(), 50) == 50);
}

BOOST_AUTO_TEST_CASE(a_run_from_q_and_p_is_an_open_run_to_the_bit) {
  const in_bath warm(pendulum(), bath::of_temperature(0.5, 0.1));
  const auto check = [&](const auto& method) {
    const auto fixed = make_stepper(warm, method, 0.1, counter_noise(1));
    const auto run_of = [&](std::uint64_t trajectory, int steps) {
      auto run = fixed.open(somewhere(), trajectory);
      fixed.advance(run, steps);
      return fixed.synchronous(run);
    };
    flow_state<double, 1> x{somewhere(), vector<double, 1>(0.0)};
    flow_state<double, 1> y = x;
    constexpr std::array after{2, 5};
    std::vector<phase_point<double, 1>> seen;
    fixed.run(x, y, after, 3, [&](std::size_t k) {
      BOOST_TEST(k == seen.size());
      seen.push_back(y);
    });
    BOOST_TEST_REQUIRE(seen.size() == 2U);
    BOOST_TEST(same_bits(seen[0], run_of(3, 2)));
    BOOST_TEST(same_bits(seen[1], run_of(3, 5)));
    BOOST_TEST(!same_bits(seen[1], run_of(2, 5)));
    BOOST_TEST(!same_bits(seen[1], run_of(3, 4)));
  };
  check(baoab());
  check(obabo());
  check(tabulated(obabo()));
}

BOOST_AUTO_TEST_CASE(verlet_is_verlet) {
  const pendulum system;
  const double h = 0.1;
  auto x = somewhere();
  make_stepper(system, verlet(), h).step(x);
  const double half = -0.4 - 0.5 * h * std::sin(0.7);
  const double q = 0.7 + h * half;
  BOOST_TEST(std::abs(x.q[0] - q) <= 4.0 * eps);  // the same four operations, in another order
  BOOST_TEST(std::abs(x.p[0] - (half - 0.5 * h * std::sin(q))) <= 4.0 * eps);
}

BOOST_AUTO_TEST_CASE(masses_divide_the_momentum) {
  const two_masses system;
  phase_point<double, 2> x{{0.0, 0.0}, {1.0, 1.0}};
  make_stepper(system, verlet(), 0.1).step(x);
  BOOST_TEST(x.q[0] == 0.1 * 1.0);
  BOOST_TEST(x.q[1] == 0.1 * 0.25);
}

BOOST_AUTO_TEST_CASE(counting_changes_nothing) {
  const auto system = an_fpu_chain::make();
  draws random;
  const auto x = random.state(system, 0.5);
  const counted watched(system);
  BOOST_TEST(same_bits(integrate(watched, pefrl(), 0.02, x, 100).finish,
                       integrate(system, pefrl(), 0.02, x, 100).finish));
  BOOST_TEST(watched.evaluations == 400);
  BOOST_TEST(describe(watched) == describe(system));
}

using methods_in_lanes = std::tuple<verlet, member<nystrom>>;

BOOST_AUTO_TEST_CASE_TEMPLATE(each_lane_has_the_bits_of_one_trajectory, M, methods_in_lanes) {
  draws random;
  for_each<std::tuple<an_fpu_chain, a_dynamic_fpu, a_free_chain>>([&]<class Model>() {
    const auto system = Model::make();
    const auto method = any_method<M>(random);
    const auto by_type = make_stepper(system, method, 0.02);
    const auto by_data = make_stepper(system, tabulated(method), 0.02);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << method.name() << " on " << describe(system)) {
      BOOST_TEST(lanes_are_alone<1>(by_type, random, Model::reach));
      BOOST_TEST(lanes_are_alone<8>(by_type, random, Model::reach));
      BOOST_TEST(lanes_are_alone<16>(by_type, random, Model::reach));
      BOOST_TEST(lanes_are_alone<16>(by_data, random, Model::reach));
      BOOST_TEST(!lanes_are_alone<8>(by_type, random, Model::reach, 32));  // a step apart
    }
  });
}
