"""What a whirling rotor knows of the liquid in a chamber of any section: few motions and their friction."""

from __future__ import annotations

import gc
import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import TYPE_CHECKING, Any

import numpy as np
import scipy
from numpy.typing import ArrayLike

from fluid.fill import Fill
from fluid.friction.laws import Friction, layer_thickness
from fluid.whirl import is_full, plane_layer
from meshes.arrays import Array, Complex
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.chamber_section import ChamberSection, liquid_of

if TYPE_CHECKING:
    from meshes.liquid_section import LiquidSection
    from solvers.sloshing.sector import SectorSystem, Slip
    from solvers.sloshing.system import LiquidSystem

# Slip at which the thickness of the layer at edges is taken, rad/s: twice as thick a layer changes the drag
# by some per cent.
_SLIP = 10.0
# Frequencies over the spin whose answers are kept, off the real axis where no wave resonates; with them go
# rest and the limit of very fast whirl.
KEPT = (0.2 + 0.08j, 0.45 + 0.12j, 0.75 + 0.15j, 1.1 + 0.2j, 1.6 + 0.4j)
_DISTINCT = 1e-10  # of a new answer that must stand across the others
_TURN = np.array([[0.0, -1.0], [1.0, 0.0]])  # a quarter turn with the spin: multiplies by i


@dataclass(frozen=True, eq=False)
class ReducedLiquid:
    """K eta'' + 2 Omega C eta' + Omega^2 B eta = -P^T f and Q = -rho P eta, in m motions."""

    inertia: Array  #: K, the unit matrix, shape (m, m)
    gyration: Array  #: C, antisymmetric, shape (m, m)
    surface: Array  #: B, symmetric, positive definite, shape (m, m)
    moment: Array  #: P, shape (2, m), m
    motions: Array  #: what they are in the condensed unknowns, shape (n, m)
    liquid_area: float  #: as in `LiquidSystem`, m^2
    enclosed_area: float

    def compliance(self, slip_ratio: ArrayLike) -> Complex:
        """First moment of the displaced liquid for a uniform force [theory: sections, eq. 2].

        Q Omega^2/(rho h f), shape (k, 2, 2), m^2, for f e^{i s t} in the drum's frame at s/Omega, shape (k,).
        """
        s = np.asarray(slip_ratio, dtype=complex)[:, None, None]
        matrix = -np.square(s) * self.inertia + 2j * s * self.gyration + self.surface
        drive = np.broadcast_to(self.moment.T, (len(s), *self.moment.T.shape))
        return np.asarray(self.moment @ np.linalg.solve(matrix, drive))

    def force_ratio(self, slip_ratio: ArrayLike) -> Array:
        """Force on a drum that whirls in a circle over that of a full one, as far as it turns with the whirl.

        G [theory: sections, eq. 2] for s/Omega of the whirl as seen from the drum, shape (k,).
        """
        s, found = np.asarray(slip_ratio, dtype=float), self.compliance(slip_ratio)
        along, across = found[:, 0, 0] + found[:, 1, 1], found[:, 0, 1] - found[:, 1, 0]
        moved = 0.5 * (along - 1j * across).real
        return np.asarray((self.liquid_area + np.square(1.0 + s) * moved) / self.enclosed_area)


def reduce_liquid(system: LiquidSystem) -> ReducedLiquid:
    """Keep the motions that answer a uniform force [theory: sections, eq. 1]."""
    root = scipy.linalg.cholesky(system.inertia, lower=True)

    def scaled(matrix: Array) -> Array:
        half = scipy.linalg.solve_triangular(root, matrix, lower=True)
        return np.asarray(scipy.linalg.solve_triangular(root, half.T, lower=True).T)

    gyration, surface = scaled(system.gyration), scaled(system.surface)
    drive = scipy.linalg.solve_triangular(root, system.moment.T, lower=True)
    answers = [drive, np.linalg.solve(surface, drive)]
    unit = np.eye(len(drive))
    for s in KEPT:
        answer = np.linalg.solve(-s * s * unit + 2j * s * gyration + surface, drive)
        answers += [answer.real, answer.imag]
    basis = spanned(np.hstack(answers))
    motions = scipy.linalg.solve_triangular(root.T, basis, lower=False)
    turn, spread = (basis.T @ matrix @ basis for matrix in (gyration, surface))
    return ReducedLiquid(
        inertia=np.eye(basis.shape[1]),
        gyration=0.5 * (turn - turn.T),
        surface=0.5 * (spread + spread.T),
        moment=drive.T @ basis,
        motions=np.asarray(motions),
        liquid_area=system.liquid_area,
        enclosed_area=system.enclosed_area,
    )


