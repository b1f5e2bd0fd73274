"""`leblanc volume`: the free surface, the optimal volume, their check by finite elements."""

from __future__ import annotations

from typing import Annotated

import typer

from leblanc.cli.output import print_json, print_table


def volume(
    radius: Annotated[str, typer.Option(help="Wall radius, m or with a unit.")],
    height: Annotated[str, typer.Option(help="Height of the chamber along the axis.")],
    eccentricity: Annotated[str, typer.Option(help="Deflection: distance of the rotation axis.")],
    speed: Annotated[str, typer.Option(help="Spin speed, rad/s or with a unit.")],
    volume: Annotated[str | None, typer.Option(help="Volume of the liquid; adds its surface.")] = None,
    gravity: Annotated[str, typer.Option(help="Gravity along the axis.")] = "9.81",
    inner_radius: Annotated[str, typer.Option(help="Inner wall radius.")] = "0",
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Volume that just covers the wall at a deflection. Also the surface of a given volume."""
    from leblanc.scene.schema.faults import NotConverged
    from leblanc.studies.volume import answer_volume
    from leblanc.text.volume import facts, question
    from leblanc.units import ACCELERATION, ANGULAR_SPEED, LENGTH, VOLUME, parse_option
    from meshes.chamber import Chamber
    from meshes.errors import require_not_negative

    chamber = Chamber(
        parse_option(radius, LENGTH, "--radius"),
        parse_option(height, LENGTH, "--height"),
        parse_option(inner_radius, LENGTH, "--inner-radius"),
    )
    e = parse_option(eccentricity, LENGTH, "--eccentricity")
    spin = parse_option(speed, ANGULAR_SPEED, "--speed")
    g = parse_option(gravity, ACCELERATION, "--gravity")
    for field, value in (("--eccentricity", e), ("--speed", spin), ("--gravity", g)):
        require_not_negative(field, value)
    held = None if volume is None else parse_option(volume, VOLUME, "--volume")
    answer = answer_volume(chamber, e, spin, g, held)
    if json:
        print_json(answer.to_json())
    else:
        print(question(answer))
        print_table(facts(answer))
    if not answer.converged:
        raise NotConverged(["leblanc volume: no surface found that holds the volume asked for"])
