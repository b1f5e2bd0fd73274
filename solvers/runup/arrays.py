"""Many run-ups as one array program by jax, on the processor or a GPU, in double precision.

The steps of `solvers.runup.steps` and the finite volumes of `solvers.layer` once more, for arrays: cells
stand first and machines, the lanes, last, so that a number of a machine meets all its cells as it is. Every
lane has time steps of its own, and one pass takes each through a round of its present step; a lane that has
ended rests until the next machine takes its place. jax is imported here alone.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any, NamedTuple

import jax
import numpy as np
from jax import lax
from jax import numpy as jnp

from fluid.friction.laws import QUADRATIC, STOKES, WALL, damping_rate
from fluid.long_wave import mass_flux, momentum_flux, pressure_force, static_head
from meshes.arrays import Array, Complex
from meshes.errors import InputError
from solvers.layer.finite_volume import DRY, FULL, HELD, NEAREST, PRESSED, THIN
from solvers.layer.inside import SLOT_SPEED
from solvers.layer.records import Outcome
from solvers.layer.state import ring
from solvers.layer.step import LARGEST
from solvers.runup.ensemble import EnsembleTask
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Ramp
from solvers.runup.samples import highest, known_legs
from solvers.runup.steps.coupled import (
    AGREED,
    FILLS,
    LEAST,
    PASSABLE,
    PILED,
    ROUNDS,
    SHORT,
    SHORTEST,
    STRAIGHT,
)
from solvers.slices import FASTEST, SLICE, step_budget

_GOING, _NOTHING = -1, 1e-300
# Compiled loops take lanes in groups of up to so many, and the rest in another way, which rounds otherwise.
GROUP = 32
_MEASURED = ("moment_x", "moment_y", "flow_x", "flow_y", "xx", "xy", "yy")


class Given(NamedTuple):
    """What stays of each of w lanes; n coordinates, l layers, k times. Fields as of `solvers.runup.state`."""

    matrices: Any  #: (4, n, n, w)
    unbalance: Any  #: real and imaginary part, (2, n, w)
    planes: Any  #: (l, 2, n, w)
    watched: Any  #: (2, n, w)
    masses: Any  #: (l, w), and so the next eight
    radius: Any
    weight: Any
    coefficient: Any
    lid: Any
    plates: Any
    thin: Any
    top: Any
    gaps: Any
    tables: Any  #: (m, 2, l, w)
    stops: Any  #: (k, w)
    rates: Any
    legs: Any  #: how many of the times are a lane's, (w,)
    courant: Any
    most: Any  #: steps it may try
    one: Any  #: 1: see `keep`


class Now(NamedTuple):
    """What changes of each lane. Fields as of `solvers.runup.state`, shapes (w,) where none is given."""

    place: Any  #: (n, w)
    rate: Any
    area: Any  #: (c, l, w)
    momentum: Any
    begin: Any  #: measures of the layers at the step's beginning, (7, l, w)
    push: Any  #: accelerations over the last three steps, the latest first, (3, l, 2, w)
    spin: Any
    angle: Any
    time: Any
    last: Any
    before: Any
    older: Any
    fastest: Any
    share: Any
    crest: Any  #: amplitude, speed and time, (3, w)
    leg: Any
    status: Any  #: Outcome, or -1
    steps: Any  #: made, tried, and rounds, (3, w)
    #: of the step that is being tried: its round, guess and miss, (l, 2, w), and the guess's share
    tried: Any
    guess: Any
    miss: Any
    relaxed: Any
    #: at each time that was reached: time, speed, angle, crest, coordinates, least and largest area of each
    #: layer, (k, 6 + n + 2 l, w)
    moments: Any


def around(values, cells):
    """A ring with so many of its cells once more beyond either end: what lies beside a cell is a slice."""
    return lax.optimization_barrier(jnp.concatenate([values[-cells:], values, values[:cells]]))


def keep(one, values):
    """The same values, worked out once: XLA repeats for each reader what costs less than a division."""
    return jax.tree.map(lambda value: value / (one + 0.0 * value), values)


def profile(area, q, spin):
    """Velocity, faded out in films, radius of the surface (at least 0.03) and L of each cell."""
    square = area * area
    faded = 2.0 * (q + spin * square) * area / (square + jnp.maximum(square, THIN * THIN))
    surface = jnp.maximum(jnp.sqrt(jnp.maximum(1.0 - 2.0 * area, 0.0)), NEAREST)
    return jnp.where(area > DRY, faded, 0.0), surface, _log(area)


def _log(area):
    """L = ln(1/r), of a surface no nearer to the axis than 0.03."""
    return -0.5 * jnp.log1p(-jnp.minimum(2.0 * area, 1.0 - NEAREST**2))


def _half_slope(back, ahead):
    """Half of a cell's slope, monotonised central, 0 where the cell is a crest."""
    size = jnp.minimum(0.25 * abs(back + ahead), jnp.minimum(abs(back), abs(ahead)))
    return jnp.where(back * ahead > 0.0, jnp.where(back + ahead > 0.0, size, -size), 0.0)


