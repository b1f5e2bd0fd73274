"""The layers of a run-up kept at regular times, for a film."""

from __future__ import annotations

import numpy as np

from leblanc.results.runup import RunupFrames
from leblanc.scene.scene import Scene
from meshes.errors import InputError
from solvers.runup.runup import RunupHistory

FRAMES = 180  # of a film
MOST_FRAMES = 2000


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


def runup_frames(history: RunupHistory) -> RunupFrames | None:
    """The layers that a run-up kept [theory: coupling].

    Parameters
    ----------
    history : of a run with snapshots

    Returns
    -------
    In the drum frame; None where no snapshots were asked for
    """
    kept = history.snapshots
    if kept is None:
        return None
    turn = np.exp(-1j * history.angle[kept.sample])
    return RunupFrames(
        time=history.time[kept.sample],
        speed=history.speed[kept.sample],
        deflection=history.deflection[kept.sample] * turn[:, None],
        amplitude=history.amplitude[kept.sample],
        theta=kept.theta,
        depth=kept.depth,
        # Gravity points against the first direction.
        pool=np.angle(-turn),
    )
