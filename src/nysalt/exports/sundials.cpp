// SPDX-License-Identifier: BSL-1.0
// Export to the SPRKStep of SUNDIALS.
#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_sundials(const exported_method& method) {
  const exported_letters word = composition_of(method, "SUNDIALS");
  const auto [kicks, drifts] = in_stages(word, 'B');
  auto values = values_of_header(method, "//");
  values.emplace_back("STAGES", std::to_string(kicks.size()));
  values.emplace_back("ORDER", std::to_string(method.method.order));
  values.emplace_back("A", digits(drifts));
  values.emplace_back("AHAT", digits(kicks));
  return fill(R"(@HEADER@//
// The table of SPRKStep, since SUNDIALS 6.6: stage i is p += ahat[i] h f1(q), then q += a[i] h f2(p). It evaluates f1 in
// each of its @STAGES@ stages, also where ahat[i] is zero.
//   SPRKStepSetMethod(memory, @NAME@_table()); SPRKStepSetFixedStep(memory, h);
// Test, of a stand-in with the loop of SPRKStep: cc -DNYSALT_SELF_TEST FILE -lm && ./a.out
static const double @NAME@_a[] = {@A@};
static const double @NAME@_ahat[] = {@AHAT@};

#ifndef NYSALT_SELF_TEST
#include <arkode/arkode_sprk.h>

// Null where there is no memory; freed by ARKodeSPRKTable_Free.
ARKodeSPRKTable @NAME@_table(void) { return ARKodeSPRKTable_Create(@STAGES@, @ORDER@, @NAME@_a, @NAME@_ahat); }
#else
#include <math.h>
#include <stdio.h>

// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
int main(void) {
  const double end_q[2] = {@Q@}, end_p[2] = {@P@}, inverse_mass[2] = {1.0, 0.5}, h = 0.1;
  double q[2] = {0.3, 0.2}, p[2] = {0.1, -0.25}, off = 0;
  for (int k = 0; k < 10; ++k) {
    for (int i = 0; i < @STAGES@; ++i) {
      const double f[2] = {-q[0] - 2 * q[0] * q[1], -q[1] - q[0] * q[0] + q[1] * q[1]};
      for (int j = 0; j < 2; ++j) p[j] += @NAME@_ahat[i] * h * f[j];
      for (int j = 0; j < 2; ++j) q[j] += @NAME@_a[i] * h * inverse_mass[j] * p[j];
    }
  }
  for (int j = 0; j < 2; ++j) off = fmax(off, fmax(fabs(q[j] - end_q[j]), fabs(p[j] - end_p[j])));
  printf("@NAME@: off by %.1e\n", off);
  return !(off < 1e-13);
}
#endif
)",
              values);
}

}  // namespace nysalt::detail
