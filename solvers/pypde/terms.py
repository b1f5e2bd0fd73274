"""Annular long waves in SI units, by the compiled finite volumes: rates of change, time steps, readings.

A layer is the liquid area per radian A, m^2, and the relative angular momentum per radian and density q = R u
A - Omega A^2, m^4/s, both shape (n,), on n equal cells round the drum, the first from theta = 0. The spin may
change at a constant rate; Omega is always the current one [theory: long_wave, eq. 4]. Cells that a time step
left below zero count as dry.
"""

from __future__ import annotations

import cmath
import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fluid import long_wave
from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw, damping_rate
from fluid.friction.wall import WallDrag, wall_drag, wall_shear
from meshes.arrays import Array, Complex
from meshes.errors import InputError, require_not_negative
from solvers.layer.finite_volume import DRY, FULL, GHOSTS, THIN, WORK, rates_of
from solvers.layer.inside import SLOT_SPEED, full_area, inside_of
from solvers.layer.records import LOADS, Drive, Outcome, Record, Wall, records
from solvers.layer.state import means, ring
from solvers.layer.step import centre, scratch, tally
from solvers.layer.step import march as march_layer
from solvers.liquid_model import Whirl, drag_frequency, grown
from solvers.slices import compiled


@dataclass(frozen=True)
class LongWaveTerms:
    """What acts on a layer [theory: long_wave, eq. 4]."""

    fill: Fill  #: chamber and liquid; the volume is that of the uniform layer
    whirl: Whirl  #: of the drum's axis, at a constant speed in space, and gravity; its spin is that at time 0
    #: on the wall; the laminar law takes the frequency of what moves, seen from the drum at time 0
    friction: Friction = NO_FRICTION
    dispersion: bool = False  #: add the finite depth's dispersion [theory: long_wave, eq. 13]
    spin_rate: float = 0.0  #: rate of change of the spin, rad/s^2

    def __post_init__(self) -> None:
        if not math.isfinite(self.spin_rate):
            raise InputError("spin_rate", self.spin_rate, "a finite number")

    @cached_property
    def _frequency(self) -> float:
        return drag_frequency(self.fill, self.whirl)

    def drag(self) -> tuple[int, float]:
        """Law and coefficient of the friction as `fluid.friction.laws.damping_rate` takes them."""
        return self.friction.at(self.fill.liquid.viscosity, self._frequency, self.fill.chamber.radius)

    def wall_drag(self) -> WallDrag | None:
        """The law of the wall at the spin at time 0, rates in 1/s; None under another law."""
        if self.friction.law is not FrictionLaw.WALL:
            return None
        return _wall_drag(self.friction, self.fill, self._frequency, self.whirl.spin)

    def wall(self) -> Wall:
        """What the compiled steps know of the wall, rates in 1/s."""
        law, coefficient = self.drag()
        drag = self.wall_drag()
        if drag is None:
            return Wall(law, coefficient, _lid(self), self.dispersion)
        return Wall(law, coefficient, drag.lid, self.dispersion, drag.plates, drag.thin, drag.top, drag.table)

    def spin(self, time: float) -> float:
        """Omega at a time, rad/s; refused where the drum does not spin forward."""
        spin = self.whirl.spin + self.spin_rate * time
        if spin <= 0.0:
            raise InputError("time", time, "one at which the drum spins forward")
        return spin


@lru_cache(maxsize=64)
def _wall_drag(friction: Friction, fill: Fill, slip: float, spin: float) -> WallDrag:
    chamber = fill.chamber
    given = fill.liquid.viscosity, fill.depth, chamber.radius, chamber.height
    return wall_drag(friction, *given, slip, spin)


def body_force(terms: LongWaveTerms, time: float) -> complex:
    """Minus the acceleration of the drum's axis, and gravity [theory: long_wave, eq. 8].

    In the drum frame, m/s^2, real along theta = 0.
    """
    whirl = terms.whirl
    # The drum has turned by the time and the mean spin so far.
    turned = (whirl.spin + 0.5 * terms.spin_rate * time) * time
    seen = cmath.exp(1j * (whirl.speed * time - turned))
    amplitude = whirl.amplitude * float(grown(time, whirl.ramp))
    return whirl.speed**2 * amplitude * seen - 1j * whirl.gravity * cmath.exp(-1j * turned)


