"""The searched fill volumes against closed forms [theory: optimum, eq. 1; theory: statics, eq. 8].

At the working speed nothing is gained beyond the volume that wets the whole wall at the deflection that the
machine has with the reference mass added to it: both follow without a search.
"""

from __future__ import annotations

from leblanc.core.units import MM
from leblanc.liquid.choose import axial_gravity
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene, jeffcott
from leblanc.studies.optimise.study import optimise_scene
from leblanc.studies.optimise.wetting import wetting_volumes
from validation.case import Case, Claims

CLAIMS = Claims("fill_optimum")

_ML = 1e6
# Values within 1e-6 count as equal, and the least volume of these is the answer. What is missing costs its
# 5/2 power of the unbalance along an upright axis, its 3/2 power on a horizontal one: 0.4 % and 0.01 % of the
# volume, times a number of order one to ten.
_UPRIGHT, _HORIZONTAL = 0.01, 0.002


def cases() -> list[Case]:
    """An upright and a horizontal machine with one chamber: best volume and its amplitude."""
    found = []
    for name, tolerance in (("runup", _UPRIGHT), ("washing_machine", _HORIZONTAL)):
        scene = example(name)
        answer = optimise_scene(scene.altered(optimise=None), "working_speed", front=False)
        deflection, volume = closed_forms(scene)
        words = {"machine": name, "at": f"{scene.name}, at the working speed"}
        sizes = {"printed": volume * _ML, "tolerance": tolerance, "percent": 100.0 * tolerance}
        found += [
            CLAIMS.case("volume", float(answer.volume[0]) * _ML, **sizes, **words),
            CLAIMS.case("amplitude", answer.value * MM, printed=deflection * MM, **words),
        ]
    return found


def closed_forms(scene: Scene) -> tuple[float, float]:
    """Amplitude of a planar rotor with the reference mass added, m, and volume that it takes, m^3.

    Of one chamber, at the last of the scene's speeds.
    """
    rotor, (fill,), speed = jeffcott(scene), scene.fills, scene.speeds.stop
    total = rotor.mass + fill.full_mass
    stiffness = complex(rotor.stiffness - total * speed**2, rotor.damping * speed)
    deflection = rotor.unbalance * speed**2 / abs(stiffness)
    form = wetting_volumes(fill.chamber, deflection, speed, axial_gravity(scene))
    return deflection, form.full_volume
