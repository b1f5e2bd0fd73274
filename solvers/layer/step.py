"""Time steps of a finite-volume layer: their parts, and a layer's way under a prescribed whirl.

Heun's method in two stages between two half steps of friction, exact but for the law of the wall
[theory: long_wave, eq. 11]. The coupled machine takes the parts and puts its own forces to them. Lengths over
R, times in the unit of the spin given.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from fluid import long_wave
from meshes.arrays import Array
from solvers.layer.drag import FRICTION, friction_of
from solvers.layer.finite_volume import (
    COMPILED,
    DRY,
    FULL,
    GHOSTS,
    MOST_ROLLER,
    NEAREST,
    NO_ROLLER,
    RATES,
    SUMMED,
    THIN,
    WORK,
    faded_velocity,
    log_of_surface,
    rates_of,
)
from solvers.layer.inside import NOTHING, Inside
from solvers.layer.records import LOADS, PACE, Drive, Outcome, Record, Wall, records
from solvers.machine_code import BARE, REAL, ROW, ROWS, WHOLE, entry, handed, machine_code, type_of
from solvers.slices import FASTEST, RUNAWAY, compiled, slices, step_budget

_jit: Any = machine_code(**COMPILED)
_part: Any = machine_code(**(COMPILED | BARE))
_sum_part: Any = machine_code(**(SUMMED | BARE))
_sum_jit: Any = machine_code(**SUMMED)

# Courant number beyond which a step is taken again.
LARGEST = 1.0

surface_radius = _part(long_wave.free_surface_radius)
_wall = _part(long_wave.wall_pressure)


@_part
def copy(source, target):
    """Copy an array element by element: compiled code here may not ask for memory, as slices would."""
    to, of = target.reshape(-1), source.reshape(-1)
    for i in range(of.size):
        to[i] = of[i]


@_part
def profile(area, q, spin, velocity, surface, log):
    """Fill velocity, radius of the surface (at least 0.03) and L of each cell; arrays of one shape."""
    for i in range(area.size):
        surface[i] = np.maximum(surface_radius(area[i]), NEAREST)
        velocity[i] = faded_velocity(area[i], q[i], spin)
        log[i] = log_of_surface(area[i], surface[i])


@_part
def wall_friction(friction, area, q, spin, wall, dt, spare):
    """Friction alone over a time dt; `spare`: scratch of at least four rows."""
    n = area.size
    velocity, surface, kept, pushed = spare[0, :n], spare[1, :n], spare[2, :n], spare[3, :n]
    for i in range(n):
        surface[i] = surface_radius(area[i])
        velocity[i] = (q[i] + spin * area[i] * area[i]) / np.maximum(area[i], DRY)
    friction(
        *(area, velocity, surface, wall.law, wall.coefficient, wall.lid, wall.plates, wall.thin, wall.top),
        *(wall.table, dt, kept, pushed),
    )
    decelerate(area, q, spin, kept, pushed)


@_part
def decelerate(area, q, spin, kept, pushed):
    """Leave each cell this share of its velocity, then add to it; dry ones keep none."""
    for i in range(area.size):
        square = spin * area[i] * area[i]
        moved = (q[i] + square) * kept[i]
        q[i] = (moved if area[i] > DRY else 0.0) - square
        q[i] += area[i] * pushed[i] if area[i] > DRY else 0.0


@_part
def calm(area, q, spin):
    """Leave films the momentum of their faded velocity, which no front exceeds: the rest goes to the wall.

    No front runs ahead at twice the speed of the drum; films may go twice as fast as that. Returns the sum of
    what they gain.
    """
    most, gained = FASTEST * abs(spin), 0.0
    for i in range(area.size):
        a = area[i]
        u = np.minimum(np.maximum(faded_velocity(a, q[i], spin), -most), most)
        now = (u - spin * a) * a if a < THIN else q[i]
        gained += now - q[i]
        q[i] = now
    return gained


@_part
def predict(area, q, rate_a, rate_q, dt, next_a, next_q):
    """Euler step; whether the surface stays off the axis and every number is finite."""
    wrong = 0
    for i in range(area.size):
        next_a[i] = np.maximum(area[i] + dt * rate_a[i], 0.0)
        next_q[i] = q[i] + dt * rate_q[i]
        # Written so that nan is wrong too.
        sound = area[i] < FULL and next_a[i] < FULL and abs(next_q[i]) < np.inf
        wrong += 0 if sound else 1
    return wrong == 0


@_part
def predict_energy(energy, rate, dt, next_energy):
    """Euler step of the energy of the fluctuations, none below zero."""
    for i in range(energy.size):
        next_energy[i] = np.maximum(energy[i] + dt * rate[i], 0.0)


@_part
def correct_energy(energy, rate, dt, next_energy):
    """Second stage of Heun's method for the energy of the fluctuations."""
    for i in range(energy.size):
        energy[i] = 0.5 * (energy[i] + np.maximum(next_energy[i] + dt * rate[i], 0.0))


