"""One comparison of the validation report: what a source prints, what the package computes."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import Literal, get_args

from meshes.errors import InputError

Verdict = Literal["agrees", "erratum", "trend", "differs"]
Value = float | str | None


@dataclass(frozen=True)
class Case:
    """A published claim beside the computed one.

    Parameters
    ----------
    name : group and name, `errata/dr-eq-18`
    source : key of the source and the place in it
    quantity : what is compared, with its unit and the input it was taken at
    printed : the source's value, or its statement in words
    computed : the package's value, or its statement in words
    difference : of the printed from the computed value, relative to the latter; or in words
    verdict : `agrees`; `erratum`: the source is wrong and the derived value is shown; `trend`: only the shape
        can be compared; `differs`
    note : what a reader must know to judge

    Raises
    ------
    InputError : an unknown verdict, a number that is not finite
    """

    name: str
    source: str
    quantity: str
    printed: Value
    computed: Value
    difference: Value
    verdict: Verdict
    note: str = ""

    def __post_init__(self) -> None:
        if self.verdict not in get_args(Verdict):
            raise InputError("verdict", self.verdict, "one of " + ", ".join(get_args(Verdict)))
        for field in ("printed", "computed", "difference"):
            value = getattr(self, field)
            if isinstance(value, float) and not math.isfinite(value):
                raise InputError(field, value, "a finite number, words, or None")

    @property
    def group(self) -> str:
        """The part of the name before the slash."""
        return self.name.partition("/")[0]

    def record(self) -> dict[str, Value]:
        """The case as a flat dictionary that JSON can hold."""
        return asdict(self)


def compare(
    name: str,
    source: str,
    quantity: str,
    printed: float,
    computed: float,
    *,
    tolerance: float,
    otherwise: Verdict = "differs",
    note: str = "",
) -> Case:
    """Case of two numbers; whether they agree is decided here.

    Parameters
    ----------
    name, source, quantity, note : as in `Case`
    printed, computed : the two values
    tolerance : relative difference up to which they agree
    otherwise : verdict if they do not

    Returns
    -------
    Case whose difference is printed/computed - 1, or a text where the computed value is 0

    Raises
    ------
    InputError : a number that is not finite

    Examples
    --------
    >>> compare("errata/a", "X20, eq. 1", "mass, kg", 2.0, 1.0, tolerance=0.01, otherwise="erratum").verdict
    'erratum'
    """
    printed, computed = float(printed), float(computed)
    difference: float | str
    if computed != 0.0:
        difference = (printed - computed) / abs(computed)
        agrees = abs(difference) <= tolerance
    else:
        difference = "none" if printed == 0.0 else f"{printed:g} instead of nothing"
        agrees = printed == 0.0
    return Case(
        name, source, quantity, printed, computed, difference, "agrees" if agrees else otherwise, note
    )
