"""`leblanc modes`: ring, baffles, section from a file, figure, table, wrong input."""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fluid.liquid import known_liquid
from leblanc.cli import main
from leblanc.core.blocks import Table
from leblanc.studies.modes.study import Resolution, SectionSource, answer_modes
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.files.exchange import write_section
from meshes.section import Section, disc
from solvers.sloshing.forced import mode_damping
from solvers.sloshing.system import surface_system
from tests.mutants import kills
from tests.oracles.sloshing import ring_decay, sector_frequencies
from validation.cases.baffles.modes import RADIUS, SPIN, SURFACE, baffle_row, table

R, A, H = 0.15, 0.135, 0.05
VOLUME = math.pi * (R**2 - A**2) * H
WATER = known_liquid("water")
CALL = ["modes", "--radius", "0.15", "--height", "5 cm", "--volume", str(VOLUME), "--speed", "40"]


@kills(
    "leblanc.studies.modes.study:_error",
    "np.abs(other / size - 1.0) / (4.0**order - 1.0)",
    "np.abs(other / size - 1.0)",
)
@kills(
    "leblanc.studies.modes.study:_exact",
    "np.where(modes.frequency > 0.0, *both)",
    "np.where(modes.frequency < 0.0, *both)",
)
@kills("leblanc.studies.modes.study:answer_modes", "damping.rate / size", "damping.rate * size")
def test_ring() -> None:
    """Frequencies, exact values beside them, errors estimated within a factor of two, damping by hand."""
    answer = answer_modes(Chamber(R, H), VOLUME, WATER, 40.0, 6, Resolution(64, 4))
    exact = np.array(answer.exact, dtype=float)
    assert answer.error_estimate is not None
    error = np.abs(answer.frequency / exact - 1.0)
    assert np.all(error < 5e-5) and np.all(np.abs(error / answer.error_estimate - 1.0) < 0.5)
    assert np.all(np.diff(np.abs(answer.frequency)) > 0.0)
    for k, n in enumerate(answer.crests):
        by_hand = ring_decay(int(n), exact[k], 40.0, R, A, H, WATER.viscosity, coriolis=True)
        assert abs(answer.damping[k] / by_hand - 1.0) < 2e-3
    assert np.allclose(answer.damping_ratio, answer.damping / np.abs(answer.frequency))
    assert abs(answer.surface_radius - A) < 1e-12 and abs(answer.synchronous_force_ratio - 1.0) < 1e-6
    assert answer.converged and not answer.notes


@kills("leblanc.studies.modes.answer:_rows", "k += same", "k += 1")
def test_closed_sectors() -> None:
    """Six compartments: one frequency six times, against the series of sines."""
    chamber = Chamber(R, H, baffles=Baffles(6))
    answer = answer_modes(chamber, VOLUME, WATER, 40.0, 8, Resolution(96, 4))
    log = math.log(R / A)
    coarse, fine = (sector_frequencies(math.pi / 3.0, log, terms, 2) for terms in (60, 120))
    first, second = 40.0 * (fine + (fine - coarse) / 7.0)
    assert np.allclose(np.abs(answer.frequency), [first] * 6 + [second] * 2, rtol=1e-4)
    assert answer.multiplicity.tolist() == [6] * 8 and answer.exact == (None,) * 8
    assert np.all(np.abs(answer.travelling) < 0.5)
    (table,) = (block for block in answer.blocks() if isinstance(block, Table))
    assert [(row[1], row[3]) for row in table.rows] == [("6", "stands")] * 2


