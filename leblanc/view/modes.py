"""Pictures of the liquid's own oscillations: a mode of sloshing in a chamber of the machine."""

from __future__ import annotations

import math

import numpy as np

from leblanc.results.base import one_line
from leblanc.results.drawn.scale import Scale
from leblanc.results.drawn.shapes import LiquidBodies, LiquidShape, ModeView
from leblanc.units import RPM
from leblanc.view.film import Film
from leblanc.view.parts import Instant, Picture, Stage
from leblanc.view.scene import compose
from meshes.arrays import Array, Complex
from meshes.bodies.body import columns

ROUND = 48  # frames of a period


def _moment(displacement: Complex, phase: float, lift: float) -> Array:
    """Displacement at a phase, m."""
    return np.asarray(lift * (displacement * np.exp(-1j * phase)).real)


def _body_of(mode: ModeView, phase: float, lift: float) -> LiquidBodies:
    """Liquid of a mode between walls of any shape."""
    section, displacement = mode.section, mode.section_displacement
    assert section is not None and displacement is not None
    moved = _moment(displacement, phase, lift)
    away = np.hypot(*section.points.T)
    # As on the surface of a ring: the area per angle swings.
    points = section.points * np.sqrt(1.0 + 2.0 * moved / away)[:, None]
    surface = np.zeros(len(points), dtype=bool)
    surface[section.surface] = True
    height = mode.fill.chamber.height
    full, none = np.full(len(points), height), np.zeros(len(points), dtype=bool)
    body = columns(points, section.cells, full, height, none, surface, layers=1, order=2)
    return LiquidBodies(0j, (body,))


def shape_of(mode: ModeView, phase: float, lift: float) -> LiquidShape | LiquidBodies:
    """Liquid of a mode at a phase of its oscillation; the area per angle swings, so that the volume stays.

    Parameters
    ----------
    mode : the oscillation
    phase : sigma t, rad
    lift : largest displacement, m
    """
    if mode.section is not None:
        return _body_of(mode, phase, lift)
    chamber, size = mode.fill.chamber, mode.fill.surface_radius
    moved = _moment(mode.displacement, phase, lift)
    free = np.sqrt(np.maximum(size**2 + 2.0 * size * moved, chamber.inner_radius**2))
    free = np.minimum(free, chamber.radius)[:, None]
    count = mode.angle.size
    outer, inner = np.full(count, chamber.radius), np.full(count, chamber.inner_radius)
    height = np.repeat(np.array([[0.0, chamber.height]]), count, axis=0)
    return LiquidShape(0j, mode.angle, inner, outer, np.repeat(free, 2, axis=1), height)


def mode_picture(mode: ModeView, phase: float = 0.0) -> Picture:
    """Picture of a mode at a phase of its oscillation.

    Parameters
    ----------
    mode : the oscillation
    phase : sigma t, rad
    """
    stage = Stage((mode.fill,), (0.0,), mode.lying, Scale(), 0.0, zero="", gravity=not mode.lying)
    sense = "with the spin" if mode.frequency > 0.0 else "against the spin"
    crests = f"{mode.crests} crest{'s' if mode.crests > 1 else ''}"
    if mode.fill.chamber.section is not None:
        crests = f"between walls of its own shape; of its harmonics the strongest has {crests}"
    if mode.fill.chamber.baffles is not None:
        crests = f"between baffles; of its harmonics the strongest has {crests}"
    caption = [
        "The wave is drawn much higher than it is; its true height is any small one.",
        "Seen from the drum.",
    ]
    if mode.gravity > 0.0:
        caption.append("Gravity across the axis is left out.")
    instant = Instant(
        deflection=(0j,),
        lean=0j,
        bodies=(shape_of(mode, phase, mode.lift),),
        title=f"{one_line(mode.name)}: sloshing mode {mode.number} at {mode.speed * RPM:.4g} rpm",
        state=f"{crests} around, {sense}\n{abs(mode.frequency):.4g} rad/s seen from the drum",
        caption=" ".join(caption),
    )
    return compose(stage, instant)


def mode_film(mode: ModeView, frames: int = ROUND) -> Film:
    """One period of a mode.

    Parameters
    ----------
    mode : the oscillation
    frames : of the period
    """
    sense = 1.0 if mode.frequency > 0.0 else -1.0
    # The phase sigma t runs backwards for a wave against the spin.
    return Film(frames, lambda k: mode_picture(mode, sense * 2.0 * math.pi * k / frames))
