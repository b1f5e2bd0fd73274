"""Modes, unbalance response, orbits, critical speeds and the Campbell diagram of any dry rotor."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag

from meshes.errors import InputError
from solvers.rotor.campbell import campbell
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import Support, TwoPlane
from solvers.rotor.vibration import (
    Modes,
    axis_is_free,
    critical_speeds,
    dynamic_stiffness,
    free_motions,
    modes,
    orbit,
    unbalance_response,
    whirl_direction,
)
from tests.mutants import kills
from tests.oracles.rotors import tub, two_plane

SYSTEMS = [two_plane().system(), tub().system(), tub(40.0).system(), Jeffcott(4.0, 4e4, 84.0, 6e-4).system()]


@kills(
    "solvers.rotor.vibration:modes",
    "omega[:, None, None] * system.gyroscopic",
    "-omega[:, None, None] * system.gyroscopic",
)
@kills(
    "solvers.rotor.vibration:modes",
    "state *= np.tile(scale, 2)[:, None] / np.tile(scale, 2)",
    "state *= np.tile(scale, 2) / np.tile(scale, 2)[:, None]",
)
def test_modes_solve_the_equations() -> None:
    """[lambda^2 M + lambda (C + Omega G) + K] q = 0 for each pair, at rest and turning."""
    for system in SYSTEMS:
        for spin in (0.0, 75.0):
            found = modes(system, spin)
            for value, shape in zip(found.eigenvalue[0], found.shape[0].T, strict=True):
                terms = [
                    value**2 * system.mass @ shape,
                    value * (system.damping + spin * system.gyroscopic) @ shape,
                    system.stiffness @ shape,
                ]
                # Backward stable eigenvalues of a matrix with entries up to K/M ~ 1e5: 1e5 roundings.
                assert np.abs(sum(terms)).max() <= 1e-10 * max(np.abs(one).max() for one in terms)


@kills(
    "solvers.rotor.vibration:modes",
    "-_per_mass(system, system.stiffness)",
    "-2.0 * _per_mass(system, system.stiffness)",
)
def test_rayleigh() -> None:
    """Squares of the undamped frequencies are the energies' quotients of the shapes, each shape a minimum."""
    for system in SYSTEMS:
        found = modes(system, 0.0, damped=False)
        shapes = found.shape[0].real
        strain = np.einsum("ik,ij,jk->k", shapes, system.stiffness, shapes)
        motion = np.einsum("ik,ij,jk->k", shapes, system.mass, shapes)
        np.testing.assert_allclose(found.frequency[0] ** 2, strain / motion, rtol=1e-9)
        bottom = found.frequency[0].min() ** 2
        some = np.random.default_rng(1).normal(size=(200, len(system.coordinates)))
        quotient = np.einsum("ki,ij,kj->k", some, system.stiffness, some)
        quotient /= np.einsum("ki,ij,kj->k", some, system.mass, some)
        assert quotient.min() >= bottom * (1.0 - 1e-12)


@given(zeta=st.floats(0.0, 5.0), frequency=st.floats(1.0, 1e3))
def test_one_oscillator(zeta: float, frequency: float) -> None:
    rotor = Jeffcott(2.0, 2.0 * frequency**2, 4.0 * zeta * frequency, 0.0)
    found = modes(rotor.system())
    if abs(zeta - 1.0) > 1e-3:  # at 1 two roots meet and are known to the square root of rounding only
        damped = frequency * math.sqrt(max(1.0 - zeta**2, 0.0))
        slow = frequency * (zeta - math.sqrt(max(zeta**2 - 1.0, 0.0)))
        np.testing.assert_allclose(found.frequency[0], damped, rtol=1e-8, atol=1e-9 * frequency)
        np.testing.assert_allclose(-found.eigenvalue[0].real, slow, rtol=1e-8, atol=1e-9 * frequency)
        np.testing.assert_allclose(found.damping_ratio, min(zeta, 1.0), rtol=1e-8, atol=1e-12)


