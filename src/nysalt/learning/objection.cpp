// SPDX-License-Identifier: BSL-1.0
// When a fit is not to be trusted, in words.
#include "nysalt/learning/objection.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
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
