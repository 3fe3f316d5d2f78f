# SPDX-License-Identifier: BSL-1.0
"""The examples of docs/python.md run, and find what they say; Ctrl-C ends a search of minima. Tier 1 has their calls in
tests/python, that fits are those of the program, and Ctrl-C in data, runs and comparisons."""
import os
import pathlib
import runpy
import signal
import threading
import time

import numpy as np
import nysalt
import pytest

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


def test_a_long_search_ends():
    began = time.monotonic()
    timer = threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):  # few data, a long search
        nysalt.learn(nysalt.system("fpu"), "fg4", step=0.03, trajectories=50, random_starts=10000)
    assert time.monotonic() - began < 60  # it would take minutes; a pass over the starts is done before it ends
    timer.join()
