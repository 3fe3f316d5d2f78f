// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and the step folded in: the two forms in which the stepper applies letters.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "nysalt/force.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// open(system, x)        from a synchronous state to an open one: force and first letter where it needs them
/// advance(system, x, n)  n steps of an open run; last letter of a step and first of the next are one
/// close(system, x)       the first letter taken back: an open state becomes synchronous
/// step(system, x)        one plain step, letter by letter, from q and p alone
/// in_loop()              itself, as a loop should hold it
template <Word W, Scalar C>
class prepared_word;

/// Letters known at compile time: unrolled, nothing is decided while stepping.
template <Scalar C, Flow... L>
class prepared_word<word<L...>, C> {
  using W = word<L...>;

 public:
  prepared_word(const W&, const std::array<C, W::length>& c, double h)
      : letters_(prepare(c, h, std::make_index_sequence<W::length>{})) {
    if constexpr (W::merges) {
      seam_ = first::prepare(c[W::length - 1] + c[0], h);
      undo_ = first::prepare(-c[0], h);
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
  [[gnu::always_inline]] void advance(const S& system, flow_state<T, S::dimension>& x,
                                      std::int64_t steps) const {
    constexpr bool last_differs = W::plan.in_last != W::plan.in_loop;
    for (std::int64_t n = last_differs ? 1 : 0; n < steps; ++n) {
      loop<W::plan.in_loop, W::first_in_loop>(system, x);
    }
    if constexpr (last_differs) {
      if (steps > 0) loop<W::plan.in_last, W::first_in_loop>(system, x);
    }
  }
  template <class T, System S>
  void close(const S& system, flow_state<T, S::dimension>& x) const {
    if constexpr (W::merges) first::apply(system, undo_, x);
  }
  template <class T, System S>
  void step(const S& system, flow_state<T, S::dimension>& x) const {
    plain<0>(system, x);
  }

 private:
  using first = typename W::template letter<0>;

  template <std::size_t... I>
  static auto prepare(const std::array<C, W::length>& c, double h, std::index_sequence<I...>) {
    return std::tuple(W::template letter<I>::prepare(c[I], h)...);
  }

  template <Flow Letter, evaluation E, class T, System S>
  [[gnu::always_inline]] static void apply(const S& system, const auto& prepared,
                                           flow_state<T, S::dimension>& x) {
    if constexpr (E == evaluation::alone && requires { Letter::evaluate_and_apply(system, prepared, x); }) {
      Letter::evaluate_and_apply(system, prepared, x);
    } else {
      if constexpr (E != evaluation::none) force<T>(system, x.q, x.f);
      Letter::apply(system, prepared, x);
    }
  }

  template <auto Evaluations, std::size_t I, class T, System S>
  [[gnu::always_inline]] void loop(const S& system, flow_state<T, S::dimension>& x) const {
    using letter = typename W::template letter<I>;
    if constexpr (W::merges && I + 1 == W::length) {
      apply<letter, Evaluations[I]>(system, seam_, x);
    } else {
      apply<letter, Evaluations[I]>(system, std::get<I>(letters_), x);
    }
    if constexpr (I + 1 < W::length) loop<Evaluations, I + 1>(system, x);
  }

  template <std::size_t I, class T, System S>
  [[gnu::always_inline]] void plain(const S& system, flow_state<T, S::dimension>& x) const {
    using letter = typename W::template letter<I>;
    apply<letter, W::plan.in_step[I]>(system, std::get<I>(letters_), x);
    if constexpr (I + 1 < W::length) plain<I + 1>(system, x);
  }

  using letters_type =
      decltype(prepare(std::array<C, W::length>{}, 1.0, std::make_index_sequence<W::length>{}));

  letters_type letters_;
  std::tuple_element_t<0, letters_type> seam_{};  // last and first letter in one
  std::tuple_element_t<0, letters_type> undo_{};  // the first letter taken back
};

/// Letters as data: one decision a letter, the same operations in the same order, hence the same bits.
template <Scalar C>
class prepared_word<run_time_word, C> {
 public:
  /// Throws std::invalid_argument unless there is a coefficient for each letter.
  prepared_word(const run_time_word& w, const std::vector<C>& c, double h)
      : merges_(w.merges), evaluates_to_open_(w.evaluations_to_open > 0) {
    if (c.size() != w.length) {
      throw std::invalid_argument(fmt::format("the word {} has {} letters, but {} coefficients are given",
                                              w.letters(), w.length, c.size()));
    }
    const auto prepare = [&](std::size_t i, const C& coefficient, evaluation e) {
      prepared_letter result{w.letters()[i], e, coefficient};
      detail::with_letter(result.letter, known_letters{},
                          [&](auto flow) { result.prepared = flow.prepare(coefficient, h); });
      return result;
    };
    for (std::size_t i = 0; i < w.length; ++i) plain_.push_back(prepare(i, c[i], w.plan().in_step[i]));
    for (std::size_t i = w.first_in_loop(); i < w.length; ++i) {
      const bool is_seam = merges_ && i + 1 == w.length;
      const C coefficient = is_seam ? c[i] + c[0] : c[i];
      loop_.push_back(prepare(i, coefficient, w.plan().in_loop[i]));
      last_.push_back(prepare(i, coefficient, w.plan().in_last[i]));
    }
    undo_.push_back(prepare(0, -c[0], evaluation::none));
  }

  const prepared_word& in_loop() const { return *this; }

  template <class T, System S>
  void open(const S& system, flow_state<T, S::dimension>& x) const {
    if (evaluates_to_open_) force<T>(system, x.q, x.f);
    if (merges_) apply(system, {plain_[0].letter, evaluation::none, plain_[0].prepared}, x);
  }
  template <class T, System S>
  [[gnu::always_inline]] void advance(const S& system, flow_state<T, S::dimension>& x,
                                      std::int64_t steps) const {
    for (std::int64_t n = 1; n <= steps; ++n) {
      for (const auto& letter : n < steps ? loop_ : last_) apply(system, letter, x);
    }
  }
  template <class T, System S>
  void close(const S& system, flow_state<T, S::dimension>& x) const {
    if (merges_) apply(system, undo_[0], x);
  }
  template <class T, System S>
  void step(const S& system, flow_state<T, S::dimension>& x) const {
    for (const auto& letter : plain_) apply(system, letter, x);
  }

 private:
  struct prepared_letter {
    char letter;
    evaluation evaluates;  // the force, before it
    C prepared;
  };

  template <class T, System S>
  [[gnu::always_inline]] static void apply(const S& system, const prepared_letter& l,
                                           flow_state<T, S::dimension>& x) {
    const C prepared = l.prepared;
    if (l.evaluates == evaluation::shared) force<T>(system, x.q, x.f);
    detail::with_letter(
        l.letter, known_letters{}, [&](auto flow) __attribute__((always_inline)) {
          if constexpr (requires { flow.evaluate_and_apply(system, prepared, x); }) {
            if (l.evaluates == evaluation::alone) return flow.evaluate_and_apply(system, prepared, x);
          }
          flow.apply(system, prepared, x);
        });
  }

  bool merges_;
  bool evaluates_to_open_;
  std::vector<prepared_letter> plain_;
  std::vector<prepared_letter> loop_;
  std::vector<prepared_letter> last_;  // as loop_, and leaves the force where it is needed
  std::vector<prepared_letter> undo_;
};

}  // namespace nysalt
