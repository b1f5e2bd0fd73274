"""Natural frequencies, damping and shapes of the liquid in a chamber of any section."""

from __future__ import annotations

from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any

from leblanc.core.question import FILE, LIQUID, Quantity, Reader, ask
from leblanc.core.units import ANGULAR_SPEED, LENGTH, VOLUME

if TYPE_CHECKING:
    from leblanc.studies.modes.answer import ModesAnswer

FILES = ("modes.svg",)
_UNIT = Reader("leblanc.studies.modes.study:length_of_unit")


def modes(
    *,
    radius: Annotated[Quantity, LENGTH, "Wall radius, m or with a unit."],
    volume: Annotated[Quantity, VOLUME, "Volume of the liquid."],
    height: Annotated[Quantity, LENGTH, "Height of the chamber along the axis."],
    speed: Annotated[Quantity, ANGULAR_SPEED, "Spin speed, rad/s or with a unit."],
    count: Annotated[int, "How many modes, the slowest first."] = 12,
    baffles: Annotated[int, "Number of radial baffles."] = 0,
    baffle_tip_radius: Annotated[
        Quantity, LENGTH, "Distance of the baffles' inner edges from the axis; 0: through the surface."
    ] = 0.0,
    baffle_wall_gap: Annotated[Quantity, LENGTH, "Distance of the baffles' outer edges from the wall."] = 0.0,
    mesh: Annotated[
        str | PathLike[str] | None,
        FILE,
        "Section of the chamber: a mesh file, or an outline as DXF or STEP.",
    ] = None,
    mesh_unit: Annotated[
        Quantity | None, _UNIT, "Length of the mesh file's unit [default: its own, of a mesh 1 m]."
    ] = None,
    mesh_size: Annotated[
        Quantity | None, LENGTH, "Cells at the walls of an outline [default: 1/100 of its extent]."
    ] = None,
    liquid: Annotated[Any, LIQUID, "Name of the liquid, for the damping."] = "water",
    segments: Annotated[int, "Cells around the liquid, at least."] = 96,
    layers: Annotated[int, "Cells across the liquid, at least."] = 6,
    order: Annotated[int, "1: linear elements, 2: quadratic ones."] = 2,
) -> ModesAnswer:
    """Frequencies, damping and shapes of the liquid's waves. Frequencies relative to the drum.

    They are positive with the spin. A liquid is a known name, or a `leblanc.Liquid`.

    Raises
    ------
    InputError : a value out of its range, a file that cannot be used

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.modes(radius=0.15, volume="671 ml", height=0.05, speed=40.0, count=2, segments=32)
    >>> found.frequency.shape
    (2,)
    """
    return ask(modes, "leblanc.studies.modes.study:answer", locals())
