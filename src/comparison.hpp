// SPDX-License-Identifier: BSL-1.0
// Methods beside each other: which at which step, how far they err, and what they cost.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
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
  estimate error{};
  std::optional<double> reference_error{};
  std::int64_t diverged = 0;
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
  void learn_for(row& its, const std::string& family);
  void measure_errors();
  void measure_at(double step, const std::vector<row*>& group);
  void measure_seconds();
  void warn_of_reference();

  std::string quantity() const;
  std::vector<work_precision_row> work_precision_rows() const;
  std::string at_equal_cost(bool markdown) const;

  compare_command command_;
  common_settings common_;
  std::unique_ptr<bundled_system> system_;
  std::map<std::string, std::string> families_;  // of the methods that are learned, by what was typed
  std::vector<row> rows_;
  json fits_ = json::array();
  json references_ = json::array();
  std::vector<std::string> warnings_;
  progress shown_;
};

}  // namespace nysalt::program
