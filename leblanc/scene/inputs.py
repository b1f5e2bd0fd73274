"""All that a scene says, for readers: rows, tables of its parts, each value marked that no source gives."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS, Liquid
from fluid.temperature import Expansion, GivenLaw, PropertyLaw, Tabulated, Vogel, Walther
from leblanc.core.netcdf import Variable, variable
from leblanc.core.page import About
from leblanc.core.units import (
    ANGULAR_SPEED,
    LENGTH,
    MASS,
    MINUS,
    MM,
    RPM,
    UNBALANCE,
    VOLUME,
    Dimension,
    Unit,
    celsius,
    friction_words,
    in_rpm,
    number,
    unit_for,
)
from leblanc.scene.cabinet import point_table
from leblanc.scene.rotors import JeffcottRotor
from leblanc.scene.rows import Row, RowTable, Value, curve_words, degrees, mm, row, rpm, three
from leblanc.scene.scene import WITHOUT_CHAMBERS, Model, Scene
from leblanc.scene.schema.load import escaped
from leblanc.scene.tasks import BallRanges, Layout, Optimisation, Runup, pairs_of
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection
from solvers.rotor.system import moving_mass
from solvers.rotor.vibration import critical_speeds

MOST = 6  # speeds of a duty cycle that are listed one by one

_BAFFLES = ("Chamber", "baffles", "tips at (mm)", "gap at the wall (mm)", "first at (deg)", "loss")
_SECTIONS = ("Chamber", "section", "area (cm²)", "farthest wall (mm)", "cells at the wall (mm)")


@dataclass(frozen=True)
class SceneInputs:
    """What a scene says."""

    rows: tuple[Row, ...]  #: single values
    tables: tuple[RowTable, ...]  #: of what there may be several of: chambers, supports, springs


def inputs_of(scene: Scene, optimise: Optimisation | None = None) -> SceneInputs:
    """Everything that a scene says.

    `optimise` takes the place of the scene's; what differs from that is not marked as assumed.
    """
    rows = [
        *scene.rotor.rows(),
        *(() if scene.cabinet is None else scene.cabinet.rows()),
        row("Gravity", f"{number(scene.gravity)} m/s²", "gravity"),
        *_study(scene),
        *(() if scene.runup is None else _runup(scene.runup)),
        *(() if scene.programme is None else scene.programme.rows()),
    ]
    marked = [
        Row(entry.label, tuple(value.marked(scene.assumed) for value in entry.values)) for entry in rows
    ]
    wanted = scene.optimise if optimise is None else optimise
    if wanted is not None:
        marked += _optimise(wanted, scene)
    tables = [
        RowTable(table.head, tuple(tuple(v.marked(scene.assumed) for v in line) for line in table.rows))
        for table in (*scene.rotor.tables(), *_around(scene), *_chambers(scene), *_races(scene))
    ]
    return SceneInputs(tuple(marked), tuple(tables))


def machine_variables(scene: Scene) -> dict[str, Variable]:
    """Masses, capacities, critical speeds without liquid: what a data file needs to be read alone."""
    if isinstance(scene.rotor, WITHOUT_CHAMBERS) or not hasattr(scene.rotor, "machine"):
        return {}
    rotor, over = scene.rotor.machine(), ("machine_chamber",)
    speed, critical = critical_speeds(rotor.system())[0], ("machine_critical",)
    speed = speed[np.diff(speed, prepend=0.0) > 1e-9 * speed]  # of two directions that are alike one
    found = {
        "machine_mass": variable((), moving_mass(rotor), "kg", "mass that moves with the axis", "no liquid"),
        "machine_critical_speed": variable(
            critical, speed, "rad s-1", "critical speeds", "no liquid, undamped"
        ),
    }
    if scene.fills:
        masses, rooms = zip(*((fill.mass, fill.chamber.capacity) for fill in scene.fills), strict=True)
        found["machine_liquid_mass"] = variable(over, np.array(masses), "kg", "mass of the liquid")
        found["machine_capacity"] = variable(over, np.array(rooms), "m3", "capacity of the chamber")
    return found


def about(
    scene: Scene,
    command: str = "",
    data: str = "",
    task: Optimisation | None = None,
    unused: tuple[str, ...] = (),
) -> About:
    """What a report of a scene is about.

    `task` takes the place of the scene's optimisation; the report's numbers do not depend on its `unused`
    tables.
    """
    found = inputs_of(scene, task)
    aside = tuple(row for row in found.rows if row.path.partition(".")[0] in unused)
    tabled = (value for table in found.tables for line in table.rows for value in line)
    values = (*(value for row in found.rows for value in row.values), *tabled)
    paths = [value.path for value in values if value.assumed]
    elsewhere = tuple(
        path
        for path in scene.assumed
        if not any(own == path or own.startswith(f"{path}.") or path.startswith(f"{own}.") for own in paths)
    )
    return About(
        *(scene.name, scene.source, scene.digest),
        rows=tuple(row for row in found.rows if row not in aside),
        tables=found.tables,
        unused=aside,
        elsewhere=elsewhere,
        command=command,
        data=data,
    )


def input_rows(
    scene: Scene, roots: tuple[str, ...] = ("rotor", "cabinet", "points", "chambers", "speeds")
) -> tuple[tuple[str, str, str], ...]:
    """Label, value with its unit and field path of each value under some tables, as data files keep them.

    `roots`: those tables, keys or parts of them, in their order.
    """
    found = inputs_of(scene)
    single = [*found.rows, *(entry for table in found.tables for entry in table.single())]
    return tuple(
        (entry.label, escaped(" ".join(value.text for value in entry.values)).replace(MINUS, "-"), entry.path)
        for root in roots
        for entry in single
        if entry.path == root or entry.path.startswith(f"{root}.")
    )


def runup_rows(scene: Scene, cells: int, dispersion: bool) -> tuple[tuple[str, str, str], ...]:
    """Label, value with its unit and field path of what a run-up takes from its scene.

    `cells` of each layer and `dispersion` take the place of the scene's.
    """
    assert scene.speed_plan is not None
    plan, name = scene.speed_plan.altered(cells=cells, dispersion=dispersion), "runup"
    if scene.programme is not None:
        name = "programme"
    return input_rows(
        scene.altered(**{name: plan}), ("rotor", "cabinet", "points", name, "model.friction", "chambers")
    )


def _around(scene: Scene) -> Iterator[RowTable]:
    """Feet of the cabinet and named points."""
    if scene.cabinet is not None:
        yield from scene.cabinet.tables()
    if scene.points:
        yield point_table(scene.points)


def _chambers(scene: Scene) -> Iterator[RowTable]:
    """Sizes and fill; the plane along the axis where some chamber has one."""
    walls = [fill.chamber for fill in scene.fills]
    length = unit_for(LENGTH, *(size for wall in walls for size in (wall.radius, wall.height, wall.plane)))
    volume = unit_for(VOLUME, *(fill.volume for fill in scene.fills))
    sizes = [f"{name} ({length.name})" for name in ("radius", "inner radius", "height", "plane")]
    head = ["Chamber", *sizes, f"volume ({volume.name})", "liquid"]
    rows = [_chamber(fill, k, length, volume) for k, fill in enumerate(scene.fills)]
    if isinstance(scene.rotor, JeffcottRotor) and all(wall.plane == 0.0 for wall in walls):
        del head[4]
        rows = [(*line[:4], *line[5:]) for line in rows]
    baffles = [(k, fill.chamber.baffles) for k, fill in enumerate(scene.fills)]
    sections = [(k, fill.chamber.section) for k, fill in enumerate(scene.fills)]
    for titles, lines in (
        (tuple(head), rows),
        (_BAFFLES, [_baffle(plates, k) for k, plates in baffles if plates is not None]),
        (_SECTIONS, [_section(section, k) for k, section in sections if section is not None]),
    ):
        if lines:
            yield RowTable(titles, tuple(lines))


def _races(scene: Scene) -> Iterator[RowTable]:
    """The races with their balls."""
    head = ("Race", "balls", "path's radius (mm)", "plane (mm)", "mass of each (g)", "drag (N s/m)", "motion")
    rows = []
    for number_of, race in enumerate(scene.balls):
        at = f"chambers.{len(scene.liquids) + number_of}"
        own = f"{at}.{'mass' if race.density is None else 'density'}"
        how: str = race.motion
        if race.rolling_resistance:
            how = f"{how}, resistance {number(race.rolling_resistance)}"
        if race.liquid is not None:
            how = f"{how}, in {race.liquid.name}"
        if race.start == "bottom":
            how = f"{how}, from the bottom"
        if race.start_angle:
            how = f"{how}, from {degrees(race.start_angle)} deg"
        size = "" if race.diameter is None else f" of {number(race.diameter * MM)} mm"
        rows.append(
            (
                Value(f"{number_of + 1}"),
                Value(f"{race.count}{size}", (f"{at}.count", f"{at}.diameter")),
                Value(number(race.radius * MM), (f"{at}.radius",)),
                Value(number(race.plane * MM), (f"{at}.plane",)),
                Value(number(race.each * 1e3), (own,)),
                Value(number(race.drag), (f"{at}.drag",)),
                Value(
                    how,
                    tuple(
                        f"{at}.{key}"
                        for key in ("motion", "rolling_resistance", "liquid", "start", "start_angle")
                    ),
                ),
            )
        )
    if rows:
        yield RowTable(head, tuple(rows))


def _chamber(fill: Fill, k: int, length: Unit, volume: Unit) -> tuple[Value, ...]:
    chamber, at, name = fill.chamber, f"chambers.{k}", fill.liquid.name
    if KNOWN_LIQUIDS.get(name) != fill.liquid:
        density, viscosity = number(fill.liquid.density), number(fill.liquid.viscosity * 1e6)
        name = f"{name}, {density} kg/m³, {viscosity} mm²/s{_over_temperature(fill.liquid)}"
    wall = (
        Value(length.number(chamber.radius), (f"{at}.radius",)),
        Value(length.number(chamber.inner_radius), (f"{at}.inner_radius",)),
    )
    if chamber.section is not None:
        wall = Value("see section"), Value("")
    return (
        Value(f"{k + 1}"),
        *wall,
        Value(length.number(chamber.height), (f"{at}.height",)),
        Value(length.number(chamber.plane), (f"{at}.plane",)),
        Value(volume.number(fill.volume), (f"{at}.volume",)),
        Value(name, (f"{at}.liquid",)),
    )


def _over_temperature(liquid: Liquid) -> str:
    """The laws that the scene gives; a brine says by its name what it is."""
    law = liquid.law
    if not isinstance(law, GivenLaw):
        return ""
    parts = [
        f"{name} {words}"
        for name, words in (("density", _law(law.density)), ("viscosity", _law(law.viscosity)))
        if words
    ]
    span = f"from {celsius(law.lowest)} to {celsius(law.highest)}"
    return f" at {celsius(law.reference)}; {'; '.join(parts)}; {span}"


def _law(law: PropertyLaw) -> str:
    """One law with its numbers; nothing of a property that does not change."""
    if isinstance(law, Tabulated):
        return f"from a table of {len(law.values)}"
    if isinstance(law, Expansion):
        at = f"{number(law.value)} kg/m³ at {celsius(law.temperature)}"
        return f"{at}, expansion {number(law.expansion)} 1/K"
    if isinstance(law, Walther):
        pairs = zip(law.values, law.temperatures, strict=True)
        points = (f"{number(value * 1e6)} mm²/s at {celsius(heat)}" for value, heat in pairs)
        return f"{' and '.join(points)} by Walther"
    if isinstance(law, Vogel):
        shift = f", c = {number(law.c)} K by Vogel" if law.c else " by Andrade"
        return f"a = {number(law.a * 1e6)} mm²/s, b = {number(law.b)} K{shift}"
    return ""


def _section(section: ChamberSection, k: int) -> tuple[Value, ...]:
    path, unit, size = (f"chambers.{k}.section{end}" for end in ("", "_unit", "_size"))
    cells = "as in the file" if section.cell_size is None else number(section.cell_size * MM)
    return (
        Value(f"{k + 1}"),
        Value(section.name, (path,)),
        Value(number(section.area * 1e4), (path, unit)),
        Value(number(section.farthest * MM), (unit, path)),
        Value(cells, (size,)),
    )


def _baffle(baffles: Baffles, k: int) -> tuple[Value, ...]:
    at = f"chambers.{k}.baffles"
    return (
        Value(f"{k + 1}"),
        Value(f"{baffles.count}", (f"{at}.count",)),
        Value(number(baffles.tip_radius * MM), (f"{at}.tip_radius", f"{at}.height")),
        Value(number(baffles.wall_gap * MM), (f"{at}.wall_gap",)),
        Value(degrees(baffles.first_angle), (f"{at}.first_angle",)),
        Value("by depth and flow" if baffles.loss is None else number(baffles.loss), (f"{at}.loss",)),
    )


def _study(scene: Scene) -> list[Row]:
    """Speeds and models."""
    speeds, model = scene.speeds, scene.model
    several = "" if speeds.count == 1 else "s"
    return [
        Row(
            "Speeds",
            (
                Value(number(speeds.start * RPM), ("speeds.start",)),
                Value(f"to {in_rpm(speeds.stop)}", ("speeds.stop",)),
                Value(f"at {speeds.count} speed{several}", ("speeds.count",)),
            ),
        ),
        row("Liquid model", model.liquid, "model.liquid"),
        row("Liquid friction", friction_words(model.friction), "model.friction"),
        row("Tolerance", f"{number(100.0 * model.tolerance)} %", "model.tolerance"),
        *_held(model),
    ]


def _held(model: Model) -> list[Row]:
    """How waves are integrated in time, where they are."""
    if model.held == "never" and model.liquid not in ("long_wave", "potential"):
        return []
    held = [row("Time-domain states", model.held, "model.held")] if model.held != "never" else []
    return [*held, row("Cells of a held wave", str(model.cells), "model.cells")]


def _runup(plan: Runup) -> list[Row]:
    ramp = "runup.ramp_time" if plan.ramp_time is not None else ""
    found = [
        row("Run-up from", rpm(plan.start), "runup.start", ramp),
        row("Run-up to", rpm(plan.stop), "runup.stop", ramp),
    ]
    if plan.rate is not None:
        found.append(row("Run-up rate", f"{number(plan.rate)} rad/s²", "runup.rate", ramp))
    if plan.motor is not None:
        motor, curve = plan.motor, curve_words(plan.motor.speeds, plan.motor.torques)
        found += [
            row("Inertia on the motor", f"{number(motor.inertia)} kg m²", "runup.motor.inertia"),
            row("Motor's torque", curve, "runup.motor.torques", "runup.motor.speeds"),
        ]
    return [
        *found,
        row("Run-up lasts", f"{number(plan.duration)} s", "runup.duration"),
        row("Run-up then", "down again" if plan.back else "held", "runup.back"),
        row("Run-up cells", f"{plan.cells} round each wall", "runup.cells"),
        row("Run-up dispersion", "with" if plan.dispersion else "without", "runup.dispersion"),
        *([] if plan.bore == "none" else [row("Turbulence of jumps", f"with {plan.bore}", "runup.bore")]),
        *([] if plan.capture == "carried" else [row("Centrifuged", plan.capture, "runup.capture")]),
        row("Run-up samples", f"{plan.samples}", "runup.samples"),
    ]


# -- what the liquid is chosen for ---------------------------------------------------------------------------

_DEFAULT = Optimisation()


_OVER = {
    "operating": "at the operating speeds",
    "runup": "over the run-up in time",
    "both": "at the operating speeds and over the run-up in time",
}


def optimise_rows(wanted: Optimisation) -> list[Row]:
    """Rows of the objective and of what differs from the defaults."""
    said = [row("Objective", wanted.objective, "optimise.objective")]
    for name, label, text in (
        ("working_speed", "Working speed", _speed(wanted.working_speed)),
        ("steady", "Peak", "of the steady response"),
        ("duty", "Duty cycle", _duty(wanted)),
        ("vibration_limit", "Vibration limit", _length(wanted.vibration_limit)),
        ("limit_at", "Limit holds at", f"{wanted.limit_at.replace('_', ' ')} speeds"),
        ("deflection", "Deflection given", _length(wanted.deflection)),
        ("unbalance", "Unbalance range", _unbalances(wanted)),
        ("temperature", "Temperature range", _temperatures(wanted.temperature)),
        ("quantile", "Quantile", number(wanted.quantile)),
        ("samples", "Samples of the ranges", f"{wanted.samples}"),
        ("seed", "Seed", f"{wanted.seed}"),
        ("dry_patch", "Dry wall", "not allowed at the working speed"),
        ("stable", "Small whirls", "may grow"),
        ("stability_margin", "Stability margin", _rate(wanted.stability_margin)),
        ("least_film", "Thinnest film", _length(wanted.least_film)),
        ("whirl_limit", "Whirl limit", _length(wanted.whirl_limit)),
        ("spill", "Inner edge", "may be reached at the working speed"),
        ("operating", "Operating speeds", _span(wanted.operating, ANGULAR_SPEED)),
        ("clearance", "Clearance", _length(wanted.clearance)),
        ("loads_over", "Loads looked at", _OVER[wanted.loads_over]),
        ("floor_force", "Largest force under a foot", _plain(wanted.floor_force, " N")),
        ("walking_margin", "Least margin against walking", _plain(wanted.walking_margin)),
        ("slip_margin", "Least margin against slipping", _plain(wanted.slip_margin)),
        ("point_clearance", "Least clearance of a point", _length(wanted.point_clearance)),
        ("motor_torque", "Largest torque of the motor", _plain(wanted.motor_torque, " N m")),
        ("balance_quality", "Balance quality", _grade(wanted.balance_quality)),
        ("volumes", "Volumes", _volumes(wanted)),
        ("layout", "Layout of the mounts", _layout(wanted.layout)),
        ("balls", "Balls", _ball_ranges(wanted.balls)),
    ):
        if getattr(wanted, name) != getattr(_DEFAULT, name):
            said.append(row(label, text, f"optimise.{name}"))
    return said


def _optimise(wanted: Optimisation, scene: Scene) -> list[Row]:
    """What is wanted; a value that is not the scene's own is not marked."""
    own = [] if scene.optimise is None else optimise_rows(scene.optimise)
    return [
        Row(entry.label, tuple(value.marked(scene.assumed) for value in entry.values))
        if entry in own
        else entry
        for entry in optimise_rows(wanted)
    ]


