// SPDX-License-Identifier: BSL-1.0
// Fits a family to the flow map of a system at a step.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

#include "nysalt/execution.hpp"
#include "nysalt/family.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/learning/fit_summary.hpp"
#include "nysalt/losses/loss_choice.hpp"
#include "nysalt/losses/window_error.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

namespace nysalt {

/// Number of random starts of a search in stages: 40, 120 or 400, or a fifth of these for two parameters
/// and fewer.
enum class effort { quick, normal, thorough };

/// Options of learn(). Empty ones are taken from the family.
struct fit_options {
  std::optional<nysalt::coordinates>
      coordinates{};                  ///< coordinates in which the error counts; empty: as suits the loss
  std::optional<loss_choice> loss{};  ///< loss to minimise; empty: usual_loss()
  std::optional<Eigen::VectorXd> start{};  ///< instead of the family's own starts
  std::vector<named_parameters>
      further_starts{};  ///< additional starts, such as the optimum at a smaller step
  /// The optimum of the family that this one contains, in that one's parameters; empty: it is searched for.
  std::optional<Eigen::VectorXd> contained{};
  std::optional<int>
      random_starts{};  ///< number of random starts, normal around the first; empty: by the effort
  nysalt::effort effort = nysalt::effort::normal;  ///< effort of a search in stages
  std::vector<std::optional<double>> fixed{};      ///< a value for each parameter that is not to be learned
  bool guarded = true;  ///< false: an unstable optimum is found, and said not to be usable
  /// The largest number of steps of a run with the method: the length of its trial, and the steps, up to
  /// 10,000, over which the guard examines growth. A proposal of Hybrid Monte Carlo takes few.
  std::int64_t planned_steps = 20'000;
  bool check_force = true;  ///< whether the force is checked at some states of the data, before the search
  /// The frequency that the phase-fitted member of the family keeps, a start of the search and a rival; none:
  /// the highest of the modes, or of what is met often.
  std::optional<double> frequency{};
  std::uint64_t seed = 1;    ///< seed of the random starts
  int max_iterations = 200;  ///< largest number of iterations of the search from each start
  /// Threads; ranks are those of the data. Progress is called before each pass of the search over the data,
  /// with the number of passes done, and what it throws ends the search.
  nysalt::execution execution{};
};

/// Result of learn().
struct fit {
  Eigen::VectorXd theta;  ///< the learned parameters
  fit_summary summary;    ///< errors and verdict of the fit; `usable` says whether to use the method
  nysalt::method method;  ///< the member at theta; it carries its step and system, and refuses others
};

/// theta that minimises a loss over `data`: the loss of the options, by default the state's error at several
/// times of whole trajectories, in a bath the one-step loss [li_lu_tao_ye_2023, section 3.1]. The search
/// begins at the family's own start, its classical members, its phase-fitted member, random starts and what
/// the options add, and goes in stages, see loss_kind. Of several minima it is the one that the loss's
/// judge_of_minima likes best, among those that the stability_guard admits and that withstand a trial run of
/// planned_steps steps. It is not worse, by the loss on held-out data, than a member of the family that was
/// known before; and the summary names the best classical method of the same cost where that is as good. The
/// held-out data should come from another seed.
///
/// The word may have letters of the system, which check_letter() tries at four states of the data before the
/// search, with check_force. What they do to an oscillator is not known: the guard is the trial run, and no
/// classical method is named as a rival.
///
/// Throws std::invalid_argument if the data are of another system, of two steps or not finite, if
/// check_force() finds the system's force, kick or derivative wrong at some states of the data (unless
/// check_force = false), if the system does not serve the family's letters, or if the coordinates, the loss,
/// a start, a fixed value, max_iterations or threads are out of range. A fit that cannot be
/// trusted is returned with usable = false. Cost: some 40 passes over a part of the data for each start, and
/// some 20 to 200 over all for each of three minima, each a step with derivatives a pair. Memory: some five
/// copies of the data.
fit learn(const family& family, const model& system, const flow_map_data& data, const flow_map_data& held_out,
          const fit_options& options = {});

namespace detail {
/// The options with the loss. Throws std::invalid_argument if they have one.
fit_options with_loss(fit_options options, loss_choice loss);
}  // namespace detail

/// The same with a loss of one's own. Throws std::invalid_argument, too, if the options have another loss.
template <SeparableSystem S, class Error>
fit learn(const family& family, const S& system, const flow_map_data& data, const flow_map_data& held_out,
          const fit_options& options, const own_loss<Error>& own) {
  return learn(family, system, data, held_out, detail::with_loss(options, loss_of(system, own)));
}

}  // namespace nysalt
