"""Many machines at once: each as if alone, whatever stands beside it."""

from __future__ import annotations

import math

import numpy as np

from fluid.fill import Fill, Fills
from fluid.friction.laws import Friction
from fluid.liquid import Liquid
from leblanc.liquid.models import synchronous_model
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott, PlanarMachine
from solvers.statics.hydrostatics import equilibrium
from solvers.synchronous.models import STATICS
from solvers.synchronous.pairs import pair_machines
from solvers.synchronous.response import machine_responses, response
from solvers.whirl.growth import asynchronous_growth, machines_growth
from tests.mutants import kills

WATER, OIL = Liquid("water", 1000.0, 1e-6), Liquid("oil", 870.0, 6.9e-5)
GRAVITY = np.array([0.0, 9.81, 9.81, 0.0, 9.81])
OWNER = np.repeat(np.arange(5), 12)
SPEED = np.tile(np.linspace(40.0, 160.0, 12), 5)


def machines() -> list[PlanarMachine]:
    """None, one, two and three chambers, some without liquid, one with an inner wall."""
    wall = Fill(Chamber(0.06, 0.03, inner_radius=0.05), OIL, 3e-5)
    open_one = Fill(Chamber(0.065, 0.02), WATER, 1.2e-5)
    empty = Fill(Chamber(0.05, 0.02), WATER, 0.0)
    return [
        (Jeffcott(4.0, 4e4, 0.8, 1e-4), [open_one]),
        (Jeffcott(5.0, 4e4, 16.0, 3e-3), [open_one, wall]),
        (Jeffcott(3.0, 2e4, 30.0, 6e-4), [wall, empty, open_one]),
        (Jeffcott(4.0, 4e4, 20.0, 6e-4), []),
        (Jeffcott(4.0, 4e4, 20.0, 0.0), [empty, open_one, open_one]),
    ]


@kills("solvers.synchronous.pairs:pair_machines", "place = index[owner]", "place = index[owner[::-1]]")
def test_each_as_if_alone() -> None:
    """The response of many machines is that of each by itself, for every model."""
    for model in map(synchronous_model, ("statics", "linear")):
        many = machine_responses(machines(), OWNER, SPEED, GRAVITY, model)
        branches = np.isfinite(many.branch_deflection).sum(axis=1)
        for k, (rotor, fills) in enumerate(machines()):
            own = k == OWNER
            alone = response(rotor, fills, SPEED[own], GRAVITY[k], model)
            for name in ("deflection", "deflection_dry", "liquid_offset", "liquid_angle"):
                np.testing.assert_allclose(
                    getattr(many, name)[own], getattr(alone, name), rtol=1e-12, atol=1e-18
                )
            for name in ("dry_patch", "stable", "in_range", "converged"):
                np.testing.assert_array_equal(getattr(many, name)[own], getattr(alone, name))
            np.testing.assert_array_equal(branches[own], np.isfinite(alone.branch_deflection).sum(axis=1))
        assert many.converged.all()


