"""Which liquid model answers at each speed of a scene, how well, and why."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray

from leblanc.core.notes import EXACT, percent
from leblanc.core.units import TIME, with_unit
from meshes.arrays import Array, Flags, Index
from meshes.quantity import Q

if TYPE_CHECKING:
    from solvers.synchronous.errors import GravityError, LinearError

# Liquid models of time-domain states, with what goes round each wall, in words.
HELD_MODELS = {
    "long_wave": ("long waves", "cells"),
    "potential": ("fully nonlinear waves", "nodes"),
    "kdv_held": ("waves of KdV-Burgers", "points"),
}


KNOWN, _RATE = ("linear", "statics", "kdv", "fem", *HELD_MODELS), "rad s-1"


@dataclass(frozen=True)
class HeldCost:
    """What it takes to hold in time the motions that no steady model answers well enough."""

    speeds: Annotated[int, Q("1", "speeds to hold in time")]
    first: Annotated[float, Q(_RATE, "first of these speeds", data=False)]
    last: Annotated[float, Q(_RATE, "last of these speeds", data=False)]
    seconds: Annotated[
        float, Q("s", "processor time to hold them", "good to a factor of two", by="held, eq. 11-13")
    ]
    asked: Annotated[bool, Q(text="the scene has them held")]

    @property
    def words(self) -> str:
        """The time for print."""
        return f"about {seconds_words(self.seconds)} of one core"


def seconds_words(seconds: float) -> str:
    """A processor time in s that is known to a factor of two, for print."""
    return with_unit(float(f"{seconds:.2g}"), TIME)


@dataclass(frozen=True)
class Choice:
    """The liquid model of a scene at each of its speeds, shape (n,)."""

    #: of small deflections, by which the critical speeds are; it does not depend on the speeds asked for
    model: str
    models: NDArray[np.str_]  #: name of the model taken at each speed
    prescribed: bool  #: the scene names the model itself
    in_range: Flags  #: the liquid rides with the drum
    captured_from: float | None  #: speed above which it does, rad/s; None if at every speed
    tolerance: float  #: relative error that the scene allows
    #: estimated relative error of what is taken, of amplitude and liquid the larger one; nan where there is
    #: no estimate
    error: Array
    linear: LinearError  #: error of the linear theory against the exact equilibrium
    #: what gravity across the axis does, which no model of a steady answer has, to the means over time and as
    #: a ripple about them
    gravity: GravityError
    cut: bool = False  #: baffles cut the liquid of a chamber into compartments, or its section is no circle
    held_model: str = "long_wave"  #: of the waves, where time-domain states are asked for
    #: processor time to hold rotor and waves in time at each speed, s; None where it was not asked for or no
    #: wave can be held
    holding: Array | None = None
    announced: bool = False  #: it is a model of one's own that a package announces and the scene names

    @property
    def missed(self) -> Flags:
        """Where even the model taken is not known to be within the tolerance, shape (n,)."""
        return ~(self.error <= self.tolerance)


@dataclass(frozen=True)
class ModelSpan:
    """A range of speeds that one model answers; an error or ripple is nan where there is no estimate."""

    first: Annotated[float, Q(_RATE, "first speed of a liquid model", variable="first")]
    last: Annotated[float, Q(_RATE, "last speed of a liquid model", variable="last")]
    model: Annotated[str, Q("1", "liquid model", variable="model")]
    in_range: Annotated[bool, Q(name="the model holds there", flags="no yes", variable="in_range")]
    within_tolerance: Annotated[
        bool, Q(text="its estimated error is below the scene's tolerance at every speed")
    ]
    error: Annotated[float, Q("1", "estimated error", "largest, relative", variable="error")]
    linear_error: Annotated[
        float, Q("1", "largest error of the linear theory", "against the exact equilibrium", data=False)
    ]
    strain: Annotated[
        float,
        Q("1", "largest linear deflection", "over that at which the law of the liquid bends", data=False),
    ]
    gravity_error: Annotated[
        float, Q("1", "largest error by gravity across the axis", "of the mean amplitude", data=False)
    ]
    liquid_error: Annotated[float, Q("1", "the same of the mean of the liquid's offset", data=False)]
    ripple: Annotated[float, Q("1", "largest ripple of the amplitude", "about its mean", data=False)]
    liquid_ripple: Annotated[
        float, Q("m", "largest ripple of the liquid's centre of mass", "in the drum", data=False)
    ]
    reason: Annotated[str, Q("1", "why that model", variable="reason")]
    better: Annotated[str, Q(text="what the next better model would cost and give")]


@dataclass(frozen=True)
class SpeedEstimate:
    """What is expected of the answer at one speed; an error is nan where there is no estimate."""

    speed: Annotated[float, Q(_RATE, "spin speed")]
    model: Annotated[str, Q(text="that answers")]
    in_range: Annotated[bool, Q(text="the liquid rides with the drum")]
    error: Annotated[float, Q("1", "estimated error of the mean amplitude")]
    #: by gravity across the axis
    liquid_error: Annotated[float, Q("1", "estimated error of the liquid's mean offset")]
    #: by gravity, about the mean
    ripple: Annotated[float, Q("1", "estimated ripple of the amplitude")]
    liquid_ripple: Annotated[float, Q("m", "estimated ripple of the liquid's centre of mass")]


def speed_estimates(choice: Choice, speed: Array) -> tuple[SpeedEstimate, ...]:
    """What is expected at every speed."""
    waves = choice.gravity
    columns = (
        speed,
        choice.models,
        choice.in_range,
        choice.error,
        waves.liquid,
        waves.ripple,
        waves.liquid_ripple,
    )
    return tuple(SpeedEstimate(*row) for row in zip(*(column.tolist() for column in columns), strict=True))


def model_spans(choice: Choice, speed: Array) -> tuple[ModelSpan, ...]:
    """Consecutive speeds with the same model that are alike in range and within the tolerance."""
    numbers = np.unique(choice.models, return_inverse=True)[1].reshape(-1)
    kinds = np.stack((numbers, choice.in_range, choice.missed))
    edges = np.flatnonzero((np.diff(kinds.astype(int), axis=1) != 0).any(axis=0)) + 1
    return tuple(_span(choice, speed, part) for part in np.split(np.arange(speed.size), edges))


def _span(choice: Choice, speed: Array, part: Index) -> ModelSpan:
    model = str(choice.models[part[0]])
    return ModelSpan(
        first=float(speed[part[0]]),
        last=float(speed[part[-1]]),
        model=model,
        in_range=bool(choice.in_range[part[0]]),
        within_tolerance=not choice.missed[part[0]],
        error=float(choice.error[part].max()),
        linear_error=float(choice.linear.worst[part].max()),
        strain=float(choice.linear.strain[part].max()),
        gravity_error=float(choice.gravity.amplitude[part].max()),
        liquid_error=float(choice.gravity.liquid[part].max()),
        ripple=float(choice.gravity.ripple[part].max()),
        liquid_ripple=float(choice.gravity.liquid_ripple[part].max()),
        reason=_reason(choice, model, part),
        better=_better(choice, model, part),
    )


def _reason(choice: Choice, model: str, part: Index) -> str:
    """Why that model."""
    if choice.cut:
        why = "chambers cut by baffles, or of another section than a circle: small disturbances only"
        return why if choice.in_range[part[0]] else f"{why}; at this speed the liquid does not cover the wall"
    if not choice.in_range[part[0]]:
        return (
            "gravity across the axis outweighs the spin: the liquid does not ride with the drum, the numbers "
            "are those of liquid that does"
        )
    if model in HELD_MODELS:
        return _held_reason(choice, part)
    if model == "kdv":
        return _family_reason(choice, part)
    if model not in KNOWN:
        asked = "the scene asks for" if choice.announced else "the question was asked with"
        return f"a model of one's own, which {asked}"
    if model == "fem" and not choice.cut:
        return "the scene asks for it; finite elements integrate the paraboloid and miss it by their mesh"
    why = _statics_reason(choice, part) if model == "statics" else _linear_reason(choice, part)
    if choice.prescribed and choice.held_model == "potential":
        asked = "the scene asks for the fully nonlinear wave, which in a circle with the spin is this one"
        why = f"{asked}; {why}"
    elif choice.prescribed:
        why = f"the scene asks for it; {why}"
    if not choice.missed[part[0]]:
        return why
    limit, waves = percent(choice.tolerance), choice.gravity.amplitude[part].max()
    if waves > choice.tolerance:
        return f"{why}; but gravity's waves may change its mean by {percent(waves)}, tolerance {limit}"
    return f"{why}; this is more than the tolerance of {limit}"


def _family_reason(choice: Choice, part: Index) -> str:
    """Distance of unidirectional waves alone from liquid between both families."""
    worst = choice.error[part].max()
    size = percent(worst) if np.isfinite(worst) else "an amount that is not known"
    return (
        "the scene asks for it; unidirectional waves stand for the two families that hold liquid at rest "
        f"in the drum, and are off the exact equilibrium by up to {size}"
    )


def _held_reason(choice: Choice, part: Index) -> str:
    """What a wave that was integrated in time rests on."""
    asked = "the scene asks for it; " if choice.prescribed else ""
    worst = choice.error[part].max()
    size = percent(worst) if np.isfinite(worst) else "an amount that is not known"
    parts = HELD_MODELS[choice.held_model][1]
    why = f"{asked}integrated in time with the rotor until converged"
    if choice.held_model == "kdv_held":
        return (
            f"{why}; the distance from the exact equilibrium and half the {parts} come to {size}, of a limit "
            "cycle there is no estimate"
        )
    return f"{why}; half the {parts} change it by {size}"


def _linear_reason(choice: Choice, part: Index) -> str:
    """What the linear theory leaves out at these speeds."""
    strain, worst = choice.linear.strain[part].max(), choice.linear.worst[part].max()
    if worst < EXACT:
        moves = f"at most {percent(strain)} of the way there" if strain > 0.0 else "not"
        return (
            "it is exact until the surface touches an end of the wall or an inner wall, and the axis moves "
            f"{moves}"
        )
    if not choice.prescribed:
        return f"what it leaves out changes amplitude and liquid by less than {percent(worst)}"
    size = f"by up to {percent(worst)}" if np.isfinite(worst) else "without a bound"
    return f"against the exact equilibrium amplitude or liquid may be off {size}"


def _statics_reason(choice: Choice, part: Index) -> str:
    """What rules the linear theory out at these speeds."""
    strain, worst = choice.linear.strain[part], choice.linear.worst[part].max()
    known = np.isfinite(worst)
    off = f"linear theory may be off by {percent(worst)}" if known else "linear theory has no bound of error"
    if choice.prescribed and worst <= choice.tolerance:
        return f"{off}, within the tolerance"
    if not np.isfinite(strain).all():
        return f"{off}: at this spin the surface does not cover the wall's height or clear an inner wall"
    if strain.max() > 1.0:
        return (
            f"{off}: the axis moves up to {strain.max():.3g} times as far as to where the surface touches "
            "the wall's end or an inner wall"
        )
    return f"{off}: with a wall dry in part, other deflections may satisfy the balance as well"


def _better(choice: Choice, model: str, part: Index) -> str:
    """What the next better model is, costs and gives."""
    if choice.cut:
        return "none: no other model knows such chambers"
    if model not in KNOWN:
        return "unknown: it is compared with no other"
    if not choice.in_range[part[0]]:
        return "none that is steady: `leblanc runup` carries the liquid until it is caught"
    if model == "kdv_held":
        return (
            'long waves integrated in time (liquid = "long_wave"), for whirls that are large or off resonance'
        )
    if model in HELD_MODELS:
        return f"the same with more {HELD_MODELS[model][1]} ([model] cells)"
    if model == "kdv":
        return "the exact equilibrium (statics), which costs less as well"
    gravity = choice.gravity.amplitude[part].max()
    if gravity > 0.0 and (model == "statics" or gravity > choice.tolerance):
        long = "seconds a speed"
        if choice.holding is not None:
            long = f"about {seconds_words(choice.holding[part].sum())} for all these speeds"
        return f"long waves integrated in time ([model] held), {long}, for gravity's {percent(gravity)}"
    if model != "statics":
        worst = choice.linear.worst[part].max()
        gives = "the same" if worst < EXACT else f"less than {percent(worst)} of change"
        return (
            f"the exact equilibrium gives {gives if np.isfinite(worst) else 'the answer'} for about a "
            "hundred times the time, up to some milliseconds a speed"
        )
    return "none: the equilibrium is exact for liquid at rest in the drum"
