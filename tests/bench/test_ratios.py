# SPDX-License-Identifier: BSL-1.0
"""What ./dev bench concludes from what was measured."""
import json
import pathlib
import sys

import pytest

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "bench"))
from pages import markdown  # noqa: E402
from ratios import COLUMNS, LARGEST_SPREAD, Growth, Judged, Measurements, Row, paired_ratio  # noqa: E402


def document_of(runners, race="race"):
    """As google-benchmark writes it: an entry a round, and aggregates behind."""
    rounds = [{"name": f"{race}/iterations:1/manual_time", "run_type": "iteration",
               **{f"ns/{name}": times[i] for name, times in runners.items()}} for i in range(len(next(iter(runners.values()))))]
    return {"context": {"num_cpus": 2},
            "benchmarks": [*rounds, {"name": f"{race}/mean", "run_type": "aggregate", "ns/ours": 1e9, "ns/peer": 1.0}]}


def read(document):
    result = Measurements()
    result.add(document)
    return result


def measured(**runners):
    return read(document_of({name.replace("_", " "): times for name, times in runners.items()}))


def times_of(value, scatter=0.0):
    return [value * (1 + scatter * (i / 19 - 0.5)) for i in range(20)]


STEADY = times_of(1.0)


def speed_of_ours(bound, **more):
    return Row("speed", "race", "ours", more.pop("against", ("peer",)), bound, **more)


def time_of_ours(bound):
    return Row("time", "race", "ours", ("peer",), bound, speed=False)


def test_a_ratio_holds_or_does_not():
    both = measured(ours=STEADY, peer=times_of(2.0))
    assert Judged(speed_of_ours(1.9), both).holds is True and Judged(speed_of_ours(2.1), both).holds is False
    assert Judged(time_of_ours(0.6), both).holds is True and Judged(time_of_ours(0.4), both).holds is False
    assert Judged(speed_of_ours(1.9), both).found.value == 2.0 and Judged(time_of_ours(0.6), both).found.value == 0.5
    # The fastest peer counts.
    found = Judged(speed_of_ours(2.0, against=("slow", "quick")), measured(ours=STEADY, slow=times_of(3.0), quick=times_of(1.5)))
    assert found.against == "quick" and found.holds is False


def test_pairs_of_a_round_belong_together():
    """The machine slows down to a third, both slow down alike: the ratio stays 2 in every pair."""
    ours = [1.0 + 0.1 * i for i in range(20)]
    found = Judged(speed_of_ours(1.99), measured(ours=ours, peer=[2 * x for x in ours]))
    assert found.found.spread == 0 and found.holds is True


def test_too_noisy_to_say_is_said_with_a_reason():
    """20 values from 1.9 to 2.1 at equal distances; the fifth from either end, 1.942 and 2.058, bound the interval."""
    noisy = measured(ours=STEADY, peer=times_of(2.0, 0.1))
    for bound in (1.99, 2.01):
        found = Judged(speed_of_ours(bound), noisy)
        assert found.holds is None and "too noisy" in found.reason
        assert found.document()["holds"] is None and found.document()["reason"] == found.reason
    assert Judged(speed_of_ours(1.94), noisy).holds is True and Judged(speed_of_ours(2.06), noisy).holds is False
    # From 1 to 3, the quartiles half of the median apart: beyond a spread every pair must agree.
    wide = measured(ours=STEADY, peer=times_of(2.0, 1.0))
    assert Judged(speed_of_ours(1.0), wide).found.spread > LARGEST_SPREAD
    assert [Judged(speed_of_ours(bound), wide).holds for bound in (0.9, 1.2, 3.1)] == [True, None, False]


def test_the_interval_holds_the_median_with_95_percent():
    found = paired_ratio(list(range(1, 42)), [1.0] * 41)
    # From the 14th to the 28th: P(14 <= Binomial(41, 1/2) <= 27) = 0.972; one less on either side is 0.940.
    assert (found.value, found.low, found.high) == (21, 14, 28)
    assert paired_ratio([3.0], [2.0]).low == 1.5
    with pytest.raises(ValueError, match="pairs"):
        paired_ratio([1.0], [])


