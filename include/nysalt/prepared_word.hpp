// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and the step folded in, letters known at compile time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>

#include "nysalt/force.hpp"
#include "nysalt/noise_seam.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

// clang-format off
/// open(system, x)                from a synchronous state to an open one: force and first letter where needed
/// advance(system, x, n, cursor)  n steps of an open run; last letter of a step and first of the next are one
/// close(system, x, cursor)       an open state becomes synchronous
/// step(system, x, cursor)        one plain step, letter by letter, from q and p alone
/// in_loop()                      itself, as a loop should hold it
/// The cursor says where the run is in its noise, and goes on with it.
// clang-format on
///
/// An open run is ahead of the synchronous state by a first letter that merges with the last. Where both are
/// of the bath it is behind instead: the letter O that meets the next step's is still to come.
template <class W, Scalar C>
class prepared_word;

/// Unrolled, nothing is decided while stepping.
template <Scalar C, Flow... L>
class prepared_word<word<L...>, C> {
  using W = word<L...>;

 public:
  prepared_word(const W&, const std::array<C, W::length>& c, double h, const bath* its)
      : letters_(prepare(c, h, its, std::make_index_sequence<W::length>{})) {
    if constexpr (W::merges) {
      seam_ = first::prepare(c[W::length - 1] + c[0], h);
      undo_ = first::prepare(-c[0], h);
    } else if constexpr (W::halves_meet) {
      seam_ = noise_seam<C>(std::get<W::length - 1>(letters_), std::get<0>(letters_), its->sigma() > 0.0);
    }
  }

  /// A copy: local coefficients cannot alias the system, so they stay in registers.
  prepared_word in_loop() const { return *this; }

  template <class T, System S>
  void open(const S& system, flow_state<T, S::dimension>& x) const {
    if constexpr (W::evaluations_to_open > 0) force<T>(system, x.q, x.f);
    if constexpr (W::merges) first::apply(system, std::get<0>(letters_), x);
  }
  template <class T, System S>
  [[gnu::always_inline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                      auto& cursor) const {
    constexpr bool last_differs = W::plan.in_last != W::plan.in_loop;
    for (std::int64_t n = last_differs ? 1 : 0; n < steps; ++n) {
      loop<in_loop_plan, W::first_in_loop>(system, x, cursor);
      cursor.next();
    }
    if constexpr (last_differs) {
      if (steps > 0) {
        loop<in_last_plan, W::first_in_loop>(system, x, cursor);
        cursor.next();
      }
    }
  }
  template <class T, System S>
  void close(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::merges) first::apply(system, undo_, x);
    if constexpr (W::halves_meet) seam_.end(system, cursor, x);
  }
  template <class T, System S>
  void step(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (W::halves_meet) seam_.begin(system, cursor, x);
    plain<W::halves_meet ? 1 : 0>(system, x, cursor);
    cursor.next();
    if constexpr (W::halves_meet) seam_.end(system, cursor, x);
  }

 private:
  using first = typename W::template letter<0>;
  static constexpr std::size_t end = W::halves_meet ? W::length - 1 : W::length;  // of loop and plain step

  template <Flow Letter>
  static auto prepare_letter(const C& c, double h, const bath* its) {
    if constexpr (StochasticFlow<Letter>) {
      return Letter::prepare(c, h, *its);
    } else {
      return Letter::prepare(c, h);
    }
  }
  template <std::size_t... I>
  static auto prepare(const std::array<C, W::length>& c, double h, const bath* its,
                      std::index_sequence<I...>) {
    return std::tuple(prepare_letter<typename W::template letter<I>>(c[I], h, its)...);
  }

  template <std::size_t I, evaluation E, class T, System S>
  [[gnu::always_inline]] static void apply(const S& system, const auto& prepared,
                                           flow_state<T, S::dimension>& x, auto& cursor) {
    using letter = typename W::template letter<I>;
    if constexpr (StochasticFlow<letter>) {
      apply_noise(system, prepared, W::stochastic_number(I), cursor, x);
    } else if constexpr (E == evaluation::alone &&
                         requires { letter::evaluate_and_apply(system, prepared, x); }) {
      letter::evaluate_and_apply(system, prepared, x);
    } else {
      if constexpr (E != evaluation::none) force<T>(system, x.q, x.f);
      letter::apply(system, prepared, x);
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
    if constexpr (W::halves_meet && I == 0) {
      seam_.cross(system, cursor, x);
    } else if constexpr (W::merges && I + 1 == W::length) {
      apply<I, evaluates>(system, seam_, x, cursor);
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

  using letters_type = decltype(prepare({}, 1.0, nullptr, std::make_index_sequence<W::length>{}));
  using first_type = std::tuple_element_t<0, letters_type>;

  letters_type letters_;
  std::conditional_t<W::halves_meet, noise_seam<C>, first_type> seam_{};  // last and first letter in one
  first_type undo_{};                                                     // the first letter taken back
};

}  // namespace nysalt
