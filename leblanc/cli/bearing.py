"""`leblanc bearing`: a rolling bearing's frequencies, a bearing from its frequencies, slip of its cage."""

from __future__ import annotations

from typing import Annotated

import typer

from leblanc.cli.terminal.output import print_json, print_table


def bearing(
    speed: Annotated[str, typer.Option(help="Of the shaft, rad/s or with a unit.")],
    balls: Annotated[int | None, typer.Option(help="How many balls or rollers in one row.")] = None,
    ball_diameter: Annotated[str | None, typer.Option(help="Diameter of a ball, m or with a unit.")] = None,
    pitch_diameter: Annotated[str | None, typer.Option(help="Of the circle of the balls' centres.")] = None,
    contact_angle: Annotated[
        str | None, typer.Option(help="Contact angle [default: 0; sought where --bsf is given].")
    ] = None,
    ftf: Annotated[float | None, typer.Option(help="Frequency of the cage over the shaft's.")] = None,
    bpfo: Annotated[float | None, typer.Option(help="Of the outer ring over the shaft's.")] = None,
    bpfi: Annotated[float | None, typer.Option(help="Of the inner ring over the shaft's.")] = None,
    bsf: Annotated[float | None, typer.Option(help="Of a ball over the shaft's.")] = None,
    cage: Annotated[str | None, typer.Option(help="Measured speed of the cage; adds its slip.")] = None,
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Frequencies of a rolling bearing, or a bearing from its frequencies. Also the slip of its cage."""
    given = locals()
    from leblanc.questions import ask, bearing_question
    from leblanc.studies.spindles.bearing import answer_bearing
    from leblanc.text.spindles.bearing import HEAD, bearing_words, frequency_rows, more

    answer = answer_bearing(**ask(bearing_question, given))
    if json:
        print_json(answer.to_json())
        return
    print(bearing_words(answer))
    columns = len(HEAD) if answer.given else 3
    print_table([row[:columns] for row in frequency_rows(answer)], HEAD[:columns], right=True)
    if rows := more(answer):
        print_table(rows)
