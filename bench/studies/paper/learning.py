# SPDX-License-Identifier: BSL-1.0
"""What is learned on the chain, sections 5.2 and 5.3: from three generators, against omega, the step and the amount of data."""
import functools
import math

import nysalt
import numpy as np

from chain import BATH, GAP, OMEGA, STATE, Setting, chain, follow, learned, learned_in_bath, pick, theta_of, two_stages
from claims import Claim, Estimate, Exhibit, agrees, exponent, mean_of
from linear import optimum, optimum_in_bath, two_stages_of
from pages import Curve, Panel

CLOSE = 0.01  # where the paper calls parameters close
PRINTED = {1: (0.499, 0.403), 5: (0.500, 0.403), 10: (0.499, 0.402)}  # table 1: b1 and beta1 by the step in .001
DIRECTIONS = np.array([[1.0, 0.5], [0.0, 1.0]])  # of b1 and beta1: along the first a small step hardly changes


def force(q):
    """Of the chain, equation (5.1): soft quartic springs and stiff linear ones in turn."""
    bonds = np.diff(q, axis=-1, prepend=0, append=0)
    pull = np.where(np.arange(7) % 2, 0.5 * OMEGA**2 * bonds, 4 * bonds**3)
    return np.diff(pull, axis=-1)


def in_modes(x):
    """The sums and differences over the stiff springs, of q and of p."""
    return np.concatenate([x[..., 1::2] + x[..., ::2], x[..., 1::2] - x[..., ::2]], axis=-1) / math.sqrt(2)


def fitted(states, step, coordinates):
    """b1 and beta1 of least weighted squares over steps, and standard errors by the jackknife over trajectories.

    states: (trajectories, times, 12), one step apart; each coordinate is weighted with its mean square increment, (3.5).
    """
    start, finish = states[:, :-1], states[:, 1:]
    change = {"qp": lambda x: x, "modes": in_modes}[coordinates]
    increments = np.sum(change(finish - start) ** 2, axis=1)  # by trajectory and coordinate, as all sums below

    def gradients(theta):
        """Of half the squares, along DIRECTIONS; the derivatives of the step are analytic, without differences."""
        ends = [np.concatenate(two_stages_of(theta + 1e-30j * e, step, force, start[..., :6], start[..., 6:]), axis=-1)
                for e in DIRECTIONS]
        residual = change(ends[0].real - finish)
        return np.stack([np.sum(change(end.imag) / 1e-30 * residual, axis=1) for end in ends], axis=-1)

    def newton(slopes, curvatures, sizes):
        return np.linalg.solve(np.tensordot(1 / sizes, curvatures, 1), (1 / sizes) @ slopes) @ DIRECTIONS

    theta, d = np.array([0.5, 0.4034]), 1e-5  # the second derivatives are wanted to d^2 relative
    for _ in range(20):
        slopes = gradients(theta)
        curvatures = np.stack([(gradients(theta + d * e) - gradients(theta - d * e)) / (2 * d) for e in DIRECTIONS], axis=-1)
        last = newton(slopes.sum(0), curvatures.sum(0), increments.sum(0))
        theta = theta - last
        if np.linalg.norm(last) < 1e-10:
            break
    without = [newton(slopes.sum(0) - s, curvatures.sum(0) - c, increments.sum(0) - i)
               for s, c, i in zip(slopes, curvatures, increments)]
    error = np.std(without, axis=0) * math.sqrt(len(without) - 1)
    return [Estimate(*one) for one in zip(map(float, theta), map(float, error))]


def table_1():
    h, generators = pick(1e-6, 1e-4), ((2 / 3, 1 / 3), (1 / 3, 1 / 3), (1 / 2, 1 / 2))
    q, p = chain().starts(pick(100, 10), seed=Setting.seed, role="training")
    data = [follow(nysalt.system("fpu", omega=OMEGA), two_stages(*one), h, 1.0, 1e-3, None, STATE, q=q, p=p) for one in generators]
    rows, ours, holds, between = [], [], {}, 0.0
    for coordinates, training in (("qp", 500), ("qp", 1000), ("modes", 500), ("modes", 1000)):
        name = f"{'(q, p)' if coordinates == 'qp' else coordinates}, Ttr = {'1/2' if training == 500 else '1'}"
        of_rows = []
        for factor, printed in PRINTED.items():
            fits = [fitted(one[:, :training + 1:factor], factor * 1e-3, coordinates) for one in data]
            between = max(between, *(abs(a.mean - b.mean) for fit in fits for a, b in zip(fit, fits[0])))
            of_rows.append(fits[0])
            rows.append([name, 1000 * factor, f"{printed[0]:.3f}", fits[0][0], f"{printed[1]:.3f}", fits[0][1]])
        # Rounded or cut off: within one unit of the last printed digit.
        holds[name] = all(agrees(a, b, 2e-3) for fit, row in zip(of_rows, PRINTED.values()) for a, b in zip(fit, row))
        ours.append(f"{name}: " + ", ".join(f"({b1.mean:.4f}, {beta1.mean:.4f})" for b1, beta1 in of_rows))
    return Exhibit(
        "Table 1: robustness to the data generator", "Table 1, section 5.2",
        [Claim("(b1, beta1) = (.499, .403), (.500, .403), (.499, .402) at gaps 1000, 5000 and 10000",
               "the same, from M = 100 trajectories by generators with h = 1e-6", "; ".join(ours), holds,
               "each number, rounded or cut off, within a unit of its last digit and two standard errors. The text says "
               "Ttr = 1/2, and not which coordinates", "the coordinates of the loss and the training time",
               "nysalt learn --system fpu --loss state:1 --step 0.01 --trajectories 100 --horizon 1 --coordinates modes"),
         Claim("the parameters are the same for three generators",
               "largest difference between generators, all rows and readings", f"{between:.1e}", between < 5e-4,
               "below half the last printed digit")],
        [f"The generators are the members (2/3, 1/3), (1/3, 1/3) and (1/2, 1/2); h = {h:g}."],
        [("From the generator (2/3, 1/3); errors are those of the fit:",
          ["loss and training time", "gap", "b1, printed", "b1, ours", "beta1, printed", "beta1, ours"], rows, 1)])


