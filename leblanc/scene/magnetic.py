"""A rotor in magnetic bearings as a scene gives it: magnets, motor, fluid, control, loads, trial."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field

from leblanc.core import units
from leblanc.core.units import CURRENT, LENGTH, MASS, TIME, number, with_unit
from leblanc.scene.rows import Row, RowTable, Value, mm, row, rpm
from leblanc.scene.schema.part import Conflict, Part
from leblanc.scene.schema.rules import (
    STIFFNESS,
    Axis,
    Damping,
    Inertia,
    Length,
    Mass,
    Position,
    Speed,
    Stiffness,
    entries,
    quantity,
    whole,
)

if TYPE_CHECKING:
    from solvers.rotor.magnetic.control import Controller
    from solvers.rotor.magnetic.machine import MagneticRotor as Machine
    from solvers.rotor.magnetic.motion import Load, SpeedLaw

MAX_LOADS = 100
MAX_SAMPLES = 100_001

_Current = Annotated[float, quantity(units.CURRENT, 1e-9, 1e6)]
_Time = Annotated[float, quantity(units.TIME, 1e-9, 1e6)]
_Force = Annotated[float, quantity(units.FORCE, -1e9, 1e9)]
_Moment = Annotated[float, quantity(units.TORQUE, -1e9, 1e9)]
_Offset = Annotated[float, quantity(units.LENGTH, -1.0, 1.0)]
_Rate = Annotated[float, quantity(units.CUBIC_RATE, 1e-12, 1e24)]
_FREQUENCY = quantity(units.ANGULAR_SPEED, 1e-6, 1e9)


class Magnets(Part):
    """Two opposite magnets on each of two axes, in each of two bearings."""

    gap: Length = Field(description="between the rotor in the centre and each magnet")
    force_constant: Annotated[float, quantity(units.MAGNET, 1e-18, 1e6)] = Field(
        description="force of one magnet times the square of its gap over that of its current"
    )
    bias_current: _Current = Field(description="that flows in every coil")
    most_current: _Current | None = Field(
        None, description="largest control current; the bias current if left out, with which one coil is off"
    )
    bandwidth: Annotated[float | None, _FREQUENCY] = Field(
        None, description="of coils and amplifiers; they follow at once if left out"
    )
    first: Position = Field(description="place of the first bearing along the axis, from the rotor's centre")
    second: Position = Field(description="place of the second bearing, above the first")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A coil cannot push, and the bearings are apart."""
        most, bias = values.get("most_current"), values.get("bias_current")
        if most is not None and bias is not None and most > bias:
            yield Conflict(("most_current",), f"at most rotor.magnets.bias_current, {bias:g} A")
        if {"first", "second"} <= values.keys() and values["first"] >= values["second"]:
            yield Conflict(("second",), f"above rotor.magnets.first, {values['first']:g} m")


class Motor(Part):
    """A motor between the bearings, which pulls the rotor out of the centre."""

    stiffness: Stiffness = Field(description="of that pull, c_m: force outwards over the deflection")
    length: Length = Field(description="over which it pulls evenly, l_m")


class Drag(Part):
    """The fluid around the rotor, which holds against its turning."""

    coefficient: Annotated[float, quantity(units.NUMBER, 0.0, 1e6)] = Field(description="c_w of the shape")
    viscosity: Annotated[float, quantity(units.DYNAMIC_VISCOSITY, 0.0, 1e6)] = Field(
        description="of the fluid, dynamic"
    )
    radius: Length = Field(description="of the rotor in the fluid")
    length: Length = Field(description="of the rotor in the fluid")


class Synergetic(Part):
    """Synergetic control, which knows the rotor and takes off what acts on it."""

    manifold_time: _Time = Field(description="T_1 to T_4, in which the rate approaches what is wanted")
    goal_time: _Time = Field(description="T_5 to T_8, in which the deflection approaches the centre")
    weight: Annotated[float, quantity(units.SQUARE_TIME, 1e-18, 1e12)] = Field(
        description="h, of the estimated load beside the deflection"
    )
    rate: _Rate = Field(description="mu_1 and mu_2, by which a deflection raises the estimated load")
    tilt_rate: _Rate = Field(description="mu_3 and mu_4, the same for a lean")


