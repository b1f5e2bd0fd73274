"""A report opens with a sentence of result, one of doubt, and the day on which it was made."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

import leblanc as lb
from leblanc.cli import main
from leblanc.core.blocks import Check, Grade
from leblanc.core.page import doubt, made_on
from leblanc.studies.run.words import answer, checks

COMMANDS = {
    "run": (["run", "{scene}"], "summary.html"),
    "map": (["map", "{scene}", "--volumes", "3", "--speeds", "8"], "map.html"),
    "optimise": (["optimise", "{scene}", "--no-front"], "optimise.html"),
    "runup": (["runup", "{runup}", "--cells", "16", "--no-check"], "runup.html"),
    "exciter": (["run", "{table}"], "summary.html"),
}


def scene(name: str, folder: Path) -> str:
    """An example with few speeds and a short run-up."""
    content = Path(f"examples/{name}.toml").read_text(encoding="utf-8")
    content = re.sub(r"^count = \d{3}", "count = 9", content, flags=re.MULTILINE)
    path = folder / f"{name}.toml"
    path.write_text(content.replace('duration = "14 s"', 'duration = "2 s"'), encoding="utf-8")
    return str(path)


@pytest.mark.usefixtures("undrawn", "_exciter_once")
@pytest.mark.parametrize("command", COMMANDS)
def test_every_report_opens_with_result_doubt_and_date(
    command: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1600000000")
    arguments, report = COMMANDS[command]
    names = {"scene": "centrifuge", "runup": "runup", "table": "vibratory_table"}
    given = [word.format(**{k: scene(v, tmp_path) for k, v in names.items()}) for word in arguments]
    assert main([*given, "--out", str(tmp_path)]) == 0
    page = (tmp_path / report).read_text(encoding="utf-8")
    opening = page.partition("<section")[0]
    (said,) = re.findall(r'<p class="answer">(.+?)</p>', opening)
    (doubted,) = re.findall(r'<p class="doubt">(.+?)</p>', opening)
    assert said.endswith(".") and doubted.endswith(".")
    # What is doubted is what the table of limits marks.
    assert doubted.startswith("Caution: ") == ('class="warning"' in page.partition("<section")[2])
    assert '<time datetime="2020-09-13">2020-09-13</time>' in opening  # 1 600 000 000 s after 1970, in UTC


def test_the_doubt_names_the_two_gravest_limits_and_counts_the_rest() -> None:
    """Two clauses at most, each with its speeds as the table has them, of what touches the headline."""
    result = lb.run(lb.example("tub"))
    every = checks(result)
    failed = {check.label: check.where for check in every if check.grade > Grade.NOTE}
    assert len(failed) > 2 and len(failed) < sum(check.grade > 0 for check in every)
    out, loose = (
        failed[name] for name in ("Liquid model out of range", "No annular layer (gravity dominates)")
    )
    wanted = f"Caution: liquid model out of range: {out}; no annular layer (gravity dominates): {loose} "
    assert doubt(every) == f"{wanted}({len(failed) - 2} more under the limits)."
    aside = [check for check in every if check.grade <= Grade.NOTE]
    said = doubt(aside, "2 % at the largest amplitude")
    assert (
        said == "No limit of the models touches these figures; estimated error 2 % at the largest amplitude."
    )


def test_up_to_two_limits_are_all_told() -> None:
    names, bad = (
        ("Wall dry in part", "Liquid model out of range", "Error above 1 %"),
        ("100 rpm", Grade.WARNING),
    )
    rows = [Check(name, *(bad if k != 1 else ("none",))) for k, name in enumerate(names)]
    assert doubt(rows[:2]) == "Caution: wall dry in part: 100 rpm."
    assert doubt(rows) == "Caution: error above 1 %: 100 rpm; wall dry in part: 100 rpm."


@pytest.mark.parametrize("volume", ["0 ml", "10 ml"])
@pytest.mark.parametrize("count", [1, 21])
def test_an_amplitude_without_a_bound_is_told_as_a_person_would(volume: str, count: int) -> None:
    """Without damping the dry rotor has none at its critical speed, which is one of the speeds here."""
    speeds = {"speeds.start": "1000 rpm", "speeds.stop": "1000 rpm" if count == 1 else "2000 rpm"}
    undamped = {"rotor.damping_ratio": 0.0, "rotor.critical_speed": "1000 rpm", "speeds.count": count}
    scene = lb.example("horizontal_rig").replace(
        {**undamped, **speeds, "chambers.0.volume": volume, "chambers.1.volume": volume}
    )
    said = answer(lb.run(scene))
    assert "grows without bound" in said and "infinite" not in said and "bound at most" not in said
    if volume == "0 ml":
        assert said == "Without liquid the amplitude grows without bound at 1000 rpm."


def test_no_doubt_where_nothing_is_passed() -> None:
    calm = [Check("Not converged", "none")]
    assert doubt(calm) == "No limit of the models is passed."
    assert doubt(calm, "at most 0.05 %").endswith("passed; estimated error at most 0.05 %.")


def test_a_result_without_an_answer_says_so() -> None:
    result = lb.run(lb.example("horizontal_rig").replace({"speeds.count": 3}))
    assert result.refined is not None
    given, between = (
        replace(r, deflection=r.deflection * float("nan")) for r in (result.response, result.refined)
    )
    assert answer(replace(result, response=given, refined=between)) == "No answer was found at any speed."
    # Without an answer at the speeds of the scene the largest amplitude, between them, is still told.
    told = answer(replace(result, response=given))
    assert "largest amplitude is 0.7166 mm at 1009 rpm with the liquid" in told
    assert told.endswith("without; at 2000 rpm no answer was found with the liquid; without it is 0.2051 mm.")


def test_data_and_figures_do_not_know_the_day(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The same scene on two days: every file but the report is the same, byte for byte.

    So is what the record of the folder says of every other file.
    """
    path, files = scene("centrifuge", tmp_path), []
    for seconds in ("1600000000", "1700000000"):
        monkeypatch.setenv("SOURCE_DATE_EPOCH", seconds)
        out = tmp_path / seconds
        assert main(["run", path, "--out", str(out)]) == 0
        files.append({file.name: file.read_bytes() for file in out.iterdir()})
    first, second = files
    assert {name for name in first if first[name] != second[name]} == {"summary.html", "contents.json"}
    changed = second["summary.html"].replace(b"2023-11-14", b"2020-09-13")
    assert changed == first["summary.html"]
    # The record holds the checksum of the report.
    records = [json.loads(each["contents.json"]) for each in files]
    sums = [record["made"]["run"]["files"].pop("summary.html") for record in records]
    assert records[0] == records[1] and sums[0] != sums[1]


@pytest.mark.parametrize("given", ["", "today", "-1", "9" * 30])
def test_what_is_no_epoch_is_passed_over(given: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("SOURCE_DATE_EPOCH", given)
    assert re.fullmatch(r"20\d\d-[01]\d-[0-3]\d", made_on())
