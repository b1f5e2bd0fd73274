"""Rotors whose chambers have baffles: reduced liquid, added mass, self-excited whirl in two frames."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fluid.fill import Fill, Fills, compartment_share
from fluid.friction.laws import Friction
from fluid.liquid import known_liquid
from fluid.waves import force_ratio
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.chamber_section import chamber_section
from meshes.errors import InputError
from meshes.rings.quadrilaterals import ring as quadrilaterals
from meshes.rings.triangles import ring
from meshes.section import Section, disc
from solvers.liquid_model import Whirls
from solvers.rotor.jeffcott import Jeffcott
from solvers.sloshing.forced import mode_damping
from solvers.sloshing.model import SmallWaves
from solvers.sloshing.modes import sloshing_modes
from solvers.sloshing.reduced import clear_ring, reduce_liquid, section_layer, section_layers, wall_drag
from solvers.sloshing.system import LiquidSystem, condense
from solvers.statics.free_surface import solve_surface
from solvers.synchronous.balance import backward_mass
from solvers.whirl import sections
from solvers.whirl.growth import asynchronous_growth, system_modes
from solvers.whirl.sections import circle_layer, drum_matrices, drum_modes, standing_modes
from tests.mutants import kills
from tests.oracles.rotors import tub, two_plane

WALL, SURFACE, HEIGHT = 0.15, 0.135, 0.05
VOLUME = math.pi * (WALL**2 - SURFACE**2) * HEIGHT
WATER = known_liquid("water")
CLEAR = Fill(Chamber(WALL, HEIGHT), WATER, VOLUME)
HALF = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(3, 0.1425)))
FULL = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(4)))
FREE = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(3, 0.13, 0.003)))
LAWS = [Friction(), Friction("linear", 0.5), Friction("stokes")]

# Rotor of physical size with mu = m_f/M = 0.1, omega_n = 25 rad/s.
MASS = CLEAR.full_mass / 0.1
SPIN = 25.0 * np.linspace(0.5, 2.2, 12)


def rotor(damping_ratio: float = 0.0) -> Jeffcott:
    return Jeffcott(MASS, MASS * 625.0, 50.0 * damping_ratio * MASS, 0.0)


def drum_growth(fill: Fill, friction: Friction, damping_ratio: float = 0.05) -> np.ndarray:
    """Largest growth over the spin in the drum's frame."""
    _, layers = section_layers([fill], friction)
    modes = drum_modes(rotor(damping_ratio), layers, SPIN)
    assert modes.complete.all()
    return np.asarray(np.where(modes.found, modes.root.real, -np.inf).max(axis=1))


@kills(
    "solvers.sloshing.reduced:ReducedLiquid.compliance",
    "-np.square(s) * self.inertia",
    "np.square(s) * self.inertia",
)
@kills(
    "solvers.sloshing.reduced:ReducedLiquid.compliance",
    "+ 2j * s * self.gyration",
    "- 2j * s * self.gyration",
)
@kills(
    "solvers.sloshing.reduced:ReducedLiquid.force_ratio", "np.square(1.0 + s) * moved", "np.square(s) * moved"
)
@kills("solvers.sloshing.reduced:ReducedLiquid.force_ratio", "along - 1j * across", "along + 1j * across")
@kills("solvers.sloshing.reduced:clear_ring", "gyration=tangent * turn", "gyration=-tangent * turn")
@kills("solvers.sloshing.reduced:clear_ring", "math.sqrt(math.pi * tangent)", "math.sqrt(math.pi)")
def test_the_ring_without_baffles_is_that_of_linear_theory() -> None:
    """Reduced finite elements against the closed form, the closed form against linear theory."""
    slip = np.array([-2.0, -0.8, -0.3, 0.0, 0.4, 1.3])
    exact = force_ratio((WALL / SURFACE) ** 2, 1.0 + slip)
    # Rounding, enlarged by the distance to the waves.
    np.testing.assert_allclose(clear_ring(WALL, SURFACE).force_ratio(slip), exact, rtol=1e-11)
    elements = reduce_liquid(condense(ring(WALL, SURFACE, 96)))
    assert len(elements.inertia) <= 4  # one circle; a uniform force drives nothing else but rounding
    # 96 quadratic sides: (2 pi/96)^4 = 2e-5 times a small constant, enlarged near the waves.
    np.testing.assert_allclose(elements.force_ratio(slip), exact, rtol=2e-6, atol=1e-7)


