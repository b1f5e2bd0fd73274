"""The response of a machine to its unbalance, and the liquid models that answered, as text."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from leblanc.core.blocks import Check, Grade, Section, Table, Words
from leblanc.core.notes import WHOLE, one_line, percent
from leblanc.core.units import (
    LENGTH,
    MASS,
    NOT_FOUND,
    RPM,
    VOLUME,
    Unit,
    change_words,
    in_peak,
    in_rpm,
    measured,
    number,
    over_rpm,
    ranges,
    rpm_bands,
    unit_for,
    with_unit,
)
from leblanc.liquid.choice import HELD_MODELS, ModelSpan
from leblanc.studies.held.answer import Held
from leblanc.studies.run.notes import plane_words
from meshes.arrays import Array, Flags, Index
from solvers.rotor.balance_quality import GRADES, grade_name, grade_of

if TYPE_CHECKING:
    from leblanc.studies.run.answer import RunAnswer

_ONE = Unit("", 1.0)
AGAINST = 0.5  # from here on a whirl counts as one with or against the spin


def answer(result: RunAnswer) -> str:
    """What the liquid does, in one sentence."""
    most, at, last, *_ = comparisons(result)
    if most.wet == NOT_FOUND:
        return "No answer was found at any speed."
    speed, place = in_rpm(float(result.speed[-1])), amplitude_place(result)
    where = f" {place}" if place else ""
    if not result.liquid_mass > 0.0:
        size = _UNBOUNDED if most.wet == _INFINITE else f"is {most.wet_text} at most,"
        return f"Without liquid the amplitude{where} {size} at {at.wet} rpm."
    final = f"{_sized(last.wet_text)}{_on_average(result, -1)}"
    if result.speed.size == 1:
        size = f"{final} with the liquid{_aside(result, -1)}"
        bare = _UNBOUNDED if last.dry == _INFINITE else last.dry_text
        return f"At {speed} the amplitude{where} {size} and {bare} without."
    highest = result.curve.top
    assert highest is not None
    at_last = f"it {final}{_aside(result, -1)} instead of {last.dry_text}"
    if last.dry == _INFINITE:
        at_last = f"it {final}{_aside(result, -1)}; without it {_UNBOUNDED}"
    if last.wet == NOT_FOUND:
        at_last = f"no answer was found with the liquid; without it is {last.dry_text}"
    at_highest = f"at {at.wet} rpm with the liquid{_aside(result, highest)}"
    held = _where_it_holds(result)
    first = (
        f"The largest amplitude{where}{held} is {most.wet_text}{_on_average(result, highest)} {at_highest}"
    )
    if most.wet == _INFINITE:
        first = f"The amplitude{where} {_UNBOUNDED} {at_highest}"
    bare = f"it {_UNBOUNDED}" if most.dry == _INFINITE else most.dry_text
    return f"{first} and {bare} at {at.dry} rpm without; at {speed} {at_last}."


def effect(result: RunAnswer) -> str:
    """Which way the liquid changes the vibration, at the last speed and on the way there, in one sentence.

    Empty where there is nothing to compare.
    """
    curve = result.curve
    top = curve.top
    if result.chamberless or not result.liquid_mass > 0.0 or result.speed.size < 2 or top is None:
        return ""
    at = change_words(float(curve.amplitude[-1]), float(curve.amplitude_dry[-1]))
    bare = float(np.nanmax(curve.amplitude_dry, initial=0.0))
    way = change_words(float(curve.amplitude[top]), bare)
    if not at or not way:
        return ""
    *_, final = comparisons(result)[:3]
    where = in_rpm(float(result.speed[-1]))
    said = f"With the liquid the amplitude at {where} is {final.wet_text} instead of {final.dry_text} ({at})"
    doubts, error = _wrong(result, top), error_at(result, top)
    if error > abs(curve.amplitude[top] / bare - 1.0):
        doubts.append(f"error {_error_words(error)}")
    if result.carried_from is not None and curve.speed[top] < result.carried_from < math.inf:
        doubts.append(f"no annulus from rest below {in_rpm(result.carried_from)}")
    if doubts:
        return f"{said}. On the way the steady answer does not hold ({', '.join(doubts)}): see leblanc runup."
    return f"{said}, on the way {way}."


def unseen(result: RunAnswer) -> str:
    """Critical speeds below the first speed, at which nothing is answered; empty without any."""
    if result.motion is None:
        found = [result.critical_speed_dry]
    else:
        found = [speed for speed, _ in result.motion.critical_speeds_dry]
    below = [speed for speed in found if 0.0 < speed < float(result.speed.min())]
    if not below or result.speed.size < 2:
        return ""
    count = (
        f"{len(below)} of {len(found)} critical speeds lie" if len(found) > 1 else "The critical speed lies"
    )
    most = in_rpm(max(below))
    return f"{count} below the first speed, up to {most}: resonances there are not in these figures."


def _where_it_holds(result: RunAnswer) -> str:
    """Said of a largest amplitude that others exceed at speeds at which the answer does not hold."""
    curve = result.curve
    return " where the answer holds" if np.any(curve.amplitude > curve.peak.amplitude) else ""


_INFINITE, _UNBOUNDED = "infinite", "grows without bound"


def _sized(text: str) -> str:
    """An amplitude as the end of a sentence about it."""
    return _UNBOUNDED if text == _INFINITE else f"is {text}"


def largest(amplitude: Array) -> int | None:
    """Index of the largest amplitude, one without a bound above all; None if none was found."""
    return None if np.isnan(amplitude).all() else int(np.nanargmax(amplitude))


def _aside(result: RunAnswer, index: int) -> str:
    """What an amplitude is beside its size, in brackets; empty where there is nothing to say."""
    found = _wrong(result, index)
    if (ends := _ends(result, index)) is not None:
        unit = unit_for(LENGTH, *ends)
        found.append(f"between {unit.number(ends[0])} and {unit.number(ends[1])} {unit.name}")
    return f" ({', '.join(found)})" if found else ""


RIPPLE = 0.01  # of the amplitude, beyond which its change over time is reported


def _on_average(result: RunAnswer, index: int) -> str:
    """Said of an amplitude that changes over time."""
    told = result.cycling[index] or _ends(result, index) is not None
    return " on average" if told else ""


def _ends(result: RunAnswer, index: int) -> tuple[float, float] | None:
    """Least and largest amplitude over time at a place of the curve; None where it hardly changes.

    Where an orbit is an ellipse its amplitude is that of each turn's largest distance: only more is reported.
    """
    if result.held is None:
        return None
    (rows,) = np.nonzero(result.held.at & (result.speed == result.curve.speed[index]))
    if rows.size == 0:
        return None
    k = int(rows[0])
    least, largest, mean = (
        float(size[k]) for size in (result.amplitude_min, result.amplitude_max, result.amplitude)
    )
    swing = largest - least if result.motion is None else largest - mean
    changes = bool(result.held.limit_cycle[k]) or swing > RIPPLE * mean
    return (least, largest) if changes and math.isfinite(swing) else None


def _wrong(result: RunAnswer, index: int) -> list[str]:
    """What keeps an amplitude from being believed."""
    r = result.curve
    found = [] if r.in_range[index] else ["out of range"]
    if result.held is not None and r.model[index] in HELD_MODELS:
        state = (
            "limit cycle" if result.cycling[index] else "" if r.converged[index] else "not converged in time"
        )
        return [*found, state] if state else found
    if not r.converged[index] and np.isfinite(r.deflection[index]):
        found.append("not converged")
    if not r.stable[index]:
        found.append("stability not known" if _unknown(result, index) else "unstable")
    return found


def _unknown(result: RunAnswer, index: int) -> bool:
    """The stability of the answer at a place of the curve is not known."""
    r, whirl = result.curve, result.whirl
    if whirl is None or not r.branch_stable[index].any():
        return False
    speed = r.speed[[index]]
    lost = np.interp(speed, result.speed, np.isnan(whirl.growth)) > 0.0
    return bool((lost & ~whirl.inside(speed))[0])


def amplitude_place(result: RunAnswer) -> str:
    """Where along the axis amplitudes are those of; empty for a rotor that moves in one plane."""
    if result.motion is None:
        return ""
    return plane_words(result.motion.position, bool(result.chambers))


def error_at(result: RunAnswer, index: int) -> float:
    """Relative error that the models estimate at a place of the curve; inf: no bound, nan: unknown."""
    if result.chamberless or result.error_estimate is None:
        return math.nan
    order = np.argsort(result.speed, kind="stable")
    speed, error = result.speed[order], result.error_estimate[order]
    at = result.curve.speed[index]
    # Between two speeds the larger of theirs, not known where one is not.
    right = int(np.clip(np.searchsorted(speed, at), 0, speed.size - 1))
    left = right if speed[right] == at or right == 0 else right - 1
    return float(np.maximum(error[left], error[right]))


def headline_error(result: RunAnswer) -> str:
    """Errors of the largest amplitude and of the last, as a clause; empty where none is estimated."""
    top = result.curve.top
    if result.chamberless or result.error_estimate is None or top is None:
        return ""
    places = [(top, "at the largest amplitude"), (-1, f"at {in_rpm(float(result.curve.speed[-1]))}")]
    told = [f"{_error_words(error_at(result, index))} {place}" for index, place in places]
    return f"{told[-1] if result.speed.size == 1 else ', '.join(told)} (of the liquid model)"


def _error_words(error: float) -> str:
    if math.isnan(error):
        return "not known"
    return "without a bound" if math.isinf(error) else percent(error)


def largest_error(result: RunAnswer) -> str:
    """The largest error that the models estimate; empty where none is estimated."""
    if result.chamberless or result.error_estimate is None or np.isnan(result.error_estimate).all():
        return ""
    known = result.error_estimate[np.isfinite(result.error_estimate)]
    unknown = result.error_estimate.size - known.size
    most = percent(float(known.max())) if known.size else "without a bound"
    rest = f", without a bound at {unknown} of {result.speed.size} speeds" if known.size and unknown else ""
    return (f"at most {most}" if most[0].isdigit() else most) + rest


def comparison_table(result: RunAnswer) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """Heads and rows of `comparisons`, as printed; of a machine without chambers one column."""
    rows = comparisons(result)
    if result.chamberless:
        return ("", "without liquid"), [(row.label, row.wet) for row in rows]
    return ("", "with liquid", "without", "ratio"), [(row.label, row.wet, row.dry, row.ratio) for row in rows]


@dataclass(frozen=True)
class Comparison:
    """With liquid, without, and their ratio, as printed."""

    label: str  #: what is compared, with the unit in brackets
    wet: str  #: numbers
    dry: str
    ratio: str
    unit: str = ""  #: of the first two

    @property
    def wet_text(self) -> str:
        """That with liquid, and its unit."""
        return self._with_unit(self.wet)

    @property
    def dry_text(self) -> str:
        """That without, and its unit."""
        return self._with_unit(self.dry)

    def _with_unit(self, size: str) -> str:
        return f"{size} {self.unit}" if size[-1:].isdigit() else size


def comparisons(result: RunAnswer) -> list[Comparison]:
    """Largest and last amplitude, critical speed (planar), balance quality, with and without liquid."""
    r = result.curve
    wet, dry = r.top, largest(r.amplitude_dry)
    at_wet, at_dry = (NOT_FOUND if i is None else number(r.speed[i] * RPM) for i in (wet, dry))
    found = [
        _compared("Largest amplitude", result, wet, dry),
        Comparison("at the speed (rpm)", at_wet, at_dry, "", "rpm"),
        _compared(f"Amplitude at {in_rpm(float(r.speed[-1]))}", result, -1, -1),
        *_resonance(result),
    ]
    if result.motion is None:
        with_liquid, without = result.critical_speed_wet, result.critical_speed_dry
        values = number(with_liquid * RPM), number(without * RPM), number(with_liquid / without)
        found.append(Comparison("Critical speed (rpm)", *values, "rpm"))
    if result.balance_quality is not None and result.balance_quality_dry is not None:
        both = float(result.balance_quality[-1]), float(result.balance_quality_dry[-1])
        ratio = number(both[0] / both[1]) if both[1] > 0.0 and math.isfinite(both[0]) else ""
        label = f"Balance quality at {in_rpm(float(r.speed[-1]))}"
        wet_words, dry_words = map(quality_words, both)
        found.append(Comparison(label, wet_words, dry_words, ratio))
    return found


def _resonance(result: RunAnswer) -> list[Comparison]:
    """Amplification factor and separation margin of the highest resonance; nothing where there is none."""
    curve = result.curve
    places = (result.resonances, curve.top), (result.resonances_dry, largest(curve.amplitude_dry))
    # Of the largest amplitudes that are reported, where these are no ends of the range.
    both = [
        next((one for one in found if k is not None and one.speed == curve.speed[k]), None)
        for found, k in places
    ]
    if result.speed.size < 2 or both[0] is None:
        return []
    factors, margins = (
        [math.nan if one is None else getattr(one, name) for one in both]
        for name in ("amplification_factor", "separation_margin")
    )
    last = in_rpm(float(result.curve.speed[-1]))
    rows = (
        ("Amplification factor at the peak", factors),
        (f"Separation margin from {last} (%)", [100.0 * margin for margin in margins]),
    )
    return [
        Comparison(label, three_digits(wet), three_digits(dry), "")
        for label, (wet, dry) in rows
        if math.isfinite(wet) or math.isfinite(dry)
    ]


def three_digits(value: float) -> str:
    """A figure of judgement for print."""
    return NOT_FOUND if math.isnan(value) else "infinite" if math.isinf(value) else f"{value:.3g}"


def mode_table(result: RunAnswer) -> Table:
    """Modes without liquid at rest, each with what it does by share of kinetic energy; empty without tilt."""
    modes = () if result.motion is None else result.motion.modes
    rows = [
        (number(mode.frequency / (2.0 * math.pi)), f"{mode.damping_ratio:.2g}", mode.moves) for mode in modes
    ]
    return Table(rows, ("Modes at rest (Hz)", "damping ratio", "motion"), shown="page")


def resonance_table(result: RunAnswer) -> Table:
    """Each maximum over speed with its amplification factor and separation margin; empty of one alone."""
    both = {"with liquid": result.resonances, "without liquid": result.resonances_dry}
    if result.chamberless:
        del both["with liquid"]
    every = [(name, one) for name, found in both.items() for one in found]
    if max(map(len, both.values())) < 2:
        return Table((), ())
    unit = unit_for(LENGTH, *(one.amplitude for _, one in every))
    rows = [
        (
            *(name, number(one.speed * RPM), unit.number(one.amplitude)),
            three_digits(one.amplification_factor),
            three_digits(100.0 * one.separation_margin),
        )
        for name, one in every
    ]
    head = ("Peaks", "at (rpm)", f"amplitude ({in_peak(unit.name)})", "amplification", "separation (%)")
    return Table(rows, head, shown="page")


def quality_words(quality: float) -> str:
    """A balance quality with the grade of ISO 21940-11 that it keeps."""
    finest = grade_of(quality)
    grade = f"above {grade_name(GRADES[-1])}" if finest is None else grade_name(finest)
    return f"{number(quality * 1e3)} mm/s ({grade})"


def _compared(label: str, result: RunAnswer, wet: int | None, dry: int | None) -> Comparison:
    """Amplitudes at two places of the curve."""
    with_liquid = math.nan if wet is None else float(result.curve.amplitude[wet])
    without = math.nan if dry is None else float(result.curve.amplitude_dry[dry])
    comparable = without > 0.0 and math.isfinite(without) and math.isfinite(with_liquid)
    error = math.nan if wet is None else error_at(result, wet)
    unit, share = unit_for(LENGTH, with_liquid, without), with_liquid / without if comparable else math.nan
    ratio = measured(share, error * share, _ONE).partition(" ")[0] if comparable else ""
    wet_text, dry_text = measured(with_liquid, error * with_liquid, unit), unit.number(without)
    wrong = "" if wet is None else "".join(f", {text}" for text in _wrong(result, wet))
    if error >= WHOLE:
        wrong += f", error {_error_words(error)}"
    return Comparison(f"{label} ({in_peak(unit.name)}{wrong})", wet_text, dry_text, ratio, unit.name)


def facts(result: RunAnswer) -> list[tuple[str, str]]:
    """Further results: label and value."""
    r = result.response
    where = NOT_FOUND if math.isnan(r.liquid_offset[-1]) else "none"
    if r.liquid_offset[-1] > 0.0:
        angle = number(math.degrees(r.liquid_angle[-1]))
        where = f"{with_unit(float(r.liquid_offset[-1]), LENGTH)} off the axis at {angle} deg"
    if result.chamberless:
        return _vibration(result)
    return [
        ("Mass of the liquid", with_unit(result.liquid_mass, MASS)),
        (f"Its centre of mass at {in_rpm(float(r.speed[-1]))}", where),
        *_held_facts(result),
        *_vibration(result),
    ]


def _held_facts(result: RunAnswer) -> list[tuple[str, str]]:
    """Number of time-domain states, and the swing of the liquid."""
    held = result.held
    if held is None:
        return []
    count, every = int(np.count_nonzero(held.at)), result.speed.size
    error, (waves, parts) = _largest_known(held.error), HELD_MODELS[held.model]
    found = [
        (
            f"Rotor and {waves} integrated in time",
            f"{'all' if count == every else f'{count} of'} {every} speeds, "
            f"{held.cells} {parts} round each wall"
            + ("" if math.isnan(error) else f", estimated error at most {percent(error)}"),
        )
    ]
    swing = _largest_known(held.ripple[-1])
    if not math.isnan(swing):
        label = f"Swing of a layer's centre of mass at {in_rpm(float(result.speed[-1]))}"
        found.append((label, f"up to {with_unit(swing, LENGTH)} about its mean in the drum"))
    return found


def _largest_known(values: Array) -> float:
    """Largest of the values that are known; nan where none is."""
    known = values[~np.isnan(values)]
    return float(known.max()) if known.size else math.nan


def _vibration(result: RunAnswer) -> list[tuple[str, str]]:
    """Critical speeds and natural frequencies; "b" marks a whirl against the spin."""
    if result.motion is None:
        return []

    def listed(speeds: tuple[tuple[float, float], ...]) -> str:
        parts = [f"{number(speed * RPM)}" + (" b" if sense < -AGAINST else "") for speed, sense in speeds]
        return ", ".join(parts) + " rpm" if parts else "none"

    at_rest = [
        f"{number(mode.frequency / (2.0 * math.pi))} ({mode.damping_ratio:.2g})"
        for mode in result.motion.modes
    ]
    wet = [("Critical speeds with liquid", listed(result.motion.critical_speeds_wet))]
    return [
        *([] if result.chamberless else wet),
        ("Critical speeds without liquid", listed(result.motion.critical_speeds_dry)),
        ("Natural frequencies at rest (damping ratios)", ", ".join(at_rest) + " Hz"),
    ]


def checks(result: RunAnswer, at: Sequence[float] | None = None) -> list[Check]:
    """Where the answer is not what it seems: each check with its speeds, and the largest error.

    What touches the speeds `at`, rad/s, the headline's if None, is a warning.
    """
    r, tolerance, held = result.response, result.tolerance, result.held
    at = headline_speeds(result) if at is None else at
    failing = partial(failing_at, at)
    lost = ~r.converged if held is None else ~r.converged & ~held.at
    found = [failing("Not converged", r.speed, lost)] if held is None or lost.any() else []
    found += _held_limits(result, held) if held is not None else []
    if not result.chamberless:
        found.append(failing("Liquid model out of range", r.speed, ~r.in_range))
    if result.capture_speed is not None:
        loose = r.speed <= result.capture_speed
        edge = f" (below {in_rpm(result.capture_speed)})" if loose.any() else ""
        found.append(failing("No annular layer (gravity dominates)", r.speed, loose, edge))
    if result.carried_from is not None:
        loose, where = r.speed < result.carried_from, "by nothing: without friction"
        if math.isfinite(result.carried_from):
            where = f"below {in_rpm(result.carried_from)}"
        edge = f" ({where})" if loose.any() else ""
        found.append(failing("Annulus not reached from rest", r.speed, loose, edge))
    if tolerance is not None and result.error_estimate is not None and not result.chamberless:
        missed = ~(result.error_estimate <= tolerance)
        # What is missed at the headline is said there.
        found.append(failing_at((), f"Error above {number(100.0 * tolerance)} % or unknown", r.speed, missed))
    if not result.chamberless:
        found.append(failing("Wall dry in part", r.speed, r.dry_patch))
    unstable = result.stability == "unstable"
    found.append(
        failing("Answer unstable", r.speed, unstable if held is None else unstable & ~held.limit_cycle)
    )
    lost = result.stability == "not_known"
    if held is not None:
        lost &= ~held.not_settled
    if lost.any():
        found.append(failing("Stability not known", r.speed, lost))
    if result.whirl is not None:
        parts = [rpm_bands(result.whirl.bands)] if result.whirl.bands else []
        lost = np.isnan(result.whirl.growth)
        parts += [f"not known at {ranges(r.speed, lost)}"] if lost.any() else []
        grade = failing("", r.speed, lost).grade
        if result.whirl.inside(np.array(at)).any():
            grade = Grade.WARNING
        elif parts:
            grade = max(grade, Grade.NOTE)
        found.append(Check("Self-excited whirl", ", ".join(parts) or "none", grade))
    infinite = np.isinf(result.curve.amplitude)
    if infinite.any():
        found.append(failing("Amplitude infinite", result.curve.speed, infinite))
    error = largest_error(result)
    return [*found, Check("Estimated error of the liquid model", error)] if error else found


def headline_speeds(result: RunAnswer) -> tuple[float, ...]:
    """Speeds of the largest amplitude and of the last, rad/s."""
    return tuple(float(result.curve.speed[k]) for k in (result.curve.top, -1) if k is not None)


def failing_at(at: Sequence[float], label: str, speed: Array, fails: Flags, edge: str = "") -> Check:
    """A check with the speeds that fail it: a warning where one of the headline's does, else a note."""
    order = np.argsort(speed, kind="stable")
    touched = np.interp(at, speed[order], fails[order].astype(float)) > 0.0
    grade = Grade.WARNING if touched.any() else Grade.NOTE if fails.any() else Grade.NOTHING
    return Check(label, f"{ranges(speed, fails)}{edge}", grade)