@_part
def bound_energy(area, energy, spin):
    """Take from the fluctuations what their cell cannot hold."""
    for i in range(energy.size):
        most = MOST_ROLLER * spin * spin * area[i] * area[i] if area[i] > NO_ROLLER else 0.0
        energy[i] = np.minimum(energy[i], most)


@_part
def correct(area, q, rate_a, rate_q, dt, next_a, next_q):
    """Second stage of Heun's method."""
    for i in range(area.size):
        area[i] = 0.5 * (area[i] + np.maximum(next_a[i] + dt * rate_a[i], 0.0))
        q[i] = 0.5 * (q[i] + next_q[i] + dt * rate_q[i])


@_part
def pull(x, y, angles, pull_cell, pull_face):
    """Radial part of a uniform body force at cells and faces."""
    for i in range(pull_cell.size):
        pull_cell[i] = x * angles[0, i] + y * angles[1, i]
        pull_face[i] = x * angles[2, i] + y * angles[3, i]


@_part
def stage_rates(
    rates,
    area,
    q,
    energy,
    spin,
    euler,
    x,
    y,
    angles,
    plates,
    full,
    slot,
    dt,
    dispersion,
    pull_cell,
    pull_face,
    spare,
    rate_a,
    rate_q,
    rate_e,
):
    """Rates of change at one stage of a time step, for callers that are compiled themselves.

    `energy` is A e of the fluctuations behind bores, (n,) or (0,); x, y the body force in the drum frame;
    `angles` cosine and sine at the cells' middles and at their left faces, (4, n); `dt` 0 where only the
    fastest wave is asked for. Returns Outcome.DONE, AT_AXIS, or TOO_LONG where the step is to be taken again,
    and the fastest wave.
    """
    step = 2.0 * np.pi / area.size
    pull(x, y, angles, pull_cell, pull_face)
    fastest = rates(
        *(area, q, energy, spin, euler, pull_cell, pull_face, plates, full, slot, step, dt, dispersion),
        *(spare, rate_a, rate_q, rate_e),
    )
    outcome = Outcome.DONE
    if not fastest < np.inf:
        outcome = Outcome.AT_AXIS
    elif dt * fastest > LARGEST * step:
        outcome = Outcome.TOO_LONG
    return outcome, fastest


def scratch(cells: int) -> NDArray[np.float64]:
    """Scratch of `advance` for a ring of so many cells."""
    return np.zeros((WORK + 9, cells + 2 * GHOSTS))


@_part
def _whirl(time, drive):
    """Body force in the drum frame: minus the axis' acceleration, and gravity across the axis.

    The amplitude grows as tau - sin(2 pi tau)/(2 pi), tau = time/ramp; its rate of change is left out of the
    acceleration [theory: long_wave, eq. 8].
    """
    slip, ramp = drive.slip, drive.ramp
    grown = 1.0
    if time < ramp:
        grown = time / ramp - np.sin(2.0 * np.pi * time / ramp) / (2.0 * np.pi)
    push = drive.amplitude * drive.whirl * drive.whirl * grown
    x = push * np.cos(slip * time) - drive.weight * np.sin(drive.spin * time)
    y = push * np.sin(slip * time) - drive.weight * np.cos(drive.spin * time)
    return x, y


