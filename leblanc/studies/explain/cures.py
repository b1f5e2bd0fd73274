"""What would end a self-excited whirl: fill, viscosity, walls through the surface, damping of the support."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.waves import sector_frequencies
from leblanc.core.units import VOLUME, number, rpm_bands, with_unit
from leblanc.liquid.choose import Prepared
from leblanc.studies.explain.answer import Cure
from leblanc.studies.map.study import fills_over_volume
from meshes.arrays import Array
from solvers.rotor.jeffcott import Jeffcott
from solvers.whirl.edges import Bands, any_growth, unstable_bands

_VOLUMES = 25  # from none to what fits
_THICKER = 10.0 ** (0.25 * np.arange(1, 13))  # times the viscosity
_FIRMER = math.sqrt(2.0)  # times the damping, again and again
_LESS = 2.0 ** -np.arange(1.0, 9.0)  # of the scene's volume
_MOST_DAMPED = 1.0  # damping ratio
_ALIKE = 1e-6  # relative: bands as wide as before
_SECTORS = range(2, 13)
_MM2 = 1e6


def cures(machine: Prepared, bands: Callable[[], Bands]) -> tuple[Cure, ...]:
    """Each alone, computed; none of a rotor that tilts, of a model of one's own, or where no whirl grows.

    `bands` gives those of the machine as it is, between its first and its last speed.

    Walls by the rule that no whirl grows once the liquid's wave is seen from the drum at the spin or faster.
    """
    rotor, law, fills = machine.rotor, machine.waves, machine.scene.fills
    if not isinstance(rotor, Jeffcott) or not isinstance(law, Friction) or not fills:
        return ()
    ends = machine.speed[[0, -1]]
    if ends[0] == ends[1]:
        return ()
    own = bands()
    if not own:
        return ()
    found = [*_by_volume(rotor, fills, law, ends), *_by_viscosity(rotor, fills, law, ends)]
    return (*found, *_by_walls(fills), *_by_damping(rotor, fills, law, ends, own))


def _by_volume(rotor: Jeffcott, fills: tuple[Fill, ...], law: Friction, ends: Array) -> Iterator[Cure]:
    """The next smaller and larger volume, of all chambers in their ratio, with which none grows."""
    own = sum(fill.volume for fill in fills)
    grid = [sum(fill.volume for fill in row) for row in fills_over_volume(fills, _VOLUMES)]
    volumes = sorted({*grid, *(own * _LESS).tolist()})
    rows = fills_over_volume(fills, volumes)
    grows = any_growth(rotor, rows, ends, law)
    free = [volume for volume, some in zip(volumes, grows, strict=True) if not some]
    for kind, side in (
        ("less liquid", [v for v in free if v < own]),
        ("more liquid", [v for v in free if v > own]),
    ):
        less = kind == "less liquid"
        value = math.nan if not side else max(side) if less else min(side)
        text = with_unit(value, VOLUME)
        if not side:
            text = "at none of the fills tried, up to full"
        elif value in (volumes[0], volumes[-1]):
            text = "only none at all" if less else "only a full chamber"
        yield Cure(kind, value, (), text)


def _by_viscosity(rotor: Jeffcott, fills: tuple[Fill, ...], law: Friction, ends: Array) -> Iterator[Cure]:
    """The least viscosity with which none grows, of all liquids in their ratio."""
    if law.law not in (FrictionLaw.STOKES, FrictionLaw.WALL) or not any(f.liquid.viscosity for f in fills):
        return
    rows = [
        tuple(
            replace(fill, liquid=replace(fill.liquid, viscosity=fill.liquid.viscosity * times))
            for fill in fills
        )
        for times in _THICKER.tolist()
    ]
    calm = np.flatnonzero(~any_growth(rotor, rows, ends, law)).tolist()
    if not calm:
        yield Cure("viscosity", math.nan, (), f"not up to {number(_THICKER[-1])} times it")
        return
    value = rows[calm[0]][0].liquid.viscosity
    text = f"{number(value * _MM2)} mm^2/s, {number(_THICKER[calm[0]])} times it"
    yield Cure("viscosity", value, (), text)


def _by_walls(fills: tuple[Fill, ...]) -> Iterator[Cure]:
    """The least number of walls from the drum through the surface that do it in every plain ring."""
    wet = [fill for fill in fills if fill.volume > 0.0]
    if any(fill.uneven or fill.compartments > 1 or fill.chamber.section is not None for fill in wet):
        return
    logs = [math.log(fill.chamber.radius / fill.surface_radius) for fill in wet]
    for count in _SECTORS:
        if all(sector_frequencies(count, log)[0] >= 1.0 for log in logs):
            text = f"{count} from the drum through the surface, which part the liquid"
            yield Cure("walls", float(count), (), text)
            return
    yield Cure("walls", math.nan, (), f"not up to {_SECTORS[-1]} of them")


def _by_damping(
    rotor: Jeffcott, fills: tuple[Fill, ...], law: Friction, ends: Array, own: Bands
) -> Iterator[Cure]:
    """What twice the damping of the support makes of the bands, and with how much none is left."""
    if not 0.0 < rotor.damping_ratio < _MOST_DAMPED:
        return

    def damped(times: float) -> Jeffcott:
        return replace(rotor, damping=rotor.damping * times)

    def width(bands: Bands) -> float:
        return sum(high - low for low, high in bands)

    (twice,) = unstable_bands(damped(2.0), [fills], ends, law)
    change = width(twice) - width(own)
    how = (
        "as wide as before" if abs(change) < _ALIKE * width(own) else "wider" if change > 0.0 else "narrower"
    )
    if twice and {twice[0][0], twice[-1][1]} & set(ends.tolist()):
        how += ", as far as the machine's speeds go"
    text = f"{rpm_bands(twice)}, {how}" if twice else "no whirl grows"
    yield Cure("twice the damping", 2.0 * rotor.damping_ratio, twice, text)
    if not twice:
        return
    ratio, tried = 2.0 * rotor.damping_ratio, False
    while ratio < _MOST_DAMPED or not tried:
        ratio, tried = min(ratio * _FIRMER, _MOST_DAMPED), True
        if not any_growth(damped(ratio / rotor.damping_ratio), [fills], ends, law)[0]:
            yield Cure("damping", ratio, (), f"a damping ratio of {number(ratio)} ends it")
            return
    yield Cure("damping", math.nan, (), f"no damping ratio up to {number(_MOST_DAMPED)} ends it")
