"""Critical speeds with liquid at small deflections, dampers left out."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fluid.fill import Fill, Fills
from meshes.arrays import Array, Complex, Index
from solvers.roots import bracketed_root
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor, RotorSystem
from solvers.rotor.vibration import critical_speeds
from solvers.synchronous.backward import backward_mass
from solvers.synchronous.balance import directions
from solvers.synchronous.models import STATICS, LiquidModel
from solvers.synchronous.pairs import pair_machines


def critical_speed(
    rotor: Jeffcott, fills: Sequence[Fill], gravity: float = 9.81, model: LiquidModel = STATICS
) -> float:
    """Speed at which a small deflection meets no stiffness: (M + dU/de) Omega^2 = K [theory: rotor, eq. 4].

    Parameters
    ----------
    rotor, fills, gravity, model : see `solvers.synchronous.response.response`

    Returns
    -------
    Omega, rad/s, between sqrt(K/(M + m_f)) and sqrt(K/M)
    """
    wet, along = [fill for fill in fills if fill.volume > 0.0], np.array([gravity])

    def stiffness(speed: Array, _: Index) -> Array:
        pairs = pair_machines([(rotor, wet)], np.zeros(speed.size, dtype=np.intp), speed, along, model)
        slope = pairs.liquid(np.zeros_like(speed), np.arange(speed.size)).slope
        return np.asarray(rotor.stiffness - (rotor.mass + slope) * np.square(speed))

    # The slope of the unbalance never exceeds a full chamber's mass; a little more holds the rounding.
    heaviest = rotor.mass + sum(fill.added_mass for fill in wet)
    ends = np.sqrt(rotor.stiffness / np.array([heaviest, rotor.mass])) * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    root, _ = bracketed_root(stiffness, ends[:1], ends[1:])
    return float(root[0])


def wet_critical_speeds(
    rotor: Rotor, fills: Sequence[Fill], gravity: float = 9.81, model: LiquidModel = STATICS
) -> tuple[Array, Complex]:
    """All critical speeds of a rotor of any kind, and its shapes there [theory: rotor, eq. 31].

    Parameters
    ----------
    rotor, fills, gravity, model : see `solvers.synchronous.response.response`

    Returns
    -------
    speed : rising, rad/s, shape (k,)
    shape : complex, shape (k, n)
    """
    system = rotor.system()
    wet = [fill for fill in fills if fill.volume > 0.0]
    speed, shape = critical_speeds(system, _added_mass(system, wet, None, gravity, model))
    if gravity == 0.0 or not wet:
        return speed, shape
    # Upright, the liquid's share in the mass depends a little on the speed itself.
    for k in range(speed.size):
        for _ in range(30):
            again, shapes = critical_speeds(system, _added_mass(system, wet, float(speed[k]), gravity, model))
            if k >= again.size or abs(again[k] - speed[k]) <= 1e-12 * speed[k]:
                break
            speed[k], shape[k] = again[k], shapes[k]
    return speed, shape


def _added_mass(
    system: RotorSystem, wet: list[Fill], speed: float | None, gravity: float, model: LiquidModel
) -> Complex:
    """Mass matrix of the liquid in synchronous motion, at a speed or far above every other one."""
    n = len(system.coordinates)
    total = np.zeros((n, n), dtype=complex)
    for fill, p in zip(wet, directions(system, wet), strict=True):
        full = fill.added_mass
        if speed is not None:
            law = model.synchronous(Fills.of([fill]), np.array([speed]), np.zeros(1), np.array([gravity]))
            full = float(law.slope[0])
        total += 0.5 * full * np.outer(p, np.conj(p)) + 0.5 * backward_mass(fill) * np.outer(np.conj(p), p)
    return total
