// SPDX-License-Identifier: BSL-1.0
// A search over 10^5 samples: compressed to one small block, against a Ceres block for each sample.
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <memory>
#include <stdexcept>
#include <vector>

#include "../tests/support/one_step.hpp"
#include "../tests/support/sample_blocks.hpp"
#include "nysalt/ensembles/fpu_law.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/references/fine_steps.hpp"
#include "races.hpp"

namespace nysalt::bench {

namespace {

using chain_type = fpu_chain<3>;
constexpr std::int64_t pairs_each = 100;
constexpr std::int64_t trajectories = 1000;

/// All that both searches share; it stays where it is, as the losses refer to it.
class problem {
 public:
  problem()
      : data_(make_flow_map_data(chain_, fpu_law<3>(chain_), fine_steps<>(1e-3),
                                 {.step = 0.01, .horizon = 0.01 * pairs_each, .trajectories = trajectories})),
        measure_(chain_, data_, coordinates::qp) {}

  minimum compressed() const {
    const test::one_step<nystrom> loss(chain_, data_, measure_);
    return minimise(objective_of(loss), test::defined_for<nystrom>(), start_, {0, 1}, iterations_);
  }
  minimum block_per_sample() const {
    const test::sample_blocks<nystrom, chain_type> blocks(chain_, data_, measure_);
    return test::minimise_by_blocks(blocks, test::defined_for<nystrom>(), start_, {0, 1}, iterations_);
  }
  double samples() const { return static_cast<double>(data_.pairs()); }

 private:
  static constexpr int iterations_ = 200;
  chain_type chain_{50.0};
  flow_map_data data_;
  metric measure_;
  Eigen::VectorXd start_ = column_of(nystrom::start());
};

/// What is asked of the learner: the loss equal to 1e-10, theta to 1e-8.
void require_same_minimum(const minimum& ours, const minimum& theirs) {
  const double loss = std::abs(ours.loss - theirs.loss) / theirs.loss;
  const double theta = (ours.theta - theirs.theta).norm();
  std::printf("learning: losses differ by %.1e, theta by %.1e\n", loss, theta);
  if (ours.converged && theirs.converged && loss <= 1e-10 && theta <= 1e-8) return;
  throw std::runtime_error(fmt::format(
      "the searches end at different minima: the losses differ by {:.1e}, theta by {:.1e}", loss, theta));
}

}  // namespace

void race_learning() {
  const auto shared = std::make_shared<problem>();
  require_same_minimum(shared->compressed(), shared->block_per_sample());
  std::vector<runner> runners;
  runners.push_back({"compressed", shared->samples(), [shared] { shared->compressed(); }});
  runners.push_back({"block per sample", shared->samples(), [shared] { shared->block_per_sample(); }});
  race("learning", std::move(runners), {.turn_seconds = 0.0, .repetitions = 3});
}

}  // namespace nysalt::bench
