"""Small waves in any section as a liquid model, by finite elements [theory: sloshing, eq. 13-16]."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from fluid.fill import Fill, Fills
from meshes.arrays import Array
from meshes.errors import InputError
from solvers.liquid_model import (
    CAPTURED,
    THIN_LAYERS,
    LiquidAnswer,
    LiquidWave,
    Range,
    WaveModel,
    Whirl,
    Whirls,
    added_mass_answer,
    angles,
    kept_limits,
    numbers_of,
    whirl_answer,
)

_MOST_CELLS = 600  # around; the matrices of the free surface are dense
_ACROSS = 6


@dataclass(frozen=True)
class SmallWaves(WaveModel):
    """Small waves without friction in a ring, with baffles or without, in the drum's frame.

    A synchronous whirl, in which the liquid is at rest, is known without elements: a layer adds the mass of
    its section, less what its compartments keep [theory: sections, eq. 8].

    Parameters
    ----------
    cells : around the liquid, at least

    Raises
    ------
    InputError : too few or too many cells
    """

    cells: int = 96

    name = "fem"
    takes_baffles = True
    ranges: ClassVar[Mapping[str, Range]] = {
        "wave_amplitude": (0.0, 0.3), "centrifuge": CAPTURED, "wall_layer": THIN_LAYERS,
    }  # fmt: skip

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= _MOST_CELLS:
            raise InputError("cells", self.cells, f"8 to {_MOST_CELLS} for finite elements")

    def at_rest(self, fills: Fills, whirls: Whirls) -> LiquidAnswer:
        """See `WaveModel`."""
        return added_mass_answer(fills, whirls)

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Infinite: the law is a straight line."""
        return np.full(speed.shape, np.inf)

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """See `WaveModel`: the part of the answer that turns with the whirl.

        Depths are those at an instant when the deflection lies along the first baffle.

        Raises
        ------
        InputError : gravity across the axis, no free surface, a section of its own
        """
        self._require(fill, whirl)
        from meshes.rings.quadrilaterals import ring
        from solvers.sloshing.forced import FORWARD, displacement_field, newton_force
        from solvers.sloshing.modes import surface_displacement
        from solvers.sloshing.system import condense

        chamber, inner = fill.chamber, fill.surface_radius
        system = condense(ring(chamber.radius, inner, self.cells, _ACROSS, baffles=chamber.baffles))
        pull = whirl.speed**2 * whirl.amplitude or 1.0  # without any amplitude the limit of the ratio
        force = (pull * FORWARD).astype(complex)
        field = displacement_field(system, whirl.spin, whirl.slip, force)
        total = newton_force(system, whirl.spin, whirl.slip, force, field)
        moment = -(system.moment @ field) / system.liquid_area
        onward, counter = 0.5 * (total @ FORWARD.conj()), 0.5 * (total @ FORWARD)
        nodes, moved = surface_displacement(system.section, system.on_nodes(field[None]))
        displacement = moved[0].real * (whirl.amplitude > 0.0)
        offset = complex(0.5 * (moment @ FORWARD.conj())) if whirl.amplitude > 0.0 else 0j
        height = float(np.abs(displacement).max())
        numbers = numbers_of(fill, whirl, {"wave_amplitude": height / fill.depth})
        theta, drawn = _profile(system.section.points[nodes], displacement)
        answer = whirl_answer(
            fill,
            whirl,
            force_ratio=complex(onward / (pull * system.enclosed_area)),
            offset=offset,
            limits=kept_limits(numbers, self.ranges) | {"inner_wall": inner - height >= chamber.inner_radius},
            dry_patch=height > fill.depth,
            converged=bool(np.isfinite(onward)),
            small=True,
        )
        return LiquidWave(
            answer=answer,
            theta=theta,
            depth=np.clip(chamber.radius - inner - drawn, 0.0, chamber.radius),
            numbers=numbers,
            ranges=self.ranges,
            mass_error=abs(system.liquid_area * chamber.height / fill.volume - 1.0),
            counter=float(abs(counter) / abs(onward)) if abs(onward) > 0.0 else 0.0,
        )

    def _require(self, fill: Fill, whirl: Whirl) -> None:
        """Refuse what these equations do not have."""
        chamber = fill.chamber
        if whirl.gravity != 0.0:
            raise InputError("gravity", whirl.gravity, "0 for finite elements; linear theory has it")
        if chamber.section is not None:
            raise InputError("section", chamber.section.name, "none: a ring, with baffles or without")
        if fill.depth >= chamber.radius * (1.0 - 1e-9) or fill.surface_radius <= chamber.inner_radius:
            allowed = "less than what fills the chamber, for a free surface"
            raise InputError("volume", fill.volume, allowed)


def _profile(points: Array, displacement: Array) -> tuple[Array, Array]:
    """Displacement of the surface at the angles of a profile, from that at its nodes."""
    theta = angles()
    at = np.arctan2(points[:, 1], points[:, 0])
    order = np.argsort(at, kind="stable")
    return theta, np.interp(theta, at[order], displacement[order], period=2.0 * math.pi)
