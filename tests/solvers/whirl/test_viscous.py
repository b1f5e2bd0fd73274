"""Laminar friction in self-excited whirl beside the plane Navier-Stokes equations of rotor and liquid."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction, layer_thickness
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.whirl.growth import asynchronous_growth
from tests.mutants import kills
from tests.oracles.viscous import Machine, liquid_answer, whirl

RADIUS, NATURAL = 0.15, 40.0
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
    growth, speed = (x[0] for x in asynchronous_growth(ROTOR, [fill], [spin], Friction("stokes")))
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
