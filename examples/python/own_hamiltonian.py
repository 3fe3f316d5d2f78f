# SPDX-License-Identifier: BSL-1.0
"""A Hamiltonian of your own: two atoms of different masses on Morse springs, one of them to a wall."""
# [system]
import math

import numpy as np

import nysalt


def potential(q):
    wall, between = 1 - math.exp(-q[0]), 1 - math.exp(q[0] - q[1])
    return wall**2 + 2 * between**2


def force(q):  # -grad V
    to_wall, to_other = math.exp(-q[0]), math.exp(q[0] - q[1])
    pull = 4 * (1 - to_other) * to_other
    return [-2 * (1 - to_wall) * to_wall + pull, -pull]


def starts(seed, n):  # q and p of trajectory n
    rng = np.random.default_rng([seed, n])
    return rng.normal(0, 0.1, 2), rng.normal(0, 0.3, 2)


morse = nysalt.hamiltonian("morse_pair", dimension=2, potential=potential, force=force, starts=starts,
                           inverse_mass=[1, 0.25])
# [/system]
# [use]
scheme = nysalt.learn(morse, "nystrom", step=0.3, horizon=7.5, trajectories=20, loss="state:1")
print(scheme.parameters, "usable" if scheme.usable else scheme.reason)

found = nysalt.compare(morse, ["mclachlan2", "verlet_2x", scheme], steps=0.3, horizon=7.5, trajectories=100,
                       metric=["state", "energy"])
for row in found["rows"]:
    print(f"{row['metric']:<8} {row['method']:<16} {row['error']:.2e} +- {row['standard_error']:.0e}")
# [/use]
