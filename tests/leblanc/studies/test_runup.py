"""A scene's run-up: against exact means, an independent integrator, linear theory, the liquid's geometry."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

import leblanc as lb
import leblanc.studies.runup.study as runup_module
from fluid.fill import Fill
from fluid.liquid import known_liquid
from leblanc.cli import main
from leblanc.core.blocks import Picture, flat
from leblanc.core.netcdf import write_netcdf
from leblanc.core.units import LENGTH, with_unit
from leblanc.plotting.bodies import film_factor, half_angle
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.studies.drives import drive_of, planned
from leblanc.studies.runup import figure as figures
from leblanc.studies.runup import film as film_figures
from leblanc.studies.runup.answer import RunupAnswer, RunupFrames, turn_mean
from leblanc.studies.runup.notes import RunupCode
from leblanc.studies.runup.study import (
    held_from,
    judged,
    liquid_model,
    runup_scene,
    steady_response,
    whirl_bands,
)
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.layer.records import Outcome
from solvers.runup.machine import Handover, Motor, Ramp, Transfer
from solvers.runup.runup import EnergyAudit, RunupHistory, run_up
from tests.mutants import kills
from tests.oracles.data_files import assert_read_back

RPM = math.pi / 30.0
WATER = known_liquid("water")
MASS, NATURAL, ZETA, UNBALANCE = 30.0, 25.0, 0.06, 0.1


def table(**changes: Any) -> dict[str, Any]:
    """An upright machine with a deep, wet layer and a short ramp; tables replaced or, with None, left out."""
    content: dict[str, Any] = {
        "name": "Machine",
        "source": "none",
        "rotor": {
            "kind": "jeffcott",
            "mass": MASS,
            "critical_speed": NATURAL,
            "damping_ratio": ZETA,
            "unbalance": UNBALANCE,
            "axis": "vertical",
        },
        "chambers": [{"radius": 0.25, "height": 0.04, "volume": "0.5 l", "liquid": "water"}],
        "speeds": {"start": 5.0, "stop": 100.0, "count": 20},
        "model": {"liquid": "auto", "friction": {"linear": "3 1/s"}},
        "runup": {"start": 20.0, "stop": 40.0, "rate": 20.0, "duration": 1.5, "cells": 16, "samples": 300},
    }
    for key, value in changes.items():
        merged = content[key] | value if isinstance(value, dict) and key in content else value
        content[key] = _without_none(merged) if isinstance(merged, dict) else merged
    return _without_none(content)


def _without_none(content: dict[str, Any]) -> dict[str, Any]:
    return {key: value for key, value in content.items() if value is not None}


def scene(**changes: Any) -> Scene:
    return scene_from_table(table(**changes))


def lying(**changes: Any) -> Scene:
    return scene(rotor={"axis": "horizontal"}, **changes)


@pytest.fixture(scope="module")
def record() -> RunupAnswer:
    return runup_scene(scene(runup={"back": True}))


# --- means over turns ------------------------------------------------------------------------------------


@kills(
    "leblanc.studies.runup.answer:turn_mean",
    "math.pi * np.maximum(1.0, np.ceil(",
    "math.pi * np.maximum(0.5, 0.5 * np.ceil(",
)
@kills("leblanc.studies.runup.answer:turn_mean", "/ (2.0 * half))", "/ half)")
def test_turn_mean() -> None:
    """What stands in the drum stays, what stands in space goes: the trapezium is exact for one harmonic.

    At an even spin all windows hold whole numbers of samples, so nothing is left but rounding.
    """
    for per_turn in (3, 5, 16):
        angle = np.arange(12 * per_turn * 8 + 1) * (2.0 * math.pi / per_turn)
        steady, standing = 3.0 - 2.0j, 5.0j
        values = steady + standing * np.exp(-1j * angle)
        assert np.abs(turn_mean(values, angle) - steady).max() < 1e-10 * angle.size


@kills("leblanc.studies.runup.answer:turn_mean", "0.5 * (values[1:] + values[:-1])", "values[1:]")
def test_lines() -> None:
    """What grows in proportion to the angle is its own mean: an even spin, where the trapezium is exact."""
    angle = np.linspace(0.0, 60.0 * math.pi, 961)  # 32 samples to a turn
    middle = (angle > 2.0 * math.pi) & (angle < 58.0 * math.pi)
    assert np.abs(turn_mean(angle + 0j, angle) - angle)[middle].max() < 1e-9


@given(st.floats(1.0, 500.0), st.floats(-50.0, 50.0), st.floats(-1e-2, 1e-2), st.floats(-1e-2, 1e-2))
def test_a_mean_over_turns_keeps_straight_lines(spin: float, rate: float, real: float, imag: float) -> None:
    """A value that grows in proportion to the angle is its own mean, away from the ends."""
    time = np.linspace(0.0, 1.0, 800)
    angle = spin * time + 0.5 * max(rate, 0.0) * time**2
    values = complex(real, imag) * angle
    found = turn_mean(values, angle)
    size = abs(complex(real, imag))
    # Within a window of the ends the mean is that of the nearest whole window.
    window = 2.0 * math.pi * np.maximum(1.0, np.ceil(8.0 * np.gradient(angle) / (2.0 * math.pi)))
    inside = (angle > window) & (angle < angle[-1] - window)
    # The running sum is a parabola between straight lines: at each of the window's two ends it is off by up
    # to an eighth of the step squared, over the window; steps are up to an eighth of the window.
    slack = 2.0 * np.gradient(angle) ** 2 / 8.0 / window * size + 1e-9 * size * angle[-1]
    assert np.all(np.abs(found - values)[inside] <= slack[inside])


def test_a_mean_over_turns_of_few_samples() -> None:
    assert np.array_equal(turn_mean(np.array([1.0 + 1j, 2.0]), np.array([0.0, 1.0])), [1.0 + 1j, 2.0])


# --- what is asked ---------------------------------------------------------------------------------------


@kills("leblanc.studies.drives:drive_of", "plan.rate, plan.duration", "plan.duration, plan.rate")
@kills("leblanc.studies.drives:drive_of", "Motor(plan.start, motor", "Motor(plan.stop, motor")
def test_drive() -> None:
    """The ramp of a scene as its file says it."""
    plan = scene(runup={"back": True}).runup
    assert plan is not None
    ramp = drive_of(plan)
    assert isinstance(ramp, Ramp)
    # Up in 1 s, held until 1.5 s, down again in 1 s.
    assert np.allclose(ramp.corners(), [[0.0, 1.0, 1.5, 2.5], [20.0, 40.0, 40.0, 20.0]], rtol=1e-12)
    curve = {"inertia": 2.0, "speeds": [0.0, 50.0], "torques": [4.0, 1.0]}
    driven = scene(runup={"start": 20.0, "stop": 40.0, "rate": None, "motor": curve, "duration": 3.0})
    motor = drive_of(planned(driven))
    assert motor == Motor(20.0, 2.0, (0.0, 50.0), (4.0, 1.0), 3.0)


def test_other_names() -> None:
    """The call and the table of a scene have two names each; both tables together are one too many."""
    assert lb.runup is lb.run_up
    content = table()
    other = {("run_up" if key == "runup" else key): value for key, value in content.items()}
    assert scene_from_table(other).table() == scene().table()
    with pytest.raises(SceneError, match="run_up"):
        scene_from_table(content | other)


def test_a_scene_without_run_up_is_refused() -> None:
    with pytest.raises(InputError, match="runup"):
        runup_scene(scene(runup=None))


def test_resolution_from_outside_takes_the_place_of_the_scene_s(record: RunupAnswer) -> None:
    found = runup_scene(scene(runup={"duration": 0.2}), cells=8, samples=20, check=False)
    assert found.cells == 8
    assert found.history.time.size == 20
    assert math.isnan(found.history.error_estimate)
    assert record.cells == 16


# --- what comes back -------------------------------------------------------------------------------------


@kills(
    "leblanc.studies.runup.answer:RunupAnswer.deflection",
    "self.history.deflection[:, 0] * np.exp(-1j * self.history.angle)",
    "self.history.deflection[:, 0] * np.exp(1j * self.history.angle)",
)
def test_dry_run() -> None:
    """Amplitude and phase of the empty machine, by an independent integrator of its equation of motion."""
    found = runup_scene(scene(chambers=[_chamber(0.0)], runup={"samples": 2001}), check=False)
    time, rate, start = found.history.time, 20.0, 20.0

    def rates(t: float, y: np.ndarray) -> list[float]:
        held = t >= 1.0
        spin = start + rate * min(t, 1.0)
        angle = start * min(t, 1.0) + 0.5 * rate * min(t, 1.0) ** 2 + 40.0 * max(t - 1.0, 0.0)
        force = UNBALANCE * (spin**2 - 1j * rate * (not held)) * complex(math.cos(angle), math.sin(angle))
        z, v = complex(y[0], y[1]), complex(y[2], y[3])
        a = (force - 2.0 * ZETA * MASS * NATURAL * v - MASS * NATURAL**2 * z) / MASS
        return [v.real, v.imag, a.real, a.imag]

    up = solve_ivp(rates, (0.0, 1.0), [0.0] * 4, "DOP853", time[time <= 1.0], rtol=1e-10, atol=1e-13)
    wanted = (up.y[0] + 1j * up.y[1])[-1]
    k = int(np.flatnonzero(time <= 1.0)[-1])
    turned = wanted * np.exp(-1j * (start + 0.5 * rate))
    # The samples of 1.5/2000 s are the longest steps. The trapezium turns the free oscillation at 25 rad/s by
    # (25 * 1.5/2000)^2/12 too little, 7e-4 rad in the second; it is no larger than the peak.
    slack = 1e-3 * found.history.amplitude.max()
    assert abs(found.history.amplitude[k] - abs(wanted)) < slack
    assert abs(found.deflection[k] - turned) < slack
    assert found.phase[k] == pytest.approx(float(np.angle(turned)), abs=slack / abs(wanted))


def _chamber(volume: float, **more: Any) -> dict[str, Any]:
    return {"radius": 0.25, "height": 0.04, "volume": volume, "liquid": "water"} | more


@kills(
    "leblanc.studies.runup.study:steady_response",
    "response(jeffcott(scene), scene.fills, passed",
    "response(jeffcott(scene), (), passed",
)
def test_steady() -> None:
    """A wet wall acts as the added mass m_f; the axis stands, gravity along it changes nothing of that."""
    quiet = scene(rotor={"unbalance": 1e-4})
    answer = steady_response(quiet, np.array([20.0, 40.0]))
    assert answer is not None
    assert (answer.speed[0], answer.speed[-1]) == (20.0, 40.0)
    mass = MASS + WATER.density * math.pi * 0.25**2 * 0.04
    impedance = MASS * NATURAL**2 - mass * answer.speed**2 + 2j * ZETA * MASS * NATURAL * answer.speed
    assert np.allclose(answer.deflection, 1e-4 * answer.speed**2 / impedance, rtol=1e-9)


def test_steady_response() -> None:
    assert steady_response(scene(), np.array([20.0, 20.0])) is None


@kills(
    "leblanc.studies.runup.study:whirl_bands",
    "unstable_bands(dry_rotor(scene), [scene.fills], passed, scene.model.friction)",
    "unstable_bands(dry_rotor(scene), [scene.fills * 2], passed, scene.model.friction)",
)
def test_bands() -> None:
    """Edges of the unstable band of an undamped rotor with m_f = 0.1 M and h0 = 0.1 R, in its frequencies."""
    radius, height = 0.15, 0.04
    full = WATER.density * math.pi * radius**2 * height
    volume = math.pi * height * radius**2 * (1.0 - 0.9**2)
    rotor = {"mass": 10.0 * full, "critical_speed": 50.0, "damping_ratio": 0.0}
    chambers = [{"radius": radius, "height": height, "volume": volume, "liquid": "water"}]
    undamped = scene(rotor=rotor, chambers=chambers, model={"liquid": "auto", "friction": "none"})
    ((low, high),) = whirl_bands(undamped, np.array([0.9, 1.7]) * 50.0)
    # Known to the step of the scan that found them.
    assert low / 50.0 == pytest.approx(1.1225, abs=5e-4)
    assert high / 50.0 == pytest.approx(1.475, abs=5e-4)


def test_bands_of_self_excited_whirl() -> None:
    assert whirl_bands(scene(), np.array([30.0, 30.0])) == ()


def test_a_run_up_and_back(record: RunupAnswer) -> None:
    h = record.history
    assert h.converged
    assert h.time[-1] == pytest.approx(2.5, rel=1e-12)
    # The way back begins after the hold.
    assert h.time[record.turning] == pytest.approx(1.5, rel=1e-12)
    up, back, turning = record.crest(), record.crest(back=True), float(h.time[record.turning])
    assert up.time <= turning < back.time
    for moment, steps in ((up, h.time <= turning), (back, h.time > turning)):
        assert moment.amplitude >= h.amplitude[steps].max()
        assert moment.amplitude == h.largest[steps].max()
        # Between the samples beside it, the speed being the ramp's.
        assert moment.speed == pytest.approx(np.interp(moment.time, h.time, h.speed), rel=1e-12)
    assert record.in_range.all()
    # The liquid's weight times its distance is what the layer and the axis' deflection make together.
    exact = (h.deflection[:, 0] + h.offset[:, 0]) * np.exp(-1j * h.angle)
    assert np.allclose(h.liquid_position, exact)


# --- where it holds --------------------------------------------------------------------------------------


def history_of(count: int, layers: int, **changes: Any) -> RunupHistory:
    """A made-up history of layers at rest in the drum at 100 rad/s."""
    audit = EnergyAudit(1.0, 0.0, 0.0, 0.0, 0.5, 0.5, 0.0, 0.0, 0.0, 0.0)
    values: dict[str, Any] = {
        "time": np.linspace(0.0, 1.0, count),
        "speed": np.full(count, 100.0),
        "angle": 100.0 * np.linspace(0.0, 1.0, count),
        "coordinates": np.zeros((count, 2)),
        "deflection": np.full((count, max(layers, 1)), 1e-3 + 0j),
        "largest": np.full(count, 1e-3),
        "largest_speed": np.full(count, 100.0),
        "largest_time": np.linspace(0.0, 1.0, count),
        "offset": np.zeros((count, layers), dtype=complex),
        "captured": np.ones((count, layers), dtype=bool),
        "depth_min": np.full((count, layers), 5e-3),
        "depth_max": np.full((count, layers), 1e-2),
        "mean_rotation": np.zeros((count, layers)),
        "layer_mass": np.full(layers, 0.5),
        "mass_error": 0.0,
        "error_estimate": 0.001,
        "audit": audit,
        "steps": 10,
        "layer_steps": 10,
        "disagreement": 0.0,
        "outcome": Outcome.DONE,
        "reason": "",
    }
    return RunupHistory(**values | changes)


@kills(
    "leblanc.studies.runup.study:judged",
    "history.speed + history.mean_rotation[:, k]",
    "history.speed - history.mean_rotation[:, k]",
)
@kills(
    "leblanc.studies.runup.study:held_from",
    "capture_speed(fill.surface_radius, scene.gravity)",
    "capture_speed(fill.chamber.radius, scene.gravity)",
)
def test_gravity_across() -> None:
    """The liquid itself must turn faster than sqrt(g/a), whatever the drum does, and must be captured."""
    machine = lying()
    fill = machine.fills[0]
    needed = math.sqrt(machine.gravity / fill.surface_radius)
    assert held_from(machine, fill) == pytest.approx(needed, rel=1e-12)
    lag = np.array([-100.0, -(100.0 - 0.99 * needed), -(100.0 - 1.01 * needed), 0.0, 100.0])
    good, notes = judged(machine, history_of(5, 1, mean_rotation=lag[:, None]))
    assert good.tolist() == [False, False, True, True, True]
    assert len(notes) == 1
    assert "40%" in notes[0].text
    good, _ = judged(machine, history_of(2, 1, captured=np.array([[False], [True]])))
    assert good.tolist() == [False, True]


@kills("leblanc.studies.runup.study:judged", "(pool is None or pours(fill, pool))", "True")
def test_a_pool_that_reaches_the_axis_is_out_of_range() -> None:
    """Two layers describe one below the axis; of a fuller chamber only the ring is described."""
    free = np.array([[False], [True]])
    for share, holds in ((0.3, True), (0.48, False)):
        machine = lying()
        machine = machine.replace({"chambers.0.volume": share * machine.fills[0].chamber.capacity})
        good, _ = judged(machine, history_of(2, 1, captured=free, handover=Handover.CARRIED))
        assert good.tolist() == [holds, True]


@kills(
    "leblanc.studies.runup.study:held_from",
    "covering_speed(fill, axial_gravity(scene))",
    "covering_speed(fill, 2.0 * axial_gravity(scene))",
)
@kills("leblanc.studies.runup.study:held_from", "max(slowest, covering", "min(slowest, covering")
def test_gravity_along() -> None:
    """The paraboloid covers the wall's height: g h_c/Omega^2 < V/(pi h_c), in a centrifuge's field."""
    machine = scene(chambers=[_chamber(1e-3)])
    covered = math.sqrt(machine.gravity * 0.04 / (1e-3 / (math.pi * 0.04)))
    speed = np.array([0.99, 1.01]) * covered
    good, _ = judged(machine, history_of(2, 1, speed=speed))
    assert good.tolist() == [False, True]
    # A low and nearly full chamber is covered at once: there Omega^2 a > g decides, a being 0.1 m.
    low = scene(chambers=[_chamber(math.pi * 1e-3 * (0.25**2 - 0.1**2), height=1e-3)])
    speed = np.array([0.99, 1.01]) * math.sqrt(low.gravity / 0.1)
    assert held_from(low, low.fills[0]) == pytest.approx(math.sqrt(low.gravity / 0.1), rel=1e-9)
    good, notes = judged(low, history_of(2, 1, speed=speed))
    assert not good.any()  # such a layer is too deep at any speed
    assert any("deeper than 0.3" in note.text for note in notes)


@kills(
    "leblanc.studies.runup.study:judged",
    ">= wall.radius - wall.inner_radius",
    ">= wall.radius + wall.inner_radius",
)
def test_inner_wall() -> None:
    """The surface of linear layers must stay off the inner wall; long waves fill their gap, and say so."""
    ring = scene(chambers=[_chamber(0.5e-3, inner_radius=0.2)])
    depth = np.array([[0.049], [0.051]])
    # Waves as high are beyond linear layers besides.
    _, told = judged(ring, history_of(2, 1, depth_max=depth), "linear")
    assert {note.code: note.data["share"] for note in told} == {"inner_wall": 0.5, "too_high": 1.0}
    good, notes = judged(ring, history_of(2, 1, depth_max=depth))
    assert good.all() and [(note.code, note.data["share"]) for note in notes] == [("full_gap", 0.5)]
    assert judged(scene(), history_of(2, 1, depth_max=5.0 * depth))[0].all()


def test_where_the_layer_is_a_fair_picture() -> None:
    dry = scene(chambers=[_chamber(0.0)])
    assert judged(dry, history_of(2, 1, captured=np.zeros((2, 1), dtype=bool)))[0].all()


def test_gravity_captures_and_drops_the_liquid() -> None:
    """Up through the speed of capture and back: both are reported, and nothing below it is in range."""
    needed = math.sqrt(9.81 / lying().fills[0].surface_radius)
    ramp = {"start": 0.8 * needed, "stop": 4.0 * needed, "rate": 40.0, "duration": 0.6, "back": True}
    machine = lying(runup=ramp | {"capture": "riding"})
    found = runup_scene(machine, check=False)
    h = found.history
    # Let go at 0.98 of it; a sample later than the speed says, which is looked at between samples.
    step = 40.0 * float(np.diff(h.time).max())
    assert not found.in_range[h.speed < 0.98 * needed - step].any()
    told = [note for note in found.notes if note.code in (RunupCode.CAPTURED, RunupCode.FALLS_BACK)]
    assert told[0].code is RunupCode.CAPTURED
    assert told[-1].code is RunupCode.FALLS_BACK
    first = int(np.flatnonzero(h.captured[:, 0])[0])
    assert needed - step <= h.speed[first - 1] <= needed + step  # one sample behind the speed of capture


# --- files -----------------------------------------------------------------------------------------------


@kills(
    "leblanc.studies.runup.answer:RunupAnswer.liquid_angle",
    "np.angle(self.history.liquid_position)",
    "-np.angle(self.history.liquid_position)",
)
def test_json(capsys: pytest.CaptureFixture[str] | None = None) -> None:
    """Place of the liquid and of the axis in the drum, turned back by hand from the standing frame."""
    found = runup_scene(scene(runup={"duration": 1.0}), check=False)
    h, got = found.history, found.to_json()
    assert got["speed"] == h.speed.tolist()
    place = h.deflection[:, 0] + h.offset[:, 0]
    assert np.allclose(got["liquid_offset"], np.abs(place))
    later = np.abs(place) > 1e-6
    apart = got["liquid_angle"] - (np.angle(place) - h.angle)
    assert np.allclose(np.cos(apart[later]), 1.0, atol=1e-9)
    apart = got["phase"] - (np.angle(h.deflection[:, 0]) - h.angle)
    assert np.allclose(np.cos(apart[h.amplitude > 1e-9]), 1.0, atol=1e-9)
    assert got["peak"]["amplitude"] == h.largest.max() >= h.amplitude.max()
    assert got["end"]["time"] == h.time[-1]
    assert got["end"]["liquid_angle"] == got["liquid_angle"][-1]
    audit = h.audit
    gained = audit.unbalance + audit.drive + audit.gravity + audit.captured
    lost = audit.change + audit.support + audit.friction + audit.bores + audit.profile
    assert got["energy"]["remainder"] == pytest.approx(gained - lost, abs=1e-12 * abs(gained))


def test_json_is_one_object_of_lists(capsys: pytest.CaptureFixture[str], record: RunupAnswer) -> None:
    from leblanc.core.terminal import print_json

    print_json(record.to_json())
    got = json.loads(capsys.readouterr().out)
    count = record.history.time.size
    for name in ("time", "speed", "amplitude", "phase", "liquid_offset", "liquid_angle", "in_range"):
        assert len(got[name]) == count, name
    for name in ("captured", "depth_max", "depth_min", "mean_rotation"):
        assert len(got[name]) == count
        assert len(got[name][0]) == 1
    assert got["mass_error"] < 1e-12
    assert got["converged"] is True
    assert got["peak_back"]["time"] > got["peak"]["time"]
    assert got["energy"]["closure"] == record.history.audit.closure
    assert got["digest"] == record.digest


def test_the_data_file_holds_the_run(tmp_path: Path, record: RunupAnswer) -> None:
    import h5py

    write_netcdf(record.named_arrays(), tmp_path / "runup.nc")
    assert_read_back(record.named_arrays(), tmp_path)
    h = record.history
    with h5py.File(tmp_path / "runup.nc") as file:
        for name, values in (
            ("time", h.time),
            ("speed", h.speed),
            ("amplitude", h.amplitude),
            ("deflection_real", h.deflection.real),
            ("deflection_imag", h.deflection.imag),
            ("offset_imag", h.offset.imag),
            ("depth_max", h.depth_max),
            ("captured", h.captured),
            ("layer_mass", h.layer_mass),
        ):
            assert np.array_equal(file[name][...], values), name
            assert file[name].attrs["units"]
        energy = json.loads(file.attrs["energy"])
        assert energy["unbalance"] == h.audit.unbalance
        assert file.attrs["digest"] == record.digest


# --- figures ---------------------------------------------------------------------------------------------


def test_steady_lines() -> None:
    """All branches end up in the two lines, each with its own amplitude."""
    branches = np.array([[1.0, np.nan, np.nan], [1.1, 2.0, 3.0], [1.2, 1.9, 3.1], [np.nan, np.nan, 3.2]]) * 1j
    branches = np.where(np.isnan(branches), complex(np.nan, np.nan), branches)
    calm = np.array([[True] * 3, [True, False, True], [True, False, True], [True] * 3])
    stable, unstable = figures.steady_lines(np.arange(4.0), branches, calm)
    sizes = np.sort(stable[1][~np.isnan(stable[1])])
    assert sizes.size == 6
    assert np.allclose(sizes, 1e3 * np.array([1.0, 1.1, 1.2, 3.0, 3.1, 3.2]))
    assert np.allclose(np.sort(unstable[1][~np.isnan(unstable[1])]), [1900.0, 2000.0])


def labels(figure: Any) -> list[str]:
    return [text.get_text() for text in figure.legends[0].get_texts()]


def test_figures(record: RunupAnswer) -> None:
    names = {one.name for one in flat(record.blocks(), "page") if isinstance(one, Picture)}
    assert names == {"runup_speed", "runup_time", "runup_energy"}
    speed = figures.speed_figure(record)
    assert {"run-up", "run-down", "steady response"} <= set(labels(speed))
    lines = {line.get_label(): line for line in speed.axes[0].get_lines()}
    up, back = lines["run-up"], lines["run-down"]
    assert up.get_linestyle() != back.get_linestyle()  # told apart without colour too
    # Sample or step: the modulus of one place is known to rounding.
    peak, peak_back = 1e3 * record.peak["amplitude"], 1e3 * record.peak_back["amplitude"]
    assert up.get_ydata().max() == pytest.approx(peak, rel=1e-14)
    assert back.get_ydata()[1:].max() == pytest.approx(peak_back, rel=1e-14)
    assert np.allclose(up.get_xdata()[[0, -1]], [20.0 / RPM, 40.0 / RPM])
    told = str(speed.caption)
    assert "16 cells" in told and "linear, 3 1/s" in told and "Error of the amplitude" in told


def test_dry_and_wet_are_drawn_in_the_same_axes(record: RunupAnswer) -> None:
    """Every peak of the run, with liquid and without, and of the steady response is inside the axes."""
    assert record.steady is not None
    axes = figures.speed_figure(record).axes[0]
    lines = {str(line.get_label()): line for line in axes.get_lines()}
    for name in ("run-up", "run-down"):
        wet, dry = lines[name], lines[f"{name}, without liquid"]
        assert wet.get_linestyle() != dry.get_linestyle() or dry.get_marker() == "o"
    drawn = np.concatenate([line.get_ydata() for line in lines.values()])
    bare = 1e3 * record.peak_dry["amplitude"]
    assert lines["run-up, without liquid"].get_ydata().max() == pytest.approx(bare, rel=1e-14)
    assert axes.get_ylim()[1] > np.nanmax(drawn) >= 1e3 * np.nanmax(record.amplitude_dry)
    below = figures.time_figure(record)
    over_time = next(axes for axes in below.axes if "Amplitude" in axes.get_ylabel())
    wet, dry = over_time.get_lines()[:2]
    assert set(1e3 * record.amplitude_dry) <= set(dry.get_ydata())
    assert np.all(np.diff(dry.get_xdata()) > 0.0)
    largest = 1e3 * max(record.peak["amplitude"], record.peak_back["amplitude"])
    assert np.max(wet.get_ydata()) == pytest.approx(largest, rel=1e-14)
    assert over_time.get_ylim()[1] > max(np.max(wet.get_ydata()), np.nanmax(dry.get_ydata()))


def test_a_steady_peak_far_above_the_run_is_told_in_words(record: RunupAnswer) -> None:
    """It would flatten the run; nothing of the run itself is ever cut."""
    assert record.steady is not None
    tall = replace(record.steady, deflection_dry=record.steady.deflection_dry.copy())
    tall.deflection_dry[200] = 30.0 * record.amplitude.max()
    axes = figures.speed_figure(replace(record, steady=tall)).axes[0]
    names = [str(line.get_label()) for line in axes.get_lines()]
    said = f"steady, without liquid (up to {with_unit(30.0 * float(record.amplitude.max()), LENGTH)})"
    assert said in names
    top = 1e3 * max(float(record.amplitude.max()), record.peak_dry["amplitude"])
    assert top < axes.get_ylim()[1] < 1.2 * figures.FAR * top


def test_the_peak_does_not_depend_on_what_is_kept() -> None:
    """Ten samples or five hundred: the peak of all steps is one, dry as well; of ten alone it would not be.

    Steps end at other times where more is kept. They are of second order: with 16 cells the two are within
    1.5 %, so with 64 within a sixteenth of that.
    """
    few, many = (runup_scene(scene(), 64, count, check=False) for count in (10, 500))
    for of_few, of_many in ((few.peak, many.peak), (few.peak_dry, many.peak_dry)):
        assert of_few["amplitude"] == pytest.approx(of_many["amplitude"], rel=1e-3)
        assert of_few["time"] == pytest.approx(of_many["time"], abs=2.0 * math.pi / 20.0)
    assert few.amplitude.max() < 0.95 * few.peak["amplitude"]
    note = next(note for note in few.notes if note.code in ("peak", "peak_steady"))
    assert note.data["amplitude"] == few.peak["amplitude"]


@kills("leblanc.studies.runup.study:dry_run", "replace(fill, volume=0.0)", "fill")
def test_the_run_without_liquid_is_that_of_the_empty_machine(record: RunupAnswer) -> None:
    """Both liquid models step the rotor alone by the same trapezium; the steps end at the same angles."""
    empty = scene(runup={"back": True}, chambers=[_chamber(0.0)])
    plan = planned(empty)
    history = run_up(
        runup_module.dry_rotor(empty).system(), empty.fills, drive_of(plan),
        numerics=runup_module.numerics_of(plan, check=False),
    )  # fmt: skip
    largest = history.amplitude.max()
    wet = scene(runup={"back": True})
    own = runup_module.dry_run(
        wet, record.history, drive_of(plan), 0.0, runup_module.numerics_of(plan), "long_wave"
    )
    assert own is not None and own.layer_mass.sum() == 0.0
    assert np.array_equal(own.amplitude, record.amplitude_dry)
    # Second order in the step: both are within a hundredth of each other where steps differ by halves.
    assert np.abs(record.amplitude_dry - history.amplitude).max() < 1e-2 * largest
    assert abs(record.peak["amplitude"] - record.peak_dry["amplitude"]) > 1e-2 * largest
    assert np.array_equal(record.speed_dry, record.speed)
    told = record.to_json()
    assert told["peak_dry"]["amplitude"] == own.largest[: record.turning + 1].max()


def test_a_run_that_stops_keeps_the_times_of_the_run_without_liquid(record: RunupAnswer) -> None:
    short = replace(record, history_dry=replace(record.history, time=record.time[:5], speed=record.speed[:5]))
    assert np.array_equal(short.speed_dry[:5], record.speed[:5]) and np.isnan(short.speed_dry[5:]).all()
    alone = replace(record, history_dry=None)
    assert np.isnan(alone.amplitude_dry).all() and math.isnan(alone.peak_dry["amplitude"])
    names = labels(figures.speed_figure(alone))
    assert "run-up" in names and not any("without liquid" in name for name in names if "run" in name)


def test_capture_is_marked_over_time() -> None:
    """At the time of the event itself, which need not be that of a sample."""
    caught = np.ones((50, 1), dtype=bool)
    caught[:10] = caught[-5:] = False
    events = [Transfer(0, True, 0.2011, 90.0, (0.0, 0.0), (0.0, 0.0), 0.0)]
    events.append(Transfer(0, False, 0.9011, 80.0, (0.0, 0.0), (0.0, 0.0), 0.0))
    record = made_up(history_of(50, 1, captured=caught, transfers=tuple(events)))
    figure = figures.time_figure(record)
    assert {"liquid centrifuged", "annulus collapses", "model out of range"} <= set(labels(figure))
    lines = [line for axes in figure.axes for line in axes.lines]
    marked = [line for line in lines if str(line.get_label()).startswith(("liq", "annulus"))]
    assert {float(line.get_xdata()[0]) for line in marked} >= {0.2011, 0.9011}


@kills("solvers.runup.runup:EnergyAudit.faults_beside", "abs(left) <= OPEN", "abs(left) <= 2.0 * OPEN")
@kills("solvers.runup.runup:EnergyAudit.faults_beside", "< -COLD", "< -2.0 * COLD")
@kills("leblanc.studies.runup.answer:run_faults", "not size <= chamber.radius", "size > 1.1 * chamber.radius")
def test_what_is_not_physical_is_no_answer() -> None:
    """A balance that does not close, a heat below zero, a deflection beyond the wall: each by its term."""
    sound = made_up(history_of(20, 1))
    assert sound.converged and sound.reason == "" and sound.energy_error == sound.energy.closure == 0.0
    audit = sound.history.audit
    radius = sound.chambers[0].radius
    # Of a scale of 1 J: 0.06 are left; what friction would give is accounted for.
    for change, word in (
        ({"audit": replace(audit, change=0.44)}, "balance leaves 0.06 J"),
        ({"audit": replace(audit, change=math.nan)}, "balance leaves nan"),
        (
            {"audit": replace(audit, friction=-1.5e-6, change=0.5000015)},
            "heat of wall friction is -1.5e-06 J",
        ),
        ({"audit": replace(audit, baffles=-2e-6, change=0.500002)}, "heat of baffles is -2e-06 J"),
        ({"largest": np.full(20, 1.01 * radius)}, "axis of chamber 1"),
        ({"deflection": np.full((20, 1), 1.01j * radius)}, "axis of chamber 1"),
    ):
        found = made_up(history_of(20, 1, **change))
        assert not found.converged and word in found.reason, change
        told = found.to_json()
        assert told["converged"] is False and told["energy_error"] == told["energy"]["closure"]
    for change in ({"audit": replace(audit, change=0.46)}, {"largest": np.full(20, 0.99 * radius)}):
        assert made_up(history_of(20, 1, **change)).converged


@pytest.mark.parametrize("start", [1.0, 5.0])
@pytest.mark.parametrize(("count", "tip"), [(2, 0.19), (4, 0.15), (8, 0.17), (12, 0.12)])
def test_baffles_that_lift_a_pool_from_rest(start: float, count: int, tip: float) -> None:
    """Below sqrt(g/R) = 7 rad/s there is no annular layer yet: its drag brakes the pool and gives no energy.

    An explicit step of that drag overshoots: six of these broke off, their balance open 1e5 times and more.
    Twelve high bars hold it where they caught it, uneven as that is; it rides with the drum all the same.
    """
    found = runup_scene(baffled(count, tip, start), check=False)
    rides = abs(found.history.mean_rotation[-1, 0]) < 0.02 * found.history.speed[-1]
    assert found.converged and (rides if count == 12 else found.captured[-1].all())
    # Bores and baffles lose energy by the scheme's own error, which falls with the cells (1e-3 with 64).
    assert found.energy_error < 0.01
    for heat in ("support", "friction", "bores", "baffles"):
        assert getattr(found.energy, heat) >= -1e-6 * found.energy.scale


def baffled(count: int, tip: float, start: float) -> Scene:
    """Half a litre of water in a lying drum with baffles."""
    rotor = {"mass": 40.0, "stiffness": 64000.0, "damping": 400.0, "unbalance": 0.05}
    chamber = {"radius": 0.2, "height": 0.05, "volume": 5e-4, "liquid": "water"}
    ramp = {"start": start, "stop": 60.0, "rate": 40.0, "duration": 1.6, "cells": 48, "samples": 80}
    return scene_from_table(
        {
            "name": "lying",
            "rotor": {"kind": "jeffcott", "axis": "horizontal"} | rotor,
            "chambers": [chamber | {"baffles": {"count": count, "tip_radius": tip}}],
            "speeds": {"start": 5.0, "stop": 60.0, "count": 3},
            "runup": ramp,
        },
        "lying",
    )


@pytest.mark.usefixtures("undrawn")
def test_a_deflection_beyond_the_wall_ends_with_3(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Saved, the term named, the JSON printed as well."""
    scene = tmp_path / "wide.toml"
    scene.write_text(
        """
        name = "wide"
        rotor = { kind = "jeffcott", axis = "vertical", mass = 1, stiffness = 900, damping = 1, unbalance = 1}
        chambers = [{ radius = 0.02, height = 0.02, volume = 1e-6, liquid = "water" }]
        speeds = { start = 20.0, stop = 40.0, count = 3 }
        model = { liquid = "linear" }
        runup = { start = 20.0, stop = 40.0, rate = 40.0, duration = 0.6, cells = 16 }
        """
    )
    command = ["runup", str(scene), "--no-check", "--json", "--out", str(tmp_path / "out")]
    assert main(command) == 3
    printed = capsys.readouterr()
    answer = json.loads(printed.out)
    assert answer["converged"] is False and "beyond its radius of 20 mm" in answer["reason"]
    assert answer["energy_error"] == answer["energy"]["closure"] < 0.05
    assert "beyond its radius of 20 mm" in printed.err
    assert (tmp_path / "out" / "runup.nc").exists()


