"""Rotor and liquid layers through time together [theory: coupling].

Each step looks for the mean acceleration of every chamber's axis that makes the layers' change of momentum
and the rotor's trapezium agree: momentum is exchanged to rounding, and the rotor's part is stable for any
stiffness. SI units; layers over their wall radius.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fluid.friction.laws import NONE, STOKES, WALL
from solvers.layer.baffles import FACE, OPEN, taken
from solvers.layer.drag import wall_kept
from solvers.layer.finite_volume import COMPILED, GHOSTS, LOG, NEAREST, SUMMED, SURFACE, VELOCITY, WORK, most
from solvers.layer.inside import SLOT_SPEED, Inside
from solvers.layer.records import Outcome
from solvers.layer.step import (
    add_velocity,
    bound_energy,
    calm,
    copy,
    correct,
    correct_energy,
    decelerate,
    kept_speed,
    predict,
    predict_energy,
    profile,
    stage_rates,
)
from solvers.layer.two_layer_step import advance as advance_pool
from solvers.layer.two_layer_step import measure as measure_pool
from solvers.layer.two_layer_step import stands
from solvers.machine_code import BARE, machine_code

_jit: Any = machine_code(**COMPILED)
_unwrapped: Any = machine_code(**(COMPILED | BARE))
_summed: Any = machine_code(**(SUMMED | BARE))
# Parts of one function: compiled one by one and linked they would cost twice the time to compile.
_inner: Any = machine_code(inline="always")


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


@_jit
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


@_jit
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


@_jit
def driven(curve, shaft, load, dt):
    """Spin at the end of a step under the motor's torque at the middle, however steep its curve.

    `load`: impulse of the torque of liquid and whirl on the drum.
    """
    weight = 0.5 / shaft.inertia
    middle, _ = resisted(curve, -dt * weight, shaft.spin - load * weight)
    return 2.0 * middle - shaft.spin


@_jit
def relative_momentum(measures, layer, spin, cosine, sine, out):
    """Momentum of a layer relative to its axis, in the standing frame [theory: coupling, eq. 3]."""
    scale = layer.weight * layer.radius**3
    x = measures.flow_x - spin * measures.moment_y
    y = measures.flow_y + spin * measures.moment_x
    out[0], out[1] = scale * (x * cosine - y * sine), scale * (x * sine + y * cosine)


@_jit
def flow_inertia(measures, layer, c, s, out):
    """Inertia of a layer's flow under a body force, in the standing frame [theory: coupling, eq. 4]."""
    scale = layer.weight * layer.radius**2
    xx, xy, yy = scale * measures.xx, scale * measures.xy, scale * measures.yy
    out[0] = c * c * xx - 2.0 * c * s * xy + s * s * yy
    out[1] = c * s * (xx - yy) + (c * c - s * s) * xy
    out[2] = s * s * xx + 2.0 * c * s * xy + c * c * yy


# Rows of a layer's scratch beyond those of its rates: radial forces, rates of change, state of the second
# stage, share of the velocity that friction leaves; velocity, radius of the surface and L at the step's end.
_PULL_CELL, _PULL_FACE, _RATE_A, _RATE_Q, _NEXT_A, _NEXT_Q, _KEPT = range(WORK, WORK + 7)
_VELOCITY, _SURFACE, _LOG = range(WORK + 7, WORK + 10)
# The same of the fluctuations behind bores: rate of change, second stage.
_RATE_E, _NEXT_E = WORK + 10, WORK + 11
# What the law of the wall adds to the velocity; of other laws it stays nothing.
_PUSHED = WORK + 12
# Angular momentum before friction.
_HELD = WORK + 13


def layer_scratch(layers: int, cells: int) -> NDArray[np.float64]:
    """Scratch that `layer_step` wants for each of so many layers."""
    return np.zeros((layers, WORK + 14, cells + 2 * GHOSTS))


@_jit
def measure(area, q, spin, angles, plates, spare, out):
    """Fill `out`, a record MEASURES, for a layer [theory: coupling, eq. 2, 4 and 7].

    `plates`: the layer's table of baffles as the last evaluation of its rates left it.
    """
    n = area.size
    profile(area, q, spin, spare[_VELOCITY, :n], spare[_SURFACE, :n], spare[_LOG, :n])
    measure_profile(area, q, spin, angles, plates, spare, out)


