// SPDX-License-Identifier: BSL-1.0
// Methods at one cost, or at one error, and who of them wins.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "method_source.hpp"
#include "paired_ratio.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// Where on the grid of steps the error was below the one asked for, and where above.
struct bracket {
  std::optional<int> below;
  int above;
  bool has_failed = false;  // `above` was tried; else it is the end of the grid
  bool is_fine = false;     // all trajectories, and searches from all starts
  bool is_found = false;
  bool is_given_up = false;
  std::map<int, std::vector<double>> thetas;  // that were learned
};

/// Errors of a method on some trajectories.
struct measured_error {
  estimate mean{};
  std::vector<double> scores{};  // of each trajectory
  bool is_heavy = false;         // the tail of the scores is too heavy for a mean and a standard error
  std::int64_t diverged = 0;
  std::int64_t trajectories = 0;
};

/// A method that may win, and what was found of it at its step.
struct candidate {
  method_source source;
  std::optional<placement> where;  // of the letters O of a family that is learned
  int order = 0;
  bool symmetric = false;
  bool is_symplectic = true;
  bool rotates = false;
  double step = 0.0;
  std::optional<learned_scheme> learned{};
  std::int64_t learned_from = 0;  // trajectories
  bool is_searched_for = false;   // from all starts
  std::optional<nysalt::method> method{};
  bracket search{};
  std::string reason{};         // why the candidate cannot win
  bool is_left_behind = false;  // in a race, on few trajectories, which is the reason
  measured_error error{};
  std::optional<measured_error> confirmed{};  // on trajectories on which nothing was chosen
  double evaluations_per_time = std::numeric_limits<double>::quiet_NaN();
  double seconds_per_time = std::numeric_limits<double>::quiet_NaN();
  std::optional<double> reference_error{};
  std::string reference{};

  bool is_learned() const { return source.family.has_value(); }
  /// The candidate was measured, and stayed with the reference on every trajectory.
  bool is_eligible() const { return reason.empty() && has_error(); }
  /// That, or it was so on the trajectories on which it was left behind.
  bool is_ranked() const { return (reason.empty() || is_left_behind) && has_error(); }
  bool has_error() const { return !error.scores.empty() && error.diverged == 0; }
};

enum class cost_unit { evaluations, seconds };

/// Candidates at one cost, ranked by error; or at one error, ranked by cost. One of them wins if it differs
/// by more than chance, the grid of steps and the resolution of the clock.
struct contest {
  cost_unit unit;
  std::optional<double> budget;  // cost per unit time; nothing: at one error
  double cost_ratio;             // how far costs must differ to count as different, at one error
  error_statistic statistic;
  std::vector<candidate> all{};

  double cost_of(const candidate& contender) const {
    return unit == cost_unit::evaluations ? contender.evaluations_per_time : contender.seconds_per_time;
  }
  double error_of(const candidate& contender) const { return statistic(contender.error.scores); }

  /// The accepted candidates, best first.
  void rank();
  /// The best accepted candidate; null if there is none.
  const candidate* best_of(bool learned) const;
  const candidate* best() const;
  bool has_result() const { return best() != nullptr; }
  /// The winner, or null where the best of both kinds do not differ significantly.
  const candidate* winner() const;
  /// The candidate to take: the winner, and of a tie the one that needs no learning; null if there is none.
  const candidate* taken() const;
  /// The error of one over that of the other, on the trajectories that confirm both, or else on those of the
  /// ranking.
  ratio_estimate error_ratio(const candidate& a, const candidate& b) const;
  /// "learned", "classical", "tie" or "none"
  std::string verdict() const;

 private:
  bool is_better(const candidate& a, const candidate& b) const;
};

}  // namespace nysalt::program
