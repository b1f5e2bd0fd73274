"""Seeded faults of the two layers, and their oracles, run as plain Python by `test_uncompiled.py`."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fluid import pool as closures
from fluid.fill import Fill
from fluid.friction.laws import Friction
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from solvers.layer import two_layer_step
from solvers.layer.records import records
from solvers.layer.two_layers import TAKEN
from tests.mutants import kills
from tests.solvers.layer.two_layer_drums import COMPUTED, WATER, Drum

_STEP = "solvers.layer.two_layer_step:"
_RATES = "solvers.layer.two_layer_step:_rates"
_SOURCES = "solvers.layer.two_layer_step:_sources"
_MEASURE = "solvers.layer.two_layer_step:measure"
PLAIN = Fill(Chamber(0.24, 1.0), WATER, COMPUTED.volume)


def rates(drum: Drum, dt: float = 0.0) -> Array:
    """Rates of change of a drum's state, shape (4, n)."""
    turn, rate = np.zeros((2, drum.cells)), np.zeros((4, drum.cells))
    stream = drum.stream
    two_layer_step.turnings(drum.flow, stream.full, 0.0, turn)
    given = drum.flow, turn, *drum.force, drum.angles, stream.full, stream.slot, stream.rim, dt, drum.work
    two_layer_step._rates(*given, rate)
    return rate


def waving(cells: int, unlike: float = 0.0, fill: Fill = PLAIN) -> Drum:
    """A ring with waves all round, of two layers whose speeds differ; in a gap, that fills it."""
    drum = Drum(fill, cells=cells)
    first, second = np.arctan2(drum.angles[1], drum.angles[0]), drum.mean
    if fill.chamber.inner_radius:
        second = 1.2 * drum.stream.full
    one, two = second * (0.4 + 0.1 * np.cos(first)), second * (0.6 + 0.1 * np.sin(2.0 * first))
    rest = 1.0 - one - two
    drum.flow[:2] = one, two
    drum.flow[2] = one * rest * (30.0 + np.cos(first) - unlike)
    drum.flow[3] = two * rest * (30.0 + np.sin(first) + unlike)
    return drum


@kills(_RATES, "drop = (1.0 - share) * drop if dried else drop", "drop = drop")
@kills(_RATES, "edge = min(pull[left], pull[f])", "edge = max(pull[left], pull[f])")
@kills(_RATES, "wanted = _area_at(level, edge, rim, full, slot)", "wanted = whole")
def test_rest() -> None:
    """No rates in a pool at rest, full gap or not; a slope where it is not level."""
    for fill in (COMPUTED, PLAIN):
        drum = Drum(fill, cells=48)
        drum.lie()
        assert np.abs(rates(drum)).max() < 1e-11
        # Deeper by a cell's worth on one side: what the middle feels is the slope of the level.
        middle = int(np.argmax(drum.pull))
        if fill is PLAIN:
            drum.flow[1, middle - 3 : middle] *= 1.02
            slope = rates(drum)
            assert slope[3, middle] > 0.0 > slope[3, middle - 3]


@kills(_RATES, "max(much - 2.0, 0.0)", "much")
@kills(_RATES, "asked = 1.0 - stiff * (1.0 - most / abs(jump))", "asked = 1.0")
@kills(_RATES, "share = min(1.0, 2.0 * own / (whole + 1e-300))", "share = 1.0")
def test_rounding_does_not_grow() -> None:
    """A shallow shore cell beside a deep one, a gap that begins to be full: nothing grows."""
    plates = Baffles(6, 0.24 * 0.97)
    half = Chamber(0.24, 0.06, 0.12, baffles=plates)
    shore = Fill(half, WATER, 0.1640625 * half.capacity)
    bare = replace(half, baffles=None)
    nearly = Fill(bare, WATER, 0.4453125 * bare.capacity)
    narrow = Chamber(0.24, 0.06, 0.20, baffles=Baffles(6, 0.24 * 0.97))
    for fill, down, cells, time in (
        (shore, 0.0, 32, 0.5),
        (COMPUTED, math.pi, 64, 0.03),
        (nearly, 0.0, 32, 0.05),
        (Fill(narrow, WATER, 0.252 * narrow.capacity), math.pi, 16, 0.3),
    ):
        drum = Drum(fill, down=down, cells=cells)
        drum.lie()
        drum.flow[2:] = 1e-9 * drum.flow[:2] * np.sin(np.arctan2(drum.angles[1], drum.angles[0]))
        drum.go(time)
        assert np.abs(drum.flow[2:]).max() < 1e-8


