"""Datasets with units and their files, whole or not there: the only door to xarray."""

from __future__ import annotations

import os
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    import xarray as xr

    Variable = xr.Variable
    Dataset = xr.Dataset


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


def variable(dims: tuple[str, ...], values: Any, units: str, long_name: str, text: str = "") -> Variable:
    """Variable with what a reader needs to use it.

    Parameters
    ----------
    dims : names of its dimensions
    values : of it
    units, long_name : as CF asks
    text : description, if there is more to say
    """
    import xarray as xr

    said = {"description": text} if text else {}
    return xr.Variable(dims, values, {"units": units, "long_name": long_name} | said)


def flags(dims: tuple[str, ...], values: NDArray[Any], meanings: str, name: str, text: str = "") -> Variable:
    """Variable that stores one of a few states as a byte; the last of the meanings has the value 1.

    Parameters
    ----------
    dims, values, text : as for `variable`
    meanings : words for the states, in the order of their values
    name : long name
    """
    found = variable(dims, values.astype(np.int8), "1", name, text)
    found.attrs["flag_values"] = np.arange(2 - len(meanings.split()), 2, dtype=np.int8)
    found.attrs["flag_meanings"] = meanings
    return found


def dataset(
    variables: Mapping[str, Variable], coords: Mapping[str, Variable], attrs: Mapping[str, Any]
) -> Dataset:
    """Dataset of variables over their coordinates.

    Parameters
    ----------
    variables, coords : by name
    attrs : of the whole
    """
    import xarray as xr

    return xr.Dataset(dict(variables), coords=dict(coords), attrs={"Conventions": "CF-1.11"} | dict(attrs))


def write_dataset(found: Dataset, path: Path) -> None:
    """Write a dataset as netCDF 4.

    Parameters
    ----------
    found : from `dataset`
    path : the file to write or replace; an interrupted run leaves the old one whole
    """
    with replacing(path) as temporary:
        found.to_netcdf(temporary, engine="h5netcdf")
