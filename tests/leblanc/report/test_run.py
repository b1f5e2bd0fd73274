"""The report of `run`: numbers of the record and of the JSON, nothing from elsewhere, warnings where due."""

from __future__ import annotations

import base64
import json
import math
import re
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.blocks import Notes
from leblanc.core.notes import Note
from leblanc.core.page import all_versions, citation, picture
from leblanc.core.units import number, ranges
from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.page import LIGHT, FigureFiles
from leblanc.scene.scene import load_scene
from leblanc.studies.run import words as words
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.motion import SelfExcited
from leblanc.studies.run.notes import OF_MODELS, RunCode
from leblanc.studies.run.study import run_scene
from leblanc.studies.run.words import MODELS
from tests.oracles.pages import WARNING, Page, about_record, printed, read_page, write_page_of
from tests.oracles.records import RPM, folded, record_of, response_of, rig

ROOT = Path(__file__).parents[3]
SVG = '<?xml version="1.0"?><svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300"/>'
ALT = "What is seen in the figure and its numbers."
PNG = b"\x89PNG\r\n\x1a\n" + bytes(100)


@pytest.fixture
def drawing(tmp_path: Path) -> FigureFiles:
    return figure(tmp_path, "amplitude", SVG)


def figure(folder: Path, name: str, svg: str, png: bytes = PNG) -> FigureFiles:
    files = FigureFiles(name, f"Title of {name}", folder / f"{name}.svg", folder / f"{name}.png", alt=ALT)
    files.svg.write_text(svg, encoding="utf-8")
    assert files.png is not None
    files.png.write_bytes(png)
    return files


def page_of(record: RunAnswer, folder: Path, figures: Sequence[FigureFiles] = (), tolerance=None) -> Page:
    path = folder / "summary.html"
    write_page_of(replace(record, tolerance=tolerance), about_record(record), figures, path)
    return read_page(path)


def test_comparisons() -> None:
    record = rig()
    r = record.response
    largest, at, last, factor, margin, critical = words.comparisons(record)
    wet, dry = np.abs(r.deflection), np.abs(r.deflection_dry)
    # Four digits are printed.
    close = {"rel_tol": 6e-4}
    assert math.isclose(float(largest.wet), wet.max() * 1000.0, **close)
    assert math.isclose(float(largest.dry), dry.max() * 1000.0, **close)
    assert math.isclose(float(largest.ratio), wet.max() / dry.max(), **close)
    assert math.isclose(float(at.wet), r.speed[wet.argmax()] * 30.0 / math.pi, **close)
    assert math.isclose(float(at.dry), r.speed[dry.argmax()] * 30.0 / math.pi, **close)
    assert math.isclose(float(last.ratio), wet[-1] / dry[-1], **close)
    top, top_dry = (
        max(found, key=lambda one: one.amplitude) for found in (record.resonances, record.resonances_dry)
    )
    assert [factor.wet, factor.dry] == [f"{one.amplification_factor:.3g}" for one in (top, top_dry)]
    away = [100.0 * (1.0 - one.speed / r.speed[-1]) for one in (top, top_dry)]
    assert [margin.wet, margin.dry] == [f"{share:.3g}" for share in away]
    # The added mass of the chamber lowers the critical speed by the root of the masses.
    added = 998.2 * math.pi * 0.065**2 * 0.02
    assert math.isclose(float(critical.ratio), math.sqrt(4.0 / (4.0 + added)), **close)
    assert critical.dry == "1000" and math.isclose(
        float(critical.wet), 1000.0 * float(critical.ratio), **close
    )
    found = dict(words.facts(record))
    place = found["Its centre of mass at 2000 rpm"].replace("\N{MINUS SIGN}", "-").split()
    assert math.isclose(float(place[0]), r.liquid_offset[-1] * 1000.0, **close)
    assert math.isclose(float(place[-2]), math.degrees(r.liquid_angle[-1]), **close)
    assert math.isclose(float(found["Mass of the liquid"].split()[0]), record.liquid_mass * 1000.0, **close)


def test_ranges() -> None:
    speed = np.array([100.0, 200.0, 300.0, 400.0, 500.0, 600.0]) * RPM
    holds = np.array([False, True, True, False, True, False])
    assert ranges(speed, holds) == "200 to 300; 500 rpm"
    assert ranges(speed[::-1], holds[::-1]) == "200 to 300; 500 rpm"
    assert ranges(speed, ~holds) == "100; 400; 600 rpm"


