# SPDX-License-Identifier: BSL-1.0
"""Ctrl-C ends long calls, and other threads of Python go on meanwhile."""
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import nysalt
from conftest import henon_heiles_by_functions

CHAIN = nysalt.system("fpu")


def long_integration():
    q, p = CHAIN.starts(40)
    nysalt.integrate(CHAIN, "srkn6b", 1e-3, q, p, 10**12, out=(q, p))


LONG = dict(
    run=lambda: nysalt.run(CHAIN, "verlet", 1e-3, 1e8, sample_every=10**9),  # hours, of one trajectory
    integrate=long_integration,
    learn=lambda: nysalt.learn(CHAIN, "nystrom", step=0.02, trajectories=10**4),  # tests/long/python/test_examples.py has the search
    compare=lambda: nysalt.compare(CHAIN, ["verlet", "srkn6b"], [0.01, 0.02], trajectories=10**6, horizon=5),
    slow_path=lambda: nysalt.learn(henon_heiles_by_functions(), "nystrom", step=0.4, horizon=40, trajectories=100))


@pytest.mark.parametrize("call", LONG)
def test_a_long_call_ends(call):
    began = time.monotonic()
    timer = threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        LONG[call]()
    assert time.monotonic() - began < 60  # alone it would take minutes; a block or a pass is done before it ends
    timer.join()


def test_a_handler_that_raises_nothing_ends_nothing():
    caught = []
    before = signal.signal(signal.SIGINT, lambda *_: caught.append(1))
    try:
        timer = threading.Timer(0.1, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        run = nysalt.run(CHAIN, "verlet", 1e-3, 2000, trajectories=16, sample_every=10**6)
        timer.join()
    finally:
        signal.signal(signal.SIGINT, before)
    assert caught and np.isfinite(run.values).all()


def longest_pause_of_another_thread(call):
    pauses, done = [], threading.Event()

    def tick():
        last = time.monotonic()
        while not done.is_set():
            time.sleep(0.005)
            now = time.monotonic()
            pauses.append(now - last)
            last = now

    other = threading.Thread(target=tick)
    other.start()
    began = time.monotonic()
    call()
    taken = time.monotonic() - began
    done.set()
    other.join()
    return max(pauses), taken


def test_the_lock_is_released():
    call = lambda: nysalt.run(CHAIN, "srkn6b", 1e-3, 400, trajectories=16, sample_every=10**6, threads=1)
    pause, taken = longest_pause_of_another_thread(call)
    assert pause < 0.5 * taken
    # What holds the lock stops the others: sorting is one call of C.
    numbers = np.random.default_rng(1).random(1_500_000).tolist()
    pause, taken = longest_pause_of_another_thread(numbers.sort)
    assert pause > 0.5 * taken


def test_a_second_ctrl_c_is_not_lost():
    timers = [threading.Timer(after, lambda: os.kill(os.getpid(), signal.SIGINT)) for after in (0.1, 0.15)]
    with pytest.raises(KeyboardInterrupt):  # the second
        for timer in timers:
            timer.start()
        try:
            nysalt.learn(CHAIN, "nystrom", step=0.02, horizon=50, trajectories=20, loss="state:5")
            pytest.fail("the call was not interrupted")
        except KeyboardInterrupt:
            for _ in range(500):  # 5 s at most: Python looks for signals after each call
                time.sleep(0.01)
    for timer in timers:
        timer.join()


LEAVING = """
import ctypes, sys, threading, time
import numpy as np

# Called last, after the destructors of nysalt's static objects and of its libraries': a process that gets there
# with a thread that still computes is found out.
libc = ctypes.CDLL(None)
libc.__cxa_atexit(libc.usleep, ctypes.c_void_p(500_000), None)
import nysalt

chain = nysalt.system("fpu")
springs = nysalt.hamiltonian("springs", dimension=1, potential=lambda q: 0.5 * q[0]**2, force=lambda q: -q,
                             starts=lambda seed, n: np.random.default_rng([seed, n]).normal(size=(2, 1)))
states = [np.tile(x, (100000, 1)) for x in nysalt.system("lennard_jones").starts(1)]

def energies():
    while True:
        nysalt.system("lennard_jones").energy(*states)

calls = dict(run=lambda: nysalt.run(chain, "verlet", 1e-3, 1e8, sample_every=10**9),
             learn=lambda: nysalt.learn(chain, "nystrom", step=0.02, trajectories=10**5),
             slow_path=lambda: nysalt.run(springs, "verlet", 1e-3, 1e8, sample_every=10**9),
             energies=energies)
thread = threading.Thread(target=calls["CALL"], daemon=True)
thread.start()
time.sleep(0.2)
assert thread.is_alive()
libc.fputs(b"written at the end", ctypes.c_void_p.in_dll(libc, "stdout"))  # C's own stream, which a pipe fills
sys.exit(3)
"""


@pytest.mark.parametrize("call", ["run", "learn", "slow_path", "energies"])
def test_python_may_end_during_a_call_of_another_thread(call):
    done = subprocess.run([sys.executable, "-c", LEAVING.replace("CALL", call)], capture_output=True, text=True,
                          timeout=600)
    assert (done.returncode, done.stdout, done.stderr) == (3, "written at the end", "")
