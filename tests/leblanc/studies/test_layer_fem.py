"""`leblanc layer --model fem`: forced response of a ring, with baffles or without."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

from fluid.fill import Fill, compartment_share
from fluid.liquid import known_liquid
from leblanc.cli import main
from leblanc.liquid.models import wave_model
from leblanc.studies.layer import layer
from leblanc.studies.layer.answer import LayerAnswer
from leblanc.studies.layer.study import answer_layer
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.sloshing.model import SmallWaves
from tests.mutants import kills

WALL, SURFACE, HEIGHT, SPIN = 0.15, 0.135, 0.05, 40.0
VOLUME = math.pi * (WALL**2 - SURFACE**2) * HEIGHT
WATER = known_liquid("water")


def fill(baffles: Baffles | None = None) -> Fill:
    return Fill(Chamber(WALL, HEIGHT, baffles=baffles), WATER, VOLUME)


def answer(whirl: float, model: str, baffles: Baffles | None = None) -> LayerAnswer:
    return answer_layer(fill(baffles), SPIN, whirl, 1e-4, wave_model(model))


@kills(
    "solvers.sloshing.model:SmallWaves.wave",
    "whirl.speed**2 * whirl.amplitude",
    "whirl.spin**2 * whirl.amplitude",
)
@kills(
    "solvers.sloshing.model:SmallWaves.wave",
    "chamber.radius - inner - drawn",
    "chamber.radius - inner + drawn",
)
def test_a_clear_ring_is_linear_theory() -> None:
    """On both sides of both waves, which lie at 57.8 and 30.6 rad/s."""
    for whirl in (-30.0, 10.0, 27.0, 33.0, 45.0, 55.0, 65.0, 120.0):
        exact, found = answer(whirl, "linear"), answer(whirl, "fem")
        # 96 cells: (2 pi/96)^4 = 2e-5 with a small constant, enlarged by the distance to the waves.
        assert found.force_ratio == pytest.approx(exact.force_ratio, rel=2e-6, abs=2e-7)
        assert found.offset == pytest.approx(exact.offset, rel=2e-6, abs=1e-10)
        height = np.abs(exact.depth - (WALL - SURFACE)).max()
        # The surface is fitted to slopes, which are of second order: (2 pi/96)^2/12 = 3.6e-4 of its height.
        np.testing.assert_allclose(found.depth, exact.depth, rtol=0.0, atol=4e-4 * height)


@kills(
    "solvers.sloshing.model:SmallWaves.wave", "(pull * system.enclosed_area)", "(pull * system.liquid_area)"
)
def test_compartments_at_synchronous_whirl() -> None:
    for count in (3, 4, 6):
        left = 1.0 - (SURFACE / WALL) ** 2 * compartment_share(count)
        assert answer(SPIN, "fem", Baffles(count)).force_ratio == pytest.approx(left, rel=1e-6)


@kills("solvers.sloshing.model:SmallWaves.wave", "moment = -(system", "moment = (system")
@kills("solvers.sloshing.model:SmallWaves.wave", "/ system.liquid_area\n", "/ system.enclosed_area\n")
@kills("solvers.sloshing.model:SmallWaves.wave", "0.5 * (total @ FORWARD)", "0.0 * (total @ FORWARD)")
def test_force_and_offset_obey_newton() -> None:
    """Force and motion of the centre of mass are one statement: G A = A_l (1 + d/w)."""
    shares = {1: 0.1, 3: 1e-7}
    for count, against in shares.items():
        for whirl in (20.0, 35.0, 50.0):
            found = answer(whirl, "fem", Baffles(count, 0.1425))
            liquid, whole = WALL**2 - SURFACE**2, WALL**2
            ratio = liquid / whole * (1.0 + found.offset / 1e-4)
            assert found.force_ratio == pytest.approx(ratio, rel=1e-7)
            told = any("against the whirl" in note.text for note in found.notes)
            assert told == (against > 1e-6)


def test_without_an_amplitude_the_limit() -> None:
    still = answer_layer(fill(), SPIN, 33.0, 0.0, SmallWaves())
    assert still.force_ratio == pytest.approx(answer(33.0, "fem").force_ratio, rel=1e-12)
    assert still.offset == 0.0
    np.testing.assert_allclose(still.depth, WALL - SURFACE, rtol=1e-12)


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"friction": "stokes"}, "friction"),
        ({"gravity": 9.81}, "gravity"),
        ({"cells": 5000}, "cells"),
    ],
)
def test_what_elements_do_not_take(change: dict[str, object], field: str) -> None:
    with pytest.raises(InputError, match=field):
        layer(
            radius=WALL, volume=VOLUME, height=HEIGHT, speed=SPIN, whirl_speed=33.0, whirl_amplitude=1e-4,
            model="fem", **change,  # type: ignore[arg-type]
        )  # fmt: skip


def test_baffles_are_for_elements() -> None:
    with pytest.raises(InputError, match="fem takes them"):
        answer(33.0, "linear", Baffles(3))


def test_the_command(capsys: pytest.CaptureFixture[str]) -> None:
    given = ["--radius", "0.15", "--volume", str(VOLUME), "--height", "0.05", "--speed", "40"]
    whirl = [
        "--whirl-speed",
        "40",
        "--whirl-amplitude",
        "0.1 mm",
        "--model",
        "fem",
        "--baffles",
        "4",
        "--json",
    ]
    assert main(["layer", *given, *whirl]) == 0
    found = json.loads(capsys.readouterr().out)
    left = 1.0 - (SURFACE / WALL) ** 2 * compartment_share(4)
    assert found["force_ratio"] == pytest.approx([left, 0.0], abs=1e-6)
