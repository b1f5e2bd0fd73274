"""What `runup` writes for other programs: the dataset and the JSON object."""

from __future__ import annotations

import json
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.friction import friction_words
from leblanc.results.netcdf import dataset, flags, variable, write_dataset
from leblanc.results.provenance import one_line, versions
from leblanc.studies.runup import RunupRecord

Values = NDArray[Any]


def write_runup(record: RunupRecord, path: Path) -> None:
    """Write a run-up as netCDF 4, dimensions `time`, `chamber` and `coordinate`.

    Complex numbers are pairs `_real`, `_imag`, truth values are bytes with `flag_meanings`. The energy audit
    and what else is a single value stand in the attributes.

    Parameters
    ----------
    record : the run-up
    path : the file to write or replace
    """
    columns = _columns(record)
    coords = {name: columns.pop(name) for name in ("time", "chamber")}
    write_dataset(dataset(columns, coords, _attributes(record)), path)


def _columns(record: RunupRecord) -> dict[str, Any]:
    """Variables by name."""
    h, over = record.history, ("time",)
    count = len(record.chambers)

    def each(values: Values, unit: str, text: str) -> Any:
        return variable(("time", "chamber"), values[:, :count], unit, text)

    drum = "in the drum frame, from its zero mark, positive with the spin"
    here = "liquid's centre of mass from the axis"
    held = "the liquid rides with the drum as a layer"
    columns = {
        "time": variable(over, h.time, "s", "time"),
        "chamber": variable(("chamber",), np.arange(1, count + 1, dtype=np.int32), "1", "chamber"),
        "speed": variable(over, h.speed, "rad s-1", "spin speed"),
        "angle": variable(over, h.angle, "rad", "angle of rotation"),
        "amplitude": variable(over, h.amplitude, "m", "deflection of the first chamber's axis, modulus"),
        "phase": variable(over, record.phase, "rad", f"angle of that deflection {drum}"),
        "liquid_offset": variable(over, np.abs(h.liquid_position), "m", here),
        "liquid_angle": variable(over, np.angle(h.liquid_position), "rad", f"angle of that place {drum}"),
        "in_range": flags(over, record.in_range, "no yes", "the layer is a fair picture of the liquid"),
        "coordinates": variable(("time", "coordinate"), h.coordinates, "1", "of the rotor, m or rad"),
        "captured": flags(("time", "chamber"), h.captured[:, :count], "no yes", held),
        "depth_min": each(h.depth_min, "m", "least depth around the wall"),
        "depth_max": each(h.depth_max, "m", "largest depth around the wall"),
        "mean_rotation": each(h.mean_rotation, "rad s-1", "mean rotation of the liquid in the drum"),
        "layer_mass": variable(("chamber",), h.layer_mass, "kg", "mass of the liquid"),
    }
    for name, values, text in (
        ("deflection", h.deflection, "of the chamber's axis, standing frame"),
        ("offset", h.offset, "of the liquid's centre of mass from its chamber's axis, standing frame"),
    ):
        columns[f"{name}_real"] = each(values.real, "m", f"{name} {text}, first direction")
        columns[f"{name}_imag"] = each(values.imag, "m", f"{name} {text}, second direction")
    return columns


def _attributes(record: RunupRecord) -> dict[str, Any]:
    """Scene, numerics, single results and versions."""
    history, numerics = record.history, record.numerics
    return {
        "title": one_line(record.name),
        "source": one_line(record.source) or "not stated",
        "digest": record.digest,
        "assumed": "; ".join(map(one_line, record.assumed)) or "nothing",
        "inputs": "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in record.inputs),
        "rotor": record.kind,
        "axis": record.axis,
        "friction": friction_words(record.friction),
        "model": record.model,
        "model_reason": one_line(record.model_reason),
        "model_error": record.model_error,
        "cells": np.int32(numerics.cells),
        "dispersion": "with" if numerics.dispersion else "without",
        "energy": json.dumps(_energy(record)),
        "mass_error": history.mass_error,
        "error_estimate": history.error_estimate,
        "steps": np.int64(history.steps),
        "converged": "yes" if history.converged else one_line(f"no: {history.reason}"),
        "notes": "\n".join(map(one_line, record.notes)) or "none",
        "history": "written by leblanc runup",
        **{f"version_{package}": version for package, version in versions().items()},
    }


def _energy(record: RunupRecord) -> dict[str, float]:
    """Terms of the balance, J, what it leaves, and that over the work."""
    audit = record.history.audit
    return asdict(audit) | {"remainder": audit.remainder, "closure": audit.closure}


def _moment(record: RunupRecord, index: int) -> dict[str, float]:
    """Amplitude, speed and time of one sample."""
    h = record.history
    return {
        "amplitude": float(h.amplitude[index]),
        "speed": float(h.speed[index]),
        "time": float(h.time[index]),
    }


def runup_json(record: RunupRecord) -> dict[str, Any]:
    """What `runup` prints for scripts, SI and radians; lists over time, of chambers a list in each of it.

    Parameters
    ----------
    record : the run-up

    Returns
    -------
    Arrays and numbers for `leblanc.cli.output.print_json`
    """
    h, count = record.history, len(record.chambers)
    position, mean = h.liquid_position, record.mean_position
    found: dict[str, Any] = {
        "time": h.time,
        "speed": h.speed,
        "amplitude": h.amplitude,
        "phase": record.phase,
        "liquid_offset": np.abs(position),
        "liquid_angle": np.angle(position),
        "liquid_offset_mean": np.abs(mean),
        "liquid_angle_mean": np.angle(mean),
        "mass_error": h.mass_error,
        "captured": h.captured,
        "in_range": record.in_range,
    }
    found |= {name: getattr(h, name)[:, :count] for name in ("depth_max", "depth_min", "mean_rotation")}
    last = h.time.size - 1
    ends = {"peak": _moment(record, record.peak()), "end": _moment(record, last)}
    if record.turning < last:
        ends["peak_back"] = _moment(record, record.peak(back=True))
    ends["end"] |= {name: float(found[name][-1]) for name in ("phase", "liquid_offset", "liquid_angle")}
    names = ("name", "digest", "assumed", "notes", "bands")
    return (
        found
        | ends
        | {name: getattr(h, name) for name in ("error_estimate", "converged", "reason", "steps")}
        | {"energy": _energy(record), "cells": record.numerics.cells, "model": record.model}
        | {"model_reason": record.model_reason, "model_error": record.model_error}
        | {name: getattr(record, name) for name in names}
    )
