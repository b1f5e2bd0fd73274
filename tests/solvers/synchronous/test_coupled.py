"""Any rotor with liquid: against the planar rotor, independent rotors, solids and a linear layer."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.linalg
from hypothesis import given
from hypothesis import strategies as st

from fluid.fill import Fill
from fluid.liquid import Liquid
from fluid.waves import displacement_ratio, offset_ratio
from leblanc.liquid.models import synchronous_model
from meshes.arrays import Array
from meshes.chamber import Baffles, Chamber
from meshes.errors import InputError
from solvers.liquid_model import LiquidModel
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor, RotorSystem
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import critical_speeds, orbit, solve_each, unbalance_response
from solvers.sloshing.model import SmallWaves
from solvers.statics.hydrostatics import equilibrium
from solvers.synchronous import coupled
from solvers.synchronous.balance import backward_mass, harmonic_balance
from solvers.synchronous.coupled import newton, one_plane, several_planes, stable_solutions
from solvers.synchronous.models import LINEAR, STATICS
from solvers.synchronous.response import (
    Response,
    critical_speed,
    fill_responses,
    response,
    wet_critical_speeds,
)
from tests.mutants import kills
from tests.oracles.rotors import tub, two_plane
from tests.solvers.synchronous.test_planar import WATER, fills, folded, rig


def at_plane(plane: float, volume: float, radius: float = 0.065, inner: float = 0.0) -> Fill:
    return Fill(Chamber(radius, 0.02, inner, plane), WATER, volume)


def at_chambers(system: RotorSystem, found: Response, wet: list[Fill]) -> tuple[np.ndarray, np.ndarray]:
    """Forward and backward part of the axis at each chamber, shape (s, c)."""
    orbits = [orbit(system, found.coordinates, fill.chamber.plane) for fill in wet]
    return np.stack([one.forward for one in orbits], 1), np.stack([one.backward for one in orbits], 1)


@kills(
    "solvers.synchronous.coupled:one_plane",
    "elastic = support.real - squared * mass",
    "elastic = support.real",
)
@kills("solvers.synchronous.coupled:one_plane", "moment - mass[k] * deflection", "moment")
@kills(
    "solvers.synchronous.coupled:_phase",
    "np.angle(support * size - pulled)",
    "np.angle(support * size + pulled)",
)
@kills("solvers.synchronous.coupled:stable_solutions", "~falls & (", "(~falls | True) & (0.0 * ")
@kills("solvers.synchronous.coupled:stable_solutions", "2j * spin * mass", "0j * spin * mass")
def test_planar_rotor() -> None:
    """Every branch, dry patch and angle of the planar rotor, by the other way of solving."""
    for rotor, wet, speed, gravity in (
        (*folded(), 0.0),
        (rig(0.02, 3e-3), fills(1e-5, 1e-5), np.linspace(40.0, 250.0, 16), 0.0),
        (rig(0.02, 3e-3), fills(1e-5, 1e-5), np.linspace(40.0, 250.0, 16), 9.81),
        (rig(0.1), fills(1e-4, 8e-5), np.linspace(10.0, 300.0, 12), 9.81),
    ):
        one = response(rotor, wet, speed, gravity)
        found = other = response(rotor.system(), wet, speed, gravity)
        assert other.converged.all()
        # Next to a fold a root is known to the square root of rounding.
        np.testing.assert_allclose(other.deflection, one.deflection, rtol=1e-8)
        np.testing.assert_allclose(other.branch_deflection, one.branch_deflection, rtol=1e-8)
        np.testing.assert_allclose(other.liquid_offset, one.liquid_offset, rtol=1e-8)
        np.testing.assert_allclose(other.deflection_dry, one.deflection_dry, rtol=1e-12)
        np.testing.assert_allclose(np.exp(1j * (other.liquid_angle - one.liquid_angle)), 1.0, atol=1e-8)
        np.testing.assert_array_equal(other.dry_patch, one.dry_patch)
        np.testing.assert_array_equal(other.branch_stable, one.branch_stable)
        assert np.abs(found.backward).max() < 1e-14 and found.residual.max() < 1e-12


def in_one_plane(rotor: Jeffcott) -> list[Rotor]:
    """A planar rotor as one in two planes and as a tub, whose chambers sit in the plane of the mass."""
    k, c = rotor.stiffness, rotor.damping
    supports = tuple(Support(z, 0.5 * k, 0.5 * c) for z in (-0.2, 0.2))
    arms = ((0.0, 0.0, 0.0), (0.3, 0.2, 0.0), (-0.3, -0.2, 0.0))
    springs = tuple(Mount(place, along_axes=(k / 3.0, 1e4, k / 3.0)) for place in arms)
    dampers = tuple(Mount(place, along_axes=(c / 3.0, 1e2, c / 3.0)) for place in arms)
    m = rotor.mass
    masses = {"tub_mass": 0.7 * m, "drum_mass": 0.3 * m, "tub_inertia": (1.0, 1.1, 1.2)}
    return [
        TwoPlane(m, 1.0, 0.2, supports, (PlaneUnbalance(0.0, rotor.unbalance),)),
        Tub(
            **masses, drum_polar_inertia=0.2, drum_transverse_inertia=0.3, springs=springs, dampers=dampers,
            unbalance=rotor.unbalance, unbalance_position=0.0,
        ),
    ]  # fmt: skip


@kills(
    "solvers.synchronous.balance:Balance.told",
    "= found.dry_patch, found.in_range",
    "= dry[:, j], in_range[:, j]",
)
@pytest.mark.parametrize("model", [LINEAR, SmallWaves(24)], ids=lambda model: model.name)
def test_range_on_every_rotor(model: LiquidModel) -> None:
    """Random machines in one plane, of three kinds of rotor and beside baffles: one range and one dry wall.

    Linear theory leaves its range where the deflection is the depth of the layer.
    """
    rng, seen = np.random.default_rng(5), np.zeros(2, dtype=int)
    for _ in range(30):
        mass, k = rng.uniform(4.0, 12.0), rng.uniform(1e4, 5e4)
        rotor = Jeffcott(
            mass, k, rng.uniform(0.05, 0.5) * math.sqrt(k * mass), 10.0 ** rng.uniform(-4.0, -2.0)
        )
        chamber = Chamber(0.1, 0.05, baffles=Baffles(3, 0.095) if rng.random() < 0.5 else None)
        wet = [Fill(chamber, WATER, 10.0 ** rng.uniform(-7.0, -4.3))]
        speed = math.sqrt(k / mass) * np.sort(rng.uniform(0.3, 3.0, 5))
        one = response(rotor, wet, speed, 0.0, model)
        for other in in_one_plane(rotor):
            found = response(other, wet, speed, 0.0, model)
            np.testing.assert_allclose(found.deflection, one.deflection, rtol=1e-8)
            np.testing.assert_array_equal(found.dry_patch, one.dry_patch)
            np.testing.assert_array_equal(found.in_range, one.in_range)
        beyond = np.abs(one.deflection) >= wet[0].depth
        np.testing.assert_array_equal(one.dry_patch, beyond)
        np.testing.assert_array_equal(one.in_range, ~beyond)
        seen += np.array([beyond.sum(), (~beyond).sum()])
    assert np.all(seen > 20)


@kills("solvers.synchronous.balance:Balance.told", "_backward_displacement(own) * backward", "0.0 * backward")
@kills("solvers.synchronous.balance:_backward_displacement", "8.0 * outer", "18.0 * outer")
def test_range_in_an_ellipse() -> None:
    """Unlike springs: what counts is the surface's largest rise over a turn, of both circles together.

    That of the backward one is computed here as a whirl of its own, and the least depth all round over a
    turn is looked for on a grid of angles and instants.
    """
    system = tub(0.2).system()
    wet = [Fill(Chamber(0.2, 0.05, plane=0.05), WATER, 3e-3)]
    speed = np.array([12.0, 14.0, 16.0, 18.0, 20.0, 26.0, 34.0])
    whole, part = response(system, wet, speed, 0.0, LINEAR), []
    assert not whole.dry_patch.any()
    forward, backward = (np.abs(x[:, 0]) for x in at_chambers(system, whole, wet))
    kappa = (0.2 / wet[0].surface_radius) ** 2
    angle, turn = np.meshgrid(np.linspace(0.0, 2 * np.pi, 721), np.linspace(0.0, np.pi, 361))
    for one, other in zip(forward, backward, strict=True):
        counter = float(displacement_ratio(kappa, -1.0)) * other
        # In the drum the backward circle turns at -2 Omega.
        part.append(np.max(one * np.cos(angle) - counter * np.cos(angle + 2.0 * turn)))
    rise = np.array(part)
    assert np.any(rise > 1.001 * forward)  # the ellipse matters somewhere
    # The linear answer grows in proportion to the unbalance: just below and just above the depth. The grid
    # finds a maximum to 1 - cos(half a degree) = 4e-5.
    for k in range(speed.size):
        for share, dry in ((0.999, False), (1.001, True)):
            scaled = replace(system, unbalance=system.unbalance * share * wet[0].depth / rise[k])
            found = response(scaled, wet, speed[k : k + 1], 0.0, LINEAR)
            assert bool(found.dry_patch[0]) is dry and bool(found.in_range[0]) is not dry


def with_discs(system: RotorSystem, discs: list[tuple[float, float]]) -> RotorSystem:
    """The rotor with point masses on its axis, (mass, position)."""
    mass = system.mass + sum(m * system.at(z).T @ system.at(z) for m, z in discs)
    return RotorSystem(
        system.coordinates, mass, system.damping, system.gyroscopic, system.stiffness, system.unbalance,
        system.centre, system.lean,
    )  # fmt: skip


@kills(
    "solvers.synchronous.balance:Balance.forward",
    "0.5 * answer @ np.conj(self.plane).T",
    "0.5 * answer @ self.plane.T",
)
@kills("solvers.synchronous.balance:Balance.linear", "0.5 * np.einsum(", "1.0 * np.einsum(")
@kills("solvers.synchronous.balance:directions_at", "np.array([1.0, -1j])", "np.array([1.0, 1j])")
@kills(
    "solvers.synchronous.balance:_balance",
    "force=squared[:, None] * system",
    "force=speed[:, None] * system",
)
@kills(
    "solvers.synchronous.response:_centre_of_mass",
    "np.abs(moment), terms.mass",
    "np.abs(moment), 1.0 / terms.mass",
)
def test_added_mass() -> None:
    """Walls wet all over in isotropic supports: the mass of full chambers, at each plane its own."""
    system, speed = two_plane().system(), np.linspace(10.0, 300.0, 5)
    wet = [at_plane(-0.25, 1.2e-4), at_plane(0.2, 1e-4, radius=0.08)]
    found = response(system, wet, speed, 0.0)
    assert not found.dry_patch.any() and found.converged.all()
    heavy = with_discs(system, [(one.full_mass, one.chamber.plane) for one in wet])
    answer = unbalance_response(heavy, speed)
    for k, fill in enumerate(wet):
        expected = orbit(heavy, answer, fill.chamber.plane).forward
        np.testing.assert_allclose(at_chambers(system, found, wet)[0][:, k], expected, rtol=1e-10)
    forward = at_chambers(system, found, wet)[0]
    np.testing.assert_allclose(found.deflection, forward[:, 0], rtol=1e-14)
    # First moments m_f f of both chambers, over the mass of their liquid.
    moment = forward @ np.array([one.full_mass for one in wet])
    mass = sum(one.mass for one in wet)
    np.testing.assert_allclose(found.liquid_offset, np.abs(moment) / mass, rtol=1e-12)
    np.testing.assert_allclose(found.liquid_angle, np.angle(moment), rtol=1e-12)


@kills(
    "solvers.synchronous.balance:backward_mass",
    "        return fill.mass\n",
    "        return fill.full_mass\n",
)
def test_full_chambers() -> None:
    """Completely full chambers on an anisotropic rotor are solid discs, forward and backward alike."""
    system, speed = tub().system(), np.linspace(3.0, 60.0, 40)
    places = (0.1, -0.05)
    wet = [
        at_plane(z, Chamber(0.18, 0.02, inner).capacity, 0.18, inner)
        for z, inner in zip(places, (0.0, 0.1), strict=True)
    ]
    heavy = with_discs(system, [(one.mass, one.chamber.plane) for one in wet])
    expected = orbit(heavy, unbalance_response(heavy, speed), places[0])
    found = response(system, wet, speed, 0.0)
    np.testing.assert_allclose(found.deflection, expected.forward, rtol=1e-9)
    np.testing.assert_allclose(found.backward, expected.backward, rtol=1e-9)


def layered(system: RotorSystem, fill: Fill, speed: float) -> np.ndarray:
    """Amplitudes of rotor and linear layer in real coordinates q, d_1, d_2, forced at the speed of the spin.

    (1 + kappa) d'' - 4 i kappa Omega d' - 2 kappa Omega^2 d = -Z'' and the pull -m_l (Z'' + d'').
    """
    n = len(system.coordinates)
    kappa = (fill.chamber.radius / fill.surface_radius) ** 2
    b = system.at(fill.chamber.plane)
    mass, rate, stiffness = np.zeros((3, n + 2, n + 2))
    mass[:n, :n] = system.mass + fill.mass * b.T @ b
    mass[:n, n:], mass[n:, :n] = fill.mass * b.T, b
    mass[n:, n:] = (1.0 + kappa) * np.eye(2)
    rate[:n, :n] = system.damping + speed * system.gyroscopic
    rate[n:, n:] = 4.0 * kappa * speed * np.array([[0.0, 1.0], [-1.0, 0.0]])
    stiffness[:n, :n], stiffness[n:, n:] = system.stiffness, -2.0 * kappa * speed**2 * np.eye(2)
    force = np.concatenate((speed**2 * system.unbalance, [0.0, 0.0]))
    return np.linalg.solve(stiffness - speed**2 * mass + 1j * speed * rate, force)[:n]


@kills(
    "solvers.synchronous.balance:_balance",
    "stiffness = stiffness - held",
    "stiffness = stiffness + held",
)
@kills(
    "solvers.synchronous.balance:_balance",
    "np.outer(np.conj(p), p)",
    "np.outer(p, np.conj(p))",
)
def test_linear_layer() -> None:
    """A deep layer on an anisotropic rotor: its equations of motion as they stand, no parts taken apart."""
    system = tub().system()
    fill = Fill(Chamber(0.2, 0.1, 0.0, 0.12), Liquid("heavy", 3000.0, 1e-6), 0.011)
    speed = np.linspace(4.0, 60.0, 30)
    found = response(system, [fill], speed, 0.0)
    assert not found.dry_patch.any()
    expected = np.array([layered(system, fill, one) for one in speed])
    orbits = orbit(system, expected, 0.12)
    np.testing.assert_allclose(found.deflection, orbits.forward, rtol=1e-9)
    np.testing.assert_allclose(found.backward, orbits.backward, rtol=1e-9)
    assert np.abs(found.backward).max() > 0.1 * np.abs(found.deflection).max()
    np.testing.assert_allclose(at_chambers(system, found, [fill])[1][:, 0], found.backward, rtol=1e-12)


@kills(
    "solvers.synchronous.balance:backward_mass",
    "force_ratio(curvature, -1.0)",
    "force_ratio(curvature, 1.0)",
)
def test_backward_mass() -> None:
    """Newton's law for the liquid: m_b = m_l (1 + offset of its centre of mass over the whirl)."""
    for volume in (1e-6, 5e-5, 2e-4):
        fill = at_plane(0.0, volume)
        kappa = (fill.chamber.radius / fill.surface_radius) ** 2
        expected = fill.mass * (1.0 + float(offset_ratio(kappa, -1.0)))
        # Both sides are differences: a layer of 0.1 mm costs them three digits.
        assert backward_mass(fill) == pytest.approx(expected, rel=1e-10)
    assert backward_mass(at_plane(0.0, 1e-9)) == pytest.approx(7.0 / 8.0 * 1e-6, rel=1e-4)


