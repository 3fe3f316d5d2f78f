# SPDX-License-Identifier: BSL-1.0
"""The paper's chain, and what is learned, run and measured on it through the Python module."""
import functools
import json
import math

import nysalt
import numpy as np

from claims import Estimate, mean_of

OMEGA = 50.0
STATE = [f"{name}{i}" for name in "qp" for i in range(1, 7)]
GAP = 1e-4  # the paper's fine step: a step is `gap` times it


class Setting:
    """How much is computed (all, or if quick so little that everything runs once), from which seed, on how many threads."""
    quick = False
    seed = 1
    threads = None


def pick(whole, part):
    return part if Setting.quick else whole


@functools.lru_cache(maxsize=None)
def chain(frequency=OMEGA, spread=1.0):
    """Without a bath. The spread multiplies the deviation 1/omega of the starts."""
    return nysalt.system("fpu", omega=frequency, spread=spread)


def at(q, p, **surroundings):
    """The chain at given states; learning asks for starts that differ, by a spread that no printed digit shows."""
    states = [", ".join(f"{n}={x!r}" for n, x in zip(STATE, map(float, one))) for one in np.hstack([q, p])]
    return nysalt.system("fpu", omega=OMEGA, at=states, spread=1e-9, **surroundings)


def soft_starts(trajectories, role):
    """The chain at starts of which the soft springs hold omega^2, half of it moving and half of it stretched.

    The soft modes of the usual starts have x_0 = y_0 = 1; x_0 = omega^(1/2) and y_0 = omega/3^(1/2) move each coordinate by a
    constant.
    """
    q, p = chain().starts(trajectories, seed=Setting.seed, role=role)
    return at(q + (math.sqrt(OMEGA) - 1) / math.sqrt(2), p + (OMEGA / math.sqrt(3) - 1) / math.sqrt(2))


IN_BATH = {"friction": 0.01, "sigma": 0.05}  # the paper's
BATH = "--friction 0.01 --sigma 0.05"
ENSEMBLES = 20  # of the long trajectory, as many as there are repetitions


@functools.lru_cache(maxsize=None)
def long_trajectory():
    """q and p of ensembles of starts: the trajectory takes seconds to make."""
    return [np.split(x, ENSEMBLES) for x in bath("trajectory").starts(ENSEMBLES * 1024, seed=Setting.seed, role="training")]


@functools.lru_cache(maxsize=None)
def bath(start):
    """The chain in the paper's bath: with Gibbs starts, or with states of one long trajectory."""
    return nysalt.system("fpu", omega=OMEGA, start=start, **IN_BATH)


@functools.lru_cache(maxsize=None)
def to_learn_from(start, ensemble):
    """The same: from a long trajectory that is not made for each call, with other states in each ensemble."""
    if start == "gibbs":
        return bath(start)
    q, p = long_trajectory()
    return at(q[ensemble], p[ensemble], **IN_BATH)


@functools.lru_cache(maxsize=None)
def learned(system, step, *, trajectories=None, horizon=0.5, coordinates="qp", placement=None, fine_step=None, repetition=0):
    """The two-stage scheme of a step from M = 100 trajectories, the paper's for the chain without a bath."""
    return nysalt.learn(system, "nystrom", step=step, loss="state:1", random_starts=0, horizon=horizon,
                        trajectories=trajectories or pick(100, 10), coordinates=coordinates, placement=placement,
                        fine_step=fine_step, seed=Setting.seed + repetition, threads=Setting.threads)


def learned_in_bath(start, gap, *, trajectories=None, coordinates="qp", placement="end", repetition=0):
    """The paper's fits in the bath: M = 512, Ttr = 1, loss in q and p."""
    return learned(to_learn_from(start, repetition), gap * GAP, trajectories=trajectories or pick(512, 16), horizon=1.0,
                   coordinates=coordinates, placement=placement, fine_step=GAP, repetition=repetition)


def theta_of(scheme):
    """Parameters with their standard errors."""
    errors = [math.nan if e is None else e for e in scheme.standard_errors.values()]
    return [Estimate(*one) for one in zip(map(float, scheme.theta), errors)]


@functools.lru_cache(maxsize=None)
def two_stages(b1, beta1):
    """The member (b1, beta1) of the family as a composition A(c1) B(b1) A(c2 - c1) B(b2) A(1 - c2), equations (2.7-11)."""
    b2, c1 = 1 - b1, 1 - beta1 / b1
    c2 = 1 - (0.5 - beta1) / b2
    return nysalt.Table(json.dumps({"format": "nysalt table", "version": 1, "name": f"({b1}, {beta1})", "letters": "ABABA",
                                    "coefficients": [c1, b1, c2 - c1, b2, 1 - c2]}), f"({b1}, {beta1})")


def divided(step, most):
    """The largest step that divides `step` and is at most so long."""
    return step / math.ceil(step / most - 1e-9)  # of a whole number, rounding apart


def errors(system, methods, step, horizon, trajectories, metric="relative", fine_step=None, **how):
    """Errors of methods by name, and the document of the reference; infinite if more than half of the trajectories diverged, as
    the error of the others is that of a lucky few."""
    for name, method in methods.items():
        if not isinstance(method, str):
            method.name = name
    found = nysalt.compare(system, methods.values(), step, metric=metric, observable=None if metric == "state" else "stiff_energy",
                           horizon=horizon, trajectories=trajectories, force=True, seed=Setting.seed, threads=Setting.threads,
                           fine_step=fine_step and divided(step, fine_step), **how)
    result = {}
    for name, row in zip(methods, found["rows"], strict=True):
        lost = 2 * row["diverged"] > trajectories or not isinstance(row["error"], float)
        result[name] = Estimate(math.inf) if lost else Estimate(row["error"], row["standard_error"] or math.nan)
    return result, found["references"][0]


def follow(system, method, step, horizon, sample, trajectories, observables, *, repetition=0, **states):
    """Values (trajectories, samples, observables) at the times 0, sample, ...; NaN from where a trajectory diverged on."""
    return nysalt.run(system, method, step, horizon, trajectories=None if states else trajectories, observables=observables,
                      sample_every=round(sample / step), checks=False, force=True, threads=Setting.threads,
                      seed=Setting.seed + repetition, **states).values


def gain(ours, theirs):
    """Whether ours are below theirs, paired over trajectories, by more than two standard errors."""
    difference = mean_of(theirs - ours)
    return difference.mean > 2 * difference.error


def steps_text(gaps):
    """Gaps as steps of the command line."""
    return ",".join(f"{gap * GAP:g}" for gap in gaps)
