"""What figures are drawn from: lags, units, branches, areas and moments of the liquid."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from leblanc.liquid.filled import FilledChamber
from leblanc.plotting import chambers, curves
from leblanc.studies.run import figure as run_figures
from tests.oracles.records import folded, rig

CHAMBER = FilledChamber(
    radius=0.065, inner_radius=0.0, height=0.02, volume=1e-5, liquid_name="water", mean_surface_radius=0.06376
)


def test_lags_stay_in_one_piece() -> None:
    angle = np.radians([0.0, -150.0, 180.0, -180.0, 170.0, 60.0, -400.0])
    size = np.array([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0])
    expected = [0.0, -150.0, -180.0, -180.0, -190.0, 60.0, -40.0]
    # A few roundings of numbers below 400.
    np.testing.assert_allclose(curves.lag_degrees(angle, size), expected, rtol=0, atol=1e-12)
    assert np.isnan(curves.lag_degrees(angle[:1], np.zeros(1))).all()


def test_curves_have_their_units() -> None:
    """60 rpm are 2 pi rad/s, 1 m is 1000 mm; speeds may come in any order."""
    record = rig(41)
    backwards = {
        name: value[::-1] if isinstance(value, np.ndarray) else value
        for name, value in vars(record.response).items()
    }
    r = record.response
    drawn = curves.prepare(replace(record, response=type(r)(**backwards)))
    np.testing.assert_allclose(drawn.rpm, r.speed * 60.0 / (2.0 * math.pi), rtol=1e-15)
    np.testing.assert_allclose(drawn.offset, r.liquid_offset * 1000.0, rtol=1e-15)
    np.testing.assert_allclose(drawn.amplitude_dry, np.abs(r.deflection_dry) * 1000.0, rtol=1e-15)
    np.testing.assert_allclose(drawn.amplitude * np.exp(1j * np.radians(drawn.phase)), r.deflection * 1000.0)
    # 350 rpm, half-way between two speeds of the grid at 337.5 and 385 rpm.
    np.testing.assert_allclose(drawn.out_of_range, [(100.0, 361.25)], rtol=1e-14)


def test_branches_are_followed_through_the_fold() -> None:
    """The upper branch is one smooth curve although its column changes where the fold begins."""
    w = folded(401).response.branch_deflection
    chain = curves.link(w)
    number = np.count_nonzero(~np.isnan(w), axis=1)
    begin, end = np.flatnonzero(np.diff(number)) + 1
    assert chain[begin - 1, 0] == chain[begin, 2] == chain[end - 1, 2]
    assert chain[end, 0] == chain[end - 1, 0] == chain[begin, 0]
    assert len({int(c) for c in chain[begin]}) == 3
    assert np.all((chain >= 0) == ~np.isnan(w))


def test_thinning_keeps_peaks_and_troughs() -> None:
    values = np.sin(np.linspace(0.0, 9.0, 50_000))
    values[[12_345, 31_000]] = 7.0, -7.0
    values[40_000:41_000] = values[12_400:12_410] = np.nan
    kept = curves.thin(values[:, None], 100)
    assert {0, 12_345, 31_000, 49_999} <= set(kept.tolist())
    assert kept.size <= 4 * 100
    assert np.all(np.diff(kept) > 0)


def test_spans_reach_half_way() -> None:
    x = np.array([0.0, 10.0, 20.0, 40.0])
    found = curves.spans(x, np.array([True, False, True, False]), (0.0, 40.0))
    assert found == [(0.0, 5.0), (15.0, 30.0)]
    assert curves.spans(x[:1], np.array([True]), (-1.0, 1.0)) == [(-1.0, 1.0)]
    assert curves.spans(x, np.zeros(4, dtype=np.bool_), (0.0, 40.0)) == []


def _moments(chamber: FilledChamber, centre: complex, depth: float) -> tuple[float, complex]:
    """Area and first moment of the outline by the polygon formulas."""
    angle, inner, outer = chambers.liquid_outline(chamber, centre, depth)
    z = np.concatenate([outer * np.exp(1j * angle), (inner * np.exp(1j * angle))[::-1]])
    cross = (np.conj(z) * np.roll(z, -1)).imag
    moment = np.sum((z + np.roll(z, -1)) * cross) / 6.0
    return float(np.sum(cross)) / 2.0, complex(moment)


def test_drawn_liquid_has_its_area_and_moment() -> None:
    """Area of the layer as drawn; its first moment about the rotation axis is pi R^2 e while the wall is wet
    [theory: statics]; with a dry patch it lies along the deflection, between that and area times R."""
    R, depth = CHAMBER.radius, 0.012
    area = math.pi * (R**2 - (R - depth) ** 2)
    for centre in (0.0, 0.008 * np.exp(-2j), 0.02 * np.exp(-2j)):
        found, moment = _moments(CHAMBER, centre, depth)
        # Rays one degree apart: a chord lies below its arc by (pi/180)^2/6 of the area of the disc, 5e-5.
        assert math.isclose(found, area, rel_tol=1e-3)
        if abs(centre) < depth:
            assert abs(moment - math.pi * R**2 * centre) < 1e-3 * area * R
        else:
            assert abs(np.angle(moment / centre)) < 1e-3
            assert area * abs(centre) < abs(moment) < math.pi * R**2 * abs(centre)


def test_chords_end_on_the_circle() -> None:
    angle = np.linspace(-3.0, 3.0, 13)
    centre = 0.3 - 0.2j
    ends = chambers.chord(1.0, centre, angle) * np.exp(1j * angle)
    np.testing.assert_allclose(np.abs(ends - centre), 1.0, rtol=1e-14)
    assert np.all(chambers.chord(1.0, centre, angle) > 0.0)


def test_drawing_keeps_wet_wet_and_dry_dry() -> None:
    """The wall is wet all round as long as the deflection is below the depth, in the drawing too."""
    depth = CHAMBER.radius - CHAMBER.mean_surface_radius
    for sizes in ((0.1, 0.4), (0.4, 0.9999), (1.2, 0.1), (3.0, 0.8), (30.0, 2.0), (1e-9, 0.0), (100.0, 1.01)):
        deflections = tuple(size * depth for size in sizes)
        scale = chambers.exaggeration((CHAMBER,), deflections)
        for w in deflections:
            drawn_w, drawn_depth = w * scale.deflection, depth * scale.depth
            assert (drawn_w < drawn_depth) == (w < depth)
            assert drawn_w <= 0.35 * CHAMBER.radius
        assert max(deflections) * scale.deflection > 0.01 * CHAMBER.radius  # visible


def test_top_axis_is_in_radians_per_second() -> None:
    figure = run_figures.phase_figure(rig(21))
    top = figure.axes[0].child_axes[0]
    figure.draw_without_rendering()
    # 100 and 2000 rpm
    np.testing.assert_allclose(top.get_xlim(), [10.471975512, 209.4395102], rtol=1e-9)


def magnification(ratio: np.ndarray, damping: float) -> np.ndarray:
    """Amplitude over eccentricity of a damped rotor, at speeds over the critical one."""
    return ratio**2 / np.abs(1.0 - ratio**2 + 2j * damping * ratio)


@pytest.mark.parametrize("damping", [0.002, 0.02, 0.1])
def test_half_power_band_of_a_damped_rotor(damping: float) -> None:
    """Its ends are where the closed form falls to the peak over the root of 2."""
    ratio = np.linspace(0.3, 2.0, 200_001)
    size = magnification(ratio, damping)
    ((low, high, height),) = curves.half_power_bands(ratio, size)
    # The peak of the sampled curve is below the true one by the square of the step over the width.
    assert height == pytest.approx(1.0 / (2.0 * damping * math.sqrt(1.0 - damping**2)), rel=1e-4)
    for end in (low, high):
        assert magnification(np.array([end]), damping)[0] == pytest.approx(height / math.sqrt(2.0), rel=1e-3)
    assert low < 1.0 / math.sqrt(1.0 - 2.0 * damping**2) < high


def test_no_band_without_both_ends() -> None:
    """A curve that ends on the slope of a peak, or stays high after it, has no width."""
    ratio = np.linspace(0.3, 0.99, 400)
    assert curves.half_power_bands(ratio, magnification(ratio, 0.01)) == []
    ratio = np.linspace(0.3, 5.0, 400)
    assert curves.half_power_bands(ratio, magnification(ratio, 0.6)) == []
    assert curves.half_power_bands(ratio, np.full(400, np.nan)) == []


def test_narrow_resonances_get_a_window() -> None:
    """Narrow ones side by side share it, far ones have their own; wide ones and many have none."""
    x = np.linspace(1.0, 1001.0, 20_001)

    def resonances(*places: float, damping: float = 0.003) -> np.ndarray:
        return np.max([magnification(x / place, damping) for place in places], axis=0)

    limits = 1.0, 1001.0
    (one,) = curves.windows([(x, resonances(300.0))], limits)
    assert one[0] < 300.0 < one[1] and one[1] - one[0] < 100.0
    dry_too = [(x, resonances(300.0)), (x, resonances(320.0))]
    (both,) = curves.windows(dry_too, limits)
    assert both[0] < 295.0 and both[1] > 325.0
    assert len(curves.windows([(x, resonances(200.0, 800.0))], limits)) == 2
    assert curves.windows([(x, resonances(300.0, damping=0.1))], limits) == []
    assert curves.windows([(x, np.full(x.shape, 1.0))], limits) == []
    # The band takes its share of the axis: on a narrow axis the same resonance needs no window.
    near = np.linspace(280.0, 320.0, 2001)
    assert curves.windows([(near, magnification(near / 300.0, 0.003))], (280.0, 320.0)) == []


def test_refined_points_do_not_change_a_median_over_speed() -> None:
    """Of a straight line it is the middle, wherever the points crowd."""
    x = np.union1d(np.linspace(0.0, 1.0, 501), np.linspace(0.9, 1.0, 2001))
    # To the coarser step, which is the largest share of one point.
    assert abs(curves.median_over(x, 3.0 * x) - 1.5) < 3.0 * 0.002
    assert np.median(3.0 * x) > 2.7
    assert curves.median_over(np.ones(3), np.array([1.0, 5.0, 2.0])) == 2.0


def test_a_part_of_the_curves() -> None:
    """All points inside, one more on either side, marked spans cut."""
    whole = curves.prepare(folded())
    low, high = whole.rpm[10] + 1e-6, whole.rpm[30] - 1e-6
    part = curves.cut(replace(whole, dry_patch=[(0.0, 1e9)], out_of_range=[(0.0, 1e-9)]), (low, high))
    assert np.array_equal(part.rpm, whole.rpm[10:31])
    assert np.array_equal(part.branches, whole.branches[10:31], equal_nan=True)
    assert part.limits == (low, high) and part.dry_patch == [(low, high)] and part.out_of_range == []