@kills(_RATES, "beyond > 0.0 and still > 0.0", "beyond > 0.0")
@kills(_RATES, "weighs + between * r", "between * r")
def test_what_hangs_is_pressed_and_not_pulled() -> None:
    """Liquid that fills a gap above the axis: by its weight alone, or under the pressure that it has."""
    drum = Drum(COMPUTED, cells=96)
    angle, full = np.arctan2(drum.angles[1], drum.angles[0]), drum.stream.full
    lies, step = np.abs(angle) < 0.7, 2.0 * math.pi / 96
    # Too little pressure to hold it: each cell has its own weight along the wall.
    drum.flow[1] = np.where(lies, full + 2e-4, 0.01)
    own = drum.gravity / 0.24 * drum.angles[1] * drum.flow[1] * drum.stream.rim
    assert np.abs(rates(drum)[3] - own)[lies].max() < 1e-2
    # More of it in the middle, and less than full beside it: that pressure pushes either half.
    drum.flow[1] = np.maximum(full + 0.1 * np.cos(2.0 * np.clip(angle, -1.57, 1.57)), 0.01)
    half = angle > 0.0
    pressure = drum.stream.slot * 0.1 + closures.static_pressure(drum.stream.rim, drum.pull.min())
    found = step * rates(drum)[3, half].sum()
    weighs = drum.gravity / 0.24 * step * np.sum((drum.angles[1] * drum.flow[1])[half])
    assert found == pytest.approx(pressure + weighs, abs=0.02 * pressure)


@kills(_RATES, "counts * free[i]", "free[i]")
@kills(_RATES, "counts * free[i]", "0.0 * free[i]")
@kills("solvers.layer.two_layer_step:_counted", "lowered + max(power, 0.0)", "0.0")
def test_what_flies_is_held_back_where_it_spreads() -> None:
    """A lump that flies above the axis as it is keeps what turns it; one that thins out gets no energy."""
    drum = Drum(PLAIN, cells=192)
    angle = np.arctan2(drum.angles[1], drum.angles[0])
    above = np.abs(angle) < 1.0
    area = np.where(above, 0.02 + 0.1 * np.cos(0.5 * math.pi * angle) ** 2, 0.0)
    for spread in (0.0, 0.8, -0.8):
        drum.flow[1] = area
        drum.flow[3] = area * (1.0 - area) * (1.0 + spread * angle)
        rate, begin, tiny = rates(drum), drum.energy(), 1e-7
        moment = drum.flows()
        torque = moment.moment_x * drum.force[1] - moment.moment_y * drum.force[0]
        turned = rate[2:].sum() * 2.0 * math.pi / 192
        drum.flow += tiny * rate
        gained = (drum.energy() - begin) / tiny
        assert gained < 0.0
        if spread <= 0.0:
            assert abs(turned - torque) < 1e-12


def test_a_level_pool_is_no_cliff() -> None:
    """One that leans a little and gives way is driven back by its whole weight's torque."""
    drum, leaning = Drum(PLAIN, cells=192), Drum(PLAIN, down=math.pi + 0.1, cells=192)
    leaning.lie()
    drum.flow[:] = leaning.flow
    moment = drum.flows()
    torque = moment.moment_x * drum.force[1] - moment.moment_y * drum.force[0]
    drum.flow[3] = math.copysign(1e-9, torque) * drum.flow[1]
    found = rates(drum)[2:].sum() * 2.0 * math.pi / 192
    # 25 cells to either side, of which a shore may be off by half a one.
    assert found == pytest.approx(torque, rel=0.5 / 25.0)


@kills(_RATES, "mean * radius + edge > 0.0 or (", "edge > 0.0 or (")
@kills("solvers.layer.two_layer_step:turnings", "(rest * a) if a", "a if a")
def test_spun_ring() -> None:
    """The exact offset of a fast ring is steady, with all of it in either layer."""
    for layer in range(2):
        drum = Drum(PLAIN, cells=64)
        drum.force *= 0.1
        a, spin = drum.mean, 60.0
        area = a - a * math.sqrt(1.0 - 2.0 * a) * drum.pull / spin**2
        drum.flow[layer], drum.flow[2 + layer] = area, area * (1.0 - area) * spin * (2.0 - area / a)
        found, cosine = rates(drum), drum.angles[0]
        force = a * 0.5 * abs(drum.force[0])
        # Rates along cos and sin theta beside what gravity alone would do.
        for row in (drum.angles[0], drum.angles[1]):
            assert abs(found[2 + layer] @ row) / (force * drum.cells) < 3e-3
        assert abs(found[layer] @ cosine) * spin / (force * drum.cells) < 3e-3


