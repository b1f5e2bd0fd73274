"""Which liquid model a scene needs at each speed: cheapest within the tolerance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from fluid.waves import capture_speed
from fluid.whirl import covering_speed
from leblanc.scene.machine import dry_rotor, jeffcott
from leblanc.scene.scene import JeffcottRotor, Scene
from meshes.arrays import Array, Flags
from meshes.chamber_section import rest_offset, surface_is_whole
from meshes.errors import InputError
from solvers.synchronous.errors import ROUNDING, LinearError
from solvers.synchronous.estimate import error_estimate, machine_errors
from solvers.synchronous.models import MODEL_NAMES, LiquidModel, model_named

_NO_DEPTH = 1e-6  # over the surface's radius: a slit that reaches the surface leaves the circle whole
_BALANCED = 1e-3  # of the surface's radius, that the liquid at rest may lie off the axis


@dataclass(frozen=True)
class Choice:
    """The liquid model of a scene at each of its speeds, shape (n,).

    Parameters
    ----------
    model : the most exact of the models taken
    models : name of the model taken at each speed
    asked : the scene names the model itself
    in_range : the liquid rides with the drum
    captured_from : speed above which it does, rad/s; None if at every speed
    tolerance : relative error that the scene allows
    error : estimated relative error of what is taken, of amplitude and liquid the larger one; nan where there
        is no estimate
    linear : error of the linear theory against the exact equilibrium
    gravity : estimated error by gravity across the axis, which no model of a steady answer has; nan where the
        liquid does not ride with the drum
    cut : baffles cut the liquid of a chamber into compartments, or its section is no circle
    """

    model: str
    models: NDArray[np.str_]
    asked: bool
    in_range: Flags
    captured_from: float | None
    tolerance: float
    error: Array
    linear: LinearError
    gravity: Array
    cut: bool = False

    @property
    def liquid_models(self) -> list[LiquidModel]:
        """The model taken at each speed, n of them."""
        return [model_named(name) for name in self.models.tolist()]

    @property
    def missed(self) -> Flags:
        """Where even the model taken is not known to be within the tolerance, shape (n,)."""
        return ~(self.error <= self.tolerance)


def axial_gravity(scene: Scene) -> float:
    """Gravity along the rotor's axis, m/s^2: none if the axis lies."""
    return scene.gravity if scene.rotor.axis == "vertical" else 0.0


def across_gravity(scene: Scene) -> float:
    """Gravity across the rotor's axis, m/s^2: none if the axis stands."""
    return scene.gravity if scene.rotor.axis == "horizontal" else 0.0


def choose(scene: Scene) -> Choice:
    """Liquid model for the synchronous response of a scene at each of its speeds.

    Raises
    ------
    InputError : the scene asks for a model that does not answer the synchronous response, or is an exciter
    """
    return choose_all([scene])[0]


def choose_all(scenes: Sequence[Scene]) -> list[Choice]:
    """`choose` for several scenes, those of planar rotors all at once.

    Raises
    ------
    InputError : as `choose`
    """
    for scene in scenes:
        if scene.model.liquid not in ("auto", *MODEL_NAMES):
            allowed = ", ".join(("auto", *MODEL_NAMES))
            raise InputError(
                "model.liquid", scene.model.liquid, f"one of {allowed} for the response to an unbalance"
            )
        _check_walls(scene)
    planar = [scene for scene in scenes if isinstance(scene.rotor, JeffcottRotor)]
    found = iter(_planar_errors(planar) if planar else ())
    errors = [
        next(found) if isinstance(scene.rotor, JeffcottRotor) else _other_errors(scene) for scene in scenes
    ]
    return [_choice(scene, *pair) for scene, pair in zip(scenes, errors, strict=True)]


def _check_walls(scene: Scene) -> None:
    """What there is no model for."""
    for k, fill in enumerate(scene.fills):
        section, area = fill.chamber.section, fill.volume / fill.chamber.height
        if fill.compartments == 2:
            allowed = "3 or more where they reach from the wall through the surface: two compartments answer \
differently in two directions"
            raise InputError(f"chambers.{k}.baffles.count", 2, allowed)
        if section is None or not fill.uneven:
            continue
        if not surface_is_whole(section, area) or fill.depth <= _NO_DEPTH * fill.surface_radius:
            allowed = (
                f"one whose walls the free surface, a circle of {fill.surface_radius:g} m about the axis, "
                "does not meet; `leblanc modes` takes others"
            )
            raise InputError(f"chambers.{k}.section", section.name, allowed)
        if (away := rest_offset(section, area)) > _BALANCED * fill.surface_radius:
            allowed = f"balanced about the axis: the liquid at rest would lie {away:.3g} m off it"
            raise InputError(f"chambers.{k}.section", section.name, allowed)
    if is_cut(scene) and scene.model.liquid not in ("auto", "fem"):
        allowed = "auto or fem where baffles cut the liquid into compartments or the section is no circle"
        raise InputError("model.liquid", scene.model.liquid, allowed)


