// SPDX-License-Identifier: BSL-1.0
// Letters that are known as data: those of the library, and those of users by their names.
#pragma once

#include <concepts>
#include <cstddef>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <typeinfo>
#include <utility>
#include <vector>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/flow.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/flows/gradient_kick.hpp"
#include "nysalt/flows/ornstein_uhlenbeck.hpp"
#include "nysalt/flows/rotation.hpp"
#include "nysalt/lanes.hpp"
#include "nysalt/word.hpp"

// A letter of one's own, bound to a system, without the type of either: how words as data carry it.

namespace nysalt::detail {

/// What a letter states of itself, as a value.
struct letter_facts {
  char letter;
  std::size_t slots;
  field reads;
  int force_derivatives;
  int displaced_forces;
  bool moves_q;
  bool additive;
  bool symplectic;
  bool is_of_bath;
  bool reads_modes;
  splitting splits;

  bool operator==(const letter_facts&) const = default;
};

template <Flow L>
constexpr letter_facts facts_of_letter() {
  return {.letter = L::letter,
          .slots = L::slots,
          .reads = L::reads,
          .force_derivatives = L::force_derivatives,
          .displaced_forces = displaced_forces_of<L>(),
          .moves_q = L::moves_q,
          .additive = L::additive,
          .symplectic = is_symplectic<L>(),
          .is_of_bath = StochasticFlow<L>,
          .reads_modes = QuadraticFlow<L>,
          .splits = splitting_of<L>()};
}

/// A letter with its coefficients c and the step h folded in; the bath and the modes are for letters of the
/// library only.
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

/// The scalars over which words as data carry letters of one's own: those of the kernels of a model.
using letter_lanes = scalar_of_lanes<default_lanes>;
template <class R>
using letter_slopes = dual<R, 2>;

/// A state where it lies: of a fixed dimension its numbers, of a dynamic one the vectors too.
template <class T>
struct state_of_letter {
  T* q;
  T* p;
  vector<T, Eigen::Dynamic>* dynamic_q = nullptr;
  vector<T, Eigen::Dynamic>* dynamic_p = nullptr;
  flow_room<T, Eigen::Dynamic>* room = nullptr;
};

template <class T>
using applied_letter = std::function<void(const state_of_letter<T>& x)>;

/// A letter with coefficients of C and the step folded in, over each scalar T of a state.
template <Scalar C>
struct prepared_own_letter {
  applied_letter<C> of_one;
  template <class T>
  static constexpr bool serves = std::is_same_v<T, C>;
  template <class T>
  const applied_letter<T>& over() const {
    return of_one;
  }
};
template <>
struct prepared_own_letter<double> {
  applied_letter<double> of_one;
  applied_letter<letter_lanes> of_lanes;
  template <class T>
  static constexpr bool serves = std::is_same_v<T, double> || std::is_same_v<T, letter_lanes>;
  template <class T>
  const applied_letter<T>& over() const {
    if constexpr (std::is_same_v<T, double>) {
      return of_one;
    } else {
      return of_lanes;
    }
  }
};

/// Whether words as data carry letters of one's own with coefficients over C.
template <class C>
inline constexpr bool carries_own_letters =
    std::is_same_v<C, double> || std::is_same_v<C, letter_slopes<double>> ||
    std::is_same_v<C, letter_slopes<letter_lanes>>;

/// A letter of one's own and the system that it acts on.
class own_letter {
 public:
  own_letter(const letter_facts& stated, std::string of_system, bool side_by_side)
      : facts(stated), system(std::move(of_system)), in_lanes(side_by_side) {}
  virtual ~own_letter() = default;
  own_letter(const own_letter&) = delete;
  own_letter& operator=(const own_letter&) = delete;

  virtual prepared_own_letter<double> prepare(const double* c, double h) const = 0;
  virtual prepared_own_letter<letter_slopes<double>> prepare(const letter_slopes<double>* c,
                                                             double h) const = 0;
  virtual prepared_own_letter<letter_slopes<letter_lanes>> prepare(const letter_slopes<letter_lanes>* c,
                                                                   double h) const = 0;

