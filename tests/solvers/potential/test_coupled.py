"""Rotor and exact layers in time: closed forms, eigenvalues, budgets, the long waves as they get thin."""

from __future__ import annotations

import cmath
import math
from dataclasses import replace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import known_liquid
from fluid.whirl import plane_layer
from meshes.arrays import Array, Complex
from meshes.chamber import Chamber
from meshes.errors import InputError
from solvers.potential.coupled import Ended, ExactMachine, Powers, advance, breaking, coupled, ramp, shapes
from solvers.potential.steady import free
from solvers.potential.unsteady import answer, force, invariants, laid, levelled, rates, seen, started
from solvers.pypde import RotorLayersPDE, run
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.whirl.system import circles_of, coupled_matrices, linear_modes
from tests.mutants import kills
from tests.solvers.potential.test_unsteady import waved

RADIUS, HEIGHT, SPIN = 0.1, 0.02, 130.0


def filled(layer: float, plane: float = 0.0, radius: float = RADIUS) -> Fill:
    """A chamber with a layer of so much of its radius."""
    volume = math.pi * radius**2 * HEIGHT * layer * (2.0 - layer)
    return Fill(Chamber(radius, HEIGHT, plane=plane), known_liquid("water"), volume)


def jeffcott(damping: float = 0.0, unbalance: float = 0.0) -> Jeffcott:
    """A rotor with a natural frequency of 100 rad/s that is ten times as heavy as its full drum."""
    return Jeffcott(mass=6.0, stiffness=6.0e4, damping=damping, unbalance=unbalance)


def tilting() -> TwoPlane:
    """A rotor that turns about both axes across, on unlike bearings."""
    supports = Support(-0.15, 3e4, damping=8.0), Support(0.1, 2e4, damping=5.0)
    return TwoPlane(5.0, 0.05, 0.03, supports, (PlaneUnbalance(0.05, 2e-4, 0.4),))


def moving(machine: ExactMachine, size: float = 1e-3, height: float = 0.05) -> Array:
    """A state of no symmetry: rotor and waves."""
    state = machine.rest()
    parts = machine.parts(state)
    n = parts.place.size
    parts.place[:] = size * RADIUS * np.cos(1.0 + np.arange(n))
    parts.rate[:] = size * RADIUS * machine.unit * np.sin(2.0 + np.arange(n))
    u = 2.0 * math.pi * np.arange(machine.nodes) / machine.nodes
    for j, (layer, wave) in enumerate(zip(machine.layers, parts.waves, strict=True)):
        wave[: machine.nodes] *= 1.0 + height * np.cos(u + j) + 0.2 * height * np.sin(2.0 * u)
        wave[machine.nodes :] = 0.4 * height * layer.layer * np.sin(u - 0.4)
        wave[:] = levelled(wave, math.pi * layer.layer * (2.0 - layer.layer))
    return state


@kills("solvers.potential.unsteady:answer", "n**2)", "n)")
@kills("solvers.potential.unsteady:answer", "volume * np.eye(2) - moved", "volume * np.eye(2)")
@kills("solvers.potential.unsteady:_limited", "spectra[1:, 0] = 0.0", "spectra[2:, 0] = 0.0")
@kills("solvers.potential.unsteady:_wall_force", "-change", "change")
def test_force_and_rates_are_straight_lines_of_the_push() -> None:
    """Against the rates and the wall's pressure at a push; both are sums of 64 numbers of order 1."""
    for layer in (0.1, 0.3, 0.8):
        state = waved(layer).state
        found = answer(state)
        for push in (0j, 1 + 0j, 1j, -0.3 + 0.2j):
            along = np.array([push.real, push.imag])
            np.testing.assert_allclose(found.rates(push), rates(state, push), atol=1e-14)
            assert found.force + complex(*(found.response @ along)) == pytest.approx(
                force(state, push), abs=1e-13
            )


