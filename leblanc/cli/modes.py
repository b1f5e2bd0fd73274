"""`leblanc modes`: natural frequencies, damping and shapes of the liquid in a chamber of any section."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.core.files import out_dir
from leblanc.core.progress import working
from leblanc.core.terminal import print_json, say

if TYPE_CHECKING:
    from leblanc.results.liquid import ModesResult


def modes(
    radius: Annotated[str, typer.Option(help="Wall radius, m or with a unit.")],
    volume: Annotated[str, typer.Option(help="Volume of the liquid.")],
    height: Annotated[str, typer.Option(help="Height of the chamber along the axis.")],
    speed: Annotated[str, typer.Option(help="Spin speed, rad/s or with a unit.")],
    count: Annotated[int, typer.Option(help="How many modes, the slowest first.")] = 12,
    baffles: Annotated[int, typer.Option(help="Number of radial baffles.")] = 0,
    baffle_tip_radius: Annotated[
        str, typer.Option(help="Distance of their inner edges from the axis; 0: through the surface.")
    ] = "0",
    baffle_wall_gap: Annotated[str, typer.Option(help="Distance of their outer edges from the wall.")] = "0",
    mesh: Annotated[
        Path | None, typer.Option(help="Section of the chamber: a mesh file, or an outline as DXF or STEP.")
    ] = None,
    mesh_unit: Annotated[
        str | None, typer.Option(help="Length of that file's unit [default: its own, of a mesh 1 m].")
    ] = None,
    mesh_size: Annotated[
        str | None, typer.Option(help="Cells at the walls of an outline [default: 1/100 of its extent].")
    ] = None,
    liquid: Annotated[str, typer.Option(help="Name of the liquid, for the damping.")] = "water",
    segments: Annotated[int, typer.Option(help="Cells around the liquid, at least.")] = 96,
    layers: Annotated[int, typer.Option(help="Cells across the liquid, at least.")] = 6,
    order: Annotated[int, typer.Option(help="1: linear elements, 2: quadratic ones.")] = 2,
    out: Annotated[Path | None, typer.Option(help="Folder for the figure of the shapes.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Frequencies, damping and shapes of the liquid's waves.

    Frequencies are relative to the drum, positive with the spin.
    """
    given = locals()
    from leblanc.core.answer import NotConverged
    from leblanc.core.units import LENGTH, with_unit
    from leblanc.questions import ask, modes_question
    from leblanc.studies.modes import answer_modes
    from leblanc.text.liquid import modes_table

    question = ask(modes_question, given)
    folder = None if out is None else out_dir("modes", out)
    with working("waves by finite elements") as update:
        result = answer_modes(**question, progress=lambda what: update(what=what))
    if json:
        print_json(result.to_json())
    else:
        print(f"{result.title}; free surface at {with_unit(result.surface_radius, LENGTH)}; {liquid}")
        print("\n".join(modes_table(result)))
        print(f"force ratio of a synchronous whirl {result.synchronous_force_ratio:.6g}")
        for note in result.notes:
            print(f"note: {note.text}")
    if folder is not None:
        _draw(result, folder)
    if not result.converged:
        reason = "the eigenproblem was not solved to rounding; a coarser mesh may help"
        raise NotConverged([f"leblanc modes: {reason}"])


def _draw(result: ModesResult, folder: Path) -> None:
    """The shapes of the slowest modes."""
    from leblanc.figures.liquid import modes_figure, save

    files = save(modes_figure(result), folder, "modes", "Shapes of the liquid's modes")
    say(f"wrote {files.png}")
