// SPDX-License-Identifier: BSL-1.0
// Methods beside each other: which at which step, how far they err, and what they cost.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bundled_system.hpp"
#include "json.hpp"
#include "method_source.hpp"
#include "nysalt/report/work_precision.hpp"
#include "progress.hpp"

namespace nysalt::program {

/// One method at one step.
struct row {
  std::string method;  // as typed
  double nominal;      // the step as typed: of a whole step, or (equal cost) of an evaluation
  double step;         // that is taken
  std::optional<tabulated> coefficients{};
  std::string reason{};  // why there is no error
  double evaluations_per_time = 0.0;
  double seconds_per_time = 0.0;
  estimate error{};  // or, of the metric acceptance, the acceptance
  std::optional<double> reference_error{};
  std::int64_t diverged = 0;
  // Of the metrics distribution and acf.
  std::optional<double> floor{};  // what sampling alone would make of the error
  std::optional<gathered_statistics> statistics{};
};

class comparison {
 public:
  /// Plans the rows. Throws refusal for whatever cannot be, before any work is done.
  comparison(const compare_command& command, const common_settings& common);

  void learn_and_measure();

  bool has_result() const;
  const std::vector<std::string>& warnings() const { return warnings_; }

  json document() const;
  std::string readable() const;
  /// Tables and pictures.
  void write(const std::filesystem::path& folder) const;

 private:
  void require_sound_command() const;
  void plan_rows();
  void add_row(const method_source& source, double nominal);
  trajectories_plan plan_at(double step) const;
  void require_sound_statistics() const;
  void learn_for(row& its, const method_source& source);
  void measure_errors();
  void measure_at(double step, const std::vector<row*>& group);
  /// Those with coefficients that may be used; of the others only the cost is told.
  std::vector<row*> usable(const std::vector<row*>& group, const trajectories_plan& plan) const;
  void measure_seconds();
  void warn_of_reference();

  bool is_acceptance() const { return command_.metric == "acceptance"; }
  /// What the column of results is called.
  std::string value_name() const { return is_acceptance() ? "acceptance" : "error"; }
  bool is_better(const row& a, const row& b) const {
    return is_acceptance() ? a.error.mean > b.error.mean : a.error.mean < b.error.mean;
  }
  void measure_acceptance_at(double step, const std::vector<row*>& group);

  bool is_statistical() const { return command_.metric == "distribution" || command_.metric == "acf"; }
  statistics_plan statistics_at(double step) const;
  void prepare_bins();
  void measure_statistics_at(double step, const std::vector<row*>& group);
  std::vector<gathered_statistics> references_at(double step);
  void require_samples_in_range(std::span<const gathered_statistics> all) const;

  std::string quantity() const;
  std::vector<work_precision_row> work_precision_rows() const;
  std::string at_equal_cost(bool markdown) const;
  std::vector<figure> pictures_of_statistics() const;

  compare_command command_;
  common_settings common_;
  std::unique_ptr<bundled_system> system_;
  std::map<std::string, method_source> families_;  // of the methods that are learned, by what was typed
  std::vector<row> rows_;
  json fits_ = json::array();
  json references_ = json::array();
  std::vector<std::string> warnings_;
  std::optional<equal_bins> bins_;
  std::map<double, std::vector<gathered_statistics>> reference_statistics_;  // by step
  progress shown_;
};

}  // namespace nysalt::program
