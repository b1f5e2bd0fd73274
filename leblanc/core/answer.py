"""An answer to a question: declared quantities, blocks to be shown, one main figure."""

from __future__ import annotations

import html
import io
import re
from abc import ABC, abstractmethod
from base64 import b64encode
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass
from functools import cache, partial, wraps
from hashlib import sha256
from importlib import metadata
from os import PathLike
from pathlib import Path
from types import CodeType
from typing import TYPE_CHECKING, Any, ClassVar

from leblanc.core.blocks import Block, Headline, Table, flat
from leblanc.core.notes import Note, one_line
from leblanc.core.question import called

if TYPE_CHECKING:
    from leblanc.core.netcdf import Dataset, NamedArrays


class NotConverged(RuntimeError):  # noqa: N818 - it names a state, not a mistake
    """A solver did not converge everywhere; what did is kept. One line for each that did not."""

    def __init__(self, failed: Sequence[str]) -> None:
        super().__init__("\n".join(failed))
        self.failed = tuple(failed)


_NO_ADDRESS = re.compile(r" at 0x[0-9A-Fa-f]+")


@dataclass(frozen=True)
class Typed:
    """What was asked, as it was typed."""

    machine_file: str = ""  #: text of the scene; what its file would say where it was made in Python
    study_file: str = ""  #: text of a sweep
    command: str = ""  #: that was typed; empty where it was asked in Python
    path: str = ""  #: of the machine file, beside which its sections are
    #: liquid asked with in Python in place of the scene's: its name, or what a model of one's own is made of
    liquid_model: str = ""


def as_typed(
    answer: Answer,
    scene: Any = None,
    study: Any = None,
    model: Any = None,
    models: Sequence[Any] = (),
    **_: Any,
) -> None:
    """Let an answer know what was asked, by its question; a study that changes the scene says so before."""
    scene = scene if study is None else study.scene
    if scene is not None and "typed" not in vars(answer):
        objects = [one for one in (model, *models) if not isinstance(one, str | None)]
        own = ", ".join(map(_made_of, objects)) or model or ""
        typed = Typed(scene.text, "" if study is None else study.text, path=scene.file, liquid_model=own)
        object.__setattr__(answer, "typed", typed)
        if objects:
            told = f"{vars(answer)['digest']} {own} {' '.join(_code_of(type(one)) for one in objects)}"
            object.__setattr__(answer, "digest", sha256(told.encode()).hexdigest())
        object.__setattr__(answer, "scene_asked", scene)


def _made_of(model: Any, within: tuple[int, ...] = ()) -> str:
    """An object in words that tell it from others: its own, or its class with its attributes.

    Arrays are told by their fingerprint, and addresses in memory are left out, which differ from run to run.
    """
    kind: Any = type(model)
    if id(model) in within:
        return "..."
    if kind.__module__ == "numpy" and hasattr(model, "tobytes"):
        return f"{model.dtype}{list(model.shape)} {sha256(model.tobytes()).hexdigest()[:12]}"
    name, told = f"{kind.__module__}.{kind.__qualname__}", getattr(model, "__dict__", {})
    if is_dataclass(model):
        name, told = kind.__qualname__, {each.name: getattr(model, each.name) for each in fields(model)}
    elif kind.__repr__ is not object.__repr__:
        return _NO_ADDRESS.sub("", repr(model))
    within = (*within, id(model))
    return f"{name}({', '.join(f'{key}={_made_of(value, within)}' for key, value in told.items())})"


def _code_of(part: Any) -> str:
    """What a class with its bases, a method, its code or a constant in it does, wherever it stands."""
    if isinstance(part, type):
        own = [(name, _code_of(each)) for kind in part.__mro__[:-1] for name, each in vars(kind).items()]
        return "".join(name + code for name, code in own if "(" in code or not name.startswith("__"))
    part = getattr(part, "fget", getattr(part, "__func__", part))
    code = getattr(part, "__code__", part)
    if isinstance(code, CodeType):
        return f"({code.co_code.hex()}{code.co_names}{[*map(_code_of, code.co_consts)]})"
    return _NO_ADDRESS.sub("", repr(sorted(code, key=repr) if isinstance(code, frozenset) else code))


def versions(packages: Iterable[str] = ("leblanc", "numpy", "scipy")) -> dict[str, str]:
    """Versions of packages, by default of this one and of the libraries that all numbers come from."""
    return {package: _version(package) for package in packages}


