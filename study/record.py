"""What one study found, as files, figures and reports take it."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from importlib import metadata

import numpy as np
from numpy.typing import NDArray

from meshes.border import InputError
from solvers.response import Response

Array = NDArray[np.float64]

RPM = 60.0 / (2.0 * math.pi)  # revolutions per minute in one rad/s
MM = 1e3  # millimetres in one metre


@dataclass(frozen=True)
class ChamberRecord:
    """One chamber as reports show it.

    Parameters
    ----------
    radius, inner_radius, height, mean_surface_radius : m; the last one of the undisturbed layer
    volume : of the liquid, m^3
    liquid_name : as the scene names it
    """

    radius: float
    inner_radius: float
    height: float
    volume: float
    liquid_name: str
    mean_surface_radius: float


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
    critical_speed_dry, critical_speed_wet : without liquid and with its added mass, rad/s

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


def one_line(text: str) -> str:
    """Text without line breaks and control characters, which files and figures cannot carry."""
    return " ".join("".join(c if c.isprintable() else " " for c in text).split())


def versions() -> dict[str, str]:
    """Versions of this package and of the libraries its numbers come from."""
    found = {}
    for package in ("leblanc", "numpy", "scipy"):
        try:
            found[package] = metadata.version(package)
        except metadata.PackageNotFoundError:  # run from a source tree that was never installed
            found[package] = "not installed"
    return found


def models_used(response: Response) -> tuple[str, ...]:
    """Names of the liquid models, in the order in which they appear over speed."""
    return tuple(dict.fromkeys(response.model.tolist()))


def peak(deflection: NDArray[np.complex128]) -> int | None:
    """Index of the largest deflection, the first of equals; None if there is no finite one.

    Parameters
    ----------
    deflection : complex, nan where nothing was found, m, shape (n,)
    """
    size = np.abs(deflection)
    known = np.isfinite(size)
    return int(np.argmax(np.where(known, size, -1.0))) if known.any() else None