def made_up(history: RunupHistory, machine: Scene | None = None) -> RunupAnswer:
    """Record of a made-up history."""
    machine = machine or lying()
    good, notes = judged(machine, history)
    return RunupAnswer(
        name=machine.name,
        source="",
        assumed=(),
        digest="",
        inputs=(),
        kind="jeffcott",
        axis=machine.rotor.axis,
        friction=machine.model.friction,
        gravity=machine.gravity,
        model="long_wave",
        model_reason="",
        model_error=math.nan,
        cells=planned(machine).cells,
        dispersion=planned(machine).dispersion,
        history=history,
        turning=history.time.size - 1,
        in_range=good,
        steady=None,
        bands=((50.0, 60.0),),
        chambers=tuple(map(runup_module.chamber_of, machine.fills)),
        planes=tuple(fill.chamber.plane for fill in machine.fills),
        notes=notes,
    )


@pytest.mark.parametrize("layers", [0, 1, 3])
def test_figures_of_dull_histories(layers: int) -> None:
    """Nothing moves, nothing turns faster, no chamber: there is a figure all the same."""
    none = {"deflection": np.zeros((20, max(layers, 1)), dtype=complex)}
    chambers = [_chamber(1e-4, radius=0.2 - 0.01 * j) for j in range(layers)]
    machine = lying(chambers=chambers) if layers else lying().altered(chambers=())
    record = made_up(history_of(20, layers, **none), machine)
    for draw in (figures.speed_figure, figures.time_figure, figures.energy_figure):
        draw(record).canvas.draw()


