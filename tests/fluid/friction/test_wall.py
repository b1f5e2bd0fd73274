"""The law of the wall for a layer against the laws it is made of, and its limits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.friction.laws import QUADRATIC, Friction, damping_rate, plate_factor
from fluid.friction.pipe import drag_speed, friction_factor, hydraulic_diameter
from fluid.friction.wall import WallDrag, drag_table, mean_rates, wall_drag, wall_shear, wave_rates
from fluid.waves import free_wave_frequencies
from meshes.errors import InputError
from tests.mutants import kills

RADIUS, DEPTH, HEIGHT, NU, SPIN = 0.15, 0.015, 0.05, 1e-6, 40.0


def drag(friction: Friction = Friction("wall"), nu: float = NU, slip: float = 9.4) -> WallDrag:  # type: ignore[arg-type]  # noqa: B008
    return wall_drag(friction, nu, DEPTH, RADIUS, HEIGHT, slip, SPIN)


def layer(count: int = 64) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    theta = np.linspace(0.0, 2.0 * np.pi, count, endpoint=False)
    depth = 0.1 + 0.03 * np.cos(theta)
    return depth, depth * (1.0 - 0.5 * depth), -3.0 + 2.0 * np.cos(theta - 0.4)


@pytest.mark.parametrize(("nu", "rough"), [(1e-6, 0.0), (1e-6, 2e-6), (1e-6, 1e-3), (1e-3, 0.0), (0.0, 1e-5)])
def test_the_table_is_the_formula(nu: float, rough: float) -> None:
    """To 1e-4 over eight decades of the velocity: what the number of its steps was chosen for."""
    diameter = float(hydraulic_diameter(DEPTH, HEIGHT))
    top, table = drag_table(diameter, nu, rough)
    velocity = np.geomspace(1e-6, 1.0, 20001) * top
    known = WallDrag(0.0, 0.0, 0.0, 0.0, top, table)
    found = mean_rates(known, 1.0, 0.0, velocity)
    np.testing.assert_allclose(found, drag_speed(velocity, diameter, nu, rough), rtol=1e-4)


@kills("fluid.friction.wall:mean_rates", "(1.0 - np.asarray(area))", "1.0")
@kills("fluid.friction.wall:mean_rates", "+ drag.lid", "+ 0.5 * drag.lid")
@kills("fluid.friction.wall:drag_table", "root**4", "root**3")
def test_an_even_layer_is_slowed_as_a_channel() -> None:
    """(f_D/2) u/D_h for liquid that turns as a whole with the lag u/(R (1 - A))."""
    depth = DEPTH / RADIUS
    area, lag = depth * (1.0 - 0.5 * depth), 12.0
    found = mean_rates(drag(), depth, area, -lag * (1.0 - area))
    diameter = 4.0 * DEPTH * HEIGHT / (HEIGHT + 2.0 * DEPTH)
    factor = float(friction_factor(lag * RADIUS * diameter / NU))
    # The table's 1e-4.
    assert found == pytest.approx(0.5 * factor * lag * RADIUS / diameter, rel=2e-4)


@kills("fluid.friction.wall:wave_rates", "1.0 + drag.plates * h", "1.0 + drag.lid * h")
@kills("fluid.friction.laws:plate_factor", "abs(twice - slow)", "abs(twice)")
@kills("fluid.friction.laws:plate_factor", "0.5 * (math", "1.0 * (math")
def test_small_waves_decay_at_the_rates_of_the_thin_layer() -> None:
    """Amplitudes of the free waves with one crest, as known from the exact modes: 0.135 and 0.286 1/s.

    The energy's loss over twice the energy. Exact modes move less at the wall than long waves by some h/R,
    a tenth here.
    """
    area = 0.1 * 0.95
    tanh = (1.0 - 0.81) / (1.0 + 0.81)
    for frequency, wanted, plain in zip(
        np.abs(free_wave_frequencies(1, math.log(1.0 / 0.9), SPIN)),
        (0.286, 0.135),
        (0.201, 0.077),
        strict=True,
    ):
        slip = float(frequency)
        # [theory: whirl, eq. 9] to first order in k: half of it, and what the wave's turning adds.
        sense = 1.0 if slip > 15.0 else -1.0
        share = 0.5 * (1.0 + sense * tanh / math.sqrt(tanh**2 + tanh))
        rate = float(wave_rates(drag(slip=slip)._replace(thin=0.0), 0.1, area))
        assert rate * share == pytest.approx(wanted, rel=0.11)
        k = float(damping_rate(2, math.sqrt(NU * slip / 2.0) / RADIUS, 2.0 * RADIUS / HEIGHT, 0.1, area, 0.0))
        assert k * share == pytest.approx(plain, rel=0.11)
        # What the correction adds, alike in both: the errors of the long waves cancel.
        assert rate / k == pytest.approx(wanted / plain, rel=0.03)


def test_the_plates_without_rotation_are_the_wall() -> None:
    assert plate_factor(10.0, 0.0) == 1.0
    # At the frequency 2 Omega one circle has no oscillating layer: sqrt(2)/2 of the other.
    assert plate_factor(80.0, 40.0) == pytest.approx(math.sqrt(0.5), rel=1e-12)
    assert plate_factor(-9.0, 40.0) == plate_factor(9.0, 40.0)


@kills("fluid.friction.wall:wall_shear", "waves * (velocity - mean)", "waves * velocity")
@kills("fluid.friction.wall:wall_shear", "weight = waves * area", "weight = area")
def test_waves_exert_no_torque_on_the_layer() -> None:
    depth, area, velocity = layer()
    whole, held = drag(), mean_rates(drag(), depth, area, velocity) * area * velocity
    # Torque of both parts is that of the mean part: to rounding.
    assert wall_shear(whole, depth, area, velocity).sum() == pytest.approx(held.sum(), rel=1e-12)
    assert np.abs(wall_shear(whole, depth, area, velocity) - held).max() > 0.01 * np.abs(held).max()


@kills("fluid.friction.wall:wave_rates", "h / (h + drag.thin)", "1.0")
def test_a_film_has_no_stokes_layer() -> None:
    """Far below the layer's thickness the rate stays at that of a film which oscillates as a whole, s/2."""
    depth, slip = 1e-7, 9.4
    found = float(wave_rates(drag(slip=slip), depth, depth))
    assert found == pytest.approx(0.5 * slip, rel=1e-3)


