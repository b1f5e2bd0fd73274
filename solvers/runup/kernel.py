"""Rotor and liquid layers through time together [theory: coupling].

Each step looks for the mean acceleration of every chamber's axis that makes the layers' change of momentum
and the rotor's trapezium agree: momentum is handed over to rounding, and the rotor's part is stable for any
stiffness. SI units; layers over their wall radius. Compiled by numba with its cache on disk.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

from fluid.friction import STOKES
from solvers.layer.finite_volume import (
    COMPILED,
    DRY,
    GHOSTS,
    NEAREST,
    WORK,
    faded_velocity,
    log_of_surface,
)
from solvers.layer.records import Outcome
from solvers.layer.step import calm, copy, correct, predict, stage_rates, surface_radius, wall_friction

_jit: Any = njit(**COMPILED)
_unwrapped: Any = njit(**(COMPILED | {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}))
# Parts of one function: compiled one by one and linked they would cost twice the time to compile.
_inner: Any = njit(inline="always")


@_jit
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


def layer_scratch(layers: int, cells: int) -> NDArray[np.float64]:
    """Scratch that `layer_step` wants for each of so many layers."""
    return np.zeros((layers, WORK + 9, cells + 2 * GHOSTS))


@_jit
def measure(area, q, spin, angles, spare, out):
    """Fill `out`, a record MEASURES, for a layer [theory: coupling, eq. 2, 4 and 7]."""
    n = area.size
    step = 2.0 * np.pi / n
    across, along, log = spare[WORK, :n], spare[WORK + 1, :n], spare[WORK + 2, :n]
    flow = spare[WORK + 3, :n]
    moment_x, moment_y, spinning, energy = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        u = faded_velocity(area[i], q[i], spin)
        log[i] = log_of_surface(area[i], r)
        across[i], along[i] = r * angles[0, i], r * angles[1, i]
        flow[i] = u * log[i]
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        moment_x += lever * angles[0, i] * step
        moment_y += lever * angles[1, i] * step
        whole = area[i] * (1.0 - area[i])
        spinning += (spin * whole + u * area[i]) * step
        energy += (0.5 * spin * spin * whole + spin * u * area[i] + 0.5 * u * u * log[i]) * step
    flow_x, flow_y, xx, xy, yy = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        after, before = i + 1 if i + 1 < n else 0, i - 1
        x, y = 0.5 * (across[after] - across[before]), 0.5 * (along[after] - along[before])
        flow_x += flow[i] * x
        flow_y += flow[i] * y
        xx += log[i] * x * x / step
        xy += log[i] * x * y / step
        yy += log[i] * y * y / step
    out.moment_x, out.moment_y, out.spinning, out.energy = moment_x, moment_y, spinning, energy
    out.flow_x, out.flow_y, out.xx, out.xy, out.yy = flow_x, flow_y, xx, xy, yy


@_unwrapped
def _energy(area, q, spin):
    """Energy of the flow in the frame that does not turn, over rho h_c R^4 [theory: coupling, eq. 7]."""
    total = 0.0
    for i in range(area.size):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        u = faded_velocity(area[i], q[i], spin)
        turning = spin * area[i] * (0.5 * spin * (1.0 - area[i]) + u)
        total += turning + 0.5 * u * u * log_of_surface(area[i], r)
    return total * 2.0 * np.pi / area.size


@_unwrapped
def _power(area, q, spin, euler, x, y, angles, rate_a, gains, dt):
    """Power of the body force in the frame that does not turn [theory: coupling, eq. 8].

    Adds what the flow's profile makes of the changing spin: the Euler force acts on the angular momentum,
    which the profile does not turn into energy to the last digit.
    """
    n = area.size
    step = 2.0 * np.pi / n
    moment_x, moment_y, rate_x, rate_y = 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        moment_x += lever * angles[0, i] * step
        moment_y += lever * angles[1, i] * step
        rate_x += r * angles[0, i] * rate_a[i] * step
        rate_y += r * angles[1, i] * rate_a[i] * step
        u, log = faded_velocity(area[i], q[i], spin), log_of_surface(area[i], r)
        gains.missed -= dt * step * euler * u * (area[i] - log * (1.0 - area[i]))
    return x * (rate_x - spin * moment_y) + y * (rate_y + spin * moment_x)


@_unwrapped
def _work(area, q, before, spin, step, gains):
    """Add what friction has done to the velocities: impulse of the wall's torque, and heat."""
    for i in range(area.size):
        a = area[i]
        if a <= DRY:
            continue
        r = np.maximum(surface_radius(a), NEAREST)
        u, v = faded_velocity(a, before[i], spin), faded_velocity(a, q[i], spin)
        gains.torque += a * (v - u) * step
        gains.heat += 0.5 * log_of_surface(a, r) * (u * u - v * v) * step


