"""Why a liquid model answers, and how far several models are apart, as text."""

from __future__ import annotations

import math

from leblanc.core.notes import EXACT, WHOLE, one_line, percent
from leblanc.core.units import (
    LENGTH,
    NOT_FOUND,
    RPM,
    TORQUE,
    VOLUME,
    ZERO_TO_PEAK,
    Unit,
    in_rpm,
    number,
    over_rpm,
    unit_for,
    with_unit,
)
from leblanc.results.choice import HeldCost, ModelSpan, SpeedEstimate
from leblanc.results.explanation import (
    BaffleOutlook,
    Explanation,
    LayerExplanation,
    SpinUp,
)
from leblanc.results.models.comparison import Comparison, ModelAnswer
from leblanc.studies.run.motion import RestMode
from leblanc.studies.run.words import amplitude_place, error_words, speeds_words
from meshes.arrays import Array

Rows = list[tuple[str, str]]

_HZ = 60.0  # rpm in one hertz

REFUSED = "does not answer"


def machine_rows(answer: Explanation) -> Rows:
    """The rotor as a whole; label and text."""
    dry, wet = (in_rpm(speed) for speed in (answer.critical_speed_dry, answer.critical_speed_wet))
    beside = f", {wet} with it at small deflections" if answer.layers else ""
    first, last = answer.speed_ratio
    rows = [
        ("critical speed", f"{dry} without liquid{beside}"),
        ("damping ratio", f"{answer.damping_ratio:.4g}"),
        ("speeds", f"{first:.3g} to {last:.3g} times the dry critical speed"),
    ]
    if math.isnan(answer.critical_speed_dry):
        free = [mode.moves for mode in answer.modes if mode.frequency == 0.0]
        rows = [
            ("free to move", f"{len(free)} motions that nothing holds: {', '.join(free)}"),
            ("critical speed", "none is given: the axis moves freely, and `leblanc run` refuses the machine"),
        ]
    if answer.captured_from is not None:
        captured = f"above {in_rpm(answer.captured_from)} a ring of liquid stands against gravity"
        rows.append(("captured", captured))
    if answer.whirl is not None:
        size, speed = with_unit(answer.whirl.amplitude, LENGTH), in_rpm(answer.whirl.speed)
        turning = in_rpm(answer.whirl.whirl_speed)
        text = f"grows by itself to about {size} at {speed}, the middle of its band, turning at {turning}"
        rows.append(("whirl", f"{text}: an estimate, see `map --cycles`"))
    if answer.held is not None:
        rows.append(("held in time", _held_words(answer.held, answer.tolerance)))
    return rows


def _held_words(held: HeldCost, tolerance: float) -> str:
    """What motions held in time take, and why they are held."""
    where = f"{held.speeds} speeds {over_rpm(held.first, held.last)}, {held.words}, good to a factor of two"
    if held.asked:
        return f"{where}; the cores share it"
    why = f"no steady model is within {percent(tolerance)} there, or a whirl grows by itself"
    return f'{where}, with [model] held = "auto": {why}'


def mode_rows(modes: tuple[RestMode, ...]) -> Rows:
    """Natural frequencies at rest; frequency and text."""
    return [
        (
            f"{number(mode.frequency * RPM / _HZ)} Hz",
            f"{in_rpm(mode.frequency)}, damping ratio {mode.damping_ratio:.3g}, mostly a {mode.moves}",
        )
        for mode in modes
    ]


