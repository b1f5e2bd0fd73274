"""Every declared answer is compared by value, is not changed, says in a line what it is, and is JSON."""

from __future__ import annotations

import copy
import json
import pickle
from dataclasses import fields, replace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest

import leblanc as lb
from leblanc.core.answer import Later, later
from leblanc.core.quantities import alike, seal
from meshes.errors import InputError
from tests.leblanc.core.answers import ASKED, answer
from tests.mutants import kills


@pytest.mark.usefixtures("_exciter_once")
@pytest.mark.parametrize("kind", ASKED)
def test_an_answer_is_a_value(kind: str) -> None:
    found = answer(kind)
    again = copy.deepcopy(found)
    assert found == again
    assert hash(found) == hash(again)
    assert found != 7
    assert json.loads(json.dumps(found.to_json(), allow_nan=False)) == json.loads(json.dumps(again.to_json()))
    said = repr(found)
    assert said.startswith(f"<{type(found).__name__}")
    assert "\n" not in said
    assert len(said) < 300


@pytest.mark.parametrize("kind", ASKED)
def test_its_arrays_are_not_changed(kind: str) -> None:
    found = answer(kind)
    arrays = {
        one.name: value
        for one in fields(found)  # type: ignore[arg-type]
        if isinstance(value := getattr(found, one.name), np.ndarray)
    }
    seal(found)
    for name, array in arrays.items():
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 0
        if array.dtype.kind == "f":
            assert found != replace(found, **{name: array + 1.0}), name  # type: ignore[type-var]


@pytest.mark.parametrize("kind", ASKED)
def test_what_is_computed_is_not_changed(kind: str) -> None:
    """An array that a property computes is written into in vain: it says so."""
    found = answer(kind)
    read = [getattr(found, name) for name in dir(found) if not name.startswith("_")]
    tables = [[one] if isinstance(one, np.ndarray) else one for one in read]
    arrays = [
        array
        for table in tables
        for array in (
            table.values() if isinstance(table, dict) else table if isinstance(table, list | tuple) else ()
        )
        if isinstance(array, np.ndarray)
    ]
    assert not any(array.flags.writeable for array in arrays)


def test_values_alike() -> None:
    nan = float("nan")
    assert alike((nan, [1, {"a": np.array([nan, 1.0])}]), (nan, [1, {"a": np.array([nan, 1.0])}]))
    for one, other in (
        (1, 1.0),
        (nan, 0.0),
        ([1], [1, 2]),
        ({"a": 1}, {"b": 1}),
        (np.zeros(2), np.zeros(3)),
        (np.zeros(2), np.zeros(2, dtype=complex)),
        (np.zeros(2), [0.0, 0.0]),
        (np.array(["a"]), np.array(["b"])),
    ):
        assert not alike(one, other)


def test_a_figure_of_one_axes_is_drawn_on_others() -> None:
    figure, axes = plt.subplots()
    assert answer("bearing").plot(ax=axes) is figure
    assert len(axes.patches) == 4
    assert axes.get_xlabel() == "Frequency (Hz)"
    assert figure.axes == [axes]
    with pytest.raises(InputError, match="3 axes, not one"):
        answer("periods").plot(ax=axes)
    with pytest.raises(InputError, match="axes of matplotlib"):
        answer("bearing").plot(ax=figure)
    plt.close(figure)


BEARING: dict[str, Any] = {"speed": 200.0, "balls": 9, "ball_diameter": "7 mm", "pitch_diameter": "31 mm"}
LAYER: dict[str, Any] = {
    **{"radius": 0.15, "height": 0.05, "volume": 6.7e-4, "speed": 40.0},
    **{"whirl_speed": 32.0, "whirl_amplitude": 1.5e-4},
}


@pytest.mark.parametrize(
    ("question", "given", "name", "allowed"),
    [
        ("bearing", BEARING | {"balls": 9.0}, "balls", "a whole number"),
        ("bearing", BEARING | {"balls": np.arange(3)}, "balls", "a whole number"),
        ("bearing", BEARING | {"balls": True}, "balls", "a whole number"),
        ("bearing", BEARING | {"ftf": "fast"}, "ftf", "a number"),
        ("bearing", BEARING | {"speed": [200.0]}, "speed", ""),
        ("bearing", BEARING | {"speed": np.ones(2)}, "speed", ""),
        ("bearing", BEARING | {"speed": None}, "speed", ""),
        ("layer", LAYER | {"model": 3}, "model", "a text"),
        ("layer", LAYER | {"dispersion": "yes"}, "dispersion", "True or False"),
        ("layer", LAYER | {"friction": {"linaer": 0.5}}, "friction", "linear"),
        ("layer", LAYER | {"friction": {"linear": "0.5 kg"}}, "friction", "linear"),
        ("layer", LAYER | {"friction": 0.5}, "friction", "linear"),
        ("layer", LAYER | {"liquid": 7}, "liquid", "known liquid"),
    ],
)
def test_a_wrong_argument_is_named(question: str, given: dict[str, Any], name: str, allowed: str) -> None:
    with pytest.raises(InputError) as refused:
        getattr(lb, question)(**given)
    assert refused.value.field == name
    assert allowed in refused.value.allowed


def test_numbers_of_numpy_are_numbers() -> None:
    own = lb.bearing(**BEARING | {"balls": np.int64(9), "speed": np.float64(200.0)})
    assert own == lb.bearing(**BEARING)


@kills("leblanc.core.answer:Later.__call__", "self._value = call()", "pass")
@kills("leblanc.core.answer:Answer.__getstate__", "getattr(self, name)", "vars(self)[name]")
def test_what_is_worked_out_later() -> None:
    """Once, when it is first read, for all that stand on it; a copy has the value, which is read-only."""
    scene = lb.example("centrifuge")
    calls: list[int] = []

    def quality() -> np.ndarray:
        calls.append(1)
        return np.arange(3.0)

    known = lb.run(scene)
    shared = later(quality)
    found = replace(known, balance_quality=shared, balance_quality_dry=shared)
    seal(found)
    assert not calls and isinstance(vars(found)["balance_quality"], Later)
    assert np.asarray(found.balance_quality).tolist() == [0.0, 1.0, 2.0]
    assert found.balance_quality is found.balance_quality_dry and len(calls) == 1
    with pytest.raises(ValueError, match="read-only"):
        found.balance_quality[0] = 1.0
    fresh = lb.run(scene)
    assert any(isinstance(value, Later) for value in vars(fresh).values())
    assert not any(isinstance(value, Later) for value in vars(pickle.loads(pickle.dumps(fresh))).values())
    assert pickle.loads(pickle.dumps(fresh)) == known
