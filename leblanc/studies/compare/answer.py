"""What each liquid model answers for a scene, how far apart the answers are, and what they cost."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Picture, Table, Words
from leblanc.core.netcdf import NamedArrays, variable
from leblanc.core.notes import EXACT, WHOLE, one_line
from leblanc.core.units import LENGTH, NOT_FOUND, RPM, ZERO_TO_PEAK, Unit, number, unit_for, with_unit
from leblanc.studies.held.answer import MOTIONS
from leblanc.studies.run.answer import RunAnswer
from leblanc.studies.run.words import amplitude_place, unanswered
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from meshes.quantity import Q

REFUSED = "does not answer"
_OVER = ("speed",)


@dataclass(frozen=True)
class ModelAnswer:
    """What one liquid model says of a scene; of one that does not answer all values are None."""

    model: Annotated[str, Q("1", "liquid model", "as asked for", variable="model")]
    #: empty where it does
    reason: Annotated[str, Q("1", "reason", "why the model does not answer", variable="reason")]
    cpu_time: Annotated[float | None, Q("s", "processor time", "that the answer took", variable="cpu_time")]
    result: RunAnswer | None  #: the answer
    #: its amplitude less that of the reference, over the reference's largest, shape (n,)
    difference: Array | None = None

    @property
    def answered(
        self,
    ) -> Annotated[
        bool, Q("", "answered", "the model answers this scene", flags="no yes", variable="answered")
    ]:
        return self.result is not None

    @property
    def amplitude(
        self,
    ) -> Annotated[
        Array | None,
        Q("m", "amplitude", "of the branch reported", _OVER, variable="amplitude", error="error_estimate"),
    ]:
        return None if self.result is None else self.result.amplitude

    @property
    def liquid_offset(
        self,
    ) -> Annotated[
        Array | None,
        Q(
            "m",
            "liquid offset",
            "rotation axis to centre of mass",
            _OVER,
            variable="liquid_offset",
            error="error_estimate",
        ),
    ]:
        return None if self.result is None else self.result.liquid_offset

    @property
    def amplitude_min(
        self,
    ) -> Annotated[Array | None, Q("m", "least amplitude", "over time", _OVER, variable="amplitude_min")]:
        return None if self.result is None else self.result.amplitude_min

    @property
    def amplitude_max(
        self,
    ) -> Annotated[Array | None, Q("m", "largest amplitude", "over time", _OVER, variable="amplitude_max")]:
        return None if self.result is None else self.result.amplitude_max

    @property
    def state(
        self,
    ) -> Annotated[NDArray[np.str_] | None, Q(text="state of the motion, once it is settled", data=False)]:
        return None if self.result is None else self.result.state

    @property
    def in_range(
        self,
    ) -> Annotated[
        Flags | None, Q("", "in range", "of the model", _OVER, flags="no yes", variable="in_range")
    ]:
        return None if self.result is None else self.result.in_range

    @property
    def error_estimate(
        self,
    ) -> Annotated[
        Array | None,
        Q("1", "estimated error", "by the model itself, relative", _OVER, variable="error_estimate"),
    ]:
        return None if self.result is None else self.result.error_estimate

    @property
    def peak_amplitude(
        self,
    ) -> Annotated[float | None, Q("m", "largest amplitude", "over the speeds", variable="peak_amplitude")]:
        found = math.nan if self.result is None else self.result.peak["amplitude"]
        return found if math.isfinite(found) else None

    @property
    def largest_difference(
        self,
    ) -> Annotated[
        float | None,
        Q(
            "1",
            "largest difference",
            "from the reference, over its largest amplitude",
            variable="largest_difference",
        ),
    ]:
        size = np.abs(math.nan if self.difference is None else self.difference)
        return None if np.isnan(size).all() else float(np.nanmax(size))

    @property
    def largest_error(
        self,
    ) -> Annotated[
        float | None, Q("1", "largest estimated error", "infinite without a bound", variable="largest_error")
    ]:
        # Speeds at which it has no estimate do not count.
        error = self.error_estimate
        return None if error is None or np.isnan(error).all() else float(np.nanmax(error))

    @property
    def in_range_share(
        self,
    ) -> Annotated[float | None, Q("1", "share in range", "of the speeds", variable="in_range_share")]:
        return None if self.result is None else float(np.mean(self.result.in_range))

    @property
    def held(
        self,
    ) -> Annotated[
        dict[str, int] | None, Q("1", "how many of the time-domain states are of each kind", data=False)
    ]:
        if self.result is None or self.result.held is None:
            return None
        held = self.result.held
        return {kind: int(np.count_nonzero(held.at & (held.state == kind))) for kind in MOTIONS}


def apart(own: RunAnswer, reference: RunAnswer) -> Array:
    """Amplitude of a model less that of the reference, over the reference's largest, shape (n,).

    nan where one of the two has no finite amplitude or has not converged; zeros where no machine moves.
    """
    known = (
        np.isfinite(own.amplitude) & np.isfinite(reference.amplitude) & own.converged & reference.converged
    )
    found = np.full(own.amplitude.shape, np.nan)
    found[known] = own.amplitude[known] - reference.amplitude[known]
    largest = reference.peak["amplitude"]
    size = largest if math.isfinite(largest) else float(np.max(reference.amplitude[known], initial=0.0))
    # Without any deflection of the reference there is nothing to compare with but zero itself.
    return found / size if size > 0.0 else np.where(found == 0.0, 0.0, np.nan)


@dataclass(frozen=True)
class CompareAnswer(Answer):
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

    command, title, data = "compare", "Response by several liquid models", "compare.nc"
    figure = "leblanc.studies.compare.figure:comparison_figure"

    name: Annotated[str, Q(text="of the scene as it was given")]
    source: str
    assumed: tuple[str, ...]
    digest: Annotated[str, Q(text="of the scene")]
    answers: Annotated[tuple[ModelAnswer, ...], Q(text="by model, as asked for", key="models", rows="model")]

    def __post_init__(self) -> None:
        if not self.results:
            raise InputError("answers", ", ".join(self.models), "at least one model that answers")
        last = self.results[self.reference]
        found = (
            each if each.result is None else replace(each, difference=apart(each.result, last))
            for each in self.answers
        )
        object.__setattr__(self, "answers", tuple(found))

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models, in the order given."""
        return tuple(answer.model for answer in self.answers)

    @property
    def results(self) -> dict[str, RunAnswer]:
        """The answers that there are, by the name of their model."""
        return {answer.model: answer.result for answer in self.answers if answer.result is not None}

    @property
    def reference(self) -> Annotated[str, Q(text="last model that answers")]:
        return [*self.results][-1]

    @property
    def speed(self) -> Annotated[Array, Q("rad s-1", "spin speed", "of the rotor about its axis", _OVER)]:
        return self.results[self.reference].response.speed

    @property
    def amplitude_dry(self) -> Annotated[Array, Q("m", "amplitude", "without liquid", _OVER)]:
        return self.results[self.reference].response.amplitude_dry

    def difference(self, model: str) -> Array:
        """Amplitude of a model less that of the reference, over the reference's largest, shape (n,)."""
        return apart(self.results[model], self.results[self.reference])

    def largest_difference(self, model: str) -> float | None:
        """Largest size of `difference`; None where nothing can be compared."""
        return next(each.largest_difference for each in self.answers if each.model == model)

    @property
    def own(self) -> Mapping[str, Any]:
        return {"reference": self.reference}

    @property
    def faults(self) -> list[str]:
        return [f"{name}: {text}" for name, result in self.results.items() for text in unanswered(result)]

    @property
    def closing(self) -> str:
        return f"{self.name}: {len(self.results)} of {len(self.models)} models answered"

    def named_arrays(self) -> NamedArrays:
        """With how many motions that were held are of each kind, where any was held."""
        found, counts = super().named_arrays(), [answer.held for answer in self.answers]
        kinds = MOTIONS if any(counts) else ()
        held = {
            f"held_{kind}": variable(
                *(("model",), np.array([0 if own is None else own[kind] for own in counts])),
                *("1", f"held motions that are {kind.replace('_', ' ')}"),
            )
            for kind in kinds
        }
        return replace(found, variables={**found.variables, **held})

    def blocks(self) -> tuple[Block, ...]:
        basis = (
            f"Differences are the largest over the speeds, from {self.reference}, as a share of its largest "
            "amplitude.\nEstimates are the largest error that a model knows of itself; in range is the part "
            "of the speeds."
        )
        silent = (one for one in self.answers if not one.answered)
        facts = [("Scene", one_line(self.name)), *((one.model, _fact(self, one)) for one in self.answers)]
        return (
            Table(facts, shown="page"),
            Table(comparison_rows(self), comparison_head(self), right=True, shown="text"),
            Words(basis, shown="text"),
            *(Words(one_line(one.reason), one.model, shown="text") for one in silent),
            Picture("compare", "Amplitude over speed by liquid model", self.figure),
        )


