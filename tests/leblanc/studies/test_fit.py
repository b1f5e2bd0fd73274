"""`fit`: the truth found again within its own errors, and what the data cannot tell said in words."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import leblanc as lb
from leblanc.cli import main
from leblanc.results.fit import FitCode
from leblanc.studies.fit import Measurement, _answer, _uncertainty, fit_scene, read_measured
from meshes.errors import InputError
from tests.mutants import kills

RIG = lb.example("horizontal_rig")
SPEED = np.linspace(60.0, 180.0, 30)
UNKNOWN = ("rotor.mass", "rotor.damping_ratio")
TRUTH = np.array([4.0, 0.1])


def measured(noise: float, seed: int, scale: float = 1.0) -> Measurement:
    (amplitude,) = _answer(RIG, "speed", SPEED, ["amplitude"])
    random = np.random.default_rng(seed)
    size = noise * np.sqrt(np.mean(np.square(amplitude)))
    return Measurement(
        "speed", SPEED, (("amplitude", scale * (amplitude + size * random.standard_normal(30))),)
    )


@kills("leblanc.studies.fit:_uncertainty", "max(count - unknowns, 1)", "count**2")
@kills("leblanc.studies.fit:_Problem.result", "std = std * value", "std = 9.0 * std * value")
def test_truth_within_its_errors() -> None:
    """Errors are as large as they are said to be: over twelve sets of noise their squares average to one."""
    guess = RIG.replace({"rotor.mass": 5.0, "rotor.damping_ratio": 0.07})
    squares = []
    for seed in range(12):
        found = fit_scene(guess, measured(0.02, seed), UNKNOWN, starts=1)
        assert found.converged
        squares.append(np.square((found.value - TRUTH) / found.std))
    # Of 24 squares of a normal variable: a mean of 1, give or take sqrt(2/24) = 0.29; four of those.
    assert 0.3 < np.mean(squares) < 2.2


def test_without_noise() -> None:
    """The truth to rounding, from several starts, whatever the seed; and no errors without noise."""
    for seed in (0, 1):
        guess = RIG.replace({"rotor.mass": 6.0, "rotor.damping_ratio": 0.05})
        found = fit_scene(guess, measured(0.0, 0), UNKNOWN, starts=3, seed=seed)
        # The search ends where a step changes the sum by 1e-8 of it, or the values by 1e-8.
        np.testing.assert_allclose(found.value, TRUTH, rtol=1e-5)
        assert found.residual_rms < 1e-5
    again = fit_scene(guess, measured(0.02, 3), UNKNOWN, starts=2, seed=5)
    assert again.parameters == fit_scene(guess, measured(0.02, 3), UNKNOWN, starts=2, seed=5).parameters


def test_a_free_scale() -> None:
    """A sensor in its own units: the same values, and its scale."""
    plain = fit_scene(RIG, measured(0.02, 1), UNKNOWN, starts=1)
    found = fit_scene(RIG, measured(0.02, 1, 8192.0), UNKNOWN, starts=1, free=True)
    assert found.scale == pytest.approx(8192.0, rel=0.05)
    np.testing.assert_allclose(found.value, plain.value, rtol=0.05)
    assert FitCode.SCALE in [note.code for note in found.notes]
    assert found.measured[0].unit == ""


def test_what_the_data_cannot_tell() -> None:
    """Stiffness and mass far above the resonance, unbalance in a free scale: said in words."""
    fast = np.linspace(600.0, 900.0, 12)
    (amplitude,) = _answer(RIG, "speed", fast, ["amplitude"])
    random = np.random.default_rng(0)
    table = Measurement(
        "speed", fast, (("amplitude", amplitude * (1.0 + 0.01 * random.standard_normal(12))),)
    )
    found = fit_scene(RIG, table, ("rotor.mass", "rotor.damping_ratio"), starts=1)
    told = {note.code for note in found.notes}
    # Damping does nothing there.
    assert told & {FitCode.VAGUE, FitCode.NOT_TOLD, FitCode.AT_BOUND}
    together = fit_scene(RIG, measured(0.02, 0), ("rotor.mass", "rotor.unbalance"), starts=1)
    assert abs(together.correlation[0, 1]) > 0.8


@kills("leblanc.studies.fit:_uncertainty", "np.square(inverse)", "inverse")
def test_uncertainty_of_a_straight_line() -> None:
    """The textbook's covariance, and nan for what no row of the Jacobian knows."""
    x = np.linspace(0.0, 1.0, 20)
    jacobian = np.stack([np.ones(20), x], axis=1)
    std, correlation = _uncertainty(jacobian, 18.0 * 0.04, 20)
    exact = 0.04 * np.linalg.inv(jacobian.T @ jacobian)
    np.testing.assert_allclose(std, np.sqrt(np.diag(exact)), rtol=1e-12)
    assert correlation[0, 1] == pytest.approx(exact[0, 1] / np.sqrt(exact[0, 0] * exact[1, 1]), rel=1e-12)
    blind, _ = _uncertainty(np.stack([np.ones(20), np.zeros(20)], axis=1), 1.0, 20)
    assert math.isfinite(blind[0]) and math.isnan(blind[1])


