"""The dual-frequency exciter: balls in a race on a shaft shake a platform; where they can stick."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass
from itertools import pairwise
from typing import Annotated

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from meshes.quantity import Q
from solvers.roots import bracketed_root
from solvers.rotor.system import RotorSystem

# Rolling inertia over that of the sliding mass, m R^2 [YF17, eq. 7].
ROLLING = {"ball": 7.0 / 5.0, "roller": 3.0 / 2.0}


def rolling_inertia(kind: str, mass: float = 1.0, radius: float = 1.0, own_inertia: float = 0.0) -> float:
    """Inertia of a load on its way around the track, over m R^2 [theory: balls, eq. 2] [YF17, eq. 7].

    kappa: 7/5, 3/2 or 1 + J/(m R^2) of a `ball`, `roller` or `pendulum`, J about its own centre of mass.
    """
    if kind in ROLLING:
        return ROLLING[kind]
    if kind != "pendulum":
        raise InputError("kind", kind, "ball, roller or pendulum")
    require_positive("mass", mass)
    require_positive("radius", radius)
    require_not_negative("own_inertia", own_inertia)
    return 1.0 + own_inertia / (mass * radius**2)


@dataclass(frozen=True)
class Dimensionless:
    """The machine in its own units: 1/(natural frequency) and N m R/(whole mass) [theory: balls, eq. 5]."""

    #: eps = N m/(kappa M), share of the balls in the whole mass over their rolling inertia
    smallness: Annotated[float, Q("1", "smallness", "share of the balls in the mass over their inertia")]
    #: b, over the smallness and the natural frequency
    drag: Annotated[float, Q("1", "drag", "of the balls")]
    #: delta
    unbalance: Annotated[float, Q("1", "unbalance", "of the shaft over that of all balls together")]
    #: h
    damping: Annotated[float, Q("1", "damping", "ratio of the platform")]
    #: sigma
    gravity: Annotated[float, Q("1", "gravity", "static deflection over the unit of length")] = 0.0
    #: alpha
    incline: Annotated[float, Q("1", "incline", "of the platform's line to the vertical, rad")] = 0.0

    def __post_init__(self) -> None:
        if not 0.0 < self.smallness < 1.0:
            raise InputError("smallness", self.smallness, "between 0 and 1")
        for name in ("drag", "unbalance", "damping", "gravity"):
            require_not_negative(name, getattr(self, name))
        if not math.isfinite(self.incline):
            raise InputError("incline", self.incline, "a finite angle, rad")

    def numbers(self, speed: float) -> Array:
        """What `rates` takes: (eps, b, delta, h, sigma, alpha, n), shape (7,)."""
        return np.array([*astuple(self), speed])


@dataclass(frozen=True)
class Exciter:
    """A platform on springs, a shaft with an unbalance on it, balls free in a race around the shaft."""

    #: of all that moves with the platform, its load and the unbalance too, without the balls, kg
    platform_mass: float
    stiffness: float  #: of the supports k, N/m
    damping: float  #: of the supports, N s/m
    unbalance: float  #: mu P of the shaft, kg m
    ball_count: int  #: N, 1 or more
    ball_mass: float  #: m of one, kg
    rolling: float  #: kappa, see `rolling_inertia`
    track_radius: float  #: R of the balls' centres, m
    ball_damping: float  #: drag of the race on one ball over its speed in it, N s/m

    def __post_init__(self) -> None:
        for name in ("platform_mass", "stiffness", "ball_mass", "track_radius", "ball_damping"):
            require_positive(name, getattr(self, name))
        for name in ("damping", "unbalance"):
            require_not_negative(name, getattr(self, name))
        if self.ball_count < 1:
            raise InputError("ball_count", self.ball_count, "1 or more")
        if not (math.isfinite(self.rolling) and self.rolling >= 1.0):
            raise InputError("rolling", self.rolling, "1 (a pendulum without own inertia) or above")

    @property
    def whole_mass(self) -> float:
        """M of everything that moves with the platform, kg [YF17, eq. 6]."""
        return self.platform_mass + self.ball_count * self.ball_mass

    @property
    def natural_frequency(self) -> float:
        """sqrt(k/M), rad/s: the unit of all dimensionless speeds [YF17, eq. 5]."""
        return math.sqrt(self.stiffness / self.whole_mass)

    @property
    def length(self) -> float:
        """N m R/M, m: the unit of the platform's motion [YF17, eq. 5]."""
        return self.ball_count * self.ball_mass * self.track_radius / self.whole_mass

    def dimensionless(self, gravity: float = 0.0, incline: float = 0.0) -> Dimensionless:
        """The numbers that the motion depends on [theory: balls, eq. 5] [YF17, eq. 3].

        Gravity 0 leaves its pull on the balls out; `incline` of the platform's line to the vertical, rad.
        """
        mass, frequency = self.whole_mass, self.natural_frequency
        balls = self.ball_count * self.ball_mass
        return Dimensionless(
            smallness=balls / (self.rolling * mass),
            drag=self.ball_damping * mass / (balls * self.ball_mass * frequency),
            unbalance=self.unbalance / (balls * self.track_radius),
            damping=self.damping / (2.0 * mass * frequency),
            gravity=gravity / (self.length * frequency**2),
            incline=incline,
        )

    def system(self) -> RotorSystem:
        """Platform and unbalance without the balls, which moves along the second direction only."""
        unit = np.ones((1, 1))
        across = np.array([[0.0], [1.0]])
        return RotorSystem(
            coordinates=("y",),
            mass=self.platform_mass * unit,
            damping=self.damping * unit,
            gyroscopic=0.0 * unit,
            stiffness=self.stiffness * unit,
            unbalance=np.array([-1j * self.unbalance], dtype=complex),
            centre=across,
            lean=0.0 * across,
        )


