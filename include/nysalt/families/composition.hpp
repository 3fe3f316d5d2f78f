// SPDX-License-Identifier: BSL-1.0
// Families of compositions of drifts and kicks, and of rotations and soft kicks.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <vector>

#include "nysalt/families/parameters.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// Defaults of a family: parameters theta1, theta2, ... between -4 and 4; of order 1,
/// not symmetric, for any kinetic energy. A family of one's own adds
///   static constexpr word letters{"..."};  static constexpr std::string_view name = ...;
///   start();  coefficients(theta)
template <int Parameters>
struct composition {
  static constexpr int parameters = Parameters;
  static constexpr int order = 1;
  static constexpr bool symmetric = false;
  static constexpr bool requires_quadratic_kinetic = false;

 private:
  static constexpr auto count = static_cast<std::size_t>(Parameters);
  static constexpr std::array<std::string_view, 12> numbered{"theta1", "theta2",  "theta3",  "theta4",
                                                             "theta5", "theta6",  "theta7",  "theta8",
                                                             "theta9", "theta10", "theta11", "theta12"};

 public:
  static constexpr std::array<std::string_view, count> parameter_names = [] {
    static_assert(count <= numbered.size(), "nysalt: name the parameters of so large a family");
    std::array<std::string_view, count> first;
    for (std::size_t k = 0; k < count; ++k) first[k] = numbered[k];
    return first;
  }();

  static std::array<parameter_range, count> ranges() {
    std::array<parameter_range, count> all;
    all.fill({-detail::farthest_parameter, detail::farthest_parameter, false});
    return all;
  }
};

namespace detail {

/// The names a1, b1, a2, b2, ... of coefficients that are parameters, in the order of the word; b first where
/// the word begins with it.
template <std::size_t Count>
constexpr std::array<std::string_view, Count> names_in_turn(bool b_is_first) {
  constexpr std::array<std::string_view, 6> a{"a1", "a2", "a3", "a4", "a5", "a6"};
  constexpr std::array<std::string_view, 6> b{"b1", "b2", "b3", "b4", "b5", "b6"};
  static_assert(Count <= 12, "nysalt: name the parameters of so large a family");
  std::array<std::string_view, Count> all;
  for (std::size_t k = 0; k < Count; ++k) all[k] = ((k % 2 == 0) != b_is_first ? a : b)[k / 2];
  return all;
}

}  // namespace detail

/// x_1 y_1 x_2 y_2 ... y_2 x_2 y_1 x_1 with x and y each adding up to 1: symmetric, of order 2. Parameters
/// are the coefficients from the left; the last of each letter follow from the sums. Where the steps of words
/// of s = 4 kicks and more are large, the best of them hold large kicks of opposite sign around a short
/// drift: a gradient kick by differences, along a flat valley.
template <Flow Outer, Flow Inner, std::size_t Length>
struct symmetric_composition : composition<(static_cast<int>(Length) - 3) / 2> {
  static constexpr word letters = alternating_word<Outer, Inner, Length>();
  static constexpr std::size_t free = (Length - 3) / 2;
  static constexpr auto parameter_names = detail::names_in_turn<free>(Outer::reads != field::none);
  static constexpr int order = 2;
  static constexpr bool symmetric = true;
  static constexpr bool requires_quadratic_kinetic = QuadraticFlow<Outer>;

  /// Equal steps of drift-kick-drift, or of kick-drift-kick.
  static std::array<double, free> start() {
    constexpr double inner = 2.0 / static_cast<double>(Length - 1);
    std::array<double, free> all;
    all.fill(inner);
    all[0] = 0.5 * inner;
    return all;
  }

  template <Scalar C>
  static std::array<C, Length> coefficients(const std::array<C, free>& theta) {
    return detail::palindrome<Length, C>(theta);
  }

  /// The parameters that a classical method of this word has.
  static std::array<double, free> of(const nysalt::method& method) {
    std::array<double, free> all;
    const auto& c = method.coefficients();
    for (std::size_t k = 0; k < free; ++k) all[k] = c[k];
    return all;
  }
};

namespace detail {
/// "aba4" for the prefix "aba" and 4 kicks, below 10.
template <std::size_t Length>
struct numbered_name {
  std::array<char, Length> text{};
  constexpr numbered_name(std::string_view prefix, int number) {
    for (std::size_t i = 0; i + 1 < Length; ++i) text[i] = prefix[i];
    text[Length - 1] = static_cast<char>('0' + number);
  }
};

/// The classical methods A B ... B A with that number of kicks, as members of a family F of such words.
/// Rotations may replace the drifts: of K, order conditions ask but that it is quadratic in p.
template <class F, int Kicks>
std::vector<classical_member<F::parameters>> classical_palindromes() {
  if constexpr (Kicks == 2) return {{"mclachlan2", F::of(mclachlan2())}};
  if constexpr (Kicks == 3) return {{"forest_ruth", F::of(forest_ruth())}};
  if constexpr (Kicks == 4) return {{"pefrl", F::of(pefrl())}};
  if constexpr (Kicks == 5) {
    return {{"mclachlan5", F::of(mclachlan5())}, {"omelyan5p", F::of(omelyan5p())}};
  }
  return {};
}

}  // namespace detail

