# SPDX-License-Identifier: BSL-1.0
"""Learned symplectic integrators.

    import nysalt

    chain = nysalt.system("fpu", omega=50)
    scheme = nysalt.learn(chain, "nystrom", step=0.02)
    run = nysalt.run(chain, scheme, step=0.02, horizon=100, trajectories=8)
    run["stiff_energy"]          # trajectories x samples

The functions are those of the program `nysalt`, with its defaults and its numbers to the last bit; an argument
whose default is None is left to that of the program. Bad input is a ValueError of one sentence. Long calls release the
interpreter's lock, except for a Hamiltonian of your own. Ctrl-C ends them when the block of trajectories, the
interval of steps or the pass over the data is done; this may take as long as that does.
"""

import functools as _functools
import inspect as _inspect
import itertools as _itertools
import json as _json
import os as _os
import sys as _sys
import warnings as _warnings
from dataclasses import dataclass as _dataclass
from typing import Any, Callable, Dict, Iterable, List, Mapping, Optional, Sequence, Tuple, Union

import numpy as np


def _compiled() -> Any:
    """The compiled module: of a wheel the one for this processor. NYSALT_PROCESSOR=baseline takes that for any."""
    from importlib import import_module
    try:
        with open("/proc/cpuinfo") as file:
            flags = set(next(line for line in file if line.startswith("flags")).split())
    except (OSError, StopIteration):
        flags = set()
    if "avx2" in flags and _os.environ.get("NYSALT_PROCESSOR") != "baseline":
        try:
            return import_module("nysalt.avx2._nysalt")
        except ModuleNotFoundError:
            pass
    return import_module("nysalt._nysalt")


_nysalt = _compiled()

__version__: str = _nysalt.version
__all__ = ["Run", "Scheme", "System", "Table", "build", "compare", "export", "families", "hamiltonian", "integrate", "judge",
           "learn", "load", "methods", "metrics", "potential", "recommend", "recommend_for_sampling", "run", "system", "systems"]

Texts = Union[str, Sequence[str]]
_seeds = _itertools.count(2**40)  # of calls of integrate() without a seed: far from those that people give
Numbers = Union[float, Sequence[float]]


@_functools.lru_cache(maxsize=None)
def _never_none(function: Callable[..., Any]) -> Tuple[str, ...]:
    """The arguments of a function that must have a value: all whose default is not None."""
    return tuple(name for name, one in _inspect.signature(function).parameters.items()
                 if one.default is not None and one.kind is not one.VAR_KEYWORD)


def _require_values(function: Callable[..., Any], given: Mapping[str, Any]) -> None:
    """Refuses None where it stands for no default; `given` are the arguments of a call of the function, by name."""
    for name in _never_none(function):
        if given.get(name, name) is None:
            raise ValueError(f"{name} must have a value, got None")


_keywords: Dict[str, List[Tuple[str, str, Any, str]]] = _nysalt.keywords()  # name, type, default and meaning, by function


def _optioned(function: Callable[..., Any]) -> Callable[..., Any]:
    """Puts the keywords of the options of a function in the place of its argument `options`, a dict of those that are given.

    A default of ... is that of the option of this name.
    """
    rows = {name: rest for name, *rest in _keywords[function.__name__]}
    own = dict(_inspect.signature(function).parameters)
    del own["options"]
    own = {name: one.replace(default=rows[name][1]) if one.default is ... else one for name, one in own.items()}
    keywords = [_inspect.Parameter(name, _inspect.Parameter.KEYWORD_ONLY, default=default,
                                   annotation=kind if default is not None else f"Optional[{kind}]")
                for name, (kind, default, _) in rows.items() if name not in own]
    signature = _inspect.Signature(sorted([*own.values(), *keywords], key=lambda one: one.kind),
                                   return_annotation=_inspect.signature(function).return_annotation)

    @_functools.wraps(function)
    def call(*args: Any, **given: Any) -> Any:
        bound = signature.bind(*args, **given)
        options = {one.name: bound.arguments.pop(one.name) for one in keywords if one.name in bound.arguments}
        bound.apply_defaults()
        _require_values(call, {**bound.arguments, **options})
        taken = {name: bound.arguments[name] for name in own}
        rest = {name: taken.pop(name) for name, one in own.items() if one.kind is one.VAR_KEYWORD}
        return function(**taken, options=options, **{name: value for more in rest.values() for name, value in more.items()})

    setattr(call, "__signature__", signature)
    call.__annotations__ = {name: one.annotation for name, one in signature.parameters.items()}
    call.__doc__ = f"{function.__doc__}\n    Options:\n" + "".join(
        f"    {one.name}: {rows[one.name][2]}{'' if one.default is None else f' [{one.default!r}]'}\n" for one in keywords)
    return call


