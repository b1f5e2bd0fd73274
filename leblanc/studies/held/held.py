"""Response of a scene with time-domain states: speeds at which they begin, and their results."""

from __future__ import annotations

import hashlib
import zipfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from contextlib import contextmanager
from dataclasses import fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import fluid
from fluid.whirl import covering_speed
from leblanc.core.answer import versions
from leblanc.core.files import writing
from leblanc.core.progress import update
from leblanc.liquid.choice import Choice
from leblanc.liquid.choose import Prepared, held_model, is_cut
from leblanc.studies.held.answer import Held
from leblanc.studies.held.holding import Began, Holding
from leblanc.studies.held.whirls import wave_errors
from leblanc.studies.processes import processes
from meshes.arrays import Array, Complex, Flags, Index
from solvers.held.branch import HeldBranches, HeldTask, Runner, held_branches
from solvers.held.integrate import compile_kernels, hold_with_error, require_known_solver, start
from solvers.held.state import HeldKind, HeldMachine, HeldState, HoldNumerics, Moment
from solvers.rotor.vibration import orbit
from solvers.synchronous.response import Response, by_speed, distance, joined, response
from solvers.whirl.growth import asynchronous_growth

# Of waves that py-pde does not integrate: fully nonlinear ones, those of KdV-Burgers.
OWN_STEPS = {"potential": "dop853", "kdv_held": "lawson"}
_KICK = 0.1  # of the layer's depth times the spin: what a whirl that grows by itself begins with


def hold_answer(
    machine: Prepared,
    choice: Choice,
    began: Began,
    holding: Holding,
) -> tuple[Choice, Response, Response, Held, dict[float, HeldState]]:
    """Answer of a machine with time-domain states where they are asked for.

    The choice with the wave as model where it was held; answers at the speeds asked for and between them; the
    time-domain states; the motions by their speeds, rad/s.
    """
    rows = np.flatnonzero(began.at)
    between = _between(began)
    steady = joined([began.answer.at(rows), began.refined.at(between)])
    order = np.argsort(steady.speed, kind="stable")
    more = asynchronous_growth(
        machine.rotor, machine.scene.fills, began.refined.speed[between], machine.friction
    )[0] if between.size else np.zeros(0)  # fmt: skip
    growth, total, done = np.concatenate([began.growth[rows], more])[order], steady.speed.size, 0

    def told(count: int) -> None:
        nonlocal done
        done += count
        what = f"waves integrated in time, {done} of {total} speeds" if done <= total else "waves carried on"
        update(what=what)

    told(0)
    found = hold_speeds(machine, steady.at(order), growth, holding, told)
    back = np.argsort(order, kind="stable")
    every = held_response(machine, steady.at(order), found).at(back)
    states = HeldBranches(*(tuple(way[k] for k in back.tolist()) for way in (found.up, found.down)))
    own = HeldBranches(states.up[: rows.size], states.down[: rows.size])
    held = held_result(own, machine, rows, holding.solver)
    motions = dict(zip(steady.speed.tolist(), states.up, strict=True))
    answer = _placed(began.answer, every.at(np.arange(rows.size)), rows)
    models, error = choice.models.astype("U9"), choice.error.copy()
    models[rows] = choice.held_model
    waves = np.nan_to_num(held.wave_error[rows])  # where they have no estimate the notes say so
    error[rows] = held.error[rows] + waves + _left_out(machine, began.answer.at(rows))
    if choice.held_model == "kdv_held":
        error[rows] += _family_left(machine, every.at(np.arange(rows.size)), held.limit_cycle[rows])
    kept = by_speed([every.at(np.arange(rows.size, total)), began.refined.at(_far(began))])
    return replace(choice, models=models, error=error), answer, kept, held, motions


def _left_out(machine: Prepared, steady: Response) -> Array:
    """Relative change of amplitude or liquid, the larger, by gravity along the axis, shape (n,).

    No held wave has it. Nothing where the answer with it or without is not known; nan for compartments, whose
    elements do not have it either.
    """
    if machine.axial_gravity == 0.0:
        return np.zeros(steady.speed.size)
    if is_cut(machine.scene):
        return np.full(steady.speed.size, np.nan)
    flat = response(machine.rotor, machine.scene.fills, steady.speed, 0.0, position=steady.position)
    with np.errstate(invalid="ignore", divide="ignore"):
        change = np.maximum(
            np.abs(flat.amplitude / steady.amplitude - 1.0),
            np.abs(flat.liquid_offset / steady.liquid_offset - 1.0),
        )
    return np.where(np.isfinite(change), change, 0.0)


