// SPDX-License-Identifier: BSL-1.0
// Kicks of parts add up to the kick of the whole, merge, are counted part by part, and make r-RESPA.
#include "nysalt/flows/kick_of_parts.hpp"

#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "../support/rounding.hpp"
#include "nysalt/derivatives/check_force.hpp"
#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/derivatives/reversibility.hpp"
#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/integrate.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/methods/r_respa.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "nysalt/systems/bonded_chain.hpp"
#include "nysalt/systems/phi4_chain.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

using chain_of_4 = bonded_chain<4>;
const chain_of_4 chain(stiff_bonds<4>(20.0), soft_charges<4>(2.0));
const phase_point<double, 4> start{{0.01, -0.02, 0.0, 0.03}, {0.3, -0.1, 0.2, 0.4}};

/// Velocity Verlet, whose kick is that of all parts.
struct verlet_of_parts {
  using word = nysalt::word<kick_of_parts<0, 1>, drift, kick_of_parts<0, 1>>;
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "verlet_of_parts"; }
  static std::array<double, 5> coefficients() { return {0.5, 0.5, 1.0, 0.5, 0.5}; }
};

template <class M>
phase_point<double, 4> after(const M& method, double step, int steps) {
  return integrate(chain, method, step, start, steps).finish;
}

}  // namespace

