"""Self-excited whirl: known bands, independent eigenproblems and roots, energy, Nyquist's count, limits."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mpmath import mp, polyroots
from scipy.linalg import expm

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.whirl import Layer, layer_rate, plane_layer
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.synchronous.response import response
from solvers.whirl import edges as whirl_edges
from solvers.whirl.edges import unstable_bands
from solvers.whirl.growth import (
    asynchronous_growth,
    dominant,
    growth_at,
    growth_map,
    planar_layers,
    system_modes,
)
from solvers.whirl.laminar import _eliminate, _layer_waves, _Problem
from solvers.whirl.planar import PlanarProblem, planar_modes
from solvers.whirl.system import coupled_matrices
from tests.mutants import kills
from tests.oracles.edges import undamped_edges

WATER = Liquid("water", 1000.0, 1e-6)
RADIUS, HEIGHT, NATURAL = 0.1, 0.02, 100.0
FULL = 1000.0 * math.pi * RADIUS**2 * HEIGHT
NO_FRICTION = Friction()


def machine(mu: float, depth: float, zeta: float = 0.0, viscosity: float = 1e-6) -> tuple[Jeffcott, Fill]:
    """A Jeffcott rotor of 100 rad/s with one chamber: m_f/M, h0/R, damping ratio."""
    mass = FULL / mu
    chamber = Chamber(RADIUS, HEIGHT)
    fill = Fill(chamber, Liquid("any", 1000.0, viscosity), (1.0 - (1.0 - depth) ** 2) * chamber.capacity)
    return Jeffcott(mass, mass * NATURAL**2, 2.0 * zeta * mass * NATURAL, 0.0), fill


def not_planar(rotor: Jeffcott) -> RotorSystem:
    """The same machine, sent through the solver of any rotor."""
    return rotor.system()


def wolf(mu: float, depth: float, zeta: float, spin: float, rate: float) -> np.ndarray:
    """Roots omega of the characteristic equation in kappa, from D and the force of Newton's law.

    (K - M w^2 + i C w) D - m_l w^2 (D - w^2) with M = 1, K = 1e4.
    """
    kappa = 1.0 / (1.0 - depth) ** 2
    omega, s = np.poly1d([1.0, 0.0]), np.poly1d([1.0, -spin])
    d = (1.0 - kappa) * omega**2 + 2.0 * kappa * s**2 - 1j * rate * (1.0 + kappa) * s
    rotor = np.poly1d([-1.0, 2j * zeta * NATURAL, NATURAL**2])
    liquid = mu * (1.0 - 1.0 / kappa)
    return np.asarray((rotor * d - liquid * omega**2 * (d - omega**2)).roots)


@kills(
    "solvers.whirl.planar:_scaled",
    "damping=problem.damping / mass / spin",
    "damping=0.5 * problem.damping / mass / spin",
)
@kills("solvers.whirl.planar:_scaled", "mass=1.0 + share.sum", "mass=1.0 - share.sum")
@kills(
    "solvers.whirl.planar:_scaled",
    "2.0 * t + 1j * problem.rate",
    "2.0 * t - 1j * problem.rate",
)
@kills(
    "solvers.whirl.planar:_scaled",
    "share * 0.5 * (1.0 - t)",
    "share * 0.5 * (1.0 + t)",
)
@kills(
    "solvers.whirl.system:coupled_matrices",
    "layer.mass / (0.5 * (1.0 - layer.layer_tanh))",
    "layer.mass / (0.5 * (1.0 + layer.layer_tanh))",
)
@kills("solvers.whirl.system:coupled_matrices", "(drag + 2.0 *", "(drag - 2.0 *")
def test_characteristic_equation() -> None:
    """Growth and whirl speed of the fastest of the polynomial's roots."""
    spins = np.array([30.0, 95.0, 128.0, 160.0, 400.0])
    for mu, depth, zeta, k in ((0.1, 0.1, 0.05, 0.0), (0.5, 0.2, 0.02, 3.0), (0.3, 0.6, 0.1, 40.0)):
        system, fill = machine(mu, depth, zeta)
        # k h R/A with A = (R^2 - a^2)/2.
        rate = k * 2.0 / (2.0 - depth)
        roots = [wolf(mu, depth, zeta, spin, rate) for spin in spins]
        best = np.array([one[np.argmin(one.imag)] for one in roots])
        for one in (system, not_planar(system)):
            growth, whirl = asynchronous_growth(one, [fill], spins, Friction("linear", k))
            # The polynomial in omega has lost some digits where its roots are close.
            np.testing.assert_allclose(growth, -best.imag, rtol=0.0, atol=1e-8 * NATURAL)
            np.testing.assert_allclose(whirl, best.real, rtol=1e-8)


def scan(mu: float, depth: float, zeta: float) -> tuple[np.ndarray, np.ndarray]:
    """Speeds over the natural frequency in steps of 5e-4 and growth over it."""
    ratio = np.arange(0.3, 4.0, 5e-4)
    system, fill = machine(mu, depth, zeta)
    return ratio, asynchronous_growth(system, [fill], ratio * NATURAL)[0] / NATURAL