def spanned(vectors: Any, distinct: float = _DISTINCT) -> Any:
    """Orthonormal columns that span others, save vectors with less than `distinct` across the ones before."""
    kept: list[Any] = []
    for vector in vectors.T:
        left = vector / np.linalg.norm(vector)
        for _ in range(2):  # twice is enough
            for other in kept:
                left = left - other * np.vdot(other, left)
        size = float(np.linalg.norm(left))
        if size > distinct:
            kept.append(left / size)
    return np.stack(kept, axis=1)


@dataclass(frozen=True, eq=False)
class SectionLayer:
    """Liquid of one or several equal chambers in one plane."""

    density: float  #: rho h of all of them together, kg/m^2
    liquid: ReducedLiquid  #: its motions
    rate: float  #: k of linear friction, 1/s
    #: S of laminar friction on walls, and of floor and lid along and across the velocity, shape (3, m, m),
    #: s^(-1/2) [theory: sections, eq. 5]
    laminar: Array


def section_layer(fill: Fill, friction: Friction) -> SectionLayer | None:
    """Layer of a fill under a law of friction; None without liquid or without a free surface.

    A clear ring is known analytically, baffles and other sections are computed by finite elements.
    """
    if fill.volume == 0.0 or is_full(fill):
        return None
    chamber = fill.chamber
    density = fill.liquid.density * chamber.height
    # Friction without walls is that of a clear ring of the same liquid about the same free surface.
    radius = math.hypot(fill.surface_radius, math.sqrt(fill.volume / (math.pi * chamber.height)))
    plain = plane_layer(Fill(Chamber(radius, chamber.height), fill.liquid, fill.volume), friction)
    assert plain is not None
    if not fill.uneven:
        liquid = clear_ring(chamber.radius, fill.surface_radius)
        walls = plain.stokes * liquid.inertia
    else:
        stokes = math.sqrt(fill.liquid.viscosity) if friction.law.laminar else 0.0
        # Of a fluid layer of that thickness at the edges of baffles.
        cut = float(layer_thickness(fill.liquid.viscosity, _SLIP)) if stokes else 0.0
        if chamber.section is None:
            liquid, drag = _of_baffles(fill, cut)
        else:
            liquid, drag = _any_section(chamber.section, fill.surface_radius, cut)
        walls = stokes * drag
    laminar = np.stack([walls, plain.lids * liquid.inertia, plain.lids * liquid.gyration])
    return SectionLayer(density, liquid, plain.rate, laminar)


def _of_baffles(fill: Fill, cut: float) -> tuple[ReducedLiquid, Array]:
    """Motions and wall drag of a ring with baffles, from one of unit radius with the first at angle 0."""
    radius, baffles = fill.chamber.radius, fill.chamber.baffles
    assert baffles is not None
    unit = Baffles(baffles.count, baffles.tip_radius / radius, baffles.wall_gap / radius)
    reduced, drag = _baffled_ring(fill.surface_radius / radius, unit, cut / radius)
    liquid = replace(
        reduced,
        moment=reduced.moment * radius,
        liquid_area=reduced.liquid_area * radius**2,
        enclosed_area=reduced.enclosed_area * radius**2,
    )
    return liquid, drag / radius


def section_layers(fills: Sequence[Fill], friction: Friction) -> tuple[float, list[SectionLayer]]:
    """Mass of all liquid that has no free surface, kg, and the layers of chambers that move alike.

    Equal layers count as one: sloshing against one another they leave the rotor alone and do not grow.
    """
    solid, found = 0.0, dict[tuple[object, ...], list[Fill]]()
    for fill in fills:
        if is_full(fill):
            solid += fill.mass
        else:
            found.setdefault((replace(fill.chamber, plane=0.0), fill.liquid, fill.volume), []).append(fill)
    layers = []
    for same in found.values():
        layer = section_layer(same[0], friction)
        if layer is not None:
            layers.append(replace(layer, density=len(same) * layer.density))
    return solid, layers


