"""Held states with fully nonlinear waves: a turn at a time, judged as long waves are [theory: held]."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fluid.whirl import body_force_rate
from meshes.arrays import Array, Complex, Flags
from solvers.held.convergence import Watch
from solvers.held.state import HeldMachine, HoldNumerics, Moment
from solvers.layer.records import Outcome
from solvers.potential.coupled import (
    Course,
    Ended,
    ExactLayer,
    ExactMachine,
    Parts,
    advance,
    breaking,
    coupled,
    finer,
    ramp,
    rough,
)
from solvers.potential.unsteady import answer, laid, levelled, node_angles, resampled, seen
from solvers.runup.state import WORKS, layer_capture, planes_of

MOST = 512  # nodes, beyond which a wave that wants more is none that can be told
_DAMPING = 1.0  # of the shortest waves
_TAIL = 1e-4  # of the waves' sizes in the last of the spectrum, above which nodes are doubled
_STEP = 1e-6  # tolerance of a step; the shortest waves bound it closer than that
_BETWEEN = 4  # moments between two steps, at which the axis is told


@dataclass
class _Turning:
    """What a watch may change: rows of y, of phi, of the coordinates and of their rates."""

    data: Array  #: shape (2l + 2n, m)


def riding(machine: HeldMachine, spin: float) -> Flags:
    """Which chambers hold a layer at a speed, shape (l,)."""
    return np.array([layer_capture(fill, machine.gravity) < spin for fill in machine.fills], dtype=bool)


def exact_machine(machine: HeldMachine, spin: float, layers: Flags, nodes: int) -> ExactMachine:
    """Rotor and exact layers of what is held; liquid that is not among the `layers` is a mass."""
    system = machine.system
    for fill, rides in zip(machine.fills, layers.tolist(), strict=True):
        if not rides:
            at = system.at(fill.chamber.plane)
            system = replace(system, mass=system.mass + fill.mass * at.T @ at)
    fills = [fill for fill, rides in zip(machine.fills, layers.tolist(), strict=True) if rides]
    rates = [body_force_rate(fill, machine.friction, spin) for fill in fills]
    gravity = complex(-machine.gravity)
    return coupled(system, fills, ramp(spin), friction=rates, gravity=gravity, nodes=nodes, damping=_DAMPING)


def begin(machine: HeldMachine, spin: float, nodes: int, motion: Complex, kick: float) -> Moment:
    """Rotor in a synchronous motion with its liquid at rest in the drum.

    `motion`: complex amplitudes of the coordinates; `kick`: velocity of the axis beside that, over the
    layers' depth times the spin.
    """
    layers = riding(machine, spin)
    exact = exact_machine(machine, spin, layers, nodes)
    state, planes = exact.rest(), planes_of(machine.system, machine.fills)
    parts = exact.parts(state)
    parts.place[:], parts.rate[:] = motion.real, (1j * spin * motion).real
    for row, j in enumerate(np.flatnonzero(layers).tolist()):
        fill, plane = machine.fills[j], planes[j]
        forward = 0.5 * complex(plane[0] @ motion + 1j * (plane[1] @ motion))
        hung = -machine.gravity / (spin**2 * fill.chamber.radius)
        parts.waves[row] = _wave(exact.layers[row], spin, forward / fill.chamber.radius, hung, nodes)
        if kick:
            way = np.linalg.solve(machine.system.mass, plane[0])
            parts.rate[:] += kick * fill.depth * spin * way / (plane[0] @ way)
    return _moment(exact, state, spin, layers)


def _wave(layer: ExactLayer, spin: float, deflection: complex, gravity: float, nodes: int) -> Array:
    """Wave under a circle about the rotation axis, and on it the small one of gravity, at rest in space.

    `deflection` over R in the drum frame, `gravity` over Omega^2 R along the first direction; without its
    wave the liquid would ripple for long. Both are lower together where they would leave the wall dry
    [theory: whirl, eq. 1-3].
    """
    depth, inner = layer.layer, 1.0 - layer.layer
    tanh = (1.0 - inner**2) / (1.0 + inner**2)
    rise = tanh * gravity / complex(1.0 + tanh, layer.friction / spin)
    lower = min(1.0, 0.8 * depth / max(abs(deflection) + abs(rise), 1e-300))
    size, away = lower * abs(deflection), float(np.angle(-deflection))

    def radius(angle: Array) -> Array:
        off = angle - away
        circle = size * np.cos(off) + np.sqrt(np.square(inner) - np.square(size * np.sin(off)))
        return np.asarray(circle + lower * np.real(rise * np.exp(-1j * angle)))

    found = levelled(laid(radius, nodes).state, math.pi * depth * (2.0 - depth))
    angle = node_angles(found)
    found[nodes:] = lower * np.real(1j * rise * inner / tanh * np.exp(-1j * angle))
    return found


def _moment(exact: ExactMachine, state: Array, spin: float, layers: Flags) -> Moment:
    """A state at the end of a turn, with what is seen of its waves at even angles."""
    parts, m = exact.parts(state), exact.nodes
    even = 2.0 * math.pi * np.arange(m) / m
    area, momentum = np.zeros((2, len(exact.layers), m))
    for j, (layer, wave) in enumerate(zip(exact.layers, parts.waves, strict=True)):
        radius, velocity = seen(wave, even)
        over = 0.5 * (1.0 - np.square(radius))
        area[j] = layer.radius**2 * over
        momentum[j] = layer.radius**4 * spin * over * (velocity - over)
    return Moment(spin, parts.place.copy(), parts.rate.copy(), area, momentum, layers, parts.waves.copy())


def march(
    machine: HeldMachine, moment: Moment, numerics: HoldNumerics, watch: Watch
) -> tuple[Moment, Outcome]:
    """Advance turn by turn until the watch has seen enough, the turns have run out or a wave breaks down.

    Where nodes were too few it goes on with twice as many.
    """
    nodes = moment.wave.shape[1] // 2 if len(moment.wave) else numerics.cells
    exact = exact_machine(machine, moment.spin, moment.layers, nodes)
    turn, state = 2.0 * math.pi / moment.spin, exact.rest()
    parts = exact.parts(state)
    parts.place[:], parts.rate[:], parts.waves[:] = moment.coordinates, moment.rate, moment.wave
    while watch.count < numerics.turns:
        course = advance(exact, state, (0.0, turn), _STEP)
        if course.ended in (Ended.BROKE, Ended.NODES) or rough(exact, course.state, _TAIL):
            if exact.nodes >= MOST or not exact.layers:
                broke = course.ended is Ended.BROKE or breaking(exact, turn, course.state)
                outcome = Outcome.BROKE if broke else Outcome.WANTS_NODES
                return _moment(exact, state, moment.spin, moment.layers), outcome
            exact, state = finer(exact, state)
            watch.forget(moment.layers)
            continue
        if course.ended is Ended.DRIED:
            return _moment(exact, state, moment.spin, moment.layers), Outcome.DRIED
        before, state = state, course.state.copy()
        enough = _told(exact, (before, state), course, watch, turn)
        # Angles begin anew with each turn: it is the same as the one before.
        exact.parts(state).turned[:, 0] = 0.0
        if enough:
            return _moment(exact, state, moment.spin, moment.layers), Outcome.DONE
    return _moment(exact, state, moment.spin, moment.layers), Outcome.DONE


def _told(exact: ExactMachine, ends: tuple[Array, Array], course: Course, watch: Watch, turn: float) -> bool:
    """Hand a turn to the watch; whether it has seen enough. It may change the state at the end."""
    before, state = ends
    parts, m, count = exact.parts(state), exact.nodes, len(exact.layers)
    fields = np.concatenate((parts.waves[:, :m], parts.waves[:, m:]))
    uniform = np.concatenate((parts.place, parts.rate))
    turning = _Turning(np.concatenate((fields, np.tile(uniform[:, None], m))))
    known = turning.data.copy()
    heights = np.stack((exact.parts(before).waves[:, :m], parts.waves[:, :m]))
    radius = np.array([layer.radius for layer in exact.layers])[:, None]
    areas = 0.5 * np.square(radius) * -np.expm1(-2.0 * heights)
    steps = _steps(exact, exact.parts(before), course, turn)
    steps[:, 0] += watch.count * turn
    steps[:, 1] += 2.0 * math.pi * watch.count
    unbalance, gravity, drive, support, friction, gained = course.balance.tolist()
    works = {"unbalance": unbalance, "gravity": gravity, "drive": drive, "support": support}
    works["friction"] = friction
    watch.balances.append(np.array([*(works.get(name, 0.0) for name in WORKS), gained]))
    enough = watch.turn(steps, areas, turning)
    if not np.array_equal(known, turning.data):
        n = parts.place.size
        parts.place[:], parts.rate[:] = turning.data[2 * count : -n, 0], turning.data[-n:, 0]
        for j, layer in enumerate(exact.layers):
            wave = np.concatenate((turning.data[j], turning.data[count + j]))
            parts.waves[j] = levelled(wave, math.pi * layer.layer * (2.0 - layer.layer))
    return enough


def _steps(exact: ExactMachine, begin: Parts, course: Course, turn: float) -> Array:
    """Rows of time, angle, coordinates and moments, some between two steps by cubic splines."""
    from scipy.interpolate import CubicHermiteSpline

    first = [answer(wave) for wave in begin.waves]
    time = np.concatenate(([0.0], course.time))
    moment = np.concatenate((np.array([[found.moment for found in first]], dtype=complex), course.moment))
    change = np.concatenate((np.array([[found.momentum for found in first]], dtype=complex), course.momentum))
    values, slopes = np.vstack((begin.place, course.place)), np.vstack((begin.rate, course.rate))
    liquid, moves = (
        np.stack((part.real, part.imag), axis=2).reshape(time.size, -1)
        for part in (moment, exact.unit * change)
    )
    spline = CubicHermiteSpline(time, np.hstack((values, liquid)), np.hstack((slopes, moves)))
    at = np.linspace(0.0, turn, _BETWEEN * course.time.size + 1)[1:]
    return np.column_stack((at, exact.unit * at, spline(at)))


def again(machine: HeldMachine, moment: Moment, nodes: int) -> Moment:
    """The moment with another number of nodes."""
    exact = exact_machine(machine, moment.spin, moment.layers, nodes)
    state = exact.rest()
    parts = exact.parts(state)
    parts.place[:], parts.rate[:] = moment.coordinates, moment.rate
    for j, (layer, wave) in enumerate(zip(exact.layers, moment.wave, strict=True)):
        parts.waves[j] = levelled(resampled(wave, nodes), math.pi * layer.layer * (2.0 - layer.layer))
    return _moment(exact, state, moment.spin, moment.layers)
