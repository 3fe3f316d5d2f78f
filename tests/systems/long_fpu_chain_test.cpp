// SPDX-License-Identifier: BSL-1.0
// The chain of many masses is the FPU chain, stored in another order.
#include "nysalt/systems/long_fpu_chain.hpp"

#include <boost/test/unit_test.hpp>

#include "../laws/system_laws.hpp"
#include "../support/allocations.hpp"
#include "../support/draws.hpp"
#include "../support/refusal.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/methods/classical.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using state = phase_point<double, Eigen::Dynamic>;

state ends_apart(const long_fpu_chain& chain, const state& x) {
  return {chain.ends_apart(x.q), chain.ends_apart(x.p)};
}

/// One chain in both orders, at the edges of the blocks in which soft bonds are taken.
template <Method M>
bool moves_as_fpu_chain(Eigen::Index pairs, const M& method) {
  const fpu_chain<> in_turn(pairs, 50.0);
  const long_fpu_chain apart(pairs, 50.0);
  draws random;
  const state x = random.state(in_turn, 0.5);
  return same_bits(integrate(apart, method, 0.01, ends_apart(apart, x), 100).finish,
                   ends_apart(apart, integrate(in_turn, method, 0.01, x, 100).finish));
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_mass_moves_as_in_fpu_chain_to_the_bit) {
  for (const Eigen::Index pairs : {1, 2, 3, 63, 64, 65, 128, 129, 200}) {
    BOOST_TEST_CONTEXT(pairs << " pairs") {
      BOOST_TEST(moves_as_fpu_chain(pairs, verlet()));
      BOOST_TEST(moves_as_fpu_chain(pairs, member<nystrom>({0.5, 0.4})));
    }
  }
}

BOOST_AUTO_TEST_CASE(the_kick_of_the_chain_is_that_of_its_force) {
  draws random;
  for (const Eigen::Index pairs : {1, 2, 63, 64, 65, 129}) {
    const long_fpu_chain chain(pairs, 50.0);
    BOOST_TEST(kick_is_force(chain, random.state(chain, 1.0), 0.3));
  }
}

BOOST_AUTO_TEST_CASE(orders_are_each_other_s_inverse) {
  const long_fpu_chain chain(2, 50.0);
  const Eigen::VectorXd in_turn = Eigen::Vector4d(1.0, 2.0, 3.0, 4.0);
  BOOST_TEST((chain.ends_apart(in_turn) == Eigen::Vector4d(1.0, 3.0, 2.0, 4.0)));
  BOOST_TEST((chain.ends_in_turn(chain.ends_apart(in_turn)) == in_turn));
  const Eigen::VectorXd three = Eigen::Vector3d::Zero();
  BOOST_TEST(refuses<std::invalid_argument>([&] { chain.ends_apart(three); }, {"4 masses", "3 coordinates"}));
  BOOST_TEST(refuses<std::invalid_argument>([&] { chain.ends_in_turn(three); }, {"4 masses"}));
}

BOOST_AUTO_TEST_CASE(the_energies_are_those_of_fpu_chain) {
  const fpu_chain<> in_turn(5, 50.0);
  const long_fpu_chain apart(5, 50.0);
  draws random;
  const state x = random.state(in_turn, 1.0);
  const state y = ends_apart(apart, x);
  BOOST_TEST(energy<double>(apart, y) == energy<double>(in_turn, x), boost::test_tools::tolerance(10 * eps));
  BOOST_TEST(apart.stiff_energy(y) == in_turn.stiff_energy(x));
  for (Eigen::Index j = 0; j < 5; ++j) BOOST_TEST(apart.stiff_energy(y, j) == in_turn.stiff_energy(x, j));
}

BOOST_AUTO_TEST_CASE(the_chain_says_that_its_order_is_another_one) {
  BOOST_TEST(describe(long_fpu_chain(3, 50.0)) == "long_fpu_chain(pairs=3, omega=50)");
  BOOST_TEST(refuses<std::invalid_argument>([] { long_fpu_chain(0, 50.0); }, {"0 pairs"}));
  static_assert(!HasModes<long_fpu_chain>);  // a dense basis
}

// Anything dense would take 8 TB; a state is 16 MB, and a run may hold ten.
BOOST_AUTO_TEST_CASE(a_million_masses_take_memory_in_proportion) {
  const auto bytes_of_run = [](Eigen::Index pairs) {
    const long_fpu_chain chain(pairs, 50.0);
    state x{make_vector<double>(chain), make_vector<double>(chain)};
    x.q.setConstant(0.1);
    x.p.setZero();
    const std::size_t before = allocated_bytes;
    const auto end = integrate(chain, verlet(), 0.01, x, 2);
    BOOST_TEST(!end.diverged_at.has_value());
    BOOST_TEST(chain.frequency_bands().size() == 2U);
    return allocated_bytes - before;
  };
  const double of_a_state = 16.0 * 1e6;
  BOOST_TEST(static_cast<double>(bytes_of_run(500'000)) <= 10.0 * of_a_state);
  BOOST_TEST(static_cast<double>(bytes_of_run(500)) <= 10.0 * of_a_state * 1e-3 + 1e4);
}