def comparison_head(found: CompareAnswer) -> tuple[str, ...]:
    """Headings of the table of models."""
    place = next((amplitude_place(result) for result in found.results.values()), "")
    amplitude = f"largest amplitude{f' {place}' if place else ''}, {ZERO_TO_PEAK} ({_unit(found).name})"
    held = ("time-domain states",) if _any_held(found) else ()
    return (
        "model",
        amplitude,
        "at (rpm)",
        "difference (%)",
        "estimate (%)",
        "in range (%)",
        *held,
        "CPU time (s)",
    )


def _any_held(found: CompareAnswer) -> bool:
    """Some model's motions were integrated in time."""
    return any(answer.held for answer in found.answers)


def _unit(found: CompareAnswer) -> Unit:
    """Unit of the amplitudes of all models."""
    peaks = [answer.peak_amplitude for answer in found.answers]
    return unit_for(LENGTH, *(size for size in peaks if size is not None))


def comparison_rows(found: CompareAnswer) -> list[tuple[str, ...]]:
    """A row of the table for each model, as `comparison_head` says."""
    return [_comparison_row(found, answer) for answer in found.answers]


def _comparison_row(found: CompareAnswer, answer: ModelAnswer) -> tuple[str, ...]:
    if answer.result is None or answer.cpu_time is None:
        return answer.model, REFUSED, *[""] * (len(comparison_head(found)) - 2)
    at, amplitude = answer.result.peak["speed"], answer.peak_amplitude
    return (
        answer.model,
        NOT_FOUND if amplitude is None else _unit(found).number(amplitude),
        "" if math.isnan(at) else number(at * RPM),
        "reference" if answer.model == found.reference else difference(found, answer.model),
        _estimate(answer),
        "" if answer.in_range_share is None else f"{100.0 * answer.in_range_share:.3g}",
        *([held_words(answer)] if _any_held(found) else []),
        f"{answer.cpu_time:.2g}",
    )


