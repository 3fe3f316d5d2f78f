# SPDX-License-Identifier: BSL-1.0
"""Section 4: the harmonic oscillator q'' = -Omega q - gamma q', its optimal parameters, stability and order."""
import math

import numpy as np

from chain import GAP, OMEGA
from claims import Claim, Estimate, Exhibit, agrees, exponent

ANGLES = (0.1, 0.5, 1.0, 1.5, 2.0)
HALF_A_DIGIT = 5e-3  # of a number that is printed with two digits
WEIGHTS = "the weights of the loss"


def two_stages_of(theta, h, force, q, p, beta_sum=0.5):
    """One step of the scheme (2.7-8). beta1 + beta2 is 1/2, and 1 as the proposition of section 4.1 prints it."""
    b1, beta1 = theta
    b2, beta2 = 1 - b1, beta_sum - beta1
    c1, c2 = 1 - beta1 / b1, 1 - beta2 / b2
    l1 = force(q + h * c1 * p)
    l2 = force(q + h * c2 * p + h * h * b1 * (c2 - c1) * l1)
    return q + h * p + h * h * (beta1 * l1 + beta2 * l2), p + h * (b1 * l1 + b2 * l2)


def one_step(theta, h, Omega=1.0, beta_sum=0.5):
    """Its matrix."""
    return np.array(two_stages_of(theta, h, lambda q: -Omega * q, np.array([1.0, 0.0]), np.array([0.0, 1.0]), beta_sum))


def exact_step(h, Omega=1.0, gamma=0.0):
    """e^{A h} = e^{-gamma h/2} (cos(nu h) 1 + sin(nu h)/nu (A + gamma/2 1)), nu^2 = Omega - gamma^2/4 > 0."""
    nu = math.sqrt(Omega - 0.25 * gamma**2)
    A = np.array([[0.5 * gamma, 1.0], [-Omega, -0.5 * gamma]])
    return math.exp(-0.5 * gamma * h) * (math.cos(nu * h) * np.eye(2) + math.sin(nu * h) / nu * A)


def damping(h, gamma):
    return np.diag([1.0, math.exp(-gamma * h)])


def minimum(loss):
    """Near (1/2, 0.4), by Newton's method, halved while it leads uphill; the loss is analytic, and differentiated so."""
    tiny, d = 1e-30, 1e-5  # of a derivative without cancellation, and of the central difference of that: d^2 relative

    def gradient(x):
        return np.array([loss(x + 1j * tiny * e).imag / tiny for e in np.eye(2)])

    x = np.array([0.5, 0.4])
    for _ in range(100):
        hessian = np.array([(gradient(x + d * e) - gradient(x - d * e)) / (2 * d) for e in np.eye(2)])
        curvature, axes = np.linalg.eigh((hessian + hessian.T) / 2)
        change = -axes @ ((axes.T @ gradient(x)) / np.abs(curvature))
        change *= min(1.0, 0.05 / np.linalg.norm(change))
        for _ in range(10):
            if loss(x + change) <= loss(x):
                break
            change *= 0.5
        x = x + change
        if np.linalg.norm(change) < 1e-10:
            break
    return x


def optimum(h, Omega=1.0, gamma=0.0, weights=1.0):
    """Of the weighted squares of what a step, with O at its end, differs by from the flow; as it stands in the energy norm for
    omega = 1, with h in units of 1/omega."""
    return minimum(lambda theta: np.sum(weights * (damping(h, gamma) @ one_step(theta, h, Omega) - exact_step(h, Omega, gamma)) ** 2))


def optimum_in_bath(gap):
    """b1 and beta1 of the damped oscillator of the paper's bath, gamma = .01."""
    return optimum(gap * GAP * OMEGA, gamma=0.01 / OMEGA)


def printed_optimum(z, frequency):
    """Of Tr(E^T Sigma^-1 E) with Sigma = diag(1, Omega^2), as printed."""
    return optimum(z / frequency, frequency**2, weights=np.array([[1.0], [frequency**-4.0]]))


