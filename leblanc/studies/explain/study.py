"""What a scene is in numbers, and which liquid model answers it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from fluid.fill import Fill
from fluid.friction.baffles import most_torque
from fluid.friction.laws import FrictionLaw
from fluid.friction.pipe import hydraulic_diameter, regime, spin_up_time, steady_lag
from fluid.numbers import layer_numbers
from fluid.whirl import is_full
from leblanc.core.answer import Later, later
from leblanc.liquid.choice import Choice, HeldCost, model_spans, speed_estimates
from leblanc.liquid.choose import (
    Prepared,
    balance_from,
    choose_all,
    costed,
    held_cost,
    prepare,
    runup_outlook,
)
from leblanc.liquid.models import synchronous_model
from leblanc.liquid.notes import closed_compartments
from leblanc.scene.rows import baffle_words
from leblanc.scene.scene import Runup, Scene
from leblanc.studies.closed_forms.study import closed_forms
from leblanc.studies.explain.answer import (
    BaffleOutlook,
    ExplainAnswer,
    LayerExplanation,
    SpinUp,
    WhirlOutlook,
)
from leblanc.studies.explain.cures import cures
from leblanc.studies.run.motion import RestMode
from leblanc.studies.run.study import rest_modes
from leblanc.studies.volume.study import volumes_over_speed
from meshes.arrays import Array
from solvers.checked_model import CheckedModel
from solvers.cycles.estimate import largest_estimate
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import moving_mass
from solvers.rotor.vibration import axis_is_free, critical_speeds, modes, orbit, unbalance_response
from solvers.synchronous.response import critical_speed, main_critical_speeds, wet_critical_speeds
from solvers.whirl.edges import Bands, unstable_bands
from solvers.whirl.growth import asynchronous_growth


def explain_scene(scene: Scene) -> ExplainAnswer:
    """Dimensionless numbers of a scene and the model that each speed takes."""
    scene = scene.as_read()
    machine = prepare(scene, free=True)
    gravity, (choice,) = machine.axial_gravity, choose_all([machine])
    # What no other number needs is worked out when it is read.
    grown, bands = later(_grown, machine, choice), later(_bands, machine)
    ends = np.array([scene.speeds.start, scene.speeds.stop])
    moved = unbalance_response(machine.system, machine.speed)
    dry = [np.abs(orbit(machine.system, moved, fill.chamber.plane).forward) for fill in scene.fills]
    volumes = volumes_over_speed(
        scene.fills, machine.speed, np.reshape(dry, (len(dry), machine.speed.size)), gravity
    )
    bare = _bare(machine, choice.model)
    layers: list[LayerExplanation | None] = []
    for fill, covering in zip(scene.fills, volumes.wetting_volume[:, -1].tolist(), strict=True):
        if fill.volume == 0.0:
            layers.append(None)
            continue
        layers.append(
            LayerExplanation(
                numbers=layer_numbers(fill, ends, scene.gravity, gravity),
                depth=fill.depth,
                added_mass_ratio=fill.added_mass / bare.mass,
                liquid_mass_ratio=fill.mass / bare.mass,
                optimal_volume=covering,
                walls=_walls(fill),
                carried_from=balance_from(scene, fill),
                spin_up=_spin_up(scene, fill),
                carrying=_carrying(scene, fill, choice.captured_from),
            )
        )
    return ExplainAnswer(
        name=scene.name,
        critical_speed_dry=bare.critical_speed,
        critical_speed_wet=bare.critical_speed_wet if scene.fills else math.nan,
        damping_ratio=bare.damping_ratio,
        speed_ratio=(ends[0] / bare.critical_speed, ends[1] / bare.critical_speed),
        captured_from=choice.captured_from,
        layers=tuple(layers),
        models=later(_by_speed, machine, grown, model_spans) if scene.fills else (),
        estimates=later(_by_speed, machine, grown, speed_estimates) if scene.fills else (),
        tolerance=choice.tolerance,
        modes=bare.modes,
        runup=runup_outlook(scene),
        whirl=later(_whirl, machine, bands),
        cures=later(cures, machine, bands),
        held=later(_held, machine, grown),
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        closed_forms=later(closed_forms, machine),
        wall_volumes=volumes,
    )


def _grown(machine: Prepared, choice: Choice) -> tuple[Choice, Array]:
    """The choice with what it takes to hold waves in time, and the growth of small whirls at each speed."""
    growth = _growth(machine)
    return costed(machine, choice, growth), growth


_FEW = 17  # speeds at which small whirls among baffles are looked at first


def _growth(machine: Prepared) -> Array:
    """Growth of the fastest-growing small whirl at each speed, 1/s, as the cost of holding asks for it.

    Among baffles, where waves take finite elements, at a few speeds and where its sign changes between them;
    elsewhere between those. A narrower band is left to `run`.
    """
    speed, fills = machine.speed, machine.scene.fills
    if speed.size <= _FEW or not any(fill.uneven for fill in fills):
        return asynchronous_growth(machine.rotor, fills, speed, machine.waves)[0]
    found, looked = np.full(speed.size, np.nan), np.zeros(speed.size, dtype=bool)
    at = np.unique(np.round(np.linspace(0, speed.size - 1, _FEW)).astype(np.intp))
    while at.size:
        found[at] = asynchronous_growth(machine.rotor, fills, speed[at], machine.waves)[0]
        looked[at] = True
        have = np.flatnonzero(looked)
        grows = found[have] > 0.0
        apart = (np.diff(have) > 1) & (grows[1:] != grows[:-1])
        at = (have[:-1] + have[1:])[apart] // 2
    known = np.flatnonzero(looked & ~np.isnan(found))
    if known.size == 0:
        return found
    return np.where(looked, found, np.interp(np.arange(speed.size), known, found[known]))


def _bands(machine: Prepared) -> Bands:
    """Bands of self-excited whirl between the machine's first and last speed."""
    return unstable_bands(machine.rotor, [machine.scene.fills], machine.speed, machine.waves)[0]


