"""A scene's run-up: rotor and liquid taken through the speeds in time, and where the models hold."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.pool import centrifuging_speed, pool_of
from fluid.waves import capture_speed
from fluid.whirl import covering_speed, is_full
from leblanc.core.notes import Note, percent
from leblanc.core.progress import update
from leblanc.liquid.choose import (
    across_gravity,
    axial_gravity,
    captured_speed,
    is_cut,
    prepare,
    ruled_out_linear,
)
from leblanc.liquid.filled import FilledChamber
from leblanc.liquid.models import RUNUP_MODELS, runup_model
from leblanc.liquid.notes import smeared_baffles
from leblanc.liquid.validity import doubts, require_supported
from leblanc.scene.inputs import runup_rows
from leblanc.scene.programme.table import Programme as Steps
from leblanc.scene.scene import JeffcottRotor, Runup, Scene, dry_rotor, jeffcott, require_clear
from leblanc.studies.balls.study import races_shown, started_balls
from leblanc.studies.drives import drive_of, numerics_of, planned, rotor_in_time, unbalance_left
from leblanc.studies.loads.study import loaded_machine, loads_over_time
from leblanc.studies.peaks import responses_between
from leblanc.studies.runup import notes
from leblanc.studies.runup.answer import Bands, Passage, RunupAnswer, RunupFrames, run_faults
from leblanc.studies.runup.notes import RunupCode
from meshes.arrays import Array, Flags, Index
from meshes.errors import InputError
from solvers.layer.places import FEWEST_CELLS, fewest_cells
from solvers.layer.records import Outcome
from solvers.liquid_model import LONG
from solvers.runup.ensemble import EnsembleTask, Member, Spread, member_of, run_member, spread_over
from solvers.runup.ensemble import ensemble as made_ensemble
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import MOST_WAVE, Drive, Handover, RunupModel
from solvers.runup.programme import Programme
from solvers.runup.runup import (
    MOST_LAG,
    LinearRunError,
    RunupHistory,
    RunupNumerics,
    linear_run_error,
    run_up,
)
from solvers.runup.state import pours
from solvers.synchronous.models import LINEAR
from solvers.synchronous.response import Response, by_speed, response

MOST_FRAMES = 2000  # of a film
STEADY_SPEEDS = 401  # of the steady response drawn behind the run-up
BAND_SPEEDS = 201  # at which self-excited whirl is looked for
_STEADY = 1e-9  # relative change of the speed that is none


def runup_frames(history: RunupHistory) -> RunupFrames | None:
    """The layers that a run-up kept [theory: coupling]."""
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
        down=np.angle(-turn),
        pool=np.angle(history.offset[kept.sample] * turn[:, None]),
    )


def liquid_model(scene: Scene) -> str:
    """Most exact liquid model that a scene's run-up may take: the one that it names, or long waves."""
    liquid = scene.model.liquid
    if liquid not in ("auto", *RUNUP_MODELS):
        raise InputError("model.liquid", liquid, "auto, " + " or ".join(RUNUP_MODELS) + " for a run-up")
    return "long_wave" if liquid == "auto" else liquid


def judged(scene: Scene, history: RunupHistory, model: str | None = None) -> tuple[Flags, tuple[Note, ...]]:
    """Where the layer describes the liquid, and why it does not elsewhere.

    A layer must turn fast enough itself, whatever the drum does, must not be deep beside its radius
    [theory: long_wave, eq. 4], and a linear one must leave the inner wall clear; long waves fill the gap
    there [theory: long_wave, eq. 18].

    Truth values, shape (k,), and one note for each reason.
    """
    good = np.ones(history.time.shape, dtype=bool)
    found: list[Note | None] = []
    deepest, highest = LONG[1], LINEAR.ranges["wave_amplitude"][1]
    linear = (model or liquid_model(scene)) == "linear"
    for k, fill in enumerate(scene.fills):
        if fill.volume == 0.0 or is_full(fill):
            continue
        wall = fill.chamber
        own = history.speed + history.mean_rotation[:, k]
        ring, flows = history.captured[:, k], history.handover is not Handover.RIDING and not linear
        pool = pool_of(fill)
        flows = flows and (pool is None or pours(fill, pool))
        carried = (ring & (np.abs(own) > held_from(scene, fill))) | (flows & ~ring)
        reached = np.nan_to_num(history.depth_max[:, k]) >= wall.radius - wall.inner_radius
        touches = reached & (wall.inner_radius > 0.0)
        # The exact linear theory holds at any depth.
        shallow = linear or fill.depth <= deepest * wall.radius
        rise = np.nan_to_num(history.depth_max[:, k] - fill.depth)
        small = ~(linear & (rise > highest * fill.depth))
        for code, holds, limit in (
            (RunupCode.TOO_SLOW, carried, math.nan),
            (RunupCode.INNER_WALL, ~(touches & linear), math.nan),
            (RunupCode.TOO_DEEP, np.full(good.shape, shallow), deepest),
            (RunupCode.TOO_HIGH, small, highest),
        ):
            good &= holds
            found.append(notes.out_of_range(code, k, holds, limit))
        found.append(None if linear else notes.full_gap(k, touches))
    return good, tuple(note for note in found if note is not None)


