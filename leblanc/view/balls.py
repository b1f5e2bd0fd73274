"""Balls in their races in a three-dimensional picture, and the picture of a steady state."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from leblanc.core.notes import one_line
from leblanc.core.units import DEGREE, LENGTH, MINUS, MM, unit_for
from leblanc.plotting.bodies import BallView, DrawnRace
from leblanc.view.parts import NO_CELLS, Instant, Label, Picture, Piece, Stage, placed, turned
from leblanc.view.scene import compose, describe_speed, place_in_words
from meshes.arrays import Array

STATES = {
    "balanced": "the balls balance the rotor",
    "together": "balls together",
    "apart": "balls apart, the rotor is not balanced",
}


def with_balls(
    picture: Picture, stage: Stage, instant: Instant, races: Sequence[DrawnRace], angle: Array
) -> Picture:
    """The picture with the balls of each race as spheres.

    `angle` of each ball from the zero mark of the drum, rad, shape (N,).
    """
    pieces: list[Piece] = []
    labels: list[Label] = []
    for number, race in enumerate(races, start=1):
        centre = stage.scale.deflection * instant.deflection[race.ring]
        across = centre + race.radius * np.exp(1j * angle[slice(*race.balls)])
        points = turned(stage, placed(stage, across, stage.places[race.ring]), instant.turn)
        pieces.append(Piece(f"balls {number}", points, NO_CELLS, "ball", race.ball * MM))
        x, y, z = points[0].tolist()
        count = race.balls[1] - race.balls[0]
        name = "ball" if count == 1 else f"{count} balls"
        labels.append(Label(name if len(races) == 1 else f"{name}, race {number}", (x, y, z)))
    return replace(picture, pieces=(*picture.pieces, *pieces), labels=(*picture.labels, *labels))


def stage_with_balls(view: BallView) -> Stage:
    """What is fixed in pictures of a machine with balls."""
    size = np.nan_to_num(np.abs(view.deflection))
    return Stage(
        fills=view.fills,
        places=view.places,
        lying=view.result.axis == "horizontal",
        scale=view.scale,
        swing=view.scale.deflection * float(size.max(initial=0.0)),
        zero="unbalance" if view.result.kind == "jeffcott" else "angle 0",
        parts=view.parts,
    )


def ball_still(view: BallView, index: int, turn: float = 0.0, said: str = "") -> Picture:
    """Picture of a machine with balls at one of its speeds, the drum turned by `turn`, rad.

    `said`: sentence of a film about it, in place of that of a still.
    """
    stage = stage_with_balls(view)
    lean = complex(view.lean[index])
    found = view.deflection[index]
    instant = Instant(
        deflection=tuple(map(complex, np.where(np.isfinite(found), found, 0.0))),
        lean=lean if np.isfinite(lean) else 0j,
        bodies=view.bodies[index],
        title=describe_speed(view.result.name, float(view.result.speed[index])),
        state="\n".join(_state(view, index)),
        caption=" ".join(_caption(view, index, said or "Seen from the drum.")),
        turn=turn,
    )
    return with_balls(compose(stage, instant), stage, instant, view.races, view.angle[index])


def _state(view: BallView, index: int) -> list[str]:
    """Deflection, balls and stability, a line each."""
    result = view.result
    if not result.converged[index]:
        return ["no state found in which the balls rest: the axis is drawn at rest"]
    zero = "the unbalance" if result.kind == "jeffcott" else "angle 0"
    moved, size = complex(result.deflection[index]), float(result.amplitude[index])
    unit = unit_for(LENGTH, size, float(result.amplitude_without[index]))
    without = unit.text(float(result.amplitude_without[index]))
    places = ", ".join(f"{math.degrees(angle):.0f}" for angle in result.ball_angle[index])
    lines = [
        f"{STATES[str(result.state[index])]}: at {places.replace('-', MINUS)}{DEGREE} from {zero}",
        f"deflection {place_in_words(moved, zero, unit)}, amplitude without balls {without}",
    ]
    if not result.stable[index]:
        lines.append("not stable: the balls would run in their race")
    return lines


def _caption(view: BallView, index: int, seen: str) -> list[str]:
    """How the machine is drawn, sentence by sentence."""
    words = view.scale.in_words()
    if view.result.liquid_mass == 0.0:
        words = words.replace("walls and volume of liquid", "walls")
    parts = [words, seen, "Races are drawn as rings as wide as their balls."]
    if view.apart[index]:
        parts.append("Balls at one place lie side by side.")
    if any(race.assumed for race in view.races):
        parts.append("The scene does not say how large its balls are: drawn as of steel.")
    if view.moved:
        parts.append("Chambers drawn one behind the other; the scene does not say where they are.")
    if view.result.liquid_mass > 0.0:
        parts.append("The liquid is in equilibrium with the deflection as drawn.")
    if view.parts.sketched:
        parts.append(view.parts.sketched)
    if view.result.assumed:
        parts.append("Some values of the scene are assumed.")
    return [one_line(part) for part in parts]
