"""Draw rooms, the folders of modules, as boxes in layers with the imports between them; see house.py.

Who imports stands above whom it imports. All imports of a room flow together into one stream that ends in one
arrow, so what a line leads to is plain anywhere on it; the stream is as wide as the imports in it are many.
Imports against the order, which only rooms in a circle have, are dashed.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

Imports = Mapping[tuple[str, str], int]
# A box, by the room's name, or the stream towards a room where it passes through a row.
Node = str | tuple[str, int]

# Lengths in hundredths of an inch; the picture is meant to be shown one pixel each.
WIDTH, LEFT, RIGHT, FOOT = 1000.0, 112.0, 24.0, 24.0
BOX, GAP, BAND, APART = 38.0, 44.0, 16.0, 24.0  # a box, between rows, a band beyond its boxes, between bands
# Least room beside a stream and beside a box, and how many times that may become where there is more.
BESIDE_STREAM, BESIDE_BOX, LOOSEST = 4.0, 7.0, 3.0
NARROWEST, MARGIN = 84.0, 14.0  # a box, and beside its name together
MOST = 6  # boxes in a row
SWEEPS, PASSES = 30, 400  # to untangle, to straighten
FONT, NAME, SMALL = "DejaVu Sans", 9.5, 7.5  # which comes with matplotlib; points
DOTS = 100  # of the PNG to an inch
# Okabe and Ito's colours, which colour-blind readers tell apart; from the ground up, then again.
COLOURS = ("#0072B2", "#009E73", "#E69F00", "#CC79A7", "#56B4E9", "#D55E00")
AGAINST = "#000000"


@dataclass(frozen=True)
class Rooms:
    """Rooms and the imports between them.

    Parameters
    ----------
    sizes : modules of each room; its name is its folder with slashes, the package first
    imports : importing and imported room: pairs of a module and one that it imports
    """

    sizes: Mapping[str, int]
    imports: Imports


@dataclass(frozen=True)
class Plan:
    """Where everything stands.

    Parameters
    ----------
    rows : boxes and streams from left to right, the upper row first
    packages : of each row
    places : middle of each box and stream, from the left
    width : of the picture
    against : imports that do not lead downwards
    """

    rows: list[list[Node]]
    packages: list[str]
    places: dict[Node, float]
    width: float
    against: list[tuple[str, str]]


def circles(imports: Imports) -> list[list[str]]:
    """Groups of rooms that import one another in a circle.

    Parameters
    ----------
    imports : see `Rooms`
    """
    groups = _groups({name for pair in imports for name in pair}, imports)
    return sorted(sorted(group) for group in groups if len(group) > 1)


def _groups(names: Iterable[str], imports: Imports) -> list[set[str]]:
    """Rooms that reach one another, group by group, importers first."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    index = {name: k for k, name in enumerate(sorted(names))}
    pairs = [(index[a], index[b]) for a, b in imports if a in index and b in index]
    ends = np.array(pairs, dtype=np.int32).reshape(-1, 2).T
    matrix = coo_array((np.ones(len(pairs)), (ends[0], ends[1])), shape=(len(index), len(index)))
    count, labels = connected_components(matrix.tocsr(), connection="strong")
    members = [{name for name, k in index.items() if labels[k] == group} for group in range(count)]
    above = {k: {int(labels[a]) for a, b in pairs if labels[b] == k} - {k} for k in range(count)}
    found = []
    while above:
        free = min((k for k in above if not above[k] & above.keys()), key=lambda k: min(members[k]))
        found.append(members[free])
        del above[free]
    return found


def order(names: Iterable[str], imports: Imports) -> list[str]:
    """Importers first; within a circle first what imports more of it than it is imported.

    Parameters
    ----------
    names : to order
    imports : among them, and others
    """
    found: list[str] = []
    for group in _groups(names, imports):
        surplus = dict.fromkeys(group, 0)
        for (importer, imported), count in imports.items():
            if importer in group and imported in group:
                surplus[importer] += count
                surplus[imported] -= count
        found += sorted(group, key=lambda name: (-surplus[name], name))
    return found


def _package(room: str) -> str:
    return room.partition("/")[0]


