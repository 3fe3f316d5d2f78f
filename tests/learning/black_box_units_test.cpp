// SPDX-License-Identifier: BSL-1.0
// What is learned of a black box is the same in all units, and what is learned with exact derivatives.
#include <boost/test/unit_test.hpp>

#include "../support/black_box_in_units.hpp"
#include "../support/refusal.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/fg_chin.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"

using namespace nysalt;
using namespace nysalt::test;

namespace {

template <Family F, class S>
Eigen::VectorXd learned_for(const units& scales, double factor = 1.0) {
  S system;
  system.scales = scales;
  S wrong = system;
  wrong.first_factor = factor;
  const double h = 0.6 * scales.time;
  const starts_in_units<2> starts(system);
  const auto data = [&](std::uint64_t seed) {
    const data_options options{.step = h, .horizon = 10.0 * h, .trajectories = 20, .seed = seed};
    return make_flow_map_data(system, starts, fine_steps<>(h / 64.0), options);
  };
  const auto [method, fit] = learn(F{}, wrong, data(1), data(2), {.guarded = false});  // the optimum itself
  Eigen::VectorXd theta(std::ssize(fit.parameters));
  for (Eigen::Index k = 0; k < theta.size(); ++k) {
    theta[k] = fit.parameters[static_cast<std::size_t>(k)].value;
  }
  return theta;
}

/// Derivatives are off by 1e-8 of themselves, and theta by that times the root of the Hessian's condition,
/// which is below 100.
template <Family F>
void check(const std::vector<units>& all) {
  const Eigen::VectorXd expected = learned_for<F, open_wells<2>>(units());
  for (const units& scales : all) {
    BOOST_TEST_CONTEXT(F::name << ", length " << scales.length << ", mixed " << scales.mixed << ", time "
                               << scales.time << ", offset " << scales.offset) {
      const Eigen::VectorXd found = learned_for<F, boxed_wells<2>>(scales);
      BOOST_TEST((found - expected).cwiseAbs().maxCoeff() < 1e-6);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(theta_is_the_same_in_all_units) {
  const std::vector<units> all{{.length = 1e-10},
                               {.length = 1.0},
                               {.length = 1e10},
                               {.length = 1e-10, .time = 1e-15, .mass = 1e-26, .offset = 20.0},
                               {.length = 1e-6, .mixed = 1e12}};
  check<aba<4>>(all);
  check<fg_chin>(all);
}

BOOST_AUTO_TEST_CASE(a_wrong_force_is_refused_in_all_units) {
  for (const double length : {1e-10, 1.0, 1e10}) {
    for (const double factor : {-1.0, 1.001}) {
      BOOST_TEST(refuses<std::invalid_argument>(
          [&] { learned_for<fg_chin, boxed_wells<2>>({.length = length}, factor); }, {"not -grad V"}));
    }
  }
}
