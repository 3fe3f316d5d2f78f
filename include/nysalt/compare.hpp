// SPDX-License-Identifier: BSL-1.0
// Methods beside each other on a system of one's own: errors, costs, and the page that reports both.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "nysalt/analysis/statistics.hpp"
#include "nysalt/comparison_options.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt {

/// Result of compare().
class comparison {
 public:
  /// Result of one method at one step by one metric.
  struct row {
    std::string method;           ///< method as requested
    double step;                  ///< size of a whole step
    std::string metric;           ///< metric as requested, with the observable
    bool is_learned;              ///< whether the method was learned, by this comparison, or in a scheme
    double evaluations_per_time;  ///< force evaluations of one trajectory per unit time
    double seconds_per_time;      ///< wall time of one trajectory per unit time, minimum over rounds
    estimate value;         ///< the error (of acceptance the probability) with its standard error; NaN: none
    std::int64_t diverged;  ///< number of diverged trajectories
    std::string reason;     ///< why there is no value; else empty
  };

  class measurement;  ///< internal form of the results
  /// Made by compare().
  explicit comparison(std::shared_ptr<const measurement> found) : found_(std::move(found)) {}

  /// Every method at every step by every metric.
  std::vector<row> rows() const;
  /// The tables that the program prints.
  std::string text() const;
  /// A JSON document of all that was found: what `nysalt compare --json` prints.
  std::string json() const;
  /// Warnings to read before the numbers are used, a sentence each.
  std::vector<std::string> warnings() const;
  /// Writes report.html, with pictures where gnuplot is installed, report.json, rows.csv, and the folder
  /// schemes of what was learned. The folder is made if it is not there. Throws std::runtime_error if it
  /// cannot be written.
  void write(const std::filesystem::path& folder) const;

 private:
  std::shared_ptr<const measurement> found_;
};

/// Errors and costs of methods on a system from its initial distribution; in a warm bath from the Gibbs
/// distribution, where one is found. Where the frequency is 0 it is found along
/// 64 starts. The force is checked against the potential first. Throws std::invalid_argument, naming the
/// option, for bad input, before any work is done. Cost: the trajectories, a reference some ten
/// times finer, and a fit for each learned method and step.
comparison compare(const initial_value_problem& problem, const comparison_options& options,
                   const common_options& common = {});

/// A comparison with a report: a page with tables and pictures in a folder. Parts that are finished stand in
/// report.work there, and the file goes when the report is written: after an interruption the same call goes
/// on from it. Throws std::invalid_argument if that file is of other options, or of a system with other
/// forces at its first starts; std::runtime_error if it cannot be written.
comparison report(const initial_value_problem& problem, comparison_options options,
                  const std::filesystem::path& folder, const common_options& common = {});

}  // namespace nysalt
