"""Held states by KdV-Burgers: rotor and the waves of each layer a turn at a time [theory: held, eq. 16-18].

The family against the spin steepens, disperses, diffuses and rubs, the other answers linearly, both on liquid
that lags; the equations of limit cycles [theory: kdv, eq. 34-36, 40] as they stand, not about a cycle. Seen
from the drum; waves and their lengths over R, times over 1/Omega; coordinates in m or rad.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass, replace

import numpy as np

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import damping_rate
from fluid.friction.wall import lag_drag
from meshes.arrays import Array, Complex, Flags
from solvers.held.convergence import Watch
from solvers.held.exact import riding
from solvers.held.state import HeldMachine, HoldNumerics, Moment
from solvers.layer.records import Outcome
from solvers.runup.path import fastest_frequency
from solvers.runup.state import mean_area, planes_of, unit_slip

_COURANT = 2.0  # of the highest mode under the steepest wave and of the rotor: the steps are good to 2.8
_FEWEST = 48  # steps in a turn
_LOOKS = 8  # in a turn, at the waves' heights
_LEAST = 1e-7  # of the spin: smaller lags are dragged as this one
_HIGHEST = 30.0  # of the mean area: modes that no wave has


@dataclass(frozen=True)
class Frozen:
    """What changes so slowly that a step keeps it, shape (l,)."""

    lag: Array
    wall: Array  #: torque of the wall over the lag
    diffusion: Array


class FamilyMachine:
    """Rotor and l layers of so many modes, n coordinates; liquid that is not among the `layers` is a mass."""

    def __init__(self, machine: HeldMachine, spin: float, layers: Flags, cells: int) -> None:
        system, self.held, self.spin, self.modes = machine.system, machine, spin, cells // 2 - 1
        self.fills = [fill for fill, rides in zip(machine.fills, layers.tolist(), strict=True) if rides]
        mass = system.mass.astype(float)
        for fill in machine.fills:
            at = system.at(fill.chamber.plane)
            mass = mass + fill.mass * at.T @ at
        planes = planes_of(system, self.fills) if self.fills else np.zeros((0, 2, len(system.mass)))
        self.system, self.whole, self.rows = system, mass, planes[:, 0] + 1j * planes[:, 1]
        self.gravity = complex(-machine.gravity) / spin**2
        self.radius = np.array([fill.chamber.radius for fill in self.fills])
        self.mass = np.array([fill.mass for fill in self.fills])
        pairs = [[kdv.coefficients(1.0, 1.0 - f.depth / f.chamber.radius, 1.0, sign) for sign in (-1, 1)]
                 for f in self.fills]  # fmt: skip
        self.near, self.far = [near for near, _ in pairs], [far for _, far in pairs]
        self.surface = np.array([c.surface_radius for c in self.near])
        self.mean = np.array([c.mean_area for c in self.near])
        self.inertia = 0.5 * (1.0 + np.square(self.surface))  # of the liquid over m R^2
        rates = [self._rate(fill) for fill in self.fills]
        self.decay = np.array([float(kdv.decay(c, k)) for c, k in zip(self.near, rates, strict=True)])
        self.far_decay = np.array([float(kdv.decay(c, k)) for c, k in zip(self.far, rates, strict=True)])
        self.steepening = np.array([c.steepening for c in self.near])
        self.coupling = np.array([c.coupling for c in self.near])
        n = np.arange(1.0, self.modes + 1.0)
        own = [kdv.wave_frequency(n, c, False) for c in self.near]
        self.numbers, self.frequency = n, np.array(own).reshape(-1, self.modes)
        self.far_frequency = np.array([float(kdv.wave_frequency(1, c, False)) for c in self.far])
        self.lever, self._squares = self.surface / self.mean, np.square(n)
        self.damping, self._springs = system.damping / spin + system.gyroscopic, system.stiffness / spin**2
        self._inverse, self._carried = np.linalg.inv(mass), (self.mass * self.radius) * self.rows.conj().T

    def _rate(self, fill: Fill) -> float:
        """Rate at which the wall stops waves, over the spin; laminar at the slower natural wave's."""
        friction, chamber, slip = self.held.friction, fill.chamber, unit_slip(fill) * self.spin
        law, coefficient = friction.at(fill.liquid.viscosity, slip, chamber.radius)
        lid = friction.lid(chamber.radius, chamber.height, slip, self.spin)
        depth = fill.depth / chamber.radius
        return float(damping_rate(law, coefficient, lid, depth, mean_area(fill), 0.0)) / self.spin

    def wall(self, lag: Array) -> Array:
        """Torque of the wall over the lag, m R^2 Omega^2 of the liquid, shape (l,)."""
        behind = np.maximum(np.abs(lag), _LEAST)
        drags = [
            lag_drag(fill, self.held.friction, one * self.spin, self.spin, unit_slip(fill) * self.spin)
            for fill, one in zip(self.fills, behind.tolist(), strict=True)
        ]
        return np.asarray(drags / behind) / self.spin**2

    def frozen(self, state: Complex, acceleration: Array) -> Frozen:
        """What a step keeps, by a state and the axes' acceleration over R [theory: kdv, eq. 39]."""
        lag = self.parts(state)[2].real.copy()
        each = zip(self.near, acceleration.tolist(), strict=True)
        diffusion = [float(kdv.diffusion(c, kdv.forcing(c, size))) for c, size in each]
        return Frozen(lag, self.wall(lag), np.array(diffusion))

    def parts(self, state: Complex) -> tuple[Complex, Complex, Complex, Complex, Complex]:
        """Modes, the other family's first one, lags, coordinates, momenta, as views."""
        count, n, first = len(self.fills), len(self.system.mass), len(self.fills) * self.modes
        ends = first + count, first + 2 * count, first + 2 * count + n
        v = state[:first].reshape(count, self.modes)
        return v, state[first : ends[0]], state[ends[0] : ends[1]], state[ends[1] : ends[2]], state[ends[2] :]

    def offset(self, state: Complex) -> Complex:
        """Centre of mass from the chamber's axis over R, in the drum, shape (l,) [theory: kdv, eq. 35]."""
        v, other = self.parts(state)[:2]
        return np.asarray(self.lever * np.conj(v[:, 0] + other))

    def areas(self, state: Complex, points: int) -> Array:
        """Area per radian at even angles over R^2, shape (l, points)."""
        v, other = self.parts(state)[:2]
        modes = np.zeros((len(v), self.modes + 1), dtype=complex)
        modes[:, 1:] = v
        modes[:, 1] += other
        return np.asarray(self.mean[:, None] + np.fft.irfft(modes, points, norm="forward"))

    def velocity(self, time: float, state: Complex, frozen: Frozen) -> Array:
        """Rates of the coordinates, shape (n,): the liquid's own momentum is that of its centre of mass."""
        moved = cmath.exp(1j * time) * self._moved(state, frozen)
        return np.asarray(self._inverse @ (self.parts(state)[4].real - self._felt(moved)))

    def moving(self, state: Complex, velocity: Array) -> Complex:
        """The state at the end of a turn with the momenta of rates of the coordinates."""
        found, none = state.copy(), np.zeros(len(self.fills))
        moved = self._moved(found, self.frozen(found, none))
        self.parts(found)[4][:] = self.whole @ velocity + self._felt(moved)
        return found

    def _moved(self, state: Complex, frozen: Frozen) -> Complex:
        """Velocity of the centres of mass from the axes over R; what pushes both families cancels."""
        lag = self.parts(state)[2].real
        waves, beside = self._waves(state, lag, self._linear(frozen, lag))
        return np.asarray(self.lever * np.conj(waves[:, 0] + beside) + 1j * self.offset(state))

    def _felt(self, moved: Complex) -> Array:
        """Momenta of the coordinates by velocities of the layers over R, standing frame."""
        return np.asarray(self._carried @ moved).real

    def _linear(self, frozen: Frozen, lag: Array) -> tuple[Complex, Complex]:
        """Rate of each mode over itself, without steepening, and of the other family's."""
        n, each = self.numbers, lag[:, None]
        taken = self.decay[:, None] + frozen.diffusion[:, None] * self._squares
        own = 1j * (n * each - (1.0 - each) * self.frequency) - taken
        far = 1j * (lag - (1.0 - lag) * self.far_frequency) - self.far_decay - frozen.diffusion
        return own, far

    def _waves(self, state: Complex, lag: Array, linear: tuple[Complex, Complex]) -> tuple[Complex, Complex]:
        """Rates of the modes and of the other family without a body force."""
        v, other = self.parts(state)[:2]
        modes, m = np.zeros((len(v), self.modes + 1), dtype=complex), self.modes
        modes[:, 1:] = v
        eta = np.fft.irfft(modes, 4 * (m + 1), norm="forward")
        square = np.fft.rfft(eta * eta, norm="forward")[:, 1 : m + 1]
        steep = (-0.5j * self.steepening * (1.0 - lag))[:, None] * self.numbers
        waves = linear[0] * v + steep * square
        # What friction takes from one family it gives the other, the area being kept.
        waves[:, 0] += self.far_decay * other
        return waves, linear[1] * other + self.decay * v[:, 0]

    def rates(self, time: float, state: Complex, frozen: Frozen) -> tuple[Complex, Array]:
        """Rates of a state, and the size of the axes' acceleration over R, shape (l,)."""
        system, turn = self.system, cmath.exp(1j * time)
        v, other, lags, place, momentum = self.parts(state)
        lag, offset = lags.real, self.lever * np.conj(v[:, 0] + other)
        linear = self._linear(frozen, lag)
        own, far = linear[0][:, 0] + self.decay, linear[1] + self.far_decay
        turning = 1.0 - lag
        waves, beside = self._waves(state, lag, linear)
        change = self.lever * np.conj(waves[:, 0] + beside)
        velocity = self._inverse @ (momentum.real - self._felt(turn * (change + 1j * offset)))
        force = (system.unbalance * turn).real - self.damping @ velocity - self._springs @ place.real
        slower = -frozen.wall * lag / self.inertia
        push, bend = 0.5j * self.coupling / turning, 1j * self.steepening
        # The velocity of the centre of mass changes by the modes' rates, the lag, and a body force.
        by_lag = 1j * ((self.frequency[:, 0] + 1.0) * v[:, 0] + (self.far_frequency + 1.0) * other)
        by_lag += bend * np.sum(np.conj(v[:, :-1]) * v[:, 1:], axis=1)
        changed = np.sum(np.conj(waves[:, :-1]) * v[:, 1:] + np.conj(v[:, :-1]) * waves[:, 1:], axis=1)
        still = own * waves[:, 0] - bend * turning * changed + far * beside + by_lag * slower
        ahead = self.lever * np.conj(still) + 2j * change - offset
        weight = turn.conjugate() * self.gravity / self.radius
        pulls = np.concatenate((turn.conjugate() * self.rows, weight[:, None]), axis=1)
        held = -np.imag(np.conj(offset)[:, None] * pulls) / self.inertia[:, None]
        by_pull = ((own - far) * push)[:, None] * np.conj(pulls) + by_lag[:, None] * held
        by_pull -= (bend * turning * v[:, 1] * np.conj(push))[:, None] * pulls
        by_pull = turn * self.lever[:, None] * np.conj(by_pull)
        # A body force less the axes' acceleration, which it changes in turn.
        left = self.whole - (self._carried @ (by_pull[:, :-1] / self.radius[:, None])).real
        right = force - self._felt(turn * ahead + by_pull[:, -1])
        acceleration = self.rows @ _solved(left, right) / self.radius
        pull = weight - turn.conjugate() * acceleration
        waves[:, 0] += push * np.conj(pull)
        beside = beside - push * np.conj(pull)
        slower = slower - np.imag(np.conj(offset) * pull) / self.inertia
        return np.concatenate((waves.ravel(), beside, slower, velocity, force)), np.abs(acceleration)

    def step(self, time: float, state: Complex, frozen: Frozen, length: float) -> tuple[Complex, Array]:
        """A step of Runge and Kutta's in which the linear waves are exact, by Lawson's integrating factor."""
        whole = np.concatenate([part.ravel() for part in self._linear(frozen, frozen.lag)])
        linear = np.concatenate((whole, np.zeros(state.size - whole.size)))
        half = np.exp(0.5 * length * linear)

        def rest(at: float, there: Complex) -> tuple[Complex, Array]:
            rates, size = self.rates(at, there, frozen)
            return rates - linear * there, size

        first, size = rest(time, state)
        second = rest(time + 0.5 * length, half * (state + 0.5 * length * first))[0]
        third = rest(time + 0.5 * length, half * state + 0.5 * length * second)[0]
        last = rest(time + length, half * (half * state + length * third))[0]
        found = half * (half * (state + length / 6.0 * first) + length / 3.0 * (second + third))
        return found + length / 6.0 * last, size

    def rows_of(self, moment: Moment) -> Complex:
        """State at a moment."""
        waves, m = moment.wave, self.modes
        v = waves[:, :m] + 1j * waves[:, m : 2 * m]
        other, lag = waves[:, 2 * m] + 1j * waves[:, 2 * m + 1], waves[:, 2 * m + 2]
        place, rate = moment.coordinates, moment.rate / self.spin
        state = np.concatenate((v.ravel(), other, lag, place, rate)).astype(complex)
        return self.moving(state, rate)

    def moment(self, state: Complex, layers: Flags) -> Moment:
        """A state at the end of a turn, with what is seen of its waves at even angles."""
        v, other, lag, place, _ = self.parts(state)
        frozen = self.frozen(state, np.zeros(len(self.fills)))
        rate = self.spin * self.velocity(0.0, state, frozen)
        area, radius = self.areas(state, 2 * (self.modes + 1)), self.radius[:, None]
        # Liquid that lags by so much everywhere, as the mean rotation of a layer counts it.
        log = -0.5 * np.log1p(-2.0 * np.clip(area, 1e-12, 0.4999))
        velocity = -lag.real[:, None] * np.clip(area, 1e-12, None) / log
        columns = v.real, v.imag, other.real[:, None], other.imag[:, None], lag.real[:, None]
        momentum = radius**4 * self.spin * area * (velocity - area)
        wave = np.concatenate(columns, axis=1)
        return Moment(self.spin, place.real.copy(), rate, radius**2 * area, momentum, layers, wave)


