"""The page of the scope: every number of the sources has a row, and every row leads somewhere."""

from __future__ import annotations

import importlib
import re
from collections import Counter
from functools import cache
from pathlib import Path

import pytest

from tests.oracles.cases import kept_cases

ROOT = Path(__file__).parent.parent
PAGE = ROOT / "docs" / "evidence.md"

# First and last number of what a source numbers; nothing where it has none.
NUMBERED = {
    "DR18, chapter 2.1": {"eq.": (1, 26), "fig.": (1, 24), "table": (1, 1)},
    "DR18, chapter 2.2": {"eq.": (1, 16), "fig.": (1, 9), "table": (1, 1)},
    "DR18, chapter 2.3": {"eq.": (17, 52), "fig.": (1, 7), "table": (1, 1)},
    "DR18, chapter 2.4": {"fig.": (1, 11)},
    "DG21": {"eq.": (1, 5), "fig.": (1, 14), "table": (1, 1)},
    "FF20": {"eq.": (1, 37), "fig.": (1, 2)},
    "YF17": {"eq.": (1, 21), "fig.": (1, 6)},
}
# What is done of it; a row that is declined, or has nothing to compute, gives its reason in words.
STATES = {"built", "in part", "put right", "declined", "words"}
REASON = 5  # words
_HEADING = "of the source"


def _data() -> list[tuple[str, list[str]]]:
    """Source and cells of each row, those of headings left out."""
    source, rows = "", []
    for line in PAGE.read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            source = line[3:].partition(":")[0]
        elif line.startswith("|") and source in NUMBERED:
            # A bar within mathematics or code is written \|.
            rows.append((source, [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]))
    return [(source, cells) for source, cells in rows if set(cells[0]) - set("-: ") and cells[0] != _HEADING]


def _numbers(cell: str) -> Counter[tuple[str, int]]:
    """What a row is about: "eq. 1-3, 5; fig. 2" is four equations and a figure."""
    found: Counter[tuple[str, int]] = Counter()
    for part in cell.split(";"):
        match = re.match(r"(eq\.|fig\.|table) ([\d, -]+)(?:\D|$)", part.strip())
        if match is None:
            continue
        for piece in match[2].split(","):
            first, _, last = piece.strip().partition("-")
            if first:
                found.update((match[1], n) for n in range(int(first), int(last or first) + 1))
    return found


@pytest.mark.parametrize("source", NUMBERED)
def test_nothing_is_passed_over(source: str) -> None:
    told: Counter[tuple[str, int]] = Counter()
    for name, cells in _data():
        if name == source:
            told.update(_numbers(cells[0]))
    wanted = {(kind, n) for kind, (first, last) in NUMBERED[source].items() for n in range(first, last + 1)}
    assert sorted(wanted - set(told)) == []
    assert sorted(set(told) - wanted) == []


def test_every_row_is_whole() -> None:
    for source, cells in _data():
        assert len(cells) == 4, (source, cells)
        assert all(cells), (source, cells)
        assert cells[2] in STATES, (source, cells)


@cache
def _commands() -> frozenset[str]:
    """Names of the commands."""
    from typer.main import get_command

    from leblanc.cli import application

    return frozenset(get_command(application()).commands)  # type: ignore[attr-defined]


def _leads(cell: str, cases: set[str]) -> list[tuple[str, bool]]:
    """Where a cell leads, and whether that exists."""
    from validation.command import GROUPS

    links = re.findall(r"\]\(([^)\s]+)\)", cell)
    found = [(target, (PAGE.parent / target.partition("#")[0]).exists()) for target in links]
    for code in re.findall(r"`([^`]+)`", cell):
        words = code.split()
        if words[0] == "leblanc":
            groups = words[2:3] if words[1] == "validate" else []
            found.append((code, words[1] in _commands() and set(groups) <= set(GROUPS)))
        elif re.fullmatch(r"[a-z_]+/[\w.-]+", code) and code.partition("/")[0] in GROUPS:
            found.append((code, code in cases))
        elif re.fullmatch(r"(solvers|fluid|leblanc|validation)(\.\w+)+", code):
            found.append((code, _exists(code)))
    return found


def _exists(name: str) -> bool:
    """Whether a dotted name is a module or something in one."""
    parts = name.split(".")
    for k in range(len(parts), 0, -1):
        try:
            found: object = importlib.import_module(".".join(parts[:k]))
        except ModuleNotFoundError:
            continue
        for part in parts[k:]:
            if not hasattr(found, part):
                return False
            found = getattr(found, part)
        return True
    return False


def test_every_row_leads_somewhere() -> None:
    """To a page, a command, a case or a function; or it gives a reason."""
    cases = {case["name"] for case in kept_cases()}
    for source, cells in _data():
        leads = _leads(cells[3], cases)
        assert [what for what, there in leads if not there] == [], (source, cells[0])
        if cells[2] in ("declined", "words"):
            assert len(re.findall(r"[A-Za-z]{2,}", cells[3])) >= REASON, (source, cells)
        else:
            assert leads, (source, cells)


def test_what_is_told_is_noticed() -> None:
    """The readings of this file, on rows of its own."""
    assert _numbers("eq. 1-3, 5; fig. 2") == {
        ("eq.", 1): 1, ("eq.", 2): 1, ("eq.", 3): 1, ("eq.", 5): 1, ("fig.", 2): 1
    }  # fmt: skip
    assert _numbers("section 2") == {}
    told = dict(
        _leads("`leblanc validate tub`, `leblanc nothing`, `errata/none`, [x](none.md)", {"errata/one"})
    )
    assert told == {
        "leblanc validate tub": True, "leblanc nothing": False, "errata/none": False, "none.md": False
    }  # fmt: skip
    assert _exists("solvers.rotor.tub") and not _exists("solvers.rotor.nothing")
