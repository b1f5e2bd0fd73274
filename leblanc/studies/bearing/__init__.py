"""Frequencies of a rolling bearing, a bearing from its frequencies, slip of its cage."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from leblanc.core.question import Quantity, ask
from leblanc.core.units import ANGLE, ANGULAR_SPEED, LENGTH

if TYPE_CHECKING:
    from leblanc.studies.bearing.answer import BearingAnswer


def bearing(
    *,
    speed: Annotated[Quantity, ANGULAR_SPEED, "Speed of the shaft; the outer ring is at rest."],
    balls: Annotated[int | None, "Balls or rollers in one row [default: sought from frequencies]."] = None,
    ball_diameter: Annotated[Quantity | None, LENGTH, "Diameter of a ball."] = None,
    pitch_diameter: Annotated[
        Quantity | None, LENGTH, "Diameter of the circle of the balls' centres."
    ] = None,
    contact_angle: Annotated[
        Quantity | None, ANGLE, "Contact angle [default: 0; sought where bsf is given]."
    ] = None,
    ftf: Annotated[float | None, "Frequency of the cage over the shaft's."] = None,
    bpfo: Annotated[float | None, "Frequency of the outer ring over the shaft's."] = None,
    bpfi: Annotated[float | None, "Frequency of the inner ring over the shaft's."] = None,
    bsf: Annotated[float | None, "Frequency of a ball over the shaft's."] = None,
    cage: Annotated[Quantity | None, ANGULAR_SPEED, "Measured speed of the cage; adds its slip."] = None,
) -> BearingAnswer:
    """Frequencies of a rolling bearing from its dimensions, or the bearing that is nearest to frequencies.

    Raises
    ------
    InputError : a value out of its range, dimensions beside frequencies, too few of either

    Examples
    --------
    >>> import leblanc as lb
    >>> lb.bearing(speed="33 Hz", ftf=0.38475, bpfi=5.5369, bsf=2.0497).balls
    9
    """
    return ask(bearing, "leblanc.studies.bearing.study:answer_bearing", locals())
