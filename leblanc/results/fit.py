"""Unknown values of a scene found from what was measured on the machine, each with its uncertainty."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays, variable
from leblanc.core.notes import Note, NoteCode, texts
from leblanc.core.units import Unit, number
from meshes.arrays import Array

REACH = 100.0  # of the first guess: how far the search looks
BOTH = 0.95  # a correlation from which on data tell little more than a combination of two values
_UPPER = 0.975  # of the distribution: a twentieth lies outside both ends
POOR = 0.3  # of what was measured: more left than that is no noise
LARGE = 0.05  # of what was measured: more noise than that is doubtful
VAGUE = 0.5  # of the value: a standard error at which the data hardly tell it


class FitCode(NoteCode):
    """What the notes of a fit say."""

    AT_BOUND = "at_bound"
    CORRELATED = "correlated"
    VAGUE = "vague"
    NOT_TOLD = "not_told"
    OTHER_MINIMUM = "other_minimum"
    NO_SPREAD = "no_spread"
    SCALE = "scale"
    POOR = "poor"
    PLATEAU = "plateau"
    LOPSIDED = "lopsided"
    FLAT = "flat"
    NOT_REPEATED = "not_repeated"
    LARGE = "large"
    FEW = "few"
    CONVERTED = "converted"


@dataclass(frozen=True)
class Measured:
    """One measured quantity."""

    name: str  #: amplitude, peak, phase, liquid_offset, liquid_angle, or a coordinate of the rotor
    unit: str  #: SI unit of its values; empty where their scale is free
    value: Array  #: measured, in that unit, shape (n,)
    fitted: Array  #: by the scene with the values found, shape (n,)


@dataclass(frozen=True)
class Noise:
    """Noise of the measured values, by which they are weighted."""

    kind: str  #: "absolute", or "relative" to each reading; angles are always absolute
    stated: bool  #: it was given; otherwise estimated from what is left
    names: tuple[str, ...]  #: the quantities
    size: tuple[float, ...]  #: standard deviation of each, SI, or a share of each reading


@dataclass(frozen=True)
class FittedCurve:
    """The fitted answer between the measured points."""

    at: Array  #: rad/s, s or m^3, rising, shape (m,)
    values: tuple[Array, ...]  #: of each quantity, in its unit, shape (m,)


@dataclass(frozen=True)
class FitResult(Result):
    """Values of a scene that bring it closest to what was measured; p unknowns, n measured points.

    Examples
    --------
    >>> one = np.ones(1)
    >>> about, over = ("rig", "", (), "", ("rotor.mass",)), (np.eye(1), "speed", one)
    >>> result = FitResult(*about, 4 * one, 0.1 * one, 5 * one, *over, (), 1, 0.02, True, 9, ())
    >>> result.parameters
    {'rotor.mass': {'value': 4.0, 'std': 0.1}}
    """

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]
    digest: str
    unknown: tuple[str, ...]  #: paths of the unknowns, in the scene
    value: Array  #: found, SI, and their standard errors, nan where the data do not tell them, shape (p,)
    std: Array
    first: Array  #: values of the scene that the search began with, shape (p,)
    correlation: Array  #: of the errors of the values, shape (p, p)
    over: str  #: "speed", "time" or "added" (liquid): what the quantities were measured over
    at: Array  #: those speeds, times or volumes, rad/s, s or m^3, rising, shape (n,)
    measured: tuple[Measured, ...]  #: the quantities
    #: of the measured lengths over the scene's, of the first of them where each has its own; 1 where it is
    #: given
    scale: float
    residual_rms: float  #: root of the mean square of what is left, over that of what was measured
    converged: bool  #: the best search came to its end
    evaluations: int  #: of the scene
    notes: tuple[Note, ...]  #: what the data cannot tell
    signed: tuple[str, ...] = ()  #: unknowns that may have either sign
    #: degrees of freedom, measured values less those that were found; 0 where they are not known
    freedom: int = 0
    accepted: bool = True  #: noise, or the error of the model, explains what is left
    noise: Noise = Noise("absolute", False, (), ())  #: of the measured values
    #: ends of the intervals of 95 %, where a profile gives them, SI, nan elsewhere,
    #: shape (p, 2)
    profile: Array | None = None
    tied: tuple[tuple[str, ...], ...] = ()  #: other paths that have the value of each unknown
    curve: FittedCurve | None = None
    units: tuple[Unit, ...] = ()  #: in which the values are shown, those of the scene's file

    figure: ClassVar[str] = "leblanc.figures.fit:fit_figure"
    summary: ClassVar[str] = "leblanc.text.fit:summary"

    @property
    def parameters(self) -> dict[str, dict[str, float]]:
        """Value and standard error of each unknown, SI."""
        pairs = zip(self.unknown, self.value.tolist(), self.std.tolist(), strict=True)
        return {path: {"value": value, "std": std} for path, value, std in pairs}

    @property
    def interval(self) -> Array:
        """Ends between which each value lies with 95 %, SI, shape (p, 2) [theory: fit, eq. 4].

        Neither lies beyond what the search looks at.
        """
        if self.freedom < 1:
            return np.full((self.value.size, 2), np.nan)
        wide = self.quantile * self.std
        # Beyond the search nobody has looked; its edge is also where the exponential would overflow.
        factor = np.exp(np.minimum(wide / np.abs(self.value), 2.0 * math.log(REACH)))
        ends = np.stack([self.value / factor, self.value * factor], axis=1)
        ends = np.clip(ends, self.first[:, None] / REACH, self.first[:, None] * REACH)
        either = np.array([[path in self.signed] for path in self.unknown])
        ends = np.where(either, np.stack([self.value - wide, self.value + wide], axis=1), ends)
        return ends if self.profile is None else np.where(np.isnan(self.profile), ends, self.profile)

    @property
    def quantile(self) -> float:
        """Standard errors on either side of a value within which it lies with 95 %."""
        return quantile(self.freedom, self.noise.stated)

    def to_json(self) -> dict[str, Any]:
        """What `fit` prints for scripts, SI; what is not finite becomes null when it is printed."""
        return {
            "parameters": self.parameters,
            "interval": dict(zip(self.unknown, self.interval.tolist(), strict=True)),
            "accepted": self.accepted,
            "residual_rms": self.residual_rms,
            "noise": self.noise.kind if self.noise.stated else "estimate",
            "noise_kind": self.noise.kind,
            "noise_size": dict(zip(self.noise.names, self.noise.size, strict=True)),
            "tied": {path: also for path, also in zip(self.unknown, self.tied, strict=False) if also},
            "correlation": self.correlation,
            "first": dict(zip(self.unknown, self.first.tolist(), strict=True)),
            "scale": self.scale,
            "converged": self.converged,
            "evaluations": self.evaluations,
            "name": self.name,
            "digest": self.digest,
            "assumed": self.assumed,
            "notes": texts(self.notes),
            self.over: self.at,
            "measured": {part.name: part.value for part in self.measured},
            "fitted": {part.name: part.fitted for part in self.measured},
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `unknown`, `other` (of the correlation) and speed, time or added."""
        over = (self.over,)
        own: dict[str, Any] = {"residual_rms": self.residual_rms, "scale": self.scale}
        own |= {"accepted": str(self.accepted).lower(), "noise": self.noise.kind}
        unit = {"speed": "rad s-1", "time": "s", "added": "m3"}[self.over]
        found = {
            "value": variable(("unknown",), self.value, "1", "value found, SI"),
            "std": variable(("unknown",), self.std, "1", "its standard error, SI"),
            "first": variable(("unknown",), self.first, "1", "value that the search began with, SI"),
            "correlation": variable(("unknown", "other"), self.correlation, "1", "of the errors"),
        }
        for part in self.measured:
            shown = part.unit or "1"
            found[f"{part.name}_measured"] = variable(over, part.value, shown, f"{part.name}, measured")
            found[f"{part.name}_fitted"] = variable(over, part.fitted, shown, f"{part.name}, by the scene")
        coords = {
            "unknown": variable(("unknown",), np.array(self.unknown), "1", "path in the scene"),
            self.over: variable(over, self.at, unit, self.over),
        }
        if self.curve is not None:
            dense = (f"{self.over}_curve",)
            coords[dense[0]] = variable(dense, self.curve.at, unit, f"{self.over} of the fitted curve")
            for part, values in zip(self.measured, self.curve.values, strict=True):
                long = f"{part.name}, by the scene between the measured points"
                found[f"{part.name}_curve"] = variable(dense, values, part.unit or "1", long)
        return NamedArrays(
            found,
            coords=coords,
            attrs=attributes(self, "fit", own, self.notes),
        )


