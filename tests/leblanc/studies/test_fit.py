"""`fit`: the truth found again within its own errors, and what the data cannot tell said in words."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import leblanc as lb
from leblanc.cli import main
from leblanc.results.fit import FitCode
from leblanc.studies.fit import fit_scene
from leblanc.studies.fitting.errors import curvature
from leblanc.studies.fitting.measured import Measurement, read_measured
from leblanc.studies.fitting.problem import answer as _answer
from meshes.errors import InputError
from tests.mutants import kills
from validation.cases.rotors.rigs import _fit, _liquid_angle, data, horizontal_rig

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


@kills("leblanc.studies.fitting.noise:_noise", "np.sqrt(mean / share)", "np.sqrt(9.0 * mean / share)")
@kills("leblanc.studies.fit:_result", "value, problem.spans)", "9.0 * value, problem.spans)")
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
    found = fit_scene(RIG, measured(0.02, 1, 8192.0), UNKNOWN, starts=1, scale="free")
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


@kills("leblanc.results.fit:quantile", "stdtrit(freedom, _UPPER)", "stdtrit(99, _UPPER)")
@kills("leblanc.results.fit:FitResult.interval", "self.value / factor", "self.value - factor")
def test_interval() -> None:
    """Student's t of the table, 2.306 for eight degrees of freedom, about the logarithm; wider for fewer."""
    speed = np.linspace(60.0, 180.0, 10)
    (amplitude,) = _answer(RIG, "speed", speed, ["amplitude"])
    noisy = amplitude * (1.0 + 0.1 * np.random.default_rng(1).standard_normal(10))
    found = fit_scene(RIG, Measurement("speed", speed, (("amplitude", noisy),)), UNKNOWN, starts=1)
    assert found.freedom == 8
    ends = np.log(found.interval / found.value[:, None]) * (found.value / found.std)[:, None]
    # The table has four digits.
    np.testing.assert_allclose(ends, [[-2.306, 2.306]] * 2, rtol=2e-4)
    vague = replace(found, std=9.0 * found.value)
    np.testing.assert_allclose(vague.interval / vague.first[:, None], [[0.01, 100.0]] * 2, rtol=1e-12)
    scaled = fit_scene(RIG, Measurement("speed", speed, (("amplitude", noisy),)), UNKNOWN, 1, scale="free")
    assert scaled.freedom == 7


@pytest.mark.slow
def test_coverage_of_200_trials() -> None:
    """The truth lies in its interval in 95 % of 200 sets of noise, for each unknown.

    Of 200 trials 190 +- sqrt(200 * 0.95 * 0.05) = 3.1 are inside; four of those below. Errors a fifth too
    small would leave 177.
    """
    guess = RIG.replace({"rotor.mass": 5.0, "rotor.damping_ratio": 0.07})
    inside = np.zeros(2, dtype=int)
    for seed in range(1000, 1200):
        found = fit_scene(guess, measured(0.02, seed), UNKNOWN, starts=1)
        low, high = found.interval.T
        inside += (low < TRUTH) & (high > TRUTH)
    assert (inside >= 178).all(), inside


def test_liquid_added() -> None:
    """What was in the ring before, from amplitudes with more and more liquid, in units of the sensor."""
    scene = lb.example("runup").replace({"speeds.stop": 21.0, "chambers.0.volume": "60 ml"})
    added = np.linspace(0.0, 3e-4, 7)
    (amplitude,) = _answer(scene, "added", added, ["amplitude"])
    exact = lb.run(scene.replace({"chambers.0.volume": "160 ml", "speeds.start": 20.0, "speeds.count": 2}))
    assert amplitude[2] == pytest.approx(exact.amplitude[-1], rel=1e-9)
    guess = scene.replace({"chambers.0.volume": "80 ml"})
    for scale, factor in (("given", 1.0), ("free", 7.0), ("each", 7.0)):
        table = Measurement("added", added, (("amplitude", factor * amplitude),))
        found = fit_scene(guess, table, ("chambers.0.volume",), starts=1, scale=scale)
        # The search ends where a step changes the sum, or the value, by 1e-8 of it.
        assert found.value[0] == pytest.approx(60e-6, rel=1e-4)
        assert found.scale == pytest.approx(factor, rel=1e-4)