def layer_rows(layer: LayerExplanation | None) -> Rows:
    """One chamber; label and text."""
    if layer is None:
        return [("fill", "empty")]
    n = layer.numbers
    steepness = f"{_ends(n.steepness)}: rise of the surface over the radius in chamber heights"
    if math.isinf(n.steepness[0]):
        steepness = "a cylinder: no gravity along the axis"
    covers = "not known for such a chamber"
    if not math.isnan(layer.optimal_volume):
        covers = f"from {with_unit(layer.optimal_volume, VOLUME)} at the dry rotor's last deflection"
    return [
        *([("walls", layer.walls)] if layer.walls else []),
        *([("carried by baffles", carrying_words(layer.carrying))] if layer.carrying else []),
        ("fill", f"{n.fill:.4g} of the capacity"),
        ("layer at fast spin", f"{with_unit(layer.depth, LENGTH)} deep, h0/R = {n.relative_depth:.4g}"),
        ("curvature", f"kappa = {n.curvature:.5g}"),
        ("added mass", f"{layer.added_mass_ratio:.4g} of the rotor's mass while the wall is wet"),
        ("mass of the liquid", f"{layer.liquid_mass_ratio:.4g} of the rotor's mass"),
        ("centrifuge number", f"{_ends(n.centrifuge)}: acceleration at the surface over gravity"),
        ("steepness", steepness),
        ("Reynolds number", _ends(n.reynolds)),
        ("wall layer", f"{_ends(n.skin)} of the depth"),
        *(_spin_up_rows(layer.spin_up) if layer.spin_up is not None else []),
        ("covers the wall", covers),
        *([] if layer.carried_from is None else [("carried from rest", _carried(layer.carried_from))]),
    ]


def _carried(speed: float) -> str:
    """When the walls take the liquid round."""
    if math.isinf(speed):
        return "never: no friction acts on it"
    return f"from {in_rpm(speed)}, where the walls' drag on the liquid at the bottom beats gravity"


def _spin_up_rows(found: SpinUp) -> Rows:
    """How the wall carries the liquid along."""
    asked = "that the ramp asks of the wall" if found.ramp else "of liquid at rest in space at the last speed"
    flow = f"{found.regime}, Re = {number(found.reynolds)} with a lag of {in_rpm(found.lag)}, {asked}"
    if math.isinf(found.time):
        return [("flow at the wall", flow), ("carried along", "never: nothing drags on the liquid")]
    carried = f"to a tenth of its lag in {number(found.time)} s at the last speed, without gravity"
    if found.ramp_time is not None:
        slow = found.time > found.ramp_time
        carried += f"; the ramp takes {number(found.ramp_time)} s: the liquid " + (
            "stays behind" if slow else "can follow"
        )
    return [("flow at the wall", flow), ("carried along", carried)]


def carrying_words(found: BaffleOutlook) -> str:
    """Torque that the baffles can exert against what the ramp asks."""
    able = f"{with_unit(found.available, TORQUE)} at {in_rpm(found.speed)}"
    text = f"the ramp asks for {with_unit(found.asked, TORQUE)}, they can {able}"
    if not found.left_behind:
        return text
    return f"{text}: the liquid is left behind up to {in_rpm(found.enough_from)}"


def span_rows(span: ModelSpan) -> Rows:
    """One range of speeds: its error, why that model, and what the next better one gives."""
    return [("estimated error", error_words(span)), ("why", span.reason), ("next better", span.better)]


_SHOWN = 9  # speeds in the table of estimates


def estimate_rows(answer: Explanation) -> list[tuple[str, ...]]:
    """What is expected at some of the speeds, as `ESTIMATES` heads it; none where no gravity lies across."""
    every = answer.estimates
    if not any(each.liquid_ripple != 0.0 for each in every):
        return []
    picked = {round(k * (len(every) - 1) / (_SHOWN - 1)) for k in range(_SHOWN)}
    return [_estimate_row(every[k]) for k in sorted(picked)]


ESTIMATES = "speed (rpm)", "model", "mean", "liquid's mean", "ripple", "liquid's ripple"


def _estimate_row(each: SpeedEstimate) -> tuple[str, ...]:
    if not each.in_range:
        return number(each.speed * RPM), each.model, "not carried", "", "", ""
    shares = [_share(each.error), _share(each.liquid_error), _share(each.ripple)]
    return number(each.speed * RPM), each.model, *shares, with_unit(each.liquid_ripple, LENGTH)


def _share(value: float) -> str:
    if math.isnan(value):
        return "not known"
    return percent(value) if math.isfinite(value) else "no bound"