# ---- What there is by name.

def _listed(kind: str) -> Dict[str, Dict[str, Any]]:
    return {one.pop("name"): one for one in _json.loads(_nysalt.listing())[kind]}


def systems() -> Dict[str, Dict[str, Any]]:
    """The bundled systems: by name their options with defaults, Hamiltonian, starts and observables."""
    return _listed("systems")


def methods() -> Dict[str, Dict[str, Any]]:
    """The classical methods: by name aliases, letters, order, evaluations a step, stability limit, and source."""
    return _listed("methods")


def families() -> Dict[str, Dict[str, Any]]:
    """What can be learned: by name letters, parameters with their ranges, order, evaluations a step."""
    return _listed("families")


def metrics() -> Dict[str, Dict[str, Any]]:
    """What `compare` judges by: by name its meaning."""
    return _listed("metrics")


# ---- Systems.

class System:
    """A Hamiltonian H(q, p) = K(p) + V(q), perhaps in a bath, and the distribution of its initial states.

    Made by `system` or `hamiltonian`. q and p are arrays of shape (dimension,), or (trajectories, dimension).
    """

    def __init__(self, held: Any) -> None:
        self._held = held
        facts = held.facts()
        #: By which a scheme knows it.
        self.description: str = facts["description"]
        #: The description without the size, by which a scheme knows other sizes; empty where there is none.
        self.kind: str = facts["kind"]
        #: Degrees of freedom.
        self.dimension: int = facts["dimension"]
        #: What `run` can sample; "q1..q6" means q1, q2, ... q6.
        self.observables: List[str] = facts["observables"]
        self.default_observable: str = facts["default_observable"]
        #: Names of its own letters, for words as in `method="word:tct"` and families `"word:tctctct"`.
        self.letters: List[str] = facts["letters"]
        #: Angular frequencies (low, high) that motion has; empty where they have no bound.
        self.frequency_bands: List[Tuple[float, float]] = facts["frequency_bands"]
        #: The highest that a motion from the initial distribution meets, rare initial states included.
        self.highest_frequency: float = facts["highest_frequency"]
        #: As scheme files hold them.
        self.parameters: Dict[str, Any] = _json.loads(facts["parameters"])
        #: Whether its functions are yours: one thread then, and the slow path.
        self.calls_python: bool = facts["calls_python"]

    def __repr__(self) -> str:
        return f"<nysalt system {self.description}>"

    def energy(self, q: Any, p: Any) -> Union[float, np.ndarray]:
        """H(q, p): a number, or one for each trajectory."""
        return self._held.energy(q, p)

    def force(self, q: Any) -> np.ndarray:
        """-grad V(q), in the shape of q."""
        return self._held.force(q)

    def starts(self, trajectories: int = 1, *, seed: int = 1, role: str = "test") -> Tuple[np.ndarray, np.ndarray]:
        """q and p where trajectories start, of shape (trajectories, dimension).

        With a seed `run` and `compare` begin at those of the role "test"; `learn` learns from "training" and
        judges on "held_out".
        """
        _require_values(System.starts, locals())
        q, p, warnings = self._held.starts(dict(trajectories=trajectories, seed=seed, role=role))
        _warn(warnings)
        return q, p


def _held_by(system: Any) -> Any:
    held = getattr(system, "_held", None)
    if held is None:
        raise ValueError(f"system must be one that nysalt.system or nysalt.hamiltonian made, got {system!r}")
    return held


@_optioned
def system(name: Union[str, _os.PathLike] = "fpu", *, options: Mapping[str, Any], **parameters: Union[float, str, None]) -> System:
    """A bundled system with its parameters, such as omega=50; `systems()` names them all. Or one of your own.

    The path of what `build` made, or of its source, loads a system of your own, at full speed: it is code that
    runs as you. friction (gamma) with sigma or temperature (kT = sigma^2/(2 gamma)) puts the system into a
    bath. `spread` also gives the deviations around the states of `at`.
    """
    return System(_nysalt.bundled({**options, "name": _path(name), "parameters": parameters}))