@kills(_RATES, "turning = 0.5 * mean", "turning = 0.25 * mean")
@kills(_RATES, "back_1, back_2 = rest * w_1, rest * w_2", "back_1, back_2 = rest * w_1, w_2")
@kills(_RATES, "between = 0.5 * (min(whole, full) + min(own, full))", "between = 0.5 * min(own, full)")
@kills(_RATES, "0.5 * rise * flow[k, i] * (turn[k, i] ** 2 - square)", "0.0 * rise * flow[k, i] * square")
@kills(
    _RATES,
    "0.5 * rise * flow[k, i] * (turn[k, i] ** 2 - square)",
    "rise * flow[k, i] * (turn[k, i] ** 2 - square)",
)
def test_energy_of_unlike_layers() -> None:
    """Smooth waves of two layers of unlike speed keep their energy, but for the scheme's spreading."""
    for unlike in (-4.0, 4.0):
        gained = []
        for cells in (48, 96, 192):
            drum = waving(cells, unlike)
            rate, begin, tiny = rates(drum), drum.energy(), 1e-7
            drum.flow += tiny * rate
            gained.append((drum.energy() - begin) / tiny / begin)
        # Steep slopes take a little, limited ones spread by the square of a cell; wrong terms give 0.1.
        assert -1e-3 < gained[2] <= 0.0 and abs(gained[2] - gained[1]) < 0.27 * abs(gained[1] - gained[0])


@kills(_RATES, "mean * whole**2 if beyond == 0.0 else 0.0", "mean * min(whole, full) ** 2")
@kills(_RATES, "rise = min(flow[0, after] + flow[1, after], full)", "rise = flow[0, after] + flow[1, after]")
def test_energy_of_unlike_layers_in_a_full_gap() -> None:
    """A full gap with waves in the speeds of both layers: what turns weighs on no surface there."""
    for unlike in (-4.0, 4.0):
        gained = []
        for cells in (48, 96):
            drum = waving(cells, unlike, COMPUTED)
            rate, begin, tiny = rates(drum), drum.energy(), 1e-7
            drum.flow += tiny * rate
            gained.append((drum.energy() - begin) / tiny / begin)
        assert abs(gained[1]) < 0.02 and gained[1] < 0.5 * abs(gained[0])


@kills(_RATES, "min(least_2, two, flow[1, i])", "min(least_2, two)")
def test_what_passes_has_the_velocity_of_where_it_comes_from() -> None:
    """No cell gets a velocity that its neighbours have not: level layers, some hardly there; thin ones."""
    draw, cells = np.random.default_rng(1), 32
    pool, ring = Drum(PLAIN, cells=cells), Drum(PLAIN, gravity=1e-9, cells=cells)
    pool.lie()
    hardly = np.where(draw.random(cells) < 0.5, 1e-5, 0.5)
    layers = pool.flow.sum(axis=0) * np.array([1.0 - hardly, hardly])
    # Of the ring what turns weighs as its depth, a thousandth; it goes either way round.
    thin = 1e-3 * draw.uniform(0.1, 1.9, (2, cells))
    for drum, areas, least, most, fastest in (
        (pool, layers, -1e-6, 1e-6, math.sqrt(9.81 / 0.24)),
        (ring, thin, 20.0, 40.0, 40.0),
        (ring, thin, -40.0, -20.0, 40.0),
    ):
        rest, dt = 1.0 - areas.sum(axis=0), 0.2 * 2.0 * math.pi / cells / fastest
        drum.flow[:2], drum.flow[2:] = areas, areas * rest * draw.uniform(least, most, (2, cells))
        after = drum.flow + dt * rates(drum, dt)
        wet = areas.sum(axis=0) > 1e-4
        found = after[2:, wet] / (after[:2, wet] * (1.0 - after[:2, wet].sum(axis=0)))
        allowed = 0.01 * (most - least)
        assert least - allowed <= found.min() and found.max() <= most + allowed


