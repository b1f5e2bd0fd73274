"""Models compared where baffles stand in the liquid."""

from __future__ import annotations

import numpy as np
import pytest

from leblanc.scene.scene import Scene
from meshes.errors import InputError
from tests.leblanc.studies.optimise.test_walls import rig as walls
from validation.trade.answers import HELD, RESPONSE, RUNUP, SMALL, Case, answer
from validation.trade.cases import questions
from validation.trade.trade import trade_scene

RUNUP_TABLE = {"start": 40.0, "stop": 200.0, "rate": 80.0, "duration": 2.2, "cells": 64}


def rig(tip: float, **more: object) -> Scene:
    """60 ml and eight plates in one chamber, at two speeds beyond those that gravity upsets."""
    changes = {
        "chambers.0.volume": 6e-5,
        "speeds": {"start": 80.0, "stop": 160.0, "count": 2},
        "model": {"liquid": "auto", "friction": {"linear": 10.0}},
    }
    return walls({"count": 8, "tip_radius": tip}, **{"runup": RUNUP_TABLE, **changes, **more})


def test_compartments_have_the_models_that_know_them() -> None:
    """Elements on several meshes, and long waves held in time with four cells in each; all agree."""
    response, runup = questions(rig(0.02), quick=True)
    labels = {case.label for case in response.cases}
    assert not any(name in label for label in labels for name in ("statics", "linear"))
    assert min(case.resolution or 32 for case in response.cases if case.variant == HELD) >= 32
    best = answer(response.scene, Case(RESPONSE, "long_wave", 32, HELD))
    for case in (Case(RESPONSE, "auto"), Case(RESPONSE, "fem", 12, SMALL), Case(RESPONSE, "fem", 48, SMALL)):
        # The cells' own error is up to 1e-2, as `trade` finds with four times as many.
        found = answer(response.scene, case)
        np.testing.assert_allclose(found.values, best.values, rtol=1e-2)
        # Compartments keep their volume in a synchronous whirl: of itself the closed form answers.
        assert found.used == ("linear" if case.model == "auto" else "fem",) and found.in_range
    assert all(case.model != "linear" for case in runup.cases)
    coarse, fine = (answer(runup.scene, Case(RUNUP, "long_wave", n)).values for n in (32, 64))
    assert np.abs(coarse - fine).max() < 0.02 * fine.max()


def test_plates_that_the_liquid_passes_leave_all_models() -> None:
    """None of them is a different liquid in a synchronous whirl; a layer alone is that of a clear ring."""
    scene = rig(0.06)
    response, runup = questions(scene, quick=True)
    assert {"statics", "linear"} <= {case.label for case in response.cases}
    assert "linear" in {case.label for case in runup.cases}
    assert questions(scene.replace({"model.liquid": "long_wave"}), quick=True)[-1].name == RUNUP
    with pytest.raises(InputError, match=r"chambers\.0\.baffles"):
        questions(scene, layer=True)
    with pytest.raises(InputError, match="two directions"):
        trade_scene(rig(0.02, **{"chambers.0.baffles": {"count": 2}}), quick=True)
