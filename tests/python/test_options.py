# SPDX-License-Identifier: BSL-1.0
"""Keywords are those of the options of the program, with their defaults; nysalt/__init__.pyi has them."""
import inspect
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path

import pytest

import nysalt

sys.path.append(str(Path(__file__).resolve().parents[2] / "docs" / "site"))
import stub

#: Those of a command that are no options of it: objects of Python in the place of names and files.
OWN = {"run": {"system", "q", "p", "out"}, "learn": {"system"}, "compare": {"system"}, "recommend": {"system", "output"}}


def offered(command):
    """Defaults in the help of a command, by the keyword."""
    text = subprocess.run([os.environ["NYSALT_PROGRAM"], command, "--help-all"], capture_output=True, text=True, check=True).stdout
    rows = re.findall(r"^  --(\S+)(?: [A-Z]\S*)?(?: \[(.*?)\])?(?: REQUIRED)?(?:  |$)", text, re.MULTILINE)
    return {name.replace("-", "_"): value for name, value in rows}


@pytest.mark.parametrize("command", OWN)
def test_keywords_are_options_of_the_command(command):
    options = offered(command)
    options["checks"], options["purpose"] = "True", options.pop("for", "")
    found = {name: one.default for name, one in inspect.signature(getattr(nysalt, command)).parameters.items()
             if name not in OWN[command]}
    assert len(found) > 8 and set(found) <= set(options)
    shown = {name: value if isinstance(value, (str, bool)) else f"{value:g}" for name, value in found.items()
             if value not in (None, False, (), inspect.Parameter.empty)}
    assert len(shown) > 2 and {name: str(value) for name, value in shown.items()} == {name: options[name] for name in shown}


def test_docstrings_have_the_options():
    assert re.search(r"^ *learn_effort: how long .* \['normal'\]$", nysalt.compare.__doc__, re.MULTILINE)
    assert re.search(r"in place of steps?\b|in place of trajectories", nysalt.learn.__doc__) and "--" not in nysalt.learn.__doc__


def test_the_stub_is_up_to_date():
    text = (Path(stub.folder) / "__init__.pyi").read_text()
    assert text == stub.stub(nysalt), "docs/site/stub.py --update writes it"
    assert "sample_every: int=..." in text and "options" not in re.findall(r"\w+(?=:)", text)


def test_other_keywords_are_refused_as_python_does():
    with pytest.raises(TypeError, match="unexpected keyword argument 'trajectory'"):
        nysalt.learn(nysalt.system("pendulum"), step=0.1, trajectory=3)
    with pytest.raises(TypeError, match="missing a required argument: 'horizon'"):
        nysalt.run(nysalt.system("pendulum"), "verlet", 0.1)


def test_warnings_are_of_the_line_that_calls():
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        nysalt.run(nysalt.system("kepler", friction=0.1, temperature=0.1), "baoab", 0.01, 0.1)
    assert caught and {one.filename for one in caught} == {__file__}
