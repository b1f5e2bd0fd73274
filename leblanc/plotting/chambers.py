"""Chambers seen along the axis, drawn on axes that are handed in: wall and liquid, enlarged as needed."""

from __future__ import annotations

import cmath
import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import lru_cache, partial
from itertools import zip_longest
from typing import Any

import numpy as np

from leblanc.core.units import DEGREE, LENGTH, MINUS, MM, TIMES, in_rpm, number, with_unit
from leblanc.liquid.choice import HELD_MODELS
from leblanc.liquid.filled import FilledChamber
from leblanc.plotting.bodies import chord, rounded_down
from leblanc.plotting.page import (
    RIGHT,
    WIDTH,
    Figure,
    Frame,
    caption,
    fill_loops,
    lay_out,
    style,
)
from leblanc.studies.run.answer import RunAnswer, peak, phase
from leblanc.studies.run.words import alts, amplitude_place
from meshes.arrays import Array, Complex
from meshes.baffles import Baffles
from meshes.clip import Remainder, area_within, outside_circle, wall_loops
from solvers.roots import bracketed_root

RAYS = 361  # one degree apart, closed
BISECTIONS = 60  # from the radius down to rounding

UNEVEN_RAYS = 721
SHARES = 21  # of the exponent with which factors that do not fit are tried again
OUTSIDE = 1.07  # place of the unbalance over the wall's radius, where it covers no liquid
GAP = 0.03  # over the radius, between an inner wall and a surface drawn larger that does not meet it
UPRIGHT = 0.02  # of the radius: a surface whose ends are nearer stands upright in the drawing
TIERS, HEIGHTS = 4, 24  # shades of a bowl; heights at which its area is counted
SEEN = 0.02  # of the radius: a deflection drawn smaller than this gets a factor of its own

Axes = Any  # matplotlib's, which no module that only draws imports

WALL, LIQUID, SURFACE, CENTRE, UNBALANCE = "0.15", "#56B4E9", "#0072B2", "#D55E00", "0.15"
SHADES = ("#DCEFFA", "#BBE0F5", "#99D1F1", "#78C3ED", LIQUID)  # from the floor of a bowl to the lid
MOST_DRAWINGS = 3  # side by side
BETWEEN, BELOW = 0.6, 0.36  # inches
FRAME = Frame(left=0.15, top=0.26, between=BETWEEN, below=BELOW)
HEADING_ROW = 0.14  # inches


@dataclass(frozen=True)
class Exaggeration:
    """Factors that the drawing applies."""

    deflection: float  #: of the geometric centre and of the mean layer
    depth: float


def liquid_outline(chamber: FilledChamber, centre: complex, depth: float) -> tuple[Array, Array, Array]:
    """Rays about the rotation axis, rad, and inner and outer end of the liquid on each, m; shape (361,).

    The surface is the circle about the rotation axis that leaves the right area; `depth` is the mean depth as
    drawn, m, `centre` the geometric centre, which must leave that axis inside the inner wall.
    """
    angle = np.linspace(-math.pi, math.pi, RAYS)
    outer = chord(chamber.radius, centre, angle)
    floor = np.zeros_like(outer)
    if chamber.inner_radius > 0.0:
        floor = chord(chamber.inner_radius, centre, angle)
    wanted = math.pi * depth * (2.0 * chamber.radius - depth)
    low, high = 0.0, float(outer.max())
    for _ in range(BISECTIONS):
        surface = 0.5 * (low + high)
        inner = np.clip(surface, floor, outer)
        # The rays are equally spaced over a turn, where the mean is exact for smooth outlines.
        area = math.pi * float(np.mean((outer**2 - inner**2)[1:]))
        low, high = (surface, high) if area > wanted else (low, surface)
    return angle, np.clip(0.5 * (low + high), floor, outer), outer


