"""The reports of `map`, `optimise`, `runup` and of an exciter: numbers of the JSON, warnings where due."""

from __future__ import annotations

import json
import math
import tomllib
from dataclasses import dataclass, fields, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.answer import Typed
from leblanc.core.blocks import Table, flat
from leblanc.core.disk import write
from leblanc.core.quantities import quantities
from leblanc.scene.scene import scene_from_table
from leblanc.studies.map import answer as whirl_map
from leblanc.studies.map.answer import WhirlMap
from leblanc.studies.optimise.answer import ConstraintValue, OptimumAnswer
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.run.study import run_scene
from leblanc.studies.run.words import MODELS
from leblanc.studies.runup import words
from leblanc.studies.runup.answer import RunupAnswer
from leblanc.studies.runup.notes import RunupCode
from leblanc.studies.runup.study import runup_scene
from leblanc.wings.exciter.answer import NUMBERS, ExciterAnswer, facts, limits
from leblanc.wings.exciter.study import run_exciter
from solvers.layer.records import Outcome
from solvers.runup.runup import EnergyAudit
from tests.leblanc.studies.test_runup import lying
from tests.leblanc.studies.test_runup import table as machine
from tests.oracles.blocks import cell_text, failed, labels, table
from tests.oracles.pages import Page, printed, read_page

ROOT = Path(__file__).parents[3]
RPM = 30.0 / math.pi


def example(name: str, count: int, **tables: Any) -> dict[str, Any]:
    table = tomllib.loads((ROOT / f"examples/{name}.toml").read_text(encoding="utf-8"))
    table["speeds"]["count"] = count
    return table | tables


def toml(value: Any, at: str = "") -> str:
    """A table as TOML, all of it in one line each."""
    if isinstance(value, dict):
        inside = ", ".join(f"{key} = {toml(entry)}" for key, entry in value.items())
        return f"{{ {inside} }}"
    if isinstance(value, list):
        return "[" + ", ".join(map(toml, value)) + "]"
    if isinstance(value, bool):
        return str(value).lower()
    return json.dumps(value, ensure_ascii=False)


@dataclass(frozen=True)
class Told:
    """What a command prints for scripts, and its report."""

    answer: dict[str, Any]
    page: Page
    size: int


def told(table: dict[str, Any], command: str, report: str, *options: str, code: int = 0) -> Told:
    """Run a command on a scene."""
    import contextlib
    import io

    with TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        scene.write_text("\n".join(f"{key} = {toml(one)}" for key, one in table.items()), encoding="utf-8")
        out = io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(io.StringIO()):
            assert main([command, str(scene), "--json", "--out", folder, *options]) == code
        path = Path(folder) / report
        return Told(json.loads(out.getvalue()), read_page(path), path.stat().st_size)


def check_command(page: Page, command: str, data: str) -> None:
    """The page says how it was made and where its numbers are."""
    assert any(text.startswith(f"leblanc {command} ") for text in page.of("code"))
    assert not data or data in page.of("code")


# --- map -------------------------------------------------------------------------------------------------


@cache
def small_map() -> WhirlMap:
    return lb.map_whirl(scene_from_table(example("horizontal_rig", 9)), volumes=7, speeds=40)


def test_map_numbers() -> None:
    record = small_map()
    found = dict(whirl_map.facts(record))
    k, j = np.unravel_index(np.argmax(record.growth), record.growth.shape)
    speed, volume = record.speed[j] * RPM, record.volume[k] * 1e6
    growth = printed(record.growth[k, j])
    assert found["Fastest growth"] == f"{growth} 1/s at {printed(speed)} rpm, {printed(volume)} ml"
    ratio = record.whirl_speed[k, j] / record.speed[j]
    assert found["That whirl's speed in space"] == f"{printed(ratio)} of the spin"
    share = 100.0 * (record.growth > 0.0).mean()
    assert found["A whirl grows at"] == f"{printed(share)} % of the points"
    assert found["Most liquid, all chambers"] == f"{printed(record.volume[-1] * 1e6)} ml"
    for volume, bands, most in whirl_map.bands_table(record).rows:
        (line,) = (i for i in range(record.volume.size) if printed(record.volume[i] * 1e6) == volume)
        assert most == printed(record.growth[line].max())
        edges = [f"{printed(low * RPM)} to {printed(high * RPM)}" for low, high in record.edges[line]]
        assert bands.text == ("; ".join(edges) or "none")


