# SPDX-License-Identifier: BSL-1.0
"""A Hamiltonian by functions of Python: the theta of the compiled one, what goes wrong in functions, and functions over
many trajectories, which give the bits of one after the other."""
import gc
import math
import traceback
import warnings
import weakref

import numpy as np
import pytest

import nysalt
from conftest import henon_heiles_by_functions

LEARNING = dict(family="nystrom", step=0.4, horizon=4, trajectories=10, fine_step=0.05, loss="state:1", random_starts=0)


def test_it_learns_the_theta_of_the_compiled_one():
    compiled = nysalt.learn(nysalt.system("henon_heiles"), **LEARNING)
    mine = nysalt.learn(henon_heiles_by_functions(), **LEARNING)
    fit = compiled.fit["fits"][0]
    assert mine.fit["fits"][0]["samples"] == fit["samples"] and mine.usable == compiled.usable
    # The functions have the operations of the compiled force, so that data and loss are the same to the bit.
    # Derivatives by theta are differences, wrong by eps^(2/3) of their size: theta, where they make the gradient
    # vanish, is off by that times residual/slope (standard error times root of samples) times the condition. A
    # hundredth of theta stands for the standard error, which ten trajectories do not tell.
    share = np.finfo(float).eps ** (2 / 3) * fit["condition"] * fit["samples"] ** 0.5
    assert set(compiled.standard_errors.values()) == {None} and "rest on" in fit["standard_errors_withheld"]
    tolerance = share * 0.01 * compiled.theta
    assert (abs(mine.theta - compiled.theta) <= tolerance).all()
    assert mine.loss == pytest.approx(compiled.loss, rel=1e-12)  # of second order there; rounding of its sum
    other = nysalt.learn(henon_heiles_by_functions("another", cubic=1.5), **LEARNING)
    assert (abs(other.theta - compiled.theta) > tolerance).any()


def test_it_runs_and_is_stepped_with_the_bits_of_the_compiled_one():
    mine, compiled = henon_heiles_by_functions(), nysalt.system("henon_heiles")
    asked = dict(method="srkn6b", step=0.3, horizon=6, trajectories=3, observables=["energy", "q1", "p2"])
    found = nysalt.run(mine, **asked)
    assert np.array_equal(found.values, nysalt.run(compiled, **asked).values)
    q, p = compiled.starts(3)
    assert np.array_equal(nysalt.integrate(mine, "verlet", 0.1, q, p, 40),
                          nysalt.integrate(compiled, "verlet", 0.1, q, p, 40))
    assert np.array_equal(mine.force(q), compiled.force(q))
    other = henon_heiles_by_functions("another", cubic=1.5)
    assert not np.array_equal(nysalt.run(other, **asked).values, found.values)


def test_it_is_compared_as_the_compiled_one_is():
    asked = dict(methods=["verlet", "srkn6b"], steps=[0.2], horizon=2, trajectories=4, metric=["state", "energy"],
                 fine_step=0.05)
    mine = nysalt.compare(henon_heiles_by_functions(), **asked)["rows"]
    compiled = nysalt.compare(nysalt.system("henon_heiles"), **asked)["rows"]
    for a, b in zip(mine, compiled):
        assert a["evaluations_per_time"] == b["evaluations_per_time"]
        if a["metric"] == "energy":  # the state is measured in modes where they are known
            assert a["error"] == pytest.approx(b["error"], rel=1e-9)  # the potential rounds in another order
    by_method = {row["method"]: row["error"] for row in mine if row["metric"] == "state"}
    assert by_method["srkn6b"] < by_method["verlet"]


