// SPDX-License-Identifier: BSL-1.0
// Noisy trajectories have the same bits from any compiler, in any lanes, on any number of threads: the hashes
// below are those of all of them. The exponentials of a step are of one library, and are taken once.
#include <boost/test/unit_test.hpp>

#include "../support/systems.hpp"
#include "../support/trajectory_hash.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"

using namespace nysalt;
using namespace nysalt::test;

BOOST_AUTO_TEST_CASE(the_chain_in_a_bath) {
  const in_bath chain(fpu_chain<3>(50.0), bath::of_sigma(0.01, 0.05));
  const in_bath masses(two_masses(), bath::of_temperature(0.5, 0.25));
  must_have(0xaa7e00e0cb26955fU, chain, baoab(), 0.01, counter_noise(1));
  must_have(0xaa7e00e0cb26955fU, chain, tabulated(baoab{}), 0.01, counter_noise(1));
  must_have(0x825a4393124ca5b3U, chain, obabo(), 0.01, counter_noise(1));
  must_have(0x825a4393124ca5b3U, chain, tabulated(obabo{}), 0.01, counter_noise(1));
  must_have(0xcb1a5c8cc821cc65U, masses, obabo(), 0.1, counter_noise(1));
  BOOST_TEST((trajectory_hash<double>(chain, baoab(), 0.01, 1, counter_noise(2))) !=
             (trajectory_hash<double>(chain, baoab(), 0.01, 1, counter_noise(1))));
}
