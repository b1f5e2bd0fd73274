"""Which liquid model a run-up takes: linear layers if they say themselves that they are good enough."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from solvers.drive import Drive
from solvers.runup import MODELS, RunupHistory, RunupNumerics, run_up
from solvers.runup_error import MOST_LAG, MOST_WAVE, LinearRunError, largest_wave, linear_run_error
from study.fidelity_words import percent
from study.machine import dry_rotor
from study.runup_range import liquid_model
from study.scene import Scene

Progress = Callable[[float], None] | None


@dataclass(frozen=True)
class RunupChoice:
    """A run-up and the liquid model it took.

    Parameters
    ----------
    history : of rotor and liquid
    model : "long_wave" or "linear"
    error : estimated error of the amplitude over its largest, by the model and by its steps; nan where one of
        them is not known
    reason : why that model, in words
    """

    history: RunupHistory
    model: str
    error: float
    reason: str


def chosen_run(
    scene: Scene, drive: Drive, gravity: float, numerics: RunupNumerics, progress: Progress = None
) -> RunupChoice:
    """Run a scene up with the cheapest liquid model whose estimated error is within its tolerance.

    Linear layers take a twentieth of the time of long waves and are tried first. What they cannot have rules
    them out before: a motor that feels the wave, friction that small waves do not feel, and a tolerance that
    not even the smallest waves are known to meet.

    Parameters
    ----------
    scene : the machine
    drive, gravity, numerics, progress : as in `solvers.runup.run_up`

    Raises
    ------
    InputError : the scene asks for a model that does not go through time
    """
    model, tolerance = liquid_model(scene), scene.model.tolerance
    system, law = dry_rotor(scene).system(), scene.model.friction
    friction = (law.law, law.coefficient)

    def run(name: str, resolved: RunupNumerics, told: Progress) -> RunupHistory:
        return run_up(system, scene.chambers, drive, friction, gravity, resolved, told, name)

    if scene.model.liquid == "long_wave":
        history = run(model, numerics, progress)
        return RunupChoice(history, model, history.error_estimate, "the scene asks for long waves.")
    if scene.model.liquid == "linear":
        history = run(model, numerics, progress)
        found = linear_run_error(history, scene.chambers)
        reason = f"the scene asks for linear layers; {_words(found)}."
        return RunupChoice(history, model, found.estimate + history.error_estimate, reason)
    ruled_out = _ruled_out(scene)
    if not ruled_out:
        first = run("linear", replace(numerics, companion=False), None)
        found = linear_run_error(first, scene.chambers)
        if found.estimate <= tolerance:
            history = run("linear", numerics, progress) if numerics.companion else first
            error = found.estimate + (0.0 if math.isnan(history.error_estimate) else history.error_estimate)
            reason = f"linear layers, as {_words(found)}, within the tolerance of {percent(tolerance)}."
            return RunupChoice(history, "linear", error, reason)
        ruled_out = f"with linear layers {_words(found)}, and the tolerance is {percent(tolerance)}"
    history = run(model, numerics, progress)
    return RunupChoice(history, model, history.error_estimate, f"long waves: {ruled_out}.")


def runup_outlook(scene: Scene) -> str:
    """Which liquid model the run-up of a scene will take, as far as that is known before, in words."""
    asked, tolerance = scene.model.liquid, scene.model.tolerance
    if scene.runup is None:
        return ""
    if asked not in ("auto", *MODELS):
        return f"none: {asked} does not go through time; ask for auto, long_wave or linear"
    if asked != "auto":
        return f"{asked}, as the scene asks"
    ruled_out, wave = _ruled_out(scene), largest_wave(tolerance)
    if ruled_out:
        return f"long waves: {ruled_out}"
    return (
        f"linear layers first, for a twentieth of the time of long waves; they stay if the surface rises by \
less than {percent(wave)} of the depth and the liquid hardly lags, otherwise long waves follow"
    )


def _ruled_out(scene: Scene) -> str:
    """Why linear layers are not tried, or nothing."""
    if scene.runup is not None and scene.runup.motor is not None:
        return "a motor feels the torque of the waves, which linear layers leave out"
    if scene.model.friction.law == "quadratic":
        return "linear layers do not feel quadratic friction"
    if largest_wave(scene.model.tolerance) == 0.0:
        return f"linear layers are not known to be within {percent(scene.model.tolerance)}"
    return ""


def _words(found: LinearRunError) -> str:
    """What a linear run says of itself."""
    size = (
        f"waves reach {percent(found.wave)} of the depth and the liquid lags by up to {percent(found.lag)} \
of the spin"
    )
    if found.touches:
        return f"{size}, and a surface touches an inner wall, beyond any estimate"
    if math.isfinite(found.estimate):
        return f"{size}, an estimated error of {percent(found.estimate)} against long waves"
    return (
        f"{size}, beyond the {percent(MOST_WAVE)} and {percent(MOST_LAG)} up to which an error is estimated"
    )
