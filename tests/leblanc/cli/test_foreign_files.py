"""The command beside files of a user's own that bear the names of our packages, or of Python's."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
NAMES = ("study", "fluid", "meshes", "solvers", "validation", "leblanc", "numpy", "pickle", "tokenize")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of work in which every module would end the process that imports it."""
    work = tmp_path / "work"
    work.mkdir()
    for name in NAMES:
        (work / f"{name}.py").write_text(f"raise SystemExit('{name}.py of the current folder was taken')\n")
    for scene in ("horizontal_rig.toml", "vibratory_table.toml"):
        shutil.copy(ROOT / "examples" / scene, work)
    (work / "sweep.toml").write_text(
        'scene = "horizontal_rig.toml"\nmethod = "random"\nsamples = 8\nseed = 1\n'
        '[vary]\n"rotor.mass" = { uniform = [3.0, 5.0] }\n'
    )
    imported = "".join(f"import {name}\n" for name in NAMES if name != "study")
    (work / "own.py").write_text(f"# %%\n{imported}")
    return work


def leblanc(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """The command as it is installed: a script in a folder of its own, run from the folder of work."""
    script = folder.parent / "bin" / "leblanc"
    script.parent.mkdir(exist_ok=True)
    script.write_text(
        "import sys\nfrom leblanc.cli import main\n\nif __name__ == '__main__':\n    sys.exit(main())\n"
    )
    environment = {key: value for key, value in os.environ.items() if key != "PYTHONSAFEPATH"}
    return subprocess.run(
        [sys.executable, str(script), *arguments],
        cwd=folder,
        env=environment | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize(
    "arguments",
    [
        ("run", "horizontal_rig.toml"),
        ("sweep", "sweep.toml", "--workers", "2"),
        ("trade", "vibratory_table.toml", "--quick", "--repeats", "2"),
        ("validate", "vector_model"),
        pytest.param(("notebooks", "own.py"), marks=pytest.mark.notebook),
    ],
    ids=lambda arguments: arguments[0],
)
def test_modules_of_the_current_folder_are_not_taken(folder: Path, arguments: tuple[str, ...]) -> None:
    if arguments[0] == "notebooks":
        for name in ("jupytext", "nbclient", "nbconvert", "ipykernel"):
            pytest.importorskip(name)
    done = leblanc(folder, *arguments)
    assert done.returncode == 0, done.stderr
    assert "was taken" not in done.stdout + done.stderr
