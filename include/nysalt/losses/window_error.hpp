// SPDX-License-Identifier: BSL-1.0
// Losses on windows of trajectories: of the state in a metric, of the energy, and of users.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "nysalt/core/sentence.hpp"
#include "nysalt/flow_map_data.hpp"
#include "nysalt/kernels/kernels.hpp"
#include "nysalt/lanes.hpp"

namespace nysalt {

// The residuals of a window of steps.

/// Residuals of a loss over data, of any kind: state_error(), energy_error(), own_error().
/// The kind is no part of the type, as a pass over the data is expensive to compile: one serves all kinds. It
/// calls `of` once for each pack of windows and each two parameters, which costs little beside their steps.
template <Scalar R = detail::lanes>
struct window_error {
  using scalar = dual<R, detail::directions_at_a_time>;  ///< residuals with their derivatives
  using data_point = phase_point<R, Eigen::Dynamic>;     ///< states of the data, in the lanes of R
  using point = phase_point<scalar, Eigen::Dynamic>;     ///< a state that the method comes to

  std::size_t residuals;  ///< number of residuals of a window
  /// Writes r[0..residuals) of the window from start, which the method ends at finish, and the data at
  /// wanted. Called from several threads at a time.
  std::function<void(const data_point& start, const point& finish, const data_point& wanted, scalar* r)> of;
  /// Errors of weights that are estimated from the data: row k, column m is what trajectory m adds to the
  /// relative error of residual k's mean square. Else nullptr.
  const Eigen::MatrixXd* weight_deviations = nullptr;
  bool may_throw = false;  ///< whether `of` may, so that ranks that share the data must agree on it
};

// In which coordinates, and with which weights, an error of one step counts.

/// qp      every q_i and p_i, each weighted with its own mean square increment [li_lu_tao_ye_2023, (3.5)]
/// modes   the same in the system's orthonormal modes x = U^T M^{1/2} q, y = U^T M^{-1/2} p
/// energy  omega_k x_k (x_k where omega_k = 0) and y_k with one common weight: the energy norm of the
/// quadratic
///         part, as the metric `state` has it
enum class coordinates { qp, modes, energy };

/// The name: qp, modes or energy.
std::string to_string(coordinates c);

/// r = Sigma^{-1/2} (the difference of two states in the chosen coordinates), Sigma the mean square
/// increment over the data. The weights come from training data, and then judge any data alike.
class metric {
 public:
  /// Throws std::invalid_argument if the system has no modes, if nothing moves in the data, or so far that
  /// a weight is not finite.
  metric(const model& system, const flow_map_data& data, coordinates which);

  /// Number of coordinates that count: 2 N less those that never move.
  Eigen::Index residuals() const { return static_cast<Eigen::Index>(active_.size()); }
  /// Names of coordinates without motion, which have no scale and are left out.
  const std::vector<std::string>& dropped() const { return dropped_; }

  /// The weights are estimates too. Row k, column m: what trajectory m adds to the relative error of the
  /// mean square increment of coordinate k; a row sums to zero.
  const Eigen::MatrixXd& weight_deviations() const { return deviations_; }
  /// The same of the trajectories of other data among each other, as if they made the weights. Collective.
  Eigen::MatrixXd weight_deviations(const flow_map_data& others) const;

  /// r[0..residuals()) of the difference a - b; b is data, a may carry derivatives.
  template <Scalar T>
  void residual(const auto& aq, const auto& ap, const auto& b, T* r) const {
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const Eigen::Index row = active_[k];
      const bool is_q = row < size_;
      const Eigen::Index i = is_q ? row : row - size_;
      r[k] = is_q ? difference<T>(aq, b.q, sums_of_q_, i, weight_[row])
                  : difference<T>(ap, b.p, sums_of_p_, i, weight_[row]);
    }
  }

 private:
  /// A coordinate of the system, and its factor in a mode: modes of chains have few that are not zero.
  struct term {
    Eigen::Index coordinate;
    double factor;
  };
  using sums = std::vector<std::vector<term>>;  // one a mode; empty for qp

  template <class T>
  [[gnu::always_inline]] T difference(const auto& a, const auto& target, const sums& modes, Eigen::Index i,
                                      double weight) const {
    if (modes.empty()) return (a[i] - target[i]) * weight;
    const auto& terms = modes[static_cast<std::size_t>(i)];
    T sum = (a[terms.front().coordinate] - target[terms.front().coordinate]) * terms.front().factor;
    for (std::size_t k = 1; k < terms.size(); ++k) {
      sum += (a[terms[k].coordinate] - target[terms[k].coordinate]) * terms[k].factor;
    }
    return sum * weight;
  }

  void change_coordinates(const model& system, coordinates which);
  void weigh(const flow_map_data& data);
  std::vector<Eigen::VectorXd> squares_in(const flow_map_data& data) const;
  std::string name_of(Eigen::Index row) const;

  Eigen::Index size_;
  coordinates which_;
  sums sums_of_q_;
  sums sums_of_p_;
  Eigen::VectorXd weight_;
  Eigen::MatrixXd deviations_;
  std::vector<Eigen::Index> active_;
  std::vector<std::string> dropped_;
};

/// r = Sigma^{-1/2} (K steps from the start - the data there); for K = 1 the paper's loss
/// [li_lu_tao_ye_2023, equation (3.5)]. Refers to the metric, whose weights are estimates.
template <Scalar R = detail::lanes>
window_error<R> state_error(const metric& measure) {
  return {.residuals = static_cast<std::size_t>(measure.residuals()),
          .of = [error_metric = &measure](const auto&, const auto& finish, const auto& wanted,
                                          auto* r) { error_metric->residual(finish.q, finish.p, wanted, r); },
          .weight_deviations = &measure.weight_deviations()};
}

/// A metric that is gone by then cannot be referred to.
template <Scalar R = detail::lanes>
window_error<R> state_error(metric&& measure) = delete;

namespace detail {
/// 1/the root mean square of K(p) at the starts of all pairs. Throws std::invalid_argument if the energy of
/// the system is not known.
double scale_of_energies(const model& system, const flow_map_data& data);
}  // namespace detail

/// r = (H after K steps - H at the start)/the root mean square of K(p) at the starts of all pairs. Throws
/// std::invalid_argument if the system's energy is not known.
template <Scalar R = detail::lanes>
window_error<R> energy_error(const model& system, const flow_map_data& data) {
  using C = typename window_error<R>::scalar;
  const double scale = detail::scale_of_energies(system, data);
  return {.residuals = 1, .of = [system, scale](const auto& start, const auto& finish, const auto&, C* r) {
            const C before = energy<C>(system, start.template cast<C>());
            r[0] = (energy<C>(system, finish) - before) * scale;
          }};
}

// A loss of the user's: one function.

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
/// all states, also for states of zeros. What is not finite makes the search turn back. Weights are the
/// function's own, given and not estimated. It is called from several threads at a time.
template <class Error>
struct own_loss {
  std::string name;  ///< name in a fit_summary, followed by K: one line, unlike the name of any other loss
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

}  // namespace detail

}  // namespace nysalt