@kills(_RATES, "flows_1 * back_1 + comes_1 * ahead_1 + spreads_1", "mass_1 * back_1")
@kills(_RATES, "flows_2 * back_2 + comes_2 * ahead_2 + spreads_2", "mass_2 * back_2")
def test_streams_that_meet_collide() -> None:
    """Where as much comes from either side nothing passes, and either stream is stopped by the other."""
    drum = Drum(PLAIN, gravity=1e-9, cells=32)
    for layer in range(2):
        for way in (1.0, -1.0):
            area = np.full(32, 1e-3)
            turning = np.where(np.arange(32) < 16, way, -way) * 2.0
            drum.flow[:] = 0.0
            drum.flow[layer], drum.flow[2 + layer] = area, area * (1.0 - area) * turning
            rate, step = rates(drum), 2.0 * math.pi / 32
            meets, apart = (15, 31) if way > 0.0 else (31, 15)
            hits = area[0] * (1.0 - area[0]) * 4.0 / step
            # A little is waves, which are as fast as the root of the depth lets them.
            assert rate[2 + layer, meets] == pytest.approx(-hits, rel=0.05)
            assert rate[2 + layer, (meets + 1) % 32] == pytest.approx(hits, rel=0.05)
            assert rate[layer, meets] == pytest.approx(area[0] * 2.0 / step, rel=0.1)
            assert abs(rate[2 + layer].sum()) < 1e-12 and abs(rate[2 + layer, 5]) < 1e-9
            assert abs(rate[2 + layer, apart] - hits) < 0.05 * hits


@kills(_RATES, "back_1 if spreads_1 > 0.0 else ahead_1", "ahead_1 if spreads_1 > 0.0 else back_1")
@kills(_RATES, "back_2 if spreads_2 > 0.0 else ahead_2", "ahead_2 if spreads_2 > 0.0 else back_2")
@kills(_RATES, "spreads_2 = mass_1 - flows_1 - comes_1, mass_2 - flows_2 - comes_2", "spreads_2 = 0.0, 0.0")
def test_what_spreads_has_the_velocity_of_where_it_comes_from() -> None:
    """Shallow liquid that runs away from deep liquid gets mass, and what momentum that had there."""
    drum = Drum(PLAIN, gravity=1e-9, cells=32)
    for layer in range(2):
        for way in (1, -1):
            deep = (way * np.arange(32)) % 32 >= 16
            area = np.where(deep, 1e-2, 1e-3)
            drum.flow[:] = 0.0
            drum.flow[layer] = area
            for behind in (0.0, 1.0):
                turning = way * np.where(deep, behind, 2.0)
                drum.flow[2 + layer] = area * (1.0 - area) * turning
                rate, gone = rates(drum), 2.0 * area[0] * 32 / (2.0 * math.pi)
                comes = rate[layer, 0] + gone
                gets = rate[2 + layer, 0] + 2.0 * way * (1.0 - area[0]) * gone
                assert comes > 2.0 * gone
                # Waves even out the rest, pressure of what turns and all.
                assert gets == pytest.approx(way * behind * comes, rel=0.1, abs=0.05 * comes)


@kills(_RATES, "asked = 1.0 - slow", "asked = 1.0")
def test_slow_liquid_does_not_spread_up_a_slope() -> None:
    """A film above either shore of a resting pool runs down into it, and nothing runs up out of the pool."""
    drum = Drum(PLAIN, cells=32)
    drum.lie()
    whole = drum.flow[:2].sum(axis=0)
    dry = np.flatnonzero(whole == 0.0)
    shores = [k for k in dry if whole[(k - 1) % 32] > 0.0 or whole[(k + 1) % 32] > 0.0]
    assert len(shores) == 2 and (drum.pull[shores] > 0.0).all()
    drum.flow[0, shores] = 1e-4
    assert (rates(drum, 1e-3)[:2].sum(axis=0)[shores] <= 0.0).all()


@kills(_MEASURE, "+ r * (whole - held)", "+ 0.0 * whole")
@kills(_MEASURE, "slot * beyond * beyond / full", "0.9 * slot * beyond * beyond / full")
def test_energy_of_a_little_more_is_its_level() -> None:
    """Height and pressure answer more liquid by the level, full gap or not [theory: pool, eq. 11]."""
    for fill in (PLAIN, COMPUTED):
        drum, tiny = Drum(fill, cells=48), 1e-7
        drum.lie()
        begin, whole, stream = drum.energy(), drum.flow[:2].sum(axis=0), drum.stream
        for cell in np.flatnonzero(whole > 1e-3).tolist():
            more = Drum(fill, cells=48)
            more.flow[:] = drum.flow
            more.flow[1, cell] += tiny
            surface = two_layer_step._surface(whole[cell], stream.full)
            level = two_layer_step._level(whole[cell], surface, drum.pull[cell], stream.full, stream.slot)
            found = (more.energy() - begin) / tiny / (2.0 * math.pi / 48)
            assert found == pytest.approx(-level, rel=1e-4, abs=1e-4)


