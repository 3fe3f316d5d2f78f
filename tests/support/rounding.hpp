// SPDX-License-Identifier: BSL-1.0
// What rounding may do: the ingredients of tolerances, so that none is guessed.
#pragma once

#include <Eigen/Core>
#include <boost/test/unit_test.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>

#include "nysalt/method.hpp"

namespace nysalt::test {

using boost::test_tools::per_element, boost::test_tools::tolerance;

inline constexpr double eps = std::numeric_limits<double>::epsilon();
inline constexpr double infinite = std::numeric_limits<double>::infinity();
inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// Largest absolute row sum: how much a matrix can magnify the largest coordinate.
inline double norm(const Eigen::MatrixXd& a) { return a.cwiseAbs().rowwise().sum().maxCoeff(); }

/// A phase_point, or a point in a list.
template <class X>
concept Point = requires(const X& x) {
  x.q.size();
  x.p.size();
};

double size_of(const Point auto& x) {
  return std::max({1.0, x.q.cwiseAbs().maxCoeff(), x.p.cwiseAbs().maxCoeff()});
}

double distance(const Point auto& x, const Point auto& y) {
  return std::max((x.q - y.q).cwiseAbs().maxCoeff(), (x.p - y.p).cwiseAbs().maxCoeff());
}
/// One may be {q, p}.
template <int N>
double distance(const phase_point<double, N>& x, const phase_point<double, N>& y) {
  return std::max((x.q - y.q).cwiseAbs().maxCoeff(), (x.p - y.p).cwiseAbs().maxCoeff());
}

bool same_bits(const Point auto& x, const Point auto& y) { return x.q == y.q && x.p == y.p; }

/// The Hessian of V at q, from the force over dual numbers.
template <SeparableSystem S>
Eigen::MatrixXd hessian(const S& system, const vector<double, S::dimension>& q) {
  using D = dual<double, 1>;
  vector<D, S::dimension> x = q.template cast<D>();
  vector<D, S::dimension> f = x;
  Eigen::MatrixXd columns(q.size(), q.size());
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    x[k] = D::variable(q[k], 0);
    force<D>(system, x, f);
    x[k] = D(q[k]);
    for (Eigen::Index i = 0; i < q.size(); ++i) columns(i, k) = -f[i].derivative[0];
  }
  return columns;
}

/// Sizes of the second derivatives of V and K around a state, the soft and the quadratic part of V among
/// them, and of that of |grad V|^2/2: what letters shear with.
struct shears {
  double potential;
  double kinetic;
  double gradient;
  double frequency() const { return std::max(1.0, std::sqrt(potential * kinetic)); }
};

/// How much the letters of one step can magnify a perturbation: the product of 1 + |c h| |shear| over
/// them, with shears twice as large as at the start, since the state moves. A rotation is a shear of both
/// kinds at most. Those of the bath do not magnify.
inline double transient_growth(const method& method, double step, const shears& at) {
  double product = 1.0;
  const word& letters = method.letters();
  const auto& c = method.coefficients();
  const auto magnify = [&](char letter, std::size_t slot) {
    const double time = 2.0 * std::abs(c[slot] * step);
    switch (letter) {
      case 'A':
        product *= 1.0 + time * at.kinetic;
        break;
      case 'B':
      case 'S':
        product *= 1.0 + time * at.potential;
        break;
      case 'G':
      case 'H':
        product *= 1.0 + time * at.potential + 4.0 * std::abs(c[slot + 1] * step * step * step) * at.gradient;
        break;
      case 'D': {  // of the force at a point that is itself a kick away, and whose f' may be as large again
        const double displaced = 2.0 * std::abs(c[slot + 1] * step * step) * at.potential * at.kinetic;
        product *= 1.0 + time * at.potential * (1.0 + displaced);
        break;
      }
      case 'R':
        product *= (1.0 + time * at.kinetic) * (1.0 + time * at.potential);
        break;
      default:
        break;
    }
  };
  for (std::size_t i = 0; i < letters.length; ++i) magnify(letters.letter(i), letters.first_slot(i));
  const std::string_view processor = letters.processor();
  for (int times = 0; times < 2; ++times) {  // before and after
    for (std::size_t i = 0; i < processor.size(); ++i) magnify(processor[i], letters.kernel_slots + i);
  }
  return product;
}

/// How often a step rounds a coordinate, in units of the two roundings of a kick: a gradient or displaced
/// kick has two terms more, and each entry of a rotated state is two sums over n modes or coordinates.
inline double roundings(std::string_view letters, Eigen::Index n) {
  double sum = 0.0;
  for (const char letter : letters) {
    sum += letter == 'R'                                     ? 2.0 * static_cast<double>(n + 2)
           : letter == 'G' || letter == 'H' || letter == 'D' ? 3.0
                                                             : 1.0;
  }
  return sum;
}
inline double roundings(const method& method, Eigen::Index n) {
  const word& letters = method.letters();
  return roundings(letters.view(), n) +
         roundings(letters.processor(), n);  // a processor acts before and after
}

}  // namespace nysalt::test
