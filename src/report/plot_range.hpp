// SPDX-License-Identifier: BSL-1.0
#pragma once

#include "figure.hpp"

namespace nysalt::detail {

struct log_range {
  double low = 0.0;
  double high = 0.0;
  int outside = 0;  // points

  bool is_empty() const { return !(low > 0.0); }
};

/// Of y on a logarithmic axis: all points within Tukey's outer fences of log10 y, three interquartile ranges
/// from the quartiles and at least three decades, as an error of 1e30 would leave the others a line. Levels
/// are always within, and points up to ten times the highest: there is where an error is compared.
log_range range_of_logarithms(const panel& plot);

/// Of x on a logarithmic axis, with a margin; empty where there is no positive point.
log_range range_of_costs(const panel& plot);

}  // namespace nysalt::detail
