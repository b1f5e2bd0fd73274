"""Limit cycles of a scene as it stands: how large its self-excited whirl becomes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fluid.friction.laws import Friction
from fluid.kdv import FRONT, refuse_quadratic
from leblanc.core.notes import Note, NoteCode, percent
from leblanc.core.progress import update
from leblanc.core.units import in_rpm
from leblanc.liquid.choose import Prepared
from leblanc.studies.cycles.answer import FAST_LAG, LargeWhirl
from meshes.arrays import Array

if TYPE_CHECKING:
    from solvers.cycles.cycles import HeldWhirl, LimitCycles

_DEEP = 0.9  # of the layer's depth: whirls beyond that lay walls dry, or come near to it
# Widths of fronts over the one taken that limit cycles by KdV-Burgers are compared at [theory: kdv, eq. 39].
_TRIED = 0.5, 1.5
_HIGH = 0.3  # of the depth: waves of KdV-Burgers beyond that are out of its range
_POINTS = 128  # round the drum, of waves of KdV-Burgers
_SPEEDS = 41  # at which diffusions are compared
_WAY = 1e-3  # relative width of the range of a single speed


class CycleCode(NoteCode):
    """What the notes of limit cycles say."""

    NO_CYCLES = "no_cycles"
    CYCLES_MISSING = "cycles_missing"
    NO_CIRCLE = "no_circle"
    LAGGING = "lagging"
    DEEP_WHIRL = "deep_whirl"
    HIGH_WAVE = "high_wave"
    DIFFUSION = "diffusion"


def cycles_by(machine: Prepared) -> str:
    """Liquid model of a scene's limit cycles: KdV-Burgers where it is named, else long waves."""
    return "kdv" if machine.scene.model.liquid == "kdv" else "long_wave"


def scene_cycles(machine: Prepared, friction: Friction) -> tuple[LimitCycles, tuple[Note, ...]]:
    """Limit cycles over the speeds of a scene, and what they leave out [theory: whirl, eq. 21-30].

    By KdV-Burgers where the scene names it [theory: kdv, eq. 34-40].
    """
    from solvers.cycles.cycles import limit_cycles
    from solvers.cycles.family import family_wave

    def told(count: int, speed: float) -> None:
        update(what=f"whirls of finite size: {count} found, at {in_rpm(speed)}")

    speeds, fills = machine.scene.speeds, machine.scene.fills
    # A single speed still needs a way to it.
    range_ = speeds.start, max(speeds.stop, speeds.start * (1.0 + _WAY))
    by_family = cycles_by(machine) == "kdv"
    if by_family:
        field = "model.friction" if friction == machine.scene.model.friction else "friction"
        refuse_quadratic(friction, field)
        found, *others = (
            limit_cycles(
                machine.rotor, fills, range_, friction, progress=told, wave=family_wave(share * FRONT)
            )
            for share in (1.0, *_TRIED)
        )
    else:
        found, others = limit_cycles(machine.rotor, fills, range_, friction, progress=told), []
    if not found.branches:
        text = f"No limit cycles: {found.reason}."
        return found, (Note(CycleCode.NO_CYCLES, {"reason": found.reason}, text),)
    said = []
    if found.reason:
        text = f"Limit cycles may be missing: {found.reason}."
        said.append(Note(CycleCode.CYCLES_MISSING, {"reason": found.reason}, text))
    if machine.scene.rotor.axis == "horizontal" and machine.scene.gravity > 0.0:
        text = (
            "Limit cycles are those without gravity across the axis, with which a whirl is no circle: ask "
            "for a time-domain state of `run` where the spin hardly outweighs it."
        )
        said.append(Note(CycleCode.NO_CIRCLE, {}, text))
    lag = max(float(np.nanmax(branch.lag / branch.speed[:, None])) for branch in found.branches)
    if lag > FAST_LAG:
        flow = "turns as a whole beneath its waves" if by_family else "has no vorticity"
        text = (
            f"Limit cycles in which the liquid lags by more than {percent(FAST_LAG)} of the spin (up to "
            f"{percent(lag)}) are the model's own: its flow {flow}."
        )
        said.append(Note(CycleCode.LAGGING, {"largest": lag, "limit": FAST_LAG}, text))
    deflection = max(float(np.abs(branch.deflection).max()) for branch in found.branches)
    share = deflection / max(fill.depth for fill in fills)
    if by_family:
        said += _of_family(found, others, range_)
    elif share > _DEEP:
        text = f"The largest limit cycle is {share:.2g} times the depth of the layer: walls fall nearly dry."
        said.append(Note(CycleCode.DEEP_WHIRL, {"largest": share}, text))
    return found, tuple(said)


def _of_family(found: LimitCycles, others: list[LimitCycles], range_: tuple[float, float]) -> list[Note]:
    """What limit cycles by KdV-Burgers leave out, and what they owe to its diffusion."""
    said, height = [], 1.0 - min(float(branch.thinnest.min()) for branch in found.branches)
    if height > _HIGH:
        text = (
            "KdV-Burgers is right to the first order of the wave's height over the layer's depth, which "
            f"comes to {height:.2g}; `map --cycles` with another model takes nonlinear long waves."
        )
        said.append(Note(CycleCode.HIGH_WAVE, {"largest": height, "limit": _HIGH}, text))
    speeds = np.linspace(*range_, _SPEEDS).tolist()
    sizes = np.array([[one.largest_stable(speed) for speed in speeds] for one in (found, *others)])
    both = (sizes > 0.0).all(axis=0)
    if both.any():
        change = float(np.abs(sizes[1:, both] - sizes[0, both]).max() / sizes[0].max())
        text = (
            "No law sets the diffusion of KdV-Burgers, which gives the fronts of waves their width, here "
            f"{FRONT:g} of the layer's depth. With half of it and half as much again the whirl changes by up "
            f"to {percent(change)} of the largest."
        )
        data = {"front": FRONT, "tried": _TRIED, "change": change}
        said.append(Note(CycleCode.DIFFUSION, data, text))
    return said


def large_whirl(machine: Prepared, growth: Array) -> tuple[LargeWhirl, tuple[Note, ...]]:
    """How large the self-excited whirl becomes at each speed of a machine, and what is to be said of it."""
    found, said = scene_cycles(machine, machine.scene.model.friction)
    largest = [_largest_stable(found, speed) for speed in machine.speed.tolist()]
    size = np.array([0.0 if whirl is None else whirl.amplitude for whirl in largest])
    turning = np.array([np.nan if whirl is None else whirl.whirl_speed for whirl in largest])
    lost = (size == 0.0) & ~(growth <= 0.0)
    large = LargeWhirl(
        branches=found.branches,
        wave=cycles_by(machine),
        amplitude=np.where(lost, np.nan, size),
        whirl_speed=turning,
        kicked=(size > 0.0) & (growth <= 0.0),
        reason=found.reason,
    )
    return large, said


def _largest_stable(found: LimitCycles, speed: float) -> HeldWhirl | None:
    whirls = [whirl for branch in found.branches for whirl in branch.at(speed) if whirl.stable]
    return max(whirls, key=lambda whirl: whirl.amplitude, default=None)
