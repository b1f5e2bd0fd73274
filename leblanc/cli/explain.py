"""`leblanc explain`: a scene's dimensionless numbers and the liquid model at each speed."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from leblanc.cli.command import finish
from leblanc.cli.terminal.output import load
from leblanc.core.terminal import print_json, print_table

if TYPE_CHECKING:
    from leblanc.results.explanation import Explanation
    from leblanc.results.races.numbers import BallExplanation


def explain(
    scene: Annotated[Path, typer.Argument(help="Scene file (TOML).")],
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> None:
    """Key numbers of the machine; which liquid model answers, and why."""
    from leblanc.core.question import called
    from leblanc.registry import answerer
    from leblanc.studies.explain import explain_balls, explain_scene

    machine = load(scene)
    if (address := answerer("explain", machine.rotor.kind)) is not None:
        finish(called(address)(machine), str(scene), json)
        return
    if machine.balls:
        balls = explain_balls(machine)
        if json:
            print_json(balls.to_json())
        else:
            _print_balls(balls)
        return
    answer = explain_scene(machine)
    if json:
        print_json(answer.to_json())
    else:
        _print(answer)


def _print_balls(answer: BallExplanation) -> None:
    """The explanation of a scene with balls: that of the scene without them, and theirs."""
    from leblanc.text.races.numbers import ball_rows, race_rows

    _print(answer.machine)
    for k, race in enumerate(answer.races):
        print(f"race {k + 1}")
        print_table(race_rows(race, float(answer.speed[-1])), indent=2)
    print("balls")
    print_table([*ball_rows(answer), *(("not told", text) for text in answer.lacking)], indent=2)


def _print(answer: Explanation) -> None:
    """The explanation as text; of the liquid only where there is any."""
    from leblanc.core.notes import percent
    from leblanc.studies.closed_forms.answer import closed_form_table
    from leblanc.studies.run.words import described
    from leblanc.text.explanation import (
        ESTIMATES,
        estimate_rows,
        layer_rows,
        machine_rows,
        mode_rows,
        span_heading,
        span_rows,
    )

    print(answer.name)
    print_table(machine_rows(answer), indent=2)
    if answer.modes:
        print("natural frequencies at rest, without liquid")
        print_table(mode_rows(answer.modes), indent=2)
    for k, layer in enumerate(answer.layers):
        print(f"chamber {k + 1}")
        print_table(layer_rows(layer), indent=2)
    if answer.models:
        print(f"liquid model, with a tolerance of {percent(answer.tolerance)}")
    for span in answer.models:
        print(f"  {span_heading(span)}")
        print_table(span_rows(span), indent=4)
    if rows := estimate_rows(answer):
        print("  estimated: error of the means, ripple about them once a turn by gravity")
        print_table(rows, ESTIMATES, indent=4)
    if answer.models:
        print_table(described(span.model for span in answer.models), indent=2)
    told = [(str(row[0]), str(row[1])) for row in closed_form_table(answer.closed_forms).rows]
    told += [("not told", text) for text in answer.closed_forms.lacking]
    if told:
        print("closed forms")
        print_table(told, indent=2)
    if answer.runup:
        print("liquid model of the run-up")
        print_table([(answer.runup,)], indent=2)
