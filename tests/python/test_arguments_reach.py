# SPDX-License-Identifier: BSL-1.0
"""Arguments that change no shape of a result are used, not only taken."""
import nysalt
import pytest

SPRING = nysalt.system("oscillator", omega=1.0)


def test_the_fine_step_is_that_of_the_reference():
    asked = dict(family="nystrom", step=0.5, horizon=2, trajectories=4, random_starts=0, loss="state:1")
    fit = nysalt.learn(SPRING, fine_step=0.05, **asked).fit
    assert "0.05" in fit["reference"]
    with pytest.raises(ValueError, match="fine_step"):  # a step must be a multiple of it
        nysalt.learn(SPRING, fine_step=0.3, **asked)


def test_each_role_has_starts_of_its_own():
    starts = {role: SPRING.starts(3, role=role)[0].tolist() for role in ("training", "held_out", "test")}
    assert starts["training"] != starts["held_out"] != starts["test"] != starts["training"]
    assert SPRING.starts(3)[0].tolist() == starts["test"]
