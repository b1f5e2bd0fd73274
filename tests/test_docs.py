"""The documentation hangs together: contents, links, pictures, citations, the examples that it shows."""

from __future__ import annotations

import ast
import doctest
import importlib
import inspect
import math
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest

from tests.oracles.browser import Browser, found

ROOT = Path(__file__).parent.parent
DOCS = ROOT / "docs"
PAGES = sorted(path for path in DOCS.rglob("*.md"))
_CODE = re.compile(r"```.*?```|`[^`\n]*`", re.DOTALL)
_LINK = re.compile(r"\]\(([^)\s]+)\)")
_CONTENTS = re.compile(r"```\{toctree\}\n(.*?)```", re.DOTALL)


def _module(name: str, folder: str = "docs") -> ModuleType:
    """A module that lies with the pages."""
    sys.path.insert(0, str(ROOT / folder))
    try:
        return importlib.import_module(name)
    finally:
        sys.path.pop(0)


def _slug(title: str) -> str:
    """Anchor of a heading, as GitHub makes it."""
    plain = re.sub(r"[^\w\- ]", "", re.sub(r"[`*$]", "", title).strip().lower())
    return plain.replace(" ", "-")


def _anchors(page: Path) -> set[str]:
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    return {_slug(title) for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}


def test_links_and_pictures_lead_somewhere() -> None:
    lost = []
    for page in [*PAGES, ROOT / "README.md", ROOT / "CHANGELOG.md"]:
        for target in _LINK.findall(_CODE.sub("", page.read_text(encoding="utf-8"))):
            if "://" in target:
                continue
            file, _, anchor = target.partition("#")
            there = (page.parent / file).resolve() if file else page
            if not there.exists() or (anchor and anchor not in _anchors(there)):
                lost.append(f"{page.relative_to(ROOT)}: {target}")
    assert not lost


def _listed() -> set[Path]:
    """Pages that the contents lead to from the index."""
    found, ahead = {DOCS / "index.md"}, [DOCS / "index.md"]
    while ahead:
        page = ahead.pop()
        for block in _CONTENTS.findall(page.read_text(encoding="utf-8")):
            for entry in (line.strip() for line in block.splitlines()):
                if not entry or entry.startswith(":"):
                    continue
                for one in page.parent.glob(
                    f"{entry}.md" if not entry.endswith("*") else f"{entry[:-1]}*.md"
                ):
                    if (page_of := one.resolve()) not in found:
                        found.add(page_of)
                        ahead.append(page_of)
    return found


def test_every_page_is_in_the_contents() -> None:
    assert not {str(p.relative_to(DOCS)) for p in set(PAGES) - _listed()}


def test_contents_name_only_pages_that_exist() -> None:
    lost = []
    for page in PAGES:
        for block in _CONTENTS.findall(page.read_text(encoding="utf-8")):
            for entry in (line.strip() for line in block.splitlines()):
                if entry and not entry.startswith(":") and not entry.endswith("*"):
                    lost += [] if (page.parent / f"{entry}.md").is_file() else [entry]
    assert not lost


def _defined() -> dict[str, set[str]]:
    """Names that each module of the packages defines or hands on at its top level, by its dotted name."""
    found: dict[str, set[str]] = {}
    for package in ("meshes", "fluid", "solvers", "leblanc", "validation"):
        for path in (ROOT / package).rglob("*.py"):
            parts = path.relative_to(ROOT).with_suffix("").parts
            names: set[str] = set()
            for node in ast.parse(path.read_text(encoding="utf-8")).body:
                if isinstance(node, ast.FunctionDef | ast.ClassDef):
                    names.add(node.name)
                elif isinstance(node, ast.Assign):
                    names |= {target.id for target in node.targets if isinstance(target, ast.Name)}
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = names
    return found


