"""Harmonic balance of any rotor with liquid in its chambers [theory: rotor, eq. 28 and 29].

The forward part of the orbit at each chamber meets the liquid model, the backward part a mass by linear
theory whatever the model: by finite elements with baffles in the liquid or a section that is no circle, the
only part of the synchronous answer that needs sloshing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fluid.fill import Fill, Fills
from fluid.friction.laws import NO_FRICTION
from fluid.waves import force_ratio
from meshes.arrays import Array, Complex, Flags, Index
from solvers.liquid_model import LiquidModel, Whirls
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import dynamic_stiffness, solve_each
from solvers.sloshing.reduced import section_layer


def backward_mass(fill: Fill) -> float:
    """Mass with which a layer resists a backward whirl at the speed of its spin, kg.

    m_f G(kappa, -1), G = 1 - 8/(1 + 7 kappa) [theory: rotor, eq. 28]; the liquid's where it fills its
    chamber; with baffles the part of the answer that turns with the whirl.
    """
    full = fill.volume >= fill.chamber.capacity * (1.0 - 1e-9)
    if full or fill.surface_radius == 0.0:
        return fill.mass
    if fill.uneven:
        layer = section_layer(fill, NO_FRICTION)
        assert layer is not None
        whole = layer.density * layer.liquid.enclosed_area
        return whole * float(layer.liquid.force_ratio([-2.0])[0])
    curvature = (fill.chamber.radius / fill.surface_radius) ** 2
    return fill.full_mass * float(force_ratio(curvature, -1.0)) if curvature > 1.0 else 0.0


@dataclass(frozen=True)
class Liquid:
    """The liquid of c chambers at k states."""

    #: first moments about the rotation axis U_liq, kg m, complex where liquid pulls across, shape (k, c)
    unbalance: Array | Complex
    slope: Array | Complex  #: their derivatives with respect to the deflection, kg, shape (k, c)
    dry_patch: Flags  #: shape (k, c)
    in_range: Flags
    converged: Flags


@dataclass(frozen=True)
class Balance:
    """Equations [theory: rotor, eq. 29] of n coordinates and c chambers at s pairs of volumes and a speed."""

    system: RotorSystem  #: the dry rotor
    speed: Array  #: Omega, rad/s, shape (s,)
    owner: Index  #: which set of volumes each pair has, rising, shape (s,)
    stiffness: Complex  #: dynamic stiffness with the liquid's answer to the backward part, shape (s, n, n)
    force: Complex  #: Omega^2 U, shape (s, n)
    plane: Complex  #: p = B^T (1, -i) of each chamber, shape (c, n)
    fills: tuple[Fills, ...]  #: of each chamber those of all pairs, shape (s,); every one has liquid
    backward_mass: Array  #: with which each chamber resists the backward part, kg, shape (s, c)
    added_mass: Array  #: full mass of each chamber, kg, shape (s, c)
    steepest: Array  #: no smaller than the slope of all chambers' unbalance anywhere, kg, shape (s,)
    limit: Array  #: forward deflection up to which a chamber adds exactly its full mass, m, shape (s, c)
    model: LiquidModel  #: of the liquid
    gravity: float  #: along the axis, m/s^2

    @property
    def mass(self) -> Array:
        """Mass of all the liquid, kg, shape (s,)."""
        return np.asarray(sum((fills.mass for fills in self.fills), np.zeros(self.speed.size)))

    def moved(self, which: Index, speed: Array) -> Balance:
        """The balance of some of its pairs at other speeds."""
        chambers = tuple(fills.at(which) for fills in self.fills)
        back, owner = self.backward_mass[which], self.owner[which]
        return _balance(self.system, self.plane, chambers, back, owner, speed, self.gravity, self.model)

    def forward(self, answer: Complex) -> Complex:
        """Forward deflection at each chamber, m, shape (k, c), for coordinates of shape (k, n)."""
        return np.asarray(0.5 * answer @ np.conj(self.plane).T)

    def linear(self, which: Index, share: Array | float = 1.0) -> Complex:
        """Coordinates if each chamber adds a share of its full mass, shape (k, n)."""
        size = (share * np.square(self.speed[which]))[:, None] * self.added_mass[which]
        added = 0.5 * np.einsum("kc,ci,cj->kij", size, self.plane, np.conj(self.plane))
        return solve_each(self.stiffness[which] - added, self.force[which])

    def liquid(self, which: Index, deflection: Array) -> Liquid:
        """Law of each chamber at forward deflections."""
        shape = deflection.shape
        across = self.model.across
        slope = self.added_mass[which].astype(complex if across else float)
        unbalance = slope * deflection
        flags = np.zeros(shape, dtype=bool), np.ones(shape, dtype=bool), np.ones(shape, dtype=bool)
        bent = ~(deflection <= self.limit[which])
        for j, fills in enumerate(self.fills):
            # The law costs most of the time, and up to the limit it is known.
            rows = np.flatnonzero(bent[:, j])
            if rows.size:
                own, gravity = which[rows], np.full(rows.size, self.gravity)
                whirls = Whirls.synchronous(self.speed[own], deflection[rows, j], gravity)
                law = self.model.answer(fills.at(own), whirls)
                slope[rows, j] = law.slope
                unbalance[rows, j] = law.unbalance if across else law.real_unbalance()
                for flag, found in zip(flags, (law.dry_patch, law.in_range, law.converged), strict=True):
                    flag[rows, j] = found
        return Liquid(unbalance, slope, *flags)

    def pull(self, which: Index, deflection: Array) -> Array:
        """First moment of the liquid of all chambers at one forward deflection of all, kg m, shape (k,)."""
        total = np.zeros(deflection.shape)
        for j, fills in enumerate(self.fills):
            line = self.added_mass[which, j] * deflection
            rows = np.flatnonzero(~(deflection <= self.limit[which, j]))
            if rows.size:
                own, gravity = which[rows], np.full(rows.size, self.gravity)
                whirls = Whirls.synchronous(self.speed[own], deflection[rows], gravity)
                line[rows] = self.model.pull(fills.at(own), whirls)
            total += line
        return total

    def told(self, which: Index, answer: Complex) -> Liquid:
        """Law of each chamber at solutions, the flags asked of the model even if its law is straight there.

        What moves the surface most over a turn counts: the forward part, and the wave of the backward one
        [theory: rotor, eq. 28].
        """
        forward, backward = np.abs(self.forward(answer)), 0.5 * np.abs(answer @ self.plane.T)
        law = self.liquid(which, forward)
        dry, in_range = law.dry_patch.copy(), law.in_range.copy()
        along = np.full(which.size, self.gravity)
        for j, fills in enumerate(self.fills):
            own = fills.at(which)
            moved = forward[:, j] + _backward_displacement(own) * backward[:, j]
            found = self.model.answer(own, Whirls.synchronous(self.speed[which], moved, along))
            dry[:, j], in_range[:, j] = found.dry_patch, found.in_range
        return replace(law, dry_patch=dry, in_range=in_range)


def _backward_displacement(fills: Fills) -> Array:
    """Displacement of the surface in a backward whirl over its amplitude, shape (n,).

    (kappa - 1)/(1 + 7 kappa), of a clear ring [theory: waves, eq. 4].
    """
    outer = np.square(fills.chamber.radius)
    film = fills.depth * (2.0 * fills.chamber.radius - fills.depth)
    return np.asarray(film / (8.0 * outer - film))


def harmonic_balance(
    system: RotorSystem,
    sets: Sequence[Sequence[Fill]],
    owner: Index,
    speed: Array,
    gravity: float,
    model: LiquidModel,
) -> Balance:
    """Terms of the harmonic balance [theory: rotor, eq. 28 and 29].

    Sets have the same chambers with other volumes; `owner` is the set of each pair, rising.
    """
    wet = [[fill for fill in fills if fill.volume > 0.0] for fills in sets]
    chambers = tuple(Fills.of(column).at(owner) for column in zip(*wet, strict=True))
    back = np.array([[backward_mass(fill) for fill in fills] for fills in wet])[owner]
    plane = directions(system, wet[0])
    return _balance(system, plane, chambers, back, owner, speed, gravity, model)


def _balance(
    system: RotorSystem,
    plane: Complex,
    chambers: tuple[Fills, ...],
    back: Array,
    owner: Index,
    speed: Array,
    gravity: float,
    model: LiquidModel,
) -> Balance:
    """Terms for the chambers and their backward masses of each pair, all of which have liquid."""
    squared, along = np.square(speed), np.full(speed.size, gravity)
    stiffness = dynamic_stiffness(system, speed)
    for j, p in enumerate(plane):
        held = 0.5 * squared * back[:, j]
        stiffness = stiffness - held[:, None, None] * np.outer(np.conj(p), p)
    nothing = np.zeros((speed.size, 0))
    limits = [model.linear_limit(fills, speed, along)[:, None] for fills in chambers]
    return Balance(
        system=system,
        speed=speed,
        owner=owner,
        stiffness=stiffness,
        force=squared[:, None] * system.unbalance,
        plane=plane,
        fills=chambers,
        backward_mass=back,
        added_mass=np.hstack([nothing, *(model.added_mass(fills)[:, None] for fills in chambers)]),
        steepest=sum((model.steepest(fills) for fills in chambers), np.zeros(speed.size)),
        limit=np.hstack([nothing, *limits]),
        model=model,
        gravity=gravity,
    )


def directions(system: RotorSystem, fills: Sequence[Fill]) -> Complex:
    """p = B^T (1, -i) of each chamber: a forward force F on it acts on the coordinates with p F, (c, n)."""
    return directions_at(system, [fill.chamber.plane for fill in fills])


def directions_at(system: RotorSystem, positions: Sequence[float]) -> Complex:
    """p = B^T (1, -i) of places along the axis, m, shape (k, n)."""
    found = np.zeros((len(positions), len(system.coordinates)), dtype=complex)
    for j, position in enumerate(positions):
        found[j] = system.at(position).T @ np.array([1.0, -1j])
    return found