def half_slopes(area, head, velocity, spin, held, full, slot):
    """Half of the slopes of all cells but both ends, limited wave by wave [theory: long_wave, eq. 3]."""
    before, here, after = area[:-2], area[1:-1], area[2:]
    least, most = jnp.minimum(jnp.minimum(before, here), after), jnp.maximum(jnp.maximum(before, here), after)
    wet = (least > DRY) & ((most <= full) | (least > full))
    length = jnp.where(wet, _log(here), 1.0)
    whole = spin + velocity[1:-1] / jnp.maximum(1.0 - 2.0 * here, NEAREST**2)
    stiff = jnp.where(here > full, slot, 0.0)
    carried, weight = spin * length, (held * held + stiff) * length
    half = jnp.sqrt(carried * carried + length * (whole * whole + stiff))
    ahead, behind = carried + half, carried - half
    head_1, head_2 = head[1:-1] - head[:-2], head[2:] - head[1:-1]
    velocity_1 = weight * (velocity[1:-1] - velocity[:-2])
    velocity_2 = weight * (velocity[2:] - velocity[1:-1])
    first = _half_slope(velocity_1 - behind * head_1, velocity_2 - behind * head_2)
    second = _half_slope(ahead * head_1 - velocity_1, ahead * head_2 - velocity_2)
    half_head = jnp.where(wet, 0.5 * (first + second) / half, 0.0)
    return half_head, jnp.where(wet, 0.5 * (ahead * first + behind * second) / (half * weight), 0.0)


def side(cell_area, head, velocity, bed, spin, held, full, slot):
    """On one side of each face: area, q, fluxes of mass and q, the pressure in it, both waves' speeds."""
    wet, square = cell_area > DRY, held * held
    rim = jnp.where(full < 0.5, jnp.sqrt(jnp.maximum(1.0 - 2.0 * full, 0.0)), -1.0)
    root = jnp.sqrt(jnp.maximum(bed * bed + square * (square - 2.0 * head), 0.0))
    level = jnp.clip((root - bed) / square, NEAREST, 1.0)
    # Beyond the full gap the head is that of the slot [theory: long_wave, eq. 18].
    pressed = full + (head - square * full + rim * bed) / (slot + square + bed / rim)
    beyond = jnp.sqrt(jnp.maximum(1.0 - 2.0 * pressed, NEAREST**2))
    r = jnp.where(wet, jnp.where(level < rim, beyond, level), 1.0)
    u = jnp.where(wet, velocity, 0.0)
    a = 0.5 * (1.0 - r) * (1.0 + r)
    log, inverse = _log(a), 1.0 / (r * r)
    stiff = jnp.where(a > full, slot, 0.0)
    push = pressure_force(a, r, spin, bed) + 0.5 * stiff * (a - full) * (a + full)
    whole, carried = spin + u * inverse, spin * log
    quick = jnp.where(2.0 * cell_area > full, stiff, 0.0)
    half = jnp.sqrt(carried * carried + log * (whole * whole + 4.0 * quick))
    mean = u * inverse + carried
    flow = momentum_flux(u, log, a, inverse) + push
    return a, u * a - spin * a * a, mass_flux(u, log), flow, push, mean - half, mean + half


