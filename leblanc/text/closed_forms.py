"""Closed forms beside an answer, as rows: angles, stability of the upright rotation, balancing, cages."""

from __future__ import annotations

import math

import numpy as np

from leblanc.core.notes import EXACT
from leblanc.core.units import NOT_FOUND, RPM, in_rpm, number
from leblanc.results.motion.closed_forms import Cage, ClosedForms, Upright, VectorModel
from meshes.arrays import Array

Rows = list[tuple[str, str]]

# Angles from the liquid to the unbalance, then what they follow from and what they leave.
HEAD = (
    *("speed (rpm)", "angle, solved (deg)", "alpha_0 (deg)", "as printed (deg)"),
    *("lag delta (deg)", "k", "lambda_0"),
)
_SHOWN = 9  # speeds in the table of angles


def closed_form_rows(forms: ClosedForms | None) -> Rows:
    """What closed forms say, in a line each; label and text."""
    if forms is None:
        return []
    return [
        *([] if forms.vector is None else [("vector model", _vector(forms.vector))]),
        *([] if forms.upright is None else [("upright rotation", _upright(forms.upright))]),
        *_balancing(forms),
        *((f"cage of {cage.name}", _cage(cage)) for cage in forms.cages),
    ]


def _vector(found: VectorModel) -> str:
    """How well the balance of angles is met, and what is left of the unbalance."""
    if math.isnan(found.difference):
        return "no angle balances: no liquid is off the axis"
    met = "angles are the solved ones to rounding"
    if found.difference > EXACT:
        met = f"angles within {found.difference:.1g} rad of the solved ones"
    left = float(found.unbalance_left[-1])
    last = f"; at the last speed lambda_0 = {left:.4g} of the unbalance is left" if np.isfinite(left) else ""
    return met + last


def vector_rows(speed: Array, found: VectorModel) -> list[tuple[str, ...]]:
    """Angles at some of the speeds, as `HEAD` heads them."""
    picked = sorted({round(k * (speed.size - 1) / (_SHOWN - 1)) for k in range(_SHOWN)})
    return [
        (
            number(float(speed[k]) * RPM),
            *(_known(math.degrees(float(values[k]))) for values in (found.angle, found.balance_angle)),
            _known(math.degrees(float(found.printed_angle[k])), "not real"),
            _known(math.degrees(float(found.lag[k]))),
            _known(float(found.ratio[k])),
            _known(float(found.unbalance_left[k])),
        )
        for k in picked
    ]


def _known(value: float, otherwise: str = NOT_FOUND) -> str:
    return number(value) if math.isfinite(value) else otherwise


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
        ("balancing in two planes", f"{whole}, {at_last} at the last speed; damped supports may ask for more")
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
