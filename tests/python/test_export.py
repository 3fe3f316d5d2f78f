# SPDX-License-Identifier: BSL-1.0
"""A method as source is the text of the program, and steps as the module does."""
import numpy as np
import pytest

import nysalt


def module_of(text):
    found = {"__name__": "exported"}
    exec(compile(text, "exported", "exec"), found)
    return found


def test_a_text_is_that_of_the_program(program):
    for host in ("c", "python", "mici"):
        assert nysalt.export("srkn6b", host) == program("export", "srkn6b", "--to", host)["text"]
    assert nysalt.export("chin4a", "c", displaced=True) == program("export", "chin4a", "--to", "c", "--displaced")["text"]


def test_a_learned_method_steps_as_here():
    system = nysalt.system("henon_heiles")
    scheme = nysalt.learn(system, "bab3", step=0.6, trajectories=20, effort="quick")
    exported = module_of(nysalt.export(scheme, "python"))
    assert exported["self_test"]() < 1e-13
    q, p = (np.array(x) for x in system.starts(5))
    here = nysalt.integrate(system, scheme, 0.6, q, p, 20)
    exported["steps"](q, p, 0.6, 20, system.force)
    # 20 steps of 7 letters, each rounded to 2^-53 of numbers below 1; orbits part by less than 100 meanwhile.
    assert np.abs(here[0] - q).max() < 1e-12 and np.abs(here[1] - p).max() < 1e-12
    exported["steps"](q, p, 0.6, 1, system.force)
    assert np.abs(here[0] - q).max() > 1e-3


@pytest.mark.parametrize("method, first", [("srkn6b", 1), ("verlet", 1), ("mclachlan2", 0)])
def test_evaluations_are_those_of_the_header(method, first):
    text = nysalt.export(method, "python")
    told = int(text.split("first and last joined: ")[1].split(".")[0])
    calls = []

    def force(q):
        calls.append(1)
        return -q

    module_of(text)["steps"](np.ones(3), np.zeros(3), 0.1, 10, force)
    assert len(calls) == 10 * told + first
    assert told == nysalt.methods()[method]["evaluations_per_step"]


def test_the_header_promises_no_more_than_the_letters():
    displaced = nysalt.export("fg4_processed", "python", displaced=True)
    assert "order 4." in displaced and "displaced kicks" in displaced and "ABADABA|" in displaced
    assert "order 6." in nysalt.export("srkn11b", "python", displaced=True)
    assert "displaced kicks" not in nysalt.export("srkn11b", "python", displaced=True)


def test_what_a_host_does_not_take():
    with pytest.raises(ValueError, match="did you mean python"):
        nysalt.export("verlet", "pyton")
    with pytest.raises(ValueError, match="displaced"):
        nysalt.export("chin4a", "c")
