# SPDX-License-Identifier: BSL-1.0
"""Schemes at another size of the kind of system that they were learned for."""
import warnings

import numpy as np
import pytest

import nysalt


def learned(system):
    return nysalt.learn(system, "nystrom", step=0.02, trajectories=8, horizon=0.4, loss="state:1", effort="quick")


def test_a_scheme_of_a_small_chain_runs_a_large_one():
    small = nysalt.system("fpu", omega=50)
    large = nysalt.system("fpu", omega=50, pairs=20)
    assert small.kind == large.kind == "fpu_chain(omega=50)"
    scheme = learned(small)
    assert scheme.document["system"]["kind"] == small.kind
    with pytest.warns(UserWarning, match="learned at another size, for .*pairs=3.* passed the trial run for .*pairs=20"):
        tried = nysalt.run(large, scheme, step=0.02, horizon=0.2, trajectories=4, observables="energy")
    with pytest.warns(UserWarning, match="not tried at this size"):
        forced = nysalt.run(large, scheme, step=0.02, horizon=0.2, trajectories=4, force=True,
                            observables="energy")
    assert np.array_equal(tried["energy"], forced["energy"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        nysalt.run(small, scheme, step=0.02, horizon=0.2, trajectories=4)
    with pytest.raises(ValueError, match="must run on fpu_chain.pairs=3, omega=50., for which it was learned, got .*omega=51"):
        nysalt.run(nysalt.system("fpu", omega=51, pairs=20), scheme, step=0.02, horizon=0.2)


def wells(number, kind=None):
    """Quartic wells of one's own."""

    def starts(seed, n):
        draw = np.random.default_rng([seed, n])
        return 0.5 * draw.standard_normal(number), draw.standard_normal(number)

    return nysalt.hamiltonian(f"wells({number})", dimension=number, potential=lambda q: 0.25 * np.sum(q**4),
                              force=lambda q: -(q**3), starts=starts, frequency=3.0, kind=kind)


def test_functions_of_python_tell_their_kind():
    scheme = nysalt.learn(wells(1, kind="wells"), "nystrom", step=0.3, trajectories=4, horizon=3, loss="state:1",
                          effort="quick")
    with pytest.warns(UserWarning, match="passed the trial run for wells"):
        nysalt.run(wells(3, kind="wells"), scheme, step=0.3, horizon=3, trajectories=2)
    for other in (wells(3), wells(3, kind="other wells")):
        with pytest.raises(ValueError, match="must run on wells"):
            nysalt.run(other, scheme, step=0.3, horizon=3, trajectories=2)
