"""A scene in numbers with the liquid model at each speed, and one scene by several liquid models."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import asdict, dataclass, fields
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from fluid.numbers import LayerNumbers
from leblanc.results.base import Result, attributes
from leblanc.results.choice import HeldCost, ModelSpan, SpeedEstimate
from leblanc.results.exciter import named_speeds, number_or_none
from leblanc.results.motion.held import MOTIONS
from leblanc.results.motion.tilting import RestMode
from leblanc.results.netcdf import NamedArrays, Variable, flags
from leblanc.results.netcdf import variable as var
from leblanc.results.response import RunResult
from meshes.arrays import Array
from meshes.errors import InputError

if TYPE_CHECKING:
    from solvers.rotor.exciter.machine import Dimensionless


@dataclass(frozen=True)
class LayerExplanation:
    """One chamber in numbers, at the first and the last speed where they change.

    Parameters
    ----------
    numbers : dimensionless numbers, shape (2,) where they depend on speed
    depth : mean depth of the layer at fast spin, m
    added_mass_ratio : mass of a full chamber over the rotor's, m_f/M
    liquid_mass_ratio : mass of the liquid over the rotor's
    optimal_volume : that just covers the wall at the dry rotor's deflection at the last speed, m^3; nan where
        baffles cut the liquid or the section is no circle
    walls : baffles, or the file of the section, in words; empty for a plain ring
    carried_from : speed from which the walls carry the liquid round from rest, rad/s, inf where they never
        do; None if the axis stands, or the section is no circle
    """

    numbers: LayerNumbers
    depth: float
    added_mass_ratio: float
    liquid_mass_ratio: float
    optimal_volume: float
    walls: str = ""
    carried_from: float | None = None


@dataclass(frozen=True)
class WhirlOutlook:
    """How large a self-excited whirl may grow, by rule and not by solving for it [theory: whirl, eq. 29].

    Parameters
    ----------
    speed : spin speed of the scene inside a band of self-excited whirl at which it is largest, rad/s
    amplitude : of the axis at the chambers, m; mostly within 10 %, up to half of it off next to an edge
    whirl_speed : in space, rad/s
    lag : of the liquid behind the drum, rad/s
    """

    speed: float
    amplitude: float
    whirl_speed: float
    lag: float


_ABOUT = ("source", "assumed", "digest")  # of the scene; not part of the JSON


@dataclass(frozen=True)
class Explanation(Result):
    """A scene in numbers.

    Parameters
    ----------
    name : of the scene
    critical_speed_dry, critical_speed_wet : without liquid, and with it at small deflections, rad/s; of
        several the one at which the unbalance moves the axis most
    damping_ratio : of the support; of several modes the one next to the dry critical speed, at that speed
    speed_ratio : first and last speed over the dry critical speed
    captured_from : speed above which the liquid rides with the drum, rad/s; None if at every speed
    layers : one for each chamber; None for an empty one
    models : which model answers at each speed, how well, and why
    estimates : what is expected at every speed
    tolerance : relative error that the scene allows
    modes : of the dry rotor at rest; none for a planar rotor, whose only one is the critical speed
    runup : which liquid model the run-up will take, in words; empty without one
    whirl : how large the whirl grows by itself; None where none does, or nothing bounds it
    held : what it takes to hold in time what steady models do not answer; None where they answer all
    source, assumed, digest : of the scene

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("horizontal_rig"))
    >>> sorted({span.model for span in explanation.models})
    ['linear']
    """

    figure: ClassVar[str] = "leblanc.figures.explanation:model_figure"
    summary: ClassVar[str] = "leblanc.text.explanation:facts"

    name: str
    critical_speed_dry: float
    critical_speed_wet: float
    damping_ratio: float
    speed_ratio: tuple[float, float]
    captured_from: float | None
    layers: tuple[LayerExplanation | None, ...]
    models: tuple[ModelSpan, ...]
    tolerance: float
    modes: tuple[RestMode, ...] = ()
    runup: str = ""
    whirl: WhirlOutlook | None = None
    held: HeldCost | None = None
    estimates: tuple[SpeedEstimate, ...] = ()
    source: str = ""
    assumed: tuple[str, ...] = ()
    digest: str = ""

    def to_json(self) -> dict[str, Any]:
        """What `explain` prints for scripts, SI; what is not finite becomes null when it is printed."""
        return {name: value for name, value in asdict(self).items() if name not in _ABOUT}

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `chamber`, `end` (first and last speed) and `span` (of one model)."""
        rate, span = "rad s-1", ("span",)
        ends = np.array(self.speed_ratio) * self.critical_speed_dry
        captured = math.nan if self.captured_from is None else self.captured_from
        spans = {
            field.name: np.array([getattr(span, field.name) for span in self.models])
            for field in fields(ModelSpan)
        }
        return NamedArrays(
            {
                "critical_speed_dry": var((), self.critical_speed_dry, rate, "critical speed without liquid"),
                "critical_speed_wet": var((), self.critical_speed_wet, rate, "critical speed with liquid"),
                "damping_ratio": var((), self.damping_ratio, "1", "damping ratio", "of the support"),
                "capture_speed": var((), captured, rate, "capture speed", "the liquid rides with the drum"),
                **_whirl_variables(self.whirl),
                **_held_variables(self.held),
                "tolerance": var((), self.tolerance, "1", "tolerance", "relative error that is allowed"),
                "first": var(span, spans["first"], rate, "first speed of a liquid model"),
                "last": var(span, spans["last"], rate, "last speed of a liquid model"),
                "model": var(span, spans["model"], "1", "liquid model"),
                "in_range": flags(span, spans["in_range"], "no yes", "the model holds there"),
                "error": var(span, spans["error"], "1", "estimated error", "largest, relative"),
                "reason": var(span, spans["reason"], "1", "why that model"),
                **_layer_variables(self.layers),
                **_estimate_variables(self.estimates),
            },
            coords={"speed": var(("end",), ends, rate, "spin speed", "first and last of the scene")},
            attrs=attributes(self, "explain", {}, ()),
        )


