"""`leblanc map`: volumes, bands, range of the model, files, figure, JSON."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import h5netcdf
import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg

import leblanc as lb
from fluid.friction.laws import Friction
from fluid.whirl import covering_speed
from leblanc.cli import main
from leblanc.core.netcdf import write_netcdf
from leblanc.core.question import parameters
from leblanc.liquid.choose import prepare
from leblanc.scene.scene import Scene, dry_rotor, load_scene
from leblanc.studies import map as questions
from leblanc.studies.map.answer import WhirlMap
from leblanc.studies.map.figure import map_figure, signed_distance
from leblanc.studies.map.study import MapCode, fills_over_volume
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import asynchronous_growth, growth_map
from tests.mutants import kills

EXAMPLES = Path(__file__).parents[3] / "examples"
RPM = 60.0 / (2.0 * math.pi)
STUDY = "leblanc.studies.map.study"


def scene(name: str = "washing_machine") -> Scene:
    return load_scene(EXAMPLES / f"{name}.toml")


def small(name: str = "washing_machine", **changes: object) -> WhirlMap:
    return lb.map_whirl(scene(name), **({"volumes": 9, "speeds": 40} | changes))  # type: ignore[arg-type]


@kills(
    f"{STUDY}:fills_over_volume",
    "share = parts / parts.sum()",
    "share = parts / parts.max()",
)
@kills(f"{STUDY}:fills_over_volume", "np.min(capacity[wet]", "np.max(capacity[wet]")
def test_fills() -> None:
    """The volumes keep their ratios, add up, and end where the first chamber is full."""
    for name in ("horizontal_rig", "vertical_rig"):
        chambers = scene(name).fills
        rows = fills_over_volume(chambers, 5)
        totals = [sum(fill.volume for fill in fills) for fills in rows]
        assert totals[0] == 0.0
        np.testing.assert_allclose(np.diff(totals), totals[-1] / 4.0, rtol=1e-12)
        for fills in rows[1:]:
            ratio = [fill.volume / one.volume for fill, one in zip(fills, chambers, strict=True)]
            np.testing.assert_allclose(ratio, ratio[0], rtol=1e-12)
        fullest = max(fill.volume / fill.chamber.capacity for fill in rows[-1])
        assert fullest == pytest.approx(1.0, rel=1e-12)
        assert sum(fill.volume for fill in fills_over_volume(chambers, 3, 1e-5)[-1]) == pytest.approx(1e-5)
    empty = tuple(replace(fill, volume=0.0) for fill in scene("horizontal_rig").fills)
    for fill in fills_over_volume(empty, 2)[-1]:
        assert fill.volume == pytest.approx(fill.chamber.capacity)


def test_record() -> None:
    """Each point is the growth of the scene's machine with those volumes; each band separates signs."""
    for name, law, pair in (
        ("horizontal_rig", Friction("stokes", 0.0), Friction("stokes")),
        ("washing_machine", Friction("linear", 2.0), Friction("linear", 2.0)),
        ("washing_machine", Friction("quadratic", 0.1), Friction()),
    ):
        record, machine = small(name, friction=law), scene(name)
        rotor = dry_rotor(machine)
        rows = fills_over_volume(machine.fills, 9)
        np.testing.assert_allclose(record.volume, [sum(f.volume for f in fills) for fills in rows])
        for k in (0, 3, 8):
            growth, whirl = asynchronous_growth(rotor, rows[k], record.speed, pair)
            np.testing.assert_array_equal(record.growth[k], growth)
            np.testing.assert_array_equal(record.whirl_speed[k], whirl)
        assert np.array_equal(record.growth > 0.0, signed_distance(record) > 0.0)


@kills(f"{STUDY}:_held", "speed > max(needed", "speed > 2.0 * max(needed")
def test_range() -> None:
    """Held by the centrifugal field: level from the centrifuging speed, vertical from covering."""
    record, machine = small(friction=Friction("none", 0.0)), scene()
    for k, fills in enumerate(fills_over_volume(machine.fills, 9)):
        free = 0 < k < 8
        captured = math.sqrt(9.81 / fills[0].surface_radius) if free else 0.0
        assert np.array_equal(record.in_range[k], record.speed > captured)
    record, machine = small("vertical_rig", friction=Friction("none", 0.0)), scene("vertical_rig")
    for k, fills in enumerate(fills_over_volume(machine.fills, 9)):
        covered = max(covering_speed(fill, 9.81) for fill in fills)
        assert np.array_equal(record.in_range[k], record.speed > covered)


