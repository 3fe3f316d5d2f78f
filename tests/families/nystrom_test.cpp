// SPDX-License-Identifier: BSL-1.0
// The family is the paper's: its word of letters is the tableau, and its members are who they are said to be.
#include <boost/test/unit_test.hpp>

#include "../laws/models.hpp"
#include "../support/refusal.hpp"
#include "../support/rounding.hpp"
#include "../support/tableau.hpp"
#include "nysalt/derivatives/jacobian.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

/// Fixed and dynamic, and a black box.
using unit_mass_systems = std::tuple<a_galaxy, a_dynamic_fpu, a_black_box>;

/// Both forms take some 12 operations per coordinate, on terms no larger than the magnified state.
template <class Model>
double against_tableau(const member<nystrom>& method, const tableau& oracle, draws& random) {
  const auto system = Model::make();
  const auto x = random.state(system, Model::reach);
  const auto at = shears_at(system, x);
  const double h = 0.5 / at.frequency();
  auto ours = x;
  auto theirs = x;
  step_map(system, method, h)(ours);
  oracle.step(system, theirs, h);
  return distance(ours, theirs) / (12.0 * eps * size_of(x) * transient_growth(method, h, at));
}

}  // namespace

BOOST_AUTO_TEST_CASE_TEMPLATE(the_word_is_the_tableau, Model, unit_mass_systems) {
  draws random;
  for (int n = 0; n < 20; ++n) {
    const auto [b1, beta1] = random_theta<nystrom>(random);
    BOOST_TEST_CONTEXT("seed " << draws::seed << ", b1 = " << b1 << ", beta1 = " << beta1) {
      auto oracle = tableau::symplectic(b1, beta1);
      const member<nystrom> method({b1, beta1});
      BOOST_TEST(against_tableau<Model>(method, oracle, random) <= 1.0);
      oracle.beta2 = 1.0 - beta1 - 0.5 * b1;  // not a slip of the paper, but one as good
      BOOST_TEST(against_tableau<Model>(method, oracle, random) > 1e3);
    }
  }
}

BOOST_AUTO_TEST_CASE(verlet_and_mclachlan_are_members) {
  const pendulum system;
  draws random;
  const auto x = random.state(system, 1.0);
  const auto after = [&](const auto& method) {
    auto y = x;
    step_map(system, method, 0.3)(y);
    return y;
  };
  const auto member_at = [](double b1, double beta1) { return member<nystrom>({b1, beta1}); };
  // Ten operations on numbers of size 1.
  BOOST_TEST(distance(after(member_at(0.5, 0.5)), after(verlet())) <= 10.0 * eps);
  BOOST_TEST(distance(after(member_at(2.0 / 3.0, 1.0 / 3.0)), after(verlet_aba())) <= 10.0 * eps);
  BOOST_TEST(distance(after(member<nystrom>(nystrom::start())), after(mclachlan2())) <= 10.0 * eps);
  BOOST_TEST(distance(after(member_at(0.5, 0.4)), after(mclachlan2())) > 1e-6);
  auto halves = x;  // (1/2, 3/8): two half steps of drift-kick-drift
  step_map(system, verlet_aba(), 0.15)(halves);
  step_map(system, verlet_aba(), 0.15)(halves);
  BOOST_TEST(distance(after(member_at(0.5, 0.375)), halves) <= 20.0 * eps);
}

BOOST_AUTO_TEST_CASE(out_of_range_is_said_with_the_parameters_name) {
  const double not_a_number = std::numeric_limits<double>::quiet_NaN();
  const auto refused = [](double b1, double beta1, auto... words) {
    return refuses<std::invalid_argument>([&] { member<nystrom>({b1, beta1}); }, {"nystrom", words...});
  };
  BOOST_TEST(refused(0.0, 0.4, "b1", "(0, 1)", "got 0"));
  BOOST_TEST(refused(1.0, 0.4, "b1", "(0, 1)", "got 1"));
  BOOST_TEST(refused(-0.5, 0.4, "b1", "got -0.5"));
  BOOST_TEST(refused(not_a_number, 0.4, "b1", "nan"));
  BOOST_TEST(refused(0.5, -1e-9, "beta1", "[0, 0.5]", "got -1e-09"));
  BOOST_TEST(refused(0.5, 0.51, "beta1", "[0, 0.5]"));
  BOOST_TEST(refused(0.5, not_a_number, "beta1", "nan"));
  for (const double end : {0.0, 0.5}) {  // the ends of beta1 may be attained
    for (const double c : member<nystrom>({0.5, end}).coefficients()) BOOST_TEST(std::isfinite(c));
  }
}
