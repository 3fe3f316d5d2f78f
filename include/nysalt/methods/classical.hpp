// SPDX-License-Identifier: BSL-1.0
// Classical methods, whose coefficients are constants: one table.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

#include "nysalt/method.hpp"

namespace nysalt {

namespace detail {

/// Coefficients as a constant, one for each slot of the letters.
class coefficient_list {
 public:
  /// Coefficients of an array, 29 at most.
  template <std::size_t Count>
  constexpr coefficient_list(const std::array<double, Count>& all) : count_(Count) {
    std::copy(all.begin(), all.end(), values_.begin());
  }

  constexpr const double* begin() const { return values_.data(); }         ///< the first
  constexpr const double* end() const { return values_.data() + count_; }  ///< behind the last
  constexpr std::size_t size() const { return count_; }                    ///< number of coefficients

 private:
  std::array<double, 29> values_{};
  std::size_t count_;
};

/// A classical method: its letters, coefficients and source, and what it promises.
struct classical_row {
  std::string_view name;                    ///< name in the program and in classical<"name">
  std::string_view letters;                 ///< letters of docs/notation.md, from left to right
  coefficient_list coefficients;            ///< coefficients, one for each slot of the letters
  int order;                                ///< order as declared; measured in the tests
  std::string_view source;                  ///< key in docs/bibliography.bib
  bool symmetric = true;                    ///< whether a step back undoes a step
  bool requires_quadratic_kinetic = false;  ///< whether the order is for quadratic K(p) only
  bool repeats = false;  ///< whether the method is several steps of a shorter one in classical_methods()
};

}  // namespace detail

// clang-format off
namespace detail {

/// Classical methods, in the order of the program's list. Orders in a bath, of words with letters O, are
/// weak ones; the error of the invariant distribution is of that order too, or better.
inline constexpr classical_row classical_table[] = {
    {"verlet", "BAB", palindrome<3>({}), 2, "verlet_1967"},
    {"verlet_aba", "ABA", palindrome<3>({}), 2, "verlet_1967"},
    {.name = "verlet_2x", .letters = "BABAB", .coefficients = palindrome<5>({0.25}), .order = 2,
     .source = "verlet_1967", .repeats = true},

    // a = 1/2 - r/12 + 1/(6 r) with r = (36 + 2 sqrt(326))^(1/3)
    {"mclachlan2", "ABABA", palindrome<5>({0.19318332750378357396}), 2, "mclachlan_1995"},
    {"mclachlan2v", "BABAB", palindrome<5>({0.19318332750378357396}), 2, "mclachlan_1995"},
    // The methods of two and of three stages, and equation (6.8).
    {"bcss2", "ABABA", palindrome<5>({0.211781}), 2, "blanes_casas_sanz_serna_2014"},
    {"bcss2v", "BABAB", palindrome<5>({0.211781}), 2, "blanes_casas_sanz_serna_2014"},
    {"bcss3", "BABABAB", palindrome<7>({0.11888010966548, 0.29619504261126}), 2, "blanes_casas_sanz_serna_2014"},
    {"bcss4", "BABABABAB",
     palindrome<9>({0.071353913450279725904, 0.191667800000000000000, 0.268548791161230105820}), 2,
     "blanes_casas_sanz_serna_2014"},
    // Equation (26).
    {"predescu3", "BABABAB", palindrome<7>({0.108991425403425322, 0.290485609075128726}), 2,
     "predescu_and_others_2012"},

    // w = 1/(2 - 2^(1/3)): w/2 and w
    {"forest_ruth", "ABABABA",
     palindrome<7>({0.5 / (2.0 - 1.2599210498948731648), 1.0 / (2.0 - 1.2599210498948731648)}), 4,
     "forest_ruth_1990"},
    // xi, (1 - 2 lambda)/2, chi
    {"pefrl", "ABABABABA",
     palindrome<9>({0.1786178958448091, 0.5 - -0.2123418310626054, -0.06626458266981849}), 4,
     "omelyan_mryglod_folk_2002"},
    {"vefrl", "BABABABAB",
     palindrome<9>({0.1644986515575760, 0.5 - -0.02094333910398989, 1.235692651138917}), 4,
     "omelyan_mryglod_folk_2002"},
    // Equation (71): theta, rho, lambda, mu.
    {"omelyan5v", "BABABABABAB",
     palindrome<11>({0.08398315262876693, 0.2539785108410595, 0.6822365335719091, -0.03230286765269967}), 4,
     "omelyan_mryglod_folk_2003"},
    // Equation (80): rho, theta, mu, lambda.
    {"omelyan5p", "ABABABABABA",
     palindrome<11>({0.2750081212332419, -0.08442961950707149, -0.1347950099106792, 0.3549000571574260}), 4,
     "omelyan_mryglod_folk_2003"},
    {.name = "mclachlan_atela4", .letters = "BABABABA",
     .coefficients = std::array{0.1344961992774310892, 0.5153528374311229364,
                                -0.2248198030794208058, -0.085782019412973646,
                                0.7563200005156682911, 0.4415830236164665242,
                                0.3340036032863214255, 0.1288461583653841854},
     .order = 4, .source = "mclachlan_atela_1992", .symmetric = false, .requires_quadratic_kinetic = true},
    // (14 - sqrt 19)/108, 2/5, (20 - 7 sqrt 19)/108, -1/10
    {"mclachlan5", "ABABABABABA",
     palindrome<11>({(14.0 - 4.3588989435406735522) / 108.0, 0.4,
                     (20.0 - 7.0 * 4.3588989435406735522) / 108.0, -0.1}), 4, "mclachlan_1995"},

    // Table 2, S_6 and S_10.
    {"blanes_moan_s6", "BABABABABABAB",
     palindrome<13>({0.0792036964311957, 0.209515106613362, 0.353172906049774, -0.143851773179818,
                     -0.0420650803577195}), 4, "blanes_moan_2002"},
    {"blanes_moan_s10", "BABABABABABABABABABAB",
     palindrome<21>({0.0502627644003922, 0.148816447901042, 0.413514300428344, -0.132385865767784,
                     0.0450798897943977, 0.067307604692185, -0.188054853819569, 0.432666402578175,
                     0.541960678450780}), 6, "blanes_moan_2002"},
    // Table 3, SRKN_6^b, SRKN_11^b and SRKN_14^a.
    {"srkn6b", "BABABABABABAB",
     palindrome<13>({0.0829844064174052, 0.245298957184271, 0.396309801498368, 0.604872665711080,
                     -0.0390563049223486}), 4, "blanes_moan_2002"},
    {.name = "srkn11b", .letters = "BABABABABABABABABABABAB",
     .coefficients = palindrome<23>({0.0414649985182624, 0.123229775946271,
                                     0.198128671918067, 0.290553797799558,
                                     -0.0400061921041533, -0.127049212625417,
                                     0.0752539843015807, -0.246331761062075,
                                     -0.0115113874206879, 0.357208872795928}),
     .order = 6, .source = "blanes_moan_2002", .requires_quadratic_kinetic = true},
    {.name = "srkn14a", .letters = "ABABABABABABABABABABABABABABA",
     .coefficients = palindrome<29>({0.0378593198406116, 0.09171915262446165,
                                     0.102635633102435, 0.183983170005006,
                                     -0.0258678882665587, -0.05653436583288827,
                                     0.314241403071447, 0.004914688774712854,
                                     -0.130144459517415, 0.143761127168358,
                                     0.106417700369543, 0.328567693746804,
                                     -0.00879424312851058}),
     .order = 6, .source = "blanes_moan_2002", .requires_quadratic_kinetic = true},

    {.name = "takahashi_imada", .letters = "AGA", .coefficients = std::array{0.5, 1.0, 1.0 / 24.0, 0.5},
     .order = 2, .source = "takahashi_imada_1984", .requires_quadratic_kinetic = true},
    {.name = "chin4a", .letters = "BAGAB",
     .coefficients = std::array{1.0 / 6.0, 0.5, 2.0 / 3.0, 1.0 / 72.0, 0.5, 1.0 / 6.0},
     .order = 4, .source = "chin_1997", .requires_quadratic_kinetic = true},
    // G(2/3, 1/72) with its force at q + 2 c/b h^2 M^-1 f, which is it up to h^5.
    {.name = "chin4a_displaced", .letters = "BADAB",
     .coefficients = std::array{1.0 / 6.0, 0.5, 2.0 / 3.0, 1.0 / 24.0, 0.5, 1.0 / 6.0},
     .order = 4, .source = "yin_mawhinney_2011", .requires_quadratic_kinetic = true},
    // Equation (44): a = 1/2 - 1/sqrt(24 b), b, and c = (1 - (1 - b) sqrt(6 b))/12.
    {.name = "omelyan_fg4", .letters = "ABAGABA", .coefficients = [] {
       constexpr double b = 0.2470939580390842;
       constexpr double a = 0.5 - 1.0 / 2.43521148833895344696;                 // sqrt(24 b)
       constexpr double c = (1.0 - (1.0 - b) * 1.21760574416947672348) / 12.0;  // sqrt(6 b)
       return std::array{a, b, 0.5 - a, 1.0 - 2.0 * b, c, 0.5 - a, b, a};
     }(), .order = 4, .source = "omelyan_mryglod_folk_2003", .requires_quadratic_kinetic = true},

    {.name = "impulse", .letters = "SRS", .coefficients = palindrome<3>({}), .order = 2,
     .source = "tuckerman_berne_martyna_1992", .requires_quadratic_kinetic = true},

    {"baoab", "BAOAB", std::array{0.5, 0.5, 1.0, 0.5, 0.5}, 2, "leimkuhler_matthews_2013"},
    {.name = "baoab_2x", .letters = "BAOABAOAB",
     .coefficients = std::array{0.25, 0.25, 0.5, 0.25, 0.5, 0.25, 0.5, 0.25, 0.25}, .order = 2,
     .source = "leimkuhler_matthews_2013", .repeats = true},
    {"aboba", "ABOBA", std::array{0.5, 0.5, 1.0, 0.5, 0.5}, 2, "leimkuhler_matthews_2013"},
    {"obabo", "OBABO", std::array{0.5, 0.5, 1.0, 0.5, 0.5}, 2, "bussi_parrinello_2007"},
};

/// Classical kernels with processors P = B A B A ..., with which P(-h) K^n P(h)^-1 agrees with the flow to
/// h^order for every n: 5 equations for the order 4, 11 for the order 6 [blanes_casas_ros_1999], which
/// docs/notation.md lists. Of their solutions these have a small sum of squares.
inline constexpr classical_row processed_table[] = {
    {.name = "takahashi_imada_processed", .letters = "AGA|BABABA",
     .coefficients = [] {
       constexpr double x = 0.16047247800761, y = 0.0991774456676410, z = 0.25964992367525;
       return std::array{0.5, 1.0, 1.0 / 24.0, 0.5, -x, y, z, -z, -y, x};
     }(), .order = 4, .source = "takahashi_imada_1984", .requires_quadratic_kinetic = true},
    // a, b, c are those with which the kernel fg4 is conjugate to a method of order 6.
    {.name = "fg4_processed", .letters = "ABAGABA|BABABABABABABA",
     .coefficients = [] {
       constexpr double a = -0.06826103839186301, b = 0.2621129352517028, c = 0.01640111281607833;
       return std::array{a, b, 0.5 - a, 1.0 - 2.0 * b, c, 0.5 - a, b, a,
                         0.03373311281826821, 0.2281381917462715, 0.06392082841500404,
                         -0.3744804007903129, 0.2530866083518434, 0.1696191837204259,
                         -0.3353442653699947, -0.18691655686842, -0.2605352967581503,
                         0.3336701560859482, -0.1419773137996439, -0.2506475135961628,
                         0.3871163263426732, 0.08061693970225002};
     }(), .order = 6, .source = "blanes_casas_ros_1999", .requires_quadratic_kinetic = true},
};

}  // namespace detail
// clang-format on

namespace detail {

/// A row of the table as a method.
inline method as_data(const classical_row& row) {
  return {std::string(row.name),
          word(row.letters),
          {row.coefficients.begin(), row.coefficients.end()},
          {row.order, row.symmetric, row.requires_quadratic_kinetic}};
}

}  // namespace detail

/// Rows without letters O that are not several steps of another: what a learned method is compared with.
inline std::vector<method> classical_methods() {
  std::vector<method> result;
  for (const auto& row : detail::classical_table) {
    const bool is_for_baths = row.letters.find(ornstein_uhlenbeck::letter) != std::string_view::npos;
    if (!is_for_baths && !row.repeats) result.push_back(detail::as_data(row));
  }
  for (const auto& row : detail::processed_table) result.push_back(detail::as_data(row));
  return result;
}

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

}  // namespace detail

/// The method of that name in the table: `classical<"pefrl">()`, which is also pefrl(). A name that the table
/// does not have does not compile.
template <detail::method_name Name>
struct classical : nysalt::method {
  static constexpr std::size_t row = detail::row_of(Name.view());  ///< number of the row
  static_assert(row < std::size(detail::classical_table),
                "nysalt: no classical method has this name; nysalt/methods/classical.hpp has those that "
                "there are");
  classical() : nysalt::method(detail::as_data(detail::classical_table[row])) {}
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
/// The word of bcss3 with the least error on oscillators as z -> 0, where the energy error is of fourth
/// order: order 2, three evaluations.
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