def test_a_machine_that_cannot_show_it_is_no_failure():
    row = speed_of_ours(1.8, premise=("kernel two", "kernel one", 1.9, "not quiet"))

    def with_kernel(gain, ours):
        return Judged(row, measured(peer=times_of(ours), ours=STEADY, kernel_one=times_of(gain), kernel_two=STEADY))

    assert with_kernel(2.0, 1.5).holds is False
    assert with_kernel(1.5, 1.5).holds is None and "not quiet" in with_kernel(1.5, 1.5).reason
    assert with_kernel(1.5, 1.9).holds is True  # what was reached was reached


def test_growth_counts_until_memory_bounds_it():
    growth = Growth("growth", "race", ("1", "10", "100"), "stream ", 1024.0)
    times = {"1": times_of(1.0), "10": times_of(1.2), "100": times_of(2.0), "stream 10": times_of(0.5), "stream 100": times_of(0.9)}

    def judged():
        return Judged(growth.row(read(document_of(times))), read(document_of(times)))

    assert judged().holds is False and judged().found.value == 2.0  # nothing to excuse it
    times["stream 100"] = times_of(1.1)
    assert judged().holds is True and judged().found.value == 1.2
    assert judged().row.note == "memory bound from 100 on, where the state takes 100 kB"
    times["stream 10"] = times_of(1.0)
    assert judged().found.value == 1.0


def test_all_files_of_a_compiler_count(tmp_path):
    for name, times in (("g++.1", [1.0, 2.0]), ("g++.2", [3.0]), ("clang++.1", [4.0])):
        (tmp_path / f"{name}.json").write_text(json.dumps(document_of({"ours": times})))
    (tmp_path / "g++.2.log").write_text("no JSON")

    def of(compiler):
        return Measurements.of_compiler(tmp_path, compiler).times("race", "ours")

    assert of("g++") == [1.0, 2.0, 3.0] and of("clang++") == [4.0]
    with pytest.raises(ValueError, match="./dev bench"):
        of("icc")
    (tmp_path / "g++.3.json").write_text("{")
    with pytest.raises(ValueError, match=r"g\+\+.3.json holds no JSON"):
        of("g++")


def test_the_document_says_all_that_the_table_says():
    found = Judged(speed_of_ours(1.9), measured(ours=STEADY, peer=times_of(2.0)), measured(ours=STEADY, peer=times_of(3.0)))
    document = found.document()
    assert [document[key] for key in ("name", "value", "target", "relation", "holds", "pairs")] == ["speed", 2, 1.9, ">=", True, 20]
    assert "reason" not in document and document["clang++"]["value"] == 3.0
    line = markdown(COLUMNS, [found.cells()]).splitlines()[2]
    assert [cell.strip() for cell in line.split("|")[1:-1]] == ["speed", ">= 1.9", "yes", "2", "2 - 2", "3", "3 - 3"]


def test_what_is_no_measurement_is_refused():
    with pytest.raises(ValueError, match="no benchmarks"):
        read([])
    with pytest.raises(ValueError, match="no time"):
        measured(ours=[0.0])
    missing = document_of({"ours": STEADY, "peer": STEADY})
    del missing["benchmarks"][3]["ns/peer"]
    with pytest.raises(ValueError, match="peer missed a round"):
        read(missing)
    failed = document_of({"ours": STEADY})
    for entry in failed["benchmarks"]:
        entry.update(error_occurred=True, error_message="fell over")
    with pytest.raises(ValueError, match="fell over"):
        Judged(speed_of_ours(1.0), read(failed))
    with pytest.raises(ValueError, match="'peer'"):
        Judged(speed_of_ours(1.0), measured(ours=STEADY))
