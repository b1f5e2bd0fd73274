"""The suspended tub against its energies, derived with computer algebra, and in its limits."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from scipy.linalg import eig

from meshes.errors import InputError
from solvers.rotor.system import RotorSystem
from solvers.rotor.tub import Mount, Tub, displacement
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import modes, orbit, unbalance_response
from tests.mutants import kills
from tests.oracles.rotors import free_energy_drift, tub, tub_energies


@functools.cache
def derived(angle: float = 0.7) -> dict[str, np.ndarray]:
    """Matrices of `tub` and its unbalance force at one angle, for 1 rad/s, from the energies alone."""
    import sympy as sp

    energy, heavy, phi, turn, q, v, symbol = tub_energies(sp)
    omega, e = sp.Symbol("omega"), symbol["e"]
    machine = tub()
    values = {
        "m1": machine.tub_mass, "m2": machine.drum_mass, "Jx": 1.3, "Jy": 1.5, "Jz": 1.2, "Ja": 0.2,
        "Jb": 0.32, "xD": 0.02, "yD": 0.09, "zD": -0.03, "yu": 0.06,
    }  # fmt: skip
    known = {symbol[name]: value for name, value in values.items()} | {omega: 1}
    rest = dict.fromkeys([*q, *v], 0)

    def at_rest(of: object) -> object:
        return of.subs(rest).subs(known)  # type: ignore[attr-defined]

    def hessian(first: list[object], second: list[object]) -> np.ndarray:
        """Of the sum of weight s^2/2: weight (s_a s_b + s s_ab)."""
        total = np.zeros((6, 6))
        for weight, s in energy:
            rows, columns = ([float(at_rest(sp.diff(s, a))) for a in side] for side in (first, second))
            bend = float(at_rest(s))
            more = [[float(at_rest(sp.diff(s, a, b))) for b in second] for a in first] if bend else 0.0
            total += float(known[weight]) * (np.outer(rows, columns) + bend * np.array(more))
        return total

    mixed = hessian(v, q)
    stiffness = np.zeros((6, 6))
    damping = np.zeros((6, 6))
    for mounts, table in ((machine.springs, stiffness), (machine.dampers, damping)):
        for one in mounts:
            place = sp.Matrix(one.position)
            stretch = sp.Matrix(q[:3]) + turn * place - place
            unit = sp.Matrix(one.direction) / math.hypot(*one.direction)
            # Second derivatives at rest, where the stretch is 0: products of the first ones.
            for coefficient, way in (
                (one.coefficient, unit),
                *zip(one.along_axes, sp.eye(3).columnspace(), strict=True),
            ):
                slope = np.array([stretch.dot(way).diff(a).subs(rest) for a in q], dtype=float)
                table += coefficient * np.outer(slope, slope)
    # Generalized force of a mass u/e at the distance e: its momentum is that of its first moment u.
    force = []
    for a, b in zip(q, v, strict=True):
        momentum = sum(at_rest(s) * at_rest(sp.diff(s, b)) for s in heavy)
        pull = -sp.diff(momentum, phi) + sum(at_rest(s) * at_rest(sp.diff(s, a)) for s in heavy)
        force.append(float(sp.diff(pull, e).subs(e, 0).subs(phi, angle)))
    return {
        "mass": hessian(v, v),
        "gyroscopic": mixed - mixed.T,
        "stiffness": stiffness,
        "damping": damping,
        "force": machine.unbalance * np.array(force),
    }


@kills("solvers.rotor.tub:displacement", "found[..., 1, 3], found", "found[..., 1, 4], found")
@kills("solvers.rotor.tub:displacement", "[..., 2, 4] = y, -x", "[..., 2, 4] = y, x")
@kills("solvers.rotor.tub:Mount.matrix", "/ math.hypot(*self.direction)", "")
@kills(
    "solvers.rotor.tub:Mount.matrix",
    "moving.T @ tensor @ moving",
    "moving.T @ np.diag(np.diag(tensor)) @ moving",
)
@kills(
    "solvers.rotor.tub:Tub._system",
    "gyroscopic[5, 3] = -along, along",
    "gyroscopic[5, 3] = -2.0 * along, 2.0 * along",
)
@kills(
    "solvers.rotor.tub:Tub._system", "gyroscopic[5, 3] = -along, along", "gyroscopic[5, 3] = along, -along"
)
@kills("solvers.rotor.tub:Tub._system", "0.0, across, along, across]", "0.0, along, across, along]")
@kills(
    "solvers.rotor.tub:Tub._system",
    "inertia += self.drum_mass * drum.T",
    "inertia -= self.drum_mass * drum.T",
)
def test_matrices() -> None:
    """Mass, gyroscopic, damping and stiffness matrices of the energies [DR18, eq. 1-8]."""
    system, reference = tub().system(), derived()
    for name in ("mass", "gyroscopic", "stiffness", "damping"):
        expected = reference[name]
        np.testing.assert_allclose(getattr(system, name), expected, atol=1e-13 * np.abs(expected).max())
    assert np.abs(reference["gyroscopic"]).max() == pytest.approx(0.32)


@kills("solvers.rotor.tub:Tub._system", "[[2, 0]]", "[[0, 2]]")
@kills("solvers.rotor.tub:Tub._system", "(centre + heavy * lean).T", "(centre - heavy * lean).T")
@kills(
    "solvers.rotor.tub:Tub._system",
    "+ heavy * lean).T @ turning",
    "+ heavy * lean).T @ turning.conj()",
)
def test_unbalance() -> None:
    """The force of a mass point that goes round in the drum, z into x."""
    force = np.real(tub().system().unbalance * np.exp(0.7j))
    np.testing.assert_allclose(force, derived()["force"], atol=1e-13 * np.abs(force).max())


def test_natural_frequencies_against_an_independent_solution() -> None:
    """Generalized first-order pencil of the derived matrices, by QZ instead of QR."""
    reference, spin = derived(), 80.0
    mass, none, one = reference["mass"], np.zeros((6, 6)), np.eye(6)
    damping = reference["damping"] + spin * reference["gyroscopic"]
    left = np.block([[none, one], [-reference["stiffness"], -damping]])
    right = np.block([[one, none], [none, mass]])
    values = eig(left, right, right=False)
    expected = np.sort(values[values.imag > 1e-9].imag)
    found = modes(tub().system(), spin).frequency[0]
    np.testing.assert_allclose(found[-expected.size :], expected, rtol=1e-10)
    assert expected.size == 6


def test_energy_is_kept() -> None:
    assert free_energy_drift(tub(0.0).system(), 300.0, 2.0) < 1e-7


def test_symmetry() -> None:
    system = tub().system()
    for name in ("mass", "stiffness", "damping"):
        matrix = getattr(system, name)
        np.testing.assert_allclose(matrix, matrix.T, atol=1e-14 * np.abs(matrix).max())
    np.testing.assert_array_equal(system.gyroscopic, -system.gyroscopic.T)
    assert np.linalg.eigvalsh(system.stiffness).min() > 0.0


@kills("solvers.rotor.tub:displacement", "[..., 0, 5] = z, -y", "[..., 0, 5] = -z, -y")
def test_displacement() -> None:
    """Points of the tub and of the drum's axis move as under a small rotation about x, y, z."""
    q = np.array([0.1, 0.2, 0.3, 1e-7, -2e-7, 3e-7])
    place = np.array([0.4, -0.5, 0.6])
    turned = np.cross(q[3:], place)
    np.testing.assert_allclose(displacement((0.4, -0.5, 0.6)) @ q, q[:3] + turned, rtol=1e-15)
    moved = q[:3] + np.cross(q[3:], [0.02, 0.25, -0.03])
    np.testing.assert_allclose(tub().system().at(0.25) @ q, moved[[2, 0]], rtol=1e-14)


