#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Time of an ensemble of 1000 trajectories through a force of NumPy, over that of the same arithmetic in bare NumPy.

usage: PYTHONPATH=build/release/python bench/batched_force.py
"""
import statistics
import time

import numpy as np

import nysalt

COUNT, STEPS = 1000, 200


def potential(q):
    return (0.5 * q**2 + 0.25 * q**4).sum(axis=1)


def force(q):
    return -q - q**3


def bare(letters, coefficients, h, q, p, steps):
    """The word in NumPy, first and last letters joined."""
    q, p = q.copy(), p.copy()
    f = None
    for _ in range(steps):
        for letter, c in zip(letters, coefficients):
            if letter == "A":
                q += c * h * p
                f = None
            else:
                f = force(q) if f is None else f
                p += c * h * f
    return q, p


def seconds(work):
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def main():
    print("| degrees of freedom | method | time of bare NumPy |\n|---|---|---|")
    for dimension in (3, 30, 300):
        def starts(seed, n):
            rng = np.random.default_rng([seed, n])
            return rng.normal(0, 0.5, dimension), rng.normal(0, 0.5, dimension)

        system = nysalt.hamiltonian("wells", dimension=dimension, potential=potential, force=force, starts=starts,
                                    frequency=2.0, batched=True)
        q, p = system.starts(COUNT)
        for method, letters, coefficients in (("verlet", "BAB", (0.5, 1.0, 0.5)),
                                              ("mclachlan2v", "BABAB", (0.1931833275037836, 0.5, 0.6136333449924328, 0.5,
                                                                        0.1931833275037836))):
            ours = nysalt.integrate(system, method, 0.05, q, p, STEPS)
            theirs = bare(letters, coefficients, 0.05, q, p, STEPS)
            assert np.abs(ours[0] - theirs[0]).max() < 1e-11
            ratios = [seconds(lambda: nysalt.integrate(system, method, 0.05, q, p, STEPS)) /
                      seconds(lambda: bare(letters, coefficients, 0.05, q, p, STEPS)) for _ in range(15)]
            low, middle, high = (statistics.quantiles(ratios, n=20)[k] for k in (0, 9, 18))
            print(f"| {dimension} | {method} | {middle:.2f} ({low:.2f} to {high:.2f}) |", flush=True)


if __name__ == "__main__":
    main()
