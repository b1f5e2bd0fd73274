"""Self-excited whirls of finite size as answers have them: rows, folds, and the largest ones."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from leblanc.core.netcdf import Variable
from leblanc.core.quantities import named_arrays, row_variables, to_json
from meshes.arrays import Array, Flags
from meshes.quantity import Q

if TYPE_CHECKING:
    from solvers.cycles.cycles import Branch

# Of the spin: the long waves' profile of the flow does not describe a layer that lags more.
FAST_LAG = 1.0 / 3.0
_RATE, _OVER = "rad s-1", ("speed",)


class _Row:
    """A record whose quantities are items as well, as in the JSON."""

    def __getitem__(self, name: str) -> Any:
        return getattr(self, name)


@dataclass(frozen=True)
class Cycle(_Row):
    """A limit cycle; of several layers the lag is that of the one that lags most."""

    branch: Annotated[int, Q("1", "branch")]
    speed: Annotated[float, Q(_RATE, "spin speed", "of the rotor about its axis")]
    amplitude: Annotated[float, Q("m", "amplitude", "of the first chamber's axis")]
    whirl_speed: Annotated[float, Q(_RATE, "whirl speed", "in space")]
    lag: Annotated[float, Q(_RATE, "lag", "of the liquid behind the drum")]
    stable: Annotated[bool, Q(name="stable", text="small disturbances decay", flags="no yes")]
    growth: Annotated[float, Q("s-1", "growth rate", "of a small disturbance of the whirl")]
    torque: Annotated[float, Q("N m", "torque", "that the drive has to supply on top")]
    power: Annotated[float, Q("W", "power", "that the drive has to supply on top")]
    thinnest: Annotated[float, Q("1", "least depth", "over the mean depth; of KdV-Burgers may be below 0")]
    in_range: Annotated[
        bool,
        Q(
            name="in range",
            text="the liquid lags by a third at most, and KdV-Burgers leaves the wall wet",
            flags="no yes",
        ),
    ]


@dataclass(frozen=True)
class Fold(_Row):
    """Where a branch turns back in speed."""

    branch: Annotated[int, Q("1", text="number of its branch", data=False)]
    speed: Annotated[float, Q(_RATE, "spin speed of the fold")]
    amplitude: Annotated[float, Q("m", "amplitude of the fold")]


@dataclass(frozen=True)
class Cycles:
    """Limit cycles, one after the other along their branches."""

    branches: tuple[Branch, ...]  #: without unbalance
    wave: Annotated[
        str, Q(name="liquid model", text="of limit cycles: long_wave or kdv", key="cycles_model", data=False)
    ]

    @property
    def cycles(self) -> Annotated[list[Cycle], Q(text="limit cycles along their branches")]:
        """Of all branches."""
        found = []
        for number, branch in enumerate(self.branches):
            lag = np.nanmax(branch.lag, axis=1)
            columns = (
                *(branch.speed, branch.amplitude, branch.whirl_speed, lag, branch.stable, branch.growth),
                *(branch.torque, branch.power, branch.thinnest),
                (lag <= FAST_LAG * branch.speed) & (branch.thinnest >= 0.0),
            )
            rows = zip(*(column.tolist() for column in columns), strict=True)
            found += [Cycle(number, *row) for row in rows]
        return found

    @property
    def folds(self) -> Annotated[list[Fold], Q(text="where branches turn back in speed")]:
        """Of all branches."""
        return [
            Fold(number, speed, amplitude)
            for number, branch in enumerate(self.branches)
            for speed, amplitude in zip(branch.fold_speed, branch.fold_amplitude, strict=True)
        ]

    def to_json(self) -> dict[str, Any]:
        """The branches, and of a subclass all else."""
        return to_json(self)

    def variables(self) -> dict[str, Variable]:
        """Arrays over `cycle` and `fold`, and of a subclass all else."""
        rows = row_variables(Cycle, self.cycles, "cycle") | row_variables(Fold, self.folds, "fold")
        return dict(named_arrays(self).variables) | rows


@dataclass(frozen=True)
class LargeWhirl(Cycles):
    """How large the self-excited whirl becomes that comes on top of the response to the unbalance."""

    #: 0 where there is none, nan where a small whirl grows and none was found that it grows to, shape (n,)
    amplitude: Annotated[
        Array,
        Q(
            "m",
            "amplitude of self-excited whirl",
            "of the first chamber's axis",
            over=_OVER,
            key="self_excited_amplitude",
        ),
    ]
    #: nan where there is none, shape (n,)
    whirl_speed: Annotated[
        Array, Q(_RATE, "speed of self-excited whirl", "in space", over=_OVER, key="self_excited_whirl_speed")
    ]
    #: a small whirl does not grow there: a kick starts this one or a run-up carries it, shape (n,)
    kicked: Flags
    reason: str = ""  #: why there are none, or what is not among them; empty if nothing is to be said