# --- film ------------------------------------------------------------------------------------------------


@kills("leblanc.studies.runup.study:runup_frames", "turn = np.exp(-1j", "turn = np.exp(1j")
@kills(
    "solvers.runup.long_wave:Coupled._depths",
    "np.maximum(1.0 - 2.0 * area, 0.0)",
    "np.maximum(1.0 - area, 0.0)",
)
def test_film() -> None:
    """The frames hold the record's deflections in the drum frame and all of the liquid."""
    machine = scene(runup={"duration": 1.0, "samples": 201})
    found = runup_scene(machine, check=False, frames=21)
    reel = found.frames
    assert reel is not None
    at = np.searchsorted(found.history.time, reel.time - 1e-9)
    assert np.allclose(reel.speed, found.history.speed[at], rtol=1e-9)
    # The stops of the film fall on the samples' times; its steps are the same.
    largest = found.history.amplitude.max()
    assert np.abs(reel.deflection[:, 0] - found.deflection[at]).max() < 1e-6 * largest
    radius, height = 0.25, 0.04
    area = np.mean(radius * reel.depth - 0.5 * reel.depth**2, axis=2) * 2.0 * math.pi
    assert np.allclose(area[:, 0] * height, 0.5e-3, rtol=1e-12)


def shoelace(edge: np.ndarray) -> float:
    return abs(float(np.sum(edge.real * np.roll(edge.imag, -1) - edge.imag * np.roll(edge.real, -1)))) / 2.0


