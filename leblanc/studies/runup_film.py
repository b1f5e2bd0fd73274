"""The layers of a run-up kept at regular times, for a film."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import Scene
from leblanc.studies.runup import RunupRecord, drive_of, liquid_model, planned
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.runup.drive import Drive, Ramp, torque_curve
from solvers.runup.long_wave import Coupled, couple, reading, switch
from solvers.runup.runup import RunupNumerics

FRAMES = 180  # of a film
MOST_FRAMES = 2000
_MOST = 200_000_000  # steps between two frames


@dataclass(frozen=True)
class Reel:
    """What the frames of a film show; f frames, l chambers, c cells, everything in the drum frame.

    Parameters
    ----------
    time, speed : s and rad/s, shape (f,)
    deflection : complex, of each chamber's axis, m, shape (f, l)
    amplitude : of the first of them, m, shape (f,)
    theta : angle from the drum's zero mark of the cells, rad, shape (c,)
    depth : of the layers, m, nan where the liquid is none, shape (f, l, c)
    pool : angle of liquid that lies at the bottom, rad, shape (f,)
    """

    time: Array
    speed: Array
    deflection: Complex
    amplitude: Array
    theta: Array
    depth: Array
    pool: Array


def require_layers(scene: Scene) -> None:
    """A film shows the layers cell by cell.

    Raises
    ------
    InputError : the scene's liquid model has no cells
    """
    if liquid_model(scene) == "linear":
        raise InputError("model.liquid", "linear", "auto or long_wave for a film")


def film(scene: Scene, record: RunupRecord, frames: int = FRAMES) -> Reel:
    """Run a scene's run-up again and keep the layers [theory: coupling].

    Parameters
    ----------
    scene : the machine
    record : its run-up, whose end is the film's end
    frames : how many times are kept, at least 2

    Raises
    ------
    InputError : too few frames or too many
    """
    if not 2 <= frames <= MOST_FRAMES:
        raise InputError("frames", frames, f"from 2 to {MOST_FRAMES}")
    drive, numerics = drive_of(planned(scene)), record.numerics
    system, law = dry_rotor(scene).system(), record.friction
    start = float(drive.corners()[1, 0])
    machine = couple(system, scene.fills, start, law, record.gravity, numerics.cells, numerics.dispersion)
    machine.drive(torque_curve(drive), 0.0 if isinstance(drive, Ramp) else drive.inertia)
    wanted = np.linspace(0.0, float(record.history.time[-1]), frames)
    rows = [_frame(machine)]
    for begin, end in pairwise(wanted.tolist()):
        if not _advance(machine, drive, begin, end, numerics):
            break
        rows.append(_frame(machine))
    table = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return Reel(**table, theta=np.arctan2(machine.machine.angles[1], machine.machine.angles[0]))


def _advance(machine: Coupled, drive: Drive, begin: float, end: float, numerics: RunupNumerics) -> bool:
    """From one frame to the next, with a stop at each corner of the ramp; whether it got there.

    Liquid is caught and let go at ten times in between.
    """
    corners = drive.corners()
    within = corners[0][(corners[0] > begin) & (corners[0] < end)]
    stops = np.unique(np.concatenate((np.linspace(begin, end, 11)[1:], within)))
    for stop in stops.tolist():
        switch(machine)
        middle = 0.5 * (machine.time + stop)
        rate = float(_rate(drive, middle)) if isinstance(drive, Ramp) else 0.0
        if machine.advance(stop, rate, numerics.courant, _MOST) != 0:
            return False
    return True


def _rate(drive: Ramp, time: float) -> float:
    """Rate of change of the spin at a time between two corners, rad/s^2."""
    corners = drive.corners()
    k = int(np.clip(np.searchsorted(corners[0], time) - 1, 0, corners.shape[1] - 2))
    return float((corners[1, k + 1] - corners[1, k]) / (corners[0, k + 1] - corners[0, k]))


def _frame(machine: Coupled) -> dict[str, object]:
    """One frame, by the names of `Reel`."""
    now = reading(machine)
    turn = np.exp(-1j * now["angle"])
    radius = np.array([[fill.chamber.radius] for fill in machine.fills]).reshape(-1, 1)
    depth = radius * (1.0 - np.sqrt(np.maximum(1.0 - 2.0 * machine.area, 0.0)))
    return {
        "time": now["time"],
        "speed": now["speed"],
        "deflection": now["deflection"] * turn,
        "amplitude": abs(now["deflection"][0]),
        "depth": np.where(machine.active[:, None], depth, np.nan),
        # Gravity points against the first direction.
        "pool": float(np.angle(-turn)),
    }
