"""Arrays with names, dimensions and units: in memory, for JSON, as an xarray dataset, as a netCDF file.

To import xarray, with pandas and dask, takes longer than most answers, so results are kept and written
without it. This is the only door to xarray, and to h5netcdf, which writes the files.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.files import writing
from leblanc.core.units import with_peak
from meshes.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

    Dataset = xr.Dataset

ASIDE = "answer"  # group of what a file holds besides its arrays


@dataclass(frozen=True)
class Variable:
    """An array with names for its dimensions and with what a reader needs to use it.

    Raises
    ------
    InputError : another number of names, values that netCDF does not know
    """

    dims: tuple[str, ...]  #: a name for each dimension
    values: NDArray[Any]  #: real numbers or texts
    attrs: dict[str, Any]  #: units, long name and what else there is to say

    def __post_init__(self) -> None:
        if self.values.ndim != len(self.dims):
            raise InputError("dims", ", ".join(self.dims), f"{self.values.ndim} names")
        if self.values.dtype.kind not in "iufUO":
            raise InputError("values", str(self.values.dtype), "real numbers or texts")


@dataclass(frozen=True)
class NamedArrays:
    """Variables over their coordinates.

    Raises
    ------
    InputError : variables differ in the length of a dimension
    """

    variables: Mapping[str, Variable]  #: by name
    coords: Mapping[str, Variable]
    attrs: Mapping[str, Any]  #: of the whole

    def __post_init__(self) -> None:
        object.__setattr__(self, "attrs", {"Conventions": "CF-1.11", **self.attrs})
        sizes = self.sizes
        for name, array in self.arrays.items():
            for dim, length in zip(array.dims, array.values.shape, strict=True):
                if length != sizes[dim]:
                    raise InputError(name, f"{length} along {dim}", f"{sizes[dim]}, as another variable has")

    @property
    def arrays(self) -> dict[str, Variable]:
        """Coordinates and variables by name."""
        return {**self.coords, **self.variables}

    @property
    def sizes(self) -> dict[str, int]:
        """Lengths of the dimensions."""
        return {
            dim: length
            for array in self.arrays.values()
            for dim, length in zip(array.dims, array.values.shape, strict=True)
        }

    def to_dataset(self) -> Dataset:
        """The same as an xarray dataset."""
        import xarray as xr

        variables, coords = (
            {name: xr.Variable(array.dims, array.values, array.attrs) for name, array in part.items()}
            for part in (self.variables, self.coords)
        )
        return xr.Dataset(variables, coords=coords, attrs=self.attrs)


def variable(dims: tuple[str, ...], values: Any, units: str, long_name: str, text: str = "") -> Variable:
    """Variable with what a reader needs to use it: units and long name as CF asks, a description."""
    text = with_peak(units, long_name, text)
    said = {"description": text} if text else {}
    return Variable(dims, np.asarray(values), {"units": units, "long_name": long_name} | said)


def flags(dims: tuple[str, ...], values: NDArray[Any], meanings: str, name: str, text: str = "") -> Variable:
    """Variable of a few states, stored as bytes; the last of the names in `meanings` has the value 1."""
    found = variable(dims, values.astype(np.int8), "1", name, text)
    found.attrs["flag_values"] = np.arange(2 - len(meanings.split()), 2, dtype=np.int8)
    found.attrs["flag_meanings"] = meanings
    return found


def finite(values: NDArray[Any]) -> list[Any]:
    """Nested lists, None in place of what is not finite, complex numbers as [re, im]."""
    known = np.isfinite(values)
    if np.iscomplexobj(values):
        values, known = np.stack([values.real, values.imag], axis=-1), np.stack([known, known], axis=-1)
    if known.all():
        return list(values.tolist())
    found: list[Any] = np.where(known, values, np.array(None)).tolist()
    return found


def write_netcdf(found: NamedArrays, path: Path, aside: bytes = b"") -> None:
    """Write named arrays as netCDF 4, the file that xarray would write of their dataset.

    What stands `aside` is in a group of its own, which a reader of the arrays does not meet. An interrupted
    run and a full disk leave the old file whole; the OSError carries the path.
    """
    content = _content(found, aside)
    with writing(path) as temporary:
        temporary.write_bytes(content)


def _content(found: NamedArrays, aside: bytes) -> bytes:
    """The file, in memory: on a full disk HDF5 does not come back from closing a file."""
    import h5netcdf
    import h5py

    held, memory = _held_by(found), BytesIO()
    with h5netcdf.File(memory, "w") as file:
        file.attrs.update({**found.attrs, **held.get("", {})})
        file.dimensions = found.sizes
        for name, entry in found.arrays.items():
            texts, missing = entry.values.dtype.kind in "UO", entry.values.dtype.kind == "f"
            stored = file.create_variable(
                name,
                entry.dims,
                h5py.string_dtype() if texts else entry.values.dtype,
                data=entry.values.astype(object) if texts else entry.values,
                fillvalue=np.nan if missing else None,
            )
            stored.attrs.update({**entry.attrs, **held.get(name, {})})
        if aside:
            group, content = file.create_group(ASIDE), np.frombuffer(aside, np.uint8)
            group.dimensions = {"byte": content.size}
            group.create_variable("content", ("byte",), np.uint8, data=content)
    return memory.getvalue()


def read_values(path: Path) -> dict[str, NDArray[Any]]:
    """Values of all variables of a file, by name.

    An `InputError` refuses what is no netCDF 4, or was cut or damaged in what HDF5 checks.
    """
    import h5netcdf

    try:
        with h5netcdf.File(path, "r") as file:
            return {name: np.asarray(entry[...]) for name, entry in file.variables.items()}
    except Exception as error:  # whatever HDF5 and h5netcdf make of other bytes than were written
        raise InputError("file", str(path), "a netCDF 4 file, undamaged") from error


def read_aside(path: Path) -> bytes | None:
    """What stands aside in a file, None where nothing does; an `InputError` as of `read_values`."""
    import h5netcdf

    try:
        with h5netcdf.File(path, "r") as file:
            return np.asarray(file[ASIDE]["content"][...]).tobytes() if ASIDE in file.groups else None
    except Exception as error:
        raise InputError("file", str(path), "a netCDF 4 file, undamaged") from error


def _held_by(found: NamedArrays) -> dict[str, dict[str, str]]:
    """Attributes that name the coordinates which are no dimensions: of the whole under ""."""
    others = {
        name: set(array.dims) for name, array in sorted(found.coords.items()) if name not in found.sizes
    }
    held = {}
    for name, array in found.arrays.items():
        names = [other for other, dims in others.items() if dims <= set(array.dims)]
        if names and name not in others and name not in array.dims:
            held[name] = " ".join(names)
    left = [other for other in others if not any(other in names.split() for names in held.values())]
    return {name: {"coordinates": names} for name, names in ({"": " ".join(left)} | held).items() if names}
