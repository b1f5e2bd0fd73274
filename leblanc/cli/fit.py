"""`leblanc fit`: unknown values of a scene from what was measured on the machine."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from leblanc.cli.terminal.output import load
from leblanc.core.contents import results_dir
from leblanc.core.progress import working
from leblanc.core.terminal import print_json, print_table, say


def fit(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML); its values are the first guess.")],
    measured: Annotated[
        Path,
        typer.Argument(help="Table of what was measured (CSV), headed like: speed [rpm], amplitude [mm]."),
    ],
    unknown: Annotated[
        list[str],
        typer.Option(help="Path of an unknown, as in rotor.mass; A=B ties B to A; once for each of them."),
    ],
    starts: Annotated[
        int,
        typer.Option(
            help="Searches at least; more follow until the best values are found again.", min=1, max=1000
        ),
    ] = 2,
    seed: Annotated[int, typer.Option(help="Of the values that they start from.", min=0)] = 0,
    scale: Annotated[
        str,
        typer.Option(
            help="given; free: the unit of the sensor is not known, shapes count; each: of every quantity."
        ),
    ] = "given",
    noise: Annotated[
        str,
        typer.Option(help='estimate, a share of each reading ("3 %") or an error ("0.1 mm", "2 deg").'),
    ] = "estimate",
    column: Annotated[
        list[str] | None,
        typer.Option(help='Column of the file that is meant: amplitude="Schwingweg [um pp]", speed=, time=.'),
    ] = None,
    out: Annotated[
        Path | None, typer.Option(help="Folder for the files [default: out/<scene name>].")
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Unknowns of a scene from a measured curve, each with its uncertainty."""
    from leblanc.scene.scene import dry_rotor
    from leblanc.studies.fit import fit_scene
    from leblanc.studies.fitting.measured import named_columns, read_measured
    from leblanc.studies.fitting.noise import parse_noise
    from leblanc.studies.fitting.problem import require_scale

    machine, free = load(scene), require_scale(scale, "--scale") != "given"
    parse_noise(noise, "--noise")
    columns = named_columns(column or (), "--column")
    table = read_measured(measured, dry_rotor(machine).system().coordinates, free, columns)
    folder = results_dir(machine.name, out, scene, machine.digest, "fit.nc")
    with working("search") as update:
        found = fit_scene(
            machine, table, unknown, starts, seed, scale, lambda part: update(part, 1.0), noise, scene
        )

    from leblanc.core.netcdf import write_netcdf
    from leblanc.figures.fit import write_figures
    from leblanc.text.fit import HEAD, fit_rows, left_words, noise_words

    write_netcdf(found.named_arrays(), folder / "fit.nc")
    files = write_figures(found, folder)
    if json:
        print_json(found.to_json())
    else:
        print_table(fit_rows(found), HEAD, right=True)
        print(f"Left: {left_words(found)}")
        print(f"Noise: {noise_words(found)}")
        for note in found.notes:
            print(f"note: {note}")
        print(f"See {files.png}; the data are in {folder / 'fit.nc'}")
    if not found.converged:
        from leblanc.core.answer import NotConverged

        raise NotConverged([f"{scene}: the search for {', '.join(unknown)} did not come to its end"])
    say(f"{found.name}: {len(unknown)} unknowns, {found.evaluations} answers")
