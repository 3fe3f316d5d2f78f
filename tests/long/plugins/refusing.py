#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A program that breaks what new_formula.py tries: of processes that compile at once all but one are refused."""
import fcntl
import os
import sys
import time

cache = os.environ["XDG_CACHE_HOME"]
os.makedirs(cache, exist_ok=True)
with open(os.path.join(cache, "formula.hpp"), "w", encoding="utf-8") as source:
    try:
        fcntl.flock(source, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        sys.exit("cannot write formula.hpp: another process writes it")
    time.sleep(2)  # the compiler
with open(sys.argv[sys.argv.index("--output") + 1], "w", encoding="utf-8") as table:
    table.write("1\n")
