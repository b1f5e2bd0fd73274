"""Stills: a machine in steady rotation at one speed, its liquid at rest in the drum."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

import numpy as np

from leblanc.figures.caption import zero_of
from leblanc.results.base import one_line
from leblanc.results.drawn.scale import Scale
from leblanc.results.drawn.shapes import DrawnLiquid, MachineMotion
from leblanc.units import MM, RPM
from leblanc.view.parts import Instant, Picture, Stage
from leblanc.view.scene import compose

MINUS, DEGREE = "\N{MINUS SIGN}", "\N{DEGREE SIGN}"


def stage_of(motion: MachineMotion, scale: Scale) -> Stage:
    """What stands still in pictures of a machine.

    Parameters
    ----------
    motion : the machine
    scale : common to all pictures
    """
    size = np.nan_to_num(np.abs(motion.deflection))
    tilting = motion.response.motion
    return Stage(
        fills=motion.fills,
        places=motion.places,
        lying=motion.response.axis == "horizontal",
        scale=scale,
        swing=scale.deflection * float(size.max(initial=0.0)),
        zero="unbalance" if tilting is None or tilting.zero == "unbalance" else "angle 0",
    )


def still(motion: MachineMotion, index: int, liquid: DrawnLiquid, stage: Stage | None = None) -> Picture:
    """Picture of a machine at one of its speeds.

    Parameters
    ----------
    motion : the machine
    index : of the speed
    liquid : as drawn at that speed
    stage : of several pictures, for this one alone if None
    """
    found = motion.deflection[index]
    deflection = np.where(np.isfinite(found), found, 0.0)
    lean = complex(motion.lean[index])
    instant = Instant(
        deflection=tuple(map(complex, deflection)),
        lean=lean if cmath.isfinite(lean) else 0j,
        bodies=liquid.bodies,
        title=describe_speed(motion.response.name, float(motion.speed[index])),
        state="\n".join(describe_state(motion, index, liquid.dry)),
        caption=" ".join(describe_drawing(motion, index, liquid)),
    )
    return compose(stage_of(motion, liquid.scale) if stage is None else stage, instant)


def describe_speed(name: str, speed: float) -> str:
    """Title of a picture.

    Parameters
    ----------
    name : of the scene
    speed : rad/s
    """
    return f"{one_line(name)}: {speed * RPM:.4g} rpm ({speed:.4g} rad/s)"


def describe_state(motion: MachineMotion, index: int, dry: Sequence[bool]) -> list[str]:
    """Deflection and liquid of a machine at one of its speeds, a line each.

    Parameters
    ----------
    motion, index : the machine, which speed
    dry : the wall of each chamber is dry in part there
    """
    found, answer = motion.deflection[index], motion.response.response
    if not np.isfinite(found).all():
        return ["no bounded deflection found: the axis is drawn at rest"]
    lines = []
    several = len({round(abs(one), 12) for one in found}) > 1
    for k, one in enumerate(found):
        if k == 0 or several:
            name = f"chamber {k + 1}: deflection" if several else "deflection"
            lines.append(f"{name} {place_in_words(complex(one), zero_of(motion.response))}")
    if not motion.fills:
        return [*lines, "no liquid"]
    which = [str(k + 1) for k, here in enumerate(dry) if here]
    wall = "wall wet all round" if not which else "wall dry in part"
    if which and len(motion.fills) > 1:
        wall += f" in chamber{'s' if len(which) > 1 else ''} {', '.join(which)}"
    lines.append(f"{wall}; liquid model {answer.model[index]}")
    if not answer.in_range[index]:
        lines.append("out of the range in which the models hold")
    if not answer.stable[index]:
        lines.append("not stable: this motion would not last")
    return lines


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


def describe_drawing(motion: MachineMotion, index: int, liquid: DrawnLiquid) -> list[str]:
    """How a still is drawn, sentence by sentence.

    Parameters
    ----------
    motion, index, liquid : the machine, which speed, its liquid as drawn
    """
    scale = liquid.scale
    words = [scale.in_words(), "Seen from the drum."]
    if motion.fills and scale != Scale():
        words.append("The liquid is in equilibrium with the deflection as drawn.")
    wrong = [here for there, here in zip(liquid.dry, liquid.drawn_dry, strict=True) if here != there]
    if wrong:
        words.append(f"A wall is {'dry in part' if wrong[0] else 'wet all round'} in the picture alone.")
    if any(fill.compartments > 1 for fill in motion.fills):
        words.append("Baffles close the compartments: each keeps its volume.")
    open_ = [fill for fill in motion.fills if fill.chamber.baffles is not None and fill.compartments == 1]
    if scale.depth > 1.0 and open_:
        words.append("Distances of the baffles from the wall grow with the depth.")
    if names := dict.fromkeys(
        one.chamber.section.name for one in motion.fills if one.chamber.section is not None
    ):
        words.append(f"Section from {', '.join(names)}.")
    if motion.moved:
        words.append("Chambers drawn one behind the other; the scene does not say where they are.")
    tilting, answer = motion.response.motion, motion.response.response
    if tilting is not None and abs(tilting.backward[index]) > 0.01 * abs(answer.deflection[index]):
        words.append(
            f"Drawn is the part that turns with the spin; {abs(tilting.backward[index]) * MM:.2g} mm "
            "turn against it."
        )
    if motion.response.assumed:
        words.append("Some values of the scene are assumed.")
    return words