def span_heading(span: ModelSpan) -> str:
    """Range of speeds and its model."""
    return f"{speeds_words(span)} rpm: {span.model}{'' if span.in_range else ' (out of range)'}"


def facts(answer: Explanation) -> Rows:
    """Main numbers of a scene: label and value."""
    spans = [(f"{speeds_words(span)} rpm", f"{span.model}, {error_words(span)}") for span in answer.models]
    return [("Scene", one_line(answer.name)), *machine_rows(answer), *spans]


def _ends(values: Array) -> str:
    """From the first speed to the last."""
    return f"{number(float(values[0]))} to {number(float(values[1]))}"


def comparison_head(found: Comparison) -> tuple[str, ...]:
    """Headings of the table of models."""
    place = next((amplitude_place(result) for result in found.results.values()), "")
    amplitude = f"largest amplitude{f' {place}' if place else ''}, {ZERO_TO_PEAK} ({_unit(found).name})"
    held = ("held states",) if _any_held(found) else ()
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


def _any_held(found: Comparison) -> bool:
    """Some model's motions were held in time."""
    return any(answer.held for answer in found.answers)


def _unit(found: Comparison) -> Unit:
    """Unit of the amplitudes of all models."""
    peaks = [answer.peak_amplitude for answer in found.answers]
    return unit_for(LENGTH, *(size for size in peaks if size is not None))


def comparison_rows(found: Comparison) -> list[tuple[str, ...]]:
    """A row of the table for each model, as `comparison_head` says."""
    return [_comparison_row(found, answer) for answer in found.answers]


def _comparison_row(found: Comparison, answer: ModelAnswer) -> tuple[str, ...]:
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
    """How many motions held in time are of each kind; none where a model is steady."""
    if answer.held is None:
        return "none"
    return ", ".join(f"{count} {kind.replace('_', ' ')}" for kind, count in answer.held.items() if count)


def difference(found: Comparison, model: str) -> str:
    """Largest difference of a model from the reference, per cent."""
    size = found.largest_difference(model)
    if size is None:
        return NOT_FOUND
    return "rounding" if 0.0 < size < EXACT else f"{100.0 * size:.2g}"


def refusals(found: Comparison) -> list[str]:
    """Why models do not answer, a line for each."""
    return [f"{answer.model}: {one_line(answer.reason)}" for answer in found.answers if not answer.answered]


def basis(found: Comparison) -> str:
    """What the differences are, in one sentence."""
    return (
        f"Differences are the largest over the speeds, from {found.reference}, as a share of its largest "
        "amplitude.\nEstimates are the largest error that a model knows of itself; in range is the part of "
        "the speeds."
    )


def comparison_facts(found: Comparison) -> list[tuple[str, str]]:
    """Main numbers: label and value."""
    return [
        ("Scene", one_line(found.name)),
        *((answer.model, _fact(found, answer)) for answer in found.answers),
    ]


def _fact(found: Comparison, answer: ModelAnswer) -> str:
    if answer.result is None or answer.cpu_time is None:
        return f"{REFUSED}: {one_line(answer.reason)}"
    parts = [f"{_size(answer)} at most"]
    if answer.model == found.reference:
        parts.append("the reference")
    else:
        size = difference(found, answer.model)
        parts.append(f"difference {size}{' %' if size[0].isdigit() else ''}")
    if answer.held:
        parts.append(f"held states: {held_words(answer)}")
    return ", ".join([*parts, f"{answer.cpu_time:.2g} s of processor time"])


def _size(answer: ModelAnswer) -> str:
    """Largest amplitude with its unit."""
    return NOT_FOUND if answer.peak_amplitude is None else with_unit(answer.peak_amplitude, LENGTH)


def comparison_alt(found: Comparison) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    peaks = [f"{answer.model} {_size(answer)}" for answer in found.answers if answer.answered]
    below = "; below, their differences" if len(peaks) > 1 else ""
    held = [f"{a.model} held in time: {held_words(a)}" for a in found.answers if a.held]
    below += f"; largest: {', '.join(peaks)}"
    return f"Curves of the amplitude over speed by each liquid model{'; '.join([below, *held])}."
