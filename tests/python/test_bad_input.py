# SPDX-License-Identifier: BSL-1.0
"""What cannot be is a ValueError of one sentence, in the words of Python."""
import inspect
import os

import neighbour
import numpy as np
import pytest

import nysalt

PENDULUM = nysalt.system("pendulum")
CHAIN = nysalt.system("fpu")


def run(**more):
    return nysalt.run(PENDULUM, **{**dict(method="verlet", step=0.1, horizon=1, trajectories=2), **more})


def integrate(**more):
    return nysalt.integrate(CHAIN, **{**dict(method="verlet", step=0.01, q=np.zeros((2, 6)), p=np.zeros((2, 6)),
                                             steps=3), **more})


def out(q=None, p=None):
    return dict(out=(np.zeros((2, 6)) if q is None else q, np.zeros((2, 6)) if p is None else p))


def read_only(shape):
    array = np.zeros(shape)
    array.flags.writeable = False
    return array


SHARED = np.zeros((3, 6))

CASES = [
    (lambda: nysalt.system("fpv"), "unknown system 'fpv': did you mean fpu?"),
    (lambda: nysalt.system("pendulum", omega=3), "unknown parameter 'omega' of the system pendulum: it takes spread"),
    (lambda: nysalt.system("fpu", omega="fast"), "omega must be a number, got 'fast'"),
    (lambda: nysalt.system("fpu", pairs=2.5), "pairs must be a whole number, got 2.5"),
    (lambda: nysalt.system("fpu", omega=float("nan")), "omega must be finite, got nan"),
    (lambda: nysalt.system("fpu", **{"\udcff": 1}), r"the name of an argument must be a text of whole characters, got '\\udcff'"),
    (lambda: nysalt.system("fpu", **{"a\0b": 1}), "unknown parameter 'a b' of the system fpu"),
    (lambda: nysalt.system("fpu", friction=0.1), "friction must come with sigma or temperature; give 0 for damping without noise"),
    (lambda: nysalt.system(3), "name must be a text, got 3"),
    (lambda: nysalt.learn(CHAIN), "step or steps must be given, and not both"),
    (lambda: nysalt.learn(CHAIN, "nystrom", step=-0.1), "step must be a positive, finite number, got -0.1"),
    (lambda: nysalt.learn(CHAIN, "nystrom", step=0.02, fix={"b2": 1}), "fix must name a parameter of the family nystrom, got 'b2': it has b1"),
    (lambda: nysalt.learn(CHAIN, "nystrom", step=0.02, enough=0.1, trajectories=3), "leave trajectories away"),
    (lambda: nysalt.learn(CHAIN, "nystrom", step=0.02, trajectories=10**30), "trajectories must be a whole number that can be counted"),
    (lambda: nysalt.learn(nysalt.system("kepler"), "nystrom", step=0.1, coordinates="modes"), "must declare modes for the modes coordinates, got none; take qp"),
    (lambda: run(method="verlett"), "unknown method 'verlett': did you mean verlet?"),
    (lambda: run(method="learned:nystrom"), r'learned:nystrom must be learned first: nysalt.learn\(system, family="nystrom", step=0.1'),
    (lambda: run(sample_every=0), "sample_every must be at least 1, got 0"),
    (lambda: run(out=[0.0]), "out must be a NumPy array of float64 to be filled, got list"),
    (lambda: run(out=np.zeros((2, 11, 1), np.float32)), "out must hold float64 to be filled, got float32"),
    (lambda: run(out=np.zeros((2, 11))), r"out must have the shape \(2, 11, 1\), got \(2, 11\)"),
    (lambda: run(out=np.zeros((1, 11, 2)).T), "out must lie one row after the other to be filled"),
    (lambda: run(out=read_only((2, 11, 1))), "out must be writable to be filled, got a read-only array"),
    (lambda: integrate(q=np.zeros((2, 5))), r"q must have the shape \(6,\) or \(trajectories, 6\), got \(2, 5\)"),
    (lambda: integrate(p=np.zeros(6)), r"p must have the shape of q, \(2, 6\), got \(6,\)"),
    (lambda: nysalt.run(CHAIN, "verlet", 0.01, 1, p=np.zeros(6)), "p must come with q; give the coordinates"),
    (lambda: nysalt.run(CHAIN, "verlet", 0.01, 1, q=np.zeros(5)), r"q must have the shape \(6,\) or \(trajectories, 6\)"),
    (lambda: nysalt.run(CHAIN, "verlet", 0.01, 1, q=np.zeros(6), p=np.zeros((1, 6))), r"p must have the shape of q"),
    (lambda: nysalt.run(CHAIN, "verlet", 0.01, 1, q=np.zeros(6), trajectories=2), "trajectories must be at most 1"),
    (lambda: nysalt.system("kepler", at="x=1").energy([1, 0], [0, 1]), "at: names must be of q1, p1 to q2, p2, got 'x'"),
    (lambda: integrate(steps=-1), "steps must not be negative, got -1"),
    (lambda: integrate(q=np.full((2, 6), np.inf)), "the state of trajectory 0 must be finite, got q1 = inf"),
    (lambda: integrate(**out(SHARED[:2], SHARED[1:])), "q and p of out must not share memory; give two arrays"),
    (lambda: integrate(q=SHARED[:2], **out(q=SHARED[1:])), "out must be q and p themselves or share no memory"),
    (lambda: nysalt.compare(PENDULUM, "verlet", []), "steps must be one or more, got none"),
    (lambda: nysalt.compare(PENDULUM, "verlet", 0.1, bins=10), "bins must come with metric distribution, got path"),
    (lambda: nysalt.compare(PENDULUM, [], 0.1), "methods must be one or more, got none"),
    (lambda: nysalt.compare(PENDULUM, "verlet", 0.1, metric=()), "metric must be one or more, got none"),
    (lambda: nysalt.recommend(PENDULUM, 5), "budget"),
    (lambda: nysalt.export("chin4a", "c"), "displaced"),
    (lambda: nysalt.export("verlet"), "to or template must be given, and not both, got neither"),
    (lambda: nysalt.export("verlet", template=__file__), "test_bad_input.py:"),
    (lambda: PENDULUM.energy([1.0], "p"), "p must hold real numbers, got text"),
    (lambda: PENDULUM.force([1j]), "q must hold real numbers, got complex ones"),
    (lambda: PENDULUM.force([None]), "q must hold real numbers, got objects"),
    (lambda: PENDULUM.force(np.array(["2020"], "datetime64[D]")), "q must hold real numbers, got dates or times"),
    (lambda: PENDULUM.force([[1], [2, 3]]), "q must hold real numbers, got list"),
    (lambda: integrate(out=np.zeros((3, 2, 6))), r"out must be a pair \(q, p\) of arrays, got array"),
    (lambda: integrate(**out(q=np.zeros(97, np.uint8)[1:].view(float).reshape(2, 6))), "q of out must lie where a float64"),
    (lambda: run(step=True), "step must be a number, got True"),
    (lambda: run(step=np.complex64(0.1)), "step must be a number, got"),
    (lambda: run(step=np.ones((50, 50))), r"step must be a number, got array\(\[\[1., 1.*\.\.\.$"),
    (lambda: run(trajectories=True), "trajectories must be a whole number, got True"),
    (lambda: run(trajectories=np.True_), "trajectories must be a whole number, got True"),
    (lambda: run(seed=-1), "seed must not be negative, got -1"),
    (lambda: run(threads=10**12), "threads must be a number of threads, got 1000000000000"),
    (lambda: run(force=1), "force must be True or False, got 1"),
    (lambda: run(method="\udc80"), "method must be a text of whole characters"),
    (lambda: nysalt.run(3, "verlet", 0.1, 1), "system must be one that nysalt.system or .* made, got 3"),
    (lambda: nysalt.compare(PENDULUM, 3, 0.1), "methods must be names, schemes or tables, got 3"),
    (lambda: nysalt.learn(CHAIN, "nystrom", step=0.02, fix={"b1": None}), "b1 must be a number, got None"),
    (lambda: nysalt.potential("x^2", "x", around={"x": None}), "x must be a number, got None"),
    (lambda: nysalt.compare(PENDULUM, [None], 0.1), "methods must be a text, got None"),
    (lambda: nysalt.compare(PENDULUM, "verlet", [0.1, None]), "steps must be a number, got None"),
    (lambda: integrate(out=(None, None)), "q of out must be a NumPy array of float64 to be filled, got NoneType"),
    (lambda: nysalt.learn(CHAIN, "nystrom", step=0.02, fix=["b1=1"]), "fix must be a dict of numbers by name"),
    (lambda: PENDULUM.starts(0), "trajectories must be at least 1, got 0"),
    (lambda: PENDULUM.starts(1, role="mine"), "unknown role 'mine': it is one of training, held_out, test"),
]


