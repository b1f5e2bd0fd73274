"""Equations of motion of a rotor with balls that roll in races around its axis, and their energy."""

from __future__ import annotations

import numpy as np

from meshes.arrays import Array


def rates(
    time: float,
    state: Array,
    mass: Array,
    damping: Array,
    stiffness: Array,
    turning: Array,
    axes: Array,
    balls: Array,
    numbers: Array,
    out: Array,
) -> None:
    """Rates of change, the coupled accelerations solved for exactly [theory: balls, eq. 16-18].

    For the compiler. State: n coordinates, their rates, angles of the N balls, theirs, work done without what
    is stored, sum of the sizes of all work. `damping` is C + Omega G, `turning` real and imaginary part of
    the unbalance (2, n), `axes` the axis in each ball's plane for unit coordinates (N, 2, n), `balls` mass,
    radius, drag, rolling inertia (N, 4), `numbers` spin and gravity.
    """
    spin, gravity = numbers
    n, count = mass.shape[0], balls.shape[0]
    first, second, work = 2 * n, 2 * n + count, 2 * (n + count)
    cosine, sine = spin * spin * np.cos(spin * time), spin * spin * np.sin(spin * time)
    matrix = mass.copy()
    out[work:] = 0.0
    for i in range(n):
        push, drawn, held = turning[0, i] * cosine - turning[1, i] * sine, 0.0, 0.0
        for k in range(n):
            drawn += damping[i, k] * state[n + k]
            held += stiffness[i, k] * state[k]
        out[i], out[n + i] = state[n + i], push - drawn - held
        out[work] += (push - drawn) * state[n + i]
        out[work + 1] += abs(push * state[n + i])
    for j in range(count):
        weight, radius, drag, rolling = balls[j]
        rate, x, y = state[second + j], np.cos(state[first + j]), np.sin(state[first + j])
        slip = -drag * radius * radius * (rate - spin)
        torque, away = slip - weight * gravity * radius * x, weight * radius * rate * rate
        out[first + j], out[second + j] = rate, torque / (rolling * weight * radius * radius)
        out[work] += slip * rate
        out[work + 1] += abs(slip * rate)
        for i in range(n):
            # Parts of the race's motion outward and along the race.
            outward, along = x * axes[j, 0, i] + y * axes[j, 1, i], x * axes[j, 1, i] - y * axes[j, 0, i]
            out[n + i] += away * outward - torque / (rolling * radius) * along
            for k in range(n):
                matrix[i, k] += weight * outward * (x * axes[j, 0, k] + y * axes[j, 1, k])
                share = weight * (1.0 - 1.0 / rolling) * along
                matrix[i, k] += share * (x * axes[j, 1, k] - y * axes[j, 0, k])
    # Elimination as it stands: the library's solver takes the compiler ten seconds.
    for i in range(n):
        for k in range(i + 1, n):
            share = matrix[k, i] / matrix[i, i]
            out[n + k] -= share * out[n + i]
            for m in range(i, n):
                matrix[k, m] -= share * matrix[i, m]
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            out[n + i] -= matrix[i, k] * out[n + k]
        out[n + i] /= matrix[i, i]
    for j in range(count):
        x, y = np.cos(state[first + j]), np.sin(state[first + j])
        for i in range(n):
            along = x * axes[j, 1, i] - y * axes[j, 0, i]
            out[second + j] -= along * out[n + i] / (balls[j, 3] * balls[j, 1])


def energy(state: Array, mass: Array, stiffness: Array, axes: Array, balls: Array, gravity: float) -> float:
    """Kinetic and potential energy of rotor and balls [theory: balls, eq. 19].

    Arguments as of `rates`; J. The balls' own spin is in it up to a constant and a part in proportion to
    their speed, which a constant spin leaves out of every balance.
    """
    n, count = mass.shape[0], balls.shape[0]
    q, velocity = state[:n], state[n : 2 * n]
    angle, rate = state[2 * n : 2 * n + count], state[2 * n + count : 2 * (n + count)]
    weight, radius, rolling = balls[:, 0], balls[:, 1], balls[:, 3]
    carried = axes @ velocity
    x = carried[:, 0] - radius * rate * np.sin(angle)
    y = carried[:, 1] + radius * rate * np.cos(angle)
    own = (rolling - 1.0) * np.square(radius * rate)
    moving = 0.5 * velocity @ mass @ velocity + 0.5 * np.sum(weight * (x * x + y * y + own))
    lifted = gravity * np.sum(weight * radius * np.sin(angle))
    return float(moving + 0.5 * q @ stiffness @ q + lifted)
