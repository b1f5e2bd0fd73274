"""Liquid models by the names that scenes and commands give them; here alone a name becomes an object.

A room of solvers is imported where one of its models is made: the response needs no waves, no run-up. A model
of one's own is known by its name while a question is asked with it, or for good where an installed package
announces it under `leblanc.liquids`, as "module:object" of a model or of a class that makes one.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import replace
from typing import TYPE_CHECKING

from fluid.friction.laws import NO_FRICTION, Friction, FrictionLaw
from leblanc.registry import LIQUIDS, announced
from leblanc.scene.scene import LIQUID_MODELS, Scene
from leblanc.scene.schema.load import meant
from meshes.errors import InputError
from solvers.checked_model import CheckedModel
from solvers.liquid_model import LiquidModel, WaveModel
from solvers.synchronous.models import LINEAR, STATICS

if TYPE_CHECKING:
    from solvers.runup.machine import RunupModel

_Make = Callable[[Friction, int | None, bool, str | None], WaveModel]
_SEGMENTS = 48  # edges along the wall of the elements under a paraboloid
_POINTS = 256  # round the wall, unless another number is asked for


def _linear(friction: Friction, cells: int | None, dispersion: bool, solver: str | None) -> WaveModel:
    _require_none(friction, "the linear theory, which is inviscid")
    return LINEAR


def _long_wave(friction: Friction, cells: int | None, dispersion: bool, solver: str | None) -> WaveModel:
    from solvers.layer.state import Numerics
    from solvers.pypde.models import LongWave

    numerics = Numerics(_POINTS if cells is None else cells, dispersion)
    return LongWave(friction, numerics) if solver is None else LongWave(friction, numerics, solver)


def _kdv(friction: Friction, cells: int | None, dispersion: bool, solver: str | None) -> WaveModel:
    from solvers.pypde.models import OneFamily

    family = OneFamily(friction, _POINTS if cells is None else cells, dispersion)
    return family if solver is None else replace(family, solver=solver)


def _fem(friction: Friction, cells: int | None, dispersion: bool, solver: str | None) -> WaveModel:
    from solvers.sloshing.model import SmallWaves

    _require_none(friction, "finite elements, which are inviscid")
    return SmallWaves() if cells is None else SmallWaves(cells)


def _potential(friction: Friction, cells: int | None, dispersion: bool, solver: str | None) -> WaveModel:
    from solvers.potential.model import Potential

    _require_none(friction, "the fully nonlinear wave, which is inviscid")
    return Potential() if cells is None else Potential(cells)


def _require_none(friction: Friction, theory: str) -> None:
    """Refuse friction that a theory does not know."""
    if friction.law is not FrictionLaw.NONE:
        raise InputError("friction", friction.law, f"none for {theory}")


_MAKE: Mapping[str, _Make] = {
    "statics": lambda *_: STATICS,
    "linear": _linear,
    "long_wave": _long_wave,
    "kdv": _kdv,
    "fem": _fem,
    "potential": _potential,
}
WAVE_MODELS = tuple(_MAKE)
# Those that py-pde solves, and that know friction.
MARCHED = ("long_wave", "kdv")
# Those that answer the unbalance of a rotor: the liquid is at rest in a synchronous whirl.
SYNCHRONOUS_MODELS = ("statics", "linear", "fem", "kdv")
# Those that go through time with a rotor.
RUNUP_MODELS = ("long_wave", "linear")


def wave_model(
    name: str,
    friction: Friction = NO_FRICTION,
    cells: int | None = None,
    dispersion: bool = False,
    solver: str | None = None,
) -> WaveModel:
    """The liquid model that `layer` names, for a prescribed whirl; statics feel no friction.

    `cells` round the wall, points of unidirectional waves, or most steps from crest to trough of the
    fully nonlinear wave.
    """
    if name not in _MAKE:
        raise InputError("model", name, "one of " + ", ".join(_MAKE))
    if solver is not None and name not in MARCHED:
        raise InputError("solver", solver, f"left out for {name}; " + " and ".join(MARCHED) + " have one")
    return _MAKE[name](friction, cells, dispersion, solver)


def synchronous_model(name: str) -> LiquidModel:
    """The liquid model that a scene names; `auto` is the cheapest that is exact for synchronous whirl."""
    if name not in LIQUID_MODELS:
        return own_model(name)
    if name not in ("auto", *SYNCHRONOUS_MODELS):
        raise InputError("model.liquid", name, "one of auto, " + ", ".join(SYNCHRONOUS_MODELS))
    return wave_model("statics" if name == "auto" else name)


def element_model() -> LiquidModel:
    """The paraboloid in a plain chamber by finite elements: equal to the exact one to its mesh, some 1e-7."""
    from solvers.synchronous.models import ElementsAtRest

    return ElementsAtRest(_SEGMENTS, order=2)


def runup_model(name: str) -> RunupModel:
    """The liquid model of a run-up."""
    from solvers.runup.linear import couple_linear
    from solvers.runup.long_wave import couple

    if name not in RUNUP_MODELS:
        raise InputError("model.liquid", name, " or ".join(RUNUP_MODELS) + " for a run-up")
    return couple if name == "long_wave" else couple_linear


_GIVEN: ContextVar[tuple[CheckedModel, ...]] = ContextVar("given", default=())


def own_model(name: str) -> CheckedModel:
    """A model of one's own by its name: the one that is asked with, or an announced one."""
    for model in _GIVEN.get():
        if model.name == name:
            return model
    others = announced(LIQUIDS, LIQUID_MODELS)
    entry = others.get(name)
    if entry is None:
        known = (*LIQUID_MODELS, *others)
        raise InputError("model.liquid", name, f"one of {', '.join(known)}{meant(name, known)}")
    try:
        found = entry.load()
        return CheckedModel(found() if isinstance(found, type) else found, name)
    except Exception as error:
        said = f"one that is installed; {entry.value} cannot be loaded: {str(error) or type(error).__name__}"
        raise InputError("model.liquid", name, said) from error


@contextmanager
def asked_with(scene: Scene, model: object | None) -> Iterator[Scene]:
    """The scene with its liquid as a model of one's own has it, which is known within the block.

    An `InputError` where it is no such model, or has the name of a built-in one.
    """
    if model is None:
        yield scene
        return
    if isinstance(model, str):
        yield scene.replace({"model.liquid": model})
        return
    own = CheckedModel(model)
    if own.name in LIQUID_MODELS:
        raise InputError("model.name", own.name, "a name of its own, none of " + ", ".join(LIQUID_MODELS))
    if not scene.liquids:
        raise InputError("model", own.name, "left out where no chamber holds liquid")
    token = _GIVEN.set((own, *_GIVEN.get()))
    try:
        yield scene.altered(model=scene.model.altered(liquid=own.name))
    finally:
        _GIVEN.reset(token)