@kills("solvers.whirl.growth:dominant", "-np.inf, -omega.imag)", "-np.inf, omega.imag)")
def test_published_bands() -> None:
    """Edges to the step of the scan, peaks to the last digit given."""
    for mu, depth, low, high in ((0.1, 0.1, 1.1225, 1.475), (0.5, 0.2, 0.969, 1.699)):
        ratio, growth = scan(mu, depth, 0.0)
        inside = ratio[growth > 0.0]
        assert np.all(np.diff(inside) < 6e-4)
        assert inside[0] == pytest.approx(low, abs=6e-4) and inside[-1] == pytest.approx(high, abs=6e-4)
    assert np.max(scan(0.1, 0.1, 0.0)[1]) == pytest.approx(0.066, abs=5e-4)
    damped = scan(0.1, 0.1, 0.05)[1]
    assert np.all(damped > 0.0) and np.max(damped) == pytest.approx(0.046, abs=5e-4)


@kills("solvers.whirl.growth:dominant", "- _EQUAL * np.abs(omega)", "")
def test_whirls_that_die_alike() -> None:
    """Forward and backward whirl of a rotor that hardly knows of its spin: rounding does not choose."""
    spin, size = np.array([1000.0]), 0.16 + 2.5e-4j
    for nudge in (1.0 - 1e-12, 1.0, 1.0 + 1e-12):
        omega = np.array([[-size.real + size.imag * 1j * nudge], [size]])
        growth, whirl = dominant(omega, np.full((2, 1), 1e-17), spin)
        assert whirl[0] == size.real
        assert growth[0] == pytest.approx(-size.imag, rel=1e-11)


def discriminant(mu: float, depth: float, ratio: mp.mpf) -> mp.mpf:
    """Product of squared differences of the frictionless quartic's roots, in 40 digits."""
    kappa = 1 / (1 - mp.mpf(depth)) ** 2
    w = mp.mpf(ratio)
    # D = (1 + kappa) x^2 - 4 kappa w x + 2 kappa w^2; x^2 (D - x^2) = D x^2 - x^4.
    d = [1 + kappa, -4 * kappa * w, 2 * kappa * w**2]
    liquid = mp.mpf(mu) * (1 - 1 / kappa)
    quartic = [-(1 + liquid) * d[0] + liquid, -(1 + liquid) * d[1], d[0] - (1 + liquid) * d[2], d[1], d[2]]
    roots = polyroots(quartic, maxsteps=200, extraprec=200)
    product = mp.mpf(1)
    for i in range(4):
        for j in range(i):
            product *= (roots[i] - roots[j]) ** 2
    return mp.re(product)


def exact_edge(mu: float, depth: float, low: float, high: float) -> float:
    with mp.workdps(40):
        low, high = mp.mpf(low), mp.mpf(high)
        first = mp.sign(discriminant(mu, depth, low))
        for _ in range(45):
            middle = (low + high) / 2
            if mp.sign(discriminant(mu, depth, middle)) == first:
                low = middle
            else:
                high = middle
        return float(low)


def test_refined_edges() -> None:
    """To 1e-8 against the sign of the discriminant in 40 digits, and by the extrema of the stiffness."""
    speeds = np.linspace(30.0, 400.0, 75)
    for mu, depth, brackets in (
        (0.1, 0.1, ((1.1, 1.2), (1.4, 1.5))),
        (0.5, 0.2, ((0.9, 1.0), (1.6, 1.8))),
    ):
        exact = [exact_edge(mu, depth, *one) for one in brackets]
        system, fill = machine(mu, depth)
        ((band,),) = unstable_bands(system, [[fill]], speeds)
        np.testing.assert_allclose(np.array(band) / NATURAL, exact, rtol=1e-8)
        mass, layers = planar_layers(FULL / mu, [fill], NO_FRICTION)
        edges = undamped_edges(mass, mass * NATURAL**2, layers)
        np.testing.assert_allclose(edges / NATURAL, exact, rtol=1e-10)


@kills("solvers.whirl.edges:_refine", "(rates > 0.0) != first", "(rates > 0.0) == first")
def test_edges_with_friction() -> None:
    """On either side of each edge the growth has the sign it should; outside all is decay."""
    speeds = np.linspace(30.0, 400.0, 200)
    for friction in (Friction("linear", 5.0), Friction("stokes")):
        for system, fill in (machine(0.1, 0.1, 0.05), machine(0.1, 0.02, 0.02)):
            (bands,) = unstable_bands(system, [[fill]], speeds, friction)
            assert bands
            for low, high in bands:
                around = np.array([low * (1 - 1e-8), low * (1 + 1e-8), high * (1 - 1e-8), high * (1 + 1e-8)])
                growth, _ = asynchronous_growth(system, [fill], around, friction)
                assert np.array_equal(growth > 0.0, [False, True, True, False])


