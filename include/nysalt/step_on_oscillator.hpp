// SPDX-License-Identifier: BSL-1.0
// What a word does to the harmonic oscillator, letter by letter.
#pragma once

#include <Eigen/Core>

#include <cmath>
#include <cstddef>
#include <vector>

#include "nysalt/run_time_word.hpp"

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

/// (q, p) after one step of size 1 of the word without its bath, on q'' = -(theta^2 + k) q. R rotates by
/// theta, S and H know k alone, B and G all of it. times_k(x) is k x, so that k may be a number, the variable
/// of a polynomial, or, for two modes, a matrix; theta is a number, or an array of two. With a step h: theta
/// = h omega, k = h^2 kappa, and p counts in units of q/h.
template <class P, class Theta>
void step_on_oscillator(const run_time_word& word, const std::vector<double>& coefficients,
                        const Theta& theta, const auto& times_k, P& q, P& p) {
  const auto times_all = [&](const P& x) {
    P result = times_k(x);
    result += theta * theta * x;
    return result;
  };
  const auto simple_kick = [&](const auto& times, double c) { p += -c * times(q); };
  const auto with_gradient = [&](const auto& times, double b, double c) {
    P force = -1.0 * times(q);
    p += b * force;
    p += -2.0 * c * times(force);
  };
  const auto rotate = [&](double part) {
    using std::cos;
    using std::sin;
    const Theta angle = part * theta;
    const Theta cosine = cos(angle);
    const Theta sine = sin(angle);
    P turned = cosine * q;
    turned += detail::sine_over(theta, part) * p;
    p *= cosine;
    p += -1.0 * theta * sine * q;
    q = turned;
  };
  for (std::size_t i = 0; i < word.length; ++i) {
    const char letter = word.letters()[i];
    const double* c = &coefficients[word.first_slot(i)];
    if (letter == drift::letter) q += c[0] * p;
    if (letter == kick::letter) simple_kick(times_all, c[0]);
    if (letter == gradient_kick::letter) with_gradient(times_all, c[0], c[1]);
    if (letter == rotation::letter) rotate(c[0]);
    if (letter == soft_kick::letter) simple_kick(times_k, c[0]);
    if (letter == soft_gradient_kick::letter) with_gradient(times_k, c[0], c[1]);
  }
}

}  // namespace nysalt
