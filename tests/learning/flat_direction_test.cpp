// SPDX-License-Identifier: BSL-1.0
// Where the loss does not change along some direction, what changes it is learned all the same.
#include <Eigen/Core>

#include "../support/dense.hpp"
#include "../support/families.hpp"
#include "compare_searches.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

using namespace nysalt;
using namespace nysalt::test;

// On one oscillator aba4 has a direction too many. The search goes as far as the others matter.
BOOST_AUTO_TEST_CASE(a_flat_direction_is_reported_and_the_rest_is_learned) {
  const harmonic_oscillator oscillator(2.0);
  const auto data = make_flow_map_data(oscillator, around_rest(oscillator), exact_linear(oscillator),
                                       {.step = 0.5, .horizon = 2.0, .trajectories = 20});
  const metric measure(oscillator, data, coordinates::qp);
  const one_step<aba4> loss(oscillator, data, measure);
  const sample_blocks<aba4, harmonic_oscillator> blocks(oscillator, data, measure);
  const auto fit = learn(aba4{}, oscillator, data, data);
  BOOST_TEST_CONTEXT(fit.summary.full()) {
    BOOST_TEST(fit.summary.usable);
    BOOST_REQUIRE(fit.summary.flat_directions.size() == 1);
    const Eigen::VectorXd flat = Eigen::Map<const Eigen::Vector3d>(fit.summary.flat_directions[0].data());
    const auto at_end = squares_at(loss, fit.method.parameters());
    const symmetric_eigen of_loss(at_end.normal_matrix);
    // Residuals vanish at the minimum, so the normal matrix is half the Hessian: the same direction is flat.
    BOOST_TEST(std::abs(of_loss.vectors.col(0).dot(flat)) >= 1.0 - 1e-6);
    BOOST_TEST(of_loss.values[0] <= 1e-8 * of_loss.values[2]);
    BOOST_TEST(of_loss.values[1] > 1e-8 * of_loss.values[2]);
    const auto large =
        minimise_by_blocks(blocks, defined_for<aba4>(), column_of(aba4::start()), {0, 1, 2}, 200);
    BOOST_TEST_MESSAGE("eigenvalues " << of_loss.values.transpose() << ", loss " << fit.summary.loss
                                      << " and " << large.loss);
    BOOST_TEST(large.loss <= 1e-24);
    BOOST_TEST(fit.summary.loss <= 1e-24);
  }
}
