"""A rotor in magnetic bearings as a picture draws it: in its gap, with the path of its axis."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.arrays import Array


@dataclass(frozen=True)
class MagneticView:
    """A rotor in its two bearings; k instants.

    Parameters
    ----------
    name : of the scene
    assumed : some of its values are
    lying : the axis is horizontal
    controller : that holds the rotor
    trial : the path is that of the trial in time; else an orbit by the unbalances alone
    time, speed : of the instants, s and rad/s, shape (k,)
    displacement : along first x, first y, second x, second y of the bearings, m, shape (k, 4)
    gap : m
    planes : of the bearings along the axis, m
    radius, length : of the rotor, m
    sketched : the scene does not say how wide and long it is
    gap_factor, path_factor : by which the gap and the path are drawn larger
    """

    name: str
    assumed: bool
    lying: bool
    controller: str
    trial: bool
    time: Array
    speed: Array
    displacement: Array
    gap: float
    planes: tuple[float, float]
    radius: float
    length: float
    sketched: bool
    gap_factor: float
    path_factor: float

    def to_json(self) -> dict[str, object]:
        """What `leblanc view --json` prints of a rotor in magnetic bearings, SI."""
        return {
            "controller": self.controller,
            "speed": float(self.speed[0]),
            "displacement": self.displacement[0],
            "gap_factor": self.gap_factor,
            "deflection_factor": self.path_factor,
        }
