"""Seeded faults of the coupled time step, and their oracles, run as plain Python by `test_uncompiled.py`."""

from __future__ import annotations

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import Friction
from fluid.friction.wall import NO_TABLE
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.layer import finite_volume
from solvers.layer.drag import friction_of
from solvers.layer.inside import NOTHING, Inside
from solvers.layer.records import Outcome, records
from solvers.layer.state import ring
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import RotorSystem
from solvers.runup.long_wave import Coupled, couple
from solvers.runup.state import GAINS, LAYER, MEASURES, PACE, SHAFT
from solvers.runup.steps import coupled as coupled_parts
from solvers.runup.steps import layer as coupled_layer
from solvers.runup.steps.spin import driven, motor_torque
from tests.mutants import kills

SPIN, TURNED = 2.0, 0.4
FILL = Fill(Chamber(0.25, 0.04), Liquid("water", 1000.0, 1e-6), 2e-3)


def state(n: int) -> tuple[np.ndarray, np.ndarray]:
    theta = 2.0 * np.pi * (np.arange(n) + 0.5) / n
    area = 0.1 + 0.02 * np.cos(theta) + 0.01 * np.sin(2.0 * theta)
    velocity = 0.3 + 0.2 * np.sin(theta) + 0.1 * np.cos(theta)
    return area, velocity * area - SPIN * area**2


def measured(area: np.ndarray, q: np.ndarray) -> np.record:
    out = records(MEASURES)[0]
    spare = coupled_layer.layer_scratch(1, area.size)[0]
    coupled_layer.measure(area, q, SPIN, ring(area.size), NOTHING.plates, spare, out)
    return out


def rates(area: np.ndarray, q: np.ndarray, push: complex = 0j) -> tuple[np.ndarray, np.ndarray]:
    n = area.size
    angles, step = ring(n), 2.0 * np.pi / n
    d_area, d_q = np.empty(n), np.empty(n)
    work = np.zeros((finite_volume.WORK, n + 2 * finite_volume.GHOSTS))
    cell, face = (push.real * angles[k] + push.imag * angles[k + 1] for k in (0, 2))
    none = np.empty(0)
    finite_volume.rates(
        *(area, q, none, SPIN, 0.0, cell, face, *NOTHING, step, 0.0, False, work, d_area, d_q, none)
    )
    return d_area, d_q


@kills("solvers.layer.step:profile", "= faded_velocity(area[i], q[i], spin)", "= 0.0")
@kills("solvers.runup.steps.layer:_moments", "moment_y += lever * sine[i]", "moment_y += lever * cosine[i]")
@kills("solvers.runup.steps.layer:_moments", "area[i] * (1.0 - area[i]), q[i]", "area[i], q[i]")
@kills("solvers.runup.steps.layer:_moments", "0.5 * spin * spin * whole", "spin * spin * whole")
@kills("solvers.runup.steps.layer:_moments", "+ 0.5 * u * u * log[i]", "+ 0.5 * u * u * area[i]")
@kills("solvers.runup.steps.layer:_flows", "flow_x += flow * x", "flow_x -= flow * x")
@kills("solvers.runup.steps.layer:_flows", "xy += log[i] * x * y", "xy -= log[i] * x * y")
@kills("solvers.runup.steps.layer:measure_profile", "across[0], along[0],", "across[0], across[0],")
def test_measures() -> None:
    """Moment, angular momentum and energy by quadrature over the depth; rates of change by the volumes'."""
    n = 96
    area, q = state(n)
    out = measured(area, q)
    theta = 2.0 * np.pi * (np.arange(n) + 0.5) / n
    surface = np.sqrt(1.0 - 2.0 * area)
    u = q / area + SPIN * area
    node, weight = np.polynomial.legendre.leggauss(12)
    radius = 0.5 * (1.0 + surface + np.outer(node, 1.0 - surface))
    each = np.outer(weight, 0.5 * (1.0 - surface)) * (2.0 * np.pi / n)
    # Cells hold means of a smooth state: rectangles are exact to rounding.
    moment = np.sum(each * radius**2 * np.exp(1j * theta))
    turning = SPIN * radius + u / radius
    assert complex(out.moment_x, out.moment_y) == pytest.approx(moment, rel=1e-10)
    assert out.spinning == pytest.approx(np.sum(each * radius**2 * turning), rel=1e-10)
    assert out.energy == pytest.approx(np.sum(each * radius * 0.5 * turning**2), rel=1e-10)
    d_area, d_q = rates(area, q)
    moved = np.sum(surface * np.exp(1j * theta) * d_area) * 2.0 * np.pi / n
    # Second order: some (2 pi/96)^2 of the size.
    assert complex(out.flow_x, out.flow_y) == pytest.approx(moved, abs=1e-2 * abs(moved))
    # Inertia: how a push changes the flow's rate.
    tiny = 1e-4
    for push in (1.0, 1.0j):
        pushed = rates(area, q, tiny * push)[1]
        later = measured(area, q + (pushed - d_q))
        flow = complex(later.flow_x - out.flow_x, later.flow_y - out.flow_y) / tiny
        xx, xy, yy = out.xx, out.xy, out.yy
        wanted = xx * push.real + xy * push.imag + 1j * (xy * push.real + yy * push.imag)
        assert abs(flow - wanted) < 2e-2 * abs(wanted)


