# SPDX-License-Identifier: BSL-1.0
"""The cost model that ./dev scaling fits, and what it makes of measurements."""
import json
import pathlib
import sys

import numpy as np
import pytest

sys.path[:0] = [str(pathlib.Path(__file__).resolve().parents[2] / "bench" / folder) for folder in ("scaling", "")]
import report  # noqa: E402
from report import Cost, Measured, Model, Reductions, bytes_of_pass, fitted_costs, largest_share_of, levels_over  # noqa: E402


def some_times(off):
    """y = 2e-9 x_0 + 3e-6 x_1, each a little off by a part that changes sign."""
    x = [[pairs, 1.0] for pairs in (1e3, 1e4, 1e5, 1e6) for _ in (0, 1)]
    return x, [(2e-9 * pairs + 3e-6) * (1 + off * (-1) ** i) for i, (pairs, _) in enumerate(x)]


def test_costs_are_found_again():
    exact = fitted_costs(*some_times(0.0))
    # Rounding alone, in columns of one size.
    assert abs(exact[0].value / 2e-9 - 1) < 1e-12 and abs(exact[1].value / 3e-6 - 1) < 1e-12
    rough = fitted_costs(*some_times(0.01))[0]
    assert abs(rough.value - 2e-9) < 3 * rough.error
    # Four pairs of times 1 % off tell the cost of a pair to some .01/sqrt(4).
    assert 0.003 * 2e-9 < rough.error < 0.03 * 2e-9


def test_no_cost_is_negative():
    # y falls with x_1, which would be the negative cost.
    found = fitted_costs([[1.0, 0.0], [1.0, 1.0], [2.0, 1.0]], [1.0, 0.9, 1.9])
    assert found[1].value == 0 and found[0].value > 0.9
    for x, y in (([[1.0, 0.0]], [1.0]), ([], [])):
        with pytest.raises(ValueError, match="too little"):
            fitted_costs(x, y)


SHARES = {  # of nysalt::shard, by trajectories, on 1, 2, 3, 7, 64 and 1000 ranks
    1: (1, 1, 1, 1, 1, 1), 17: (17, 16, 16, 16, 16, 16), 1000: (1000, 512, 336, 144, 16, 16),
    65536: (65536, 32768, 22016, 9472, 1024, 80), 100003: (100003, 50176, 33792, 14336, 1568, 112),
    10000019: (10000019, 5111808, 3342336, 1441792, 159744, 10240)}


def test_shares_are_those_of_shard():
    for total, shares in SHARES.items():
        assert tuple(largest_share_of(total, ranks) for ranks in (1, 2, 3, 7, 64, 1000)) == shares


def test_a_sum_takes_a_level_more_where_ranks_double():
    assert [levels_over(ranks) for ranks in (1, 2, 5, 10_000)] == [0, 1, 3, 14]
    assert bytes_of_pass(2) == 8 * 6 and bytes_of_pass(10) == 8 * 66
    costs = Reductions(Cost(0.5), Cost(), Cost(1.0), Cost(0.25))
    assert costs.seconds(1, 8.0) == 0.5 and costs.seconds(16, 8.0) == 0.5 + 4 * (1.0 + 2.0)


COSTS = {"kernel": 3e-9, "two-stage": 4e-9, "BAOAB": 2e-8, "data": 3e-7, "pass": 5e-8, "learn": 2e-6}  # of a trajectory-step


def write(folder, share_of=largest_share_of):
    """A machine of four cores that shares work without loss."""
    lines, noise = [], np.random.default_rng(1)
    for what, cost in COSTS.items():
        works = [("strong", 1, 1, 65536, 16), ("strong", 2, 1, 65536, 16), ("strong", 1, 2, 65536, 16), ("weak", 2, 1, 131072, 16),
                 *([] if what == "kernel" else [("size", 1, 1, 1024, 16), ("size", 1, 1, 4096, 64)])]
        for scaling, ranks, threads, trajectories, steps in works:
            share = share_of(trajectories, ranks)
            lines += [dict(what=what, scaling=scaling, ranks=ranks, threads=threads, trajectories=trajectories, steps=steps,
                           largest_share=share, seconds=cost * share * steps / threads * noise.uniform(0.99, 1.01))
                      for _ in range(9)]
    lines += [dict(what="reduction", ranks=ranks, cores=4, doubles=doubles, seconds=1e-6 * (1 + levels_over(ranks)), seconds_90=1e-5)
              for ranks in (1, 2, 4) for doubles in (1, 100) for _ in range(2)]
    lines += [dict(what="memory", ranks=1, trajectories=m, steps=n, share=m, bytes=3e7 + 400 * m * n + 90 * m)
              for m, n in ((2048, 16), (16384, 16), (65536, 1), (65536, 4))]
    lines.append(dict(what="row of text", seconds=1e-6, bytes=60.0))
    (folder / "all.jsonl").write_text("\n".join(map(json.dumps, lines)))


def test_a_page_has_what_was_put_into_the_measurements(tmp_path):
    write(tmp_path)
    measured = Measured(tmp_path)
    model = Model(measured)
    for what in ("two-stage", "BAOAB"):
        assert abs(model.of_steps[what][0].value / COSTS[what] - 1) < 0.01  # as each time is off by at most 1 %
    assert abs(model.passes() / (COSTS["learn"] / COSTS["pass"]) - 1) < 0.02
    assert [round(cost.value) for cost in model.memory] == [30_000_000, 400, 90]
    page = report.page(measured, model)
    verdicts = [line.split("|") for line in page.splitlines() if line.startswith(("| steps", "| making", "| pass", "| learn()"))][:5]
    assert [row[4].strip() for row in verdicts] == ["yes"] * 5
    assert "| strong  |     2 |" in page and "10^9 rows at rank 0" in page
    report.write_rows(tmp_path / "rows.csv", measured)
    rows = (tmp_path / "rows.csv").read_text().splitlines()
    assert len(rows) == 1 + 4 + 5 * 6 and rows[1].startswith("kernel,strong,1,1,65536,16,65536,9,")


def test_what_is_no_measurement_is_refused(tmp_path):
    with pytest.raises(ValueError, match="./dev scaling"):
        Measured(tmp_path)
    (tmp_path / "x.jsonl").write_text('{"what": "pass"}')
    with pytest.raises(ValueError, match="x.jsonl"):
        Measured(tmp_path)
    (tmp_path / "x.jsonl").unlink()
    write(tmp_path, lambda trajectories, ranks: trajectories)  # shares that no rank of nysalt has
    with pytest.raises(ValueError, match="largest share of 65536 trajectories on 2 ranks must be 32768"):
        Measured(tmp_path)
