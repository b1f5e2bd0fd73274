"""What unidirectional waves do to a synchronous whirl: its pull as a law of the deflection alone.

In a synchronous whirl the wave stands still in the drum. Nothing rubs on the wall then, and every term of the
equation goes with the spin: over the depth and the wall's radius the wave depends on the deflection and on
how full the chamber is, at every speed alike [theory: kdv, eq. 31]. It is solved once by py-pde, at rising
deflections, until the wall would run dry or no wave stands.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.interpolate import CubicSpline

from fluid import kdv
from fluid.fill import FULL, Fills
from meshes.arrays import Array, Flags
from solvers.pypde.settle_family import steady_wave
from solvers.waves.modes import WaveTerms

STEPS = 40  # of the deflection up to the mean depth
_POINTS = 64


@dataclass(frozen=True)
class FamilyLaw:
    """Standing waves of one family in a layer, over the deflection in mean depths."""

    reach: float  #: deflection up to which there is a wave that leaves the wall wet, at most 1
    share: CubicSpline  #: of the exact offset of the liquid's centre of mass, by deflection
    #: largest change of the liquid area over its mean, and largest rise, by deflection, shape (k, 2)
    height: Array
    deflection: Array  #: of the waves found, from 0 to `reach`, shape (k,)
    other: float  #: answer of the family left out over that of this one, by linear theory of long waves

    def shares(self, deflection: Array) -> tuple[Array, Array]:
        """Share of the exact offset, and slope of the offset over that of the exact one.

        Beyond reach both are the last share.
        """
        within = np.minimum(deflection, self.reach)
        share = self.share(within)
        bend = np.where(deflection <= self.reach, within * self.share(within, 1), 0.0)
        return share, share + bend

    def heights(self, deflection: Array) -> tuple[Array, Array]:
        """Largest change of the liquid area over its mean and largest rise; those of the last wave beyond."""
        change, rise = (np.interp(deflection, self.deflection, column) for column in self.height.T)
        return change, rise

    def answered(self, deflection: Array) -> Flags:
        """Whether there is a wave."""
        return np.asarray(deflection <= self.reach)

    @property
    def steepest(self) -> float:
        """Upper bound of the slopes that `shares` has."""
        fine = np.linspace(0.0, self.reach, 20 * STEPS)
        # Between two of these points the slope of a spline is off by less than a part of its steps.
        return 1.02 * float(max(self.shares(fine)[1].max(), 1.0))


@lru_cache(maxsize=4096)
def family_law(surface: float, dispersion: bool) -> FamilyLaw:
    """Law of a layer by the radius of its mean surface over the wall's.

    Of the retrograde family, whose resonance is nearer.
    """
    c = kdv.coefficients(1.0, surface, 1.0, -1)
    depth, whole = 1.0 - surface, surface**2 / (2.0 * c.mean_area)
    own = c.linear_speed / float(kdv.wave_frequency(1, c, dispersion))
    # A small wave, of the coefficients alone [theory: kdv, eq. 22].
    share = [own * c.other_speed / (c.other_speed - c.linear_speed)]
    heights, reached = [(0.0, 0.0)], [0.0]
    for k in range(1, STEPS + 1):
        size = k / STEPS * depth
        forcing = float(kdv.forcing(c, size))
        wave = steady_wave(WaveTerms(c, dispersion, 0.0, 0.0, forcing, 0.0), _POINTS)
        eta = wave.profile(max(_POINTS, 2 * wave.modes.size + 2))
        offset = float(kdv.offset(c, eta).real)
        dry = float(eta.min()) <= -c.mean_area
        # The exact offset never falls as the deflection grows; what falls is a resonance of short waves.
        if not wave.converged or dry or offset < share[-1] * whole * reached[-1] * depth:
            break
        share.append(offset / (whole * size))
        heights.append((float(np.abs(eta).max() / c.mean_area), float(eta.max() / c.mean_area)))
        reached.append(k / STEPS)
    at = np.array(reached if len(reached) > 1 else [0.0, 1.0 / STEPS])
    ends = ((1, 0.0), "not-a-knot" if at.size > 2 else (1, 0.0))
    spline = CubicSpline(at, share if len(share) > 1 else share * 2, bc_type=ends)
    other = abs(c.linear_speed / c.other_speed)
    return FamilyLaw(reached[-1], spline, np.array(heights), np.array(reached), other)


@dataclass(frozen=True)
class Standing:
    """Waves that stand in n chambers in synchronous whirl; shapes (n,)."""

    waves: Flags  #: there is a free surface; elsewhere the liquid goes with the drum
    found: Flags  #: there is a wave, or no surface
    share: Array  #: as from `FamilyLaw.shares`
    slope: Array
    change: Array  #: largest change of the liquid area over its mean
    deepest: Array  #: greatest depth, m
    other: Array  #: answer of the family left out over that of this one
    steepest: Array  #: as of `FamilyLaw`


def standing(fills: Fills, deflection: Array, dispersion: bool) -> Standing:
    """Waves of some layers, each law solved once; deflections of the chambers' axes, m, shape (n,)."""
    radius, depth = fills.chamber.radius, fills.depth
    surface = 1.0 - depth / radius
    waves = (fills.volume > 0.0) & (fills.volume < FULL * fills.chamber.capacity) & (surface > 0.0)
    found, (share, slope, change, rise, other, steepest) = ~waves, np.zeros((6, depth.size))
    for kind in np.unique(surface[waves]).tolist():
        rows = np.flatnonzero(waves & (surface == kind))
        law, deep = family_law(kind, dispersion), deflection[rows] / depth[rows]
        found[rows] = law.answered(deep)
        share[rows], slope[rows] = law.shares(deep)
        change[rows], rise[rows] = law.heights(deep)
        other[rows], steepest[rows] = law.other, law.steepest
    risen = np.square(surface) - rise * (1.0 - np.square(surface))
    deepest = radius * (1.0 - np.sqrt(np.maximum(risen, 0.0)))
    return Standing(waves, found, share, slope, change, deepest, other, steepest)
