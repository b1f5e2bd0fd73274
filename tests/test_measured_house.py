"""The measures of the house on trees made up for it: counts, layers, the picture of the rooms."""

from __future__ import annotations

import random
import sys
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "docs"))
try:
    import flows
    import house
    import rooms
finally:
    sys.path.pop(0)

TREE = {
    "meshes/__init__.py": "",
    "meshes/border.py": "import math\n",
    "solvers/__init__.py": "from solvers.rotor.system import run\n",
    "solvers/rotor/__init__.py": "",
    "solvers/rotor/system.py": """from .. import roots
from meshes.border import InputError
def run():
    import json
""",
    "solvers/roots.py": "from meshes import border\n\n\n\n",
    "leblanc/__init__.py": "",
    "leblanc/__main__.py": "from leblanc.cli.run import run\n",
    "leblanc/units.py": "",
    "leblanc/api.py": "from leblanc import cli\n",
    "leblanc/tools.py": "import leblanc.api\n",
    "leblanc/cli/__init__.py": "",
    "leblanc/cli/run.py": """from leblanc import units
def run():
    from solvers import rotor
    import numpy
    import json
""",
}  # fmt: skip


def tree(folder: Path) -> list[house.Module]:
    for name, text in TREE.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return house.read(folder)


def test_modules_and_imports_are_counted(tmp_path: Path) -> None:
    by_name = {module.name: module for module in tree(tmp_path)}
    assert len(by_name) == len(TREE)
    assert by_name["solvers.rotor.system"].imports == {"solvers.roots", "meshes.border"}
    assert by_name["leblanc.cli.run"].imports == {"leblanc.units", "solvers.rotor"}
    rows = {row.package: row for row in house.table(list(by_name.values()))}
    assert [*rows] == ["meshes", "solvers", "leblanc", "all"]
    assert (rows["solvers"].modules, rows["solvers"].lines, rows["solvers"].middle) == (4, 9, 2.5)
    assert rows["solvers"].largest == ("solvers.roots", 4) and rows["solvers"].folder == ("solvers", 2)
    # One importer: roots, rotor.system and rotor; border has two, the others none.
    assert (rows["solvers"].single, rows["meshes"].single) == (3, 0)
    assert rows["leblanc"].inside == (1, 2) and rows["leblanc"].inside_elsewhere == (0, 0)
    assert rows["all"].inside == (1, 3) and rows["all"].inside_elsewhere == (0, 1)


def test_what_a_front_hands_on_joins_no_rooms(tmp_path: Path) -> None:
    found = house.graph(tree(tmp_path))
    # What imports a room stands above it, and so does what imports that; the others lie below.
    assert found.sizes == {
        **{"meshes": 2, "solvers": 2, "solvers/rotor": 2, "leblanc": 3, "leblanc/cli": 2},
        **{"leblanc/api.py": 1, "leblanc/tools.py": 1},
    }
    assert found.imports == {
        ("solvers", "meshes"): 1,
        ("solvers/rotor", "meshes"): 1,
        ("solvers/rotor", "solvers"): 1,
        ("leblanc/cli", "leblanc"): 1,
        ("leblanc/cli", "solvers/rotor"): 1,
        ("leblanc/api.py", "leblanc/cli"): 1,
        ("leblanc/tools.py", "leblanc/api.py"): 1,
    }
    assert rooms.circles(found.imports) == []


def test_circles_are_found_whole() -> None:
    ring = {("a", "b"): 1, ("b", "c"): 1, ("c", "a"): 1, ("d", "a"): 1, ("e", "f"): 2, ("f", "e"): 1}
    assert rooms.circles(ring) == [["a", "b", "c"], ["e", "f"]]
    # In the circle of two the heavier import goes with the order.
    assert rooms.order("ef", ring) == ["e", "f"]


