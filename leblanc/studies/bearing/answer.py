"""What `bearing` answers: frequencies of a rolling bearing, what they tell of it, slip of its cage."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from leblanc.core.answer import Answer
from leblanc.core.blocks import Block, Picture, Table, Words
from leblanc.core.units import in_rpm, number
from meshes.quantity import Q
from solvers.rotor.rolling_bearing import Bearing, BearingFit

NAMES = {
    "ftf": "Cage, FTF",
    "bpfo": "Outer ring, BPFO",
    "bpfi": "Inner ring, BPFI",
    "bsf": "Ball, BSF",
}
HEAD = ("Frequency", "Hz", "over the shaft's", "given", "computed less given")
HERTZ = 0.5 / math.pi  # in one rad/s


@dataclass(frozen=True)
class BearingAnswer(Answer):
    """Frequencies of a bearing at one speed of its shaft, the outer ring at rest.

    Examples
    --------
    >>> import leblanc as lb
    >>> found = lb.bearing(speed="33 Hz", balls=9, ball_diameter="7.144 mm", pitch_diameter="31 mm")
    >>> round(found.bpfo / (2 * 3.141592653589793), 1)  # Hz
    114.3
    """

    command = "bearing"
    figure = "leblanc.studies.bearing.figure:bearing_figure"

    bearing: Bearing  #: number of balls, ratio of diameters, contact angle
    speed: Annotated[float, Q("rad s-1", "speed of the shaft", coordinate=True)]
    orders: Annotated[dict[str, float], Q("1", text="frequencies over the shaft's, by name", data=False)]
    given: Annotated[dict[str, float], Q("1", text="those to which the bearing was fitted", data=False)]
    fit: Annotated[BearingFit | None, Q(text="how it was fitted; None where its dimensions were given")]
    cage_measured: Annotated[float | None, Q("rad s-1", "measured speed of the cage", data=False)]
    slip: Annotated[float | None, Q("1", "slip of the cage", by="spindle, eq. 19")]

    @property
    def ftf(self) -> Annotated[float, Q("rad s-1", "frequency", "of the cage", by="spindle, eq. 17")]:
        return self.orders["ftf"] * self.speed

    @property
    def bpfo(self) -> Annotated[float, Q("rad s-1", "frequency", "outer ring", by="spindle, eq. 17")]:
        return self.orders["bpfo"] * self.speed

    @property
    def bpfi(self) -> Annotated[float, Q("rad s-1", "frequency", "inner ring", by="spindle, eq. 17")]:
        return self.orders["bpfi"] * self.speed

    @property
    def bsf(self) -> Annotated[float, Q("rad s-1", "frequency", "of a ball", by="spindle, eq. 17")]:
        return self.orders["bsf"] * self.speed

    @property
    def balls(self) -> Annotated[int, Q("1", "balls in a row")]:
        return self.bearing.balls

    @property
    def diameter_ratio(self) -> Annotated[float, Q("1", "ball over pitch diameter")]:
        return self.bearing.diameter_ratio

    @property
    def contact_angle(self) -> Annotated[float, Q("rad", "contact angle")]:
        return self.bearing.contact_angle

    def blocks(self) -> tuple[Block, ...]:
        columns = len(HEAD) if self.given else 3
        rows = tuple(row[:columns] for row in frequency_rows(self))
        return (
            Words(bearing_words(self)),
            Table(rows, HEAD[:columns], right=True),
            Table(_more(self)),
            Picture("bearing", "Frequencies of a rolling bearing", self.figure),
        )


def bearing_words(answer: BearingAnswer) -> str:
    """The bearing in one sentence."""
    angle = number(math.degrees(answer.contact_angle)) if answer.contact_angle > 1e-6 else "0"
    return (
        f"{answer.balls} balls, ball over pitch diameter {number(answer.diameter_ratio)}, contact angle "
        f"{angle} deg, shaft at {in_rpm(answer.speed)} ({number(answer.speed * HERTZ)} Hz)"
    )


def frequency_rows(answer: BearingAnswer) -> list[tuple[str, ...]]:
    """A row for each frequency: cells of `HEAD`."""
    rows: list[tuple[str, ...]] = []
    for name, text in NAMES.items():
        order, given = answer.orders[name], answer.given.get(name)
        off = ("", "") if given is None else (number(given), f"{100.0 * (order / given - 1.0):+.2f} %")
        rows.append((text, number(order * answer.speed * HERTZ), number(order), *off))
    return rows


def _more(answer: BearingAnswer) -> tuple[tuple[str, str], ...]:
    """The fit and the slip: label and value."""
    found, fit = [], answer.fit
    if fit is not None:
        spread = "" if math.isnan(fit.projected_ratio_std) else f" +- {number(fit.projected_ratio_std)}"
        found.append(("d cos(theta)/D", f"{number(fit.projected_ratio)}{spread}"))
        if "bsf" in answer.given:
            found.append(("Contact angle", _angle(answer.contact_angle, fit)))
        found.append(("Residual, root mean square", f"{100.0 * fit.residual_rms:.2g} %"))
        if fit.next_balls:
            found.append((f"With {fit.next_balls} balls, the second best", f"{100.0 * fit.next_rms:.2g} %"))
    if answer.slip is not None:
        found.append(("Slip of the cage", f"{100.0 * answer.slip:.3g} %"))
    return tuple(found)


def _angle(contact_angle: float, fit: BearingFit) -> str:
    """The contact angle, and from where to where it may lie by one standard error of its cosine."""
    angle = math.degrees(contact_angle)
    if math.isnan(fit.cosine_std):
        return f"{number(angle)} deg" if angle > 1e-4 else "0 deg, the end of its range"
    low, high = (math.degrees(math.acos(min(1.0, fit.cosine + s * fit.cosine_std))) for s in (1.0, -1.0))
    return f"{number(angle)} deg, {number(low)} to {number(high)} deg by one standard error"
