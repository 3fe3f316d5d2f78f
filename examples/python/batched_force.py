# SPDX-License-Identifier: BSL-1.0
"""A force over arrays: one call a kick for all trajectories."""
# [batched]
import numpy as np

import nysalt


def potential(q):  # of (trajectories, dimension), one number for each trajectory
    return (0.5 * q**2 + 0.25 * q**4).sum(axis=1) + 0.5 * (np.diff(q, axis=1) ** 2).sum(axis=1)


def force(q):  # -grad V, of the shape of q
    elongation = np.diff(q, axis=1, prepend=0.0, append=0.0)
    elongation[:, 0] = elongation[:, -1] = 0.0  # the ends are free
    return -q - q**3 + elongation[:, 1:] - elongation[:, :-1]


def starts(seed, n):
    rng = np.random.default_rng([seed, n])
    return rng.normal(0, 0.5, 8), rng.normal(0, 0.5, 8)


wells = nysalt.hamiltonian("eight_wells", dimension=8, potential=potential, force=force, starts=starts, batched=True)
q, p = wells.starts(1000)
before = wells.energy(q, p)
q, p = nysalt.integrate(wells, "srkn6b", 0.6, q, p, 100)  # 601 calls of the force for 1000 trajectories
print(f"energies of {len(q)} trajectories are off by {np.abs(wells.energy(q, p) - before).mean():.1e}")
# [/batched]
