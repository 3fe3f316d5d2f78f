// SPDX-License-Identifier: BSL-1.0
// The damped oscillator dq = p dt, dp = (-omega^2 q - gamma p) dt + sigma dW: its solution, exact paths of it
// and every word of A, B and O on it are linear maps with normal noise, known here without the library.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "dense.hpp"
#include "nysalt/families/composition.hpp"
#include "nysalt/families/nystrom.hpp"
#include "nysalt/family.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/reference.hpp"
#include "nysalt/systems/in_bath.hpp"
#include "nysalt/systems/textbook.hpp"

namespace nysalt::test {

template <int N>
using square = Eigen::Matrix<double, N, N>;

/// X -> map X + a normal vector of this covariance.
template <int N>
struct gaussian_step {
  square<N> map = square<N>::Identity();
  square<N> covariance = square<N>::Zero();
};

/// One after the other, with independent noise.
template <int N>
gaussian_step<N> then(const gaussian_step<N>& first, const gaussian_step<N>& second) {
  return {second.map * first.map, second.map * first.covariance * second.map.transpose() + second.covariance};
}

/// The solution of dX = A X dt + noise over the time t, where rate is the noise's covariance per unit time.
/// Taylor's series of e^{A t} and of C' = A C + C A^T + rate over t/2^k, with A t/2^k below 1/4, so that the
/// 16 terms err by less than (2/4)^17/17! < 1e-19; then k doublings, which only add what is positive.
template <int N>
gaussian_step<N> solve_linear(const square<N>& A, const square<N>& rate, double t) {
  int doublings = 0;
  while (A.cwiseAbs().rowwise().sum().maxCoeff() * t > 0.25) {
    t *= 0.5;
    ++doublings;
  }
  gaussian_step<N> result;
  square<N> map_term = square<N>::Identity();
  square<N> covariance_term = rate * t;
  for (int k = 1; k <= 16; ++k) {
    map_term = (A * map_term * (t / k)).eval();
    result.map += map_term;
    result.covariance += covariance_term;
    const square<N> moved = A * covariance_term;
    covariance_term = (moved + moved.transpose()) * (t / (k + 1));
  }
  for (; doublings > 0; --doublings) result = then(result, result);
  return result;
}

/// The covariance that a step keeps: Sigma = map Sigma map^T + covariance, as N^2 linear equations.
template <int N>
square<N> stationary(const gaussian_step<N>& step) {
  square<N* N> equations = square<N * N>::Identity();
  Eigen::Matrix<double, N * N, 1> right;
  for (int i = 0; i < N; ++i) {
    for (int j = 0; j < N; ++j) {
      right[N * i + j] = step.covariance(i, j);
      for (int k = 0; k < N; ++k) {
        for (int l = 0; l < N; ++l) equations(N * i + j, N * k + l) -= step.map(i, k) * step.map(j, l);
      }
    }
  }
  const Eigen::VectorXd solution = least_squares(equations, right, 0.0);
  return Eigen::Map<const square<N>>(solution.data());  // symmetric: the order of entries does not matter
}

/// A lower triangle L with L L^T = covariance, which may be singular: what rounding makes negative is zero.
template <int N>
square<N> cholesky(const square<N>& covariance) {
  square<N> L = square<N>::Zero();
  for (int j = 0; j < N; ++j) {
    double pivot = covariance(j, j);
    for (int k = 0; k < j; ++k) pivot -= L(j, k) * L(j, k);
    L(j, j) = std::sqrt(std::max(pivot, 0.0));
    if (L(j, j) == 0.0) continue;
    for (int i = j + 1; i < N; ++i) {
      double rest = covariance(i, j);
      for (int k = 0; k < j; ++k) rest -= L(i, k) * L(j, k);
      L(i, j) = rest / L(j, j);
    }
  }
  return L;
}

struct damped_oscillator {
  double omega;
  double gamma;
  double sigma;

