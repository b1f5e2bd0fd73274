"""Whirls of limit cycles: their size out of a motion, and what it does to long waves."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from leblanc.liquid.choose import Prepared, prepare
from leblanc.scene.examples import example
from leblanc.studies.held.whirls import own_whirl, wave_errors
from solvers.held.integrate import start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics
from solvers.wave_error import long_wave_error
from tests.mutants import kills

SPIN, WHIRL, SIZE = 30.0, 24.0, 2e-4  # rad/s, m


def machine(**change: object) -> Prepared:
    return prepare(example("runup").replace({"model.liquid": "long_wave", **change}))


def cycle(of: Prepared, size: float = SIZE, kind: HeldKind = HeldKind.LIMIT_CYCLE) -> HeldState:
    """A motion with the spin, one at its own speed, one against the spin, and where it stands."""
    time = np.linspace(0.0, 40.0 * 2.0 * math.pi / SPIN, 1501)[:-1] + 0.7
    time = time + 0.01 / SPIN * np.sin(7.0 * time)  # not quite even
    axis = 1e-3 * np.exp(1j * SPIN * time) + size * np.exp(1j * (WHIRL * time + 0.4)) + 3e-5
    axis = axis + 1e-4 * np.exp(-1j * SPIN * time)
    held, coordinates = HeldMachine(of.system, tuple(of.scene.fills)), np.zeros(2, dtype=complex)
    moment = start(held, SPIN, HoldNumerics(cells=8), coordinates)
    each = np.ones(len(of.scene.fills))
    return HeldState(
        spin=SPIN, kind=kind, amplitude=1e-3, crest=1.3e-3, least=7e-4, largest=1.3e-3,
        coordinates=coordinates, rest=np.zeros(2), liquid=0j * each, ripple=0.0 * each,
        whirl_speed=WHIRL if kind is HeldKind.LIMIT_CYCLE else math.nan, dry=each < 0.0, captured=each > 0.0,
        mean_rotation=0.0 * each, mass_error=0.0, change=0.0, turns=40, steps=1500, moment=moment,
        path=np.column_stack([time, axis.real, axis.imag]),
    )  # fmt: skip


@kills("leblanc.studies.held.whirls:own_whirl", "first + 1j * second", "first - 1j * second")
@kills("leblanc.studies.held.whirls:own_whirl", "np.arange(-_LINES, _LINES + 1)", "np.arange(0)")
def test_a_whirl_is_found_beside_all_that_goes_with_the_spin() -> None:
    of = machine()
    # Parts at other speeds fit to rounding over the condition of six waves on 40 turns.
    assert own_whirl(of.system, cycle(of), 0.0) == pytest.approx(SIZE, rel=1e-9)
    assert own_whirl(of.system, cycle(of, 0.0), 0.0) < 1e-9 * SIZE


@kills(
    "leblanc.studies.held.whirls:_error", "state.spin / state.whirl_speed", "state.whirl_speed / state.spin"
)
@kills("leblanc.studies.held.whirls:_error", "/ fill.depth\n", "\n")
def test_long_waves_err_as_under_a_whirl_of_the_cycles_speed_and_size() -> None:
    of = machine()
    (fill,) = of.scene.fills
    layer = fill.depth / fill.chamber.radius
    small = 1e-3 * fill.depth
    expected = float(long_wave_error(layer, (1.0 - SPIN / WHIRL) ** 2, small / fill.depth, False))
    assert math.isfinite(expected)
    found = wave_errors(of, [cycle(of, small), cycle(of, small, HeldKind.PERIODIC), cycle(of, fill.depth)])
    assert found[0] == pytest.approx(expected, rel=1e-6)
    # No whirl of its own, and one that no smooth wave follows.
    assert np.isnan(found[1:]).all()


def test_nothing_is_known_of_other_waves() -> None:
    of = machine()
    state = cycle(of, 1e-3 * of.scene.fills[0].depth)
    assert np.isnan(wave_errors(machine(**{"model.liquid": "potential"}), [state])).all()
    fallen = replace(state, captured=np.zeros(1, dtype=bool))
    assert np.isnan(wave_errors(of, [fallen])).all()
    baffled = machine(**{"chambers.0.baffles": {"count": 4, "tip_radius": 0.145}})
    assert np.isnan(wave_errors(baffled, [state])).all()