@kills("solvers.rotor.vibration:Modes.damping_ratio", "> _ROUNDING * size", "> 0.0 * size")
def test_no_damping_is_no_damping() -> None:
    """Real parts that rounding leaves are none, and have no sign; damping a thousand times that is kept."""
    size = np.array([[50.0, 100.0]])
    for real, ratio in ((3e-15, 0.0), (-3e-15, 0.0), (1e-11, -1e-11 / 50.0), (-1e-11, 1e-11 / 50.0)):
        found = Modes(np.zeros(1), 1j * size + np.array([real, -5.0]), np.zeros((1, 2, 2), complex))
        assert found.damping_ratio[0, 0] == pytest.approx(ratio, rel=1e-9, abs=0.0)
        assert ratio != 0.0 or not np.signbit(found.damping_ratio[0, 0])
        assert found.damping_ratio[0, 1] == pytest.approx(0.05, rel=2e-3)


def test_equal_overdamped_modes_and_free_bodies() -> None:
    """Where eigenvalues are double, rounding must not mix slow and fast roots or let a free body vibrate."""
    for zeta in np.linspace(1.05, 30.0, 60):
        found = modes(Jeffcott(2.0, 2.0 * 37.0**2, 4.0 * zeta * 37.0, 0.0).system())
        slow = 37.0 / (zeta + math.sqrt(zeta**2 - 1.0))
        np.testing.assert_allclose(-found.eigenvalue[0].real, slow, rtol=1e-9)
        assert not found.frequency.any()
    loose = TwoPlane(3.0, 0.1, 0.05, (Support(0.0, 1e4, 1.0),)).system()
    assert np.count_nonzero(modes(loose, 0.0).frequency) == 2
    assert np.count_nonzero(modes(loose, 50.0).frequency) == 3  # and the free top


@kills("solvers.rotor.vibration:free_motions", "square < FREE", "square < -FREE")
@kills("solvers.rotor.vibration:axis_is_free", "(system.centre, system.lean)", "(system.centre,)")
@kills("solvers.rotor.vibration:axis_is_free", "part @ free", "system.centre @ free * 0.0")
def test_motions_that_nothing_holds() -> None:
    """A rod in one support turns about it, one in two does not; a turn about its own axis moves no axis."""
    ends = Support(-0.2, 1e4, 1.0), Support(0.3, 1e4, 1.0)
    hinged = TwoPlane(3.0, 0.1, 0.05, ends[:1]).system()
    free = free_motions(hinged)
    assert free.shape[1] == 2 and axis_is_free(hinged)
    # No force at the support: it stays where it is, and the kinetic energies are those of unit motions.
    np.testing.assert_allclose(hinged.at(-0.2) @ free, 0.0, atol=1e-9)
    np.testing.assert_allclose(free.T @ hinged.mass @ free, np.eye(2), atol=1e-12)
    middle = TwoPlane(3.0, 0.1, 0.05, (Support(0.0, 1e4, 1.0),)).system()  # leans, the centre rests
    assert axis_is_free(middle) and not np.abs(middle.centre @ free_motions(middle)).max() > 1e-9
    assert not axis_is_free(TwoPlane(3.0, 0.1, 0.05, ends).system())
    assert not axis_is_free(tub().system()) and not axis_is_free(Jeffcott(4.0, 4e4, 84.0, 6e-4).system())
    # A coordinate that no spring holds and that moves no axis, as a turn about it.
    held = TwoPlane(3.0, 0.1, 0.05, ends).system()
    wide = replace(
        held,
        coordinates=(*held.coordinates, "turn"),
        mass=block_diag(held.mass, 0.05),
        damping=block_diag(held.damping, 0.0),
        gyroscopic=block_diag(held.gyroscopic, 0.0),
        stiffness=block_diag(held.stiffness, 0.0),
        unbalance=np.append(held.unbalance, 0.0),
        centre=np.pad(held.centre, ((0, 0), (0, 1))),
        lean=np.pad(held.lean, ((0, 0), (0, 1))),
    )
    assert free_motions(wide).shape[1] == 1 and not axis_is_free(wide)


