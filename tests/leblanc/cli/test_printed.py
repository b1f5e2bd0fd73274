"""What commands print in words: the answer with its limits, in readable units, the same everywhere."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.blocks import Table, Words, flat
from leblanc.core.units import LENGTH, RPM, with_unit
from leblanc.plotting.chambers import describe_state as chamber_state
from leblanc.scene.examples import example_path
from leblanc.studies.run import words as text
from leblanc.studies.shapes.machine import machine_motion
from leblanc.view.scene import describe_state as view_state

RAW = re.compile(r"[-+.\d]j\b|\bTrue\b|\bFalse\b|\bNone\b|\bnan\b|\binf\b|\[|array|e[+-]\d\d")


def printed(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    assert main([*arguments]) == 0
    return capsys.readouterr().out


def run(
    capsys: pytest.CaptureFixture[str], name: str, folder: Path, changes: str = "", right: str = ""
) -> str:
    path = folder / "scene.toml"
    content = example_path(name).read_text(encoding="utf-8")
    assert right in content
    path.write_text(content.replace(right, changes), encoding="utf-8")
    return printed(capsys, "run", str(path), "--out", str(folder))


@pytest.mark.usefixtures("undrawn")
def test_run_prints_every_limit_below_its_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Unstable from ... to ..., error, out of range: those of the JSON."""
    words = run(capsys, "horizontal_rig", tmp_path, "count = 20", "count = 201")
    result = lb.run(tmp_path / "scene.toml")
    below = words.partition("Limits of the answer")[2].splitlines()
    rows = {row[0]: row[1] for line in below if len(row := re.split(r"  +", line.strip("! "))) == 2}
    found = {limit.label: limit.where for limit in text.checks(result) if limit.where != "none"}
    assert found.items() <= rows.items() and "none" not in rows.values()
    slow = result.speed[~result.in_range] * RPM
    assert rows["Liquid model out of range"] == f"{slow[0]:.0f} to {slow[-1]:.4g} rpm" or slow.size == 1
    assert result.error_estimate is not None
    unknown = int((~np.isfinite(result.error_estimate)).sum())
    assert rows["Estimated error of the liquid model"].endswith(f"at {unknown} of 20 speeds")


@pytest.mark.parametrize("name", ["tub", "centrifuge", "horizontal_rig"])
def test_a_headline_that_does_not_hold_says_so(name: str) -> None:
    """At the largest amplitude: out of range, unstable, or neither; in the sentence and in the table."""
    result = lb.run(lb.example(name).replace({"speeds.count": 60}))
    curve = result.curve  # with the speeds between, where the peak is
    k = curve.top
    assert k is not None
    largest = text.comparisons(result)[0].label
    headline = text.answer(result).partition(" and ")[0]
    for words, holds in (("out of range", curve.in_range[k]), ("unstable", curve.stable[k])):
        assert (words in largest) != holds
        assert (words in headline) != holds


@pytest.mark.parametrize("name", ["tub", "two_plane_rig"])
def test_console_chamber_figure_and_view_show_one_amplitude(name: str) -> None:
    """That of `amplitude` in the JSON, in the plane that is named with it."""
    scene = lb.example(name).replace({"speeds.count": 40})
    motion = machine_motion(scene)
    result, last = motion.response, motion.response.speed.size - 1
    size = with_unit(float(result.amplitude[last]), LENGTH)
    place = text.amplitude_place(result)
    assert place == f"in the plane of chamber 1 at {with_unit(scene.chambers[0].plane, LENGTH)}"
    assert text.comparisons(result)[2].wet_text == size
    assert chamber_state(result, result.curve.speed.size - 1).startswith(f"amplitude {size} at chamber 1,")
    assert view_state(motion, last, [False] * len(scene.chambers))[0] == f"amplitude {place}: {size}"
    assert place in text.answer(result) and place in text.alts(result)["amplitude"]
    assert text.amplitude_place(result) == place
    figure = result.plot()
    assert figure.axes[0].get_ylabel().replace("\n", " ") == "Amplitude at chamber 1 (mm 0-p)"
    assert place in figure.caption.shown


def test_a_rotor_in_one_plane_has_no_plane_to_name() -> None:
    result = lb.run(lb.example("centrifuge").replace({"speeds.count": 5}))
    assert text.amplitude_place(result) == "" and "plane" not in text.answer(result)
    assert result.plot().axes[0].get_ylabel().replace("\n", " ") == "Amplitude (mm 0-p)"


