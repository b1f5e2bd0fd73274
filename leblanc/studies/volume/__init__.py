"""Volumes that wet a chamber's wall at a deflection, and the free surface of a given volume."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from leblanc.core.question import Quantity, ask
from leblanc.core.units import ACCELERATION, ANGULAR_SPEED, LENGTH, VOLUME

if TYPE_CHECKING:
    from leblanc.studies.volume.answer import VolumeAnswer


def volume(
    *,
    radius: Annotated[Quantity, LENGTH, "Wall radius."],
    height: Annotated[Quantity, LENGTH, "Height of the chamber along the axis."],
    eccentricity: Annotated[Quantity, LENGTH, "Deflection: distance of the rotation axis."],
    speed: Annotated[Quantity, ANGULAR_SPEED, "Spin speed."],
    volume: Annotated[Quantity | None, VOLUME, "Volume of the liquid; adds its surface."] = None,
    gravity: Annotated[Quantity, ACCELERATION, "Gravity along the axis."] = 9.81,
    inner_radius: Annotated[Quantity, LENGTH, "Inner wall radius."] = 0.0,
) -> VolumeAnswer:
    """Volumes that wet the wall at the floor and up to the lid. Also the surface of a given volume.

    Along an upright axis more liquid than wets the wall at the floor still adds to its unbalance, up to the
    volume that wets it to the lid. Without gravity along the axis, as on a horizontal one, both are one.

    Raises
    ------
    InputError : a value out of its range, more liquid than the chamber holds

    Examples
    --------
    >>> import leblanc as lb
    >>> best = lb.volume(radius=0.2, height=0.05, eccentricity="1 mm", speed=90.0)
    >>> f"{1e6 * best.optimal_volume:.4f} ml"
    '54.4396 ml'
    >>> f"{1e6 * best.full_volume:.2f} ml up to the lid, {1e6 * best.lid_volume:.2f} ml touch it"
    '72.19 ml up to the lid, 1.26 ml touch it'
    """
    return ask(_volume, "leblanc.studies.volume.study:answer_volume", locals())


_volume = volume  # a parameter has its name
