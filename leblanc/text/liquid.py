"""The liquid alone as text: optimal volume, layer under a whirl, modes."""

from __future__ import annotations

import cmath
import math

import numpy as np

from leblanc.core.units import LENGTH, NUMBER, Dimension, in_rpm, number, unit_for, with_unit
from leblanc.results.layer import (
    ExactPeriods,
    ExactWave,
    FreeWaveResult,
    LayerCase,
    LayerPeriodsResult,
    LayerResult,
    Number,
)


def whirl_words(case: LayerCase) -> str:
    """What was understood of a question about a layer.

    Parameters
    ----------
    case : the layer and the whirl
    """
    return (
        f"{layer_words(case)}, whirl of {with_unit(case.whirl_amplitude, LENGTH)} "
        f"at {in_rpm(case.whirl_speed)}"
    )


def layer_words(case: LayerCase) -> str:
    """The layer and its spin, without the whirl.

    Parameters
    ----------
    case : the layer
    """
    inner = f", inner wall {with_unit(case.inner_radius, LENGTH)}" if case.inner_radius > 0.0 else ""
    return (
        f"Wall of radius {with_unit(case.radius, LENGTH)}{inner}, mean depth "
        f"{with_unit(case.mean_depth, LENGTH)}; spin {in_rpm(case.speed)}"
    )


VALIDITY_HEAD = ("The model rests on", "value", "holds for", "that is")
MOST_ANGLES = 24  # of a profile on a terminal


def validity_rows(numbers: tuple[Number, ...]) -> list[tuple[str, ...]]:
    """Dimensionless numbers, each with the range of the model, as `VALIDITY_HEAD` says.

    Parameters
    ----------
    numbers : of an answer
    """
    return [
        (
            entry.name.replace("_", " "),
            f"{number(entry.value)}{'' if entry.in_range else ', OUT OF RANGE'}",
            _range_words(entry),
            entry.meaning,
        )
        for entry in numbers
    ]


def _range_words(entry: Number) -> str:
    if entry.least is None and entry.most is None:
        return "any"
    most = math.inf if entry.most is None else entry.most
    least = entry.least or 0.0
    return f"at least {number(least)}" if math.isinf(most) else f"{number(least)} to {number(most)}"


def layer_periods(result: LayerPeriodsResult) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Heading and a row for each whirl period of a layer from rest.

    Parameters
    ----------
    result : the answer
    """
    h = result.history
    unit = unit_for(LENGTH, *h.depth_max.tolist(), *np.abs(h.offset).tolist())
    head: tuple[str, ...] = (
        "time (s)", "force ratio", "at (deg)", "by pressure", "rotation (rad/s)",
        f"deepest ({unit.name})", f"shallowest ({unit.name})", f"centre of mass ({unit.name})",
    )  # fmt: skip
    rows: list[tuple[str, ...]] = [
        (
            number(float(h.time[k])),
            number(abs(complex(h.force_ratio[k]))),
            number(math.degrees(cmath.phase(complex(h.force_ratio[k])))),
            number(abs(complex(h.pressure_ratio[k]))),
            number(float(h.mean_rotation[k])),
            unit.number(float(h.depth_max[k])),
            unit.number(float(h.depth_min[k])),
            unit.number(abs(complex(h.offset[k]))),
        )
        for k in range(h.time.size)
    ]
    return head, rows


def layer_profile(
    result: LayerResult | LayerPeriodsResult | FreeWaveResult,
) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Heading and rows of the depth around the wall, at no more than `MOST_ANGLES` of its angles.

    Parameters
    ----------
    result : the answer
    """
    unit = unit_for(LENGTH, *result.depth.tolist())
    step = max(1, math.ceil(result.theta.size / MOST_ANGLES))
    rows: list[tuple[str, ...]] = [
        (number(math.degrees(float(angle))), unit.number(float(depth)))
        for angle, depth in zip(result.theta[::step], result.depth[::step], strict=True)
    ]
    every = f", one in {step} of {result.theta.size}" if step > 1 else ""
    return (f"angle (deg){every}", f"depth ({unit.name})"), rows


def layer_summary(result: LayerResult) -> list[tuple[str, str]]:
    """The main numbers of a layer's answer, as labels and values."""
    return [
        *_model(result),
        ("Force ratio", _at_angle(result.force_ratio)),
        *_error(result.error_estimate),
        ("Centre of mass", _at_angle(result.offset, LENGTH)),
        ("Mean rotation in the drum", _rate(result.mean_rotation)),
        *_steady(result),
        *_exact(result),
        ("Error of the liquid's volume", number(result.mass_error)),
        *_validity(result.converged, result.in_range, result.validity),
    ]