@pytest.mark.parametrize("bad, sentence", CASES)
def test_it_is_told_in_a_sentence(bad, sentence):
    with pytest.raises(ValueError, match=sentence) as caught:
        bad()
    told = str(caught.value)
    assert "\n" not in told and ("--" not in told or "nysalt learn --" in told)


SCHEME = nysalt.learn(PENDULUM, "nystrom", step=0.2, trajectories=5, horizon=2)
STATES = dict(q=[0.1], p=[0.0])
#: Every public function with arguments that it takes.
CALLS = {
    nysalt.system: dict(name="pendulum"),
    nysalt.build: dict(source="none.hpp"),
    nysalt.potential: dict(text="x^2", variables="x"),
    nysalt.hamiltonian: dict(name="x^2", dimension=1, potential=lambda q: q[0]**2, force=lambda q: -2 * q,
                             starts=lambda seed, n: ([1.0], [0.0])),
    nysalt.learn: dict(system=PENDULUM, family="nystrom", step=0.2, trajectories=5, horizon=2),
    nysalt.load: dict(path="none.json"),
    nysalt.run: dict(system=PENDULUM, method="verlet", step=0.1, horizon=1),
    nysalt.judge: dict(system=PENDULUM, method="verlet", step=0.1),
    nysalt.integrate: dict(system=PENDULUM, method="verlet", step=0.1, steps=2, **STATES),
    nysalt.export: dict(method="verlet", to="c"),
    nysalt.compare: dict(system=PENDULUM, methods="verlet", steps=0.1),
    nysalt.recommend: dict(system=PENDULUM, horizon=1, budget=10),
    nysalt.recommend_for_sampling: dict(system=PENDULUM, length=1),
    nysalt.System.energy: dict(self=PENDULUM, **STATES),
    nysalt.System.force: dict(self=PENDULUM, q=[0.1]),
    nysalt.System.starts: dict(self=PENDULUM),
    nysalt.Scheme.save: dict(self=SCHEME, path="nowhere/scheme.json"),
}
LISTS = {nysalt.systems, nysalt.methods, nysalt.families, nysalt.metrics}