@kills(_RATES, "one = min(one, whole) if flow[1, i] > DRY else whole", "one = min(one, whole)")
def test_which_layer_holds_it_does_not_matter() -> None:
    """A tilted pool that lies in the lower layer, in the upper one or in both: one flow of the whole."""
    found = []
    for share in (0.0, 0.5, 1.0):
        drum = Drum(PLAIN, down=math.pi + 0.05, cells=32)
        drum.lie()
        whole = drum.flow.sum(axis=0)
        drum.flow[:] = (1.0 - share) * whole, share * whole, 0.0 * whole, 0.0 * whole
        drum.force = np.array([-9.81 / 0.24, 0.0])
        rate = rates(drum, 1e-3)
        found.append([rate[:2].sum(axis=0), rate[2:].sum(axis=0)])
    np.testing.assert_allclose(found[0], found[2], atol=1e-12)
    np.testing.assert_allclose(found[1], found[2], atol=1e-12)


@kills(_RATES, "work[_EDGE, i] = flow[k, i] / out if out > flow[k, i] else 1.0", "work[_EDGE, i] = 1.0")
def test_no_cell_gives_more_than_it_has() -> None:
    """A thin cell that runs out: no area below zero, and what it gives arrives."""
    drum = Drum(PLAIN, cells=16)
    drum.flow[1, 5], drum.flow[3, 5] = 0.01, 0.01 * 40.0
    whole = drum.flow[:2].sum()
    rate = rates(drum, 0.02)
    assert (drum.flow[:2] + 0.02 * rate[:2]).min() > -1e-15
    assert rate[:2].sum() == pytest.approx(0.0, abs=1e-12)
    drum.go(0.02)
    assert drum.flow[:2].sum() == pytest.approx(whole, rel=1e-12)


def sources(drum: Drum, spin: float, dt: float) -> np.record:
    """Exchange and drag alone over a time; what was taken."""
    taken, table = records(TAKEN)[0], np.zeros((2, 2))
    heavy = float(np.hypot(*drum.force))
    two_layer_step._sources(drum.flow, drum.pull, spin, drum.stream, table, heavy, drum.is_ring, dt, taken)
    return taken


@kills(
    _SOURCES,
    "plates_1 = 0.5 * often * width * slip_1 * lever * thin",
    "plates_1 = often * width * slip_1 * thin",
)
@kills(_SOURCES, "plates_2 = 0.5 * often * width * slip_2", "plates_2 = 0.5 * often * width * slip_1")
@kills(_SOURCES, "held / (held + length * slip_2", "held / (held + 0.0 * length * slip_2")
@kills(_SOURCES, "wall_1 = _shear(stream, table, slip_1, depth)", "wall_1 = 0.0")
@kills(_SOURCES, "torque += drag_1 * (spin - last_1)", "torque -= drag_1 * (spin - last_1)")
@kills(
    _SOURCES, "lost += dt * plates_2 * (spin - last_2) ** 2", "lost -= dt * plates_2 * (spin - last_2) ** 2"
)
def test_drag() -> None:
    """Torques of an instant by their formulas; what the drum gives is momentum, its heat positive."""
    drum, dt = Drum(COMPUTED, Friction("quadratic", 0.002), cells=16), 1e-9
    stream, often = drum.stream, 8.0 / (2.0 * math.pi)
    one, two = np.full(16, stream.tip), np.full(16, 0.03)
    rest = 1.0 - one - two
    drum.flow[:] = one, two, one * rest * 5.0, two * rest * 2.0
    begin = drum.flow[2:].sum()
    taken = sources(drum, 20.0, dt)
    step = 2.0 * math.pi / 16.0
    assert (drum.flow[2:].sum() - begin) * step == pytest.approx(taken.torque, rel=1e-6)
    depth = 1.0 - np.sqrt(1.0 - 2.0 * (one + two))
    mean = (one * 25.0 + two * 4.0) / (one + two)
    weight = np.maximum(mean + drum.pull, 0.0) * depth
    share = (depth - stream.tip) / depth
    length = np.minimum(depth * (1.0 / ((0.58 + 0.42 * share**3) * share) - 1.0) ** 2, 20.0 * stream.tip)
    length /= 1.0 + length * 18.0**2 / (2.0 * 0.6 * stream.tip * weight + 1e-300)
    first = 0.5 * often * 2.4 * stream.tip * (1.0 - 0.5 * stream.tip) * 15.0 * 15.0
    second, wall = 0.5 * often * length * 18.0 * 18.0, 0.002 * 15.0 * 15.0
    lids = stream.lid * 0.002 * (15.0**2 * one + 18.0**2 * two) * rest
    assert taken.torque / dt == pytest.approx(step * np.sum(first + second + wall + lids), rel=1e-6)
    assert taken.baffles / dt == pytest.approx(step * np.sum(first * 15.0 + second * 18.0), rel=1e-6)
    heat = wall * 15.0 + stream.lid * 0.002 * (15.0**3 * one + 18.0**3 * two) * rest
    assert taken.heat / dt == pytest.approx(step * np.sum(heat), rel=1e-6)


