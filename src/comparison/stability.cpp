// SPDX-License-Identifier: BSL-1.0
#include "stability.hpp"

#include "nysalt/derivatives/linear_stability.hpp"
#include "nysalt/derivatives/oscillator.hpp"

namespace nysalt::program {

stability_chart chart_of(const tabulated& method) {
  return chart_stability(method.letters(), method.coefficients());
}
std::vector<stability_window> stability_of(const tabulated& method) { return chart_of(method).windows; }
double limit_of(const tabulated& method) { return stability_limit(method); }

double half_trace_of(const tabulated& method, double z) {
  const auto times_all = [z](double x) { return z * z * x; };
  double qq = 1.0, pq = 0.0, qp = 0.0, pp = 1.0;
  step_on_oscillator(method.letters(), method.coefficients(), 0.0, times_all, qq, pq);
  step_on_oscillator(method.letters(), method.coefficients(), 0.0, times_all, qp, pp);
  return 0.5 * (qq + pp);
}

}  // namespace nysalt::program
