"""The spin over a time step: given, or by a motor less what liquid and whirl take [theory: coupling]."""

from __future__ import annotations

from typing import Any

from solvers.layer.finite_volume import COMPILED
from solvers.layer.records import records
from solvers.layer.two_layers import STREAM, TAKEN
from solvers.machine_code import (
    BARE,
    HANDED,
    REAL,
    ROW,
    ROWS,
    TURNING,
    handed,
    handed_type,
    machine_code,
    type_of,
)
from solvers.runup.state import BALL, GAINS, LAYER, SHAFT
from solvers.runup.steps.balls import ball_turned

_part: Any = machine_code(**(COMPILED | BARE))
_handed: Any = machine_code(**(COMPILED | HANDED))


@_part
def motor_torque(curve, spin):
    """Torque at a speed, by straight lines between the points of the motor's curve."""
    last = curve.shape[1] - 1
    if spin <= curve[0, 0]:
        return curve[1, 0]
    for k in range(last):
        if spin <= curve[0, k + 1]:
            part = (spin - curve[0, k]) / (curve[0, k + 1] - curve[0, k])
            return curve[1, k] + part * (curve[1, k + 1] - curve[1, k])
    return curve[1, last]


@_part
def resisted(curve, weight, aim):
    """Where x + weight T(x) = aim, and the slope of T there, T by straight lines between points of a curve.

    With it a torque is that of the middle of a step, not of its beginning.
    """
    low, high = 0, curve.shape[1] - 1
    if aim <= curve[0, 0] + weight * curve[1, 0]:
        return aim - weight * curve[1, 0], 0.0
    if aim > curve[0, high] + weight * curve[1, high]:
        return aim - weight * curve[1, high], 0.0
    while high - low > 1:
        middle = (low + high) // 2
        if curve[0, middle] + weight * curve[1, middle] < aim:
            low = middle
        else:
            high = middle
    slope = (curve[1, high] - curve[1, low]) / (curve[0, high] - curve[0, low])
    return curve[0, low] + (aim - curve[0, low] - weight * curve[1, low]) / (1.0 + weight * slope), slope


@_part
def driven(curve, shaft, load, dt):
    """Spin at the end of a step under the motor's torque at the middle, however steep its curve.

    `load`: impulse of the torque of liquid and whirl on the drum.
    """
    weight = 0.5 / shaft.inertia
    middle, _ = resisted(curve, -dt * weight, shaft.spin - load * weight)
    return 2.0 * middle - shaft.spin


@_handed
def free_spin(
    curve,
    unbalance,
    layers,
    pools,
    balls,
    shaft,
    roll_rate,
    gains,
    taken,
    change,
    roll_change,
    held,
    spins,
    turn,
    dt,
):
    """Spin at the end of the step by the motor [theory: coupling, eq. 6]."""
    load = 0.0
    for i in range(change.size):
        along, across = unbalance[i].real, unbalance[i].imag
        load -= change[i] * 0.5 * (along * (turn[1] + turn[3]) + across * (turn[0] + turn[2]))
    for j in range(layers.shape[0]):
        load += layers[j].weight * layers[j].radius ** 4 * gains[j].torque
    for j in range(pools.shape[0]):
        load += pools[j].inertia * taken[j].torque
    for j in range(balls.shape[0]):
        load += ball_turned(balls[j], held[j], roll_rate[j], roll_change[j], spins, dt)
    return driven(curve, shaft, load, dt)


@_handed
def given_spin(
    curve,
    unbalance,
    layers,
    pools,
    balls,
    shaft,
    roll_rate,
    gains,
    taken,
    change,
    roll_change,
    held,
    spins,
    turn,
    dt,
):
    """Spin at the end of the step on its ramp."""
    return shaft.spin + shaft.rate * dt


@_handed
def motor_power(curve, spins):
    """Power of the motor at the middle of a step."""
    spin = 0.5 * (spins[0] + spins[1])
    return spin * motor_torque(curve, spin)


@_handed
def no_power(curve, spins):
    """Stands for `motor_power` where the spin is given."""
    return 0.0


# Of `free_spin` and of `motor_power`.
SPIN: Any = (
    handed_type(
        *(REAL, ROWS, TURNING, type_of(records(LAYER)), type_of(records(STREAM)), type_of(records(BALL))),
        *(type_of(records(SHAFT)[0]), ROW, type_of(records(GAINS)), type_of(records(TAKEN)), ROW, ROW, ROW),
        *(ROW, ROW, REAL),
    ),
    handed_type(REAL, ROWS, ROW),
)


def spin_of(free: bool) -> tuple[Any, Any]:
    """What moves a spin, free or given, handed over."""
    made = (free_spin, motor_power) if free else (given_spin, no_power)
    return handed(made[0], SPIN[0]), handed(made[1], SPIN[1])
