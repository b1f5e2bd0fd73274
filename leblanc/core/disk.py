"""An answer on disk: its data file, which gives it back, beside the pictures and the report.

A data file may be a stranger's: `opened` makes plain values, and frozen records and states of leblanc and of
the packages that announce something to it, whose fields it sets without a call.
"""

from __future__ import annotations

import json
import lzma
from base64 import b64decode, b64encode
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import MISSING, asdict, fields, is_dataclass, replace
from enum import Enum
from importlib import import_module
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from leblanc.core.answer import Answer, Typed, versions
from leblanc.core.blocks import Picture, flat
from leblanc.core.netcdf import read_aside, write_netcdf
from leblanc.core.quantities import seal
from leblanc.core.question import called
from meshes.errors import InputError

FORMAT = 1  # of what stands aside in a data file: JSON, compressed by xz
_PACKAGES = ("meshes", "fluid", "solvers", "leblanc")
_GROUPS = ("leblanc.commands", "leblanc.liquids", "leblanc.machines")  # entry points of other packages
_MOST = 1 << 30  # bytes of that text
_PLAIN = {each.__name__: each for each in (tuple, list, frozenset, set)}


def write(answer: Answer, folder: Path, machine: Any = None, png: bool = False) -> list[Any]:
    """Data file, pictures and report of an answer, about its machine; the files of the pictures.

    Pictures are drawn as SVG, with `png` as PNG as well.
    """
    if answer.data:
        save(answer, folder / answer.data)
    pictures = (block for block in flat(answer.blocks(), "page") if isinstance(block, Picture))
    figures = {one.name: drawing(answer, one, folder, png) for one in pictures}
    if answer.page:
        typed = answer.typed
        if machine is None:
            scene: Any = called("leblanc.scene.scene:Scene")
            machine = scene.from_toml(typed.machine_file, typed.path)
        about = called("leblanc.scene.inputs:about")
        machine = getattr(machine, "scene", machine)  # of a study, what it varies
        what = about(machine, typed.command, answer.data, answer.task, answer.unused)
        page = called("leblanc.core.page:write_page")
        page(answer.title, answer.blocks(), what, figures, folder / answer.page)
    return list(figures.values())


def drawing(answer: Answer, picture: Picture, folder: Path, png: bool = False) -> Any:
    """Files of a picture of an answer, drawn."""
    save_figure = called("leblanc.plotting.page:save")
    return save_figure(called(picture.draw)(answer), folder, picture.name, picture.title, png)


def save(answer: Answer, path: Path) -> None:
    """Write the data file of an answer, with what `opened` makes it from."""
    found, typed = answer.named_arrays(), asdict(answer.typed)
    machine, about = answer.scene_asked, {}
    if machine is None and answer.typed.machine_file:
        scene: Any = called("leblanc.scene.scene:Scene")
        with suppress(InputError, ValueError, OSError):  # a file that it names may have been elsewhere
            machine = scene.from_toml(answer.typed.machine_file, answer.typed.path)
    if machine is not None:
        about = called("leblanc.scene.inputs:machine_variables")(machine)
    said = {
        "format": FORMAT,
        "leblanc": versions()["leblanc"],
        "typed": typed,
        "answer": _said(answer),
    }
    packed = lzma.compress(json.dumps(said, separators=(",", ":")).encode())
    shown = {name: text for name, text in typed.items() if text and name != "path"}
    found = replace(found, variables={**found.variables, **about}, attrs={**found.attrs, **shown})
    write_netcdf(found, path, packed)


def opened(path: str | PathLike[str]) -> Answer:
    """The answer in the data file of a command: report, figures and tables without a new run.

    The machine file as it was typed is in its `typed.machine_file`.

    Parameters
    ----------
    path : of the file, such as out/NAME/response.nc

    Raises
    ------
    InputError : no file that can be read, no data file of a command, a damaged one, one that another version
        wrote and this cannot read

    Examples
    --------
    >>> import leblanc as lb
    >>> answer = lb.open("out/Run-up/runup.nc")  # doctest: +SKIP
    >>> answer.write("again")  # doctest: +SKIP
    """
    if not isinstance(path, str | PathLike):
        raise InputError("path", type(path).__name__, "the path of a data file")
    where, allowed = Path(path), "a data file that a command of leblanc wrote"
    try:
        where.stat()
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or error
        raise InputError("path", str(path), f"{allowed}, which can be read: {why}") from error
    packed = read_aside(where)
    if packed is None:
        raise InputError("path", str(path), f"{allowed}; this one holds no answer, or numbers alone")
    try:
        unpack = lzma.LZMADecompressor(memlimit=_MOST)
        content = unpack.decompress(packed, _MOST)
        said = json.loads(content) if unpack.eof else {}
        wrote, number = str(said["leblanc"]), int(said["format"])
        if number > FORMAT:
            raise _Unknown(f"format {number}, of which it knows {FORMAT}")
        typed, found = Typed(**said["typed"]), _made(said["answer"])
    except _Unknown as error:
        text = f"one that this version, {versions()['leblanc']}, knows; leblanc {wrote} wrote {error}"
        raise InputError("path", str(path), text) from error
    except Exception as error:  # whatever other bytes than were written lead to
        raise InputError("path", str(path), f"{allowed}, undamaged") from error
    if not isinstance(found, Answer):
        raise InputError("path", str(path), allowed)
    object.__setattr__(found, "typed", typed)
    seal(found)
    return found


