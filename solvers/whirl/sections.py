"""Whirl of rotors whose chambers have baffles in the liquid or a section of their own.

Such liquid has constant coefficients in the drum's frame, where a planar rotor is solved. A rotor that tilts
or has unlike springs is solved in the standing frame, with liquid that answers alike in all directions (three
baffles or more) and so moves in circles, one complex coordinate each. With laminar friction the modes that
grow most are followed, each with its own frequency.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
import scipy

from meshes.arrays import Array, Complex, Flags, Index
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.sloshing.reduced import KEPT, ReducedLiquid, SectionLayer, spanned
from solvers.whirl.count import Region, missed_modes
from solvers.whirl.sheets import drum_roots, standing_roots
from solvers.whirl.system import CoupledMatrices, SystemModes, linear_modes

Placed = tuple[float, SectionLayer]

_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])  # a quarter turn with the spin: multiplies by i
_ALIKE = 1e-3  # of the answer, that may go in the other sense: what an uneven mesh makes of even walls
_DISTINCT = 1e-3  # of an answer that must stand across the others: waves slower than the spin to 3e-5
_SLOW = 0.3  # frequency of slow waves over the spin
_FOLLOWED = 6  # modes at a speed whose laminar friction is computed at their own frequency
_STEPS = 30
_BESIDE = 3e-14 * (1.0 + 1.0j)
_SETTLED = 1e-12  # relative step at which a mode is found
_ROUNDING = 1e-15  # the same of the next step, as far as two show it
_SHARE = 1e-7  # of the spin: how far left of the mode that grows most the others are counted
_ASIDE = 1e-4  # of the spin: how far left of that the others start at least
_SAME = 1e-9  # of the spin: modes as near as that are one
_GONE = -1e300  # lambda of a mode that there is not, 1/s
_FEW = 48  # matrices of a mode that are solved at once
_BLOCK = 512  # points whose matrices fit the processor's cache
_RESOLVED = 1e-11  # of the frequencies, below which growth is rounding


@dataclass(frozen=True, eq=False)
class DrumMatrices:
    """M z'' + (C + D(lambda)) z' + K z = 0 at n speeds [theory: sections, eq. 3]."""

    mass: Array  #: symmetric, positive definite, shape (N, N)
    damping: Array  #: shape (n, N, N)
    stiffness: Array
    laminar: Array  #: of `SectionLayer`, times the density, shape (3, N, N)


def drum_matrices(rotor: Jeffcott, layers: Sequence[SectionLayer], speed: Array) -> DrumMatrices:
    """Rotor and liquid as one linear system in the frame of the drum [theory: sections, eq. 3].

    Liquid without a free surface is part of the rotor's mass.
    """
    heavy = rotor.mass + sum(layer.density * layer.liquid.liquid_area for layer in layers)
    pull = -np.hstack([np.zeros((2, 0)), *(layer.density * layer.liquid.moment for layer in layers)])

    def parts(name: str) -> Array:
        return np.asarray(
            scipy.linalg.block_diag(*(layer.density * getattr(layer.liquid, name) for layer in layers))
        )

    inertia, gyration, surface = parts("inertia"), parts("gyration"), parts("surface")
    rate = scipy.linalg.block_diag(*(layer.density * layer.rate * layer.liquid.inertia for layer in layers))
    laminar = [
        scipy.linalg.block_diag(np.zeros((2, 2)), *(layer.density * layer.laminar[k] for layer in layers))
        for k in range(3)
    ]
    spin = speed[:, None, None]
    mass = np.block([[heavy * np.eye(2), pull], [pull.T, inertia]])
    twist = np.block([[heavy * _TURN, _TURN @ pull], [pull.T @ _TURN, gyration]])
    steady = scipy.linalg.block_diag(rotor.damping * np.eye(2), rate)
    spread = np.block([[-heavy * np.eye(2), -pull], [-pull.T, surface]])
    support = np.zeros_like(mass)
    support[:2, :2] = rotor.stiffness * np.eye(2)
    turned = np.zeros_like(mass)
    turned[:2, :2] = rotor.damping * _TURN
    return DrumMatrices(
        mass=mass,
        damping=2.0 * spin * twist + steady,
        stiffness=np.square(spin) * spread + spin * turned + support,
        laminar=np.array(laminar),
    )


