// SPDX-License-Identifier: BSL-1.0
// The search, and the same with a Ceres block for each sample.
#pragma once

#include <boost/test/unit_test.hpp>

#include "../support/one_step.hpp"
#include "../support/rounding.hpp"
#include "../support/sample_blocks.hpp"
#include "nysalt/ensembles/normal_around.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/losses/own_loss.hpp"

namespace nysalt::test {

/// States around rest.
template <System S>
normal_around<S::dimension> around_rest(const S& system) {
  const vector<double, S::dimension> zero = Eigen::VectorXd::Zero(size(system));
  return normal_around<S::dimension>({zero, zero}, 0.4, 0.4);
}

template <Family F, SeparableSystem S>
void compare_searches(const S& system, const auto& starts, const auto& reference, double step,
                      const std::vector<Eigen::Index>& free) {
  const auto data = make_flow_map_data(system, starts, reference,
                                       {.step = step, .horizon = 7.0 * step, .trajectories = 30});
  const metric measure(system, data, coordinates::qp);
  const one_step<F, scalar_of_passes<S>> loss(system, data, measure);
  const sample_blocks<F, S> blocks(system, data, measure);
  const Eigen::VectorXd start = column_of(F::start());
  const auto small = minimise(objective_of(loss), defined_for<F>(), start, free, 200);
  const auto large = minimise_by_blocks(blocks, defined_for<F>(), start, free, 200);
  BOOST_TEST_CONTEXT(describe(system) << ", " << F::name) {
    BOOST_TEST_MESSAGE(describe(system)
                       << ", " << F::name << ": theta off by " << norm(small.theta - large.theta)
                       << ", iterations " << small.iterations << " and " << large.iterations);
    BOOST_TEST(small.converged);
    BOOST_TEST(large.converged);
    BOOST_TEST(std::abs(small.loss - large.loss) <= 1e-10 * large.loss);
    BOOST_TEST(norm(small.theta - large.theta) <= 1e-8);  // what is asked of it
    BOOST_TEST(norm(small.theta - start) > 1e-6);         // which says something
  }
}

}  // namespace nysalt::test
