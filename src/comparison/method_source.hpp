// SPDX-License-Identifier: BSL-1.0
// What `--method` and `--methods` may name, and the coefficients of it.
#pragma once

#include <map>
#include <optional>
#include <string>

#include "catalogue.hpp"
#include "method_file.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// A classical name, an adaptive one, word:LETTERS, learned:FAMILY, or the file of a scheme or table; with
/// @PLACEMENT or without.
struct method_source {
  std::string typed;
  std::optional<method> fixed;                // classical and tables: the same at every step
  std::optional<scheme> learned;              // from a file: at its own step
  std::optional<std::string> family;          // to be learned at each step
  const adaptive_method* adaptive = nullptr;  // of the catalogue: from step and frequency
  std::optional<placement> where;             // of its letters O, if it says so: verlet@end
  int evaluations_to_observe =
      0;  // of a processed method: once before the first step, and for each observation
  int evaluations_per_step = 0;  // of a system whose f'(q) v counts one, until charge() knows which
  int force_derivatives = 0;     // f'(q) v in a step
  std::optional<nysalt::word> word;
};

/// What is held goes before all else. Words and tables may have letters of the system that they are for.
/// Throws refusal, listing what is known, if the text names nothing.
method_source find_method(const std::string& text, const std::map<std::string, std::string>& held = {},
                          const std::vector<letter_facts>& of_system = {});

/// What a step costs with a system: differences of a black box call it twice for each f'(q) v.
void charge(method_source& source, const prepared_problem& system);

/// Why the order of a classical method is not its own on a system: its kinetic energy is not quadratic. Empty
/// where it is.
std::string objection_to_order(const method_source& source, const prepared_problem& system);

/// The frequency that the coefficients follow from, on a system; nothing of other methods, and where none is
/// known.
std::optional<fitted_frequency> frequency_of(const method_source& source, const prepared_problem& system);

/// Whether the step is the scheme's own, to 1e-9 relative, as steps are typed in decimals.
bool is_at(const scheme& learned, double step);

/// Whether a scheme was learned for another size of this kind of system.
bool is_of_other_size(const scheme& learned, const prepared_problem& system);

/// What a scheme from a file must do and does not here, as in "run at the step 0.1, got 0.2"; empty if it is
/// valid here, or may be tried as one of another size.
std::string out_of_place(const scheme& learned, const prepared_problem& system, double step);

/// The coefficients of a source that needs no learning; in a bath with letters O, where `otherwise` says if
/// source does not. A scheme that is out of place is refused unless `force`, and so is one of another size
/// that fails the trial there; a warning says what was used all the same, or tried, and also where the step
/// is not linearly stable for the system, or letters O are left out for want of a bath.
method coefficients_at(const method_source& source, const prepared_problem& system, double step, bool force,
                       std::optional<placement> otherwise, std::vector<std::string>& warnings);

/// What is to be said if a scheme was learned on other energies than those of the starts of a plan, which
/// must be prepared; nothing otherwise, and of another system's scheme. See energies_outside.
std::optional<std::string> warning_of_energies(const method_source& source, const prepared_problem& system,
                                               const trajectories_plan& plan);

/// Where a family that is learned has its letters O: nowhere without a bath. Throws refusal for one that has
/// no central letter.
std::optional<placement> placement_in(const method_source& source, const prepared_problem& system,
                                      std::optional<placement> otherwise);

/// In how many equal parts of a step a method wants the noise of a path; 0 without noise.
int noise_parts(const method& method, const prepared_problem& system);

/// What `--placement` says; nothing if it is empty.
std::optional<placement> placement_asked(const std::string& text);

}  // namespace nysalt::program
