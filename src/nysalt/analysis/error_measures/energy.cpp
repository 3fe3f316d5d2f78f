// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/error_measures/energy.hpp"

#include <span>

namespace nysalt {

error_measure detail::energy_measure(const model& system) {
  const auto read = [system]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    result[0] = energy<T>(system, x);
  };
  const auto error = [](const auto& seen, const auto& at_start) {
    const auto difference = seen[0] - at_start[0];
    return difference * difference;
  };
  const auto square = [](const auto& at_start) { return at_start[0] * at_start[0]; };
  return {.name = "energy",
          .width = 1,
          .read = read,
          .error = error,
          .how = averaging::root_of_all,
          .needs_reference = false,
          .no_scale =
              "the energy error: the energy at the starts, to which the error is relative, must not be 0 at "
              "every start; take other starts, or another measure",
          .relative_to = square,
          .dimension = system.size()};
}

}  // namespace nysalt
