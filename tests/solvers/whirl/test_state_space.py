"""State space of layers and of the planar machine: the linear model's force, its modes, its steady answer."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from fluid.waves import force_ratio
from fluid.whirl import Layer, layer_rate, offset_with_friction, plane_layer
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.synchronous.response import response
from solvers.whirl.growth import system_modes
from solvers.whirl.state_space import (
    BAND,
    ERROR,
    chamber_space,
    fit_root,
    largest_error,
    layer_force,
    machine_space,
)
from tests.mutants import kills

SPIN = 70.0
WATER = Liquid("water", 1000.0, 1e-6)
OIL = Liquid("oil", 900.0, 5e-5)
# From the drum, rad/s, on both sides, without the slips of a resonance to the last digit.
SLIP = np.concatenate([np.linspace(-311.0, -0.7, 40), np.linspace(0.9, 287.0, 40)])


def fill(share: float, liquid: Liquid = WATER) -> Fill:
    """A chamber, wetted to so much of its volume."""
    chamber = Chamber(0.12, 0.04)
    return Fill(chamber, liquid, share * chamber.capacity)


def layer(share: float, friction: Friction, liquid: Liquid = WATER) -> Layer:
    """Its layer."""
    found = plane_layer(fill(share, liquid), friction)
    assert found is not None
    return found


SPACE = "solvers.whirl.state_space:"


@kills(f"{SPACE}_parts", "a[1, 1] += 2j * t * spin", "a[1, 1] -= 2j * t * spin")
@kills(f"{SPACE}_parts", "a[1, 0] -= t * spin**2", "a[1, 0] += t * spin**2")
@kills(f"{SPACE}_parts", "h[0] += liquid.mass * spin**2", "h[0] -= liquid.mass * spin**2")
@kills(f"{SPACE}_parts", "h[1] -= 2j * liquid.mass * spin", "h[1] += 2j * liquid.mass * spin")
@kills(f"{SPACE}_parts", "g[1] = -0.5 * (1.0 - t)", "g[1] = -0.5 * (1.0 + t)")
@kills(f"{SPACE}_parts", "0.5 * (1.0 + t) * liquid.mass", "liquid.mass")
@kills(f"{SPACE}_real", "found[1::2, ::2], found[::2, 1::2] = matrix.imag, -matrix.imag", "pass")
@pytest.mark.parametrize("share", [0.02, 0.3, 0.9])
def test_force_of_an_inviscid_layer(share: float) -> None:
    """It is the exact linear theory's over the whirl, to rounding [theory: waves, eq. 5]."""
    chamber = fill(share)
    space = chamber_space(layer(share, Friction()), SPIN)
    kappa = (chamber.chamber.radius / chamber.surface_radius) ** 2
    full = 1000.0 * chamber.chamber.capacity
    exact = -full * force_ratio(kappa, (SPIN + SLIP) / SPIN)
    # A film's kappa - 1 has lost as many digits as it is small.
    assert np.abs(space(SLIP)[:, 0] / exact - 1.0).max() < 1e-9


@kills(f"{SPACE}_parts", "drag[1] = liquid.rate", "drag[1] = 0.5 * liquid.rate")
def test_force_and_offset_with_linear_friction() -> None:
    """Force and offset per displacement are those of the layer with friction [theory: whirl, eq. 4-5]."""
    wet = layer(0.3, Friction("linear", 3.0))
    space, whirl = chamber_space(wet, SPIN), SLIP + SPIN
    share = offset_with_friction(wet.layer_tanh, SPIN, whirl, layer_rate(wet, SPIN, SLIP))
    found = -np.square(whirl)[:, None] * space(SLIP)
    assert np.abs(found[:, 0] / (wet.mass * np.square(whirl) * (1.0 + share)) - 1.0).max() < 1e-9
    assert np.abs(found[:, 1] / share - 1.0).max() < 1e-9
    assert space.outputs == ("force_x", "force_y", "liquid_x", "liquid_y")


def test_the_matrices_are_real_and_of_their_names() -> None:
    """x' = A x + B u of parts (x, y) turns as the complex one: a quarter turn of u is one of y."""
    space = chamber_space(layer(0.3, Friction("linear", 3.0)), SPIN)
    n = len(space.states)
    assert space.A.shape == (n, n) and space.B.shape == (n, 2) and space.C.shape == (4, n)
    whole = 40j * np.eye(n) - space.A
    answer = space.C @ np.linalg.solve(whole, space.B) + space.D
    # e^{i s t} along x and, a quarter behind, along y is one circle with the spin.
    circle = answer @ np.array([1.0, -1.0j])
    assert circle[0] == pytest.approx(space(np.array([40.0]))[0, 0], rel=1e-12)
    assert circle[1] == pytest.approx(-1j * circle[0], rel=1e-12)


@kills(f"{SPACE}RootFit.at", "np.sqrt(spin) * self.weight", "spin * self.weight")
def test_the_root_is_fitted_by_drags() -> None:
    """Within its error in its band, at any spin; its part in phase with the velocity is never below 0."""
    root, (low, high) = fit_root().at(SPIN), BAND
    s = SPIN * np.geomspace(low, high, 5000)
    # Between 400 fitted frequencies it is no more than a little worse.
    assert np.abs(root(1j * s) / np.sqrt(1j * s) - 1.0).max() < 1.05 * ERROR
    assert (root.weight > 0.0).all() and (root.decay > 0.0).all()
    assert (root(1j * np.geomspace(1e-9, 1e9, 2000)).real >= 0.0).all()


