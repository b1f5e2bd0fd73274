"""What the notes of a layer say, and the numbers that a model of it rests on."""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass

from leblanc.core.notes import Note, NoteCode, percent


class LayerCode(NoteCode):
    """What the notes of a layer say."""

    NO_ANSWER = "no_answer"
    OUT_OF_RANGE = "out_of_range"
    INNER_WALL = "inner_wall"
    AGAINST_WHIRL = "against_whirl"
    DRY_WALL = "dry_wall"
    LEE_WAVES = "lee_waves"
    NO_SMOOTH_WAVE = "no_smooth_wave"
    NO_EXACT_WAVE = "no_exact_wave"
    TWO_GRIDS = "two_grids"
    FRICTION_FREQUENCY = "friction_frequency"


@dataclass(frozen=True)
class Number:
    """A dimensionless number and the range in which the model holds."""

    name: str  #: what it is
    meaning: str
    value: float  #: not finite where it has no bound or was not found
    least: float | None  #: the model's range; None where it sets none
    most: float | None
    in_range: bool  #: the value is within

    def __str__(self) -> str:
        least, most = self.least or 0.0, math.inf if self.most is None else self.most
        allowed = f"at least {least:g}" if math.isinf(most) else f"{least:g} to {most:g}"
        return f"{self.meaning} = {self.value:.2g}, the model's range is {allowed}"


def no_answer(reason: str) -> Note:
    """Why there is no answer, or none to rely on."""
    return Note(LayerCode.NO_ANSWER, {}, reason)


def out_of_range(numbers: tuple[Number, ...]) -> tuple[Note, ...]:
    """The numbers that are out of their range, a note for each."""
    return tuple(
        Note(LayerCode.OUT_OF_RANGE, asdict(number), str(number)) for number in numbers if not number.in_range
    )


def inner_wall() -> Note:
    """The surface reaches the inner wall."""
    return Note(LayerCode.INNER_WALL, {}, "the surface reaches the inner wall")


def against_whirl(share: float) -> Note:
    """The liquid answers against the whirl as well, at a share of its answer with the whirl."""
    text = f"the liquid also answers against the whirl, {share:.3g} times as strongly"
    return Note(LayerCode.AGAINST_WHIRL, {"share": share}, text)


def dry_wall() -> Note:
    """The wall is dry in part."""
    return Note(LayerCode.DRY_WALL, {}, "the wall is dry in part")


def lee_waves() -> Note:
    """Shorter waves ride on the wave of the whirl."""
    return Note(LayerCode.LEE_WAVES, {}, "shorter waves ride on the wave, as they do in the lee of a whirl")


def no_smooth_wave(whirl: float, largest: float, fold: bool) -> Note:
    """The whirl is larger than any up to which a smooth steady wave follows it, both over the mean depth.

    Above the resonance such waves end at a fold, below it the flow chokes.
    """
    way = "it turns back" if fold else "the flow chokes"
    text = f"no smooth steady wave follows a whirl as it grows to {whirl:.2g} of the mean depth: "
    text += f"without friction {way} at {largest:.2g}"
    return Note(LayerCode.NO_SMOOTH_WAVE, {"whirl": whirl, "largest": largest, "fold": fold}, text)


def no_exact_wave(reason: str) -> Note:
    """Why no exact wave was found where the closed form has a smooth one, so that another model answers."""
    return Note(LayerCode.NO_EXACT_WAVE, {}, f"no smooth exact wave was found: {reason}")


def two_grids(gap: float) -> Note:
    """The whirl is larger than smooth waves follow: the error is that between two grids."""
    text = (
        "without friction no smooth steady wave follows so large a whirl: this one is as steep as the cells "
    )
    text += f"let it be, and the force on half as many differs by {percent(gap)}"
    return Note(LayerCode.TWO_GRIDS, {"gap": gap}, text)


def friction_frequency(frequency: float, alone: bool) -> Note:
    """The one frequency seen from the drum, rad/s, that laminar friction takes under gravity across the axis.

    Alone: nothing else moves; else it is a mean of that of the whirl and that of gravity.
    """
    of = "gravity, which turns in the drum" if alone else "whirl and gravity, weighted with their energies"
    text = f"laminar friction is that of {frequency:.4g} rad/s seen from the drum, the frequency of {of}"
    return Note(LayerCode.FRICTION_FREQUENCY, {"frequency": frequency}, text)
