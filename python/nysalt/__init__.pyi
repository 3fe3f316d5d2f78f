# SPDX-License-Identifier: BSL-1.0
# Written by docs/site/stub.py --update.
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
__version__: str
__all__ = ['Run', 'Scheme', 'System', 'Table', 'build', 'compare', 'export', 'families', 'hamiltonian', 'integrate', 'judge', 'learn', 'load', 'methods', 'metrics', 'potential', 'recommend', 'recommend_for_sampling', 'run', 'system', 'systems']
Texts = Union[str, Sequence[str]]
Numbers = Union[float, Sequence[float]]
def systems() -> Dict[str, Dict[str, Any]]:
    ...
def methods() -> Dict[str, Dict[str, Any]]:
    ...
def families() -> Dict[str, Dict[str, Any]]:
    ...
def metrics() -> Dict[str, Dict[str, Any]]:
    ...
class System:
    description: str
    kind: str
    dimension: int
    observables: List[str]
    default_observable: str
    letters: List[str]
    frequency_bands: List[Tuple[float, float]]
    highest_frequency: float
    parameters: Dict[str, Any]
    calls_python: bool

    def __init__(self, held: Any) -> None:
        ...

    def __repr__(self) -> str:
        ...

    def energy(self, q: Any, p: Any) -> Union[float, np.ndarray]:
        ...

    def force(self, q: Any) -> np.ndarray:
        ...

    def starts(self, trajectories: int=..., *, seed: int=..., role: str=...) -> Tuple[np.ndarray, np.ndarray]:
        ...
def system(name: Union[str, _os.PathLike]=..., *, friction: Optional[float]=..., temperature: Optional[float]=..., start: Optional[str]=..., at: Optional[Texts]=..., spread: Optional[float]=..., sigma: Optional[float]=..., frequency: Optional[float]=..., **parameters: Union[float, str, None]) -> System:
    ...
def build(source: Union[str, _os.PathLike], output: Union[str, _os.PathLike, None]=...) -> str:
    ...
def potential(text: str, variables: Texts, *, mass: Optional[Numbers]=..., around: Optional[Mapping[str, float]]=..., friction: Optional[float]=..., temperature: Optional[float]=..., start: Optional[str]=..., at: Optional[Texts]=..., spread: Optional[float]=..., sigma: Optional[float]=..., frequency: Optional[float]=..., **parameters: float) -> System:
    ...
def hamiltonian(name: str, *, dimension: int, potential: Callable[[np.ndarray], float], force: Callable[[np.ndarray], Any], starts: Callable[[int, int], Tuple[Any, Any]], inverse_mass: Numbers=..., frequency: Optional[float]=..., batched: bool=..., friction: Optional[float]=..., sigma: Optional[float]=..., temperature: Optional[float]=..., kind: Optional[str]=...) -> System:
    ...
class _FromFile:
    name: str
    document: Dict[str, Any]
    letters: str
    order: int
    symmetric: bool
    evaluations_per_step: int

    def __init__(self, text: str, name: str) -> None:
        ...

    def __repr__(self) -> str:
        ...

    def coefficients(self, step: Optional[float]=...) -> np.ndarray:
        ...
class Table(_FromFile):
    ...
class Scheme(_FromFile):
    family: str
    parameters: Dict[str, Any]
    standard_errors: Dict[str, Any]
    theta: np.ndarray
    step: Any
    loss: Any
    held_out_loss: Any
    usable: bool
    reason: Optional[str]
    fit: Optional[Dict[str, Any]]

    def __init__(self, text: str, name: str, fit: Optional[Dict[str, Any]]=...) -> None:
        ...

    def save(self, path: Union[str, '_os.PathLike[str]'], *, force: bool=...) -> None:
        ...
