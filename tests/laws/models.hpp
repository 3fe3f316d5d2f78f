// SPDX-License-Identifier: BSL-1.0
// What the laws are tried on. A new system or family is one line here (and its name in a list); classical
// methods are the rows of classical_table.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
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
#include "nysalt/methods/s_aia.hpp"
#include "nysalt/methods/tabulated.hpp"
#include "nysalt/systems/fpu_chain.hpp"
#include "nysalt/systems/gaussian.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"
#include "nysalt/systems/henon_heiles.hpp"
#include "nysalt/systems/kepler.hpp"
#include "nysalt/systems/lennard_jones_cluster.hpp"
#include "nysalt/systems/linear_chain.hpp"
#include "nysalt/systems/logistic_regression.hpp"
#include "nysalt/systems/pendulum.hpp"
#include "nysalt/systems/phi4_chain.hpp"
#include "nysalt/systems/phi4_lattice.hpp"
#include "nysalt/systems/with_quadratic_part.hpp"

namespace nysalt::test {

/// Three masses on two springs, held by nothing: one frequency is zero.
inline linear_chain free_chain() {
  Eigen::MatrixXd stiffness(3, 3);
  stiffness << 2.0, -2.0, 0.0, -2.0, 5.0, -3.0, 0.0, -3.0, 3.0;
  return linear_chain(stiffness, Eigen::Vector3d(1.0, 2.0, 5.0));
}

/// Small swings split off.
inline auto split_pendulum() { return with_quadratic_part(pendulum(), Eigen::MatrixXd::Identity(1, 1)); }

/// Two masses of different weight, the linear spring between them split off: one frequency is zero.
inline auto split_masses() {
  Eigen::Matrix2d spring;
  spring << 1.0, -1.0, -1.0, 1.0;
  return with_quadratic_part(two_masses(), spring);
}

/// Atoms that rest.
inline around at_rest(const lennard_jones<>& system) {
  return {cluster_at_rest(system), Eigen::VectorXd::Zero(system.size()), 0.05};
}

/// A ring of wells, its springs split off: of a dynamic dimension, and one frequency is zero.
inline auto split_ring() {
  Eigen::Matrix3d springs;
  springs << 2.0, -1.0, -1.0, -1.0, 2.0, -1.0, -1.0, -1.0, 2.0;
  return with_quadratic_part(dynamic_potential(), springs);
}

/// Four rows of three predictors.
inline logistic_regression a_posterior_of_rows() {
  Eigen::MatrixXd rows(4, 3);
  rows << 1.0, 0.5, -2.0, 1.0, -1.5, 0.3, 1.0, 2.0, 1.0, 1.0, 0.1, -0.7;
  return {rows, Eigen::Vector4d(1.0, 0.0, 1.0, 0.0), 4.0};
}

// clang-format off
// reach: random coordinates are drawn from -reach..reach, where motion stays bounded.
struct within_one { static constexpr double reach = 1.0; };
struct within_a_half { static constexpr double reach = 0.5; };
struct within_a_quarter { static constexpr double reach = 0.25; };

struct an_oscillator : within_one { static auto make() { return harmonic_oscillator(1.7); } };
struct a_chain : within_one { static auto make() { return linear_chain::between_walls(4, 3.0); } };
struct a_free_chain : within_one { static auto make() { return free_chain(); } };
struct an_fpu_chain : within_a_half { static auto make() { return fpu_chain<3>(10.0); } };
struct a_dynamic_fpu : within_a_half { static auto make() { return fpu_chain<>(2, 7.0); } };
struct a_pendulum : within_one { static auto make() { return pendulum(); } };
struct a_galaxy : within_a_quarter { static auto make() { return henon_heiles(); } };
struct a_planet {
  inline static const around reach{Eigen::Vector2d(1.0, 0.0), Eigen::Vector2d(0.0, 1.0), 0.2};  // a circle
  static auto make() { return kepler(); }
};
struct flat_atoms {
  inline static const around reach = at_rest(lennard_jones<>(2, 3));
  static auto make() { return lennard_jones<2, 3>(); }
};
struct atoms_in_space {
  inline static const around reach = at_rest(lennard_jones<>(3, 5));
  static auto make() { return lennard_jones<>(3, 5); }
};
struct a_ring : within_one { static auto make() { return phi4_chain<4>(); } };
struct a_dynamic_ring : within_one { static auto make() { return phi4_chain<>(5); } };
struct a_lattice : within_a_half { static auto make() { return phi4_lattice(3, -1.0, 2.0); } };
struct a_gaussian : within_one { static auto make() { return gaussian(Eigen::Vector3d(0.3, 1.0, 2.5)); } };
struct a_posterior : within_one { static auto make() { return a_posterior_of_rows(); } };
struct a_potential : within_one { static auto make() { return potential_only(); } };
struct a_dynamic_one : within_one { static auto make() { return dynamic_potential(); } };
struct a_black_box : within_one { static auto make() { return black_box(); } };
struct a_differentiable_box : within_one { static auto make() { return black_box_with_derivative(); } };
struct two_weights : within_one { static auto make() { return two_masses(); } };
struct a_split_pendulum : within_one { static auto make() { return split_pendulum(); } };
struct two_split_weights : within_one { static auto make() { return split_masses(); } };
struct a_split_ring : within_one { static auto make() { return split_ring(); } };
struct a_fast_one : within_one { static auto make() { return relativistic(); } };
struct a_faster_one : within_one { static auto make() { return relativistic_with_velocity(); } };
// clang-format on

/// Every system whose force can be differentiated exactly. (a_black_box takes differences.)
using systems = std::tuple<an_oscillator, a_chain, a_free_chain, an_fpu_chain, a_dynamic_fpu, a_pendulum,
                           a_galaxy, a_planet, flat_atoms, atoms_in_space, a_ring, a_dynamic_ring, a_lattice,
                           a_gaussian, a_posterior, a_potential, a_dynamic_one, a_differentiable_box,
                           two_weights, a_fast_one, a_faster_one>;

/// One of each kind, for laws about methods rather than systems: fixed and dynamic, with masses, with a
/// layout of its own, by potential and by force, with a quadratic part of its own or split off, and with
/// another K.
using various_systems =
    std::tuple<a_free_chain, an_fpu_chain, a_galaxy, a_planet, flat_atoms, a_split_pendulum,
               two_split_weights, a_split_ring, a_differentiable_box, a_fast_one, a_faster_one>;

template <class... List>
using joined = decltype(std::tuple_cat(std::declval<List>()...));

template <std::size_t Row>
consteval auto name_of_row() {
  constexpr std::string_view name = classical_table[Row].name;
  char text[name.size() + 1]{};
  std::copy(name.begin(), name.end(), text);
  return detail::method_name<name.size() + 1>(text);
}

struct of_kicks_and_drifts {
  constexpr bool operator()(std::string_view letters) const {
    return letters.find_first_not_of("AB") == std::string_view::npos;
  }
};
template <char Letter>
struct with_letter {
  constexpr bool operator()(std::string_view letters) const {
    return letters.find(Letter) != std::string_view::npos;
  }
};

template <class Kind, std::size_t... Row>
auto chosen_rows(std::index_sequence<Row...>)
    -> joined<std::conditional_t<Kind()(classical_table[Row].letters),
                                 std::tuple<classical<name_of_row<Row>()>>, std::tuple<>>...>;
/// The rows of classical_table whose letters are of that kind.
template <class Kind>
using rows = decltype(chosen_rows<Kind>(std::make_index_sequence<std::size(classical_table)>()));

/// Of those for baths one, as what it is without: its conservative part.
using classical_types = joined<rows<of_kicks_and_drifts>, std::tuple<s_aia2, s_aia3, baoab>>;
using families = std::tuple<nystrom, aba<2>, aba<4>, aba<5>, aba<6>, bab<2>, bab<3>, bab<4>, bab<5>, bab<6>,
                            aba3_free, aba4_free, aba6_free, bab6_free>;
using gradient_methods = rows<with_letter<'G'>>;
using gradient_families = std::tuple<fg_chin, fg4>;
using displaced_methods = rows<with_letter<'D'>>;
using displaced_families = std::tuple<fd_chin>;
using fitted_methods =
    std::tuple<phase_fitted<fg_chin, chin4a>, phase_fitted<fg4, omelyan_fg4>, phase_fitted<aba<4>, pefrl>,
               phase_fitted<bab<4>, vefrl>, phase_fitted<aba<5>, mclachlan5>, phase_fitted<bab<5>, omelyan5v>,
               phase_fitted<bab<6>, srkn6b>>;
using rotating_methods = rows<with_letter<'R'>>;
using rotating_families = std::tuple<r_aba<2>, r_aba<4>, r_aba<6>, r_fg4>;

using all_families = joined<families, gradient_families, displaced_families, rotating_families>;

template <class List>
struct members_of_list;
template <class... F>
struct members_of_list<std::tuple<F...>> : std::type_identity<std::tuple<member<F>...>> {};
template <class List>
using members_of = typename members_of_list<List>::type;

using methods = joined<fitted_methods, classical_types, members_of<families>, gradient_methods,
                       members_of<gradient_families>, displaced_methods, members_of<displaced_families>,
                       rotating_methods, members_of<rotating_families>>;

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

/// The method itself, or a random member of its family (of s_aia2 and s_aia3 where it is not yet Verlet), or
/// one fitted to a random z.
template <Method M>
M any_method(draws& random) {
  if constexpr (requires { typename M::family; }) {
    return M(random_theta<typename M::family>(random));
  } else if constexpr (std::same_as<M, s_aia2>) {
    return M(random.uniform(0.1, 2.8));
  } else if constexpr (std::same_as<M, s_aia3>) {
    return M(random.uniform(0.1, 5.1));
  } else if constexpr (std::constructible_from<M, double>) {
    return M(random.uniform(0.1, 4.0));
  } else {
    return M{};
  }
}

/// Calls f.operator()<Model>() for each model in a list.
template <class List>
void for_each(auto&& f) {
  [&]<class... Model>(std::tuple<Model...>*) {
    (f.template operator()<Model>(), ...);
  }(static_cast<List*>(nullptr));
}

template <class Model>
using system_of = decltype(Model::make());

/// Whether a system has the letters of a method, and a kinetic energy that gives it its order. (A black box
/// gives gradient kicks, but not their derivatives.)
template <SeparableSystem S>
bool suits(const S&, const Method auto& method) {
  const std::string letters = word_of(method).letters();
  const auto has = [&](const char* some) { return letters.find_first_of(some) != std::string::npos; };
  if (method.requires_quadratic_kinetic && !NystromSystem<S>) return false;
  if (has("RSH") && !HasQuadraticPart<S>) return false;
  return !(has("G") && BlackBoxForce<S>);
}
template <class M, class Model>
inline constexpr bool fits = (!M::requires_quadratic_kinetic || NystromSystem<system_of<Model>>)&&(
    M::word::reads != field::soft || HasQuadraticPart<system_of<Model>>);

/// All methods as data, with members drawn from the families: a law about them is compiled once a system.
/// That a method steps as its table does is a law of its own, in laws/data_laws.hpp.
/// Itself it is compiled once, in methods_as_data.cpp.
std::vector<tabulated> methods_as_data(draws& random);

}  // namespace nysalt::test
