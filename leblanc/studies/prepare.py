"""A scene made ready for the solvers: the dry rotor, its speeds and gravity, each made once."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fluid.friction import Friction
from leblanc.scene.scene import Scene, dry_rotor
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott

if TYPE_CHECKING:
    from solvers.rotor.system import RotorSystem
    from solvers.rotor.tub import Tub
    from solvers.rotor.two_plane import TwoPlane


@dataclass(frozen=True)
class Prepared:
    """A machine as solvers take it; every step of a study takes the same one.

    Parameters
    ----------
    scene : the machine
    rotor : without liquid
    system : its equations of motion
    speed : spin speeds, rad/s, shape (n,)
    axial_gravity, across_gravity : along and across the axis, m/s^2
    friction : of the liquid
    """

    scene: Scene
    rotor: Jeffcott | TwoPlane | Tub
    system: RotorSystem
    speed: Array
    axial_gravity: float
    across_gravity: float
    friction: Friction

    @property
    def planar(self) -> Jeffcott:
        """The rotor, where it is planar.

        Raises
        ------
        InputError : it is of another kind
        """
        if not isinstance(self.rotor, Jeffcott):
            raise InputError("rotor.kind", self.scene.rotor.kind, "jeffcott for this")
        return self.rotor


def prepare(scene: Scene) -> Prepared:
    """The scene's machine as solvers take it.

    Raises
    ------
    InputError : the scene is that of an exciter
    """
    rotor = dry_rotor(scene)
    return Prepared(
        scene=scene,
        rotor=rotor,
        system=rotor.system(),
        speed=scene.speed_array(),
        axial_gravity=axial_gravity(scene),
        across_gravity=across_gravity(scene),
        friction=scene.model.friction,
    )


def axial_gravity(scene: Scene) -> float:
    """Gravity along the rotor's axis, m/s^2: none if the axis lies."""
    return scene.gravity if scene.rotor.axis == "vertical" else 0.0


def across_gravity(scene: Scene) -> float:
    """Gravity across the rotor's axis, m/s^2: none if the axis stands."""
    return scene.gravity if scene.rotor.axis == "horizontal" else 0.0
