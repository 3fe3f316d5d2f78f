// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/small_steps.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"
#include "nysalt/reference.hpp"

namespace nysalt {

/// Paths of a system in a bath in small steps, with their noise in larger ones. Its error is the difference
/// from a finer one along the same path.
template <Method M = baoab>
class fine_paths {
  static_assert(M::word::stochastic_letters == 1, "nysalt: fine paths need a method with one letter O");

 public:
  /// Throws std::invalid_argument unless the step is positive and finite.
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
  }

  double step_;
  M method_;
  int halvings_;  // of the step whose noise is fresh
};

}  // namespace nysalt
