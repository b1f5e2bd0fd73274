"""All that a scene says, in units that engineers use, each value marked that no source gives."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS
from leblanc.friction import friction_words
from leblanc.report.parts import Cell, Table
from leblanc.results.provenance import one_line
from leblanc.scene.machine import dry_rotor
from leblanc.scene.optimise import Aim
from leblanc.scene.scene import Exciter, Rotor, Runup, Scene
from leblanc.text.numbers import number
from leblanc.units import ML, MM, RPM
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import TwoPlane

Row = tuple[Cell, ...]


@dataclass(frozen=True)
class Entry:
    """One or a few values under one label."""

    label: str
    cells: Row


class Marker:
    """Makes cells and marks those whose value no source gives.

    Parameters
    ----------
    assumed : paths in the scene, of values or of whole tables
    """

    def __init__(self, assumed: tuple[str, ...]) -> None:
        self.assumed = assumed

    def cell(self, text: str, path: str, *derived_from: str) -> Cell:
        """A value at a path; one that is derived is as doubtful as what it comes from."""
        paths = path, *derived_from
        marked = any(
            own == one or own.startswith(f"{one}.") or one.startswith(f"{own}.")
            for own in paths
            for one in self.assumed
        )
        return Cell(one_line(text), marked, path=path)

    def entry(self, label: str, text: str, path: str, *derived_from: str) -> Entry:
        """The only value under a label."""
        return Entry(label, (self.cell(text, path, *derived_from),))


def rpm(speed: float) -> str:
    """A speed in both units."""
    return f"{number(speed * RPM)} rpm ({number(speed)} rad/s)"


def mm(length: float) -> str:
    """A length."""
    return f"{number(length * MM)} mm"


def unbalance(size: float) -> str:
    """Mass times its distance from the axis."""
    return f"{number(size * 1e6)} g mm"


AimRow = tuple[str, str, str]

MOST = 6  # speeds of a duty cycle that are listed one by one
_DEFAULT = Aim()


def aim_rows(aim: Aim) -> list[AimRow]:
    """Label, value with its unit and name of what an aim says beyond its defaults; the objective always.

    Parameters
    ----------
    aim : what the liquid is chosen for
    """
    said = [("Objective", aim.objective, "objective")]
    for name, label, text in (
        ("working_speed", "Working speed", _speed(aim.working_speed)),
        ("steady", "Peak", "of the steady response"),
        ("duty", "Duty cycle", _duty(aim)),
        ("vibration_limit", "Vibration limit", _length(aim.vibration_limit)),
        ("limit_at", "Limit holds at", f"{aim.limit_at.replace('_', ' ')} speeds"),
        ("deflection", "Deflection given", _length(aim.deflection)),
        ("unbalance", "Unbalance range", _range(aim.unbalance, 1e6, "g mm")),
        ("temperature", "Temperature range", _range(aim.temperature, 1.0, "K")),
        ("quantile", "Quantile", number(aim.quantile)),
        ("samples", "Samples of the ranges", f"{aim.samples}"),
        ("seed", "Seed", f"{aim.seed}"),
        ("dry_patch", "Dry wall", "not allowed at the working speed"),
        ("stability_margin", "Stability margin", _rate(aim.stability_margin)),
        ("operating", "Operating speeds", _range(aim.operating, RPM, "rpm")),
        ("clearance", "Clearance", _length(aim.clearance)),
        ("volumes", "Volumes", _volumes(aim)),
    ):
        if getattr(aim, name) != getattr(_DEFAULT, name):
            said.append((label, text, name))
    return said


def _speed(value: float | None) -> str:
    return "" if value is None else f"{number(value * RPM)} rpm"


def _length(value: float | None) -> str:
    return "" if value is None else f"{number(value * MM)} mm"


def _rate(value: float | None) -> str:
    return "" if value is None else f"at least {number(value)} 1/s"


def _range(ends: tuple[float, float] | None, unit: float, name: str) -> str:
    return "" if ends is None else f"{number(ends[0] * unit)} to {number(ends[1] * unit)} {name}"


def _duty(aim: Aim) -> str:
    parts = [f"{number(speed * RPM)} rpm (weight {number(weight)})" for speed, weight in aim.duty]
    if len(parts) <= MOST:
        return ", ".join(parts)
    return f"{len(parts)} speeds from {parts[0]} to {parts[-1]}"


def _volumes(aim: Aim) -> str:
    parts = [
        f"chamber {k + 1} {number(low * ML)} to {number(high * ML)} ml"
        for k, (low, high) in enumerate(aim.volumes)
    ]
    return ", ".join(parts)


def jeffcott_entries(mark: Marker, rotor: Rotor) -> list[Entry]:
    """What a scene says of a planar rotor."""
    machine = Jeffcott(rotor.mass, rotor.stiffness, rotor.damping, rotor.unbalance)
    critical = f"{number(machine.natural_frequency * RPM)} rpm"
    return [
        mark.entry("Rotor", f"{rotor.kind}, {rotor.axis} axis", "rotor.axis", "rotor.kind"),
        mark.entry("Mass", f"{number(rotor.mass)} kg", "rotor.mass"),
        mark.entry("Critical speed, dry", critical, "rotor.critical_speed", "rotor.stiffness"),
        mark.entry("Stiffness", f"{number(rotor.stiffness)} N/m", "rotor.stiffness", "rotor.critical_speed"),
        mark.entry("Damping ratio", number(machine.damping_ratio), "rotor.damping_ratio", "rotor.damping"),
        mark.entry("Damping", f"{number(rotor.damping)} N s/m", "rotor.damping", "rotor.damping_ratio"),
        mark.entry("Unbalance", unbalance(rotor.unbalance), "rotor.unbalance"),
    ]


def exciter_entries(mark: Marker, rotor: Exciter) -> list[Entry]:
    """What a scene says of an exciter."""
    balls = rotor.balls
    kind = "rotor.balls.kind" if balls.kind != "pendulum" else "rotor.balls.pendulum_inertia"
    found = [
        mark.entry("Rotor", "exciter", "rotor.kind"),
        mark.entry("Platform mass", f"{number(rotor.platform_mass)} kg", "rotor.platform_mass"),
        mark.entry("Stiffness", f"{number(rotor.stiffness)} N/m", "rotor.stiffness"),
        mark.entry("Damping", f"{number(rotor.damping)} N s/m", "rotor.damping"),
        mark.entry("Unbalance of the shaft", unbalance(rotor.unbalance), "rotor.unbalance"),
        Entry(
            "In the track",
            (mark.cell(f"{balls.count}", "rotor.balls.count"), mark.cell(f"{balls.kind}s", kind)),
        ),
        mark.entry("Mass of each", f"{number(balls.mass * 1e3)} g", "rotor.balls.mass"),
        mark.entry("Radius of the track", mm(balls.track_radius), "rotor.balls.track_radius"),
        mark.entry("Damping along it", f"{number(balls.damping)} N s/m", "rotor.balls.damping"),
    ]
    if balls.kind == "pendulum":
        found.append(mark.entry("Inertia of each", f"{number(balls.pendulum_inertia)} kg m²", kind))
    return found


def two_plane_entries(mark: Marker, rotor: TwoPlane) -> list[Entry]:
    """What a scene says of a rotor in supports along its axis, once each."""
    across, about = rotor.transverse_inertia, rotor.polar_inertia
    return [
        mark.entry("Mass", f"{number(rotor.mass)} kg", "rotor.mass"),
        mark.entry("Inertia across the axis", f"{number(across)} kg m²", "rotor.transverse_inertia"),
        mark.entry("Inertia about the axis", f"{number(about)} kg m²", "rotor.polar_inertia"),
    ]


def two_plane_tables(mark: Marker, rotor: TwoPlane) -> Iterator[Table]:
    """Its supports and unbalances."""
    rows = []
    for k, one in enumerate(rotor.supports):
        at = f"rotor.supports.{k}"
        rows.append(
            (
                Cell(f"{k + 1}"),
                mark.cell(number(one.position * MM), f"{at}.position"),
                mark.cell(number(one.stiffness), f"{at}.stiffness"),
                mark.cell(number(one.damping), f"{at}.damping"),
            )
        )
    yield Table("", ("Support", "at (mm)", "stiffness (N/m)", "damping (N s/m)"), tuple(rows))
    rows = []
    for k, heavy in enumerate(rotor.unbalances):
        at = f"rotor.unbalances.{k}"
        rows.append(
            (
                Cell(f"{k + 1}"),
                mark.cell(number(heavy.position * MM), f"{at}.position"),
                mark.cell(number(heavy.size * 1e6), f"{at}.size"),
                mark.cell(number(math.degrees(heavy.angle)), f"{at}.angle"),
            )
        )
    if rows:
        yield Table("", ("Unbalance", "at (mm)", "size (g mm)", "angle (deg)"), tuple(rows))


def tub_entries(mark: Marker, rotor: Tub) -> list[Entry]:
    """What a scene says of a suspended tub, once each."""
    heavy = rotor.unbalance_position
    about, across = number(rotor.drum_polar_inertia), number(rotor.drum_transverse_inertia)
    place = rotor.drum_position[1] if heavy is None else heavy
    return [
        mark.entry("Tub mass", f"{number(rotor.tub_mass)} kg", "rotor.tub_mass"),
        mark.entry("Drum mass", f"{number(rotor.drum_mass)} kg", "rotor.drum_mass"),
        mark.entry("Tub inertias x, y, z", f"{_three(rotor.tub_inertia)} kg m²", "rotor.tub_inertia"),
        mark.entry("Drum inertia about its axis", f"{about} kg m²", "rotor.drum_polar_inertia"),
        mark.entry("Drum inertia across it", f"{across} kg m²", "rotor.drum_transverse_inertia"),
        mark.entry("Drum's centre", f"({_three(rotor.drum_position, MM)}) mm", "rotor.drum_position"),
        mark.entry("Unbalance", unbalance(rotor.unbalance), "rotor.unbalance"),
        mark.entry("Unbalance at y", mm(place), "rotor.unbalance_position"),
    ]


def tub_tables(mark: Marker, rotor: Tub) -> Iterator[Table]:
    """Its springs and dampers."""
    for name, unit, key, mounts in (
        ("Spring", "N/m", "stiffness", rotor.springs),
        ("Damper", "N s/m", "damping", rotor.dampers),
    ):
        rows = tuple(_mount(mark, one, f"rotor.{name.lower()}s.{k}", key, k) for k, one in enumerate(mounts))
        head = (name, "at x, y, z (mm)", f"{key} ({unit})", "direction")
        if rows:
            yield Table("", head, rows)


def _mount(mark: Marker, one: Mount, at: str, key: str, k: int) -> Row:
    along = one.coefficient > 0.0
    size = number(one.coefficient) if along else f"({_three(one.along_axes)})"
    way = mark.cell(f"({_three(one.direction)})", f"{at}.direction") if along else Cell("along x, y, z")
    place = mark.cell(f"({_three(one.position, MM)})", f"{at}.position")
    return (Cell(f"{k + 1}"), place, mark.cell(size, f"{at}.{key}"), way)


def _three(values: tuple[float, float, float], unit: float = 1.0) -> str:
    return ", ".join(number(float(f"{one * unit:.10g}")) for one in values)


BAFFLES = "Chamber", "baffles", "tips at (mm)", "gap at the wall (mm)", "first at (deg)"
SECTIONS = "Chamber", "section", "area (cm²)", "farthest wall (mm)", "cells at the wall (mm)"


@dataclass(frozen=True)
class Inputs:
    """What a scene says.

    Parameters
    ----------
    entries : single values
    tables : of what there may be several of: chambers, supports, springs
    unused : single values that the report's numbers do not depend on
    """

    entries: tuple[Entry, ...]
    tables: tuple[Table, ...]
    unused: tuple[Entry, ...] = ()

    @property
    def cells(self) -> list[Cell]:
        """All values."""
        single = [cell for entry in (*self.entries, *self.unused) for cell in entry.cells]
        return single + [cell for one in self.tables for row in one.rows for cell in row]

    @property
    def assumed(self) -> bool:
        """Some value is marked."""
        return any(cell.assumed for cell in self.cells)


def scene_inputs(scene: Scene, aim: Aim | None = None, unused: tuple[str, ...] = ()) -> Inputs:
    """Everything that a scene says.

    Parameters
    ----------
    scene : the scene
    aim : of an optimisation, in place of the scene's
    unused : tables of the scene that the report's numbers do not depend on
    """
    mark = Marker(scene.assumed)
    entries, tables = _rotor(mark, scene)
    entries.append(mark.entry("Gravity", f"{number(scene.gravity)} m/s²", "gravity"))
    entries += _study(mark, scene)
    entries += [] if scene.runup is None else _runup(mark, scene.runup)
    wanted = scene.optimise if aim is None else aim
    entries += [] if wanted is None else _optimise(wanted, scene)
    tables += [_chambers(mark, scene)] if scene.chambers else []
    baffles = [(k, fill.chamber.baffles) for k, fill in enumerate(scene.chambers)]
    rows = [_baffle(mark, one, k) for k, one in baffles if one is not None]
    tables += [Table("", BAFFLES, tuple(rows))] if rows else []
    shapes = [(k, fill.chamber.section) for k, fill in enumerate(scene.chambers)]
    rows = [_section(mark, one, k) for k, one in shapes if one is not None]
    tables += [Table("", SECTIONS, tuple(rows))] if rows else []
    aside = [one for one in entries if one.cells[0].path.partition(".")[0] in unused]
    return Inputs(tuple(one for one in entries if one not in aside), tuple(tables), tuple(aside))


def _rotor(mark: Marker, scene: Scene) -> tuple[list[Entry], list[Table]]:
    """Single values, and tables of parts."""
    rotor = scene.rotor
    if isinstance(rotor, Rotor):
        return jeffcott_entries(mark, rotor), []
    if isinstance(rotor, Exciter):
        return exciter_entries(mark, rotor), []
    machine = dry_rotor(scene)
    assert not isinstance(machine, Jeffcott)
    kind = mark.entry("Rotor", f"{rotor.kind}, {rotor.axis} axis", "rotor.axis", "rotor.kind")
    if isinstance(machine, TwoPlane):
        return [kind, *two_plane_entries(mark, machine)], list(two_plane_tables(mark, machine))
    return [kind, *tub_entries(mark, machine)], list(tub_tables(mark, machine))


def _chambers(mark: Marker, scene: Scene) -> Table:
    """Sizes and fill; the plane along the axis where some chamber has one."""
    planes = any(fill.chamber.plane != 0.0 for fill in scene.chambers) or not isinstance(scene.rotor, Rotor)
    head = [
        "Chamber",
        "radius (mm)",
        "inner radius (mm)",
        "height (mm)",
        "plane (mm)",
        "volume (ml)",
        "liquid",
    ]
    rows = [_chamber(mark, fill, k) for k, fill in enumerate(scene.chambers)]
    if not planes:
        del head[4]
        rows = [(*row[:4], *row[5:]) for row in rows]
    return Table("", tuple(head), tuple(rows))


def _chamber(mark: Marker, fill: Fill, k: int) -> Row:
    one, at = fill.chamber, f"chambers.{k}"
    name = fill.liquid.name
    if KNOWN_LIQUIDS.get(name) != fill.liquid:
        density, viscosity = number(fill.liquid.density), number(fill.liquid.viscosity * 1e6)
        name = f"{name}, {density} kg/m³, {viscosity} mm²/s"
    wall = (
        mark.cell(number(one.radius * MM), f"{at}.radius"),
        mark.cell(number(one.inner_radius * MM), f"{at}.inner_radius"),
    )
    if one.section is not None:
        wall = (Cell("see section"), Cell(""))
    return (
        Cell(f"{k + 1}"),
        *wall,
        mark.cell(number(one.height * MM), f"{at}.height"),
        mark.cell(number(one.plane * MM), f"{at}.plane"),
        mark.cell(number(fill.volume * ML), f"{at}.volume"),
        mark.cell(name, f"{at}.liquid"),
    )


def _section(mark: Marker, one: ChamberSection, k: int) -> Row:
    at = f"chambers.{k}"
    cells = "as in the file" if one.cell_size is None else number(one.cell_size * MM)
    return (
        Cell(f"{k + 1}"),
        mark.cell(one.name, f"{at}.section"),
        mark.cell(number(one.area * 1e4), f"{at}.section", f"{at}.section_unit"),
        mark.cell(number(one.farthest * MM), f"{at}.section_unit", f"{at}.section"),
        mark.cell(cells, f"{at}.section_size"),
    )


def _baffle(mark: Marker, one: Baffles, k: int) -> Row:
    at = f"chambers.{k}.baffles"
    return (
        Cell(f"{k + 1}"),
        mark.cell(f"{one.count}", f"{at}.count"),
        mark.cell(number(one.tip_radius * MM), f"{at}.tip_radius"),
        mark.cell(number(one.wall_gap * MM), f"{at}.wall_gap"),
        mark.cell(number(math.degrees(one.first_angle)), f"{at}.first_angle"),
    )


def _study(mark: Marker, scene: Scene) -> list[Entry]:
    """Speeds and models."""
    speeds, model = scene.speeds, scene.model
    return [
        Entry(
            "Speeds",
            (
                mark.cell(number(speeds.start * RPM), "speeds.start"),
                mark.cell(f"to {number(speeds.stop * RPM)} rpm", "speeds.stop"),
                mark.cell(f"at {speeds.count} speed{'' if speeds.count == 1 else 's'}", "speeds.count"),
            ),
        ),
        mark.entry("Liquid model", model.liquid, "model.liquid"),
        mark.entry("Liquid friction", friction_words(model.friction), "model.friction"),
        mark.entry("Tolerance", f"{number(100.0 * model.tolerance)} %", "model.tolerance"),
    ]


def _runup(mark: Marker, plan: Runup) -> list[Entry]:
    found = [
        mark.entry("Run-up from", rpm(plan.start), "runup.start"),
        mark.entry("Run-up to", rpm(plan.stop), "runup.stop"),
    ]
    if plan.rate is not None:
        found.append(mark.entry("Run-up rate", f"{number(plan.rate)} rad/s²", "runup.rate"))
    if plan.motor is not None:
        motor = plan.motor
        points = [
            f"{number(torque)} N m at {number(speed * RPM)} rpm"
            for speed, torque in zip(motor.speeds, motor.torques, strict=True)
        ]
        curve = ", ".join(points if len(points) <= MOST else [points[0], "...", points[-1]])
        more = f" ({len(points)} points)" if len(points) > MOST else ""
        inertia = f"{number(motor.inertia)} kg m²"
        found.append(mark.entry("Inertia on the motor", inertia, "runup.motor.inertia"))
        found.append(
            mark.entry("Motor's torque", f"{curve}{more}", "runup.motor.torques", "runup.motor.speeds")
        )
    ways = "down again" if plan.back else "held"
    waves = "with" if plan.dispersion else "without"
    return [
        *found,
        mark.entry("Run-up lasts", f"{number(plan.duration)} s", "runup.duration"),
        mark.entry("Run-up then", ways, "runup.back"),
        mark.entry("Run-up cells", f"{plan.cells} round each wall", "runup.cells"),
        mark.entry("Run-up dispersion", waves, "runup.dispersion"),
        mark.entry("Run-up samples", f"{plan.samples}", "runup.samples"),
    ]


def _optimise(aim: Aim, scene: Scene) -> list[Entry]:
    """What an optimisation is after; a value that is not the scene's own is not marked."""
    own = aim_rows(scene.optimise) if scene.optimise is not None else []
    mark, bare = Marker(scene.assumed), Marker(())
    return [
        (mark if row in own else bare).entry(row[0], row[1], f"optimise.{row[2]}") for row in aim_rows(aim)
    ]
