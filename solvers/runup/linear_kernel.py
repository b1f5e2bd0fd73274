"""Rotor and linear layers through time by the trapezium, in SI units [theory: coupling, eq. 11-13]."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array
from solvers.layer.drag import mean_rate
from solvers.layer.finite_volume import COMPILED
from solvers.layer.records import Outcome, Record, floats
from solvers.machine_code import machine_code
from solvers.runup.kernel import (
    AGREED,
    SHORTEST,
    add_ball,
    ball_turned,
    driven,
    motor_torque,
    solve,
    tally_ball,
    watch,
)

_jit: Any = machine_code(**COMPILED)

# Of a layer: mass, curvature, friction rate of its waves and of it as a whole, power of the spin that they go
# with, moment of inertia; under the law of the wall last velocity of its table, R/h + 2 R/h_c, otherwise 0
# both.
LINEAR_LAYER = floats("mass", "curvature", "rate", "whole", "power", "inertia", "top", "sides")


class LinearMachine(NamedTuple):
    """Rotor, l linear layers and b balls; n coordinates, N = n + 2 l + b."""

    matrices: Array  #: M, C, G, K of the rotor, shape (4, n, n)
    unbalance: NDArray[np.complex128]  #: U, complex, shape (n,)
    planes: Array  #: displacement of each layer's axis for unit coordinates, shape (l, 2, n)
    layers: Record  #: records LINEAR_LAYER, shape (l,)
    tables: Array  #: of the law of the wall, shape (l, m, 2); m = 0 under other laws
    #: smeared baffles, zeta N r_m/(4 pi R) at lags that rise evenly from 0 to the spin, shape (l, p); p = 0
    #: where no layer has any
    plates: Array
    active: Array  #: 1 for a layer, 0 for liquid that lies at the bottom or is solid, shape (l,)
    gravity: Array  #: across the axis, shape (2,)
    curve: Array  #: the motor's, shape (2, k)
    watched: Array  #: displacement of the axis whose amplitude counts, for unit coordinates, shape (2, n)
    #: place and rate: rotor's coordinates, the layers' offsets, two parts each, and the balls' angles in the
    #: standing frame, and their rates, shape (N,)
    place: Array
    rate: Array
    shaft: Record  #: record SHAFT of `solvers.runup.state`, shape (1,)
    carried: Array  #: rotation of each layer as a whole, rad/s, shape (l,)
    sums: Record  #: record SUMS, shape (1,)
    crest: Record  #: record CREST of `solvers.runup.state`, shape (1,)
    #: balls and races: as in `solvers.runup.state.Machine`, shapes (b,) and (b, 2, n)
    balls: Record
    races: Array
    #: left, change, swing and held: scratch, shapes (N, N), (N,), (n,), (b,)
    left: Array
    change: Array
    swing: Array
    held: Array


@_jit
def _assemble(m, j, spin, before, after, dt):
    """Rows and columns of a layer [theory: coupling, eq. 11]."""
    n = m.unbalance.size
    layer, b = m.layers[j], m.planes[j]
    mass, kappa = layer.mass, layer.curvature
    friction = layer.rate * spin**layer.power * (1.0 + kappa)
    whole = 0.5 * (before + after)
    for i in range(n):
        for k in range(n):
            m.left[i, k] += mass * (b[0, i] * b[0, k] + b[1, i] * b[1, k])
    for part in range(2):
        row = n + 2 * j + part
        m.left[row, row] = 1.0
        m.change[row] = 0.0
    if m.active[j] == 0.0:
        return
    for part in range(2):
        row = n + 2 * j + part
        other, sign = n + 2 * j + 1 - part, 1.0 - 2.0 * part
        # Multiplication by -i takes (x, y) to (y, -x).
        coriolis, swirl = (
            4.0 * kappa * whole * sign,
            (whole * friction + 2.0 * kappa * (after - before) / dt) * sign,
        )
        centrifugal = -2.0 * kappa * whole * whole
        m.left[row, row] = mass * (1.0 + kappa + 0.5 * dt * friction + 0.25 * dt * dt * centrifugal)
        m.left[row, other] = mass * (0.5 * dt * coriolis + 0.25 * dt * dt * swirl)
        here, there = m.place[row] + 0.5 * dt * m.rate[row], m.place[other] + 0.5 * dt * m.rate[other]
        forces = friction * m.rate[row] + coriolis * m.rate[other] + centrifugal * here + swirl * there
        m.change[row] = dt * mass * (m.gravity[part] - forces)
        for i in range(n):
            m.left[row, i] = mass * b[part, i]
            m.left[i, row] = mass * b[part, i]


@_jit
def _rotor_rows(m, spin, first, last, spins, dt):
    """Rows of the rotor, as in the nonlinear step [theory: coupling, eq. 5]."""
    n = m.unbalance.size
    for i in range(n):
        m.swing[i] = spins[0] * (m.unbalance[i] * first).imag - spins[1] * (m.unbalance[i] * last).imag
        m.change[i] = -m.swing[i]
        for k in range(n):
            damping = m.matrices[1, i, k] + spin * m.matrices[2, i, k]
            stiffness = m.matrices[3, i, k]
            m.left[i, k] = m.matrices[0, i, k] + 0.5 * dt * damping + 0.25 * dt * dt * stiffness
            m.change[i] -= dt * (damping * m.rate[k] + stiffness * (m.place[k] + 0.5 * dt * m.rate[k]))


@_jit
def _wall_drag(m, j, spin, lag):
    """Rate of the friction of the walls on a layer as a whole, 1/s."""
    layer = m.layers[j]
    if layer.top == 0.0:
        return layer.whole * spin**layer.power
    rate, _ = mean_rate(m.tables[j], layer.top, lag)
    return rate * layer.sides


@_jit
def plate_drag(curve, spin, lag):
    """Rate at which smeared baffles take a lag away, 1/s [theory: baffles, eq. 13]."""
    last = curve.size - 1
    if last < 1:
        return 0.0
    place = min(last * lag / spin, 1.0 * last)
    k = min(int(place), last - 1)
    return lag * (curve[k] + (place - k) * (curve[k + 1] - curve[k]))


@_jit
def _mean_drag(m, j, spin, dt):
    """Rates of walls and of baffles on a layer at the middle of the step: at most they stop its lag."""
    lag = abs(spin - m.carried[j])
    first = _wall_drag(m, j, spin, lag) + plate_drag(m.plates[j], spin, lag)
    lag /= 1.0 + 0.5 * dt * first
    wall, plates = _wall_drag(m, j, spin, lag), plate_drag(m.plates[j], spin, lag)
    most = 1.0 / max(1.0, 0.5 * dt * (wall + plates))
    return most * wall, most * plates


@_jit
def _carry(m, j, spin, spins, dt):
    """Rotation of a layer as a whole at the end of the step: walls and baffles take it to the drum's."""
    if m.active[j] == 0.0:
        return spins[1]
    wall, plates = _mean_drag(m, j, spin, dt)
    share = 0.5 * dt * (wall + plates)
    return (m.carried[j] * (1.0 - share) + share * (spins[0] + spins[1])) / (1.0 + share)


