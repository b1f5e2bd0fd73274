"""Control of the rotor in magnetic bearings: poles, margins, answers, motion in time."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from meshes.arrays import Complex
from meshes.errors import InputError
from solvers.rotor.magnetic.control import Controller, Pid, Uncontrolled, source_times
from solvers.rotor.magnetic.linear import Loop, closed_loop, margins, orbit_size
from solvers.rotor.magnetic.machine import MagneticRotor
from solvers.rotor.magnetic.motion import Ending, Load, SpeedLaw, _Equations, integrate, settling_time
from tests.mutants import kills
from tests.oracles.blood_pump import MAGNETS, ROTOR, SPEED, pid, synergetic

CONTROL = "solvers.rotor.magnetic.control:"
LINEAR = "solvers.rotor.magnetic.linear:"
MOTION = "solvers.rotor.magnetic.motion:"
UNIT = math.sqrt(ROTOR.mass / ROTOR.motor_stiffness)  # of time in the source


def pairs_with(found: Complex, expected: Complex, rel: float) -> None:
    """Every expected pole is among those found, as often as it is expected."""
    rest = list(np.asarray(found))
    for pole in expected:
        k = int(np.argmin(np.abs(np.array(rest) - pole)))
        assert rest[k] == pytest.approx(pole, rel=rel)
        rest.pop(k)
    assert not rest


@kills(CONTROL + "Synergetic.feedback", "1.0 + self.weight", "self.weight")
@kills(CONTROL + "Synergetic.feedback", "pull / self.goal_time + inner", "pull / self.goal_time - inner")
@kills(CONTROL + "Synergetic._matrices", "speed * gyroscopic", "-speed * gyroscopic")
@kills(CONTROL + "Synergetic._matrices", "speed * per_speed", "-speed * per_speed")
@kills(CONTROL + "Synergetic.gains", "pulled - on_place", "-pulled - on_place")
@kills(CONTROL + "source_times", "weight * unit**2", "weight * unit")
@kills(LINEAR + "closed_loop", "machine.motor_pull + magnets", "-machine.motor_pull + magnets")
def test_poles_of_the_synergetic_control() -> None:
    """Gyroscopic terms, drag, motor and magnets are taken off: a cubic for each coordinate, at every speed.

    In the source's units s^3 + (h mu + 1/T_5 + 1/T_1) s^2 + (h mu/T_5 + (h mu + 1/T_5)/T_1) s
    + mu (1 + h/(T_1 T_5)). Eigenvalues 1e5 times apart lose as many digits: 1e-9.
    """
    cubics = []
    for mu in (0.2, 0.2, 1.2, 1.2):
        pull = 4000.0 * mu
        middle = pull / 35.0 + (pull + 1.0 / 35.0) / 35.0
        cubics.append(np.roots([1.0, pull + 2.0 / 35.0, middle, mu * (1.0 + 4000.0 / 35.0**2)]) / UNIT)
    for speed in (0.0, SPEED):
        pairs_with(closed_loop(ROTOR, synergetic(), speed).poles, np.concatenate(cubics), 1e-9)
    slow, fast = cubics[0][np.argmin(np.abs(cubics[0]))], cubics[0][np.argmax(np.abs(cubics[0]))]
    assert slow.real == pytest.approx(-19.9, abs=0.05) and abs(slow.imag) == pytest.approx(11.0, abs=0.05)
    assert fast.real == pytest.approx(-5.6e5, rel=0.01)


@kills(CONTROL + "Pid.gains", "-steep * unit", "steep * unit")
@kills(CONTROL + "Pid.gains", "self.cutoff * motion))", "motion))")
def test_poles_of_the_pid_control() -> None:
    """Without spin, drag: s^2 + (P + I/s + D s w/(s + w)) k - pull, a quartic for each coordinate."""
    rotor = replace(ROTOR, drag=0.0)
    control = pid(rotor)
    expected: list[complex] = []
    for n in (0, 2):
        arm = 2.0 if n == 0 else 2.0 * 9e-3**2
        inertia = rotor.inertia[n]
        pull = (rotor.motor_pull[n, n] + arm * MAGNETS.position_stiffness) / inertia
        p, i, d = (
            arm * part / inertia for part in (control.proportional, control.integral, control.derivative)
        )
        w = control.cutoff
        quartic = np.roots([1.0, w, p + d * w - pull, (p - pull) * w + i, i * w])
        expected += [*quartic, *quartic]
    pairs_with(closed_loop(rotor, control, 0.0).poles, np.array(expected), 1e-7)


@kills(
    LINEAR + "closed_loop",
    "machine.damping + speed * machine.gyroscopic",
    "machine.damping + machine.gyroscopic",
)
def test_gyroscopic_splitting() -> None:
    """On springs alone the tilting mode splits into w = +-g/2 + sqrt(g^2/4 + k), g = Omega I_z/I_x."""
    rotor = replace(ROTOR, drag=0.0)
    control = Pid(rotor, proportional=20e3, integral=0.0, derivative=0.0, cutoff=1e4)
    net = 2.0 * 9e-3**2 * (20e3 - MAGNETS.position_stiffness) - rotor.motor_pull[2, 2]
    half, k = 0.5 * SPEED * rotor.polar_inertia / rotor.transverse_inertia, net / rotor.transverse_inertia
    found = np.sort(np.abs(closed_loop(rotor, control, SPEED).poles.imag))
    for expected in (math.sqrt(half**2 + k) - half, math.sqrt(half**2 + k) + half):
        assert np.sum(np.abs(found - expected) < 1e-7 * expected) == 2  # a pair of conjugates
    free = replace(rotor, motor_stiffness=0.0, magnets=replace(MAGNETS, force_constant=1e-20))
    poles = closed_loop(free, Uncontrolled(), SPEED).poles
    assert np.abs(poles.imag).max() == pytest.approx(2.0 * half, rel=1e-6)  # nutation of a free body


def test_poles_with_coils_that_take_time() -> None:
    """1/(1 + s/w) in the currents: s^4/w + s^3 + (D - n/w) s^2 + (P - n) s + Z, n the pull over m."""
    coils = replace(MAGNETS, bandwidth=2.0e4)
    rotor = replace(ROTOR, magnets=coils)
    control = synergetic(rotor)
    place, rate, memory = control.feedback
    n = (rotor.motor_stiffness + 2.0 * coils.position_stiffness) / rotor.mass
    lag, found = 1.0 / 2.0e4, closed_loop(rotor, control, 0.0).poles
    quartic = np.roots([lag, 1.0, rate[0] - lag * n, place[0], control.rate * memory])
    for pole in quartic:
        assert np.sum(np.abs(found - pole) < 1e-8 * abs(pole)) == 2  # x and y


def wanted_crossings(factor: float) -> tuple[float, float]:
    """Phase and delay margin of x with the synergetic control at rest, from the roots of |N|^2 = |D|^2."""
    control = synergetic()
    place, rate, memory = control.feedback
    n = (ROTOR.motor_stiffness + 2.0 * MAGNETS.position_stiffness) / ROTOR.mass
    top = factor * np.array([rate[0], place[0] + n, control.rate * memory])  # of s^2, s, 1
    # |N(iw)|^2 - |D(iw)|^2 in u = w^2, D = s^3 - n s.
    gap = np.polysub(
        np.polyadd(
            np.square([1.0, 0.0]) * 0.0, [top[0] ** 2, top[1] ** 2 - 2.0 * top[0] * top[2], top[2] ** 2]
        ),
        np.polymul([1.0, 0.0], np.polymul([1.0, n], [1.0, n])),
    )
    roots = np.roots(gap)
    frequency = np.sqrt(roots.real[(np.abs(roots.imag) < 1e-9 * np.abs(roots)) & (roots.real > 0.0)])
    loop = np.polyval(top, 1j * frequency) / np.polyval([1.0, 0.0, -n, 0.0], 1j * frequency)
    lag = np.angle(-loop)
    return float(np.abs(lag).min()), float((lag % (2.0 * math.pi) / frequency).min())


@kills(LINEAR + "_phase_and_delay", "lag % (2.0 * math.pi)) / at", "lag % math.pi) / at / 2.0")
@kills(LINEAR + "_phase_and_delay", "phase, abs(lag)", "phase, math.pi - abs(lag)")
@kills(LINEAR + "Loop.closed", "self.free - factor", "self.free - factor * factor")
def test_margins_at_rest() -> None:
    """A body without tilt in the loop: margins of x from its polynomials, the least gain by Routh's rule."""
    # Leaning is made as stiff as can be by a tiny inertia's partner: the same numbers for both coordinates.
    same = replace(
        ROTOR, transverse_inertia=ROTOR.mass * 9e-3**2, drag=0.0, motor_length=math.sqrt(12.0) * 9e-3
    )
    control = replace(synergetic(same), tilt_rate=synergetic(same).rate)
    found = margins(closed_loop(same, control, 0.0))
    phase, delay = wanted_crossings(1.0)
    assert found.phase == pytest.approx(phase, rel=1e-8)
    assert found.delay == pytest.approx(delay, rel=1e-8)
    place, rate, memory = control.feedback
    n = (ROTOR.motor_stiffness + 2.0 * MAGNETS.position_stiffness) / ROTOR.mass
    assert found.gain_down == pytest.approx((n + control.rate * memory / rate[0]) / (place[0] + n), rel=1e-8)
    assert found.gain_up == math.inf
    # |1 + L| over frequency, evenly for all four currents
    w = np.geomspace(1e-2, 1e9, 20001)
    top = np.polyval([rate[0], place[0] + n, control.rate * memory], 1j * w)
    least = np.abs(1.0 + top / np.polyval([1.0, 0.0, -n, 0.0], 1j * w)).min()
    assert found.sensitivity == pytest.approx(1.0 / least, rel=1e-4)


