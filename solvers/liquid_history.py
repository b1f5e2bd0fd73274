"""Records of a layer in time, whichever solver took it there: whirl periods, and pictures."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.arrays import Array, Complex


@dataclass(frozen=True)
class LayerFilm:
    """Pictures of a layer in the drum frame; k of them, n cells."""

    time: Array  #: s, shape (k,)
    theta: Array  #: angle in the drum, rad, shape (n,)
    depth: Array  #: m, shape (k, n)
    deflection: Complex  #: of the drum's axis, seen from the drum, m, complex, shape (k,)


@dataclass(frozen=True)
class LayerHistory:
    """Whirl periods of a layer; k of them, n cells. Complex: along the deflection, 90 deg ahead of it."""

    time: Array  #: middle of each period, s, shape (k,)
    force_ratio: Complex  #: mean force on the drum over m_f omega_w^2 A, by the liquid's momentum, shape (k,)
    #: the same by the pressure on the wall; the two differ by the model's error, shape (k,)
    pressure_ratio: Complex
    offset: Complex  #: mean offset of the liquid's centre of mass from the drum's axis, m, shape (k,)
    mean_rotation: Array  #: mean turning of the liquid relative to the drum, rad/s, shape (k,)
    depth_max: Array  #: mean over the period of the largest and the least depth, m, shape (k,)
    depth_min: Array
    theta: Array  #: angle from the deflection at the end, rad, ascending, shape (n,)
    depth: Array  #: depth of the layer there, m, shape (n,)
    ends: LayerFilm  #: at the start and at the end of each period
    mass_error: float  #: relative change of the liquid's volume
    converged: bool  #: every period was finished and, where it was to settle, the last two agree
    reason: str  #: why it is not, or empty