@_unwrapped
def layer_step(area, q, spins, force, layer, coefficient, dt, angles, spare, gains):
    """Advance a layer by one time step, in place; a step that fails leaves nothing to go on with.

    Parameters
    ----------
    area, q : state, shape (n,)
    spins : spin at the beginning and at the end
    force : body force over R in the drum frame at the beginning (two parts) and at the end (two)
    layer : its record LAYER
    coefficient : of its friction at these spins
    dt : time step
    angles : cosine and sine at the cells' middles and at their left faces, shape (4, n)
    spare : scratch of this layer, from `layer_scratch`
    gains : results, a record GAINS

    Returns
    -------
    Outcome.DONE, Outcome.TOO_LONG or Outcome.AT_AXIS; and the largest speed met
    """
    n = area.size
    step, euler = 2.0 * np.pi / n, (spins[1] - spins[0]) / dt
    law, lid, dispersion = layer.law, layer.lid, layer.dispersion
    pull_cell, pull_face = spare[WORK, :n], spare[WORK + 1, :n]
    rate_a, rate_q = spare[WORK + 4, :n], spare[WORK + 5, :n]
    next_a, next_q, before = spare[WORK + 6, :n], spare[WORK + 7, :n], spare[WORK + 8, :n]
    gains.torque, gains.heat, gains.loss, gains.missed = 0.0, 0.0, 0.0, 0.0
    copy(q, before)
    wall_friction(area, q, spins[0], law, coefficient, lid, 0.5 * dt)
    _work(area, q, before, spins[0], step, gains)
    copy(area, next_a)
    copy(q, next_q)
    gains.loss = _energy(area, q, spins[0])
    fastest = 0.0
    for stage in range(2):
        spin, x, y = spins[stage], force[2 * stage], force[2 * stage + 1]
        outcome, speed = stage_rates(
            next_a, next_q, spin, euler, x, y, angles, dt, dispersion,
            pull_cell, pull_face, spare, rate_a, rate_q,
        )  # fmt: skip
        fastest = max(fastest, speed)
        if outcome != Outcome.DONE:
            return outcome, fastest
        done = _power(next_a, next_q, spin, euler, x, y, angles, rate_a, gains, 0.5 * dt)
        gains.loss += 0.5 * dt * done
        if stage == 0:
            if not predict(area, q, rate_a, rate_q, dt, next_a, next_q):
                return Outcome.AT_AXIS, fastest
        else:
            correct(area, q, rate_a, rate_q, dt, next_a, next_q)
            calm(area, q, spin)
    gains.loss -= _energy(area, q, spins[1]) + gains.missed
    copy(q, before)
    wall_friction(area, q, spins[1], law, coefficient, lid, 0.5 * dt)
    _work(area, q, before, spins[1], step, gains)
    return Outcome.DONE, fastest


# A step is done once two estimates of the mean accelerations differ by this, relative to the largest. Where
# the drying edge of a layer makes them jump, the guess follows by halves after a few rounds; after the last
# the step is shortened, and the shortest may pass with what is left. Momentum is handed over all the same.
_AGREED, _PASSABLE, _STRAIGHT, _ROUNDS, _SHORTEST = 1e-6, 1e-2, 5, 12, 1.0 / 32.0
# Steps shortened by more than this no longer follow what the layers do.
_LEAST = 1e-6


