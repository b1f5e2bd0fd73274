"""The answer of a rotor in magnetic bearings as text."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import CURRENT, LENGTH, NOT_FOUND, TIME, in_rpm, number, ranges, with_unit
from leblanc.results.magnetic.control import Controlled, LoadAnswer, MagneticResult
from leblanc.results.magnetic.explanation import MagneticExplanation
from leblanc.studies.run.words import Limit

SENSITIVE = 3.0  # largest sensitivity of a new machine by ISO 14839-3
FASTEST = 1e5  # poles beyond it ask for more than coils and amplifiers give, 1/s
NAMES = {"synergetic": "synergetic control", "pid": "PID control"}
CONTROL = (
    "Rigid rotor with gyroscopic terms; forces of the magnets with the squares of currents and gaps; poles, "
    "margins and answers over speed from the loop made linear about the centre, the trial in time from the "
    "equations as they stand."
)
NUMBERS = {
    "gyroscopic": "Inertia about the axis over that across it",
    "slenderness": "Mass times the square of the bearings' distance over the inertia across the axis",
    "drag": "Drag of the fluid on the lean",
    "magnets": "Force constant times bias current squared, over the motor's pull and the gap's cube",
    "time": "Time scale, square root of the mass over the motor's pull (s)",
}


def heads(result: MagneticResult) -> tuple[str, ...]:
    """Head of the table of controllers.

    Parameters
    ----------
    result : the answer
    """
    return ("", *(NAMES[control.name] for control in result.controllers))


def rows(result: MagneticResult) -> list[tuple[str, ...]]:
    """The controllers side by side: a label, then a text for each.

    Parameters
    ----------
    result : the answer
    """
    last = in_rpm(float(result.speed[-1]))
    lines = [
        ("Slowest pole (1/s)", [_pole(control) for control in result.controllers]),
        (
            "Fastest pole (1/s)",
            [number(float(control.poles[-1].real.min())) for control in result.controllers],
        ),
        ("Factors of the gain that it bears", [_gain(control) for control in result.controllers]),
        ("Phase margin, least", [_least(control.phase_margin, _degrees) for control in result.controllers]),
        ("Delay margin, least", [_least(control.delay_margin, _time) for control in result.controllers]),
        ("Largest sensitivity", [_most(control.sensitivity) for control in result.controllers]),
        (
            f"Deflection by the unbalances at {last}",
            [with_unit(float(control.amplitude[-1]), LENGTH) for control in result.controllers],
        ),
        (
            f"Control current by them at {last}",
            [with_unit(float(control.current[-1]), CURRENT) for control in result.controllers],
        ),
    ]
    for k in range(max((len(control.loads) for control in result.controllers), default=0)):
        told = [control.loads[k] if control.loads else None for control in result.controllers]
        name = next(load.name for load in told if load is not None)
        lines.append((f"{name.capitalize()}: deflection", [_deflection(load) for load in told]))
        lines.append((f"{name.capitalize()}: current in the end", [_current(load) for load in told]))
    trials = [control.trial for control in result.controllers]
    if all(trial is not None for trial in trials):
        told_trials = [trial for trial in trials if trial is not None]
        within = with_unit(result.band, LENGTH)
        lines += [
            (f"In time: within {within} after", [_time(trial.settled) for trial in told_trials]),
            ("In time: largest deflection after later loads", [_length(t.after_loads) for t in told_trials]),
            ("In time: largest deflection in the last tenth", [_length(trial.left) for trial in told_trials]),
            ("In time: largest control current", [with_unit(t.most_current, CURRENT) for t in told_trials]),
        ]
    return [(label, *texts) for label, texts in lines]


def answer(result: MagneticResult) -> str:
    """Whether and how well the rotor is held, in one sentence.

    Parameters
    ----------
    result : the answer
    """
    held = [control for control in result.controllers if control.stable.all()]
    if not held:
        return "No controller holds the rotor at all speeds."
    parts = [
        f"{NAMES[control.name]} holds the rotor within {with_unit(float(control.amplitude.max()), LENGTH)}"
        f" of the centre against its unbalances, with a largest sensitivity of {_most(control.sensitivity)}"
        for control in held
    ]
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}."


def facts(result: MagneticResult) -> list[tuple[str, str]]:
    """Main numbers: label and value.

    Parameters
    ----------
    result : the answer
    """
    names = [NAMES[control.name] for control in result.controllers]
    return [
        (f"{label}, {name}", text)
        for label, *texts in rows(result)
        for name, text in zip(names, texts, strict=True)
    ]


def limits(result: MagneticResult) -> list[Limit]:
    """Where the answer is not what it seems: each check with what fails it.

    Parameters
    ----------
    result : the answer
    """
    found = []
    for control in result.controllers:
        name = NAMES[control.name]
        loose = ~control.stable
        found.append(Limit(f"Not stable, {name}", ranges(result.speed, loose), bool(loose.any())))
        near = np.nan_to_num(control.sensitivity, nan=0.0) > SENSITIVE
        found.append(Limit(f"Sensitivity above 3, {name}", ranges(result.speed, near), bool(near.any())))
        fast = -control.poles.real.min(axis=-1) > FASTEST
        label = f"Faster than coils are, {name}"
        found.append(Limit(label, ranges(result.speed, fast), bool(fast.any())))
        if control.trial is not None:
            ending = control.trial.motion.ending.value
            end = f"{ending} at {_time(float(control.trial.motion.time[-1]))}"
            found.append(Limit(f"Trial in time, {name}", end, ending != "done"))
    return found


def alt(result: MagneticResult) -> str:
    """What the figure shows."""
    time = (
        "" if result.controllers[0].trial is None else "deflection in a bearing and currents over time, and "
    )
    return f"Curves of {time}the deflection by unbalances over speed. {answer(result)}"


def lines(result: MagneticResult) -> list[str]:
    """The answer in a few lines.

    Parameters
    ----------
    result : the answer
    """
    return [answer(result)]


def explanation_rows(answer: MagneticExplanation) -> list[tuple[str, str]]:
    """A rotor in magnetic bearings in numbers; label and text.

    Parameters
    ----------
    answer : to tell
    """
    found = [
        (name, f"{number(getattr(answer.numbers, name))}: {text[0].lower()}{text[1:]}")
        for name, text in NUMBERS.items()
        if math.isfinite(getattr(answer.numbers, name))
    ]
    fastest = [
        (f"fastest pole, {NAMES[name]}", f"{number(-decay)} 1/s{_asks(decay)}")
        for name, decay in answer.fastest.items()
    ]
    return [
        *found,
        ("force by current", f"{number(answer.current_stiffness)} N/A, of a pair of magnets in the centre"),
        ("force by deflection", f"{number(answer.position_stiffness)} N/m outwards, of a pair of magnets"),
        ("without control", f"a deflection grows by {number(answer.growth)} 1/s"),
        ("holds", f"{number(answer.holds)} N along an axis, in the centre"),
        ("comes home from", f"{with_unit(answer.reach, LENGTH)} along an axis"),
        *fastest,
    ]


def _asks(decay: float) -> str:
    return ": faster than coils are" if decay > FASTEST else ""


def explanation_facts(answer: MagneticExplanation) -> list[tuple[str, str]]:
    """Main numbers: label and value.

    Parameters
    ----------
    answer : to tell
    """
    return [("Scene", one_line(answer.name)), *explanation_rows(answer)]


def load_words(result: MagneticResult) -> Sequence[str]:
    """Remarks of a reader of the report.

    Parameters
    ----------
    result : the answer
    """
    at = in_rpm(result.load_speed)
    return (
        f"Loads are answered at {at}, each by itself; of a constant load the deflection is the largest "
        "after it comes on, of a harmonic one the amplitude.",
        "Margins are those of all four currents changed alike; no model error of the magnets is in them.",
        "The numbers over speed and time are printed by the same command with --json.",
    )


def _pole(control: Controlled) -> str:
    slow = control.poles[-1][0]
    if abs(slow.imag) < 1e-3 * abs(slow.real):
        return number(float(slow.real))
    return f"{number(float(slow.real))} \N{PLUS-MINUS SIGN} {number(abs(float(slow.imag)))} i"


def _gain(control: Controlled) -> str:
    if not control.stable.all():
        return NOT_FOUND
    up, down = float(control.gain_up.min()), float(control.gain_down.max())
    return f"from {number(down)} {'up' if math.isinf(up) else f'to {number(up)}'}"


def _least(values: np.ndarray, words: object) -> str:
    return words(float(values.min())) if np.isfinite(values).all() else NOT_FOUND  # type: ignore[operator]


def _most(values: np.ndarray) -> str:
    return number(float(values.max())) if np.isfinite(values).all() else NOT_FOUND


def _degrees(angle: float) -> str:
    return f"{number(math.degrees(angle))} deg"


def _time(time: float) -> str:
    return with_unit(time, TIME) if math.isfinite(time) else NOT_FOUND


def _length(length: float) -> str:
    return with_unit(length, LENGTH) if math.isfinite(length) else "none"


def _deflection(load: LoadAnswer | None) -> str:
    if load is None:
        return NOT_FOUND
    return with_unit(load.settled if math.isfinite(load.frequency) else load.peak, LENGTH)


def _current(load: LoadAnswer | None) -> str:
    return NOT_FOUND if load is None else with_unit(load.current, CURRENT)