def _whirl_variables(whirl: WhirlOutlook | None) -> dict[str, Variable]:
    """The estimate of the self-excited whirl, nan where there is none."""
    parts = {
        "whirl_spin": ("speed", "rad s-1", "spin speed"),
        "whirl_amplitude": ("amplitude", "m", "amplitude"),
        "whirl_speed": ("whirl_speed", "rad s-1", "whirl speed"),
        "whirl_lag": ("lag", "rad s-1", "lag of the liquid"),
    }
    return {
        name: var((), math.nan if whirl is None else getattr(whirl, own), unit, words, "by rule")
        for name, (own, unit, words) in parts.items()
    }


def _held_variables(held: HeldCost | None) -> dict[str, Variable]:
    """What motions held in time take, none where there are none."""
    count, seconds = (0, 0.0) if held is None else (held.speeds, held.seconds)
    return {
        "held_speeds": var((), count, "1", "speeds to hold in time"),
        "held_seconds": var((), seconds, "s", "processor time to hold them", "good to a factor of two"),
    }


def _estimate_variables(estimates: tuple[SpeedEstimate, ...]) -> dict[str, Variable]:
    """What is expected at every speed."""
    parts = {
        "speed": ("rad s-1", "spin speed"),
        "error": ("1", "estimated error of the mean amplitude"),
        "liquid_error": ("1", "estimated error of the liquid's mean offset"),
        "ripple": ("1", "estimated ripple of the amplitude"),
        "liquid_ripple": ("m", "estimated ripple of the liquid's centre of mass"),
    }
    return {
        f"at_{name}": var(("at",), np.array([getattr(each, name) for each in estimates]), unit, words)
        for name, (unit, words) in parts.items()
    }


def _or_nan(value: float | None) -> float:
    """A number for an array."""
    return math.nan if value is None else value