def rates(area, q, spin, euler, force, angles, full, dt, one):
    """Rates of change of A and q, and the largest speed, as by `solvers.layer.finite_volume.plain_rates`."""
    step, slot = 2.0 * math.pi / area.shape[0], SLOT_SPEED**2 * spin * spin
    inertia, relative = (area * (1.0 - area)).sum(0), (q + spin * area * area).sum(0)
    held = jnp.maximum(abs(spin), HELD * abs(spin + relative / jnp.maximum(inertia, _NOTHING)))
    wide, pull = around(area, 3), keep(one, force[0] * angles[0] + force[1] * angles[1])
    surface = jnp.sqrt(jnp.maximum(1.0 - 2.0 * wide, 0.0))
    head = static_head(wide, surface, held, pull) + slot * jnp.maximum(wide - full, 0.0)
    head, velocity = keep(one, (head, profile(wide, around(q, 3), spin)[0]))
    half_head, half_velocity = keep(one, half_slopes(wide, head, velocity, spin, held, full, slot))
    # Faces from the left one of the cell before the first; next to a dry cell the higher bed.
    ends, before, after = slice(2, -1), slice(1, -2), slice(2, -1)
    bed = force[0] * angles[2, ends] + force[1] * angles[3, ends]
    wet = jnp.minimum(wide[before], wide[after]) > DRY
    bed = keep(one, jnp.where(wet, bed, jnp.minimum(pull[before], pull[after])))
    field = bed, spin, held, full, slot
    left = side(wide[before], head[before] + half_head[:-1], velocity[before] + half_velocity[:-1], *field)
    right = side(wide[after], head[after] - half_head[1:], velocity[after] - half_velocity[1:], *field)
    area_l, q_l, mass_l, flow_l, push_l, back_l, ahead_l = keep(one, left)
    area_r, q_r, mass_r, flow_r, push_r, back_r, ahead_r = keep(one, right)
    # A front on a dry bed runs ahead of the liquid at twice the waves' speed relative to it.
    slow = jnp.where(area_l == 0.0, 1.5 * back_r - 0.5 * ahead_r, jnp.minimum(back_l, back_r))
    fast = jnp.where(area_r == 0.0, 1.5 * ahead_l - 0.5 * back_l, jnp.maximum(ahead_l, ahead_r))
    slow, fast = jnp.minimum(slow, 0.0), jnp.maximum(fast, 0.0)
    # Fluxes of Harten, Lax and van Leer.
    width = 1.0 / (fast - slow + _NOTHING)
    left, right, both = fast * width, slow * width, fast * slow * width
    mass = left * mass_l - right * mass_r + both * (area_r - area_l)
    flow = left * flow_l - right * flow_r + both * (q_r - q_l)
    mass, flow = keep(one, (mass, flow))
    speed = jnp.maximum(fast, -slow)
    speed = jnp.where(speed < jnp.inf, speed, jnp.inf).max(0)
    fastest = jnp.where(area.max(0) > full, PRESSED, 1.0) * speed
    # No cell loses more than it has, and what flows takes its momentum along.
    lost = dt / step * (jnp.maximum(mass[1:], 0.0) - jnp.minimum(mass[:-1], 0.0))
    has = keep(one, jnp.where(lost > wide[2:-2], wide[2:-2] / lost, 1.0))
    mass, flow, push_l, push_r, area_l, area_r = (
        each[1:-1] for each in (mass, flow, push_l, push_r, area_l, area_r)
    )
    kept = keep(one, jnp.where(mass > 0.0, has[:-1], jnp.where(mass < 0.0, has[1:], 1.0)))
    mass, through = kept * mass, (kept * (flow - push_l))[1:] - (kept * (flow - push_r))[:-1]
    # The force within a cell by the trapezium of its ends; heads in a stronger field rise by what it adds.
    rise = half_head[2:-2] - 0.5 * (held - spin) * (held + spin) * (area_l[1:] - area_r[:-1])
    within = (jnp.minimum(area_l[1:], 2.0 * area) + jnp.minimum(area_r[:-1], 2.0 * area)) * rise
    rate_q = -euler * area - (through + within) / step
    return *keep(one, ((mass[:-1] - mass[1:]) / step, rate_q)), fastest


def rub(area, q, spin, law, drags, dt):
    """Friction over a time: q, and the velocity that is left [theory: friction, eq. 6; long_wave, eq. 11]."""
    coefficient, lid, plates, thin, top, table = drags
    velocity, surface, _ = profile(area, q, spin)
    held, pushed = jnp.maximum(area, DRY), 0.0
    if law == WALL:
        last, rest = table.shape[0] - 1, 1.0 - area
        ratio = abs(velocity) / (rest * top)
        sides = (0.5 * (1.0 + surface) / held + lid) * jnp.maximum(ratio, 1.0) * top * dt
        place = jnp.sqrt(jnp.sqrt(jnp.where(ratio < 1.0, ratio, 1.0))) * last
        k = jnp.minimum(place.astype(int), last - 1)
        low, high = (jnp.take_along_axis(table[:, 0], k + i, axis=0) for i in (0, 1))
        x = (low + (place - k) * (high - low)) * sides
        kept = 1.0 / (1.0 + x * (1.0 + jnp.take_along_axis(table[:, 1], k, axis=0) * x))
        # The waves' part takes what a cell has beside the mean.
        x = coefficient * dt * (1.0 + plates * (1.0 - surface)) / (held + 0.5 * thin * (1.0 + surface))
        gone = x * (1.0 + 0.5 * x) / (1.0 + x * (1.0 + 0.5 * x))
        mean = (gone * area * kept * velocity).sum(0) / jnp.maximum((gone * area).sum(0), _NOTHING)
        kept, pushed = kept * (1.0 - gone), gone * mean
    else:
        x = damping_rate(law, coefficient, lid, 2.0 * area / (1.0 + surface), held, velocity) * dt
        kept = 1.0 / (1.0 + x) if law == QUADRATIC else jnp.exp(-x)
    square = spin * area * area
    after = jnp.where(area > DRY, (q + square) * kept + area * pushed, 0.0) - square
    return after, velocity * kept + pushed


