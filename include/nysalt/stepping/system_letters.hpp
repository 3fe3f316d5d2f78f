// SPDX-License-Identifier: BSL-1.0
// Letters that a system declares, prepared for it and applied to states where they lie.
#pragma once

#include <functional>
#include <tuple>
#include <type_traits>
#include <vector>

#include "nysalt/lanes.hpp"
#include "nysalt/stepping/step_program.hpp"

namespace nysalt {
class model;
}  // namespace nysalt

namespace nysalt::detail {

/// A letter with its coefficients and the step h folded in; letters of the bath and of modes are prepared
/// with more.
template <class L, Scalar C>
auto prepare_coefficients(const C* c, double h) {
  if constexpr (requires { L::prepare(c, h); }) {
    return L::prepare(c, h);
  } else if constexpr (L::slots == 2) {
    return L::prepare(c[0], c[1], h);
  } else {
    static_assert(L::slots == 1);
    return L::prepare(c[0], h);
  }
}

/// A state where it lies: of a fixed dimension its numbers, of a dynamic one the vectors too.
template <class T>
struct state_of_letter {
  T* q;
  T* p;
  vector<T, Eigen::Dynamic>* dynamic_q = nullptr;
  vector<T, Eigen::Dynamic>* dynamic_p = nullptr;
  flow_room<T, Eigen::Dynamic>* room = nullptr;
};

/// A prepared letter of the system behind the pointer, whose type the letter knows. Empty: it does not serve
/// T.
template <class T>
using applied_letter = std::function<void(const void* system, const state_of_letter<T>& x)>;

/// What a letter reads and writes of a state that lies elsewhere.
template <class T, int N>
struct letter_view {
  using scalar_type = T;
  vector<T, N>& q;
  vector<T, N>& p;
  Eigen::Index size() const { return q.size(); }
};

/// L over T with coefficients of C and the step folded in.
template <class L, class S, class T, class C>
applied_letter<T> applied(const C* c, double h) {
  static_assert(L::reads == field::none && !StochasticFlow<L> && !QuadraticFlow<L>,
                "nysalt: a letter of one's own evaluates what it needs itself: reads = field::none");
  constexpr int N = S::dimension;
  return [folded = prepare_coefficients<L>(c, h)](const void* held, const state_of_letter<T>& x) {
    const S& system = *static_cast<const S*>(held);
    if constexpr (N == Eigen::Dynamic) {
      letter_view<T, N> view{*x.dynamic_q, *x.dynamic_p};
      L::apply(system, folded, view, *x.room);
    } else {
      letter_view<T, N> view{reinterpret_cast<vector<T, N>&>(*x.q), reinterpret_cast<vector<T, N>&>(*x.p)};
      std::conditional_t<displaced_forces_of<L>() == 0, no_room, flow_room<T, N>> room;
      L::apply(system, folded, view, room);
    }
  };
}

/// The letter of that name among the letters that S declares, and the library's letters that kernels do not
/// know.
template <class S, class T, class C>
applied_letter<T> letter_of_system(char name, const C* c, double h) {
  applied_letter<T> result;
  const auto take = [&]<class L>(const L&) {
    if constexpr (!StochasticFlow<L> && action_of<L>() == action::call) {
      if constexpr (L::template serves<S, T>) result = applied<L, S, T>(c, h);
    }
  };
  if (!with_letter(name, letters_of<S>(), take)) with_letter(name, known_letters(), take);
  return result;
}

/// The letters of a system: those that it declares, and how letters find it. Refers to the system.
template <class S>
class letters_on {
 public:
  explicit letters_on(const S& system) : system_(&system) {}

  /// The facts of the letters that the system declares.
  std::vector<letter_facts> declared() const {
    const auto all = facts_of_letters(static_cast<const letters_of<S>*>(nullptr));
    return {all.begin(), all.end()};
  }
  /// Whether a letter, of the library or of those declared, serves the system over T.
  template <class T>
  bool serves(char name) const {
    bool result = false;
    with_letter(name, std::tuple_cat(known_letters{}, letters_of<S>{}),
                [&]<class L>(const L&) { result = L::template serves<S, T>; });
    return result;
  }
  /// The letter of that name over T, with coefficients and step folded in.
  template <class T, class C>
  applied_letter<T> over(char name, const C* c, double h) const {
    return letter_of_system<S, T>(name, c, h);
  }
  /// The system, as its letters find it.
  const void* held() const { return system_; }

 private:
  const S* system_;
};
/// Of a model: its facts and kernels, see model.hpp.
template <>
class letters_on<model>;

/// A letter with the coefficients c, over C, and a step h.
template <Scalar C>
struct letter_with_step {
  char name;
  std::vector<C> c;
  double h;
};

/// A letter with its coefficients and the step folded in, for states over C, and over packs where C is
/// double.
template <Scalar C>
struct prepared_letter {
  letter_with_step<C> unfolded;
  applied_letter<C> of_one{};
  template <class T>
  static constexpr bool serves = std::is_same_v<T, C>;
  template <class T>
  const applied_letter<T>& over() const {
    return of_one;
  }
};
template <>
struct prepared_letter<double> {
  using lanes = scalar_of_lanes<default_lanes>;
  letter_with_step<double> unfolded;
  applied_letter<double> of_one{};
  applied_letter<lanes> of_lanes{};
  template <class T>
  static constexpr bool serves = std::is_same_v<T, double> || std::is_same_v<T, lanes>;
  template <class T>
  const applied_letter<T>& over() const {
    if constexpr (std::is_same_v<T, double>) {
      return of_one;
    } else {
      return of_lanes;
    }
  }
};

/// The letter of that name as the system has it.
template <class S, Scalar C>
prepared_letter<C> prepared_letter_of(const S& system, const letter_facts& facts, const C* c, double h) {
  const char name = facts.letter;
  const letters_on letters(system);
  prepared_letter<C> result{{name, {c, c + facts.slots}, h}};
  result.of_one = letters.template over<C>(name, c, h);
  if constexpr (std::is_same_v<C, double> && lanes_of<S> > 1) {
    result.of_lanes = letters.template over<typename prepared_letter<C>::lanes>(name, c, h);
  }
  return result;
}

}  // namespace nysalt::detail