def _path(text: Any) -> Any:
    return _os.fspath(text) if isinstance(text, _os.PathLike) else text


def build(source: Union[str, _os.PathLike], output: Union[str, _os.PathLike, None] = None) -> str:
    """Compiles the source (.hpp) of a system of your own, by the compiler that nysalt was built with.

    It is made of a struct and a line NYSALT_SYSTEM; `nysalt new NAME` on the command line writes one to begin
    with. Returns the path of the library, output or else ./SOURCE.so, for `system`. Cost: some five seconds,
    nothing where nothing has changed.
    """
    _require_values(build, locals())
    return _nysalt.build(dict(source=_path(source), output=_path(output)))


@_optioned
def potential(text: str, variables: Texts, *, options: Mapping[str, Any], **parameters: float) -> System:
    """H = sum_i p_i^2/(2 m_i) + V(q) of a potential as text, compiled: at full speed.

        nysalt.potential("0.5*k*(sqrt(x^2 + y^2) - 1)^2 + y", ["x", "y"], around={"y": -1}, k=400)

    The text has numbers, the variables, the parameters, + - * / ^, parentheses, sqrt, exp, log and their like,
    pi, and sum(i, 1, 15, (q[i+1] - q[i])^4) over the coordinates of a variable "q[16]". Starts are normal
    around a point, with the deviations deviation_q and deviation_p, parameters too [0.1].
    """
    if not isinstance(text, str):
        raise ValueError(f"text must be a text, got {text!r}")
    return System(_nysalt.bundled({**options, "formula": text, "variables": variables, "parameters": parameters}))


def hamiltonian(name: str, *, dimension: int, potential: Callable[[np.ndarray], float],
                force: Callable[[np.ndarray], Any], starts: Callable[[int, int], Tuple[Any, Any]],
                inverse_mass: Numbers = 1.0, frequency: Optional[float] = None, batched: bool = False,
                friction: Optional[float] = None, sigma: Optional[float] = None,
                temperature: Optional[float] = None, kind: Optional[str] = None) -> System:
    """H = sum_i inverse_mass_i p_i^2/2 + V(q) of your own, by functions of Python.

    potential(q) is V, force(q) is -grad V, of an array of `dimension` numbers that they may keep; the force is
    checked against differences of the potential at four starts. starts(seed, n) is the start (q, p) of
    trajectory n: a function of these two numbers only, such as one of np.random.default_rng([seed, n]).
    `frequency` is the highest angular frequency of the motion, by which the reference chooses its step, and to
    which methods named phase_fitted_... and s_aia... are fitted; if it is not given, that along 64 starts. Schemes know the system by its name: let it hold the parameters. `kind` is
    the name without the size: a scheme that was learned at another size of the same kind is tried here, and used
    if it passes.
    The dimension is at most ten million.

    With batched=True, potential and force take arrays (trajectories, dimension) and return (trajectories,) and
    (trajectories, dimension). Then `integrate` calls the force once a kick for all trajectories, with the bits of one
    after the other where the force finds the same numbers; with gradient kicks, and elsewhere (run, learn, compare),
    the functions get one trajectory at a time.

    This is the slow path. Every force is a call of Python, some microseconds instead of some nanoseconds;
    one trajectory goes at a time, on one thread, with the interpreter's lock. Derivatives for learning are
    central differences of the force along what a step does, good to 1e-7 in any units: two more calls for each
    parameter, and in each gradient kick one more than the two evaluations that it counts otherwise. What the
    functions raise comes through. There are no modes and no bands of frequencies, hence no coordinates but qp, no
    rotations, and starts in a bath are those of the function.
    """
    _require_values(hamiltonian, locals())
    return System(_nysalt.own(dict(locals())))


# ---- Methods that are learned, or come from files.