def _family_left(machine: Prepared, found: Response, cycles: Flags) -> Array:
    """Distance of motions by KdV-Burgers from the exact equilibrium, relative; nan at limit cycles, (n,)."""
    exact = response(
        machine.rotor, machine.scene.fills, found.speed, machine.axial_gravity, position=found.position
    )
    return np.where(cycles, np.nan, distance(found, exact))


def _between(began: Began) -> Index:
    """Refined speeds at which the wave is held as well: the peaks, with liquid and without, next to one held.

    Where steady models answer on both sides they answer there too.
    """
    refined = began.refined
    wet = np.where(refined.holds, refined.amplitude, np.nan)
    peaks = [int(np.nanargmax(size)) for part in (wet, refined.amplitude_dry)
             if np.isfinite(size := np.where(np.isfinite(part), part, np.nan)).any()]  # fmt: skip
    return np.setdiff1d(np.array(peaks, dtype=np.intp), _far(began))


def _far(began: Began) -> Index:
    """Refined speeds between two at which steady models answer."""
    speed, after = began.answer.speed, np.searchsorted(began.answer.speed, began.refined.speed)
    last = speed.size - 1
    return np.flatnonzero(~(began.at[np.clip(after, 0, last)] | began.at[np.clip(after - 1, 0, last)]))


def _placed(whole: Response, part: Response, rows: Index) -> Response:
    """A response with another one at some of its speeds."""
    others = np.setdiff1d(np.arange(whole.speed.size), rows)
    if others.size == 0:
        return part
    order = np.argsort(np.concatenate([rows, others]), kind="stable")
    return joined([part, whole.at(others)]).at(order)


def held_machine(machine: Prepared) -> HeldMachine:
    """The machine as time-domain states take it."""
    fills = tuple(machine.scene.fills)
    liquid = held_model(machine.scene).removesuffix("_held")
    return HeldMachine(machine.system, fills, machine.friction, machine.across_gravity, liquid)


def hold_speeds(
    machine: Prepared,
    steady: Response,
    growth: Array,
    holding: Holding,
    progress: Callable[[int], object] = lambda _: None,
) -> HeldBranches:
    """Held states at the speeds of a steady response.

    `growth` is that of the fastest-growing whirl, 1/s, nan where it is not known.
    """
    held = held_machine(machine)
    numerics = HoldNumerics(cells=machine.scene.model.cells, solver=holding.solver)
    require_known_solver(held, float(steady.speed[0]), numerics)
    tasks = []
    for k, spin in enumerate(steady.speed.tolist()):
        found = np.isfinite(steady.coordinates[k]).all()
        grows = bool(growth[k] > 0.0) or not (found and steady.stable[k]) or bool(np.isnan(growth[k]))
        motion = steady.coordinates[k] if found else None
        begin = start(held, spin, numerics, motion, _KICK if grows else 0.0)
        rate = float(growth[k]) if np.isfinite(growth[k]) and (growth[k] > 0.0) == grows else 0.0
        tasks.append(HeldTask(begin, rate))
    several = np.count_nonzero(np.isfinite(steady.branch_deflection) & steady.branch_stable, axis=1) > 1
    with runner(held, numerics, holding.workers) as run:
        if holding.folder is not None:
            run = kept(run, holding.folder / FOLDER, held, numerics, holding.fresh)
        return held_branches(tasks, run, several, progress)


def held_response(machine: Prepared, steady: Response, found: HeldBranches) -> Response:
    """The steady response with time-domain states in the place of its own answers, all speeds.

    Angles, the rotor without liquid and the plane reported are those of the steady response.
    """
    system, fills = machine.system, machine.scene.fills
    up = found.up
    coordinates = np.array([state.coordinates for state in up])
    motion = orbit(system, coordinates, steady.position)
    offset, angle = _liquid(machine, up, coordinates)
    settled = np.array([state.settled for state in up])
    circles = settled & np.array([state.kind is not HeldKind.LIMIT_CYCLE for state in up])
    none = np.full((settled.size, 0), complex(np.nan, np.nan))
    return replace(
        steady,
        deflection=motion.forward,
        backward=motion.backward,
        coordinates=coordinates,
        liquid_offset=offset,
        liquid_angle=angle if fills else np.angle(motion.forward),
        dry_patch=np.array([state.dry.any() for state in up]),
        stable=circles,
        model=np.full(settled.shape, held_model(machine.scene)),
        # Steady waves of KdV-Burgers are out of range everywhere, as one family alone.
        in_range=_in_range(machine, up) & (steady.in_range | (held_model(machine.scene) == "kdv_held")),
        converged=settled,
        branch_deflection=np.column_stack([motion.forward, none]),
        branch_stable=circles[:, None],
        branch_backward=np.column_stack([motion.backward, none]),
        branch_coordinates=coordinates[:, None, :],
        fold_speed=np.full(settled.shape, np.nan),
        residual=np.array([state.change for state in up]),
        over_time=_sizes(machine, up),
    )


