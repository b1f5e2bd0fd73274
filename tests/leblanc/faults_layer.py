"""Seeded faults of the layer's answer and of the numbers of a scene."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc.studies import test_explain, test_layer

FAULTS: tuple[Fault, ...] = (
    Fault(
        "leblanc.studies.layer",
        "moment / fill.volume - amplitude",
        "moment / fill.volume + amplitude",
        test_layer.check_statics,
    ),
    Fault(
        "leblanc.studies.layer",
        "- amplitude * np.cos(theta), chamber",
        "+ amplitude * np.cos(theta), chamber",
        test_layer.check_statics,
    ),
    Fault(
        "leblanc.studies.layer",
        "surface + displacement * np.cos",
        "surface - displacement * np.cos",
        test_layer.check_linear,
    ),
    Fault(
        "leblanc.studies.layer",
        "ratio = (chamber.radius / surface) ** 2, whirl.speed / speed",
        "ratio = (chamber.radius / surface) ** 2, speed / whirl.speed",
        test_layer.check_linear,
    ),
    Fault(
        "fluid.numbers",
        "np.square(spin) * surface / gravity",
        "spin * surface / gravity",
        test_explain.check_numbers,
    ),
    Fault(
        "fluid.numbers",
        "spin * radius**2 / viscosity if viscosity > 0.0",
        "spin * radius / viscosity if viscosity > 0.0",
        test_explain.check_numbers,
    ),
    Fault(
        "fluid.numbers",
        "np.sqrt(viscosity / spin) / fill.depth",
        "viscosity / spin / fill.depth",
        test_explain.check_numbers,
    ),
    Fault(
        "fluid.fill",
        "film / (self.chamber.radius + self.surface_radius)",
        "film / (2.0 * self.chamber.radius)",
        test_explain.check_numbers,
    ),
    Fault(
        "fluid.fill",
        "self.chamber.radius**2 - self.volume / (math.pi",
        "self.chamber.radius**2 - self.volume / (2.0 * math.pi",
        test_explain.check_numbers,
    ),
    Fault(
        "leblanc.studies.choose", "speed > captured_from", "speed < captured_from", test_explain.check_capture
    ),
)
