#!/usr/bin/env python3
# SPDX-License-Identifier: BSL-1.0
"""What bounds the two-stage step of an ensemble: operations, ports and latencies, counted in the assembly.

usage: bench/ports.py [CPU...]

The loop over stages (a kick and a drift, of two registers for each number) is compiled by each compiler that is there, and
its cycles are estimated by llvm-mca for each CPU, a name as -mcpu takes it [znver4 icelake-server]. The ports bound a stage by
(operations that one kind of unit serves)/(such units); the data bound it by the longest chain of latencies. Beside them
stands what was measured: `./dev bench`, ns of "ours" in the race "ensemble", and the frequency of the processor.
"""
import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[1]
FLAGS = ["-std=c++20", "-O3", "-DNDEBUG", "-march=native", "-ffp-contract=off", "-DNYSALT_BENCH_CONTRACTION=off", "-I",
         str(ROOT / "include"), "-I", str(ROOT / "bench/peers"), "-isystem", "/usr/include/eigen3"]
MULTIPLICATIONS = ADDITIONS = 46  # of a stage, for two registers: half of those of roofs.hpp, twice


def assembly(compiler, folder):
    output = folder / f"{compiler}.s"
    extra = ["-fno-tree-slp-vectorize"] if compiler == "g++" else []
    subprocess.run([compiler, *FLAGS, *extra, "-S", str(ROOT / "bench/peers/ours.cpp"), "-o", str(output)], check=True)
    return output.read_text().splitlines()


def innermost_loop(lines):
    """The first loop with as many multiplications and additions as a stage."""
    begins = {}
    for at, line in enumerate(lines):
        if label := re.match(r"(\.L\w+):", line):
            begins[label[1]] = at
        jump = re.match(r"\s+j\w+\s+(\.L\w+)", line)
        if not jump or jump[1] not in begins:
            continue
        body = [text for text in lines[begins[jump[1]] + 1:at + 1] if re.match(r"\s+[a-z]", text)]
        if (sum("mulpd" in text for text in body) == MULTIPLICATIONS and
                sum("addpd" in text or "subpd" in text for text in body) == ADDITIONS):
            return body
    sys.exit("ports.py: no loop with 46 multiplications and 46 additions was found: has the step changed?")


def for_analysis(body):
    """Labels and constants by names that the assembler knows."""
    text = "\n".join(body)
    text = re.sub(r"\.L\w+\(%rip\)", "8(%rip)", text)
    return "stage:\n" + re.sub(r"(\tj\w+\s+)\.L\w+", r"\1stage", text) + "\n"


def analysed(body, cpu, folder):
    tool = next((name for name in ("llvm-mca", *(f"llvm-mca-{n}" for n in range(21, 13, -1)))
                 if shutil.which(name) and f" {cpu} " in subprocess.run(
                     [name, "-mcpu=help", "/dev/null"], capture_output=True, text=True).stderr), None)
    if tool is None:
        return None
    source = folder / "loop.s"
    source.write_text(for_analysis(body))
    done = subprocess.run([tool, f"-mcpu={cpu}", "-iterations=200", "-json", str(source)], capture_output=True, text=True,
                          check=True)
    region = json.loads(done.stdout)["CodeRegions"][0]
    summary = region["SummaryView"]
    return tool, summary["TotalCycles"] / summary["Iterations"], summary["BlockRThroughput"]


def main():
    cpus = sys.argv[1:] or ["znver4", "icelake-server"]
    print("| compiler | for | instructions | spills | ports, cycles a stage | llvm-mca, cycles a stage | by |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        for compiler in ("g++", "clang++"):
            if not shutil.which(compiler):
                continue
            body = innermost_loop(assembly(compiler, folder))
            spills = sum("(%rsp" in text for text in body)
            for cpu in cpus:
                found = analysed(body, cpu, folder)
                if found is None:
                    print(f"| {compiler} | {cpu} | {len(body)} | {spills} | no llvm-mca here knows it | | |")
                    continue
                tool, cycles, ports = found
                print(f"| {compiler} | {cpu} | {len(body)} | {spills} | {ports:.1f} | {cycles:.1f} | {tool} |")


if __name__ == "__main__":
    main()