@kills(
    LINEAR + "_gain", "return float(brentq(slowest, before, factor, xtol=1e-12, rtol=1e-10))", "return before"
)
@kills(LINEAR + "_sensitivity", "np.eye(4) + loop.transfer", "np.eye(4) - loop.transfer")
def test_margins_lead_to_the_edge() -> None:
    """At each margin of a loop with lagging coils a pole is on the imaginary axis: 1 + L is singular."""
    rotor = replace(ROTOR, magnets=replace(MAGNETS, bandwidth=1e5))
    loop = closed_loop(rotor, pid(rotor), SPEED)
    found = margins(loop)
    assert 1.0 < found.gain_up < math.inf and 0.0 < found.gain_down < 1.0
    w = np.geomspace(100.0, 1e6, 12001)
    transfer = loop.transfer(w)

    def nearest(turn: Complex) -> float:
        return float(np.abs(np.linalg.eigvals(transfer) * turn[:, None] + 1.0).min())

    # The grid misses the crossing by 4e-4 of the frequency, eigenvalues of some 1 by as much.
    for turn in (found.gain_up + 0j, found.gain_down + 0j):
        assert nearest(np.full(w.shape, turn)) < 3e-3
    assert nearest(np.exp(-1j * w * found.delay)) < 3e-3
    assert min(nearest(np.full(w.shape, np.exp(s * 1j * found.phase))) for s in (1.0, -1.0)) < 3e-3
    assert nearest(np.exp(-1j * w * 0.8 * found.delay)) > 0.02
    worst = np.linalg.inv(np.eye(4) + loop.transfer(found.worst))
    assert np.linalg.norm(worst, 2) == pytest.approx(found.sensitivity, rel=1e-9)
    assert found.sensitivity >= 1.0 / np.linalg.svd(np.eye(4) + transfer, compute_uv=False).min() - 1e-6


