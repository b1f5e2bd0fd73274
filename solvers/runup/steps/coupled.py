"""Rotor and liquid layers through time together [theory: coupling].

Each step looks for the mean acceleration of every chamber's axis that makes the layers' change of momentum
and the rotor's trapezium agree: momentum is exchanged to rounding, and the rotor's part is stable for any
stiffness. SI units; layers over their wall radius.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from fluid.friction.laws import STOKES, WALL
from solvers.layer.drag import FRICTION
from solvers.layer.finite_volume import COMPILED, RATES
from solvers.layer.finite_volume import most as most_of
from solvers.layer.inside import SLOT_SPEED
from solvers.layer.records import Outcome, records
from solvers.layer.step import copy
from solvers.layer.two_layers import FLOWS, STREAM, TAKEN
from solvers.machine_code import (
    BARE,
    BLOCKS,
    FLAG,
    REAL,
    ROW,
    ROWS,
    TURNING,
    WHOLE,
    machine_code,
    type_of,
)
from solvers.runup.state import BALL, CREST, GAINS, LAYER, MEASURES, PACE, SHAFT, SUMS
from solvers.runup.steps.balls import BALLS
from solvers.runup.steps.layer import (
    LAYER_STEP,
    flow_inertia,
    measure,
    measure_profile,
    relative_momentum,
)
from solvers.runup.steps.pools import POOLS
from solvers.runup.steps.spin import SPIN

_jit: Any = machine_code(**COMPILED)
_unwrapped: Any = machine_code(**(COMPILED | BARE))


@_unwrapped
def solve(matrix, right):
    """Solve a small dense system in place by elimination with pivots."""
    n = right.size
    for k in range(n):
        best = k
        for i in range(k + 1, n):
            if abs(matrix[i, k]) > abs(matrix[best, k]):
                best = i
        if best != k:
            for j in range(n):
                matrix[k, j], matrix[best, j] = matrix[best, j], matrix[k, j]
            right[k], right[best] = right[best], right[k]
        for i in range(k + 1, n):
            factor = matrix[i, k] / matrix[k, k]
            for j in range(k, n):
                matrix[i, j] -= factor * matrix[k, j]
            right[i] -= factor * right[k]
    for k in range(n - 1, -1, -1):
        for j in range(k + 1, n):
            right[k] -= matrix[k, j] * right[j]
        right[k] /= matrix[k, k]


# A step is done once two estimates of the mean accelerations differ by this, relative to the largest. Where
# the drying edge of a layer makes them jump, the guess follows by shares after some rounds; after the last
# the step is shortened, and a short one may pass with what is left. Momentum is handed over all the same.
AGREED, PASSABLE, STRAIGHT, ROUNDS, SHORT = 1e-6, 1e-2, 3, 16, 1.0 / 32.0
# The force of a pool jumps where cells run dry: beside one, steps as short as this pass with so much left.
_TINY, _PASSABLE_POOL = 1.0 / 256.0, 0.2
# Steps this short that do not agree end the run: a layer on its way through the axis.
SHORTEST = 1.0 / 1024.0
# Momentum of a pool that jumps at a cell is no acceleration: the shortest steps pass with so much of a
# difference in velocity.
_JUMP = 3e-4
# A layer of this area, whose surface is nearer to the axis than to the wall, is none where it does not agree.
PILED = 0.375
# Steps shortened by more than this no longer follow what the layers do.
LEAST = 1e-6
# What steps may be longer by to fill a stretch with a whole number of them.
FILLS = 1.0 + 1e-9
# Longest step beside a pool, over the time in which it swings by a radian.
_SWING = 0.25


@_unwrapped
def _measure_layers(
    layers, spins, turn, angles, plates, area, momentum, spare, begin, end, before, after, inertia
):
    """The layers' momenta at both ends of the step, and the inertia of their flows."""
    cosine, sine = 0.5 * (turn[0] + turn[2]), 0.5 * (turn[1] + turn[3])
    size = np.hypot(cosine, sine)
    for j in range(layers.shape[0]):
        layer = layers[j]
        # Their steps have left the profiles at the end.
        measure_profile(area[j], momentum[j], spins[1], angles, plates[j], spare[j], end[j])
        relative_momentum(begin[j], layer, spins[0], turn[0], turn[1], before[j])
        relative_momentum(end[j], layer, spins[1], turn[2], turn[3], after[j])
        flow_inertia(begin[j], layer, cosine / size, sine / size, inertia[j])


