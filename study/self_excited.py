"""Self-excited whirl at the speeds of a scene, and what it makes of their stability."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from solvers.whirl import asynchronous_growth
from solvers.whirl_edges import unstable_bands
from study.machine import dry_rotor
from study.record import RPM, SelfExcited
from study.scene import Scene
from study.stability import small_whirl_friction, solver_friction


def self_excited(scene: Scene) -> SelfExcited:
    """Growth of small whirls of the scene's machine at its speeds [theory: whirl, eq. 7].

    Parameters
    ----------
    scene : the machine; its friction acts in the liquid
    """
    system, speed = dry_rotor(scene).system(), scene.speed_array()
    friction = solver_friction(scene.model.friction)
    growth, whirl_speed = asynchronous_growth(system, scene.chambers, speed, friction)
    bands: tuple[tuple[float, float], ...] = ()
    if speed[-1] > speed[0]:
        bands = unstable_bands(system, [scene.chambers], speed, friction, growth[None])[0]
    return SelfExcited(growth, whirl_speed, bands, small_whirl_friction(scene.model.friction))


def stable_with(found: SelfExcited, stable: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """Stability against slow disturbances and against whirls that grow by themselves.

    Parameters
    ----------
    found : the whirl
    stable : against slow disturbances, shape (n,)
    """
    return np.asarray(stable & ~(found.growth > 0.0))


def describe_whirl(found: SelfExcited) -> str:
    """What was found, in words."""
    theory = (
        "by linear theory of an even layer; dry walls and liquid gathered on one side are left out; "
        f"liquid friction: {found.friction}"
    )
    if np.isnan(found.growth).any():
        return f"Whether a whirl grows by itself was not found at every speed ({theory})."
    if not found.bands:
        return f"No whirl grows by itself at these speeds ({theory})."
    listed = ", ".join(f"{low * RPM:.5g} to {high * RPM:.5g} rpm" for low, high in found.bands)
    most = int(np.argmax(found.growth))
    fastest = ""
    if found.growth[most] > 0.0:
        ratio = found.whirl_speed[most]
        fastest = f", fastest at {found.growth[most]:.3g} 1/s, whirling at {ratio * RPM:.4g} rpm"
    return f"A whirl grows by itself from {listed}{fastest}: unstable there ({theory})."