@pytest.mark.parametrize("baffles", [Baffles(3, 0.1425), Baffles(4), Baffles(1), Baffles(5, 0.13, 0.004)])
def test_few_motions_answer_as_all_of_them(baffles: Baffles) -> None:
    system = condense(ring(WALL, SURFACE, 48, baffles=baffles))
    reduced = reduce_liquid(system)
    assert reduced.inertia.shape[0] <= 24
    # Off the waves by a little damping. One baffle, round which all modes couple, is the hardest.
    s = np.linspace(-0.7, 0.7, 15) + 0.02j
    full = np.array([_compliance(system, x) for x in s])
    off = np.abs(reduced.compliance(s) - full).max(axis=(1, 2)) / np.abs(full).max(axis=(1, 2))
    assert off.max() < 1e-4


@kills(
    "solvers.whirl.sections:circle_layer",
    "spanned(np.hstack(answers), _DISTINCT)",
    "spanned(drive, _DISTINCT)",
)
@pytest.mark.parametrize("count", [3, 4, 6])
def test_few_motions_of_a_circle_answer_as_all_of_them(count: int) -> None:
    """What a circle drives, by the motions kept and by all, up to whirls as fast as the spin; and slowed."""
    fill = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(count, 0.1425)))
    layer = section_layer(fill, Friction("linear", 0.5))
    liquid, circle = layer.liquid, circle_layer(layer)
    drive = liquid.moment[0] - 1j * liquid.moment[1]
    for s in np.concatenate([np.linspace(-1.0, 1.0, 21) + 0.02j, 0.3 + 1j * np.linspace(0.05, 0.5, 5)]):
        whole = -s * s * liquid.inertia + 2j * s * liquid.gyration + liquid.surface
        few = -s * s * np.eye(len(circle.moment)) + 2j * s * circle.gyration + circle.surface
        wanted = 0.5 * drive.conj() @ np.linalg.solve(whole, drive)
        found = circle.moment @ np.linalg.solve(few, circle.moment.conj())
        assert abs(found - wanted) < 1e-6 * abs(wanted)


def _compliance(system: LiquidSystem, s: complex) -> np.ndarray:
    matrix = -s * s * system.inertia + 2j * s * system.gyration + system.surface
    return np.asarray(system.moment @ np.linalg.solve(matrix, system.moment.T))


def check_compartments(count: int) -> None:
    """Finite elements at s = 0, and a quadrature of the displacement by hand, against the closed form."""
    fill = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(count)))
    layer = section_layer(fill, Friction())
    assert layer is not None
    found = fill.full_mass * layer.liquid.force_ratio([0.0])[0]
    # The displacement is a polynomial on each of 64 sides and more: (2 pi/64)^4 = 9e-5 of it is lost at most,
    # with a small constant.
    assert found == pytest.approx(fill.added_mass, rel=1e-5)
    assert compartment_share(count) * math.pi == pytest.approx(_both_ways(count), rel=1e-12)


def _both_ways(count: int) -> float:
    """pi less half of the squared displacements for a deflection along x and along y."""
    total = 0.0
    nodes, weights = np.polynomial.legendre.leggauss(30)
    edges = np.linspace(0.0, 2.0 * math.pi, count + 1)
    for low, high in pairwise(edges):
        theta = 0.5 * (low + high) + 0.5 * (high - low) * nodes
        weight = 0.5 * (high - low) * weights
        for shape in (np.cos(theta), np.sin(theta)):
            mean = (weight @ shape) / weight.sum()
            total += 0.5 * float(weight @ (shape - mean) ** 2)
    return math.pi - total


@kills(
    "fluid.fill:Fill.full_mass",
    "self.liquid.density * math.pi * self.chamber.radius**2 * self.chamber.height",
    "self.liquid.density * math.pi * self.chamber.radius * self.chamber.height",
)
@kills("fluid.fill:compartment_share", "math.sin(math.pi / count)) ** 2", "math.sin(math.pi / count))")
@kills("fluid.fill:Fill.added_mass", "self.compartments) * self.surface_radius**2", "self.compartments)")
@kills("fluid.fill:Fill.added_mass", "return self.full_mass - self.liq", "return self.full_mass + self.liq")
def test_compartments_keep_their_volume() -> None:
    for count in (3, 4, 5, 8):
        check_compartments(count)