@_unwrapped
def measure_profile(area, q, spin, angles, plates, spare, out):
    """Fill `out` as `measure`, for a layer whose profile stands in its scratch, as `layer_step` leaves it."""
    n = area.size
    velocity, surface, log = spare[_VELOCITY, :n], spare[_SURFACE, :n], spare[_LOG, :n]
    step = 2.0 * np.pi / n
    sums = _moments(area, q, velocity, surface, log, spin, angles[0], angles[1])
    out.moment_x, out.moment_y = sums[0] * step, sums[1] * step
    out.spinning, out.energy = sums[2] * step, sums[3] * step
    across, along = spare[0], spare[1]
    for i in range(n):
        across[i + 1], along[i + 1] = surface[i] * angles[0, i], surface[i] * angles[1, i]
    across[0], along[0], across[n + 1], along[n + 1] = across[n], along[n], across[1], along[1]
    flow = _flows(velocity, log, across, along)
    out.flow_x, out.flow_y = flow[0], flow[1]
    out.xx, out.xy, out.yy = flow[2] / step, flow[3] / step, flow[4] / step
    _held_back(plates, velocity, log, across, along, step, out)


@_summed
def _moments(area, q, velocity, surface, log, spin, cosine, sine):
    """Sums over the cells: first moment, angular momentum and energy.

    A film holds all its angular momentum, although its velocity is faded out.
    """
    moment_x, moment_y, spinning, energy = 0.0, 0.0, 0.0, 0.0
    for i in range(area.size):
        r, u = surface[i], velocity[i]
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        moment_x += lever * cosine[i]
        moment_y += lever * sine[i]
        whole, relative = area[i] * (1.0 - area[i]), q[i] + spin * area[i] * area[i]
        spinning += spin * whole + relative
        energy += 0.5 * spin * spin * whole + spin * relative + 0.5 * u * u * log[i]
    return moment_x, moment_y, spinning, energy


@_summed
def _flows(velocity, log, across, along):
    """Sums over the cells: rate of the first moment by the flow, and the flow's inertia."""
    flow_x, flow_y, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0
    n = velocity.size
    across_b, across_a, along_b, along_a = across[:n], across[2 : n + 2], along[:n], along[2 : n + 2]
    for i in range(n):
        x, y = 0.5 * (across_a[i] - across_b[i]), 0.5 * (along_a[i] - along_b[i])
        flow = velocity[i] * log[i]
        flow_x += flow * x
        flow_y += flow * y
        xx += log[i] * x * x
        xy += log[i] * x * y
        yy += log[i] * y * y
    return flow_x, flow_y, xx, xy, yy


@_unwrapped
def _held_back(plates, velocity, log, across, along, step, out):
    """Take from flow and inertia in `out`, a record MEASURES, what would pass closed baffles.

    Nothing passes there, and the liquid's momentum is the rate of its first moment [theory: coupling, eq. 2].
    """
    n = velocity.size
    for k in range(plates.shape[0]):
        i = int(plates[k, FACE])
        if i < 0 or plates[k, OPEN] > 0.0:
            continue
        x, y = across[i + 1] - across[i], along[i + 1] - along[i]
        for side in range(2):
            # The cell before the face and the one after it: half of either's flow would pass.
            j = (i - 1 + side) % n
            flow = 0.5 * velocity[j] * log[j]
            out.flow_x -= flow * x
            out.flow_y -= flow * y
            whole_x = 0.5 * (across[j + 2] - across[j])
            whole_y = 0.5 * (along[j + 2] - along[j])
            # The other half passes, of a cell whose slope is that of its own side.
            rest_x, rest_y, share = whole_x - 0.5 * x, whole_y - 0.5 * y, log[j] / step
            out.xx += share * (2.0 * rest_x * rest_x - whole_x * whole_x)
            out.xy += share * (2.0 * rest_x * rest_y - whole_x * whole_y)
            out.yy += share * (2.0 * rest_y * rest_y - whole_y * whole_y)


@_summed
def _power(area, velocity, surface, log, rate_a, spin, x, y, cosine, sine):
    """Power of the body force in the frame that does not turn, and what the flow's profile misses, a cell.

    The second over the change of the spin: the profile does not turn all of the Euler force's work on the
    angular momentum into energy [theory: coupling, eq. 8].
    """
    moment_x, moment_y, rate_x, rate_y, missed = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(area.size):
        r = np.maximum(surface[i], NEAREST)
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        moment_x += lever * cosine[i]
        moment_y += lever * sine[i]
        rate_x += r * cosine[i] * rate_a[i]
        rate_y += r * sine[i] * rate_a[i]
        missed += velocity[i] * (log[i] * (1.0 - area[i]) - area[i])
    return x * (rate_x - spin * moment_y) + y * (rate_y + spin * moment_x), missed


@_summed
def _rub(area, q, held, velocity, log, kept, pushed, spin, full, slot):
    """Let friction leave its share of the velocities and add to them; sums over the cells, over rho h_c R^4.

    Impulse of the wall's torque, heat, and the energy in the frame that does not turn before and after
    [theory: coupling, eq. 7], of a full gap too [theory: long_wave, eq. 19]. `q` and `held`: angular momenta
    after and before.
    """
    torque, heat, before, after = 0.0, 0.0, 0.0, 0.0
    for i in range(area.size):
        u, v = velocity[i], velocity[i] * kept[i] + pushed[i]
        velocity[i] = v
        torque += q[i] - held[i]
        lost = 0.5 * log[i] * (u - v) * (u + v)
        heat += lost
        pressed = np.maximum(area[i] - full, 0.0)
        still = spin * (0.5 * spin * area[i] * (1.0 + area[i]) + q[i]) + 0.5 * log[i] * v * v
        still += 0.5 * slot * pressed * pressed
        after += still
        before += still + spin * (held[i] - q[i]) + lost
    return torque, heat, before, after


