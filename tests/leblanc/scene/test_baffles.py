"""A scene whose chamber has baffles: its keys, its models, what is refused."""

from __future__ import annotations

import json
import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from fluid.fill import Fills
from leblanc.core.notes import percent
from leblanc.core.progress import told
from leblanc.liquid.choose import choose
from leblanc.liquid.notes import BaffleCode
from leblanc.scene.scene import Scene, jeffcott, load_scene, scene_from_table
from leblanc.scene.schema.load import SceneError, read_toml
from leblanc.studies.explain.study import explain_scene
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.study import run_scene
from leblanc.studies.runup.study import runup_scene
from leblanc.studies.sweep.batch import answer_scenes
from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.files.exchange import write_section
from meshes.section import Section, disc
from solvers.sloshing.model import SmallWaves
from tests.leblanc.studies.test_modes import circle_drawing
from tests.mutants import kills

EXAMPLES = Path(__file__).parents[3] / "examples"
BASE: dict[str, Any] = {
    "name": "Baffled",
    "rotor": {
        "kind": "jeffcott",
        "mass": 4.0,
        "critical_speed": 100.0,
        "damping_ratio": 0.1,
        "unbalance": 6e-5,
        "axis": "vertical",
    },
    "speeds": {"start": 60.0, "stop": 200.0, "count": 5},
}
CHAMBER = {"radius": 0.1, "height": 0.02, "volume": 1.2e-4, "liquid": "water"}
LOW, CUT = {"count": 3, "tip_radius": "97 mm", "first_angle": "10 deg"}, {"count": 4}


def scene(baffles: dict[str, Any] | None = None, **more: Any) -> Scene:
    chamber = CHAMBER if baffles is None else CHAMBER | {"baffles": baffles}
    return scene_from_table(BASE | {"chambers": [chamber]} | more)


@cache
def answered(kind: str) -> RunAnswer:
    """Of a chamber that is clear, with baffles that liquid can pass, or cut into compartments."""
    return run_scene(scene({"clear": None, "low": LOW, "cut": CUT}[kind]))


ONE = {"speeds": {"start": 100.0, "stop": 100.0, "count": 1}}


def test_the_keys_of_baffles_reach_the_chamber() -> None:
    assert scene(LOW).fills[0].chamber.baffles == Baffles(3, 0.097, 0.0, math.radians(10.0))
    assert scene().fills[0].chamber.baffles is None
    assert scene().digest != scene(LOW).digest != scene(CUT).digest


@pytest.mark.parametrize(
    ("baffles", "told"),
    [
        ({"count": 0}, "chambers.0.baffles.count = 0: must be a whole number from 1 to 360"),
        ({"tip_radius": 0.05}, "chambers.0.baffles.count: must be given: a whole number from 1 to 360"),
        (
            {"count": 3, "depth": 1},
            "left out or spelled as one of: count, tip_radius, height, wall_gap, first_angle",
        ),
        ({"count": 3, "tip_radius": 0.1}, "must be a tip_radius below radius - wall_gap, 0.1 m"),
        ({"count": 3, "tip_radius": "9 kg"}, "chambers.0.baffles.tip_radius = '9 kg': must be a length"),
    ],
)
def test_wrong_baffles_are_named(baffles: dict[str, Any], told: str) -> None:
    with pytest.raises(SceneError, match=r".") as caught:
        scene(baffles)
    assert told in str(caught.value).replace('"9 kg"', "'9 kg'")


@kills("leblanc.liquid.notes:slowed_by", "max(counts)", "len(counts)")
def test_what_takes_long_is_told_while_it_does() -> None:
    """Waves among baffles are by finite elements: a command says so; of a clear ring nothing is slow."""
    for baffles, said in ((LOW, True), (None, False)):
        heard: list[str] = []
        with told(lambda _, __, what, heard=heard: heard.append(what or "")):  # type: ignore[misc]
            run_scene(scene(baffles))
        assert ("self-excited whirl: 3 baffles by finite elements" in heard) == said
        assert any(what.startswith("self-excited whirl") for what in heard)


def test_baffles_that_the_liquid_can_pass_change_no_steady_answer() -> None:
    clear, low = answered("clear"), answered("low")
    np.testing.assert_array_equal(low.response.deflection, clear.response.deflection)
    assert clear.whirl is not None
    assert low.whirl is not None
    assert np.abs(low.whirl.growth - clear.whirl.growth).max() > 1e-6
    assert ("Chamber 1: tips at", "97 mm", "chambers.0.baffles.tip_radius") in low.inputs


