// SPDX-License-Identifier: BSL-1.0
// A loss of the user's: one function.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "nysalt/losses/window_error.hpp"

namespace nysalt {

/// The mean over all windows of K steps of the sum of the squares of the residuals that `error` returns:
///
///   const own_loss of_place{"place", 5, []<class T>(const phase_point<T, 2>& start,
///                                                   const phase_point<T, 2>& finish,
///                                                   const phase_point<T, 2>& wanted) -> vector<T, 2> {
///                             return finish.q - wanted.q;
///                           }};
///
/// A window goes from `start`; the method ends it at `finish`, the data at `wanted`. T is any scalar: in it
/// go derivatives by theta, and windows in lanes, so a function is written as a system's potential is.
/// It returns a T, a std::array<T, n> or a vector<T, n>; n may be Eigen::Dynamic, and is then the same for
/// all states, those of zeros too. What is not finite makes the search turn back. Weights are the function's
/// own, given and not estimated. It is called from several threads at a time.
template <class Error>
struct own_loss {
  std::string name;  ///< name in a fit_summary, followed by K: one line, unlike that of any other loss
  int steps;         ///< K, steps of a window
  Error error;       ///< error(start, finish, wanted): the residuals

  /// Description, in the form of the library's losses, such as "place:5".
  std::string description() const { return name + ":" + std::to_string(steps); }
};
/// Deduced from its three parts.
template <class Error>
own_loss(std::string, int, Error) -> own_loss<Error>;

namespace detail {

/// Number of residuals over T in a result: Eigen::Dynamic if it has a size(), 0 if it is none.
template <class Result, class T>
inline constexpr int residuals_in = 0;
template <class T>
inline constexpr int residuals_in<T, T> = 1;
template <class T, std::size_t n>
inline constexpr int residuals_in<std::array<T, n>, T> = static_cast<int>(n);
template <class T, int n, int options, int most>
inline constexpr int residuals_in<Eigen::Matrix<T, n, 1, options, most, 1>, T> = n;

template <class T>
void write_residuals(const T& one, std::size_t, T* r) {
  *r = one;
}
template <class Several, class T>
void write_residuals(const Several& all, std::size_t count, T* r) {
  if (static_cast<std::size_t>(all.size()) != count) {
    throw std::invalid_argument(
        "own_loss: the number of residuals must be the same for every pair of states, got " +
        std::to_string(count) + " and " + std::to_string(all.size()));
  }
  std::copy(all.begin(), all.end(), r);
}

}  // namespace detail

/// The scalar that carries windows of S: packs where the system and its derivatives serve them.
template <SeparableSystem S>
using scalar_of_passes =
    std::conditional_t<detail::serves<S, detail::lanes_with_slopes>, detail::lanes, double>;

/// The residuals that a function returns, see own_loss. Throws std::invalid_argument if there are none; while
/// it is asked, if there are not as many for one window as for another.
template <class R = void, SeparableSystem S, class Error>
auto own_error(const S& system, const Error& error) {
  using scalar = std::conditional_t<std::is_void_v<R>, scalar_of_passes<S>, R>;
  using C = typename window_error<scalar>::scalar;
  using point = phase_point<C, S::dimension>;
  constexpr bool is_asked_so = std::invocable<const Error&, const point&, const point&, const point&>;
  static_assert(is_asked_so,
                "nysalt: an own loss is a function of (start, finish, wanted), each a `phase_point<T, N>` of "
                "the system's dimension N, and const, for any scalar T");
  if constexpr (is_asked_so) {
    using result =
        std::remove_cvref_t<std::invoke_result_t<const Error&, const point&, const point&, const point&>>;
    constexpr int known = detail::residuals_in<result, C>;
    static_assert(
        known != 0,
        "nysalt: an own loss returns its residuals over the T of its states, at least one: a `T`, a "
        "`std::array<T, n>` or a `vector<T, n>`; of an expression, say `-> vector<T, n>`");
    auto count = static_cast<std::size_t>(known);
    if constexpr (known == Eigen::Dynamic) {
      point zero{make_vector<C>(system), make_vector<C>(system)};
      zero.q.fill(C(0.0));
      zero.p.fill(C(0.0));
      count = static_cast<std::size_t>(error(zero, zero, zero).size());
      if (count == 0) throw std::invalid_argument("own_loss: residuals must be one or more, got none");
    }
    const auto own = [](const auto& x) { return point{x.q, x.p}; };
    return window_error<scalar>{
        .residuals = count,
        .of =
            [error, count, own](const auto& start, const auto& finish, const auto& wanted, C* r) {
              const auto residuals =
                  error(own(start.template cast<C>()), own(finish), own(wanted.template cast<C>()));
              detail::write_residuals(residuals, count, r);
            },
        .may_throw = true};
  }
}

}  // namespace nysalt