@_unwrapped
def _half_friction(area, q, spin, layer, drags, dt, inside, spare, gains):
    """Half a step of friction; the energy before and after, with the profile left in the scratch."""
    n, step = area.size, 2.0 * np.pi / area.size
    velocity, surface, log = spare[_VELOCITY, :n], spare[_SURFACE, :n], spare[_LOG, :n]
    kept, pushed, held = spare[_KEPT, :n], spare[_PUSHED, :n], spare[_HELD, :n]
    coefficient, thin, table = drags
    profile(area, q, spin, velocity, surface, log)
    copy(q, held)
    if layer.law == NONE:
        for i in range(n):
            kept[i] = 1.0
    else:
        if layer.law == WALL:
            known = (layer.lid, layer.plates, thin, layer.top, table)
            wall_kept(area, velocity, surface, coefficient, known, 0.5 * dt, kept, pushed)
        else:
            kept_speed(area, velocity, surface, layer.law, coefficient, layer.lid, 0.5 * dt, kept)
        decelerate(area, q, spin, kept)
        if layer.law == WALL:
            add_velocity(area, q, pushed)
    slot = inside.slot * spin * spin
    torque, heat, before, after = _rub(area, q, held, velocity, log, kept, pushed, spin, inside.full, slot)
    gains.torque += torque * step
    gains.work += spin * torque * step
    gains.heat += heat * step
    return before * step, after * step


@_unwrapped
def layer_step(
    area, q, rolling, spins, force, layer, coefficient, thin, table, dt, angles, inside, spare, gains
):
    """Advance a layer by one time step, in place; a step that fails leaves nothing of use.

    Outcome.DONE, TOO_LONG or AT_AXIS, and the largest speed met. `spins` and `force` (body force over R in
    the drum frame, two parts each) at both ends; friction's `coefficient`, `thin` and `table` at these spins.
    The profile at the end is left in `spare`, results in `gains`, a record GAINS.
    """
    n = area.size
    step, euler, dispersion = 2.0 * np.pi / n, (spins[1] - spins[0]) / dt, layer.dispersion
    pull_cell, pull_face = spare[_PULL_CELL, :n], spare[_PULL_FACE, :n]
    rate_a, rate_q = spare[_RATE_A, :n], spare[_RATE_Q, :n]
    next_a, next_q = spare[_NEXT_A, :n], spare[_NEXT_Q, :n]
    rate_e, next_e = spare[_RATE_E, : rolling.size], spare[_NEXT_E, : rolling.size]
    velocity, surface, log = spare[VELOCITY, GHOSTS:], spare[SURFACE, GHOSTS:], spare[LOG, GHOSTS:]
    gains.torque, gains.work, gains.heat = 0.0, 0.0, 0.0
    gains.loss, gains.missed, gains.baffles = 0.0, 0.0, 0.0
    drags = coefficient, thin, table
    _, gains.loss = _half_friction(area, q, spins[0], layer, drags, dt, inside, spare, gains)
    copy(area, next_a)
    copy(q, next_q)
    copy(rolling, next_e)
    fastest = 0.0
    for stage in range(2):
        spin, x, y = spins[stage], force[2 * stage], force[2 * stage + 1]
        outcome, speed = stage_rates(
            next_a, next_q, next_e, spin, euler, x, y, angles, inside, dt, dispersion,
            pull_cell, pull_face, spare, rate_a, rate_q, rate_e,
        )  # fmt: skip
        fastest = max(fastest, speed)
        if outcome != Outcome.DONE:
            return outcome, fastest
        done, missed = _power(next_a, velocity, surface, log, rate_a, spin, x, y, angles[0], angles[1])
        gains.loss += 0.5 * dt * step * done
        gains.missed += 0.5 * dt * step * euler * missed
        held, power = taken(inside.plates)
        gains.torque -= 0.5 * dt * held
        gains.work -= 0.5 * dt * spin * held
        gains.baffles += 0.5 * dt * power
        # The drum's work by the baffles enters, their heat leaves.
        gains.loss -= 0.5 * dt * (spin * held + power)
        if stage == 0:
            if not predict(area, q, rate_a, rate_q, dt, next_a, next_q):
                return Outcome.AT_AXIS, fastest
            predict_energy(rolling, rate_e, dt, next_e)
        else:
            correct(area, q, rate_a, rate_q, dt, next_a, next_q)
            correct_energy(rolling, rate_e, dt, next_e)
            bound_energy(area, rolling, spin)
            # What films lose to the wall is a torque of the drum, which works.
            stuck = step * calm(area, q, spin)
            gains.torque += stuck
            gains.work += spin * stuck
            gains.loss += spin * stuck
    energy, _ = _half_friction(area, q, spins[1], layer, drags, dt, inside, spare, gains)
    gains.loss -= energy + gains.missed
    return Outcome.DONE, fastest


