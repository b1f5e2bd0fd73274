"""The layer as coefficients and as a link, against the field equations, and in ROSS where it is installed."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fluid.fill import Fill
from fluid.friction.laws import LINEAR, Friction, damping_rate
from fluid.liquid import Liquid
from fluid.waves import force_ratio
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.ross import (
    Coefficients,
    dynamic_stiffness,
    liquid_bearing,
    liquid_coefficients,
    liquid_layer,
    liquid_link,
)
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.models import Linear
from solvers.synchronous.response import response
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills
from validation.benchmarks.peers import ross as peer_ross

CHAMBER = Chamber(radius=0.15, height=0.01)
WATER = Liquid("water", 1000.0, 1e-6)
# h0/R = 0.1.
FILL = Fill(CHAMBER, WATER, 0.19 * CHAMBER.capacity)
FORWARD, BACKWARD = np.array([1.0, -1.0j]), np.array([1.0, 1.0j])
RATE = 0.7  # 1/s


def linear(rate: float, fill: Fill = FILL) -> Friction:
    """Linear friction whose decay rate is the one wanted."""
    return Friction("linear", rate / decay(LINEAR, 1.0, fill))


def decay(law: int, coefficient: float, fill: Fill = FILL) -> float:
    """Decay rate at the mean depth [theory: long_wave, eq. 9], lengths over the radius."""
    radius, height = fill.chamber.radius, fill.chamber.height
    area = 0.5 * fill.volume / (np.pi * height) / radius**2
    return float(damping_rate(law, coefficient, 2.0 * radius / height, fill.depth / radius, area, 0.0))


def field_stiffness(fill: Fill, spin: float, whirl: complex, rate: complex) -> complex:
    """Minus the force on the drum per deflection, from the two conditions at the surface.

    Unknown are xi and the b of phi = b (r/R^2 + 1/r), psi = i b (r/R^2 - 1/r): the surface moves with the
    liquid, and the pressure on it is zero; the drag takes k phi from the head.
    """
    big, a, s = fill.chamber.radius, fill.surface_radius, whirl - spin
    matrix = np.array(
        [
            [1j * s, -(1.0 / big**2 - 1.0 / a**2)],
            [
                spin**2 * a,
                -(1j * s + rate) * (a / big**2 + 1.0 / a) - 2.0j * spin * (a / big**2 - 1.0 / a),
            ],
        ]
    )
    xi = np.linalg.solve(matrix, np.array([0.0, -(whirl**2) * a]))[0]
    # First moment -pi a^2 h xi of the layer, over its volume.
    offset = -np.pi * a**2 * fill.chamber.height * xi / fill.volume
    return complex(-fill.mass * whirl**2 * (1.0 + offset))


def acts_on(found: Coefficients, whirl: float, shape: np.ndarray, at: int = 0) -> np.ndarray:
    """Force per displacement of a motion shape e^{i whirl t}."""
    matrix = found.stiffness[at] + 1j * whirl * found.damping[at] - whirl**2 * found.mass[at]
    return np.asarray(matrix @ shape)


def condensed(fill: Fill, spin: float, whirl: float, friction: Friction, shape: np.ndarray) -> np.ndarray:
    """Force per displacement of the drum; the coordinates of the mass on the link are solved for."""
    link = liquid_link(fill, spin, friction)
    held = link.stiffness[0] + 1j * whirl * link.damping[0] - whirl**2 * link.mass[0]
    liquid = np.linalg.solve(held - whirl**2 * fill.mass * np.eye(2), held @ shape)
    return np.asarray(held @ (shape - liquid))


def close(found: Any, wanted: Any, relative: float, size: float) -> None:
    assert np.abs(np.asarray(found) - np.asarray(wanted)).max() <= relative * size


@kills("solvers.ross:dynamic_stiffness", "* (1.0 + offset)", "* (1.0 - offset)")
@kills("solvers.ross:dynamic_stiffness", "-layer.mass * np.square(w)", "layer.mass * np.square(w)")
@kills("solvers.ross:dynamic_stiffness", "rate = layer_rate(", "rate = 2.0 * layer_rate(")
def test_field() -> None:
    # Two 2 x 2 systems with condition numbers below 1e3: 1e-12 leaves room for rounding only.
    for whirl in (-55.0, -20.0, 13.0, 33.0, 40.0, 61.0):
        found = complex(dynamic_stiffness(FILL, 40.0, whirl, linear(RATE)))
        wanted = field_stiffness(FILL, 40.0, whirl, RATE)
        close(found, wanted, 1e-12, abs(wanted))


@kills("solvers.ross:dynamic_stiffness", "slip = w - omega", "slip = w + omega")
@kills("solvers.ross:dynamic_stiffness", "layer_rate(layer, omega, slip)", "layer_rate(layer, omega, -slip)")
def test_laminar() -> None:
    # Seen from the drum the whirl runs backward, s < 0: the wall layer lags the other way round, and its drag
    # sqrt(i nu s) has equal real and negative imaginary parts.
    whirl, spin = 33.0, 40.0
    outer, a = CHAMBER.radius, FILL.surface_radius
    shares = 4.0 * outer * a**2 / (outer**4 - a**4), 2.0 / CHAMBER.height * np.array([a**2, outer**2])
    # Circles with and against the whirl on floor and lid, of energies as a^2 to R^2, turn at 73 and 87 rad/s.
    real = shares[0] * np.sqrt(7.0), shares[1] / (outer**2 + a**2) * np.sqrt([73.0, 87.0])
    rate = np.sqrt(0.5 * WATER.viscosity) * (
        (real[0] + real[1][1]) * (1.0 - 1.0j) + real[1][0] * (1.0 + 1.0j)
    )
    wanted = field_stiffness(FILL, spin, whirl, rate)
    close(complex(dynamic_stiffness(FILL, spin, whirl, Friction("stokes"))), wanted, 1e-12, abs(wanted))


@kills("solvers.ross:liquid_coefficients", "0.5 * (forward + backward)", "0.5 * (forward - backward)")
@kills("solvers.ross:liquid_coefficients", "0.5 * (forward - backward)", "(forward - backward)")
@kills("solvers.ross:liquid_coefficients", "half.imag / w", "mean.imag / w")
@kills("solvers.ross:liquid_coefficients", "half.real / w", "-half.real / w")
@kills(
    "solvers.ross:liquid_coefficients", "mean.real + mass * np.square(w)", "mean.real - mass * np.square(w)"
)
@kills("solvers.ross:liquid_coefficients", ", -mean.imag)", ", mean.imag)")
def test_both_whirls() -> None:
    # Of the order of ten operations on numbers of the size of H and m_f omega^2.
    for whirl in (13.0, 33.0, 40.0, 61.0):
        found = liquid_coefficients(FILL, 40.0, whirl, linear(RATE))
        size = abs(field_stiffness(FILL, 40.0, whirl, RATE)) + FILL.full_mass * whirl**2
        for shape, sense in ((FORWARD, 1.0), (BACKWARD, -1.0)):
            h = field_stiffness(FILL, 40.0, sense * whirl, RATE)
            # x + i y of p (1, i) e^{i omega t} is conj(p) e^{-i omega t}.
            wanted = h * shape if sense > 0 else np.conj(h) * shape
            close(acts_on(found, whirl, shape), wanted, 1e-12, size)


@kills("solvers.ross:liquid_coefficients", "else fill.full_mass", "else fill.mass")
def test_synchronous() -> None:
    spins = np.array([5.0, 40.0, 300.0])
    found = liquid_coefficients(FILL, spins, friction=linear(RATE))
    assert np.array_equal(found.mass, FILL.full_mass * np.broadcast_to(np.eye(2), (3, 2, 2)))
    for i, spin in enumerate(spins):
        full = FILL.full_mass * spin**2
        close(acts_on(found, spin, FORWARD, i), -full * FORWARD, 1e-12, full)


@kills(
    "solvers.ross:liquid_link",
    "layer.mass * (1.0 + layer.layer_tanh) / (1.0",
    "layer.mass * (1.0 - layer.layer_tanh) / (1.0",
)
@kills("solvers.ross:liquid_link", "2.0 * layer.mass * layer.rate", "layer.mass * layer.rate")
@kills("solvers.ross:_isotropic", "+ crossed[:, None", "- crossed[:, None")
def test_link() -> None:
    # The link's matrices have condition numbers below 1e3.
    for whirl in (-55.0, -20.0, 13.0, 33.0, 40.0, 61.0):
        h = field_stiffness(FILL, 40.0, whirl, RATE)
        shape = FORWARD
        close(condensed(FILL, 40.0, whirl, linear(RATE), shape), h * shape, 1e-11, abs(h))


class Recorder:
    """Stands for an element of ROSS: keeps what it is given."""

    def __init__(self, **given: Any) -> None:
        self.given = given


class BothAxes(Recorder):
    """A bearing of ROSS 3: tables over the spin, the whirl's frequency, or both."""

    def __init__(self, speed: Any = None, frequency: Any = None, **given: Any) -> None:
        super().__init__(speed=speed, frequency=frequency, **given)
        for name in given:
            setattr(self, f"{name}_interpolated", SimpleNamespace(_interpolated=None))


