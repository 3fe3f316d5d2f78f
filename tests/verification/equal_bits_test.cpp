// SPDX-License-Identifier: BSL-1.0
// Trajectories of systems made of + - * / sqrt have the same bits from any compiler, in any lanes, on any
// number of threads: the hashes below are those of all of them.
#include <boost/test/unit_test.hpp>

#include "../support/systems.hpp"
#include "../support/trajectory_hash.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(the_chain) {
  const fpu_chain<3> chain(50.0);
  const member<nystrom> learned({0.51, 0.4});
  must_have(0xa3039e62515f01ffU, chain, verlet(), 0.01);
  must_have(0x72d20a23d494d637U, chain, learned, 0.03);
  must_have(0x72d20a23d494d637U, chain, tabulated(learned), 0.03);
  must_have(0xef0fece6c771e772U, chain, srkn6b(), 0.05);
  must_have(0x72d20a23d494d637U, fpu_chain<>(3, 50.0), learned, 0.03);
}

BOOST_AUTO_TEST_CASE(other_systems) {
  must_have(0xbbe778e91101a5f4U, henon_heiles(), srkn11b(), 0.1);
  must_have(0x8e5652c3e009195cU, relativistic(), verlet(), 0.1);
  // Its modes come from an eigensolver, but a trajectory does not ask for them.
  must_have(0x778e5a0cd91d7a34U, linear_chain::between_walls(5, 2.0, 3.0), verlet(), 0.1);
}

// One bit of one number is enough to be seen.
BOOST_AUTO_TEST_CASE(the_hash_sees_the_last_bit) {
  const auto of = [](double omega) {
    return trajectory_hash<double>(fpu_chain<3>(omega), verlet(), 0.01, 1);
  };
  BOOST_TEST(of(50.0) != of(std::nextafter(50.0, 51.0)));
}
