"""A scene's run-up: rotor and liquid taken through the speeds in time, and where the models hold."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from meshes.border import InputError
from solvers.drive import Drive, Motor, Ramp
from solvers.response import Response, synchronous_response
from solvers.runup import RunupHistory, RunupNumerics
from study.fidelity import across_gravity as across_gravity  # of a run-up, asked for with it
from study.fidelity import axial_gravity
from study.friction import Friction
from study.machine import dry_rotor, jeffcott, require_clear
from study.record import Array, ChamberRecord, phase
from study.runup_choice import chosen_run
from study.runup_range import judged
from study.runup_words import Bands, describe_inputs, describe_run
from study.scene import Rotor, Runup, Scene
from study.stability import solver_friction

Flags = NDArray[np.bool_]
Complex = NDArray[np.complex128]

STEADY_SPEEDS = 401  # of the steady response drawn behind the run-up
BAND_SPEEDS = 201  # at which self-excited whirl is looked for
_FEWEST = 8  # samples in a mean over turns


@dataclass(frozen=True)
class RunupRecord:
    """A run-up of a scene; k times, l chambers.

    Parameters
    ----------
    name, source, assumed, digest : of the scene
    inputs : label, value with its unit, field path
    kind, axis : of the rotor; "horizontal" or "vertical"
    friction : law and coefficient
    gravity : across the axis, m/s^2
    model : of the liquid, "long_wave" or "linear"
    numerics : resolution
    history : of rotor and liquid
    turning : index of the last time before the speed falls again; the last one of all if it never does
    in_range : the layer is a fair picture of the liquid at that time, shape (k,)
    steady : synchronous response at the speeds passed, of a Jeffcott rotor; None for others
    bands : of speed in which some whirl grows by itself, rad/s, an end of the range counting as an edge
    chambers, planes : one for each chamber; its position along the axis, m
    notes : limits of validity and findings, in words
    model_reason : why that liquid model, in words
    model_error : estimated error of the amplitude over its largest, by the model and by its steps; nan where
        one of them is not known
    """

    name: str
    source: str
    assumed: tuple[str, ...]
    digest: str
    inputs: tuple[tuple[str, str, str], ...]
    kind: str
    axis: str
    friction: Friction
    gravity: float
    model: str
    numerics: RunupNumerics
    history: RunupHistory
    turning: int
    in_range: Flags
    steady: Response | None
    bands: Bands
    chambers: tuple[ChamberRecord, ...]
    planes: tuple[float, ...]
    notes: tuple[str, ...]
    model_reason: str = ""
    model_error: float = math.nan

    @property
    def deflection(self) -> Complex:
        """Of the first chamber's axis, in the drum frame, m, shape (k,)."""
        return np.asarray(self.history.deflection[:, 0] * np.exp(-1j * self.history.angle))

    @property
    def phase(self) -> Array:
        """Angle of that deflection from the drum's zero mark, where a Jeffcott rotor has its unbalance."""
        return phase(self.deflection)

    @property
    def mean_position(self) -> Complex:
        """Liquid's centre of mass in the drum frame as a mean over whole turns, m, shape (k,)."""
        return turn_mean(self.history.liquid_position, self.history.angle)

    def peak(self, back: bool = False) -> int:
        """Index of the largest amplitude on the way up, or on the way back."""
        amplitude = self.history.amplitude
        if back and self.turning + 1 < amplitude.size:
            return self.turning + 1 + int(np.argmax(amplitude[self.turning + 1 :]))
        return int(np.argmax(amplitude[: self.turning + 1]))


def runup_scene(
    scene: Scene,
    cells: int | None = None,
    samples: int | None = None,
    check: bool = True,
    progress: Callable[[float], None] | None = None,
) -> RunupRecord:
    """Run the machine of a scene through its speeds [theory: coupling].

    Parameters
    ----------
    scene : with a table `runup`
    cells, samples : in place of the scene's
    check : run once more with half the cells to estimate the error
    progress : called with the share of the work that is done

    Returns
    -------
    RunupRecord; with what was reached if the run did not come to its end

    Raises
    ------
    InputError : no run-up in the scene, a rotor without linear equations of motion, a value out of its range
    """
    require_clear(scene, "a run-up, whose waves run in a clear ring; model.friction may stand for baffles")
    plan = planned(scene)
    numerics = numerics_of(plan, cells, samples, check)
    law, gravity = scene.model.friction, across_gravity(scene)
    taken = chosen_run(scene, drive_of(plan), gravity, numerics, progress)
    history = taken.history
    steady, bands = steady_response(scene, history.speed), whirl_bands(scene, history.speed)
    in_range, faults = judged(scene, history, taken.model)
    fastest = np.flatnonzero(history.speed == history.speed.max())
    return RunupRecord(
        name=scene.name,
        source=scene.source,
        assumed=scene.assumed,
        digest=scene.digest,
        inputs=describe_inputs(scene, plan, numerics),
        kind=scene.rotor.kind,
        axis=scene.rotor.axis,
        friction=law,
        gravity=gravity,
        model=taken.model,
        model_reason=taken.reason,
        model_error=taken.error,
        numerics=numerics,
        history=history,
        turning=int(fastest[-1]) if plan.back else history.time.size - 1,
        in_range=in_range,
        steady=steady,
        bands=bands,
        chambers=tuple(_chamber(fill) for fill in scene.chambers),
        planes=tuple(fill.chamber.plane for fill in scene.chambers),
        notes=(f"Liquid model: {taken.reason}", *describe_run(scene, history, steady, bands), *faults),
    )


