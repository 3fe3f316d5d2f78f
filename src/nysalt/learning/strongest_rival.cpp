// SPDX-License-Identifier: BSL-1.0

#include "strongest_rival.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "describe.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt::detail {

namespace {

double median_of(const std::vector<double>& losses, const shard& share) {
  std::vector<double> all = gathered(losses, share);
  const auto middle = all.begin() + std::ssize(all) / 2;
  std::ranges::nth_element(all, middle);
  return *middle;
}

const std::vector<double>& losses_beside(const contender& chosen, const contender& rival) {
  return rival.losses_beside.empty() ? chosen.losses : rival.losses_beside;
}
double loss_beside(const contender& chosen, const contender& rival) {
  return rival.losses_beside.empty() ? chosen.loss : rival.loss_beside;
}

/// Relative to the chosen one by the same times.
double relative_loss(const contender& chosen, const contender& rival) {
  const double own = loss_beside(chosen, rival);
  if (own > 0.0) return rival.loss / own;
  return rival.loss > 0.0 ? std::numeric_limits<double>::infinity() : 1.0;
}
double relative_median(const contender& chosen, const contender& rival, const shard& share) {
  return median_of(rival.losses, share) / median_of(losses_beside(chosen, rival), share);
}

/// Classical methods at equal cost that the system serves.
std::vector<contender> classical_rivals(const learning_problem& problem, const contender& chosen) {
  const run_time_family& family = problem.family;
  const shard& share = problem.held_out;
  std::vector<contender> result;
  if (family.letters.has_own_letters()) return result;  // what these cost is for their author to declare
  for (const auto& method : classical_methods()) {
    // Rotations are not counted, and are not free: words with them are compared with each other.
    if (method.letters().reads_modes != family.letters.reads_modes) continue;
    if (!method.letters().is_symplectic && family.letters.is_symplectic) continue;
    // Nor do words without a processor pay for looking.
    if (method.letters().evaluations_to_observe > family.letters.evaluations_to_observe) continue;
    const auto known = problem.rival(method);
    if (!known) continue;
    contender one{.name = known->name, .losses = known->held_out_losses};
    one.loss = share.sum(one.losses);
    one.step = known->step;
    if (known->losses_beside) {
      one.losses_beside = known->losses_beside(chosen.theta);
      one.loss_beside = share.sum(one.losses_beside);
    }
    one.objection = [&problem, method = known->method, step = known->judged_step] {
      const judgement found = problem.judged(method, step);
      return found.holds() ? std::string() : found.in_words();
    };
    result.push_back(std::move(one));
  }
  return result;
}

}  // namespace

bool is_better(const contender& a, const contender& b, const shard& share) {
  return is_better(a.losses, b.losses, share);
}

void summarise_rival(const learning_problem& problem, const contender& chosen, std::vector<contender> rivals,
                     fit_summary& summary) {
  const shard& share = problem.held_out;
  for (auto& one : classical_rivals(problem, chosen)) rivals.push_back(std::move(one));
  std::erase_if(rivals, [](const auto& one) { return one.name == "start" || !std::isfinite(one.loss); });
  std::ranges::stable_sort(
      rivals, {}, [&](const contender& one) { return std::pair(relative_loss(chosen, one), one.loss); });
  const contender* failed = nullptr;
  const contender* taken = nullptr;
  std::string why;
  for (const auto& rival : rivals) {
    const bool is_beaten = is_better(losses_beside(chosen, rival), rival.losses, share);
    if (!is_beaten) {
      const std::string objection = rival.objection();
      if (!objection.empty()) {
        if (failed == nullptr && rival.step > 0.0) {
          failed = &rival;
          why = objection;
        }
        continue;
      }
    }
    taken = &rival;
    summary.rival = rival.name;
    summary.rival_step = rival.step;
    summary.rival_loss = rival.loss;
    summary.loss_beside_rival = loss_beside(chosen, rival);
    summary.rival_noise = noise_of_difference(losses_beside(chosen, rival), rival.losses, share);
    summary.gains_nothing = !is_beaten;
    break;
  }
  if (failed == nullptr) return;
  const double best =
      taken != nullptr && summary.gains_nothing ? relative_median(chosen, *taken, share) : 1.0;
  summary.failing_rival = {.name = failed->name,
                           .step = failed->step,
                           .times_less = std::sqrt(best / relative_median(chosen, *failed, share)),
                           .reason = why};
}

}  // namespace nysalt::detail
