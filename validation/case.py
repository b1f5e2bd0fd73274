"""One comparison of the validation report: what a source prints, what the package computes."""

from __future__ import annotations

import math
import re
import tomllib
from dataclasses import dataclass
from importlib import resources
from typing import Any, Literal, get_args

from meshes.errors import InputError
from validation.study import plain

Verdict = Literal["agrees", "erratum", "trend", "differs"]
Value = float | str | None
Origins = Literal["printed", "measured", "second code", "scan", "closed form"]

# By how much the size of an effect may be off while its shape is still called the same.
_FACTOR = 2.0


@dataclass(frozen=True)
class Effect:
    """Size of an effect by the source, and computed."""

    quantity: str  #: what its size is measured by, with its unit
    measured: float  #: sizes; of one sign where they are alike
    computed: float
    #: the value that there would be without the effect, where the sizes are what it leaves of that: the
    #: changes from it are compared as well; None where the sizes are the effect itself
    without: float | None = None

    @property
    def alike(self) -> bool:
        """Within a factor of two; nothing is like nothing alone."""
        pairs = [(self.measured, self.computed)]
        if self.without is not None:
            pairs.append((self.measured - self.without, self.computed - self.without))
        return all(_alike(*pair) for pair in pairs)


def _alike(measured: float, computed: float) -> bool:
    if measured == 0.0 or computed == 0.0:
        return measured == computed
    return 1.0 / _FACTOR <= computed / measured <= _FACTOR


def shape_verdict(same: bool, effect: Effect | None = None) -> Verdict:
    """`trend` where the shape is the same and the effect as large within a factor of two, else `differs`.

    Effect None: the source gives no size.
    """
    return "trend" if same and (effect is None or effect.alike) else "differs"


@dataclass(frozen=True)
class Origin:
    """Origin of the value beside the computed one; InputError for a code, scan or closed form unnamed."""

    #: `printed` in a source, as a number or a statement; `measured` by a source's authors or others; by a
    #: `second code`; a `scan` of our own; a `closed form`, a limit or a conservation law
    kind: Origins
    name: str = ""  #: of the code, the scan or the closed form

    def __post_init__(self) -> None:
        if self.kind not in get_args(Origins):
            raise InputError("origin.kind", self.kind, "one of " + ", ".join(get_args(Origins)))
        if self.kind not in ("printed", "measured") and not self.name:
            raise InputError("origin.name", self.name, f"the name of the {self.kind}")

    def __str__(self) -> str:
        return f"{self.kind}: {self.name}" if self.name else self.kind


PRINTED, MEASURED = Origin("printed"), Origin("measured")
COMPUTED_FLOW = Origin("second code", "interFoam of OpenFOAM, two-phase flow computed for this comparison")
_KEY = re.compile(r"[A-Z][A-Za-z]*\d{2}\b")  # of a source in references.bib