def quiet() -> RunAnswer:
    """A record of which nothing is to be said."""
    r = rig().response
    always = np.ones(201, dtype=np.bool_)
    whirl = SelfExcited(np.full(201, -1.0), np.zeros(201), (), "none")
    calm = replace(r, in_range=always, dry_patch=~always, stable=always, converged=always)
    return replace(
        record_of(calm), capture_speed=None, whirl=whirl, error_estimate=np.full(201, 1e-5), notes=()
    )


def some(first: int, last: int) -> np.ndarray:
    mask = np.zeros(201, dtype=np.bool_)
    mask[first : last + 1] = True
    return mask


def troubled() -> dict[str, tuple[RunAnswer, str]]:
    """One trouble each: heading of the check, record, speeds that it must name; see `WITH`."""
    record = quiet()
    r, whirl = record.response, record.whirl
    assert whirl is not None and record.error_estimate is not None
    part, where = some(20, 40), "290 to 480 rpm"  # the speeds lie 9.5 rpm apart, from 100 rpm
    infinite = np.where(some(30, 30), complex(np.inf, 0.0), r.deflection)
    lost = np.where(part, np.nan, whirl.growth)
    hidden = replace(r.at(np.array([30])), speed=r.speed[30:31] + RPM, deflection=infinite[30:31])
    return {
        "Not converged": (replace(record, response=replace(r, converged=~part)), where),
        "Liquid model out of range": (replace(record, response=replace(r, in_range=~part)), where),
        "No annular layer (gravity dominates)": (
            replace(record, capture_speed=150.0 * RPM), "100 to 147.5 rpm (below 150 rpm)"
        ),
        "Annulus not reached from rest": (
            replace(record, capture_speed=50.0 * RPM, carried_from=150.0 * RPM),
            "100 to 147.5 rpm (below 150 rpm)",
        ),
        "Error above 0.1 % or unknown": (
            replace(record, error_estimate=np.where(part, [np.nan, 0.002] * 100 + [0.002], 1e-5)), where
        ),
        "Wall dry in part": (replace(record, response=replace(r, dry_patch=part)), where),
        "Answer unstable": (replace(record, response=replace(r, stable=~part)), where),
        "Self-excited whirl": (
            replace(record, whirl=replace(whirl, bands=((290.0 * RPM, 480.0 * RPM),))), where
        ),
        "Stability not known": (replace(record, whirl=replace(whirl, growth=lost)), where),
        "Amplitude infinite": (replace(record, response=replace(r, deflection=infinite)), "385 rpm"),
        # Between the speeds of the scene, where no other check looks.
        "Amplitude infinite ": (replace(record, refined=hidden), "386 rpm"),
    }  # fmt: skip


# Where no whirl's growth is known, and where no motion lasts, nothing is known of stability either.
WITH = {"Stability not known": {"Self-excited whirl"}, "Amplitude infinite": {"Stability not known"}}


def test_warnings() -> None:
    assert not any(check.grade for check in words.checks(replace(quiet(), tolerance=1e-3)))
    for name, (record, where) in troubled().items():
        heading, marked = name.strip(), {name.strip()} | WITH.get(name, set())
        checks = {check.label: check for check in words.checks(replace(record, tolerance=1e-3))}
        assert {label for label, check in checks.items() if check.grade} == marked
        assert checks[heading].where == where, heading
        left = checks.keys() - marked - {"Estimated error of the liquid model"}
        assert all(checks[label].where == "none" for label in left)


def test_warnings_stand_on_the_page_where_the_flags_say_so(tmp_path: Path) -> None:
    assert page_of(quiet(), tmp_path, tolerance=1e-3).warnings() == set()
    assert WARNING not in page_of(quiet(), tmp_path).all_text
    for name, (record, where) in troubled().items():
        # An amplitude without a bound is the largest one; nothing else touches it, or the last speed.
        marked = {name.strip()} if name.startswith("Amplitude") else set()
        marked |= WITH.get(name, set()) if marked else set()
        page = page_of(record, tmp_path, tolerance=1e-3)
        assert page.warnings() == marked, name
        assert page.row(name.strip()) == [f"{WARNING} {where}" if marked else where]
        with pytest.MonkeyPatch.context() as patch:
            # As if the largest amplitude lay there.
            patch.setattr(words, "headline_speeds", lambda _: (385.0 * RPM, 386.0 * RPM, 120.0 * RPM))
            page = page_of(record, tmp_path, tolerance=1e-3)
        marked = {name.strip()} | WITH.get(name, set()) - {"Error above 0.1 % or unknown"}
        if name.startswith("Error"):
            marked = set()  # the headline itself says its error
        assert page.warnings() == marked, name


