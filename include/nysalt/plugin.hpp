// SPDX-License-Identifier: BSL-1.0
// What a file declares that the program loads: a system of one's own, with its parameters, starts and
// observables.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/ensembles/given_states.hpp"
#include "nysalt/system_declaration.hpp"
#include "nysalt/systems/requirements.hpp"
#include "nysalt/version.hpp"

namespace nysalt {

namespace detail {

/// A data member of S that is a parameter.
template <class S>
struct member_parameter {
  declared_parameter declared;
  std::function<void(S&, const parameter_value&)> set;

  member_parameter at_least(double bound) && {
    return declared.least = std::max(declared.least, bound), std::move(*this);
  }
  member_parameter at_most(double bound) && {
    return declared.most = std::min(declared.most, bound), std::move(*this);
  }
  member_parameter positive() && { return declared.is_positive = true, std::move(*this); }
  member_parameter size() && { return declared.is_size = true, std::move(*this); }
};

template <class F>
struct starts_of_system {
  F law;
};
template <class F>
struct observable_of_system {
  std::string name;
  F value;
};
template <class F>
struct frequency_of_system {
  F highest;
};
template <Flow... L>
struct declared_letters {};

/// S with the letters of each piece that declares some.
template <class S, class... Pieces>
struct with_letters_of : std::type_identity<S> {};
template <class S, Flow... L, class... Pieces>
struct with_letters_of<S, declared_letters<L...>, Pieces...>
    : with_letters_of<with_letters<S, L...>, Pieces...> {};
template <class S, class First, class... Pieces>
struct with_letters_of<S, First, Pieces...> : with_letters_of<S, Pieces...> {};

/// S with a description that names the parameters, and a kind that names those that are no size, where S
/// itself does not give them.
template <class S>
struct described : S {
  described(const S& system, std::string description, std::string kind)
      : S(system), text(std::move(description)), text_of_kind(std::move(kind)) {}
  std::string description() const { return text; }
  std::string kind() const { return text_of_kind; }
  std::string text;
  std::string text_of_kind;
};

template <class S>
void take_piece(member_parameter<S> piece, std::vector<member_parameter<S>>& parameters) {
  parameters.push_back(std::move(piece));
}
template <class S, class Piece>
void take_piece(const Piece&, std::vector<member_parameter<S>>&) {}

template <class S, class F>
void take_observable(const observable_of_system<F>& piece, const S& system,
                     std::vector<initial_value_problem::named_observable>& to) {
  const auto value = [system, f = piece.value]<class T>(const phase_point<T, Eigen::Dynamic>& x) -> T {
    return f(system, of_dimension<S::dimension>(x));
  };
  to.push_back({piece.name, value});
}
template <class S, class Piece>
void take_observable(const Piece&, const S&, std::vector<initial_value_problem::named_observable>&) {}

template <class Piece>
inline constexpr bool is_starts = false;
template <class F>
inline constexpr bool is_starts<starts_of_system<F>> = true;
template <class Piece>
inline constexpr bool is_frequency = false;
template <class F>
inline constexpr bool is_frequency<frequency_of_system<F>> = true;

template <class L>
concept DeclarableLetter = requires {
  requires L::invertible;
  requires L::reversible;
};
template <class... L>
consteval bool can_be_declared(const std::tuple<L...>*) {
  return (DeclarableLetter<L> && ...);
}

template <class S, class F>
initial_states starts_by(const starts_of_system<F>& piece, const S& system, double spread) {
  if constexpr (std::invocable<const F&, const S&, double>) {
    return piece.law(system, spread);
  } else {
    return piece.law(system);
  }
}
template <class S, class F>
consteval bool takes_spread(const starts_of_system<F>*) {
  return std::invocable<const F&, const S&, double>;
}

/// Facts in which a plug-in and the program that loads it must agree.
inline std::string plugin_stamp() {
  return sentence("nysalt {}; compiler {}; {} lanes; Eigen {}.{}.{}, aligned to {}; sizes {}, {}", version,
                  __VERSION__, default_lanes, EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION,
                  EIGEN_MAX_ALIGN_BYTES, sizeof(system_declaration), sizeof(initial_value_problem));
}

}  // namespace detail

/// A data member as a parameter of the system, usually what a default-constructed system has there. Bounds
/// follow: parameter(...).at_least(2), .at_most(1000), .positive(). A parameter that says how many equal
/// parts the system has is marked by .size(): what was learned at one size may then be tried at another.
template <class S, class Number>
  requires std::is_arithmetic_v<Number>
detail::member_parameter<S> parameter(std::string name, Number S::*member, std::string meaning) {
  using value = std::conditional_t<std::is_integral_v<Number>, std::int64_t, double>;
  using limits = std::numeric_limits<Number>;
  detail::declared_parameter declared{
      .name = std::move(name), .usual = static_cast<value>(S().*member), .meaning = std::move(meaning)};
  if constexpr (sizeof(Number) < sizeof(value) || std::is_unsigned_v<Number>) {  // what the member can hold
    declared.least = static_cast<double>(limits::lowest());
    if constexpr (sizeof(Number) < sizeof(value)) declared.most = static_cast<double>(limits::max());
  }
  return {std::move(declared), [member](S& system, const parameter_value& given) {
            system.*member = static_cast<Number>(std::get<value>(given));
          }};
}

/// The initial distribution: an ensemble, such as normal_around, from `law(system)`, or from
/// `law(system, spread)`, where deviations are to be multiplied by the spread.
template <class F>
detail::starts_of_system<F> starts(F law) {
  return {std::move(law)};
}

/// A function value(system, x) of a state x over any scalar.
template <class F>
detail::observable_of_system<F> observable(std::string name, F value) {
  return {std::move(name), std::move(value)};
}

/// The highest angular frequency that motion from the starts may meet, as highest(system). If it is not
/// given, it is the highest of the system's frequency_bands(), or what the starts show.
template <class F>
detail::frequency_of_system<F> frequency(F highest) {
  return {std::move(highest)};
}

/// Letters of the user's own, of the form of exact_flow, whose names spell words: word:tct. The
/// program tries what they state by check_letter() where a word with them is first taken.
template <Flow... L>
detail::declared_letters<L...> letters() {
  return {};
}

namespace detail {

/// The declaration of S: of its parameters, its starts, and what else there is, in any order.
template <class S, class... Pieces>
system_declaration declare_system(std::string name, std::string title, Pieces... pieces) {
  require_suited<S>();
  using declared = typename detail::with_letters_of<S, Pieces...>::type;
  static_assert(!std::is_final_v<S>,
                "nysalt: a declared system must not be final: it is counted by deriving");
  static_assert(std::is_default_constructible_v<S>,
                "nysalt: a declared system needs a default constructor: give each member a value");
  static_assert(detail::can_be_declared(static_cast<const detail::letters_of<declared>*>(nullptr)),
                "nysalt: a letter that a system declares must be invertible and reversible, as exact_flow "
                "states; step the word by the system's type");
  static_assert((0 + ... + detail::is_starts<Pieces>) == 1, "nysalt: NYSALT_SYSTEM needs starts(...), once");
  static_assert((0 + ... + detail::is_frequency<Pieces>) <= 1, "nysalt: frequency(...) may be given once");
  std::vector<detail::member_parameter<S>> members;
  (detail::take_piece<S>(pieces, members), ...);
  system_declaration result{.name = std::move(name), .title = std::move(title)};
  for (const auto& member : members) result.parameters.push_back(member.declared);
  for (const letter_facts& own : detail::letters_on(declared()).declared()) result.letters += own.letter;
  const auto spread_of = []<class Piece>(const Piece*) {
    if constexpr (detail::is_starts<Piece>)
      return detail::takes_spread<S>(static_cast<const Piece*>(nullptr));
    return false;
  };
  result.has_spread = (spread_of(static_cast<const Pieces*>(nullptr)) || ...);
  result.make = [members, name = result.name, all = std::tuple(std::move(pieces)...)](
                    const parameter_values& values, const bath& in, double spread) {
    declared system;
    std::string listed;
    std::string listed_of_kind;
    bool has_size = false;
    for (const auto& member : members) {
      const auto& value = values[member.declared.name];
      member.set(system, value);
      const std::string text =
          member.declared.name + "=" + std::visit([](auto x) { return sentence("{}", x); }, value);
      listed += (listed.empty() ? "" : ", ") + text;
      has_size = has_size || member.declared.is_size;
      if (!member.declared.is_size) listed_of_kind += (listed_of_kind.empty() ? "" : ", ") + text;
    }
    std::vector<initial_value_problem::named_observable> observables;
    double highest = 0.0;
    std::vector<initial_states> law;
    const auto take = [&]<class Piece>(const Piece& piece) {
      detail::take_observable(piece, system, observables);
      if constexpr (detail::is_starts<Piece>) law.push_back(detail::starts_by(piece, system, spread));
      if constexpr (detail::is_frequency<Piece>) highest = piece.highest(system);
    };
    std::apply([&](const auto&... piece) { (take(piece), ...); }, all);
    if constexpr (HasFrequencyBands<S>) {
      if (highest == 0.0) highest = highest_frequency(system.frequency_bands());
    }
    initial_value_problem made = [&] {
      constexpr bool declares_kind = detail::TellsKind<S>;
      if constexpr (detail::TellsDescription<S>) {
        if (declares_kind || !has_size) return detail::made_of(system, in, law.front(), highest);
      }
      const std::string text = detail::TellsDescription<S> ? describe(system) : name + "(" + listed + ")";
      std::string kind = has_size ? name + "(" + listed_of_kind + ")" : text;
      if constexpr (declares_kind) kind = system.kind();
      return detail::made_of(detail::described<declared>(system, text, kind), in, law.front(), highest);
    }();
    made.observables = std::move(observables);
    if (made.springs.pairs > 0) made.default_observable = "stiff_energy";
    return made;
  };
  return result;
}

}  // namespace detail

}  // namespace nysalt

#ifndef NYSALT_PLUGIN_SOURCE
/// Fingerprint of the source, for files; nysalt build defines it.
#define NYSALT_PLUGIN_SOURCE "unknown"
#endif
/// Declares SYSTEM to the program, once in a file: NYSALT_SYSTEM(type, "title", parameter(...)...,
/// starts(...), observable(...)..., letters<...>()). The system is named as its type.
#define NYSALT_SYSTEM(SYSTEM, ...)                                                       \
  extern "C" __attribute__((visibility("default"))) const char* nysalt_plugin_stamp() {  \
    static const std::string stamp = nysalt::detail::plugin_stamp();                     \
    return stamp.c_str();                                                                \
  }                                                                                      \
  extern "C" __attribute__((visibility("default"))) void nysalt_plugin_declare(          \
      nysalt::system_declaration& result) {                                              \
    using namespace nysalt;                                                              \
    result = detail::declare_system<SYSTEM>(#SYSTEM, __VA_ARGS__);                       \
  }                                                                                      \
  extern "C" __attribute__((visibility("default"))) const char* nysalt_plugin_source() { \
    return NYSALT_PLUGIN_SOURCE;                                                         \
  }                                                                                      \
  static_assert(true)
