"""Answers of many scenes that differ in a few values: a grid or a sample, resumable, here or on a cluster."""

from __future__ import annotations

from collections.abc import Callable
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import STUDY, VARY, Option, ask, called

if TYPE_CHECKING:
    from leblanc.studies.sweep.answer import SweepAnswer

FILES = ("sweep.html", "sweep.nc", "samples.csv", "curves.csv", "sweep.xlsx")


def sweep(
    study: Annotated[Any, STUDY, Option(argument=True), "Study file, or machine file with --vary (TOML)."],
    out: str | PathLike[str] | None = None,
    *,
    vary: Annotated[
        Any,
        VARY,
        "Values of a number of the machine: PATH=LOW..HIGH:COUNT, as chambers.0.volume='0.1 l..1.9 l:20', or "
        "PATH=A,B,C; several make a grid.",
    ] = None,
    workers: Annotated[int | None, "Local processes, 0 for none but this [default: the cores]."] = None,
    scheduler: Annotated[str | None, "Address of a Dask scheduler, in place of local processes."] = None,
    fresh: Annotated[bool, Option(("--fresh",)), "Start anew, without what is in the store."] = False,
    progress: Callable[[float, float], None] | None = None,
) -> SweepAnswer:
    """Answers for many values of one number, or of several. The same call continues after a stop.

    The store is made in the folder `out`, out/<name of the study or machine> if None. `vary` has texts as
    typed, or lists of values, by their paths; with a study its method must be a grid.

    Raises
    ------
    SceneError : with everything that is wrong with the files
    InputError : a machine without `vary`, a store of another study, a scheduler that does not answer

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.sweep("study.toml", workers=0)  # doctest: +SKIP
    >>> fills = {"chambers.0.volume": "0.1 l..1.9 l:20"}
    >>> found = lb.sweep(lb.example("tub"), vary=fills, workers=0)  # doctest: +SKIP
    """
    return ask(sweep, "leblanc.studies.sweep.study:answer_sweep", locals())


def present(
    answer: Any,
    *,
    netcdf: Annotated[bool, Option(("--netcdf",)), "Write a netCDF copy of the store."] = False,
    emulate: Annotated[
        bool, Option(("--emulate",)), "Fit emulators to the outputs, with their errors on unseen samples."
    ] = False,
    to: Annotated[str | None, "csv or xlsx: tables of samples and of their curves as well."] = None,
    decimal: Annotated[str, "point, or comma with semicolons between the columns (csv)."] = "point",
) -> SweepAnswer:
    """What the command alone is asked for: a copy of the store, emulators, tables."""
    shown: SweepAnswer = called("leblanc.studies.sweep.study:present")(answer, netcdf, emulate, to, decimal)
    return shown
