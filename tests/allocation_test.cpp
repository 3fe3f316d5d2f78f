// SPDX-License-Identifier: BSL-1.0
// The loop allocates nothing, however many steps it takes.
#include <boost/test/unit_test.hpp>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/verlet.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "support/allocations.hpp"

namespace {

using namespace nysalt;
using nysalt::test::allocations;

template <Method M, int Pairs>
std::size_t allocations_of(const fpu_chain<Pairs>& chain, const M& method, std::int64_t steps) {
  const auto stepper = make_stepper(chain, method, 1e-3);
  phase_point<double, fpu_chain<Pairs>::dimension> start{make_vector<double>(chain),
                                                         make_vector<double>(chain)};
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
}

BOOST_AUTO_TEST_CASE(the_count_would_see_an_allocation) {
  const std::size_t before = allocations;
  const Eigen::VectorXd something(8);
  BOOST_TEST(allocations - before == 1U);
  BOOST_TEST(something.size() == 8);
}