@contextmanager
def recorded(bearing: type[Recorder] = Recorder) -> Iterator[None]:
    """Elements are recorded instead of made."""
    stand_in = SimpleNamespace(BearingElement=bearing, PointMass=Recorder)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(sys.modules, "ross", stand_in)
        yield


@kills("solvers.ross:_named", "m[:, i, j]", "m[:, j, i]")
@kills("solvers.ross:liquid_layer", "np.square(_AXIAL", "(_AXIAL")
def test_names() -> None:
    """kxy is the force along x for a displacement along y, as ROSS has it."""
    spins = np.array([20.0, 30.0, 40.0, 50.0])
    with recorded():
        one: Any = liquid_bearing(FILL, 2, spins, 0.7 * spins, linear(RATE))
        liquid: Any = liquid_layer(FILL, 2, 5, spins, linear(RATE))
    found, link = (
        liquid_coefficients(FILL, spins, 0.7 * spins, linear(RATE)),
        liquid_link(FILL, spins, linear(RATE)),
    )
    for element, own in ((one, found), (liquid.bearings[0], link)):
        for letter, matrix in (("m", own.mass), ("c", own.damping), ("k", own.stiffness)):
            rows = [[element.given[f"{letter}{i}{j}"] for j in "xy"] for i in "xy"]
            assert np.array_equal(np.moveaxis(np.array(rows), -1, 0), matrix)
        assert np.array_equal(element.given["frequency"], spins)
    held, support = (part.given for part in liquid.bearings)
    assert (held["n"], held["n_link"], support["n"], liquid.mass.given["n"]) == (2, 5, 5, 5)
    # The liquid between the chamber's ends is stiff: its axial frequency is ten times the highest spin.
    assert liquid.mass.given["m"] == FILL.mass
    np.testing.assert_allclose(np.sqrt(held["kzz"] / FILL.mass), 500.0, rtol=1e-15)


