"""The answer of a scene in magnetic bearings: loads, trial, JSON, arrays, words, figure, report."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import load_scene
from leblanc.wings.magnetic.answer import MagneticAnswer, limits, rows, sentence
from leblanc.wings.magnetic.figure import magnetic_figure
from leblanc.wings.magnetic.study import explain_magnetic, run_magnetic
from meshes.errors import InputError
from tests.mutants import kills
from tests.oracles.blood_pump import ROTOR, SPEED, synergetic

ROOT = Path(__file__).parents[3]
PUMP = ROOT / "examples" / "blood_pump.toml"
SHORT = {
    "speeds.start": "9000 rpm",
    "speeds.count": 2,
    "rotor.trial.duration": 0.06,
    "rotor.trial.samples": 121,
    "rotor.loads.0.start": 0.04,
    "rotor.loads.1.start": 0.05,
}
AT = "leblanc.wings.magnetic.study:"


@pytest.fixture(scope="module")
def record() -> MagneticAnswer:
    return run_magnetic(load_scene(PUMP).replace(SHORT))


def test_the_scene_is_the_table_of_the_source() -> None:
    """[BG18, table 1 and section 4]: lengths and times are written with five to seven digits."""
    scene = load_scene(PUMP)
    machine, control = scene.rotor.machine(), scene.rotor.controllers()[0]  # type: ignore[union-attr]
    for name in ("mass", "transverse_inertia", "polar_inertia", "eccentricity", "drag", "motor_length"):
        assert getattr(machine, name) == pytest.approx(getattr(ROTOR, name), rel=3e-5), name
    printed = synergetic(machine)
    for name in ("manifold_time", "goal_time", "weight", "rate", "tilt_rate"):
        assert getattr(control, name) == pytest.approx(getattr(printed, name), rel=1e-6), name


@kills(AT + "_load", "load.frequency or 0.0", "0.0")
@kills(AT + "_controlled", "orbit_size(place).max()", "orbit_size(place).min() / 2.0")
def test_closed_forms_of_the_synergetic_control() -> None:
    """Of each coordinate x = s w/(m (s^3 + D s^2 + P s + mu Z)), s = i p; 1e-6 as the scene."""
    bare = {"rotor.trial.duration": 1e-3, "speeds.stop": "9000 rpm", "speeds.count": 1}
    found = run_magnetic(load_scene(PUMP).replace(SHORT | bare)).controls["synergetic"]
    control = synergetic()
    place, rate, memory = control.feedback

    def answer(force: float, s: complex, k: int) -> complex:
        cubic = ((s + rate[k]) * s + place[k]) * s + control.rates[k] * memory
        return force * s / (cubic * ROTOR.inertia[k])

    swing = abs(answer(0.12, 2j * math.pi * 50.0, 0))
    assert found.loads[1].settled == pytest.approx(swing, rel=1e-5)
    force, couple = ROTOR.unbalance * SPEED**2
    shift, lean = answer(force, 1j * SPEED, 0), answer(couple, 1j * SPEED, 2)
    each = [abs(shift + sign * 9e-3j * lean) for sign in (1.0, -1.0)]
    assert found.amplitude[0] == pytest.approx(max(each), rel=1e-5)
    # The whole load of 1.2 N is carried by two bearings of 60 N/A in the end.
    assert found.loads[0].current == pytest.approx(1.2 / (2.0 * 60.0), rel=1e-6)
    assert found.loads[0].settled == pytest.approx(0.0, abs=1e-15)
    assert found.loads[0].peak == pytest.approx(3.071e-6, rel=1e-3)


@kills(AT + "loads_of", "-rotor.mass * scene.gravity", "rotor.mass * scene.gravity")
def test_gravity_across_the_axis() -> None:
    """It is a load like others: the rotor falls towards -y first, and the coils carry it in the end."""
    lying = load_scene(PUMP).replace(SHORT | {"rotor.axis": "horizontal", "rotor.trial.offset": [0, 0]})
    found = run_magnetic(lying).controls["pid"]
    weight = found.loads[-1]
    assert weight.name == "gravity"
    assert weight.current == pytest.approx(ROTOR.mass * 9.81 / (2.0 * 60.0), rel=1e-6)
    assert found.trial is not None
    motion = found.trial.motion
    early = (motion.time > 0.0) & (motion.time < 0.002)
    assert np.all(motion.displacement[early][:, 1] < 0.0)
    assert motion.current[-1, 1] == pytest.approx(weight.current, rel=0.2)


def test_the_trial_begins_where_the_scene_says(record: MagneticAnswer) -> None:
    for control in record.controllers:
        assert control.trial is not None
        motion = control.trial.motion
        assert motion.displacement[0].tolist() == pytest.approx([1.4e-4, 0.0, 1.4e-4, 0.0])
        assert control.trial.most_current == pytest.approx(np.abs(motion.current).max())
        assert control.trial.after_loads == pytest.approx(motion.distance[motion.time >= 0.04].max())
    assert record.band == pytest.approx(4e-6) and record.load_speed == pytest.approx(SPEED)
    assert math.isinf(record.controls["synergetic"].trial.settled)  # type: ignore[union-attr]
    assert record.controls["pid"].trial.settled < 0.03  # type: ignore[union-attr]


def test_json_holds_numbers_and_nulls_only(record: MagneticAnswer) -> None:
    found = json.loads(json.dumps(record.to_json(), allow_nan=False))
    control = found["controls"]["synergetic"]
    assert np.shape(control["poles"]) == (2, 12, 2) and control["gain_up"] == [None, None]
    assert control["trial"]["settled"] is None and control["trial"]["ending"] == "done"
    assert np.shape(control["trial"]["displacement"]) == (121, 4)
    assert found["amplitude"] == control["amplitude"] and found["stable"] == [True, True]


def test_arrays_have_a_place_for_every_pole(record: MagneticAnswer) -> None:
    data = record.to_dataset()
    assert data["pole_real"].shape == (2, 2, 16) and bool(data["pole_real"][0, :, 12:].isnull().all())
    assert data["displacement"].dims == ("control", "time", "axis")
    np.testing.assert_array_equal(data["amplitude"][1], record.controllers[1].amplitude)


def test_words(record: MagneticAnswer) -> None:
    told = {label: texts for label, *texts in rows(record)}
    assert told["Slowest pole (1/s)"][0] == "\N{MINUS SIGN}19.86 \N{PLUS-MINUS SIGN} 10.99 i"
    assert (
        told["Load 1: deflection"][0] == "3.071 um" and told["In time: within 4 um after"][0] == "not found"
    )
    failed = {check.label for check in limits(record) if check.grade}
    assert failed == {"Faster than coils are, synergetic control"}
    assert "largest sensitivity" in sentence(record)


def test_what_does_not_hold_is_said() -> None:
    """A PID control softer than the magnets' pull: no margins, no loads, the rotor at a magnet."""
    weak = load_scene(PUMP).replace(SHORT | {"rotor.pid.proportional": 5e3})
    found = run_magnetic(weak)
    control = found.controls["pid"]
    assert not control.stable.any() and np.isnan(control.sensitivity).all() and control.loads == ()
    assert control.trial is not None and control.trial.motion.ending.value == "touched"
    told = {label: texts for label, *texts in rows(found)}
    assert told["Phase margin, least"][1] == "not found" and told["Load 1: deflection"][1] == "not found"
    failed = {check.label for check in limits(found) if check.grade}
    assert {"Not stable, PID control", "Trial in time, PID control"} <= failed and found.converged
    assert json.dumps(found.to_json(), allow_nan=False)
    assert bool(found.to_dataset()["displacement"][1].isnull().any())
    assert magnetic_figure(found).alt


