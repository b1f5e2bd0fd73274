"""Overhung rotor with a partly filled cavity, whose band of self-excited whirl need not end [Kaken96].

The forward whirl in which the rotor tilts tends to Omega I_p/I_t, the backward wave stands in space at
Omega (1 - c): where both are the same the two go together up to any speed.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION
from fluid.liquid import known_liquid
from fluid.whirl import plane_layer, slower_slip
from meshes.chamber import Chamber
from solvers.rotor.two_plane import Support, TwoPlane
from solvers.rotor.vibration import critical_speeds
from solvers.whirl.edges import Bands, unstable_bands
from solvers.whirl.growth import asynchronous_growth
from validation.case import Case, Claims

CLAIMS = Claims("published")

# kg, kg m^2, m and N/m: a rotor to compute with, the source gives none.
_MASS, _INERTIA, SUPPORTS = 10.0, 0.1, ((-0.25, 2e4), (-0.1, 4e4))
_RADIUS, _HEIGHT, _PLANE = 0.1, 0.05, 0.05  # m, of its chamber, and of that along the axis
SHARES = (0.25, 0.5, 0.75)
RATIOS = (0.2, 0.5, 0.6, 0.75, 0.9, 2.0)  # polar over transverse inertia; 2: a disc
_FAST = 2e4  # rad/s, 140 times the fastest natural frequency
_LIGHT = 10.0  # how much heavier the rotor is for the limit of a light liquid
_HALVINGS = 14


def rotor(ratio: float, heavy: float = 1.0) -> TwoPlane:
    """Rotor overhung on two supports, with a polar over its transverse inertia; all of it heavy times."""
    inertia = heavy * _INERTIA
    supports = tuple(Support(at, heavy * stiffness, 0.0) for at, stiffness in SUPPORTS)
    return TwoPlane(heavy * _MASS, inertia, ratio * inertia, supports)


def filled(share: float) -> Fill:
    """Water in a share of the chamber."""
    chamber = Chamber(_RADIUS, _HEIGHT, plane=_PLANE)
    return Fill(chamber, known_liquid("water"), share * chamber.capacity)


def wave_in_space(share: float) -> float:
    """Speed of the backward wave in space over the spin, 1 - c."""
    layer = plane_layer(filled(share), NO_FRICTION)
    assert layer is not None
    return 1.0 - slower_slip(layer.layer_tanh)


def rule(ratio: float, share: float) -> float:
    """Speed at which the tilting whirl of the empty rotor and the wave meet, rad/s.

    Omega = omega_t + c Omega: a critical speed of a rotor with (1 - c)^2 of the mass and 1 - c of the
    gyroscopic moment.
    """
    space, system = wave_in_space(share), rotor(ratio).system()
    turned = replace(system, mass=space**2 * system.mass, gyroscopic=space * system.gyroscopic)
    return float(critical_speeds(turned)[0].max())


def bands(ratio: float, share: float) -> Bands:
    """Bands of self-excited whirl, rad/s: the first of the translation, one of the tilt, if there is one."""
    (found,) = unstable_bands(rotor(ratio), [[filled(share)]], np.array([10.0, _FAST]))
    return found


def endless(share: float, heavy: float = _LIGHT) -> tuple[float, float]:
    """Polar over transverse inertia between which the whirl of a very fast rotor grows."""

    def grows(ratio: float) -> bool:
        return bool(asynchronous_growth(rotor(ratio, heavy), [filled(share)], [_FAST])[0] > 0.0)

    inside = wave_in_space(share)
    edges = []
    for outside in (0.5, 1.1):
        within, beyond = inside, outside
        for _ in range(_HALVINGS):
            middle = 0.5 * (within + beyond)
            within, beyond = (middle, beyond) if grows(middle) else (within, middle)
        edges.append(within)
    return edges[0], edges[1]


def cases() -> Iterator[Case]:
    """Where the band of the tilt lies, where it ends, and the ratio of inertias at which it does not."""
    for share in SHARES:
        low, high = bands(RATIOS[0], share)[1]
        told = {"share": share, "ratio": RATIOS[0], "low": low, "high": high}
        yield CLAIMS.case("tilt", 0.5 * (low + high), printed=rule(RATIOS[0], share), **told)
    said, ends = [], []
    for ratio in RATIOS:
        tilting = bands(ratio, SHARES[0])[1:]
        ends.append(tilting[0][1] if tilting else 0.0)
        said.append(f"{ratio:g}: {_end(ends[-1])}")
    same = ends[0] < ends[1] < ends[2] < _FAST == ends[3] and ends[4] == ends[5] == 0.0
    told = {"share": SHARES[0], "space": wave_in_space(SHARES[0])}
    yield CLAIMS.case("upper-edge", "; ".join(said), same, **told)
    for share in SHARES:
        low, high = endless(share)
        wide = endless(share, 1.0)
        told = {"share": share, "low": low, "high": high, "wide_low": wide[0], "wide_high": wide[1]}
        yield CLAIMS.case("endless", 0.5 * (low + high), printed=wave_in_space(share), **told)


def _end(speed: float) -> str:
    if speed == 0.0:
        return "no band"
    return "no end" if speed == _FAST else f"{speed:.0f} rad/s"
