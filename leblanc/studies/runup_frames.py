"""The layers of a run-up kept at regular times, for a film."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from leblanc.results.runup import RunupFrames
from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import Scene
from leblanc.studies.prepare import across_gravity
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.runup.drive import Drive, Ramp, torque_curve
from solvers.runup.long_wave import Coupled, couple, reading, switch
from solvers.runup.runup import RunupNumerics

FRAMES = 180  # of a film
MOST_FRAMES = 2000
_MOST = 200_000_000  # steps between two frames


def require_layers(scene: Scene) -> None:
    """A film shows the layers cell by cell.

    Raises
    ------
    InputError : the scene's liquid model has no cells
    """
    if scene.model.liquid == "linear":
        raise InputError("model.liquid", "linear", "auto or long_wave for a film")


def require_frames(frames: int) -> None:
    """A number of frames that a film can have.

    Raises
    ------
    InputError : too few or too many
    """
    if not 2 <= frames <= MOST_FRAMES:
        raise InputError("frames", frames, f"from 2 to {MOST_FRAMES}")


def runup_frames(scene: Scene, drive: Drive, numerics: RunupNumerics, time: Array) -> RunupFrames:
    """The layers of a run-up at some times [theory: coupling].

    Parameters
    ----------
    scene : the machine; its layers are long waves
    drive, numerics : as in `solvers.runup.runup.run_up`
    time : rising, the first one 0, s, shape (f,)

    Returns
    -------
    RunupFrames; fewer where the run did not come to its end
    """
    start = float(drive.corners()[1, 0])
    system, friction = dry_rotor(scene).system(), scene.model.friction
    gravity = across_gravity(scene)
    machine = couple(system, scene.chambers, start, friction, gravity, numerics.cells, numerics.dispersion)
    machine.drive(torque_curve(drive), 0.0 if isinstance(drive, Ramp) else drive.inertia)
    rows = [_frame(machine)]
    for begin, end in pairwise(time.tolist()):
        if not _advance(machine, drive, begin, end, numerics):
            break
        rows.append(_frame(machine))
    table = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return RunupFrames(**table, theta=np.arctan2(machine.machine.angles[1], machine.machine.angles[0]))


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
    """One frame, by the names of `RunupFrames`."""
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