def test_whirl_that_was_not_found_is_a_warning() -> None:
    """Nor is it known there whether the answer is stable."""
    record = quiet()
    assert record.whirl is not None
    lost = replace(record, whirl=replace(record.whirl, growth=np.where(some(0, 1), np.nan, -1.0)))
    assert [(check.label, check.where) for check in words.checks(lost) if check.grade] == [
        ("Stability not known", "100 to 109.5 rpm"),
        ("Self-excited whirl", "not known at 100 to 109.5 rpm"),
    ]


def test_what_is_not_known_of_the_peak_is_not_called_unstable() -> None:
    record = quiet()
    assert record.whirl is not None
    at = int(np.argmax(record.amplitude))
    whirl = replace(record.whirl, growth=np.where(some(at, at), np.nan, -1.0))
    r = replace(record.response, stable=~some(at, at))
    lost = replace(record, response=r, whirl=whirl)
    assert words.comparisons(lost)[0].label == "Largest amplitude (mm 0-p, stability not known)"
    grows = replace(lost, whirl=record.whirl)
    assert words.comparisons(grows)[0].label == "Largest amplitude (mm 0-p, unstable)"
    # What is unstable against slow disturbances is known, and so is a whirl that grows.
    fails = replace(lost, response=replace(r, branch_stable=~np.ones_like(r.branch_stable)))
    inside = replace(lost, whirl=replace(whirl, bands=((0.0, 1e3),)))
    for known in (fails, inside):
        assert words.comparisons(known)[0].label == "Largest amplitude (mm 0-p, unstable)"


