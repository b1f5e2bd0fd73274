"""Seeded faults of the exact waves and shocks."""

from tests.faults import Fault
from tests.fluid import test_exact
from tests.fluid.test_exact import PLAIN, PROGRADE


def _cnoidal() -> None:
    for sharpness, crests in ((1.0, 1), (2.2, 2), (6.0, 1)):
        test_exact.assert_travels(PROGRADE, sharpness, crests, 0.2)
    test_exact.assert_matches_mpmath()


def _shock() -> None:
    test_exact.assert_shock(PLAIN)


def _sawtooth() -> None:
    test_exact.assert_sawtooth(PLAIN, 0.5, 1.0)


FAULTS: tuple[Fault, ...] = (
    Fault("fluid.exact", "height / (12.0 * c.dispersion)", "height / (6.0 * c.dispersion)", _cnoidal),
    Fault("fluid.exact", "(level + height / 3.0)", "(level + height / 2.0)", test_exact.assert_solitary),
    Fault("fluid.exact", "-height * math.tanh", "-0.5 * height * math.tanh", test_exact.assert_solitary),
    Fault("fluid.exact", "sharpness**2 * (m - m1)", "sharpness**2 * (m1 - m)", _cnoidal),
    Fault("fluid.exact", "level + 4.0 * c.disp", "level + 2.0 * c.disp", _cnoidal),
    Fault("fluid.exact", "mean -= weight", "mean += weight", _cnoidal),
    Fault("fluid.exact", "- scale / k", "+ scale / k", _cnoidal),
    Fault("fluid.exact", "-0.5 * drop * np.tanh", "0.5 * drop * np.tanh", _shock),
    Fault("fluid.exact", "/ (4.0 * viscosity))", "/ (2.0 * viscosity))", _shock),
    Fault(
        "fluid.exact",
        "/ (4.0 * viscosity * old[..., None])",
        "/ (2.0 * viscosity * old[..., None])",
        _sawtooth,
    ),
    Fault(
        "fluid.exact",
        "mean_distance / (c.steepening * old)",
        "-mean_distance / (c.steepening * old)",
        _sawtooth,
    ),
)