def layer_run(law: int, push: complex, n: int = 32) -> tuple[np.ndarray, np.ndarray, np.record]:
    area, q = state(n)
    gains, spare = records(GAINS)[0], coupled_layer.layer_scratch(1, n)[0]
    there = push * np.exp(-1j * SPIN * 0.02)
    layer = records(LAYER)[0]
    layer.law, layer.coefficient = law, 0.5
    status, _ = coupled_layer.layer_step(
        *(finite_volume.rates, friction_of(law), area, q, area[:0], np.array([SPIN, SPIN])),
        np.array([push.real, push.imag, there.real, there.imag]),
        *(layer, layer.coefficient, 0.0, NO_TABLE, 0.02, ring(n), *NOTHING, spare, gains),
    )
    assert status == Outcome.DONE
    return area, q, gains


@kills("solvers.runup.steps.layer:_rub", "(0.5 * spin * area", "(spin * area")
@kills(
    "solvers.runup.steps.layer:_rub",
    "before += still + spin * (held[i] - q[i]) + lost",
    "before += still + lost",
)
@kills("solvers.runup.steps.layer:_power", "rate_y + spin * moment_x", "rate_y - spin * moment_x")
@kills("solvers.runup.steps.layer:_rub", "torque += q[i] - held[i]", "torque += q[i]")
@kills("solvers.runup.steps.layer:_rub", "lost = 0.5 * log[i]", "lost = log[i]")
@kills("solvers.runup.steps.layer:_half_friction", "(0.5 * dt, kept", "(dt, kept")
@kills("solvers.runup.steps.layer:_half_friction", "decelerate(area, q, spin, kept, pushed)", "pass")
@kills("solvers.runup.steps.layer:layer_step", "gains.loss -= energy + gains.missed", "gains.loss += energy")
def test_layer_gains() -> None:
    """Wall torque and heat are what the angular momentum and the energy lose; the rest is small."""
    push = 0.3 + 0.2j
    for law in (0, 1):
        area, q, gains = layer_run(law, push)
        before, after = measured(*state(32)), measured(area, q)
        # The push's torque about the axis, by the mean moment, and its work.
        middle = push * np.exp(-1j * SPIN * 0.01)
        moment = 0.5 * complex(before.moment_x + after.moment_x, before.moment_y + after.moment_y)
        flow = 0.5 * complex(before.flow_x + after.flow_x, before.flow_y + after.flow_y)
        torque = (moment.conjugate() * middle).imag * 0.02
        work = (middle.conjugate() * (flow + 1j * SPIN * moment)).real * 0.02
        # Means of the ends for means over the step, and the volumes' own error at 32 cells.
        assert after.spinning - before.spinning - torque == pytest.approx(gains.torque, abs=1e-5)
        left = work + SPIN * gains.torque - gains.heat - gains.loss - (after.energy - before.energy)
        assert abs(left) < 1e-5
        assert abs(gains.loss) < 1e-4
        assert (gains.heat > 1e-4) == (law > 0)
        if law > 0:
            velocity = q / area + SPIN * area
            shear = 0.5 * (1.0 - np.sqrt(1.0 - 2.0 * area)) * velocity
            assert -gains.torque == pytest.approx(np.sum(shear) * 2.0 * np.pi / 32 * 0.02, rel=0.02)
            log = -0.5 * np.log(1.0 - 2.0 * area)
            heat = np.sum(shear * velocity * log / area) * 2.0 * np.pi / 32 * 0.02
            assert gains.heat == pytest.approx(heat, rel=0.02)


