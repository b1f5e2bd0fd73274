"""What `run` answers of a vibrating table whose balls can stick: stuck speeds and vibration over speed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import numpy as np
from numpy.typing import NDArray

from leblanc.core.answer import Answer
from leblanc.core.blocks import (
    Block,
    Cell,
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
from leblanc.core.units import LENGTH, RPM, in_rpm, number, over_rpm, ranges, unit_for, with_unit
from leblanc.wings.dry import DryAnswer
from meshes.arrays import Array, Flags
from meshes.quantity import Q
from solvers.rotor.exciter.machine import Dimensionless

if TYPE_CHECKING:
    from solvers.rotor.exciter.machine import Exciter
    from solvers.rotor.exciter.motion import Start

NUMBERS = {
    "smallness": "Share of the balls in the moving mass, over their rolling inertia",
    "drag": "Drag of the balls",
    "unbalance": "Unbalance of the shaft, over that of the balls",
    "damping": "Damping ratio of the platform",
}
MODEL = (
    "Stuck speeds and vibration are those of the lowest order in the balls' share of the moving mass; the "
    "critical speed and the integrated speeds come from the full equations in time. "
    "Taken for granted: balls that roll without sliding or touching, a shaft that keeps its speed, a "
    "platform that moves along one line, no gravity."
)
_OVER, _RATE = ("speed",), "rad s-1"


@dataclass(frozen=True)
class TimeCheck:
    """One time integration beside the formulas."""

    speed: Annotated[float, Q(_RATE, "shaft speed", "integrated in time")]
    stuck_speed: Annotated[float, Q(_RATE, "speed of the balls", "mean over time")]
    #: nan where the two cannot be distinguished
    slow: Annotated[float, Q("m", "slow vibration", "amplitude of the platform, integrated in time")]
    fast: Annotated[float, Q("m", "fast vibration", "amplitude of the platform, integrated in time")]
    holds: Annotated[bool, Q(name="the balls stay", flags="no yes")]
    converged: Annotated[bool, Q(name="every number is finite", data=False)]


@dataclass(frozen=True)
class _Known(Answer):
    """What is known without any integration in time."""

    name: Annotated[str, Q(text="of the scene")]
    source: str
    assumed: tuple[str, ...]  #: values that no source gives
    digest: str  #: of the scene
    natural_frequency: Annotated[float, Q(_RATE, "natural frequency", "of the platform")]
    dimensionless: Annotated[Dimensionless, Q(text="dimensionless numbers")]
    #: shaft speeds between which there are three stuck speeds and, second, where the slowest passes the
    #: resonance, rad/s; nan if there is one at every speed
    characteristic: tuple[float, float, float]
    #: nan outside its ranges
    critical_speed_printed: Annotated[float, Q(_RATE, "critical speed", "by the source's regression")]

    @property
    def characteristic_speeds(
        self,
    ) -> Annotated[
        dict[str, float], Q("rad s-1", text="shaft speeds where the stuck speeds change, by name", data=False)
    ]:
        return dict(zip(("second_pair", "through_resonance", "merger"), self.characteristic, strict=True))

    @property
    def second_pair(
        self,
    ) -> Annotated[float, Q(_RATE, "shaft speed", "first with three stuck speeds", json=False)]:
        return self.characteristic[0]

    @property
    def through_resonance(
        self,
    ) -> Annotated[float, Q(_RATE, "shaft speed", "slowest stuck speed at the resonance", json=False)]:
        return self.characteristic[1]

    @property
    def merger(self) -> Annotated[float, Q(_RATE, "shaft speed", "up to it three stuck speeds", json=False)]:
        return self.characteristic[2]


@dataclass(frozen=True)
class ExciterExplanation(_Known):
    """Numbers that determine how a vibrating table with balls behaves, without any integration in time.

    Examples
    --------
    >>> import leblanc as lb
    >>> explanation = lb.explain(lb.example("vibratory_table"))
    >>> [f"{speed:.4g} rad/s" for speed in explanation.characteristic]
    ['70.8 rad/s', '1540 rad/s', '1542 rad/s']
    """

    command = "explain"
    figure = "leblanc.wings.exciter.figure:stuck_range_figure"

    #: first and last shaft speed
    speed_ratio: Annotated[
        tuple[float, float], Q("1", text="speeds of the scene over the natural frequency", data=False)
    ]

    @property
    def numbers(self) -> Annotated[Dimensionless, Q(part=True, json=False)]:
        return self.dimensionless

    def blocks(self) -> tuple[Block, ...]:
        numbers, (begin, _, end) = self.dimensionless, self.characteristic
        first, last = self.speed_ratio
        share = "share of the balls in the moving mass over their rolling inertia"
        rows = [
            ("natural frequency", in_rpm(self.natural_frequency, "none")),
            ("speeds", f"{first:.3g} to {last:.3g} times the natural frequency"),
            ("smallness", f"{numbers.smallness:.4g}: {share}"),
            ("drag", f"{numbers.drag:.4g}: drag of the balls"),
            ("unbalance", f"{numbers.unbalance:.4g}: unbalance over that of the balls"),
            ("damping", f"{numbers.damping:.4g}: damping ratio of the platform"),
            ("three stuck speeds", f"from {in_rpm(begin, 'none')} to {in_rpm(end, 'none')}"),
            ("printed critical", f"{in_rpm(self.critical_speed_printed, 'none')} by the source's regression"),
        ]
        return Words(self.name), Table(rows, indent=2)


@dataclass(frozen=True)
class ExciterAnswer(_Known, DryAnswer):
    """Answer over speed; n speeds.

    Examples
    --------
    >>> import leblanc as lb
    >>> answer = lb.run(lb.example("vibratory_table").replace({"speeds.count": 2}))
    >>> answer.stuck_speeds.shape
    (2, 3)
    """

    command = "run"
    title = "Stuck speeds of the balls and vibration of the platform"
    page = "summary.html"
    unused = ("model", "runup", "optimise")
    figure = "leblanc.wings.exciter.figure:exciter_figure"

    machine: Exciter  #: the exciter
    speed: Annotated[Array, Q(_RATE, "shaft speed", "of the exciter", over=_OVER)]
    amplitude_slow: Annotated[
        Array,
        Q(
            "m",
            "slow vibration of the platform",
            "zero to peak, with the balls, slowest stuck speed",
            over=_OVER,
        ),
    ]
    amplitude_fast: Annotated[
        Array, Q("m", "fast vibration of the platform", "zero to peak, with the shaft", over=_OVER)
    ]
    #: by size, nan where there are fewer, shape (n, 3)
    stuck_speeds: Annotated[
        Array, Q(_RATE, "stuck speed of the balls", over=("speed", "pair"), variable="stuck_speed")
    ]
    dual_frequency: Annotated[Flags, Q(name="the balls stick together", over=_OVER, flags="no yes")]
    #: nan if there is one stuck speed at every speed
    critical_speed: Annotated[float, Q(_RATE, "critical speed", "balls stick up to it")]
    start: Annotated[Start, Q(text="from which the critical speed is searched")]
    checks: Annotated[tuple[TimeCheck, ...], Q(text="time integrations", rows="check")]

    @property
    def converged(self) -> bool:
        """Every time integration stayed finite."""
        return all(check.converged for check in self.checks)

    @property
    def amplitude(
        self,
    ) -> Annotated[Array, Q("m", "amplitude", "of the platform, both vibrations", over=_OVER)]:
        return np.asarray(self.amplitude_fast + np.where(self.dual_frequency, self.amplitude_slow, 0.0))

    @property
    def amplitude_dry(self) -> Annotated[Array, Q("m", "amplitude", "shaft alone", over=_OVER, data=False)]:
        return self.amplitude_fast

    @property
    def phase(
        self,
    ) -> Annotated[Array, Q("rad", "phase", "from the unbalance; lags are negative", over=_OVER, data=False)]:
        ratio = self.speed / self.natural_frequency
        return -np.arctan2(2.0 * self.dimensionless.damping * ratio, 1.0 - np.square(ratio))

    @property
    def stable(self) -> Annotated[Flags, Q(name="the balls stick together", over=_OVER, data=False)]:
        return self.dual_frequency

    @property
    def model(self) -> Annotated[NDArray[np.str_], Q(name="what answers", over=_OVER)]:
        return np.full(self.speed.shape, "balls")

    @property
    def faults(self) -> tuple[str, ...]:
        lost = "a time integration beside the formulas did not stay finite"
        return () if self.converged else (lost,)

    @property
    def closing(self) -> str:
        return f"{self.name}: {self.speed.size} speeds done"

    def blocks(self) -> tuple[Block, ...]:
        low, high = (number(float(speed) * RPM) for speed in (self.speed[0], self.speed[-1]))
        about = (
            f"A platform with {self.machine.ball_count} balls in the track of its shaft, shaken from {low} "
            f"to {high} rpm in {self.speed.size} speeds."
        )
        began = f"The critical speed depends on the start: here {self.start.kind}, "
        began += f"{number(self.start.separation)} rad apart."
        numbers = [(text, number(getattr(self.dimensionless, name))) for name, text in NUMBERS.items()]
        tables = Columns(
            (Table(facts(self)), Checks(limits(self))),
            (Table(numbers, ("Dimensionless numbers", "")), _integrations(self)),
            shown="page",
        )
        printed = "The numbers over speed are printed by the same command with --json."
        return (
            Headline(_answer(self), about),
            Section(
                "Results", (Picture("exciter", self.title, self.figure), tables), width="110mm", shown="page"
            ),
            *(Words(line, shown="text") for line in _lines(self)),
            Checks(limits(self), shown="text"),
            Section("Model", (Words(MODEL, name="balls", small=True),), shown="page"),
            Notes((began, printed), shown="page"),
        )


def _answer(answer: ExciterAnswer) -> str:
    """Up to where the balls stick, in one sentence."""
    if not math.isfinite(answer.critical_speed):
        return "The balls can stick together at one speed only, whatever the speed of the shaft."
    first, _, last = answer.characteristic
    return (
        f"The balls stick together up to {in_rpm(answer.critical_speed)} of the shaft, the platform "
        f"vibrating at two frequencies; from {in_rpm(first)} to {in_rpm(last)} they have three stuck speeds."
    )


def facts(answer: ExciterAnswer) -> list[tuple[str, str]]:
    """Speeds that decide how the table behaves, and its vibration at the last speed: label and value."""
    first, through, last = answer.characteristic
    none = "none: one stuck speed at every speed"
    at = in_rpm(float(answer.speed[-1]))
    slow = "none: they do not stick"
    if answer.dual_frequency[-1]:
        slow = with_unit(float(answer.amplitude_slow[-1]), LENGTH)
    return [
        ("Natural frequency of the platform", in_rpm(answer.natural_frequency)),
        (
            "Three stuck speeds, shaft from and to",
            f"{in_rpm(first)} to {in_rpm(last)}" if math.isfinite(first) else none,
        ),
        ("Slowest stuck speed at the resonance, shaft at", in_rpm(through, "none")),
        ("Critical speed, up to which the balls stick", in_rpm(answer.critical_speed, "none")),
        ("The same by the source's regression", in_rpm(answer.critical_speed_printed, "outside its ranges")),
        (f"Vibration with the balls at {at}", slow),
        (f"Vibration with the shaft at {at}", with_unit(float(answer.amplitude_fast[-1]), LENGTH)),
    ]


def limits(answer: ExciterAnswer) -> list[Check]:
    """Where the answer is not what it seems: each check with what fails it."""
    lost = [one.speed for one in answer.checks if not one.converged]
    beyond, outside = ~answer.dual_frequency, not math.isfinite(answer.critical_speed_printed)
    return [
        check("Time integration not finite", ", ".join(map(in_rpm, lost)) or "none", lost),
        check("Balls do not stick", ranges(answer.speed, beyond), beyond.any()),
        check("Regression of the source", "outside its ranges" if outside else "inside", outside),
    ]


def _lines(answer: ExciterAnswer) -> list[str]:
    """The answer in a few lines."""
    lines = [f"Natural frequency of the platform: {in_rpm(answer.natural_frequency)}"]
    if math.isfinite(answer.critical_speed):
        first, _, last = answer.characteristic
        lines += [
            f"Three stuck speeds of the balls {over_rpm(first, last)} of the shaft",
            f"Critical speed, up to which the balls stick together: {in_rpm(answer.critical_speed)}",
        ]
    else:
        lines.append("One stuck speed of the balls at every speed of the shaft")
    for one in answer.checks:
        began, both = f"Integrated at {in_rpm(one.speed)}: balls", ""
        if math.isfinite(one.slow):
            slow, fast = with_unit(one.slow, LENGTH), with_unit(one.fast, LENGTH)
            both = f", platform {slow} with them and {fast} with the shaft"
        stay = f"stay at {in_rpm(one.stuck_speed)}{both}"
        lines.append(f"{began} {stay if one.holds else 'leave'}")
    return lines


def _integrations(answer: ExciterAnswer) -> Table:
    """Time integrations beside the formulas."""
    unit = unit_for(LENGTH, *(size for one in answer.checks for size in (one.slow, one.fast)))
    rows: list[tuple[str | Cell, ...]] = []
    for one in answer.checks:
        stay = Cell("stay" if one.holds else "leave", warning=not one.converged)
        stuck = number(one.stuck_speed * RPM) if one.holds else ""
        both = [unit.number(x) if one.holds and math.isfinite(x) else "" for x in (one.slow, one.fast)]
        rows.append((number(one.speed * RPM), stay, stuck, *both))
    platform = f"platform with them ({unit.name})", f"with the shaft ({unit.name})"
    return Table(rows, ("Shaft (rpm)", "balls", "at (rpm)", *platform), title="Integrated in time")


def alt(answer: ExciterAnswer) -> str:
    """What the figure shows."""
    return (
        "Curves of the speeds at which the balls can stick together and of the platform's two vibrations "
        f"over the shaft's speed; critical speed: {in_rpm(answer.critical_speed, 'none')}."
    )
