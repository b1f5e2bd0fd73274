"""A command: centrifugal acceleration at the wall of each chamber."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from leblanc.cli.command import command
from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Headline, Table
from leblanc.core.question import SCENE, Quantity, ask
from leblanc.core.units import LENGTH
from leblanc.scene.scene import Scene, require_chambers
from meshes.arrays import Array
from meshes.errors import InputError
from meshes.quantity import Q

FILES = ("gforce.nc",)


@dataclass(frozen=True)
class GforceAnswer(Answer):
    """How hard the liquid is pressed against the wall."""

    command = "gforce"
    data = "gforce.nc"

    name: str
    source: str
    assumed: tuple[str, ...]
    digest: str
    speed: Annotated[Array, Q("rad s-1", "spin speed", over=("speed",))]
    acceleration: Annotated[Array, Q("m s-2", "acceleration at the wall", over=("chamber", "speed"))]
    gravity: Annotated[float, Q("m s-2", "acceleration of gravity")]

    def blocks(self) -> tuple[Block, ...]:
        """What is printed, in the order of reading."""
        most = self.acceleration.max(axis=1) / self.gravity
        rows = [(f"Chamber {k + 1}", f"{value:.3g} g") for k, value in enumerate(most)]
        return Headline(f"Up to {most.max():.3g} g at the wall.", self.name, shown="both"), Table(rows)


def gforce(
    scene: Annotated[Scene | str, SCENE, "Scene or its file."],
    *,
    depth: Annotated[Quantity, LENGTH, "Distance from the wall, inwards."] = 0.0,
) -> GforceAnswer:
    """Centrifugal acceleration at the wall of each chamber over the speeds."""
    return ask(gforce, "slender.gforce:answer_gforce", locals())


def answer_gforce(scene: Scene, depth: float) -> GforceAnswer:
    """What the study answers: Omega^2 (R - d)."""
    require_chambers(scene, "the acceleration at their walls")
    radius = np.array([fill.chamber.radius for fill in scene.fills]) - depth
    if not (radius > 0.0).all():
        raise InputError("depth", depth, "less than the radius of every chamber")
    speed = scene.speed_array()
    about = (scene.name, scene.source, scene.assumed, scene.digest)
    return GforceAnswer(*about, speed, radius[:, None] * speed**2, scene.gravity)


typed = command(gforce)
