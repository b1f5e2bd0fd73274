"""Operators of the strip against cosines, whose answers are known, on even nodes and crowded ones."""

from __future__ import annotations

import numpy as np
import pytest

from meshes.errors import InputError
from solvers.potential.strip import moved, nodes, strip
from tests.mutants import kills

DEPTH = 0.3


@kills("solvers.potential.strip:_placed", "np.square(cluster * sine)", "np.square(sine)")
@kills("solvers.potential.strip:nodes", "(-sine * k) @ harmonics", "(sine * k) @ harmonics")
@kills("solvers.potential.strip:nodes", "hilbert=(cosine * k)", "hilbert=cosine")
@kills("solvers.potential.strip:nodes", "mean=ends * stretch * crests", "mean=ends * crests")
@kills("solvers.potential.strip:nodes", "first = crests * np.arange", "first = np.arange")
@kills("solvers.potential.strip:strip", "(cosine * (k * rest)) @ taken", "(cosine * rest) @ taken")
@kills("solvers.potential.strip:strip", "(sine * rest) @ taken", "(cosine * rest) @ taken")
@kills("solvers.potential.strip:strip", "k = at.crests * np.arange", "k = np.arange")
def test_cosines() -> None:
    """k coth(kK) cos ku, coth(kK) sin ku, -k sin ku and the means, on even nodes and crowded ones."""
    for crests, cluster, count in ((1, 1.0, 32), (3, 1.0, 32), (1, 0.5, 96), (3, 0.3, 128)):
        at = nodes(count, crests, cluster)
        by = strip(at, DEPTH)
        flat = np.ones(count + 1)
        assert at.mean @ flat == pytest.approx(1.0, rel=1e-14)
        assert at.u[0] == 0.0 and at.u[-1] == pytest.approx(np.pi / crests, rel=1e-15)
        for waves in (1, 2, 4):
            # Their series in xi end at rounding here, as ((1 - L)/(1 + L))^j; slopes multiply it by count/L.
            k, rounding = waves * crests, 1e-13 * count / cluster
            cosine, sine, hollow = np.cos(k * at.u), np.sin(k * at.u), np.tanh(k * DEPTH)
            np.testing.assert_allclose(by.flux @ cosine, k / hollow * cosine, atol=k * rounding)
            np.testing.assert_allclose(by.shift @ cosine, sine / hollow, atol=rounding)
            np.testing.assert_allclose(at.slope @ cosine, -k * sine, atol=k * rounding)
            assert abs(at.mean @ cosine) < 1e-13
        # A mean has no flux.
        assert np.abs(by.flux @ flat).max() < 1e-9 and np.abs(by.shift @ flat).max() < 1e-11


@kills("solvers.potential.strip:strip", "fall = -k * rest * (2.0 + rest)", "fall = -k * rest * (1.0 + rest)")
@kills("solvers.potential.strip:strip", "(cosine * (k * fall)) @ taken", "(cosine * fall) @ taken")
def test_slopes_by_depth() -> None:
    """Derivatives by K against central differences of 1e-5: 1e-10 of the third derivative, and rounding."""
    at, step = nodes(32, 2, 0.7), 1e-5
    more, less, by = strip(at, DEPTH + step), strip(at, DEPTH - step), strip(at, DEPTH)
    for name in ("flux", "shift"):
        wanted = (getattr(more, name) - getattr(less, name)) / (2.0 * step)
        np.testing.assert_allclose(getattr(by, name + "_slope"), wanted, atol=2e-7 * np.abs(wanted).max())


@kills("solvers.potential.strip:moved", "at.cluster * np.cos", "np.cos")
def test_moved_between_nodes() -> None:
    """An analytic function on other nodes; its series in xi ends at rounding."""
    at, to = nodes(96, 2, 0.5), nodes(40, 2, 0.8)
    found = moved(at, 1.0 / (1.5 - np.cos(2.0 * at.u)), to)
    np.testing.assert_allclose(found, 1.0 / (1.5 - np.cos(2.0 * to.u)), rtol=1e-12)


def test_very_deep_and_very_shallow() -> None:
    """From k coth kK = k to 1/K, without an overflow."""
    at = nodes(16)
    cosine = np.cos(at.u)
    np.testing.assert_allclose(strip(at, 1e4).flux @ cosine, cosine, atol=1e-13)
    np.testing.assert_allclose(strip(at, 1e-4).flux @ cosine, 1e4 * cosine, rtol=1e-7, atol=1e-3)


@pytest.mark.parametrize(
    ("field", "given"),
    [("count", (7,)), ("crests", (16, 0)), ("cluster", (16, 1, 0.0)), ("cluster", (16, 1, 1.1))],
)
def test_bad_nodes(field: str, given: tuple[float, ...]) -> None:
    with pytest.raises(InputError, match=field):
        nodes(*given)  # type: ignore[arg-type]


def test_no_depth() -> None:
    with pytest.raises(InputError, match="depth"):
        strip(nodes(16), 0.0)
