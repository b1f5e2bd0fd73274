"""Inertia of the flow that baffles block, against closed forms and a strip of finite elements."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from skfem import Basis, ElementTriP2, FacetBasis, LinearForm, MeshTri, asm, condense, solve
from skfem.models.poisson import laplace

from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.blocked import blocked_inertia, blocked_share
from tests.mutants import kills

ZETA_3 = 1.2020569031595942


@kills("solvers.sloshing.blocked:_push", "(2.0 * t - 1.0), 4.0", "(2.0 * t - 1.0), 2.0")
@kills("solvers.sloshing.blocked:blocked_inertia", "unknown[section.surface] = False", "pass")
def test_closed_baffles() -> None:
    """A dam across the depth h takes 14 zeta(3) h^2/pi^3 on each side along; a lonely one in a thin layer.

    The layer's curvature changes that by some h/R: 2 % and 1 %.
    """
    for depth, around in ((0.02, 800), (0.01, 1500)):
        inertia = blocked_inertia(ring(1.0, 1.0 - depth, around, 4, baffles=Baffles(4)))
        assert inertia / (4 * 2 * 14 * ZETA_3 / math.pi**3 * depth**2) == pytest.approx(1.0, abs=depth)


@kills("solvers.sloshing.blocked:_push", "-np.sum(place * along", "np.sum(place * np.roll(along, 1, axis=2)")
def test_low_baffles() -> None:
    """A low plate on the wall takes half of a flat plate's added mass along, pi b^2/2; a wall nothing."""
    radius, height = 1.0, 0.01
    inertia = blocked_inertia(ring(radius, 0.8, 120, 6, baffles=Baffles(3, radius - height)))
    # The arm of the plate's middle, and the surface twenty heights away.
    assert inertia == pytest.approx(3 * 0.5 * math.pi * height**2, rel=0.02)
    assert abs(blocked_inertia(ring(radius, 0.8, 120, 6))) < 1e-9


@kills("solvers.sloshing.blocked:blocked_share", "0.5 * np.pi", "np.pi")
def test_share_of_the_layer() -> None:
    """Over the layer's own moment of inertia; less than plates in deep liquid take, pi b^2/2 each."""
    water = Liquid("water", 1000.0, 1e-6)
    walls = Chamber(0.24, 0.06, baffles=Baffles(8, 0.234))
    depth = 0.0137
    fill = Fill(walls, water, math.pi * 0.06 * depth * (0.48 - depth))
    section = ring(0.24, 0.24 - depth, 192, 12, baffles=walls.baffles)
    weight = 1000.0 * 0.06
    whole = 0.5 * fill.mass * (0.24**2 + fill.surface_radius**2)
    share = blocked_share(fill)
    assert share == pytest.approx(weight * blocked_inertia(section) / whole, rel=1e-6)
    # The free surface is 1.3 heights of a plate above it.
    deep = 8 * 0.5 * math.pi * 0.006**2 * 0.237**2 * weight / whole
    assert 0.9 * deep < share < deep


@pytest.mark.parametrize("share", [0.2, 0.56, 0.8])
def test_under_a_lid(share: float) -> None:
    """Added length of an opening under a rigid lid, by graded elements [theory: baffles, eq. 15]."""
    n, length, tip = 12, 4.0, 1.0 - share

    def graded(a: float, b: float) -> np.ndarray:
        return b - (b - a) * np.linspace(1.0, 0.0, n + 1) ** 3

    y = np.unique(np.concatenate([graded(0.0, tip), graded(1.0, tip)]))
    mesh = MeshTri.init_tensor(length * np.linspace(0.0, 1.0, 3 * n + 1) ** 3, y)
    basis = Basis(mesh, ElementTriP2())
    far = mesh.facets_satisfying(lambda x: np.isclose(x[0], length))
    opening = mesh.facets_satisfying(lambda x: np.isclose(x[0], 0.0) & (x[1] > tip))

    def one(v: Any, _w: Any) -> Any:
        return v

    flux = asm(LinearForm(one), FacetBasis(mesh, ElementTriP2(), facets=far))
    potential = solve(*condense(asm(laplace, basis), flux, D=basis.get_dofs(opening)))
    # Of the order of the smallest cell at the edge, (1/12)^3; the strip's end adds e^(-8 pi).
    exact = -4.0 / math.pi * math.log(math.sin(0.5 * math.pi * share))
    assert 2.0 * (flux @ potential - length) == pytest.approx(exact, rel=2e-3)