  /// The covariance of the invariant law, kT diag(1/omega^2, 1) with kT = sigma^2/(2 gamma).
  square<2> invariant() const {
    const double kT = sigma * sigma / (2.0 * gamma);
    return Eigen::Vector2d(kT / (omega * omega), kT).asDiagonal();
  }

  /// The solution of (q, p) over a time t.
  gaussian_step<2> exact(double t) const {
    square<2> A;
    A << 0.0, 1.0, -omega * omega, -gamma;
    return solve_linear<2>(A, Eigen::Vector2d(0.0, sigma * sigma).asDiagonal(), t);
  }

  /// The solution of (q, p, eta) over a time t, where d eta = -gamma eta dt + sigma dW feels the same path:
  /// from eta = 0 on, eta is the noise that an O over this time adds.
  gaussian_step<3> exact_with_bath(double t) const {
    square<3> A;
    A << 0.0, 1.0, 0.0, -omega * omega, -gamma, 0.0, 0.0, 0.0, -gamma;
    const Eigen::Vector3d felt(0.0, sigma, sigma);
    return solve_linear<3>(A, felt * felt.transpose(), t);
  }
};

/// A letter and its coefficient.
struct spelled {
  char letter;
  double coefficient;
};

/// "BAOAB" and {.5, .5, 1, .5, .5}.
inline std::vector<spelled> spell(std::string_view letters, const auto& coefficients) {
  if (letters.size() != coefficients.size()) throw std::invalid_argument("a coefficient for each letter");
  std::vector<spelled> result;
  for (std::size_t i = 0; i < letters.size(); ++i) result.push_back({letters[i], coefficients[i]});
  return result;
}

/// A letter over the time t, without the noise of O.
inline square<2> letter_map(const damped_oscillator& x, char letter, double t) {
  square<2> map = square<2>::Identity();
  if (letter == 'A') {
    map(0, 1) = t;
  } else if (letter == 'B') {
    map(1, 0) = -x.omega * x.omega * t;
  } else if (letter == 'O') {
    map(1, 1) = std::exp(-x.gamma * t);
  } else {
    throw std::invalid_argument("an oscillator knows A, B and O");
  }
  return map;
}

/// A word's step of size h on (q, p).
inline gaussian_step<2> word_step(const damped_oscillator& x, const std::vector<spelled>& word, double h) {
  gaussian_step<2> result;
  for (const auto& [letter, c] : word) {
    gaussian_step<2> flow{letter_map(x, letter, c * h)};
    if (letter == 'O') flow.covariance(1, 1) = x.exact_with_bath(c * h).covariance(2, 2);
    result = then(result, flow);
  }
  return result;
}

/// Over a step of size h, four numbers: the exact solution (q, p), and how much the word's (q, p) differs
/// from it on the same path. The word's O's take the pieces of the path one after the other, as long as their
/// coefficients say. The difference is a coordinate, so that it does not drown in rounding.
inline gaussian_step<4> step_with_error(const damped_oscillator& x, const std::vector<spelled>& word,
                                        double h) {
  gaussian_step<4> result;
  for (const auto& [letter, c] : word) {
    gaussian_step<2> exact;  // the time goes on in O's
    gaussian_step<4> both;
    if (letter == 'O') {
      const auto piece = x.exact_with_bath(c * h);
      exact.map = piece.map.topLeftCorner<2, 2>();
      Eigen::Matrix<double, 4, 3> felt;
      felt << 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0;
      both.covariance = felt * piece.covariance * felt.transpose();
    }
    const square<2> of_word = letter_map(x, letter, c * h);
    both.map << exact.map, square<2>::Zero(), of_word - exact.map, of_word;
    result = then(result, both);
  }
  return result;
}

/// The covariance of the error after n steps from a point of the given covariance.
inline square<2> error_after(const gaussian_step<4>& step, const square<2>& start, int n) {
  square<4> both = square<4>::Zero();
  both.topLeftCorner<2, 2>() = start;
  for (; n > 0; --n) both = (step.map * both * step.map.transpose() + step.covariance).eval();
  return both.bottomRightCorner<2, 2>();
}

/// Two stages in a bath, at a member that is near the optimum and not quite Verlet.
inline method two_stages(placement where) { return thermostat(member(nystrom(), {0.5, 0.41}), where); }

/// Verlet in a symmetric placement is obabo, and with O in the middle baoab.
inline std::vector<method> langevin_methods() {
  return {baoab(),
          obabo(),
          aboba(),
          baoab_2x(),
          two_stages(placement::end),
          two_stages(placement::symmetric),
          two_stages(placement::middle),
          thermostat(verlet(), placement::end)};
}

using bathed_oscillator = in_bath<harmonic_oscillator>;

inline bathed_oscillator bathed_system(const damped_oscillator& x) {
  return {harmonic_oscillator(x.omega), bath::of_sigma(x.gamma, x.sigma)};
}
inline std::vector<spelled> spell(const method& method) {
  return spell(method.letters().view(), method.coefficients());
}

inline phase_point<double, 1> point(double q, double p) {
  return {vector<double, 1>(q), vector<double, 1>(p)};
}
inline Eigen::Vector2d coordinates_of(const phase_point<double, 1>& x) { return {x.q[0], x.p[0]}; }

/// The number 1 for one letter O of a step, 0 for the others.
struct one_at {
  static constexpr bool is_memoryless = false;
  int flow;
  template <class T, int N>
  void normals(const noise_place& at, vector<T, N>& xi) const {
    xi.fill(T(at.flow == flow ? 1.0 : 0.0));
  }
};

/// A step of the library's as it is: what it makes of unit states and of unit numbers, as it is linear.
inline gaussian_step<2> library_step(const damped_oscillator& x, const method& method, double h) {
  const auto system = bathed_system(x);
  gaussian_step<2> result;
  const auto stepped = [&](phase_point<double, 1> state, int flow) {
    make_stepper(system, method, h, one_at{flow}).step(state);
    return coordinates_of(state);
  };
  result.map << stepped(point(1.0, 0.0), -1), stepped(point(0.0, 1.0), -1);
  for (int flow = 0; flow < method.letters().stochastic_letters; ++flow) {
    const Eigen::Vector2d response = stepped(point(0.0, 0.0), flow);
    result.covariance += response * response.transpose();
  }
  return result;
}

/// Exact paths of the damped oscillator, and their noise, as a ReferenceFlow. Over each part of the time, (q,
/// p) and the noise of the bath come from their joint law.
class exact_paths {
 public:
  explicit exact_paths(const damped_oscillator& x) : oscillator_(x) {}