@kills("solvers.whirl.edges:_refine", "np.divide(at_a, at_a - at_b", "np.divide(at_b, at_a - at_b")
def test_edge_steps() -> None:
    """Secants need few looks: the growth at an edge is as good as linear."""
    looks = []

    def counted(*arguments: object) -> tuple[np.ndarray, np.ndarray]:
        looks.append(1)
        return growth_at(*arguments)  # type: ignore[arg-type]

    system, fill = machine(0.1, 0.1, 0.05)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(whirl_edges, "growth_at", counted)
        unstable_bands(system, [[fill]], np.linspace(30.0, 400.0, 75), Friction("linear", 5.0))
    # Quarters alone take 15 rounds from a step of 5 to 1e-10; one call is not at the edges.
    assert len(looks) - 1 <= 7


def test_thin_film() -> None:
    """The band of a film, off the grid here, lies between the critical speeds with and without added mass."""
    speeds = np.linspace(30.0, 400.0, 20)
    for depth in (1e-5, 1e-7):
        system, fill = machine(0.1, depth)
        growth, _ = asynchronous_growth(system, [fill], speeds)
        assert not growth.any()
        (bands,) = unstable_bands(system, [[fill]], speeds)
        assert len(bands) == 1
        band = bands[0]
        # The waves run at sqrt(T) = sqrt(h/R) of the spin, which sets how far the edges are from the limit.
        near = 2.0 * math.sqrt(depth)
        assert band[0] == pytest.approx(NATURAL / math.sqrt(1.1), rel=near)
        assert band[1] == pytest.approx(NATURAL, rel=4.0 * near ** (2.0 / 3.0))
        mass, layers = planar_layers(FULL / 0.1, [fill], NO_FRICTION)
        np.testing.assert_allclose(band, undamped_edges(mass, mass * NATURAL**2, layers), rtol=1e-8)


def motion(system: Jeffcott, fill: Fill, spin: float, rate: float) -> np.ndarray:
    """First-order matrix of (w, d, w', d') in complex coordinates, from the equation of the offset."""
    mass, stiffness, damping = system.mass, system.stiffness, system.damping
    kappa = (RADIUS / fill.surface_radius) ** 2
    liquid = fill.mass
    inertia = np.array([[mass + liquid, liquid], [1.0, 1.0 + kappa]], dtype=complex)
    drag = np.array([[damping, 0.0], [0.0, rate * (1.0 + kappa) - 4j * kappa * spin]])
    spring = np.array([[stiffness, 0.0], [0.0, -2.0 * kappa * spin**2 - 1j * rate * (1.0 + kappa) * spin]])
    inverse = np.linalg.inv(inertia)
    return np.block([[np.zeros((2, 2)), np.eye(2)], [-inverse @ spring, -inverse @ drag]])


@kills("solvers.whirl.growth:machines_growth", "found.slip + speed[here]", "found.slip - speed[here]")
def test_time() -> None:
    """A small disturbance advanced in time grows, or decays, at the rate given."""
    for spin, k in ((128.0, 0.0), (128.0, 5.0), (95.0, 5.0), (300.0, 5.0)):
        system, fill = machine(0.1, 0.1, 0.05)
        time = 2.3 / spin
        step = expm(motion(system, fill, spin, k * 2.0 / 1.9) * time)
        state, sizes = np.array([1e-6, 2e-6j, 1e-4, 0.0]), []
        for _ in range(12000):
            state = step @ state
            sizes.append(np.linalg.norm(state))
            state = state / sizes[-1]
        # The slowest of the other modes has died out against this one.
        rate = math.log(sizes[-1]) / time
        growth, whirl = asynchronous_growth(system, [fill], [spin], Friction("linear", k))
        assert growth[0] == pytest.approx(rate, rel=1e-6)
        turned = step @ state
        phase = math.remainder(whirl[0] * time - np.angle(turned[0] / state[0]), 2.0 * math.pi)
        assert abs(phase) < 1e-6


def test_energy() -> None:
    """Slow growth is the work of the dampers over twice the energy, negative for the retrograde wave."""
    zeta, spin = 1e-4, 250.0
    for k in (0.0, 1e-3):
        system, fill = machine(0.1, 0.1, zeta)
        rate = k * 2.0 / 1.9
        values, vectors = np.linalg.eig(motion(system, fill, spin, rate))
        # The wave against the spin: slower than the drum, faster than the rotor's whirl.
        pick = int(np.argmin(np.abs(values.imag - 0.74 * spin)))
        w, d, dw, dd = vectors[:, pick]
        mass, stiffness, damping = system.mass, system.stiffness, system.damping
        kappa, liquid = (RADIUS / fill.surface_radius) ** 2, fill.mass
        energy = 0.5 * (mass * abs(dw) ** 2 + stiffness * abs(w) ** 2 + liquid * abs(dw + dd) ** 2)
        energy += 0.5 * liquid * (kappa * abs(dd) ** 2 - 2.0 * kappa * spin**2 * abs(d) ** 2)
        assert energy < 0.0
        drag = liquid * (1.0 + kappa) * rate * (np.conj(dd) * (dd - 1j * spin * d)).real
        power = -damping * abs(dw) ** 2 - drag
        growth = system_modes(system, [fill], np.array([spin]), Friction("linear", k)).root.real
        # To second order in the dampings, 1e-4.
        assert np.min(np.abs(growth / (power / (2.0 * energy)) - 1.0)) < 1e-3
    growth, _ = asynchronous_growth(machine(0.1, 0.1, zeta)[0], [fill], [spin])
    assert growth[0] > 0.0