def optimum_in_units(frequency):
    """Of the energy norm at delta omega = 1, written in q and p."""
    return optimum(1 / frequency, frequency**2, weights=np.array([[1.0, frequency**2], [frequency**-2.0, 1.0]]))


def linear_optimum():
    def is_printed(theta):
        return agrees(Estimate(theta[0]), 0.5, 0.1) and agrees(Estimate(theta[1]), 0.40, 0.01)

    optima = {z: optimum(z) for z in ANGLES}
    energy, printed = optima[1.0], printed_optimum(1.0, OMEGA)
    by_energy = max(abs(optimum_in_units(other)[1] - energy[1]) for other in (1.0, 10.0, 50.0))
    as_printed = max(abs(printed_optimum(1.0, other)[1] - printed_optimum(1.0, 1.0)[1]) for other in (1.0, 10.0, 50.0))
    change = {most: max(abs(optima[z][1] - optima[0.1][1]) for z in ANGLES if z <= most) for most in (1.0, 2.0)}
    digit = "a change of half the last printed digit (.005) is none"
    return Exhibit(
        "Optimal parameters of the linear system", "Remark on optimal parameters, section 4.1",
        [Claim("b1* = 0.5, beta1* about 0.40", "the minimum at delta omega = 1 (omega = 50 for the printed Sigma)",
               f"energy norm {energy[0]:.5f}, {energy[1]:.5f}; printed Sigma {printed[0]:.5f}, {printed[1]:.5f}",
               {"the energy norm": is_printed(energy), "Sigma = diag(1, Omega^2) as printed": is_printed(printed)},
               "to the printed digits", WEIGHTS,
               "nysalt learn --system oscillator --loss state:1 --omega 50 --step 0.02 --coordinates energy"),
         Claim("the estimator is independent of Omega, because of the weight matrix Sigma",
               "largest change of beta1* from omega = 1 to 50 at delta omega = 1",
               f"energy norm {by_energy:.1e}; printed Sigma {as_printed:.4f}",
               {"the energy norm": by_energy <= HALF_A_DIGIT, "Sigma as printed": as_printed <= HALF_A_DIGIT},
               digit + ". diag(1, Omega^2) adds squares of different units", WEIGHTS),
         Claim("the minimisers appear to be independent of delta",
               "largest change of beta1* (energy norm) from delta omega = 0.1 on",
               f"{change[1.0]:.4f} up to 1, {change[2.0]:.4f} up to 2",
               {f"delta omega up to {most:g}": change[most] <= HALF_A_DIGIT for most in change}, digit, "how large the step is",
               "nysalt learn --system oscillator --loss state:1 --omega 50 --steps 0.01,0.02,0.03,0.04 --coordinates energy")],
        ["b1* is 1/2 by symmetry in the energy norm: exchanging the stages is b1 -> 1 - b1. beta1* tends to 0.403408 for "
         "small steps, the coefficient of McLachlan's method."],
        [("b1, beta1 at the minimum of the one-step error:",
          ["delta omega", "energy norm", "printed Sigma, omega = 1", "omega = 10", "omega = 50"],
          [[f"{z:g}", *(f"{x[0]:.4f}, {x[1]:.4f}" for x in (optima[z], *(printed_optimum(z, w) for w in (1.0, 10.0, 50.0))))]
           for z in ANGLES], 0)])


def order_with(beta_sum):
    """Of the error of (q, p) at time 1."""
    counts = [64, 128, 256, 512, 1024]
    errors = [np.linalg.norm(np.linalg.matrix_power(one_step((0.5, 0.4), 1 / n, 1.0, beta_sum), n) - exact_step(1.0))
              for n in counts]
    return exponent([1 / n for n in counts], errors)