def test_the_response_of_a_uniform_layer() -> None:
    """V - pi a^2 tanh(ln(R/a)), of which both directions have the same [theory: potential, eq. 27]."""
    for layer in (0.05, 0.5, 0.9):
        hollow = (1.0 - layer) ** 2
        found = answer(laid(lambda angle, at=1.0 - layer: np.full(angle.shape, at), 32).state).response
        wanted = math.pi * (1.0 - hollow) - math.pi * hollow * (1.0 - hollow) / (1.0 + hollow)
        np.testing.assert_allclose(found, wanted * np.eye(2), atol=1e-14)


@kills("solvers.potential.unsteady:_momentum", "-2.0 * np.pi", "2.0 * np.pi")
def test_momentum_is_the_rate_of_the_moment() -> None:
    state, step = waved(0.3).state, 1e-3
    change = answer(state).rates(0.01j)
    ends = [answer(state + way * step * change).moment for way in (-1.0, 1.0)]
    # Central differences of second order: 1e-6 of a curvature of order 0.1.
    assert (ends[1] - ends[0]) / (2.0 * step) == pytest.approx(answer(state).momentum, abs=1e-7)
    assert answer(state).moment == pytest.approx(invariants(state).centre, abs=1e-15)


def test_a_state_is_seen_at_any_angle() -> None:
    """The area of the layer from its depth at even angles, and no circulation."""
    for layer in (0.1, 0.3):
        state, angles = waved(layer).state, 2.0 * math.pi * np.arange(256) / 256
        radius, velocity = seen(state, angles)
        area = math.pi * np.mean(1.0 - np.square(radius))
        assert area == pytest.approx(invariants(state).volume, rel=1e-13)
        assert np.mean(velocity) == pytest.approx(0.0, abs=1e-14)


def circled(deflection: complex, layer: float, count: int) -> Array:
    """Liquid at rest under a circle about the axis of rotation, which lies off the drum's by -deflection."""
    size, way = abs(deflection), cmath.phase(-deflection)

    def radius(angle: Array) -> Array:
        off = angle - way
        return np.asarray(size * np.cos(off) + np.sqrt((1.0 - layer) ** 2 - np.square(size * np.sin(off))))

    return laid(radius, count).state


@kills(
    "solvers.potential.coupled:ExactMachine.motion",
    "layer.plane.T @ inertia @ layer.plane",
    "0.9 * layer.plane.T @ inertia @ layer.plane",
)
@kills("solvers.potential.coupled:ExactMachine.motion", "scale * unit * found.force", "scale * found.force")
@kills(
    "solvers.potential.coupled:ExactMachine.motion",
    "speed * system.gyroscopic",
    "0.9 * speed * system.gyroscopic",
)
@pytest.mark.parametrize("layers", [(0.1, 0.3), (0.7, 0.9)])
def test_the_synchronous_motion_is_the_closed_form(layers: tuple[float, float]) -> None:
    """Circles of half the layers' depth: liquid is the mass of full drums, and nothing moves in the drums.

    Of half the air's radius where that is less: the drum's axis has to stay in the air.
    """
    fills = [filled(layers[0]), filled(layers[1], 0.06, 0.07)]
    rotor = tilting().system()
    full = [fill.liquid.density * math.pi * fill.chamber.radius**2 * HEIGHT for fill in fills]
    planes = [rotor.at(fill.chamber.plane) for fill in fills]
    mass = rotor.mass + sum(m * at.T @ at for m, at in zip(full, planes, strict=True))
    left = rotor.stiffness - SPIN**2 * mass + 1j * SPIN * (rotor.damping + SPIN * rotor.gyroscopic)
    motion = np.linalg.solve(left, SPIN**2 * rotor.unbalance)
    # All are circles along the spin, as the rotor is round: half of (x - iy) is nothing.
    circles = [complex(at[0] @ motion) for at in planes]
    room = [min(fill.depth, fill.chamber.radius - fill.depth) for fill in fills]
    share = 0.5 / max(abs(z) / most for z, most in zip(circles, room, strict=True))
    motion, rotor = share * motion, replace(rotor, unbalance=share * rotor.unbalance)
    machine = coupled(rotor, fills, ramp(SPIN), nodes=128)
    state = machine.rest()
    parts = machine.parts(state)
    parts.place[:], parts.rate[:] = motion.real, (1j * SPIN * motion).real
    for wave, fill, z in zip(parts.waves, fills, circles, strict=True):
        wave[:] = circled(share * z / fill.chamber.radius, fill.depth / fill.chamber.radius, 128)
    change = machine.parts(machine.rates(0.0, state))
    size = SPIN**2 * np.abs(parts.place).max()
    np.testing.assert_allclose(change.rate, -(SPIN**2) * parts.place, atol=1e-12 * size)
    assert np.abs(change.waves).max() < 1e-13 * SPIN
    # It stays so over a turn, to the steps' tolerance.
    end = machine.parts(advance(machine, state, (0.0, 2.0 * math.pi / SPIN)).state)
    np.testing.assert_allclose(end.place, parts.place, atol=1e-9 * np.abs(parts.place).max())


