"""Machines of beams: closed forms, energy, reciprocity, the way by reactions, soundness at high frequency."""

from __future__ import annotations

import functools
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.shaft.section import round_section
from solvers.rotor.shaft.structure import Coordinate, Joint, PointMass, Structure, compliances
from solvers.rotor.shaft.substructures import connections, free_compliances, station_matrices, substructures
from tests.mutants import kills

_AT = "solvers.rotor.shaft"


def parts(*lengths: float, diameter: float = 0.02, theory: str = "timoshenko") -> tuple:  # type: ignore[type-arg]
    return tuple(round_section(length, diameter, theory=theory) for length in lengths)


def rig(scale: float = 1.0, damping: float = 300.0) -> Structure:
    """Tool holder, spindle, housing and frame as the source plans them: 2, 6, 7 and 4 sections."""
    bearings = [Joint((1, k), (2, k + 1), 5e7 * scale, damping) for k in range(1, 5)]
    return Structure(
        (
            parts(0.06, 0.04),
            parts(0.02, 0.015, 0.1, 0.015, 0.05, 0.03),
            parts(0.01, 0.02, 0.03, 0.09, 0.03, 0.04, 0.03, diameter=0.065),
            parts(0.2, 0.2, 0.2, 0.1, diameter=0.08),
        ),
        (PointMass((0, 0), 0.4, 1e-4), PointMass((1, 5), 0.5, 3e-4)),
        (
            Joint((0, 2), (1, 0), 1e8, 100.0, 1e5, 1.0),
            *bearings,
            Joint((2, 1), (3, 1), 4e7, 200.0),
            Joint((2, 6), (3, 3), 4e7, 200.0),
            Joint((3, 2), None, 1e8, 100.0, 3e4, 20.0),
        ),
    )


EVERY = [
    Coordinate((beam, k), slope) for beam, k in ((0, 0), (1, 1), (2, 2), (3, 4)) for slope in (False, True)
]
FREQUENCY = np.array([10.0, 200.0, 1000.0, 2000.0, 5000.0, 20000.0])


def tip_compliance(length: float, bending: float, mass: float, frequency: Array) -> Array:
    """Driving point of a free Euler beam at its end, closed form; cosh divided out."""
    beta = (mass * frequency**2 / bending) ** 0.25
    x = beta * length
    with np.errstate(over="ignore"):
        secant = 1.0 / np.cosh(x)
    return np.asarray(
        -(np.cos(x) * np.tanh(x) - np.sin(x)) / (bending * beta**3 * (np.cos(x) - secant)),
    )


@pytest.mark.parametrize("wave", [0.5, 3.0, 10.0, 40.0, 200.0])
def test_free_beam_at_low_and_high_frequency(wave: float) -> None:
    section = round_section(1.0, 0.02, theory="euler")
    frequency = np.array([wave**2 * math.sqrt(section.bending_stiffness / section.mass)])
    exact = tip_compliance(1.0, section.bending_stiffness, section.mass, frequency)
    found = compliances(Structure(((section,),)), frequency, [Coordinate((0, 0))], [Coordinate((0, 0))])
    # The dynamic part of a stiffness has the share 1/500 wave^4 of the static one at low frequency, and a sum
    # of some 2 wave pieces adds up its roundings at high frequency.
    allowed = 1e-14 * max(500.0 / wave**4, 1.0) * max(1.0, wave) ** 2
    assert abs(found[0, 0, 0] / exact[0] - 1.0) < allowed