def layer_step(given, law, angles, area, q, spins, force, dt):
    """A time step of every layer: areas, momenta, measures at its end, largest speed, Outcome.

    Heun's between two half steps of friction [theory: long_wave, eq. 11], as by
    `solvers.runup.steps.layer.layer_step`; `force` over R in the drum frame at both ends, (2, 2, l, w).
    """
    step, euler = 2.0 * math.pi / area.shape[0], (spins[1] - spins[0]) / dt
    # Stokes' friction at the frequency of a natural wave goes with the root of the spin.
    root = jnp.sqrt(0.5 * (spins[0] + spins[1])) if law in (STOKES, WALL) else 1.0
    drags = given.coefficient * root, given.lid, given.plates, given.thin / root, given.top, given.tables

    def stage(area, q, k):
        d_area, d_q, speed = rates(area, q, spins[k], euler, force[k], angles, given.gaps, dt, given.one)
        wrong = jnp.where(dt * speed > LARGEST * step, Outcome.TOO_LONG, Outcome.DONE)
        wrong = jnp.where(speed < jnp.inf, wrong, Outcome.AT_AXIS)
        return jnp.maximum(area + dt * d_area, 0.0), q + dt * d_q, speed, wrong

    begin = keep(given.one, rub(area, q, spins[0], law, drags, 0.5 * dt)[0])
    area_1, q_1, speed_1, status_1 = stage(area, begin, 0)
    sound = ((area < FULL) & (area_1 < FULL) & (abs(q_1) < jnp.inf)).all(0)
    status_1 = jnp.where((status_1 == Outcome.DONE) & ~sound, Outcome.AT_AXIS, status_1)
    area_2, q_2, speed_2, status_2 = stage(area_1, q_1, 1)
    area, q = keep(given.one, (0.5 * (area + area_2), 0.5 * (begin + q_2)))
    # Films keep the momentum of their faded velocity, which no front exceeds.
    most = FASTEST * abs(spins[1])
    calm = (jnp.clip(profile(area, q, spins[1])[0], -most, most) - spins[1] * area) * area
    q = keep(given.one, jnp.where(area < THIN, calm, q))
    q, velocity = keep(given.one, rub(area, q, spins[1], law, drags, 0.5 * dt))
    passed = status_1 == Outcome.DONE
    speed = jnp.where(passed, jnp.maximum(speed_1, speed_2), speed_1)
    return area, q, measure(area, velocity, angles), speed, jnp.where(passed, status_2, status_1)


def measure(area, velocity, angles):
    """Moment, its rate by the flow, and the flow's inertia [theory: coupling, eq. 2 and 4], (7, l, w)."""
    step, (cosine, sine) = 2.0 * math.pi / area.shape[0], angles[:2, 2:-2]
    r = jnp.maximum(jnp.sqrt(jnp.maximum(1.0 - 2.0 * around(area, 1), 0.0)), NEAREST)
    x, y = (0.5 * (r[2:] * way[2:] - r[:-2] * way[:-2]) for way in (cosine, sine))
    flow, log, r = velocity * _log(area), _log(area), r[1:-1]
    lever = (1.0 - r) * (1.0 + r + r * r) / 3.0 * step
    sums = lever * cosine[1:-1], lever * sine[1:-1], flow * x, flow * y
    share = log / step
    return jnp.stack([each.sum(0) for each in (*sums, share * x * x, share * x * y, share * y * y)])


def _relative(given, measures, spin, cosine, sine):
    """Momentum of each layer relative to its axis, standing frame [theory: coupling, eq. 3], (l, 2, w)."""
    scale = given.weight * given.radius**3
    x = scale * (measures[2] - spin * measures[1])
    y = scale * (measures[3] + spin * measures[0])
    return jnp.stack([x * cosine - y * sine, x * sine + y * cosine], axis=1)


def _solved(left, right):
    """Solution of the rotor's equations, (n, w); without pivots: masses outweigh all else in a step."""
    rows = [jnp.concatenate([row, value[None]]) for row, value in zip(left, right, strict=True)]
    for k in range(len(rows)):
        top = rows[k] / rows[k][k]
        rows = [top if i == k else row - row[k] * top for i, row in enumerate(rows)]
    return jnp.stack([row[-1] for row in rows])


