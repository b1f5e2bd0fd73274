"""Data files: what our writer writes is what xarray has of the same result."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

from leblanc.core.netcdf import NamedArrays, Variable, read_values, variable, write_netcdf
from meshes.errors import InputError
from tests.oracles.data_files import assert_read_back


def numbers(*dims: str, shape: tuple[int, ...] = ()) -> Variable:
    count = int(np.prod(shape)) if shape else 1
    return variable(dims, np.arange(count, dtype=float).reshape(shape), "m", "numbers")


KINDS = {
    "numbers with gaps": NamedArrays(
        {"a": variable(("x",), [1.0, np.nan, np.inf], "m", "a"), "b": numbers("x", "y", shape=(3, 2))},
        {"x": variable(("x",), [0.1, 0.2, 0.3], "s-1", "x")},
        {"title": "Schleuder \N{SNOWMAN}", "count": np.int32(3), "share": 0.1, "many": np.arange(3.0)},
    ),
    "whole numbers and texts": NamedArrays(
        {
            "flag": variable(("x",), np.array([0, -1], dtype=np.int8), "1", "flag"),
            "word": variable(("x",), np.array(["linear", "\N{GREEK SMALL LETTER OMEGA}"]), "1", "word"),
            "reason": variable(("x",), np.array(["", "a\nb"], dtype=object), "1", "reason"),
            "single": variable((), np.array("one"), "1", "single"),
            "small": variable((), np.float32(0.1), "1", "small"),
        },
        {"x": variable(("x",), np.array([1, 2], dtype=np.int32), "1", "x")},
        {},
    ),
    "nothing along a dimension": NamedArrays(
        {
            "edge": numbers("x", "band", shape=(2, 0)),
            "word": variable(("band",), np.zeros(0, "U1"), "1", "word"),
        },
        {"x": numbers("x", shape=(2,))},
        {},
    ),
    "coordinates that are no dimensions": NamedArrays(
        {"a": numbers("x", shape=(2,)), "b": numbers("x", "y", shape=(2, 3)), "c": numbers()},
        {
            "place": numbers("x", shape=(2,)),
            "height": numbers("x", "y", shape=(2, 3)),
            "alone": numbers("z", shape=(4,)),
        },
        {},
    ),
    "a table with the name of its dimension": NamedArrays(
        {"amplitude": numbers("sample", "speed", shape=(2, 3)), "volume": numbers("sample", shape=(2,))},
        {"speed": numbers("sample", "speed", shape=(2, 3))},
        {},
    ),
}


@pytest.mark.parametrize("kind", KINDS)
def test_a_file_is_the_dataset(kind: str, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert_read_back(KINDS[kind], tmp_path)


def test_what_netcdf_does_not_know_is_refused() -> None:
    with pytest.raises(InputError, match="real numbers or texts"):
        variable(("x",), np.zeros(3, dtype=complex), "m", "deflection")
    with pytest.raises(InputError, match="real numbers or texts"):
        variable(("x",), np.zeros(3, dtype=bool), "1", "stable")
    with pytest.raises(InputError, match="2 names"):
        variable(("x",), np.zeros((3, 2)), "m", "deflection")
    with pytest.raises(InputError, match="along x"):
        NamedArrays({"a": numbers("x", shape=(2,)), "b": numbers("x", shape=(3,))}, {}, {})


def test_a_file_that_is_none_is_refused(tmp_path: Path) -> None:
    """Half a file, and one of another kind, in one line."""
    path = tmp_path / "data.nc"
    values = np.arange(1000.0)
    write_netcdf(NamedArrays({"x": variable(("k",), values, "m", "x")}, {}, {}), path)
    assert np.array_equal(read_values(path)["x"], values)
    content = path.read_bytes()
    for changed in (b"", b"no netCDF", content[: len(content) // 2], content[:-1]):
        path.write_bytes(changed)
        with pytest.raises(InputError, match="a netCDF 4 file") as caught:
            read_values(path)
        assert "\n" not in str(caught.value)