def _held_limits(result: RunAnswer, held: Held) -> list[Check]:
    """Time-domain states that did not converge to one that repeats."""
    failing = partial(failing_at, headline_speeds(result))
    found = [failing("Not converged in time", result.speed, held.not_settled)]
    cycles = failing("Limit cycle", result.speed, held.limit_cycle)
    if cycles.grade:
        most = with_unit(float(held.largest[held.limit_cycle].max()), LENGTH)
        cycles = replace(cycles, where=f"{cycles.where}, amplitude up to {most}")
    return [*found, cycles, failing("Up and down differ", result.speed, held.hysteresis)]


def unanswered(result: RunAnswer) -> list[str]:
    """What has no answer, a line a kind, each with its first speeds."""
    held, found = result.held, []
    lost = ~result.converged if held is None else ~result.converged & ~held.at
    if lost.any():
        dry = lost & (result.response.model == "kdv") & np.isfinite(result.response.deflection)
        found += _unfound(result, lost & ~dry, "no bounded deflection found")
        found += _unfound(result, dry, "unidirectional waves leave the wall dry")
    if held is not None and held.not_settled.any():
        why = held.reason[held.not_settled].tolist() if held.reason.size else []
        places = [in_rpm(speed) for speed in result.speed[held.not_settled].tolist()]
        told = [f"{place} ({reason})" for place, reason in zip(places, why, strict=True)] if why else places
        count = f"{len(places)} of {np.count_nonzero(held.at)}"
        found += [
            f"the motion has not converged in time at {count} speeds at which it was integrated in time: "
            f"{_first(told)}",
            "all files are written; a motion that has not converged in time is marked not_settled, with "
            "the numbers of its last "
            "turns. The states are kept in the folder held beside them: another run takes them from there",
        ]
    return found


