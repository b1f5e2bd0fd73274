"""A pool at the bottom of a lying chamber: its shape, its slowest sloshing, the drag of the walls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import quad
from scipy.linalg import eigh

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.friction.pipe import friction_factor
from fluid.liquid import Liquid
from fluid.pool import Pool, centrifuging_speed, pool_of, sloshing_number, wall_torque
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from tests.mutants import kills

BRINE = Liquid("brine", 1200.0, 1.6e-6)


def ring(volume: float, inner: float = 0.0) -> Fill:
    return Fill(Chamber(0.24, 0.06, inner), BRINE, volume)


def section_integral(fill: Fill, level: float, power: float, moment: bool = False) -> float:
    """Integral of r^power over the liquid at least `level` below the axis, or of the depth below the axis."""

    def width(y: float, radius: float) -> float:
        return math.sqrt(max(radius**2 - y**2, 0.0))

    def strip(y: float) -> float:
        outer, inner = width(y, fill.chamber.radius), width(y, fill.chamber.inner_radius)
        if moment:
            return 2.0 * (outer - inner) * y
        found, _ = quad(lambda x: (x * x + y * y) ** (0.5 * power), inner, outer, epsabs=1e-14)
        return 2.0 * found

    # At the inner wall's lowest point the width has a kink.
    kink = [fill.chamber.inner_radius] if level < fill.chamber.inner_radius else None
    return quad(strip, level, fill.chamber.radius, points=kink, epsabs=1e-13, limit=200)[0]


@kills("fluid.pool:_segment", "c * c + s * s / 3.0", "c * c + s * s")
@kills("fluid.pool:_segment", "2.0 / 3.0 * (radius * s) ** 3,", "(radius * s) ** 3,")
@kills("fluid.pool:_cube", "0.375 * s * c**3", "0.25 * s * c**3")
@kills("fluid.pool:_cube", "0.4 * math.pi - _cube", "0.5 * math.pi - _cube")
@kills("fluid.pool:pool_of", "outer.moment - hole.moment", "outer.moment + hole.moment")
def test_shape() -> None:
    """Area, centre of mass and moments of the section against quadrature, below and above the axis."""
    for inner in (0.0, 0.20):
        for share in (0.001, 0.1, 0.4, 0.7, 0.97):
            fill = ring(share * Chamber(0.24, 0.06, inner).capacity, inner)
            pool = pool_of(fill)
            assert pool is not None
            level = 0.24 * math.cos(pool.half_angle)
            # Quadrature of square roots at the ends is right to 1e-8 or so.
            assert section_integral(fill, level, 0.0) == pytest.approx(fill.volume / 0.06, rel=1e-7)
            first = section_integral(fill, level, 0.0, moment=True)
            assert pool.arm * pool.area == pytest.approx(first, rel=1e-7)
            assert pool.square == pytest.approx(section_integral(fill, level, 2.0), rel=1e-7)
            assert pool.cube == pytest.approx(section_integral(fill, level, 3.0), rel=1e-7)
            if inner:
                wet = 0.0 if level >= inner else math.acos(max(level / inner, -1.0))
                assert pool.inner_half_angle == pytest.approx(wet, abs=1e-9)


def ritz(half_angle: float, terms: int) -> float:
    """Slowest frequency by harmonic polynomials about the middle of the surface, each a flow; from above.

    The wall's condition is natural. The energy of a flow is a sum over the boundary, phi d(phi)/dn.
    """
    node, weight = np.polynomial.legendre.leggauss(200)
    number = np.arange(1, terms + 1)[:, None]
    middle, size = math.cos(half_angle), math.sin(half_angle)

    def flow(place: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        # Im z^n, downwards being the real axis; its gradient is i times the conjugate of n z^(n - 1).
        z = ((place - middle) / size)[None, :]
        return (z**number).imag, 1j * np.conj(number * z ** (number - 1)) / size

    wall, chord = np.exp(1j * half_angle * node), middle + 1j * size * node
    value, gradient = flow(wall)
    energy = (value * (half_angle * weight)) @ (gradient * np.conj(wall)[None, :]).real.T
    value, gradient = flow(chord)
    energy -= (value * (size * weight)) @ gradient.real.T
    surface = (value * (size * weight)) @ value.T
    scale = 1.0 / np.sqrt(np.diag(energy))
    energy, surface = (0.5 * scale[:, None] * (m + m.T) * scale for m in (energy, surface))
    return 1.0 / float(eigh(surface, energy, eigvals_only=True)[-1])


@kills("fluid.pool:sloshing_number", "np.tanh(number * half_angle)", "np.tanh(number)")
@kills("fluid.pool:_strip", "0.25 * _STRIP", "0.5 * _STRIP")
def test_slowest_sloshing() -> None:
    """Against harmonic polynomials, and the half full cylinder's 1.3557 of the literature."""
    assert sloshing_number(0.5 * math.pi) == pytest.approx(1.3557, abs=5e-5)
    # From above; polynomials converge the slower, the wider the corners of the surface.
    for half_angle, terms, tolerance in (
        (0.3, 6, 1e-6),
        (1.0, 10, 1e-6),
        (0.5 * math.pi, 12, 2e-6),
        (2.0, 16, 2e-5),
    ):
        found, above = sloshing_number(half_angle), ritz(half_angle, terms)
        assert -1e-7 < above / found - 1.0 < tolerance
    # A shallow pool slides like a point.
    assert sloshing_number(0.01) == pytest.approx(1.0, abs=1e-4)