@kills(
    "leblanc.studies.modes.study:section_of_file",
    "surface_radius_of(section, volume / chamber.height)",
    "surface_radius_of(section, volume)",
)
@kills("leblanc.studies.modes.study:section_of_file", "[liquid, halved(liquid)]", "[liquid, liquid]")
def test_file(tmp_path: Path) -> None:
    """A disc from a file, in millimetres, has the ring's waves."""
    path = tmp_path / "disc.msh"
    write_section(disc(150.0, 96, order=2), path)
    source = SectionSource(path, 1e-3)
    plain = answer_modes(Chamber(R, H), VOLUME, WATER, 40.0, 8)
    exact = np.array(plain.exact, dtype=float)
    for order in (1, 2):
        answer = answer_modes(Chamber(R, H), VOLUME, WATER, 40.0, 8, Resolution(64, 4, order=order), source)
        error = np.abs(answer.frequency / exact - 1.0)
        # The file's own wall, parabolas of 96 sides, is off by 1e-8; above that the extrapolation holds.
        assert np.all(error < {1: 2e-3, 2: 5e-6}[order])
        known = error > 5e-8
        assert known.any() and np.all(np.abs(answer.error_estimate / error - 1.0)[known] < 0.5)
        assert answer.exact == (None,) * 8
    other = answer_modes(Chamber(0.2, H), VOLUME, WATER, 40.0, 2, Resolution(32, 2), source)
    assert any("not --radius" in note.text for note in other.notes)


def circle_drawing(path: Path, units: int = 4) -> None:
    """A circle of 150 mm in millimetres, whatever the unit that the file names."""
    document = ezdxf().new(units=units)
    document.modelspace().add_circle((0, 0), 150.0)
    document.saveas(path)


def ezdxf() -> Any:
    """The library of drawings; skips where it or Gmsh is missing."""
    try:
        import gmsh  # noqa: F401
    except (ImportError, OSError) as missing:  # the wheel needs libraries of the system
        pytest.skip(f"gmsh cannot be loaded: {missing}")
    return pytest.importorskip("ezdxf")


