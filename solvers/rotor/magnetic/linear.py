"""The closed loop about the centre: poles, margins, sensitivity, answers to unbalance and loads."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.magnetic.control import Controller
from solvers.rotor.magnetic.machine import MagneticRotor

_FREQUENCIES = np.geomspace(1e-2, 1e9, 1101)  # rad/s: 100 a decade
_FACTORS = np.geomspace(1.0, 1e4, 161)  # of the loop gain


@dataclass(frozen=True)
class Loop:
    """Linear closed loop at one speed, s' = (A - B K) s + load [theory: magnetic, eq. 19].

    s: the four coordinates, their rates, the controller's state and, where coils take time, the four
    currents.
    """

    speed: float  #: Omega, rad/s
    free: Array  #: A, without what the controller wants, shape (p, p)
    drive: Array  #: B, by a unit of wanted currents, shape (p, 4)
    feedback: Array  #: K, so that the wanted currents are -K s, shape (4, p)
    machine: MagneticRotor  #: the rotor

    def closed(self, factor: complex = 1.0) -> Complex:
        """Matrix of the closed loop, its gain times a factor, shape (p, p)."""
        return np.asarray(self.free - factor * (self.drive @ self.feedback), dtype=np.complex128)

    @property
    def poles(self) -> Complex:
        """Eigenvalues of the closed loop, the slowest first, 1/s, shape (p,)."""
        found = np.linalg.eigvals(self.closed().real)
        # Poles of x and y are equal but for rounding, which must not decide on their order.
        size = np.maximum(np.abs(found.real), 1e-12 * np.abs(found).max() + 1e-30)
        digits = 10.0 ** (8.0 - np.floor(np.log10(size)))
        decay = np.round(found.real * digits) / digits
        return np.asarray(found[np.lexsort((found.imag, -decay))], dtype=np.complex128)

    @property
    def stable(self) -> bool:
        """All poles have negative real parts."""
        return bool(self.poles.real.max() < 0.0)

    def transfer(self, frequency: ArrayLike) -> Complex:
        """Loop transfer L, from wanted currents round to wanted currents, shape (..., 4, 4).

        With the sign of feedback, at frequencies in rad/s.
        """
        w = np.asarray(frequency, dtype=float)[..., None, None]
        unit = np.eye(self.free.shape[0])
        answer = np.linalg.solve(
            1j * w * unit - self.free, np.broadcast_to(self.drive, (*w.shape[:-2], *self.drive.shape))
        )
        return np.asarray(self.feedback @ answer)

    def answer(self, load: ArrayLike, frequency: float) -> tuple[Complex, Complex]:
        """Steady motion under a turning or swinging load Re(load e^{i w t}) [theory: magnetic, eq. 22].

        Complex amplitudes of the bearings' displacements, m, and of the wanted currents, A, shape (4,) each;
        load in N and N m, frequency w in rad/s, 0 for a constant load.
        """
        size = self.free.shape[0]
        right = np.zeros(size, dtype=np.complex128)
        right[4:8] = np.asarray(load) / self.machine.inertia
        state = np.linalg.solve(1j * frequency * np.eye(size) - self.closed(), right)
        return self.machine.bearing_motion @ state[:4], -self.feedback @ state

    def unbalance(self) -> tuple[Complex, Complex]:
        """`answer` to the unbalances at the loop's speed."""
        force, couple = self.machine.unbalance * self.speed**2
        return self.answer(np.array([force, -1j * force, couple, -1j * couple]), self.speed)

    def step(self, load: ArrayLike, time: ArrayLike) -> tuple[Array, Array]:
        """Motion after a constant load comes on a rotor at rest, linear [theory: magnetic, eq. 23].

        Displacements in the bearings, m, and wanted currents, A, shape (n, 4) each; load in N and N m.
        """
        from scipy.linalg import expm

        size = self.free.shape[0]
        wide = np.zeros((size + 1, size + 1))
        wide[:size, :size] = self.closed().real
        wide[4:8, size] = np.asarray(load, dtype=float) / self.machine.inertia
        states = np.array([expm(wide * t)[:size, size] for t in np.asarray(time, dtype=float).reshape(-1)])
        return states[:, :4] @ self.machine.bearing_motion.T, -states @ self.feedback.T