@kills("solvers.sloshing.reduced:wall_drag", "along.T @ (weights[:, None] * along)", "along.T @ along")
def test_drag_on_the_wall() -> None:
    """Of a clear ring: the slip along the wall is 1/sinh L of that at the surface."""
    mesh = ring(WALL, SURFACE, 96)
    x, y = mesh.points.T
    log = np.log(WALL / np.hypot(x, y))
    angle = np.arctan2(y, x)
    motion = np.sinh(log) / math.sinh(math.log(WALL / SURFACE)) * np.cos(angle)
    exact = math.pi / (WALL * math.sinh(math.log(WALL / SURFACE)) ** 2)
    # The slope of quadratic elements across four cells: a quarter of the depth squared, (h0/4R)^2 = 6e-4.
    assert wall_drag(mesh, motion[None])[0, 0] == pytest.approx(exact, rel=1e-3)


@kills(
    "solvers.sloshing.reduced:section_layer",
    "plain.lids * liquid.inertia",
    "0.5 * plain.lids * liquid.inertia",
)
@kills("solvers.sloshing.reduced:_of_baffles", "return liquid, drag / radius", "return liquid, drag")
def test_friction_of_a_thin_ring() -> None:
    """Baffles too short to matter leave the laminar drag of a thin ring, on its wall and on floor and lid."""
    thin = math.pi * (WALL**2 - 0.147**2) * HEIGHT
    clear = replace(CLEAR, volume=thin)
    shallow = replace(clear, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(3, 0.1499)))
    plain, cut = (section_layer(fill, Friction("stokes")) for fill in (clear, shallow))
    assert plain is not None
    assert cut is not None
    rates = []
    for layer in (plain, cut):
        answer = np.linalg.solve(layer.liquid.surface, layer.liquid.moment[0])
        energy = answer @ layer.liquid.inertia @ answer
        rates.append([answer @ drag @ answer / energy for drag in layer.laminar[:2]])
    assert rates[0][1] == pytest.approx(2.0 * math.sqrt(WATER.viscosity) / HEIGHT, rel=1e-9)
    # The baffles are a thirtieth of the depth high.
    np.testing.assert_allclose(rates[1], rates[0], rtol=0.03)


@kills("solvers.whirl.sections:_shears", "0.5 * (along + against),", "np.abs(wall) + 0.0j,")
@kills("solvers.whirl.sections:_shears", "(0.0, 2j, -2j)", "(0.0, 1j, -1j)")
@kills(
    "solvers.whirl.sections:drum_modes",
    "_shears(root, speed[owner])[0]",
    "_shears(0.3j * speed[owner], speed[owner])[0]",
)
def test_drags_are_those_of_the_modes(monkeypatch: pytest.MonkeyPatch) -> None:
    """In closed compartments on a heavy rotor, fast waves too: walls, floor and lid to first order."""
    monkeypatch.setattr("solvers.whirl.sections._FOLLOWED", 24)
    _, layers = section_layers([FULL], Friction("stokes"))
    found = drum_modes(Jeffcott(1e6, 1e4, 1e5, 0.0), layers, np.array([40.0]))
    system = condense(quadrilaterals(WALL, SURFACE, 64, 4, baffles=FULL.chamber.baffles))
    modes = sloshing_modes(system, 40.0, 16)
    damped = mode_damping(system, modes, WATER.viscosity, HEIGHT)
    assert modes.frequency.min() < -2.0 * 40.0
    for frequency, rate in zip(modes.frequency.tolist(), damped.rate.tolist(), strict=True):
        own = found.root[0][np.argmin(np.abs(found.root[0].imag + frequency))]
        # Of second order: the rate over the frequency, 1 %.
        assert own.real == pytest.approx(-rate, rel=0.01)


@given(st.integers(3, 400))
def test_many_compartments_hold_the_liquid_like_a_solid(count: int) -> None:
    fill = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(count)))
    assert fill.compartments == count
    assert fill.mass <= fill.added_mass * (1.0 + 1e-12)
    # sin^2(x)/x^2 = 1 - x^2/3 ...: what is left above a solid ring goes with 1/n^2.
    excess = fill.added_mass / fill.mass - 1.0
    ratio = SURFACE**2 / (WALL**2 - SURFACE**2)
    assert excess == pytest.approx(
        ratio * (math.pi / count) ** 2 / 3.0, rel=0.6 * (math.pi / count) ** 2 + 1e-9
    )


