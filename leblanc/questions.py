"""Questions of some commands and calls, from options of the command or keywords in Python.

Quantities are numbers in SI units or texts with a unit. Faults name the option, as in "--whirl-speed".
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from inspect import signature
from typing import TYPE_CHECKING, Any, TypeVar

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid, known_liquid
from leblanc.core.units import (
    ACCELERATION,
    ANGULAR_SPEED,
    LENGTH,
    TIME,
    VOLUME,
    allowed_as_typed,
    parse_friction,
    parse_option,
)
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import OBJECTIVES, Optimisation
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError

if TYPE_CHECKING:
    from leblanc.studies.models.whirling import AutoWave
    from solvers.liquid_model import WaveModel

Quantity = str | float
Question = TypeVar("Question")
_MOST_BAFFLES = 64


def ask(question: Callable[..., Question], given: Mapping[str, Any]) -> Question:
    """A question from those of the values that it has parameters for.

    Parameters
    ----------
    question : one of this module's functions
    given : values by their names, as `locals()` of a command or call that has the same parameters and more
    """
    return question(**{name: given[name] for name in signature(question).parameters})


def as_typed(error: InputError, given: Mapping[str, Any]) -> InputError:
    """What is refused of an option, with the value as it was typed and its bounds in the unit typed.

    Parameters
    ----------
    error : of a study, or of what reads the option
    given : values by the names of the options
    """
    name = error.field.removeprefix("--").replace("-", "_")
    typed = given.get(name)
    if not isinstance(typed, str):
        return error
    if not error.field.startswith("--") and not typed.lstrip("+-. ")[:1].isdigit():
        return error  # no quantity: a name, which may be an argument and no option
    option = f"--{name.replace('_', '-')}"
    try:
        return InputError(option, float(typed), error.allowed)  # in SI, as the bounds are
    except ValueError:
        return InputError(option, typed, allowed_as_typed(error.allowed, typed))


@dataclass(frozen=True)
class LayerQuestion:
    """A layer under a prescribed whirl, or its free wave."""

    #: by the names of `leblanc.studies.layer.answer_layer`; empty where a free wave is asked for
    whirl: dict[str, Any]
    duration: float | None  #: from rest, s; None for the settled answer
    ramp: float  #: time over which the whirl grows, s
    #: by the names of `leblanc.studies.layer.free_wave`; None where a whirl is given
    free: dict[str, Any] | None = None


def layer_question(
    *,
    radius: Quantity,
    volume: Quantity,
    height: Quantity,
    speed: Quantity,
    whirl_speed: Quantity | None = None,
    whirl_amplitude: Quantity | None = None,
    model: str = "linear",
    cells: int | None = None,
    baffles: int = 0,
    baffle_tip_radius: Quantity = 0.0,
    baffle_wall_gap: Quantity = 0.0,
    dispersion: bool = False,
    friction: str | Friction = "none",
    gravity: Quantity = 0.0,
    liquid: str | Liquid = "water",
    duration: Quantity | None = None,
    ramp: Quantity = 0.0,
    solver: str | None = None,
    free: float | None = None,
    mode: int | None = None,
    tolerance: float | None = None,
) -> LayerQuestion:
    """The question of `layer`; the parameters are those of `leblanc.api.layer`.

    Raises
    ------
    InputError : a value that cannot be read, or is out of its range
    """
    from leblanc.studies.layer import (
        as_options,
    )  # brings the solvers of layers, which no other question needs

    plates = baffle_plates(baffles, baffle_tip_radius, baffle_wall_gap)
    chamber = Chamber(
        parse_option(radius, LENGTH, "--radius"), parse_option(height, LENGTH, "--height"), baffles=plates
    )
    whirl: dict[str, Any] = {
        "fill": Fill(chamber, liquid_of(liquid), parse_option(volume, VOLUME, "--volume")),
        "speed": parse_option(speed, ANGULAR_SPEED, "--speed"),
    }
    law = friction_of(friction)
    if free is not None:
        unused = {
            "whirl_speed": whirl_speed, "whirl_amplitude": whirl_amplitude, "duration": duration,
            "solver": solver, "dispersion": dispersion or None, "baffles": baffles or None,
            "gravity": gravity if parse_option(gravity, ACCELERATION, "--gravity") else None,
            "ramp": ramp if parse_option(ramp, TIME, "--ramp") else None,
        }  # fmt: skip
        for name, value in unused.items():
            if value is not None:
                raise InputError(f"--{name.replace('_', '-')}", value, "left out where --free is given")
        with as_options():
            made = _layer_model(model, law, cells, tolerance=tolerance)
        crests = 1 if mode is None else mode
        return LayerQuestion({}, None, 0.0, {**whirl, "crest": float(free), "crests": crests, "model": made})
    if mode is not None:
        raise InputError("--mode", mode, "left out without --free")
    pull = parse_option(gravity, ACCELERATION, "--gravity")
    if pull > 0.0 and (
        whirl_amplitude is None or parse_option(whirl_amplitude, LENGTH, "--whirl-amplitude") == 0.0
    ):
        # Gravity alone drives: nothing whirls.
        whirl_speed, whirl_amplitude = whirl["speed"] if whirl_speed is None else whirl_speed, 0.0
    if whirl_speed is None or whirl_amplitude is None:
        name = "--whirl-amplitude" if whirl_amplitude is None else "--whirl-speed"
        raise InputError(name, None, "given, or --free in its place")
    whirl |= {
        "whirl_speed": parse_option(whirl_speed, ANGULAR_SPEED, "--whirl-speed"),
        "whirl_amplitude": parse_option(whirl_amplitude, LENGTH, "--whirl-amplitude"),
        "gravity": pull,
    }
    with as_options():
        whirl["model"] = _layer_model(model, law, cells, dispersion, solver, tolerance)
    length = None if duration is None else parse_option(duration, TIME, "--duration")
    return LayerQuestion(whirl, length, parse_option(ramp, TIME, "--ramp"))


def _layer_model(
    name: str,
    friction: Friction,
    cells: int | None,
    dispersion: bool = False,
    solver: str | None = None,
    tolerance: float | None = None,
) -> WaveModel | AutoWave:
    """The model that is named, or what stands for it until the whirl is known."""
    from leblanc.studies.models.liquid import wave_model
    from leblanc.studies.models.whirling import AUTO, LAYER_MODELS, TOLERANCE, AutoWave

    if name not in LAYER_MODELS:
        raise InputError("model", name, "one of " + ", ".join(LAYER_MODELS))
    if name != AUTO:
        if tolerance is not None:
            raise InputError("tolerance", tolerance, f"left out for {name}; auto has one")
        return wave_model(name, friction, cells, dispersion, solver)
    if solver is not None:
        raise InputError("solver", solver, "left out for auto; long_wave and kdv have one")
    return AutoWave(friction, cells, dispersion, TOLERANCE if tolerance is None else tolerance)


def optimisation_of(
    scene: Scene,
    objective: str | None = None,
    deflection: Quantity | None = None,
    limit: Quantity | None = None,
    steady: bool = False,
    seed: int | None = None,
) -> Optimisation:
    """What the liquid of a scene is chosen for: its table [optimise] with what is given in its place.

    The parameters are those of `leblanc.api.optimise`.

    Raises
    ------
    InputError : no such objective, a value out of its range
    """
    task = scene.optimise or Optimisation()
    if objective is not None:
        if objective not in OBJECTIVES:
            raise InputError("--objective", objective, "one of " + ", ".join(OBJECTIVES))
        task = task.altered(objective=objective)
    if deflection is not None:
        task = task.altered(deflection=_length(deflection, "--deflection"))
    if limit is not None:
        task = task.altered(vibration_limit=_length(limit, "--limit"))
    if seed is not None:
        if seed < 0:
            raise InputError("--seed", seed, "a whole number, 0 or above")
        task = task.altered(seed=seed)
    return task.altered(steady=task.steady or steady)


def require_no_emulator(store: object) -> None:
    """Refuse an emulator of a sweep over volumes where balls are chosen.

    Raises
    ------
    InputError : one is given
    """
    if store is not None:
        raise InputError("--emulator", str(store), "left out with balls, whose designs it does not know")


def _length(given: Quantity, option: str) -> float:
    """A length above 0 in metres."""
    value = parse_option(given, LENGTH, option)
    if not 1e-12 <= value <= 1e3:
        raise InputError(option, given, "from 1e-12 to 1000 m")
    return value


def liquid_of(liquid: str | Liquid) -> Liquid:
    """A liquid, or the known one of that name."""
    return liquid if isinstance(liquid, Liquid) else known_liquid(liquid)


def friction_of(friction: str | Friction) -> Friction:
    """A friction law, or the one typed as none, stokes, wall[:ROUGHNESS], linear:RATE or quadratic:NUMBER."""
    return friction if isinstance(friction, Friction) else parse_friction(friction, "--friction")


def baffle_plates(count: int, tip_radius: Quantity, wall_gap: Quantity) -> Baffles | None:
    """Radial baffles, None without any.

    Raises
    ------
    InputError : more than are taken, edges without baffles
    """
    tip = parse_option(tip_radius, LENGTH, "--baffle-tip-radius")
    gap = parse_option(wall_gap, LENGTH, "--baffle-wall-gap")
    if not 0 <= count <= _MOST_BAFFLES:
        raise InputError("--baffles", count, f"from 0 to {_MOST_BAFFLES}")
    if count > 0:
        return Baffles(count, tip, gap)
    if tip != 0.0 or gap != 0.0:
        raise InputError("--baffles", count, "1 or more where their edges are given")
    return None
