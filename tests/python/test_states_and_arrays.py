# SPDX-License-Identifier: BSL-1.0
"""States are stepped as run steps them; arrays are filled where they lie; arguments are used, not only taken."""
import tracemalloc

import numpy as np
import pytest

import nysalt


@pytest.fixture(scope="module")
def chain():
    return nysalt.system("fpu", omega=50, friction=0.01, sigma=0.05, start="law")  # no burn-in


def samples_at_end(chain, trajectories, steps, **more):
    names = [f"q{i}" for i in range(1, 7)] + [f"p{i}" for i in range(1, 7)]
    run = nysalt.run(chain, "baoab", 0.01, steps * 0.01, trajectories=trajectories, sample_every=steps,
                     observables=names, **more)
    return run.values[:, -1, :6], run.values[:, -1, 6:]


@pytest.mark.parametrize("trajectories", [1, 40])  # singly, and side by side in lanes
def test_states_go_where_run_takes_them(chain, trajectories):
    q, p = chain.starts(trajectories)
    expected = samples_at_end(chain, trajectories, 150)
    assert np.array_equal((q, p), chain.starts(trajectories, seed=1))
    assert not np.array_equal(q, chain.starts(trajectories, seed=2)[0])
    new = nysalt.integrate(chain, "baoab", 0.01, q, p, 150, seed=1)
    assert np.array_equal(new, expected)
    assert np.array_equal((q, p), chain.starts(trajectories))  # as they were
    assert not np.array_equal(nysalt.integrate(chain, "baoab", 0.01, q, p, 150, seed=2), expected)  # other noise

    mine = nysalt.integrate(chain, "baoab", 0.01, q, p, 150, seed=1, out=(q, p))
    assert mine[0] is q and mine[1] is p and np.array_equal(mine, expected)


def test_runs_begin_at_states_of_ours():
    kepler = nysalt.system("kepler")
    names = ["q1", "q2", "p1", "p2"]
    orbit = nysalt.run(kepler, "srkn11b", 2 * np.pi / 640, 2 * np.pi, q=[0.4, 0], p=[0, 2], sample_every=640,
                       observables=names)
    assert np.array_equal(orbit.values[0, 0], [0.4, 0, 0, 2])
    assert np.abs(orbit.values[0, 1] - orbit.values[0, 0]).max() < 1e-9  # a = 1: a period is 2 pi
    q, p = kepler.starts(3, seed=7)
    several = nysalt.run(kepler, "verlet", 0.01, 1, q=q, p=p, observables=names, sample_every=100)
    drawn = nysalt.run(kepler, "verlet", 0.01, 1, trajectories=3, observables=names, sample_every=100, seed=7)
    assert np.array_equal(several.values, drawn.values)
    at_rest = nysalt.run(nysalt.system("pendulum", spread=2.0), "verlet", 0.01, 1, q=[0.5], observables=["q1", "p1"])
    assert np.array_equal(at_rest.values[0, 0], [0.5, 0])
    at = nysalt.system("kepler", at="q1=0.4; p2=2")
    assert np.array_equal(nysalt.run(at, "srkn11b", 2 * np.pi / 640, 2 * np.pi, sample_every=640,
                                     observables=names).values, orbit.values)


def test_a_loop_of_calls_has_new_noise_in_each():
    count = 400
    warm = nysalt.system("oscillator", omega=1, friction=1, temperature=1, start="law")

    def temperature_after(**seed):
        q, p = np.zeros((count, 1)), np.zeros((count, 1))
        for _ in range(200):
            q, p = nysalt.integrate(warm, "baoab", 0.1, q, p, 1, **seed)
        return (q**2).mean()

    # <q^2> = kT, and a mean of 400 squares of normal numbers deviates by .07; 5 deviations.
    assert abs(temperature_after() - 1) < 0.35
    assert temperature_after(seed=1) > 5  # the same noise again and again: q drifts by 0.1 p in each step


def test_one_state_may_be_a_list_and_steps_may_be_none():
    pendulum = nysalt.system("pendulum")
    q, p = nysalt.integrate(pendulum, "verlet", 0.1, [0.5], [0.0], 1)
    # B A B with f = -sin q.
    half = -0.05 * np.sin(0.5)
    assert q[0] == 0.5 + half * 0.1 and abs(p[0] - (half - 0.05 * np.sin(q[0]))) <= 1e-17
    assert np.array_equal(nysalt.integrate(pendulum, "verlet", 0.1, [0.5], [0.0], 0), ([0.5], [0.0]))


def test_what_diverges_ends_as_nan():
    wild = nysalt.system("henon_heiles")
    q, p = nysalt.integrate(wild, "verlet", 0.1, [[0.1, 0.1], [3.0, 3.0]], np.zeros((2, 2)), 400)
    assert np.isfinite(q[0]).all() and np.isfinite(p[0]).all()
    assert np.isnan(q[1]).all() and np.isnan(p[1]).all()


