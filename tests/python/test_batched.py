# SPDX-License-Identifier: BSL-1.0
"""Functions over (trajectories, dimension): the same bits as one after the other, and one call a kick."""
import numpy as np
import pytest

import nysalt


def potential(q):
    return (0.5 * q**2 + 0.25 * q**4).sum(axis=-1)


def cubic(q):
    return -q - q**3


def starts(seed, n):
    rng = np.random.default_rng([seed, n])
    return rng.normal(0, 0.5, 3), rng.normal(0, 0.5, 3)


def system(force, batched, **bath):
    return nysalt.hamiltonian("wells", dimension=3, potential=potential, force=force, starts=starts, frequency=3.0,
                              inverse_mass=[1.0, 0.5, 2.0], batched=batched, **bath)


@pytest.mark.parametrize("method", ["verlet", "mclachlan5", "srkn6b", "srkn11b", "chin4a", "baoab", "obabo", "verlet@end"])
@pytest.mark.parametrize("steps", [1, 64, 100])
def test_bits_are_those_of_one_after_the_other(method, steps):
    is_in_bath = method in ("baoab", "obabo", "verlet@end")
    bath = dict(friction=0.7, temperature=0.4) if is_in_bath else {}
    q, p = system(cubic, False).starts(7)
    one = nysalt.integrate(system(cubic, False, **bath), method, 0.2, q, p, steps, seed=5)
    many = nysalt.integrate(system(cubic, True, **bath), method, 0.2, q, p, steps, seed=5)
    assert (one[0] == many[0]).all() and (one[1] == many[1]).all()
    assert not (one[0] == q).any()
    other = nysalt.integrate(system(cubic, True, **bath), method, 0.2, q, p, steps, seed=6)
    assert (other[1] == many[1]).any() != is_in_bath


def test_one_call_a_kick():
    shapes = []

    def counted(q):
        shapes.append(q.shape)
        return cubic(q)

    wells = system(counted, True)
    q, p = wells.starts(1000)
    shapes.clear()
    nysalt.integrate(wells, "srkn6b", 0.2, q, p, 10)
    assert shapes == [(1000, 3)] * 61


def test_one_that_is_lost_leaves_the_others():
    q, p = system(cubic, False).starts(5)
    q[2] *= 1e3  # far out the step is much too long
    one, many = (nysalt.integrate(system(cubic, batched), "verlet", 0.2, q, p, 200) for batched in (False, True))
    assert np.isnan(one[0][2]).all() and np.isnan(many[0][2]).all()
    kept = [0, 1, 3, 4]
    assert (one[0][kept] == many[0][kept]).all() and np.isfinite(many[1][kept]).all()


def test_a_wrong_shape_is_refused():
    q, p = system(cubic, False).starts(4)
    with pytest.raises(ValueError, match=r"force\(q\) must have the shape \(1, 3\)"):
        system(lambda q: cubic(q)[0], True)
    wells = system(lambda q: cubic(q)[:1], True)  # right for one trajectory alone
    with pytest.raises(ValueError, match=r"force\(q\) must have the shape \(4, 3\)"):
        nysalt.integrate(wells, "verlet", 0.1, q, p, 10)
    with pytest.raises(ZeroDivisionError):
        nysalt.integrate(system(lambda q: cubic(q) if len(q) == 1 else 1 / 0, True), "verlet", 0.1, q, p, 10)


def test_it_learns_as_the_plain_one():
    fits = [nysalt.learn(system(cubic, batched), "nystrom", step=0.3, horizon=3, trajectories=5,
                         effort="quick", loss="state:1").theta for batched in (False, True)]
    assert (fits[0] == fits[1]).all()