def layer_rates(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> tuple[Array, Array]:
    """Rates of change of a layer, m^2/s and m^4/s^2 [theory: long_wave, eq. 1 and 4].

    Discretised as in eq. 11 there. A cell below zero, where a time step has taken more than there was, counts
    as dry. Where the surface has come to the axis all rates are nan, which adaptive steppers take as too long
    a step.
    """
    radius, n, spin = terms.fill.chamber.radius, area.size, terms.spin(time)
    a, q = scaled(terms, area, momentum)
    d_area, d_q = np.full(n, math.nan), np.full(n, math.nan)
    if is_layer(terms, area, momentum):
        cell, face = radial_force(terms, n, time)
        work, step = np.zeros((WORK, n + 2 * GHOSTS)), 2.0 * math.pi / n
        inside, none = inside_of(terms.fill, n), np.empty(0)
        going = rates_of(inside.plates, terms.dispersion, False)
        compiled(
            *(going, a, q, none, spin, terms.spin_rate, cell, face, *inside),
            *(step, 0.0, terms.dispersion, work, d_area, d_q, none),
        )
        d_q -= _shear(terms, a, q, spin)
    return d_area * radius**2, d_q * radius**4


class Marcher:
    """Heun steps on one ring in which no cell falls below zero, at a constant spin.

    They add loads to a record LOADS of `solvers.layer.records`, shape (1,); lengths over R, times in s.
    """

    def __init__(self, terms: LongWaveTerms, cells: int, courant: float, loads: Record | None = None) -> None:
        require_constant_spin(terms)
        whirl, radius = terms.whirl, terms.fill.chamber.radius
        self.terms, self.courant, self._ring, self._spare = terms, courant, ring(cells), scratch(cells)
        self._loads = records(LOADS) if loads is None else loads
        self._drive = Drive(
            amplitude=whirl.amplitude / radius,
            slip=whirl.slip,
            ramp=whirl.ramp,
            whirl=whirl.speed,
            weight=whirl.gravity / radius,
            spin=whirl.spin,
        )
        self._inside = inside_of(terms.fill, cells)
        self._wall = terms.wall()
        # The state as the last march left it: scaled, and as it was told, m^2 and m^4/s.
        self._kept: tuple[Array, Array] | None = None
        self._told = np.zeros((2, cells))

    def march(self, state: Array, start: float, stop: float) -> tuple[Outcome, int]:
        """Advance a layer, A and q, shape (2, n), in place unless the steps fail; how it ended, steps.

        One that is as the last call left it goes on without a rounding.
        """
        if self._kept is None or not (self._told == state).all():
            require_layer(self.terms, state[0], state[1])
            require_not_negative("time", start)
            if state[0].min() < 0.0:
                raise InputError("area", float(state[0].min()), "0 or above in each cell")
            self._kept = scaled(self.terms, state[0], state[1])
        a, q = self._kept
        args = start, stop, self._drive, self._wall, self._ring, self.courant, self._spare, self._loads
        outcome, steps = march_layer(a, q, *args, inside=self._inside)
        square = self.terms.fill.chamber.radius**2
        np.multiply(a, square, out=self._told[0])
        np.multiply(q, square * square, out=self._told[1])
        if outcome is Outcome.DONE:
            state[...] = self._told
        return outcome, int(steps)


def loads_at(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> Array:
    """Fields of a record LOADS at one moment, as a `Marcher` adds them up; lengths over R, times in s."""
    a, q = scaled(terms, area, momentum)
    n, slip, found = a.size, terms.whirl.slip, records(LOADS)
    turn = cmath.exp(1j * slip * time)
    pull = radial_force(terms, n, time)[0]
    spin, full = terms.spin(time), full_area(terms.fill)
    slot = (SLOT_SPEED * spin) ** 2
    compiled(tally, a, q, spin, pull, ring(n), turn.real, turn.imag, 1.0, full, slot, found[0])
    push = body_force(terms, time) / (terms.fill.chamber.radius * turn)
    found[0].push_x, found[0].push_y = push.real, push.imag
    return np.asarray(found.view(np.float64))


class Place(NamedTuple):
    """Offset of the centre of mass from the drum's axis, m, and its rate, m/s, real along the deflection."""

    offset: complex
    rate: complex


def place_at(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> Place:
    """Offset of the centre of mass and its rate, as the finite volumes move it; nan without a layer."""
    slip, radius = terms.whirl.slip, terms.fill.chamber.radius
    turn = cmath.exp(-1j * slip * time)
    offset = offset_of(area, radius) * turn
    # Of (R^3 - r_s^3)/3, cell by cell: in a bore no other derivative is that of the sums.
    held = np.maximum(area, 0.0)
    lever = surface_radius(terms, held) * layer_rates(terms, area, momentum, time)[0]
    moved = complex((lever * _rays(area.size)).sum()) / float(held.sum()) * turn
    return Place(offset, moved - 1j * slip * offset)


def load_means(terms: LongWaveTerms, loads: Array, length: float, ends: tuple[Place, Place]) -> Complex:
    """Means over a time of what a `Marcher` has added up, shape (6,) [theory: long_wave, eq. 7].

    Force over that of a full drum by the liquid's momentum, offset, m, turning, rad/s, least and largest
    depth, m, force by the pressure on the wall as the first; without deflection no force. `ends` are the
    `place_at` of both ends.
    """
    whirl, radius = terms.whirl, terms.fill.chamber.radius
    mass = terms.fill.volume / (terms.fill.chamber.height * radius**2)
    offsets = ends[0].offset / radius, ends[1].offset / radius
    moving = ends[0].rate / radius, ends[1].rate / radius
    # As plain numbers, which are read faster than those of a record.
    sums = SimpleNamespace(**dict(zip(LOADS.names or (), loads.tolist(), strict=True)))
    found = means(sums, length, mass, whirl.speed, offsets, moving)
    full = math.pi * whirl.amplitude / radius * whirl.speed**2 or math.inf
    return found * (1.0 / full, radius, 1.0, radius, radius, 1.0 / full)


def require_constant_spin(terms: LongWaveTerms) -> None:
    """Raise `InputError` unless the spin stays as it is."""
    if terms.spin_rate != 0.0:
        raise InputError(
            "spin_rate", terms.spin_rate, '0 for "finite_volume"; py-pde\'s own solvers take any'
        )


def is_layer(terms: LongWaveTerms, area: Array, momentum: Array) -> bool:
    """Whether A and q, shape (n,), are finite and the surface is clear of the axis."""
    most = FULL * terms.fill.chamber.radius**2
    return bool(np.isfinite(momentum).all() and np.isfinite(area).all() and area.max() < most)


def require_layer(terms: LongWaveTerms, area: Array, momentum: Array) -> None:
    """Raise `InputError` unless A and q, shape (n,), are finite and the surface is clear of the axis."""
    if not is_layer(terms, area, momentum):
        most = FULL * terms.fill.chamber.radius**2
        raise InputError("area", float(area.max()), f"below {most:g} m^2, and finite with its momentum")


def radial_force(terms: LongWaveTerms, cells: int, time: float) -> tuple[Array, Array]:
    """f_r over R, 1/s^2, at the middles of the cells and at their left faces, shape (n,)."""
    force = body_force(terms, time) / terms.fill.chamber.radius
    table = ring(cells)
    return force.real * table[0] + force.imag * table[1], force.real * table[2] + force.imag * table[3]


def scaled(terms: LongWaveTerms, area: Array, momentum: Array) -> tuple[Array, Array]:
    """A and q, shape (n,), in lengths over R; what is below zero counts as dry."""
    radius = terms.fill.chamber.radius
    return np.maximum(area / radius**2, 0.0), momentum / radius**4


def faded_velocity(a: Array, q: Array, spin: float) -> Array:
    """u as the finite volumes take it, gone in the thinnest films; lengths over R, shape (n,)."""
    square = np.square(a)
    found = 2.0 * (q + spin * square) * a / (square + np.maximum(square, THIN**2))
    return np.where(a > DRY, found, 0.0)


def _lid(terms: LongWaveTerms) -> float:
    return 2.0 * terms.fill.chamber.radius / terms.fill.chamber.height


def _shear(terms: LongWaveTerms, a: Array, q: Array, spin: float) -> Array:
    """tau/rho of the wall friction, lengths over R [theory: long_wave, eq. 9]."""
    law, coefficient = terms.drag()
    shear, wet = np.zeros_like(a), a > DRY
    u, held = faded_velocity(a, q, spin)[wet], a[wet]
    depth = 2.0 * held / (1.0 + long_wave.free_surface_radius(held))
    drag = terms.wall_drag()
    if drag is not None:
        shear[wet] = wall_shear(drag, depth, held, u)
        return shear
    shear[wet] = damping_rate(law, coefficient, _lid(terms), depth, held, u) * held * u
    return shear


def area_at(terms: LongWaveTerms, depth: Array) -> Array:
    """Liquid area per radian A = h (R - h/2), m^2, of depths h up to R, m; shape (n,)."""
    return np.asarray(depth * (terms.fill.chamber.radius - 0.5 * depth))


def surface_radius(terms: LongWaveTerms, area: Array) -> Array:
    """Free-surface radius r_s, m, of A, m^2, shape (n,); beyond the wall in cells below zero."""
    radius = terms.fill.chamber.radius
    return np.asarray(radius * long_wave.free_surface_radius(area / radius**2))


def depth(terms: LongWaveTerms, area: Array) -> Array:
    """Depth R - r_s, m, of A, m^2, shape (n,), without cancellation in thin films."""
    return 2.0 * area / (terms.fill.chamber.radius + surface_radius(terms, area))


def velocity(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> Array:
    """Velocity along the wall relative to the drum, m/s: u = (q + Omega A^2)/(R A); 0 in dry cells."""
    radius = terms.fill.chamber.radius
    a, q = scaled(terms, area, momentum)
    return radius * faded_velocity(a, q, terms.spin(time))


def momentum_at(terms: LongWaveTerms, area: Array, velocity: Array, time: float) -> Array:
    """Relative angular momentum q = R u A - Omega A^2, m^4/s, of A, m^2, and u, m/s; shape (n,)."""
    return np.asarray(terms.fill.chamber.radius * velocity * area - terms.spin(time) * np.square(area))


def angular_momentum(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> float:
    """Angular momentum of the liquid in space about the drum's axis, kg m^2/s: the sum of q + Omega R^2 A."""
    fill = terms.fill
    whole = float((momentum + terms.spin(time) * fill.chamber.radius**2 * area).mean()) * 2.0 * math.pi
    return fill.liquid.density * fill.chamber.height * whole


def pressure_force(terms: LongWaveTerms, area: Array, momentum: Array, time: float) -> complex:
    """Force of the liquid on the drum by the pressure on its wall [theory: long_wave, eq. 7].

    In the drum frame, N, real along theta = 0.
    """
    require_layer(terms, area, momentum)
    a, q = scaled(terms, area, momentum)
    surface, spin = long_wave.free_surface_radius(a), terms.spin(time)
    u, pull = faded_velocity(a, q, spin), radial_force(terms, a.size, time)[0]
    pressure = long_wave.wall_pressure(u, long_wave.layer_log(a), a, surface, spin, pull)
    force = complex((pressure * _rays(a.size)).mean()) * 2.0 * math.pi
    return force * terms.fill.liquid.density * terms.fill.chamber.height * terms.fill.chamber.radius**3


def liquid_offset(terms: LongWaveTerms, area: Array) -> complex:
    """Liquid's centre of mass from the drum's axis, in the drum frame, m, of A, m^2, shape (n,)."""
    require_layer(terms, area, area)
    if not area.max() > 0.0:
        raise InputError("area", 0.0, "above 0 in some cell")
    return offset_of(area, terms.fill.chamber.radius)


def offset_of(area: Array, radius: float) -> complex:
    """`liquid_offset` of what is known to be a layer; nan without liquid."""
    return complex(*compiled(centre, area / radius**2, ring(area.size))) * radius


@lru_cache(maxsize=16)
def _rays(cells: int) -> NDArray[np.complex128]:
    """e^{i theta} at the cells' middles."""
    return np.asarray(ring(cells)[0] + 1j * ring(cells)[1])
