"""What drives the coils of magnetic bearings: synergetic control, PID control, or nothing."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

import numpy as np

from meshes.arrays import Array
from meshes.errors import require_not_negative, require_positive
from solvers.rotor.magnetic.machine import MagneticRotor


@dataclass(frozen=True)
class Gains:
    """Controller about the centre: i = -(place q + rate q' + memory s), s' = from_place q + from_memory s."""

    place: Array  #: currents for unit coordinates and rates, A, shape (4, 4)
    rate: Array
    memory: Array  #: currents for a unit state of the controller, A, shape (4, k)
    from_place: Array  #: shape (k, 4)
    from_memory: Array  #: shape (k, k)


class Controller(Protocol):
    """What drives the coils, with a state of k values of its own that starts at 0."""

    @property
    def name(self) -> str:
        """Name in scenes and results."""
        ...

    @property
    def states(self) -> int:
        """Number k of values of its state."""
        ...

    @property
    def scales(self) -> Array:
        """Sizes that its state may have, beside which an error counts, shape (k,)."""
        ...

    def answer(self, speed: float, place: Array, rate: Array, memory: Array) -> tuple[Array, Array]:
        """Wanted currents, A, shape (4,), and the rate of change of its state, shape (k,)."""
        ...

    def gains(self, speed: float) -> Gains:
        """Linear part of the control about the centre."""
        ...


@dataclass(frozen=True)
class Synergetic:
    """Feedback that makes the rotor approach a manifold and on it its centre [theory: magnetic, eq. 11-16].

    It knows the rotor: the forces of magnets, motor, fluid and gyroscopic terms are worked out and taken off.
    """

    model: MagneticRotor  #: the rotor that it knows
    manifold_time: float  #: T_1 to T_4, s
    goal_time: float  #: T_5 to T_8, s
    weight: float  #: h_1 to h_4, of the estimated disturbance beside the deflection, s^2
    rate: float  #: mu_1, mu_2 and mu_3, mu_4, by which a deflection and a lean raise the estimate, 1/s^3
    tilt_rate: float

    def __post_init__(self) -> None:
        for name in ("manifold_time", "goal_time", "weight", "rate", "tilt_rate"):
            require_positive(name, getattr(self, name))

    name = "synergetic"
    states = 4

    @property
    def scales(self) -> Array:
        """As `Controller.scales`: accelerations that the magnets reach."""
        push = self.model.magnets.current_stiffness * self.model.magnets.bias_current
        place = 0.5 * (self.model.second - self.model.first)
        return push * np.array([1.0, 1.0, place, place]) / self.model.inertia

    @property
    def rates(self) -> Array:
        """mu of the four coordinates, 1/s^3, shape (4,)."""
        return np.array([self.rate, self.rate, self.tilt_rate, self.tilt_rate])

    @property
    def feedback(self) -> tuple[Array, Array, float]:
        """Wanted acceleration is -(P q + D q' + Z z): P, D of shape (4,), Z [theory: magnetic, eq. 15]."""
        pull = self.weight * self.rates
        inner = pull + 1.0 / self.goal_time
        place = pull / self.goal_time + inner / self.manifold_time
        return (
            place,
            inner + 1.0 / self.manifold_time,
            1.0 + self.weight / (self.goal_time * self.manifold_time),
        )

    def forces(self, speed: float, place: Array, rate: Array, memory: Array) -> Array:
        """Wanted forces along the axes of the bearings, N, shape (4,) [theory: magnetic, eq. 16]."""
        on_place, on_rate, on_memory = self._matrices(speed)
        return np.asarray(on_place @ place + on_rate @ rate + on_memory @ memory)

    def answer(self, speed: float, place: Array, rate: Array, memory: Array) -> tuple[Array, Array]:
        """As `Controller.answer`: the estimate of the disturbance is its state."""
        wanted = self.forces(speed, place, rate, memory)
        current = self.model.magnets.current(self._motion @ place, wanted)
        return current, np.asarray(self._rates * place)

    def gains(self, speed: float) -> Gains:
        """As `Controller.gains`."""
        on_place, on_rate, on_memory = self._matrices(speed)
        magnets = self.model.magnets
        pulled = magnets.position_stiffness * self.model.bearing_motion
        return Gains(
            place=np.asarray((pulled - on_place) / magnets.current_stiffness),
            rate=np.asarray(-on_rate / magnets.current_stiffness),
            memory=np.asarray(-on_memory / magnets.current_stiffness),
            from_place=np.diag(self.rates),
            from_memory=np.zeros((4, 4)),
        )

    def _matrices(self, speed: float) -> tuple[Array, Array, Array]:
        """Wanted forces for unit coordinates, rates and estimates, each of shape (4, 4)."""
        on_place, per_speed, on_rate, gyroscopic, on_memory = self._parts
        return on_place + speed * per_speed, on_rate + speed * gyroscopic, on_memory

    @cached_property
    def _parts(self) -> tuple[Array, Array, Array, Array, Array]:
        """Parts of `_matrices` with and without the speed, the latter for 1 rad/s."""
        model = self.model
        spread, inertia = np.linalg.inv(model.bearing_motion.T), model.inertia
        on_place, on_rate, on_memory = self.feedback
        return (
            spread @ (-model.motor_pull - np.diag(inertia * on_place)),
            spread @ model.circulation,
            spread @ (model.damping - np.diag(inertia * on_rate)),
            spread @ model.gyroscopic,
            np.asarray(spread @ np.diag(-inertia * on_memory), dtype=np.float64),
        )

    @cached_property
    def _motion(self) -> Array:
        return self.model.bearing_motion

    @cached_property
    def _rates(self) -> Array:
        return self.rates


@dataclass(frozen=True)
class Pid:
    """PID control of each axis of each bearing, its derivative filtered [theory: magnetic, eq. 18]."""

    model: MagneticRotor  #: the rotor, of which it knows the gap, the bias current and the force constant
    proportional: float  #: P, N/m
    integral: float  #: I, N/(m s)
    derivative: float  #: D, N s/m
    cutoff: float  #: of the filter of the derivative, rad/s

    def __post_init__(self) -> None:
        require_positive("proportional", self.proportional)
        require_positive("cutoff", self.cutoff)
        require_not_negative("integral", self.integral)
        require_not_negative("derivative", self.derivative)

    name = "pid"
    states = 8

    @property
    def scales(self) -> Array:
        """As `Controller.scales`: the gap, and the gap over the time of the integral part."""
        gap = self.model.magnets.gap
        held = self.proportional / self.integral if self.integral > 0.0 else 1.0
        return gap * np.repeat([held, 1.0], 4)

    def answer(self, speed: float, place: Array, rate: Array, memory: Array) -> tuple[Array, Array]:
        """As `Controller.answer`: integrals and filtered deflections of the four axes are its state."""
        at = self._motion @ place
        slope = self.cutoff * (at - memory[4:])
        wanted = -(self.proportional * at + self.integral * memory[:4] + self.derivative * slope)
        return np.asarray(wanted / self.model.magnets.current_stiffness), np.concatenate((at, slope))

    def gains(self, speed: float) -> Gains:
        """As `Controller.gains`."""
        motion, unit = self.model.bearing_motion, np.eye(4)
        steep = self.derivative * self.cutoff
        per_force = 1.0 / self.model.magnets.current_stiffness
        nothing = np.zeros((4, 4))
        return Gains(
            place=np.asarray(per_force * (self.proportional + steep) * motion),
            rate=nothing,
            memory=np.asarray(per_force * np.hstack((self.integral * unit, -steep * unit))),
            from_place=np.vstack((motion, self.cutoff * motion)),
            from_memory=np.block([[nothing, nothing], [nothing, -self.cutoff * unit]]),
        )

    @cached_property
    def _motion(self) -> Array:
        return self.model.bearing_motion


@dataclass(frozen=True)
class Uncontrolled:
    """Bias currents alone."""

    name = "none"
    states = 0
    scales = np.zeros(0)

    def answer(self, speed: float, place: Array, rate: Array, memory: Array) -> tuple[Array, Array]:
        """As `Controller.answer`."""
        return np.zeros(4), np.zeros(0)

    def gains(self, speed: float) -> Gains:
        """As `Controller.gains`."""
        nothing = np.zeros((4, 4))
        return Gains(nothing, nothing, np.zeros((4, 0)), np.zeros((0, 4)), np.zeros((0, 0)))


def source_times(
    machine: MagneticRotor, time: float, weight: float, rate: float, tilt_rate: float
) -> Synergetic:
    """Synergetic control from numbers over powers of sqrt(m/c_m), as the source has them [BG18, section 4].

    T, h, mu_1 and mu_3, dimensionless, of a machine with a motor.
    """
    require_positive("motor_stiffness", machine.motor_stiffness)
    unit = float(np.sqrt(machine.mass / machine.motor_stiffness))
    return Synergetic(
        machine, time * unit, time * unit, weight * unit**2, rate / unit**3, tilt_rate / unit**3
    )
