"""The store of a sweep: one dataset in Zarr's third format, filled block by block. The only door to zarr.

A block's chunks are written and brought to the disk before its part of `status`, which marks it as finished:
whatever is killed in between, `status` never promises what is not there. Each file is written whole under
another name and then takes its own. Nothing in the store depends on when, where or by whom it was written.

Every chunk ends with its checksum (the codec crc32c), the attributes of the whole hold those of all metadata.
A store is opened only after all of it was read: a damaged file is refused, a block that lacks one is pending.
"""

from __future__ import annotations

import json
import os
import shutil
import zlib
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import versions
from leblanc.core.netcdf import NamedArrays, variable
from leblanc.core.notes import one_line
from leblanc.scene.schema.load import shown
from leblanc.studies.sweep.block import PENDING, STATUS
from leblanc.studies.sweep.outputs import kind_of
from leblanc.studies.sweep.plan import Sweep, VariedField
from meshes.errors import InputError
from meshes.quantity import Q

STORE = "sweep.zarr"

_MANY = 4096  # samples of a block at most
# Samples of a block at least, and blocks of a sweep as long as they are neither too small nor too large: of
# `run`, and of run-ups, which take some tenths of a second each.
_BLOCKS = {"run": (64, 50), "runup": (4, 1000)}
_ANSWERS = 16_384  # samples times speeds of a block at most
_UNFINISHED = "*.partial"  # what zarr calls a file before it is whole
_METADATA = "zarr.json"
# Attributes of the whole: checksums of the arrays' metadata by name, and that of all other attributes.
_CHECKSUMS, _SEAL = "checksums", "checksum"
_EMPTY = {"float64": np.nan, "int8": -1, "str": ""}  # what stands where there is no answer


@dataclass(frozen=True)
class Store:
    """A store on disk, open for reading and writing."""

    path: Path  #: its folder
    group: Any  #: of zarr
    arrays: Mapping[str, Any]  #: of the group by name
    samples: int  #: in all
    block: int  #: samples of a block, which are those of a chunk
    #: numbers of the blocks that are not finished, or of which a file is missing
    pending: tuple[int, ...] = ()

    def bounds(self, number: int) -> tuple[int, int]:
        """First sample of a block and the one behind its last."""
        return number * self.block, min((number + 1) * self.block, self.samples)

    def attributes(self, name: str | None = None) -> dict[str, Any]:
        """Attributes of a variable, or of the whole, without the store's own checksums."""
        said = dict((self.group if name is None else self.arrays[name]).attrs)
        return {key: value for key, value in said.items() if key not in (_CHECKSUMS, _SEAL)}

    def read(self, name: str, rows: slice = slice(None), columns: slice | None = None) -> NDArray[Any]:
        """Values of a variable, or some rows or columns of them; texts as Python's own."""
        found = np.asarray(self.arrays[name][rows if columns is None else (rows, columns)])
        return found if found.dtype.kind in "fi" else found.astype(object)

    def dims(self, name: str) -> tuple[str, ...]:
        """Names of a variable's dimensions."""
        return tuple(self.arrays[name].metadata.dimension_names)