def _sizes(machine: Prepared, states: tuple[HeldState, ...]) -> Array:
    """Mean distance of the axis over time; where its orbit is an ellipse each turn's largest counts."""
    planar = machine.scene.rotor.kind == "jeffcott"
    return np.array([state.amplitude if planar else state.crest for state in states])


def _stops(machine: Prepared, spin: float) -> bool:
    """Whether friction stops the waves of KdV-Burgers before they go far."""
    from solvers.held.family import overdamped

    return overdamped(held_machine(machine), spin)


def _in_range(machine: Prepared, states: tuple[HeldState, ...]) -> Flags:
    """Every layer rides with the drum, covers a vertical wall, is long, and clear of its inner wall.

    By KdV-Burgers the wall is wet as well, as of its limit cycles, and friction lets waves go far.
    """
    found, model = [], held_model(machine.scene)
    exact, family = model == "potential", model == "kdv_held"
    covers = max((covering_speed(f, machine.axial_gravity) for f in machine.scene.fills), default=0.0)
    for state in states:
        rows = iter(range(len(state.moment.area)))
        # Beyond its range the equation leaves less than nothing on the wall.
        kept = state.spin >= covers and not (
            family and (bool(state.dry.any()) or _stops(machine, state.spin))
        )
        for j, fill in enumerate(machine.scene.fills):
            radius = fill.chamber.radius
            if not state.captured[j]:
                kept &= fill.volume == 0.0 or fill.surface_radius <= 0.0
                continue
            area = state.moment.area[next(rows)] / radius**2
            deepest = 1.0 - float(np.sqrt(max(1.0 - 2.0 * area.max(), 0.0)))
            kept &= (
                exact or fill.depth <= _LONG * radius
            ) and deepest * radius <= radius - fill.chamber.inner_radius
        found.append(kept)
    return np.array(found, dtype=bool)


_LONG = 0.3  # mean depth over the radius up to which waves are long


def _liquid(machine: Prepared, states: tuple[HeldState, ...], coordinates: Complex) -> tuple[Array, Array]:
    """Distance of all the liquid's mean centre of mass from the rotation axis, and its angle, in the drum."""
    fills = machine.scene.fills
    mass = np.array([fill.mass for fill in fills])
    if mass.sum() == 0.0:
        return np.zeros(len(states)), np.zeros(len(states))
    axes = np.stack([orbit(machine.system, coordinates, f.chamber.plane).forward for f in fills], axis=1)
    centre = (axes + np.array([state.liquid for state in states])) @ mass / mass.sum()
    return np.abs(centre), np.angle(centre)


def held_result(found: HeldBranches, machine: Prepared, at: Index, solver: str) -> Held:
    """Record of the time-domain states of a result."""
    up, down, speeds = found.up, found.down, machine.speed.size
    model = held_model(machine.scene)
    apart = found.hysteresis

    def spread(values: Sequence[Any] | Array, missing: complex | str = np.nan) -> NDArray[Any]:
        known = np.asarray(values)
        whole = np.full((speeds, *known.shape[1:]), missing, dtype=known.dtype)
        whole[at] = known
        return whole

    flags, states = np.zeros(speeds, dtype=bool), np.full(speeds, "steady", "U11")
    flags[at] = True
    states[at] = [str(state.kind) for state in up]
    states_down = states.copy()
    states_down[at] = [str(state.kind) for state in down]
    falling = np.where(apart, _sizes(machine, down), np.nan)
    return Held(
        at=flags,
        state=states,
        least=spread([state.least for state in up]),
        largest=spread([state.largest for state in up]),
        whirl_speed=spread([state.whirl_speed for state in up]),
        liquid=spread([state.liquid for state in up], complex(np.nan, np.nan)),
        ripple=spread([state.ripple for state in up]),
        error=spread([state.error for state in up]),
        state_down=states_down,
        amplitude_down=spread(falling),
        cells=machine.scene.model.cells,
        reason=spread([state.reason for state in up], ""),
        solver=OWN_STEPS.get(model, solver),
        model=model,
        wave_error=spread(wave_errors(machine, up)),
        energy_error=spread([state.energy_error for state in up]),
        multiplier=spread([np.abs(state.multipliers).max(initial=0.0) or np.nan for state in up]),
    )


