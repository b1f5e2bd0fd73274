"""All that a scene says, in units that engineers use, each value marked that no source gives."""

from __future__ import annotations

import math
from dataclasses import dataclass

from fluid.fill import Fill
from fluid.liquid import KNOWN_LIQUIDS
from meshes.baffles import Baffles
from meshes.chamber_section import ChamberSection
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.two_plane import TwoPlane
from study.friction import friction_words
from study.inputs import ML
from study.machine import dry_rotor
from study.optimise_table import Aim
from study.record import MM, RPM
from study.report_aim import aim_rows
from study.report_marks import Entry, Marker, Row, rpm
from study.report_parts import Cell, Table
from study.report_rotor import (
    exciter_entries,
    jeffcott_entries,
    tub_entries,
    tub_tables,
    two_plane_entries,
    two_plane_tables,
)
from study.scene import Exciter, Rotor, Runup, Scene
from study.words import number

BAFFLES = "Chamber", "baffles", "tips at (mm)", "gap at the wall (mm)", "first at (deg)"
SECTIONS = "Chamber", "section", "area (cm²)", "farthest wall (mm)", "cells at the wall (mm)"
MOST = 6  # points of a curve that are listed one by one


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
