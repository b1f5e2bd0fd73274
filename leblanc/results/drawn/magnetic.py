"""A rotor in magnetic bearings as a picture draws it: in its gap, with the path of its axis."""

from __future__ import annotations

from dataclasses import dataclass

from meshes.arrays import Array


@dataclass(frozen=True)
class MagneticView:
    """A rotor in its two bearings; k instants."""

    name: str  #: of the scene
    assumed: bool  #: some of its values are
    lying: bool  #: the axis is horizontal
    controller: str  #: that holds the rotor
    trial: bool  #: the path is that of the trial in time; else an orbit by the unbalances alone
    time: Array  #: of the instants, s and rad/s, shape (k,)
    speed: Array
    displacement: Array  #: along first x, first y, second x, second y of the bearings, m, shape (k, 4)
    gap: float  #: m
    planes: tuple[float, float]  #: of the bearings along the axis, m
    radius: float  #: of the rotor, m
    length: float
    sketched: bool  #: the scene does not say how wide and long it is
    gap_factor: float  #: by which the gap and the path are drawn larger
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
