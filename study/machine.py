"""The dry rotor of a scene as the solvers take it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from meshes.border import InputError
from study.scene import Rotor, Scene, TubRotor, TwoPlaneRotor

if TYPE_CHECKING:
    from solvers.rotor.jeffcott import Jeffcott
    from solvers.rotor.tub import Tub
    from solvers.rotor.two_plane import TwoPlane


def jeffcott(scene: Scene) -> Jeffcott:
    """The scene's planar rotor without liquid.

    Raises
    ------
    InputError : the scene's rotor is of another kind
    """
    from solvers.rotor.jeffcott import Jeffcott

    rotor = scene.rotor
    if not isinstance(rotor, Rotor):
        raise InputError("rotor.kind", rotor.kind, "jeffcott for this")
    return Jeffcott(rotor.mass, rotor.stiffness, rotor.damping, rotor.unbalance)


def dry_rotor(scene: Scene) -> Jeffcott | TwoPlane | Tub:
    """The scene's rotor without liquid, whose `system()` gives its equations of motion.

    Raises
    ------
    InputError : the scene is that of an exciter, which has no linear equations of motion
    """
    if isinstance(scene.rotor, TwoPlaneRotor | TubRotor):
        return scene.rotor.machine
    if not isinstance(scene.rotor, Rotor):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott, two_plane or tub for this")
    return jeffcott(scene)
