"""Claims in words, against what closed forms say of the same machines."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import pytest

from tests.mutants import kills
from validation.cases.claims import cases
from validation.cases.claims.chambers import COUNTS, KINDS, machine, rings, steady_gain
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


def test_verdicts() -> None:
    """Radii help at constant speed, the number of rings does not; 35 mm lie in what may be assumed."""
    found = {case.name.partition("/")[2]: case for case in cases()}
    verdicts = {name: case.verdict for name, case in found.items()}
    # The page has what is computed, run-ups to half of their last digit and a hundredth for other builds.
    page = (Path(__file__).parents[2] / "docs" / "claims.md").read_text(encoding="utf-8")
    concentric = page.split("| 2, 3, 4 concentric rings |")[1].split("|")[1:4]
    for cell, measure, within in zip(
        concentric, ("at-speed", "peak", "run-up"), (6e-4, 6e-4, 0.016), strict=True
    ):
        computed = str(found[f"chambers-concentric-{measure}"].computed).split(", ")[1:]
        assert [float(each) for each in cell.split(", ")] == pytest.approx(
            [*map(float, computed)], abs=within
        )
    for kind, trends in (("concentric", {"at-speed", "peak"}), ("stacked", set())):
        for measure in ("at-speed", "peak", "run-up"):
            expected = "trend" if measure in trends else "differs"
            assert verdicts[f"chambers-{kind}-{measure}"] == expected, (kind, measure)
    assert found["chambers-stacked-at-speed"].difference == "no effect"
    assert verdicts["35-g"] == "differs"
    assert verdicts["35-g-range"] == verdicts["35-g-motor"] == "trend"