def _solved(left: Array, right: Array) -> Array:
    """Accelerations of the coordinates; nan where waves that run away leave nothing to solve."""
    try:
        return np.asarray(np.linalg.solve(left, right))
    except np.linalg.LinAlgError:
        return np.full(right.shape, np.nan)


def overdamped(machine: HeldMachine, spin: float) -> bool:
    """Whether a wall stops waves within the time of a radian, where the two families know it badly."""
    own = FamilyMachine(machine, spin, riding(machine, spin), 16)
    return bool((np.maximum(own.decay, own.far_decay) > 1.0).any())


def begin(machine: HeldMachine, spin: float, cells: int, motion: Complex, kick: float) -> Moment:
    """Rotor in a synchronous motion with small waves at rest in the drum, and those of gravity in space.

    `motion`: complex amplitudes of the coordinates; `kick`: velocity of the axis beside that, over the
    layers' depth times the spin.
    """
    layers = riding(machine, spin)
    own = FamilyMachine(machine, spin, layers, cells)
    place, rate = motion.real, (1j * motion).real
    turned = 0.5 * (own.rows @ motion) / own.radius
    push = 0.5j * own.coupling
    first, other = np.zeros((2, len(own.fills)), dtype=complex)
    # Body forces that stand in the drum, and that go round against the spin as gravity does.
    for pull, way in ((turned, 0.0), (np.full(turned.shape, own.gravity) / own.radius, 1.0)):
        first += push * np.conj(pull) / (1j * (own.frequency[:, 0] + way))
        other -= push * np.conj(pull) / (1j * (own.far_frequency + way))
    size = 2.0 * np.abs(first) + 2.0 * np.abs(other)
    lower = np.minimum(1.0, 0.8 * own.mean / np.maximum(size, 1e-300))
    wave = np.zeros((len(own.fills), 2 * own.modes + 3))
    wave[:, 0], wave[:, own.modes] = (lower * first).real, (lower * first).imag
    wave[:, -3], wave[:, -2] = (lower * other).real, (lower * other).imag
    if kick:
        for row, fill in zip(own.rows, own.fills, strict=True):
            along = np.linalg.solve(machine.system.mass, row.real)
            rate = rate + kick * fill.depth * along / (row.real @ along)
    none = np.zeros((len(own.fills), cells))
    return _again(own, Moment(spin, place, spin * rate, none, none, layers, wave))


