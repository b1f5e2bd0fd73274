"""Where a rotor with liquid resonates: the tops of planar machines, and the resonances of any other rotor.

At the largest deflection of a planar rotor the deflection is stationary over the speed, and so is the mass
that the liquid adds: the top is that of a linear rotor of this mass [theory: rotor, eq. 33], found however
narrow the resonance is and wherever the curve folds.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill, Fills
from meshes.arrays import Array, Flags, Index
from solvers.liquid_model import LiquidModel, Whirls
from solvers.roots import bracketed_root
from solvers.rotor.jeffcott import PlanarMachine
from solvers.rotor.system import RotorSystem
from solvers.synchronous.balance import backward_mass, directions

_STEPS = 3  # towards the top of a machine whose axis stands
_NEAR = 1e-4  # relative distance of the speeds between which the liquid's share in the mass changes


@dataclass(frozen=True)
class Tops:
    """The largest deflection of planar machines over all speeds; shape (n,)."""

    speed: Array  #: rad/s; nan where there is none: nothing moves the rotor, or too much damps it
    amplitude: Array  #: m; infinite without damping
    half_width: Array  #: of the resonance, rad/s


def planar_tops(machines: Sequence[PlanarMachine], gravity: Array, model: LiquidModel) -> Tops:
    """Tops of the resonance curves of planar machines [theory: rotor, eq. 33 and 34]."""
    rotors = np.array([(r.mass, r.stiffness, r.damping, r.unbalance) for r, _ in machines]).reshape(-1, 4)
    mass, stiffness, damping, force = np.ascontiguousarray(rotors.T)
    liquid = _Liquid.of(machines, gravity, model)
    full, own = liquid.added_mass, liquid.mass
    speed, amplitude, total = np.full((3, len(machines)), np.nan)
    # Without damping the deflection grows without bound where the liquid left behind is a dead mass.
    free = (force > 0.0) & (damping == 0.0)
    total[free] = (mass + np.where(liquid.straight(np.sqrt(stiffness / mass)), full, own))[free]
    speed[free], amplitude[free] = np.sqrt(stiffness / total)[free], np.inf
    rows = np.flatnonzero((force > 0.0) & (damping > 0.0))
    curve = _Curve(*(x[rows] for x in (mass, stiffness, damping, force)))
    total[rows] = mass[rows] + full[rows]
    speed[rows], amplitude[rows] = curve.top(np.arange(rows.size), total[rows], np.zeros(rows.size))
    # Wet all over, the liquid has its full mass whatever the deflection and the speed.
    known = np.isfinite(speed[rows])
    known[known] = amplitude[rows[known]] <= liquid.limit(rows[known], speed[rows[known]])
    # Too much damping for a top whatever the liquid's share in the mass: none, as above.
    low, high = _masses(curve, full[rows])
    sought = ~known & (low < high)
    rows, curve = rows[sought], curve.at(sought)
    if rows.size:
        total[rows], speed[rows], amplitude[rows] = _bent(curve, liquid, rows)
    return Tops(speed, amplitude, 0.5 * damping / total)


def _bent(curve: _Curve, liquid: _Liquid, rows: Index) -> tuple[Array, Array, Array]:
    """Mass, speed and deflection at the tops of machines with a wall that runs dry; nan where none is."""
    least, most = _masses(curve, liquid.added_mass[rows])
    total, change = most, np.zeros(rows.size)
    for _ in range(_STEPS if np.any(liquid.gravity[rows] > 0.0) else 1):

        def missing(mass: Array, which: Index) -> Array:
            speed, deflection = curve.top(which, mass, change[which])
            return np.asarray(curve.mass[which] + liquid.share(rows[which], deflection, speed) - mass)

        total, met = bracketed_root(missing, least, most)
        total = np.where(met, total, np.nan)
        speed, deflection = curve.top(np.arange(rows.size), total, change)
        # Upright, the liquid's share in the mass depends on the speed itself as well.
        upright = np.flatnonzero((liquid.gravity[rows] > 0.0) & met)
        if upright.size:
            near = speed[upright] * (1.0 + np.array([-_NEAR, _NEAR])[:, None])
            size = np.tile(deflection[upright], 2)
            shares = liquid.share(np.tile(rows[upright], 2), size, near.ravel()).reshape(2, -1)
            change[upright] = 0.25 * (shares[1] - shares[0]) / _NEAR
    return total, speed, deflection


def _masses(curve: _Curve, added: Array) -> tuple[Array, Array]:
    """Least and largest mass with the liquid's share at which a top may be; none between where they cross."""
    # With less mass than that the deflection rises without end.
    least = np.maximum(
        curve.mass * (1.0 - 1e-12), 0.5 * np.square(curve.damping) / curve.stiffness * (1.0 + 1e-9)
    )
    return least, curve.mass + added * (1.0 + 1e-9)


