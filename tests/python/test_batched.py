# SPDX-License-Identifier: BSL-1.0
"""Functions over (trajectories, dimension): the same bits as one after the other, and one call a kick."""
import numpy as np
import pytest

import nysalt


def potential(q):
    return (0.5 * q**2 + 0.25 * q**4).sum(axis=-1)


class Counted:
    def __init__(self):
        self.shapes = []

    def __call__(self, q):
        self.shapes.append(q.shape)
        return -q - q**3


def starts(seed, n):
    rng = np.random.default_rng([seed, n])
    return rng.normal(0, 0.5, 3), rng.normal(0, 0.5, 3)


def system(force, batched, **bath):
    return nysalt.hamiltonian("wells", dimension=3, potential=potential, force=force, starts=starts, frequency=3.0,
                              inverse_mass=[1.0, 0.5, 2.0], batched=batched, **bath)


@pytest.mark.parametrize("method", ["verlet", "mclachlan5", "srkn6b", "srkn11b", "chin4a"])
@pytest.mark.parametrize("steps", [1, 64, 100])
def test_bits_are_those_of_one_after_the_other(method, steps):
    q, p = system(lambda q: -q - q**3, False).starts(7)
    one = nysalt.integrate(system(lambda q: -q - q**3, False), method, 0.2, q, p, steps)
    many = nysalt.integrate(system(lambda q: -q - q**3, True), method, 0.2, q, p, steps)
    assert (one[0] == many[0]).all() and (one[1] == many[1]).all()
    assert not (one[0] == q).any()


@pytest.mark.parametrize("method", ["baoab", "obabo", "verlet@end"])
def test_bits_in_a_bath(method):
    bath = dict(friction=0.7, temperature=0.4)
    q, p = system(lambda q: -q - q**3, False).starts(6)
    one = nysalt.integrate(system(lambda q: -q - q**3, False, **bath), method, 0.2, q, p, 90, seed=5)
    many = nysalt.integrate(system(lambda q: -q - q**3, True, **bath), method, 0.2, q, p, 90, seed=5)
    assert (one[0] == many[0]).all() and (one[1] == many[1]).all()
    other = nysalt.integrate(system(lambda q: -q - q**3, True, **bath), method, 0.2, q, p, 90, seed=6)
    assert not (other[0] == many[0]).any()


def test_one_call_a_kick():
    force = Counted()
    wells = system(force, True)
    q, p = wells.starts(1000)
    force.shapes.clear()
    nysalt.integrate(wells, "srkn6b", 0.2, q, p, 10)
    assert force.shapes == [(1000, 3)] * 61


def test_one_that_is_lost_leaves_the_others():
    def strong(q):
        return -q - 4 * q**3

    def energies(q):
        return (0.5 * q**2 + q**4).sum(axis=-1)

    def made(batched):
        return nysalt.hamiltonian("strong", dimension=3, potential=energies, force=strong, starts=starts, frequency=3.0,
                                  batched=batched)

    q, p = made(False).starts(5)
    q[2] *= 1e3  # far out the step is much too long
    one = nysalt.integrate(made(False), "verlet", 0.2, q, p, 200)
    many = nysalt.integrate(made(True), "verlet", 0.2, q, p, 200)
    assert np.isnan(one[0][2]).all() and np.isnan(many[0][2]).all()
    kept = [0, 1, 3, 4]
    assert (one[0][kept] == many[0][kept]).all() and np.isfinite(many[1][kept]).all()


def test_a_wrong_shape_is_refused():
    q, p = system(lambda q: -q - q**3, False).starts(4)
    with pytest.raises(ValueError, match=r"force\(q\) must have the shape \(1, 3\)"):
        system(lambda q: (-q - q**3)[0], True)
    wells = system(lambda q: (-q - q**3)[:1], True)  # right for one trajectory alone
    with pytest.raises(ValueError, match=r"force\(q\) must have the shape \(4, 3\)"):
        nysalt.integrate(wells, "verlet", 0.1, q, p, 10)
    with pytest.raises(ZeroDivisionError):
        nysalt.integrate(system(lambda q: -q - q**3 if len(q) == 1 else 1 / 0, True), "verlet", 0.1, q, p, 10)


def test_it_learns_as_the_plain_one():
    fits = [nysalt.learn(system(lambda q: -q - q**3, batched), "nystrom", step=0.3, horizon=3, trajectories=5,
                         effort="quick", loss="state:1").theta for batched in (False, True)]
    assert (fits[0] == fits[1]).all()
