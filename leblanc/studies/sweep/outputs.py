"""What a sweep keeps of each sample: the outputs of `run` over speed, and a few single numbers of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from leblanc.studies.batch import Answers

PENDING, DONE, FAILED, NOT_CONVERGED = range(4)
STATUS = ("pending", "done", "failed", "not_converged")

NUMBER, FLAG, TEXT = "float64", "int8", "str"


@dataclass(frozen=True)
class Output:
    """One variable of the store.

    Parameters
    ----------
    name : of the variable
    kind : "float64"; "int8", -1 where there is no answer; "str"
    over_speed : one value at each speed, not one in all
    units, long_name, text : as CF asks, and what more there is to say
    meanings : words for the values of a flag, from -1 on
    """

    name: str
    kind: str
    over_speed: bool
    units: str
    long_name: str
    text: str = ""
    meanings: tuple[str, ...] = ()


_LAG = "from the unbalance, positive with the spin, a lag is negative"
_MOST = "of the whirl that grows most"


def _flag(name: str, long_name: str, text: str) -> Output:
    return Output(name, FLAG, True, "1", long_name, text, ("absent", "no", "yes"))


OVER_SPEED: tuple[Output, ...] = (
    Output("speed", NUMBER, True, "rad s-1", "spin speed", "of the rotor about its axis"),
    Output("amplitude", NUMBER, True, "m", "amplitude", "of the branch reported"),
    Output("amplitude_dry", NUMBER, True, "m", "amplitude", "without liquid"),
    Output("phase", NUMBER, True, "rad", "phase of the deflection", _LAG),
    Output("liquid_offset", NUMBER, True, "m", "liquid offset", "rotation axis to centre of mass"),
    Output("liquid_angle", NUMBER, True, "rad", "angle of the liquid's centre of mass", _LAG),
    Output("growth", NUMBER, True, "s-1", "growth rate", f"{_MOST}; above 0 unstable"),
    Output("whirl_speed", NUMBER, True, "rad s-1", "whirl speed", f"{_MOST}, in space"),
    _flag("dry_patch", "dry patch", "the wall is dry somewhere"),
    _flag("stable", "the branch reported is stable", "against slow disturbances and whirls"),
    _flag("in_range", "in range", "the liquid model holds there"),
    _flag("converged", "converged", "every branch was found"),
    Output(
        "error_estimate", NUMBER, True, "1", "estimated error", "relative, of amplitude and liquid the larger"
    ),
    Output("model", TEXT, True, "1", "liquid model", "used at this speed"),
)

SINGLE: tuple[Output, ...] = (
    Output("peak_amplitude", NUMBER, False, "m", "largest amplitude", "over the speeds"),
    Output("peak_amplitude_dry", NUMBER, False, "m", "largest amplitude", "over the speeds, without liquid"),
    Output("last_amplitude", NUMBER, False, "m", "amplitude at the last speed"),
    Output("last_amplitude_dry", NUMBER, False, "m", "amplitude at the last speed", "without liquid"),
    Output("peak_growth", NUMBER, False, "s-1", "largest growth rate", "over the speeds; above 0 unstable"),
)

OUTPUTS = OVER_SPEED + SINGLE


def blank(output: Output, samples: int, speeds: int) -> NDArray[Any]:
    """Values of samples without an answer: nan, -1 or an empty text.

    Parameters
    ----------
    output : of which there is none
    samples, speeds : how many
    """
    shape = (samples, speeds) if output.over_speed else (samples,)
    if output.kind == TEXT:
        return np.full(shape, "", dtype=object)
    return np.full(shape, np.nan if output.kind == NUMBER else -1, dtype=output.kind)


def values_of(answers: Answers) -> dict[str, NDArray[Any]]:
    """Outputs by name, from the answers of some scenes.

    Parameters
    ----------
    answers : arrays of shape (scenes, speeds)
    """
    values = {
        output.name: np.asarray(getattr(answers, output.name)).astype(
            object if output.kind == TEXT else output.kind
        )
        for output in OVER_SPEED
    }
    # fmax takes the other of two where one is not a number; a whole row without numbers gives none.
    for name in ("amplitude", "amplitude_dry", "growth"):
        values[f"peak_{name}"] = np.fmax.reduce(values[name], axis=1)
    for name in ("amplitude", "amplitude_dry"):
        values[f"last_{name}"] = values[name][:, -1]
    return values