def dumbbell(ends: tuple[tuple[float, Jeffcott], ...], length: float = 0.4) -> TwoPlane:
    """Two planar rotors of equal mass as the ends of one rigid rotor."""
    mass = ends[0][1].mass
    return TwoPlane(
        2 * mass,
        2 * mass * length**2,
        0.0,
        tuple(Support(z * length, one.stiffness, one.damping) for z, one in ends),
        tuple(PlaneUnbalance(z * length, one.unbalance) for z, one in ends),
    )


def test_independent_ends() -> None:
    """Dry patches and folds at both ends of a dumbbell: each end as if the other were not there."""
    first, second = rig(0.001, 1e-4), Jeffcott(4.0, 3.6e4, 40.0, 3e-3)
    system = dumbbell(((-1.0, first), (1.0, second))).system()
    wet = [at_plane(-0.4, 1.2e-5), at_plane(0.4, 1e-5)]
    speed = np.linspace(94.0, 102.0, 33)
    found = response(system, wet, speed, 0.0)
    ends = [response(one, [fill], speed, 0.0) for one, fill in zip((first, second), wet, strict=True)]
    assert found.converged.all() and found.residual.max() < 1e-10
    assert [bool(one.dry_patch.any()) for one in ends] == [True, True]
    several = np.isfinite(ends[0].branch_deflection).sum(axis=1)
    assert several.max() == 3 and np.isfinite(ends[1].branch_deflection).sum(axis=1).max() == 1
    for k, one in enumerate(ends):
        np.testing.assert_allclose(at_chambers(system, found, wet)[0][:, k], one.deflection, rtol=1e-7)
    np.testing.assert_array_equal(np.isfinite(found.branch_deflection).sum(axis=1), several)
    # The branches rise with the first end's, which folds; the other end is stable throughout.
    np.testing.assert_array_equal(found.branch_stable, ends[0].branch_stable)
    assert not ends[0].branch_stable[several == 3, 1].any() and found.stable.all()


