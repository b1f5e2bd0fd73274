"""The runner of the notebooks: a wrong case, a warning and a warning of another process each fail it."""

from __future__ import annotations

import ast
import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

from tests.oracles.notebooks import BROKEN, claims, earliest, failed, made, statements, used
from validation.run_notebooks import FOLDER, texts

for _module in ("jupytext", "nbclient", "nbconvert", "ipykernel"):
    pytest.importorskip(_module)

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.notebook


def run(out: Path, *paths: Path) -> tuple[subprocess.CompletedProcess[str], dict[str, bool]]:
    """The command's end, and which notebooks passed."""
    command = [sys.executable, "-m", "leblanc", "notebooks", *map(str, paths), "--out", str(out), "--json"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)
    return done, {one["name"]: one["passed"] for one in json.loads(done.stdout)["notebooks"]}


def notebook(folder: Path, name: str, *cells: str) -> Path:
    path = folder / f"{name}.py"
    path.write_text("\n\n".join(f"# %%\n{cell}" for cell in cells) + "\n", encoding="utf-8")
    return path


def test_a_case_that_is_broken_fails_the_notebook(tmp_path: Path) -> None:
    """Cases and claims of the washing machine, as they are and with a drum that no table has."""
    text = (FOLDER / "5_washing_machine.py").read_text(encoding="utf-8")
    (claim,) = re.findall(r"^assert verdicts\(cases\) == \{.*?^\}$", text, re.MULTILINE | re.DOTALL)
    cells = (
        "from validation.cases.rotors import tub\nfrom validation.page import case_table, verdicts",
        "cases = list(tub.cases())\ncase_table(cases)",
        claim,
    )
    fault = (
        "from dataclasses import replace\n\n"
        "right = tub.suspended_tub\n"
        "tub.suspended_tub = lambda *given, **named: replace(right(*given, **named), drum_mass=20.0)"
    )
    right = notebook(tmp_path, "right", *cells)
    wrong = notebook(tmp_path, "wrong", cells[0], fault, *cells[1:])
    done, passed = run(tmp_path / "out", right, wrong)
    assert passed == {"right": True, "wrong": False} and done.returncode == 1, done.stderr
    assert "AssertionError" in done.stderr
    # What came out stands there for the reader all the same, the runner's own cell left out.
    book = json.loads((tmp_path / "out" / "wrong.ipynb").read_text(encoding="utf-8"))
    assert "simplefilter" not in json.dumps(book["cells"])
    assert (tmp_path / "out" / "wrong.html").exists()


def test_what_else_fails(tmp_path: Path) -> None:
    codes = {
        "warning": 'import warnings\n\nwarnings.warn("old", DeprecationWarning, stacklevel=1)',
        "overflow": "import numpy as np\n\nnp.array([1e300]) * np.array([1e300])",
        "elsewhere": 'import sys\n\nprint("part.py:3: UserWarning: careful", file=sys.stderr)',
    }
    books = [notebook(tmp_path, name, code, "assert True") for name, code in codes.items()]
    done, passed = run(tmp_path / "out", *books)
    assert done.returncode == 1 and passed == dict.fromkeys(codes, False)


@pytest.mark.parametrize("path", texts(), ids=lambda path: path.stem)
def test_claims_without_pictures(path: Path) -> None:
    """Every claim stands in the code that wrong formulas are tried with, and no picture is drawn there."""
    whole, kept = path.read_text(encoding="utf-8"), claims(path)
    assert (
        len(re.findall("^assert ", kept, re.MULTILINE))
        == len(re.findall("^assert ", whole, re.MULTILINE))
        > 0
    )
    assert not re.search(r"^(picture|drawn)\(", kept, re.MULTILINE)


@pytest.mark.parametrize("path", texts(), ids=lambda path: path.stem)
def test_claims_that_come_early_mean_the_same(path: Path) -> None:
    """A statement that gives or changes a value stays on its side of all that take it."""
    body = statements(path)
    place = {k: at for at, k in enumerate(earliest(body))}
    takes, gives = [used(node) for node in body], [made(node, body) for node in body]
    for k in range(len(body)):
        for later in range(k + 1, len(body)):
            if gives[k] & (takes[later] | gives[later]) or takes[k] & gives[later]:
                assert place[k] < place[later], (ast.unparse(body[k]), ast.unparse(body[later]))


@pytest.mark.slow
@pytest.mark.parametrize("number", range(len(BROKEN)), ids=[str(mutant) for _, mutant in BROKEN])
def test_the_notebook_that_leans_on_a_formula_notices(number: int) -> None:
    """Each of the formulas, wrong by five per cent, at a claim of the notebook that stands on it."""
    assert failed(number).startswith("assert ")


def test_every_notebook_leans_on_a_formula_that_is_broken() -> None:
    assert {name for name, _ in BROKEN} == {path.stem for path in texts()}


@pytest.mark.slow
@pytest.mark.parametrize("path", texts(), ids=lambda path: path.stem)
def test_notebook_passes(path: Path, tmp_path: Path) -> None:
    done, passed = run(tmp_path, path)
    assert done.returncode == 0 and passed[path.stem], done.stderr
    assert not done.stderr
