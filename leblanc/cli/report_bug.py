"""`leblanc report-bug`: what whoever mends a fault needs to know, to be pasted into a report."""

from __future__ import annotations

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.terminal.output import load

if TYPE_CHECKING:
    from leblanc.scene.scene import Scene

# Libraries on which answers depend.
LIBRARIES = ("numpy", "scipy", "numba", "py-pde", "scikit-fem", "meshio", "pyvista", "pydantic", "pint")


def versions() -> dict[str, str]:
    """Versions of this package and of the libraries on which answers depend."""
    found = {}
    for name in ("leblanc", *LIBRARIES):
        try:
            found[name] = version(name)
        except PackageNotFoundError:
            found[name] = "not installed"
    return found


def report_bug(
    scene: Annotated[Path | None, typer.Argument(help="Scene file (TOML) with which it happens.")] = None,
) -> None:
    """Print versions, computer and the machine without its names, for a report of a fault."""
    print("### What happened\n\nThe command, what it printed, and what you expected:\n")
    print("### Versions\n")
    for name, number in versions().items():
        print(f"* {name} {number}")
    print(f"* Python {platform.python_version()}, {platform.platform()}, {os.cpu_count()} cores")
    if scene is not None:
        print(f"\n### Machine\n\n```toml\n{_without_names(load(scene)).to_toml().rstrip()}\n```")


def _without_names(machine: Scene) -> Scene:
    """The same machine without what tells whose it is: names, sources, folders of files."""
    changes: dict[str, object] = {"name": "Machine", "source": ""}
    changes |= {f"points.{k}.name": f"point {k + 1}" for k in range(len(machine.points))}
    table = machine.table()
    for k, chamber in enumerate(table.get("chambers", ())):
        if isinstance(chamber.get("liquid"), dict) and "name" in chamber["liquid"]:
            changes[f"chambers.{k}.liquid.name"] = f"liquid {k + 1}"
    return machine.replace(changes)
