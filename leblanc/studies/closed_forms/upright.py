"""Whether a vertical rotor with a ball joint stands upright with its liquid, and up to where."""

from __future__ import annotations

import numpy as np

from leblanc.scene.scene import Scene, TwoPlaneRotor
from leblanc.studies.closed_forms.answer import Upright
from meshes.arrays import Array
from solvers.statics.upright import Top, sign_changes, upright_margin

_SHARES = 201  # of the fill, between which changes of sign are looked for
_SPEEDS = 401  # the same of the speed
_LEAST = 1e-6  # of a chamber, that is liquid or air


def lacking(scene: Scene) -> str | None:
    """What the scene lacks for it; None where it lacks nothing, or its axis is not vertical."""
    if scene.rotor.axis != "vertical":
        return None
    stability = "Stability of the upright rotation"
    if not isinstance(scene.rotor, TwoPlaneRotor):
        if scene.rotor.kind == "jeffcott":
            return f"{stability}: a planar rotor does not tilt; it takes a two_plane rotor with rotor.pivot."
        return (
            f"{stability}: a tub hangs on its springs, without the ball joint of the source's condition; it "
            "takes a two_plane rotor with rotor.pivot."
        )
    if scene.rotor.pivot is None:
        return f"{stability}: rotor.pivot, the place of a ball joint, is not given."
    walls = [fill.chamber for fill in scene.fills]
    if any(chamber.section is not None or chamber.baffles is not None for chamber in walls):
        return f"{stability}: a chamber has baffles or a section of its own."
    if scene.balls:
        return f"{stability}: balls that can move in their races are not in its condition."
    return None


def upright(scene: Scene, speed: Array) -> Upright | None:
    """Margin over the scene's speeds, and where it is used up [theory: statics, eq. 20-21].

    None where it lacks something, see `lacking`, or its axis is horizontal.
    """
    rotor = scene.rotor
    if lacking(scene) is not None or not isinstance(rotor, TwoPlaneRotor) or rotor.pivot is None:
        return None
    pivot, fills = rotor.pivot, [fill for fill in scene.fills if fill.volume > 0.0]
    stiffness = sum(support.stiffness * (support.position - pivot) ** 2 for support in rotor.supports)
    top = Top(rotor.mass, rotor.transverse_inertia, rotor.polar_inertia, -pivot, stiffness)

    def left_at(spin: Array) -> Array:
        return upright_margin(top, fills, 1.0, spin, scene.gravity).left

    def left_of_fill(share: Array) -> Array:
        return upright_margin(top, fills, share, scene.speeds.stop, scene.gravity).left

    margin = upright_margin(top, fills, 1.0, speed, scene.gravity)
    span = np.linspace(scene.speeds.start, scene.speeds.stop, _SPEEDS)
    # The least film has a free surface and a full chamber none: both ends are jumps, and left out.
    most = min((fill.chamber.capacity / fill.volume for fill in fills), default=1.0)
    shares = most * np.linspace(_LEAST, 1.0 - _LEAST, _SHARES)
    return Upright(
        speed=speed,
        dry=upright_margin(top, (), 1.0, speed, scene.gravity).left,
        frozen=margin.frozen,
        surface=margin.surface,
        limits=sign_changes(left_at, span),
        fill_limits=sign_changes(left_of_fill, shares) if fills else (),
    )
