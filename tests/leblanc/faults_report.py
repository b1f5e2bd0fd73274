"""Seeded faults in what reports print: units, signs, parts swapped, warnings lost or raised for nothing."""

from __future__ import annotations

from tests.faults import Fault
from tests.leblanc.test_report import check_comparisons, check_ranges, check_warnings
from tests.leblanc.test_report_kinds import (
    check_events,
    check_exciter_numbers,
    check_exciter_warnings,
    check_map_numbers,
    check_map_warnings,
    check_optimum_numbers,
    check_optimum_warnings,
    check_runup_numbers,
    check_runup_warnings,
)

RUN, MAP, BEST, UP, TABLE = (
    f"study.report_{name}" for name in ("run", "map", "optimise", "runup", "exciter")
)

FAULTS: tuple[Fault, ...] = (
    Fault("leblanc.text.numbers", "rpm[change[1::2] - 1]", "rpm[change[1::2]]", check_ranges),
    # The response.
    Fault(RUN, "number(with_liquid / without) if", "number(without / with_liquid) if", check_comparisons),
    Fault(
        RUN,
        "number(with_liquid * MM), number(without * MM)",
        "number(without * MM), number(with_liquid * MM)",
        check_comparisons,
    ),
    Fault(RUN, "number(with_liquid * RPM)", "number(without * RPM)", check_comparisons),
    Fault(RUN, "math.degrees(r.liquid_angle[-1])", "math.degrees(-r.liquid_angle[-1])", check_comparisons),
    Fault(RUN, "r.liquid_offset[-1] * MM", "r.liquid_offset[-1]", check_comparisons),
    Fault(RUN, "record.liquid_mass * 1e3", "record.liquid_mass * 1e6", check_comparisons),
    Fault(RUN, "ranges(r.speed, ~r.converged)", "ranges(r.speed, r.converged)", check_warnings),
    Fault(RUN, "bool((~r.in_range).any())", "bool(r.in_range.any())", check_warnings),
    Fault(RUN, "r.speed <= record.capture_speed", "r.speed >= record.capture_speed", check_warnings),
    Fault(RUN, "~(record.error_estimate <= tolerance)", "record.error_estimate > tolerance", check_warnings),
    Fault(RUN, "bool(r.dry_patch.any())", "bool(r.dry_patch.all())", check_warnings),
    Fault(RUN, "bool((~r.stable).any())", "False", check_warnings),
    Fault(RUN, "{low * RPM:.5g} to {high * RPM:.5g}", "{low:.5g} to {high:.5g}", check_warnings),
    Fault(RUN, "np.isinf(record.amplitude)", "np.isnan(record.amplitude)", check_warnings),
    # The map.
    Fault(
        MAP, "record.whirl_speed[row, column]) / speed", "record.whirl_speed[row, column])", check_map_numbers
    ),
    Fault(MAP, "np.nanargmax(growth)", "np.nanargmin(growth)", check_map_numbers),
    Fault(
        MAP,
        "np.count_nonzero(unstable)) / size",
        "np.count_nonzero(unstable)) / growth.shape[0]",
        check_map_numbers,
    ),
    Fault(MAP, "float(np.nanmax(growth))", "float(np.nanmin(growth))", check_map_numbers),
    Fault(MAP, "band_words(record.edges[k])", "band_words(record.edges[-1 - k])", check_map_numbers),
    Fault(MAP, "float(record.volume[k]) * ML", "float(record.volume[k])", check_map_numbers),
    Fault(
        MAP,
        "np.isnan(record.growth), ~record.in_range",
        "np.isnan(record.growth), record.in_range",
        check_map_warnings,
    ),
    Fault(MAP, "out & (record.growth > 0.0)", "out & (record.growth < 0.0)", check_map_warnings),
    Fault(MAP, "bool(record.scene_edges)", "False", check_map_warnings),
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
    # The exciter.
    Fault(
        TABLE,
        "first, through, last = record.characteristic",
        "first, last, through = record.characteristic",
        check_exciter_numbers,
    ),
    Fault(TABLE, "number(speed * RPM)} rpm", "number(speed)} rpm", check_exciter_numbers),
    Fault(TABLE, "float(record.slow[-1]) * MM", "float(record.fast[-1]) * MM", check_exciter_numbers),
    Fault(TABLE, "one.stuck_speed * RPM", "one.speed * RPM", check_exciter_numbers),
    Fault(TABLE, "beyond = ~record.dual_frequency", "beyond = record.dual_frequency", check_exciter_warnings),
    Fault(TABLE, "if not one.converged]", "if not one.holds]", check_exciter_warnings),
    Fault(TABLE, "outside = not math", "outside = math", check_exciter_warnings),
)
