// SPDX-License-Identifier: BSL-1.0
// The interpreter of letters: steps of a system by its type.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstdint>

#include "nysalt/force.hpp"
#include "nysalt/stepping/step_program.hpp"

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

template <class Kick, class S, class State>
void apply_kick_with_derivative(const S& system, const auto& coefficients, evaluation evaluates, State& x,
                                auto& room) {
  using T = typename State::scalar_type;
  if constexpr (Kick::template serves<S, T> && !steps_by_own_letters_only<S>) {
    const auto c = coefficients;  // local: they cannot alias the state
    if (evaluates != evaluation::none) force_of<Kick::reads, T>(system, x.q, x.f);
    Kick::apply(system, c, x, room);
  }
}
/// The same where inlining would cost more time to compile than to run.
template <class Kick, class S, class State>
[[gnu::noinline]] void call_kick_with_derivative(const S& system, const auto& coefficients,
                                                 evaluation evaluates, State& x, auto& room) {
  apply_kick_with_derivative<Kick>(system, coefficients, evaluates, x, room);
}

template <class S, class State, class C>
[[gnu::noinline]] void apply_rotation(const S& system, const step_program_letter<C>& letter, State& x,
                                      auto& room) {
  if constexpr (rotation::serves<S, typename State::scalar_type>) {
    rotation::apply(system, *letter.turn, x, room);
  }
}

/// One letter. The system is inlined: with several users of its force g++ would not. Without MayCall the
/// letter is no rotation and not called back: then nothing takes the address of the state.
template <field F, bool MayCall, class S, class State, class C>
[[gnu::always_inline]] inline void apply_letter(const S& system, const step_program_letter<C>& letter,
                                                State& x, auto& room, const auto& other) {
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
      if constexpr (!steps_by_own_letters_only<S>) {
        if (letter.evaluates != evaluation::none) force_of<F, T>(system, x.q, x.f);
      }
      kick_of<F>::apply(system, c, x, room);
      break;
    }
    case action::gradient_kick:
      if constexpr (std::same_as<T, double>) {
        apply_kick_with_derivative<gradient_kick_of<F>>(system, letter.gradient, letter.evaluates, x, room);
      } else {
        call_kick_with_derivative<gradient_kick_of<F>>(system, letter.gradient, letter.evaluates, x, room);
      }
      break;
    case action::displaced_kick:
      if constexpr (std::same_as<T, double>) {
        apply_kick_with_derivative<displaced_kick>(system, letter.displaced, letter.evaluates, x, room);
      } else {
        call_kick_with_derivative<displaced_kick>(system, letter.displaced, letter.evaluates, x, room);
      }
      break;
    case action::rotation:
      if constexpr (MayCall) apply_rotation(system, letter, x, room);
      break;
    case action::call:
      if constexpr (MayCall) other(letter.number);
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

/// Interpreter loop: `steps` steps of any program. If the program consists of shears alone, which call no
/// function of the user with the state, a state of a small fixed dimension is copied to a local variable,
/// whose coordinates are held in registers.
template <field F, class S, class State, class C>
[[gnu::flatten, gnu::noinline]] void take_any_steps(const S& system, State& x, auto& room,
                                                    const step_program<C>& letters, std::int64_t steps,
                                                    const auto& other) {
  using T = typename State::scalar_type;
  const auto take = [&]<bool MayCall>(auto& state, auto& space) __attribute__((always_inline)) {
    for (std::int64_t n = 1; n <= steps; ++n) {
      for (const auto& letter : n < steps ? letters.loop : letters.last) {
        apply_letter<F, MayCall>(system, letter, state, space, other);
      }
    }
  };
  constexpr int most = 32;  // coordinates: of more not even the positions fit into vector registers
  if constexpr (S::dimension != Eigen::Dynamic && S::dimension <= most && std::same_as<T, double>) {
    if (letters.is_of_shears) {
      flow_state<T, S::dimension> local{{x.q, x.p}, x.f};
      flow_room<T, S::dimension> space;
      take.template operator()<false>(local, space);
      x.q = local.q;
      x.p = local.p;
      x.f = local.f;
      return;
    }
  }
  take.template operator()<true>(x, room);
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
                const step_program<C>& letters, std::int64_t steps, const auto& other,
                const watch<T>& watched) {
  if constexpr (F == field::whole && !steps_by_own_letters_only<S> && std::same_as<C, double> &&
                !is_dual<T>) {
    if (!letters.pairs.empty()) return take_steps_in_pairs(system, x, room, letters, steps, watched);
  }
  watch_steps(
      steps, watched, [&](std::int64_t count) { take_any_steps<F>(system, x, room, letters, count, other); },
      [&] { show<F, S, T, C>(system, x, room, letters, watched); });
}

/// The same by the field that the letters read.
template <class S, class T, class C>
void take_steps_of_word(const S& system, state_in_place<T, S::dimension>& x, auto& room,
                        const step_program<C>& letters, std::int64_t steps, const auto& other,
                        const watch<T>& watched) {
  if constexpr (HasQuadraticPart<S> && ForceOver<S, T, field::soft>) {
    if (letters.reads == field::soft) {
      return take_steps<field::soft>(system, x, room, letters, steps, other, watched);
    }
  }
  take_steps<field::whole>(system, x, room, letters, steps, other, watched);
}

}  // namespace nysalt::detail