class _FromFile:
    def __init__(self, text: str, name: str) -> None:
        facts = _nysalt.method(text, name, None)
        self._text = text
        #: Under which rows of `compare` have it; change it where two would have the same.
        self.name: str = name
        #: What the file holds.
        self.document: Dict[str, Any] = _json.loads(text)
        #: A for drifts, B for kicks, ...
        self.letters: str = facts["letters"]
        self.order: int = facts["order"]
        self.symmetric: bool = facts["symmetric"]
        self.evaluations_per_step: int = facts["evaluations_per_step"]

    def __repr__(self) -> str:
        return f"<nysalt {type(self).__name__.lower()} {self.name}: {self.letters}>"

    def coefficients(self, step: Optional[float] = None) -> np.ndarray:
        """Of the letters, in their order; of a curve of schemes at a step."""
        return np.array(_nysalt.method(self._text, self.name, step)["coefficients"])


class Table(_FromFile):
    """Coefficients of one's own, from a file; checked for consistency, order and stability."""


class Scheme(_FromFile):
    """A family's parameters that were learned for a system and a step (or a curve of steps).

    It holds there, and is refused elsewhere unless force=True is given. At another size of the same kind of system
    (`System.kind`) it is tried first, and a warning says so.
    """

    def __init__(self, text: str, name: str, fit: Optional[Dict[str, Any]] = None) -> None:
        super().__init__(text, name)
        self.family: str = self.document["family"]
        #: theta by name: a number, or of a curve a list with one for each step; to the last bit.
        self.parameters: Dict[str, Any] = self.document["parameters"]
        self.standard_errors: Dict[str, Any] = self.document["standard_errors"]
        #: theta as an array: (parameters,), or (parameters, steps).
        self.theta: np.ndarray = np.array(list(self.parameters.values()), dtype=float)
        #: A number, or of a curve a list.
        self.step: Any = self.document.get("steps", self.document.get("step"))
        #: The loss on what was learned from, and on trajectories that were not.
        self.loss: Any = self.document["loss"]
        self.held_out_loss: Any = self.document["held_out_loss"]
        self.usable: bool = self.document["usable"]
        #: Why it is not; None if it is.
        self.reason: Optional[str] = self.document["reason"] or None
        #: What `nysalt learn --json` prints; None of a scheme that comes from a file.
        self.fit: Optional[Dict[str, Any]] = fit

    def save(self, path: Union[str, "_os.PathLike[str]"], *, force: bool = False) -> None:
        """Writes the scheme file, whole or not at all; one that is not usable only with force=True."""
        _require_values(Scheme.save, locals())
        if not self.usable and not force:
            raise ValueError(f"cannot save the fit: it is not usable ({self.reason}); "
                             "take force=True to save it all the same")
        _nysalt.save(_os.fspath(path), self._text)


Method = Union[str, Scheme, Table]


@_optioned
def learn(system: System, family: str = ..., *, options: Mapping[str, Any]) -> Scheme:
    """Fits a family to the flow of a system at a step, or at several for a curve of parameters.

    It is judged on as many other trajectories as it learns from. The purpose of the runs to come sets the loss.
    A fit that cannot be trusted is returned with usable = False and the reason.
    """
    text, file = _nysalt.learn(_held_by(system), {**options, "family": family})
    fit = _json.loads(text)
    _warn(fit["warnings"])
    return Scheme(file, f"scheme:{family}", fit)


def load(path: Union[str, "_os.PathLike[str]"]) -> Union[Scheme, Table]:
    """A scheme or a table from a file, of this package or of the program."""
    _require_values(load, locals())
    name = _os.fspath(path)
    _nysalt.require_readable(_os.fsencode(name))
    with open(name, encoding="utf-8") as file:
        text = file.read(_nysalt.longest_method_file + 1)  # of what is longer the check says so
    return (Scheme if _nysalt.method(text, name, None)["is_learned"] else Table)(text, name)


def _held_by_name(given: Iterable[Method]) -> Tuple[List[Any], Dict[str, str]]:
    """The names under which methods go, and the files of those that have one."""
    held: Dict[str, str] = {}
    given = list(given)
    for one in given:
        if not isinstance(one, _FromFile):
            continue
        if held.get(one.name, one._text) != one._text:
            raise ValueError(f"methods must have different names, got {one.name} twice; "
                             "give one another name, scheme.name = ...")
        held[one.name] = one._text
    return [one.name if isinstance(one, _FromFile) else one for one in given], held


