"""Which module answers a question about a kind of machine, and what installed packages announce.

The one place that names wings.
"""

from __future__ import annotations

import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from contextlib import contextmanager
from functools import lru_cache
from importlib.metadata import Distribution, EntryPoint, distributions
from pathlib import Path
from traceback import extract_tb
from typing import Any

from leblanc.core.answer import Answer, NotConverged
from leblanc.core.interrupts import Terminated, behind
from leblanc.core.question import called
from leblanc.core.terminal import say
from meshes.errors import InputError

# Groups of entry points.
COMMANDS, LIQUIDS, MACHINES = "leblanc.commands", "leblanc.liquids", "leblanc.machines"
CORE = ("jeffcott", "two_plane", "tub")  # kinds that the core's own studies answer

# "module:function" of a scene, by kind of machine and by question.
WINGS: dict[str, dict[str, str]] = {
    "balls": {
        "run": "leblanc.studies.balls.study:run_balls",
        "explain": "leblanc.studies.explain.balls.study:explain_balls",
    },
    "exciter": {
        "run": "leblanc.wings.exciter.study:run_exciter",
        "explain": "leblanc.wings.exciter.study:explain_exciter",
    },
    "magnetic": {
        "run": "leblanc.wings.magnetic.study:run_magnetic",
        "explain": "leblanc.wings.magnetic.study:explain_magnetic",
        "view": "leblanc.wings.magnetic.geometry:magnetic_view",
    },
    "spindle": {
        "run": "leblanc.wings.spindle.study:run_spindle",
        "view": "leblanc.wings.spindle.geometry:spindle_view",
    },
}


def answerer(question: str, kind: str) -> Callable[..., Any] | None:
    """What answers a question about a kind of machine; None where the core does."""
    if kind in CORE or kind in WINGS:
        address = WINGS.get(kind, {}).get(question)
        return None if address is None else called(address)
    entry = announced(MACHINES).get(kind)
    if entry is None:
        return None
    with sound(kind, f"ANSWERS of {entry.value}"):
        address = entry.load().ANSWERS.get(question)
    if address is None:
        return None

    def answer(*asked: Any) -> Any:
        with sound(kind, f"the answer to {question}, {address!r},"):
            found = called(address)(*asked)
            if question != "view" and not isinstance(found, Answer):
                raise TypeError(f"it is {type(found).__name__}, no leblanc.core.answer.Answer")
            return found

    return answer


@contextmanager
def sound(
    name: str, what: str, field: str = "rotor.kind", passed: tuple[type[BaseException], ...] = ()
) -> Iterator[None]:
    """What fails in the code of another package, in one sentence about what the user named.

    What it refuses stays as it is, and what is `passed`.
    """
    refusals: tuple[type[BaseException], ...] = (InputError, NotConverged, Terminated, *passed)
    of_a_file: Any = called("leblanc.scene.schema.load:SceneError")
    try:
        yield
    except refusals:
        raise
    except (Exception, SystemExit) as error:
        if behind(error) is not None or isinstance(error, of_a_file):
            raise
        said = " ".join(str(error).split())
        places = [one for one in extract_tb(error.__traceback__)[1:] if not one.filename.startswith("<")]
        at = f" ({Path(places[-1].filename).name}, line {places[-1].lineno})" if places else ""
        why = f"{type(error).__name__}{': ' * bool(said)}{said}{at}"
        raise InputError(field, name, f"of a package that works; {what} fails: {why}") from error


_SAID: set[str] = set()  # of names that are announced in vain


def announced(
    group: str, taken: Collection[str] = (), failed: Callable[[str], object] = lambda _: None
) -> dict[str, EntryPoint]:
    """Entry points of a group by name; one that cannot be read announces none, `failed` says why.

    A name that is `taken` by one of ours, or by a package before, announces nothing; stderr says so once.
    """
    found: dict[str, EntryPoint] = {}
    by: dict[str, Distribution] = {}
    for package, entries in _read(distributions, tuple((folder, _changed(folder)) for folder in sys.path)):
        if isinstance(entries, str):
            failed(entries)
            continue
        for entry in (entry for entry in entries if entry.group == group):
            first = found.get(entry.name)
            if entry.name in taken:
                _say_once(f"{entry.value} is not used: {group} has {entry.name} of leblanc itself")
            elif first is None:
                found[entry.name], by[entry.name] = entry, package
            elif not _same(package, by[entry.name]):
                _say_once(f"{entry.value} is not used: {group} has {entry.name} of {first.value}")
    return found


@lru_cache(maxsize=1)
def _read(
    packages: Callable[[], Iterable[Distribution]], path: tuple[tuple[str, int], ...]
) -> tuple[tuple[Distribution, tuple[EntryPoint, ...] | str], ...]:
    """Packages with their entry points, or why these cannot be read; anew where a folder has changed."""
    found: list[tuple[Distribution, tuple[EntryPoint, ...] | str]] = []
    for package in packages():
        try:
            found.append((package, tuple(package.entry_points)))
        except Exception as error:
            found.append((package, str(error) or type(error).__name__))
    return tuple(found)


def _changed(folder: str) -> int:
    """When a folder of the path changed last, ns; 0 for none."""
    try:
        return Path(folder).stat().st_mtime_ns
    except OSError:
        return 0


def _same(one: Distribution, other: Distribution) -> bool:
    """Whether these are two versions on the path, of which the first is the one imported."""
    first, second = (getattr(each, "name", None) for each in (one, other))
    return one is other or (first is not None and first == second)


def _say_once(text: str) -> None:
    if text not in _SAID:
        _SAID.add(text)
        say(f"leblanc: {' '.join(text.split())}")
