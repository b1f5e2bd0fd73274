"""What the balls of a scene are in numbers, and from which speed on they balance."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from leblanc.core.units import in_rpm
from leblanc.liquid.choose import runup_outlook
from leblanc.scene.races import BallRace
from leblanc.scene.scene import Scene, TwoPlaneRotor, dry_rotor, require_clear
from leblanc.scene.unbalances import unbalances_of
from leblanc.studies.balls.states import worst_states
from leblanc.studies.explain.balls.answer import BallExplainAnswer, RaceNumbers
from leblanc.studies.explain.study import explain_scene
from meshes.arrays import Array, Flags
from meshes.errors import InputError
from solvers.rotor.balls.states import RotorWithBalls, balancing_shares, turning
from solvers.rotor.balls.two_plane_balance import (
    Balancing,
    dynamic_balancing,
    of_two_planes,
    single_plane_balancing,
)

_SPEEDS, _FEW = 41, 13  # at which the balanced state is looked at; with liquid, which takes its time
_HALVINGS, _FEWER = 20, 8  # of the gap in which it becomes stable
_LEFT = 1e-9  # of the unbalance: what may be left of it where races balance it


def explain_balls(scene: Scene) -> BallExplainAnswer:
    """Numbers of a scene with balls, beside those of the same scene without."""
    machine = replace(explain_scene(scene.without_balls()), digest=scene.digest, runup=runup_outlook(scene))
    require_clear(scene, "balls beside liquid")
    system = dry_rotor(scene).system()
    turned = RotorWithBalls(system, tuple(race.race() for race in scene.balls))
    each, left = balancing_shares(turned)
    shares = np.where(left <= _LEFT, np.abs(each), np.nan)
    count = _FEW if scene.fills else _SPEEDS
    speed = np.linspace(scene.speeds.start, scene.speeds.stop, min(count, max(scene.speeds.count, 2)))
    speed = np.unique(speed)
    states = worst_states(scene, speed)
    can = turned.balanced() is not None
    pairs = zip(scene.balls, shares.tolist(), strict=True)
    return BallExplainAnswer(
        machine=machine,
        races=tuple(_numbers(race, share, machine.critical_speed_dry) for race, share in pairs),
        unbalance=float(sum(unbalances_of(scene.rotor))),
        ball_mass=float(sum(race.count * race.each for race in scene.balls)),
        can_balance=can,
        reason=_why(scene, shares, left, can),
        balanced_from=_balanced_from(scene, speed, states.balanced),
        speed=speed,
        growth=states.balanced_growth,
        balancing=_in_two_planes(scene, turned, speed, can),
        single_plane=_in_one_plane(scene, speed),
        lacking=tuple(_lacking(scene, turned)),
    )


def _numbers(race: BallRace, share: float, critical: float) -> RaceNumbers:
    """One race."""
    own = race.race()
    inertia = own.rolling * own.masses[0]  # kappa m
    side = 0.0
    if race.diameter is not None:
        side = race.count * math.asin(race.diameter / (2.0 * race.radius)) / math.pi
    return RaceNumbers(
        count=race.count,
        mass=race.each,
        plane=race.plane,
        capacity=race.capacity,
        share=share,
        crowding=side,
        fade_time=inertia / race.drag if race.drag > 0.0 else math.inf,
        drag=race.drag / (inertia * critical) if critical > 0.0 else math.nan,
        sticking=race.rolling_resistance * race.radius,
    )


def _why(scene: Scene, shares: Array, left: float, can: bool) -> str:
    """Whether a balanced state exists, and why."""
    if can:
        return "each race holds its share of the unbalance"
    if left > _LEFT:
        return "the unbalance is in other planes than the races, which cannot take all of it away"
    for k, (race, share) in enumerate(zip(scene.balls, shares.tolist(), strict=True)):
        if share > race.capacity:
            return f"the balls of race {k + 1} hold less than their share of the unbalance"
    if any(sum(race.count for race in scene.balls if race.plane == own.plane) == 1 for own in scene.balls):
        return "a single ball holds one size of unbalance alone"
    return "one ball outweighs the unbalance and the other balls of its plane"


def _balanced_from(scene: Scene, speed: Array, balanced: Flags) -> float:
    """Speed from which on the balanced state is stable, rad/s, by halving the gap between two speeds."""
    failing = np.flatnonzero(~balanced)
    first = 0 if not failing.size else int(failing[-1]) + 1
    if first >= speed.size:
        return math.nan
    if first == 0:
        return float(speed[0])
    low, high = float(speed[first - 1]), float(speed[first])
    for _ in range(_FEWER if scene.fills else _HALVINGS):
        middle = 0.5 * (low + high)
        stable = bool(worst_states(scene, [middle]).balanced[0])
        low, high = (low, middle) if stable else (middle, high)
    return high


def _in_two_planes(scene: Scene, turned: RotorWithBalls, speed: Array, can: bool) -> Balancing | None:
    """Conditions of balancing in two planes, with the roots of rotor and balls where they can balance it."""
    if not isinstance(scene.rotor, TwoPlaneRotor) or len({race.plane for race in scene.balls}) < 2:
        return None
    liquid = sum(fill.mass for fill in scene.fills)
    added = sum(race.count * race.each for race in scene.balls) + liquid
    try:
        rotor = of_two_planes(scene.rotor.machine(), added)
    except InputError:
        return None
    roots = (turned.system, turned.races) if can and not scene.fills else None
    return dynamic_balancing(rotor, speed, balls=roots)


def _in_one_plane(scene: Scene, speed: Array) -> Flags | None:
    """Whether light balls in the only plane of the races take away an unbalance of that plane."""
    planes = {race.plane for race in scene.balls}
    if not isinstance(scene.rotor, TwoPlaneRotor) or len(planes) > 1:
        return None
    rotor = scene.rotor.machine()
    added = sum(race.count * race.each for race in scene.balls)
    try:
        alike = of_two_planes(rotor, added)
        damping = [float(support.across[1][0, 0]) for support in rotor.supports]
        return single_plane_balancing(alike, planes.pop(), speed, damping)
    except InputError:
        return None


def _lacking(scene: Scene, turned: RotorWithBalls) -> Iterator[str]:
    """What is not reported."""
    if scene.fills:
        yield "Liquid models beside the balls: those reported are of the scene without its balls."
    if scene.rotor.axis == "horizontal":
        yield "Gravity across the axis, which swings the balls: `leblanc runup` has it."
        reach = [race.rolling_resistance * race.radius for race in scene.balls if race.rolling_resistance]
        if reach:
            free = math.sqrt(scene.gravity / max(reach))
            yield f"Gravity that frees balls which stick: below {in_rpm(free)} it moves them in every turn."
    if any(race.count > 2 for race in scene.balls):
        yield "Three balls and more can balance in many ways: growth is of one; `leblanc run` has its range."
    if turning(turned.system) is None:
        yield "The supports differ in two directions: the balls' swing with twice the spin is left out."
    if scene.rotor.kind == "tub":
        yield "Conditions of balancing in two planes are those of rigid rotors on two supports, not of a tub."
    elif scene.rotor.kind == "two_plane" and not _has_conditions(scene):
        yield "Conditions of balancing: its supports leave a motion free, or are not alike."
    yield "Whether the balls come to rest on the way up: `leblanc runup` follows them in time."


def _has_conditions(scene: Scene) -> bool:
    """Whether a rotor is one that the conditions are for."""
    assert isinstance(scene.rotor, TwoPlaneRotor)
    try:
        of_two_planes(scene.rotor.machine())
    except InputError:
        return False
    return True