def test_a_scheme_is_of_the_name(tmp_path):
    scheme = nysalt.learn(henon_heiles_by_functions("mine"), **LEARNING)
    scheme.save(tmp_path / "mine.json")
    again = henon_heiles_by_functions("mine")
    loaded = nysalt.load(tmp_path / "mine.json")
    assert np.array_equal(nysalt.run(again, loaded, 0.4, 4).values, nysalt.run(again, scheme, 0.4, 4).values)
    with pytest.raises(ValueError, match="must run on mine, for which it was learned, got yours"):
        nysalt.run(henon_heiles_by_functions("yours"), loaded, 0.4, 4)


@pytest.mark.parametrize("after", [0, 1500])
def test_what_a_function_raises_comes_through(after):
    calls = []

    def raises(q):
        calls.append(1)
        if len(calls) > after:
            raise ZeroDivisionError("the mass is zero")
        x, y = q
        return -x - x * y * 2, -y - x * x + y * y

    with pytest.raises(ZeroDivisionError, match="the mass is zero") as caught:
        nysalt.learn(henon_heiles_by_functions(force=raises), **LEARNING)
    assert any(frame.name == "raises" for frame in traceback.extract_tb(caught.value.__traceback__))
    assert len(calls) == after + 1  # no further call


@pytest.mark.parametrize("change, sentence", [
    (dict(force=lambda q: [1.0, 2.0, 3.0]), r"force\(q\) must have the shape \(2,\), got \(3,\)"),
    (dict(force=lambda q: 1.0), r"force\(q\) must have the shape \(2,\), got \(\)"),
    (dict(force=lambda q: None), r"force\(q\) must return numbers, got None; end it with a return"),
    (dict(force=lambda q: "two numbers"), r"force\(q\) must hold real numbers, got text"),
    (dict(force=lambda q: q), "the force is not -grad V: coordinate [12] is off"),
    (dict(potential=lambda q: "deep"), r"potential\(q\) must hold real numbers, got text"),
    (dict(potential=lambda q: None), r"potential\(q\) must return a number, got None; end it with a return"),
    (dict(potential=lambda q: 0.5 * q**2), r"potential\(q\) must be one number, got the shape \(2,\)"),
    (dict(starts=lambda seed, n: ([0.1], [0.0, 0.0])), r"q of starts\(seed, n\) must have the shape \(2,\), got \(1,\)"),
    (dict(starts=lambda seed, n: 1), r"starts\(seed, n\) must be a pair \(q, p\), got 1"),
    (dict(starts=lambda seed, n: ([np.nan, 0.1], [0.0, 0.0])), "q1 is nan"),
    (dict(force=3), "force must be a function, got 3"),
    (dict(inverse_mass=[1, 1, 1]), "inverse_mass must be one number or 2, got 3"),
    (dict(inverse_mass=-1), "inverse_mass must be positive, got -1"),
    (dict(dimension=0), "dimension must be at least 1, got 0"),
    (dict(dimension=10**7 + 1), "dimension must be at most 10000000, or states do not fit into memory, got 10000001"),
    (dict(dimension=2**62), "dimension must be at most 10000000, .*, got 4611686018427387904"),
    (dict(dimension=10**30), "dimension must be a whole number that can be counted"),
    (dict(friction=0.1), "friction must come with sigma or temperature"),
    (dict(name=""), "a Hamiltonian must have a name"),
    (dict(name="two\nlines"), r"must be one line that can be printed, got 'two\\nlines'"),
    (dict(name="a\x1b[2J"), "must be one line that can be printed"),
])
def test_what_is_no_hamiltonian_is_told_in_a_sentence(change, sentence):
    sound = dict(name="springs", dimension=2, potential=lambda q: 0.5 * (q @ q), force=lambda q: -q,
                 starts=lambda seed, n: np.random.default_rng([seed, n]).normal(size=(2, 2)))
    assert nysalt.hamiltonian(**sound).highest_frequency == pytest.approx(1, rel=0.02)  # known to 1 %
    with pytest.raises(ValueError, match=sentence) as caught:
        nysalt.hamiltonian(**{**sound, **change})
    assert "\n" not in str(caught.value)


