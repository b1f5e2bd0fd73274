"""Natural frequencies, damping and shapes of the liquid in a chamber of any section."""

from __future__ import annotations

import math
import time
from collections.abc import Iterable
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from fluid.fill import Fill
from fluid.liquid import Liquid
from fluid.waves import free_wave_frequencies
from leblanc.core.notes import Note
from leblanc.core.progress import update
from leblanc.core.question import Quantity
from leblanc.core.units import LENGTH, parse_option, with_unit
from leblanc.scene.chambers import is_outline, round_chamber, section_of_any_file
from leblanc.studies.modes.answer import ModesAnswer, ModesCode
from meshes.arrays import Array
from meshes.baffles import Baffles
from meshes.chamber import Chamber
from meshes.errors import InputError, require_positive
from meshes.findings import Finding, mesh_findings, wave_findings
from meshes.liquid_section import LiquidSection
from solvers.sloshing.forced import ModeDamping, mode_damping
from solvers.sloshing.modes import SloshingModes, first_largest, sloshing_modes
from solvers.sloshing.slowest import slowest_modes, synchronous_force_ratio
from solvers.sloshing.system import SurfaceSystem, surface_system

# A radius of the section that differs by more from the one given.
_OTHER = 1e-3
_MOST_SEGMENTS = 1200


@dataclass(frozen=True)
class Resolution:
    """Mesh of the liquid."""

    segments: int = 96  #: cells around and across, at least
    layers: int = 6
    order: int = 2  #: 1 for linear elements, 2 for quadratic ones

    def __post_init__(self) -> None:
        if not 16 <= self.segments <= _MOST_SEGMENTS:
            raise InputError("segments", self.segments, f"from 16 to {_MOST_SEGMENTS}")
        if not 1 <= self.layers <= 200:
            raise InputError("layers", self.layers, "from 1 to 200")
        if self.order not in (1, 2):
            raise InputError("order", self.order, "1 (linear elements) or 2 (quadratic ones)")


@dataclass(frozen=True)
class SectionSource:
    """File with the section of a chamber; its origin is the geometric axis."""

    path: Path  #: a mesh, or an outline
    #: length of the file's unit, m; None for the one that it names, of a mesh for 1 m
    unit: float | None = None
    #: of the cells at walls of an outline, m; None for a hundredth of its largest extent
    size: float | None = None


def ring_sections(
    radius: float, surface_radius: float, baffles: Baffles | None, fineness: Resolution
) -> list[LiquidSection]:
    """The liquid in a round chamber on a mesh and, before it, on one twice as coarse; radii in m."""
    from meshes.rings.quadrilaterals import ring

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
) -> tuple[list[LiquidSection], list[Note], str]:
    """Coarser and finer mesh of the liquid in a round chamber, notes, and a description of the chamber."""
    fill = Fill(chamber, liquid, volume)
    a, radius = fill.surface_radius, chamber.radius
    if a <= 0.01 * radius or a <= chamber.inner_radius or fill.depth < 1e-6 * radius:
        raise InputError("volume", volume, "less than what fills the chamber, and enough to cover its wall")
    notes: list[Note] = []
    baffles = chamber.baffles
    span = baffles.wetted_span(radius, a) if baffles is not None else None
    if baffles is not None and span is None:
        notes.append(Note(ModesCode.BAFFLES_CLEAR, {}, "the baffles stand clear of the liquid"))
    title = f"Round chamber, R = {with_unit(radius, LENGTH)}"
    if baffles is not None and span is not None:
        inner, outer = span
        ends = "through the surface" if inner == a else f"to {with_unit(inner, LENGTH)} from the axis"
        start = "the wall" if outer == radius else f"{with_unit(radius - outer, LENGTH)} off the wall"
        title += f", {baffles.count} baffles from {start} {ends}"
    return ring_sections(radius, a, baffles if span else None, fineness), notes, title