BOOST_AUTO_TEST_CASE(parts_are_one_system) {
  vector<double, 4> whole;
  vector<double, 4> first;
  vector<double, 4> second;
  force<double>(chain, start.q, whole);
  force<double>(chain.part<0>(), start.q, first);
  force<double>(chain.part<1>(), start.q, second);
  BOOST_TEST((whole - first - second).cwiseAbs().maxCoeff() <= 4.0 * eps * whole.cwiseAbs().maxCoeff());
  BOOST_TEST(second.cwiseAbs().maxCoeff() > 0.1);  // no part is empty
  BOOST_TEST(chain.potential(start.q) ==
             chain.part<0>().potential(start.q) + chain.part<1>().potential(start.q));
  BOOST_TEST(describe(chain) == "stiff_bonds(4, omega=20) + soft_charges(4, strength=2)");
  static_assert(HasParts<chain_of_4> && !HasParts<phi4_chain<>> && NystromSystem<chain_of_4>);
  using pair = sum_of_parts<phi4_chain<>, phi4_chain<>>;
  BOOST_CHECK_THROW(pair(phi4_chain<>(3), phi4_chain<>(4)), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(forces_of_the_parts_are_gradients) {
  BOOST_TEST(check_force(chain.part<0>(), {start.q, vector<double, 4>(2.0 * start.q)}).passed());
  BOOST_TEST(check_force(chain.part<1>(), {start.q, vector<double, 4>(2.0 * start.q)}).passed());
}

// Two sums of the same numbers in another order differ by some roundings a step, which 50 steps amplify
// tenfold.
BOOST_AUTO_TEST_CASE(kicks_of_all_parts_are_the_kick_of_the_whole) {
  BOOST_TEST(distance(after(verlet_of_parts(), 0.02, 50), after(verlet(), 0.02, 50)) <= 1e4 * eps);
  BOOST_TEST(distance(after(r_respa<0, 1, 1>(), 0.02, 50), after(verlet(), 0.02, 50)) <= 1e4 * eps);
  BOOST_TEST(distance(after(r_respa<0, 1, 2>(), 0.02, 50), after(verlet(), 0.02, 50)) > 1e-5);
}

BOOST_AUTO_TEST_CASE(evaluations_are_counted_part_by_part) {
  using W = r_respa<0, 1, 5>::word;
  static_assert(W::merges && evaluations_of_part<W>(0) == 5 && evaluations_of_part<W>(1) == 1);
  static_assert(evaluations_of_part<W>(2) == 0);
  static_assert(W::evaluations_per_step == 6);
  static_assert(declared_cost<W>(std::array{1.0, 100.0}) == 105.0);
  using learned = nested_kicks<0, 1, 3, 2>::word;
  static_assert(evaluations_of_part<learned>(0) == 6 && evaluations_of_part<learned>(1) == 2);
}

BOOST_AUTO_TEST_CASE(they_are_what_they_state) {
  const std::vector points{start, phase_point<double, 4>{-2.0 * start.q, 0.5 * start.p}};
  BOOST_TEST((check_letter<kick_of_parts<0, 1>>(chain, points, 0.1).passed()));
  BOOST_TEST((check_letter<kick_of_parts<0, 1>>(chain, points, 0.1, {0.3, 0.7}).passed()));
  BOOST_TEST((check_letter<kick_of_part<1>>(chain, points, 0.1).passed()));
}

// J^T Omega J - Omega sums 2 N products of entries up to |J|^2, each off by some hundred roundings.
BOOST_AUTO_TEST_CASE(r_respa_is_symplectic_reversible_and_of_order_two) {
  const r_respa<0, 1, 4> method;
  BOOST_TEST(symplecticity_defect(chain, method, 0.05, start) <= 8.0 * 100.0 * eps * 20.0 * 20.0);
  BOOST_TEST(reversibility_defect(chain, method, 0.05, start) <= 1e3 * eps);
  // Halving the step at a fixed time quarters the error: 3 to 5 leaves room for the next power.
  const auto exact = after(srkn11b(), 0.0005, 1000);
  const double coarse = distance(after(method, 0.01, 50), exact);
  const double fine = distance(after(method, 0.005, 100), exact);
  BOOST_TEST(coarse / fine > 3.0);
  BOOST_TEST(coarse / fine < 5.0);
}

// Where the outer step is half a period of a fast mode the slow kicks resonate with it: the energy grows, and
// does not where the step is a little shorter. The highest mode of four free bonds is omega (2 + sqrt
// 2)^(1/2).
BOOST_AUTO_TEST_CASE(the_outer_step_resonates_with_the_fast_modes) {
  const double omega = 20.0 * std::sqrt(2.0 + std::sqrt(2.0));
  const double half_period = std::acos(-1.0) / omega;
  const auto growth = [&](double step) {
    double worst = 0.0;
    const double before = energy<double>(chain, start);
    const auto watch = [&](std::int64_t, double, const auto& x) {
      worst = std::max(worst, std::abs(energy<double>(chain, x) - before));
    };
    integrate(chain, r_respa<0, 1, 8>(), step, start, 2'000, watch, 10);
    return worst;
  };
  BOOST_TEST(growth(half_period * 0.9) < 0.1);
  double at_resonance = 0.0;
  for (double part = 0.97; part < 1.03; part += 0.002) {
    at_resonance = std::max(at_resonance, growth(part * half_period));
  }
  BOOST_TEST(at_resonance > 1.0);
}

BOOST_AUTO_TEST_CASE(a_family_over_two_forces_is_learned) {
  const normal_around<4> starts({vector<double, 4>::Zero(), vector<double, 4>::Zero()}, 0.01, 0.3);
  const auto data = [&](std::uint64_t seed) {
    return make_flow_map_data(chain, starts, fine_steps<>(0.0025),
                              {.step = 0.06, .horizon = 0.6, .trajectories = 16, .seed = seed});
  };
  const auto found =
      learn(nested_kicks<0, 1, 4>(), chain, data(1), data(2), {.random_starts = 4, .planned_steps = 1000});
  BOOST_TEST(found.summary.usable, found.summary.reason);
  BOOST_TEST(found.summary.held_out_loss < 0.25 * found.summary.held_out_start_loss);  // half the error
  using family = nested_kicks<0, 1, 4>;
  const auto first = family::coefficients(family::start());
  BOOST_TEST(first == (r_respa<0, 1, 4>::coefficients()));
}