class Springs:
    """Holds a system that holds it."""

    def __init__(self):
        self.system = nysalt.hamiltonian("springs", dimension=2, potential=lambda q: self.force(q) @ q / -2, force=self.force,
                                         frequency=1, starts=lambda seed, n: np.random.default_rng([seed, n]).normal(size=(2, 2)))

    def force(self, q):
        return -q


def test_where_a_force_overflows_a_trajectory_diverges():
    def of(force):
        return nysalt.hamiltonian("cosh", dimension=1, potential=lambda q: math.cosh(q[0]) - 1, force=force,
                                  starts=lambda seed, n: ([1.5], [0.1 + n % 7 / 100]), frequency=2)

    overflows = []

    def sinh(q):
        try:
            return [-math.sinh(q[0])]
        except OverflowError:  # beyond q = 710
            overflows.append(q[0])
            raise

    found = nysalt.judge(of(sinh), "verlet", 3.0)  # linearly stable up to 2, and less far out
    assert found["verdict"] == "unstable" and found["diverged"] > 0 and overflows

    def with_a_mistake(q):
        if abs(q[0]) > 5:
            raise IndexError("there is no such place")
        return [-math.sinh(q[0])]

    with pytest.raises(IndexError, match="no such place"):
        nysalt.judge(of(with_a_mistake), "verlet", 3.0)


def test_cycles_are_collected():
    springs = Springs()
    gone = weakref.ref(springs)
    gc.collect()
    assert nysalt.run(springs.system, "verlet", 0.1, 1).steps == 10  # what is held is not
    del springs
    gc.collect()
    assert gone() is None
    held = Springs().system  # which needs what made it
    gc.collect()
    assert held.energy([1, 0], [0, 0]) == 0.5


def test_it_may_be_in_a_bath_and_has_masses():
    # One oscillator of mass 4 and frequency 1 at kT = 0.5.
    bath = nysalt.hamiltonian("heavy", dimension=1, potential=lambda q: 2 * q[0]**2, force=lambda q: -4 * q,
                              starts=lambda seed, n: ([0.0], [1.0]), inverse_mass=0.25, friction=1, temperature=0.5,
                              frequency=1)
    assert bath.energy([1.0], [2.0]) == 2 + 0.5
    run = nysalt.run(bath, "baoab", 0.2, 20, trajectories=200, observables="kinetic_temperature", sample_every=100)
    # p^2/m is kT times chi-squared: of 200 the mean errs by kT sqrt(2/200), and this is five times that.
    assert abs(run.values[:, -1, 0].mean() - 0.5) <= 5 * 0.5 * 0.1
    assert run.values[0, 0, 0] == 0.25


def wells(number, kind=None):
    """Quartic wells of one's own."""

    def starts(seed, n):
        draw = np.random.default_rng([seed, n])
        return 0.5 * draw.standard_normal(number), draw.standard_normal(number)

    return nysalt.hamiltonian(f"wells({number})", dimension=number, potential=lambda q: 0.25 * np.sum(q**4),
                              force=lambda q: -(q**3), starts=starts, frequency=3.0, kind=kind)


def test_systems_of_a_kind_share_schemes_with_a_warning():
    assert nysalt.system("fpu", omega=50).kind == nysalt.system("fpu", omega=50, pairs=20).kind == "fpu_chain(omega=50)"
    scheme = nysalt.learn(wells(1, kind="wells"), "nystrom", step=0.3, trajectories=4, horizon=3, loss="state:1",
                          effort="quick")
    assert scheme.document["system"]["kind"] == "wells"
    with pytest.warns(UserWarning, match=r"learned at another size, .* for wells\(3\)"):
        nysalt.run(wells(3, kind="wells"), scheme, step=0.3, horizon=3, trajectories=2)
    with warnings.catch_warnings():
        warnings.filterwarnings("error", message=".*learned at another size")
        nysalt.run(wells(1, kind="wells"), scheme, step=0.3, horizon=3, trajectories=2)
    for other in (wells(3), wells(3, kind="other wells")):
        with pytest.raises(ValueError, match="must run on wells"):
            nysalt.run(other, scheme, step=0.3, horizon=3, trajectories=2)


