"""Analytical checks of a scene: each where the scene has what it needs."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from fluid.printed import liquid_angle_as_printed
from leblanc.liquid.choose import Prepared
from leblanc.scene.bearings import CagedBearing
from leblanc.scene.scene import Scene, TubRotor, TwoPlaneRotor
from leblanc.studies.closed_forms.answer import Cage, ClosedForms, Upright, VectorModel
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.balls.two_plane_balance import Balancing, dynamic_balancing, of_two_planes
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import cage_speed
from solvers.rotor.vector_model import balance_angles, deflection_lag, unbalance_left
from solvers.statics.upright import Top, sign_changes, upright_margin
from solvers.synchronous.response import Response


def closed_forms(machine: Prepared, answer: Response | None = None) -> ClosedForms:
    """Analytical checks that a scene has the data for."""
    scene, speed = machine.scene, machine.speed
    balancing, why_not = _balancing(scene, speed)
    missing = [lacking(scene), why_not, _no_balls(scene)]
    vector = None
    if answer is not None and scene.fills and isinstance(machine.rotor, Jeffcott):
        vector = vector_model(machine.rotor, answer, sum(fill.mass for fill in scene.fills))
    bearings = scene.rotor.caged() if isinstance(scene.rotor, TubRotor | TwoPlaneRotor) else ()
    return ClosedForms(
        upright=upright(scene, speed),
        vector=vector,
        balancing=balancing,
        cages=cages_of(bearings, speed),
        lacking=tuple(text for text in missing if text is not None),
    )


def vector_model(rotor: Jeffcott, answer: Response, liquid_mass: float) -> VectorModel:
    """Angles of the vector model beside those of a response [DR18, eq. 24-26; theory: rotor, eq. 9-14].

    The ratio takes the liquid's unbalance from its law alone, the angle is that of the balance with the
    rotor: they fit each other only where the response solves it.
    """
    lag = deflection_lag(answer.speed, rotor.mass, rotor.damping, rotor.stiffness)
    liquid = answer.liquid_offset * liquid_mass
    known = np.isfinite(liquid) & (liquid > 0.0)
    ratio = np.full(liquid.shape, math.nan)
    np.divide(rotor.unbalance, liquid, out=ratio, where=known)
    angle = np.where(known, -answer.liquid_angle, math.nan)
    left = np.full(ratio.shape, math.nan)
    turning = known & (ratio > 0.0)
    left[turning] = unbalance_left(angle[turning], ratio[turning])
    return VectorModel(
        lag=lag,
        ratio=ratio,
        angle=angle,
        balance_angle=_nearest_balance(lag, ratio, angle),
        printed_angle=np.array([_printed(*each) for each in zip(lag.tolist(), ratio.tolist(), strict=True)]),
        unbalance_left=left,
    )


def _nearest_balance(lag: Array, ratio: Array, angle: Array) -> Array:
    """Of the two angles that balance the one nearer to that of the answer, rad; nan where there is none."""
    found = np.full(angle.shape, math.nan)
    real = (ratio > 0.0) & (ratio >= np.sin(lag))
    both = np.stack(balance_angles(lag[real], ratio[real]))
    # Whole turns do not count; the difference is kept beside the answer's own angle.
    apart = np.mod(both - angle[real] + math.pi, 2.0 * math.pi) - math.pi
    nearest = np.abs(apart).argmin(axis=0)
    found[real] = angle[real] + np.take_along_axis(apart, nearest[None], axis=0)[0]
    return found


def _printed(lag: float, ratio: float) -> float:
    """Angle of the source's formula, rad; nan where it is not real."""
    if not ratio > 0.0:
        return math.nan
    try:
        return liquid_angle_as_printed(lag, ratio)
    except InputError:
        return math.nan


def _balancing(scene: Scene, speed: Array) -> tuple[Balancing | None, str | None]:
    """Conditions of balancing in two planes of a rotor that tilts, or why they are not reported."""
    if not isinstance(scene.rotor, TwoPlaneRotor):
        return None, None
    refused = "Conditions of balancing in two planes"
    planes = [fill.chamber.plane for fill in scene.fills if fill.volume > 0.0]
    planes += [race.plane for race in scene.balls]
    if not planes:
        return None, None
    if len(set(planes)) < 2:
        what = "liquid and balls are" if scene.balls else "liquid is"
        return None, f"{refused}: {what} in fewer than two planes."
    added = sum(fill.mass for fill in scene.fills) + sum(sum(race.race().masses) for race in scene.balls)
    try:
        rotor = of_two_planes(scene.rotor.machine(), added)
    except InputError as error:
        return None, f"{refused}: {error}."
    return dynamic_balancing(rotor, speed), None


def _no_balls(scene: Scene) -> str | None:
    """Why the speed of no cage is reported, though there are bearings."""
    rotor = scene.rotor
    if not isinstance(rotor, TubRotor) or not rotor.bearings or rotor.caged():
        return None
    return (
        "Speed of the bearings' cages: ball_diameter and pitch_diameter are not given in [[rotor.bearings]]."
    )


def cages_of(bearings: Sequence[CagedBearing], speed: Array) -> tuple[Cage, ...]:
    """Speeds of cages without slip [DR18, eq. 9-10; theory: rotor, eq. 32]."""
    found = []
    for part in bearings:
        printed = 0.5 * speed if part.contact_angle == 0.0 else np.full(speed.shape, math.nan)
        cage = cage_speed(speed, part.pitch_diameter, part.ball_diameter, part.contact_angle)
        found.append(Cage(part.name, cage, printed))
    return tuple(found)


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
    if not all(support.isotropic for support in scene.rotor.machine().supports):
        return f"{stability}: a support differs in two directions."
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
    supports = rotor.machine().supports
    stiffness = sum(float(each.across[0][0, 0]) * (each.position - pivot) ** 2 for each in supports)
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
