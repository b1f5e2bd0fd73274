"""A scene made ready for the solvers: rotor, speeds, gravity, the cheapest liquid model within tolerance."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill, Fills
from fluid.friction.laws import Friction, FrictionLaw
from fluid.kdv import refuse_quadratic
from fluid.pool import centrifuging_speed, pool_of
from fluid.waves import capture_speed
from fluid.whirl import covering_speed
from leblanc.core.notes import percent
from leblanc.core.units import small_whirl_friction
from leblanc.liquid.choice import HELD_MODELS, Choice, HeldCost
from leblanc.liquid.models import RUNUP_MODELS, own_model, synchronous_model
from leblanc.liquid.validity import require_supported
from leblanc.scene.scene import LIQUID_MODELS, Runup, Scene, dry_rotor, require_no_balls
from meshes.arrays import Array, Flags
from meshes.chamber_section import rest_offset, surface_is_whole
from meshes.errors import InputError
from solvers.checked_model import CheckedModel, require_outwards
from solvers.held.cost import hold_seconds
from solvers.held.state import HoldNumerics
from solvers.liquid_model import ROUNDING, LiquidModel, Whirls
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.machine import largest_wave
from solvers.sloshing.model import REST_ERROR
from solvers.synchronous.errors import GravityError, LinearError, error_estimate, machine_errors
from solvers.synchronous.response import distance, response
from solvers.whirl.growth import Waves

if TYPE_CHECKING:
    from solvers.rotor.system import RotorSystem
    from solvers.rotor.tub import Tub
    from solvers.rotor.two_plane import TwoPlane


@dataclass(frozen=True)
class Prepared:
    """A machine as solvers take it; every step of a study takes the same one."""

    scene: Scene  #: the machine
    rotor: Jeffcott | TwoPlane | Tub  #: without liquid
    system: RotorSystem  #: its equations of motion
    speed: Array  #: spin speeds, rad/s, shape (n,)
    axial_gravity: float  #: along and across the axis, m/s^2
    across_gravity: float
    friction: Friction  #: of the liquid
    waves: Waves  #: small ones: those of a ring under that friction, or of a model of one's own

    @property
    def drag(self) -> str:
        """Friction of small whirls, in words."""
        if isinstance(self.waves, CheckedModel):
            return f"as the model {self.waves.name} has it"
        return small_whirl_friction(self.waves)

    @property
    def planar(self) -> Jeffcott:
        """The rotor, where it is planar."""
        if not isinstance(self.rotor, Jeffcott):
            raise InputError("rotor.kind", self.scene.rotor.kind, "jeffcott for this")
        return self.rotor


def prepare(scene: Scene, free: bool = False) -> Prepared:
    """The scene's machine as solvers take it."""
    require_no_balls(scene, "this; `leblanc run` and `leblanc runup` answer with balls")
    if not free:
        require_supported(scene)
    scene = scene.as_read()
    rotor, waves = dry_rotor(scene), _own(scene)
    if waves is not None:
        _try(waves, scene)
    return Prepared(
        scene=scene,
        rotor=rotor,
        system=rotor.system(),
        speed=scene.speed_array(),
        axial_gravity=axial_gravity(scene),
        across_gravity=across_gravity(scene),
        friction=scene.model.friction,
        waves=scene.model.friction if waves is None else waves,
    )


def _own(scene: Scene) -> CheckedModel | None:
    """The model of one's own that a scene names; None where it is a built-in one."""
    return own_model(scene.model.liquid) if scene.model.liquid not in LIQUID_MODELS else None