def printed_constraint():
    printed, meant = order_with(1.0), order_with(0.5)
    return Exhibit(
        "The constraint on beta2", "Proposition on the linear system, section 4.1",
        [Claim("beta2 = 1 - beta1, of a method of second order", "order at time 1 for Omega = 1, (b1, beta1) = (0.5, 0.4)",
               f"{printed.mean:.3f} with beta2 = 1 - beta1, {meant.mean:.3f} with 1/2 - beta1", agrees(printed, 2.0, 0.2),
               "the order must be 2 to a tenth; beta1 + beta2 = 1/2 is what section 2 asks for, and is meant")])


def stable_windows(theta):
    """Of z^2: where the trace 2 - z^2 + c z^4 of a step, whose determinant is 1, lies within -2 .. 2."""
    c = (np.trace(one_step(theta, 2.0)) + 2.0) / 16.0  # of z = 2: the trace is 2 - 4 + 16 c
    edges = [0.0, *(r.real for side in (-2.0, 2.0) for r in np.roots([c, -1.0, 2.0 - side]) if r.imag == 0 and r.real > 1e-9)]
    edges.sort()
    windows = []
    for low, high in zip(edges, edges[1:]):
        touches = high - low <= 1e-6 * high  # a double root, split by rounding: the trace turns back at +-2
        if touches or abs(2 - 0.5 * (low + high) + 0.25 * c * (low + high) ** 2) < 2:
            joined = bool(windows) and windows[-1][1] == low
            windows[-1:] = [(windows[-1][0], high)] if joined else [*windows[-1:], (low, high)]
    return windows


def limit_of(theta):
    """The end of the first window of delta omega."""
    return math.sqrt(stable_windows(theta)[0][1])


def linear_stability():
    windows = stable_windows((0.5, 0.4))
    limit, verlet = limit_of((0.5, 0.4)), limit_of((0.5, 0.5))
    values = np.linalg.eigvals([one_step((0.5, 0.4), math.sqrt(z2)) for z2 in 20 * (np.arange(2000) + 0.5) / 2000])
    wrong = np.mean((values.real.max(1) <= 1 + 1e-9) & (np.abs(values).max(1) > 1 + 1e-6))  # rounding; of a double root its root
    command = "nysalt stability --family nystrom --parameters 0.5,0.4"

    return Exhibit(
        "Largest step of linear stability", "Remark on linear stability, section 4.1",
        [Claim("stable for delta <= sqrt(20/3)/omega at (0.5, 0.40)", "end of the first window of delta omega",
               f"{limit:.10f}; sqrt(20/3) = {math.sqrt(20 / 3):.10f}", math.isclose(limit, math.sqrt(20 / 3)), "to nine digits",
               command=command),
         Claim("sqrt(5/3) times the limit of Verlet", "ratio of the limits", f"{limit / verlet:.10f}",
               math.isclose(limit / verlet, math.sqrt(5 / 3)), "to nine digits", command=command),
         Claim("a second window 10 <= z <= 50/3 of z = delta^2 Omega", "the second window of z",
               f"{windows[1][0]:.8f} .. {windows[1][1]:.8f}", math.isclose(windows[1][0], 10.0) and math.isclose(windows[1][1], 50 / 3),
               "to nine digits", command=command),
         Claim("stable while the real parts of the eigenvalues are at most 1",
               "part of 0 < z < 20 that this calls stable and |lambda| <= 1 does not", f"{wrong:.3f}", bool(wrong == 0),
               "it must be none; between 20/3 and 10 one eigenvalue is below -1"),
         Claim("the largest step of linear stability is enlarged", "limit over that of Verlet, a step and an evaluation",
               f"{limit / verlet:.4f} and {0.5 * limit / verlet:.4f}",
               {"a step": limit > verlet, "a force evaluation": 0.5 * limit > verlet}, "",
               "what is counted: a step takes two force evaluations, one of Verlet one", "nysalt stability --method verlet")])


