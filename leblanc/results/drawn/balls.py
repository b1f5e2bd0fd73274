"""A machine with balls in races as a picture draws it, at some of its speeds."""

from __future__ import annotations

from dataclasses import dataclass

from fluid.fill import Fill
from leblanc.results.drawn.machine import DrawnRace, Liquid, MachineParts, Scale
from leblanc.results.races.states import BallsResult
from meshes.arrays import Array, Complex


@dataclass(frozen=True)
class BallView:
    """A machine with balls at some speeds; s speeds, c chambers, N balls. All in the drum frame.

    Parameters
    ----------
    result : what `run` says of them
    fills, places : chambers with liquid, then a ring without any for each race; their middles, m
    moved : some are drawn apart although the scene gives them one plane
    races : with their balls
    deflection : of the axis at each of them, m, nan where no state was found, shape (s, c)
    lean : slope of the axis along itself, rad, shape (s,)
    angle : of each ball as drawn, rad, shape (s, N)
    apart : balls that would cover one another are drawn side by side, shape (s,)
    scale : of the deflection and the depth of liquid
    bodies : liquid of each chamber at each speed
    parts : drum, housing, springs and dampers
    """

    result: BallsResult
    fills: tuple[Fill, ...]
    places: tuple[float, ...]
    moved: bool
    races: tuple[DrawnRace, ...]
    deflection: Complex
    lean: Complex
    angle: Array
    apart: tuple[bool, ...]
    scale: Scale
    bodies: tuple[tuple[Liquid, ...], ...]
    parts: MachineParts

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