def held_from(scene: Scene, fill: Fill) -> float:
    """Rotation of the liquid itself above which it stands round its wall in spite of gravity, rad/s.

    Its centrifugal acceleration at the surface must exceed gravity [theory: waves, eq. 11]; if the axis
    stands, the paraboloid must also cover the wall's height and leave an inner wall clear.
    """
    slowest = float(capture_speed(fill.surface_radius, scene.gravity))
    return max(slowest, covering_speed(fill, axial_gravity(scene)))


@dataclass(frozen=True)
class RunupChoice:
    """A run-up and the liquid model it took."""

    history: RunupHistory  #: of rotor and liquid
    model: str  #: "long_wave" or "linear"
    #: estimated error of the amplitude over its largest, by the model and by its steps; nan where one of them
    #: is not known
    error: float
    reason: str  #: why that model, in words


def chosen_run(
    scene: Scene,
    drive: Drive,
    gravity: float,
    numerics: RunupNumerics,
    snapshots: ArrayLike = (),
    follow: bool = False,
    share: float | None = None,
) -> RunupChoice:
    """Run a scene up with the cheapest liquid model whose estimated error is within its tolerance.

    Linear layers take a twentieth of the time of long waves and are tried first. What they cannot have rules
    them out before: a motor that feels the wave, friction that small waves do not feel, and a tolerance that
    not even the smallest waves are known to meet. It says how far it has come
    where it is given a `share` of all work.
    """
    scene = scene.as_read()
    require_supported(scene)
    model, tolerance = liquid_model(scene), scene.model.tolerance
    system, friction = rotor_in_time(scene), scene.model.friction

    def run(name: str, resolved: RunupNumerics = numerics, tell: bool = True) -> RunupHistory:
        told = None if share is None or not tell else lambda part: update(share * part, 1.0)
        given = system, scene.fills, drive, friction, gravity, resolved, told
        return run_up(*given, model_of(scene, name), snapshots, follow)

    if not scene.chambers:
        # Both models step the rotor alike; this one is the quicker, the other has the cells of a film.
        model = "long_wave" if np.size(snapshots) else "linear"
        history = run(model)
        return RunupChoice(history, model, _by_steps(history), "the machine has no chamber.")
    if scene.model.liquid == "long_wave":
        history = run(model)
        return RunupChoice(history, model, _by_steps(history), "the scene asks for long waves.")
    if scene.model.liquid == "linear":
        history = run(model)
        found = linear_run_error(history, scene.fills)
        reason = f"the scene asks for linear layers; {_judged_by(found)}."
        return RunupChoice(history, model, found.estimate + history.error_estimate, reason)
    ruled_out = ruled_out_linear(scene)
    if not ruled_out:
        first = run("linear", replace(numerics, companion=False), tell=False)
        found = linear_run_error(first, scene.fills)
        if found.estimate <= tolerance:
            history = run("linear") if numerics.companion else first
            error = found.estimate + (0.0 if math.isnan(history.error_estimate) else history.error_estimate)
            reason = f"linear layers, as {_judged_by(found)}, within the tolerance of {percent(tolerance)}."
            return RunupChoice(history, "linear", error, reason)
        ruled_out = f"with linear layers {_judged_by(found)}, and the tolerance is {percent(tolerance)}"
    history = run(model)
    return RunupChoice(history, model, _by_steps(history), f"long waves: {ruled_out}.")


def _by_steps(history: RunupHistory) -> float:
    """Error by cells, steps and pool-annulus transition together, over the largest amplitude."""
    handed = history.handover_estimate
    return history.error_estimate + (0.0 if math.isnan(handed) else handed)


