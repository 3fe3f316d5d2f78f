// SPDX-License-Identifier: BSL-1.0
// Classical methods as types.
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>

#include "nysalt/detail/word_of_letters.hpp"
#include "nysalt/methods/classical_table.hpp"

namespace nysalt {

namespace detail {

/// A name as an argument of a template.
template <std::size_t Size>
struct method_name {
  char text[Size];
  consteval method_name(const char (&name)[Size]) { std::copy(name, name + Size, text); }
  constexpr std::string_view view() const { return {text, Size - 1}; }
};

/// The row of that name; behind the last if there is none.
constexpr std::size_t row_of(std::string_view name) {
  std::size_t row = 0;
  while (row < std::size(classical_table) && classical_table[row].name != name) ++row;
  return row;
}

/// The letters of a row, for word_of_letters.
template <std::size_t Row>
struct letters_of_row {
  static constexpr std::string_view letters() { return classical_table[Row].letters; }
};

}  // namespace detail

/// A row of the table as a type: `classical<"pefrl">`, which is also called pefrl. A name that the table does
/// not have does not compile.
template <detail::method_name Name>
class classical {
  static constexpr std::size_t row = detail::row_of(Name.view());
  static_assert(
      row < std::size(classical_table),
      "nysalt: no classical method has this name; nysalt/methods/classical_table.hpp has those that "
      "there are");

 public:
  using word = detail::word_of_letters<detail::letters_of_row<row>>;
  static constexpr int order = classical_table[row].order;
  static constexpr bool symmetric = classical_table[row].symmetric;
  static constexpr bool requires_quadratic_kinetic = classical_table[row].requires_quadratic_kinetic;
  static std::string name() { return std::string(Name.view()); }
  static constexpr typename word::template coefficients<double> coefficients() { return constants; }

