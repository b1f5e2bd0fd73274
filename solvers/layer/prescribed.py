"""A prescribed whirl of a drum with a liquid layer: what is asked and what is answered."""

from __future__ import annotations

import math
from dataclasses import dataclass

from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative, require_positive


@dataclass(frozen=True)
class Whirl:
    """A circular whirl of the drum's axis.

    Parameters
    ----------
    spin : Omega, rad/s, > 0
    speed : omega_w in space, rad/s
    amplitude : m
    ramp : time over which the amplitude grows from nothing, s
    gravity : across the axis, m/s^2
    """

    spin: float
    speed: float
    amplitude: float
    ramp: float = 0.0
    gravity: float = 0.0

    def __post_init__(self) -> None:
        require_positive("speed", self.spin)
        require_not_negative("whirl_amplitude", self.amplitude)
        require_not_negative("ramp", self.ramp)
        require_not_negative("gravity", self.gravity)
        if not math.isfinite(self.speed) or self.speed == 0.0:
            raise InputError("whirl_speed", self.speed, "a finite number other than 0")

    @property
    def slip(self) -> float:
        """Whirl speed seen from the drum, s = omega_w - Omega, rad/s."""
        return self.speed - self.spin

    @property
    def period(self) -> float:
        """Time of one whirl seen from the drum, or of one turn of a synchronous one, s."""
        return 2.0 * math.pi / (abs(self.slip) or self.spin)


@dataclass(frozen=True)
class Numerics:
    """How the layer is resolved.

    Parameters
    ----------
    cells : finite volumes round the wall, at least 8
    dispersion : add the finite depth's dispersion [theory: long_wave, eq. 12]
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