def _shears(rate: Complex, spin: Array) -> tuple[Complex, Complex]:
    """lambda times the factors of `SectionLayer.laminar` in D(lambda), and slopes, shape (3, k).

    Floor and lid drag with sqrt(lambda +- 2 i Omega) on the circles of the flow, the root whose layer decays
    away from the wall [theory: sections, eq. 5].
    """
    wall, along, against = (np.sqrt(rate + turn * spin) for turn in (0.0, 2j, -2j))
    # Half of what is left of lambda over the root, 0 at the end of a cut.
    steep = [0.5 * rate * np.divide(1.0, x, out=np.zeros_like(x), where=x != 0.0) for x in (along, against)]
    factors = np.stack([wall, 0.5 * (along + against), -0.5j * (along - against)])
    bends = np.stack([0.5 * wall, 0.5 * (steep[0] + steep[1]), -0.5j * (steep[0] - steep[1])])
    return factors * rate, factors + bends


def _mixed(weights: Complex, parts: Complex) -> Complex:
    """Sums of matrices by weights at k points, shape (k, N, N) from (c, k) and (c, N, N)."""
    size = parts.shape[-1]
    return np.asarray((weights.T @ parts.reshape(len(parts), -1)).reshape(-1, size, size))


def drum_modes(
    rotor: Jeffcott, layers: Sequence[SectionLayer], speed: Array, near: SystemModes | None = None
) -> SystemModes:
    """Whirl modes in the drum's frame: all without laminar friction, with it those that grow most.

    `sense`: the way they go round as seen from the drum. `near`: as of `most_growing`.
    """
    system = drum_matrices(rotor, layers, speed)
    circles = _circles(layers)
    if not np.any(system.laminar):
        return linear_modes(CoupledMatrices(system.mass, system.damping, system.stiffness), circles)
    walls, plates = system.laminar[0], system.damping + _of_plates(system.laminar, speed)
    plain = CoupledMatrices(system.mass, plates, system.stiffness)
    slowly = replace(plain, damping=plates + np.sqrt(0.5 * _SLOW * speed)[:, None, None] * walls)
    mass, laminar, every_damping, stiffness = (
        part.astype(complex) for part in (system.mass, system.laminar, system.damping, system.stiffness)
    )

    def matrix(root: Complex, owner: Index) -> Complex:
        at, shear = root[:, None, None], _mixed(_shears(root, speed[owner])[0], laminar)
        return np.asarray(at * (at * mass + every_damping[owner]) + stiffness[owner] + shear)

    def slope(root: Complex, owner: Index) -> Complex:
        change = _mixed(_shears(root, speed[owner])[1], laminar)
        return np.asarray(2.0 * root[:, None, None] * mass + every_damping[owner] + change)

    def log_determinant(root: Complex, owner: Index) -> Complex:
        unit, size = np.linalg.slogdet(matrix(root, owner))
        return np.asarray(size + 1j * np.angle(unit))

    def every(owner: Index) -> Complex:
        return drum_roots(plain.at(owner), walls, speed[owner])

    drag = _drag(system.mass, system.laminar)
    search = MostGrowing(speed, 0.0, slowly, drag, circles, matrix, slope, log_determinant, every)
    return most_growing(search, near)


def _of_plates(laminar: Array, speed: Array) -> Array:
    """Drag of floor and lid on slow motions, which the Coriolis force alone decides, shape (n, N, N)."""
    return np.asarray(np.sqrt(speed)[:, None, None] * (laminar[1] + laminar[2]))


def roots(matrices: CoupledMatrices) -> Complex:
    """All lambda of M z'' + C z' + K z = 0, shape (n, 2 N)."""
    size = len(matrices.mass)
    state = np.zeros((len(matrices.damping), 2 * size, 2 * size))
    state[:, :size, size:] = np.eye(size)
    state[:, size:, :size] = -np.linalg.solve(matrices.mass, matrices.stiffness)
    state[:, size:, size:] = -np.linalg.solve(matrices.mass, matrices.damping)
    return np.asarray(np.linalg.eigvals(state), dtype=complex)