def arguments_of(function):
    return {name: one for name, one in inspect.signature(function).parameters.items()
            if name != "self" and one.kind is not one.VAR_KEYWORD}


def test_no_function_is_left_out():
    functions = {one for name in nysalt.__all__ if inspect.isfunction(one := getattr(nysalt, name))}
    functions |= {one for kind in (nysalt.System, nysalt.Scheme, nysalt.Table) for name, one in inspect.getmembers(kind, inspect.isfunction)
                  if not name.startswith("_")}
    assert functions == set(CALLS) | LISTS | {nysalt.Scheme.coefficients}
    assert all(one.default is None for one in arguments_of(nysalt.Scheme.coefficients).values())


@pytest.mark.parametrize("function, name", [(function, name) for function in CALLS for name, one in arguments_of(function).items()
                                            if one.default is not None])
def test_none_is_no_value(function, name):
    """Where it is not the default; what is taken for a default of the program has None as its own."""
    with pytest.raises(ValueError, match=rf"^{name} must (have a value, got None|hold real numbers, got objects)$"):
        function(**{**CALLS[function], name: None})


def test_none_is_a_default():
    given = {name: None for name, one in arguments_of(nysalt.run).items() if one.default is None}
    assert len(given) > 5 and np.array_equal(run(**{**given, "trajectories": 2}).values, run().values)


class Broken(Exception):
    pass


def raising(kind, *places):
    """An object that raises wherever it is read as one of these."""

    def fail(self, *_, **__):
        raise kind("of mine")

    return type("Raising", (), {place: fail for place in places})()


