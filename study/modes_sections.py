"""Meshes on which the liquid's modes are computed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.baffles import Baffles
from meshes.border import InputError, require_positive
from meshes.chamber import Chamber
from meshes.liquid_section import LiquidSection
from study.section_file import is_outline, section_of_any_file

# A radius of the section that differs by more from the one given.
_OTHER = 1e-3
_MOST_SEGMENTS = 1200  # the cost goes with the cube


@dataclass(frozen=True)
class Resolution:
    """Mesh of the liquid.

    Parameters
    ----------
    segments, layers : cells around and across, at least
    order : 1 for linear elements, 2 for quadratic ones

    Raises
    ------
    InputError : a number out of its range
    """

    segments: int = 96
    layers: int = 6
    order: int = 2

    def __post_init__(self) -> None:
        if not 16 <= self.segments <= _MOST_SEGMENTS:
            raise InputError("--segments", self.segments, f"from 16 to {_MOST_SEGMENTS}")
        if not 1 <= self.layers <= 200:
            raise InputError("--layers", self.layers, "from 1 to 200")
        if self.order not in (1, 2):
            raise InputError("--order", self.order, "1 (linear elements) or 2 (quadratic ones)")


@dataclass(frozen=True)
class SectionSource:
    """File with the section of a chamber; its origin is the geometric axis.

    Parameters
    ----------
    path : a mesh, or an outline
    unit : length of the file's unit, m; None for the one that it names, of a mesh for 1 m
    size : of the cells at walls of an outline, m; None for a hundredth of its largest extent
    """

    path: Path
    unit: float | None = None
    size: float | None = None


def ring_sections(
    radius: float, surface_radius: float, baffles: Baffles | None, fineness: Resolution
) -> list[LiquidSection]:
    """The liquid in a round chamber on a mesh and, before it, on one with cells twice as large.

    Parameters
    ----------
    radius, surface_radius : R and a, m
    baffles : None without any
    fineness : of the finer mesh
    """
    from meshes.polar import ring

    # In a deep layer waves with many crests keep to the surface.
    grading = 2.0 if radius > 1.6 * surface_radius else 1.0
    around, across = max(8, -(-fineness.segments // 2)), -(-fineness.layers // 2)
    return [
        ring(
            radius, surface_radius, around, across,
            order=fineness.order, baffles=baffles, times=times, towards_surface=grading,
        )
        for times in (1, 2)
    ]  # fmt: skip


def round_sections(
    chamber: Chamber, volume: float, liquid: Liquid, fineness: Resolution
) -> tuple[list[LiquidSection], list[str], str]:
    """Coarser and finer mesh of the liquid in a round chamber, notes, and the chamber in words.

    Parameters
    ----------
    chamber : with its baffles
    volume : of the liquid, m^3
    liquid : what it is
    fineness : of the finer mesh

    Raises
    ------
    InputError : more liquid than the chamber holds, or too little for a layer
    """
    fill = Fill(chamber, liquid, volume)
    a, radius = fill.surface_radius, chamber.radius
    if a <= 0.01 * radius or a <= chamber.inner_radius or fill.depth < 1e-6 * radius:
        raise InputError("--volume", volume, "less than what fills the chamber, and enough to cover its wall")
    notes, baffles = [], chamber.baffles
    span = baffles.wetted_span(radius, a) if baffles is not None else None
    if baffles is not None and span is None:
        notes.append("the baffles stand clear of the liquid")
    title = f"Round chamber, R = {radius * 1e3:.4g} mm"
    if baffles is not None and span is not None:
        inner, outer = span
        ends = "through the surface" if inner == a else f"to {inner * 1e3:.4g} mm from the axis"
        start = "the wall" if outer == radius else f"{(radius - outer) * 1e3:.3g} mm off the wall"
        title += f", {baffles.count} baffles from {start} {ends}"
    return ring_sections(radius, a, baffles if span else None, fineness), notes, title


def section_of_file(
    chamber: Chamber, volume: float, fineness: Resolution, source: SectionSource
) -> tuple[list[LiquidSection], list[str], str]:
    """Coarser and finer mesh of the liquid in a chamber from a file, notes, and the section in words.

    Parameters
    ----------
    chamber : its height counts; its radius is compared
    volume : of the liquid, m^3
    fineness : longest side at the surface, as cells around
    source : the file

    Raises
    ------
    InputError : baffles besides those of the file, a file that cannot be used, more liquid than it holds
    """
    from meshes.findings import mesh_findings
    from meshes.halving import halved, straightened
    from meshes.waterline_cut import liquid_outside, surface_radius_of

    if source.unit is not None:
        require_positive("--mesh-unit", source.unit)
    if source.size is not None:
        require_positive("--mesh-size", source.size)
    if chamber.baffles is not None:
        raise InputError("--baffles", chamber.baffles.count, "left out with --mesh, which has its own walls")
    section = section_of_any_file(source.path, source.unit, source.size, ("--mesh-unit", "--mesh-size"))
    a = surface_radius_of(section, volume / chamber.height)
    notes = [f"mesh: {one}" for one in mesh_findings(section)]
    if section.order == 1 and not is_outline(source.path):
        notes.append("straight sides: the error is that on these walls, whatever curves they stand for")
    farthest = float(np.hypot(*section.points.T).max())
    if abs(farthest / chamber.radius - 1.0) > _OTHER:
        notes.append(
            f"the section reaches to {farthest * 1e3:.5g} mm from the axis: that counts, not --radius"
        )
    size = 4.0 * math.pi * a / fineness.segments
    liquid = liquid_outside(section, a, order=2, surface_size=size, wall_size=2.0 * size)
    sections = [liquid, halved(liquid)]
    if fineness.order == 1:
        sections = [straightened(one) for one in sections]
    return sections, notes, f"Section of {source.path.name}"