@kills(
    "solvers.synchronous.coupled:stable_solutions", "+ spin * system.gyroscopic", "- spin * system.gyroscopic"
)
@kills(
    "solvers.synchronous.coupled:stable_solutions",
    'ci,cj->kij", secant, p, np.conj(p))',
    'ci,cj->kij", secant, np.conj(p), p)',
)
def test_slow_stability_is_that_of_the_standing_frame() -> None:
    """Rotors that tilt, with dampers that drive some modes and hold others, their liquid a mass.

    What is slow in the rotating frame turns with the spin in the standing one: the same growth.
    """
    seen = set()
    for seed in range(24):
        rng = np.random.default_rng(seed)
        # A drum like a long disc: its modes part with the spin, forward and backward.
        rotor = two_plane(0.0, 0.6) if seed % 2 else tub(0.0)
        system, n = rotor.system(), len(rotor.system().coordinates)
        drive = rng.normal(size=(n, n))
        system = replace(
            system, damping=system.mass @ (drive + drive.T) + 2.0 * system.mass * rng.uniform(-2, 5)
        )
        wet = [at_plane(-0.1, 2e-3, 0.3), at_plane(0.12, 1e-3, 0.3)]
        speed = np.array([rng.uniform(20.0, 90.0)])
        terms = harmonic_balance(system, [wet], np.zeros(1, dtype=np.intp), speed, 0.0, LINEAR)
        answer = terms.linear(np.zeros(1, dtype=np.intp))
        assert stable_solutions(terms, answer, np.zeros(1, dtype=np.intp)).all()  # not looked at
        found = stable_solutions(
            replace(terms, limit=np.zeros_like(terms.limit)), answer, np.zeros(1, dtype=np.intp)
        )
        mass = system.mass.astype(complex)
        for p, added, back in zip(terms.plane, terms.added_mass[0], terms.backward_mass[0], strict=True):
            mass += 0.5 * (added * np.outer(p, p.conj()) + back * np.outer(p.conj(), p))
        rate = system.damping + speed[0] * system.gyroscopic
        zero, one = np.zeros((n, n)), np.eye(n)
        left = np.block([[zero, one], [-system.stiffness, -rate]])
        growth = scipy.linalg.eigvals(left, np.block([[one, zero], [zero, mass]])).real.max()
        assert found[0] == (growth < 0.0)
        seen.add((seed % 2, bool(found[0])))
    assert len(seen) == 4


