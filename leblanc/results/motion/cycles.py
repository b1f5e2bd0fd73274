"""Self-excited whirls of finite size as results tell them: rows, folds, arrays, and the largest ones."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from leblanc.core.netcdf import Variable, flags
from leblanc.core.netcdf import variable as var
from meshes.arrays import Array, Flags
from meshes.quantity import Q

if TYPE_CHECKING:
    from solvers.cycles.cycles import Branch

_OVER = ("speed",)
# Of the spin: the long waves' profile of the flow does not describe a layer that lags more.
FAST_LAG = 1.0 / 3.0
DEEP = 0.9  # of the layer's depth: whirls beyond that lay walls dry, or come near to it


def cycle_rows(branches: Sequence[Branch]) -> list[dict[str, Any]]:
    """Limit cycles one after the other along their branches, SI.

    `amplitude` is that of the first chamber's axis, `lag` by how much the liquid turns more slowly than the
    drum (of several layers the one that lags most), `growth` that of a small disturbance, `torque` and
    `power` what the drive has to supply on top, `thinnest` the least depth over the mean depth. In `in_range`
    are whirls whose lag is below a third of the spin.
    """
    found = []
    for number, branch in enumerate(branches):
        lag = np.nanmax(branch.lag, axis=1)
        columns = {
            "branch": np.full(lag.shape, number),
            "speed": branch.speed,
            "amplitude": branch.amplitude,
            "whirl_speed": branch.whirl_speed,
            "lag": lag,
            "stable": branch.stable,
            "growth": branch.growth,
            "torque": branch.torque,
            "power": branch.power,
            "thinnest": branch.thinnest,
            "in_range": lag <= FAST_LAG * branch.speed,
        }
        found += [
            dict(zip(columns, row, strict=True))
            for row in zip(*(values.tolist() for values in columns.values()), strict=True)
        ]
    return found


def fold_rows(branches: Sequence[Branch]) -> list[dict[str, Any]]:
    """Where branches turn back in speed: `branch`, `speed` and `amplitude`, SI."""
    return [
        {"branch": number, "speed": speed, "amplitude": amplitude}
        for number, branch in enumerate(branches)
        for speed, amplitude in zip(branch.fold_speed, branch.fold_amplitude, strict=True)
    ]


def cycle_arrays(branches: Sequence[Branch]) -> dict[str, Variable]:
    """Limit cycles over the dimension `cycle` and folds over `fold`, by name."""
    rate, whirls, folds = "rad s-1", cycle_rows(branches), fold_rows(branches)
    units = {
        "speed": (rate, "spin speed", "of the rotor about its axis"),
        "amplitude": ("m", "amplitude", "of the first chamber's axis"),
        "whirl_speed": (rate, "whirl speed", "in space"),
        "lag": (rate, "lag", "of the liquid behind the drum"),
        "growth": ("s-1", "growth rate", "of a small disturbance of the whirl"),
        "torque": ("N m", "torque", "that the drive has to supply on top"),
        "power": ("W", "power", "that the drive has to supply on top"),
        "thinnest": ("1", "least depth", "over the mean depth"),
    }
    found = {
        f"cycle_{name}": var(("cycle",), np.array([row[name] for row in whirls], dtype=float), *words)
        for name, words in units.items()
    }
    found["cycle_branch"] = var(
        ("cycle",), np.array([row["branch"] for row in whirls], dtype=np.int64), "1", "branch"
    )
    stable = np.array([row["stable"] for row in whirls], dtype=bool)
    valid = np.array([row["in_range"] for row in whirls], dtype=bool)
    found["cycle_stable"] = flags(("cycle",), stable, "no yes", "stable", "small disturbances die out")
    found["cycle_in_range"] = flags(
        ("cycle",), valid, "no yes", "in range", "the liquid lags by a third at most"
    )
    for name in ("speed", "amplitude"):
        values = np.array([row[name] for row in folds], dtype=float)
        found[f"fold_{name}"] = var(("fold",), values, units[name][0], f"{units[name][1]} of the fold")
    return found


@dataclass(frozen=True)
class LargeWhirl:
    """How large the self-excited whirl becomes that comes on top of the response to the unbalance."""

    branches: tuple[Branch, ...]  #: of limit cycles, without unbalance
    #: in the largest stable whirl, 0 where there is none, nan where a small whirl grows and none was found
    #: that it grows to
    amplitude: Annotated[
        Array,
        Q(
            *("m", "amplitude of self-excited whirl", "of the first chamber's axis", _OVER),
            key="self_excited_amplitude",
        ),
    ]
    #: nan where there is none
    whirl_speed: Annotated[
        Array, Q("rad s-1", "speed of self-excited whirl", "in space", _OVER, key="self_excited_whirl_speed")
    ]
    #: a small whirl does not grow there: a kick starts this one or a run-up carries it, shape (n,)
    kicked: Flags
    reason: str = ""  #: why there are none, or what is not among them; empty if nothing is to be said

    @property
    def cycles(self) -> Annotated[list[dict[str, Any]], Q(text="limit cycles along their branches")]:
        return cycle_rows(self.branches)

    @property
    def folds(self) -> Annotated[list[dict[str, Any]], Q(text="where branches turn back in speed")]:
        return fold_rows(self.branches)

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed`, `cycle` and `fold`."""
        over = ("speed",)
        return {
            "self_excited_amplitude": var(
                *(over, self.amplitude, "m", "amplitude of self-excited whirl"), "of the first chamber's axis"
            ),
            "self_excited_whirl_speed": var(
                *(over, self.whirl_speed, "rad s-1", "speed of self-excited whirl"), "in space"
            ),
            **cycle_arrays(self.branches),
        }