@kills("leblanc.studies.fitting.problem:_factor", "own @ value", "own @ own")
def test_a_factor_for_each_quantity() -> None:
    """Two sensors in two units: both factors are found, and angles have none."""
    names = ["amplitude", "liquid_offset", "liquid_angle"]
    parts = _answer(RIG, "speed", SPEED, names)
    sensors = zip(names, parts, (3.0, 50.0, 1.0), strict=True)
    table = Measurement("speed", SPEED, tuple((name, factor * part) for name, part, factor in sensors))
    guess = RIG.replace({"rotor.damping_ratio": 0.07})
    found = fit_scene(guess, table, ("rotor.damping_ratio",), starts=1, scale="each")
    assert found.value[0] == pytest.approx(0.1, rel=1e-5)
    (note,) = [note for note in found.notes if note.code == FitCode.SCALE]
    assert note.data["scale"] == pytest.approx({"amplitude": 3.0, "liquid_offset": 50.0}, rel=1e-5)


@kills("leblanc.studies.fitting.errors:curvature", "np.square(inverse)", "inverse")
def test_uncertainty_of_a_straight_line() -> None:
    """The textbook's covariance, and nan for what no row of the Jacobian knows."""
    x = np.linspace(0.0, 1.0, 20)
    jacobian = np.stack([np.ones(20), x], axis=1)
    bent = curvature(jacobian / 0.2)
    exact = 0.04 * np.linalg.inv(jacobian.T @ jacobian)
    np.testing.assert_allclose(bent.std, np.sqrt(np.diag(exact)), rtol=1e-12)
    assert bent.correlation[0, 1] == pytest.approx(
        exact[0, 1] / np.sqrt(exact[0, 0] * exact[1, 1]), rel=1e-12
    )
    assert not bent.flat
    blind = curvature(np.stack([np.ones(20), np.zeros(20)], axis=1))
    assert math.isfinite(blind.std[0]) and math.isnan(blind.std[1])
    np.testing.assert_allclose(np.abs(blind.flat[0]), [0.0, 1.0], atol=1e-12)


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


def _loaded(position: float, angle: float) -> lb.Scene:
    """The tub of the examples, dry, with a second load in its drum."""
    load = {"size": 0.05, "position": position, "angle": angle}
    changes = {"chambers.0.volume": 0.0, "rotor.unbalance": 0.1, "rotor.loads": [load]}
    return lb.example("tub").replace(changes)


@kills("leblanc.studies.fitting.problem:Problem.values", "np.isnan(spans)", "spans == spans")
@kills(
    "leblanc.results.fit:FitResult.interval", "self.value - wide, self.value + wide", "ends[:, 0], ends[:, 1]"
)
def test_where_a_load_lies() -> None:
    """Position and angle, from a guess of 0 and of the other sign; intervals of even arms."""
    speed = np.linspace(20.0, 90.0, 16)
    names = ["amplitude", "phase"]
    paths = ("rotor.loads.0.position", "rotor.loads.0.angle")
    columns = tuple(zip(names, _answer(_loaded(0.08, 0.6), "speed", speed, names), strict=True))
    found = fit_scene(_loaded(0.0, -0.2), Measurement("speed", speed, columns), paths, starts=1)
    np.testing.assert_allclose(found.value, [0.08, 0.6], rtol=1e-5)
    random = np.random.default_rng(5)
    noisy = tuple((name, value * (1.0 + 0.02 * random.standard_normal(16))) for name, value in columns)
    off = fit_scene(_loaded(0.05, 0.5), Measurement("speed", speed, noisy), paths, starts=1)
    # A chance of 1e-4 each that a normal variable is further off.
    assert np.all(np.abs(off.value - [0.08, 0.6]) < 4.0 * off.std)
    assert off.signed == paths
    middle = off.interval.mean(axis=1)
    np.testing.assert_allclose(middle, off.value, rtol=1e-12)
    # Student's t of the table for 30 degrees of freedom.
    np.testing.assert_allclose(np.diff(off.interval, axis=1)[:, 0], 2.0 * 2.042 * off.std, rtol=3e-4)


