// SPDX-License-Identifier: BSL-1.0
// A figure as gnuplot reads it: data and a script. Of gnuplot 5.4, which has keyentry.
#pragma once

#include <string>

#include "figure.hpp"

namespace nysalt::detail {

/// One block a curve, in the order of the panels: x, y, error, and 1 if hollow where some are. Points that
/// are not finite leave a gap.
std::string plot_data(const figure& f);

std::string plot_script(const figure& f);

}  // namespace nysalt::detail
