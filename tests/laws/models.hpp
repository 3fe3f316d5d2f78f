// SPDX-License-Identifier: BSL-1.0
// Systems by their types for tests of templates, and lists of families: a new family is a name in one of
// them. The systems that properties are tried on are in specimens.cpp.
#pragma once

#include <tuple>

#include "../support/parameters.hpp"
#include "../support/systems.hpp"
#include "laws.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/gradient_composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/methods/phase_fitted.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/textbook.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

namespace nysalt::test {

/// Three masses on two springs, held by nothing: one frequency is zero.
inline linear_chain free_chain() {
  return linear_chain(Eigen::Matrix3d{{2.0, -2.0, 0.0}, {-2.0, 5.0, -3.0}, {0.0, -3.0, 3.0}},
                      Eigen::Vector3d(1.0, 2.0, 5.0));
}

/// Two masses of different weight, the linear spring between them split off: one frequency is zero.
inline auto split_masses() {
  return with_quadratic_part(two_masses(), Eigen::Matrix2d{{1.0, -1.0}, {-1.0, 1.0}});
}

/// A ring of wells, its springs split off: of a dynamic dimension, and one frequency is zero.
inline auto split_ring() {
  const Eigen::Matrix3d springs{{2.0, -1.0, -1.0}, {-1.0, 2.0, -1.0}, {-1.0, -1.0, 2.0}};
  return with_quadratic_part(dynamic_potential(), springs);
}

using all_families =
    std::tuple<nystrom, aba<2>, aba<4>, aba<5>, aba<6>, bab<2>, bab<3>, bab<4>, bab<5>, bab<6>, aba3_free,
               aba4_free, aba6_free, bab6_free, fg_chin, fg4, fd_chin, r_aba<2>, r_aba<4>, r_aba<6>, r_fg4>;

/// Phase-fitted members of a family, which are the classical method for small steps.
template <Family F, class M>
struct fitted {
  using family = F;
  using classical = M;
  static method at(double z) { return phase_fitted(F(), M(), z); }
};
using fitted_methods = std::tuple<fitted<fg_chin, chin4a>, fitted<fg4, omelyan_fg4>, fitted<aba<4>, pefrl>,
                                  fitted<bab<4>, vefrl>, fitted<aba<5>, mclachlan5>,
                                  fitted<bab<5>, omelyan5v>, fitted<bab<6>, srkn6b>>;

template <Family F>
detail::parameters_of<F> random_theta(draws& random) {
  return array_of<std::size_t{F::parameters}>(random_theta(family(F()), random));
}

/// Calls f.operator()<Model>() for each model in a list.
template <class List>
void for_each(auto&& f) {
  [&]<class... Model>(std::tuple<Model...>*) {
    (f.template operator()<Model>(), ...);
  }(static_cast<List*>(nullptr));
}

}  // namespace nysalt::test
