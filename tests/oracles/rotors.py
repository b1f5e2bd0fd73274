"""Rotors and independent references that several tests of the dry rotors share."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from solvers.rotor.shaft.natural import _eigenvalues
from solvers.rotor.shaft.structure import Structure, nodes_up_to
from solvers.rotor.system import RotorSystem
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane

Array = np.ndarray


def two_plane(damping: float = 20.0, polar: float = 0.16) -> TwoPlane:
    """A lopsided rotor with unbalance in two planes."""
    return TwoPlane(
        mass=20.0,
        transverse_inertia=0.72,
        polar_inertia=polar,
        supports=(Support(-0.35, 4e4, damping), Support(0.31, 5e4, 2.0 * damping)),
        unbalances=(PlaneUnbalance(-0.2, 1.5e-3, 0.4), PlaneUnbalance(0.25, 1.2e-3, 2.5)),
    )


def tub(damping: float = 1.0) -> Tub:
    """A tub without any symmetry: every place, direction and coefficient is another one."""
    return Tub(
        tub_mass=48.2,
        drum_mass=12.5,
        tub_inertia=(1.3, 1.5, 1.2),
        drum_polar_inertia=0.32,
        drum_transverse_inertia=0.2,
        springs=(
            Mount((0.2, 0.03, 0.19), 4800.0, (0.26, 0.1, 0.97)),
            Mount((-0.21, -0.05, 0.2), 5200.0, (-0.3, 0.05, 0.9), (900.0, 1100.0, 1300.0)),
            Mount((0.05, 0.11, -0.2), along_axes=(1500.0, 700.0, 2100.0)),
        ),
        dampers=(
            Mount((0.12, 0.02, -0.22), 155.0 * damping, (0.34, -0.06, -0.94)),
            Mount((-0.13, 0.04, -0.2), along_axes=(20.0 * damping, 30.0 * damping, 90.0 * damping)),
        ),
        unbalance=0.185,
        drum_position=(0.02, 0.09, -0.03),
        unbalance_position=0.06,
    )


def tub_energies(sp: Any) -> tuple[list[tuple[Any, Any]], list[Any], Any, Any, list[Any], list[Any], Any]:
    """Energies of tub and drum and the velocity of a mass point on the drum, for a finite rotation.

    Returns
    -------
    Weights and quantities whose sum of weight s^2/2 is the kinetic energy; velocity of the point; its angle
    phi; the rotation as a matrix; coordinates; their rates; the symbols by name
    """
    q = list(sp.symbols("X Y Z alpha beta gamma"))
    v = list(sp.symbols("Xd Yd Zd alphad betad gammad"))
    phi, omega = sp.symbols("phi omega")
    names = sp.symbols("m1 m2 Jx Jy Jz Ja Jb e xD yD zD yu")
    m1, m2, jx, jy, jz, ja, jb, e, x_d, y_d, z_d, y_u = names
    turn = sp.rot_ccw_axis1(q[3]) * sp.rot_ccw_axis2(q[4]) * sp.rot_ccw_axis3(q[5])

    def rate(thing: Any) -> Any:
        found = thing.diff(phi) * omega
        for one, speed in zip(q, v, strict=True):
            found += thing.diff(one) * speed
        return found

    spin = turn.T * rate(turn)
    w = (spin[2, 1], spin[0, 2], spin[1, 0])
    shift = sp.Matrix(q[:3])
    centre = rate(shift + turn * sp.Matrix([x_d, y_d, z_d]))
    heavy = rate(shift + turn * sp.Matrix([x_d + e * sp.sin(phi), y_u, z_d + e * sp.cos(phi)]))
    energy = [*((m1, one) for one in v[:3]), *((m2, one) for one in centre)]
    energy += [(jx, w[0]), (jy, w[1]), (jz, w[2]), (ja, w[0]), (ja, w[2]), (jb, w[1] + omega)]
    return energy, list(heavy), phi, turn, q, v, dict(zip([str(n) for n in names], names, strict=True))


def free_energy_drift(system: RotorSystem, spin: float, duration: float) -> float:
    """Relative change of the energy of the undamped gyroscopic rotor let go, by time integration."""
    n = len(system.coordinates)

    def rate(_: float, y: Array) -> Array:
        q, v = y[:n], y[n:]
        force = -system.stiffness @ q - spin * system.gyroscopic @ v
        return np.concatenate((v, np.linalg.solve(system.mass, force)))

    start = np.concatenate((1e-3 * np.cos(np.arange(n)), 1e-2 * np.sin(1.0 + np.arange(n))))
    end = solve_ivp(rate, (0.0, duration), start, method="DOP853", rtol=1e-10, atol=1e-14).y[:, -1]

    def energy(y: Array) -> float:
        return float(0.5 * y[n:] @ system.mass @ y[n:] + 0.5 * y[:n] @ system.stiffness @ y[:n])

    return abs(energy(end) / energy(start) - 1.0)


def count_below(structure: Structure, frequency: Array) -> Array:
    """Number of natural frequencies of a structure below given ones, rad/s [theory: spindle, eq. 11]."""
    nodes = nodes_up_to(structure, float(frequency.max()))
    return np.sum(_eigenvalues(structure, nodes, frequency, 0.0) < 0.0, axis=-1)
