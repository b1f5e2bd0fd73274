"""`leblanc volume`: exact, by finite elements, as published; the extremes."""

from __future__ import annotations

import json
import math
from functools import partial

import pytest

from leblanc.cli import main

slow = partial(pytest.param, marks=pytest.mark.slow)
CHAMBER = ["volume", "--radius", "0.2", "--height", "0.05"]


def ask(capsys: pytest.CaptureFixture[str], *options: str) -> dict[str, float]:
    assert main([*CHAMBER, *options, "--json"]) == 0
    out, err = capsys.readouterr()
    assert err == ""
    answer: dict[str, float] = json.loads(out)
    return answer


def test_optimal_volume(capsys: pytest.CaptureFixture[str]) -> None:
    answer = ask(capsys, "--eccentricity", "0.001", "--speed", "90")
    assert set(answer) == {
        "optimal_volume", "optimal_volume_fem", "fem_error", "printed_eq18", "corrected_eq18",
    }  # fmt: skip
    assert answer["optimal_volume"] == pytest.approx(54.43957239e-6, rel=2e-10)
    assert answer["optimal_volume_fem"] == pytest.approx(answer["optimal_volume"], rel=1e-6)
    assert answer["printed_eq18"] == pytest.approx(2.040, rel=1e-3)
    assert answer["corrected_eq18"] == pytest.approx(56.7e-6, rel=1e-3)


def test_what_was_understood_is_said_first(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*CHAMBER, "--inner-radius", "150 mm", "--eccentricity", "1 mm", "--speed", "9.549 rpm"]) == 0
    assert capsys.readouterr().out.startswith(
        "Chamber of radius 200 mm, inner radius 150 mm, height 50 mm; deflection 1 mm at 9.549 rpm\n"
    )


def test_units_are_read(capsys: pytest.CaptureFixture[str]) -> None:
    plain = ask(capsys, "--eccentricity", "0.003", "--speed", "90", "--volume", "1e-4")
    with_units = ask(
        capsys, "--eccentricity", "3 mm", "--speed", f"{90 * 30 / math.pi!r} rpm", "--volume", "100 ml"
    )
    assert with_units == pytest.approx(plain, rel=1e-12)


@pytest.mark.parametrize(("volume", "case"), [("1e-3", 1), ("54.43957239e-6", 2), ("1e-5", 3)])
def test_cases(capsys: pytest.CaptureFixture[str], volume: str, case: int) -> None:
    answer = ask(capsys, "--eccentricity", "0.001", "--speed", "90", "--volume", volume)
    assert answer["case"] == case
    full = math.pi * 0.2**2 * 0.05 * 0.001
    if case == 1:
        assert answer["unbalance_volume"] == pytest.approx(full, rel=1e-12)
    else:
        # A drop at the farthest point at most: V (R + e).
        assert answer["unbalance_volume"] < min(full, float(volume) * 0.201)
    assert answer["unbalance_volume_fem"] == pytest.approx(answer["unbalance_volume"], rel=1e-5)


@pytest.mark.parametrize("eccentricity", ["0", slow("1e-5"), "0.2", slow("0.3"), slow("2")])
@pytest.mark.parametrize("speed", ["0", slow("1e-4"), "1e5"])
@pytest.mark.parametrize("gravity", ["0", "9.81"])
@pytest.mark.parametrize("volume", ["0", "6.283185307179587e-3"])
def test_extremes(
    capsys: pytest.CaptureFixture[str], eccentricity: str, speed: str, gravity: str, volume: str
) -> None:
    answer = ask(
        capsys, "--eccentricity", eccentricity, "--speed", speed, "--gravity", gravity, "--volume", volume
    )
    capacity, e = math.pi * 0.2**2 * 0.05, float(eccentricity)
    assert 0.0 <= answer["optimal_volume"] <= capacity * (1 + 1e-12)
    assert answer["fem_error"] < 1e-5
    full = float(volume) > 0.0
    assert answer["unbalance_volume"] == pytest.approx(capacity * e if full else 0.0, rel=1e-12)
    assert answer["unbalance_volume_fem"] == pytest.approx(capacity * e if full else 0.0, rel=1e-5, abs=1e-18)


@pytest.mark.parametrize(
    "options",
    [
        ["--eccentricity", "-1", "--speed", "90"],
        ["--eccentricity", "0.001", "--speed", "nan"],
        ["--eccentricity", "0.001", "--speed", "90", "--volume", "7e-3"],
        ["--eccentricity", "0.001", "--speed", "90", "--volume", "-1 ml"],
        ["--eccentricity", "1 kg", "--speed", "90"],
        ["--eccentricity", "0.001", "--speed", "90", "--gravity", "-9.81"],
        ["--eccentricity", "0.001", "--speed", "90", "--inner-radius", "0.3"],
        ["--eccentricity", "0.001"],
        ["--eccentricity", "0.001", "--speed", "90", "--colour", "red"],
    ],
)
def test_bad_input(capsys: pytest.CaptureFixture[str], options: list[str]) -> None:
    assert main([*CHAMBER, *options, "--json"]) == 2
    out, err = capsys.readouterr()
    assert out == "" and len(err.strip().splitlines()) == 1 and "Traceback" not in err
