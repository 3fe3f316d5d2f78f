// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and the step folded in, letters as data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "nysalt/detail/kernels.hpp"
#include "nysalt/prepared_word.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt {

/// Of letters as data: one decision a letter, the same operations in the same order, hence the same bits.
/// Nothing is inlined where it is used: each scalar is compiled once, and a call costs little beside the
/// decisions.
template <Scalar C, int N>
class prepared_word<run_time_word, C, N> {
 public:
  static constexpr bool needs_room = true;  // perhaps

  /// Folds step and surroundings into the coefficients. Throws std::invalid_argument unless there is a
  /// coefficient for each slot.
  prepared_word(const run_time_word& w, const std::vector<C>& c, double h, const surroundings_of_word& its)
      : merges_(w.merges),
        halves_meet_(w.halves_meet),
        evaluates_to_open_(w.evaluations_to_open > 0),
        reads_soft_(w.reads == field::soft) {
    w.require_one_for_each_slot(c);
    int number = 0;
    for (std::size_t i = 0; i < w.length; ++i) {
      plain_.push_back(prepare(w, i, &c[w.first_slot(i)], h, its, w.plan().in_step[i]));
      if (w.letters()[i] == ornstein_uhlenbeck::letter) plain_.back().number = number++;
    }
    for (std::size_t i = w.first_in_loop(); i < w.length; ++i) {
      loop_.push_back(plain_[i]);
      if (merges_ && i + 1 == w.length) {  // letters that merge have one coefficient
        const std::array both{C(c.back() + c.front()), C(0.0)};
        loop_.back() = prepare(w, i, both.data(), h, its, evaluation::none);
      }
      last_.push_back(loop_.back());
      loop_.back().evaluates = w.plan().in_loop[i];
      last_.back().evaluates = w.plan().in_last[i];
    }
    const std::array back{C(-c.front()), C(0.0)};
    if (merges_) undo_ = prepare(w, 0, back.data(), h, its, evaluation::none);
    if (halves_meet_) {
      seam_ = noise_seam<C>(plain_.back().noise, plain_.front().noise, its.its_bath->sigma() > 0.0);
      for (auto* letters : {&plain_, &loop_, &last_}) {
        letters->pop_back();
        letters->erase(letters->begin());
      }
    }
    run_program_ = program(loop_, last_, w.stochastic_letters > 0);
    if (merges_) run_program_.undo = {translated(undo_, 0)};
    run_program_.find_pairs();
    plain_program_ = program(plain_, plain_, w.stochastic_letters > 0);
  }

  /// What the loop applies: itself, as its letters lie elsewhere and no copy would be nearer.
  const prepared_word& in_loop() const { return *this; }

