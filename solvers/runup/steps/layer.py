"""A layer through a time step of a rotor that it is coupled to, and what its rotor feels of it.

Layers over their wall radius [theory: coupling, eq. 2-8].
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from solvers.layer.baffles import FACE, OPEN, taken
from solvers.layer.drag import FRICTION
from solvers.layer.finite_volume import COMPILED, GHOSTS, LOG, NEAREST, RATES, SUMMED, SURFACE, VELOCITY, WORK
from solvers.layer.records import Outcome, records
from solvers.layer.step import (
    bound_energy,
    calm,
    copy,
    correct,
    correct_energy,
    decelerate,
    predict,
    predict_energy,
    profile,
    stage_rates,
)
from solvers.machine_code import (
    BARE,
    HANDED,
    REAL,
    ROW,
    ROWS,
    WHOLE,
    handed_type,
    machine_code,
    pair,
    type_of,
)
from solvers.runup.state import GAINS, LAYER

_jit: Any = machine_code(**COMPILED)
_handed: Any = machine_code(**(COMPILED | HANDED))
_unwrapped: Any = machine_code(**(COMPILED | BARE))
_summed: Any = machine_code(**(SUMMED | BARE))


@_jit
def relative_momentum(measures, layer, spin, cosine, sine, out):
    """Momentum of a layer relative to its axis, in the standing frame [theory: coupling, eq. 3]."""
    scale = layer.weight * layer.radius**3
    x = measures.flow_x - spin * measures.moment_y
    y = measures.flow_y + spin * measures.moment_x
    out[0], out[1] = scale * (x * cosine - y * sine), scale * (x * sine + y * cosine)


@_unwrapped
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
def _half_friction(friction, area, q, spin, layer, drags, dt, full, slot, spare, gains):
    """Half a step of friction; the energy before and after, with the profile left in the scratch."""
    n, step = area.size, 2.0 * np.pi / area.size
    velocity, surface, log = spare[_VELOCITY, :n], spare[_SURFACE, :n], spare[_LOG, :n]
    kept, pushed, held = spare[_KEPT, :n], spare[_PUSHED, :n], spare[_HELD, :n]
    coefficient, thin, table = drags
    profile(area, q, spin, velocity, surface, log)
    copy(q, held)
    friction(
        *(area, velocity, surface, layer.law, coefficient, layer.lid, layer.plates, thin, layer.top, table),
        *(0.5 * dt, kept, pushed),
    )
    decelerate(area, q, spin, kept, pushed)
    torque, heat, before, after = _rub(
        area, q, held, velocity, log, kept, pushed, spin, full, slot * spin * spin
    )
    gains.torque += torque * step
    gains.work += spin * torque * step
    gains.heat += heat * step
    return before * step, after * step


@_handed
def layer_step(
    rates,
    friction,
    area,
    q,
    rolling,
    spins,
    force,
    layer,
    coefficient,
    thin,
    table,
    dt,
    angles,
    plates,
    full,
    slot,
    spare,
    gains,
):
    """Advance a layer by one time step, in place; a step that fails leaves nothing of use.

    Outcome.DONE, TOO_LONG or AT_AXIS, and the largest speed met. `rates` and `friction`: see
    `solvers.layer.finite_volume.RATES` and `solvers.layer.drag.FRICTION`. `spins` and `force` (body force
    over R in the drum frame, two parts each) at both ends; friction's `coefficient`, `thin` and `table` at
    these spins. The profile at the end is left in `spare`, results in `gains`, a record GAINS.
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
    _, gains.loss = _half_friction(friction, area, q, spins[0], layer, drags, dt, full, slot, spare, gains)
    copy(area, next_a)
    copy(q, next_q)
    copy(rolling, next_e)
    fastest = 0.0
    for stage in range(2):
        spin, x, y = spins[stage], force[2 * stage], force[2 * stage + 1]
        outcome, speed = stage_rates(
            *(rates, next_a, next_q, next_e, spin, euler, x, y, angles, plates, full, slot, dt, dispersion),
            *(pull_cell, pull_face, spare, rate_a, rate_q, rate_e),
        )
        fastest = max(fastest, speed)
        if outcome != Outcome.DONE:
            return outcome, fastest
        done, missed = _power(next_a, velocity, surface, log, rate_a, spin, x, y, angles[0], angles[1])
        gains.loss += 0.5 * dt * step * done
        gains.missed += 0.5 * dt * step * euler * missed
        held, power = taken(plates)
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
    energy, _ = _half_friction(friction, area, q, spins[1], layer, drags, dt, full, slot, spare, gains)
    gains.loss -= energy + gains.missed
    return Outcome.DONE, fastest


# Of `layer_step`.
LAYER_STEP: Any = handed_type(
    *(pair(WHOLE, REAL), RATES, FRICTION, ROW, ROW, ROW, ROW, ROW, type_of(records(LAYER)[0]), REAL, REAL),
    *(ROWS, REAL, ROWS, ROWS, REAL, REAL, ROWS, type_of(records(GAINS)[0])),
)