@kills("solvers.whirl.system:coupled_matrices", "+= layer.mass * at.T @ at", "-= layer.mass * at.T @ at")
@kills("solvers.whirl.system:coupled_matrices", "(spin * drag @ turn", "(-spin * drag @ turn")
@kills(
    "solvers.whirl.system:coupled_matrices",
    "- (1.0 + t) * np.square(spin) * unit",
    "- (1.0 - t) * np.square(spin) * unit",
)
def test_synchronous() -> None:
    """Driven by an unbalance the same equations give the synchronous response while the wall is wet."""
    rotor = Jeffcott(6.0, 6.0e4, 80.0, 1e-6)
    chambers = (Chamber(0.1, 0.02), Chamber(0.08, 0.03))
    fills = [Fill(one, WATER, 0.2 * one.capacity) for one in chambers]
    speeds = np.array([40.0, 90.0, 150.0])
    answer = response(rotor, fills, speeds, gravity=0.0)
    assert not answer.dry_patch.any()
    system = rotor.system()
    layers = [(0.0, plane_layer(fill, Friction("linear", 2.0))) for fill in fills]
    matrices = coupled_matrices(system, [(z, one) for z, one in layers if one is not None], speeds)
    for k, spin in enumerate(speeds):
        dynamic = matrices.stiffness[k] + 1j * spin * matrices.damping[k] - spin**2 * matrices.mass
        force = np.zeros(6, dtype=complex)
        force[:2] = spin**2 * system.unbalance
        x, y = np.linalg.solve(dynamic, force)[:2]
        assert x == pytest.approx(answer.deflection[k], rel=1e-10)
        assert y == pytest.approx(-1j * answer.deflection[k], rel=1e-10)


def laminar_function(system: Jeffcott, fill: Fill, spin: float, s: np.ndarray) -> np.ndarray:
    """Characteristic function with laminar friction, in kappa, the square root as it stands."""
    mass, stiffness, damping = system.mass, system.stiffness, system.damping
    kappa, omega = (RADIUS / fill.surface_radius) ** 2, s + spin
    a, nu, t = fill.surface_radius, fill.liquid.viscosity, (kappa - 1.0) / (kappa + 1.0)
    # Floor and lid drag on two circles.
    plates = (1.0 - t) * np.sqrt(1j * (s + 2.0 * spin)) + (1.0 + t) * np.sqrt(1j * (s - 2.0 * spin))
    wall = np.sqrt(1j * nu * s) * 4.0 * RADIUS * a**2 / ((RADIUS - a) * (RADIUS + a) * (RADIUS**2 + a**2))
    rate = wall + math.sqrt(nu) * plates / HEIGHT
    d = (1.0 - kappa) * omega**2 + 2.0 * kappa * s**2 - 1j * rate * (1.0 + kappa) * s
    rotor = stiffness - mass * omega**2 + 1j * damping * omega
    return np.asarray(rotor * d - fill.mass * omega**2 * (d - omega**2))


@kills("solvers.whirl.planar:_scaled", "problem.stokes / np.sqrt(spin)", "problem.stokes / spin")
@kills(
    "solvers.whirl.planar:_polynomial", "wave - drag * (square * x), bend", "wave + drag * (square * x), bend"
)
@kills("solvers.whirl.planar:_chunk", "admitted = x.real > 0.0", "admitted = x.imag > 0.0")
@kills(
    "solvers.whirl.planar:_chunk",
    "np.where(admitted, -1j * np.square(x)",
    "np.where(admitted, 1j * np.square(x)",
)
def test_laminar() -> None:
    """Modes solve the equation with its square root; Nyquist counts as many growing ones."""
    unstable = 0
    for viscosity, depth, zeta in ((1e-6, 0.1, 0.05), (1e-4, 0.1, 0.0), (1e-3, 0.3, 0.1), (1e-6, 1e-4, 0.02)):
        system, fill = machine(0.1, depth, zeta, viscosity)
        for spin in (60.0, 118.0, 130.0, 350.0):
            layer = plane_layer(fill, Friction("stokes"))
            assert layer is not None
            one = np.ones((1, 1))
            mass, stiffness, damping = system.mass, system.stiffness, system.damping
            problem = PlanarProblem(
                *(np.array([x]) for x in (mass, stiffness, damping, spin)),
                fill.mass * one,
                *(layer.layer_tanh * one, 0.0 * one, layer.stokes * one, layer.lids * one),
            )
            slip = planar_modes(problem).slip[:, 0]
            slip = slip[~np.isnan(slip)]
            near = slip[:, None] * (1.0 + 1e-6 * np.exp(2j * np.pi * np.arange(8) / 8))
            # A root that is right to 1e-9 is a thousandth of the value a millionth off it.
            around = np.min(np.abs(laminar_function(system, fill, spin, near)), axis=1)
            assert np.all(np.abs(laminar_function(system, fill, spin, slip)) < 1e-2 * around)
            # Around the lower half plane, where the square root is analytic.
            line = np.concatenate([-np.geomspace(1e9, 1e-9, 200_000), np.geomspace(1e-9, 1e9, 200_000)])
            arc = 1e9 * np.exp(-1j * np.linspace(0.0, np.pi, 2000))
            path = laminar_function(system, fill, spin, np.concatenate([line, arc]))
            turns = np.angle(np.roll(path, -1) / path).sum() / (2.0 * np.pi)
            growing = int(np.sum(slip.imag < 0.0))
            assert -turns == pytest.approx(growing, abs=1e-6)
            unstable += growing
    assert unstable > 3


