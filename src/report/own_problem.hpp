// SPDX-License-Identifier: BSL-1.0
// A problem of a caller of the library, prepared as the program prepares its systems.
#pragma once

#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "comparison/prepared_problem.hpp"
#include "comparison/progress.hpp"
#include "comparison/refusal.hpp"
#include "nysalt/comparison_options.hpp"

namespace nysalt::program {

/// Examined, and with the starts of its bath where there is one. Throws refusal.
std::unique_ptr<prepared_problem> prepared(initial_value_problem problem);

/// With a whole seed and some threads. Throws refusal.
common_settings settings_of(const common_options& common);

/// Hears what the caller asks to be told, while it lives.
class told_caller {
 public:
  explicit told_caller(const common_options& common);

 private:
  quiet_caller caller_;
  std::optional<work_for> work_;  // nothing: the caller asks for nothing
};

/// The result of work(); a refusal becomes std::invalid_argument.
auto with_cpp_exceptions(const auto& work) {
  try {
    return work();
  } catch (const refusal& problem) {
    throw std::invalid_argument(problem.what());
  }
}

}  // namespace nysalt::program