def exaggeration(
    chambers: tuple[FilledChamber, ...], deflections: tuple[complex, ...], bends: tuple[float, ...] = ()
) -> Exaggeration:
    """Factors that make deflection and layer visible and leave what the liquid touches as it is.

    Where the surface meets an inner wall nothing is enlarged. `deflections` as drawn, m; `bends` is 2
    g/Omega^2 at each, by which the surface's squared radius grows along the axis, m.
    """
    found = _visible(chambers, tuple(abs(w) for w in deflections))
    plain = Exaggeration(min(found.deflection, 1.0), 1.0)
    if found == plain:
        return plain
    instants = list(zip_longest(deflections or (0j,), bends, fillvalue=0.0))
    if any(meets_inner_wall(chamber, w, 1.0, bend) for chamber in chambers for w, bend in instants):
        return plain
    for share in np.linspace(1.0, 0.0, SHARES):
        scale = Exaggeration(_part(found.deflection, share), _part(found.depth, share))
        if scale == plain or not any(
            meets_inner_wall(chamber, scale.deflection * w, scale.depth, bend, GAP)
            for chamber in chambers
            for w, bend in instants
        ):
            break
    return scale


def _part(factor: float, share: float) -> float:
    """Power of a factor above 1; smaller ones are needed for the deflection to fit at all."""
    return factor if factor <= 1.0 or share == 1.0 else max(1.0, rounded_down(factor**share))


def _visible(chambers: tuple[FilledChamber, ...], deflections: tuple[float, ...]) -> Exaggeration:
    """Factors that make deflection and layer visible and keep wet walls wet and dry patches dry."""
    layers = [(c.least_depth, c) for c in chambers]
    layers = [(depth, c) for depth, c in layers if depth > 0.0]
    depth_factor = 1.0
    if layers:
        fits = min(0.5 * (c.radius - c.inner_radius) / depth for depth, c in layers)
        shows = max(0.15 * c.radius / depth for depth, c in layers)
        depth_factor = rounded_down(max(1.0, min(fits, shows)))
    sizes = [w for w in deflections if w > 0.0]
    if not sizes:
        return Exaggeration(1.0, depth_factor)
    inner = [0.9 * c.inner_radius for c in chambers if c.inner_radius > 0.0]
    widest = min([0.35 * c.radius for c in chambers] + inner) / max(sizes)
    wet = [0.9 * depth_factor * depth / w for depth, _ in layers for w in sizes if w < depth]
    factor = rounded_down(min([widest, *wet]))
    dry = [factor * w / depth for depth, _ in layers for w in sizes if w >= depth]
    if dry and min(dry) < depth_factor:
        # Equal factors leave dry arcs as they are. A film that cannot be seen so covers a larger arc.
        film = min(SEEN * c.radius / depth for depth, c in layers)
        depth_factor = rounded_down(max(factor, min(film, 0.5 * min(dry))))
    return Exaggeration(factor, depth_factor)


def meets_inner_wall(
    chamber: FilledChamber, centre: complex, depth_factor: float, bend: float = 0.0, gap: float = 0.0
) -> bool:
    """The liquid reaches an inner wall, a core, or past the inner edges of closed baffles.

    Or comes as near as `gap` chamber radii; `centre` is the geometric centre from the rotation axis, m, the
    layer is `depth_factor` times as deep, `bend` as for `exaggeration`.
    """
    if chamber.volume == 0.0 or chamber.least_depth <= 0.0:
        return False
    reach = [float(np.abs(z + centre).max(initial=0.0)) for z in _inside(chamber, depth_factor)]
    if not any(reach):
        return False
    found = levels(chamber, centre, depth_factor, bend)
    return any(
        far > math.sqrt(max(square, 0.0)) - (gap - 1e-9) * chamber.radius
        for far, square in zip(reach, found, strict=True)
    )


def side_by_side(chambers: tuple[FilledChamber, ...]) -> list[tuple[FilledChamber, ...]]:
    """Chambers sorted into drawings: those inside one another share one, equal ones are drawn once."""
    drawings: list[list[FilledChamber]] = []
    for chamber in sorted(dict.fromkeys(chambers), key=lambda c: -c.radius):
        for drawing in drawings:
            if chamber.radius <= drawing[-1].inner_radius and chamber.plane == drawing[-1].plane:
                drawing.append(chamber)
                break
        else:
            drawings.append([chamber])
    return [tuple(drawing) for drawing in drawings]


@dataclass(frozen=True)
class LiquidOutline:
    """A body of liquid seen along the axis, about the rotation axis."""

    level: float  #: distance of the free surface, on the floor of a bowl, m
    liquid: Remainder  #: what lies outside of it
    #: what is covered up to some heights above the floor, if the surface is a bowl, from the lowest on
    higher: tuple[Remainder, ...] = ()


