"""`leblanc layer`: the liquid's answer to one prescribed whirl."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.core.files import out_dir, require_writable
from leblanc.core.progress import working
from leblanc.core.terminal import print_json, print_table, say

if TYPE_CHECKING:
    from leblanc.questions import LayerQuestion
    from leblanc.results.layer import FreeWaveResult, LayerPeriodsResult, LayerResult


def layer(
    radius: Annotated[str, typer.Option(help="Wall radius, m or with a unit.")],
    volume: Annotated[str, typer.Option(help="Volume of the liquid.")],
    height: Annotated[str, typer.Option(help="Height of the chamber along the axis.")],
    speed: Annotated[str, typer.Option(help="Spin speed, rad/s or with a unit.")],
    whirl_speed: Annotated[
        str | None, typer.Option(help="Whirl speed in space; left out where gravity alone drives.")
    ] = None,
    whirl_amplitude: Annotated[
        str | None, typer.Option(help="Radius of the whirl [default: 0 with --gravity].")
    ] = None,
    free: Annotated[
        float | None,
        typer.Option(
            help="In place of a whirl: the free wave whose crest is so many mean depths deep "
            "(linear, potential)."
        ),
    ] = None,
    mode: Annotated[int | None, typer.Option(help="Crests of the free wave [default: 1].")] = None,
    model: Annotated[
        str,
        typer.Option(
            help="statics, linear, long_wave, kdv, fem or potential; auto: the cheapest within --tolerance."
        ),
    ] = "linear",
    tolerance: Annotated[
        float | None, typer.Option(help="Of auto: error of the force that is allowed [default: 0.01].")
    ] = None,
    cells: Annotated[
        int | None,
        typer.Option(
            help="Cells round the wall [default: long_wave 256, fem 96]; "
            "most nodes from crest to trough, in time round the wall [default: potential 432, 2048]."
        ),
    ] = None,
    baffles: Annotated[int, typer.Option(help="Number of radial baffles (fem).")] = 0,
    baffle_tip_radius: Annotated[
        str, typer.Option(help="Distance of their inner edges from the axis; 0: through the surface.")
    ] = "0",
    baffle_wall_gap: Annotated[str, typer.Option(help="Distance of their outer edges from the wall.")] = "0",
    dispersion: Annotated[
        bool, typer.Option("--dispersion", help="Exact linear dispersion (long_wave, kdv).")
    ] = False,
    friction: Annotated[
        str, typer.Option(help="none, stokes, wall[:ROUGHNESS], linear:RATE or quadratic:NUMBER.")
    ] = "none",
    gravity: Annotated[str, typer.Option(help="Gravity across the axis.")] = "0",
    liquid: Annotated[str, typer.Option(help="Name of the liquid.")] = "water",
    duration: Annotated[
        str | None, typer.Option(help="Start from rest and answer period by period (long_wave, potential).")
    ] = None,
    ramp: Annotated[str, typer.Option(help="Time over which the whirl grows, with --duration.")] = "0",
    solver: Annotated[
        str | None,
        typer.Option(
            help="Of py-pde: runge-kutta, scipy ... [default: long_wave finite_volume, kdv steady_newton]."
        ),
    ] = None,
    profile: Annotated[bool, typer.Option("--profile", help="Add the depth around the wall.")] = False,
    out: Annotated[Path | None, typer.Option(help="Folder for the figure of the wave.")] = None,
    animate: Annotated[
        Path | None,
        typer.Option(
            help="GIF or MP4 of the wave in the drum frame: long_wave from rest, potential with --duration "
            "too, others steady."
        ),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Force and centre of mass of a liquid layer under a whirl. In the plane, the whirl being prescribed.

    With --free the speeds of the wave that runs round the drum by itself.
    """
    given = locals()
    from leblanc.core.answer import NotConverged
    from leblanc.questions import ask, layer_question
    from leblanc.results.layer import LayerPeriodsResult
    from leblanc.studies.layer import answer_layer, free_wave, layer_history

    question = ask(layer_question, given)
    folder = None if out is None else out_dir("layer", out)
    if animate is not None:
        from leblanc.figures.drawing.page import require_film

        require_film(animate)
        require_writable(animate)
    result: LayerResult | LayerPeriodsResult | FreeWaveResult
    with working("waves under the whirl") as update:
        whirl = question.whirl | {"progress": lambda share: update(share, 1.0)}
        if question.free is not None:
            result = free_wave(**question.free)
        elif question.duration is not None:
            result = layer_history(**whirl, duration=question.duration, ramp=question.ramp)
        else:
            result = answer_layer(**whirl)
        if folder is not None and (not isinstance(result, LayerPeriodsResult) or result.time.size):
            _draw(result, folder)
    if animate is not None:
        _film(question, result, animate)
    shown = result.to_json(profile)
    if json:
        print_json(shown)
    else:
        _tell(result, profile)
    if not result.converged:
        reason = "; ".join(shown["notes"][:1])
        raise NotConverged([f"leblanc layer: {reason or 'no answer'}; {_HELP[result.case.model]}"])


