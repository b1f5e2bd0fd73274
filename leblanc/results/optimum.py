"""What `optimise` writes for other programs: the dataset and the JSON object."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.results.netcdf import dataset, flags, write_dataset
from leblanc.results.netcdf import variable as var
from leblanc.results.provenance import one_line, versions
from leblanc.studies.optimise.closed_form import Covering
from leblanc.studies.optimise.front import Front
from leblanc.studies.optimise.optimise import OptimumRecord


def write_optimum(record: OptimumRecord, path: Path) -> None:
    """Write all volumes that were judged as netCDF 4, dimensions `candidate` and `chamber`.

    Parameters
    ----------
    record : the optimum
    path : the file to write or replace
    """
    over, judged = ("candidate",), record.judged
    count = record.volume.size
    columns = {
        "volume": var(("candidate", "chamber"), record.points, "m3", "volume of liquid"),
        "objective": var(over, judged.objective, record.unit, "objective", record.meaning),
        "excess": var(
            over, judged.excess, "1", "excess", "of the constraint exceeded most; 0 or below: none is"
        ),
        "best_volume": var(("chamber",), record.volume, "m3", "best volume"),
    }
    sure = judged.details["sure"]
    columns["sure"] = flags(over, sure, "no yes", "sure", "else the vibration is an estimate from below")
    for name in ("vibration", "mass"):
        unit = "m" if name == "vibration" else "kg"
        columns[name] = var(over, judged.details[name], unit, name)
    if record.front is not None:
        along = ("front",)
        columns |= {
            "front_volume": var(("front", "chamber"), record.front.volume, "m3", "volume on the front"),
            "front_vibration": var(along, record.front.vibration, "m", "vibration on the front"),
            "front_mass": var(along, record.front.mass, "kg", "mass of liquid on the front"),
            "front_margin": var(along, record.front.margin, "s-1", "stability margin on the front"),
        }
    coords = {
        "candidate": var(over, np.arange(record.points.shape[0], dtype=np.int32), "1", "candidate"),
        "chamber": var(("chamber",), np.arange(1, count + 1, dtype=np.int32), "1", "chamber"),
    }
    write_dataset(dataset(columns, coords, _attributes(record)), path)


def _attributes(record: OptimumRecord) -> dict[str, Any]:
    """Scene, what was asked for, versions."""
    scene = record.scene
    return {
        "title": one_line(scene.name),
        "source": one_line(scene.source) or "not stated",
        "digest": scene.digest,
        "assumed": "; ".join(map(one_line, scene.assumed)) or "nothing",
        "objective": record.objective,
        "meaning": record.meaning,
        "value": record.value,
        "baseline": record.baseline,
        "feasible": "yes" if record.feasible else "no",
        "notes": "\n".join(map(one_line, record.notes)) or "none",
        "history": "written by leblanc optimise",
        **{f"version_{package}": version for package, version in versions().items()},
    }


def optimum_json(record: OptimumRecord) -> dict[str, Any]:
    """What `optimise` prints for scripts, SI.

    Parameters
    ----------
    record : the optimum

    Returns
    -------
    Arrays and numbers for `leblanc.cli.output.print_json`
    """
    front = record.front
    points = [] if front is None else _points(front)
    return {
        "objective": record.objective,
        "volume": record.volume,
        "value": record.value,
        "baseline": record.baseline,
        "feasible": record.feasible,
        "constraints": {
            name: {
                "limit": one.limit,
                "value": one.value,
                "satisfied": one.satisfied,
                "unit": one.unit,
                "meaning": one.text,
            }
            for name, one in record.constraints.items()
        },
        "evaluations": record.evaluations,
        **({} if record.emulated is None else {"emulator": record.emulated}),
        "unit": record.unit,
        "meaning": record.meaning,
        "working_speed": record.working_speed,
        "vibration": record.vibration,
        "vibration_baseline": record.vibration_baseline,
        "mass": record.mass,
        "stability_margin": -record.growth,
        "closed_form": [_closed_form(one) for one in record.covering],
        "pareto": points,
        "name": record.scene.name,
        "digest": record.scene.digest,
        "assumed": record.scene.assumed,
        "notes": record.notes,
    }


def _closed_form(one: Covering) -> dict[str, float | None]:
    """The covering volumes of one chamber."""
    return {
        "deflection": one.deflection,
        "speed": one.speed,
        "optimal_volume": one.optimal_volume,
        "full_volume": one.full_volume if math.isfinite(one.full_volume) else None,
        "unbalance_share": one.share,
    }


def _points(front: Front) -> list[dict[str, Any]]:
    """Points of the front."""
    return [
        {
            "volume": front.volume[k],
            "vibration": front.vibration[k],
            "mass": front.mass[k],
            "stability_margin": front.margin[k],
        }
        for k in range(front.mass.size)
    ]
