// SPDX-License-Identifier: BSL-1.0
#include "stability.hpp"

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/oscillator.hpp"

namespace nysalt::program {

stability_chart chart_of(const method& method) {
  return chart_stability(method.letters(), method.coefficients());
}
std::vector<stability_window> stability_of(const method& method) { return chart_of(method).windows; }
double limit_of(const nysalt::method& method) { return stability_limit(method); }

double half_trace_of(const nysalt::method& method, double z) {
  return detail::matrix_on_oscillator(method.letters(), method.coefficients(), z * z).half_trace();
}

}  // namespace nysalt::program
