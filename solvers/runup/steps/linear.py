"""Rotor and linear layers through time by the trapezium, in SI units [theory: coupling, eq. 11-13]."""

from __future__ import annotations

from typing import Any

import numpy as np

from solvers.layer.drag import mean_rate
from solvers.layer.finite_volume import COMPILED
from solvers.layer.records import Outcome, records
from solvers.machine_code import BARE, BLOCKS, REAL, ROW, ROWS, TURNING, WHOLE, machine_code, type_of
from solvers.runup.state import BALL, CREST, LINEAR_LAYER, SHAFT, SUMS
from solvers.runup.steps.balls import BALLS, ball_turned
from solvers.runup.steps.coupled import AGREED, SHORTEST, load_rotor, solve, watch
from solvers.runup.steps.spin import driven, motor_torque

_jit: Any = machine_code(**COMPILED)
_part: Any = machine_code(**(COMPILED | BARE))


@_part
def _assemble(layer, b, active, gravity, row, n, spin, before, after, place, rate, dt, left, change):
    """Rows and columns of a layer from `row` on, `b` its axis' displacement [theory: coupling, eq. 11]."""
    mass, kappa = layer.mass, layer.curvature
    friction = layer.rate * spin**layer.power * (1.0 + kappa)
    whole = 0.5 * (before + after)
    for i in range(n):
        for k in range(n):
            left[i, k] += mass * (b[0, i] * b[0, k] + b[1, i] * b[1, k])
    for part in range(2):
        here, there, sign = row + part, row + 1 - part, 1.0 - 2.0 * part
        left[here, here] = 1.0
        change[here] = 0.0
        if active == 0.0:
            continue
        # Multiplication by -i takes (x, y) to (y, -x).
        coriolis, swirl = (
            4.0 * kappa * whole * sign,
            (whole * friction + 2.0 * kappa * (after - before) / dt) * sign,
        )
        centrifugal = -2.0 * kappa * whole * whole
        left[here, here] = mass * (1.0 + kappa + 0.5 * dt * friction + 0.25 * dt * dt * centrifugal)
        left[here, there] = mass * (0.5 * dt * coriolis + 0.25 * dt * dt * swirl)
        own, other = place[here] + 0.5 * dt * rate[here], place[there] + 0.5 * dt * rate[there]
        forces = friction * rate[here] + coriolis * rate[there] + centrifugal * own + swirl * other
        change[here] = dt * mass * (gravity[part] - forces)
        for i in range(n):
            left[here, i] = mass * b[part, i]
            left[i, here] = mass * b[part, i]


@_part
def _wall_drag(layer, table, spin, lag):
    """Rate of the friction of the walls on a layer as a whole, 1/s."""
    if layer.top == 0.0:
        return layer.whole * spin**layer.power
    rate, _ = mean_rate(table, layer.top, lag)
    return rate * layer.sides


@_part
def plate_drag(curve, spin, lag):
    """Rate at which smeared baffles take a lag away, 1/s [theory: baffles, eq. 13]."""
    last = curve.size - 1
    if last < 1:
        return 0.0
    place = min(last * lag / spin, 1.0 * last)
    k = min(int(place), last - 1)
    return lag * (curve[k] + (place - k) * (curve[k + 1] - curve[k]))


@_part
def _mean_drag(layer, table, curve, carried, spin, dt):
    """Rates of walls and of baffles on a layer at the middle of the step: at most they stop its lag."""
    lag = abs(spin - carried)
    first = _wall_drag(layer, table, spin, lag) + plate_drag(curve, spin, lag)
    lag /= 1.0 + 0.5 * dt * first
    wall, plates = _wall_drag(layer, table, spin, lag), plate_drag(curve, spin, lag)
    most = 1.0 / max(1.0, 0.5 * dt * (wall + plates))
    return most * wall, most * plates


@_part
def _carry(layer, table, curve, active, carried, spin, before, after, dt):
    """Rotation of a layer as a whole at the end of the step: walls and baffles take it to the drum's."""
    if active == 0.0:
        return after
    wall, plates = _mean_drag(layer, table, curve, carried, spin, dt)
    share = 0.5 * dt * (wall + plates)
    return (carried * (1.0 - share) + share * (before + after)) / (1.0 + share)


@_part
def _tally(layer, table, curve, gravity, row, carried, spin, after, place, rate, change, dt, sums):
    """Add a layer's works and heats over one step [theory: coupling, eq. 13]; `after`: its rotation then."""
    mass, kappa = layer.mass, layer.curvature
    slow, (held, blocked) = layer.rate * spin**layer.power, _mean_drag(layer, table, curve, carried, spin, dt)
    whole, gained = 0.5 * (carried + after), after - carried
    u, v = rate[row] + 0.5 * change[row], rate[row + 1] + 0.5 * change[row + 1]
    x, y = place[row] + 0.5 * dt * u, place[row + 1] + 0.5 * dt * v
    # Velocity relative to the liquid that turns as a whole.
    p, q = u + whole * y, v - whole * x
    drag = mass * slow * (1.0 + kappa)
    sums.friction += dt * (drag * (p * p + q * q) + layer.inertia * held * (spin - whole) ** 2)
    sums.baffles += dt * layer.inertia * blocked * (spin - whole) ** 2
    sums.drive -= dt * drag * whole * (x * q - y * p)
    sums.drive += 2.0 * mass * kappa * gained * (x * v - y * u - whole * (x * x + y * y))
    sums.drive += layer.inertia * spin * gained
    sums.gravity += dt * mass * (gravity[0] * u + gravity[1] * v)