def rates(time: float, state: Array, numbers: Array, out: Array) -> None:
    """Rates of change of the state, with the coupled accelerations solved for [theory: balls, eq. 4 and 6].

    For the compiler. Time in units of 1/(natural frequency); state: platform's position and velocity, angles
    of the N balls, their rates; numbers of `Dimensionless.numbers`.
    """
    eps, b, delta, h, sigma, alpha, n = numbers
    balls = (state.size - 2) // 2
    velocity = state[1]
    load = delta * n * n * np.sin(n * time) - 2.0 * h * velocity - state[0]
    carried = 0.0
    for j in range(balls):
        angle, rate = state[2 + j], state[2 + balls + j]
        cosine = np.cos(angle)
        own = -eps * b * (rate - n)
        if sigma != 0.0:
            own -= eps * sigma * np.cos(angle - alpha)
        load += (rate * rate * np.sin(angle) - own * cosine) / balls
        carried += cosine * cosine
        out[2 + j] = rate
        out[2 + balls + j] = own
    acceleration = load / (1.0 - eps * carried / balls)
    out[0] = velocity
    out[1] = acceleration
    for j in range(balls):
        out[2 + balls + j] -= eps * acceleration * np.cos(state[2 + j])


def platform_motion(
    machine: Dimensionless, speed: float, stuck: float, together: float = 1.0
) -> tuple[complex, complex]:
    """Slow and fast vibration of the platform to lowest order [theory: balls, eq. 7] [YF17, eq. 8].

    Complex amplitudes: v = Im(slow e^{i Q t} + fast e^{i n t}), the balls' mean at the angle Q t; `together`
    is A, the length of the mean of their unit vectors.
    """

    def answer(frequency: float) -> complex:
        return frequency**2 / complex(1.0 - frequency**2, 2.0 * machine.damping * frequency)

    return together * answer(stuck), machine.unbalance * answer(speed)


@dataclass(frozen=True)
class CharacteristicSpeeds:
    """Shaft speeds over the natural frequency where the stuck speeds change [theory: balls, eq. 12-14]."""

    second_pair: float  #: n1, from where there are three stuck speeds; nan if there is one at every speed
    through_resonance: float  #: n2, where the slowest stuck speed is the natural frequency
    merger: float  #: n3, up to where there are three stuck speeds; nan as n1


