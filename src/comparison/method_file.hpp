// SPDX-License-Identifier: BSL-1.0
// Methods on disk: learned schemes, and users' own coefficient tables.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "json.hpp"
#include "nysalt/learning/reach.hpp"
#include "nysalt/letters.hpp"
#include "nysalt/method.hpp"
#include "prepared_problem.hpp"

namespace nysalt::program {

/// What a scheme file says: a family's parameters at a step or at several, and where they are valid.
/// What scheme files state of a letter of a system, all other facts as usual.
letter_facts as_stated(const letter_facts& of_system);

struct scheme {
  std::string family;
  std::optional<placement> where;  // of its letters O
  theta_curve curve;
  std::string system;  // its description
  std::string kind;    // the same without the size; empty where the system declared none
  std::string source;  // of a system of the user's own: its source and parameters; empty: a bundled one
  bool usable;
  std::string reason;
  std::optional<energy_range> energies;     // that it was learned on
  std::size_t trajectories = 0;             // how many, at the step with the fewest
  std::vector<letter_facts> own_letters{};  // of the system, as they are stated

  /// The method at a step, under the family's name; beyond the curve that of its nearer end.
  method at(double step) const;
  bool is_learned_at(double step) const { return curve.has(step); }
  /// Of the method at any step.
  word letters() const;
  /// "the step 0.03", or "steps from 0.02 to 0.03".
  std::string steps() const;
};

/// Bytes of a scheme or a table, which are far shorter.
inline constexpr std::size_t longest_method_file = std::size_t{1} << 20U;

/// By what a scheme knows a system of the user's own beside its description: the source and all parameters.
/// Empty of a bundled one.
std::string source_of_system(const nlohmann::ordered_json& parameters);

/// The file's text: what was learned at each step, how well, and from what; with a checksum, and nothing of
/// the machine or the hour, which its provenance may add. The plan is that of one of the steps.
json scheme_document(const std::vector<learned_scheme>& learned, const prepared_problem& system,
                     const learn_plan& plan);
inline std::string scheme_text(const std::vector<learned_scheme>& learned, const prepared_problem& system,
                               const learn_plan& plan) {
  return text_of(scheme_document(learned, system, plan));
}

/// The text of a table: the coefficients of any method under a name, with the step and the system that they
/// were chosen for, which say what the table is of and are not checked when it is used.
std::string table_text(const std::string& name, const nysalt::method& method, double step,
                       const prepared_problem& system);

/// A method that was chosen, as the file that `--method` takes: a scheme of what was learned, else a table.
struct chosen_method {
  std::string name;  // as it was typed, or would be
  double step;
  std::string text;  // of the file
};
/// Called with the best so far, each time that another is the best.
using choice_observer = std::function<void(const chosen_method&)>;

struct method_file {
  std::optional<scheme> learned;  // one of the two
  std::optional<method> table;    // its order was found from its coefficients
};

/// Reads either kind. Throws refusal, naming the file, for one that is missing, not whole, edited, foreign or
/// of a newer version, and for coefficients that are not consistent or of a lower order than declared.
/// Tables may have letters of a system, schemes state what theirs are.
method_file read_method_file(const std::filesystem::path& path,
                             const std::vector<letter_facts>& of_system = {});
/// The same from the text of a file, whose name is part of refusals.
method_file method_file_in(const std::string& text, const std::string& file,
                           const std::vector<letter_facts>& of_system = {});

}  // namespace nysalt::program
