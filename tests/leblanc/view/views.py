"""Machines as `leblanc view` draws them, for tests of pictures."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from leblanc.plotting.bodies import DrawnLiquid, MachineMotion, RunupView, Scale
from leblanc.scene.scene import Scene, load_scene
from leblanc.studies.shapes.machine import drawn_liquid, machine_view, runup_view
from leblanc.view.film import Film, sweep_film
from leblanc.view.parts import Picture
from leblanc.view.scene import still

EXAMPLES = Path(__file__).parents[3] / "examples"
FRAMES = 13  # of a short run-up


@dataclass(frozen=True)
class Shown:
    """A machine at one speed, its liquid as drawn, and the picture."""

    motion: MachineMotion
    liquid: DrawnLiquid
    picture: Picture

    @property
    def scale(self) -> Scale:
        return self.liquid.scale


def show(scene: Scene, speed: float | None = None, factor: float | None = None) -> Shown:
    """A scene's machine at one speed."""
    view = machine_view(scene, speed, factor)
    return Shown(view.motion, view.liquid, still(view.motion, -1, view.liquid))


def picture_at(motion: MachineMotion, index: int, scale: Scale) -> Picture:
    """Picture at one of the speeds."""
    return still(motion, index, drawn_liquid(motion, index, scale))


def film_over(motion: MachineMotion, scale: Scale, frames: int) -> Film:
    """Film over the speeds."""
    return sweep_film(motion, scale, lambda k: drawn_liquid(motion, k, scale), frames)


def scene(name: str) -> Scene:
    """An example."""
    return load_scene(EXAMPLES / f"{name}.toml")


@cache
def working(name: str) -> Shown:
    """An example at its working speed."""
    return show(scene(name))


@cache
def short_runup(name: str) -> RunupView:
    """An example run up in 4 s."""
    short = {"runup.duration": "4 s", "runup.cells": 32, "runup.samples": 250}
    return runup_view(scene(name).replace(short), FRAMES)