@kills(f"{STUDY}:map_scene", "zip(rows, whirl_speed - speed", "zip(rows, whirl_speed")
@kills(f"{STUDY}:_thin_layers", "2.0 * fill.liquid.viscosity", "fill.liquid.viscosity")
def test_thin_layers() -> None:
    """With laminar friction a film thinner than five thicknesses of the wall layer is out of range."""
    record, machine = small(), scene()
    held = small(friction=Friction("none", 0.0)).in_range
    for k, fills in enumerate(fills_over_volume(machine.fills, 9)[1:8], start=1):
        slip = np.abs(record.whirl_speed[k] - record.speed)
        thick = np.sqrt(2.0 * fills[0].liquid.viscosity / slip) > 0.2 * fills[0].depth
        assert np.array_equal(record.in_range[k], held[k] & ~thick)
    assert not record.in_range[1:8].all() and record.in_range.any()


def test_notes_say_which_dampings_there_are() -> None:
    record = small(friction=Friction("quadratic", 0.1))
    assert any(note.code is MapCode.QUADRATIC for note in record.notes)
    assert any(note.code is MapCode.WITHOUT_FRICTION for note in record.notes)
    assert record.friction.startswith("none (") and "0.187" in record.damping
    record = small()
    assert "laminar" in record.friction
    assert not any(note.code is MapCode.WITHOUT_FRICTION for note in record.notes)
    assert "140.1" in str(record.notes[0]) and len(record.scene_edges) == 1


def test_other_rotors() -> None:
    """The tub with its six degrees of freedom: bands separate signs there too."""
    record = lb.map_whirl(scene("tub"), volumes=3, speeds=12, friction=Friction("linear", 0.5))
    assert np.isfinite(record.growth).all()
    assert np.array_equal(record.growth > 0.0, signed_distance(record) > 0.0)
    assert record.damping == "damping as in the scene"


def test_file(tmp_path: Path) -> None:
    record = small("horizontal_rig")
    write_netcdf(record.named_arrays(), tmp_path / "map.nc")
    with h5netcdf.File(tmp_path / "map.nc", "r") as file:
        np.testing.assert_array_equal(file["growth"][...], record.growth)
        np.testing.assert_array_equal(file["in_range"][...], record.in_range)
        assert file["growth"].dimensions == ("volume", "speed")
        low, high = file["edge_low"][...], file["edge_high"][...]
        for k, bands in enumerate(record.edges):
            found = [(a, b) for a, b in zip(low[k], high[k], strict=True) if not np.isnan(a)]
            assert found == list(bands)
        assert file.attrs["friction"] == record.friction
        assert file["growth"].attrs["units"] == "s-1" and file["volume"].attrs["units"] == "m3"


