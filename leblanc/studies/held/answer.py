"""Quantities of time-domain states."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from numpy.typing import NDArray

from meshes.arrays import Array, Complex, Flags
from meshes.quantity import Q
from solvers.held.state import COUPLED

MOTIONS = ("steady", "periodic", "limit_cycle", "not_settled")
_OVER, _LAYERS, _RATE = ("speed",), ("speed", "chamber"), "rad s-1"
_AXES = ("along the unbalance", "90 deg ahead of it")


@dataclass(frozen=True)
class Held:
    """Rotor and waves at the speeds at which they were integrated in time until they converged.

    n speeds, c chambers. At the other speeds numbers are nan and states are "steady".
    """

    at: Annotated[
        Flags,
        Q(
            *("", "held", "the motion was integrated in time until it converged", _OVER),
            flags="no yes",
            key="held_at",
        ),
    ]
    state: NDArray[np.str_]  #: one of `MOTIONS`, as met while the speed rises, shape (n,)
    least: Array  #: distance of the axis from where it rests, over time, m, shape (n,)
    largest: Array
    #: nan without one
    whirl_speed: Annotated[
        Array, Q(_RATE, "whirl speed", "beside the spin, in space", _OVER, key="held_whirl_speed")
    ]
    liquid: Annotated[
        Complex,
        Q(
            *("m", "mean of the layer's centre of mass", "from the chamber's axis, in the drum"),
            over=_LAYERS,
            axes=_AXES,
            key="liquid_mean",
        ),
    ]
    ripple: Annotated[
        Array, Q("m", "ripple of the layer's centre of mass", "largest", _LAYERS, key="liquid_ripple")
    ]
    error: Annotated[
        Array, Q("1", "estimated error", "of the held motion, by half the cells", _OVER, key="held_error")
    ]
    state_down: Annotated[
        NDArray[np.str_],
        Q(name="state of the motion", text="while the speed falls", over=_OVER, flags=" ".join(MOTIONS)),
    ]
    amplitude_down: Annotated[Array, Q("m", "amplitude", "while the speed falls", _OVER)]
    cells: int  #: round each wall
    reason: Annotated[
        NDArray[np.str_],
        Q(
            *(
                "1",
                "why the motion has not converged in time",
                "empty where it has, or was not integrated in time",
                _OVER,
            ),
            key="held_reason",
        ),
    ]
    #: estimated from smooth waves; nan where there is no whirl or no estimate
    wave_error: Annotated[
        Array,
        Q(
            *("1", "estimated error of the waves"),
            "of long waves beside exact ones, under the whirl of a limit cycle",
            _OVER,
            key="held_wave_error",
        ),
    ]
    #: over the largest of the works of unbalance and drive and of the heats; nan where the solver does not
    #: tell it
    energy_error: Annotated[
        Array, Q("1", "energy error", "what the balance of energy of the last turns leaves", _OVER)
    ]
    multiplier: Annotated[
        Array,
        Q(
            *("1", "Floquet multiplier", "size of the largest, of motions found by Newton's method", _OVER),
            key="held_multiplier",
            by="held, eq. 23",
        ),
    ]
    solver: Annotated[
        str,
        Q("1", "solver", "that held the motions, of py-pde unless it is dop853 or lawson", key="held_solver"),
    ] = COUPLED
    model: str = "long_wave"  #: of the liquid, one of `HELD_MODELS`

    @property
    def limit_cycle(self) -> Flags:
        """Where the motion, as met while the speed rises, is bounded but never repeats, shape (n,)."""
        return np.asarray(self.at & (self.state == "limit_cycle"))

    @property
    def waves_not_known(self) -> Flags:
        """Limit cycles of which there is no estimate how far long waves are off, shape (n,)."""
        if self.model != "long_wave":
            return np.zeros(self.at.shape, dtype=bool)
        return np.asarray(self.limit_cycle & np.isnan(self.wave_error))

    @property
    def not_settled(self) -> Flags:
        """Where the motion still changed when it was given up, shape (n,)."""
        return np.asarray(self.at & (self.state == "not_settled"))

    @property
    def hysteresis(self) -> Flags:
        """Where the motion depends on whether the speed rises or falls, shape (n,).

        A motion that has not converged in time on either way is none of its own.
        """
        settled = (self.state != "not_settled") & (self.state_down != "not_settled")
        return np.asarray(self.at & settled & ~np.isnan(self.amplitude_down))
