"""Peaks between samples: closed forms, rational functions, jumps, and tops against dense speeds."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fluid.fill import Fill
from fluid.liquid import known_liquid
from meshes.arrays import Array, Complex, Index
from meshes.chamber import Chamber
from solvers.liquid_model import LiquidModel
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import dynamic_stiffness
from solvers.synchronous.models import LINEAR, STATICS
from solvers.synchronous.peaks import Answer, Peak, Samples, highest, maxima, refine, seeds
from solvers.synchronous.resonances import Tops, planar_tops, resonances
from solvers.synchronous.response import response
from tests.mutants import kills

WATER = known_liquid("water")
NOBODY = np.zeros(0, dtype=np.intp)


def rotor(damping_ratio: float, mass: float = 4.0, rate: float = 100.0, unbalance: float = 6e-4) -> Jeffcott:
    return Jeffcott(mass, mass * rate**2, 2.0 * damping_ratio * mass * rate, unbalance)


@pytest.mark.parametrize("ratio", [1e-7, 1e-4, 0.01, 0.3, 0.7])
@kills("solvers.synchronous.resonances:_Curve.top", "- 0.5 * np.square(damping)", "- np.square(damping)")
def test_dry_top(ratio: float) -> None:
    """e/(2 zeta sqrt(1 - zeta^2)) at omega/sqrt(1 - 2 zeta^2), to rounding over what the root leaves."""
    tops = planar_tops([(rotor(ratio), [])], np.zeros(1), LINEAR)
    left = 1.0 - 2.0 * ratio**2
    slack = 1e-14 / left
    assert tops.speed[0] == pytest.approx(100.0 / math.sqrt(left), rel=slack)
    size = 6e-4 / 4.0 / (2.0 * ratio * math.sqrt(1.0 - ratio**2))
    # Stiffness and inertia leave a difference of 2 zeta^2 of them, but the damper holds what they leave.
    assert tops.amplitude[0] == pytest.approx(size, rel=1e-15 / ratio + slack)


def test_no_top() -> None:
    """More damping than zeta = sqrt(1/2) leaves no top, none no bound; without unbalance nothing moves."""
    still = Jeffcott(4.0, 4e4, 10.0, 0.0)
    tops = planar_tops([(rotor(0.71), []), (rotor(0.0), []), (still, [])], np.zeros(3), LINEAR)
    assert np.isnan(tops.speed[[0, 2]]).all() and np.isnan(tops.amplitude[[0, 2]]).all()
    assert tops.speed[1] == pytest.approx(100.0, rel=1e-15) and math.isinf(tops.amplitude[1])


def machine(seed: int) -> tuple[Jeffcott, list[Fill], float]:
    """A rotor of any damping and one to three chambers, whose walls run dry at the resonance or do not."""
    rng = np.random.default_rng(seed)
    own = rotor(10.0 ** rng.uniform(-4, -0.4), 10.0 ** rng.uniform(0, 1.5), 10.0 ** rng.uniform(1, 2.3), 1.0)
    fills, gravity = [], float(rng.choice([0.0, 9.81]))
    for _ in range(1 if gravity else rng.integers(1, 4)):  # the exact law costs much of an upright machine
        radius, height = rng.uniform(0.05, 0.3), rng.uniform(0.02, 0.2)
        chamber = Chamber(radius, height, rng.choice([0.0, 0.6]) * radius)
        fills.append(Fill(chamber, WATER, chamber.capacity * 10.0 ** rng.uniform(-3, -0.05)))
    size = own.mass * 0.1 * own.damping_ratio * 10.0 ** rng.uniform(-4, 0)
    return Jeffcott(own.mass, own.stiffness, own.damping, size), fills, gravity


def assert_top(own: Jeffcott, fills: list[Fill], gravity: float, model: LiquidModel) -> Tops:
    """The response reports the top at its speed, and no larger deflection anywhere."""
    tops = planar_tops([(own, fills)], np.array([gravity]), model)
    top, size, width = float(tops.speed[0]), float(tops.amplitude[0]), float(tops.half_width[0])
    near = top + width * np.array([-2.0, -1.0, -0.5, -0.1, -0.02, -0.01, 0.01, 0.02, 0.1, 0.5, 1.0, 2.0])
    speed = np.union1d(np.linspace(0.4, 1.8, 21) * own.natural_frequency, near[near > 0.0])
    # The roots are found to some 1e-15, and lie on the curve whose top is level.
    assert np.abs(response(own, fills, [top], gravity, model).deflection[0]) == pytest.approx(size, rel=1e-10)
    assert np.abs(response(own, fills, speed, gravity, model).deflection).max() <= size * (1.0 + 1e-10)
    return tops


@pytest.mark.parametrize("model", [STATICS, LINEAR], ids=["statics", "linear"])
@pytest.mark.parametrize("seed", [0, 1, 2, 4, 5])
def test_top_of_the_curve(seed: int, model: LiquidModel) -> None:
    """Machines of all kinds."""
    assert_top(*machine(seed), model)


@kills("solvers.synchronous.resonances:_Liquid.share", "/ deflection)", "/ (2.0 * deflection))")
def test_top_of_a_dry_wall() -> None:
    """A wall that has run dry at the resonance, and a curve that folds: less mass, a higher speed."""
    own, fills = rotor(0.02, unbalance=3e-4), [Fill(Chamber(0.1, 0.05), WATER, 2e-5)]
    bent, straight = (assert_top(own, fills, 0.0, model).speed[0] for model in (STATICS, LINEAR))
    assert bent > 1.01 * straight


@kills(
    "solvers.synchronous.resonances:_bent", "0.25 * (shares[1] - shares[0])", "0.0 * (shares[1] - shares[0])"
)
def test_upright_top() -> None:
    """The floor of an upright chamber is dry at slow speeds: the liquid's share changes with the speed."""
    own, fills = rotor(0.3, 1.0, 25.0, 1e-5), [Fill(Chamber(0.1, 0.1), WATER, 2e-5)]
    assert_top(own, fills, 9.81, STATICS)


