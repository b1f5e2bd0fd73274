"""Stills: a machine in steady rotation at one speed, its liquid at rest in the drum."""

from __future__ import annotations

import cmath
import math

import numpy as np

from fluid.fill import Fill
from leblanc.figures.caption import zero_of
from leblanc.results.provenance import one_line
from leblanc.studies.shapes import Sight
from leblanc.units import MM, RPM
from leblanc.view.bodies import LiquidBodies, bodies_at_rest, is_cut, wall_is_dry
from leblanc.view.parts import Instant, Picture, Stage
from leblanc.view.scale import Scale, drawn_volume
from leblanc.view.scene import compose
from leblanc.view.surfaces import LiquidShape, body_at_rest
from solvers.statics.hydrostatics import optimal_volume

MINUS, DEGREE = "\N{MINUS SIGN}", "\N{DEGREE SIGN}"


def stage_of(sight: Sight, scale: Scale) -> Stage:
    """What stands still in pictures of a machine.

    Parameters
    ----------
    sight : its answers
    scale : common to all pictures
    """
    size = np.nan_to_num(np.abs(sight.deflection))
    motion = sight.record.motion
    return Stage(
        fills=sight.fills,
        places=sight.places,
        lying=sight.record.axis == "horizontal",
        scale=scale,
        swing=scale.deflection * float(size.max(initial=0.0)),
        zero="unbalance" if motion is None or motion.zero == "unbalance" else "angle 0",
    )


def still(sight: Sight, index: int, scale: Scale, stage: Stage | None = None) -> Picture:
    """Picture of a machine at one of its speeds.

    The liquid is in equilibrium with the deflection as it is drawn, at that speed.

    Parameters
    ----------
    sight : its answers
    index : of the speed
    scale : of deflection and depth
    stage : of several pictures, for this one alone if None
    """
    found = sight.deflection[index]
    known = np.isfinite(found)
    deflection = np.where(known, found, 0.0)
    bodies = tuple(liquid_at(sight, k, index, scale) for k in range(len(sight.fills)))
    lean = complex(sight.lean[index])
    instant = Instant(
        deflection=tuple(map(complex, deflection)),
        lean=lean if cmath.isfinite(lean) else 0j,
        bodies=bodies,
        title=describe_speed(sight.record.name, float(sight.speed[index])),
        state="\n".join(describe_state(sight, index)),
        caption=" ".join(describe_drawing(sight, index, scale)),
    )
    return compose(stage_of(sight, scale) if stage is None else stage, instant)


def liquid_at(sight: Sight, k: int, index: int, scale: Scale) -> LiquidShape | LiquidBodies | None:
    """Liquid of a chamber at a speed, in equilibrium with the deflection as drawn; None if there is none.

    Parameters
    ----------
    sight, k, index : answers, which chamber, which speed
    scale : of deflection and depth
    """
    fill, speed = sight.fills[k], float(sight.speed[index])
    if fill.volume == 0.0:
        return None
    volume = drawn_volume(fill, scale.depth)
    found = complex(sight.deflection[index, k])
    deflection = scale.deflection * found if cmath.isfinite(found) else 0j
    if is_cut(fill):
        return bodies_at_rest(fill, volume, deflection, speed, sight.gravity)
    return body_at_rest(fill.chamber, volume, deflection, speed, sight.gravity)


def describe_speed(name: str, speed: float) -> str:
    """Title of a picture.

    Parameters
    ----------
    name : of the scene
    speed : rad/s
    """
    return f"{one_line(name)}: {speed * RPM:.4g} rpm ({speed:.4g} rad/s)"


