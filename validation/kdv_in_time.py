"""Rotor and layer in time by KdV-Burgers: what becomes of a kick, and of an unbalance beside it.

The equations of limit cycles by KdV-Burgers [theory: kdv, eq. 34-36, 40] as they stand, not about a cycle,
for a planar rotor with one layer and linear friction. They are followed in a frame that turns about as the
whirl does, in which all is slow. Lengths over R, times over 1/Omega.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.integrate import solve_ivp

from fluid import kdv
from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott

_LAST = 0.25  # of the time, over which the motion is taken apart
_SAMPLES = 4000
_STEP = 1e-6  # of the time, in the derivative of the centre of mass' velocity
_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Motion:
    """What a rotor with its layer has come to."""

    whirl: float  #: amplitude of the self-excited part, m
    whirl_speed: float  #: of it in space, rad/s
    synchronous: float  #: amplitude of the part that goes with the spin, m
    lag: float  #: of the liquid, rad/s
    spread: float  #: largest less least amplitude of the self-excited part over its mean


@dataclass(frozen=True)
class InWhirl:
    """Equations in the turning frame."""

    near: kdv.KdvCoefficients
    far: kdv.KdvCoefficients
    modes: int
    rate: float  #: k of the waves, over the spin
    diffusion: float  #: nu_b, over the spin
    frame: float  #: speed of the frame in space, over the spin
    share: float  #: liquid over rotor and liquid
    damping: float  #: c and k of the support over the mass of rotor and liquid, and the spin
    stiffness: float
    unbalance: float  #: over that mass and R

    @cached_property
    def _numbers(self) -> Array:
        """Of the modes."""
        return np.arange(1.0, self.modes + 1.0)

    @cached_property
    def _constants(self) -> tuple[Array, Array, float, float]:
        """Frequencies of the modes and what takes of them, and both of the other family."""
        n = self._numbers
        decay, far = (self.diffusion + float(kdv.decay(c, self.rate)) for c in (self.near, self.far))
        taken = decay + self.diffusion * (np.square(n) - 1.0)
        return (
            kdv.wave_frequency(n, self.near, False),
            taken,
            float(kdv.wave_frequency(1, self.far, False)),
            far,
        )

    def _waves(self, v: Complex, other: complex, lag: float) -> tuple[Complex, complex]:
        """Rates of the modes and of the other family without the axis' acceleration."""
        turning, n, (omega, taken, own, far) = 1.0 - lag, self._numbers, self._constants
        carried = turning - self.frame
        eta = np.fft.irfft(np.concatenate(([0.0], v)), 4 * (self.modes + 1), norm="forward")
        square = np.fft.rfft(np.square(eta), norm="forward")[1 : self.modes + 1]
        rates = -(1j * (turning * omega + n * carried) + taken) * v
        rates -= 0.5j * self.near.steepening * turning * n * square
        return rates, -(1j * (turning * own + carried) + far) * other

    def _moved(self, v: Complex, other: complex, lag: float) -> complex:
        """Velocity of the centre of mass from the axis in space; what pushes both families cancels."""
        turning, (omega, taken, own, far) = 1.0 - lag, self._constants
        carried = turning - self.frame
        square = 2.0 * complex(np.vdot(v[:-1], v[1:]))  # mode 1 of the square
        near = -(1j * (turning * omega[0] + carried) + taken[0]) * v[0]
        near -= 0.5j * self.near.steepening * turning * square
        change = near - (1j * (turning * own + carried) + far) * other
        place = complex(v[0] + other).conjugate()
        ahead = complex(change).conjugate() + 1j * self.frame * place
        return self.near.surface_radius / self.near.mean_area * ahead

    def rates(self, time: float, state: Complex) -> Complex:
        """State: modes, the other family's first one, lag, deflection, momentum over the whole mass."""
        v, (other, lag, place, momentum) = state[: self.modes], state[self.modes :].tolist()
        lag = lag.real
        still = self._moved(v, other, lag)
        velocity = momentum - self.share * still
        force = -self.damping * velocity - self.stiffness * place
        force += self.unbalance * np.exp(1j * (1.0 - self.frame) * time)
        waves, far = self._waves(v, other, lag)
        push = 0.5j * self.near.coupling / (1.0 - lag)
        offset = self.near.surface_radius / self.near.mean_area * complex(v[0] + other).conjugate()
        wall = self.rate * self.near.surface_radius * lag
        inertia = 0.5 * (1.0 + self.near.surface_radius**2)

        def all_with(pull: complex) -> tuple[Complex, complex, float]:
            """Rates of waves and lag under a body force on the liquid."""
            ahead = waves.copy()
            ahead[0] += push * pull.conjugate()
            slower = -(wall + (offset.conjugate() * pull).imag) / inertia
            return ahead, far - push * pull.conjugate(), slower

        def acceleration(pull: complex) -> complex:
            """Of the axis, where the liquid feels such a force."""
            ahead, beside, slower = all_with(pull)
            there = self._moved(v + _STEP * ahead, other + _STEP * beside, lag + _STEP * slower)
            change = (there - still) / _STEP + 1j * self.frame * still
            return complex(force - self.share * change)

        # Real and linear in the pull, which is less the acceleration.
        none, one, ahead = (acceleration(pull) for pull in (0j, 1.0 + 0j, 1j))
        by = np.array([[(one - none).real, (ahead - none).real], [(one - none).imag, (ahead - none).imag]])
        x, y = np.linalg.solve(np.eye(2) + by, [-none.real, -none.imag])
        found, beside, slower = all_with(complex(x, y))
        turn = 1j * self.frame
        return np.array([*found, beside, slower, velocity - turn * place, force - turn * momentum])