# A step is done once two estimates of the mean accelerations differ by this, relative to the largest. Where
# the drying edge of a layer makes them jump, the guess follows by shares after some rounds; after the last
# the step is shortened, and a short one may pass with what is left. Momentum is handed over all the same.
AGREED, _PASSABLE, _STRAIGHT, _ROUNDS, _SHORT = 1e-6, 1e-2, 3, 16, 1.0 / 32.0
# The force of a pool jumps where cells run dry: beside one, steps as short as this pass with so much left.
_TINY, _PASSABLE_POOL = 1.0 / 256.0, 0.2
# Steps this short that do not agree end the run: a layer on its way through the axis.
SHORTEST = 1.0 / 1024.0
# Momentum of a pool that jumps at a cell is no acceleration: the shortest steps pass with so much of a
# difference in velocity.
_JUMP = 3e-4
# A layer of this area, whose surface is nearer to the axis than to the wall, is none where it does not agree.
_PILED = 0.375
# Share of the spin by which a ball that sticks may creep.
_CREEP = 1e-5
# No wave of a pool is faster, rad/s.
_FASTEST = 1e9
# Steps shortened by more than this no longer follow what the layers do.
_LEAST = 1e-6
# Longest step beside a pool, over the time in which it swings by a radian.
_SWING = 0.25


@_unwrapped
def _move_pools(machine, state, room, dt):
    """Move all pools one step under the guessed accelerations; whether they could [theory: pool, eq. 19]."""
    spin, first = 0.5 * (room.spins[0] + room.spins[1]), machine.layers.shape[0]
    for j in range(machine.pools.shape[0]):
        pool, own, taken, work = machine.pools[j], first + j, room.taken[j], room.work[j]
        x = (machine.gravity[0] - room.guess[own, 0]) / pool.radius
        y = (machine.gravity[1] - room.guess[own, 1]) / pool.radius
        for i in range(state.two_layers.shape[1]):
            copy(room.two_layers[j, i], state.two_layers[j, i])
        taken.torque, taken.heat, taken.baffles = 0.0, 0.0, 0.0
        fastest = advance_pool(
            *(state.two_layers[j], spin, x, y, state.rings[j], dt, machine.angles, pool),
            *(machine.pool_tables[j], work, taken),
        )
        if not fastest < _FASTEST:
            return False
        begin, end = room.first[j], room.last[j]
        measure_pool(
            *(state.two_layers[j], machine.angles, pool.full, pool.slot, room.spins[1]),
            *(work, end),
        )
        room.before[own, 0], room.before[own, 1] = pool.weight * begin.flow_x, pool.weight * begin.flow_y
        room.after[own, 0], room.after[own, 1] = pool.weight * end.flow_x, pool.weight * end.flow_y
        scale = 0.5 * pool.weight / pool.radius
        room.inertia[own, 0] = scale * (begin.xx + end.xx)
        room.inertia[own, 1] = scale * (begin.xy + end.xy)
        room.inertia[own, 2] = scale * (begin.yy + end.yy)
    return True


@_unwrapped
def _begin_pools(machine, state, room):
    """Measure the pools at the beginning of a step; rings that their own rotation holds no more fall."""
    first = machine.layers.shape[0]
    for j in range(machine.pools.shape[0]):
        pool = machine.pools[j]
        x = (machine.gravity[0] - state.push[first + j, 0, 0]) / pool.radius
        y = (machine.gravity[1] - state.push[first + j, 0, 1]) / pool.radius
        state.rings[j] = state.rings[j] and stands(state.two_layers[j], x, y, pool.full)
        for i in range(state.two_layers.shape[1]):
            copy(state.two_layers[j, i], room.two_layers[j, i])
        measure_pool(
            *(state.two_layers[j], machine.angles, pool.full, pool.slot, state.shaft[0].spin),
            *(room.work[j], room.first[j]),
        )


@_unwrapped
def _restore_pools(state, room):
    """Put the pools back to the beginning of the step."""
    for j in range(room.two_layers.shape[0]):
        for i in range(room.two_layers.shape[1]):
            copy(room.two_layers[j, i], state.two_layers[j, i])


