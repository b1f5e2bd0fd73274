"""Faults of options, as they were typed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from leblanc.core.units import allowed_as_typed
from meshes.errors import InputError


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
