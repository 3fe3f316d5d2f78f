// SPDX-License-Identifier: BSL-1.0
// A word with its coefficients and the step folded in, prepared for a system.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/stepping/merged_half_steps.hpp"
#include "nysalt/stepping/system_letters.hpp"
#include "nysalt/stepping/take_steps.hpp"
#include "nysalt/systems/modal_coordinates.hpp"
#include "nysalt/word.hpp"

namespace nysalt {

namespace detail {

/// What letters are prepared with, beside coefficients and step: where their word needs it, else nothing.
struct surroundings_of_word {
  std::optional<bath> heat_bath;  ///< for letters O; a copy, as a system may return it by value
  std::shared_ptr<const modal_coordinates> part;  ///< for letters R
};

}  // namespace detail

// clang-format off
/// Letters with coefficients and step folded in, and what a stepper does with them:
/// open(system, x, cursor)        a synchronous state becomes open: force and first letter where needed
/// advance(system, x, n, cursor)  n steps of an open run; last letter of a step and first of the next are one
/// close(system, x, cursor)       an open state becomes synchronous
/// step(system, x, cursor)        one plain step, letter by letter, from only q and p
/// The cursor says where the run is in its noise, and goes on with it.
// clang-format on
namespace detail {

///
/// An open run is ahead of the synchronous state by a first letter that merges with the last. Where both are
/// of the bath it is behind instead: the letter O that meets the next step's is still to come.
///
/// Letters of the bath and those that a system declares are done here, all others by the system's kernels: in
/// one virtual call for many steps where the system is a model. N is the dimension of the system.
template <Scalar C, int N>
class prepared_word {
 public:
  /// Folds step and surroundings into the coefficients. Throws std::invalid_argument unless there is a
  /// coefficient for each slot.
  template <System S>
  prepared_word(const S& system, const word& w, const std::vector<C>& c, double h,
                const surroundings_of_word& around)
      : merges_(w.merges), merges_half_steps_(w.merges_half_steps) {
    w.require_one_for_each_slot(c);
    if (w.is_processed()) {
      before_ = plain(detail::pre_processor(w), detail::pre_processor_coefficients(w, c), h);
      after_ = plain(detail::post_processor(w), detail::post_processor_coefficients(w, c), h);
    }
    const word::evaluation_plan plan = w.plan();
    evaluates_to_open_ = plan.is_known_when_open;
    const auto prepare_one = [&](std::size_t i, const C* from) {
      return prepare(system, w.facts(i), from, h, around);
    };
    run_.reads = plain_.reads = w.reads == field::soft ? field::soft : field::whole;
    run_.calls = plain_.calls = w.stochastic_letters > 0;
    if (merges_half_steps_) run_.loop.push_back({.number = seam_of_steps});
    if (merges_half_steps_) run_.last.push_back({.number = seam_of_steps});
    const std::size_t slots_of_first = w.slots_of(0);
    for (auto* letters : {&run_.loop, &run_.last, &plain_.loop}) letters->reserve(w.length + 2);
    std::size_t slot = 0;
    for (std::size_t i = 0; i < w.length; slot += w.slots_of(i), ++i) {
      const letter one = prepare_one(i, &c[slot]);
      const bool is_at_seam = merges_half_steps_ && (i == 0 || i + 1 == w.length);
      if (!is_at_seam) plain_.loop.push_back(evaluating(one, plan.in_step[i]));
      if (i < w.first_in_loop() || is_at_seam) continue;
      letter in_run = one;
      if (merges_ && i + 1 == w.length) {
        std::vector<C> both;
        for (std::size_t k = 0; k < slots_of_first; ++k) both.push_back(C(c[slot + k] + c[k]));
        in_run = prepare_one(i, both.data());
      }
      run_.loop.push_back(evaluating(in_run, plan.in_loop[i]));
      run_.last.push_back(evaluating(in_run, plan.in_last[i]));
    }
    if (merges_) {
      std::vector<C> back;
      for (std::size_t k = 0; k < slots_of_first; ++k) back.push_back(C(-c[k]));
      first_ = prepare_one(0, c.data());
      run_.undo = {prepare_one(0, back.data())};
    }
    if (merges_half_steps_) {
      const bool is_warm = around.heat_bath->sigma() > 0.0;
      merged_ = merged_half_steps<C>(noise_.back(), noise_.front(), is_warm);
    }
    for (auto* letters : {&run_.loop, &run_.last, &plain_.loop}) end_step(*letters);
    plain_.last = plain_.loop;
    run_.complete();
    plain_.complete();
  }