def _unfound(result: RunAnswer, lost: Flags, what: str) -> list[str]:
    """What is missing at some speeds, in a line with the first of them; no line where it is at none."""
    if not lost.any():
        return []
    listed = _first([f"{speed:.6g} rad/s" for speed in result.speed[lost].tolist()])
    return [f"{what} at {np.count_nonzero(lost)} of {lost.size} speeds: {listed}"]


def _first(parts: list[str]) -> str:
    """The first ten."""
    return ", ".join(parts[:10]) + (", ..." if len(parts) > 10 else "")


def machine(result: RunAnswer) -> str:
    """The machine and its speeds, in one sentence."""
    r = result.response
    count = len(result.chambers)
    volume = with_unit(sum(chamber.volume for chamber in result.chambers), VOLUME)
    liquids = " and ".join(dict.fromkeys(one_line(c.liquid_name) for c in result.chambers))
    chambers = f"{count} chambers, together" if count > 1 else "one chamber"
    carries = f"{chambers} with {volume} of {liquids}" if count else "no chamber"
    speeds = f"at {in_rpm(float(r.speed[0]))}"
    if r.speed.size > 1:
        speeds = f"{over_rpm(r.speed[0], r.speed[-1])} in {r.speed.size} speeds"
    return f"A rotor with a {result.axis} axis that carries {carries}, {speeds}."


