"""What a scene says of its rotor, in units that engineers use."""

from __future__ import annotations

import math
from collections.abc import Iterator

from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import TwoPlane
from study.record import MM, RPM
from study.report_marks import Entry, Marker, Row, mm, unbalance
from study.report_parts import Cell, Table
from study.scene import Exciter, Rotor
from study.words import number


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