@given(st.floats(1e-6, 0.999), st.floats(0.0, 0.95))
def test_pendulums_are_sound(share: float, inner: float) -> None:
    """At every fill: a centre of mass inside the circle, a length above its distance, finite moments."""
    chamber = Chamber(0.24, 0.06, 0.24 * inner)
    pool = pool_of(Fill(chamber, BRINE, share * chamber.capacity))
    assert pool is not None
    assert 0.0 < pool.arm < 0.24 and pool.length >= pool.arm
    assert 0.0 < pool.cube < 0.24 * pool.square < 0.24**3 * pool.area * (1.0 + 1e-9)
    assert pool_of(Fill(chamber, BRINE, 0.0)) is None
    assert pool_of(Fill(chamber, BRINE, chamber.capacity)) is None


def drag(fill: Fill, pool: Pool, friction: Friction, turn: float) -> float:
    """The shear of the law summed up over wall, inner wall, floor and lid."""
    wall = fill.chamber

    def shear(speed: float) -> float:
        if friction.law == "wall":
            # By the factor of the speed at the outer wall.
            area, edge = pool.area * wall.height, pool.half_angle * wall.radius
            wet = 2.0 * wall.height * (edge + pool.inner_half_angle * wall.inner_radius) + 2.0 * pool.area
            reynolds = turn * wall.radius * 4.0 * area / wet / BRINE.viscosity
            rough = friction.roughness * wet / (4.0 * area)
            return BRINE.density * float(friction_factor(reynolds, rough)) / 8.0 * speed**2
        if friction.law == "quadratic":
            return BRINE.density * friction.coefficient * speed**2
        return BRINE.density * math.sqrt(0.5 * BRINE.viscosity * turn) * speed

    found = 0.0
    for radius, half in ((wall.radius, pool.half_angle), (wall.inner_radius, pool.inner_half_angle)):
        found += shear(turn * radius) * radius * 2.0 * half * radius * wall.height
    if friction.law == "stokes":
        found += 2.0 * shear(turn) * section_integral(fill, wall.radius * math.cos(pool.half_angle), 2.0)
    if friction.law == "wall":
        found += 2.0 * shear(turn) * section_integral(fill, wall.radius * math.cos(pool.half_angle), 3.0)
    return found


@kills("fluid.pool:_shear_torque", "shear * turn * (walls_2 + 2.0 * pool.square)", "shear * turn * walls_2")
@kills("fluid.pool:_shear_torque", "height * arc * r**4", "height * arc * r**3")
@kills("fluid.pool:_shear_torque", "(walls_3 + 2.0 * pool.cube)", "(walls_3 + pool.cube)")
def test_drag() -> None:
    """The torque is the sum of the shear."""
    for inner in (0.0, 0.20):
        fill = ring(6e-4, inner)
        pool = pool_of(fill)
        assert pool is not None
        for friction in (Friction("quadratic", 0.0025), Friction("stokes"), Friction("wall", roughness=1e-5)):
            found = float(wall_torque(fill, pool, friction, 12.0))
            assert found == pytest.approx(drag(fill, pool, friction, 12.0), rel=1e-6)
            assert float(wall_torque(fill, pool, friction, -12.0)) == -found
        # A rate k takes k times the moment of inertia.
        rigid = BRINE.density * 0.06 * pool.square
        assert float(wall_torque(fill, pool, Friction("linear", 2.0), 3.0)) == pytest.approx(6.0 * rigid)


