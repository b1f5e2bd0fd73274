"""A run-up in words: what was asked, what happened."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from fluid.friction import Friction
from leblanc.friction import friction_words
from leblanc.results.response import peak
from leblanc.units import MM, RPM

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene
    from solvers.runup.runup import RunupHistory, RunupNumerics
    from solvers.synchronous.response import Response

Bands = tuple[tuple[float, float], ...]

CLOSURE = 1e-3  # of the work: what the energy balance may leave
ERROR = 0.02  # of the largest amplitude: an error estimate to speak of


def model_words(model: str, numerics: RunupNumerics) -> str:
    """Liquid model of a run-up with its resolution."""
    if model == "linear":
        return f"exact linear theory in time, steps as of {numerics.cells} cells"
    shallow = "with dispersion" if numerics.dispersion else "without dispersion"
    return f"annular long waves in time, {numerics.cells} cells, {shallow}"


def describe_run(
    scene: Scene, history: RunupHistory, steady: Response | None, bands: Bands
) -> tuple[str, ...]:
    """What happened and how far it can be trusted, one sentence each."""
    notes = [] if history.converged else [f"The run stopped: {history.reason}."]
    return (
        *notes,
        *_numbers(history),
        *_peaks(history, steady),
        *_captures(history),
        *_bands(bands, scene.model.friction),
    )


def _numbers(history: RunupHistory) -> list[str]:
    """Error estimate and energy balance."""
    notes = []
    error, closure = history.error_estimate, history.audit.closure
    if math.isnan(error):
        notes.append("The error of the amplitude was not estimated.")
    elif error > ERROR:
        notes.append(
            f"With half the cells the amplitude differs by up to {error:.1%} of its largest: "
            "more cells would sharpen it."
        )
    if closure > CLOSURE:
        notes.append(f"The energy balance leaves {closure:.1%} of the work unaccounted for.")
    return notes


def _peaks(history: RunupHistory, steady: Response | None) -> list[str]:
    """The largest amplitude beside that of a run-up without end."""
    k = int(np.argmax(history.amplitude))
    text = f"Largest amplitude {history.amplitude[k] * MM:.4g} mm at {history.speed[k] * RPM:.4g} rpm"
    highest = None if steady is None else peak(steady.deflection)
    if steady is None or highest is None:
        return [f"{text}."]
    size, speed = abs(steady.deflection[highest]) * MM, steady.speed[highest] * RPM
    return [f"{text}; in the steady response it is {size:.4g} mm at {speed:.4g} rpm."]


def switches(history: RunupHistory) -> list[tuple[int, int, bool]]:
    """Samples at which a layer is captured or let go: index of the sample, chamber, captured."""
    state: NDArray[np.int8] = history.captured.astype(np.int8)
    row, column = np.nonzero(np.diff(state, axis=0))
    return [
        (int(k) + 1, int(j), bool(state[k + 1, j]))
        for k, j in zip(row.tolist(), column.tolist(), strict=True)
    ]


def _captures(history: RunupHistory) -> list[str]:
    """When liquid began and ceased to ride with the drum."""
    return [
        f"Chamber {j + 1}: its liquid {'is captured' if caught else 'falls back'} at "
        f"{history.time[k]:.4g} s, {history.speed[k] * RPM:.4g} rpm."
        for k, j, caught in switches(history)
    ]


def _bands(bands: Bands, friction: Friction) -> list[str]:
    """Speeds at which whirl grows by itself."""
    if not bands:
        return []
    listed = ", ".join(f"{low * RPM:.4g} to {high * RPM:.4g} rpm" for low, high in bands)
    law = friction_words(friction)
    return [f"By linear theory with liquid friction {law}, some whirl grows by itself at {listed}."]
