"""The layers of a run-up kept at regular times, for a film."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import Scene
from leblanc.studies.runup import RunupRecord, drive_of, liquid_model, planned
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.runup.runup import run_up

FRAMES = 180  # of a film
MOST_FRAMES = 2000


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
    drive, end = drive_of(planned(scene)), float(record.history.time[-1])
    # A multiple of the frames: each frame is then at its own time, if the run comes to its end.
    samples = -(-(record.numerics.samples - 1) // (frames - 1)) * (frames - 1) + 1
    history = run_up(
        dry_rotor(scene).system(),
        scene.fills,
        drive,
        record.friction,
        record.gravity,
        replace(record.numerics, samples=samples, companion=False),
        snapshots=np.linspace(0.0, end, frames),
    )
    shots = history.snapshots
    assert shots is not None
    turn = np.exp(-1j * history.angle[shots.sample])
    return Reel(
        time=history.time[shots.sample],
        speed=history.speed[shots.sample],
        deflection=history.deflection[shots.sample] * turn[:, None],
        amplitude=history.amplitude[shots.sample],
        theta=shots.theta,
        depth=shots.depth,
        # Gravity points against the first direction.
        pool=np.angle(-turn),
    )
