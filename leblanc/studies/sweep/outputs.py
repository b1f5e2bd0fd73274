"""What a sweep keeps of each sample: outputs of `run` over speed, and a few numbers of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from leblanc.core.quantities import quantities
from meshes.arrays import Array, Flags
from meshes.quantity import Q

_OVER = ("speed",)
_LAG = "from the unbalance, positive with the spin, a lag is negative"
_MOST = "of the fastest-growing whirl"
_BALLS = "balanced_from"  # None without balls


@dataclass(frozen=True)
class Answers:
    """Outputs of `run` of n scenes at s speeds each, SI; shape (n, s), or (n,) of what is not over speed."""

    speed: Annotated[Array, Q("rad s-1", "spin speed", "of the rotor about its axis", over=_OVER)]
    amplitude: Annotated[Array, Q("m", "amplitude", "of the branch reported", over=_OVER)]
    amplitude_dry: Annotated[Array, Q("m", "amplitude", "without liquid", over=_OVER)]
    phase: Annotated[Array, Q("rad", "phase of the deflection", _LAG, over=_OVER)]
    liquid_offset: Annotated[Array, Q("m", "liquid offset", "rotation axis to centre of mass", over=_OVER)]
    liquid_angle: Annotated[Array, Q("rad", "angle of the liquid's centre of mass", _LAG, over=_OVER)]
    growth: Annotated[Array, Q("s-1", "growth rate", f"{_MOST}; above 0 unstable", over=_OVER)]
    whirl_speed: Annotated[Array, Q("rad s-1", "whirl speed", f"{_MOST}, in space", over=_OVER)]
    dry_patch: Annotated[Flags, Q("1", "dry patch", "the wall is dry somewhere", over=_OVER, flags="no yes")]
    stable: Annotated[
        Flags,
        Q(
            *("1", "the branch reported is stable", "against slow disturbances and whirls"),
            over=_OVER,
            flags="no yes",
        ),
    ]
    in_range: Annotated[Flags, Q("1", "in range", "the liquid model holds there", over=_OVER, flags="no yes")]
    converged: Annotated[Flags, Q("1", "converged", "every branch was found", over=_OVER, flags="no yes")]
    model: Annotated[NDArray[np.str_], Q("", "liquid model", "used at this speed", over=_OVER)]
    #: nan where unknown
    error_estimate: Annotated[
        Array, Q("1", "estimated error", "relative, of amplitude and liquid the larger", over=_OVER)
    ]
    #: found between the speeds as well; with balls at the speeds themselves
    peak_amplitude: Annotated[Array, Q("m", "largest amplitude", "over the speeds at which it holds")]
    peak_amplitude_dry: Annotated[
        Array, Q("m", "largest amplitude", "over the range of speeds, without liquid")
    ]
    amplitude_without: Annotated[
        Array | None, Q("m", "amplitude", "without balls, with the liquid", over=_OVER, when=_BALLS)
    ] = None
    state: Annotated[
        NDArray[np.str_] | None,
        Q("", "how the balls rest", "balanced, together, apart or none", over=_OVER, when=_BALLS),
    ] = None
    balanced: Annotated[
        Flags | None,
        Q(
            *("1", "the balanced state is stable", "whichever state is reported"),
            over=_OVER,
            flags="no yes",
            when=_BALLS,
        ),
    ] = None
    #: nan if at none
    balanced_from: Annotated[
        Array | None,
        Q("rad s-1", "speed from which on the balanced state is stable", "of these", when=_BALLS),
    ] = None

    @property
    def last_amplitude(self) -> Annotated[Array, Q("m", "amplitude at the last speed")]:
        return self.amplitude[:, -1]

    @property
    def last_amplitude_dry(self) -> Annotated[Array, Q("m", "amplitude at the last speed", "without liquid")]:
        return self.amplitude_dry[:, -1]

    @property
    def peak_growth(
        self,
    ) -> Annotated[Array, Q("s-1", "largest growth rate", "over the speeds; above 0 unstable")]:
        # fmax takes the other of two where one is not a number; a whole row without numbers gives none.
        most = np.fmax.reduce(self.growth, axis=1)
        # Where no whirl is known to grow and some are not known, whether one grows is not known either.
        return np.where(np.isnan(self.growth).any(axis=1) & ~(most > 0.0), np.nan, most)


def outputs_of(balls: bool) -> Mapping[str, Q]:
    """What a store keeps of each sample, by name."""
    return {name: q for name, q in quantities(Answers).items() if balls or not q.when}


def single_outputs(balls: bool) -> Mapping[str, Q]:
    """Those that are one number a sample."""
    return {name: q for name, q in outputs_of(balls).items() if not q.over}


def over_speed(balls: bool) -> list[str]:
    """Names of the others."""
    return [name for name, q in outputs_of(balls).items() if q.over]


def kind_of(output: Q) -> str:
    """How a store keeps an output: "int8", -1 where there is no answer, "str", or "float64"."""
    return "int8" if output.flags else "float64" if output.unit else "str"


def blank(output: Q, samples: int, speeds: int) -> NDArray[np.generic]:
    """Values of samples without an answer: nan, -1 or an empty text."""
    shape, kind = (samples, speeds) if output.over else (samples,), kind_of(output)
    if kind == "str":
        return np.full(shape, "", dtype=object)
    return np.full(shape, np.nan if kind == "float64" else -1, dtype=kind)
