"""No band of self-excited whirl is lost between two speeds, on any rotor."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from fluid.fill import Fill
from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from fluid.liquid import known_liquid
from fluid.whirl import plane_layer
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.system import Rotor
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.whirl import edges as whirl_edges
from solvers.whirl.edges import _changes, _first_speeds, _refine, _zero, any_growth, looks, unstable_bands
from solvers.whirl.growth import asynchronous_growth, modes_at, planar_layers
from solvers.whirl.system import coupled_matrices, linear_modes
from tests.mutants import kills
from tests.oracles.edges import undamped_edges

WATER = known_liquid("water")
Machine = tuple[Rotor, list[Fill], Friction, float, float]


def drawn(seed: int) -> Machine:
    """A rotor of some kind with liquid in one or two chambers, a law of friction and a range of speeds.

    Every third without damping of the supports, every second without friction, every eighth with baffles.
    """
    rng = np.random.default_rng([31, seed])
    kind = ("jeffcott", "two_plane", "two_plane", "tub")[seed % 4]
    mass, natural = 10.0 ** rng.uniform(0.5, 1.7), 10.0 ** rng.uniform(1.3, 2.3)
    stiff = mass * natural**2
    ratio = 0.0 if rng.random() < 0.33 else 10.0 ** rng.uniform(-3.0, -0.7)
    damping = 2.0 * ratio * mass * natural
    radius = rng.uniform(0.05, 0.2)
    baffles = (
        Baffles(int(rng.integers(3, 6)), radius * rng.uniform(0.93, 0.99)) if rng.random() < 0.125 else None
    )
    fills = []
    for _ in range(int(rng.integers(1, 3))):
        height, depth = radius * rng.uniform(0.2, 0.8), radius * 10.0 ** rng.uniform(-1.7, -0.5)
        chamber = Chamber(radius, height, plane=radius * rng.uniform(-2.0, 2.0), baffles=baffles)
        fills.append(Fill(chamber, WATER, math.pi * height * (radius**2 - (radius - depth) ** 2)))
    if kind == "jeffcott":
        rotor: Rotor = Jeffcott(mass, stiff, damping, 1e-3)
    elif kind == "two_plane":
        across = mass * radius**2 * rng.uniform(0.3, 3.0)
        share = rng.uniform(0.3, 0.7)
        places = (-radius * rng.uniform(0.5, 2.5), radius * rng.uniform(0.5, 2.5))
        supports = tuple(
            Support(z, part * stiff, part * damping)
            for z, part in zip(places, (share, 1 - share), strict=True)
        )
        polar = across * rng.uniform(0.1, 1.5)
        rotor = TwoPlane(mass, across, polar, supports, (PlaneUnbalance(0.0, 1e-3),))
    else:
        inertia = mass * radius**2 * rng.uniform(0.5, 2.0, 3)
        springs, dampers = [], []
        for _ in range(4):
            place = tuple(radius * rng.uniform(-1.5, 1.5, 3))
            springs.append(Mount(place, along_axes=tuple(0.25 * stiff * rng.uniform(0.3, 1.0, 3))))
            dampers.append(Mount(place, along_axes=tuple(0.25 * damping * rng.uniform(0.3, 1.0, 3))))
        rotor = Tub(
            0.7 * mass, 0.3 * mass, (inertia[0], inertia[1], inertia[2]), 0.3 * inertia[1], 0.2 * inertia[0],
            tuple(springs), tuple(dampers), 1e-3,
        )  # fmt: skip
    law = [
        NO_FRICTION,
        NO_FRICTION,
        Friction(FrictionLaw.LINEAR, 10.0 ** rng.uniform(-2.0, 0.7)),
        Friction(FrictionLaw.STOKES),
    ]
    return rotor, fills, law[int(rng.integers(0, 4))], 0.3 * natural, 6.0 * natural


def contradictions(seed: int, speeds: int) -> list[float]:
    """Speeds at which a whirl grows outside all bands or fades inside one, the edges themselves left out."""
    rotor, fills, friction, first, last = drawn(seed)
    asked = np.linspace(first, last, speeds)
    growth = asynchronous_growth(rotor, fills, asked, friction)[0]
    (bands,) = unstable_bands(rotor, [fills], asked[[0, -1]], friction)
    inside = np.zeros(speeds, dtype=bool)
    edge = np.isnan(growth)
    for low, high in bands:
        inside |= (asked >= low) & (asked <= high)
        edge |= np.minimum(np.abs(asked - low), np.abs(asked - high)) <= 1e-7 * asked
    return [float(x) for x in asked[~edge & (inside != (growth > 0.0))]]


def no_band_lost(seeds: range, speeds: int = 200) -> None:
    """No seed's bands contradict the growth at speeds that they were not found from."""
    for seed in seeds:
        assert not contradictions(seed, speeds), seed


