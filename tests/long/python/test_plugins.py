# SPDX-License-Identifier: BSL-1.0
"""Systems of users that are compiled: by a source, whose letters make words that are methods and families by name, and by a
potential as text. Tier 1: tests/smoke has one plug-in."""
from pathlib import Path

import numpy as np
import pytest

import nysalt

PLUGINS = Path(__file__).parents[3] / "examples" / "plugins"


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "cache"))


def test_words_of_them_are_stepped():
    well = nysalt.system(str(PLUGINS / "cubic_well.hpp"))
    assert well.letters == ["t", "c"]
    assert nysalt.system("pendulum").letters == []
    q, p = np.array([0.1, -0.2]), np.array([0.3, 0.1])
    end_q, end_p = nysalt.integrate(well, "word:tct", 0.5, q, p, 1)
    # Half a turn, the kick, half a turn: the operations of the letters, in their order.
    c, s = np.cos(0.25), np.sin(0.25)
    def turned(q, p):
        return q * c + p * s, p * c - q * s
    x, y = turned(q, p)
    y = y + 0.5 * np.array([-2 * x[0] * x[1], x[1]**2 - x[0]**2])
    x, y = turned(x, y)
    # NumPy's cosine may be another one: some ten roundings of numbers below 1/2.
    assert np.allclose(end_q, x, rtol=0, atol=1e-15) and np.allclose(end_p, y, rtol=0, atol=1e-15)
    other_q, _ = nysalt.integrate(well, "word:ctc", 0.5, q, p, 1)
    assert not np.allclose(other_q, x, rtol=0, atol=1e-4)


def test_what_is_learned_keeps_them_by_name(tmp_path):
    well = nysalt.system(str(PLUGINS / "cubic_well.hpp"))
    scheme = nysalt.learn(well, "word:tctct", step=0.5, trajectories=16)
    assert scheme.letters == "tctct" and scheme.symmetric and scheme.evaluations_per_step == 2
    assert [one["letter"] for one in scheme.document["own_letters"]] == ["t", "c"]
    scheme.save(tmp_path / "scheme.json")
    again = nysalt.load(tmp_path / "scheme.json")
    run, same, plain = (nysalt.run(well, method, step=0.5, horizon=5, trajectories=3, observables=["q1", "p2"]).values
                        for method in (scheme, again, "word:tctct"))
    assert np.array_equal(run, same) and not np.array_equal(run, plain)
    with pytest.raises(ValueError, match="has no letters of its own, got t of cubic_well"):
        nysalt.run(nysalt.system("pendulum"), again, step=0.5, horizon=5)
    with pytest.raises(ValueError, match="the letter t"):
        nysalt.export(again, "c")


def test_parts_are_kicked_by_name():
    chain = nysalt.system(str(PLUGINS / "bonds_and_charges.hpp"))
    assert chain.letters == ["0", "1", "k"]
    errors = nysalt.compare(chain, ["word:kA0A0A0Ak", "verlet"], [0.03], metric="state", trajectories=8, horizon=3)
    respa, verlet = (row["error"] for row in errors["rows"])
    assert respa < 0.5 * verlet  # of order 2 with four times as short steps of the bonds


def test_letters_that_are_not_sound_are_refused(tmp_path):
    source = (PLUGINS / "cubic_well.hpp").read_text()
    weak = source.replace("x.p[i] += room.x[i] * t;", "x.p[i] += room.x[i] * t * 0.9;")
    assert weak != source
    (tmp_path / "weak.hpp").write_text(weak)
    well = nysalt.system(str(tmp_path / "weak.hpp"))
    with pytest.raises(ValueError, match="must add up to H"):
        nysalt.run(well, "word:tct", step=0.5, horizon=5)
    nysalt.run(well, "verlet", step=0.1, horizon=1)


def test_a_source_is_built_and_loaded(tmp_path):
    path = nysalt.build(str(PLUGINS / "toda.hpp"), str(tmp_path / "toda.so"))
    assert path == str(tmp_path / "toda.so")
    ring = nysalt.system(path, particles=6)
    assert ring.description == "toda(particles=6)" and ring.dimension == 6 and not ring.calls_python
    assert ring.parameters == {"name": "toda", "particles": 6, "source": ring.parameters["source"]}
    q = np.linspace(-0.3, 0.4, 6)
    bonds = np.roll(q, -1) - q
    assert np.allclose(ring.energy(q, 0 * q), np.sum(np.exp(bonds) - 1 - bonds), rtol=1e-14)
    run = nysalt.run(ring, "srkn6b", step=0.1, horizon=1, trajectories=4, observables=["first_bond", "energy"])
    assert run["first_bond"].shape == (4, 11)
    assert np.all(np.abs(run["energy"] - run["energy"][:, :1]) < 1e-5)
    scheme = nysalt.learn(ring, "nystrom", step=0.3, trajectories=8)
    assert scheme.document["system"]["particles"] == 6
    for more, sentence in ((dict(omega=3.0), "unknown parameter 'omega' of .*toda.so: it takes particles, spread"),
                           (dict(particles=1), "particles must be at least 2 and at most 1000, got 1")):
        with pytest.raises(ValueError, match=sentence):
            nysalt.system(path, **more)


def test_a_potential_as_text():
    swing = nysalt.potential("0.5*k*(sqrt(x^2 + y^2) - 1)^2 + y", ["x", "y"], around={"y": -1}, k=400,
                             deviation_q=0.02, deviation_p=0.5)
    q = np.array([0.3, -1.1])
    r = np.hypot(*q)
    assert np.isclose(swing.energy(q, 0 * q), 200 * (r - 1)**2 - 1.1, rtol=1e-14)
    assert np.allclose(swing.force(q), -400 * (r - 1) * q / r - [0, 1], rtol=1e-13)
    heavy = nysalt.potential("x^2", "x", mass=4)
    assert heavy.energy([0.0], [2.0]) == 0.5
    with pytest.raises(ValueError, match="potential: 'z' must be a function"):
        nysalt.potential("x + z", ["x"])
    with pytest.raises(ValueError, match="must come with .*variables"):
        nysalt.potential("x^2", [])