@_jit
def _tally(m, spin, spins, dt):
    """Add one step's works and heats, then make its end the state [theory: coupling, eq. 13]."""
    n, sums = m.unbalance.size, m.sums[0]
    for i in range(n):
        mean = m.rate[i] + 0.5 * m.change[i]
        sums.unbalance -= m.swing[i] * mean
        for k in range(n):
            sums.support += dt * mean * m.matrices[1, i, k] * (m.rate[k] + 0.5 * m.change[k])
    for j in range(m.layers.shape[0]):
        row = n + 2 * j
        if m.active[j] == 0.0:
            continue
        layer = m.layers[j]
        mass, kappa = layer.mass, layer.curvature
        rate, (held, blocked) = layer.rate * spin**layer.power, _mean_drag(m, j, spin, dt)
        after = _carry(m, j, spin, spins, dt)
        whole, gained = 0.5 * (m.carried[j] + after), after - m.carried[j]
        u, v = m.rate[row] + 0.5 * m.change[row], m.rate[row + 1] + 0.5 * m.change[row + 1]
        x, y = m.place[row] + 0.5 * dt * u, m.place[row + 1] + 0.5 * dt * v
        # Velocity relative to the liquid that turns as a whole.
        p, q = u + whole * y, v - whole * x
        drag = mass * rate * (1.0 + kappa)
        sums.friction += dt * (drag * (p * p + q * q) + layer.inertia * held * (spin - whole) ** 2)
        sums.baffles += dt * layer.inertia * blocked * (spin - whole) ** 2
        sums.drive -= dt * drag * whole * (x * q - y * p)
        sums.drive += 2.0 * mass * kappa * gained * (x * v - y * u - whole * (x * x + y * y))
        sums.drive += layer.inertia * spin * gained
        sums.gravity += dt * mass * (m.gravity[0] * u + m.gravity[1] * v)
    for j in range(m.balls.shape[0]):
        row = n + 2 * m.layers.shape[0] + j
        moving = m.place[row], m.rate[row]
        tally_ball(m.balls[j], m.held[j], m.gravity, moving, m.change[row], spins, dt, sums)
    if m.curve.shape[1] > 0:
        sums.motor += dt * spin * motor_torque(m.curve, spin)


