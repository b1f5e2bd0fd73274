"""Lying drums with baffles from rest: their energy closes, no heat is below zero, and they come to their end.

`lying_drums.py` beside this counts how many hundreds of them end.
"""

from __future__ import annotations

import pytest

from leblanc.scene.scene import scene_from_table
from leblanc.studies.runup.answer import RunupAnswer
from leblanc.studies.runup.notes import RunupCode
from leblanc.studies.runup.study import runup_scene
from tests.leblanc.metamorphic.lying_drums import PHYSICAL_REASONS, outcome, run
from tests.oracles.machines import MACHINES, Table
from tests.oracles.random_balls import machine_with_balls

# What each broke off by: drag that overshot (13, 17), closed baffles beside dry cells (19, 42, 61), films
# that a closed baffle drove away (11, 293) or that were pushed as the deep state at their face (33),
# gravity's work by a momentum that was not that of the centre of mass (25, 278), the drive's work at the mean
# spin beside stiff friction (45), heat of bores below zero by what the scheme gives back (238), momentum
# of flow that a closed baffle holds back (149), films that ran dry pushed as the deep state at their face
# (190), a motor that its pool holds at a millionth of its speed (83).
SEEDS = (11, 13, 17, 19, 25, 33, 42, 45, 61, 83, 149, 190, 238, 278, 293)
# Mass and volume of drum 190 off by these shares: a cell that holds an eighth of what fills its gap filled it
# at its face, was emptied in a step by the waves of a full gap, and kept its momentum (8 to 37 % left).
OFF = (
    0.0,
    1e-10,
    3.0611456632961178e-12,
    7.637249731937225e-11,
    1.1655668431641441e-12,
    -5.185663474007379e-9,
)


@pytest.mark.parametrize("seed", SEEDS)
def test_lying_drums_end_for_a_physical_reason(seed: int) -> None:
    """Each with its heats; the balance leaves less than what the run itself tells from 5 % on."""
    result = run(seed)
    assert outcome(result) in PHYSICAL_REASONS
    audit = result.energy
    assert min(audit.support, audit.friction, audit.bores, audit.baffles) >= -1e-12 * audit.scale
    assert result.energy_error < 0.05


@pytest.mark.parametrize("off", OFF)
def test_a_thin_cell_is_not_emptied_by_the_waves_of_a_full_gap(off: float) -> None:
    """Rounding decides what falls dry in drum 190; in none of its ways may it gain energy."""
    result = run(190, off)
    assert outcome(result) in PHYSICAL_REASONS
    assert result.energy_error < 0.01


def sound(result: RunupAnswer, open_: float) -> None:
    """No heat below zero, and a balance that leaves no more than a share of its largest term."""
    audit = result.energy
    assert result.history.converged, result.history.reason
    assert min(audit.support, audit.friction, audit.bores, audit.baffles) >= 0.0
    assert audit.scale > 0.0 and result.energy_error < open_


def programme(table: Table, liquid: str, drag: float) -> RunupAnswer:
    """From rest to a speed, down, up again and coasting to a stand."""
    top = table["speeds"]["stop"]
    steps = [f"to {top} rad/s in 0.6 s", f"to {0.3 * top} rad/s in 0.2 s", f"to {top} rad/s in 0.1 s"]
    way = {"start": 0.0, "steps": [*steps, "coast to 0 rad/s"], "inertia": 0.05, "coast_limit": 0.5}
    how = {"cells": 16, "samples": 50, "drag_torque": drag, "drag_rate": drag}
    model = {"liquid": liquid, "friction": {"linear": 1e4 * drag}}
    changed = {name: part for name, part in table.items() if name != "runup"}
    scene = scene_from_table(changed | {"model": model, "programme": way | how}, table["name"])
    return runup_scene(scene, check=False)


@pytest.mark.parametrize("liquid", ["linear", "long_wave"])
@pytest.mark.parametrize("kind", MACHINES)
def test_every_rotor_with_liquid_keeps_its_energy(kind: str, liquid: str) -> None:
    """Starts from rest, reversals and stops of planar, two-plane and tub, soft and stiff drag.

    The steps are as coarse as they may be, 16 cells: their error is of second order in 1/16 of a turn.
    """
    for drag in (1e-3, 10.0):
        sound(programme(MACHINES[kind], liquid, drag), 0.05)


@pytest.mark.parametrize("seed", range(6))
def test_every_rotor_with_balls_keeps_its_energy(seed: int) -> None:
    """Balls that roll with resistance and drag, on lying and upright axes, from a start to a stand."""
    table = machine_with_balls(seed)
    table["rotor"]["axis"] = ("vertical", "horizontal")[seed % 2]
    for race in table["chambers"]:
        race["rolling_resistance"] = 0.02 * (seed // 2)
    sound(programme(table, "auto", (0.1, 10.0)[seed % 2]), 0.05)


def test_a_drum_that_its_pool_turns_back_has_ended_its_coast() -> None:
    """A pool held up on one side by friction falls back once the light drum is free, drum and all."""
    table = {name: part for name, part in MACHINES["jeffcott"].items() if name != "runup"}
    model = {"liquid": "long_wave", "friction": {"linear": 20.0}}
    way = {"start": 4.0, "steps": ["hold 2 s", "coast 3 s"], "inertia": 3e-5, "drag_torque": 1e-9}
    scene = scene_from_table(table | {"model": model, "programme": way | {"cells": 64, "samples": 50}}, "")
    result = runup_scene(scene, check=False)
    assert result.converged and not result.reason
    # 0.005 of its highest speed is a stand, found to a millionth of it.
    assert 2.0 < result.time[-1] < 2.1 and 0.0 < result.speed[-1] < 0.02 * (1.0 + 1e-6)
    assert RunupCode.STANDING in {note.code for note in result.notes}