@_unwrapped
def load_rotor(
    matrices,
    unbalance,
    planes,
    masses,
    place,
    rate,
    inertia,
    before,
    after,
    guess,
    spins,
    turn,
    dt,
    swing,
    left,
    right,
):
    """Matrix and loads of the rotor's equations over the step, given the layers' momenta.

    Theory: coupling, eq. 5.
    """
    n, spin = swing.size, 0.5 * (spins[0] + spins[1])
    for i in range(right.size):
        right[i] = 0.0
        for k in range(right.size):
            left[i, k] = 0.0
    for i in range(n):
        along, across = unbalance[i].real, unbalance[i].imag
        first, last = along * turn[1] + across * turn[0], along * turn[3] + across * turn[2]
        swing[i] = spins[0] * first - spins[1] * last
        right[i] = -swing[i]
        for k in range(n):
            damping = matrices[1, i, k] + spin * matrices[2, i, k]
            stiffness = matrices[3, i, k]
            left[i, k] = matrices[0, i, k] + 0.5 * dt * damping + 0.25 * dt * dt * stiffness
            x, v = place[k], rate[k]
            right[i] -= dt * (damping * v + stiffness * (x + 0.5 * dt * v))
    for j in range(planes.shape[0]):
        mass, b = masses[j], planes[j]
        xx, xy, yy = inertia[j, 0], inertia[j, 1], inertia[j, 2]
        given_x = after[j, 0] - before[j, 0] + dt * (xx * guess[j, 0] + xy * guess[j, 1])
        given_y = after[j, 1] - before[j, 1] + dt * (xy * guess[j, 0] + yy * guess[j, 1])
        for i in range(n):
            right[i] -= b[0, i] * given_x + b[1, i] * given_y
            for k in range(n):
                left[i, k] += (mass - xx) * b[0, i] * b[0, k] + (mass - yy) * b[1, i] * b[1, k]
                left[i, k] -= xy * (b[0, i] * b[1, k] + b[1, i] * b[0, k])


@_unwrapped
def _disagreement(planes, layers, gravity, spin, change, guess, dt, found):
    """Mean accelerations that the rotor's change means; their distance from the guess, and their size."""
    gap, size, first = 0.0, 0.0, layers.shape[0]
    for j in range(planes.shape[0]):
        reach = layers[j].radius if j < first else 0.0
        for i in range(2):
            total = 0.0
            for k in range(change.size):
                total += planes[j, i, k] * change[k]
            found[j, i] = total / dt
            gap = max(gap, abs(found[j, i] - guess[j, i]))
            # Edges of a pool that run dry make its force jump: beside its weight that is nothing.
            least = 1e-6 * spin * spin * reach if j < first else abs(gravity[0])
            size = max(size, abs(found[j, i]), least)
    return gap, size


@_unwrapped
def _lowered(gravity, layer, begin, end, turn):
    """Work of gravity on a layer over a step: its weight on the way of its centre of mass."""
    x = end.moment_x * turn[2] - end.moment_y * turn[3] - begin.moment_x * turn[0] + begin.moment_y * turn[1]
    y = end.moment_x * turn[3] + end.moment_y * turn[2] - begin.moment_x * turn[1] - begin.moment_y * turn[0]
    return layer.weight * layer.radius**3 * (gravity[0] * x + gravity[1] * y)


@_unwrapped
def _tally(matrices, layers, gravity, rate, change, swing, begin, end, gains, turn, dt, sums):
    """Add one step's work and losses of rotor and layers [theory: coupling, eq. 9-10]."""
    n = change.size
    for i in range(n):
        mean = rate[i] + 0.5 * change[i]
        sums.unbalance -= swing[i] * mean
        for k in range(n):
            sums.support += dt * mean * matrices[1, i, k] * (rate[k] + 0.5 * change[k])
    for j in range(layers.shape[0]):
        layer, gain = layers[j], gains[j]
        scale = layer.weight * layer.radius**4
        sums.drive += scale * gain.work
        sums.gravity += _lowered(gravity, layer, begin[j], end[j], turn)
        sums.friction += scale * gain.heat
        sums.lost += scale * gain.loss
        sums.baffles += scale * gain.baffles
        sums.profile += scale * gain.missed