def test_compartments_add_less_mass() -> None:
    record = answered("cut")
    fill, rotor = record.response, jeffcott(scene(CUT))
    # The closed form, of which the elements come within 2e-6 [theory: sections, eq. 8].
    added = scene(CUT).fills[0].added_mass
    assert added == pytest.approx(SmallWaves().added_mass(Fills.of(scene(CUT).fills))[0], rel=2e-6)
    speed = fill.speed
    # The law is a straight line: the response of a heavier rotor [theory: rotor, eq. 2].
    stiffness = rotor.stiffness - (rotor.mass + added) * speed**2 + 1j * rotor.damping * speed
    np.testing.assert_allclose(fill.deflection, rotor.unbalance * speed**2 / stiffness, rtol=1e-12)
    assert set(fill.model) == {"linear"}
    assert record.error_estimate is not None
    assert np.isnan(record.error_estimate).all()
    assert not np.isfinite(record.error_estimate).any()
    assert added < 0.5 * scene(CUT).fills[0].full_mass


@kills("leblanc.liquid.notes:closed_compartments", "fill.added_mass / fill.full_mass", "0.5")
@kills("leblanc.liquid.notes:closed_compartments", "fill.compartments < 2", "fill.compartments > 2")
def test_compartments_that_hardly_balance_are_told() -> None:
    """One sentence in `run` and `explain` for equal chambers; none where the liquid passes.

    The balancing mass is pi h R^2 for a layer that leaves the wall wet, less the surface a^2 whose shift each
    sector of four takes back: the integral of cos^2 of its mean over the circle.
    """
    sectors = np.arange(4)[:, None] * (math.pi / 2.0)
    angle = sectors + (np.arange(1000) + 0.5) * (math.pi / 2000.0)
    surface = 0.01 - CHAMBER["volume"] / (math.pi * CHAMBER["height"])  # its radius squared
    left = 1.0 - surface / 0.01 * 2.0 * float(np.mean(np.cos(angle).mean(axis=1) ** 2))
    chamber = CHAMBER | {"baffles": {"count": 4, "tip_radius": 0.05}}
    own = scene_from_table(BASE | {"chambers": [chamber, chamber]} | ONE)
    found = [note for note in run_scene(own).notes if note.code == BaffleCode.CLOSED_COMPARTMENTS]
    assert len(found) == 1
    note = found[0]
    assert note.text.startswith("Chambers 1 and 2: baffles of 50 mm are higher than the layer of 10.05 mm")
    assert "close 4 compartments: the liquid cannot gather on one side" in note.text
    assert f"its balancing mass is {percent(left)} of that in a clear ring" in note.text
    assert all(note.text[18:100] in layer.walls for layer in explain_scene(own).layers)
    passes = chamber | {"baffles": {"count": 4, "tip_radius": 0.095}}
    low = scene_from_table(BASE | {"chambers": [passes]} | ONE)
    assert not [note for note in run_scene(low).notes if note.code == BaffleCode.CLOSED_COMPARTMENTS]


@kills("leblanc.scene.chambers:_held", "volume < _FILM * drum", "volume < 0.0")
def test_a_film_thinner_than_molecules_is_no_liquid() -> None:
    """Beside baffles, where elements mesh every layer: as an empty chamber; a film with a mesh answers."""
    own = BASE | {"speeds": {"start": 60.0, "stop": 60.0, "count": 1}}
    wet, drum = CHAMBER | {"baffles": CUT}, math.pi * 0.01 * 0.02

    def amplitude(volume: float) -> np.ndarray:
        return run_scene(scene_from_table(own | {"chambers": [wet, CHAMBER | {"volume": volume}]})).amplitude

    empty = amplitude(0.0)
    for share in (1e-15, 3.9e-8):
        np.testing.assert_array_equal(amplitude(share * drum), empty)
    thin = amplitude(4.1e-8 * drum)
    assert np.isfinite(thin).all() and not np.array_equal(thin, empty)


def test_many_scenes_at_once_are_those_alone() -> None:
    several = [scene(), scene(LOW), scene(CUT)]
    answers = answer_scenes(several)
    for k, record in enumerate(map(answered, ("clear", "low", "cut"))):
        np.testing.assert_allclose(answers.amplitude[k], record.amplitude, rtol=1e-12)
        assert record.whirl is not None
        np.testing.assert_allclose(answers.growth[k], record.whirl.growth, atol=1e-9)
        assert answers.model[k].tolist() == record.response.model.tolist()


def test_the_map_runs_from_empty_to_full() -> None:
    record = lb.map_whirl(scene(LOW), volumes=3, speeds=3)
    assert np.isfinite(record.growth).all()
    # Empty and full there is nothing that could slosh.
    assert np.all(record.growth[[0, -1]] <= 0.0)