def _layer_variables(layers: tuple[LayerExplanation | None, ...]) -> dict[str, Variable]:
    """Numbers of every chamber, nan for an empty one."""
    units = {"depth": "m", "optimal_volume": "m3", "added_mass_ratio": "1", "liquid_mass_ratio": "1"}
    units["carried_from"] = "rad s-1"
    found = {
        name: var(
            ("chamber",),
            np.array([_or_nan(None if layer is None else getattr(layer, name)) for layer in layers]),
            unit,
            name.replace("_", " "),
        )
        for name, unit in units.items()
    }
    for field in fields(LayerNumbers):
        values = [
            np.full(2, math.nan) if layer is None else np.broadcast_to(getattr(layer.numbers, field.name), 2)
            for layer in layers
        ]
        table = np.array(values, dtype=float).reshape(-1, 2)
        found[field.name] = var(("chamber", "end"), table, "1", field.name.replace("_", " "))
    return found


@dataclass(frozen=True)
class ExciterExplanation(Result):
    """Numbers that determine how a vibrating table with balls behaves, without any integration in time.

    Parameters
    ----------
    name : of the scene
    natural_frequency : of the platform, rad/s
    speed_ratio : first and last shaft speed over it
    dimensionless : numbers of the machine
    characteristic : shaft speeds between which there are three stuck speeds and, second, where the slowest
        passes the resonance, rad/s; nan if there is one at every speed
    critical_speed_printed : by the source's regression, rad/s; nan outside its ranges
    source, assumed, digest : of the scene

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("vibratory_table"))
    >>> [f"{speed:.4g} rad/s" for speed in explanation.characteristic]
    ['70.8 rad/s', '1540 rad/s', '1542 rad/s']
    """

    figure: ClassVar[str] = "leblanc.figures.explanation:stuck_range_figure"
    summary: ClassVar[str] = "leblanc.text.explanation:exciter_facts"

    name: str
    natural_frequency: float
    speed_ratio: tuple[float, float]
    dimensionless: Dimensionless
    characteristic: tuple[float, float, float]
    critical_speed_printed: float
    source: str = ""
    assumed: tuple[str, ...] = ()
    digest: str = ""

    @property
    def characteristic_speeds(self) -> dict[str, float | None]:
        """Shaft speeds where the stuck speeds change, rad/s, by name."""
        return named_speeds(self.characteristic)

    def to_json(self) -> dict[str, Any]:
        """What `explain` prints for scripts, SI, null for what is not there."""
        return {
            "name": self.name,
            "natural_frequency": self.natural_frequency,
            "speed_ratio": list(self.speed_ratio),
            "dimensionless": asdict(self.dimensionless),
            "characteristic_speeds": self.characteristic_speeds,
            "critical_speed_printed": number_or_none(self.critical_speed_printed),
        }

    def named_arrays(self) -> NamedArrays:
        """Single numbers."""
        rate = "rad s-1"
        numbers = {
            name: var((), value, "1", name.replace("_", " "))
            for name, value in asdict(self.dimensionless).items()
        }
        first, through, last = self.characteristic
        return NamedArrays(
            {
                "natural_frequency": var((), self.natural_frequency, rate, "natural frequency"),
                "second_pair": var((), first, rate, "shaft speed", "from here on three stuck speeds"),
                "through_resonance": var((), through, rate, "shaft speed", "slowest at the resonance"),
                "merger": var((), last, rate, "shaft speed", "up to here three stuck speeds"),
                "critical_speed_printed": var((), self.critical_speed_printed, rate, "critical speed"),
                **numbers,
            },
            coords={},
            attrs=attributes(self, "explain", {}, ()),
        )


# Of each answer, over speed, as `run` has them.
_OVER_SPEED = (
    "amplitude", "liquid_offset", "amplitude_min", "amplitude_max", "state", "in_range", "error_estimate",
)  # fmt: skip


def _estimates(result: RunResult) -> Array:
    """Estimated error at each speed; nan where there is none."""
    found = result.error_estimate
    return np.full(result.speed.shape, np.nan) if found is None else found


def _held_counts(answers: tuple[ModelAnswer, ...]) -> dict[str, Variable]:
    """How many motions held in time are of each kind, by model; nothing where none was held."""
    counts = [answer.held for answer in answers]
    if not any(counts):
        return {}
    return {
        f"held_{kind}": var(
            ("model",),
            np.array([0 if own is None else own[kind] for own in counts]),
            "1",
            f"held motions that are {kind.replace('_', ' ')}",
        )
        for kind in MOTIONS
    }