@pytest.mark.parametrize(
    "name",
    [
        "horizontal_rig",
        "tub",
        *(
            pytest.param(name, marks=pytest.mark.slow)
            for name in ("vertical_rig", "two_plane_rig", "centrifuge")
        ),
    ],
)
def test_numbers_are_those_of_the_json(
    name: str, tmp_path: Path, capsys, request: pytest.FixtureRequest
) -> None:
    if name != "horizontal_rig":  # what figures are called is alike
        request.getfixturevalue("undrawn")
    assert main(["run", f"examples/{name}.toml", "--json", "--out", str(tmp_path)]) == 0
    answer = json.loads(capsys.readouterr().out)
    page = read_page(tmp_path / "summary.html")
    rpm = [speed * 30.0 / math.pi for speed in answer["speed"]]
    wet, dry = answer["amplitude"], answer["amplitude_dry"]
    most, most_dry, curve = answer["peak"], answer["peak_dry"], answer["curve"]
    # The peaks are those of all speeds, of the scene and between them; with liquid where the answer holds.
    holds = zip(curve["amplitude"], curve["in_range"], strict=True)
    assert most["amplitude"] == max(size for size, inside in holds if inside)
    assert most_dry["amplitude"] == max(curve["amplitude_dry"])
    sizes = most["amplitude"], most_dry["amplitude"]
    (label,) = (row[0] for row in page.rows if row and row[0].startswith("Largest amplitude (mm 0-p"))
    shown, bare, ratio = page.row(label)
    size, _, error = shown.partition(" \N{PLUS-MINUS SIGN} ")
    # No digit is finer than the error, and the ratio's are as many.
    within = 0.05 * float(error) if error else 5e-4 * sizes[0] * 1e3
    assert abs(float(size) - sizes[0] * 1e3) <= within
    assert bare == printed(sizes[1] * 1e3) and len(ratio) <= 6
    assert abs(float(ratio) - sizes[0] / sizes[1]) <= 1.1 * within / (sizes[1] * 1e3)
    loose = most["speed"] <= (answer["capture_speed"] or 0.0)
    grows = any(low <= most["speed"] <= high for low, high in answer["whirl_bands"])
    assert ("out of range" in label, "unstable" in label) == (loose, grows)
    at = [printed(peak["speed"] * 30.0 / math.pi) for peak in (most, most_dry)]
    assert page.row("at the speed (rpm)") == [*at, ""]
    last = [printed(x) for x in (wet[-1] * 1e3, dry[-1] * 1e3, wet[-1] / dry[-1])]
    (label,) = (
        row[0] for row in page.rows if row and row[0].startswith(f"Amplitude at {printed(rpm[-1])} rpm")
    )
    shown, *rest = page.row(label)
    assert math.isclose(float(shown.partition(" ")[0]), wet[-1] * 1e3, rel_tol=2e-3)
    assert rest[0] == last[1] and math.isclose(float(rest[1]), wet[-1] / dry[-1], rel_tol=2e-3)
    assert ("unstable" in label) != answer["stable"][-1]
    assert ("out of range" in label) != answer["in_range"][-1]
    ((_, unit),) = (text.split() for text in page.row("Mass of the liquid"))
    mass = answer["liquid_mass"] * {"g": 1e3, "kg": 1.0}[unit]
    assert page.row("Mass of the liquid") == [f"{printed(mass)} {unit}"] and 1.0 <= mass < 1e3
    angle, offset = math.degrees(answer["liquid_angle"][-1]), answer["liquid_offset"][-1] * 1e3
    place = f"{printed(offset)} mm off the axis at {printed(angle)} deg"
    assert page.row(f"Its centre of mass at {printed(rpm[-1])} rpm") == [place]
    if "critical_speeds_wet" in answer:
        listed = ", ".join(
            printed(speed * 30.0 / math.pi) + (" b" if way < -0.5 else "")
            for speed, way in answer["critical_speeds_wet"]
        )
        assert page.row("Critical speeds with liquid") == [f"{listed} rpm"]
    else:
        both = [answer["critical_speed_wet"], answer["critical_speed_dry"]]
        both = [*(x * 30.0 / math.pi for x in both), both[0] / both[1]]
        assert page.row("Critical speed (rpm)") == [printed(x) for x in both]
    at, speed = np.array([most["speed"], answer["speed"][-1]]), answer["speed"]

    def touched(fails) -> bool:
        return bool(np.any(np.interp(at, speed, np.array(fails, dtype=float)) > 0.0))

    carried, bands = answer["carried_from"] or 0.0, answer["whirl_bands"]
    capture = answer["capture_speed"] or 0.0
    flags = {
        "Not converged": touched(np.logical_not(answer["converged"])),
        "Liquid model out of range": touched(np.logical_not(answer["in_range"])),
        "Wall dry in part": touched(answer["dry_patch"]),
        "Answer unstable": touched(np.logical_not(answer["stable"])),
        "Self-excited whirl": any(low <= one <= high for one in at for low, high in bands),
        "No annular layer (gravity dominates)": touched(np.array(speed) <= capture),
        "Annulus not reached from rest": touched(np.array(speed) < carried),
    }
    for name_of, least in answer.get("worst", {}).get("clearance", {}).items():
        flags[f"Clearance of {name_of}"] = least["value"] <= 0.0
    assert page.warnings() == {heading for heading, flag in flags.items() if flag}
    # The models and why, as `explain` says them.
    assert main(["explain", f"examples/{name}.toml", "--json"]) == 0
    spans = json.loads(capsys.readouterr().out)["models"]
    rows = page.table("Speeds (rpm)", "Model", "Estimated error", "Why")
    assert len(rows) == len(spans)
    for row, span in zip(rows, spans, strict=True):
        assert row[1].split()[0] == span["model"] and ("out of range" in row[1]) != span["in_range"]
        assert row[3].lower() == f"{span['reason'].lower()}."
        assert row[0].split()[0] == printed(span["first"] * 30.0 / math.pi)
    for model in {span["model"] for span in spans}:
        assert MODELS[model][0] in page.words
    assert set(answer["notes"]) - set(page.of("li")) <= {
        note for note in answer["notes"] if "tolerance" in note or note.startswith("Liquid model:")
    }


def test_why_gives_the_error_of_each_range() -> None:
    scene = load_scene(ROOT / "examples/horizontal_rig.toml")
    spans = run_scene(scene).models
    rows = words.why(spans).rows
    assert [row[2] for row in rows] == ["not known", "2.1 %", "0.094 %"]
    assert [row[0] for row in rows] == ["100 to 128.5", "138 to 1107", "1116 to 2000"]
    unbounded = words.why([replace(spans[2], error=math.inf)]).rows[0]
    assert unbounded[2] == "without a bound"


