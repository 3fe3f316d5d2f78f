// SPDX-License-Identifier: BSL-1.0
// What a stability window claims, checked without the code that found it.
#pragma once

#include <Eigen/Core>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "../support/dense.hpp"
#include "../support/rounding.hpp"
#include "nysalt/derivatives/jacobian.hpp"
#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/systems/harmonic_oscillator.hpp"

namespace nysalt::test {

/// The oscillator of frequency 1, so that z is the step.
inline const harmonic_oscillator& unit_oscillator() {
  static const harmonic_oscillator system(1.0);
  return system;
}

inline phase_point<double, 1> at_one() { return {vector<double, 1>(1.0), vector<double, 1>(1.0)}; }

/// The eigenvalues' largest absolute value, from the exact Jacobian of a step.
template <Method M>
double spectral_radius(const M& method, double z) {
  const Eigen::MatrixXd step = jacobian(step_map(unit_oscillator(), method, z), at_one());
  return spectral_radius(step);
}

/// What rounding may add to it where the eigenvalues are apart: the determinant, 1, is their squared size,
/// and errs by 2 |J| |dJ|. Letter k rounds the product P_k so far, by 2 eps |L_k| |P_k|, and the letters
/// after it carry that on.
template <Method M>
double radius_rounding(const M& method, double z) {
  const auto word = word_of(method);
  const std::string letters = word.letters();
  const auto c = method.coefficients();
  std::vector<Eigen::Matrix2d> so_far;
  std::vector<Eigen::Matrix2d> letter(letters.size(), Eigen::Matrix2d::Identity());
  Eigen::Matrix2d product = Eigen::Matrix2d::Identity();
  for (std::size_t k = 0; k < letters.size(); ++k) {
    const std::size_t slot = word.first_slot(k);
    if (letters[k] == 'B') letter[k](1, 0) = -c[slot] * z;
    if (letters[k] == 'G') letter[k](1, 0) = -c[slot] * z + 2.0 * c[slot + 1] * z * z * z;
    if (letters[k] == 'A') letter[k](0, 1) = c[slot] * z;
    product = letter[k] * product;
    so_far.push_back(product);
  }
  double error = 0.0;
  Eigen::Matrix2d rest = Eigen::Matrix2d::Identity();
  for (std::size_t k = letters.size(); k-- > 0;) {
    error += 2.0 * eps * norm(rest) * norm(letter[k]) * norm(so_far[k]);
    rest = rest * letter[k];
  }
  return 2.0 * norm(product) * error;
}

/// Largest coordinate over 100,000 steps, or where it first exceeds 1e9. (Not by integrate: near the ends of
/// a window bounded orbits swing by more than its criterion for divergence.)
template <Method M>
double largest_in_long_run(const M& method, double z) {
  const auto fixed = make_stepper(unit_oscillator(), method, z);
  auto run = fixed.open(at_one());
  double largest = 0.0;
  while (run.step < 100'000 && largest <= 1e9) {
    fixed.advance(run, 1);
    largest = std::max(largest, size_of(fixed.synchronous(run)));
  }
  return largest;
}

/// What it may be inside a window: with trace/2 = cos t, J^n = cos(n t) + sin(n t)/sin(t) (J - cos t).
/// Twice that, as rounding moves t by a little.
template <Method M>
double bound_of_long_run(const M& method, double z) {
  const Eigen::Matrix2d step = jacobian(step_map(unit_oscillator(), method, z), at_one());
  const double cosine = 0.5 * step.trace();
  return 2.0 * (1.0 + norm(step - cosine * Eigen::Matrix2d::Identity()) / std::sqrt(1.0 - cosine * cosine));
}

/// Calls inside(z) and outside(z) near the ends of every window: so large a part of the narrowest width or
/// gap beside the end away from it. A window that begins at 0 has no outside there. Far out letters magnify
/// so much that rounding hides where a window ends: those are left out, but never the first.
template <Method M>
void try_ends(const M& method, double part_inside, double part_outside, auto&& inside, auto&& outside) {
  const auto windows = stability_windows(method);
  for (std::size_t i = 0; i < windows.size(); ++i) {
    const auto [low, high] = windows[i];
    if (i > 0 && radius_rounding(method, high) > 1e-6) continue;
    double nearest = high - low;
    if (i > 0) nearest = std::min(nearest, low - windows[i - 1].high);
    if (i + 1 < windows.size()) nearest = std::min(nearest, windows[i + 1].low - high);
    BOOST_TEST_CONTEXT("window " << low << ".." << high) {
      inside(high - part_inside * nearest);
      outside(high + part_outside * nearest);
      inside(low + part_inside * nearest);
      if (low > 0.0) outside(low - part_outside * nearest);
    }
  }
}

}  // namespace nysalt::test