@pytest.mark.slow
def test_water_that_leaves_a_load() -> None:
    """Share and time constant of what laundry sheds, from the amplitude over a programme with noise."""
    steps = ["to 900 rpm at 120 rpm/s", "hold 8 s"]
    changes = {"chambers.0.volume": 0.0, "programme": {"start": "60 rpm", "steps": steps, "cells": 16}}
    sheds = {"share": 0.4, "time_constant": "3 s", "above": "300 rpm"}
    scene = lb.example("tub").altered(runup=None).replace(changes | {"rotor.sheds": sheds})
    time = np.linspace(1.0, 14.5, 80)
    (amplitude,) = _answer(scene, "time", time, ["amplitude"])
    noisy = amplitude * (1.0 + 0.01 * np.random.default_rng(0).standard_normal(80))
    guess = scene.replace({"rotor.sheds.share": 0.3, "rotor.sheds.time_constant": 4.0})
    paths = ("rotor.sheds.share", "rotor.sheds.time_constant")
    found = fit_scene(guess, Measurement("time", time, (("amplitude", noisy),)), paths, starts=1)
    # A chance of 1e-4 each that a normal variable is further off.
    assert np.all(np.abs(found.value - [0.4, 3.0]) < 4.0 * found.std)
    assert np.all(found.std < [0.004, 0.1])


@kills("leblanc.studies.fit:_is_near", "[told]", "")
def test_measured_angles_of_a_rig() -> None:
    """The rig's six angles: what a least squares of its own finds, and friction that they do not tell."""
    angles = read_measured(Path("docs/examples/rig_angles.csv"), ("x", "y"))
    wall = RIG.replace({"model.friction": {"wall": {"roughness": 5e-5}}})
    paths = ("rotor.damping_ratio", "rotor.critical_speed", "model.friction.wall.roughness")
    found = fit_scene(wall, angles, paths, starts=3)
    seen = data("dr18_fig24.json")
    speed = np.array(seen["speed_rpm"]) * math.pi / 30.0
    np.testing.assert_allclose(angles.at, speed)
    wet, _ = _fit(
        lambda x: _liquid_angle(speed, x[0], x[1] * 1000.0 * math.pi / 30.0),
        np.array(seen["angle_deg"], dtype=float),
        [0.1, 1.0],
    )
    # There the liquid's added mass counts as the rotor's; the square of the speed goes as 1 over the mass.
    heavier = math.sqrt(1.0 + sum(fill.full_mass for fill in horizontal_rig()) / 4.0)
    dry = wet * heavier * np.array([1.0, 1000.0 * math.pi / 30.0])
    np.testing.assert_allclose(found.value[:2], dry, rtol=1e-3)
    assert np.isfinite(found.std[:2]).all() and math.isnan(found.std[2])
    # Searches that differ in what is not told alone are no other answer.
    # Six values cannot tell noise of 0.19 rad from a scene that does not meet them: said so.
    assert {note.code for note in found.notes} == {FitCode.NOT_TOLD, FitCode.LARGE}


def test_data_that_the_scene_cannot_meet() -> None:
    """A curve that rises and falls without sense is not met, and the answer says so."""
    table = Measurement("speed", SPEED, (("amplitude", 1e-3 * (1.0 + np.arange(30) % 2 * 4.0)),))
    found = fit_scene(RIG, table, UNKNOWN, starts=1)
    assert found.residual_rms > 0.3 and FitCode.POOR in {note.code for note in found.notes}


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
        ("speed [rpm], time [s], amplitude [mm]\n1, 2, 3\n3, 4, 5\n", "speed, time or added"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3, x\n", "numbers"),
        ("speed [rpm], amplitude [mm]\n1, 2\n3\n", "2 finite numbers"),
        ("speed [rpm], amplitude [mm]\n0, 2\n3, 4\n", "above 0"),
        ("added [ml], peak [mm]\n-1, 2\n3, 4\n", "at least 0"),
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