def assert_each_as_if_alone(rotor: Rotor, sets: list[list[Fill]], speed: Array) -> None:
    """The answer of every set of volumes among the others is that of its own."""
    owner = np.tile(np.arange(len(sets)), speed.size)  # in any order
    together = fill_responses(rotor, sets, owner, np.repeat(speed, len(sets)), 0.0)
    for k, own_fills in enumerate(sets):
        own, alone = together.at(np.flatnonzero(owner == k)), response(rotor, own_fills, speed, 0.0)
        branches = alone.branch_amplitude.shape[1]
        assert np.isnan(own.branch_amplitude[:, branches:]).all()
        # Newton's last step leaves rounding of the largest terms.
        np.testing.assert_allclose(own.branch_amplitude[:, :branches], alone.branch_amplitude, rtol=1e-9)
        np.testing.assert_allclose(own.coordinates, alone.coordinates, rtol=1e-8, atol=1e-15)
        np.testing.assert_allclose(own.liquid_offset, alone.liquid_offset, rtol=1e-8)
        np.testing.assert_array_equal(own.dry_patch, alone.dry_patch)
        np.testing.assert_array_equal(own.converged, alone.converged)


def test_volumes_in_several_planes_at_once() -> None:
    """Sets of volumes with folds, some without liquid in a chamber."""
    first, second = rig(0.001, 1e-4), Jeffcott(4.0, 3.6e4, 40.0, 3e-3)
    volumes = [(1.2e-5, 1e-5), (0.0, 2e-5), (0.0, 0.0), (3e-5, 0.0)]
    sets = [[at_plane(z, v) for z, v in zip((-0.4, 0.4), row, strict=True)] for row in volumes]
    assert_each_as_if_alone(dumbbell(((-1.0, first), (1.0, second))), sets, np.linspace(94.0, 102.0, 9))


