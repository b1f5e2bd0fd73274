"""The picture of the architecture page: parts on floors, whoever imports another above it; see house.py."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

Imports = Mapping[tuple[str, str], int]

# From the top: package, and its parts with the folders or modules of each.
FLOORS: tuple[tuple[str, Mapping[str, tuple[str, ...]]], ...] = (
    ("validation", {"cases, notebooks, trade": ("validation",)}),
    ("leblanc", {"commands, sliders": ("leblanc.cli", "leblanc.__main__", "leblanc.app")}),
    ("leblanc", {"calls": ("leblanc",), "three dimensions": ("leblanc.view",)}),
    ("leblanc", {"wings": ("leblanc.wings",)}),
    (
        "leblanc",
        {
            "studies: question, study, answer": ("leblanc.studies",),
            "plotting": ("leblanc.plotting",),
        },
    ),
    ("leblanc", {"liquid models: choice, errors": ("leblanc.liquid",)}),
    ("leblanc", {"machine file": ("leblanc.scene",)}),
    (
        "leblanc",
        {
            "core, registry": ("leblanc.core", "leblanc.registry", "leblanc.moved"),
        },
    ),
    (
        "solvers",
        {
            "in time, py-pde": ("solvers.runup", "solvers.held", "solvers.pypde"),
            "self-excited whirl": ("solvers.whirl", "solvers.cycles"),
            "synchronous response": ("solvers.synchronous",),
        },
    ),
    (
        "solvers",
        {
            "nonlinear potential flow": ("solvers.potential",),
            "finite elements, statics": ("solvers.sloshing", "solvers.statics"),
        },
    ),
    (
        "solvers",
        {
            "shallow-water layer": ("solvers.layer", "solvers.waves"),
            "rotors": ("solvers.rotor",),
            "models, roots, search": ("solvers",),
        },
    ),
    ("fluid", {"equations and closed forms": ("fluid",)}),
    ("meshes", {"chambers, sections, meshes": ("meshes",)}),
)
COLOURS = {
    "validation": "#CC79A7",
    "leblanc": "#E69F00",
    "solvers": "#009E73",
    "fluid": "#56B4E9",
    "meshes": "#0072B2",
}
WIDTH, HIGH, GAP, LEFT = (
    10.0,
    0.42,
    0.26,
    1.1,
)  # inches: of the picture, a floor, between floors, left of boxes


def part_of(module: str) -> tuple[int, str]:
    """Floor, counted from the top, and part that a module lies in: the longest name that it begins with."""
    found = [
        (len(name), floor, part)
        for floor, (_, parts) in enumerate(FLOORS)
        for part, names in parts.items()
        for name in names
        if module == name or module.startswith(f"{name}.")
    ]
    _, floor, part = max(found)
    return floor, part


def circles(imports: Imports) -> list[list[str]]:
    """Groups of folders that import one another in a circle, from the imports between them."""
    below: dict[str, set[str]] = {}
    for above, other in imports:
        below.setdefault(above, set()).add(other)
    reached = {name: _reached(name, below) for name in below}
    groups = {
        frozenset({name, *(other for other in found if name in reached.get(other, ()))})
        for name, found in reached.items()
        if name in found
    }
    return sorted(sorted(group) for group in groups)


def _reached(name: str, below: Mapping[str, Iterable[str]]) -> set[str]:
    """All that a folder imports, itself if in a circle, directly or through others."""
    found: set[str] = set()
    ways = [*below[name]]
    while ways:
        way = ways.pop()
        if way not in found:
            found.add(way)
            ways += below.get(way, ())
    return found


def figure(modules: Iterable[str]) -> Any:
    """The figure: each part with how many modules it has."""
    from matplotlib.figure import Figure
    from matplotlib.patches import FancyBboxPatch

    sizes = Counter(part_of(module) for module in modules)
    high = len(FLOORS) * (HIGH + GAP)
    drawn = Figure(figsize=(WIDTH, high), facecolor="white")
    axes = drawn.add_axes((0, 0, 1, 1), xlim=(0, WIDTH), ylim=(high, 0))
    axes.set_axis_off()
    last = ""
    for floor, (package, parts) in enumerate(FLOORS):
        top, broad = floor * (HIGH + GAP) + 0.5 * GAP, (WIDTH - LEFT - 0.2) / len(parts)
        if package != last:
            axes.text(0.12, top + 0.5 * HIGH, package, va="center", weight="bold", color="#222222", size=10)
        last = package
        for k, part in enumerate(parts):
            left, text = LEFT + k * broad, f"{part}  ({sizes[floor, part]})"
            box = FancyBboxPatch(
                (left + 0.08, top), broad - 0.16, HIGH, boxstyle="round,pad=0,rounding_size=0.06"
            )
            box.set(facecolor=COLOURS[package] + "40", edgecolor=COLOURS[package])
            axes.add_patch(box)
            axes.text(left + 0.5 * broad, top + 0.5 * HIGH, text, ha="center", va="center", size=10)
        if floor + 1 < len(FLOORS):
            way = {"arrowstyle": "-|>", "color": "#666666", "lw": 1.2, "shrinkA": 0, "shrinkB": 0}
            middle = 0.5 * (LEFT + WIDTH - 0.2)
            axes.annotate("", (middle, top + HIGH + GAP), (middle, top + HIGH), arrowprops=way)
    return drawn


def draw_rooms(modules: Iterable[str], path: Path) -> tuple[Path, Path]:
    """Draw the picture; the PNG and the SVG, the same files every time."""
    import matplotlib

    files = path.with_suffix(".png"), path.with_suffix(".svg")
    path.parent.mkdir(parents=True, exist_ok=True)
    with matplotlib.rc_context({"font.family": "DejaVu Sans", "svg.hashsalt": "rooms"}):
        drawn = figure(modules)
        drawn.savefig(files[0], dpi=100, metadata={"Software": None})
        drawn.savefig(files[1], metadata={"Date": None, "Creator": "leblanc"})
    return files