def in_whirl(
    rotor: Jeffcott, fill: Fill, spin: float, friction: Friction, size: float, modes: int, whirl_speed: float
) -> InWhirl:
    """Equations in the frame of a whirl, rad/s, whose size, m, sets the diffusion."""
    if friction.law != "linear":
        raise InputError("friction", friction.law, "linear")
    radius, whole = fill.chamber.radius, rotor.mass + fill.mass
    near, far = (kdv.coefficients(1.0, 1.0 - fill.depth / radius, 1.0, sign) for sign in (-1, 1))
    frame = whirl_speed / spin
    pull = frame**2 * size / radius
    return InWhirl(
        near, far, modes,
        friction.coefficient / spin * (fill.depth / radius) / near.mean_area,
        float(kdv.diffusion(near, kdv.forcing(near, pull))),
        frame, fill.mass / whole, rotor.damping / whole / spin, rotor.stiffness / whole / spin**2,
        rotor.unbalance / whole / radius,
    )  # fmt: skip


def kdv_in_time(
    rotor: Jeffcott,
    fill: Fill,
    spin: float,
    friction: Friction,
    kick: float,
    turns: float = 100.0,
    modes: int = 31,
    whirl_speed: float | None = None,
) -> Motion:
    """Let go a rotor at constant spin, rad/s, from a deflection, m, in a whirl; its unbalance acts.

    `turns` of the spin are followed; `whirl_speed`, rad/s: about that of the whirl [default: full chambers'].
    """
    radius, around = fill.chamber.radius, whirl_speed
    if around is None:
        around = math.sqrt(rotor.stiffness / (rotor.mass + fill.full_mass))
    frame, model = around / spin, in_whirl(rotor, fill, spin, friction, kick, modes, around)
    start = np.zeros(modes + 4, dtype=complex)
    start[-2], start[-1] = kick / radius, 1j * frame * kick / radius
    stop = 2.0 * math.pi * turns
    done = solve_ivp(
        model.rates, (0.0, stop), start, "RK45",
        t_eval=np.linspace((1.0 - _LAST) * stop, stop, _SAMPLES), rtol=_TOLERANCE, atol=1e-9,
    )  # fmt: skip
    return _apart(done.t, radius * done.y[-2], spin * done.y[-3].real, frame, spin)


def _apart(time: Array, place: Complex, lag: Array, frame: float, spin: float) -> Motion:
    """Self-excited and synchronous parts of a motion in the turning frame."""
    window = np.hanning(time.size)
    own, moved = np.exp(-1j * (1.0 - frame) * time), place
    synchronous = 0j
    for _ in range(8):
        rest = place - synchronous / own
        phase = np.unwrap(np.angle(rest))
        speed = float(np.polyfit(time, phase, 1)[0])
        whirl = complex((window * rest * np.exp(-1j * speed * time)).sum() / window.sum())
        synchronous = complex(
            (window * (moved - whirl * np.exp(1j * speed * time)) * own).sum() / window.sum()
        )
    rest = np.abs(place - synchronous / own)
    return Motion(
        abs(whirl), (frame + speed) * spin, abs(synchronous), float((window * lag).sum() / window.sum()),
        float(np.ptp(rest) / rest.mean()),
    )  # fmt: skip