def test_what_the_page_on_the_project_names_exists() -> None:
    """Modules, rooms, files, functions, classes; in the table of rooms also what is in the room of a row."""
    defined = _defined()
    anywhere = {name for names in defined.values() for name in names if not name.startswith("_")}

    def exists(name: str, room: str) -> bool:
        dotted, inside = name.replace("/", "."), f"{room}.{name}".replace("/", ".")
        if dotted in defined or inside in defined or (ROOT / room / name).is_dir():
            return True
        module, _, last = dotted.rpartition(".")
        return last in (defined.get(module, set()) if module else anywhere)

    lost, looked_up = [], 0
    for line in (DOCS / "project.md").read_text(encoding="utf-8").splitlines():
        names = [name for name in re.findall(r"`([A-Za-z_][\w./]*)`", line) if not name.startswith("__")]
        room = names[0] if names and line.startswith("| `") else ""
        looked_up += len(names)
        lost += [name for name in names if not exists(name, room)]
    assert not lost
    assert looked_up > 100


def test_every_picture_has_a_recipe_and_a_place_in_the_gallery() -> None:
    figures = _module("figures")
    drawn = [name for recipe in figures.RECIPES for name in recipe.pictures]
    assert len(drawn) == len(set(drawn))
    assert set(drawn) == {path.stem for path in figures.IMAGES.glob("*.png")}
    gallery = (DOCS / "howto" / "view.md").read_text(encoding="utf-8")
    assert set(drawn) == set(re.findall(r"\(\.\./images/(\w+)\.png\)", gallery))
    for recipe in figures.RECIPES:
        assert gallery.count(f"`{recipe.shown()}`") >= len(recipe.pictures)


def test_programs_that_draw_are_there() -> None:
    from typer.main import get_command

    from leblanc.cli import application

    commands = get_command(application()).commands  # type: ignore[attr-defined]
    for recipe in _module("figures").RECIPES:
        first, *rest = recipe.program
        if first == "leblanc":
            assert rest[0] in commands
            assert rest[1].startswith("--") or (ROOT / rest[1]).is_file()
        elif first.endswith(".py"):
            assert (ROOT / first).is_file()
        else:
            assert (ROOT / (first.replace(".", "/") + ".py")).is_file()


def test_pictures_that_differ_are_told_apart(tmp_path: Path) -> None:
    figures = _module("figures")
    from matplotlib.image import imsave

    white = np.ones((40, 50, 3))
    marked = white.copy()
    marked[:10, :25] = 0.0  # 250 of 2000 points
    faint = white - 0.05
    for name, picture in (("white", white), ("marked", marked), ("faint", faint), ("small", white[:20])):
        imsave(tmp_path / f"{name}.png", picture)

    def gap(other: str) -> float:
        return float(figures.difference(tmp_path / "white.png", tmp_path / f"{other}.png"))

    assert gap("white") == gap("faint") == 0.0
    assert math.isclose(gap("marked"), 0.125)
    assert gap("small") == 1.0


def test_every_command_is_written_about() -> None:
    from typer.main import get_command

    from leblanc.cli import application

    text = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    commands = get_command(application()).commands  # type: ignore[attr-defined]
    assert not [name for name in commands if f"leblanc {name}" not in text]


def test_public_names_and_results_are_described_once_with_an_example(tmp_path: Path) -> None:
    import leblanc

    pages = _module("api_pages", "docs/_ext")
    written = pages.write(tmp_path).read_text(encoding="utf-8")
    described = re.findall(r"^\.\. auto(?:function|class):: (\S+)$", written, re.MULTILINE)
    assert len(described) == len(set(described))
    results = [member.full for member in pages.results()]
    assert {"leblanc.core.answer.Answer", "leblanc.studies.run.answer.RunAnswer"} < set(results)
    assert {"leblanc.wings.exciter.answer.ExciterAnswer", "leblanc.studies.map.balls.answer.BallChart"} < set(
        results
    )
    named = {f"leblanc.{name}" for name in leblanc.__all__}
    assert named | {"leblanc.core.answer.Answer"} == set(described)
    assert all(f"``{name.rpartition('.')[2]}``" in written for name in results[1:])
    public = named | set(results)
    bases = {base for member in pages.results() for base in member.bases}
    for name in sorted(public):
        module, _, last = name.rpartition(".")
        if last in bases:  # what results inherit from is no answer itself
            continue
        assert "\nExamples\n---" in inspect.cleandoc(
            getattr(importlib.import_module(module), last).__doc__
        ), name


