# SPDX-License-Identifier: BSL-1.0
"""The program beside the package, and Henon and Heiles' system by functions of Python."""
import json
import os
import re
import subprocess

import pytest

import nysalt


@pytest.fixture
def program(tmp_path):
    """Runs `nysalt` in a folder of its own; the document that it prints."""

    def run(*arguments):
        done = subprocess.run([os.environ["NYSALT_PROGRAM"], *arguments, "--json"], cwd=tmp_path,
                              capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)

    return run


def without_times(document):
    """What two computers, or one twice, agree on; a text with arguments where the program names options."""
    if isinstance(document, str):
        return re.sub(r"--([a-z-]+)", lambda option: option[1].replace("-", "_"), document)
    if isinstance(document, dict):
        return {name: without_times(value) for name, value in document.items()
                if "seconds" not in name and name != "peak_memory"}
    return [without_times(value) for value in document] if isinstance(document, list) else document


def henon_heiles_by_functions(name="henon_heiles by functions", cubic=1.0, force=None, **more):
    """With the operations of include/nysalt/systems/textbook.hpp, in their order, and with its starts; 1.0 times
    a number is that number."""
    bundled = nysalt.system("henon_heiles")
    starts = {1 + 2**51 * key: bundled.starts(100, role=role)
              for key, role in enumerate(("training", "held_out", "test"))}

    def potential(q):
        x, y = q.tolist()
        return (x * x + y * y) * 0.5 + cubic * x * x * y - cubic * y * y * y * (1.0 / 3.0)

    def own_force(q):
        x, y = q.tolist()
        return -x - cubic * x * y * 2.0, -y - cubic * x * x + cubic * y * y

    def start(seed, n):
        q, p = starts[seed]
        return q[n], p[n]

    return nysalt.hamiltonian(name, dimension=2, potential=potential, starts=start,
                              force=force or own_force, **more)