def _judged_by(found: LinearRunError) -> str:
    """What a linear run says of its own error."""
    size = f"waves reach {percent(found.wave)} of the depth and the liquid lags by up to "
    size += f"{percent(found.lag)} of the spin"
    if found.touches:
        return f"{size}, and a surface touches an inner wall, beyond any estimate"
    if math.isfinite(found.estimate):
        return f"{size}, an estimated error of {percent(found.estimate)} against long waves"
    most = " and ".join(map(percent, (MOST_WAVE, MOST_LAG)))
    return f"{size}, beyond the {most} up to which an error is estimated"


def require_runup(scene: Scene, cells: int | None = None) -> Runup | Steps:
    """The way of a scene; an `InputError` where it has none, or its liquid cannot go it."""
    plan = planned(scene)
    require_clear(scene, "a run-up, whose waves run in a ring with circular walls", baffles=True)
    if scene.model.liquid == "linear" and any(fill.compartments > 1 for fill in scene.fills):
        text = "auto or long_wave where baffles cut the liquid into compartments"
        raise InputError("model.liquid", "linear", text)
    if cells is None and plan.cells < (fewest := fewest_cells(scene.fills)):
        table = "runup" if scene.programme is None else "programme"
        allowed = f"{fewest} or more, {FEWEST_CELLS} in each compartment"
        raise InputError(f"{table}.cells", plan.cells, allowed)
    return plan


def runup_scene(
    scene: Scene,
    cells: int | None = None,
    samples: int | None = None,
    check: bool = True,
    frames: int | None = None,
    ensemble: int = 0,
    seed: int = 0,
    workers: int = 1,
) -> RunupAnswer:
    """Run the machine of a scene through its speeds [theory: coupling].

    `check`: once more with half the cells to estimate the error; `frames` times at which the layers are kept
    for a film; `ensemble` repetitions with the unbalance changed in the last digits, the same with any number
    of workers. What was reached if the run did not come to its end.
    """
    if workers < 1:
        raise InputError("workers", workers, "1 or more")
    scene = scene.as_read()
    plan = require_runup(scene, cells)
    if frames is not None and not 2 <= frames <= MOST_FRAMES:
        raise InputError("frames", frames, f"from 2 to {MOST_FRAMES}")
    if frames is not None and scene.model.liquid == "linear":
        raise InputError("model.liquid", "linear", "auto or long_wave for a film")
    update(what="running up")
    numerics = numerics_of(plan, cells, samples, check)
    drive, gravity = drive_of(plan, scene.rotor), across_gravity(scene)
    times = () if frames is None else np.linspace(0.0, float(drive.corners()[0, -1]), frames)
    share = 1.0 / (1.0 + 0.8 * ensemble / workers)
    tasks = []  # with long waves until it is known which model is taken
    if ensemble:
        given = rotor_in_time(scene), scene.fills, drive, scene.model.friction, gravity, numerics
        tasks = made_ensemble(*given, model_of(scene, "long_wave"), ensemble, seed)
    machine = loaded_machine(scene)
    taken = chosen_run(scene, drive, gravity, numerics, times, machine is not None, share)
    history = taken.history
    if taken.model == "linear":
        tasks = [replace(task, model=model_of(scene, "linear")) for task in tasks]
    spread = rounding_spread(taken, tasks, seed, workers, share)
    dry = dry_run(scene, history, drive, gravity, numerics, taken.model)
    steady, bands = steady_response(scene, history.speed), whirl_bands(scene, history.speed)
    in_range, limits = judged(scene, history, taken.model)
    steps = () if scene.programme is None else tuple(step.words() for step in scene.programme.steps)
    passages, left = passages_of(history, dry, steps), unbalance_left(scene, history)
    fastest = np.flatnonzero(history.speed == history.speed.max())
    chambers = tuple(chamber_of(fill) for fill in scene.fills)

    def found() -> Iterator[Note]:
        if scene.chambers:
            yield Note(RunupCode.LIQUID_MODEL, {"model": taken.model}, f"Liquid model: {taken.reason}")
        pools = taken.model == "long_wave" and gravity > 0.0 and bool(scene.fills)
        faults = run_faults(history, chambers)
        yield from notes.happened(history, steady, spread, faults, numerics.cells if pools else None)
        yield from _never_caught(scene, history)
        if bands is None and not scene.balls:
            yield notes.WHIRL_BESIDE_BAFFLES
        if bands:
            whirl = whirl_on_the_way(scene, bands)
            yield notes.self_excited_on_the_way(bands, scene.model.friction, whirl)
        if scene.programme is not None and isinstance(drive, Programme):
            yield from notes.programme_notes(scene.programme, history, drive, passages)
        if left is not None:
            yield notes.unbalance_left(float(left[-1]))
        yield from limits
        if scene.balls:
            yield from notes.of_balls(history, bool(scene.fills))
        yield from smeared_baffles(scene.fills, None if taken.model == "linear" else numerics.cells)
        if machine is not None:
            yield notes.LOADS
        yield from doubts(scene)

    return RunupAnswer(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        inputs=runup_rows(scene, numerics.cells, numerics.dispersion),
        kind=scene.rotor.kind,
        axis=scene.rotor.axis,
        friction=scene.model.friction,
        gravity=gravity,
        model=taken.model,
        model_reason=taken.reason,
        model_error=taken.error,
        cells=numerics.cells,
        dispersion=numerics.dispersion,
        history=history,
        turning=int(fastest[-1]) if isinstance(plan, Runup) and plan.back else history.time.size - 1,
        in_range=in_range,
        steady=steady,
        bands=bands,
        chambers=chambers,
        planes=tuple(fill.chamber.plane for fill in scene.fills) or (_position(scene),),
        notes=tuple(found()),
        frames=runup_frames(history),
        history_dry=dry,
        spread=spread,
        bore=plan.bore,
        passages=passages,
        unbalance_left=left,
        loads=None if machine is None else loads_over_time(scene, machine, history),
        races=races_shown(scene),
        unused=("speeds", *(() if scene.chambers else ("model",)), "optimise"),
    )


