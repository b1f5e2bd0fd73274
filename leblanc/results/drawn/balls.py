"""A machine with balls in races as a picture draws it, at some of its speeds."""

from __future__ import annotations

from dataclasses import dataclass

from fluid.fill import Fill
from leblanc.results.drawn.machine import DrawnRace, Liquid, MachineParts, Scale
from leblanc.studies.balls.answer import BallsAnswer
from meshes.arrays import Array, Complex


@dataclass(frozen=True)
class BallView:
    """A machine with balls at some speeds; s speeds, c chambers, N balls. All in the drum frame."""

    result: BallsAnswer  #: what `run` says of them
    fills: tuple[Fill, ...]  #: chambers with liquid, then a ring without any for each race; their middles, m
    places: tuple[float, ...]
    moved: bool  #: some are drawn apart although the scene gives them one plane
    races: tuple[DrawnRace, ...]  #: with their balls
    deflection: Complex  #: of the axis at each of them, m, 0 where no state was found, shape (s, c)
    lean: Complex  #: slope of the axis along itself, rad, shape (s,)
    angle: Array  #: of each ball as drawn, rad, shape (s, N)
    apart: tuple[bool, ...]  #: balls that would cover one another are drawn side by side, shape (s,)
    scale: Scale  #: of the deflection and the depth of liquid
    bodies: tuple[tuple[Liquid, ...], ...]  #: liquid of each chamber at each speed
    parts: MachineParts  #: drum, housing, springs and dampers

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a machine with balls, SI; angles as `run` has them."""
        return {
            "speed": float(self.result.speed[-1]),
            "deflection": self.deflection[-1],
            "state": str(self.result.state[-1]),
            "ball_angle": self.result.ball_angle[-1],
            "stable": bool(self.result.stable[-1]),
            "deflection_factor": self.scale.deflection,
            "depth_factor": self.scale.depth,
        }
