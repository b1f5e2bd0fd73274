"""Claims in words, against what closed forms say of the same machines."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest

from tests.mutants import kills
from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.cases.claims import layout, swing
from validation.cases.claims.chambers import COUNTS, KINDS, gain, machine, rings, steady_gain
from validation.cases.claims.swing import LOAD, PLACE, SWING, damping_that_swings, peak, rig


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("count", COUNTS)
def test_rings_share_one_litre_within_one_envelope(count: int, kind: str) -> None:
    found = rings(count, kind)  # type: ignore[arg-type]
    assert sum(ring.volume for ring in found) == pytest.approx(1e-3, rel=1e-14)
    assert max(ring.radius for ring in found if ring.radius is not None) == 0.2
    depths = [ring.fill().depth for ring in found]
    if kind == "stacked":
        assert sum(ring.height for ring in found) == pytest.approx(0.04, rel=1e-14)
        assert depths == pytest.approx([depths[0]] * count, rel=1e-12)
    else:
        # Equal in the share of the circumference, not on the curved wall: 8 mm deep beside 50 mm of radius.
        assert max(depths) / min(depths) < 1.1
        assert all(outer.inner_radius == inner.radius for outer, inner in pairwise(found))


@pytest.mark.parametrize("count", COUNTS[1:])
@kills("validation.cases.claims.chambers:rings", "_HEIGHT / count", "_HEIGHT")
def test_stacked_rings_are_one_cylinder(count: int) -> None:
    """Added masses alone stand in the steady answer of wet walls; their sum does not know the partitions."""
    assert steady_gain(count, "stacked") == pytest.approx(steady_gain(1, "stacked"), rel=1e-9)


@kills("validation.cases.claims.chambers:steady_gain", "found.amplitude_dry[-1]", "found.amplitude_dry[0]")
def test_concentric_rings_add_their_squared_radii() -> None:
    """Far above resonance M/(M + m); at 6.4 times it (1 - x)/(1 - x + m/M) with x = (w_n/w)^2 = 0.025."""
    scene = machine(3, "concentric")
    added = sum(fill.full_mass for fill in scene.fills) / 30.0
    left = 1.0 - (2.0 * math.pi * 2.25 / 90.0) ** 2
    # Damping of 1 % counts with 2 zeta x^2, below 1e-5 here; gravity's paraboloid leaves a wet wall the same.
    assert steady_gain(3, "concentric")[0] == pytest.approx(left / (left + added), rel=1e-4)


@kills("validation.cases.claims.swing:damping_that_swings", "0.5 * math.asin(double)", "math.asin(double)")
@kills("validation.cases.claims.swing:rig", "load * place", "2.0 * load * place")
def test_damping_swings_the_load_as_far_as_asked() -> None:
    for mass in (10.0, 30.0, 60.0):
        assert peak(rig(mass, PLACE, damping_that_swings(mass))) == pytest.approx(SWING, rel=1e-9)
    # Light damping, by hand: U/(2 M zeta).
    assert peak(rig(30.0, PLACE, 0.01)) == pytest.approx(LOAD * PLACE / 0.6, rel=1e-3)


def on_the_page() -> list[list[float]]:
    """Gains of two, three and four concentric rings: at speed, at the peak, in a run-up."""
    page = (Path(__file__).parents[2] / "docs" / "evidence.md").read_text(encoding="utf-8")
    cells = page.split("| 2, 3, 4 concentric rings |")[1].split("|")[1:4]
    return [[float(each) for each in cell.split(", ")] for cell in cells]


def test_verdicts() -> None:
    """Radii help at constant speed, the number of rings does not; 35 mm lie in what may be assumed."""
    found = kept_group("claims")
    trends = {"chambers-concentric-at-speed", "chambers-concentric-peak", "35-g-range", "35-g-motor"}
    assert verdicts(found, "trend") >= trends
    stacked = {f"chambers-stacked-{measure}" for measure in ("at-speed", "peak", "run-up")}
    assert verdicts(found, "differs") >= {*stacked, "chambers-concentric-run-up", "35-g"}
    come_out_again([*swing.cases(), *layout.cases()])
    # The page has what is computed.
    at_speed, peak, _ = on_the_page()
    assert (at_speed[1], peak[1]) == pytest.approx(steady_gain(3, "concentric"), abs=6e-4)


@pytest.mark.slow
def test_gains_of_the_page() -> None:
    """All of them, run-ups to half of their last digit and a hundredth for other builds."""
    gains = [gain(count, "concentric") for count in COUNTS[1:]]
    for row, measure, within in zip(
        on_the_page(), ("at_speed", "peak", "run_up"), (6e-4, 6e-4, 0.016), strict=True
    ):
        assert row == pytest.approx([getattr(one, measure) for one in gains], abs=within)