@kills(f"{SPACE}_parts", "roots.append((0.5 * (1.0 - t) * liquid.lids, 2.0 * spin))", "pass")
@kills(f"{SPACE}_parts", "(1.0 + t) * liquid.lids, -2.0 * spin", "(1.0 + t) * liquid.lids, 2.0 * spin")
@kills(f"{SPACE}_parts", "-np.diag(root.decay + 1j * shift)", "-np.diag(root.decay - 1j * shift)")
@kills(f"{SPACE}_parts", "drag[own] = -size * root.weight", "drag[own] = size * root.weight")
@pytest.mark.parametrize("liquid", [OIL, WATER], ids=lambda each: each.name)
def test_laminar_friction_within_its_error(liquid: Liquid) -> None:
    """Over the band the force is the linear model's within the error that is said, and all decays."""
    wet = layer(0.3, Friction("stokes"), liquid)
    space = chamber_space(wet, SPIN)
    error = largest_error(wet, SPIN, space)
    assert error < 2.0 * ERROR
    slip = np.concatenate([-1.0, 1.0] * np.geomspace(0.011, 9.7, 300)[:, None]) * SPIN
    off = np.abs(space(slip)[:, 0] - layer_force(wet, SPIN, slip))
    assert (off <= 1.05 * error * np.maximum(np.abs(layer_force(wet, SPIN, slip)), wet.mass / 0.4)).all()
    assert np.linalg.eigvals(space.A).real.max() < 0.0


def of_machine(friction: Friction, liquid: Liquid) -> tuple[Jeffcott, list[Fill]]:
    """A planar rotor with two unlike chambers."""
    return Jeffcott(6.0, 6.0 * 55.0**2, 8.0, 1e-3), [fill(0.3, liquid), fill(0.1, liquid)]


@kills(f"{SPACE}machine_space", "a[1, 1] -= 2j * spin", "a[1, 1] += 2j * spin")
@kills(f"{SPACE}machine_space", "a[1, 0] += spin**2", "a[1, 0] -= spin**2")
@kills(f"{SPACE}machine_space", "- 1j * rotor.damping * spin", "+ 1j * rotor.damping * spin")
@kills(f"{SPACE}machine_space", "a[own] += np.outer(p.g, row)", "pass")
@pytest.mark.parametrize(
    "friction", [Friction(), Friction("linear", 2.0), Friction("stokes")], ids=lambda each: each.law.value
)
def test_poles_are_the_modes(friction: Friction) -> None:
    """Seen from the drum they are the modes of rotor and layers; with laminar drag by the fit's error."""
    rotor, fills = of_machine(friction, OIL)
    layers = [plane_layer(each, friction) for each in fills]
    space = machine_space(rotor, [each for each in layers if each is not None], SPIN)
    poles = np.linalg.eigvals(space.A[::2, ::2] + 1j * space.A[1::2, ::2]) + 1j * SPIN
    modes = system_modes(rotor, fills, np.array([SPIN]), friction)
    # A mode with the spin stands as it is among the poles, one against it as its conjugate.
    root = modes.root[0][modes.found[0] & (modes.root[0].imag >= 0.0)]
    far = np.abs(poles[:, None, None] - np.stack([root, root.conj()])).min(axis=(0, 1))
    # Laminar modes next to the band's lower end are those of the relative error of a small root.
    assert root.size >= 6
    assert far.max() < (3e-3 if friction.law.laminar else 1e-9) * SPIN


@kills(f"{SPACE}machine_space", "b[own] = p.g / mass", "pass")
@kills(f"{SPACE}machine_space", "force - wet * row", "force")
@kills(f"{SPACE}machine_space", "d = np.array([0.0, -wet / mass], dtype=complex)", "d = np.zeros(2, complex)")
def test_an_unbalance_is_a_constant_force() -> None:
    """Its steady deflection is the synchronous response; the liquid pulls as the mass of a full chamber."""
    friction = Friction("linear", 2.0)
    rotor, fills = of_machine(friction, WATER)
    layers = [each for each in (plane_layer(one, friction) for one in fills) if each is not None]
    space = machine_space(rotor, layers, SPIN)
    rest = space.D - space.C @ np.linalg.solve(space.A, space.B)
    found = rest @ [rotor.unbalance * SPIN**2, 0.0]
    exact = response(rotor, fills, np.array([SPIN])).deflection[0]
    assert found[0] + 1j * found[1] == pytest.approx(exact, rel=1e-9)
    full = sum(1000.0 * each.chamber.capacity for each in fills)
    assert found[2] + 1j * found[3] == pytest.approx(full * SPIN**2 * exact, rel=1e-9)


def test_liquid_without_a_surface_is_a_mass() -> None:
    """A full chamber, and a machine with one, have no states of liquid."""
    full = fill(1.0)
    space = chamber_space(full.mass, SPIN)
    assert space.states == () and pytest.approx(-full.mass * np.eye(2)) == space.D
    machine = machine_space(Jeffcott(5.0, 4e4, 0.0, 0.0), [full.mass], SPIN)
    poles = np.linalg.eigvals(machine.A) + 0j
    natural = math.sqrt(4e4 / (5.0 + full.mass))
    assert np.sort(np.abs(poles.imag)) == pytest.approx(
        np.sort(np.repeat(np.abs(np.array([natural, -natural]) - SPIN), 2)), rel=1e-9
    )
