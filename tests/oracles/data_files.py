"""Data files by another writer: xarray with h5netcdf."""

from __future__ import annotations

from pathlib import Path

import xarray as xr

from leblanc.core.netcdf import NamedArrays, write_netcdf


def assert_read_back(found: NamedArrays, path: Path) -> None:
    """Xarray reads the dataset, and without decoding the very variables that it writes itself."""
    ours, theirs = path / "ours.nc", path / "theirs.nc"
    write_netcdf(found, ours)
    data = found.to_dataset()
    data.to_netcdf(theirs, engine="h5netcdf")
    with xr.open_dataset(ours, engine="h5netcdf", decode_timedelta=False) as read:
        xr.testing.assert_identical(read.load(), data)
        assert {name: list(one.attrs) for name, one in read.variables.items()} == {
            name: list(one.attrs) for name, one in data.variables.items()
        }
    with (
        xr.open_dataset(ours, engine="h5netcdf", decode_cf=False) as raw,
        xr.open_dataset(theirs, engine="h5netcdf", decode_cf=False) as expected,
    ):
        xr.testing.assert_identical(raw.load(), expected.load())
        assert {name: one.dtype for name, one in raw.variables.items()} == {
            name: one.dtype for name, one in expected.variables.items()
        }
