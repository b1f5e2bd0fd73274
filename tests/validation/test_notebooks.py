"""The notebooks as texts: what each must say, what it may import, and that it ends by asserting its cases."""

from __future__ import annotations

import ast
import base64
import importlib
import json
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import pytest

from leblanc.cli import exit_code
from tests.mutants import kills
from validation import run_notebooks
from validation.page import Picture, Table
from validation.run_notebooks import texts

ROOT = Path(__file__).parents[2]
PACKAGES = {"numpy", "scipy", "meshes", "fluid", "solvers", "leblanc", "validation"}
SECTIONS = ("## Who measured or printed what", "## Assumed", "## What does not agree", "## Asserted")
NOTEBOOKS = texts()


@dataclass(frozen=True)
class Notebook:
    """A notebook by its cells, comment marks taken off the text."""

    head: str
    words: list[str]
    code: list[str]


def read(path: Path) -> Notebook:
    head, *cells = re.split(r"^# %%", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    words = [cell for cell in cells if cell.startswith(" [markdown]\n")]
    code = [cell.partition("\n")[2] for cell in cells if not cell.startswith(" [markdown]")]
    plain = ["\n".join(line.removeprefix("#")[1:] for line in one.splitlines()[1:]).strip() for one in words]
    return Notebook(head, plain, code)


def test_they_are_numbered_in_their_order() -> None:
    numbers = [int(path.stem.partition("_")[0]) for path in NOTEBOOKS]
    assert numbers == list(range(1, len(NOTEBOOKS) + 1)) and len(numbers) >= 10


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_header_belongs_to_no_machine(path: Path) -> None:
    head = read(path).head
    assert "format_name: percent" in head and "name: python3" in head
    assert not re.search(r"jupytext_version|argv|/|\\", head)


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_says_what_a_reader_must_know(path: Path) -> None:
    book = read(path)
    title, *rest = book.words[0].splitlines()
    assert title.startswith(f"# {path.stem.partition('_')[0]}. ")
    lines = [line for words in (*rest, *book.words[1:]) for line in words.splitlines()]
    assert not [line for line in lines if line.startswith("# ")]
    places = [lines.index(section) for section in SECTIONS]
    assert places == sorted(places)
    # Something stands below each heading but the last, below which is code.
    for section, place in zip(SECTIONS[:-1], places, strict=False):
        below = next(line for line in lines[place + 1 :] if line.strip())
        assert not below.startswith("#"), section


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_text_is_plain_markdown(path: Path) -> None:
    text = "\n\n".join(read(path).words)
    bare = re.sub(r"`[^`\n]*`", "", text)
    assert not re.search(r"</?[a-zA-Z][^>]*>", bare), "HTML"
    assert not re.search(r"\]\(\s*/|https?://", text), "a link away from the project"
    # A page on its own has nothing that sets formulas: without a network `$` would stand in the text.
    assert "$" not in bare and "\\" not in bare, "TeX"
    for page in re.findall(r"`((?:docs|examples|validation)/[\w/.]+\.\w+)`", text):
        # One of the pages is in the repository that a measurement comes from.
        assert (ROOT / page).exists() or page == "docs/balance_ring_analysis.md", page


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_sources_are_known(path: Path) -> None:
    keys = set(re.findall(r"@\w+\{(\w+),", (ROOT / "references.bib").read_text(encoding="utf-8")))
    cited = set(re.findall(r"\[([A-Z]{2}\d{2})[\],]", "\n".join(read(path).words)))
    assert cited <= keys


def _names(code: str) -> set[str]:
    return {n.attr if isinstance(n, ast.Attribute) else n.id for n in ast.walk(ast.parse(code))
            if isinstance(n, ast.Attribute | ast.Name)}  # fmt: skip


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_calls_public_functions_of_the_packages(path: Path) -> None:
    code = "\n".join(read(path).code)
    tree = ast.parse(code)
    assert not [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef | ast.ClassDef)]
    assert not [name for name in _names(code) if name.startswith("_") and name != "_"]
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            modules = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            modules = [node.module or ""]
            assert not [alias.name for alias in node.names if alias.name.startswith("_")]
        else:
            continue
        assert all(m.partition(".")[0] in PACKAGES | sys.stdlib_module_names for m in modules), modules


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_ends_by_asserting_its_cases(path: Path) -> None:
    """Each list of cases that is shown is asserted in the last cell, by the verdicts."""
    book = read(path)
    whole = "\n".join(book.code)
    tabled = re.findall(r"^case_table\((\w+)\)", whole, flags=re.MULTILINE)
    assert tabled
    last = ast.parse(book.code[-1])
    assert isinstance(last.body[-1], ast.Assert)
    asserted = {
        call.args[0].id
        for call in ast.walk(last)
        if isinstance(call, ast.Call)
        and isinstance(call.func, ast.Name)
        and call.func.id == "verdicts"
        and isinstance(call.args[0], ast.Name)
    }
    assert set(tabled) <= asserted


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_jupytext_reads_the_same_cells(path: Path) -> None:
    jupytext = pytest.importorskip("jupytext")
    cells = jupytext.read(path, fmt="py:percent").cells
    book = read(path)
    assert [one.source for one in cells if one.cell_type == "markdown"] == book.words
    assert len([one for one in cells if one.cell_type == "code"]) == len(book.code)


