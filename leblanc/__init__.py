"""Passive liquid balancers and rotors partly filled with liquid: describe the machine, get its vibration.

`import leblanc as lb` gives everything that a user needs; each name is loaded when it is first used.
"""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from leblanc.moved import Finder

if TYPE_CHECKING:
    from fluid.fill import Fill
    from fluid.friction.laws import Friction
    from fluid.liquid import Liquid
    from leblanc.core.disk import opened as open
    from leblanc.scene.examples import example
    from leblanc.scene.magnetic import MagneticRotor
    from leblanc.scene.rotors import Exciter, JeffcottRotor, TubRotor, TwoPlaneRotor
    from leblanc.scene.scene import Scene, load_scene
    from leblanc.scene.schema.load import SceneError
    from leblanc.scene.spindle import Spindle
    from leblanc.studies.bearing import bearing
    from leblanc.studies.compare import compare
    from leblanc.studies.explain import explain
    from leblanc.studies.export import export
    from leblanc.studies.fit import fit
    from leblanc.studies.layer import layer
    from leblanc.studies.map import map_balls, map_whirl
    from leblanc.studies.modes import modes
    from leblanc.studies.optimise import optimise
    from leblanc.studies.outputs import outputs
    from leblanc.studies.run import run
    from leblanc.studies.runup import run_up
    from leblanc.studies.runup import runup as runup  # another name of it
    from leblanc.studies.sweep import sweep
    from leblanc.studies.validate import validate
    from leblanc.studies.volume import volume
    from meshes.chamber import Chamber
    from meshes.errors import InputError
    from solvers.liquid_model import LiquidAnswer, LiquidModel

__all__ = [
    "Chamber",
    "Exciter",
    "Fill",
    "Friction",
    "InputError",
    "JeffcottRotor",
    "Liquid",
    "LiquidAnswer",
    "LiquidModel",
    "MagneticRotor",
    "Scene",
    "SceneError",
    "Spindle",
    "TubRotor",
    "TwoPlaneRotor",
    "bearing",
    "compare",
    "example",
    "explain",
    "export",
    "fit",
    "layer",
    "load_scene",
    "map_balls",
    "map_whirl",
    "modes",
    "open",
    "optimise",
    "outputs",
    "run",
    "run_up",
    "sweep",
    "validate",
    "volume",
]

sys.meta_path.append(Finder)

# Each in a module of its name.
_QUESTIONS = (
    *("bearing", "compare", "explain", "export", "fit", "layer", "modes", "optimise", "outputs", "run"),
    *("runup", "sweep", "validate", "volume"),
)
# Where each public name lives: its module, and its name there.
_HOMES = {
    "Chamber": ("meshes.chamber", "Chamber"),
    "Exciter": ("leblanc.scene.rotors", "Exciter"),
    "Fill": ("fluid.fill", "Fill"),
    "Friction": ("fluid.friction.laws", "Friction"),
    "InputError": ("meshes.errors", "InputError"),
    "JeffcottRotor": ("leblanc.scene.rotors", "JeffcottRotor"),
    "Liquid": ("fluid.liquid", "Liquid"),
    "LiquidAnswer": ("solvers.liquid_model", "LiquidAnswer"),
    "LiquidModel": ("solvers.liquid_model", "LiquidModel"),
    "MagneticRotor": ("leblanc.scene.magnetic", "MagneticRotor"),
    "Scene": ("leblanc.scene.scene", "Scene"),
    "SceneError": ("leblanc.scene.schema.load", "SceneError"),
    "Spindle": ("leblanc.scene.spindle", "Spindle"),
    "TubRotor": ("leblanc.scene.rotors", "TubRotor"),
    "TwoPlaneRotor": ("leblanc.scene.rotors", "TwoPlaneRotor"),
    **{name: (f"leblanc.studies.{name}", name) for name in _QUESTIONS},
    "run_up": ("leblanc.studies.runup", "runup"),
    "example": ("leblanc.scene.examples", "example"),
    "open": ("leblanc.core.disk", "opened"),
    "load_scene": ("leblanc.scene.scene", "load_scene"),
    "map_balls": ("leblanc.studies.map", "map_balls"),
    "map_whirl": ("leblanc.studies.map", "map_whirl"),
}


def __getattr__(name: str) -> object:
    """Load a public name at its first use."""
    from importlib import import_module

    if name == "__version__":
        from leblanc.core.answer import versions

        return versions()["leblanc"]
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, attribute = _HOMES[name]
    found = globals()[name] = getattr(import_module(module), attribute)
    if module.startswith("leblanc.studies."):
        from leblanc.core.question import readable

        readable(found)
    return found


def __dir__() -> list[str]:
    """The public names, loaded or not."""
    return sorted(__all__)
