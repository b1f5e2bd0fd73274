"""A sweep: a scene, what varies in it by which distribution and how it is sampled, read from a study file."""

from __future__ import annotations

import hashlib
import json
import math
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict, dataclass, replace
from os import PathLike
from pathlib import Path
from textwrap import shorten
from typing import Annotated, Any

import numpy as np
from pydantic import Field, PlainValidator, ValidationError

from leblanc.core import units
from leblanc.core.files import native, path_text
from leblanc.core.units import allowed_as_typed
from leblanc.scene.scene import Scene, SceneOrPath, fault_in, require_whirl, scene_from_table
from leblanc.scene.schema.load import (
    SceneError,
    SceneFault,
    field_path,
    read_text,
    scene_table,
    shown,
    toml_of,
    with_lines,
)
from leblanc.scene.schema.part import Conflict, Part, allowed_at, faults_of
from leblanc.scene.schema.paths import ROOTS, Keys, keys_of, rule_at
from leblanc.scene.schema.rules import (
    Entries,
    Quantity,
    Refused,
    Several,
    Text,
    Truth,
    Whole,
    one_of,
    whole,
)
from leblanc.studies.sweep.outputs import Kept, kept_of
from meshes.arrays import Array
from meshes.errors import InputError

Vary = Mapping[str, tuple[Mapping[str, Any], str]]  #: distribution of a grid and its text, by paths

MAX_LEVELS = 1_000_000
MAX_CHOICES = 1000

_INSIDE = (2.0**-54, 1.0 - 2.0**-53)  # where every inverse distribution function is finite


@dataclass(frozen=True)
class Uniform:
    """Evenly spread from `low` to `high`."""

    low: float
    high: float

    def at(self, u: Array) -> Array:
        """Value below which the share u lies [theory: sampling, eq. 1]."""
        return np.asarray(self.low + (self.high - self.low) * u)


@dataclass(frozen=True)
class Normal:
    """Gauss's bell around `mean` with a standard deviation."""

    mean: float
    deviation: float

    def at(self, u: Array) -> Array:
        """Value below which the share u lies [theory: sampling, eq. 2]."""
        return np.asarray(self.mean + self.deviation * _standard_normal(u))


@dataclass(frozen=True)
class LogNormal:
    """Its logarithm is normal: two thirds lie within `factor` of the `median`, up and down."""

    median: float
    factor: float

    def at(self, u: Array) -> Array:
        """Value below which the share u lies [theory: sampling, eq. 3]."""
        return np.asarray(self.median * np.exp(math.log(self.factor) * _standard_normal(u)))


@dataclass(frozen=True)
class Choice:
    """One of a few values, each as likely."""

    options: tuple[Any, ...]  #: as a scene writes them; a quantity in SI

    @property
    def categorical(self) -> bool:
        """Some option is no number."""
        return not all(isinstance(option, float | int) for option in self.options)

    def at(self, u: Array) -> Array:
        """Number of the option at the share u [theory: sampling, eq. 4]."""
        return np.minimum(np.floor(u * len(self.options)), len(self.options) - 1.0)

    def levels(self) -> Array:
        """Numbers of all options."""
        return np.arange(len(self.options), dtype=np.float64)


@dataclass(frozen=True)
class Levels:
    """Evenly spaced values of a grid, both ends among them."""

    first: float
    last: float
    count: int

    def levels(self) -> Array:
        """All values."""
        return np.linspace(self.first, self.last, self.count)


Distribution = Uniform | Normal | LogNormal | Choice | Levels


def _standard_normal(u: Array) -> Array:
    """Quantiles of the standard normal distribution."""
    from scipy.special import ndtri

    return np.asarray(ndtri(np.clip(u, *_INSIDE)))


def _quantity(rule: Any, kind: str) -> Quantity:
    """The rule of a field that takes any number between bounds, the same in all directions."""
    rule = rule.each if isinstance(rule, Several) else rule
    if not isinstance(rule, Quantity):
        raise Refused(f"choice, since the field must be {rule.allowed}: it has no {kind}")
    return rule


def _several(given: Any, count: int, what: str) -> list[Any]:
    return list(Entries(count, count, what)(given))


def _uniform(given: Any, rule: Any) -> Uniform:
    rule = _quantity(rule, "uniform")
    low, high = map(rule, _several(given, 2, f"values, lowest and highest, each {rule.allowed}"))
    if low >= high:
        raise Refused("a lowest value below the highest")
    return Uniform(low, high)


