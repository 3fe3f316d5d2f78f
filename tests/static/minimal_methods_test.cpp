// SPDX-License-Identifier: BSL-1.0
// The least flow, word, family and method: what docs/concepts shows, and that they do their work.
#include <boost/test/unit_test.hpp>

#include <array>
#include <string>
#include <string_view>

#include "nysalt/derivatives/symplecticity.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/integrate.hpp"
#include "quartic_well.hpp"

using namespace nysalt::test;

namespace {

constexpr double eps = 0x1p-52;

// [flow]
/// The flow of -sum q_i: a uniform field pulls every coordinate, p_i += c h.
struct pull {
  static constexpr char letter = 'U';
  static constexpr std::size_t slots = 1;
  static constexpr nysalt::field reads = nysalt::field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = false;
  static constexpr bool additive = true;

  template <nysalt::System S, nysalt::Scalar T>
  static constexpr bool serves = true;

  template <nysalt::Scalar C>
  static C prepare(const C& c, double h) {
    return c * h;
  }
  template <nysalt::System S, nysalt::Scalar T, nysalt::CoefficientOf<T> C>
  static void apply(const S&, const C& c, nysalt::flow_state<T, S::dimension>& x, auto&) {
    for (Eigen::Index i = 0; i < x.size(); ++i) x.p[i] += c;
  }
};
static_assert(nysalt::Flow<pull>);
// [/flow]
struct never_applied : pull {
  static void apply(auto&&...) = delete;
};
static_assert(!nysalt::Flow<never_applied>);

// [word]
using five_letters = nysalt::word<nysalt::drift, nysalt::kick, nysalt::drift, nysalt::kick, nysalt::drift>;
static_assert(nysalt::Word<five_letters>);
static_assert(five_letters::merges);                     // the last A of a step and the first of the next
static_assert(five_letters::evaluations_per_step == 2);  // however many steps
static_assert(five_letters::evaluations_to_open == 0);
// [/word]

// [family]
/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a)
struct equal_kicks : nysalt::composition<1> {
  using word = five_letters;
  static constexpr std::string_view name = "equal_kicks";
  static std::array<double, 1> start() { return {0.25}; }

  template <nysalt::Scalar C>
  static std::array<C, 5> coefficients(const std::array<C, 1>& theta) {
    const C& a = theta[0];
    return {a, C(0.5), C(1.0) - a * 2.0, C(0.5), a};
  }
};
static_assert(nysalt::Family<equal_kicks>);
// [/family]

// [method]
struct symplectic_euler {
  using word = nysalt::word<nysalt::kick, nysalt::drift>;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;
  static std::string name() { return "symplectic_euler"; }
  static std::array<double, 2> coefficients() { return {1.0, 1.0}; }
};
static_assert(nysalt::Method<symplectic_euler>);
// [/method]

}  // namespace

BOOST_AUTO_TEST_CASE(a_letter_of_ones_own_goes_through_the_same_loop) {
  // U(1/2) A U(1/2) is exact in a uniform field: q = t^2/2, p = t.
  const nysalt::detail::free_particle system;
  using fall = nysalt::word<pull, nysalt::drift, pull>;
  const nysalt::stepper<nysalt::detail::free_particle, fall> stepper(system, {0.5, 1.0, 0.5}, 0.125);
  auto run = stepper.open(at(0.0, 0.0));
  stepper.advance(run, 16);
  const auto x = stepper.synchronous(run);
  BOOST_TEST(x.q[0] == 2.0);  // a step of 1/8 makes every number exact
  BOOST_TEST(x.p[0] == 2.0);
}

BOOST_AUTO_TEST_CASE(families_and_methods_of_ones_own_are_symplectic) {
  const quartic_well system;
  const auto x = at(0.7, 0.3);
  // Seven roundings of entries below 2.
  BOOST_TEST(nysalt::symplecticity_defect(system, symplectic_euler(), 0.1, x) <= 64 * eps);
  const nysalt::member<equal_kicks> some({0.2});
  BOOST_TEST(nysalt::symplecticity_defect(system, some, 0.1, x) <= 64 * eps);
  auto euler = at(1.0, 0.0);
  nysalt::make_stepper(system, symplectic_euler(), 0.5).step(euler);
  BOOST_TEST(euler.q[0] == 0.75);
  BOOST_TEST(euler.p[0] == -0.5);
}
