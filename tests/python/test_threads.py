# SPDX-License-Identifier: BSL-1.0
"""Threads of Python on one system, functions that ask the system that they belong to, other interpreters, and threads with
another rounding. What a call gives is what it gives alone; none waits for ever."""
import ctypes
import platform
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest

import nysalt
from conftest import henon_heiles_by_functions

LIMIT = 20  # seconds for calls of milliseconds: a thread that waits for ever shows

# Each function of the module that takes a system, at little cost; `system` is one of the two below.
CALLS = dict(
    facts=lambda system: repr(system),
    force=lambda system: system.force(Q),
    energy=lambda system: system.energy(Q, P),
    starts=lambda system: system.starts(20),
    run=lambda system: nysalt.run(system, "verlet", 0.1, 2, trajectories=3, observables=["energy", "q1"], checks=False).values,
    checked_run=lambda system: nysalt.run(system, "verlet", 0.1, 2, trajectories=3, observables=["energy"]).values,
    integrate=lambda system: nysalt.integrate(system, "verlet", 0.1, Q, P, 5),
    phase_fitted=lambda system: nysalt.integrate(system, "phase_fitted_chin4a", 0.1, Q, P, 5),
    judge=lambda system: nysalt.judge(system, "verlet", 0.4)["verdict"],
    learn=lambda system: nysalt.learn(system, "bab2", step=0.5, horizon=2, trajectories=3, effort="quick").coefficients(),
    compare=lambda system: [one["error"] for one in nysalt.compare(system, ["verlet", "mclachlan2v"], [0.2], trajectories=3,
                                                                   horizon=2)["rows"]],
)
Q, P = np.full((40, 2), 0.1), np.full((40, 2), 0.05)
SYSTEMS = dict(of_python=henon_heiles_by_functions, bundled=lambda: nysalt.system("henon_heiles"))


def numbers(found):
    return np.concatenate([np.ravel(one) for one in found]) if isinstance(found, tuple) else found


PAIRS = """
    import faulthandler, sys, threading
    faulthandler.dump_traceback_later({limit}, exit=True)  # works without the interpreter's lock
    sys.setswitchinterval(1e-4)  # a fiftieth of the usual
    from test_threads import CALLS, SYSTEMS, np, numbers

    system, call = SYSTEMS["{kind}"](), CALLS["{name}"]
    alone, other = numbers(call(system)), numbers(CALLS["force"](system))
    wrong = []
    def ask(function, wanted, times):
        try:
            for _ in range(times):
                if not np.array_equal(numbers(function(system)), wanted): wrong.append(function)
        except BaseException as problem:
            wrong.append(problem)
    threads = [threading.Thread(target=ask, args=args)
               for args in ((call, alone, 1), (call, alone, 1), (CALLS["force"], other, 30))]
    [one.start() for one in threads]
    [one.join() for one in threads]
    print(wrong)
"""


def run_script(script, **names):
    return subprocess.run([sys.executable, "-B", "-c", textwrap.dedent(script).format(limit=LIMIT, **names)],
                          capture_output=True, text=True, cwd=Path(__file__).parent)


@pytest.mark.parametrize("kind", SYSTEMS)
@pytest.mark.parametrize("name", CALLS)
def test_three_threads_on_one_system(kind, name):
    done = run_script(PAIRS, kind=kind, name=name)
    assert (done.returncode, done.stdout) == (0, "[]\n"), done.stderr[-2000:]


def test_a_thread_that_waits_for_ever_is_found():
    done = run_script("import faulthandler, threading\nfaulthandler.dump_traceback_later(1, exit=True)\nthreading.Lock().acquire()\n"
                      "lock = threading.Lock()\nlock.acquire()\nlock.acquire()")
    assert done.returncode == 1 and "Timeout" in done.stderr


def test_a_force_may_ask_its_system():
    """As deep as Python lets functions call one another, and at a finite depth to the right number."""
    asked = dict(depth=0, most=None)

    def force(q):
        if asked["most"] is None:
            return -q
        asked["depth"] += 1
        return system.force(q) if asked["depth"] < asked["most"] else -q

    system = nysalt.hamiltonian("asks", dimension=2, potential=lambda q: 0.5 * float(q @ q), force=force,
                                starts=lambda seed, n: (np.ones(2), np.zeros(2)), frequency=1.0)
    asked.update(depth=0, most=5)
    assert np.array_equal(system.force(np.ones(2)), [-1.0, -1.0]) and asked["depth"] == 5
    asked.update(depth=0, most=10**9)
    with pytest.raises(RecursionError):
        system.force(np.ones(2))


def test_the_module_may_be_loaded_again():
    again = run_script("import sys, nysalt\ndel sys.modules['nysalt'], sys.modules['nysalt._nysalt']\nimport nysalt\n"
                       "print(nysalt.system('pendulum').dimension)")
    assert (again.returncode, again.stdout) == (0, "1\n"), again.stderr


@pytest.mark.parametrize("first", ["", "import nysalt"])
def test_another_interpreter_has_an_import_error(first):
    done = run_script("import faulthandler\nfaulthandler.dump_traceback_later({limit}, exit=True)\n" + first + "\n" +
                      "import _xxsubinterpreters as others\nothers.run_string(others.create(), 'import nysalt')")
    if "No module named" in done.stderr:
        pytest.skip("this Python has no module of interpreters by that name")
    assert "ImportError" in done.stderr, done.stderr
    if not first:  # else NumPy may say the same first
        assert "nysalt must be imported in the main interpreter" in done.stderr, done.stderr


UPWARD = {"x86_64": 0x800, "aarch64": 0x400000}.get(platform.machine())  # FE_UPWARD of <fenv.h>
C_LIBRARY = ctypes.CDLL(None)


@pytest.mark.skipif(UPWARD is None, reason="the number of FE_UPWARD is not known here")
def test_the_rounding_of_a_thread_of_python_does_not_matter():
    """Another module may have set it; a force that sets it is refused."""
    chain = nysalt.system("fpu")

    def samples():
        return nysalt.run(chain, "verlet", 0.01, 1, trajectories=9, observables="energy", threads=2).values

    wanted = samples()
    assert C_LIBRARY.fesetround(UPWARD) == 0
    try:
        found = samples()
        assert C_LIBRARY.fegetround() == UPWARD  # what another module has set is left to it
    finally:
        C_LIBRARY.fesetround(0)
    assert np.array_equal(found, wanted)

    armed = []
    system = nysalt.hamiltonian("rounds", dimension=1, potential=lambda q: 0.5 * float(q @ q),
                                force=lambda q: (armed and C_LIBRARY.fesetround(UPWARD), -q)[1],
                                starts=lambda seed, n: (np.ones(1), np.zeros(1)), frequency=1.0)
    nysalt.run(system, "verlet", 0.1, 1)
    armed.append(True)
    with pytest.raises(ValueError, match="leave the floating-point environment as it is, got rounding upward"):
        nysalt.run(system, "verlet", 0.1, 1, checks=False)
    with pytest.raises(ValueError, match="leave the floating-point environment as it is, got rounding upward"):
        system.force([1.0])
    assert C_LIBRARY.fegetround() == 0
