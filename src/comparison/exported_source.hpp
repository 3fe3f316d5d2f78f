// SPDX-License-Identifier: BSL-1.0
// From what a user names to the text that is exported.
#pragma once

#include <optional>
#include <string>

#include "method_source.hpp"
#include "nysalt/export_to.hpp"

namespace nysalt::program {

/// Options of an export.
struct export_request {
  std::string name;            ///< identifier in the text; empty: that of the family or method
  std::optional<double> step;  ///< of a scheme over several steps
  std::string placement;       ///< of letters O in a method without them; empty: no bath, or the scheme's own
  bool displaced = false;      ///< gradient kicks become displaced kicks
};

/// A method and the options of its export.
struct export_source {
  nysalt::method method;
  export_options options;
};

/// Throws refusal for a method that is still to be learned or that depends on step and frequency, and for a
/// step at which a scheme was not learned.
export_source exported_from(const method_source& source, const export_request& request);

/// The text for a host, or by the template in a file; one of the two is given, and the other one is empty.
/// Throws refusal for an unknown host, for what is not the language of templates, and where the host cannot
/// take the method.
std::string export_text(const std::string& host, const std::string& template_file,
                        const export_source& source);

}  // namespace nysalt::program
