# SPDX-License-Identifier: BSL-1.0
"""The paper's claims: their rules, what is known without a computation, and a quick run of all."""
import json
import math
import pathlib
import subprocess
import sys

import numpy as np
import pytest

SOURCE = pathlib.Path(__file__).resolve().parents[3]
sys.path[:0] = [str(SOURCE / "bench/studies/paper"), str(SOURCE / "bench")]
import accuracy  # noqa: E402
import chain  # noqa: E402
import energies  # noqa: E402
import in_bath  # noqa: E402
import learning  # noqa: E402
import linear  # noqa: E402
from claims import Claim, Estimate, agrees, exponent, items, mean_of  # noqa: E402


def reproduce(*arguments, **how):
    return subprocess.run([sys.executable, "-B", SOURCE / "bench/studies/paper/reproduce.py", *arguments], capture_output=True,
                          text=True, check=False, **how)


def claims_of(folder, *arguments):
    done = reproduce("--quick", "--output", folder, *arguments)
    assert done.returncode == 0, done.stderr
    return json.loads((folder / "paper.json").read_text())


def must_be_whole(claims):
    for one in claims:
        assert all(one[key] for key in ("part", "exhibit", "place", "claim", "quantity", "ours", "verdict", "reason")), one
        assert one["verdict"] in ("reproduced", "not reproduced") or one["verdict"].startswith("depends on "), one
        assert one["command"] is None or one["command"].startswith("nysalt "), one
        assert "nan" not in one["ours"] and "inf " not in one["ours"], one


def test_linear_claims_have_known_verdicts():
    """What follows from formulas, derived in docs/theory-langevin-optimum.md, too; no seed matters."""
    known = {"b1* = 0.5": "depends on the weights of the loss", "independent of Omega": "depends on the weights of the loss",
             "independent of delta": "depends on how large the step is", "beta2 = 1 - beta1": "not reproduced",
             "sqrt(20/3)/omega": "reproduced", "sqrt(5/3)": "reproduced", "second window": "reproduced",
             "real parts": "not reproduced", "is enlarged": "depends on what is counted", "0.43 gamma": "depends on the step",
             "strong order is 1.5": "reproduced"}
    claims = items({"linear": [make() for make in linear.EXHIBITS]})
    must_be_whole(claims)
    assert len(claims) == len(known)
    found = {words: [one for one in claims if words in one["claim"]] for words in known}
    assert all(len(one) == 1 for one in found.values())
    for words, verdict in known.items():
        assert found[words][0]["verdict"].startswith(verdict), words
    assert "0.40058" in found["b1* = 0.5"][0]["ours"]
    assert found["sqrt(5/3)"][0]["ours"] == "1.2909944487"
    assert "-0.3770" in found["0.43 gamma"][0]["ours"]


def test_wrong_coefficients_reproduce_nothing(monkeypatch):
    """A scheme without beta2 has another limit and another order: the same claims must fail."""
    right = linear.two_stages_of
    monkeypatch.setattr(linear, "two_stages_of", lambda theta, h, force, q, p, beta_sum=0.5:
                        right((theta[0], 1.05 * theta[1]), h, force, q, p, 1.02 * beta_sum))
    verdicts = {one["claim"]: one["verdict"] for make in linear.EXHIBITS[1:3] for one in items({"": [make()]})}
    for claim in ("stable for delta <= sqrt(20/3)/omega at (0.5, 0.40)", "a second window 10 <= z <= 50/3 of z = delta^2 Omega"):
        assert verdicts[claim] == "not reproduced"


def test_verdicts_follow_from_readings():
    both, one, none = ({"a": a, "b": b} for a, b in ((True, True), (True, False), (False, False)))
    of = lambda holds: Claim("", "", "", holds, "rule", "the reading")  # noqa: E731
    assert (of(both).verdict, of(both).reason) == ("reproduced", "holds for a, b; rule")
    assert (of(one).verdict, of(one).reason) == ("depends on the reading", "holds for a; fails for b; rule")
    assert (of(none).verdict, of(none).reason) == ("not reproduced", "fails for a, b; rule")
    assert (of(True).verdict, of(False).verdict, of(False).reason) == ("reproduced", "not reproduced", "rule")


def test_numbers_agree_within_half_a_digit_and_two_errors():
    assert agrees(Estimate(0.405), 0.40, 0.01) and not agrees(Estimate(0.4051), 0.40, 0.01)
    assert agrees(Estimate(0.42, 0.0076), 0.40, 0.01) and not agrees(Estimate(0.42, 0.0074), 0.40, 0.01)
    assert str(Estimate(0.40231, 0.00042)) == "0.40231 +- 0.00042"
    assert str(Estimate(0.40231, math.nan)) == "0.40231"
    assert mean_of([1.0, 2.0, 3.0, math.nan]) == (2.0, 1 / math.sqrt(3))  # the deviation is 1


def test_exponents_and_thresholds_are_found_again():
    x = np.array([1.0, 2.0, 4.0, 8.0])
    assert abs(exponent(x, 3 * x**2).mean - 2) < 1e-14  # rounding
    gaps = [10.0, 20.0, 40.0]
    errors = [Estimate(1e-4 * g**2, 1e-6 * g**2) for g in gaps]
    at = accuracy.crossing(gaps, errors, 0.0625)
    assert abs(at.mean - 25) < 1e-12  # 1e-4 25^2, on a line of logarithms: rounding
    assert 0 < at.error < 0.25  # of 1 % in the errors at most half of it in the gap, which is 2 of slope
    assert accuracy.is_gap(at, 30, 5) and not accuracy.is_gap(at, 31, 5)
    assert accuracy.crossing(gaps, errors, 1.0) == (40, 0) and accuracy.crossing(gaps, errors, 1e-3) == (10, 0)
    assert accuracy.crossing(gaps, [*errors[:2], Estimate(math.inf)], 0.1) == (20, 10)


