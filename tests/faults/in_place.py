#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A program that breaks the promises which faults.py tries: it writes its output in place."""
import sys

try:
    with open(sys.argv[sys.argv.index("--output") + 1], "w") as file:
        file.write("a whole output")
except OSError as problem:
    print(f"in_place: {problem}", file=sys.stderr)
    sys.exit(2)