def test_each_table_has_its_axis_in_ross_3() -> None:
    """Over spins it is one of `speed`, over whirls at one spin of `frequency`, through every entry."""
    axis = np.array([20.0, 30.0, 40.0, 50.0])
    with recorded(BothAxes):
        spins: Any = liquid_bearing(FILL, 2, axis, 0.7 * axis, linear(RATE))
        whirls: Any = liquid_bearing(FILL, 2, 40.0, axis, linear(RATE))
        held: Any = liquid_layer(FILL, 2, 5, axis, linear(RATE)).bearings[0]
    for element, over, other in (
        (spins, "speed", "frequency"), (whirls, "frequency", "speed"), (held, "speed", "frequency"),
    ):  # fmt: skip
        assert element.given[other] is None
        assert np.array_equal(element.given[over], axis)
        passed = element.kxy_interpolated._interpolated(axis)
        np.testing.assert_allclose(passed, element.given["kxy"], rtol=1e-12)


@given(
    share=st.floats(1e-6, 0.999),
    spin=st.floats(1.0, 1e4),
    ratio=st.floats(0.05, 4.0),
    rate=st.floats(1e-2, 1.0),
)
def test_link_and_coefficients_agree(share: float, spin: float, ratio: float, rate: float) -> None:
    """Over the whole box, friction from a hundredth of the spin to all of it."""
    fill = Fill(CHAMBER, WATER, share * CHAMBER.capacity)
    friction, whirl = linear(rate * spin, fill), ratio * spin
    found = liquid_coefficients(fill, spin, whirl, friction)
    h = acts_on(found, whirl, FORWARD)
    # kappa - 1 of a layer of a millionth of the chamber keeps ten digits; damped resonances lose two more.
    size = np.abs(h).max() + fill.full_mass * whirl**2
    close(condensed(fill, spin, whirl, friction, FORWARD), h, 1e-8, size)
    assert found.mass[0, 0, 0] == fill.full_mass
    # Friction drags the whirl towards the spin: it brakes a faster one and drives a slower one.
    assert h[0].imag * np.sign(whirl - spin) >= -1e-12 * size


