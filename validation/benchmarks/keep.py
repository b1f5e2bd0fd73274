"""The run of the benchmarks that is kept with the package: `results.json` beside this module."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from importlib import resources
from pathlib import Path
from typing import Any

from validation.benchmarks.growth import Growth
from validation.benchmarks.report import Results
from validation.benchmarks.table import Section
from validation.benchmarks.timing import Sample

_FILE = "results.json"


def keep(results: Results, folder: Path | None = None) -> Path:
    """Write a run so that any JSON reader takes it: null for what is not a number.

    Parameters
    ----------
    results : of all codes side by side
    folder : where to; None: beside this module

    Returns
    -------
    The file
    """
    file = (folder or Path(__file__).parent) / _FILE
    text = json.dumps(_without_nan(asdict(results)), indent=1, allow_nan=False)
    file.write_text(text + "\n", encoding="utf-8")
    return file


def kept_results(folder: Path | None = None) -> Results:
    """Read a run that was kept.

    Parameters
    ----------
    folder : see `keep`
    """
    place = resources.files("validation.benchmarks") if folder is None else folder
    found: dict[str, Any] = json.loads(place.joinpath(_FILE).read_text(encoding="utf-8"))
    sections = []
    for one in found["sections"]:
        samples = tuple(Sample(**_with_nan(row)) for row in one["samples"])
        sections.append(Section(**(one | {"samples": samples, "missing": tuple(one["missing"])})))
    grown = {name: [Growth(**one) for one in found[name]] for name in ("over_cells", "over_speeds")}
    return Results(**(found | {"sections": sections} | grown))


def _without_nan(value: Any) -> Any:
    if isinstance(value, dict):
        return {key: _without_nan(one) for key, one in value.items()}
    if isinstance(value, list | tuple):
        return [_without_nan(one) for one in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _with_nan(row: dict[str, Any]) -> dict[str, Any]:
    return {key: math.nan if value is None else value for key, value in row.items()}
