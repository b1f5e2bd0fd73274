"""Rotor and liquid taken through the speeds in time: run-up, run-down, spin programme."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import SCENE, Option, Reader, ask

if TYPE_CHECKING:
    from leblanc.studies.runup.answer import RunupAnswer

FILES = ("runup.html", "runup.nc")
_FILM = Reader("leblanc.plotting.page:film_path")


def runup(
    scene: Annotated[Any, SCENE, "The machine, or the path of its file."],
    *,
    cells: Annotated[int | None, "Cells round each wall [default: the scene's]."] = None,
    samples: Annotated[int | None, "How many times are recorded [default: the scene's]."] = None,
    check: Annotated[bool, "Do not run again with half the cells to estimate the error."] = True,
    frames: Annotated[int | None, Option(film=180), "How many times the layers are kept for a film."] = None,
    ensemble: Annotated[int, "Repeat it so often with the unbalance changed in its last digits."] = 0,
    seed: Annotated[int, "Random seed of those changes."] = 0,
    workers: Annotated[int, Option(same=True), "Processes that repeat it [default: one a core]."] = 1,
    progress: Callable[[float, float], None] | None = None,
) -> RunupAnswer:
    """Through the resonance in time, up and down. Figures, data file, energy balance, report.

    As the scene's table [runup] or [programme] says. Without `check` the error is not estimated; the layers
    are not kept where `frames` is None. `progress` is called with what is done and the total.

    Raises
    ------
    SceneError : with everything that is wrong with the file
    InputError : no table [runup] or [programme], a value out of its range

    Examples
    --------
    >>> import leblanc as lb
    >>> short = lb.example("runup").replace({"runup.duration": "1 s", "runup.cells": 16})
    >>> bool(lb.run_up(short, samples=50, check=False).amplitude.max() > 0.0)
    True
    """
    return ask(runup, "leblanc.studies.runup.study:runup_scene", locals())


def present(
    answer: Any,
    *,
    animate: Annotated[
        Any, _FILM, "Film of chambers and amplitude: .gif, .mp4, or .html, a page that plays."
    ] = None,
) -> RunupAnswer:
    """What the command alone is asked for: a film of the layers that the run kept."""
    with_film: RunupAnswer = replace(answer, film=animate)
    return with_film


run_up = runup
