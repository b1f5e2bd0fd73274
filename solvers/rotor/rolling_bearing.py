"""A ball bearing whose outer ring is at rest: its frequencies and what they tell; life, slip and wear."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import ArrayLike

from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from meshes.quantity import Q
from solvers.rotor.system import cage_speed

ORDERS = ("ftf", "bpfo", "bpfi", "bsf")
FEWEST_BALLS, MOST_BALLS = 3, 60
_LEAST_RATIO, _MOST_RATIO, _GRID = 1e-3, 0.95, 2000  # of d cos(theta)/D
_LEAST_COSINE = math.cos(math.radians(80.0))  # of contact angles that are looked for


@dataclass(frozen=True)
class Bearing:
    """What the frequencies of a bearing depend on."""

    balls: int  #: N_b, how many roll in one row
    diameter_ratio: float  #: d/D, of a ball over the circle of the balls' centres, between 0 and 1
    contact_angle: float = 0.0  #: theta, rad, from 0 to below pi/2

    def __post_init__(self) -> None:
        if not (isinstance(self.balls, int) and 1 <= self.balls <= 1000):
            raise InputError("balls", self.balls, "a whole number from 1 to 1000")
        if not 0.0 < self.diameter_ratio < 1.0:
            raise InputError("diameter_ratio", self.diameter_ratio, "between 0 and 1")
        if not 0.0 <= self.contact_angle < 0.5 * math.pi:
            raise InputError("contact_angle", self.contact_angle, "from 0 to below pi/2")

    def orders(self) -> dict[str, float]:
        """Each frequency over that of the shaft, by name [theory: spindle, eq. 17].

        `ftf` of the cage; `bpfo` and `bpfi` of balls that pass a place of the outer and of the inner ring;
        `bsf` of a ball about its own axis.
        """
        ratio, cosine = self.diameter_ratio, math.cos(self.contact_angle)
        cage = float(cage_speed(1.0, 1.0, ratio, self.contact_angle))
        spin = 0.5 * (1.0 - (ratio * cosine) ** 2) / ratio
        return dict(zip(ORDERS, (cage, self.balls * cage, self.balls * (1.0 - cage), spin), strict=True))


# A ball bearing with less load than this share of its dynamic rating skids: the makers' common rule.
LEAST_LOAD = 0.01


def rating_life(rating: ArrayLike, load: ArrayLike, speed: ArrayLike) -> Array:
    """Time that nine of ten ball bearings reach, s by ISO 281 [theory: loads, eq. 22]; infinite without load.

    `rating` the basic dynamic one, N; `load` across the axis, N; `speed` of the inner ring, rad/s.
    """
    c, p, spin = np.broadcast_arrays(*(np.asarray(x, dtype=float) for x in (rating, load, speed)))
    turns = np.divide(c, p, out=np.full(p.shape, np.inf), where=p != 0.0) ** 3
    return np.asarray(2.0 * np.pi * 1e6 * turns / spin)


def skidding_slip(load: ArrayLike, least: ArrayLike) -> Array:
    """Share by which a cage is behind rolling, its load below the least one [theory: loads, eq. 23]."""
    return np.asarray(np.maximum(1.0 - np.asarray(load) / np.asarray(least), 0.0))


def sliding_speed(
    speed: ArrayLike, slip: ArrayLike, ball: float, pitch: float, contact_angle: float = 0.0
) -> Array:
    """Speed of the inner ring's track against the balls, m/s, by the cage's slip [theory: loads, eq. 24].

    `ball` and `pitch` are the diameters of a ball and of the circle of their centres.
    """
    track = 0.5 * (pitch - ball * math.cos(contact_angle))
    return np.asarray(np.asarray(slip) * np.asarray(speed) * track)


def worn_volume(coefficient: ArrayLike, load: ArrayLike, distance: ArrayLike) -> Array:
    """Volume worn off by sliding, m^3: coefficient (m^2/N), load, distance [theory: loads, eq. 25]."""
    return np.asarray(np.asarray(coefficient) * np.asarray(load) * np.asarray(distance))


def cage_slip(measured: float, theoretical: float) -> float:
    """Share by which a cage is behind rolling without slip [theory: spindle, eq. 19] [DR18, eq. 9].

    0 where all balls roll, 1 where the cage stands still, below 0 where it is ahead.
    """
    require_positive("theoretical", theoretical)
    if not (math.isfinite(measured) and measured >= 0.0):
        raise InputError("measured", measured, "a finite number, 0 or above")
    return 1.0 - measured / theoretical


@dataclass(frozen=True)
class BearingFit:
    """A bearing whose frequencies are nearest to some that are given."""

    bearing: Bearing  #: the best
    projected_ratio: Annotated[float, Q("1", "d cos(theta)/D")]
    #: nan where no more is given than is sought
    projected_ratio_std: Annotated[float, Q("1", "standard error of d cos(theta)/D")]
    #: nan where the angle was given or is 0, the end of its range
    cosine: Annotated[float, Q("1", "cosine of the contact angle")]
    cosine_std: Annotated[float, Q("1", "standard error of that cosine")]
    residual_rms: Annotated[float, Q("1", "root mean square of computed over given less 1")]
    #: None and nan where the number of balls was given
    next_balls: Annotated[int | None, Q("1", "second best number of balls")]
    next_rms: Annotated[float, Q("1", "residual with that number")]


def fit_bearing(
    given: Mapping[str, float], balls: int | None = None, contact_angle: float | None = None
) -> BearingFit:
    """Bearing from its frequencies over that of the shaft, by least squares of the relative errors.

    Every number of balls is tried; for each the ratio of diameters and the contact angle are fitted
    [theory: spindle, eq. 18]. An `InputError` where the values do not tell what is sought: balls need bpfo or
    bpfi, the contact angle bsf.
    """
    for name, value in given.items():
        if name not in ORDERS:
            raise InputError("given", name, "one of: " + ", ".join(ORDERS))
        require_positive(name, value)
    if balls is None and not {"bpfo", "bpfi"} & given.keys():
        raise InputError("balls", None, "given, or bpfo or bpfi, which tell how many there are")
    if contact_angle is None and "bsf" not in given:
        raise InputError("contact_angle", None, "given, or bsf, which alone tells it")
    sought = 1 + (balls is None) + (contact_angle is None)
    if len(given) < sought:
        raise InputError("given", len(given), f"{sought} frequencies or more, as many as are sought")
    counts = range(FEWEST_BALLS, MOST_BALLS + 1) if balls is None else (balls,)
    likely = sorted(counts, key=lambda count: _least_error(given, count, contact_angle))[:2]
    found = sorted((_fitted(given, count, contact_angle) for count in likely), key=lambda fit: fit[1])
    (values, rms, spread), other = found[0], found[1] if len(found) > 1 else None
    ratio, cosine, count = values
    angle = math.acos(min(1.0, cosine)) if contact_angle is None else contact_angle
    return BearingFit(
        bearing=Bearing(int(count), ratio / cosine, angle),
        projected_ratio=ratio,
        projected_ratio_std=spread[0],
        cosine=cosine,
        cosine_std=spread[1],
        residual_rms=rms,
        next_balls=None if other is None else int(other[0][2]),
        next_rms=math.nan if other is None else other[1],
    )


def _orders(balls: int, ratio: Array, cosine: Array) -> dict[str, Array]:
    """Frequencies over the shaft's by d cos(theta)/D and cos(theta) [theory: spindle, eq. 17]."""
    cage = 0.5 * (1.0 - ratio)
    spin = 0.5 * cosine / ratio * (1.0 - ratio * ratio)
    return dict(zip(ORDERS, (cage, balls * cage, balls * (1.0 - cage), spin), strict=True))


