"""All natural frequencies of a band: closed forms, finite elements of scikit-fem, whirl with spin, ROSS."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import brentq

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.shaft.natural import modes, natural_frequencies
from solvers.rotor.shaft.section import Section, round_section
from solvers.rotor.shaft.structure import Joint, PointMass, Structure
from tests.mutants import kills
from tests.oracles.rotors import count_below

_AT = "solvers.rotor.shaft"
RIGID = 1e16  # of a support, N/m and N m/rad: 1e9 times a beam's own stiffness


def beam(theory: str = "euler", diameter: float = 0.02, spins: bool = False) -> Section:
    return round_section(1.0, diameter, theory=theory, spins=spins)


def wave_numbers(section: Section, frequency: Array) -> Array:
    return np.asarray((section.mass * frequency**2 / section.bending_stiffness) ** 0.25)


@pytest.mark.parametrize("ends", ["free", "cantilever"])
def test_euler_beams(ends: str) -> None:
    """cos x cosh x = 1 of a free beam, = -1 of a clamped one; forty of them, none missed."""
    section, sign = beam(), 1.0 if ends == "free" else -1.0
    joints = () if ends == "free" else (Joint((0, 0), None, RIGID, 0.0, RIGID),)
    high = 125.0**2 * math.sqrt(section.bending_stiffness / section.mass)
    found = wave_numbers(section, natural_frequencies(Structure(((section,),), joints=joints), 1.0, high))
    first = 1.5 if ends == "free" else 0.5

    def condition(x: float) -> float:
        return math.cos(x) - sign / math.cosh(x)

    middles = [(first + k) * math.pi for k in range(40)]
    exact = [brentq(condition, x - 0.5, x + 0.5, xtol=1e-13) for x in middles]
    assert found.size == sum(x < 125.0 for x in exact) >= 38
    # A support gives way by 1e-9 x^3 of its own motion at the most; a free beam by rounding, 1e-16 500/x^4.
    assert np.abs(found / exact[: found.size] - 1.0).max() < (1e-10 if ends == "free" else 1e-7)


def pinned_exact(section: Section, n: Array, spin: float = 0.0) -> Array:
    """Frequencies of sin(n pi x/L) in forward whirl: the quartic of eq. 1-2, its lowest positive root."""
    found = []
    for k in n * math.pi / section.length:
        j, p, s = section.rotary_inertia, section.polar_inertia * spin, section.shear_flexibility
        bending, mass = section.bending_stiffness, section.mass
        # (E I k^2 - R)(1 - s m omega^2/k^2) = m omega^2/k^2, R = j omega^2 - p omega
        soft = mass / k**2
        turning = np.array([-j, p, bending * k**2])  # in powers omega^2, omega, 1
        whole = np.polysub(np.polymul(turning, [-s * soft, 0.0, 1.0]), [soft, 0.0, 0.0])
        roots = np.roots(whole)
        real = roots[np.abs(roots.imag) < 1e-6 * np.abs(roots)].real
        found.append(real[real > 0.0].min())
    return np.array(found)


@pytest.mark.parametrize("spin", [0.0, 3000.0, -3000.0])
@pytest.mark.parametrize("theory", ["euler", "rayleigh", "timoshenko"])
def test_pinned_beams_of_each_theory(theory: str, spin: float) -> None:
    """Sine waves: n^2 pi^2 of Euler, less with rotary inertia, less with shear; split by a spin."""
    section = beam(theory, 0.08, spins=theory != "euler")
    pinned = Structure(((section,),), joints=(Joint((0, 0), None, RIGID), Joint((0, 1), None, RIGID)))
    high = 2.5e4
    found = natural_frequencies(pinned, 1.0, high, spin)
    n = np.arange(1.0, found.size + 2.0)
    exact = pinned_exact(section, n, spin)
    assert exact[-1] > high and found.size >= 4
    assert np.abs(found / exact[:-1] - 1.0).max() < 1e-6  # supports of 1e16 N/m beside 1e9 of the beam


@kills(
    f"{_AT}.structure:dynamic_stiffness",
    "mass.polar_inertia * spin * omega",
    "-mass.polar_inertia * spin * omega",
)
@kills(f"{_AT}.section:Section.turning_inertia", "np.square(frequency) - self", "np.square(frequency) + self")
def test_a_spin_stiffens_forward_whirl() -> None:
    """Of a shaft and of a thin disc, whose polar inertia is twice the other; backward whirl softens."""
    ends = Joint((0, 0), None, RIGID), Joint((0, 1), None, RIGID)
    shaft = Structure(((beam("rayleigh", 0.08, spins=True),),), joints=ends)
    disc = Structure(((beam("euler", 0.08),),), (PointMass((0, 1), 1e-9, 0.02, 0.04),), ends)
    for machine in (shaft, disc):
        against, without, with_it = (natural_frequencies(machine, 1.0, 2e4, s)[0] for s in (-3e3, 0.0, 3e3))
        assert against < without < with_it


def test_rigid_body_on_springs() -> None:
    """A short stiff beam is a mass and an inertia: two frequencies from two numbers."""
    section = Section(0.1, 1e9, 50.0)
    body = Structure(((section,),), joints=(Joint((0, 0), None, 1e5), Joint((0, 1), None, 1e5)))
    heave = math.sqrt(2e5 / 5.0)
    pitch = math.sqrt(2e5 * 0.05**2 / (5.0 * 0.1**2 / 12.0))
    # Bending of the beam is 1e-6 as soft as the springs; half of that shows in the frequency.
    assert natural_frequencies(body, 1.0, 1e3) == pytest.approx([heave, pitch], rel=1e-6)


def finite_elements(section: Section, tip: float, count: int) -> Array:
    """Cantilever with a body at its end by Hermite elements of scikit-fem, lowest three frequencies."""
    from scipy.linalg import eigh
    from skfem import Basis, BilinearForm, ElementLineHermite, MeshLine
    from skfem.helpers import dd, ddot

    basis = Basis(MeshLine(np.linspace(0.0, section.length, count + 1)), ElementLineHermite(), intorder=8)

    @BilinearForm
    def bend(u, v, _):  # type: ignore[no-untyped-def]
        return section.bending_stiffness * ddot(dd(u), dd(v))

    @BilinearForm
    def inertia(u, v, _):  # type: ignore[no-untyped-def]
        return section.mass * u * v + section.rotary_inertia * u.grad[0] * v.grad[0]

    stiffness, mass = bend.assemble(basis).toarray(), inertia.assemble(basis).toarray()
    last = int(basis.nodal_dofs[0, np.argmax(basis.mesh.p[0])])
    mass[last, last] += tip
    clamped = basis.nodal_dofs[:, np.argmin(basis.mesh.p[0])]
    free = np.setdiff1d(np.arange(stiffness.shape[0]), clamped)
    pick = np.ix_(free, free)
    return np.asarray(np.sqrt(eigh(stiffness[pick], mass[pick], eigvals_only=True)[:3]))


@kills(
    f"{_AT}.structure:dynamic_stiffness", "mass.mass * np.square(omega)", "2.0 * mass.mass * np.square(omega)"
)
def test_finite_elements_come_closer_by_the_fourth_order() -> None:
    """Cubic elements miss a frequency by h^4: towards this answer, and to no other."""
    section, tip = beam("rayleigh", 0.1), 3.0
    machine = Structure(((section,),), (PointMass((0, 1), tip),), (Joint((0, 0), None, RIGID, 0.0, RIGID),))
    exact = natural_frequencies(machine, 10.0, 3e4)[:3]
    counts = np.array([4, 8, 16])
    errors = np.array([finite_elements(section, tip, n) / exact - 1.0 for n in counts])
    assert np.all(errors > 0.0)  # elements are too stiff
    order = np.log2(errors[:-1] / errors[1:])
    assert np.all(np.abs(order[-1] - 4.0) < 0.1), order  # still rising towards 4 on the coarser pair
    assert errors[-1].max() < 1e-4


def chain(stiffness: list[float]) -> Structure:
    """Short beams in a row, joined by springs."""
    section = round_section(0.05, 0.03)
    joints = [Joint((k, 1), (k + 1, 0), s, 0.0, 0.02 * s) for k, s in enumerate(stiffness[1:])]
    ground = Joint((0, 0), None, stiffness[0], 0.0, 0.1 * stiffness[0])
    return Structure(tuple((section,) for _ in stiffness), joints=(ground, *joints))


@settings(max_examples=20, deadline=None)
@given(stiffness=st.lists(st.floats(1e4, 1e9), min_size=2, max_size=4), split=st.floats(0.1, 0.9))
def test_every_frequency_of_a_band_is_found(stiffness: list[float], split: float) -> None:
    """A band cut in two has the frequencies of the whole; each takes the count up by one."""
    machine, high = chain(stiffness), 2e4
    whole = natural_frequencies(machine, 1.0, high)
    assert whole.size == int(np.diff(count_below(machine, np.array([1.0, high])))[0])
    assert np.all(np.diff(whole) >= 0.0)
    cut = split * high
    halves = np.concatenate([natural_frequencies(machine, *ends) for ends in ((1.0, cut), (cut, high))])
    assert halves == pytest.approx(whole, rel=1e-8)
    apart = np.diff(whole) > 1e-6 * whole[1:] if whole.size > 1 else np.zeros(0, dtype=bool)
    for k in np.flatnonzero(apart):
        middle = math.sqrt(whole[k] * whole[k + 1])
        first = int(count_below(machine, np.array([1.0]))[0])
        assert int(count_below(machine, np.array([middle]))[0]) == first + k + 1


def test_two_machines_that_do_not_know_of_each_other() -> None:
    """Equal frequencies count as often as they occur, with shapes that are not the same."""
    section = beam()
    joints = tuple(Joint((k, end), None, RIGID) for k in (0, 1) for end in (0, 1))
    twins = Structure(((section,), (section,)), joints=joints)
    found = natural_frequencies(twins, 10.0, 5e3)
    assert found[::2] == pytest.approx(found[1::2], rel=1e-9)
    first, second = modes(twins, 10.0, found[1] * 1.01)
    shapes = [np.concatenate([part for _, part in mode.along]) for mode in (first, second)]
    together = abs(shapes[0] @ shapes[1]) / np.linalg.norm(shapes[0]) / np.linalg.norm(shapes[1])
    assert together < 1e-6


def test_shape_of_a_pinned_beam() -> None:
    section = beam("timoshenko", 0.05)
    pinned = Structure(((section,),), joints=(Joint((0, 0), None, RIGID), Joint((0, 1), None, RIGID)))
    for n, mode in enumerate(modes(pinned, 10.0, 1e4, least=20)[:3], start=1):
        place, deflection = mode.along[0]
        wanted = np.sin(n * math.pi * place)
        wanted /= wanted[np.abs(deflection).argmax()]
        assert np.abs(deflection - wanted).max() < 1e-5  # supports give way; nodes of the nth sine
        assert np.abs(mode.stations[0]).max() < 1e-5


def test_bad_bands() -> None:
    free = Structure(((beam(),),))
    for band in ((0.0, 1.0), (2.0, 1.0), (1.0, math.inf), (math.nan, 1.0)):
        with pytest.raises(InputError, match="band"):
            natural_frequencies(free, *band)


def test_ross_whirls_alike() -> None:
    """Forward and backward whirl of a shaft with a disc, by Timoshenko elements of ROSS."""
    ross = pytest.importorskip("ross")
    material = ross.Material("steel", rho=7850.0, E=210e9, Poisson=0.3)
    elements = [
        ross.ShaftElement(L=0.05, idl=0.0, odl=0.05, material=material, n=k, shear_method_calc="cowper")
        for k in range(20)
    ]
    disc = ross.DiskElement(n=10, m=8.0, Id=0.02, Ip=0.04)
    bearings = [ross.BearingElement(n=n, kxx=2e7, cxx=0.0) for n in (0, 20)]
    rotor = ross.Rotor(elements, [disc], bearings)
    speed = 800.0
    theirs = np.sort(rotor.run_modal(speed, num_modes=24).wn)[:4]
    half = round_section(0.5, 0.05, spins=True)
    ours = Structure(
        ((half, half),),
        (PointMass((0, 1), 8.0, 0.02, 0.04),),
        (Joint((0, 0), None, 2e7), Joint((0, 2), None, 2e7)),
    )
    both = np.sort(np.concatenate([natural_frequencies(ours, 1.0, 1e4, s) for s in (speed, -speed)]))[:4]
    assert theirs == pytest.approx(both, rel=1e-4)  # h^4 of elements of 50 mm, and other moments of shear
