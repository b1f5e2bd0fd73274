"""The free surface in its limits: clear of the wall, at rest, weightless, thin, empty, full; bad requests."""

from __future__ import annotations

import math

import pytest

from meshes.errors import InputError
from meshes.section import disc, section_area
from solvers.statics.free_surface import default_disc, integrate_surface, optimal_volume_fem, solve_surface
from tests.mutants import kills
from tests.solvers.statics.test_free_surface import HEIGHT, RADIUS, agree, beta_of, values


@kills("solvers.statics.free_surface:_integral", 'w["x"][0] - plan.axis[0]', 'w["x"][0] + plan.axis[0]')
@kills(
    "solvers.statics.free_surface:solve_surface",
    "-height * (floor / plan.ramp)",
    "height * (floor / plan.ramp)",
)
@kills(
    "solvers.statics.free_surface:solve_surface",
    "height * (below / plan.ramp)",
    "height * (floor / plan.ramp)",
)
@kills(
    "solvers.statics.free_surface:solve_surface", "math.sqrt(max(floor, 0.0))", "math.sqrt(max(below, 0.0))"
)
def test_clear_surface() -> None:
    """Clear of the wall the air is a body about the axis: the chamber minus it in closed form.

    C = h/2 - beta (A - V/h)/pi for a section of area A, and the unbalance is that of the full chamber, A h e.
    """
    for order in (1, 2):
        section = disc(RADIUS, 24, order=order)
        area = section_area(section)
        for speed, volume, e in ((30.0, 0.8 * area * HEIGHT, 0.01), (300.0, 0.3 * area * HEIGHT, 0.02)):
            beta = beta_of(speed)
            solution = solve_surface(section, HEIGHT, beta, volume, axis=(-e, 0.0))
            constant = HEIGHT / 2 - beta * (area - volume / HEIGHT) / math.pi
            assert solution.surface_constant == pytest.approx(constant, rel=1e-9)
            assert float(solution.moments.x) == pytest.approx(area * HEIGHT * e, rel=1e-8)
            wetted = beta * (RADIUS + e) ** 2 + constant
            assert solution.wetted_height == pytest.approx(wetted, rel=1e-9)
            assert solution.dry_radius == pytest.approx(math.sqrt(-constant / beta), rel=1e-9)


@kills(
    "solvers.statics.free_surface:integrate_surface",
    "plan.ramp * (wetted_height / height)",
    "plan.ramp * wetted_height",
)
@kills("solvers.statics.free_surface:_all_moments", "0.5 * depth * depth", "depth * depth")
@kills(
    "solvers.statics.free_surface:_all_moments", "depth * depth * depth / 3.0", "depth * depth * depth / 2.0"
)
def test_flat_surface() -> None:
    """At rest the liquid is a plate V/A thick, whatever the axis."""
    section = disc(RADIUS, 24)
    area = section_area(section)
    level, e = 0.3 * HEIGHT, 0.4
    solution = solve_surface(section, HEIGHT, 0.0, level * area, axis=(-e, 0.0))
    assert solution.wetted_height == pytest.approx(level, rel=1e-12)
    assert solution.surface_constant == pytest.approx(level, rel=1e-12)
    assert solution.dry_radius == 0.0
    moments = solution.moments
    assert float(moments.x) == pytest.approx(area * level * e, rel=1e-12)
    assert float(moments.z) == pytest.approx(area * level**2 / 2, rel=1e-12)
    assert float(moments.zz) == pytest.approx(area * level**3 / 3, rel=1e-12)
    assert float(moments.xz) == pytest.approx(area * level**2 / 2 * e, rel=1e-12)
    again = integrate_surface(section, HEIGHT, 0.0, level, axis=(-e, 0.0))
    assert values(again) == pytest.approx(values(moments), rel=1e-12)