  template <class S, class T, int N>
  std::int64_t advance(const S&, phase_point<T, N>& x, double t, const path_place& at,
                       std::span<vector<T, N>> xi) const {
    const auto parts = std::max<std::int64_t>(std::ssize(xi), 1);
    const auto part = oscillator_.exact_with_bath(t / static_cast<double>(parts));
    const square<3> L = cholesky(part.covariance);
    const auto& E = part.map;
    const double deviation = std::sqrt(part.covariance(2, 2));
    std::array<T, 3> z;
    for (std::int64_t k = 0; k < parts; ++k) {
      standard_normals<T>(at.seed, {.trajectory = at.trajectory, .step = at.step * parts + k}, z);
      const T q = x.q[0];
      const T p = x.p[0];
      x.q[0] = q * E(0, 0) + p * E(0, 1) + z[0] * L(0, 0);
      x.p[0] = q * E(1, 0) + p * E(1, 1) + z[0] * L(1, 0) + z[1] * L(1, 1);
      if (xi.empty() || deviation == 0.0) continue;
      const T noise = z[0] * L(2, 0) + z[1] * L(2, 1) + z[2] * L(2, 2);
      xi[static_cast<std::size_t>(k)][0] = noise * (1.0 / deviation);
    }
    return 0;
  }

  exact_paths finer() const { return *this; }
  std::string description() const { return "exact_paths()"; }

 private:
  damped_oscillator oscillator_;
};

}  // namespace nysalt::test
