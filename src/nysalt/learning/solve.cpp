// SPDX-License-Identifier: BSL-1.0
// From a problem of learning to a fit: minima are located, refined, judged and described.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "describe.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "problem.hpp"
#include "search.hpp"
#include "starts_of_fit.hpp"
#include "strongest_rival.hpp"

namespace nysalt {

using detail::contender;

namespace {

/// The best member of the family that this one contains: what is learned is no worse than what fewer
/// parameters give, which the first stages of a search among many lose sight of. Nothing where there is none.
std::optional<named_parameters> best_contained(search_task task, const learning_problem& problem) {
  const auto inner = problem.family.contained;
  if (!inner || task.stages.empty() || problem.options.start) return std::nullopt;
  const auto embedded = [&](const Eigen::VectorXd& theta) {
    return named_parameters{"best of " + inner->family.name, inner->embed(theta)};
  };
  if (problem.options.contained) return embedded(*problem.options.contained);
  const auto options = detail::options_within(*inner, problem.options);
  if (!options) return std::nullopt;
  task.free = detail::free_parameters(inner->family, *options);
  task.withstands = {};
  task.most_stable_member = {};
  constexpr int some_iterations = 20;  // as the search goes on from here
  task.max_iterations = some_iterations;
  const auto starts = detail::starts_of(inner->family, *options, problem, task.free);
  const search_result found = search(detail::within(*inner, task), starts);
  if (found.lost_after > 0) return std::nullopt;
  return embedded(found.best.theta);
}

/// The member at theta, for the step and the system of the data. A covariance loss asks no data, and has seen
/// no energies.
method learned_method(const learning_problem& problem, const Eigen::VectorXd& theta, bool is_of_data) {
  const family& family = problem.family;
  return {family.name,
          family.letters,
          family.coefficients(theta),
          {family.order, family.symmetric, family.requires_quadratic_kinetic},
          method_validity{problem.data.step, problem.data.system, detail::kind_of(problem.system),
                          is_of_data ? problem.data.energies : std::nullopt}};
}

/// One search for the answer to a problem, in four phases: each needs those before.
class solution {
 public:
  explicit solution(const learning_problem& problem);

  /// Searches from all starts. The number of steps after which no member followed the data; 0: some did.
  int locate();
  /// Where the guard let no minimum of the loss itself through: what a search by the one-step loss finds, if
  /// the judge likes it better.
  void refine();
  /// What is handed out is not worse than a member of the family that was known before.
  void judge();
  /// The fit with its summary.
  fit describe();

  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - began_).count();
  }

 private:
  std::string objection_of_guard(const Eigen::VectorXd& theta, detail::met which) const {
    return problem_.guard.objection(family_.letters, family_.coefficients(theta), problem_.facts.step, which);
  }
  const judgement& judged(const Eigen::VectorXd& theta) const {
    return problem_.judged(problem_.member(theta), problem_.facts.step);
  }
  std::string objection_to(const contender& one) const {
    const judgement& found = problem_.judged(one.method, one.judged_step);
    return found.holds() ? std::string() : found.in_words();
  }
  bool has_settled() const { return found_.best.converged || found_.best.in_valley || found_.best.is_held; }

  search_task task_of() const;
  contender member_at(const std::string& name, const Eigen::VectorXd& theta) const;
  std::vector<contender> known_members() const;

  void describe_losses(fit_summary& summary) const;
  void describe_search(fit_summary& summary) const;
  /// The curvature of the loss; and the uncertainty of the minimum, if the loss is of data.
  std::optional<spread_of_minimum> describe_curvature(fit_summary& summary) const;
  void describe_parameters(const std::optional<spread_of_minimum>& spread, fit_summary& summary) const;
  std::string objection_to_unguarded() const;

  const learning_problem& problem_;
  const family& family_;
  const fit_options& options_;
  const shard share_;
  const std::chrono::steady_clock::time_point began_ = std::chrono::steady_clock::now();
  std::vector<Eigen::Index> free_;
  double frequency_;                        // that of the phase-fitted member
  std::optional<named_parameters> fitted_;  // the phase-fitted member
  std::optional<named_parameters> contained_;
  std::vector<named_parameters> starts_;
  search_task task_;
  search_result found_;
  std::optional<contender> chosen_;
  std::vector<contender> members_;
};

solution::solution(const learning_problem& problem)
    : problem_(problem),
      family_(problem.family),
      options_(problem.options),
      share_(problem.share()),
      frequency_(problem.known_frequency) {
  detail::require_sound(family_, options_);
  free_ = detail::free_parameters(family_, options_);
  starts_ = detail::starts_of(family_, options_, problem_, free_);
  if (!(frequency_ > 0.0)) {
    for (const auto& band : problem_.guard.frequencies(detail::met::often)) {
      frequency_ = std::max(frequency_, band.high);
    }
  }
  const double z = problem_.facts.step * frequency_;
  if (z > 0.0 && std::isfinite(z) && !family_.letters.has_own_letters()) {
    fitted_ = phase_fitted_start(family_, z);
  }
  if (fitted_ && !options_.start) {
    starts_.push_back(*fitted_);
    detail::fix(options_, starts_.back().theta);
  }
  task_ = task_of();
}