def test_inviscid_force_is_that_of_the_waves() -> None:
    kappa = (CHAMBER.radius / FILL.surface_radius) ** 2
    ratio = np.array([-1.5, -0.4, 0.3, 0.7, 1.0, 1.2, 2.5])
    wanted = -FILL.full_mass * np.square(40.0 * ratio) * force_ratio(kappa, ratio)
    close(dynamic_stiffness(FILL, 40.0, 40.0 * ratio), wanted, 1e-12, np.abs(wanted).max())


def test_full_and_empty() -> None:
    full, empty = Fill(CHAMBER, WATER, CHAMBER.capacity), Fill(CHAMBER, WATER, 0.0)
    ring = Chamber(radius=0.15, height=0.01, inner_radius=0.1)
    for fill, mass in (
        (full, full.mass),
        (empty, 0.0),
        (Fill(ring, WATER, ring.capacity), ring.capacity * 1e3),
    ):
        found = liquid_coefficients(fill, 40.0, 33.0)
        # What is left of k + m omega^2 - m omega^2 is its rounding.
        close(found.mass[0], mass * np.eye(2), 1e-15, mass)
        close(found.stiffness, 0.0, 1e-15, mass * 33.0**2)
        close(found.damping, 0.0, 1e-15, mass * 33.0)
        with pytest.raises(InputError, match="volume"):
            liquid_link(fill, 40.0)
    almost = Fill(CHAMBER, WATER, (1.0 - 1e-6) * CHAMBER.capacity)
    # 1 - T is 5e-7 there, and s^2/D of the same order.
    close(dynamic_stiffness(almost, 40.0, 33.0), -almost.mass * 33.0**2, 1e-4, almost.mass * 33.0**2)


def eigenvalues(spin: float, friction: Friction, mass: float, stiffness: float, damping: float) -> np.ndarray:
    """Of a Jeffcott rotor with the link of the layer, 1/s."""
    link, one = liquid_link(FILL, spin, friction), np.eye(2)

    def both(link_part: np.ndarray, own: float, liquid: float) -> np.ndarray:
        return np.block([[link_part + own * one, -link_part], [-link_part, link_part + liquid * one]])

    m = both(link.mass[0], mass, FILL.mass)
    c, k = both(link.damping[0], damping, 0.0), both(link.stiffness[0], stiffness, 0.0)
    state = np.block([[np.zeros((4, 4)), np.eye(4)], [-np.linalg.solve(m, k), -np.linalg.solve(m, c)]])
    return np.asarray(np.linalg.eigvals(state))


@kills("solvers.ross:liquid_link", "4.0 * inertia * omega", "2.0 * inertia * omega")
@kills("solvers.ross:liquid_link", "-2.0 * inertia", "2.0 * inertia")
def test_self_excited_band() -> None:
    """mu = 0.1, h0/R = 0.1 without damping: unstable from 1.1225 to 1.475 natural frequencies."""
    mass = FILL.full_mass / 0.1
    # The edges are known to a step of 5e-4 omega_n. Two roots meet there and the growth rises with the square
    # root of the distance: 1.5e-3 away it is of the order of 1e-2 omega_n, outside it is rounding.
    for ratio, unstable in ((1.121, False), (1.124, True), (1.3, True), (1.4735, True), (1.4765, False)):
        found = eigenvalues(ratio * 100.0, Friction(), mass, mass * 1e4, 0.0)
        assert (found.real.max() > 1e-3) == unstable


@kills("solvers.ross:liquid_link", "np.square(omega), damping * omega", "np.square(omega), -damping * omega")
def test_growth() -> None:
    """The link's roots are those of the whirl's characteristic equation, with both dampings."""
    mass, stiffness, damping = 4.0, 4.4e4, 84.0
    for spin in (60.0, 120.0, 200.0):
        for root in eigenvalues(spin, linear(RATE), mass, stiffness, damping):
            # Roots against the spin are the conjugates; either root or conjugate must fit.
            left = []
            for value in (root, np.conj(root)):
                whirl = complex(-1j * value)
                dry = stiffness - mass * whirl**2 + 1j * damping * whirl
                left.append(abs(dry + field_stiffness(FILL, spin, whirl, RATE)) / stiffness)
            # The residual moves by the slope of the equation, below 1e4 here, times rounding of a root.
            assert min(left) < 1e-9