@kills(f"{_AT}.structure:dynamic_stiffness", "length = section.length / count", "length = section.length")
def test_products_of_transfer_matrices_lose_digits_where_the_assembly_does_not() -> None:
    """The table of the theory page: entries of the size cosh, of which differences matter."""
    section = round_section(1.0, 0.02, theory="euler")
    free = Structure(((section,),))
    wave = np.array([5.3, 20.3, 30.3, 40.3])
    frequency = wave**2 * math.sqrt(section.bending_stiffness / section.mass)
    exact = tip_compliance(1.0, section.bending_stiffness, section.mass, frequency)
    product = np.abs(free_compliances(free, 0, frequency)[:, 0, 0] / exact - 1.0)
    assembly = np.abs(compliances(free, frequency, EVERY[:1], EVERY[:1])[:, 0, 0] / exact - 1.0)
    assert np.all(assembly < 1e-11)
    assert product[0] < 1e-12
    # Rounding times e^x: 1e-16 times 7e8, 1e13 and 3e17.
    assert np.all(product[1:] > [1e-9, 1e-5, 1e-2])


@kills(
    f"{_AT}.structure:dynamic_stiffness",
    "found[:, first, second] -= stiffness",
    "found[:, first, second] += stiffness",
)
@kills(f"{_AT}.substructures:point_matrices", "found[:, 3, 0] += radial", "found[:, 3, 0] -= radial")
@kills(f"{_AT}.substructures:point_matrices", "found[:, 2, 1] -= mass", "found[:, 2, 1] += mass")
@kills(f"{_AT}.substructures:substructures", "load -= own", "load += own")
def test_two_ways_agree() -> None:
    machine = rig()
    direct = compliances(machine, FREQUENCY, EVERY, [Coordinate((1, 1))])[..., 0]
    found = substructures(machine, FREQUENCY, Coordinate((1, 1)))
    assert found.matrix.shape == (FREQUENCY.size, 8, 8)
    other = [found.motions[entry.station[0]][:, entry.station[1], int(entry.slope)] for entry in EVERY]
    # Free parts are 1/(m omega^2) soft: at 10 rad/s their rigid motions exceed the answer 1e4 to 1e5 times.
    assert np.abs(np.stack(other, -1) / direct - 1.0).max() < 1e-9


def test_the_compliance_matrix_is_the_one_of_the_source() -> None:
    """A few entries of [eq. 7], with their signs, from the compliances of the free parts."""
    machine, omega = rig(), np.array([700.0])
    matrix = substructures(machine, omega, Coordinate((1, 1))).matrix[0]
    alpha = [free_compliances(machine, beam, omega)[0] for beam in range(4)]

    def of(beam: int, i: int, j: int, turn: int = 0, moment: int = 0) -> complex:
        return complex(alpha[beam][2 * i + turn, 2 * j + moment])

    flexible = [spring.flexibility[0] for spring in connections(machine, omega)]
    entries = {
        (0, 0): of(0, 2, 2) + of(1, 0, 0) + flexible[0],
        (0, 1): of(0, 2, 2, 0, 1) + of(1, 0, 0, 0, 1),
        (1, 1): of(0, 2, 2, 1, 1) + of(1, 0, 0, 1, 1) + flexible[1],
        (0, 2): -of(1, 0, 1),
        (1, 5): -of(1, 0, 4, 1, 0),
        (2, 2): of(1, 1, 1) + of(2, 2, 2) + flexible[2],
        (2, 5): of(1, 1, 4) + of(2, 2, 5),
        (2, 6): -of(2, 2, 1),
        (3, 7): -of(2, 3, 6),
        (6, 6): of(2, 1, 1) + of(3, 1, 1) + flexible[6],
        (6, 7): of(2, 1, 6) + of(3, 1, 3),
        (7, 2): -of(2, 6, 2),
        (0, 6): 0.0,
    }
    for place, value in entries.items():
        assert matrix[place] == pytest.approx(value, rel=1e-12, abs=1e-30), place
    assert np.abs(matrix - matrix.T).max() < 1e-10 * np.abs(matrix).max()


