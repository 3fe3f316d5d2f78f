// SPDX-License-Identifier: BSL-1.0
// Export to C99.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_c(const exported_method& method) {
  auto values = values_of(method, "//");
  add_bath(values, method,
           {{"BATH_TYPE", R"(
// Friction, the temperature kT, and a source of standard normal numbers, one a call.
typedef struct {
  double friction, temperature;
  double (*normal)(void *source);
  void *source;
} @NAME@_bath;
)"},
            {"BATH_PARAMETER", ", const @NAME@_bath *bath"},
            {"BATH_NONE", ", 0"},
            {"BATH", ", bath"},
            {"BATH_BRANCH", R"(    if (*letters == 'O') {
      const double damping = *c * h * bath->friction, decay = exp(-damping);
      const double spread = sqrt(-expm1(-2 * damping) * bath->temperature);
      for (int i = 0; i < n; ++i) p[i] = decay * p[i] + spread / sqrt(inverse_mass[i]) * bath->normal(bath->source);
      c += 1;
      continue;
    }
)"},
            {"BATH_PINNED", "static double @NAME@_sine(void *k) { return sin((double)++*(int *)k); }\n\n"},
            {"BATH_MADE", "  int k = 0;\n  const @NAME@_bath bath = {1.5, 0.7, @NAME@_sine, &k};\n"},
            {"BATH_TEST", ", &bath"}});
  return fill(R"(@HEADER@//
@EXPLAINED@
// A run is start once, steps, and finish on a copy of q and p that is observed; without a processor start and finish
// do nothing. A force that is known is not evaluated again, also from step to step.
// Test: cc -DNYSALT_SELF_TEST FILE -lm && ./a.out
#include <math.h>
#include <stdio.h>

typedef void (*@NAME@_force)(int n, const double *q, double *f, void *data);
@BATH_TYPE@
static const char @NAME@_kernel[] = "@KERNEL@";
static const double @NAME@_kernel_c[] = {@KERNEL_COEFFICIENTS@};
static const char @NAME@_before[] = "@START@";
static const double @NAME@_before_c[] = {@START_COEFFICIENTS@};
static const char @NAME@_after[] = "@FINISH@";
static const double @NAME@_after_c[] = {@FINISH_COEFFICIENTS@};

// One pass over letters; whether the force at q is known, in the first n of 3 n numbers of work.
static int @NAME@_apply(const char *letters, const double *c, int known, int n, double *q, double *p, double h,
                        @NAME@_force force, const double *inverse_mass, void *data, double *work@BATH_PARAMETER@) {
  double *f = work, *x = work + n, *g = work + 2 * n;
  for (; *letters; ++letters) {
    if (*letters == 'A') {
      for (int i = 0; i < n; ++i) q[i] += *c * h * inverse_mass[i] * p[i];
      known = 0;
      c += 1;
      continue;
    }
@BATH_BRANCH@    if (!known) force(n, q, f, data);
    known = 1;
    if (*letters == 'B') {
      for (int i = 0; i < n; ++i) p[i] += *c * h * f[i];
      c += 1;
    } else {
      for (int i = 0; i < n; ++i) x[i] = q[i] + c[1] * h * h * inverse_mass[i] * f[i];
      force(n, x, g, data);
      for (int i = 0; i < n; ++i) p[i] += c[0] * h * g[i];
      c += 2;
    }
  }
  return known;
}

void @NAME@_start(int n, double *q, double *p, double h, @NAME@_force force, const double *inverse_mass, void *data,
                  double *work) {
  @NAME@_apply(@NAME@_before, @NAME@_before_c, 0, n, q, p, h, force, inverse_mass, data, work@BATH_NONE@);
}

void @NAME@_steps(int n, double *q, double *p, double h, long steps, @NAME@_force force, const double *inverse_mass,
                  void *data, double *work@BATH_PARAMETER@) {
  int known = 0;
  for (long k = 0; k < steps; ++k)
    known = @NAME@_apply(@NAME@_kernel, @NAME@_kernel_c, known, n, q, p, h, force, inverse_mass, data, work@BATH@);
}

void @NAME@_finish(int n, double *q, double *p, double h, @NAME@_force force, const double *inverse_mass, void *data,
                   double *work) {
  @NAME@_apply(@NAME@_after, @NAME@_after_c, 0, n, q, p, h, force, inverse_mass, data, work@BATH_NONE@);
}

static void @NAME@_pinned(int n, const double *q, double *f, void *data) {
  (void)n, (void)data;
  f[0] = -q[0] - 2 * q[0] * q[1];
  f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
}

@BATH_PINNED@// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
int @NAME@_self_test(void) {
  const double end_q[2] = {@Q@}, end_p[2] = {@P@}, inverse_mass[2] = {1.0, 0.5};
  double q[2] = {0.3, 0.2}, p[2] = {0.1, -0.25}, work[6], off = 0;
@BATH_MADE@  @NAME@_start(2, q, p, 0.1, @NAME@_pinned, inverse_mass, 0, work);
  @NAME@_steps(2, q, p, 0.1, 10, @NAME@_pinned, inverse_mass, 0, work@BATH_TEST@);
  @NAME@_finish(2, q, p, 0.1, @NAME@_pinned, inverse_mass, 0, work);
  for (int i = 0; i < 2; ++i) off = fmax(off, fmax(fabs(q[i] - end_q[i]), fabs(p[i] - end_p[i])));
  printf("@NAME@: off by %.1e\n", off);
  return !(off < 1e-13);
}

#ifdef NYSALT_SELF_TEST
int main(void) { return @NAME@_self_test(); }
#endif
)",
              values);
}

}  // namespace nysalt::detail