def section_of_file(
    chamber: Chamber, volume: float, fineness: Resolution, source: SectionSource
) -> tuple[list[LiquidSection], list[Note], str]:
    """Coarser and finer mesh of the liquid in a chamber from a file, notes, and a description of the section.

    Of the chamber the height counts, its radius is compared; segments set the longest side at the surface.
    """
    from meshes.refine.bisection import halved, straightened
    from meshes.refine.waterline import liquid_outside, surface_radius_of

    if source.unit is not None:
        require_positive("mesh_unit", source.unit)
    if source.size is not None:
        require_positive("mesh_size", source.size)
    if chamber.baffles is not None:
        raise InputError("baffles", chamber.baffles.count, "left out with mesh, which has its own walls")
    section = section_of_any_file(source.path, source.unit, source.size, ("mesh_unit", "mesh_size"))
    a = surface_radius_of(section, volume / chamber.height)
    notes = _of_mesh(mesh_findings(section))
    if section.order == 1 and not is_outline(source.path):
        text = "straight sides: the error is that on these walls, whatever curves they stand for"
        notes.append(Note(ModesCode.STRAIGHT_SIDES, {}, text))
    farthest = float(np.hypot(*section.points.T).max())
    if abs(farthest / chamber.radius - 1.0) > _OTHER:
        text = (
            f"the section reaches to {with_unit(farthest, LENGTH)} from the axis: that counts, not --radius"
        )
        notes.append(Note(ModesCode.OTHER_RADIUS, {"radius": farthest}, text))
    size = 4.0 * math.pi * a / fineness.segments
    liquid = liquid_outside(section, a, order=2, surface_size=size, wall_size=2.0 * size)
    sections = [liquid, halved(liquid)]
    if fineness.order == 1:
        sections = [straightened(section) for section in sections]
    return sections, notes, f"Section of {source.path.name}"


def _of_mesh(findings: Iterable[Finding]) -> list[Note]:
    """What is found in a mesh."""
    return [Note(ModesCode.MESH, asdict(finding), f"mesh: {finding}") for finding in findings]


# Errors above this, relative, are worth a note.
_ROUGH = 1e-3
# A layer thin beside its boundary layers is damped by more than the first order of their thickness.
_VISCOUS = 0.1


def length_of_unit(unit: Quantity | None, name: str) -> float | None:
    """A length in m, also of a unit by its name alone."""
    if unit is None:
        return None
    if isinstance(unit, str) and unit.strip()[:1].isalpha():
        unit = f"1 {unit}"
    return parse_option(unit, LENGTH, name)


def answer(
    radius: float,
    volume: float,
    height: float,
    speed: float,
    count: int,
    baffles: int,
    baffle_tip_radius: float,
    baffle_wall_gap: float,
    mesh: Path | None,
    mesh_unit: float | None,
    mesh_size: float | None,
    liquid: Liquid,
    segments: int,
    layers: int,
    order: int,
) -> ModesAnswer:
    """Modes of the liquid in a round chamber, or in one whose section is in a file."""
    chamber = round_chamber(radius, height, baffles, baffle_tip_radius, baffle_wall_gap)
    for name, value in {"mesh_unit": mesh_unit, "mesh_size": mesh_size}.items():
        if mesh is None and value is not None:
            raise InputError(name, value, "left out without mesh")
    source = None if mesh is None else SectionSource(mesh, mesh_unit, mesh_size)
    return answer_modes(chamber, volume, liquid, speed, count, Resolution(segments, layers, order), source)