@cache
def _version(package: str) -> str:
    try:
        return metadata.version(package)
    except metadata.PackageNotFoundError:  # run from a source tree that was never installed
        return "not installed"


def input_lines(inputs: Iterable[tuple[str, str, str]]) -> str:
    """What a machine file says, a line each, from label, value with its unit and path."""
    return "\n".join(one_line("{}: {} [{}]".format(*entry)) for entry in inputs)


def attributes(
    result: Any, command: str, own: Mapping[str, Any], notes: Iterable[Note | str]
) -> dict[str, Any]:
    """Attributes of the data file that a command writes: scene, what this kind alone has, notes, versions."""
    said = [one_line(note if isinstance(note, str) else note.text) for note in notes]
    scene = {}
    if hasattr(result, "digest"):
        scene = {
            "title": one_line(result.name),
            "source": one_line(result.source) or "not stated",
            "digest": result.digest,
            "assumed": "; ".join(map(one_line, result.assumed)) or "nothing",
        }
    return {
        **scene,
        **own,
        "notes": "\n".join(said) or "none",
        "history": f"written by leblanc {command}",
        **{f"version_{package}": version for package, version in versions().items()},
    }


def _table(rows: Sequence[Sequence[Any]], head: Sequence[str] = ()) -> str:
    """A table of texts and cells as HTML."""

    def line(row: Sequence[Any], first: str, tag: str) -> str:
        texts = [html.escape(cell if isinstance(cell, str) else cell.text) for cell in row]
        cells = "".join(f"<{tag}>{text}</{tag}>" for text in texts[1:])
        return f'<tr><th scope="{first}" style="text-align: left">{texts[0]}</th>{cells}</tr>'

    lines = ([line(head, "col", "th")] if head else []) + [line(row, "row", "td") for row in rows]
    return f"<table>{''.join(lines)}</table>"


def _read_only(value: Any) -> Any:
    """An array, a tuple or a table of them, made read-only: what is written into one would be lost."""
    if type(value) in (tuple, dict):
        for each in value.values() if isinstance(value, dict) else value:
            _read_only(each)
    elif type(value).__name__ == "ndarray":
        value.flags.writeable = False
    return value


def _plain(to_json: Callable[[Any], dict[str, Any]]) -> Any:
    """A `to_json` of a kind of answer, whose values are made such as JSON knows."""

    @wraps(to_json)
    def made(answer: Any) -> dict[str, Any]:
        found: dict[str, Any] = called("leblanc.core.quantities:plain")(to_json(answer))
        return found

    return made


class Later:
    """A value of an answer that is worked out when it is first read; several values may stand on it.

    Of two threads both may work it out, to the same value.
    """

    def __init__(self, function: Callable[..., Any], *given: Any) -> None:
        self._call: Callable[[], Any] | None = partial(function, *given)
        self._value: Any = None

    def __call__(self) -> Any:
        """The value."""
        call = self._call
        if call is not None:
            self._value = call()
            self._call = None
        return self._value


def later(function: Callable[..., Any], *given: Any) -> Any:
    """`Later`, in place of a value of any type."""
    return Later(function, *given)


