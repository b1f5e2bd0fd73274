"""Seeded faults of the closed forms of the liquid."""

from tests.faults import Fault
from tests.fluid import test_lens, test_printed, test_upright, test_waves


def _lens() -> None:
    for r, e in ((0.8, 0.5), (1.3, 0.5), (1.4, 1.2)):
        test_lens.assert_matches_quadrature(r, 1.0, e)


FAULTS: tuple[Fault, ...] = (
    Fault("fluid.moments", "return r**2 * area, r**4", "return r**2 * area / 2.0, r**4", _lens),
    Fault("fluid.moments", "first = (2.0 / 3.0)", "first = (1.0 / 3.0)", _lens),
    Fault("fluid.moments", "- 2.0 * e * first + polar", "+ 2.0 * e * first + polar", _lens),
    Fault("fluid.moments", "0.0, e * area)", "0.0, 0.5 * e * area)", _lens),
    Fault("fluid.moments", "across - radius * cos * first", "across + radius * cos * first", _lens),
    Fault(
        "fluid.moments",
        "0.5 * np.pi * whole**4",
        "0.25 * np.pi * whole**4",
        test_lens.test_disc_inside_the_chamber,
    ),
    Fault(
        "fluid.waves", "root = np.sqrt(t * (t + n))", "root = np.sqrt(t * n)", test_waves.assert_free_waves
    ),
    Fault("fluid.waves", "t = np.tanh(n * log)", "t = np.tanh(log)", test_waves.assert_free_waves),
    Fault("fluid.waves", "-omega * (n * t)", "omega * (n * t)", test_waves.assert_free_waves),
    Fault(
        "fluid.waves",
        "_over_resonance(2.0 * np.square(q - 1.0)",
        "_over_resonance(np.square(q - 1.0)",
        test_waves.assert_forced_layers,
    ),
    Fault(
        "fluid.waves", "(1.0 - kappa) * np.square(q) +", "-np.square(q) +", test_waves.assert_forced_layers
    ),
    Fault(
        "fluid.waves",
        "-_over_resonance(np.square(q)",
        "_over_resonance(np.square(q)",
        test_waves.assert_momentum,
    ),
    Fault(
        "fluid.waves",
        "_over_resonance((kappa - 1.0) * np.square(q)",
        "_over_resonance(kappa * np.square(q)",
        test_waves.assert_synchronous,
    ),
    Fault(
        "fluid.waves",
        "(2.0 * kappa * np.square(omega))",
        "(kappa * np.square(omega))",
        test_waves.assert_gravity,
    ),
    Fault(
        "fluid.waves",
        "-(kappa - 1.0) * gravity_offset",
        "(kappa - 1.0) * gravity_offset",
        test_waves.assert_gravity,
    ),
    Fault("fluid.waves", "np.sqrt(g / a)", "np.sqrt(2.0 * g / a)", test_waves.assert_capture),
    Fault(
        "fluid.printed",
        "return beta * chamber.radius**2 - beta * volume / area",
        "return beta * chamber.radius**2 + beta * volume / area",
        test_printed.assert_eq_17,
    ),
    Fault(
        "fluid.printed",
        "(level * float(lens.area) - beta",
        "(level * float(lens.area) + beta",
        test_printed.assert_volume_by_heights,
    ),
    Fault(
        "fluid.printed",
        "return chamber.radius - eccentricity",
        "return chamber.radius + eccentricity",
        test_printed.assert_optimal_volume,
    ),
    Fault(
        "fluid.printed",
        "s**2 * (far - near) ** 2 / 16.0",
        "s**2 * (far - near) ** 2 / 8.0",
        test_printed.assert_corrected_eq_18,
    ),
    Fault(
        "fluid.printed",
        "kite = h * root / (2.0 * beta)",
        "kite = h * root / beta",
        test_printed.assert_frozen_angle,
    ),
    Fault(
        "fluid.printed", "beta * (e**2 - R**2))", "beta * (R**2 - e**2))", test_printed.assert_frozen_angle
    ),
    Fault(
        "fluid.printed",
        "kite = h * chord / (4.0",
        "kite = h * math.sqrt(chord) / (4.0",
        test_printed.assert_eq_20_as_printed,
    ),
    Fault("fluid.printed", "(square - ratio**2)", "(square - ratio)", test_printed.assert_eq_25_as_printed),
    Fault(
        "fluid.upright",
        "integral = np.sum(np.square(stiffening)",
        "integral = np.sum((stiffening)",
        test_upright.assert_wall_only,
    ),
    Fault("fluid.upright", "axis=-1) / 4.0", "axis=-1) / 2.0", test_upright.assert_wall_only),
    Fault(
        "fluid.upright",
        "for level in (0.0, chamber.height):",
        "for level in (0.0, 2.0 * chamber.height):",
        test_upright.assert_floor_to_lid,
    ),
    Fault(
        "fluid.upright",
        "- m * gravity * height - a",
        "+ m * gravity * height - a",
        test_upright.assert_wall_only,
    ),
)