@lru_cache(maxsize=64)
def walls(chamber: FilledChamber) -> tuple[tuple[Complex, ...], ...]:
    """Walls of each body of liquid that cannot mix with the others, about the geometric centre.

    Closed lines, m, with the inside on their left.
    """
    if chamber.section is not None:
        return (wall_loops(chamber.section.mesh),)
    baffles = chamber.baffles
    if baffles is not None and _closed(chamber, baffles):
        width = 2.0 * math.pi / baffles.count
        turn = np.exp(1j * np.linspace(0.0, width, UNEVEN_RAYS // baffles.count + 2))
        inner = (
            chamber.inner_radius * turn[::-1] if chamber.inner_radius > 0.0 else np.zeros(1, dtype=complex)
        )
        sector = np.concatenate([chamber.radius * turn, inner])
        return tuple((sector * complex(start),) for start in np.exp(1j * baffles.angles))
    round_it = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, UNEVEN_RAYS)[:-1])
    hole = (chamber.inner_radius * round_it.conj(),) if chamber.inner_radius > 0.0 else ()
    return ((chamber.radius * round_it, *hole),)


def _closed(chamber: FilledChamber, baffles: Baffles) -> bool:
    """Baffles run from the wall through the free surface."""
    rest = chamber.mean_surface_radius
    return baffles.wetted_span(chamber.radius, rest) == (rest, chamber.radius)


def bodies(
    chamber: FilledChamber, centre: complex, depth_factor: float, bend: float = 0.0
) -> list[LiquidOutline]:
    """Each body of liquid in its walls, outside the circle about the rotation axis that leaves its area.

    Under gravity along the axis r^2 = C + bend z. `depth_factor` is taken where the layer is thinnest.
    """
    found = []
    for loops, level in zip(walls(chamber), levels(chamber, centre, depth_factor, bend), strict=True):
        moved = tuple(loop + centre for loop in loops)
        ramp = bend * chamber.height
        if _is_upright(chamber, level, ramp):
            found.append(LiquidOutline(math.sqrt(level), outside_circle(moved, math.sqrt(level))))
            continue
        tiers = [math.sqrt(max(level + ramp * k / TIERS, 0.0)) for k in range(TIERS + 1)]
        left = [outside_circle(moved, radius) for radius in tiers]
        found.append(LiquidOutline(tiers[0], left[0], tuple(left[1:])))
    return found


def levels(chamber: FilledChamber, centre: complex, depth_factor: float, bend: float = 0.0) -> list[float]:
    """Square of the free surface's distance from the rotation axis in each body, m^2.

    On the floor, if the surface is a bowl; below 0 where it covers the axis there.
    """
    rest = max(chamber.mean_surface_radius - (depth_factor - 1.0) * chamber.least_depth, 0.0)
    ramp, found = bend * chamber.height, []
    farthest = (chamber.radius + abs(centre)) ** 2
    for loops in walls(chamber):
        outside = [_within(chamber, loops, 0j, np.array([radius]))[0] for radius in (math.inf, rest)]
        wanted = float(outside[0] - outside[1])
        taken = partial(_within, chamber, loops, centre)
        level = _square(taken, wanted, farthest, 0.0)
        upright = _is_upright(chamber, level, ramp)
        found.append(level if upright else _square(taken, wanted, farthest, ramp))
    return found


def _is_upright(chamber: FilledChamber, square: float, ramp: float) -> bool:
    """A surface stands so nearly upright that it is drawn as if it did."""
    return ramp == 0.0 or math.sqrt(max(square, 0.0) + ramp) - math.sqrt(max(square, 0.0)) < (
        UPRIGHT * chamber.radius
    )


def _square(taken: Callable[[Array], Array], area: float, farthest: float, ramp: float) -> float:
    """Square of the surface's radius on the floor, m^2, that leaves an area outside it in the mean.

    `taken` is the area inside some radii (the whole inside an infinite one), `ramp` the growth of the square
    from floor to lid, m^2.
    """
    whole, low, high = float(taken(np.array([math.inf]))[0]), -ramp, farthest
    share, weight = np.polynomial.legendre.leggauss(HEIGHTS) if ramp > 0.0 else (np.zeros(1), np.full(1, 2.0))

    def excess(square: Array, _: object) -> Array:
        squares = np.maximum(square + 0.5 * ramp * (1.0 + share), 0.0)
        return np.array([whole - float(0.5 * weight @ taken(np.sqrt(squares))) - area])

    return float(bracketed_root(excess, np.array([low]), np.array([high]))[0][0])