def nested(seed: int, circle: bool) -> rooms.Rooms:
    """Some forty rooms in five packages, imports from earlier names to later ones, and back if asked for."""
    draw = random.Random(seed)
    packages = ["walls", "pipes", "beams", "mmmm", "a"]
    names = [
        f"{name}/{'mw' * draw.randint(1, 6)}{k}" for name in packages for k in range(draw.randint(0, 14))
    ]
    names = [*packages, *names]
    names.sort(key=lambda name: packages.index(name.partition("/")[0]))
    pairs = [(a, b) for k, a in enumerate(names) for b in names[k + 1 :] if draw.random() < 0.15]
    back = [(names[-1], names[0]), (names[2], names[1])] if circle else []
    return rooms.Rooms(
        {name: draw.randint(1, 30) for name in names},
        {pair: draw.randint(1, 200) for pair in [*pairs, *back]},
    )


@pytest.mark.parametrize("circle", [False, True])
@pytest.mark.parametrize("seed", range(3))
def test_imports_lead_down_and_nothing_overlaps(seed: int, circle: bool) -> None:
    graph = nested(seed, circle)
    placed = rooms.plan(graph)
    level = {node: k for k, row in enumerate(placed.rows) for node in row}
    assert sorted(node for node in level if isinstance(node, str)) == sorted(graph.sizes)
    against = {pair for pair in graph.imports if level[pair[0]] >= level[pair[1]]}
    assert set(placed.against) == against and bool(against) == circle
    assert all(len({node for node in row if isinstance(node, str)}) <= rooms.MOST for row in placed.rows)
    for row, package in zip(placed.rows, placed.packages, strict=True):
        assert {node.partition("/")[0] for node in row if isinstance(node, str)} == {package}
        edges = [rooms.LEFT]
        for node in row:
            half = 0.5 * rooms.breadth_of(node)
            edges += [placed.places[node] - half, placed.places[node] + half]
        edges.append(placed.width - rooms.RIGHT)
        assert all(a <= b + 1e-6 for a, b in pairwise(edges))


def test_the_picture_is_the_same_each_time(tmp_path: Path) -> None:
    first, again = (rooms.draw_rooms(nested(1, True), tmp_path / name) for name in ("first.png", "again.svg"))
    assert [path.suffix for path in first] == [".png", ".svg"]
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


@pytest.mark.parametrize("seed", range(3))
def test_words_do_not_touch_and_stand_in_their_boxes(seed: int) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.patches import FancyBboxPatch

    graph = nested(seed, True)
    drawn = rooms.figure(graph)
    renderer = FigureCanvasAgg(drawn).get_renderer()
    (axes,) = drawn.axes
    words = [text.get_window_extent(renderer) for text in axes.texts]
    boxes = [box.get_window_extent(renderer) for box in axes.patches if isinstance(box, FancyBboxPatch)]
    packages = {name.partition("/")[0] for name in graph.sizes}
    assert len(boxes) == len(graph.sizes)
    assert not [(a, b) for k, a in enumerate(words) for b in words[k + 1 :] if a.overlaps(b)]
    within = [
        word
        for word in words
        if any(b.x0 <= word.x0 and word.x1 <= b.x1 and b.y0 <= word.y0 and word.y1 <= b.y1 for b in boxes)
    ]
    # A room has its name and its number in its box.
    assert len(within) == 2 * len(graph.sizes) and len(words) == len(within) + 2 * len(packages) + 5


def test_a_traced_command_enters_its_own_module_and_draws_nothing() -> None:
    entered, with_definitions, imported = flows.trace(["explain", "examples/horizontal_rig.toml"], ROOT)
    front = "leblanc" if (ROOT / "leblanc").is_dir() else "study"
    assert {f"{front}.cli", f"{front}.cli.explain"} <= set(entered) <= set(with_definitions) <= set(imported)
    assert any(name.startswith("solvers.") for name in entered) and set(imported) - set(with_definitions)
    assert not [name for name in imported if name.startswith(f"{front}.figures")]
