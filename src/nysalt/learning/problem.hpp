// SPDX-License-Identifier: BSL-1.0
// The problem that learn() solves: a family, data, a loss and a guard.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <memory>
#include <vector>

#include "curvature.hpp"
#include "nysalt/judgement.hpp"
#include "nysalt/learn.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/method.hpp"
#include "search.hpp"

namespace nysalt {

/// A loss over data that several share.
using shared_loss = std::shared_ptr<const loss_on_data>;

/// A family, data, a loss over steps up to some number of them, and a guard. Refers to the data. Where ranks
/// share the data each rank has its own part, and the functions are collective: all ranks search together,
/// and find the same.
class learning_problem {
 public:
  /// The problem over all steps of the trajectories. Throws what learn() does.
  learning_problem(const nysalt::family& to_fit, const model& of_system, const flow_map_data& to_learn_from,
                   const flow_map_data& to_judge_by, const fit_options& how);

  nysalt::family family;                  ///< family to fit
  model system;                           ///< system that the data are of
  const flow_map_data& data;              ///< data to learn from
  const flow_map_data& held_out;          ///< data to judge by
  loss_choice chosen;                     ///< loss that is minimised
  fit_options options;                    ///< options as given, but for the planned steps of proposals
  coordinates which;                      ///< coordinates in which an error of the state counts
  std::shared_ptr<const metric> measure;  ///< weights of an error of the state
  detail::stability_guard guard;          ///< knows the frequencies of the system
  double known_frequency;  ///< frequency that was given, or that of the highest mode; 0: neither is known
  fit_summary facts;       ///< facts that are known before a search

  after_steps_options times;           ///< steps after which the errors of the loss count
  std::vector<search_stage> stages;    ///< losses that are minimised roughly before, to locate minima
  objective loss;                      ///< the loss to minimise
  objective one_step_before;           ///< one-step loss, whose minimum is one more start; empty: none
  shared_loss over_data;               ///< the loss over the data to learn from
  shared_loss over_held_out;           ///< the loss over held-out data
  shared_loss one_step_over_held_out;  ///< the error after a step, of held-out pairs
  shared_loss at_end_of_held_out;      ///< the error at the ends of held-out trajectories

  /// The distribution of the held-out trajectories over ranks.
  shard share() const { return held_out.share(); }
  /// The score that is least for the best of several minima, see judge_of_minima; of a loss that asks no
  /// data, the loss.
  double judge(const Eigen::VectorXd& theta) const;
  /// The contribution of each trajectory to the gradient of the loss, its part in the weights included.
  trajectory_scores scores(const Eigen::VectorXd& theta) const;
  /// The same of each held-out trajectory, in the loss on held-out data. Empty: the held-out data are not
  /// new.
  trajectory_scores held_out_scores(const Eigen::VectorXd& theta) const;
  /// Whether the method stays near the data over all steps of the loss: with an error below a
  /// twentieth of the motion. Where it does not, phases are lost, and the loss means little. True where the
  /// loss is not one of trajectories.
  bool follows(const Eigen::VectorXd& theta) const;
  /// The word with the coefficients of a member, as a method.
  nysalt::method member(const Eigen::VectorXd& theta) const;
  /// The judgement of a method at a step. What was judged once is known.
  const judgement& judged(const nysalt::method& method, double step) const;
  /// Force evaluations of all ranks so far, data included.
  std::int64_t evaluations() const;
  /// Whether windows are in lanes.
  bool in_lanes() const { return system.facts().in_lanes_with_slopes; }
  /// A loss over any pairs, after any steps. Refers to the metric.
  shared_loss made(const loss_kind& kind, const flow_map_data& pairs, after_steps_options how) const;

  /// Whether there is a problem over fewer steps.
  bool has_shorter() const { return chosen.kind->is_shortened && steps_ > 1; }
  /// The same problem over a quarter of the steps. Its evaluations include those of this one.
  learning_problem shorter() const;

 private:
  void tell_facts();
  /// The losses over at most that number of steps.
  void make_losses();
  void add_stage(const after_steps_options& stage, int every);
  /// A loss whose evaluations count.
  shared_loss counted(const loss_kind& kind, const flow_map_data& pairs, const after_steps_options& how);
  /// The same, with the options' progress: each call is a pass.
  objective watched(objective of_theta) const;

  struct judges;
  int whole_;                         // steps of the shortest trajectory
  int steps_;                         // largest number of steps in a loss of this problem
  objective law_;                     // the loss, if it asks no data
  std::vector<shared_loss> counted_;  // those whose evaluations count
  Eigen::VectorXd motion_;            // mean square of each residual over the steps of the loss
  std::shared_ptr<judges> judges_;
  std::shared_ptr<std::int64_t> passes_ = std::make_shared<std::int64_t>(0);  // passes that were reported
};

/// The fit of a learning problem, judged: over fewer steps where the data cannot be followed over all. Throws
/// std::invalid_argument for options that the family cannot take. Cost: see learn().
fit solve(const learning_problem& problem);

/// Whether letters are served, in lanes or one by one, with their derivatives by theta. Throws
/// std::invalid_argument where they are not.
void require_served_with_slopes(const word& letters, const model& system, bool in_lanes);

}  // namespace nysalt
