"""A rotor with exact layers through time: no iteration, since a layer's force is linear in the body force.

Plane vectors are complex numbers in the standing frame, their real part along the first direction
[theory: potential, eq. 25-32]. Dimensional but for the waves, whose lengths are over R and whose times are in
1/`unit`.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable, Sequence
from dataclasses import astuple, dataclass, replace
from enum import StrEnum

import numpy as np

from fluid.fill import Fill
from fluid.whirl import is_full
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.potential.in_time import BREAKING, LOST, Watch, watched
from solvers.potential.unsteady import Answer, answer, invariants, resampled, still, tail
from solvers.rotor.system import RotorSystem

# Angle of the drum, its speed and the rate of that, at a time: rad, rad/s, rad/s^2.
Spinning = Callable[[float], tuple[float, float, float]]

_ABSOLUTE = 1e-3  # of the tolerance


class Ended(StrEnum):
    """Why a course ends."""

    DONE = "done"
    # The liquid at a crest overtakes it, or the surface overhangs [theory: potential, eq. 23].
    BROKE = "broke"
    # The nodes do not carry a wave any more whose crest does not break.
    NODES = "nodes"
    DRIED = "dried"


def ramp(start: float, rate: float = 0.0) -> Spinning:
    """Spin that changes evenly, rad/s, rad/s^2; at time 0 the zero mark lies along the first direction."""
    return lambda time: (start * time + 0.5 * rate * time**2, start + rate * time, rate)


@dataclass(frozen=True)
class ExactLayer:
    """A layer and how it moves with the rotor."""

    plane: Array  #: displacement of its chamber's axis for unit coordinates, shape (2, n)
    weight: float  #: rho h_c, kg/m^2
    radius: float  #: R, m
    layer: float  #: h_0/R
    friction: float = 0.0  #: k of a force -k u on all its liquid, u being the velocity in the drum, 1/s

    @property
    def mass(self) -> float:
        """Mass of the liquid, kg."""
        return self.weight * math.pi * self.radius**2 * self.layer * (2.0 - self.layer)


@dataclass(frozen=True)
class Parts:
    """A state taken apart; n coordinates, l layers of m nodes."""

    place: Array  #: coordinates and their rates, shape (n,)
    rate: Array
    turned: Array  #: angle of the frame in which each layer has no vorticity, and its speed, shape (l, 2)
    waves: Array  #: y and phi of each layer, shape (l, 2m)


@dataclass(frozen=True)
class Powers:
    """What brings energy to rotor and layers, and what takes it, W [theory: potential, eq. 32]."""

    unbalance: float  #: of the drive by way of the unbalance
    gravity: float  #: across the axis, but for the weight that is at rest
    drive: float  #: on the liquid, by its friction
    support: float  #: heat
    friction: float


@dataclass(frozen=True)
class ExactMachine:
    """A rotor with exact layers."""

    system: RotorSystem  #: the rotor, with the mass of liquid that has no free surface
    layers: tuple[ExactLayer, ...]  #: any number
    spin: Spinning  #: of the drum over time
    unit: float  #: spin at the time 0, rad/s; one over it is the waves' unit of time
    gravity: complex  #: across the axis, standing frame, complex, m/s^2
    nodes: int  #: of each surface, even
    damping: float = 0.0  #: of the shortest waves, over the unit, see `solvers.potential.unsteady.rates`

    def rest(self) -> Array:
        """State without deflection, its liquid at rest in the drum."""
        n, turned = len(self.system.coordinates), np.array([[0.0, self.unit]] * len(self.layers))
        waves = [still(layer.layer, self.nodes).state for layer in self.layers]
        return np.concatenate((np.zeros(2 * n), turned.ravel(), *waves))

    def parts(self, state: Array) -> Parts:
        """State of shape (2n + 2l + 2ml,) taken apart; what is changed in the parts is changed in it."""
        n, count = len(self.system.coordinates), len(self.layers)
        turned = state[2 * n : 2 * (n + count)].reshape(count, 2)
        return Parts(
            state[:n], state[n : 2 * n], turned, state[2 * (n + count) :].reshape(count, 2 * self.nodes)
        )

    def joined(self, parts: Parts) -> Array:
        """A state from its parts."""
        return np.concatenate((parts.place, parts.rate, parts.turned.ravel(), parts.waves.ravel()))

    def rates(self, time: float, state: Array) -> Array:
        """Rates of change of a state [theory: potential, eq. 28-30]."""
        parts, speed = self.parts(state), self.spin(time)[1]
        acceleration, answers = self.motion(time, parts)
        changes = [parts.rate, acceleration]
        turning, waves = np.empty_like(parts.turned), np.empty_like(parts.waves)
        for j, (layer, found) in enumerate(zip(self.layers, answers, strict=True)):
            angle, own = parts.turned[j].tolist()
            turning[j] = own, layer.friction * (speed - own)
            felt = self.gravity - complex(*(layer.plane @ acceleration))
            push = felt * cmath.exp(-1j * angle) / (layer.radius * self.unit**2)
            waves[j] = self.unit * found.rates(push)
        return np.concatenate((*changes, turning.ravel(), waves.ravel()))

    def motion(self, time: float, parts: Parts) -> tuple[Array, list[Answer]]:
        """Acceleration of the coordinates, shape (n,), and what the layers answer."""
        system, (angle, speed, rate) = self.system, self.spin(time)
        left = system.mass.copy()
        right = ((speed**2 - 1j * rate) * system.unbalance * cmath.exp(1j * angle)).real
        right = right - (system.damping + speed * system.gyroscopic) @ parts.rate
        right -= system.stiffness @ parts.place
        answers, weight = [], np.array([self.gravity.real, self.gravity.imag])
        for layer, (turned, own), wave in zip(self.layers, parts.turned.tolist(), parts.waves, strict=True):
            unit, turn = self.unit, cmath.exp(1j * turned)
            found = answer(wave, own / unit, layer.friction / unit, self.damping)
            scale, lag = layer.weight * layer.radius**3 * unit, (speed - own) / unit
            dragged = layer.friction * scale * (found.momentum - 1j * lag * found.moment)
            force = turn * (scale * unit * found.force + dragged)
            standing = np.array([[turn.real, -turn.imag], [turn.imag, turn.real]])
            inertia = layer.weight * layer.radius**2 * standing @ found.response @ standing.T
            given = np.array([force.real, force.imag]) + inertia @ weight - layer.mass * weight
            right += layer.plane.T @ given
            left += layer.plane.T @ inertia @ layer.plane
            answers.append(found)
        return np.asarray(np.linalg.solve(left, right), dtype=float), answers

    def energy(self, state: Array) -> float:
        """Energy of rotor and layers, J [theory: potential, eq. 31]."""
        parts, system = self.parts(state), self.system
        total = 0.5 * (parts.rate @ system.mass @ parts.rate + parts.place @ system.stiffness @ parts.place)
        for layer, (turned, own), wave in zip(self.layers, parts.turned.tolist(), parts.waves, strict=True):
            axis, kept = complex(*(layer.plane @ parts.rate)), invariants(wave, own / self.unit)
            inner = kept.energy + own / self.unit * kept.angular_momentum
            total += 0.5 * layer.mass * abs(axis) ** 2
            total += (axis.conjugate() * self._momentum(layer, turned, own, wave)).real
            total += layer.weight * layer.radius**4 * self.unit**2 * inner
        return float(total)

    def powers(self, time: float, state: Array) -> Powers:
        """Powers that change the energy at a time."""
        parts, system, (angle, speed, rate) = self.parts(state), self.system, self.spin(time)
        push = ((speed**2 - 1j * rate) * system.unbalance * cmath.exp(1j * angle)).real
        fall = drive = friction = 0.0
        for layer, (turned, own), wave in zip(self.layers, parts.turned.tolist(), parts.waves, strict=True):
            momentum = self._momentum(layer, turned, own, wave)
            fall += (self.gravity.conjugate() * momentum).real
            alone, lag = invariants(wave, 0.0), (speed - own) / self.unit
            inertia = invariants(wave, 1.0).angular_momentum - alone.angular_momentum
            scale = layer.friction * layer.weight * layer.radius**4 * self.unit
            drive -= speed * scale * (alone.angular_momentum - lag * inertia)
            heat = 2.0 * (alone.energy - lag * alone.angular_momentum) + lag**2 * inertia
            friction += scale * self.unit * heat
        support = float(parts.rate @ system.damping @ parts.rate)
        return Powers(float(push @ parts.rate), fall, drive, support, friction)

    def _momentum(self, layer: ExactLayer, turned: float, own: float, wave: Array) -> complex:
        """Momentum of the liquid relative to its axis, kg m/s, standing frame."""
        found = answer(wave)
        relative = found.momentum + 1j * own / self.unit * found.moment
        return layer.weight * layer.radius**3 * self.unit * relative * cmath.exp(1j * turned)


@dataclass(frozen=True)
class Course:
    """Rotor and layers over a stretch of time, at m moments, the beginning left out."""

    time: Array  #: s, shape (m,)
    place: Array  #: of the rotor, shape (m, n)
    rate: Array
    #: V times each layer's centre of mass and the rate of that, in the layer's frame over R^3 and the unit,
    #: complex, shape (m, l)
    moment: Complex
    momentum: Complex
    state: Array  #: at the end
    #: integrals over time of the powers, J, in the order of `Powers`, and what the energy has gained
    balance: Array
    ended: Ended  #: why it went no further


def coupled(
    system: RotorSystem,
    fills: Sequence[Fill],
    spin: Spinning,
    *,
    friction: Sequence[float] = (),
    gravity: complex = 0j,
    nodes: int = 128,
    damping: float = 0.0,
) -> ExactMachine:
    """Rotor with exact layers, of all chambers that hold one; a full one is a mass, an empty one nothing.

    `friction` is k of each chamber's liquid, 1/s; gravity across the axis, standing frame, complex, m/s^2;
    `nodes` of each surface, even; `damping` that of the shortest waves, over the spin at the time 0.
    """
    rates = tuple(friction) or (0.0,) * len(fills)
    if len(rates) != len(fills):
        raise InputError("friction", len(rates), f"{len(fills)} rates, one a chamber")
    layers, heavy, start = [], system, spin(0.0)[1]
    require_positive("spin", start)
    for j, (fill, rate) in enumerate(zip(fills, rates, strict=True)):
        require_not_negative("friction", rate)
        chamber, plane = fill.chamber, system.at(fill.chamber.plane)
        if fill.uneven and fill.volume > 0.0:
            raise InputError(
                f"chambers.{j}", "baffles or a section", "a plain circle for the fully nonlinear wave"
            )
        if is_full(fill):
            heavy = replace(heavy, mass=heavy.mass + fill.mass * plane.T @ plane)
        elif fill.volume > 0.0:
            weight = fill.liquid.density * chamber.height
            depth = fill.depth / chamber.radius
            layers.append(ExactLayer(plane, weight, chamber.radius, depth, rate))
    return ExactMachine(heavy, tuple(layers), spin, start, gravity, nodes, damping)


def advance(
    machine: ExactMachine, begin: Array, stretch: tuple[float, float], tolerance: float = 1e-9
) -> Course:
    """Take a machine through time, by steps that the fastest of its waves allows.

    The course ends where a wave breaks or the nodes do not carry it. `tolerance` of a step is relative; the
    absolute one is a thousandth of it, of the radius, the unit and so on.
    """
    from scipy.integrate import DOP853

    size = max((layer.radius for layer in machine.layers), default=1.0)
    n, turns = len(machine.system.coordinates), 2 * len(machine.layers)
    scale = np.ones(begin.size)
    scale[:n], scale[n : 2 * n], scale[2 * n : 2 * n + turns] = size, size * machine.unit, machine.unit
    longest = 2.0 / (1.0 + math.sqrt(1.0 + machine.nodes / 3.0)) / machine.unit
    count = max(1, math.ceil((stretch[1] - stretch[0]) / longest))
    longest = (stretch[1] - stretch[0]) / count * (1.0 + 1e-12)
    solver = DOP853(
        *(machine.rates, stretch[0], begin.copy(), stretch[1]),
        rtol=tolerance,
        atol=_ABSOLUTE * tolerance * scale,
        max_step=longest,
        first_step=min(longest, stretch[1] - stretch[0]),
    )
    rows: list[tuple[float, Array, Array, list[complex], list[complex], Array]] = []
    powers = np.array([astuple(machine.powers(stretch[0], begin))])
    volumes, ended = _volumes(machine, begin), Ended.DONE
    while solver.status == "running" and ended is Ended.DONE:
        with np.errstate(all="ignore"):
            failed = solver.step()
            ended = Ended.NODES if failed else _judged(machine, machine.parts(solver.y), volumes)
            if ended is Ended.NODES and breaking(machine, solver.t, solver.y):
                ended = Ended.BROKE
        if ended in (Ended.BROKE, Ended.NODES):
            break
        parts, power = machine.parts(solver.y), machine.powers(solver.t, solver.y)
        answers = [answer(wave) for wave in parts.waves]
        moment, momentum = ([getattr(found, name) for found in answers] for name in ("moment", "momentum"))
        own = solver.t, parts.place.copy(), parts.rate.copy(), moment, momentum
        rows.append((*own, np.array(astuple(power))))
    powers = np.vstack((powers, *(row[5] for row in rows)))
    whole = np.trapezoid(powers, [stretch[0], *(row[0] for row in rows)], axis=0)
    return Course(
        time=np.array([row[0] for row in rows]),
        place=np.array([row[1] for row in rows]).reshape(-1, n),
        rate=np.array([row[2] for row in rows]).reshape(-1, n),
        moment=np.array([row[3] for row in rows], dtype=complex).reshape(len(rows), len(machine.layers)),
        momentum=np.array([row[4] for row in rows], dtype=complex).reshape(len(rows), len(machine.layers)),
        state=solver.y.copy(),
        balance=np.append(whole, machine.energy(solver.y) - machine.energy(begin)),
        ended=ended,
    )


def shapes(machine: ExactMachine, time: float, state: Array) -> list[Watch]:
    """Shape of each layer's wave."""
    parts, change = machine.parts(state), machine.parts(machine.rates(time, state))
    volumes = [math.pi * layer.layer * (2.0 - layer.layer) for layer in machine.layers]
    return [
        watched(wave, rate / machine.unit, volume)
        for wave, rate, volume in zip(parts.waves, change.waves, volumes, strict=True)
    ]