  /// The letters of an open run.
  const detail::step_program<C>& program() const { return run_; }

  /// Opens a run. Cost: the word's evaluations_to_open.
  template <class T, System S>
  [[gnu::noinline]] void open(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    take(system, before_, x, 1, cursor, {}, 1);
    if (evaluates_to_open_) evaluate<T>(system, x);
    if (merges_) apply_known(system, first_, x, cursor);
  }
  /// Steps of an open run. Cost: the word's evaluations_per_step each.
  template <class T, System S>
  [[gnu::noinline]] void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t steps,
                                 auto& cursor) const {
    take(system, run_, x, steps, cursor, {}, detail::facts_of(system).threads);
  }
  /// The same from a step on, watched: observe(n, y) is called with the synchronous state y at each step n
  /// that `every` divides. Of a model the kernel calls back, in one virtual call for all steps.
  template <class T, System S>
  void advance(const S& system, flow_state<T, S::dimension>& x, std::int64_t step, std::int64_t steps,
               std::int64_t every, auto& cursor, const auto& observe) const {
    const std::int64_t end_of_steps = step + steps;
    std::int64_t next = (step / every + 1) * every;
    if constexpr (ErasedSystem<S>) {
      if (next > end_of_steps) return advance(system, x, steps, cursor);  // without room for y
      flow_state<T, S::dimension> y = x;
      const auto see = [&] {
        if (merges_ && is_called(run_.undo.front()))
          apply_called(system, run_.undo.front().number, y, cursor.room);
        end(system, y, cursor);
        observe(next, y);
        next += every;
      };
      take(system, run_, x, steps, cursor,
           detail::watch<T>{.q = &y.q,
                            .p = &y.p,
                            .first = next - step,
                            .every = every,
                            .observe = [](void* context) { (*static_cast<decltype(see)*>(context))(); },
                            .context = const_cast<void*>(static_cast<const void*>(&see))},
           detail::facts_of(system).threads);
    } else {
      // One call of the loop: a second one, where the system is known by its type, keeps g++ from inlining
      // the force.
      flow_state<T, S::dimension> y = x;
      for (; step < end_of_steps; next += every) {
        const std::int64_t until = std::min(end_of_steps, next);
        advance(system, x, until - step, cursor);
        step = until;
        if (step < next) break;
        y = x;
        close(system, y, cursor);
        observe(step, y);
      }
    }
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
    take(system, before_, x, 1, cursor, {}, 1);
    take(system, plain_, x, 1, cursor, {}, 1);
    end(system, x, cursor);
  }

 private:
  using letter = detail::step_program_letter<C>;
  using turn = rotation::prepared<C, Eigen::Dynamic>;

  // What is called back: letter O number k as k, and
  static constexpr int next_step = -1;
  static constexpr int seam_of_steps = -2;
  static constexpr int ends_step = 1 << 20;     // with the number of a letter O that is the last of a step
  static constexpr int first_called = 1 << 24;  // and any other letter number k as first_called + k