@dataclass(frozen=True)
class Case:
    """Published claim beside the computed one.

    InputError for a number that is not finite, a `trend` whose effect is off by more than a factor of two or
    not given though the source prints a number or nothing, and a printed value without a source of the
    references.
    """

    name: str  #: group and name, `errata/dr-eq-18`
    source: str  #: key of the source and the place in it
    quantity: str  #: what is compared, with its unit and the input it was taken at
    printed: Value  #: the source's value, or its statement in words
    computed: Value  #: the package's value, or its statement in words
    difference: Value  #: of the printed from the computed value, relative to the latter; or in words
    #: `agrees`; `erratum`: the source is wrong and the derived value is shown; `trend`: only the shape can be
    #: compared and is the same, its effect as large within a factor of two; `differs`
    verdict: Verdict
    note: str = ""  #: what a reader must know to judge
    effect: Effect | None = None  #: how large it is, where the source gives its size
    origin: Origin = PRINTED  #: of the value in `printed`

    def __post_init__(self) -> None:
        if self.verdict not in get_args(Verdict):
            raise InputError("verdict", self.verdict, "one of " + ", ".join(get_args(Verdict)))
        if self.origin == PRINTED and not _KEY.match(self.source):
            raise InputError(
                "origin", "printed", f"another: {self.source!r} names no source of the references"
            )
        for field in ("printed", "computed", "difference"):
            value = getattr(self, field)
            if isinstance(value, float) and not math.isfinite(value):
                raise InputError(field, value, "a finite number, words, or None")
        if self.verdict != "trend":
            return
        if self.effect is None and not isinstance(self.printed, str):
            raise InputError("effect", None, "told of a trend, where the source does not print words alone")
        if self.effect is not None and not self.effect.alike:
            sizes = (self.effect.measured, self.effect.computed)
            raise InputError("effect", sizes, f"within a factor of {_FACTOR:g} for a trend; else it differs")

    @property
    def group(self) -> str:
        """The part of the name before the slash."""
        return self.name.partition("/")[0]

    def to_json(self) -> dict[str, Any]:
        """The case as `leblanc validate --json` prints it, for `json.dumps`."""
        found: dict[str, Any] = plain(self)
        return found


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
    origin: Origin = PRINTED,
) -> Case:
    """Case of two numbers; it `agrees` up to a relative difference, else the verdict is `otherwise`.

    A `trend` only within a factor of two; the difference is printed/computed - 1, or a text where computed is
    0. InputError for a tolerance that half as much again would be within.
    """
    # At a third the computed value may be half as large again, and no change of it would be noticed.
    if not 0.0 <= tolerance < 1.0 / 3.0:
        raise InputError("tolerance", tolerance, "from 0 to below a third")
    printed, computed = float(printed), float(computed)
    difference: float | str
    if computed != 0.0:
        difference = (printed - computed) / abs(computed)
        agrees = abs(difference) <= tolerance
    else:
        difference = "none" if printed == 0.0 else f"{printed:g} instead of nothing"
        agrees = printed == 0.0
    effect = Effect(quantity, printed, computed) if otherwise == "trend" else None
    if not agrees and effect is not None:
        otherwise = shape_verdict(True, effect)
    verdict: Verdict = "agrees" if agrees else otherwise
    return Case(name, source, quantity, printed, computed, difference, verdict, note, effect, origin)


class Claims:
    """What the sources of a group say, one entry of `data/cases/<group>.toml` a case or family of cases.

    An entry has the fields of `Case`, or `tolerance` and `otherwise` as of `compare`. Its verdict is `holds`,
    by default `agrees`, where a statement agrees, else `otherwise`; so of two words for its `difference` the
    first and the second. Words in braces are computed.
    """

    def __init__(self, group: str) -> None:
        file = resources.files("validation").joinpath("data", "cases", f"{group}.toml")
        self.group, self.entries = group, tomllib.loads(file.read_text(encoding="utf-8"))

    def case(self, entry: str, computed: Any = None, agrees: Any = None, **given: Any) -> Case:
        """Case of an entry; given: fields that hang on what is computed, and the words of texts."""
        row = {"name": entry, "difference": "in words", "printed": None} | self.entries[entry]
        row = {key: value.format(**given) if isinstance(value, str) else value for key, value in row.items()}
        row |= {key: value for key, value in given.items() if key in _FIELDS}
        if computed is not None:
            row["computed"] = computed
        row["name"] = f"{self.group}/{row['name']}"
        origin = row.get("origin", PRINTED)
        if not isinstance(origin, Origin):
            row["origin"] = Origin(*([origin] if isinstance(origin, str) else origin))
        if "tolerance" in row:
            del row["difference"]
            return compare(**row)
        holds, otherwise = row.pop("holds", "agrees"), row.pop("otherwise", "differs")
        if agrees is not None:
            same = agrees if holds != "trend" else shape_verdict(bool(agrees), row.get("effect")) == "trend"
            row["verdict"] = holds if same else otherwise
        if isinstance(row["difference"], list):
            row["difference"] = row["difference"][0 if agrees else 1]
        return Case(**row)


_FIELDS = {*Case.__dataclass_fields__, "tolerance", "otherwise"} - {"computed"}
