"""Seeded faults of the one-family coefficients."""

from functools import partial

from tests.faults import Fault
from tests.fluid import test_kdv as kdv

_CASE = (0.15, 0.135, 40.0)
_steepening_prograde = partial(kdv.steepening_matches, *_CASE, 1)
_steepening_retrograde = partial(kdv.steepening_matches, *_CASE, -1)
_dispersion = partial(kdv.dispersion_matches, *_CASE, 1)
_resonance = partial(kdv.resonance_is_projected, *_CASE, -1)
_friction = partial(kdv.friction_is_projected, *_CASE, 1)


def steepening() -> None:
    """Both families."""
    _steepening_prograde()
    _steepening_retrograde()


def dispersion() -> None:
    """The prograde family."""
    _dispersion()


def resonance() -> None:
    """The retrograde family, then both."""
    _resonance()
    kdv.families_add_up(*_CASE)


def friction() -> None:
    """The prograde family."""
    _friction()


def conventions() -> None:
    """One code, both families."""
    kdv.convention_maps("dedalus", 1)
    kdv.convention_maps("dedalus", -1)


FAULTS = (
    Fault("fluid.kdv", "root = math.sqrt(log * (log + 1.0))", "root = math.sqrt(log)", steepening),
    Fault("fluid.kdv", "(2.0 * log + 1.0) / (2.0 * root)", "(2.0 * log + 1.0) / root", steepening),
    Fault("fluid.kdv", "-1.0 / (4.0 * root**2 * (1.0 + swing))", "1.0 - 2.0 * swing", steepening),
    Fault("fluid.kdv", "3.0 * spin / surface_radius**2", "3.0 * spin / radius**2", steepening),
    Fault("fluid.kdv", "3.0 * spin / surface_radius**2", "1.5 * spin / surface_radius**2", steepening),
    Fault("fluid.kdv", "log + root if family == 1", "root if family == 1", steepening),
    Fault("fluid.kdv", "-log / (log + root)", "log / (log + root)", steepening),
    Fault("fluid.kdv", "spin * log**3 / 3.0 * share", "spin * log**3 / 6.0 * share", dispersion),
    Fault("fluid.kdv", "spin * log**3 / 3.0 * share", "-spin * log**3 / 3.0 * share", dispersion),
    Fault("fluid.kdv", "coupling=family * log", "coupling=log", resonance),
    Fault("fluid.kdv", "log * surface_radius / (2.0", "log * radius / (2.0", resonance),
    Fault("fluid.kdv", "k * abs(c.linear_speed) /", "k * abs(c.other_speed) /", friction),
    Fault("fluid.kdv", "n * (c.linear_speed - c.dispersion", "n * (c.linear_speed + c.dispersion",
          kdv.frequency_solves_the_equation),
    Fault("fluid.kdv", "c.steepening * angle / steepening", "c.steepening / steepening", conventions),
    Fault("fluid.kdv", "np.cbrt(dispersion / c", "np.cbrt(c.dispersion / c", conventions),
    Fault("fluid.kdv", "eta * np.exp(1j * angle)", "eta * np.exp(-1j * angle)", kdv.moment_of_the_layer),
    Fault("fluid.kdv", "c.surface_radius / c.mean_area * first", "c.radius / c.mean_area * first",
          kdv.moment_of_the_layer),
    Fault("fluid.kdv", "(1.0 + np.asarray(liquid_offset", "(1.0 - np.asarray(liquid_offset",
          kdv.synchronous_whirl_is_static),
    Fault("fluid.kdv", "2.0 * c.mean_area / c.radius**2", "c.mean_area / c.radius**2",
          kdv.synchronous_whirl_is_static),
)  # fmt: skip
