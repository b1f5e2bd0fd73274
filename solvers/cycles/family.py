"""Limit cycles by KdV-Burgers: a layer's waves as Fourier modes, in place of the finite volumes of `wave`.

The family against the spin steepens, disperses, diffuses and rubs; the other answers linearly. Both ride on
liquid that turns more slowly than the drum, by a lag that the whirl's torque and the wall's drag settle.
Lengths over R, times over 1/Omega [theory: kdv, eq. 34-40].
"""

from __future__ import annotations

import cmath
import functools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw, damping_rate
from fluid.friction.wall import lag_drag
from meshes.arrays import Array, Complex
from solvers.cycles.balance import Circular
from solvers.cycles.branch import Cycle, MakeWave
from solvers.cycles.wave import Answer, Derivatives, LayerWave, Whirling
from solvers.waves.modes import System, WaveProblem, joined, resized, split, values
from solvers.waves.newton import TOLERANCE
from solvers.waves.steady import solve

_MOST_POINTS = 1024  # of a first wave, whose modes beyond the layer's are left
_STEP = 1e-7  # relative, in differences by the lag and by what drives the layer
_LEAST = 1e-7  # of the radius, of the spin: smaller deflections and lags are answered as this one
_ROUNDS = 2  # for what friction gives a wave from the other family
_HIGHEST = 30.0  # of the mean area: modes that no wave has
_WILD = 0.1  # over the spin: disturbances that grow faster are none of the whirl, see `floquet`


@dataclass(frozen=True)
class _Posed:
    """Equations of both families at a state."""

    system: System  #: of the family against the spin
    speed: float  #: of the whirl, seen from the liquid, as the system takes it
    scale: float  #: of its modes, over R^2
    first: complex  #: mode 1 of both families together, over R^2
    other: complex  #: mode 1 of the other family over R^2, its rate in the whirl's frame, what friction takes
    other_rate: complex
    other_decay: float
    push: complex  #: rate of mode 1 by a force's conjugate; the other family's is less it

    @property
    def answers(self) -> complex:
        """Mode 1 of the other family over that of this one: friction gives it what it takes from this one."""
        return -self.system.problem.decay / self.other_rate

    def left(self, state: Array) -> Array:
        """What the modes leave of their equations [theory: kdv, eq. 19 and 35]."""
        found = self.system.residual(state[:-1] / self.scale, self.speed)
        given = 1j * self.other_decay * self.other / (self.system.scale * self.scale)
        found[[0, self.system.modes]] += given.real, given.imag
        return found

    def slope(self, state: Array) -> Array:
        """Derivative of what is left with respect to the modes over their scale."""
        m = self.system.modes
        found = self.system.jacobian(state[:-1] / self.scale, self.speed, m)
        given = 1j * self.other_decay * self.answers / self.system.scale
        found[np.ix_([0, m], [0, m])] += _real(np.array([[given]]))
        return found


