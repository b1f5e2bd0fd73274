"""Axes of a chart: so many points, evenly spaced, or each of them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from leblanc.scene.scene import Scene
from meshes.arrays import Array
from meshes.errors import InputError

_FEWEST = 2


def few_points(field: str, points: int | Sequence[float], most: int) -> None:
    """Refuse a single point, too many, and points that do not rise."""
    if isinstance(points, int):
        if not _FEWEST <= points <= most:
            raise InputError(field, points, f"a whole number from {_FEWEST} to {most}")
        return
    if not _FEWEST <= len(points) <= most:
        raise InputError(field, f"{len(points)} of them", f"{_FEWEST} to {most} of them")
    for k in range(1, len(points)):
        if not points[k] > points[k - 1]:
            raise InputError(f"{field}.{k}", points[k], f"above the one before it, {points[k - 1]:g}")


def speeds_of(scene: Scene, speeds: int | Sequence[float], most: int) -> tuple[Scene, Array]:
    """The speeds of a chart, so many over the scene's range or those given, and the scene with these."""
    few_points("speeds", speeds, most)
    if not isinstance(speeds, int):
        scene = scene.replace({"speeds": speeds})
        return scene, scene.speed_array()
    if scene.speeds.stop <= scene.speeds.start:
        raise InputError("speeds.stop", scene.speeds.stop, "above speeds.start for a map")
    return scene, np.linspace(scene.speeds.start, scene.speeds.stop, speeds)
