// SPDX-License-Identifier: BSL-1.0
// Multiple time steps: kicks with one part of the force between kicks with another.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/exact_flow.hpp"

namespace nysalt {

namespace detail {

template <std::size_t Fast, std::size_t Slow, std::size_t Inner, std::size_t... I>
constexpr word nest_kicks(std::index_sequence<I...>) {
  return word_of<std::conditional_t<
      I % 2 == 1, drift,
      std::conditional_t<I % (2 * Inner) == 0, kick_of_parts<Fast, Slow>, kick_of_part<Fast>>>...>();
}

/// The first half of a palindrome of `Count` numbers that add up to one, from those that are free: the middle
/// one, or the two next to the middle, follow.
template <std::size_t Count, class C>
std::array<C, Count> of_sum_one(const C* free) {
  constexpr std::size_t last = (Count - 1) / 2;
  std::array<C, Count> all{};
  C rest(1.0);
  for (std::size_t i = 0; i < last; ++i) {
    all[i] = all[Count - 1 - i] = free[i];
    rest = rest - free[i] * 2.0;
  }
  all[last] = all[Count - 1 - last] = Count % 2 == 1 ? rest : rest * 0.5;
  return all;
}

/// The name "nested_INNERxOUTER", both of one digit.
template <int Inner, int Outer>
inline constexpr std::array<char, 10> name_of_nested{
    'n', 'e', 's', 't', 'e', 'd', '_', static_cast<char>('0' + Inner), 'x', static_cast<char>('0' + Outer)};

/// `Outer` kicks of the parts Fast and Slow together and one more, which merges, with Inner drifts and
/// Inner - 1 kicks of Fast only between any two of them. With Inner = n and Outer = 1 it is the word of
/// r-RESPA: k A (F A)^(n - 1) k.
template <std::size_t Fast, std::size_t Slow, std::size_t Inner, std::size_t Outer = 1>
inline constexpr word nested_word =
    detail::nest_kicks<Fast, Slow, Inner>(std::make_index_sequence<2 * Inner * Outer + 1>());

}  // namespace detail

/// r-RESPA and its kin: a nested_word whose coefficients read the same from both ends, the coefficients of
/// drifts, of Fast and of Slow adding up to one each. Parameters are the free drifts from the left, then the
/// free kicks of Fast, then the free kicks of Slow. Symmetric, of order 2. The start is r-RESPA, `Outer`
/// steps of it. A step costs Inner Outer evaluations of Fast and Outer of Slow. Source:
/// [tuckerman_berne_martyna_1992].
template <std::size_t Fast, std::size_t Slow, int Inner, int Outer = 1>
  requires(Inner >= 1 && Outer >= 1 && Inner < 10 && Outer < 10 && Inner * Outer >= 2)
struct nested_kicks : composition<(Inner * Outer - 1) / 2 + Inner * Outer / 2 + Outer / 2> {
  static constexpr std::size_t drifts =
      static_cast<std::size_t>(Inner * Outer);                  ///< number of drifts in a step
  static constexpr std::size_t free_drifts = (drifts - 1) / 2;  ///< parameters that are drifts
  static constexpr std::size_t free_fast = drifts / 2;  ///< number of free parameters that are kicks of Fast
  static constexpr std::size_t free_slow =
      static_cast<std::size_t>(Outer) / 2;  ///< number of free parameters that are kicks of Slow
  static constexpr std::size_t free = free_drifts + free_fast + free_slow;

  static constexpr word letters =
      detail::nested_word<Fast, Slow, static_cast<std::size_t>(Inner), static_cast<std::size_t>(Outer)>;
  static constexpr std::string_view name{detail::name_of_nested<Inner, Outer>.data(), 10};
  static constexpr int order = 2;
  static constexpr bool symmetric = true;

  static std::array<double, free> start() {
    std::array<double, free> all;
    const auto equal = 1.0 / static_cast<double>(drifts);
    all.fill(equal);
    all[free_drifts] = 0.5 * equal;
    if (free_slow > 0) all[free_drifts + free_fast] = 0.5 / Outer;
    for (std::size_t k = 1; k < free_slow; ++k) all[free_drifts + free_fast + k] = 1.0 / Outer;
    return all;
  }
  /// Member with the longest stability interval: r-RESPA.
  static std::array<double, free> most_stable_member() { return start(); }

  template <Scalar C>
  static std::array<C, letters.slots> coefficients(const std::array<C, free>& theta) {
    const auto a = detail::of_sum_one<drifts>(theta.data());
    const auto fast = detail::of_sum_one<drifts + 1>(theta.data() + free_drifts);
    const auto slow =
        detail::of_sum_one<static_cast<std::size_t>(Outer) + 1>(theta.data() + free_drifts + free_fast);
    std::array<C, letters.slots> all{};
    std::size_t slot = 0;
    for (std::size_t i = 0; i <= drifts; ++i) {
      all[slot++] = fast[i];
      if (i % static_cast<std::size_t>(Inner) == 0) all[slot++] = slow[i / static_cast<std::size_t>(Inner)];
      if (i < drifts) all[slot++] = a[i];
    }
    return all;
  }
};

/// r-RESPA, the impulse method: a half kick of Slow, Inner steps of velocity Verlet with Fast, a half kick of
/// Slow. Order 2, symmetric, Inner evaluations of Fast and one of Slow; where Slow times the step meets half
/// a period of a fast mode it is unstable. Source: [tuckerman_berne_martyna_1992].
template <std::size_t Fast, std::size_t Slow, int Inner>
  requires(Inner >= 1)
struct r_respa : nysalt::method {
  r_respa()
      : nysalt::method(sentence("r_respa({})", Inner),
                       detail::nested_word<Fast, Slow, static_cast<std::size_t>(Inner)>, equal_steps(),
                       {2, true, false}) {}

 private:
  static std::vector<double> equal_steps() {
    std::vector<double> all(detail::nested_word<Fast, Slow, static_cast<std::size_t>(Inner)>.slots,
                            1.0 / Inner);
    all.front() = all[all.size() - 2] = 0.5 / Inner;
    all[1] = all.back() = 0.5;
    return all;
  }
};

}  // namespace nysalt
