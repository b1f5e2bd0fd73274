"""What is told of a layer in time, whichever solver took it there: whirl periods, and pictures."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.arrays import Array, Complex


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
    converged : every period was finished and, where it was to settle, the last two agree
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