FOLDER = "held"
_ROOMS = (
    "fluid",
    "fluid/friction",
    "solvers/rotor",
    "solvers/layer",
    "solvers/runup",
    "solvers/pypde",
    "solvers/potential",
    "solvers/held",
)


def kept(
    run: Runner, folder: Path, machine: HeldMachine, numerics: HoldNumerics, fresh: bool = False
) -> Runner:
    """A runner that looks for each state in a folder first, and leaves there what it finds."""
    folder.mkdir(parents=True, exist_ok=True)
    whole = _code()
    _feed(whole, (machine, numerics, versions()))

    def again(tasks: Sequence[HeldTask]) -> Iterator[tuple[int, HeldState]]:
        paths, missing = [], []
        for k, task in enumerate(tasks):
            own = whole.copy()
            _feed(own, task)
            paths.append(folder / f"{own.hexdigest()[:32]}.npz")
            known = None if fresh else _read(paths[-1])
            if known is None:
                missing.append(k)
            else:
                yield k, known
        for k, state in run([tasks[k] for k in missing]):
            _write(state, paths[missing[k]])
            yield missing[k], state

    return again


def _code() -> Any:
    """Digest of what holds states: another code may hold others."""
    digest, root = hashlib.sha256(), Path(fluid.__file__).parent.parent
    for room in _ROOMS:
        for path in sorted((root / room).glob("*.py")):
            digest.update(path.read_bytes())
    return digest


def _feed(digest: Any, value: Any) -> None:
    """Add a value to a digest by its content."""
    digest.update(type(value).__name__.encode())
    if isinstance(value, np.ndarray):
        digest.update(repr((value.shape, value.dtype.str)).encode())
        digest.update(np.ascontiguousarray(value).tobytes())
    elif isinstance(value, Enum):
        digest.update(repr(value.value).encode())
    elif is_dataclass(value):
        for each in fields(value):
            digest.update(each.name.encode())
            _feed(digest, getattr(value, each.name))
    elif isinstance(value, dict):
        _feed(digest, tuple(value.items()))
    elif isinstance(value, (tuple, list)):
        digest.update(str(len(value)).encode())
        for item in value:
            _feed(digest, item)
    else:
        digest.update(repr(value).encode())


def _write(state: HeldState, path: Path) -> None:
    values = {each.name: getattr(state, each.name) for each in fields(state) if each.name != "moment"}
    values["kind"] = str(state.kind)
    moment = {f"moment_{each.name}": getattr(state.moment, each.name) for each in fields(state.moment)}
    with writing(path) as part, part.open("wb") as file:
        np.savez(file, **(values | moment))


def _read(path: Path) -> HeldState | None:
    """The state in a file; None where there is none, or none that is whole."""
    try:
        with np.load(path, allow_pickle=False) as found:
            values = {name: found[name] for name in found.files}
        plain = {name: value.item() if value.ndim == 0 else value for name, value in values.items()}
        moment = Moment(**{each.name: plain.pop(f"moment_{each.name}") for each in fields(Moment)})
        plain["kind"] = HeldKind(plain["kind"])
        return HeldState(**plain, moment=moment)
    except (OSError, ValueError, KeyError, TypeError, EOFError, zipfile.BadZipFile):
        return None


@contextmanager
def runner(machine: HeldMachine, numerics: HoldNumerics, workers: int) -> Iterator[Runner]:
    """A runner of tasks in so many processes; in this one where that is one or none."""
    if workers <= 1:
        yield lambda tasks: _here(machine, numerics, tasks)
        return
    with processes(workers) as pool:
        yield lambda tasks: _there(pool, machine, numerics, tasks)


def _here(
    machine: HeldMachine, numerics: HoldNumerics, tasks: Sequence[HeldTask]
) -> Iterator[tuple[int, HeldState]]:
    for k, task in enumerate(tasks):
        yield k, hold_with_error(machine, task.begin, numerics, task.slowest)


def _there(
    pool: ProcessPoolExecutor, machine: HeldMachine, numerics: HoldNumerics, tasks: Sequence[HeldTask]
) -> Iterator[tuple[int, HeldState]]:
    if tasks:
        # Workers that find the kernels of another version on disk at the same time would mix the two.
        compile_kernels(machine, tasks[0].begin)
    waiting: dict[Future[HeldState], int] = {
        pool.submit(hold_with_error, machine, task.begin, numerics, task.slowest): k
        for k, task in enumerate(tasks)
    }
    for future in as_completed(waiting):
        yield waiting[future], future.result()
