// SPDX-License-Identifier: BSL-1.0
// Linear systems, whose flow is known.
#pragma once

#include "comparison/checks.hpp"
#include "nysalt/references/exact_linear.hpp"
#include "nysalt/system_declaration.hpp"

namespace nysalt::program {

/// A linear system whose exact flow is the reference, without a bath, unless a fine step is asked for.
/// Throws refusal if the highest frequency has no square.
template <class S>
initial_value_problem with_exact_flow(const S& system, const bath& in, initial_value_problem made) {
  const in_bath<S> put(system, in);
  require_square_of_frequency(system.description(), made.frequency);
  made.has_exact_flow = true;
  if (!in.acts()) made.exact = exact_linear(put);
  return made;
}

}  // namespace nysalt::program
