"""Questions of some commands and calls, from options of the command or keywords in Python.

Quantities are numbers in SI units or texts with a unit. Faults name the option, as in "--whirl-speed".
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from leblanc.core.units import LENGTH, allowed_as_typed, parse_option
from leblanc.scene.scene import Scene
from leblanc.scene.tasks import OBJECTIVES, Optimisation
from meshes.errors import InputError

Quantity = str | float


def as_typed(error: InputError, given: Mapping[str, Any]) -> InputError:
    """What is refused of an option, with the value as it was typed and its bounds in the unit typed."""
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
    """Refuse an emulator of a sweep over volumes where balls are chosen."""
    if store is not None:
        raise InputError("--emulator", str(store), "left out with balls, whose designs it does not know")


def _length(given: Quantity, option: str) -> float:
    """A length above 0 in metres."""
    value = parse_option(given, LENGTH, option)
    if not 1e-12 <= value <= 1e3:
        raise InputError(option, given, "from 1e-12 to 1000 m")
    return value
