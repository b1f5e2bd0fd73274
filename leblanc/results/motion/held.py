"""Motions held in time until they settled."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.netcdf import Variable, finite, flags, pair
from leblanc.core.netcdf import variable as var
from meshes.arrays import Array, Complex, Flags
from solvers.held.state import COUPLED

MOTIONS = ("steady", "periodic", "limit_cycle", "not_settled")
# Liquid models of motions held in time, with what goes round each wall, in words.
HELD_MODELS = {"long_wave": ("long waves", "cells"), "potential": ("exact waves", "nodes")}


@dataclass(frozen=True)
class Held:
    """What rotor and waves do at the speeds at which they were held in time until they settled.

    n speeds, c chambers. At the other speeds numbers are nan and states are "steady".
    """

    at: Flags  #: where that was done, shape (n,)
    state: NDArray[np.str_]  #: one of `MOTIONS`, as met while the speed rises, shape (n,)
    least: Array  #: distance of the axis from where it rests, over time, m, shape (n,)
    largest: Array
    #: of the whirl that goes round beside the spin, in space, nan without one, rad/s, shape (n,)
    whirl_speed: Array
    #: mean of each layer's centre of mass from its chamber's axis, in the drum, m, shape (n, c)
    liquid: Complex
    ripple: Array  #: largest distance of it from that mean, m, shape (n, c)
    error: Array  #: estimated from half the cells, over the largest distance, shape (n,)
    state_down: NDArray[np.str_]  #: while the speed falls, m, shape (n,)
    amplitude_down: Array
    cells: int  #: round each wall
    #: why the motion has not settled, else empty, shape (n,); no entry where that is not known
    reason: NDArray[np.str_] = field(default_factory=lambda: np.zeros(0, dtype="U1"))
    solver: str = COUPLED  #: that held them, by its name in py-pde
    model: str = "long_wave"  #: of the liquid, one of `HELD_MODELS`
    #: estimated from smooth waves under the whirl of a limit cycle, how far long waves are off the exact
    #: ones, relative; nan where there is no whirl or no estimate, shape (n,); no entry where that is not
    #: known
    wave_error: Array = field(default_factory=lambda: np.zeros(0))
    #: what the balance of energy of the last turns leaves, over the largest of the works of unbalance and
    #: drive and of the heats; nan where the solver does not tell it, shape (n,); no entry where not known
    energy_error: Array = field(default_factory=lambda: np.zeros(0))

    @property
    def limit_cycle(self) -> Flags:
        """Where the motion, as met while the speed rises, is bounded but never repeats, shape (n,)."""
        return np.asarray(self.at & (self.state == "limit_cycle"))

    @property
    def waves_not_known(self) -> Flags:
        """Limit cycles of which there is no estimate how far long waves are off, shape (n,)."""
        if not self.wave_error.size or self.model == "potential":
            return np.zeros(self.at.shape, dtype=bool)
        return np.asarray(self.limit_cycle & np.isnan(self.wave_error))

    @property
    def not_settled(self) -> Flags:
        """Where the motion still changed when it was given up, shape (n,)."""
        return np.asarray(self.at & (self.state == "not_settled"))

    @property
    def hysteresis(self) -> Flags:
        """Where the motion depends on whether the speed rises or falls, shape (n,).

        What has not settled on either way is no motion of its own.
        """
        settled = (self.state != "not_settled") & (self.state_down != "not_settled")
        return np.asarray(self.at & settled & ~np.isnan(self.amplitude_down))

    def to_json(self) -> dict[str, Any]:
        """Lists over speed, None (null) where the motion was not held."""
        return {
            "held_at": self.at.tolist(),
            "held_error": finite(self.error),
            "held_wave_error": finite(self.wave_error),
            "held_whirl_speed": finite(self.whirl_speed),
            "liquid_mean": finite(self.liquid),
            "liquid_ripple": finite(self.ripple),
            "amplitude_down": finite(self.amplitude_down),
            "state_down": self.state_down.tolist(),
            "held_reason": self.reason.tolist(),
            "held_solver": self.solver,
            "energy_error": finite(self.energy_error),
        }

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed`, of the layers over `chamber` too."""
        over, each, drum = ("speed",), ("speed", "chamber"), "from the chamber's axis, in the drum"
        down, more = numbered(self.state_down), {}
        if self.wave_error.size:
            text = "of long waves beside exact ones, under the whirl of a limit cycle"
            more["held_wave_error"] = var(over, self.wave_error, "1", "estimated error of the waves", text)
        if self.energy_error.size:
            text = "what the balance of energy of the last turns leaves"
            more["energy_error"] = var(over, self.energy_error, "1", "energy error", text)
        if self.reason.size:
            text = "why the motion has not settled"
            more["held_reason"] = var(over, self.reason, "1", text, "empty where it has, or was not held")
        return {
            "held_at": flags(over, self.at, "no yes", "held", "the motion was held in time until it settled"),
            "held_error": var(
                over, self.error, "1", "estimated error", "of the held motion, by half the cells"
            ),
            "held_whirl_speed": var(
                over, self.whirl_speed, "rad s-1", "whirl speed", "beside the spin, in space"
            ),
            **pair("liquid_mean", each, self.liquid, f"mean of the layer's centre of mass {drum}"),
            "liquid_ripple": var(each, self.ripple, "m", "ripple of the layer's centre of mass", "largest"),
            "amplitude_down": var(over, self.amplitude_down, "m", "amplitude", "while the speed falls"),
            "state_down": flags(
                over, down, " ".join(MOTIONS), "state of the motion", "while the speed falls"
            ),
            "held_solver": var(
                (),
                np.array(self.solver),
                "1",
                "solver",
                "that held the motions, of py-pde unless it is dop853",
            ),
            **more,
        }


def numbered(states: NDArray[np.str_]) -> Array:
    """Motions as numbers of which the last is 1."""
    return np.array([MOTIONS.index(state) - len(MOTIONS) + 2 for state in states.tolist()], dtype=float)