@_sum_part
def _cell_loads(area, q, spin, pull, cosine, sine, full, slot):
    """Sums over the cells: pressure on walls, first moment, both along two directions; area; mass flux."""
    force_x, force_y, moment_x, moment_y, total, turned = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(area.size):
        r = np.maximum(surface_radius(area[i]), NEAREST)
        u, log = faded_velocity(area[i], q[i], spin), log_of_surface(area[i], r)
        # What a full gap is under presses on the inner wall as well, against the outer one.
        pressed = slot * np.maximum(area[i] - full, 0.0) * (1.0 - r)
        pressure = _wall(u, log, area[i], r, spin, pull[i]) + pressed
        lever = (1.0 - r) * (1.0 + r + r * r) / 3.0
        force_x += pressure * cosine[i]
        force_y += pressure * sine[i]
        moment_x += lever * cosine[i]
        moment_y += lever * sine[i]
        total += area[i]
        turned += u * log
    return force_x, force_y, moment_x, moment_y, total, turned


@_sum_part
def _bounds(values):
    least, largest = values[0], values[0]
    for i in range(values.size):
        least = values[i] if values[i] < least else least
        largest = values[i] if values[i] > largest else largest
    return least, largest


@_jit
def centre(area, angles):
    """Centre of mass of the layer from the drum's axis, x and y in the drum frame; nan without liquid.

    An area below zero counts as dry.
    """
    x, y, total = 0.0, 0.0, 0.0
    for i in range(area.size):
        a = np.maximum(area[i], 0.0)
        r = surface_radius(a)
        # (1 - r^3)/3, without cancellation in thin films.
        moment = 2.0 / 3.0 * a * (1.0 + r + r * r) / (1.0 + r)
        x += moment * angles[0, i]
        y += moment * angles[1, i]
        total += a
    return x / total, y / total


@_jit
def tally(area, q, spin, pull, angles, cosine, sine, share, full, slot, sums):
    """Add a time's share of the loads to the record of `advance`.

    `full` is the area of the full gap and `slot` the rise of its head with what is more. Forces and offsets
    are turned into the frame of the deflection, at an angle of this cosine and sine.
    """
    force_x, force_y, moment_x, moment_y, total, turned = _cell_loads(
        area, q, spin, pull, angles[0], angles[1], full, slot
    )
    least, largest = _bounds(area)
    part, step = share / total, share * 2.0 * np.pi / area.size
    sums.force_x += (force_x * cosine + force_y * sine) * step
    sums.force_y += (force_y * cosine - force_x * sine) * step
    sums.offset_x += (moment_x * cosine + moment_y * sine) * part
    sums.offset_y += (moment_y * cosine - moment_x * sine) * part
    sums.turning += turned * part
    sums.depth_min += (1.0 - surface_radius(least)) * share
    sums.depth_max += (1.0 - surface_radius(largest)) * share