def test_a_spring_works_along_its_line() -> None:
    """Where on its line of action a spring is held does not matter."""
    line, unit = np.array([0.2, 0.03, 0.19]), np.array([0.26, 0.1, 0.97])
    here, there = (Mount(tuple(line + s * unit), 4800.0, tuple(unit)).matrix() for s in (0.0, 0.7))
    np.testing.assert_allclose(there, here, atol=1e-12 * np.abs(here).max())


def test_a_spring_in_three_directions_is_three_springs() -> None:
    along = Mount((0.1, 0.2, 0.3), along_axes=(1.0, 2.0, 3.0)).matrix()
    three = [
        Mount((0.1, 0.2, 0.3), c, d).matrix()
        for c, d in zip((1.0, 2.0, 3.0), np.eye(3).tolist(), strict=True)
    ]
    np.testing.assert_allclose(along, sum(three), rtol=1e-14)


def test_rigid_body_limits() -> None:
    """Drum at the tub's centre, isotropic springs about it: six separate oscillators."""
    places = [(x, y, z) for x in (-0.2, 0.2) for y in (-0.1, 0.1) for z in (-0.15, 0.15)]
    springs = tuple(Mount(place, along_axes=(500.0, 500.0, 500.0)) for place in places)
    machine = Tub(48.2, 12.5, (1.3, 1.5, 1.2), 0.3, 0.2, springs, (), 0.0)
    found = modes(machine.system()).frequency[0]
    shift = math.sqrt(8 * 500.0 / 60.7)
    turns = [
        math.sqrt(4000.0 * (a**2 + b**2) / inertia)
        for a, b, inertia in ((0.1, 0.15, 1.5), (0.2, 0.15, 1.8), (0.2, 0.1, 1.4))
    ]
    np.testing.assert_allclose(found, np.sort([shift, shift, shift, *turns]), rtol=1e-10)