@dataclass(frozen=True)
class ModelAnswer:
    """What one liquid model says of a scene.

    Parameters
    ----------
    model : its name, as a scene has it
    reason : why it does not answer; empty where it does
    cpu_time : processor time that the answer took, s; None where there is none
    result : the answer; None where there is none
    """

    model: str
    reason: str
    cpu_time: float | None
    result: RunResult | None

    @property
    def answered(self) -> bool:
        """The model answers this scene."""
        return self.result is not None

    @property
    def peak_amplitude(self) -> float | None:
        """Largest amplitude over the range of speeds, m; None where there is none, or none that is finite."""
        found = math.nan if self.result is None else self.result.peak["amplitude"]
        return found if math.isfinite(found) else None

    @property
    def largest_error(self) -> float | None:
        """Largest error that the model estimates for itself, relative; infinite without a bound.

        Speeds at which it has no estimate do not count; None where it has none at all.
        """
        error = None if self.result is None else self.result.error_estimate
        return None if error is None or np.isnan(error).all() else float(np.nanmax(error))

    @property
    def in_range_share(self) -> float | None:
        """Part of the speeds at which the model is within its range."""
        return None if self.result is None else float(np.mean(self.result.in_range))

    @property
    def held(self) -> dict[str, int] | None:
        """How many of the motions held in time are of each kind of `MOTIONS`; None where none was held."""
        if self.result is None or self.result.held is None:
            return None
        held = self.result.held
        return {kind: int(np.count_nonzero(held.at & (held.state == kind))) for kind in MOTIONS}


