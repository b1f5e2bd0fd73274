"""Seeded faults of rotors whose chambers have baffles."""

from __future__ import annotations

from tests.faults import Fault
from tests.solvers import test_sections as oracle

FILL, REDUCED, LAYER = "fluid.fill", "solvers.sloshing.reduced", "solvers.sloshing.reduced"
DRUM, STANDING = "solvers.whirl.sections", "solvers.whirl.sections"

FAULTS: tuple[Fault, ...] = (
    Fault(
        FILL,
        "self.liquid.density * math.pi * self.chamber.radius**2 * self.chamber.height",
        "self.liquid.density * math.pi * self.chamber.radius * self.chamber.height",
        oracle.check_all_compartments,
    ),
    Fault(
        FILL, "math.sin(math.pi / count)) ** 2", "math.sin(math.pi / count))", oracle.check_all_compartments
    ),
    Fault(
        FILL,
        "self.compartments) * self.surface_radius**2",
        "self.compartments)",
        oracle.check_all_compartments,
    ),
    Fault(
        FILL,
        "return self.full_mass - self.liq",
        "return self.full_mass + self.liq",
        oracle.check_all_compartments,
    ),
    Fault(
        "solvers.synchronous.backward",
        "whole = layer.density * layer.liquid.enclosed_area",
        "whole = fill.full_mass * 1.0",
        oracle.check_section_added_mass,
    ),
    Fault(FILL, "if not self.uneven:\n                return self.mass", "", oracle.check_section_added_mass),
    Fault(
        FILL,
        "layer_depth(section, area) if 0.0",
        "self.chamber.radius - self.surface_radius if 0.0",
        oracle.check_least_depth,
    ),
    Fault(FILL, "(self.volume + air)", "(self.volume - air)", oracle.check_section_added_mass),
    Fault(REDUCED, "-np.square(s) * self.inertia", "np.square(s) * self.inertia", oracle.check_clear_ring),
    Fault(REDUCED, "+ 2j * s * self.gyration", "- 2j * s * self.gyration", oracle.check_clear_ring),
    Fault(REDUCED, "np.square(1.0 + s) * moved", "np.square(s) * moved", oracle.check_clear_ring),
    Fault(REDUCED, "along - 1j * across", "along + 1j * across", oracle.check_clear_ring),
    Fault(LAYER, "gyration=tangent * turn", "gyration=-tangent * turn", oracle.check_clear_ring),
    Fault(LAYER, "math.sqrt(math.pi * tangent)", "math.sqrt(math.pi)", oracle.check_clear_ring),
    Fault(
        LAYER,
        "density = fill.liquid.density * chamber.height",
        "density = fill.liquid.density",
        oracle.check_clear_whirl,
    ),
    Fault(LAYER, "plain.stokes * liquid.inertia", "plain.rate * liquid.inertia", oracle.check_clear_whirl),
    Fault(
        LAYER,
        "2.0 / chamber.height * liquid.inertia",
        "1.0 / chamber.height * liquid.inertia",
        oracle.check_friction,
    ),
    Fault(LAYER, "return liquid, drag / radius", "return liquid, drag", oracle.check_friction),
    Fault(LAYER, "along.T @ (weights[:, None] * along)", "along.T @ along", oracle.check_wall_drag),
    Fault(DRUM, "2.0 * spin * twist", "spin * twist", oracle.check_clear_whirl),
    Fault(DRUM, "[heavy * _TURN, _TURN @ pull]", "[heavy * _TURN, -_TURN @ pull]", oracle.check_clear_whirl),
    Fault(DRUM, "spin * turned + support", "support", oracle.check_clear_whirl),
    Fault(DRUM, "[-pull.T, surface]", "[pull.T, surface]", oracle.check_clear_whirl),
    Fault(DRUM, "damping + 1.5 * drag", "damping - 15.0 * drag", oracle.check_clear_whirl),
    Fault(DRUM, "drag = np.sqrt(at)", "drag = np.sqrt(-at)", oracle.check_clear_whirl),
    Fault(
        STANDING, "twist - circle.density * turn", "twist + circle.density * turn", oracle.check_two_frames
    ),
    Fault(
        STANDING,
        "spread - unit - 2.0 * turn @ twist",
        "spread - unit + 2.0 * turn @ twist",
        oracle.check_two_frames,
    ),
    Fault(
        STANDING,
        "- circle.rate * circle.density * spin * turn",
        "+ circle.rate * circle.density * spin * turn",
        oracle.check_two_frames,
    ),
    Fault(STANDING, "for way in (-1j, 1j):", "for way in (1j, -1j):", oracle.check_two_frames),
    Fault(STANDING, "-0.5j * (pair[0] - pair[1])", "0.5j * (pair[0] - pair[1])", oracle.check_two_frames),
    Fault(
        STANDING,
        "pull = -circle.density",
        "pull = circle.density * 0.5",
        oracle.check_layer_as_in_the_standing_system,
    ),
)