def test_models_that_know_no_compartments_are_refused() -> None:
    with pytest.raises(InputError, match=r"auto, linear or fem .* \(or long_wave\)"):
        run_scene(scene(CUT, model={"liquid": "statics"}))
    with pytest.raises(InputError, match="two directions"):
        run_scene(scene({"count": 2}))
    # One plate lets the liquid round the other way.
    assert set(run_scene(scene({"count": 1})).response.model) <= {"linear", "statics"}


def test_compartments_are_held_in_time_where_long_waves_are_asked_for() -> None:
    """From the motion of the elements, and to it: the deflection is a thousandth of the depth."""
    speeds = {"start": 60.0, "stop": 120.0, "count": 2}
    model = {"liquid": "long_wave", "cells": 64, "friction": {"linear": 5.0}}
    held = run_scene(scene(CUT, speeds=speeds, model=model))
    elements = run_scene(scene(CUT, speeds=speeds))
    assert set(held.response.model) == {"long_wave"} and held.held is not None
    assert np.isnan(held.error_estimate).all()
    # The mesh of 64 cells errs by some 1e-3, and upright the elements leave gravity out of the waves.
    np.testing.assert_allclose(held.amplitude, elements.amplitude, rtol=5e-3)
    assert choose(scene(CUT, model=model)).models.tolist() == ["linear"] * 5


def test_fem_of_a_clear_chamber_runs_the_elements() -> None:
    """Near linear theory, as near as its own estimate says, but not the same numbers under another name."""
    ends = BASE["speeds"] | {"count": 2}
    fem, linear = (run_scene(scene(model={"liquid": name}, speeds=ends)) for name in ("fem", "linear"))
    apart = np.abs(fem.deflection / linear.deflection - 1.0)
    assert apart.min() > 0.0 and apart.max() < 1e-6
    assert fem.error_estimate is not None and linear.error_estimate is not None
    # Its own estimate is its distance from the exact equilibrium, of amplitude and liquid the larger one.
    own = fem.error_estimate - linear.error_estimate
    assert np.all(own >= apart - 1e-12) and own.max() < 1e-6
    assert set(fem.response.model) == {"fem"}


def test_a_tilting_rotor_takes_baffles_as_well() -> None:
    table = read_toml(EXAMPLES / "two_plane_rig.toml")
    table["chambers"][0]["baffles"] = {"count": 3, "tip_radius": "1 mm"}
    table["speeds"]["count"] = 2
    record = run_scene(scene_from_table(table))
    assert set(record.response.model) == {"linear"}
    assert record.whirl is not None
    assert np.isfinite(record.whirl.growth).all()


def test_a_scene_without_baffles_keeps_its_digest() -> None:
    # The kept comparison was made before chambers could have baffles.
    kept = json.loads(
        (EXAMPLES.parent / "validation" / "trade" / "horizontal_rig.json").read_text(encoding="utf-8")
    )
    assert load_scene(EXAMPLES / "horizontal_rig.toml").digest == kept["digest"]


def lobes(folder: Path) -> Path:
    """Mesh file of a section whose wall waves round it six times, in millimetres."""
    base = disc(100.0, 48, order=2)
    angle, away = np.arctan2(base.points[:, 1], base.points[:, 0]), np.hypot(*base.points.T) / 100.0
    stretch = 1.0 + 0.02 * np.cos(6.0 * angle) * away**4
    file = folder / "lobes.msh"
    write_section(Section(base.points * stretch[:, None], base.triangles), file)
    return file


def drawn(folder: Path, **more: Any) -> dict[str, Any]:
    chamber = {"section": str(lobes(folder)), "section_unit": "1 mm", "height": 0.02, "volume": 1.2e-4}
    return BASE | {"chambers": [chamber | {"liquid": "water"} | more]}


def test_a_section_from_a_file(tmp_path: Path) -> None:
    machine = scene_from_table(drawn(tmp_path))
    record, fill = run_scene(machine), machine.fills[0]
    assert fill.chamber.radius == pytest.approx(0.102, rel=1e-9)
    assert ("Chamber 1: section", "lobes.msh", "chambers.0.section") in record.inputs
    assert ("Chamber 1: farthest wall", "102 mm", "chambers.0.section_unit") in record.inputs
    rotor, speed = jeffcott(machine), record.response.speed
    added = fill.added_mass
    assert added == pytest.approx(SmallWaves().added_mass(Fills.of([fill]))[0], rel=1e-5)
    stiffness = rotor.stiffness - (rotor.mass + added) * speed**2 + 1j * rotor.damping * speed
    np.testing.assert_allclose(record.response.deflection, rotor.unbalance * speed**2 / stiffness, rtol=1e-12)
    assert set(record.response.model) == {"linear"}