def modes(fills: list[Fill], rotor: RotorSystem, rate: float) -> Complex:
    """Exponents of small motions of linear theory with a body force, seen from the drum, 1/s."""
    layers = []
    for fill in fills:
        layer = plane_layer(fill, Friction(FrictionLaw.NONE))
        assert layer is not None
        layers.append((fill.chamber.plane, replace(layer, rate=rate)))
    found = linear_modes(coupled_matrices(rotor, layers, np.array([SPIN])), circles_of(rotor, layers))
    root, sense = found.root[0], found.sense[0]
    # Each whirl stands with its conjugate, which goes the other way round.
    half = root.imag > 0.0
    return root[half].real + 1j * (sense * root.imag)[half] - 1j * SPIN


def jacobian(machine: ExactMachine) -> Complex:
    """Exponents of small motions of a planar machine, the rotor seen from the drum as the waves are."""
    rest, size = machine.rest(), 1e-6
    keep = np.r_[0:4, 6 : rest.size]
    scale = np.where(np.arange(rest.size) < 2, RADIUS, 1.0)
    scale[2:4] *= RADIUS * machine.unit

    def change(state: Array) -> Array:
        found = machine.rates(0.0, state)
        for part in (slice(0, 2), slice(2, 4)):
            x, y = state[part]
            found[part] += machine.unit * np.array([y, -x])
        return found[keep] / scale[keep]

    table = []
    for k in keep.tolist():
        bump = np.zeros(rest.size)
        bump[k] = size * scale[k]
        table.append((change(rest + bump) - change(rest - bump)) / (2.0 * size))
    return np.asarray(np.linalg.eigvals(np.array(table).T))


@kills(
    "solvers.potential.coupled:ExactMachine.rates", "cmath.exp(-1j * angle)", "cmath.exp(-1j * angle) * 1.01"
)
@kills("solvers.potential.unsteady:_limited", "-= friction * flow", "-= 0.9 * friction * flow")
@kills("solvers.potential.coupled:ExactMachine.motion", "+ dragged", "- dragged")
def test_small_motions_are_linear_theory() -> None:
    """Rotor and both free waves, growth and frequency; central differences of 1e-6 leave 1e-9."""
    rotor = jeffcott(damping=20.0).system()
    for layer, rate in ((0.1, 0.0), (0.1, 3.0), (0.6, 3.0), (0.7, 0.0), (0.9, 3.0)):
        wanted = modes([filled(layer)], rotor, rate)
        found = jacobian(coupled(rotor, [filled(layer)], ramp(SPIN), friction=[rate], nodes=16))
        assert wanted.size == 4
        assert (wanted.real.max() > 2.0) == (layer == 0.1)  # inside the band
        for value in wanted:
            assert np.abs(found - value).min() < 1e-7 * SPIN, (layer, rate, value)