def test_map_warnings() -> None:
    record = small_map()
    calm = replace(
        record, growth=-np.ones_like(record.growth), scene_edges=(), in_range=np.ones_like(record.in_range)
    )
    assert not any(check.grade for check in whirl_map.checks(calm))
    some = np.zeros_like(record.in_range)
    some[1, :7] = True
    lost = np.where(some, np.nan, -1.0)
    every = record.growth.size
    for heading, text, troubled in (
        ("Growth not known", f"7 of {every} points (2.5 %)", replace(calm, growth=lost)),
        ("Model out of range", f"7 of {every} points (2.5 %)", replace(calm, in_range=~some)),
        (
            "Unstable with the scene's volume (rpm)",
            "600 to 900",
            replace(calm, scene_edges=((600 / RPM, 900 / RPM),)),
        ),
    ):
        found = whirl_map.checks(troubled)
        assert [(check.label, check.where) for check in found if check.grade] == [(heading, text)]
    both = replace(calm, in_range=~some, growth=np.where(some, 1.0, -1.0))
    marked = {check.label for check in whirl_map.checks(both) if check.grade}
    assert marked == {"Model out of range", "Grows where out of range"}


def test_map_report_is_the_json() -> None:
    table = example("horizontal_rig", 9)
    found = told(table, "map", "map.html", "--volumes", "7", "--speeds", "40", "--friction", "linear:0.2")
    answer, page = found.answer, found.page
    growth = np.array(answer["growth"])
    assert page.row("Volumes by speeds") == ["7 by 40"]
    k, j = np.unravel_index(np.argmax(growth), growth.shape)
    at = f"{printed(answer['speed'][j] * RPM)} rpm, {printed(answer['volume'][k] * 1e6)} ml"
    assert page.row("Fastest growth") == [f"{printed(growth[k, j])} 1/s at {at}"]
    assert page.row("Friction of the liquid") == [answer["friction"]] == ["linear, 0.2 1/s"]
    assert page.row("Support") == [answer["damping"]]
    bands = "; ".join(f"{printed(low * RPM)} to {printed(high * RPM)}" for low, high in answer["scene_edges"])
    assert page.row("Bands with the scene's 20 ml (rpm)") == [bands]
    assert [row[2] for row in page.table("Liquid (ml)")] == [printed(max(row)) for row in growth.tolist()]
    assert page.of("li") == answer["notes"]
    check_command(page, "map", "map.nc")
    assert "--volumes 7 --speeds 40 --friction linear:0.2" in page.words
    assert found.size < 1_500_000


def test_a_map_of_many_points_stays_light(tmp_path: Path) -> None:
    """Many points: the picture takes the place of the drawing, or the drawing holds a picture."""
    scene = scene_from_table(example("horizontal_rig", 9))
    record = lb.map_whirl(scene, volumes=3, speeds=3)
    speed = np.linspace(10.0, 200.0, 500)
    volume = np.linspace(0.0, 3e-4, 300)
    growth = np.sin(speed / 20.0) * np.cos(volume[:, None] * 4e4)
    edge = ((50.0, 90.0),)
    many = replace(
        record, speed=speed, volume=volume, growth=growth, whirl_speed=0.7 * speed + 0.0 * growth,
        in_range=growth < 0.9, edges=(edge,) * volume.size,
    )  # fmt: skip
    write(many, tmp_path, scene)
    assert (tmp_path / "map.html").stat().st_size < 3_000_000
    assert len(read_page(tmp_path / "map.html").table("Liquid (ml)")) == whirl_map.LISTED


# --- optimise --------------------------------------------------------------------------------------------


@cache
def optimum() -> OptimumAnswer:
    return optimise_scene(scene_from_table(example("centrifuge", 9)), front=True)