def quantile(freedom: int, stated: bool) -> float:
    """Standard errors within which a value lies with 95 %: Student's, or normal where the noise is known."""
    from scipy.special import ndtri, stdtrit

    return float(ndtri(_UPPER) if stated else stdtrit(freedom, _UPPER))


def poor_note(rms: float, reason: str) -> Note:
    """That noise does not explain what is left (rms over that of what was measured), and why, in a clause."""
    text = (
        f"The scene does not meet the data: {100.0 * rms:.2g} % of their size are left, and {reason}. "
        "There are no standard errors."
    )
    return Note(FitCode.POOR, {"residual_rms": rms}, text)


def few_note(rms: float, freedom: int) -> Note:
    """That so few values cannot show whether what is left is noise."""
    more = f"{freedom} value{'' if freedom == 1 else 's'} more than unknowns"
    text = (
        f"{100.0 * rms:.2g} % of the data's size are left, and {more} cannot show whether that is noise: "
        "state the error of the sensor (--noise) or measure more. There are no standard errors."
    )
    return Note(FitCode.FEW, {"residual_rms": rms, "freedom": freedom}, text)


def large_note(rms: float) -> Note:
    """That what is left was taken for noise although it is much."""
    text = (
        f"{100.0 * rms:.2g} % of the data's size are left and taken for noise, which is much; state the "
        "error of the sensor (--noise) to have it judged."
    )
    return Note(FitCode.LARGE, {"residual_rms": rms}, text)