def distance_from(linear, theta):
    return max(abs(theta[k].mean - linear[k]) for k in (0, 1))


def curves_of(thetas, x, k):
    """Parameter k against x, by label; the first is bold."""
    return [Curve(label, x, [t[k].mean for t in all_of_it], [t[k].error for t in all_of_it], bold=label == next(iter(thetas)))
            for label, all_of_it in thetas.items()]


def parameters_against_omega():
    omegas = pick([2, 4, 8, 10, 20, 30, 40, 50, 60, 70, 80, 90, 100], [2, 50])
    theta = {c: [theta_of(learned(chain(float(w)), 1 / w, coordinates=c)) for w in omegas] for c in ("qp", "modes")}
    linear = (0.5, optimum(1.0)[1])
    farthest = {c: max(distance_from(linear, t) for w, t in zip(omegas, theta[c]) if w >= 30) for c in theta}
    panels = [Panel(name, "omega", name, [*curves_of({f"loss in {c}": theta[c] for c in theta}, omegas, k),
                                          Curve("linear system", omegas, [linear[k]] * len(omegas))], "x")
              for k, name in enumerate(("b1", "beta1"))]
    return Exhibit(
        "Optimal parameters against the stiffness", "Figure 2 (left), section 5.2",
        [Claim("for omega >= 30 the parameters are close to those of the linear system",
               f"largest distance of b1 and beta1 from (0.5, {linear[1]:.4f})",
               f"{farthest['qp']:.4f} in (q, p), {farthest['modes']:.4f} in the modes",
               {"a loss in (q, p)": farthest["qp"] <= CLOSE, "a loss in the modes": farthest["modes"] <= CLOSE},
               "close: to a hundredth", "the coordinates of the loss",
               "nysalt learn --system fpu --loss state:1 --omega 50 --step 0.02 --coordinates modes")],
        ["M = 100 trajectories over Ttr = 1/2, delta = 1/omega."],
        [("Learned parameters with the errors of the fit:",
          ["omega", "b1, (q, p)", "beta1, (q, p)", "b1, modes", "beta1, modes"],
          [[w, *a, *b] for w, a, b in zip(omegas, theta["qp"], theta["modes"])], 0)],
        [("parameters_against_omega", panels, (1100, 460), "Learned parameters against omega at delta = 1/omega, and those "
          "of the linear system (energy norm).")])


def convergence(fit, powers, repetitions, printed, name):
    """Of estimators from M = 2^least .. 2^most trajectories to one of 2^(most + 1): from other data, and from data that
    hold those of the smaller ones, as trajectories are numbered. Returns claims, tables and figures, and the errors."""
    def theta(power, repetition):
        return fit(trajectories=2**power, repetition=repetition).theta

    others, nested = np.zeros((2, len(powers), repetitions))
    for r in range(repetitions):
        own, other = theta(powers[-1] + 1, 2 * r), theta(powers[-1] + 1, 2 * r + 1)
        for k, power in enumerate(powers):
            found = theta(power, 2 * r)
            nested[k, r], others[k, r] = np.abs(found - own).mean(), np.abs(found - other).mean()
    sizes = [2**power for power in powers]
    slopes = [mean_of([exponent(sizes, e[:, r]).mean for r in range(repetitions)]) for e in (others, nested)]
    errors = [[mean_of(one) for one in e] for e in (others, nested)]
    labels = ("reference from other data", "reference from the same data and more")
    claim = Claim(
        f"the error of the estimators decays as M^{printed}", "exponent, mean over repetitions with its error",
        f"{slopes[0]} with a reference from other data, {slopes[1]} with one from the same data and more",
        {"a reference estimator from other data": agrees(slopes[0], printed, 0.01),
         "one from the same data and more": agrees(slopes[1], printed, 0.01)},
        "within two standard errors and half the last digit. An exact reference would give -0.5; one with an error of its own "
        "flattens the end of the curve, and one that shares the data steepens it", "whether the reference estimator shares the data")
    table = ("Mean over repetitions of (|b1 - b1'| + |beta1 - beta1'|)/2:", ["M", *(f"error, {label}" for label in labels)],
             [[m, *row] for m, *row in zip(sizes, *errors)], 0)
    curves = [Curve(label, sizes, [e.mean for e in one], [e.error for e in one], bold=one is errors[0])
              for label, one in zip(labels, errors)]
    figure = (f"convergence_in_M_{name}", [Panel("", "M", "mean error of b1 and beta1", curves, "xy")], (700, 520),
              "Error of the estimators against the number of trajectories.")
    return claim, table, figure, errors[0]


