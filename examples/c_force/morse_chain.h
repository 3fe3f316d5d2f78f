/* SPDX-License-Identifier: BSL-1.0 */
/* A force as it is in many programs: C, pointers, lengths, and parameters in a struct. */
#ifndef MORSE_CHAIN_H
#define MORSE_CHAIN_H

#ifdef __cplusplus
extern "C" {
#endif

struct morse_bonds {
  double depth;
  double width;
};

/* n atoms in a row behind a wall, at x[0] .. x[n - 1] from where they rest. Writes the force on each to f, and
   returns the potential energy. */
double morse_chain(int n, const double* x, double* f, const struct morse_bonds* bonds);

#ifdef __cplusplus
}
#endif

#endif