def cubic(q):
    return -q - q**3


def three_wells(force, batched, **bath):
    """Of functions over (trajectories, dimension) if batched: one call a kick."""
    return nysalt.hamiltonian("wells", dimension=3, potential=lambda q: (0.5 * q**2 + 0.25 * q**4).sum(axis=-1), force=force,
                              starts=lambda seed, n: np.random.default_rng([seed, n]).normal(0, 0.5, (2, 3)), frequency=3.0,
                              inverse_mass=[1.0, 0.5, 2.0], batched=batched, **bath)


@pytest.mark.parametrize("method", ["verlet", "mclachlan5", "srkn6b", "srkn11b", "chin4a", "baoab", "obabo", "verlet@end"])
@pytest.mark.parametrize("steps", [1, 64, 100])
def test_batched_bits_are_those_of_one_after_the_other(method, steps):
    is_in_bath = method in ("baoab", "obabo", "verlet@end")
    bath = dict(friction=0.7, temperature=0.4) if is_in_bath else {}
    q, p = three_wells(cubic, False).starts(7)
    one = nysalt.integrate(three_wells(cubic, False, **bath), method, 0.2, q, p, steps, seed=5)
    many = nysalt.integrate(three_wells(cubic, True, **bath), method, 0.2, q, p, steps, seed=5)
    assert (one[0] == many[0]).all() and (one[1] == many[1]).all()
    assert not (one[0] == q).any()
    other = nysalt.integrate(three_wells(cubic, True, **bath), method, 0.2, q, p, steps, seed=6)
    assert (other[1] == many[1]).any() != is_in_bath


def test_batched_there_is_one_call_a_kick():
    shapes = []

    def counted(q):
        shapes.append(q.shape)
        return cubic(q)

    wells = three_wells(counted, True)
    q, p = wells.starts(1000)
    shapes.clear()
    nysalt.integrate(wells, "srkn6b", 0.2, q, p, 10)
    assert shapes == [(1000, 3)] * 61


def test_batched_one_that_is_lost_leaves_the_others():
    q, p = three_wells(cubic, False).starts(5)
    q[2] *= 1e3  # far out the step is much too long
    one, many = (nysalt.integrate(three_wells(cubic, batched), "verlet", 0.2, q, p, 200) for batched in (False, True))
    assert np.isnan(one[0][2]).all() and np.isnan(many[0][2]).all()
    kept = [0, 1, 3, 4]
    assert (one[0][kept] == many[0][kept]).all() and np.isfinite(many[1][kept]).all()


def test_batched_a_wrong_shape_is_refused():
    q, p = three_wells(cubic, False).starts(4)
    with pytest.raises(ValueError, match=r"force\(q\) must have the shape \(1, 3\)"):
        three_wells(lambda q: cubic(q)[0], True)
    wells = three_wells(lambda q: cubic(q)[:1], True)  # right for one trajectory alone
    with pytest.raises(ValueError, match=r"force\(q\) must have the shape \(4, 3\)"):
        nysalt.integrate(wells, "verlet", 0.1, q, p, 10)
    with pytest.raises(ZeroDivisionError):
        nysalt.integrate(three_wells(lambda q: cubic(q) if len(q) == 1 else 1 / 0, True), "verlet", 0.1, q, p, 10)


def test_batched_it_learns_as_the_plain_one():
    fits = [nysalt.learn(three_wells(cubic, batched), "nystrom", step=0.3, horizon=3, trajectories=5,
                         effort="quick", loss="state:1").theta for batched in (False, True)]
    assert (fits[0] == fits[1]).all()
