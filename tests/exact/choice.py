"""What `--model auto` answers to whirls by chance, beside the exact wave that was followed from rest."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from leblanc.liquid.whirling import AutoWave, choose_wave
from meshes.arrays import Array
from solvers.liquid_model import Whirl
from tests.exact.answers import layer_fill
from validation.exact import Cases, whirl_speeds

# Kept waves have a spectrum that falls to a millionth: no smaller error is told from theirs.
RESOLVED = 1e-6


@dataclass(frozen=True)
class Chosen:
    """The models that auto took for some whirls; all shapes (n,)."""

    model: NDArray[np.str_]  #: its name
    told: Array  #: its own estimate of its error; nan of long waves, which were not asked
    #: distance of its G from the exact one over the larger of |G| and 1; nan where one is missing
    error: Array

    @property
    def covered(self) -> float:
        """Share of the known errors that are within what is told."""
        known = np.isfinite(self.error)
        return float(np.mean(self.error[known] <= np.maximum(self.told[known], RESOLVED)))


def choices(cases: Cases, tolerance: float) -> Chosen:
    """What auto takes and answers; long waves are not asked where they are left, which takes seconds each.

    Of the two whirl speeds of a detuning every other case has the one behind the drum, the others its twin.
    """
    places = zip(cases.layer.tolist(), cases.ratio.tolist(), cases.whirl.tolist(), strict=True)
    found = [_choice(*place, tolerance, k % 2) for k, place in enumerate(places)]
    names, told, force = zip(*found, strict=True)
    error = np.abs(np.array(force) - cases.exact) / np.maximum(1.0, np.abs(cases.exact))
    return Chosen(np.array(names), np.array(told), error)


def _choice(layer: float, ratio: float, size: float, tolerance: float, twin: int) -> tuple[str, float, float]:
    """Model, its estimate and its G."""
    fill, whirl = layer_fill(layer), Whirl(1.0, whirl_speeds(layer, ratio)[twin], size * layer)
    choice = choose_wave(AutoWave(tolerance=tolerance), fill, whirl)
    if choice.wave is None:
        return choice.model.name, np.nan, np.nan
    answer = choice.wave.answer
    force = float(answer.unbalance[0].real) / (fill.full_mass * whirl.amplitude)
    return choice.model.name, float(answer.error[0]), force


def words(cases: Cases, tolerance: float, found: Chosen) -> str:
    """Row of a table: shares of the models among smooth waves, coverage, the others."""
    smooth = cases.smooth
    names = ("linear", "kdv", "potential", "long_wave")
    shares = [f"{np.mean(found.model[smooth] == name):.1%}" for name in names]
    beyond = f"{np.mean(found.model[~smooth] == 'long_wave'):.0%}"
    cells = [f"{tolerance:g}", *shares, f"{found.covered:.1%}", f"{np.nanmax(found.error):.2g}", beyond]
    return f"| {' | '.join(cells)} |"
