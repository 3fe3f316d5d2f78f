// SPDX-License-Identifier: BSL-1.0
// All that a search must know of a system, its data and a family; no type of any of them is left.
#pragma once

#include <concepts>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "nysalt/judgement.hpp"
#include "nysalt/learning/curvature.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/learning/search.hpp"
#include "nysalt/learning/stability_guard.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/squares.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/method.hpp"
#include "nysalt/run_time_family.hpp"

namespace nysalt {

/// Number of random starts of a search in stages: 40, 120 or 400, or a fifth of these for two parameters
/// and fewer.
enum class effort { quick, normal, thorough };

/// Options of a search. Empty ones are those of the family.
struct fit_options {
  std::optional<nysalt::coordinates>
      coordinates{};                  ///< coordinates in which the error counts; empty: as suits the loss
  std::optional<loss_choice> loss{};  ///< loss to minimise, if not an own_loss; empty: usual_loss()
  std::optional<Eigen::VectorXd> start{};  ///< instead of the family's own starts
  std::vector<named_parameters>
      further_starts{};  ///< additional starts, such as the optimum at a smaller step
  std::optional<int>
      random_starts{};  ///< number of random starts, normal around the first; empty: by the effort
  nysalt::effort effort = nysalt::effort::normal;  ///< effort of a search in stages
  std::vector<std::optional<double>> fixed{};      ///< a value for each parameter that is not to be learned
  bool guarded = true;  ///< false: an unstable optimum is found, and said not to be usable
  /// The largest number of steps of a run with the method: the length of its trial, and the steps, up to
  /// 10,000, over which the guard examines growth. A proposal of Hybrid Monte Carlo takes few.
  std::int64_t planned_steps = 20'000;
  bool check_force = true;  ///< whether learn() checks the force first
  /// The frequency that the phase-fitted member of the family keeps, a start of the search and a rival; none:
  /// the highest of the modes, or of what is met often.
  std::optional<double> frequency{};
  std::uint64_t seed = 1;    ///< seed of the random starts
  int max_iterations = 200;  ///< largest number of iterations of the search from each start
  int threads = 1;           ///< changes no bit of what is learned
};

/// Another method, at the step at which it costs as much per unit time as the family.
struct rival_method {
  std::string name;                     ///< name of the rival
  double step = 0.0;                    ///< its step
  std::vector<double> held_out_losses;  ///< contribution of each held-out trajectory of this rank to the loss
  tabulated method;                     ///< word and coefficients that are judged
  double judged_step = 0.0;             ///< step at which they are; in a bath that of several steps as one
  /// The same of a member of the family, by the times that both have; empty where these are all times of the
  /// loss.
  std::function<std::vector<double>(const Eigen::VectorXd&)> losses_beside{};
};

/// The problem that learn() makes of system and data, and solve() solves. Refers to the system. Where ranks
/// share the data each has its own part, and the functions are collective: all ranks search together, and
/// find the same.
struct learning_problem {
  run_time_family family;              ///< family to fit
  fit_options options;                 ///< options as given
  double step;                         ///< h of the data
  method_validity validity{};          ///< step, system and energies of the data
  objective loss;                      ///< loss to minimise
  std::vector<search_stage> stages{};  ///< losses that are minimised roughly before, to locate minima
  objective one_step_before{};  ///< one-step loss, whose minimum is one more start of a search in stages;
                                ///< empty: none
  /// The contribution of each trajectory to the gradient of `loss`, its part in the weights included.
  std::function<trajectory_scores(const Eigen::VectorXd&)> scores;
  /// The same of each held-out trajectory, in the loss on held-out data. Empty: there are no such data.
  std::function<trajectory_scores(const Eigen::VectorXd&)> held_out_scores{};
  shard held_out;  ///< distribution of the held-out trajectories over ranks
  /// The contribution of each held-out trajectory of this rank to the loss.
  std::function<std::vector<double>(const Eigen::VectorXd&)> held_out_losses;
  std::function<double(const Eigen::VectorXd&)> one_step_loss;  ///< mean over held-out pairs
  std::function<double(const Eigen::VectorXd&)> loss_at_end;  ///< error at the ends of held-out trajectories
  /// The function that is least for the best of several minima, see judge_of_minima; of a loss that asks no
  /// data, the loss.
  std::function<double(const Eigen::VectorXd&)> judge;
  std::function<std::int64_t()> evaluations;  ///< force evaluations of all ranks so far, data included
  /// Whether the method stays near the data over all steps of the loss: with an error below a
  /// twentieth of the motion. Where it does not, phases are lost, and the loss means little. Empty: the loss
  /// is not one of trajectories.
  std::function<bool(const Eigen::VectorXd&)> follows{};
  std::shared_ptr<learning_problem> shorter{};  ///< problem over a quarter of the steps; null: none
  /// Judges a method at a step; the judges of steps are made when they are first asked.
  std::function<judgement(const tabulated&, double step)> judged;
  /// Another method at equal cost, by the loss on held-out data, with the letters O of the family's word.
  /// Where its step does not divide that of the data, the loss is that at the times nearest to its own which
  /// are multiples of both steps. Nothing if the system does not serve its letters, if there are no such
  /// times, or if the word has letters O or a processor and the step does not divide.
  std::function<std::optional<rival_method>(const tabulated&)> rival;
  stability_guard guard;          ///< knows the frequencies of the system
  bool is_of_black_box = false;   ///< whether the force is a black box, over double only
  bool is_in_bath = false;        ///< whether the system is in a bath that acts
  double frequency_to_fit = 0.0;  ///< as given, or the highest of the modes; 0: neither
  fit_summary facts;              ///< facts that are known before a search
};

/// Result of learning a run_time_family.
struct fit {
  Eigen::VectorXd theta;  ///< the learned parameters
  fit_summary summary;    ///< errors and verdict of the fit; `usable` says whether to use the method
  tabulated method;       ///< the member at theta; it carries its step and system, and refuses others
};

/// The fit of a learning problem, judged: see learn().
fit solve(const learning_problem& problem);

// From a system, its data and a family to a problem that knows none of their types.

namespace detail {

/// A loss other than those of losses(), over the scalar that carries the windows.
struct other_loss {
  std::string name;
  std::string description;
  int steps;
  std::optional<window_error<lanes>> in_lanes = {};
  std::optional<window_error<double>> one_by_one = {};
};

template <SeparableSystem S, class Error>
other_loss without_type(const S& system, const own_loss<Error>& own) {
  other_loss result{own.name, own.description(), own.steps};
  if constexpr (std::same_as<scalar_of_passes<S>, lanes>) {
    result.in_lanes = own_error(system, own.error);
  } else {
    result.one_by_one = own_error(system, own.error);
  }
  return result;
}

learning_problem make_learning_problem(const run_time_family& family, const model& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const other_loss* other = nullptr);

fit learn(const run_time_family& family, const model& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options, const other_loss* other = nullptr);

}  // namespace detail

/// The problem of fitting the family's word to the data: by the loss of the options, or by one own_loss.
/// Throws what learn() does.
template <SeparableSystem S, class... Own>
  requires(sizeof...(Own) <= 1)
learning_problem make_learning_problem(const run_time_family& family, const S& system,
                                       const flow_map_data& data, const flow_map_data& held_out,
                                       const fit_options& options, const own_loss<Own>&... own) {
  if constexpr (sizeof...(Own) == 0) {
    return detail::make_learning_problem(family, system, data, held_out, options);
  } else {
    const auto other = detail::without_type(system, own...);
    return detail::make_learning_problem(family, system, data, held_out, options, &other);
  }
}

}  // namespace nysalt