@dataclass(frozen=True)
class _Curve:
    """Damped rotors M, K, C with unbalance U, shape (n,)."""

    mass: Array
    stiffness: Array
    damping: Array
    force: Array

    def at(self, which: Index | Flags) -> _Curve:
        """Curves of some rotors."""
        return _Curve(*(x[which] for x in (self.mass, self.stiffness, self.damping, self.force)))

    def top(self, which: Index, mass: Array, change: Array) -> tuple[Array, Array]:
        """Speed and deflection at which the deflection is stationary; nan where there is none.

        `change`: half the derivative of the mass over the logarithm of the speed, kg.
        """
        stiffness, damping, force = (x[which] for x in (self.stiffness, self.damping, self.force))
        # Both conditions, squared speeds eliminated [theory: rotor, eq. 34].
        first = stiffness * (mass - change) - 0.5 * np.square(damping)
        under = np.square(first) + 4.0 * mass * change * np.square(stiffness)
        below = first + np.sqrt(np.maximum(under, 0.0))
        sound = (under >= 0.0) & (below > 0.0)
        squared = np.divide(2.0 * np.square(stiffness), below, out=np.full(mass.shape, np.nan), where=sound)
        speed = np.sqrt(squared)
        held = np.hypot(stiffness - mass * squared, damping * speed)
        return speed, np.asarray(force * squared / held)


@dataclass(frozen=True)
class _Liquid:
    """The liquid of all chambers of planar machines."""

    fills: Fills  #: chambers with liquid, of all machines, shape (c,)
    owner: Index  #: the machine of each, shape (c,)
    gravity: Array  #: of each machine, shape (n,)
    mass: Array
    added_mass: Array
    model: LiquidModel  #: of the liquid

    @classmethod
    def of(cls, machines: Sequence[PlanarMachine], gravity: Array, model: LiquidModel) -> _Liquid:
        """Liquid of some machines."""
        wet = [(k, fill) for k, (_, fills) in enumerate(machines) for fill in fills if fill.volume > 0.0]
        owner, fills = np.array([k for k, _ in wet], dtype=np.intp), Fills.of([fill for _, fill in wet])
        mass, added_mass = (
            np.bincount(owner, x, minlength=len(machines)).astype(float)
            for x in (fills.mass, fills.added_mass)
        )
        return cls(fills, owner, gravity, mass, added_mass, model)

    def share(self, rows: Index, deflection: Array, speed: Array) -> Array:
        """What the liquid adds to the mass of some machines: its unbalance over the deflection, kg."""
        chamber, place = self._chambers(rows)
        if chamber.size == 0:
            return np.zeros(rows.size)
        spin, own = speed[place], self.gravity[rows][place]
        pull = self.model.pull(self.fills.at(chamber), Whirls.synchronous(spin, deflection[place], own))
        return np.asarray(np.bincount(place, pull, minlength=rows.size) / deflection)

    def limit(self, rows: Index, speed: Array) -> Array:
        """Deflection up to which every chamber of some machines adds its full mass, m."""
        found = np.full(rows.size, np.inf)
        chamber, place = self._chambers(rows)
        if chamber.size:
            own = self.model.linear_limit(self.fills.at(chamber), speed[place], self.gravity[rows][place])
            np.minimum.at(found, place, own)
        return found

    def straight(self, speed: Array) -> Flags:
        """Whether every chamber adds its full mass however large the deflection is."""
        return np.isinf(self.limit(np.arange(speed.size), speed))

    def _chambers(self, rows: Index) -> tuple[Index, Index]:
        """Chambers of some machines, and the place of each one's machine among them."""
        order = np.argsort(self.owner, kind="stable")
        first = np.searchsorted(self.owner[order], rows)
        count = np.searchsorted(self.owner[order], rows, side="right") - first
        place = np.repeat(np.arange(rows.size), count)
        within = np.arange(place.size) - np.repeat(np.cumsum(count) - count, count)
        return order[np.repeat(first, count) + within], place


def resonances(system: RotorSystem, fills: Sequence[Fill], share: float = 1.0) -> tuple[Array, Array]:
    """Speeds at which the unbalance meets a free vibration, rising, and half widths, rad/s.

    The liquid adds a `share` of its full mass. Zeros of the determinant of the dynamic stiffness
    [theory: rotor, eq. 29], a polynomial of the speed; their distance from the real axis is half the width.
    """
    from scipy.linalg import eigvals

    wet = [fill for fill in fills if fill.volume > 0.0]
    inertia = (system.mass - 1j * system.gyroscopic).astype(complex)
    for fill, p in zip(wet, directions(system, wet), strict=True):
        inertia += 0.5 * share * fill.added_mass * np.outer(p, np.conj(p))
        inertia += 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
    n, stiffest, heaviest = len(system.coordinates), np.abs(system.stiffness).max(), system.mass.max()
    if stiffest == 0.0:
        return np.zeros(0), np.zeros(0)
    # Scaled, so that turns count as much as shifts, and speeds are of order 1.
    scale = np.sqrt(np.diag(system.mass) / heaviest)
    weight, rate = scale[:, None] * scale, np.sqrt(stiffest / heaviest)
    stiffness = system.stiffness / weight / stiffest
    damping = system.damping / weight * rate / stiffest
    first, second = np.zeros((2, 2 * n, 2 * n), dtype=complex)
    first[:n, n:], first[n:, :n], first[n:, n:] = np.eye(n), stiffness, 1j * damping
    second[:n, :n], second[n:, n:] = np.eye(n), inertia / weight / heaviest
    value = eigvals(first, second) * rate
    value = value[np.isfinite(value) & (value.real > 1e-6 * rate)]
    order = np.argsort(value.real, kind="stable")
    return np.asarray(value.real[order]), np.asarray(np.abs(value.imag[order]))
