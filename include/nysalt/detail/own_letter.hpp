// SPDX-License-Identifier: BSL-1.0
// A letter of one's own, bound to a system, without the type of either: how words as data carry it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <type_traits>
#include <utility>

#include "nysalt/flow.hpp"
#include "nysalt/lanes.hpp"

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

}  // namespace nysalt::detail