def breaking(machine: ExactMachine, time: float, state: Array) -> bool:
    """Whether the crest of a wave breaks, which is more than that it needs more nodes."""
    if not np.isfinite(state).all():
        return False
    found = shapes(machine, time, state)
    return any(now.crest_number > BREAKING or now.slope > 0.5 * math.pi for now in found)


def rough(machine: ExactMachine, state: Array, most: float) -> bool:
    """Whether the last of the spectrum is above a share of the waves' sizes: the waves need more nodes."""
    waves = machine.parts(state).waves
    if not np.isfinite(waves).all():
        return True
    return any(tail(wave, layer.layer) > most for wave, layer in zip(waves, machine.layers, strict=True))


def finer(machine: ExactMachine, state: Array) -> tuple[ExactMachine, Array]:
    """Machine and state on twice as many nodes."""
    parts, onto = machine.parts(state), replace(machine, nodes=2 * machine.nodes)
    waves = np.array([resampled(wave, onto.nodes) for wave in parts.waves])
    return onto, onto.joined(replace(parts, waves=waves))


def _volumes(machine: ExactMachine, state: Array) -> Array:
    return np.array([invariants(wave).volume for wave in machine.parts(state).waves])


def _judged(machine: ExactMachine, parts: Parts, volumes: Array) -> Ended:
    """Whether the nodes carry the waves of a state."""
    if not (np.isfinite(parts.waves).all() and np.isfinite(parts.place).all()):
        return Ended.NODES
    if parts.waves[:, : machine.nodes].min(initial=1.0) <= 0.0:
        return Ended.DRIED
    found = np.array([invariants(wave).volume for wave in parts.waves])
    return Ended.NODES if np.abs(found / volumes - 1.0).max(initial=0.0) > LOST else Ended.DONE
