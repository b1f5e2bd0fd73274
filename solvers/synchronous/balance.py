"""Harmonic balance of any rotor with liquid in its chambers [theory: rotor, eq. 28 and 29].

The forward part of the orbit at each chamber meets the liquid model, the backward part a mass. That mass
follows from linear theory whatever the model; where baffles stand in the liquid or the section is no circle
it takes finite elements, which is all that the synchronous answer takes from sloshing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill, Fills
from fluid.friction import NO_FRICTION
from fluid.waves import force_ratio
from meshes.arrays import Array, Complex, Flags, Index
from solvers.liquid_model import LiquidModel, Whirls
from solvers.rotor.system import RotorSystem
from solvers.rotor.vibration import dynamic_stiffness, solve_each
from solvers.sloshing.reduced import section_layer


def backward_mass(fill: Fill) -> float:
    """Mass with which a layer resists a backward whirl at the speed of its spin, kg.

    m_f G(kappa, -1), G = 1 - 8/(1 + 7 kappa) [theory: rotor, eq. 28]; that of the liquid where it fills its
    chamber; with baffles in the liquid the part of the answer that turns with the whirl.
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
    """The liquid of c chambers at k states.

    Parameters
    ----------
    unbalance : first moments about the rotation axis U_liq, kg m, shape (k, c)
    slope : their derivatives with respect to the deflection, kg, shape (k, c)
    dry_patch, in_range, converged : shape (k, c)
    """

    unbalance: Array
    slope: Array
    dry_patch: Flags
    in_range: Flags
    converged: Flags


@dataclass(frozen=True)
class Balance:
    """Equations [theory: rotor, eq. 29] of n coordinates and c chambers with liquid at s speeds.

    Parameters
    ----------
    speed : Omega, rad/s, shape (s,)
    stiffness : dynamic stiffness with the liquid's answer to the backward part, shape (s, n, n)
    force : Omega^2 U, shape (s, n)
    plane : p = B^T (1, -i) of each chamber, shape (c, n)
    fills : the chambers with liquid
    limit : forward deflection up to which a chamber adds exactly its full mass, m, shape (s, c)
    model : of the liquid
    gravity : along the axis, m/s^2
    """

    speed: Array
    stiffness: Complex
    force: Complex
    plane: Complex
    fills: tuple[Fill, ...]
    limit: Array
    model: LiquidModel
    gravity: float

    @property
    def added_mass(self) -> Array:
        """Full mass of each chamber, kg, shape (c,)."""
        return self.model.added_mass(Fills.of(self.fills))

    def forward(self, answer: Complex) -> Complex:
        """Forward deflection at each chamber, m, shape (k, c), for coordinates of shape (k, n)."""
        return np.asarray(0.5 * answer @ np.conj(self.plane).T)

    def linear(self, which: Index, share: Array | float = 1.0) -> Complex:
        """Coordinates if each chamber adds a share of its full mass, shape (k, n).

        Parameters
        ----------
        which : of the speeds, shape (k,)
        share : shape (k,) or a number
        """
        full = self.added_mass
        added = 0.5 * np.einsum("c,ci,cj->ij", full, self.plane, np.conj(self.plane))
        size = (share * np.square(self.speed[which]))[:, None, None]
        return solve_each(self.stiffness[which] - size * added, self.force[which])

    def liquid(self, which: Index, deflection: Array) -> Liquid:
        """Law of each chamber at forward deflections.

        Parameters
        ----------
        which : of the speeds, shape (k,)
        deflection : m, shape (k, c)
        """
        shape = deflection.shape
        full = self.added_mass
        unbalance, slope = full * deflection, np.broadcast_to(full, shape).copy()
        flags = np.zeros(shape, dtype=bool), np.ones(shape, dtype=bool), np.ones(shape, dtype=bool)
        bent = ~(deflection <= self.limit[which])
        for j, fill in enumerate(self.fills):
            # The law costs most of the time, and up to the limit it is known.
            rows = np.flatnonzero(bent[:, j])
            if rows.size:
                same, gravity = Fills.same(fill, rows.size), np.full(rows.size, self.gravity)
                whirls = Whirls.synchronous(self.speed[which[rows]], deflection[rows, j], gravity)
                law = self.model.answer(same, whirls)
                unbalance[rows, j], slope[rows, j] = law.real_unbalance(), law.slope
                for flag, found in zip(flags, (law.dry_patch, law.in_range, law.converged), strict=True):
                    flag[rows, j] = found
        return Liquid(unbalance, slope, *flags)


def harmonic_balance(
    system: RotorSystem, fills: Sequence[Fill], speed: Array, gravity: float, model: LiquidModel
) -> Balance:
    """Terms of the harmonic balance [theory: rotor, eq. 28 and 29].

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers; those without liquid are left out
    speed : Omega, rad/s, shape (s,), above 0
    gravity : along the axis, m/s^2
    model : of the liquid
    """
    wet = tuple(fill for fill in fills if fill.volume > 0.0)
    squared = np.square(speed)
    plane = directions(system, wet)
    stiffness = dynamic_stiffness(system, speed)
    for fill, p in zip(wet, plane, strict=True):
        back = 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
        stiffness = stiffness - squared[:, None, None] * back
    along = np.full(speed.size, gravity)
    limits = [model.linear_limit(Fills.same(fill, speed.size), speed, along) for fill in wet]
    return Balance(
        speed=speed,
        stiffness=stiffness,
        force=squared[:, None] * system.unbalance,
        plane=plane,
        fills=wet,
        limit=np.stack(limits, axis=1) if wet else np.zeros((speed.size, 0)),
        model=model,
        gravity=gravity,
    )


def directions(system: RotorSystem, fills: Sequence[Fill]) -> Complex:
    """p = B^T (1, -i) of each chamber: a forward force F on it acts on the coordinates with p F, (c, n)."""
    return directions_at(system, [fill.chamber.plane for fill in fills])


def directions_at(system: RotorSystem, positions: Sequence[float]) -> Complex:
    """The same of places along the axis, m, shape (k, n)."""
    found = np.zeros((len(positions), len(system.coordinates)), dtype=complex)
    for j, position in enumerate(positions):
        found[j] = system.at(position).T @ np.array([1.0, -1j])
    return found