def describe_state(sight: Sight, index: int) -> list[str]:
    """Deflection and liquid of a machine at one of its speeds, a line each.

    Parameters
    ----------
    sight, index : its answers, which speed
    """
    found, answer = sight.deflection[index], sight.record.response
    if not np.isfinite(found).all():
        return ["no bounded deflection found: the axis is drawn at rest"]
    lines = []
    several = len({round(abs(one), 12) for one in found}) > 1
    for k, one in enumerate(found):
        if k == 0 or several:
            name = f"chamber {k + 1}: deflection" if several else "deflection"
            lines.append(f"{name} {place_in_words(complex(one), zero_of(sight.record))}")
    if not sight.fills:
        return [*lines, "no liquid"]
    dry = [
        str(k + 1)
        for k, fill in enumerate(sight.fills)
        if fill.volume > 0.0 and is_dry(sight, k, index, fill)
    ]
    wall = "wall wet all round" if not dry else "wall dry in part"
    if dry and len(sight.fills) > 1:
        wall += f" in chamber{'s' if len(dry) > 1 else ''} {', '.join(dry)}"
    lines.append(f"{wall}; liquid model {answer.model[index]}")
    if not answer.in_range[index]:
        lines.append("out of the range in which the models hold")
    if not answer.stable[index]:
        lines.append("not stable: this motion would not last")
    return lines


def is_dry(sight: Sight, k: int, index: int, fill: Fill, scale: Scale | None = None) -> bool:
    """The wall of a chamber is dry in part, in truth or as drawn [theory: statics, eq. 8].

    Parameters
    ----------
    sight, k, index : answers, which chamber, which speed
    fill : that chamber with its liquid
    scale : of the drawing; None for the truth
    """
    factors = scale or Scale()
    moved = complex(sight.deflection[index, k]) * factors.deflection
    if fill.volume == 0.0 or not (0.0 < abs(moved) < math.inf):
        return False
    speed, volume = float(sight.speed[index]), drawn_volume(fill, factors.depth)
    if is_cut(fill):
        return wall_is_dry(fill, volume, moved, speed, sight.gravity)
    return bool(volume < optimal_volume(fill.chamber, abs(moved), speed, sight.gravity))


def place_in_words(deflection: complex, zero: str) -> str:
    """Size and angle of a deflection.

    Parameters
    ----------
    deflection : m
    zero : what angles count from
    """
    if deflection == 0.0:
        return "none"
    angle = f"{math.degrees(cmath.phase(deflection)):.0f}"
    angle = "0" if angle == "-0" else angle.replace("-", MINUS)
    return f"{abs(deflection) * MM:.3g} mm at {angle}{DEGREE} from {zero}"


def describe_drawing(sight: Sight, index: int, scale: Scale) -> list[str]:
    """How a still is drawn, sentence by sentence.

    Parameters
    ----------
    sight, index, scale : answers, which speed, factors
    """
    words = [scale.in_words(), "Seen from the drum."]
    if sight.fills and scale != Scale():
        words.append("The liquid is in equilibrium with the deflection as drawn.")
    wrong = [
        k
        for k, f in enumerate(sight.fills)
        if is_dry(sight, k, index, f) != is_dry(sight, k, index, f, scale)
    ]
    if wrong:
        state = (
            "dry in part" if is_dry(sight, wrong[0], index, sight.fills[wrong[0]], scale) else "wet all round"
        )
        words.append(f"A wall is {state} in the picture alone.")
    if any(fill.compartments > 1 for fill in sight.fills):
        words.append("Baffles close the compartments: each keeps its volume.")
    open_ = [fill for fill in sight.fills if fill.chamber.baffles is not None and fill.compartments == 1]
    if scale.depth > 1.0 and open_:
        words.append("Distances of the baffles from the wall grow with the depth.")
    if names := dict.fromkeys(
        one.chamber.section.name for one in sight.fills if one.chamber.section is not None
    ):
        words.append(f"Section from {', '.join(names)}.")
    if sight.moved:
        words.append("Chambers drawn one behind the other; the scene does not say where they are.")
    motion = sight.record.motion
    if motion is not None and abs(motion.backward[index]) > 0.01 * abs(
        sight.record.response.deflection[index]
    ):
        words.append(
            f"Drawn is the part that turns with the spin; {abs(motion.backward[index]) * MM:.2g} mm "
            "turn against it."
        )
    if sight.record.assumed:
        words.append("Some values of the scene are assumed.")
    return words