def test_optimum_numbers() -> None:
    record = optimum()
    (row,) = table(record, "Chamber").rows
    (form,), (chamber,) = record.closed_form, record.chambers
    expected = [
        record.volume[0] * 1e6, 100.0 * record.volume[0] / chamber.capacity, form.deflection * 1e3,
        form.optimal_volume * 1e6, 100.0 * form.unbalance_share, form.full_volume * 1e6,
    ]  # fmt: skip
    shown = [row[k] for k in (1, 3, 4, 5, 6, 7)]
    assert shown == [printed(one) for one in expected]
    (value,) = table(record, "", "best volumes").rows
    assert value[1:] == (
        f"{printed(record.value * 1e3)} mm", f"{printed(record.baseline * 1e3)} mm",
        printed(record.value / record.baseline),
    )  # fmt: skip
    found = labels(record)
    assert found["Working speed"] == f"{printed(record.working_speed * RPM)} rpm"
    assert found["Mass of the liquid"] == f"{printed(record.mass * 1e3)} g"
    (margin,) = (text for label, text in found.items() if label.startswith("Stability margin from"))
    assert margin == f"{printed(-record.growth)} 1/s"
    edge = record.front
    assert edge is not None
    rows = table(record, "Liquid (kg), ").rows
    assert sum("(chosen)" in row[0] for row in rows) == 1
    for row in rows:
        points = [k for k in range(edge.mass.size) if printed(edge.mass[k]) == row[0].split()[0]]
        mine = [
            (
                printed(edge.volume[k, 0] * 1e6),
                printed(edge.vibration[k] * 1e3),
                printed(edge.stability_margin[k]),
            )
            for k in points
        ]
        assert row[1:] in mine
        if "(chosen)" in row[0]:
            assert row[1] == printed(record.volume[0] * 1e6)


def test_optimum_warnings() -> None:
    """With constraints kept and nothing growing no row is marked; each trouble marks its own."""
    record = optimum()
    calm = replace(
        record,
        growth=-1.0,
        constraints={"capacity": ConstraintValue(1.0, 0.1, True, "1", "s")},
        response=None,
    )
    (kept,) = table(calm, "Constraint").rows
    assert not failed(calm) and cell_text(kept[3]) == "kept" and not kept[3].warning
    assert list(failed(replace(calm, growth=0.5))) == [
        "A small whirl grows somewhere at the operating speeds"
    ]
    dry = {"dry_patch": ConstraintValue(0.0, 1.0, False, "1", "dry")}
    over = replace(calm, constraints=dry)
    assert failed(over) == {"Constraints exceeded": "dry patch"}
    (row,) = table(over, "Constraint").rows
    assert row[3].warning and row[3].text == "EXCEEDED" and row[1:3] == ("1", "0")


