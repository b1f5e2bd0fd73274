"""The slowest modes without dense matrices: those of the dense ones, each of equal ones, on fine meshes."""

from __future__ import annotations

import numpy as np
import pytest

from fluid.liquid import known_liquid
from leblanc.studies.modes.study import Resolution, answer_modes
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.rings.quadrilaterals import ring
from solvers.sloshing.forced import forced_response
from solvers.sloshing.modes import sloshing_modes, spectrum
from solvers.sloshing.slowest import slowest_modes, synchronous_force_ratio
from solvers.sloshing.system import condense, surface_system
from tests.mutants import kills

R, A, SPIN = 0.15, 0.135, 40.0
SHAPES = {
    "clear": None,
    "compartments": Baffles(24),
    "from the wall": Baffles(6, 0.145),
    "from the surface": Baffles(4, 0.0, 0.002),
    "free": Baffles(3, 0.14, 0.004),
}


@pytest.mark.parametrize("shape", SHAPES)
@kills("solvers.sloshing.slowest:_Krylov.extend", "2j * (self.system.gyration", "-2j * (self.system.gyration")
@kills("solvers.sloshing.slowest:synchronous_force_ratio", "0.5 * np.trace", "np.trace")
def test_the_dense_matrices_say_the_same(shape: str) -> None:
    """Frequencies, all of a multiple one, energies and the force of a synchronous whirl."""
    for order, around in ((1, 32), (2, 24)):
        section = ring(R, A, around, 2, order=order, baffles=SHAPES[shape])
        dense, sparse = condense(section), surface_system(section)
        every, found = spectrum(dense), slowest_modes(sparse, 12)
        assert found.converged
        count = len(found.spectrum.frequency)
        # Dense matrices lose as many digits as the cells at the surface differ in width.
        np.testing.assert_allclose(found.spectrum.frequency, every.frequency[:count], rtol=1e-7)
        # None as fast as the last one is left out: 24 compartments have 24 equal modes.
        assert every.frequency[count] > every.frequency[count - 1] * (1.0 + 1e-7)
        if shape == "compartments":
            assert count % 24 == 0
        ratio = forced_response(dense, SPIN, SPIN, every).force_ratio.real
        assert synchronous_force_ratio(sparse) == pytest.approx(float(ratio), rel=1e-7)
        modes, other = sloshing_modes(sparse, SPIN, 6, found.spectrum), sloshing_modes(dense, SPIN, 6, every)
        assert modes.converged and modes.residual.max() < 1e-9
        np.testing.assert_allclose(modes.frequency, other.frequency, rtol=1e-7)
        np.testing.assert_array_equal(modes.multiplicity, other.multiplicity)
        if shape != "compartments":
            np.testing.assert_allclose(modes.travelling, other.travelling, atol=1e-5)


def test_a_fine_mesh_at_an_edge() -> None:
    """Cells of 1e-9 of the radius beside the edge of a baffle: modes to rounding, of high order."""
    found = []
    for times in (1, 2, 4):
        system = surface_system(ring(R, A, 12, 2, baffles=Baffles(1, 0.14), times=times))
        slow = slowest_modes(system, 3)
        modes = sloshing_modes(system, SPIN, 3, slow.spectrum)
        # Dense matrices leave 2e-11, 1e-9 and 3e-8.
        assert slow.converged and modes.converged and modes.residual.max() < 3e-9
        found.append(np.abs(modes.frequency))
    coarse, middle, fine = found
    # Fourth order divides the error by 16.
    assert np.all(np.abs(coarse - middle) > 10.0 * np.abs(middle - fine))


def test_a_fine_mesh_answers() -> None:
    """`modes` with 192 segments and baffles in the liquid."""
    chamber = Chamber(R, 0.05, baffles=Baffles(2, 0.14))
    answer = answer_modes(chamber, 6.7e-4, known_liquid("water"), SPIN, 3, Resolution(segments=192, layers=2))
    assert answer.converged and answer.error_estimate.max() < 2e-5
