// SPDX-License-Identifier: BSL-1.0
// The interpreter of letters as data: steps of a system by its type.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

#include "nysalt/detail/prepared_word.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/step_program.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/run_time_word.hpp"

namespace nysalt::detail {

/// A vector of N entries where it lies.
template <int N, class T>
auto& as_fixed(vector<T, Eigen::Dynamic>& x) {
  if constexpr (N == Eigen::Dynamic) {
    return x;
  } else {
    return reinterpret_cast<vector<T, N>&>(*x.data());
  }
}
template <int N, class T>
const auto& as_fixed(const vector<T, Eigen::Dynamic>& x) {
  if constexpr (N == Eigen::Dynamic) {
    return x;
  } else {
    return reinterpret_cast<const vector<T, N>&>(*x.data());
  }
}

/// A state where it lies: letters that are called back change it.
template <class T, int N>
struct state_in_place {
  using scalar_type = T;
  vector<T, N>& q;
  vector<T, N>& p;
  vector<T, N>& f;
  Eigen::Index size() const { return q.size(); }
};

template <field F, class S, class State, class C>
[[gnu::noinline]] void apply_gradient_kick(const S& system, const step_program_letter<C>& letter, State& x,
                                           auto& room) {
  using T = typename State::scalar_type;
  if constexpr (gradient_kick_of<F>::template serves<S, T>) {
    const gradient_kick_coefficients<C> c = letter.gradient;
    if (letter.evaluates != evaluation::none) force_of<F, T>(system, x.q, x.f);
    gradient_kick_of<F>::apply(system, c, x, room);
  }
}

template <class S, class State, class C>
[[gnu::noinline]] void apply_displaced_kick(const S& system, const step_program_letter<C>& letter, State& x,
                                            auto& room) {
  using T = typename State::scalar_type;
  if constexpr (displaced_kick::serves<S, T>) {
    const displaced_kick_coefficients<C> c = letter.displaced;
    if (letter.evaluates != evaluation::none) force<T>(system, x.q, x.f);
    displaced_kick::apply(system, c, x, room);
  }
}

template <class S, class State, class C>
[[gnu::noinline]] void apply_rotation(const S& system, const step_program_letter<C>& letter, State& x,
                                      auto& room) {
  if constexpr (rotation::serves<S, typename State::scalar_type>) {
    rotation::apply(system, *letter.turn, x, room);
  }
}

/// One letter. The system is inlined: with several users of its force g++ would not.
template <field F, class S, class State, class C>
[[gnu::always_inline]] inline void apply_letter(const S& system, const step_program_letter<C>& letter,
                                                State& x, auto& room, const callback& other) {
  using T = typename State::scalar_type;
  switch (letter.what) {
    case action::drift: {
      const C c = letter.coefficient;  // local: it cannot alias the state
      drift::apply(system, c, x, room);
      break;
    }
    case action::kick: {
      const C c = letter.coefficient;
      if constexpr (F == field::whole && HasKick<S, T, C>) {
        if (letter.evaluates == evaluation::unshared) return system.kick(x.q, x.p, c);
      }
      if (letter.evaluates != evaluation::none) force_of<F, T>(system, x.q, x.f);
      kick_of<F>::apply(system, c, x, room);
      break;
    }
    case action::gradient_kick:
      apply_gradient_kick<F>(system, letter, x, room);
      break;
    case action::displaced_kick:
      apply_displaced_kick(system, letter, x, room);
      break;
    case action::rotation:
      apply_rotation(system, letter, x, room);
      break;
    case action::call:
      other.call(other.context, letter.number);
      break;
  }
}

/// A letter for which no force is evaluated: one that merges, when a run is opened or observed.
template <field F, class S, class State, class C>
void apply_known(const S& system, const step_program_letter<C>& letter, State& x, auto& room) {
  const C c = letter.coefficient;
  if (letter.what == action::drift) drift::apply(system, c, x, room);
  if (letter.what == action::kick) kick_of<F>::apply(system, c, x, room);
  if (letter.what == action::rotation) apply_rotation(system, letter, x, room);
}

/// Interpreter loop: `steps` steps of any program.
template <field F, class S, class State, class C>
[[gnu::flatten, gnu::noinline]] void take_any_steps(const S& system, State& x, auto& room,
                                                    const step_program<C>& letters, std::int64_t steps,
                                                    const callback& other) {
  for (std::int64_t n = 1; n <= steps; ++n) {
    for (const auto& letter : n < steps ? letters.loop : letters.last) {
      apply_letter<F>(system, letter, x, room, other);
    }
  }
}

/// Observation: copies the state, takes the merged first letter back on the copy, and calls the observer.
template <field F, class S, class T, class C, class State>
void show(const S& system, State& x, auto& room, const step_program<C>& letters, const watch<T>& watched) {
  constexpr int N = S::dimension;
  state_in_place<T, N> seen{as_fixed<N>(*watched.q), as_fixed<N>(*watched.p), x.f};
  for (Eigen::Index i = 0; i < x.q.size(); ++i) {
    seen.q[i] = x.q[i];
    seen.p[i] = x.p[i];
  }
  for (const auto& letter : letters.undo) apply_known<F>(system, letter, seen, room);
  watched.observe(watched.context);
}

/// Splits `steps` steps at the observation times: go_on(n) takes n steps, observe() observes.
template <class T>
[[gnu::always_inline]] inline void watch_steps(std::int64_t steps, const watch<T>& watched, const auto& go_on,
                                               const auto& observe) {
  std::int64_t step = 0;
  std::int64_t next = watched.observe == nullptr ? steps + 1 : watched.first;
  while (step < steps) {
    const std::int64_t end = std::min(next, steps);
    go_on(end - step);
    step = end;
    if (step != next) return;
    observe();
    next += watched.every;
  }
}

/// Steps of a program of drifts and kicks in turn.
template <class S, class T>
[[gnu::flatten, gnu::noinline]] void take_steps_in_pairs(const S& system, state_in_place<T, S::dimension>& x,
                                                         auto& room, const step_program<double>& letters,
                                                         std::int64_t steps, const watch<T>& watched) {
  const auto take = [&]<pair_begins Begins, last_force Last>() __attribute__((always_inline)) {
    watch_steps(
        steps, watched,
        [&](std::int64_t count) __attribute__((always_inline)) {
          take_pairs<Begins, Last, T>(system, x, room, letters.pairs.data(), letters.pairs.size(), count);
        },
        [&] { show<field::whole, S, T, double>(system, x, room, letters, watched); });
  };
  if (letters.begins_with_kick) {
    take.template operator()<pair_begins::with_kick, last_force::unknown>();
  } else if (letters.keeps_last_force) {
    take.template operator()<pair_begins::with_drift, last_force::stored>();
  } else {
    take.template operator()<pair_begins::with_drift, last_force::unknown>();
  }
}

/// `steps` steps, observed or not: by take_steps_in_pairs() where the program allows it.
template <field F, class S, class T, class C>
void take_steps(const S& system, state_in_place<T, S::dimension>& x, auto& room,
                const step_program<C>& letters, std::int64_t steps, const callback& other,
                const watch<T>& watched) {
  if constexpr (F == field::whole && std::same_as<C, double> && !is_dual<T>) {
    if (!letters.pairs.empty()) return take_steps_in_pairs(system, x, room, letters, steps, watched);
  }
  watch_steps(
      steps, watched, [&](std::int64_t count) { take_any_steps<F>(system, x, room, letters, count, other); },
      [&] { show<F, S, T, C>(system, x, room, letters, watched); });
}

/// The same by the field that the letters read.
template <class S, class T, class C>
void take_steps_of_word(const S& system, state_in_place<T, S::dimension>& x, auto& room,
                        const step_program<C>& letters, std::int64_t steps, const callback& other,
                        const watch<T>& watched) {
  if constexpr (HasQuadraticPart<S> && ForceOver<S, T, field::soft>) {
    if (letters.reads == field::soft) {
      return take_steps<field::soft>(system, x, room, letters, steps, other, watched);
    }
  }
  take_steps<field::whole>(system, x, room, letters, steps, other, watched);
}

}  // namespace nysalt::detail

