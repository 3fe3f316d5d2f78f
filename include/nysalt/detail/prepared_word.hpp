// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and the step folded in, letters known at compile time.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include "nysalt/detail/merged_half_steps.hpp"
#include "nysalt/detail/modal_coordinates.hpp"
#include "nysalt/detail/own_letter.hpp"
#include "nysalt/detail/pairs_in_loop.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

/// What letters are prepared with, beside coefficients and step: where their word needs it, else nothing.
struct surroundings_of_word {
  std::optional<bath> heat_bath;  ///< for letters O; a copy, as a system may return it by value
  std::shared_ptr<const modal_coordinates> part;  ///< for letters R
  int threads = 1;                                ///< that may share a step
};

namespace detail {
/// One letter with its coefficients, from c[0] on, and the step folded in.
template <Flow Letter, int N, Scalar C>
auto prepare_letter(const C* c, double h, const surroundings_of_word& around) {
  if constexpr (StochasticFlow<Letter>) {
    return Letter::prepare(c[0], h, *around.heat_bath);
  } else if constexpr (QuadraticFlow<Letter>) {
    return Letter::template prepare<N>(c[0], h, around.part);
  } else {
    return prepare_coefficients<Letter>(c, h);
  }
}
}  // namespace detail

// clang-format off
/// Letters with coefficients and step folded in, and what a stepper does with them:
/// open(system, x)                from a synchronous state to an open one: force and first letter where needed
/// advance(system, x, n, cursor)  n steps of an open run; last letter of a step and first of the next are one
/// close(system, x, cursor)       an open state becomes synchronous
/// step(system, x, cursor)        one plain step, letter by letter, from only q and p
/// in_loop()                      itself, as a loop should hold it
/// The cursor says where the run is in its noise, and goes on with it.
// clang-format on
///
/// An open run is ahead of the synchronous state by a first letter that merges with the last. Where both are
/// of the bath it is behind instead: the letter O that meets the next step's is still to come. N is the
/// dimension of the system.
template <class W, Scalar C, int N>
class prepared_word;

/// Of letters known at compile time: unrolled, nothing is decided while stepping.
template <Scalar C, int N, Flow... L>
class prepared_word<word<L...>, C, N> {
  using W = word<L...>;

 public:
  /// One for each slot.
  using coefficients = typename W::template coefficients<C>;
  /// The cursor of the word holds a flow_room: there is a letter D, G, R or H.
  static constexpr bool needs_room = W::force_derivatives + W::displaced_forces > 0 ||
                                     (QuadraticFlow<L> || ...);

  /// Folds step and surroundings into the coefficients.
  prepared_word(const W&, const coefficients& c, double h, const surroundings_of_word& around)
      : letters_(prepare(c, h, around, std::make_index_sequence<W::length>{})) {
    if constexpr (W::merges) {
      std::array<C, first::slots> both;
      std::array<C, first::slots> back;
      for (std::size_t k = 0; k < first::slots; ++k) {
        both[k] = c[W::slots - first::slots + k] + c[k];
        back[k] = -c[k];
      }
      merged_ = detail::prepare_letter<first, N>(both.data(), h, around);
      undo_ = detail::prepare_letter<first, N>(back.data(), h, around);
    } else if constexpr (W::merges_half_steps) {
      merged_ = merged_half_steps<C>(std::get<W::length - 1>(letters_), std::get<0>(letters_),
                                     around.heat_bath->sigma() > 0.0);
    }
  }

  /// A copy: local coefficients cannot alias the system, so they stay in registers.
  prepared_word in_loop() const { return *this; }

