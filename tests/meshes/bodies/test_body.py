"""Bodies of liquid: volume and first moments against quadrature and closed forms, orders, valid cells."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mpf

from meshes.bodies.body import WALL_PARTS, Body, body_integrals, body_jacobians
from meshes.bodies.paraboloid import paraboloid_body
from meshes.bodies.wave import wave_body
from meshes.errors import InputError
from meshes.rings.sectors import sector
from meshes.section import annulus, disc
from solvers.statics.free_surface import integrate_surface, solve_surface
from tests.mutants import kills
from tests.oracles.statics import LiquidReference, liquid_reference

R, H = 0.2, 0.05

# beta, C, e: floor and lid cut; the side wall dry on one side; floor covered; lid dry; at rest.
SURFACES = [
    (20.0, -0.2, 0.02),
    (20.0, -0.62, 0.02),
    (1.0, 0.02, 0.03),
    (0.5, 0.01, 0.02),
    (2.0, -0.075, 0.01),
    (0.0, 0.02, 0.01),
]


@lru_cache
def reference(beta: float, constant: float, e: float) -> LiquidReference:
    return liquid_reference(R, H, e, mpf(beta), mpf(constant))


def errors(beta: float, constant: float, e: float, segments: int, order: int) -> np.ndarray:
    """Relative errors of volume, first moment about the axis and height of the centre of mass."""
    section = disc(R, segments, order=order)
    size = 2 * math.pi * R / segments
    body = paraboloid_body(section, H, beta, constant, axis=(-e, 0.0), size=size, order=order)
    assert body_jacobians(body.points, body.cells).min() > 0.0
    found = body_integrals(body)
    exact = reference(beta, constant, e)
    # The first moment is seen against the lever of the wall, where the thin liquid is.
    lever = float(exact.volume) * R
    return np.array(
        [
            found.volume / float(exact.volume) - 1.0,
            (found.x + e * found.volume - float(exact.x)) / lever,
            found.z / float(exact.z) - 1.0,
            found.y / lever,
        ]
    )


@kills("meshes.bodies.body:_tetrahedra", "start = np.where(empty[column[:, c]], high, low)", "start = low")
@kills(
    "meshes.bodies.paraboloid:_squares",
    "(-constant / beta, height / beta)",
    "(constant / beta, height / beta)",
)
@kills(
    "meshes.bodies.paraboloid:_depth_share", "(square - floor) / ramp, 0.0", "(floor - square) / ramp, 0.0"
)
def test_paraboloid() -> None:
    """Volume and moments of every case against quadrature in high precision.

    Depth is quadratic and meets the nodes. Where an arc of length s bends a cell, by s^2/(8 r), it is off by
    2 beta s times that, 2/15 of it on the average: with s = 0.02, r = 0.19 and beta = 2 a ten-thousandth of
    the centimetre that the thinnest of these liquids is deep, if all of it lay along waterlines.
    """
    for beta, constant, e in SURFACES:
        found = errors(beta, constant, e, 64, 2)
        assert np.abs(found).max() < 1e-4


@pytest.mark.parametrize(("order", "expected"), [(1, 2.0), (2, 4.0)])
@pytest.mark.parametrize(
    ("beta", "constant", "e"), [(2.0, -0.02, 0.02), (1.0, -0.01, 0.03), (1.0, 0.02, 0.03), (0.5, 0.01, 0.02)]
)
def test_order_of_the_body(order: int, expected: float, beta: float, constant: float, e: float) -> None:
    """Over a factor of 3 in size, less than the distance between the waterlines.

    Edges come out up to twice as short as asked for, which moves the slope by log(2^p)/log(3^p) at the very
    worst; it is allowed less than half of that.
    """
    coarse, fine = (np.abs(errors(beta, constant, e, n, order)).max() for n in (40, 120))
    slope = math.log(coarse / fine) / math.log(3.0)
    assert slope == pytest.approx(expected, abs=0.25 * expected)


@kills("meshes.bodies.paraboloid:_upright_circle", "floor + 0.5 * ramp", "floor + ramp")
def test_upright() -> None:
    """Without gravity the surface stands upright; at a high speed all but so."""
    section = disc(R, 48, order=2)
    for e, dry in ((0.0, 0.15), (0.02, 0.15), (0.02, 0.19)):
        body = paraboloid_body(section, H, math.inf, dry_radius=dry, axis=(-e, 0.0), size=0.02)
        exact = integrate_surface(section, H, math.inf, dry_radius=dry, axis=(-e, 0.0))
        found = body_integrals(body)
        # Against the same section: only the arcs of the surface are left, b = 1/15 at most.
        slack = H * math.pi * dry**2 * (1 / 15) ** 4 / 30
        assert found.volume == pytest.approx(float(exact.volume), abs=slack)
        assert found.x + e * found.volume == pytest.approx(float(exact.x), abs=slack * R)
        assert found.z == pytest.approx(H / 2 * found.volume, rel=1e-12)
    # A ramp of 17 micrometres; its volume is a ten-thousandth of the liquid's.
    fast = paraboloid_body(section, H, 1e4, -1e4 * 0.15**2, axis=(-0.02, 0.0), size=0.02)
    exact = integrate_surface(section, H, 1e4, dry_radius=0.15, axis=(-0.02, 0.0))
    assert body_integrals(fast).volume == pytest.approx(float(exact.volume), rel=1e-5)


@given(
    speed=st.floats(-1.0, 3.0),
    fill=st.floats(0.02, 0.95),
    e=st.floats(0.0, 0.15),
    inner=st.sampled_from([0.0, 0.04]),
    layers=st.integers(1, 3),
)
@settings(max_examples=25)
def test_bodies_are_valid_and_hold_their_volume(
    speed: float, fill: float, e: float, inner: float, layers: int
) -> None:
    """Any surface that holds a volume, against that volume on the same section."""
    section = annulus(R, inner, 24, order=2)
    beta, volume = 10.0**speed, fill * H * math.pi * (R**2 - inner**2) * 0.99
    surface = solve_surface(section, H, beta, volume, axis=(-e * R, 0.0))
    body = paraboloid_body(section, H, beta, surface.surface_constant, axis=(-e * R, 0.0), layers=layers)
    assert body_jacobians(body.points, body.cells).min() > 0.0
    # Arcs have b = 1/8 at most, or are upright where the ramp is thinner than the square of their length over
    # the radius: there the wall cuts the ramp short, by 2 % of what stands within an edge of the wall.
    assert body_integrals(body).volume == pytest.approx(volume, rel=2e-3, abs=1e-4 * H * R**2)


@kills("meshes.bodies.body:columns", "(top & open_top[:, None])", "(top & ~open_top[:, None])")
def test_faces() -> None:
    """Gauss's theorem closes, floor and lid are flat, the area of the surface is that of the paraboloid."""
    for order in (1, 2):
        body = paraboloid_body(disc(R, 48, order=order), H, 20.0, -0.2, size=0.01, order=order)
        faces = np.concatenate([body.surface, body.wall])
        corners = body.points[faces[:, :3]]
        normal = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert np.abs(normal.sum(axis=0)).max() < 1e-14  # rounding of 1e4 faces
        parts = [corners[len(body.surface) :][body.wall_part == k] for k in range(3)]
        area = [
            np.linalg.norm(normal[len(body.surface) :][body.wall_part == k], axis=1).sum() for k in range(3)
        ]
        assert np.all(parts[WALL_PARTS.index("floor")][..., 2] == 0.0)
        assert np.all(parts[WALL_PARTS.index("lid")][..., 2] == H)
        # Chords lack 2 b^2/3 of the circles, b = pi/48 at the wall, of a floor that is 3/4 of the disc.
        inner, outer = math.sqrt(0.01), math.sqrt(0.0125)
        slack = 0.005
        assert area[0] == pytest.approx(math.pi * (R**2 - inner**2), rel=slack)
        assert area[1] == pytest.approx(math.pi * (R**2 - outer**2), rel=slack)
        assert area[2] == pytest.approx(2 * math.pi * R * H, rel=slack)
        # Paraboloid z = beta r^2 between two radii: pi/(6 beta^2) [(1 + 4 beta^2 r^2)^(3/2)].
        exact = math.pi / 2400 * ((1 + 1600 * outer**2) ** 1.5 - (1 + 1600 * inner**2) ** 1.5)
        assert np.linalg.norm(normal[: len(body.surface)], axis=1).sum() == pytest.approx(exact, rel=slack)
        # The normal of the free surface points to the axis.
        middle = corners[: len(body.surface)].mean(axis=1)
        assert np.all(np.sum(middle[:, :2] * normal[: len(body.surface), :2], axis=1) < 0.0)