def test_margins_of_what_is_not_stable() -> None:
    found = margins(closed_loop(ROTOR, Uncontrolled(), SPEED))
    assert math.isnan(found.phase) and math.isnan(found.sensitivity)
    with pytest.raises(InputError, match="speed"):
        closed_loop(ROTOR, pid(), -1.0)
    with pytest.raises(InputError, match="manifold_time"):
        source_times(ROTOR, 0.0, 1.0, 1.0, 1.0)


@kills(MOTION + "_Equations.__call__", "speed * self.circulation", "-speed * self.circulation")
@kills(MOTION + "_Equations.__call__", "self.damping + speed", "self.damping - speed")
@kills(MOTION + "_Equations.currents", "np.clip(wanted, -limit, limit)", "-np.clip(wanted, -limit, limit)")
@kills(MOTION + "_Equations.__call__", "bandwidth * (wanted - current)", "bandwidth * (wanted + current)")
@kills(CONTROL + "Synergetic.answer", "self._rates * place", "-self._rates * place")
@kills(CONTROL + "Pid.answer", "self.cutoff * (at - memory[4:])", "self.cutoff * (at + memory[4:])")
def test_small_motions_in_time_are_the_linear_loop() -> None:
    """Central differences of the nonlinear rates of change, against the loop's matrix.

    Steps of 1e-6 of each scale leave 1e-12 of the third derivatives and 1e-10 by rounding, of the largest
    entry in a row; what the unbalance adds is the same on both sides.
    """
    rotor = replace(ROTOR, drag=1e-5, magnets=replace(MAGNETS, bandwidth=3e4))
    for control in (synergetic(rotor), pid(rotor), synergetic(), pid()):
        machine = control.model
        equations = _Equations(machine, control, SpeedLaw(SPEED), ())
        expected = closed_loop(machine, control, SPEED).closed().real
        size = expected.shape[0]
        steps = 1e4 * equations.errors(size)
        found = np.empty((size, size))
        for k in range(size):
            aside = steps * (np.arange(size) == k)
            found[:, k] = (equations(0.3, aside) - equations(0.3, -aside)) / (2.0 * steps[k])
        weights = steps / np.max(np.abs(expected) * steps, axis=1, keepdims=True)
        np.testing.assert_allclose(found * weights, expected * weights, atol=1e-7)


