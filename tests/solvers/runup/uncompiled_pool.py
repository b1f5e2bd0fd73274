"""Seeded faults of pools in coupled steps, and their oracles, run by `test_uncompiled.py`."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.layer.records import Outcome
from solvers.rotor.jeffcott import Jeffcott
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.machine import Handover
from tests.mutants import kills
from tests.solvers.layer.two_layer_drums import Drum

G = 9.81
FILL = Fill(Chamber(0.24, 0.06, 0.2, baffles=Baffles(8, 0.231)), Liquid("brine", 1200.0, 1.6e-6), 1.2e-3)
FREE = Jeffcott(3.0, 1e-9, 0.0, 0.0)
SOFT = Jeffcott(3.0, 600.0, 5.0, 0.01)


def poured(rotor: Jeffcott, spin: float = 15.0) -> Coupled:
    """Liquid at rest in a drum that turns, after a fiftieth of a second."""
    friction = Friction("quadratic", 0.01)
    machine = couple(rotor.system(), [FILL], spin, friction, G, 32, False, handover=Handover.CARRIED)
    machine.advance(0.02, 0.0, 0.8, 10**6)
    return machine


@kills("solvers.runup.steps.pools:move_pools", "pool.weight * begin.flow_y", "0.0 * begin.flow_y")
@kills("solvers.runup.steps.pools:begin_pools", "work[j], first[j])", "work[j], first.copy()[j])")
def test_momentum() -> None:
    """Beside a rotor of its own mass that floats: what the liquid gains the rotor loses, to rounding."""
    machine = poured(FREE)
    ((_, momentum, _, flows),) = machine._swinging()
    assert float(np.abs(momentum).max()) > 1e-5 and flows.spinning > 0.0
    np.testing.assert_allclose((3.0 + FILL.mass) * machine.velocity, -momentum, rtol=1e-6)


@kills("solvers.runup.steps.pools:move_pools", "gravity[0] - guess", "gravity[0] + guess")
def test_axis_that_shakes() -> None:
    """A heavy axis on springs, let go with a velocity: the liquid feels gravity less its acceleration."""
    heavy, frequency, rate, steps = 1e7, 120.0, 0.3, 80
    shaken = Jeffcott(heavy, heavy * frequency**2, 0.0, 0.0)
    machine = couple(shaken.system(), [FILL], 5.0, Friction(), G, 128, False, handover=Handover.CARRIED)
    machine.state.rate[0] = rate
    machine.advance(0.02, 0.0, 0.8, 10**6)
    drum, still = Drum(FILL, cells=128), Drum(FILL, cells=128)
    drum.lie()
    still.lie()
    for k in range(steps):
        edges = frequency * 0.02 / steps * np.array([k, k + 1])
        # The mean of rate omega sin(omega t) over a step.
        mean = rate * (math.cos(edges[0]) - math.cos(edges[1])) * steps / 0.02
        drum.force[0] = (mean - G) / 0.24
        drum.go(0.02 / steps, 5.0)
        still.go(0.02 / steps, 5.0)
    own = machine._flows(0).flow_x
    assert abs(drum.flows().flow_x - still.flows().flow_x) > 20.0 * abs(own - drum.flows().flow_x)


@kills("solvers.runup.steps.pools:move_pools", "scale * (begin.yy + end.yy)", "0.0 * (begin.yy + end.yy)")
def test_light_rotors_agree_with_their_liquid() -> None:
    """Beside a rotor of a twentieth of its mass as well, since the flow's inertia is put in beforehand."""
    machine = couple(
        Jeffcott(0.07, 1e-9, 0.0, 0.0).system(), [FILL], 15.0, Friction("quadratic", 0.01), G, 32, False,
        handover=Handover.CARRIED,
    )  # fmt: skip
    assert machine.advance(0.02, 0.0, 0.8, 10**6) is Outcome.DONE
    assert machine.sums.disagreement < 1e-6


