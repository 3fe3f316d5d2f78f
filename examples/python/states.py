# SPDX-License-Identifier: BSL-1.0
"""States that are yours, stepped in place."""
# [states]
import nysalt

chain = nysalt.system("fpu", omega=50)
q, p = chain.starts(1000)  # trajectories x dimension; any arrays of yours
before = chain.energy(q, p)
for _ in range(10):
    nysalt.integrate(chain, "s_aia2", 0.02, q, p, 50, out=(q, p))  # no copy is made
    off = abs(chain.energy(q, p) / before - 1)
    print(f"energy is off by {off.mean():.1e}, at most {off.max():.1e}")
# [/states]
