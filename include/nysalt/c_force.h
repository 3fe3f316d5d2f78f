/* SPDX-License-Identifier: BSL-1.0 */
/*
 * A Hamiltonian H = sum_i p_i^2/(2 m_i) + V(q) by functions of C, or of any language that offers functions as C
 * does. A shared object that defines them is a system for the program and for Python:
 *   cc -O3 -shared -fPIC mine.c -o mine.so && nysalt run --system ./mine.so ...
 * Of a system with several threads each has its own `data`; without nysalt_open it is null.
 */
#ifndef NYSALT_C_FORCE_H
#define NYSALT_C_FORCE_H

#include <stdint.h>  // NOLINT(modernize-deprecated-headers): a header for C too

#ifdef __cplusplus
extern "C" {
#endif

/* Degrees of freedom, n in what follows. */
int64_t nysalt_dimension(void);
/* f = -grad V(q); neither q nor f is kept. */
void nysalt_force(int64_t n, const double *q, double *f, void *data);
/* V(q). */
double nysalt_potential(int64_t n, const double *q, void *data);
/* The start of a trajectory from 2 n independent standard normal numbers, which the program has multiplied by the
 * spread. */
void nysalt_start(int64_t n, const double *normals, double *q, double *p, void *data);

/* These may be missing. */
double nysalt_inverse_mass(int64_t i);     /* 1/m_i; missing: all are 1 */
double nysalt_frequency(void);             /* the highest angular frequency of the motion; missing: estimated */
const char *nysalt_description(void);      /* one line with all parameters; missing: the name of the file */
const char *nysalt_kind(void);             /* the same without the size; missing: no other file is of its kind */
void *nysalt_open(void);                   /* what the functions get as data; null where it cannot be had */
void nysalt_close(void *data);

#ifdef __cplusplus
}
#endif

#endif
