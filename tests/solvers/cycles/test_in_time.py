"""Limit cycles of random machines against rotor and layers marched in time at constant spin."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.cycles.cycles import limit_cycles
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import Support, TwoPlane
from solvers.runup.runup import RunupNumerics
from tests.mutants import kills
from validation.whirl_in_time import large_whirl_in_time, passage

CELLS = 64
# Rotor, chambers, and about its natural frequency, rad/s.
Machine = tuple[Rotor, list[Fill], float]


def layer(generator: np.random.Generator, plane: float = 0.0) -> Fill:
    """A chamber with a layer a twentieth to an eighth of the radius deep."""
    radius, height = generator.uniform(0.08, 0.14), generator.uniform(0.015, 0.03)
    depth = generator.uniform(0.05, 0.12)
    chamber = Chamber(radius, height, plane=plane)
    return Fill(chamber, Liquid("any", 1000.0, 1e-6), (1.0 - (1.0 - depth) ** 2) * chamber.capacity)


def planar(generator: np.random.Generator) -> Machine:
    """Two different layers in a rotor that moves in one plane."""
    fills = [layer(generator), layer(generator)]
    mass = sum(fill.full_mass for fill in fills) / generator.uniform(0.08, 0.15)
    stiffness = mass * generator.uniform(60.0, 150.0) ** 2
    damping = 2.0 * generator.uniform(0.02, 0.03) * math.sqrt(stiffness * mass)
    return Jeffcott(mass, stiffness, damping, 0.0), fills, math.sqrt(stiffness / mass)


def two_planes(generator: np.random.Generator) -> Machine:
    """Unlike supports and layers: the whirl's shape is complex and changes along the branch."""
    fills = [layer(generator, -0.05), layer(generator, 0.07)]
    mass = sum(fill.full_mass for fill in fills) / generator.uniform(0.08, 0.15)
    inertia = mass * generator.uniform(0.07, 0.1) ** 2
    first, second = 0.5 * mass * generator.uniform(80.0, 110.0, 2) ** 2
    damping = generator.uniform(0.03, 0.05, 2) * mass * 100.0
    supports = (
        Support(-0.1, float(first), float(damping[0])),
        Support(0.12, float(second), float(damping[1])),
    )
    natural = math.sqrt(float(first + second) / mass)
    return TwoPlane(mass, inertia, 0.7 * inertia, supports), fills, natural


def tub(generator: np.random.Generator) -> Machine:
    """A tub whose springs and dampers are the same in all directions across the axis."""
    fills = [layer(generator, 0.04)]
    mass = fills[0].full_mass / generator.uniform(0.08, 0.12)
    stiffness, damping = 0.5 * mass * 90.0**2, generator.uniform(0.02, 0.03) * mass * 90.0
    mounts = [
        [Mount((0.0, y, 0.0), along_axes=(value, value, value)) for y in (-0.2, 0.2)]
        for value in (stiffness, damping)
    ]
    inertia = mass * 0.15**2
    rotor = Tub(
        tub_mass=0.6 * mass,
        tub_inertia=(inertia, inertia, inertia),
        drum_mass=0.4 * mass,
        drum_polar_inertia=0.2 * inertia,
        drum_transverse_inertia=0.3 * inertia,
        springs=tuple(mounts[0]),
        dampers=tuple(mounts[1]),
        unbalance=0.0,
    )
    return rotor, fills, 90.0


@pytest.mark.slow
@pytest.mark.parametrize("make", [planar, two_planes, tub])
def test_random_machines_come_to_their_limit_cycle(make) -> None:
    generator = np.random.default_rng({"planar": 3, "two_planes": 5, "tub": 8}[make.__name__])
    rotor, fills, natural = make(generator)
    friction = Friction("linear", generator.uniform(2.0, 4.0))
    cycles = limit_cycles(rotor, fills, (0.8 * natural, 1.5 * natural), friction, CELLS)
    assert cycles.branches, cycles.reason
    branch = max(cycles.branches, key=lambda own: own.amplitude[own.stable].max(initial=0.0))
    # In the middle of the branch, where it settles soon and the liquid lags by less than a third.
    steady = np.flatnonzero(branch.stable)
    k = int(steady[np.argmin(np.abs(branch.amplitude[steady] - 0.5 * branch.amplitude[steady].max()))])
    found = large_whirl_in_time(
        rotor, fills, float(branch.speed[k]), friction, 0.7 * branch.amplitude[k], CELLS
    )
    assert found.spread < 5e-3  # what settling leaves
    assert found.amplitude == pytest.approx(branch.amplitude[k], rel=5e-3)
    assert found.whirl_speed == pytest.approx(branch.whirl_speed[k], rel=1e-3)


@kills(
    "validation.whirl_in_time:passage", "amplitude_down=h.amplitude[down]", "amplitude_down=h.amplitude[up]"
)
def test_a_run_up_is_behind_its_limit_cycle_and_a_run_down_above_it_in_proportion_to_the_rate() -> None:
    fill = Fill(Chamber(0.1, 0.02), Liquid("any", 1000.0, 1e-6), 0.19 * Chamber(0.1, 0.02).capacity)
    mass = 10.0 * fill.full_mass
    rotor, law = Jeffcott(mass, mass * 100.0**2, 4.0 * mass, 0.0), Friction("linear", 3.0)
    size = limit_cycles(rotor, [fill], (110.0, 150.0), law, cells=32).largest_stable(145.0)
    # The mass off the axis by a fiftieth of the depth: the whirl is soon there, the unbalance's share small.
    resolved, speeds = RunupNumerics(cells=32), (118.0, 165.0)
    behind = []
    for rate in (16.0, 8.0):
        run = passage(rotor, fill, law, speeds, rate, resolved, 0.02)
        assert run.converged
        # Mean over beats with the unbalance's share.
        sizes = []
        for speed, amplitude in ((run.speed, run.amplitude), (run.speed_down, run.amplitude_down)):
            near = np.abs(speed - 145.0) < 4.0
            sizes.append(float(amplitude[near].mean()) / size - 1.0)
        assert -0.1 < sizes[0] < -0.02 and 0.02 < sizes[1] < 0.1
        behind.append(sizes)
    (up, down), (slow_up, slow_down) = behind
    assert up < slow_up and slow_down < down
    # In proportion to the rate to first order: what is left is of the order of the distance itself.
    assert up / slow_up == pytest.approx(2.0, rel=0.1) and down / slow_down == pytest.approx(2.0, rel=0.1)
