# SPDX-License-Identifier: BSL-1.0
"""Tables in Markdown and pictures by gnuplot, for all pages that benchmarks and studies write."""
import dataclasses
import math
import pathlib
import subprocess
from typing import List, Sequence

COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")  # told apart by all eyes


def processor():
    """The name of this machine's processor."""
    try:
        lines = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
        return next(line.split(": ")[1].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration, IndexError):
        return "unknown processor"


def markdown(columns, rows, left=1):
    """A table with aligned columns; the first `left` of them are texts, at the left."""
    cells = [[str(cell).replace("|", "\\|") for cell in row] for row in [columns, *rows]]
    widths = [max(3, *map(len, column)) for column in zip(*cells)]
    sides = [str.ljust if i < left else str.rjust for i in range(len(widths))]
    lines = ["| " + " | ".join(side(c, w) for side, c, w in zip(sides, row, widths)) + " |" for row in cells]
    lines.insert(1, "| " + " | ".join("-" * w if i < left else "-" * (w - 1) + ":" for i, w in enumerate(widths)) + " |")
    return "\n".join(lines) + "\n"


@dataclasses.dataclass
class Curve:
    """Points with standard errors, where there are any; those that are not finite are left out."""
    label: str
    x: Sequence[float]
    y: Sequence[float]
    error: Sequence[float] = ()
    bold: bool = False
    dashed: bool = False


@dataclasses.dataclass
class Panel:
    """Axes with curves; `log` names the logarithmic ones, "x", "y" or "xy"."""
    title: str
    x: str
    y: str
    curves: List[Curve]
    log: str = ""
    y_range: str = "[*:*]"


def _data(curve):
    errors = list(curve.error) or [0.0] * len(curve.x)
    points = [p for p in zip(curve.x, curve.y, errors) if all(map(math.isfinite, p[:2]))]
    return "".join(f"{x:.10g} {y:.10g} {e if math.isfinite(e) else 0:.10g}\n" for x, y, e in points)


def _drawn(curve, block, colour):
    marks = f"lc '{colour}' lw {2.5 if curve.bold else 1.5} dt {2 if curve.dashed else 1}"
    points = "" if curve.dashed or len(curve.x) > 100 else " pt 7 ps 0.5"
    title = curve.label.replace("'", "''")
    lines = [f"{block} using 1:2 with {'linespoints' if points else 'lines'} {marks}{points} title '{title}'"]
    if len(curve.error):
        lines.append(f"{block} using 1:2:3 with yerrorbars {marks} ps 0 notitle")
    return lines


def _script(panels, columns):
    """What gnuplot draws: panels in rows of `columns`."""
    blocks, plots = [], []
    for panel in panels:
        elements = []
        for curve in panel.curves:
            points = _data(curve)
            if not points:
                continue
            block = f"$curve{len(blocks)}"
            blocks.append(f"{block} << end\n{points}end\n")
            elements += _drawn(curve, block, COLOURS[panel.curves.index(curve) % len(COLOURS)])
        plots.append(f"set title '{panel.title}'\nset xlabel '{panel.x}'\nset ylabel '{panel.y}'\nunset logscale\n"
                     + (f"set logscale {panel.log}\n" if panel.log else "") + f"set yrange {panel.y_range}\n"
                     + "plot " + ", \\\n  ".join(elements) + "\n")
    layout = f"set multiplot layout {-(-len(panels) // columns)},{columns}\n"
    return "".join(blocks) + layout + "".join(plots)


def draw(file, panels, width=1200, height=520):
    """Panels side by side into FILE.svg, with the script and its data in FILE.gp. False if gnuplot is not there or fails."""
    return draw_script(file, "set format '%g'\nset key outside top center horizontal\n" + _script(panels, len(panels)), width, height)


def draw_script(file, script, width, height):
    """A script of gnuplot's own, as `draw` does it."""
    head = f"set terminal svg size {width},{height} background 'white' font 'sans,13' noenhanced\n"
    path = pathlib.Path(file).resolve()
    path.with_suffix(".gp").write_text(f"{head}set output '{path.name}.svg'\nset grid lw 0.5 lc '#cccccc'\n{script}",
                                       encoding="utf-8")
    try:
        return subprocess.run(["gnuplot", f"{path.name}.gp"], cwd=path.parent, check=False).returncode == 0
    except FileNotFoundError:
        return False