@kills("solvers.layer.step:calm", "-most), most)", "-most), 2.0 * most)")
@kills("solvers.layer.step:calm", "(u - spin * a) * a", "u * a")
@kills("solvers.layer.step:calm", "a < THIN else", "a < 0.5 * THIN else")
@kills("solvers.layer.step:calm", "gained += now - q[i]", "gained += now")
def test_calm() -> None:
    """Films stick to the wall, the thinner the more, and none runs away; layers are not touched."""
    area, q = np.array([1e-6, 1e-6, 8e-6, 0.1]), np.array([1.0, 1e-7, 1e-7, 5.0])
    from solvers.layer.step import FASTEST, calm

    given = q / area + SPIN * area
    lost = calm(area, q, SPIN)
    assert lost == pytest.approx(np.sum((q / area - given + SPIN * area) * area), rel=1e-12)
    velocity = q / area + SPIN * area
    assert velocity[0] == pytest.approx(FASTEST * SPIN)
    # By hand, 2 u a^2/(a^2 + 1e-10); rounding of the square alone is in the way.
    share = 2.0 * area**2 / (area**2 + 1e-10)
    np.testing.assert_allclose(velocity[1:3], (share * given)[1:3], rtol=1e-12)
    assert 0.0 < share[1] < 0.02 and 0.7 < share[2] < 0.8
    assert q[3] == 5.0


def machine(cells: int, gravity: float = 0.0, rate: float = 0.5) -> Coupled:
    rotor = Jeffcott(3.0, 3.0 * 15.0**2, 6.0, 4e-3)
    found = couple(rotor.system(), [FILL], 30.0, Friction("linear", rate), gravity, cells, False)
    found.state.place[:] = 2e-3, -1e-3
    found.state.rate[:] = 0.05, 0.02
    return found


def momentum(found: Coupled) -> np.ndarray:
    velocity = found.state.rate[:]
    total = found.system.mass @ velocity
    for one, plane, _, relative in found.measured():
        total = total + plane.T @ (one.mass * plane @ velocity + relative)
    turn = np.exp(1j * found.state.shaft[0].angle)
    return total + (1j * found.spin * found.system.unbalance * turn).real


@kills(
    "solvers.runup.steps.coupled:load_rotor",
    "spins[0] * first - spins[1] * last",
    "spins[1] * last - spins[0] * first",
)
@kills(
    "solvers.runup.steps.coupled:load_rotor",
    "left[i, k] += (mass - xx) * b[0, i] * b[0, k]",
    "left[i, k] += (mass + xx) * b[0, i] * b[0, k]",
)
@kills(
    "solvers.runup.steps.coupled:load_rotor", "right[i] -= b[0, i] * given_x", "right[i] += b[0, i] * given_x"
)
@kills(
    "solvers.runup.steps.coupled:advance",
    "shaft.angle += 0.5 * (spins[0] + spins[1]) * dt",
    "shaft.angle += spins[1] * dt",
)
def test_momentum() -> None:
    """Momentum of a machine without support stays to rounding: rotor, liquid and unbalance."""
    rotor = Jeffcott(3.0, 1e-15, 0.0, 4e-3)
    free = couple(rotor.system(), [FILL], 30.0, Friction("linear", 0.5), 0.0, 12, False)
    free.state.rate[:] = 0.05, 0.02
    before = momentum(free)
    assert free.advance(0.05, 20.0, 0.4, 1000) == Outcome.DONE
    np.testing.assert_allclose(momentum(free), before, atol=1e-13)