@kills(
    "leblanc.liquid.choose:across_gravity",
    'scene.gravity if scene.rotor.axis == "horizontal"',
    'scene.gravity if scene.rotor.axis == "vertical"',
)
@kills(
    "leblanc.studies.runup.study:runup_frames",
    "history.offset[kept.sample] * turn",
    "history.offset[kept.sample] / turn",
)
def test_pool() -> None:
    """Liquid at the bottom: its outline holds its volume, and its middle points down as the drum turns."""
    ramp = {"start": 1.0, "stop": 3.0, "rate": 4.0, "duration": 0.5, "capture": "riding"}
    found = runup_scene(lying(runup=ramp), check=False, frames=5)
    assert not found.history.captured.any()
    reel = found.frames
    assert reel is not None
    chamber = found.chambers[0]
    for k in range(5):
        edge, _ = film_figures.liquid_shape(chamber, reel, k, 0, factor=1.0)
        # The pool has the right area between the chords of a wall of 720 sides.
        assert shoelace(edge) * 1e-6 * chamber.height == pytest.approx(chamber.volume, rel=1e-4)
        # Between samples of 1/600 s a ramp of 4 rad/s^2 bends the angle by 1.4e-6.
        angle = np.interp(reel.time[k], found.history.time, found.history.angle)
        # Down in space is against the first direction: in a drum that has turned by an angle, at pi less it.
        after = np.roll(edge, -1)
        middle = complex(np.sum((edge + after) * (edge.conj() * after).imag))
        assert np.angle(middle * np.exp(1j * (angle - math.pi))) == pytest.approx(0.0, abs=1e-5)


