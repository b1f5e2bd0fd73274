"""Small waves in any section as a liquid model, by finite elements [theory: sloshing, eq. 13-16]."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING, ClassVar

import numpy as np

from fluid.fill import Fill, Fills
from fluid.whirl import is_full
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection, liquid_of
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

if TYPE_CHECKING:
    from meshes.liquid_section import LiquidSection

# Of the mass that a clear ring adds at rest, by the usual cells: 7e-8 at most, whatever the depth.
REST_ERROR = 1e-7
_MOST_CELLS = 600  # around; the matrices of the free surface are dense
_ACROSS = 6


@dataclass(frozen=True)
class SmallWaves(WaveModel):
    """Small waves without friction in a ring, with baffles or without, in the drum's frame.

    In a synchronous whirl the liquid is at rest in the drum, and all that the elements have to find is the
    mass that it adds: once for each shape of the liquid, whatever the speed and the deflection.

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
        """See `WaveModel`; the error is that of the elements, the added mass being known analytically."""
        added = self.added_mass(fills)
        known = fills.added_mass
        error = np.divide(np.abs(added - known), known, out=np.zeros_like(known), where=known > 0.0)
        return added_mass_answer(fills, whirls, error, added)

    def added_mass(self, fills: Fills) -> Array:
        """See `LiquidModel`: by elements on the liquid of each fill that has a free surface."""
        asked = {int(k): self._added_mass(fills.origin[int(k)]) for k in np.unique(fills.which)}
        return np.array([asked[int(k)] for k in fills.which])

    def _added_mass(self, fill: Fill) -> float:
        """Of one fill; liquid without a free surface goes with its chamber."""
        chamber, inner = fill.chamber, fill.surface_radius
        if is_full(fill) or inner <= 0.0:
            return fill.added_mass
        if chamber.section is not None:
            area = _section_at_rest(chamber.section, inner)
        else:
            baffles = chamber.baffles if fill.uneven else None
            radius = chamber.radius
            if baffles is not None:
                baffles = Baffles(baffles.count, baffles.tip_radius / radius, baffles.wall_gap / radius)
            area = radius**2 * _ring_at_rest(inner / radius, baffles, self.cells)
        return fill.liquid.density * chamber.height * area

    def linear_limit(self, fills: Fills, speed: Array, gravity: Array) -> Array:
        """Infinite: the law is a straight line."""
        return np.full(speed.shape, np.inf)

    def wave(self, fill: Fill, whirl: Whirl) -> LiquidWave:
        """The part of the answer that turns with the whirl, see `WaveModel`.

        Depths are those at an instant when the deflection lies along the first baffle.
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


@lru_cache(maxsize=1024)
def _ring_at_rest(surface_radius: float, baffles: Baffles | None, cells: int) -> float:
    """Area whose liquid would weigh as much as a ring of unit radius adds, by elements."""
    from meshes.rings.quadrilaterals import ring

    return _at_rest(ring(1.0, surface_radius, cells, _ACROSS, baffles=baffles))


@lru_cache(maxsize=256)
def _section_at_rest(section: ChamberSection, surface_radius: float) -> float:
    """The same of a section of its own, m^2."""
    return _at_rest(liquid_of(section, surface_radius))


def _at_rest(mesh: LiquidSection) -> float:
    """Mean over all directions of A + P B^-1 P^T, in the mesh's unit squared [theory: sloshing, eq. 13]."""
    from solvers.sloshing.system import condense

    system = condense(mesh)
    moved = system.moment @ np.linalg.solve(system.surface, system.moment.T)
    return float(system.liquid_area + 0.5 * np.trace(moved))


def _profile(points: Array, displacement: Array) -> tuple[Array, Array]:
    """Displacement of the surface at the angles of a profile, from that at its nodes."""
    theta = angles()
    at = np.arctan2(points[:, 1], points[:, 0])
    order = np.argsort(at, kind="stable")
    return theta, np.interp(theta, at[order], displacement[order], period=2.0 * math.pi)
