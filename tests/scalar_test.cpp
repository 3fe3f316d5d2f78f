// SPDX-License-Identifier: BSL-1.0
// Ceres' Jets are scalars like any other: a step over them is a step over dual numbers.
#include <boost/test/unit_test.hpp>

#include <ceres/jet.h>

#include "laws/models.hpp"
#include "nysalt/scalars/series.hpp"
#include "nysalt/stepper.hpp"
#include "support/rounding.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {
using jet = ceres::Jet<double, 2>;
using pair = dual<double, 2>;
}  // namespace

static_assert(Scalar<jet> && Scalar<pair> && Scalar<series<3>> && Scalar<double>);
static_assert(CoefficientOf<jet, jet> && CoefficientOf<double, jet>);
static_assert(!CoefficientOf<jet, pair> && !CoefficientOf<pair, jet> && !CoefficientOf<jet, double>);

// A black box has no derivatives to give to a Jet.
using systems_of_jets = std::tuple<a_free_chain, an_fpu_chain, a_pendulum, a_galaxy, a_fast_one>;

// By theta: coefficients and states over Jets.
BOOST_AUTO_TEST_CASE_TEMPLATE(derivatives_by_theta_are_the_same_over_jets, Model, systems_of_jets) {
  draws random;
  const auto system = Model::make();
  using S = system_of<Model>;
  const auto [b1, beta1] = random_theta<nystrom>(random);
  const auto x = random.state(system, Model::reach);
  const auto at = shears_at(system, x);
  const double h = 0.25 / at.frequency();

  const std::array by_dual{pair::variable(b1, 0), pair::variable(beta1, 1)};
  const std::array by_jet{jet(b1, 0), jet(beta1, 1)};
  const stepper<S, nystrom::word, pair> with_dual(system, nystrom::coefficients(by_dual), h);
  const stepper<S, nystrom::word, jet> with_jet(system, nystrom::coefficients(by_jet), h);
  auto a = x.template cast<pair>();
  auto b = x.template cast<jet>();
  with_dual.step(a);
  with_jet.step(b);

  // Some 20 operations a letter, and dc/dtheta is up to 1/b1^2 times the step's own size.
  const double magnified = transient_growth(member<nystrom>({b1, beta1}), h, at);
  const double rounding = 20.0 * 5.0 * eps * size_of(x) * magnified * at.potential / (b1 * b1);
  BOOST_TEST_CONTEXT("seed " << draws::seed << ", " << describe(system)) {
    double moved = 0.0;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      BOOST_TEST(std::abs(a.q[i].value - b.q[i].a) <= rounding);
      for (int k = 0; k < 2; ++k) {
        BOOST_TEST(std::abs(a.q[i].derivative[static_cast<std::size_t>(k)] - b.q[i].v[k]) <= rounding);
        BOOST_TEST(std::abs(a.p[i].derivative[static_cast<std::size_t>(k)] - b.p[i].v[k]) <= rounding);
        moved = std::max(moved, std::abs(b.p[i].v[k]));
      }
    }
    BOOST_TEST(moved > 1e3 * rounding);  // there is something to compare
  }
}

// By the start, with plain coefficients; also where the force comes from the potential, a dual of a Jet.
BOOST_AUTO_TEST_CASE(derivatives_by_the_start_are_the_same_over_jets) {
  const potential_only system;
  const stepper<potential_only, verlet::word> fixed(system, verlet::coefficients(), 0.2);
  phase_point<pair, 2> a{{pair::variable(0.3, 0), pair::variable(-0.5, 1)}, {pair(0.1), pair(0.2)}};
  phase_point<jet, 2> b{{jet(0.3, 0), jet(-0.5, 1)}, {jet(0.1), jet(0.2)}};
  fixed.step(a);
  fixed.step(b);
  for (int i = 0; i < 2; ++i) {
    for (int k = 0; k < 2; ++k) {  // some 60 operations on numbers below 1
      BOOST_TEST(std::abs(a.p[i].derivative[static_cast<std::size_t>(k)] - b.p[i].v[k]) <= 60.0 * eps);
    }
  }
}
