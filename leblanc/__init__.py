"""Passive liquid balancers and rotors partly filled with liquid: describe the machine, get its vibration.

`import leblanc as lb` gives everything a user needs; the names are loaded when they are first used.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fluid.fill import Fill as Fill
    from fluid.liquid import Liquid as Liquid
    from leblanc.scene.scene import Scene as Scene
    from leblanc.scene.scene import load_scene as load_scene
    from leblanc.scene.schema.faults import SceneFaults as SceneError
    from meshes.chamber import Chamber as Chamber
    from meshes.errors import InputError as InputError

# Where each public name lives: module, and its name there.
_HOMES = {
    "load_scene": ("leblanc.scene.scene", "load_scene"),
    "Scene": ("leblanc.scene.scene", "Scene"),
    "Chamber": ("meshes.chamber", "Chamber"),
    "Fill": ("fluid.fill", "Fill"),
    "Liquid": ("fluid.liquid", "Liquid"),
    "InputError": ("meshes.errors", "InputError"),
    "SceneError": ("leblanc.scene.schema.faults", "SceneFaults"),
}

__all__ = ["Chamber", "Fill", "InputError", "Liquid", "Scene", "SceneError", "load_scene"]


def __getattr__(name: str) -> Any:
    """Load a public name at its first use."""
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _HOMES[name]
    found = getattr(import_module(module), attribute)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    """The public names, loaded or not."""
    return sorted({*globals(), *_HOMES})
