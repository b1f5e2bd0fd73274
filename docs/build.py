"""Build the documentation site: `python docs/build.py --out out/docs`.

The pages are gathered in one folder (the Markdown as it is, pictures drawn anew, notebooks executed, an API
page for each package) and go through Sphinx, whose warnings are errors. What comes out is proofread.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import time
from collections.abc import Callable, Sequence
from pathlib import Path

_HERE = Path(__file__).resolve().parent
ROOT = _HERE.parent
sys.path[:0] = [str(_HERE), str(_HERE / "_ext")]

import api_pages  # noqa: E402 - beside this file
import console  # noqa: E402
import figures  # noqa: E402
import output_pages  # noqa: E402
import proofread  # noqa: E402
import scene_keys  # noqa: E402

NOTEBOOKS = ROOT / "validation" / "notebooks"
_PATTERN = re.compile(r"[\w/]+\*$")  # an entry of the contents that stands for several pages
# Pages whose commands are run.
RUN = (
    "index.md",
    "tour.md",
    "models/potential.md",
    *(
        f"howto/{name}.md"
        for name in ("machine", "chamber", "volume", "cluster", "results", "export", "units")
    ),
)


def gather(source: Path, quick: bool) -> None:
    """Lay out what Sphinx reads.

    Parameters
    ----------
    source : folder for it; the folder around it is made anew
    quick : pictures as committed, notebooks only if they were executed before
    """
    shutil.rmtree(source.parent, ignore_errors=True)
    shutil.copytree(_HERE, source, ignore=shutil.ignore_patterns("__pycache__"))
    for name in ("references.bib", "CHANGELOG.md", "CITATION.cff"):
        shutil.copyfile(ROOT / name, source.parent / name)
    api_pages.write(source / "api")
    scene_keys.write(source)
    output_pages.write(source)
    drawn = ROOT / "out" / "figures"
    if not quick:
        if figures.draw_all(figures.RECIPES, drawn, check=True):
            raise SystemExit("pictures of docs/images are out of date")
        for picture in drawn.glob("*.png"):
            shutil.copyfile(picture, source / "images" / picture.name)
    _notebooks(source / "notebooks", quick)
    _without_empty_patterns(source / "index.md")


def _without_empty_patterns(index: Path) -> None:
    """Leave patterns out of the contents that no page matches: Sphinx would warn."""
    lines = index.read_text(encoding="utf-8").splitlines(keepends=True)
    kept = [line for line in lines if not _PATTERN.match(line) or [*index.parent.glob(line.strip())]]
    index.write_text("".join(kept), encoding="utf-8")


def _notebooks(target: Path, quick: bool) -> None:
    """Bring the executed notebooks; those older than their text or what they call are executed first."""
    executed = ROOT / "out" / "notebooks"
    texts = sorted(NOTEBOOKS.glob("[0-9]*.py"))
    called = [path for path in NOTEBOOKS.parent.rglob("*.py") if NOTEBOOKS not in path.parents]
    stale = [
        text
        for text in texts
        if any(_older(executed / f"{text.stem}.ipynb", path) for path in (text, *called))
    ]
    if stale and not quick:
        command = [sys.executable, "-m", "leblanc", "notebooks", *(text.stem for text in stale)]
        subprocess.run([*command, "--out", str(executed)], cwd=ROOT, check=True)
    target.mkdir(parents=True, exist_ok=True)
    for text in texts:
        book = executed / f"{text.stem}.ipynb"
        if book.is_file():
            shutil.copyfile(book, target / book.name)


def _older(path: Path, other: Path) -> bool:
    return not path.is_file() or path.stat().st_mtime < other.stat().st_mtime


def sphinx(source: Path, out: Path) -> int:
    """Run Sphinx on what `gather` made with warnings as errors; its exit code."""
    # A date in a page would make two builds differ.
    settings = os.environ | {"SOURCE_DATE_EPOCH": os.environ.get("SOURCE_DATE_EPOCH", "0")}
    options = ["-W", "--keep-going", "-n", "-q", "-b", "html", "-d", str(out) + ".doctrees"]
    return subprocess.run(
        [sys.executable, "-m", "sphinx", *options, str(source), str(out)], cwd=ROOT, env=settings, check=False
    ).returncode


def commands() -> int:
    """Run the commands that the pages show; 1 if one prints something else."""
    pages = [str(_HERE / name) for name in RUN if (_HERE / name).is_file()]
    return console.main(pages)


def timed(name: str, work: Callable[[], int | None]) -> int:
    """Do one part of the work and say how long it took; its exit code."""
    begin = time.perf_counter()
    code = work() or 0
    print(f"{name}: {time.perf_counter() - begin:.0f} s", flush=True)
    return code


def main(arguments: Sequence[str] | None = None) -> int:
    """Build the site.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code
    """
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "docs", help="folder of the site")
    parser.add_argument("--quick", action="store_true", help="pictures as committed, no command is run")
    chosen = parser.parse_args(arguments)
    out = chosen.out.resolve()
    source = out.parent / (out.name + ".source") / "docs"
    timed("pages, pictures, notebooks", lambda: gather(source, chosen.quick))
    wrong = 0 if chosen.quick else timed("commands of the pages", commands)
    wrong = timed("site", lambda: sphinx(source, out)) or wrong
    return timed("proofreading", lambda: proofread.main([str(out)])) or wrong


if __name__ == "__main__":
    raise SystemExit(main())
