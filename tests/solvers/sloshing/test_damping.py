"""Damping of the liquid's modes: by hand on the ring, layers solved across their depth, edges, limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fluid.friction.laws import edge_weight, layer_thickness, plate_drags, stokes_coefficient
from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.forced import baffle_edges, mode_damping, wall_loss
from solvers.sloshing.modes import sloshing_modes
from solvers.sloshing.system import condense
from tests.mutants import kills
from tests.oracles.sloshing import ring_decay

R, A, SPIN, HEIGHT, WATER = 0.15, 0.135, 40.0, 0.05, 1e-6


@kills(
    "fluid.friction.laws:decay_rate",
    "first * (k + c) + second * (k - c)",
    "first * (k - c) + second * (k + c)",
)
@kills("fluid.friction.laws:decay_rate", "lost / (k + potential)", "lost / (2.0 * k)")
@kills("solvers.sloshing.forced:mode_damping", "modes.spin / modes.frequency", "modes.frequency / modes.spin")
def test_ring_by_hand() -> None:
    """Both rates of the ring's slowest modes against the integrals of (r/R)^n - (R/r)^n."""
    system = condense(ring(R, A, 96, 6))
    modes = sloshing_modes(system, SPIN, 5)
    for height in (HEIGHT, 0.5, math.inf):
        found = mode_damping(system, modes, WATER, height)
        for k, n in enumerate(modes.crests):
            case = (int(n), float(modes.frequency[k]), SPIN, R, A, min(height, 1e9), WATER)
            # The slope at the wall is that of quadratic elements, (n 2 pi/96)^2/12 of its square.
            bound = 5e-5 * n**2
            assert abs(found.rate[k] / ring_decay(*case, coriolis=True) - 1.0) < bound
            assert abs(found.plain_rate[k] / ring_decay(*case, coriolis=False) - 1.0) < bound
        assert np.all(found.edge_spread == 0.0)


@kills("fluid.friction.laws:plate_drags", "(viscosity, twice - sigma), ", "(viscosity, twice + sigma), ")
@kills("fluid.friction.laws:plate_drags", "2.0 * np.asarray(spin", "1.0 * np.asarray(spin")
def test_plate_layer() -> None:
    """Loss in the layers on a plate against the defect solved as a system: mean of shear times velocity."""
    sigma, nu, along = -17.0, 3e-6, np.array([0.3 - 0.1j, 0.2 + 0.5j])
    matrix = np.array([[-1j * sigma, -2.0 * SPIN], [2.0 * SPIN, -1j * sigma]])
    # d_t + 2 Omega J d = nu d_zz, d = -U on the plate: d = -exp(-z sqrt(matrix/nu)) U, shear nu u_z.
    values, vectors = np.linalg.eig(matrix)
    root = vectors @ np.diag(np.sqrt(values / nu)) @ np.linalg.inv(vectors)
    shear = nu * root @ along
    loss = 0.5 * np.vdot(along, shear).real
    first, second = plate_drags(nu, sigma, SPIN)
    # U_x + i U_y = alpha e^{-i sigma t} + beta e^{i sigma t}
    alpha, beta = 0.5 * (along[0] + 1j * along[1]), 0.5 * np.conj(along[0] - 1j * along[1])
    assert abs(first * abs(alpha) ** 2 + second * abs(beta) ** 2 - loss) < 1e-12 * loss


@kills("solvers.sloshing.forced:mode_damping", "rate(once, g, g)", "rate(once, 2.0 * g, g)")
def test_thin_layer() -> None:
    """The plain rate of a thin layer is half that of the long waves' friction, to the root of its depth."""
    for depth in (1e-2, 1e-3):
        system = condense(ring(R, R * (1.0 - depth), 64, 2))
        modes = sloshing_modes(system, SPIN, 2)
        found = mode_damping(system, modes, 1e-9, HEIGHT)
        friction = stokes_coefficient(1e-9, modes.frequency) * (1.0 / (depth * R) + 2.0 / HEIGHT)
        ratio = found.plain_rate / (0.5 * friction)
        # The energies are unequal by the Coriolis force, +- sqrt(L) for waves with and against the spin.
        assert np.all(np.abs(ratio - 1.0 - np.sign(modes.frequency) * math.sqrt(depth)) < 0.6 * depth)
        # With the Coriolis force floor and lid drag more on waves slower than twice the spin.
        assert np.all(found.rate > found.plain_rate)