def remarks(result: RunAnswer) -> list[str]:
    """Remarks that follow from the numbers themselves, besides the notes."""
    r, found = result.curve, []
    highest = r.top
    if highest is None:
        found.append("No answer was found at any speed.")
    elif np.isinf(r.amplitude[highest]):
        found.append("The largest amplitude has no bound: nothing damps the resonance.")
    elif r.speed.size > 1 and r.speed[highest] in (r.speed.min(), r.speed.max()):
        found.append("The largest amplitude lies at an end of the range of speeds.")
    if highest is not None and not r.in_range[highest]:
        found.append("The largest amplitude lies where the liquid model is out of range.")
    if result.motion is not None and any(way < -AGAINST for _, way in result.motion.critical_speeds_dry):
        found.append("Critical speeds marked b belong to whirl against the spin.")
    if not r.in_range[-1]:
        found.append("At the last speed the liquid model is out of range.")
    return found


def alts(result: RunAnswer) -> dict[str, str]:
    """What each figure shows, with the numbers a reader would take from it."""
    most, at, last, *_ = comparisons(result)
    where = f" {place}" if (place := amplitude_place(result)) else ""
    if result.chamberless:
        return {
            "amplitude": f"Curve of the amplitude{where} over speed: largest {most.dry_text} "
            f"at {at.dry} rpm.",
            "liquid": "No liquid.",
            "chamber": "No chamber.",
            "phase": "Curve of the angle from the unbalance to the deflection over speed.",
            "campbell": "Curves of the natural frequencies over speed.",
        }
    values = dict(facts(result))
    centre = next(value for label, value in values.items() if label.startswith("Its centre"))
    return {
        "amplitude": f"Curves of the amplitude{where} over speed: largest{_where_it_holds(result)} "
        f"{most.wet_text} at {at.wet} rpm with liquid, {most.dry_text} at {at.dry} rpm without."
        f"{_held_alt(result)}{_on_top_alt(result)}",
        "liquid": "Curves of the distance and the angle of the liquid's centre of mass over speed; at the "
        f"last speed: {centre}.{_swing_alt(result)}",
        "phase": "Curves of the angle from the unbalance to the deflection over speed, with and without "
        "liquid.",
        "chamber": "Drawing of each chamber with its liquid, seen along the axis, at the largest deflection"
        f"{_where_it_holds(result)}, {most.wet_text}, and at the last speed, {last.wet_text}.",
        "campbell": "Curves of the natural frequencies without liquid over speed.",
        "volumes": "Curves over speed of the volumes that wet each chamber's wall; at the last speed: "
        f"{_volumes_alt(result)}.",
    }