def test_over_time() -> None:
    """A run-up: the stiffness and the damping of a dry machine from its amplitude over time."""
    scene = lb.example("runup").replace(
        {"chambers.0.volume": 0.0, "runup.duration": "6 s", "runup.samples": 400}
    )
    time = np.linspace(0.5, 6.0, 60)
    (amplitude,) = _answer(scene, "time", time, ["amplitude"])
    paths = tuple(path for path in ("rotor.critical_speed", "rotor.stiffness") if _stands(scene, path))
    guess = scene.replace({paths[0]: 1.05 * _value(scene, paths[0])})
    found = fit_scene(guess, Measurement("time", time, (("amplitude", amplitude),)), paths[:1], starts=1)
    assert found.value[0] == pytest.approx(_value(scene, paths[0]), rel=1e-4)


def _value(scene: lb.Scene, path: str) -> float:
    table = scene.table()
    for key in path.split("."):
        table = table[key]
    return float(table)  # type: ignore[arg-type]


def _stands(scene: lb.Scene, path: str) -> bool:
    try:
        _value(scene, path)
    except (KeyError, TypeError):
        return False
    return True


def table(folder: Path, text: str) -> Path:
    (folder / "m.csv").write_text(text, encoding="utf-8")
    return folder / "m.csv"


def test_tables(tmp_path: Path) -> None:
    """Units of the header, any order of columns and rows, comments."""
    text = "# a run\namplitude [um], speed (rpm), liquid_angle [deg]\n2, 300, 90\n1, 60, -45\n"
    found = read_measured(table(tmp_path, text), ("x", "y"))
    np.testing.assert_allclose(found.at, [2 * math.pi, 10 * math.pi])
    assert [name for name, _ in found.columns] == ["amplitude", "liquid_angle"]
    np.testing.assert_allclose(found.columns[0][1], [1e-6, 2e-6])
    np.testing.assert_allclose(found.columns[1][1], [-math.pi / 4, math.pi / 2])
    free = read_measured(table(tmp_path, "speed [rpm], amplitude [LSB]\n60, 5\n120, 7\n"), (), True)
    np.testing.assert_allclose(free.columns[0][1], [5.0, 7.0])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", "a header"),
        ("speed [rpm], amplitude [kg]\n1, 2\n3, 4\n", "length"),
        ("speed [rpm], amplitde [mm]\n1, 2\n3, 4\n", "one of"),
        ("speed [rpm], time [s], amplitude [mm]\n1, 2, 3\n3, 4, 5\n", "speed or time"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3, x\n", "numbers"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3\n", "2 finite numbers"),
        ("speed [rpm], amplitude [mm]\n0, 2\n3, 4\n", "above 0"),
    ],
)
def test_faulty_tables(tmp_path: Path, text: str, words: str) -> None:
    with pytest.raises(InputError) as fault:
        read_measured(table(tmp_path, text), ("x", "y"))
    assert words in str(fault.value)


@given(st.text(max_size=200))
def test_any_text_is_refused_or_read(text: str) -> None:
    import tempfile

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "m.csv"
        path.write_bytes(text.encode("utf-8", "surrogatepass"))
        try:
            found = read_measured(path, ("x",))
            assert (np.diff(found.at) >= 0.0).all() and np.isfinite(found.at).all()
        except InputError:
            return


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """JSON keys that scripts rely on, files, and wrong unknowns in one line each."""
    scene = str(Path(lb.__file__).parents[1] / "examples" / "horizontal_rig.toml")
    data = measured(0.02, 0)
    lines = [f"{s * 30 / math.pi}, {a * 1e3}" for s, a in zip(SPEED, data.columns[0][1], strict=True)]
    path = str(table(tmp_path, "speed [rpm], amplitude [mm]\n" + "\n".join(lines)))
    out = tmp_path / "out"
    words = ["fit", scene, path, "--starts", "1", "--out", str(out)]
    assert main([*words, "--unknown", "rotor.mass", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert set(found["parameters"]["rotor.mass"]) == {"value", "std"}
    assert {"residual_rms", "correlation"} <= found.keys()
    assert {"fit.nc", "fit.png", "fit.svg"} <= {file.name for file in out.iterdir()}
    for unknown in ("rotor.masse", "name", "rotor"):
        assert main([*words, "--unknown", unknown]) == 2
        assert capsys.readouterr().err.count("\n") == 1
    assert main([*words, "--unknown", "rotor.mass"]) == 0
    assert "rotor.mass" in capsys.readouterr().out