def test_outline(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A drawn circle has the ring's waves, in the drawing's own unit or one that is given, which wins."""
    shown = []
    for units, more in ((4, []), (4, ["--mesh-size", "10 mm"]), (1, ["--mesh-unit", "mm"])):
        circle_drawing(tmp_path / "circle.dxf", units)
        assert main([*CALL, "--count", "4", "--mesh", str(tmp_path / "circle.dxf"), *more, "--json"]) == 0
        shown.append(json.loads(capsys.readouterr().out))
    plain = answer_modes(Chamber(R, H), VOLUME, WATER, 40.0, 4)
    for one in shown:
        assert np.allclose(one["frequency"], plain.frequency, rtol=5e-5)
        assert max(one["error_estimate"]) < 1e-4
    assert shown[0]["unknowns"] != shown[1]["unknowns"]


def test_no_library_for_outlines(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "x.dxf").write_text("")
    monkeypatch.setitem(sys.modules, "ezdxf", None)
    assert main([*CALL, "--mesh", str(tmp_path / "x.dxf")]) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert "extra `cad`" in line


def test_a_poor_mesh_is_named(tmp_path: Path) -> None:
    coarse = disc(0.15, 24, order=1)
    points = coarse.points.copy()
    inside = np.flatnonzero(np.hypot(*points.T) < 0.149)
    points[inside] *= 0.12
    write_section(Section(points, coarse.triangles), tmp_path / "poor.msh")
    source = SectionSource(tmp_path / "poor.msh")
    answer = answer_modes(Chamber(R, H), VOLUME, WATER, 40.0, 2, Resolution(32, 2), source)
    assert any(note.text.startswith("mesh: ") for note in answer.notes)
    assert any("straight sides" in note.text for note in answer.notes)


def test_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*CALL, "--count", "3", "--segments", "32", "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert np.allclose(shown["frequency"], [-9.42412, 17.82191, -18.77685], rtol=1e-4)
    assert np.allclose(shown["exact"], shown["frequency"], rtol=1e-4)
    for name in ("damping", "damping_ratio", "crests", "multiplicity", "error_estimate"):
        assert len(shown[name]) == 3
    baffled = [*CALL, "--count", "2", "--segments", "24", "--baffles", "2", "--baffle-tip-radius", "142 mm"]
    assert main([*baffled, "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["exact"] == [None, None] and 0.0 < shown["damping_spread"][0] < 0.05


def test_figure_and_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "shapes"
    assert main([*CALL, "--count", "7", "--segments", "24", "--baffles", "3", "--out", str(out)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("Round chamber, R = 150 mm, 3 baffles from the wall through the surface")
    assert (out / "modes.svg").stat().st_size > 20_000


@pytest.mark.parametrize(
    ("more", "word"),
    [
        (["--count", "0"], "--count"),
        (["--baffles", "-2"], "--baffles"),
        (["--baffle-tip-radius", "0.1"], "--baffles"),
        (["--baffles", "2", "--baffle-wall-gap", "0.2"], "tip_radius"),
        (["--segments", "3"], "--segments"),
        (["--layers", "0"], "--layers"),
        (["--order", "3"], "--order"),
        (["--speed", "0"], "--speed"),
        (["--volume", "1"], "volume"),
        (["--volume", "0"], "--volume"),
        (["--liquid", "beer"], "liquid"),
        (["--mesh", "/nowhere/at/all.msh"], "path"),
        (["--mesh", "x.msh", "--baffles", "2"], "--baffles"),
        (["--mesh", "x.msh", "--mesh-unit", "0"], "--mesh-unit"),
        (["--mesh", "x.dxf", "--mesh-size", "0"], "--mesh-size"),
        (["--mesh", "x.msh", "--mesh-size", "1 mm"], "--mesh-size"),
        (["--mesh-size", "1 mm"], "--mesh-size"),
        (["--mesh-unit", "1 mm"], "--mesh-unit"),
        (["--mesh", "x.dxf"], "path"),
    ],
)
def test_wrong_input(more: list[str], word: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*CALL, *more]) == 2
    shown = capsys.readouterr()
    assert shown.out == "" and word in shown.err and shown.err.count("\n") == 1


def test_dry_baffles_change_nothing() -> None:
    chamber = Chamber(R, H, baffles=Baffles(3, 0.05, 0.02))
    answer = answer_modes(chamber, VOLUME, WATER, 40.0, 2, Resolution(32, 2))
    assert answer.exact[0] is not None and "clear of the liquid" in answer.notes[0].text


def test_a_coarse_mesh_says_so() -> None:
    answer = answer_modes(Chamber(R, H), VOLUME, WATER, 40.0, 14, Resolution(16, 2))
    assert any("--segments" in note.text for note in answer.notes)


def test_thick_oil_says_so() -> None:
    answer = answer_modes(Chamber(R, H), VOLUME, known_liquid("glycerol"), 40.0, 2, Resolution(32, 2))
    assert any("boundary layers" in note.text for note in answer.notes)


def test_baffle_table() -> None:
    clear, deep, closed = (
        baffle_row(count, share, fineness=Resolution(32, 2))
        for count, share in ((0, 0.0), (2, 0.5), (3, 1.0))
    )
    assert deep.error < 1e-3 and abs(deep.against) < abs(clear.against) and deep.along < clear.along
    expected = SPIN * sector_frequencies(2.0 * math.pi / 3.0, math.log(RADIUS / SURFACE), 60, 1)[0]
    assert abs(abs(closed.against) / expected - 1.0) < 1e-3 and closed.against == closed.along
    assert "stands" in table([clear, deep, closed]).rows[-1][2]


def test_plates_of_a_high_chamber_do_not_count() -> None:
    chamber = Chamber(R, 1e6)
    record = answer_modes(chamber, VOLUME / H * 1e6, WATER, 40.0, 2, Resolution(32, 2))
    system = surface_system(record.section)
    damping = mode_damping(system, record.shapes, WATER.viscosity, 1e6)
    higher = mode_damping(system, record.shapes, WATER.viscosity, np.inf)
    assert np.allclose(damping.rate, higher.rate, rtol=1e-5)