def _volumes_alt(result: RunAnswer) -> str:
    """The volumes of each chamber at the last speed."""
    found = result.wall_volumes
    if found is None:
        return "not known"
    return "; ".join(
        f"{with_unit(wet, VOLUME)} at the floor, {with_unit(full, VOLUME)} up to the lid"
        for wet, full in zip(
            found.wetting_volume[:, -1].tolist(), found.full_volume[:, -1].tolist(), strict=True
        )
    )


def _held_alt(result: RunAnswer) -> str:
    """Time-domain states in a figure of the amplitude."""
    held = result.held
    if held is None:
        return ""
    rows = {limit.label: limit for limit in _held_limits(result, held)}
    parts = ["A band from the least to the largest amplitude over time"]
    if (cycles := rows["Limit cycle"]).grade:
        parts.append(f"diamonds and, below, the speed of the whirl at limit cycles: {cycles.where}")
    if (differ := rows["Up and down differ"]).grade:
        parts.append(f"a thin line while the speed falls: {differ.where}")
    if (lost := rows["Not converged in time"]).grade:
        parts.append(f"not converged in time: {lost.where}")
    return f" {'; '.join(parts)}."


def _on_top_alt(result: RunAnswer) -> str:
    """What a figure of the amplitude shows of self-excited whirl."""
    large = None if result.whirl is None else result.whirl.large
    if large is None or not np.nanmax(large.amplitude, initial=0.0) > 0.0:
        return ""
    most, at = with_unit(float(np.nanmax(large.amplitude)), LENGTH), int(np.nanargmax(large.amplitude))
    where = in_rpm(float(result.speed[at]))
    return f" A band of beating with self-excited whirl, which is largest, {most}, at {where}."


