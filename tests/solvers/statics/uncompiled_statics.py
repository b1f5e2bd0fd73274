"""Seeded faults of the compiled equilibrium, and their oracles, run as plain Python.

Compiled code keeps its right lines while a fault is seeded, so these are collected by `test_uncompiled.py`
alone, in a process of its own in which numba compiles nothing.
"""

from __future__ import annotations

import numpy as np
import pytest

from meshes.chamber import Chamber
from solvers.statics import kernel
from solvers.statics.hydrostatics import equilibrium
from tests.mutants import kills
from tests.solvers.statics.test_hydrostatics import GRAVITY, check_state


@kills("solvers.statics.wall:_far_node", "abscissa = e + (1.0", "abscissa = e - (1.0")
@kills("solvers.statics.wall:_far_node", "* 2.0 * e * sin,", "* e * sin,")
@kills("solvers.statics.wall:_near_node", "8.0 * e * panel.width", "4.0 * e * panel.width")
@kills("solvers.statics.wall:_near_node", "(e - 1.0) + 2.0 * squared", "(e - 1.0) + squared")
@kills("solvers.statics.wall:_cuts", "(1.0 - eps) ** 2 if eps", "(1.0 - eps) if eps")
@kills("solvers.statics.wall:_second_moment", "node.s * node.phi + node", "node.s * node.phi - node")
@kills("solvers.statics.wall:moments", "yy += 0.5 * liquid", "yy += liquid")
@kills("solvers.statics.wall:moments", " z += 0.5 * liquid", " z += liquid")
@kills("solvers.statics.wall:moments", "depth**2 * node.phi / 3.0", "depth**2 * node.phi / 2.0")
@kills("solvers.statics.wall:moments", "xz += 0.5 * liquid", "xz += liquid")
@kills("solvers.statics.wall:_sine_excess", "4.0 / 6.0 * phi**3", "4.0 / 5.0 * phi**3")
@kills("solvers.statics.kernel:_add_moments", "area * radius * own[1]", "area * own[1]")
def test_whole_box_at_four_corners() -> None:
    for fill, e, speed in ((0.02, 0.012, 40.0), (0.3, 0.25, 7.0), (0.01, 0.1, 1e4), (0.7, 0.05, 6.0)):
        check_state(0.2, 0.05, fill, e, speed)


# Short panels have rules of their own: with too few nodes a film that the surface cuts just so is missed.
@kills("solvers.statics.wall:_rule_of", "_FEW_FAR if half <= _SHORT_FAR", "_DISC if half <= _SHORT_FAR")
@kills("solvers.statics.wall:_rule_of", "_FEW_NEAR if half <= _SHORT_NEAR", "_DISC if half <= _SHORT_NEAR")
@kills("solvers.statics.wall:_rule_of", "_FEW_NEAR if half <= _SHORT_NEAR", "_FEW_NEAR if half <= 6.0")
def test_short_and_long_panels() -> None:
    for fill, e, speed in ((0.01, 0.004, 90.0), (0.1, 0.01, 30.0), (0.9, 0.19, 4.0), (0.02, 0.2, 300.0)):
        check_state(0.2, 0.05, fill, e, speed)


@kills("solvers.statics.kernel:_inside", "(1.0 + ratio + 2.0 * eps)", "(1.0 + ratio + eps)")
@kills("solvers.statics.kernel:_power", "3 if i == 0 else i - 1", "3 if i == 0 else i")
@kills("solvers.statics.kernel:first_moments", "inner[k] ** 3 * height", "inner[k] ** 2 * height")
def test_slope_and_moment_of_an_annulus() -> None:
    """The slope is a difference of the moments, which both kernels find alike."""
    chamber, volume, e, speed = Chamber(0.2, 0.05, inner_radius=0.15), 2e-3, 0.02, 9.0
    step = 1e-5 * e
    around = equilibrium(chamber, volume, np.array([e - step, e, e + step]), speed, GRAVITY)
    moment, slope = around.unbalance()
    # Central difference: rounding 1e-15/1e-5, truncation 1e-10 times a curvature of order one to ten.
    np.testing.assert_allclose((moment[2] - moment[0]) / (2 * step), slope[1], rtol=1e-6)
    np.testing.assert_allclose(around.first_moment(), moment, rtol=1e-13)


@kills("solvers.statics.kernel:_of_cylinder", "+ eps * chord - area", "- eps * chord - area")
@kills("solvers.statics.kernel:_of_cylinder", "squared + eps**2 - 1.0", "squared - eps**2 - 1.0")
def test_a_cylinder_beside_a_dry_wall_is_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """Areas of two circles say where it is; the volume under the surface is asked for once more at most."""
    asked, whole = 0, kernel._volume_and_plan

    def counted(*state: float) -> tuple[float, float]:
        nonlocal asked
        asked += 1
        return whole(*state)

    monkeypatch.setattr(kernel, "_volume_and_plan", counted)
    chamber = Chamber(0.2, 0.05)
    for fill, e in ((0.01, 0.01), (0.1, 0.05), (0.5, 0.15), (0.9, 0.19), (1e-4, 2e-3)):
        asked = 0
        assert equilibrium(chamber, fill * chamber.capacity, e, 30.0, 0.0).converged
        assert asked <= 2
