"""What `run` writes for other programs: the dataset and the JSON object."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.results.netcdf import dataset, flags
from leblanc.results.netcdf import variable as var
from leblanc.results.provenance import one_line, versions
from leblanc.results.record import ChamberRecord as ChamberRecord
from leblanc.results.record import StudyRecord as StudyRecord
from leblanc.results.record import models_used, phase

if TYPE_CHECKING:
    from leblanc.results.netcdf import Dataset, Variable

SCALARS = ("liquid_mass", "critical_speed_dry", "critical_speed_wet", "capture_speed")
STATES = ("dry_patch", "stable", "model", "in_range", "converged")  # over speed


def _pair(name: str, dims: tuple[str, ...], values: NDArray[Any], long_name: str) -> dict[str, Variable]:
    """Real and imaginary part of a deflection, both nan where one is."""
    values = np.where(np.isnan(values), complex(np.nan, np.nan), values)
    return {
        f"{name}_real": var(dims, values.real, "m", f"{long_name}, real part", "along the unbalance"),
        f"{name}_imag": var(dims, values.imag, "m", f"{long_name}, imaginary part", "90 deg ahead of it"),
    }


def _variables(record: StudyRecord) -> dict[str, Variable]:
    """Variables of the dataset by name."""
    r, over, each, rate = record.response, ("speed",), ("speed", "branch"), "rad s-1"
    states = np.where(np.isnan(r.branch_deflection), -1, r.branch_stable)
    mass, dry, wet, capture = (np.array(getattr(record, name), dtype=np.float64) for name in SCALARS)
    lag, slow = "from the unbalance, positive with the spin, a lag is negative", "against slow disturbances"
    return {
        "amplitude": var(over, record.amplitude, "m", "amplitude", "of the branch reported"),
        "amplitude_dry": var(over, record.amplitude_dry, "m", "amplitude", "without liquid"),
        "phase": var(over, phase(r.deflection), "rad", "phase of the deflection", lag),
        "phase_dry": var(over, phase(r.deflection_dry), "rad", "phase without liquid", lag),
        **_pair("deflection", over, r.deflection, "deflection of the branch reported"),
        **_pair("deflection_dry", over, r.deflection_dry, "deflection without liquid"),
        "liquid_offset": var(over, r.liquid_offset, "m", "liquid offset", "rotation axis to centre of mass"),
        "liquid_angle": var(over, r.liquid_angle, "rad", "angle of the liquid's centre of mass", lag),
        "dry_patch": flags(over, r.dry_patch, "no yes", "dry patch", "the wall is dry somewhere"),
        "stable": flags(over, r.stable, "no yes", "the branch reported is stable", f"{slow} and whirls"),
        "model": var(over, r.model, "1", "liquid model", "used at this speed"),
        "in_range": flags(over, r.in_range, "no yes", "in range", "the liquid model holds there"),
        "converged": flags(over, r.converged, "no yes", "converged", "every branch was found"),
        **_pair("branch", each, r.branch_deflection, "deflection of every branch"),
        "branch_stable": flags(each, states, "absent unstable stable", "stability of every branch", slow),
        "liquid_mass": var((), mass, "kg", "liquid mass", "of all chambers"),
        "critical_speed_dry": var((), dry, rate, "critical speed without liquid", "undamped"),
        "critical_speed_wet": var((), wet, rate, "critical speed with liquid", "undamped, wall wet"),
        "capture_speed": var((), capture, rate, "capture speed", "the liquid rides with the drum above it"),
        **_error_variables(record),
        **_motion_variables(record),
        **_whirl_variables(record),
    }


def _error_variables(record: StudyRecord) -> dict[str, Variable]:
    """Estimated error over speed."""
    if record.error_estimate is None:
        return {}
    text = "relative, of amplitude and liquid the larger one"
    return {"error_estimate": var(("speed",), record.error_estimate, "1", "estimated error", text)}


def _whirl_variables(record: StudyRecord) -> dict[str, Variable]:
    """Self-excited whirl over speed."""
    if record.whirl is None:
        return {}
    most, over = "of the whirl that grows most", ("speed",)
    return {
        "growth": var(over, record.whirl.growth, "s-1", "growth rate", f"{most}; above 0 unstable"),
        "whirl_speed": var(over, record.whirl.whirl_speed, "rad s-1", "whirl speed", f"{most}, in space"),
    }


def _motion_variables(record: StudyRecord) -> dict[str, Variable]:
    """What a rotor that is not planar adds; dimensions `mode` and `chamber` besides those of all records."""
    motion, over, each, rate = record.motion, ("speed",), ("speed", "branch"), "rad s-1"
    if motion is None:
        return {}
    c, against = motion.campbell, "turning against the spin"
    by_spin = ("spin", "mode")
    at_rest = np.array([(one.frequency, one.damping_ratio) for one in motion.modes]).reshape(-1, 2)
    sense = "-1 against the spin to 1 with it"
    return {
        **_pair("backward", over, motion.backward, f"part of the deflection {against}"),
        **_pair("backward_dry", over, motion.backward_dry, f"part {against}, without liquid"),
        **_pair("branch_backward", each, motion.branch_backward, f"part of every branch {against}"),
        **_pair("chamber", ("speed", "chamber"), motion.chamber_forward, "deflection at each chamber"),
        "position": var((), motion.position, "m", "position", "of the plane reported, along the axis"),
        "spin": var(("spin",), c.spin, rate, "spin speed", "of the Campbell diagram"),
        "campbell_frequency": var(by_spin, c.frequency, rate, "natural frequency", "damped, without liquid"),
        "campbell_damping_ratio": var(by_spin, c.damping_ratio, "1", "damping ratio", "without liquid"),
        "campbell_direction": var(by_spin, c.direction, "1", "direction of the whirl", sense),
        "natural_frequency": var(("rest_mode",), at_rest[:, 0], rate, "natural frequency", "at rest, dry"),
        "natural_damping_ratio": var(("rest_mode",), at_rest[:, 1], "1", "damping ratio", "at rest, dry"),
    }


def to_dataset(record: StudyRecord) -> Dataset:
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
    speed, branches = record.response.speed, record.response.branch_deflection.shape[1]
    rank = np.arange(branches, dtype=np.int32)
    return dataset(
        _variables(record),
        coords={
            "speed": var(("speed",), speed, "rad s-1", "spin speed", "of the rotor about its axis"),
            "branch": var(("branch",), rank, "1", "branch", "rank by rising amplitude"),
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
            "history": "written by leblanc run",
            **{f"version_{package}": version for package, version in versions().items()},
        },
    )


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
        "amplitude": _finite(record.amplitude),
        "amplitude_dry": _finite(record.amplitude_dry),
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
        **({} if record.error_estimate is None else {"error_estimate": _finite(record.error_estimate)}),
        **_motion_json(record),
        **_whirl_json(record),
    }


def _whirl_json(record: StudyRecord) -> dict[str, Any]:
    """Self-excited whirl over speed, and the bands of speed in which it grows."""
    if record.whirl is None:
        return {}
    return {
        "growth": _finite(record.whirl.growth),
        "whirl_speed": _finite(record.whirl.whirl_speed),
        "whirl_bands": [list(band) for band in record.whirl.bands],
    }


def _motion_json(record: StudyRecord) -> dict[str, Any]:
    """What a rotor that is not planar adds; critical speeds as [rad/s, direction of the whirl]."""
    motion = record.motion
    if motion is None:
        return {}
    return {
        "position": motion.position,
        "backward": _finite(motion.backward),
        "chamber_deflection": _finite(motion.chamber_forward),
        "natural_frequency": [one.frequency for one in motion.modes],
        "natural_damping_ratio": [one.damping_ratio for one in motion.modes],
        "critical_speeds_dry": [list(one) for one in motion.critical_speeds_dry],
        "critical_speeds_wet": [list(one) for one in motion.critical_speeds_wet],
    }