def _swing_alt(result: RunAnswer) -> str:
    """Layers with time-domain states in a figure of the liquid."""
    if result.held is None or not result.held.ripple.size:
        return ""
    most = with_unit(_largest_known(result.held.ripple), LENGTH)
    return (
        " Below, each layer's centre of mass off its chamber's axis with a band as wide as its swing, at "
        f"most {most}."
    )


# What the model does, and what it takes for granted.
MODELS = {
    "statics": (
        "The liquid rests in the turning drum; its surface is a paraboloid about the rotation axis.",
        "Left out: waves, self-excited whirl, surface tension.",
    ),
    "linear": (
        "Small waves on a rigidly turning ring, by the exact linear theory of plane frictionless flow.",
        "Taken for granted: a wet wall all round, small disturbances, one depth along the axis.",
    ),
    "long_wave": (
        "Long waves of any height, hydraulic jumps included, that keep mass and angular momentum.",
        "Taken for granted: a layer thin against its waves, one depth along the axis.",
    ),
    "potential": (
        "Exact plane waves of any height and any depth on a flow without vorticity, by a conformal map.",
        "Left out: wall layers, hydraulic jumps and dry walls, surface tension, the liquid's lag; "
        "friction is a small "
        "force on all the liquid that damps waves as the walls do.",
    ),
    "kdv": (
        "Unidirectional, weakly nonlinear, dispersive waves that stand still as seen from the whirl.",
        "Taken for granted: whirl near the resonance of that family, low waves.",
    ),
    "kdv_held": (
        "Waves of KdV-Burgers against the spin, those with it by linear theory, on liquid that lags.",
        "Taken for granted: whirl near the resonance of the former, a wet wall, a thin layer.",
    ),
    "fem": (
        "Small disturbances of the liquid, by finite elements on the section of the chamber.",
        "Taken for granted: plane frictionless flow, an undisturbed surface that is a circle.",
    ),
}