def _least_error(given: Mapping[str, float], balls: int, contact_angle: float | None) -> float:
    """Least sum of squares over a grid of ratios, the cosine the best for each: tells balls from balls."""
    ratio = np.linspace(_LEAST_RATIO, _MOST_RATIO, _GRID)
    cosine = np.full(ratio.shape, math.cos(contact_angle or 0.0))
    if contact_angle is None:
        at_one = _orders(balls, ratio, np.ones_like(ratio))["bsf"]
        cosine = np.clip(given["bsf"] / at_one, _LEAST_COSINE, 1.0)  # bsf is in proportion to it
    computed = _orders(balls, ratio, cosine)
    errors = np.stack([computed[name] / value - 1.0 for name, value in given.items()])
    return float(np.square(errors).sum(axis=0).min())


def _fitted(
    given: Mapping[str, float], balls: int, contact_angle: float | None
) -> tuple[tuple[float, float, int], float, tuple[float, float]]:
    """Best ratio and cosine of one number of balls, the residual, standard errors."""
    from scipy.optimize import least_squares

    def errors(values: Array) -> Array:
        cosine = values[-1] if contact_angle is None else np.cos(contact_angle)
        computed = _orders(balls, values[0], cosine)
        return np.array([computed[name] / value - 1.0 for name, value in given.items()])

    least, most = [_LEAST_RATIO], [_MOST_RATIO]
    if contact_angle is None:
        least, most = [_LEAST_RATIO, _LEAST_COSINE], [_MOST_RATIO, 1.0]
    start = [0.25, 0.95][: len(least)]
    tight = dict.fromkeys(("xtol", "ftol", "gtol"), 1e-15)
    found = least_squares(errors, start, bounds=(least, most), **tight)
    free = np.asarray(found.active_mask == 0)
    over = len(given) - int(free.sum())
    spread = [math.nan, math.nan]
    jacobian = found.jac[:, free]
    if over > 0 and free.any() and np.linalg.matrix_rank(jacobian) == free.sum():
        variance = 2.0 * found.cost / over * np.linalg.inv(jacobian.T @ jacobian)
        for place, value in zip(np.flatnonzero(free), np.sqrt(np.diagonal(variance)), strict=True):
            spread[place] = float(value)
    # An interior-point step stops just short of a bound.
    cosine = math.cos(contact_angle or 0.0) if free.size == 1 or not free[-1] else float(found.x[-1])
    rms = math.sqrt(2.0 * found.cost / len(given))
    return (float(found.x[0]), cosine, balls), rms, (spread[0], spread[1])