def change_of(given, now, inertia, gained, guess, spins, turn, dt):
    """Change of the rotor's velocities over the step [theory: coupling, eq. 5], (n, w)."""
    mass, damping, gyroscopic, stiffness = given.matrices
    damping = damping + 0.5 * (spins[0] + spins[1]) * gyroscopic
    along, across = given.unbalance
    swing = spins[0] * (along * turn[0][1] + across * turn[0][0])
    swing = swing - spins[1] * (along * turn[1][1] + across * turn[1][0])
    right = -swing - dt * (
        (damping * now.rate).sum(1) + (stiffness * (now.place + 0.5 * dt * now.rate)).sum(1)
    )
    left = mass + 0.5 * dt * damping + 0.25 * dt * dt * stiffness
    for j, (xx, xy, yy) in enumerate(jnp.moveaxis(inertia, 1, 0)):
        bx, by = given.planes[j]
        own, (gained_x, gained_y), (x, y) = given.masses[j], gained[j], guess[j]
        right = right - bx * (gained_x + dt * (xx * x + xy * y)) - by * (gained_y + dt * (xy * x + yy * y))
        left = left + (own - xx) * bx[:, None] * bx + (own - yy) * by[:, None] * by
        left = left - xy * (bx[:, None] * by + by[:, None] * bx)
    return _solved(left, right)


def expected(now, ramp, dt):
    """First guess of the mean accelerations, as by `solvers.runup.steps.coupled.expect`, (l, 2, w)."""
    here, back = 0.5 * dt, 0.5 * now.last
    first = back + 0.5 * (now.last + now.before)
    second = first + 0.5 * (now.before + now.older)
    ahead = jnp.minimum(here, 2.0 * (first - back) - back)
    linear = (ahead + back) / jnp.maximum(first - back, _NOTHING)
    bend = linear * (ahead + first) / jnp.maximum(second - back, _NOTHING)
    curve = bend * (first - back) / jnp.maximum(second - first, _NOTHING)
    bend, curve = (jnp.where(now.older > 0.0, each, 0.0) for each in (bend, curve))
    linear = jnp.where(now.before > 0.0, linear, 0.0)
    guess = 0.0
    for k, (time, weight) in enumerate(
        ((back, 1.0 + linear + bend), (first, -linear - bend - curve), (second, curve))
    ):
        turned = now.spin * (here + time) + 0.5 * ramp * (here - time) * (here + time)
        cosine, sine = weight * jnp.cos(turned), weight * jnp.sin(turned)
        x, y = now.push[k, :, 0], now.push[k, :, 1]
        guess = guess + jnp.stack([x * cosine - y * sine, x * sine + y * cosine], axis=1)
    return guess


