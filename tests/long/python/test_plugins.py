# SPDX-License-Identifier: BSL-1.0
"""Systems of users that are compiled: by a source, whose letters make words that are families by name, and by a potential as
text. What the words do, and which letters are refused, tests/smoke and tests/long/programs have. Tier 1: tests/smoke."""
import subprocess
from pathlib import Path

import numpy as np
import pytest

import nysalt

PLUGINS = Path(__file__).parents[3] / "examples" / "plugins"


@pytest.fixture(autouse=True)
def own_cache(tmp_path_factory, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path_factory.getbasetemp() / "cache"))


def test_what_is_learned_keeps_them_by_name(tmp_path):
    well = nysalt.system(str(PLUGINS / "cubic_well.hpp"))
    assert well.letters == ["t", "c"] and nysalt.system("pendulum").letters == []
    assert nysalt.system(str(PLUGINS / "bonds_and_charges.hpp")).letters == ["0", "1", "k"]
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


WELL = """#include <nysalt/plugin.hpp>
struct well {{
  static constexpr int dimension = 1;
  template <class T> T potential(const nysalt::vector<T, 1>& q) const {{ return q[0] * q[0] * {stiffness}; }}
}};
NYSALT_SYSTEM(well, "a well", starts([](const well&) {{
  const nysalt::vector<double, 1> zero(0.0);
  return normal_around<1>({{zero, zero}}, 0.1, 0.1);
}}));
"""


def test_what_has_changed_is_another_system_and_what_is_held_stays(tmp_path, monkeypatch):
    def force(system):
        return -system.force([1.0])[0]

    def first_kick(system):
        run = nysalt.run(system, "verlet", step=1e-3, horizon=1e-3, q=[1.0], p=[0.0], observables=["p1"], checks=False)
        return -run["p1"][0, -1] / 1e-3

    for folder, stiffness in (("soft", 0.5), ("stiff", 50.0)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "well.hpp").write_text(WELL.format(stiffness=stiffness))
    monkeypatch.chdir(tmp_path / "soft")
    soft = nysalt.system("well.hpp")
    monkeypatch.chdir(tmp_path / "stiff")
    stiff = nysalt.system("well.hpp")
    assert (force(soft), force(stiff)) == (1.0, 100.0)
    # Commands take the system that is held, whatever has become of its file and of the current folder.
    (tmp_path / "stiff" / "well.hpp").write_text(WELL.format(stiffness=5.0))
    assert np.isclose(first_kick(soft), 1.0, rtol=1e-5) and np.isclose(first_kick(stiff), 100.0, rtol=1e-3)
    assert force(nysalt.system("well.hpp")) == 10.0
    built = nysalt.build("well.hpp")
    assert force(nysalt.system(built)) == 10.0
    (tmp_path / "stiff" / "well.hpp").write_text(WELL.format(stiffness=25.0))
    nysalt.build("well.hpp")  # replaces the library, which is loaded
    assert force(nysalt.system(built)) == 50.0


SHARED = """#include "nysalt/c_force.h"
{kind} double stiffness = {stiffness};
int64_t nysalt_dimension(void) {{ return 1; }}
double nysalt_potential(int64_t, const double* q, void*) {{ return 0.5 * stiffness * q[0] * q[0]; }}
void nysalt_force(int64_t, const double* q, double* f, void*) {{ f[0] = -stiffness * q[0]; }}
void nysalt_start(int64_t, const double* z, double* q, double* p, void*) {{ q[0] = z[0], p[0] = z[1]; }}
"""


@pytest.mark.parametrize("kind", ["static", "inline"])
def test_variables_of_two_libraries_are_two(tmp_path, kind):
    """The loader gives the inline variable of the first library to all later ones, whose forces would be those of the first."""
    for name, stiffness in (("first", 1), ("second", 100)):
        (tmp_path / f"{name}.cpp").write_text(SHARED.format(kind=kind, stiffness=stiffness))
        subprocess.run(["g++", "-shared", "-fPIC", "-I", str(PLUGINS.parents[1] / "include"), f"{name}.cpp", "-o", f"{name}.so"],
                       cwd=tmp_path, check=True)
    assert nysalt.system(str(tmp_path / "first.so")).force([1.0])[0] == -1.0
    if kind == "static":
        assert nysalt.system(str(tmp_path / "second.so")).force([1.0])[0] == -100.0
        return
    with pytest.raises(ValueError, match="variables of its own, got stiffness, which is that of .*first.so"):
        nysalt.system(str(tmp_path / "second.so"))


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
