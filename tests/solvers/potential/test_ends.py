"""Where exact waves end: folds by another code, the linear theory's critical flow, and what is told."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from solvers.potential.model import EndKind, end, froude
from solvers.potential.steady import SteadyWave, at_rest, forced, linear_detuning
from solvers.potential.strip import nodes
from tests.mutants import kills


@kills("solvers.potential.model:froude", "2.0 * radius - speed", "radius - speed")
@settings(max_examples=60, deadline=None)
@given(layer=some.floats(0.02, 0.9), share=some.floats(0.1, 3.0))
def test_the_froude_number_of_a_layer_at_rest(layer: float, share: float) -> None:
    """Long waves: t/n -> ln(R/a) = K in the linear theory, whose p^2 is then K/(1 + K)."""
    flat, depth = at_rest(layer, nodes(16)), -math.log1p(-layer)
    square = share * depth / (1.0 + depth)
    wave = SteadyWave(flat.at, flat.surface, square, 0.0, layer, 0.0, True)
    np.testing.assert_allclose(froude(wave), share, rtol=1e-10)


def test_the_froude_number_is_the_change_of_the_hydraulic_head() -> None:
    """Of a layer of depth y with the flow of another: the head's derivative by y is r^2 (1 - F^2)."""
    wave, square = forced(0.1, 0.03, 0.004), 0.03
    for k in (0, 30, 64):
        y, speed = float(wave.surface[k]), float(wave.speeds[k])
        radius = math.exp(-y)
        # Velocity A/r - r seen from the wave, whose flow between wall and surface is kept, over s.
        flow = radius * (radius - speed) * y - 0.5 * (1.0 - radius**2)

        def head(here: float, flow: float = flow) -> float:
            r = math.exp(-here)
            along = (flow + 0.5 * (1.0 - r * r)) / here
            return 0.5 * square * (along / r - r) ** 2 - 0.5 * r * r

        slope = (head(y * (1.0 + 1e-5)) - head(y * (1.0 - 1e-5))) / (2e-5 * y)
        assert slope == pytest.approx(radius**2 * (1.0 - float(froude(wave)[k])), rel=1e-7, abs=1e-7)


# h_0/R, p over that of the free wave, largest w_0/h_0 of waves out of phase: by another code.
FOLDS = (
    (0.1, 1.05, 0.002810558),
    (0.1, 1.1, 0.010372250),
    (0.1, 1.2, 0.039130892),
    (0.1, 1.3, 0.085666761),
    (0.1, 1.5, 0.230884010),
    (0.3, 1.05, 0.004788178),
    (0.3, 1.1, 0.015564431),
    (0.3, 1.2, 0.052327347),
    (0.3, 1.3, 0.107335961),
    (0.3, 1.5, 0.26569846),
)


@kills("solvers.potential.model:_fold", "slope**2 / (4.0 * bend)", "slope**2 / (2.0 * bend)")
@kills("solvers.potential.model:end", "> linear_detuning", "< linear_detuning")
def test_folds() -> None:
    """A parabola through heights of 4 % apart: its error is of the fourth power of these."""
    for layer, apart, largest in FOLDS:
        failed = forced(layer, apart**2 * linear_detuning(layer), 2.0 * largest * layer)
        assert not failed.converged
        found = end(failed)
        assert found.kind is EndKind.FOLD and found.whirl == pytest.approx(largest * layer, rel=2e-5)


@pytest.mark.parametrize(
    ("layer", "ratio", "whirl", "kind", "least", "most"),
    [
        # The smooth branch is known to go on to the first share at least.
        (0.1, 1.3, 0.06, EndKind.CHOKING, 0.0537, 0.058),
        (0.3, 0.7, 0.02, EndKind.RESONANCE, 0.0126, 0.0128),
        (0.5, 2.0, 0.02, EndKind.RESONANCE, 0.01, 0.02),
    ],
)
def test_ends_below_the_resonance(
    layer: float, ratio: float, whirl: float, kind: EndKind, least: float, most: float
) -> None:
    """Where the trough chokes, and where the free wave of 4 or of 3 crests has the speed of the whirl."""
    failed = forced(layer, (1.0 - 1.0 / ratio) ** 2, whirl * layer)
    assert not failed.converged
    found = end(failed)
    assert found.kind is kind and least < found.whirl / layer < most
    if kind is EndKind.RESONANCE:
        apart = [abs((1.0 - 1.0 / ratio) ** 2 / linear_detuning(layer, n) - 1.0) for n in range(2, 9)]
        assert found.crests == 2 + int(np.argmin(apart)) and min(apart) < 0.03
    else:
        assert 0.8 < found.froude < 1.1


def test_waves_that_nodes_do_not_carry() -> None:
    failed = forced(0.1, (1.0 - 1.0 / 0.95) ** 2, 0.08, 64)
    assert not failed.converged and end(failed, 64).kind is EndKind.NODES


@kills("solvers.potential.steady:solve", "same and strayed", "False")
def test_a_growing_whirl_does_not_jump_to_another_branch() -> None:
    """Next to the free waves of one crest and two other waves are near by, of another shape."""
    square = (1.0 - 1.0 / 0.765) ** 2
    for whirl in (0.0005, 0.001):
        assert not forced(0.1, square, 0.1 * whirl).converged
