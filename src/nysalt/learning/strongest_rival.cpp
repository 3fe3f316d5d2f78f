// SPDX-License-Identifier: BSL-1.0

#include "strongest_rival.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

#include "data_of_problem.hpp"
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

/// Where a word has its letters O; nothing if it has none, or not as placement says.
std::optional<placement> placement_in(const nysalt::word& word) {
  const std::string& letters = word.letters();
  constexpr char o = ornstein_uhlenbeck::letter;
  if (word.stochastic_letters == 2 && letters.front() == o && letters.back() == o)
    return placement::symmetric;
  if (word.stochastic_letters != 1) return std::nullopt;
  return letters.back() == o ? placement::end : placement::middle;
}

/// The method with letters O where the family has its own; nothing where it cannot have them.
std::optional<method> placed(const method& method, const nysalt::word& family) {
  if (family.stochastic_letters == 0) return method;
  const auto place = placement_in(family);
  if (!place || method.letters().is_processed()) return std::nullopt;
  if (*place == placement::middle && method.letters().length % 2 == 0) return std::nullopt;
  return thermostat(method, *place);
}

bool is_served(const nysalt::word& word, const learning_problem& problem) {
  try {
    require_served_with_slopes(word, problem.system, problem.in_lanes());
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

std::vector<double> losses_of(const method& method, const loss_on_data& loss) {
  const family as_family(method.name(), method.letters(), method.coefficients());
  return loss.of_family(as_family)->by_trajectory({});
}

}  // namespace

held_out_by_times::held_out_by_times(const learning_problem& problem)
    : problem_(&problem), known_{{1, problem.over_held_out}} {}

const shared_loss& held_out_by_times::at_every(int times) {
  const auto [found, is_new] = known_.try_emplace(times);
  shared_loss& result = found->second;
  if (!is_new) return result;
  const auto& problem = *problem_;
  const auto longer = in_longer_steps(problem.times, times, shortest_of(problem.held_out));
  if (!longer.steps.empty()) {
    result = problem.made(*problem.chosen.kind, coarser(problem.held_out, times), longer);
  }
  return result;
}

std::optional<contender> rival_of(const learning_problem& problem, held_out_by_times& held_out,
                                  const method& method, const Eigen::VectorXd& theta) {
  if (method.requires_quadratic_kinetic && !has_quadratic_kinetic(problem.system)) return std::nullopt;
  const nysalt::word& family = problem.family.letters;
  const int ours = family.evaluations_per_step;
  const int theirs = method.letters().evaluations_per_step;
  if (ours < 1 || theirs < 1) return std::nullopt;
  // `steps` steps of the family last as long, and cost as much, as `times` of the method.
  const int steps = theirs / std::gcd(ours, theirs);
  const int times = ours / std::gcd(ours, theirs);
  const bool is_in_bath = family.stochastic_letters > 0;
  if (steps > 1 && (is_in_bath || family.is_processed() || family.has_own_letters())) return std::nullopt;
  if ((steps > 1 || times > 1) && method.letters().is_processed()) return std::nullopt;
  const auto stepped = placed(repeated(method, times), family);
  if (!stepped || !is_served(stepped->letters(), problem)) return std::nullopt;
  const shared_loss loss = held_out.at_every(steps);
  if (loss == nullptr) return std::nullopt;
  const shard share = problem.share();
  contender result{.name = method.name(),
                   .losses = losses_of(*stepped, *loss),
                   .method = is_in_bath ? *stepped : method,
                   .step = problem.facts.step * theirs / ours};
  result.loss = share.sum(result.losses);
  result.judged_step = is_in_bath ? problem.facts.step : result.step;
  if (steps > 1) {
    result.losses_beside = losses_of(repeated(problem.member(theta), steps), *loss);
    result.loss_beside = share.sum(result.losses_beside);
  }
  return result;
}

std::vector<contender> classical_rivals(const learning_problem& problem, const Eigen::VectorXd& theta) {
  const nysalt::word& family = problem.family.letters;
  std::vector<contender> result;
  if (family.has_own_letters()) return result;  // what these cost is for their author to declare
  held_out_by_times held_out(problem);
  for (const auto& method : classical_methods()) {
    const nysalt::word& word = method.letters();
    // Rotations are not counted, and are not free: words with them are compared with each other.
    if (word.reads_modes != family.reads_modes) continue;
    if (!word.is_symplectic && family.is_symplectic) continue;
    // Nor do words without a processor pay for looking.
    if (word.evaluations_to_observe > family.evaluations_to_observe) continue;
    if (auto one = rival_of(problem, held_out, method, theta)) result.push_back(*std::move(one));
  }
  return result;
}

void summarise_rival(const contender& chosen, std::vector<contender> rivals, const shard& share,
                     const objection_to& objection, fit_summary& summary) {
  std::erase_if(rivals, [](const auto& one) { return one.name == "start" || !std::isfinite(one.loss); });
  std::ranges::stable_sort(
      rivals, {}, [&](const contender& one) { return std::pair(relative_loss(chosen, one), one.loss); });
  const contender* failed = nullptr;
  const contender* taken = nullptr;
  std::string why;
  for (const auto& rival : rivals) {
    const bool is_beaten = is_better(losses_beside(chosen, rival), rival.losses, share);
    if (!is_beaten) {
      const std::string said = objection(rival);
      if (!said.empty()) {
        if (failed == nullptr && rival.step > 0.0) {
          failed = &rival;
          why = said;
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