@_inner
def _move_layers(machine, state, room, dt):
    """Move all layers through one step under the guessed accelerations; what went wrong, the fastest wave."""
    fastest, spins, turn, force = 0.0, room.spins, room.turn, room.force
    copy(room.area, state.area)
    copy(room.momentum, state.momentum)
    copy(room.rolling, state.rolling)
    if not _move_pools(machine, state, room, dt):
        return Outcome.AT_AXIS, fastest
    for j in range(machine.layers.shape[0]):
        layer = machine.layers[j]
        x = (machine.gravity[0] - room.guess[j, 0]) / layer.radius
        y = (machine.gravity[1] - room.guess[j, 1]) / layer.radius
        for end in range(2):
            cosine, sine = turn[2 * end], turn[2 * end + 1]
            force[2 * end], force[2 * end + 1] = x * cosine + y * sine, y * cosine - x * sine
        coefficient, thin = layer.coefficient, layer.thin
        if layer.law == STOKES or layer.law == WALL:
            # Stokes' friction at the frequency of a natural sloshing wave goes with the root of the spin.
            root = np.sqrt(0.5 * (spins[0] + spins[1]))
            coefficient, thin = coefficient * root, thin / root
        status, speed = layer_step(
            *(
                state.area[j],
                state.momentum[j],
                state.rolling[j],
                spins,
                force,
                layer,
                coefficient,
                thin,
                machine.tables[j],
                dt,
                machine.angles,
                Inside(machine.plates[j], machine.gaps[j], SLOT_SPEED * SLOT_SPEED),
            ),
            *(room.spare[j], room.gains[j]),
        )
        fastest = max(fastest, speed)
        if status != Outcome.DONE:
            return status, fastest
    return Outcome.DONE, fastest


@_unwrapped
def _measure_layers(machine, state, room):
    """The layers' momenta at both ends of the step, and the inertia of their flows."""
    turn, spins = room.turn, room.spins
    cosine, sine = 0.5 * (turn[0] + turn[2]), 0.5 * (turn[1] + turn[3])
    size = np.hypot(cosine, sine)
    for j in range(machine.layers.shape[0]):
        layer = machine.layers[j]
        # Their steps have left the profiles at the end.
        area, q = state.area[j], state.momentum[j]
        measure_profile(area, q, spins[1], machine.angles, machine.plates[j], room.spare[j], room.end[j])
        relative_momentum(room.begin[j], layer, spins[0], turn[0], turn[1], room.before[j])
        relative_momentum(room.end[j], layer, spins[1], turn[2], turn[3], room.after[j])
        flow_inertia(room.begin[j], layer, cosine / size, sine / size, room.inertia[j])


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


@_unwrapped
def _move_rotor(machine, state, room, dt):
    """Change of the velocities of rotor and balls over the step, given the layers' momenta.

    Theory: coupling, eq. 5; races, eq. 3.
    """
    change, swing, left, right, turn = room.change, room.swing, room.left, room.right, room.turn
    n, spin = change.size, 0.5 * (room.spins[0] + room.spins[1])
    for i in range(right.size):
        right[i] = 0.0
        for k in range(right.size):
            left[i, k] = 0.0
    for i in range(n):
        first = machine.unbalance[i] * complex(turn[0], turn[1])
        last = machine.unbalance[i] * complex(turn[2], turn[3])
        swing[i] = room.spins[0] * first.imag - room.spins[1] * last.imag
        right[i] = -swing[i]
        for k in range(n):
            damping = machine.matrices[1, i, k] + spin * machine.matrices[2, i, k]
            stiffness = machine.matrices[3, i, k]
            left[i, k] = machine.matrices[0, i, k] + 0.5 * dt * damping + 0.25 * dt * dt * stiffness
            x, v = state.place[k], state.rate[k]
            right[i] -= dt * (damping * v + stiffness * (x + 0.5 * dt * v))
    first = machine.layers.shape[0]
    for j in range(machine.planes.shape[0]):
        mass = machine.layers[j].mass if j < first else machine.pools[j - first].mass
        b, guess = machine.planes[j], room.guess[j]
        xx, xy, yy = room.inertia[j, 0], room.inertia[j, 1], room.inertia[j, 2]
        given_x = room.after[j, 0] - room.before[j, 0] + dt * (xx * guess[0] + xy * guess[1])
        given_y = room.after[j, 1] - room.before[j, 1] + dt * (xy * guess[0] + yy * guess[1])
        for i in range(n):
            right[i] -= b[0, i] * given_x + b[1, i] * given_y
            for k in range(n):
                left[i, k] += (mass - xx) * b[0, i] * b[0, k] + (mass - yy) * b[1, i] * b[1, k]
                left[i, k] -= xy * (b[0, i] * b[1, k] + b[1, i] * b[0, k])
    for j in range(machine.balls.shape[0]):
        moving = state.roll[j], state.roll_rate[j]
        ball, b = machine.balls[j], machine.races[j]
        room.held[j] = add_ball(ball, b, machine.gravity, n + j, moving, room.spins, dt, n, left, right)
    solve(left, right)
    for i in range(n):
        change[i] = right[i]
    for j in range(room.roll.size):
        room.roll[j] = right[n + j]