search_task solution::task_of() const {
  search_task task{.family = &family_,
                   .loss = problem_.loss,
                   .stages = problem_.stages,
                   .one_step_loss = problem_.one_step_before,
                   .judge = [this](const Eigen::VectorXd& theta) { return problem_.judge(theta); },
                   .admits =
                       [this](const Eigen::VectorXd& theta) {
                         return !options_.guarded || objection_of_guard(theta, detail::met::often).empty();
                       },
                   .admits_at_edge =
                       [this](const Eigen::VectorXd& theta) {
                         return !options_.guarded || objection_of_guard(theta, detail::met::ever).empty();
                       },
                   .free = free_,
                   .max_iterations = options_.max_iterations};
  if (options_.guarded) {
    task.withstands = [this](const Eigen::VectorXd& theta) { return judged(theta).holds(); };
  }
  if (family_.most_stable_member) {
    task.most_stable_member = named_parameters{"the most stable member", *family_.most_stable_member};
    detail::fix(options_, task.most_stable_member->theta);
  }
  return task;
}

int solution::locate() {
  contained_ = best_contained(task_, problem_);
  if (contained_) task_.kept.push_back(*contained_);
  found_ = search(task_, starts_);
  return found_.lost_after;
}

void solution::refine() {
  const auto is_sound = [&](const candidate& one) {
    return one.admitted && (!task_.withstands || task_.withstands(one.theta));
  };
  const bool was_sound = is_sound(found_.best);
  if (!task_.one_step_loss || (was_sound && !found_.best.is_held)) return;
  search_task task = task_;
  task.loss = task_.one_step_loss;
  task.stages = {{.loss = task_.one_step_loss, .steps = 1}};
  task.one_step_loss = {};
  task.kept = {};
  const search_result other = search(task, starts_);
  found_.tried += other.tried;
  if (!is_sound(other.best) || (was_sound && !(other.best.judged < found_.best.judged))) return;
  found_.best = other.best;
  found_.best.loss = task_.loss(other.best.theta).value;
  found_.best.is_held = true;  // no minimum of the loss itself
}

contender solution::member_at(const std::string& name, const Eigen::VectorXd& theta) const {
  contender result{.name = name,
                   .losses = problem_.over_held_out->by_trajectory(theta),
                   .method = problem_.member(theta),
                   .judged_step = problem_.facts.step,
                   .theta = theta};
  result.loss = share_.sum(result.losses);
  return result;
}

std::vector<contender> solution::known_members() const {
  std::vector<contender> members;
  const bool is_free = std::ssize(free_) == family_.parameters();
  if (!is_free || !problem_.facts.is_of_data) return members;
  for (const auto& known : family_.starts) {
    if (known.name != "further start") members.push_back(member_at(known.name, known.theta));
  }
  if (family_.most_stable_member) members.push_back(member_at("equal steps", *family_.most_stable_member));
  if (fitted_) members.push_back(member_at(fitted_->name, fitted_->theta));
  if (contained_) members.push_back(member_at(contained_->name, contained_->theta));
  std::ranges::stable_sort(members, {}, &contender::loss);
  return members;
}

void solution::judge() {
  chosen_ = member_at(found_.best.from, found_.best.theta);
  members_ = known_members();
  const bool is_chosen_sound = !options_.guarded || objection_to(*chosen_).empty();
  for (const auto& member : members_) {
    if (!options_.guarded || !has_settled()) break;
    const bool may_replace = detail::is_better(member.losses, chosen_->losses, share_) || !is_chosen_sound;
    if (!may_replace || !objection_to(member).empty()) continue;
    if (!found_.unguarded) found_.unguarded = found_.best;
    found_.best = {.from = member.name,
                   .theta = member.theta,
                   .hessian = {},
                   .free = free_,
                   .loss = task_.loss(member.theta).value,
                   .is_held = true};
    chosen_ = member;
    break;
  }
  detail::require_same(share_.ranks(), found_.best.theta);
}

fit solution::describe() {
  const Eigen::VectorXd& theta = found_.best.theta;
  fit_summary summary = problem_.facts;
  describe_losses(summary);
  describe_search(summary);
  const auto spread = describe_curvature(summary);
  if (summary.is_of_data) {
    summary.errors_withheld = detail::reason_to_withhold(problem_, summary, found_.best, free_, spread);
  }
  describe_parameters(spread, summary);
  summary.judgement = judged(theta);
  const std::string instability = summary.judgement.holds() ? std::string() : summary.judgement.in_words();
  if (instability.empty()) {
    for (const auto& [low, high] :
         problem_.guard.gaps(family_.letters, family_.coefficients(theta), summary.step)) {
      summary.gaps.push_back({low, high});
    }
  }
  if (summary.is_of_data) {
    auto rivals = members_;
    // The best of the contained family is learned, too, and no rival of it.
    if (contained_) std::erase_if(rivals, [&](const auto& one) { return one.name == contained_->name; });
    for (auto& one : detail::classical_rivals(problem_, theta)) rivals.push_back(std::move(one));
    const auto objection = [this](const contender& one) { return objection_to(one); };
    detail::summarise_rival(*chosen_, std::move(rivals), share_, objection, summary);
  }
  summary.reason = detail::objection(summary, has_settled(), instability);
  summary.usable = summary.reason.empty();
  summary.learning_evaluations = problem_.evaluations();
  summary.fit_seconds = seconds();
  return {theta, summary, learned_method(problem_, theta, summary.is_of_data)};
}

