// SPDX-License-Identifier: BSL-1.0
// What the struct of a family states of its parameters.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>

namespace nysalt {

/// Range of a parameter. Open: the coefficients are not defined at the ends. Closed: the ends may be
/// attained.
struct parameter_range {
  double low;   ///< lower end
  double high;  ///< upper end
  bool open;    ///< whether the ends are excluded

  /// Whether a parameter may be x. NaN may not.
  bool contains(double x) const { return open ? low < x && x < high : low <= x && x <= high; }
};

namespace detail {

/// theta: one number for each parameter of the family F.
template <class F>
using parameters_of = std::array<double, static_cast<std::size_t>(F::parameters)>;

/// Bound of a parameter where a family has none: beyond it coefficients of opposite sign leave less than half
/// of their digits of each other. A search that ends here has found nothing.
inline constexpr double farthest_parameter = 4.0;

}  // namespace detail

/// A classical method that a family contains.
template <int Parameters>
struct classical_member {
  std::string_view name;                                           ///< name of the method
  std::array<double, static_cast<std::size_t>(Parameters)> theta;  ///< parameters of the method in the family
};

}  // namespace nysalt