PEER = peer_ross.RotorProblem(speed=np.linspace(5.3, 600.0, 12))


@kills("validation.benchmarks.peers.ross:RotorProblem.exact", "place @ supports", "-place @ supports")
@kills(
    "validation.benchmarks.peers.ross:RotorProblem.exact",
    "(rotor.transverse_inertia - rotor.polar",
    "(rotor.transverse_inertia + rotor.polar",
)
@kills(
    "validation.benchmarks.peers.ross:RotorProblem.exact",
    "direct * turning - crossed**2",
    "direct * turning + crossed**2",
)
@kills(
    "validation.benchmarks.peers.ross:RotorProblem.exact",
    "supports.sum(axis=0) - rotor.mass",
    "supports.sum(axis=0) + rotor.mass",
)
@kills(
    "validation.benchmarks.peers.ross:RotorProblem.exact",
    "turning - arm * crossed",
    "turning + arm * crossed",
)
def test_peer_answer() -> None:
    """The benchmark's closed form against the matrices of the rigid rotor."""
    run = peer_ross.unbalance(PEER)[0].prepare()()
    exact = PEER.exact()
    # Two well-conditioned equations a speed.
    close(run(), exact, 1e-12, float(np.abs(exact).max()))


@kills(
    "validation.benchmarks.peers.ross:RotorProblem.rigid",
    "self.diameter**2 / 16.0",
    "self.diameter**2 / 8.0",
)
@kills(
    "validation.benchmarks.peers.ross:RotorProblem.rigid",
    "places - masses @ places",
    "places + masses @ places",
)
def test_peer_inertia() -> None:
    """The rigid rotor's masses against a rod cut into slices, Gauss points along it."""
    nodes, weights = np.polynomial.legendre.leggauss(4)
    z, dz = 0.5 * PEER.length * (nodes + 1.0), 0.5 * PEER.length * weights
    area, spread = 0.25 * np.pi * PEER.diameter**2, np.pi * PEER.diameter**4 / 64.0
    masses = np.array([*PEER.mass, *(PEER.density * area * dz)])
    places = np.array([0.0, PEER.length, *z])
    middle = masses @ places / masses.sum()
    transverse = sum(PEER.transverse) + (PEER.density * spread * dz).sum() + masses @ (places - middle) ** 2
    rotor = PEER.rigid()
    # The quadrature is exact for these polynomials.
    np.testing.assert_allclose(rotor.mass, masses.sum(), rtol=1e-13)
    np.testing.assert_allclose(rotor.transverse_inertia, transverse, rtol=1e-13)
    polar = sum(PEER.polar) + 2.0 * PEER.density * spread * PEER.length
    np.testing.assert_allclose(rotor.polar_inertia, polar, rtol=1e-13)
    np.testing.assert_allclose(rotor.supports[0].position, -middle, rtol=1e-13)


@pytest.mark.parametrize(
    ("field", "call"),
    [
        ("whirl_speed", lambda: liquid_coefficients(FILL, 40.0, 0.0)),
        ("whirl_speed", lambda: liquid_coefficients(FILL, 40.0, -3.0)),
        ("whirl_speed", lambda: dynamic_stiffness(FILL, 40.0, np.inf)),
        ("spin", lambda: liquid_coefficients(FILL, np.nan)),
        ("friction", lambda: dynamic_stiffness(FILL, 40.0, 30.0, Friction("linear", -1.0))),
        ("friction", lambda: liquid_link(FILL, 40.0, Friction("linear", -1.0))),
        ("friction", lambda: liquid_link(FILL, 40.0, Friction("stokes"))),
        ("spin", lambda: liquid_link(FILL, np.inf)),
        ("speed", lambda: liquid_layer(FILL, 0, 1, [1.0, 2.0, 3.0])),
        ("spin", lambda: liquid_bearing(FILL, 0, [1.0, 2.0, 2.0, 3.0])),
        ("whirl_speed", lambda: liquid_bearing(FILL, 0, 40.0, 30.0)),
    ],
)
def test_bad_input(field: str, call: Any) -> None:
    with pytest.raises(InputError) as fault:
        call()
    assert fault.value.field == field