def slope_of_optimum(z, symmetric):
    """d beta1*/d(gamma/(Omega delta)) at b1 = 1/2 and gamma -> 0, with O at the end of the step or half of it at each end."""
    def beta1(gamma):
        before, behind = (damping(part * z, gamma) for part in ((0.5, 0.5) if symmetric else (0.0, 1.0)))

        def loss(theta):  # b1 is kept
            off = behind @ one_step((0.5, theta[1]), z) @ before - exact_step(z, 1.0, gamma)
            return np.sum(off**2) + z**6 * (theta[0] - 0.5) ** 2

        return minimum(loss)[1]

    g = 3e-4 * z
    return (4 * beta1(g) - beta1(2 * g) - 3 * beta1(0.0)) / (2 * g) * z


def linear_langevin_optimum():
    """See docs/theory-langevin-optimum.md."""
    end = {z: slope_of_optimum(z, False) for z in (0.2, 0.5, 1.0, 2.0)}
    return Exhibit(
        "Optimal parameters of the linear Langevin system", "Remark on optimal parameters, section 4.2",
        [Claim("beta1* about 0.40 - 0.43 gamma/(Omega delta)",
               "d beta1*/d(gamma/(Omega delta)) at b1 = 1/2, gamma -> 0, energy norm",
               f"{end[0.2]:.4f}, {end[1.0]:.4f} and {end[2.0]:.4f} at delta omega = 0.2, 1 and 2",
               {name: agrees(Estimate(end[z]), -0.43, 0.01) for name, z in (
                   ("small steps (delta omega = 0.2)", 0.2), ("delta omega = 1", 1.0), ("delta omega = 2", 2.0))}, "to the printed digits",
               "the step: the remark expands in it")],
        ["The slope is of the placement, not of the system: with half of the bath before the step and half behind there is "
         "none. In the setting of section 5.3 the shift is below 0.0005."],
        [("The slope:", ["delta omega", "O at the end, as in the paper", "O symmetric"],
          [[f"{z:g}", f"{end[z]:.4f}", f"{slope_of_optimum(z, True):.4f}"] for z in end], 0)])


def one_step_noise(h, gamma):
    """Root mean squares, of q and of p, of what the exact noise of a step, sigma int e^{A s} (0, dW), has beyond the
    scheme's (0, sigma int e^{-gamma s} dW) on the same path, for sigma = 1; by Simpson's rule."""
    pieces = 200
    weights = np.ones(pieces + 1)
    weights[1:-1:2], weights[2:-1:2] = 4, 2
    exact = np.array([exact_step(h * i / pieces, 1.0, gamma)[:, 1] for i in range(pieces + 1)])
    exact[:, 1] -= np.exp(-gamma * h * np.arange(pieces + 1) / pieces)
    return np.sqrt(weights @ exact**2 * h / pieces / 3)


def linear_langevin_order():
    gamma = 0.5
    steps = [0.02 / 2**k for k in range(5)]
    noise = np.array([one_step_noise(h, gamma) for h in steps])
    # From a state of covariance diag(1, 1) kT with kT = sigma^2/(2 gamma), sigma = 1.
    of_states = [np.linalg.norm(damping(h, gamma) @ one_step((0.5, 0.4), h) - exact_step(h, 1.0, gamma)) / (2 * gamma) ** 0.5
                 for h in steps]
    order = exponent(steps, np.hypot(of_states, np.hypot(*noise.T)))
    return Exhibit(
        "Local strong order of the linear Langevin scheme", "Remark on the order, section 4.2",
        [Claim("the local strong order is 1.5", "exponent of the root mean square error of one step, Omega = 1, gamma = 0.5",
               f"{order.mean:.3f} (noise of q only {exponent(steps, noise[:, 0]).mean:.3f}, of p only "
               f"{exponent(steps, noise[:, 1]).mean:.3f})", agrees(order, 1.5, 0.1),
               "to the printed digits; the covariance of the noise is integrated, no sampling")],
        ["Globally this is the strong order 1: errors of independent steps add up as a root."])


EXHIBITS = (linear_optimum, printed_constraint, linear_stability, linear_langevin_optimum, linear_langevin_order)