def test_page_names_machine_model_notes_and_versions(tmp_path: Path) -> None:
    record = rig()
    page = page_of(record, tmp_path)
    assert page.of("h1") == [record.name]
    text = page.words
    assert "A rotor with a horizontal axis that carries one chamber with 10 ml of water" in text
    assert "from 100 to 2000 rpm in 201 speeds." in text
    assert "Source: DR18, section 7.2." in text
    assert str(record.notes[0]) in page.of("li")
    assert record.digest in text
    for package, version in all_versions().items():
        assert f"{package} {version}" in text
    assert f"numpy {np.__version__}" in text
    assert MODELS["statics"][0] in text


def test_every_model_says_what_it_does_and_takes_for_granted() -> None:
    assert set(MODELS) == {"statics", "linear", "long_wave", "kdv", "kdv_held", "potential", "fem"}
    assert all(len(sentences) == 2 for sentences in MODELS.values())


def test_inputs_with_assumed_values_marked(tmp_path: Path) -> None:
    record = replace(rig(), assumed=("rotor.mass", "chambers.0", "runup.rate"))
    page = page_of(record, tmp_path)
    assert [label for label, _ in page.terms] == [label for label, _, _ in record.inputs]
    for (label, value, path), (_, shown) in zip(record.inputs, page.terms, strict=True):
        marked = path == "rotor.mass" or path.startswith("chambers.0.")
        assert shown == (f"{value} *" if marked else value), label
    assert "* assumed: no source gives this value. Also assumed: runup.rate." in page.words
    assert page.attributes.count(("span", "aria-label", "assumed")) == 5
    assert "assumed" not in page_of(replace(record, assumed=()), tmp_path).words


def test_several_models_each_with_its_range(tmp_path: Path) -> None:
    r = rig().response
    model = np.where(np.arange(201) < 100, "statics", "long_wave")
    page = page_of(record_of(replace(r, model=model)), tmp_path)
    assert page.table("Model", "Speeds") == [
        ["statics", "100 to 1040 rpm"],
        ["long_wave", "1050 to 2000 rpm"],
    ]


def test_remarks_come_from_the_numbers() -> None:
    record = rig()
    assert words.remarks(record) == []
    below = replace(rig(50, 100.0, 900.0), notes=())
    assert words.remarks(below) == ["The largest amplitude lies at an end of the range of speeds."]
    r = record.response
    doubtful = replace(record, notes=(), response=replace(r, in_range=np.zeros(201, dtype=np.bool_)))
    assert len(words.remarks(doubtful)) == 2
    lost = replace(r, deflection=np.full(201, np.nan + 0j))
    assert words.remarks(replace(record, notes=(), response=lost)) == ["No answer was found at any speed."]


def test_figures_are_inside_the_page(tmp_path: Path, drawing: FigureFiles) -> None:
    page = page_of(rig(), tmp_path, [drawing])
    (address,) = page.addresses
    kind, content = address.split(",")
    assert kind == "data:image/svg+xml;base64"
    assert base64.b64decode(content) == drawing.svg.read_bytes()
    assert page.of("figcaption") == [] and page.of("b")[1] == "Figure 1. Title of amplitude."
    assert page.alts == [drawing.alt]


def test_heavy_drawings_are_pictures(tmp_path: Path) -> None:
    """The smaller file counts, and only beyond what a page bears."""
    heavy = SVG + "<!--" + "x" * LIGHT + "-->"
    for svg, png, kind in (
        (SVG, b"", "svg"), (heavy, PNG, "png"), (heavy, PNG + bytes(2 * LIGHT), "svg"),
    ):  # fmt: skip
        assert picture(figure(tmp_path, "map", svg, png), "alt")["address"].startswith(f"data:image/{kind}")


def test_the_phase_stands_on_the_page_of_a_rotor_that_tilts_only(tmp_path: Path) -> None:
    names = ["amplitude", "liquid", "phase", "chamber", "campbell"]
    figures = [figure(tmp_path, name, SVG) for name in names]
    assert len(page_of(rig(), tmp_path, figures[:4]).addresses) == 3
    assert len(page_of(run_scene(lb.example("two_plane_rig")), tmp_path, figures).addresses) == 5


