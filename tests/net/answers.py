"""What is held of a command: exit code, what it printed, names and contents of the files it wrote."""

from __future__ import annotations

import json
import lzma
import re
from pathlib import Path
from typing import Any

from tests.net.call import Called, call
from tests.net.cases import Case

# Keys whose values are prose, or belong to the machine or the moment: held by key and type.
PROSE = {
    *("notes", "note", "reason", "reasons", "meaning", "better", "model_reason", "recommendation", "remark"),
    *("digest", "versions", "wall_time"),
}

Answer = dict[str, Any]


def answer(case: Case, folder: Path) -> Answer:
    """Run the command of a case and take down what is held of it.

    Parameters
    ----------
    case : the command
    folder : the present one, which holds the inputs and nothing else
    """
    before = set(_files(folder))
    called = call(case.argv)
    return {
        "argv": list(case.argv),
        "code": called.code,
        "stdout": _printed(case, called),
        "stderr": [_field(line) for line in called.stderr.splitlines()] if called.code in (2, 3) else None,
        "files": {name: "written" for name in _files(folder) if name not in before},
        "data": _data(folder, before, case.measured) if "--json" in case.argv else {},
    }


def _printed(case: Case, called: Called) -> Any:
    """The JSON object without its prose; of a help page the options; of words only whether there are any."""
    if "--json" in case.argv and called.stdout:
        return plain(json.loads(called.stdout), case.measured)
    if "--help" in case.argv:
        return sorted(set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", called.stdout)))
    return bool(called.stdout)


def plain(value: Any, measured: frozenset[str] = frozenset()) -> Any:
    """The same with prose replaced by its type.

    Parameters
    ----------
    value : of JSON
    measured : keys that are held by type as well

    Returns
    -------
    numbers, truth values and None as they are; strings without white space, such as the name of a model, too;
    others and the values of `PROSE` as "<type>"
    """
    if isinstance(value, dict):
        loose = PROSE | measured
        return {key: kind(entry) if key in loose else plain(entry, measured) for key, entry in value.items()}
    if isinstance(value, list):
        return [plain(entry, measured) for entry in value]
    if isinstance(value, str) and re.search(r"\s|^$|^<", value):
        return "<str>"
    return value


def kind(value: Any) -> str:
    """Type of a value of JSON; a number is a number, with a point or without."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        return "<number>"
    return f"<{type(value).__name__}>"


def _field(line: str) -> str:
    """Beginning of a line on stderr, up to the field: what names the fault, without its words."""
    found = re.match(r"(.*?)(?: = |: must )", line)
    return found[1] if found else line.split(": ")[0]


def _files(folder: Path) -> list[str]:
    """Names below a folder, sorted; a zarr store counts as one file, the folder's own record as none.

    States held in time have names that go with the sources and the versions of libraries: they count as one.
    """
    names = set()
    for path in folder.rglob("*"):
        parts = path.relative_to(folder).parts
        store = next((k for k, part in enumerate(parts) if part.endswith(".zarr")), None)
        if store is not None:
            names.add("/".join(parts[: store + 1]) + "/")
        elif parts[-2:-1] == ("held",):
            names.add("/".join((*parts[:-1], "*")))
        elif not path.is_dir() and path.name != "contents.json":
            names.add("/".join(parts))
    return sorted(names)


def _data(folder: Path, before: set[str], measured: frozenset[str]) -> dict[str, Any]:
    """Variables of the netCDF files and zarr stores that are new; of what is measured the type."""
    readers = {".nc": _netcdf, ".zarr/": _zarr}
    return {
        name: _held(reader(folder / name), measured)
        for name in _files(folder)
        if name not in before
        for ending, reader in readers.items()
        if name.endswith(ending)
    }


def _held(data: dict[str, Any], measured: frozenset[str]) -> dict[str, Any]:
    """The same with the values of what a machine measures replaced."""
    for name in (measured | {"wall_time"}) & data["variables"].keys():
        data["variables"][name]["values"] = kind(data["variables"][name]["values"])
    return data


def _netcdf(path: Path) -> dict[str, Any]:
    """Variables of a netCDF file as they stand in it; the names of its attributes."""
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf", decode_cf=False) as data:
        variables = {
            str(name): _variable(v.dims, v.dtype, v.attrs.get("units"), v.values)
            for name, v in data.variables.items()
        }
        # What was typed stands in a test of its own.
        attributes = {*map(str, data.attrs)} - {"machine_file", "study_file", "command"}
        return {"variables": variables, "attributes": sorted(attributes)}


def _zarr(path: Path) -> dict[str, Any]:
    """Arrays of a zarr store as they stand in it; the names of its attributes."""
    import numpy as np
    import zarr

    store = zarr.open_group(path, mode="r")
    arrays = {
        name: _variable(
            getattr(array.metadata, "dimension_names", None) or (),
            array.dtype,
            array.attrs.get("units"),
            np.asarray(array[...]),
        )
        for name, array in sorted(store.arrays())
    }
    return {"variables": arrays, "attributes": sorted(store.attrs)}


def _variable(dims: Any, dtype: Any, units: Any, values: Any) -> dict[str, Any]:
    """One variable in what JSON knows; its prose replaced."""
    import numpy as np

    if np.iscomplexobj(values):
        values = np.stack([values.real, values.imag], axis=-1)
    # Texts have the same type whatever library wrote them.
    kept = str(dtype) if np.dtype(dtype).kind in "biufc" else "text"
    return {"dims": list(dims), "dtype": kept, "units": units, "values": plain(values.tolist())}


def write(path: Path, found: Answer) -> None:
    """Keep an answer. The same answer gives the same bytes."""
    text = json.dumps(found, separators=(",", ":"), sort_keys=True)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(lzma.compress(text.encode(), preset=9))


def read(path: Path) -> Answer:
    """An answer that was kept."""
    kept: Answer = json.loads(lzma.decompress(path.read_bytes()))
    return kept