# Rounds in which spin and load of a free drum are to agree: one after the other, then by secants.
_PLAIN, _SECANT = 6, 12


@_jit
def advance_linear(m, stop, angle_step, most):
    """Advance rotor and layers to a time, by at most `angle_step` rad a step, in at most so many steps.

    Outcome.DONE, RAN_OUT, STOPPED where the motor stands, or NOT_COUPLED where its load grows without bound.
    """
    n, spins, taken, shaft, share = m.unbalance.size, (0.0, 0.0), 0, m.shaft[0], 1.0
    balls = n + 2 * m.layers.shape[0]
    while shaft.time < stop:
        before = shaft.spin
        if before <= 0.0:
            return Outcome.STOPPED
        if taken >= most:
            return Outcome.RAN_OUT
        taken += 1
        left = stop - shaft.time
        dt = min(share * angle_step / before, left)
        if left > dt > 0.5 * left:
            dt = 0.5 * left
        after = before + (shaft.rate * dt if m.curve.shape[1] == 0 else 0.0)
        rounds, guess, found = 1 if m.curve.shape[1] == 0 else _PLAIN + _SECANT, after, after
        for tried in range(rounds):
            spin = 0.5 * (before + after)
            first = complex(np.cos(shaft.angle), np.sin(shaft.angle))
            turned = shaft.angle + spin * dt
            last = complex(np.cos(turned), np.sin(turned))
            spins = (before, after)
            for i in range(m.change.size):
                for k in range(m.change.size):
                    m.left[i, k] = 0.0
            _rotor_rows(m, spin, first, last, spins, dt)
            for j in range(m.layers.shape[0]):
                _assemble(m, j, spin, m.carried[j], _carry(m, j, spin, spins, dt), dt)
            for j in range(m.balls.shape[0]):
                row, ball, b = balls + j, m.balls[j], m.races[j]
                moving = m.place[row], m.rate[row]
                m.held[j] = add_ball(ball, b, m.gravity, row, moving, spins, dt, n, m.left, m.change)
            solve(m.left, m.change)
            if m.curve.shape[1] > 0:
                load = 0.0
                for i in range(n):
                    load -= m.change[i] * (0.5 * m.unbalance[i] * (first + last)).imag
                for j in range(m.layers.shape[0]):
                    gained = _carry(m, j, spin, spins, dt) - m.carried[j]
                    load += m.layers[j].inertia * gained * m.active[j]
                for j in range(m.balls.shape[0]):
                    rate, change = m.rate[balls + j], m.change[balls + j]
                    load += ball_turned(m.balls[j], m.held[j], rate, change, spins, dt)
                last_guess, last_found = guess, found
                guess, found = after, driven(m.curve, shaft, load, dt)
                after = found
                if tried + 1 < _PLAIN:
                    continue
                if abs(found - guess) <= AGREED * before or guess == last_guess:
                    break
                # Liquid that clings to a drum as light as itself answers the spin as strongly as it does.
                slope = (found - last_found) / (guess - last_guess)
                if tried + 1 < rounds and slope < 0.9:
                    after = guess + (found - guess) / (1.0 - slope)
        if after <= 0.0 or abs(after - spins[1]) > AGREED * before:
            # A long step turns the drum round where a shorter one slows it down.
            if share <= SHORTEST:
                return Outcome.STOPPED if after <= 0.0 else Outcome.NOT_COUPLED
            share *= 0.5
            continue
        share = min(1.0, 1.5 * share)
        _tally(m, spin, spins, dt)
        for j in range(m.layers.shape[0]):
            m.carried[j] = _carry(m, j, spin, spins, dt)
        for i in range(m.change.size):
            m.place[i] += dt * (m.rate[i] + 0.5 * m.change[i])
            m.rate[i] += m.change[i]
        shaft.spin, shaft.angle = spins[1], shaft.angle + spin * dt
        shaft.time = stop if dt == left else shaft.time + dt
        m.sums[0].steps += 1.0
        watch(m.watched, m.place, shaft, m.crest[0])
    return Outcome.DONE
