#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Runs a command and appends a line to a file: its CPU seconds, its peak memory in MB, and what it compiles.

usage: cost.py FILE COMMAND [ARGUMENT]...
"""
import os
import subprocess
import sys


def run(command, **options):
    """The exit status, CPU seconds and peak MB of a command, those of its children included."""
    process = subprocess.Popen(command, **options)
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024


def main():
    path, *command = sys.argv[1:]
    code, seconds, peak = run(command)
    if code == 0 and "-c" in command:
        with open(path, "a", encoding="utf-8") as file:
            file.write(f"{command[command.index('-c') + 1]}: {seconds:.1f} s CPU, {peak:.0f} MB\n")
    sys.exit(code)


if __name__ == "__main__":
    main()