def test_members_are_found_again_by_least_squares():
    """Data of a member at its own step have it as their optimum, to rounding over its slope (some 1e-10), in both coordinates;
    data of another member do not."""
    rng = np.random.default_rng(1)
    q, p = rng.normal(0, 0.02, (5, 6)), rng.normal(0, 1, (5, 6))
    states = [np.hstack([q, p])]
    for _ in range(20):
        q, p = linear.two_stages_of((0.45, 0.43), 0.02, learning.force, q, p)
        states.append(np.hstack([q, p]))
    for coordinates in ("qp", "modes"):
        found = learning.fitted(np.stack(states, axis=1), 0.02, coordinates)
        assert [abs(a.mean - b) < 1e-8 for a, b in zip(found, (0.45, 0.43))] == [True, True]
        assert abs(found[0].mean - 0.5) > 1e-2


def test_force_and_scheme_are_those_of_the_library():
    q, p = chain.chain().starts(8)
    assert np.allclose(learning.force(q), chain.chain().force(q), rtol=1e-13, atol=1e-11)  # rounding of springs of 1250 q
    ours = np.hstack(linear.two_stages_of((0.45, 0.43), 0.02, learning.force, q, p))
    run = chain.follow(chain.chain(), chain.two_stages(0.45, 0.43), 0.02, 0.02, 0.02, 8, learning.STATE)
    assert np.allclose(ours, run[:, 1], rtol=1e-12, atol=1e-12)  # rounding, over two kicks
    other = chain.follow(chain.chain(), chain.two_stages(0.45, 0.42), 0.02, 0.02, 0.02, 8, learning.STATE)
    assert not np.allclose(ours, other[:, 1], rtol=1e-6)


def test_distances_of_energies_and_angles():
    I = np.array([[[1.0, 2.0, 1.0], [2.0, 1.0, 1.0], [math.nan] * 3]])
    reference = np.array([[[1.0, 2.0, 1.0], [1.0, 2.0, 1.0], [1.0, 2.0, 1.0]]])
    assert energies.energy_error(I, reference).tolist() == [[0.0, 0.5, 2.0]]
    assert abs(energies.angle_error(I, reference)[0, 1] - (math.atan(2**0.5) - math.atan(2**-0.5))) < 1e-15  # rounding


def test_autocorrelations_of_a_known_process():
    """x_{n+1} = x_n/2 + noise has rho(k) = 2^-k; M n/3 independent products give 5 standard errors of 0.01 each."""
    rng = np.random.default_rng(2)
    x = np.zeros((300, 120))
    x[:, 0] = rng.normal(0, math.sqrt(4 / 3), 300)
    for n in range(119):
        x[:, n + 1] = 0.5 * x[:, n] + rng.normal(0, 1, 300)
    x = np.vstack([x, np.full(120, math.nan)])  # a trajectory that diverged does not count
    assert np.abs(in_bath.autocorrelation(x, 4) - 0.5 ** np.arange(5)).max() < 0.05
    assert np.abs(in_bath.autocorrelation(rng.permuted(x, axis=1), 4)[1:]).max() < 0.05  # shuffled, they have none


def test_quick_runs_go_through_all_exhibits_and_write_them(tmp_path):
    document = claims_of(tmp_path)
    must_be_whole(document["items"])
    assert document["quick"] and {one["part"] for one in document["items"]} == {"linear", "deterministic", "langevin"}
    exhibits = {one["exhibit"] for one in document["items"]}
    assert len(exhibits) == 23 and len(document["items"]) == 57
    page = (tmp_path / "paper.md").read_text()
    assert "no weight" in page and all(f"### {exhibit}\n" in page for exhibit in exhibits)
    assert " cores" in document["made"]["machine"]
    for picture in ("parameters_against_omega", "accuracy_T_05", "energies_at_400", "law_distance"):
        assert "<svg" in (tmp_path / f"paper/{picture}.svg").read_text()


def test_threads_change_nothing_and_seeds_do(tmp_path):
    one = claims_of(tmp_path, "deterministic", "linear", "--threads", "1")["items"]
    assert claims_of(tmp_path, "linear", "deterministic", "--threads", "3")["items"] == one
    assert claims_of(tmp_path, "deterministic", "--seed", "2")["items"] != [x for x in one if x["part"] != "linear"]


@pytest.mark.parametrize("arguments, words", [
    (["quadratic"], "PART must be one of linear, deterministic, langevin, got 'quadratic'"), (["linear", "--quik"], "--quik"),
    (["linear", "--output", "/dev/null/results"], "--output must be a folder"),
    (["deterministic", "--quick", "--threads", "0"], "threads"), (["deterministic", "--quick", "--seed", "-1"], "seed")])
def test_bad_input_is_refused(arguments, words):
    done = reproduce(*arguments)
    assert done.returncode == 2 and words in done.stderr and "Traceback" not in done.stderr
