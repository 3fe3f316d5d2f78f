// SPDX-License-Identifier: BSL-1.0
#pragma once

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>

#include "nysalt/detail/sentence.hpp"
#include "nysalt/detail/small_steps.hpp"
#include "nysalt/method.hpp"
#include "nysalt/methods/classical.hpp"

namespace nysalt {

/// Any method with a small step. SRKN11b (order 6) is the default: at omega h = 5e-3 its error is
/// rounding. It needs a quadratic K(p): of any other, take fine_steps<blanes_moan_s10>. A second-order method
/// needs a far smaller step, or what is learned is its error.
template <Method M = srkn11b>
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

}  // namespace nysalt
