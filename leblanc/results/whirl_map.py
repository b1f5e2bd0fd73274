"""What `map` writes for other programs: the dataset and the JSON object."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from leblanc.results.netcdf import dataset, flags, write_dataset
from leblanc.results.netcdf import variable as var
from leblanc.results.provenance import one_line, versions
from leblanc.studies.whirl_map import StabilityRecord


def write_map(record: StabilityRecord, path: Path) -> None:
    """Write a stability map as netCDF 4, dimensions `volume`, `speed` and `band`.

    Truth values are bytes with `flag_meanings`; volumes with fewer bands than others have nan in `edge_low`
    and `edge_high`.

    Parameters
    ----------
    record : the map
    path : the file to write or replace
    """
    over, bands = ("volume", "speed"), max(map(len, record.edges), default=0)
    ends = np.full((record.volume.size, bands, 2), np.nan)
    for row, found in zip(ends, record.edges, strict=True):
        row[: len(found)] = np.reshape(found, (len(found), 2))

    mode = "of the whirl that grows most"
    held = flags(over, record.in_range, "no yes", "in range", "the plane layer holds there")
    edge = "of a band in which a whirl grows; the ends of the range of speeds count as edges"
    whole = dataset(
        {
            "growth": var(over, record.growth, "s-1", "growth rate", f"{mode}; above 0 unstable"),
            "whirl_speed": var(over, record.whirl_speed, "rad s-1", "whirl speed", f"{mode}, in space"),
            "in_range": held,
            "edge_low": var(("volume", "band"), ends[..., 0], "rad s-1", "lower edge", edge),
            "edge_high": var(("volume", "band"), ends[..., 1], "rad s-1", "upper edge", edge),
        },
        coords={
            "speed": var(("speed",), record.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
            "volume": var(("volume",), record.volume, "m3", "volume", "of liquid in all chambers together"),
        },
        attrs=_attributes(record),
    )
    write_dataset(whole, path)


def _attributes(record: StabilityRecord) -> dict[str, str]:
    """Scene, model and versions."""
    return {
        "title": one_line(record.name),
        "source": one_line(record.source) or "not stated",
        "digest": record.digest,
        "assumed": "; ".join(map(one_line, record.assumed)) or "nothing",
        "friction": record.friction,
        "damping": record.damping,
        "notes": "\n".join(map(one_line, record.notes)) or "none",
        "history": "written by leblanc map",
        **{f"version_{package}": version for package, version in versions().items()},
    }


def map_json(record: StabilityRecord) -> dict[str, Any]:
    """What `map` prints for scripts, SI: rows of `growth`, `whirl_speed` and `in_range` follow `volume`."""
    names = ["speed", "volume", "growth", "whirl_speed", "edges", "in_range", "friction", "damping"]
    names += ["scene_volume", "scene_edges", "name", "digest", "assumed", "notes"]
    return {name: getattr(record, name) for name in names}
