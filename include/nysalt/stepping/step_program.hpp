// SPDX-License-Identifier: BSL-1.0
// The letters of a step, with their coefficients, as they are interpreted.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

#include "nysalt/word.hpp"

namespace nysalt::detail {

/// What kernels do themselves; letters of the bath, and all other letters, are called back.
enum class action : std::uint8_t { drift, kick, gradient_kick, displaced_kick, rotation, call };

/// The action of a letter of the library.
template <class L>
constexpr action action_of() {
  if constexpr (std::is_same_v<L, drift>) return action::drift;
  if constexpr (std::is_same_v<L, kick> || std::is_same_v<L, soft_kick>) return action::kick;
  if constexpr (std::is_same_v<L, gradient_kick> || std::is_same_v<L, soft_gradient_kick>) {
    return action::gradient_kick;
  }
  if constexpr (std::is_same_v<L, displaced_kick>) return action::displaced_kick;
  if constexpr (std::is_same_v<L, rotation>) return action::rotation;
  return action::call;
}

/// A letter of a program, with the step folded into the coefficients.
template <Scalar C>
struct step_program_letter {
  action what = action::call;
  evaluation evaluates = evaluation::none;  ///< of the force, before it
  int number = 0;                           ///< what is called back
  C coefficient{0.0};
  gradient_kick_coefficients<C> gradient{};
  displaced_kick_coefficients<C> displaced{};
  const rotation::prepared<C, Eigen::Dynamic>* turn = nullptr;
};

/// The letters of one step, as the loop reads them.
template <Scalar C>
struct step_program {
  using letter = step_program_letter<C>;
  std::vector<letter> loop;  ///< of a step that another one follows
  std::vector<letter> last;  ///< of a step after which the run may be observed
  std::vector<letter> undo;  ///< what takes the first letter back, of an open run
  field reads = field::none;
  bool calls = false;         ///< there are letters of the bath, and calls between steps
  bool is_of_shears = false;  ///< all letters are drifts and kicks of any kind
  /// Coefficients of a loop that is drifts and kicks in turn, each force being read once: kernels keep the
  /// state in registers then. Empty of other loops.
  std::vector<std::array<C, 2>> pairs{};
  bool begins_with_kick = false;
  bool keeps_last_force = false;  ///< the last kick of a last step leaves its force known

  /// What follows from the letters.
  void complete() {
    is_of_shears = std::ranges::none_of(
        loop, [](const letter& one) { return one.what == action::call || one.what == action::rotation; });
    pairs.clear();
    if (calls || loop.empty() || loop.size() % 2 != 0) return;
    begins_with_kick = loop.front().what == action::kick;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const bool is_kick = begins_with_kick == (i % 2 == 0);
      if (loop[i].what != (is_kick ? action::kick : action::drift)) return;
      if (is_kick && loop[i].evaluates != evaluation::unshared) return;
      const bool may_be_kept = !begins_with_kick && i + 1 == loop.size();
      if (is_kick && !may_be_kept && last[i].evaluates != evaluation::unshared) return;
    }
    keeps_last_force = !begins_with_kick && last.back().evaluates == evaluation::shared;
    for (std::size_t i = 0; i < loop.size(); i += 2)
      pairs.push_back({loop[i].coefficient, loop[i + 1].coefficient});
  }
};

/// Whom kernels call for letters of the bath. The state is up to date then, and read again.
struct callback {
  void (*call)(void* context, int number) = nullptr;
  void* context = nullptr;

  void operator()(int number) const { call(context, number); }
};

/// An observer of a run: after `first` steps, and every `every` steps from there on, the synchronous state is
/// copied to q and p, and `observe` is called. A null `observe` means an unobserved run.
template <class T>
struct watch {
  vector<T, Eigen::Dynamic>* q = nullptr;
  vector<T, Eigen::Dynamic>* p = nullptr;
  std::int64_t first = 0;
  std::int64_t every = 1;
  void (*observe)(void* context) = nullptr;
  void* context = nullptr;
};

}  // namespace nysalt::detail