@kills(
    "solvers.whirl.laminar:_eliminate", "np.square(root) * (1.0 - share)", "np.square(root) * (1.0 + share)"
)
@kills(
    "solvers.whirl.laminar:_eliminate",
    "turned = root - 1j * c.sense * spin",
    "turned = root + 1j * c.sense * spin",
)
@kills(
    "solvers.whirl.laminar:_eliminate",
    "asarray(0.5 * (1.0 - c.tanh) * np",
    "asarray(0.5 * (1.0 + c.tanh) * np",
)
@kills("solvers.whirl.laminar:_eliminate", "+ c.tanh * np.square(spin)", "- c.tanh * np.square(spin)")
def test_any_rotor() -> None:
    """The solver of any rotor with laminar friction finds what the one for one plane does."""
    speeds = np.array([50.0, 118.0, 130.0, 250.0])
    for depth, zeta, viscosity in ((0.1, 0.05, 1e-6), (0.3, 0.0, 1e-4), (0.02, 0.02, 1e-5)):
        system, fill = machine(0.2, depth, zeta, viscosity)
        small = Fill(Chamber(0.06, 0.03), fill.liquid, 5e-5)
        for fills in ([fill], [fill, small], [fill, fill, fill]):
            for friction in (NO_FRICTION, Friction("linear", 2.0), Friction("stokes")):
                planar = asynchronous_growth(system, fills, speeds, friction)
                other = asynchronous_growth(not_planar(system), fills, speeds, friction)
                np.testing.assert_allclose(other[0], planar[0], rtol=0.0, atol=1e-9 * NATURAL)
                moving = planar[0] != 0.0
                np.testing.assert_allclose(other[1][moving], planar[1][moving], rtol=1e-8)


@kills("solvers.whirl.laminar:_eliminate", "+ 1.5 * friction", "+ 1.0 * friction")
@kills("solvers.whirl.laminar:_eliminate", "2.0 - 4.0 * share", "2.0 - 2.0 * share")
def zeros_of_the_waves(layer: Layer, spin: float) -> np.ndarray:
    """All zeros s/Omega of E on the sheet where layers die out, by Newton's method from a grid."""
    t, wall, lids = layer.layer_tanh, layer.stokes / math.sqrt(spin), layer.lids / math.sqrt(spin)
    x, y = np.meshgrid(np.linspace(-9.0, 9.0, 46), np.linspace(-1.0, 9.0, 26))

    def wave(s: np.ndarray) -> np.ndarray:
        along, against, slow = (np.sqrt(1j * (s + turn)) for turn in (2.0, -2.0, 0.0))
        drag = wall * slow + 0.5 * lids * ((1.0 - t) * along + (1.0 + t) * against)
        return np.asarray(s * s - 2.0 * t * s - t - 1j * drag * s)

    s = (x + 1j * y).ravel()
    moved = np.zeros_like(s)
    with np.errstate(all="ignore"):
        for _ in range(60):
            step = 1e-6 * (1.0 + np.abs(s))
            moved = wave(s) * 2.0 * step / (wave(s + step) - wave(s - step))
            s = s - moved
        s = s[np.abs(moved) < 1e-9 * np.abs(s)]
    return np.unique(np.round(s, 6))


@kills("solvers.whirl.planar:_past_cuts", "g.real < 0.0)", "g.real < -9.0)")
@kills(
    "solvers.whirl.planar:_past_cuts",
    "np.sqrt(1j * end + np.square(g))[0]",
    "np.sqrt(1j * end - np.square(g))[0]",
)
@kills("solvers.whirl.planar:_own", "slope - share * one[1]", "slope + share * one[1]")
def test_modes_beside_the_cuts_of_floor_and_lid() -> None:
    """Slow drums whose layers are as thick as the chamber is high: s is next to -+2 Omega, where roots end.

    On a rotor far stiffer than that the modes are the zeros of E.
    """
    speed = 1e-3
    for share in (0.3, 0.6, 0.9, 1.0 - 1e-6):
        fill = Fill(Chamber(RADIUS, HEIGHT), WATER, share * Chamber(RADIUS, HEIGHT).capacity)
        layer = plane_layer(fill, Friction("stokes"))
        assert layer is not None
        one = np.ones((1, 1))
        problem = PlanarProblem(
            *(np.array([x]) for x in (4.0, 4e4, 80.0, speed)),
            *(x * one for x in (fill.mass, layer.layer_tanh, 0.0, layer.stokes, layer.lids)),
        )
        modes = planar_modes(problem)
        assert modes.converged.all()
        found = modes.slip[:, 0] / speed
        found = found[np.isfinite(found) & (np.abs(found) < 100.0)]
        wanted = zeros_of_the_waves(layer, speed)
        assert wanted.size > 0 and found.size == wanted.size
        # As they were rounded, and the support's stiffness of 1e10 drums.
        assert np.abs(found[:, None] - wanted).min(axis=0).max() < 2e-6


