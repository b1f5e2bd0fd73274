"""The exact wave as the measure of the other models of a layer: their errors, kept as JSON.

`python -m validation.exact` measures again; `kept` reads what it left. Depths are over R, whirls over h_0,
detunings are ratios p/p_1 to that of small free waves.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

import numpy as np

from meshes.arrays import Array, Flags

KEPT = Path(__file__).parent / "results.json"
# Models by their names here; one family answers the whirl behind the drum and its twin ahead, which the
# others do not tell apart.
MODELS = ("linear", "long_wave", "dispersion", "kdv", "kdv_twin", "whitham", "whitham_twin")


@dataclass(frozen=True)
class Cases:
    """Answers of all models to some whirls; all shapes (n,)."""

    layer: Array  #: h_0/R, p/p_1, w_0/h_0
    ratio: Array
    whirl: Array
    exact: Array  #: G of the exact wave; nan where no smooth one was found
    crest: Array  #: of that wave: depths over h_0, and lee waves over its height
    trough: Array
    ripple: Array
    models: Mapping[str, Array]  #: G by each model, nan where it has no smooth wave

    @property
    def smooth(self) -> Flags:
        """Whether there is an exact wave to compare with."""
        return np.isfinite(self.exact)

    def error(self, model: str) -> Array:
        """Distance of a model's G from the exact one over the larger of |G| and 1, shape (n,)."""
        return np.asarray(np.abs(self.models[model] - self.exact) / np.maximum(1.0, np.abs(self.exact)))


@dataclass(frozen=True)
class Ends:
    """Where waves of whirls that grow from nothing end; all shapes (n,)."""

    layer: Array  #: h_0/R, p/p_1
    ratio: Array
    whirl: Array  #: largest w_0/h_0 of a smooth exact wave
    fold: Flags  #: there the branch turns back
    choked: Array  #: largest w_0/h_0 of a smooth long wave without dispersion


@dataclass(frozen=True)
class Marched:
    """Long waves through time beside the steady ones; all shapes (n,)."""

    layer: Array  #: h_0/R, whirl speed over the spin, w_0/h_0
    speed: Array
    whirl: Array
    dispersion: Flags  #: with it
    cells: Array  #: round the wall
    force: Array  #: G through time, its real part
    steady: Array  #: G by the steady equations
    converged: Flags  #: it settled


@dataclass(frozen=True)
class Measured:
    """All that is kept."""

    maps: Cases  #: on a grid of depths, detunings and whirls
    drawn: Cases  #: by chance, none of which a constant was fitted to
    ends: Ends  #: of branches
    marched: Marched  #: long waves through time
    seconds: float  #: that the measurement took


def kept() -> Measured:
    """What was measured last."""
    found = json.loads(KEPT.read_text(encoding="utf-8"))
    return Measured(
        maps=_cases(found["maps"]),
        drawn=_cases(found["drawn"]),
        ends=Ends(**{key: _array(value) for key, value in found["ends"].items()}),
        marched=Marched(**{key: _array(value) for key, value in found["marched"].items()}),
        seconds=found["seconds"],
    )


def _cases(found: Mapping[str, Any]) -> Cases:
    arrays = {item.name: _array(found[item.name]) for item in fields(Cases) if item.name != "models"}
    return Cases(**arrays, models={name: _array(found["models"][name]) for name in MODELS})


def _array(values: list[Any]) -> Any:
    """Numbers with nan where there are none; flags as flags."""
    if all(isinstance(value, bool) for value in values):
        return np.array(values, dtype=bool)
    return np.array([np.nan if value is None else value for value in values], dtype=float)


def keep(measured: Measured) -> None:
    """Write what was measured."""
    KEPT.write_text(json.dumps(_plain(measured), separators=(",", ":")) + "\n", encoding="utf-8")


def _plain(value: Any) -> Any:
    """As JSON has it: no nan, nine digits, more than any model is right to."""
    if isinstance(value, np.ndarray):
        return [_plain(entry) for entry in value.tolist()]
    if isinstance(value, float):
        return None if np.isnan(value) else float(f"{value:.9g}")
    if isinstance(value, Mapping):
        return {key: _plain(entry) for key, entry in value.items()}
    if hasattr(value, "__dataclass_fields__"):
        return {item.name: _plain(getattr(value, item.name)) for item in fields(value)}
    return value