@kills(
    "solvers.rotor.vibration:dynamic_stiffness",
    "system.damping + omega * system.gyroscopic",
    "system.damping - omega * system.gyroscopic",
)
def test_unbalance_in_time() -> None:
    """The steady answer continues itself under time integration, force and gyroscopic terms as they stand."""
    system, speed = tub(3.0).system(), 14.0
    answer = unbalance_response(system, [speed])[0]
    n = len(system.coordinates)

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        force = np.real(speed**2 * system.unbalance * np.exp(1j * speed * t))
        force -= (system.damping + speed * system.gyroscopic) @ y[n:] + system.stiffness @ y[:n]
        return np.concatenate((y[n:], np.linalg.solve(system.mass, force)))

    start = np.concatenate((answer.real, (1j * speed * answer).real))
    end = solve_ivp(rate, (0.0, 1.3), start, method="DOP853", rtol=1e-10, atol=1e-13).y[:n, -1]
    expected = np.real(answer * np.exp(1j * speed * 1.3))
    np.testing.assert_allclose(end, expected, atol=1e-7 * np.abs(answer).max())


@kills(
    "solvers.rotor.vibration:dynamic_stiffness",
    "- np.square(omega) * system.mass",
    "+ np.square(omega) * system.mass",
)
@kills(
    "solvers.rotor.vibration:unbalance_response",
    "np.square(omega)[:, None] * system.unbalance",
    "omega[:, None] * system.unbalance",
)
@kills("solvers.rotor.vibration:orbit", "0.5 * (first + 1j * second)", "0.5 * (first - 1j * second)")
def test_jeffcott() -> None:
    """Closed form of the planar rotor: a circle with the spin."""
    rotor, speed = Jeffcott(4.0, 4e4, 84.0, 6e-4), np.linspace(5.0, 300.0, 60)
    found = orbit(rotor.system(), unbalance_response(rotor.system(), speed), 0.3)
    closed = 6e-4 * speed**2 / rotor.dynamic_stiffness(speed)
    np.testing.assert_allclose(found.forward, closed, rtol=1e-13)
    assert np.abs(found.backward).max() < 1e-15 * np.abs(closed).max()


@kills("solvers.rotor.vibration:orbit", "0.5 * np.conj(first - 1j * second)", "0.5 * (first - 1j * second)")
@kills(
    "solvers.rotor.vibration:Orbit.amplitude",
    "np.abs(self.forward) + np.abs(self.backward)",
    "np.abs(self.forward)",
)
def test_orbit() -> None:
    """Forward and backward part together are the path of the axis; its amplitude is the largest radius."""
    system = tub().system()
    answer = unbalance_response(system, [7.0, 9.0, 20.0])
    phase = np.linspace(0.0, 2.0 * np.pi, 20001)
    found = orbit(system, answer, 0.11)
    for k in range(3):
        first, second = np.real((system.at(0.11) @ answer[k])[:, None] * np.exp(1j * phase))
        path = first + 1j * second
        parts = found.forward[k] * np.exp(1j * phase) + found.backward[k] * np.exp(-1j * phase)
        np.testing.assert_allclose(parts, path, atol=1e-14 * np.abs(path).max())
        # A maximum missed by half a step of 3e-4 rad is off by its square over 8.
        assert found.amplitude[k] == pytest.approx(np.abs(path).max(), rel=2e-8)


@kills(
    "solvers.rotor.vibration:whirl_direction",
    "np.square(np.abs(first + 1j * second))",
    "np.square(np.abs(first - 1j * second))",
)
def test_whirl_direction() -> None:
    """1 for a circle with the spin, -1 against it, 0 for a line, whether the axis shifts or tilts."""
    system = two_plane().system()
    shapes = np.array(
        [[1, -1j, 0, 0], [1, 1j, 0, 0], [1, 0, 0, 0], [0, 0, 1j, 1], [0, 0, -1j, 1]], dtype=complex
    )
    np.testing.assert_allclose(whirl_direction(system, shapes), [1.0, -1.0, 0.0, 1.0, -1.0], atol=1e-15)
    assert whirl_direction(tub().system(), np.array([0, 1.0, 0, 0, 0, 0], dtype=complex)) == 0.0