@kills("solvers.whirl.edges:_refine", "(rates > 0.0) != first", "(rates > 0.0) == first")
def test_no_band_lost() -> None:
    """A sample of random machines: planar, on two planes, tubs, clear and beside baffles."""
    no_band_lost(range(10))


@pytest.mark.slow
def test_no_band_lost_in_200() -> None:
    """The same of 200 machines."""
    no_band_lost(range(200))


@kills("solvers.whirl.edges:_unsure", "[gap_there[:, None], rises", "[gap_there[:, None] & False, rises")
@kills("solvers.whirl.edges:_handed_over", "0.5 * (ceases + begins)", "0.0 * begins")
@kills("solvers.whirl.edges:_handed_over", "~(first & last).any(axis=1)", "(first & last).any(axis=1)")
def test_gap_between_two_modes() -> None:
    """Growth goes over from one mode to another within 0.4 % of the speed: between them nothing grows."""
    rotor, fills, friction, first, last = drawn(88)
    (bands,) = unstable_bands(rotor, [fills], np.array([first, last]), friction)
    assert len(bands) == 2
    (_, ceases), (begins, _) = bands
    assert 1.0 < begins / ceases < 1.004
    beside = np.array([ceases * (1 - 1e-6), ceases * (1 + 1e-6), begins * (1 - 1e-6), begins * (1 + 1e-6)])
    growth, whirl_speed = asynchronous_growth(rotor, fills, beside, friction)
    assert (growth > 0.0).tolist() == [True, False, False, True]
    assert whirl_speed[3] < 0.9 * whirl_speed[0]


#: Two planes, no damping: bands of 594 to 674 and 971 to 1428 rpm and a stable gap between.
GAPPED = TwoPlane(
    10.0, 0.05, 0.015, (Support(0.1, 1e4, 0.0), Support(-0.1, 1e4, 0.0)), (PlaneUnbalance(0.0, 1e-3),)
)
HALF = Fill(Chamber(0.06, 0.02, plane=0.15), WATER, 113.0973e-6)


@pytest.mark.parametrize("speeds", [60, 100, 2001])
def test_number_of_speeds(speeds: int) -> None:
    """Neither a band nor the gap between two is lost, however few speeds are asked for."""
    asked = np.linspace(20.0, 3000.0, speeds)
    growth = asynchronous_growth(GAPPED, [HALF], asked)[0]
    (bands,) = unstable_bands(GAPPED, [[HALF]], asked, growth=growth[None])
    (other,) = unstable_bands(GAPPED, [[HALF]], asked[[0, -1]])
    np.testing.assert_array_equal(bands, other)
    assert len(bands) == 2
    for low, high in bands:
        beside = np.array([low * (1 - 1e-8), low * (1 + 1e-8), high * (1 - 1e-8), high * (1 + 1e-8)])
        grows = asynchronous_growth(GAPPED, [HALF], beside)[0] > 0.0
        assert grows.tolist() == [False, True, True, False]
    # A grid of 0.4 rad/s, by the sign of the growth alone.
    fine = np.arange(50.0, 160.0, 0.4)
    grows = asynchronous_growth(GAPPED, [HALF], fine)[0] > 0.0
    edges = fine[1:][grows[1:] != grows[:-1]]
    np.testing.assert_allclose(np.ravel(bands), edges - 0.2, atol=0.2)