@dataclass(frozen=True, eq=False)
class MostGrowing:
    """What the search for the modes that grow most starts from."""

    speed: Array  #: rad/s, shape (n,)
    turn: float  #: of the drum in the frame, over the spin: 0 in its own, 1 in the standing one
    slowly: CoupledMatrices  #: with friction at the frequency of slow waves, `_SLOW` of the spin
    drag: float  #: of the wall layers over the inertia, s^(-1/2)
    circles: Array  #: displacements that tell the sense of a whirl, in pairs across the axis, shape (2 c, N)
    #: T(lambda), and its derivative, shape (k, N, N), at points, (k,), of the speeds they belong to, (k,)
    matrix: Callable[[Complex, Index], Complex]
    slope: Callable[[Complex, Index], Complex]
    log_determinant: Callable[[Complex, Index], Complex]  #: log det T, but for turns of its phase, shape (k,)
    #: all lambda at some of the speeds, nan in place of some, shape (k, m) from (k,)
    every: Callable[[Index], Complex]

    @cached_property
    def started(self) -> Complex:
        """lambda with that friction, shape (n, m)."""
        return roots(self.slowly)

    @cached_property
    def fastest(self) -> Array:
        """Rate beyond which the masses alone count, 1/s, shape (n,)."""
        return np.asarray(np.maximum(np.abs(self.started).max(axis=1), self.drag**2))


def most_growing(search: MostGrowing, near: SystemModes | None = None) -> SystemModes:
    """The modes that grow most, each with laminar friction of its own frequency [theory: sections, eq. 6].

    `near`: those at speeds next to these, from which they are followed; others are not looked for then.
    """
    speed = search.speed
    if near is not None:
        row, column = np.nonzero(near.found)
        start = near.root[row, column]
        follow = _followed(search, start, row, search.matrix)
        root, found = near.root.copy(), near.found.copy()
        root[row, column], found[row, column] = follow[0], follow[2]
        return replace(near, root=root, found=found)
    root = search.started
    # Fast modes have more friction than that of slow waves, in proportion to the root of their frequency. Of
    # the two circles of a mode the one with the spin slips less.
    slip = np.abs(np.abs(root.imag) - search.turn * speed[:, None])
    more = np.sqrt(np.maximum(slip / (_SLOW * speed[:, None]), 1.0))
    rate = np.where(root.real < 0.0, root.real * more, root.real)
    oscillating = np.where(root.imag > 1e-9 * speed[:, None], rate, -np.inf)
    order = np.argsort(-oscillating, axis=1)
    modes = _told(search, _split(root, order[:, :_FOLLOWED]), np.arange(speed.size))
    missed = np.flatnonzero(~modes.complete)
    if missed.size:
        # What the liquid hardly damps seemed to decay more than it does.
        starts = _split(root[missed], order[missed, : 2 * _FOLLOWED])
        modes = modes.replaced(missed, _told(search, starts, missed), _GONE)
        missed = np.flatnonzero(~modes.complete)
    if missed.size == 0:
        return modes
    again = search.every(missed)
    rate = np.where(again.imag > 1e-9 * speed[missed][:, None], again.real, -np.inf)
    most = np.argsort(-rate, axis=1)[:, : 2 * _FOLLOWED]
    start, others = _split(again, most)
    start = np.where(np.isfinite(start), start, complex(-1.0, 1.0) * speed[missed][:, None])
    return modes.replaced(missed, _told(search, (start, others), missed), _GONE)


def _split(root: Complex, which: Index) -> tuple[Complex, Complex]:
    """Those at the places given, shape (n, f), and the others above the real axis, nan in place of some."""
    others = np.where(root.imag > 0.0, root, complex(np.nan, np.nan))
    np.put_along_axis(others, which, complex(np.nan, np.nan), axis=1)
    return np.take_along_axis(root, which, axis=1), others