def test_arrays_are_filled_where_they_lie(chain):
    shape = (32, 2001, 4)
    observables = ["stiff_energy", "energy", "q1", "p1"]
    out = np.zeros(shape)
    pointer = out.ctypes.data
    tracemalloc.start()
    run = nysalt.run(chain, "baoab", 0.01, 20, trajectories=32, observables=observables, out=out)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert run.values is out and out.ctypes.data == pointer and not np.isnan(out).any()
    assert most < out.nbytes / 20  # NumPy tells of each of its arrays: there was no second one of the size
    assert run["q1"].base is out and np.shares_memory(run["q1"], out)

    tracemalloc.start()
    new = nysalt.run(chain, "baoab", 0.01, 20, trajectories=32, observables=observables)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert new.values.flags.owndata and np.array_equal(new.values, out)
    assert out.nbytes < most < 1.05 * out.nbytes  # one array, and no copy
    assert not np.shares_memory(new.values, out) and not np.shares_memory(out.copy(), out)


def test_a_run_prints_as_one_line(chain):
    run = nysalt.run(chain, "baoab", 0.01, 20, trajectories=3, sample_every=50, observables=["energy", "q1"])
    assert repr(run) == str(run) == (f"<nysalt run of {chain.description}: 3 trajectories, 2000 steps, "
                                     "41 samples to t = 20: energy, q1>")


def test_energy_and_force_are_those_of_the_hamiltonian():
    system = nysalt.system("henon_heiles")
    q, p = system.starts(5)
    x, y = q.T
    expected = 0.5 * (p**2).sum(1) + 0.5 * (x**2 + y**2) + x**2 * y - y**3 / 3
    assert np.allclose(system.energy(q, p), expected, rtol=1e-14, atol=0)  # some ten roundings
    assert isinstance(system.energy(q[0], p[0]), float) and system.energy(q[0], p[0]) == system.energy(q, p)[0]
    assert np.array_equal(system.force(q), np.stack([-x - x * y * 2, -y - x * x + y * y], axis=1))
    assert system.force(q[0]).shape == (2,) and not np.allclose(system.energy(q, p), expected * 1.001)


def test_facts_of_a_system():
    chain = nysalt.system("fpu", omega=30, pairs=2)
    assert chain.dimension == 4 and chain.description == "fpu_chain(pairs=2, omega=30)"
    assert chain.default_observable == "stiff_energy" and "q1..q4" in chain.observables
    assert chain.parameters == {"name": "fpu", "pairs": 2, "omega": 30.0} and not chain.calls_python
    assert chain.frequency_bands[-1][1] >= 30 and nysalt.system("kepler").frequency_bands == []


def test_the_fine_step_is_that_of_the_reference():
    spring = nysalt.system("oscillator", omega=1.0)
    asked = dict(family="nystrom", step=0.5, horizon=2, trajectories=4, random_starts=0, loss="state:1")
    fit = nysalt.learn(spring, fine_step=0.05, **asked).fit
    assert "0.05" in fit["fits"][0]["reference"]
    with pytest.raises(ValueError, match="fine_step"):  # a step must be a multiple of it
        nysalt.learn(spring, fine_step=0.3, **asked)


def test_each_role_has_starts_of_its_own():
    spring = nysalt.system("oscillator", omega=1.0)
    starts = {role: spring.starts(3, role=role)[0].tolist() for role in ("training", "held_out", "test")}
    assert starts["training"] != starts["held_out"] != starts["test"] != starts["training"]
    assert spring.starts(3)[0].tolist() == starts["test"]


def test_a_system_is_of_the_files_that_it_was_made_of(tmp_path, monkeypatch):
    """All calls see one system: a file that has changed since, or is another in another folder, is refused."""
    (tmp_path / "other").mkdir()
    for folder, first in ((tmp_path, 0.1), (tmp_path / "other", 0.3)):
        (folder / "at.csv").write_text(f"q1,q2\n{first},0.1\n")
    monkeypatch.chdir(tmp_path)
    system = nysalt.system("henon_heiles", start="at.csv")
    assert system.starts()[0][0, 0] == 0.1
    monkeypatch.chdir(tmp_path / "other")
    for call in (system.starts, lambda: nysalt.run(system, "verlet", 0.1, 1), lambda: nysalt.judge(system, "verlet", 0.1)):
        with pytest.raises(ValueError, match="at.csv: the file must be as it was when the system was made"):
            call()
    monkeypatch.chdir(tmp_path)
    assert system.starts()[0][0, 0] == 0.1
    (tmp_path / "at.csv").write_text("q1,q2\n0.2,0.1\n")
    with pytest.raises(ValueError, match="at.csv: the file must be as it was when the system was made"):
        system.starts()
    assert nysalt.system("henon_heiles", start="at.csv").starts()[0][0, 0] == 0.2
