"""What `run` writes for other programs: the dataset (the only door to xarray) and the JSON object."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from study.record import ChamberRecord as ChamberRecord  # a record and its files are asked for together
from study.record import StudyRecord as StudyRecord
from study.record import models_used, one_line, phase, versions

if TYPE_CHECKING:
    import xarray as xr

SCALARS = ("liquid_mass", "critical_speed_dry", "critical_speed_wet", "capture_speed")
STATES = ("dry_patch", "stable", "model", "in_range", "converged")  # over speed


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Path to write to instead of `path`; takes its place once all is written, so no reader sees half a file.

    Parameters
    ----------
    path : the file to write; its folder is made if it is missing
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    temporary = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        yield temporary
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def _var(dims: tuple[str, ...], values: Any, units: str, long_name: str, text: str) -> xr.Variable:
    """Variable with what a reader needs to use it."""
    import xarray as xr

    return xr.Variable(dims, values, {"units": units, "long_name": long_name, "description": text})


def _flags(dims: tuple[str, ...], values: NDArray[Any], meanings: str, name: str, text: str) -> xr.Variable:
    """Variable that stores one of a few states as a byte; the last of the meanings has the value 1."""
    variable = _var(dims, values.astype(np.int8), "1", name, text)
    variable.attrs["flag_values"] = np.arange(2 - len(meanings.split()), 2, dtype=np.int8)
    variable.attrs["flag_meanings"] = meanings
    return variable


def _pair(name: str, dims: tuple[str, ...], values: NDArray[Any], long_name: str) -> dict[str, xr.Variable]:
    """Real and imaginary part of a deflection, both nan where one is."""
    values = np.where(np.isnan(values), complex(np.nan, np.nan), values)
    return {
        f"{name}_real": _var(dims, values.real, "m", f"{long_name}, real part", "along the unbalance"),
        f"{name}_imag": _var(dims, values.imag, "m", f"{long_name}, imaginary part", "90 deg ahead of it"),
    }


def _variables(record: StudyRecord) -> dict[str, xr.Variable]:
    """Variables of the dataset by name."""
    r, over, each, rate = record.response, ("speed",), ("speed", "branch"), "rad s-1"
    states = np.where(np.isnan(r.branch_deflection), -1, r.branch_stable)
    mass, dry, wet, capture = (np.array(getattr(record, name), dtype=np.float64) for name in SCALARS)
    lag, slow = "from the unbalance, positive with the spin, a lag is negative", "against slow disturbances"
    return {
        "amplitude": _var(over, np.abs(r.deflection), "m", "amplitude", "of the branch reported"),
        "amplitude_dry": _var(over, np.abs(r.deflection_dry), "m", "amplitude", "without liquid"),
        "phase": _var(over, phase(r.deflection), "rad", "phase of the deflection", lag),
        "phase_dry": _var(over, phase(r.deflection_dry), "rad", "phase without liquid", lag),
        **_pair("deflection", over, r.deflection, "deflection of the branch reported"),
        **_pair("deflection_dry", over, r.deflection_dry, "deflection without liquid"),
        "liquid_offset": _var(over, r.liquid_offset, "m", "liquid offset", "rotation axis to centre of mass"),
        "liquid_angle": _var(over, r.liquid_angle, "rad", "angle of the liquid's centre of mass", lag),
        "dry_patch": _flags(over, r.dry_patch, "no yes", "dry patch", "the wall is dry somewhere"),
        "stable": _flags(over, r.stable, "no yes", "the branch reported is stable", slow),
        "model": _var(over, r.model, "1", "liquid model", "used at this speed"),
        "in_range": _flags(over, r.in_range, "no yes", "in range", "the liquid model holds there"),
        "converged": _flags(over, r.converged, "no yes", "converged", "every branch was found"),
        **_pair("branch", each, r.branch_deflection, "deflection of every branch"),
        "branch_stable": _flags(each, states, "absent unstable stable", "stability of every branch", slow),
        "liquid_mass": _var((), mass, "kg", "liquid mass", "of all chambers"),
        "critical_speed_dry": _var((), dry, rate, "critical speed without liquid", "undamped"),
        "critical_speed_wet": _var((), wet, rate, "critical speed with liquid", "undamped, wall wet"),
        "capture_speed": _var((), capture, rate, "capture speed", "the liquid rides with the drum above it"),
    }


def to_dataset(record: StudyRecord) -> xr.Dataset:
    """Dataset of a study, dimensions `speed` and `branch`.

    netCDF has no complex numbers and no truth values: deflections are pairs `_real`, `_imag`, truth values
    are bytes with `flag_meanings`. There is no time stamp, so one record gives one file, byte for byte, as
    long as the versions of xarray, h5netcdf and HDF5 stay the same.

    Parameters
    ----------
    record : the study

    Returns
    -------
    Variables with `units`, `long_name` and `description`; scene, digest and versions in the attributes.
    """
    import xarray as xr

    speed, branches = record.response.speed, record.response.branch_deflection.shape[1]
    rank = np.arange(branches, dtype=np.int32)
    return xr.Dataset(
        _variables(record),
        coords={
            "speed": _var(("speed",), speed, "rad s-1", "spin speed", "of the rotor about its axis"),
            "branch": _var(("branch",), rank, "1", "branch", "rank by rising amplitude"),
        },
        attrs={
            "title": one_line(record.name),
            "source": one_line(record.source) or "not stated",
            "digest": record.digest,
            "assumed": "; ".join(map(one_line, record.assumed)) or "nothing",
            "inputs": "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in record.inputs),
            "model": ", ".join(models_used(record.response)),
            "axis": record.axis,
            "notes": "\n".join(map(one_line, record.notes)) or "none",
            "Conventions": "CF-1.11",
            "history": "written by leblanc run",
            **{f"version_{package}": version for package, version in versions().items()},
        },
    )


def write_dataset(dataset: xr.Dataset, path: Path) -> None:
    """Write a dataset as netCDF 4.

    Parameters
    ----------
    dataset : from `to_dataset`
    path : the file to write or replace; an interrupted run leaves the old one whole
    """
    with replacing(path) as temporary:
        dataset.to_netcdf(temporary, engine="h5netcdf")


def _finite(values: NDArray[Any]) -> list[Any]:
    """Nested lists, None in place of what is not finite, complex numbers as [re, im]."""
    known = np.isfinite(values)
    if np.iscomplexobj(values):
        values, known = np.stack([values.real, values.imag], axis=-1), np.stack([known, known], axis=-1)
    if known.all():
        return list(values.tolist())
    found: list[Any] = np.where(known, values, np.array(None)).tolist()
    return found


def run_json(record: StudyRecord) -> dict[str, Any]:
    """What `run` prints for scripts: plain Python values, SI, radians, complex numbers as [re, im].

    Parameters
    ----------
    record : the study

    Returns
    -------
    Lists over speed, with None (null) where nothing was found; `branches` has one list for each speed, of
    as many deflections as there are branches.
    """
    r = record.response
    present = ~np.isnan(r.branch_deflection)
    ends = np.cumsum(np.count_nonzero(present, axis=1)).tolist()
    rows = [slice(start, stop) for start, stop in pairwise([0, *ends])]
    branches, branch_stable = _finite(r.branch_deflection[present]), r.branch_stable[present].tolist()
    return {
        "speed": _finite(r.speed),
        "amplitude": _finite(np.abs(r.deflection)),
        "amplitude_dry": _finite(np.abs(r.deflection_dry)),
        "phase": _finite(phase(r.deflection)),
        "liquid_offset": _finite(r.liquid_offset),
        "liquid_angle": _finite(r.liquid_angle),
        **{name: getattr(r, name).tolist() for name in STATES},
        "deflection": _finite(r.deflection),
        "branches": [branches[row] for row in rows],
        "branch_stable": [branch_stable[row] for row in rows],
        **{name: getattr(record, name) for name in ("name", "digest", *SCALARS)},
        "assumed": list(record.assumed),
        "notes": list(record.notes),
    }
