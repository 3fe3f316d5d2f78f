// SPDX-License-Identifier: BSL-1.0
// state:K, the state's error after K steps.
#include "data_loss.hpp"
#include "nysalt/losses/state_error.hpp"

namespace nysalt::detail {

data_loss of_states(const loss_inputs& from) {
  return from.in_lanes ? after_steps_of(from, state_error<lanes>(*from.measure))
                       : after_steps_of(from, state_error<double>(*from.measure));
}

constinit const loss_kind state_loss{
    .name = "state", .judge = judge_of_minima::held_out_end, .over_data = of_states};

}  // namespace nysalt::detail
