"""`leblanc trade`: accuracy against cost of every model and resolution on a scene."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated

import typer

from leblanc.core.contents import results_dir
from leblanc.core.files import writing
from leblanc.core.terminal import print_json, say


def trade(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    quick: Annotated[bool, typer.Option("--quick", help="Short ladders of resolutions.")] = False,
    layer: Annotated[
        bool | None,
        typer.Option(
            "--layer/--no-layer",
            help="One layer alone by each solver of py-pde [default: where the scene asks for its waves].",
        ),
    ] = None,
    repeats: Annotated[int, typer.Option(min=2, help="How often short runs are timed.")] = 5,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    png: Annotated[bool, typer.Option("--png", help="Write the figure as PNG as well.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Accuracy against cost of every model and resolution. The best choices among them, a figure."""
    from leblanc.cli.terminal.output import load

    machine = load(scene)
    folder = results_dir(machine.name, out, scene, machine.digest, "trade.json")

    from rich.progress import Progress

    from validation.trade.cases import names_waves
    from validation.trade.trade import trade_scene

    with Progress(transient=True, disable=not sys.stderr.isatty()) as bar:
        task = bar.add_task("measuring", total=1.0)
        record = trade_scene(
            *(machine, quick, repeats),
            progress=lambda what, done: bar.update(task, description=what, completed=done),
            layer=layer,
        )

    from leblanc.plotting.page import save
    from validation.trade.figure import trade_figure
    from validation.trade.results import trade_json, trade_lines

    found = trade_json(record)
    with writing(folder / "trade.json") as path:
        from json import dumps

        path.write_text(dumps(found, indent=1) + "\n", encoding="utf-8")
    files = save(trade_figure(record), folder, "trade", "Accuracy against cost", png)
    if json:
        print_json(found)
    else:
        print("\n".join(trade_lines(record)))
        if layer is None and not names_waves(machine) and machine.chambers:
            print("Solvers of py-pde on a layer of it alone, their cost and error: --layer")
        print(f"Look at {files.svg}; the numbers are in {folder / 'trade.json'}")
    count = sum(len(comparison.rows) for comparison in record.comparisons)
    say(f"{record.name}: {count} models and resolutions done")