def test_laminar_derivative() -> None:
    """The slope of the eliminated rotor against a central difference."""
    system, fill = machine(0.2, 0.1, 0.05, 1e-4)
    layer = plane_layer(fill, Friction("stokes"))
    assert layer is not None
    problem, spin = _Problem(system.system(), [(0.0, layer)], np.ones(1), 8), np.array([90.0])
    for value in (3.0 + 70.0j, -2.0 - 130.0j):
        root, step = np.array([value]), 1e-4
        ends = [_eliminate(problem, root + side * step, spin) for side in (1.0, -1.0)]
        slope = (ends[0].matrix - ends[1].matrix) / (2.0 * step)
        here = _eliminate(problem, root, spin)
        # Of second order, (step/distance to the pole)^2 of some 1e-11, and rounding over the step.
        np.testing.assert_allclose(here.slope, slope, rtol=1e-6, atol=1e-6 * np.abs(slope).max())


@kills("solvers.whirl.laminar:_layer_waves", "(np.square(own) + 1j) * spin", "(np.square(own) - 1j) * spin")
@kills("solvers.whirl.laminar:_layer_waves", "plates - 2j * t", "plates + 2j * t")
@kills("solvers.whirl.laminar:_layer_waves", "0, 3] = -t", "0, 3] = t")
@kills("solvers.whirl.laminar:_layer_waves", "layer.lids / np.sqrt", "-layer.lids / np.sqrt")
def test_layer_waves() -> None:
    """Waves of a layer alone: zeros of E with its square root as it stands."""
    for stokes, t, rate, lids in ((0.05, 0.1, 0.0, 0.03), (2.0, 0.3, 4.0, 0.0), (3e3, 1e-4, 0.0, 0.5)):
        speed = np.array([20.0, 150.0])
        layer = Layer(1.0, t, rate, stokes, lids)
        waves = _layer_waves(layer, speed)
        for spin, row in zip(speed, waves, strict=True):
            row = row[~np.isnan(row)]
            assert row.size >= 2
            s = -1j * row - spin
            along, against = np.sqrt(1j * (s + 2.0 * spin)), np.sqrt(1j * (s - 2.0 * spin))
            drag = rate + stokes * np.sqrt(1j * s) + 0.5 * lids * ((1.0 - t) * along + (1.0 + t) * against)
            terms = np.abs(s) ** 2 + 2.0 * t * spin * np.abs(s) + t * spin**2 + np.abs(drag * s)
            residual = s**2 - 2.0 * t * spin * s - t * spin**2 - 1j * drag * s
            # s keeps what the spin's size leaves of it.
            assert np.all(np.abs(residual) <= 1e-8 * terms)


def cone(polar: float) -> tuple[RotorSystem, Fill, float]:
    """A rotor that only leans, gyroscopic, with a chamber at 0.2 m."""
    inertia, stiffness, damping, place = 0.05, 500.0, 0.3, 0.2
    one, turn = np.eye(2), np.array([[0.0, 1.0], [-1.0, 0.0]])
    system = RotorSystem(
        *(
            ("a", "b"),
            inertia * one,
            damping * one,
            polar * turn,
            stiffness * one,
            np.zeros(2, dtype=complex),
        ),
        *(0.0 * one, one),
    )
    chamber = Chamber(RADIUS, 0.002, plane=place)
    return system, Fill(chamber, WATER, 0.3 * chamber.capacity), place


@kills("solvers.whirl.system:coupled_matrices", "spin * system.gyroscopic", "-spin * system.gyroscopic")
@kills(
    "solvers.whirl.system:coupled_matrices",
    "system.at(plane)\n        t, inertia",
    "system.at(0.0)\n        t, inertia",
)
@kills(
    "solvers.whirl.system:sense_of",
    "np.where(along + least >= against, 1.0, -1.0)",
    "np.where(along + least >= against, -1.0, 1.0)",
)
def test_cone() -> None:
    """Gyroscopic couple and lever arm against the polynomial of that rotor."""
    for polar in (0.0, 0.03):
        system, fill, place = cone(polar)
        inertia, stiffness, damping = system.mass[0, 0], system.stiffness[0, 0], system.damping[0, 0]
        kappa, k = (RADIUS / fill.surface_radius) ** 2, 1.5
        rate = k * 2.0 * RADIUS / (RADIUS + fill.surface_radius)
        for spin in (90.0, 125.0, 260.0):
            omega, s = np.poly1d([1.0, 0.0]), np.poly1d([1.0, -spin])
            d = (1.0 - kappa) * omega**2 + 2.0 * kappa * s**2 - 1j * rate * (1.0 + kappa) * s
            # i polar Omega a' turns the lean ahead for e^{i w t}: K - J w^2 + P Omega w + i C w.
            rotor = np.poly1d([-inertia, polar * spin + 1j * damping, stiffness])
            roots = (rotor * d - place**2 * fill.mass * omega**2 * (d - omega**2)).roots
            best = roots[np.argmin(roots.imag)]
            growth, whirl = asynchronous_growth(system, [fill], [spin], Friction("linear", k))
            assert growth[0] == pytest.approx(-best.imag, rel=1e-8, abs=1e-8)
            assert whirl[0] == pytest.approx(best.real, rel=1e-8)