LAYER = [
    *("layer", "--radius", "150 mm", "--height", "50 mm", "--volume", "671 ml", "--speed", "40"),
    *("--whirl-speed", "32", "--whirl-amplitude", "0.15 mm"),
]


@pytest.mark.parametrize(
    "options",
    [
        ["--model", "kdv", "--profile"],
        ["--model", "linear"],
        ["--model", "fem"],
        ["--model", "long_wave", "--duration", "0.5", "--ramp", "0.2"],
    ],
    ids=lambda it: "-".join(it[1:2]),
)
def test_layer_prints_a_table_without_anything_of_python(
    options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    cells = ["--cells", "32"] if options[1] in ("kdv", "long_wave") else []
    words = printed(capsys, *LAYER, *cells, *options)
    assert not RAW.search(words), words
    for needed in ("382 rpm", "305.6 rpm", "150 mm", "14.99 mm", "0.15 mm"):
        assert needed in words, words


def test_the_numbers_of_layer_are_those_of_its_json(capsys: pytest.CaptureFixture[str]) -> None:
    options = [*LAYER, "--model", "kdv", "--cells", "32"]
    words, answer = printed(capsys, *options), json.loads(printed(capsys, *options, "--json"))
    ratio, offset = (complex(*answer[name]) for name in ("force_ratio", "offset"))
    rows = {row[0]: row[1] for line in words.splitlines() if len(row := re.split(r"  +", line.strip())) == 2}
    size, _, angle = rows["Force coefficient"].partition(" at ")
    assert math.isclose(float(size), abs(ratio), rel_tol=5.1e-4)  # four digits
    assert angle == "0 deg from the deflection"
    assert math.isclose(float(rows["Centre of mass"].split()[0]), abs(offset) * 1e3, rel_tol=5.1e-4)
    assert rows["Converged"] == "yes" and rows["Model in range"] == "yes"


@pytest.mark.parametrize(
    "arguments",
    [
        ["explain", "examples/centrifuge.toml"],
        ["volume", "--radius", "65 mm", "--height", "20 mm", "--eccentricity", "1 mm", "--speed", "1000 rpm"],
    ],
    ids=lambda it: it[0],
)
def test_words_are_for_people(arguments: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    words = printed(capsys, *arguments)
    assert not re.search(r"\bTrue\b|\bFalse\b|\bNone\b|\bnan\b|e\+\d\d", words), words


def test_small_and_large_machines_are_in_their_units(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A hundredth of the unbalance moves a hundredth: micrometres in table, figure and report alike."""
    words = run(capsys, "centrifuge", tmp_path, 'unbalance = "1.5 kg*mm"', 'unbalance = "150 kg*mm"')
    assert "Largest amplitude (um 0-p" in words
    assert "(um 0-p)" in (tmp_path / "amplitude.svg").read_text(encoding="utf-8")
    page = (tmp_path / "summary.html").read_text(encoding="utf-8")
    assert "Largest amplitude (um 0-p" in page and not re.search(r"\b0\.0\d+ mm", page)


def test_the_plane_of_a_sweep_is_named(tmp_path: Path) -> None:
    (tmp_path / "study.toml").write_text(
        f'scene = "{example_path("two_plane_rig")}"\nmethod = "grid"\n[vary]\n'
        '"rotor.mass" = { linspace = [19.0, 21.0, 2] }\n"speeds.start" = { choice = ["1000 rpm"] }\n',
        encoding="utf-8",
    )
    found = lb.sweep(tmp_path / "study.toml", out=tmp_path, workers=0)
    assert found.plane == "in the plane of chamber 1 at \N{MINUS SIGN}280 mm"
    shown = list(flat(found.blocks(), "text"))
    assert Words(f"Amplitudes are zero to peak, {found.plane}.") in shown
    rows = {row[0]: row for block in shown if isinstance(block, Table) for row in block.rows}
    _, mean, *_, unit = rows["last amplitude"]
    assert unit in ("mm", "um")
    said = float(str(mean)) / {"mm": 1e3, "um": 1e6}[str(unit)]
    assert math.isclose(said, found.outputs["last_amplitude"].mean, rel_tol=5.1e-4)