def _exact(result: LayerResult) -> list[tuple[str, str]]:
    """What only the exact wave tells: its kind and size, or how large a whirl has a wave."""
    exact = result.exact
    if exact is None:
        return []
    if exact.state is None:
        largest = exact.largest_whirl
        return [("Largest whirl with a wave", with_unit(largest, LENGTH))] if math.isfinite(largest) else []
    return _shape(exact)


def _exact_periods(exact: ExactPeriods | None) -> list[tuple[str, str]]:
    """What only the exact wave in time tells."""
    if exact is None:
        return []
    return [
        ("State of the wave", exact.state.replace("_", " ")),
        ("Deepest and shallowest", f"{number(exact.crest)} and {number(exact.trough)} mean depths"),
        ("Speed of the liquid at a crest", f"up to {number(exact.crest_number)} of the crest's"),
        ("Nodes round the wall", f"{exact.nodes}"),
        ("Gap of the two forces", number(exact.force_gap)),
    ]


def _shape(wave: ExactWave | FreeWaveResult) -> list[tuple[str, str]]:
    """Kind and size of a wave, as labels and values."""
    kind = [("Kind of wave", wave.branch.replace("_", " "))] if wave.branch else []
    moving = math.isfinite(wave.crest_number)
    speed = [("Speed of the liquid at the crest", f"{number(wave.crest_number)} of the crest's")]
    depths = f"{number(wave.crest)} and {number(wave.trough)} mean depths"
    return [*kind, ("Deepest and shallowest", depths), *(speed if moving else [])]


def free_wave_summary(result: FreeWaveResult) -> list[tuple[str, str]]:
    """The main numbers of a free wave, as labels and values."""
    found = result.converged
    behind, ahead = (in_rpm(float(speed)) for speed in result.whirl_speed)
    speeds = [("Crests go round, behind the drum", behind), ("Crests go round, ahead of it", ahead)]
    known = found and math.isfinite(result.error_estimate)
    return [
        ("Liquid model", result.case.model),
        *_why(result.case),
        ("Crests", f"{result.mode}"),
        *(speeds if found else []),
        *(_shape(result) if found else []),
        *([("Estimated error of the speed", number(result.error_estimate))] if known else []),
        *([("Error of the liquid's volume", number(result.mass_error))] if found else []),
        *_validity(found, result.in_range, result.validity),
    ]


def _error(estimate: float) -> list[tuple[str, str]]:
    """What the model tells of its own error, if it does."""
    return [("Its estimated error", number(estimate))] if math.isfinite(estimate) else []


def periods_summary(result: LayerPeriodsResult) -> list[tuple[str, str]]:
    """The main numbers of a layer from rest, as labels and values."""
    h = result.history
    if not h.time.size:
        return [*_model(result), ("Answer", h.reason), *_exact_periods(result.exact)]
    return [
        *_model(result),
        ("Whirl periods", f"{h.time.size}"),
        ("Force ratio of the last one", _at_angle(complex(h.force_ratio[-1]))),
        ("Mean rotation in the drum", _rate(float(h.mean_rotation[-1]))),
        *_exact_periods(result.exact),
        *_validity(result.converged, result.in_range, result.validity),
    ]


def _model(result: LayerResult | LayerPeriodsResult) -> list[tuple[str, str]]:
    """The model, and what of py-pde solves it."""
    solver = [("Solver of py-pde", result.case.solver)] if result.case.solver else []
    return [("Liquid model", result.case.model), *_why(result.case), *solver]


def _why(case: LayerCase) -> list[tuple[str, str]]:
    """Why that model, where the question left it open."""
    return [("Why that model", case.reason)] if case.reason else []


def _validity(converged: bool, in_range: bool, numbers: tuple[Number, ...]) -> list[tuple[str, str]]:
    """Whether there is an answer that holds."""
    wrong = "; ".join(str(entry) for entry in numbers if not entry.in_range)
    verdict = "yes" if in_range else wrong or "no"
    return [("Converged", "yes" if converged else "no"), ("Model in range", verdict)]


def _steady(result: LayerResult) -> list[tuple[str, str]]:
    """What gravity across the axis does, where there is any."""
    held = [] if result.captured else [("Liquid not carried round", "gravity is stronger at its surface")]
    if result.gravity_offset == 0.0:
        return held
    return [("Centre of mass under gravity", f"{with_unit(result.gravity_offset, LENGTH)} in space"), *held]


def _rate(value: float) -> str:
    """An angular velocity, or that the model has none."""
    return f"{number(value)} rad/s" if math.isfinite(value) else "not known to this model"


def _at_angle(value: complex, dimension: Dimension = NUMBER) -> str:
    """Size and angle from the deflection."""
    if not cmath.isfinite(value):
        return "not found"
    angle = f"{number(round(math.degrees(cmath.phase(value))))} deg from the deflection"
    size = with_unit(abs(value), dimension) if dimension.unit else number(abs(value))
    return f"{size} at {angle}"