def _warn(texts: Sequence[str]) -> None:
    """Of the line that called this module."""
    level, frame = 1, _sys._getframe()
    while frame.f_back is not None and frame.f_globals is globals():
        level, frame = level + 1, frame.f_back
    for text in texts:
        _warnings.warn(text, stacklevel=level)


def _chosen(found: Tuple[str, Optional[str], Optional[str]]) -> Tuple[Dict[str, Any], Union[Scheme, Table, None]]:
    text, file, name = found
    document = _json.loads(text)
    _warn(document["warnings"])
    if file is None or name is None:
        return document, None
    if _nysalt.method(file, name, None)["is_learned"]:
        return document, Scheme(file, f"scheme:{_json.loads(file)['family']}")
    return document, Table(file, f"table:{name}")


# ---- What is done with them.

@_dataclass(frozen=True, eq=False)
class Run:
    """Samples of trajectories: values[trajectory, sample, observable] at times t[sample].

    From where a trajectory diverged on its values are NaN; `diverged` is that step, or -1. run["energy"] is a
    view of one observable. `evaluations` are of a trajectory, `seconds` of all. `energy_error` is the largest
    |H - H_0| at the end of the trajectories that did not diverge; `judgement` is that of `judge`.
    """

    t: np.ndarray
    values: np.ndarray
    diverged: np.ndarray
    observables: List[str]
    system: str
    starts: str
    steps: int
    evaluations: int
    seconds: float
    energy_error: float
    judgement: Dict[str, Any]
    warnings: List[str]

    def __getitem__(self, observable: str) -> np.ndarray:
        if observable not in self.observables:
            raise KeyError(f"unknown observable '{observable}': it is one of {', '.join(self.observables)}")
        return self.values[:, :, self.observables.index(observable)]

    def __repr__(self) -> str:
        trajectories, samples, _ = self.values.shape
        return (f"<nysalt run of {self.system}: {trajectories} trajectories, {self.steps} steps, "
                f"{samples} samples to t = {self.t[-1]:g}: {', '.join(self.observables)}>")


@_optioned
def run(system: System, method: Method, step: float, horizon: float, *, q: Any = None, p: Any = None,
        out: Optional[np.ndarray] = None, options: Mapping[str, Any]) -> Run:
    """Trajectories of a method from states q and p, or from the starts of a system, sampled every `sample_every` steps.

    q and p have the shape (dimension,), or (trajectories, dimension) for several; without p all is at rest.
    The samples are written where NumPy has them, in a new array, or in `out`: a writable one of float64 and of
    shape (trajectories, samples, observables), with samples = floor(horizon/step)//sample_every + 1.
    force=True runs a scheme where it was not learned. With checks=False the judgement says that nothing was tried.
    """
    (name,), held = _held_by_name([method])
    found = _nysalt.run(_held_by(system), {**options, "method": name, "held": held, "step": step, "horizon": horizon}, q, p, out)
    found = Run(**{**found, "judgement": _json.loads(found["judgement"])})
    _warn(found.warnings)
    return found


def judge(system: System, method: Method, step: float, *, placement: Optional[str] = None, force: bool = False,
          threads: Optional[int] = None) -> Dict[str, Any]:
    """What happens to a method at a step: the `judgement` of `nysalt stability --json`.

    Its "verdict" is "good", "near an edge", "loses trajectories", "unstable" or "not tried", with a "reason"; beside it
    stand the trial, the energy error against the kinetic energy, and what linear theory says.
    """
    _require_values(judge, locals())
    (name,), held = _held_by_name([method])
    asked = dict(method=name, held=held, step=step, placement=placement, force=force, threads=threads)
    text, warnings = _nysalt.judge(_held_by(system), asked)
    _warn(warnings)
    return _json.loads(text)


