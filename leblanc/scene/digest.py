"""Fingerprint of a scene: the same however units, keys and blanks are written."""

from __future__ import annotations

import hashlib
import json
from dataclasses import asdict
from typing import Any

from fluid.fill import Fill
from leblanc.scene.optimise import Optimisation
from leblanc.scene.rotors import AnyRotor, Exciter, JeffcottRotor

_DIGITS = 10  # of each number; spellings of one value differ in the sixteenth


def fingerprint(content: dict[str, Any]) -> str:
    """SHA-256 of what a scene says.

    Parameters
    ----------
    content : tables, lists and values
    """
    return hashlib.sha256(json.dumps(_rounded(content), sort_keys=True).encode()).hexdigest()


def rotor_content(rotor: AnyRotor) -> dict[str, Any]:
    """What the machine is, whichever of two alternatives says so.

    Parameters
    ----------
    rotor : of a scene
    """
    if isinstance(rotor, JeffcottRotor):
        return asdict(rotor.machine()) | {"kind": rotor.kind, "axis": rotor.axis}
    if isinstance(rotor, Exciter):
        balls = rotor.balls.model_dump()
        balls |= {"kind": rotor.balls.name, "pendulum_inertia": rotor.balls.pendulum_inertia or 0.0}
        return rotor.model_dump(exclude={"balls"}) | {"balls": balls}
    return {"kind": rotor.kind, "machine": asdict(rotor.machine()), "axis": rotor.axis}


def chamber_content(fill: Fill) -> dict[str, Any]:
    """What a chamber is and holds; a part that came later counts only where there is one.

    Parameters
    ----------
    fill : of a scene
    """
    chamber = fill.chamber
    walls: dict[str, Any] = {
        "radius": chamber.radius,
        "height": chamber.height,
        "inner_radius": chamber.inner_radius,
        "plane": chamber.plane,
    }
    if chamber.baffles is not None:
        walls["baffles"] = asdict(chamber.baffles)
    if chamber.section is not None:
        walls["section"] = chamber.section.digest
    return {"chamber": walls, "liquid": asdict(fill.liquid), "volume": fill.volume}


def optimise_content(wanted: Optimisation) -> dict[str, Any]:
    """What the liquid is chosen for.

    Parameters
    ----------
    wanted : of a scene
    """
    duty = [(one.speed, one.weight) for one in wanted.duty]
    return wanted.model_dump(exclude={"duty"}) | {"duty": duty}


def _rounded(value: Any) -> Any:
    """The same with every float as a text of a few digits."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [_rounded(entry) for entry in value]
    return f"{value:.{_DIGITS}g}" if isinstance(value, float) else value