def clear_ring(radius: float, surface_radius: float) -> ReducedLiquid:
    """The two motions of a ring without baffles that a whirl drives [theory: sections, eq. 4]."""
    tangent = math.tanh(math.log(radius / surface_radius))
    turn = np.array([[0.0, 1.0], [-1.0, 0.0]])
    return ReducedLiquid(
        inertia=np.eye(2),
        gyration=tangent * turn,
        surface=tangent * np.eye(2),
        moment=-surface_radius * math.sqrt(math.pi * tangent) * turn,
        motions=np.zeros((0, 2)),
        liquid_area=math.pi * (radius - surface_radius) * (radius + surface_radius),
        enclosed_area=math.pi * radius**2,
    )


def _baffled_ring(surface_radius: float, baffles: Baffles, cut: float) -> tuple[ReducedLiquid, Array]:
    """Of a ring of unit radius; the slowest waves to 4e-5 of their frequencies."""
    if baffles.count < 3:  # which answer differently in two directions
        return _few_baffles(surface_radius, baffles, cut)
    liquid, slip = _sector(surface_radius, baffles)
    return liquid, over_parts(slip.drag(cut))


@lru_cache(maxsize=64)
def _few_baffles(surface_radius: float, baffles: Baffles, cut: float) -> tuple[ReducedLiquid, Array]:
    from meshes.rings.quadrilaterals import ring

    return _reduced(ring(1.0, surface_radius, 64, 4, baffles=baffles), cut)


@lru_cache(maxsize=256)
def _sector(surface_radius: float, baffles: Baffles) -> tuple[ReducedLiquid, Slip]:
    """Motions from one of three sectors and more, and what they do along the walls."""
    from solvers.sloshing.sector import condense_sector

    system = condense_sector(1.0, surface_radius, baffles)
    motions = _driven(system)
    gyration, surface = (motions.conj().T @ form @ motions for form in (system.gyration, system.surface))
    p = system.moment @ motions
    liquid = ReducedLiquid(
        inertia=np.eye(2 * len(p)),
        gyration=over_parts(0.5 * (gyration - gyration.conj().T)),
        surface=over_parts(0.5 * (surface + surface.conj().T)),
        moment=over_parts(p[None]),
        motions=np.zeros((0, 2 * len(p))),
        liquid_area=system.liquid_area,
        enclosed_area=system.enclosed_area,
    )
    slip = system.slip(motions)
    gc.collect(0)  # meshes and bases of scikit-fem refer to each other, a megabyte each time
    return liquid, slip


def _driven(system: SectorSystem) -> Complex:
    """Motions of unit inertia that span the answers to a force in either sense, shape (m, k)."""
    root = scipy.linalg.cholesky(system.inertia, lower=True)
    half = scipy.linalg.solve_triangular(root, np.eye(len(root)), lower=True)
    gyration, surface = (half @ form @ half.conj().T for form in (system.gyration, system.surface))
    drive = half @ system.moment.conj()[:, None]
    answers = [drive, np.linalg.solve(surface, drive)]
    answers += [
        np.linalg.solve(-s * s * np.eye(len(root)) + 2j * s * gyration + surface, drive)
        for point in KEPT
        for s in (point, -point.conjugate())
    ]
    return np.asarray(half.conj().T @ spanned(np.hstack(answers)))


def over_parts(matrix: Any) -> Array:
    """A complex matrix over real and imaginary parts, shape (r, m) to (2 r, 2 m)."""
    return np.asarray(np.kron(matrix.real, np.eye(2)) + np.kron(matrix.imag, _TURN))


@lru_cache(maxsize=256)
def _any_section(section: ChamberSection, surface_radius: float, cut: float) -> tuple[ReducedLiquid, Array]:
    """Of a section of its own."""
    return _reduced(liquid_of(section, surface_radius), cut)


def _reduced(mesh: LiquidSection, cut: float) -> tuple[ReducedLiquid, Array]:
    """Motions that a whirl drives, and their drag on the walls."""
    from solvers.sloshing.system import condense

    system = condense(mesh)
    reduced = reduce_liquid(system)
    return reduced, wall_drag(mesh, np.asarray(system.on_nodes(reduced.motions.T).real), cut)


def wall_drag(section: LiquidSection, motions: Array, cut: float = 0.0) -> Array:
    """Integral of products of tangential displacements along walls and both sides of baffles, (m, m).

    1/m for motions without unit, stream functions on the nodes, (m, N); `cut` is the thickness of the layer
    that does not see the edges of baffles, m [theory: sloshing, eq. 23].
    """
    from solvers.sloshing.forced import wall_weights

    slope, weights = wall_weights(section, np.array(cut))
    along = np.asarray(slope @ motions.T)
    return np.asarray(along.T @ (weights[:, None] * along))
