// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "nysalt/detail/in_digits.hpp"
#include "nysalt/detail/sentence.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/baoab.hpp"
#include "nysalt/noises/finer_noise.hpp"
#include "nysalt/noises/recorded_path.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// Paths of a system in a bath in small steps, with their noise in larger ones. Its error is what a finer one
/// along the same path tells.
template <Method M = baoab>
class fine_paths {
  static_assert(M::word::stochastic_letters == 1, "nysalt: fine paths need a method with one letter O");

 public:
  /// Throws std::invalid_argument unless the step is positive and finite.
  explicit fine_paths(double step, const M& method = M{}) : fine_paths(step, method, 0) {}

  /// x becomes the state a time t later on its path, the `at.step`-th such time of it; xi[k] become the
  /// standard normal numbers of the noise over the k-th of so many equal parts of that time. Throws
  /// std::invalid_argument unless each part is a positive multiple of the step, to 1e-9 relative.
  template <HasBath S, Scalar T>
  void advance(const S& system, phase_point<T, S::dimension>& x, double t, const path_place& at,
               std::span<vector<T, S::dimension>> xi) const {
    const std::int64_t parts = std::max<std::int64_t>(std::ssize(xi), 1);
    const double ratio = t / step_ / static_cast<double>(parts);
    const double steps = std::round(ratio);
    if (!(steps >= 1.0) || !(steps < 1e18) || !(std::abs(ratio - steps) <= 1e-9 * steps)) {
      throw std::invalid_argument(sentence(
          "fine_paths: the time {} in {} equal parts, as the noise is wanted, is not a multiple of the fine "
          "step {}",
          t, parts, step_));
    }
    const auto of_a_part = static_cast<std::int64_t>(steps);
    const double h = t / (steps * static_cast<double>(parts));
    const double friction = system.bath().friction();
    const finer_noise path(at.seed, std::ldexp(friction * h, halvings_), halvings_);
    const coarse_graining coarse(friction * h);
    vector<T, S::dimension>* sum = nullptr;
    const auto fine = make_stepper(system, method_, h, recorder<T, S::dimension>{&path, &coarse, &sum});
    auto run = fine.open(x, at.trajectory);
    run.step = at.step * parts * of_a_part;
    for (std::int64_t k = 0; k < parts; ++k) {
      sum = xi.empty() ? nullptr : &xi[static_cast<std::size_t>(k)];
      if (sum != nullptr) coarse.first(*sum);
      fine.advance(run, of_a_part);
      if (sum != nullptr) coarse.last(*sum, of_a_part);
    }
    x = fine.synchronous(run);
  }

  double step() const { return step_; }        ///< of its method
  const M& method() const { return method_; }  ///< that takes the steps
  int halvings() const { return halvings_; }   ///< of the step whose noise is fresh

  /// Half the step, on the same path.
  fine_paths finer() const { return fine_paths(0.5 * step_, method_, halvings_ + 1); }
  std::string description() const {
    return sentence("{} with step {}", method_.name(), in_digits(step_, 12));
  }

 private:
  /// Adds up what it hands out.
  template <class T, int N>
  struct recorder {
    static constexpr bool draws_freely = false;
    const finer_noise* path;
    const coarse_graining* coarse;
    vector<T, N>* const* sum;

    void normals(const noise_place& at, vector<T, N>& xi) const {
      path->normals(at, xi);
      if (*sum != nullptr) coarse->next(**sum, xi);
    }
  };

  fine_paths(double step, const M& method, int halvings) : step_(step), method_(method), halvings_(halvings) {
    if (!(step > 0.0) || !std::isfinite(step)) {
      throw std::invalid_argument(sentence("fine_paths: the step must be positive and finite, got {}", step));
    }
  }

  double step_;
  M method_;
  int halvings_;  // of the step whose noise is fresh
};

}  // namespace nysalt
