// SPDX-License-Identifier: BSL-1.0
// Results of a comparison: plain numbers, which a work file keeps and a report shows.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "described.hpp"
#include "nysalt/analysis/ensemble_statistics.hpp"
#include "nysalt/analysis/statistics.hpp"
#include "nysalt/analysis/trajectory_errors.hpp"
#include "nysalt/divergence.hpp"

namespace nysalt::program {

/// The distribution of an observable, or its autocorrelation, as it is drawn.
struct drawn_law {
  std::vector<double> x;  // values, or lags
  std::vector<double> y;  // density, or normalised autocovariance
  estimate mean{};
  double effective_sample_size = 0.0;
  std::optional<double> kinetic_temperature{};  // both temperatures: of a histogram only
  std::optional<double> half_step_kinetic_temperature{};
};
drawn_law drawn(const gathered_statistics& found);

/// Result of one method at one step, by one metric.
struct measurement {
  estimate value{};         // an error; of the metric acceptance that
  std::string reason = {};  // why there is none
  std::int64_t diverged = 0;
  std::vector<diverged_trajectory> diverged_at{};  // the first hundred, in the order of their numbers
  std::optional<drawn_law> law{};
  std::optional<method_error::distribution> spread{};  // of single trajectories, along paths
  std::vector<double> groups{};  // what groups of trajectories have in the value, see means_of_groups()

  /// Of that number of trajectories; says why if none is left.
  void lose(const std::vector<diverged_trajectory>& lost, std::int64_t trajectories);
};

/// NaN where there is none.
method_error::distribution spread_of(const measurement& outcome);

/// Means over up to 1024 groups of as many trajectories each, in their order; those that are left over are
/// left out. Two methods on the same trajectories differ by the mean of the differences of theirs, known as
/// well as by all trajectories, and a work file has room for that many numbers.
std::vector<double> means_of_groups(const std::vector<double>& of_each);

/// Along the horizon.
struct energy_course {
  std::vector<double> t;
  std::vector<double> deviation;  // root mean square of H(t) - H(0), over the trajectories that survive
  std::vector<double> surviving;  // share of the trajectories
};

/// Reference, null model and floor of the measurements at one step, by one metric. What a metric has not is
/// left out.
struct baseline {
  std::string reference = {};                 // description of the reference
  std::optional<double> reference_error{};    // the error of the reference itself
  std::optional<double> null_model{};         // the error of what stays as it was at the start
  std::optional<double> predictable_until{};  // infinite: to the end
  std::optional<double> floor{};              // the distance that is due to sampling
  std::optional<drawn_law> law{};             // of the reference
};

/// All methods at one step by one metric, in the order of their rows.
struct measured {
  baseline against{};
  std::vector<measurement> measurements{};
};

/// By the index of the metric, and the size of the step.
using baselines = std::map<std::pair<std::size_t, double>, baseline>;

NYSALT_DESCRIBED(estimate, mean, standard_error)
NYSALT_DESCRIBED(diverged_trajectory, trajectory, step)
NYSALT_DESCRIBED(tail, count, skewness, deciding)
NYSALT_DESCRIBED(method_error::distribution, largest, median, quantiles)
NYSALT_DESCRIBED(drawn_law, x, y, mean, effective_sample_size, kinetic_temperature,
                 half_step_kinetic_temperature)
NYSALT_DESCRIBED(measurement, value, reason, diverged, diverged_at, law, spread, groups)
NYSALT_DESCRIBED(energy_course, t, deviation, surviving)
NYSALT_DESCRIBED(baseline, reference, reference_error, null_model, predictable_until, floor, law)
NYSALT_DESCRIBED(measured, against, measurements)

// Of what a work file holds, which people may have edited. Each throws std::exception for what is not whole:
// of another kind, or of other lengths than the members of one result, the number of metrics or rows, or that
// of all trajectories ask for.
void require_whole(const drawn_law& law);
void require_whole(const energy_course& course);
void require_whole(const measurement& outcome);
measurement measurement_from(const json& text, std::int64_t trajectories);
std::vector<measured> measured_from(const json& text, std::size_t metrics, std::size_t rows,
                                    std::int64_t trajectories);

}  // namespace nysalt::program
