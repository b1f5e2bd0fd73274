"""One answer of one model at one resolution to the question that a scene was cut to."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from pydantic import Field

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from leblanc.liquid.choice import Choice
from leblanc.liquid.choose import across_gravity, axial_gravity, choose, is_cut, liquid_models, prepare
from leblanc.scene.scene import Exciter, Runup, Scene, dry_rotor
from leblanc.studies.drives import drive_of, planned
from leblanc.studies.runup.study import RunupChoice, chosen_run, judged
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.layer.places import fewest_cells
from solvers.layer.state import Numerics
from solvers.liquid_model import LiquidModel, Whirl
from solvers.runup.runup import RunupNumerics
from solvers.wave_error import long_wave_error

RESPONSE, RUNUP = "response", "runup"
WAVES, FAMILY = "long waves", "one family"
DISPERSION, HELD, SMALL = "dispersion", "held", "small waves"


@dataclass(frozen=True)
class Case:
    """One model at one resolution."""

    question: str  #: "response" or "runup", or of a layer alone "long waves" or "one family"
    #: "auto" (the scene's default), "linear", "statics", "long_wave", "kdv", "fem"; of an exciter "formulas"
    #: or "integration"
    model: str
    #: cells round a wall, edges along a wall, steps in a turn; None where there is none
    resolution: int | None = None
    #: "dispersion", "held" (in time until the motion settles), "order 1" or "order 2", "small waves" (of
    #: compartments), or empty; of a layer alone its solver, as py-pde names it
    variant: str = ""

    @property
    def selectable(self) -> bool:
        """A scene or `layer` can name it: what goes through time takes any grid, what is steady none."""
        return self.resolution is None or self.question != RESPONSE or self.variant == HELD

    @property
    def label(self) -> str:
        """A short description."""
        size = "" if self.resolution is None else f" {self.resolution}"
        return f"{self.model}{size}{', ' + self.variant if self.variant else ''}"


@dataclass(frozen=True)
class Answer:
    """What a case answers."""

    values: Array  #: amplitudes over speed or over time, m, shape (k,)
    in_range: bool  #: the model says of itself that it holds there
    reason: str  #: why there is no answer, or empty
    used: tuple[str, ...]  #: models that answered
    #: half of what the amplitude swings over, m, shape (k,); None where it is not asked for
    ripple: Array | None = None
    #: largest error that the answer tells of itself, relative: of a layer alone that of its waves beside the
    #: exact one, without friction; nan where it tells none
    estimate: float = math.nan
    #: cells that steps in time advanced, over all steps; of linear layers their steps; 0 where nothing goes
    #: through time
    work: float = 0.0


class SceneAt(Scene):
    """A scene at chosen speeds."""

    chosen: tuple[float, ...] = Field((), description="in place of the evenly spaced ones, rising")

    def speed_array(self) -> Array:
        """Spin speeds, rad/s, shape (k,)."""
        return np.array(self.chosen)


def at_speeds(scene: Scene, speed: Array) -> SceneAt:
    """The scene at those speeds."""
    content = {name: getattr(scene, name) for name in Scene.model_fields}
    return SceneAt.model_construct(**content, chosen=tuple(float(x) for x in speed))


@dataclass(frozen=True)
class Steady:
    """A synchronous response at the speeds of a scene, shape (n,)."""

    amplitude: Array  #: m
    ripple: Array  #: half of what the distance of the axis swings over, its orbit being an ellipse, m
    dry: Flags  #: the wall is dry somewhere
    good: Flags  #: in range, and found
    used: tuple[str, ...]  #: models that answered


def steady(scene: Scene, models: LiquidModel | Sequence[LiquidModel]) -> Steady:
    """Synchronous response of a scene with one liquid model, or one for each speed; no exciter."""
    from solvers.synchronous.response import response

    gravity = axial_gravity(scene)
    found = response(dry_rotor(scene), scene.fills, scene.speed_array(), gravity, models)
    ways = np.abs(found.deflection), np.abs(found.backward)
    good = found.in_range & found.converged
    used = tuple(dict.fromkeys(found.model.tolist()))
    return Steady(ways[0] + ways[1], np.minimum(*ways), found.dry_patch, good, used)


def chosen_models(scene: Scene, model: str) -> tuple[list[LiquidModel], Choice]:
    """Model at each speed, and what the main job knows of them; no exciter.

    A model that is named is taken as it is; its error is estimated all the same, as users get it.
    """
    choice = choose(scene.altered(model=scene.model.altered(liquid=model)))
    return liquid_models(choice), choice


def answer(scene: Scene, case: Case) -> Answer:
    """Answer of a case to the question that a scene was cut to."""
    kind = "exciter" if isinstance(scene.rotor, Exciter) else case.question
    if kind not in _ANSWERS:
        raise InputError("question", case.question, "one of " + ", ".join(_ANSWERS))
    return _ANSWERS[kind](scene, case)


def _response(scene: Scene, case: Case) -> Answer:
    from solvers.synchronous.models import CellsAtRest

    size = case.resolution
    if case.variant == HELD:
        return _held(scene, size or scene.model.cells)
    models, choice = chosen_models(scene, "auto" if is_cut(scene) else "statics" if size else case.model)
    if size is None:
        found = steady(scene, models)
        used, estimate = found.used, float(choice.error.max())
    else:
        model = CellsAtRest(size) if case.model == "long_wave" else _elements(size, case.variant)
        found, used, estimate = steady(scene, model), (case.model,), math.nan
    good = found.good & choice.in_range
    reason = "" if np.isfinite(found.amplitude).all() else "no bounded answer"
    return Answer(found.amplitude, bool(good.all()), reason, used, found.ripple, estimate)


def _elements(size: int, variant: str) -> LiquidModel:
    """Finite elements: of the paraboloid, or of small waves."""
    from solvers.sloshing.model import SmallWaves
    from solvers.synchronous.models import ElementsAtRest

    return SmallWaves(size) if variant == SMALL else ElementsAtRest(size, int(variant[-1]))


def _held(scene: Scene, cells: int) -> Answer:
    """Rotor and long waves at constant speed until they settle, each speed from its synchronous motion."""
    from leblanc.studies.held.held import held_machine
    from leblanc.studies.held.whirls import wave_errors
    from solvers.held.integrate import hold, start
    from solvers.held.state import HoldNumerics
    from solvers.synchronous.models import STATICS
    from solvers.synchronous.response import response

    machine, rest = prepare(scene), _elements(96, SMALL) if is_cut(scene) else STATICS
    held, numerics = held_machine(machine), HoldNumerics(cells=cells)
    begin = response(machine.rotor, scene.fills, machine.speed, machine.axial_gravity, rest).coordinates
    growth = whirl_growth(scene)
    states = [
        hold(held, start(held, spin, numerics, motion), numerics, rate)
        for spin, motion, rate in zip(machine.speed.tolist(), begin, growth.tolist(), strict=True)
    ]
    planar = scene.rotor.kind == "jeffcott"
    amplitude = np.array([state.amplitude if planar else state.crest for state in states])
    ripple = np.array([0.5 * (state.largest - state.least) for state in states])
    reason = next((state.reason for state in states if not state.settled), "")
    captured = all(state.captured.all() for state in states)
    # Of the cells there is no estimate, the ladder shows what they do; of the waves where they whirl.
    waves = wave_errors(machine, states)
    estimate = float(np.nanmax(waves)) if np.isfinite(waves).any() else math.nan
    work = float(sum(state.steps for state in states) * numerics.cells * len(scene.fills))
    return Answer(amplitude, captured, reason, ("long_wave",), ripple, estimate, work)


def whirl_growth(scene: Scene) -> Array:
    """Growth of the fastest-growing small whirl at the speeds of a scene, 1/s, shape (n,)."""
    from solvers.whirl.growth import asynchronous_growth

    return asynchronous_growth(dry_rotor(scene), scene.fills, scene.speed_array(), scene.model.friction)[0]


def _runup(scene: Scene, case: Case) -> Answer:
    plan = planned(scene)
    dispersion = plan.dispersion if case.resolution is None else case.variant == DISPERSION
    cells = case.resolution or plan.cells
    taken = taken_run(scene, case.model, cells, dispersion)
    history, good = taken.history, judged(scene, taken.history, taken.model)[0]
    work = float(history.steps + history.layer_steps * cells)
    return Answer(history.amplitude, bool(good.all()), history.reason, (taken.model,), work=work)


def taken_run(scene: Scene, model: str, cells: int, dispersion: bool) -> RunupChoice:
    """Run-up of a scene as its command makes it, but for the second run with half the cells."""
    plan = planned(scene)
    numerics = RunupNumerics(cells, plan.samples, dispersion, companion=False)
    variant = scene.altered(model=scene.model.altered(liquid=model))
    return chosen_run(variant, drive_of(plan), across_gravity(scene), numerics)


def _exciter(scene: Scene, case: Case) -> Answer:
    from solvers.rotor.exciter.machine import platform_motion, stuck_speeds
    from solvers.rotor.exciter.motion import integrate

    if not isinstance(scene.rotor, Exciter):
        raise InputError("rotor.kind", scene.rotor.kind, "exciter for this")
    machine = scene.rotor.machine()
    numbers = machine.dimensionless()
    ratio = scene.speed_array() / machine.natural_frequency
    if case.resolution is None:
        stuck = stuck_speeds(ratio, numbers)[:, 0]
        both = [np.abs(platform_motion(numbers, n, q)) for n, q in zip(ratio, stuck, strict=True)]
        return Answer(np.ravel(both) * machine.length, True, "", (case.model,))
    runs = [integrate(numbers, float(n), machine.ball_count, steps=case.resolution) for n in ratio]
    values = np.array([(run.slow, run.fast) for run in runs]).ravel() * machine.length
    in_range = all(run.holds for run in runs)
    return Answer(
        values, in_range, "" if np.isfinite(values).all() else "the balls break away", (case.model,)
    )


_DRAG = 0.05  # linear friction of a layer alone, of the spin: it settles in some ten whirl periods
_OFF, _SMALL, _PERIODS = 0.8, 0.01, 3  # its whirl over the spin; whirl over the depth; periods from rest


def lone_layer(scene: Scene) -> tuple[Fill, Whirl, Friction]:
    """First layer of a scene under a small whirl at the last of its speeds, and the friction taken."""
    spin = float(scene.speed_array()[-1])
    for fill in scene.fills:
        if 0.0 < fill.volume < fill.chamber.capacity * (1.0 - 1e-9):
            first = Whirl(spin, _OFF * spin, _SMALL * fill.depth)
            whirl = replace(first, ramp=first.period)
            return fill, whirl, Friction(FrictionLaw.LINEAR, _DRAG * spin)
    raise InputError("chambers", len(scene.fills), "one with liquid and a free surface at least")


def _long_waves(scene: Scene, case: Case) -> Answer:
    from solvers.pypde.settle import simulate

    fill, whirl, friction = lone_layer(scene)
    numerics = Numerics(case.resolution or Numerics().cells)
    found = simulate(fill, whirl, _PERIODS * whirl.period, friction, numerics, case.variant)
    force, layer = found.force_ratio, fill.depth / fill.chamber.radius
    estimate = float(long_wave_error(layer, whirl.detuning, _SMALL, False, numerics.cells))
    values = np.concatenate([force.real, force.imag])
    work = float(numerics.cells**2)  # to a factor: the steps go with the cells
    return Answer(values, True, found.reason, (case.model,), estimate=estimate, work=work)


def _one_family(scene: Scene, case: Case) -> Answer:
    from solvers.pypde.models import OneFamily

    fill, whirl, friction = lone_layer(scene)
    found = OneFamily(friction, case.resolution or 256, solver=case.variant).wave(fill, whirl)
    offset = complex(found.answer.offset[0])
    in_range, work = bool(found.answer.in_range[0]), float(case.resolution or 256) ** 2
    values, estimate = np.array([offset.real, offset.imag]), float(found.answer.error[0])
    return Answer(values, in_range, found.reason, (case.model,), estimate=estimate, work=work)


_ANSWERS: dict[str, Callable[[Scene, Case], Answer]] = {
    RESPONSE: _response,
    RUNUP: _runup,
    "exciter": _exciter,
    WAVES: _long_waves,
    FAMILY: _one_family,
}


def taste(scene: Scene, case: Case) -> None:
    """A small piece of a case, which imports and compiles all that the whole takes."""
    if case.question == RUNUP:
        plan = planned(scene)
        assert isinstance(plan, Runup)
        bit = scene.altered(runup=plan.altered(duration=1e-3 * plan.duration, samples=2))
        answer(bit, case)
        if case.model == "auto":  # of which so small a piece takes one model alone
            answer(bit, replace(case, model="long_wave"))
    elif case.question in (WAVES, FAMILY):
        answer(scene, replace(case, resolution=8))
    else:
        few = case.model == "fem" or case.variant == HELD
        small = replace(case, resolution=fewest_cells(scene.fills)) if few and case.resolution else case
        answer(at_speeds(scene, scene.speed_array()[-1:]), small)
