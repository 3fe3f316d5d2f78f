# SPDX-License-Identifier: BSL-1.0
"""The example of docs/python.md: under 25 lines, and the program's theta to the last bit."""
import pathlib
import runpy

import nysalt

EXAMPLE = pathlib.Path(__file__).parents[2] / "examples/python/fpu.py"


def bits(parameters):
    return {name: value.hex() for name, value in parameters.items()}


def test_the_example_is_under_25_lines_and_learns_what_the_program_learns(program, tmp_path, monkeypatch, capsys):
    assert len(EXAMPLE.read_text().splitlines()) < 25
    monkeypatch.chdir(tmp_path)
    its = runpy.run_path(str(EXAMPLE))
    scheme = its["scheme"]
    by_program = program("learn", "--family", "nystrom", "--system", "fpu", "--omega", "50", "--step", "0.02",
                         "--loss", "state:1", "--output", "theirs.json")
    assert bits(scheme.parameters) == bits(by_program["parameters"])
    assert bits(dict(zip(scheme.parameters, scheme.theta.tolist()))) == bits(by_program["parameters"])
    assert scheme.standard_errors == by_program["standard_errors"]
    assert (scheme.loss, scheme.held_out_loss) == (by_program["loss"], by_program["held_out_loss"])
    assert (tmp_path / "scheme.json").read_bytes() == (tmp_path / "theirs.json").read_bytes()
    assert scheme.usable and scheme.reason is None

    printed = capsys.readouterr().out
    assert "usable" in printed and "scheme:nystrom" in printed
    errors = {row["method"]: row["error"] for row in its["found"]["rows"]}
    assert errors["scheme:nystrom"] < errors["verlet"]  # which has half the step


def test_another_seed_learns_another_theta(program):
    chain = nysalt.system("fpu", omega=50)
    asked = dict(family="nystrom", step=0.02, trajectories=20, seed=2)
    of_program = program("learn", "--family", "nystrom", "--step", "0.02", "--trajectories", "20", "--seed", "2")["parameters"]
    assert bits(nysalt.learn(chain, **asked).parameters) == bits(of_program)
    assert bits(nysalt.learn(chain, **{**asked, "seed": 3}).parameters) != bits(of_program)
