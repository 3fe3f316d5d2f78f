# SPDX-License-Identifier: BSL-1.0
"""Ctrl-C ends a search of minima. Tier 1 has data, runs and comparisons: tests/python/test_interrupt.py."""
import os
import signal
import threading
import time

import nysalt
import pytest


def test_a_long_search_ends():
    began = time.monotonic()
    timer = threading.Timer(0.4, lambda: os.kill(os.getpid(), signal.SIGINT))
    timer.start()
    with pytest.raises(KeyboardInterrupt):  # few data, a long search
        nysalt.learn(nysalt.system("fpu"), "fg4", step=0.03, trajectories=50, random_starts=10000)
    assert time.monotonic() - began < 60  # it would take minutes; a pass over the starts is done before it ends
    timer.join()