@given(st.floats(1e-3, 0.999))
def test_a_pool_fills_its_share(share: float) -> None:
    volume = share * math.pi * 0.25**2 * 0.04
    half = half_angle(volume / (0.04 * 0.25**2))
    # Bisected to 2^-60 of pi; the segment's area changes by 2 sin^2 of the half angle, at most 2.
    assert 0.25**2 * (half - math.sin(half) * math.cos(half)) * 0.04 == pytest.approx(volume, abs=1e-15)


def test_a_round_surface_stays_round_as_drawn() -> None:
    """A thin layer whose surface is a circle about the axis at rest: both are magnified by one factor."""
    theta = (np.arange(360) + 0.5) * 2.0 * math.pi / 360
    mean, swing = 5e-3, 2e-3 * np.exp(0.7j)
    depth = mean + (swing * np.exp(-1j * theta)).real
    reel = RunupFrames(
        time=np.array([0.0, 1.0]),
        speed=np.full(2, 30.0),
        deflection=np.full((2, 1), swing),
        amplitude=np.full(2, abs(swing)),
        theta=theta,
        depth=np.broadcast_to(depth, (2, 1, 360)).copy(),
        down=np.zeros(2),
        pool=np.zeros((2, 1)),
    )
    record = made_up(history_of(2, 1))
    factor = film_factor(record.chambers, reel.depth, reel.deflection)
    assert factor > 1.0
    _, surface = film_figures.liquid_shape(record.chambers[0], reel, 0, 0, factor)
    distance = np.abs(surface * 1e-3 + factor * swing)
    # To the square of the drawn swing over the radius, which makes a circle's equation linear; the drawing
    # joins cells of one degree by straight lines, which is less.
    assert np.ptp(distance) < (factor * abs(swing)) ** 2 / 0.25