def test_tops_at_once() -> None:
    """Many machines at once have the tops that they have alone."""
    rows = [machine(seed) for seed in range(4)] + [(rotor(0.1), [], 0.0), (rotor(0.0), [], 0.0)]
    gravity = np.array([g for *_, g in rows])
    tops = planar_tops([(own, fills) for own, fills, _ in rows], gravity, STATICS)
    for k, (own, fills, g) in enumerate(rows):
        alone = planar_tops([(own, fills)], np.array([g]), STATICS)
        assert tops.speed[k] == pytest.approx(alone.speed[0], rel=1e-12)
        assert tops.amplitude[k] == pytest.approx(alone.amplitude[0], rel=1e-12)


def test_undamped_top() -> None:
    """Without damping the deflection grows on until the liquid is a dead mass in the chamber's far end."""
    fills = [Fill(Chamber(0.1, 0.05), WATER, 2e-4)]
    own = rotor(0.0)
    for model, mass in ((STATICS, fills[0].mass), (LINEAR, fills[0].added_mass)):
        top = planar_tops([(own, fills)], np.zeros(1), model).speed[0]
        assert top == pytest.approx(math.sqrt(own.stiffness / (own.mass + mass)), rel=1e-14)
        near = response(own, fills, top * (1.0 - np.array([1e-4, 1e-6])), 0.0, model)
        assert np.abs(near.deflection[1]) > 90.0 * np.abs(near.deflection[0])


def test_resonances() -> None:
    """Each makes the dynamic stiffness singular at the speed that stands half a width off the real ones."""
    support = Support(-0.3, 4e4, 50.0), Support(0.25, 6e4, 70.0)
    tilting = TwoPlane(20.0, 0.7, 0.2, support, (PlaneUnbalance(0.1, 1e-3),))
    system = tilting.system()
    speed, half_width = resonances(system, [])
    assert speed.size >= 3 and np.all(np.diff(speed) >= 0.0)
    for place, width in zip(speed, half_width, strict=True):
        least = []
        for omega in (place + 1j * width, place - 1j * width):
            matrix = system.stiffness - omega**2 * system.mass
            matrix = matrix + 1j * omega * (system.damping + omega * system.gyroscopic)
            least.append(np.linalg.svd(matrix)[1][-1])
        assert min(least) < 1e-9 * np.linalg.norm(dynamic_stiffness(system, speed[:1])[0])