PLACES = {
    "step": (lambda one: run(step=one), "__float__"),
    "horizon": (lambda one: run(horizon=one), "__float__"),
    "omega": (lambda one: nysalt.system("fpu", omega=one), "__float__"),
    "steps": (lambda one: nysalt.learn(CHAIN, "nystrom", steps=[0.01, one]), "__float__"),
    "b1": (lambda one: nysalt.learn(CHAIN, "nystrom", step=0.02, fix={"b1": one}), "__float__"),
    "trajectories": (lambda one: run(trajectories=one), "__index__"),
    "seed": (lambda one: PENDULUM.starts(seed=one), "__index__"),
    "pairs": (lambda one: nysalt.system("fpu", pairs=one), "__index__"),
    "q": (lambda one: PENDULUM.force(one), "__array__"),
    "p": (lambda one: integrate(p=one), "__array__"),
    "levels": (lambda one: nysalt.compare(PENDULUM, "verlet", 0.1, levels=one), "__len__", "__getitem__", "__iter__"),
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("kind", [KeyboardInterrupt, MemoryError, SystemExit, RecursionError, ZeroDivisionError, Broken])
def test_what_an_argument_raises_comes_through(place, kind):
    call, *methods = PLACES[place]
    with pytest.raises(kind, match="^of mine$"):
        call(raising(kind, *methods))


@pytest.mark.parametrize("place", [place for place in PLACES if place != "levels"])
@pytest.mark.parametrize("kind", [TypeError, ValueError, OverflowError])
def test_what_cannot_be_converted_is_refused(place, kind):
    call, *methods = PLACES[place]
    with pytest.raises(ValueError, match=f"^{place} must (be|hold) .*, got"):
        call(raising(kind, *methods))


def test_what_is_sound_is_not_refused():
    assert run(out=np.zeros((2, 11, 1))).values.shape == (2, 11, 1)
    assert integrate(**out())[0].shape == (2, 6)
    assert integrate(q=SHARED[:2].copy())[0].shape == (2, 6)
    assert np.array_equal(PENDULUM.force([1]), PENDULUM.force(np.ones(1, np.float32)))
    assert run(force=np.bool_(True), threads=np.int32(1)).diverged.tolist() == [-1, -1]
    rows = nysalt.compare(PENDULUM, (name for name in ["verlet", "srkn6b"]), np.array(0.1), trajectories=2)["rows"]
    assert [row["method"] for row in rows] == ["verlet", "srkn6b"]
    assert run(observables=[]).observables == run().observables
    found = nysalt.compare(PENDULUM, ["verlet"], 0.1, trajectories=4, horizon=1, levels=[], prices=[])
    assert len(found["rows"]) == 1
    one, other = run(), run()
    assert one == one and one != other and len({one, other}) == 2


@pytest.mark.parametrize("change", [dict(method="verlett"), dict(step=-1), dict(q=np.full((2, 6), np.nan)),
                                    dict(p=np.zeros(6)), dict(steps=-1), dict(placement="nowhere")])
def test_what_is_refused_leaves_arrays_as_they_were(change):
    q, p = np.full((2, 6), 7.0), np.full((2, 6), 8.0)
    with pytest.raises(ValueError):
        integrate(**{**change, **out(q, p)})
    assert (q == 7).all() and (p == 8).all()
    integrate(**out(q, p))
    assert (q == 0).all() and (p == 0).all()  # at rest


def test_files_that_cannot_be(tmp_path):
    """Private nodes and links, which nothing writes to."""
    (tmp_path / "half.json").write_text('{"format": "nysalt scheme", ')
    (tmp_path / "zero").symlink_to("/dev/zero")
    os.mkfifo(tmp_path / "fifo")
    with open(tmp_path / "long", "wb") as file:
        file.truncate(2**33)
    (tmp_path / "deep").write_text("[" * 400_000 + "]" * 400_000)
    scheme = nysalt.learn(PENDULUM, "nystrom", step=0.2, trajectories=5, horizon=2)
    scheme.save(tmp_path / "edited.json", force=True)
    (tmp_path / "edited.json").write_text((tmp_path / "edited.json").read_text().replace('"seed": 1', '"seed": 2'))
    files = sorted(os.listdir(tmp_path))
    for name, sentence in (("half.json", "half.json must be whole JSON"), ("long", "at most 1048576 bytes long"),
                           ("zero", "cannot read .*zero: it is not a regular file"), ("deep", "nested at most"),
                           ("fifo", "cannot read .*fifo: it is not a regular file"),
                           ("edited.json", '"checksum" must fit the contents')):
        with pytest.raises(ValueError, match=sentence):
            nysalt.load(tmp_path / name)
    with pytest.raises(FileNotFoundError):
        nysalt.load(tmp_path / "none.json")
    for name, sentence in (("nowhere/scheme.json", ""), ("a\0b", "must hold no zero byte"),
                           ("fifo", "is not a regular file")):
        with pytest.raises(OSError, match=sentence):
            scheme.save(f"{tmp_path}/{name}", force=True)
    assert (tmp_path / "fifo").is_fifo() and sorted(os.listdir(tmp_path)) == files


def test_two_methods_of_one_name_are_told_apart():
    schemes = [nysalt.learn(PENDULUM, "nystrom", step=0.2, trajectories=5, horizon=2, seed=seed) for seed in (1, 2)]
    with pytest.raises(ValueError, match="methods must have different names, got scheme:nystrom twice"):
        nysalt.compare(PENDULUM, schemes, 0.2, trajectories=4)
    schemes[1].name = "the second"
    found = nysalt.compare(PENDULUM, schemes, 0.2, trajectories=4, force=True)
    assert [row["method"] for row in found["rows"]] == ["scheme:nystrom", "the second"]


def test_other_exceptions_are_as_without_this_package():
    with pytest.raises(TypeError):
        nysalt.learn(CHAIN, "nystrom", stpe=0.1)
    with pytest.raises(OverflowError, match="^--too-large was given$"):
        neighbour.overflow()
    with pytest.raises(ValueError, match="^give --force$"):
        neighbour.invalid()