def integrate(system: System, method: Method, step: float, q: Any, p: Any, steps: int, *,
              out: Optional[Tuple[np.ndarray, np.ndarray]] = None, seed: Optional[int] = None,
              placement: Optional[str] = None, force: bool = False,
              threads: Optional[int] = None) -> Tuple[np.ndarray, np.ndarray]:
    """Advances states by `steps` steps: q and p of shape (dimension,), or (trajectories, dimension).

    Returns new arrays, or those of `out`, filled; out=(q, p) goes on in place, without a copy. They must be
    writable arrays of float64 in the shape of q. A call that is refused leaves them as they are; one that is
    interrupted, or in which a function of yours raises, leaves in them what is not defined. A trajectory that
    diverges ends as NaN. Each call is a run of its own: the numbers are those of `run` from the same states with the
    same seed. In a bath a call with a seed has the noise of that seed from its beginning; calls without a seed take
    seeds of their own in turn, so that a loop of calls has new noise in each and a program the same in each run.
    """
    _require_values(integrate, locals())
    if seed is None:
        seed = next(_seeds)
    (name,), held = _held_by_name([method])
    asked = dict(method=name, held=held, step=step, steps=steps, seed=seed, placement=placement, force=force,
                 threads=threads)
    to_q, to_p, warnings = _nysalt.integrate(_held_by(system), asked, q, p, out)
    _warn(warnings)
    return to_q, to_p


@_optioned
def export(method: Method, to: Optional[str] = None, *, template: Union[str, "_os.PathLike[str]", None] = None,
           options: Mapping[str, Any]) -> str:
    """The method as source for another language or code: the text that `nysalt export` writes.

    `to` is a language or code: "c", "cpp", "fortran", "python", "julia", "jax", "odeint", "sundials", "ordinarydiffeq",
    "ase", "openmm", "lammps", "rebound", "blackjax", "mici", "gpt", "grid", "chroma", "tmlqcd" or "openqcd"; instead,
    `template` is the file of a template for a host of your own. The text has a self-test.
    """
    (label,), held = _held_by_name([method])
    return _nysalt.export({**options, "method": label, "held": held, "to": to, "template": _path(template)})


@_optioned
def compare(system: System, methods: Union[Method, Iterable[Method]] = ..., steps: Numbers = (), *,
            options: Mapping[str, Any]) -> Dict[str, Any]:
    """Methods beside each other, at every step and by every metric: errors, evaluations, seconds.

    "all" stands for every method of methods() that applies to the system, its bath and the metrics; `left_out` of
    the document says which do not, and why.
    Returns the document that `nysalt compare --json` prints: `rows`, the `references` that they are seen
    against, `rankings`, `fits` of "learned:FAMILY", which are learned as `learn` does it; `schemes` are the documents
    of their scheme files. metrics() lists the metrics. Prices are in any unit.
    """
    is_one = isinstance(methods, (str, _FromFile))
    if not is_one and not isinstance(methods, Iterable):
        raise ValueError(f"methods must be names, schemes or tables, got {methods!r}")
    names, held = _held_by_name([methods] if is_one else methods)
    found = _json.loads(_nysalt.compare(_held_by(system), {**options, "methods": names, "held": held, "steps": steps}))
    _warn(found["warnings"])
    return found


@_optioned
def recommend(system: System, horizon: float, *, output: Union[str, "_os.PathLike[str]", None] = None,
              options: Mapping[str, Any]) -> Tuple[Dict[str, Any], Union[Scheme, Table, None]]:
    """The best method at `budget` evaluations per unit time, or at `budget_seconds` per unit time of one
    trajectory, or the cheapest that errs less than `error`. Families are learned as by `learn`.

    Returns the document that `nysalt recommend --json` prints, and the method to take, `document, method =
    nysalt.recommend(...)`: a Scheme where it was learned, else a Table of its coefficients at the step that the
    document says; None if no method is accepted. The file `output` has the best so far, also where the work is
    interrupted.
    """
    return _chosen(_nysalt.recommend(_held_by(system), {**options, "horizon": horizon, "output": _path(output)}))


@_optioned
def recommend_for_sampling(system: System, length: float, *, output: Union[str, "_os.PathLike[str]", None] = None,
                           options: Mapping[str, Any]) -> Tuple[Dict[str, Any], Union[Scheme, Table, None]]:
    """The word with which Hybrid Monte Carlo takes the largest step per evaluation at an acceptance, with
    trajectories of mean duration `length`, on a system `times_larger` than this one.

    Returns the document that `nysalt recommend --for sampling --json` prints, and the word to take, and keeps it
    in `output`, as `recommend` does.
    """
    return _chosen(_nysalt.recommend_for_sampling(_held_by(system), {**options, "length": length, "output": _path(output)}))
