// SPDX-License-Identifier: BSL-1.0
// Export to REBOUND.
#include <fmt/format.h>

#include "exported_method.hpp"
#include "exports.hpp"
#include "fill.hpp"

namespace nysalt::detail {

std::string export_to_rebound(const exported_method& method) {
  const exported_letters word = composition_of(method, "REBOUND");
  auto values = values_of_header(method, "//");
  values.emplace_back("LETTERS", word.letters);
  values.emplace_back("LIST", digits(word.coefficients));
  const std::size_t forces = word.count('B');
  values.emplace_back("FORCES", std::to_string(forces));
  return fill(R"(@HEADER@//
@EXPLAINED@
// An integrator of REBOUND 5. The forces are computed at each kick, @FORCES@ times a step: REBOUND keeps none from step
// to step, so that of two words of equal work that which begins with a drift is the cheaper one.
//   @NAME@_register();
//   reb_simulation_set_integrator(r, "@NAME@");
// Test, of a stand-in for the simulation: cc -DNYSALT_SELF_TEST FILE -lm && ./a.out
#include <stddef.h>
#ifndef NYSALT_SELF_TEST
#include "rebound.h"
#else
#include <math.h>
#include <stdio.h>

// What a step asks of REBOUND: two oscillators, the x of two particles with the masses 1 and 2.
#define REB_GRAVITY_IGNORE_TERMS_NONE 0
struct reb_particle {
  double x, y, z, vx, vy, vz, ax, ay, az, m;
};
struct reb_simulation {
  double t, dt;
  size_t N;
  int gravity_ignore_terms;
  struct reb_particle *particles;
};
static void reb_simulation_update_acceleration(struct reb_simulation *r) {
  const double x = r->particles[0].x, y = r->particles[1].x;
  r->particles[0].ax = (-x - 2 * x * y) / r->particles[0].m;
  r->particles[1].ax = (-y - x * x + y * y) / r->particles[1].m;
}
#endif

static void @NAME@_step(struct reb_simulation *r, void *state) {
  static const char letters[] = "@LETTERS@";
  static const double coefficients[] = {@LIST@};
  struct reb_particle *const particles = r->particles;
  (void)state;
  r->gravity_ignore_terms = REB_GRAVITY_IGNORE_TERMS_NONE;
  for (int k = 0; letters[k]; ++k) {
    const double c = coefficients[k] * r->dt;
    if (letters[k] == 'A') {
      for (size_t i = 0; i < (size_t)r->N; ++i) {
        particles[i].x += c * particles[i].vx;
        particles[i].y += c * particles[i].vy;
        particles[i].z += c * particles[i].vz;
      }
      r->t += c;
    } else {
      reb_simulation_update_acceleration(r);
      for (size_t i = 0; i < (size_t)r->N; ++i) {
        particles[i].vx += c * particles[i].ax;
        particles[i].vy += c * particles[i].ay;
        particles[i].vz += c * particles[i].az;
      }
    }
  }
}

#ifndef NYSALT_SELF_TEST
void @NAME@_register(void) {
  const struct reb_integrator integrator = {.step = @NAME@_step};
  reb_integrator_register(integrator, "@NAME@");
}
#else
// 0 if ten steps of two oscillators end where nysalt's own do; their rounding differs by less than 1e-13.
int main(void) {
  const double end_q[2] = {@Q@}, end_p[2] = {@P@};
  struct reb_particle both[2] = {{.x = 0.3, .vx = 0.1, .m = 1.0}, {.x = 0.2, .vx = -0.125, .m = 2.0}};
  struct reb_simulation r = {.dt = 0.1, .N = 2, .particles = both};
  double off = 0;
  for (int k = 0; k < 10; ++k) @NAME@_step(&r, NULL);
  for (int i = 0; i < 2; ++i)
    off = fmax(off, fmax(fabs(both[i].x - end_q[i]), fabs(both[i].m * both[i].vx - end_p[i])));
  off = fmax(off, fabs(r.t - 1.0));
  printf("@NAME@: off by %.1e\n", off);
  return !(off < 1e-13);
}
#endif
)",
              values);
}

}  // namespace nysalt::detail