def test_a_kick_grows_as_linear_theory_has_it() -> None:
    """In time: the four motions keep their shares, by growth and speed of linear theory."""
    fill, rotor, turn = filled(0.1), jeffcott(damping=20.0).system(), 2.0 * math.pi / SPIN
    machine = coupled(rotor, [fill], ramp(SPIN), nodes=32)
    values, state = modes([fill], rotor, 0.0), machine.rest()
    state[:2] = 1e-6 * RADIUS, 0.0
    course = advance(machine, state, (0.0, 12.0 * turn))
    place = course.place @ np.array([1.0, 1j])
    every = np.exp(np.outer(course.time, values + 1j * SPIN))
    size, *_ = np.linalg.lstsq(every, place, rcond=None)
    # Waves of 1e-4 of the layer leave 1e-8 of the second order in time, the steps as much.
    assert np.abs(every @ size - place).max() < 1e-6 * np.abs(place).max()
    assert np.abs(place[-1]) > 5.0 * np.abs(place[0])
    for k in range(4):
        if abs(size[k]) < 0.01 * np.abs(size).max():
            continue
        # A growth or a speed that is off by 1e-4 of the spin does not fit.
        other = values.copy()
        other[k] *= 1.0 + 1e-4
        every = np.exp(np.outer(course.time, other + 1j * SPIN))
        size_then, *_ = np.linalg.lstsq(every, place, rcond=None)
        assert np.abs(every @ size_then - place).max() > 1e-6 * np.abs(place).max()


@pytest.mark.parametrize(
    ("name", "layers"), [("jeffcott", (0.3, 0.5)), ("two_plane", (0.3, 0.5)), ("jeffcott", (0.7, 0.9))]
)
def test_energy_is_kept(name: str, layers: tuple[float, float]) -> None:
    """Without damping, unbalance and gravity, waves of a tenth: over three turns, to the steps' tolerance."""
    rotor = jeffcott().system() if name == "jeffcott" else replace(
        tilting().system(), damping=np.zeros((4, 4)), unbalance=np.zeros(4, dtype=complex)
    )  # fmt: skip
    fills = [filled(layers[0]), filled(layers[1], 0.12, 0.07)]
    machine = coupled(rotor, fills, ramp(SPIN), nodes=64)
    # Deep layers have little air, which waves as high would leave no room.
    begin = moving(machine) if layers[0] < 0.5 else moving(machine, 1e-4, 2e-3)
    course = advance(machine, begin, (0.0, 6.0 * math.pi / SPIN))
    assert course.ended is Ended.DONE
    first, last = machine.energy(begin), machine.energy(course.state)
    moved = machine.energy(begin) - machine.energy(machine.rest())
    assert abs(last - first) < 2e-8 * abs(moved)
    if name == "jeffcott":
        spun = [_angular_momentum(machine, state) for state in (machine.rest(), begin, course.state)]
        assert abs(spun[2] - spun[1]) < 1e-8 * abs(spun[1] - spun[0])


def _angular_momentum(machine: ExactMachine, state: Array) -> float:
    """Of a planar machine about the axis at rest, kg m^2/s: nothing turns it when its support is round."""
    parts = machine.parts(state)
    z, v = (complex(*part) for part in (parts.place, parts.rate))
    found = machine.system.mass[0, 0] * (z.conjugate() * v).imag
    for layer, (angle, _), wave in zip(machine.layers, parts.turned.tolist(), parts.waves, strict=True):
        liquid, turn = answer(wave), cmath.exp(1j * angle)
        scale = layer.weight * layer.radius**3
        moment = scale * turn * liquid.moment
        relative = scale * machine.unit * turn * (liquid.momentum + 1j * liquid.moment)
        found += layer.mass * (z.conjugate() * v).imag
        found += (z.conjugate() * relative).imag + (moment.conjugate() * v).imag
        found += layer.weight * layer.radius**4 * machine.unit * invariants(wave).angular_momentum
    return found


def gained(powers: Powers) -> float:
    """Rate of change of the energy: what is brought less what is taken."""
    return powers.unbalance + powers.gravity + powers.drive - powers.support - powers.friction


