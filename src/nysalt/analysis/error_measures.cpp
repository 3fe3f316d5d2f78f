// SPDX-License-Identifier: BSL-1.0

#include "nysalt/analysis/error_measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

double error_measure::score(double sum, double weights) const {
  const double mean = sum / weights;
  return how == averaging::root_of_each ? std::sqrt(mean) : mean;
}

double error_measure::unit(std::span<const double> sizes) const {
  if (!relative_to || sizes.empty()) return 1.0;
  const double mean = mean_and_error(sizes).mean;
  return how == averaging::mean ? mean : std::sqrt(mean);
}

estimate error_measure::average(std::span<const double> scores, std::span<const double> sizes) const {
  const estimate mean = mean_and_error(scores);
  const double root = how == averaging::root_of_all ? std::sqrt(mean.mean) : mean.mean;
  if (relative_to && !sizes.empty())
    return {root / unit(sizes), mean_and_error(parts(scores, sizes)).standard_error};
  if (how != averaging::root_of_all || mean.mean == 0.0) return mean;
  return {root, mean.standard_error / (2.0 * root)};
}

std::vector<double> error_measure::parts(std::span<const double> scores,
                                         std::span<const double> sizes) const {
  std::vector<double> result(scores.begin(), scores.end());
  const double mean = mean_and_error(scores).mean;
  const bool is_root = how == averaging::root_of_all && mean != 0.0;
  const double root = is_root ? std::sqrt(mean) : mean;
  if (is_root) {
    for (double& x : result) x = root + (x - mean) / (2.0 * root);
  }
  if (!relative_to || sizes.empty()) return result;
  const double unit_of_all = unit(sizes);
  const double power = how == averaging::mean ? 1.0 : 0.5;
  const double slope = power * root / mean_and_error(sizes).mean;
  double seen = 0.0;  // the mean size of those that count
  double count = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    if (std::isnan(scores[i])) continue;
    seen += sizes[i];
    count += 1.0;
  }
  seen /= count;
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = (result[i] - slope * (sizes[i] - seen)) / unit_of_all;
  }
  return result;
}

std::vector<double> error_measure::of_each(std::span<const double> scores,
                                           std::span<const double> sizes) const {
  std::vector<double> result(scores.begin(), scores.end());
  const double unit_of_all = unit(sizes);
  for (double& x : result) x = (how == averaging::root_of_all ? std::sqrt(x) : x) / unit_of_all;
  return result;
}

namespace {

/// One term of the sums w_k x_k over q and y_k over p.
struct term {
  std::size_t row;  ///< k
  Eigen::Index coordinate;
  double of_q;
  double of_p;
};

/// All terms: those of the modal coordinates, or of M^{1/2} q and M^{-1/2} p where there are no modes.
std::vector<term> terms_of(const model& system) {
  std::vector<term> result;
  if (has_modes(system)) {
    const auto modes = detail::modal_coordinates::of(system);
    for (const auto& [i, k, heavy, light] : modes->entries()) {
      const auto row = static_cast<std::size_t>(k);
      const double omega = modes->frequencies()[row];
      result.push_back({row, i, omega == 0.0 ? heavy : omega * heavy, light});
    }
    return result;
  }
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    const double root = root_mass(system, i);
    result.push_back({static_cast<std::size_t>(i), i, root, 1.0 / root});
  }
  return result;
}

}  // namespace

error_measure state_measure(const model& system) {
  const auto n = static_cast<std::size_t>(system.size());
  const auto terms = std::make_shared<const std::vector<term>>(terms_of(system));
  const auto read = [n, terms]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    std::fill(result.begin(), result.end(), T(0.0));
    for (const auto& [k, i, of_q, of_p] : *terms) {
      result[k] += x.q[i] * of_q;
      result[n + k] += x.p[i] * of_p;
    }
  };
  const auto error = []<class T>(std::span<const T> seen, std::span<const T> expected) {
    T sum(0.0);
    for (std::size_t k = 0; k < seen.size(); ++k) {
      sum += (seen[k] - expected[k]) * (seen[k] - expected[k]);
    }
    return sum;
  };
  return {.name = "state",
          .width = 2 * n,
          .read = read,
          .error = error,
          .how = averaging::root_of_all,
          .dimension = system.size()};
}

namespace {

/// The square of the difference of the only numbers that are read, and that of the number of the reference.
constexpr auto squared_difference = [](const auto& seen, const auto& expected) {
  const auto difference = seen[0] - expected[0];
  return difference * difference;
};
constexpr auto square = [](const auto& expected) { return expected[0] * expected[0]; };

}  // namespace

error_measure detail::energy_measure(const model& system) {
  const auto read = [system]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    result[0] = energy<T>(system, x);
  };
  return {.name = "energy",
          .width = 1,
          .read = read,
          .error = squared_difference,
          .how = averaging::root_of_all,
          .needs_reference = false,
          .no_scale =
              "the energy error: the energy at the starts, to which the error is relative, must not be 0 at "
              "every start; take other starts, or another measure",
          .relative_to = square,
          .dimension = system.size()};
}

error_measure detail::path_measure(const over_scalars<of_state>& observable, Eigen::Index dimension) {
  const auto read = [observable]<class T>(const phase_point<T, Eigen::Dynamic>& x, std::span<T> result) {
    result[0] = observable(x);
  };
  return {.name = "path",
          .width = 1,
          .read = read,
          .error = squared_difference,
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
    return squared_difference(seen, expected) / square(expected);
  };
  path.scale = [](const auto& expected) { return expected[0]; };
  path.relative_to = {};
  path.no_scale =
      "the relative error: the observable on the reference, to which the error is relative, must not be 0 "
      "or change its sign; take the path error, or another observable";
  return path;
}

}  // namespace nysalt
