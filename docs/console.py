"""Commands shown in the pages, run word by word: `python docs/console.py docs/tour.md`; `--write` for anew.

A block of the kind `console` holds lines `$ command` and what they print. All blocks of a page run in their
order in one empty folder, in which `examples` is the project's. A line `...` in what is shown stands for any
lines. Numbers agree within a part in a thousand. A comment before a block changes how it is taken:

* `<!-- console: words -->`: times and the like differ from run to run, so numbers are not compared;
* `<!-- console: ran -->`: run, and what it prints is not compared at all;
* `<!-- console: shown -->`: not run at all (another machine, or an installation).

A block of the kind `toml` after a comment `<!-- file: NAME -->` is written to that file; after
`<!-- append: NAME -->` it is added to it.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
_BLOCK = re.compile(
    r"(?:^<!-- (?P<mark>console|file|append): (?P<word>[^>]+?) -->\n+)?"
    r"^```(?P<kind>console|toml|python)\n(?P<body>.*?)^```$",
    re.MULTILINE | re.DOTALL,
)
_NUMBER = re.compile(r"[-\N{MINUS SIGN}]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
# Last figures may differ between processors: some answers follow from iterations with tolerances of 1e-6 and
# less, and what is printed has three or four figures.
_RELATIVE = 1e-3


@dataclass(frozen=True)
class Step:
    """One command of a page and what the page says it prints.

    Parameters
    ----------
    command : as typed
    shown : lines of output
    words : numbers are not compared
    """

    command: str
    shown: tuple[str, ...]
    words: bool


def steps(body: str, words: bool) -> list[Step]:
    """Commands of one block; a backslash at the end of a line goes on with the command.

    Parameters
    ----------
    body : of the block
    words : numbers are not compared
    """
    found: list[tuple[list[str], list[str]]] = []
    for line in body.splitlines():
        if line.startswith("$ "):
            found.append(([line[2:]], []))
        elif found and not found[-1][1] and found[-1][0][-1].endswith("\\"):
            found[-1][0].append(line)
        elif found:
            found[-1][1].append(line)
    return [Step("\n".join(command), tuple(output), words) for command, output in found]


def run(command: str, folder: Path) -> str:
    """What a command prints on standard output.

    Parameters
    ----------
    command : for the shell, `leblanc` and `python` being those of this interpreter
    folder : where it runs

    Raises
    ------
    SystemExit : it failed
    """
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ.get("PATH", "")))
    settings = {"PATH": path, "COLUMNS": "100", "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
    done = subprocess.run(
        ["bash", "-c", command],
        cwd=folder,
        env=os.environ | settings,
        capture_output=True,
        text=True,
        check=False,
    )
    if done.returncode != 0:
        raise SystemExit(f"$ {command}\nended with code {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def agree(shown: Sequence[str], printed: Sequence[str], words: bool) -> bool:
    """Whether lines shown, with `...` for any, are those printed; of `words` numbers do not count."""
    if not shown:
        return not [line for line in printed if line.strip()]
    if shown[0].strip() == "...":
        return any(agree(shown[1:], printed[k:], words) for k in range(len(printed) + 1))
    return bool(printed) and _same(shown[0], printed[0], words) and agree(shown[1:], printed[1:], words)


def _same(shown: str, printed: str, words: bool) -> bool:
    """One line: the words between the numbers, and the numbers."""
    first, other = (" ".join(line.split()) for line in (shown, printed))
    texts = [" ".join(_NUMBER.sub("#", line).split()) for line in (first, other)]
    if texts[0] != texts[1]:
        return False
    pairs = zip(_NUMBER.findall(first), _NUMBER.findall(other), strict=True)
    return words or all(_close(*pair) for pair in pairs)


def _close(shown: str, other: str) -> bool:
    if shown == other:
        return True
    first, second = (float(text.replace("\N{MINUS SIGN}", "-")) for text in (shown, other))
    # A unit in the last place shown, or the tolerance.
    mantissa, _, power = shown.partition("e")
    unit = 1.01 * 10.0 ** (int(power or 0) - len(mantissa.partition(".")[2]))
    return abs(first - second) <= max(_RELATIVE * abs(second), unit)


def check(page: Path, write: bool = False) -> list[str]:
    """Run the commands of a page.

    Parameters
    ----------
    page : Markdown
    write : show what is printed now in place of what is shown, but for blocks with `...`

    Returns
    -------
    What does not agree, in words
    """
    text, wrong = page.read_text(encoding="utf-8"), list[str]()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        shutil.copytree(ROOT / "examples", folder / "examples")

        def again(block: re.Match[str]) -> str:
            if block["kind"] == "console":
                return _console(block, folder, wrong, write)
            if block["mark"] in {"file", "append"}:
                _keep(block, folder)
            return block[0]

        new = _BLOCK.sub(again, text)
    if write and new != text:
        page.write_text(new, encoding="utf-8")
    return wrong


def _keep(block: re.Match[str], folder: Path) -> None:
    """Write a block to its file, or add it there."""
    with (folder / block["word"]).open("a" if block["mark"] == "append" else "w", encoding="utf-8") as file:
        file.write(("\n" if block["mark"] == "append" else "") + block["body"])


def _console(block: re.Match[str], folder: Path, wrong: list[str], write: bool) -> str:
    """Run the commands of a block; the block, anew if that is asked for."""
    if block["word"] == "shown":
        return block[0]
    lines = []
    for step in steps(block["body"], block["word"] == "words"):
        printed = run(step.command, folder).rstrip("\n").splitlines()
        same = block["word"] == "ran" or agree(step.shown, printed, step.words)
        if not same and not write:
            wrong.append("\n".join((f"$ {step.command}", "shown:", *step.shown, "printed:", *printed)))
        kept = same or any(line.strip() == "..." for line in step.shown)
        lines += [f"$ {step.command}", *(step.shown if kept else printed)]
    return block[0].replace(block["body"], "\n".join(lines) + "\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Check pages.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code, 1 if something does not agree
    """
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("pages", type=Path, nargs="+")
    parser.add_argument("--write", action="store_true", help="show what is printed now")
    chosen = parser.parse_args(arguments)
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        found = pool.map(lambda page: check(page, chosen.write), chosen.pages)
        wrong = [
            f"{page}:\n{difference}"
            for page, several in zip(chosen.pages, found, strict=True)
            for difference in several
        ]
    print(*wrong, sep="\n\n")
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main())
