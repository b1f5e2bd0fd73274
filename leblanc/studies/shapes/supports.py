"""What carries the chambers of a scene and what holds it: drum, housing, shaft, bearings, springs, dampers.

A scene tells masses and stiffnesses, and of springs and dampers of a tub where they hold it and which way
they act. What it does not tell is sketched round the chambers, and said so.
"""

from __future__ import annotations

import cmath
import math
from collections.abc import Iterable
from dataclasses import replace

from leblanc.plotting.bodies import MachineParts, Shell, Spot, Strut
from leblanc.scene.rotors import JeffcottRotor, TubRotor, TwoPlaneRotor
from leblanc.scene.scene import Scene

# Lengths over the drum's radius, for what a scene does not give.
BARE = 0.1  # m, radius of a machine without chambers and springs
SHAFT = 0.07  # radius of the shaft
HOUSE = 1.2  # radius of a tub round its drum
LONG = 0.6  # of springs and dampers
CLEAR = 0.06  # between drum and housing along the axis
DEEP = 0.9  # of a drum behind an open ring
CUP = 1.14  # of the ring in which a planar rotor is drawn hung
BEARING = 0.16  # radius of a bearing
OPEN = 0.6  # a ring whose inner wall is farther out than this is open

# Angles of springs and dampers round the axis, degrees: hung and propped, under a bearing, all round.
HUNG = (("spring", 50.0), ("spring", 130.0), ("damper", -58.0), ("damper", -122.0))
UNDER = (("spring", -112.0), ("damper", -68.0))
AROUND = (("spring", 45.0), ("damper", 135.0), ("spring", 225.0), ("damper", 315.0))

_SAME = 1e-6  # of a length: two mounts at one place


def machine_parts(scene: Scene, places: tuple[float, ...]) -> MachineParts:
    """Drum, housing, shaft, bearings, springs and dampers of a scene's rotor."""
    if isinstance(scene.rotor, TubRotor):
        return _around(scene, _tub(scene, scene.rotor, places))
    if isinstance(scene.rotor, TwoPlaneRotor):
        return _around(scene, _two_plane(scene, scene.rotor, places))
    assert isinstance(scene.rotor, JeffcottRotor)
    return _around(scene, _jeffcott(scene, scene.rotor, places))


def _around(scene: Scene, parts: MachineParts) -> MachineParts:
    """The same with the feet of its cabinet, in their order round it, and the points that the scene names."""
    points = tuple(
        Spot(point.name, *_spot(scene, point.position), turns=point.on == "drum") for point in scene.points
    )
    if scene.cabinet is None:
        return replace(parts, points=points)
    feet = [Spot("", *_spot(scene, foot)) for foot in scene.cabinet.feet]
    lying = scene.rotor.axis == "horizontal"
    flat = [complex(foot.axial, foot.across.real) if lying else foot.across for foot in feet]
    middle = sum(flat) / len(flat)
    order = sorted(range(len(feet)), key=lambda k: cmath.phase(flat[k] - middle))
    told = "The cabinet stands on its feet where the scene says; its edges and its top are sketched."
    return replace(
        parts,
        points=points,
        feet=tuple(feet[k] for k in order),
        sketched=f"{parts.sketched} {told}".strip(),
    )


def _spot(scene: Scene, position: tuple[float, float, float]) -> tuple[float, complex]:
    """Place along the axis and across it, gravity along -i where the axis lies; the spin goes with i."""
    if isinstance(scene.rotor, TubRotor):
        return position[1], _across(position, scene.rotor.axis)
    x, y, z = position
    return z, complex(-y, x) if scene.rotor.axis == "horizontal" else complex(x, y)


def _ends(scene: Scene, places: tuple[float, ...]) -> tuple[float, float]:
    """Of all chambers along the axis, m."""
    halves = [0.5 * fill.chamber.height for fill in scene.fills]
    low = min((p - h for p, h in zip(places, halves, strict=True)), default=0.0)
    return low, max((p + h for p, h in zip(places, halves, strict=True)), default=0.0)


def _radius(scene: Scene, otherwise: float) -> float:
    """Of the widest chamber, m."""
    return max((fill.chamber.radius for fill in scene.fills), default=otherwise)