@kills(
    "solvers.synchronous.balance:harmonic_balance",
    "for fills in wet])[owner]",
    "for fills in wet])[0 * owner]",
)
@kills("solvers.synchronous.coupled:one_plane", "mass[owner] * bent", "mass[0] * bent")
def test_volumes_in_one_plane_at_once() -> None:
    """The same of a rotor that moves differently in two directions."""
    sets = [
        [Fill(Chamber(0.2, 0.1, 0.0, 0.12), Liquid("heavy", 3000.0, 1e-6), volume)]
        for volume in (1e-5, 2e-4, 3e-5, 0.011)
    ]
    assert_each_as_if_alone(tub(), sets, np.linspace(4.0, 60.0, 30))


def test_newton_finds_what_the_search_finds() -> None:
    """Both ways of solving on one plane of a lopsided rotor: the same branches, the same numbers of them."""
    rotor = TwoPlane(
        4.0,
        0.05,
        0.02,
        (Support(-0.2, 2.1e4, 0.3), Support(0.25, 1.9e4, 0.4)),
        (PlaneUnbalance(0.05, 2e-4, 0.7),),
    )
    speed = np.linspace(94.0, 102.0, 33)
    alone = np.zeros(speed.size, dtype=np.intp)
    terms = harmonic_balance(rotor.system(), [[at_plane(0.03, 1.2e-5)]], alone, speed, 0.0, STATICS)
    tables = []
    for found in (one_plane(terms), several_planes(terms)):
        assert found.converged.all()
        size = np.abs(terms.forward(found.answer)[:, 0])
        order = np.lexsort((size, found.which))
        tables.append((found.which[order], size[order]))
    np.testing.assert_array_equal(tables[0][0], tables[1][0])
    np.testing.assert_allclose(tables[0][1], tables[1][1], rtol=1e-7)
    assert np.bincount(tables[0][0]).max() == 3