@kills(LINEAR + "Loop.unbalance", "-1j * force, couple", "1j * force, couple")
@kills(LINEAR + "Loop.answer", "right[4:8]", "right[:4]")
def test_unbalance_and_harmonic_load_in_time() -> None:
    """Settled motion under small loads: that of the linear loop.

    The magnets' forces are straight to (x/delta)^2: 1e-8 here. Of the transient e^-6.9 of some of the answer
    is left after 0.35 s with the synergetic control.
    """
    rotor = replace(ROTOR, eccentricity=2e-5, inertia_tilt=2e-3, drag=1e-4)
    control = synergetic(rotor)
    load = Load((0.01, -0.004), (2e-5, 1e-5), frequency=2.0 * math.pi * 50.0)
    motion = integrate(rotor, control, SpeedLaw(SPEED), 0.4, [load], samples=4001)
    loop = closed_loop(rotor, control, SPEED)
    turning = loop.unbalance()[0]
    swinging = loop.answer(-1j * load.size, load.frequency or 0.0)[0]
    late = motion.time > 0.35
    t = motion.time[late, None]
    expected = np.real(turning * np.exp(1j * SPEED * t) + swinging * np.exp(1j * (load.frequency or 0.0) * t))
    size = np.abs(expected).max()
    assert motion.ending is Ending.DONE and size > 1e-9
    np.testing.assert_allclose(motion.displacement[late], expected, atol=3e-3 * size)


@kills(LINEAR + "Loop.step", "/ self.machine.inertia", "/ self.machine.inertia[::-1]")
@pytest.mark.parametrize("make", [synergetic, pid])
def test_step_in_time(make: type[Controller]) -> None:
    """A small step of load: the linear answer to (x/delta)^2 + (i/i_0)^2, 1e-4 here."""
    rotor = replace(ROTOR, eccentricity=0.0, inertia_tilt=0.0)
    control = make(rotor)  # type: ignore[call-arg]
    load = Load((0.02, 0.01), (1e-5, -1e-5), start=0.1)
    motion = integrate(rotor, control, SpeedLaw(SPEED), 0.3, [load], samples=301)
    after = motion.time >= 0.1
    place, current = closed_loop(rotor, control, SPEED).step(load.size, motion.time[after] - 0.1)
    assert np.abs(motion.displacement[motion.time < 0.1]).max() == 0.0
    scale = np.abs(place).max()
    np.testing.assert_allclose(motion.displacement[after], place, atol=1e-3 * scale)
    np.testing.assert_allclose(motion.current[after], current, atol=1e-3 * np.abs(current).max())


def test_the_claims_of_accuracy() -> None:
    """A load of c_m delta moves the rotor by less than 4 um, and it is back after 0.4 s [BG18]."""
    load = ROTOR.motor_stiffness * MAGNETS.gap
    place, _ = closed_loop(ROTOR, synergetic(), SPEED).step([load, 0.0, 0.0, 0.0], np.linspace(0.0, 0.4, 401))
    size = orbit_size(place)
    assert size.max() == pytest.approx(3.07e-6, rel=5e-3) and size[-1].max() < 6e-9


