"""The run-up of a scene step by step, as the FMU of `leblanc export` has it."""

from __future__ import annotations

import json
from enum import IntEnum
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.liquid.choose import across_gravity, ruled_out_linear
from leblanc.scene.scene import Scene, dry_rotor
from leblanc.studies.drives import drive_of, numerics_of, rotor_in_time
from leblanc.studies.loads.study import loaded_machine, spinning_inertia
from leblanc.studies.runup.study import chosen_run, liquid_model, model_of, require_runup
from solvers.layer.records import Outcome
from solvers.rotor.loads.machine import LoadedMachine
from solvers.runup.machine import Motor
from solvers.runup.runup import SteppedRunup

# Resources of the FMU: the machine file, and what else it is made from.
MACHINE, ABOUT = "machine.toml", "export.json"
OUTPUTS = {
    "speed": ("rad/s", "spin speed"),
    "x": ("m", "deflection of the first chamber's axis from its equilibrium, first direction in space"),
    "y": ("m", "the same, second direction: the spin turns the first one into it"),
    "liquid_x": (
        "kg.m",
        "mass of the liquid times its distance from its chamber's axis, sum of the chambers",
    ),
    "liquid_y": ("kg.m", "the same, second direction"),
    "bearing_force": (
        "N",
        "largest force in a bearing; without bearings, of the moving rotor on its supports",
    ),
    "floor_force": ("N", "force of the floor under all feet, upwards, weight included; 0 without a floor"),
}


class Drive(IntEnum):
    """What turns the rotor."""

    SCENE = 0
    SPEED = 1
    TORQUE = 2


class Refusal(ValueError):  # noqa: N818 - it says no
    """A step that cannot be done, in a sentence."""


def stepped_model(scene: Scene) -> str:
    """Liquid model of a scene's run-up, as `run_up` takes it."""
    if scene.model.liquid != "auto" or ruled_out_linear(scene):
        return liquid_model(scene)
    plan = require_runup(scene)
    numerics = numerics_of(plan, check=False)
    return chosen_run(scene, drive_of(plan, scene.rotor), across_gravity(scene), numerics, share=1.0).model


class Cosimulation:
    """A machine that is taken through time from outside; SI units."""

    def __init__(self, scene: Scene, model: str) -> None:
        """`model` of the liquid, linear or long_wave, as `stepped_model` finds it."""
        self.scene = scene.as_read()
        self._model, self.drive = model, Drive.SCENE
        plan = require_runup(self.scene)
        self._drive, self._numerics = drive_of(plan, self.scene.rotor), numerics_of(plan, check=False)
        self._loaded = loaded_machine(self.scene) or LoadedMachine(
            dry_rotor(self.scene),
            tuple(self.scene.fills),
            self.scene.gravity,
            self.scene.rotor.axis == "vertical",
        )
        self.start_speed = float(self._drive.corners()[1, 0])  #: rad/s
        self.duration = float(self._drive.corners()[0, -1])  #: of the scene's own way, s
        self.usual_step = self.duration / (self._numerics.samples - 1)  #: that of `run_up`, s
        self._begin(self.start_speed)

    @classmethod
    def from_resources(cls, folder: str | Path) -> Cosimulation:
        """The machine whose files stand in the resources of an FMU."""
        about = json.loads((Path(folder) / ABOUT).read_text(encoding="utf-8"))
        text = (Path(folder) / MACHINE).read_text(encoding="utf-8")
        return cls(Scene.from_toml(text, str(Path(folder) / MACHINE)), about["model"])

    @property
    def inertia(self) -> float:
        """Moment of inertia of drum and motor about the axis, kg m^2; 0 where the scene has none."""
        if isinstance(self._drive, Motor):
            return self._drive.inertia
        return getattr(self._drive, "inertia", None) or spinning_inertia(self.scene)

    def begin(self, drive: int, speed: float) -> None:
        """Begin anew; with `Drive.SPEED` at that speed, rad/s, otherwise at that of the scene."""
        if drive not in list(Drive):
            raise Refusal(f"drive must be 0, 1 or 2, not {drive}")
        self.drive = Drive(drive)
        if self.drive is Drive.TORQUE:
            if not self.inertia > 0.0:
                raise Refusal("drive 2 needs an inertia of the drum: rotor, [runup.motor] or [programme]")
            if self.scene.fills and self.scene.model.liquid == "auto":
                self._model = "long_wave"  # a motor feels the torque of the waves
        if self.drive is Drive.SPEED and not speed > 0.0:
            raise Refusal(f"speed_demand must be above 0 at the beginning, not {speed:g}")
        self._begin(speed if self.drive is Drive.SPEED else self.start_speed)

    def _begin(self, speed: float) -> None:
        system, scene = rotor_in_time(self.scene), self.scene
        given = scene.model.friction, across_gravity(scene), self._numerics, model_of(scene, self._model)
        self._run = SteppedRunup(system, scene.fills, self._drive, *given, start=speed)

    @property
    def time(self) -> float:
        """Time since the beginning, s."""
        return self._run.machine.time

    def step(self, step: float, speed: float, torque: float) -> None:
        """Go on by so many s; speed, rad/s, and torque, N m, count where they drive."""
        if not (step >= 0.0 and np.isfinite(step)):
            raise Refusal(f"a step must be 0 s or longer, not {step:g} s")
        if step == 0.0:
            return
        if self.drive is Drive.SPEED and not (speed >= 0.0 and np.isfinite(speed)):
            raise Refusal(f"speed_demand must be 0 or above, not {speed:g}")
        if self.drive is Drive.SCENE:
            outcome = self._run.on(step)
        elif self.drive is Drive.SPEED:
            outcome = self._run.to(step, speed)
        else:
            outcome = self._run.under(step, torque, self.inertia)
        if outcome is not Outcome.DONE:
            where = f"at {self.time:.6g} s, {self._run.machine.spin:.6g} rad/s"
            raise Refusal(f"{outcome.message or outcome.name.lower()} {where}")

    def outputs(self) -> dict[str, float]:
        """Values of `OUTPUTS` by their names."""
        run, loaded = self._run, self._loaded
        now, velocity = run.machine.read(), run.machine.velocity
        liquid = complex(np.sum(run.machine.masses * now.offset))
        loads = loaded.loads(now.coordinates, velocity, run.acceleration, np.asarray(now.angle))
        bearing = float(np.linalg.norm(loaded.holding(now.coordinates, velocity).sum(axis=0)))
        if loads.bearing.size:
            bearing = float(loads.bearing.max())
        first = complex(now.deflection[0])
        return {
            "speed": float(now.speed),
            "x": first.real,
            "y": first.imag,
            "liquid_x": liquid.real,
            "liquid_y": liquid.imag,
            "bearing_force": bearing,
            "floor_force": 0.0 if loads.floor is None else float(loads.floor.vertical.sum()),
        }


def resources(scene: Scene, model: str) -> dict[str, str]:
    """Files from which `Cosimulation.from_resources` makes the machine, by name."""
    about: dict[str, Any] = {"name": scene.name, "digest": scene.digest, "model": model}
    return {MACHINE: scene.text, ABOUT: json.dumps(about, indent=1)}
