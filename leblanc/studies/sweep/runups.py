"""Outputs of `runup` of many scenes: each one's way in time, kept over bands of the spin speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from leblanc.liquid.choose import across_gravity
from leblanc.scene.scene import Scene
from leblanc.studies.drives import drive_of, numerics_of
from leblanc.studies.loads.study import loaded_machine, loads_over_time
from leblanc.studies.runup.answer import run_faults
from leblanc.studies.runup.study import chamber_of, chosen_run, dry_run, judged, require_runup
from leblanc.studies.sweep.outputs import LEVELS, RunupAnswers, together, worst_of
from meshes.arrays import Array, Index
from solvers.layer.records import Outcome
from solvers.runup.machine import Drive
from solvers.runup.runup import RunupHistory
from solvers.runup.samples import highest

_SHORT = 0.01  # of the way: nearer to the highest speed than this counts as there


def answer_runups(scenes: Sequence[Scene], check: bool) -> RunupAnswers:
    """Outputs of `runup` of several scenes, of each one as alone; `check` as there."""
    return together([_one(scene, check) for scene in scenes])


def _one(scene: Scene, check: bool) -> RunupAnswers:
    """Outputs of one scene."""
    scene = scene.as_read()
    plan = require_runup(scene)
    drive, gravity = drive_of(plan, scene.rotor), across_gravity(scene)
    numerics = numerics_of(plan, check=check)
    machine = loaded_machine(scene)
    taken = chosen_run(scene, drive, gravity, numerics, follow=machine is not None)
    run = taken.history
    dry = dry_run(scene, run, drive, gravity, numerics, taken.model)
    if dry is None or Outcome.INTERRUPTED in (run.outcome, dry.outcome):
        raise KeyboardInterrupt
    edges = np.linspace(*spin_range(scene, drive), LEVELS + 1)
    amplitude, time = over_bands(run, edges)
    top, most = float(run.speed.max()), int(np.argmax(run.largest))
    nearly = top - _SHORT * (top - float(run.speed[0]))
    reason = "; ".join((*filter(None, [run.reason]), *run_faults(run, [chamber_of(f) for f in scene.fills])))
    limited = 0.0 if run.limited is None else float(np.diff(run.time) @ run.limited[1:])
    single: dict[str, Any] = {
        "peak_amplitude": run.largest[most],
        "peak_amplitude_dry": dry.largest.max(),
        "peak_speed": run.largest_speed[most],
        "peak_time": run.largest_time[most],
        "last_amplitude": run.amplitude[-1],
        "last_amplitude_dry": dry.amplitude[-1],
        "last_speed": run.speed[-1],
        "top_speed": top,
        "top_time": run.time[np.argmax(run.speed >= nearly)],
        "duration": run.time[-1],
        "motor_work": run.audit.motor,
        "limited_time": limited,
        "in_range": judged(scene, run, taken.model)[0].all(),
        "converged": not reason,
        "model": taken.model if scene.chambers else "none",
        "error_estimate": taken.error,
        "reasons": reason,
    }
    loads = None if machine is None else loads_over_time(scene, machine, run)
    return RunupAnswers(
        speed=0.5 * (edges[:-1] + edges[1:])[None],
        amplitude=amplitude[None],
        amplitude_dry=over_bands(dry, edges)[0][None],
        time=time[None],
        **{name: np.array([value]) for name, value in single.items()},
        **worst_of(loads),
    )


def spin_range(scene: Scene, drive: Drive) -> tuple[float, float]:
    """Least and largest spin speed that a scene's way asks for, rad/s."""
    asked = highest(drive) if scene.runup is None else scene.runup.stop
    return float(drive.corners()[1].min()), asked


def over_bands(run: RunupHistory, edges: Array) -> tuple[Array, Array]:
    """Largest amplitude while the spin is in each band, and the time at which it first is.

    Bands between ascending edges, the outer two open; the largest amplitude between two records counts where
    it was, bands passed between them have the larger of both. nan where the spin did not come.
    """
    count = edges.size - 1

    def band(speed: Array) -> Index:
        return np.clip(np.searchsorted(edges, speed, side="right") - 1, 0, count - 1)

    own = band(run.speed)
    largest, time = np.full(count, -np.inf), np.full(count, np.inf)
    np.maximum.at(largest, own, run.amplitude)
    np.maximum.at(largest, band(run.largest_speed), run.largest)
    np.minimum.at(time, own, run.time)
    low, high = np.minimum(own[:-1], own[1:]), np.maximum(own[:-1], own[1:])
    for step in range(1, int(np.max(high - low, initial=0))):
        rows = np.flatnonzero(low + step < high)
        np.maximum.at(largest, low[rows] + step, np.maximum(run.amplitude[rows], run.amplitude[rows + 1]))
        np.minimum.at(time, low[rows] + step, run.time[rows + 1])
    return np.where(np.isinf(largest), np.nan, largest), np.where(np.isinf(time), np.nan, time)