class Answer(ABC):
    """Base of a frozen dataclass whose fields and properties are declared by `Q`."""

    figure: ClassVar[str]  #: "module:function" that draws its main figure
    command: ClassVar[str]  #: that asks for it
    title: ClassVar[str] = ""  #: of its report
    data: ClassVar[str] = ""  #: file of its numbers; empty where there is none
    page: ClassVar[str] = ""  #: file of its report
    typed: Typed = Typed()  #: what was asked
    scene_asked: Any = None  #: the machine; None of an answer that was read from a file
    unused: tuple[str, ...] = ()  #: tables of the scene on which its numbers do not depend
    task: Any = None  #: of an optimisation, in place of the scene's
    interrupted = False  #: it was ended before its time; what is there is whole

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        # In place of what a dataclass would make of fields that are arrays.
        for name in ("__eq__", "__hash__", "__repr__"):
            if name not in vars(cls) or (name == "__hash__" and cls.__hash__ is None):
                setattr(cls, name, getattr(Answer, name))
        if "to_json" in vars(cls):
            cls.to_json = _plain(cls.to_json)  # type: ignore[method-assign]

    def __eq__(self, other: object) -> bool:
        """Of the same kind with the same values, arrays element by element, nan equal to nan."""
        from leblanc.core.quantities import alike

        return alike(self, other) if type(self) is type(other) else NotImplemented

    def __hash__(self) -> int:
        return hash((type(self), getattr(self, "digest", None)))

    def __repr__(self) -> str:
        """What it is, of which machine, and how much of it."""
        sizes = ", ".join(f"{name} {size}" for name, size in self.named_arrays().sizes.items())
        of = getattr(self, "name", None)
        return (
            f"<{type(self).__name__}{f' of {one_line(of)!r}' if of else ''}{f': {sizes}' if sizes else ''}>"
        )

    @property
    def attributes(self) -> Mapping[str, Any]:
        """Of its data file, besides the quantities: scene, notes, versions."""
        return attributes(self, self.command, self.own, getattr(self, "notes", ()))

    @property
    def own(self) -> Mapping[str, Any]:
        """Attributes that only this kind of answer has."""
        return {}

    @property
    def faults(self) -> Sequence[str]:
        """Why there is no answer, or none to rely on, a line each."""
        return ()

    def fault(self, where: str) -> Exception | None:
        """With what a command ends whose answer is none, or none to rely on."""
        return NotConverged([f"{where}: {fault}" for fault in self.faults]) if self.faults else None

    @property
    def closing(self) -> str:
        """What was done, for the end of a command."""
        return ""

    def after(self) -> None:  # noqa: B027 - most have nothing to do
        """What the command does once its files are written."""

    def __getattribute__(self, name: str) -> Any:
        """As of any object; an array that is computed anew is read-only as well."""
        found = object.__getattribute__(self, name)
        if type(found) is Later:
            found = found()
            called("leblanc.core.quantities:seal")(found)
            object.__setattr__(self, name, found)
        return _read_only(found)

    def __getstate__(self) -> dict[str, Any]:
        """All of its values, none of them for later."""
        return {name: getattr(self, name) for name in vars(self)}

    def __getattr__(self, name: str) -> Any:
        """A quantity of one of its parts; None where it has no such part."""
        from leblanc.core.quantities import reached

        if name.startswith("__"):
            raise AttributeError(name)
        try:
            return _read_only(reached(self, name))
        except AttributeError:
            return _read_only(called("leblanc.moved:attribute")(self, name))

    def __dir__(self) -> list[str]:
        from leblanc.core.quantities import names

        return sorted({*super().__dir__(), *names(type(self))})

    @abstractmethod
    def blocks(self) -> Sequence[Block]:
        """What is shown of it, in the order of reading."""

    def to_json(self) -> dict[str, Any]:
        """Its quantities by name: SI, radians, complex numbers as [re, im], None for what is not there."""
        from leblanc.core.quantities import to_json

        return to_json(self)

    def named_arrays(self) -> NamedArrays:
        """Its quantities as arrays with named dimensions, units in their attributes."""
        from leblanc.core.quantities import named_arrays

        return named_arrays(self, self.attributes)

    def to_dataset(self) -> Dataset:
        """The same as an xarray dataset."""
        return self.named_arrays().to_dataset()

    def save(self, path: str | PathLike[str]) -> None:
        """Write it as a netCDF file, from which `leblanc.open` makes it again."""
        called("leblanc.core.disk:save")(self, Path(path))

    def write(self, folder: str | PathLike[str], png: bool = False) -> None:
        """Write the files of its command into a folder: data, pictures, report.

        Pictures are SVG, with `png` PNG as well; one alone is `plot().savefig("it.png")`.
        """
        called("leblanc.core.disk:write")(self, Path(folder), png=png)

    def plot(self, ax: Any = None) -> Any:
        """The main figure, a `matplotlib.figure.Figure`; one of a single axes on somebody else's `ax`.

        An `InputError` refuses `ax` where the figure has several.
        """
        if ax is None:
            return called(self.figure)(self)
        return called("leblanc.plotting.page:drawn_on")(called(self.figure), self, ax)

    def _repr_html_(self) -> str:
        """The main numbers and the main figure, for a notebook."""
        drawing, figure = io.BytesIO(), self.plot()
        figure.savefig(drawing, format="svg")
        address = b64encode(drawing.getvalue()).decode("ascii")
        alt = html.escape(getattr(figure, "alt", ""))
        return f'{self._tables()}<img alt="{alt}" src="data:image/svg+xml;base64,{address}">'

    def _tables(self) -> str:
        shown = list(flat(self.blocks(), "page"))
        words = [f"<p>{html.escape(block.text)}</p>" for block in shown if isinstance(block, Headline)]
        return "".join(words + [_table(one.rows, one.head) for one in shown if isinstance(one, Table)])
