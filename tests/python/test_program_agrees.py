# SPDX-License-Identifier: BSL-1.0
"""Documents, samples, scheme files and exported methods are those of the program."""
import json
import pathlib
import warnings

import numpy as np
import pytest

import nysalt
from conftest import without_times


def test_what_there_is_is_what_list_prints(program):
    listed = program("list")
    for kind, function in (("systems", nysalt.systems), ("methods", nysalt.methods),
                           ("families", nysalt.families), ("metrics", nysalt.metrics)):
        assert [{"name": name, **facts} for name, facts in function().items()] == listed[kind]


DOCUMENTS = [
    (lambda: nysalt.learn(nysalt.system("fpu", omega=30, friction=0.01, sigma=0.05), "nystrom", step=0.02, trajectories=10,
                          horizon=0.2, placement="end", fix={"b1": 0.5}).fit,
     "learn --system fpu --family nystrom --omega 30 --friction 0.01 --sigma 0.05 --step 0.02 --trajectories 10 --horizon 0.2 "
     "--placement end --fix b1=0.5"),
    (lambda: nysalt.compare(nysalt.system("henon_heiles"), ["verlet", "srkn6b", "learned:nystrom"], [0.05, 0.1],
                            equal_cost=True, horizon=4, trajectories=20, metric=["path:energy", "state"], learn_horizon=4,
                            learn_trajectories=10, levels=[1e-3]),
     "compare --system henon_heiles --methods verlet,srkn6b,learned:nystrom --steps 0.05,0.1 --equal-cost --horizon 4 "
     "--trajectories 20 --metric path:energy,state --learn-horizon 4 --learn-trajectories 10 --levels 1e-3"),
    (lambda: nysalt.compare(nysalt.system("henon_heiles", frequency=0.9), steps=0.02, equal_cost=True, horizon=3,
                            trajectories=4, metric="state"),  # all methods that apply
     "compare --system henon_heiles --frequency 0.9 --steps 0.02 --equal-cost --horizon 3 --trajectories 4 --metric state"),
]


@pytest.mark.parametrize("call, line", DOCUMENTS)
def test_a_document_is_that_of_the_program(program, call, line):
    documents = [program(*line.split(), "--seed", seed) for seed in "12"]
    found = without_times(call())
    for one in (found, *documents):
        one.pop("output", None)
    assert [without_times(one) == found for one in documents] == [True, False]


