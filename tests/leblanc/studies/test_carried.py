"""Scenes whose baffles carry the liquid round: run-ups, layers, and what `explain` says of them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from fluid.friction.baffles import baffle_torque
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.studies.explain.answer import layer_rows
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.runup.study import runup_scene
from meshes.errors import InputError
from tests.mutants import kills

PLATES = {"count": 4, "tip_radius": "234 mm"}


def ring(plates: dict[str, Any] | None, rate: float = 20.0, **model: Any) -> Scene:
    chamber = {"radius": "240 mm", "inner_radius": "200 mm", "height": "60 mm", "volume": "1.2 l"}
    chamber |= {"liquid": "water"} | ({"baffles": plates} if plates else {})
    rotor = {"kind": "jeffcott", "mass": "12 kg", "critical_speed": "150 rpm", "damping_ratio": 0.1}
    return scene_from_table(
        {
            "name": "ring",
            "rotor": rotor | {"unbalance": "1 kg*mm", "axis": "vertical"},
            "chambers": [chamber],
            "speeds": {"start": 20, "stop": 60, "count": 3},
            "model": {"friction": "none"} | model,
            "runup": {"start": 40, "stop": 44, "rate": rate, "duration": 0.3, "cells": 32, "samples": 20},
        }
    )


def test_a_run_up_with_baffles() -> None:
    """The liquid of a smooth ring stays behind the drum, that between baffles hardly does."""
    lags, heat = [], []
    for plates in (None, PLATES, PLATES | {"loss": 50.0}):
        found = runup_scene(ring(plates, liquid="long_wave"), check=False)
        assert found.converged and found.mass_error < 1e-12
        lags.append(-found.history.mean_rotation[-1, 0])
        heat.append(found.energy.baffles)
    # Without friction nothing turns it: it lags by the 4 rad/s that the drum has gained.
    assert lags[0] == pytest.approx(4.0, rel=0.1)
    assert lags[2] < lags[1] < 0.8 * lags[0]
    assert heat[0] == 0.0 and min(heat[1:]) > 0.0


def test_three_ways_of_baffles_leave_the_same_lag() -> None:
    """Each at its face, smeared over the long waves on 12 cells, and smeared over a linear layer.

    Of the 4 rad/s that the drum has gained the baffles make up for some. What piles up before them takes a
    share of the loss away, which the ways have each in its own manner: they differ by less than that share
    of what was made up for.
    """
    ways = [
        runup_scene(ring(PLATES, liquid=liquid), cells=cells, check=False)
        for liquid, cells in (("long_wave", 64), ("long_wave", 12), ("linear", 64))
    ]
    lags = [-way.history.mean_rotation[-1, 0] for way in ways]
    told = [any(note.code == "smeared_baffles" for note in way.notes) for way in ways]
    assert told == [False, True, True]
    loss = baffle_torque(ring(PLATES).fills[0], 44.0, np.array([0.0, lags[0] / 44.0])).loss
    share = 1.0 - loss[1] / loss[0]
    assert 0.1 < share < 0.2
    np.testing.assert_allclose(lags[1:], lags[0], rtol=0.0, atol=share * (4.0 - lags[0]))
    assert lags[0] < 3.2


def test_compartments_need_their_cells_and_their_waves() -> None:
    closed = {"count": 4, "tip_radius": "201 mm"}
    with pytest.raises(InputError, match="compartments"):
        runup_scene(ring(closed, liquid="linear"), check=False)
    with pytest.raises(InputError, match="16 or more"):
        runup_scene(ring(closed), cells=12, check=False)


@kills("leblanc.studies.explain.study:_carrying", "0.5 * fill.mass", "fill.mass")
@kills("leblanc.studies.explain.study:_carrying", "math.sqrt(asked / able)", "(asked / able)")
def test_outlook() -> None:
    """At the speed it names the baffles' largest torque is what the ramp asks to take the liquid along."""
    scene = ring(PLATES, 60.0)
    layer = explain_scene(scene).layers[0]
    assert layer is not None and layer.carrying is not None
    found, fill = layer.carrying, scene.fills[0]
    lag = np.linspace(0.0, 0.5, 2001)
    at = baffle_torque(fill, found.enough_from, lag)
    most = at.torque[at.froude <= 1.1].max()
    inner = fill.surface_radius
    # A ring that turns as a whole: its moment of inertia is m (R^2 + a^2)/2; lags are 1/4000 apart.
    asked = 60.0 * fill.mass * (fill.chamber.radius**2 + inner**2) / 2.0
    assert found.asked == pytest.approx(asked, rel=1e-12) and most == pytest.approx(asked, rel=3e-3)
    assert found.left_behind and found.speed == 40.0
    assert "slips" in dict(layer_rows(layer))["baffles' torque"]
    slow = explain_scene(ring(PLATES, 2.0)).layers[0]
    assert slow is not None and slow.carrying is not None and not slow.carrying.left_behind
    clear = explain_scene(ring(None)).layers[0]
    assert clear is not None and clear.carrying is None