class Pid(Part):
    """PID control of each axis of each bearing by itself."""

    proportional: Annotated[float, STIFFNESS] = Field(description="force over the deflection in the bearing")
    integral: Annotated[float, quantity(units.INTEGRAL_GAIN, 0.0, 1e18)] = Field(
        description="force over the integral of the deflection"
    )
    derivative: Damping = Field(description="force over the rate of the deflection")
    cutoff: Annotated[float, _FREQUENCY] = Field(description="of the filter before the derivative")


class OuterLoad(Part):
    """A load from outside, constant or harmonic."""

    force: Annotated[tuple[_Force, _Force], entries(2, 2, "forces, along x and y")] = Field(
        (0.0, 0.0), description="on the rotor's centre, along x and y"
    )
    moment: Annotated[tuple[_Moment, _Moment], entries(2, 2, "moments, about x and y")] = Field(
        (0.0, 0.0), description="about x and y"
    )
    frequency: Annotated[float | None, _FREQUENCY] = Field(
        None, description="with which it swings; constant if left out"
    )
    start: Annotated[float, quantity(units.TIME, 0.0, 1e6)] = Field(
        0.0, description="time of the trial from which it acts"
    )

    def load(self) -> Load:
        """The load as the solvers take it."""
        from solvers.rotor.magnetic.motion import Load

        return Load(self.force, self.moment, self.frequency, self.start)


class Trial(Part):
    """A motion of the rotor that is followed in time."""

    duration: _Time = Field(description="of the motion")
    speed: Speed = Field(description="of the rotor, in the mean")
    pulsation: Annotated[float, quantity(units.ANGULAR_SPEED, 0.0, 1e6)] = Field(
        0.0, description="amplitude by which the speed swings about its mean, at most the mean"
    )
    pulsation_frequency: Annotated[float, quantity(units.ANGULAR_SPEED, 0.0, 1e6)] = Field(
        0.0, description="with which it swings"
    )
    offset: Annotated[tuple[_Offset, _Offset], entries(2, 2, "lengths, along x and y")] = Field(
        (0.0, 0.0), description="of the rotor's centre at the start, along x and y"
    )
    samples: Annotated[int, whole(2, MAX_SAMPLES)] = Field(1001, description="times that are recorded")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """The rotor does not turn backwards."""
        if {"speed", "pulsation"} <= values.keys() and values["pulsation"] > values["speed"]:
            yield Conflict(("pulsation",), f"at most rotor.trial.speed, {values['speed']:g} rad/s")

    def law(self) -> SpeedLaw:
        """Speed over time, as the solvers take it."""
        from solvers.rotor.magnetic.motion import SpeedLaw

        return SpeedLaw(self.speed, self.pulsation, self.pulsation_frequency)