// A word with its coefficients and the step folded in, letters as data.

namespace nysalt {

/// Of letters as data: the same operations in the same order as of a type, hence the same bits. Letters of
/// the bath and of one's own are done here, all others by the system's kernels: in one virtual call for many
/// steps where the system is a model.
template <Scalar C, int N>
class prepared_word<run_time_word, C, N> {
 public:
  static constexpr bool needs_room = true;  // perhaps

  /// Folds step and surroundings into the coefficients. Throws std::invalid_argument unless there is a
  /// coefficient for each slot.
  prepared_word(const run_time_word& w, const std::vector<C>& c, double h, const surroundings_of_word& around)
      : merges_(w.merges),
        merges_half_steps_(w.merges_half_steps),
        evaluates_to_open_(w.plan().is_known_when_open) {
    w.require_one_for_each_slot(c);
    if (w.is_processed()) {
      before_ = plain(detail::pre_processor(w), detail::pre_processor_coefficients(w, c), h, around);
      after_ = plain(detail::post_processor(w), detail::post_processor_coefficients(w, c), h, around);
    }
    run_.reads = plain_.reads = w.reads == field::soft ? field::soft : field::whole;
    run_.calls = plain_.calls = w.stochastic_letters > 0;
    run_.threads = around.threads;
    if (merges_half_steps_) run_.loop.push_back({.number = seam_of_steps});
    if (merges_half_steps_) run_.last.push_back({.number = seam_of_steps});
    for (std::size_t i = 0; i < w.length; ++i) {
      const letter one = prepare(w, i, &c[w.first_slot(i)], h, around);
      const bool is_at_seam = merges_half_steps_ && (i == 0 || i + 1 == w.length);
      if (!is_at_seam) plain_.loop.push_back(evaluating(one, w.plan().in_step[i]));
      if (i < w.first_in_loop() || is_at_seam) continue;
      letter in_run = one;
      if (merges_ && i + 1 == w.length) {
        std::vector<C> both;
        for (std::size_t k = 0; k < w.slots_of(0); ++k) both.push_back(C(c[w.first_slot(i) + k] + c[k]));
        in_run = prepare(w, i, both.data(), h, around);
      }
      run_.loop.push_back(evaluating(in_run, w.plan().in_loop[i]));
      run_.last.push_back(evaluating(in_run, w.plan().in_last[i]));
    }
    if (merges_) {
      std::vector<C> back;
      for (std::size_t k = 0; k < w.slots_of(0); ++k) back.push_back(C(-c[k]));
      first_ = prepare(w, 0, c.data(), h, around);
      run_.undo = {prepare(w, 0, back.data(), h, around)};
    }
    if (merges_half_steps_) {
      const bool is_warm = around.heat_bath->sigma() > 0.0;
      merged_ = merged_half_steps<C>(noise_.back(), noise_.front(), is_warm);
    }
    for (auto* letters : {&run_.loop, &run_.last, &plain_.loop}) end_step(*letters);
    plain_.last = plain_.loop;
    run_.find_pairs();
  }

