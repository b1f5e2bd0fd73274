"""The work of a sweep: a block of scenes from sampled values, answered whatever happens to one of them.

Only what varies is checked anew. Kept of each sample are outputs of `run` over speed and a few numbers of
them.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import ValidationError

from leblanc.core.answer import versions
from leblanc.scene.scene import Scene, scene_from_table
from leblanc.scene.schema.load import SceneError, escaped
from leblanc.scene.schema.part import Part, rule_of
from leblanc.scene.schema.paths import Keys, tables_of, with_values
from leblanc.scene.schema.rules import Quantity
from leblanc.studies.sweep.outputs import Answers, Kept, RunupAnswers, blank
from meshes.errors import InputError

PENDING, DONE, FAILED, NOT_CONVERGED = range(4)
STATUS = ("pending", "done", "failed", "not_converged")


_WORDS = "source", "assumed"  # no answer depends on them
_IN_TIME = "runup", "programme"  # nor one over speed on these

_Tables = Mapping[tuple[str, ...], type[Part]]

Maker = Callable[[Sequence[Any]], Scene]


def scene_maker(table: Mapping[str, Any], paths: Sequence[Keys], unused: Sequence[str] = _IN_TIME) -> Maker:
    """What makes one scene after the other from the same table with other values at some paths.

    Each is the scene that the whole table with those values gives, but for its `unused` tables, at a fraction
    of the cost, and raises as that would.
    """
    base = {key: value for key, value in table.items() if key not in (*_WORDS, *unused)}
    scene = scene_from_table(base)
    base = _in_si(base, (), tables_of(Scene, scene.rotor.kind))
    rotor_class = type(scene.rotor)
    touched = {keys[:2] if keys[0] == "chambers" else keys[:1] for keys in paths}
    chambers = sorted(int(keys[1]) for keys in touched if keys[0] == "chambers")
    in_parts = all(keys[0] in ("rotor", "chambers") for keys in paths)

    def make(values: Sequence[Any]) -> Scene:
        changed = with_values(base, zip(paths, values, strict=True))
        if not in_parts:
            return scene_from_table(changed)
        try:
            parts = list(scene.chambers)
            for k in chambers:
                parts[k] = type(parts[k]).model_validate(changed["chambers"][k])
            rotor = scene.rotor
            if ("rotor",) in touched:
                rotor = rotor_class.model_validate(changed["rotor"])
        except ValidationError:
            return scene_from_table(changed)  # says what is wrong in words
        return scene.altered(rotor=rotor, chambers=tuple(parts))

    return make


def _in_si(table: Mapping[str, Any], place: tuple[str, ...], tables: _Tables) -> dict[str, Any]:
    """The table with quantities as plain numbers, which are not parsed again for each sample."""
    plain = dict(table)
    for key, value in table.items():
        below = (*place, key)
        if isinstance(value, list) and (*below, "*") in tables:
            plain[key] = [_in_si(entry, _place_in(below, entry, tables), tables) for entry in value]
        elif isinstance(value, dict) and below in tables:
            plain[key] = _in_si(value, below, tables)
        elif isinstance(value, str):
            rule = rule_of(tables[place].model_fields[key])
            plain[key] = rule(value) if isinstance(rule, Quantity) else value
    return plain


def _place_in(below: tuple[str, ...], entry: Mapping[str, Any], tables: _Tables) -> tuple[str, ...]:
    """Place of an entry of a list, by its kind where that has a table of its own."""
    other = (*below, f"*{entry.get('kind', '')}")
    return other if other in tables else (*below, "*")


def make_scenes(make: Maker, rows: Iterable[Sequence[Any]]) -> tuple[list[Scene | None], list[str]]:
    """Scenes of some samples, None for one that breaks a rule, and the reason why."""
    scenes: list[Scene | None] = []
    reasons: list[str] = []
    for row in rows:
        try:
            scenes.append(make(row))
            reasons.append("")
        except SceneError as error:
            scenes.append(None)
            said = (str(fault).removeprefix(f"{escaped(fault.file)}: ") for fault in error.faults)
            reasons.append("; ".join(said))
    return scenes, reasons


_LONGEST = 2000  # characters of a reason
_ADDRESS = re.compile(r"0x[0-9a-fA-F]{6,}")  # of an object in memory, another one each time

Values = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Block:
    """Samples to be answered together."""

    number: int  #: of the block
    table: Mapping[str, Any]  #: content of the scene file that they are made from
    paths: tuple[Keys, ...]  #: keys along the path of each varied field
    rows: tuple[tuple[Any, ...], ...]  #: values of each sample at those paths
    kept: Kept  #: of each sample


@dataclass(frozen=True)
class BlockAnswer:
    """What came of a block."""

    number: int  #: of the block
    values: Values  #: of each output, one row for each sample
    status: NDArray[np.int8]  #: DONE, FAILED or NOT_CONVERGED, shape (samples,)
    reason: tuple[str, ...]  #: why not done, empty where done
    versions: Mapping[str, str]  #: of the packages that the numbers come from


def answer_block(block: Block) -> BlockAnswer:
    """Answer a block on one thread.

    A sample whose scene breaks a rule, or that fails in any other way, has its reason in its place.
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        unused = _IN_TIME if block.kept.kind is Answers else ()
        scenes, reasons = make_scenes(scene_maker(block.table, block.paths, unused), block.rows)
        kept = [k for k, scene in enumerate(scenes) if scene is not None]
        pieces = _answer([scene for scene in scenes if scene is not None], block.kept)
    outputs = block.kept.outputs
    values = {name: blank(output, len(scenes), block.kept.speeds) for name, output in outputs.items()}
    status = np.full(len(scenes), FAILED, dtype=np.int8)
    done = 0
    for count, found in pieces:
        places = kept[done : done + count]
        done += count
        if isinstance(found, str):
            reasons[places[0]] = found
            continue
        for name in outputs:
            values[name][places] = getattr(found, name)
        for place, reason in zip(places, found.reasons, strict=True):
            status[place], reasons[place] = NOT_CONVERGED if reason else DONE, str(reason)
    return BlockAnswer(block.number, values, status, tuple(reasons), own_versions())


@functools.cache
def own_versions() -> Mapping[str, str]:
    """Versions of the packages in this process."""
    return versions()


def answered(scenes: Sequence[Scene], kept: Kept) -> Answers | RunupAnswers:
    """Outputs of some scenes by the command of their sweep."""
    if kept.kind is Answers:
        from leblanc.studies.sweep.batch import answer_scenes

        return answer_scenes(scenes)
    from leblanc.studies.sweep.runups import answer_runups

    return answer_runups(scenes, kept.check)


def _answer(scenes: Sequence[Scene], kept: Kept) -> list[tuple[int, Answers | RunupAnswers | str]]:
    """Answers of as many scenes at once as do not fail together; the reason of one that fails alone."""
    if not scenes:
        return []
    if kept.kind is RunupAnswers and len(scenes) > 1:  # nothing is saved by several together
        return [_answer([scene], kept)[0] for scene in scenes]
    try:
        return [(len(scenes), answered(scenes, kept))]
    except MemoryError:
        raise  # says nothing about the scenes
    except Exception as error:  # whatever it is, it must not take the other samples with it
        if len(scenes) == 1:
            return [(1, reason_of(error))]
        middle = len(scenes) // 2
        return _answer(scenes[:middle], kept) + _answer(scenes[middle:], kept)


def reason_of(error: Exception) -> str:
    """The message of an error, the same each time."""
    said = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
    return _ADDRESS.sub("0x...", escaped(said))[:_LONGEST]
