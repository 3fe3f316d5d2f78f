// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/error_measures/path.hpp"

#include <span>

#include "nysalt/analysis/error_measures/relative.hpp"

namespace nysalt {

error_measure detail::path_measure(const over_scalars<of_state>& observable, Eigen::Index dimension) {
  const auto read = [observable]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    result[0] = observable(x);
  };
  const auto error = [](const auto& seen, const auto& expected) {
    const auto difference = seen[0] - expected[0];
    return difference * difference;
  };
  const auto square = [](const auto& expected) { return expected[0] * expected[0]; };
  return {.name = "path",
          .width = 1,
          .read = read,
          .error = error,
          .how = averaging::root_of_each,
          .no_scale =
              "the path error: the observable on the reference, to which the error is relative, must not be "
              "0; take another observable, or measure states",
          .relative_to = square,
          .dimension = dimension};
}

error_measure detail::relative_measure(error_measure path) {
  path.name = "relative";
  path.error = [](const auto& seen, const auto& expected) {
    const auto difference = seen[0] - expected[0];
    return difference * difference / (expected[0] * expected[0]);
  };
  path.scale = [](const auto& expected) { return expected[0]; };
  path.relative_to = {};
  path.no_scale =
      "the relative error: the observable on the reference, to which the error is relative, must not be 0 "
      "or change its sign; take the path error, or another observable";
  return path;
}

}  // namespace nysalt