def _told(search: MostGrowing, starts: tuple[Complex, Complex], at: Index) -> SystemModes:
    """Modes followed from starting values at some speeds, complete where no other grows more.

    Each from its own shape, by which two that are almost alike part. The other starting values only make
    smooth what is followed: a factor whose own zero is left of the line wins or loses no zero.
    """
    start, others = starts
    first, owner = start.astype(complex).ravel(), np.repeat(at, start.shape[1])

    def plain(root: Complex, owner: Index) -> Complex:
        lam, slowly = root[:, None, None], search.slowly.at(owner)
        return np.asarray(lam * (lam * slowly.mass + slowly.damping) + slowly.stiffness)

    last, shapes, settled = _followed(search, first, owner, plain)
    root, found = last.reshape(start.shape), settled.reshape(start.shape)
    shape = shapes.reshape(*start.shape, -1)
    along, against = _sizes(search.circles, shape)
    spin = search.speed[at]
    rate = np.where(found, root.real, -np.inf).max(axis=1)
    told = np.isfinite(rate)
    tips = np.outer(spin, [search.turn, search.turn + 2.0])
    region = Region(np.where(told, rate, 0.0) - _SHARE * spin, tips, spin, search.fastest[at])

    def determinant(points: Complex, owner: Index) -> Complex:
        found = np.empty(points.shape, dtype=complex)
        for first in range(0, points.size, _BLOCK):
            part = slice(first, first + _BLOCK)
            found[part] = search.log_determinant(points[part], at[owner[part]])
        return found

    # Two starts may lead to one mode.
    twice = np.tril(np.abs(root[:, :, None] - root[:, None, :]) <= _SAME * spin[:, None, None], -1)
    kept = found & ~(twice & found[:, None, :]).any(axis=2)
    left = others.real < (region.line - _ASIDE * spin)[:, None]
    known, rough = (
        np.where(kept, root, complex(np.nan, np.nan)),
        np.where(left, others, complex(np.nan, np.nan)),
    )
    count = missed_modes(determinant, 2 * len(search.circles.T), known, region, rough)
    scale = np.abs(root) + spin[:, None]
    sense = np.where(along >= against, 1.0, -1.0)
    return SystemModes(root, sense, _RESOLVED * scale, found, told & (count == 0.0))


def _shapes(matrix: Complex) -> Complex:
    """Shapes of modes by matrices next to their zeros, shape (k, N): one step of inverse iteration."""
    size = matrix.shape[-1]
    anything = 1.0 + 0.1j * np.arange(size)  # has something of every mode
    shape = np.linalg.solve(matrix, np.broadcast_to(anything[:, None], (len(matrix), size, 1)))[..., 0]
    return np.asarray(shape / np.abs(shape).max(axis=1, keepdims=True))


def _drag(mass: Array, laminar: Array) -> float:
    """Largest drag of wall layers over the inertia: it equals that at the square of this rate."""
    return float(np.abs(np.linalg.eigvals(np.linalg.solve(mass, laminar[0] + laminar[1]))).max())


def _circles(layers: Sequence[SectionLayer]) -> Array:
    """Displacement of the axis and of each layer's centre, in pairs across the axis."""
    shifts = [layer.liquid.moment / layer.liquid.liquid_area for layer in layers]
    return np.asarray(scipy.linalg.block_diag(np.eye(2), *shifts))


def _sizes(circles: Array, shape: Complex) -> tuple[Array, Array]:
    """Squared sizes of the circles along and against the spin of modes, shape (n, f) from (n, f, N)."""
    moved = shape @ circles.T
    x, y = moved[..., ::2], moved[..., 1::2]
    along, against = (np.square(np.abs(x + turn * y)).sum(axis=-1) for turn in (1j, -1j))
    return along, against


def _followed(
    search: MostGrowing, root: Complex, owner: Index, matrix: Callable[[Complex, Index], Complex]
) -> tuple[Complex, Complex, Flags]:
    """Modes by Newton's method, each with its own laminar friction, shapes (k, N), which converged.

    From starts above the real axis, shape (k,), of the speeds they belong to, and their shapes by `matrix`.
    """
    root, found = root.copy(), np.zeros(root.shape, dtype=bool)
    shape = np.zeros((root.size, len(search.slowly.mass)), dtype=complex)
    for first in range(0, root.size, _FEW):
        part = slice(first, first + _FEW)
        begin = _shapes(matrix(root[part] * (1.0 + _BESIDE), owner[part]))
        root[part], shape[part], found[part] = _by_newton(search, root[part], owner[part], begin)
    return root, shape, found


