"""What one study found, as files, figures and reports take it."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection, layer_depth
from meshes.errors import InputError
from solvers.rotor.campbell import Campbell
from solvers.synchronous.planar import Response


@dataclass(frozen=True)
class ChamberRecord:
    """One chamber as reports show it.

    Parameters
    ----------
    radius, inner_radius, height, mean_surface_radius : m; the last one of the undisturbed layer
    volume : of the liquid, m^3
    liquid_name : as the scene names it
    plane : position along the axis where that matters, m
    baffles : None without any
    section : None for circular walls
    """

    radius: float
    inner_radius: float
    height: float
    volume: float
    liquid_name: str
    mean_surface_radius: float
    plane: float = 0.0
    baffles: Baffles | None = None
    section: ChamberSection | None = None

    @property
    def least_depth(self) -> float:
        """Depth of the undisturbed layer where it is thinnest, m."""
        area = self.volume / self.height
        if self.section is not None and 0.0 < area < self.section.area:
            return layer_depth(self.section, area)
        return self.radius - self.mean_surface_radius


@dataclass(frozen=True)
class ModeRecord:
    """Free vibration of the dry rotor at rest.

    Parameters
    ----------
    frequency : damped, rad/s; 0 where overdamped
    damping_ratio : 1 where overdamped
    moves : what moves most, in words
    """

    frequency: float
    damping_ratio: float
    moves: str


@dataclass(frozen=True)
class Motion:
    """What a rotor that tilts, or moves differently in two directions, adds to a planar one.

    The axis goes round as forward e^{i Omega t} + backward e^{-i Omega t}; the deflections of the response
    are the forward part. s speeds, b branches, c chambers.

    Parameters
    ----------
    position : along the axis of the plane reported, m
    backward, backward_dry : m, shape (s,)
    branch_backward : m, shape (s, b)
    chamber_forward : at each chamber, m, shape (s, c)
    modes : of the dry rotor at rest, by rising frequency
    campbell : natural frequencies of the dry rotor over its speed
    critical_speeds_dry, critical_speeds_wet : undamped, each with the direction of its whirl, -1 to 1
    zero : what angles count from, in words
    """

    position: float
    backward: NDArray[np.complex128]
    backward_dry: NDArray[np.complex128]
    branch_backward: NDArray[np.complex128]
    chamber_forward: NDArray[np.complex128]
    modes: tuple[ModeRecord, ...]
    campbell: Campbell
    critical_speeds_dry: tuple[tuple[float, float], ...]
    critical_speeds_wet: tuple[tuple[float, float], ...]
    zero: str


@dataclass(frozen=True)
class SelfExcited:
    """Whirl that grows by itself from the even layer, in linear theory.

    Parameters
    ----------
    growth : of the whirl that grows most, 1/s, nan where it was not found, shape (n,)
    whirl_speed : of that whirl in the standing frame, rad/s, shape (n,)
    bands : of speed in which some whirl grows, rad/s; the ends of the range of speeds count as edges
    friction : of the liquid, in words
    """

    growth: Array
    whirl_speed: Array
    bands: tuple[tuple[float, float], ...]
    friction: str


@dataclass(frozen=True)
class StudyRecord:
    """Everything that `run` writes down: the scene in words, the response, what a reader must know.

    Parameters
    ----------
    name, source : of the scene, free text
    assumed : field paths of the values that no source gives
    inputs : label, value with its unit, field path
    digest : of the scene
    response : the answer at each speed, SI
    liquid_mass : of all chambers, kg
    notes : limits of validity and findings, in words
    axis : "horizontal" or "vertical"
    chambers : one for each chamber
    capture_speed : below it gravity keeps the liquid from riding with the drum, rad/s; None if never
    critical_speed_dry, critical_speed_wet : without liquid and with its added mass, rad/s; of several the one
        at which the unbalance moves the axis most
    motion : None for a planar rotor
    whirl : None where it was not asked for
    error_estimate : relative, of amplitude and liquid the larger one, nan where there is none, shape (n,);
        None where nothing was estimated

    Raises
    ------
    InputError : no speed at all, an axis of another name, arrays of the response that do not fit together
    """

    name: str
    source: str
    assumed: tuple[str, ...]
    inputs: tuple[tuple[str, str, str], ...]
    digest: str
    response: Response
    liquid_mass: float
    notes: tuple[str, ...]
    axis: str
    chambers: tuple[ChamberRecord, ...]
    capture_speed: float | None
    critical_speed_dry: float
    critical_speed_wet: float
    motion: Motion | None = None
    whirl: SelfExcited | None = None
    error_estimate: Array | None = None

    def __post_init__(self) -> None:
        if self.axis not in ("horizontal", "vertical"):
            raise InputError("rotor.axis", self.axis, "horizontal or vertical")
        count = self.response.speed.size
        if self.response.speed.ndim != 1 or count == 0:
            raise InputError("speeds", self.response.speed.shape, "a list of at least one speed")
        branches = self.response.branch_deflection.shape
        for field in fields(self.response):
            shape = getattr(self.response, field.name).shape
            expected = (count, *branches[1:]) if field.name.startswith("branch_") else (count,)
            if shape != expected:
                raise InputError(f"response.{field.name}", shape, f"of shape {expected}")

    @property
    def amplitude(self) -> Array:
        """Largest distance of the axis from the line it rests in, of the branch reported, m, shape (n,)."""
        more = 0.0 if self.motion is None else np.abs(self.motion.backward)
        return np.asarray(np.abs(self.response.deflection) + more)

    @property
    def amplitude_dry(self) -> Array:
        """The same of the rotor without liquid, m, shape (n,)."""
        more = 0.0 if self.motion is None else np.abs(self.motion.backward_dry)
        return np.asarray(np.abs(self.response.deflection_dry) + more)

    @property
    def branch_amplitude(self) -> Array:
        """The same of every branch, nan where there is none, m, shape (n, b)."""
        more = 0.0 if self.motion is None else np.abs(self.motion.branch_backward)
        return np.asarray(np.abs(self.response.branch_deflection) + more)


def phase(deflection: NDArray[np.complex128]) -> Array:
    """Angle from the unbalance to the deflection.

    Parameters
    ----------
    deflection : complex, the unbalance pointing along the real axis, m, shape (...,)

    Returns
    -------
    rad in (-pi, pi], negative where the deflection lags, 0 where there is none, shape (...,).
    """
    angle = np.angle(deflection)
    angle = np.where(angle <= -math.pi, math.pi, angle)
    return np.where(deflection == 0.0, 0.0, angle)


def models_used(response: Response) -> tuple[str, ...]:
    """Names of the liquid models, in the order in which they appear over speed."""
    return tuple(dict.fromkeys(response.model.tolist()))


def peak(deflection: NDArray[np.complex128] | Array) -> int | None:
    """Index of the largest deflection, the first of equals; None if there is no finite one.

    Parameters
    ----------
    deflection : complex or its size, nan where nothing was found, m, shape (n,)
    """
    size = np.abs(deflection)
    known = np.asarray(np.isfinite(size))
    return int(np.argmax(np.where(known, size, -1.0))) if known.any() else None
