// SPDX-License-Identifier: BSL-1.0
// References that take small steps of an accurate method: along the motion, or along a path of noise.
#pragma once

#include "nysalt/method.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// A reference by any method with a small step. SRKN11b (order 6) is the default: at omega h = 5e-3 its error
/// is rounding. It needs a quadratic K(p): of any other, take blanes_moan_s10. A second-order method needs a
/// far smaller step, or what is learned is its error. Each interval must be a positive multiple of the step,
/// to 1e-9 relative. Throws std::invalid_argument unless the step is positive and finite.
reference fine_steps(double step);
reference fine_steps(double step, const nysalt::method& method);

/// A reference by paths of a system in a bath in small steps, with their noise in larger ones; BAOAB is the
/// default. Its error is the difference from a finer one along the same path. Each part of an interval whose
/// noise is kept must be a positive multiple of the step, to 1e-9 relative. Throws std::invalid_argument
/// unless the step is positive and finite, and the method has one letter O.
reference fine_paths(double step);
reference fine_paths(double step, const nysalt::method& method);

}  // namespace nysalt