 private:
  static constexpr auto constants = [] {
    const auto& from = classical_table[row].coefficients;
    typename word::template coefficients<double> all{};
    static_assert(classical_table[row].coefficients.size() == all.size());
    std::copy(from.begin(), from.end(), all.begin());
    return all;
  }();
};

/// B(1/2) A B(1/2): velocity Verlet, order 2, one evaluation a step
/// [verlet_1967; hairer_lubich_wanner_2006, section I.1.4].
using verlet = classical<"verlet">;
/// A(1/2) B A(1/2): position Verlet, order 2, one evaluation a step.
using verlet_aba = classical<"verlet_aba">;
/// Two half steps of velocity Verlet: what every two-stage method must beat, at its cost.
using verlet_2x = classical<"verlet_2x">;

/// A(a) B(1/2) A(1 - 2a) B(1/2) A(a) with the least error constant of its kind: order 2, two evaluations.
using mclachlan2 = classical<"mclachlan2">;
/// B(b) A(1/2) B(1 - 2b) A(1/2) B(b) with the coefficient of mclachlan2, the velocity form of the same
/// minimum.
using mclachlan2v = classical<"mclachlan2v">;
/// B A B A B with the least energy error on oscillators up to z = 2: order 2, two evaluations.
using bcss2 = classical<"bcss2">;
/// The velocity form of bcss2, which begins with a kick: on oscillators it errs as much.
using bcss2v = classical<"bcss2v">;
/// B(b) A(a) B(1/2 - b) A(1 - 2a) B(1/2 - b) A(a) B(b) with the least energy error on oscillators up to z =
/// 3: order 2, three evaluations.
using bcss3 = classical<"bcss3">;
/// B A B A B A B A B with the least energy error on oscillators up to z = 4: order 2, four evaluations.
using bcss4 = classical<"bcss4">;
/// The word of bcss3 with the least error on oscillators as z -> 0, where that of energy is of fourth order:
/// order 2, three evaluations.
using predescu3 = classical<"predescu3">;

/// Three steps of position Verlet, of the lengths w, 1 - 2w and w with w = 1/(2 - 2^(1/3)):
///   A(w/2) B(w) A((1 - w)/2) B(1 - 2w) A((1 - w)/2) B(w) A(w/2),
/// order 4, three evaluations. The middle step goes back by 1.7 h, which makes its error the largest of its
/// order and cost here.
using forest_ruth = classical<"forest_ruth">;
/// Position-extended Forest-Ruth-like: A(xi) B((1 - 2 lambda)/2) A(chi) B(lambda) A(1 - 2(chi + xi)) ...,
/// order 4, four evaluations.
using pefrl = classical<"pefrl">;
/// Velocity-extended Forest-Ruth-like: B(xi) A((1 - 2 lambda)/2) B(chi) A(lambda) B(1 - 2(chi + xi)) ...,
/// order 4, four evaluations.
using vefrl = classical<"vefrl">;
/// B A B A B A B A B A B of order 4 with the least norm of the error's leading coefficients, five
/// evaluations; 4MN5FV or OMF4 in lattice field theory.
using omelyan5v = classical<"omelyan5v">;
/// A B A B A B A B A B A of order 4 with the least norm of the error's leading coefficients, five
/// evaluations; 4MN5FP in lattice field theory.
using omelyan5p = classical<"omelyan5p">;
/// B(b1) A(a1) B(b2) A(a2) B(b3) A(a3) B(b4) A(a4), not symmetric: order 4 for quadratic K(p), else 3; four
/// evaluations. Begun with a drift, the same coefficients have order 3.
using mclachlan_atela4 = classical<"mclachlan_atela4">;
/// A(a1) B(2/5) A(a2) B(-1/10) A(1/2 - a1 - a2) B(2/5) ..., the least error constant of its kind: order 4,
/// five evaluations. (Not the composition of five Verlet steps in the same paper.)
using mclachlan5 = classical<"mclachlan5">;
/// S6: order 4 for any separable Hamiltonian, six evaluations.
using blanes_moan_s6 = classical<"blanes_moan_s6">;
/// S10: order 6 for any separable Hamiltonian, ten evaluations.
using blanes_moan_s10 = classical<"blanes_moan_s10">;
/// SRKN6b: order 4, six evaluations. Its order holds for any K(p): what a quadratic K removes is a term of
/// fourth order, which a symmetric method lacks anyway. Its small error constant is for quadratic K.
using srkn6b = classical<"srkn6b">;
/// SRKN11b: order 6 for quadratic K(p), else 4; eleven evaluations.
using srkn11b = classical<"srkn11b">;
/// SRKN14a: order 6 for quadratic K(p), else 4; fourteen evaluations.
using srkn14a = classical<"srkn14a">;

/// A(1/2) G(1, 1/24) A(1/2), position Verlet with a gradient kick: order 2, and of effective order 4, as a
/// change of coordinates that is small as h^2 makes it a method of order 4. Two evaluations.
using takahashi_imada = classical<"takahashi_imada">;
/// 4A: B(1/6) A(1/2) G(2/3, 1/72) A(1/2) B(1/6), order 4 without going back in time; three evaluations.
using chin4a = classical<"chin4a">;
/// Chin's method 4A with a displaced kick: three evaluations, not symplectic.
using chin4a_displaced = classical<"chin4a_displaced">;
/// A(a) B(b) A(1/2 - a) G(1 - 2 b, c) A(1/2 - a) B(b) A(a) with the least norm of the error's leading
/// coefficients: order 4, four evaluations; 4MN3F1GP in lattice field theory.
using omelyan_fg4 = classical<"omelyan_fg4">;

/// S(1/2) R S(1/2): velocity Verlet with the quadratic part solved exactly, for systems that declare one
/// [grubmueller_heller_windemuth_schulten_1991; tuckerman_berne_martyna_1992, r-RESPA]. Order 2, one
/// evaluation of the soft force. The step is not limited by the stiff frequencies omega, but resonates with
/// them where h omega is near a multiple of pi.
using impulse = classical<"impulse">;

/// B(1/2) A(1/2) O A(1/2) B(1/2), one evaluation: exact in the distribution of q for harmonic systems, on
/// which it is stable for h omega < 2.
using baoab = classical<"baoab">;
/// Two half steps of BAOAB: what every two-stage method in a bath must beat, at its cost.
using baoab_2x = classical<"baoab_2x">;
/// A(1/2) B(1/2) O B(1/2) A(1/2), one evaluation.
using aboba = classical<"aboba">;
/// O(1/2) B(1/2) A B(1/2) O(1/2): velocity Verlet between two halves of the bath; one evaluation.
using obabo = classical<"obabo">;

}  // namespace nysalt