  /// Opens a run. Cost: the word's evaluations_to_open.
  template <class T, System S>
  [[gnu::noinline]] void open(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if (evaluates_to_open_) evaluate<T>(system, x);
    if (!merges_) return;
    prepared_letter first = plain_.front();
    first.evaluates = evaluation::none;
    apply(system, first, x, cursor);
  }
  /// Steps of an open run. Cost: the word's evaluations_per_step each.
  template <class T, System S>
  [[gnu::noinline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                 auto& cursor) const {
    if constexpr (ErasedSystem<S>) return take_steps(system, run_program_, loop_, last_, x, steps, cursor);
    for (std::int64_t n = 1; n <= steps; ++n) {
      if (halves_meet_) cross(system, x, cursor);
      for (const auto& letter : n < steps ? loop_ : last_) apply(system, letter, x, cursor);
      cursor.next();
    }
  }
  /// The same of an erased system, watched: look() is called with the synchronous state in y after `first`
  /// steps, and after every so many from there on.
  template <class T, ErasedSystem S>
  void advance(const S& system, flow_state<T, S::dimension>& x, flow_state<T, S::dimension>& y,
               std::int64_t steps, std::int64_t first, std::int64_t every, auto& cursor,
               const auto& look) const {
    const auto see = [&] {
      if (halves_meet_) end(system, y, cursor);
      look();
    };
    const detail::watch<T> watched{.q = &y.q,
                                   .p = &y.p,
                                   .first = first,
                                   .every = every,
                                   .look = [](void* context) { (*static_cast<decltype(see)*>(context))(); },
                                   .context = const_cast<void*>(static_cast<const void*>(&see))};
    take_steps(system, run_program_, loop_, last_, x, steps, cursor, watched);
  }
  /// What an open state is at its step. No evaluation.
  template <class T, System S>
  [[gnu::noinline]] void close(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if (merges_) apply(system, undo_, x, cursor);
    if (halves_meet_) end(system, x, cursor);
  }
  /// One step from q and p alone. Cost: the word's evaluations_of_plain_step.
  template <class T, System S>
  [[gnu::noinline]] void step(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if (halves_meet_) begin(system, x, cursor);
    if constexpr (ErasedSystem<S>) {
      take_steps(system, plain_program_, plain_, plain_, x, 1, cursor);
    } else {
      for (const auto& letter : plain_) apply(system, letter, x, cursor);
      cursor.next();
    }
    if (halves_meet_) end(system, x, cursor);
  }

 private:
  struct prepared_letter {
    char letter = ' ';
    evaluation evaluates = evaluation::none;  // of the force, before it
    C prepared{0.0};
    gradient_kick_coefficients<C> gradient{};
    ornstein_uhlenbeck::prepared<C> noise{};
    int number = 0;  // among the letters O
    std::shared_ptr<const rotation::prepared<C, N>> turn{};
  };

  using program_type = detail::step_program<C>;
  // What a program calls back beside its letters.
  static constexpr int next_step = -1;
  static constexpr int seam_of_steps = -2;
  static constexpr int ends_step = 1 << 20;  // with the number of a letter O that is the last of a step

  static typename program_type::letter translated(const prepared_letter& l, int number) {
    using detail::action;
    typename program_type::letter result{
        .evaluates = l.evaluates, .number = number, .coefficient = l.prepared};
    result.gradient = l.gradient;
    if constexpr (N == Eigen::Dynamic) result.turn = l.turn.get();
    switch (l.letter) {
      case drift::letter:
        result.what = action::drift;
        break;
      case kick::letter:
      case soft_kick::letter:
        result.what = action::kick;
        break;
      case gradient_kick::letter:
      case soft_gradient_kick::letter:
        result.what = action::gradient_kick;
        break;
      case rotation::letter:
        result.what = action::rotation;
        break;
      default:
        break;
    }
    return result;
  }

  program_type program(const std::vector<prepared_letter>& loop, const std::vector<prepared_letter>& last,
                       bool has_noise) const {
    program_type result;
    result.reads = reads_soft_ ? field::soft : field::whole;
    result.calls = has_noise;
    const auto translate = [&](const std::vector<prepared_letter>& letters, int first) {
      std::vector<typename program_type::letter> all;
      if (halves_meet_ && &letters != &plain_) all.push_back({.number = seam_of_steps});
      for (const prepared_letter& l : letters) all.push_back(translated(l, first++));
      if (!all.empty() && has_noise && all.back().what == detail::action::call && all.back().number >= 0) {
        all.back().number |= ends_step;
      } else if (has_noise) {
        all.push_back({.number = next_step});
      }
      return all;
    };
    result.loop = translate(loop, 0);
    result.last = translate(last, static_cast<int>(loop.size()));
    return result;
  }

  /// Steps of a system whose kernels know all letters but those of the bath.
  template <class T, System S>
  void take_steps(const S& system, const program_type& letters, const std::vector<prepared_letter>& loop,
                  const std::vector<prepared_letter>& last, flow_state<T, S::dimension>& x,
                  std::int64_t steps, auto& cursor, const detail::watch<T>& watched = {}) const {
    const auto act = [&](int number) {
      if (number == next_step) return cursor.next();
      if (number == seam_of_steps) return cross(system, x, cursor);
      const auto k = static_cast<std::size_t>(number & ~ends_step);
      const prepared_letter& l = k < loop.size() ? loop[k] : last[k - loop.size()];
      if constexpr (is_noisy<decltype(cursor)>) apply_noise(system, l.noise, l.number, cursor, x);
      if ((number & ends_step) != 0) cursor.next();
    };
    const detail::callback other{
        [](void* context, int number) { (*static_cast<decltype(act)*>(context))(number); },
        const_cast<void*>(static_cast<const void*>(&act))};
    system.template kernels<T>().advance(x.q, x.p, x.f, cursor.room, letters, steps, other, watched);
  }

  static prepared_letter prepare(const run_time_word& w, std::size_t i, const C* c, double h,
                                 const surroundings_of_word& its, evaluation evaluates) {
    prepared_letter result{.letter = w.letters()[i], .evaluates = evaluates};
    detail::with_letter(result.letter, known_letters{}, [&](auto flow) {
      using letter = decltype(flow);
      auto folded = detail::prepare_letter<letter, N>(c, h, its);
      if constexpr (StochasticFlow<letter>) {
        result.noise = folded;
      } else if constexpr (QuadraticFlow<letter>) {
        result.turn = std::make_shared<const rotation::prepared<C, N>>(std::move(folded));
      } else if constexpr (letter::slots == 2) {
        result.gradient = folded;
      } else {
        result.prepared = folded;
      }
    });
    return result;
  }

  template <class T, System S>
  [[gnu::noinline]] void evaluate(const S& system, flow_state<T, S::dimension>& x) const {
    if constexpr (HasQuadraticPart<S> && ForceOver<S, T, field::soft>) {
      if (reads_soft_) return force_of<field::soft, T>(system, x.q, x.f);
    }
    force<T>(system, x.q, x.f);
  }

  template <class T, System S>
  [[gnu::always_inline]] void apply(const S& system, const prepared_letter& l, flow_state<T, S::dimension>& x,
                                    auto& cursor) const {
    if (l.evaluates == evaluation::shared) evaluate<T>(system, x);
    detail::with_letter(
        l.letter, known_letters{}, [&](auto flow) __attribute__((always_inline)) {
          using letter = decltype(flow);
          if constexpr (StochasticFlow<letter>) {
            if constexpr (is_noisy<decltype(cursor)>) apply_noise(system, l.noise, l.number, cursor, x);
          } else if constexpr (!letter::template serves<S, T>) {
            // the stepper has refused it
          } else if constexpr (QuadraticFlow<letter> || letter::slots == 2) {
            apply_large<letter, T>(system, l, x, cursor.room);
          } else {
            const C prepared = l.prepared;
            if constexpr (requires { flow.evaluate_and_apply(system, prepared, x, cursor.room); }) {
              if (l.evaluates == evaluation::alone) {
                return flow.evaluate_and_apply(system, prepared, x, cursor.room);
              }
            }
            flow.apply(system, prepared, x, cursor.room);
          }
        });
  }

  /// Compiled once, and not wherever a letter may stand: a call costs nothing beside it.
  template <Flow Letter, class T, System S>
  [[gnu::noinline]] void apply_large(const S& system, const prepared_letter& l,
                                     flow_state<T, S::dimension>& x, auto& room) const {
    if constexpr (QuadraticFlow<Letter>) {
      Letter::apply(system, *l.turn, x, room);
    } else {
      if (l.evaluates == evaluation::alone) evaluate<T>(system, x);
      Letter::apply(system, l.gradient, x, room);
    }
  }

  template <class Cursor>
  static constexpr bool is_noisy = std::remove_cvref_t<Cursor>::is_noisy;

  template <class T, System S>
  void cross(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (is_noisy<decltype(cursor)>) seam_.cross(system, cursor, x);
  }
  template <class T, System S>
  void begin(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (is_noisy<decltype(cursor)>) seam_.begin(system, cursor, x);
  }
  template <class T, System S>
  void end(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (is_noisy<decltype(cursor)>) seam_.end(system, cursor, x);
  }

  bool merges_;
  bool halves_meet_;
  bool evaluates_to_open_;
  bool reads_soft_;
  std::vector<prepared_letter> plain_;
  std::vector<prepared_letter> loop_;
  std::vector<prepared_letter> last_;  // as loop_, and leaves the force where it is needed
  prepared_letter undo_;
  program_type run_program_;  // the same for kernels
  program_type plain_program_;
  noise_seam<C> seam_;
};

}  // namespace nysalt
