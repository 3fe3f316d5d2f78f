#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A program that breaks the promises which faults.py tries: it writes its output in place, and once more by a new file that
is not put on the disk before it is renamed."""
import os
import sys

output = sys.argv[sys.argv.index("--output") + 1]
try:
    with open(output, "wb", buffering=0) as file:
        file.write(b"a whole output")
    with open(output + ".new", "wb", buffering=0) as file:
        file.write(b"a whole output")
    os.rename(output + ".new", output)
except OSError as problem:
    print(f"in_place: {problem}", file=sys.stderr)
    sys.exit(4)