def test_surface_lies_on_the_paraboloid() -> None:
    body = paraboloid_body(disc(R, 48, order=2), H, 20.0, -0.2, axis=(-0.03, 0.01))
    x, y, z = body.points[np.unique(body.surface)].T
    level = 20.0 * ((x + 0.03) ** 2 + (y - 0.01) ** 2) - 0.2
    assert np.abs(z - level).max() < 1e-12
    below = 20.0 * ((body.points[:, 0] + 0.03) ** 2 + (body.points[:, 1] - 0.01) ** 2) - 0.2
    assert np.all(body.points[:, 2] <= below + 1e-12)


def test_a_sector_holds_a_body_too() -> None:
    section = sector(R, 0.3, 1.2, 0.05, 24)
    surface = solve_surface(section, H, 5.0, 2e-4, axis=(-0.01, 0.0))
    body = paraboloid_body(section, H, 5.0, surface.surface_constant, axis=(-0.01, 0.0), size=0.01)
    assert body_integrals(body).volume == pytest.approx(2e-4, rel=1e-4)


def test_a_full_chamber_has_no_surface() -> None:
    body = paraboloid_body(disc(R, 24, order=2), H, 0.0, H)
    assert len(body.surface) == 0
    assert set(body.wall_part) == {0, 1, 2}