def convergence_in_trajectories():
    claim, table, figure, errors = convergence(functools.partial(learned, chain(), 1 / OMEGA), range(1, pick(8, 3) + 1),
                                               pick(30, 2), -0.45, "deterministic")
    command = "nysalt learn --system fpu --loss state:1 --step 0.02 --trajectories "
    claim.command = command + "256"
    first = errors[0]
    return Exhibit("Convergence of the estimators in the number of trajectories", "Figure 2 (right), section 5.2",
                   [claim, Claim("with M = 2 the error is below 1e-3", "mean error of (b1 + beta1)/2 at M = 2", str(first),
                                 first.mean - 2 * first.error < 1e-3, "below 1e-3 within two standard errors",
                                 command=command + "2")], tables=[table], figures=[figure])


LEARN_IN_BATH = f"nysalt learn --system fpu {BATH} --start trajectory --placement end --trajectories 512 --horizon 1 --step 0.02"


def convergence_in_bath():
    fit = functools.partial(learned_in_bath, "trajectory", 0.02 / GAP)
    claim, table, figure, errors = convergence(fit, range(2, pick(9, 4) + 1), pick(10, 2), -0.44, "langevin")
    claim.command, last = LEARN_IN_BATH, errors[-1]
    return Exhibit("Convergence of the estimators in a bath", "Figure 5 (left), section 5.3",
                   [claim, Claim("with M = 512 the errors are below 1e-2", "mean error at the largest M", str(last),
                                 last.mean - 2 * last.error < 1e-2, "below 1e-2 within two standard errors", command=LEARN_IN_BATH)],
                   tables=[table], figures=[figure])


def parameters_against_gap():
    gaps, repetitions = pick([10, 30, 50, 70, 100, 150, 190, 250, 330, 390, 450], [190]), pick(10, 2)
    cases = {"(q, p), one long trajectory": ("trajectory", "qp"), "(q, p), Gibbs starts": ("gibbs", "qp"),
             "modes, Gibbs starts": ("gibbs", "modes")}

    def scatter(gap, start, coordinates):
        """Mean and standard deviation of both parameters over repetitions: what the paper draws as a bar."""
        count = repetitions if gap >= 50 else min(repetitions, 3)  # small gaps have many pairs: slow, with little scatter
        found = [learned_in_bath(start, gap, coordinates=coordinates, repetition=r).theta for r in range(count)]
        return [Estimate(float(x.mean()), float(x.std(ddof=1))) for x in np.transpose(found)]

    theta = {name: [scatter(gap, *case) for gap in gaps] for name, case in cases.items()}
    linear = [optimum_in_bath(gap) for gap in gaps]
    farthest = {name: max(map(distance_from, linear, all_of_it)) for name, all_of_it in theta.items()}
    widest = {name: max(one.error for pair in all_of_it for one in pair) for name, all_of_it in theta.items()}
    panels = [Panel(name, "gap", name, [*curves_of(theta, gaps, k), Curve("linear system", gaps, [x[k] for x in linear])], "x")
              for k, name in enumerate(("b1", "beta1"))]

    def claim(text, quantity, sizes, rule):
        return Claim(text, quantity, ", ".join(f"{size:.4f} ({name})" for name, size in sizes.items()),
                     {name: size <= CLOSE for name, size in sizes.items()}, rule,
                     "the coordinates of the loss and the starts", LEARN_IN_BATH)

    return Exhibit(
        "Optimal parameters against the gap, in a bath", "Figure 5 (right), section 5.3",
        [claim("the mean of both estimators is close to the optimum of the linear Langevin system",
               "largest distance of the mean of b1 and beta1 from it over all gaps", farthest, "close: to a hundredth"),
         claim("the error bar is barely noticeable", "largest standard deviation over repetitions", widest,
               "at most a hundredth")],
        [f"M = {pick(512, 16)} trajectories over Ttr = 1 by BAOAB with h = 1e-4, {repetitions} repetitions (3 below gap 50); "
         "O at the end."],
        [("Mean and standard deviation over the repetitions:",
          ["gap", "linear b1, beta1", *(f"{k}, {name}" for name in theta for k in ("b1", "beta1"))],
          [[gap, f"{linear[i][0]:.4f}, {linear[i][1]:.4f}", *(x for one in theta.values() for x in one[i])]
           for i, gap in enumerate(gaps)], 0)],
        [("parameters_against_gap", panels, (1100, 480), "Learned parameters in the bath against the gap; bars are the "
          "standard deviation over repetitions.")])