def layers(rooms: Rooms) -> list[list[str]]:
    """Rooms of one package in each row, the upper row first; imports lead downwards but within circles.

    Parameters
    ----------
    rooms : to place
    """
    between: dict[tuple[str, str], int] = {}
    for (importer, imported), count in rooms.imports.items():
        pair = _package(importer), _package(imported)
        between[pair] = between.get(pair, 0) + count
    rows: list[list[str]] = []
    for package in order({_package(room) for room in rooms.sizes}, between):
        inside = order([room for room in rooms.sizes if _package(room) == package], rooms.imports)
        height: dict[str, int] = {}
        for k, room in reversed([*enumerate(inside)]):
            below = [height[other] for other in inside[k + 1 :] if (room, other) in rooms.imports]
            height[room] = 1 + max(below, default=-1)
        for level in range(max(height.values()), -1, -1):
            row = [room for room in inside if height[room] == level]
            count = math.ceil(len(row) / MOST)
            rows += [list(part) for part in np.array_split(np.array(row, dtype=object), count)]
    return rows


def plan(rooms: Rooms) -> Plan:
    """Place rooms and streams.

    Parameters
    ----------
    rooms : to place
    """
    boxes = layers(rooms)
    level = {room: k for k, row in enumerate(boxes) for room in row}
    downward = [pair for pair in rooms.imports if level[pair[0]] < level[pair[1]]]
    against = sorted(pair for pair in rooms.imports if level[pair[0]] >= level[pair[1]])
    rows: list[list[Node]] = [list(row) for row in boxes]
    for room in level:
        first = min((level[a] for a, b in downward if b == room), default=level[room])
        for k in range(first + 1, level[room]):
            rows[k].append((room, k))
    links = _links(rows, downward, level)
    rows = _untangled(rows, links)
    solid = np.array([sum(map(breadth_of, row)) for row in rows])
    gaps = np.array([sum(map(_gap, row)) for row in rows])
    width = max(WIDTH, LEFT + RIGHT + float(np.max(solid + gaps)))
    loose = min(LOOSEST, float(np.min((width - LEFT - RIGHT - solid) / gaps)))
    return Plan(rows, [_package(row[0]) for row in boxes], _spread(rows, links, width, loose), width, against)


def _links(
    rows: Sequence[Sequence[Node]], downward: Iterable[tuple[str, str]], level: Mapping[str, int]
) -> set[tuple[Node, Node]]:
    """What is joined to what in the row below."""

    def stream(room: str, row: int) -> Node:
        return room if level[room] == row else (room, row)

    links = {(importer, stream(imported, level[importer] + 1)) for importer, imported in downward}
    for row in rows:
        links |= {(node, stream(node[0], node[1] + 1)) for node in row if isinstance(node, tuple)}
    return links


def _neighbours(links: Iterable[tuple[Node, Node]]) -> tuple[dict[Node, list[Node]], dict[Node, list[Node]]]:
    """Above and below each node."""
    above: dict[Node, list[Node]] = {}
    below: dict[Node, list[Node]] = {}
    for high, low in sorted(links, key=str):
        above.setdefault(low, []).append(high)
        below.setdefault(high, []).append(low)
    return above, below


def _untangled(rows: list[list[Node]], links: set[tuple[Node, Node]]) -> list[list[Node]]:
    """The same rows, in an order with few crossings: by the mean place of the neighbours, down and up."""
    above, below = _neighbours(links)
    rows = [sorted(row, key=str) for row in rows]
    best, fewest = rows, math.inf
    for sweep in range(SWEEPS):
        rows = [list(row) for row in rows]
        downwards = sweep % 2 == 0
        for k in range(1, len(rows)) if downwards else range(len(rows) - 2, -1, -1):
            beside, joined = (rows[k - 1], above) if downwards else (rows[k + 1], below)
            at = {node: (i + 0.5) / len(beside) for i, node in enumerate(beside)}
            own = {node: (i + 0.5) / len(rows[k]) for i, node in enumerate(rows[k])}
            mean = {n: float(np.mean([at[m] for m in joined.get(n, [])] or [own[n]])) for n in rows[k]}
            rows[k].sort(key=lambda node: mean[node])
        crossings = sum(_crossings(upper, lower, below) for upper, lower in pairwise(rows))
        if crossings < fewest:
            best, fewest = rows, crossings
    return best


