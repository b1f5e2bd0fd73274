"""What the liquid answers to one prescribed whirl."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from leblanc.studies.validity import Number
from meshes.arrays import Array

_POINTS = 360


@dataclass(frozen=True)
class LayerAnswer:
    """Force and centre of mass of a liquid layer; complex: along the deflection, 90 deg ahead of it.

    Parameters
    ----------
    force_ratio : force on the drum over m_f omega_w^2 A
    offset : liquid's centre of mass from the drum's axis, m
    mass_error : of the surface that the model draws, relative
    converged : the force is finite
    in_range : the model holds; `validity` and `notes` say why not
    mean_rotation : of the liquid relative to the drum, rad/s
    wall_time : s
    theta, depth : angle from the deflection, rad, and depth of the layer there, m, shape (k,)
    notes : what the model leaves out here, in words
    gravity_offset : steady part of the offset under gravity across the axis, in space, m: up is negative
    captured : centrifugal acceleration at the surface exceeds gravity
    validity : dimensionless numbers the model rests on, each with its range
    """

    force_ratio: complex
    offset: complex
    mass_error: float
    converged: bool
    in_range: bool
    mean_rotation: float
    wall_time: float
    theta: Array
    depth: Array
    notes: tuple[str, ...]
    gravity_offset: float
    captured: bool
    validity: tuple[Number, ...]


def angles() -> Array:
    """Angles from the deflection all round, rad."""
    return np.linspace(-math.pi, math.pi, _POINTS, endpoint=False)


def wave_amplitude(depth: Array, mean: float) -> float:
    """Largest change of depth over the mean depth; nan without a profile."""
    return float(np.max(np.abs(depth - mean))) / mean if depth.size else math.nan