class FamilyWave(LayerWave):
    """A layer as steady waves of KdV-Burgers on so many points, with their lag.

    The state has real and imaginary parts of the modes of A - A0, over R^2, and the lag over the spin, times
    the mean area.
    """

    def __init__(self, fill: Fill, friction: Friction, cells: int, front: float = kdv.FRONT) -> None:
        kdv.refuse_quadratic(friction, "friction")
        super().__init__(fill, friction, cells)
        self.front, self.modes = front, cells // 2 - 1
        surface = 1.0 - fill.depth / fill.chamber.radius
        self.near, self._far = (kdv.coefficients(1.0, surface, 1.0, sign) for sign in (-1, 1))
        self.mean = self.near.mean_area
        self.state = np.zeros(2 * self.modes + 1)

    def lag(self, share: float) -> None:
        """See `LayerWave`."""
        self.state = np.append(np.zeros(2 * self.modes), share * self.mean)

    def thinnest(self, state: Array) -> float:
        """See `LayerWave`; below 0 where the equation leaves less than nothing on the wall."""
        eta = values(joined(state[:-1]), 4 * (self.modes + 1))
        return 1.0 + float(eta.min()) / self.mean

    def kept(self, state: Array) -> Array:
        """See `LayerWave`: the mean of every wave is 0."""
        return state

    def closed(self, step: Array) -> Array:
        """See `LayerWave`: every equation says something."""
        return np.asarray(step - np.eye(len(step)))

    def period(self, given: Whirling) -> Answer | None:
        """See `LayerWave`; at once to the steady wave on liquid with the present lag."""
        posed = self.posed(self.state, given)
        if posed is None:
            return None
        system = posed.system
        wave = solve(system.problem, posed.speed * system.scale, points=self.cells, most_points=_MOST_POINTS)
        if wave.residual > TOLERANCE:
            return None
        self.state = np.append(resized(split(wave.modes), self.modes), self.state[-1])
        # The wave rubs alone; what friction gives it from the other family is little.
        for _ in range(_ROUNDS):
            posed = self.posed(self.state, given)
            if posed is None:
                return None
            step = np.linalg.solve(posed.slope(self.state), posed.left(self.state))
            self.state[:-1] -= posed.scale * step
        return self.cell(self.state, given)

    def cell(self, state: Array, given: Whirling) -> Answer | None:
        """See `LayerWave`: the state less what it leaves of its equations [theory: kdv, eq. 35-37]."""
        posed = self.posed(state, given)
        if posed is None:
            return None
        if not float(np.abs(state).max()) < _HIGHEST * self.mean:
            return None
        left = posed.left(state)
        force, lag = self._force(posed.first, given), float(state[-1]) / self.mean
        held = lag - self._fed(given, force) / self._rate(given, lag)
        gap = np.append(left * self._unit(posed) * posed.scale, held * self.mean)
        return Answer(state - gap, force, -lag)

    def linearise(self, given: Whirling) -> Derivatives | None:
        """See `LayerWave`; exact by the modes."""
        state, base = self.state, self.cell(self.state, given)
        posed = self.posed(state, given)
        if posed is None or base is None:
            return None
        later, further = state.copy(), _STEP * self.mean
        later[-1] += further
        tries = [(later, given)]
        tries += [(state, given._replace(**{name: v * (1.0 + _STEP)})) for name, v in given._asdict().items()]
        ends = [self.cell(*tried) for tried in tries]
        steps = np.array([further, *(_STEP * value for value in given)])
        if any(end is None for end in ends):
            return None
        columns = np.array([end.state - base.state for end in ends if end]).T / steps
        forces = np.array([end.force - base.force for end in ends if end]) / steps
        force = np.zeros(state.size, dtype=complex)
        force[[0, self.modes]] = self._force(1.0 + posed.answers, given) - self._force(0.0, given), 0.0
        force[self.modes] = -1j * force[0]
        force[-1] = forces[0]
        by_state = np.eye(state.size)
        by_state[:-1, :-1] -= posed.slope(state) * self._unit(posed)
        by_state[-1] = self._fed(given, force) * (self.mean / self._rate(given, base.turning))
        by_state[:, -1] = columns[:, 0]
        return Derivatives(by_state, columns[:, 1:], force, forces[1:])

    def posed(self, state: Array, given: Whirling) -> _Posed | None:
        """Equations at a state; None where the liquid would stand still in space."""
        turning = 1.0 - float(state[-1]) / self.mean
        if not turning > _LEAST:
            return None
        near, far, rubbed = self.near, self._far, self._wave_rate(given)
        slip, acceleration = given.ratio - turning, given.ratio**2 * max(given.size, _LEAST)
        q = float(kdv.forcing(near, acceleration)) / turning
        problem = WaveProblem(
            functools.partial(_frequency, near, turning),
            near.steepening * turning,
            q,
            float(kdv.decay(near, rubbed)),
            # The spin is gone from it.
            float(kdv.diffusion(near, q * turning, self.front)),
        )
        system = System(problem, self.modes)
        other_decay = float(kdv.decay(far, rubbed))
        rate = -1j * (float(_frequency(far, turning, np.array(1.0))) - slip) - problem.diffusion - other_decay
        push, first = 0.5j * q / acceleration, complex(state[0], state[self.modes])
        other = (push * acceleration - problem.decay * first) / rate
        return _Posed(
            system,
            slip / system.scale,
            system.scale / problem.steepening,
            first + other,
            other,
            rate,
            other_decay,
            push,
        )

    def rates(self, state: Array, given: Whirling) -> tuple[Array, Array, Array]:
        """A layer's disturbances in the whirl's frame: rates, push and offset [theory: kdv, eq. 40].

        Unknown are the state, then real and imaginary part of the other family's first mode, k of them: their
        rates of change by themselves, shape (k, k), and by a body force along the deflection and ahead of
        it, shape (k, 2); and the offset of the centre of mass over R, shape (2, k).
        """
        posed = self.posed(state, given)
        assert posed is not None
        m, near = self.modes, self.near
        count = 2 * m + 3
        rates, push, offset = np.zeros((count, count)), np.zeros((count, 2)), np.zeros((2, count))
        others = slice(count - 2, count)
        n = np.arange(1.0, m + 1.0)[:, None]

        def left(at: Array) -> Array:
            """-i n times the equations, of the modes and of the other family, with the force held."""
            there = self.posed(at, given)
            assert there is not None
            system = there.system
            both = system.residual(at[:-1] / there.scale, there.speed) * system.scale * there.scale
            mode = -1j * n[:, 0] * joined(both)
            other = there.other_rate * (posed.other - there.other)
            return np.concatenate([mode.real, mode.imag, [other.real, other.imag]])

        exact = posed.system.jacobian(state[:-1] / posed.scale, posed.speed, m) * posed.system.scale
        rates[:m, : 2 * m], rates[m : 2 * m, : 2 * m] = n * exact[m:], -n * exact[:m]
        later, further = state.copy(), _STEP * self.mean
        later[-1] += further
        change = (left(later) - left(state)) / further
        rates[[*range(2 * m), count - 2, count - 1], 2 * m] = change
        rates[others, others] = _real(np.array([[posed.other_rate]]))
        # What friction takes from one family it gives the other.
        rates[others, [0, m]] = posed.system.problem.decay * np.eye(2)
        rates[[0, m], others] = posed.other_decay * np.eye(2)
        # Of a force f the first mode of e^{i xi} is pushed by the conjugate.
        way = _real(np.array([[posed.push]])) @ np.diag([1.0, -1.0])
        push[[0, m]], push[others] = way, -way
        lever = near.surface_radius / self.mean * np.diag([1.0, -1.0])
        offset[:, [0, m]], offset[:, others] = lever, lever
        # The lag by the torques of the wall and of the force on the centre of mass.
        force = given.ratio**2 * given.size
        centre = near.surface_radius / self.mean * complex(posed.first).conjugate()
        inertia = 0.5 * (1.0 + near.surface_radius**2)
        lag = float(state[-1]) / self.mean
        slope = (self._rate(given, lag * (1.0 + _STEP)) * (1.0 + _STEP) - self._rate(given, lag)) / _STEP
        rates[2 * m, 2 * m] = -slope / inertia
        rates[2 * m] += offset[1] * (force * self.mean / inertia)
        push[2 * m] = np.array([-centre.imag, centre.real]) * (-self.mean / inertia)
        return rates, push, offset

    def _rate(self, given: Whirling, lag: float) -> float:
        """Torque of the wall over the lag."""
        behind = max(abs(lag), _LEAST)
        slip = abs(given.ratio - 1.0)
        if self.friction.law is FrictionLaw.WALL:
            spin = 1.0 / given.drag
            found = lag_drag(self.fill, self.friction, behind * spin, spin, slip * spin)
            return found * given.drag**2 / behind
        # One law for a lag and for waves, whose rate the long waves take for the surface's velocity.
        return self._wave_rate(given) * self.near.surface_radius

    def _wave_rate(self, given: Whirling) -> float:
        """Rate at which the wall stops waves, over the spin [theory: long_wave, eq. 9]."""
        radius, slip, drag = self.fill.chamber.radius, given.ratio - 1.0, given.drag
        if self.friction.law is FrictionLaw.WALL:
            drag *= self.friction.at(self.fill.liquid.viscosity, slip / given.drag, radius)[1]
        lid = self.friction.lid(radius, self.fill.chamber.height, slip, 1.0)
        depth = self.fill.depth / radius
        return float(damping_rate(self.friction.law.number, drag, lid, depth, self.mean, 0.0))

    def _unit(self, posed: _Posed) -> float:
        """Weight of the waves' equations beside that of the lag: over the speed of long waves."""
        return posed.system.scale / abs(self.near.linear_speed)

    def _force(self, first: complex, given: Whirling) -> complex:
        """G by the momentum of the liquid [theory: kdv, eq. 16], of a first mode over R^2."""
        offset = self.near.surface_radius / self.mean * complex(first).conjugate()
        return 2.0 * self.mean * (1.0 + offset / max(given.size, _LEAST))

    def _fed(self, given: Whirling, force: Any) -> Any:
        """Torque by which the whirl holds the liquid back, over m R^2 Omega^2 [theory: kdv, eq. 37]."""
        return (given.ratio * given.size) ** 2 / (2.0 * self.mean) * np.imag(force)