def _by_newton(
    search: MostGrowing, root: Complex, owner: Index, shape: Complex
) -> tuple[Complex, Complex, Flags]:
    """See `_followed`, of a few modes whose matrices fit the processor's cache, shape (k,)."""
    on, found = np.arange(root.size), np.zeros(root.shape, dtype=bool)
    before = np.full(root.shape, np.nan)
    for _ in range(_STEPS):
        # A mode met to rounding makes the matrix singular to rounding, which is wanted; so little away it is
        # never exactly so.
        near = root[on] * (1.0 + _BESIDE)
        moved = search.slope(near, owner[on]) @ shape[on][..., None]
        solved = np.linalg.solve(search.matrix(near, owner[on]), moved)[..., 0]
        anchor = np.argmax(np.abs(solved), axis=-1)[:, None]
        largest = np.take_along_axis(solved, anchor, -1)
        step = (np.take_along_axis(shape[on], anchor, -1) / largest)[:, 0]
        root[on] = near - step
        shape[on] = solved / largest
        # Steps that shrink by their square: the next one would be less than rounding.
        size, whole = np.abs(step), np.abs(root[on])
        settled = (size <= _SETTLED * whole) | (size * np.square(size / before[on]) <= _ROUNDING * whole)
        before[on] = size
        found[on[settled]] = True
        on = on[~settled]
        if on.size == 0:
            break
    return root, shape, found


@dataclass(frozen=True, eq=False)
class CircleLayer:
    """Layer that answers alike in all directions, in m complex coordinates q.

    q'' + 2 Omega C q' + Omega^2 B q = p* a and Q = -rho h p q, both in the drum's frame, all x + i y
    [theory: sections, eq. 9].
    """

    density: float  #: rho h, kg/m^2
    liquid_area: float  #: m^2
    gyration: Complex  #: C, B, shape (m, m), and what `SectionLayer.laminar` is, (3, m, m)
    surface: Complex
    laminar: Complex
    moment: Complex  #: p, shape (m,), m
    rate: float  #: k of linear friction, 1/s


def circle_layer(layer: SectionLayer) -> CircleLayer:
    """Motions of a layer that a circular whirl drives [theory: sections, eq. 9].

    An `InputError` where it does not answer alike in all directions.
    """
    liquid = layer.liquid
    drive = (liquid.moment[0] - 1j * liquid.moment[1])[:, None]
    answers = [drive, np.linalg.solve(liquid.surface, drive)]
    for point in KEPT:
        for s in (point, -point.conjugate()):
            matrix = -s * s * liquid.inertia + 2j * s * liquid.gyration + liquid.surface
            answers.append(np.linalg.solve(matrix, drive))
    basis = spanned(np.hstack(answers), _DISTINCT)
    # What rounding, or an uneven mesh, makes of motions in the other sense stays out.
    x, y = liquid.moment @ basis
    basis = basis[:, np.abs(y + 1j * x) <= _ALIKE * np.abs(x).max()]

    def seen(matrix: Array) -> Complex:
        return np.asarray(basis.conj().T @ matrix @ basis)

    found = CircleLayer(
        density=layer.density,
        liquid_area=liquid.liquid_area,
        gyration=seen(liquid.gyration),
        surface=seen(liquid.surface),
        laminar=seen(layer.laminar),
        moment=np.sqrt(2.0) * (liquid.moment[0] @ basis),
        rate=layer.rate,
    )
    _require_alike(liquid, found)
    return found


def _require_alike(liquid: ReducedLiquid, circle: CircleLayer) -> None:
    """Refuse a liquid that does not answer alike in all directions."""
    s = np.array([0.0, *KEPT])
    matrix = liquid.compliance(s)
    sum_xy, difference = matrix[:, 0, 0] + matrix[:, 1, 1], matrix[:, 0, 0] - matrix[:, 1, 1]
    turned = 0.5 * (sum_xy - 1j * (matrix[:, 0, 1] - matrix[:, 1, 0]))
    counter = 0.5 * (difference + 1j * (matrix[:, 0, 1] + matrix[:, 1, 0]))
    unit = np.eye(len(circle.moment))
    at = s[:, None, None]
    motion = -np.square(at) * unit + 2j * at * circle.gyration + circle.surface
    answer = np.linalg.solve(
        motion, np.broadcast_to(circle.moment.conj()[:, None], (s.size, unit.shape[0], 1))
    )
    off = np.abs((circle.moment @ answer)[..., 0] - turned) + np.abs(counter)
    if (off > _ALIKE * np.abs(turned).max()).any():
        allowed = "3 or more for a rotor that is not planar: fewer answer differently in two directions"
        raise InputError("chambers.baffles.count", "1 or 2", allowed)


