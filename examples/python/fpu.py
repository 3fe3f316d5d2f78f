# SPDX-License-Identifier: BSL-1.0
"""Learns a method for the stiff Fermi-Pasta-Ulam chain, compares it at equal cost, and runs it."""
# [readme]
import nysalt

chain = nysalt.system("fpu", omega=50)
scheme = nysalt.learn(chain, "nystrom", step=0.02, loss="state:1")  # the paper's loss
print(scheme.parameters, "usable" if scheme.usable else scheme.reason)
scheme.save("scheme.json")  # nysalt run --method scheme.json takes it, too

found = nysalt.compare(chain, ["verlet", "bcss2", scheme], steps=0.01, equal_cost=True, trajectories=100)
for row in found["rows"]:
    print(f"{row['method']:<14} {row['evaluations_per_time']:.0f} evaluations, error {row['error']:.2e}")
# [/readme]

run = nysalt.run(chain, scheme, step=0.02, horizon=100, trajectories=8, sample_every=50)
energy = run["stiff_energy"]  # trajectories x samples
print(f"stiff energy at t = {run.t[-1]:g}: {energy[:, -1].mean():.3f}, at the start {energy[:, 0].mean():.3f}")
