// SPDX-License-Identifier: BSL-1.0

#include "losses_of_problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "data_of_problem.hpp"
#include "nysalt/methods/phase_fitted.hpp"

namespace nysalt::detail {

namespace {

/// Whether the errors at these times are below a twentieth of the motion, in the mean over coordinates: each
/// over its own motion, as a fast one of small amplitude is not followed where only slow ones are; in the
/// energy norm all over that of all.
std::function<bool(const Eigen::VectorXd&)> follows_over(const source_of_losses& from, const data_loss& loss,
                                                         const after_steps_options& times) {
  Eigen::VectorXd motion = motion_in(from.data, *from.measure, times);
  if (from.which == coordinates::energy) motion.setConstant(motion.mean());
  return [by_residual = loss.by_residual, motion](const Eigen::VectorXd& theta) {
    constexpr double lost = 0.05 * 0.05;
    const Eigen::VectorXd squares = by_residual(theta);  // those of a time after those of another
    double relative = 0.0;
    for (Eigen::Index k = 0; k < squares.size(); ++k) relative += squares[k] / motion[k % motion.size()];
    return relative <= lost * static_cast<double>(motion.size());
  };
}

}  // namespace

loss_by_times losses_by_times(const source_of_losses& from, const data_loss& held,
                              const after_steps_options& how) {
  struct lasting {
    run_time_family family;
    model system;
    std::optional<other_loss> other;
    std::map<int, std::shared_ptr<const data_loss>> known;
  };
  const auto kept = std::make_shared<lasting>(lasting{from.family, from.system, {}, {}});
  if (from.other != nullptr) kept->other = *from.other;
  kept->known[1] = std::make_shared<const data_loss>(held);
  return [kept, how, data = from.kept_held_out, chosen = from.chosen, which = from.which,
          measure = from.measure, threads = from.threads, in_lanes = from.in_lanes](int times) {
    if (const auto found = kept->known.find(times); found != kept->known.end()) return found->second;
    auto& result = kept->known[times];
    if (data == nullptr) return result;
    const auto longer = in_longer_steps(how, times, shortest_of(*data));
    if (longer.steps.empty()) return result;
    const flow_map_data pairs = coarser(*data, times);
    const source_of_losses again{
        kept->family, kept->system, pairs,   pairs,   chosen, kept->other ? &*kept->other : nullptr,
        which,        measure,      threads, in_lanes};
    result = std::make_shared<const data_loss>(again.over(pairs, longer));
    return result;
  };
}

void put_losses(learning_problem& problem, const source_of_losses& from, const rivals_by& rival,
                const data_loss& at_end, int most_steps, const std::function<std::int64_t()>& before) {
  const flow_map_data& data = from.data;
  const loss_kind& kind = *from.chosen.kind;
  const int whole = std::min(shortest_of(data), shortest_of(from.held_out));
  const int shortest = std::min(whole, most_steps);
  const auto stages = from.other == nullptr ? kind.stages(from.chosen.steps, shortest)
                                            : after_each_step(from.other->steps, shortest);
  std::vector<data_loss> losses_of_stages;
  const int every = trajectories_apart(data, size(from.system));
  const bool is_of_trajectories = from.other == nullptr && kind.is_shortened;
  const bool has_several_steps = is_of_trajectories && shortest > 1;
  bool has_all = false;  // the last stage
  for (auto stage : stages) {
    // Two windows a trajectory show where minima lie.
    const int apart = is_of_trajectories ? std::max(stage.apart, whole / 2) : stage.apart;
    has_all = every == 1 && apart == stage.apart;
    stage.every = every;
    stage.apart = apart;
    losses_of_stages.push_back(from.over(data, stage));
  }
  const data_loss loss = has_all ? losses_of_stages.back() : from.over(data, stages.back());
  std::optional<data_loss> one_step_before;
  if (has_several_steps) {
    one_step_before = from.over(data, {.steps = {1}, .apart = std::max(whole / 8, 1), .every = every});
  }
  const auto held = from.over(from.held_out, stages.back());
  const auto passes = [=] {
    std::int64_t here = held.evaluations() + before();
    for (const auto& stage : losses_of_stages) here += stage.evaluations();
    if (!has_all) here += loss.evaluations();
    if (one_step_before) here += one_step_before->evaluations();
    return here;
  };
  const learning_problem without = problem;
  problem.loss = loss.of_theta;
  problem.scores = [of = loss.scores, measure = from.measure](const Eigen::VectorXd& theta) {
    return of(theta, measure->weight_deviations());
  };
  problem.held_out_scores = {};
  if (problem.facts.held_out_is_new) {
    const auto deviations = from.measure->weight_deviations(from.held_out);
    problem.held_out_scores = [of = held.scores, deviations](const Eigen::VectorXd& theta) {
      return of(theta, deviations);
    };
  }
  problem.held_out_losses = held.by_trajectory;
  const auto judge = from.other == nullptr ? kind.judge : judge_of_minima::held_out_loss;
  problem.judge = judge == judge_of_minima::held_out_end    ? at_end.value
                  : judge == judge_of_minima::training_loss ? loss.value
                                                            : held.value;
  const std::int64_t of_data = data.evaluations + from.held_out.evaluations;
  problem.evaluations = [&ranks = data.share().ranks(), of_data, passes] {
    return of_data + ranks.sum(passes());
  };
  problem.rival = [rival, by_times = losses_by_times(from, held, stages.back())](const tabulated& method) {
    return rival(method, by_times);
  };
  problem.facts.loss_steps = stages.back().steps.back();
  for (std::size_t n = 0; from.asks_data() && n < stages.size(); ++n) {
    problem.stages.push_back({.loss = losses_of_stages[n].of_theta, .steps = stages[n].steps.back()});
    if (!has_several_steps) continue;
    constexpr double lost = 0.25;  // an error of half the motion
    problem.stages.back().lost_above = lost * motion_in(data, *from.measure, stages[n]).sum();
  }
  if (!from.asks_data()) {  // the loss judges, too
    problem.loss = kind.without_data(from.system, from.family, data.step);
    problem.judge = [law = problem.loss](const Eigen::VectorXd& theta) { return law(theta).value; };
    if (kind.is_of_proposals)
      problem.stages = {{.loss = problem.loss}};  // from many starts: a pass costs little
  }
  if (!is_of_trajectories) return;
  problem.facts.trajectory_steps = whole;
  problem.follows = follows_over(from, loss, stages.back());
  if (!has_several_steps) return;
  problem.one_step_before = one_step_before->of_theta;
  problem.shorter = std::make_shared<learning_problem>(without);
  put_losses(*problem.shorter, from, rival, at_end, shortest / 4 + 1, passes);
}

namespace {

/// What defects of z^2 are multiplied with to be those of the matrix itself, its four entries counted. Of a
/// kernel only the phase counts, which is the first: a processor does the rest.
Eigen::VectorXd weights_of_defects(Eigen::Index count, double z, bool is_kernel) {
  const double root = std::numbers::sqrt2;  // the half trace is of two entries, and so does the difference
  Eigen::VectorXd weights(4);
  weights << root * std::pow(z, 4), std::pow(z, 3), std::pow(z, 3), root * z * z;
  if (is_kernel) weights.tail(3).setZero();
  return weights.head(count);
}

}  // namespace

objective oscillator_loss(const run_time_family& family, const std::vector<frequency_band>& bands,
                          double step) {
  constexpr int points_of_band = 4;
  std::vector<double> angles;
  for (const auto& [low, high] : bands) {
    for (int k = 0; k < points_of_band; ++k) {
      const double z = step * (low + (high - low) * (k + 1.0) / points_of_band);
      if (z > 0.0 && std::isfinite(z)) angles.push_back(z);
    }
  }
  if (angles.empty() || family.letters.rotates()) return {};
  return [family, angles](const Eigen::VectorXd& theta) {
    const Eigen::Index count = theta.size();
    squares sum{0.0, Eigen::VectorXd::Zero(count), Eigen::MatrixXd::Zero(count, count)};
    const auto coefficients = family.coefficients(theta);
    for (const double z : angles) {
      Eigen::VectorXd r = defect_of_rotation(family.letters, coefficients, family.symmetric, z * z);
      const Eigen::VectorXd weights = weights_of_defects(r.size(), z, family.letters.is_processed());
      r = r.cwiseProduct(weights);
      const Eigen::MatrixXd slopes = weights.asDiagonal() * jacobian_of_defect(family, theta, z * z);
      sum.value += r.squaredNorm();
      sum.half_gradient += slopes.transpose() * r;
      sum.normal_matrix += slopes.transpose() * slopes;
    }
    const double share = 1.0 / static_cast<double>(angles.size());
    return squares{share * sum.value, share * sum.half_gradient, share * sum.normal_matrix};
  };
}

}  // namespace nysalt::detail
