// SPDX-License-Identifier: BSL-1.0
// What the program knows by name.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "nysalt/families/nystrom.hpp"
#include "nysalt/langevin.hpp"
#include "nysalt/losses/metric.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "refusal.hpp"

namespace nysalt::program {

/// Every family that can be learned. A new one is one name here.
using families = std::tuple<nystrom>;

std::vector<std::string> family_names();

/// Calls f(F{}) for the family of that name. Throws refusal, listing the names, if there is none.
template <class Action>
void with_family(std::string_view name, Action&& f) {
  const bool known = std::apply(
      [&](auto... family) { return ((family.name == name && (f(family), true)) || ...); }, families{});
  if (!known) refuse("unknown family '{}': it is one of {}", name, listed(family_names()));
}

/// A member of a family, from its parameters. Throws what is wrong with them, or with the name.
tabulated family_member(const std::string& family, const std::vector<double>& parameters);

/// A classical method whose coefficients are fixed.
struct classical_method {
  tabulated method;
  std::string_view source;  // in docs/bibliography.bib
};
const std::vector<classical_method>& classical_methods();

coordinates coordinates_named(const std::string& name);
placement placement_named(const std::string& name);

/// Methods whose coefficients depend on step times highest frequency.
inline constexpr std::string_view adaptive_method = "s_aia2";

/// All names that `--method` takes, beside files.
std::vector<std::string> method_names();

}  // namespace nysalt::program