@kills(
    "solvers.runup.steps.pools:tally_pools",
    "sums.lost -= 0.5 * dt * found[own, i]",
    "sums.lost += 0.5 * dt * found[own, i]",
)
@kills(
    "solvers.runup.steps.pools:tally_pools",
    "pool.inertia * (first[j].energy - last[j].energy) + fallen",
    "pool.inertia * (first[j].energy - last[j].energy) - fallen",
)
def test_energy() -> None:
    """What drum and gravity give is heat, motion of liquid and axis, and what mixing loses."""
    friction = Friction("quadratic", 0.01)
    machine = couple(SOFT.system(), [FILL], 15.0, friction, G, 32, False, handover=Handover.CARRIED)
    begin = machine.energy()
    machine.advance(0.02, 0.0, 0.8, 10**6)
    sums = machine.sums
    gained = sums.unbalance + sums.drive + sums.gravity
    spent = sums.friction + sums.baffles + sums.lost + sums.support
    # The acceleration that was put in and the one that came out agree to 1e-6.
    assert machine.energy() - begin == pytest.approx(gained - spent, abs=1e-6 * abs(sums.drive))
    assert sums.friction > 0.0 and sums.baffles > 0.0 and sums.lost > 0.0 and sums.bores == sums.lost


@kills("solvers.runup.steps.pools:tally_pools", "heat = pool.inertia * gone.heat", "heat = 0.5 * gone.heat")
@kills(
    "solvers.runup.steps.pools:tally_pools", "lost = pool.inertia * gone.baffles", "lost = 0.5 * pool.inertia"
)
@kills(
    "solvers.runup.steps.pools:tally_pools",
    "drive = spin * pool.inertia",
    "drive = 0.5 * spin * pool.inertia",
)
def test_works_are_those_of_the_layers() -> None:
    """With the axis held they are those of the two layers alone."""
    friction = Friction("quadratic", 0.01)
    stiff = Jeffcott(3.0, 1e13, 0.0, 0.0)
    machine = couple(stiff.system(), [FILL], 15.0, friction, G, 32, False, handover=Handover.CARRIED)
    machine.advance(0.01, 0.0, 0.8, 10**6)
    drum = Drum(FILL, friction)
    drum.lie()
    drum.go(0.01, 15.0)
    scale, taken = drum.stream.inertia, drum.taken
    # Steps of other lengths, of first order in the drag.
    assert machine.sums.friction == pytest.approx(scale * taken.heat, rel=2e-2)
    assert machine.sums.baffles == pytest.approx(scale * taken.baffles, rel=2e-2)
    assert machine.sums.drive == pytest.approx(15.0 * scale * taken.torque, rel=2e-2)


@kills(
    "solvers.runup.steps.spin:free_spin",
    "load += pools[j].inertia * taken[j].torque",
    "load += 0.0",
)
def test_a_free_drum_is_slowed() -> None:
    """What the liquid gets of angular momentum by the drum, a drum without a motor loses."""
    machine = couple(SOFT.system(), [FILL], 15.0, Friction(), 1e-4, 32, False, handover=Handover.CARRIED)
    machine._rearrange(np.array([False]))
    machine.two_layers[0, 2:] = 0.0
    machine._assemble()
    machine.load(0.0 * machine.machine.unbalance)
    machine.drive(np.array([[0.0, 100.0], [0.0, 0.0]]), 0.05)
    machine.advance(0.01, 0.0, 0.8, 10**6)
    spun = float(machine._turning()[0][0])
    assert spun > 1e-4 and 0.05 * (15.0 - machine.spin) == pytest.approx(spun, rel=1e-5)


@kills("solvers.runup.steps.pools:begin_pools", "rings[j] and stands", "rings[j] or stands")
@kills(
    "solvers.runup.steps.pools:begin_pools",
    "stands(two_layers[j], x, y, pool.full)",
    "stands(two_layers[j], 0.0, 0.0, pool.full)",
)
def test_a_ring_falls_once() -> None:
    """When its own rotation holds it no more it is in two layers, for good."""
    friction = Friction()
    machine = couple(SOFT.system(), [FILL], 60.0, friction, G, 32, False, handover=Handover.CARRIED)
    machine._rearrange(np.array([False]))
    assert machine.rings[0]
    machine.advance(0.002, 0.0, 0.8, 10**6)
    assert machine.rings[0]
    machine.state.two_layers[0, 2:] *= 0.95 * math.sqrt(G / FILL.surface_radius) / 60.0
    machine.advance(0.006, 0.0, 0.8, 10**6)
    assert not machine.rings[0] and machine.two_layers[0, 0].max() > 0.0
    machine.state.two_layers[0, 2:] *= 10.0
    machine.advance(0.008, 0.0, 0.8, 10**6)
    assert not machine.rings[0]
