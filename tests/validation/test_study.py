"""Studies as commands, and records that are kept as JSON."""

from __future__ import annotations

import math
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np
import pytest

from meshes.arrays import Array, Flags
from tests import exact_whirl, models
from tests.exact_whirl import held
from tests.mutants import kills
from validation import breaking, exact
from validation.study import launch, read, write


@dataclass(frozen=True)
class Part:
    size: float
    name: str | None


@dataclass(frozen=True)
class Whole:
    parts: tuple[Part, ...]
    values: Array
    flags: Flags
    models: Mapping[str, Array]


@kills("validation.study:plain", "return None", "return 0.0")
@kills("validation.study:built", "math.nan if value is None else value for value", "value or 0.0 for value")
def test_records_come_back(tmp_path: Path) -> None:
    whole = Whole(
        (Part(1.0 / 3.0, None), Part(math.inf, "b")),
        np.array([0.1, math.nan]),
        np.array([True, False]),
        {"a": np.array([2.0])},
    )
    file = tmp_path / "kept.json"
    write(file, whole)
    found = read(file, Whole)
    assert found.parts[0] == whole.parts[0] and math.isnan(found.parts[1].size)
    np.testing.assert_array_equal(found.values, whole.values)
    np.testing.assert_array_equal(found.flags, whole.flags)
    assert found.flags.dtype == bool and found.models["a"] == 2.0
    write(file, whole, digits=3, compact=True)
    assert '"size":0.333,' in file.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("file", "kind", "compact"),
    [
        (exact.KEPT, exact.Measured, True),
        (exact_whirl.KEPT, exact_whirl.Kept, True),
        (breaking.KEPT, breaking.Kept, False),
        (models.KEPT, tuple[models.ModelTable, ...], False),
        (held.KEPT, tuple[held.Pair, ...], False),
    ],
)
def test_kept_files_are_written_as_they_are(
    file: Path, kind: type[object], compact: bool, tmp_path: Path
) -> None:
    """Nothing is lost between file and records, to the last digit."""
    write(tmp_path / "kept.json", read(file, kind), compact=compact)
    assert (tmp_path / "kept.json").read_bytes() == file.read_bytes()


def test_options_are_the_parameters(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def study(
        *names: str, out: Path, count_all: int = 3, kind: Literal["a", "b"] | None = None, quick: bool = False
    ) -> Iterator[object]:
        yield from (names, out, count_all, kind, quick)

    monkeypatch.setattr(sys, "argv", ["x", "--out", "o", "--quick", "--kind", "b", "--count-all", "4", "n"])
    launch(study)
    assert capsys.readouterr().out.split("\n") == ["('n',)", "o", "4", "b", "True", ""]
    for wrong in (["--kind", "c", "--out", "o"], []):
        monkeypatch.setattr(sys, "argv", ["x", *wrong])
        with pytest.raises(SystemExit, match="2"):
            launch(study)