def _crossings(upper: Sequence[Node], lower: Sequence[Node], below: Mapping[Node, Sequence[Node]]) -> int:
    """How many links between two rows cross."""
    at = {node: k for k, node in enumerate(lower)}
    ends = [(i, at[low]) for i, node in enumerate(upper) for low in below.get(node, [])]
    return sum(a < c and b > d for a, b in ends for c, d in ends)


def breadth_of(node: Node) -> float:
    """Width of a box; a stream has none that matters."""
    return max(NARROWEST, _length(label(node)) + MARGIN) if isinstance(node, str) else 0.0


@cache
def _length(text: str) -> float:
    """Length of a name as it is written in a box."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import TextToPath

    width, _, _ = TextToPath().get_text_width_height_descent(
        text, FontProperties(family=FONT, size=NAME), False
    )
    return float(width) * 100.0 / 72.0


def _gap(node: Node) -> float:
    """Least room on both sides of a node together."""
    return 2.0 * (BESIDE_BOX if isinstance(node, str) else BESIDE_STREAM)


def label(room: str) -> str:
    """What stands in the box of a room: its folder in the package."""
    return room.partition("/")[2] or room


def _spread(
    rows: Sequence[Sequence[Node]], links: set[tuple[Node, Node]], width: float, loose: float
) -> dict[Node, float]:
    """Places that draw every node to its neighbours and keep it clear of those beside it."""
    from scipy.optimize import isotonic_regression

    joined: dict[Node, list[tuple[Node, float]]] = {}
    for high, low in sorted(links, key=str):
        # Streams are to run straight: between two places of one the pull is the strongest.
        pull = (1.0, 3.0, 9.0)[isinstance(high, tuple) + isinstance(low, tuple)]
        joined.setdefault(high, []).append((low, pull))
        joined.setdefault(low, []).append((high, pull))
    halves = {node: 0.5 * (breadth_of(node) + loose * _gap(node)) for row in rows for node in row}
    # Distances from the first of a row where all stand close, and where the first may stand.
    close = [np.cumsum([0.0, *(halves[a] + halves[b] for a, b in pairwise(row))]) for row in rows]
    low = [LEFT + halves[row[0]] for row in rows]
    high = [width - RIGHT - halves[row[-1]] - offsets[-1] for row, offsets in zip(rows, close, strict=True)]
    places: dict[Node, float] = {}
    for k, row in enumerate(rows):
        places |= dict(zip(row, (0.5 * (low[k] + high[k]) + close[k]).tolist(), strict=True))
    for count in range(PASSES):
        for k in range(len(rows)) if count % 2 == 0 else range(len(rows) - 1, -1, -1):
            pulls = [joined.get(node, [(node, 1.0)]) for node in rows[k]]
            weights = np.array([sum(pull for _, pull in some) for some in pulls])
            wanted = np.array([sum(places[other] * pull for other, pull in some) for some in pulls]) / weights
            fitted = isotonic_regression(wanted - close[k], weights=weights).x
            kept = np.clip(fitted, low[k], high[k]) + close[k]
            places |= dict(zip(rows[k], kept.tolist(), strict=True))
    return places


def draw_rooms(graph: Rooms, path: Path) -> tuple[Path, Path]:
    """Draw rooms and their imports; the PNG and the SVG."""
    import matplotlib

    files = path.with_suffix(".png"), path.with_suffix(".svg")
    path.parent.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context({"font.family": FONT, "svg.hashsalt": "rooms"}):  # the same files every time
        drawn = figure(graph)
        drawn.savefig(files[0], dpi=DOTS, metadata={"Software": None})
        drawn.savefig(files[1], metadata={"Date": None, "Creator": "leblanc"})
    return files


def figure(graph: Rooms) -> Any:
    """The figure of rooms.

    Parameters
    ----------
    graph : rooms and their imports
    """
    from matplotlib.figure import Figure

    placed = plan(graph)
    heights, bands, total = _heights(placed.packages)
    drawn = Figure(figsize=(placed.width / 100.0, total / 100.0), facecolor="white")
    axes = drawn.add_axes((0, 0, 1, 1), xlim=(0, placed.width), ylim=(total, 0))
    axes.set_axis_off()
    tints = dict(zip(dict.fromkeys(reversed(placed.packages)), 3 * COLOURS, strict=False))
    _draw_bands(axes, graph, bands, placed.width, tints)
    _draw_streams(axes, graph, placed, heights, tints)
    _draw_boxes(axes, graph, placed, heights, tints)
    _draw_against(axes, placed, heights)
    _draw_key(axes, total, bool(placed.against))
    return drawn


def _heights(packages: Sequence[str]) -> tuple[list[float], dict[str, tuple[float, float]], float]:
    """Upper edge of the boxes of each row, upper and lower edge of each band, height of the picture."""
    heights: list[float] = []
    bands: dict[str, tuple[float, float]] = {}
    at = 8.0
    for k, package in enumerate(packages):
        new = k == 0 or packages[k - 1] != package
        top = at if new else bands[package][0]
        heights.append(at + (BAND if new else 0.0))
        bands[package] = (top, heights[-1] + BOX + BAND)
        last = k + 1 == len(packages) or packages[k + 1] != package
        at = heights[-1] + BOX + (BAND + APART if last else GAP)
    return heights, bands, at + FOOT


def _mixed(colour: str, white: float) -> tuple[float, float, float]:
    """A colour with a share of white."""
    from matplotlib.colors import to_rgb

    red, green, blue = (white + (1.0 - white) * part for part in to_rgb(colour))
    return red, green, blue


def _draw_bands(
    axes: Any, graph: Rooms, bands: Mapping[str, tuple[float, float]], width: float, tints: Mapping[str, str]
) -> None:
    """A band behind the rooms of each package, with its name."""
    from matplotlib.patches import Rectangle

    for package, (top, bottom) in bands.items():
        pale = _mixed(tints[package], 0.9)
        axes.add_patch(Rectangle((8, top), width - 16, bottom - top, facecolor=pale, edgecolor="none"))
        middle = 0.5 * (top + bottom)
        axes.text(18, middle - 6, package, fontsize=NAME + 1, weight="bold", va="center")
        count = sum(size for room, size in graph.sizes.items() if _package(room) == package)
        axes.text(18, middle + 11, _modules(count), fontsize=SMALL, va="center", color="0.25")


def _modules(count: int) -> str:
    return f"{count} module" + ("s" if count != 1 else "")


def _breadth(count: float) -> float:
    """Breadth of a line for so many imports."""
    return min(10.0, 0.7 + 0.6 * math.sqrt(count))


def _draw_streams(
    axes: Any, graph: Rooms, placed: Plan, heights: Sequence[float], tints: Mapping[str, str]
) -> None:
    """All imports that lead downwards, one stream to each imported room."""
    ports = _ports(graph, placed)
    level = {node: k for k, row in enumerate(placed.rows) for node in row}
    for room in sorted(graph.sizes, key=lambda name: -level[name]):
        pieces = _pieces(room, graph, placed, heights, ports, level)
        if not pieces:
            continue
        # White beneath shows which of two lines that cross is which.
        for extra, colour in ((2.4, "white"), (0.0, _mixed(tints[_package(room)], 0.15))):
            for start, end, breadth in pieces:
                _draw_piece(axes, start, end, breadth + extra, colour)
        _draw_head(axes, placed.places[room], heights[level[room]], pieces, tints[_package(room)])


def _pieces(
    room: str,
    graph: Rooms,
    placed: Plan,
    heights: Sequence[float],
    ports: Mapping[tuple[str, str], float],
    level: Mapping[Node, int],
) -> list[tuple[tuple[float, float], tuple[float, float], float]]:
    """Lines of the stream towards a room: start, end, breadth."""
    counts = {a: n for (a, b), n in graph.imports.items() if b == room and level[a] < level[room]}
    pieces = []
    for k in range(level[room]):
        low: Node = room if k + 1 == level[room] else (room, k + 1)
        end = (placed.places.get(low, 0.0), heights[k + 1] - (5.0 if low == room else 0.0))
        for importer in (name for name in counts if level[name] == k):
            start = (ports[importer, room], heights[k] + BOX)
            pieces.append((start, end, _breadth(counts[importer])))
        if (room, k) in placed.places:
            x, so_far = placed.places[room, k], sum(n for name, n in counts.items() if level[name] < k)
            pieces.append(((x, heights[k]), (x, heights[k] + BOX), _breadth(so_far)))
            pieces.append(((x, heights[k] + BOX), end, _breadth(so_far)))
    return pieces


def _ports(graph: Rooms, placed: Plan) -> dict[tuple[str, str], float]:
    """Where the imports of a room leave its box, from left to right as their streams go."""
    level = {node: k for k, row in enumerate(placed.rows) for node in row}
    found = {}
    for room in graph.sizes:
        out = [b for a, b in graph.imports if a == room and level[room] < level[b]]
        out.sort(key=lambda b: (placed.places.get((b, level[room] + 1), placed.places[b]), b))
        step = min(12.0, (breadth_of(room) - 20.0) / max(1, len(out) - 1))
        for k, imported in enumerate(out):
            found[room, imported] = placed.places[room] + step * (k - 0.5 * (len(out) - 1))
    return found


def _draw_piece(
    axes: Any, start: tuple[float, float], end: tuple[float, float], breadth: float, colour: Any
) -> None:
    """A line that leaves and arrives vertically."""
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path as Line

    (x, y), (u, v) = start, end
    middle = 0.5 * (y + v)
    line = Line([(x, y), (x, middle), (u, middle), (u, v)], [Line.MOVETO, *[Line.CURVE4] * 3])
    axes.add_patch(
        PathPatch(line, fill=False, edgecolor=colour, linewidth=0.72 * breadth, capstyle="butt", zorder=2)
    )


def _draw_head(axes: Any, x: float, y: float, pieces: Iterable[tuple[Any, Any, float]], colour: str) -> None:
    """The arrow in which a stream ends."""
    from matplotlib.patches import Polygon

    side = 4.0 + 0.5 * max(breadth for _, end, breadth in pieces if end[0] == x)
    corners = [(x - side, y - 9.0), (x + side, y - 9.0), (x, y)]
    axes.add_patch(Polygon(corners, facecolor=colour, edgecolor="white", linewidth=0.6, zorder=4))


def _draw_boxes(
    axes: Any, graph: Rooms, placed: Plan, heights: Sequence[float], tints: Mapping[str, str]
) -> None:
    """The rooms with their names."""
    from matplotlib.patches import FancyBboxPatch

    for row, top in zip(placed.rows, heights, strict=True):
        for room in (node for node in row if isinstance(node, str)):
            x, half, colour = placed.places[room], 0.5 * breadth_of(room), tints[_package(room)]
            axes.add_patch(
                FancyBboxPatch(
                    (x - half, top),
                    2.0 * half,
                    BOX,
                    boxstyle="round,pad=0,rounding_size=5",
                    facecolor=_mixed(colour, 0.72),
                    edgecolor=colour,
                    linewidth=1.1,
                    zorder=3,
                )
            )
            style = {"ha": "center", "va": "center", "zorder": 5}
            axes.text(x, top + 13.5, label(room), fontsize=NAME, **style)
            axes.text(x, top + 28.0, _modules(graph.sizes[room]), fontsize=SMALL, color="0.2", **style)


def _draw_against(axes: Any, placed: Plan, heights: Sequence[float]) -> None:
    """Imports that do not lead downwards."""
    from matplotlib.patches import FancyArrowPatch

    level = {node: k for k, row in enumerate(placed.rows) for node in row}
    for importer, imported in placed.against:
        ends = [
            (placed.places[room] + 0.5 * breadth_of(room), heights[level[room]] + share * BOX)
            for room, share in ((importer, 0.3), (imported, 0.7))
        ]
        axes.add_patch(
            FancyArrowPatch(
                *ends,
                arrowstyle="-|>",
                connectionstyle="arc3,rad=0.4",
                mutation_scale=10,
                linestyle=(0, (4, 2)),
                color=AGAINST,
                linewidth=1.3,
                zorder=2.5,  # behind the names
            )
        )


def _draw_key(axes: Any, total: float, against: bool) -> None:
    """What the lines mean."""
    y, x = total - 0.5 * FOOT, 18.0
    style = {"fontsize": SMALL, "va": "center", "color": "0.2"}
    axes.text(x, y, "Arrows lead to what is imported, in the colour of its package. Imports:", **style)
    x += 398.0
    for count in (1, 10, 100):
        axes.plot([x, x + 30], [y, y], color="0.45", lw=0.72 * _breadth(count), solid_capstyle="butt")
        axes.text(x + 36, y, str(count), **style)
        x += 74.0
    if against:
        axes.plot([x, x + 30], [y, y], color=AGAINST, lw=1.3, ls=(0, (4, 2)))
        axes.text(x + 36, y, "against the order, in a circle", **style)
