"""What a scene says, as reports list it: label, value with its unit, field path."""

from __future__ import annotations

import math

from leblanc.scene.machine import dry_rotor
from leblanc.scene.scene import Scene
from leblanc.units import ML, MM, RPM
from meshes.baffles import Baffles
from solvers.rotor.jeffcott import Jeffcott
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.two_plane import TwoPlane

Row = tuple[str, str, str]


def input_rows(scene: Scene) -> tuple[Row, ...]:
    """Label, value with its unit and field path of what the scene says.

    Raises
    ------
    InputError : the scene is that of an exciter
    """
    machine = dry_rotor(scene)
    if isinstance(machine, TwoPlane):
        rows = _two_plane(machine)
    else:
        rows = _tub(machine) if isinstance(machine, Tub) else _jeffcott(machine)
    rows.append(("Axis", scene.rotor.axis, "rotor.axis"))
    for k, fill in enumerate(scene.fills):
        label, chamber = f"Chamber {k + 1}", fill.chamber
        inner = f", inner radius {chamber.inner_radius * MM:.4g} mm" if chamber.inner_radius > 0.0 else ""
        wall = (f"{label}: radius", f"{chamber.radius * MM:.4g} mm{inner}", f"chambers.{k}.radius")
        if chamber.section is not None:
            reach = f"{chamber.section.name}, up to {chamber.radius * MM:.4g} mm from the axis"
            wall = (f"{label}: section", reach, f"chambers.{k}.section")
        rows += [
            wall,
            (f"{label}: height", f"{chamber.height * MM:.4g} mm", f"chambers.{k}.height"),
            (f"{label}: liquid", f"{fill.volume * ML:.4g} ml of {fill.liquid.name}", f"chambers.{k}.volume"),
        ]
        if chamber.baffles is not None:
            rows.append((f"{label}: baffles", baffle_words(chamber.baffles), f"chambers.{k}.baffles"))
        if not isinstance(machine, Jeffcott):
            rows.append((f"{label}: plane", f"{chamber.plane * MM:.4g} mm", f"chambers.{k}.plane"))
    speeds = scene.speeds
    span = f"{speeds.start * RPM:.4g} to {speeds.stop * RPM:.4g} rpm, {speeds.count} speeds"
    return (*rows, ("Speeds", span, "speeds"))


def baffle_words(baffles: Baffles) -> str:
    """How many, and from where to where.

    Parameters
    ----------
    baffles : of a chamber
    """
    inner = f"{baffles.tip_radius * MM:.4g} mm from the axis" if baffles.tip_radius > 0.0 else "the axis"
    outer = f"{baffles.wall_gap * MM:.4g} mm off the wall" if baffles.wall_gap > 0.0 else "the wall"
    return f"{baffles.count}, from {outer} to {inner}"


def _jeffcott(rotor: Jeffcott) -> list[Row]:
    frequency = rotor.natural_frequency
    return [
        ("Rotor mass", f"{rotor.mass:.4g} kg", "rotor.mass"),
        ("Support stiffness", f"{rotor.stiffness:.4g} N/m", "rotor.stiffness"),
        (
            "Critical speed without liquid",
            f"{frequency * RPM:.4g} rpm ({frequency:.4g} rad/s)",
            "rotor.critical_speed",
        ),
        ("Support damping", f"{rotor.damping:.4g} N s/m", "rotor.damping"),
        ("Damping ratio", f"{rotor.damping_ratio:.4g}", "rotor.damping_ratio"),
        ("Unbalance", f"{rotor.unbalance * 1e6:.4g} g mm", "rotor.unbalance"),
    ]


def _two_plane(rotor: TwoPlane) -> list[Row]:
    rows = [
        ("Rotor mass", f"{rotor.mass:.4g} kg", "rotor.mass"),
        ("Inertia across the axis", f"{rotor.transverse_inertia:.4g} kg m²", "rotor.transverse_inertia"),
        ("Inertia about the axis", f"{rotor.polar_inertia:.4g} kg m²", "rotor.polar_inertia"),
    ]
    for k, support in enumerate(rotor.supports):
        what = f"{support.stiffness:.4g} N/m, {support.damping:.4g} N s/m"
        rows.append((f"Support at {support.position * MM:.4g} mm", what, f"rotor.supports.{k}"))
    for k, one in enumerate(rotor.unbalances):
        what = f"{one.size * 1e6:.4g} g mm, {math.degrees(one.angle):.4g} deg"
        rows.append((f"Unbalance at {one.position * MM:.4g} mm", what, f"rotor.unbalances.{k}"))
    return rows


def _tub(rotor: Tub) -> list[Row]:
    inertia = ", ".join(f"{one:.4g}" for one in rotor.tub_inertia)
    drum = f"{rotor.drum_polar_inertia:.4g}, {rotor.drum_transverse_inertia:.4g} kg m²"
    heavy = rotor.unbalance_position
    y = rotor.drum_position[1] if heavy is None else heavy
    rows = [
        ("Tub mass", f"{rotor.tub_mass:.4g} kg", "rotor.tub_mass"),
        ("Drum mass", f"{rotor.drum_mass:.4g} kg", "rotor.drum_mass"),
        ("Tub inertias x, y, z", f"{inertia} kg m²", "rotor.tub_inertia"),
        ("Drum inertias along, across", drum, "rotor.drum_polar_inertia"),
        ("Drum's centre", f"{_place(rotor.drum_position)}", "rotor.drum_position"),
        ("Unbalance", f"{rotor.unbalance * 1e6:.6g} g mm", "rotor.unbalance"),
        ("Unbalance at y", f"{y * MM:.4g} mm", "rotor.unbalance_position"),
    ]
    for k, one in enumerate(rotor.springs):
        rows.append((f"Spring at {_place(one.position)}", _strength(one, "N/m"), f"rotor.springs.{k}"))
    for k, one in enumerate(rotor.dampers):
        rows.append((f"Damper at {_place(one.position)}", _strength(one, "N s/m"), f"rotor.dampers.{k}"))
    return rows


def _place(position: tuple[float, float, float]) -> str:
    return "(" + ", ".join(f"{one * MM:.4g}" for one in position) + ") mm"


def _strength(mount: Mount, unit: str) -> str:
    """Along its direction, or along the axes."""
    if mount.coefficient > 0.0:
        way = ", ".join(f"{one:.3g}" for one in mount.direction)
        return f"{mount.coefficient:.4g} {unit} along ({way})"
    return "(" + ", ".join(f"{one:.4g}" for one in mount.along_axes) + f") {unit}"