def answer_modes(
    chamber: Chamber,
    volume: float,
    liquid: Liquid,
    speed: float,
    count: int = 12,
    resolution: Resolution | None = None,
    source: SectionSource | None = None,
) -> ModesAnswer:
    """Modes of the liquid in one chamber, round or, with `source`, of a section from a file."""
    begin = time.perf_counter()
    require_positive("speed", speed)
    require_positive("volume", volume)
    if not 1 <= count <= 500:
        raise InputError("count", count, "from 1 to 500")
    fineness = resolution or Resolution()
    update(what="mesh of the liquid")
    if source is None:
        sections, notes, title = round_sections(chamber, volume, liquid, fineness)
    else:
        sections, notes, title = section_of_file(chamber, volume, fineness, source)
    update(what="waves by finite elements")
    system = surface_system(sections[-1])
    slow = slowest_modes(system, count)
    modes = sloshing_modes(system, speed, count, slow.spectrum)
    update(what="damping")
    damping = mode_damping(system, modes, liquid.viscosity, chamber.height)
    size = np.abs(modes.frequency)
    update(what="the same on a coarser mesh")
    estimate = _error(surface_system(sections[0]), size / speed, fineness.order)
    if source is not None:
        crests = int(modes.crests.max())
        notes += _of_mesh(wave_findings(sections[-1], crests))
    notes += _limits(damping, _depth(sections[-1]), estimate)
    clear = source is None and _is_ring(sections[-1], chamber.radius)
    strongest = modes.psi[np.arange(len(size)), first_largest(modes.psi)]
    return ModesAnswer(
        chamber=title,
        liquid=liquid.name,
        speed=speed,
        frequency=modes.frequency,
        exact=_exact(modes, chamber.radius, system.section.surface_radius) if clear else (None,) * len(size),
        damping=damping.rate,
        damping_ratio=damping.rate / size,
        plain_damping=damping.plain_rate,
        damping_spread=damping.edge_spread,
        crests=modes.crests,
        travelling=modes.travelling,
        multiplicity=modes.multiplicity,
        error_estimate=estimate,
        synchronous_force_ratio=synchronous_force_ratio(system),
        surface_radius=system.section.surface_radius,
        circulations=modes.circulations,
        unknowns=system.unknowns,
        surface_unknowns=len(system.steady) - system.steady.shape[1],
        converged=modes.converged and slow.converged,
        wall_time=time.perf_counter() - begin,
        notes=tuple(notes),
        section=sections[-1],
        shapes=modes,
        phase=np.angle(strongest),
    )


def _is_ring(section: LiquidSection, radius: float) -> bool:
    """Whether all walls lie on the circle of that radius."""
    away = np.hypot(*section.points[section.wall].transpose(2, 0, 1)) - radius
    return bool(np.all(np.abs(away) < 1e-9 * radius))


def _depth(section: LiquidSection) -> float:
    """Largest depth of the liquid, m."""
    return float(np.hypot(*section.points[section.wall[:, 0]].T).max()) - section.surface_radius


def _error(coarse: SurfaceSystem, size: Array, order: int) -> Array:
    """Relative error of the finer frequencies by Richardson's extrapolation, order 2 p."""
    other = slowest_modes(coarse, len(size)).spectrum.frequency[: len(size)]
    other = np.append(other, np.full(len(size) - len(other), np.nan))
    found: Array = np.abs(other / size - 1.0) / (4.0**order - 1.0)
    return found


def _limits(damping: ModeDamping, depth: float, estimate: Array) -> list[Note]:
    """What to know about errors and damping."""
    notes = []
    worst = float(np.max(np.nan_to_num(estimate, nan=1.0)))
    if worst > _ROUGH:
        text = f"the mesh is coarse for the fastest of these modes (error about {worst:.1g}): more --segments"
        notes.append(Note(ModesCode.COARSE, {"error": worst}, text))
    if np.any(damping.thickness > _VISCOUS * depth):
        text = "boundary layers are not thin beside the liquid: the damping is their first order alone"
        notes.append(Note(ModesCode.THICK_LAYERS, {}, text))
    if np.any(damping.edge_spread > 0.0):
        text = "laminar damping at edges of baffles: separation adds to it, more at large amplitude"
        notes.append(Note(ModesCode.SHARP_EDGES, {}, text))
    return notes


def _exact(modes: SloshingModes, radius: float, surface_radius: float) -> tuple[float, ...]:
    """Natural sloshing waves of the ring with as many crests, running the same way [theory: waves, eq. 7]."""
    depth = math.log(radius / surface_radius)
    both = free_wave_frequencies(modes.crests, depth, modes.spin)
    return tuple(np.where(modes.frequency > 0.0, *both).tolist())
