// SPDX-License-Identifier: BSL-1.0
// acceptance, the energy's error at several times of whole trajectories: what Metropolis' rule rejects by.
#include <algorithm>
#include <cmath>
#include <vector>

#include "data_loss.hpp"

namespace nysalt::detail {

/// Lengths of proposals are random: up to the length of the data, each of several counts as much. Of
/// stationary starts so is every state of a trajectory, and proposals begin at four of them where they are
/// short enough.
std::vector<after_steps_options> stages_of_acceptance(int /*K*/, int shortest) {
  constexpr int times = 8;
  std::vector<after_steps_options> result;
  for (const int length : {std::max(1, shortest / 8), shortest}) {
    after_steps_options stage;
    stage.steps.clear();
    for (int k = 1; k <= times; ++k) {
      const int steps = std::max(1, static_cast<int>(std::lround(static_cast<double>(k) * length / times)));
      if (stage.steps.empty() || stage.steps.back() < steps) stage.steps.push_back(steps);
    }
    stage.apart = std::max(1, shortest / 4);
    if (length == shortest) stage.apart = shortest;
    result.push_back(std::move(stage));
  }
  return result;
}

constinit const loss_kind acceptance_loss{.name = "acceptance",
                                          .counts_steps = false,
                                          .is_of_proposals = true,
                                          .is_for_sampling = true,
                                          .stages = stages_of_acceptance,
                                          .over_data = of_energies};

}  // namespace nysalt::detail
