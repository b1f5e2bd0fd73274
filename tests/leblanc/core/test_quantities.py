"""Quantities of an answer read from its declarations: names, parts, nested records, rows, left out."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np
import pytest

from leblanc.core.answer import Answer
from leblanc.core.netcdf import Variable, variable
from leblanc.core.notes import Note, NoteCode
from leblanc.core.quantities import named_arrays, names, plain, quantities, to_json
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from meshes.quantity import Q
from tests.mutants import kills

TWO = np.array([1.0, 2.0])
AT = "leblanc.core.quantities"


class Code(NoteCode):
    """Codes of the notes here."""

    ONE = "one"


@dataclass(frozen=True)
class Motion:
    """A part: its quantities are the answer's."""

    lean: Annotated[Array, Q("rad", "lean", over=("speed",))]
    amplitude: Annotated[Array, Q("m", "largest", over=("speed",), key="size", text="zero to peak")]


@dataclass(frozen=True)
class Drawn:
    """A part that says itself how it is written."""

    cycles: int

    def to_json(self) -> dict[str, int]:
        return {"cycles": 3 * self.cycles}

    def variables(self) -> dict[str, Variable]:
        return {"cycles": variable((), 2.0 * self.cycles, "1", "cycles")}


@dataclass(frozen=True)
class Curve:
    """A record with an axis of its own."""

    speed: Annotated[Array, Q("rad s-1", "speed", over=("speed",))]
    size: Annotated[Array, Q("m", "size", over=("speed",))]
    left_out: Annotated[Array, Q("m", "left out", over=("speed",))]


@dataclass(frozen=True)
class Row:
    """One of several."""

    gain: Annotated[float, Q("1", "gain")]
    path: Annotated[Array, Q("m", "path", over=("speed",), variable="path")]
    poles: Annotated[Array, Q("s-1", "poles", over=("pole",), data=False)]


@dataclass(frozen=True)
class Layer:
    """A record in rows, with one in it."""

    depth: Annotated[float, Q("m", "depth")]
    numbers: Annotated[Motion | None, Q(prefix="numbers")]
    wet: Annotated[bool, Q(name="wet", flags="no yes")]


@dataclass(frozen=True)
class Several:
    """Records of which some are not there."""

    whirl: Annotated[Layer | None, Q(prefix="whirl")]
    layers: Annotated[tuple[Layer | None, ...], Q(rows="layer")]


@dataclass(frozen=True)
class Whole(Answer):
    """An answer with one of each."""

    command = "whole"

    speed: Annotated[Array, Q("rad s-1", "speed", over=("speed",))]
    deflection: Annotated[Complex, Q("m", "deflection", over=("speed",), axes=("along", "ahead"))]
    state: Annotated[Array, Q(name="state", over=("speed",), flags="wet unknown dry")]
    ratio: Annotated[float, Q("1", "ratio", variable="share")]
    motion: Annotated[Motion | None, Q(part=True)]
    drawn: Annotated[Drawn | None, Q(part=True)]
    gap: Annotated[float | None, Q("m", "gap", when="gap")]
    refined: Annotated[Curve | None, Q(prefix="curve", only=("speed", "size"), when="refined")]
    rows: Annotated[tuple[Row, ...], Q(rows="row")]
    notes: Annotated[tuple[Note, ...], Q(text="what a reader must know", data=False)]

    def blocks(self) -> tuple[()]:
        return ()


