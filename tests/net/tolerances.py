"""How near a number must come to the kept one: one table, each entry with its reason."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fnmatch import fnmatchcase


@dataclass(frozen=True)
class Tolerance:
    """Bound of a difference: the larger of the two.

    Parameters
    ----------
    relative : to the largest magnitude in the kept array
    absolute : in the unit of the value
    ordered : False if only the values of an array count, not their places
    """

    relative: float = 0.0
    absolute: float = 0.0
    ordered: bool = True

    def times(self, share: float) -> Tolerance:
        """A share of it."""
        return replace(self, relative=share * self.relative, absolute=share * self.absolute)


DEFAULT = Tolerance(relative=1e-12)
EXACT = Tolerance()

# (commands, paths, tolerance, reason): the first that fits holds.
TABLE: tuple[tuple[str, str, Tolerance, str], ...] = (
    ("*", "*#", EXACT, "lengths of lists"),
    (
        *("compare*", "*largest_difference*", Tolerance(absolute=2e-12)),
        "between two amplitudes over the largest, each good to a part in 1e12",
    ),
)


def tolerance_of(case: str, path: str) -> Tolerance:
    """Tolerance of a value.

    Parameters
    ----------
    case : name of the command
    path : of the value, without indices: `stdout.layers[].numbers.fill`
    """
    for commands, paths, tolerance, _ in TABLE:
        if fnmatchcase(case, commands) and fnmatchcase(path, paths.replace("[]", "[[]]")):
            return tolerance
    return DEFAULT