@kills(
    "fluid.friction.laws:edge_weight",
    "1.0 / (1.0 + np.asarray(thickness",
    "1.0 / (0.0 + np.asarray(thickness",
)
@kills("solvers.sloshing.forced:baffle_edges", "before[wall[:, 1]] = ", "before[wall[:, 0]] = ")
@kills("solvers.sloshing.forced:baffle_edges", "< _BACK * size", "> -_BACK * size")
def test_edges() -> None:
    """At an edge the square of the slope goes as 1/d: each halving of the cut adds the same, 2 c^2 ln 2."""
    baffles = Baffles(2, 0.139, 0.004, 0.4)
    section = ring(R, A, 48, 3, baffles=baffles, times=2)
    edges = baffle_edges(section)
    exact = [r * np.exp(1j * a) for r in (0.139, 0.146) for a in baffles.angles]
    found = edges @ [1.0, 1j]
    assert len(found) == 4 and all(np.abs(found - one).min() < 1e-12 for one in exact)
    modes = sloshing_modes(condense(section), SPIN, 2)
    cuts = 1e-4 * 0.5 ** np.arange(5)
    loss = np.array([wall_loss(section, modes.psi, np.full(2, cut)) for cut in cuts])
    gain = np.diff(loss, axis=0)
    assert np.all(np.abs(gain[1:] / gain[:-1] - 1.0) < 0.06)
    # Far from edges nothing is cut off; a baffle through the surface has no edge in the liquid.
    assert len(baffle_edges(ring(R, A, 24, 2, baffles=Baffles(3)))) == 0
    assert len(baffle_edges(ring(R, A, 24, 2, baffles=Baffles(3, 0.14)))) == 3
    assert len(baffle_edges(ring(R, A, 24, 2, order=1, baffles=Baffles(3, 0.0, 0.004)))) == 3
    damping = mode_damping(condense(section), modes, WATER, HEIGHT)
    assert np.all((damping.edge_spread > 0.0) & (damping.edge_spread < 0.05))


@kills(
    "fluid.friction.laws:layer_thickness",
    "np.sqrt(2.0 * np.asarray(viscosity",
    "np.sqrt(0.5 * np.asarray(viscosity",
)
@given(
    st.floats(1e-8, 1e-3), st.floats(0.01, 1e3), st.floats(0.01, 1e3), st.floats(1e-9, 1.0)
)  # fmt: skip
def test_layers(viscosity: float, frequency: float, spin: float, distance: float) -> None:
    delta = layer_thickness(viscosity, frequency)
    # sqrt(nu |s|/2) = nu/delta: velocity over thickness.
    assert math.isclose(
        float(stokes_coefficient(viscosity, frequency)), viscosity / float(delta), rel_tol=1e-12
    )
    first, second = plate_drags(viscosity, frequency, spin)
    back, onward = plate_drags(viscosity, -frequency, spin)
    assert first == onward and second == back  # a mode and its conjugate are one motion
    plain = plate_drags(viscosity, frequency, 0.0)
    assert plain[0] == plain[1] == stokes_coefficient(viscosity, frequency)
    weight = float(edge_weight(distance, delta))
    assert 0.0 < weight < 1.0 or math.isclose(weight, 1.0)
    assert math.isclose(float(edge_weight(delta, delta)), 0.5)


def test_rates_go_with_the_root_of_viscosity() -> None:
    system = condense(ring(R, A, 24, 2))
    modes = sloshing_modes(system, SPIN, 3)
    one, four = (mode_damping(system, modes, nu, HEIGHT).rate for nu in (1e-6, 4e-6))
    assert np.allclose(four, 2.0 * one, rtol=1e-12)
    still = mode_damping(system, modes, 0.0, HEIGHT)
    assert np.all(still.rate == 0.0) and np.all(still.edge_spread == 0.0)


def test_bad_input() -> None:
    system = condense(ring(R, A, 16, 1))
    modes = sloshing_modes(system, SPIN, 1)
    for viscosity, height in ((-1.0, 1.0), (1e-6, 0.0), (math.nan, 1.0)):
        with pytest.raises(InputError):
            mode_damping(system, modes, viscosity, height)