@pytest.mark.parametrize("step, count", [(1e-17, 1), (0.1, 0)])
def test_warnings_of_a_run_are_those_of_the_program(program, step, count):
    """Of motion that is lost in rounding."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        found = nysalt.run(nysalt.system("henon_heiles"), "verlet", step, 8 * step).warnings
    document = program(*f"run --system henon_heiles --method verlet --step {step} --horizon {8 * step}".split())
    assert found == document["warnings"] == [str(one.message) for one in caught]
    assert len(found) == count and all("is lost in rounding" in one for one in found)


def test_a_curve_is_that_of_the_program(program):
    curve = nysalt.learn(nysalt.system("oscillator"), "nystrom", steps=[0.02, 0.03], trajectories=10, coordinates="energy")
    fits = program("learn", "--family", "nystrom", "--system", "oscillator", "--steps", "0.02,0.03", "--trajectories", "10",
                   "--coordinates", "energy")["fits"]
    assert without_times(curve.fit["fits"]) == without_times(fits)
    assert curve.theta.shape == (2, 2) and curve.step == [0.02, 0.03]
    for n, step in enumerate(curve.step):
        assert curve.parameters["beta1"][n] == fits[n]["parameters"]["beta1"]
        assert curve.coefficients(step).sum() == pytest.approx(2, abs=1e-14)  # drifts and kicks, a few roundings
    assert not np.array_equal(curve.coefficients(0.02), curve.coefficients(0.03))


def test_a_judgement_is_that_of_the_program_and_of_a_run(program):
    pendulum = nysalt.system("pendulum")
    for step, verdict in ((0.1, "good"), (2.5, "unstable")):
        found = nysalt.judge(pendulum, "verlet", step)
        assert found["verdict"] == verdict
        assert found == program("stability", "--system", "pendulum", "--method", "verlet", "--step", str(step))["judgement"]
    with pytest.warns(UserWarning, match="unstable"):
        ran = nysalt.run(pendulum, "verlet", step=2.5, horizon=250)
    assert ran.judgement == found and ran.energy_error > found["kinetic_energy"]
    assert nysalt.run(pendulum, "verlet", step=0.1, horizon=1).energy_error < 0.1


def test_a_run_without_checks_has_the_same_numbers_and_says_so(program):
    pendulum = nysalt.system("pendulum")
    checked = nysalt.run(pendulum, "verlet", step=0.1, horizon=10)
    with pytest.warns(UserWarning, match="checks are left out"):
        ran = nysalt.run(pendulum, "verlet", step=0.1, horizon=10, checks=False)
    assert np.array_equal(ran.values, checked.values)
    assert (checked.judgement["verdict"], ran.judgement["verdict"]) == ("good", "not tried")
    with pytest.warns(UserWarning, match="not tried"):  # it would have been unstable
        nysalt.run(pendulum, "verlet", step=2.5, horizon=25, checks=False)
    with pytest.raises(ValueError, match="checks must be True or False"):
        nysalt.run(pendulum, "verlet", step=0.1, horizon=10, checks=1)


def test_a_recommendation_is_the_document_of_the_program(program, tmp_path):
    pendulum = nysalt.system("pendulum")
    found, method = nysalt.recommend(pendulum, 2, budget=4, families="nystrom", trajectories=8, learn_trajectories=5,
                                     output=tmp_path / "best.json")
    of_program = program("recommend", "--system", "pendulum", "--horizon", "2", "--budget", "4", "--families",
                         "nystrom", "--trajectories", "8", "--learn-trajectories", "5")
    for one in (found, of_program):
        one.pop("output")
        one.pop("advice")  # it tells of seconds
    assert without_times(found) == without_times(of_program)
    assert isinstance(method, nysalt.Scheme if found["verdict"] == "learned" else nysalt.Table)
    kept = nysalt.load(tmp_path / "best.json")
    assert kept.document == method.document
    step = next(row["step_size"] for row in found["rows"] if row["method"] == found["best_classical"])
    assert found["verdict"] == "learned" or kept.document["step"] == step
    (row,) = nysalt.compare(pendulum, kept, step, horizon=12 * step, trajectories=4)["rows"]
    assert row["error"] > 0.0


def test_a_fit_of_a_comparison_is_a_scheme(program):
    pendulum = nysalt.system("pendulum")
    few = dict(horizon=4, trajectories=4)
    found = nysalt.compare(pendulum, "learned:bab2", 0.4, learn_trajectories=4, learn_effort="quick", **few)
    scheme = nysalt.learn(pendulum, "bab2", step=0.4, trajectories=4, effort="quick")
    assert found["schemes"] == [scheme.document]
    assert nysalt.compare(pendulum, scheme, 0.4, **few)["rows"][0]["error"] == found["rows"][0]["error"]
    other = nysalt.learn(pendulum, "bab2", step=0.4, trajectories=4, effort="quick", purpose="energy")
    assert nysalt.compare(pendulum, other, 0.4, **few)["rows"][0]["error"] != found["rows"][0]["error"]


RUNS = [
    (dict(name="oscillator", friction=0.01, sigma=0.05), "--system oscillator --friction 0.01 --sigma 0.05", "baoab", 0.01,
     40.0, 37, 70, ["energy", "q1", "p1"]),  # noise, and several blocks of lanes
    (dict(name="henon_heiles", spread=2.5), "--system henon_heiles --spread 2.5", "verlet", 0.3, 600.0, 40, 7,
     ["energy", "q2"]),  # some diverge
]


@pytest.mark.parametrize("system, options, method, step, horizon, trajectories, every, observables", RUNS)
def test_samples_are_those_of_the_program(program, tmp_path, system, options, method, step, horizon, trajectories,
                                          every, observables):
    run = nysalt.run(nysalt.system(**system), method, step, horizon, trajectories=trajectories, sample_every=every,
                     observables=observables, threads=2)
    asked = ["run", *options.split(), "--method", method, "--step", str(step), "--horizon", str(horizon), "--trajectories",
             str(trajectories), "--sample-every", str(every), "--observables", ",".join(observables)]
    program(*asked, "--output", "run.npy")
    values = np.load(tmp_path / "run.npy")
    assert np.array_equal(run.values, values, equal_nan=True)
    of_table = program(*asked)
    lost = {one["trajectory"]: one["step"] for one in of_table["diverged"]}
    assert {int(m): int(run.diverged[m]) for m in np.flatnonzero(run.diverged >= 0)} == lost
    assert np.isnan(run.values[:, -1, 0]).sum() == len(lost)
    times = [row[2] for row in of_table["rows"] if row[0] == 0]
    assert times == run.t[:len(times)].tolist()
    assert run.evaluations == of_table["evaluations"] and run.starts == of_table["starts"]
    assert np.array_equal(run[observables[1]], run.values[:, :, 1], equal_nan=True)

    other = nysalt.run(nysalt.system(**system), method, step, horizon, trajectories=trajectories, sample_every=every,
                       observables=observables, seed=2)
    assert not np.array_equal(other.values, values, equal_nan=True)


def test_scheme_files_go_both_ways(program, tmp_path):
    chain = nysalt.system("fpu")
    scheme = nysalt.learn(chain, "nystrom", step=0.02, trajectories=10)
    mine, theirs = tmp_path / "mine.json", tmp_path / "theirs.json"
    scheme.save(mine)
    program("learn", "--system", "fpu", "--family", "nystrom", "--step", "0.02", "--trajectories", "10", "--output", "theirs.json")
    whole = json.loads(theirs.read_text())
    assert whole["provenance"]["seed"] == 1  # the program's alone: a caller of the module has no command line
    loaded = nysalt.load(theirs)
    assert isinstance(loaded, nysalt.Scheme) and loaded.parameters == scheme.parameters and loaded.fit is None
    assert loaded.document == whole
    del whole["provenance"]
    assert scheme.document == whole == json.loads(mine.read_text())

    program("run", "--system", "fpu", "--method", "mine.json", "--step", "0.02", "--horizon", "1", "--output", "run.npy")
    values = np.load(tmp_path / "run.npy")
    for method in (scheme, loaded, str(mine)):
        assert np.array_equal(nysalt.run(chain, method, 0.02, 1).values, values)
    with pytest.raises(ValueError, match=r"must run at the step 0.02, for which it was learned, got 0.03; learn it there, or take force=True"):
        nysalt.run(chain, scheme, 0.03, 1)
    with pytest.warns(UserWarning, match=r"used all the same \(force=True\)"):
        nysalt.run(chain, scheme, 0.03, 1, force=True)


def test_tables_are_read(program, tmp_path):
    table = tmp_path / "mine.json"
    table.write_text(json.dumps({"format": "nysalt table", "version": 1, "name": "leapfrog", "letters": "BAB",
                                 "coefficients": [0.5, 1.0, 0.5]}))
    loaded = nysalt.load(table)
    assert isinstance(loaded, nysalt.Table) and loaded.order == 2 and loaded.letters == "BAB"
    system = nysalt.system("pendulum")
    assert np.array_equal(nysalt.run(system, loaded, 0.1, 5).values, nysalt.run(system, "verlet", 0.1, 5).values)
    table.write_text(table.read_text().replace("1.0", "0.9"))
    with pytest.raises(ValueError, match="it is not consistent"):
        nysalt.load(table)


def test_an_unusable_fit_is_said_to_be_one(program, tmp_path):
    # Both kicks in the middle of the step: Verlet again, unstable at z = 2.5, and nothing is left to learn.
    fit = nysalt.learn(nysalt.system("fpu"), "nystrom", step=0.05, trajectories=3, fix={"b1": 0.5, "beta1": 0.25})
    assert not fit.usable and fit.reason
    with pytest.raises(ValueError, match="it is not usable"):
        fit.save(tmp_path / "fit.json")
    fit.save(tmp_path / "fit.json", force=True)
    assert nysalt.load(tmp_path / "fit.json").reason == fit.reason
    with pytest.raises(ValueError, match="must have a usable fit"):
        nysalt.run(nysalt.system("fpu"), fit, 0.05, 1)


def module_of(text):
    found = {"__name__": "exported"}
    exec(compile(text, "exported", "exec"), found)
    return found


def test_a_text_is_that_of_the_program(program):
    for host in ("c", "python", "mici"):
        assert nysalt.export("srkn6b", host) == program("export", "srkn6b", "--to", host)["text"]
    assert nysalt.export("chin4a", "c", displaced=True) == program("export", "chin4a", "--to", "c", "--displaced")["text"]


def test_a_text_by_a_template_is_that_of_the_program(program):
    unrolled = pathlib.Path(__file__).parents[2] / "examples" / "unrolled.c.in"
    text = nysalt.export("srkn6b", template=unrolled)
    assert text == program("export", "srkn6b", "--template", str(unrolled))["text"]
    assert "static void srkn6b_step(" in text
    assert nysalt.export("baoab", template=str(unrolled)) != text


def test_a_learned_method_steps_as_here():
    system = nysalt.system("henon_heiles")
    scheme = nysalt.learn(system, "bab3", step=0.6, trajectories=20, effort="quick")
    exported = module_of(nysalt.export(scheme, "python"))
    assert exported["self_test"]() < 1e-13
    q, p = (np.array(x) for x in system.starts(5))
    here = nysalt.integrate(system, scheme, 0.6, q, p, 20)
    exported["steps"](q, p, 0.6, 20, system.force)
    # 20 steps of 7 letters, each rounded to 2^-53 of numbers below 1; orbits part by less than 100 meanwhile.
    assert np.abs(here[0] - q).max() < 1e-12 and np.abs(here[1] - p).max() < 1e-12
    exported["steps"](q, p, 0.6, 1, system.force)
    assert np.abs(here[0] - q).max() > 1e-3


@pytest.mark.parametrize("method, first", [("srkn6b", 1), ("verlet", 1), ("mclachlan2", 0)])
def test_evaluations_are_those_of_the_header(method, first):
    text = nysalt.export(method, "python")
    told = int(text.split("first and last joined: ")[1].split(".")[0])
    calls = []

    def force(q):
        calls.append(1)
        return -q

    module_of(text)["steps"](np.ones(3), np.zeros(3), 0.1, 10, force)
    assert len(calls) == 10 * told + first
    assert told == nysalt.methods()[method]["evaluations_per_step"]


def test_the_header_promises_no_more_than_the_letters():
    displaced = nysalt.export("fg4_processed", "python", displaced=True)
    assert "order 4." in displaced and "displaced kicks" in displaced and "ABADABA|" in displaced
    assert "order 6." in nysalt.export("srkn11b", "python", displaced=True)
    assert "displaced kicks" not in nysalt.export("srkn11b", "python", displaced=True)
