"""The one-page summary: its numbers are the record's, it needs nothing else, no text of a user runs in it."""

from __future__ import annotations

import base64
import math
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from meshes.border import InputError
from study import report
from study.record import ChamberRecord, StudyRecord
from tests.study import faults_results as oracles
from tests.study.records import folded, record_of, response_of, rig

VOID = {"meta", "img", "br"}


class Page(HTMLParser):
    """Texts of a page by tag, cells of its tables, addresses it points to; tags must close in order."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.open: list[str] = []
        self.texts: list[tuple[str, str]] = []
        self.rows: list[list[str]] = []
        self.addresses: list[str] = []
        self.tags: set[str] = set()
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.addresses += [str(value) for key, value in attrs if key in ("src", "href", "action", "data")]
        assert not any(key.startswith("on") for key, _ in attrs)
        if tag == "tr":
            self.rows.append([])
        elif tag in ("th", "td"):
            self.rows[-1].append("")
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append((self.open[-1] if self.open else "", data.strip()))
        if self.open and self.open[-1] in ("th", "td"):
            self.rows[-1][-1] += data

    def of(self, tag: str) -> list[str]:
        return [text for found, text in self.texts if found == tag and text]

    @property
    def all_text(self) -> str:
        return " ".join(text for tag, text in self.texts if tag != "style")


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    path = tmp_path / "amplitude.svg"
    path.write_text('<svg xmlns="http://www.w3.org/2000/svg"/>', encoding="utf-8")
    return path


def page_of(record: StudyRecord, directory: Path, figures: dict[str, Path] | None = None) -> Page:
    path = directory / "summary.html"
    report.write_summary(record, figures or {}, path)
    return Page(path.read_text(encoding="utf-8"))


@pytest.mark.parametrize("oracle", [oracles.summary_compares_and_converts, oracles.ranges_name_their_ends])
def test_oracles(oracle):
    oracle()


def test_numbers_on_the_page_are_those_of_the_record(tmp_path: Path):
    record = rig()
    r = record.response
    wet, dry = np.abs(r.deflection) * 1e3, np.abs(r.deflection_dry) * 1e3
    rows = {row[0]: row[1:] for row in page_of(record, tmp_path).rows if row}

    def four(*values: float) -> list[str]:
        return [f"{value:.4g}" for value in values]

    assert rows["Largest amplitude (mm)"] == four(wet.max(), dry.max(), wet.max() / dry.max())
    rpm = r.speed * 30.0 / math.pi
    assert rows["at the speed (rpm)"] == [*four(rpm[wet.argmax()], rpm[dry.argmax()]), ""]
    assert rows["Amplitude at 2000 rpm (mm)"] == four(wet[-1], dry[-1], wet[-1] / dry[-1])
    assert rows["Mass of the liquid"] == [f"{record.liquid_mass * 1e3:.4g} g"]
    assert rows["Critical speed with liquid"] == [f"{record.critical_speed_wet * 30.0 / math.pi:.4g} rpm"]
    assert rows["Critical speed without liquid"] == ["1000 rpm"]
    assert rows["Model out of range"] == ["100 to 347 rpm"]
    assert rows["Dry patch on the wall"] == ["none"]
    angle = math.degrees(r.liquid_angle[-1])
    assert rows["Liquid at 2000 rpm"] == [f"\N{MINUS SIGN}{-angle:.4g} deg from the unbalance"]


def test_page_names_machine_model_notes_and_versions(tmp_path: Path):
    record = rig()
    page = page_of(record, tmp_path)
    assert page.of("h1") == [record.name]
    text = page.all_text
    assert "A rotor with a horizontal axis that carries one chamber with 10 ml of water" in text
    assert "from 100 to 2000 rpm in 201 speeds." in text
    assert "DR18, section 7.2" in text
    assert record.notes[0] in text
    assert record.digest in text
    assert f"numpy {np.__version__}" in text
    assert "paraboloid" in text
    assert set(report.MODELS) == {"statics", "linear", "long_wave", "kdv", "fem"}
    assert all(len(sentences) == 2 for sentences in report.MODELS.values())


def test_inputs_with_assumed_values_marked(tmp_path: Path):
    record = replace(rig(), assumed=("rotor.mass", "chambers.0", "runup.rate"))
    page = page_of(record, tmp_path)
    spans = page.of("span")
    shown = dict(zip(spans[1::2], spans[2::2], strict=True))
    assert list(shown) == [label for label, _, _ in record.inputs]
    for label, value, path in record.inputs:
        marked = path == "rotor.mass" or path.startswith("chambers.0.")
        assert shown[label] == (f"{value} *" if marked else value)
    assert "Also assumed: runup.rate." in page.all_text


def test_several_models_each_with_its_range(tmp_path: Path):
    r = rig().response
    model = np.where(np.arange(201) < 100, "statics", "long_wave")
    text = page_of(record_of(replace(r, model=model)), tmp_path).all_text
    assert "statics (100 to 1040 rpm)." in text
    assert "long_wave (1050 to 2000 rpm)." in text


def test_remarks_come_from_the_numbers():
    record = rig()
    assert report.remarks(record) == list(record.notes)
    below = replace(rig(50, 100.0, 900.0), notes=())
    assert report.remarks(below) == ["The largest amplitude lies at an end of the range of speeds."]
    r = record.response
    doubtful = replace(record, notes=(), response=replace(r, in_range=np.zeros(201, dtype=np.bool_)))
    assert len(report.remarks(doubtful)) == 2
    lost = replace(r, deflection=np.full(201, np.nan + 0j))
    assert report.remarks(replace(record, notes=(), response=lost)) == ["No answer was found at any speed."]


def test_figures_are_inside_the_page(tmp_path: Path, picture: Path):
    page = page_of(rig(), tmp_path, {"Amplitude": picture})
    (address,) = page.addresses
    kind, content = address.split(",")
    assert kind == "data:image/svg+xml;base64"
    assert base64.b64decode(content) == picture.read_bytes()
    with pytest.raises(InputError, match="figures"):
        page_of(rig(), tmp_path, {"Notes": tmp_path / "notes.txt"})


def test_user_text_is_text(tmp_path: Path):
    hostile = "<script>alert('x')</script> \"quoted\" & {{ 7 * 7 }}"
    record = replace(
        rig(),
        name=hostile,
        source=hostile,
        notes=(hostile,),
        assumed=(hostile,),
        inputs=((hostile, hostile, "rotor.mass"),),
        chambers=(ChamberRecord(0.065, 0.0, 0.02, 1e-5, hostile, 0.06),),
    )
    page = page_of(record, tmp_path)
    assert "script" not in page.tags
    assert page.of("h1") == [hostile]
    assert page.of("li") == [hostile]


def test_unicode_survives_and_control_characters_do_not(tmp_path: Path):
    name = "Ölabscheider \N{CJK UNIFIED IDEOGRAPH-6D17} \N{HEBREW LETTER ALEF} \N{SNOWMAN}"
    page = page_of(replace(rig(), name=f"{name}\x00\x1b\n"), tmp_path)
    assert page.of("h1") == [name]


def test_page_needs_no_network(tmp_path: Path, picture: Path):
    page_of(rig(), tmp_path, {"Amplitude": picture})
    text = (tmp_path / "summary.html").read_text(encoding="utf-8")
    assert "http://" not in text
    assert "https://" not in text
    assert "url(" not in text
    assert "default-src 'none'" in text


def test_more_text_makes_smaller_figures(tmp_path: Path):
    def height(record: StudyRecord) -> float:
        page_of(record, tmp_path)
        text = (tmp_path / "summary.html").read_text(encoding="utf-8")
        return float(text.split("width: 100%; height: ")[1].split("mm")[0])

    long = replace(rig(), notes=tuple(f"Note {i} on the limits of the model." for i in range(12)))
    assert report.FIGURE_HEIGHTS[0] <= height(long) < height(rig()) <= report.FIGURE_HEIGHTS[1]


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
def test_extremes_give_a_page(record: StudyRecord, tmp_path: Path):
    page = page_of(record, tmp_path)
    assert "nan" not in page.all_text.split()
    assert len(page.rows) == 1 + 3 + 8


def test_same_record_same_page(tmp_path: Path, picture: Path):
    texts = []
    for name in ("a", "b"):
        page_of(folded(), tmp_path / name, {"Amplitude": picture})
        texts.append((tmp_path / name / "summary.html").read_bytes())
    assert texts[0] == texts[1]


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
def test_numbers_for_print(value: float, text: str):
    assert report.number(value) == text