@kills(
    "solvers.synchronous.coupled:newton", "keepdims=True), step, 0.0)", "keepdims=True) | True, step, 0.0)"
)
def test_a_singular_matrix_leaves_a_start_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """One of two starts has no step: it is not converged, without a fault; the other finds what it should."""
    speed, alone = np.array([60.0, 60.0]), np.zeros(2, dtype=np.intp)
    terms = harmonic_balance(two_plane().system(), [[at_plane(0.03, 1.2e-5)]], alone, speed, 0.0, STATICS)
    begin = 1.2 * np.linalg.solve(terms.stiffness, terms.force[..., None])[..., 0]
    wanted, found = newton(terms, begin, np.array([0, 1]))
    assert found.all()
    monkeypatch.setattr(coupled, "solve_each", lambda matrix, right: _without_first(right, matrix))
    answer, found = newton(terms, begin, np.array([0, 1]))
    assert found.tolist() == [False, True]
    np.testing.assert_array_equal(answer[0], begin[0])
    np.testing.assert_allclose(answer[1], wanted[1], rtol=1e-9)


def _without_first(right: np.ndarray, matrix: np.ndarray) -> np.ndarray:
    """As `solve_each`, the first of several with a singular matrix."""
    out = solve_each(matrix, right).astype(complex)
    out[: len(out) - 1] = complex(np.inf, 0.0)
    return out


