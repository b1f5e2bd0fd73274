"""`leblanc layer --model potential`: steady and free waves, waves from rest, and what ends them."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from tests.mutants import kills

R, H0, H, SPIN = 0.1, 0.01, 0.02, 40.0
RING = {"radius": R, "volume": math.pi * (R**2 - (R - H0) ** 2) * H, "height": H, "speed": SPIN}


def typed(capsys: pytest.CaptureFixture[str], **more: object) -> tuple[int, dict[str, Any], str]:
    """Exit code, what was printed as JSON, and what was said beside it."""
    options = {**RING, "model": "potential", **more}
    command = [part for k, v in options.items() for part in (f"--{k.replace('_', '-')}", str(v))]
    code = main(["layer", *command, "--json"])
    printed = capsys.readouterr()
    return code, json.loads(printed.out) if printed.out else {}, printed.err


def test_steady(capsys: pytest.CaptureFixture[str]) -> None:
    """A wave of another code to its digits, crest and trough with it."""
    code, found, _ = typed(capsys, whirl_speed=52.0, whirl_amplitude=0.02 * H0)
    assert code == 0 and found["converged"] and found["state"] == "resolved"
    assert found["force_ratio"] == pytest.approx([2.04254635717, 0.0], abs=1e-11)
    assert (found["crest"], found["trough"]) == pytest.approx((1.0439750030, 0.9520102517), abs=1e-9)
    assert found["branch"] == "one_crest" and 0.0 < found["error_estimate"] < 1e-8
    # A whirl against the spin holds a wave too, and twins hold the same.
    pair = [
        lb.layer(**RING, whirl_speed=v * SPIN, whirl_amplitude=5e-4, model="potential") for v in (0.7, 1.75)
    ]
    assert pair[0].force_ratio == pytest.approx(pair[1].force_ratio, abs=1e-10)
    assert lb.layer(**RING, whirl_speed=-SPIN, whirl_amplitude=5e-4, model="potential").converged


def test_free(capsys: pytest.CaptureFixture[str]) -> None:
    """Both speeds in space of a wave of another code; of many crests; and linear theory of a low one."""
    code, found, _ = typed(capsys, free=1.5)
    behind = -0.266050523357
    assert code == 0
    wanted = [SPIN * (1.0 + behind), SPIN * (1.0 + 1.0 / (-2.0 - 1.0 / behind))]
    assert found["whirl_speed"] == pytest.approx(wanted, abs=1e-8)
    assert found["crest"] == pytest.approx(1.5) and found["mode"] == 1
    assert lb.layer(**RING, free=1.05, mode=5, model="potential").branch == "many_crests"
    low, linear = (lb.layer(**RING, free=1.0001, model=model) for model in ("potential", "linear"))
    np.testing.assert_allclose(low.whirl_speed, linear.whirl_speed, rtol=1e-6)


@kills("leblanc.studies.layer:_exact_history", "state=found.state.value", "state='resolved'")
def test_from_rest(capsys: pytest.CaptureFixture[str]) -> None:
    """A whirl at the resonance: period by period, and with twice the whirl up to where it breaks."""
    resonance = {"whirl_speed": 30.576, "duration": 2.4, "ramp": 0.6}
    code, found, _ = typed(capsys, whirl_amplitude=0.05 * H0, **{**resonance, "duration": 1.7})
    assert code == 0 and found["state"] == "resolved" and len(found["time"]) == 2
    assert complex(*found["force_ratio"][-1]) == pytest.approx(0.482 + 1.990j, abs=3e-3)
    assert found["crest"] == pytest.approx(1.192, abs=2e-3) and found["error_estimate"] < 1e-8
    code, found, said = typed(capsys, whirl_amplitude=0.2 * H0, **resonance)
    assert code == 3 and found["state"] == "broken" and not found["converged"]
    assert "breaks" in said and found["crest"] > 1.3


def test_no_wave_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    """Beyond the end of a branch, with the whirl at which it was: below that there is one."""
    code, found, said = typed(capsys, whirl_speed=52.0, whirl_amplitude=0.1 * H0)
    assert code == 3 and found["state"] is None and "chokes" in said
    largest = found["largest_whirl"]
    assert 0.02 * H0 < largest < 0.1 * H0
    assert typed(capsys, whirl_speed=52.0, whirl_amplitude=0.9 * largest)[0] == 0


@pytest.mark.parametrize(
    ("more", "named"),
    [
        ({"whirl_speed": 52.0, "whirl_amplitude": 1e-4, "gravity": 9.81}, "--gravity"),
        ({"whirl_speed": 52.0, "whirl_amplitude": 1e-4, "friction": "stokes"}, "--friction"),
        ({"free": 0.9}, "--free"),
        ({"free": 1.2, "model": "long_wave"}, "--model"),
        ({"whirl_speed": 52.0}, "--whirl-amplitude"),
        ({"whirl_speed": 52.0, "whirl_amplitude": 1e-4, "duration": -1.0}, "--duration"),
    ],
)
def test_bad_input(capsys: pytest.CaptureFixture[str], more: dict[str, object], named: str) -> None:
    code, _, said = typed(capsys, **more)
    assert code == 2 and named in said and len(said.strip().splitlines()) == 1


@pytest.mark.slow
def test_figures_and_films(tmp_path: Path) -> None:
    """Of a free wave and of one from rest."""
    command = [part for k, v in RING.items() for part in (f"--{k}", str(v))]
    free = ["--free", "1.4", "--model", "potential", "--out", str(tmp_path)]
    assert main(["layer", *command, *free, "--animate", str(tmp_path / "free.gif")]) == 0
    assert (tmp_path / "wave.png").exists() and (tmp_path / "free.gif").stat().st_size > 1e4
    whirl = ["--whirl-speed", "52", "--whirl-amplitude", "2e-4", "--model", "potential"]
    rest = ["--duration", "0.6", "--ramp", "0.3", "--animate", str(tmp_path / "rest.gif")]
    assert main(["layer", *command, *whirl, *rest]) == 0
    assert (tmp_path / "rest.gif").stat().st_size > 1e4