@kills("solvers.synchronous.resonances:resonances", "0.5 * share *", "0.4 * share *")
def test_liquid_moves_resonances() -> None:
    """A planar rotor with its liquid's full mass: sqrt(K/M) and C/(2 M) to the square of the damping."""
    own, fill = rotor(1e-3), Fill(Chamber(0.1, 0.05), WATER, 2e-4)
    speed, half_width = resonances(own.system(), [fill])
    whole = own.mass + fill.added_mass
    k = int(np.argmin(np.abs(speed - math.sqrt(own.stiffness / whole))))
    assert speed[k] == pytest.approx(math.sqrt(own.stiffness / whole), rel=1e-5)
    assert half_width[k] == pytest.approx(0.5 * own.damping / whole, rel=1e-9)


def rational(centre: Array, ratio: Array, size: Array):  # type: ignore[no-untyped-def]
    """Sum of the answers of some oscillators, and how often it was asked."""
    asked: list[int] = []

    def answer(owner: Index, speed: Array) -> Complex:
        asked.append(speed.size)
        squared = np.square(speed)[:, None]
        terms = size * squared / (centre**2 - squared + 2j * ratio * centre * speed[:, None])
        return np.asarray(terms.sum(axis=1)[:, None])

    return answer, asked


@given(
    st.lists(
        st.tuples(st.floats(1.5, 19.0), st.floats(-4.0, -0.4), st.floats(-2.0, 0.0), st.booleans()),
        min_size=1,
        max_size=3,
    ),
    st.integers(4, 300),
    st.booleans(),
)
@settings(max_examples=100, deadline=None)
def test_refined_peaks(modes: list[tuple[float, float, float, bool]], count: int, whole: bool) -> None:
    """No amplitude at 20 001 speeds is above the peak, from however few samples."""
    centre, ratio, size = (
        np.array(x) for x in zip(*[(c, 10.0**r, 10.0**s) for c, r, s, _ in modes], strict=True)
    )
    size = size * np.where([up for *_, up in modes], 1.0, -1.0)
    answer, asked = rational(centre, ratio, size)
    found = []
    for number in (count, 2 * count + 1):
        speed = np.linspace(1.0, 20.0, number)
        speed = np.union1d(speed, seeds(centre, ratio * centre, 1.0, 20.0, speed, whole))
        (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
        found.append(highest(samples.speed, samples.amplitude).amplitude)
    dense = np.abs(answer(NOBODY, np.linspace(1.0, 20.0, 20001))).max()
    assert min(found) >= dense * (1.0 - 1e-9)
    assert found[0] == pytest.approx(found[1], rel=1e-9)
    assert len(asked) < 30


def test_narrow_resonance_without_seeds() -> None:
    """Amplitude and phase alone lead to a resonance 300 times narrower than the samples' distance."""
    answer, _ = rational(np.array([10.03, 15.0]), np.array([1e-4, 0.2]), np.array([-0.1, 1.0]))
    speed = np.linspace(1.0, 20.0, 60)
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    top = highest(samples.speed, samples.amplitude)
    near = np.abs(answer(NOBODY, np.linspace(10.02, 10.04, 20001)))
    assert top.amplitude == pytest.approx(near.max(), rel=1e-5)


def test_resonances_share_their_speeds() -> None:
    """Twenty resonances that overlap want hardly more speeds than one; narrow ones keep their own."""
    centre, width = 10.0 + 0.01 * np.arange(20), np.full(20, 0.5)
    known = np.linspace(1.0, 20.0, 5)
    together = seeds(centre, width, 1.0, 20.0, known, whole=False)
    assert together.size <= 5 and np.diff(together).min() > 0.25
    assert seeds(centre, np.full(20, 1e-4), 1.0, 20.0, known, whole=False).size == 3 * 20
    # Where an odd one shows the shape, its place counts alone.
    assert seeds(np.array([7.0]), np.array([np.nan]), 1.0, 20.0, known, whole=False).tolist() == [7.0]


@pytest.mark.parametrize("count", [3, 10, 60])
def test_jump(count: int) -> None:
    """An amplitude that rises to a fold and falls beyond it: the peak is at the fold."""

    def answer(owner: Index, speed: Array) -> Complex:
        rising = 2.0 - np.sqrt(np.maximum(7.123456 - speed, 0.0)) / 2.0
        return np.where(speed <= 7.123456, rising, 0.3)[:, None].astype(complex)

    speed = np.linspace(2.0, 10.0, count)
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    top = highest(samples.speed, samples.amplitude)
    # Speeds are told apart to 1e-12 of them; the amplitude has the root of that.
    assert top.speed == pytest.approx(7.123456, rel=1e-11) and top.amplitude == pytest.approx(2.0, rel=1e-5)


@pytest.mark.parametrize("whole", [True, False])
def test_two_peaks_close_together(whole: bool) -> None:
    """Two resonances a hundredth of the samples' distance apart, the higher one second."""
    centre, ratio = np.array([10.03, 10.033]), np.array([5e-5, 5e-5])
    answer, _ = rational(centre, ratio, np.array([0.5, 1.0]))
    speed = np.linspace(1.0, 20.0, 60)
    speed = np.union1d(speed, seeds(centre, ratio * centre, 1.0, 20.0, speed, whole))
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    near = 10.033 + np.linspace(-2e-3, 2e-3, 200001)
    assert highest(samples.speed, samples.amplitude).amplitude >= np.abs(answer(NOBODY, near)).max() * (
        1.0 - 1e-9
    )


def test_ends() -> None:
    """Where the amplitude only rises or falls the peak is an end of the range, and nothing more is asked."""
    answer, asked = rational(np.array([30.0]), np.array([0.1]), np.array([1.0]))
    speed = np.linspace(1.0, 20.0, 30)
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    assert highest(samples.speed, samples.amplitude).speed == 20.0 and len(asked) == 1


def test_a_known_bound_ends_the_search() -> None:
    """A machine that has reached what it cannot exceed is not asked again; others are."""
    answer, asked = rational(np.array([10.0]), np.array([0.01]), np.array([1.0]))
    speed = np.linspace(1.0, 20.0, 30)
    samples = Samples(speed, answer(NOBODY, speed))
    most = float(samples.amplitude.max())
    same, more = refine(answer, [samples, samples], [most, math.inf])
    assert same.speed.size == 30 and more.speed.size > 30
    asked.clear()
    refine(answer, [samples], [most])
    assert not asked


def noisy(noise: float) -> tuple[Answer, list[int], Peak]:
    """A resonance with noise like rounding of an ill-conditioned machine; what it is asked; its top."""
    exact, _ = rational(np.array([10.0]), np.array([0.05]), np.array([1.0]))
    calls = []

    def answer(owner: Index, speed: Array) -> Complex:
        calls.append(speed.size)
        # Digits of the speed far below what the resonance feels, as good as random.
        return exact(owner, speed) * (1.0 + noise * np.sin(speed * 1e13))[:, None]

    near = np.linspace(9.5, 10.5, 100001)
    return answer, calls, highest(near, np.abs(exact(NOBODY, near))[:, 0])


@pytest.mark.parametrize("noise", [1e-13, 1e-9, 1e-6, 1e-4])
def test_the_peak_under_noise(noise: float) -> None:
    """Found with few questions: a dozen speeds a round to see the shape, then 24 in at most eight rounds."""
    answer, calls, top = noisy(noise)
    speed = np.linspace(5.0, 20.0, 15)
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    assert highest(samples.speed, samples.amplitude).amplitude == (
        pytest.approx(top.amplitude, rel=1e-8 + 2.0 * noise)
    )
    assert len(calls) < 25 and sum(calls) < 300


@kills("solvers.synchronous.peaks:_around_maxima", "[:_AT_A_TIME]", "")
@kills("solvers.synchronous.peaks:refine", "fine[k] += not coarse", "fine[k] += 0")
def test_maxima_of_noise_are_not_refined() -> None:
    """Three hundred on a flat top, and each would have others beside it: eight at a time, eight times."""
    answer, calls, top = noisy(1e-6)
    speed = top.speed + np.linspace(-0.01, 0.01, 1001)
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    assert highest(samples.speed, samples.amplitude).amplitude == pytest.approx(top.amplitude, rel=2e-6)
    assert len(calls) <= 1 + 8 and max(calls[1:]) <= 3 * 8


def test_many_tops_of_one_height() -> None:
    """Twelve alike, more than are followed at a time: each to its end."""
    centre = np.linspace(5.0, 16.0, 12)

    def answer(owner: Index, speed: Array) -> Complex:
        return np.exp(-np.square((speed[:, None] - centre) / 0.2)).sum(axis=1)[:, None].astype(complex)

    speed = np.linspace(4.0, 17.0, 100)
    (samples,) = refine(answer, [Samples(speed, answer(NOBODY, speed))], [math.inf])
    for place in centre:
        near = np.abs(samples.speed - place) < 0.3
        # Of neighbours exp(-25) and exp(-100) is left; a top lower than another is seen to 1e-3.
        assert samples.amplitude[near].max() == pytest.approx(1.0, abs=1e-3)
    assert samples.amplitude.max() == pytest.approx(answer(NOBODY, centre).real.max(), rel=1e-10)


def test_no_peak() -> None:
    """Nothing known gives nan, an infinite amplitude has no bound, of equals the first one counts."""
    nowhere = highest(np.array([1.0]), np.array([np.nan]))
    assert not nowhere.known
    assert highest(np.array([1.0, 2.0]), np.array([0.1, np.inf])) == Peak(2.0, np.inf)
    assert highest(np.array([1.0, 2.0]), np.array([0.1, 0.1])) == Peak(1.0, 0.1)


def unbalanced(ratio: Array, damping: float) -> Array:
    """Amplitude of an unbalanced oscillator over its far amplitude, at speeds over the natural frequency."""
    return np.asarray(ratio**2 / np.sqrt((1.0 - ratio**2) ** 2 + (2.0 * damping * ratio) ** 2))


@kills("solvers.synchronous.peaks:maxima", "math.sqrt(0.5)", "0.5")
@kills("solvers.synchronous.peaks:maxima", "/ (high - low)", "/ (high + low)")
@kills(
    "solvers.synchronous.peaks:maxima",
    "- float(speed[-1])) / abs(float(speed[-1]))",
    "- float(speed[-1])) / abs(float(x[k]))",
)
@pytest.mark.parametrize("damping", [0.01, 0.05, 0.15])
def test_maxima_as_standards_judge_them(damping: float) -> None:
    speed = np.linspace(0.3, 2.0, 20001)
    (found,) = maxima(40.0 * speed, unbalanced(speed, damping))
    # Of s = r^2 the half-power points solve s^2 = A^2/2 ((1 - s)^2 + 4 zeta^2 s), where
    # A^2 = 1/(4 zeta^2 (1 - zeta^2)).
    half = 1.0 / (8.0 * damping**2 * (1.0 - damping**2))
    low, high = np.sqrt(np.sort(np.roots([half - 1.0, half * (4.0 * damping**2 - 2.0), half])))
    top = 1.0 / math.sqrt(1.0 - 2.0 * damping**2)
    # To a step of the speeds, of the width that the factor divides by.
    step = 1.7 / 20000
    assert found.speed == pytest.approx(40.0 * top, abs=40.0 * step)
    assert found.amplification_factor == pytest.approx(top / (high - low), rel=2.0 * step / (high - low))
    assert found.separation_margin == pytest.approx((2.0 - top) / 2.0, abs=step)


def test_ripples_and_ends_are_no_maxima() -> None:
    speed = np.linspace(0.3, 2.0, 200)
    assert maxima(speed, unbalanced(speed, 0.9)) == ()  # rises to its end
    assert maxima(speed, np.ones(200)) == () and maxima(speed[:2], speed[:2]) == ()
    curve = unbalanced(speed, 0.05)
    rippled = curve * (1.0 + 1e-3 * (-1.0) ** np.arange(200))
    assert len(maxima(speed, rippled)) == 1
    endless = np.where(np.arange(200) == 80, math.inf, curve)
    (found,) = maxima(speed, endless)
    assert math.isinf(found.amplification_factor) and found.speed == speed[80]
    # What has no answer is left out.
    assert maxima(speed, np.where(np.arange(200) % 7 == 3, math.nan, curve))[0].amplitude <= curve.max()
    # One that falls by less than to its half-power band counts, without a factor.
    two = np.array([0.0, 1.0, 0.85, 1.2, 0.0])
    first, second = maxima(np.arange(1.0, 6.0), two)
    assert math.isnan(first.amplification_factor) and second.amplification_factor > 0.0