@kills("solvers.whirl.growth:planar_layers", "mass += fill.mass", "mass -= fill.mass")
@kills("solvers.whirl.growth:system_modes", "heavy.mass + fill.mass * at.T", "heavy.mass - fill.mass * at.T")
def test_limits() -> None:
    """No liquid: the bare rotor. Full: a heavier one. Stiff supports: no band."""
    system, fill = machine(0.3, 0.2, 0.03)
    chamber, speeds = fill.chamber, np.linspace(20.0, 400.0, 60)
    mass = FULL / 0.3
    for volume, total in ((0.0, mass), (chamber.capacity, mass + FULL)):
        for one in (system, not_planar(system)):
            growth, whirl = asynchronous_growth(one, [Fill(chamber, WATER, volume)], speeds)
            np.testing.assert_allclose(growth, -0.03 * NATURAL * mass / total, rtol=1e-9)
            frequency = math.sqrt(NATURAL**2 * mass / total - growth[0] ** 2)
            np.testing.assert_allclose(np.abs(whirl), frequency, rtol=1e-9)
    stiff = Jeffcott(mass, 1e15, 0.0, 0.0)
    assert not asynchronous_growth(stiff, [fill], speeds)[0].any()
    growth, _ = asynchronous_growth(stiff, [fill], speeds, Friction("stokes"))
    assert np.all(growth < 0.0)
    # Nearly full: the solid mass, its own waves neutral.
    nearly = Fill(chamber, WATER, chamber.capacity * (1.0 - 1e-8))
    undamped, _ = machine(0.3, 0.2)
    assert not asynchronous_growth(undamped, [nearly], np.linspace(20.0, 80.0, 20))[0].any()


@pytest.mark.parametrize("share", [0.0, 1e-9, 1e-4, 0.3, 1.0 - 1e-6, 1.0])
@pytest.mark.parametrize("stiffness", [1e-6, 4e4, 1e15])
@pytest.mark.parametrize("damping", [0.0, 80.0, 1e10])
@pytest.mark.parametrize(
    "friction", [NO_FRICTION, Friction("linear", 0.5), Friction("linear", 1e6), Friction("stokes")]
)
def test_extremes(share: float, stiffness: float, damping: float, friction: Friction) -> None:
    """From 1e-3 to 1e6 rad/s both solvers find all modes and agree to a part of the fastest rate there is."""
    chamber, speeds = Chamber(RADIUS, HEIGHT), np.array([1e-3, 1.0, 60.0, 120.0, 1e4, 1e6])
    system = Jeffcott(4.0, stiffness, damping, 0.0)
    fill = Fill(chamber, WATER, share * chamber.capacity)
    growth, whirl = asynchronous_growth(system, [fill], speeds, friction)
    assert np.isfinite(growth).all() and np.isfinite(whirl).all()
    other, _ = asynchronous_growth(not_planar(system), [fill], speeds, friction)
    scale = np.maximum(np.maximum(speeds, math.sqrt(stiffness / 4.0)), damping / 4.0)
    # Where two roots meet an eigenvalue keeps half of its sixteen digits.
    assert np.all(np.abs(growth - other) <= 1e-7 * scale)


@settings(max_examples=40)
@given(
    mu=st.floats(1e-3, 3.0),
    depth=st.floats(0.01, 0.95),
    zeta=st.sampled_from([0.0, 1e-3, 0.1]),
    k=st.sampled_from([0.0, 0.3, 20.0]),
)
def test_modes_over_the_box(mu: float, depth: float, zeta: float, k: float) -> None:
    """Against the polynomial in kappa, by its residual where its roots are ill-conditioned."""
    system, fill = machine(mu, depth, zeta)
    spins = np.array([40.0, 97.0, 140.0, 500.0])
    growth, whirl = asynchronous_growth(system, [fill], spins, Friction("linear", k))
    for k_spin, spin in enumerate(spins):
        roots = wolf(mu, depth, zeta, spin, k * 2.0 / (2.0 - depth))
        # Roots of the power basis meet to half of their digits.
        assert growth[k_spin] == pytest.approx(-roots.imag.min(), abs=3e-6 * spin)
        if growth[k_spin] != 0.0:
            near = np.min(np.abs(roots - (whirl[k_spin] - 1j * growth[k_spin])))
            assert near < 3e-6 * max(spin, NATURAL)