@kills(
    "solvers.synchronous.coupled:_linearised",
    "- squared[:, None] * ((secant * w) @ p)",
    "- squared[:, None] * ((law.slope * w) @ p)",
)
@kills(
    "solvers.synchronous.coupled:_linearised",
    "- squared[:, None] * ((secant * w) @ p)",
    "- squared[:, None] * ((secant * w) @ np.conj(p))",
)
def test_balance() -> None:
    """Chambers in three planes of an anisotropic rotor, walls partly dry: the forces balance one by one."""
    system, speed = tub().system(), np.linspace(5.0, 40.0, 24)
    wet = [at_plane(z, v, 0.18, 0.12) for z, v in ((0.12, 2e-5), (0.0, 5e-5), (-0.1, 1e-4))]
    for gravity in (0.0, 9.81):
        found = response(system, wet, speed, gravity)
        assert found.converged.all() and found.dry_patch.any()
        q = found.coordinates
        held = q @ system.stiffness.T - speed[:, None] ** 2 * q @ system.mass.T
        held = held + 1j * speed[:, None] * (q @ system.damping.T + speed[:, None] * q @ system.gyroscopic.T)
        force = speed[:, None] ** 2 * system.unbalance
        for k, fill in enumerate(wet):
            f, g = (part[:, k] for part in at_chambers(system, found, wet))
            state = equilibrium(fill.chamber, fill.volume, np.abs(f), speed, gravity)
            forward = speed**2 * fill.liquid.density * state.unbalance()[0] * f / np.abs(f)
            backward = speed**2 * backward_mass(fill) * g
            first, second = forward + np.conj(backward), -1j * (forward - np.conj(backward))
            force = force + np.stack((first, second), axis=1) @ system.at(fill.chamber.plane)
        scale = np.abs(system.stiffness).max() * np.abs(q).max()
        np.testing.assert_allclose(held, force, atol=1e-10 * scale)


@kills(
    "solvers.synchronous.response:_added_mass",
    "0.5 * full * np.outer(p, np.conj(p))",
    "full * np.outer(p, np.conj(p))",
)
@kills(
    "solvers.synchronous.response:_added_mass",
    "0.5 * backward_mass(fill) * np.outer",
    "backward_mass(fill) * np.outer",
)
def test_critical_speeds() -> None:
    """As of the planar rotor with liquid, at any gravity; dry without liquid; discs where it is full."""
    for wet in (fills(1e-4, 8e-5), [Fill(Chamber(0.2, 0.5), WATER, 0.02)]):
        for gravity in (0.0, 9.81):
            rotor = rig() if wet[0].chamber.height < 0.1 else Jeffcott(30.0, 30.0 * 8.0**2, 1.0, 0.0)
            speed, _ = wet_critical_speeds(rotor.system(), wet, gravity)
            assert speed.min() == pytest.approx(critical_speed(rotor, wet, gravity), rel=1e-9)
    system = tub(0.0).system()
    np.testing.assert_allclose(
        wet_critical_speeds(system, [], 0.0)[0], critical_speeds(system)[0], rtol=1e-12
    )
    full = at_plane(0.1, Chamber(0.18, 0.02).capacity, 0.18)
    heavy = with_discs(system, [(full.mass, 0.1)])
    np.testing.assert_allclose(
        wet_critical_speeds(system, [full], 0.0)[0], critical_speeds(heavy)[0], rtol=1e-10
    )