def _by_speed(machine: Prepared, grown: Later, told: Callable[[Choice, Array], tuple[Any, ...]]) -> Any:
    return told(grown()[0], machine.speed)


def _held(machine: Prepared, grown: Later) -> HeldCost | None:
    return held_cost(machine, *grown())


def _whirl(machine: Prepared, bands: Later) -> WhirlOutlook | None:
    """Size of the self-excited whirl between the scene's first and last speed, of an even layer.

    None where there is none; the rule knows no model of one's own.
    """
    scene, range_ = machine.scene, (float(machine.speed.min()), float(machine.speed.max()))
    if not scene.fills or range_[0] == range_[1] or isinstance(machine.waves, CheckedModel):
        return None
    most = largest_estimate(machine.rotor, scene.fills, range_, scene.model.friction, bands)
    if most is None:
        return None
    return WhirlOutlook(most.spin, most.amplitude, most.whirl_speed, most.lag)


class _Rise(NamedTuple):
    """A rise of the spin speed: from and to, rad/s, and its rate, rad/s^2."""

    start: float
    stop: float
    rate: float


def _rise(scene: Scene, above: float) -> _Rise | None:
    """The steepest rise of a run-up or programme that ends above a speed, rad/s; None without one."""
    plan = scene.speed_plan
    if plan is None or isinstance(plan, Runup):
        return None if plan is None or plan.rate is None else _Rise(plan.start, plan.stop, plan.rate)
    found, speed = [], plan.start
    for step in plan.steps:
        if step.kind == "to" and step.speed is not None and step.speed > max(speed, above):
            rate = step.rate or (step.speed - speed) / (step.time or math.inf)
            found.append(_Rise(speed, step.speed, rate))
        # After a coast for a time the speed is not known before: from rest at the worst.
        speed = speed if step.kind == "hold" else step.speed or 0.0
    return max(found, key=lambda rise: rise.rate, default=None)


