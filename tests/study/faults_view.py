"""Seeded faults of the three-dimensional pictures: wrong shapes, factors, directions."""

from __future__ import annotations

from tests.faults import Fault
from tests.study import test_view_picture as picture
from tests.study import test_view_scale as scale
from tests.study import test_view_shapes as shapes

_SURFACES, _SCALE, _MARKS, _MODES = (f"study.view_{name}" for name in ("surfaces", "scale", "marks", "modes"))

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
    Fault(_SURFACES, "np.cross(b, c))) / 6.0", "np.cross(b, c))) / 3.0", shapes.check_volume),
    Fault(
        _SURFACES,
        "chamber.radius - depth[order]",
        "chamber.radius - 0.5 * depth[order]",
        shapes.check_layer_and_pool,
    ),
    Fault(_SURFACES, "np.divide(level - start", "np.divide(level + start", shapes.check_layer_and_pool),
    Fault(
        _SURFACES,
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
        "study.view_still", "scale.deflection * found if", "found if", picture.check_liquid_fills_its_walls
    ),
    Fault(
        "study.view_scene",
        "centre = factor * instant.deflection[k]",
        "centre = instant.deflection[k]",
        picture.check_factor,
    ),
    Fault(
        "study.view_parts",
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
        "study.view_answer",
        "(high - low) / np.ptp(planes)",
        "(low - high) / np.ptp(planes)",
        picture.check_axis_of_the_drum,
    ),
    Fault(
        "study.view_answer",
        "for place in (-0.5, 0.5)",
        "for place in (0.5, -0.5)",
        picture.check_lean_of_one_chamber,
    ),
    Fault(
        "study.view_answer",
        "behind -= height",
        "behind -= 0.0 * height - behind",
        picture.check_chambers_apart,
    ),
    Fault(_MODES, "np.exp(-1j * phase)", "np.exp(1j * phase)", picture.check_mode),
    Fault(_MODES, "size**2 + 2.0 * size * moved", "size**2 - 2.0 * size * moved", picture.check_mode),
    Fault("study.view_exciter", "sign * size", "0.5 * sign * size", picture.check_table),
)