def _normal(given: Any, rule: Any) -> Normal:
    rule = _quantity(rule, "normal")
    mean, spread = _several(given, 2, f"values, mean and standard deviation, each {rule.allowed}")
    deviation = units.parse(spread, rule.dimension)
    if deviation <= 0.0:
        raise Refused("a mean and a standard deviation above 0")
    return Normal(rule(mean), deviation)


def _lognormal(given: Any, rule: Any) -> LogNormal:
    rule = _quantity(rule, "lognormal")
    middle, spread = _several(given, 2, f"values, median and factor; the median {rule.allowed}")
    median, factor = rule(middle), Quantity(units.NUMBER, 1.0, 1e6)(spread)
    if median <= 0.0 or factor <= 1.0:
        raise Refused("a median above 0 and a factor above 1")
    return LogNormal(median, factor)


def _choice(given: Any, rule: Any) -> Choice:
    options = Entries(1, MAX_CHOICES, f"values, each {rule.allowed}")(given)
    checked = [rule(option) for option in options]
    return Choice(tuple(checked) if isinstance(rule, Quantity) else tuple(options))


def _linspace(given: Any, rule: Any) -> Levels:
    rule = _quantity(rule, "linspace")
    first, last, count = _several(
        given, 3, f"values, first, last and how many; first and last {rule.allowed}"
    )
    levels = Levels(rule(first), rule(last), Whole(2, MAX_LEVELS)(count))
    if levels.first == levels.last:
        raise Refused("two different ends")
    return levels


KINDS: dict[str, Callable[[Any, Any], Distribution]] = {
    "uniform": _uniform,
    "normal": _normal,
    "lognormal": _lognormal,
    "choice": _choice,
    "linspace": _linspace,
}

# How a study file writes each, and what it means.
FORMS: dict[str, tuple[str, str]] = {
    "uniform": ("{ uniform = [low, high] }", "evenly spread between the two"),
    "normal": ("{ normal = [mean, deviation] }", "Gauss's bell with that mean and standard deviation"),
    "lognormal": (
        "{ lognormal = [median, factor] }",
        "two thirds within that factor of the median",
    ),
    "choice": ("{ choice = [a, b, ...] }", "each as likely; the only one for words; in a grid all of them"),
    "linspace": (
        "{ linspace = [first, last, count] }",
        "evenly spaced, with both ends; only in a grid",
    ),
}

METHODS = ("grid", "latin_hypercube", "sobol", "random", "saltelli")
MAX_SAMPLES = 10_000_000
MAX_VARIED = 1000  # fields
_SHOWN = 6  # options of a choice
MAX_SEED = 2**63 - 1  # the largest whole number of TOML

_EXAMPLE = '"rotor.mass" = { uniform = ["3 kg", "12 kg"] }'


class Varying:
    """[vary]: fields of the scene by their paths, each with one distribution."""

    allowed = f"a table of 1 to {MAX_VARIED} fields of the scene by their paths, such as {_EXAMPLE}"

    def __call__(self, value: object) -> dict[str, Any]:
        """The fields, each with what the file says about it."""
        if isinstance(value, dict) and 1 <= len(value) <= MAX_VARIED:
            return value
        raise Refused(self.allowed)


