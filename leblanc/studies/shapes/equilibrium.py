"""Where the chambers of a machine are drawn, and their liquid in equilibrium with the deflection as drawn."""

from __future__ import annotations

import cmath

from fluid.fill import Fill
from leblanc.plotting.bodies import Liquid, Scale
from leblanc.scene.rotors import JeffcottRotor
from leblanc.scene.scene import Scene
from leblanc.studies.shapes.bodies import bodies_at_rest, is_cut
from leblanc.studies.shapes.layer import body_at_rest
from leblanc.studies.shapes.scale import drawn_volume

GAP = 0.25  # between chambers moved apart, over the wider one's radius


def places_of(scene: Scene) -> tuple[tuple[float, ...], bool]:
    """Middle of each chamber along the axis as drawn, and whether some were moved out of each other.

    A planar rotor's chambers that do not lie inside one another stand one behind the other.
    """
    chambers = [fill.chamber for fill in scene.fills]
    if not isinstance(scene.rotor, JeffcottRotor):
        return tuple(chamber.plane for chamber in chambers), False
    stacks: list[list[int]] = []
    for k in sorted(range(len(chambers)), key=lambda k: -chambers[k].radius):
        for stack in stacks:
            if chambers[k].radius <= chambers[stack[-1]].inner_radius:
                stack.append(k)
                break
        else:
            stacks.append([k])
    places, behind = [0.0] * len(chambers), 0.0
    for stack in stacks:
        height = max(chambers[k].height for k in stack)
        middle = behind - 0.5 * height
        for k in stack:
            places[k] = middle
        behind -= height + GAP * max(chamber.radius for chamber in chambers)
    shift = 0.5 * (max(places) + min(places)) if places else 0.0
    return tuple(place - shift for place in places), len(stacks) > 1


def liquid_at(fill: Fill, deflection: complex, speed: float, gravity: float, scale: Scale) -> Liquid:
    """Liquid of a chamber at a speed; None if there is none."""
    if fill.volume == 0.0:
        return None
    volume = drawn_volume(fill, scale.depth)
    moved = scale.deflection * deflection if cmath.isfinite(deflection) else 0j
    if is_cut(fill):
        return bodies_at_rest(fill, volume, moved, speed, gravity)
    return body_at_rest(fill.chamber, volume, moved, speed, gravity)
