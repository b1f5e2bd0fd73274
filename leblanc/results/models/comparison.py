"""What each liquid model answers for a scene, how far apart the answers are, and what they cost."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from leblanc.core.answer import Result, attributes
from leblanc.core.netcdf import NamedArrays, Variable, flags
from leblanc.core.netcdf import variable as var
from leblanc.studies.held.answer import MOTIONS
from leblanc.studies.run.answer import RunAnswer
from meshes.arrays import Array
from meshes.errors import InputError

if TYPE_CHECKING:
    pass


# Of each answer, over speed, as `run` has them.
_OVER_SPEED = (
    "amplitude", "liquid_offset", "amplitude_min", "amplitude_max", "state", "in_range", "error_estimate",
)  # fmt: skip


def _estimates(result: RunAnswer) -> Array:
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
    """What one liquid model says of a scene."""

    model: str  #: its name, as a scene has it
    reason: str  #: why it does not answer; empty where it does
    cpu_time: float | None  #: processor time that the answer took, s; None where there is none
    result: RunAnswer | None  #: the answer; None where there is none

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

    Raises
    ------
    InputError : no model answers

    Examples
    --------
    >>> import leblanc as lb
    >>> comparison = lb.compare(lb.example("horizontal_rig"), models=["statics", "linear"])
    >>> [answer.model for answer in comparison.answers if answer.answered]
    ['statics', 'linear']
    """

    figure: ClassVar[str] = "leblanc.figures.comparison:comparison_figure"
    summary: ClassVar[str] = "leblanc.text.explanation:comparison_facts"

    name: str  #: of the scene as it was given
    source: str
    assumed: tuple[str, ...]
    digest: str
    answers: tuple[ModelAnswer, ...]  #: one for each model, in the order given

    def __post_init__(self) -> None:
        if not any(answer.answered for answer in self.answers):
            raise InputError("answers", ", ".join(self.models), "at least one model that answers")

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models, in the order given."""
        return tuple(answer.model for answer in self.answers)

    @property
    def results(self) -> dict[str, RunAnswer]:
        """The answers that there are, by the name of their model."""
        return {answer.model: answer.result for answer in self.answers if answer.result is not None}

    @property
    def reference(self) -> str:
        """Name of the last model that answers."""
        return [*self.results][-1]

    @property
    def speed(self) -> Array:
        """Spin speed, rad/s, shape (n,)."""
        return self.results[self.reference].response.speed

    @property
    def amplitude_dry(self) -> Array:
        """Amplitude of the rotor without liquid, m, shape (n,)."""
        return self.results[self.reference].response.amplitude_dry

    def difference(self, model: str) -> Array:
        """Amplitude of a model less that of the reference, over the reference's largest, shape (n,).

        nan where one of the two has no finite amplitude or has not converged; zeros where no machine moves.
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
        """Largest size of `difference`; None where nothing can be compared."""
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

        def table(take: Callable[[RunAnswer], Array]) -> Array:
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