@_unwrapped
def _relaxed(guess, found, miss, share):
    """Share of what the accelerations miss by that the guess follows next, by Aitken's rule for vectors."""
    along, size = 0.0, 0.0
    for j in range(guess.shape[0]):
        for i in range(2):
            change = found[j, i] - guess[j, i] - miss[j, i]
            along += miss[j, i] * change
            size += change * change
    return min(max(-share * along / (size + 1e-300), -1.0), 1.0)


@_unwrapped
def _apart(pools, layers, gravity, guess, found, dt):
    """Velocity by which what rotor and pools found is apart from what they were given, over sqrt(g R).

    Beside layers that is no measure: one that does not agree in the shortest steps is thrown off its wall.
    """
    gap, heavy = 0.0, abs(gravity[0])
    for j in range(pools.shape[0]):
        for i in range(2):
            apart = dt * abs(found[j, i] - guess[j, i])
            gap = max(gap, apart / np.sqrt(heavy * pools[j].radius))
    return gap if layers.shape[0] == 0 else np.inf


@_unwrapped
def watch(plane, place, shaft, crest):
    """Keep the amplitude of a plane in `crest`, a record CREST, with speed and time, if it is the largest."""
    x, y = 0.0, 0.0
    for i in range(plane.shape[1]):
        x += plane[0, i] * place[i]
        y += plane[1, i] * place[i]
    amplitude = np.hypot(x, y)
    if amplitude > crest.amplitude:
        crest.amplitude, crest.speed, crest.time = amplitude, shaft.spin, shaft.time


@_unwrapped
def swing_time(pools, gravity):
    """Longest step that follows the pools' swinging, s."""
    longest = np.inf
    for j in range(pools.shape[0]):
        longest = min(longest, _SWING * np.sqrt(pools[j].radius / abs(gravity[0])))
    return longest


@_unwrapped
def expect(push, pace, shaft, dt, guess):
    """Mean accelerations of a step to come: seen from the drum, on a parabola through the last three steps'.

    In a drum that turns steadily what goes round with it stands still.
    """
    here, back = 0.5 * dt, 0.5 * pace.last
    first = back + 0.5 * (pace.last + pace.before)
    second = first + 0.5 * (pace.before + pace.older)
    # No farther ahead than two steps like the last.
    ahead = min(here, 2.0 * (first - back) - back)
    linear = (ahead + back) / max(first - back, 1e-300)
    bend = linear * (ahead + first) / max(second - back, 1e-300)
    curve = bend * (first - back) / max(second - first, 1e-300)
    if pace.older <= 0.0:
        bend, curve = 0.0, 0.0
    if pace.before <= 0.0:
        linear = 0.0
    for j in range(guess.shape[0]):
        guess[j, 0], guess[j, 1] = 0.0, 0.0
    for k in range(3):
        time = back if k == 0 else (first if k == 1 else second)
        weight = 1.0 + linear + bend if k == 0 else (-linear - bend - curve if k == 1 else curve)
        turned = shaft.spin * (here + time) + 0.5 * shaft.rate * (here - time) * (here + time)
        cosine, sine = weight * np.cos(turned), weight * np.sin(turned)
        for j in range(guess.shape[0]):
            guess[j, 0] += push[j, k, 0] * cosine - push[j, k, 1] * sine
            guess[j, 1] += push[j, k, 0] * sine + push[j, k, 1] * cosine


