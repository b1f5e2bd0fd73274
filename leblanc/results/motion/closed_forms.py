"""What closed forms say of a machine beside its solved answer: angles, stability, balancing, cages."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from leblanc.core.netcdf import Variable, finite, flags
from leblanc.core.netcdf import variable as var
from meshes.arrays import Array, Flags
from solvers.rotor.balls.two_plane_balance import Balancing


@dataclass(frozen=True)
class Upright:
    """Whether a rotor with its liquid stands upright about a ball joint [theory: statics, eq. 20-21]."""

    speed: Array  #: spin speed, rad/s, shape (n,)
    dry: Array  #: second variation of the energy without liquid, N m, shape (n,)
    frozen: Array  #: the same with the liquid frozen, N m, shape (n,)
    surface: Array  #: what the free surfaces take from it, N m, shape (n,)
    #: speeds of the scene's range at which the upright rotation turns from stable to unstable or back, rad/s
    limits: tuple[float, ...]
    #: shares of all volumes at which it does at the last speed; 1 is the scene, from the least film up to
    #: where the first chamber is full
    fill_limits: tuple[float, ...]

    @property
    def margin(self) -> Array:
        """Above 0 where the upright rotation is stable, N m, shape (n,)."""
        return self.frozen - self.surface

    @property
    def stable(self) -> Flags:
        """Whether it is, shape (n,)."""
        return np.asarray(self.margin > 0.0)

    def to_json(self) -> dict[str, Any]:
        """Plain values over its speeds, SI."""
        return {
            "speed": finite(self.speed),
            "margin": finite(self.margin),
            "dry": finite(self.dry),
            "frozen": finite(self.frozen),
            "surface": finite(self.surface),
            "stable": self.stable.tolist(),
            "limits": list(self.limits),
            "fill_limits": list(self.fill_limits),
        }


@dataclass(frozen=True)
class VectorModel:
    """Angles of the vector model at the speeds of a planar answer [theory: rotor, eq. 9-14]."""

    lag: Array  #: delta of the deflection behind the total unbalance, rad, shape (n,)
    #: k = unbalance of the rotor over that of the liquid, shape (n,); nan where no liquid is off axis
    ratio: Array
    angle: Array  #: from the liquid to the unbalance, of the solved answer, rad, shape (n,)
    #: alpha_0 by the balance of angles for this k, of two the one nearer to `angle`, rad, shape (n,); nan
    #: where no angle balances
    balance_angle: Array
    #: alpha_0 by the source's formula, whose cosine lost a factor 1/k [DR18, eq. 25], rad, shape (n,); nan
    #: where it is not real
    printed_angle: Array
    unbalance_left: Array  #: lambda_0, total unbalance over the rotor's, shape (n,)

    @property
    def difference(self) -> float:
        """Largest difference between solved angle and balance of angles, rad; nan where none is known."""
        apart = np.abs(self.angle - self.balance_angle)
        return float(np.nanmax(apart)) if np.isfinite(apart).any() else math.nan

    def to_json(self) -> dict[str, Any]:
        """Plain values over the speeds of the answer, rad; null where there is none."""
        names = ("lag", "ratio", "angle", "balance_angle", "printed_angle", "unbalance_left")
        return {name: finite(getattr(self, name)) for name in names}

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed`."""
        over, liquid = ("speed",), "from the liquid to the unbalance, positive with the spin"
        return {
            "vector_lag": var(over, self.lag, "rad", "lag", "of the deflection behind the total unbalance"),
            "vector_ratio": var(over, self.ratio, "1", "unbalance of the rotor over that of the liquid"),
            "vector_angle": var(over, self.angle, "rad", "angle of the solved answer", liquid),
            "vector_balance_angle": var(
                over, self.balance_angle, "rad", "angle by the balance of angles", liquid
            ),
            "vector_printed_angle": var(over, self.printed_angle, "rad", "angle as printed", liquid),
            "vector_unbalance_left": var(
                over, self.unbalance_left, "1", "total unbalance over that of the rotor"
            ),
        }


@dataclass(frozen=True)
class Cage:
    """Speed of a bearing's cage without slip [theory: rotor, eq. 32]."""

    name: str  #: of the bearing
    speed: Array  #: rad/s, shape (n,)
    #: half the shaft's, as the source has it for balls without contact angle [DR18, eq. 10], rad/s, shape
    #: (n,); nan with a contact angle
    printed: Array


@dataclass(frozen=True)
class ClosedForms:
    """What closed forms say of a scene; None or empty where it lacks what they need."""

    upright: Upright | None = None  #: of a vertical rotor with a ball joint
    vector: VectorModel | None = None  #: of a planar rotor's answer
    balancing: Balancing | None = None  #: conditions of balancing in two planes
    cages: tuple[Cage, ...] = ()  #: of the bearings whose balls are given
    #: what the scene lacks for those that its kind of machine could have, a sentence each
    lacking: tuple[str, ...] = ()

    @property
    def conditions(self) -> dict[str, Any] | None:
        """Balancing in two planes as plain values, null for a speed that there is not."""
        found = self.balancing
        if found is None:
            return None
        return {
            "speed": finite(found.speed),
            "possible": found.possible.tolist(),
            "long": bool(found.long),
            "above": _or_none(found.above),
            "resonances": list(found.resonances),
            "conditions": [
                {
                    "name": each.name,
                    "value": finite(each.value),
                    "satisfied": each.satisfied.tolist(),
                    "above": _or_none(each.above),
                }
                for each in found.conditions
            ],
        }

    @property
    def cage_speed(self) -> dict[str, list[Any]]:
        """Speed of each cage over speed, rad/s, by the bearing's name."""
        return {cage.name: finite(cage.speed) for cage in self.cages}

    def to_json(self) -> dict[str, Any]:
        """What is told, plain values; without the keys of what is not."""
        conditions = self.conditions
        return {
            **({} if self.upright is None else {"upright": self.upright.to_json()}),
            **({} if self.vector is None else {"vector_model": self.vector.to_json()}),
            **({} if conditions is None else {"balancing": conditions}),
            **({"cage_speed": self.cage_speed} if self.cages else {}),
        }

    def variables(self, over: str = "speed") -> dict[str, Variable]:
        """Arrays over the speeds."""
        found: dict[str, Variable] = {} if self.vector is None else self.vector.variables()
        dims = (over,)
        if self.upright is not None:
            text = "second variation of the energy of upright rotation"
            found["upright_margin"] = var(dims, self.upright.margin, "N m", text, "above 0 stable")
            surface = self.upright.surface
            found["upright_surface"] = var(dims, surface, "N m", "what the free surfaces take from it")
        if self.balancing is not None:
            text = "balancing in two planes"
            found["balancing_possible"] = flags(dims, self.balancing.possible, "no yes", text)
        if self.cages:
            names = np.array([cage.name for cage in self.cages], dtype=object)
            found["cage_name"] = var(("cage",), names, "1", "name of the bearing")
            speeds = np.stack([cage.speed for cage in self.cages], axis=-1)
            found["cage_speed"] = var((*dims, "cage"), speeds, "rad s-1", "speed of the cage", "without slip")
        return found


def _or_none(value: float) -> float | None:
    return value if math.isfinite(value) else None