@kills(
    "solvers.runup.steps.layer:relative_momentum", "- spin * measures.moment_y", "+ spin * measures.moment_y"
)
@kills(
    "solvers.runup.steps.layer:relative_momentum",
    "scale * (x * sine + y * cosine)",
    "scale * (y * cosine - x * sine)",
)
@kills(
    "solvers.runup.steps.coupled:_tally", "sums.drive += scale * gain.work", "sums.drive -= scale * gain.work"
)
@kills("solvers.runup.steps.coupled:_tally", "sums.friction += scale", "sums.friction -= scale")
@kills("solvers.runup.long_wave:Coupled.energy", "0.5 * layer.mass * rate @ rate + momentum", "momentum")
@kills(
    "solvers.runup.steps.coupled:advance",
    "gravity[0] - guess[j, 0]",
    "gravity[0] + guess[j, 0]",
)
def test_energy() -> None:
    """The remainder of the energy balance goes down with the square of the step and the cell."""
    left = []
    for cells in (6, 12):
        found = machine(cells, 0.5)
        before = found.energy()
        assert found.advance(0.05, 20.0, 0.4, 1000) == Outcome.DONE
        s = found.sums
        gained = s.unbalance + s.drive + s.gravity
        lost = s.support + s.friction + s.lost + s.profile
        left.append(abs(gained - lost - (found.energy() - before)) / abs(s.unbalance))
    assert left[1] < 2e-2
    assert left[1] < 0.35 * left[0]


@kills("solvers.runup.steps.layer:_power", "missed += velocity", "missed -= velocity")
@kills(
    "solvers.runup.steps.coupled:_tally",
    "sums.unbalance -= swing[i] * mean",
    "sums.unbalance += swing[i] * mean",
)
@kills("solvers.runup.steps.coupled:_lowered", "- begin.moment_x * turn[0]", "+ begin.moment_x * turn[0]")
@kills("solvers.runup.steps.coupled:_tally", "dt * mean * matrices[1, i, k]", "mean * matrices[1, i, k]")
def test_tallies() -> None:
    """Works and heats are the integrals of their powers over what is sampled."""
    found = machine(12, 0.5)
    times = np.linspace(0.0, 0.04, 17)
    rows, offset = [], []
    for stop in times:
        if stop > 0.0:
            assert found.advance(stop, 20.0, 0.4, 1000) == Outcome.DONE
        v, angle = found.state.rate[:].copy(), found.state.shaft[0].angle
        force = ((found.spin**2 - 20j) * found.system.unbalance * np.exp(1j * angle)).real
        rows.append((force @ v, v @ found.system.damping @ v))
        offset.append(found.read().offset[0])
    wanted = np.trapezoid(np.array(rows).T, times)
    s = found.sums
    # The weight on the way of the centre of mass.
    lowered = FILL.mass * complex(*found.machine.gravity).conjugate() * (offset[-1] - offset[0])
    assert s.gravity == pytest.approx(lowered.real, rel=1e-10) and s.gravity != 0.0
    for name, value in zip(("unbalance", "support"), wanted, strict=True):
        # The trapezium over 17 points of a fifth of a turn.
        assert s[name] == pytest.approx(value, rel=5e-3, abs=1e-6)
    # The drive lifts the liquid's angular momentum against what the accelerations take.
    assert s.friction > 0.0
    assert s.profile < 0.0