void solution::describe_losses(fit_summary& summary) const {
  const Eigen::VectorXd& theta = found_.best.theta;
  const auto at_start = problem_.over_held_out->by_trajectory(starts_.front().theta);
  summary.loss = found_.best.loss;
  summary.held_out_loss = chosen_->loss;
  summary.held_out_start_loss = share_.sum(at_start);
  summary.held_out_noise = detail::noise_of_difference(chosen_->losses, at_start, share_);
  summary.one_step_error = std::sqrt(problem_.one_step_over_held_out->value(theta));
  summary.trajectory_error = std::sqrt(problem_.at_end_of_held_out->value(theta));
  summary.follows = problem_.follows(theta);
}

void solution::describe_search(fit_summary& summary) const {
  const candidate& best = found_.best;
  summary.starts_tried = found_.tried;
  summary.from = best.from;
  summary.iterations = best.iterations;
  summary.is_in_valley = best.in_valley;
  summary.is_held_by_guard = best.is_held;
  summary.highest_frequency = problem_.guard.highest_along();
  if (fitted_) {
    summary.fitted_frequency = frequency_;
    summary.source_of_frequency = options_.frequency               ? "as given"
                                  : problem_.known_frequency > 0.0 ? "declared"
                                                                   : "the highest that the data meet often";
  }
  if (found_.unguarded) summary.unguarded = objection_to_unguarded();
  for (const Eigen::Index k : free_) {
    const bool is_held_there = std::ranges::find(best.free, k) == best.free.end();
    if (is_held_there && std::abs(best.theta[k]) == detail::farthest_parameter)
      summary.is_at_no_bound = false;
  }
}

std::string solution::objection_to_unguarded() const {
  const Eigen::VectorXd& theta = found_.unguarded->theta;
  std::string text = objection_of_guard(theta, detail::met::often);
  if (text.empty()) {
    const judgement& found = judged(theta);
    if (!found.holds()) text = found.reason;
  }
  return text.empty() ? objection_of_guard(theta, detail::met::ever) : text;
}

std::optional<spread_of_minimum> solution::describe_curvature(fit_summary& summary) const {
  const candidate& best = found_.best;
  if (best.is_held) {  // no minimum is near
    if (summary.is_of_data) summary.expected_excess = std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
  }
  std::optional<spread_of_minimum> spread;
  const curvature bend(best.hessian, best.free);
  if (summary.is_of_data) {
    const auto scores = problem_.scores(best.theta);
    spread = bend.spread(scores, problem_.held_out_scores(best.theta));
    summary.expected_excess = bend.expected_excess(scores);
    summary.deciding_trajectories = bend.deciding_blocks(scores);
  }
  summary.condition = bend.condition();
  for (const auto& flat : bend.flat_directions()) {
    summary.flat_directions.emplace_back(flat.begin(), flat.end());
  }
  return spread;
}

void solution::describe_parameters(const std::optional<spread_of_minimum>& spread,
                                   fit_summary& summary) const {
  const candidate& best = found_.best;
  for (Eigen::Index k = 0; k < best.theta.size(); ++k) {
    const bool is_estimated = summary.is_of_data && std::ranges::find(free_, k) != free_.end();
    const bool varies = !best.is_held && std::ranges::find(best.free, k) != best.free.end();
    const bool is_flat = spread && std::isinf(spread->standard_errors[k]);
    const double error = !is_estimated ? 0.0
                         : !summary.errors_withheld.empty() && !is_flat
                             ? std::numeric_limits<double>::quiet_NaN()
                             : spread->standard_errors[k];
    summary.parameters.push_back(
        {family_.parameter_names[static_cast<std::size_t>(k)], best.theta[k], error, varies});
  }
}

/// What solve() comes to where no member follows the data for as many steps: the first problem over fewer
/// steps whose loss may be followed.
fit solve_shorter(const learning_problem& problem, int lost_after) {
  const learning_problem next = problem.shorter();
  const bool is_lost_too = !next.stages.empty() && next.stages.back().steps >= lost_after;
  return next.has_shorter() && is_lost_too ? solve_shorter(next, lost_after) : solve(next);
}

}  // namespace

fit solve(const learning_problem& problem) {
  solution one(problem);
  const int lost_after = one.locate();
  std::optional<fit> found;
  if (lost_after == 0) {
    one.refine();
    one.judge();
    found = one.describe();
    if (!problem.has_shorter() || found->summary.follows) return *found;
  }
  const double seconds = one.seconds();
  fit other = solve_shorter(problem, found ? std::numeric_limits<int>::max() : lost_after);
  if (found && found->summary.usable && !other.summary.usable) return *found;
  other.summary.fit_seconds += seconds;
  return other;
}

}  // namespace nysalt