@kills(_SOURCES, "width = max(closures.DRAG * plate, vented)", "width = closures.DRAG * plate")
@kills(_SOURCES, "held / (held + length * slip_1", "held / (held + 0.0 * length * slip_1")
def test_drag_between_high_bars() -> None:
    """The stream of a full gap past high bars is pushed as the pool is; where the air comes in it is not."""
    for speed, pushed in ((0.3, True), (300.0, False)):
        chamber = Chamber(0.24, 1.0, 0.20, baffles=Baffles(8, 0.217))
        drum, dt = Drum(Fill(chamber, WATER, 0.02), cells=16), 1e-12
        one, full = drum.stream.tip, drum.stream.full
        drum.flow[0], drum.flow[1] = one, full - one
        taken, below = sources(drum, speed, dt), drum.pull > 1.0
        given = drum.flow[2] / dt / (0.5 * 8.0 / (2.0 * math.pi) * speed**2 * (1.0 - 0.5 * one) * one)
        high, depth = 1.0 - one / (1.0 - drum.stream.rim), 1.0 - drum.stream.rim
        orifice = depth * (1.0 / ((0.58 + 0.42 * high**3) * high) - 1.0) ** 2 / one
        assert orifice > 2.0 * 2.4 and taken.torque > 0.0
        weight = 1.2 * one * drum.pull[below] * depth
        length = orifice * one
        vented = length / (1.0 + length * speed**2 / weight) / one if pushed else 2.4
        np.testing.assert_allclose(given[below], vented, rtol=1e-3)


@kills(_STEP + "_drained", "flow[3 - k, i] += flow[2 + k, i] - own", "pass")
@kills(_STEP + "_drained", "flow[k, i] < 0.5 * had[k, i]", "flow[k, i] < had[k, i]")
@kills(_STEP + "_drained", "flow[2 + k, i] = own", "pass")
def test_drained() -> None:
    """A layer that leaves a cell leaves no more than its velocity there, and nothing is lost."""
    drum = Drum(COMPUTED, cells=16)
    had, turn = np.full((4, 16), 0.02), np.full((2, 16), 3.0)
    drum.flow[:] = np.array([[1e-9], [0.03], [0.01], [0.06]])
    drum.flow[:, 8:] = drum.flow[[1, 0, 3, 2], 8:]
    drum.flow[0, 0] = 0.011
    begin = drum.flow.copy()
    two_layer_step._drained(drum.flow, had, turn, drum.stream.full)
    rest = 1.0 - drum.flow[:2].sum(axis=0)
    np.testing.assert_allclose(drum.flow[2:].sum(axis=0), begin[2:].sum(axis=0), rtol=1e-14)
    np.testing.assert_array_equal(drum.flow[:2], begin[:2])
    np.testing.assert_allclose((drum.flow[2] / rest)[1:8], 3e-9, rtol=1e-12)
    np.testing.assert_allclose((drum.flow[3] / rest)[8:], 3e-9, rtol=1e-12)
    np.testing.assert_array_equal(drum.flow[2:, 0], begin[2:, 0])


@kills(_SOURCES, "between = 0.125 * closures.INTERFACE * abs(w_2 - w_1)", "between = 0.0")
def test_between_the_layers() -> None:
    """What one layer loses to the other it gains, by the formula, and energy is lost."""
    drum, dt = Drum(COMPUTED, cells=16), 1e-9
    one, two = np.full(16, drum.stream.tip), np.full(16, 0.6 * drum.stream.tip)
    rest = 1.0 - one - two
    drum.flow[:] = one, two, one * rest * 6.0, two * rest * 2.0
    # The drum turns with the stream: no drag on it, and none on the pool where its back has no pressure.
    begin, before = drum.flow.copy(), drum.flows().energy
    taken = sources(drum, 8.0, dt)
    gained = (drum.flow[3] - begin[3]) / dt
    given = 0.125 * 0.012 * 4.0 * 4.0
    above = drum.pull < -40.0 * 0.7
    np.testing.assert_allclose(gained[above], given, rtol=1e-5)
    lost = (begin[2] - drum.flow[2]) / dt
    own = 0.5 * 8.0 / (2.0 * math.pi) * 2.4 * one * (1.0 - 0.5 * one) * 4.0
    np.testing.assert_allclose(lost, given - own, rtol=1e-5)
    assert before - drum.flows().energy + 8.0 * taken.torque > taken.heat + taken.baffles


