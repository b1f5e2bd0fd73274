"""Sweeps of run-ups: each sample is what `runup` of its machine gives, kept over bands of the spin speed."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given, settings
from hypothesis import strategies as st

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError
from leblanc.scene.tasks import Optimisation
from leblanc.studies.optimise.study import emulated_vibration
from leblanc.studies.sweep.outputs import LEVELS, RunupAnswers, worst_of
from leblanc.studies.sweep.plan import study_of
from leblanc.studies.sweep.runups import answer_runups, over_bands
from leblanc.studies.sweep.store import STORE
from meshes.arrays import Array
from meshes.errors import InputError
from tests.leblanc.studies.test_programme import machine
from tests.mutants import kills
from tests.oracles.sweeps import tree

RUNUPS = "leblanc.studies.sweep.runups"
SHORT = {"runup.cells": 16, "runup.samples": 200, "runup.stop": "60 rad/s", "runup.duration": "8 s"}


def short(name: str = "runup", **changed: Any) -> Scene:
    return lb.example(name).replace({**SHORT, **changed})


def study(scene: Scene, **given: Any) -> dict[str, Any]:
    vary = {"rotor.unbalance": {"linspace": [0.05, 0.1, 2]}, "chambers.0.volume": {"choice": [0.0, 5e-4]}}
    return {"scene": scene, "command": "runup", "method": "grid", "vary": vary, "check": False, **given}


@kills(f"{RUNUPS}:_one", "run.amplitude[-1]", "run.amplitude[0]")
@kills(f"{RUNUPS}:_one", "dry.largest.max()", "run.largest.max()")
@kills(f"{RUNUPS}:_one", '"peak_speed": run.largest_speed[most]', '"peak_speed": run.largest_speed[-1]')
@kills(f"{RUNUPS}:_one", '"motor_work": run.audit.motor', '"motor_work": run.audit.drive')
def test_each_sample_is_what_runup_gives(tmp_path: Path) -> None:
    """Of the weak motor, whose speed its liquid decides; the last digit as well."""
    scene = short("weak_motor", **{"runup.duration": "20 s"})
    found = lb.sweep(study(scene), out=tmp_path, workers=0)
    store = xr.open_zarr(tmp_path / STORE, consolidated=False).load()
    assert found.done == store.sizes["sample"] == 4
    assert store.sizes["speed"] == LEVELS
    for k in range(4):
        values = {path: float(store[path][k]) for path in ("rotor.unbalance", "chambers.0.volume")}
        alone = lb.run_up(scene.replace(values), check=False)
        kept = store.isel(sample=k)
        assert float(kept.peak_amplitude) == alone.peak["amplitude"]
        assert float(kept.peak_speed) == alone.peak["speed"]
        assert float(kept.peak_time) == alone.peak["time"]
        assert float(kept.peak_amplitude_dry) == alone.peak_dry["amplitude"]
        assert float(kept.last_amplitude) == alone.amplitude[-1]
        assert float(kept.last_speed) == alone.speed[-1]
        assert float(kept.top_speed) == alone.speed.max()
        assert float(kept.motor_work) == alone.energy.motor > 0.0
        assert str(kept.model.values) == alone.model
        assert bool(kept.in_range) == alone.in_range.all()
        assert alone.time[0] <= float(kept.top_time) <= alone.time[-1]
        # No band has more than the peak, and the one with it has no less.
        assert float(kept.amplitude.max()) == alone.peak["amplitude"]


@kills(f"{RUNUPS}:_one", "np.diff(run.time) @ run.limited[1:]", "np.diff(run.time) @ run.limited[:-1]")
@kills(f"{RUNUPS}:_one", "run.speed >= nearly", "run.speed >= top")
def test_a_motor_that_cannot_follow_its_programme() -> None:
    """The time in which it gives less than asked, and that at which it is nearly as fast as it comes."""
    torques = {"speeds": [0.0, 100.0], "torques": [9.0, 9.0]}
    scene = machine(motor=torques, steps=["to 60 rad/s in 1 s", "hold 1 s"])
    found, alone = answer_runups([scene], False), lb.run_up(scene, check=False)
    assert alone.motor_limited is not None
    lasts = sum(
        alone.time[k] - alone.time[k - 1] for k in range(1, alone.time.size) if alone.motor_limited[k]
    )
    assert found.limited_time[0] == pytest.approx(lasts, rel=1e-12) and lasts > 0.0
    near = alone.speed >= alone.speed.max() - 0.01 * (alone.speed.max() - alone.speed[0])
    assert found.top_time[0] == alone.time[near].min() < alone.time[np.argmax(alone.speed)]


def test_an_answer_does_not_depend_on_its_companions() -> None:
    scenes = [short(**{"rotor.unbalance": size}) for size in (0.05, 0.1, 0.15)]
    together, back = answer_runups(scenes, False), answer_runups(scenes[::-1], False)
    for k, scene in enumerate(scenes):
        alone = answer_runups([scene], False)
        for found, row in ((together, k), (back, 2 - k)):
            np.testing.assert_array_equal(found.amplitude[row], alone.amplitude[0])
            assert found.peak_amplitude[row] == alone.peak_amplitude[0]


@kills(f"{RUNUPS}:_one", "numerics_of(plan, check=check)", "numerics_of(plan, check=False)")
def test_the_error_of_each_run_where_it_is_checked() -> None:
    scene = short(**{"model.liquid": "long_wave"})
    answer = lb.run_up(scene)
    assert answer_runups([scene], True).error_estimate[0] == answer.model_error > 0.0
    assert np.isnan(answer_runups([scene], False).error_estimate[0])


@kills("leblanc.studies.sweep.outputs:worst_of", "np.fmin.reduce(clearances)", "np.fmax.reduce(clearances)")
@kills("leblanc.studies.sweep.outputs:worst_of", "loads.largest(loads.power)", "loads.least(loads.power)")
@pytest.mark.parametrize("command", ["run", "runup"])
def test_loads_are_those_of_the_command(command: str, tmp_path: Path) -> None:
    """Force of the floor, walking margin, clearance and motor, over a range of speeds or a way in time."""
    scene = lb.example("tub").replace({"runup.duration": "3 s", "runup.cells": 16, "speeds.count": 12})
    vary = {"cabinet.friction": {"linspace": [0.2, 0.5, 2]}}
    given = {"scene": scene, "method": "grid", "vary": vary, "command": command}
    lb.sweep(given | ({"check": False} if command == "runup" else {}), out=tmp_path, workers=0)
    store = xr.open_zarr(tmp_path / STORE, consolidated=False).load()
    for k, friction in enumerate((0.2, 0.5)):
        changed = scene.replace({"cabinet.friction": friction})
        answer = lb.run(changed) if command == "run" else lb.run_up(changed, check=False)
        worst = answer.worst
        feet = [foot.value for foot in worst["floor_force"]]
        # The same from arrays of another shape.
        same = {"rel": 1e-9}
        assert float(store.floor_force[k]) == pytest.approx(max(feet), **same)
        assert float(store.walking_margin[k]) == pytest.approx(worst["walking_margin"].value, **same)
        least = min(each.value for each in worst["clearance"].values())
        assert float(store.clearance[k]) == pytest.approx(least, **same)
        assert float(store.motor_torque[k]) == pytest.approx(worst["motor_torque"].value, **same)
        assert float(store.motor_power[k]) == pytest.approx(worst["motor_power"].value, **same)
    # A machine on a slippery floor walks first.
    assert store.walking_margin[0] < store.walking_margin[1]


def test_no_loads_of_a_machine_without_parts() -> None:
    assert worst_of(None) == {}
    assert answer_runups([short()], False).floor_force is None


def test_planar_machines_have_loads_as_run_gives_them(tmp_path: Path) -> None:
    point = {"name": "drum", "position": [0, 0, 0], "gap": "20 mm"}
    table = {**lb.example("horizontal_rig").table(), "points": [point]}
    scene = scene_from_table(table).replace({"speeds.count": 12})
    lb.sweep({"scene": scene, "method": "grid", "vary": {"rotor.unbalance": {"linspace": [3e-4, 6e-4, 2]}}},
             out=tmp_path, workers=0)  # fmt: skip
    store = xr.open_zarr(tmp_path / STORE, consolidated=False).load()
    for k, size in enumerate((3e-4, 6e-4)):
        answer = lb.run(scene.replace({"rotor.unbalance": size}))
        assert float(store.clearance[k]) == pytest.approx(answer.worst["clearance"]["drum"].value, rel=1e-8)
    assert "floor_force" not in store


# -- bands of the spin speed ---------------------------------------------------------------------------------


def history(speed: Array, amplitude: Array, extra: Array) -> Any:
    """A run with so many records; between two of them the amplitude rises `extra` above both, halfway."""

    class Run:
        time = np.arange(speed.size, dtype=float)
        largest = amplitude.copy()
        largest_speed = speed.copy()

    run = Run()
    run.speed, run.amplitude = speed, amplitude  # type: ignore[attr-defined]
    run.largest[1:] = np.maximum(amplitude[1:], amplitude[:-1]) + extra[1:]
    run.largest_speed[1:] = 0.5 * (speed[1:] + speed[:-1])
    return run


@kills(f"{RUNUPS}:over_bands", "band(run.largest_speed), run.largest", "own, run.largest")
@kills(f"{RUNUPS}:over_bands", "np.minimum.at(time, own, run.time)", "np.maximum.at(time, own, run.time)")
@kills(f"{RUNUPS}:over_bands", "low + step < high", "low + step <= low")
@settings(max_examples=200, deadline=None)
@given(st.integers(0, 2**32 - 1), st.integers(2, 40), st.integers(1, 30))
def test_bands_hold_what_was_met_in_them(seed: int, records: int, count: int) -> None:
    """Against a loop over bands: the records in each, the largest between records, and what was passed."""
    rng = np.random.default_rng(seed)
    edges = np.linspace(0.0, 1.0, count + 1)
    run = history(rng.uniform(-0.2, 1.2, records), rng.random(records), rng.random(records))
    amplitude, time = over_bands(run, edges)
    inner = np.clip(edges, 0.0, 1.0)
    inner[0], inner[-1] = -np.inf, np.inf
    for j in range(count):
        inside = (inner[j] <= run.speed) & (run.speed < inner[j + 1])
        at_most = (inner[j] <= run.largest_speed) & (run.largest_speed < inner[j + 1])
        met = [*run.amplitude[inside], *run.largest[at_most]]
        times = [*run.time[inside]]
        for k in range(records - 1):
            low, high = sorted(run.speed[k : k + 2])
            if low < inner[j] and inner[j + 1] <= high:
                met.append(max(run.amplitude[k : k + 2]))
                times.append(run.time[k + 1])
        assert (not met and np.isnan(amplitude[j])) or amplitude[j] == max(met)
        assert (not times and np.isnan(time[j])) or time[j] == min(times)
    assert np.nanmax(amplitude) == run.largest.max()


def test_where_the_spin_does_not_come_nothing_is_known() -> None:
    """A motor that hangs at the resonance."""
    scene = short("weak_motor", **{"chambers.0.volume": 0.0, "runup.motor.torques.0": "1 N*m"})
    found = answer_runups([scene], False)
    assert isinstance(found, RunupAnswers)
    came = found.speed[0] <= found.top_speed[0]
    assert not came.all()
    assert np.isfinite(found.amplitude[0, :-1][came[1:]]).all()
    assert np.isnan(found.amplitude[0, 1:][~came[:-1]]).all()
    assert (np.diff(found.time[0][np.isfinite(found.time[0])]) >= 0.0).all()


# -- store, report, faults -----------------------------------------------------------------------------------


def written(folder: Path, scene: Scene) -> Path:
    scene_file, path = folder / "scene.toml", folder / "study.toml"
    scene_file.write_text(scene.to_toml(), encoding="utf-8")
    lines = ['scene = "scene.toml"', 'command = "runup"', "check = false", 'method = "latin_hypercube"']
    lines += ["samples = 8", "[vary]", '"rotor.unbalance" = { uniform = [0.05, 0.1] }']
    lines += ['"chambers.0.volume" = { uniform = ["0.1 l", "0.6 l"] }']
    path.write_text("\n".join(lines), encoding="utf-8")
    return path


def test_the_command_writes_store_figure_and_report(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = written(tmp_path, short())
    assert main(["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "a")]) == 0
    said = capsys.readouterr().out
    assert "top speed" in said
    assert "peak amplitude" in said
    assert "motor work" not in said  # its speed is given
    page = (tmp_path / "a" / "sweep.html").read_text(encoding="utf-8")
    assert "leblanc runup, in time" in page
    assert "uniform from 0.0001 to 0.0006 m^3" in page
    assert f"{LEVELS} bands" in page
    assert (tmp_path / "a" / "sweep.svg").stat().st_size > 1000
    # Any workers, and a stop after half of the blocks: the same bytes.
    assert main(["sweep", str(path), "--workers", "1", "--out", str(tmp_path / "b"), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["done"] == 8
    assert tree(tmp_path / "a" / STORE) == tree(tmp_path / "b" / STORE)
    (tmp_path / "b" / STORE / "peak_amplitude" / "c" / "1").unlink()
    assert main(["sweep", str(path), "--workers", "0", "--out", str(tmp_path / "b")]) == 0
    assert tree(tmp_path / "a" / STORE) == tree(tmp_path / "b" / STORE)


def test_a_sample_that_fails_leaves_the_others(tmp_path: Path) -> None:
    """More than the chamber holds is no scene; the others are answered."""
    vary = {"chambers.0.volume": {"choice": [1e-4, 5e-4, 1.0]}}
    found = lb.sweep(study(short(), vary=vary), out=tmp_path, workers=0)
    assert (found.done, found.failed) == (2, 1)
    assert "chambers.0.volume" in found.reasons[0].reason


def test_an_interrupt_ends_the_sweep_and_loses_no_finished_block(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = 0

    def interrupted(*given: Any) -> Any:
        nonlocal calls
        calls += 1
        if calls > 6:  # the scene itself, and five samples: the second block of four is begun
            raise KeyboardInterrupt
        return answer_runups(*given)

    path = written(tmp_path, short())
    monkeypatch.setattr(f"{RUNUPS}.answer_runups", interrupted)
    with pytest.raises(KeyboardInterrupt):
        lb.sweep(path, out=tmp_path / "a", workers=0)
    monkeypatch.undo()
    status = xr.open_zarr(tmp_path / "a" / STORE, consolidated=False).status.values
    assert status.tolist() == [1] * 4 + [0] * 4
    lb.sweep(path, out=tmp_path / "a", workers=0)
    lb.sweep(path, out=tmp_path / "b", workers=0)
    assert tree(tmp_path / "a" / STORE) == tree(tmp_path / "b" / STORE)


@pytest.mark.parametrize(
    ("changed", "field", "said"),
    [
        ({"command": "runnup"}, "command", "one of: run, runup"),
        ({"command": "run"}, "check", 'left out unless command is "runup"'),
        ({"check": 1}, "check", "true or false"),
        ({"vary": {"speeds.start": {"linspace": [1, 2, 2]}}}, "speeds", "runup, programme"),
        ({"vary": {"runup.rates": {"linspace": [1, 2, 2]}}}, "rates", "rate"),
        ({"vary": {"runup.rate": {"linspace": [-1, 2, 2]}}}, "rate", "an angular acceleration"),
    ],
)
def test_what_is_no_study_of_run_ups(changed: dict[str, Any], field: str, said: str) -> None:
    with pytest.raises(SceneError) as raised:
        study_of(study(short(), **changed))
    assert field in str(raised.value)
    assert said in str(raised.value)


def test_a_study_of_run_does_not_vary_the_way_in_time() -> None:
    with pytest.raises(SceneError, match="under gravity, rotor"):
        study_of({"scene": short(), "method": "grid", "vary": {"runup.rate": {"linspace": [1.0, 2.0, 2]}}})


def test_a_machine_without_a_way_in_time_is_refused() -> None:
    table = {key: value for key, value in short().table().items() if key not in ("runup", "assumed")}
    with pytest.raises(InputError, match="runup"):
        study_of(study(scene_from_table(table)))


# -- emulators -----------------------------------------------------------------------------------------------


def test_an_emulator_of_the_peak_in_time_answers_optimise(tmp_path: Path) -> None:
    """Asked by the search, then evaluated by run-ups; a sweep of steady motions is refused for it."""
    scene = short()
    vary = {"chambers.0.volume": {"linspace": [1e-4, 9e-4, 12]}}
    lb.sweep(study(scene, vary=vary), out=tmp_path / "in_time", workers=0)
    given = {"scene": scene, "method": "grid", "vary": vary}
    lb.sweep(given, out=tmp_path / "steady", workers=0)
    answer = lb.optimise(scene, objective="peak", emulator=tmp_path / "in_time" / STORE, front=False)
    assert answer.in_time
    assert 1e-4 <= answer.volume[0] <= 9e-4
    for store, steady in (("steady", False), ("in_time", True)):
        asked = Optimisation(objective="peak", steady=steady)
        with pytest.raises(InputError, match="command"):
            emulated_vibration(tmp_path / store / STORE, scene, asked)