class MagneticRotor(Part):
    """A rigid rotor that a controller keeps in the centre of two magnetic bearings.

    Examples
    --------
    >>> import leblanc as lb
    >>> rotor = lb.example("blood_pump").rotor
    >>> f"{rotor.machine().magnets.position_stiffness:.0f} N/m"
    '9000 N/m'
    """

    kind: Literal["magnetic"] = Field("magnetic", description="the kind of rotor")
    mass: Mass = Field(description="of the rotor")
    transverse_inertia: Inertia = Field(description="across the axis, about the rotor's centre")
    polar_inertia: Inertia = Field(description="about the axis")
    eccentricity: Annotated[float, quantity(units.LENGTH, 0.0, 1.0)] = Field(
        description="distance of the centre of mass from the axis"
    )
    inertia_tilt: Annotated[float, quantity(units.ANGLE, 0.0, 1.0)] = Field(
        0.0, description="angle between the axis and the principal axis of inertia"
    )
    axis: Axis = Field(description="horizontal: gravity lies across the axis, against y; vertical: along it")
    magnets: Magnets = Field(description="of the bearings")
    motor: Motor | None = Field(None, description="between the bearings; none if left out")
    drag: Drag | None = Field(None, description="of the fluid; none if left out")
    synergetic: Synergetic | None = Field(None, description="control to answer for; or pid, or both")
    pid: Pid | None = Field(None, description="control to answer for; or synergetic, or both")
    loads: Annotated[tuple[OuterLoad, ...], entries(0, MAX_LOADS, "tables headed [[rotor.loads]]")] = Field(
        (), description="from outside, one table each"
    )
    trial: Trial | None = Field(None, description="motion that is followed in time; none if left out")

    CONTROLS: ClassVar = ("synergetic", "pid")

    @classmethod
    def conflicts(cls, values: Mapping[str, Any], given: Mapping[str, Any]) -> Iterator[Conflict]:
        """A body has its inertias, something controls it, and it starts between its magnets."""
        across, about = values.get("transverse_inertia"), values.get("polar_inertia")
        if across is not None and about is not None and about > 2.0 * across:
            yield Conflict(("polar_inertia",), f"at most twice rotor.transverse_inertia, {2.0 * across:g}")
        if not any(given.get(name) is not None for name in cls.CONTROLS):
            yield Conflict(("synergetic",), "given, or pid: without control the magnets do not hold a rotor")
        trial, magnets = values.get("trial"), values.get("magnets")
        if trial is not None and magnets is not None and math.hypot(*trial.offset) >= magnets.gap:
            yield Conflict(("trial", "offset"), f"within rotor.magnets.gap, {magnets.gap:g} m, of the centre")

    @property
    def unbalance(self) -> float:
        """Mass times the distance of its centre from the axis, kg m."""
        return self.mass * self.eccentricity

    @cached_property
    def _machine(self) -> Machine:
        from solvers.rotor.magnetic import machine as solver

        magnets, motor, drag = self.magnets, self.motor, self.drag
        return solver.MagneticRotor(
            mass=self.mass,
            transverse_inertia=self.transverse_inertia,
            polar_inertia=self.polar_inertia,
            eccentricity=self.eccentricity,
            inertia_tilt=self.inertia_tilt,
            first=magnets.first,
            second=magnets.second,
            magnets=solver.Magnets(
                magnets.gap,
                magnets.force_constant,
                magnets.bias_current,
                magnets.most_current,
                magnets.bandwidth,
            ),
            motor_stiffness=0.0 if motor is None else motor.stiffness,
            motor_length=0.0 if motor is None else motor.length,
            drag=0.0 if drag is None else solver.screw_drag(**drag.model_dump()),
        )

    def machine(self) -> Machine:
        """The rotor as the solvers take it."""
        return self._machine

    def controllers(self) -> tuple[Controller, ...]:
        """What the scene asks to be controlled by, each knowing this rotor."""
        from solvers.rotor.magnetic import control

        machine = self.machine()
        found: list[Controller] = []
        if self.synergetic is not None:
            found.append(control.Synergetic(machine, **self.synergetic.model_dump()))
        if self.pid is not None:
            found.append(control.Pid(machine, **self.pid.model_dump()))
        return tuple(found)

    def rows(self) -> list[Row]:
        """Rows of the rotor, for readers."""
        across, about = f"{number(self.transverse_inertia)} kg m²", f"{number(self.polar_inertia)} kg m²"
        found = [
            row("Rotor", f"{self.kind}, {self.axis} axis", "rotor.axis", "rotor.kind"),
            row("Mass", with_unit(self.mass, MASS), "rotor.mass"),
            row("Inertia across the axis", across, "rotor.transverse_inertia"),
            row("Inertia about the axis", about, "rotor.polar_inertia"),
            row("Centre of mass off the axis", mm(self.eccentricity), "rotor.eccentricity"),
            row("Principal axis leans by", f"{number(self.inertia_tilt)} rad", "rotor.inertia_tilt"),
            *_magnet_rows(self.magnets),
        ]
        for name, rows in (
            ("motor", _motor_rows),
            ("drag", _drag_rows),
            ("synergetic", _synergetic_rows),
            ("pid", _pid_rows),
            ("trial", _trial_rows),
        ):
            if (part := getattr(self, name)) is not None:
                found += rows(part)
        return found

    def tables(self) -> list[RowTable]:
        """Loads of the rotor, for readers."""
        if not self.loads:
            return []
        lines = []
        for k, load in enumerate(self.loads):
            at = f"rotor.loads.{k}"
            swings = "constant" if load.frequency is None else _hertz(load.frequency)
            lines.append(
                (
                    Value(f"{k + 1}"),
                    Value(_pair(load.force), (f"{at}.force",)),
                    Value(_pair(load.moment), (f"{at}.moment",)),
                    Value(swings, (f"{at}.frequency",)),
                    Value(number(load.start), (f"{at}.start",)),
                )
            )
        head = ("Load", "force x, y (N)", "moment x, y (N m)", "frequency", "from (s)")
        return [RowTable(head, tuple(lines))]