def is_cut(scene: Scene) -> bool:
    """The exact equilibrium of a circular chamber does not hold in some chamber."""
    return any(fill.compartments > 1 or fill.chamber.section is not None for fill in scene.fills)


def _planar_errors(scenes: Sequence[Scene]) -> list[tuple[LinearError, Array]]:
    """Error of the linear theory, and by gravity across the axis, of each scene."""
    speeds = [scene.speed_array() for scene in scenes]
    owner = np.repeat(np.arange(len(scenes)), [one.size for one in speeds])
    speed, gravity = np.concatenate(speeds), np.array([axial_gravity(scene) for scene in scenes])
    machines = [(jeffcott(scene), scene.fills) for scene in scenes]
    across = np.array([across_gravity(scene) for scene in scenes])
    error, thrown = machine_errors(machines, owner, speed, gravity, across)
    ends = np.cumsum([one.size for one in speeds])
    parts = [slice(stop - one.size, stop) for stop, one in zip(ends, speeds, strict=True)]
    return [
        (
            LinearError(error.amplitude[part], error.liquid[part], error.wet[part], error.strain[part]),
            thrown[part],
        )
        for part in parts
    ]


def _other_errors(scene: Scene) -> tuple[LinearError, Array]:
    """The same of a rotor that tilts, or moves differently in two directions."""
    along, across = axial_gravity(scene), across_gravity(scene)
    return error_estimate(dry_rotor(scene), scene.fills, scene.speed_array(), along, across)


def _choice(scene: Scene, linear: LinearError, gravity: Array) -> Choice:
    """The cheapest model that the errors allow, or the one asked for."""
    speed, asked, tolerance = scene.speed_array(), scene.model.liquid, scene.model.tolerance
    # What gravity does to all models alike does not speak for the dearer one. Where a wall may run dry the
    # exact equilibrium says where.
    enough = linear.wet & (linear.worst <= tolerance)
    cut = is_cut(scene)
    small = "fem" if cut or asked == "fem" else "linear"
    if cut or asked != "auto":
        enough = np.full(speed.shape, asked != "statics")
    models = np.where(enough, small, "statics")
    captured_from = _captured_from(scene)
    held = np.ones(speed.shape, dtype=bool) if captured_from is None else speed > captured_from
    error = np.where(enough, linear.worst, ROUNDING) + gravity
    if cut:
        # The exact equilibrium of compartments, which would judge small disturbances, is not computed.
        held = held & (speed > max(_covers(fill, axial_gravity(scene)) for fill in scene.fills))
        error = np.full(speed.shape, np.nan)
    return Choice(
        model=small if enough.all() else "statics",
        models=models,
        asked=asked != "auto",
        in_range=held,
        captured_from=captured_from,
        tolerance=tolerance,
        error=error,
        linear=linear,
        gravity=gravity,
        cut=cut,
    )


def _covers(fill: Fill, gravity: float) -> float:
    """Speed above which the layer covers the wall over its whole height, rad/s."""
    if fill.chamber.section is None or not fill.uneven:
        return covering_speed(fill, gravity)
    inner = fill.surface_radius
    return math.sqrt(gravity * fill.chamber.height / (fill.depth * (fill.depth + 2.0 * inner)))


def _captured_from(scene: Scene) -> float | None:
    """Speed above which centrifugal acceleration holds every layer against gravity across the axis, rad/s."""
    layers = [fill for fill in scene.fills if _has_surface(fill)]
    if scene.rotor.axis == "vertical" or scene.gravity == 0.0 or not layers:
        return None
    return max(float(capture_speed(fill.surface_radius, scene.gravity)) for fill in layers)


def _has_surface(fill: Fill) -> bool:
    """Neither empty nor full to rounding."""
    return 0.0 < fill.volume < fill.chamber.capacity * (1.0 - 1e-9) and fill.surface_radius > 0.0