def _speed(value: float | None) -> str:
    return "" if value is None else in_rpm(value)


def _length(value: float | None) -> str:
    return "" if value is None else mm(value)


def _plain(value: float | None, unit: str = "") -> str:
    return "" if value is None else f"{number(value)}{unit}"


def _grade(value: float | None) -> str:
    return "" if value is None else f"at most {number(value * 1e3)} mm/s (G {number(value * 1e3)})"


def _rate(value: float | None) -> str:
    return "" if value is None else f"at least {number(value)} 1/s"


def _span(ends: tuple[float, float] | None, dimension: Dimension) -> str:
    if ends is None:
        return ""
    unit = unit_for(dimension, *ends)
    return f"{unit.number(ends[0])} to {unit.text(ends[1])}"


def _temperatures(ends: tuple[float, float] | None) -> str:
    return "" if ends is None else " to ".join(map(celsius, ends))


def _unbalances(wanted: Optimisation) -> str:
    """One range, or one for each unbalance."""
    ranges = wanted.unbalance
    if ranges is None:
        return ""
    return "; ".join(_span(ends, UNBALANCE) for ends in pairs_of(ranges))


def _duty(wanted: Optimisation) -> str:
    parts = [f"{in_rpm(point.speed)} (weight {number(point.weight)})" for point in wanted.duty]
    if len(parts) <= MOST:
        return ", ".join(parts)
    return f"{len(parts)} speeds from {parts[0]} to {parts[-1]}"


def _layout(wanted: Layout | None) -> str:
    if wanted is None:
        return ""
    found = (
        f"{wanted.measure}, places by {three(wanted.reach, MM)} mm, directions by {degrees(wanted.turn)} deg"
    )
    band = "" if wanted.band is None else f", running at {_span(wanted.band, ANGULAR_SPEED)}"
    return found + band + ("" if wanted.sag is None else f", sag at most {mm(wanted.sag)}")


def _ball_ranges(wanted: BallRanges | None) -> str:
    if wanted is None:
        return ""
    spans = (
        ("balls", wanted.count and f"{wanted.count[0]} to {wanted.count[1]}"),
        ("mass", _span(wanted.mass, MASS)),
        ("diameter", _span(wanted.diameter, LENGTH)),
        ("drag", wanted.drag and f"{number(wanted.drag[0])} to {number(wanted.drag[1])} N s/m"),
        ("radius", _span(wanted.radius, LENGTH)),
    )
    return ", ".join(f"{name} {text}" for name, text in spans if text)


def _volumes(wanted: Optimisation) -> str:
    return ", ".join(f"chamber {k + 1} {_span(span, VOLUME)}" for k, span in enumerate(wanted.volumes))
