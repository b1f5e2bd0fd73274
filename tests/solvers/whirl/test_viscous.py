"""Laminar friction in self-excited whirl beside the plane Navier-Stokes equations of rotor and liquid."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw, layer_thickness
from fluid.liquid import Liquid
from fluid.whirl import Layer, damped_waves, drag_power, layer_rate, plane_layer
from meshes.chamber import Chamber
from solvers.cycles.balance import circular
from solvers.cycles.edges import small_whirl_edges
from solvers.rotor.jeffcott import Jeffcott
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills
from tests.oracles.viscous import Machine, liquid_answer, whirl

RADIUS, NATURAL = 0.15, 40.0
LAMINAR = Friction(FrictionLaw.STOKES)
TALL = 1e6  # of the chamber, m: no floor and lid to speak of
FULL = 1000.0 * math.pi * RADIUS**2  # kg/m
ROTOR = Jeffcott(10.0 * FULL * TALL, 10.0 * FULL * NATURAL**2 * TALL, 0.0, 0.0)
CENTRED = {0.05: 1.3, 0.1: 1.3, 0.2: 1.4, 0.3: 1.45}  # spins inside the bands over the natural frequency


def changes(depth: float, viscosity: float, points: int = 96) -> tuple[float, float, float]:
    """Change of growth by viscosity as the package has it and as it is, 1/s, and the wall layer over h."""
    surface, spin = RADIUS * (1.0 - depth), CENTRED[depth] * NATURAL
    volume = math.pi * (RADIUS**2 - surface**2) * TALL
    fill = Fill(Chamber(RADIUS, TALL), Liquid("of a test", 1000.0, viscosity), volume)
    free = asynchronous_growth(ROTOR, [fill], [spin])[0][0]
    growth, speed = (x[0] for x in asynchronous_growth(ROTOR, [fill], [spin], LAMINAR))
    machine = Machine(ROTOR.mass / TALL, ROTOR.stiffness / TALL, 0.0, RADIUS, surface, 1000.0, viscosity)
    slip = whirl(machine, spin, complex(speed - spin, -growth), points)
    thin = float(layer_thickness(viscosity, slip.real)) / (depth * RADIUS)
    return growth - free, -slip.imag - free, thin


def test_the_oracle_keeps_newtons_law() -> None:
    """Pressure and shear on the wall are what moves the centre of mass; more points change nothing."""
    machine = Machine(1.0, 1.0, 0.0, RADIUS, 0.9 * RADIUS, 1000.0, 1e-6)
    found = [liquid_answer(machine, 50.0, -9.0 - 2.0j, points) for points in (48, 64)]
    for answer in found:
        assert abs(answer.force / answer.newton - 1.0) < 1e-8
    assert abs(found[0].force / found[1].force - 1.0) < 1e-7


@kills("fluid.whirl:wall_share", "(1.0 - layer_tanh) * (1.0 + layer_tanh)", "(1.0 - layer_tanh)")
@kills("fluid.whirl:plane_layer", "shear / radius * wall_share", "shear / radius * 1.1 * wall_share")
def test_growth_is_that_of_the_viscous_liquid() -> None:
    """The law is right to first order in the wall layer's thickness: what is left is of its second."""
    for depth in CENTRED:
        gaps = []
        for viscosity in (1e-6, 2.5e-7):
            law, exact, thin = changes(depth, viscosity)
            # The heat of the irrotational flow itself, twice a layer's thickness over its arc, and the next
            # power of that over the depth.
            assert abs(law / exact - 1.0) < 4.0 * thin, (depth, viscosity)
            gaps.append(law - exact)
        # Twice as thin a layer leaves a quarter, but for the third order.
        assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize("depth", [0.1, 0.2, 0.3])
def test_long_waves_drag_more(depth: float) -> None:
    """By (R^2 + a^2)/(2 a^2) at the wall [theory: long_wave, eq. 10]: no law for growth in deep layers."""
    a = 1.0 - depth
    long_wave = 2.0 / (1.0 + a) / depth
    exact = 4.0 * a**2 / (1.0 - a**4)
    assert long_wave / exact == pytest.approx((1.0 + a**2) / (2.0 * a**2), rel=1e-12)
    law, true, _ = changes(depth, 2.5e-7)
    assert np.sign(law) == np.sign(true) and abs(law / true - 1.0) < 0.5 * (long_wave / exact - 1.0)