@dataclass(frozen=True, eq=False)
class StandingMatrices:
    """M z'' + C z' + K z = 0 at n speeds, and laminar friction beside it."""

    mass: Array  #: shape (N, N), (n, N, N), (n, N, N)
    damping: Array
    stiffness: Array
    laminar: Array  #: of `CircleLayer`, times the density, shape (3, N, N)
    quarter: Array  #: multiplies the liquid's complex coordinates by i, shape (N, N)
    circles: tuple[tuple[float, CircleLayer], ...]  #: layers and their planes

    @cached_property
    def rotor(self) -> tuple[Array, Array, Array]:
        """Mass, damping and stiffness of the rotor's own coordinates, shape (r^2,) and (n, r^2) twice."""
        own = slice(0, len(self.mass) - 2 * sum(len(circle.moment) for _, circle in self.circles))
        count = len(self.damping)
        damping, stiffness = (part[:, own, own].reshape(count, -1) for part in (self.damping, self.stiffness))
        return self.mass[own, own].ravel(), damping, stiffness


def standing_matrices(system: RotorSystem, layers: Sequence[Placed], speed: Array) -> StandingMatrices:
    """Rotor and liquid as one linear system in the standing frame [theory: sections, eq. 10].

    Liquid without a free surface is part of the rotor's mass.
    """
    count, spin = len(system.coordinates), speed[:, None, None]
    circles = [(plane, circle_layer(layer)) for plane, layer in layers]
    size = count + 2 * sum(len(circle.moment) for _, circle in circles)
    mass, quarter = np.zeros((2, size, size))
    laminar = np.zeros((3, size, size))
    damping, stiffness = np.zeros((2, speed.size, size, size))
    mass[:count, :count] = system.mass
    damping[:, :count, :count] = system.damping + spin * system.gyroscopic
    stiffness[:, :count, :count] = system.stiffness
    first = count
    for plane, circle in circles:
        m, at = len(circle.moment), system.at(plane)
        own = slice(first, first + 2 * m)
        first += 2 * m
        pull = -circle.density * at.T @ _real(circle.moment[None])
        turn, unit = _real(1j * np.eye(m)), circle.density * np.eye(2 * m)
        mass[:count, :count] += circle.density * circle.liquid_area * at.T @ at
        mass[:count, own], mass[own, :count], mass[own, own] = pull, pull.T, unit
        # d/dt - i Omega takes the place of d/dt in what the liquid does in the drum.
        twist, spread = circle.density * _real(circle.gyration), circle.density * _real(circle.surface)
        damping[:, own, own] = 2.0 * spin * (twist - circle.density * turn) + circle.rate * unit
        stiffness[:, own, own] = (
            np.square(spin) * (spread - unit - 2.0 * turn @ twist)
            - circle.rate * circle.density * spin * turn
        )
        laminar[:, own, own] = circle.density * np.array([_real(part) for part in circle.laminar])
        quarter[own, own] = turn
    return StandingMatrices(mass, damping, stiffness, laminar, quarter, tuple(circles))


def standing_modes(
    system: RotorSystem, layers: Sequence[Placed], speed: Array, near: SystemModes | None = None
) -> SystemModes:
    """Whirl modes in the standing frame: all without laminar friction, with it those that grow most.

    `near`: as of `most_growing`.
    """
    found = standing_matrices(system, layers, speed)
    rows = np.zeros((2 * len(layers), len(found.mass)))
    for k, (plane, _) in enumerate(layers):
        rows[2 * k : 2 * k + 2, : len(system.coordinates)] = system.at(plane)
    own = np.eye(len(found.mass))[len(system.coordinates) :]
    circles = np.concatenate([rows, own])
    if not np.any(found.laminar):
        return linear_modes(CoupledMatrices(found.mass, found.damping, found.stiffness), circles)
    plates = _of_plates(found.laminar, speed)
    plain, slowly = (
        CoupledMatrices(
            found.mass,
            found.damping + drag,
            found.stiffness - speed[:, None, None] * found.quarter @ drag,
        )
        for drag in (plates, plates + np.sqrt(0.5 * _SLOW * speed)[:, None, None] * found.laminar[0])
    )
    turned = found.quarter @ found.laminar
    mass, laminar, every_damping, stiffness = (
        part.astype(complex)
        for part in (found.mass, np.concatenate([found.laminar, turned]), found.damping, found.stiffness)
    )  # once: products of complex and real arrays convert them each time, at eight times the cost

    def shears(root: Complex, owner: Index, part: int) -> Complex:
        # Either sense of circle slips by its own frequency over the drum.
        spin = speed[owner]
        one, other = (_shears(root + way * spin, spin)[part] for way in (-1j, 1j))
        return _mixed(np.concatenate([0.5 * (one + other), -0.5j * (one - other)]), laminar)

    def matrix(root: Complex, owner: Index) -> Complex:
        made = root[:, None, None] * mass
        made += every_damping[owner]
        made *= root[:, None, None]
        made += stiffness[owner]
        made += shears(root, owner, 0)
        return np.asarray(made)

    def slope(root: Complex, owner: Index) -> Complex:
        return np.asarray(2.0 * root[:, None, None] * mass + every_damping[owner] + shears(root, owner, 1))

    def every(owner: Index) -> Complex:
        drags = 0.5 * np.stack([found.laminar[0] - 1j * turned[0], found.laminar[0] + 1j * turned[0]])
        return standing_roots(plain.at(owner), np.asarray(drags, dtype=complex), speed[owner])

    drag, condensed = _drag(found.mass, found.laminar), partial(standing_determinant, system, found, speed)
    search = MostGrowing(speed, 1.0, slowly, drag, circles, matrix, slope, condensed, every)
    return most_growing(search, near)


