// SPDX-License-Identifier: BSL-1.0
#include "strongest_rival.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "nysalt/learning/objection.hpp"
#include "nysalt/methods/classical_methods.hpp"

namespace nysalt::detail {

bool is_better(const contender& a, const contender& b, const shard& share) {
  const double noise = noise_of_difference(a.losses, b.losses, share);
  return b.loss > 1e-24 && a.loss < b.loss - 2.0 * noise && a.loss < b.loss * (1.0 - 1e-9);
}

void summarise_rival(const learning_problem& problem, const contender& chosen, std::vector<contender> rivals,
                     fit_summary& summary) {
  const run_time_family& family = problem.family;
  const shard& share = problem.held_out;
  std::vector<std::optional<rival_method>> methods;
  for (const auto& method : classical_methods_of_cost(family.letters.evaluations_per_step)) {
    // Rotations are not counted, and are not free: words with them are compared with each other.
    if (has_rotation(method.letters()) != has_rotation(family.letters)) continue;
    if (family.letters.has_own_letters()) continue;  // what these cost is for their author to declare
    if (!method.letters().is_symplectic && family.letters.is_symplectic) continue;
    // Nor do words without a processor pay for looking.
    if (method.letters().evaluations_to_observe > family.letters.evaluations_to_observe) continue;
    methods.push_back(problem.rival(method));
    const auto& known = methods.back();
    if (!known) continue;
    contender one{known->name, known->held_out_losses};
    one.loss = share.sum(one.losses);
    one.withstands = [&problem, method = known->method] { return problem.judged(method).holds(); };
    rivals.push_back(std::move(one));
  }
  std::erase_if(rivals, [](const auto& one) { return !std::isfinite(one.loss); });
  std::ranges::stable_sort(rivals, {}, &contender::loss);
  for (const auto& rival : rivals) {
    if (rival.name == "start") continue;
    const bool is_beaten = is_better(chosen, rival, share);
    if (!is_beaten && !rival.withstands()) continue;
    summary.rival = rival.name;
    summary.rival_loss = rival.loss;
    summary.rival_noise = noise_of_difference(chosen.losses, rival.losses, share);
    summary.gains_nothing = !is_beaten;
    break;
  }
}

}  // namespace nysalt::detail
