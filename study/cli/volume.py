"""`leblanc volume`: the free surface, the optimal volume, their check by finite elements."""

from __future__ import annotations

from typing import Annotated

import typer

from study.cli.output import print_json


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
    """Volume that just covers the wall at a deflection, and the surface of a given volume."""
    from dataclasses import asdict

    from meshes.border import require_not_negative
    from meshes.chamber import Chamber
    from study.faults import NotConverged
    from study.units import ACCELERATION, ANGULAR_SPEED, LENGTH, VOLUME, parse_option
    from study.volume import answer_surface, answer_volume

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
    best = answer_volume(chamber, e, spin, g)
    answer = asdict(best)
    if volume is not None:
        surface = answer_surface(chamber, parse_option(volume, VOLUME, "--volume"), e, spin, g)
        answer |= asdict(surface)
    if json:
        print_json(answer)
    else:
        for name, value in answer.items():
            print(f"{name.replace('_', ' '):24}{_words(name, value)}")
    if not answer.get("converged", True):
        raise NotConverged(["leblanc volume: no surface found that holds the volume asked for"])


def _words(name: str, value: object) -> str:
    """Value with its unit."""
    if value is None:
        return "none"
    if isinstance(value, bool | int):
        return str(value).lower()
    assert isinstance(value, float)
    if name.startswith("unbalance"):
        return f"{value:.10g} m^4"
    if name == "surface_constant":
        return f"{value:.10g} m"
    if name == "fem_error":
        return f"{value:.2g}"
    return f"{value * 1e6:.10g} ml"
