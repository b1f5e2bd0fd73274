"""The notebooks for users: imports, question, decision, and a run of each with figures fit to be read."""

from __future__ import annotations

import ast
import json
import re
from pathlib import Path

import numpy as np
import pytest

from tests.validation.test_notebooks import read
from validation import run_notebooks
from validation.run_notebooks import FOLDER, FOR_USERS

PATHS = [FOLDER / "users" / f"{name}.py" for name in FOR_USERS]
EACH = pytest.mark.parametrize("path", PATHS, ids=lambda path: path.stem)
# Stands before each figure is shown: axes with names and units, few entries.
FIGURE = """\
_named = [axes for axes in plt.gcf().axes if axes.get_ylabel()]
assert len(_named) == len(plt.gcf().axes) and any(axes.get_xlabel() for axes in _named)
for _axes in _named:
    assert len(_axes.get_legend_handles_labels()[1]) <= 5
    for _label in (_axes.get_xlabel(), _axes.get_ylabel()):
        assert not _label or "(" in _label or _label == "uncertain value", _label
plt.show()
"""


def test_the_command_knows_those_in_the_folder() -> None:
    assert sorted(FOR_USERS) == sorted(path.stem for path in (FOLDER / "users").glob("*.py"))
    assert run_notebooks._text(FOR_USERS[0]) == PATHS[0]
    assert not {path.stem for path in run_notebooks.texts()} & set(FOR_USERS)


@EACH
def test_imports_what_a_user_has_and_names_no_path(path: Path) -> None:
    code = "\n".join(read(path).code)
    found = set()
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        assert not isinstance(node, ast.ImportFrom)
        assert not (isinstance(node, ast.Attribute) and re.match("_[^_]", node.attr))
    assert found == {"leblanc", "numpy", "matplotlib.pyplot"}
    assert not re.search(r"examples/|validation|docs/|\.\./", code)


@EACH
def test_asks_at_the_top_and_decides_at_the_end(path: Path) -> None:
    book = read(path)
    assert book.words[0].startswith("# ") and "**Question.**" in book.words[0]
    assert book.words[-1].endswith("## Decision") and "## What this does not say" in book.words[-1]
    assert sum(len(words.split()) for words in book.words) <= 900
    shows, captions = (
        sum(text.count(what) for text in texts)
        for texts, what in ((book.code, "plt.show()"), (book.words, "Figure: "))
    )
    assert shows == captions >= 2


@EACH
def test_no_number_of_the_decision_is_typed(path: Path) -> None:
    """The last cell prints; digits stand in what is computed and in formats alone."""
    (*_, last) = ast.parse(read(path).code[-1]).body
    assert isinstance(last, ast.Expr) and isinstance(last.value, ast.Call)
    assert isinstance(last.value.func, ast.Name) and last.value.func.id == "print"
    typed, values = [], 0
    for text in last.value.args:
        parts = text.values if isinstance(text, ast.JoinedStr) else [text]
        values += sum(isinstance(part, ast.FormattedValue) for part in parts)
        typed += [part.value for part in parts if isinstance(part, ast.Constant)]
        # What is computed has a name in it: a bare number would be typed after all.
        assert all(
            any(isinstance(node, ast.Name) for node in ast.walk(part.value))
            for part in parts
            if isinstance(part, ast.FormattedValue)
        )
    assert values >= 5 and not re.search(r"\d", "".join(map(str, typed)))


def test_the_measurement_is_the_one_that_is_kept() -> None:
    code = "\n".join(read(FOLDER / "users" / "machine_fitted.py").code)
    (typed,) = re.findall(r"^measured = (.*)$", code, flags=re.MULTILINE)
    kept = json.loads((FOLDER.parent / "data" / "dr18_fig24.json").read_text(encoding="utf-8"))
    speed, angle = np.array(ast.literal_eval(typed)).T
    assert speed.tolist() == kept["speed_rpm"] and (-angle).tolist() == kept["angle_deg"]


@pytest.mark.slow
@pytest.mark.notebook
@EACH
def test_runs_without_a_warning_and_is_the_same_again(path: Path, tmp_path: Path) -> None:
    for name in ("jupytext", "nbclient", "nbconvert", "ipykernel"):
        pytest.importorskip(name)
    checked = tmp_path / path.name
    checked.write_text(path.read_text(encoding="utf-8").replace("plt.show()\n", FIGURE), encoding="utf-8")
    said = []
    for source, out in ((checked, tmp_path / "one"), (path, tmp_path / "two")):
        assert run_notebooks.execute(source, out) == ""
        book = json.loads((out / f"{path.stem}.ipynb").read_text(encoding="utf-8"))
        outputs = [output for cell in book["cells"] for output in cell.get("outputs", ())]
        said.append([output["text"] for output in outputs if "text" in output])
        pictures = [output for output in outputs if "image/png" in output.get("data", {})]
        assert all(output["metadata"]["image/png"]["alt"] for output in pictures) and len(pictures) >= 2
    assert said[0] == said[1]
