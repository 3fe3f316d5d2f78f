// SPDX-License-Identifier: BSL-1.0
// The loop allocates nothing, however many steps it takes.
#include <boost/test/unit_test.hpp>

#include "nysalt/ensembles/lennard_jones_liquid_law.hpp"
#include "nysalt/families/fg4.hpp"
#include "nysalt/families/fg_chin.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/r_aba.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/model.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"
#include "support/allocations.hpp"

namespace {

using namespace nysalt;
using nysalt::test::allocations;

template <class Stepper>
std::size_t allocations_of(const Stepper& stepper, std::int64_t steps) {
  const auto& chain = stepper.system();
  using S = std::decay_t<decltype(chain)>;
  phase_point<double, S::dimension> start{make_vector<double>(chain), make_vector<double>(chain)};
  start.q.setConstant(0.7);
  start.p.setConstant(0.1);
  auto run = stepper.open(start);
  const std::size_t before = allocations;
  stepper.advance(run, steps);
  return allocations - before;
}

template <System S, Method M, NoiseSource Noise = no_noise>
std::size_t allocations_of(const S& chain, const M& method, std::int64_t steps, const Noise& noise = {}) {
  return allocations_of(make_stepper(chain, method, 1e-3, noise), steps);
}

/// By a family's word as a type, and as data.
template <Family F, System S>
std::array<std::size_t, 2> allocations_of_family(const S& chain, std::int64_t steps) {
  const auto c = F::coefficients(F::start());
  const nysalt::stepper<S, typename F::word> by_type(chain, c, 1e-3);
  const nysalt::stepper by_data(chain, run_time_word(typename F::word()), {c.begin(), c.end()}, 1e-3);
  return {allocations_of(by_type, steps), allocations_of(by_data, steps)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_loop_allocates_nothing) {
  const member<nystrom> two_stage({0.5, 0.4});
  BOOST_TEST(allocations_of(fpu_chain<3>(50.0), verlet{}, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<3>(50.0), two_stage, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<>(3, 50.0), verlet{}, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<>(3, 50.0), two_stage, 1000) == 0U);
  BOOST_TEST(allocations_of(fpu_chain<>(70, 50.0), tabulated(two_stage), 1000) == 0U);
}

// Tiles have a few buffers, whatever the number of steps.
BOOST_AUTO_TEST_CASE(steps_in_tiles_allocate_nothing_either) {
  for (const Eigen::Index pairs : {70, 3000}) {
    const model chain(fpu_chain<>(pairs, 50.0));
    const auto of_few = allocations_of(chain, tabulated(verlet{}), 5000);
    BOOST_TEST(of_few < 40U);
    BOOST_TEST(allocations_of(chain, tabulated(verlet{}), 10000) == of_few);
  }
}

// Letters that need more than the state have four vectors of a dynamic size, whatever the number of steps.
BOOST_AUTO_TEST_CASE(gradient_kicks_and_rotations_allocate_nothing_either) {
  using counts = std::array<std::size_t, 2>;
  const fpu_chain<3> fixed(50.0);
  const fpu_chain<> dynamic(3, 50.0);
  const fpu_chain<> long_one(70, 50.0);
  const auto linear = linear_chain::between_walls(6, 4.0);
  const with_quadratic_part split(dynamic, Eigen::MatrixXd::Identity(6, 6));
  const with_quadratic_part fixed_split(fixed, Eigen::MatrixXd::Identity(6, 6));
  BOOST_TEST((allocations_of_family<fg4>(fixed, 1000) == counts{0, 0}));
  BOOST_TEST((allocations_of_family<fg4>(dynamic, 1000) == counts{4, 4}));
  BOOST_TEST((allocations_of_family<fg_chin>(long_one, 1000) == counts{4, 4}));
  BOOST_TEST((allocations_of_family<r_fg4>(fixed_split, 1000) == counts{0, 0}));
  BOOST_TEST((allocations_of_family<nystrom>(dynamic, 1000) == counts{0, 0}));  // no letter needs them
  // A word as a type is copied into the loop, with three vectors for each rotation and each seam.
  BOOST_TEST((allocations_of_family<r_aba<4>>(linear, 1000) == counts{4 + 3 * (5 + 2), 4}));
  BOOST_TEST((allocations_of_family<r_aba<4>>(split, 1000) == counts{4 + 3 * (5 + 2), 4}));
  BOOST_TEST((allocations_of_family<r_fg4>(split, 1000) == counts{4 + 3 * (4 + 2), 4}));
  BOOST_TEST((allocations_of_family<r_fg4>(split, 1) == counts{4 + 3 * (4 + 2), 4}));
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

// But where a list is made: not at rest, and once in a while in motion.
BOOST_AUTO_TEST_CASE(a_liquid_allocates_where_its_list_is_made) {
  const auto allocations_at = [](double temperature, std::int64_t steps) {
    const lennard_jones_liquid liquid(256, 0.8442);
    const auto stepper = make_stepper(liquid, verlet{}, 0.004);
    auto run = stepper.open(lennard_jones_liquid_law(liquid, temperature)(1, 0));
    stepper.advance(run, 1);
    const std::size_t before = allocations;
    const std::int64_t made = liquid.lists_made();
    stepper.advance(run, steps);
    return std::pair(allocations - before, liquid.lists_made() - made);
  };
  BOOST_TEST((allocations_at(0.0, 200) == std::pair<std::size_t, std::int64_t>(0, 0)));
  BOOST_TEST(allocations_at(3.0, 200).second > 0);
}

BOOST_AUTO_TEST_CASE(the_count_would_see_an_allocation) {
  const std::size_t before = allocations;
  const Eigen::VectorXd something(8);
  BOOST_TEST(allocations - before == 1U);
  BOOST_TEST(something.size() == 8);
}
