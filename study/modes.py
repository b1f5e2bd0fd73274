"""Natural frequencies, damping and shapes of the liquid in a chamber of any section."""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fluid.liquid import Liquid
from fluid.waves import free_wave_frequencies
from meshes.border import InputError, require_positive
from meshes.chamber import Chamber
from meshes.findings import wave_findings
from meshes.liquid_section import LiquidSection
from solvers.sloshing import SloshingModes, sloshing_modes, spectrum
from solvers.sloshing_damping import ModeDamping, mode_damping
from solvers.sloshing_forced import forced_response
from solvers.sloshing_system import LiquidSystem, condense
from study.modes_sections import Resolution, SectionSource, round_sections, section_of_file

Array = NDArray[np.float64]

# Errors above this, relative, are worth a note.
_ROUGH = 1e-3
# A layer thin beside its boundary layers is damped by more than the first order of their thickness.
_VISCOUS = 0.1


@dataclass(frozen=True, eq=False)
class ModesAnswer:
    """Slowest modes of the liquid, by rising size of the frequency, seen from the drum.

    Parameters
    ----------
    frequency : sigma, prograde positive, rad/s, shape (k,)
    exact : of the ring without baffles, rad/s; None where no closed form is known
    damping : decay rate of the amplitude in laminar layers, 1/s, shape (k,)
    damping_ratio : over the size of the frequency, shape (k,)
    plain_damping : without the Coriolis force in the layers on floor and lid, 1/s, shape (k,)
    damping_spread : change of the damping for half or twice the layers' thickness at edges, relative, shape
    (k,)
    crests : round the drum, of the largest share, shape (k,)
    travelling : 0 for a standing oscillation to 1 for a wave that runs one way, shape (k,)
    multiplicity : modes with that frequency, shape (k,)
    error_estimate : of the frequency, relative, from a mesh twice as coarse
    synchronous_force_ratio : force of the liquid in a synchronous whirl over that of all that the wall
        encloses, the mean over its directions
    surface_radius : a, m
    circulations : steady flows, without a frequency
    unknowns : of the mesh, and
    surface_unknowns : of the eigenproblem
    converged : the eigenproblem is solved to rounding
    wall_time : s
    notes : what to know about these values, in words
    """

    frequency: Array
    exact: tuple[float | None, ...]
    damping: Array
    damping_ratio: Array
    plain_damping: Array
    damping_spread: Array
    crests: NDArray[np.int64]
    travelling: Array
    multiplicity: NDArray[np.int64]
    error_estimate: Array
    synchronous_force_ratio: float
    surface_radius: float
    circulations: int
    unknowns: int
    surface_unknowns: int
    converged: bool
    wall_time: float
    notes: tuple[str, ...]


@dataclass(frozen=True, eq=False)
class ModesRecord:
    """What the figure of the shapes shows.

    Parameters
    ----------
    section : the liquid at rest
    modes : its modes
    title : the chamber in words
    spin : Omega, rad/s
    """

    section: LiquidSection
    modes: SloshingModes
    title: str
    spin: float


def answer_modes(
    chamber: Chamber,
    volume: float,
    liquid: Liquid,
    speed: float,
    count: int = 12,
    resolution: Resolution | None = None,
    source: SectionSource | None = None,
) -> tuple[ModesAnswer, ModesRecord]:
    """Modes of the liquid in one chamber.

    Parameters
    ----------
    chamber : a round one, with baffles or without; with `source` its height and, for comparison, its radius
    volume : of the liquid, m^3
    liquid : for its viscosity
    speed : spin, rad/s
    count : how many modes
    resolution : of the mesh; with `source` the longest side at the surface, as cells around
    source : file with the section of the chamber

    Returns
    -------
    The modes, and what is drawn of them.

    Raises
    ------
    InputError : a value out of its range
    """
    begin = time.perf_counter()
    require_positive("--speed", speed)
    require_positive("--volume", volume)
    if not 1 <= count <= 500:
        raise InputError("--count", count, "from 1 to 500")
    fineness = resolution or Resolution()
    if source is None:
        sections, notes, title = round_sections(chamber, volume, liquid, fineness)
    else:
        sections, notes, title = section_of_file(chamber, volume, fineness, source)
    system = condense(sections[-1])
    known = spectrum(system)
    modes = sloshing_modes(system, speed, count, known)
    damping = mode_damping(system, modes, liquid.viscosity, chamber.height)
    size = np.abs(modes.frequency)
    estimate = _error(condense(sections[0]), size / speed, fineness.order)
    notes += (
        [f"mesh: {one}" for one in wave_findings(sections[-1], int(modes.crests.max()))] if source else []
    )
    notes += _found(damping, _depth(sections[-1]), estimate)
    clear = source is None and _is_ring(sections[-1], chamber.radius)
    answer = ModesAnswer(
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
        synchronous_force_ratio=float(forced_response(system, speed, speed, known).force_ratio.real),
        surface_radius=system.section.surface_radius,
        circulations=modes.circulations,
        unknowns=system.unknowns,
        surface_unknowns=len(system.inertia),
        converged=modes.converged,
        wall_time=time.perf_counter() - begin,
        notes=tuple(notes),
    )
    return answer, ModesRecord(sections[-1], modes, title, speed)