class Motion(NamedTuple):
    """A plane layer's irrotational motion under a whirl w e^{i omega t} of its drum, of unit depth."""

    heat: float  # of Stokes' and Ekman's layers on the wall, on floor and lid, over rho sqrt(nu), mean
    energy: float  # of the liquid in the turning frame beyond that at rest, over rho
    centre: float  # offset of the centre of mass from the drum's axis, m


def motion(surface: float, height: float, spin: float, whirl_speed: float, w: float) -> Motion:
    """By quadrature on the section; surface 0 for the free wave of unit height that w = 0 leaves."""
    slip, a = whirl_speed - spin, surface
    # u = Re grad phi e^{i s t}, phi = c (r + R^2/r) e^{-i theta} [theory: whirl, eq. 1].
    rise, along, force = 1.0 - RADIUS**2 / a**2, a + RADIUS**2 / a, whirl_speed**2 * w
    flux = a - RADIUS**2 / a  # psi is c times it, from the wall where it is 0
    per_rise = rise / (1j * slip)
    if force:
        c = -force * a / (spin**2 * a * per_rise - 1j * slip * along - 2.0 * spin * 1j * flux)
    else:
        c = complex(1.0 / per_rise)
    xi = per_rise * c
    theta = np.arange(64) * 2.0 * np.pi / 64
    step = 2.0 * np.pi / 64
    x, weights = np.polynomial.legendre.leggauss(24)
    r = 0.5 * (RADIUS + a) + 0.5 * (RADIUS - a) * x[:, None]
    area = 0.5 * (RADIUS - a) * weights[:, None] * r * step
    turn = np.exp(-1j * theta)
    radial, round_ = c * (1.0 - RADIUS**2 / r**2) * turn, -1j * c * (1.0 + RADIUS**2 / r**2) * turn
    cos, sin = np.cos(theta), np.sin(theta)
    u = np.stack([radial * cos - round_ * sin, radial * sin + round_ * cos])
    # Circles with and against the spin at each point, whose layers have k^2 = i (2 Omega +- s)/nu.
    with_, against = 0.5 * (u[0] + 1j * u[1]), 0.5 * (u[0] - 1j * u[1])
    drags = (math.sqrt(0.5 * abs(2.0 * spin + q)) for q in (slip, -slip))
    plates = sum(
        d * float(np.sum(area * np.abs(q) ** 2)) for d, q in zip(drags, (with_, against), strict=True)
    )
    wall = 0.5 * math.sqrt(0.5 * abs(slip)) * float(np.sum(np.abs(-2j * c * turn) ** 2)) * RADIUS * step
    # In the frame that turns about the fixed axis: kinetic energy, and that of the centrifugal force on what
    # lies where the liquid is and was not.
    moves = 1j * slip * w * np.array([1.0, -1j])[:, None, None]
    kinetic = 0.25 * float(np.sum(area * np.abs(u + moves) ** 2))
    surface_now = np.real(xi * turn)
    moment = -float(np.sum(a**2 * surface_now * cos)) * step
    place = math.pi * (RADIUS**2 - a**2) * w**2 + 2.0 * w * moment
    lifted = place - float(np.sum(a**2 * surface_now**2)) * step
    return Motion(
        wall + 2.0 * plates / height,
        kinetic - 0.5 * spin**2 * lifted,
        moment / (math.pi * (RADIUS**2 - a**2)),
    )


HEIGHT = 0.04  # of a chamber whose floor and lid drag as much as its wall


def weakly(depth: float, viscosity: float) -> tuple[Fill, Layer]:
    """Liquid of next to no viscosity in a low chamber."""
    volume = math.pi * RADIUS**2 * (1.0 - (1.0 - depth) ** 2) * HEIGHT
    fill = Fill(Chamber(RADIUS, HEIGHT), Liquid("of a test", 1000.0, viscosity), volume)
    layer = plane_layer(fill, LAMINAR)
    assert layer is not None
    return fill, layer


