// SPDX-License-Identifier: BSL-1.0
// Methods as source text for other languages and codes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "exported_method.hpp"

namespace nysalt::program {

/// A language or code that a method is exported to.
struct export_host {
  std::string_view name;    ///< as --to takes it
  std::string_view what;    ///< what the file holds
  std::string_view suffix;  ///< of the file's name
  std::string (*text)(
      const exported_method&);  ///< the file; throws refusal where the host cannot take the word
};

/// All of them, in the order of docs/program.md.
const std::vector<export_host>& export_hosts();

/// The one of that name. Throws refusal, naming those that are known.
const export_host& find_export_host(const std::string& name);

/// The name as an identifier: letters, digits and underscores, with a letter first.
std::string identifier_of(std::string_view name);

// One file each.
std::string export_to_c(const exported_method& method);
std::string export_to_cpp(const exported_method& method);
std::string export_to_fortran(const exported_method& method);
std::string export_to_python(const exported_method& method);
std::string export_to_julia(const exported_method& method);
std::string export_to_odeint(const exported_method& method);
std::string export_to_sundials(const exported_method& method);
std::string export_to_ase(const exported_method& method);
std::string export_to_blackjax(const exported_method& method);
std::string export_to_mici(const exported_method& method);

}  // namespace nysalt::program