def test_a_scene_file_finds_the_section_beside_it(tmp_path: Path) -> None:
    lobes(tmp_path)
    text = """
name = "Lobes"
speeds = { start = 60, stop = 200, count = 3 }
[rotor]
kind = "jeffcott"
mass = 4
critical_speed = 100
damping_ratio = 0.1
unbalance = 1e-5
axis = "vertical"
[[chambers]]
section = "lobes.msh"
section_unit = "1 mm"
height = "20 mm"
volume = "120 ml"
liquid = "water"
"""
    (tmp_path / "scene.toml").write_text(text, encoding="utf-8")
    one = load_scene(tmp_path / "scene.toml")
    assert one.digest == load_scene(tmp_path / "scene.toml").digest
    assert one.fills[0].chamber.section is not None


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"section": "none.msh"}, "chambers.0.section"),
        ({"section": 3}, "must be the path of a mesh file of the section"),
        ({"section_size": "2 mm"}, "section_size left out for a mesh file, which has its cells"),
        (
            {"section": "none.dxf"},
            "must be the path of a mesh file of the section, .msh, .vtu or .xdmf, or of",
        ),
        ({"radius": 0.1}, "chambers.0.radius = 0.1: must be left out where section is given"),
        ({"baffles": {"count": 3}}, "chambers.0.baffles"),
        ({"volume": 1.0}, "chambers.0.volume = 1.0: must be at most what the chamber holds"),
    ],
)
def test_wrong_sections_are_named(tmp_path: Path, change: dict[str, Any], told: str) -> None:
    with pytest.raises(SceneError, match=r".") as caught:
        scene_from_table(drawn(tmp_path, **change))
    assert told in str(caught.value)


def test_a_section_from_a_drawing(tmp_path: Path) -> None:
    circle_drawing(tmp_path / "circle.dxf")
    chamber = {"section": str(tmp_path / "circle.dxf"), "height": 0.02, "volume": 2e-4, "liquid": "water"}
    machine = scene_from_table(BASE | ONE | {"chambers": [chamber]})
    shape = machine.fills[0].chamber.section
    assert shape is not None and shape.cell_size == pytest.approx(3e-3, rel=1e-3)
    # Parabolas of 3 mm on a circle of 150 mm.
    assert shape.farthest == pytest.approx(0.15, rel=1e-6)
    finer = scene_from_table(
        BASE | {"chambers": [chamber | {"section_size": "2 mm", "section_unit": "2 mm"}]}
    )
    other = finer.fills[0].chamber.section
    assert other is not None and other.cell_size == 2e-3 and other.farthest == pytest.approx(0.3, rel=1e-6)
    assert set(run_scene(machine).response.model) == {"linear"}


def test_a_chamber_has_a_wall() -> None:
    with pytest.raises(SceneError, match=r"chambers\.0\.radius: must be given: .* or section"):
        scene_from_table(BASE | {"chambers": [{"height": 0.02, "volume": 1e-5, "liquid": "water"}]})


def test_a_section_off_the_axis_is_refused(tmp_path: Path) -> None:
    base = disc(0.1, 32, order=2)
    write_section(Section(base.points + np.array([0.005, 0.0]), base.triangles), tmp_path / "off.msh")
    table = drawn(tmp_path, section=str(tmp_path / "off.msh"), section_unit=1.0, volume=2e-4)
    with pytest.raises(InputError, match="balanced about the axis"):
        run_scene(scene_from_table(table))


@pytest.mark.parametrize(
    ("liquid", "cells", "why"), [("linear", 64, "linear layer"), ("auto", 8, "fewer than four")]
)
def test_a_run_up_tells_that_baffles_are_smeared(liquid: str, cells: int, why: str) -> None:
    """One note with the cause where baffles have no places of their own, none where they have."""
    runup = {"start": 60.0, "stop": 70.0, "rate": 100.0, "duration": 0.1, "samples": 10}
    model = {"liquid": liquid, "friction": {"linear": 1.0}}
    for count in (cells, 16):
        found = runup_scene(scene(LOW, runup=runup | {"cells": count}, model=model), check=False)
        told = [note for note in found.notes if note.code == "smeared_baffles"]
        assert len(told) == (count == cells or liquid == "linear")
        assert all(why in note.text and "Chamber 1" in note.text for note in told)
    with pytest.raises(InputError, match="compartments"):
        runup_scene(scene(CUT, runup=runup | {"cells": 32}, model={"liquid": "linear"}))