def test_a_layer_with_baffles() -> None:
    """`layer --model long_wave` takes them: without height they change nothing."""
    asked: dict[str, Any] = {
        "radius": 0.15, "height": 0.05, "volume": 6.7e-4, "speed": 40.0, "whirl_speed": 30.0,
        "whirl_amplitude": 1e-4, "model": "long_wave", "cells": 32, "friction": "linear:2.0",
    }  # fmt: skip
    bare = lb.layer(**asked)
    level = lb.layer(**asked, baffles=4, baffle_tip_radius=0.15 * (1 - 1e-14))
    half = lb.layer(**asked, baffles=4, baffle_tip_radius=0.146)
    assert abs(level.force_ratio - bare.force_ratio) < 1e-6 * abs(bare.force_ratio)
    assert abs(half.force_ratio - bare.force_ratio) > 1e-4 * abs(bare.force_ratio)
    assert half.mass_error < 1e-12


def test_the_digest_counts_a_loss_alone() -> None:
    """A scene with baffles keeps its digest; with a loss coefficient it has another."""
    assert ring(PLATES).digest != ring(PLATES | {"loss": 2.0}).digest


def test_a_gap_that_fills() -> None:
    """A layer thrown against its inner wall stays in range, and the run tells how often it was there."""
    scene = ring(None, 2.0, liquid="long_wave", friction={"linear": 5.0})
    scene = scene.replace({"rotor.unbalance": "0.3 kg*m", "chambers.0.volume": "2.4 l"})
    found = runup_scene(scene, check=False)
    told = {note.code: note.data for note in found.notes}
    assert told["full_gap"]["chamber"] == 1 and 0.0 < told["full_gap"]["share"] <= 1.0
    assert "inner_wall" not in told
    gap = 0.04
    deepest = np.nanmax(found.history.depth_max)
    # The slot takes the rise of the head over it: a few per cent of the gap under a deflection as large.
    assert gap < deepest < 1.03 * gap and found.mass_error < 1e-12


@kills("leblanc.studies.explain.study:_rise", "max(found, key", "min(found, key")
@kills("leblanc.studies.explain.study:_rise", "step.speed > max(speed, above)", "step.speed > speed")
def test_a_programme_asks_by_its_steepest_rise() -> None:
    """Of the rises that end above the speed of capture the steepest counts, for each ring."""
    steps = ["to 50 rpm in 0.5 s", "hold 2 s", "to 400 rpm at 40 rpm/s", "to 900 rpm at 60 rpm/s"]
    scene = lb.example("front_loader").replace({"programme.steps": steps})
    rate = 60.0 * 2.0 * math.pi / 60.0
    for fill, layer in zip(scene.fills, lb.explain(scene).layers, strict=True):
        assert layer is not None and layer.carrying is not None
        inertia = 0.5 * fill.mass * (fill.chamber.radius**2 + fill.surface_radius**2)
        assert layer.carrying.asked == pytest.approx(rate * inertia, rel=1e-12)
        assert layer.carrying.speed == pytest.approx(400.0 * math.pi / 30.0, rel=1e-12)
        assert not layer.carrying.left_behind
