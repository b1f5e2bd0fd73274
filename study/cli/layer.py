"""`leblanc layer`: the liquid's answer to one prescribed whirl."""

from __future__ import annotations

from typing import Annotated

import typer

from study.cli.output import print_json


def layer(
    radius: Annotated[str, typer.Option(help="Wall radius, m or with a unit.")],
    volume: Annotated[str, typer.Option(help="Volume of the liquid.")],
    height: Annotated[str, typer.Option(help="Height of the chamber along the axis.")],
    speed: Annotated[str, typer.Option(help="Spin speed, rad/s or with a unit.")],
    whirl_speed: Annotated[str, typer.Option(help="Whirl speed in space.")],
    whirl_amplitude: Annotated[str, typer.Option(help="Radius of the whirl.")],
    model: Annotated[str, typer.Option(help="statics or linear.")] = "linear",
    friction: Annotated[str, typer.Option(help="none, stokes, linear:RATE or quadratic:NUMBER.")] = "none",
    gravity: Annotated[str, typer.Option(help="Gravity across the axis.")] = "0",
    liquid: Annotated[str, typer.Option(help="Name of the liquid.")] = "water",
    profile: Annotated[bool, typer.Option("--profile", help="Add the depth around the wall.")] = False,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Force and centre of mass of a liquid layer under a circular whirl, in the plane."""
    from dataclasses import asdict

    from fluid.fill import Fill
    from fluid.liquid import known_liquid
    from meshes.chamber import Chamber
    from study.faults import NotConverged
    from study.friction import parse_friction
    from study.layer import answer_layer
    from study.units import ACCELERATION, ANGULAR_SPEED, LENGTH, VOLUME, parse_option

    chamber = Chamber(parse_option(radius, LENGTH, "--radius"), parse_option(height, LENGTH, "--height"))
    answer = answer_layer(
        Fill(chamber, known_liquid(liquid), parse_option(volume, VOLUME, "--volume")),
        speed=parse_option(speed, ANGULAR_SPEED, "--speed"),
        whirl_speed=parse_option(whirl_speed, ANGULAR_SPEED, "--whirl-speed"),
        whirl_amplitude=parse_option(whirl_amplitude, LENGTH, "--whirl-amplitude"),
        model=model,
        friction=parse_friction(friction, "--friction"),
        gravity=parse_option(gravity, ACCELERATION, "--gravity"),
    )
    shown = asdict(answer)
    if not profile:
        del shown["theta"], shown["depth"]
    if json:
        print_json(shown)
    else:
        for name, value in shown.items():
            print(f"{name.replace('_', ' '):18}{value}")
    if not answer.converged:
        raise NotConverged(["leblanc layer: the whirl meets a free wave, the linear force is unbounded"])