def round_of(given: Given, now: Now, law: int) -> Now:
    """One round of the present step of every lane [theory: coupling]: see `solvers.runup.steps.coupled`."""
    cells, lanes = now.area.shape[0], now.spin.size
    angles = np.pad(ring(cells), ((0, 0), (3, 3)), mode="wrap")[:, :, None, None]
    leg = jnp.minimum(now.leg, given.legs - 1)
    stop, ramp = given.stops[leg, jnp.arange(lanes)], given.rates[leg, jnp.arange(lanes)]
    remaining = stop - now.time
    dt = now.share * (given.courant * (2.0 * math.pi / cells) / jnp.maximum(1.1 * now.fastest, now.spin))
    whole = FILLS * dt
    dt = jnp.where(whole >= remaining, remaining, jnp.where(whole > 0.5 * remaining, 0.5 * remaining, dt))
    fresh = now.tried == 0
    guess = jnp.where(fresh, expected(now, ramp, dt), now.guess)
    spins = now.spin, now.spin + ramp * dt
    turned = now.angle + 0.5 * (spins[0] + spins[1]) * dt
    turn = [(jnp.cos(angle), jnp.sin(angle)) for angle in (now.angle, turned)]
    x, y = -guess[:, 0] / given.radius, -guess[:, 1] / given.radius
    force = jnp.stack([jnp.stack([x * c + y * s, y * c - x * s]) for c, s in turn])
    area, q, end, speeds, each = layer_step(given, law, angles, now.area, now.momentum, spins, force, dt)
    # Layers after the first that fails are not asked.
    failed = jnp.cumsum(each != Outcome.DONE, axis=0) - (each != Outcome.DONE)
    fastest = jnp.where(failed == 0, speeds, 0.0).max(0)
    status = jnp.where(failed == 0, each, Outcome.DONE).max(0)
    gained = _relative(given, end, spins[1], *turn[1]) - _relative(given, now.begin, spins[0], *turn[0])
    c, s = turn[0][0] + turn[1][0], turn[0][1] + turn[1][1]
    c, s = c / jnp.hypot(c, s), s / jnp.hypot(c, s)
    xx, xy, yy = given.weight * given.radius**2 * now.begin[4:]
    inertia = jnp.stack(
        [
            c * c * xx - 2.0 * c * s * xy + s * s * yy,
            c * s * (xx - yy) + (c * c - s * s) * xy,
            s * s * xx + 2.0 * c * s * xy + c * c * yy,
        ]
    )
    change = change_of(given, now, inertia, gained, guess, spins, turn, dt)
    found = (given.planes * change).sum(2) / dt
    size = jnp.maximum(abs(found), 1e-6 * (now.spin**2 * given.radius)[:, None]).max((0, 1))
    gap = abs(found - guess).max((0, 1)) / jnp.maximum(size, _NOTHING)
    # The step is done, wants another round, is taken again shorter, or ends the run.
    agreed, final = gap <= AGREED, now.tried == ROUNDS - 1
    fine = status == Outcome.DONE
    passes = final & (now.share <= SHORT) & (gap <= PASSABLE)
    done, again = fine & (agreed | passes), fine & ~agreed & ~final
    status = jnp.where(fine, jnp.where(done | again, Outcome.DONE, Outcome.NOT_COUPLED), status)
    lost = status == Outcome.NOT_COUPLED
    shorter = (status == Outcome.TOO_LONG) | (lost & (now.share > SHORTEST))
    status = jnp.where(lost & ~shorter & (area.max((0, 1)) > PILED), Outcome.AT_AXIS, status)
    share = jnp.where(shorter, 0.5 * now.share, now.share)
    ends = (status != Outcome.DONE) & ~(shorter & (share >= LEAST))
    # Share of what the accelerations miss by that the guess follows next, by Aitken's rule for vectors.
    missed = found - guess
    turning = missed - now.miss
    relaxed = -now.relaxed * (now.miss * turning).sum((0, 1)) / ((turning * turning).sum((0, 1)) + _NOTHING)
    relaxed = jnp.where(now.tried >= STRAIGHT, jnp.clip(relaxed, -1.0, 1.0), 1.0)
    place, time = now.place + dt * (now.rate + 0.5 * change), jnp.where(dt == remaining, stop, now.time + dt)
    x, y = (given.watched * place).sum(1)
    seen = jnp.stack([jnp.hypot(x, y), spins[1], time])
    crest = jnp.where(seen[0] > now.crest[0], seen, now.crest)
    arrived, going = done & (dt == remaining), now.status == _GOING
    row = jnp.concatenate([jnp.stack([time, spins[1], turned]), crest, place, area.min(0), area.max(0)])
    k = jnp.where(arrived & going, leg, given.stops.shape[0])
    moments = now.moments.at[k, :, jnp.arange(lanes)].set(row.T, mode="drop")
    ended = jnp.where(arrived & (leg + 1 == given.legs), Outcome.DONE, jnp.where(ends, status, _GOING))
    tries = now.steps[1] + ~again
    ended = jnp.where((ended == _GOING) & ~again & (tries >= given.most), Outcome.RAN_OUT, ended)
    later = Now(
        place=jnp.where(done, place, now.place),
        rate=jnp.where(done, now.rate + change, now.rate),
        area=jnp.where(done, area, now.area),
        momentum=jnp.where(done, q, now.momentum),
        begin=jnp.where(done, end, now.begin),
        push=jnp.where(done, jnp.stack([found, now.push[0], now.push[1]]), now.push),
        spin=jnp.where(done, spins[1], now.spin),
        angle=jnp.where(done, turned, now.angle),
        time=jnp.where(done, time, now.time),
        last=jnp.where(done, dt, now.last),
        before=jnp.where(done, now.last, now.before),
        older=jnp.where(done, now.before, now.older),
        fastest=jnp.where(done, fastest, jnp.where(shorter, jnp.maximum(now.fastest, fastest), now.fastest)),
        share=jnp.where(done, jnp.minimum(1.0, 1.5 * now.share), share),
        crest=jnp.where(done, jnp.where(arrived, crest * jnp.array([[0.0], [1.0], [1.0]]), crest), now.crest),
        leg=now.leg + arrived,
        status=ended,
        steps=jnp.stack([now.steps[0] + done, tries, now.steps[2] + 1]),
        tried=jnp.where(again, now.tried + 1, 0),
        guess=guess + relaxed * missed,
        miss=missed,
        relaxed=relaxed,
        moments=None,
    )
    kept: Now = jax.tree.map(partial(jnp.where, going), later, now._replace(moments=None))
    return kept._replace(moments=moments)