def family_wave(front: float = kdv.FRONT) -> MakeWave:
    """What makes layers of KdV-Burgers with fronts so wide beside the depth."""
    return functools.partial(FamilyWave, front=front)


def family_growth(machine: Circular, waves: Sequence[FamilyWave], cycle: Cycle) -> float:
    """Growth rate of the disturbance of a limit cycle that grows most, 1/s.

    A turn of the whole whirl does not count as one.
    """
    rates = disturbances(machine, waves, cycle)
    growth = np.delete(rates, np.argmin(np.abs(rates))).real
    return float(growth[growth < _WILD * cycle.spin].max())


def disturbances(machine: Circular, waves: Sequence[FamilyWave], cycle: Cycle) -> Complex:
    """Rates of all small disturbances of a limit cycle in the whirl's frame, 1/s [theory: kdv, eq. 40].

    Of the modes and the lag of each layer, then place and velocity of the rotor.
    """
    count = sum(wave.state.size + 2 for wave in waves)
    ratio, p = cycle.whirl_speed / cycle.spin, cycle.moved.size
    size = count + 4 * p
    step, held = np.zeros((size, size)), np.eye(size)
    place, moving = slice(count, count + 2 * p), slice(count + 2 * p, size)
    turn, around = (_real(1j * ratio * np.eye(n, dtype=np.complex128)) for n in (p, 1))
    step[place, place], step[place, moving] = -turn, np.eye(2 * p)
    step[moving, place] = -_real(machine.stiffness / cycle.spin**2)
    step[moving, moving] = -_real((machine.damping + cycle.spin * machine.gyroscopic) / cycle.spin)
    mass = machine.mass.astype(complex)
    first, momenta = 0, np.zeros((2 * p, size))
    for wave, drive, state, layer in zip(waves, cycle.given, cycle.state, machine.places, strict=True):
        own = slice(first, first + wave.state.size + 2)
        rates, push, offset = wave.rates(state, drive)
        row = layer.row * cmath.exp(-1j * cmath.phase(complex(layer.row @ cycle.moved)))
        row = row[None] / layer.fill.chamber.radius
        felt = push @ _real(-row)
        step[own, own], held[own, moving] = rates, -felt
        step[own, moving] += felt @ turn
        carried = _real(layer.mass * layer.fill.chamber.radius**2 * row.conj().T)
        # The velocity of the liquid's centre of mass; the families' pushes on it cancel.
        momenta[:, own] += carried @ (offset @ rates + around @ offset)
        mass = mass + layer.mass * layer.fill.chamber.radius**2 * row.conj().T @ row
        first = own.stop
    held[moving, moving] = _real(mass)
    held[moving] += momenta
    step[moving] -= turn @ momenta
    step[moving, moving] -= turn @ _real(mass)
    return np.asarray(np.linalg.eigvals(np.linalg.solve(held, step)) * cycle.spin)


def _real(matrix: Complex) -> Array:
    """A complex matrix over real and imaginary parts: all real parts first, shape (2 a, 2 b)."""
    return np.block([[matrix.real, -matrix.imag], [matrix.imag, matrix.real]])


def _frequency(c: kdv.KdvCoefficients, turning: float, mode: Array) -> Array:
    return turning * kdv.wave_frequency(mode, c, whitham=False)
