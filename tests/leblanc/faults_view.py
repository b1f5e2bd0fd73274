"""Seeded faults of the three-dimensional pictures: wrong shapes, factors, directions."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.faults import Fault
from tests.leblanc import test_view_picture as picture
from tests.leblanc import test_view_scale as scale
from tests.leblanc import test_view_shapes as shapes
from tests.leblanc import test_view_uneven as uneven


def section_picture() -> None:
    """In a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        uneven.check_picture_of_a_section(Path(folder))


def section_modes() -> None:
    """In a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        uneven.check_modes_of_a_section(Path(folder))


_SURFACES, _SCALE, _BODIES = (f"leblanc.studies.shapes.{name}" for name in ("layer", "scale", "bodies"))
_MARKS, _MODES, _WALLS, _SCENE = (f"leblanc.view.{name}" for name in ("parts", "modes", "walls", "scene"))

FAULTS: tuple[Fault, ...] = (
    Fault(_SURFACES, "farthest**2 - (float(", "farthest**2 + (float(", shapes.check_volume),
    Fault(_SURFACES, "* fall\n", "* fall * 0.9\n", shapes.check_volume),
    Fault(_SURFACES, "line**2 + size**2 - wall**2", "line**2 + size**2 + wall**2", shapes.check_dry_arc),
    Fault(
        _SURFACES,
        "step * (radius + first[:, None])",
        "step * (radius - first[:, None])",
        shapes.check_paraboloid,
    ),
    Fault(
        _SURFACES,
        "chord(chamber.radius, deflection, angle)",
        "chord(chamber.radius, -deflection, angle)",
        shapes.check_centre_of_mass,
    ),
    Fault("leblanc.results.shapes", "np.cross(b, c))) / 6.0", "np.cross(b, c))) / 3.0", shapes.check_volume),
    Fault(
        _SURFACES,
        "chamber.radius - depth[order]",
        "chamber.radius - 0.5 * depth[order]",
        shapes.check_layer_and_pool,
    ),
    Fault(_SURFACES, "np.divide(level - start", "np.divide(level + start", shapes.check_layer_and_pool),
    Fault(
        "leblanc.results.drawing",
        "half - math.sin(half) * math.cos(half)",
        "half + math.sin(half) * math.cos(half)",
        shapes.check_layer_and_pool,
    ),
    Fault(_SURFACES, "-start * math.sin(down)", "start * math.sin(down)", shapes.check_layer_and_pool),
    Fault(
        _SURFACES,
        "np.where(dry[:, None], 0.0,",
        "np.where(dry[:, None], 0.01,",
        shapes.check_no_film_on_a_dry_wall,
    ),
    Fault(
        _SCALE,
        "2.0 * fill.chamber.radius - layer",
        "2.0 * fill.chamber.radius + layer",
        scale.check_drawn_volume,
    ),
    Fault(
        _SCALE,
        "np.where(wet, middle, low), np.where(wet, high, middle)",
        "np.where(wet, low, middle), np.where(wet, middle, high)",
        scale.check_drying_deflection,
    ),
    Fault(_SCALE, "CLEAR * float(here.min())", "2.0 * float(here.min())", scale.check_wet_stays_wet),
    Fault(_SCALE, "return Scale(both, both)", "return Scale(1.0, both)", scale.check_dry_stays_dry),
    Fault(
        "leblanc.studies.shapes.machine",
        "scale.deflection * found if",
        "found if",
        picture.check_liquid_fills_its_walls,
    ),
    Fault(
        "leblanc.view.scene",
        "centre = factor * instant.deflection[k]",
        "centre = instant.deflection[k]",
        picture.check_factor,
    ),
    Fault(
        "leblanc.view.parts",
        "(axial, across.real, across.imag)",
        "(axial, across.imag, across.real)",
        picture.check_spin_and_unbalance,
    ),
    Fault(
        _MARKS,
        "np.linspace(100.0, 150.0, 31)",
        "np.linspace(150.0, 100.0, 31)",
        picture.check_spin_and_unbalance,
    ),
    Fault(
        _MARKS,
        "instant.lean * (shorter - middle)",
        "instant.lean * (ends - middle)",
        picture.check_axis_of_the_drum,
    ),
    Fault(
        _MARKS,
        "start - np.array([0.0, 0.0, 0.3",
        "start + np.array([0.0, 0.0, 0.3",
        picture.check_gravity_points_down,
    ),
    Fault(_MARKS, "half, away = 0.5 * bar_length", "half, away = bar_length", picture.check_scale_bar),
    Fault(
        "leblanc.studies.shapes.machine",
        "(high - low) / np.ptp(planes)",
        "(low - high) / np.ptp(planes)",
        picture.check_axis_of_the_drum,
    ),
    Fault(
        "leblanc.studies.shapes.machine",
        "for place in (-0.5, 0.5)",
        "for place in (0.5, -0.5)",
        picture.check_lean_of_one_chamber,
    ),
    Fault(
        "leblanc.studies.shapes.machine",
        "behind -= height",
        "behind -= 0.0 * height - behind",
        picture.check_chambers_apart,
    ),
    Fault(_MODES, "np.exp(-1j * phase)", "np.exp(1j * phase)", picture.check_mode),
    Fault(_MODES, "size**2 + 2.0 * size * moved", "size**2 - 2.0 * size * moved", picture.check_mode),
    Fault(
        _BODIES, "speed**2 / (2.0 * gravity)", "speed**2 / gravity", uneven.check_surfaces_are_about_the_axis
    ),
    Fault(
        _BODIES,
        "    axis = (-deflection.real, -deflection.imag)",
        "    axis = (deflection.real, -deflection.imag)",
        uneven.check_radius_of_each_compartment,
    ),
    Fault(
        _BODIES,
        "axis=(-deflection.real, -deflection.imag)",
        "axis=(-deflection.real, deflection.imag)",
        uneven.check_surfaces_are_about_the_axis,
    ),
    Fault(
        _BODIES,
        "share = volume / len(meshes)",
        "share = 0.9 * volume / len(meshes)",
        uneven.check_each_compartment_keeps_its_volume,
    ),
    Fault(
        _BODIES,
        "return LiquidBodies(deflection,",
        "return LiquidBodies(0j * deflection,",
        uneven.check_picture_of_compartments,
    ),
    Fault(_BODIES, "np.abs(wall + deflection)", "np.abs(wall - deflection)", uneven.check_dry_walls),
    Fault(_WALLS, "4 * t * (1 - t)", "2 * t * (1 - t)", uneven.check_outline),
    Fault(_WALLS, "4 - 8 * t", "8 * t - 4", uneven.check_outline),
    Fault(_WALLS, "out = -1j * along", "out = 1j * along", uneven.check_outline),
    Fault(
        _WALLS, "np.bincount(number)[number] == 2", "np.bincount(number)[number] == 3", uneven.check_outline
    ),
    Fault(
        _WALLS,
        "np.maximum(np.abs(ends[:, :1]), chamber.inner_radius)",
        "np.abs(ends[:, :1])",
        uneven.check_picture_of_compartments,
    ),
    Fault(_WALLS, "skin * sides.outwards", "0.0 * sides.outwards", section_picture),
    Fault(
        _SCENE,
        "liquid.centre + body.points[:, 0] + 1j",
        "body.points[:, 0] + 1j",
        uneven.check_picture_of_compartments,
    ),
    Fault(
        _SCENE,
        "found |= (np.abs(share.imag)",
        "found &= (np.abs(share.imag)",
        uneven.check_picture_of_compartments,
    ),
    Fault(
        _SCALE,
        "inner = fill.surface_radius + fill.depth - layer",
        "inner = fill.surface_radius - layer",
        uneven.check_a_deeper_layer,
    ),
    Fault(
        _SCALE, "depth * fill.depth if fill.uneven", "3.0 * fill.depth if fill.uneven", uneven.check_dry_walls
    ),
    Fault(_MODES, "np.sqrt(1.0 + 2.0 * moved / away)", "(1.0 + 2.0 * moved / away)", section_modes),
    Fault(
        "leblanc.studies.shapes.modes",
        "share[wall], share[surface] = 0.0, 1.0",
        "share[wall], share[surface] = 1.0, 1.0",
        section_modes,
    ),
    Fault(_MODES, "np.exp(-1j * phase)", "np.exp(2j * phase)", section_modes),
    Fault("leblanc.view.exciter", "sign * size", "0.5 * sign * size", picture.check_table),
)
