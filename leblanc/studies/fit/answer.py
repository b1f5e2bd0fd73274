"""What `fit` answers: unknown values of a scene, how well each is known, residuals."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Notes, Picture, Table
from leblanc.core.netcdf import NamedArrays, Variable, variable
from leblanc.core.notes import Note, texts
from leblanc.core.units import MM, Unit
from meshes.arrays import Array
from meshes.quantity import Q

REACH = 100.0  # of the first guess: how far the search looks
HEAD = ("Unknown", "unit", "first guess", "found", "standard error", "of it", "95 % from", "to")
_UPPER = 0.975  # of the distribution: a twentieth lies outside both ends
_EACH = ("unknown",)


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

    kind: Annotated[
        str, Q(text="absolute, or relative to each reading; angles are always absolute", key="noise_kind")
    ]
    stated: bool  #: it was given; otherwise estimated from residuals
    names: tuple[str, ...]  #: the quantities
    size: tuple[float, ...]  #: standard deviation of each, SI, or a share of each reading

    @property
    def given(self) -> Annotated[str, Q(text="its kind where it was stated, else estimate", key="noise")]:
        return self.kind if self.stated else "estimate"

    @property
    def sizes(
        self,
    ) -> Annotated[dict[str, float], Q(text="standard deviation by quantity, SI", key="noise_size")]:
        return dict(zip(self.names, self.size, strict=True))


@dataclass(frozen=True)
class FittedCurve:
    """The fitted answer between the measured points."""

    at: Array  #: rad/s, s or m^3, rising, shape (m,)
    values: tuple[Array, ...]  #: of each quantity, in its unit, shape (m,)


@dataclass(frozen=True)
class FitAnswer(Answer):
    """Values of a scene that bring it closest to what was measured; p unknowns, n measured points.

    Examples
    --------
    >>> one = np.ones(1)
    >>> about, over = ("rig", "", (), "", ("rotor.mass",)), (np.eye(1), "speed", one)
    >>> answer = FitAnswer(*about, 4 * one, 0.1 * one, 5 * one, *over, (), 1, 0.02, True, 9, ())
    >>> answer.parameters
    {'rotor.mass': {'value': 4.0, 'std': 0.1}}
    """

    command = "fit"
    figure = "leblanc.studies.fit.figure:fit_figure"
    data = "fit.nc"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: Annotated[tuple[str, ...], Q(text="values of the scene that no source gives")]
    digest: Annotated[str, Q(text="fingerprint of the scene")]
    unknown: Annotated[tuple[str, ...], Q("1", "path in the scene", over=_EACH, json=False)]
    value: Annotated[Array, Q("1", "value found, SI", over=_EACH, json=False, error="std")]
    #: nan where the data do not tell it
    std: Annotated[Array, Q("1", "its standard error, SI", over=_EACH, json=False)]
    first: Annotated[Array, Q("1", "value that the search began with, SI", over=_EACH)]
    correlation: Annotated[Array, Q("1", "of the errors", over=("unknown", "other"))]
    over: str  #: "speed", "time" or "added" (liquid): what the quantities were measured over
    at: Array  #: those speeds, times or volumes, rad/s, s or m^3, rising, shape (n,)
    measured: tuple[Measured, ...]  #: the quantities
    #: of the first of them where each has its own; 1 where it is given
    scale: Annotated[float, Q("1", text="factor of the measured lengths over the scene's", data=False)]
    residual_rms: Annotated[
        float, Q("1", text="root mean square of the residuals over that of the readings", data=False)
    ]
    converged: Annotated[bool, Q(text="the best search came to its end")]
    evaluations: Annotated[int, Q("1", text="answers of the scene that were computed", data=False)]
    notes: Annotated[tuple[Note, ...], Q(text="what the data cannot tell")]
    signed: tuple[str, ...] = ()  #: unknowns that may have either sign
    #: degrees of freedom, measured values less those that were found; 0 where they are not known
    freedom: int = 0
    accepted: Annotated[bool, Q(text="noise, or the error of the model, explains the residuals")] = True
    noise: Annotated[Noise, Q(part=True)] = Noise("absolute", False, (), ())
    #: ends of the intervals of 95 %, where a profile gives them, SI, nan elsewhere,
    #: shape (p, 2)
    profile: Array | None = None
    tied: tuple[tuple[str, ...], ...] = ()  #: other paths that have the value of each unknown
    curve: FittedCurve | None = None
    units: tuple[Unit, ...] = ()  #: in which the values are shown, those of the scene's file

    @property
    def parameters(self) -> Annotated[dict[str, dict[str, float]], Q(text="value and std by path, SI")]:
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

    def shown_in(self, k: int) -> Unit:
        """Unit in which an unknown is shown."""
        return self.units[k] if self.units else Unit("SI", 1.0)

    @property
    def own(self) -> Mapping[str, Any]:
        said = {"accepted": str(self.accepted).lower(), "noise": self.noise.kind}
        return {"residual_rms": self.residual_rms, "scale": self.scale, **said}

    @property
    def faults(self) -> tuple[str, ...]:
        unknown = ", ".join("=".join((path, *also)) for path, also in self._tied())
        return () if self.converged else (f"the search for {unknown} did not come to its end",)

    @property
    def closing(self) -> str:
        return f"{self.name}: {len(self.unknown)} unknowns, {self.evaluations} answers"

    def _tied(self) -> tuple[tuple[str, tuple[str, ...]], ...]:
        """Each unknown with the paths that are tied to it."""
        return tuple(zip(self.unknown, self.tied or ((),) * len(self.unknown), strict=True))

    def to_json(self) -> dict[str, Any]:
        by_path = {"interval": self.interval, "first": self.first}
        return {
            **super().to_json(),
            **{name: dict(zip(self.unknown, each.tolist(), strict=True)) for name, each in by_path.items()},
            "tied": {path: also for path, also in self._tied() if also},
            self.over: self.at,
            "measured": {part.name: part.value for part in self.measured},
            "fitted": {part.name: part.fitted for part in self.measured},
        }

    def named_arrays(self) -> NamedArrays:
        found, over = super().named_arrays(), (self.over,)
        unit = {"speed": "rad s-1", "time": "s", "added": "m3"}[self.over]
        coordinates = {self.over: variable(over, self.at, unit, self.over)}
        parts: dict[str, Variable] = {}
        for part in self.measured:
            shown = part.unit or "1"
            parts[f"{part.name}_measured"] = variable(over, part.value, shown, f"{part.name}, measured")
            parts[f"{part.name}_fitted"] = variable(over, part.fitted, shown, f"{part.name}, by the scene")
        if self.curve is not None:
            dense = (f"{self.over}_curve",)
            coordinates[dense[0]] = variable(dense, self.curve.at, unit, f"{self.over} of the fitted curve")
            for part, values in zip(self.measured, self.curve.values, strict=True):
                long = f"{part.name}, by the scene between the measured points"
                parts[f"{part.name}_curve"] = variable(dense, values, part.unit or "1", long)
        return replace(found, variables={**found.variables, **parts}, coords={**found.coords, **coordinates})

    def blocks(self) -> tuple[Block, ...]:
        verdict = "accepted" if self.accepted else "not accepted"
        count = sum(part.value.size for part in self.measured)
        left = f"{100.0 * self.residual_rms:.2g} % of the measured size, over {count} values; {verdict}"
        return (
            Table([self._row(k) for k in range(len(self.unknown))], HEAD, right=True),
            Table([("Left", left), ("Noise", self._noise_words())]),
            Notes(texts(self.notes)),
            Picture("fit", "Measured and fitted", self.figure),
        )

    def _row(self, k: int) -> tuple[str, ...]:
        """What is known of one unknown, as `HEAD` heads it."""
        path, also = self._tied()[k]
        value, std, unit = float(self.value[k]), float(self.std[k]), self.shown_in(k)
        known = not math.isnan(std)
        bare = path in self.signed  # a position or an angle has no size to compare with
        share = "" if bare else f"{100.0 * std / abs(value):.2g} %" if known else "not reported"
        ends = [
            unit.number(end) if math.isfinite(end) else "not reported" for end in self.interval[k].tolist()
        ]
        error = unit.number(std) if known else "not reported"
        first = unit.number(float(self.first[k]))
        return (" = ".join((path, *also)), unit.name, first, unit.number(value), error, share, *ends)

    def _noise_words(self) -> str:
        """Noise that the values are weighted by."""
        parts = []
        units = {part.name: part.unit for part in self.measured}
        for name, size in self.noise.sizes.items():
            if self.noise.kind == "relative" and units[name] != "rad":
                parts.append(f"{name} {100.0 * size:.2g} % of each reading")
            elif units[name] == "m":
                parts.append(f"{name} {float(f'{size * MM:.2g}'):g} mm")
            else:
                parts.append(f"{name} {size:.2g} {units[name]}".strip())
        given = "as stated" if self.noise.stated else "estimated from the residuals"
        return f"{self.noise.kind}, {given}: " + ", ".join(parts)


def quantile(freedom: int, stated: bool) -> float:
    """Standard errors within which a value lies with 95 %: Student's, or normal where the noise is known."""
    from scipy.special import ndtri, stdtrit

    return float(ndtri(_UPPER) if stated else stdtrit(freedom, _UPPER))