@kills("solvers.runup.steps.layer:layer_step", "force[2 * stage], force[2 * stage + 1]", "force[0], force[1]")
@kills("solvers.runup.steps.coupled:load_rotor", "stiffness * (x + 0.5 * dt * v)", "stiffness * x")
@kills(
    "solvers.runup.steps.coupled:advance",
    "dt * (rate[i] + 0.5 * change[i])",
    "dt * rate[i]",
)
def test_order() -> None:
    """Halving the step leaves a quarter of the error."""
    ends = []
    for courant in (0.4, 0.2, 0.1):
        found = machine(8)
        assert found.advance(0.03, 20.0, courant, 4000) == Outcome.DONE
        ends.append(complex(*found.state.place[:]))
    ratio = abs(ends[0] - ends[1]) / abs(ends[1] - ends[2])
    assert 3.0 < ratio < 5.5


@kills("solvers.runup.steps.coupled:load_rotor", "spin * matrices[2, i, k]", "matrices[2, i, k]")
@kills("solvers.runup.steps.coupled:load_rotor", "0.25 * dt * dt * stiffness", "0.5 * dt * dt * stiffness")
def test_gyroscope() -> None:
    """A turn with gyroscopic coupling keeps the energy, and precesses as it must."""
    one, cross = np.eye(2), np.array([[0.0, 1.0], [-1.0, 0.0]])
    system = RotorSystem(
        ("a", "b"), one, 0.0 * one, 0.5 * cross, 9.0 * one, np.zeros(2, dtype=complex), one, 0.0 * one
    )
    found = couple(system, [], 4.0, Friction(), 0.0, 400, False)
    found.state.place[0] = 1.0
    assert found.advance(0.5, 0.0, 0.8, 1000) == Outcome.DONE
    # z'' - 2i z' + 9 z = 0 with Omega G = 2: z'' + 2 (y', -x') + 9 z = 0.
    roots = np.roots([1.0, -2j, 9.0])
    weights = np.linalg.solve(np.array([[1.0, 1.0], roots]), np.array([1.0, 0.0]))
    wanted = weights @ np.exp(roots * 0.5)
    assert complex(*found.state.place[:]) == pytest.approx(wanted, abs=2e-4)
    # The trapezium keeps the energy of what has no damping.
    assert found.energy() == pytest.approx(4.5, rel=1e-12)


@kills(
    "solvers.runup.steps.spin:free_spin",
    "load -= change[i] * 0.5",
    "load += change[i] * 0.5",
)
@kills(
    "solvers.runup.steps.spin:free_spin",
    "layers[j].radius ** 4 * gains[j].torque",
    "layers[j].radius ** 3 * gains[j].torque",
)
@kills("solvers.runup.steps.spin:driven", "shaft.spin - load * weight", "shaft.spin + load * weight")
@kills("solvers.runup.steps.spin:motor_power", "spin * motor_torque", "motor_torque")
def test_motor() -> None:
    """The motor's torque goes into the spin, less what the unbalance and the liquid take."""
    rotor = Jeffcott(3.0, 3.0 * 15.0**2, 6.0, 0.05)
    found = couple(rotor.system(), [FILL], 30.0, Friction("linear", 0.5), 0.0, 12, False)
    found.state.place[:] = 2e-3, -1e-3
    found.state.rate[:] = 0.05, 0.02
    curve = np.array([[0.0, 40.0, 80.0], [6.0, 2.0, 0.0]])
    found.drive(curve, 0.05)
    wall = 1000.0 * 0.04 * 0.25**4

    def turning() -> float:
        """Spin's own momentum, with the unbalance's share and the liquid's."""
        v, angle = found.state.rate[:], found.state.shaft[0].angle
        cross = v @ (1j * found.system.unbalance * np.exp(1j * angle)).real
        return 0.05 * found.spin + cross

    before = turning()
    spins, forces, walls = [], [], []
    times = np.linspace(0.0, 0.02, 17)
    for stop in times:
        if stop > 0.0:
            assert found.advance(stop, 0.0, 0.4, 2000) == Outcome.DONE
        v, angle = found.state.rate[:], found.state.shaft[0].angle
        # d/dt of the share: v' . Re(iU e) and v . Re(-Omega U e); the latter is no torque.
        forces.append(-found.spin * v @ (found.system.unbalance * np.exp(1j * angle)).real)
        surface = np.sqrt(1.0 - 2.0 * found.area[0])
        velocity = found.momentum[0] / found.area[0] + found.spin * found.area[0]
        walls.append(-wall * np.mean(0.5 * (1.0 - surface) * velocity) * 2.0 * np.pi)
        spins.append(found.spin)
    torque = np.interp(spins, curve[0], curve[1])
    wanted = np.trapezoid(torque + np.array(forces) - np.array(walls), times)
    assert turning() - before == pytest.approx(wanted, rel=2e-3)
    work = np.trapezoid(torque * np.array(spins), times)
    assert found.sums.motor == pytest.approx(work, rel=1e-4)


