"""A finite-volume layer with what drives it: its start, equilibrium, loads, way through periods.

Lengths over R, times over 1/Omega; complex numbers: along the deflection, 90 deg ahead of it.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np

from fluid.fill import Fill
from fluid.friction import QUADRATIC, Friction
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.records import LOADS, Drive, Outcome, Record, Wall, records
from solvers.liquid_model import Whirl


@lru_cache(maxsize=16)
def ring(cells: int) -> Array:
    """Cosine and sine at the cells' middles and at their left faces, shape (4, n); the first cell from 0."""
    edge = 2.0 * math.pi * np.arange(cells) / cells
    middle = edge + math.pi / cells
    return np.stack([np.cos(middle), np.sin(middle), np.cos(edge), np.sin(edge)])


def offset(area: Array, drive: Drive, angles: Array, time: float) -> complex:
    """Offset of the liquid's centre of mass from the drum's axis at a time.

    Parameters
    ----------
    area : A, shape (n,)
    drive, angles : as for `solvers.layer.step.advance`
    time : at which the deflection has turned by the slip times it
    """
    surface = np.sqrt(np.maximum(1.0 - 2.0 * area, 0.0))
    lever = (1.0 - surface) * (1.0 + surface + surface * surface) / 3.0
    found = complex(lever @ angles[0], lever @ angles[1]) / float(area.sum())
    return found * cmath.exp(-1j * drive.slip * time)


def means(
    sums: Record, length: float, mass: float, whirl_speed: float, offsets: tuple[complex, complex]
) -> Complex:
    """Means over a time [theory: long_wave, eq. 7].

    Parameters
    ----------
    sums : a record LOADS of `solvers.layer.records`
    length : of the time
    mass : of the liquid, over rho h_c R^2
    whirl_speed : omega_w
    offsets : at the beginning and at the end

    Returns
    -------
    Force by the liquid's momentum and offset, turning, least and largest depth, force by the pressure on the
    wall, shape (6,); forces are over rho h_c R^3
    """
    pressure = complex(sums.force_x, sums.force_y) / length
    moved = complex(sums.offset_x, sums.offset_y) / length
    push = complex(sums.push_x, sums.push_y) / length
    drift = (offsets[1] - offsets[0]) / length
    # The liquid as a whole: what pushes it, the centripetal and the Coriolis part.
    inertia = mass * (push + whirl_speed**2 * moved - 2j * whirl_speed * drift)
    rest = sums.turning / length, sums.depth_min / length, sums.depth_max / length
    return np.array([inertia, moved, *rest, pressure], dtype=np.complex128)


@dataclass(frozen=True)
class Numerics:
    """How the layer is resolved.

    Parameters
    ----------
    cells : finite volumes round the wall, at least 8
    dispersion : add the finite depth's dispersion [theory: long_wave, eq. 13]
    """

    cells: int = 256
    dispersion: bool = False

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")


@dataclass(frozen=True)
class LayerHistory:
    """Whirl periods of a layer; k of them, n cells. Complex: along the deflection, 90 deg ahead of it.

    Parameters
    ----------
    time : middle of each period, s, shape (k,)
    force_ratio : mean force on the drum over m_f omega_w^2 A, by the liquid's momentum, shape (k,)
    pressure_ratio : the same by the pressure on the wall; the two differ by the model's error, shape (k,)
    offset : mean offset of the liquid's centre of mass from the drum's axis, m, shape (k,)
    mean_rotation : mean turning of the liquid relative to the drum, rad/s, shape (k,)
    depth_max, depth_min : mean over the period of the largest and the least depth, m, shape (k,)
    theta : angle from the deflection at the end, rad, ascending, shape (n,)
    depth : depth of the layer there, m, shape (n,)
    mass_error : relative change of the liquid's volume
    converged : every period was finished; for `settle`, and the last two agree
    reason : why it is not, or empty
    """

    time: Array
    force_ratio: Complex
    pressure_ratio: Complex
    offset: Complex
    mean_rotation: Array
    depth_max: Array
    depth_min: Array
    theta: Array
    depth: Array
    mass_error: float
    converged: bool
    reason: str


@dataclass(frozen=True)
class LayerFilm:
    """Pictures of a layer in the drum frame; k of them, n cells.

    Parameters
    ----------
    time : s, shape (k,)
    theta : angle in the drum, rad, shape (n,)
    depth : m, shape (k, n)
    deflection : of the drum's axis, seen from the drum, m, complex, shape (k,)
    """

    time: Array
    theta: Array
    depth: Array
    deflection: Complex


