// SPDX-License-Identifier: BSL-1.0
// The loop allocates nothing, however many steps it takes.
#include <boost/test/unit_test.hpp>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/long_fpu_chain.hpp"
#include "support/allocations.hpp"

namespace {

using namespace nysalt;
using nysalt::test::allocations;

template <System S, Method M>
std::size_t allocations_of(const S& chain, const M& method, std::int64_t steps) {
  const auto stepper = make_stepper(chain, method, 1e-3);
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

BOOST_AUTO_TEST_CASE(the_count_would_see_an_allocation) {
  const std::size_t before = allocations;
  const Eigen::VectorXd something(8);
  BOOST_TEST(allocations - before == 1U);
  BOOST_TEST(something.size() == 8);
}
