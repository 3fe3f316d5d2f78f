"""Runs a command, and appends a line to LOG: what it makes, the CPU-seconds it took, and its peak memory in MB.

usage: measured.py LOG WHAT COMMAND...
"""
import os
import sys

log, what, *command = sys.argv[1:]
_, status, used = os.wait4(os.posix_spawnp(command[0], command, os.environ), 0)
with open(log, "a", encoding="utf-8") as out:
    out.write(f"{what} {used.ru_utime + used.ru_stime:.2f} {used.ru_maxrss / 1024:.0f}\n")
sys.exit(os.waitstatus_to_exitcode(status) & 255)