def planned(scene: Scene) -> Runup:
    """The run-up that a scene asks for.

    Raises
    ------
    InputError : it asks for none
    """
    if scene.runup is None:
        allowed = (
            "a table [runup] in the scene with start, stop, duration, and rate or motor; "
            "what `leblanc new` writes has one, commented out"
        )
        raise InputError("runup", "missing", allowed)
    return scene.runup


def drive_of(plan: Runup) -> Drive:
    """Ramp or motor of a run-up."""
    if plan.motor is not None:
        motor = plan.motor
        return Motor(plan.start, motor.inertia, motor.speeds, motor.torques, plan.duration)
    if plan.rate is None:
        raise InputError("runup.rate", None, "given where there is no motor")
    return Ramp(plan.start, plan.stop, plan.rate, plan.duration, plan.back)


def numerics_of(
    plan: Runup, cells: int | None = None, samples: int | None = None, check: bool = True
) -> RunupNumerics:
    """Resolution of a run-up, of the scene where nothing else is asked for."""
    return RunupNumerics(
        cells=plan.cells if cells is None else cells,
        samples=plan.samples if samples is None else samples,
        dispersion=plan.dispersion,
        companion=check,
    )


def steady_response(scene: Scene, speed: Array) -> Response | None:
    """Synchronous response over the speeds that were passed; None unless the rotor is a Jeffcott rotor."""
    passed = _passed(speed, STEADY_SPEEDS)
    if not isinstance(scene.rotor, Rotor) or passed.size == 0:
        return None
    return synchronous_response(jeffcott(scene), scene.chambers, passed, axial_gravity(scene))


def whirl_bands(scene: Scene, speed: Array) -> Bands:
    """Bands of the speeds that were passed in which some whirl grows by itself, rad/s."""
    from solvers.whirl_edges import unstable_bands

    passed = _passed(speed, BAND_SPEEDS)
    if not scene.chambers or passed.size == 0:
        return ()
    system, friction = dry_rotor(scene).system(), solver_friction(scene.model.friction)
    return unstable_bands(system, [scene.chambers], passed, friction)[0]


def _passed(speed: Array, count: int) -> Array:
    """Speeds evenly over those of a run with the spin, which a motor may have turned round; none if still."""
    low, high = max(float(speed.min()), 1e-3 * float(speed.max())), float(speed.max())
    return np.linspace(low, high, count) if 0.0 < low < high else np.empty(0)


def turn_mean(values: Complex, angle: Array) -> Complex:
    """Mean over the turns of the rotor around each time: what stands still in space drops out of it.

    The mean is taken over one turn, or over as many whole turns as hold eight samples.

    Parameters
    ----------
    values : in the drum frame, shape (k,)
    angle : of rotation, rising, rad, shape (k,)

    Returns
    -------
    Means, shape (k,); near the ends over the turns that there are
    """
    if angle.size < 3:
        return values.copy()
    steps = np.diff(angle)
    total = np.concatenate(([0.0], np.cumsum(0.5 * (values[1:] + values[:-1]) * steps)))
    half = math.pi * np.maximum(1.0, np.ceil(_FEWEST * np.gradient(angle) / (2.0 * math.pi)))
    half = np.minimum(half, 0.5 * (angle[-1] - angle[0]))
    middle = np.clip(angle, angle[0] + half, angle[-1] - half)

    def until(edge: Array) -> Complex:
        return np.asarray(np.interp(edge, angle, total.real) + 1j * np.interp(edge, angle, total.imag))

    return np.asarray((until(middle + half) - until(middle - half)) / (2.0 * half))


def _chamber(fill: Fill) -> ChamberRecord:
    one, name = fill.chamber, fill.liquid.name
    return ChamberRecord(one.radius, one.inner_radius, one.height, fill.volume, name, fill.surface_radius)
