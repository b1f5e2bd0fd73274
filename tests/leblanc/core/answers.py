"""One small answer of each declared kind, asked once."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any

import leblanc as lb
from leblanc.core.answer import Answer

_WALL: dict[str, Any] = {"radius": 0.15, "height": 0.05, "volume": 6.7e-4, "speed": 40.0}
_WHIRL = _WALL | {"whirl_speed": 32.0, "whirl_amplitude": 1.5e-4}
_FEW = {"speeds.count": 3}

ASKED: dict[str, Callable[[], Any]] = {
    "bearing": lambda: lb.bearing(speed="33 Hz", ftf=0.38475, bpfi=5.5369, bsf=2.0497, cage=80.0),
    "volume": lambda: lb.volume(radius=0.2, height=0.05, eccentricity="1 mm", speed=90.0, volume="40 ml"),
    "optimal volume": lambda: lb.volume(radius=0.2, height=0.05, eccentricity="1 mm", speed=90.0),
    "layer": lambda: lb.layer(**_WHIRL),
    "free wave": lambda: lb.layer(**_WALL, free=1.05, model="linear"),
    "periods": lambda: lb.layer(**_WHIRL, model="long_wave", cells=32, duration=2.0),
    "modes": lambda: lb.modes(**_WALL, count=2, segments=24, layers=2, order=1),
    "exciter": lambda: lb.run(lb.example("vibratory_table").replace(_FEW)),
    "magnetic": lambda: lb.run(lb.example("blood_pump").replace(_FEW | {"rotor.trial.duration": 0.01})),
    "spindle": lambda: lb.run(lb.example("spindle").replace(_FEW)),
    "explain exciter": lambda: lb.explain(lb.example("vibratory_table")),
    "explain magnetic": lambda: lb.explain(lb.example("blood_pump")),
}


@cache
def answer(kind: str) -> Answer:
    """The answer of a kind."""
    found: Answer = ASKED[kind]()
    return found