_HELP = {
    "statics": "less liquid or a smaller whirl may help",
    "linear": "friction takes the bound off: --model kdv or long_wave",
    "fem": "a whirl speed off the free waves may help",
    "kdv": "friction may help, or --model long_wave",
    "long_wave": "friction or --duration may help",
    "potential": "a smaller wave or another speed may help; long_wave has bores",
}


def _tell(result: LayerResult | LayerPeriodsResult | FreeWaveResult, profile: bool) -> None:
    """The answer as text, each number that it rests on in a line."""
    from leblanc.results.layer import FreeWaveResult, LayerPeriodsResult
    from leblanc.text.liquid import (
        VALIDITY_HEAD,
        free_wave_summary,
        layer_periods,
        layer_profile,
        layer_summary,
        layer_words,
        periods_summary,
        validity_rows,
        whirl_words,
    )

    free = isinstance(result, FreeWaveResult)
    print(layer_words(result.case) if free else whirl_words(result.case))
    if isinstance(result, LayerPeriodsResult):
        print_table(periods_summary(result))
        head, rows = layer_periods(result)
        if rows:
            print()
            print_table(rows, head, right=True)
    else:
        print_table(
            free_wave_summary(result) if isinstance(result, FreeWaveResult) else layer_summary(result)
        )
        if profile:
            head, rows = layer_profile(result)
            print()
            print_table(rows, head, right=True)
    print()
    print_table(validity_rows(result.validity), VALIDITY_HEAD)
    for note in result.notes:
        print(f"note: {note}")


def _draw(result: LayerResult | LayerPeriodsResult | FreeWaveResult, folder: Path) -> None:
    """The wave as it stands in the frame of the deflection, or of its crest; its means over whirl periods."""
    from leblanc.figures.drawing.page import save
    from leblanc.figures.wave import layer_figure, periods_figure
    from leblanc.results.layer import LayerPeriodsResult

    if isinstance(result, LayerPeriodsResult):
        files = save(periods_figure(result), folder, "periods", "Whirl periods of a layer")
    else:
        files = save(layer_figure(result), folder, "wave", "Wave on the annulus")
    say(f"wrote {files.png}")


def _film(question: LayerQuestion, result: object, path: Path) -> None:
    """The wave in the drum frame: long_wave from rest, by default six whirl periods; others two, steady."""
    from leblanc.figures.wave import animate
    from leblanc.results.layer import FreeWaveResult
    from leblanc.studies.layer import free_film, layer_film

    with working("waves through time") as update:
        whirl = question.whirl | {"progress": lambda share: update(share, 1.0)}
        if isinstance(result, FreeWaveResult):
            if not result.converged:
                return
            wave, film = free_film(result)
        else:
            wave, film = layer_film(**whirl, duration=question.duration, ramp=question.ramp)
        update(what="drawing")
        frames = animate(wave, film, path, update)
    say(f"wrote {path}, {frames} frames")
