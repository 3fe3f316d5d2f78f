// SPDX-License-Identifier: BSL-1.0
// Methods as source text for other languages and codes.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "nysalt/method.hpp"

namespace nysalt {

/// A language or code that methods are exported to.
struct export_host {
  std::string_view name;    ///< name of the format, an argument of export_to()
  std::string_view what;    ///< content of the text
  std::string_view suffix;  ///< suffix of a file with the text
};

/// All hosts, in the order of docs/how-to/take_it_with_you.md.
std::vector<export_host> export_hosts();

/// Options of an export.
struct export_options {
  /// Identifier in the text; empty: from the method's name.
  std::string name = {};
  /// Lines for the header of the text, such as the origin of the method.
  std::vector<std::string> about = {};
  /// Gradient kicks G become displaced kicks D, of order 4 at most and not symplectic.
  bool displaced = false;
};

/// Source text of the method for a host, with a self-test. Throws std::invalid_argument for an unknown host,
/// and for a method that the host cannot take. Cost: ten steps of two oscillators.
std::string export_to(std::string_view host, const method& method, const export_options& options = {});

/// Source text of the method for a host of one's own, by the template in `text`
/// (docs/how-to/export_template.md); `file` names the template in messages. Throws std::invalid_argument,
/// with file and line, for what is not the language of templates, and for a method that the template cannot
/// take. Cost: as export_to().
std::string export_by_template(std::string_view text, std::string_view file, const nysalt::method& method,
                               const export_options& options = {});

}  // namespace nysalt
