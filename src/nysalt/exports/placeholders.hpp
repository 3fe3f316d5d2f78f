// SPDX-License-Identifier: BSL-1.0
// What a template of a host can ask of a method: one table of placeholders, and one of conditions.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "export_template.hpp"
#include "exported_method.hpp"

namespace nysalt::detail {

/// What placeholders and conditions are about.
struct template_subject {
  const exported_method& method;
  const export_template& host;
  const exported_letter* letter = nullptr;  ///< the letter of a loop; null outside loops
  std::size_t index = 0;                    ///< number of letters before it in the loop
};

/// A placeholder: a text that depends on the method.
struct placeholder {
  std::string_view name;
  std::string_view needs;  ///< condition without which there is no such text, or `loop`; empty: none
  std::string (*text)(const template_subject&);
};
std::span<const placeholder> placeholders();

/// A condition that has a name.
struct named_condition {
  std::string_view name;
  bool (*holds)(const exported_method&);
};
std::span<const named_condition> conditions();

/// A word of the method that loops go over.
struct named_word {
  std::string_view name;
  exported_word (*word)(const exported_method&);
};
std::span<const named_word> words();

}  // namespace nysalt::detail
