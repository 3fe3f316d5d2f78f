// SPDX-License-Identifier: BSL-1.0
// Cost beside error: force evaluations, seconds, the cost at an error, and which methods are on the front.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <span>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/method.hpp"
#include "nysalt/model.hpp"

// Force evaluations of a trajectory.

namespace nysalt {

namespace detail {
std::int64_t evaluations_of_run(const model& system, const method& method, double step, std::int64_t steps,
                                const phase_point<double, Eigen::Dynamic>& start);
}  // namespace detail

/// Force evaluations of one whole trajectory of `steps` steps that is observed once, at the end, start-up
/// included: those that follow from the word; of a black box counted over the first two steps, as every step
/// after them costs the same.
template <SeparableSystem S>
std::int64_t evaluations_of_run(const S& system, const method& method, double step, std::int64_t steps,
                                const phase_point<double, S::dimension>& start) {
  return detail::evaluations_of_run(system, method, step, steps, {start.q, start.p});
}

// The cost or step at which an error crosses a level.

/// An error at a step, or at a cost; NaN or infinite where all diverged.
struct error_at {
  double x;               ///< a step, or a cost
  double error;           ///< error at that step or cost
  double standard_error;  ///< standard error of the error
};

/// Crossing of an error level. Unknown values are NaN; if it is bracketed, x is the last that is below.
struct threshold_crossing {
  /// found             at x, between two errors that are known
  /// bracketed         between last_below and first_above, of which one has no logarithm: it diverged, or is
  /// 0 below_all         not up to the last row: beyond x above_from_first  before the first row: before x
  enum class crossing_kind { found, bracketed, below_all, above_from_first };

  crossing_kind kind;  ///< kind of the crossing
  double x;            ///< the step or cost of the crossing, see crossing_kind
  double standard_error = std::numeric_limits<double>::quiet_NaN();  ///< standard error of x, if it is found
  double last_below = std::numeric_limits<double>::quiet_NaN();      ///< x of the last row below the level
  double first_above =
      std::numeric_limits<double>::quiet_NaN();  ///< x of the first row at or above the level
};

/// The step or cost where errors first reach a level, from the accurate end on: rows are sorted by rising
/// steps, or by falling costs. Between the last row below and the first at or above it, errors are a power of
/// the step or cost,
///
///   ln x* = (1 - s) ln x_0 + s ln x_1,   s = (ln level - ln e_0)/(ln e_1 - ln e_0),
///
/// and by the delta method, with w = (ln x_1 - ln x_0)/(ln e_1 - ln e_0), a = (1 - s) w d_0/e_0 and
/// b = s w d_1/e_1 for the standard errors d of e,
///
///   (standard error of ln x*)^2 = a^2 + b^2 + 2 correlation a b.
///
/// Rows on the same trajectories are correlated: both errors are large where starts are bad, and move x* the
/// same way. Then 0 makes the standard error too small, by sqrt 2 at most, and 1 is never too small. That the
/// power changes between two rows is not in it. Errors that are not finite are above any level.
///
/// Throws std::invalid_argument if there is no row, an abscissa is not positive and finite, they are not
/// sorted, an error is negative, or the level is not positive and finite.
threshold_crossing threshold(std::span<const error_at> rows, double level, double correlation = 0.0);

/// Seconds of a job over some rounds. What else the machine does only adds: the least is nearest to the job's
/// own, and how far the median lies above it measures how quiet the machine was.
struct timed_job {
  double least = std::numeric_limits<double>::infinity();    ///< minimum over all rounds, in seconds
  double median = std::numeric_limits<double>::quiet_NaN();  ///< median over all rounds, in seconds
  int rounds = 0;                                            ///< rounds that count
};

/// Times each job over `rounds` rounds in which all take turns: a machine that slows down slows all of them.
/// One round more goes first, uncounted.
std::vector<timed_job> interleaved_seconds(const std::vector<std::function<void()>>& jobs, int rounds);

/// A point of a diagram of cost and error, in any units.
struct cost_and_error {
  double cost;   ///< less is better
  double error;  ///< less is better
};

/// The Pareto front: points of which no other has less or as much of both. Of equals the first counts; what
/// is not finite never does. Indices, by rising cost and falling error. Cost: a sort.
std::vector<std::size_t> pareto_front(std::span<const cost_and_error> all);

}  // namespace nysalt