def _pair(values: tuple[float, float]) -> str:
    return f"({number(values[0])}, {number(values[1])})"


def _hertz(frequency: float) -> str:
    return f"{number(frequency / (2.0 * math.pi))} Hz"


def _magnet_rows(magnets: Magnets) -> list[Row]:
    constant = f"{number(magnets.force_constant)} N m²/A²"
    found = [
        row("Gap of the magnets", mm(magnets.gap), "rotor.magnets.gap"),
        row("Force constant of a magnet", constant, "rotor.magnets.force_constant"),
        row("Bias current", with_unit(magnets.bias_current, CURRENT), "rotor.magnets.bias_current"),
        row("First bearing at", mm(magnets.first), "rotor.magnets.first"),
        row("Second bearing at", mm(magnets.second), "rotor.magnets.second"),
    ]
    if magnets.most_current is not None:
        most = with_unit(magnets.most_current, CURRENT)
        found.append(row("Largest control current", most, "rotor.magnets.most_current"))
    if magnets.bandwidth is not None:
        found.append(row("Bandwidth of the coils", _hertz(magnets.bandwidth), "rotor.magnets.bandwidth"))
    return found


def _motor_rows(motor: Motor) -> list[Row]:
    return [
        row("Pull of the motor outwards", f"{number(motor.stiffness)} N/m", "rotor.motor.stiffness"),
        row("Length of the motor", mm(motor.length), "rotor.motor.length"),
    ]


def _drag_rows(drag: Drag) -> list[Row]:
    return [
        row("Drag coefficient in the fluid", number(drag.coefficient), "rotor.drag.coefficient"),
        row("Viscosity of the fluid", f"{number(drag.viscosity)} Pa s", "rotor.drag.viscosity"),
        row("Radius in the fluid", mm(drag.radius), "rotor.drag.radius"),
        row("Length in the fluid", mm(drag.length), "rotor.drag.length"),
    ]


def _synergetic_rows(control: Synergetic) -> list[Row]:
    at = "rotor.synergetic"
    return [
        row(
            "Synergetic: time of the manifold", with_unit(control.manifold_time, TIME), f"{at}.manifold_time"
        ),
        row("Synergetic: time of the goal", with_unit(control.goal_time, TIME), f"{at}.goal_time"),
        row("Synergetic: weight of the load", f"{number(control.weight)} s²", f"{at}.weight"),
        row("Synergetic: rate of the estimate", f"{number(control.rate)} 1/s³", f"{at}.rate"),
        row("Synergetic: the same for a lean", f"{number(control.tilt_rate)} 1/s³", f"{at}.tilt_rate"),
    ]


def _pid_rows(control: Pid) -> list[Row]:
    return [
        row("PID: proportional", f"{number(control.proportional)} N/m", "rotor.pid.proportional"),
        row("PID: integral", f"{number(control.integral)} N/(m s)", "rotor.pid.integral"),
        row("PID: derivative", f"{number(control.derivative)} N s/m", "rotor.pid.derivative"),
        row("PID: filter of the derivative", _hertz(control.cutoff), "rotor.pid.cutoff"),
    ]


def _trial_rows(trial: Trial) -> list[Row]:
    at = "rotor.trial"
    offset = f"({', '.join(with_unit(part, LENGTH) for part in trial.offset)})"
    return [
        row("Followed in time for", with_unit(trial.duration, TIME), f"{at}.duration"),
        row("Speed in the mean", rpm(trial.speed), f"{at}.speed"),
        row("Amplitude of the speed", rpm(trial.pulsation), f"{at}.pulsation"),
        row("Frequency of the speed", _hertz(trial.pulsation_frequency), f"{at}.pulsation_frequency"),
        row("Centre at the start", offset, f"{at}.offset"),
        row("Times recorded", f"{trial.samples}", f"{at}.samples"),
    ]
