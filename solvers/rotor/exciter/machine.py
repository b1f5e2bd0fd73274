"""The dual-frequency exciter: balls in a race on an unbalanced shaft shake a platform along one line."""

from __future__ import annotations

import math
from dataclasses import astuple, dataclass

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_not_negative, require_positive
from solvers.rotor.system import RotorSystem

# Rolling inertia over that of the sliding mass, m R^2 [YF17, eq. 7].
ROLLING = {"ball": 7.0 / 5.0, "roller": 3.0 / 2.0}


def rolling_inertia(kind: str, mass: float = 1.0, radius: float = 1.0, own_inertia: float = 0.0) -> float:
    """Inertia of a load on its way around the track, over m R^2 [theory: balls, eq. 2] [YF17, eq. 7].

    Parameters
    ----------
    kind : `ball`, `roller` or `pendulum`
    mass, radius : m, kg, and R, m; of a pendulum
    own_inertia : J of a pendulum about its own centre of mass, kg m^2

    Returns
    -------
    kappa: 7/5, 3/2 or 1 + J/(m R^2)

    Raises
    ------
    InputError : an unknown kind, a mass or radius that is not positive, a negative inertia
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
    """The machine in its own units: 1/(natural frequency) and N m R/(whole mass) [theory: balls, eq. 5].

    Parameters
    ----------
    smallness : eps = N m/(kappa M), share of the balls in the whole mass over their rolling inertia
    drag : b, drag of the race over that share and the natural frequency
    unbalance : delta, of the shaft over that of all balls together
    damping : h, damping ratio of the platform
    gravity : sigma, static deflection over the unit of length
    incline : alpha, of the platform's line to the vertical, rad

    Raises
    ------
    InputError : a value that is not finite, smallness not between 0 and 1, a negative drag or damping
    """

    smallness: float
    drag: float
    unbalance: float
    damping: float
    gravity: float = 0.0
    incline: float = 0.0

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
    """A platform on springs, a shaft with an unbalance on it, balls free in a race around the shaft.

    Parameters
    ----------
    platform_mass : of all that moves with the platform, its load and the unbalance too, without the balls, kg
    stiffness : of the supports k, N/m
    damping : of the supports, N s/m
    unbalance : mu P of the shaft, kg m
    ball_count : N, 1 or more
    ball_mass : m of one, kg
    rolling : kappa, see `rolling_inertia`
    track_radius : R of the balls' centres, m
    ball_damping : drag of the race on one ball over its speed in it, N s/m

    Raises
    ------
    InputError : masses, stiffness or radius not positive, kappa below 1, damping or unbalance negative
    """

    platform_mass: float
    stiffness: float
    damping: float
    unbalance: float
    ball_count: int
    ball_mass: float
    rolling: float
    track_radius: float
    ball_damping: float

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

        Parameters
        ----------
        gravity : m/s^2, 0 to leave its pull on the balls out
        incline : of the platform's line to the vertical, rad
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

    Written without array expressions, for the compiler.

    Parameters
    ----------
    time : in units of 1/(natural frequency)
    state : platform's position and velocity, angles of the N balls, their rates, shape (2 + 2 N,)
    numbers : of `Dimensionless.numbers`
    out : the result, shape of `state`
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

    Parameters
    ----------
    machine : its numbers
    speed : n of the shaft
    stuck : Q of the balls
    together : A, length of the mean of the balls' unit vectors, 1 where they sit together

    Returns
    -------
    Complex amplitudes: v = Im(slow e^{i Q t} + fast e^{i n t}), the balls' mean at the angle Q t
    """

    def answer(frequency: float) -> complex:
        return frequency**2 / complex(1.0 - frequency**2, 2.0 * machine.damping * frequency)

    return together * answer(stuck), machine.unbalance * answer(speed)
