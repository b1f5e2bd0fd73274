"""Exported files: read back, run by another tool, beside the answers and models that they are of."""

from __future__ import annotations

import csv
import json
import math
import zipfile
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray as xr
from scipy.io import loadmat

import leblanc as lb
from leblanc.cli import main
from leblanc.scene.examples import example_path
from leblanc.scene.scene import Scene
from leblanc.studies.export.cosimulation import Cosimulation, Drive, Refusal, stepped_model
from meshes.errors import InputError
from tests.mutants import kills

HERE = "leblanc.studies.export."
_SHEETS = "{http://schemas.openxmlformats.org/spreadsheetml/2006/main}"


@cache
def short() -> Scene:
    """A run-up of a second, through the resonance of a machine with a vertical axis."""
    changes = {"runup.start": 15.0, "runup.rate": 15.0, "runup.duration": 1.2, "runup.stop": 33.0}
    return lb.example("runup").replace(changes | {"runup.cells": 32, "runup.samples": 121})


@cache
def folder(to: str, tmp: Path, decimal: str = "point") -> Path:
    """Where the files of a format are."""
    lb.export(short(), to=to, decimal=decimal, out=tmp / f"{to}_{decimal}")
    return tmp / f"{to}_{decimal}"


@pytest.fixture(scope="module")
def tmp(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("export")


def table(path: Path, comma: bool = False) -> dict[str, list[str]]:
    """Columns of a CSV file by their heads."""
    with path.open(newline="", encoding="utf-8") as file:
        head, *rows = csv.reader(file, delimiter=";" if comma else ",")
    return {name: [row[k] for row in rows] for k, name in enumerate(head)}


@pytest.mark.parametrize("decimal", ["point", "comma"])
def test_the_peak_is_in_the_table_to_the_last_digit(tmp: Path, decimal: str) -> None:
    """The largest amplitude of the column is the peak of the answer, at its speed; so is that of run-up."""
    comma, where = decimal == "comma", folder("csv", tmp, decimal)
    found = table(where / "response.csv", comma)

    def numbers(name: str, of: dict[str, list[str]] = found) -> np.ndarray:
        texts = [text.replace(",", ".") if comma else text for text in of[name]]
        return np.array([float(text) if text else math.nan for text in texts])

    answer = lb.run(short())
    curve, speed = answer.curve, numbers("speed [rad s-1]")
    assert np.array_equal(speed, curve.speed) and speed.size > answer.speed.size
    assert np.array_equal(numbers("amplitude [m]"), curve.amplitude)
    at = int(np.flatnonzero(speed == answer.peak["speed"])[0])
    assert numbers("amplitude [m]")[at] == answer.peak["amplitude"]
    # What the answer has at the speeds asked for only is there at all of them.
    assert np.isfinite(numbers("growth [s-1]")).all()
    passed, history = table(where / "runup.csv", comma), lb.run_up(short()).history
    assert np.array_equal(numbers("time [s]", passed), history.time)
    assert numbers("largest_amplitude [m]", passed).max() == history.largest.max()


def test_of_every_machine_there_are_tables(tmp_path: Path) -> None:
    """Of kinds with an answer of their own as well."""
    for name in ("vibratory_table", "spindle"):
        found = lb.export(lb.example(name), to="csv", out=tmp_path / name)
        assert set(found.files) == {path.name for path in (tmp_path / name).iterdir()}
        for file in found.files:
            columns = table(tmp_path / name / file)
            assert len(columns) > 1 and all(columns.values())


def sheets(path: Path) -> dict[str, list[list[str | float | None]]]:
    """Cells of a workbook by its sheets."""
    with zipfile.ZipFile(path) as book:
        texts = [
            "".join(part.itertext()) for part in ElementTree.fromstring(book.read("xl/sharedStrings.xml"))
        ]
        names = [
            one.attrib["name"]
            for one in ElementTree.fromstring(book.read("xl/workbook.xml")).iter(f"{_SHEETS}sheet")
        ]
        found = {}
        for k, name in enumerate(names, 1):
            place = f"xl/worksheets/sheet{k}.xml"
            if place not in book.namelist():
                continue  # a chart
            rows = []
            for row in ElementTree.fromstring(book.read(place)).iter(f"{_SHEETS}row"):
                cells = ((one.attrib.get("t"), one.findtext(f"{_SHEETS}v")) for one in row)
                rows.append(
                    [None if v is None else texts[int(v)] if t == "s" else float(v) for t, v in cells]
                )
            found[name] = rows
        found["parts"] = [[name] for name in book.namelist()]
    return found


def test_a_workbook_has_the_numbers_and_a_chart(tmp: Path) -> None:
    """Cells are numbers with all their digits; the chart has the amplitude with and without liquid."""
    pytest.importorskip("xlsxwriter")
    found = sheets(folder("xlsx", tmp) / "Run-up.xlsx")
    head, *rows = found["response"]
    answer, place = lb.run(short()), head.index("amplitude [m]")
    assert [row[0] for row in rows] == answer.curve.speed.tolist()
    assert max(row[place] for row in rows) == answer.peak["amplitude"]
    assert [row[head.index("amplitude_dry [m]")] for row in rows] == answer.curve.amplitude_dry.tolist()
    assert {"response", "response_values", "runup"} <= set(found)
    assert ["xl/charts/chart1.xml"] in found["parts"]


def test_without_the_extra_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for to, module in (("xlsx", "xlsxwriter"), ("fmu", "pythonfmu")):
        monkeypatch.setitem(__import__("sys").modules, module, None)
        with pytest.raises(InputError, match=r"pip install leblanc\[export\]"):
            lb.export(short(), to=to, out=tmp_path)


@pytest.mark.parametrize(
    ("given", "field"),
    [
        ({"to": "ods"}, "to"),
        ({"to": "csv", "decimal": "dot"}, "decimal"),
        ({"to": "statespace", "decimal": "comma"}, "decimal"),
        ({"to": "csv", "speed": 10.0}, "speed"),
        ({"to": "statespace", "speed": -1.0}, "speed"),
        # Its liquid does not cover the walls so slowly.
        ({"to": "statespace", "speed": 1.0}, "speed"),
    ],
)
def test_what_is_no_export_is_refused(tmp_path: Path, given: dict[str, object], field: str) -> None:
    with pytest.raises(InputError) as refused:
        lb.export(short(), out=tmp_path, **given)
    assert refused.value.field == field and not list(tmp_path.iterdir())


def test_the_command(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Files, their record, one line for a fault."""
    given = ["export", "examples/centrifuge.toml", "--to", "statespace", "--out", str(tmp_path)]
    assert main([*given, "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    assert said["files"] == ["chamber_1.json", "chamber_1.mat", "machine.json", "machine.mat"]
    record = json.loads((tmp_path / "contents.json").read_text())
    assert set(record["made"]["export statespace"]["files"]) == set(said["files"])
    assert main(["export", "examples/horizontal_rig.toml", "--to", "statespace"]) == 2
    assert "transverse gravity" in capsys.readouterr().err


# State space


def test_state_space_of_a_scene(tmp_path: Path) -> None:
    """MAT and JSON are alike; the force per displacement is that of `layer --model linear`."""
    scene = lb.example("centrifuge").replace({"model.friction": "none"})
    lb.export(scene, to="statespace", out=tmp_path)
    plain, mat = json.loads((tmp_path / "chamber_1.json").read_text()), loadmat(tmp_path / "chamber_1.mat")
    for name in "ABCD":
        assert np.array_equal(mat[name], np.array(plain[name]))
    assert [text.item() for text in mat["states"].ravel()] == plain["states"]
    assert plain["inputs"] == ["acceleration_x", "acceleration_y"]
    assert plain["speed"] == scene.speed_array()[-1] == mat["speed"].item()
    fill, spin = scene.fills[0], plain["speed"]
    a, b, c, d = (np.array(plain[name]) for name in "ABCD")
    for ratio in (0.4, 0.83, 1.2, -0.3):
        whirl = ratio * spin
        known = {"radius": fill.chamber.radius, "height": fill.chamber.height, "volume": fill.volume}
        layer = lb.layer(**known, speed=spin, whirl_speed=whirl, whirl_amplitude=1e-7, liquid=fill.liquid)
        full = fill.liquid.density * math.pi * fill.chamber.radius**2 * fill.chamber.height
        answer = c @ np.linalg.solve(1j * (whirl - spin) * np.eye(len(a)) - a, b) + d
        # A circle e^{i s t} is real along x and a quarter behind along y.
        force = -(whirl**2) * (answer @ [1.0, -1.0j])[0]
        assert force / (full * whirl**2) == pytest.approx(layer.force_ratio, rel=1e-9)


@kills(f"{HERE}space:spaces", "if across_gravity(scene) > 0.0:", "if False:")
@kills(f"{HERE}space:spaces", "if spin <= least:", "if False:")
def test_state_space_is_refused_where_there_is_none(tmp_path: Path) -> None:
    """Transverse gravity; walls that are not covered; balls; a rotor that does not whirl."""
    assert refusal(lb.example("horizontal_rig"), tmp_path) == "gravity"
    assert refusal(short(), tmp_path, speed=1.0) == "speed"
    for name in ("balls", "blood_pump", "spindle"):
        assert refusal(lb.example(name), tmp_path)


def refusal(scene: Scene, out: Path, **given: float) -> str:
    """Field for which a state space is refused; empty where it is not."""
    try:
        lb.export(scene, to="statespace", out=out, **given)
    except InputError as refused:
        return refused.field
    return ""


def test_what_a_state_space_says_of_itself(tmp_path: Path) -> None:
    """Exact, fitted with its band and error, chambers alone, at the speed asked for."""
    found = lb.export(short(), to="statespace", speed="500 rpm", out=tmp_path)
    assert found.notes[0].code == "state_space_exact"
    assert json.loads((tmp_path / "machine.json").read_text())["speed"] == pytest.approx(500 * math.pi / 30)
    laminar = lb.export(short().replace({"model.friction": "stokes"}), to="statespace", out=tmp_path)
    assert laminar.notes[0].code == "state_space_fitted"
    said = json.loads((tmp_path / "machine.json").read_text())
    assert 0.0 < said["largest_error"] == laminar.notes[0].data["error"] < 2e-3
    assert said["band"] == pytest.approx([0.01 * said["speed"], 10.0 * said["speed"]])
    upright = lb.example("two_plane_rig").replace({"gravity": 0.0})
    alone = lb.export(upright, to="statespace", out=tmp_path / "two")
    assert "state_space_of_chambers_alone" in [note.code for note in alone.notes]
    assert not any(name.startswith("machine") for name in alone.files)


# Co-simulation


def taken(
    run: Cosimulation, times: np.ndarray, speed: object = None, torque: float = 0.0
) -> dict[str, np.ndarray]:
    """Outputs at times from 0 on; `speed` is a function of the time at which a step ends."""
    rows = [run.outputs()]
    for begin, end in zip(times[:-1].tolist(), times[1:].tolist(), strict=True):
        run.step(end - begin, 0.0 if speed is None else speed(end), torque)
        rows.append(run.outputs())
    return {name: np.array([row[name] for row in rows]) for name in rows[0]}


def test_at_its_own_times_it_is_the_run_up() -> None:
    """Step by step the machine goes the same way, to the last digit."""
    history = lb.run_up(short(), check=False).history
    found = taken(Cosimulation(short(), stepped_model(short())), history.time)
    assert np.array_equal(found["speed"], history.speed)
    assert np.array_equal(found["x"] + 1j * found["y"], history.deflection[:, 0])
    assert np.array_equal(found["liquid_x"] + 1j * found["liquid_y"], history.offset @ history.layer_mass)


@kills(f"{HERE}cosimulation:Cosimulation.outputs", '"y": first.imag', '"y": -first.imag')
@kills("solvers.runup.runup:SteppedRunup.on", "else end, leg.rate", "else end, 0.5 * leg.rate")
@pytest.mark.parametrize("drive", [Drive.SCENE, Drive.SPEED])
def test_at_other_times_it_is_beside_the_run_up(drive: Drive) -> None:
    """Uneven steps, and a speed that is given: within 2 % of the run's largest."""
    history = lb.run_up(short(), check=False).history
    run = Cosimulation(short(), stepped_model(short()))
    run.begin(drive, float(history.speed[0]))
    end = float(history.time[-1])
    times = end * np.sort(np.concatenate([[0.0, 1.0], np.random.default_rng(1).random(97)]))
    found = taken(run, times, lambda time: float(np.interp(time, history.time, history.speed)))
    # A complex number between samples a fifth of a radian apart is known by amplitude and angle.
    size = np.interp(times, history.time, np.abs(history.deflection[:, 0]))
    angle = np.interp(times, history.time, np.unwrap(np.angle(history.deflection[:, 0])))
    assert np.abs(found["speed"] - np.interp(times, history.time, history.speed)).max() < 2e-2 * 33.0
    off = np.abs(found["x"] + 1j * found["y"] - size * np.exp(1j * angle))
    assert off.max() < 2e-2 * size.max()


@kills("solvers.runup.runup:SteppedRunup.under", "[torque, torque]", "[torque, 2.0 * torque]")
@kills("solvers.runup.runup:SteppedRunup.to", "max(speed, self.floor)", "self.floor")
def test_torque_and_speed_drive_it() -> None:
    """Without liquid and unbalance the spin gains torque over inertia; a speed is reached in a line."""
    bare = lb.example("weak_motor").replace({"chambers": [], "rotor.unbalance": 0.0})
    run = Cosimulation(bare, stepped_model(bare))
    run.begin(Drive.TORQUE, 0.0)
    first = run.start_speed
    torque = 0.5 * run.inertia
    found = taken(run, np.linspace(0.0, 3.0, 31), torque=torque)
    assert found["speed"][-1] == pytest.approx(first + 1.5, rel=1e-9)
    run.begin(Drive.SPEED, 20.0)
    found = taken(run, np.array([0.0, 0.1, 0.3]), lambda time: 20.0 + 10.0 * time)
    assert found["speed"] == pytest.approx([20.0, 21.0, 23.0], rel=1e-12)


def test_after_its_end_the_speed_is_held() -> None:
    run = Cosimulation(short(), stepped_model(short()))
    found = taken(run, np.array([0.0, run.duration, run.duration + 0.1]))
    assert found["speed"][1] == found["speed"][2] > found["speed"][0]


@kills("solvers.runup.runup:SteppedRunup._look", "2.0 * cubic[1] / width**2", "cubic[1] / width**2")
def test_forces_of_a_machine_with_bearings_and_feet() -> None:
    """At first the floor carries the weight; largest forces are those of the run-up's loads."""
    tub = lb.example("tub").replace({"runup.duration": 6.0, "runup.samples": 501, "runup.cells": 32})
    answer = lb.run_up(tub, check=False)
    assert answer.loads is not None
    found = taken(Cosimulation(tub, stepped_model(tub)), answer.history.time)
    assert found["floor_force"][0] == pytest.approx(answer.loads.rest.sum(), rel=1e-9)
    worst = answer.loads.worst
    # Of the moments of a turn it sees only those at the steps; both take the acceleration from a spline.
    assert found["bearing_force"].max() == pytest.approx(worst.bearing.max(), rel=2e-2)
    assert (found["floor_force"] < worst.floor_force.sum(axis=1) * 1.02).all()


def test_a_step_that_cannot_be_done_is_refused() -> None:
    run = Cosimulation(short(), stepped_model(short()))
    with pytest.raises(Refusal, match="0 s or longer"):
        run.step(-0.1, 0.0, 0.0)
    for drive, speed in ((3, 0.0), (Drive.SPEED, 0.0), (Drive.TORQUE, 0.0)):
        with pytest.raises(Refusal):  # the last one: this rotor has no inertia about its axis
            run.begin(drive, speed)
    run.begin(Drive.SPEED, 10.0)
    with pytest.raises(Refusal, match="speed_demand"):
        run.step(0.1, -1.0, 0.0)
    run.step(0.0, 10.0, 0.0)
    assert run.time == 0.0


@pytest.fixture(scope="module")
def fmu(tmp: Path) -> str:
    """The FMU of the short run-up."""
    pytest.importorskip("pythonfmu")
    pytest.importorskip("fmpy")
    return str(folder("fmu", tmp) / "Run-up.fmu")


def test_an_fmu_is_valid(fmu: str) -> None:
    """Its description has no fault, SI units and the machine among its resources."""
    from fmpy import read_model_description
    from fmpy.validation import validate_fmu

    assert validate_fmu(fmu) == []
    said = read_model_description(fmu)
    units = {one.name: one.unit for one in said.modelVariables if one.name != "drive"}
    assert units == {
        "motor_torque": "N.m",
        "speed_demand": "rad/s",
        "speed": "rad/s",
        "x": "m",
        "y": "m",
        "liquid_x": "kg.m",
        "liquid_y": "kg.m",
        "bearing_force": "N",
        "floor_force": "N",
    }
    with zipfile.ZipFile(fmu) as packed:
        assert "resources/machine.toml" in packed.namelist()


def test_another_tool_runs_it_beside_the_run_up(fmu: str) -> None:
    """Within 2 % of the largest, by itself and under the demand of a speed."""
    import fmpy

    history = lb.run_up(short(), check=False).history
    end, step = float(history.time[-1]), float(history.time[1])
    given = {"stop_time": end, "step_size": step, "output_interval": step}
    found = fmpy.simulate_fmu(fmu, **given)
    assert len(found) == history.time.size
    largest = np.abs(history.deflection).max()
    off = np.abs(found["x"] + 1j * found["y"] - history.deflection[:, 0])
    assert off.max() < 2e-2 * largest
    assert np.abs(found["speed"] - history.speed).max() < 2e-2 * history.speed.max()
    # fmpy sets what the input is at the beginning of a step: there it asks for the speed at its end.
    demand = np.array(
        list(zip(history.time, np.append(history.speed[1:], history.speed[-1]), strict=True)),
        dtype=[("time", float), ("speed_demand", float)],
    )
    start = {"drive": 1, "speed_demand": float(history.speed[0])}
    asked = fmpy.simulate_fmu(fmu, start_values=start, input=demand, **given)
    size = np.hypot(asked["x"], asked["y"])
    assert np.abs(size - np.abs(history.deflection[:, 0])).max() < 2e-2 * largest


def test_an_fmu_refuses_a_negative_step(fmu: str) -> None:
    import fmpy
    from fmpy.fmi1 import FMICallException
    from fmpy.simulation import instantiate_fmu

    place, said = fmpy.extract(fmu), fmpy.read_model_description(fmu)
    machine = instantiate_fmu(place, said, "CoSimulation")
    machine.setupExperiment(startTime=0.0)
    machine.enterInitializationMode()
    machine.exitInitializationMode()
    machine.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.01)
    with pytest.raises(FMICallException):
        machine.doStep(currentCommunicationPoint=0.01, communicationStepSize=-0.01)
    with pytest.raises(FMICallException):
        machine.doStep(currentCommunicationPoint=0.0, communicationStepSize=0.01)
    machine.terminate()
    machine.freeInstance()


def test_an_fmu_needs_a_run_up(tmp_path: Path) -> None:
    pytest.importorskip("pythonfmu")
    with pytest.raises(InputError) as refused:
        lb.export(lb.example("blood_pump"), to="fmu", out=tmp_path)
    assert refused.value.field in ("rotor.kind", "runup")


@pytest.mark.parametrize("to", ["csv", "xlsx"])
def test_samples_of_a_sweep_as_tables(to: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A row a sample with what varies first, a row for each sample and speed; the numbers of the store."""
    study = tmp_path / "study.toml"
    study.write_text(
        f'scene = "{example_path("runup")}"\nmethod = "grid"\n[vary]\n'
        '"rotor.mass" = { linspace = ["29 kg", "31 kg", 3] }\n',
        encoding="utf-8",
    )
    out = tmp_path / "out"
    assert main(["sweep", str(study), "--out", str(out), "--workers", "0", "--to", to]) == 0
    capsys.readouterr()
    data = xr.open_zarr(out / "sweep.zarr", consolidated=False)
    if to == "csv":
        columns = [table(out / f"{name}.csv") for name in ("samples", "curves")]
        samples, curves = (
            [dict(zip(one, row, strict=True)) for row in zip(*one.values(), strict=True)] for one in columns
        )
    else:
        pytest.importorskip("xlsxwriter")
        found = sheets(out / "sweep.xlsx")
        samples, curves = (
            [dict(zip(found[name][0], row, strict=False)) for row in found[name][1:]]
            for name in ("samples", "curves")
        )
    assert list(samples[0])[:2] == ["sample", "rotor.mass [kg]"]
    assert [float(row["rotor.mass [kg]"]) for row in samples] == [29.0, 30.0, 31.0]
    assert [float(row["last_amplitude [m]"]) for row in samples] == data["last_amplitude"].values.tolist()
    count = lb.example("runup").speeds.count
    assert len(curves) == 3 * count and [int(row["sample"]) for row in curves[count - 1 : count + 1]] == [
        0,
        1,
    ]
    sizes = np.array([float(row["amplitude [m]"]) for row in curves])
    np.testing.assert_array_equal(sizes, data["amplitude"].values.ravel())
    if to == "csv":
        assert main(["sweep", str(study), "--out", str(out), "--workers", "0", "--to", "ods"]) == 2
        assert "csv or xlsx" in capsys.readouterr().err
