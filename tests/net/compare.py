"""Differences between a kept answer and a found one, told value by value."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, NamedTuple

from tests.net.answers import Answer
from tests.net.tolerances import Tolerance, tolerance_of

_SHOWN = 70  # letters of a value


@dataclass(frozen=True)
class Difference:
    """One difference, the worst of its array.

    Parameters
    ----------
    case : name of the command
    path : of the value in the answer
    kept, found : the values, as text
    relative : to the largest magnitude in the kept array; None if not of numbers
    count, size : how many values of the array differ, of how many
    """

    case: str
    path: str
    kept: str
    found: str
    relative: float | None = None
    count: int = 1
    size: int = 1

    def __str__(self) -> str:
        """One line."""
        line = f"{self.case}: {self.path}: kept {self.kept}, found {self.found}"
        if self.relative is not None:
            line += f", relative difference {self.relative:.2g}"
        return line + (f" ({self.count} of {self.size} values differ)" if self.count > 1 else "")


class Leaf(NamedTuple):
    """A value that holds no others, and where it stands."""

    path: str
    value: Any


def compare(case: str, kept: Answer, found: Answer, share: float = 1.0) -> list[Difference]:
    """All differences beyond the tolerances of the command, in the order of the paths.

    Parameters
    ----------
    case : name of the command
    kept, found : as `answers.answer` gives them
    share : of the tolerances that may be used up
    """
    ours, theirs = arrays(kept), arrays(found)
    differences = []
    for path in sorted(ours.keys() | theirs.keys()):
        values = path.removesuffix("#") + "[]"  # that they are missing says that their number is
        if path.endswith("#") and (values in ours) != (values in theirs):
            continue
        if path not in theirs:
            differences.append(Difference(case, path, _shown(ours[path]), "nothing"))
        elif path not in ours:
            differences.append(Difference(case, path, "nothing", _shown(theirs[path])))
        else:
            one = _array(case, path, ours[path], theirs[path], share)
            differences += [one] if one else []
    return differences


def arrays(value: Any) -> dict[str, list[Leaf]]:
    """Leaves of an answer by their path without indices: what stands under one path is one array.

    The entries of a list of objects are taken together, so that a column has one scale. The length of each
    list stands under the path of the list and "#"; an object without keys is told by ".keys".
    """
    found: dict[str, list[Leaf]] = {}
    for general, leaf in _leaves(value, "", ""):
        found.setdefault(general.lstrip("."), []).append(Leaf(leaf.path.lstrip("."), leaf.value))
    return found


def _leaves(value: Any, general: str, path: str) -> Iterator[tuple[str, Leaf]]:
    if isinstance(value, dict):
        if not value:
            yield f"{general}.keys", Leaf(path, "none")
        for key in value:
            yield from _leaves(value[key], f"{general}.{key}", f"{path}.{key}")
    elif isinstance(value, list):
        yield f"{general}#", Leaf(f"{path}#", len(value))
        for k, entry in enumerate(value):
            yield from _leaves(entry, f"{general}[]", f"{path}[{k}]")
    else:
        yield general, Leaf(path, value)


def _array(case: str, path: str, kept: list[Leaf], found: list[Leaf], share: float) -> Difference | None:
    """The worst difference of an array, None if there is none."""
    if len(kept) != len(found):
        return Difference(case, path, f"{len(kept)} values", f"{len(found)} values")
    tolerance = tolerance_of(case, path).times(share)
    kept, found = kept[tolerance.skipped :], found[tolerance.skipped :]
    scale = max((abs(leaf.value) for leaf in kept if _finite(leaf.value)), default=0.0)
    if not tolerance.ordered:
        kept, found = sorted(kept, key=_rank), sorted(found, key=_rank)
    bad = [(a, b) for a, b in zip(kept, found, strict=True) if not alike(a, b, scale, tolerance)]
    if not bad:
        return None
    a, b = max(bad, key=lambda pair: _distance(*pair))
    both = _finite(a.value) and _finite(b.value)
    relative = _distance(a, b) / scale if both and scale > 0.0 and not path.endswith("#") else None
    return Difference(case, a.path, _text(a.value), _text(b.value), relative, len(bad), len(kept))


def _rank(leaf: Leaf) -> tuple[bool, float, str]:
    """Place of a value among those of an array whose order does not count."""
    return (True, leaf.value, "") if _finite(leaf.value) else (False, 0.0, str(leaf.value))


def _distance(a: Leaf, b: Leaf) -> float:
    """How far two numbers are apart, an angle by the shorter way round; infinite unless both are finite."""
    if not (_finite(a.value) and _finite(b.value)):
        return math.inf
    distance = abs(a.value - b.value)
    if re.search(r"[._](phase|liquid_angle\w*)\b", a.path) and distance <= 2.0 * math.pi:
        return min(distance, 2.0 * math.pi - distance)
    return distance


def alike(a: Leaf, b: Leaf, scale: float, tolerance: Tolerance) -> bool:
    """Whether two values are the same within the tolerance.

    Parameters
    ----------
    a, b : kept and found
    scale : largest magnitude in the kept array
    tolerance : for numbers; truth values, None, not a number, infinities and strings are the same or not
    """
    if _finite(a.value) and _finite(b.value):
        return _distance(a, b) <= max(tolerance.relative * scale, tolerance.absolute)
    if isinstance(a.value, float) and isinstance(b.value, float):
        return a.value == b.value or (math.isnan(a.value) and math.isnan(b.value))
    return type(a.value) is type(b.value) and a.value == b.value


def _finite(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _shown(leaves: list[Leaf]) -> str:
    return _text(leaves[0].value) + (f" and {len(leaves) - 1} more" if len(leaves) > 1 else "")


def _text(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= _SHOWN else text[:_SHOWN] + "..."