@kills("fluid.whirl:_plates", "first * along + second * against", "second * along + first * against")
@kills("fluid.whirl:_plates", "slip, dtype=complex), np.asarray(layer_tanh)", "slip, dtype=complex), 0.0")
@kills("fluid.whirl:wall_share", "(1.0 + layer_tanh) / layer_tanh", "1.0 / layer_tanh")
@pytest.mark.parametrize("depth", [0.1, 0.3, 0.5])
def test_weak_friction_takes_its_heat_from_the_whirl(depth: float) -> None:
    """Growth is minus the heat over twice the energy of the whirl without friction, both by quadrature.

    Above the band the rotor's own whirl turns more slowly than the drum, and its energy is below 0.
    """
    viscosity, density, spin = 1e-14, 1000.0, 3.0 * NATURAL
    fill, _ = weakly(depth, viscosity)
    share = HEIGHT / TALL
    rotor = Jeffcott(ROTOR.mass * share, ROTOR.stiffness * share, 0.0, 0.0)
    growth, speed = (float(x[0]) for x in asynchronous_growth(rotor, [fill], [spin], LAMINAR))
    found = motion(fill.surface_radius, HEIGHT, spin, speed, 1.0)
    # It is the mode: Newton's law for rotor and liquid, to the root of the viscosity.
    pull = rotor.mass + fill.mass * (1.0 + found.centre)
    assert rotor.stiffness == pytest.approx(speed**2 * pull, rel=1e-6)
    slip = speed - spin
    energy = 0.5 * rotor.mass * slip**2 + 0.5 * (rotor.stiffness - rotor.mass * spin**2)
    energy += density * HEIGHT * found.energy
    heat = density * HEIGHT * math.sqrt(viscosity) * found.heat
    # Of the next order is a layer's thickness over the liquid's depth, 1e-7.
    assert growth > 0.0 > energy and growth == pytest.approx(-heat / (2.0 * energy), rel=1e-5)


@kills("fluid.whirl:drag_power", "0.5 * layer.mass * (1.0 - layer.layer_tanh)", "0.5 * layer.mass")
@pytest.mark.parametrize("depth", [0.1, 0.3, 0.5])
def test_heat_of_weak_friction(depth: float) -> None:
    """A driven layer's by quadrature; a free wave decays by its heat over twice its energy."""
    viscosity, density, spin = 1e-14, 1000.0, 40.0
    fill, layer = weakly(depth, viscosity)
    scale = density * HEIGHT * math.sqrt(viscosity)
    for speed in (0.5 * spin, -0.7 * spin, 2.2 * spin):
        found = motion(fill.surface_radius, HEIGHT, spin, speed, 1e-3)
        heat = float(drag_power(layer, spin, speed, speed**2 * 1e-3))
        assert heat == pytest.approx(scale * found.heat, rel=1e-5)
    for wave in damped_waves(layer.layer_tanh, spin, 0.0):
        slip = float(wave.real)
        free = motion(fill.surface_radius, HEIGHT, spin, spin + slip, 0.0)
        rate = float(layer_rate(layer, spin, slip).real)
        decay = complex(damped_waves(layer.layer_tanh, spin, rate)[0 if slip > 0.0 else 1]).imag
        assert decay == pytest.approx(math.sqrt(viscosity) * free.heat / (2.0 * free.energy), rel=1e-5)


@kills("solvers.cycles.edges:_rates", "layer_rate(place.layer, spin, slip).real", "place.layer.rate")
def test_edges_of_limit_cycles_balance_the_heat() -> None:
    """A whirl that neither grows nor decays: the supports' torque, times the slip, is the liquid's heat."""
    viscosity, zeta, share = 1e-8, 0.002, HEIGHT / TALL
    fill, _ = weakly(0.3, viscosity)
    mass = ROTOR.mass * share
    rotor = Jeffcott(mass, ROTOR.stiffness * share, 2.0 * zeta * mass * NATURAL, 0.0)
    edges = small_whirl_edges(circular(rotor.system(), [fill], LAMINAR), (1.0 * NATURAL, 2.0 * NATURAL))
    assert len(edges) == 2
    for edge in edges:
        heat = motion(fill.surface_radius, HEIGHT, edge.spin, edge.whirl_speed, 1.0).heat
        torque = rotor.damping * edge.whirl_speed
        # The motion is that without friction, a thousandth of the frequency, and edges lie on a line
        # between two of 201 spins.
        found = 1000.0 * HEIGHT * math.sqrt(viscosity) * heat
        assert found == pytest.approx(torque * (edge.spin - edge.whirl_speed), rel=4e-3)
