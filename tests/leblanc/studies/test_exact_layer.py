"""`leblanc layer --model potential` and `--free`: keys, words, refusals, files; `lb.layer` beside them."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.studies.layer.answer import FreeWaveAnswer, LayerAnswer, PeriodsAnswer
from leblanc.studies.layer.study import free_film, steady_film
from meshes.errors import InputError
from solvers.liquid_model import Whirl
from tests.mutants import kills

R, SPIN, HEIGHT = 0.1, 40.0, 0.02
VOLUME = math.pi * R**2 * 0.19 * HEIGHT  # h_0/R = 0.1
LAYER = ["layer", "--radius", "0.1", "--volume", repr(VOLUME), "--height", "0.02", "--speed", "40"]
WHIRL = ["--whirl-speed", "52", "--whirl-amplitude", "0.2 mm", "--model", "potential"]


def called(**more: object) -> LayerAnswer | PeriodsAnswer | FreeWaveAnswer:
    found = {"radius": R, "volume": VOLUME, "height": HEIGHT, "speed": SPIN, "model": "potential"} | more
    return lb.layer(**found)  # type: ignore[arg-type]


def printed(capsys: pytest.CaptureFixture[str], *options: str, code: int = 0) -> dict[str, object]:
    assert main([*LAYER, *options, "--json"]) == code
    found: dict[str, object] = json.loads(capsys.readouterr().out)
    return found


def test_steady(capsys: pytest.CaptureFixture[str]) -> None:
    """The keys of every model and those of the fully nonlinear wave; the same from Python, in other units."""
    found = printed(capsys, *WHIRL, "--profile")
    assert found["force_ratio"] == pytest.approx([2.042546357170, 0.0], abs=1e-11)
    assert (found["crest"], found["trough"]) == pytest.approx((1.0439750030, 0.9520102517), abs=1e-9)
    assert found["state"] == "resolved" and found["branch"] == "one_crest" and found["largest_whirl"] is None
    assert found["converged"] and found["in_range"] and 0.0 < found["crest_number"] < 0.1  # type: ignore[operator]
    assert len(found["theta"]) == len(found["depth"])  # type: ignore[arg-type]
    result = called(radius="100 mm", whirl_speed=52.0, whirl_amplitude="0.2 mm")
    assert isinstance(result, LayerAnswer) and result.exact is not None
    ratio = [result.force_ratio.real, result.force_ratio.imag]
    assert ratio == pytest.approx(found["force_ratio"], abs=1e-11)
    assert {"crest", "trough", "crest_number"} <= {number.name for number in result.validity}


def test_no_wave_ends_with_code_3(capsys: pytest.CaptureFixture[str]) -> None:
    """The largest whirl with a wave is reported, in words and as a number."""
    larger = ["--whirl-speed", "29.5", "--whirl-amplitude", "0.5 mm", "--model", "potential"]
    found = printed(capsys, *larger, code=3)
    assert found["state"] is None and found["force_ratio"] == [None, None] and not found["in_range"]
    largest = found["largest_whirl"]
    assert isinstance(largest, float) and 0.1e-3 < largest < 0.5e-3
    assert main([*LAYER, *larger]) == 3
    out, err = capsys.readouterr()
    assert "fold" in err and "Largest whirl with a wave" in out
    below = printed(capsys, *larger[:3], repr(0.99 * largest), *larger[4:])
    assert below["converged"]


def test_lee_waves_are_noted() -> None:
    layer = math.pi * R**2 * 0.3 * 1.7 * HEIGHT
    found = called(volume=layer, whirl_speed=28.0, whirl_amplitude=0.012 * 0.3 * R)
    assert isinstance(found, LayerAnswer) and found.exact is not None
    assert found.exact.branch == "lee_waves" and any("shorter waves" in note.text for note in found.notes)
    assert found.in_range


@kills(
    "leblanc.studies.layer.study:free_wave", "np.array(wave.whirl_speed)", "np.array(wave.whirl_speed[::-1])"
)
def test_free(capsys: pytest.CaptureFixture[str]) -> None:
    """Retrograde and prograde in space; the linear theory does not know of the height."""
    found = printed(capsys, "--free", "1.3", "--model", "potential", "--profile")
    behind, ahead = found["whirl_speed"]  # type: ignore[misc]
    assert behind / SPIN - 1.0 == pytest.approx(-0.255138549856, abs=1e-10)
    assert SPIN / (ahead - SPIN) + SPIN / (behind - SPIN) == pytest.approx(-2.0, rel=1e-10)
    assert found["crest"] == pytest.approx(1.3, rel=1e-10) and found["branch"] == "one_crest"
    assert found["converged"] and 0.0 < found["crest_number"] < 1.0  # type: ignore[operator]
    assert max(found["depth"]) == pytest.approx(1.3 * 0.1 * R, rel=1e-10)  # type: ignore[arg-type]
    linear = printed(capsys, "--free", "1.2", "--model", "linear")
    assert linear["whirl_speed"][0] / SPIN - 1.0 == pytest.approx(-0.235602983589, abs=1e-10)  # type: ignore[index]
    assert linear["in_range"] and linear["branch"] is None
    five = called(free=1.1, mode=5)
    assert isinstance(five, FreeWaveAnswer) and five.branch == "many_crests" and five.mode == 5
    # Five crests as high as the one that was asked for.
    assert np.count_nonzero(five.depth > (1.1 - 1e-9) * 0.1 * R) == 5


def test_too_high_a_free_wave_ends_with_code_3(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*LAYER, "--free", "1.9", "--model", "potential"]) == 3
    out, err = capsys.readouterr()
    assert "the last crest is 1.6" in err and "Converged       no" in out


def test_words(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*LAYER, "--free", "1.2", "--model", "potential", "--profile"]) == 0
    out = capsys.readouterr().out
    for text in ("behind the drum", "ahead of it", "one crest", "1.2 and ", "angle (deg), one in"):
        assert text in out
    assert "whirl of" not in out
    assert main([*LAYER, *WHIRL]) == 0
    out = capsys.readouterr().out
    assert "1.044 and 0.952 mean depths" in out and "Its estimated error" in out


@pytest.mark.usefixtures("undrawn")
def test_in_time(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """Grown slowly off the resonance, its means come near the steady wave; at the resonance it breaks."""
    slow = ["--whirl-speed", "34", "--whirl-amplitude", "0.1 mm", "--model", "potential"]
    found = printed(capsys, *slow, "--duration", "8 s", "--ramp", "4 s", "--cells", "64")
    assert found["state"] == "resolved" and found["converged"] and found["nodes"] == 64
    steady = printed(capsys, *slow)
    last = complex(*found["force_ratio"][-1])  # type: ignore[index]
    assert last == pytest.approx(complex(*steady["force_ratio"]), abs=0.05)  # type: ignore[misc]
    assert found["force_gap"] < 1e-8 and found["mass_error"] < 1e-9  # type: ignore[operator]
    hard = ["--whirl-speed", "30.6", "--whirl-amplitude", "3 mm", "--model", "potential", "--cells", "64"]
    assert main([*LAYER, *hard, "--duration", "3 s", "--out", str(tmp_path)]) == 3
    assert "broken" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ([], "--whirl-amplitude"),
        (["--whirl-amplitude", "1 mm"], "--whirl-speed"),
        ([*WHIRL, "--gravity", "9.81"], "--gravity"),
        ([*WHIRL, "--friction", "stokes"], "--friction"),
        ([*WHIRL, "--solver", "scipy"], "--solver"),
        ([*WHIRL, "--baffles", "3"], "--baffles"),
        ([*WHIRL, "--cells", "3"], "--cells"),
        ([*WHIRL, "--cells", "33", "--duration", "1 s"], "--cells"),
        ([*WHIRL, "--mode", "2"], "--mode"),
        ([*WHIRL, "--free", "1.2"], "--whirl-speed"),
        (["--free", "1.2", "--model", "kdv"], "--model"),
        (["--free", "0.9", "--model", "potential"], "--free"),
        (["--free", "1.2", "--model", "potential", "--mode", "0"], "--mode"),
        (["--free", "1.2", "--model", "potential", "--duration", "1 s"], "--duration"),
        (["--free", "1.2", "--model", "linear", "--gravity", "9.81"], "--gravity"),
    ],
)
def test_refused_in_one_line(options: list[str], named: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*LAYER, *options]) == 2
    err = capsys.readouterr().err.strip()
    assert named in err and "must be" in err and "\n" not in err


def test_refused_from_python() -> None:
    with pytest.raises(InputError, match="whirl_amplitude"):
        called()
    with pytest.raises(InputError, match="free"):
        called(free=1.0)


def test_figures_and_films(tmp_path: Path) -> None:
    """A figure of each kind; of a natural sloshing wave the film's crest keeps its height wherever it is."""
    free = called(free=1.5)
    assert isinstance(free, FreeWaveAnswer)
    _, frames = free_film(free)
    assert np.abs(frames.depth.max(axis=1) / free.depth.max() - 1.0).max() < 5e-3
    highest = frames.theta[frames.depth.argmax(axis=1)]
    apart = np.angle(np.exp(1j * highest) / np.exp(1j * np.angle(frames.deflection)))
    assert np.abs(apart).max() < 0.01
    held = called(whirl_speed=28.0, whirl_amplitude=1e-3)
    assert isinstance(held, LayerAnswer)
    # Angles that hardly crowd stay as they are.
    assert steady_film(held, Whirl(SPIN, 28.0, 1e-3), 1.0).theta.size == held.theta.size
    for name, result in (("free", free), ("held", held)):
        figure = result.plot()
        figure.savefig(tmp_path / f"{name}.png")
        text = " ".join(str(item.get_text()) for item in figure.findobj(lambda a: hasattr(a, "get_text")))
        assert ("Angle from the crest" in text) is (name == "free")
        assert ("force coefficient" in text) is (name == "held")
    assert main([*LAYER, "--free", "1.2", "--mode", "3", "--model", "linear", "--out", str(tmp_path)]) == 0
    assert (tmp_path / "wave.svg").is_file()
    assert free.to_dataset()["whirl_speed"].size == 2
