"""`leblanc bearing`: dimensions to frequencies and back, slip, what is refused."""

from __future__ import annotations

import json
import math

import pytest

import leblanc as lb
from leblanc.cli import main
from meshes.errors import InputError

DIMENSIONS = {"balls": 9, "ball_diameter": "7.144 mm", "pitch_diameter": "31 mm"}
OPTIONS = "--balls 9 --ball-diameter 7.144mm --pitch-diameter 31mm"


def test_dimensions(capsys: pytest.CaptureFixture[str]) -> None:
    """The textbook's numbers, d/D = 0.2305: FTF 0.3848, BPFO 3.463, BPFI 5.537, BSF 2.054 times the shaft."""
    found = lb.bearing(speed="33 Hz", contact_angle=0.0, **DIMENSIONS)
    orders = [found.orders[name] for name in ("ftf", "bpfo", "bpfi", "bsf")]
    assert orders == pytest.approx([0.38477, 3.46297, 5.53703, 2.05442], abs=1e-5)
    assert found.bpfo == pytest.approx(3.46297 * 2.0 * math.pi * 33.0, rel=1e-5)
    assert main(["bearing", "--speed", "33Hz", *OPTIONS.split(), "--json"]) == 0
    assert json.loads(capsys.readouterr().out) == found.to_json()


def test_there_and_back() -> None:
    made = lb.bearing(speed="10 Hz", contact_angle="25 deg", **DIMENSIONS)
    found = lb.bearing(speed="10 Hz", **made.orders)
    assert found.balls == 9
    assert math.degrees(found.contact_angle) == pytest.approx(25.0, abs=1e-3)
    assert found.diameter_ratio == pytest.approx(7.144 / 31.0, rel=1e-6)


def test_slip_and_words(capsys: pytest.CaptureFixture[str]) -> None:
    found = lb.bearing(speed="33 Hz", cage="12 Hz", **DIMENSIONS)
    assert found.slip == pytest.approx(1.0 - 12.0 / (33.0 * found.orders["ftf"]), rel=1e-12)
    assert main(["bearing", "--speed", "33Hz", *OPTIONS.split(), "--cage", "12Hz"]) == 0
    assert "Slip of the cage  5.49 %" in capsys.readouterr().out
    ratios = {"--ftf": "0.38475", "--bpfo": "3.4555", "--bpfi": "5.5369", "--bsf": "2.0497"}
    options = [word for pair in ratios.items() for word in pair]
    assert main(["bearing", "--speed", "33Hz", *options]) == 0
    said = capsys.readouterr().out
    assert "0 deg, the end of its range" in said and "+0.15 %" in said
    assert found.plot().alt and float(found.to_dataset()["bpfi"]) == pytest.approx(found.bpfi)


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ("--balls 9", "--ball-diameter"),
        (f"{OPTIONS} --ftf 0.4", "--ball-diameter"),
        ("--ftf 0.4", "--balls"),
        ("--ftf 0.4 --bpfo 3 --bpfi -1", "--bpfi"),
        (OPTIONS.replace("7.144mm", "40mm"), "--ball-diameter"),
        (OPTIONS.replace("9", "0", 1), "--balls"),
        (f"{OPTIONS} --contact-angle 95deg", "--contact-angle"),
        (f"{OPTIONS} --cage 3kg", "--cage"),
        (f"{OPTIONS} --cage=-3", "--cage"),
    ],
)
def test_refusals(options: str, field: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["bearing", "--speed", "33Hz", *options.split()]) == 2
    said = capsys.readouterr().err.strip().splitlines()
    assert len(said) == 1 and said[0].startswith(f"leblanc: {field} = ")


def test_keywords_are_named_in_python() -> None:
    with pytest.raises(InputError, match=r"^ball_diameter"):
        lb.bearing(speed=1.0, balls=9)
    with pytest.raises(InputError, match=r"^speed"):
        lb.bearing(speed=-1.0, **DIMENSIONS)