# Share of the first lag at which the liquid counts as spun up.
_CARRIED = 0.1


def _spin_up(scene: Scene, fill: Fill) -> SpinUp | None:
    """How the wall carries the liquid along; None unless its law acts on a layer in a clear ring."""
    friction, chamber, rise = scene.model.friction, fill.chamber, _rise(scene, 0.0)
    if friction.law is not FrictionLaw.WALL or fill.uneven or is_full(fill):
        return None
    viscosity = fill.liquid.viscosity
    last = scene.speeds.stop if rise is None else rise.stop
    given = float(hydraulic_diameter(fill.depth, chamber.height)), viscosity, friction.roughness
    lag, ramp_time = last, None
    if rise is not None:
        lag = min(last, steady_lag(rise.rate, chamber.radius, *given) / chamber.radius)
        ramp_time = (rise.stop - rise.start) / rise.rate
    reynolds = lag * chamber.radius * given[0] / viscosity if viscosity > 0.0 else math.inf
    return SpinUp(
        regime=str(regime(reynolds)),
        reynolds=reynolds,
        lag=lag,
        ramp=ramp_time is not None,
        time=float(spin_up_time(_CARRIED, last * chamber.radius, *given)),
        ramp_time=ramp_time,
    )


def _walls(fill: Fill) -> str:
    """What is there besides a plain ring."""
    if fill.chamber.section is not None:
        return f"section of {fill.chamber.section.name}"
    if fill.chamber.baffles is None:
        return ""
    effect = closed_compartments(fill) or "at rest in the drum the liquid lies as without them"
    return f"baffles: {baffle_words(fill.chamber.baffles)}; {effect}"


def _carrying(scene: Scene, fill: Fill, captured_from: float | None) -> BaffleOutlook | None:
    """What the baffles of a chamber can do on the ramp, None where nothing is asked of them."""
    rise = _rise(scene, captured_from or 0.0)
    if rise is None or not fill.uneven or fill.chamber.baffles is None or fill.compartments > 1:
        return None
    speed = min(max(rise.start, captured_from or 0.0), rise.stop)
    # Both the flow and what holds it to the wall go with the speed.
    able = most_torque(fill, speed)
    asked = rise.rate * 0.5 * fill.mass * (fill.chamber.radius**2 + fill.surface_radius**2)
    enough = speed * math.sqrt(asked / able) if able > 0.0 else math.inf
    return BaffleOutlook(speed, able, asked, enough)


@dataclass(frozen=True)
class _Bare:
    """The rotor without liquid in numbers."""

    mass: float
    critical_speed: float
    critical_speed_wet: float
    damping_ratio: float
    modes: tuple[RestMode, ...] = ()


def _bare(machine: Prepared, model: str) -> _Bare:
    rotor, system, fills = machine.rotor, machine.system, machine.scene.fills
    gravity = machine.axial_gravity
    if axis_is_free(system):
        nothing = math.nan
        return _Bare(
            moving_mass(rotor), nothing, nothing, nothing, rest_modes(system, machine.scene.rotor.axis)
        )
    if isinstance(rotor, Jeffcott):
        wet = critical_speed(rotor, fills, gravity, synchronous_model(model))
        return _Bare(moving_mass(rotor), rotor.natural_frequency, wet, rotor.damping_ratio)
    liquid = wet_critical_speeds(system, fills, gravity, synchronous_model(model))
    dry, wet = main_critical_speeds(system, fills, critical_speeds(system), liquid)
    turning = modes(system, dry if np.isfinite(dry) else 0.0)
    nearest = int(np.argmin(np.abs(turning.frequency[0] - dry))) if np.isfinite(dry) else 0
    ratio = float(turning.damping_ratio[0, nearest])
    return _Bare(moving_mass(rotor), dry, wet, ratio, rest_modes(system, machine.scene.rotor.axis))