@kills("solvers.runup.state:at_rest", "np.array([-gravity, 0.0])", "np.array([gravity, 0.0])")
@kills(
    "solvers.runup.steps.coupled:advance",
    "x * cosine + y * sine, y * cosine - x * sine",
    "x * cosine - y * sine, y * cosine + x * sine",
)
def test_gravity() -> None:
    """The rotor held, liquid let go is pulled against the first direction by its flow's inertia."""
    rotor = Jeffcott(3.0, 1e15, 0.0, 0.0)
    found = couple(rotor.system(), [FILL], 30.0, Friction(), 0.5, 24, False)
    found.state.shaft[0].angle = TURNED
    inertia = found.measured()[0][2].xx * 40.0 * 0.25**2
    assert found.advance(0.001, 0.0, 0.8, 100) == Outcome.DONE
    relative = found.measured()[0][3]
    # In a millisecond the drum turns by 0.03: waves and turning take that much of it.
    assert relative[0] == pytest.approx(-0.5 * 0.001 * inertia, rel=0.05)
    assert abs(relative[1]) < 0.1 * abs(relative[0])


@kills("solvers.runup.steps.coupled:advance", "root = np.sqrt(", "root = (")
@kills(
    "solvers.runup.long_wave:couple",
    "momentum=-spin * np.square(area)",
    "momentum=spin * np.square(area)",
)
@kills(
    "solvers.runup.state:layer_properties",
    "lid = 2.0 * chamber.radius / chamber.height",
    "lid = chamber.radius / chamber.height",
)
@kills("fluid.friction.laws:Friction.at", "frequency)) / radius", "frequency))")
def test_stokes() -> None:
    """Stokes' friction takes the frequency of the slower free wave, with floor and lid."""
    viscous = Fill(FILL.chamber, Liquid("oil", 1000.0, 1e-3), FILL.volume)
    rotor = Jeffcott(3.0, 1e15, 0.0, 0.0)
    found = couple(rotor.system(), [viscous], 30.0, Friction("stokes"), 0.0, 8, False)
    found.momentum[0] += 0.2 * found.area[0]
    found.state.momentum[:] = found.momentum
    assert found.advance(0.2, 0.0, 0.8, 1000) == Outcome.DONE
    velocity = found.momentum[0] / found.area[0] + 30.0 * found.area[0]
    log = math.log(0.25 / viscous.surface_radius)
    t = math.tanh(log)
    slip = 30.0 * (math.sqrt(t * (t + 1.0)) - t)
    shear = math.sqrt(0.5 * 1e-3 * slip) * (1.0 + 2.0 * viscous.depth / 0.04)
    rate = shear * 0.25 / (found.area[0, 0] * 0.25**2)
    np.testing.assert_allclose(velocity, 0.2 * math.exp(-rate * 0.2), rtol=1e-6)


