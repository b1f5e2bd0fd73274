"""Balls through a time step of the rotor that carries their races [theory: races, eq. 1-3]."""

from __future__ import annotations

from typing import Any

import numpy as np

from solvers.layer.finite_volume import COMPILED
from solvers.layer.records import records
from solvers.machine_code import (
    BARE,
    BLOCKS,
    HANDED,
    NOTHING,
    REAL,
    ROW,
    ROWS,
    WHOLE,
    handed,
    handed_type,
    machine_code,
    type_of,
)
from solvers.runup.state import BALL, SUMS

_handed: Any = machine_code(**(COMPILED | HANDED))
_unwrapped: Any = machine_code(**(COMPILED | BARE))

# Share of the spin by which a ball that sticks may creep.
_CREEP = 1e-5


@_unwrapped
def add_ball(ball, b, gravity, row, moving, spins, dt, n, left, right):
    """Row and column of a ball, on a straight line about its way so far [theory: races, eq. 2-3].

    `b`: displacement of the axis in its plane for unit coordinates; `row`: its own equation; `moving`: its
    angle in the standing frame and its rate. Returns its rolling resistance as a drag.
    """
    angle, rate = moving
    spin, gained = 0.5 * (spins[0] + spins[1]), spins[1] - spins[0]
    lever, middle, last = ball.mass * ball.radius, angle + 0.5 * dt * rate, angle + dt * rate
    x, y, x_end, y_end = np.cos(middle), np.sin(middle), np.cos(last), np.sin(last)
    past = spin - rate
    # It sticks by a drag that is large beside all others while the drum hardly passes it.
    press = ball.resistance * ball.mass * (ball.radius * rate) ** 2
    held = press / max(abs(past), _CREEP * spin)
    pull = lever * (gravity[1] * x - gravity[0] * y)
    left[row, row] = ball.inertia + dt * (0.5 * ball.drag + held)
    right[row] = dt * (ball.drag * past + held * (spins[1] - rate) + pull)
    right[row] += ball.carried * gained
    # Its momentum at the end, had it kept its rate, and how that changes with the rate.
    given_x, given_y = -lever * rate * (y_end - np.sin(angle)), lever * rate * (x_end - np.cos(angle))
    slope_x = -lever * (y_end + 0.5 * dt * rate * x_end)
    slope_y = lever * (x_end - 0.5 * dt * rate * y_end)
    for i in range(n):
        left[row, i] = lever * (b[1, i] * x - b[0, i] * y)
        left[i, row] = b[0, i] * slope_x + b[1, i] * slope_y
        right[i] -= b[0, i] * given_x + b[1, i] * given_y
        for k in range(n):
            left[i, k] += ball.mass * (b[0, i] * b[0, k] + b[1, i] * b[1, k])
    return held


@_unwrapped
def ball_dragged(ball, held, rate, change, spins, dt):
    """Impulse of the torque of the drum on a ball, by drag and by what it resists to rolling.

    `held` as from `add_ball`; `change` of the ball's rate over the step.
    """
    slow = 0.5 * (spins[0] + spins[1]) - rate - 0.5 * change
    return dt * (ball.drag * slow + held * (spins[1] - rate - change))


@_unwrapped
def ball_turned(ball, held, rate, change, spins, dt):
    """Impulse of the torque that a ball takes from the drum [theory: races, eq. 1]."""
    gained = spins[1] - spins[0]
    return ball_dragged(ball, held, rate, change, spins, dt) + ball.driven * gained - ball.carried * change


@_unwrapped
def tally_ball(ball, held, gravity, moving, change, spins, dt, sums):
    """Add the works of one step of a ball to `sums`, a record SUMS."""
    angle, rate = moving
    spin, mean, middle = 0.5 * (spins[0] + spins[1]), rate + 0.5 * change, angle + 0.5 * dt * rate
    sums.drive += spin * ball_turned(ball, held, rate, change, spins, dt)
    # A ball that stops slipping within the step resists as at its end: that is no heat below zero.
    sums.friction += max((spin - mean) * ball_dragged(ball, held, rate, change, spins, dt), 0.0)
    pull = gravity[1] * np.cos(middle) - gravity[0] * np.sin(middle)
    sums.gravity += dt * ball.mass * ball.radius * mean * pull


@_handed
def add_balls(balls, races, gravity, first, roll, roll_rate, spins, dt, n, left, right, held):
    """Rows and columns of all balls from row `first` on, and their rolling resistance `held`."""
    for j in range(balls.shape[0]):
        moving = roll[j], roll_rate[j]
        held[j] = add_ball(balls[j], races[j], gravity, first + j, moving, spins, dt, n, left, right)


@_handed
def no_balls(balls, races, gravity, first, roll, roll_rate, spins, dt, n, left, right, held):
    """Stands for `add_balls` where there are none."""


@_handed
def tally_balls(balls, held, gravity, first, roll, roll_rate, change, spins, dt, sums):
    """Add the works of one step of all balls, which stand from `first` on, to `sums`, a record SUMS."""
    for j in range(balls.shape[0]):
        k = first + j
        tally_ball(balls[j], held[j], gravity, (roll[k], roll_rate[k]), change[k], spins, dt, sums)


@_handed
def tally_no_balls(balls, held, gravity, first, roll, roll_rate, change, spins, dt, sums):
    """Stands for `tally_balls` where there are none."""


_BALLS = type_of(records(BALL))
# Of `add_balls` and of `tally_balls`.
BALLS: Any = (
    handed_type(NOTHING, _BALLS, BLOCKS, ROW, WHOLE, ROW, ROW, ROW, REAL, WHOLE, ROWS, ROW, ROW),
    handed_type(NOTHING, _BALLS, ROW, ROW, WHOLE, ROW, ROW, ROW, ROW, REAL, type_of(records(SUMS)[0])),
)


def balls_of(count: int) -> tuple[Any, Any]:
    """What moves so many balls, handed over."""
    made = (add_balls, tally_balls) if count else (no_balls, tally_no_balls)
    return handed(made[0], BALLS[0]), handed(made[1], BALLS[1])
