"""Where a rotor with liquid resonates: the tops of planar machines, and the resonances of any other rotor.

A planar rotor moves in a circle that lags the unbalance. Its deflections over all speeds are one curve with
the lag along it: with t the cotangent of the lag, the damper gives the deflection at a speed, and the balance
along it gives the speed [theory: rotor, eq. 33]. Where the curve folds over the speed, it does not fold over
the lag, so that its top is found like that of a linear rotor, however narrow it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from meshes.arrays import Array, Index
from solvers.liquid_model import LiquidModel
from solvers.roots import bracketed_root
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.rotor.system import RotorSystem
from solvers.synchronous.balance import backward_mass, directions
from solvers.synchronous.models import STATICS
from solvers.synchronous.pairs import pair_machines

_STEPS = 4  # towards the top
_NEAR = 1e-4  # relative distance of the speeds between which the liquid's share in the mass changes


@dataclass(frozen=True)
class Tops:
    """The largest deflection of planar machines over all speeds; shape (n,).

    Parameters
    ----------
    speed : rad/s; nan where there is none: nothing moves the rotor, or too much damps it
    amplitude : m; infinite without damping
    half_width : of the resonance, rad/s
    """

    speed: Array
    amplitude: Array
    half_width: Array


def planar_tops(machines: Sequence[PlanarMachine], gravity: Array, model: LiquidModel) -> Tops:
    """Tops of the resonance curves of planar machines [theory: rotor, eq. 33 to 35].

    Parameters
    ----------
    machines : rotors, each with its chambers and their liquid
    gravity : along the axis of each, m/s^2, shape (n,)
    model : of the liquid

    Returns
    -------
    Tops

    Examples
    --------
    Without liquid the amplitude is e/(2 zeta sqrt(1 - zeta^2)), at omega/sqrt(1 - 2 zeta^2):

    >>> rotor = Jeffcott(mass=1.0, stiffness=100.0, damping=2.0, unbalance=1e-3)
    >>> tops = planar_tops([(rotor, [])], np.zeros(1), STATICS)
    >>> print(f"{tops.speed[0]:.6f} {1e3 * tops.amplitude[0]:.6f}")
    10.101525 5.025189
    """
    rotors = np.array([(r.mass, r.stiffness, r.damping, r.unbalance) for r, _ in machines]).reshape(-1, 4)
    mass, stiffness, damping, force = np.ascontiguousarray(rotors.T)
    full, own = np.zeros((2, len(machines)))
    for k, (_, fills) in enumerate(machines):
        wet = [fill for fill in fills if fill.volume > 0.0]
        full[k], own[k] = sum(fill.added_mass for fill in wet), sum(fill.mass for fill in wet)
    moved = force > 0.0
    damped = moved & (damping > 0.0)
    speed, amplitude = np.full((2, len(machines)), np.nan)
    # Without damping the deflection grows without bound where the liquid left behind is a dead mass.
    dead = np.where(_straight(machines, gravity, model), full, own)
    free = moved & ~damped
    speed[free], amplitude[free] = np.sqrt(stiffness / (mass + dead))[free], np.inf
    rows = np.flatnonzero(damped)
    if rows.size:
        curve = _Curve([machines[k] for k in rows.tolist()], gravity[rows], model, full[rows])
        speed[rows], amplitude[rows] = curve.top()
    total = np.divide(stiffness, np.square(speed), out=np.full(speed.shape, np.nan), where=speed > 0.0)
    return Tops(speed, amplitude, 0.5 * damping / total)


def _straight(machines: Sequence[PlanarMachine], gravity: Array, model: LiquidModel) -> Array:
    """Whether every chamber adds its full mass however large the deflection is."""
    rate = np.array([rotor.natural_frequency for rotor, _ in machines])
    pairs = pair_machines(machines, np.arange(len(machines)), rate, gravity, model)
    return np.isinf(pairs.limit)


class _Curve:
    """Resonance curves of damped planar machines, with the cotangent t of the lag along them."""

    def __init__(
        self, machines: Sequence[PlanarMachine], gravity: Array, model: LiquidModel, full: Array
    ) -> None:
        self.machines, self.gravity, self.model = machines, gravity, model
        values = [(r.mass, r.stiffness, r.damping, r.unbalance) for r, _ in machines]
        self.mass, self.stiffness, self.damping, self.force = np.array(values).T
        self.heaviest = self.mass + full * (1.0 + 1e-9)

    def top(self) -> tuple[Array, Array]:
        """Speed and deflection where the deflection is largest; nan where it rises without end."""
        everyone = np.arange(self.mass.size)
        t = np.zeros(everyone.size)
        speed = self.speed(everyone, t)
        for _ in range(_STEPS):
            rows = np.flatnonzero(np.isfinite(speed))
            t[rows] = self._level(rows, t[rows], speed[rows])
            speed[:] = np.nan
            rows = rows[np.isfinite(t[rows])]
            speed[rows] = self.speed(rows, t[rows])
        return speed, self.size(everyone, t, speed)

    def _level(self, rows: Index, t: Array, speed: Array) -> Array:
        """Cotangent at which the deflection stands still over the speed; nan where it does nowhere."""
        mass, stiffness, damping = (x[rows] for x in (self.mass, self.stiffness, self.damping))
        e, total = self.size(rows, t, speed), (stiffness - damping * speed * t) / np.square(speed)
        # Upright, the liquid's share in the mass depends on the speed itself; otherwise on the deflection
        # alone, which stands still at the top.
        upright = np.flatnonzero((self.gravity[rows] > 0.0) & (total > mass * (1.0 + 1e-12)))
        if upright.size:
            near = speed[upright] * (1.0 + np.array([-_NEAR, _NEAR])[:, None])
            owner, size = np.tile(rows[upright], 2), np.tile(e[upright], 2)
            below, above = (self._pull(owner, near.ravel(), size) / np.square(near.ravel())).reshape(2, -1)
            total[upright] += 0.25 * (above - below) / _NEAR
        half = 0.5 * total * speed / damping
        under = np.square(half) - 0.5
        found = np.full(t.shape, np.nan)
        np.divide(-0.5, half + np.sqrt(np.maximum(under, 0.0)), out=found, where=(half > 0.0) & (under > 0.0))
        return found

    def _pull(self, rows: Index, speed: Array, deflection: Array) -> Array:
        """The liquid's pull over the deflection, N/m."""
        pairs = pair_machines(self.machines, rows, speed, self.gravity, self.model)
        beyond = pairs.pull(deflection, np.arange(speed.size)) / deflection
        return np.asarray(beyond + np.square(speed) * pairs.liquid_mass)

    def size(self, rows: Index, t: Array, speed: Array) -> Array:
        """Deflection at a speed and a lag, which the damper alone gives: U Omega/(C sqrt(1 + t^2))."""
        return np.asarray(self.force[rows] * speed / (self.damping[rows] * np.hypot(1.0, t)))

    def speed(self, rows: Index, t: Array) -> Array:
        """Speed at a lag: the balance along the deflection, K - M Omega^2 - C Omega t = Omega^2 U_liq/e."""
        mass, stiffness, damping = (x[rows] for x in (self.mass, self.stiffness, self.damping))

        def left(speed: Array, which: Index) -> Array:
            pull = self._pull(rows[which], speed, self.size(rows[which], t[which], speed))
            held = stiffness[which] - mass[which] * np.square(speed) - damping[which] * speed * t[which]
            return np.asarray(held - pull)

        # Between the speeds at which the rotor has all of the liquid's mass and none of it.
        shift = 0.5 * damping * t
        ends = [np.sqrt(np.square(shift) + stiffness * m) for m in (self.heaviest[rows], mass)]
        low, high = (ends[0] - shift) / self.heaviest[rows], (ends[1] - shift) / mass
        return bracketed_root(left, low * (1.0 - 1e-9), high * (1.0 + 1e-9))[0]


def resonances(system: RotorSystem, fills: Sequence[Fill], share: float = 1.0) -> tuple[Array, Array]:
    """Speeds at which the unbalance meets a free vibration, where the liquid adds a share of its full mass.

    Those are the zeros of the determinant of the dynamic stiffness [theory: rotor, eq. 29], a polynomial of
    the speed: they stand off the real speeds by half the width of the resonance.

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers
    share : of the mass that a chamber adds in a small whirl

    Returns
    -------
    speed, half_width : rising, rad/s, shape (k,)

    Examples
    --------
    >>> rotor = Jeffcott(mass=1.0, stiffness=100.0, damping=2.0, unbalance=1e-3)
    >>> speed, half_width = resonances(rotor.system(), [])
    >>> print(np.round(speed, 3), np.round(half_width, 3))
    [9.95 9.95] [1. 1.]
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