@dataclass(frozen=True)
class Comparison(Result):
    """The answers of several liquid models to one scene; n speeds, m models.

    The reference of all differences is the last model that answers: name the models by rising exactness.

    Parameters
    ----------
    name, source, assumed, digest : of the scene as it was given
    answers : one for each model, in the order given

    Raises
    ------
    InputError : no model answers

    Examples
    --------
    >>> import leblanc as lb
    >>> comparison = lb.compare(lb.example("horizontal_rig"), models=["statics", "linear", "fem"])
    >>> [answer.model for answer in comparison.answers if answer.answered]
    ['statics', 'linear', 'fem']
    """

    figure: ClassVar[str] = "leblanc.figures.comparison:comparison_figure"
    summary: ClassVar[str] = "leblanc.text.explanation:comparison_facts"

    name: str
    source: str
    assumed: tuple[str, ...]
    digest: str
    answers: tuple[ModelAnswer, ...]

    def __post_init__(self) -> None:
        if not any(answer.answered for answer in self.answers):
            raise InputError("answers", ", ".join(self.models), "at least one model that answers")

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models, in the order given."""
        return tuple(answer.model for answer in self.answers)

    @property
    def results(self) -> dict[str, RunResult]:
        """The answers that there are, by the name of their model."""
        return {answer.model: answer.result for answer in self.answers if answer.result is not None}

    @property
    def reference(self) -> str:
        """Name of the last model that answers."""
        return [*self.results][-1]

    @property
    def speed(self) -> Array:
        """Spin speed, rad/s, shape (n,)."""
        return self.results[self.reference].speed

    @property
    def amplitude_dry(self) -> Array:
        """Amplitude of the rotor without liquid, m, shape (n,)."""
        return self.results[self.reference].amplitude_dry

    def difference(self, model: str) -> Array:
        """Amplitude of a model less that of the reference, over the reference's largest amplitude.

        Parameters
        ----------
        model : one that answers

        Returns
        -------
        nan where one of the two has no finite amplitude or has not converged, shape (n,); zeros where no
        machine moves
        """
        pair = [self.results[name] for name in (model, self.reference)]
        own, other = (result.amplitude for result in pair)
        known = np.isfinite(own) & np.isfinite(other) & pair[0].converged & pair[1].converged
        found = np.full(own.shape, np.nan)
        found[known] = own[known] - other[known]
        largest = self.results[self.reference].peak["amplitude"]
        size = largest if math.isfinite(largest) else float(np.max(other[known], initial=0.0))
        # Without any deflection of the reference there is nothing to compare with but zero itself.
        return found / size if size > 0.0 else np.where(found == 0.0, 0.0, np.nan)

    def largest_difference(self, model: str) -> float | None:
        """Largest size of `difference`; None where nothing can be compared.

        Parameters
        ----------
        model : one that answers
        """
        size = np.abs(self.difference(model))
        return None if np.isnan(size).all() else float(np.nanmax(size))

    def to_json(self) -> dict[str, Any]:
        """What `compare` prints for scripts, SI; values of a model that does not answer are None (null)."""
        return {
            "models": [self._entry(answer) for answer in self.answers],
            "reference": self.reference,
            "speed": self.speed,
            "amplitude_dry": self.amplitude_dry,
            "name": self.name,
            "digest": self.digest,
        }

    def _entry(self, answer: ModelAnswer) -> dict[str, Any]:
        found = answer.result
        return {
            "model": answer.model,
            "answered": answer.answered,
            "reason": answer.reason,
            "cpu_time": answer.cpu_time,
            **{name: None if found is None else getattr(found, name) for name in _OVER_SPEED},
            "peak_amplitude": answer.peak_amplitude,
            "largest_difference": self.largest_difference(answer.model) if answer.answered else None,
            "largest_error": answer.largest_error,
            "in_range_share": answer.in_range_share,
            "held": answer.held,
        }

    def named_arrays(self) -> NamedArrays:
        """Arrays over the dimensions `model` and `speed`; nan where a model does not answer."""
        each, over = ("model",), ("model", "speed")
        answered = np.array([answer.answered for answer in self.answers])

        def table(take: Callable[[RunResult], Array]) -> Array:
            nothing = np.full(self.speed.shape, np.nan)
            return np.stack(
                [nothing if answer.result is None else take(answer.result) for answer in self.answers]
            )

        def numbers(values: list[float | None]) -> Array:
            return np.array(values, dtype=np.float64)

        largest = [
            self.largest_difference(answer.model) if answer.answered else None for answer in self.answers
        ]
        peaks, times, errors, shares = (
            [getattr(answer, key) for answer in self.answers]
            for key in ("peak_amplitude", "cpu_time", "largest_error", "in_range_share")
        )
        amplitude, offset = table(lambda result: result.amplitude), table(lambda result: result.liquid_offset)
        least, most = table(lambda result: result.amplitude_min), table(lambda result: result.amplitude_max)
        told = table(_estimates)
        within = table(lambda result: result.in_range.astype(float)) == 1.0
        dry, reference = self.amplitude_dry, f"from {self.reference}, over its largest amplitude"
        reasons = np.array([answer.reason for answer in self.answers], dtype=object)
        return NamedArrays(
            {
                "answered": flags(each, answered, "no yes", "answered", "the model answers this scene"),
                "reason": var(each, reasons, "1", "reason", "why the model does not answer"),
                "cpu_time": var(each, numbers(times), "s", "processor time", "that the answer took"),
                "amplitude": var(over, amplitude, "m", "amplitude", "of the branch reported"),
                "amplitude_dry": var(("speed",), dry, "m", "amplitude", "without liquid"),
                "liquid_offset": var(over, offset, "m", "liquid offset", "rotation axis to centre of mass"),
                "peak_amplitude": var(each, numbers(peaks), "m", "largest amplitude", "over the speeds"),
                "largest_difference": var(each, numbers(largest), "1", "largest difference", reference),
                "amplitude_min": var(over, least, "m", "least amplitude", "over time"),
                "amplitude_max": var(over, most, "m", "largest amplitude", "over time"),
                "error_estimate": var(over, told, "1", "estimated error", "by the model itself, relative"),
                "in_range": flags(over, within, "no yes", "in range", "of the model"),
                "largest_error": var(
                    each, numbers(errors), "1", "largest estimated error", "over the speeds"
                ),
                "in_range_share": var(each, numbers(shares), "1", "share in range", "of the speeds"),
                **_held_counts(self.answers),
            },
            coords={
                "speed": var(("speed",), self.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
                "model": var(each, np.array(self.models, dtype=object), "1", "liquid model", "as asked for"),
            },
            attrs=attributes(self, "compare", {"reference": self.reference}, ()),
        )
