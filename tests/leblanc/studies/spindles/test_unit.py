"""Scenes of spindle units: the example's resonances, checks that can fail, refusals, files, units."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.blocks import Check, Checks, Headline, Table
from leblanc.core.netcdf import read_values
from leblanc.scene.examples import example, example_path
from leblanc.scene.schema.load import SceneError
from leblanc.wings.spindle.answer import SpindleAnswer
from leblanc.wings.spindle.figure import compliance_figure, shapes_figure
from meshes.errors import InputError
from solvers.rotor.shaft.structure import Coordinate, compliances
from tests.oracles.rotors import count_below

SCENE = example("spindle")
FEW = SCENE.replace({"speeds.count": 200})


@pytest.fixture(scope="module")
def result() -> SpindleAnswer:
    found = lb.run(FEW)
    assert isinstance(found, SpindleAnswer)
    return found


def checks(answer: SpindleAnswer) -> Sequence[Check]:
    return next(block.rows for block in answer.blocks() if isinstance(block, Checks))


def test_the_example_has_what_its_source_gives(result: SpindleAnswer) -> None:
    """[DP18]: resonances of the frame at 33 and 335 Hz, a quill of 65 by 250 mm, 2, 6, 7 and 4 sections."""
    hertz = result.natural_frequency / (2.0 * math.pi)
    assert hertz[:2] == pytest.approx([33.0, 335.0], abs=0.05)  # digits printed
    rotor = SCENE.rotor
    housing = rotor.beams[2]
    assert sum(section.length for section in housing.sections) == pytest.approx(0.25, rel=1e-12)
    assert {section.diameter for section in housing.sections} == {0.065}
    assert [len(beam.sections) for beam in rotor.beams] == [2, 6, 7, 4]
    given = {"rotor.kind", "rotor.driven", "rotor.measured", "rotor.wanted"}
    assert not given & set(SCENE.assumed)
    marked = [path for path in SCENE.assumed if "diameter" in path or path == "rotor.beams.2"]
    assert marked == []  # the quill's diameter is given


def test_all_natural_frequencies_are_there(result: SpindleAnswer) -> None:
    machine = SCENE.rotor.machine()
    ends = count_below(machine, result.frequency[[0, -1]])
    assert len(result.modes) == ends[1] - ends[0] == 5


def test_peaks_lie_at_natural_frequencies(result: SpindleAnswer) -> None:
    """Weak damping: at a natural frequency the motion is a quarter of a turn behind or ahead of the force."""
    driving = compliances(
        SCENE.rotor.machine(), result.natural_frequency, [Coordinate((1, 1))], [Coordinate((1, 1))]
    )[:, 0, 0]
    for mode, value in zip(result.modes[:2], driving, strict=False):
        assert abs(math.degrees(np.angle(value)) + 90.0) < 3.0
        assert abs(mode.wanted) > 10.0 * float(np.median(np.abs(result.wanted)))


def test_checks_pass_and_can_fail(result: SpindleAnswer) -> None:
    assert result.reciprocity < 1e-10 and result.ways_apart < 1e-9
    assert result.least_dissipation >= 0.0
    assert not any(check.grade for check in checks(result))
    for wrong in ({"reciprocity": 1e-6}, {"ways_apart": 1e-3}, {"least_dissipation": -1e-3}):
        assert sum(check.grade > 0 for check in checks(replace(result, **wrong))) == 1


def test_ratio_and_table(result: SpindleAnswer) -> None:
    assert result.transmissibility == pytest.approx(result.wanted / result.measured)
    rows = next(block.rows for block in result.blocks() if isinstance(block, Table))
    assert len(rows) == len(result.modes) + 2
    assert [row[0] for row in rows[1:3]] == ["33", "335"]
    assert "33, 335" in next(block.text for block in result.blocks() if isinstance(block, Headline))


def test_units_and_scale_do_not_matter() -> None:
    """Lengths, masses and stiffnesses scaled alike: compliances go down, frequencies as root k/m."""
    small = FEW.replace({"speeds.count": 7})
    known = lb.run(small)
    changes = {}
    for b, beam in enumerate(small.rotor.beams):
        changes[f"rotor.beams.{b}.density"] = 4.0 * beam.density
        changes[f"rotor.beams.{b}.elastic_modulus"] = 4.0 * beam.elastic_modulus
    for k, mass in enumerate(small.rotor.masses):
        changes |= {
            f"rotor.masses.{k}.mass": 4.0 * mass.mass,
            f"rotor.masses.{k}.inertia": 4.0 * mass.inertia,
        }
    for k, joint in enumerate(small.rotor.joints):
        for key in ("stiffness", "damping", "angular_stiffness", "angular_damping"):
            if key in joint.model_fields_set:
                changes[f"rotor.joints.{k}.{key}"] = 4.0 * getattr(joint, key)
    found = lb.run(small.replace(changes))
    assert found.wanted == pytest.approx(0.25 * known.wanted, rel=1e-9)
    assert found.natural_frequency == pytest.approx(known.natural_frequency, rel=1e-9)
    written = small.replace({"rotor.beams.0.sections.0.length": "6 cm", "speeds.start": "300 rpm"})
    assert lb.run(written).wanted == pytest.approx(known.wanted, rel=1e-9)
    assert written.digest == small.digest


def test_a_cut_section_is_the_same_beam() -> None:
    table = FEW.replace({"speeds.count": 5}).table()
    known = lb.run(lb.Scene(**table))
    sections = table["rotor"]["beams"][3]["sections"]
    last = sections[-1]
    sections[-1:] = [{**last, "length": 0.5 * last["length"]}] * 2
    found = lb.run(lb.Scene(**table))
    assert found.wanted == pytest.approx(known.wanted, rel=1e-9)


@pytest.mark.usefixtures("undrawn")
def test_files_and_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "few.toml"
    text = example_path("spindle").read_text(encoding="utf-8")
    scene.write_text(text.replace("count = 1991", "count = 40"), encoding="utf-8")
    assert main(["run", str(scene), "--json", "--out", str(tmp_path / "out")]) == 0
    told = json.loads(capsys.readouterr().out)
    assert len(told["frequency"]) == len(told["compliance"]["wanted"]) == 40
    assert told["modes"][0]["stations"]["frame.2"] == pytest.approx(0.0, abs=0.1)
    kept = read_values(tmp_path / "out" / "response.nc")
    assert kept["wanted_imag"] == pytest.approx([pair[1] for pair in told["compliance"]["wanted"]])
    assert kept["mode_shape"].shape == (5, 23)
    names = {path.name for path in (tmp_path / "out").iterdir()}
    assert {"summary.html", "response.nc", "compliance.svg", "shapes.svg"} <= names
    page = (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert "33, 335" in page
    assert main(["run", str(scene), "--out", str(tmp_path / "out")]) == 0
    assert "Limits of the answer" in capsys.readouterr().out


def test_figures_say_what_they_show(result: SpindleAnswer) -> None:
    first, second = compliance_figure(result), shapes_figure(result)
    assert "tool_holder.0" in first.alt and "33 Hz" in second.alt
    assert len(second.axes) == 5


@pytest.mark.parametrize("command", ["explain", "map", "runup", "optimise"])
def test_what_makes_no_sense_is_refused_in_one_line(command: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([command, str(example_path("spindle"))]) == 2
    said = capsys.readouterr().err.strip().splitlines()
    assert len(said) == 1 and 'rotor.kind = "spindle"' in said[0]


def test_calls_refuse_it_too() -> None:
    for call in (
        lambda: lb.compare(SCENE, models=["statics"]),
        lambda: lb.optimise(SCENE),
        lambda: lb.map_whirl(SCENE),
        lambda: lb.run_up(SCENE),
        lambda: lb.explain(SCENE),
    ):
        with pytest.raises(InputError, match=r"rotor\.kind"):
            call()


@pytest.mark.parametrize(
    ("change", "field"),
    [
        ({"rotor.driven": "spindle.9"}, "rotor.driven"),
        ({"rotor.wanted": "quill.0"}, "rotor.wanted"),
        ({"rotor.measured": "housing"}, "rotor.measured"),
        ({"rotor.beams.1.name": "housing"}, "rotor.beams.2.name"),
        ({"rotor.joints.0.to": "tool_holder.0"}, "rotor.joints.0.to"),
        ({"rotor.joints.0.to": "ceiling"}, "rotor.joints.0.to"),
        ({"rotor.masses.0.station": "tool_holder.3"}, "rotor.masses.0.station"),
        ({"rotor.beams.2.sections.0.bore": "65 mm"}, "rotor.beams.2.sections.0.bore"),
        ({"rotor.beams.0.name": "ground"}, "rotor.beams.0.name"),
        ({"rotor.theory": "plate"}, "rotor.theory"),
        ({"rotor.joints.0.stiffness": -1.0}, "rotor.joints.0.stiffness"),
    ],
)
def test_faulty_scenes(change: dict[str, object], field: str) -> None:
    with pytest.raises(SceneError) as caught:
        SCENE.replace(change)
    assert field in str(caught.value)


def test_no_liquid_and_no_run_up() -> None:
    table = SCENE.table()
    chamber = {"radius": "65 mm", "height": "20 mm", "volume": "10 ml", "liquid": "water"}
    with pytest.raises(SceneError, match="left out for a spindle"):
        lb.Scene(**(table | {"chambers": [chamber]}))
    with pytest.raises(SceneError, match="left out for a spindle"):
        lb.Scene(**(table | {"model": {"liquid": "statics"}}))


def test_beyond_the_theory() -> None:
    """Shear waves cross the frame's 90 mm from 50 to 60 kHz on."""
    with pytest.raises(InputError, match="cutoff"):
        lb.run(SCENE.replace({"speeds.stop": "150 kHz", "speeds.count": 2}))
