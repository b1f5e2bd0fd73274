"""Which liquid model a scene needs at each speed, and where that model holds."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.waves import capture_speed
from meshes.border import InputError
from solvers.liquid_models import SYNCHRONOUS_MODELS
from study.scene import Scene

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Choice:
    """The liquid model of a scene.

    Parameters
    ----------
    model : name of the model taken
    reason : why, in plain words
    in_range : where it holds, shape (n,) over the scene's speeds
    captured_from : speed above which the liquid rides with the drum, rad/s; None if at every speed
    """

    model: str
    reason: str
    in_range: NDArray[np.bool_]
    captured_from: float | None


def axial_gravity(scene: Scene) -> float:
    """Gravity along the rotor's axis, m/s^2: none if the axis lies."""
    return scene.gravity if scene.rotor.axis == "vertical" else 0.0


def choose(scene: Scene) -> Choice:
    """Liquid model for the synchronous response of a scene.

    Raises
    ------
    InputError : the scene asks for a model that does not answer the synchronous response
    """
    asked = scene.model.liquid
    if asked not in ("auto", *SYNCHRONOUS_MODELS):
        allowed = ", ".join(("auto", *SYNCHRONOUS_MODELS))
        raise InputError("model.liquid", asked, f"one of {allowed} for the response to an unbalance")
    model = "statics" if asked == "auto" else asked
    reason = {
        "auto": "the deflection turns with the drum, so the liquid is at rest in it; the exact equilibrium "
        "answers that at any amplitude, and no cheaper model does once part of the wall is dry",
        "statics": "the scene asks for the exact equilibrium",
        "linear": "the scene asks for the linear theory, which holds while the deflection is below the mean "
        "depth of the layer",
    }[asked]
    speed = scene.speed_array()
    captured_from = _captured_from(scene)
    in_range = np.ones(speed.shape, dtype=bool) if captured_from is None else speed > captured_from
    return Choice(model, reason, in_range, captured_from)


def _captured_from(scene: Scene) -> float | None:
    """Speed above which centrifugal acceleration holds every layer against gravity across the axis, rad/s."""
    layers = [fill for fill in scene.chambers if _has_surface(fill)]
    if scene.rotor.axis == "vertical" or scene.gravity == 0.0 or not layers:
        return None
    return max(float(capture_speed(fill.surface_radius, scene.gravity)) for fill in layers)


def _has_surface(fill: Fill) -> bool:
    """Neither empty nor full to rounding."""
    return 0.0 < fill.volume < fill.chamber.capacity * (1.0 - 1e-9) and fill.surface_radius > 0.0
