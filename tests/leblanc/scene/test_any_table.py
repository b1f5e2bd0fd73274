"""Whatever stands in a file, it is a scene or a list of faults."""

from __future__ import annotations

import math
import tomllib
from dataclasses import asdict
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from leblanc.scene.scene import Exciter, Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.scene.schema.part import parts_of
from leblanc.scene.schema.paths import tables_of
from tests.leblanc.scene.test_scene import TEXT

VALUES = st.one_of(
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=8),
    st.dates(),
    st.sampled_from(
        [
            "1 m",
            "4 kg",
            "1000 rpm",
            "10 ml",
            "water",
            "jeffcott",
            "two_plane",
            "tub",
            "exciter",
            "magnetic",
            "vertical",
            "stokes",
            10**400,
            0.1,
        ]
    ),
)
KEYS = st.one_of(
    st.sampled_from(
        sorted(
            {
                key
                for kind in parts_of(Scene.model_fields["rotor"])
                for table in tables_of(Scene, kind).values()
                for key in table.model_fields
            }
        )
    ),
    st.text(max_size=4),
)
CONTENTS = st.recursive(
    VALUES,
    lambda inner: st.one_of(st.lists(inner, max_size=3), st.dictionaries(KEYS, inner, max_size=4)),
    max_leaves=12,
)


@settings(max_examples=200)
@given(st.dictionaries(KEYS, CONTENTS, max_size=6))
def test_any_table_is_a_scene_or_a_list_of_faults(table: dict[str, Any]) -> None:
    with pytest.raises(SceneError) as caught:
        scene_from_table(table)
    for fault in caught.value.faults:
        assert str(fault).startswith("scene: ")
        assert str(fault).isprintable()
        assert "must be" in str(fault)


PATHS = [
    (section, key)
    for section in ("rotor", "speeds", "model", "runup")
    for key in tomllib.loads(TEXT)[section]
]


@settings(max_examples=200)
@given(st.sampled_from(PATHS), CONTENTS)
def test_any_value_in_a_good_scene_is_taken_or_named(path: tuple[str, str], value: Any) -> None:
    table = tomllib.loads(TEXT)
    table[path[0]][path[1]] = value
    try:
        scene = scene_from_table(table)
    except SceneError as error:
        assert all(fault.field.startswith(path[0]) for fault in error.faults)
        return
    assert not isinstance(scene.rotor, Exciter)
    numbers = [entry for entry in asdict(scene.rotor.machine()).values() if isinstance(entry, float)]
    assert all(map(math.isfinite, numbers))
