// SPDX-License-Identifier: BSL-1.0
// References that take small steps of an accurate method: along the motion, or along a path of noise.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/noises/counter_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/reference.hpp"

// Reference flows by small steps of a method, for systems by their type and for models.

namespace nysalt::detail {

/// The number of steps in each of `parts` equal parts of the time t; nothing unless it is a positive integer,
/// to 1e-9 relative.
inline std::optional<std::int64_t> whole_steps(double t, double step, std::int64_t parts = 1) {
  const double ratio = t / step / static_cast<double>(parts);
  const double steps = std::round(ratio);
  if (!(steps >= 1.0) || !(steps < 1e18) || !(std::abs(ratio - steps) <= 1e-9 * steps)) return std::nullopt;
  return static_cast<std::int64_t>(steps);
}

/// A noise source that sums the noise it returns, over each part of a time.
template <class T, int N>
struct summing_noise {
  static constexpr bool is_memoryless = false;
  const finer_noise* path;
  const coarse_graining* coarse;
  vector<T, N>* const* sum;

  void normals(const noise_place& at, vector<T, N>& xi) const {
    path->normals(at, xi);
    if (*sum != nullptr) coarse->next(**sum, xi);
  }
};

/// Advances x on its path by the time t, in steps of a method whose noise was halved `halvings` times; see
/// fine_paths::advance(). Returns the number of steps.
template <HasBath S, Scalar T>
std::int64_t advance_on_path(const S& system, const tabulated& method, double step, int halvings,
                             phase_point<T, S::dimension>& x, double t, const path_place& at,
                             std::span<vector<T, S::dimension>> xi) {
  const std::int64_t parts = std::max<std::int64_t>(std::ssize(xi), 1);
  const auto of_a_part = whole_steps(t, step, parts);
  if (!of_a_part) {
    throw std::invalid_argument(
        sentence("fine_paths: the time {} in the {} equal parts of the noise must be a multiple of "
                 "the fine step {}",
                 t, parts, step));
  }
  const std::int64_t steps = *of_a_part * parts;
  const double h = t / (static_cast<double>(*of_a_part) * static_cast<double>(parts));
  const double friction = system.bath().friction();
  const finer_noise path(at.seed, std::ldexp(friction * h, halvings), halvings);
  const coarse_graining coarse(friction * h);
  vector<T, S::dimension>* sum = nullptr;
  const auto fine = make_stepper(system, method, h, summing_noise<T, S::dimension>{&path, &coarse, &sum});
  auto run = fine.open(x, at.trajectory);
  run.step = at.step * steps;
  for (std::int64_t k = 0; k < parts; ++k) {
    sum = xi.empty() ? nullptr : &xi[static_cast<std::size_t>(k)];
    if (sum != nullptr) coarse.first(*sum);
    fine.advance(run, *of_a_part);
    if (sum != nullptr) coarse.last(*sum, *of_a_part);
  }
  x = fine.synchronous(run);
  return steps;
}

}  // namespace nysalt::detail

namespace nysalt {

/// Any method with a small step. SRKN11b (order 6) is the default: at omega h = 5e-3 its error is
/// rounding. It needs a quadratic K(p): of any other, take fine_steps<blanes_moan_s10>. A second-order method
/// needs a far smaller step, or what is learned is its error.
template <class M = srkn11b>
class fine_steps {
 public:
  /// Throws std::invalid_argument unless the step is positive and finite.
  explicit fine_steps(double step, const M& method = M{}) : step_(step), method_(method) {
    if (!(step > 0.0) || !std::isfinite(step)) {
      throw std::invalid_argument(sentence("fine_steps: the step must be positive and finite, got {}", step));
    }
  }

  /// x becomes the state a time t later. Throws std::invalid_argument unless t is a positive multiple of
  /// the step, to 1e-9 relative.
  template <SeparableSystem S, Scalar T>
  void advance(const S& system, phase_point<T, S::dimension>& x, double t) const {
    const auto steps = detail::whole_steps(t, step_);
    if (!steps) {
      throw std::invalid_argument(
          sentence("fine_steps: the time must be a multiple of the fine step, got {} and {}", t, step_));
    }
    const auto fine = make_stepper(system, method_, t / static_cast<double>(*steps));
    auto run = fine.open(x);
    fine.advance(run, *steps);
    x = fine.synchronous(run);
  }

  double step() const { return step_; }                                  ///< step of the method
  const M& method() const { return method_; }                            ///< method of the steps
  fine_steps finer() const { return fine_steps(0.5 * step_, method_); }  ///< reference with half the step
  std::string description() const {
    return sentence("{} with step {}", method_.name(), in_digits(step_, 12));
  }

 private:
  double step_;
  M method_;
};

/// Paths of a system in a bath in small steps, with their noise in larger ones. Its error is the difference
/// from a finer one along the same path.
template <class M = baoab>
class fine_paths {
 public:
  /// Throws std::invalid_argument unless the step is positive and finite and the method has one letter O.
  explicit fine_paths(double step, const M& method = M{}) : fine_paths(step, method, 0) {}

  /// x becomes the state a time t later on its path, interval `at.step` of the path; xi[k] become the
  /// standard normal numbers of the noise over the k-th of as many equal parts of that time. Throws
  /// std::invalid_argument unless each part is a positive multiple of the step, to 1e-9 relative.
  template <HasBath S, Scalar T>
  void advance(const S& system, phase_point<T, S::dimension>& x, double t, const path_place& at,
               std::span<vector<T, S::dimension>> xi) const {
    detail::advance_on_path(system, method_, step_, halvings_, x, t, at, xi);
  }

  double step() const { return step_; }        ///< step of the method
  const M& method() const { return method_; }  ///< method of the steps
  int halvings() const { return halvings_; }   ///< halvings of the step with fresh noise

  /// Half the step, on the same path.
  fine_paths finer() const { return fine_paths(0.5 * step_, method_, halvings_ + 1); }
  std::string description() const {
    return sentence("{} with step {}", method_.name(), in_digits(step_, 12));
  }

 private:
  fine_paths(double step, const M& method, int halvings) : step_(step), method_(method), halvings_(halvings) {
    if (!(step > 0.0) || !std::isfinite(step)) {
      throw std::invalid_argument(sentence("fine_paths: the step must be positive and finite, got {}", step));
    }
    if (method.letters().stochastic_letters != 1) {
      throw std::invalid_argument(
          sentence("fine_paths: the method must have one letter O, got {} of the word {}; take baoab or aboba",
                   method.name(), method.letters().letters()));
    }
  }

  double step_;
  M method_;
  int halvings_;  // of the step whose noise is fresh
};

}  // namespace nysalt