def test_films() -> None:
    """Bands of a film on two planes, as narrow as the film is thin, are gone to, each between two speeds.

    Without gyration the rotor's shift is a Jeffcott rotor whose film is in the plane of its centre of mass:
    its edges are those of the undamped planar rotor.
    """
    rotor = TwoPlane(
        6.0, 0.05, 0.0, (Support(0.1, 3e4, 0.0), Support(-0.1, 3e4, 0.0)), (PlaneUnbalance(0.0, 1e-3),)
    )
    for depth in (1e-4, 1e-6):
        chamber = Chamber(0.1, 0.02, plane=0.0)
        fill = Fill(chamber, WATER, math.pi * 0.02 * (0.1**2 - (0.1 - 0.1 * depth) ** 2))
        (bands,) = unstable_bands(rotor, [[fill]], np.array([30.0, 400.0]))
        mass, layers = planar_layers(6.0, [fill], NO_FRICTION)
        # Each edge to the half of the digits that a double root leaves.
        np.testing.assert_allclose(np.ravel(bands), undamped_edges(mass, 6e4, layers), rtol=1e-7)


@kills("solvers.whirl.edges:_gone_to", "for _ in range(_STEPS)", "for _ in range(0)")
@kills("solvers.whirl.edges:_meetings", "first * last < 0.0", "first * last < -np.inf")
@kills("solvers.whirl.edges:_pairs", "np.where(both, ", "np.where(~both, ")
def test_films_from_even_speeds(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no speed at which a wave meets a mode is known before, each meeting is gone to from between."""
    rotor = Jeffcott(6.0, 6e4, 0.0, 0.0)
    monkeypatch.setattr(whirl_edges, "_first_speeds", lambda *_: np.geomspace(31.0, 401.0, 33))
    for depth in (1e-4, 1e-6):
        fill = Fill(Chamber(0.1, 0.02), WATER, math.pi * 0.02 * (0.1**2 - (0.1 - 0.1 * depth) ** 2))
        (bands,) = unstable_bands(rotor, [[fill]], np.array([31.0, 401.0]))
        mass, layers = planar_layers(6.0, [fill], NO_FRICTION)
        edges = undamped_edges(mass, 6e4, layers)
        assert len(bands) == 1
        np.testing.assert_allclose(np.ravel(bands), edges, rtol=1e-7)


@kills("solvers.whirl.edges:_first_speeds", "mass=ratio**2 * mass", "mass=ratio * mass")
@kills("solvers.whirl.edges:_first_speeds", "gyroscopic=ratio * system", "gyroscopic=system")
@kills(
    "solvers.whirl.edges:_first_speeds", "way * math.sqrt(x.layer_tanh", "way * math.sqrt(2.0 * x.layer_tanh"
)
def test_meetings_of_waves() -> None:
    """Where a wave meets a mode both have one frequency, that of the layer alone and of the rotor alone."""
    system = GAPPED.system()
    layer = plane_layer(HALF, NO_FRICTION)
    assert layer is not None
    found = _first_speeds(system, [HALF], 20.0, 3000.0)
    even = np.geomspace(20.0, 3000.0, 1 + math.ceil(math.log(150.0) / 0.08))
    own = found[np.abs(found[:, None] - even).min(axis=1) > 1e-9 * found]
    # Two waves, each with rotors of two masses; a forward mode runs away from the faster wave.
    assert own.size >= 4
    # E of no friction has the zeros s of the free waves.
    slips = np.roots([1.0, -2.0 * layer.layer_tanh, -layer.layer_tanh])
    at = system.at(HALF.chamber.plane)
    heavy = replace(system, mass=system.mass + HALF.mass * at.T @ at)
    for speed in own:
        spin = np.array([speed])
        modes = np.concatenate(
            [linear_modes(coupled_matrices(one, [], spin), np.eye(4)).root[0].imag for one in (system, heavy)]
        )
        off = np.abs(np.abs(modes)[:, None] - np.abs(1.0 + slips) * speed).min()
        # Eigenvalues to some hundred roundings of the largest.
        assert off <= 1e-9 * speed


@kills("solvers.whirl.edges:_first_speeds", "rotor.mass + sum(x.mass", "rotor.mass - sum(x.mass")
@kills("solvers.whirl.edges:_first_speeds", "rotor.stiffness / mass) /", "rotor.stiffness / mass) *")
def test_meetings_in_one_plane() -> None:
    """A planar rotor has the speeds that its equations of motion in two directions have."""
    rotor = Jeffcott(6.0, 6e4, 20.0, 0.0)
    fills = [HALF, replace(HALF, volume=0.1 * HALF.volume)]
    own, general = (_first_speeds(one, fills, 20.0, 3000.0) for one in (rotor, rotor.system()))
    for found, other in ((own, general), (general, own)):
        assert (np.abs(found[:, None] - other).min(axis=1) <= 1e-12 * found).all()


@kills("solvers.whirl.edges:any_growth", "found[calm[row[rate > 0.0]]] = True", "pass")
def test_growth_without_edges(monkeypatch: pytest.MonkeyPatch) -> None:
    """Some whirl grows where bands are found; a film's band is seen only when it is looked for."""
    monkeypatch.setattr(whirl_edges, "_first_speeds", lambda *_: np.geomspace(31.0, 401.0, 33))
    rotor, speed = Jeffcott(6.0, 6e4, 0.0, 0.0), np.array([31.0, 401.0])
    volumes = math.pi * 0.02 * (0.1**2 - (0.1 - 0.1 * np.array([0.0, 1e-6, 1e-4, 0.3])) ** 2)
    rows = [[Fill(Chamber(0.1, 0.02), WATER, float(volume))] for volume in volumes]
    for law in (NO_FRICTION, Friction(FrictionLaw.STOKES)):
        bands = unstable_bands(rotor, rows, speed, law)
        np.testing.assert_array_equal(any_growth(rotor, rows, speed, law), [bool(own) for own in bands])


@kills("solvers.whirl.edges:_changes", "spread[1] < _SIDE_BY_SIDE", "spread[1] < 0.0")
@kills("solvers.whirl.edges:_changes", "paired(root + common)", "paired(root - common)")
def test_modes_side_by_side_keep_their_slopes() -> None:
    """Two that are nearer to one another than they change go on beside each other; two that cross do."""
    gap, change = 3e-8, 1e-6
    root = np.array([[1.0j, (1.0 + gap) * 1j, 2.0j, complex(np.nan, np.nan)]])
    np.testing.assert_allclose(_changes(root, root[:, [1, 2, 0, 3]] + change * 1j)[0, :3].imag, change)
    beside = np.array([[1.0j, (1.0 + gap - change) * 1j, 2.0j, complex(np.nan, np.nan)]])
    np.testing.assert_allclose(_changes(root, beside)[0, :3].imag, [0.0, -change, 0.0], atol=1e-14)


@kills("solvers.whirl.growth:modes_at", "parts(row, next_to, first)", "parts(row, speed, first)")
@kills(
    "solvers.whirl.sections:most_growing",
    "root[row, column], found[row, column] =",
    "_, found[row, column] =",
)
def test_modes_at_a_second_speed_are_those_found_there() -> None:
    """Followed from the first speed, by Newton's or Aberth's method, and found with a proof at the second."""
    beside, speed = 1e-4, np.array([90.0, 140.0, 210.0])
    cut = replace(HALF, chamber=replace(HALF.chamber, baffles=Baffles(4, 0.95 * HALF.chamber.radius)))
    planes = TwoPlane(6.0, 0.05, 0.03, (Support(-0.1, 3e4, 10.0), Support(0.1, 4e4, 10.0)), ())
    twins = [replace(HALF, chamber=replace(HALF.chamber, plane=z)) for z in (-0.05, 0.0, 0.08)]
    law = Friction(FrictionLaw.STOKES)
    for rotor, fills in (
        (planes, [HALF]),
        (planes, twins),
        (planes, [cut]),
        (Jeffcott(6.0, 6e4, 20.0, 0.0), [HALF]),
        (Jeffcott(6.0, 6e4, 20.0, 0.0), [cut]),
    ):
        at = np.zeros(speed.size, dtype=np.intp)
        _, (followed, _), _ = modes_at(rotor, [fills], at, speed, law, beside)
        (found, rounding), _, _ = modes_at(rotor, [fills], at, speed * (1.0 + beside), law, beside)
        gap = np.abs(followed[:, :, None] - found[:, None, :])
        nearest = np.where(np.isnan(gap), np.inf, gap).min(axis=2)[np.isfinite(followed)]
        # Both to rounding, of modes that go over the second speed by 1e-4.
        assert nearest.max() < 1e-9 * speed[-1] + np.nanmax(rounding)
        assert (np.isfinite(followed).sum(axis=1) == np.isfinite(found).sum(axis=1)).all()


@kills("solvers.whirl.edges:_zero", "speed[own] * ratio", "speed[own] / ratio")
@kills("solvers.whirl.edges:_zero", "seen[:, 1] == 0.0, np.nan", "seen[:, 1] == 0.0, 0.0")
@kills("solvers.whirl.edges:_zero", "(growth < 0.0).any", "(growth > 0.0).any")
def test_the_speed_of_no_growth_by_interpolation() -> None:
    """Exact where the speed is a cubic of the growth, whatever rounding made zero; not beyond the points."""
    growth = np.array([-3.0, -0.5, 0.2, 1.0, 2.0])
    speed = 7.0 + 0.2 * growth + 0.03 * growth**2 - 0.01 * growth**3
    hidden = np.append(speed, 7.1), np.append(growth, 0.0)
    found, off = _zero(np.stack(hidden, axis=1)[:, :, None])
    assert found[0] == pytest.approx(7.0, rel=1e-15)
    # What the quadratic through the three of least growth leaves, 0.01 times the product of their growths.
    assert off[0] == pytest.approx(0.01 * 0.5 * 0.2 * 1.0, rel=1e-12)
    assert np.isnan(_zero(np.stack([speed, np.abs(growth)], axis=1)[:, :, None])[0]).all()


@pytest.mark.parametrize("hidden", [0.0, 1e-8])
def test_an_edge_takes_few_calls(monkeypatch: pytest.MonkeyPatch, hidden: float) -> None:
    """Six, also where rounding makes growth zero up to a speed beyond the edge; in quarters seventeen."""
    calls: list[int] = []

    def growth(_: Any, __: Any, ___: Any, speed: np.ndarray, *____: Any) -> tuple[np.ndarray, np.ndarray]:
        calls.append(speed.size)
        rate = np.sin(0.3 * (speed - 97.0)) + 0.02 * (speed - 97.0) ** 2
        return np.where(np.abs(rate) <= hidden, 0.0, rate), speed

    monkeypatch.setattr(whirl_edges, "growth_at", growth)
    ends = np.array([[95.0], [98.0]])
    low, high = (np.stack([end, growth(None, [], None, end, None)[0]]) for end in ends)
    calls.clear()
    found = _refine(Jeffcott(1.0, 1.0, 0.0, 0.0), [], np.zeros(1, dtype=np.intp), low, high, NO_FRICTION, [])
    assert found[0] == pytest.approx(97.0 + hidden / 0.3, rel=1e-10)
    assert len(calls) <= 6


@kills("solvers.whirl.edges:_looked", "rounding <= _HIDDEN * speed", "rounding <= np.inf * speed")
def test_what_rounding_hides_is_not_followed() -> None:
    """On supports 1e9 times as stiff as the spin asks for, waves of a film are known to no digit."""
    supports = (Support(-0.1, 4e18, 1e4), Support(0.1, 3e18, 1e4))
    rotor = TwoPlane(10.0, 0.1, 0.05, supports, (PlaneUnbalance(0.0, 1e-3),))
    fill = Fill(Chamber(0.1, 0.05, plane=0.02), WATER, 1e-5)
    speed = looks(rotor, [[fill]], 1.0, 10.0, NO_FRICTION)[1]
    assert speed.size < 60