def test_captions_are_text_of_the_page(tmp_path: Path) -> None:
    """No small print in the picture; its file says all of it, a page what the picture shows."""
    from leblanc.plotting import chambers, page
    from leblanc.studies.run import figure as run_figures

    record = replace(rig(41), name="A & B")
    drawn = {
        "amplitude": run_figures.amplitude_figure(record),
        "liquid": run_figures.liquid_figure(record),
        "chamber": chambers.chamber_figure(record),
    }
    for name, one in drawn.items():
        files = page.save(one, tmp_path, name, "Title")
        assert one.texts == [] and "Scene: A & B." in str(one.caption)
        assert picture(files)["caption"] == one.caption.shown.replace("\N{NO-BREAK SPACE}", " ")
        assert "Scene: A &amp; B." in files.svg.read_text(encoding="utf-8")
        assert picture(files)["alt"] == one.alt and len(one.alt) > 20
    assert picture(figure(tmp_path, "bare", SVG), "alt")["caption"] == ""


def test_notes_that_the_page_says_elsewhere_are_left_out() -> None:
    """The table of models says what the notes on the models say; other notes stay."""
    result = run_scene(load_scene(ROOT / "examples/horizontal_rig.toml"))
    codes = [note.code for note in result.notes]
    assert codes[:2] == list(OF_MODELS)
    (shown,) = (block for block in result.blocks() if isinstance(block, Notes))
    assert list(shown.texts) == [str(note) for note in result.notes[2:]]


def test_user_text_is_text(tmp_path: Path) -> None:
    hostile = "<script>alert('x')</script> \"quoted\" & {{ 7 * 7 }}"
    record = replace(
        rig(),
        name=hostile,
        source=hostile,
        notes=(Note(RunCode.MESH, {}, hostile),),
        assumed=(hostile,),
        inputs=((hostile, hostile, "rotor.mass"),),
        chambers=(FilledChamber(0.065, 0.0, 0.02, 1e-5, hostile, 0.06),),
    )
    page = page_of(record, tmp_path)
    assert "script" not in page.tags
    assert page.of("h1") == [hostile]
    assert page.of("li") == [hostile]
    assert page.terms == [(hostile, hostile)]


def test_unicode_survives_and_control_characters_do_not(tmp_path: Path) -> None:
    name = "Ölabscheider \N{CJK UNIFIED IDEOGRAPH-6D17} \N{HEBREW LETTER ALEF} \N{SNOWMAN}"
    page = page_of(replace(rig(), name=f"{name}\x00\x1b\n"), tmp_path)
    assert page.of("h1") == [name]


@pytest.mark.parametrize(
    "record",
    [
        folded(),
        rig(1),
        replace(rig(), chambers=(), notes=(), assumed=(), source=""),
        record_of(
            replace(
                response_of(np.linspace(1.0, 2.0, 3)),
                deflection=np.full(3, np.nan + 0j),
                deflection_dry=np.zeros(3, dtype=np.complex128),
                liquid_offset=np.full(3, np.nan),
                model=np.full(3, "a model from elsewhere"),
            )
        ),
    ],
    ids=["folded", "one speed", "bare", "nothing found"],
)
def test_extremes_give_a_page(record: RunAnswer, tmp_path: Path) -> None:
    page_of(record, tmp_path)


def test_same_record_same_page(tmp_path: Path, drawing: FigureFiles) -> None:
    texts = []
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
        page_of(folded(), tmp_path / name, [drawing])
        texts.append((tmp_path / name / "summary.html").read_bytes())
    assert texts[0] == texts[1]


def test_the_citation_is_that_of_the_file() -> None:
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    (title,), (authors,) = (
        re.findall(r'^title: "(.*)"$', text, re.M),
        re.findall(r"- name: (.*)$", text, re.M),
    )
    assert citation() == f"{authors}. {title}. Version {all_versions()['leblanc']}."


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (1000.0, "1000"),
        (0.5, "0.5"),
        (-1.23456, "\N{MINUS SIGN}1.235"),
        (123456.7, "123457"),
        (1.5e-7, "1.500e\N{MINUS SIGN}07"),
        (2.5e9, "2.500e+09"),
        (math.nan, "not found"),
        (math.inf, "infinite"),
    ],
)
def test_numbers_for_print(value: float, text: str) -> None:
    assert number(value) == text
    if math.isfinite(value):
        assert printed(value) == text