  /// Opens a run. Cost: W::evaluations_to_open.
  template <class T, System S>
  void open(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::plan.is_known_when_open) force_of<W::reads, T>(system, x.q, x.f);
    if constexpr (W::merges) first::apply(system, std::get<0>(letters_), x, cursor.room);
  }
  /// Steps of an open run. Cost: W::evaluations_per_step each.
  template <class T, System S>
  [[gnu::always_inline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                      auto& cursor) const {
    constexpr bool last_differs = W::plan.in_last != W::plan.in_loop;
    const std::int64_t alike = last_differs ? steps - 1 : steps;
    if constexpr (is_in_pairs && !is_dual<T>) {
      constexpr auto begins = std::same_as<typename W::template letter<W::first_in_loop>, kick>
                                  ? detail::pair_begins::with_kick
                                  : detail::pair_begins::with_drift;
      const auto pairs = pairs_of_loop(std::make_index_sequence<(end - W::first_in_loop) / 2>{});
      detail::take_pairs<begins, detail::last_force::unknown, T>(system, x, cursor.room, pairs.data(),
                                                                 pairs.size(), alike);
    } else {
      for (std::int64_t n = 0; n < alike; ++n) {
        loop<in_loop_plan, W::first_in_loop>(system, x, cursor);
        cursor.next();
      }
    }
    if constexpr (last_differs) {
      if (steps > 0) {
        loop<in_last_plan, W::first_in_loop>(system, x, cursor);
        cursor.next();
      }
    }
  }
  /// What an open state is at its step. No evaluation.
  template <class T, System S>
  void close(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::merges) first::apply(system, undo_, x, cursor.room);
    if constexpr (W::merges_half_steps) merged_.end(system, cursor, x);
  }
  /// One step from only q and p. Cost: W::evaluations_of_plain_step.
  template <class T, System S>
  void step(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::merges_half_steps) merged_.begin(system, cursor, x);
    plain<W::merges_half_steps ? 1 : 0>(system, x, cursor);
    cursor.next();
    if constexpr (W::merges_half_steps) merged_.end(system, cursor, x);
  }

 private:
  using first = typename W::template letter<0>;
  static constexpr std::size_t end =
      W::merges_half_steps ? W::length - 1 : W::length;  // of loop and plain step

  /// Whether a step of an open run is drifts and kicks in turn, several of each, whose forces nothing else
  /// needs.
  static constexpr bool is_in_pairs = [] {
    constexpr std::size_t first = W::first_in_loop;
    if (!std::same_as<C, double> || end - first < 4 || (end - first) % 2 != 0) return false;
    constexpr std::array is_kick{std::same_as<L, kick>...};
    constexpr std::array is_drift{std::same_as<L, drift>...};
    for (std::size_t i = first; i < end; ++i) {
      if (!is_kick[i] && !is_drift[i]) return false;
      if (i > first && is_kick[i] == is_kick[i - 1]) return false;
      if (is_kick[i] && W::plan.in_loop[i] != evaluation::unshared) return false;
    }
    return true;
  }();

  template <std::size_t I>
  double folded() const {
    if constexpr (W::merges && I + 1 == W::length) {
      return merged_;
    } else {
      return std::get<I>(letters_);
    }
  }
  template <std::size_t... I>
  auto pairs_of_loop(std::index_sequence<I...>) const {
    constexpr std::size_t first = W::first_in_loop;
    return std::array{std::array{folded<first + 2 * I>(), folded<first + 2 * I + 1>()}...};
  }

  template <std::size_t... I>
  static auto prepare(const coefficients& c, double h, const surroundings_of_word& around,
                      std::index_sequence<I...>) {
    return std::tuple(
        detail::prepare_letter<typename W::template letter<I>, N>(&c[W::first_slot(I)], h, around)...);
  }

  template <std::size_t I, evaluation E, class T, System S>
  [[gnu::always_inline]] static void apply(const S& system, const auto& prepared,
                                           flow_state<T, S::dimension>& x, auto& cursor) {
    using letter = typename W::template letter<I>;
    if constexpr (StochasticFlow<letter>) {
      apply_noise(system, prepared, W::stochastic_number(I), cursor, x);
    } else if constexpr (E == evaluation::unshared &&
                         requires { letter::evaluate_and_apply(system, prepared, x, cursor.room); }) {
      letter::evaluate_and_apply(system, prepared, x, cursor.room);
    } else {
      if constexpr (E != evaluation::none) force_of<W::reads, T>(system, x.q, x.f);
      letter::apply(system, prepared, x, cursor.room);
    }
  }

  // Types, not arrays: g++ 12 confuses template parameters that are arrays of equal length.
  struct in_loop_plan {
    static constexpr auto evaluations = W::plan.in_loop;
  };
  struct in_last_plan {
    static constexpr auto evaluations = W::plan.in_last;
  };

  template <class Plan, std::size_t I, class T, System S>
  [[gnu::always_inline]] void loop(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    constexpr evaluation evaluates = Plan::evaluations[I];
    if constexpr (W::merges_half_steps && I == 0) {
      merged_.cross(system, cursor, x);
    } else if constexpr (W::merges && I + 1 == W::length) {
      apply<I, evaluates>(system, merged_, x, cursor);
    } else {
      apply<I, evaluates>(system, std::get<I>(letters_), x, cursor);
    }
    if constexpr (I + 1 < end) loop<Plan, I + 1>(system, x, cursor);
  }

  template <std::size_t I, class T, System S>
  [[gnu::always_inline]] void plain(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    constexpr evaluation evaluates = W::plan.in_step[I];
    apply<I, evaluates>(system, std::get<I>(letters_), x, cursor);
    if constexpr (I + 1 < end) plain<I + 1>(system, x, cursor);
  }

  using letters_type = decltype(prepare({}, 1.0, {}, std::make_index_sequence<W::length>{}));
  using first_type = std::tuple_element_t<0, letters_type>;

  letters_type letters_;
  std::conditional_t<W::merges_half_steps, merged_half_steps<C>, first_type>
      merged_{};       // last and first letter in one
  first_type undo_{};  // the first letter taken back
};

}  // namespace nysalt
