"""Motions of rotors that tilt, or move differently in two directions."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.core.netcdf import Variable, finite, pair
from leblanc.core.netcdf import variable as var
from meshes.arrays import Complex
from solvers.rotor.campbell import Campbell


@dataclass(frozen=True)
class RestMode:
    """Free vibration of the dry rotor at rest."""

    frequency: float  #: damped, rad/s; 0 where overdamped
    damping_ratio: float  #: 1 where overdamped
    moves: str  #: what moves most, in words


@dataclass(frozen=True)
class Motion:
    """What a rotor that tilts, or moves differently in two directions, adds to a planar one.

    The axis goes round as forward e^{i Omega t} + backward e^{-i Omega t}; the deflections of the response
    are the forward part. s speeds, b branches, c chambers.
    """

    position: float  #: along the axis of the plane reported, m
    backward: NDArray[np.complex128]  #: m, shape (s,)
    backward_dry: NDArray[np.complex128]
    branch_backward: NDArray[np.complex128]  #: m, shape (s, b)
    chamber_forward: NDArray[np.complex128]  #: at each chamber, m, shape (s, c)
    modes: tuple[RestMode, ...]  #: of the dry rotor at rest, by rising frequency
    campbell: Campbell  #: natural frequencies of the dry rotor over its speed
    #: undamped, each with the direction of its whirl, -1 to 1
    critical_speeds_dry: tuple[tuple[float, float], ...]
    critical_speeds_wet: tuple[tuple[float, float], ...]
    zero: str  #: what angles count from, in words
    #: as chamber_forward, at the refined speeds; none if empty, shape (r, c)
    refined_forward: Complex = field(default_factory=lambda: np.zeros((0, 0), dtype=complex))

    @property
    def natural_frequency(self) -> list[float]:
        """Of each mode of the dry rotor at rest, rad/s."""
        return [mode.frequency for mode in self.modes]

    @property
    def natural_damping_ratio(self) -> list[float]:
        """Of each of these modes."""
        return [mode.damping_ratio for mode in self.modes]

    def to_json(self) -> dict[str, Any]:
        """Plain values; critical speeds as [rad/s, direction of the whirl]."""
        return {
            "position": self.position,
            "backward": finite(self.backward),
            "chamber_deflection": finite(self.chamber_forward),
            "natural_frequency": self.natural_frequency,
            "natural_damping_ratio": self.natural_damping_ratio,
            "critical_speeds_dry": [list(speed) for speed in self.critical_speeds_dry],
            "critical_speeds_wet": [list(speed) for speed in self.critical_speeds_wet],
        }

    def variables(self) -> dict[str, Variable]:
        """Arrays over `speed`; dimensions `mode` and `chamber` come with them."""
        over, each, rate = ("speed",), ("speed", "branch"), "rad s-1"
        c, against = self.campbell, "turning against the spin"
        by_spin = ("spin", "mode")
        at_rest = np.array([(mode.frequency, mode.damping_ratio) for mode in self.modes]).reshape(-1, 2)
        sense = "-1 against the spin to 1 with it"
        return {
            **pair("backward", over, self.backward, f"part of the deflection {against}"),
            **pair("backward_dry", over, self.backward_dry, f"part {against}, without liquid"),
            **pair("branch_backward", each, self.branch_backward, f"part of every branch {against}"),
            **pair("chamber", ("speed", "chamber"), self.chamber_forward, "deflection at each chamber"),
            "position": var((), self.position, "m", "position", "of the plane reported, along the axis"),
            "spin": var(("spin",), c.spin, rate, "spin speed", "of the Campbell diagram"),
            "campbell_frequency": var(
                by_spin, c.frequency, rate, "natural frequency", "damped, without liquid"
            ),
            "campbell_damping_ratio": var(by_spin, c.damping_ratio, "1", "damping ratio", "without liquid"),
            "campbell_direction": var(by_spin, c.direction, "1", "direction of the whirl", sense),
            "natural_frequency": var(
                ("rest_mode",), at_rest[:, 0], rate, "natural frequency", "at rest, dry"
            ),
            "natural_damping_ratio": var(("rest_mode",), at_rest[:, 1], "1", "damping ratio", "at rest, dry"),
        }