@settings(max_examples=40)
@given(
    mu=st.floats(0.01, 2.0), depth=st.floats(1e-3, 0.8), other=st.floats(1e-3, 0.8), ratio=st.floats(0.2, 5.0)
)
def test_undamped_growth_is_zero_outside_the_bands(
    mu: float, depth: float, other: float, ratio: float
) -> None:
    """Two chambers: growth above 0 where the count of neutral whirls says so, exactly 0 elsewhere."""
    system, fill = machine(mu, depth)
    chamber = Chamber(0.07, 0.02)
    fills = [fill, Fill(chamber, WATER, other * chamber.capacity)]
    mass, layers = planar_layers(system.mass, fills, NO_FRICTION)
    if len(layers) < 2 or abs(layers[0].layer_tanh / layers[1].layer_tanh - 1.0) < 1e-3:
        return
    edges = undamped_edges(mass, system.stiffness, layers) / NATURAL
    if np.min(np.abs(edges / ratio - 1.0), initial=1.0) < 1e-6:
        return
    growth, _ = asynchronous_growth(system, fills, [ratio * NATURAL])
    # Speeds at infinity are stable: each edge in between adds or takes a pair of whirls.
    found = _real_whirls(mass, system.stiffness, layers, ratio * NATURAL)
    assert (growth[0] > 0.0) == (found < 6)


def _real_whirls(mass: float, stiffness: float, layers: list, spin: float) -> int:  # type: ignore[type-arg]
    """Sign changes of K - Omega^2 Y between and beyond its poles, on a grid that crowds at them."""
    t = np.array([one.layer_tanh for one in layers])
    poles = np.sort(np.concatenate([t + np.sqrt(t * t + t), t - np.sqrt(t * t + t)])) * spin
    ends = np.concatenate([[-1e4 * spin], poles, [1e4 * spin]])
    count = 0
    for low, high in pairwise(ends):
        part = np.geomspace(1e-12, 0.5, 20_000)
        s = np.concatenate([low + (high - low) * part, high - (high - low) * part[::-1]])
        omega = s + spin
        value = stiffness - (mass + sum(one.mass for one in layers)) * omega**2
        for one in layers:
            wave = s * s - 2.0 * one.layer_tanh * spin * s - one.layer_tanh * spin**2
            value = value + one.mass * 0.5 * (1.0 - one.layer_tanh) * omega**4 / wave
        count += int(np.sum(np.sign(value[1:]) != np.sign(value[:-1])))
    return count


def test_map_has_rows_of_volumes_with_different_numbers_of_layers() -> None:
    system, fill = machine(0.1, 0.1, 0.05)
    chamber, speeds = fill.chamber, np.linspace(50.0, 300.0, 40)
    rows = [[Fill(chamber, WATER, share * chamber.capacity)] for share in (0.0, 0.19, 1.0)]
    growth, whirl = growth_map(system, rows, speeds, Friction("linear", 1.0))
    for k, fills in enumerate(rows):
        one, speed = asynchronous_growth(system, fills, speeds, Friction("linear", 1.0))
        np.testing.assert_array_equal(growth[k], one)
        np.testing.assert_array_equal(whirl[k], speed)


def test_quadratic_friction_does_nothing_to_a_small_whirl() -> None:
    system, fill = machine(0.1, 0.1, 0.05)
    without = asynchronous_growth(system, [fill], [130.0])
    assert asynchronous_growth(system, [fill], [130.0], Friction("quadratic", 0.1)) == without


def test_growth_crosses_zero_with_the_rate_of_the_laminar_layer() -> None:
    """Small viscosity: the wave of a layer on a rigid drum decays as the real drag and the inertia say."""
    system, fill = machine(0.1, 0.1)
    stiff = replace(system, stiffness=1e12, damping=1e9)
    layer = plane_layer(fill, Friction("stokes"))
    assert layer is not None
    t, spin = layer.layer_tanh, 40.0
    s = spin * (t - math.sqrt(t * t + t))
    # First order: ds = i k s/(2 (s - T Omega)); second order is k/s, 3 %, of it.
    first = (1j * layer_rate(layer, spin, s) * s / (2.0 * (s - t * spin))).imag
    growth, _ = asynchronous_growth(stiff, [fill], [spin], Friction("stokes"))
    assert growth[0] == pytest.approx(-first, rel=0.05)


@pytest.mark.parametrize("speed", [0.0, -1.0, math.nan, math.inf])
def test_bad_speeds_are_named(speed: float) -> None:
    system, fill = machine(0.1, 0.1)
    with pytest.raises(InputError, match="speed"):
        asynchronous_growth(system, [fill], [10.0, speed])


def test_too_many_layers_are_named() -> None:
    system, _ = machine(0.1, 0.1)
    fills = [Fill(Chamber(0.05 + 0.001 * k, 0.02), WATER, 1e-5) for k in range(51)]
    with pytest.raises(InputError, match="at most 50"):
        asynchronous_growth(system, fills, [100.0])


def test_many_chambers() -> None:
    """Sixteen different ones and sixteen equal ones."""
    system, _ = machine(0.1, 0.1, 0.05)
    for step in (0.002, 0.0):
        fills = [Fill(Chamber(0.05 + step * k, 0.01, plane=0.01 * k), WATER, 2e-5) for k in range(16)]
        for friction in (NO_FRICTION, Friction("stokes")):
            growth, _ = asynchronous_growth(system, fills, [60.0, 105.0, 300.0], friction)
            other, _ = asynchronous_growth(not_planar(system), fills, [60.0, 105.0, 300.0], friction)
            np.testing.assert_allclose(other, growth, rtol=1e-6, atol=1e-6 * NATURAL)