  /// What the loop applies: the word itself, as its letters lie elsewhere and no copy would be nearer.
  const prepared_word& in_loop() const { return *this; }

  /// The letters of an open run.
  const detail::step_program<C>& program() const { return run_; }

  /// Opens a run. Cost: the word's evaluations_to_open.
  template <class T, System S>
  [[gnu::noinline]] void open(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    take(system, before_, x, 1, cursor, {});
    if (evaluates_to_open_) evaluate<T>(system, x);
    if (merges_) apply_known(system, first_, x, cursor);
  }
  /// Steps of an open run. Cost: the word's evaluations_per_step each.
  template <class T, System S>
  [[gnu::noinline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                 auto& cursor) const {
    take(system, run_, x, steps, cursor, {});
  }
  /// The same of an erased system, watched: observe() is called with the synchronous state in y after `first`
  /// steps, and every `every` steps from there on.
  template <class T, ErasedSystem S>
  void advance(const S& system, flow_state<T, S::dimension>& x, flow_state<T, S::dimension>& y,
               std::int64_t steps, std::int64_t first, std::int64_t every, auto& cursor,
               const auto& observe) const {
    const auto see = [&] {
      if (merges_ && is_own(run_.undo.front())) apply_own(run_.undo.front().number, y, cursor.room);
      end(system, y, cursor);
      observe();
    };
    take(system, run_, x, steps, cursor,
         detail::watch<T>{.q = &y.q,
                          .p = &y.p,
                          .first = first,
                          .every = every,
                          .observe = [](void* context) { (*static_cast<decltype(see)*>(context))(); },
                          .context = const_cast<void*>(static_cast<const void*>(&see))});
  }
  /// What an open state is at its step. Cost: the word's evaluations_to_observe.
  template <class T, System S>
  [[gnu::noinline]] void close(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    close_kernel(system, x, cursor);
    end(system, x, cursor);
  }
  /// The same without the bath and without P(-h). No evaluation.
  template <class T, System S>
  void close_kernel(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if (merges_) apply_known(system, run_.undo.front(), x, cursor);
  }
  /// One step from only q and p. Cost: the word's evaluations_of_plain_step.
  template <class T, System S>
  [[gnu::noinline]] void step(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (is_noisy<decltype(cursor)>) {
      if (merges_half_steps_) merged_.begin(system, cursor, x);
    }
    take(system, before_, x, 1, cursor, {});
    take(system, plain_, x, 1, cursor, {});
    end(system, x, cursor);
  }

 private:
  using letter = detail::step_program_letter<C>;
  using turn = rotation::prepared<C, Eigen::Dynamic>;

  // What is called back: letter O number k as k, and
  static constexpr int next_step = -1;
  static constexpr int seam_of_steps = -2;
  static constexpr int ends_step = 1 << 20;  // with the number of a letter O that is the last of a step
  static constexpr int first_own = 1 << 24;  // and letter of one's own number k as first_own + k

  letter prepare(const run_time_word& w, std::size_t i, const C* c, double h,
                 const surroundings_of_word& around) {
    letter result;
    if (const auto* own = w.own_letter(w.letters()[i])) {
      if constexpr (detail::carries_own_letters<C>) {
        result.number = first_own + static_cast<int>(own_.size());
        own_.push_back(own->prepare(c, h));
        return result;
      } else {
        throw std::invalid_argument(
            sentence("the word {} as data must have no letters of one's own for such derivatives; take the "
                     "word by its type",
                     w.letters()));
      }
    }
    detail::with_letter(w.letters()[i], known_letters{}, [&](auto flow) {
      using L = decltype(flow);
      auto folded = detail::prepare_letter<L, Eigen::Dynamic>(c, h, around);
      if constexpr (StochasticFlow<L>) {
        result.number = static_cast<int>(noise_.size());
        noise_.push_back(folded);
      } else if constexpr (QuadraticFlow<L>) {
        turns_.push_back(std::make_shared<const turn>(std::move(folded)));
        result.what = detail::action::rotation;
        result.turn = turns_.back().get();
      } else if constexpr (detail::displaced_forces_of<L>() > 0) {
        result.what = detail::action::displaced_kick;
        result.displaced = folded;
      } else if constexpr (L::slots == 2) {
        result.what = detail::action::gradient_kick;
        result.gradient = folded;
      } else {
        result.what = L::reads == field::none ? detail::action::drift : detail::action::kick;
        result.coefficient = folded;
      }
    });
    return result;
  }
  static letter evaluating(letter one, evaluation evaluates) {
    one.evaluates = evaluates;
    return one;
  }
  /// The cursor goes on with the last letter O where a step ends with it, else by a call of its own.
  void end_step(std::vector<letter>& letters) const {
    if (!run_.calls) return;
    const bool by_letter = !letters.empty() && letters.back().what == detail::action::call &&
                           letters.back().number >= 0 && letters.back().number < ends_step;
    if (by_letter) {
      letters.back().number |= ends_step;
    } else {
      letters.push_back({.number = next_step});
    }
  }

  /// A plain step of a word of letters that take no other number than their coefficient.
  detail::step_program<C> plain(const run_time_word& w, const std::vector<C>& c, double h,
                                const surroundings_of_word& around) {
    detail::step_program<C> result;
    result.reads = field::whole;
    for (std::size_t i = 0; i < w.length; ++i) {
      result.loop.push_back(evaluating(prepare(w, i, &c[w.first_slot(i)], h, around), w.plan().in_step[i]));
    }
    result.last = result.loop;
    result.find_pairs();
    return result;
  }

  /// Nothing of an empty program.
  template <class T, System S>
  void take(const S& system, const detail::step_program<C>& letters, flow_state<T, S::dimension>& x,
            std::int64_t steps, auto& cursor, const detail::watch<T>& watched) const {
    if (letters.loop.empty()) return;
    const auto act = [&](int number) {
      if (number >= first_own) return apply_own(number, x, cursor.room);
      if constexpr (is_noisy<decltype(cursor)>) {
        if (number == seam_of_steps) return merged_.cross(system, cursor, x);
        if (number != next_step) {
          const int k = number & ~ends_step;
          apply_noise(system, noise_[static_cast<std::size_t>(k)], k, cursor, x);
          if (k == number) return;
        }
        cursor.next();
      }
    };
    const detail::callback other{
        [](void* context, int number) { (*static_cast<decltype(act)*>(context))(number); },
        const_cast<void*>(static_cast<const void*>(&act))};
    if constexpr (ErasedSystem<S>) {
      system.template kernels<T>().advance(x.q, x.p, x.f, cursor.room, letters, steps, other, watched);
    } else {
      detail::state_in_place<T, S::dimension> in_place{x.q, x.p, x.f};
      detail::take_steps_of_word(system, in_place, cursor.room, letters, steps, other, watched);
    }
  }

  template <class T, System S>
  [[gnu::noinline]] void evaluate(const S& system, flow_state<T, S::dimension>& x) const {
    if constexpr (HasQuadraticPart<S> && ForceOver<S, T, field::soft>) {
      if (run_.reads == field::soft) return force_of<field::soft, T>(system, x.q, x.f);
    }
    force<T>(system, x.q, x.f);
  }
  static bool is_own(const letter& one) {
    return one.what == detail::action::call && one.number >= first_own;
  }
  template <class T, int Size>
  [[gnu::noinline]] void apply_own(int number, flow_state<T, Size>& x, auto& room) const {
    if constexpr (detail::prepared_own_letter<C>::template serves<T>) {
      const auto& one = own_[static_cast<std::size_t>(number - first_own)].template over<T>();
      if constexpr (Size == Eigen::Dynamic) {
        if (one) return one({x.q.data(), x.p.data(), &x.q, &x.p, &room});
      } else {
        if (one) return one({x.q.data(), x.p.data()});
      }
    }
    throw std::invalid_argument(
        "a word as data must have no letters of one's own over this scalar; take the word by its type");
  }
  void apply_known(const auto& system, const letter& one, auto& x, auto& cursor) const {
    if (is_own(one)) return apply_own(one.number, x, cursor.room);
    detail::apply_known<field::whole>(system, one, x, cursor.room);
  }

  template <class Cursor>
  static constexpr bool is_noisy = std::remove_cvref_t<Cursor>::is_noisy;

  template <class T, System S>
  void end(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (is_noisy<decltype(cursor)>) {
      if (merges_half_steps_) merged_.end(system, cursor, x);
    }
    take(system, after_, x, 1, cursor, {});
  }

  bool merges_;
  bool merges_half_steps_;
  bool evaluates_to_open_;
  detail::step_program<C> run_;
  detail::step_program<C> plain_;
  detail::step_program<C> before_;  // P(h)^-1 of a processed word, else empty
  detail::step_program<C> after_;   // P(-h)
  letter first_{};
  std::vector<ornstein_uhlenbeck::prepared<C>> noise_;  // of the letters O, in their order
  std::vector<std::shared_ptr<const turn>> turns_;      // that the programs refer to
  std::vector<detail::prepared_own_letter<C>> own_;     // letters of one's own, in their order
  merged_half_steps<C> merged_;
};

}  // namespace nysalt
