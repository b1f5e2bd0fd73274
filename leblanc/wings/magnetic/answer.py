"""What is answered of a rotor in magnetic bearings: by `run` its control, by `explain` its numbers."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer
from leblanc.core.blocks import (
    Block,
    Check,
    Checks,
    Columns,
    Headline,
    Notes,
    Picture,
    Section,
    Table,
    Words,
    check,
)
from leblanc.core.units import CURRENT, LENGTH, NOT_FOUND, RPM, TIME, in_rpm, number, ranges, with_unit
from leblanc.wings.dry import DryAnswer
from meshes.arrays import Array, Complex, Flags
from meshes.quantity import Q
from solvers.rotor.magnetic.motion import Motion

if TYPE_CHECKING:
    from solvers.rotor.magnetic.machine import Dimensionless, MagneticRotor
    from solvers.rotor.magnetic.motion import Load

SENSITIVE = 3.0  # largest sensitivity of a new machine by ISO 14839-3
FASTEST = 1e5  # poles beyond it ask for more than coils and amplifiers give, 1/s
NAMES = {"synergetic": "synergetic control", "pid": "PID control"}
NUMBERS = {
    "gyroscopic": "Inertia about the axis over that across it",
    "slenderness": "Mass times the square of the bearings' distance over the inertia across the axis",
    "drag": "Drag of the fluid on the lean",
    "magnets": "Force constant times bias current squared, over the motor's pull and the gap's cube",
    "time": "Time scale, square root of the mass over the motor's pull (s)",
}
MODEL = (
    "Rigid rotor with gyroscopic terms; forces of the magnets with the squares of currents and gaps; poles, "
    "margins and answers over speed from the loop made linear about the centre, the trial in time from the "
    "equations as they stand."
)
_FIGURES = "leblanc.wings.magnetic.figure"
_OVER, _AXES = ("speed",), "first x, first y, second x, second y"


@dataclass(frozen=True)
class LoadAnswer:
    """What one load does, by the linear loop."""

    name: Annotated[str, Q(text="as in the scene, or gravity")]
    frequency: Annotated[float, Q("rad s-1", "frequency", "of a harmonic load; none of a constant one")]
    peak: Annotated[float, Q("m", "largest deflection in a bearing", "of a constant load, after it comes on")]
    settled: Annotated[float, Q("m", "deflection in the end", "of a harmonic load its amplitude")]
    current: Annotated[float, Q("A", "control current in the end", "of a harmonic load its amplitude")]


@dataclass(frozen=True)
class Followed:
    """A trial in time."""

    motion: Annotated[Motion, Q(part=True)]
    #: until the next load comes on; inf if never
    settled: Annotated[float, Q("s", "time from which the rotor stays within the band")]
    #: nan without one
    after_loads: Annotated[float, Q("m", "largest deflection in a bearing", "from the first later load on")]
    left: Annotated[float, Q("m", "largest deflection in a bearing", "in the last tenth")]
    most_current: Annotated[float, Q("A", "largest control current")]


@dataclass(frozen=True)
class Controlled:
    """One controller; n speeds, p poles. All margins are nan where the loop is not stable."""

    name: str  #: `synergetic` or `pid`
    #: shape (n, p)
    poles: Annotated[
        Complex, Q("s-1", "poles of the closed loop", "slowest first", over=("speed", "pole"), data=False)
    ]
    gain_up: Annotated[
        Array, Q("1", "gain margin", "largest factor of the loop gain", over=_OVER, variable="gain_up")
    ]
    gain_down: Annotated[Array, Q("1", "gain margin", "smallest factor", over=_OVER, variable="gain_down")]
    phase_margin: Annotated[
        Array, Q("rad", "phase margin", "at all four currents", over=_OVER, variable="phase_margin")
    ]
    delay_margin: Annotated[
        Array, Q("s", "delay margin", "at all four currents", over=_OVER, variable="delay_margin")
    ]
    sensitivity: Annotated[
        Array, Q("1", "largest sensitivity", "over frequency", over=_OVER, variable="sensitivity")
    ]
    #: complex deflection along x of the first bearing, of the unbalances alone, m, shape (n,)
    unbalance: Complex
    amplitude: Annotated[
        Array,
        Q(
            "m",
            "deflection in a bearing",
            "zero to peak, of the unbalances",
            over=_OVER,
            variable="amplitude",
        ),
    ]
    current: Annotated[Array, Q("A", "control current", "of the unbalances", over=_OVER, variable="current")]
    loads: Annotated[tuple[LoadAnswer, ...], Q(text="what each load does", data=False)]
    trial: Annotated[
        Followed | None, Q(text="in time; none where the scene has none", data=False, when="trial")
    ]

    @property
    def stable(
        self,
    ) -> Annotated[Flags, Q(name="the closed loop is stable", over=_OVER, flags="no yes", variable="stable")]:
        return np.asarray(self.poles.real.max(axis=-1) < 0.0)


@dataclass(frozen=True)
class MagneticExplanation(Answer):
    """What a rotor in magnetic bearings is in numbers, without any motion in time; n places.

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("blood_pump"))
    >>> f"{explanation.position_stiffness:.0f} N/m"
    '9000 N/m'
    """

    command = "explain"
    figure = f"{_FIGURES}:force_figure"

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: tuple[str, ...]  #: values that no source gives
    digest: str  #: of the scene
    dimensionless: Annotated[Dimensionless, Q(text="dimensionless numbers")]
    current_stiffness: Annotated[
        float, Q("N A-1", "force by current", "of a pair of magnets in the centre", data=False)
    ]
    position_stiffness: Annotated[
        float, Q("N m-1", "force by deflection", "outwards, of a pair of magnets", data=False)
    ]
    growth: Annotated[float, Q("s-1", "growth", "without control")]
    holds: Annotated[float, Q("N", "largest constant force", "along one axis")]
    reach: Annotated[float, Q("m", "largest deflection", "from which it comes home")]
    fastest: Annotated[
        dict[str, float],
        Q("s-1", text="decay of the fastest pole at the last speed, by controller", data=False),
    ]
    place: Annotated[Array, Q("m", "deflection", "along an axis", over=("place",), json=False)]
    #: of both bearings and the motor, at the largest current home, none, out, shape (3, n)
    force: Annotated[
        Array, Q("N", "force outwards", "home, none, out", over=("current", "place"), json=False)
    ]

    @property
    def numbers(self) -> Dimensionless:
        """The same as `dimensionless`."""
        return self.dimensionless

    def blocks(self) -> tuple[Block, ...]:
        stiffness = number(self.current_stiffness), number(self.position_stiffness)
        rows = [
            *((key, f"{value}: {text[0].lower()}{text[1:]}") for key, text, value in _told(self.numbers)),
            ("force by current", f"{stiffness[0]} N/A, of a pair of magnets in the centre"),
            ("force by deflection", f"{stiffness[1]} N/m outwards, of a pair of magnets"),
            ("without control", f"a deflection grows by {number(self.growth)} 1/s"),
            ("holds", f"{number(self.holds)} N along an axis, in the centre"),
            ("comes home from", f"{with_unit(self.reach, LENGTH)} along an axis"),
        ]
        for name, decay in self.fastest.items():
            asks = ": faster than coils are" if decay > FASTEST else ""
            rows.append((f"fastest pole, {NAMES[name]}", f"{number(-decay)} 1/s{asks}"))
        return Words(self.name), Table(rows, indent=2)


@dataclass(frozen=True)
class MagneticAnswer(DryAnswer):
    """Answer over speed; n speeds, c controllers.

    Examples
    --------
    >>> import leblanc as lb
    >>> pump = lb.example("blood_pump").replace({"speeds.count": 2, "rotor.trial.duration": 0.01})
    >>> answer = lb.run(pump)
    >>> [control.name for control in answer.controllers], bool(answer.stable.all())
    (['synergetic', 'pid'], True)
    """

    command = "run"
    title = "Magnetic bearings and their control"
    data, page = "response.nc", "summary.html"
    unused = ("model", "runup", "programme", "optimise")
    figure = f"{_FIGURES}:magnetic_figure"

    name: str  #: of the scene
    source: str
    assumed: tuple[str, ...]  #: values that no source gives
    digest: str  #: of the scene
    machine: MagneticRotor  #: the rotor
    dimensionless: Annotated[Dimensionless, Q(text="dimensionless numbers")]
    speed: Annotated[Array, Q("rad s-1", "spin speed", "of the rotor", over=_OVER)]
    #: at least one
    controllers: Annotated[
        tuple[Controlled, ...], Q(text="answer with each controller", rows="control", json=False)
    ]
    loads: tuple[Load, ...]  #: from outside, gravity among them where it lies across the axis
    load_speed: Annotated[float, Q("rad s-1", "speed at which the loads are answered", data=False)]
    band: Annotated[float, Q("m", "deflection within which the rotor has settled", data=False)]

    @property
    def numbers(self) -> Dimensionless:
        """The same as `dimensionless`."""
        return self.dimensionless

    @property
    def controls(
        self,
    ) -> Annotated[dict[str, Controlled], Q(text="answer with each controller, by its name")]:
        return {control.name: control for control in self.controllers}

    @property
    def control(
        self,
    ) -> Annotated[NDArray[np.str_], Q("1", "controller", over=("control",), json=False)]:
        return np.array([control.name for control in self.controllers])

    @property
    def amplitude(
        self,
    ) -> Annotated[Array, Q("m", "amplitude", "of the unbalances, first controller", over=_OVER, data=False)]:
        """Largest deflection in a bearing, shape (n,)."""
        return self.controllers[0].amplitude

    @property
    def amplitude_dry(
        self,
    ) -> Annotated[Array, Q("m", "amplitude", "without liquid", over=_OVER, data=False)]:
        return self.amplitude

    @property
    def phase(
        self,
    ) -> Annotated[Array, Q("rad", "phase", "from the unbalance; lags are negative", over=_OVER, data=False)]:
        return np.asarray(np.angle(self.controllers[0].unbalance))

    @property
    def stable(
        self,
    ) -> Annotated[Flags, Q(name="all poles decay with the first controller", over=_OVER, data=False)]:
        return self.controllers[0].stable

    @property
    def model(self) -> Annotated[NDArray[np.str_], Q(name="what answers: the first controller", over=_OVER)]:
        return np.full(self.speed.shape, self.controllers[0].name)

    @property
    def pole_real(
        self,
    ) -> Annotated[
        Array,
        Q("s-1", "decay of a pole", "of the closed loop", over=("control", "speed", "pole"), json=False),
    ]:
        return _stacked([control.poles.real for control in self.controllers], 1)

    @property
    def pole_imag(
        self,
    ) -> Annotated[
        Array, Q("rad s-1", "frequency of a pole", "damped", over=("control", "speed", "pole"), json=False)
    ]:
        return _stacked([control.poles.imag for control in self.controllers], 1)

    @property
    def trials(self) -> list[Motion]:
        """Motions of the trial in time, one with each controller; empty where the scene has none."""
        return [control.trial.motion for control in self.controllers if control.trial is not None]

    @property
    def time(self) -> Annotated[Array | None, Q("s", "time", "of the trial", over=("time",), json=False)]:
        return max((motion.time for motion in self.trials), key=len, default=None)

    @property
    def displacement(
        self,
    ) -> Annotated[
        Array | None,
        Q("m", "displacement in the bearings", _AXES, over=("control", "time", "axis"), json=False),
    ]:
        return _stacked([motion.displacement for motion in self.trials], 0) if self.trials else None

    @property
    def control_current(
        self,
    ) -> Annotated[
        Array | None,
        Q("A", "control current in time", _AXES, over=("control", "time", "axis"), json=False),
    ]:
        return _stacked([motion.current for motion in self.trials], 0) if self.trials else None

    @property
    def converged(self) -> bool:
        """Every trial came to its end, or to a magnet."""
        return all(motion.ending.value != "failed" for motion in self.trials)

    @property
    def faults(self) -> tuple[str, ...]:
        return () if self.converged else ("the trial in time did not come to its end",)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.speed.size} speeds done"

    def blocks(self) -> tuple[Block, ...]:
        low, high = number(float(self.speed[0]) * RPM), number(float(self.speed[-1]) * RPM)
        about = (
            f"A rigid rotor of {number(self.machine.mass * 1e3)} g in two magnetic bearings, from {low} to "
            f"{high} rpm in {self.speed.size} speeds."
        )
        numbers = [(text, value) for _, text, value in _told(self.numbers)]
        heads = ("", *(NAMES[control.name] for control in self.controllers))
        tables = Columns(
            (Table(rows(self), heads, right=True),),
            (Checks(limits(self)), Table(numbers, ("Dimensionless numbers", ""), shown="page")),
        )
        at = in_rpm(self.load_speed)
        remarks = (
            f"Loads are answered at {at}, each by itself; of a constant load the deflection is the largest "
            "after it comes on, of a harmonic one the amplitude.",
            "Margins are those of all four currents changed alike; no model error of the magnets is in them.",
            "The numbers over speed and time are printed by the same command with --json.",
        )
        picture = Picture("magnetic", "Rotor in magnetic bearings", self.figure)
        return (
            Headline(sentence(self), about, shown="both"),
            Section("Results", (picture, tables), width="110mm"),
            Section("Model", (Words(MODEL, name="control", small=True),), shown="page"),
            Notes(remarks, shown="page"),
        )


def _stacked(parts: Sequence[Array], axis: int) -> Array:
    """Arrays as one, side by side; nan where one is shorter along its axis than the longest."""
    longest = max(part.shape[axis] for part in parts)

    def filled(part: Array) -> Array:
        room = [(0, longest - length if k == axis else 0) for k, length in enumerate(part.shape)]
        return np.pad(part, room, constant_values=math.nan)

    return np.array([filled(part) for part in parts])


def _told(numbers: Dimensionless) -> list[tuple[str, str, str]]:
    """Dimensionless numbers that there are: name, what it is, value."""
    values = {name: float(getattr(numbers, name)) for name in NUMBERS}
    return [(name, NUMBERS[name], number(value)) for name, value in values.items() if math.isfinite(value)]


def sentence(answer: MagneticAnswer) -> str:
    """Whether and how well the rotor is held, in one sentence."""
    held = [control for control in answer.controllers if control.stable.all()]
    if not held:
        return "No controller holds the rotor at all speeds."
    parts = [
        f"{NAMES[control.name]} holds the rotor within {with_unit(float(control.amplitude.max()), LENGTH)}"
        f" of the centre against its unbalances, with a largest sensitivity of {_most(control.sensitivity)}"
        for control in held
    ]
    text = "; ".join(parts)
    return f"{text[0].upper()}{text[1:]}."


def rows(answer: MagneticAnswer) -> list[tuple[str, ...]]:
    """The controllers side by side: a label, then a text for each."""
    last, within = in_rpm(float(answer.speed[-1])), with_unit(answer.band, LENGTH)
    lines: list[tuple[str, ...]] = []

    def row(label: str, words: Callable[[Controlled], str]) -> None:
        lines.append((label, *map(words, answer.controllers)))

    row("Slowest pole (1/s)", _pole)
    row("Fastest pole (1/s)", lambda control: number(float(control.poles[-1].real.min())))
    row("Factors of the gain that it bears", _gain)
    row("Phase margin, least", lambda control: _least(control.phase_margin, _degrees))
    row("Delay margin, least", lambda control: _least(control.delay_margin, _time))
    row("Largest sensitivity", lambda control: _most(control.sensitivity))
    row(
        f"Deflection by the unbalances at {last}",
        lambda control: with_unit(float(control.amplitude[-1]), LENGTH),
    )
    row(f"Control current by them at {last}", lambda control: with_unit(float(control.current[-1]), CURRENT))
    loads = max((control.loads for control in answer.controllers), key=len)
    for k, name in enumerate(load.name.capitalize() for load in loads):
        told = [control.loads[k] if control.loads else None for control in answer.controllers]
        lines.append((f"{name}: deflection", *map(_deflection, told)))
        lines.append((f"{name}: current in the end", *map(_current, told)))
    trials = [control.trial for control in answer.controllers if control.trial is not None]
    if trials:
        begin = "In time: "
        lines += [
            (f"{begin}within {within} after", *(_time(one.settled) for one in trials)),
            (f"{begin}largest deflection after later loads", *(_length(one.after_loads) for one in trials)),
            (f"{begin}largest deflection in the last tenth", *(_length(one.left) for one in trials)),
            (f"{begin}largest control current", *(with_unit(one.most_current, CURRENT) for one in trials)),
        ]
    return lines


def limits(answer: MagneticAnswer) -> list[Check]:
    """Where the answer is not what it seems: each check with what fails it."""
    found = []
    for control in answer.controllers:
        name = NAMES[control.name]
        for label, fails in (
            ("Not stable", ~control.stable),
            ("Sensitivity above 3", np.nan_to_num(control.sensitivity, nan=0.0) > SENSITIVE),
            ("Faster than coils are", -control.poles.real.min(axis=-1) > FASTEST),
        ):
            found.append(check(f"{label}, {name}", ranges(answer.speed, fails), fails.any()))
        if control.trial is not None:
            ending, end = control.trial.motion.ending.value, float(control.trial.motion.time[-1])
            found.append(check(f"Trial in time, {name}", f"{ending} at {_time(end)}", ending != "done"))
    return found


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


def _least(values: Array, words: Callable[[float], str]) -> str:
    return words(float(values.min())) if np.isfinite(values).all() else NOT_FOUND


def _most(values: Array) -> str:
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