def test_nested_chambers_share_a_drawing() -> None:
    walls = [(0.2, 0.15), (0.15, 0.1), (0.2, 0.0)]
    chambers = tuple(
        runup_module.chamber_of(Fill(Chamber(outer, 0.04, inner), WATER, 1e-4)) for outer, inner in walls
    )
    assert film_figures.drawings(chambers, (0.0, 0.0, 0.0)) == [[0, 1], [2]]
    assert film_figures.drawings(chambers, (0.0, 0.1, 0.0)) == [[0], [2], [1]]


def test_animation(tmp_path: Path, record: RunupAnswer) -> None:
    from PIL import Image

    machine = scene(runup={"back": True})
    reel = runup_scene(machine, check=False, frames=3).frames
    assert reel is not None
    counted: list[tuple[int, int]] = []
    frames = film_figures.animate(record, reel, tmp_path / "a.gif", lambda i, n: counted.append((i, n)))
    assert frames == 3
    assert counted == [(1, 3), (2, 3), (3, 3)]
    with Image.open(tmp_path / "a.gif") as image:
        assert getattr(image, "n_frames", 1) == 3
        assert image.size[1] % 2 == 0
    with pytest.raises(InputError, match=r"\.gif, \.html or \.mp4"):
        film_figures.animate(record, reel, tmp_path / "a.avi")
    with pytest.raises(InputError, match="frames"):
        runup_scene(machine, frames=1)


