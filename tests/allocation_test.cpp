// SPDX-License-Identifier: BSL-1.0
// The loop allocates nothing, however many steps it takes.
#include <boost/test/unit_test.hpp>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/baoab.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/long_fpu_chain.hpp"
#include "support/allocations.hpp"

namespace {

using namespace nysalt;
using nysalt::test::allocations;

template <System S, Method M, NoiseSource Noise = no_noise>
std::size_t allocations_of(const S& chain, const M& method, std::int64_t steps, const Noise& noise = {}) {
  const auto stepper = make_stepper(chain, method, 1e-3, noise);
  phase_point<double, S::dimension> start{make_vector<double>(chain), make_vector<double>(chain)};
  start.q.setConstant(0.7);
  start.p.setConstant(0.1);
  auto run = stepper.open(start);
  const std::size_t before = allocations;
  stepper.advance(run, steps);
  return allocations - before;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_loop_allocates_nothing) {
  const member<nystrom> two_stage({0.5, 0.4});
  BOOST_TEST(allocations_of(fpu_chain<3>(50.0), verlet{}, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<3>(50.0), two_stage, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<>(3, 50.0), verlet{}, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<>(3, 50.0), two_stage, 1000) == 0U);
  BOOST_TEST(allocations_of(long_fpu_chain(70, 50.0), verlet{}, 1000) == 0U);
  BOOST_TEST(allocations_of(long_fpu_chain(70, 50.0), tabulated(two_stage), 1000) == 0U);
}

// Of a dynamic size the noise has one vector, whatever the number of steps.
BOOST_AUTO_TEST_CASE(the_noisy_loop_allocates_nothing) {
  const in_bath fixed(fpu_chain<3>(50.0), bath::of_sigma(0.1, 0.05));
  const in_bath dynamic(fpu_chain<>(3, 50.0), bath::of_sigma(0.1, 0.05));
  const in_bath cold(fpu_chain<3>(50.0), bath::of_sigma(0.1, 0.0));
  const in_bath quiet(fpu_chain<>(3, 50.0), bath::of_sigma(0.0, 0.0));
  const counter_noise noise(1);
  BOOST_TEST(allocations_of(fixed, baoab(), 1000, noise) == 0U);
  BOOST_TEST(allocations_of(fixed, obabo(), 1000, noise) == 0U);
  BOOST_TEST(allocations_of(fixed, tabulated(baoab{}), 1000, noise) == 0U);
  BOOST_TEST(allocations_of(cold, obabo(), 1000) == 0U);
  BOOST_TEST(allocations_of(dynamic, baoab(), 1000, noise) == 1U);
  BOOST_TEST(allocations_of(dynamic, obabo(), 2, noise) == allocations_of(dynamic, obabo(), 1000, noise));
  BOOST_TEST(allocations_of(quiet, baoab(), 1000, noise) == 0U);
}

BOOST_AUTO_TEST_CASE(the_count_would_see_an_allocation) {
  const std::size_t before = allocations;
  const Eigen::VectorXd something(8);
  BOOST_TEST(allocations - before == 1U);
  BOOST_TEST(something.size() == 8);
}