@pytest.fixture(autouse=True)
def read_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Declarations are kept by class; a mutant must read them itself."""
    monkeypatch.setattr("leblanc.core.quantities._FOUND", {})


def whole() -> Whole:
    """Every way to declare, each with numbers of its own."""
    return Whole(
        speed=TWO,
        deflection=np.array([1 + 2j, complex(math.nan, 5.0)]),
        state=np.array(["wet", "dry"]),
        ratio=0.5,
        motion=Motion(3.0 * TWO, 4.0 * TWO),
        drawn=Drawn(7),
        gap=0.25,
        refined=Curve(np.arange(3.0), 5.0 * np.arange(3.0), np.zeros(3)),
        rows=(Row(0.5, 6.0 * TWO, np.zeros(1)), Row(0.7, 8.0 * TWO, np.zeros(2))),
        notes=(Note(Code.ONE, {}, "Mind the gap."),),
    )


@kills(f"{AT}:_declared", "key = each.key or name", "key = name")
@kills(f"{AT}:to_json", "only and key not in only", "False")
@kills(f"{AT}:plain", "return value.text", "return str(value.code)")
def test_json_has_each_quantity_once_under_its_public_name() -> None:
    assert whole().to_json() == {
        "speed": [1.0, 2.0],
        "deflection": [[1.0, 2.0], [None, None]],
        "state": ["wet", "dry"],
        "ratio": 0.5,
        "lean": [3.0, 6.0],
        "size": [4.0, 8.0],
        "cycles": 21,
        "gap": 0.25,
        "refined": {"speed": [0.0, 1.0, 2.0], "size": [0.0, 5.0, 10.0]},
        "rows": [
            {"gain": 0.5, "path": [6.0, 12.0], "poles": [0.0]},
            {"gain": 0.7, "path": [8.0, 16.0], "poles": [0.0, 0.0]},
        ],
        "notes": ["Mind the gap."],
    }


@kills(f"{AT}:plain", "finite(wide)", "finite(value)")
@kills("leblanc.core.answer:Answer.__init_subclass__", "_plain(cls.to_json)", "cls.to_json")
def test_json_of_an_answer_of_another_package_is_json_whatever_its_numbers_are() -> None:
    """Also what its `to_json` adds: complex numbers in two parts, None for what is not finite."""

    def own(answer: Whole) -> dict[str, object]:
        added = {"of_its_own": 1j, "missing": math.nan, "long": np.clongdouble(2.0 + 3.0j)}
        return added | {"longs": np.array([1j, np.inf], np.clongdouble), "real": np.longdouble(0.5)}

    class Longer(Whole):
        to_json = own

    parts = {name: getattr(whole(), name) for name in Whole.__dataclass_fields__}
    found = Longer(**parts).to_json()
    assert isinstance(found["longs"], list) and type(found["longs"][0][1]) is float
    assert found == {
        "of_its_own": [0.0, 1.0],
        "missing": None,
        "long": [2.0, 3.0],
        "longs": [[0.0, 1.0], [None, None]],
        "real": 0.5,
    }


@kills(f"{AT}:_with_parts", 'f"{q.prefix}_{dim}" if dim in dims', "dim if dim in dims")
@kills(f"{AT}:_columns", "each.q.variable or ", "")
@kills(f"{AT}:_columns", "(dim, *each.q.over)", "(*each.q.over, dim)")
@kills(f"{AT}:_variables", "complex(math.nan, math.nan), values)", "values, values)")
@kills(f"{AT}:_variables", "+ 2 - len(meanings)", "+ 0")
def test_variables_have_names_units_and_dimensions() -> None:
    found = named_arrays(whole())
    everything = found.arrays | found.coords
    assert {name: one.dims for name, one in everything.items()} == {
        "speed": ("speed",),
        "curve_speed": ("curve_speed",),
        **dict.fromkeys(("deflection_real", "deflection_imag", "state", "lean", "size"), ("speed",)),
        **dict.fromkeys(("share", "cycles", "gap"), ()),
        "curve_size": ("curve_speed",),
        "row_gain": ("row",),
        "path": ("row", "speed"),
    }
    assert set(found.coords) == {"speed", "curve_speed"}
    np.testing.assert_array_equal(everything["path"].values, [6.0 * TWO, 8.0 * TWO])
    np.testing.assert_array_equal(everything["deflection_imag"].values, [2.0, math.nan])
    assert everything["state"].values.tolist() == [-1, 1]
    assert everything["cycles"].values == 14.0 and everything["curve_speed"].values.size == 3


@kills(f"{AT}:_of", "if there is not None and", "if True or")
def test_what_is_not_there_is_left_out() -> None:
    bare = replace(whole(), gap=None, refined=None, motion=None, drawn=None, rows=())
    assert {"gap", "refined", "lean", "size", "cycles"}.isdisjoint(bare.to_json())
    found = named_arrays(bare)
    assert {*found.arrays, *found.coords} == {"speed", "deflection_real", "deflection_imag", "state", "share"}


@kills(f"{AT}:_scalars", "not each.q.over", "each.q.over")
def test_records_that_are_not_there_are_null_and_nan() -> None:
    """As numbers are; of records in rows as well, where a part may be the one that lacks."""
    layer = Layer(0.5, whole().motion, True)
    found, rows = named_arrays(Several(None, (None, layer))), ("layer",)
    assert to_json(Several(None, (None, layer)))["whirl"] is None
    assert {"whirl_depth", "whirl_size", "whirl_wet"} & {*found.arrays} == {"whirl_depth"}
    assert np.isnan(found.arrays["whirl_depth"].values)
    np.testing.assert_array_equal(found.arrays["layer_depth"].values, [math.nan, 0.5])
    assert found.arrays["layer_wet"].values.tolist() == [0, 1]
    assert found.arrays["layer_size"].dims == (*rows, *quantities(Motion)["size"].over)
    assert np.isnan(found.arrays["layer_size"].values[0]).all()


@kills(f"{AT}:reached", "return None", "continue")
def test_quantities_of_parts_are_the_answer_s() -> None:
    """By their public names; None where the answer has no such part, an error where nothing declares them."""
    answer = whole()
    np.testing.assert_array_equal(answer.size, 4.0 * TWO)
    assert getattr(replace(answer, motion=None), "size", "lost") is None
    assert {"lean", "size", "ratio"} <= names(Whole) and {"lean", "size"} <= set(dir(answer))
    assert quantities(Motion)["size"].text == "zero to peak"
    with pytest.raises(AttributeError, match="'Whole' object has no attribute 'breadth'"):
        answer.breadth  # noqa: B018


def test_what_has_no_form_in_json_is_refused() -> None:
    with pytest.raises(TypeError, match="object has no form in JSON"):
        plain(object())


@dataclass(frozen=True)
class Wall:
    """A record whose declaration is changed below."""

    speed: Annotated[float, Q("rad s-1", "spin speed")]
    wall: Annotated[Array, Q("m s-1", "speed of the wall", over=("chamber",))]


def wall_of(q: Q, value: object = TWO) -> Wall:
    """A record like it with another declaration, and a value."""
    said = {"speed": Wall.__annotations__["speed"], "wall": Annotated[Array, q]}
    kind = type("Wall", (), {"__annotations__": said, "__module__": __name__})
    return dataclass(frozen=True)(kind)(3.0, value)


GOOD = Q("m s-1", "speed of the wall", over=("chamber",))
UNREAD = [
    (replace(GOOD, key="speed"), r"Wall\.wall = 'speed': must be a name of its own; Wall\.speed has it"),
    (replace(GOOD, unit="banana"), r"Wall\.wall\.unit = 'banana': must be a unit"),
    (replace(GOOD, unit="3 m"), r"Wall\.wall\.unit"),
    (replace(GOOD, unit=3), r"Wall\.wall\.unit = 3: must be a unit"),  # type: ignore[arg-type]
    (replace(GOOD, over="chamber"), r"Wall\.wall\.over = 'chamber'"),  # type: ignore[arg-type]
    (replace(GOOD, when="nothing"), r"Wall\.wall = 'nothing': must be an attribute of Wall"),
    (replace(GOOD, text="{0.nothing}"), r"Wall\.wall = 'nothing': must be an attribute of Wall"),
]


@pytest.mark.parametrize(("q", "said"), UNREAD)
def test_a_declaration_that_cannot_hold_is_refused_as_the_class_is_read(q: Q, said: str) -> None:
    made = wall_of(q)
    for _ in range(2):  # the second time as well
        with pytest.raises(InputError, match=said):
            quantities(type(made))


def test_units_are_those_that_pint_knows() -> None:
    for unit in ("", "1", "m s-1", "m/s", "N m rad-1", "m4", "degC", "mm s-1", "{0.speed}"):
        assert quantities(type(wall_of(replace(GOOD, unit=unit))))["wall"].unit == unit


@kills(f"{AT}:_variables", "values.ndim != len(q.over) or not (", "not (")
def test_a_value_unlike_its_declaration_is_named() -> None:
    assert named_arrays(wall_of(GOOD)).sizes == {"chamber": 2}
    for value in (3.0, np.ones((2, 2)), TWO * 1j, np.array([None, 1.0]), "text", {1, 2}):
        said = ""
        try:
            named_arrays(wall_of(GOOD, value))
        except InputError as error:
            said = str(error)
        assert said.startswith("wall = ") and "over (chamber)" in said, value
    with pytest.raises(InputError, match=r"Wall\.wall = 'set'"):
        to_json(wall_of(GOOD, {1, 2}))
