"""Records in rows: their quantities side by side in the data file."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from leblanc.core.quantities import named_arrays, to_json
from meshes.arrays import Array
from meshes.quantity import Q


@dataclass(frozen=True)
class Part:
    """One row."""

    gain: Annotated[float, Q("1", "gain")]
    size: Annotated[Array, Q("m", "size", over=("speed",), variable="size")]
    poles: Annotated[Array, Q("s-1", "poles", over=("pole",), data=False)]


@dataclass(frozen=True)
class Whole:
    """An answer with two rows."""

    parts: Annotated[tuple[Part, ...], Q(rows="part")]


def test_rows_are_named_after_their_dimension_unless_they_say_their_name() -> None:
    """What the data leave out may have another length in each row."""
    first, second = np.array([1.0, 2.0, 3.0]), np.array([4.0, 5.0, 6.0])
    whole = Whole((Part(0.5, first, np.zeros(1)), Part(0.7, second, np.zeros(2))))
    found = named_arrays(whole).arrays
    assert set(found) == {"part_gain", "size"}
    assert found["part_gain"].dims == ("part",) and found["part_gain"].values.tolist() == [0.5, 0.7]
    assert found["size"].dims == ("part", "speed")
    np.testing.assert_array_equal(found["size"].values, [first, second])
    assert [len(part["poles"]) for part in to_json(whole)["parts"]] == [1, 2]
