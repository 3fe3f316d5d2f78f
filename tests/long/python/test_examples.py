# SPDX-License-Identifier: BSL-1.0
"""The examples of docs/python.md run, and find what they say. Tier 1 has their calls in tests/python, and that
fits are those of the program."""
import pathlib
import runpy

import numpy as np
import nysalt

EXAMPLES = pathlib.Path(__file__).parents[3] / "examples/python"


def test_fpu_is_under_25_lines_and_learns_a_scheme(tmp_path, monkeypatch, capsys):
    assert len((EXAMPLES / "fpu.py").read_text().splitlines()) < 25
    monkeypatch.chdir(tmp_path)
    found = runpy.run_path(str(EXAMPLES / "fpu.py"))
    assert found["scheme"].usable and found["scheme"].reason is None
    assert nysalt.load(tmp_path / "scheme.json").document == found["scheme"].document
    printed = capsys.readouterr().out
    assert "usable" in printed and "scheme:nystrom" in printed
    errors = {row["method"]: row["error"] for row in found["found"]["rows"]}
    assert errors["scheme:nystrom"] < errors["verlet"]  # which has half the step


def test_own_hamiltonian_learns_and_compares(capsys):
    found = runpy.run_path(str(EXAMPLES / "own_hamiltonian.py"))
    assert found["scheme"].usable and not found["morse"].frequency_bands
    assert {row["metric"] for row in found["found"]["rows"]} == {"state", "energy"}
    # examples/new_hamiltonian.cpp prints these at the step .4, from other data: the optimum moves with the square of the
    # step, by some (.4^2 - .3^2)/.4^2 of its distance from the best at small steps, (.5, .4).
    theirs = np.array([0.4939, 0.3873])
    assert (abs(found["scheme"].theta - theirs) <= 0.03).all()
    assert "mclachlan2" in capsys.readouterr().out


def test_batched_force(capsys):
    runpy.run_path(str(EXAMPLES / "batched_force.py"), run_name="__main__")
    assert float(capsys.readouterr().out.split()[-1]) < 1e-2  # of energies of some 3


def test_states(capsys):
    found = runpy.run_path(str(EXAMPLES / "states.py"))
    assert found["off"].max() < 0.5 and len(capsys.readouterr().out.splitlines()) == 10
    assert not np.array_equal(found["q"], found["chain"].starts(1000)[0])