def test_optimise_report_is_the_json() -> None:
    table = example("washing_machine", 9)
    found = told(table, "optimise", "optimise.html", "--objective", "least_mass")
    answer, page = found.answer, found.page
    rows = page.table("Chamber", "best volume (ml)")
    assert [row[1] for row in rows] == [printed(one * 1e6) for one in answer["volume"]]
    for row, form in zip(rows, answer["closed_form"], strict=True):
        assert row[4] == printed(form["deflection"] * 1e3)
        assert row[5] == printed(form["optimal_volume"] * 1e6)
        assert row[6] == printed(100.0 * form["unbalance_share"])
        assert row[7] == printed(form["full_volume"] * 1e6)
    mass, vibration = (
        answer["value"] * 1e3,
        [answer[one] * 1e3 for one in ("vibration", "vibration_baseline")],
    )
    assert page.row("Objective") == [f"{printed(mass)} g", "0 g", ""]
    both = [f"{printed(one)} mm" for one in vibration]
    assert page.row("Vibration") == [*both, printed(vibration[0] / vibration[1])]
    assert page.row("Sets of volumes evaluated") == [str(answer["evaluations"])]
    limits = {row[0].partition(":")[0]: row[1:] for row in page.table("Constraint")}
    assert limits["vibration"][1] == f"{printed(answer['constraints']['vibration']['limit'] * 1e3)} mm"
    assert limits["vibration"][2] == "kept" and set(limits) == {
        *("capacity", "stability", "wetting", "spill", "vibration")
    }
    head = next(row[0] for row in page.rows if row and row[0].startswith("Liquid ("))
    factor = {"g": 1e3, "kg": 1.0}[head[8 : head.index(")")]]
    front = {printed(one["mass"] * factor): one for one in answer["pareto"]}
    for row in page.table(head):
        assert row[0].split()[0] in front
    # What is said of the machine with the best volumes is what `run` says of it.
    for chamber, volume in zip(table["chambers"], answer["volume"], strict=True):
        chamber["volume"] = volume
    again = run_scene(scene_from_table(table | {"model": {"liquid": "statics"}}))
    r, last = again.response, float(again.speed[-1])
    at = [last] if answer["objective"] == "working_speed" else [again.peak["speed"], last]
    flags = {
        name: bool(np.any(np.interp(at, r.speed, fails.astype(float)) > 0.0))
        for name, fails in (
            ("Wall dry in part", r.dry_patch),
            ("Answer unstable", ~r.stable),
            ("Liquid model out of range", ~r.in_range),
        )
    }
    assert {heading for heading, flag in flags.items() if flag} == page.warnings() & set(flags)
    grows = any(heading.startswith("A small whirl grows") for heading in page.warnings())
    assert grows == (answer["stability_margin"] < 0.0)
    assert page.of("li") == list(answer["notes"])
    assert MODELS["statics"][0] in page.words and "the scene asks for it" not in page.words.lower()
    assert "--objective least_mass" in page.words
    check_command(page, "optimise", "optimum.nc")


def test_a_search_that_names_its_model_says_so() -> None:
    scene = scene_from_table(example("washing_machine", 5, model={"liquid": "statics"}))
    record = optimise_scene(scene, front=False)
    assert "scene asks" in record.models[-1].reason


@pytest.mark.usefixtures("undrawn")
def test_a_given_deflection_has_its_report() -> None:
    found = told(
        example("vertical_rig", 5), "optimise", "optimise.html", "--deflection", "1 mm", "--no-front"
    )
    rows = found.page.table("Chamber", "best volume (ml)")
    assert [row[1] for row in rows] == [printed(one * 1e6) for one in found.answer["volume"]]
    assert all(row[4] == "1" for row in rows)
    assert ("Deflection given", "1 mm") in found.page.terms
    assert not any(row[0].startswith("Liquid (g)") for row in found.page.rows if row)


# --- runup -----------------------------------------------------------------------------------------------


@cache
def run() -> RunupAnswer:
    """Up and down, lying, so that its liquid is captured and let go."""
    ramp = {"start": 3.0, "stop": 30.0, "rate": 20.0, "back": True, "duration": 2.0, "capture": "riding"}
    return runup_scene(lying(runup=ramp))


def test_runup_numbers() -> None:
    record = run()
    h = record.history
    rows = {label: cells for label, *cells in words.moments(record).rows}
    turn = int(np.flatnonzero(h.speed == h.speed.max())[-1])
    up = int(np.argmax(h.amplitude[: turn + 1]))
    down = turn + 1 + int(np.argmax(h.amplitude[turn + 1 :]))
    for label, k in (("Largest on the way up", up), ("Largest on the way down", down), ("At the end", -1)):
        label += "" if record.in_range_at(h.time[k]) else " (out of range)"
        assert rows[label] == [printed(h.amplitude[k] * 1e3), printed(h.speed[k] * RPM), printed(h.time[k])]
    assert record.steady is not None
    k = int(np.nanargmax(np.abs(record.steady.deflection)))
    steady = abs(record.steady.deflection[k]) * 1e3, record.steady.speed[k] * RPM
    assert rows["Largest of the steady response"] == [*map(printed, steady), ""]
    audit = h.audit
    work = max(abs(audit.unbalance), audit.support + audit.friction + audit.bores)
    energy = {label: cells for label, *cells in words.energy(record).rows}
    assert energy.get("+ work of the unbalance") == [
        printed(audit.unbalance),
        printed(100.0 * audit.unbalance / work),
    ]

    assert {label[0] for label in energy if label[0] != "="} == {"+", "\N{MINUS SIGN}"}

    # What is brought in less what is used is what is left over, as the signs before the terms say.
    def value(text: str) -> float:
        return float(text.replace("\N{MINUS SIGN}", "-"))

    total = sum(
        value(one[0]) * (1.0 if label[0] == "+" else -1.0) for label, one in energy.items() if label[0] != "="
    )
    left = value(energy["= not accounted for"][0])
    size = sum(abs(value(one[0])) for one in energy.values())
    assert abs(total - left) < 1e-3 * size  # each term has four digits
    assert abs(value(energy["= not accounted for"][1])) == pytest.approx(100.0 * audit.closure, rel=1e-3)
    found = dict(words.facts(record))
    assert found["Energy not accounted for, of the work"] == f"{printed(100.0 * audit.closure)} %"
    assert found["Error by half the cells, of the largest"] == f"{printed(100.0 * h.error_estimate)} %"
    assert found["Largest change of a layer's mass"] == f"{printed(100.0 * h.mass_error)} %"
    place = h.liquid_position[-1]
    angle = printed(math.degrees(np.angle(place)))
    assert (
        found["Its centre of mass at the end"]
        == f"{printed(abs(place) * 1e3)} mm off the axis at {angle} deg"
    )