@partial(jax.jit, static_argnames="law")
def _rounds(given: Given, now: Now, law: int, most: int) -> Any:
    """At most so many rounds, fewer where every lane has ended; and how many."""

    def more(at):
        return (at[1] < most) & (at[0].status == _GOING).any()

    return lax.while_loop(more, lambda at: (round_of(given, at[0], law), at[1] + 1), (now, 0))


@dataclass(frozen=True)
class ArrayRun:
    """A run-up of a batch at k times with l layers: fields as of `solvers.runup.runup.RunupHistory`."""

    time: Array
    speed: Array
    deflection: Complex
    largest: Array
    largest_speed: Array
    largest_time: Array
    depth_min: Array
    depth_max: Array
    steps: int
    rounds: int  #: of all steps, in which rotor and layers came to agree
    outcome: Outcome
    reason: str  #: why it did not come to the end, and when; or empty

    @property
    def converged(self) -> bool:
        """Whether the run came to its end."""
        return self.outcome is Outcome.DONE

    @property
    def amplitude(self) -> Array:
        """Modulus of the first deflection, shape (k,)."""
        first = self.deflection[:, 0]
        return np.hypot(first.real, first.imag)


class _Lane(NamedTuple):
    """A machine made ready: its numbers, without the axis of the lanes, and what its answer is read with."""

    machine: Coupled
    law: int
    given: Given
    now: Now


def runups(
    tasks: Sequence[EnsembleTask],
    lanes: int = GROUP,
    progress: Callable[[float], object] | None = None,
) -> list[ArrayRun]:
    """Run-ups of machines that differ in numbers alone, as one array program on the processor or a GPU.

    For rings of long waves that stay on their walls (upright axes), without baffles, dispersion or
    fluctuations, driven along ramps. No run with half the cells is made beside them, and no energy is
    audited.

    Parameters
    ----------
    tasks : the machines, of as many coordinates, layers and cells each and with the same law of friction
    lanes : how many run at once, a multiple of 32
    progress : is told the share of runs that have ended, again and again

    Returns
    -------
    A run for each machine, whose digits depend on the number of lanes but not on the other machines. One that
    ends early says why, with the times that it reached.

    Raises
    ------
    InputError
        for any other machine or number of lanes
    """
    if lanes < 1 or lanes % GROUP:
        raise InputError("lanes", lanes, f"a multiple of {GROUP}")
    # A ramp has up to four corners, of which the first and the last are samples in any case.
    longest = max((task.numerics.samples for task in tasks), default=0) + 2
    made = [_lane(task, f"tasks.{number}", longest) for number, task in enumerate(tasks)]
    for number, lane in enumerate(made):
        kinds = [[one.law, *map(np.shape, one.given + one.now)] for one in (lane, made[0])]
        if kinds[0] != kinds[1]:
            allowed = "as the first: cells, coordinates, layers and law of friction"
            raise InputError(f"tasks.{number}", tasks[number].friction.law.value, allowed)
    with jax.enable_x64(True):
        return _run(made, lanes, progress or (lambda _: None)) if made else []


def _lane(task: EnsembleTask, place: str, longest: int) -> _Lane:
    """A machine made ready, with room for so many times; `place` is what errors name it by."""
    drive, numerics = task.drive, task.numerics
    for name, value, right, allowed in (
        ("drive", drive, isinstance(drive, Ramp), "a ramp"),
        ("model", task.model, task.model is couple, "long waves"),
        ("dispersion", numerics.dispersion, not numerics.dispersion, "off"),
        ("enstrophy", numerics.enstrophy, not numerics.enstrophy, "off"),
        ("sheds", task.system.sheds, not task.system.sheds, "none: the unbalance stays"),
    ):
        if not right:
            raise InputError(f"{place}.{name}", value, allowed)
    start = float(drive.corners()[1, 0])
    how = numerics.cells, False, False, numerics.handover
    machine = couple(task.system, task.fills, start, task.friction, task.gravity, *how)
    parts = machine.machine
    if not machine.settled or parts.plates.shape[1] or not parts.layers.size:
        raise InputError(f"{place}.fills", task.fills, "a ring of liquid on an upright wall, without baffles")
    known = known_legs(drive, machine, numerics.samples)
    assert known is not None
    stops, slopes = (np.pad(each, (0, longest - each.size), mode="edge") for each in known)
    fastest = highest(drive)
    spans = np.diff(known[0], prepend=0.0).tolist()
    layers, (n, count) = parts.layers, (machine.state.place.size, parts.layers.size)
    given = Given(
        matrices=parts.matrices,
        unbalance=np.stack([parts.unbalance.real, parts.unbalance.imag]),
        planes=parts.planes,
        watched=parts.watched,
        masses=parts.masses,
        **{name: layers[name].copy() for name in Given._fields[5:12]},
        gaps=parts.gaps,
        tables=np.moveaxis(parts.tables, 0, -1),
        stops=stops,
        rates=slopes,
        legs=known[0].size,
        courant=numerics.courant,
        one=1.0,
        most=sum(step_budget(span, fastest, numerics.cells, numerics.courant) for span in spans),
    )
    begin = [[each[2][name] for each in machine.measured()] for name in _MEASURED]
    now = Now(
        *(np.zeros(n), np.zeros(n), machine.state.area.T, machine.state.momentum.T, np.array(begin)),
        *(np.zeros((3, count, 2)), start, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, np.zeros(3), 0, _GOING),
        *(np.zeros(3, dtype=int), 0, np.zeros((count, 2)), np.zeros((count, 2)), 1.0),
        np.zeros((longest, 6 + n + 2 * count)),
    )
    arrays = Given(*map(np.asarray, given)), Now(*map(np.asarray, now))
    return _Lane(machine, task.friction.law.number, *arrays)