  /// Whether it can be applied to states over T, or with coefficients over T.
  template <class T>
  bool serves() const {
    if (std::is_same_v<T, double>) return true;
    if (std::is_same_v<T, letter_lanes> || std::is_same_v<T, letter_slopes<letter_lanes>>) return in_lanes;
    return std::is_same_v<T, letter_slopes<double>>;
  }

  const letter_facts facts;
  const std::string system;  ///< what describe() says of it
  const bool in_lanes;       ///< it acts on trajectories side by side
};

/// What a letter reads and writes of a state that lies elsewhere.
template <class T, int N>
struct letter_view {
  using scalar_type = T;
  vector<T, N>& q;
  vector<T, N>& p;
  Eigen::Index size() const { return q.size(); }
};

template <Flow L, System S>
class bound_letter final : public own_letter {
  static_assert(
      L::reads == field::none && !StochasticFlow<L> && !QuadraticFlow<L>,
      "nysalt: a letter of one's own in a word as data evaluates what it needs itself: reads = field::none");
  static_assert(!BlackBoxForce<S>,
                "nysalt: a word as data carries letters of one's own for systems that are templates over the "
                "scalar; step the word by its type");
  static constexpr int N = S::dimension;

 public:
  explicit bound_letter(const S& system) : bound_letter(system, describe(system)) {}
  /// Of a system that is described otherwise.
  bound_letter(const S& system, std::string description)
      : own_letter(facts_of_letter<L>(), std::move(description), lanes_of<S> > 1),
        system_(std::make_shared<const S>(system)) {}

  prepared_own_letter<double> prepare(const double* c, double h) const override {
    return {applied<double>(c, h), applied<letter_lanes>(c, h)};
  }
  prepared_own_letter<letter_slopes<double>> prepare(const letter_slopes<double>* c,
                                                     double h) const override {
    return {applied<letter_slopes<double>>(c, h)};
  }
  prepared_own_letter<letter_slopes<letter_lanes>> prepare(const letter_slopes<letter_lanes>* c,
                                                           double h) const override {
    return {applied<letter_slopes<letter_lanes>>(c, h)};
  }

 private:
  /// Empty over packs where the system asks for one lane.
  template <class T, class C>
  applied_letter<T> applied(const C* c, double h) const {
    constexpr bool in_lanes =
        std::is_same_v<T, letter_lanes> || std::is_same_v<T, letter_slopes<letter_lanes>>;
    if constexpr (in_lanes && lanes_of<S> == 1) {
      return {};
    } else {
      static_assert(L::template serves<S, T>);  // as its stepper has said
      return [system = system_, folded = prepare_coefficients<L>(c, h)](const state_of_letter<T>& x) {
        if constexpr (N == Eigen::Dynamic) {
          letter_view<T, N> view{*x.dynamic_q, *x.dynamic_p};
          L::apply(*system, folded, view, *x.room);
        } else {
          letter_view<T, N> view{reinterpret_cast<vector<T, N>&>(*x.q),
                                 reinterpret_cast<vector<T, N>&>(*x.p)};
          std::conditional_t<displaced_forces_of<L>() == 0, no_room, flow_room<T, N>> room;
          L::apply(*system, folded, view, room);
        }
      };
    }
  }

  std::shared_ptr<const S> system_;
};

// Letters of one's own by name: those of a system, and those that a file states.

/// A letter of one's own, and the part of H whose time each of its coefficients is, a character for each
/// slot; empty where the letter has several and does not say.
struct named_letter {
  std::shared_ptr<const own_letter> letter;
  std::string times;
  std::string parts{};  ///< numbers of the parts whose force the letter evaluates, a digit for each
};
using named_letters = std::vector<named_letter>;

/// Those of L::times, or of a single coefficient the letter itself.
template <Flow L>
std::string times_of() {
  if constexpr (requires { std::string(L::times); }) {
    return std::string(L::times);
  } else {
    return L::slots == 1 ? std::string(1, L::letter) : std::string();
  }
}

/// Those that L::evaluations_of_part() names; none of a letter without that function.
template <Flow L>
std::string parts_of() {
  std::string parts;
  if constexpr (requires { L::evaluations_of_part(0); }) {
    for (char part = '0'; part <= '9'; ++part) {
      if (L::evaluations_of_part(static_cast<std::size_t>(part - '0')) > 0) parts.push_back(part);
    }
  }
  return parts;
}

/// What a file states of a letter of a system. A word with it can be read, and steps nothing before it has
/// the letters of the system.
class stated_letter final : public own_letter {
 public:
  stated_letter(const letter_facts& stated, std::string of_system)
      : own_letter(stated, std::move(of_system), true) {}