@_jit
def advance(
    rates, friction, area, q, energy, pace, stop, drive, wall, angles, inside, courant, most, spare, loads
):
    """Advance a layer under a prescribed whirl, in place, and add its loads to `loads`.

    `rates` and `friction`: see `solvers.layer.finite_volume.RATES` and `solvers.layer.drag.FRICTION`.
    `energy` is A e of the fluctuations behind bores, (n,), or (0,) without them; `pace` a record PACE, how
    far it has come: after RAN_OUT the next call goes on as if there had been none between. `angles` as of
    `stage_rates`; rows of the scratch `spare` are reused. Returns Outcome, and the steps tried.
    """
    n = area.size
    step = 2.0 * np.pi / n
    slip, spin, sums = drive.slip, drive.spin, loads[0]
    dispersion = wall.dispersion
    pull_cell, pull_face = spare[WORK, :n], spare[WORK + 1, :n]
    rate_a, rate_q = spare[WORK + 2, :n], spare[WORK + 3, :n]
    next_a, next_q, begin_q = spare[WORK + 4, :n], spare[WORK + 5, :n], spare[WORK + 6, :n]
    next_e, rate_e = spare[WORK + 7, : energy.size], spare[WORK + 8, : energy.size]
    time, steps, dt, fastest = pace[0].time, 0, 0.0, pace[0].fastest
    # 0: only the largest speed is asked for; 1 and 2: the two stages of Heun's method.
    stage = 1 if fastest > 0.0 else 0
    while time < stop:
        if stage == 1 and steps >= most:
            pace[0].time, pace[0].fastest = time, fastest
            return Outcome.RAN_OUT, steps
        if stage == 1:
            # The speed may have grown since it was taken: a tenth is kept in hand.
            dt = min(courant * step / (1.1 * fastest), stop - time)
            for i in range(n):
                begin_q[i] = q[i]
            wall_friction(friction, area, q, spin, wall, 0.5 * dt, spare)
        if stage < 2:
            for i in range(n):
                next_a[i], next_q[i] = area[i], q[i]
            for i in range(energy.size):
                next_e[i] = energy[i]
        x, y = _whirl(time + dt if stage == 2 else time, drive)
        limit = dt if stage > 0 else 0.0
        outcome, fastest = stage_rates(
            *(
                rates,
                next_a,
                next_q,
                next_e,
                spin,
                0.0,
                x,
                y,
                angles,
                inside.plates,
                inside.full,
                inside.slot,
            ),
            *(limit, dispersion, pull_cell, pull_face, spare, rate_a, rate_q, rate_e),
        )
        if outcome == Outcome.AT_AXIS:
            return outcome, steps
        if stage < 2 and fastest > RUNAWAY * abs(spin):
            return Outcome.RAN_AWAY, steps
        if outcome == Outcome.TOO_LONG:
            # A film has run faster than the step allows: once more, shorter.
            for i in range(n):
                q[i] = begin_q[i]
            stage = 1
            steps += 1
            continue
        if stage == 1:
            if not predict(area, q, rate_a, rate_q, dt, next_a, next_q):
                return Outcome.AT_AXIS, steps
            predict_energy(energy, rate_e, dt, next_e)
        elif stage == 2:
            x, y = _whirl(time, drive)
            pull(x, y, angles, pull_cell, pull_face)
            cosine, sine = np.cos(slip * time), np.sin(slip * time)
            slot = inside.slot * spin * spin
            tally(area, begin_q, spin, pull_cell, angles, cosine, sine, dt, inside.full, slot, sums)
            sums.push_x += (x * cosine + y * sine) * dt
            sums.push_y += (y * cosine - x * sine) * dt
            correct(area, q, rate_a, rate_q, dt, next_a, next_q)
            correct_energy(energy, rate_e, dt, next_e)
            bound_energy(area, energy, spin)
            calm(area, q, spin)
            wall_friction(friction, area, q, spin, wall, 0.5 * dt, spare)
            time += dt
            steps += 1
        stage = 2 if stage == 1 else 1
    pace[0].time, pace[0].fastest = time, fastest
    return Outcome.DONE, steps


# Of `advance`.
ADVANCE = (
    *(RATES, FRICTION, ROW, ROW, ROW, type_of(records(PACE)), REAL, type_of(Drive(*[0.0] * 6))),
    *(type_of(Wall(0, 0.0, 0.0, False)), ROWS, type_of(NOTHING), REAL, WHOLE, ROWS, type_of(records(LOADS))),
)


def stepper(wall: Wall, inside: Inside, enstrophy: bool) -> tuple[Any, Any, Any]:
    """`advance` and its first two arguments for a layer with these features."""
    rates = handed(rates_of(inside.plates, wall.dispersion, enstrophy), RATES)
    return entry(advance, *ADVANCE), rates, friction_of(wall.law)


def march(
    area: Array,
    q: Array,
    start: float,
    stop: float,
    drive: Drive,
    wall: Wall,
    angles: Array,
    courant: float,
    spare: Array,
    loads: Record,
    most: int | None = None,
    energy: Array | None = None,
    inside: Inside = NOTHING,
) -> tuple[Outcome, int]:
    """`advance` from one time to another in slices, between which Python sees a Ctrl-C.

    At most `most` steps, by default `solvers.slices.step_budget`. Returns Outcome, and the steps tried.
    """
    pace, outcome, taken = records(PACE), Outcome.RAN_OUT, 0
    pace[0].time = start
    rolling = np.empty(0) if energy is None else energy
    if most is None:
        most = step_budget(stop - start, drive.spin, area.size, courant)
    going = stepper(wall, inside, rolling.size > 0)
    for steps in slices(most, area.size):
        reached, tried = compiled(
            *(*going, area, q, rolling, pace, stop, drive, wall, angles, inside),
            *(courant, steps, spare, loads),
        )
        outcome, taken = Outcome(reached), taken + tried
        if outcome is not Outcome.RAN_OUT:
            break
    return outcome, taken
