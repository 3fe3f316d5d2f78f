// SPDX-License-Identifier: BSL-1.0
// What `--method` and `--methods` may name, and the coefficients that it stands for.
#pragma once

#include <optional>
#include <string>

#include "bundled_system.hpp"
#include "method_file.hpp"

namespace nysalt::program {

/// A classical name, s_aia2, learned:FAMILY, or the file of a scheme or table.
struct method_source {
  std::string typed;
  std::optional<tabulated> fixed;     // classical and tables: the same at every step
  std::optional<scheme> learned;      // from a file: at its own step
  std::optional<std::string> family;  // to be learned at each step
  int evaluations_per_step = 0;

  bool is_adaptive() const { return !fixed && !learned && !family; }
};

/// Throws refusal, listing what is known, if the text names nothing.
method_source find_method(const std::string& text);

/// Whether the step is the scheme's own, to 1e-9 relative, as steps are typed in decimals.
bool is_at(const scheme& learned, double step);

/// Why a scheme from a file is not valid here; empty if it is.
std::string out_of_place(const scheme& learned, const bundled_system& system, double step);

/// The coefficients of a source that needs no learning. A scheme that is out of place is refused unless
/// `force`; then a warning is added, and also where the step is not linearly stable for the system.
tabulated coefficients_at(const method_source& source, const bundled_system& system, double step, bool force,
                          std::vector<std::string>& warnings);

}  // namespace nysalt::program