def _within(chamber: FilledChamber, loops: tuple[Complex, ...], centre: complex, radius: Array) -> Array:
    """Areas of a body's room inside circles about the rotation axis, m^2."""
    if len(walls(chamber)) == 1 and chamber.section is None:
        both = [
            np.array([_common(wall, one, abs(centre)) for one in radius.tolist()])
            for wall in (chamber.radius, chamber.inner_radius)
        ]
        return np.asarray(both[0] - both[1])
    if np.isinf(radius).all():
        return np.full(radius.shape, Remainder(loops, ()).area)
    return area_within(tuple(loop + centre for loop in loops), radius)


def _common(first: float, second: float, apart: float) -> float:
    """Area that two circles have in common, given their radii and the distance of their centres, m^2."""
    small, large = sorted((first, second))
    if apart <= large - small:
        return math.pi * small**2
    if apart >= large + small:
        return 0.0
    foot = (apart**2 + small**2 - large**2) / (2.0 * apart)
    shares = foot / small, (apart - foot) / large
    inner, outer = (math.acos(max(-1.0, min(1.0, share))) for share in shares)
    return small**2 * inner + large**2 * outer - apart * math.sqrt(max(small**2 - foot**2, 0.0))


def _inside(chamber: FilledChamber, depth_factor: float) -> list[Complex]:
    """Points of walls of each body that the liquid at rest leaves dry as a whole: inner walls, cores."""
    if chamber.section is None and chamber.baffles is not None and _closed(chamber, chamber.baffles):
        edge = abs(plates(chamber.baffles, chamber.radius, depth_factor, chamber.inner_radius)[0][0])
        width = 2.0 * math.pi / chamber.baffles.count
        turn = np.linspace(0.0, width, UNEVEN_RAYS // chamber.baffles.count)
        return [edge * np.exp(1j * (start + turn)) for start in chamber.baffles.angles]
    reach = chamber.mean_surface_radius * (1.0 + 1e-9)
    dry = [loop for loop in walls(chamber)[0] if float(np.abs(loop).max()) <= reach]
    return [np.concatenate([np.zeros(0, dtype=complex), *dry])]


def plates(
    baffles: Baffles, radius: float, depth_factor: float, inner_radius: float = 0.0
) -> list[tuple[complex, complex]]:
    """Ends of each baffle from the geometric centre, m; distances from the wall grow as the layer does."""
    inner = max(radius - (radius - baffles.tip_radius) * depth_factor, inner_radius)
    outer = max(radius - baffles.wall_gap * depth_factor, inner)
    return [(inner * complex(turn), outer * complex(turn)) for turn in np.exp(1j * baffles.angles)]


@dataclass(frozen=True)
class Views:
    """What the figure of the chambers shows."""

    drawings: list[tuple[FilledChamber, ...]]  #: chambers of each column
    instants: list[int]  #: index of each view over the speeds of the curve
    #: exaggeration of each view; alike, so that views can be compared, if the smaller deflection can be seen
    #: so
    scales: list[Exaggeration]
    largest: float  #: deflection of all views as drawn, m
    inner: list[int]  #: index of the views in which liquid reaches an inner wall, and whose surface is a bowl
    bowls: list[int]
    left_out: int  #: number of chambers that found no room


def chamber_figure(result: RunAnswer) -> Figure:
    """Chambers as seen along the axis at the largest deflection and at the working speed."""
    views = choose_views(result)
    zero = "unbalance" if result.motion is None else result.motion.zero
    with style():
        figure = Figure()
        figure.alt = alts(result)["chamber"]
        cells = [(drawing, index) for index in views.instants for drawing in views.drawings]
        if not cells:
            axes: Axes = figure.add_axes((0, 0, 1, 1), frame_on=False, xticks=[], yticks=[])
            axes.text(0.5, 0.5, "no chamber, or no deflection found", ha="center")
            lay_out(figure, [[axes]], [1.0], FRAME, caption(result, "Chamber seen along the axis."))
            return figure
        drawn = []
        for i, (chambers, index) in enumerate(cells):
            scale = views.scales[views.instants.index(index)]
            axes = figure.add_axes((0, 0, 1, 1), label=str(i))
            at = moved(result, chambers, index)
            draw_chambers(axes, chambers, at, views, scale, bend_at(result, index), zero)
            if i % len(views.drawings) == 0:
                write_numbers(axes, result, views, index)
            drawn.append(axes)
        # Up to two drawings of each view stand in one row, more in a row for each view.
        columns = len(drawn) if len(views.drawings) < 3 else len(views.drawings)
        rows = [drawn[i : i + columns] for i in range(0, len(drawn), columns)]
        sides = [min(2.7, (WIDTH - FRAME.left - RIGHT) / columns)] * len(rows)
        part = ""
        if result.motion is not None:
            place = amplitude_place(result)
            part = f" Amplitudes are those {place}; drawn is the part of the motion that turns with the spin."
        if any(result.curve.model[index] in HELD_MODELS for index in views.instants):
            part += " The liquid is drawn at rest in the mean motion, without its waves."
        text = caption(result, f"Chamber seen along the axis. {describe_scale(result, views)}{part}")
        out_of_range = not result.curve.in_range[views.instants].all()
        more = HEADING_ROW * ((len(views.drawings) > 1) + int(out_of_range))
        below = 0.0 if result.motion is None else HEADING_ROW
        frame = replace(FRAME, top=FRAME.top + more, between=BETWEEN + more + below, below=BELOW + below)
        lay_out(figure, rows, sides, frame, text)
    return figure


def choose_views(result: RunAnswer) -> Views:
    """The chambers at the resonance peak and at the working speed, the last one.

    Speeds without an answer are not drawn.
    """
    curve = result.curve
    deflection = curve.deflection
    last, highest = deflection.size - 1, curve.top
    if highest is not None and np.isinf(curve.amplitude[highest]):
        highest = peak(curve.amplitude)
    instants = [i for i in (highest, last) if i is not None and np.isfinite(deflection[i])]
    if highest is None or highest == last or curve.amplitude[highest] == 0.0:
        instants = instants[-1:]
    drawings = side_by_side(result.chambers)
    drawn = drawings[:MOST_DRAWINGS]
    at = [
        [(chamber, moved(result, drawing, i)) for drawing in drawn for chamber in drawing] for i in instants
    ]
    bends = [bend_at(result, i) for i in instants]
    scales = _scales(at, bends)
    largest = max(
        (s.deflection * abs(w) for s, here in zip(scales, at, strict=True) for _, w in here), default=0.0
    )
    inner, bowls = [], []
    for i, here, bend in zip(instants, at, bends, strict=True):
        if any(meets_inner_wall(chamber, w, 1.0, bend) for chamber, w in here):
            inner.append(i)
        if any(
            c.volume > 0.0 and not _is_upright(c, square, bend * c.height)
            for c, w in here
            for square in levels(c, w, 1.0, bend)
        ):
            bowls.append(i)
    left_out = sum(map(len, drawings[MOST_DRAWINGS:]))
    return Views(drawn, instants, scales, largest, inner, bowls, left_out)


def bend_at(result: RunAnswer, index: int) -> float:
    """Growth of the squared radius of the free surface along the axis at a speed, 2 g/Omega^2, m."""
    return 2.0 * result.axial_gravity / float(result.curve.speed[index]) ** 2


def _scales(at: list[list[tuple[FilledChamber, complex]]], bends: list[float]) -> list[Exaggeration]:
    """Of each view, given its chambers and their deflections, and the bend of its surface."""
    if not at or not at[0]:
        return [Exaggeration(1.0, 1.0)] * len(at)
    radius = max(chamber.radius for chamber, _ in at[0])
    chambers = tuple(chamber for chamber, _ in at[0])
    of_view = [list(dict.fromkeys((w, bend) for _, w in here)) for here, bend in zip(at, bends, strict=True)]
    common = exaggeration(chambers, *zip(*(pair for pairs in of_view for pair in pairs), strict=True))
    sizes = [max(abs(w) for _, w in here) for here in at]
    if all(common.deflection * size >= SEEN * radius for size in sizes if size > 0.0):
        return [common] * len(at)
    return [exaggeration(chambers, *zip(*pairs, strict=True)) for pairs in of_view]


def moved(result: RunAnswer, chambers: tuple[FilledChamber, ...], index: int) -> complex:
    """Deflection of the axis at the chambers of one drawing, m; the unbalance along the real axis."""
    return complex(result.chamber_curve[index, result.chambers.index(chambers[0])])


def describe_scale(result: RunAnswer, views: Views) -> str:
    """The exaggeration as text."""
    scales = views.scales[:1] if len(set(views.scales)) <= 1 else views.scales
    names = [_at_speed(result, i) if len(scales) > 1 else "" for i in views.instants]
    deflection = " and ".join(
        f"{_times(scale.deflection)}{name}" for scale, name in zip(scales, names, strict=False)
    )
    depth = " and ".join(dict.fromkeys(_times(scale.depth) for scale in scales))
    text = f"Deflection drawn {deflection}, mean depth of the layer {depth}; walls to scale."
    if deflection == depth == "to scale":
        text = "Everything to scale."
    if views.inner:
        text += f" The liquid reaches an inner wall{' and'.join(_at_speed(result, i) for i in views.inner)}."
    if views.bowls:
        places = " and".join(_at_speed(result, i) for i in views.bowls)
        text += f" The surface is a bowl{places}: the darker, the higher above the floor the liquid reaches."
    return f"{text} {views.left_out} more chambers are not drawn." if views.left_out else text


def _times(factor: float) -> str:
    return "to scale" if factor == 1.0 else f"{TIMES}\N{NO-BREAK SPACE}{factor:g}"


def _at_speed(result: RunAnswer, index: int) -> str:
    return f" at {in_rpm(result.curve.speed[index])}"


def describe_view(result: RunAnswer, index: int) -> str:
    """Name and speed of one view."""
    r = result.curve
    name = "Working speed" if index == r.speed.size - 1 else "Largest deflection"
    text = f"{name}, {in_rpm(r.speed[index])}"
    return text if r.in_range[index] else f"{text}\n(model out of range)"


def describe_state(result: RunAnswer, index: int) -> str:
    """Numbers of one view as text."""
    r = result.curve
    w, offset = r.deflection[index], r.liquid_offset[index]
    if w == 0.0:
        return "no deflection"
    place = f"{with_unit(abs(w), LENGTH)} at {_degrees(float(phase(w)))}{DEGREE}"
    text = f"deflection {place}"
    if result.motion is not None:
        size = with_unit(float(result.curve.amplitude[index]), LENGTH)
        text = f"amplitude {size} at chamber 1,\nof it with the spin {place}"
    if offset > 0.0:
        text += f"\nliquid {with_unit(offset, LENGTH)} at {_degrees(float(r.liquid_angle[index]))}{DEGREE}"
    return text


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.0f}".replace("-0", "0", 1).replace("-", MINUS)