@_unwrapped
def _disagreement(machine, room, dt):
    """Mean accelerations that the rotor's change means; their distance from the guess, and their size."""
    gap, size, spin, first = 0.0, 0.0, room.spins[0], machine.layers.shape[0]
    for j in range(machine.planes.shape[0]):
        reach = machine.layers[j].radius if j < first else 0.0
        for i in range(2):
            total = 0.0
            for k in range(room.change.size):
                total += machine.planes[j, i, k] * room.change[k]
            room.found[j, i] = total / dt
            gap = max(gap, abs(room.found[j, i] - room.guess[j, i]))
            # Edges of a pool that run dry make its force jump: beside its weight that is nothing.
            least = 1e-6 * spin * spin * reach if j < first else abs(machine.gravity[0])
            size = max(size, abs(room.found[j, i]), least)
    return gap, size


@_unwrapped
def _spin_after(machine, state, room, dt):
    """Spin at the end of the step: on its ramp, or by the motor [theory: coupling, eq. 6]."""
    n, shaft = room.change.size, state.shaft[0]
    spin = shaft.spin
    if machine.curve.shape[1] == 0:
        return spin + shaft.rate * dt
    load = 0.0
    for i in range(n):
        middle = (
            0.5 * machine.unbalance[i] * complex(room.turn[0] + room.turn[2], room.turn[1] + room.turn[3])
        )
        load -= room.change[i] * middle.imag
    for j in range(machine.layers.shape[0]):
        layer = machine.layers[j]
        load += layer.weight * layer.radius**4 * room.gains[j].torque
    for j in range(machine.pools.shape[0]):
        load += machine.pools[j].inertia * room.taken[j].torque
    for j in range(machine.balls.shape[0]):
        rate, change = state.roll_rate[j], room.roll[j]
        load += ball_turned(machine.balls[j], room.held[j], rate, change, room.spins, dt)
    return driven(machine.curve, shaft, load, dt)


@_unwrapped
def _lowered(gravity, layer, begin, end, turn):
    """Work of gravity on a layer over a step: its weight on the way of its centre of mass."""
    x = end.moment_x * turn[2] - end.moment_y * turn[3] - begin.moment_x * turn[0] + begin.moment_y * turn[1]
    y = end.moment_x * turn[3] + end.moment_y * turn[2] - begin.moment_x * turn[1] - begin.moment_y * turn[0]
    return layer.weight * layer.radius**3 * (gravity[0] * x + gravity[1] * y)


@_unwrapped
def _tally(machine, state, room, dt):
    """Add one step's work and losses [theory: coupling, eq. 9-10]."""
    sums, n = state.sums[0], room.change.size
    spin = 0.5 * (room.spins[0] + room.spins[1])
    for i in range(n):
        mean = state.rate[i] + 0.5 * room.change[i]
        sums.unbalance -= room.swing[i] * mean
        for k in range(n):
            sums.support += dt * mean * machine.matrices[1, i, k] * (state.rate[k] + 0.5 * room.change[k])
    for j in range(machine.layers.shape[0]):
        layer, gains = machine.layers[j], room.gains[j]
        scale = layer.weight * layer.radius**4
        sums.drive += scale * gains.work
        sums.gravity += _lowered(machine.gravity, layer, room.begin[j], room.end[j], room.turn)
        sums.friction += scale * gains.heat
        sums.lost += scale * gains.loss
        sums.baffles += scale * gains.baffles
        sums.profile += scale * gains.missed
    for j in range(machine.pools.shape[0]):
        pool, taken, own = machine.pools[j], room.taken[j], machine.layers.shape[0] + j
        begin, end = room.first[j], room.last[j]
        drive, heat = spin * pool.inertia * taken.torque, pool.inertia * taken.heat
        lost = pool.inertia * taken.baffles
        x, y = end.moment_x - begin.moment_x, end.moment_y - begin.moment_y
        fallen = pool.weight * (machine.gravity[0] * x + machine.gravity[1] * y)
        sums.drive += drive
        sums.friction += heat
        sums.baffles += lost
        sums.gravity += fallen
        # Jumps, mixing and what the layers rub on one another: what is left of its balance in its own frame.
        sums.lost += pool.inertia * (begin.energy - end.energy) + fallen + drive - heat - lost
        for i in range(2):
            sums.lost -= 0.5 * dt * room.found[own, i] * (room.before[own, i] + room.after[own, i])
    # Bores give nothing back: what the scheme does is no heat, the balance leaves it.
    sums.bores = max(sums.bores, sums.lost)
    for j in range(machine.balls.shape[0]):
        ball, moving = machine.balls[j], (state.roll[j], state.roll_rate[j])
        tally_ball(ball, room.held[j], machine.gravity, moving, room.roll[j], room.spins, dt, sums)
    if machine.curve.shape[1] > 0:
        sums.motor += dt * spin * motor_torque(machine.curve, spin)


