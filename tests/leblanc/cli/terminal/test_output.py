"""What commands print is JSON."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from leblanc.core import terminal as output

Capture = pytest.CaptureFixture[str]


@dataclass(frozen=True)
class Found:
    speed: Any
    label: str


def printed(value: object, capsys: Capture) -> Any:
    output.print_json(value)
    text = capsys.readouterr().out
    assert text.endswith("\n")
    assert text.count("\n") == 1
    return json.loads(text, parse_constant=lambda word: pytest.fail(f"{word} is not JSON"))


def test_json_of_everything_a_study_holds(capsys: Capture) -> None:
    value = {
        "array": np.array([[1.0, math.nan], [math.inf, -math.inf]]),
        "complex": np.array([1 + 2j, complex(math.nan, 1)]),
        "one": np.complex128(1 - 1j),
        "half": complex(1, math.inf),
        "whole": np.int64(3),
        "flag": np.array([True, False]),
        "truth": np.bool_(True),
        "word": np.array(["statics", "linear"]),
        "none": None,
        "path": Path("a") / "b",
        "found": (Found(np.float64(2.5), "Ω"), Found([], "")),
        "number": -math.inf,
    }
    assert printed(value, capsys) == {
        "array": [[1.0, None], [None, None]],
        "complex": [[1.0, 2.0], [None, None]],
        "one": [1.0, -1.0],
        "half": [None, None],
        "whole": 3,
        "flag": [True, False],
        "truth": True,
        "word": ["statics", "linear"],
        "none": None,
        "path": str(Path("a") / "b"),
        "found": [{"speed": 2.5, "label": "Ω"}, {"speed": [], "label": ""}],
        "number": None,
    }


def test_json_keeps_every_digit(capsys: Capture) -> None:
    numbers = [0.1, 1e-300, 1.7976931348623157e308, math.pi, -0.0]
    assert printed({"x": np.array(numbers)}, capsys)["x"] == numbers


def test_json_refuses_what_it_does_not_know(capsys: Capture) -> None:
    with pytest.raises(TypeError, match="object"):
        output.print_json({"x": object()})
    assert capsys.readouterr().out == ""