@kills("fluid.pool:centrifuging_speed", "froude**2 < _DRAGGED", "froude < _DRAGGED")
@kills("fluid.pool:centrifuging_speed", "if baffles.loss is None else", "if True else")
@kills(
    "fluid.pool:centrifuging_speed",
    "min(stream / _SHALLOW, 1.0)",
    "1.0",
)
@kills("fluid.pool:wall_shear", "friction.coefficient * slip", "friction.coefficient")
@kills("fluid.pool:wall_shear", "drag_speed(", "4.0 * drag_speed(")
def test_centrifuging_speed() -> None:
    """c_f F^2 = 24 m on smooth walls, F = 10.6 q beside baffles; at least sqrt(g/a)."""
    for volume in (5e-4, 1.2e-3):
        fill = ring(volume)
        mean = volume / (2.0 * math.pi * 0.06 * 0.24**2)
        stands = math.sqrt(9.81 / fill.surface_radius)
        speed = centrifuging_speed(fill, Friction("quadratic", 0.002), 9.81)
        assert (
            0.002 * (speed**2 * 0.24 / 9.81) ** 2 == pytest.approx(24.0 * mean, rel=1e-9) and speed > stands
        )
        speed = centrifuging_speed(fill, Friction("wall", roughness=1e-4), 9.81)
        diameter = 4.0 * fill.depth * 0.06 / (0.06 + 2.0 * fill.depth)
        reynolds, rough = speed * 0.24 * diameter / BRINE.viscosity, 1e-4 / diameter
        factor = float(friction_factor(reynolds, rough)) / 8.0
        assert factor * (speed**2 * 0.24 / 9.81) ** 2 == pytest.approx(24.0 * mean, rel=1e-9)
        assert centrifuging_speed(fill, Friction(), 9.81) == math.inf
        assert centrifuging_speed(fill, Friction("quadratic", 10.0), 9.81) == stands
        plates = Fill(Chamber(0.24, 0.06, 0.2, baffles=Baffles(8, 0.234)), BRINE, volume)
        speed = centrifuging_speed(plates, Friction(), 9.81)
        deep = mean / 0.025
        # Driven hard enough: 8/(4 pi) 2.4 0.025 = 0.038.
        assert 0.038 * (10.6 * deep * min(deep / 1.5, 1.0)) ** 2 > 24.0 * mean or volume < 1e-3
        wanted = max(stands, math.sqrt(10.6 * deep * min(deep / 1.5, 1.0) * 9.81 / 0.24))
        assert speed == pytest.approx(wanted, rel=1e-12)
    # A loss that is given drives the stream in place of the plates' drag: as much at 2.4, nothing at 0.
    for loss in (2.4, 0.0):
        given = Fill(Chamber(0.24, 0.06, 0.2, baffles=Baffles(8, 0.2396, loss=loss)), BRINE, 1.2e-3)
        alike = Fill(Chamber(0.24, 0.06, 0.2, baffles=Baffles(8, 0.2396)), BRINE, 1.2e-3)
        same = centrifuging_speed(given, Friction(), 9.81) == centrifuging_speed(alike, Friction(), 9.81)
        assert same == (loss > 0.0)
    closed = Fill(Chamber(0.24, 0.06, 0.2, baffles=Baffles(8, 0.2)), BRINE, 1e-3)
    assert centrifuging_speed(closed, Friction(), 9.81) == math.sqrt(9.81 / closed.surface_radius)


@kills("fluid.pool:_shear_torque", "drag_speed(", "1e-3 * drag_speed(")
def test_hysteresis_as_experiments_report() -> None:
    """Liquid becomes a ring above the speed at which it falls, unless it is thick [AH01]."""

    def ratio(share: float, viscosity: float) -> float:
        """Centrifuging speed over sqrt(g/a)."""
        chamber = Chamber(0.15, 1.0)
        fill = Fill(chamber, Liquid("liquid", 1000.0, viscosity), share * chamber.capacity)
        falls = math.sqrt(9.81 / (0.15 * math.sqrt(1.0 - share)))
        pool = pool_of(fill)
        assert pool is not None and float(wall_torque(fill, pool, Friction("wall"), falls)) > 1e-3
        return centrifuging_speed(fill, Friction("wall"), 9.81) / falls

    fills = (0.02, 0.05, 0.1, 0.2, 0.3)
    for viscosity in (1e-6, 1e-5, 1e-4):
        found = [ratio(share, viscosity) for share in fills]
        assert min(found) > 1.0
        assert found == sorted(found)
    # Omega R^2/nu is about 20 at the speed at which a ring stands: no hysteresis.
    assert max(ratio(share, 1e-1) for share in fills) == 1.0


@kills("fluid.pool:_baffle_factor", "max(plate, loss * depth)", "loss * depth")
@kills("fluid.pool:_baffle_factor", "baffles.count * pool.half_angle / math.pi", "baffles.count")
@kills("fluid.pool:wall_torque", "turn * np.abs(turn)", "turn * turn")
def test_baffles_push() -> None:
    """Those under the pool, each by the head that the flow past it loses, or as a plate under much liquid."""
    for tip, high in ((0.21, True), (0.2399, False)):
        chamber = Chamber(0.24, 0.06, 0.0, baffles=Baffles(8, tip))
        fill = Fill(chamber, BRINE, 1.2e-3)
        pool = pool_of(fill)
        assert pool is not None
        depth = 0.02 / (2.0 * pool.half_angle * 0.24)
        open_part = 1.0 - (0.24 - tip) / depth
        jet = (0.55 + 0.45 * open_part**1.8) * open_part
        lost = depth * (1.0 / jet - 1.0) ** 2
        drag_width = 1.2 * (0.24 - tip)
        assert (lost > drag_width) is high
        force = 0.5 * BRINE.density * 0.06 * max(lost, drag_width) * (3.0 * 0.5 * (0.24 + tip)) ** 2
        wet = 8.0 * pool.half_angle / math.pi
        found = float(wall_torque(fill, pool, Friction(), -3.0))
        assert found == pytest.approx(-wet * force * 0.5 * (0.24 + tip), rel=1e-12)
