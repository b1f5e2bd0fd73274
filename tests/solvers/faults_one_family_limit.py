"""Seeded faults seen in the limit of small waves in thin layers: each an error of the order of the depth."""

from tests.faults import Fault
from tests.solvers.waves.test_thin_limit import gap_goes_with_the_height as gap

FAULTS = (
    Fault("fluid.kdv", "3.0 * spin / surface_radius**2", "3.0 * spin / radius**2", gap),
    Fault("fluid.kdv", "log * surface_radius / (2.0", "log * radius / (2.0", gap),
    Fault("fluid.kdv", "k * abs(c.linear_speed) /", "0.5 * k + 0.0 * abs(c.linear_speed) /", gap),
    Fault("fluid.kdv", "spin * log**3 / 3.0 * share", "spin * log**3 * (1.0 + log) / 3.0 * share", gap),
    Fault("fluid.kdv", "c.surface_radius / c.mean_area * first", "c.radius / c.mean_area * first", gap),
)  # fmt: skip
