"""A scene: one machine with its liquid, in SI units, frozen, every value checked."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass
from functools import cache, cached_property
from itertools import pairwise
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any

from pydantic import Discriminator, Field, PlainValidator, Tag, ValidationError

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid, known_liquid
from leblanc.core import units
from leblanc.core.units import allowed_as_typed
from leblanc.registry import LIQUIDS, announced
from leblanc.scene.cabinet import MAX_POINTS, Cabinet, Point, cabinet_conflicts
from leblanc.scene.chambers import Chamber
from leblanc.scene.magnetic import MagneticRotor as MagneticRotor
from leblanc.scene.programme.table import Programme as Programme
from leblanc.scene.races import BallRace as BallRace  # what a scene's chamber may be
from leblanc.scene.rotors import WITHOUT_CHAMBERS as WITHOUT_CHAMBERS
from leblanc.scene.rotors import AnyRotor, Machine, announced_machines, not_taken, rotor_tag
from leblanc.scene.rotors import Exciter as Exciter  # what a scene's rotor may be
from leblanc.scene.rotors import JeffcottRotor as JeffcottRotor
from leblanc.scene.rotors import TubRotor as TubRotor
from leblanc.scene.rotors import TwoPlaneRotor as TwoPlaneRotor
from leblanc.scene.schema.load import (
    SceneError,
    SceneFault,
    given_at,
    meant,
    read_text,
    scene_table,
    shown,
    with_lines,
)
from leblanc.scene.schema.part import Conflict, Part, faults_of
from leblanc.scene.schema.paths import keys_of, require_field, with_values
from leblanc.scene.schema.rules import OneOf, Refused, Speed, Text, entries, one_of, quantity, whole
from leblanc.scene.spindle import Spindle as Spindle
from leblanc.scene.spindle import without_liquid
from leblanc.scene.tasks import Optimisation
from leblanc.scene.tasks import Runup as Runup
from leblanc.scene.unbalances import polar_inertia_of, sheds_of
from meshes.errors import InputError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from solvers.rotor.jeffcott import Jeffcott
    from solvers.rotor.tub import Tub
    from solvers.rotor.two_plane import TwoPlane


MAX_CHAMBERS = 1000
MAX_SPEEDS = 100_000
MAX_ASSUMED = 10_000

HELD = ("auto", "never", "always")
MAX_CELLS = 4096
LIQUID_MODELS = ("auto", "statics", "linear", "long_wave", "potential", "kdv", "fem")
_LAWS = ("none", "stokes", "wall")


@dataclass(frozen=True)
class LiquidName(OneOf):
    """A built-in liquid model, or one that an installed package announces under `leblanc.liquids`."""

    def __call__(self, value: object) -> str:
        """The name."""
        if isinstance(value, str) and value in self.names:
            return value
        return OneOf((*self.names, *announced(LIQUIDS, self.names)))(value)


_Path = Annotated[str, PlainValidator(Text(200))]


def _chamber_kind(given: Any) -> str:
    """Kind of a chamber as a file says it: liquid where it says nothing."""
    kind = given.get("kind", "liquid") if isinstance(given, Mapping) else getattr(given, "kind", "liquid")
    return str(kind)


AnyChamber = Annotated[
    Annotated[Chamber, Tag("liquid")] | Annotated[BallRace, Tag("balls")], Discriminator(_chamber_kind)
]


class Speeds(Part):
    """Spin speeds: evenly spaced, or each of them."""

    start: Speed = Field(description="first spin speed")
    stop: Speed = Field(description="last spin speed")
    count: Annotated[int, whole(1, MAX_SPEEDS)] = Field(description="how many, evenly spaced")
    values: Annotated[tuple[Speed, ...], entries(0, MAX_SPEEDS, "rising spin speeds")] = Field(
        (), description="each of them, in place of the three others"
    )

    @classmethod
    def as_table(cls, given: Any) -> Any:
        """A list or an array is that of the values; they say the first, the last and how many as well."""
        if hasattr(given, "tolist"):
            given = given.tolist()
        values = given if isinstance(given, list | tuple) else None
        if isinstance(given, Mapping) and set(given) == {"values"}:
            values = given["values"].tolist() if hasattr(given["values"], "tolist") else given["values"]
        if not isinstance(values, list | tuple) or not values or isinstance(values[0], Mapping):
            return given  # tables among them: no list of speeds
        return {"start": values[0], "stop": values[-1], "count": len(values), "values": list(values)}

    def table(self) -> dict[str, Any]:
        """Values as typed, by key."""
        return {"values": list(self.values)} if self.values else super().table()

    @classmethod
    def at(cls, speed: float) -> Speeds:
        """A single speed, rad/s, which is not checked."""
        return cls.model_construct(start=speed, stop=speed, count=1)

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """The last is not before the first, and one speed is one."""
        each = values.get("values", ())
        for k, (low, high) in enumerate(pairwise(each), 1):
            if not high > low:
                yield Conflict(("values", k), f"above the speed before it, {low:g} rad/s")
        if not {"start", "stop"} <= values.keys():
            return
        start, stop = values["start"], values["stop"]
        if each and (start, stop, values.get("count")) != (each[0], each[-1], len(each)):
            yield Conflict(("values",), "given alone, in place of start, stop and count")
            return
        if stop < start:
            yield Conflict(("stop",), f"at least speeds.start, {start:g} rad/s")
        elif values.get("count") == 1 and start != stop:
            yield Conflict(("count",), "at least 2 where speeds.start and speeds.stop differ")


class WallRoughness(Part):
    """The law of the wall on a wall that is not smooth."""

    roughness: Annotated[float, quantity(units.LENGTH, 0.0, 0.1)] = Field(
        description="height of the wall's roughness, as that of the sand in rough pipes"
    )


class FrictionCoefficient(Part):
    """A friction law with its coefficient; one of the three."""

    linear: Annotated[float | None, quantity(units.RATE, 0.0, 1e6)] = Field(
        None, description="force over mass and velocity"
    )
    quadratic: Annotated[float | None, quantity(units.NUMBER, 0.0, 1e3)] = Field(
        None, description="c_f, wall stress over density and velocity squared"
    )
    wall: WallRoughness | None = Field(
        None,
        description="mean flow as in a pipe, laminar to turbulent, and laminar layers for the waves",
    )


class FrictionRule:
    """A friction law by its name, or with its coefficient."""

    table = FrictionCoefficient
    allowed = (
        'one of: none, stokes, wall, { linear = "0.5 1/s" }, { quadratic = 0.01 }, '
        '{ wall = { roughness = "2 um" } }'
    )

    def __call__(self, value: object) -> Friction:
        """Law and coefficient, 0 where there is none."""
        if isinstance(value, Friction):
            return value
        if isinstance(value, str) and value in _LAWS:
            return Friction(FrictionLaw(value))
        if isinstance(value, str) and ":" in value:
            try:
                return units.parse_friction(value, "friction")
            except InputError as error:
                raise Refused(str(error.allowed)) from error
        if isinstance(value, dict):
            found = FrictionCoefficient.model_validate(value)
            if len(value) == 1 and found.linear is not None:
                return Friction(FrictionLaw.LINEAR, found.linear)
            if len(value) == 1 and found.quadratic is not None:
                return Friction(FrictionLaw.QUADRATIC, found.quadratic)
            if len(value) == 1 and found.wall is not None:
                return Friction(FrictionLaw.WALL, roughness=found.wall.roughness)
        raise Refused(self.allowed + meant(value, _LAWS))

    @staticmethod
    def written(value: Friction) -> object:
        """Law and coefficient as a file says them."""
        if value.roughness:
            return {value.law.value: {"roughness": value.roughness}}
        return value.law.value if value.law in _LAWS else {value.law.value: value.coefficient}


def friction_of(value: object, name: str) -> Friction:
    """A friction law: itself, its text as "linear:0.5", or its table as a file has it."""
    if isinstance(value, str):
        return units.parse_friction(value, name)
    try:
        return FrictionRule()(value)
    except ValueError as error:  # of the law, or of a number in its table
        raise InputError(name, repr(value), f"{FrictionRule.allowed}, or a text as linear:0.5") from error


def liquid_of(value: str | Liquid, name: str) -> Liquid:
    """A liquid, or the known one of that name."""
    if isinstance(value, Liquid):
        return value
    if not isinstance(value, str):
        raise InputError(name, repr(value), "the name of a known liquid, or a Liquid")
    return known_liquid(value)


class Model(Part):
    """How the liquid is modelled."""

    liquid: Annotated[str, PlainValidator(LiquidName(LIQUID_MODELS))] = Field(
        "auto", description="model of the liquid; a package may bring others"
    )
    friction: Annotated[Friction, PlainValidator(FrictionRule())] = Field(
        Friction(FrictionLaw.WALL), description="of the liquid on the wall"
    )
    tolerance: Annotated[float, quantity(units.NUMBER, 1e-12, 1.0)] = Field(
        1e-3, description="relative error that auto may make"
    )
    held: Annotated[str, one_of(*HELD)] = Field(
        "never",
        description="where auto may hold rotor and long waves in time, or kdv its own, which takes seconds a "
        "speed: never; where no steady model is within the tolerance or whirl is self-excited (auto); or "
        "always",
    )
    cells: Annotated[int, whole(16, MAX_CELLS)] = Field(
        128,
        description="finite volumes round each wall of a wave that is held; nodes of an exact one, even, of "
        "which it takes more where needed; points, even, of one by kdv",
    )


class Scene(Part):
    """One machine with its liquid: the content of a scene file, in SI units.

    Examples
    --------
    >>> from leblanc.scene.rotors import JeffcottRotor
    >>> scene = Scene(
    ...     name="Rig",
    ...     rotor=JeffcottRotor(
    ...         mass="4 kg", critical_speed="1000 rpm", damping_ratio=0.1, unbalance=6e-4, axis="horizontal"
    ...     ),
    ...     chambers=[Chamber(radius="65 mm", height="20 mm", volume="10 ml", liquid="water")],
    ...     speeds={"start": "100 rpm", "stop": "2000 rpm", "count": 20},
    ... )
    >>> scene.chambers[0].volume, scene.rotor.machine().mass
    (1e-05, 4.0)
    """

    name: Annotated[str, PlainValidator(Text(200))] = Field(description="of the machine, free text")
    source: Annotated[str, PlainValidator(Text(4000, may_be_empty=True))] = Field(
        "", description="where its values come from, free text"
    )
    assumed: Annotated[tuple[_Path, ...], entries(0, MAX_ASSUMED, "field paths")] = Field(
        (), description="paths of the values that the source does not give"
    )
    gravity: Annotated[float, quantity(units.ACCELERATION, 1e-6, 1e6, or_zero=True)] = Field(
        9.81, description="acceleration of gravity"
    )
    rotor: AnyRotor = Field(
        discriminator=Discriminator(rotor_tag), description="the machine without its liquid"
    )
    chambers: Annotated[tuple[AnyChamber, ...], entries(0, MAX_CHAMBERS, "tables headed [[chambers]]")] = (
        Field((), description="each with its liquid or its balls; without chambers [model] has no effect")
    )
    cabinet: Cabinet | None = Field(
        None,
        description="that stands on the floor around the rotor; forces under its feet are reported if given",
    )
    points: Annotated[tuple[Point, ...], entries(0, MAX_POINTS, "tables headed [[points]]")] = Field(
        (), description="named points whose orbits and clearances are reported, one table each"
    )
    speeds: Speeds = Field(description="at which the machine is studied")
    model: Model = Field(Model(), description="of the liquid")
    runup: Runup | None = Field(None, description="run-up for `leblanc runup`")
    programme: Programme | None = Field(
        None, description="spin programme for `leblanc runup`, in place of a run-up"
    )
    optimise: Optimisation | None = Field(
        None, description="what the liquid is chosen for by `leblanc optimise`"
    )

    @classmethod
    def as_table(cls, given: Any) -> Any:
        """The same with [run_up], another name, as [runup]; both are left for the check to refuse."""
        if not isinstance(given, Mapping) or "run_up" not in given or "runup" in given:
            return given
        return {"runup" if key == "run_up" else key: value for key, value in given.items()}

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """One table drives it, and what is assumed stands in the file."""
        yield from _ball_conflicts(values)
        yield from cabinet_conflicts(values, _kind(given.get("rotor")))
        if _kind(given.get("rotor")) == "spindle":
            yield from without_liquid(values, given)
        programme, rotor = values.get("programme"), values.get("rotor")
        if programme is not None:
            if given.get("runup") is not None:
                yield Conflict(("runup",), "left out where [programme] is given, which takes its place")
            told = programme.inertia is not None or rotor is None or polar_inertia_of(rotor)
            if programme.coasts and not told:
                text = "given where a step coasts and the rotor has no moment of inertia about its axis"
                yield Conflict(("programme", "inertia"), text)
        for number, path in enumerate(values.get("assumed", ())):
            if not _holds(given, path):
                text = "the path of a value that stands in this file, such as "
                yield Conflict(("assumed", number), f'{text}"rotor.mass" or "chambers.0.height"')

    @cached_property
    def file(self) -> str:
        """Where it was read from; empty where it was made, or changed, in Python."""
        return ""

    @cached_property
    def text(self) -> str:
        """Of its file, as it was typed; what a file would say where it was made, or changed, in Python.

        Empty where no file can say it, as of a section that is no file.
        """
        try:
            return self.to_toml()
        except TypeError:
            return ""

    @cached_property
    def fills(self) -> tuple[Fill, ...]:
        """The chambers with their liquids, as the solvers take them."""
        return tuple(chamber.fill() for chamber in self.liquids)

    @property
    def liquids(self) -> tuple[Chamber, ...]:
        """The chambers that hold liquid."""
        return tuple(chamber for chamber in self.chambers if isinstance(chamber, Chamber))

    @property
    def balls(self) -> tuple[BallRace, ...]:
        """The races with balls, which stand behind the chambers with liquid."""
        return tuple(chamber for chamber in self.chambers if isinstance(chamber, BallRace))

    @property
    def kind(self) -> str:
        """Kind of machine, by which a question finds who answers: "balls", or that of the rotor."""
        return "balls" if self.balls else self.rotor.kind

    def without_balls(self) -> Scene:
        """The same machine without its balls."""
        return self.altered(chambers=self.liquids) if self.balls else self

    def as_read(self) -> Scene:
        """The same machine; without chambers, whose liquid `[model]` is about, with the usual one."""
        return self if self.chambers else self.altered(model=Model())

    @property
    def speed_plan(self) -> Runup | Programme | None:
        """What takes the machine through its speeds in time: its run-up or its programme."""
        return self.runup if self.programme is None else self.programme

    def speed_array(self) -> NDArray[np.float64]:
        """Spin speeds, rad/s, shape (count,)."""
        import numpy as np

        if self.speeds.values:
            return np.array(self.speeds.values)
        return np.linspace(self.speeds.start, self.speeds.stop, self.speeds.count)

    def replace(self, changes: Mapping[str, Any]) -> Scene:
        """A scene with other values, checked as a file is.

        Parameters
        ----------
        changes : values by their paths, as in {"chambers.0.volume": "0.8 l"}

        Raises
        ------
        SceneError : a path that leads nowhere, values that are not allowed; all of them

        Examples
        --------
        >>> from leblanc.scene.examples import example
        >>> round(example("runup").replace({"chambers.0.volume": "0.8 l"}).chambers[0].volume, 9)
        0.0008
        """
        table, faults = self.table(), []
        for path, value in changes.items():
            try:
                require_field(Scene, table, path)
            except Refused as refused:
                faults.append(SceneFault("scene", path, shown(value), refused.allowed))
        if faults:
            raise SceneError(faults)
        table = with_values(table, [(keys_of(path), new) for path, new in changes.items()])
        if "assumed" not in changes and self.assumed:  # a mark goes with what it stood at
            table["assumed"] = [path for path in self.assumed if _holds(table, path)]
        return scene_from_table(table)

    def to_toml(self) -> str:
        """The scene as a file says it: what was given, quantities in SI units.

        Examples
        --------
        >>> from leblanc.scene.examples import example
        >>> print(example("runup").to_toml().splitlines()[0])
        name = "Run-up"
        """
        import tomli_w

        return tomli_w.dumps(self.table())

    @classmethod
    def from_toml(cls, text: str, file: str = "") -> Scene:
        """Scene from the text of a machine file.

        Parameters
        ----------
        text : its content
        file : its path, which faults name and beside which sections of chambers are looked for

        Raises
        ------
        SceneError : with everything that is wrong, not just the first

        Examples
        --------
        >>> from leblanc.scene.examples import example
        >>> Scene.from_toml(example("runup").to_toml()) == example("runup")
        True
        """
        return scene_from_table(scene_table(text, file or "scene"), file, text)

    def __repr__(self) -> str:
        chambers, speeds = len(self.chambers), self.speeds
        at = units.rpm_range(speeds.start, speeds.stop) if speeds.count > 1 else units.in_rpm(speeds.start)
        return (
            f"<Scene {self.name!r}: {self.rotor.kind}, {chambers} chamber{'' if chambers == 1 else 's'}, "
            f"{speeds.count} speed{'' if speeds.count == 1 else 's'} at {at}>"
        )

    __str__ = __repr__

    @property
    def digest(self) -> str:
        """Fingerprint of the content (SHA-256): the same however units, keys and blanks are written."""
        model = self.as_read().model
        content = {
            "name": self.name,
            "source": self.source,
            "assumed": self.assumed,
            "gravity": self.gravity,
            "rotor": rotor_content(self.rotor) | _leaving(self.rotor),
            "chambers": [chamber_content(fill) for fill in self.fills],
            "speeds": self.speeds.model_dump(exclude=None if self.speeds.values else {"values"}),
            "model": {
                "liquid": model.liquid,
                "friction": _friction_content(model.friction),
                "tolerance": model.tolerance,
            },
            "runup": None if self.runup is None else runup_content(self.runup),
        }
        # Results on disk are known by it: a scene without a part that came later keeps the one it had.
        if self.programme is not None:
            content["programme"] = self.programme.content()
        content |= machine_content(self)
        if self.optimise is not None:
            content["optimise"] = optimise_content(self.optimise)
        return fingerprint(content)


def _ball_conflicts(values: Mapping[str, Any]) -> Iterator[Conflict]:
    """Races stand behind the liquid, and on a rotor whose motion with balls is known."""
    chambers, rotor = values.get("chambers", ()), values.get("rotor")
    for k in [k for k, chamber in enumerate(chambers) if isinstance(chamber, BallRace)]:
        if any(isinstance(chamber, Chamber) for chamber in chambers[k + 1 :]):
            yield Conflict(("chambers", k), "behind the chambers with liquid in the file")
        if isinstance(rotor, Exciter):
            yield Conflict(("chambers", k), "left out for an exciter, which has balls of its own")
        elif chambers[k].start == "bottom" and rotor is not None and rotor.axis == "vertical":
            yield Conflict(("chambers", k, "start"), "spread where the axis stands and has no bottom")


def _friction_content(friction: Friction) -> dict[str, object]:
    """What a fingerprint takes of it; a smooth wall has what was there before walls could be rough."""
    rough = {"roughness": friction.roughness} if friction.roughness else {}
    return {"law": friction.law, "coefficient": friction.coefficient, **rough}


def _kind(rotor: object) -> object:
    """Kind of a rotor, from its table or its model."""
    return rotor.get("kind") if isinstance(rotor, Mapping) else getattr(rotor, "kind", None)


def _holds(table: object, path: str) -> bool:
    """Whether a value is given at that path."""
    for key in path.split("."):
        if isinstance(table, Mapping) and key in table:
            table = table[key]
        elif isinstance(table, Part) and (key in table.model_fields_set or key == "kind"):
            table = getattr(table, key, None)
        elif isinstance(table, list | tuple) and key.isdecimal() and len(key) < 7 and int(key) < len(table):
            table = table[int(key)]
        else:
            return False
    return True


SceneOrPath = Scene | Mapping[str, Any] | str | PathLike[str]


def scene_of(scene: SceneOrPath, field: str = "scene") -> Scene:
    """A scene itself, that of a table, or the one in that file; an `InputError` names what is none."""
    if isinstance(scene, Mapping):
        return scene_from_table(scene)
    if not isinstance(scene, Scene | str | PathLike):
        raise InputError(field, type(scene).__name__, "a Scene, its table, or the path of its file")
    return scene if isinstance(scene, Scene) else load_scene(scene)


def load_scene(path: str | PathLike[str]) -> Scene:
    """Scene from a TOML file.

    Parameters
    ----------
    path : the file

    Raises
    ------
    SceneError : with everything that is wrong, not just the first

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.load_scene("examples/horizontal_rig.toml").speeds.count
    201
    """
    if not isinstance(path, str | PathLike):
        raise InputError("path", type(path).__name__, "the path of a scene file")
    _tell_of_names()
    with with_lines(path):
        return Scene.from_toml(read_text(path), str(path))


@cache
def _tell_of_names() -> None:
    """Say once of names of machines and liquids that packages announce in vain, which a file may mean."""
    announced_machines()
    announced(LIQUIDS, LIQUID_MODELS)


def fault_in(path: str | PathLike[str], error: InputError) -> SceneError | None:
    """What a study refuses of a scene as a fault of its file: the value as it stands there, and its line.

    None where the error is not about a value of a scene.
    """
    if error.field.partition(".")[0] not in Scene.model_fields:
        return None
    stands, value, line = given_at(path, error.field)
    given = value if stands else error.value  # a default, or what follows from other values
    allowed = allowed_as_typed(error.allowed, given)
    return SceneError([SceneFault(str(path), error.field, shown(given), allowed, line)])


def scene_from_table(table: Mapping[str, Any], file: str = "", text: str = "") -> Scene:
    """Scene from the content of a TOML file, which is named in the faults of the `SceneError`; its text."""
    if "vary" in table and "rotor" not in table:
        text = "a scene; this is a study of many scenes, which `leblanc sweep` answers"
        raise SceneError([SceneFault(file or "scene", "", None, text)])
    try:
        scene = Scene.model_validate(table)
    except ValidationError as error:
        raise SceneError(faults_of(error, file or "scene", Scene)) from error
    vars(scene)["file"] = file
    if text:
        vars(scene)["text"] = text
    return scene


def jeffcott(scene: Scene) -> Jeffcott:
    """The scene's planar rotor without liquid; an `InputError` for a rotor of another kind."""
    if not isinstance(scene.rotor, JeffcottRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott for this")
    return scene.rotor.machine()


def require_clear(scene: Scene, what: str, baffles: bool = False) -> None:
    """Refuse sections from files, and baffles unless they are known.

    `what` is asked for, in words that follow "left out for".
    """
    for k, fill in enumerate(scene.fills):
        if fill.chamber.section is not None:
            raise InputError(f"chambers.{k}.section", fill.chamber.section.name, f"left out for {what}")
        if fill.chamber.baffles is not None and not baffles:
            raise InputError(
                f"chambers.{k}.baffles", f"{fill.chamber.baffles.count} of them", f"left out for {what}"
            )


def require_whirl(scene: Scene, known: bool = False) -> None:
    """Refuse an exciter, a spindle and a rotor in magnetic bearings: the question is for one that whirls.

    `known`: machines of other packages as well, of which the parts and masses are not known.
    """
    if isinstance(scene.rotor, (*WITHOUT_CHAMBERS, *((Machine,) if known else ()))):
        raise not_taken(scene.rotor.kind)


def require_no_balls(scene: Scene, what: str) -> None:
    """Refuse balls for `what`, which follows "left out for"."""
    if scene.balls:
        raise InputError(f"chambers.{len(scene.liquids)}.kind", "balls", f"left out for {what}")


def require_chambers(scene: Scene, what: str) -> None:
    """Refuse a scene without chambers for `what`, unless its kind of rotor never has any."""
    if not scene.chambers and not isinstance(scene.rotor, WITHOUT_CHAMBERS):
        raise InputError("chambers", "none", f"at least one for {what}")


def dry_rotor(scene: Scene) -> Jeffcott | TwoPlane | Tub:
    """The scene's rotor without liquid, whose `system()` gives its equations of motion.

    An `InputError` for a rotor without chambers: an exciter, a spindle, or in magnetic bearings.
    """
    if isinstance(scene.rotor, WITHOUT_CHAMBERS):
        raise not_taken(scene.rotor.kind)
    return scene.rotor.machine()


_DIGITS = 10  # of each number; spellings of one value differ in the sixteenth


def fingerprint(content: dict[str, Any]) -> str:
    """SHA-256 of what a scene says, numbers to ten digits."""
    return hashlib.sha256(json.dumps(_rounded(content), sort_keys=True).encode()).hexdigest()


def rotor_content(rotor: AnyRotor) -> dict[str, Any]:
    """What the machine is, whichever of two alternatives says so."""
    if isinstance(rotor, JeffcottRotor):
        return asdict(rotor.machine()) | {"kind": rotor.kind, "axis": rotor.axis}
    if isinstance(rotor, Exciter):
        balls = rotor.balls.model_dump()
        balls |= {"kind": rotor.balls.name, "pendulum_inertia": rotor.balls.pendulum_inertia or 0.0}
        return rotor.model_dump(exclude={"balls"}) | {"balls": balls}
    if isinstance(rotor, Spindle):
        return rotor.content()
    if isinstance(rotor, MagneticRotor | Machine):
        return rotor.model_dump()
    machine = asdict(rotor.machine())
    if not machine.get("loads", True):
        del machine["loads"]
    return {"kind": rotor.kind, "machine": machine, "axis": rotor.axis}


def _leaving(rotor: AnyRotor) -> dict[str, Any]:
    """What leaves of its unbalances; nothing where nothing does."""
    sheds = [None if part is None else part.model_dump() for part in sheds_of(rotor)]
    return {"sheds": sheds} if any(part is not None for part in sheds) else {}


def chamber_content(fill: Fill) -> dict[str, Any]:
    """What a chamber is and holds; a part that came later counts only where there is one."""
    chamber = fill.chamber
    walls: dict[str, Any] = {
        "radius": chamber.radius,
        "height": chamber.height,
        "inner_radius": chamber.inner_radius,
        "plane": chamber.plane,
    }
    if chamber.baffles is not None:
        plates = asdict(chamber.baffles)
        if chamber.baffles.loss is None:
            del plates["loss"]
        walls["baffles"] = plates
    if chamber.section is not None:
        walls["section"] = chamber.section.digest
    liquid = asdict(fill.liquid)
    if fill.liquid.law is None:
        del liquid["law"]
    else:
        liquid["law"]["kinds"] = _kinds(fill.liquid.law)
    return {"chamber": walls, "liquid": liquid, "volume": fill.volume}


def _kinds(law: object) -> list[str]:
    """Which laws these are, where their numbers may be alike."""
    inside = [getattr(law, name, None) for name in ("density", "viscosity")]
    return [type(part).__name__ for part in (law, *inside)]


def runup_content(plan: Runup) -> dict[str, Any]:
    """How the speed goes and how that is resolved."""
    usual = {"bore": "none", "capture": "carried"}
    left_out = {key for key, value in usual.items() if getattr(plan, key) == value}
    return plan.model_dump(exclude={"ramp_time", *left_out})  # the rate says it


def machine_content(scene: Scene) -> dict[str, Any]:
    """Cabinet, points, bearings and balls, as far as there are any."""
    bearings = getattr(scene.rotor, "bearings", ())
    caged = scene.rotor.caged() if isinstance(scene.rotor, TubRotor | TwoPlaneRotor) else ()
    parts = {
        "cabinet": scene.cabinet and scene.cabinet.model_dump(),
        "points": [point.model_dump() for point in scene.points],
        "bearings": [bearing.position for bearing in bearings],
        "balls": [race_content(race) for race in scene.balls],
        "rolling": [asdict(part) for part in caged],
    }
    return {name: part for name, part in parts.items() if part}


def race_content(race: BallRace) -> dict[str, Any]:
    """What a race is, whichever of two alternatives says so."""
    liquid = None if race.liquid is None else asdict(race.liquid)
    turned = {"start_angle": race.start_angle} if race.start_angle else {}
    return asdict(race.race()) | {"start": race.start, "liquid": liquid, "diameter": race.diameter} | turned


def optimise_content(wanted: Optimisation) -> dict[str, Any]:
    """What the liquid is chosen for."""
    duty = [(stage.speed, stage.weight) for stage in wanted.duty]
    later = {"balance_quality", "floor_force", "walking_margin", "point_clearance", "balls"}
    later = {name for name in later if getattr(wanted, name) is None}
    return wanted.model_dump(exclude={"duty", *later}) | {"duty": duty}


def _rounded(value: Any) -> Any:
    """The same with every float as a text of a few digits."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(entry) for entry in value]
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else value
