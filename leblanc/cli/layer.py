"""`leblanc layer`: the liquid's answer to one prescribed whirl."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from leblanc.cli.output import print_json, say
from leblanc.cli.progress import working
from leblanc.files import out_dir, require_writable

if TYPE_CHECKING:
    from leblanc.questions import LayerQuestion
    from leblanc.results.layer import LayerPeriodsResult, LayerResult


def layer(
    radius: Annotated[str, typer.Option(help="Wall radius, m or with a unit.")],
    volume: Annotated[str, typer.Option(help="Volume of the liquid.")],
    height: Annotated[str, typer.Option(help="Height of the chamber along the axis.")],
    speed: Annotated[str, typer.Option(help="Spin speed, rad/s or with a unit.")],
    whirl_speed: Annotated[str, typer.Option(help="Whirl speed in space.")],
    whirl_amplitude: Annotated[str, typer.Option(help="Radius of the whirl.")],
    model: Annotated[str, typer.Option(help="statics, linear, long_wave, kdv or fem.")] = "linear",
    cells: Annotated[
        int | None, typer.Option(help="Cells round the wall [default: long_wave 256, fem 96].")
    ] = None,
    baffles: Annotated[int, typer.Option(help="Number of radial baffles (fem).")] = 0,
    baffle_tip_radius: Annotated[
        str, typer.Option(help="Distance of their inner edges from the axis; 0: through the surface.")
    ] = "0",
    baffle_wall_gap: Annotated[str, typer.Option(help="Distance of their outer edges from the wall.")] = "0",
    dispersion: Annotated[
        bool, typer.Option("--dispersion", help="Exact linear dispersion (long_wave, kdv).")
    ] = False,
    friction: Annotated[str, typer.Option(help="none, stokes, linear:RATE or quadratic:NUMBER.")] = "none",
    gravity: Annotated[str, typer.Option(help="Gravity across the axis.")] = "0",
    liquid: Annotated[str, typer.Option(help="Name of the liquid.")] = "water",
    duration: Annotated[
        str | None, typer.Option(help="Start from rest and answer period by period (long_wave).")
    ] = None,
    ramp: Annotated[str, typer.Option(help="Time over which the whirl grows, with --duration.")] = "0",
    profile: Annotated[bool, typer.Option("--profile", help="Add the depth around the wall.")] = False,
    out: Annotated[Path | None, typer.Option(help="Folder for the figure of the wave.")] = None,
    animate: Annotated[
        Path | None,
        typer.Option(help="GIF or MP4 of the wave in the drum frame: long_wave from rest, others steady."),
    ] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Force and centre of mass of a liquid layer under a whirl. In the plane, the whirl being prescribed."""
    given = locals()
    from leblanc.questions import ask, layer_question
    from leblanc.scene.schema.load import NotConverged
    from leblanc.studies.layer import answer_layer, layer_history

    question = ask(layer_question, given)
    folder = None if out is None or question.duration is not None else out_dir("layer", out)
    if animate is not None:
        from leblanc.figures.page import require_film

        require_film(animate)
        require_writable(animate)
    result: LayerResult | LayerPeriodsResult
    with working("waves under the whirl"):
        if question.duration is not None:
            result = layer_history(**question.whirl, duration=question.duration, ramp=question.ramp)
        else:
            result = answer_layer(**question.whirl)
            if folder is not None:
                _draw(result, folder)
    if animate is not None:
        _film(question, animate)
    shown = result.to_json(profile)
    if json:
        print_json(shown)
    else:
        _tell(shown)
    if not result.converged:
        reason = "; ".join(shown["notes"][:1])
        raise NotConverged([f"leblanc layer: {reason or 'no answer'}; {_HELP[model]}"])


# Of a layer that starts from rest, one row for each whirl period.
_PERIODS = {
    "time": "time, s",
    "force_ratio": "force ratio",
    "mean_rotation": "mean rotation, rad/s",
    "depth_max": "depth max, m",
    "depth_min": "depth min, m",
    "offset": "offset, m",
    "pressure_ratio": "pressure ratio",
}

_HELP = {
    "statics": "less liquid or a smaller whirl may help",
    "linear": "friction takes the bound off: --model kdv or long_wave",
    "fem": "a whirl speed off the free waves may help",
    "kdv": "friction may help, or --model long_wave",
    "long_wave": "friction or --duration may help",
}


def _tell(shown: dict[str, Any]) -> None:
    """The answer as text, each number that it rests on in a line."""
    periods = [name for name in _PERIODS if getattr(shown.get(name), "ndim", 0) == 1]
    for name, value in shown.items():
        if name not in ("validity", "notes", *periods):
            print(f"{name.replace('_', ' '):18}{value}")
    print()
    if periods:
        print("".join(f"{_PERIODS[name]:>22}" for name in periods))
        for row in zip(*(shown[name] for name in periods), strict=True):
            print("".join(f"{value:22.4g}" for value in row))
        print()
    for number in shown["validity"]:
        print(f"{number['name'].replace('_', ' '):18}{number['value']:<10.4g}{number['meaning']}")
    for note in shown["notes"]:
        print(f"note: {note}")


def _draw(result: LayerResult, folder: Path) -> None:
    """The wave as it stands in the frame of the deflection."""
    from leblanc.figures.page import save
    from leblanc.figures.wave import wave_figure

    files = save(wave_figure(result.wave()), folder, "wave", "Wave on the annulus")
    say(f"wrote {files.png}")


def _film(question: LayerQuestion, path: Path) -> None:
    """The wave in the drum frame: long_wave from rest, by default six whirl periods; others two, steady."""
    from leblanc.figures.wave import animate
    from leblanc.studies.layer import layer_film

    with working("waves through time") as update:
        wave, film = layer_film(**question.whirl, duration=question.duration, ramp=question.ramp)
        update(what="drawing")
        frames = animate(wave, film, path, update)
    say(f"wrote {path}, {frames} frames")
