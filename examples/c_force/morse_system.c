/* SPDX-License-Identifier: BSL-1.0 */
/* Three atoms on Morse springs behind a wall as a system for the program and for Python: a shared object. */
#include "morse_chain.h"
#include "nysalt/c_force.h"

static const struct morse_bonds bonds = {10.0, 1.0};

int64_t nysalt_dimension(void) { return 3; }

void nysalt_force(int64_t n, const double* q, double* f, void* data) {
  (void)data;
  morse_chain((int)n, q, f, &bonds);
}

double nysalt_potential(int64_t n, const double* q, void* data) {
  double ignored[3];
  (void)data;
  return morse_chain((int)n, q, ignored, &bonds);
}

void nysalt_start(int64_t n, const double* normals, double* q, double* p, void* data) {
  (void)data;
  for (int64_t i = 0; i < n; ++i) {
    q[i] = 0.0;
    p[i] = 0.25 * normals[n + i];
  }
}

const char* nysalt_description(void) { return "morse_chain(depth=10, width=1)"; }
