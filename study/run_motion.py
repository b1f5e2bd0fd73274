"""Response of a scene whose rotor tilts, or moves differently in two directions."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from solvers.coupled_response import CoupledResponse, coupled_response, wet_critical_speeds
from solvers.mixed_response import mixed_coupled
from solvers.rotor.campbell import campbell
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import (
    critical_speeds,
    modes,
    orbit,
    unbalance_response,
    whirl_direction,
)
from study.fidelity import Choice, axial_gravity
from study.machine import dry_rotor
from study.record import ModeRecord, Motion
from study.scene import Scene, TubRotor

Complex = NDArray[np.complex128]

_DIAGRAM = 121  # speeds of a Campbell diagram

# What each coordinate of the rotors means, in words.
_WORDS = {
    "x": "shift along x",
    "y": "shift along y",
    "z": "shift along z",
    "alpha": "turn about x",
    "beta": "turn about y",
    "gamma": "turn about z",
}


def motion_response(scene: Scene, choice: Choice) -> tuple[CoupledResponse, Motion, tuple[float, float]]:
    """Response of a scene's rotor with all its chambers, and what its vibration is without them.

    Parameters
    ----------
    scene : the machine
    choice : liquid model of the forward part at each speed

    Returns
    -------
    The response; the motion; the critical speeds without and with liquid at which the unbalance moves the
    axis most, rad/s

    Raises
    ------
    InputError : an exciter, or an unknown model
    """
    system, gravity = dry_rotor(scene).system(), axial_gravity(scene)
    found = mixed_coupled(system, scene.chambers, scene.speed_array(), gravity, choice.models)
    dry, dry_shape = critical_speeds(system)
    wet, wet_shape = wet_critical_speeds(system, scene.chambers, gravity, choice.model)
    motion = Motion(
        position=found.position,
        backward=found.backward,
        backward_dry=found.backward_dry,
        branch_backward=found.branch_backward,
        chamber_forward=_at_chambers(system, scene.chambers, found),
        modes=rest_modes(system),
        campbell=campbell(system, np.linspace(0.0, scene.speeds.stop, _DIAGRAM)),
        critical_speeds_dry=_directed(system, dry, dry_shape),
        critical_speeds_wet=_directed(system, wet, wet_shape),
        zero="unbalance" if isinstance(scene.rotor, TubRotor) else "angle 0 of the unbalances",
    )
    return found, motion, main_critical_speeds(system, scene.chambers, found.position, dry, wet)


def _at_chambers(system: RotorSystem, fills: tuple[Fill, ...], found: CoupledResponse) -> Complex:
    """Forward part at every chamber, those without liquid as well, shape (s, c)."""
    places = [orbit(system, found.coordinates, fill.chamber.plane).forward for fill in fills]
    return np.stack(places, axis=1) if places else np.zeros((found.residual.size, 0), dtype=complex)


def rest_modes(system: RotorSystem) -> tuple[ModeRecord, ...]:
    """Modes at rest by rising frequency, each with the coordinate that has most of its energy."""
    found = modes(system)
    energy = np.abs(found.shape[0]) ** 2 * np.diag(system.mass)[:, None]
    most = energy.argmax(axis=0)
    return tuple(
        ModeRecord(float(frequency), float(ratio), _WORDS[system.coordinates[k]])
        for frequency, ratio, k in zip(found.frequency[0], found.damping_ratio[0], most, strict=True)
    )


def _directed(
    system: RotorSystem, speed: NDArray[np.float64], shape: Complex
) -> tuple[tuple[float, float], ...]:
    sense = whirl_direction(system, shape)
    return tuple((float(one), float(way)) for one, way in zip(speed, sense, strict=True))


def main_critical_speeds(
    system: RotorSystem,
    fills: tuple[Fill, ...],
    position: float,
    dry: NDArray[np.float64],
    wet: NDArray[np.float64],
) -> tuple[float, float]:
    """Of the critical speeds without and with liquid those at which the unbalance moves the axis most.

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers
    position : where the axis is looked at, m
    dry, wet : critical speeds, rad/s, at least one each

    Returns
    -------
    rad/s, without and with liquid
    """
    chosen = []
    for speeds, liquid in ((dry, ()), (wet, fills)):
        if speeds.size == 0:
            chosen.append(float("nan"))
            continue
        if liquid:
            found = coupled_response(system, liquid, speeds, 0.0, "linear", position)
            size = np.abs(found.response.deflection) + np.abs(found.backward)
        else:
            size = orbit(system, unbalance_response(system, speeds), position).amplitude
        chosen.append(float(speeds[int(np.argmax(size))]))
    return chosen[0], chosen[1]
