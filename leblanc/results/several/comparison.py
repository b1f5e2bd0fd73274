"""One scene by several liquid models, side by side: what `compare` answers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from leblanc.results.base import Result, attributes
from leblanc.results.netcdf import dataset, flags
from leblanc.results.netcdf import variable as var
from leblanc.results.response import RunResult, peak
from meshes.arrays import Array
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.results.netcdf import Dataset


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
        """Largest finite amplitude over the speeds, m; None where there is none."""
        at = None if self.result is None else peak(self.result.amplitude)
        return None if self.result is None or at is None else float(self.result.amplitude[at])


@dataclass(frozen=True)
class Comparison(Result):
    """The answers of several liquid models to one scene; n speeds, m models.

    The reference of all differences is the last model that answers: name the models by rising exactness.

    Parameters
    ----------
    name, source, assumed, digest : of the scene as it was given
    answers : one for each model, in the order asked for

    Raises
    ------
    InputError : no model answers
    """

    figure: ClassVar[str] = "leblanc.figures.comparison:comparison_figure"
    summary: ClassVar[str] = "leblanc.text.comparison:summary"

    name: str
    source: str
    assumed: tuple[str, ...]
    digest: str
    answers: tuple[ModelAnswer, ...]

    def __post_init__(self) -> None:
        if not any(one.answered for one in self.answers):
            raise InputError("answers", ", ".join(self.models), "at least one model that answers")

    @property
    def models(self) -> tuple[str, ...]:
        """Names of the models, in the order asked for."""
        return tuple(one.model for one in self.answers)

    @property
    def results(self) -> dict[str, RunResult]:
        """The answers that there are, by the name of their model."""
        return {one.model: one.result for one in self.answers if one.result is not None}

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
        nan where one of the two has no finite amplitude, shape (n,); zeros where no machine moves
        """
        own, other = (self.results[name].amplitude for name in (model, self.reference))
        known = np.isfinite(own) & np.isfinite(other)
        found = np.full(own.shape, np.nan)
        found[known] = own[known] - other[known]
        at = peak(other)
        size = 0.0 if at is None else float(other[at])
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
            "models": [self._entry(one) for one in self.answers],
            "reference": self.reference,
            "speed": self.speed,
            "amplitude_dry": self.amplitude_dry,
            "name": self.name,
            "digest": self.digest,
        }

    def _entry(self, one: ModelAnswer) -> dict[str, Any]:
        found = one.result
        return {
            "model": one.model,
            "answered": one.answered,
            "reason": one.reason,
            "cpu_time": one.cpu_time,
            "amplitude": None if found is None else found.amplitude,
            "liquid_offset": None if found is None else found.liquid_offset,
            "peak_amplitude": one.peak_amplitude,
            "largest_difference": self.largest_difference(one.model) if one.answered else None,
        }

    def to_dataset(self) -> Dataset:
        """Dataset with dimensions `model` and `speed`; nan where a model does not answer."""
        each, over = ("model",), ("model", "speed")
        answered = np.array([one.answered for one in self.answers])

        def table(take: Callable[[RunResult], Array]) -> Array:
            nothing = np.full(self.speed.shape, np.nan)
            return np.stack([nothing if one.result is None else take(one.result) for one in self.answers])

        def numbers(values: list[float | None]) -> Array:
            return np.array(values, dtype=np.float64)

        largest = [self.largest_difference(one.model) if one.answered else None for one in self.answers]
        peaks, times = ([getattr(one, key) for one in self.answers] for key in ("peak_amplitude", "cpu_time"))
        amplitude, offset = table(lambda one: one.amplitude), table(lambda one: one.liquid_offset)
        dry, reference = self.amplitude_dry, f"from {self.reference}, over its largest amplitude"
        words = np.array([one.reason for one in self.answers], dtype=object)
        return dataset(
            {
                "answered": flags(each, answered, "no yes", "answered", "the model answers this scene"),
                "reason": var(each, words, "1", "reason", "why the model does not answer"),
                "cpu_time": var(each, numbers(times), "s", "processor time", "that the answer took"),
                "amplitude": var(over, amplitude, "m", "amplitude", "of the branch reported"),
                "amplitude_dry": var(("speed",), dry, "m", "amplitude", "without liquid"),
                "liquid_offset": var(over, offset, "m", "liquid offset", "rotation axis to centre of mass"),
                "peak_amplitude": var(each, numbers(peaks), "m", "largest amplitude", "over the speeds"),
                "largest_difference": var(each, numbers(largest), "1", "largest difference", reference),
            },
            coords={
                "speed": var(("speed",), self.speed, "rad s-1", "spin speed", "of the rotor about its axis"),
                "model": var(each, np.array(self.models, dtype=object), "1", "liquid model", "as asked for"),
            },
            attrs=attributes(self, "compare", {"reference": self.reference}, ()),
        )