Method = Union[str, Scheme, Table]
def learn(system: System, family: str=..., *, step: Optional[float]=..., steps: Optional[Numbers]=..., placement: Optional[str]=..., purpose: Optional[str]=..., trajectories: int=..., effort: str=..., loss: Optional[str]=..., coordinates: Optional[str]=..., fix: Optional[Mapping[str, float]]=..., random_starts: Optional[int]=..., horizon: Optional[float]=..., fine_step: Optional[float]=..., enough: Optional[float]=..., seed: int=..., threads: Optional[int]=...) -> Scheme:
    ...
def load(path: Union[str, '_os.PathLike[str]']) -> Union[Scheme, Table]:
    ...
@_dataclass(frozen=True, eq=False)
class Run:
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
        ...

    def __repr__(self) -> str:
        ...
def run(system: System, method: Method, step: float, horizon: float, *, q: Any=..., p: Any=..., out: Optional[np.ndarray]=..., trajectories: Optional[int]=..., placement: Optional[str]=..., checks: bool=..., observables: Optional[Texts]=..., sample_every: int=..., seed: int=..., threads: Optional[int]=..., force: bool=...) -> Run:
    ...
def judge(system: System, method: Method, step: float, *, placement: Optional[str]=..., force: bool=..., threads: Optional[int]=...) -> Dict[str, Any]:
    ...
def integrate(system: System, method: Method, step: float, q: Any, p: Any, steps: int, *, out: Optional[Tuple[np.ndarray, np.ndarray]]=..., seed: Optional[int]=..., placement: Optional[str]=..., force: bool=..., threads: Optional[int]=...) -> Tuple[np.ndarray, np.ndarray]:
    ...
def export(method: Method, to: Optional[str]=..., *, template: Union[str, '_os.PathLike[str]', None]=..., step: Optional[float]=..., placement: Optional[str]=..., displaced: bool=..., name: Optional[str]=...) -> str:
    ...
def compare(system: System, methods: Union[Method, Iterable[Method]]=..., steps: Numbers=..., *, equal_cost: bool=..., horizon: Optional[float]=..., trajectories: int=..., placement: Optional[str]=..., prices: Optional[Numbers]=..., metric: Texts=..., observable: Optional[str]=..., range: Optional[Numbers]=..., bins: int=..., longest_lag: float=..., hmc_temperature: float=..., levels: Optional[Numbers]=..., purpose: Optional[str]=..., learn_trajectories: int=..., learn_effort: str=..., learn_loss: Optional[str]=..., coordinates: Optional[str]=..., fix: Optional[Mapping[str, float]]=..., learn_random_starts: Optional[int]=..., learn_horizon: Optional[float]=..., fine_step: Optional[float]=..., seed: int=..., threads: Optional[int]=..., force: bool=...) -> Dict[str, Any]:
    ...
def recommend(system: System, horizon: float, *, output: Union[str, '_os.PathLike[str]', None]=..., budget: Optional[float]=..., budget_seconds: Optional[float]=..., error: Optional[float]=..., metric: str=..., observable: Optional[str]=..., looks: int=..., trajectories: int=..., hmc_temperature: float=..., families: Optional[Texts]=..., purpose: Optional[str]=..., learn_trajectories: int=..., learn_effort: str=..., learn_loss: Optional[str]=..., coordinates: Optional[str]=..., fix: Optional[Mapping[str, float]]=..., learn_random_starts: Optional[int]=..., learn_horizon: Optional[float]=..., reversible: bool=..., placement: Optional[str]=..., seed: int=..., threads: Optional[int]=...) -> Tuple[Dict[str, Any], Union[Scheme, Table, None]]:
    ...
def recommend_for_sampling(system: System, length: float, *, output: Union[str, '_os.PathLike[str]', None]=..., acceptance: float=..., times_larger: float=..., trajectories: int=..., hmc_temperature: float=..., families: Optional[Texts]=..., learn_trajectories: int=..., learn_effort: str=..., learn_loss: Optional[str]=..., coordinates: Optional[str]=..., fix: Optional[Mapping[str, float]]=..., learn_random_starts: Optional[int]=..., learn_horizon: Optional[float]=..., seed: int=..., threads: Optional[int]=...) -> Tuple[Dict[str, Any], Union[Scheme, Table, None]]:
    ...
