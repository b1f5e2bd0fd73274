"""Which liquid model answers where, how well and why, in words."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from leblanc.studies.choose import Choice
from leblanc.units import RPM
from meshes.arrays import Array, Index

# What the model does, and what it takes for granted.
MODELS = {
    "statics": (
        "At each speed the liquid rests in the turning drum, its free surface a paraboloid about the "
        "rotation axis that holds the given volume.",
        "This takes steady synchronous whirl for granted and a liquid that friction has brought up to the "
        "drum's speed; waves, self-excited whirl and surface tension are left out.",
    ),
    "linear": (
        "The liquid answers with small waves on a rigidly turning ring, by the exact linear theory of plane "
        "frictionless flow.",
        "This takes a wet wall all round for granted, disturbances small against the depth of the layer, and "
        "a layer of the same depth all along the axis.",
    ),
    "long_wave": (
        "The liquid answers with long waves of any height in an annular layer, bores included, which keep "
        "mass and angular momentum.",
        "This takes a layer thin against its waves for granted, the pressure of a layer without radial "
        "acceleration, and the same depth all along the axis.",
    ),
    "kdv": (
        "The liquid answers with one family of weakly nonlinear, dispersive waves that stand still as seen "
        "from the whirl.",
        "This takes whirl near the resonance of that family for granted, and waves low against the depth of "
        "the layer.",
    ),
    "fem": (
        "The liquid answers with small disturbances, by finite elements on the section of the chamber.",
        "This takes plane frictionless flow for granted, disturbances small against the depth of the layer, "
        "and an undisturbed surface that is a circle.",
    ),
}

WHIRL = (
    "At each speed and volume the free whirls of rotor and liquid together, the liquid by the exact linear "
    "theory of the plane layer with the laminar or linear friction of its wall; told is the one that grows "
    "most.",
    "This takes whirls for granted that are small against the depth of the layer, a wet wall all round and "
    "the same depth all along the axis; how far a whirl grows is not asked.",
)

BALLS = (
    "Speeds at which all balls can stick together and the vibration that follows are those of the lowest "
    "order in the balls' share of the moving mass; the critical speed and a few speeds beside the formulas "
    "come from the full equations in time.",
    "This takes balls for granted that roll without sliding and without contact with one another, a shaft "
    "that keeps its speed, a platform that moves along one line, and no gravity.",
)


def described(names: Iterable[str]) -> list[tuple[str, str]]:
    """Name of each model once, with what it does and takes for granted; nothing of one that is not known.

    Parameters
    ----------
    names : of models, in any order
    """
    return [(name, " ".join(MODELS.get(name, ()))) for name in dict.fromkeys(names)]


_EXACT = 1e-9  # an error that is nothing but rounding


@dataclass(frozen=True)
class ModelSpan:
    """A range of speeds that one model answers.

    Parameters
    ----------
    first, last : rad/s
    model : its name
    in_range : it holds there
    within_tolerance : its estimated error is below the scene's tolerance at every speed
    error : largest estimate of it; nan where one is missing
    linear_error : largest error that the linear theory may have against the exact equilibrium
    strain : largest linear deflection over the one at which the law of the liquid bends
    gravity_error : largest estimate of what gravity across the axis does; nan where one is missing
    reason : why the model is taken, in words
    better : what the next better model would cost and give, in words
    """

    first: float
    last: float
    model: str
    in_range: bool
    within_tolerance: bool
    error: float
    linear_error: float
    strain: float
    gravity_error: float
    reason: str
    better: str


def model_spans(choice: Choice, speed: Array) -> tuple[ModelSpan, ...]:
    """Consecutive speeds with the same model that are alike in range and within the tolerance."""
    kinds = np.stack((choice.models != "statics", choice.in_range, choice.missed))
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
        gravity_error=float(choice.gravity[part].max()),
        reason=_reason(choice, model, part),
        better=_better(choice, model, part),
    )


def _reason(choice: Choice, model: str, part: Index) -> str:
    """Why that model."""
    if choice.cut:
        why = "baffles cut the liquid into compartments, or the section is no circle: only small \
disturbances of the liquid are computed there"
        return why if choice.in_range[part[0]] else f"{why}; at this speed it does not cover the wall"
    if not choice.in_range[part[0]]:
        return (
            "gravity across the axis is stronger than the spin: the liquid does not ride with the drum and \
no model of a steady answer holds; the numbers are those of liquid that does"
        )
    why = _statics_reason(choice, part) if model == "statics" else _linear_reason(choice, part)
    if choice.asked:
        why = f"the scene asks for it; {why}"
    if choice.missed[part[0]] and choice.gravity[part].max() > choice.tolerance:
        return f"{why}. But the waves that gravity drives across the axis, which no steady answer has, may \
change it by {percent(choice.gravity[part].max())}, more than the tolerance of {percent(choice.tolerance)}"
    if choice.missed[part[0]]:
        return f"{why}. This is more than the tolerance of {percent(choice.tolerance)}"
    return why


def _linear_reason(choice: Choice, part: Index) -> str:
    """What the linear theory leaves out at these speeds."""
    strain, worst = choice.linear.strain[part].max(), choice.linear.worst[part].max()
    if worst < _EXACT:
        where = f"at most {percent(strain)} of the way to where" if strain > 0.0 else "not, so that nowhere"
        return f"the axis moves {where} the surface touches the end of the wall or an inner wall; until then \
the liquid acts exactly as the mass of full chambers, and nothing farther out satisfies the balance"
    if not choice.asked:
        return f"the surface does not leave every wall alone, but what that takes from the mass of full \
chambers changes amplitude and liquid by less than {percent(worst)}"
    size = f"by up to {percent(worst)}" if np.isfinite(worst) else "without a bound"
    return f"against the exact equilibrium amplitude or liquid may be off {size}"


def _statics_reason(choice: Choice, part: Index) -> str:
    """What rules the linear theory out at these speeds."""
    linear = choice.linear
    strain, worst = linear.strain[part].max(), linear.worst[part].max()
    off = (
        f"the linear theory may be off by {percent(worst)}"
        if np.isfinite(worst)
        else "the linear theory \
has no bound of its error"
    )
    if choice.asked and worst <= choice.tolerance:
        return f"{off}, within the tolerance"
    bends = np.isfinite(linear.strain[part])
    if not bends.all():
        return f"{off}: the spin is too slow for the surface to cover the wall's height or to clear an inner \
wall, and no deflection is small enough for the mass of full chambers"
    if strain > 1.0:
        return f"{off}: the axis moves up to {strain:.3g} times as far as to where the surface touches the \
end of the wall or an inner wall, and a wall that runs dry holds less liquid on the heavy side"
    return f"{off}: farther out, with a wall dry in part, other deflections may satisfy the balance as well"


def _better(choice: Choice, model: str, part: Index) -> str:
    """What the next better model is, costs and gives."""
    if choice.cut:
        return "none: no other model knows such chambers"
    if not choice.in_range[part[0]]:
        return "none that is steady: `leblanc runup` carries the liquid as a mass at the bottom until it \
is caught"
    gravity = choice.gravity[part].max()
    if gravity > 0.0 and (model == "statics" or gravity > choice.tolerance):
        return f"long waves in time (`leblanc runup`, seconds a speed) have gravity's waves, estimated at \
{percent(gravity)}"
    if model != "statics":
        worst = choice.linear.worst[part].max()
        gives = "the same" if worst < _EXACT else f"less than {percent(worst)} of change"
        return f"the exact equilibrium gives {gives if np.isfinite(worst) else 'the answer'} for about a \
hundred times the time, up to some milliseconds a speed"
    return (
        "none: the equilibrium is exact for liquid at rest in the drum; whirls that grow by themselves are \
judged apart, by linear theory"
    )


def fidelity_notes(choice: Choice, speed: Array) -> tuple[str, ...]:
    """The models of a response and where the tolerance is not met, in words."""
    if choice.cut:
        return (
            "Liquid model: finite elements for small disturbances at every speed, since baffles cut the "
            "liquid or a section is no circle; the error by the size of the disturbance is not estimated.",
        )
    exact = int(np.count_nonzero(choice.models == "statics"))
    counts = f"{speed.size - exact} of {speed.size} speeds by linear theory, {exact} by the exact equilibrium"
    notes = []
    if not choice.asked:
        notes.append(
            f"Liquid model: {counts}; linear theory where it changes amplitude and liquid by less than "
            f"{percent(choice.tolerance)} and no wall runs dry."
        )
    missed = choice.missed & choice.in_range
    if missed.any():
        first, last = speed[missed][[0, -1]] * RPM
        worst = choice.error[missed].max()
        size = f"up to {percent(worst)}" if np.isfinite(worst) else "without a bound"
        whose = " of the model asked for" if choice.asked else ""
        best = "" if choice.asked else "; no model that answers here is known to be better"
        notes.append(
            f"Between {first:.4g} and {last:.4g} rpm the estimated error{whose} is {size}, more than the "
            f"tolerance of {percent(choice.tolerance)}{best}."
        )
    return tuple(notes)


def speeds_words(span: ModelSpan) -> str:
    """First and last speed of a range, rpm; one where they are the same."""
    first, last = f"{span.first * RPM:.5g}", f"{span.last * RPM:.5g}"
    return first if first == last else f"{first} to {last}"


def error_words(span: ModelSpan) -> str:
    """Largest estimated error in a range of speeds."""
    if np.isfinite(span.error):
        return percent(span.error)
    return "not known" if np.isnan(span.error) else "without a bound"


def percent(value: float) -> str:
    """A share in per cent, two digits; in words where it is the whole or nothing."""
    if value >= 0.995:
        return "about 100 % or more"
    return "rounding" if value < _EXACT else f"{100.0 * value:.2g} %"