def draw_chambers(
    axes: Axes,
    chambers: tuple[FilledChamber, ...],
    deflection: complex,
    views: Views,
    scale: Exaggeration,
    bend: float = 0.0,
    zero: str = "unbalance",
) -> None:
    """Walls, liquid, axes, unbalance and spin of chambers inside one another, the widest first.

    The deflection, m, is complex from the unbalance; `bend` as for `exaggeration`, `zero` is what the real
    axis points to.
    """
    centre = deflection * scale.deflection * MM
    widest = chambers[0].radius * MM
    reach = 1.18 * widest + views.largest * MM
    for chamber in chambers:
        _draw_liquid(axes, chamber, centre, scale.depth, bend)
        _draw_walls(axes, chamber, centre, scale.depth)
    _unbalance(axes, centre, widest, zero)
    axes.plot([0.0, centre.real], [0.0, centre.imag], color=CENTRE, linewidth=1.2)
    axes.plot([0.0], [0.0], "+", color="black", markersize=9, markeredgewidth=1.2, label="rotation axis")
    axes.plot(
        *([centre.real], [centre.imag]),
        *("o",),
        markerfacecolor="white",
        markeredgecolor=CENTRE,
        markersize=5,
        markeredgewidth=1.3,
        label="geometric centre",
    )
    axes.set_xlim(-reach, reach)
    axes.set_ylim(-reach, reach)
    axes.set_aspect("equal")
    if len(views.drawings) > 1:
        names = ", ".join(f"{number(chamber.radius * MM)}" for chamber in chambers)
        planes = {chamber.plane for drawing in views.drawings for chamber in drawing}
        place = f", at {number(chambers[0].plane * MM)}".replace("-", MINUS) if len(planes) > 1 else ""
        axes.set_title(f"radius {names}{place} mm", fontsize=7, color="0.3", pad=3.0, y=1.0)
    axes.axis("off")