@_inner
def _move_layers(machine, state, room, dt):
    """All layers through one step under the guessed accelerations; what went wrong, the fastest wave."""
    fastest, spins, turn, force = 0.0, room.spins, room.turn, room.force
    copy(room.area, state.area)
    copy(room.momentum, state.momentum)
    for j in range(machine.layers.shape[0]):
        layer = machine.layers[j]
        x = (machine.gravity[0] - room.guess[j, 0]) / layer.radius
        y = (machine.gravity[1] - room.guess[j, 1]) / layer.radius
        for end in range(2):
            cosine, sine = turn[2 * end], turn[2 * end + 1]
            force[2 * end], force[2 * end + 1] = x * cosine + y * sine, y * cosine - x * sine
        coefficient = layer.coefficient
        if layer.law == STOKES:
            # Stokes' friction at the frequency of a free wave goes with the root of the spin.
            coefficient *= np.sqrt(0.5 * (spins[0] + spins[1]))
        status, speed = layer_step(
            *(state.area[j], state.momentum[j], spins, force, layer, coefficient, dt, machine.angles),
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
        measure(state.area[j], state.momentum[j], spins[1], machine.angles, room.spare[j], room.end[j])
        relative_momentum(room.begin[j], layer, spins[0], turn[0], turn[1], room.before[j])
        relative_momentum(room.end[j], layer, spins[1], turn[2], turn[3], room.after[j])
        flow_inertia(room.begin[j], layer, cosine / size, sine / size, room.inertia[j])


@_unwrapped
def _move_rotor(machine, state, room, dt):
    """Change of the rotor's velocities over the step, given the layers' momenta [theory: coupling, eq. 5]."""
    change, swing, left, turn = room.change, room.swing, room.left, room.turn
    n, spin = change.size, 0.5 * (room.spins[0] + room.spins[1])
    for i in range(n):
        first = machine.unbalance[i] * complex(turn[0], turn[1])
        last = machine.unbalance[i] * complex(turn[2], turn[3])
        swing[i] = room.spins[0] * first.imag - room.spins[1] * last.imag
        change[i] = -swing[i]
        for k in range(n):
            damping = machine.matrices[1, i, k] + spin * machine.matrices[2, i, k]
            stiffness = machine.matrices[3, i, k]
            left[i, k] = machine.matrices[0, i, k] + 0.5 * dt * damping + 0.25 * dt * dt * stiffness
            x, v = state.place[k], state.rate[k]
            change[i] -= dt * (damping * v + stiffness * (x + 0.5 * dt * v))
    for j in range(machine.layers.shape[0]):
        mass, b, guess = machine.layers[j].mass, machine.planes[j], room.guess[j]
        xx, xy, yy = room.inertia[j, 0], room.inertia[j, 1], room.inertia[j, 2]
        given_x = room.after[j, 0] - room.before[j, 0] + dt * (xx * guess[0] + xy * guess[1])
        given_y = room.after[j, 1] - room.before[j, 1] + dt * (xy * guess[0] + yy * guess[1])
        for i in range(n):
            change[i] -= b[0, i] * given_x + b[1, i] * given_y
            for k in range(n):
                left[i, k] += (mass - xx) * b[0, i] * b[0, k] + (mass - yy) * b[1, i] * b[1, k]
                left[i, k] -= xy * (b[0, i] * b[1, k] + b[1, i] * b[0, k])
    solve(left, change)


@_unwrapped
def _disagreement(machine, room, dt):
    """Mean accelerations that the rotor's change means; their distance from the guess, and their size."""
    gap, size, spin = 0.0, 0.0, room.spins[0]
    for j in range(machine.layers.shape[0]):
        for i in range(2):
            total = 0.0
            for k in range(room.change.size):
                total += machine.planes[j, i, k] * room.change[k]
            room.found[j, i] = total / dt
            gap = max(gap, abs(room.found[j, i] - room.guess[j, i]))
            size = max(size, abs(room.found[j, i]), 1e-6 * spin * spin * machine.layers[j].radius)
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
    after = spin
    for _ in range(4):
        after = spin + (dt * motor_torque(machine.curve, 0.5 * (spin + after)) - load) / shaft.inertia
    return after


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
        sums.drive += spin * scale * gains.torque
        for i in range(2):
            sums.gravity += 0.5 * dt * machine.gravity[i] * (room.before[j, i] + room.after[j, i])
        sums.friction += scale * gains.heat
        sums.bores += scale * gains.loss
        sums.profile += scale * gains.missed
    if machine.curve.shape[1] > 0:
        sums.motor += dt * spin * motor_torque(machine.curve, spin)


@_inner
def _couple(machine, state, room, dt):
    """One step tried until rotor and layers agree; what went wrong, the fastest wave, what is left."""
    shaft = state.shaft[0]
    spin, angle, fastest = shaft.spin, shaft.angle, 0.0
    room.spins[0], room.spins[1] = spin, spin
    if machine.curve.shape[1] == 0:
        room.spins[1] = spin + shaft.rate * dt
    left = 0.0
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
            return Outcome.STOPPED, fastest, left
        left = max(left, abs(after - room.spins[1]) / spin)
        if left <= _AGREED:
            return Outcome.DONE, fastest, left
        if tried == _ROUNDS - 1:
            break
        share = 1.0 if tried < _STRAIGHT else 0.5
        for j in range(room.guess.shape[0]):
            for i in range(2):
                room.guess[j, i] += share * (room.found[j, i] - room.guess[j, i])
        room.spins[1] = after
    return Outcome.NOT_COUPLED, fastest, left


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
    shaft.angle += 0.5 * (room.spins[0] + room.spins[1]) * dt
    shaft.spin = room.spins[1]
    for j in range(room.guess.shape[0]):
        for i in range(2):
            state.push[j, 1, i] = state.push[j, 0, i]
            state.push[j, 0, i] = room.found[j, i]
        room.begin[j] = room.end[j]
    pace.before, pace.last, pace.fastest, pace.share = pace.last, dt, fastest, min(1.0, 1.5 * pace.share)


@_jit
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
    """Advance rotor and layers to a time.

    Parameters
    ----------
    machine, state, room : `solvers.runup.state`'s; the state is changed in place
    stop : s
    courant : Courant number; the rotor turns in a step by at most this share of a cell
    most : most steps
    resumed : the call before ended with RAN_OUT, and nothing has changed since

    Every step is written down in the state's trace if that has rows: as many as there are steps.

    Returns
    -------
    Outcome.DONE, AT_AXIS, RAN_OUT, TOO_LONG, NOT_COUPLED (the accelerations did not agree in the
    shortest steps) or STOPPED (the motor stands); and the steps tried
    """
    shaft, pace, sums = state.shaft[0], state.pace[0], state.sums[0]
    cell, taken = 2.0 * np.pi / machine.angles.shape[1], 0
    if not resumed:
        for j in range(room.guess.shape[0]):
            measure(
                *(state.area[j], state.momentum[j], shaft.spin, machine.angles, room.spare[j]), room.begin[j]
            )
    while shaft.time < stop:
        if shaft.spin <= 0.0:
            return Outcome.STOPPED, taken
        if taken >= most:
            return Outcome.RAN_OUT, taken
        taken += 1
        left = stop - shaft.time
        dt = pace.share * courant * cell / max(1.1 * pace.fastest, shaft.spin)
        # The last two steps share what is left, so that none is a sliver.
        if dt >= left:
            dt = left
        elif dt > 0.5 * left:
            dt = 0.5 * left
        copy(state.area, room.area)
        copy(state.momentum, room.momentum)
        _guess(state, room, dt)
        status, fastest, gap = _couple(machine, state, room, dt)
        if status == Outcome.NOT_COUPLED and pace.share <= _SHORTEST and gap <= _PASSABLE:
            status = Outcome.DONE
        if status == Outcome.TOO_LONG or (status == Outcome.NOT_COUPLED and pace.share > _SHORTEST):
            copy(room.area, state.area)
            copy(room.momentum, state.momentum)
            pace.fastest, pace.share = max(pace.fastest, fastest), 0.5 * pace.share
            if pace.share < _LEAST:
                return status, taken
            continue
        if status != Outcome.DONE:
            copy(room.area, state.area)
            copy(room.momentum, state.momentum)
            return status, taken
        _tally(machine, state, room, dt)
        _accept(state, room, dt, fastest)
        shaft.time = stop if dt == left else shaft.time + dt
        sums.steps += 1.0
        watch(machine.watched, state.place, shaft, state.crest[0])
        if state.trace.shape[0] > 0:
            _keep(state, room, state.trace[int(pace.kept)])
            pace.kept += 1.0
        sums.disagreement = max(sums.disagreement, gap)
    return Outcome.DONE, taken
