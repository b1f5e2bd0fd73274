"""Run-ups in time of a machine with any volumes: the largest amplitude and the worst loads of each."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from leblanc.scene.scene import Scene
from leblanc.studies.models.liquid import runup_model
from leblanc.studies.optimise.answers import with_volumes
from meshes.arrays import Array


@dataclass(frozen=True)
class WorstLoads:
    """The worst loads of a machine over a range of speeds, or over a run-up."""

    floor_force: float  #: largest under a foot, N; nan without a cabinet
    walking: float  #: least margins against walking and slipping; nan without a cabinet
    slip: float
    clearance: Array  #: least of each point, m, nan without a gap, shape (p,)
    motor_torque: float  #: largest of the drive, N m


@dataclass(frozen=True)
class Passage:
    """What a run-up is judged by."""

    amplitude: float  #: largest, m; infinite for a run that did not come to its end
    loads: WorstLoads | None  #: None where nobody asks, or the run did not come to its end


class Passages:
    """The run-ups of a scene; no volumes are run twice."""

    def __init__(self, scene: Scene, cells: int | None = None, loaded: bool = False) -> None:
        from leblanc.studies.drives import drive_of, numerics_of, planned
        from leblanc.studies.models.choose import across_gravity
        from leblanc.studies.runup.study import liquid_model

        plan = planned(scene)
        self.scene, self.drive, self.gravity = scene, drive_of(plan, scene.rotor), across_gravity(scene)
        self.numerics = numerics_of(plan, cells, check=False)
        self.model, self.loaded = runup_model(liquid_model(scene)), loaded
        self._known: dict[bytes, Passage] = {}

    def of(self, volumes: Array) -> list[Passage]:
        """The run-ups with m sets of volumes."""
        rows = np.ascontiguousarray(volumes)
        for row in rows:
            if row.tobytes() not in self._known:
                self._known[row.tobytes()] = self._one(row)
        return [self._known[row.tobytes()] for row in rows]

    def _one(self, volumes: Array) -> Passage:
        from leblanc.studies.drives import rotor_in_time
        from leblanc.studies.loads.study import loaded_machine, loads_over_time
        from solvers.runup.runup import run_up

        filled = with_volumes(self.scene, volumes)
        given = filled.fills, self.drive, self.scene.model.friction, self.gravity, self.numerics, None
        run = run_up(rotor_in_time(self.scene), *given, self.model, follow=self.loaded)
        if not run.converged:
            return Passage(math.inf, None)
        machine = loaded_machine(filled) if self.loaded else None
        found = None if machine is None else loads_over_time(filled, machine, run)
        if found is None:
            return Passage(float(run.largest.max()), None)
        worst = found.worst
        loads = WorstLoads(
            floor_force=float(np.fmax.reduce(worst.floor_force, axis=None)) if found.stands else math.nan,
            walking=float(np.fmin.reduce(worst.walking)),
            slip=float(np.fmin.reduce(worst.slip)),
            clearance=np.asarray(worst.clearance.min(axis=0)),
            motor_torque=float(found.torque.max()),
        )
        return Passage(float(run.largest.max()), loads)