def test_no_liquid_is_the_dry_rotor() -> None:
    system, speed = tub().system(), np.linspace(2.0, 100.0, 30)
    expected = orbit(system, unbalance_response(system, speed), 0.1)
    for wet in ([], [at_plane(0.1, 0.0)], [at_plane(0.1, 0.0), at_plane(-0.1, 0.0)]):
        found = response(system, wet, speed, position=0.1)
        np.testing.assert_allclose(found.deflection, expected.forward, rtol=1e-13)
        np.testing.assert_allclose(found.backward, expected.backward, rtol=1e-13)
        assert found.converged.all() and not found.liquid_offset.any()
    # A trace of liquid changes nothing.
    trace = response(system, [at_plane(0.1, 1e-12)], speed, 0.0)
    np.testing.assert_allclose(trace.deflection, expected.forward, rtol=1e-3)


def test_no_unbalance_stands_still() -> None:
    still = TwoPlane(10.0, 0.5, 0.1, (Support(-0.2, 1e4, 1.0), Support(0.2, 1e4, 1.0))).system()
    for wet in ([at_plane(0.0, 1e-5)], [at_plane(0.1, 1e-5), at_plane(-0.1, 1e-5)]):
        found = response(still, wet, [50.0, 100.0], 0.0)
        assert not found.deflection.any() and found.converged.all()


def test_an_undamped_resonance_is_said() -> None:
    rotor = Jeffcott(4.0, 4e4, 0.0, 6e-4).system()
    found = response(rotor, [], [99.0, 100.0, 101.0])
    np.testing.assert_array_equal(found.converged, [True, False, True])
    assert np.isinf(np.abs(found.deflection[1])) and np.isfinite(found.residual).all()
    wet = response(rotor, fills(1e-5), [99.0, 101.0], 0.0)
    assert wet.converged.all()


@given(share=st.floats(1e-9, 1.0), radius=st.floats(0.01, 10.0), inner=st.floats(0.0, 0.9))
def test_a_layer_resists_a_backward_whirl_with_less_than_its_mass(
    share: float, radius: float, inner: float
) -> None:
    chamber = Chamber(radius, 0.1, inner * radius)
    fill = Fill(chamber, WATER, share * chamber.capacity)
    # 7/8 of the liquid where the layer is thin, all of it where the drum is full; kappa = 1 + 1e-9 has seven
    # digits left.
    assert 0.875 * (1.0 - 1e-6) <= backward_mass(fill) / fill.mass <= 1.0 + 1e-6


def rigid() -> TwoPlane:
    return TwoPlane(
        20.0, 0.7, 0.2, (Support(-0.3, 1e15, 0.0), Support(0.3, 1e15, 0.0)), (PlaneUnbalance(0.1, 1e-3),)
    )


EXTREMES = {
    "16 planes": (two_plane, np.linspace(-0.3, 0.3, 16), 3e-5, np.linspace(20.0, 300.0, 20)),
    "rigid supports": (rigid, (-0.2, 0.2), 3e-6, np.linspace(20.0, 300.0, 20)),
    "no damping": (lambda: two_plane(0.0), (-0.2, 0.2), 3e-6, np.linspace(21.0, 300.0, 20)),
    "a trace of liquid": (two_plane, (-0.2, 0.2), 1e-12, np.linspace(20.0, 300.0, 20)),
    "any speed": (two_plane, (-0.2, 0.2), 3e-6, np.geomspace(1e-3, 1e5, 20)),
}


@pytest.mark.parametrize("name", EXTREMES)
@pytest.mark.parametrize("gravity", [0.0, 9.81])
def test_extremes(name: str, gravity: float) -> None:
    machine, places, volume, speed = EXTREMES[name]
    wet = [at_plane(float(z), volume, 0.06) for z in places]
    found = response(machine().system(), wet, speed, gravity)
    assert found.converged.all() and found.residual.max() < 1e-9
    assert np.isfinite(found.deflection).all()


@pytest.mark.parametrize(("speed", "model"), [([0.0], "auto"), ([math.nan], "auto"), ([1.0], "long_wave")])
def test_bad_input(speed: list[float], model: str) -> None:
    with pytest.raises(InputError):
        response(two_plane(), [], speed, model=synchronous_model(model))