class _Unknown(ValueError):  # noqa: N818 - it names a state, not a mistake
    """What this version does not have: a format, a record, or one with these fields."""


def _said(value: Any) -> Any:
    """A value as JSON; what JSON does not know is a list that begins with its kind."""
    if isinstance(value, Enum):
        return ["enum", _address(type(value)), value.name]
    if isinstance(value, np.ndarray | np.generic):
        kind = "array" if isinstance(value, np.ndarray) else "scalar"
        array = np.asarray(value)
        if array.dtype.kind == "O":
            return ["objects", list(array.shape), [_said(each) for each in array.ravel().tolist()]]
        return [kind, array.dtype.str, list(array.shape), b64encode(array.tobytes()).decode("ascii")]
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, complex):
        return ["complex", value.real, value.imag]
    if isinstance(value, Path):
        return ["path", str(value)]
    if isinstance(value, Mapping):
        kind = "frozen map" if isinstance(value, MappingProxyType) else "map"
        return [kind, *([_said(key), _said(each)] for key, each in value.items())]
    if type(value).__name__ in _PLAIN and type(value) in _PLAIN.values():
        return [type(value).__name__, *map(_said, value)]
    names, given = _fields(type(value)), getattr(value, "model_fields_set", None)
    if names is not None:
        own = {name: _said(getattr(value, name)) for name in names}
        return ["record", _address(type(value)), own, *([] if given is None else [sorted(given)])]
    raise InputError("answer", type(value).__name__, "made of records and plain values to be saved")


def _made(said: Any) -> Any:
    """The value that `_said` made the JSON of."""
    if not isinstance(said, list):
        return said
    kind, *rest = said
    if kind in ("array", "scalar"):
        name, shape, content = rest
        if (dtype := np.dtype(name)).kind not in "bfciuU":
            raise ValueError(name)
        array = np.frombuffer(b64decode(content), dtype).reshape(shape).copy()
        return array if kind == "array" else array[()]
    if kind == "objects":
        each = [_made(one) for one in rest[1]]
        array = np.empty(len(each), object)
        array[:] = each
        return array.reshape(rest[0])
    if kind in ("map", "frozen map"):
        found = {_made(key): _made(one) for key, one in rest}
        return found if kind == "map" else MappingProxyType(found)
    if kind in _PLAIN:
        return _PLAIN[kind](map(_made, rest))
    if kind == "complex":
        return complex(*rest)
    if kind == "path":
        return Path(rest[0])
    made = _class(rest[0])
    if kind == "enum" and issubclass(made, Enum):
        return made[rest[1]]
    names, given = _fields(made), rest[1]
    if kind != "record" or names is None:
        raise ValueError(kind)
    if given.keys() - names.keys() or any(name not in given and names[name] is MISSING for name in names):
        raise _Unknown(f"another {made.__name__}")
    values = {name: _made(given[name]) if name in given else usual for name, usual in names.items()}
    if hasattr(made, "model_construct"):
        return made.model_construct({str(name) for name in rest[2]}, **values)
    record: Any = object.__new__(made)
    for name, value in values.items():
        object.__setattr__(record, name, value)
    return record


def _fields(kind: type) -> dict[str, Any] | None:
    """Fields of a frozen record or of a table of a scene, with their defaults; None for what is neither."""
    if is_dataclass(kind) and kind.__dataclass_params__.frozen:  # type: ignore[attr-defined]
        return {one.name: one.default for one in fields(kind)}
    if called("leblanc.scene.schema.part:Part") in kind.__mro__:
        return dict.fromkeys(kind.model_fields, MISSING)  # type: ignore[attr-defined]
    return None


def _address(kind: type) -> str:
    return f"{kind.__module__}:{kind.__qualname__}"


def _class(address: str) -> type:
    """The class at "module:name", of leblanc or of a package that announces something to it."""
    module, _, name = address.partition(":")
    package = module.partition(".")[0]
    if "__" in address or not all(part.isidentifier() for part in (*module.split("."), name)):
        raise ValueError(address)
    if package not in _PACKAGES:
        announced = called("leblanc.registry:announced")
        entries = (entry for group in _GROUPS for entry in announced(group).values())
        if package not in {entry.module.partition(".")[0] for entry in entries}:
            raise ValueError(address)
    try:
        found = getattr(import_module(module), name)
    except (ImportError, AttributeError) as error:
        raise _Unknown(f"{name} of {module}") from error
    if not isinstance(found, type) or found.__module__ != module:
        raise ValueError(address)
    return found