def calm_run() -> RunupAnswer:
    record = run()
    h = record.history
    all_the_time = np.ones_like(h.captured)
    nothing = replace(h.audit, **{one.name: 0.0 for one in fields(h.audit)})
    history = replace(
        h, captured=all_the_time, depth_min=np.full_like(h.depth_min, 1e-3), mass_error=1e-12,
        error_estimate=0.01, outcome=Outcome.DONE, audit=nothing,
    )  # fmt: skip
    return replace(record, history=history, in_range=np.ones_like(record.in_range), bands=())


def test_runup_warnings() -> None:
    record = calm_run()
    h = record.history
    assert not any(one.grade for one in words.checks(record))
    part = np.zeros(h.time.size, dtype=np.bool_)
    part[10:20] = True
    where = f"{printed(h.time[10])} to {printed(h.time[19])} s"

    def with_history(**changes: Any) -> RunupAnswer:
        return replace(record, history=replace(h, **changes))

    audit = replace(h.audit, unbalance=1.0, support=0.99)
    for heading, text, troubled in (
        ("Stopped before its end", "a reason", with_history(outcome=Outcome.STOPPED, reason="a reason")),
        ("Liquid model out of range", where, replace(record, in_range=~part)),
        ("Annulus not reached from rest", where, with_history(captured=~part[:, None])),
        ("Liquid leaves a wall dry", where, with_history(depth_min=np.where(part, 1e-7, 1e-3)[:, None])),
        (
            "Self-excited whirl, linear theory",
            "100 to 200 rpm",
            replace(record, bands=((100 / RPM, 200 / RPM),)),
        ),
        ("Error above 2 % or unknown", "5 %", with_history(error_estimate=0.05)),
        ("Error above 2 % or unknown", "not known", with_history(error_estimate=math.nan)),
        ("Energy lost above 0.1 %", "1 %", with_history(audit=audit)),
        ("Mass changed above 0.0001 %", "0.01 %", with_history(mass_error=1e-4)),
    ):
        assert [(one.label, one.where) for one in words.checks(troubled) if one.grade] == [(heading, text)]


def test_events() -> None:
    """When liquid is captured and let go: between the samples on which its state differs, at that spin."""
    record = run()
    h = record.history
    state = h.captured[:, 0]
    change = [k for k in range(1, state.size) if state[k] != state[k - 1]]
    notes = [note for note in record.notes if note.code in (RunupCode.CAPTURED, RunupCode.FALLS_BACK)]
    assert len(notes) == len(change) >= 2
    for note, k in zip(notes, change, strict=True):
        assert ("becomes an annular layer" if state[k] else "falls back into a pool") in note.text
        time, speed = note.data["time"], note.data["speed"]
        assert isinstance(time, float) and h.time[k - 1] <= time <= h.time[k]
        assert speed == pytest.approx(float(np.interp(time, h.time, h.speed)), rel=1e-6)


