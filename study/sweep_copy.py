"""A copy of a sweep's store as one netCDF file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from study.netcdf import dataset, variable, write_dataset
from study.sweep_store import Store

_SINGLE = ("units", "long_name")


def write_copy(store: Store, path: Path) -> None:
    """Write the whole store as netCDF 4; it passes through the memory as a whole.

    Parameters
    ----------
    store : to be copied
    path : the file to write or replace
    """
    found = {}
    for name in store.arrays:
        values, said = store.read(name), store.attributes(name)
        one = variable(store.dims(name), values, *(str(said.pop(key)) for key in _SINGLE))
        if "flag_values" in said:
            said["flag_values"] = np.array(said["flag_values"], dtype=np.int8)
        one.attrs.update(said)
        found[name] = one
    speed = found.pop("speed")
    write_dataset(dataset(found, coords={"speed": speed}, attrs=store.attributes()), path)