def wave(count: int) -> np.ndarray:
    return np.asarray(0.18 + 0.012 * np.cos(2 * math.pi * np.arange(count) / count + 0.4))


def check_wave(order: int = 2) -> None:
    """A circle off the centre to first order: moments by hand from r_s = r_0 + d cos(theta + 0.4)."""
    r0, d = 0.18, 0.012
    volume = H * math.pi * (R**2 - r0**2 - d**2 / 2)
    # -h/3 oint r_s^3 cos(theta): the cube's first harmonic is 3 r0^2 d + 3/4 d^3.
    first = -H / 3 * math.pi * (3 * r0**2 * d + 0.75 * d**3)

    def error(count: int) -> float:
        body = wave_body(R, H, wave(count), order=order)
        assert body_jacobians(body.points, body.cells).min() > 0.0
        found = body_integrals(body)
        assert found.z == pytest.approx(H / 2 * found.volume, rel=1e-12)
        return max(
            abs(found.volume / volume - 1.0),
            abs(found.x - first * math.cos(0.4)) / abs(first),
            abs(found.y + first * math.sin(0.4)) / abs(first),
        )

    coarse, fine = error(32), error(64)
    # Even meshes: the next term of the error is smaller by the square of a step, a tenth.
    assert math.log2(coarse / fine) == pytest.approx(2 * order, abs=0.15)


@pytest.mark.parametrize("order", [1, 2])
def test_wave(order: int) -> None:
    check_wave(order)


@given(
    count=st.integers(4, 30).map(lambda n: 2 * n),
    depth=st.floats(-5.0, -0.4).map(lambda p: 10.0**p),
    dry=st.floats(-1.0, 1.5),
    rough=st.floats(0.0, 0.3),
    seed=st.integers(0, 20),
    order=st.sampled_from([1, 2]),
)
@settings(max_examples=60)
def test_waves_of_any_shape_are_valid(
    count: int, depth: float, dry: float, rough: float, seed: int, order: int
) -> None:
    """Dry spots, steep and rough waves: no folded cell; the volume is near that of straight pieces."""
    theta = 2 * math.pi * np.arange(count) / count
    shape = np.cos(theta) - dry + rough * np.random.default_rng(seed).standard_normal(count)
    thickness = depth * np.clip(shape, 0.0, 2.0)
    if not np.any(thickness > 1e-8):
        return
    body = wave_body(1.0, 0.1, 1.0 - thickness, order=order)
    assert body_jacobians(body.points, body.cells).min() > 0.0
    after = np.roll(thickness, -1)
    straight = 0.1 * math.pi / count * np.sum((thickness + after) * (1.0 - 0.25 * (thickness + after)))
    # Samples between the ends of quadratic edges count as 2/3 instead of 1/2: the difference is below half.
    assert body_integrals(body).volume == pytest.approx(straight, rel=0.5)


def test_dry_walls_carry_nothing() -> None:
    theta = 2 * math.pi * np.arange(64) / 64
    thickness = np.maximum(0.02 * np.cos(theta), 0.0)
    for order in (1, 2):
        body = wave_body(R, H, R - thickness, order=order)
        assert body.points[:, 0].min() > -1e-12
        # Half of the lune: h int (R d - d^2/2) over the wet half. Straight pieces lose 2 b^2/3, b = pi/64, of
        # their sectors, and the trapezoidal rule 4 b^2/12 of the cosine.
        exact = H * (R * 0.02 * 2.0 - 0.5 * 0.02**2 * math.pi / 2)
        assert body_integrals(body).volume == pytest.approx(exact, rel=2.5e-3)
        assert len(body.surface) > 0
        assert np.all(np.hypot(*body.points[np.unique(body.surface), :2].T) <= R * (1 + 1e-12))


