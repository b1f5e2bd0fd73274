"""Growth of disturbances, lines of a spectrum, and what the balls of an exciter end in."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from meshes.arrays import Array
from meshes.errors import InputError
from solvers.rotor.exciter import machine as exciter
from solvers.rotor.exciter import tangent
from solvers.rotor.exciter.machine import Dimensionless, stuck_speeds
from solvers.rotor.exciter.motion import Start, initial_state, placed_state
from solvers.rotor.exciter.regimes import Kind, Place, decay_time, regime
from solvers.rotor.exciter.spectrum import combination, lines, spectrum
from solvers.rotor.exciter.stability import resonance_speed, third_speed
from solvers.rotor.exciter.tangent import follow
from tests.mutants import kills

TYPICAL = Dimensionless(0.01, 0.4, 0.25, 0.03)
LEANING = Dimensionless(0.04, 0.4, 0.7, 0.06, gravity=0.3, incline=0.5)
RATES = "solvers.rotor.exciter.tangent:tangent_rates"


def complex_step(machine: Dimensionless, speed: float, time: float, pair: Array) -> tuple[Array, Array]:
    """Rates of the state, and their derivative along the disturbance, by the equations themselves."""
    size = pair.size // 2
    at = pair[:size] + 1e-30j * pair[size:]
    out = np.zeros(size, dtype=complex)
    exciter.rates(time, at, machine.numbers(speed), out)  # type: ignore[arg-type]
    return out.real, out.imag / 1e-30


def check_rates(machine: Dimensionless, speed: float, time: float, pair: Array) -> None:
    """Both parts to rounding, some 1e-13 of the largest."""
    out = np.zeros_like(pair)
    tangent.tangent_rates(time, pair, machine.numbers(speed), out)
    state, change = complex_step(machine, speed, time, pair)
    assert out[: state.size] == pytest.approx(state, abs=1e-12 * np.abs(state).max())
    assert out[state.size :] == pytest.approx(change, abs=1e-12 * np.abs(change).max())


@kills(RATES, "2.0 * rate * sine * quicken", "rate * sine * quicken")
@kills(RATES, "own * sine * turn - own_change * cosine", "own * sine * turn + own_change * cosine")
@kills(RATES, "carried_change -= 2.0", "carried_change += 2.0")
@kills(RATES, "load_change + acceleration * eps", "load_change - acceleration * eps")
@kills(RATES, "change * cosine - acceleration * sine", "change * cosine + acceleration * sine")
@kills(RATES, "np.sin(pair[at] - alpha) * turn", "np.sin(pair[at] - alpha)")
@pytest.mark.parametrize("balls", [1, 3])
def test_rates_of_a_disturbance(balls: int) -> None:
    random = np.random.default_rng(7)
    check_rates(LEANING, 3.0, 0.7, random.normal(size=4 + 4 * balls))


@given(
    pair=st.lists(st.floats(-3.0, 3.0), min_size=12, max_size=12),
    speed=st.floats(0.5, 30.0),
    time=st.floats(0.0, 10.0),
)
def test_rates_of_any_disturbance(pair: list[float], speed: float, time: float) -> None:
    check_rates(TYPICAL, speed, time, np.array([*pair[:6], *(x + 4.0 for x in pair[6:])]))


@kills("solvers.rotor.exciter.tangent:_stretch", "np.log(length)", "np.log(length * length)")
@kills("solvers.rotor.exciter.tangent:_stretch", "start + number * step", "start + (number + 1) * step")
def test_steps_against_an_adaptive_method() -> None:
    """State, growth and vibration of a wild start, as Python: the error falls by 16 when the step is halved.

    The growth against the distance of two motions that begin 1e-6 apart: to some 1e-6 of it.
    """
    speed, time = 3.0, 6.0
    begin = np.array([0.4, 0.1, 0.3, 2.0, 0.7, 1.9])
    aside = np.array([0.3, -0.1, 0.5, 0.2, -0.4, 0.6])

    def rate(at_time: float, at: Array) -> Array:
        out = np.zeros(6)
        exciter.rates(at_time, at, TYPICAL.numbers(speed), out)
        return out

    aside = aside / np.linalg.norm(aside)
    span = (2.0, 2.0 + time)
    exact = [
        solve_ivp(rate, span, begin + 5e-7 * side * aside, "DOP853", rtol=1e-13, atol=1e-13).y[:, -1]
        for side in (0.0, 1.0, -1.0)
    ]
    grown = math.log(np.linalg.norm(exact[1] - exact[2]) / 1e-6) / time
    errors = []
    for steps in (40, 80):
        found = follow(
            *(TYPICAL, speed, begin, time, aside),
            blocks=2,
            steps=steps,
            start=2.0,
            stretch=tangent._stretch,  # type: ignore[arg-type]
        )
        errors.append(np.max(np.abs(found.state - exact[0])))
        assert found.time == 8.0
    assert errors[1] < 1e-4
    assert 11.0 < errors[0] / errors[1] < 21.0
    assert found.growth.mean() == pytest.approx(grown, abs=1e-5)
    # Mean speeds of both halves make up the whole way.
    assert found.ball_speed.mean(axis=0) == pytest.approx((found.state[2:4] - begin[2:4]) / time, rel=1e-12)


@kills("solvers.rotor.exciter.tangent:_tangent_step", "slopes[1, i] + slopes[2, i]", "slopes[1, i]")
@kills("solvers.rotor.exciter.tangent:_tangent_step", "time + step, trial", "time, trial")
def test_one_step() -> None:
    """Local error of fifth order: 2^5 = 32 less at half the step, within a third."""
    begin, numbers = np.array([0.3, -0.2, 0.1, 2.0, 0.8, 1.4]), TYPICAL.numbers(3.0)

    def rate(at_time: float, at: Array) -> Array:
        out = np.zeros(6)
        exciter.rates(at_time, at, numbers, out)
        return out

    errors = []
    for step in (0.1, 0.05):
        pair = np.concatenate((begin, np.ones(6)))
        tangent._tangent_step(0.2, pair, numbers, step, np.empty((4, 12)), np.empty(12))
        span = (0.2, 0.2 + step)
        exact = solve_ivp(rate, span, begin, "DOP853", rtol=1e-13, atol=1e-14).y[:, -1]
        errors.append(np.max(np.abs(pair[:6] - exact)))
    assert 21.0 < errors[0] / errors[1] < 43.0


def test_two_parts_are_one_run() -> None:
    """A second part that begins at the time and state of the first goes on as if there were no parts."""
    begin = initial_state(TYPICAL, 5.0, 0.95, 2, Start("rest", 0.5))
    whole = follow(TYPICAL, 5.0, begin, 40.0, blocks=4)
    half = follow(TYPICAL, 5.0, begin, 20.0, blocks=2)
    rest = follow(TYPICAL, 5.0, half.state, 20.0, blocks=2, start=half.time)
    assert rest.state == pytest.approx(whole.state, abs=1e-9)
    assert rest.ball_speed == pytest.approx(whole.ball_speed[2:], abs=1e-10)


def test_exponents_that_are_known() -> None:
    """A platform that balls hardly load loses a disturbance at h; a periodic motion keeps its phase for ever.

    h is exact after whole half periods, to the error of the steps. Zero is met to the logarithm of what a
    phase gains at first over the time, here 3 over 8000.
    """
    light = Dimensionless(1e-9, 0.4, 0.25, 0.05)
    begin = initial_state(light, 5.0, 0.95, 1, Start("rest"))
    platform = np.array([1.0, 0.0, 0.0, 0.0])
    time = 100.0 * math.pi / math.sqrt(1.0 - 0.05**2)
    assert follow(light, 5.0, begin, time, platform).growth.mean() == pytest.approx(-0.05, abs=1e-6)
    bare = Dimensionless(0.01, 0.4, 0.0, 0.03)
    stuck = float(stuck_speeds(5.0, bare)[0])
    periodic = follow(bare, 5.0, placed_state(bare, 5.0, [stuck], [0.0]), 10000.0)
    assert abs(periodic.growth[8:].mean()) < 4e-4


def test_vibration_and_samples() -> None:
    """Mean square and samples of a platform that only the unbalance moves: half the amplitude squared.

    The balls, of 1e-9 in mass, turn with the shaft where they cancel.
    """
    machine, speed = Dimensionless(1e-9, 0.4, 0.25, 0.03), 3.0
    state = placed_state(machine, speed, [speed, speed], [0.0, math.pi])
    found = follow(machine, speed, state, 100.0 * math.pi, blocks=10, samples=200, sampled=0.5, steps=100)
    amplitude = 0.25 * 9.0 / abs(complex(1.0 - 9.0, 0.18))
    assert found.power == pytest.approx(np.full(10, 0.5 * amplitude**2), rel=1e-6)
    assert found.samples.size == 200
    assert np.abs(found.samples).max() == pytest.approx(amplitude, rel=0.01)
    # The last sample is one distance before the end.
    times = 100.0 * math.pi - found.sample_time * np.arange(200, 0, -1)
    wave = 0.25 * 9.0 / complex(1.0 - 9.0, 0.18) * np.exp(3j * times)
    assert found.samples == pytest.approx(wave.imag, abs=1e-5)


PLACED = "solvers.rotor.exciter.motion:placed_state"


@kills(PLACED, "1.0 / speeds.size", "1.0")
@kills(PLACED, "1j * turning * wave", "turning * wave")
def test_placed_balls_shake_no_more_than_they_should() -> None:
    """Nearly massless balls at two speeds: a platform placed so has no transient, to their mass."""
    machine, speed = Dimensionless(1e-9, 0.0, 0.25, 0.03), 3.0
    state = placed_state(machine, speed, [0.7, 2.2], [0.4, 1.0])
    end = follow(machine, speed, state, 20.0).state
    wave = [
        weight * q**2 / complex(1.0 - q**2, 0.06 * q) * np.exp(1j * (20.0 * q + angle))
        for weight, q, angle in ((0.5, 0.7, 0.4), (0.5, 2.2, 1.0), (0.25, 3.0, 0.0))
    ]
    assert end[0] == pytest.approx(sum(wave).imag, abs=1e-5)


@pytest.mark.parametrize(
    ("unbalance", "places", "kind"),
    [
        (0.25, "resonance resonance", Kind.STUCK),
        (0.25, "resonance shaft", Kind.PART_STUCK),
        (0.05, "resonance third", Kind.THIRD),
        (0.25, "shaft shaft", Kind.BALANCED),
    ],
)
def test_regimes_that_are_known(unbalance: float, places: str, kind: Kind) -> None:
    """Each motion of the typical table at n = 8.15 goes on where it is begun, to a per cent of its speed.

    Speeds by eq. 1 with one ball of two or both; balls of opposite places balance an unbalance of a quarter
    at 104.5 and 255.5 degrees, and begin five degrees off.
    """
    machine, speed = Dimensionless(0.01, 0.4, unbalance, 0.03), 8.15
    wanted = tuple(Place(name) for name in places.split())
    share = 0.5 if len(set(wanted)) == 2 else 1.0
    by_place = {
        Place.RESONANCE: resonance_speed(machine, speed, share),
        Place.THIRD: third_speed(machine, speed, share),
        Place.SHAFT: speed,
    }
    speeds = [by_place[place] for place in wanted]
    angles = np.radians([109.5, 255.5]) if kind is Kind.BALANCED else np.array([0.0, share * math.pi - 3.1])
    if kind is Kind.PART_STUCK:
        angles[1] = math.pi
    found = regime(machine, speed, placed_state(machine, speed, speeds, angles))
    assert found.kind is kind
    assert found.places == wanted
    assert found.ball_speed == pytest.approx(speeds, rel=0.01)
    assert found.growth < 1e-3 and found.chaos == 0.0
    bare = unbalance * speed**2 / (speed**2 - 1.0) / math.sqrt(2.0)
    assert (found.vibration < 0.02 * bare) == (kind is Kind.BALANCED)


def test_chaos_is_told_and_does_not_hang_on_the_step() -> None:
    """Scattered balls of a table with much slip: a disturbance grows at some 0.2, whatever the step.

    Two chaotic runs part, their mean growth over 1500 is alike to a third; a regular one has 0.01 at most.
    """
    machine, speed = Dimensionless(0.00695, 0.1322, 0.8909, 0.04845), 34.0
    third = third_speed(machine, speed, 0.5)
    state = placed_state(machine, speed, [third, third], [0.0, 2.0])
    grown = [float(follow(machine, speed, state, 1500.0, steps=steps).growth.mean()) for steps in (24, 36)]
    assert min(grown) > 0.1
    assert grown[0] == pytest.approx(grown[1], rel=0.35)


def test_a_run_that_settles_keeps_the_time_of_its_chaos() -> None:
    """Growth at 0.5 for a while, then decay."""
    from solvers.rotor.exciter.regimes import _chaotic_up_to

    growth = np.array([0.5] * 6 + [-0.02] * 34)
    assert _chaotic_up_to(growth, 20.0) == 120.0
    # A regular motion's disturbance grows with the time.
    times = 20.0 * np.arange(1, 41)
    regular = np.diff(np.log(np.append(1.0, times))) / 20.0
    assert _chaotic_up_to(regular, 20.0) == 0.0


@kills("solvers.rotor.exciter.spectrum:spectrum", "4.0 / samples.size", "2.0 / samples.size")
@kills("solvers.rotor.exciter.spectrum:lines", "2.0 * larger - at", "larger - at")
@kills("solvers.rotor.exciter.spectrum:lines", "(1.0 - place**2)", "(1.0 + place**2)")
@kills("solvers.rotor.exciter.spectrum:lines", "side * place", "place")
def test_lines_of_a_sum_of_sines() -> None:
    """Frequencies and amplitudes of three sines that fall between those of the transform.

    What one leaks into another 60 of the resolution away falls with its cube: 1e-5 of the resolution.
    """
    time = 0.05 * np.arange(1 << 13)
    waves = ((3.0, 0.9331, 0.2), (1.0, 4.4307, 1.0), (0.5, 7.9012, 2.0), (0.02, 11.0, 0.0))
    samples = 0.7 + sum(size * np.sin(w * time + phase) for size, w, phase in waves)
    found = lines(samples, 0.05)
    assert found.frequency == pytest.approx([w for _, w, _ in waves[:3]], abs=1e-3 * found.resolution)
    assert found.amplitude == pytest.approx([size for size, _, _ in waves[:3]], rel=1e-3)
    frequency, amplitude = spectrum(samples, 0.05)
    assert frequency.size == amplitude.size == (1 << 12) + 1


@given(
    basic=st.tuples(st.floats(0.5, 1.0), st.floats(7.0, 9.0)),
    numbers=st.tuples(st.integers(-3, 3), st.integers(-3, 3)),
)
def test_combinations(basic: tuple[float, float], numbers: tuple[int, int]) -> None:
    """What is made is found, with no larger integers; what is not, is not."""
    made = numbers[0] * basic[0] + numbers[1] * basic[1]
    found = combination(made, basic, 6, 1e-9)
    assert found is not None
    assert sum(map(abs, found)) <= sum(map(abs, numbers))
    assert found[0] * basic[0] + found[1] * basic[1] == pytest.approx(made, abs=1e-9)


def test_what_is_no_combination() -> None:
    assert combination(0.5, (1.0, 8.0), 6, 1e-6) is None
    assert combination(9.0, (1.0, 8.0), 1, 1e-6) is None
    assert combination(9.0, (1.0, 8.0), 2, 1e-6) == (1, 1)


def test_inputs_are_checked() -> None:
    state = initial_state(TYPICAL, 5.0, 0.95, 2, Start())
    for call in (
        lambda: follow(TYPICAL, 0.0, state, 10.0),
        lambda: follow(TYPICAL, 5.0, state, math.inf),
        lambda: follow(TYPICAL, 5.0, state, 1e12),
        lambda: follow(TYPICAL, 5.0, state, 10.0, np.zeros(6)),
        lambda: follow(TYPICAL, 5.0, state, 10.0, np.ones(5)),
        lambda: follow(TYPICAL, 5.0, state, 10.0, sampled=0.0),
        lambda: regime(TYPICAL, 5.0, state, decays=0.0),
        lambda: decay_time(Dimensionless(0.01, 0.0, 0.0, 0.03)),
        lambda: placed_state(TYPICAL, 5.0, [1.0], [0.0, 1.0]),
        lambda: placed_state(TYPICAL, 5.0, [math.nan], [0.0]),
        lambda: spectrum(np.zeros(8), 0.1),
        lambda: lines(np.zeros(64), 0.1, 1.0),
    ):
        with pytest.raises(InputError):
            call()
