"""Where the layer of a run-up is a fair picture of the liquid, and which models may be asked for."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.waves import capture_speed
from fluid.whirl import covering_speed, is_full
from meshes.border import InputError
from solvers.runup import MODELS, RunupHistory
from study.fidelity import axial_gravity
from study.scene import Scene
from study.validity import RANGES

Flags = NDArray[np.bool_]


def liquid_model(scene: Scene) -> str:
    """Most exact liquid model that a scene's run-up may take: the one it asks for, or long waves.

    Raises
    ------
    InputError : the scene asks for a model that does not go through time
    """
    asked = scene.model.liquid
    if asked not in ("auto", *MODELS):
        raise InputError("model.liquid", asked, "auto, " + " or ".join(MODELS) + " for a run-up")
    return "long_wave" if asked == "auto" else asked


def judged(scene: Scene, history: RunupHistory, model: str | None = None) -> tuple[Flags, tuple[str, ...]]:
    """Where the layer is a fair picture of the liquid, and in words why it is none elsewhere.

    A layer must turn fast enough itself, whatever the drum does, must not be deep beside its radius
    [theory: long_wave, eq. 4], and must leave the inner wall clear.

    Parameters
    ----------
    scene : the machine
    history : its run-up, k times
    model : of its layers; what the scene asks for, or long waves, if None

    Returns
    -------
    Truth values, shape (k,), and one sentence for each reason
    """
    good = np.ones(history.time.shape, dtype=bool)
    words: list[str] = []
    deepest, highest = RANGES["long_wave"]["relative_depth"][1], RANGES["linear"]["wave_amplitude"][1]
    linear = (model or liquid_model(scene)) == "linear"
    for k, fill in enumerate(scene.chambers):
        if fill.volume == 0.0 or is_full(fill):
            continue
        wall, label = fill.chamber, f"chamber {k + 1}"
        own = history.speed + history.mean_rotation[:, k]
        held = history.captured[:, k] & (np.abs(own) > held_from(scene, fill))
        reached = np.nan_to_num(history.depth_max[:, k]) >= wall.radius - wall.inner_radius
        touches = reached & (wall.inner_radius > 0.0)
        # The exact linear theory holds at any depth.
        shallow = linear or fill.depth <= deepest * wall.radius
        rise = np.nan_to_num(history.depth_max[:, k] - fill.depth)
        small = ~(linear & (rise > highest * fill.depth))
        reasons = (
            (held, f"the liquid in {label} turns too slowly to stand round the wall against gravity"),
            (~touches, f"the surface reaches the inner wall of {label}"),
            (np.full(good.shape, shallow), f"the layer in {label} is deeper than {deepest:g} of its radius"),
            (small, f"the wave in {label} is higher than {highest:g} of the depth, beyond linear theory"),
        )
        for holds, why in reasons:
            good &= holds
            if not holds.all():
                words.append(f"Out of range for {1.0 - np.mean(holds):.0%} of the samples: {why}.")
    return good, tuple(words)


def held_from(scene: Scene, fill: Fill) -> float:
    """Rotation of the liquid itself above which it stands round its wall in spite of gravity, rad/s.

    Its centrifugal acceleration at the surface must exceed gravity [theory: waves, eq. 11]; if the axis
    stands, the paraboloid must also cover the wall's height and leave an inner wall clear.
    """
    held = float(capture_speed(fill.surface_radius, scene.gravity))
    return max(held, covering_speed(fill, axial_gravity(scene)))
