"""The measured top loader as a scene: what its logs tell, what is assumed, and five values that are drawn.

One set of values holds for all seven fills. The ring was three quarters full with 250 ml added, as the source
found, so that what was in it before follows from the volume of the ring.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

from leblanc.liquid.choose import across_gravity
from leblanc.scene.programme.table import Programme
from leblanc.scene.scene import Scene, load_scene
from leblanc.studies.drives import drive_of, numerics_of, planned
from leblanc.studies.optimise.filled import FilledMachine
from leblanc.studies.runup.study import chosen_run
from meshes.arrays import Array
from solvers.layer.records import Outcome
from solvers.runup.runup import RunupHistory

SCENE = Path(__file__).parents[2] / "data" / "fill_sweep.toml"
ML = 1e-6  # m^3
# Shares of the ring and ml added, as the source saw them.
_FULL, _WITH = 0.75, 250.0
_TIP = 0.7  # of the gap, over which a baffle stands
# Motor off, the drum of the logs slows down from 12.4 to 10.3 Hz in 3.7 s.
SLOWING = 2.0 * math.pi * (12.4 - 10.3) / 3.7
CRUISE = 2.0 * math.pi * 12.5
# Above this speed the resonance lies behind, rad/s.
PASSED = 1.4 * 2.0 * math.pi * 4.3


@dataclass(frozen=True)
class Values:
    """What no one has measured on the machine."""

    unbalance: float  #: of the load, kg m
    damping_ratio: float  #: of the suspension
    torque: float  #: of the motor up to 570 rpm, N m
    ring: float  #: volume of the whole ring, m^3
    loss: float  #: coefficient of each baffle

    @property
    def before(self) -> float:
        """Liquid that was in the ring before any was added, m^3."""
        return _FULL * self.ring - _WITH * ML


# Ranges from which they are drawn, evenly in their logarithms.
RANGES: dict[str, tuple[float, float]] = {
    "unbalance": (0.02, 0.6),
    "damping_ratio": (0.02, 0.3),
    "torque": (1.5, 12.0),
    "ring": (400.0 * ML, 1000.0 * ML),
    "loss": (0.1, 30.0),
}


@cache
def base() -> Scene:
    """The machine with the values of its file."""
    return load_scene(SCENE)


def machine(values: Values, added: float) -> Scene:
    """Machine with drawn values and this much water added to the ring, ml."""
    ring = base().liquids[0]
    outer = float(ring.radius or 0.0)
    inner = math.sqrt(outer**2 - values.ring / (math.pi * ring.height))
    changes: dict[str, object] = {
        "rotor.unbalance": values.unbalance,
        "rotor.damping_ratio": values.damping_ratio,
        "runup.motor.torques": [values.torque, values.torque, 0.0],
        "chambers.0.inner_radius": inner,
        "chambers.0.volume": values.before + added * ML,
        "chambers.0.baffles.tip_radius": outer - _TIP * (outer - inner),
        "chambers.0.baffles.loss": values.loss,
    }
    return base().replace(changes)


def in_time(scene: Scene) -> RunupHistory:
    """Run-up or programme of a scene, without the second run for its error."""
    plan = planned(scene)
    numerics = numerics_of(plan, check=False)
    return chosen_run(scene, drive_of(plan, scene.rotor), across_gravity(scene), numerics).history


def shaking(history: RunupHistory) -> Array:
    """Signal of the sensor on the cabinet, up to a factor, shape (k,).

    The suspension presses on the cabinet, which gives way elastically: its acceleration goes as the
    deflection of the tub times the square of the speed.
    """
    return np.asarray(history.amplitude * np.square(history.speed))


@dataclass(frozen=True)
class Answer:
    """What is compared of one fill."""

    passage: float  #: largest shaking up to where the resonance lies behind, m rad^2/s^2
    speed: float  #: of the drum when the motor goes off, rad/s
    cruise: float  #: amplitude at the highest speed, m


def answer(values: Values, added: float, cells: int | None = None) -> Answer:
    """Sprint and cruise of the machine with one fill, ml added."""
    scene = machine(values, added)
    history = in_time(scene if cells is None else scene.replace({"runup.cells": cells}))
    if history.outcome != Outcome.DONE:
        raise RuntimeError(f"{values} with {added:g} ml ended with {history.outcome.name}")
    near = history.speed <= PASSED
    return Answer(float(shaking(history)[near].max()), float(history.speed[-1]), cruise(scene))


def cruise(scene: Scene) -> float:
    """Amplitude at the highest speed, where the liquid rests in the drum and baffles do nothing, m."""
    clear = scene.altered(chambers=tuple(c.altered(baffles=None) for c in scene.liquids))
    fills = np.array([[scene.liquids[0].volume]])
    return float(FilledMachine(clear).at(fills, np.array([CRUISE])).amplitude[0])


def coasting(values: Values, added: float) -> RunupHistory:
    """Machine with its motor off, from its highest speed down to half the resonance."""
    scene = machine(values, added)
    assert scene.runup is not None and scene.runup.motor is not None
    inertia = scene.runup.motor.inertia
    way = Programme(
        start=scene.runup.stop,
        steps=["hold 2 s", f"coast to {0.5 * PASSED / 1.4} rad/s"],
        inertia=inertia,
        drag_torque=inertia * SLOWING,
        cells=scene.runup.cells,
        samples=scene.runup.samples,
    )
    return in_time(scene.altered(runup=None, programme=way))
