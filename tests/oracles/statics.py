"""High-precision references, written from the definitions and not from the package's formulas."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from itertools import pairwise

from mpmath import mp, mpf


@dataclass(frozen=True)
class LiquidReference:
    """Volume, first and second moments of the liquid in a cylinder, over the density, as mpmath numbers."""

    volume: mpf
    x: mpf
    z: mpf
    xx: mpf
    yy: mpf
    zz: mpf
    xz: mpf


def liquid_reference(
    radius: float, height: float, eccentricity: float, beta: mpf, constant: mpf
) -> LiquidReference:
    """Integrate the liquid under z = beta r^2 + C in polar coordinates about the rotation axis.

    The chamber's centre lies at (e, 0). The circle of radius r is inside the chamber for |angle| < phi(r),
    with cos(phi) = (r^2 + e^2 - R^2)/(2 e r). `beta` and `constant` are mpmath numbers: C loses nothing.
    """
    R, h, e = mpf(radius), mpf(height), mpf(eccentricity)

    # All integrals ask at the same places.
    @cache
    def arc(r: mpf) -> tuple[mpf, mpf, mpf]:
        phi = +mp.pi
        if r > R - e:
            phi = mp.acos(max(mpf(-1), min(mpf(1), (r * r + e * e - R * R) / (2 * e * r))))
        return phi, mp.sin(phi), mp.sin(2 * phi)

    def phi(r: mpf) -> mpf:
        return arc(r)[0]

    def sine(r: mpf) -> mpf:
        return arc(r)[1]

    def double(r: mpf) -> mpf:
        return arc(r)[2]

    @cache
    def depth(r: mpf) -> mpf:
        return max(mpf(0), min(h, beta * r * r + constant))

    marks = {max(mpf(0), e - R), abs(R - e), R + e}
    if beta > 0:
        marks |= {mp.sqrt(s) for s in (-constant / beta, (h - constant) / beta) if s > 0}
    near, far = max(mpf(0), e - R), R + e
    # Where the wall nearly touches the rotation axis phi turns over on the scale |R - e|: one mark a decade.
    decade = abs(R - e)
    while 0 < decade < R:
        decade *= 10
        marks.add(decade)
    marks = sorted(m for m in marks if near <= m <= far)
    # A slender crescent or ramp is integrated in its own right: the marks bound every kink.
    points = [m for k, m in enumerate(marks) if k == 0 or m > marks[k - 1]]

    def integral(f) -> mpf:  # type: ignore[no-untyped-def]
        total = mpf(0)
        for start, stop in pairwise(points):
            if depth((start + stop) / 2) > 0:
                total += mp.quad(f, [start, stop])
        return total

    return LiquidReference(
        volume=integral(lambda r: 2 * phi(r) * r * depth(r)),
        x=integral(lambda r: 2 * sine(r) * r * r * depth(r)),
        z=integral(lambda r: phi(r) * r * depth(r) ** 2),
        xx=integral(lambda r: (phi(r) + double(r) / 2) * r**3 * depth(r)),
        yy=integral(lambda r: (phi(r) - double(r) / 2) * r**3 * depth(r)),
        zz=integral(lambda r: 2 * phi(r) * r * depth(r) ** 3 / 3),
        xz=integral(lambda r: sine(r) * r * r * depth(r) ** 2),
    )
