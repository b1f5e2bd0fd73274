"""Liquid in sectors as an absorber of torsional vibration [Kaken94, Kaken97]: what tunes and what drives it.

A drum that turns to and fro by phi drives a motion with the stream function eta of displacement by its
angular momentum: the liquid keeps its vorticity, K eta'' + 2 Omega C eta' + Omega^2 B eta = -A phi'' with
A eta = int r u_theta for u = curl eta. The torque back on the drum is -A eta''.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import brentq

from meshes.arrays import Array, Complex
from meshes.liquid_section import LiquidSection, liquid_section
from meshes.quality import triangle_areas
from meshes.rings.sectors import sector
from solvers.sloshing.modes import sloshing_modes, spectrum
from solvers.sloshing.system import condense, gradients
from validation.case import Case, Claims

CLAIMS = Claims("published")

SECTORS = (2, 3, 4, 6, 8)
_SEGMENTS, _MODES = 24, 6  # triangles along the wall; half waves of the shortest waves that are asked for
_SHARE = 0.3  # of the chamber, at which waves are shown
_NEAREST, _FULLEST = 0.01, 0.9  # shares between which an amount is looked for


@dataclass(frozen=True)
class SectorWaves:
    """Waves of one sector by the number of half waves along its surface, shape (k,) each."""

    frequency: Array  #: seen from the drum over the spin, below 0 where crests run backward
    running: Array  #: 0 for a standing wave, 1 for one that runs one way
    coupling: Array  #: share in what drives them all, |A eta|^2 of motions of one energy


def sector_liquid(sectors: int, share: float, segments: int = _SEGMENTS) -> LiquidSection:
    """Liquid of one of the sectors of a chamber of unit radius, filled to a share."""
    inner = math.sqrt(1.0 - share)
    mesh = sector(1.0, 0.0, 2.0 * math.pi / sectors, inner, segments)
    return liquid_section(mesh.points, mesh.triangles, inner)


def angular_momentum(section: LiquidSection, psi: Complex) -> Complex:
    """Integral of r u_theta over the liquid for stream functions on its nodes, (k, N) to (k,)."""
    along_x, along_y = gradients(section)
    area = triangle_areas(section.points, section.cells)
    x, y = section.points[section.cells[:, :3]].mean(axis=1).T
    return np.asarray(-((along_x @ psi.T).T @ (x * area) + (along_y @ psi.T).T @ (y * area)))


def sector_waves(sectors: int, share: float, coriolis: bool = True, segments: int = _SEGMENTS) -> SectorWaves:
    """The slowest waves, with the Coriolis force or without."""
    section = sector_liquid(sectors, share, segments)
    system = condense(section)
    system = system if coriolis else replace(system, gyration=0.0 * system.gyration)
    known = spectrum(system)
    modes = sloshing_modes(system, 1.0, _MODES, known)
    driven = np.square(np.abs(angular_momentum(section, system.on_nodes(known.amplitude))))
    return SectorWaves(modes.frequency, modes.travelling, driven[:_MODES] / driven.sum())


def tuned(sectors: int, half_waves: int, order: int) -> float | None:
    """Share filled at which waves of so many half waves answer a torque of an order of the spin."""

    def gap(share: float) -> float:
        return float(spectrum(condense(sector_liquid(sectors, share))).frequency[half_waves - 1]) - order

    if gap(_NEAREST) * gap(_FULLEST) >= 0.0:
        return None
    return float(brentq(gap, _NEAREST, _FULLEST, xtol=1e-3))


def cases() -> Iterator[Case]:
    """Amounts that absorb at one and two times the spin, the sense of the waves, and their parity."""
    for order in (1, 2):
        amounts = {n: _first_odd(n, order) for n in SECTORS}
        words = (f"{n}: {share:.3f} ({j})" for n, (j, share) in amounts.items())
        yield CLAIMS.case(
            "amount", "; ".join(words), not math.isnan(sum(v[1] for v in amounts.values())), order=order
        )
    found = [sector_waves(n, _SHARE) for n in SECTORS]
    still = [sector_waves(n, _SHARE, coriolis=False) for n in SECTORS]
    least, standing = min(one.running[0] for one in found), max(np.abs(one.running).max() for one in still)
    backward = all(bool(np.all(one.frequency < 0.0)) for one in found)
    same = backward and least > 0.3 and standing < 0.01
    yield CLAIMS.case("progressive", agrees=same, least=least, share=_SHARE)
    even = max(float(one.coupling[1::2].max()) for one in still)
    second, third = (np.array([one.coupling[j] for one in found]) for j in (1, 2))
    told = {"share": _SHARE, "even": even, "second": _range(second), "third": _range(third)}
    yield CLAIMS.case("odd", agrees=bool(np.all(second < third)), **told)


def _first_odd(sectors: int, order: int) -> tuple[int, float]:
    """Least odd number of half waves that some amount tunes, and the share it fills; nan without one."""
    for half_waves in range(1, _MODES + 1, 2):
        share = tuned(sectors, half_waves, order)
        if share is not None:
            return half_waves, share
    return 0, math.nan


def _range(values: Array) -> str:
    return f"{100.0 * values.min():.1f} to {100.0 * values.max():.1f} %"