@_unwrapped
def _relaxed(room, share):
    """Share of what the accelerations miss by that the guess follows next, by Aitken's rule for vectors."""
    along, size = 0.0, 0.0
    for j in range(room.guess.shape[0]):
        for i in range(2):
            change = room.found[j, i] - room.guess[j, i] - room.miss[j, i]
            along += room.miss[j, i] * change
            size += change * change
    return min(max(-share * along / (size + 1e-300), -1.0), 1.0)


@_inner
def _couple(machine, state, room, dt):
    """One step tried until rotor and layers agree; what went wrong, the fastest wave, what is left."""
    shaft = state.shaft[0]
    spin, angle, fastest = shaft.spin, shaft.angle, 0.0
    room.spins[0], room.spins[1] = spin, spin + shaft.rate * dt
    if machine.curve.shape[1] > 0:
        room.spins[1] = max(room.spins[1], 0.5 * spin)
    left, share, last_given, last_after = 0.0, 1.0, 0.0, 0.0
    for tried in range(_ROUNDS):
        turned = angle + 0.5 * (spin + room.spins[1]) * dt
        room.turn[0], room.turn[1] = np.cos(angle), np.sin(angle)
        room.turn[2], room.turn[3] = np.cos(turned), np.sin(turned)
        status, fastest = _move_layers(machine, state, room, dt)
        if status != Outcome.DONE:
            return status, fastest, 0.0
        _measure_layers(machine, state, room)
        _move_rotor(machine, state, room, dt)
        state.sums[0].layer_steps += machine.layers.shape[0]
        gap, size = _disagreement(machine, room, dt)
        left = gap / max(size, 1e-300)
        after = _spin_after(machine, state, room, dt)
        if after <= 0.0:
            # A long step turns the drum round where a shorter one slows it down.
            return (Outcome.TOO_LONG if state.pace[0].share > SHORTEST else Outcome.STOPPED), fastest, left
        left = max(left, abs(after - room.spins[1]) / spin)
        if left <= AGREED:
            # Steps that change a free spin by less than that must change it all the same.
            room.spins[1] = after
            return Outcome.DONE, fastest, left
        if tried == _ROUNDS - 1:
            break
        share = _relaxed(room, share) if tried >= _STRAIGHT else 1.0
        for j in range(room.guess.shape[0]):
            for i in range(2):
                room.miss[j, i] = room.found[j, i] - room.guess[j, i]
                room.guess[j, i] += share * room.miss[j, i]
        given, room.spins[1] = room.spins[1], after
        if tried > 0 and given != last_given and machine.pools.shape[0] > 0:
            # A pool that clings to a drum as light as itself answers the spin as strongly as it does.
            slope = (after - last_after) / (given - last_given)
            if slope < 0.9:
                room.spins[1] = max(given + (after - given) / (1.0 - slope), 0.5 * spin)
        last_given, last_after = given, after
    if machine.curve.shape[1] > 0 and last_after < 0.5 * spin and state.pace[0].share <= SHORTEST:
        # Half of its speed in the shortest step: it stands.
        return Outcome.STOPPED, fastest, left
    return Outcome.NOT_COUPLED, fastest, left


@_unwrapped
def _deepest(state):
    """Largest area of all layers, over R^2."""
    found = 0.0
    for j in range(state.area.shape[0]):
        found = max(found, most(state.area[j]))
    return found


@_unwrapped
def _apart(machine, room, dt):
    """Velocity by which what rotor and pools found is apart from what they were given, over sqrt(g R).

    Beside layers that is no measure: one that does not agree in the shortest steps is thrown off its wall.
    """
    gap, heavy = 0.0, abs(machine.gravity[0])
    for j in range(machine.pools.shape[0]):
        for i in range(2):
            apart = dt * abs(room.found[j, i] - room.guess[j, i])
            gap = max(gap, apart / np.sqrt(heavy * machine.pools[j].radius))
    return gap if machine.layers.shape[0] == 0 else np.inf


@_unwrapped
def _guess(state, room, dt):
    """Mean accelerations of the step to come, on a line through the last two steps'."""
    pace = state.pace[0]
    ahead = min((dt + pace.last) / max(pace.last + pace.before, 1e-300), 2.0)
    for j in range(room.guess.shape[0]):
        for i in range(2):
            here = state.push[j, 0, i]
            room.guess[j, i] = here + ahead * (here - state.push[j, 1, i])


