"""The rigid rotor in two planes: energies, closed forms, limits."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from meshes.errors import InputError
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import modes, orbit, unbalance_response, whirl_direction
from tests.mutants import kills
from tests.oracles.rotors import free_energy_drift, two_plane


@kills("solvers.rotor.two_plane:_axis", "[0.0, 1.0, -position, 0.0]", "[0.0, 1.0, position, 0.0]")
@kills("solvers.rotor.two_plane:TwoPlane._system", "axis.T @ damper @ axis", "axis.T @ spring @ axis")
def test_support_matrices() -> None:
    """[FF20]: k11 = k1 + k2, k14 = k1 l1 - k2 l2, k33 = k1 l1^2 + k2 l2^2, supports at +l1 and -l2."""
    k1, k2, l1, l2 = 5e4, 4e4, 0.31, 0.35
    system = two_plane().system()
    stiffness = np.zeros((4, 4))
    stiffness[0, 0] = stiffness[1, 1] = k1 + k2
    stiffness[2, 2] = stiffness[3, 3] = k1 * l1**2 + k2 * l2**2
    stiffness[0, 3] = stiffness[3, 0] = k1 * l1 - k2 * l2
    stiffness[1, 2] = stiffness[2, 1] = -(k1 * l1 - k2 * l2)
    np.testing.assert_allclose(system.stiffness, stiffness, rtol=1e-14)
    # The dampers' power is that of their end points.
    rate = np.array([0.3, -0.2, 0.5, 0.7])
    power = sum(
        c * ((rate[0] + z * rate[3]) ** 2 + (rate[1] - z * rate[2]) ** 2)
        for z, c in ((-0.35, 20.0), (0.31, 40.0))
    )
    assert rate @ system.damping @ rate == pytest.approx(power, rel=1e-14)


@kills(
    "solvers.rotor.two_plane:Support.across",
    "np.diag(_in_two(self.damping))",
    "np.diag(_in_two(self.damping)[::-1])",
)
@kills(
    "solvers.rotor.two_plane:Support.across",
    "np.diag(_in_two(self.stiffness))",
    "np.diag(_in_two(self.stiffness)[::-1])",
)
def test_unlike_supports() -> None:
    """Without gyroscopic moments the two directions are two machines, each as if its supports were alike."""
    first, second = (3e4, 20.0), (2e4, 50.0)
    unlike = TwoPlane(10.0, 0.5, 0.0, tuple(Support(z, (3e4, 2e4), (20.0, 50.0)) for z in (-0.3, 0.25)))
    for pair, (stiffness, damping) in (((0, 3), first), ((1, 2), second)):
        alike = TwoPlane(10.0, 0.5, 0.0, tuple(Support(z, stiffness, damping) for z in (-0.3, 0.25)))
        for name in ("stiffness", "damping"):
            found, expected = (getattr(each.system(), name)[np.ix_(pair, pair)] for each in (unlike, alike))
            np.testing.assert_allclose(found, expected, rtol=1e-14)
    others = np.ix_((0, 3), (1, 2))
    np.testing.assert_array_equal(unlike.system().stiffness[others], 0.0)


def test_symmetry() -> None:
    system = two_plane().system()
    np.testing.assert_array_equal(system.mass, system.mass.T)
    np.testing.assert_array_equal(system.stiffness, system.stiffness.T)
    np.testing.assert_array_equal(system.gyroscopic, -system.gyroscopic.T)


@kills(
    "solvers.rotor.two_plane:TwoPlane._system",
    "= self.polar_inertia, -self.polar_inertia",
    "= 2.0 * self.polar_inertia, -2.0 * self.polar_inertia",
)
def test_gyroscopic_splitting() -> None:
    """Supports alike on both sides: A w^2 -+ C Omega w - k33 = 0, the forward one rises with the spin."""
    rotor = TwoPlane(10.0, 0.5, 0.3, (Support(-0.3, 2e4, 0.0), Support(0.3, 2e4, 0.0)))
    system, spin = rotor.system(), np.array([40.0, 150.0, 900.0])
    k33 = 2 * 2e4 * 0.3**2
    found = modes(system, spin)
    for k, omega in enumerate(spin):
        root = math.sqrt((0.3 * omega) ** 2 + 4 * 0.5 * k33)
        closed = {"forward": (0.3 * omega + root) / 1.0, "backward": (-0.3 * omega + root) / 1.0}
        # Eigenvalues of a well-conditioned 8 x 8 matrix with a spread of 100: a few hundred roundings.
        tilt = {}
        for j in range(4):
            sense = whirl_direction(system, found.shape[k, :, j])
            if np.abs(found.shape[k, 2:, j]).max() > 1e-6:
                tilt["forward" if sense > 0 else "backward"] = found.frequency[k, j]
                assert abs(sense) == pytest.approx(1.0, abs=1e-9)
        assert tilt == pytest.approx(closed, rel=1e-11)


@kills(
    "solvers.rotor.two_plane:TwoPlane._system",
    "= self.polar_inertia, -self.polar_inertia",
    "= -self.polar_inertia, self.polar_inertia",
)
def test_free_top() -> None:
    """Without supports the axis of a free body goes round forward at C Omega/A."""
    system = TwoPlane(10.0, 0.5, 0.3, ()).system()
    found = modes(system, 100.0)
    # The other roots are the drift, twofold 0: rounding spreads them by its square root.
    assert found.frequency[0, -1] == pytest.approx(0.3 * 100.0 / 0.5, rel=1e-9)
    assert whirl_direction(system, found.shape[0, :, -1]) == pytest.approx(1.0)


@kills("solvers.rotor.two_plane:TwoPlane._system", "np.array([1.0, -1j])", "np.array([1.0, 1j])")
@kills(
    "solvers.rotor.two_plane:TwoPlane._system",
    "cmath.exp(1j * unbalanced.angle)",
    "cmath.exp(-1j * unbalanced.angle)",
)
def test_long_shaft() -> None:
    """Two equal masses at the supports, A = m L^2, C = 0: two separate Jeffcott rotors."""
    half, length = 5.0, 0.4
    ends = ((-length, 3e4, 50.0, 1e-3, 0.3), (length, 5e4, 30.0, 2e-3, -1.2))
    rotor = TwoPlane(
        2 * half,
        2 * half * length**2,
        0.0,
        tuple(Support(z, k, c) for z, k, c, _, _ in ends),
        tuple(PlaneUnbalance(z, u, a) for z, _, _, u, a in ends),
    )
    speed = np.linspace(10.0, 300.0, 60)
    answer = unbalance_response(rotor.system(), speed)
    for z, k, c, u, a in ends:
        one = Jeffcott(half, k, c, u)
        closed = u * speed**2 / one.dynamic_stiffness(speed) * np.exp(1j * a)
        found = orbit(rotor.system(), answer, z)
        # Near resonance the conditioning is 1/(2 zeta) < 10.
        np.testing.assert_allclose(found.forward, closed, rtol=1e-12)
        np.testing.assert_allclose(np.abs(found.backward), 0.0, atol=1e-14 * np.abs(closed).max())


@kills(
    "solvers.rotor.two_plane:TwoPlane._system",
    "[self.mass, self.mass, inertia, inertia]",
    "[self.mass, self.mass, inertia, 2.0 * inertia]",
)
def test_far_above_resonance() -> None:
    """The rotor turns about its principal axis: shift -U/M and tilt -sum(u z)/(A - C)."""
    rotor = two_plane()
    one, other = rotor.unbalances
    turned = [u.size * np.exp(1j * u.angle) for u in (one, other)]
    speed = np.array([1e7])
    answer = unbalance_response(rotor.system(), speed)
    # What is left is (resonance/speed)^2, 1e-9, and the dampers' share, c z^2/((A - C) Omega) = 1e-6.
    shift = orbit(rotor.system(), answer, 0.0).forward
    np.testing.assert_allclose(shift, -sum(turned) / 20.0, rtol=1e-5)
    tilt = orbit(rotor.system(), answer, 1.0).forward - shift
    couple = turned[0] * one.position + turned[1] * other.position
    np.testing.assert_allclose(tilt, -couple / (0.72 - 0.16), rtol=1e-5)


def test_energy_is_kept() -> None:
    # Tolerance of the integrator 1e-10 a step, some thousand steps.
    assert free_energy_drift(two_plane(0.0).system(), 300.0, 1.0) < 1e-7


@given(
    spin=st.floats(0.0, 1e4),
    inertia=st.floats(1e-2, 10.0),
    share=st.floats(0.0, 2.0),
    stiffness=st.floats(1e3, 1e8),
)
def test_undamped_frequencies_are_real_and_their_product_is_free_of_the_spin(
    spin: float, inertia: float, share: float, stiffness: float
) -> None:
    # det(K)/det(M) is the product of the squares: the gyroscopic terms do no work.
    rotor = TwoPlane(
        10.0, inertia, share * inertia, (Support(-0.3, stiffness, 0.0), Support(0.2, stiffness, 0.0))
    )
    system = rotor.system()
    found = modes(system, spin)
    closed = np.linalg.det(system.stiffness) / np.linalg.det(system.mass)
    # The slow precession is lost in rounding by the ratio of the frequencies.
    spread = (
        found.frequency.max()
        / np.sqrt(np.linalg.eigvals(np.linalg.solve(system.mass, system.stiffness)).real.min())
    ) ** 2
    assert np.prod(found.frequency**2) == pytest.approx(closed, rel=max(1e-9, 1e-12 * spread))
    assert np.abs(found.eigenvalue.real).max() <= 1e-9 * found.frequency.max()


@pytest.mark.parametrize(
    "change",
    [
        {"mass": 0.0}, {"transverse_inertia": -1.0}, {"polar_inertia": 3.0}, {"polar_inertia": math.nan},
        {"mass": math.inf},
    ],
)  # fmt: skip
def test_bad_rotor(change: dict[str, float]) -> None:
    values = {"mass": 1.0, "transverse_inertia": 1.0, "polar_inertia": 1.0} | change
    with pytest.raises(InputError):
        TwoPlane(**values, supports=())


def test_bad_parts() -> None:
    with pytest.raises(InputError):
        Support(math.nan, 1.0, 1.0)
    with pytest.raises(InputError):
        Support(0.0, -1.0, 1.0)
    with pytest.raises(InputError):
        PlaneUnbalance(0.0, -1.0)
    with pytest.raises(InputError):
        PlaneUnbalance(0.0, 1.0, math.inf)