def passages_of(
    history: RunupHistory, dry: RunupHistory | None, texts: tuple[str, ...]
) -> tuple[Passage, ...]:
    """The steps of a programme that were reached, in their order."""

    def samples(run: RunupHistory | None, step: int) -> Index:
        """Samples that a step leads to; the one at the beginning belongs to none."""
        if run is None or run.stage is None:
            return np.empty(0, dtype=np.intp)
        found = np.flatnonzero(run.stage == step)
        return found[found > 0]

    found = []
    for step, text in enumerate(texts):
        rows, bare = samples(history, step), samples(dry, step)
        if not rows.size:
            continue
        largest, first, last = rows[np.argmax(history.largest[rows])], rows[0] - 1, rows[-1]
        begin, end = float(history.speed[first]), float(history.speed[last])
        found.append(
            Passage(
                step=step + 1,
                text=text,
                way="hold" if abs(end - begin) <= _STEADY * begin else "up" if end > begin else "down",
                begin=float(history.time[first]),
                end=float(history.time[last]),
                speed_begin=begin,
                speed_end=end,
                amplitude=float(history.largest[largest]),
                speed=float(history.largest_speed[largest]),
                time=float(history.largest_time[largest]),
                amplitude_dry=math.nan if dry is None or not bare.size else float(dry.largest[bare].max()),
            )
        )
    return tuple(found)


def model_of(scene: Scene, name: str) -> RunupModel:
    """A liquid model by its name, with the balls of a scene beside it."""
    if not scene.balls:
        return runup_model(name)
    made = couple_linear if name == "linear" else couple
    return partial(made, balls=started_balls(scene), position=_position(scene))


def _position(scene: Scene) -> float:
    """Plane of the first race, m; 0 without one."""
    return scene.balls[0].plane if scene.balls else 0.0


def rounding_spread(
    taken: RunupChoice, tasks: list[EnsembleTask], seed: int, workers: int, share: float
) -> Spread | None:
    """The range that rounding leaves a run-up; None where none was asked for or the run did not end.

    `share` of the work is done before.
    """
    if not tasks or not taken.history.converged:
        return None
    members = [member_of(taken.history)]
    try:
        for count, member in enumerate(_each(tasks, workers), 1):
            members.append(member)
            update(share + (1.0 - share) * count / len(tasks), 1.0)
    except KeyboardInterrupt:
        # What there is so far is reported.
        pass
    return spread_over(members, len(tasks) + 1, taken.history.time.size, seed)