def standing_determinant(
    system: RotorSystem, found: StandingMatrices, speed: Array, root: Complex, owner: Index
) -> Complex:
    """log det T(lambda) at points, shape (k,), each layer eliminated in its own circles.

    A circle with the spin and one against it do not mix, and each acts on the rotor by one number
    [theory: sections, eq. 12]; the phase but for whole turns.
    """
    count, spin = len(system.coordinates), speed[owner]
    mass, damping, stiffness = found.rotor
    rotor = root[:, None] * (root[:, None] * mass + damping[owner]) + stiffness[owner]
    total = np.zeros(root.shape, dtype=complex)
    known: list[tuple[CircleLayer, Any]] = []
    pulls, pulled = list[Complex](), list[Complex]()
    for plane, circle in found.circles:
        same = [answer for other, answer in known if _same_circle(circle, other)]
        answers = same[0] if same else _circle_answers(circle, root, spin)
        known += [] if same else [(circle, answers)]
        at = system.at(plane)
        for sense, (log_size, answer) in zip((-1j, 1j), answers, strict=True):
            pull = at.T @ np.array([1.0, sense]) / np.sqrt(2.0)
            pulls.append(np.square(np.square(root)) * answer)
            pulled.append(np.outer(pull, pull.conj()).ravel())
            total += log_size
    rotor -= np.stack(pulls, axis=1) @ np.array(pulled)
    unit, size = np.linalg.slogdet(rotor.reshape(-1, count, count))
    return np.asarray(total + size + 1j * np.angle(unit))


def _circle_answers(circle: CircleLayer, root: Complex, spin: Array) -> list[tuple[Complex, Complex]]:
    """log det of a layer's motions and what they answer, rho p L^-1 p*, with the spin and against it."""
    from solvers.whirl.elimination import eliminated

    found, m = [], len(circle.moment)
    parts = np.stack([np.eye(m), circle.gyration, circle.surface, *circle.laminar])
    for sense in (-1j, 1j):
        slip = root + sense * spin
        steady = np.stack([slip * (slip + circle.rate), 2.0 * spin * slip, np.square(spin)])
        weights = np.concatenate([steady, _shears(slip, spin)[0]])
        shown, moment = (parts, circle.moment) if sense == -1j else (parts.conj(), circle.moment.conj())
        bordered = np.zeros((root.size, m + 1, m + 1), dtype=complex)
        bordered[:, :m, :m] = (weights.T @ shown.reshape(len(parts), -1)).reshape(-1, m, m)
        bordered[:, m, :m], bordered[:, :m, m] = moment, moment.conj()
        size, left = eliminated(bordered)
        found.append((np.asarray(size + m * np.log(circle.density)), -circle.density * left))
    return found


def _same_circle(one: CircleLayer, other: CircleLayer) -> bool:
    """Whether two layers are alike to the last digit."""
    return all(
        np.array_equal(getattr(one, part.name), getattr(other, part.name)) for part in fields(CircleLayer)
    )


def _real(matrix: Any) -> Array:
    """A complex matrix over real and imaginary parts, shape (r, m) to (2 r, 2 m)."""
    made = np.kron(matrix.real, np.eye(2)) + np.kron(matrix.imag, _TURN)
    return np.asarray(made)