@kills("solvers.potential.coupled:ExactMachine.powers", "lag**2 * inertia", "lag * inertia")
@kills(
    "solvers.potential.coupled:ExactMachine.rates", "layer.friction * (speed - own)", "layer.friction * speed"
)
@kills("solvers.potential.coupled:ExactMachine.motion", "speed**2 - 1j * rate", "speed**2 + 1j * rate")
@kills(
    "solvers.potential.coupled:ExactMachine.motion", "- layer.mass * weight", "- 0.9 * layer.mass * weight"
)
@pytest.mark.parametrize("layers", [(0.3, 0.5), (0.7, 0.9)])
def test_the_energy_budget_closes(layers: tuple[float, float]) -> None:
    """All at once: unbalance, gravity, a spin that rises, friction, damping, two unlike layers."""
    fills = [filled(layers[0]), filled(layers[1], 0.12, 0.07)]
    machine = coupled(
        tilting().system(), fills, ramp(SPIN, 900.0), friction=[5.0, 9.0], gravity=-9.81 + 2.0j, nodes=64
    )
    height = 0.05 if layers[0] < 0.5 else 0.01
    course = advance(machine, moving(machine, height=height), (0.0, 0.03))
    assert course.ended is Ended.DONE
    begin = course.state
    step, time = 1e-4, 0.03
    energy, gain = [machine.energy(begin)], [gained(machine.powers(time, begin))]
    for _ in range(4):
        begin = advance(machine, begin, (time, time + step)).state
        time += step
        energy.append(machine.energy(begin))
        gain.append(gained(machine.powers(time, begin)))
    slope = np.array([1.0, -8.0, 0.0, 8.0, -1.0]) @ np.array(energy) / (12.0 * step)
    # Differences of fourth order of (130 * 1e-4)^4 / 30 and of rounding of 1e-13/1e-4.
    assert slope == pytest.approx(gain[2], rel=1e-7)
    assert machine.parts(begin).turned[0, 1] > SPIN * 1.005


def test_a_changing_spin_leaves_liquid_without_friction_alone() -> None:
    """The wall is a circle: an even layer stays where it was, whatever the drum does."""
    machine = coupled(jeffcott().system(), [filled(0.2)], ramp(SPIN, 2000.0), nodes=16)
    end = machine.parts(advance(machine, machine.rest(), (0.0, 0.1)).state)
    np.testing.assert_allclose(end.waves, machine.parts(machine.rest()).waves, atol=1e-15)
    assert end.turned[0] == pytest.approx((SPIN * 0.1, SPIN), rel=1e-14)


@kills("solvers.potential.coupled:ExactMachine.rates", "self.gravity - complex", "complex")
def test_gravity_across_the_axis() -> None:
    """Liquid of a lying drum hangs back, at rest in space: d = -q g/(Omega^2 (1 + T) + i k Omega)."""
    layer, rate, gravity = 0.1, 0.3 * SPIN, -1e-3 * SPIN**2 * RADIUS
    heavy = Jeffcott(mass=1e4, stiffness=1e4 * (5.0 * SPIN) ** 2, damping=1e7, unbalance=0.0)
    machine = coupled(heavy.system(), [filled(layer)], ramp(SPIN), friction=[rate], gravity=gravity, nodes=16)
    # Waves die at about k/2: e^-18 is left.
    end = advance(machine, machine.rest(), (0.0, 120.0 / SPIN)).state
    parts = machine.parts(end)
    found = answer(parts.waves[0])
    volume = math.pi * layer * (2.0 - layer)
    offset = RADIUS * found.moment * cmath.exp(1j * parts.turned[0, 0]) / volume
    tanh = layer * (2.0 - layer) / (1.0 + (1.0 - layer) ** 2)
    wanted = -0.5 * (1.0 - tanh) * gravity / (SPIN**2 * (1.0 + tanh) + 1j * rate * SPIN)
    # The next term goes with (g/Omega^2 h_0)^2, 1e-4 times a tenth.
    assert offset == pytest.approx(wanted, rel=2e-5)


