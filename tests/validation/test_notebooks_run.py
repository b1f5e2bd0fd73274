"""The runner of the notebooks: a wrong case, a warning and a warning of another process each fail it."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import pytest

from validation.run_notebooks import FOLDER, texts

for _module in ("jupytext", "nbclient", "nbconvert", "ipykernel"):
    pytest.importorskip(_module)

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.notebook


def run(path: Path, out: Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "leblanc", "notebooks", str(path), "--out", str(out)]
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=False)


def notebook(folder: Path, name: str, *cells: str) -> Path:
    path = folder / f"{name}.py"
    path.write_text("\n\n".join(f"# %%\n{cell}" for cell in cells) + "\n", encoding="utf-8")
    return path


def test_a_case_that_is_broken_fails_the_notebook(tmp_path: Path) -> None:
    """The washing machine without its figures, as it is and with a drum that no table has."""
    text = (FOLDER / "5_washing_machine.py").read_text(encoding="utf-8")
    cells = [one for one in text.split("\n\n# %%") if "picture(draw(" not in one]
    right, wrong = tmp_path / "right.py", tmp_path / "wrong.py"
    right.write_text("\n\n# %%".join(cells), encoding="utf-8")
    fault = (
        "\nfrom dataclasses import replace\n\nfrom validation.cases.rotors import tub\n\n"
        "right = tub.suspended_tub\n"
        "tub.suspended_tub = lambda *given, **named: replace(right(*given, **named), drum_mass=20.0)"
    )
    wrong.write_text("\n\n# %%".join([cells[0], fault, *cells[1:]]), encoding="utf-8")
    passed, failed = run(right, tmp_path / "out"), run(wrong, tmp_path / "out")
    assert passed.returncode == 0, passed.stderr
    assert failed.returncode == 1 and "AssertionError" in failed.stderr
    # What came out stands there for the reader all the same, the runner's own cell left out.
    book = json.loads((tmp_path / "out" / "wrong.ipynb").read_text(encoding="utf-8"))
    assert "simplefilter" not in json.dumps(book["cells"])
    assert (tmp_path / "out" / "wrong.html").exists()


@pytest.mark.parametrize(
    ("name", "code"),
    [
        ("warning", 'import warnings\n\nwarnings.warn("old", DeprecationWarning, stacklevel=1)'),
        ("overflow", "import numpy as np\n\nnp.array([1e300]) * np.array([1e300])"),
        ("elsewhere", 'import sys\n\nprint("part.py:3: UserWarning: careful", file=sys.stderr)'),
    ],
)
def test_what_else_fails(tmp_path: Path, name: str, code: str) -> None:
    assert run(notebook(tmp_path, name, code, "assert True"), tmp_path / "out").returncode == 1


@pytest.mark.slow
@pytest.mark.parametrize("path", texts(), ids=lambda path: path.stem)
def test_notebook_passes(path: Path, tmp_path: Path) -> None:
    done = run(path, tmp_path)
    assert done.returncode == 0, done.stderr
    assert not done.stderr