# Rounds in which spin and load of a free drum are to agree: one after the other, then by secants.
_PLAIN, _SECANT = 6, 12


@_jit
def advance_linear(
    add_balls,
    tally_balls,
    matrices,
    unbalance,
    planes,
    layers,
    tables,
    plates,
    active,
    gravity,
    curve,
    watched,
    place,
    rate,
    shaft,
    carried,
    sums,
    crest,
    balls,
    races,
    left,
    change,
    swing,
    held,
    spins,
    turn,
    stop,
    angle_step,
    most,
):
    """Advance rotor and layers to a time, by at most `angle_step` rad a step, in at most so many steps.

    `add_balls` and `tally_balls`: see `solvers.runup.steps.balls`; then come the fields of `LinearMachine`.
    Outcome.DONE, RAN_OUT, STOPPED where the motor stands, or NOT_COUPLED where its load grows without bound.
    """
    shaft, sums, crest, taken, share = shaft[0], sums[0], crest[0], 0, 1.0
    none = left[:0]  # liquid that has no momentum of its own
    n, rows, free = unbalance.size, unbalance.size + 2 * layers.shape[0], curve.shape[1] > 0
    while shaft.time < stop:
        before = shaft.spin
        if before <= 0.0:
            return Outcome.STOPPED + 0
        if taken >= most:
            return Outcome.RAN_OUT + 0
        taken += 1
        remaining = stop - shaft.time
        dt = min(share * angle_step / before, remaining)
        if remaining > dt > 0.5 * remaining:
            dt = 0.5 * remaining
        after = before + (0.0 if free else shaft.rate * dt)
        rounds, guess, found, spin = _PLAIN + _SECANT if free else 1, after, after, before
        for tried in range(rounds):
            spin = 0.5 * (before + after)
            turned = shaft.angle + spin * dt
            turn[0], turn[1], turn[2], turn[3] = (
                np.cos(shaft.angle),
                np.sin(shaft.angle),
                np.cos(turned),
                np.sin(turned),
            )
            spins[0], spins[1] = before, after
            load_rotor(
                *(matrices, unbalance, planes[:0], carried, place, rate, none, none, none, none, spins, turn),
                *(dt, swing, left, change),
            )
            for j in range(layers.shape[0]):
                layer, table, lost, row = layers[j], tables[j], plates[j], n + 2 * j
                turning = _carry(layer, table, lost, active[j], carried[j], spin, before, after, dt)
                _assemble(
                    *(
                        layer,
                        planes[j],
                        active[j],
                        gravity,
                        row,
                        n,
                        spin,
                        carried[j],
                        turning,
                        place,
                        rate,
                        dt,
                    ),
                    *(left, change),
                )
            add_balls(
                balls, races, gravity, rows, place[rows:], rate[rows:], spins, dt, n, left, change, held
            )
            solve(left, change)
            if free:
                load = 0.0
                for i in range(n):
                    along, across = unbalance[i].real, unbalance[i].imag
                    load -= change[i] * 0.5 * (along * (turn[1] + turn[3]) + across * (turn[0] + turn[2]))
                for j in range(layers.shape[0]):
                    turning = _carry(
                        layers[j], tables[j], plates[j], active[j], carried[j], spin, before, after, dt
                    )
                    load += layers[j].inertia * (turning - carried[j]) * active[j]
                for j in range(balls.shape[0]):
                    row = rows + j
                    load += ball_turned(balls[j], held[j], rate[row], change[row], spins, dt)
                last_guess, last_found = guess, found
                guess, found = after, driven(curve, shaft, load, dt)
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
                return (Outcome.STOPPED if after <= 0.0 else Outcome.NOT_COUPLED) + 0
            share *= 0.5
            continue
        share = min(1.0, 1.5 * share)
        for i in range(n):
            mean = rate[i] + 0.5 * change[i]
            sums.unbalance -= swing[i] * mean
            for k in range(n):
                sums.support += dt * mean * matrices[1, i, k] * (rate[k] + 0.5 * change[k])
        for j in range(layers.shape[0]):
            layer, table, lost = layers[j], tables[j], plates[j]
            turning = _carry(layer, table, lost, active[j], carried[j], spin, before, spins[1], dt)
            if active[j] > 0.0:
                _tally(
                    *(layer, table, lost, gravity, n + 2 * j, carried[j], spin, turning, place, rate, change),
                    *(dt, sums),
                )
            carried[j] = turning
        tally_balls(balls, held, gravity, rows, place, rate, change, spins, dt, sums)
        if free:
            sums.motor += dt * spin * motor_torque(curve, spin)
        for i in range(change.size):
            place[i] += dt * (rate[i] + 0.5 * change[i])
            rate[i] += change[i]
        shaft.spin, shaft.angle = spins[1], shaft.angle + spin * dt
        shaft.time = stop if dt == remaining else shaft.time + dt
        sums.steps += 1.0
        watch(watched, place, shaft, crest)
    return Outcome.DONE + 0


# Of `advance_linear`.
ADVANCE_LINEAR: Any = (
    *(*BALLS, BLOCKS, TURNING, BLOCKS, type_of(records(LINEAR_LAYER)), BLOCKS, ROWS, ROW, ROW, ROWS, ROWS),
    *(ROW, ROW, type_of(records(SHAFT)), ROW, type_of(records(SUMS)), type_of(records(CREST))),
    *(type_of(records(BALL)), BLOCKS, ROWS, ROW, ROW, ROW, ROW, ROW, REAL, REAL, WHOLE),
)