def test_bad_machines() -> None:
    rotor = jeffcott().system()
    with pytest.raises(InputError, match="friction"):
        coupled(rotor, [filled(0.1)], ramp(SPIN), friction=[1.0, 2.0])
    with pytest.raises(InputError, match="friction"):
        coupled(rotor, [filled(0.1)], ramp(SPIN), friction=[-1.0])
    with pytest.raises(InputError, match="spin"):
        coupled(rotor, [filled(0.1)], ramp(0.0))


def test_full_and_empty_chambers() -> None:
    """A full one is a mass, an empty one nothing: the rotor alone, exactly."""
    empty = Fill(Chamber(RADIUS, HEIGHT), known_liquid("water"), 0.0)
    full = Fill(Chamber(RADIUS, HEIGHT), known_liquid("water"), Chamber(RADIUS, HEIGHT).capacity)
    machine = coupled(jeffcott().system(), [empty, full], ramp(SPIN))
    assert machine.layers == ()
    assert machine.system.mass[0, 0] == pytest.approx(6.0 + full.mass)
    state, mass = machine.rest(), 6.0 + full.mass
    state[0] = 1e-3
    end = advance(machine, state, (0.0, 0.1)).place[-1]
    assert end[0] == pytest.approx(1e-3 * math.cos(0.1 * math.sqrt(6e4 / mass)), abs=1e-11)


def test_a_wave_that_breaks_ends_the_course() -> None:
    machine = coupled(jeffcott().system(), [filled(0.1)], ramp(SPIN), nodes=64)
    state = machine.rest()
    state[2] = 0.05 * RADIUS * SPIN
    course = advance(machine, state, (0.0, 20.0 * math.pi / SPIN))
    assert course.ended in (Ended.BROKE, Ended.NODES)
    assert course.time[-1] < 20.0 * math.pi / SPIN


def test_what_breaks_is_told_from_what_wants_nodes(monkeypatch: pytest.MonkeyPatch) -> None:
    """By the liquid's speed at the crest over that of a steady wave, which is 1 - q R/r."""
    machine, wave = coupled(jeffcott().system(), [filled(0.3)], ramp(SPIN), nodes=256), free(0.3, 1.25)
    state = machine.rest()
    machine.parts(state).waves[0] = started(wave, wave.slip_speeds()[1], 256).state
    (now,) = shapes(machine, 0.0, state)
    wanted = 1.0 - wave.crest_speed / (1.0 - wave.crest * 0.3)
    assert now.crest_number == pytest.approx(wanted, rel=1e-5)
    for limit, breaks in ((0.99, False), (1.01, True)):
        monkeypatch.setattr("solvers.potential.coupled.BREAKING", wanted / limit)
        assert breaking(machine, 0.0, state) == breaks


@pytest.mark.slow
def test_long_waves_come_near_with_the_depth_squared() -> None:
    """Small whirls after four turns, long waves without their cells' error of second order."""
    rotor, turn, gaps = jeffcott(damping=20.0).system(), 2.0 * math.pi / SPIN, []
    for layer in (0.1, 0.05, 0.025):
        fill, begin = filled(layer), np.array([0.01 * layer * RADIUS, 0.0])
        machine = coupled(rotor, [fill], ramp(SPIN), nodes=32)
        state = machine.rest()
        state[:2] = begin
        exact = advance(machine, state, (0.0, 4.0 * turn)).place[-1]
        found = []
        for cells in (64, 128):
            equation = RotorLayersPDE(rotor, [fill], SPIN)
            moment = equation.start(cells, begin, np.zeros(2))
            moment, _ = run(equation, moment, (0.0, 4.0 * turn), (), solver="coupled")
            found.append(equation.parts(moment)[2])
        long = found[1] + (found[1] - found[0]) / 3.0
        gaps.append(np.linalg.norm(long - exact) / np.linalg.norm(exact))
    # 1.06e-3, 2.3e-4 and 6e-5.
    assert gaps[0] < 1.5e-3
    assert gaps[2] < gaps[1] / 3.0 < gaps[0] / 9.0