def _modules_with_examples() -> list[str]:
    """Modules with a docstring that shows a call and what comes back."""
    return sorted(
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for package in ("meshes", "fluid", "solvers", "leblanc", "validation")
        for path in (ROOT / package).rglob("*.py")
        if re.search(r"^ *>>> ", path.read_text(encoding="utf-8"), re.MULTILINE)
    )


@pytest.mark.parametrize("module", _modules_with_examples())
def test_examples_of_the_docstrings(module: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    failed, tried = doctest.testmod(importlib.import_module(module))
    assert tried > 0 and failed == 0


def test_the_page_of_keys_is_up_to_date() -> None:
    """`python docs/_ext/scene_keys.py` writes it."""
    keys = _module("scene_keys", "docs/_ext")
    assert (DOCS / keys.NAME).read_text(encoding="utf-8") == keys.page()


def test_the_page_of_outputs_is_up_to_date() -> None:
    """`python docs/_ext/output_pages.py` writes it."""
    outputs = _module("output_pages", "docs/_ext")
    assert (DOCS / outputs.NAME).read_text(encoding="utf-8") == outputs.page()


def test_products_of_units_are_no_emphasis() -> None:
    cells = re.sub(r"`[^`\n]*`", "", _module("scene_keys", "docs/_ext").page())
    assert "kg\\*mm" in cells and not re.search(r"(?<!\\)\*", cells)


def test_every_key_has_its_line_and_a_meaning() -> None:
    from leblanc.scene.scene import Scene
    from leblanc.scene.schema.paths import tables_of
    from leblanc.studies.sweep.plan import FORMS, KINDS, Study

    keys = _module("scene_keys", "docs/_ext")
    text = (DOCS / keys.NAME).read_text(encoding="utf-8")
    parts = {part for kind in keys.ROTORS for part in tables_of(Scene, kind).values()} | {Study}
    for part in parts:
        for name, field in part.model_fields.items():
            assert field.description and "\n" not in field.description, (part, name)
            assert f"| `{name}` |" in text and field.description in text, (part, name)
    assert FORMS.keys() == KINDS.keys()
    assert all(form in text for form, _ in FORMS.values())


def test_equation_numbers_are_unique_in_a_section() -> None:
    for page in (DOCS / "theory").glob("*.md"):
        for section in page.read_text(encoding="utf-8").split("\n## "):
            tags = re.findall(r"\\tag\{(\w+)\}", section)
            assert len(tags) == len(set(tags)), (page.name, section.partition("\n")[0])


def test_pages_of_models_have_their_parts() -> None:
    wanted = (
        "## Assumptions",
        "## Equations",
        "## Range",
        "## Error",
        "## How to choose it",
        "## Weak spots",
    )
    for page in (DOCS / "models").glob("*.md"):
        if page.stem not in {"overview", "rotors"}:
            text = page.read_text(encoding="utf-8")
            assert not [part for part in wanted if part not in text], page.name


def test_ranges_that_the_pages_show_are_those_of_the_code() -> None:
    from leblanc.liquid.models import WAVE_MODELS

    shown = set()
    for page in PAGES:
        shown |= set(re.findall(r"```\{model-ranges\} (\w+)", page.read_text(encoding="utf-8")))
    assert set(WAVE_MODELS) <= shown


class TestConsole:
    """Commands of the pages; `docs/build.py` runs them all."""

    def test_blocks_parse(self) -> None:
        console = _module("console")
        for name in _module("build").RUN:
            text = (DOCS / name).read_text(encoding="utf-8")
            found = [block for block in console._BLOCK.finditer(text) if block["kind"] == "console"]
            assert text.count("```console\n") == len(found), name
            assert text.count("<!-- console:") == sum(block["mark"] == "console" for block in found), name
            assert all(console.steps(block["body"], words=False) for block in found), name
            files = [block for block in console._BLOCK.finditer(text) if block["mark"] in {"file", "append"}]
            assert text.count("<!-- file:") + text.count("<!-- append:") == len(files), name
            assert all(tomllib.loads(block["body"]) for block in files), name

    def test_commands_and_outputs_are_told_apart(self) -> None:
        found = _module("console").steps("$ one \\\n  --more\nfirst\nsecond\n$ two\n", words=False)
        assert [(one.command, one.shown) for one in found] == [
            ("one \\\n  --more", ("first", "second")),
            ("two", ()),
        ]

    @pytest.mark.parametrize(
        ("shown", "printed", "same"),
        [
            ("peak 22.82 mm", "peak 22.83 mm", True),  # a unit in the last place
            ("peak 22.82 mm", "peak 23.82 mm", False),
            ("peak 0.001 mm", "peak 0.003 mm", False),
            ("error 6.3e-08", "error 6.2e-08", True),
            ("error 6.3e-08", "error 6.3e-07", False),
            ("mass 100.05", "mass 100.1", True),  # a part in a thousand
            ("peak 22.82 mm", "least 22.82 mm", False),
            ("share \N{MINUS SIGN}0.025", "share -0.025", True),
            ("at 3 and 4", "at 3", False),
        ],
    )
    def test_lines(self, shown: str, printed: str, same: bool) -> None:
        assert _module("console").agree([shown], [printed], words=False) is same

    def test_dots_stand_for_any_lines(self) -> None:
        agree = _module("console").agree
        assert agree(["a", "...", "d"], ["a", "b", "c", "d"], words=False)
        assert agree(["a", "..."], ["a"], words=False)
        assert not agree(["a", "...", "d"], ["a", "b"], words=False)
        assert not agree(["a"], ["a", "b"], words=False)

    def test_words_alone(self) -> None:
        agree = _module("console").agree
        assert agree(["took 3 ms"], ["took 900 ms"], words=True)
        assert not agree(["took 3 ms"], ["took 3 s"], words=True)

    def test_a_page_is_run_and_shown_anew(self, tmp_path: Path) -> None:
        console, page = _module("console"), tmp_path / "page.md"
        page.write_text(
            "<!-- file: a.toml -->\n```toml\nx = 1\n```\n\n```console\n$ cat a.toml\nx = 5\n```\n\n"
            "<!-- console: shown -->\n```console\n$ false\n```\n"
        )
        assert len(console.check(page)) == 1
        console.check(page, write=True)
        assert "$ cat a.toml\nx = 1\n" in page.read_text()
        assert console.check(page) == []


class TestDocstrings:
    """Docstrings as they come on the site."""

    @pytest.fixture
    def texts(self) -> ModuleType:
        pytest.importorskip("sphinx")
        sys.path.insert(0, str(DOCS / "_ext"))
        try:
            return importlib.import_module("docstrings")
        finally:
            sys.path.pop(0)

    def test_citations_become_links(self, texts: ModuleType) -> None:
        cited = texts.cited("theory: waves, eq. 5; DR18, eq. 8", {"DR18"})
        assert cited == (
            "[theory: :ref:`waves <theory-waves>`, eq. :ref:`5 <waves-eq-5>`; :cite:label:`DR18`, eq. 8]"
        )

    def test_what_is_no_markup_stays_as_it_is(self, texts: ModuleType) -> None:
        assert texts.plain("(R/a)**2, |w|, u_t", {}, set()) == r"(R/a)\*\*2, \|w\|, u\_t"

    def test_sections(self, texts: ModuleType) -> None:
        lines = [
            "What it does.",
            "",
            "Parameters",
            "----------",
            "a, b : lengths, m",
            "    of both",
            "c : a mass",
        ]
        found = "\n".join(
            texts.converted(lines, {"a": "float", "b": "float", "c": "Mass"}, {"Mass": "x.Mass"}, set())
        )
        assert "**a**, **b** \N{EN DASH} ``float``\n   lengths, m\n   of both" in found
        assert "**c** \N{EN DASH} :py:obj:`Mass <x.Mass>`\n   a mass" in found

    def test_keys_in_pages_become_links_but_not_in_code(self, texts: ModuleType) -> None:
        linked = texts.linked("see [DR18, eq. 8], `[DR18]` and [X99]", {"DR18"})
        assert linked == "see [{cite:label}`DR18`, eq. 8], `[DR18]` and [X99]"


@pytest.fixture(scope="module")
def site(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """All that makes a page hard to set, by the configuration, extensions and styles of our site."""
    for name in ("sphinx", "furo", "myst_parser", "sphinxcontrib.bibtex"):
        pytest.importorskip(name)
    source = tmp_path_factory.mktemp("site") / "docs"
    for name in ("_ext", "_static"):
        shutil.copytree(DOCS / name, source / name, ignore=shutil.ignore_patterns("__pycache__"))
    (source / "images").mkdir()
    shutil.copyfile(DOCS / "conf.py", source / "conf.py")
    shutil.copyfile(ROOT / "references.bib", source.parent / "references.bib")
    figures = _module("figures")
    picture = figures.IMAGES / "horizontal_rig_amplitude.png"
    for name in ("view_washing_machine", "trade_runup"):
        shutil.copyfile(picture.with_stem(name), source / "images" / f"{name}.png")
    words = " ".join(["words"] * 20)
    numbers = "|".join(["123456.789"] * 12)
    (source / "index.md").write_text(
        "# Front\n\n```{toctree}\nhowto/view\ncommands\n```\n\n"
        "| Key | Unit | Meaning |\n|---|---|---|\n"
        f"| `a_long_name` | kg\\*m | {words} |\n| `b` |  | b |\n\n"
        f"|{numbers}|\n{'|---' * 12}|\n|{numbers}|\n\n"
        'As "65 mm" with --json.\n\n'
        f"```text\n{words}\n```\n\n$$ {'+ x^2 ' * 60} \\tag{{1}} $$\n\n"
        "[![wide](images/trade_runup.png)](images/trade_runup.png)\n",
        encoding="utf-8",
    )
    cards = "".join(
        f"![What {name} shows](../images/{name}.png)\n\n"
        f"What is seen ([page](../index.md)): `leblanc view {name}`\n\n"
        for name in ("view_washing_machine", "trade_runup")
    )
    (source / "howto").mkdir()
    view = source / "howto" / "view.md"
    view.write_text(f"# Views\n\n## Gallery\n\n### Machines\n\n{cards}", encoding="utf-8")
    # Names as long fill two columns of the index.
    names = [f"```{{py:function}} a_name_of_a_function_as_long_as_any_{k}()\n```" for k in range(4)]
    cited = "```{bibliography}\n:all:\n:style: keyed\n```"
    api = _module("api_pages", "docs/_ext")
    speeds = api.Member("Speeds", "autoclass", "", "leblanc.scene.scene.Speeds")
    model = "\n".join(["```{eval-rst}", *api._described(speeds), "```"])
    text = "\n\n".join(["# Commands", "```{all-commands}\n```", "## Functions", *names, model, cited])
    (source / "commands.md").write_text(text, encoding="utf-8")
    out = source.parent / "site"
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(source), str(out)]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr
    return out


class TestProofreading:
    """What `docs/proofread.py` finds on built pages, and that it finds nothing on ours."""

    @pytest.mark.parametrize(
        "shown",
        [
            "<td>a ** b</td>",
            "<p>a `name`</p>",
            "<td>where $x$ is</td>",
            r"<p>\(x\)</p>",
            "<td>{cite:label}`DR18`</td>",
            "<p>[page](page.md)</p>",
            "<p>[pydantic.config.ConfigDict][]</p>",
            "<td>0.6 kg<em>mm (a plain number is in kg</em>m)</td>",
            "<img src='x.png'>",
            "<img src='x.png' alt='../x.png'>",
        ],
    )
    def test_markup_that_shows_is_found(self, shown: str) -> None:
        assert _module("proofread").leaks(f"<html><title>x</title><body>{shown}</body></html>")

    @pytest.mark.parametrize(
        "shown",
        [
            "<code>**kwargs</code>",
            "<pre>cost $x</pre>",
            r'<span class="math notranslate">\(x\)</span>',
            '<dt class="sig sig-object">f(<span>**</span>kwargs)</dt>',
            "<p>so <em>much</em> liquid, kg*m^2, c_x y^2</p>",
            "<p>one<br>two <img alt='x'> three</p><script>$('`')</script>",
        ],
    )
    def test_what_is_no_markup_is_passed_over(self, shown: str) -> None:
        assert not _module("proofread").leaks(f"<html><title>x</title><body>{shown}</body></html>")

    @pytest.mark.parametrize(
        ("body", "wide"),
        [
            ("<p>short</p>", 390),
            ("<div style='width: 500px'>x</div>", 500),
            # The window stays, all that is in it moves: nobody scrolls a page of text sideways to read it.
            ("<div class='content' style='overflow-x: auto'><div style='width: 500px'>x</div></div>", 500),
            ("<div class='content' style='overflow-x: hidden'><div style='width: 500px'>x</div></div>", 500),
            ("<div style='overflow-x: auto'><div style='width: 500px'>x</div></div>", 390),
        ],
    )
    def test_a_page_that_is_too_wide_is_found(
        self, body: str, wide: int, tab: Browser, tmp_path: Path
    ) -> None:
        page = tmp_path / "page.html"
        page.write_text(f"<!DOCTYPE html><body style='margin: 0'>{body}</body>", encoding="utf-8")
        assert _module("proofread").width(tab, page) == wide

    def test_our_pages_fit_a_telephone_and_show_no_markup(self, site: Path) -> None:
        if found() is None:
            pytest.skip("no Chromium on the path")
        assert _module("proofread").faults(site) == []

    def test_what_is_shown_can_be_typed(self, site: Path) -> None:
        """In a file and on a command line quotes are straight, and options begin with two hyphens."""
        from html import unescape

        page = unescape((site / "index.html").read_text(encoding="utf-8"))
        assert 'As "65 mm" with --json.' in page

    def test_words_of_a_table_become_cards_and_numbers_stay_a_table(self, site: Path, tab: Browser) -> None:
        tables = "[...document.querySelectorAll('table.docutils')].map(t => getComputedStyle(t).display)"
        _module("proofread").width(tab, site / "index.html")
        assert tab.value(tables) == ["block", "table"]
        cell = "document.querySelector('.cards tbody tr td:nth-child(%d)')"
        assert tab.value(f"getComputedStyle({cell % 2}, '::before').content") == '"Unit: "'
        empty = "getComputedStyle(document.querySelector('.cards td.empty')).display"
        assert tab.value(empty) == "none"
        tab.open((site / "index.html").as_uri(), 1280)
        assert tab.value(tables) == ["table", "table"]

    def test_gallery_is_a_grid_of_thumbnails(self, site: Path, tab: Browser) -> None:
        from PIL import Image

        page = site / "howto" / "view.html"
        _module("proofread").width(tab, page)
        columns = "getComputedStyle(document.querySelector('.gallery')).gridTemplateColumns.split(' ').length"
        assert tab.value(columns) == 2
        shown = "map(i => [i.getAttribute('src'), i.alt, i.loading])"
        cards = tab.value(f"[...document.querySelectorAll('.gallery img')].{shown}")
        assert [alt for _, alt, _ in cards] == ["What view_washing_machine shows", "What trade_runup shows"]
        for place, _, loading in cards:
            whole = site / "_images" / f"{Path(place).stem}.png"
            assert loading == "lazy" and 10 * (page.parent / place).stat().st_size < 9 * whole.stat().st_size
            with Image.open(page.parent / place) as small:
                assert small.width <= 480 and small.height <= 360
        links = "[...document.querySelectorAll('.gallery .card a')].map(a => a.getAttribute('href'))"
        assert tab.value(links) == [
            *("../_images/view_washing_machine.png", "../index.html"),
            *("../_images/trade_runup.png", "../index.html"),
        ]
        commands = "[...document.querySelectorAll('.gallery .command')].map(p => p.textContent)"
        assert tab.value(commands) == ["leblanc view view_washing_machine", "leblanc view trade_runup"]

    def test_every_option_stands_in_the_reference(self, site: Path) -> None:
        from html import unescape

        from typer.main import get_command

        from leblanc.cli import application

        page = unescape(re.sub(r"<[^>]+>", "", (site / "commands.html").read_text(encoding="utf-8")))
        commands = get_command(application()).commands  # type: ignore[attr-defined]
        for name, command in commands.items():
            assert f"leblanc {name}" in page
            names = [(param.opts or param.secondary_opts)[-1] for param in command.params]
            options = [name for name in names if name.startswith("-")]
            assert not [name for name in options if name not in page]
            assert not [param.name for param in command.params if param.help and param.help not in page]


class TestExamples:
    """What the page on contributing shows."""

    def test_a_frozen_liquid_is_dead_weight(self) -> None:
        try:
            frozen, heavier = _module("frozen_liquid", "docs/examples").answers()
        finally:
            sys.modules.pop("frozen_liquid", None)
        # The balance of the wet rotor is solved to 1e-12 of the deflection, amplified near resonance by
        # 1/(2 zeta) = 8.
        assert np.allclose(frozen.deflection, heavier.deflection, rtol=1e-10, atol=0.0)
        assert frozen.converged.all()

    def test_uneven_supports_have_two_critical_speeds(self) -> None:
        from solvers.rotor.vibration import modes, unbalance_response

        rotor = _module("uneven_supports", "docs/examples").ROTOR
        natural = modes(rotor.system(), damped=False).eigenvalue[0].imag
        stiff = np.array([rotor.sideways, rotor.upwards])
        assert np.allclose(natural, np.sqrt(stiff / rotor.mass), rtol=1e-12)
        speed = np.array([20.0, 45.0, 90.0])
        plane = stiff - rotor.mass * speed[:, None] ** 2 + 1j * rotor.damping * speed[:, None]
        force = rotor.unbalance * speed[:, None] ** 2 * np.array([1.0, -1j])
        assert np.allclose(unbalance_response(rotor.system(), speed), force / plane, rtol=1e-12)

    def test_the_smallest_scene_runs(self) -> None:
        from leblanc.scene.scene import load_scene
        from leblanc.studies.run.study import run_scene

        record = run_scene(load_scene(DOCS / "examples" / "smallest_scene.toml"))
        answer = record.response
        # w = U/(M + m_f - K/Omega^2) without damping, which takes (2 zeta r/(r^2 - 1))^2/2 = 0.9 %
        # at r = 2, zeta = 0.1; no wall is dry, the 0.18 mm are less than the depth of 1.2 mm.
        full = math.pi * 0.065**2 * 0.02 * 998.2
        expected = 6e-4 / (4.0 + full - 4.0 * (1000.0 / 2000.0) ** 2)
        assert math.isclose(abs(answer.deflection[-1]), expected, rel_tol=0.01)

    def test_code_in_the_pages_runs(
        self, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        monkeypatch.chdir(ROOT)
        text = (DOCS / "howto" / "python.md").read_text(encoding="utf-8")
        blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
        for block in blocks:
            exec(compile(block, "python.md", "exec"), {})
        assert len(capsys.readouterr().out.splitlines()) == len(blocks) == 7


def test_kept_measurements_are_those_that_the_page_tables(tmp_path: Path) -> None:
    from validation.benchmarks.report import cheapest, duration, keep, kept_results

    page = (DOCS / "accuracy.md").read_text(encoding="utf-8")
    rows = page.partition("| cheapest within the error |")[2].partition("\n\n")[0].splitlines()[2:]
    results = kept_results()
    assert len(rows) == 4
    for row in rows:
        _, asked, ours, others, _ = row.split("|")
        target = float(asked.rpartition(", ")[2])
        held = []
        for section in results.sections:
            found = {
                code: cheapest(section.samples, code, target)
                for code in dict.fromkeys(sample.code for sample in section.samples)
            }
            shown = {code: "not" if best is None else duration(best.seconds) for code, best in found.items()}
            held.append(
                target == section.target
                and ours.strip().startswith(f"{shown.pop('leblanc', '')} (")
                and all(f"{code} {time}" in others for code, time in shown.items() if time != "not")
            )
        assert held.count(True) == 1, row
    text = (ROOT / "validation" / "benchmarks" / "results.json").read_text(encoding="utf-8")
    assert keep(results, tmp_path).read_text(encoding="utf-8") == text


def test_kept_comparisons_are_read_as_they_were_written() -> None:
    from validation.trade import kept, names, recompute
    from validation.trade.results import trade_json

    for name in names():
        read, before = trade_json(recompute.record(name)), kept(name)
        # A file may say more: where errors of some rows are newer than their times.
        assert before["remark"].startswith(read["remark"])
        same = [key for key in read if key not in ("versions", "remark")]
        assert {key: read[key] for key in same} == {key: before[key] for key in same}
