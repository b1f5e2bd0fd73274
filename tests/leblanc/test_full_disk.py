"""On a full disk a command says so in one line, and leaves what stood there as it was."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

resource = pytest.importorskip("resource")

ROOT = Path(__file__).parents[2]
# Files that grow beyond the limit are refused as on a disk without room, by whatever library writes them.
WRITERS = {
    "netcdf": """
from leblanc.core.netcdf import NamedArrays, variable, write_netcdf
import numpy as np
arrays = {"x": variable(("k",), np.random.default_rng(1).normal(size=50_000), "m", "x")}
write = lambda path: write_netcdf(NamedArrays(arrays, {}, {}), path)
""",
    "text": """
from leblanc.core.files import writing
def write(path):
    with writing(path) as part:
        part.write_text("x" * 400_000)
""",
    "png": """
from leblanc.view.picture import write_png
import numpy as np
write = lambda path: write_png(np.random.default_rng(1).integers(0, 255, (400, 400, 3), np.uint8), path)
""",
    "figure": """
from pathlib import Path
from leblanc.plotting.page import save
from leblanc.plotting.curves import *
import numpy as np
import matplotlib.figure
class Figure(matplotlib.figure.Figure):
    caption = alt = drawn = None
def write(path):
    figure = Figure()
    figure.subplots().imshow(np.random.default_rng(1).normal(size=(400, 400)))
    save(figure, path.parent, path.stem, "x", png=path.suffix == ".png")
""",
}
ENDING = {"netcdf": ".nc", "text": ".html", "png": ".png", "figure": ".svg"}
MAIN = """
import resource, sys
from pathlib import Path
from leblanc.cli import exit_code
resource.setrlimit(resource.RLIMIT_FSIZE, (20_000, 20_000))
sys.exit(exit_code(lambda: write(Path(sys.argv[1]))))
"""


@pytest.mark.parametrize("kind", WRITERS)
def test_full_disk(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"data{ENDING[kind]}"
    path.write_text("the old one")
    done = subprocess.run(
        [sys.executable, "-c", WRITERS[kind] + MAIN, str(path)],
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 2, done.stderr
    assert done.stderr == f"{path}: File too large\n"
    assert [file.name for file in tmp_path.iterdir()] == [path.name]
    assert path.read_text() == "the old one"
