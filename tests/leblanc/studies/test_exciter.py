"""The answer of an exciter's scene: units, branches, critical speed, JSON, figure."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest

from leblanc.core.blocks import Words, flat
from leblanc.scene.scene import load_scene, scene_from_table
from leblanc.wings.exciter.answer import ExciterAnswer
from leblanc.wings.exciter.figure import exciter_figure
from leblanc.wings.exciter.study import answer_exciter, run_exciter
from meshes.errors import InputError
from solvers.rotor.exciter.machine import Exciter
from tests.mutants import kills

ROOT = Path(__file__).parents[3]
RPM = math.pi / 30.0
# Large drag and share of the balls: the time integrations are short.
MACHINE = Exciter(40.0, 4e4, 100.0, 0.02, 2, 1.0, 1.4, 0.08, 2.0)


OF = {"name": "small", "assumed": ("rotor.unbalance",)}


@pytest.fixture(scope="module")
def record() -> ExciterAnswer:
    return answer_exciter(MACHINE, np.linspace(10.0, 400.0, 40), checks=4, of=OF)


@kills(
    "leblanc.wings.exciter.study:answer_exciter",
    "np.abs(np.array(motions)).T * machine.length",
    "np.abs(np.array(motions)).T",
)
@kills(
    "leblanc.wings.exciter.study:answer_exciter",
    "platform_motion(numbers, n, q) for",
    "platform_motion(numbers, q, n) for",
)
@kills("leblanc.wings.exciter.study:answer_exciter", "stuck_speeds=stuck * unit", "stuck_speeds=stuck")
def test_units() -> None:
    """Amplitudes in metres and speeds in rad/s solve the dimensional equations.

    The mean torque of the platform on the balls, N m, against the drag of the race, and the platform as a
    driven oscillator; closed forms, to rounding.
    """
    speed = np.array([60.0, 200.0])
    found = answer_exciter(MACHINE, speed, checks=1)
    mass, k, c = 42.0, 4e4, 100.0
    q = found.stuck_speeds[:, 0]
    slow = 2 * 1.0 * 0.08 * q**2 / np.abs(k - mass * q**2 + 1j * c * q)
    fast = 0.02 * speed**2 / np.abs(k - mass * speed**2 + 1j * c * speed)
    assert found.amplitude_slow == pytest.approx(slow, rel=1e-12)
    assert found.amplitude_fast == pytest.approx(fast, rel=1e-12)
    # Power: drag of two balls on the race takes from the shaft what the platform's damper eats, at speed q.
    drag_torque = 2 * 2.0 * 0.08**2 * (speed - q)
    eaten = 0.5 * c * (q * slow) ** 2
    assert drag_torque * q == pytest.approx(eaten, rel=1e-9)


@kills("leblanc.scene.rotors:Exciter._machine", "rolling=rolling_inertia(", "rolling=1.01 * rolling_inertia(")
def test_the_worked_table() -> None:
    """Of the worked table: the source's numbers, loaded [YF17, section 5.2], and its scene."""
    machine = load_scene(ROOT / "examples" / "vibratory_table.toml").rotor.machine()  # type: ignore[arg-type]
    assert machine.whole_mass == pytest.approx(90.75, rel=1e-12)
    assert machine.natural_frequency / (2 * math.pi) == pytest.approx(6.36, abs=5e-3)
    assert machine.length == pytest.approx(0.5264e-3, abs=5e-8)
    assert machine.unbalance == pytest.approx(0.1 * 0.105, rel=1e-12)
    assert machine.rolling == 7.0 / 5.0


def test_the_start_of_a_pendulum_is_its_own_inertia() -> None:
    table = {
        "name": "p",
        "rotor": {
            "kind": "exciter",
            "platform_mass": 40.0,
            "stiffness": 4e4,
            "damping": 100.0,
            "unbalance": 0.02,
            "balls": {
                "count": 3,
                "mass": 1.0,
                "pendulum_inertia": 0.0064,
                "track_radius": 0.08,
                "damping": 2.0,
            },
        },
        "speeds": {"start": 10.0, "stop": 20.0, "count": 2},
    }
    machine = scene_from_table(table).rotor.machine()  # type: ignore[arg-type]
    assert machine.rolling == pytest.approx(2.0, rel=1e-12) and machine.ball_count == 3


def test_speeds_and_branches(record: ExciterAnswer) -> None:
    first, through, last = record.characteristic
    three = (record.speed > first) & (record.speed < last)
    assert np.array_equal(np.isfinite(record.stuck_speeds).all(axis=1), three)
    assert first < through < last
    assert np.array_equal(record.dual_frequency, record.speed <= record.critical_speed)
    assert record.converged


def test_integrations_stand_beside_the_formulas(record: ExciterAnswer) -> None:
    """Where the balls stay the lowest order is right to the balls' share of the mass, 3.4 %, a few times."""
    held = [one for one in record.checks if one.holds and one.speed > 1.5 * MACHINE.natural_frequency]
    assert held
    for one in held:
        k = int(np.argmin(np.abs(record.speed - one.speed)))
        assert one.stuck_speed == pytest.approx(record.stuck_speeds[k, 0], rel=0.05)
        assert one.slow == pytest.approx(record.amplitude_slow[k], rel=0.15)
        assert one.fast == pytest.approx(record.amplitude_fast[k], rel=0.15)
    assert any(not one.holds for one in record.checks if one.speed > record.critical_speed)


def test_json_holds_numbers_and_nulls_only(record: ExciterAnswer) -> None:
    text = json.dumps(record.to_json(), allow_nan=False)
    found = json.loads(text)
    assert len(found["speed"]) == len(found["stuck_speeds"]) == len(found["amplitude_slow"]) == 40
    assert found["stuck_speeds"][0][1] is None
    assert found["critical_speed"] == record.critical_speed
    assert found["critical_speed_printed"] is None or math.isfinite(found["critical_speed_printed"])


