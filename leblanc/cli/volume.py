"""`leblanc volume`: the free surface, the optimal volume, their check by finite elements."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.output import print_json

if TYPE_CHECKING:
    from meshes.chamber import Chamber


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
    from dataclasses import asdict

    from leblanc.scene.faults import NotConverged
    from leblanc.studies.volume import answer_surface, answer_volume
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
    best = answer_volume(chamber, e, spin, g)
    answer = asdict(best)
    if volume is not None:
        surface = answer_surface(chamber, parse_option(volume, VOLUME, "--volume"), e, spin, g)
        answer |= asdict(surface)
    if json:
        print_json(answer)
    else:
        print(_asked(chamber, e, spin))
        for name, value in answer.items():
            print(f"{_LABELS.get(name, name.replace('_', ' ')):26}{_words(name, value)}")
    if not answer.get("converged", True):
        raise NotConverged(["leblanc volume: no surface found that holds the volume asked for"])


_LABELS = {
    "optimal_volume_fem": "by finite elements",
    "fem_error": "relative difference",
    "printed_eq18": "as printed, DR18 eq. 18",
    "corrected_eq18": "the same, corrected",
    "unbalance_volume_fem": "by finite elements",
}


def _asked(chamber: Chamber, eccentricity: float, speed: float) -> str:
    """What was understood, in engineers' units."""
    inner = f", inner radius {chamber.inner_radius * 1e3:.6g} mm" if chamber.inner_radius > 0.0 else ""
    return (
        f"Chamber of radius {chamber.radius * 1e3:.6g} mm{inner}, height {chamber.height * 1e3:.6g} mm; "
        f"deflection {eccentricity * 1e3:.6g} mm at {speed * 30.0 / math.pi:.6g} rpm"
    )


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
