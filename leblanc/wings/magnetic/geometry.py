"""A rotor in magnetic bearings as a picture draws it: its trial in time, or its orbit at a speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from leblanc.plotting.bodies import rounded_down
from leblanc.scene.scene import Scene
from leblanc.wings.magnetic.study import loads_of, rotor_of
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.magnetic.linear import closed_loop, orbit_size
from solvers.rotor.magnetic.motion import integrate

GAP, ORBIT = 0.35, 0.5  # gap as drawn over the rotor's radius, orbit as drawn over the gap
_LONG = 1.3  # of a rotor whose length the scene does not say, over the distance of its bearings
_ROUND = 121  # instants of an orbit


@dataclass(frozen=True)
class MagneticView:
    """A rotor in its two bearings; k instants."""

    picture: ClassVar = "leblanc.view.magnetic:magnetic_picture"
    film: ClassVar = "leblanc.view.magnetic:magnetic_film"

    name: str  #: of the scene
    assumed: bool  #: some of its values are
    lying: bool  #: the axis is horizontal
    controller: str  #: that holds the rotor
    trial: bool  #: the path is that of the trial in time; else an orbit by the unbalances alone
    time: Array  #: of the instants, s and rad/s, shape (k,)
    speed: Array
    displacement: Array  #: along first x, first y, second x, second y of the bearings, m, shape (k, 4)
    gap: float  #: m
    planes: tuple[float, float]  #: of the bearings along the axis, m
    radius: float  #: of the rotor, m
    length: float
    sketched: bool  #: the scene does not say how wide and long it is
    gap_factor: float  #: by which the gap and the path are drawn larger
    path_factor: float

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a rotor in magnetic bearings, SI."""
        return {
            "controller": self.controller,
            "speed": float(self.speed[0]),
            "displacement": self.displacement[0],
            "gap_factor": self.gap_factor,
            "deflection_factor": self.path_factor,
        }


def magnetic_view(
    scene: Scene, mode: int | None = None, speed: float | None = None, factor: float | None = None
) -> MagneticView:
    """A rotor in magnetic bearings with its first controller, in its trial or in an orbit at a speed, rad/s.

    The trial is shown where the scene has one and no speed is asked for. The factor is that of the path as
    drawn: the gap's in a trial, chosen for an orbit, if None. An `InputError` says at which speed the
    controller does not hold the rotor.
    """
    rotor = rotor_of(scene)
    if mode is not None:
        raise InputError("--mode", mode, "left out for a rotor in magnetic bearings")
    if factor is not None and not (math.isfinite(factor) and factor > 0.0):
        raise InputError("--factor", factor, "a finite number above 0")
    machine, controller = rotor.machine(), rotor.controllers()[0]
    gap = machine.magnets.gap
    said = rotor.drag is not None
    radius = (
        rotor.drag.radius if rotor.drag is not None else math.sqrt(2.0 * machine.polar_inertia / machine.mass)
    )
    length = rotor.drag.length if rotor.drag is not None else _LONG * (machine.second - machine.first)
    wider = float(f"{rounded_down(GAP * radius / gap):.6g}")
    trial = rotor.trial if speed is None else None
    if trial is not None:
        motion = integrate(
            machine,
            controller,
            trial.law(),
            trial.duration,
            tuple(loads_of(scene).values()),
            place=(*trial.offset, 0.0, 0.0),
            samples=trial.samples,
        )
        time, spin, path, chosen = motion.time, motion.speed, motion.displacement, wider
    else:
        at = scene.speeds.stop if speed is None else speed
        if not (math.isfinite(at) and at > 0.0):
            raise InputError("--speed", at, "a finite number above 0")
        loop = closed_loop(machine, controller, at)
        if not loop.stable:
            raise InputError("--speed", at, f"one at which {controller.name} control holds the rotor")
        place, _ = loop.unbalance()
        turn: Array = np.linspace(0.0, 2.0 * math.pi, _ROUND)
        time, spin = turn / at, np.full(_ROUND, at)
        path = (place * np.exp(1j * turn[:, None])).real
        largest = float(orbit_size(place).max())
        chosen = float(f"{rounded_down(wider * ORBIT * gap / largest):.6g}") if largest > 0.0 else wider
    return MagneticView(
        name=scene.name,
        assumed=bool(scene.assumed),
        lying=rotor.axis == "horizontal",
        controller=controller.name,
        trial=trial is not None,
        time=time,
        speed=spin,
        displacement=path,
        gap=gap,
        planes=(machine.first, machine.second),
        radius=radius,
        length=length,
        sketched=not said,
        gap_factor=wider,
        path_factor=chosen if factor is None else factor,
    )
