"""Analytical checks beside a machine's solved answer: angles, stability, balancing, cages."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from leblanc.core.blocks import Table
from leblanc.core.notes import EXACT
from leblanc.core.units import in_rpm, number
from meshes.arrays import Array, Flags
from meshes.quantity import Q
from solvers.rotor.balls.two_plane_balance import Balancing

Rows = list[tuple[str, str]]

# Angles from the liquid to the unbalance, then what they follow from and what they leave.
_OVER, _LIQUID = ("speed",), "from the liquid to the unbalance, positive with the spin"


@dataclass(frozen=True)
class Upright:
    """Whether a rotor with its liquid stands upright about a ball joint [theory: statics, eq. 20-21]."""

    speed: Annotated[Array, Q("rad s-1", "spin speed", over=_OVER, data=False)]
    dry: Annotated[Array, Q("N m", "second variation of the energy", "no liquid", _OVER, data=False)]
    frozen: Annotated[Array, Q("N m", "the same with the liquid frozen", over=_OVER, data=False)]
    surface: Annotated[Array, Q("N m", "what the free surfaces take from it", over=_OVER)]
    limits: Annotated[
        tuple[float, ...], Q("rad s-1", text="speeds at which it turns stable or unstable", data=False)
    ]
    #: from the least film up to where the first chamber is full
    fill_limits: Annotated[
        tuple[float, ...],
        Q("1", text="shares of all volumes at which it does at the last speed; 1 is the scene", data=False),
    ]

    @property
    def margin(
        self,
    ) -> Annotated[
        Array, Q("N m", "second variation of the energy of upright rotation", "above 0 stable", _OVER)
    ]:
        return self.frozen - self.surface

    @property
    def stable(self) -> Annotated[Flags, Q(name="upright rotation is stable", over=_OVER)]:
        return np.asarray(self.margin > 0.0)


@dataclass(frozen=True)
class VectorModel:
    """Angles of the vector model at the speeds of a planar answer [theory: rotor, eq. 9-14]."""

    lag: Annotated[Array, Q("rad", "lag", "delta, of the deflection behind the total unbalance", _OVER)]
    #: k; nan where no liquid is off axis
    ratio: Annotated[Array, Q("1", "unbalance of the rotor over that of the liquid", over=_OVER)]
    angle: Annotated[Array, Q("rad", "angle of the solved answer", _LIQUID, _OVER)]
    #: alpha_0 for this k, of two the one nearer to `angle`; nan where no angle balances
    balance_angle: Annotated[Array, Q("rad", "angle by the balance of angles", _LIQUID, _OVER)]
    #: alpha_0 by the formula of the source, whose cosine lost a factor 1/k [DR18, eq. 25]; nan if not real
    printed_angle: Annotated[Array, Q("rad", "angle as published", _LIQUID, _OVER)]
    unbalance_left: Annotated[Array, Q("1", "total unbalance over that of the rotor", "lambda_0", _OVER)]

    @property
    def difference(self) -> float:
        """Largest difference between solved angle and balance of angles, rad; nan where none is known."""
        apart = np.abs(self.angle - self.balance_angle)
        return float(np.nanmax(apart)) if np.isfinite(apart).any() else math.nan


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
    """Analytical checks of a scene; None or empty where it lacks what they need."""

    #: of a vertical rotor with a ball joint
    upright: Annotated[Upright | None, Q(prefix="upright", text="by the energy", when="upright")] = None
    #: of a planar rotor's answer
    vector: Annotated[VectorModel | None, Q(prefix="vector", key="vector_model", when="vector")] = None
    #: conditions of balancing in two planes
    balancing: Annotated[Balancing | None, Q(prefix="balancing", when="balancing")] = None
    cages: tuple[Cage, ...] = ()  #: of the bearings whose balls are given
    #: what the scene lacks for those that its kind of machine could have, a sentence each
    lacking: tuple[str, ...] = ()

    @property
    def cage_speed(
        self,
    ) -> Annotated[
        dict[str, list[float]] | None,
        Q("rad s-1", text="of each cage, by its bearing", when="cage_speed", data=False),
    ]:
        return {cage.name: cage.speed.tolist() for cage in self.cages} or None

    @property
    def cage_name(
        self,
    ) -> Annotated[tuple[str, ...] | None, Q("1", "name of the bearing", over=("cage",), json=False)]:
        return tuple(cage.name for cage in self.cages) or None

    @property
    def cage_speeds(
        self,
    ) -> Annotated[
        Array | None,
        Q("rad s-1", "speed of the cage", "no slip", ("speed", "cage"), json=False, variable="cage_speed"),
    ]:
        return np.stack([cage.speed for cage in self.cages], axis=-1) if self.cages else None


def closed_form_table(forms: ClosedForms) -> Table:
    """Analytical checks, in a line each."""
    rows = [
        *([] if forms.vector is None else [("Vector model", _vector(forms.vector))]),
        *([] if forms.upright is None else [("Upright rotation", _upright(forms.upright))]),
        *_balancing(forms),
        *((f"Cage of {cage.name}", _cage(cage)) for cage in forms.cages),
    ]
    return Table(rows, title="Analytical checks")


def _vector(found: VectorModel) -> str:
    """How well the balance of angles is met, and the residual unbalance ratio."""
    if math.isnan(found.difference):
        return "no angle balances: no liquid is off the axis"
    met = "angles are the solved ones to rounding"
    if found.difference > EXACT:
        met = f"angles within {found.difference:.1g} rad of the solved ones"
    left = float(found.unbalance_left[-1])
    last = (
        f"; at the last speed the residual unbalance ratio is lambda_0 = {left:.4g}"
        if np.isfinite(left)
        else ""
    )
    return met + last


def _upright(found: Upright) -> str:
    """Where the upright rotation is stable, by speed and by fill."""
    margin, last = f"{number(float(found.margin[-1]))} N m", in_rpm(float(found.speed[-1]))
    if found.limits:
        where = f"{'stable' if found.stable[0] else 'unstable'} at first, turns at " + ", ".join(
            in_rpm(speed) for speed in found.limits
        )
    else:
        where = f"{'stable' if found.stable.all() else 'unstable'} at every speed"
    taken, dry = (number(float(values[-1])) for values in (found.surface, found.dry))
    text = f"{where}; margin {margin} at {last}, {dry} N m without liquid; the free surface takes {taken} N m"
    if found.fill_limits:
        shares = ", ".join(f"{number(share)} of the scene's" for share in found.fill_limits)
        text += f"; there it turns at volumes {shares}"
    return text


def _balancing(forms: ClosedForms) -> Rows:
    """Conditions of balancing in two planes."""
    found = forms.balancing
    if found is None:
        return []
    whole = f"possible above {in_rpm(found.above)}"
    if math.isinf(found.above):
        whole = "not possible at any speed"
    at_last = "holds" if found.possible[-1] else "does not hold"
    rows = [
        ("Balancing in two planes", f"{whole}, {at_last} at the last speed; damped supports may ask for more")
    ]
    for each in found.conditions:
        reach = "at no speed" if math.isinf(each.above) else f"above {in_rpm(each.above)}"
        reach = "at every speed" if each.above == 0.0 else reach
        rows.append((f"  {each.name}", f"{reach}; {number(float(each.value[-1]))} at the last speed"))
    return rows


def _cage(cage: Cage) -> str:
    """Speed of a cage at the last speed, beside the source's short form."""
    text = f"{in_rpm(float(cage.speed[-1]))} at the last speed without slip"
    if math.isnan(cage.printed[-1]):
        return text
    return f"{text}; half the shaft's, {in_rpm(float(cage.printed[-1]))}, leaves out the balls' diameter"