_COURANT = 0.8


@dataclass
class MovingLayer:
    """A layer and what drives it.

    Parameters
    ----------
    fill, whirl : what it is made from
    area, momentum : A and q, shape (n,)
    drive, wall, angles, scratch : as for `solvers.layer.step.advance`
    time : how far it has come
    reason : why it went no further, or empty
    """

    fill: Fill
    whirl: Whirl
    area: Array
    momentum: Array
    drive: Drive
    wall: Wall
    angles: Array
    scratch: Array
    time: float = 0.0
    reason: str = ""

    def periods(self, count: float) -> Complex | None:
        """Advance by whirl periods; `solvers.layer.state.means` over them, or None with a `reason`."""
        from solvers.layer.step import march

        length = self.whirl.period * self.whirl.spin * count
        first, sums = offset(self.area, self.drive, self.angles, self.time), records(LOADS)
        outcome, taken = march(
            self.area,
            self.momentum,
            self.time,
            self.time + length,
            self.drive,
            self.wall,
            self.angles,
            _COURANT,
            self.scratch,
            sums,
        )
        if outcome is not Outcome.DONE:
            ran = outcome in (Outcome.RAN_OUT, Outcome.RAN_AWAY)
            self.reason = f"{outcome.message} ({taken} steps)" if ran else outcome.message
            return None
        self.time += length
        last = offset(self.area, self.drive, self.angles, self.time)
        mass = 2.0 * math.pi * float(self.area.mean())
        return means(sums[0], length, mass, self.drive.whirl, (first, last))


def start(fill: Fill, whirl: Whirl, friction: Friction, numerics: Numerics) -> MovingLayer:
    """Uniform layer at rest in the drum.

    Parameters
    ----------
    fill, whirl, friction, numerics : as for `solvers.layer.settle.simulate`

    Raises
    ------
    InputError : no liquid, no free surface
    """
    from solvers.layer.step import scratch

    chamber = fill.chamber
    if not 0.0 < fill.volume < chamber.capacity * (1.0 - 1e-9):
        raise InputError("volume", fill.volume, f"above 0 and below the capacity ({chamber.capacity:g} m^3)")
    radius, spin = chamber.radius, whirl.spin
    n = numerics.cells
    area = np.full(n, fill.volume / (2.0 * math.pi * chamber.height * radius**2))
    law, coefficient = friction.at(fill.liquid.viscosity, whirl.slip, radius)
    # The quadratic coefficient is a pure number, the others are rates.
    scaled = coefficient if law == QUADRATIC else coefficient / spin
    return MovingLayer(
        fill=fill,
        whirl=whirl,
        area=area,
        momentum=-np.square(area),
        drive=Drive(
            amplitude=whirl.amplitude / radius,
            slip=whirl.slip / spin,
            ramp=whirl.ramp * spin,
            whirl=whirl.speed / spin,
            weight=whirl.gravity / (radius * spin**2),
            spin=1.0,
        ),
        wall=Wall(law, scaled, 2.0 * radius / chamber.height, numerics.dispersion),
        angles=ring(n),
        scratch=scratch(n),
    )


def settle_statics(layer: MovingLayer) -> None:
    """Equilibrium of the liquid under a synchronous whirl: a circle about the rotation axis, cell by cell."""
    amplitude, whole = layer.drive.amplitude, float(layer.area.sum())
    cosine, sine = layer.angles[0], layer.angles[1]

    def cells(squared: float) -> Array:
        # Distance from the drum's axis to the circle of that squared radius about the rotation axis.
        across = squared - np.square(amplitude * sine)
        surface = np.sqrt(np.maximum(across, 0.0)) - amplitude * cosine
        return np.asarray(0.5 * np.maximum(1.0 - np.square(np.clip(surface, 0.0, 1.0)), 0.0))

    low, high = 0.0, (1.0 + amplitude) ** 2
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if cells(middle).sum() > whole else (low, middle)
    layer.area[:] = cells(0.5 * (low + high))
    layer.momentum[:] = -np.square(layer.area)


def depth(layer: MovingLayer) -> Array:
    """Depth of each cell, m."""
    surface = np.sqrt(np.maximum(1.0 - 2.0 * layer.area, 0.0))
    return np.asarray(layer.fill.chamber.radius * (1.0 - surface))