def test_one_stuck_speed_at_every_speed() -> None:
    """Heavy damping: no critical speed, the motion is there at all speeds, the figure says so."""
    damped = Exciter(40.0, 4e4, 3000.0, 0.02, 2, 1.0, 1.4, 0.08, 20.0)
    found = answer_exciter(damped, [20.0, 60.0], checks=1)
    assert math.isnan(found.critical_speed) and found.dual_frequency.all()
    answer = found.to_json()
    assert answer["critical_speed"] is None and answer["characteristic_speeds"]["merger"] is None
    assert "One stuck speed" in str(exciter_figure(found).caption)


def test_the_figure(record: ExciterAnswer) -> None:
    """Curves in rpm and mm, marks where the integrations stand, hatching beyond the critical speed."""
    figure = exciter_figure(record)
    above, below = figure.axes[:2]
    lines = {line.get_label(): line for line in above.get_lines()}
    slowest = lines["stuck together, slowest"]
    assert slowest.get_xdata() == pytest.approx(record.speed / RPM)
    assert slowest.get_ydata() == pytest.approx(record.stuck_speeds[:, 0] / RPM)
    assert set(lines) >= {"middle (unstable)", "fastest", "natural frequency", "time integration, balls stay"}
    styles = [
        lines[name].get_linestyle() for name in ("stuck together, slowest", "middle (unstable)", "fastest")
    ]
    assert len(set(styles)) == 3  # told apart without colour
    slow = next(line for line in below.get_lines() if line.get_label().startswith("slow"))
    held = record.dual_frequency
    assert slow.get_ydata()[held] == pytest.approx(record.amplitude_slow[held] * 1e3)
    assert np.isnan(slow.get_ydata()[~held]).all()
    caption = str(figure.caption)
    assert "small" in caption and "of its values" in caption


def test_bad_speeds_are_named() -> None:
    with pytest.raises(InputError):
        answer_exciter(MACHINE, [0.0, 1.0])
    with pytest.raises(InputError):
        answer_exciter(Exciter(40.0, 4e4, 0.0, 0.02, 2, 1.0, 1.4, 0.08, 2.0), [10.0])


def test_a_scene_is_run_over_its_speeds() -> None:
    scene = load_scene(ROOT / "examples" / "vibratory_table.toml")
    found = run_exciter(scene)
    assert np.array_equal(found.speed, scene.speed_array()) and found.name == "Vibratory table"
    # The regression prints 11.38 natural frequencies for it, good to some per cent here.
    assert found.critical_speed == pytest.approx(found.critical_speed_printed, rel=0.06)
    assert found.critical_speed_printed == pytest.approx(11.38 * found.machine.natural_frequency, rel=1e-3)
    with pytest.raises(InputError):
        run_exciter(load_scene(ROOT / "examples" / "centrifuge.toml"))


def test_words(record: ExciterAnswer) -> None:
    lines = [block.text for block in flat(record.blocks(), "text") if isinstance(block, Words)]
    assert f"{record.critical_speed / RPM:.4g} rpm" in " ".join(lines)
    assert sum(line.startswith("Integrated at") for line in lines) == len(record.checks)
    assert any("balls leave" in line for line in lines) and any("balls stay" in line for line in lines)


def test_the_command_answers_an_exciter(capsys: pytest.CaptureFixture[str], tmp_path: Path) -> None:
    """With the keys of every `run`; the platform's fast vibration is that of a plain oscillator."""
    from leblanc.cli import main

    scene = ROOT / "examples" / "vibratory_table.toml"
    assert main(["run", str(scene), "--json", "--out", str(tmp_path)]) == 0
    answer = json.loads(capsys.readouterr().out)
    speed, n = np.array(answer["speed"]), len(answer["speed"])
    keys = ("amplitude", "amplitude_dry", "phase", "liquid_offset", "liquid_angle", "dry_patch", "stable")
    assert all(len(answer[key]) == n for key in (*keys, "model"))
    whole, stiffness, damping = 90.75, 145083.0, 150.0
    wanted = 0.0105 * speed**2 / (stiffness - whole * speed**2 + 1j * damping * speed)
    np.testing.assert_allclose(answer["amplitude_dry"], np.abs(wanted), rtol=1e-6)
    np.testing.assert_allclose(answer["phase"], np.angle(wanted), rtol=1e-6, atol=1e-9)
    assert (tmp_path / "exciter.svg").stat().st_size > 10_000
    assert "Vibratory table" in (tmp_path / "summary.html").read_text(encoding="utf-8")


def test_the_command_explains_an_exciter(capsys: pytest.CaptureFixture[str]) -> None:
    from leblanc.cli import main

    scene = str(ROOT / "examples" / "vibratory_table.toml")
    assert main(["explain", scene, "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    # 90 kg, two balls of 0.325 kg, 0.1 kg of unbalance on 145 083 N/m.
    assert found["natural_frequency"] == pytest.approx(math.sqrt(145083.0 / 90.75), rel=1e-6)
    assert found["critical_speed_printed"] == pytest.approx(11.38 * found["natural_frequency"], rel=1e-3)
    # n2 = 1 + 1/(4 h b) of the source.
    h, b = found["dimensionless"]["damping"], found["dimensionless"]["drag"]
    through = found["characteristic_speeds"]["through_resonance"] / found["natural_frequency"]
    assert through == pytest.approx(1.0 + 1.0 / (4.0 * h * b), rel=1e-3)
    assert main(["explain", scene]) == 0
    assert "381.8 rpm" in capsys.readouterr().out