class Study(Part):
    """The content of a study file: many scenes that differ in a few values."""

    scene: Annotated[str, PlainValidator(Text(4000))] = Field(
        description="file of the base, its path counts from the study's"
    )
    command: Annotated[str, one_of(*ROOTS)] = Field(
        "run", description="that answers each scene: steady motion over its speeds, or its run-up in time"
    )
    check: Truth = Field(
        True, description="whether each run-up is made with half the cells as well, which tells its error"
    )
    method: Annotated[str, one_of(*METHODS)] = Field(description="how the scenes are chosen")
    samples: Annotated[int | None, whole(1, MAX_SAMPLES)] = Field(
        None, description="how many scenes, points of the design for saltelli; left out for a grid"
    )
    seed: Annotated[int, whole(0, MAX_SEED)] = Field(0, description="of the random numbers")
    vary: Annotated[dict[str, Any], PlainValidator(Varying())] = Field(
        description="fields of the scene by their paths, each with one distribution"
    )

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A grid has the number of its samples by its levels; only run-ups are checked."""
        method = values.get("method")
        if values.get("command") == "run" and "check" in given:
            yield Conflict(("check",), 'left out unless command is "runup"')
        if method == "grid" and "samples" in given:
            yield Conflict(("samples",), "left out where method is grid")
        elif method not in (None, "grid") and "samples" not in given:
            yield Conflict(("samples",), f"given: {allowed_at(cls.model_fields['samples'])}")


_MOST_PERMUTED = 50_000_000  # numbers of a Latin hypercube, which is made as a whole


@dataclass(frozen=True)
class VariedField:
    """A field of the scene and the values it takes."""

    path: str  #: of the field, as in "chambers.0.volume"
    unit: str  #: SI unit of its values; "1" where they have none
    distribution: Distribution  #: of the values

    @property
    def keys(self) -> Keys:
        """Keys along the path."""
        return keys_of(self.path)

    @property
    def categorical(self) -> bool:
        """The values are texts, and samples hold their indices."""
        return isinstance(self.distribution, Choice) and self.distribution.categorical

    def words(self) -> str:
        """Its distribution as a person writes it."""
        law, unit = self.distribution, "" if self.unit == "1" else f" {self.unit}"
        if isinstance(law, Choice):
            shown_options = ", ".join(shown(option) for option in law.options[:_SHOWN])
            return f"one of {shown_options}{', ...' if len(law.options) > _SHOWN else ''}{unit}"
        text = {
            Uniform: "uniform from {low:.6g} to {high:.6g}",
            Normal: "normal, mean {mean:.6g}, standard deviation {deviation:.6g}",
            LogNormal: "lognormal, median {median:.6g}, factor {factor:.6g}",
            Levels: "{count} levels from {first:.6g} to {last:.6g}",
        }[type(law)]
        return text.format(**asdict(law)) + unit

    def value(self, drawn: float) -> Any:
        """What the scene gets for a sampled number."""
        if isinstance(self.distribution, Choice):
            return self.distribution.options[int(drawn)]
        return float(drawn)


@dataclass(frozen=True)
class Sweep:
    """Many scenes that differ in a few values."""

    name: str  #: of the study file, without its ending
    scene_path: str  #: of the scene they are made from
    table: Mapping[str, Any]  #: content of that file
    scene: Scene  #: that scene
    method: str  #: of sampling
    points: int  #: of the design: samples, but for a "saltelli" design, which has some for each point
    seed: int  #: of the samples
    fields: tuple[VariedField, ...]  #: what varies
    text: str = ""  #: of its file, as it was typed
    command: str = "run"  #: that answers each scene
    check: bool = True  #: run-ups are made with half the cells as well

    @property
    def kept(self) -> Kept:
        """What its store keeps of each sample."""
        return kept_of(self.scene, self.command, self.check)

    @property
    def samples(self) -> int:
        """How many scenes there are: of a "saltelli" design for each point both sets and each exchange."""
        return self.points * (len(self.fields) + 2 if self.method == "saltelli" else 1)

    @property
    def digest(self) -> str:
        """Fingerprint of all that the results depend on but the code (SHA-256)."""
        content = {
            "scene": self.scene.digest,
            "method": self.method,
            "points": self.points,
            "seed": self.seed,
            "fields": [
                [field.path, type(field.distribution).__name__, asdict(field.distribution)]
                for field in self.fields
            ],
        }
        if self.command != "run":
            content |= {"command": self.command, "check": self.check}
        return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()


def study_of(study: Sweep | SceneOrPath, field: str = "study") -> Sweep:
    """A sweep itself, that of a table, or that of a file; of a machine one in which nothing varies yet."""
    if isinstance(study, Mapping):
        return _sweep_of(study, "")
    if not isinstance(study, Sweep | Scene | str | PathLike):
        raise InputError(field, type(study).__name__, "a machine, a study, or the path of its file")
    if isinstance(study, Scene):
        return _unvaried(study)
    return study if isinstance(study, Sweep) else load_sweep(study)


def load_sweep(path: str | PathLike[str]) -> Sweep:
    """Sweep from a study file; of a machine file one in which nothing varies yet."""
    text = read_text(path)
    with with_lines(path):
        given = toml_of(text, path)
        if is_machine(given):
            return _unvaried(Scene.from_toml(text, str(path)))
        return replace(_sweep_of(given, path), text=text)


def is_machine(given: Mapping[str, Any]) -> bool:
    """The content of a file is a machine, no study."""
    return "rotor" in given and "vary" not in given


def _unvaried(scene: Scene) -> Sweep:
    """A grid of one machine."""
    _require_answered(scene, "run")
    file = scene.file or "scene"
    return Sweep(scene.name, file, scene.table(), scene, method="grid", points=1, seed=0, fields=())


def _require_answered(scene: Scene, command: str) -> None:
    """Refuse a machine that the command does not answer."""
    try:
        require_whirl(scene)
        if command == "runup":
            from leblanc.studies.runup.study import require_runup

            require_runup(scene)
    except InputError as error:
        raise ((fault_in(scene.file, error) if scene.file else None) or error) from error


_FORM = "PATH=LOW..HIGH:COUNT or PATH=A,B,C, such as chambers.0.volume='0.1 l..1.9 l:20'"
_MIXED = "values that all have a unit, or none (SI): '0 l..1.9 l:20', '0 l,0.5 l,1 l'"


def vary_of(given: Mapping[str, Any] | Sequence[str], field: str = "vary") -> Vary:
    """What varies on a grid: texts or lists of values by their paths, or texts PATH=VALUES as typed."""
    pairs: list[tuple[Any, Any]]
    if isinstance(given, Mapping):
        pairs = list(given.items())
    elif isinstance(given, list | tuple) and all(isinstance(text, str) for text in given):
        parts = (path_text(text).partition("=") for text in given)
        pairs = [(path.strip(), values.strip()) for path, _, values in parts]
    else:
        raise InputError(field, type(given).__name__, f"a table of values by their paths, or {_FORM}")
    found: dict[str, tuple[Mapping[str, Any], str]] = {}
    for path, values in pairs:
        values = values.tolist() if hasattr(values, "tolist") else values
        said = ",".join(map(str, values)) if isinstance(values, list | tuple) else str(values)
        typed = shorten(f"{path}={said}", 80, placeholder="...")
        if path in found:
            raise InputError(field, typed, "given once for each path")
        found[path] = (_grid_of(path, values, typed, field), typed)
    return found


def _grid_of(path: Any, values: Any, typed: str, field: str) -> Mapping[str, Any]:
    """The distribution of a grid that is typed as "LOW..HIGH:COUNT" or "A,B,C", or a list of values."""
    if not isinstance(path, str) or not path or not values or not isinstance(values, str | list | tuple):
        raise InputError(field, typed, _FORM)
    low, range_, rest = values.partition("..") if isinstance(values, str) else ("", "", "")
    if range_:
        high, colon, count = map(str.strip, rest.rpartition(":"))
        if not colon and low.strip() and count:
            raise InputError(field, typed, f"PATH=LOW..HIGH:COUNT, such as {path}='{values}:20'")
        if not low.strip() or not high or not count.isdecimal() or len(count) > _DIGITS:
            raise InputError(field, typed, _FORM)
        listed = [_typed(low), _typed(high)]
        made: Mapping[str, Any] = {"linspace": [*listed, int(count)]}
    else:
        listed = _listed(values) if isinstance(values, str) else list(values)
        if len(listed) < 2:
            raise InputError(field, typed, f"{_FORM}; --set takes a single value")
        made = {"choice": listed}
    plain = [isinstance(value, float | int) for value in listed]
    if any(plain) and any(isinstance(value, str) and _SIZE.match(value) for value in listed):
        raise InputError(field, typed, _MIXED)
    return made


_DIGITS = 9  # of how many
_SIZE = re.compile(r"[+-]?\.?\d")  # that a quantity begins with


def _listed(text: str) -> list[Any]:
    """Values between commas, which those of TOML may have as well."""
    with suppress(SceneError):
        found: list[Any] = toml_of(f"values = [{text}]", "vary")["values"]
        return found
    return [_typed(part) for part in text.split(",")]


def _typed(text: str) -> Any:
    """A value as TOML where it is one, else a text."""
    with suppress(SceneError):
        return toml_of(f"value = {text}", "vary")["value"]
    return text.strip()


def varied(sweep: Sweep, vary: Vary) -> Sweep:
    """A sweep with further fields on its grid, or others in their place; refused where none varies."""
    fields = {field.path: field for field in sweep.fields}
    for path, (given, typed) in vary.items():
        if sweep.method != "grid":
            raise InputError("vary", typed, f"left out of a study whose method is {sweep.method}, not grid")
        try:
            (fields[path],) = _fields({path: given}, sweep.table, "", sweep.command, "grid")
            if faults := _nested(fields, ""):
                raise SceneError(faults)
        except SceneError as error:
            raise InputError("vary", typed, error.faults[0].allowed) from error
    if not fields:
        study = "`leblanc new --example studies/fill_grid` writes a study file"
        raise InputError("vary", None, f"given with a machine file: --vary {_FORM}; {study}")
    if not vary:
        return sweep
    grid = _grid(sweep, tuple(fields.values()))
    try:
        _check_size(grid, "")
    except SceneError as error:
        raise InputError("vary", grid.points, error.faults[0].allowed) from error
    return grid


def _grid(sweep: Sweep, fields: tuple[VariedField, ...]) -> Sweep:
    """A sweep over every combination of values."""
    sizes = [int(field.distribution.levels().size) for field in fields]  # type: ignore[union-attr]
    return replace(sweep, fields=fields, points=math.prod(sizes))


def _sweep_of(given: Mapping[str, Any], path: str | PathLike[str]) -> Sweep:
    """Sweep from the content of a study file; without a path the scene may be a table or a `Scene`."""
    file = str(path) or "study"
    base = given.get("scene")
    base = base.table() if isinstance(base, Scene) else base
    if not path and isinstance(base, Mapping):
        given = {**given, "scene": "scene"}
    if is_machine(given):
        return _unvaried(scene_from_table(given))
    try:
        table = Study.model_validate(given)
    except ValidationError as error:
        raise SceneError(faults_of(error, file, Study)) from error
    if not path and isinstance(base, Mapping):
        content, scene = base, scene_from_table(base)
    else:
        scene_path = Path(path).parent / native(table.scene)
        scene_text = read_text(scene_path)
        content = scene_table(scene_text, scene_path)
        with with_lines(scene_path):
            scene = scene_from_table(content, str(scene_path), scene_text)
    _require_answered(scene, table.command)
    fields = _fields(table.vary, content, file, table.command, table.method)
    sweep = Sweep(
        name=path_text(Path(path).stem) if path else scene.name,
        scene_path=table.scene,
        table=content,
        scene=scene,
        method=table.method,
        points=table.samples or 1,
        seed=table.seed,
        fields=fields,
        command=table.command,
        check=table.check,
    )
    sweep = _grid(sweep, fields) if table.samples is None else sweep
    _check_size(sweep, file)
    return sweep


def _fields(
    vary: Mapping[str, Any], scene: Mapping[str, Any], file: str, command: str, method: str
) -> tuple[VariedField, ...]:
    """The varied fields, or all faults of them."""
    faults: list[SceneFault] = []
    fields = []
    for path, given in vary.items():
        where: tuple[str, ...] = ("vary", path)
        value: object = None
        try:
            rule = rule_at(Scene, scene, path, command)
            kind = _kind(given, method)
            where, value = (*where, kind), given[kind]
            distribution = KINDS[kind](value, rule)
        except ValidationError as error:  # of a table that stands for the value, as a liquid's
            own = faults_of(error, file, rule.table)
            faults += [replace(one, field=f"{field_path(where)}.{one.field}") for one in own]
            continue
        except (Refused, InputError) as error:
            said = None if value is None else shown(value)
            if value is None and not isinstance(given, Mapping):
                said = shown(given)
            faults.append(SceneFault(file, field_path(where), said, allowed_as_typed(error.allowed, value)))
            continue
        unit = rule.dimension.unit if isinstance(rule, Quantity | Several) else ""
        fields.append(VariedField(path, unit or "1", distribution))
    faults = faults or _nested(vary, file)
    if faults:
        raise SceneError(faults)
    return tuple(fields)


def _kind(given: object, method: str) -> str:
    """Which distribution a field has."""
    names = [kind for kind in KINDS if (kind in ("linspace", "choice")) or method != "grid"]
    if method != "grid":
        names.remove("linspace")
    if not isinstance(given, Mapping) or len(given) != 1 or next(iter(given)) not in names:
        raise Refused(f"a table of exactly one of {', '.join(names)} where method is {method}")
    return str(next(iter(given)))


def _nested(vary: Mapping[str, Any], file: str) -> list[SceneFault]:
    """Fields that are part of another varied field."""
    keys = {path: keys_of(path) for path in vary}
    return [
        SceneFault(file, field_path(("vary", path)), None, f"left out where {other} varies as a whole")
        for path, own in keys.items()
        for other, above in keys.items()
        if len(above) < len(own) and own[: len(above)] == above
    ]


def _check_size(sweep: Sweep, file: str) -> None:
    """Neither more samples than can be numbered nor a design that would not fit the memory."""
    field = "vary" if sweep.method == "grid" else "samples"
    allowed = ""
    if sweep.samples > MAX_SAMPLES:
        allowed = f"at most {MAX_SAMPLES} scenes in all"
    elif sweep.method == "latin_hypercube" and sweep.points * len(sweep.fields) > _MOST_PERMUTED:
        allowed = f"at most {_MOST_PERMUTED // len(sweep.fields)} with {len(sweep.fields)} varied fields"
    if allowed:
        raise SceneError([SceneFault(file, field, str(sweep.samples), allowed)])