def _estimate(answer: ModelAnswer) -> str:
    """Largest error that a model estimates for itself, per cent."""
    error = answer.largest_error
    if error is None:
        return "not known"
    if math.isinf(error):
        return "no bound"
    if error < EXACT:
        return "rounding"
    return "100 or more" if error >= WHOLE else f"{100.0 * error:.2g}"


def held_words(answer: ModelAnswer) -> str:
    """How many time-domain states are of each kind; none where a model is steady."""
    if answer.held is None:
        return "none"
    return ", ".join(f"{count} {kind.replace('_', ' ')}" for kind, count in answer.held.items() if count)


def difference(found: CompareAnswer, model: str) -> str:
    """Largest difference of a model from the reference, per cent."""
    size = found.largest_difference(model)
    if size is None:
        return NOT_FOUND
    return "rounding" if 0.0 < size < EXACT else f"{100.0 * size:.2g}"


def _fact(found: CompareAnswer, answer: ModelAnswer) -> str:
    if answer.result is None or answer.cpu_time is None:
        return f"{REFUSED}: {one_line(answer.reason)}"
    parts = [f"{_size(answer)} at most"]
    if answer.model == found.reference:
        parts.append("the reference")
    else:
        size = difference(found, answer.model)
        parts.append(f"difference {size}{' %' if size[0].isdigit() else ''}")
    if answer.held:
        parts.append(f"time-domain states: {held_words(answer)}")
    return ", ".join([*parts, f"{answer.cpu_time:.2g} s of processor time"])


def _size(answer: ModelAnswer) -> str:
    """Largest amplitude with its unit."""
    return NOT_FOUND if answer.peak_amplitude is None else with_unit(answer.peak_amplitude, LENGTH)


def comparison_alt(found: CompareAnswer) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    peaks = [f"{answer.model} {_size(answer)}" for answer in found.answers if answer.answered]
    below = "; below, their differences" if len(peaks) > 1 else ""
    held = [f"{a.model} integrated in time: {held_words(a)}" for a in found.answers if a.held]
    below += f"; largest: {', '.join(peaks)}"
    return f"Curves of the amplitude over speed by each liquid model{'; '.join([below, *held])}."
