# SPDX-License-Identifier: BSL-1.0
"""Reads out.h5 and out.npy, which `nysalt run` wrote: with Debian's python3-h5py, which brings NumPy."""
# [docs]
import json

import h5py
import numpy as np

with h5py.File("out.h5") as run:
    t = run["t"][:]
    energy = run["energy"]                  # trajectories x samples: on the disk, until it is asked for
    first = energy[0]                       # one trajectory
    at_the_end = energy[:, -1]              # one time
    is_whole = run["diverged_at"][:] == -1  # else the step at which it was lost, and NaN from there on
    omega = json.loads(run.attrs["system"])["omega"]
    print(f"{run.attrs['method']}, step {run.attrs['step']}, omega {omega}, seed {run.attrs['seed']}")

values = np.load("out.npy", mmap_mode="r")  # trajectories x samples x observables
with open("out.npy", "rb") as run:          # behind the numbers it says what they are
    run.seek(values.offset + values.nbytes)
    names = json.load(run)["observables"]
q1 = values[:, :, names.index("q1")]
print(f"mean energy {at_the_end[is_whole].mean():.3f} and q1 {np.nanmean(q1[:, -1]):.3f} at t = {t[-1]:.2f}")
# [/docs]

assert np.array_equal(first, values[0, :, names.index("energy")])
assert np.array_equal(at_the_end, values[:, -1, names.index("energy")])