def test_a_scene_without_a_trial() -> None:
    table = load_scene(PUMP).replace(SHORT).table()
    del table["rotor"]["trial"], table["rotor"]["pid"]
    table["assumed"] = []
    found = run_magnetic(lb.Scene(**table))
    assert found.controllers[0].trial is None and found.load_speed == found.speed[-1]
    assert len(magnetic_figure(found).axes) == 1 and "time" not in found.to_dataset().coords
    assert not any("In time" in label for label, *_ in rows(found))


def test_the_figure(record: MagneticAnswer) -> None:
    above, middle, below = magnetic_figure(record).axes
    lines = {line.get_label(): line for line in above.get_lines()}
    trial = record.controls["pid"].trial
    assert trial is not None
    assert lines["PID control"].get_ydata() == pytest.approx(trial.motion.distance * 1e6)
    assert lines["PID control"].get_linestyle() != lines["synergetic control"].get_linestyle()
    assert {"load comes on", "magnet"} <= set(lines)
    drawn = {line.get_label(): line for line in middle.get_lines()}["PID control"]
    assert drawn.get_ydata() == pytest.approx(np.abs(trial.motion.current).max(axis=1) * 1e3)
    drawn = {line.get_label(): line for line in below.get_lines()}["PID control"]
    assert drawn.get_ydata() == pytest.approx(record.controls["pid"].amplitude * 1e6)


