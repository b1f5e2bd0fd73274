"""Couplings of a tub's mounts: the printed sums, the rotor's own matrices, what no origin changes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import leblanc as lb
from meshes.errors import InputError
from solvers.rotor.layout import (
    COORDINATES,
    PAIRS,
    Mounts,
    centre_of_mass,
    couplings,
    mass_matrix,
    natural_frequencies,
    sag,
)
from solvers.rotor.tub import Mount, Tub
from tests.mutants import kills

EPS = np.finfo(float).eps


def tub() -> Tub:
    machine = lb.example("tub").rotor.machine()
    assert isinstance(machine, Tub)
    return machine


@kills("solvers.rotor.layout:Mounts.matrix", "self.position - origin", "self.position + origin")
@kills("solvers.rotor.layout:Mounts.matrix", "[None, :, :, None] * np.eye(3)", "[None, :, :, None] * 0.0")
def test_sums_as_printed() -> None:
    """Every coefficient of the list below eq. 8, its two exchanged ones put right, by hand [DR18]."""
    rng = np.random.default_rng(3)
    place, c, origin = (
        rng.uniform(-0.3, 0.3, (5, 3)),
        rng.uniform(1e3, 9e3, (5, 3)),
        np.array([0.01, 0.03, -0.02]),
    )
    mounts = Mounts.of([Mount(tuple(p), along_axes=tuple(s)) for p, s in zip(place, c, strict=True)])
    (x, y, z), (cx, cy, cz) = (place - origin).T, c.T
    expected = np.zeros((6, 6))
    for (i, j), terms in {
        (0, 0): cx, (1, 1): cy, (2, 2): cz,
        (0, 4): cx * z, (0, 5): -cx * y, (1, 3): -cy * z, (1, 5): cy * x, (2, 3): cz * y, (2, 4): -cz * x,
        (3, 3): cz * y**2 + cy * z**2, (4, 4): cx * z**2 + cz * x**2, (5, 5): cy * x**2 + cx * y**2,
        (3, 4): -cz * x * y, (3, 5): -cy * x * z, (4, 5): -cx * y * z,
    }.items():  # fmt: skip
        expected[i, j] = expected[j, i] = terms.sum()
    np.testing.assert_allclose(mounts.matrix(origin)[0], expected, rtol=1e-12, atol=1e-9)


@kills("solvers.rotor.layout:mass_matrix", "displacement(-origin)", "displacement(origin)")
def test_matrices_are_those_of_the_rotor() -> None:
    """About the tub's centre the rotor's own; elsewhere the same energies of the same motion."""
    machine = tub()
    system, rng = machine.system(), np.random.default_rng(5)
    stiffness, damping = (Mounts.of(mounts) for mounts in (machine.springs, machine.dampers))
    for origin in (np.zeros(3), np.array([0.02, 0.05, -0.03])):
        # Motion of the tub's centre from that of the origin: it turns about it.
        shift = np.eye(6)
        a, b, c = -origin
        shift[:3, 3:] = [[0.0, c, -b], [-c, 0.0, a], [b, -a, 0.0]]
        q = shift @ rng.normal(size=6)
        own = np.linalg.solve(shift, q)
        for found, whole in (
            (stiffness.matrix(origin)[0], system.stiffness),
            (damping.matrix(origin)[0], system.damping),
            (mass_matrix(machine, origin), system.mass),
        ):
            assert own @ found @ own == pytest.approx(q @ whole @ q, rel=1e-12)


def test_natural_frequencies_do_not_know_the_origin() -> None:
    machine = tub()
    springs = Mounts.of(machine.springs)
    found = [
        natural_frequencies(springs.matrix(origin), mass_matrix(machine, origin))[0]
        for origin in (np.zeros(3), centre_of_mass(machine), np.array([0.1, -0.2, 0.3]))
    ]
    system = machine.system()
    squared = np.linalg.eigvals(np.linalg.solve(system.mass, system.stiffness)).real
    np.testing.assert_allclose(found[0], np.sqrt(np.sort(squared)), rtol=1e-10)
    np.testing.assert_allclose(found[1:], [found[0]] * 2, rtol=1e-10)


@kills(
    "solvers.rotor.layout:centre_of_mass",
    "* rotor.drum_mass / rotor.mass",
    "* rotor.drum_mass / rotor.tub_mass",
)
def test_mass_is_diagonal_about_the_common_centre() -> None:
    machine = tub()
    assert np.abs(couplings(mass_matrix(machine, centre_of_mass(machine)))).max() < 16 * EPS
    assert np.abs(couplings(machine.system().mass)).max() > 0.05


@given(seed=st.integers(0, 2**32 - 1), scale=st.floats(1e-6, 1e6))
def test_couplings_are_shares_that_no_unit_changes(seed: int, scale: float) -> None:
    rng = np.random.default_rng(seed)
    mounts = Mounts.of(
        [
            Mount(
                tuple(rng.normal(size=3)),
                float(rng.uniform(0, 1)),
                tuple(rng.normal(size=3)),
                (0.1, 0.0, 0.2),
            )
            for _ in range(4)
        ]
    )
    matrix = mounts.matrix(np.zeros(3))[0]
    found = couplings(matrix)
    assert np.all(np.abs(found) <= 1.0 + 1e-12)
    unit = np.array([1.0, 1.0, 1.0, scale, scale, scale])
    np.testing.assert_allclose(couplings(matrix * np.outer(unit, unit)), found, rtol=1e-12, atol=1e-300)


@kills("solvers.rotor.layout:sag", "moved[:, :3] @ weight", "moved[:, :3] @ -weight")
def test_sag() -> None:
    """Springs in line with the weight give way by m g/c; off their centre the tub turns as well."""
    corners = [(x, y, 0.0) for x in (-0.2, 0.2) for y in (-0.1, 0.1)]
    four = Mounts.of([Mount(corner, along_axes=(500.0, 500.0, 1000.0)) for corner in corners])
    weight = np.array([0.0, 0.0, -200.0])
    np.testing.assert_allclose(sag(four.matrix(np.zeros(3)), weight), [[0.05], [0.0]], atol=1e-15)
    off = np.array([0.05, 0.0, 0.0])
    # m g (1/sum c + off^2/sum c x^2), by superposition of a force and its moment.
    found = sag(four.matrix(off), weight)
    np.testing.assert_allclose(
        found[:, 0], [0.05 + 200.0 * 0.05**2 / 160.0, 200.0 * 0.05 / 160.0], rtol=1e-12
    )
    single = Mounts.of([Mount((0.0, 0.0, 0.1), along_axes=(1.0, 1.0, 1.0))])
    assert np.isinf(sag(single.matrix(np.zeros(3)), weight)).all()


def test_names() -> None:
    assert len(PAIRS) == 15 and len(COORDINATES) == 6
    assert all(i < j for i, j in PAIRS)


def test_shapes_are_checked() -> None:
    with pytest.raises(InputError, match="position"):
        Mounts(np.zeros((1, 2, 3)), np.zeros((1, 2, 3)), np.zeros(3), np.zeros((3, 3)))
    with pytest.raises(InputError, match="direction"):
        Mounts(np.zeros((1, 2, 3)), np.zeros((1, 1, 3)), np.zeros(2), np.zeros((2, 3)))