def test_liquid_that_can_pass_adds_the_full_mass() -> None:
    for fill in (HALF, FREE, CLEAR):
        assert fill.compartments == 1
        assert fill.added_mass == fill.full_mass
        layer = section_layer(fill, Friction())
        assert layer is not None
        assert layer.liquid.force_ratio([0.0])[0] == pytest.approx(1.0, abs=2e-7)
    assert Fills.of([HALF, FULL]).added_mass == pytest.approx([HALF.full_mass, FULL.added_mass])


def lobed() -> Fill:
    """A chamber whose wall waves round it six times."""
    base = disc(WALL, 64, order=2)
    angle = np.arctan2(base.points[:, 1], base.points[:, 0])
    away = np.hypot(*base.points.T) / WALL
    stretch = 1.0 + 0.03 * np.cos(6.0 * angle) * away**4
    section = chamber_section("lobes", Section(base.points * stretch[:, None], base.triangles))
    return Fill(Chamber(section.farthest, HEIGHT, section=section), WATER, VOLUME)


@kills(
    "solvers.synchronous.balance:backward_mass",
    "whole = layer.density * layer.liquid.enclosed_area",
    "whole = fill.full_mass * 1.0",
)
@kills("fluid.fill:Fill.added_mass", "if not self.uneven:\n                return self.mass", "")
@kills("fluid.fill:Fill.added_mass", "(self.volume + air)", "(self.volume - air)")
def test_added_mass_of_another_section() -> None:
    """Closed form, finite elements at s = 0, and the free surface about a shifted axis are one mass."""
    fill = lobed()
    section = fill.chamber.section
    assert section is not None
    layer = section_layer(fill, Friction())
    assert layer is not None
    found = layer.density * layer.liquid.enclosed_area * layer.liquid.force_ratio([0.0])[0]
    # 64 sides on the surface and more: (2 pi/64)^4 with a small constant.
    assert fill.added_mass == pytest.approx(found, rel=1e-6)
    # Backwards the same: the ratio belongs to the section, whose circle round it is 6 % larger.
    newton = layer.liquid.force_ratio([-2.0])[0] * layer.density * layer.liquid.enclosed_area
    assert backward_mass(fill) == pytest.approx(newton, rel=1e-12)
    assert backward_mass(fill) == pytest.approx(backward_mass(CLEAR), rel=0.05)
    for volume in (0.0, fill.chamber.capacity):
        still = replace(fill, volume=volume)
        assert still.added_mass == pytest.approx(still.mass)  # nothing, or a solid
    e = 1e-3
    surface = solve_surface(section.mesh, HEIGHT, math.inf, VOLUME, axis=(-e, 0.0))
    assert fill.added_mass * e == pytest.approx(WATER.density * surface.moments.x, rel=1e-6)


@kills(
    "fluid.fill:Fill.depth",
    "layer_depth(section, area) if 0.0",
    "self.chamber.radius - self.surface_radius if 0.0",
)
def test_a_section_is_dry_first_where_it_is_thinnest() -> None:
    """The model holds until the deflection is the depth at the nearest wall, not the one in the lobes."""
    fill = lobed()
    # The nearest wall is 0.97 R away.
    assert fill.depth == pytest.approx(0.97 * WALL - fill.surface_radius, rel=1e-4)
    e = fill.depth * np.array([0.99, 1.01])
    whirls = Whirls.synchronous(np.full(2, 40.0), e, np.zeros(2))
    answer = SmallWaves().answer(Fills.of([fill] * 2), whirls)
    assert answer.in_range.tolist() == [True, False]
    assert answer.dry_patch.tolist() == [False, True]


def test_a_drawn_circle_whirls_like_a_ring() -> None:
    drawn = chamber_section("disc", disc(WALL, 64, order=2))
    fill = Fill(Chamber(drawn.farthest, HEIGHT, section=drawn), WATER, VOLUME)
    for friction in LAWS[:2]:
        # Frequencies of quadratic elements with 64 sides: 1e-5 and better; growth rests on their differences.
        found = drum_growth(fill, friction)
        np.testing.assert_allclose(found, drum_growth(CLEAR, friction), atol=2e-4)