def test_pages_show_no_markup_need_no_network_and_fit_a_telephone(tmp_path: Path) -> None:
    """The text of each notebook, with tables and long code as cells have them; nothing is run."""
    for module in ("jupytext", "nbconvert"):
        pytest.importorskip(module)
    import jupytext
    from nbformat.v4 import new_code_cell, new_output

    sys.path.insert(0, str(ROOT / "docs"))
    try:
        proofread = importlib.import_module("proofread")
    finally:
        sys.path.pop(0)
    names = tuple(f"column {k}" for k in range(9))
    tables = (
        Table(("what", *names), (("words " * 20, *(["123456.789"] * 9)),), "a foot"),
        Table(names, ((["123456.789"] * 9),)),
    )
    file = ROOT / "docs" / "images" / "exciter_table.png"
    image, about = Picture(file.read_bytes(), 693, "Vibratory table")._repr_png_()
    png = {"image/png": base64.b64encode(image).decode()}
    for path in NOTEBOOKS:
        book = jupytext.read(path, fmt="py:percent")
        shown = [new_output("display_data", {"text/html": table._repr_html_()}) for table in tables]
        shown.append(new_output("display_data", png, metadata={"image/png": about}))
        book.cells.append(new_code_cell("x = " + "1 + " * 60 + "1", outputs=shown))
        run_notebooks.write_pages(book, path.stem, tmp_path)
        page = (tmp_path / f"{path.stem}.html").read_text(encoding="utf-8")
        assert 'alt="Vibratory table"' in page and "<script" not in page
        assert not re.search(r"""(src|href)=["']https?:""", page)
    assert len(list(tmp_path.glob("*.html"))) == len(NOTEBOOKS)
    assert proofread.faults(tmp_path) == []


@kills("validation.run_notebooks:_complaints", 'output.name == "stderr"', 'output.name == "stdout"')
@kills("validation.run_notebooks:_complaints", "if _TOLD.search(written)", "if written")
def test_warnings_and_errors_are_complaints_and_log_lines_are_none() -> None:
    def told(text: str, name: str = "stderr") -> str:
        output = SimpleNamespace(output_type="stream", name=name, text=text)
        cell = SimpleNamespace(cell_type="code", outputs=[output])
        return run_notebooks._complaints(SimpleNamespace(cells=[cell]))

    for text in (
        "/a/b.py:12: DeprecationWarning: old\n  f()\n",
        "going on\nTraceback (most recent call last):\n  File x\n",
        "Exception ignored in: <function f>\nValueError: no\n",
    ):
        assert told(text) == text and told(text, "stdout") == ""
    # As py-pde logs where the first step, which compiles, or a busy machine takes long.
    for text in ("pde.solvers.controller: Simulation was slow\n", "100%|####| 3.0/3.0\n", "Errors: none\n"):
        assert told(text) == ""


def test_without_the_extra_its_name_is_said(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(run_notebooks, "find_spec", lambda name: None)
    assert exit_code(lambda: run_notebooks.notebooks(["1_paraboloid"], tmp_path)) == 2
    assert "leblanc[notebooks]" in capsys.readouterr().err
    assert exit_code(lambda: run_notebooks.notebooks(["99_nothing"], tmp_path)) == 2
    assert "8_accuracy_and_cost" in capsys.readouterr().err


def test_what_the_command_tells_programs(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """All are executed though one fails, and that one makes the exit code."""
    monkeypatch.setattr(run_notebooks, "require_jupyter", lambda: None)
    monkeypatch.setattr(
        run_notebooks, "execute", lambda path, out: "a claim" if path.stem == "2_wave" else ""
    )
    assert exit_code(lambda: run_notebooks.notebooks(None, tmp_path, json=True)) == 1
    printed = capsys.readouterr()
    told = json.loads(printed.out)["notebooks"]
    assert [one["name"] for one in told] == [path.stem for path in NOTEBOOKS]
    assert [one["name"] for one in told if not one["passed"]] == ["2_wave"] and printed.err == "a claim\n"
    assert exit_code(lambda: run_notebooks.notebooks(["3_rigs"], tmp_path)) == 0