@kills(
    "solvers.rotor.vibration:critical_speeds",
    "system.mass - 1j * system.gyroscopic",
    "system.mass + 1j * system.gyroscopic",
)
def test_critical_speeds() -> None:
    """There the undamped rotor's dynamic stiffness is singular, and a little damping gives a peak."""
    for machine in (two_plane, tub):
        system = machine(0.0).system()
        speed, shape = critical_speeds(system)
        scale = np.sqrt(np.diag(system.mass))
        for one, q in zip(speed, shape, strict=True):
            matrix = dynamic_stiffness(system, np.array([one]))[0] / (scale[:, None] * scale)
            assert np.abs(matrix @ (scale * q)).max() <= 1e-9 * one**2 * np.abs(scale * q).max()
        light = machine(1e-3).system()
        height = np.abs(unbalance_response(light, np.concatenate((speed, 1.003 * speed))) * scale).max(axis=1)
        # Unless the unbalance does not excite the mode, as backward ones in isotropic supports.
        excited = height[: speed.size] > 3.0 * height[speed.size :]
        assert np.count_nonzero(excited) >= 2


def test_critical_speeds_of_a_disc() -> None:
    """C > A: the forward tilt is never met by the spin, C Omega^2 - A Omega^2 + k33 > 0."""
    rotor = two_plane(0.0, polar=1.2).system()
    assert critical_speeds(rotor)[0].size == 3
    assert critical_speeds(two_plane(0.0, polar=0.16).system())[0].size == 4
    nothing = RotorSystem(("x",), np.eye(1), 0 * np.eye(1), 0 * np.eye(1), 0 * np.eye(1), np.ones(1) + 0j,
                          np.array([[1.0], [0.0]]), np.zeros((2, 1)))  # fmt: skip
    assert critical_speeds(nothing)[0].size == 0


@kills("solvers.rotor.campbell:_followed", "- likeness)[1]", "+ likeness)[1]")
@kills(
    "solvers.rotor.campbell:_refined",
    "return mode(speed, which)[0] - speed",
    "return mode(speed, which)[0] - 0.9 * speed",
)
def test_campbell() -> None:
    """Without dampers the crossings of the lines are the critical speeds; each line is one mode."""
    for machine in (two_plane, tub):
        system = machine(0.0).system()
        closed = critical_speeds(system)[0]
        grid = np.linspace(0.0, 1.3 * closed[-1], 90)
        diagram = campbell(system, grid)
        assert diagram.converged.all()
        np.testing.assert_allclose(diagram.crossing, closed, rtol=1e-8)
        frequency = np.sort(diagram.frequency, axis=1)
        np.testing.assert_allclose(frequency, np.sort(modes(system, grid).frequency, axis=1), rtol=1e-9)
        # A line does not jump to another one: its curvature stays small.
        bend = np.abs(np.diff(diagram.frequency, 2, axis=0)).max()
        assert bend < 0.2 * np.abs(np.diff(diagram.frequency, axis=0)).max() + 1e-9


def test_campbell_directions() -> None:
    """In isotropic supports lines that rise with the spin are forward, lines that fall backward."""
    diagram = campbell(two_plane().system(), np.linspace(10.0, 400.0, 60))
    rise = np.sign(diagram.frequency[-1] - diagram.frequency[0])
    np.testing.assert_allclose(np.median(diagram.direction, axis=0), rise, atol=1e-6)
    np.testing.assert_allclose(np.abs(diagram.crossing_direction), 1.0, atol=1e-6)


def test_undamped_rotor_at_its_critical_speed() -> None:
    rotor = Jeffcott(4.0, 4e4, 0.0, 6e-4)
    answer = unbalance_response(rotor.system(), [99.0, 100.0, 101.0])
    np.testing.assert_array_equal(np.isfinite(answer).all(axis=1), [True, False, True])
    np.testing.assert_array_equal(
        np.isfinite(orbit(rotor.system(), answer, 0.0).amplitude), [True, False, True]
    )


def test_bad_speeds() -> None:
    system = two_plane().system()
    with pytest.raises(InputError):
        modes(system, math.nan)
    with pytest.raises(InputError):
        unbalance_response(system, [1.0, math.inf])
    for wrong in ([2.0, 1.0], [-1.0, 1.0], [0.0, math.nan]):
        with pytest.raises(InputError):
            campbell(system, wrong)