# --- the command -----------------------------------------------------------------------------------------


def write_scene(path: Path, content: dict[str, Any]) -> Path:
    """A scene as TOML; single values and lists as JSON writes them."""
    lines = [f"{key} = {json.dumps(value)}" for key, value in content.items() if isinstance(value, str)]
    for key, value in content.items():
        for part in value if isinstance(value, list) else [value] if isinstance(value, dict) else []:
            lines.append(f"[[{key}]]" if isinstance(value, list) else f"[{key}]")
            lines += [f"{name} = {_toml(entry)}" for name, entry in part.items() if entry is not None]
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return path


def _toml(value: Any) -> str:
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{name} = {_toml(entry)}" for name, entry in value.items()) + " }"
    return json.dumps(value)


PICTURES = {f"runup_{name}.svg" for name in ("speed", "time", "energy")}
FILES = {*PICTURES, "runup.nc", "runup.html", "contents.json"}


@pytest.mark.usefixtures("undrawn")
def test_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_scene(tmp_path / "s.toml", table(runup={"duration": 0.3}))
    again = ["runup", str(file), "--cells", "8", "--samples", "20", "--out", str(tmp_path / "out")]
    assert main([*again, "--no-check", "--json"]) == 0
    got = json.loads(capsys.readouterr().out)
    assert len(got["time"]) == 20
    assert got["cells"] == 8
    assert got["error_estimate"] is None
    assert {path.name for path in (tmp_path / "out").iterdir()} == FILES | {
        "runup.nc",
        "runup.html",
        "contents.json",
    }
    assert main(["run-up", *again[1:]]) == 0  # another name of the command
    text = capsys.readouterr()
    assert "Largest amplitude" in text.out
    assert "energy closed" in text.err