@kills(
    "solvers.sloshing.reduced:section_layer",
    "density = fill.liquid.density * chamber.height",
    "density = fill.liquid.density",
)
@kills(
    "solvers.sloshing.reduced:section_layer", "plain.stokes * liquid.inertia", "plain.rate * liquid.inertia"
)
@kills(
    "solvers.sloshing.reduced:section_layer", "plain.lids * liquid.gyration", "-plain.lids * liquid.gyration"
)
@kills("solvers.whirl.sections:_shears", "-0.5j * (along - against)", "0.5j * (along - against)")
@kills("solvers.whirl.sections:_shears", "factors + bends", "factors - 60.0 * bends")
@kills("solvers.whirl.sections:drum_matrices", "2.0 * spin * twist", "spin * twist")
@kills(
    "solvers.whirl.sections:drum_matrices", "[heavy * _TURN, _TURN @ pull]", "[heavy * _TURN, -_TURN @ pull]"
)
@kills("solvers.whirl.sections:drum_matrices", "spin * turned + support", "support")
@kills("solvers.whirl.sections:drum_matrices", "[-pull.T, surface]", "[pull.T, surface]")
@kills(
    "solvers.whirl.sections:drum_modes", "_shears(root, speed[owner])[0]", "_shears(-root, speed[owner])[0]"
)
def test_whirl_without_baffles_is_the_known_one() -> None:
    """Without baffles the drum's frame gives what the characteristic equation does."""
    for friction in LAWS:
        exact, _ = asynchronous_growth(rotor(0.05), [CLEAR], SPIN, friction)
        # Newton leaves 1e-12 of the frequencies; growth is their small imaginary part.
        np.testing.assert_allclose(drum_growth(CLEAR, friction), exact, atol=1e-9 * SPIN[-1])


@kills(
    "solvers.whirl.sections:standing_matrices",
    "twist - circle.density * turn",
    "twist + circle.density * turn",
)
@kills(
    "solvers.whirl.sections:standing_matrices",
    "spread - unit - 2.0 * turn @ twist",
    "spread - unit + 2.0 * turn @ twist",
)
@kills(
    "solvers.whirl.sections:standing_matrices",
    "- circle.rate * circle.density * spin * turn",
    "+ circle.rate * circle.density * spin * turn",
)
@kills("solvers.whirl.sections:standing_modes", "for way in (-1j, 1j))", "for way in (1j, -1j))")
@kills("solvers.whirl.sections:standing_modes", "-0.5j * (one - other)", "0.5j * (one - other)")
def test_drum_frame_and_standing_frame_agree() -> None:
    """Real motions in the drum's frame and circles in the standing one are one machine."""
    for fill in (HALF, FULL, FREE):
        for friction in LAWS:
            layer = section_layer(fill, friction)
            assert layer is not None
            modes = standing_modes(rotor(0.05).system(), [(0.0, layer)], SPIN)
            assert modes.complete.all()
            most = np.where(modes.found, modes.root.real, -np.inf).max(axis=1)
            # The circles are told apart to 1e-7 of their size.
            np.testing.assert_allclose(most, drum_growth(fill, friction), atol=1e-6)


@kills("solvers.whirl.sections:standing_determinant", "(-1j, 1j), answers", "(1j, -1j), answers")
@kills("solvers.whirl.sections:standing_determinant", "total += log_size", "total = log_size")
@kills("solvers.whirl.sections:_circle_answers", "m * np.log(circle.density)", "np.log(circle.density)")
@kills("solvers.whirl.sections:_circle_answers", "(parts.conj(), circle", "(parts, circle")
@kills("solvers.whirl.sections:_circle_answers", "slip * (slip + circle.rate)", "slip * slip")
@kills("solvers.whirl.sections:_circle_answers", "-circle.density * left", "circle.density * left")
@kills("solvers.whirl.sections:_same_circle", "return all(", "return any(")
def test_layers_eliminated_one_by_one_leave_the_determinant(monkeypatch: pytest.MonkeyPatch) -> None:
    """log det T of rotor and layers, by LAPACK on the whole matrix, to its rounding; two layers unlike."""
    seen: list[Any] = []
    monkeypatch.setattr(sections, "most_growing", lambda search, _: seen.append(search))
    fills = [replace(HALF, volume=share * VOLUME) for share in (1.0, 1.4)]
    # Laminar friction stands beside a linear rate here, though no law has both.
    layers = [
        (plane, replace(section_layer(fill, Friction("stokes")), rate=rate))
        for plane, fill, rate in zip((0.1, -0.08, 0.02), (*fills, fills[0]), (0.4, 0.0, 0.4), strict=True)
    ]
    standing_modes(two_plane().system(), layers, SPIN)
    chance = np.random.default_rng(4)
    owner = chance.integers(0, SPIN.size, 300)
    root = (chance.normal(0.0, 0.1, 300) + 1j * chance.uniform(0.0, 3.0, 300)) * SPIN[owner]
    unit, size = np.linalg.slogdet(seen[0].matrix(root, owner))
    off = seen[0].log_determinant(root, owner) - size - 1j * np.angle(unit)
    turns = np.exp(1j * off.imag)
    # Of N = 50 unknowns; the condition of T beside a mode takes up to four digits.
    assert np.abs(off.real).max() < 1e-9 * np.abs(size).max()
    assert np.abs(turns - 1.0).max() < 1e-9


