// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <memory>
#include <type_traits>

#include "nysalt/flow.hpp"
#include "nysalt/flows/drift_kick.hpp"
#include "nysalt/systems/modal_coordinates.hpp"

namespace nysalt {

namespace detail {
/// sin(part theta)/theta, and its limit.
inline double sine_over(double theta, double part) {
  return theta > 0.0 ? std::sin(part * theta) / theta : part;
}
inline Eigen::Array2d sine_over(const Eigen::Array2d& theta, double part) {
  return {sine_over(theta[0], part), sine_over(theta[1], part)};
}
}  // namespace detail

/// R: the flow of H_0 = p M^-1 p/2 + q K q/2 over t = c h, exactly. In the coordinates of each mode
///   x <- cos(omega t) x + sin(omega t)/omega y,   y <- cos(omega t) y - omega sin(omega t) x,
/// and x <- x + t y where omega = 0. Cost: no evaluation, and four products for each entry of the basis that
/// is not zero, up to 4 N^2.
struct rotation {
  static constexpr char letter = 'R';
  static constexpr std::size_t slots = 1;
  static constexpr field reads = field::none;
  static constexpr int force_derivatives = 0;
  static constexpr bool moves_q = true;
  static constexpr bool additive = true;
  static constexpr bool reads_modes = true;
  static constexpr splitting splits = splitting::quadratic_part_and_rest;
  static constexpr bool invertible = true;
  using same_order_as = drift;  // of K the conditions use that it is quadratic in p, as H_0 is
  static constexpr const char* needs = detail::needs_quadratic_part;

  template <System S, Scalar T>
  static constexpr bool serves = HasQuadraticPart<S>;

  /// The turn of each mode over t = c h.
  template <Scalar C, int N>
  struct prepared {
    std::shared_ptr<const detail::modal_coordinates> part;  ///< basis and frequencies
    vector<C, N> cosine;                                    ///< cos(omega t)
    vector<C, N> of_y_in_x;                                 ///< sin(omega t)/omega, or t where omega = 0
    vector<C, N> of_x_in_y;                                 ///< -omega sin(omega t)
  };

  template <int N, Scalar C>
  static prepared<C, N> prepare(const C& c, double h,
                                const std::shared_ptr<const detail::modal_coordinates>& part) {
    using std::cos;
    using std::sin;
    const auto n = static_cast<Eigen::Index>(part->frequencies().size());
    prepared<C, N> result{part, vector<C, N>(n), vector<C, N>(n), vector<C, N>(n)};
    const C t = c * h;
    for (Eigen::Index k = 0; k < n; ++k) {
      const double omega = part->frequencies()[static_cast<std::size_t>(k)];
      const C angle = t * omega;
      result.cosine[k] = cos(angle);
      result.of_y_in_x[k] = omega > 0.0 ? C(sin(angle) / omega) : t;
      result.of_x_in_y[k] = -(sin(angle) * omega);
    }
    return result;
  }

  template <System S, class State, CoefficientOf<typename State::scalar_type> C, int N>
  static void apply(const S&, const prepared<C, N>& turn, State& z, auto& room) {
    using T = typename State::scalar_type;
    auto& q = z.q;
    auto& p = z.p;
    auto& x = room.x;
    auto& y = room.y;
    const Eigen::Index n = z.size();
    turn.part->to_modes(q, p, x, y);
    for (Eigen::Index k = 0; k < n; ++k) {
      const T turned = x[k] * turn.cosine[k] + y[k] * turn.of_y_in_x[k];
      y[k] = y[k] * turn.cosine[k] + x[k] * turn.of_x_in_y[k];
      x[k] = turned;
    }
    turn.part->from_modes(x, y, q, p);
  }

  template <class P>
  static void on_oscillator(const auto& stiffness, const double* c, P& q, P& p) {
    using std::cos;
    using std::sin;
    using angles = std::remove_cvref_t<decltype(stiffness.theta)>;
    const angles& theta = stiffness.theta;
    const angles angle = c[0] * theta;
    const angles cosine = cos(angle);
    const angles sine = sin(angle);
    P turned = cosine * q;
    turned += detail::sine_over(theta, c[0]) * p;
    p *= cosine;
    p += -1.0 * theta * sine * q;
    q = turned;
  }
};

}  // namespace nysalt
