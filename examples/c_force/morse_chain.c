/* SPDX-License-Identifier: BSL-1.0 */
#include "morse_chain.h"

#include <math.h>

double morse_chain(int n, const double* x, double* f, const struct morse_bonds* bonds) {
  double energy = 0.0;
  for (int i = 0; i < n; ++i) f[i] = 0.0;
  for (int i = 0; i < n; ++i) {
    const double elongation = i == 0 ? x[0] : x[i] - x[i - 1];
    const double decay = exp(-bonds->width * elongation);
    const double pull = 2.0 * bonds->depth * bonds->width * decay * (1.0 - decay);
    energy += bonds->depth * (1.0 - decay) * (1.0 - decay);
    f[i] -= pull;
    if (i > 0) f[i - 1] += pull;
  }
  return energy;
}
