"""One way to run a study from the command line, and to keep what it found as JSON.

A study is a function: its parameters are the options, its module's docstring the help. What is kept is a
frozen dataclass (or a tuple of them) that `write` leaves and `read` gives back.
"""

from __future__ import annotations

import argparse
import inspect
import json
import math
import sys
from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, get_args, get_origin, get_type_hints

if TYPE_CHECKING:
    from leblanc.plotting.page import Figure

_Kept = TypeVar("_Kept")


def launch(study: Callable[..., object]) -> None:
    """Call a study with the options of the command line, print the text, path or lines that it returns.

    A parameter without default is a required option, `*names` takes all words behind the options.
    """
    module = sys.modules["__main__"]
    name = "" if module.__spec__ is None else module.__spec__.name.removesuffix(".__main__")
    parser = argparse.ArgumentParser(
        prog=f"python -m {name}",
        description=module.__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    hints, words = get_type_hints(study), ""
    for name, parameter in inspect.signature(study).parameters.items():
        if parameter.kind is parameter.VAR_POSITIONAL:
            parser.add_argument(name, nargs=argparse.REMAINDER)
            words = name
            continue
        required = parameter.default is parameter.empty
        told = "required" if required else f"[default: {parameter.default}]"
        option = f"--{name.replace('_', '-')}"
        default = None if required else parameter.default
        parser.add_argument(option, required=required, default=default, help=told, **_taken(hints[name]))
    chosen = vars(parser.parse_args())
    found: Any = study(*chosen.pop(words, ()), **chosen)
    if found is not None:
        for part in found if isinstance(found, Iterator | list | tuple) else (found,):
            print(part, flush=True)


def shown(
    *tables: Callable[[], object], anew: Callable[[], object] | None = None, **figures: Callable[[], Figure]
) -> Callable[..., Iterator[object]]:
    """Study for `launch`: draw figures by the stems of their PNG files, then make tables.

    `anew` measures what is kept, which `--anew` asks for. A figure's title is the first line of the
    docstring of its function, which may be partial.
    """

    def show(out: Path = Path("docs/images")) -> Iterator[object]:
        from leblanc.plotting.page import save_png

        for stem, figure in figures.items():
            about = getattr(figure, "func", figure).__doc__ or stem
            yield save_png(figure(), out, stem, about.partition("\n")[0].rstrip("."))
        for table in tables:
            found = table()
            yield from found if isinstance(found, tuple) else (found,)

    def measure(out: Path = Path("docs/images"), anew: bool = False) -> Iterator[object]:
        return show(out) if measured is None or not anew else iter([measured()])

    measured = anew
    return measure if measured else show


def _taken(kind: Any) -> dict[str, Any]:
    """Keywords of `add_argument` for the annotation of a parameter."""
    if kind is bool:
        return {"action": "store_true"}
    parts = get_args(kind)
    if get_origin(kind) is Literal:
        return {"choices": parts}
    if get_origin(kind) is tuple:
        return {"nargs": "*"} | _taken(parts[0])
    return _taken(parts[0]) if parts else {"type": kind}


def data(name: str) -> dict[str, Any]:
    """Content of a file of `validation/data`."""
    text = resources.files("validation").joinpath("data", name).read_text(encoding="utf-8")
    content: dict[str, Any] = json.loads(text)
    return content


def write(file: Path, found: object, digits: int | None = None, compact: bool = False) -> None:
    """Keep records as JSON, null for what is not finite; digits: how many of each number."""
    layout: dict[str, Any] = {"separators": (",", ":")} if compact else {"indent": 1}
    text = json.dumps(plain(found, digits), allow_nan=False, **layout)
    file.write_text(text + "\n", encoding="utf-8")


def plain(value: Any, digits: int | None = None) -> Any:
    """What JSON can hold of records; null for what is not finite."""
    if isinstance(value, float):
        if not math.isfinite(value):
            return None
        return value if digits is None else float(f"{value:.{digits}g}")
    if is_dataclass(value):
        return {field.name: plain(getattr(value, field.name), digits) for field in fields(value)}
    if isinstance(value, Mapping):
        return {key: plain(entry, digits) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [plain(entry, digits) for entry in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist(), digits)
    return value


def read(file: Path, kind: type[_Kept]) -> _Kept:
    """Records that `write` kept, built by the annotations of their fields; null for a float is nan."""
    found: _Kept = built(json.loads(file.read_text(encoding="utf-8")), kind)
    return found


def stored(
    file: Path, kind: type[_Kept], **layout: Any
) -> tuple[Callable[[], _Kept], Callable[[_Kept], None]]:
    """What reads the records of a file, and what writes new ones; layout as of `write`."""
    return lambda: read(file, kind), lambda found: write(file, found, **layout)


def built(found: Any, kind: Any) -> Any:
    """The records again, by the annotations of their fields."""
    origin, parts = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and is_dataclass(kind):
        hints = get_type_hints(kind)
        return kind(**{name: built(value, hints[name]) for name, value in found.items()})
    if origin in (tuple, list):
        return origin(built(entry, parts[0]) for entry in found)
    if origin is not None and origin.__name__ == "ndarray":
        import numpy as np  # not above: studies set the number of threads before it is loaded

        values = [math.nan if value is None else value for value in found]
        return np.array(values, dtype=get_args(parts[1])[0])
    if origin is not None and issubclass(origin, Mapping):
        return {key: built(value, parts[1]) for key, value in found.items()}
    return math.nan if kind is float and found is None else found
