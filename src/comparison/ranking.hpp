// SPDX-License-Identifier: BSL-1.0
// Ranking of the rows of a comparison: which count, and which wins at which cost.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "comparison.hpp"
#include "nysalt/analysis/cost_against_error.hpp"
#include "verdict.hpp"

namespace nysalt::program {

/// Why a value is to be taken with care, in the words of the report.
enum class mark {
  reference,  // the reference's own error is more than a tenth of the value, or three times the floor
  null,       // no better than what stays as it was at the start
  floor,      // no more than sampling makes
  horizon,    // beyond the time for which a path can be followed
  tail,       // few trajectories decide the mean
  formula,    // learned, but a classical method of its cost is as good by the loss
  processed,  // further observations cost evaluations that are not counted
  volume,     // the method is not symplectic
  edge,       // judged near an edge
  loses,      // judged to lose trajectories, or unstable
  diverged    // only of those trajectories that did not diverge (an acceptance is of all)
};
std::string to_string(mark which);
std::string meaning(mark which);

/// The reference of a row; empty where nothing was measured.
const baseline& baseline_of(const comparison& all, std::size_t metric, const row& line);

/// The marks of one finding; none where there is no value.
std::vector<mark> marks_of(const comparison& all, std::size_t metric, const row& line);

/// Whether the row has a value of all trajectories, that says something of the method, and not of chaos or of
/// the reference.
bool is_known(const comparison& all, std::size_t metric, const row& line);
/// The same, and the row is better than doing nothing.
bool is_ranked(const comparison& all, std::size_t metric, const row& line);

/// Whether the rows of a metric are ranked by the median of their trajectories: where few trajectories decide
/// the mean of any row that counts.
bool is_by_median(const comparison& all, std::size_t metric);
/// The number that a row is ranked by, with its standard error: the mean, or the median.
estimate ranked_value(const comparison& all, std::size_t metric, const row& line);

/// A learned method, and the best of the others that cost no more evaluations.
struct at_equal_cost {
  const row* learned;
  const row* best;
};
std::vector<at_equal_cost> side_by_side(const comparison& all, std::size_t metric);

/// The factor by which the error of the learned one is smaller; of acceptances, that of what is rejected. Its
/// standard error is that of the differences trajectory by trajectory, which both share; of medians and
/// distributions that of independent numbers, which is too large where what is shared makes both err alike.
/// NaN where nothing is rejected.
estimate gain(const comparison& all, std::size_t metric, const at_equal_cost& pair);

/// Rows that none of the ranked beats in cost and error, from the cheapest on; errors below the floor are
/// ties.
std::vector<const row*> pareto_front(const comparison& all, std::size_t metric, double (*cost)(const row&));
double evaluations_of(const row& line);
double seconds_of(const row& line);

/// The ranked rows with the least errors at costs that the rows span; errors below the floor are ties.
std::vector<best_at_cost> best_by(const comparison& all, std::size_t metric, double (*cost)(const row&));

/// The costs at which a method's error comes to a level, in evaluations and in seconds a unit of time.
struct cost_at_level {
  std::string method;
  bool is_learned;
  threshold_crossing evaluations;
  threshold_crossing seconds;
};
/// The errors at which costs are given: those that were asked for, or the power of ten, or twice or five
/// times it, that most methods cross, the learned and the others; of equals the one in the middle. Empty
/// where none crosses any.
std::vector<double> levels_for(const comparison& all, std::size_t metric);
/// Of methods with ranked rows; the cheapest in evaluations first, then those of which that is not known.
std::vector<cost_at_level> costs_at(const comparison& all, std::size_t metric, double level);

/// A reference that errs like a method says nothing of it: one sentence a metric.
std::vector<std::string> warnings_of_reference(const comparison& all);

}  // namespace nysalt::program