def block_size(samples: int, speeds: int, command: str = "run") -> int:
    """Samples of a block: of the sweep alone, so that the same sweep has the same chunks everywhere."""
    fewest, blocks = _BLOCKS[command]
    wanted = min(max(samples // blocks, fewest), _MANY)
    return max(1, min(wanted, _ANSWERS // speeds, samples))


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """Keep other processes from writing a store; the lock ends with this process, however it ends."""
    import fcntl

    folder.mkdir(parents=True, exist_ok=True)
    with (folder / ".sweep.lock").open("a") as file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError as error:
            raise InputError("out", str(folder), "a folder in which no other sweep runs") from error
        yield


def open_store(folder: Path, sweep: Sweep, fresh: bool = False) -> Store:
    """The store of a sweep, made if there is none; what a killed run left half written is removed."""
    path, part = folder / STORE, folder / f".{STORE}.part"
    shutil.rmtree(part, ignore_errors=True)
    if fresh and path.exists():
        path.rename(part)  # at once; what is left of it after a kill goes with the next start
        shutil.rmtree(part)
    if not path.exists():
        _create(part, sweep)
        part.rename(path)
        _to_disk(folder)
    for left in path.rglob(_UNFINISHED):
        left.unlink()
    group = _open(path, "r+")
    _same(path, dict(group.attrs), _attributes(sweep))
    return _verified(_store(path, group))


def read_store(path: Path) -> Store:
    """A store for reading; blocks of which a file is missing count as pending."""
    return _verified(_store(path, _open(path, "r")))


def _store(path: Path, group: Any) -> Store:
    import zarr

    with zarr.config.set({"array.write_empty_chunks": True}):  # a missing chunk is always a missing answer
        arrays = {name: group[name] for name in sorted(group.attrs[_CHECKSUMS])}
    status = arrays["status"]
    return Store(path, group, arrays, int(status.shape[0]), int(status.chunks[0]))


def _open(path: Path, mode: str) -> Any:
    """The group of a store whose attributes and metadata are as they were written."""
    import zarr

    if not path.is_dir():
        raise InputError("store", str(path), "the store of a sweep")
    try:
        group = zarr.open_group(path, mode=mode, zarr_format=3)
        said = dict(group.attrs)
    except OSError:
        if (path / _METADATA).is_file():
            raise  # the disk, or a file that may not be read
        raise InputError("store", str(path), "the store of a sweep") from None
    except Exception as error:  # whatever zarr makes of what is no metadata
        raise InputError("store", str(path), "the store of a sweep") from error
    if "digest" in said and _CHECKSUMS not in said:
        allowed = "one with checksums, which older versions did not write; --fresh starts anew"
        raise InputError("store", str(path), allowed)
    if said.get(_SEAL) != _seal(said):
        raise InputError("store", str(path), "the store of a sweep, undamaged; --fresh starts anew")
    for name, checksum in said[_CHECKSUMS].items():
        file = path / name / _METADATA
        if not file.is_file() or _checksum(file.read_bytes()) != checksum:
            raise InputError("store", str(file), "there and undamaged; --fresh starts anew")
    return group


def _checksum(content: bytes) -> str:
    return f"{zlib.crc32(content):08x}"


def _seal(said: Mapping[str, Any]) -> str:
    """Checksum of all attributes but itself."""
    kept = {key: value for key, value in said.items() if key != _SEAL}
    return _checksum(json.dumps(kept, sort_keys=True).encode())


def _verified(store: Store) -> Store:
    """The store with its pending blocks, after every chunk of the others was read."""
    blocks = range(-(-store.samples // store.block))
    status = {number: _chunk(store, "status", number) for number in blocks}
    pending = [number for number, states in status.items() if states is None or PENDING in states]
    pending += [
        number
        for number in sorted(set(blocks).difference(pending))
        if any(_chunk(store, name, number) is None for name in store.arrays)
    ]
    return replace(store, pending=tuple(sorted(pending)))


def _chunk(store: Store, name: str, number: int) -> NDArray[Any] | None:
    """Values of a variable in a block, read from the disk; None where the file is missing."""
    file = _chunk_file(store, name, number)
    if not file.exists():
        return None
    try:
        return store.read(name, slice(*store.bounds(number)))
    except OSError:
        raise
    except Exception as error:  # whatever the codecs make of other bytes than were written
        allowed = "undamaged; without the file its block is answered again, --fresh starts anew"
        raise InputError("store", str(file), allowed) from error


def _chunk_file(store: Store, name: str, number: int) -> Path:
    """Where the values of a variable in a block stand."""
    path = store.path / name / "c" / str(number)
    return path / "0" if len(store.arrays[name].shape) > 1 else path


def _create(path: Path, sweep: Sweep) -> None:
    """A store without any answer."""
    import zarr
    from zarr.codecs import Crc32cCodec, ZstdCodec

    kept = sweep.kept
    samples, speeds = sweep.samples, kept.speeds
    block = block_size(samples, speeds, sweep.command)
    group = zarr.create_group(path, zarr_format=3, attributes=_attributes(sweep))

    def array(name: str, kind: str, over_speed: bool, fill: object, attributes: Mapping[str, Any]) -> None:
        group.create_array(
            name,
            shape=(samples, speeds) if over_speed else (samples,),
            chunks=(block, speeds) if over_speed else (block,),
            dtype=kind,
            fill_value=fill,
            compressors=(ZstdCodec(), Crc32cCodec()),
            dimension_names=("sample", "speed") if over_speed else ("sample",),
            attributes=attributes,
        )

    for name, output in kept.outputs.items():
        kind = kind_of(output)
        array(name, kind, bool(output.over), _EMPTY[kind], _output_attributes(output))
    for field in sweep.fields:
        kind = "str" if field.categorical else "float64"
        said = {"units": field.unit, "long_name": field.path, "description": "varied field of the scene"}
        array(field.path, kind, False, _EMPTY[kind], said)
    states = {"flag_values": list(range(len(STATUS))), "flag_meanings": " ".join(STATUS)}
    array("status", "int8", False, PENDING, {"units": "1", "long_name": "state of the sample"} | states)
    array("reason", "str", False, "", {"units": "1", "long_name": "why the sample is not done"})
    names = sorted(file.parent.name for file in path.glob(f"*/{_METADATA}"))
    found = {name: _checksum((path / name / _METADATA).read_bytes()) for name in names}
    said = dict(group.attrs) | {_CHECKSUMS: found}
    group.attrs.put(said | {_SEAL: _seal(said)})


def _output_attributes(output: Q) -> dict[str, Any]:
    said: dict[str, Any] = {"units": output.unit or "1", "long_name": output.name}
    if output.text:
        said["description"] = output.text
    if output.flags:
        said |= {"flag_values": [-1, 0, 1], "flag_meanings": f"absent {output.flags}"}
    return said


def _attributes(sweep: Sweep) -> dict[str, Any]:
    """What the store says of itself; two runs of one sweep say the same."""
    used = versions(("leblanc", "numpy", "scipy", "zarr"))
    return {
        "Conventions": "CF-1.11",
        "title": one_line(sweep.scene.name),
        "source": one_line(sweep.scene.source) or "not stated",
        "assumed": "; ".join(map(one_line, sweep.scene.assumed)) or "nothing",
        "scene_digest": sweep.scene.digest,
        "digest": sweep.digest,
        "method": sweep.method,
        "points": sweep.points,
        "seed": str(sweep.seed),
        **({} if sweep.command == "run" else {"command": sweep.command}),
        "vary": "\n".join(f"{field.path}: {field.distribution}" for field in sweep.fields),
        "history": "written by leblanc sweep",
        **{f"version_{package}": version for package, version in used.items()},
    }


def _same(path: Path, found: Mapping[str, Any], own: Mapping[str, Any]) -> None:
    """Refuse to go on with what another sweep, or other code, has begun."""
    if found.get("digest") != own["digest"]:
        allowed = "the store of this study and scene, which have changed since; --fresh starts anew"
        allowed += ", --out DIR keeps both"
        raise InputError("store", str(path), allowed)
    for key in own:
        if key.startswith("version_") and found.get(key) != own[key]:
            package = key.removeprefix("version_")
            allowed = f"written with {package} {own[key]}, not {found.get(key)}; --fresh starts anew"
            raise InputError("store", str(path), allowed)


def write_block(
    store: Store, number: int, variables: Mapping[str, NDArray[Any]], status: NDArray[np.int8]
) -> None:
    """Write a finished block, its status last."""
    start, stop = store.bounds(number)
    for name, values in variables.items():
        store.arrays[name][start:stop] = values
    # Files that are asked for together go to the disk together.
    with ThreadPoolExecutor(len(variables)) as pool:
        list(pool.map(_to_disk, (_chunk_file(store, name, number) for name in variables)))
    store.arrays["status"][start:stop] = status
    _to_disk(_chunk_file(store, "status", number))


def _to_disk(path: Path) -> None:
    """Wait until a file or a folder is on the disk."""
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def field_values(field: VariedField, drawn: NDArray[np.float64]) -> NDArray[Any]:
    """Sampled values of a field as the store holds them: SI numbers, or texts."""
    values = [field.value(level) for level in drawn]
    if not field.categorical:
        return np.array(values, dtype=np.float64)
    return np.array([value if isinstance(value, str) else _table(value) for value in values], dtype=object)


def _table(value: object) -> str:
    return json.dumps(value, sort_keys=True) if isinstance(value, dict) else shown(value)


_SINGLE = ("units", "long_name")


def read_arrays(path: Path) -> NamedArrays:
    """The whole store with units, in memory."""
    store, found = read_store(path), {}
    if store.pending:
        allowed = f"one with all blocks; {len(store.pending)} are pending: run the same sweep again"
        raise InputError("store", str(path), allowed)
    for name in store.arrays:
        values, said = store.read(name), store.attributes(name)
        entry = variable(store.dims(name), values, *(str(said.pop(key)) for key in _SINGLE))
        if "flag_values" in said:
            said["flag_values"] = np.array(said["flag_values"], dtype=np.int8)
        entry.attrs.update(said)
        found[name] = entry
    speed = found.pop("speed")
    return NamedArrays(found, coords={"speed": speed}, attrs=store.attributes())
