// SPDX-License-Identifier: BSL-1.0
// Systems by their types for tests of templates, and lists of families: a new family is a name in one of
// them. The systems that properties are tried on are in specimens.cpp.
#pragma once

#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "../support/draws.hpp"
#include "../support/systems.hpp"
#include "nysalt/families/aba.hpp"
#include "nysalt/families/bab.hpp"
#include "nysalt/families/fd_chin.hpp"
#include "nysalt/families/fg4.hpp"
#include "nysalt/families/fg_chin.hpp"
#include "nysalt/families/free_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/families/r_aba.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

namespace nysalt::test {

/// Three masses on two springs, held by nothing: one frequency is zero.
inline linear_chain free_chain() {
  Eigen::MatrixXd stiffness(3, 3);
  stiffness << 2.0, -2.0, 0.0, -2.0, 5.0, -3.0, 0.0, -3.0, 3.0;
  return linear_chain(stiffness, Eigen::Vector3d(1.0, 2.0, 5.0));
}

/// Two masses of different weight, the linear spring between them split off: one frequency is zero.
inline auto split_masses() {
  Eigen::Matrix2d spring;
  spring << 1.0, -1.0, -1.0, 1.0;
  return with_quadratic_part(two_masses(), spring);
}

/// A ring of wells, its springs split off: of a dynamic dimension, and one frequency is zero.
inline auto split_ring() {
  Eigen::Matrix3d springs;
  springs << 2.0, -1.0, -1.0, -1.0, 2.0, -1.0, -1.0, -1.0, 2.0;
  return with_quadratic_part(dynamic_potential(), springs);
}

// reach: random coordinates are drawn from -reach..reach, where motion stays bounded.
struct within_one {
  static constexpr double reach = 1.0;
};
struct within_a_half {
  static constexpr double reach = 0.5;
};
struct within_a_quarter {
  static constexpr double reach = 0.25;
};

// clang-format off
struct a_dynamic_fpu : within_a_half { static auto make() { return fpu_chain<>(2, 7.0); } };
struct a_galaxy : within_a_quarter { static auto make() { return henon_heiles(); } };
struct a_black_box : within_one { static auto make() { return black_box(); } };
// clang-format on

template <class... List>
using joined = decltype(std::tuple_cat(std::declval<List>()...));

using families = std::tuple<nystrom, aba<2>, aba<4>, aba<5>, aba<6>, bab<2>, bab<3>, bab<4>, bab<5>, bab<6>,
                            aba3_free, aba4_free, aba6_free, bab6_free>;
using gradient_families = std::tuple<fg_chin, fg4>;
using displaced_families = std::tuple<fd_chin>;
using fitted_methods =
    std::tuple<phase_fitted<fg_chin, chin4a>, phase_fitted<fg4, omelyan_fg4>, phase_fitted<aba<4>, pefrl>,
               phase_fitted<bab<4>, vefrl>, phase_fitted<aba<5>, mclachlan5>, phase_fitted<bab<5>, omelyan5v>,
               phase_fitted<bab<6>, srkn6b>>;
using rotating_families = std::tuple<r_aba<2>, r_aba<4>, r_aba<6>, r_fg4>;

using all_families = joined<families, gradient_families, displaced_families, rotating_families>;

/// A method of each kind by its type.
using methods = std::tuple<verlet, mclachlan_atela4, srkn11b, chin4a, chin4a_displaced, impulse, baoab,
                           member<nystrom>, member<bab<3>>, member<r_fg4>>;

/// A theta well inside the ranges and near the start, where coefficients are of moderate size.
template <Family F>
parameters_of<F> random_theta(draws& random) {
  parameters_of<F> theta = F::start();
  for (std::size_t k = 0; k < theta.size(); ++k) {
    const auto [low, high, open] = F::ranges()[k];
    theta[k] = random.uniform(std::max(low + 0.2 * (high - low), theta[k] - 0.3),
                              std::min(high - 0.2 * (high - low), theta[k] + 0.3));
  }
  return theta;
}

/// Calls f.operator()<Model>() for each model in a list.
template <class List>
void for_each(auto&& f) {
  [&]<class... Model>(std::tuple<Model...>*) {
    (f.template operator()<Model>(), ...);
  }(static_cast<List*>(nullptr));
}

}  // namespace nysalt::test