def test_without_ross(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "ross", None)
    with pytest.raises(ImportError, match=r"leblanc\[ross\]"):
        liquid_bearing(FILL, 0, [1.0, 2.0, 3.0, 4.0])


@pytest.fixture(scope="module")
def ross() -> Iterator[ModuleType]:
    """ROSS, whose dependencies warn and divide by zero on import."""
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        yield pytest.importorskip("ross")


# The disc, the support and the unbalance of a Jeffcott rotor; the chamber sits on the same node.
DRY = Jeffcott(mass=4.0, stiffness=4.4e4, damping=84.0, unbalance=1e-5)
SPEEDS = np.linspace(20.0, 300.0, 29)
NODE, LIQUID = 1, 3
RATE_IN_ROSS = linear(2.0)


def rotor(ross: ModuleType, bearings: Any = (), masses: Any = (), stiffer: float = 1.0) -> Any:
    """The Jeffcott rotor in ROSS: a light, stiff shaft whose mass counts as the disc's."""
    steel = ross.Material("light", rho=7.8, E=2e11, G_s=8e10)
    shaft = [ross.ShaftElement(L=0.2, idl=0.0, odl=0.05, material=steel, n=i) for i in (0, 1)]
    disc = ross.DiskElement(n=NODE, m=DRY.mass - 2.0 * shaft[0].m, Id=0.01, Ip=0.02)
    support = ross.BearingElement(
        n=NODE, kxx=DRY.stiffness, kyy=stiffer * DRY.stiffness, cxx=DRY.damping, kzz=1e4, tag="support"
    )
    return ross.Rotor(shaft, [disc], [support, *bearings], list(masses))


def unbalanced(one: Any, speeds: np.ndarray = SPEEDS) -> np.ndarray:
    """x and y at the disc, shape (n, 2)."""
    found = one.run_unbalance_response(NODE, DRY.unbalance, 0.0, speeds).forced_resp
    return np.asarray(found[one.number_dof * NODE : one.number_dof * NODE + 2].T)


def with_link(ross: ModuleType, stiffer: float = 1.0) -> Any:
    liquid = liquid_layer(FILL, NODE, LIQUID, SPEEDS, RATE_IN_ROSS)
    return rotor(ross, liquid.bearings, [liquid.mass], stiffer)


def test_ross_dry_rotor_is_ours(ross: ModuleType) -> None:
    ours = response(DRY, [], SPEEDS).deflection_dry
    # The shaft's ends bend under their own inertia: their mass over the disc's is 2e-3, and their stiffness
    # 3 E I/L^3 = 2e7 N/m against Omega^2 of it, 7e2 N/m, leaves 4e-5 of that.
    close(unbalanced(rotor(ross)) / ours[:, None], np.broadcast_to(FORWARD, (29, 2)), 1e-7, 1.0)


@pytest.mark.parametrize("form", ["link", "coefficients", "mass"])
def test_ross_with_liquid_is_ours(ross: ModuleType, form: str) -> None:
    ours = response(DRY, [FILL], SPEEDS, gravity=0.0, model=Linear()).deflection
    if form == "link":
        wet = with_link(ross)
    elif form == "coefficients":
        wet = rotor(ross, [liquid_bearing(FILL, NODE, SPEEDS, friction=RATE_IN_ROSS)])
    else:
        added = ross.BearingElement(n=NODE, kxx=0.0, cxx=0.0, mxx=FILL.full_mass, tag="added")
        wet = rotor(ross, [added])
    close(unbalanced(wet) / ours[:, None], np.broadcast_to(FORWARD, (29, 2)), 1e-7, 1.0)


def test_both_forms_agree_on_a_support_with_two_stiffnesses(ross: ModuleType) -> None:
    """The axis' ellipse has a part against the spin, which meets the liquid at -Omega."""
    link = unbalanced(with_link(ross, 1.5))
    table = unbalanced(rotor(ross, [liquid_bearing(FILL, NODE, SPEEDS, friction=RATE_IN_ROSS)], stiffer=1.5))
    assert np.abs(link[:, 0] + 1j * link[:, 1]).max() > 0.1 * np.abs(link).max()
    # Both are exact; the condition numbers of ROSS's matrices, 1e9, are rounding's.
    close(link, table, 1e-7, np.abs(link).max())
    added = ross.BearingElement(n=NODE, kxx=0.0, cxx=0.0, mxx=FILL.full_mass, tag="added")
    mass = unbalanced(rotor(ross, [added], stiffer=1.5))
    # The mass alone misses what the liquid does backward.
    assert np.abs(link - mass).max() > 1e-3 * np.abs(link).max()