def lag_number(machine: Dimensionless, together: float = 1.0) -> float:
    """Lag number chi = A^2 h/b [theory: balls, eq. 9].

    A is the length of the mean of the balls' unit vectors, 0 to 1.
    """
    if machine.drag <= 0.0:
        raise InputError("drag", machine.drag, "above 0")
    if not 0.0 <= together <= 1.0:
        raise InputError("together", together, "0 to 1")
    return together**2 * machine.damping / machine.drag


def shaft_speed(stuck: ArrayLike, machine: Dimensionless, together: float = 1.0) -> Array:
    """Shaft speed n at which balls stick at a given speed Q, without iteration [theory: balls, eq. 10]."""
    q = np.asarray(stuck, dtype=float)
    chi, h = lag_number(machine, together), machine.damping
    return np.asarray(q + chi * q**5 / (np.square(1.0 - q**2) + np.square(2.0 * h * q)))


def stuck_speeds(speed: ArrayLike, machine: Dimensionless, together: float = 1.0) -> Array:
    """All speeds at which the balls can stick, roots of the quintic [theory: balls, eq. 11] [YF17, eq. 9].

    Q by size, shape (..., 3); nan in the last two where only one is real.
    """
    n = np.asarray(speed, dtype=float)
    if not np.all(np.isfinite(n) & (n > 0.0)):
        raise InputError("speed", n.tolist(), "finite numbers above 0")
    if machine.damping <= 0.0:
        raise InputError("damping", machine.damping, "above 0")
    ends = _turning_points(machine, together)
    shafts = n.reshape(-1)
    # The slowest lies below the peak of n(Q), the fastest beyond its trough, one between them; none is faster
    # than the shaft.
    columns = []
    for low, high in pairwise((0.0, *ends, np.inf)):
        bottom, top = np.full(shafts.shape, low), np.minimum(high, shafts)
        root, there = bracketed_root(
            lambda q, which: shaft_speed(q, machine, together) - shafts[which], np.minimum(bottom, top), top
        )
        columns.append(np.where(there & (bottom < top), root, np.nan))
    columns += [np.full(shafts.shape, np.nan)] * (3 - len(columns))
    return np.sort(np.stack(columns, axis=-1), axis=-1).reshape((*n.shape, 3))


def characteristic_speeds(machine: Dimensionless, together: float = 1.0) -> CharacteristicSpeeds:
    """Shaft speeds where the number of stuck speeds changes, to rounding [theory: balls, eq. 12-14]."""
    if machine.damping <= 0.0:
        raise InputError("damping", machine.damping, "above 0")
    ends = _turning_points(machine, together)
    through = float(shaft_speed(1.0, machine, together))
    if not ends:
        return CharacteristicSpeeds(math.nan, through, math.nan)
    peak, trough = (float(shaft_speed(q, machine, together)) for q in ends)
    return CharacteristicSpeeds(trough, through, peak)


def _turning_points(machine: Dimensionless, together: float) -> tuple[float, ...]:
    """Q at the peak and at the trough of n(Q), refined; none where n rises all the way."""
    chi, h = lag_number(machine, together), machine.damping
    bell = np.array([1.0, 0.0, 4.0 * h * h - 2.0, 0.0, 1.0])
    # dn/dQ D^2 = D^2 + chi Q^4 (5 D - Q D')
    factor = polynomial.polysub(5.0 * bell, np.concatenate(([0.0], polynomial.polyder(bell))))
    slope = polynomial.polyadd(polynomial.polymul(bell, bell), chi * np.concatenate((np.zeros(4), factor)))
    roots = polynomial.polyroots(slope)
    real = np.sort(roots.real[(np.abs(roots.imag) <= 1e-7 * np.abs(roots)) & (roots.real > 0.0)])
    if real.size < 2:
        return ()
    steeper = polynomial.polyder(slope)
    for _ in range(3):
        real = real - polynomial.polyval(real, slope) / polynomial.polyval(real, steeper)
    return float(real[0]), float(real[-1])