def _try(model: CheckedModel, scene: Scene) -> None:
    """Ask a model of one's own for small whirls at the ends of the speeds, once before the work."""
    wet = [fill for fill in scene.fills if fill.volume > 0.0] * 2
    spin = np.repeat([scene.speeds.start, scene.speeds.stop], len(wet) // 2)
    along = np.full(spin.size, axial_gravity(scene))
    require_outwards(model, Fills.of(wet), Whirls.synchronous(spin, np.zeros(spin.size), along))


def axial_gravity(scene: Scene) -> float:
    """Gravity along the rotor's axis, m/s^2: none if the axis lies."""
    return scene.gravity if scene.rotor.axis == "vertical" else 0.0


def across_gravity(scene: Scene) -> float:
    """Gravity across the rotor's axis, m/s^2: none if the axis stands."""
    return scene.gravity if scene.rotor.axis == "horizontal" else 0.0


_NO_DEPTH = 1e-6  # over the surface's radius: a slit that reaches the surface leaves the circle whole
_BALANCED = 1e-3  # of the surface's radius, that the liquid at rest may lie off the axis


def choose(scene: Scene) -> Choice:
    """Liquid model for the synchronous response of a scene at each of its speeds."""
    return choose_all([prepare(scene)])[0]


def choose_all(machines: Sequence[Prepared]) -> list[Choice]:
    """`choose` for several machines, planar ones all at once."""
    for machine in machines:
        _check_walls(machine.scene)
        _check_exact(machine.scene)
        _check_family(machine.scene)
    planar = [machine for machine in machines if isinstance(machine.rotor, Jeffcott)]
    found = iter(_planar_errors(planar) if planar else ())
    errors = [
        next(found)
        if isinstance(m.rotor, Jeffcott)
        else error_estimate(m.rotor, m.scene.fills, m.speed, m.axial_gravity, m.across_gravity)
        for m in machines
    ]
    return [_choice(machine, *pair) for machine, pair in zip(machines, errors, strict=True)]


def models_of(scene: Scene) -> tuple[str, ...]:
    """Names of the liquid models that may answer a scene at some speed."""
    if is_cut(scene):
        return (_beginning(scene),)
    return ("linear", "statics") if scene.model.liquid == "auto" else (_beginning(scene),)


def _beginning(scene: Scene) -> str:
    """The model that answers first: dearer ones begin with the exact equilibrium, or with compartments."""
    if scene.model.liquid not in LIQUID_MODELS:
        return scene.model.liquid
    if is_cut(scene):  # at rest in the drum each compartment keeps its volume: a mass in closed form
        return "fem" if scene.model.liquid == "fem" else "linear"
    if scene.model.liquid == "potential":  # a circle with the spin is one of small waves too, at any height
        return "linear"
    dear = scene.model.liquid == "long_wave" or by_elements(scene)
    return "statics" if dear else scene.model.liquid


def by_elements(scene: Scene) -> bool:
    """Whether the paraboloid in plain chambers is integrated by finite elements at every speed."""
    return scene.model.liquid == "fem" and not is_cut(scene)


def models_at(machines: Sequence[Prepared]) -> list[tuple[NDArray[np.str_], Flags]]:
    """Liquid models of machines that have been chosen for, without an estimate of their errors.

    Names at the speeds of each machine, and whether the liquid rides with the drum there.
    """
    free = [machine.scene.model.liquid == "auto" and not is_cut(machine.scene) for machine in machines]
    judged = [machine for machine, chooses in zip(machines, free, strict=True) if chooses]
    chosen = iter(choose_all(judged) if judged else ())
    found = []
    for machine, chooses in zip(machines, free, strict=True):
        if chooses:
            choice = next(chosen)
            found.append((choice.models, choice.in_range))
        else:
            (name,) = models_of(machine.scene)
            found.append((np.full(machine.speed.shape, name), _carried(machine)))
    return found


def _carried(machine: Prepared) -> Flags:
    """Whether the liquid rides with the drum, and covers a wall that is no circle, shape (n,)."""
    captured_from, speed = captured_speed(machine.scene), machine.speed
    found = np.ones(speed.shape, dtype=bool) if captured_from is None else speed > captured_from
    if is_cut(machine.scene):
        found &= speed > max(_covers(fill, machine.axial_gravity) for fill in machine.scene.fills)
    return found


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
    if is_cut(scene) and scene.model.liquid not in ("auto", "linear", "fem"):
        drawn = any(fill.chamber.section is not None for fill in scene.fills)
        if drawn or scene.model.liquid != "long_wave":
            allowed = (
                "auto, linear or fem where baffles cut the liquid into compartments (or long_wave), or the "
                "section is no circle"
            )
            raise InputError("model.liquid", scene.model.liquid, allowed)


def _check_exact(scene: Scene) -> None:
    """What the fully nonlinear wave leaves out."""
    if scene.model.liquid != "potential":
        return
    if any(fill.uneven and fill.volume > 0.0 for fill in scene.fills):
        raise InputError(
            "model.liquid", "potential", "auto, fem or long_wave where baffles stand in the liquid"
        )
    if scene.model.friction.law is FrictionLaw.QUADRATIC:
        allowed = "none, linear, stokes or wall for fully nonlinear waves, which take the drag on small waves"
        raise InputError("model.friction", "quadratic", allowed)
    if scene.model.cells % 2:
        raise InputError("model.cells", scene.model.cells, "even, for fully nonlinear waves")


def _check_family(scene: Scene) -> None:
    """What waves of KdV-Burgers in time leave out."""
    model = scene.model
    if model.liquid != "kdv" or model.held == "never":
        return
    if any(fill.uneven and fill.volume > 0.0 for fill in scene.fills):
        allowed = "never for kdv where baffles stand in the liquid or a section is no circle"
        raise InputError("model.held", model.held, allowed)
    refuse_quadratic(model.friction, "model.friction")
    if model.cells % 2:
        raise InputError("model.cells", model.cells, "even, for waves of KdV-Burgers")


def may_hold(scene: Scene) -> bool:
    """Whether a scene allows time-domain states."""
    model = scene.model
    return model.liquid in HELD_MODELS or (model.liquid in ("auto", "kdv") and model.held != "never")


def held_model(scene: Scene) -> str:
    """Name of the liquid model that motions are held with."""
    return {"potential": "potential", "kdv": "kdv_held"}.get(scene.model.liquid, "long_wave")


def held_at(scene: Scene, choice: Choice, growth: Array) -> Flags:
    """At which speeds the wave is integrated in time, shape (n,).

    Auto needs it where no steady model is known to be within the tolerance, though the liquid rides with the
    drum, and where whirl is self-excited; fully nonlinear waves there, and with transverse gravity.
    """
    across = scene.rotor.axis == "horizontal" and scene.gravity > 0.0
    if scene.model.liquid == "long_wave" or (scene.model.liquid == "potential" and across):
        return np.ones(growth.shape, dtype=bool)
    if scene.model.liquid == "potential":
        return np.asarray(growth > 0.0)
    if not may_hold(scene) or is_cut(scene):
        return np.zeros(growth.shape, dtype=bool)
    if scene.model.held == "always":
        return np.ones(growth.shape, dtype=bool)
    return np.asarray(choice.in_range & (choice.missed | (growth > 0.0)))


def costed(machine: Prepared, choice: Choice, growth: Array) -> Choice:
    """The choice with what it takes to hold rotor and waves in time at each speed."""
    scene = machine.scene
    drawn = any(fill.chamber.section is not None for fill in scene.fills)
    if drawn or not any(map(_has_surface, scene.fills)):
        return choice
    numerics, liquid = HoldNumerics(cells=scene.model.cells), choice.held_model.removesuffix("_held")
    given = scene.fills, machine.speed, growth, machine.across_gravity, numerics, liquid
    return replace(choice, holding=hold_seconds(*given))


def held_cost(machine: Prepared, choice: Choice, growth: Array) -> HeldCost | None:
    """What it takes to hold what the scene has held, or what auto would hold if it were allowed to.

    None where nothing is to be held.
    """
    scene = machine.scene
    asked = scene.model.held != "never" or scene.model.liquid in HELD_MODELS
    if scene.model.liquid == "kdv" and not asked:
        return None
    ready = scene if asked else scene.altered(model=scene.model.altered(held="auto"))
    at = held_at(ready, choice, growth)
    if choice.holding is None or not at.any():
        return None
    first, last = machine.speed[at][[0, -1]].tolist()
    return HeldCost(int(np.count_nonzero(at)), first, last, float(choice.holding[at].sum()), asked)


def is_cut(scene: Scene) -> bool:
    """The exact equilibrium of a circular chamber does not hold in some chamber."""
    return any(fill.compartments > 1 or fill.chamber.section is not None for fill in scene.fills)


def liquid_models(choice: Choice) -> list[LiquidModel]:
    """The liquid model taken at each speed, as an object."""
    return [synchronous_model(name) for name in choice.models.tolist()]


def _planar_errors(machines: Sequence[Prepared]) -> list[tuple[LinearError, GravityError]]:
    """Error of the linear theory, and by gravity across the axis, of each machine."""
    counts = [machine.speed.size for machine in machines]
    owner = np.repeat(np.arange(len(machines)), counts)
    speed = np.concatenate([machine.speed for machine in machines])
    gravity = np.array([machine.axial_gravity for machine in machines])
    rotors = [(machine.planar, machine.scene.fills) for machine in machines]
    across = np.array([machine.across_gravity for machine in machines])
    error, thrown = machine_errors(rotors, owner, speed, gravity, across)
    ends = np.cumsum(counts)
    parts = [slice(stop - count, stop) for stop, count in zip(ends, counts, strict=True)]
    return [
        (
            LinearError(error.amplitude[part], error.liquid[part], error.wet[part], error.strain[part]),
            thrown.at(part),
        )
        for part in parts
    ]


def _choice(machine: Prepared, linear: LinearError, gravity: GravityError) -> Choice:
    """The cheapest model that the errors allow, or the one that the scene names."""
    scene, speed = machine.scene, machine.speed
    liquid, tolerance = _beginning(scene), scene.model.tolerance
    # What gravity does to all models alike does not speak for the dearer one. Where a wall may run dry the
    # exact equilibrium says where.
    enough = linear.wet & (linear.worst <= tolerance)
    cut = is_cut(scene)
    own = machine.waves if isinstance(machine.waves, CheckedModel) else None
    small = liquid if own is not None or liquid in ("fem", "kdv") else "linear"
    if cut or liquid != "auto":
        enough = np.full(speed.shape, liquid != "statics")
    models = np.where(enough, small, "statics")
    error = np.where(enough, linear.worst, ROUNDING) + gravity.amplitude
    if small == "fem":
        error = error + np.where(enough, REST_ERROR, 0.0)
    if liquid == "kdv" and not cut:
        error = gravity.amplitude + _family_error(machine)
    if own is not None:
        error = gravity.amplitude + _own_error(own, machine)
    if cut:
        # The exact equilibrium of compartments, which would judge small disturbances, is not computed.
        error = np.full(speed.shape, np.nan)
    return Choice(
        # Of the machine alone: the exact equilibrium, unless another is named, or there is none.
        model=small if cut else "statics" if liquid == "auto" else liquid,
        models=models,
        prescribed=scene.model.liquid != "auto",
        in_range=_carried(machine),
        captured_from=captured_speed(scene),
        tolerance=tolerance,
        error=error,
        linear=linear,
        gravity=gravity,
        cut=cut,
        held_model=held_model(scene),
        announced=own is not None and bool(own.called),
    )


def _own_error(model: CheckedModel, machine: Prepared) -> Array:
    """What a model of one's own says of its error for small whirls, the largest of the chambers, (n,)."""
    size, wet = machine.speed.size, [fill for fill in machine.scene.fills if fill.volume > 0.0]
    fills = Fills.of(wet).at(np.repeat(np.arange(len(wet)), size))
    whirls = Whirls.synchronous(
        np.tile(machine.speed, len(wet)), 1e-6 * fills.depth, np.full(len(fills), machine.axial_gravity)
    )
    return np.asarray(model.answer(fills, whirls).error.reshape(len(wet), size).max(axis=0, initial=0.0))


def _family_error(machine: Prepared) -> Array:
    """Distance of the answer by unidirectional waves from the exact equilibrium, relative, shape (n,)."""
    rotor, fills, along = machine.rotor, machine.scene.fills, machine.axial_gravity
    own, exact = (
        response(rotor, fills, machine.speed, along, synchronous_model(name)) for name in ("kdv", "statics")
    )
    return distance(own, exact)


def _covers(fill: Fill, gravity: float) -> float:
    """Speed above which the layer covers the wall over its whole height, rad/s."""
    if fill.chamber.section is None or not fill.uneven:
        return covering_speed(fill, gravity)
    inner = fill.surface_radius
    return math.sqrt(gravity * fill.chamber.height / (fill.depth * (fill.depth + 2.0 * inner)))


def captured_speed(scene: Scene) -> float | None:
    """Speed above which centrifugal acceleration holds every layer against gravity across the axis, rad/s."""
    layers = [fill for fill in scene.fills if _has_surface(fill)]
    if scene.rotor.axis == "vertical" or scene.gravity == 0.0 or not layers:
        return None
    return max(float(capture_speed(fill.surface_radius, scene.gravity)) for fill in layers)


def balance_from(scene: Scene, fill: Fill) -> float | None:
    """Centrifuging speed of liquid that lies at the bottom, rad/s [theory: pool, eq. 20-21].

    inf where nothing drags on it; None where gravity does not act across the axis, no pool lies on a circular
    wall, or closed compartments take it along.
    """
    gravity = across_gravity(scene)
    if gravity == 0.0 or fill.chamber.section is not None or fill.compartments > 1:
        return None
    return _balance(fill, scene.model.friction, gravity)


@lru_cache(maxsize=128)
def _balance(fill: Fill, friction: Friction, gravity: float) -> float | None:
    """`balance_from` of a chamber, the same whatever else of its machine changes."""
    return None if pool_of(fill) is None else centrifuging_speed(fill, friction, gravity)


def carried_from(scene: Scene) -> float | None:
    """Speed above which the walls carry every layer round from rest, rad/s [theory: pool, eq. 20-21].

    inf where nothing drags on one of them; None where no layer lies at the bottom first, or that of a chamber
    whose section is no circle.
    """
    stands = captured_speed(scene)
    if stands is None or any(fill.chamber.section is not None for fill in scene.fills):
        return None
    balances = [balance_from(scene, fill) for fill in scene.fills]
    return max([stands, *(speed for speed in balances if speed is not None)])


def _has_surface(fill: Fill) -> bool:
    """Neither empty nor full to rounding."""
    return 0.0 < fill.volume < fill.chamber.capacity * (1.0 - 1e-9) and fill.surface_radius > 0.0


def _lies(scene: Scene) -> bool:
    """Whether gravity moves the liquid of a run-up before, or after, an annular layer exists."""
    plan, stands = scene.speed_plan, captured_speed(scene)
    if plan is None or stands is None or plan.capture == "riding":
        return False
    slowest = plan.start if isinstance(plan, Runup) else 0.0
    balances = [balance_from(scene, fill) for fill in scene.fills]
    return slowest < max([stands, *(speed for speed in balances if speed is not None)])


def runup_outlook(scene: Scene) -> str:
    """Which liquid model the run-up of a scene will take, as far as that is known before, in words.

    Empty without a run-up or without liquid.
    """
    liquid, tolerance = scene.model.liquid, scene.model.tolerance
    if scene.speed_plan is None or not scene.fills:
        return ""
    if liquid not in ("auto", *RUNUP_MODELS):
        return f"none: {liquid} does not go through time; ask for auto, long_wave or linear"
    if liquid != "auto":
        return f"{liquid}, as the scene asks"
    ruled_out, wave = ruled_out_linear(scene), largest_wave(tolerance)
    if ruled_out:
        return f"long waves: {ruled_out}"
    return (
        f"linear layers first, for a twentieth of the time of long waves; they stay if the surface rises by "
        f"less than {percent(wave)} of the depth and the liquid hardly lags, otherwise long waves follow"
    )


def ruled_out_linear(scene: Scene) -> str:
    """Why linear layers are not tried for the run-up of a scene, or nothing."""
    if _lies(scene):
        return "liquid lies at the bottom at first, and linear layers do not move it"
    if any(fill.uneven for fill in scene.fills):
        return "baffles stand in the liquid, whose waves linear layers do not hold back"
    if scene.runup is not None and scene.runup.motor is not None:
        return "a motor feels the torque of the waves, which linear layers leave out"
    if scene.programme is not None and scene.programme.motor is not None:
        return "a motor feels the torque of the waves, which linear layers leave out"
    if scene.programme is not None and scene.programme.coasts:
        return "a coasting drum feels the torque of the waves, which linear layers leave out"
    if scene.model.friction.law == "quadratic":
        return "linear layers do not feel quadratic friction"
    if largest_wave(scene.model.tolerance) == 0.0:
        return f"linear layers are not known to be within {percent(scene.model.tolerance)}"
    return ""