def closed_loop(machine: MagneticRotor, controller: Controller, speed: float) -> Loop:
    """Loop of a rotor and a controller, which may know another rotor [theory: magnetic, eq. 17 and 19]."""
    if not (math.isfinite(speed) and speed >= 0.0):
        raise InputError("speed", speed, "a finite number, 0 or above")
    gains, magnets, k = controller.gains(speed), machine.magnets, controller.states
    coils = 0 if magnets.bandwidth is None else 4
    size = 8 + k + coils
    spread, per_mass = machine.bearing_motion.T, 1.0 / machine.inertia[:, None]
    free, drive, feedback = np.zeros((size, size)), np.zeros((size, 4)), np.zeros((4, size))
    free[:4, 4:8] = np.eye(4)
    pull = machine.motor_pull + magnets.position_stiffness * spread @ machine.bearing_motion
    free[4:8, :4] = per_mass * (pull - speed * machine.circulation)
    free[4:8, 4:8] = -per_mass * (machine.damping + speed * machine.gyroscopic)
    free[8 : 8 + k, :4], free[8 : 8 + k, 8 : 8 + k] = gains.from_place, gains.from_memory
    push = per_mass * magnets.current_stiffness * spread
    if magnets.bandwidth is None:
        drive[4:8] = push
    else:
        free[4:8, 8 + k :] = push
        free[8 + k :, 8 + k :] = -magnets.bandwidth * np.eye(4)
        drive[8 + k :] = magnets.bandwidth * np.eye(4)
    feedback[:, :4], feedback[:, 4:8], feedback[:, 8 : 8 + k] = gains.place, gains.rate, gains.memory
    return Loop(speed, free, drive, feedback, machine)


@dataclass(frozen=True)
class Margins:
    """How far a stable loop is from instability, all four currents alike [theory: magnetic, eq. 20-21]."""

    gain_up: float  #: largest factor of the loop gain, inf if none harms up to 10^4
    gain_down: float  #: smallest factor, 0 if none harms down to 10^-4
    phase: float  #: largest lag or lead at every frequency, rad
    delay: float  #: largest delay, s
    sensitivity: float  #: largest singular value of (1 + L)^-1 over frequency
    worst: float  #: frequency of that, rad/s


def margins(loop: Loop) -> Margins:
    """Gain, phase and delay margin and the largest sensitivity of a stable loop; nan of one that is not."""
    if not loop.stable:
        return Margins(*(math.nan,) * 6)
    phase, delay = _phase_and_delay(loop)
    sensitivity, worst = _sensitivity(loop)
    up, down = _gain(loop, _FACTORS), _gain(loop, 1.0 / _FACTORS)
    return Margins(
        math.inf if up is None else up, 0.0 if down is None else down, phase, delay, sensitivity, worst
    )


def _gain(loop: Loop, factors: Array) -> float | None:
    """First factor of a row that begins at 1 with which the loop is not stable."""
    from scipy.optimize import brentq

    def slowest(factor: float) -> float:
        return float(np.linalg.eigvals(loop.closed(factor)).real.max())

    before = float(factors[0])
    for factor in factors[1:].tolist():
        if slowest(factor) >= 0.0:
            return float(brentq(slowest, before, factor, xtol=1e-12, rtol=1e-10))
        before = factor
    return None


def _phase_and_delay(loop: Loop) -> tuple[float, float]:
    """Margins at the frequencies where an eigenvalue of L has the size 1; inf where there is none."""
    from scipy.optimize import brentq

    def loci(frequency: float) -> Complex:
        found = np.linalg.eigvals(loop.transfer(frequency))
        return np.asarray(found[np.argsort(np.abs(found))])

    def size(frequency: float, k: int) -> float:
        return float(np.log(np.abs(loci(frequency)[k])))

    # Sizes in order are continuous, so that each crossing of 1 lies between two frequencies of the grid.
    sizes = np.log(np.sort(np.abs(np.linalg.eigvals(loop.transfer(_FREQUENCIES))), axis=-1))
    phase = delay = math.inf
    for n, k in np.argwhere((sizes[:-1] > 0.0) != (sizes[1:] > 0.0)):
        low, high = _FREQUENCIES[n], _FREQUENCIES[n + 1]
        at = float(brentq(size, low, high, args=(int(k),), rtol=1e-12))
        near = loci(at)
        for value in near[np.abs(np.abs(near) - 1.0) < 1e-6]:
            lag = float(np.angle(-value))
            phase = min(phase, abs(lag))
            delay = min(delay, (lag % (2.0 * math.pi)) / at)
    return phase, delay


def _sensitivity(loop: Loop) -> tuple[float, float]:
    """Largest singular value of (1 + L)^-1 over frequency, and where."""
    from scipy.optimize import minimize_scalar

    def size(frequency: ArrayLike) -> Array:
        return np.asarray(
            1.0 / np.linalg.svd(np.eye(4) + loop.transfer(frequency), compute_uv=False)[..., -1]
        )

    sizes = size(_FREQUENCIES)
    n = int(np.clip(sizes.argmax(), 1, sizes.size - 2))
    bounds = np.log(_FREQUENCIES[[n - 1, n + 1]])
    best = minimize_scalar(lambda x: -float(size(math.exp(x))), bounds=tuple(bounds), method="bounded")
    return max(float(-best.fun), float(sizes.max())), math.exp(best.x)


def orbit_size(amplitude: ArrayLike) -> Array:
    """Largest distance from the centre in each bearing, m, shape (..., 2).

    From complex amplitudes along first x, first y, second x, second y, shape (..., 4).
    """
    x, y = np.asarray(amplitude)[..., 0::2], np.asarray(amplitude)[..., 1::2]
    return np.asarray(0.5 * (np.abs(x + 1j * y) + np.abs(x - 1j * y)))