  template <System S>
  letter prepare(const S& system, const letter_facts& facts, const C* c, double h,
                 const surroundings_of_word& around) {
    if (facts.is_of_bath) {
      noise_.push_back(ornstein_uhlenbeck::prepare(c[0], h, *around.heat_bath));
      return {.number = static_cast<int>(noise_.size()) - 1};
    }
    letter result = with_step(facts.letter, c, h, around);
    if (result.what == detail::action::call) {
      result.number = first_called + static_cast<int>(called_.size());
      called_.push_back(detail::prepared_letter_of(system, facts, c, h));
    }
    return result;
  }
  /// A letter that kernels do themselves; of all others, a call of nothing.
  letter with_step(char name, const C* c, double h, const surroundings_of_word& around) {
    letter result;
    detail::with_letter(name, known_letters{}, [&]<class L>(const L&) {
      result.what = detail::action_of<L>();
      if constexpr (std::is_same_v<L, rotation>) {
        turns_.push_back(
            std::make_shared<const turn>(rotation::prepare<Eigen::Dynamic>(c[0], h, around.part)));
        result.turn = turns_.back().get();
      } else if constexpr (detail::action_of<L>() == detail::action::displaced_kick) {
        result.displaced = detail::prepare_coefficients<L>(c, h);
      } else if constexpr (detail::action_of<L>() == detail::action::gradient_kick) {
        result.gradient = detail::prepare_coefficients<L>(c, h);
      } else if constexpr (detail::action_of<L>() != detail::action::call) {
        result.coefficient = detail::prepare_coefficients<L>(c, h);
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

  /// A plain step of a word of drifts and kicks.
  detail::step_program<C> plain(const word& w, const std::vector<C>& c, double h) {
    detail::step_program<C> result;
    result.reads = field::whole;
    const word::evaluation_plan plan = w.plan();
    result.loop.reserve(w.length);
    for (std::size_t i = 0; i < w.length; ++i) {
      result.loop.push_back(evaluating(with_step(w.letter(i), &c[i], h, {}), plan.in_step[i]));
    }
    result.last = result.loop;
    result.complete();
    return result;
  }

  /// Nothing of an empty program.
  template <class T, System S>
  void take(const S& system, const detail::step_program<C>& letters, flow_state<T, S::dimension>& x,
            std::int64_t steps, auto& cursor, const detail::watch<T>& watched, int threads) const {
    if (letters.loop.empty()) return;
    const auto act = [&](int number) {
      if (number >= first_called) return apply_called(system, number, x, cursor.room);
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
    if constexpr (ErasedSystem<S>) {
      const detail::callback other{
          [](void* context, int number) { (*static_cast<decltype(act)*>(context))(number); },
          const_cast<void*>(static_cast<const void*>(&act))};
      system.template kernels<T>().advance(x.q, x.p, x.f, cursor.room, letters, steps, threads, other,
                                           watched);
    } else {
      detail::state_in_place<T, S::dimension> in_place{x.q, x.p, x.f};
      detail::take_steps_of_word(system, in_place, cursor.room, letters, steps, act, watched);
    }
  }

  template <class T, System S>
  [[gnu::noinline]] void evaluate(const S& system, flow_state<T, S::dimension>& x) const {
    if constexpr (HasQuadraticPart<S> && ForceOver<S, T, field::soft>) {
      if (run_.reads == field::soft) return force_of<field::soft, T>(system, x.q, x.f);
    }
    if constexpr (!detail::steps_by_own_letters_only<S>) force<T>(system, x.q, x.f);
  }
  static bool is_called(const letter& one) {
    return one.what == detail::action::call && one.number >= first_called;
  }
  template <System S, class T, int Size>
  [[gnu::noinline]] void apply_called(const S& system, int number, flow_state<T, Size>& x, auto& room) const {
    const auto& prepared = called_[static_cast<std::size_t>(number - first_called)];
    const detail::letters_on letters(system);
    const void* held = letters.held();
    const auto act = [&](const detail::applied_letter<T>& one) {
      if constexpr (Size == Eigen::Dynamic) {
        one(held, {x.q.data(), x.p.data(), &x.q, &x.p, &room});
      } else {
        one(held, {x.q.data(), x.p.data()});
      }
    };
    if constexpr (detail::prepared_letter<C>::template serves<T>) {
      act(prepared.template over<T>());
    } else {  // derivatives by the state, which are taken once in a while
      const auto& [name, c, h] = prepared.unfolded;
      act(letters.template over<T>(name, c.data(), h));
    }
  }
  void apply_known(const auto& system, const letter& one, auto& x, auto& cursor) const {
    if (is_called(one)) return apply_called(system, one.number, x, cursor.room);
    detail::apply_known<field::whole>(system, one, x, cursor.room);
  }

  template <class Cursor>
  static constexpr bool is_noisy = std::remove_cvref_t<Cursor>::is_noisy;

  template <class T, System S>
  void end(const S& system, flow_state<T, S::dimension>& x, auto& cursor) const {
    if constexpr (is_noisy<decltype(cursor)>) {
      if (merges_half_steps_) merged_.end(system, cursor, x);
    }
    take(system, after_, x, 1, cursor, {}, 1);
  }

  bool merges_;
  bool merges_half_steps_;
  bool evaluates_to_open_ = false;
  detail::step_program<C> run_;
  detail::step_program<C> plain_;
  detail::step_program<C> before_;  // P(h)^-1 of a processed word, else empty
  detail::step_program<C> after_;   // P(-h)
  letter first_{};
  std::vector<ornstein_uhlenbeck::prepared<C>> noise_;  // of the letters O, in their order
  std::vector<std::shared_ptr<const turn>> turns_;      // that the programs refer to
  std::vector<detail::prepared_letter<C>> called_;      // all other letters that are called back
  merged_half_steps<C> merged_;
};

}  // namespace detail

}  // namespace nysalt