@kills("solvers.whirl.sections:standing_matrices", "pull = -circle.density", "pull = circle.density * 0.5")
def test_any_rotor_with_a_clear_ring_is_the_known_one() -> None:
    """A rotor of two planes: circles of a clear ring give what the known coupled matrices do."""
    fill = replace(CLEAR, chamber=replace(CLEAR.chamber, plane=0.07))
    for system in (two_plane().system(), tub().system()):
        for friction in LAWS:
            layer = section_layer(fill, friction)
            assert layer is not None
            found = standing_modes(system, [(0.07, layer)], SPIN)
            known = system_modes(system, [fill], SPIN, friction)
            most = np.where(known.found, known.root.real, -np.inf).max(axis=1)
            np.testing.assert_allclose(found.root.real.max(axis=1), most, atol=1e-8 * SPIN[-1])


def test_matrices_are_those_of_lagrange() -> None:
    layer = section_layer(HALF, Friction())
    assert layer is not None
    found = drum_matrices(rotor(), [layer], SPIN[:1])
    for matrix, sign in ((found.mass, 1.0), (found.stiffness[0], 1.0), (found.damping[0], -1.0)):
        assert np.abs(matrix - sign * matrix.T).max() <= 1e-13 * np.abs(matrix).max()
    assert np.linalg.eigvalsh(found.mass).min() > 0.0


def test_undamped_liquid_in_compartments_does_not_whirl_where_the_clear_ring_does() -> None:
    clear, cut = (drum_growth(fill, Friction(), 0.0) for fill in (CLEAR, FULL))
    # mu = 0.1, h0/R = 0.1: unstable between 1.1225 and 1.475 of the natural frequency.
    inside = (SPIN > 1.13 * 25.0) & (SPIN < 1.47 * 25.0)
    assert np.all(clear[inside] > 0.5)
    assert np.all(cut[inside] < 1e-6)


def test_backward_mass_of_a_clear_ring_by_elements() -> None:
    shallow = replace(CLEAR, chamber=Chamber(WALL, HEIGHT, baffles=Baffles(3, 0.149)))
    assert shallow.uneven
    # Baffles of a fifteenth of the depth move the answer by a few times the square of that.
    assert backward_mass(shallow) == pytest.approx(backward_mass(CLEAR), rel=0.05)


def test_what_differs_in_two_directions_is_refused_for_other_rotors() -> None:
    """What answers differently in two directions has no circles: one or two baffles, an oval wall."""
    base = disc(WALL, 64, order=2)
    oval = chamber_section("oval", Section(base.points * np.array([1.02, 1.0]), base.triangles))
    plain = [Chamber(WALL, HEIGHT, baffles=Baffles(count)) for count in (1, 2)]
    for chamber in (*plain, Chamber(oval.farthest, HEIGHT, section=oval)):
        layer = section_layer(replace(CLEAR, chamber=chamber), Friction())
        assert layer is not None
        with pytest.raises(InputError, match="3 or more"):
            circle_layer(layer)


def test_equal_chambers_act_together() -> None:
    again = replace(HALF, chamber=replace(HALF.chamber, plane=0.1))
    solid, layers = section_layers([HALF, again], Friction())
    assert len(layers) == 1
    assert layers[0].density == pytest.approx(2.0 * WATER.density * HEIGHT)
    assert solid == 0.0