@pytest.mark.parametrize("make", [synergetic, pid])
def test_starts_near_a_magnet_come_home(make: type[Controller]) -> None:
    """From 0.7 of the gap, within the 0.4 s that the source tells [BG18]; the coils give what they can."""
    angle = 2.5
    place = 0.7 * MAGNETS.gap * np.array([math.cos(angle), math.sin(angle), 0.0, 0.0])
    law = SpeedLaw(SPEED, 700.0 * math.pi / 30.0, 2.0 * math.pi)
    motion = integrate(ROTOR, make(ROTOR), law, 0.4, place=place, samples=401)  # type: ignore[call-arg]
    assert motion.ending is Ending.DONE and settling_time(motion, 4e-6) < 0.35
    assert np.abs(motion.current).max() <= MAGNETS.bias_current


CHANGES = ("polar_inertia", "transverse_inertia", "drag", "eccentricity", "inertia_tilt")


def changed(name: str, factor: float) -> MagneticRotor:
    """The rotor with one value that the controller does not know of."""
    return replace(ROTOR, **{name: factor * getattr(ROTOR, name)})


@pytest.mark.parametrize("factor", [0.5, 2.0])
@pytest.mark.parametrize("name", CHANGES)
def test_the_controller_need_not_know_the_rotor(name: str, factor: float) -> None:
    """Twice and half the value, with the controller of the nominal one: stable and as quick."""
    if (name, factor) in (("transverse_inertia", 0.5), ("polar_inertia", 4.0)):
        factor = 0.6  # a body has I_z <= 2 I_x
    loop = closed_loop(changed(name, factor), synergetic(), SPEED)
    assert loop.poles.real.max() < -15.0
    assert orbit_size(loop.unbalance()[0]).max() < 4e-9


@kills(MOTION + "SpeedLaw.angle", "self.amplitude / self.frequency", "self.amplitude * self.frequency")
@settings(max_examples=50)
@kills(MOTION + "SpeedLaw.rate", "self.amplitude * self.frequency * cosine", "self.amplitude * cosine")
@given(st.floats(10.0, 1000.0), st.floats(0.0, 1.0), st.floats(0.1, 50.0), st.floats(0.0, 3.0))
def test_angle_speed_and_rate(mean: float, share: float, frequency: float, time: float) -> None:
    """Central differences: errors h^2 f'''/6 <= h^2 frequency^2 of the speed's and the rate's own sizes."""
    law, h = SpeedLaw(mean, share * mean, frequency), 1e-4 / frequency
    for value, slope in ((law.angle, law.speed), (law.speed, law.rate)):
        found = float(value(time + h) - value(time - h)) / (2.0 * h)
        size = mean * max(1.0, frequency) ** (value == law.speed)
        rounding = 1e-15 * abs(float(value(time))) / h
        assert found == pytest.approx(float(slope(time)), abs=1e-7 * size + 4.0 * rounding)


def test_the_angle_begins_at_zero() -> None:
    assert float(SpeedLaw(100.0, 50.0, 3.0).angle(0.0)) == 0.0


def test_orbits() -> None:
    """A circle, a line, and an ellipse with half axes of 3 and 1."""
    found = orbit_size(np.array([[2.0, -2.0j, 3.0, 4.0], [3.0, -1.0j, 0.0, 0.0]]))
    np.testing.assert_allclose(found, [[2.0, 5.0], [3.0, 0.0]], rtol=1e-14)


def test_a_load_and_a_law_that_cannot_be() -> None:
    with pytest.raises(InputError, match="frequency"):
        Load((1.0, 0.0), frequency=0.0)
    with pytest.raises(InputError, match="load"):
        Load((math.nan, 0.0))
    with pytest.raises(InputError, match="amplitude"):
        SpeedLaw(1.0, 2.0)
    for more, field in (
        ({"duration": 1e9}, "duration"),
        ({"samples": 1}, "samples"),
        ({"place": (1, 0, 0, 0)}, "place"),
    ):
        with pytest.raises(InputError, match=field):
            integrate(ROTOR, pid(), SpeedLaw(SPEED), **({"duration": 0.1} | more))  # type: ignore[arg-type]


def test_a_load_that_is_too_large_ends_at_the_magnet() -> None:
    motion = integrate(ROTOR, pid(), SpeedLaw(SPEED), 0.5, [Load((8.0, 0.0), start=0.1)])
    assert motion.ending is Ending.TOUCHED and 0.1 < motion.time[-1] < 0.2
    assert settling_time(motion, 4e-6) == math.inf


def test_loop_is_a_row_of_numbers() -> None:
    loop: Loop = closed_loop(ROTOR, synergetic(), SPEED)
    assert loop.free.shape == (12, 12) and loop.stable and not closed_loop(ROTOR, Uncontrolled(), 0.0).stable
