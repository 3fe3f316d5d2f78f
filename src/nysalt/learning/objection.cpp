// SPDX-License-Identifier: BSL-1.0
// When a fit is not to be trusted, in words.
#include "nysalt/learning/objection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "nysalt/losses/loss_choice.hpp"

namespace nysalt::detail {

double noise_of_difference(const std::vector<double>& a, const std::vector<double>& b, const shard& share) {
  const auto count = static_cast<double>(share.total());
  if (share.total() < 2) return std::numeric_limits<double>::infinity();
  std::vector<double> terms;
  for (std::size_t m = 0; m < a.size(); ++m) terms.push_back(a[m] - b[m]);
  const double mean = share.sum(terms) / count;
  for (double& term : terms) term = (term - mean) * (term - mean);
  return std::sqrt(share.sum(terms) * count / (count - 1.0));
}

std::vector<double> gathered(const std::vector<double>& numbers, const shard& share) {
  std::vector<double> all(static_cast<std::size_t>(share.total()));
  std::ranges::copy(numbers, all.begin() + share.first());
  share.gather(all);
  return all;
}

double signed_rank(const std::vector<double>& a, const std::vector<double>& b, const shard& share) {
  const std::vector<double> of_a = gathered(a, share);
  const std::vector<double> of_b = gathered(b, share);
  std::vector<double> gains;  // ln(b/a)
  for (std::size_t m = 0; m < of_a.size(); ++m) {
    const double gain = std::log(of_b[m] / of_a[m]);
    constexpr double rounding = 1e-9;
    if (std::abs(gain) > rounding) gains.push_back(gain);  // nor NaN, where both are 0
  }
  std::ranges::sort(gains, {}, [](double x) { return std::abs(x); });
  const auto n = static_cast<double>(gains.size());
  if (gains.empty()) return 0.0;
  double sum = 0.0;  // of the ranks where a is better
  double variance = n * (n + 1.0) * (2.0 * n + 1.0) / 24.0;
  for (auto first = gains.begin(); first != gains.end();) {
    const auto last =
        std::find_if(first, gains.end(), [size = std::abs(*first)](double x) { return std::abs(x) != size; });
    const auto ties = static_cast<double>(last - first);
    const double rank = static_cast<double>(first - gains.begin()) + (ties + 1.0) / 2.0;
    sum += rank * static_cast<double>(std::count_if(first, last, [](double x) { return x > 0.0; }));
    variance -= (ties * ties * ties - ties) / 48.0;
    first = last;
  }
  return (sum - n * (n + 1.0) / 4.0) / std::sqrt(variance);
}

bool is_better(const std::vector<double>& a, const std::vector<double>& b, const shard& share) {
  constexpr double of_two = 2.28;  // standard deviations that a normal variable exceeds in 1.1 % of all cases
  const double loss = share.sum(a);
  const double other = share.sum(b);
  if (!(other > 1e-24 && loss < other * (1.0 - 1e-9))) return false;
  return loss < other - of_two * noise_of_difference(a, b, share) || signed_rank(a, b, share) > of_two;
}

std::string objection(const fit_summary& fit, bool settled, const std::string& instability) {
  if (!settled) return instability.empty() ? "the search did not converge" : instability;
  // Sigma is the mean square increment, so to stay where one is has the loss 1 in every coordinate. Proposals
  // need not be near the flow: a step of theirs may turn by more than half a period.
  const auto minimised = find_loss(fit.loss_name);
  const bool is_of_proposals = minimised && minimised->kind->is_of_proposals;
  const double one_step_loss = fit.one_step_error * fit.one_step_error;
  if (!is_of_proposals && !(one_step_loss < static_cast<double>(fit.coordinates_used))) {
    return fmt::format("its held-out one-step loss {:.2e} is no better than that of not moving at all",
                       one_step_loss);
  }
  if (!instability.empty()) return instability;
  if (!fit.is_at_no_bound)
    return "a parameter ran away to the end of its range: the data do not determine it";
  if (!fit.is_of_data) return {};
  // Worse by more than chance: a search may begin so near to the optimum, as for systems that are not stiff,
  // that other data prefer now the one and now the other. Half as much again is more than chance, for any
  // noise that a few trajectories show. Equal to rounding is no objection either.
  const double chance =
      std::min(3.0 * fit.held_out_noise, 0.5 * fit.held_out_start_loss) + 1e-9 * fit.held_out_start_loss;
  // Else the guard has objections to the start, or trajectories from there diverge.
  const bool may_begin_there = !fit.is_held_by_guard && std::isfinite(fit.held_out_start_loss);
  if (may_begin_there &&
      !(fit.held_out_loss <= fit.held_out_start_loss + chance || fit.held_out_loss <= 1e-24)) {
    return "on held-out data it is worse than the parameters that the search began with";
  }
  // A tenth would be too much: what is learned is a small correction, and the reference's error adds to it
  // like a bias, however many the data.
  if (fit.reference_checked && !(fit.reference_error <= 0.01 * fit.one_step_error)) {
    return fmt::format("the reference's own error {:.2e} is not small against the one-step error {:.2e}",
                       fit.reference_error, fit.one_step_error);
  }
  return {};
}

}  // namespace nysalt::detail