def test_runup_report_is_the_json() -> None:
    ramp = {"start": 3.0, "stop": 30.0, "back": True, "samples": 200}
    content = machine(rotor={"axis": "horizontal"}, runup=ramp)
    found = told(content, "runup", "runup.html", "--cells", "32")
    answer, page = found.answer, found.page
    for label, name in (
        ("Largest on the way up", "peak"), ("Largest on the way down", "peak_back"), ("At the end", "end"),
        ("Without liquid", "peak_dry"),
    ):  # fmt: skip
        one = answer[name]
        at = min(int(np.searchsorted(answer["time"], one["time"])), len(answer["time"]) - 1)
        label += "" if name == "peak_dry" or answer["in_range"][at] else " (out of range)"
        assert page.row(label) == [
            printed(one["amplitude"] * 1e3),
            printed(one["speed"] * RPM),
            printed(one["time"]),
        ]
    energy = answer["energy"]
    # Without baffles they have no line.
    for name in set(words.TERMS) - {"baffles"}:
        text = quantities(EnergyAudit)[name].name
        (row,) = [row for row in page.rows if row and row[0][2:] == text]
        assert row[1] == printed(energy[name])
    assert page.row("= not accounted for")[0] == printed(energy["remainder"])
    assert page.row("Error of model and steps") == [f"{printed(100.0 * answer['model_error'])} %"]
    assert page.row("Phase of the deflection at the end") == [
        f"{printed(math.degrees(answer['end']['phase']))} deg"
    ]
    assert page.row("Resolution")[0].startswith(f"32 cells, {answer['steps']} steps")
    assert "--cells 32" in page.words
    (why,) = page.table("Speeds (rpm)", "Model", "Estimated error", "Why")
    assert why[1] == answer["model"] and answer["model_reason"][1:] in why[3]
    assert MODELS[answer["model"]][0] in page.words
    captured = np.array(answer["captured"])
    flags = {
        "Liquid model out of range": not all(answer["in_range"]),
        "Self-excited whirl, linear theory": bool(answer["bands"]),
        "Error above 2 % or unknown": not answer["error_estimate"] <= 0.02,
        "Energy lost above 0.1 %": energy["closure"] > 1e-3,
        "Annulus not reached from rest": not captured.all(),
    }
    assert {heading for heading, flag in flags.items() if flag} == page.warnings() & set(flags)
    assert len(page.addresses) == 3
    # The curve first: after the two sentences and before any table.
    first = next(k for k, (_, text) in enumerate(page.texts) if text.startswith("Figure 1."))
    assert "Amplitude over speed on the run-up" in page.texts[first][1]
    assert first < next(k for k, (tag, _) in enumerate(page.texts) if tag in ("th", "td"))
    # No note is lost: it stands among the remarks, or a table says it.
    notes = runup_scene(scene_from_table(content), cells=32).notes
    assert [note.text for note in notes] == answer["notes"]
    assert page.of("li") == [note.text for note in notes if note.code not in words.IN_TABLES]
    check_command(page, "runup", "runup.nc")


@pytest.mark.usefixtures("undrawn")
def test_a_run_that_stopped_says_so(tmp_path: Path) -> None:
    record = calm_run()
    stopped = replace(
        record, history=replace(record.history, outcome=Outcome.AT_AXIS, reason="the layer <left> the drum")
    )
    write(stopped, tmp_path, lying())
    page = read_page(tmp_path / "runup.html")
    assert page.row("Stopped before its end") == ["Warning: the layer <left> the drum"]


# --- exciter ---------------------------------------------------------------------------------------------


@cache
def exciter() -> ExciterAnswer:
    return run_exciter(scene_from_table(example("vibratory_table", 6)))


