#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""A program that breaks what worst_inputs.py looks for: memory, time, length of a refusal, exit code, each once."""
import sys
import time

command = sys.argv[1]
if command == "cite":
    memory = bytearray(1_200_000_000)
    memory[::4096] = b"1" * len(memory[::4096])
if command == "stability":
    while time.process_time() < 10.5:
        pass
if command == "export":
    print("nysalt: " + "a" * 3000, file=sys.stderr)
else:
    print("nysalt: refused", file=sys.stderr)
sys.exit(1 if command == "compare" else 2)