def test_uneven_angles() -> None:
    theta = np.sort(np.random.default_rng(0).uniform(0.0, 2 * math.pi, 60))
    body = wave_body(R, H, np.full(60, 0.15), theta, order=1)
    turn = np.diff(theta, append=theta[0] + 2 * math.pi)
    exact = 0.5 * H * (R**2 - 0.15**2) * np.sum(np.sin(turn))
    assert body_integrals(body).volume == pytest.approx(exact, rel=1e-12)


@kills("meshes.bodies.body:body_integrals", "np.sum(x * flux)) / 3.0", "np.sum(x * flux)) / 2.0")
@kills("meshes.bodies.body:body_integrals", "volume * middle", "middle")
@kills("meshes.bodies.body:body_jacobians", "np.diag(4.0 * share - 1.0)", "np.diag(4.0 * share)")
def test_tetrahedron() -> None:
    """A corner of a cube: 1/6, its centre of mass at 1/4; one side bent outwards adds its parabola."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    none = np.empty((0, 3), dtype=int)
    body = Body(points, np.array([[0, 1, 2, 3]]), none, faces, np.zeros(4, dtype=int))
    found = body_integrals(body)
    assert found.volume == pytest.approx(1 / 6, rel=1e-14)
    assert (found.x, found.y, found.z) == pytest.approx((1 / 24,) * 3, rel=1e-13)
    assert body_jacobians(points, body.cells) == pytest.approx(1.0)
    edges = [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)]
    curved = np.concatenate([points, [(points[a] + points[b]) / 2 for a, b in edges]])
    # Shifting a middle by u adds 4 u L1 L2 to x.
    curved[5, 0] += 0.1
    jacobian = body_jacobians(curved, np.arange(10)[None])[0]
    # x = L1 + 0.4 L1 L2: det = dx/dL1 = 1 + 0.4 L2, with L1, L2, L3 the coordinates.
    second = np.array([0, 0, 1, 0, 0, 0.5, 0.5, 0, 0, 0.5])
    assert jacobian == pytest.approx(1.0 + 0.4 * second, rel=1e-13)


@pytest.mark.parametrize(
    ("make", "field"),
    [
        (lambda: paraboloid_body(disc(R, 12), 0.0, 1.0), "height"),
        (lambda: paraboloid_body(disc(R, 12), H, -1.0), "beta"),
        (lambda: paraboloid_body(disc(R, 12), H, 1.0, -math.inf), "surface_constant"),
        (lambda: paraboloid_body(disc(R, 12), H, 1.0, -1.0), "surface_constant"),
        (lambda: paraboloid_body(disc(R, 12), H, 0.0, 0.0), "surface_constant"),
        (lambda: paraboloid_body(disc(R, 12), H, 1.0, axis=(math.nan, 0.0)), "axis"),
        (lambda: paraboloid_body(disc(R, 12), H, math.inf, dry_radius=-1.0), "dry_radius"),
        (lambda: paraboloid_body(disc(R, 12), H, 1.0, size=0.0), "size"),
        (lambda: paraboloid_body(disc(R, 12), H, 1.0, layers=0), "layers"),
        (lambda: paraboloid_body(disc(R, 12), H, 1.0, order=3), "order"),
        (lambda: wave_body(0.0, H, wave(8)), "radius"),
        (lambda: wave_body(R, H, wave(7)), "surface_radius"),
        (lambda: wave_body(R, H, wave(9)), "surface_radius"),
        (lambda: wave_body(R, H, wave(8) + 1.0), "surface_radius"),
        (lambda: wave_body(R, H, np.full(8, R)), "surface_radius"),
        (lambda: wave_body(R, H, wave(8), np.zeros(8)), "angles"),
        (lambda: wave_body(R, H, wave(8), np.arange(7.0)), "angles"),
        (lambda: wave_body(R, H, wave(8), across=0), "across"),
        (lambda: wave_body(R, H, wave(8), order=0), "order"),
    ],
)
def test_bad_requests_are_refused(make, field: str) -> None:  # type: ignore[no-untyped-def]
    with pytest.raises(InputError) as fault:
        make()
    assert fault.value.field == field


@kills(
    "meshes.bodies.body:body_integrals", "first = 0.5 * np.sum(x * x * flux", "first = np.sum(x * x * flux"
)
@kills("meshes.bodies.wave:wave_body", "radius - (1.0 - share) * thickness", "radius - share * thickness")
@kills("meshes.bodies.wave:wave_body", "np.stack([r * np.cos(theta)", "np.stack([r * np.sin(theta)")
def test_wave_of_quadratic_cells() -> None:
    check_wave()