def _tub(scene: Scene, rotor: TubRotor, places: tuple[float, ...]) -> MachineParts:
    """Drum and tub in the middle between the springs; these where the scene puts them."""
    mounts = [(part, "spring") for part in rotor.springs] + [(part, "damper") for part in rotor.dampers]
    reach = [abs(_across(part.position, rotor.axis)) for part, _ in mounts]
    nearest = min((size for size in reach if size > 0.0), default=BARE)
    radius = _radius(scene, 0.7 * nearest)
    low, high = _ends(scene, places)
    half = max(-low, high, 0.5 * radius)
    length = LONG * radius
    # What acts along no direction of its own, at the place of what does, is the bush of that.
    taken = [part.position for part, _ in mounts if part.direction is not None]
    struts: list[Strut] = []
    for part, kind in mounts:
        place = (part.position[1], _across(part.position, rotor.axis))
        if part.direction is not None:
            struts.append(_strut(kind, place, part.direction, rotor.axis, length))
        elif any(math.dist(part.position, other) <= _SAME * max(radius, nearest) for other in taken):
            bush = Strut("bush", *place, 1.0, 0j, 0.12 * radius)
            struts += [bush] if bush not in struts else []
        else:
            values = getattr(part, part.COEFFICIENT)
            struts += [
                _strut(kind, place, direction, rotor.axis, length)
                for direction, value in zip(_outwards(part.position), values, strict=True)
                if value > 0.0
            ]
    size = max(1.06 * radius, min(HOUSE * radius, 0.97 * nearest))
    gap = CLEAR * radius
    return MachineParts(
        drum=Shell(radius, -half, half),
        hollow=True,
        housing=Shell(size, -half - 2.0 * gap, half + gap),
        shaft=(Shell(SHAFT * radius, -half - 4.0 * gap, -half),),
        bearings=(-half - 2.0 * gap,),
        struts=tuple(struts),
        sketched="Springs and dampers hold the tub where the scene says; their lengths, drum and tub are "
        "sketched.",
    )


def _across(position: tuple[float, float, float], axis: str) -> complex:
    """Place across the spin axis y, gravity along -i where that lies; the spin turns z into x."""
    x, _, z = position
    return complex(-x, z) if axis == "horizontal" else complex(z, x)


def _strut(
    kind: str,
    place: tuple[float, complex],
    direction: tuple[float, float, float],
    axis: str,
    length: float,
) -> Strut:
    size = math.hypot(*direction)
    return Strut(kind, *place, direction[1] / size, _across(direction, axis) / size, length)


def _outwards(position: tuple[float, float, float]) -> list[tuple[float, float, float]]:
    """Along x, y and z, each away from the centre of mass."""
    signs = [-1.0 if value < 0.0 else 1.0 for value in position]
    return [(signs[0], 0.0, 0.0), (0.0, signs[1], 0.0), (0.0, 0.0, signs[2])]


def _two_plane(scene: Scene, rotor: TwoPlaneRotor, places: tuple[float, ...]) -> MachineParts:
    """Drum from its first to its last chamber, a shaft in the supports of the scene."""
    supports = [support.position for support in rotor.supports]
    span = max(supports) - min(supports)
    radius = _radius(scene, 0.25 * span or BARE)
    low, high = _ends(scene, places)
    middle = 0.5 * (low + high)
    low, high = min(low, middle - 0.25 * radius), max(high, middle + 0.25 * radius)
    struts = tuple(
        strut
        for support in rotor.supports
        for strut in _radial(
            support.position, BEARING * radius, 1.25 * radius, UNDER if rotor.axis == "horizontal" else AROUND
        )
        if strut.kind == "spring" or support.damping not in (0.0, (0.0, 0.0))
    )
    beyond = 0.15 * radius
    first, last = min([low, *supports]) - beyond, max([high, *supports]) + beyond
    bore = min((fill.chamber.inner_radius for fill in scene.fills), default=radius)
    size = SHAFT * radius
    # Through the drum where no liquid stands in its way.
    pieces = [(first, last)] if bore > 2.0 * size else [(first, low), (high, last)]
    return MachineParts(
        drum=Shell(radius, low, high),
        hollow=True,
        housing=None,
        shaft=tuple(Shell(size, start, end) for start, end in pieces if end > start),
        bearings=tuple(supports),
        struts=struts,
        sketched="Supports stand where the scene says; their springs and dampers, drum and shaft are "
        "schematic.",
    )


def _radial(
    axial: float, radius: float, length: float, parts: Iterable[tuple[str, float]]
) -> tuple[Strut, ...]:
    """Springs and dampers across the axis, from a circle round it outwards."""
    ways = [(kind, cmath.rect(1.0, math.radians(angle))) for kind, angle in parts]
    return tuple(Strut(kind, axial, radius * way, 0.0, way, length) for kind, way in ways)


def _jeffcott(scene: Scene, rotor: JeffcottRotor, places: tuple[float, ...]) -> MachineParts:
    """A drum behind an open ring, or a disc with its chambers, in a ring that springs and dampers hold."""
    radius = _radius(scene, BARE)
    low, high = _ends(scene, places)
    hollow = all(fill.chamber.inner_radius >= OPEN * fill.chamber.radius for fill in scene.fills)
    end = low - (DEEP * radius if hollow and scene.fills else SHAFT * radius)
    gap, size = CLEAR * radius, CUP * radius
    cup = Shell(size, end - gap, end + max(0.4 * (high - end), 0.12 * radius))
    struts = _radial(
        0.5 * (cup.low + cup.high), size, LONG * radius, HUNG if rotor.axis == "horizontal" else AROUND
    )
    damped = rotor.machine().damping > 0.0
    return MachineParts(
        drum=Shell(radius, end, high),
        hollow=hollow and bool(scene.fills),
        housing=cup,
        shaft=(Shell(SHAFT * radius, end - 4.0 * gap, end),),
        bearings=(cup.low,),
        struts=tuple(strut for strut in struts if strut.kind == "spring" or damped),
        sketched="Drum, shaft, springs and dampers are schematic: the scene does not say where they are.",
    )