@settings(max_examples=25, deadline=None)
@given(scale=st.floats(1e-3, 1e3), damping=st.floats(0.0, 1e4), frequency=st.floats(1.0, 3e4))
def test_reciprocity_and_energy(scale: float, damping: float, frequency: float) -> None:
    """Force and motion may change places; what the force does the dampers take."""
    machine, omega = rig(scale, damping), np.array([frequency])
    found = compliances(machine, omega, EVERY, EVERY)[0]
    unit = np.sqrt(np.abs(np.diagonal(found)))
    # Condition of the scaled matrix up to 1e8 with soft and stiff joints in one machine.
    assert np.abs(found - found.T).max() <= 1e-8 * np.abs(found).max() or (
        np.abs((found - found.T) / unit / unit[:, None]).max() < 1e-6
    )
    ends = [end for joint in machine.joints for end in (joint.first, joint.second) if end is not None]
    places = [Coordinate(end, slope) for end in ends for slope in (False, True)]
    motion = compliances(machine, omega, places, [EVERY[2]])[0, :, 0]
    moved = {(entry.station, entry.slope): value for entry, value in zip(places, motion, strict=True)}
    taken = 0.0
    for joint in machine.joints:
        for slope, constant in enumerate((joint.damping, joint.angular_damping)):
            other = 0.0 if joint.second is None else moved[joint.second, bool(slope)]
            taken += 0.5 * frequency**2 * constant * abs(moved[joint.first, bool(slope)] - other) ** 2
    driving = found[2, 2]
    given_power = -0.5 * frequency * driving.imag
    assert taken >= 0.0
    assert given_power == pytest.approx(taken, rel=1e-6, abs=1e-8 * frequency * abs(driving))


def test_static_deflection_of_a_cantilever() -> None:
    section = round_section(0.4, 0.03)
    clamped = Structure(((section,),), joints=(Joint((0, 0), None, 1e15, 0.0, 1e15),))
    found = compliances(
        clamped, np.zeros(1), [Coordinate((0, 1)), Coordinate((0, 1), True)], [Coordinate((0, 1))]
    )
    bending, shear = section.bending_stiffness, section.shear_flexibility
    assert found[0, 0, 0].real == pytest.approx(0.4**3 / (3.0 * bending) + 0.4 * shear, rel=1e-7)
    assert found[0, 1, 0].real == pytest.approx(0.4**2 / (2.0 * bending), rel=1e-7)


def test_determinant_of_the_whole_beam() -> None:
    """Force-free ends: the block of the product that a natural frequency makes singular [eq. 11]."""
    from solvers.rotor.shaft.natural import natural_frequencies

    frame = Structure(
        (parts(0.2, 0.25, 0.2, 0.1, diameter=0.08),),
        (PointMass((0, 1), 3.0),),
        (Joint((0, 2), None, 1e8, 0.0, 3e4),),
    )
    known = natural_frequencies(frame, 1.0, 1e4)
    assert known.size >= 3
    for frequency in known[:3]:
        near = frequency * np.array([1.0 - 1e-6, 1.0 + 1e-6])
        whole = functools.reduce(lambda total, step: step @ total, station_matrices(frame, 0, near))
        blocks = whole[:, 2:, :2].real
        signs = np.sign(np.linalg.det(blocks))
        assert signs[0] == -signs[1] != 0.0


def test_bad_structures() -> None:
    beam = parts(0.1)
    with pytest.raises(InputError, match="station"):
        Structure((beam,), masses=(PointMass((0, 2), 1.0),))
    with pytest.raises(InputError, match="joint"):
        Structure((beam,), joints=(Joint((0, 1), (0, 1), 1.0),))
    with pytest.raises(InputError, match="damping"):
        Structure((beam,), joints=(Joint((0, 1), None, 1.0, -1.0),))
    with pytest.raises(InputError, match="beams"):
        Structure(())
    free = Structure((beam,))
    with pytest.raises(InputError, match="frequency"):
        compliances(free, np.array([math.nan]), EVERY[:1], EVERY[:1])
    with pytest.raises(InputError, match="cutoff"):
        compliances(free, np.array([1e7]), EVERY[:1], EVERY[:1])
    with pytest.raises(InputError, match="joints"):
        substructures(free, np.array([10.0]), Coordinate((0, 0)))
