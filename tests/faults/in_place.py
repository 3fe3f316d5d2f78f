#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A program that breaks the promises which faults.py tries: it writes its output in place, and not onto the disk."""
import sys

output = sys.argv[sys.argv.index("--output") + 1]
try:
    with open(output, "wb", buffering=0) as file:
        file.write(b"a whole output")
except OSError as problem:
    print(f"in_place: {problem}", file=sys.stderr)
    sys.exit(4)