def test_json_and_files(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    options = ["--volumes", "5", "--speeds", "30", "--max-volume", "900 ml", "--friction", "linear:0.5"]
    command = ["map", str(EXAMPLES / "washing_machine.toml"), *options, "--out", str(tmp_path), "--json"]
    assert main(command) == 0
    found = json.loads(capsys.readouterr().out)
    assert len(found["speed"]) == 30 and found["volume"] == pytest.approx(np.linspace(0.0, 9e-4, 5).tolist())
    for name in ("growth", "whirl_speed", "in_range"):
        assert np.shape(found[name]) == (5, 30)
    assert len(found["edges"]) == 5 and all(len(band) == 2 for row in found["edges"] for band in row)
    assert found["friction"] == "linear, 0.5 1/s"
    files = {"map.nc", "map.svg", "map.html", "contents.json"}
    assert {file.name for file in tmp_path.iterdir()} == files


def test_words(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["map", str(EXAMPLES / "washing_machine.toml"), "--volumes", "3", "--speeds", "10"]
    assert main([*command, "--out", str(tmp_path)]) == 0
    printed = capsys.readouterr()
    assert "laminar" in printed.out and "Self-excited whirl at" in printed.out
    assert "3 volumes by 10 speeds" in printed.err


@pytest.mark.parametrize("lost", [1, 3])
@kills("leblanc.studies.map.answer:WhirlMap.not_known", "np.isnan(self.growth)", "np.isinf(self.growth)")
@kills(
    f"{STUDY}:map_scene",
    "bands_not_known(speed, found)",
    "bands_not_known(speed, 0 * speed)",
)
def test_points_not_known(
    lost: int, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A point in a hundred is marked and the map stands; with more the command says so by its exit code."""

    done = 0

    def losing(*given: object) -> tuple[np.ndarray, np.ndarray]:
        nonlocal done
        growth, whirl = growth_map(*given)  # type: ignore[arg-type]
        # The third volume, in whatever block it comes.
        growth[np.arange(done, done + len(growth)) == 2, 5 : 5 + lost] = np.nan
        done += len(growth)
        return growth, whirl

    monkeypatch.setattr(f"{STUDY}.growth_map", losing)
    command = ["map", str(EXAMPLES / "washing_machine.toml"), "--volumes", "10", "--speeds", "20"]
    code = main([*command, "--out", str(tmp_path), "--json"])
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert [column for column in range(20) if found["growth"][2][column] is None] == list(range(5, 5 + lost))
    assert found["not_known"] == lost
    assert found["edges_not_known"][2] == [[found["speed"][4], found["speed"][5 + lost]]]
    assert not any(found["edges_not_known"][:2] + found["edges_not_known"][3:])
    assert f"At {lost} of 200 points" in " ".join(found["notes"])
    assert code == (0 if lost <= 2 else 3)
    assert code == 0 or "growth not known at 3 of 200 points" in said.err
    assert "growth not known" in (tmp_path / "map.svg").read_text()
    # No band that grows reaches into what is not known.
    for low, high in found["edges"][2]:
        assert high <= found["speed"][4] or low >= found["speed"][5 + lost]


@pytest.mark.parametrize(
    "options",
    [
        ["--volumes", "1"],
        ["--speeds", "5000"],
        ["--max-volume", "9 l"],
        ["--max-volume", "0"],
        ["--friction", "x"],
    ],
)
def test_wrong_options_are_named(
    options: list[str], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["map", str(EXAMPLES / "washing_machine.toml"), *options, "--out", str(tmp_path)]
    assert main(command) == 2
    assert capsys.readouterr().err.startswith(f"leblanc: {options[0]} = ")


def test_the_help_has_the_defaults_of_both_calls() -> None:
    told = {one.name: one.text for one in parameters(questions.map)}
    for call in (lb.map_whirl, lb.map_balls):
        given = {one.name: one.default for one in parameters(call) if isinstance(one.default, int | str)}
        del given["cycles" if call is lb.map_whirl else "state"]
        assert all(f" {value}]" in told[name] or f" {value};" in told[name] for name, value in given.items())


def test_a_range_of_one_speed_is_refused() -> None:
    machine = scene()
    still = machine.altered(speeds=machine.speeds.altered(stop=machine.speeds.start, count=1))
    with pytest.raises(InputError, match=r"speeds\.stop"):
        lb.map_whirl(still)


def test_outline() -> None:
    """The outline runs through the refined edges: the contour of the signed distance at zero does."""
    record = small(volumes=21, speeds=200)
    lines = [path.vertices for drawn in map_figure(record).axes[0].collections for path in drawn.get_paths()]
    step, checked = record.speed[1] - record.speed[0], 0
    for row, bands in enumerate(record.edges):
        for edge in [end for low, high in bands for end in (low, high) if high - low > 4.0 * step]:
            place = np.array([edge * RPM, record.volume[row] * 1e6])
            # Vertices on the row of this volume; a contour keeps the digits of its line between two speeds.
            near = min(np.min(np.hypot(*((line - place) / [1.0, 1e-3]).T)) for line in lines if line.size)
            assert near < 1e-6 * place[0]
            checked += 1
    assert checked > 20


@pytest.mark.parametrize("law", [Friction("stokes", 0.0), Friction("none", 0.0), Friction("linear", 500.0)])
def test_figure_has_units_on_every_axis(law: Friction) -> None:
    record = small(friction=law)
    figure = map_figure(record)
    FigureCanvasAgg(figure).draw()
    panels = [axes for axes in figure.axes if axes.get_label() in ("growth", "whirl")]
    assert [axes.get_ylabel() for axes in panels] == ["Liquid (ml)"] * 2
    assert [axes.get_xlabel() for axes in panels] == ["Speed (rpm)"] * 2
    for axes in panels:
        np.testing.assert_allclose(axes.get_xlim(), record.speed[[0, -1]] * RPM)
        above, beside = axes.child_axes
        assert above.get_xlabel() == "Speed/critical speed without liquid (\N{EN DASH})"
        np.testing.assert_allclose(above.get_xlim(), record.speed[[0, -1]] / record.critical_speed_dry)
        assert beside.get_ylabel() == "Fill (% of the chambers)"
        np.testing.assert_allclose(beside.get_ylim()[1], 100.0 * record.volume[-1] / record.capacity)
    for bar in (axes for axes in figure.axes if axes not in panels):
        assert bar.get_ylabel().endswith((")", ")"))
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "scene's volume, 600 ml" in legend
    assert ("a whirl grows: unstable" in legend) == bool((record.growth > 0.0).any())


def test_ratios_are_those_of_the_machine() -> None:
    """Full chambers are filled to the whole; the critical speed is that of `run`."""
    record, machine = small(), scene()
    assert record.volume[-1] == pytest.approx(record.capacity, rel=1e-12)
    assert record.critical_speed_dry == run_scene(machine).critical_speed_dry
    tilting = lb.example("tub").replace({"speeds.count": 9})
    found = lb.map_whirl(tilting, volumes=2, speeds=3)
    assert found.critical_speed_dry == pytest.approx(run_scene(tilting).critical_speed_dry, rel=1e-12)


def test_growth_has_one_scale_with_one_zero() -> None:
    """One bar from decay to growth, of equal steps; zero stands on it once, in the middle, without colour."""
    record = small(volumes=21, speeds=80)
    assert (record.growth > 0.0).any() and (record.growth < 0.0).any()
    figure = map_figure(record)
    FigureCanvasAgg(figure).draw()
    (bar,) = (axes for axes in figure.axes if "Growth" in axes.get_ylabel())
    ticks = [text.get_text() for text in bar.get_yticklabels() if text.get_text()]
    assert ticks.count("0") == 1
    (mesh,) = (drawn for drawn in figure.axes[0].collections if hasattr(drawn, "get_coordinates"))
    low, high = mesh.get_clim()
    assert low == -high and high >= np.nanmax(record.growth)
    red, green, blue, _ = mesh.cmap(mesh.norm(0.0))
    assert max(red, green, blue) - min(red, green, blue) < 0.05 and min(red, green, blue) > 0.9


def test_the_hatch_leaves_the_colours() -> None:
    """Thin, sparse and translucent, in the legend as in the map."""
    figure = map_figure(small(volumes=21, speeds=80))
    hatched = []
    for drawn in figure.axes[0].collections:
        hatches = [mark for mark in getattr(drawn, "hatches", []) if mark]
        if hatches:
            hatched.append(drawn)
            assert all(len(mark) <= 2 for mark in hatches)
            assert np.all(drawn.get_edgecolor()[:, 3] <= 0.5)
    assert hatched
    for key in figure.legends[0].get_patches():
        assert key.get_edgecolor()[3] <= 0.5


@pytest.mark.slow  # the same verdicts are compared by `make net`
def test_validation_agrees() -> None:
    from validation.cases.rotors.whirl import cases

    found = cases()
    assert len(found) == 22 and {one.verdict for one in found} == {"agrees"}


@kills(
    "leblanc.studies.map.study:_rows",
    "prepare(varied.at(scene, value), free=True)",
    "prepare(scene, free=True)",
)
@kills(
    "leblanc.studies.map.study:_rows", "other.waves if friction is None", "machine.waves if friction is None"
)
def test_over_any_number() -> None:
    """Each row is the machine with that number: of the rotor, of the liquid, of its friction."""
    machine = scene()
    viscosity = [f"chambers.{k}.liquid.viscosity" for k in range(len(machine.fills))]
    own = machine.replace(
        {f"chambers.{k}.liquid": {"density": 1200.0, "viscosity": 1.6e-6} for k in range(len(machine.fills))}
    )
    rubbing = machine.replace({"model.friction": {"linear": 2.0}})
    for start, over in ((machine, "rotor.damping"), (own, viscosity), (rubbing, "model.friction.linear")):
        found = lb.map_whirl(start, over=over, values=3, speeds=12)
        paths = [over] if isinstance(over, str) else over
        assert found.paths == tuple(paths) and found.value is not None and found.value.shape == (3,)
        for value, growth, edges in zip(found.value.tolist(), found.growth, found.edges, strict=True):
            changed = prepare(start.replace(dict.fromkeys(paths, value)), free=True)
            fills = changed.scene.fills
            alone, _ = asynchronous_growth(changed.rotor, fills, found.speed, changed.waves)
            np.testing.assert_allclose(growth, alone, rtol=1e-9, atol=1e-12)
            (bands,) = unstable_bands(changed.rotor, [fills], found.speed, changed.waves)
            np.testing.assert_allclose(edges, bands, rtol=1e-6)
        assert np.ptp(found.growth[:, 3]) > 0.0
        np.testing.assert_allclose(found.value[1], found.scene_value)


def test_over_any_number_in_files(tmp_path: Path) -> None:
    """The data have the number as their axis, and are opened again; the figure names it."""
    found = lb.map_whirl(
        scene(), over="rotor.damping", start="100 N*s/m", stop="600 N*s/m", values=4, speeds=9
    )
    data = found.to_dataset()
    assert data.growth.dims == ("value", "speed") and data.value.attrs["units"] == "N*s/m"
    np.testing.assert_allclose(data.value, np.linspace(100.0, 600.0, 4))
    found.save(tmp_path / "map.nc")
    again = lb.open(tmp_path / "map.nc")
    np.testing.assert_array_equal(again.growth, found.growth)
    panel = map_figure(found).axes[0]
    assert panel.get_ylabel() == "damping (N*s/m)" and panel.get_yscale() == "linear"
    assert found.to_json()["paths"] == ["rotor.damping"]
    assert not {"paths", "value", "scene_value"} & set(small().to_json())


@pytest.mark.parametrize(
    ("options", "field"),
    [
        ({"over": "rotor.axis"}, "over"),
        ({"over": "speeds.start"}, "over"),
        ({"over": "rotor.damping", "volumes": 5}, "volumes"),
        ({"over": "rotor.damping", "max_volume": 1e-4}, "max_volume"),
        ({"values": 5}, "values"),
        ({"start": 1.0}, "start"),
        ({"over": "rotor.damping", "start": 0.0, "log": True}, "start"),
    ],
)
def test_over_refuses(options: dict[str, object], field: str) -> None:
    """Paths that lead to no number, volumes beside another axis, values without one."""
    with pytest.raises(InputError) as caught:
        lb.map_whirl(scene(), speeds=5, **options)  # type: ignore[arg-type]
    assert caught.value.field == field


@kills("leblanc.studies.map.study:_alike", "np.array_equal(own.mass, last.mass)", "True")
@kills("leblanc.studies.map.study:_damping", "!= rotor.damping_ratio", "is None")
def test_what_varies_is_not_told_as_one_number() -> None:
    """A critical speed or a damping ratio that varies along the axis is no scale and no caption."""
    one = lb.map_whirl(scene(), over="rotor.damping", values=3, speeds=5)
    assert one.critical_speed_dry > 0.0 and one.damping == "damping as it varies"
    assert math.isnan(lb.map_whirl(scene(), over="rotor.mass", values=3, speeds=5).critical_speed_dry)
    assert math.isnan(lb.map_whirl(scene(), over="rotor.stiffness", values=3, speeds=5).critical_speed_dry)
    assert small().critical_speed_dry > 0.0
