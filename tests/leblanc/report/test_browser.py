"""Reports in a real browser: nothing comes from elsewhere, no complaints, nothing sticks out."""

from __future__ import annotations

from pathlib import Path

import pytest

from leblanc.core.answer import Typed
from leblanc.core.blocks import Picture, flat
from leblanc.core.disk import drawing, write
from leblanc.core.page import write_page
from leblanc.scene.scene import load_scene
from leblanc.studies.run.study import run_scene
from tests.oracles.browser import Browser, found
from tests.oracles.pages import about_record
from tests.oracles.records import awkward_texts, many_chambers, nothing_found

ROOT = Path(__file__).parents[3]
pytestmark = pytest.mark.skipif(found() is None, reason="no Chromium on the path")


@pytest.fixture(scope="module")
def pages(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """A plain machine, one that tilts, and made-up ones with all that makes a page hard to set."""
    folder, files = tmp_path_factory.mktemp("pages"), {}
    for name in ("centrifuge", "horizontal_rig", "tub"):
        scene = load_scene(ROOT / f"examples/{name}.toml")
        found = run_scene(scene)
        object.__setattr__(found, "typed", Typed(command=f"leblanc run {name}.toml"))
        write(found, folder / name, scene)
        files[name] = folder / name / "summary.html"
    for name, record in (
        ("many", many_chambers()),
        ("awkward", awkward_texts()),
        ("nothing", nothing_found()),
    ):
        files[name] = folder / f"{name}.html"
        pictures = (one for one in flat(record.blocks(), "page") if isinstance(one, Picture))
        drawn = {one.name: drawing(record, one, folder / name) for one in pictures}
        write_page(record.title, record.blocks(), about_record(record), drawn, files[name])
    return files


NAMES = ["centrifuge", "tub", "awkward", "many", "nothing"]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("width", [1280, 390])
def test_opens_and_fits(name: str, width: int, tab: Browser, pages: dict[str, Path]) -> None:
    address = pages[name].as_uri()
    tab.open(address, width)
    assert tab.requests() == [address]
    assert tab.complaints() == []
    assert tab.value("document.documentElement.scrollWidth") <= width
    broken = "[...document.images].filter(one => !one.complete || one.naturalWidth === 0).length"
    assert tab.value(broken) == 0
    assert tab.value("document.images.length") in (3, 5, 6)
    # No picture is squeezed: width over height is that of what is shown.
    shapes = "[...document.images].map(one => [one.width / one.height, one.naturalWidth / one.naturalHeight])"
    for shown, wanted in tab.value(shapes):
        assert abs(shown / wanted - 1.0) < 0.02


@pytest.mark.parametrize("name", ["centrifuge", "horizontal_rig"])
def test_a_plain_machine_takes_one_sheet(
    name: str, tab: Browser, pages: dict[str, Path], tmp_path: Path
) -> None:
    tab.open(pages[name].as_uri())
    assert tab.paper(tmp_path / "a4.pdf", "A4") == 1
    assert tab.paper(tmp_path / "letter.pdf", "Letter") == 1


def test_the_browser_sees_what_it_is_here_to_see(tab: Browser, tmp_path: Path) -> None:
    """A page with a script, a picture from elsewhere and a line that sticks out is caught three times."""
    bad = tmp_path / "bad.html"
    bad.write_text(
        "<!DOCTYPE html><title>x</title><img src='missing.png' alt=''><script>console.error('no')</script>"
        "<div style='width: 900px'>x</div>",
        encoding="utf-8",
    )
    tab.open(bad.as_uri(), 400)
    assert len(tab.requests()) == 2 and tab.complaints()
    assert tab.value("document.documentElement.scrollWidth") > 400


def test_no_script_runs_in_a_page(tab: Browser, tmp_path: Path, pages: dict[str, Path]) -> None:
    """Even if one slipped through, the page's own policy stops it and the browser says so."""
    text = pages["nothing"].read_text(encoding="utf-8")
    slipped = tmp_path / "slipped.html"
    slipped.write_text(
        text.replace("</body>", "<script>document.title = 'ran'</script></body>"), encoding="utf-8"
    )
    tab.open(slipped.as_uri())
    assert tab.value("document.title") != "ran"
    assert any("Content Security Policy" in line for line in tab.complaints())