@kills(
    "solvers.runup.steps.layer:flow_inertia",
    "out[1] = c * s * (xx - yy) + (c * c - s * s) * xy",
    "out[1] = c * s * (xx + yy)",
)
@kills(
    "solvers.runup.steps.layer:flow_inertia",
    "scale = layer.weight * layer.radius**2",
    "scale = layer.weight * layer.radius**4",
)
@kills("solvers.runup.steps.coupled:solve", "factor = matrix[i, k] / matrix[k, k]", "factor = matrix[i, k]")
@kills(
    "solvers.runup.steps.spin:motor_torque",
    "part * (curve[1, k + 1] - curve[1, k])",
    "part * curve[1, k + 1]",
)
def test_small_parts() -> None:
    """Elimination, straight lines, turned tensors."""
    generator = np.random.default_rng(5)
    matrix, right = generator.normal(size=(5, 5)), generator.normal(size=5)
    matrix[0, 0] = 0.0
    wanted = np.linalg.solve(matrix, right)
    left, found = matrix.copy(), right.copy()
    coupled_parts.solve(left, found)
    np.testing.assert_allclose(found, wanted, rtol=1e-12)
    curve = np.array([[1.0, 2.0, 5.0], [3.0, 4.0, -2.0]])
    for spin in (0.5, 1.0, 1.7, 3.0, 5.0, 7.0):
        assert motor_torque(curve, spin) == pytest.approx(np.interp(spin, *curve))
    measures, layer = records(MEASURES)[0], records(LAYER)[0]
    measures.xx, measures.xy, measures.yy = 2.0, 0.7, 1.0
    layer.radius, layer.weight = 0.5, 3.0
    turn = np.array([[math.cos(0.6), -math.sin(0.6)], [math.sin(0.6), math.cos(0.6)]])
    whole = turn @ np.array([[2.0, 0.7], [0.7, 1.0]]) @ turn.T
    out = np.zeros(3)
    coupled_layer.flow_inertia(measures, layer, math.cos(0.6), math.sin(0.6), out)
    np.testing.assert_allclose(out, 3.0 * 0.25 * np.array([whole[0, 0], whole[0, 1], whole[1, 1]]))


@kills("solvers.runup.steps.layer:_rub", "0.5 * slot * pressed * pressed", "slot * pressed * pressed")
@kills("solvers.runup.steps.layer:_half_friction", "slot * spin * spin", "slot * spin")
def test_energy_of_a_full_gap() -> None:
    """What is pressed into the slot comes out again: the loss of a smooth step is small beside its change."""
    n, full = 32, 0.12
    theta = 2.0 * np.pi * (np.arange(n) + 0.5) / n
    pipe = Inside(NOTHING.plates, full, 64.0)
    # All of it under pressure, a wave that runs along.
    area = full + 0.004 + 0.002 * np.cos(theta)
    q = 0.02 * np.sin(theta) * area - SPIN * area**2
    gains, spare = records(GAINS)[0], coupled_layer.layer_scratch(1, n)[0]
    pressed = 0.5 * 64.0 * SPIN**2 * np.square(area - full).sum() * 2.0 * np.pi / n
    layer = records(LAYER)[0]
    status, _ = coupled_layer.layer_step(
        *(finite_volume.rates, friction_of(0), area, q, area[:0], np.array([SPIN, SPIN]), np.zeros(4)),
        *(layer, 0.0, 0.0, NO_TABLE, 0.005, ring(n), *pipe, spare, gains),
    )
    assert status == Outcome.DONE
    after = 0.5 * 64.0 * SPIN**2 * np.square(area - full).sum() * 2.0 * np.pi / n
    # The scheme takes a part of what changes, 32 cells and the doubled signal speeds of the gap.
    assert abs(after - pressed) > 1e-6
    assert abs(gains.loss) < 0.3 * abs(after - pressed)


