// SPDX-License-Identifier: BSL-1.0
#include "nysalt/compare.hpp"

#include <cmath>
#include <limits>
#include <utility>

#include "comparison_report.hpp"
#include "own_problem.hpp"
#include "write_file.hpp"

namespace nysalt {

using program::with_cpp_messages;

class comparison::measurement {
 public:
  measurement(const initial_value_problem& problem, const comparison_options& options,
              const execution_options& execution)
      : all(program::prepared(problem), options, program::settings_of(execution)) {
    program::journal nowhere;
    all.learn_and_measure(nowhere);
  }

  program::comparison all;
};

std::vector<compared_method> comparison::rows() const {
  const auto& all = found_->all;
  std::vector<compared_method> result;
  for (std::size_t m = 0; m < all.metrics().size(); ++m) {
    for (const auto& row : all.rows()) {
      const auto& one = row.measurements[m];
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      result.push_back({.method = row.method,
                        .step = row.step,
                        .metric = all.metrics()[m].text(),
                        .is_learned = row.is_learned,
                        .evaluations_per_time = row.evaluations_per_time,
                        .seconds_per_time = row.seconds_per_time.least,
                        .value = one.reason.empty() ? one.value : estimate{none, none},
                        .diverged = one.diverged,
                        .reason = one.reason});
    }
  }
  return result;
}

std::string comparison::text() const {
  return program::with_arguments(readable(found_->all), program::in_cpp);
}

std::string comparison::json() const { return program::text_of(document_of(found_->all)); }

std::vector<std::string> comparison::warnings() const {
  return program::with_cpp_terms(found_->all.warnings());
}

void comparison::write(const std::filesystem::path& folder) const {
  make_folders(folder);
  write_report(found_->all, folder);
}

comparison compare(const initial_value_problem& problem, const comparison_options& options,
                   const execution_options& execution) {
  return with_cpp_messages([&] {
    return comparison(std::make_shared<const comparison::measurement>(problem, options, execution));
  });
}

comparison report(const initial_value_problem& problem, comparison_options options,
                  const std::filesystem::path& folder, const execution_options& execution) {
  options.energies = true;
  auto found = compare(problem, options, execution);
  found.write(folder);
  return found;
}

}  // namespace nysalt