@_jit
def advance(
    rates,
    friction,
    layer_step,
    begin_pools,
    move_pools,
    tally_pools,
    add_balls,
    tally_balls,
    spin_after,
    motor_power,
    matrices,
    unbalance,
    planes,
    masses,
    layers,
    pools,
    pool_tables,
    tables,
    gravity,
    angles,
    curve,
    watched,
    plates,
    gaps,
    balls,
    races,
    place,
    rate,
    shaft,
    area,
    momentum,
    rolling,
    two_layers,
    rings,
    push,
    pace,
    sums,
    crest,
    trace,
    roll,
    roll_rate,
    kept_area,
    kept_momentum,
    kept_rolling,
    kept_pools,
    taken,
    first,
    last,
    work,
    begin,
    end,
    gains,
    inertia,
    before,
    after,
    guess,
    found,
    miss,
    change,
    swing,
    left,
    right,
    roll_change,
    held,
    spins,
    turn,
    force,
    spare,
    stops,
    rates_of_spin,
    leg,
    moments,
    cells,
    courant,
    most,
    resumed,
):
    """Advance rotor and layers to one time after another, in place: Outcome, and the leg that was reached.

    What a scene has is handed over: `RATES` of its rings, `FRICTION`, `LAYER_STEP`, what moves pools
    (`pools_of`), balls (`balls_of`) and the spin (`spin_of`); then come the fields of
    `solvers.runup.state.Machine`, `State` and `Room`. The rotor turns in a step by at most the Courant
    number's share of a cell. `leg` is the first of the stops, k, that is not reached; the spin changes on the
    way to each at its rate. At each stop the moment goes into a row of `moments`, if that has rows: time,
    speed, angle, largest amplitude since the stop before with its speed and time, coordinates; and areas and
    momenta of the layers into one of `cells`. `resumed`: the call before ended with RAN_OUT, and nothing has
    changed since. Every step goes into the state's trace if that has rows. NOT_COUPLED: the accelerations did
    not agree in the shortest steps; STOPPED: the motor stands.
    """
    shaft, pace, sums, crest = shaft[0], pace[0], sums[0], crest[0]
    n, rings_, axes = change.size, layers.shape[0], planes.shape[0]
    cell, tried_steps, free = 2.0 * np.pi / angles.shape[1], 0, curve.shape[1] > 0
    longest, pooled = swing_time(pools, gravity), pools.shape[0] > 0
    count = rings_ * angles.shape[1]
    while leg < stops.size:
        stop = stops[leg]
        if not resumed:
            if leg > 0:
                crest.amplitude = 0.0
            if not free:  # a free spin goes on from its last step
                shaft.rate = rates_of_spin[leg]
            for j in range(rings_):
                measure(area[j], momentum[j], shaft.spin, angles, plates[j], spare[j], begin[j])
        resumed = False
        while shaft.time < stop:
            if shaft.spin <= 0.0:
                return Outcome.STOPPED, leg
            if tried_steps >= most:
                return Outcome.RAN_OUT, leg
            tried_steps += 1
            remaining = stop - shaft.time
            dt = pace.share * min(courant * cell / max(1.1 * pace.fastest, shaft.spin), longest)
            # The last two steps share what is left, so that none is a sliver; a whole number of steps stays
            # one, whatever the rounding of the time.
            if FILLS * dt >= remaining:
                dt = remaining
            elif FILLS * dt > 0.5 * remaining:
                dt = 0.5 * remaining
            copy(area, kept_area)
            copy(momentum, kept_momentum)
            copy(rolling, kept_rolling)
            begin_pools(
                pools, two_layers, rings, kept_pools, gravity, angles, shaft.spin, rings_, push, first, work
            )
            expect(push, pace, shaft, dt, guess)
            # The step is tried until rotor and layers agree.
            spin, angle, fastest, gap, status = shaft.spin, shaft.angle, 0.0, 0.0, Outcome.DONE + 0
            spins[0], spins[1] = spin, spin + shaft.rate * dt
            if free:
                spins[1] = max(spins[1], 0.5 * spin)
            share, last_given, last_after = 1.0, 0.0, 0.0
            for tried in range(ROUNDS):
                turned = angle + 0.5 * (spin + spins[1]) * dt
                turn[0], turn[1] = np.cos(angle), np.sin(angle)
                turn[2], turn[3] = np.cos(turned), np.sin(turned)
                copy(kept_area, area)
                copy(kept_momentum, momentum)
                copy(kept_rolling, rolling)
                fastest, gap = 0.0, 0.0
                moved = move_pools(
                    *(pools, pool_tables, two_layers, rings, kept_pools, gravity, angles, spins, rings_, dt),
                    *(guess, before, after, inertia, taken, first, last, work),
                )
                if not moved:
                    status = Outcome.AT_AXIS + 0
                    break
                for j in range(rings_):
                    layer = layers[j]
                    x, y = (
                        (gravity[0] - guess[j, 0]) / layer.radius,
                        (gravity[1] - guess[j, 1]) / layer.radius,
                    )
                    for k in range(2):
                        cosine, sine = turn[2 * k], turn[2 * k + 1]
                        force[2 * k], force[2 * k + 1] = x * cosine + y * sine, y * cosine - x * sine
                    coefficient, thin = layer.coefficient, layer.thin
                    if layer.law == STOKES or layer.law == WALL:
                        # Stokes' friction at the frequency of a natural wave goes with the root of the spin.
                        root = np.sqrt(0.5 * (spins[0] + spins[1]))
                        coefficient, thin = coefficient * root, thin / root
                    status, speed = layer_step(
                        *(
                            rates,
                            friction,
                            area[j],
                            momentum[j],
                            rolling[j],
                            spins,
                            force,
                            layer,
                            coefficient,
                            thin,
                        ),
                        *(
                            tables[j],
                            dt,
                            angles,
                            plates[j],
                            gaps[j],
                            SLOT_SPEED * SLOT_SPEED,
                            spare[j],
                            gains[j],
                        ),
                    )
                    fastest = max(fastest, speed)
                    if status != Outcome.DONE:
                        break
                if status != Outcome.DONE:
                    break
                _measure_layers(
                    *(layers, spins, turn, angles, plates, area, momentum, spare, begin, end, before, after),
                    inertia,
                )
                load_rotor(
                    *(
                        matrices,
                        unbalance,
                        planes,
                        masses,
                        place,
                        rate,
                        inertia,
                        before,
                        after,
                        guess,
                        spins,
                        turn,
                    ),
                    *(dt, swing, left, right),
                )
                add_balls(balls, races, gravity, n, roll, roll_rate, spins, dt, n, left, right, held)
                solve(left, right)
                for i in range(n):
                    change[i] = right[i]
                for j in range(roll_change.size):
                    roll_change[j] = right[n + j]
                sums.layer_steps += rings_
                distance, size = _disagreement(planes, layers, gravity, spin, change, guess, dt, found)
                gap = distance / max(size, 1e-300)
                after_spin = spin_after(
                    *(
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
                    ),
                    *(held, spins, turn, dt),
                )
                if after_spin <= 0.0:
                    # A long step turns the drum round where a shorter one slows it down.
                    status = (Outcome.TOO_LONG if pace.share > SHORTEST else Outcome.STOPPED) + 0
                    break
                gap = max(gap, abs(after_spin - spins[1]) / spin)
                if gap <= AGREED:
                    # Steps that change a free spin by less than that must change it all the same.
                    spins[1] = after_spin
                    break
                if tried == ROUNDS - 1:
                    status = Outcome.NOT_COUPLED + 0
                    if free and last_after < 0.5 * spin and pace.share <= SHORTEST:
                        # Half of its speed in the shortest step: it stands.
                        status = Outcome.STOPPED + 0
                    break
                share = _relaxed(guess, found, miss, share) if tried >= STRAIGHT else 1.0
                for j in range(axes):
                    for i in range(2):
                        miss[j, i] = found[j, i] - guess[j, i]
                        guess[j, i] += share * miss[j, i]
                given, spins[1] = spins[1], after_spin
                if tried > 0 and given != last_given and pooled:
                    # A pool that clings to a drum as light as itself answers the spin as strongly as it does.
                    slope = (after_spin - last_after) / (given - last_given)
                    if slope < 0.9:
                        spins[1] = max(given + (after_spin - given) / (1.0 - slope), 0.5 * spin)
                last_given, last_after = given, after_spin
            if status == Outcome.NOT_COUPLED:
                passable = PASSABLE if pace.share > _TINY or not pooled else _PASSABLE_POOL
                passes = pace.share <= SHORT and gap <= passable
                apart = _apart(pools, layers, gravity, guess, found, dt)
                if passes or (pace.share <= SHORTEST and apart <= _JUMP):
                    status = Outcome.DONE + 0
            if status != Outcome.DONE:
                shorter = status == Outcome.TOO_LONG or (
                    status == Outcome.NOT_COUPLED and pace.share > SHORTEST
                )
                if status == Outcome.NOT_COUPLED and not shorter:
                    for j in range(rings_):
                        if most_of(area[j]) > PILED:
                            status = Outcome.AT_AXIS + 0
                copy(kept_area, area)
                copy(kept_momentum, momentum)
                copy(kept_rolling, rolling)
                copy(kept_pools, two_layers)
                if not shorter:
                    return status, leg
                pace.fastest, pace.share = max(pace.fastest, fastest), 0.5 * pace.share
                if pace.share < LEAST:
                    return status, leg
                continue
            _tally(matrices, layers, gravity, rate, change, swing, begin, end, gains, turn, dt, sums)
            tally_pools(
                *(pools, gravity, spins, rings_, dt, found, before, after, taken, first, last, sums),
            )
            # Bores give nothing back: what the scheme does is no heat, the balance leaves it.
            sums.bores = max(sums.bores, sums.lost)
            tally_balls(balls, held, gravity, 0, roll, roll_rate, roll_change, spins, dt, sums)
            if free:
                sums.motor += dt * motor_power(curve, spins)
            # The step's end becomes the state.
            for i in range(n):
                place[i] += dt * (rate[i] + 0.5 * change[i])
                rate[i] += change[i]
            for j in range(roll_change.size):
                roll[j] += dt * (roll_rate[j] + 0.5 * roll_change[j])
                roll_rate[j] += roll_change[j]
            shaft.angle += 0.5 * (spins[0] + spins[1]) * dt
            shaft.spin = spins[1]
            for j in range(axes):
                for i in range(2):
                    push[j, 2, i] = push[j, 1, i]
                    push[j, 1, i] = push[j, 0, i]
                    push[j, 0, i] = found[j, i]
            for j in range(rings_):
                begin[j] = end[j]
            pace.older, pace.before, pace.last, pace.fastest, pace.share = (
                pace.before,
                pace.last,
                dt,
                fastest,
                min(1.0, 1.5 * pace.share),
            )
            if free:
                shaft.rate = (spins[1] - spins[0]) / dt
            shaft.time = stop if dt == remaining else shaft.time + dt
            sums.steps += 1.0
            watch(watched, place, shaft, crest)
            if trace.shape[0] > 0:
                row = trace[int(pace.kept)]
                row[0], row[1] = shaft.time, shaft.angle
                for i in range(n):
                    row[2 + i] = place[i]
                for j in range(rings_):
                    row[2 + n + 2 * j], row[3 + n + 2 * j] = begin[j].moment_x, begin[j].moment_y
                pace.kept += 1.0
            sums.disagreement = max(sums.disagreement, gap)
        if moments.shape[0] > 0:
            row = moments[leg]
            row[0], row[1], row[2] = shaft.time, shaft.spin, shaft.angle
            row[3], row[4], row[5] = crest.amplitude, crest.speed, crest.time
            for i in range(n):
                row[6 + i] = place[i]
            copy(area, cells[leg, :count])
            copy(momentum, cells[leg, count:])
        leg += 1
    return Outcome.DONE + 0, leg


