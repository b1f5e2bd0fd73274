"""Seeded faults in what reports print: units, signs, parts swapped, warnings lost or raised for nothing."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc.test_report import check_ranges
from tests.leblanc.test_report_inputs import check_units, check_units_of_other_rotors
from tests.leblanc.test_report_kinds import (
    check_events,
    check_optimum_numbers,
    check_optimum_warnings,
    check_runup_numbers,
    check_runup_warnings,
)

BEST, UP = "leblanc.report.optimise", "leblanc.report.runup"

FAULTS: tuple[Fault, ...] = (
    Fault("leblanc.text.numbers", "rpm[change[1::2] - 1]", "rpm[change[1::2]]", check_ranges),
    # The inputs.
    Fault(
        "leblanc.report.inputs",
        "number(machine.natural_frequency * RPM)",
        "number(machine.natural_frequency)",
        check_units,
    ),
    Fault(
        "leblanc.report.inputs", "degrees(heavy.angle)", "radians(heavy.angle)", check_units_of_other_rotors
    ),
    Fault(
        "leblanc.report.inputs", "number(one.damping),", "number(one.stiffness),", check_units_of_other_rotors
    ),
    Fault("leblanc.report.inputs", "balls.mass * 1e3", "balls.mass", check_units_of_other_rotors),
    Fault("leblanc.report.inputs", "length * MM", "length", check_units_of_other_rotors),
    Fault("leblanc.report.inputs", "fill.volume * ML", "fill.volume", check_units),
    Fault("leblanc.report.inputs", "one.inner_radius * MM", "one.radius * MM", check_units),
    Fault("leblanc.report.inputs", "100.0 * model.tolerance", "model.tolerance", check_units),
    Fault("leblanc.report.inputs", "one.wall_gap * MM", "one.tip_radius * MM", check_units),
    Fault(
        "leblanc.report.inputs",
        "at {number(speed * RPM)} rpm",
        "at {number(speed)} rpm",
        check_units_of_other_rotors,
    ),
    Fault("leblanc.report.inputs", "value * RPM", "value", check_units),
    Fault("leblanc.report.inputs", "value * MM", "value", check_units),
    Fault("leblanc.report.inputs", "low * ML", "high * ML", check_units),
    # The optimum.
    Fault(
        BEST,
        "100.0 * volume / fill.chamber.capacity",
        "volume / fill.chamber.capacity",
        check_optimum_numbers,
    ),
    Fault(BEST, "number(value / baseline)", "number(baseline / value)", check_optimum_numbers),
    Fault(BEST, "number(form.optimal_volume * ML)", "number(form.full_volume * ML)", check_optimum_numbers),
    Fault(BEST, "number(-record.growth)", "number(record.growth)", check_optimum_numbers),
    Fault(BEST, "float(edge.margin[k])", "-float(edge.margin[k])", check_optimum_numbers),
    Fault(BEST, "edge.volume == record.volume", "edge.volume >= record.volume", check_optimum_numbers),
    Fault(BEST, "record.growth > 0.0", "record.growth < 0.0", check_optimum_warnings),
    Fault(
        BEST,
        "record.constraints.items() if not one.satisfied",
        "record.constraints.items() if one.satisfied",
        check_optimum_warnings,
    ),
    Fault(
        BEST,
        "shown(one.value, one.unit), shown(one.limit, one.unit)",
        "shown(one.limit, one.unit), shown(one.value, one.unit)",
        check_optimum_warnings,
    ),
    # The run-up.
    Fault(
        UP,
        "float(h.speed[k]) * RPM),\n            number(float(h.time[k])),\n        )",
        "float(h.speed[k])),\n            number(float(h.time[k])),\n        )",
        check_runup_numbers,
    ),
    Fault(UP, "record.peak(back=True)", "record.peak()", check_runup_numbers),
    Fault(UP, "100.0 * value / work", "100.0 * value", check_runup_numbers),
    Fault(UP, "if name in GAINS else", "if name not in GAINS else", check_runup_numbers),
    Fault(
        UP, "math.atan2(place.imag, place.real)", "math.atan2(place.real, place.imag)", check_runup_numbers
    ),
    Fault(UP, 'f"{number(100.0 * value)} %"', 'f"{number(value)} %"', check_runup_numbers),
    Fault(UP, "reason, not h.converged", "reason, h.converged", check_runup_warnings),
    Fault(UP, "loose, depth = ~h.captured[:, k]", "loose, depth = h.captured[:, k]", check_runup_warnings),
    Fault(UP, "<= DRY * depth", "<= depth", check_runup_warnings),
    Fault(UP, "bool((~record.in_range).any())", "bool((~record.in_range).all())", check_runup_warnings),
    Fault(UP, "not h.error_estimate <= ERROR", "h.error_estimate > ERROR", check_runup_warnings),
    Fault(UP, "bad = not value <= most", "bad = value <= most", check_runup_warnings),
    Fault(
        UP,
        "time[change[::2]], time[change[1::2] - 1]",
        "time[change[::2]], time[change[1::2]]",
        check_runup_warnings,
    ),
    Fault(
        UP, "'captured' if caught else 'falls back'", "'falls back' if caught else 'captured'", check_events
    ),
)
