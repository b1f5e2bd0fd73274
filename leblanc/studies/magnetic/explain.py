"""Numbers of a rotor in magnetic bearings, without any motion in time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from leblanc.results.magnetic.explanation import MagneticExplanation
from leblanc.studies.magnetic.run import rotor_of
from solvers.rotor.magnetic.control import Uncontrolled
from solvers.rotor.magnetic.linear import closed_loop
from solvers.rotor.magnetic.machine import dimensionless

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene

_PLACES = 91  # up to 0.9 of the gap


def explain_magnetic(scene: Scene) -> MagneticExplanation:
    """Numbers that determine how a rotor in magnetic bearings behaves [theory: magnetic, eq. 4-10]."""
    rotor = rotor_of(scene)
    machine, last = rotor.machine(), scene.speeds.stop
    magnets, place = machine.magnets, np.linspace(0.0, 0.9 * machine.magnets.gap, _PLACES)
    currents = np.array([-magnets.limit, 0.0, magnets.limit])[:, None]
    return MagneticExplanation(
        name=scene.name,
        numbers=dimensionless(machine),
        current_stiffness=magnets.current_stiffness,
        position_stiffness=magnets.position_stiffness,
        growth=float(closed_loop(machine, Uncontrolled(), last).poles.real.max()),
        holds=float(machine.outward_force(0.0, magnets.limit)),
        reach=machine.reach,
        fastest={
            control.name: float(-closed_loop(machine, control, last).poles.real.min())
            for control in rotor.controllers()
        },
        place=place,
        force=machine.outward_force(place, currents),
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
    )
