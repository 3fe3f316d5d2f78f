// SPDX-License-Identifier: BSL-1.0
// Export to C99.
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::program {

std::string export_to_c(const exported_method& method) {
  return fill(R"(@HEADER@//
// Letters act from left to right: A(a) is q += a h M^-1 p, B(b) is p += b h f(q), D(b, c) is B(b) with the force
// at q + c h^2 M^-1 f(q). A run is start once, steps, and finish on a copy of q and p that is looked at; without a
// processor start and finish do nothing. A force that is known is not evaluated again, also from step to step.
// Test: cc -DNYSALT_SELF_TEST FILE -lm && ./a.out
#include <math.h>
#include <stdio.h>

typedef void (*@NAME@_force)(int n, const double *q, double *f, void *data);

static const char @NAME@_kernel[] = "@KERNEL@";
static const double @NAME@_kernel_c[] = {@KERNEL_COEFFICIENTS@};
static const char @NAME@_before[] = "@START@";
static const double @NAME@_before_c[] = {@START_COEFFICIENTS@};
static const char @NAME@_after[] = "@FINISH@";
static const double @NAME@_after_c[] = {@FINISH_COEFFICIENTS@};

// One pass over letters; whether the force at q is known, in the first n of 3 n numbers of work.
static int @NAME@_apply(const char *letters, const double *c, int known, int n, double *q, double *p, double h,
                        @NAME@_force force, const double *inverse_mass, void *data, double *work) {
  double *f = work, *x = work + n, *g = work + 2 * n;
  for (; *letters; ++letters) {
    if (*letters == 'A') {
      for (int i = 0; i < n; ++i) q[i] += *c * h * inverse_mass[i] * p[i];
      known = 0;
      c += 1;
      continue;
    }
    if (!known) force(n, q, f, data);
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
  @NAME@_apply(@NAME@_before, @NAME@_before_c, 0, n, q, p, h, force, inverse_mass, data, work);
}

void @NAME@_steps(int n, double *q, double *p, double h, long steps, @NAME@_force force, const double *inverse_mass,
                  void *data, double *work) {
  int known = 0;
  for (long k = 0; k < steps; ++k)
    known = @NAME@_apply(@NAME@_kernel, @NAME@_kernel_c, known, n, q, p, h, force, inverse_mass, data, work);
}

void @NAME@_finish(int n, double *q, double *p, double h, @NAME@_force force, const double *inverse_mass, void *data,
                   double *work) {
  @NAME@_apply(@NAME@_after, @NAME@_after_c, 0, n, q, p, h, force, inverse_mass, data, work);
}

static void @NAME@_pinned(int n, const double *q, double *f, void *data) {
  (void)n, (void)data;
  f[0] = -q[0] - 2 * q[0] * q[1];
  f[1] = -q[1] - q[0] * q[0] + q[1] * q[1];
}

// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
int @NAME@_self_test(void) {
  const double end_q[2] = {@Q@}, end_p[2] = {@P@}, inverse_mass[2] = {1.0, 0.5};
  double q[2] = {0.3, 0.2}, p[2] = {0.1, -0.25}, work[6], off = 0;
  @NAME@_start(2, q, p, 0.1, @NAME@_pinned, inverse_mass, 0, work);
  @NAME@_steps(2, q, p, 0.1, 10, @NAME@_pinned, inverse_mass, 0, work);
  @NAME@_finish(2, q, p, 0.1, @NAME@_pinned, inverse_mass, 0, work);
  for (int i = 0; i < 2; ++i) off = fmax(off, fmax(fabs(q[i] - end_q[i]), fabs(p[i] - end_p[i])));
  printf("@NAME@: off by %.1e\n", off);
  return !(off < 1e-13);
}

#ifdef NYSALT_SELF_TEST
int main(void) { return @NAME@_self_test(); }
#endif
)",
              values_of(method, "//"));
}

}  // namespace nysalt::program