@kills(
    "solvers.rotor.magnetic.machine:MagneticRotor.outward_force",
    "+ self.motor_stiffness",
    "- self.motor_stiffness",
)
def test_explanation() -> None:
    """How far the magnets reach: 4 k_A i_0^2 2/(delta + x)^2 = c_m x, a cubic; without control x grows as the
    positive root of s^2 = (c_m + 2 k_s)/m, leaning more slowly."""
    found = explain_magnetic(load_scene(PUMP))
    pull = 8.0 * 2e-5 * 0.03**2
    roots = np.roots([6000.0, 2.0 * 2e-4 * 6000.0, 2e-4**2 * 6000.0, -pull])
    reach = roots[np.abs(roots.imag) < 1e-12].real.max()
    assert found.reach == pytest.approx(reach, rel=1e-9) and reach > 0.7 * 2e-4
    assert found.growth == pytest.approx(math.sqrt((6000.0 + 2.0 * 9000.0) / ROTOR.mass), rel=0.1)
    assert found.holds == pytest.approx(2.0 * 60.0 * 0.03, rel=1e-12)
    assert found.plot().alt


def test_the_commands(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    changed = tmp_path / "pump.toml"
    text = PUMP.read_text(encoding="utf-8")
    text = text.replace('duration = "1 s"', 'duration = "20 ms"').replace("count = 15", "count = 2")
    changed.write_text(text, encoding="utf-8")
    out = tmp_path / "out"
    assert main(["run", str(changed), "--out", str(out)]) == 0
    assert "Delay margin, least" in capsys.readouterr().out
    assert {"summary.html", "response.nc", "magnetic.svg"} <= {p.name for p in out.iterdir()}
    page = (out / "summary.html").read_text(encoding="utf-8")
    assert "Faster than coils are" in page and "Bias current" in page
    assert main(["explain", str(changed)]) == 0
    assert "comes home from" in capsys.readouterr().out


@pytest.mark.parametrize(
    "argv",
    [("map",), ("runup",), ("optimise",), ("compare", "--models", "statics")],
    ids=lambda argv: argv[0],
)
def test_what_makes_no_sense_is_refused_in_one_line(
    argv: tuple[str, ...], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    command, *rest = argv
    assert main([command, str(PUMP), *rest, "--out", str(tmp_path)]) == 2
    said = capsys.readouterr().err.strip()
    assert said.count("\n") == 0 and "must be" in said
    if command == "runup":
        assert "rotor.trial" in said


def test_other_rotors_are_refused() -> None:
    tub = load_scene(ROOT / "examples" / "tub.toml")
    for study in (run_magnetic, explain_magnetic):
        with pytest.raises(InputError, match="magnetic for this"):
            study(tub)
