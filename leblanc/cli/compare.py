"""`leblanc compare`: the same scene by several liquid models, side by side."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from leblanc.cli.terminal.output import load, processes
from leblanc.core.contents import results_dir
from leblanc.core.progress import working
from leblanc.core.terminal import print_json, print_table, say


def compare(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    models: Annotated[
        str, typer.Option(help="Liquid models, commas between them; the last that answers is the reference.")
    ],
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    workers: Annotated[
        int | None, typer.Option(help="Processes that hold waves in time [default: all cores].")
    ] = None,
    fresh: Annotated[
        bool, typer.Option(help="Hold anew what an earlier run has left, so that all its time counts.")
    ] = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """The same scene by several liquid models. Table, figure, cost."""
    from leblanc.studies.compare import compare_models
    from leblanc.studies.held.holding import Holding

    machine = load(scene)
    folder = results_dir(machine.name, out, scene, machine.digest, "compare.nc")
    with working("response by several models"):
        names = [name.strip() for name in models.split(",")]
        found = compare_models(machine, names, Holding(processes(workers), folder, fresh))

    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.comparison import comparison_figure, save
    from leblanc.studies.run.words import unanswered
    from leblanc.text.explanation import basis, comparison_head, comparison_rows, refusals

    write_netcdf(found.named_arrays(), folder / "compare.nc")
    files = save(comparison_figure(found), folder, "compare", "Amplitude over speed by liquid model")
    if json:
        print_json(found.to_json())
    else:
        print_table(comparison_rows(found), comparison_head(found), right=True)
        print("\n".join([basis(found), *refusals(found)]))
        print(f"See {files.png}; the data are in {folder / 'compare.nc'}")

    lost = [f"{name}: {text}" for name, result in found.results.items() for text in unanswered(result)]
    if lost:
        from leblanc.core.answer import NotConverged

        raise NotConverged([f"{scene}: {text}" for text in lost])
    say(f"{found.name}: {len(found.results)} of {len(found.models)} models answered")
