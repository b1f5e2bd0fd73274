"""Radial walls against self-excited whirl [JAMI88, KS94]: where a band lies, and when there is none."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.liquid import known_liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.rings.quadrilaterals import ring
from solvers.rotor.jeffcott import Jeffcott
from solvers.sloshing.modes import spectrum
from solvers.sloshing.system import condense
from solvers.whirl.edges import Bands, unstable_bands
from solvers.whirl.growth import asynchronous_growth
from validation.case import Case, Claims

CLAIMS = Claims("published")

MASS, NATURAL = 10.0, 50.0  # kg, rad/s: a rotor to compute with, the sources give none
RADIUS, HEIGHT = 0.1, 0.05  # m, of its chamber
SECTORS, SHARES = (0, 3, 4, 5), (0.25, 0.5, 0.75)
_CELLS = (24, 48)  # around, of elements for the natural waves
_FASTEST = 20.0  # speed over the natural frequency up to which bands are looked for
_LAW = Friction(FrictionLaw.LINEAR, 1.0)  # where there is friction
# Sectors and share that have a band of the second wave, and damping ratio that removes it.
_SECOND, _LITTLE = (2, 0.25), 0.03
_DAMPED = 0.1  # damping ratio by which the numbers of sectors are compared


def rotor(damping_ratio: float = 0.0, mass: float = MASS) -> Jeffcott:
    """The rotor on its springs."""
    return Jeffcott(mass, mass * NATURAL**2, 2.0 * damping_ratio * mass * NATURAL, 0.0)


def chamber_with(sectors: int, share: float) -> Fill:
    """Water in a share of the chamber, which walls from the axis cut into sectors, 0 for none."""
    chamber = Chamber(RADIUS, HEIGHT, baffles=Baffles(sectors) if sectors else None)
    return Fill(chamber, known_liquid("water"), share * chamber.capacity)


def wave_ratio(sectors: int, share: float, cells: int = _CELLS[-1]) -> float:
    """Frequency of the slowest wave seen from the drum over the spin, by elements; of fewer crests in none.

    The slowest of a clear ring has one crest and runs backward.
    """
    baffles = Baffles(sectors) if sectors else None
    liquid = condense(ring(1.0, math.sqrt(1.0 - share), cells, 4, baffles=baffles))
    return float(spectrum(liquid).frequency[0])


def rule(sectors: int, share: float, mass: float = MASS) -> float:
    """Speed of the band over the natural frequency by the source's sum, inf where there is none.

    Omega = omega_c + c Omega, omega_c the critical speed of the rotor with its liquid.
    """
    ratio = wave_ratio(sectors, share)
    critical = math.sqrt(mass / (mass + chamber_with(sectors, share).added_mass))
    return critical / (1.0 - ratio) if ratio < 1.0 else math.inf


def bands(
    sectors: int,
    share: float,
    damping_ratio: float = 0.0,
    friction: Friction = NO_FRICTION,
    mass: float = MASS,
) -> Bands:
    """Bands of self-excited whirl over the natural frequency."""
    fill, machine = chamber_with(sectors, share), rotor(damping_ratio, mass)
    (found,) = unstable_bands(machine, [[fill]], np.array([0.5, _FASTEST]) * NATURAL, friction)
    return tuple((low / NATURAL, high / NATURAL) for low, high in found)


def widest(found: Bands) -> tuple[float, float]:
    """Edges of the widest band."""
    return max(found, key=lambda band: band[1] - band[0])


def whirl_over_critical(sectors: int, share: float, band: tuple[float, float], mass: float = MASS) -> float:
    """Whirl speed where the growth is largest in a band, over the critical speed with liquid."""
    fill, speeds = chamber_with(sectors, share), np.linspace(*band, 21) * NATURAL
    growth, whirl_speed = asynchronous_growth(rotor(0.0, mass), [fill], speeds)
    critical = NATURAL * math.sqrt(mass / (mass + fill.added_mass))
    return float(whirl_speed[np.argmax(growth)] / critical)


def cases() -> Iterator[Case]:
    """Places of the bands, those without one, whirl frequency, the second wave, damping, a full chamber."""
    ratios, none = [], []
    for sectors in SECTORS:
        for share in SHARES:
            found, at, c = bands(sectors, share), rule(sectors, share), wave_ratio(sectors, share)
            if math.isinf(at):
                none.append((sectors, share, c, len(found)))
                continue
            low, high = band = widest(found)
            ratios.append(whirl_over_critical(sectors, share, band))
            told = {"sectors": sectors, "share": share, "low": low, "high": high, "c": c}
            yield CLAIMS.case("band", 0.5 * (low + high), printed=at, **told)
    where = "; ".join(f"{sectors} sectors filled to {share:g}, c = {c:.3f}" for sectors, share, c, _ in none)
    yield CLAIMS.case("no-band", agrees=not any(n for *_, n in none), where=where, fastest=_FASTEST)
    least, most = min(ratios), max(ratios)
    yield CLAIMS.case("whirl-frequency", agrees=least > 0.9 and most < 1.1, least=least, most=most)
    yield _second_wave()
    yield _many_sectors()
    full = asynchronous_growth(rotor(), [chamber_with(0, 1.0)], np.linspace(0.5, _FASTEST, 40) * NATURAL)[0]
    yield CLAIMS.case("full", agrees=float(full.max()) == 0.0)


def _second_wave() -> Case:
    """Two sectors have a band of their second wave, a narrow one, which damping takes away first."""
    free, damped = bands(*_SECOND), bands(*_SECOND, _LITTLE, _LAW)
    first, second = (band for band in free if band[0] > 1.0)
    alone = len(damped) == 1 and damped[0][0] < first[1]
    narrow = (second[1] - second[0]) / (first[1] - first[0])
    told = {"first": _words(first), "second": _words(second), "left": _words(damped[0]), "ratio": _LITTLE}
    return CLAIMS.case("second-wave", agrees=alone and narrow < 0.5, rate=_LAW.coefficient, **told)


def _many_sectors() -> Case:
    """Damping that leaves a band with few sectors and none with many."""
    left = {n: bands(n, SHARES[0], _DAMPED, _LAW) for n in SECTORS}
    said = {n: _words(widest(found)) if found else "stable" for n, found in left.items()}
    computed = "; ".join(f"{n or 'no walls'}: {words}" for n, words in said.items())
    same = bool(left[0]) and not left[SECTORS[-1]]
    told = {"share": SHARES[0], "ratio": _DAMPED, "rate": _LAW.coefficient}
    return CLAIMS.case("many-sectors", computed, same, **told)


def _words(band: tuple[float, float]) -> str:
    return f"{band[0]:.2f} to {band[1]:.2f}"
