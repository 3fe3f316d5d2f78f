#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""Puts what Doxygen reads into a folder, in the form that it understands: stage.py ROOT FOLDER [--headers]."""
import sys
from pathlib import Path

import headers


def stage_headers(root, folder):
    here = Path(__file__).parent
    members = headers.read_members((here / "members.txt").read_text())
    for header in sorted((root / "include").rglob("*.hpp")):
        path = header.relative_to(root)
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(headers.staged(header.read_text(), str(path.relative_to("include/nysalt")), members, {}))


if __name__ == "__main__":
    stage_headers(Path(sys.argv[1]).resolve(), Path(sys.argv[2]))
