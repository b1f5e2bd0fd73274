"""The command beside files of a user's own that bear the names of our packages, or of Python's."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
NAMES = (
    "study",
    "fluid",
    "meshes",
    "solvers",
    "validation",
    "leblanc",
    "numpy",
    "pickle",
    "tokenize",
    "json",
)


SIZES = ("--radius", "0.1", "--volume", "2e-4", "--height", "0.05", "--speed", "40")
LAYER = ("layer", *SIZES, "--whirl-speed", "30", "--whirl-amplitude", "1e-5")
FILM = (*LAYER, "--cells", "16", "--model", "long_wave", "--animate", "layer.mp4")


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
    # Settings that libraries look for in the current folder.
    (work / ".numba_config.yaml").write_text("cache_dir: planted\n")
    (work / "matplotlibrc").write_text("animation.ffmpeg_path: ./planted.sh\n")
    (work / "planted.sh").write_text("#!/bin/sh\ntouch planted\n")
    (work / "planted.sh").chmod(0o755)
    imported = "".join(f"import {name}\n" for name in NAMES if name != "study")
    (work / "own.py").write_text(f"# %%\n{imported}")
    return work


def leblanc(folder: Path, *arguments: str, module: bool = False) -> subprocess.CompletedProcess[str]:
    """The command as it is installed: a script in a folder of its own, run from the folder of work.

    With `module` it is `python -m leblanc`, for which Python itself puts the current folder first.
    """
    script = folder.parent / "bin" / "leblanc"
    script.parent.mkdir(exist_ok=True)
    script.write_text(
        "import sys\nfrom leblanc.cli import main\n\nif __name__ == '__main__':\n    sys.exit(main())\n"
    )
    own = ("PYTHONSAFEPATH", "NUMBA_CACHE_DIR")
    environment = {key: value for key, value in os.environ.items() if key not in own}
    return subprocess.run(
        [sys.executable, *(["-m", "leblanc"] if module else [str(script)]), *arguments],
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
        pytest.param(FILM, marks=pytest.mark.slow),
        ("sweep", "sweep.toml", "--workers", "2"),
        # Each model in two processes of its own.
        pytest.param(("trade", "vibratory_table.toml", "--quick", "--repeats", "2"), marks=pytest.mark.slow),
        pytest.param(("validate", "vector_model"), marks=pytest.mark.slow),
        pytest.param(("notebooks", "own.py"), marks=pytest.mark.notebook),
    ],
    ids=lambda arguments: arguments[0],
)
def test_modules_of_the_current_folder_are_not_taken(folder: Path, arguments: tuple[str, ...]) -> None:
    if arguments[0] == "notebooks":
        for name in ("jupytext", "nbclient", "nbconvert", "ipykernel"):
            pytest.importorskip(name)
    done = leblanc(folder, *arguments)
    # Without an ffmpeg of the system there is no .mp4, and least of all by one that lies about.
    wanted = 2 if "layer.mp4" in arguments and shutil.which("ffmpeg") is None else 0
    assert done.returncode == wanted, done.stderr
    assert "was taken" not in done.stdout + done.stderr
    assert not (folder / "planted").exists()


def test_nor_are_they_by_the_name_of_the_package(folder: Path) -> None:
    """Of modules that Python loads before ours, such as one called leblanc, it alone can decide."""
    (folder / "leblanc.py").unlink()
    done = leblanc(folder, "explain", "horizontal_rig.toml", module=True)
    assert done.returncode == 0, done.stderr
    assert "was taken" not in done.stdout + done.stderr
