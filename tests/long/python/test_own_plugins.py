# SPDX-License-Identifier: BSL-1.0
"""Systems of users that are compiled: by a source, and by a potential as text. Tier 1: tests/smoke has one plug-in."""
from pathlib import Path

import numpy as np
import pytest

import nysalt

TODA = str(Path(__file__).parents[3] / "examples" / "plugins" / "toda.hpp")


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "cache"))


def test_a_source_is_built_and_loaded(tmp_path):
    path = nysalt.build(TODA, str(tmp_path / "toda.so"))
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
    with pytest.raises(ValueError, match="unknown parameter 'omega' of the system .*toda.so: it takes particles, spread"):
        nysalt.system(path, omega=3.0)
    with pytest.raises(ValueError, match="particles must be a whole number, got 2.5"):
        nysalt.system(path, particles=2.5)
    with pytest.raises(ValueError, match="particles must be at least 2 and at most 1000, got 1"):
        nysalt.system(path, particles=1)


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
