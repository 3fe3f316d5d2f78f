// SPDX-License-Identifier: BSL-1.0
// Fits a family to the flow map of a system at a step.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "nysalt/derivatives/check_letter.hpp"
#include "nysalt/detail/requirements.hpp"
#include "nysalt/learning/problem.hpp"
#include "nysalt/method.hpp"

namespace nysalt {

/// Options of learn(), with parameters of the type of the family.
template <Family F>
struct learn_options {
  std::optional<nysalt::coordinates>
      coordinates{};                    ///< coordinates in which the state's error counts; see fit_options
  parameters_of<F> start = F::start();  ///< first initial guess
  /// A value for each parameter that is not to be learned.
  std::array<std::optional<double>, static_cast<std::size_t>(F::parameters)> fixed{};
  int max_iterations = 200;            ///< largest number of iterations of the search from each start
  int threads = 1;                     ///< changes no bit of what is learned
  std::optional<loss_choice> loss{};   ///< minimised unless an own_loss is given; empty: usual_loss()
  bool classical_starts = true;        ///< begin at the family's classical members and further starts too
  std::optional<int> random_starts{};  ///< further ones, normal around these; empty: by the effort
  nysalt::effort effort =
      nysalt::effort::normal;  ///< effort, which sets the number of random starts where none is given
  bool guarded = true;         ///< false: an unstable optimum is found, and said not to be usable
  bool check_force = true;     ///< whether the force is checked at some states of the data, before the search
  std::int64_t planned_steps = 20'000;  ///< length of the planned runs, as in fit_options
  std::uint64_t seed = 1;               ///< seed of the random starts
};

/// A learned method with the summary of the fit.
template <Family F>
struct learned {
  tuned_method<F> method;  ///< carries its step and system, and refuses others
  fit_summary summary;     ///< errors and verdict of the fit; `usable` says whether to use the method
};

/// theta that minimises a loss over `data`: that of the options, by default the state's error at several
/// times of whole trajectories, in a bath the one-step loss [li_lu_tao_ye_2023, section 3.1], or one
/// own_loss. The search begins at the family's own start, its classical members, random starts and what the
/// options add, and goes in stages, see loss_kind. Of several minima it is the one that the loss's
/// judge_of_minima likes best, among those that the stability_guard admits and that withstand a trial run of
/// planned_steps steps; see learning/search.hpp for where there is none. It is not worse, by the loss on
/// held-out data, than a member of the family that was known before; and the summary names the best classical
/// method of the same cost where that is as good. The held-out data should come from another seed.
///
/// Throws std::invalid_argument if the data are of another system, of two steps or not finite, if
/// check_force() finds the system's force, kick or derivative wrong at some states of the data (unless
/// check_force = false), if the system does not serve the family's letters, or if the coordinates, the loss
/// (or two of them), a start, a fixed value, max_iterations or threads are out of range. A fit that cannot be
/// trusted is returned with usable = false. Cost: some 40 passes over a part of the data for each start, and
/// some 20 to 200 over all for each of three minima, each a step with derivatives a pair. Memory: some five
/// copies of the data.
template <SeparableSystem S, class... Own>
  requires(sizeof...(Own) <= 1)
fit learn(const run_time_family& family, const S& system, const flow_map_data& data,
          const flow_map_data& held_out, const fit_options& options = {}, const own_loss<Own>&... own) {
  if constexpr (sizeof...(Own) == 0) {
    return detail::learn(family, system, data, held_out, options);
  } else {
    const auto other = detail::without_type(system, own...);
    return detail::learn(family, system, data, held_out, options, &other);
  }
}

namespace detail {
/// check_letter() of all letters of one's own at a state of each quarter of the data.
template <TypeLevelWord W, System S>
void require_sound_letters_on(const S& system, const flow_map_data& data) {
  constexpr int N = S::dimension;
  std::vector<phase_point<double, N>> points;
  const std::size_t pairs = data.start.size();
  for (std::size_t quarter = 0; quarter < 4 && pairs > 0; ++quarter) {
    const phase_point<double, Eigen::Dynamic> x = data.start[(2 * quarter + 1) * pairs / 8];
    if (x.size() == size(system)) points.push_back({x.q, x.p});  // else the data are refused later
  }
  if (!points.empty()) require_sound_letters<W>(system, points, data.step);
}
}  // namespace detail

/// Learns a member of a family as a type; the method is a type, too. The word may have letters of one's own,
/// which check_letter() tries at four states of the data before the search, with check_force. What they do to
/// an oscillator is not known: the guard is the trial run, and no classical method is named as a rival.
template <Family F, SeparableSystem S, class... Own>
  requires(sizeof...(Own) <= 1)
learned<F> learn(const F& family, const S& system, const flow_map_data& data, const flow_map_data& held_out,
                 const learn_options<F>& options = {}, const own_loss<Own>&... own) {
  require_suited<F, S>();
  fit_options run_time_options{.coordinates = options.coordinates,
                               .loss = options.loss,
                               .random_starts = options.random_starts,
                               .effort = options.effort,
                               .fixed = {options.fixed.begin(), options.fixed.end()},
                               .guarded = options.guarded,
                               .planned_steps = options.planned_steps,
                               .check_force = options.check_force,
                               .seed = options.seed,
                               .max_iterations = options.max_iterations,
                               .threads = options.threads};
  const run_time_family as_data = [&] {
    if constexpr (detail::has_own_letters<typename F::word>()) {
      if (options.check_force) detail::require_sound_letters_on<typename F::word>(system, data);
      return run_time_family(family, system);
    } else {
      return run_time_family(family);
    }
  }();
  run_time_options.start = column_of(options.start);
  if (options.classical_starts) {
    run_time_options.further_starts.assign(as_data.starts.begin() + 1, as_data.starts.end());
  }
  const auto [theta, summary] = learn(as_data, system, data, held_out, run_time_options, own...);
  const member<F> found(array_of<parameters_of<F>{}.size()>(theta), family);
  // A covariance loss asks no data, and has seen no energies.
  const auto energies = summary.is_of_data ? data.energies : std::nullopt;
  return {tuned_method<F>(found, data.step, data.system, energies, kind_of(system)), summary};
}

}  // namespace nysalt