def _each(tasks: list[EnsembleTask], workers: int) -> Iterator[Member]:
    """Run the members of an ensemble, in their order."""
    if workers <= 1:
        yield from map(run_member, tasks)
        return
    from leblanc.studies.processes import processes

    with processes(min(workers, len(tasks))) as pool:
        yield from pool.map(run_member, tasks)


def dry_run(
    scene: Scene, history: RunupHistory, drive: Drive, gravity: float, numerics: RunupNumerics, model: str
) -> RunupHistory | None:
    """The rotor of a scene on the same way without liquid and balls, to be compared with.

    By the model of the run: without liquid both step the rotor alike, and its steps are compiled by now.
    """
    if history.outcome is Outcome.INTERRUPTED:
        return None
    if history.layer_mass.sum() == 0.0 and not scene.balls:
        return history
    empty, made = [replace(fill, volume=0.0) for fill in scene.fills], runup_model(model)
    if scene.balls:
        made = partial(couple_linear if model == "linear" else couple, position=_position(scene))
    alone = replace(numerics, companion=False)
    return run_up(rotor_in_time(scene), empty, drive, scene.model.friction, gravity, alone, None, made)


def _never_caught(scene: Scene, history: RunupHistory) -> Iterator[Note]:
    """Liquid that still lies at the bottom though the drum turns fast enough for a ring."""
    top = float(history.speed.max())
    for k, fill in enumerate(scene.fills):
        gravity = across_gravity(scene)
        if gravity == 0.0 or history.captured[:, k].any() or top <= held_from(scene, fill):
            continue
        if pool_of(fill) is not None:
            speed = centrifuging_speed(fill, scene.model.friction, gravity)
            yield notes.not_carried(k, top, speed)


def steady_response(scene: Scene, speed: Array) -> Response | None:
    """Synchronous response over the speeds that were passed, refined where it is largest.

    None unless the rotor is a Jeffcott rotor without balls that passes speeds with an annular layer.
    """
    passed = _passed(speed, STEADY_SPEEDS)
    if not isinstance(scene.rotor, JeffcottRotor) or passed.size == 0 or is_cut(scene) or scene.balls:
        return None
    stands = captured_speed(scene)  # below, no annular layer has a steady response
    if stands is not None and not (passed := passed[passed > stands]).size:
        return None
    answer = response(jeffcott(scene), scene.fills, passed, axial_gravity(scene))
    exact = scene.altered(model=scene.model.altered(liquid="statics"))
    return by_speed(
        [answer, *responses_between([replace(prepare(exact), speed=passed)], [answer], drawn=True)]
    )


def whirl_bands(scene: Scene, speed: Array) -> Bands | None:
    """Bands of the speeds passed in which whirl is self-excited, rad/s; None with baffles or balls."""
    from solvers.whirl.edges import unstable_bands

    passed = _passed(speed, BAND_SPEEDS)
    if not scene.fills or passed.size == 0:
        return ()
    if scene.balls or any(fill.uneven for fill in scene.fills):
        return None
    return unstable_bands(dry_rotor(scene), [scene.fills], passed, scene.model.friction)[0]


def whirl_on_the_way(scene: Scene, bands: Bands | None) -> tuple[float, float] | None:
    """Estimated amplitude of the largest self-excited whirl, m, and its spin speed, rad/s.

    None where nothing grows, nothing bounds it, or it is no circle, as with gravity across the axis.
    """
    from solvers.cycles.estimate import largest_estimate

    if not bands or across_gravity(scene) > 0.0:
        return None
    range_ = bands[0][0], bands[-1][1]
    found = largest_estimate(dry_rotor(scene), scene.fills, range_, scene.model.friction, lambda: bands)
    return None if found is None else (found.amplitude, found.spin)


def _passed(speed: Array, count: int) -> Array:
    """Speeds evenly over those of a run with the spin, which a motor may have turned round; none if still."""
    low, high = max(float(speed.min()), 1e-3 * float(speed.max())), float(speed.max())
    return np.linspace(low, high, count) if 0.0 < low < high else np.empty(0)


def chamber_of(fill: Fill) -> FilledChamber:
    """A chamber with its liquid, as answers keep it."""
    chamber, name = fill.chamber, fill.liquid.name
    sizes = chamber.radius, chamber.inner_radius, chamber.height, fill.volume, name, fill.surface_radius
    return FilledChamber(*sizes, baffles=chamber.baffles)
