"""Cases of KdV-Burgers: what they say of lag, diffusion, both families and the published balancer."""

from __future__ import annotations

import pytest

from tests.mutants import kills
from tests.oracles.cases import come_out_again, kept_group, verdicts
from validation.cases.liquid import kdv


def test_whirls_and_waves_agree() -> None:
    found = kept_group("kdv")
    assert verdicts(found, "agrees") == {*found}
    # The distances that the page of the model has.
    apart = [-found[f"in-time-{ratio:g}"]["difference"] for ratio, _ in kdv.MARCHED]
    assert apart == sorted(apart) and apart[0] < 0.005 and 0.05 < apart[-1] < 0.06
    exact = [case for name, case in found.items() if name.startswith("exact-")]
    assert max(abs(case["difference"]) for case in exact) < 0.004


@kills("validation.cases.liquid.kdv:offset_share", "** -2 - 1.0", "** -2")
@kills("fluid.kdv:coefficients", "family * log * surface_radius", "log * surface_radius")
@kills("fluid.kdv:offset", "c.surface_radius / c.mean_area", "c.radius / c.mean_area")
def test_the_balancer_by_one_family_and_by_both() -> None:
    come_out_again(kdv._balancer())
    for depth in (0.02, 0.05, 0.1):
        # Both families of long waves are the whole; their third derivatives add L^2/6.
        both = kdv.offset_share(depth, -1) + kdv.offset_share(depth, 1)
        assert both == pytest.approx(1.0, abs=0.2 * depth**2)


def test_waves_near_resonance_come_out_again() -> None:
    come_out_again(kdv._waves())