_BALLS, _FLOWS, _ENDS = type_of(records(BALL)), type_of(records(FLOWS)), type_of(records(MEASURES))
# Of `advance`: what is handed over, then machine, state, scratch, and how far.
ADVANCE: Any = (
    *(RATES, FRICTION, LAYER_STEP, *POOLS, *BALLS, *SPIN),
    *(BLOCKS, TURNING, BLOCKS, ROW, type_of(records(LAYER)), type_of(records(STREAM)), BLOCKS, BLOCKS, ROW),
    *(ROWS, ROWS, ROWS, BLOCKS, ROW, _BALLS, BLOCKS),
    *(ROW, ROW, type_of(records(SHAFT)), ROWS, ROWS, ROWS, BLOCKS, FLAG[::1], BLOCKS, type_of(records(PACE))),
    *(type_of(records(SUMS)), type_of(records(CREST)), ROWS, ROW, ROW),
    *(ROWS, ROWS, ROWS, BLOCKS, type_of(records(TAKEN)), _FLOWS, _FLOWS, BLOCKS, _ENDS, _ENDS),
    *(type_of(records(GAINS)), ROWS, ROWS, ROWS, ROWS, ROWS, ROWS, ROW, ROW, ROWS, ROW, ROW, ROW, ROW, ROW),
    *(ROW, BLOCKS, ROW, ROW, WHOLE, ROWS, ROWS, REAL, WHOLE, FLAG),
)