def repeated_note(searches: int) -> Note:
    """That the best values were found once."""
    text = f"Only one of {searches} searches came to these values: there may be better ones; raise --starts."
    return Note(FitCode.NOT_REPEATED, {"searches": searches}, text)


def plateau_note(path: str, value: float, edge: float, above: bool) -> Note:
    """That every value on one side fits as well."""
    side, bound = ("larger", "lower") if above else ("smaller", "upper")
    text = (
        f"Every {side} {path} fits as well as {number(value)}: the data give a {bound} bound alone, "
        f"{number(edge)}, and there is no standard error."
    )
    return Note(FitCode.PLATEAU, {"path": path, "value": value, "edge": edge}, text)


def lopsided_note(path: str, low: float, high: float) -> Note:
    """That a value may lie much further on one side than on the other."""
    text = (
        f"{path} is known much better on one side than on the other, {number(low)} to {number(high)} with "
        "95 %: there is no standard error."
    )
    return Note(FitCode.LOPSIDED, {"path": path, "low": low, "high": high}, text)


def flat_note(paths: Sequence[str], powers: Sequence[float]) -> Note:
    """That some unknowns are known in a combination only, and which changes leave the data as they are."""
    largest = max(abs(power) for power in powers)
    changes = ", ".join(
        f"{path} by {100.0 * power / largest / 10.0:+.2g} %"
        for path, power in zip(paths, powers, strict=True)
    )
    text = f"The data tell {', '.join(paths)} together only: changing {changes} changes nothing measured."
    return Note(FitCode.FLAT, {"paths": tuple(paths), "powers": tuple(powers)}, text)


def fit_notes(
    unknown: Sequence[str],
    value: Array,
    std: Array,
    correlation: Array,
    at_bound: Sequence[bool],
    shown: Sequence[bool],
    span: Array,
) -> list[Note]:
    """What the data cannot tell of p unknowns, in words; their correlation has shape (p, p).

    `at_bound`: the search ended there; `shown`: another note has said what is not known; `span`: large for an
    unknown of either sign, a length or an angle, nan of others.
    """
    found = []
    told = zip(unknown, value.tolist(), std.tolist(), at_bound, shown, span.tolist(), strict=True)
    for path, size, error, edge, said, large in told:
        if edge:
            text = f"{path} ended at the edge of the search, {number(size)}: the data do not bound it."
            found.append(Note(FitCode.AT_BOUND, {"path": path, "value": size}, text))
        elif said:
            continue
        elif math.isnan(error):
            text = f"The data do not tell {path}: nothing that was measured changes with it alone."
            found.append(Note(FitCode.NOT_TOLD, {"path": path}, text))
        elif not math.isnan(large):
            if error > VAGUE * large:
                text = f"The data hardly tell {path}: its standard error is {number(error)}."
                found.append(Note(FitCode.VAGUE, {"path": path, "std": error}, text))
        elif error > VAGUE * abs(size):
            text = f"The data hardly tell {path}: its standard error is {error / abs(size):.0%} of it."
            found.append(Note(FitCode.VAGUE, {"path": path, "share": error / abs(size)}, text))
    for i in range(len(unknown)):
        for j in range(i):
            if abs(correlation[i, j]) > BOTH:
                way = "product" if correlation[i, j] < 0.0 else "ratio"
                text = (
                    f"{unknown[j]} and {unknown[i]} are told together only (correlation "
                    f"{correlation[i, j]:.3f}): something like their {way} is known, not each of them."
                )
                data = {"paths": (unknown[j], unknown[i]), "correlation": float(correlation[i, j])}
                found.append(Note(FitCode.CORRELATED, data, text))
    return found
