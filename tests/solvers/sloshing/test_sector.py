"""One sector of a ring with baffles has what a circular whirl drives in all of it."""

from __future__ import annotations

import numpy as np
import pytest

from meshes.arrays import Array, Complex
from meshes.baffles import Baffles
from meshes.errors import InputError
from meshes.rings.quadrilaterals import ring, ring_sector
from solvers.sloshing.reduced import ReducedLiquid, _sector, over_parts, wall_drag
from solvers.sloshing.system import condense
from tests.mutants import kills

SECTOR, REDUCED = "solvers.sloshing.sector", "solvers.sloshing.reduced"
# Ending in the liquid, piercing the surface, standing free, with a gap at the wall and piercing.
KINDS = [
    (0.94, Baffles(4, 0.95)),
    (0.96, Baffles(4, 0.95)),
    (0.9, Baffles(3, 0.93, 0.03)),
    (0.9, Baffles(5, 0.8, 0.02)),
]
CUT = 2e-3
SLIPS = (0.0, 0.3, -0.3, 0.7, 0.45 + 0.05j)


def whole(radius: float, baffles: Baffles, slip: complex) -> tuple[Complex, Complex]:
    """First moment that a force displaces and the drag of that motion, by all of the ring's elements."""
    mesh = ring(1.0, radius, 64, 4, baffles=baffles)
    system = condense(mesh)
    matrix = -slip * slip * system.inertia + 2j * slip * system.gyration + system.surface
    field = np.linalg.solve(matrix, system.moment.T)
    nodes = system.on_nodes(field.T)
    drag = wall_drag(mesh, np.concatenate([nodes.real, nodes.imag]), CUT)
    turned = np.kron([[1.0, 1j]], np.eye(2))
    return system.moment @ field, turned.conj() @ drag @ turned.T


def reduced(liquid: ReducedLiquid, drag: Array, slip: complex) -> tuple[Complex, Complex]:
    """The same of the motions kept."""
    matrix = -slip * slip * liquid.inertia + 2j * slip * liquid.gyration + liquid.surface
    field = np.linalg.solve(matrix, liquid.moment.T)
    return liquid.moment @ field, field.conj().T @ drag @ field


@kills(f"{SECTOR}:condense_sector", "np.exp(-2j", "np.exp(2j")
@kills(f"{SECTOR}:condense_sector", "count * (back", "(back")
@kills(f"{SECTOR}:condense_sector", "(x + 1j * y) / math.sqrt(2.0)", "(x + 1j * y)")
@kills(f"{SECTOR}:condense_sector", "whole - coupling.conj().T", "whole + coupling.conj().T")
@kills(f"{SECTOR}:SectorSystem.on_nodes", "self.coupling @ motions", "2.0 * self.coupling @ motions")
@kills(f"{SECTOR}:SectorSystem.slip", "self.count * walls.weights", "walls.weights")
@kills(f"{SECTOR}:Slip.drag", "edge_weight(self.far, cut)", "1.0")
@kills(f"{SECTOR}:_joined", "factor[second] = first, phase", "factor[second] = first, 1.0")
@kills(f"{REDUCED}:_driven", "(point, -point.conjugate())", "(point,)")
@kills("meshes.rings.quadrilaterals:ring_sector", "turn = 2.0 * math.pi", "turn = math.pi")
@kills(f"{REDUCED}:over_parts", "np.kron(matrix.imag, _TURN)", "np.kron(matrix.imag, _TURN.T)")
@pytest.mark.parametrize(("radius", "baffles"), KINDS, ids=["tip", "cut", "free", "gap"])
def test_a_sector_answers_as_the_whole_ring(radius: float, baffles: Baffles) -> None:
    """Displaced liquid and drag by the elements of the whole ring; the motions kept are 1e-6 off at most."""
    liquid, slip_on_walls = _sector.__wrapped__(radius, baffles)
    drag = over_parts(slip_on_walls.drag(CUT))
    for slip in SLIPS:
        (moved, lost), (other, other_lost) = whole(radius, baffles, slip), reduced(liquid, drag, slip)
        assert np.abs(other - moved).max() < 1e-6 * np.abs(moved).max()
        assert np.abs(other_lost - lost).max() < 1e-5 * np.abs(lost).max()
    mesh = condense(ring(1.0, radius, 64, 4, baffles=baffles))
    # The same curved sides.
    assert liquid.liquid_area == pytest.approx(mesh.liquid_area, rel=1e-12)
    assert liquid.enclosed_area == pytest.approx(mesh.enclosed_area, rel=1e-12)


@kills(f"{SECTOR}:_joined", "owner[plate], owner[second[sector.baffle]] = plate[0], plate[0]", "pass")
def test_a_free_baffle_is_a_streamline() -> None:
    """One value of the stream function on both its sides, turned by the phase on the neighbour."""
    from solvers.sloshing.sector import condense_sector

    system = condense_sector(1.0, 0.9, Baffles(3, 0.93, 0.03))
    nodes = system.on_nodes(np.eye(len(system.moment), dtype=complex)[:, :3])
    first, second = (nodes[ray[system.sector.baffle]] for ray in system.sector.rays.T)
    assert np.abs(first - first[:1]).max() < 1e-14 and np.abs(first).max() > 1e-6
    assert np.abs(second - first * np.exp(-2j * np.pi / 3)).max() < 1e-14


def test_dry_baffles_have_no_sector() -> None:
    """Without a baffle in the liquid there is none."""
    with pytest.raises(InputError, match="in the liquid"):
        ring_sector(1.0, 0.96, 64, 4, Baffles(4, 0.5, 0.06))
