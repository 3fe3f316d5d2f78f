// SPDX-License-Identifier: BSL-1.0
// A potential as text becomes the source of a system.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace nysalt::program {

/// A system of unit or given masses whose potential energy V(q) is a formula, as typed.
struct typed_potential {
  std::string text;                     // empty: there is none
  std::vector<std::string> variables;   // the coordinates, in their order: x, or q[16] for sixteen
  std::vector<std::string> parameters;  // name=value
  std::vector<double> masses;           // one, or one for each coordinate; empty: all 1
  std::vector<std::string> around;      // name=value: where the starts are; 0 where nothing is said
};

/// The source of the system H = sum p_i^2/(2 m_i) + V(q). The grammar knows numbers, names that are declared,
/// + - * / ^, parentheses, sum(i, first, last, term), q[i + 1], pi, e and functions; what is written into the
/// source is made anew of these. Throws refusal, with the place, for any other text.
///
/// Parameters of the system are those of V, whose values are not part of the source, and deviation_q and
/// deviation_p of the starts.
std::string source_of(const typed_potential& typed);

/// The name of each coordinate: x, or q[1] to q[16] of q[16]. Throws refusal for names that cannot be taken.
std::vector<std::string> coordinate_names(const typed_potential& typed);

/// Values of parameters by their names, which are in lower case as options and files have them. Throws
/// refusal for what is not name=value.
std::vector<std::pair<std::string, std::string>> parameters_of(const typed_potential& typed);

/// The values that were typed for parameters, by name. Throws refusal for what is not name=value.
std::vector<std::pair<std::string, std::string>> values_of(const std::vector<std::string>& typed,
                                                           const std::string& option);

}  // namespace nysalt::program