@pytest.mark.usefixtures("_exciter_once")
def test_exciter_numbers() -> None:
    record = exciter()
    found = dict(facts(record))
    first, through, last = (one * RPM for one in record.characteristic)
    assert (
        found["Natural frequency of the platform"] == f"{printed(record.machine.natural_frequency * RPM)} rpm"
    )
    assert found["Three stuck speeds, shaft from and to"] == f"{printed(first)} rpm to {printed(last)} rpm"
    assert found["Slowest stuck speed at the resonance, shaft at"] == f"{printed(through)} rpm"
    critical = found["Critical speed, up to which the balls stick"]
    assert critical == f"{printed(record.critical_speed * RPM)} rpm"
    end = printed(record.speed[-1] * RPM)
    assert found[f"Vibration with the shaft at {end} rpm"] == f"{printed(record.amplitude_fast[-1] * 1e3)} mm"
    below = replace(
        record,
        speed=record.speed[:3],
        amplitude_slow=record.amplitude_slow[:3],
        amplitude_fast=record.amplitude_fast[:3],
        dual_frequency=record.dual_frequency[:3],
    )
    slow = dict(facts(below))[f"Vibration with the balls at {printed(record.speed[2] * RPM)} rpm"]
    assert slow == f"{printed(record.amplitude_slow[2] * 1e3)} mm"
    tables = [block for block in flat(record.blocks(), "page") if isinstance(block, Table)]
    integrated = next(table for table in tables if table.title == "Integrated in time")
    for row, one in zip(integrated.rows, record.checks, strict=True):
        assert row[0] == printed(one.speed * RPM) and row[1].text == ("stay" if one.holds else "leave")
        if one.holds:
            assert row[2] == printed(one.stuck_speed * RPM)
        if one.holds and math.isfinite(one.slow):
            assert [row[3], row[4]] == [printed(one.slow * 1e3), printed(one.fast * 1e3)]


@pytest.mark.usefixtures("_exciter_once")
def test_exciter_warnings() -> None:
    record = exciter()
    calm = replace(record, dual_frequency=np.ones_like(record.dual_frequency))
    assert not any(check.grade for check in limits(calm))
    lost = tuple(replace(one, converged=k != 1) for k, one in enumerate(record.checks))
    at = f"{printed(record.checks[1].speed * RPM)} rpm"
    beyond = f"{printed(record.speed[-1] * RPM)} rpm"
    few = np.arange(record.speed.size) < record.speed.size - 1
    for heading, text, troubled in (
        ("Time integration not finite", at, replace(calm, checks=lost)),
        ("Balls do not stick", beyond, replace(calm, dual_frequency=few)),
        ("Regression of the source", "outside its ranges", replace(calm, critical_speed_printed=math.nan)),
    ):
        failed = [(check.label, check.where) for check in limits(troubled) if check.grade]
        assert failed == [(heading, text)]


@pytest.mark.usefixtures("undrawn", "_exciter_once")
def test_exciter_report_is_the_json(tmp_path: Path) -> None:
    record = exciter()
    answer = json.loads(json.dumps(record.to_json()))
    object.__setattr__(record, "typed", Typed(command="leblanc run table.toml"))
    write(record, tmp_path, scene_from_table(example("vibratory_table", 6)))
    page = read_page(tmp_path / "summary.html")
    printed_critical, critical = answer["critical_speed_printed"] * RPM, answer["critical_speed"] * RPM
    assert page.row("The same by the source's regression") == [f"{printed(printed_critical)} rpm"]
    assert page.row("Critical speed, up to which the balls stick") == [f"{printed(critical)} rpm"]
    for name, value in answer["dimensionless"].items():
        if name in NUMBERS:
            assert page.row(NUMBERS[name]) == [printed(value)]
    assert ("Balls do not stick" in page.warnings()) == (not all(answer["dual_frequency"]))
    assert len(page.addresses) == 1
    check_command(page, "run", "")


def test_reports_of_one_scene_do_not_overwrite_one_another() -> None:
    """All commands may share the folder of a scene."""
    names = [
        "summary.html",
        "map.html",
        "optimise.html",
        "runup.html",
        "response.nc",
        "map.nc",
        "optimum.nc",
        "runup.nc",
    ]
    assert len(set(names)) == len(names)
    places = tuple(f"studies/{name}/answer" for name in ("run", "map", "optimise", "runup"))
    source = "".join((ROOT / f"leblanc/{name}.py").read_text(encoding="utf-8") for name in places)
    assert all(f'"{name}"' in source for name in names)