def _is_ring(section: LiquidSection, radius: float) -> bool:
    """Whether all walls lie on the circle of that radius."""
    away = np.hypot(*section.points[section.wall].transpose(2, 0, 1)) - radius
    return bool(np.all(np.abs(away) < 1e-9 * radius))


def _depth(section: LiquidSection) -> float:
    """Largest depth of the liquid, m."""
    return float(np.hypot(*section.points[section.wall[:, 0]].T).max()) - section.surface_radius


def _error(coarse: LiquidSystem, size: Array, order: int) -> Array:
    """Relative error of the finer frequencies by Richardson's extrapolation, order 2 p."""
    other = spectrum(coarse).frequency[: len(size)]
    other = np.append(other, np.full(len(size) - len(other), np.nan))
    found: Array = np.abs(other / size - 1.0) / (4.0**order - 1.0)
    return found


def _found(damping: ModeDamping, depth: float, estimate: Array) -> list[str]:
    """What to know about errors and damping."""
    notes = []
    worst = float(np.max(np.nan_to_num(estimate, nan=1.0)))
    if worst > _ROUGH:
        notes.append(
            f"the mesh is coarse for the fastest of these modes (error about {worst:.1g}): more --segments"
        )
    if np.any(damping.thickness > _VISCOUS * depth):
        notes.append("boundary layers are not thin beside the liquid: the damping is their first order alone")
    if np.any(damping.edge_spread > 0.0):
        notes.append("laminar damping at edges of baffles: separation adds to it, more at large amplitude")
    return notes


def _exact(modes: SloshingModes, radius: float, surface_radius: float) -> tuple[float, ...]:
    """Free waves of the ring with as many crests, running the same way [theory: waves, eq. 7]."""
    depth = math.log(radius / surface_radius)
    both = free_wave_frequencies(modes.crests, depth, modes.spin)
    return tuple(np.where(modes.frequency > 0.0, *both).tolist())


def table_lines(answer: ModesAnswer) -> list[str]:
    """The modes in words, equal ones on one line.

    Parameters
    ----------
    answer : of `answer_modes`
    """
    lines = [
        f"{'rad/s':>12}{'times':>7}{'crests':>8}  {'runs':<9}{'exact':>12}{'error':>9}"
        f"{'decay 1/s':>11}{'ratio':>9}"
    ]
    k = 0
    while k < len(answer.frequency):
        sigma, same = answer.frequency[k], int(answer.multiplicity[k])
        exact, error = answer.exact[k], answer.error_estimate
        cells: Sequence[str] = (
            f"{sigma:12.6g}", f"{same if same > 1 else '':>7}", f"{answer.crests[k]:8d}",
            f"  {_runs(sigma, float(answer.travelling[k])):<9}",
            f"{'' if exact is None else f'{exact:.6g}':>12}",
            f"{error[k]:>9.1g}",
            f"{answer.damping[k]:11.4g}", f"{answer.damping_ratio[k]:9.2g}",
        )  # fmt: skip
        lines.append("".join(cells))
        k += same
    return lines


def _runs(frequency: float, travelling: float) -> str:
    """Which way the crests run."""
    if abs(travelling) < 0.5:
        return "stands"
    return "with" if frequency > 0.0 else "against"