HELD = (
    "Rotor and waves march in time together, speed by speed, until their motion rests, repeats with the "
    "turn or stays within bounds; amplitudes and centres of mass are means over time."
)

BALLS = (
    "Stuck speeds and vibration are those of the lowest order in the balls' share of the moving mass; the "
    "critical speed and the integrated speeds come from the full equations in time.",
    "Taken for granted: balls that roll without sliding or touching, a shaft that keeps its speed, a "
    "platform that moves along one line, no gravity.",
)


def models_section(result: RunAnswer) -> Iterator[Section]:
    """Liquid models that answered, why, and what they take for granted; nothing without chambers."""
    held = result.held is not None
    if result.models:
        yield of_models(result.models_used, why(result.models), held)
    elif not result.chamberless:
        rows = [(name, ranges(result.speed, result.model == name)) for name in result.models_used]
        yield of_models(result.models_used, Table(rows, ("Model", "Speeds"), sentences=True), held)


WHY = ("Speeds (rpm)", "Model", "Estimated error", "Why")


def of_models(names: Iterable[str], reasons: Table, held: bool = False) -> Section:
    """Each liquid model once, with what it does and takes for granted, below the reasons why it was taken."""
    shown = [Words(text, name=name, small=True) for name, text in described(names, held) if text]
    return Section("Liquid model, and why", (reasons, *shown), shown="page")