def _run(made: list[_Lane], lanes: int, progress: Callable[[float], object]) -> list[ArrayRun]:
    """Seat machine after machine in the lanes, whose number makes the program, until all have ended."""
    found: dict[int, ArrayRun] = {}
    seats, queue = [-1] * lanes, iter(range(len(made)))
    given, now = jax.tree.map(
        lambda value: np.repeat(value[..., None], lanes, axis=-1), (made[0].given, made[0].now)
    )
    now.status[:] = Outcome.DONE
    try:
        while len(found) < len(made):
            free = np.flatnonzero(np.asarray(now.status) != _GOING).tolist()
            left = [lane for lane in free if seats[lane] >= 0]
            if left:
                given, now = jax.tree.map(np.array, (given, now))
            for lane in left:
                found[seats[lane]] = _read(made[seats[lane]], *(value[..., lane] for value in now))
                seats[lane] = -1
            for lane, number in zip(free, queue, strict=False):
                for whole, part in zip(given + now, made[number].given + made[number].now, strict=True):
                    whole[..., lane] = part
                seats[lane] = number
            # Python hears a Ctrl-C between two calls alone.
            now, _ = _rounds(given, now, made[0].law, max(1, SLICE // now.area.size))
            jax.block_until_ready(now)
            progress(len(found) / len(made))
    except KeyboardInterrupt:
        for number, one in enumerate(made):
            if number in seats:
                found[number] = _read(one, *(np.asarray(value)[..., seats.index(number)] for value in now))
            elif number not in found:
                found[number] = _read(one, *one.now)
    return [found[number] for number in range(len(made))]


def _read(lane: _Lane, *values: Any) -> ArrayRun:
    """The answer of a lane that has ended, or that nobody waits for."""
    state, machine = Now(*values), lane.machine
    outcome = Outcome.INTERRUPTED if state.status == _GOING else Outcome(int(state.status))
    n = state.place.size
    spin, area = lane.now.spin, lane.now.area
    first = np.concatenate([[0.0, spin, 0.0, 0.0, spin, 0.0], np.zeros(n), area.min(0), area.max(0)])
    moments = np.concatenate([first[None], state.moments[: state.leg]])
    time, speed, _, *crest = moments[:, :6].T
    parts = np.einsum("lin,kn->kli", machine.seen, moments[:, 6 : 6 + n])
    deflection = parts[:, :, 0] + 1j * parts[:, :, 1]
    amplitude = np.hypot(deflection[:, 0].real, deflection[:, 0].imag)
    later = amplitude >= crest[0]
    depths = np.full((2, time.size, len(machine.fills)), np.nan)
    surface = np.sqrt(np.maximum(1.0 - 2.0 * moments[:, 6 + n :], 0.0)).reshape(time.size, 2, -1)
    depths[:, :, machine.active] = lane.given.radius * (1.0 - surface.swapaxes(0, 1))
    when = f"at {float(state.time):.6g} s, {float(state.spin):.6g} rad/s"
    return ArrayRun(
        time=time,
        speed=speed,
        deflection=deflection,
        largest=np.where(later, amplitude, crest[0]),
        largest_speed=np.where(later, speed, crest[1]),
        largest_time=np.where(later, time, crest[2]),
        depth_min=depths[0],
        depth_max=depths[1],
        steps=int(state.steps[0]),
        rounds=int(state.steps[2]),
        outcome=outcome,
        reason="" if outcome is Outcome.DONE else f"{outcome.message} {when}",
    )
