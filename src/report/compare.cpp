// SPDX-License-Identifier: BSL-1.0
#include "nysalt/compare.hpp"

#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "comparison_report.hpp"
#include "nysalt/ensemble.hpp"
#include "own_problem.hpp"
#include "write_file.hpp"

namespace nysalt {

using program::with_cpp_exceptions;

class comparison::measurement {
 public:
  measurement(const initial_value_problem& problem, const comparison_options& options,
              const common_options& common)
      : all(program::prepared(problem), options, program::settings_of(common)) {}

  program::comparison all;
};

namespace {

/// What identifies a system in C++, of which a work file has no more than the name: energies and forces, to
/// the bit, at its first starts.
program::json seen_at_starts(const initial_value_problem& problem) {
  program::json seen = program::json::array();
  for (std::int64_t n = 0; n < 4; ++n) {
    const auto start = sound_start(problem.system, problem.starts, 1, n);
    auto f = detail::make_vector<double>(problem.system);
    force<double>(problem.system, start.q, f);
    double sum = 0.0;  // of weights that differ: no two coordinates can be exchanged
    for (Eigen::Index i = 0; i < f.size(); ++i) sum += f[i] / static_cast<double>(i + 1);
    seen.push_back({has_energy(problem.system) ? energy<double>(problem.system, start) : 0.0, sum});
  }
  return seen;
}

}  // namespace

std::vector<comparison::row> comparison::rows() const {
  const auto& all = found_->all;
  std::vector<row> result;
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

std::string comparison::text() const { return readable(found_->all); }

std::string comparison::json() const { return program::text_of(document_of(found_->all)); }

std::vector<std::string> comparison::warnings() const { return found_->all.warnings(); }

void comparison::write(const std::filesystem::path& folder) const {
  make_folders(folder);
  write_report(found_->all, folder);
}

comparison compare(const initial_value_problem& problem, const comparison_options& options,
                   const common_options& common) {
  return with_cpp_exceptions([&] {
    const program::told_caller told(common);
    const auto found = std::make_shared<comparison::measurement>(problem, options, common);
    program::work_file nowhere;
    found->all.learn_and_measure(nowhere);
    return comparison(found);
  });
}

comparison report(const initial_value_problem& problem, comparison_options options,
                  const std::filesystem::path& folder, const common_options& common) {
  options.energies = true;
  return with_cpp_exceptions([&] {
    const program::told_caller told(common);
    const auto found = std::make_shared<comparison::measurement>(problem, options, common);
    auto question = found->all.question();
    question["seen_at_starts"] = seen_at_starts(problem);
    make_folders(folder);
    program::work_file kept(folder / program::work_of_report, question, true);
    found->all.learn_and_measure(kept);
    comparison result(found);
    result.write(folder);
    kept.remove();
    return result;
  });
}

}  // namespace nysalt
