"""Imports run one way, and the front door opens fast."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
PACKAGES = ("meshes", "fluid", "solvers", "leblanc", "validation")
HEAVY = (
    "numpy", "scipy", "pydantic", "pint", "matplotlib", "xarray", "skfem", "meshio", "pde", "pyvista",
    "numba", "rich", "jinja2", "sympy", "ross",
)  # fmt: skip


def test_import_contracts() -> None:
    cli = pytest.importorskip("importlinter.cli")
    assert cli.lint_imports(config_filename=str(ROOT / "pyproject.toml"), is_debug_mode=False) == 0


def _loaded(code: str) -> set[str]:
    script = f"import sys\n{code}\nprint(' '.join(sorted(sys.modules)), file=sys.stderr)"
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, cwd=ROOT, check=True
    )
    return {name.partition(".")[0] for name in done.stderr.split()}


def test_help_loads_nothing_heavy() -> None:
    loaded = _loaded("from leblanc.cli import main\nassert main(['--help']) == 0")
    assert not loaded & set(HEAVY)


def test_the_main_job_loads_no_mesh() -> None:
    loaded = _loaded(
        "from leblanc.scene.scene import load_scene\nfrom leblanc.studies.run.study import run_scene\n"
        "run_scene(load_scene('examples/horizontal_rig.toml'))"
    )
    assert not loaded & {"pde", "skfem", "meshio", "pyvista", "matplotlib", "sympy"}


def test_one_family_of_waves_compiles_nothing() -> None:
    loaded = _loaded(
        "from leblanc.cli import main\n"
        "whirl = '--whirl-speed 30.6 --whirl-amplitude 0.05mm --friction linear:1'.split()\n"
        "layer = '--radius 0.15 --volume 1.3e-4 --height 0.01 --speed 40'.split()\n"
        "assert main(['layer', *layer, *whirl, '--model', 'kdv', '--json']) == 0"
    )
    assert "pde" in loaded and not loaded & {"numba", "llvmlite"}


def _public(body: list[ast.stmt]) -> list[ast.FunctionDef | ast.ClassDef]:
    """Public functions and classes of a module and their public methods, not what is nested in functions."""
    found: list[ast.FunctionDef | ast.ClassDef] = []
    for node in body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            found.append(node)
            found += _public(node.body) if isinstance(node, ast.ClassDef) else []
    return found


def test_no_folder_is_a_corridor() -> None:
    """About a dozen modules a folder."""
    wide = {}
    for name in PACKAGES:
        for folder in {path.parent for path in (ROOT / name).rglob("*.py")}:
            count = sum(path.name != "__init__.py" for path in folder.glob("*.py"))
            if count > 14:
                wide[str(folder.relative_to(ROOT))] = count
    assert not wide


def test_types_of_arrays_are_named_in_one_place() -> None:
    """What meshes/arrays.py names has no second name."""

    def named(path: Path) -> dict[str, str]:
        """Names that a module gives to types of arrays, by their definition."""
        found = {}
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            target = node.targets[0] if isinstance(node, ast.Assign) else getattr(node, "target", None)
            value = getattr(node, "value", None)
            if isinstance(target, ast.Name) and isinstance(value, ast.Subscript):
                found[ast.unparse(value).removeprefix("npt.")] = target.id
        return found

    arrays = ROOT / "meshes" / "arrays.py"
    assert "NDArray[np.float64]" in named(arrays)
    twice = [
        f"{path.relative_to(ROOT)}: {name}"
        for path in _sources()
        if path != arrays
        for definition, name in named(path).items()
        if definition in named(arrays)
    ]
    assert not twice


def _says(function: ast.FunctionDef) -> bool:
    """What a function returns is declared in its type."""
    return function.returns is not None and "Q(" in ast.unparse(function.returns)


def test_every_public_function_is_documented() -> None:
    """What an answer declares is described by its declaration."""
    bare = []
    for path in _sources():
        tree = ast.parse(path.read_text(encoding="utf-8"))
        told = path.name == "answer.py" and bool({"studies", "wings"} & set(path.parts))
        every = _public(tree.body)
        public = [n for n in every if not (isinstance(n, ast.FunctionDef) and (told or _says(n)))]
        bare += [f"{path.name}:{n.name}" for n in public if not ast.get_docstring(n)]
    assert not bare


def _sources() -> list[Path]:
    return [p for name in PACKAGES for p in (ROOT / name).rglob("*.py")]


def test_citations_lead_somewhere() -> None:
    chapters = "".join(p.read_text(encoding="utf-8") for p in sorted((ROOT / "docs" / "theory").glob("*.md")))
    parts = [part.partition("\n") for part in re.split(r"^## ", chapters, flags=re.MULTILINE)[1:]]
    pages = {title.lower().replace(" ", "_"): text for title, _, text in parts}
    assert len(pages) == len(parts)
    keys = set(re.findall(r"@\w+\{(\w+),", (ROOT / "references.bib").read_text(encoding="utf-8")))
    lost = []
    for path in _sources():
        text = " ".join(path.read_text(encoding="utf-8").split())
        for page, rest in re.findall(r"\[theory: (\w+)([^\]]*)\]", text):
            numbers = [int(n) for n in re.findall(r"\d+", rest)]
            known = pages.get(page)
            if known is None or any(f"tag{{{n}}}" not in known for n in numbers):
                lost.append(f"{path.name}: theory: {page}{rest}")
        lost += [
            f"{path.name}: {key}" for key in re.findall(r"\[([A-Z]{2,}\d{2})[,\]]", text) if key not in keys
        ]
    assert not lost