@_unwrapped
def _accept(state, room, dt, fastest):
    """Make the step's end the state."""
    shaft, pace = state.shaft[0], state.pace[0]
    for i in range(room.change.size):
        state.place[i] += dt * (state.rate[i] + 0.5 * room.change[i])
        state.rate[i] += room.change[i]
    for j in range(room.roll.size):
        state.roll[j] += dt * (state.roll_rate[j] + 0.5 * room.roll[j])
        state.roll_rate[j] += room.roll[j]
    shaft.angle += 0.5 * (room.spins[0] + room.spins[1]) * dt
    shaft.spin = room.spins[1]
    for j in range(room.guess.shape[0]):
        for i in range(2):
            state.push[j, 1, i] = state.push[j, 0, i]
            state.push[j, 0, i] = room.found[j, i]
    for j in range(room.begin.shape[0]):
        room.begin[j] = room.end[j]
    pace.before, pace.last, pace.fastest, pace.share = pace.last, dt, fastest, min(1.0, 1.5 * pace.share)


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


@_jit
def swing_time(pools, gravity):
    """Longest step that follows the pools' swinging, s."""
    longest = np.inf
    for j in range(pools.shape[0]):
        longest = min(longest, _SWING * np.sqrt(pools[j].radius / abs(gravity[0])))
    return longest


@_unwrapped
def _keep(state, room, row):
    """Write down a moment: time, angle, coordinates, and the first moment of each layer over R^3."""
    n, shaft = state.place.size, state.shaft[0]
    row[0], row[1] = shaft.time, shaft.angle
    for i in range(n):
        row[2 + i] = state.place[i]
    for j in range(room.begin.shape[0]):
        row[2 + n + 2 * j], row[3 + n + 2 * j] = room.begin[j].moment_x, room.begin[j].moment_y


@_jit
def advance(machine, state, room, stop, courant, most, resumed):
    """Advance rotor and layers to a time, in place: Outcome, and the steps tried.

    The rotor turns in a step by at most the Courant number's share of a cell. `resumed`: the call before
    ended with RAN_OUT, and nothing has changed since. Every step goes into the state's trace if that has
    rows. NOT_COUPLED: the accelerations did not agree in the shortest steps; STOPPED: the motor stands.
    """
    shaft, pace, sums = state.shaft[0], state.pace[0], state.sums[0]
    cell, taken = 2.0 * np.pi / machine.angles.shape[1], 0
    longest = swing_time(machine.pools, machine.gravity)
    if not resumed:
        for j in range(room.begin.shape[0]):
            measure(
                *(state.area[j], state.momentum[j], shaft.spin, machine.angles, machine.plates[j]),
                *(room.spare[j], room.begin[j]),
            )
    while shaft.time < stop:
        if shaft.spin <= 0.0:
            return Outcome.STOPPED, taken
        if taken >= most:
            return Outcome.RAN_OUT, taken
        taken += 1
        left = stop - shaft.time
        dt = pace.share * min(courant * cell / max(1.1 * pace.fastest, shaft.spin), longest)
        # The last two steps share what is left, so that none is a sliver.
        if dt >= left:
            dt = left
        elif dt > 0.5 * left:
            dt = 0.5 * left
        copy(state.area, room.area)
        copy(state.momentum, room.momentum)
        copy(state.rolling, room.rolling)
        _begin_pools(machine, state, room)
        _guess(state, room, dt)
        status, fastest, gap = _couple(machine, state, room, dt)
        passable = _PASSABLE if pace.share > _TINY or machine.pools.shape[0] == 0 else _PASSABLE_POOL
        if status == Outcome.NOT_COUPLED and pace.share <= _SHORT and gap <= passable:
            status = Outcome.DONE
        if status == Outcome.NOT_COUPLED and pace.share <= SHORTEST and _apart(machine, room, dt) <= _JUMP:
            status = Outcome.DONE
        if status == Outcome.TOO_LONG or (status == Outcome.NOT_COUPLED and pace.share > SHORTEST):
            copy(room.area, state.area)
            copy(room.momentum, state.momentum)
            copy(room.rolling, state.rolling)
            _restore_pools(state, room)
            pace.fastest, pace.share = max(pace.fastest, fastest), 0.5 * pace.share
            if pace.share < _LEAST:
                return status, taken
            continue
        if status != Outcome.DONE:
            if status == Outcome.NOT_COUPLED and _deepest(state) > _PILED:
                status = Outcome.AT_AXIS
            copy(room.area, state.area)
            copy(room.momentum, state.momentum)
            copy(room.rolling, state.rolling)
            _restore_pools(state, room)
            return status, taken
        _tally(machine, state, room, dt)
        _accept(state, room, dt, fastest)
        if machine.curve.shape[1] > 0:
            shaft.rate = (room.spins[1] - room.spins[0]) / dt
        shaft.time = stop if dt == left else shaft.time + dt
        sums.steps += 1.0
        watch(machine.watched, state.place, shaft, state.crest[0])
        if state.trace.shape[0] > 0:
            _keep(state, room, state.trace[int(pace.kept)])
            pace.kept += 1.0
        sums.disagreement = max(sums.disagreement, gap)
    return Outcome.DONE, taken