def test_supercritical() -> None:
    """[DG21, table 1]: far above resonance the tub goes round with m_2 e/(m_1 + m_2) = 3.05 mm."""
    springs = (Mount((0.2, 0.0, 0.2), along_axes=(6e3, 6e3, 6e3)),)
    machine = Tub(48.2, 12.5, (1.3, 1.5, 1.3), 0.32, 0.2, springs, (), 12.5 * 14.8e-3)
    found = orbit(machine.system(), unbalance_response(machine.system(), [1e5]), 0.0)
    assert np.abs(found.forward[0]) == pytest.approx(3.0478e-3, rel=1e-4)
    assert np.angle(found.forward[0]) == pytest.approx(math.pi) or np.angle(
        found.forward[0]
    ) == pytest.approx(-math.pi)


def two_views() -> tuple[RotorSystem, RotorSystem]:
    """One machine as a tub and as a rotor in two planes: supports on the axis, no tub to speak of."""
    supports = ((-0.3, 2e4, 40.0), (0.25, 3e4, 60.0))
    plain = TwoPlane(10.0, 0.5, 0.3, tuple(Support(*one) for one in supports), (PlaneUnbalance(0.1, 1e-3),))
    light = 1e-9
    as_tub = Tub(
        light,
        10.0,
        (light, light, light),
        0.3,
        0.5,
        tuple(Mount((0.0, y, 0.0), along_axes=(k, 0.0, k)) for y, k, _ in supports),
        tuple(Mount((0.0, y, 0.0), along_axes=(c, 0.0, c)) for y, _, c in supports),
        1e-3,
        unbalance_position=0.1,
    )
    return plain.system(), as_tub.system()


def test_two_plane_limit() -> None:
    """With all inertia in the drum the tub answers as a rotor in two planes, gyroscopic terms included."""
    plain, as_tub = two_views()
    held = [0, 2, 3, 5]  # along and about the axis nothing holds it
    speed = np.linspace(20.0, 400.0, 50)
    first = np.linalg.solve(
        as_tub.stiffness[np.ix_(held, held)]
        - (speed**2)[:, None, None] * as_tub.mass[np.ix_(held, held)]
        + 1j
        * speed[:, None, None]
        * (as_tub.damping + speed[:, None, None] * as_tub.gyroscopic)[:, held][:, :, held],
        ((speed**2)[:, None] * as_tub.unbalance[held])[..., None],
    )[..., 0]
    answer = np.zeros((speed.size, 6), dtype=complex)
    answer[:, held] = first
    for z in (-0.2, 0.3):
        one = orbit(plain, unbalance_response(plain, speed), z).forward
        np.testing.assert_allclose(orbit(as_tub, answer, z).forward, one, rtol=1e-7)


@pytest.mark.parametrize(
    "change",
    [
        {"tub_mass": 0.0}, {"tub_inertia": (1.0, 0.0, 1.0)}, {"drum_mass": -1.0}, {"unbalance": math.nan},
        {"drum_position": (0.0, math.inf, 0.0)}, {"unbalance_position": math.nan},
    ],
)  # fmt: skip
def test_bad_tub(change: dict[str, object]) -> None:
    values: dict[str, object] = {
        "tub_mass": 1.0, "drum_mass": 1.0, "tub_inertia": (1.0, 1.0, 1.0), "drum_polar_inertia": 1.0,
        "drum_transverse_inertia": 1.0, "springs": (), "dampers": (), "unbalance": 0.0,
    }  # fmt: skip
    with pytest.raises(InputError):
        Tub(**(values | change))  # type: ignore[arg-type]


@pytest.mark.parametrize(
    "values",
    [
        {"position": (math.nan, 0.0, 0.0)}, {"position": (0.0, 0.0, 0.0), "direction": (0.0, 0.0, 0.0)},
        {"position": (0.0, 0.0, 0.0), "coefficient": -1.0},
        {"position": (0.0, 0.0, 0.0), "along_axes": (1.0, -1.0, 1.0)},
    ],
)  # fmt: skip
def test_bad_mount(values: dict[str, object]) -> None:
    with pytest.raises(InputError):
        Mount(**values)  # type: ignore[arg-type]
