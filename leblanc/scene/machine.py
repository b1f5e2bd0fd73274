"""The dry rotor of a scene as the solvers take it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from leblanc.scene.rotors import Exciter, JeffcottRotor
from leblanc.scene.scene import Scene
from meshes.errors import InputError

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
    if not isinstance(scene.rotor, JeffcottRotor):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott for this")
    return scene.rotor.machine()


def require_clear(scene: Scene, what: str) -> None:
    """Refuse baffles and sections of other shapes where nothing knows them.

    Parameters
    ----------
    scene : the machine
    what : what is asked for, in words that follow "left out for"

    Raises
    ------
    InputError : a chamber with baffles or a section from a file
    """
    for k, fill in enumerate(scene.fills):
        if fill.chamber.section is not None:
            raise InputError(f"chambers.{k}.section", fill.chamber.section.name, f"left out for {what}")
        if fill.chamber.baffles is not None:
            raise InputError(
                f"chambers.{k}.baffles", f"{fill.chamber.baffles.count} of them", f"left out for {what}"
            )


def dry_rotor(scene: Scene) -> Jeffcott | TwoPlane | Tub:
    """The scene's rotor without liquid, whose `system()` gives its equations of motion.

    Raises
    ------
    InputError : the scene is that of an exciter, which has no linear equations of motion
    """
    if isinstance(scene.rotor, Exciter):
        raise InputError("rotor.kind", scene.rotor.kind, "jeffcott, two_plane or tub for this")
    return scene.rotor.machine()
