"""A layer's answer to one prescribed whirl by finite elements, with baffles in the layer or without."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from fluid.fill import Fill
from meshes.border import InputError
from solvers.prescribed import Whirl
from study.friction import Friction
from study.layer_answer import LayerAnswer, angles
from study.validity import judge, strained

Array = NDArray[np.float64]
Complex = NDArray[np.complex128]

MOST_CELLS = 600  # around; the matrices of the free surface are dense
_ACROSS = 6
_ONE_WAY = 1e-6  # part of the answer that may go the other way round before it is worth a note


def fem_answer(fill: Fill, whirl: Whirl, friction: Friction, cells: int) -> LayerAnswer:
    """Forced response of the liquid in the drum's frame [theory: sloshing, eq. 13-16].

    Parameters
    ----------
    fill : chamber and liquid
    whirl : of its axis
    friction : none
    cells : around the liquid, at least

    Returns
    -------
    The part of the answer that turns with the whirl; depths at an instant when the deflection lies along the
    first baffle.

    Raises
    ------
    InputError : friction, gravity, a full chamber, too many cells
    """
    _check(fill, whirl, friction, cells)
    from meshes.polar import ring
    from solvers.sloshing_forced import FORWARD, displacement_field, newton_force
    from solvers.sloshing_shapes import surface_displacement
    from solvers.sloshing_system import condense

    chamber, inner = fill.chamber, fill.surface_radius
    system = condense(ring(chamber.radius, inner, cells, _ACROSS, baffles=chamber.baffles))
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
    validity = judge("linear", fill, whirl, {"wave_amplitude": height / fill.depth})
    notes = [*strained(validity)]
    if abs(counter) > _ONE_WAY * abs(onward):
        share = abs(counter) / abs(onward)
        notes.append(f"the liquid also answers against the whirl, {share:.3g} times as strongly")
    if inner - height < chamber.inner_radius:
        notes.append("the surface reaches the inner wall")
    theta, drawn = _profile(system.section.points[nodes], displacement)
    return LayerAnswer(
        force_ratio=complex(onward / (pull * system.enclosed_area)),
        offset=offset,
        mass_error=abs(system.liquid_area * chamber.height / fill.volume - 1.0),
        converged=bool(np.isfinite(onward)),
        in_range=not notes,
        mean_rotation=0.0,
        wall_time=0.0,
        theta=theta,
        depth=np.clip(chamber.radius - inner - drawn, 0.0, chamber.radius),
        notes=tuple(notes),
        gravity_offset=0.0,
        captured=True,
        validity=validity,
    )


def _check(fill: Fill, whirl: Whirl, friction: Friction, cells: int) -> None:
    if friction.law != "none":
        raise InputError("--friction", friction.law, "none for finite elements, which are inviscid")
    if whirl.gravity != 0.0:
        raise InputError("--gravity", whirl.gravity, "0 for finite elements; --model linear has it")
    chamber = fill.chamber
    if fill.depth >= chamber.radius * (1.0 - 1e-9) or fill.surface_radius <= chamber.inner_radius:
        raise InputError("--volume", fill.volume, "less than what fills the chamber, for a free surface")
    if not 8 <= cells <= MOST_CELLS:
        raise InputError("--cells", cells, f"8 to {MOST_CELLS} for finite elements")


def _profile(points: Array, displacement: Array) -> tuple[Array, Array]:
    """Displacement of the surface at the angles of a profile, from that at its nodes."""
    theta = angles()
    at = np.arctan2(points[:, 1], points[:, 0])
    order = np.argsort(at, kind="stable")
    return theta, np.interp(theta, at[order], displacement[order], period=2.0 * math.pi)