def test_no_gravity_is_the_limit_of_fast_spin() -> None:
    """The surface becomes the circle V = h (A - pi a^2); it is reached like the ramp h/(beta r^2)."""
    section, e = disc(RADIUS, 32, order=2), 0.003
    area = section_area(section)
    solution = solve_surface(section, HEIGHT, math.inf, 0.3 * area * HEIGHT, axis=(-e, 0.0))
    assert solution.dry_radius == pytest.approx(math.sqrt(0.7 * area / math.pi), rel=1e-9)
    assert solution.wetted_height == math.inf
    assert solution.surface_constant == -math.inf
    # z is h/2 over the liquid, exactly so only in the limit.
    assert float(solution.moments.z) == pytest.approx(0.3 * area * HEIGHT**2 / 2, rel=1e-9)
    for beta in (1e6, 1e9, 1e14):
        fast = solve_surface(section, HEIGHT, beta, 0.3 * area * HEIGHT, axis=(-e, 0.0))
        agree(fast.moments, solution.moments, 1e-9 + HEIGHT / (beta * RADIUS**2), RADIUS)


def test_thin_films() -> None:
    """Weightless and centred, the liquid of an octagon retires into its corners: wedges in closed form."""
    section, b = disc(RADIUS, 8), math.pi / 8
    corner = 0.5 * RADIUS**2 * math.sin(2 * b)  # a triangle of the polygon
    for depth in (1e-2, 1e-4, 1e-6):
        a = RADIUS * (1.0 - depth)
        # Half the angle over which a side runs inside the circle r = a; half the angle of the side is b.
        inner = math.acos(min(1.0, RADIUS * math.cos(b) / a))
        inside = a**2 * (b - inner) + a**2 * math.sin(inner) * math.cos(inner)
        volume = 8 * (corner - inside) * HEIGHT
        solution = solve_surface(section, HEIGHT, math.inf, volume)
        # The closed form itself loses its digits like 1e-16/depth^2.
        assert RADIUS - solution.dry_radius == pytest.approx(RADIUS * depth, rel=1e-9 + 1e-15 / depth**2)


def test_empty_and_full() -> None:
    section = disc(RADIUS, 16)
    capacity = section_area(section) * HEIGHT
    for beta in (0.0, beta_of(1.0), beta_of(90.0), math.inf):
        empty = solve_surface(section, HEIGHT, beta, 0.0, axis=(-0.01, 0.0))
        assert values(empty.moments) == pytest.approx(0.0, abs=0.0)
        full = solve_surface(section, HEIGHT, beta, capacity, axis=(-0.01, 0.0))
        assert full.converged
        assert float(full.moments.volume) == pytest.approx(capacity, rel=1e-14)
        assert full.dry_radius == 0.0
        with pytest.raises(InputError, match="what the section holds"):
            solve_surface(section, HEIGHT, beta, capacity * (1.0 + 1e-9), axis=(-0.01, 0.0))


@pytest.mark.parametrize(
    ("wrong", "field"),
    [
        ({"height": 0.0}, "height"),
        ({"beta": -1.0}, "beta"),
        ({"beta": math.nan}, "beta"),
        ({"axis": (0.0, math.inf)}, "axis"),
        ({"wetted_height": math.nan}, "wetted_height"),
        ({"wetted_height": None}, "wetted_height"),
        ({"dry_radius": 0.1}, "wetted_height"),
        ({"beta": math.inf}, "wetted_height"),
        ({"wetted_height": None, "dry_radius": -0.1}, "dry_radius"),
    ],
)
def test_bad_surfaces_are_refused(wrong: dict[str, object], field: str) -> None:
    right = {"height": HEIGHT, "beta": 1.0, "wetted_height": 0.01, "axis": (0.0, 0.0)}
    with pytest.raises(InputError) as fault:
        integrate_surface(disc(RADIUS, 8), **(right | wrong))  # type: ignore[arg-type]
    assert fault.value.field == field


def test_bad_requests_are_refused() -> None:
    with pytest.raises(InputError, match="volume"):
        solve_surface(disc(RADIUS, 8), HEIGHT, 1.0, -1e-9)
    with pytest.raises(InputError, match="volume"):
        solve_surface(disc(RADIUS, 8), HEIGHT, 1.0, math.nan)
    for e in (-0.01, math.inf, math.nan):
        with pytest.raises(InputError, match="eccentricity"):
            optimal_volume_fem(RADIUS, HEIGHT, e, 1.0)
    with pytest.raises(InputError, match="layer"):
        default_disc(RADIUS, -0.1)
