// SPDX-License-Identifier: BSL-1.0
// The loop allocates nothing, however many steps it takes, alone and in lanes.
#include "../laws/compiled_specimens.hpp"
#include "../support/allocations.hpp"
#include "nysalt/core.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/ensembles/lennard_jones_liquid_law.hpp"

using namespace nysalt;
using nysalt::test::allocations;

namespace {

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

/// By the word of a family as a type, and as data.
template <Family F, System S>
std::array<std::size_t, 2> allocations_of_family(const S& chain, std::int64_t steps) {
  const member<F> method(F::start());
  return {allocations_of(chain, method, steps), allocations_of(chain, tabulated(method), steps)};
}

const fpu_chain<3> fixed(50.0);
const fpu_chain<> dynamic(3, 50.0);

}  // namespace

BOOST_AUTO_TEST_CASE(the_count_sees_an_allocation) {
  const std::size_t before = allocations;
  const Eigen::VectorXd something(8);
  BOOST_TEST(allocations - before == 1U);
  BOOST_TEST(something.size() == 8);
}

// Letters that need more than the state have four vectors of a dynamic size; a word as a type is copied into
// the loop, with three vectors for each rotation and each seam.
BOOST_AUTO_TEST_CASE(the_loop_allocates_nothing) {
  using counts = std::array<std::size_t, 2>;
  const auto linear = linear_chain::between_walls(6, 4.0);
  BOOST_TEST((allocations_of_family<nystrom>(dynamic, 1000) == counts{0, 0}));
  BOOST_TEST((allocations_of_family<fg4>(fixed, 1000) == counts{0, 0}));
  BOOST_TEST((allocations_of_family<fg4>(dynamic, 1000) == counts{4, 4}));
  BOOST_TEST((allocations_of_family<r_aba<4>>(linear, 1000) == counts{4 + 3 * (5 + 2), 4}));
  BOOST_TEST((allocations_of_family<r_aba<4>>(linear, 1) == counts{4 + 3 * (5 + 2), 4}));
  for (const Eigen::Index pairs : {70, 600}) {  // tiles have a few buffers
    const model chain(fpu_chain<>(pairs, 50.0));
    const auto of_few = allocations_of(chain, tabulated(verlet{}), 5000);
    BOOST_TEST(of_few < 40U);
    BOOST_TEST(allocations_of(chain, tabulated(verlet{}), 10000) == of_few);
  }
}

// Of a dynamic size the noise has one vector.
BOOST_AUTO_TEST_CASE(the_noisy_loop_allocates_nothing) {
  const in_bath warm(fixed, bath::of_sigma(0.1, 0.05));
  const in_bath warm_and_dynamic(dynamic, bath::of_sigma(0.1, 0.05));
  const in_bath cold(fixed, bath::of_sigma(0.1, 0.0));
  const counter_noise noise(1);
  BOOST_TEST(allocations_of(warm, tabulated(obabo{}), 1000, noise) == 0U);
  BOOST_TEST(allocations_of(cold, tabulated(obabo{}), 1000) == 0U);
  BOOST_TEST(allocations_of(warm_and_dynamic, baoab(), 1000, noise) == 1U);
  BOOST_TEST(allocations_of(warm_and_dynamic, tabulated(obabo{}), 2, noise) ==
             allocations_of(warm_and_dynamic, tabulated(obabo{}), 1000, noise));
}

// A thousand steps, watched at each: what is allocated is allocated before.
BOOST_AUTO_TEST_CASE(the_loop_in_lanes_allocates_nothing) {
  using T = pack<double, 8>;
  const auto stepper = make_stepper(fixed, verlet(), .01);
  const auto start = sound_starts<T>(fixed, fpu_law<3>(fixed), 1, 0, 8);
  lockstep<decltype(stepper), T> all(stepper, start, 8);
  T sum(0.0);
  const auto read = [&](const auto& x, std::span<T> numbers) { numbers[0] = fixed.stiff_energy(x); };
  const auto add = [&](std::int64_t, std::span<const T> numbers, const auto&) { sum += numbers[0]; };
  all.go_on(64, 1, 1, read, add);  // finds its room
  const auto before = allocations;
  all.go_on(1064, 1, 1, read, add);
  BOOST_TEST(allocations == before);
  BOOST_TEST(sum[7] > 0.0);
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
  BOOST_TEST((allocations_at(0.0, 100) == std::pair<std::size_t, std::int64_t>(0, 0)));
  BOOST_TEST(allocations_at(3.0, 100).second > 0);
}
