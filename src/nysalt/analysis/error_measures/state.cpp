// SPDX-License-Identifier: BSL-1.0
#include "nysalt/analysis/error_measures/state.hpp"

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "nysalt/detail/modal_coordinates.hpp"

namespace nysalt {

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
    const auto modes = modal_coordinates::of(system);
    for (const auto& [i, k, heavy, light] : modes->entries()) {
      const auto row = static_cast<std::size_t>(k);
      const double omega = modes->frequencies()[row];
      result.push_back({row, i, omega == 0.0 ? heavy : omega * heavy, light});
    }
    return result;
  }
  for (Eigen::Index i = 0; i < system.size(); ++i) {
    const double root = system.root_mass(i);
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

}  // namespace nysalt
