#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""The test folders that a change can reach, nearest first.

usage: changed.py REVISION

The change is all that differs from REVISION, files that git does not know yet included. A file of the product reaches
the tests of its own layer and of those above; a test file reaches its own folder; a page reaches tests of pages.
"""
import pathlib
import subprocess
import sys

# From the lowest layer to the highest: where a layer's files are, and its test folders. A path belongs to the longest
# beginning that fits, and what fits none (include/nysalt/word.hpp) to the second layer.
LAYERS = [
    (["include/nysalt/scalar"], ["scalars"]),
    (["include/nysalt", "src/nysalt", "cmake", "CMakeLists.txt"], ["core", "parallel", "static", "must_not_compile"]),
    (["include/nysalt/systems", "src/nysalt/systems", "include/nysalt/noise", "src/nysalt/noises",
      "include/nysalt/bath"], ["systems", "noises"]),
    (["include/nysalt/flow", "include/nysalt/method", "include/nysalt/famil", "src/nysalt/families",
      "src/nysalt/methods"], ["flows", "methods", "families"]),
    (["include/nysalt/derivatives", "src/nysalt/derivatives"], ["derivatives"]),
    (["include/nysalt/reference", "src/nysalt/references", "include/nysalt/ensemble", "src/nysalt/ensembles",
      "include/nysalt/flow_map_data", "src/nysalt/flow_map_data"], ["references", "ensembles", "data", "invariance"]),
    (["include/nysalt/losses", "src/nysalt/losses"], ["losses"]),
    (["include/nysalt/learn", "src/nysalt/learning", "include/nysalt/judgement", "src/nysalt/judgement"], ["learning"]),
    (["include/nysalt/analysis", "src/nysalt/analysis"], ["analysis"]),
    (["include/nysalt/hmc", "src/nysalt/sampling"], ["sampling"]),
    (["src/comparison", "src/report", "src/nysalt/exports", "share", "bench"], ["report", "bench", "parts_of_program"]),
    (["src/program", "src/plugin", "examples"], ["programs", "smoke", "faults", "inputs"]),
    (["python"], ["python"]),
]
PAGES = ["docs"]
OF_SCRIPTS = {"must_not_compile", "faults", "inputs"}  # folders whose tests are not files of their own


def layer_of(path):
    fitting = [(len(start), number) for number, (starts, _) in enumerate(LAYERS) for start in starts
               if path.startswith(start)]
    return max(fitting)[1] if fitting else None


def reached(paths, folders):
    """Of the folders that there are those that the paths reach, in the order in which they are tried."""
    own, lowest, pages = [], None, False
    for path in paths:
        parts = pathlib.PurePosixPath(path).parts
        if parts[0] == "tests" and len(parts) > 2:
            folder = "/".join(parts[1:3]) if parts[1] == "long" else parts[1]
            if folder in ("laws", "support"):
                lowest = 0
            else:
                own.append(folder)
            continue
        pages = pages or path.endswith((".md", ".bib"))
        layer = layer_of(path)
        if layer is not None:
            lowest = layer if lowest is None else min(lowest, layer)
    above = [folder for _, tests in LAYERS[lowest:] for folder in tests] if lowest is not None else []
    wanted = list(dict.fromkeys(own + above + (PAGES if pages or above else [])))
    return [folder for folder in wanted if folder in folders]


def main():
    root = pathlib.Path(__file__).resolve().parents[2]
    run = lambda *words: subprocess.run(["git", *words], cwd=root, capture_output=True, text=True, check=True).stdout
    paths = run("diff", "--name-only", sys.argv[1]).split() + run("ls-files", "--others", "--exclude-standard").split()
    folders = {str(file.parent.relative_to(root / "tests")) for kind in ("*_test.*", "test_*.py")
               for file in (root / "tests").rglob(kind)} | OF_SCRIPTS
    print("\n".join(reached(paths, folders)))


if __name__ == "__main__":
    main()