def described(names: Iterable[str], held: bool = False) -> list[tuple[str, str]]:
    """Name of each model once, with what it does and takes for granted; nothing of one that is not known."""
    found: dict[str, tuple[str, ...]] = {name: MODELS.get(name, ()) for name in names}
    for name in set(HELD_MODELS) & set(found) if held else ():
        does, granted = MODELS[name]
        found[name] = (does, HELD, granted)
    return [(name, " ".join(told)) for name, told in found.items()]


def why(spans: Iterable[ModelSpan]) -> Table:
    """Which liquid model answers at which speeds, how well, and why."""
    rows = [
        (
            speeds_words(span),
            span.model + ("" if span.in_range else " (out of range)"),
            error_words(span),
            f"{span.reason[:1].upper()}{span.reason[1:]}.",
        )
        for span in spans
    ]
    return Table(rows, WHY, sentences=True)


def speeds_words(span: ModelSpan) -> str:
    """First and last speed of a range, rpm; one where they are the same."""
    first, last = number(span.first * RPM), number(span.last * RPM)
    return first if first == last else f"{first} to {last}"


def error_words(span: ModelSpan) -> str:
    """Largest estimated error in a range of speeds."""
    if np.isfinite(span.error):
        return percent(span.error)
    return "not known" if np.isnan(span.error) else "without a bound"


def held_motions(result: RunAnswer) -> tuple[Table, ...]:
    """Limit cycles by ranges of speed, and where the way down differs; nothing where no motion was held."""
    held = result.held
    if held is None:
        return ()
    mean, least, largest = result.amplitude, result.amplitude_min, result.amplitude_max
    unit = unit_for(LENGTH, *mean[held.at].tolist())
    tables: list[Table] = []

    def size(values: Array) -> str:
        return _extent(values * unit.count)

    cycles = [
        (
            *(_extent(result.speed[part] * RPM), size(mean[part])),
            *(unit.number(float(least[part].min())), unit.number(float(largest[part].max()))),
            _extent(held.whirl_speed[part] * RPM),
        )
        for part in _runs(result.speed, held.limit_cycle)
    ]
    if cycles:
        sizes = (f"{name} ({in_peak(unit.name)})" for name in ("mean amplitude", "least", "largest"))
        tables.append(Table(cycles, ("Limit cycles (rpm)", *sizes, "whirl speed (rpm)")))

    def motion(states: NDArray[np.str_], values: Array) -> str:
        return f"{', '.join(dict.fromkeys(states.tolist()))}, {size(values)}".replace("_", " ")

    apart = [
        (
            _extent(result.speed[part] * RPM),
            motion(held.state[part], mean[part]),
            motion(held.state_down[part], held.amplitude_down[part]),
        )
        for part in _runs(result.speed, held.hysteresis)
    ]
    if apart:
        ways = (f"{way} speed: motion, amplitude ({in_peak(unit.name)})" for way in ("rising", "falling"))
        tables.append(Table(apart, ("Up and down differ (rpm)", *ways)))
    return tuple(tables)


def _runs(speed: Array, mask: Flags) -> list[Index]:
    """Neighbouring speeds at which a condition holds, each run by rising speed."""
    order = np.argsort(speed, kind="stable")
    holds = np.flatnonzero(mask[order])
    return [order[run] for run in np.split(holds, np.flatnonzero(np.diff(holds) > 1) + 1) if run.size]


def _extent(values: Array) -> str:
    """Least and largest of some values; one where they print alike."""
    known = values[np.isfinite(values)]
    if not known.size:
        return NOT_FOUND
    ends = number(float(known.min())), number(float(known.max()))
    return ends[0] if ends[0] == ends[1] else " to ".join(ends)