def test_ross_answers_any_frequency_with_the_link(ross: ModuleType) -> None:
    spin, wet = 130.0, with_link(ross)
    first = wet.number_dof * NODE
    for whirl in (40.0, 95.0, 130.0, 210.0):
        answer = wet.transfer_matrix(speed=spin, frequency=whirl)[first : first + 2, first : first + 2]
        dry = DRY.stiffness - DRY.mass * whirl**2 + 1j * whirl * DRY.damping
        wanted = 1.0 / (dry + field_stiffness(FILL, spin, whirl, 2.0))
        close(answer @ FORWARD, wanted * FORWARD, 1e-7, abs(wanted))


@pytest.mark.parametrize("sparse", [True, False])
def test_ross_modes_grow_as_they_should(ross: ModuleType, sparse: bool) -> None:
    wet = with_link(ross)
    for spin in (90.0, 120.0, 150.0):
        found = wet.run_modal(spin, sparse=sparse).evalues
        for value in eigenvalues(spin, RATE_IN_ROSS, DRY.mass, DRY.stiffness, DRY.damping):
            # Rounding of a state matrix whose largest entries are 1e8 times its slow eigenvalues.
            close(np.abs(found - value).min(), 0.0, 1e-7, abs(value))
        growth, whirl_speed = asynchronous_growth(DRY, [FILL], [spin], RATE_IN_ROSS)
        most = complex(growth[0], abs(whirl_speed[0]))
        close(np.abs(found - most).min(), 0.0, 1e-7, abs(most))


def test_tables_are_passed_through(ross: ModuleType) -> None:
    """Small coefficients of an asynchronous whirl, which the smoothing splines of ROSS 2 lose."""
    whirl = np.linspace(20.0, 60.0, 15)
    found = liquid_coefficients(FILL, 40.0, whirl, RATE_IN_ROSS)
    element = liquid_bearing(FILL, NODE, 40.0, whirl, RATE_IN_ROSS)
    plain = ross.BearingElement(
        n=NODE, frequency=whirl, kxx=found.stiffness[:, 0, 0], cxx=found.damping[:, 0, 0]
    )
    size = np.abs(found.damping).max()
    lost = [abs(float(plain.C(w)[0, 0]) - c) for w, c in zip(whirl, found.damping[:, 0, 0], strict=True)]
    for k, w in enumerate(whirl):
        close(element.C(w)[:2, :2], found.damping[k], 1e-12, size)
        close(element.K(w)[:2, :2], found.stiffness[k], 1e-12, np.abs(found.stiffness).max())
        close(element.M(w)[:2, :2], found.mass[k], 1e-12, FILL.full_mass)
    assert three(ross) or max(lost) > 1e-3 * size


def three(ross: ModuleType) -> bool:
    """ROSS 3 or later."""
    return int(ross.__version__.partition(".")[0]) >= 3


def test_a_link_is_exact_between_the_entries_of_its_table(ross: ModuleType) -> None:
    """Its coefficients are polynomials of the spin, which cubic splines repeat."""
    spins = np.linspace(0.0, 300.0, 6)
    held = liquid_layer(FILL, NODE, LIQUID, spins, RATE_IN_ROSS).bearings[0]
    for spin in (10.0, 77.0, 295.0):
        own = liquid_link(FILL, spin, RATE_IN_ROSS)
        close(held.K(spin)[:2, :2], own.stiffness[0], 1e-12, np.abs(own.stiffness).max())
        close(held.C(spin)[:2, :2], own.damping[0], 1e-12, np.abs(own.damping).max())
        if three(ross):
            # Whatever the frequency: the spin is its axis.
            close(held.K(500.0, spin)[:2, :2], own.stiffness[0], 1e-12, np.abs(own.stiffness).max())


def test_peer_solves_the_same_problem(ross: ModuleType) -> None:
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        samples = peer_ross.compare(PEER, repeats=0)
    assert [one.code for one in samples] == ["leblanc", "leblanc", "ROSS"]
    # The shaft bends: 2e5 N/m of a support over 3 E I/L^3 = 1e11 N/m; near a peak some times that.
    assert all(not one.note and one.error < 1e-6 for one in samples)