def again(machine: HeldMachine, moment: Moment, cells: int) -> Moment:
    """The moment with another number of modes."""
    own, m = FamilyMachine(machine, moment.spin, moment.layers, cells), (moment.wave.shape[1] - 3) // 2
    wave = np.zeros((len(own.fills), 2 * own.modes + 3))
    kept = min(m, own.modes)
    wave[:, :kept], wave[:, own.modes : own.modes + kept] = (
        moment.wave[:, :kept],
        moment.wave[:, m : m + kept],
    )
    wave[:, -3:] = moment.wave[:, -3:]
    return _again(own, replace(moment, wave=wave))


def _again(own: FamilyMachine, moment: Moment) -> Moment:
    """The moment as its waves show it."""
    return own.moment(own.rows_of(moment), moment.layers)


@dataclass
class _Turning:
    """What a watch may change: areas of one family, the other one with the lag, the rotor."""

    data: Array  #: shape (2l + 2n, c)


def march(
    machine: HeldMachine, moment: Moment, numerics: HoldNumerics, watch: Watch
) -> tuple[Moment, Outcome]:
    """Advance turn by turn until the watch has seen enough, the turns have run out or a wave runs away.

    No works are told: the equation knows none of the momentum and energy that its waves carry, which are of
    second order in their height, so that nothing could be balanced [theory: kdv, eq. 36].
    """
    own = FamilyMachine(machine, moment.spin, moment.layers, numerics.cells)
    state, sizes = own.rows_of(moment), np.zeros(len(own.fills))
    turn, fastest = 2.0 * math.pi / moment.spin, fastest_frequency(machine.system) / moment.spin
    # The acceleration that sets the diffusion is that of the step before.
    sizes = own.rates(0.0, state, own.frozen(state, sizes))[1]
    while watch.count < numerics.turns:
        high = np.abs(own.areas(state, numerics.cells) - own.mean[:, None]).max(axis=1)
        quick = float((own.modes * np.abs(own.steepening) * high).max(initial=fastest))
        steps = max(_FEWEST, math.ceil(2.0 * math.pi * quick / (_COURANT * numerics.courant)))
        steps = _LOOKS * math.ceil(steps / _LOOKS)
        length, rows, looks, before = 2.0 * math.pi / steps, [], [], state
        for k in range(steps):
            frozen = own.frozen(state, sizes)
            with np.errstate(all="ignore"):
                state, sizes = own.step(k * length, state, frozen, length)
            v, _, lag, place, _ = own.parts(state)
            wild = np.abs(v).max(initial=0.0, axis=1) > _HIGHEST * own.mean
            if not np.isfinite(state).all() or wild.any() or (lag.real > 1.0 - _LEAST).any():
                return own.moment(before, moment.layers), Outcome.FAMILY_LOST
            seen = 2.0 * math.pi * own.mean * own.offset(state)
            pairs = np.stack((seen.real, seen.imag), axis=1).ravel()
            rows.append(np.concatenate(([(k + 1) * length, (k + 1) * length], place.real, pairs)))
            if (k + 1) % (steps // _LOOKS) == 0:
                looks.append(own.areas(state, numerics.cells) * np.square(own.radius)[:, None])
        found = np.array(rows)
        found[:, 0] = found[:, 0] / moment.spin + watch.count * turn
        found[:, 1] += 2.0 * math.pi * watch.count
        state, enough = _told(own, state, found, np.array(looks), watch)
        if enough:
            return own.moment(state, moment.layers), Outcome.DONE
    return own.moment(state, moment.layers), Outcome.DONE


def _told(
    own: FamilyMachine, state: Complex, steps: Array, looks: Array, watch: Watch
) -> tuple[Complex, bool]:
    """Hand a turn to the watch, which may change the state at the end; whether it has seen enough."""
    v, other, lag, place, _ = own.parts(state)
    count, m, points = len(v), own.modes, 2 * (own.modes + 1)
    angle = 2.0 * np.pi * np.arange(points) / points
    none = np.zeros((count, 1))
    area = own.mean[:, None] + np.fft.irfft(np.concatenate((none, v), axis=1), points, norm="forward")
    beside = lag.real[:, None] + 2.0 * np.real(other[:, None] * np.exp(1j * angle))
    rate = own.velocity(0.0, state, own.frozen(state, np.zeros(count)))
    uniform = np.concatenate((place.real, rate))
    turning = _Turning(np.concatenate((area, beside, np.tile(uniform[:, None], points))))
    known = turning.data.copy()
    enough = watch.turn(steps, looks, turning)
    if np.array_equal(known, turning.data):
        return state, enough
    n = place.size
    waves, others = (np.fft.rfft(turning.data[k * count : (k + 1) * count], norm="forward") for k in (0, 1))
    found = np.concatenate((waves[:, 1 : m + 1].ravel(), others[:, 1], others[:, 0],
                            turning.data[-2 * n : -n, 0], turning.data[-n:, 0]))  # fmt: skip
    return own.moving(found.astype(np.complex128), turning.data[-n:, 0]), enough
