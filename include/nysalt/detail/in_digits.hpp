// SPDX-License-Identifier: BSL-1.0
// Numbers that are read, not computed with.
#pragma once

#include <string>

namespace nysalt {

/// The number x in decimal, rounded to `digits` significant digits, without the zeros at its end: 0.125 to
/// two is "0.12". With an exponent where it is shorter, as printf's %g has it.
std::string in_digits(double x, int digits);

}  // namespace nysalt