  prepared_own_letter<double> prepare(const double*, double) const override { refuse(); }
  prepared_own_letter<letter_slopes<double>> prepare(const letter_slopes<double>*, double) const override {
    refuse();
  }
  prepared_own_letter<letter_slopes<letter_lanes>> prepare(const letter_slopes<letter_lanes>*,
                                                           double) const override {
    refuse();
  }

 private:
  [[noreturn]] void refuse() const {
    throw std::invalid_argument(
        sentence("the letter {} of {} must come with the system, got its name only; name the system",
                 facts.letter, system));
  }
};

/// Only the letters, as words take them.
inline std::vector<std::shared_ptr<const own_letter>> letters_in(const named_letters& all) {
  std::vector<std::shared_ptr<const own_letter>> result;
  for (const auto& one : all) result.push_back(one.letter);
  return result;
}

}  // namespace nysalt::detail

// The letters that a word as data can name, and those of one's own that it carries.

namespace nysalt {

/// Every flow that a word can name by its letter at run time: what is said of letters elsewhere is asked of
/// these.
using known_letters = std::tuple<drift, kick, gradient_kick, displaced_kick, rotation, soft_kick,
                                 soft_gradient_kick, ornstein_uhlenbeck>;

namespace detail {
/// f(flow) for the flow of that letter among the given ones; false if there is none.
template <class... L>
[[gnu::always_inline]] inline bool with_letter(char letter, std::tuple<L...>, auto&& f) {
  return ((L::letter == letter && (f(L{}), true)) || ...);
}

template <class L, class Known>
inline constexpr bool is_among = false;
template <class L, class... Known>
inline constexpr bool is_among<L, std::tuple<Known...>> = (std::same_as<L, Known> || ...);
/// One of known_letters.
template <class L>
inline constexpr bool is_known_letter = is_among<L, known_letters>;

template <class L, class Known>
inline constexpr bool is_named_among = false;
template <class L, class... Known>
inline constexpr bool is_named_among<L, std::tuple<Known...>> = ((L::letter == Known::letter) || ...);
/// Its character is that of one of known_letters.
template <class L>
inline constexpr bool names_known_letter = is_named_among<L, known_letters>;
}  // namespace detail

/// Whether all letters of a word are of known_letters, so that it can be data without a system.
template <TypeLevelWord W>
consteval bool are_known_letters() {
  return []<std::size_t... I>(std::index_sequence<I...>) {
    return (detail::is_known_letter<typename W::template letter<I>> && ...);
  }(std::make_index_sequence<W::length>());
}

namespace detail {

using own_letters = std::vector<std::shared_ptr<const own_letter>>;

/// The letters of one's own of a word, as they act on a system. Throws std::invalid_argument if two of them
/// have one name.
template <TypeLevelWord W, System S>
own_letters bound_letters(const S& system) {
  own_letters result;
  std::vector<const std::type_info*> types;
  const auto add = [&]<class L>(std::type_identity<L>) {
    if constexpr (!is_known_letter<L>) {
      static_assert(!names_known_letter<L>,
                    "nysalt: a letter of one's own takes a character that no known letter has");
      for (std::size_t k = 0; k < result.size(); ++k) {
        if (result[k]->facts.letter != L::letter) continue;
        if (*types[k] == typeid(L)) return;
        throw std::invalid_argument(
            sentence("the word {}: letters of one's own must have different names, got {} twice; name one of "
                     "them otherwise",
                     W::letters(), L::letter));
      }
      types.push_back(&typeid(L));
      result.push_back(std::make_shared<const bound_letter<L, S>>(system));
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (add(std::type_identity<typename W::template letter<I>>()), ...);
  }(std::make_index_sequence<W::length>());
  return result;
}

}  // namespace detail

}  // namespace nysalt
