"""A run-up frame by frame with its layers as they are drawn."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from fluid.fill import Fill
from leblanc.results.drawn import Liquid, RunupView, Scale, film_factor
from leblanc.results.runup import RunupFrames, RunupResult
from leblanc.scene.scene import Scene
from leblanc.studies.runup import runup_scene
from leblanc.studies.shapes.layer import body_of_layer, body_of_pool
from leblanc.studies.shapes.machine import places_of
from leblanc.studies.shapes.scale import SHOWN, THIN, given_scale

VISIBLE = 0.04  # a largest deflection smaller than this over the radius is drawn larger


def runup_view(
    scene: Scene, frames: int, factor: float | None = None, progress: Callable[[float], None] | None = None
) -> RunupView:
    """Run a scene up and draw its layers.

    Parameters
    ----------
    scene : with a table `runup`
    frames : how many
    factor : of the deflection as drawn; chosen if None
    progress : called with the share of the run-up that is done

    Raises
    ------
    InputError : a value out of its range, a run-up whose liquid has no layer to show
    """
    result = runup_scene(scene, check=False, progress=progress, frames=frames)
    kept = result.frames
    assert kept is not None
    if factor is None:
        scale = runup_scale(max((fill.chamber.radius for fill in scene.fills), default=0.1), result, kept)
    else:
        scale = given_scale(factor, scene.fills, kept.deflection)
    bodies = tuple(
        tuple(_liquid(fill, scale, kept, k, j) for j, fill in enumerate(scene.fills))
        for k in range(kept.time.size)
    )
    return RunupView(result, kept, scene.fills, places_of(scene)[0], scale, bodies)


def runup_scale(radius: float, result: RunupResult, frames: RunupFrames) -> Scale:
    """One factor for deflections and depths, so that a surface round the axis at rest stays so as drawn.

    Parameters
    ----------
    radius : of the widest chamber, m
    result, frames : the run-up and its layers at regular times
    """
    largest = float(np.abs(frames.deflection).max())
    thin = any(c.radius - c.mean_surface_radius < THIN * c.radius for c in result.chambers if c.volume > 0.0)
    if not thin and largest >= VISIBLE * radius:
        return Scale()
    fits = film_factor(result.chambers, frames.depth, frames.deflection)
    both = max(1.0, min(fits, SHOWN * radius / largest if largest > 0.0 else 1.0))
    both = float(f"{both:.2g}")
    return Scale(both, both)


def _liquid(fill: Fill, scale: Scale, frames: RunupFrames, k: int, j: int) -> Liquid:
    """Liquid of a chamber in a frame."""
    if fill.volume == 0.0:
        return None
    moved, depth = complex(scale.deflection * frames.deflection[k, j]), frames.depth[k, j]
    if np.isnan(depth).any():
        return body_of_pool(fill.chamber, fill.volume, moved, float(frames.pool[k]))
    return body_of_layer(fill.chamber, moved, frames.theta, scale.depth * depth)