def test_command_refuses_before_it_runs(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    bare = write_scene(tmp_path / "bare.toml", table(runup=None))
    file = write_scene(tmp_path / "s.toml", table())
    linear = write_scene(tmp_path / "linear.toml", table(model={"liquid": "linear"}))
    for scene, options, told in (
        (bare, [], 'runup = "missing": must be a table [runup]'),
        (file, ["--animate", "film.txt"], "must be a file that ends in .gif, .html or .mp4"),
        (file, ["--cells", "3"], "--cells = 3: must be from 8 to 65536"),
        (file, ["--workers", "0"], "--workers = 0: must be 1 or more"),
        (linear, ["--animate", str(tmp_path / "film.gif")], "must be auto or long_wave for a film"),
    ):
        assert main(["runup", str(scene), "--out", str(tmp_path / "out"), *options]) == 2
        assert told in capsys.readouterr().err, told
    assert not (tmp_path / "out").exists()


def standing_motor() -> dict[str, Any]:
    """A machine whose motor brakes it to a stand."""
    motor = {"inertia": 1.0, "speeds": [0.0, 100.0], "torques": [-100.0, -100.0]}
    content = table(chambers=[_chamber(0.0)])
    content["runup"] = {
        "start": 20.0,
        "stop": 40.0,
        "duration": 5.0,
        "motor": motor,
        "cells": 8,
        "samples": 50,
    }
    return content


@pytest.mark.usefixtures("undrawn")
def test_what_was_reached_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = write_scene(tmp_path / "s.toml", standing_motor())
    assert main(["runup", str(file), "--out", str(tmp_path / "out"), "--json", "--no-check"]) == 3
    printed = capsys.readouterr()
    assert "motor stands" in printed.err
    got = json.loads(printed.out)
    assert got["converged"] is False
    # 20 rad/s are gone after 0.2 s.
    assert 0.0 < got["time"][-1] < 0.25
    assert {path.name for path in (tmp_path / "out").iterdir()} == FILES | {
        "runup.nc",
        "runup.html",
        "contents.json",
    }


@pytest.mark.usefixtures("undrawn")
def test_an_interrupted_run_leaves_its_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    history = history_of(20, 1, outcome=Outcome.INTERRUPTED, reason="interrupted at 1 s, 100 rad/s")
    monkeypatch.setattr(runup_module, "runup_scene", lambda **_: made_up(history))
    file = write_scene(tmp_path / "s.toml", table())
    assert main(["runup", str(file), "--out", str(tmp_path / "out")]) == 130
    assert (tmp_path / "out" / "runup.nc").exists()


@kills(
    "leblanc.studies.runup.study:liquid_model",
    'return "long_wave" if liquid == "auto"',
    'return "linear" if liquid == "auto"',
)
def test_liquid_model() -> None:
    """Long waves unless the scene asks for linear layers; what has no time is refused."""
    for asked, taken in (("auto", "long_wave"), ("long_wave", "long_wave"), ("linear", "linear")):
        machine = scene().altered(model=scene().model.altered(liquid=asked))
        assert liquid_model(machine) == taken
    for asked in ("statics", "kdv", "fem"):
        with pytest.raises(InputError, match="liquid"):
            liquid_model(scene().altered(model=scene().model.altered(liquid=asked)))


def test_linear_waves_out_of_their_range_are_told() -> None:
    linear = scene().altered(model=scene().model.altered(liquid="linear"))
    fill = linear.fills[0]
    depth = np.array([[1.2], [1.5]]) * fill.depth
    good, notes = judged(linear, history_of(2, 1, depth_max=depth, depth_min=2.0 * fill.depth - depth))
    assert good.tolist() == [True, False] and [note.code for note in notes] == [RunupCode.TOO_HIGH]
