// SPDX-License-Identifier: BSL-1.0
// What happens to a method at a step: a trial on many trajectories, and what linear theory adds.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "nysalt/divergence.hpp"
#include "nysalt/execution.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"
#include "nysalt/phase_point.hpp"

namespace nysalt {

/// Verdict on a method at a step. A trajectory is lost if it diverges, or if in the last sixteenth of the
/// trial |H - H_0| exceeds the median kinetic energy more often than not.
enum class step_verdict {
  good,                ///< at most one in fifty will be lost in a run four times as long, as the trial shows
  near_an_edge,        ///< good, but near to something that reason() names
  loses_trajectories,  ///< more than one in fifty is lost
  unstable,            ///< more than half are lost
  not_tried            ///< nothing could be tried; reason() says why
};

/// Name of a verdict, in programs and files.
constexpr std::string_view to_string(step_verdict v) {
  constexpr std::array<std::string_view, 5> names{"good", "near an edge", "loses trajectories", "unstable",
                                                  "not tried"};
  return names[static_cast<std::size_t>(v)];
}

/// How much a judge may do. Two judges of equal options, system, starts and step give equal judgements.
struct judging_options {
  std::int64_t steps = 20'000;  ///< largest number of steps of a trajectory
  /// Largest number of force evaluations times force_cost(), some tenths of a second in lanes, as a rule; of
  /// a black box, whose cost is not known, of force evaluations a two-thousandth of it.
  std::int64_t work = 400'000'000;
  std::uint64_t seed = 1;         ///< seed of the noise, in a bath
  nysalt::execution execution{};  ///< only the number of threads is used
  bool watches_energy = true;     ///< false: only divergence counts, as for proposals of Hybrid Monte Carlo
};

namespace detail {

/// Largest number of force evaluations of a trial: what `work` comes to.
std::int64_t evaluations_of_trial(const model& system, const judging_options& options = {});

}  // namespace detail

/// The judgement of a method at a step.
struct judgement {
  /// Errors of the energy of trajectories, each the largest |H - H_0| over the median kinetic energy.
  struct energy_errors {
    double median = 0.0;      ///< of the trajectories
    double most = 0.0;        ///< 95 % of the trajectories have less
    double nearly_all = 0.0;  ///< 98 % of the trajectories have less: a good method may lose the others
    double largest = 0.0;     ///< of all trajectories
  };

  double step = 0.0;              ///< h
  std::int64_t trajectories = 0;  ///< trajectories that count
  std::int64_t unconfined = 0;    ///< further ones, which diverge by an accurate method, too
  std::int64_t steps = 0;         ///< steps of each trajectory
  std::int64_t lost = 0;          ///< number of trajectories that are lost
  std::int64_t diverged = 0;      ///< number of those that diverged
  std::int64_t exceeding = 0;  ///< number of those that are lost, or whose energy erred at some time by more
                               ///< than the kinetic energy
  std::optional<diverged_trajectory>
      first_lost;               ///< lost trajectory with the lowest number, where it is lost
  double kinetic_energy = 0.0;  ///< median over trajectories and times of an accurate motion; 0: not known
  bool energy_was_watched =
      false;                   ///< false: in a bath, H or its kinetic part is not known, or not asked for
  energy_errors energy_error;  ///< of the trajectories that did not diverge
  /// Slope by Theil and Sen [sen_1968] of the median energy error over 16 windows, for the whole trial.
  double drift = 0.0;
  double growth = 0.0;  ///< energy_error.nearly_all of the second half of the trial, over the first half's
  diverged_trajectory farthest{};  ///< trajectory with the largest energy error, and where

  double highest_frequency = 0.0;  ///< highest frequency met along the motion; 0: not known
  std::string frequencies;         ///< the known frequencies, and their origin
  std::string linear_objection;  ///< of the linear criterion, on frequencies that are met often; empty: none
  std::optional<double> margin;  ///< of these frequencies, see stability_margin(); nothing: no windows
  std::string resonance;         ///< resonance near the step; empty: none

  step_verdict verdict = step_verdict::not_tried;  ///< by the rules in judgement.cpp
  std::string reason{};                            ///< reason of any verdict but good, a clause; else empty

  /// Share of the trajectories that are lost.
  double share_lost() const {
    return trajectories == 0 ? 0.0 : static_cast<double>(lost) / static_cast<double>(trajectories);
  }
  /// Upper 95 % bound on the share [clopper_pearson_1934].
  double most_lost() const;

  /// Whether the method may be used at the step: good, or near an edge.
  bool holds() const { return verdict == step_verdict::good || verdict == step_verdict::near_an_edge; }
  /// Verdict and reason.
  std::string in_words() const;
  /// The trial and its outcome in numbers.
  std::string report() const;
};

/// What judgements of one system, one set of starts and one step have in common: an accurate motion, the
/// kinetic energy and the frequencies along it.
class step_judge {
 public:
  /// Judge of methods at a step, on trajectories from some of these starts, the first ones first. Throws
  /// std::invalid_argument if there are no starts, the step is not positive and finite or an option is out of
  /// range. Cost: some tenth of a trial.
  step_judge(model system, const phase_points& starts, double step, const judging_options& options = {});
  ~step_judge();
  step_judge(step_judge&&) noexcept;             ///< takes over what is known
  step_judge& operator=(step_judge&&) noexcept;  ///< takes over what is known

  /// Judgement of a method at the step. Not to be called by two threads at once. Throws std::invalid_argument
  /// if the method does not suit the system. Cost: a trial of at most `work`, less where trajectories are
  /// lost.
  judgement of(const nysalt::method& method) const;

 private:
  struct known;
  std::unique_ptr<const known> known_;
};

/// The judgement of one method, see step_judge.
judgement judge(const model& system, const phase_points& starts, const nysalt::method& method, double step,
                const judging_options& options = {});

}  // namespace nysalt