@kills(
    "solvers.synchronous.pairs:Pairs.dynamic_stiffness",
    "elastic + 1j * self.damping",
    "elastic - 1j * self.damping",
)
@kills(
    "solvers.synchronous.pairs:pair_machines",
    "steepest, here.mass * here.chamber.radius",
    "steepest, here.mass",
)
@kills("solvers.synchronous.pairs:Pairs.pull", "moment - fills.mass * e", "moment")
@kills(
    "solvers.synchronous.pairs:Pairs.liquid",
    "(law.real_unbalance(), law.slope.real))",
    "(law.slope.real, law.real_unbalance()))",
)
@kills("solvers.synchronous.pairs:Pairs.pull", "self.model.added_mass(fills) * e", "fills.mass * e")
@kills(
    "solvers.synchronous.pairs:Pairs.pull",
    "pull(fills.at(bent), whirls)",
    "answer(fills.at(bent), whirls).slope",
)
def test_sums() -> None:
    """The pull and the liquid's state of a machine are sums over its chambers, each asked by itself."""
    pairs = pair_machines(machines(), OWNER, SPEED, GRAVITY, STATICS)
    which = np.flatnonzero(np.isin(OWNER, (1, 2)))[::3]
    e = np.linspace(1e-4, 2e-2, which.size)
    state, pull = pairs.liquid(e, which), pairs.pull(e, which)
    for i, k in enumerate(which):
        rotor, fills = machines()[OWNER[k]]
        wet = [fill for fill in fills if fill.volume > 0.0]
        law = [equilibrium(f.chamber, f.volume, e[i], SPEED[k], GRAVITY[OWNER[k]]).unbalance() for f in wet]
        moment = sum(f.liquid.density * one[0] for f, one in zip(wet, law, strict=True))
        mass = sum(f.liquid.density * f.volume for f in wet)
        np.testing.assert_allclose(state.unbalance[i], moment, rtol=1e-12)
        slope = sum(f.liquid.density * one[1] for f, one in zip(wet, law, strict=True))
        np.testing.assert_allclose(state.slope[i], slope, rtol=1e-12)
        # A difference of the moment and the mass times the deflection.
        expected = SPEED[k] ** 2 * (moment - mass * e[i])
        np.testing.assert_allclose(pull[i], expected, rtol=0.0, atol=1e-11 * SPEED[k] ** 2 * moment)
        stiffness = rotor.stiffness - rotor.mass * SPEED[k] ** 2 + 1j * rotor.damping * SPEED[k]
        np.testing.assert_allclose(pairs.dynamic_stiffness[k], stiffness, rtol=1e-14)
        full = sum(f.liquid.density * math.pi * f.chamber.radius**2 * f.chamber.height for f in wet)
        np.testing.assert_allclose((pairs.liquid_mass[k], pairs.added_mass[k]), (mass, full), rtol=1e-14)
        reach = sum(f.liquid.density * f.volume * f.chamber.radius for f in wet)
        np.testing.assert_allclose(pairs.reach[k], reach, rtol=1e-14)
    assert np.isinf(pairs.limit[OWNER == 3]).all() and np.isfinite(pairs.limit[OWNER == 1]).all()


@kills("fluid.fill:Fills.mass", "return self.density * self.volume", "return self.volume")
@kills(
    "fluid.fill:Fill.depth",
    "return film / (self.chamber.radius + self.surface_radius)",
    "return film / (2.0 * self.chamber.radius)",
)
def test_arrays_of_fills() -> None:
    """Arrays say what the fills say."""
    fills = [fill for _, some in machines() for fill in some]
    arrays = Fills.of(fills)
    for name in ("mass", "depth"):
        np.testing.assert_allclose(getattr(arrays, name), [getattr(f, name) for f in fills], rtol=1e-14)
    # The depth is that of the ring which has the volume: h0 (2 R - h0) pi h_c.
    walls, depth = arrays.chamber, arrays.depth
    held = np.pi * walls.height * depth * (2.0 * walls.radius - depth)
    np.testing.assert_allclose(held, arrays.volume, rtol=1e-12)
    full = [fill.full_mass if fill.volume > 0.0 else 0.0 for fill in fills]
    np.testing.assert_allclose(arrays.added_mass, full, rtol=1e-14)
    back = arrays.at(np.array([3, 1]))
    np.testing.assert_array_equal(back.volume, arrays.volume[[3, 1]])
    np.testing.assert_array_equal(back.chamber.inner_radius, arrays.chamber.inner_radius[[3, 1]])


@kills("solvers.whirl.growth:_planar_parts", "support[own[place]].T", "support[place].T")
@kills(
    "solvers.whirl.growth:_planar_parts",
    "mass = np.array([tables[i][0] for i in own])[place]",
    "mass = np.array([tables[0][0] for i in own])[place]",
)
def test_growth() -> None:
    """Growth of many machines, each with its own friction, is that of each by itself."""
    frictions = [Friction(), Friction("stokes"), Friction("linear", 2.0), Friction(), Friction("stokes")]
    growth, whirl_speed = machines_growth(machines(), frictions, OWNER, SPEED)
    for k, (rotor, fills) in enumerate(machines()):
        own = k == OWNER
        alone = asynchronous_growth(rotor, fills, SPEED[own], frictions[k])
        # The order in which terms are added differs.
        np.testing.assert_allclose(growth[own], alone[0], rtol=1e-8, atol=1e-10 * SPEED.max())
        np.testing.assert_allclose(whirl_speed[own], alone[1], rtol=1e-8)
    assert np.any(growth > 0.1) and np.any(growth < -0.1)