/// A B A ... B A with s kicks: s evaluations.
template <int Kicks>
  requires(Kicks >= 2 && Kicks < 10)
struct aba : symmetric_composition<drift, kick, 2 * Kicks + 1> {
 private:
  using base = symmetric_composition<drift, kick, 2 * Kicks + 1>;
  static constexpr detail::numbered_name<4> text{"aba", Kicks};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};

  static std::vector<classical_member<base::parameters>> classical_members() {
    return detail::classical_palindromes<base, Kicks>();
  }
};

/// B A B ... A B with s drifts: s evaluations.
template <int Drifts>
  requires(Drifts >= 2 && Drifts < 10)
struct bab : symmetric_composition<kick, drift, 2 * Drifts + 1> {
 private:
  using base = symmetric_composition<kick, drift, 2 * Drifts + 1>;
  static constexpr detail::numbered_name<4> text{"bab", Drifts};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};

  static std::vector<classical_member<base::parameters>> classical_members() {
    if constexpr (Drifts == 2) {
      return {{"mclachlan2v", base::of(mclachlan2v())}, {"bcss2v", base::of(bcss2v())}};
    }
    if constexpr (Drifts == 3) {
      return {{"bcss3", base::of(bcss3())}, {"predescu3", base::of(predescu3())}};
    }
    if constexpr (Drifts == 4) return {{"vefrl", base::of(vefrl())}, {"bcss4", base::of(bcss4())}};
    if constexpr (Drifts == 5) return {{"omelyan5v", base::of(omelyan5v())}};
    if constexpr (Drifts == 6) return {{"srkn6b", base::of(srkn6b())}};
    return {};
  }
};

namespace detail {

/// X(x1) Y(y1) X(x2) Y(y2) ... with s letters Y, not symmetric: all but the last coefficient of each letter,
/// which follow from the sums, are parameters. s evaluations. What is learned has the order 1 in truth, with
/// a tiny constant: never take it to a smaller step.
template <Flow Outer, Flow Inner, int Stages>
struct free_composition : composition<2 * Stages - 1> {
  static constexpr word letters = alternating_word<Outer, Inner, 2 * Stages + 1>();
  static constexpr std::size_t free = 2 * Stages - 1;
  static constexpr auto parameter_names = names_in_turn<free>(Outer::reads != field::none);

  /// Equal steps of drift-kick-drift, or of kick-drift-kick.
  static std::array<double, free> start() {
    std::array<double, free> all;
    all.fill(1.0 / Stages);
    all[0] = 0.5 / Stages;
    return all;
  }

  template <Scalar C>
  static std::array<C, free + 2> coefficients(const std::array<C, free>& theta) {
    std::array<C, free + 2> all;
    C a(1.0);
    C b(1.0);
    for (std::size_t k = 0; k < free; ++k) {
      all[k] = theta[k];
      (k % 2 == 0 ? a : b) -= theta[k];
    }
    all[free] = b;
    all[free + 1] = a;
    return all;
  }
};

}  // namespace detail

/// A B ... A with three kicks, five parameters.
struct aba3_free : detail::free_composition<drift, kick, 3> {
  static constexpr std::string_view name = "aba3_free";
  using contained = aba<3>;
};
/// A B ... A with four kicks, seven parameters.
struct aba4_free : detail::free_composition<drift, kick, 4> {
  static constexpr std::string_view name = "aba4_free";
  using contained = aba<4>;
};
/// A B ... A with six kicks, eleven parameters.
struct aba6_free : detail::free_composition<drift, kick, 6> {
  static constexpr std::string_view name = "aba6_free";
  using contained = aba<6>;
};
/// B A ... B with six drifts, eleven parameters.
struct bab6_free : detail::free_composition<kick, drift, 6> {
  static constexpr std::string_view name = "bab6_free";
  using contained = bab<6>;
};

/// R S R ... S R with s soft kicks, for systems that declare a quadratic part: the impulse method is its like
/// with one. Exact where nothing is soft.
template <int Kicks>
  requires(Kicks >= 2 && Kicks < 10)
struct r_aba : symmetric_composition<rotation, soft_kick, 2 * Kicks + 1> {
 private:
  using base = symmetric_composition<rotation, soft_kick, 2 * Kicks + 1>;
  static constexpr detail::numbered_name<6> text{"r_aba", Kicks};

 public:
  static constexpr std::string_view name{text.text.data(), text.text.size()};
  static constexpr std::string_view source = "tuckerman_berne_martyna_1992";

  static std::vector<classical_member<base::parameters>> classical_members() {
    return detail::classical_palindromes<base, Kicks>();
  }
};

}  // namespace nysalt