def test_rough_walls_meet_the_quadratic_law() -> None:
    """Without viscosity c_f = f_D/8, the thin layer's factor (1 - A)(1 - h/2) of geometry apart."""
    rough, area, h, u = 1e-4, 0.095, 0.1, 7.0
    known = wall_drag(Friction("wall", roughness=rough), 0.0, DEPTH, RADIUS, math.inf, 9.4, SPIN)  # type: ignore[arg-type]
    factor = float(friction_factor(math.inf, rough / (4.0 * DEPTH)))
    wanted = float(damping_rate(QUADRATIC, factor / 8.0, 0.0, h, area, u))
    found = float(mean_rates(known, h, area, u))
    assert found == pytest.approx(wanted * (1.0 - 0.5 * h) / (1.0 - area), rel=1e-6)
    assert known.coefficient == 0.0


def test_other_units_of_time_are_the_same_friction() -> None:
    depth, area, velocity = layer()
    here = drag()
    there = here._replace(coefficient=here.coefficient / SPIN, top=here.top / SPIN)
    found = wall_shear(there, depth, area, velocity / SPIN) * SPIN**2
    np.testing.assert_allclose(found, wall_shear(here, depth, area, velocity), rtol=1e-12)


def test_roughness_belongs_to_the_law_of_the_wall() -> None:
    with pytest.raises(InputError, match="roughness"):
        Friction("stokes", roughness=1e-6)  # type: ignore[arg-type]
    with pytest.raises(InputError, match="friction"):
        Friction("wall", roughness=-1e-6)  # type: ignore[arg-type]
