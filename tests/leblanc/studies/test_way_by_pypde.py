"""The waves of commands go by py-pde: its controller is watched, and without it there is no answer."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from pde.solvers.controller import Controller

from fluid.friction.laws import Friction
from leblanc.liquid.models import wave_model
from leblanc.scene.examples import example
from leblanc.scene.scene import Scene
from leblanc.studies.layer.study import answer_layer
from leblanc.studies.run.study import run_scene
from solvers.pypde import family_law
from tests.leblanc.studies.test_compare import by

PAGES = [Path(__file__).parents[3] / "docs" / name for name in ("project.md", "models/time_domain.md")]
Seen = list[tuple[str, str, list[str]]]


def held() -> Scene:
    """Two speeds with waves integrated in time on few cells; friction lets them settle within some turns."""
    change = {"speeds.start": 60.0, "speeds.count": 2, "model.cells": 16, "model.friction": {"linear": 5.0}}
    return by(example("vertical_rig").replace(change), "long_wave")


def family() -> Scene:
    return by(example("runup").replace({"speeds.count": 3}), "kdv")


def wave(name: str) -> None:
    fill = example("runup").fills[0]
    answer_layer(fill, 40.0, 32.0, 1e-5, wave_model(name, Friction("linear", 5.0), cells=16))


# What is asked; the equation, its solvers and a tracker; the section of the page that names them.
WAYS: dict[str, tuple[Callable[[], object], str, str, str, str]] = {
    "a held state": (
        lambda: run_scene(held()),
        "RotorLayersPDE", "PeriodicNewtonSolver CoupledSolver", "TurnTracker", "a held state",
    ),
    "one family in run": (
        lambda: run_scene(family()), "KdvBurgersPDE", "SteadyNewtonSolver", "", "a held state",
    ),
    "long waves of layer": (
        lambda: wave("long_wave"),
        "AnnularLongWavePDE", "FiniteVolumeSolver", "StretchMeans", "`leblanc layer`",
    ),
    "one family of layer": (
        lambda: wave("kdv"), "KdvBurgersPDE", "SteadyNewtonSolver", "", "`leblanc layer`",
    ),
}  # fmt: skip


@pytest.fixture(params=WAYS)
def way(request: pytest.FixtureRequest) -> tuple[Callable[[], object], str, str, str, str]:
    # Laws that other tests have solved would be taken from memory.
    family_law.family_law.cache_clear()
    return WAYS[request.param]


def test_the_controller_of_py_pde_drives_our_solvers(way: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    ask, equation, solvers, tracker, _ = way
    seen: Seen = []
    own = Controller.run

    def watched(self: Controller, *args: Any, **options: Any) -> Any:
        trackers = [type(one).__name__ for one in self.trackers.trackers]
        seen.append((type(self.solver.pde).__name__, type(self.solver).__name__, trackers))
        return own(self, *args, **options)

    monkeypatch.setattr(Controller, "run", watched)
    ask()
    assert seen and {(pde, by) for pde, by, _ in seen} == {(equation, solver) for solver in solvers.split()}
    assert not tracker or any(tracker in trackers for _, _, trackers in seen)


def test_without_the_controller_there_is_no_answer(way: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """No compiled step and no Newton goes past it."""

    def gone(*_: Any, **__: Any) -> Any:
        raise LookupError("py-pde is gone")

    monkeypatch.setattr(Controller, "run", gone)
    with pytest.raises(LookupError, match="py-pde is gone"):
        way[0]()


def test_the_page_names_the_classes_on_the_way(way: Any) -> None:
    _, equation, solvers, tracker, title = way
    pages = "\n".join(page.read_text(encoding="utf-8") for page in PAGES)
    heads = (f"The way of {title}", f"How {title} is solved")
    (text,) = [part for part in re.split(r"^## ", pages, flags=re.M) if part.startswith(heads)]
    names = {"SteadyNewtonSolver": "steady_newton"}
    for name in (equation, *(names.get(solver, solver) for solver in solvers.split()), tracker):
        assert name in text
