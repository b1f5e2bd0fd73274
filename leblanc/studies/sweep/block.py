"""The work of a sweep: a block of samples answered, whatever happens to one of them."""

from __future__ import annotations

import functools
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.results.base import versions
from leblanc.scene.scene import Scene
from leblanc.scene.schema.load import escaped
from leblanc.scene.schema.paths import Keys
from leblanc.studies.sweep.outputs import DONE, FAILED, NOT_CONVERGED, OUTPUTS, blank, values_of
from leblanc.studies.sweep.scenes import make_scenes, scene_maker
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.studies.batch import Answers

_LONGEST = 2000  # characters of a reason
_ADDRESS = re.compile(r"0x[0-9a-fA-F]{6,}")  # of an object in memory, another one each time

Values = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Block:
    """Samples to be answered together.

    Parameters
    ----------
    number : of the block
    table : content of the scene file that they are made from
    paths : keys along the path of each varied field
    rows : values of each sample at those paths
    """

    number: int
    table: Mapping[str, Any]
    paths: tuple[Keys, ...]
    rows: tuple[tuple[Any, ...], ...]


@dataclass(frozen=True)
class BlockAnswer:
    """What came of a block.

    Parameters
    ----------
    number : of the block
    values : of each output, one row for each sample
    status : DONE, FAILED or NOT_CONVERGED, shape (samples,)
    reason : why not done, empty where done
    versions : of the packages that the numbers come from
    """

    number: int
    values: Values
    status: NDArray[np.int8]
    reason: tuple[str, ...]
    versions: Mapping[str, str]


def answer_block(block: Block) -> BlockAnswer:
    """Answer a block on one thread.

    A sample whose scene breaks a rule, or that fails in any other way, has its reason in its place.

    Parameters
    ----------
    block : the samples
    """
    from threadpoolctl import threadpool_limits

    with threadpool_limits(1):
        scenes, reasons = make_scenes(scene_maker(block.table, block.paths), block.rows)
        kept = [k for k, scene in enumerate(scenes) if scene is not None]
        pieces = _answer([scene for scene in scenes if scene is not None])
    speeds = int(block.table["speeds"]["count"])
    values = {one.name: blank(one, len(scenes), speeds) for one in OUTPUTS}
    status = np.full(len(scenes), FAILED, dtype=np.int8)
    done = 0
    for count, found in pieces:
        places = kept[done : done + count]
        done += count
        if isinstance(found, str):
            reasons[places[0]] = found
            continue
        for name, value in values_of(found).items():
            values[name][places] = value
        lost = np.count_nonzero(~np.asarray(found.converged), axis=1)
        status[places] = np.where(lost == 0, DONE, NOT_CONVERGED)
        for k in np.flatnonzero(lost):
            reasons[places[k]] = f"no bounded deflection found at {lost[k]} of {speeds} speeds"
    return BlockAnswer(block.number, values, status, tuple(reasons), own_versions())


@functools.cache
def own_versions() -> Mapping[str, str]:
    """Versions of the packages in this process."""
    return versions()


def _answer(scenes: Sequence[Scene]) -> list[tuple[int, Answers | str]]:
    """Answers of as many scenes at once as do not fail together; the reason of one that fails alone."""
    from leblanc.studies.batch import answer_scenes

    if not scenes:
        return []
    try:
        return [(len(scenes), answer_scenes(scenes))]
    except MemoryError:
        raise  # says nothing about the scenes
    except Exception as error:  # whatever it is, it must not take the other samples with it
        if len(scenes) == 1:
            return [(1, reason_of(error))]
        middle = len(scenes) // 2
        return _answer(scenes[:middle]) + _answer(scenes[middle:])


def reason_of(error: Exception) -> str:
    """An error in words that are the same each time."""
    said = str(error) if isinstance(error, InputError) else f"{type(error).__name__}: {error}"
    return _ADDRESS.sub("0x...", escaped(said))[:_LONGEST]
