"""Balance quality: the standard's numbers, a dry rotor's own unbalance, and the liquid's beside it."""

from __future__ import annotations

import cmath
import itertools
import math

import numpy as np
import pytest

from leblanc.scene.examples import example
from leblanc.scene.scene import dry_rotor
from leblanc.studies.run.study import run_scene
from meshes.errors import InputError
from solvers.rotor.balance_quality import (
    GRADES,
    balance_quality,
    grade_name,
    grade_of,
    residual_unbalance,
    tolerance_planes,
)
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import PlaneUnbalance, Support, TwoPlane
from solvers.rotor.vibration import unbalance_response
from tests.mutants import kills


def test_grades_of_the_standard() -> None:
    """0.4 to 4000 mm/s, each about 2.5 times the one before; the finest that is kept."""
    assert (GRADES[0], GRADES[-1], len(GRADES)) == (0.4e-3, 4.0, 11)
    for finer, coarser in itertools.pairwise(GRADES):
        assert coarser / finer == pytest.approx(2.5, rel=0.025)
        assert grade_of(coarser) == coarser
        assert grade_of(coarser * (1.0 + 1e-6)) != coarser
        assert grade_of(0.5 * (finer + coarser)) == coarser
    assert grade_of(0.0) == GRADES[0]
    assert grade_of(4.1) is None and grade_of(math.inf) is None and grade_of(math.nan) is None
    assert [grade_name(grade) for grade in (GRADES[0], GRADES[3], GRADES[-1])] == ["G 0.4", "G 6.3", "G 4000"]


def _rotor(*unbalances: PlaneUnbalance, first: float = -0.3, last: float = 0.2) -> TwoPlane:
    supports = Support(first, 1e6, 50.0), Support(last, 2e6, 80.0)
    return TwoPlane(20.0, 0.4, 0.1, supports, unbalances)


@kills("solvers.rotor.balance_quality:tolerance_planes", "last / (last - first)", "-first / (last - first)")
def test_unbalance_at_the_centre_of_mass_counts_once() -> None:
    """U Omega/m in both planes, wherever the supports are: shares as the mass that rests on them."""
    speed = np.array([100.0, 300.0])
    rotor = _rotor(PlaneUnbalance(0.0, 2e-4, 0.7))
    first, last = tolerance_planes(rotor)
    assert (first.mass, last.mass) == pytest.approx((8.0, 12.0))
    np.testing.assert_allclose(balance_quality(rotor, speed), 2e-4 * speed / 20.0, rtol=1e-10)
    np.testing.assert_allclose(
        balance_quality(Jeffcott(4.0, 1e4, 0.0, 2e-4), speed), 5e-5 * speed, rtol=1e-12
    )


@kills("solvers.rotor.balance_quality:residual_unbalance", "np.conj(p)))", "1j * p))")
def test_couple_is_not_hidden() -> None:
    """Two opposed unbalances have no resultant; each plane has U d/L."""
    size, apart, speed = 1e-4, 0.1, np.array([200.0])
    rotor = _rotor(PlaneUnbalance(-0.05, size), PlaneUnbalance(0.05, size, math.pi))
    each = size * apart / 0.5
    planes = residual_unbalance(rotor.system(), rotor.system().unbalance[None], [-0.3, 0.2])
    np.testing.assert_allclose(np.abs(planes[0]), each, rtol=1e-10)
    assert balance_quality(rotor, speed)[0] == pytest.approx(each * 200.0 / 8.0, rel=1e-10)


def test_planes_from_the_balance_of_moments() -> None:
    """Any unbalances: A and B from the sum of forces and of moments by hand."""
    chance = np.random.default_rng(4)
    for _ in range(5):
        z, size, angle = chance.uniform(-0.4, 0.4, 3), chance.uniform(1e-5, 1e-3, 3), chance.uniform(0, 6, 3)
        rotor = _rotor(*(PlaneUnbalance(*part) for part in zip(z, size, angle, strict=True)))
        turning = np.array([s * cmath.exp(1j * a) for s, a in zip(size, angle, strict=True)])
        force, moment = turning.sum(), (turning * z).sum()
        second = (moment + 0.3 * force) / 0.5
        found = residual_unbalance(rotor.system(), rotor.system().unbalance[None], [-0.3, 0.2])[0]
        np.testing.assert_allclose(found, (force - second, second), rtol=1e-9)


def test_shares_stay_between_the_limits_of_the_standard() -> None:
    for first, last in ((-0.01, 0.3), (0.1, 0.4)):  # close to a support, and beyond both
        near, far = tolerance_planes(_rotor(first=first, last=last))
        assert (near.mass, far.mass) == pytest.approx((14.0, 6.0))
    single = TwoPlane(20.0, 0.4, 0.1, (Support(0.1, 1e6, 50.0),))
    assert len(tolerance_planes(single)) == 1


@kills(
    "solvers.rotor.balance_quality:balance_quality",
    "held / np.square(omega)[:, None]",
    "held / omega[:, None]",
)
@pytest.mark.parametrize("name", ["horizontal_rig", "two_plane_rig", "tub"])
def test_dry_motion_gives_back_the_unbalance(name: str) -> None:
    """From what the dry rotor does: its own unbalance, at any speed and damping."""
    rotor, speed = dry_rotor(example(name)), np.array([20.0, 60.0, 150.0])
    moved = unbalance_response(rotor.system(), speed)
    np.testing.assert_allclose(balance_quality(rotor, speed, moved), balance_quality(rotor, speed), rtol=1e-9)


@pytest.mark.parametrize("name", ["horizontal_rig", "tub"])
def test_total_is_rotor_and_liquid(name: str) -> None:
    """The rotor's unbalance and the liquid's mass times the place of its centre of mass."""
    scene = example(name)
    result = run_scene(scene)
    (plane,) = tolerance_planes(dry_rotor(scene))
    liquid = result.liquid_mass * result.liquid_offset * np.exp(1j * result.liquid_angle)
    total = np.abs(scene.rotor.unbalance + liquid) * result.speed / plane.mass  # type: ignore[union-attr]
    assert result.balance_quality is not None
    np.testing.assert_allclose(result.balance_quality, total, rtol=1e-7)
    if name == "horizontal_rig":  # one circle: the amplitude is as much smaller as the unbalance
        assert result.balance_quality_dry is not None
        np.testing.assert_allclose(
            result.balance_quality / result.balance_quality_dry,
            result.amplitude / result.amplitude_dry,
            rtol=1e-9,
        )


def test_what_has_no_bound() -> None:
    rotor = Jeffcott(4.0, 1e4, 0.0, 2e-4)
    unbounded = np.full((1, 2), complex(math.inf, 0.0))
    assert balance_quality(rotor, [50.0], unbounded)[0] == math.inf
    with pytest.raises(InputError, match="rotor"):
        tolerance_planes(rotor.system())