@kills(_SOURCES, "max(closures.RENEWED * often * abs(spin - w)", "max(often * abs(w)")
@kills(_SOURCES, "most = max(closures.DEPTH * stream.tip, open_ * film)", "most = open_ * film")
@kills(_SOURCES, "spun = flow[3, i] * moved / flow[1, i]", "spun = 0.0")
@kills(
    _SOURCES,
    "_shear(stream, table, speed, 1.0) * speed",
    "_shear(stream, table, speed, 1.0)",
)
@kills(_SOURCES, "closures.DRAWN * _shear", "0.5 * closures.DRAWN * _shear")
def test_exchange() -> None:
    """The stream is renewed once a passage beside baffles; a smooth wall draws in what its shear does."""
    for fill, friction in ((COMPUTED, Friction()), (PLAIN, Friction("quadratic", 0.002))):
        drum, dt = Drum(fill, friction, cells=16), 1e-7
        most = drum.stream.tip if fill is COMPUTED else 0.002 * 30.0**2 / (9.81 / 0.24)
        one, two = np.full(16, 0.5 * most), np.full(16, 0.05)
        rest = 1.0 - one - two
        drum.flow[:] = one, two, one * rest * 6.0, two * rest * 2.0
        sources(drum, 30.0, dt)
        pace = 8.0 / (2.0 * math.pi) * 24.0 if fill is COMPUTED else 2.72 * 0.002 * 28.0 / most
        np.testing.assert_allclose((drum.flow[0] - one) / dt, (most - one) * pace, rtol=1e-4)
        np.testing.assert_allclose(drum.flow[:2].sum(axis=0), one + two, rtol=1e-13)
        if fill is PLAIN:
            # What it takes out of the pool has the pool's speed.
            drum.stream.lid = 0.0
            drum.flow[:] = one, two, one * rest * 2.0, two * rest * 2.0
            sources(drum, 30.0, dt)
            given = (two * rest * 2.0 - drum.flow[3]) / dt
            np.testing.assert_allclose(given, 2.0 * rest * (most - one) * pace, rtol=1e-4)
        # All that exceeds the depth goes to the pool at once, with its momentum.
        drum.flow[:] = one + most, two, (one + most) * (rest - most) * 30.0, two * (rest - most) * 30.0
        sources(drum, 30.0, dt)
        np.testing.assert_allclose(drum.flow[0], most)
        np.testing.assert_allclose(drum.flow[2:] / drum.flow[:2], 30.0 * (rest - most)[0], rtol=1e-9)


@kills(_SOURCES, "1.0 - closures.SHELTERS * often * stream.tip", "1.0 - 0.2 * often * stream.tip")
def test_low_bars_shelter_the_wall_beside_them() -> None:
    """Between low bars the wall draws its own film, on what they leave of it, fifteen heights each."""
    low = replace(COMPUTED, chamber=replace(COMPUTED.chamber, baffles=Baffles(8, 0.24 * 0.99)))
    drum = Drum(low, Friction("quadratic", 0.002), cells=16)
    one, two = np.full(16, 0.06), np.full(16, 0.02)
    rest = 1.0 - one - two
    drum.flow[:] = one, two, one * rest * 30.0, two * rest * 30.0
    sources(drum, 30.0, 1e-9)
    film = 0.002 * 30.0**2 / (9.81 / 0.24)
    np.testing.assert_allclose(drum.flow[0], (1.0 - 15.0 * 8.0 * 0.01 / (2.0 * math.pi)) * film, rtol=1e-9)


