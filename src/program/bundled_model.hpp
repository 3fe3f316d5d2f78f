// SPDX-License-Identifier: BSL-1.0
// What any system with a law of starts can do for the commands.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "bundled_systems.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// Name or parameter of a system, as scheme files hold it.
struct named_value {
  std::string name;
  std::variant<std::int64_t, double, std::string> value;
};

std::unique_ptr<bundled_system> make_bundled(const made_system& made,
                                             const std::vector<named_value>& parameters,
                                             const surroundings& conditions);

/// A linear system whose exact flow is the reference, without a bath, unless a fine step is asked for.
template <class S>
made_system with_exact_flow(const S& system, const bath& in, made_system made) {
  const in_bath<S> put(system, in);
  made.has_exact_flow = true;
  if (!in.acts()) made.exact = nysalt::detail::reference_of(put, exact_linear(put));
  return made;
}

}  // namespace nysalt::program