def _draw_liquid(
    axes: Axes, chamber: FilledChamber, centre: complex, depth_factor: float, bend: float
) -> None:
    """Each body of liquid and its free surface, a bowl in shades of its depth."""
    if chamber.volume == 0.0 or chamber.radius <= chamber.mean_surface_radius:
        return
    for body in bodies(chamber, centre / MM, depth_factor, bend):
        tiers = [body.liquid, *body.higher]
        shades = SHADES if body.higher else [LIQUID]
        for tier, shade in zip(tiers, shades, strict=True):
            fill_loops(axes, [loop * MM for loop in tier.loops], facecolor=shade, label="liquid")
        for arc in (*body.liquid.arcs, *(body.higher[-1].arcs if body.higher else ())):
            axes.plot(arc.real * MM, arc.imag * MM, color=SURFACE, linewidth=0.9, solid_capstyle="butt")


def _draw_walls(axes: Axes, chamber: FilledChamber, centre: complex, depth_factor: float) -> None:
    """Walls and baffles."""
    look = {"color": WALL, "linewidth": 1.4, "solid_capstyle": "butt"}
    if chamber.section is not None:
        for loop in walls(chamber)[0]:
            closed = np.append(loop, loop[0]) * MM + centre
            axes.plot(closed.real, closed.imag, **look)
        return
    for radius in (chamber.radius, chamber.inner_radius):
        if radius > 0.0:
            axes.plot(*_circle(centre, radius * MM), **look)
    if chamber.baffles is not None:
        for ends in plates(chamber.baffles, chamber.radius, depth_factor, chamber.inner_radius):
            x, y = np.array([centre + end * MM for end in ends]).view(float).reshape(-1, 2).T
            axes.plot(x, y, **look)


