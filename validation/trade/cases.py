"""What a scene's models and resolutions are compared on: the questions and their ladders."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import FULL
from fluid.kdv import coefficients
from leblanc.liquid.choose import across_gravity, is_cut
from leblanc.scene.scene import Exciter, Runup, Scene, require_clear
from leblanc.studies.drives import planned
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.layer.places import fewest_cells
from solvers.runup.state import layer_capture
from validation.trade.answers import (
    DISPERSION,
    FAMILY,
    HELD,
    RESPONSE,
    RUNUP,
    SMALL,
    WAVES,
    Case,
    at_speeds,
    chosen_models,
    lone_layer,
    steady,
    taken_run,
    whirl_growth,
)

SPEEDS = 9  # at which the response is compared
SAMPLES = 1000  # of a run-up's history
CELLS, QUICK_CELLS = (16, 32, 64, 128, 256, 512), (16, 32, 64)
HELD_CELLS, QUICK_HELD = (32, 64, 128, 256), (16, 32, 64)  # of waves held in time
_MOST_CELLS, _MOST_SMALL = 4096, 600  # of a refined reference: of any, of small waves in compartments
MESHES: tuple[tuple[int, int], ...] = ((16, 1), (32, 1), (64, 1), (16, 2), (32, 2), (64, 2))
QUICK_MESHES: tuple[tuple[int, int], ...] = ((16, 1), (16, 2))
SMALL_CELLS, QUICK_SMALL = (24, 48, 96, 192), (12, 24, 48)  # of small waves in compartments
STOCK, QUICK_STOCK = (16, 32), (16,)  # cells by py-pde's own solvers
STEPS, QUICK_STEPS = (12, 16, 24, 32, 48, 96, 192), (12, 24, 48)
_SCOUT = 16  # cells of the run that finds the largest vibration
_BEFORE, _BEYOND, _MOTOR = 0.7, 1.2, 1.2  # of its speed, where a run-up begins and ends; of its time
# Of the speed of capture, from where on gravity does not throw the liquid about; of the run-up's end, where
# the start lies at most; the least end over the start.
_HELD, _LATEST, _WIDEST = 2.0, 0.8, 1.6
_CALM = 4.0  # of the speed of capture, from where on a motion held in time mostly repeats with the turn
_DIES = 4e-3  # in a turn, the logarithm by which a small whirl dies at least: e times in 250 turns
_EXCITED = (0.25, 0.9)  # of the exciter's critical speed, between which its speeds lie


@dataclass(frozen=True)
class Question:
    """What every case answers."""

    name: str  #: as of `Case.question`
    scene: Scene  #: cut to the question
    about: str  #: what is asked, and what was cut, in words
    cases: tuple[Case, ...]  #: in the order of the table; the first is the default
    reference: Case  #: the best of them
    #: the reference and coarser ones, finest first, whose differences give its own error; alone if it is
    #: exact
    ladder: tuple[Case, ...]


def questions(scene: Scene, quick: bool = False, layer: bool | None = None) -> tuple[Question, ...]:
    """What can be compared on a scene: its response, its run-up if it has one, and one layer.

    `layer`: its first layer alone as well, by every solver of py-pde; None where it `names_waves`.
    """
    if isinstance(scene.rotor, Exciter):
        return (exciter_question(scene, quick),)
    if scene.balls:
        # The states in which balls rest are found in one way only; steps of a run-up go with the cells.
        planned(scene)
        return (runup_question(scene, quick),)
    found = [response_question(scene, quick)]
    if scene.runup is not None:
        found.append(runup_question(scene, quick))
    if names_waves(scene) if layer is None else layer:
        require_clear(scene, "a layer alone, which is compared in a clear ring")
        found += layer_questions(scene, quick)
    return tuple(found)


def names_waves(scene: Scene) -> bool:
    """Whether a scene has a layer in a clear ring and asks for waves that py-pde solves."""
    layers = any(0.0 < fill.volume < FULL * fill.chamber.capacity for fill in scene.fills)
    clear = all(fill.chamber.baffles is None for fill in scene.fills)
    return layers and clear and scene.model.liquid in ("long_wave", "kdv")


def layer_questions(scene: Scene, quick: bool = False) -> list[Question]:
    """One layer under a prescribed whirl, as long waves from rest and as one steady family.

    Each by its own solver and by those of py-pde, on few cells: their steps are as many as the cells.
    """
    from solvers.pypde import settle_family  # with which "steady_newton" comes
    from solvers.pypde.long_wave import AnnularLongWavePDE
    from solvers.pypde.one_family import KdvBurgersPDE
    from solvers.pypde.stock import names

    fill, whirl, friction = lone_layer(scene)
    surface, spin = fill.surface_radius, whirl.spin
    few = QUICK_STOCK if quick else STOCK
    layer = (
        f"{1e3 * fill.depth:.3g} mm of liquid at a wall of {1e3 * fill.chamber.radius:.4g} mm that spins at "
        f"{spin:.4g} rad/s and whirls at {whirl.speed:.4g} rad/s with {1e6 * whirl.amplitude:.3g} um"
    )
    wave = AnnularLongWavePDE(fill, whirl, friction=friction)
    family = KdvBurgersPDE(coefficients(fill.chamber.radius, surface, spin, -1))
    ladder = tuple(
        Case(WAVES, "long_wave", n, "finite_volume") for n in reversed(QUICK_CELLS if quick else CELLS)
    )
    others = [name for name in names(wave) if name not in ("finite_volume", "explicit")]
    waves = (*ladder[1:], ladder[0], *(Case(WAVES, "long_wave", n, name) for name in others for n in few))
    finer = tuple(Case(FAMILY, "kdv", n, settle_family.NEWTON) for n in (256, 128, 64))
    best = finer[0]
    others = [name for name in names(family) if name not in (settle_family.NEWTON, "explicit")]
    steady = (*reversed(finer), *(Case(FAMILY, "kdv", n, name) for name in others for n in few))
    return [
        Question(
            *(WAVES, scene, f"{layer}, three whirl periods from rest; error: of the force over the periods"),
            *(waves, ladder[0], ladder[:3]),
        ),
        Question(*(FAMILY, scene, f"{layer}, settled; error: of the centre of mass", steady, best, finer)),
    ]


def response_question(scene: Scene, quick: bool = False) -> Question:
    """Synchronous response at the speeds that distinguish models most.

    Best is the exact equilibrium of the liquid, which every other steady model approaches; of compartments,
    which have none, the finest elements of small waves; with transverse gravity rotor and long waves
    integrated in time, which alone have it.
    """
    cells, meshes = (QUICK_CELLS, QUICK_MESHES) if quick else (CELLS, MESHES)
    if is_cut(scene):
        ladder = tuple(Case(RESPONSE, "fem", n, SMALL) for n in (QUICK_SMALL if quick else SMALL_CELLS))
        best, cases = ladder[-1], (Case(RESPONSE, "auto"), *ladder)
    else:
        best = Case(RESPONSE, "statics")
        cases = (
            Case(RESPONSE, "auto"),
            Case(RESPONSE, "linear"),
            best,
            *(Case(RESPONSE, "long_wave", n) for n in cells),
            *(Case(RESPONSE, "fem", n, f"order {order}") for n, order in meshes),
        )
        ladder = (best,)
    lying = stands_lying(scene)
    chosen = telling_speeds(scene, SPEEDS, lying)
    where = f"{chosen.size} speeds from {chosen[0]:.4g} to {chosen[-1]:.4g} rad/s"
    if not lying.any():
        about = f"synchronous response at {where}, the steady peak and the last speed among them; {_ERROR}"
        return Question(RESPONSE, at_speeds(scene, chosen), about, cases, best, ladder[:-4:-1])
    every = _enough(QUICK_HELD if quick else HELD_CELLS, scene)
    held = tuple(Case(RESPONSE, "long_wave", n, HELD) for n in every)
    about = (
        f"response with gravity across the axis at {where}, from four times that of capture on and where no "
        f"whirl grows by itself; {_ERROR}, its mean over time"
    )
    return Question(RESPONSE, at_speeds(scene, chosen), about, (*cases, *held), held[-1], held[:-4:-1])


_ERROR = "error: largest relative one of the amplitude"


def finer(question: Question) -> Question | None:
    """The question with a reference twice as fine; None where that is exact or as fine as it goes."""
    first = question.ladder[0]
    most = _MOST_SMALL if first.variant == SMALL else _MOST_CELLS
    if len(question.ladder) < 3 or first.resolution is None or 2 * first.resolution > most:
        return None
    best, place = replace(first, resolution=2 * first.resolution), question.cases.index(first) + 1
    cases = (*question.cases[:place], best, *question.cases[place:])
    return replace(question, cases=cases, reference=best, ladder=(best, *question.ladder[:2]))


def refined_to(question: Question, reference: str) -> Question:
    """The question with the reference of that label."""
    found: Question | None = question
    while found is not None and found.reference.label != reference:
        found = finer(found)
    if found is None:
        raise InputError("reference", reference, f"{question.reference.label} or a finer one")
    return found


def stands_lying(scene: Scene) -> Flags:
    """Speeds at which gravity across the axis shows in an answer that is steady on the whole, shape (n,).

    Closer to the centrifuging speed gravity throws rotor and layer into limit cycles, on one mesh and not on
    the next; where a whirl is self-excited no steady model answers what it grows to, and where it decays too
    slowly nothing converges.
    """
    speed, capture = scene.speed_array(), _capture(scene)
    if capture == 0.0:
        return np.zeros(speed.shape, dtype=bool)
    return np.asarray((speed >= _CALM * capture) & (whirl_growth(scene) * 2.0 * math.pi / speed < -_DIES))


def telling_speeds(scene: Scene, count: int = SPEEDS, among: Flags | None = None) -> Array:
    """Steady peak, its flanks, ends and middle of the range with a dry patch, last speed; others in between.

    Up to `count` of the speeds, rad/s, rising, at which the liquid rides with the drum, if there are such; of
    `among`, shape (n,), if there are any.
    """
    models, choice = chosen_models(scene, "auto" if is_cut(scene) else "statics")
    found, speed = steady(scene, models), scene.speed_array()
    amplitude, dry, kept = found.amplitude, found.dry, choice.in_range
    if among is not None and (kept & among).any():
        kept = kept & among
    if kept.any():
        speed, amplitude, dry = speed[kept], amplitude[kept], dry[kept]
    if speed.size <= count:
        return speed
    top = int(np.argmax(amplitude))
    chosen = [top, speed.size - 1]
    chosen += [k for k in (_flank(amplitude, top, -1), _flank(amplitude, top, 1)) if k is not None]
    patch = np.flatnonzero(dry)
    if patch.size:
        chosen += [int(patch[0]), int(patch[patch.size // 2]), int(patch[-1])]
    picked = list(dict.fromkeys(chosen))[:count]
    while len(picked) < count:
        # The speed farthest from those that there are.
        away = np.min(np.abs(np.arange(speed.size)[:, None] - np.array(picked)), axis=1)
        picked.append(int(np.argmax(away)))
    return np.asarray(speed[np.sort(picked)])


def _flank(amplitude: Array, top: int, way: int) -> int | None:
    """First speed beside the peak with less than 0.7 of it."""
    side = amplitude[top::way]
    below = np.flatnonzero(side < math.sqrt(0.5) * amplitude[top])
    return top + way * int(below[0]) if below.size else None


def runup_question(scene: Scene, quick: bool = False) -> Question:
    """The passage of the largest vibration of a scene's run-up.

    Best are the long waves on the finest cells, with dispersion if the scene has it. Without liquid the cells
    say how far the rotor turns in a step.
    """
    plan, about = passage(scene)
    cut = scene.altered(runup=plan)
    cells = _enough(_doubled(QUICK_CELLS if quick else CELLS, 2 * plan.cells), scene)
    own = DISPERSION if plan.dispersion else ""
    ladder = tuple(Case(RUNUP, "long_wave", n, own) for n in reversed(cells))
    variants = ("", DISPERSION) if scene.fills else ("",)
    layers = [Case(RUNUP, "long_wave", n, variant) for variant in variants for n in cells]
    linear = () if is_cut(scene) or scene.balls else (Case(RUNUP, "linear"),)
    cases = (Case(RUNUP, "auto"), *linear, *layers)
    return Question(RUNUP, cut, about, cases, ladder[0], ladder[:3])


def _enough(cells: tuple[int, ...], scene: Scene) -> tuple[int, ...]:
    """The rungs of a ladder with enough cells in every compartment; three of them, finer ones if need be."""
    least = fewest_cells(scene.fills)
    while sum(n >= least for n in cells) < 3:
        cells = (*cells, 2 * cells[-1])
    return tuple(n for n in cells if n >= least)


def _doubled(cells: tuple[int, ...], wanted: int) -> tuple[int, ...]:
    """The ladder with more rungs until the last one has as many cells as are wanted."""
    while cells[-1] < min(wanted, _MOST_CELLS):
        cells = (*cells, 2 * cells[-1])
    return cells


def passage(scene: Scene) -> tuple[Runup, str]:
    """Run-up of a scene cut to the passage of its largest vibration, and its description.

    A coarse run finds it. A ramp then runs from 0.7 to 1.2 of the speed there, within its own ends, and
    neither holds nor comes back; a motor runs from its start to 1.2 of the time there. A ramp with transverse
    gravity starts at twice the centrifuging speed at least: near that a layer falls on one mesh and stays up
    on the next, and no mesh is fine enough to show it.
    """
    plan = planned(scene)
    assert isinstance(plan, Runup)
    whole = scene.altered(runup=plan.altered(back=False, samples=SAMPLES))
    scout = max(_SCOUT, fewest_cells(scene.fills))
    history = taken_run(whole, "long_wave", scout, plan.dispersion).history
    top = int(np.argmax(history.amplitude))
    speed, time = float(history.speed[top]), float(history.time[top])
    if plan.rate is None:
        length = min(plan.duration, _MOTOR * time)
        start, stop = plan.start, plan.stop
    else:
        start = min(max(_BEFORE * speed, _HELD * _capture(scene)), _LATEST * plan.stop)
        start = max(plan.start, start)
        stop = min(plan.stop, max(_BEYOND * speed, _WIDEST * start))
        length = (stop - start) / plan.rate
    cut = plan.altered(start=start, stop=stop, duration=length, back=False, samples=SAMPLES)
    about = (
        f"run-up, cut to {length:.4g} s from {start:.4g} rad/s"
        + (f" to {stop:.4g} rad/s" if plan.rate is not None else "")
        + f" (its largest vibration is at {speed:.4g} rad/s); error: of the amplitude over time, root mean "
        "square over that of the best"
    )
    return cut, about


def _capture(scene: Scene) -> float:
    """Speed above which every layer rides with the drum against gravity across the axis, rad/s."""
    captured = [layer_capture(fill, across_gravity(scene)) for fill in scene.fills]
    return max((speed for speed in captured if math.isfinite(speed)), default=0.0)


def exciter_question(scene: Scene, quick: bool = False) -> Question:
    """Platform amplitudes of an exciter, by formulas and by time integration with ever finer steps."""
    from leblanc.wings.exciter.study import run_exciter

    found = run_exciter(scene)
    top = found.critical_speed if math.isfinite(found.critical_speed) else float(found.speed[-1])
    chosen = np.linspace(_EXCITED[0] * top, _EXCITED[1] * top, 5)
    steps = QUICK_STEPS if quick else STEPS
    ladder = tuple(Case(RESPONSE, "integration", n) for n in reversed(steps))
    about = (
        f"amplitudes of the platform with the balls and with the shaft at {chosen.size} shaft speeds from "
        f"{chosen[0]:.4g} to {chosen[-1]:.4g} rad/s; error: largest relative one"
    )
    cases = (Case(RESPONSE, "formulas"), *reversed(ladder))
    return Question(RESPONSE, at_speeds(scene, chosen), about, cases, ladder[0], ladder[:3])
