"""The measures of the house on trees made up for it: counts, layers, the picture of the rooms."""

from __future__ import annotations

import sys
from pathlib import Path

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


def test_what_a_front_hands_on_joins_no_folders(tmp_path: Path) -> None:
    # What imports a folder beside it stands above it, and so does what imports that; the others lie below.
    found = house.between(tree(tmp_path))
    assert found == {
        ("solvers", "meshes"): 1,
        ("solvers/rotor", "meshes"): 1,
        ("solvers/rotor", "solvers"): 1,
        ("leblanc/cli", "leblanc"): 1,
        ("leblanc/cli", "solvers/rotor"): 1,
        ("leblanc/api.py", "leblanc/cli"): 1,
        ("leblanc/tools.py", "leblanc/api.py"): 1,
    }
    assert rooms.circles(found) == []


def test_circles_are_found_whole() -> None:
    ring = {("a", "b"): 1, ("b", "c"): 1, ("c", "a"): 1, ("d", "a"): 1, ("e", "f"): 2, ("f", "e"): 1}
    assert rooms.circles(ring) == [["a", "b", "c"], ["e", "f"]]


def test_imports_lead_down_in_the_picture() -> None:
    # A package's own names are loaded when they are first used.
    inside = [module for module in house.read(ROOT) if "." in module.name]
    pairs = [(one.name, other) for one in inside for other in one.imports if "." in other]
    against = [pair for pair in pairs if rooms.part_of(pair[1])[0] < rooms.part_of(pair[0])[0]]
    assert against == []
    assert sum(len(parts) for _, parts in rooms.FLOORS) <= 20


def test_words_stand_in_their_boxes_and_the_picture_is_the_same_each_time(tmp_path: Path) -> None:
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    names = [module.name for module in house.read(ROOT)]
    drawn = rooms.figure(names)
    renderer = FigureCanvasAgg(drawn).get_renderer()
    (axes,) = drawn.axes
    boxes = [box.get_window_extent(renderer) for box in axes.patches if hasattr(box, "get_boxstyle")]
    words = [text.get_window_extent(renderer) for text in axes.texts if text.get_ha() == "center"]
    words = [word for word in words if word.width > 0]
    for word in words:
        assert any(b.x0 <= word.x0 and word.x1 <= b.x1 and b.y0 <= word.y0 and word.y1 <= b.y1 for b in boxes)
    assert len(words) == sum(len(parts) for _, parts in rooms.FLOORS)
    first, again = (rooms.draw_rooms(names, tmp_path / name) for name in ("first.png", "again.svg"))
    assert [path.read_bytes() for path in first] == [path.read_bytes() for path in again]


def test_a_traced_command_enters_its_own_module_and_draws_nothing() -> None:
    entered, with_definitions, imported = flows.trace(["explain", "examples/horizontal_rig.toml"], ROOT)
    front = "leblanc" if (ROOT / "leblanc").is_dir() else "study"
    assert (
        {f"{front}.cli", f"{front}.studies.explain.study"}
        <= set(entered)
        <= set(with_definitions)
        <= set(imported)
    )
    assert any(name.startswith("solvers.") for name in entered) and set(imported) - set(with_definitions)
    assert not [name for name in imported if name.startswith(f"{front}.figures")]