def write_numbers(axes: Axes, result: RunAnswer, views: Views, index: int) -> None:
    """Heading above and numbers below the drawings of one view, from the first of them to the right."""
    middle = 0.5 * len(views.drawings)
    place = {"xycoords": "axes fraction", "textcoords": "offset points", "ha": "center"}
    # Above names of the drawings if there are several.
    above = 4.0 if len(views.drawings) == 1 else 13.0
    axes.annotate(describe_view(result, index), (middle, 1.0), xytext=(0.0, above), va="bottom", **place)
    axes.annotate(describe_state(result, index), (middle, 0.0), xytext=(0.0, -2.0), va="top", **place)


def _unbalance(axes: Axes, centre: complex, radius: float, label: str) -> None:
    """A heavy spot outside the wall along the unbalance, and an arrow for the sense of the spin."""
    spot = centre + OUTSIDE * radius
    axes.plot([centre.real + radius, spot.real], [centre.imag, spot.imag], linewidth=1.4, color=UNBALANCE)
    axes.plot([spot.real], [spot.imag], "s", color=UNBALANCE, markersize=6, label=label, zorder=4)
    sweep = np.linspace(math.radians(115.0), math.radians(155.0), 30)
    arc: Array = centre + 1.13 * radius * np.exp(1j * sweep)
    axes.plot(arc.real, arc.imag, color="0.3", linewidth=1.0)
    axes.annotate(
        *("", (arc[-1].real, arc[-1].imag)),
        xytext=(arc[-3].real, arc[-3].imag),
        arrowprops={"arrowstyle": "-|>", "color": "0.3", "linewidth": 1.0, "shrinkA": 0, "shrinkB": 0},
    )
    middle = centre + 1.25 * radius * cmath.exp(1j * math.radians(135.0))
    axes.text(middle.real, middle.imag, "spin", fontsize=7, color="0.3", ha="right", va="center")


def _circle(centre: complex, radius: float) -> tuple[Array, Array]:
    points = centre + radius * np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 361))
    return points.real, points.imag