@kills("solvers.layer.two_layer_step:_spread", "nu += 0.5 * closures.SPREADS * depth", "nu += 0.0 * depth")
@kills("solvers.layer.two_layer_step:_spread", "least = min(", "least = max(")
def test_spreading() -> None:
    """Viscosity along the wall evens out each layer's speed and keeps its momentum; none beside nothing."""
    drum = waving(64, 4.0)
    turn, before = np.zeros((2, 64)), drum.flow.copy()
    two_layer_step.turnings(drum.flow, drum.stream.full, 0.0, turn)
    two_layer_step._spread(drum.flow, turn, drum.stream.full, 1e-6, drum.work)
    change = (drum.flow[2:] - before[2:]) / 1e-6
    np.testing.assert_allclose(change.sum(axis=1), 0.0, atol=1e-9)
    depth = 1.0 - np.sqrt(1.0 - 2.0 * drum.flow[:2].sum(axis=0))
    nu = 0.1 * depth * np.abs(turn[0] - turn[1])
    for k in range(2):
        ahead = 0.5 * (nu + np.roll(nu, -1)) * np.minimum(before[k], np.roll(before[k], -1))
        flux = ahead * (np.roll(turn[k], -1) - turn[k]) / (2.0 * math.pi / 64)
        np.testing.assert_allclose(change[k], (flux - np.roll(flux, 1)) / (2.0 * math.pi / 64), atol=1e-6)
    drum.flow[0], drum.flow[2] = 0.0, 0.0
    alone = drum.flow.copy()
    two_layer_step.turnings(drum.flow, drum.stream.full, 0.0, turn)
    two_layer_step._spread(drum.flow, turn, drum.stream.full, 1e-3, drum.work)
    np.testing.assert_array_equal(drum.flow, alone)


@kills(_MEASURE, "moved = flow[0, i] * turn[0, i] + flow[1, i]", "moved = flow[1, i]")
@kills(_MEASURE, "lever = 2.0 / 3.0 * held", "lever = 0.5 * held")
@kills(_MEASURE, "left = rest / (rest + slope * slope)", "left = rest / (rest + slope)")
@kills(_MEASURE, "light = whole / (rest * step)", "light = whole / step")
@kills(_MEASURE, "energy += 0.5 * step * slot * beyond * beyond / full", "energy += 0.0 * beyond")
@kills(_MEASURE, "inertia += step * whole * rest", "inertia += step * whole")
def test_measures() -> None:
    """Moments by quadrature; the flow is their rate; a force changes it by the inertia."""
    drum = waving(96)
    angle, area = np.arctan2(drum.angles[1], drum.angles[0]), drum.flow[:2].sum(axis=0)
    surface, step = np.sqrt(1.0 - 2.0 * area), 2.0 * math.pi / 96
    found = drum.flows()
    assert found.moment_x == pytest.approx(float(((1.0 - surface**3) / 3.0 * np.cos(angle)).sum()) * step)
    whole = np.sum((1.0 - surface**4) / 4.0) * step
    assert found.inertia == pytest.approx(float(whole))
    tiny, rate = 1e-6, rates(drum)
    free, bare = drum.flow.copy(), np.array([found.flow_x, found.flow_y])
    begin = np.array([found.moment_x, found.moment_y])
    drum.flow += tiny * rate
    after = drum.flows()
    moved = (np.array([after.moment_x, after.moment_y]) - begin) / tiny
    np.testing.assert_allclose(moved, bare, rtol=2e-2, atol=2e-2 * float(np.abs(bare).max()))
    first = np.array([after.flow_x, after.flow_y])
    drum.flow[:] = free
    drum.force += [20.0, 7.0]
    drum.flow += tiny * rates(drum)
    pushed = drum.flows()
    change = (np.array([pushed.flow_x, pushed.flow_y]) - first) / tiny
    wanted = [found.xx * 20.0 + found.xy * 7.0, found.xy * 20.0 + found.yy * 7.0]
    np.testing.assert_allclose(change, wanted, rtol=3e-2)
    # A gap filled beyond its room holds energy: what presses it together.
    full = Drum(COMPUTED, cells=16)
    full.flow[1] = full.stream.full * 1.05
    held = 2.0 * math.pi * 0.5 * full.stream.slot * (0.05 * full.stream.full) ** 2 / full.stream.full
    assert full.flows().energy == pytest.approx(held, rel=1e-9)


@kills("solvers.layer.two_layer_step:stands", "own * own * _surface", "own * _surface")
def test_a_ring_stands_by_its_own_rotation() -> None:
    """Up to sqrt(g/a) in either sense, whatever the drum does."""
    for share, holds in ((1.01, True), (-1.01, True), (0.99, False), (-0.5, False)):
        drum = Drum(replace(COMPUTED, volume=0.015))
        drum.spread(share * math.sqrt(9.81 / drum.fill.surface_radius))
        assert bool(two_layer_step.stands(drum.flow, *drum.force, drum.stream.full)) is holds