@kills("solvers.runup.steps.spin:resisted", "(1.0 + weight * slope)", "(1.0 - weight * slope)")
@kills("solvers.runup.steps.spin:driven", "2.0 * middle - shaft.spin", "middle")
def test_a_steep_motor_does_not_run_away() -> None:
    """Torque falling with the spin takes (1 - x)/(1 + x) of the distance to its load, x = -T' dt/(2 J)."""
    for x in (1e-3, 0.5, 3.0, 1e6):
        # T = k (40 - spin), a load of 2 N m: it settles at 40 - 2/k.
        inertia, dt = 0.05, 1e-3
        k = 2.0 * x * inertia / dt
        curve, shaft = (
            np.array([[0.0, 80.0], [40.0 * k, -40.0 * k]]),
            SimpleNamespace(inertia=inertia, spin=39.0),
        )
        rest = 40.0 - 2.0 / k
        left = driven(curve, shaft, 2.0 * dt, dt) - rest
        assert left == pytest.approx((1.0 - x) / (1.0 + x) * (39.0 - rest), abs=1e-9)
        assert abs(left) <= abs(39.0 - rest)


def steps_behind(spin: float, rate: float, seen: np.ndarray, known: int) -> tuple[np.ndarray, np.ndarray]:
    """First guess for a step, and what it would be were the last steps' course followed exactly.

    Accelerations seen from the drum are polynomials `seen` of the time, of the steps' middles; so many of the
    last three steps are known.
    """
    dt, lasted = 0.011, np.array([0.012, 0.01, 0.013])
    middle = -(np.cumsum(lasted) - 0.5 * lasted)

    def mean(time: float) -> complex:
        value = complex(np.polyval(seen[::-1], time))
        return value * np.exp(1j * (spin * time + 0.5 * rate * time**2))

    push, pace, shaft = np.zeros((1, 3, 2)), records(PACE)[0], records(SHAFT)[0]
    for k in range(known):
        push[0, k] = mean(middle[k]).real, mean(middle[k]).imag
    pace.last, pace.before, pace.older = lasted * (np.arange(3) < known)
    shaft.spin, shaft.rate = spin, rate
    guess = np.ones((1, 2))
    coupled_parts.expect(push, pace, shaft, dt, guess)
    wanted = mean(0.5 * dt)
    return guess[0], np.array([wanted.real, wanted.imag])


@kills(
    "solvers.runup.steps.coupled:expect",
    "0.5 * shaft.rate * (here - time)",
    "0.4 * shaft.rate * (here - time)",
)
@kills("solvers.runup.steps.coupled:expect", "shaft.spin * (here + time)", "shaft.spin * (here - time)")
@kills("solvers.runup.steps.coupled:expect", "linear * (ahead + first)", "linear * (ahead - first)")
@kills("solvers.runup.steps.coupled:expect", "(-linear - bend - curve if", "(-linear - bend if")
def test_the_first_guess_follows_what_goes_round_with_the_drum() -> None:
    """Exact for a course of as many terms as steps are known while the spin rises; wrong for one more."""
    seen = np.array([3.0 + 1.0j, 20.0 - 8.0j, 400.0 + 100.0j, 9e3 - 2e3j])
    for known in (1, 2, 3):
        guess, wanted = steps_behind(40.0, 25.0, seen[:known], known)
        np.testing.assert_allclose(guess, wanted, rtol=1e-13, atol=1e-13)
        guess, wanted = steps_behind(40.0, 25.0, seen[: known + 1], known)
        assert np.abs(guess - wanted).max() > 1e-4


@kills("solvers.runup.steps.coupled:expect", "min(here, 2.0 * (first - back) - back)", "here")
def test_a_long_step_after_short_ones_is_guessed_no_farther_ahead_than_two_of_them() -> None:
    """Steps were short for a fault that the next one need not have: what changed in them is no trend."""
    push, pace, shaft, guess = np.zeros((1, 3, 2)), records(PACE)[0], records(SHAFT)[0], np.zeros((1, 2))
    push[0, :, 0] = 1.0, 0.9, 0.8
    pace.last = pace.before = pace.older = 1e-5
    coupled_parts.expect(push, pace, shaft, 1e-2, guess)
    assert guess[0, 0] == pytest.approx(1.2, rel=1e-12)
