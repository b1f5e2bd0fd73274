"""One speed: rotor and layers go on until they are steady, periodic, or bounded without ever repeating."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError, require_positive
from solvers.held.convergence import KNOWN, Watch
from solvers.held.state import (
    COUPLED,
    SHORT,
    HeldKind,
    HeldMachine,
    HeldState,
    HoldNumerics,
    Moment,
    PeriodicMotion,
)
from solvers.layer.baffles import FACE, table_of
from solvers.layer.places import fewest_cells, is_smeared
from solvers.layer.records import Outcome
from solvers.layer.state import ring
from solvers.runup.state import mean_area, planes_of


def start(
    machine: HeldMachine,
    spin: float,
    numerics: HoldNumerics,
    coordinates: Complex | None = None,
    kick: float = 0.0,
) -> Moment:
    """Rotor in a synchronous motion with its liquid at rest in the drum.

    `coordinates`: complex amplitudes, q = Re(coordinates e^{i Omega t}); `kick`: velocity of the axis beside
    that of the motion, over the layer's mean depth times the spin.
    """
    n = len(machine.system.coordinates)
    motion = np.zeros(n, dtype=complex) if coordinates is None else np.asarray(coordinates)
    if machine.exact:
        from solvers.held import exact

        # A thin layer without bores breaks of what long waves forget.
        return exact.begin(machine, spin, numerics.cells, motion, 0.1 * kick)
    if machine.family:
        from solvers.held import family

        return family.begin(machine, spin, numerics.cells, motion, kick)
    from solvers.pypde import RotorLayersPDE

    equation = RotorLayersPDE(
        machine.system, machine.fills, spin, friction=machine.friction, gravity=machine.gravity
    )
    rate = (1j * spin * motion).real
    planes, layers = planes_of(machine.system, machine.fills), np.flatnonzero(equation.layers)
    area = np.zeros((layers.size, numerics.cells))
    for row, j in enumerate(layers.tolist()):
        fill, plane = machine.fills[j], planes[j]
        forward = 0.5 * complex(plane[0] @ motion + 1j * (plane[1] @ motion))
        area[row] = _levelled(fill, _circle(fill, forward, numerics.cells))
        if kick:
            size = plane[0] @ np.linalg.solve(machine.system.mass, plane[0])
            rate = rate + kick * fill.depth * spin * np.linalg.solve(machine.system.mass, plane[0]) / size
    return Moment(spin, motion.real, rate, area, -spin * np.square(area), equation.layers)


def _circle(fill: Fill, deflection: complex, cells: int) -> Array:
    """Area of each cell under a circle about the rotation axis, m^2 [theory: long_wave, eq. 6]."""
    radius, angles = fill.chamber.radius, ring(cells)
    e = deflection / radius
    along = e.real * angles[0] + e.imag * angles[1]
    across = e.real * angles[1] - e.imag * angles[0]
    whole = mean_area(fill) * cells

    def area(squared: float) -> Array:
        surface = np.sqrt(np.maximum(squared - np.square(across), 0.0)) - along
        return np.asarray(0.5 * np.maximum(1.0 - np.square(np.clip(surface, 0.0, 1.0)), 0.0))

    low, high = 0.0, (1.0 + abs(e)) ** 2
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if area(middle).sum() > whole else (low, middle)
    found = area(0.5 * (low + high))
    return np.asarray(found * (whole / found.sum()) * radius**2)


def _levelled(fill: Fill, area: Array) -> Array:
    """Areas with as much liquid in each compartment as at rest: none passes closed baffles."""
    if fill.compartments < 2:
        return area
    faces = np.sort(table_of(fill, area.size)[:, FACE].astype(int))
    # The cells before the first face belong to the last compartment.
    where = (np.searchsorted(faces, np.arange(area.size), side="right") - 1) % faces.size
    mean = np.bincount(where, area, faces.size) / np.bincount(where, minlength=faces.size)
    return np.asarray(area + (area.mean() - mean)[where])


def hold(
    machine: HeldMachine,
    begin: Moment,
    numerics: HoldNumerics | None = None,
    slowest: float = 0.0,
    trackers: Sequence[Any] = (),
) -> HeldState:
    """Hold a machine at the spin of a moment until its motion has converged.

    `slowest`: rate at which the slowest small motion decays or grows, 1/s, 0 where it is not known; windows
    long against it tell a limit cycle from slow decay. `trackers` of py-pde are called beside our own.
    """
    return _held(machine, begin, numerics or HoldNumerics(), slowest, trackers, marches=True)[0]


def _held(
    machine: HeldMachine,
    begin: Moment,
    numerics: HoldNumerics,
    slowest: float,
    trackers: Sequence[Any] = (),
    marches: bool = False,
) -> tuple[HeldState, Moment | None]:
    """The state, and of a motion by Newton's method the moment with half the cells.

    That is asked for at once where small motions decay, and where they may grow once a march decays; never if
    it only `marches` [theory: held, eq. 19-24].
    """
    require_positive("speed", begin.spin)
    require_known_solver(machine, begin.spin, numerics)

    def near(moment: Moment) -> PeriodicMotion | None:
        return _periodic(machine, moment, numerics)

    asks = not (marches or machine.exact or machine.family) and numerics.solver == COUPLED
    later, moment = near if asks and slowest >= 0.0 else None, begin
    watch = Watch(machine, begin, numerics, slowest, later, guesses=not asks)
    orbit = near(begin) if asks and slowest < 0.0 else None
    while True:
        if orbit is not None:
            moment, rate = orbit.moment, math.log(orbit.multiplier) * begin.spin / (2.0 * math.pi)
            known = Watch(machine, moment, numerics, rate, few=KNOWN)
            known.count, known.steps = watch.count + orbit.turns, watch.steps
            watch = known
        moment, outcome = _march(machine, moment, numerics, watch, trackers)
        if watch.orbit is not None:
            orbit = watch.orbit
            continue
        fallen = _fallen(machine, moment, outcome, watch.down)
        if fallen is None or watch.count >= numerics.turns:
            state = watch.answer(moment, outcome)
            # An orbit that was not at rest after all has been marched on.
            if orbit is None or not state.settled or len(watch.sizes) > SHORT:
                return state, None
            return replace(state, multipliers=orbit.multipliers), orbit.half
        moment, orbit = fallen, None
        watch.forget(moment.layers)


# Fewest cells with which a motion that repeats is looked for before it is with more, and levels of them.
_COARSE, _LEVELS = 32, 3


def _periodic(machine: HeldMachine, begin: Moment, numerics: HoldNumerics) -> PeriodicMotion | None:
    """The stable motion that repeats next to a moment, from one mesh to the next finer one; None without."""
    from solvers.pypde import PeriodicNewtonSolver, RotorLayersPDE, run

    if not begin.layers.any():
        return None
    cells = [numerics.cells]
    while len(cells) < _LEVELS and cells[0] % 2 == 0 and cells[0] >= 2 * _COARSE:
        if _parted(machine, cells[0] // 2):
            break
        cells.insert(0, cells[0] // 2)
    orbit: Any = None
    moments, stretch = [], (0.0, 2.0 * math.pi / begin.spin)
    for count in cells:
        equation = RotorLayersPDE(
            machine.system, machine.fills, begin.spin, friction=machine.friction, gravity=machine.gravity,
            dispersion=numerics.dispersion, layers=begin.layers,
        )  # fmt: skip
        first = _resampled(machine, begin, count) if count < begin.area.shape[1] else begin
        state = equation.start(count, first.coordinates, first.rate, first.area, first.momentum)
        options = {"courant": numerics.courant, "known": orbit, "judged": count == numerics.cells}
        state, _ = run(equation, state, stretch, (), solver=PeriodicNewtonSolver.name, **options)
        orbit = equation.diagnostics["solver"].get("orbit")
        if orbit is None or orbit.stable is False:
            return None
        area, momentum, place, rate = (part.copy() for part in equation.parts(state))
        moments.append(Moment(begin.spin, place, rate, area, momentum, begin.layers))
    if not orbit.stable:
        return None
    return PeriodicMotion(
        moments[-1], moments[-2] if len(cells) > 1 else None, orbit.multipliers, orbit.turns
    )


def compile_kernels(machine: HeldMachine, begin: Moment) -> None:
    """Compile what holds a motion, or load it from disk, by a step of it."""
    if machine.exact or machine.family:  # nothing of it is compiled
        return
    from solvers.pypde import RotorLayersPDE, run

    equation = RotorLayersPDE(
        machine.system, machine.fills, begin.spin, friction=machine.friction, gravity=machine.gravity,
        layers=begin.layers,
    )  # fmt: skip
    stretch = 0.0, 1e-6 / begin.spin
    run(equation, equation.start(fewest_cells(machine.fills)), stretch, (), solver="coupled", follow=1)


def require_known_solver(machine: HeldMachine, spin: float, numerics: HoldNumerics) -> None:
    """Raise `InputError` unless py-pde has a solver of that name that can hold the machine."""
    if machine.exact or machine.family:
        waves = "fully nonlinear waves" if machine.exact else "waves of KdV-Burgers"
        if numerics.solver != COUPLED:
            raise InputError("solver", numerics.solver, f"left out: {waves} have their own steps")
        if numerics.cells < 16 or numerics.cells % 2:
            raise InputError("cells", numerics.cells, f"an even number from 16 for {waves}")
        return
    if numerics.solver == COUPLED:
        return
    from solvers.pypde import RotorLayersPDE
    from solvers.pypde.stock import require_solver

    require_solver(RotorLayersPDE(machine.system, machine.fills, spin), numerics.solver)


_SHARE = 0.5  # of what half the cells change; a third where the scheme is of second order


def hold_with_error(
    machine: HeldMachine, begin: Moment, numerics: HoldNumerics, slowest: float = 0.0
) -> HeldState:
    """`hold`, and from its end once more with half the cells, to estimate the error.

    No estimate with less than 16 cells, or 8 in a compartment.
    """
    found, begun = _held(machine, begin, numerics, slowest)
    half = replace(numerics, cells=numerics.cells // 2)
    fewest = 64 if machine.exact else 32 if machine.family else 16
    if numerics.cells < fewest or _parted(machine, half.cells) or not found.settled:
        return found
    # A guess would lead from a whirl to the steady motion; one that Newton's method has found decays as it
    # does there.
    rate = 0.0 if found.kind is HeldKind.LIMIT_CYCLE else slowest
    if found.multipliers.size:
        rate = math.log(abs(found.multipliers[0])) * begin.spin / (2.0 * math.pi)
    begun = _resampled(machine, found.moment, half.cells) if begun is None else begun
    other = hold(machine, begun, half, rate)
    if not other.settled or found.largest == 0.0:
        return replace(found, error=math.inf if found.largest else 0.0)
    gap = max(abs(found.amplitude - other.amplitude), abs(found.largest - other.largest)) / found.largest
    return replace(found, error=_SHARE * gap + found.change)


def _parted(machine: HeldMachine, cells: int) -> bool:
    """Whether a compartment has too few of so many cells."""
    return any(fill.compartments > 1 and is_smeared(fill, cells) for fill in machine.fills)


def _resampled(machine: HeldMachine, moment: Moment, cells: int) -> Moment:
    """The moment with another number of cells; what a layer and a compartment hold stays."""
    if machine.exact:
        from solvers.held.exact import again as with_nodes

        return with_nodes(machine, moment, cells)
    if machine.family:
        from solvers.held.family import again as with_modes

        return with_modes(machine, moment, cells)

    def again(rows: Array) -> Array:
        n = rows.shape[1]
        edges = np.linspace(0.0, n, cells + 1)
        sums = np.concatenate([np.zeros((len(rows), 1)), np.cumsum(rows, axis=1)], axis=1)
        found = [np.diff(np.interp(edges, np.arange(n + 1), row)) * cells / n for row in sums]
        return np.array(found).reshape(len(rows), cells)

    rows = zip(np.flatnonzero(moment.layers).tolist(), again(moment.area), strict=True)
    area = [_levelled(machine.fills[j], row) for j, row in rows]
    return replace(moment, area=np.array(area).reshape(-1, cells), momentum=again(moment.momentum))


def _march(
    machine: HeldMachine, moment: Moment, numerics: HoldNumerics, watch: Watch, trackers: Sequence[Any]
) -> tuple[Moment, Outcome]:
    """Advance on py-pde until the watch has seen enough, the turns have run out or the steps have failed.

    Fully nonlinear waves by `solvers.held.exact`, those of KdV-Burgers by `solvers.held.family`.
    """
    if machine.exact:
        from solvers.held import exact

        return exact.march(machine, moment, numerics, watch)
    if machine.family:
        from solvers.held import family

        return family.march(machine, moment, numerics, watch)
    from solvers.pypde import RotorLayersPDE, TurnTracker, run
    from solvers.pypde.stock import SAMPLES

    equation = RotorLayersPDE(
        machine.system, machine.fills, moment.spin, friction=machine.friction, gravity=machine.gravity,
        dispersion=numerics.dispersion, layers=moment.layers,
    )  # fmt: skip
    state = equation.start(numerics.cells, moment.coordinates, moment.rate, moment.area, moment.momentum)
    turn = 2.0 * math.pi / moment.spin
    stretch = 0.0, (numerics.turns - watch.count) * turn
    stops = 1 if numerics.solver == COUPLED else SAMPLES
    tracker = TurnTracker(equation, turn, watch.turn, stops)
    options = {"solver": numerics.solver, **_stepping(equation, state.grid, numerics, turn / stops)}
    state, outcome = run(equation, state, stretch, [tracker, *trackers], **options)
    watch.balances = tracker.balances
    area, momentum, place, rate = (part.copy() for part in equation.parts(state))
    return Moment(moment.spin, place, rate, area, momentum, moment.layers), outcome


_MARKS = 8  # times a turn at which the layers are looked at


def _stepping(equation: Any, grid: Any, numerics: HoldNumerics, interval: float) -> dict[str, Any]:
    """What `solve` is given with the name of a solver; an interval between two looks, s."""
    if numerics.solver == COUPLED:
        return {"follow": _MARKS, "courant": numerics.courant}
    from solvers.pypde.stock import stepping

    return stepping(equation, grid, numerics.solver, interval)


def _fallen(machine: HeldMachine, moment: Moment, outcome: Outcome, down: Flags) -> Moment | None:
    """The moment with its deepest layer at the bottom, where gravity has thrown it down; else None.

    `down`: layers that lie there already, between two walls.
    """
    thrown = outcome in (Outcome.AT_AXIS, Outcome.NOT_COUPLED) or bool(down.any())
    if not (thrown and machine.gravity > 0.0 and moment.layers.any()):
        return None
    which = np.flatnonzero(moment.layers)
    radius = np.array([machine.fills[j].chamber.radius for j in which.tolist()])
    depth = moment.area.max(axis=1) / np.square(radius)
    deepest = int(np.argmax(np.where(down, depth, 0.0) if down.any() else depth))
    layers, kept = moment.layers.copy(), np.arange(which.size) != deepest
    layers[which[deepest]] = False
    return replace(moment, area=moment.area[kept], momentum=moment.momentum[kept], layers=layers)
