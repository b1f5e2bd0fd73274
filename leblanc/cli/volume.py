"""`leblanc volume`: the free surface, the optimal volume, their check by finite elements."""

from __future__ import annotations

from typing import Annotated

import typer

from leblanc.cli.terminal.output import print_json, print_table


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
    given = locals()
    from leblanc.questions import ask, volume_question
    from leblanc.scene.schema.load import NotConverged
    from leblanc.studies.volume import answer_volume
    from leblanc.text.liquid import facts
    from leblanc.text.liquid import question as described

    question = ask(volume_question, given)
    answer = answer_volume(**question)
    if json:
        print_json(answer.to_json())
    else:
        print(described(answer))
        print_table(facts(answer))
    if not answer.converged:
        raise NotConverged(["leblanc volume: no surface found that holds the volume asked for"])
