"""Which model of the liquid answers one prescribed whirl: the cheapest that is within a tolerance.

Asked is by rising cost. A model is taken where its own estimate of its error is within the tolerance and the
numbers that bound it alone are in their ranges; what bounds all models alike speaks for none of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import TypeVar

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from leblanc.core.notes import Note, percent
from leblanc.liquid.models import WAVE_MODELS, wave_model
from leblanc.liquid.notes import no_exact_wave
from leblanc.liquid.validity import judge
from meshes.errors import InputError
from solvers.liquid_model import LONG, SMOOTH, LiquidWave, WaveModel, Whirl, smooth_whirl
from solvers.potential.model import Potential
from solvers.pypde.models import LongWave, OneFamily, Progress
from solvers.synchronous.models import LINEAR, STATICS
from solvers.wave_error import long_wave_error

AUTO = "auto"
LAYER_MODELS = (AUTO, *WAVE_MODELS)
TOLERANCE = 0.01  # of the force, relative; a layer alone is rarely wanted as well as a machine
_SHARED = ("centrifuge", "wall_layer")  # numbers that bound all models that go with the whirl
_WORDS = {
    "linear": "linear theory",
    "kdv": "unidirectional waves",
    "potential": "the fully nonlinear wave",
    "fem": "finite elements",
}


@dataclass(frozen=True)
class AutoWave:
    """Stands for the model of a layer until its whirl is known."""

    friction: Friction = NO_FRICTION  #: on the wall
    cells: int | None = None  #: of the model that is taken, as `wave_model` has them
    dispersion: bool = False  #: for long waves, whether or not they need it
    tolerance: float = TOLERANCE  #: error of the force that is allowed, relative

    def __post_init__(self) -> None:
        if not 1e-12 <= self.tolerance <= 1.0:
            raise InputError("tolerance", self.tolerance, "from 1e-12 to 1")


@dataclass(frozen=True)
class WaveChoice:
    """The model that answers."""

    model: WaveModel  #: of the liquid
    reason: str = ""  #: why, in words; empty where it was asked for
    wave: LiquidWave | None = None  #: its answer, where it was asked to see whether it serves
    notes: tuple[Note, ...] = ()  #: what the answer has to say of the choice


Model = TypeVar("Model", bound=WaveModel)


def watched(model: Model, progress: Progress) -> Model:
    """The model, with someone to tell how far it has come, if it goes through time."""
    if progress is not None and isinstance(model, LongWave | OneFamily | Potential):
        return replace(model, progress=progress)
    return model


def choose_wave(asked: AutoWave, fill: Fill, whirl: Whirl) -> WaveChoice:
    """The cheapest model whose own error estimate for a steady whirl is within the tolerance.

    Long waves are not asked: they are what is left where friction or gravity acts, whose errors no estimate
    has, and where the fully nonlinear wave has no smooth answer.
    """
    if whirl.gravity != 0.0:
        return _long(asked, fill, whirl, "gravity across the axis acts, whose waves they alone have")
    if fill.chamber.baffles is not None:
        return _with_baffles(asked, fill, whirl)
    if whirl.slip == 0.0:
        return _at_rest(asked, fill, whirl)
    if asked.friction.law is not FrictionLaw.NONE:
        return _long(asked, fill, whirl, "friction acts, which is in no estimate but in their equations")
    against: list[str] = []
    share = smooth_whirl(fill, whirl)["smooth_whirl"]
    for model in _smooth(asked):
        if model.name == "potential" and share > SMOOTH[1]:
            # To look for it all the same takes up to a minute.
            why = (
                f"they have hydraulic jumps, and the whirl is {share:.2g} times the largest that a "
                "smooth wave follows"
            )
            return _long(asked, fill, whirl, why, smooth=False)
        wave = model.wave(fill, whirl)
        refused = _refused(model.name, wave, asked.tolerance)
        if not refused:
            return WaveChoice(model, _taken(wave, asked.tolerance, against), wave)
        against.append(refused)
    if wave.answer.converged[0]:
        return _long(asked, fill, whirl, against[-1])
    found = _long(asked, fill, whirl, f"they have hydraulic jumps, and {against[-1]}", smooth=False)
    return replace(found, notes=(no_exact_wave(wave.reason),))


def _smooth(asked: AutoWave) -> Iterator[WaveModel]:
    """Models of smooth waves without friction, by rising cost."""
    yield LINEAR
    yield wave_model("kdv", cells=asked.cells, dispersion=asked.dispersion)
    yield wave_model("potential", cells=asked.cells)


def _at_rest(asked: AutoWave, fill: Fill, whirl: Whirl) -> WaveChoice:
    """The liquid is at rest in the drum, and feels no friction."""
    wave = LINEAR.wave(fill, whirl)
    refused = _refused("linear", wave, asked.tolerance)
    if not refused:
        return WaveChoice(LINEAR, f"the whirl goes with the drum; {_taken(wave, asked.tolerance, [])}", wave)
    return WaveChoice(STATICS, f"the whirl goes with the drum: the exact equilibrium at any size; {refused}")


def _with_baffles(asked: AutoWave, fill: Fill, whirl: Whirl) -> WaveChoice:
    """Baffles stand in the liquid: small waves by finite elements, others and friction by long ones."""
    if asked.friction.law is FrictionLaw.NONE:
        fem = wave_model("fem", cells=asked.cells)
        wave = fem.wave(fill, whirl)
        if not (refused := _out_of_range(wave)):
            reason = "baffles stand in the liquid, and its waves are small; of the error there is no estimate"
            return WaveChoice(fem, reason, wave)
        why = f"baffles stand in the liquid, and the model of small waves {refused}"
        return _long(asked, fill, whirl, why)
    return _long(asked, fill, whirl, "baffles stand in the liquid and friction acts: they alone know both")


def choose_in_time(asked: AutoWave, fill: Fill, whirl: Whirl) -> WaveChoice:
    """The model that takes a layer from rest through time, by what it has to know: no estimate is of that."""
    plain = asked.friction.law is FrictionLaw.NONE and whirl.gravity == 0.0 and fill.chamber.baffles is None
    if plain and fill.depth > LONG[1] * fill.chamber.radius:
        model = wave_model("potential", cells=asked.cells)
        why = f"the layer is deeper than {LONG[1]:g} of the radius, where waves are not long"
    else:
        model = wave_model("long_wave", asked.friction, asked.cells, asked.dispersion)
        why = "long waves go through time with friction, gravity and hydraulic jumps"
    return WaveChoice(model, f"{why}; of the error in time there is no estimate")


def choose_free(asked: AutoWave) -> WaveChoice:
    """The model of natural sloshing waves: the exact one, of which alone the speed goes with the height."""
    why = "the speed of a natural sloshing wave goes with its height, which linear theory does not have"
    return WaveChoice(wave_model("potential", asked.friction, asked.cells), why)


def _long(asked: AutoWave, fill: Fill, whirl: Whirl, why: str, smooth: bool = True) -> WaveChoice:
    """Long waves, with dispersion where that is asked for or brings their estimate within the tolerance."""
    layer, size = fill.depth / fill.chamber.radius, whirl.amplitude / fill.depth
    plain, dispersed = (float(long_wave_error(layer, whirl.detuning, size, way)) for way in (False, True))
    clear = smooth and whirl.gravity == 0.0 and fill.chamber.baffles is None
    deep = clear and not plain <= asked.tolerance and dispersed <= asked.tolerance
    model = wave_model("long_wave", asked.friction, asked.cells, asked.dispersion or deep)
    return WaveChoice(model, f"long waves{', with dispersion for their depth' if deep else ''}: {why}")


def _taken(wave: LiquidWave, tolerance: float, against: list[str]) -> str:
    """Why a model is taken."""
    within = f"its estimated error is {percent(float(wave.answer.error[0]))}, within {percent(tolerance)}"
    return "; ".join([within, *against])


def _refused(name: str, wave: LiquidWave, tolerance: float) -> str:
    """Why a model is not taken; empty if it is."""
    error, out = float(wave.answer.error[0]), _out_of_range(wave)
    if not wave.answer.converged[0]:
        return f"{_WORDS[name]} has no answer{f': {wave.reason}' if wave.reason else ''}"
    if out:
        return f"{_WORDS[name]} {out}"
    if math.isnan(error):
        return f"{_WORDS[name]} has no estimate of its error"
    return "" if error <= tolerance else f"{_WORDS[name]} may be off by {percent(error)}"


def _out_of_range(wave: LiquidWave) -> str:
    """Which number is out of the range of this model, or which wall is in its way; empty if none."""
    for number in judge(wave.numbers, wave.ranges):
        if not number.in_range and number.name not in _SHARED:
            return f"is out of its range, {number}"
    if wave.answer.dry_patch[0]:
        return "lets the wall run dry"
    clear = wave.answer.limits.get("inner_wall")
    return "" if clear is None or clear[0] else "takes the surface to the inner wall"
