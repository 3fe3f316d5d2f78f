// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and the step folded in, letters as data.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "nysalt/prepared_word.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// One decision a letter, the same operations in the same order, hence the same bits.
template <Scalar C>
class prepared_word<run_time_word, C> {
 public:
  /// Throws std::invalid_argument unless there is a coefficient for each letter.
  prepared_word(const run_time_word& w, const std::vector<C>& c, double h, const bath* its)
      : merges_(w.merges), halves_meet_(w.halves_meet), evaluates_to_open_(w.evaluations_to_open > 0) {
    w.require_one_for_each_letter(c);
    int number = 0;
    for (std::size_t i = 0; i < w.length; ++i) {
      plain_.push_back(prepare(w, i, c[i], h, its, w.plan().in_step[i]));
      if (w.letters()[i] == ornstein_uhlenbeck::letter) plain_.back().number = number++;
    }
    for (std::size_t i = w.first_in_loop(); i < w.length; ++i) {
      loop_.push_back(plain_[i]);
      if (merges_ && i + 1 == w.length) loop_.back() = prepare(w, i, c[i] + c[0], h, its, evaluation::none);
      last_.push_back(loop_.back());
      loop_.back().evaluates = w.plan().in_loop[i];
      last_.back().evaluates = w.plan().in_last[i];
    }
    if (merges_) undo_ = prepare(w, 0, -c[0], h, its, evaluation::none);
    if (!halves_meet_) return;
    seam_ = noise_seam<C>(plain_.back().noise, plain_.front().noise, its->sigma() > 0.0);
    for (auto* letters : {&plain_, &loop_, &last_}) {
      letters->pop_back();
      letters->erase(letters->begin());
    }
  }

  const prepared_word& in_loop() const { return *this; }

  template <class T, System S>
  void open(const S& system, flow_state<T, S::dimension>& x) const {
    if (evaluates_to_open_) force<T>(system, x.q, x.f);
    no_noise_cursor nothing;  // what merges is not of the bath
    prepared_letter first = plain_.front();
    first.evaluates = evaluation::none;
    if (merges_) apply(system, first, x, nothing);
  }
  template <class T, System S>
  [[gnu::always_inline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                      auto& cursor) const {
    for (std::int64_t n = 1; n <= steps; ++n) {
      if (halves_meet_) cross(system, x, cursor);
      for (const auto& letter : n < steps ? loop_ : last_) apply(system, letter, x, cursor);
      cursor.next();
    }
  }
  template <class T, System S>
  void close(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if (merges_) apply(system, undo_, x, cursor);
    if (halves_meet_) end(system, x, cursor);
  }
  template <class T, System S>
  void step(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if (halves_meet_) begin(system, x, cursor);
    for (const auto& letter : plain_) apply(system, letter, x, cursor);
    cursor.next();
    if (halves_meet_) end(system, x, cursor);
  }

 private:
  struct prepared_letter {
    char letter;
    evaluation evaluates;  // the force, before it
    C prepared;
    ornstein_uhlenbeck::prepared<C> noise;
    int number = 0;  // among the letters O
  };

  static prepared_letter prepare(const run_time_word& w, std::size_t i, const C& c, double h, const bath* its,
                                 evaluation evaluates) {
    prepared_letter result{w.letters()[i], evaluates, c, {}};
    detail::with_letter(result.letter, known_letters{}, [&](auto flow) {
      if constexpr (StochasticFlow<decltype(flow)>) {
        result.noise = flow.prepare(c, h, *its);
      } else {
        result.prepared = flow.prepare(c, h);
      }
    });
    return result;
  }

  template <class T, System S>
  [[gnu::always_inline]] static void apply(const S& system, const prepared_letter& l,
                                           flow_state<T, S::dimension>& x, auto& cursor) {
    const C prepared = l.prepared;
    if (l.evaluates == evaluation::shared) force<T>(system, x.q, x.f);
    detail::with_letter(
        l.letter, known_letters{}, [&](auto flow) __attribute__((always_inline)) {
          if constexpr (StochasticFlow<decltype(flow)>) {
            if constexpr (has_noise<decltype(cursor)>) apply_noise(system, l.noise, l.number, cursor, x);
          } else {
            if constexpr (requires { flow.evaluate_and_apply(system, prepared, x); }) {
              if (l.evaluates == evaluation::alone) return flow.evaluate_and_apply(system, prepared, x);
            }
            flow.apply(system, prepared, x);
          }
        });
  }

  template <class Cursor>
  static constexpr bool has_noise = !std::is_same_v<std::remove_cvref_t<Cursor>, no_noise_cursor>;

  template <class T, System S>
  void cross(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (has_noise<decltype(cursor)>) seam_.cross(system, cursor, x);
  }
  template <class T, System S>
  void begin(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (has_noise<decltype(cursor)>) seam_.begin(system, cursor, x);
  }
  template <class T, System S>
  void end(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (has_noise<decltype(cursor)>) seam_.end(system, cursor, x);
  }

  bool merges_;
  bool halves_meet_;
  bool evaluates_to_open_;
  std::vector<prepared_letter> plain_;
  std::vector<prepared_letter> loop_;
  std::vector<prepared_letter> last_;  // as loop_, and leaves the force where it is needed
  prepared_letter undo_{};
  noise_seam<C> seam_;
};

}  // namespace nysalt
