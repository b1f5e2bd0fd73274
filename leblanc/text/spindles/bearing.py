"""The frequencies of a rolling bearing as text."""

from __future__ import annotations

import math

from leblanc.results.spindles.bearing import BearingResult
from leblanc.text.numbers import number
from leblanc.text.spindles.unit import hertz
from leblanc.units import in_rpm

NAMES = {
    "ftf": "Cage, FTF",
    "bpfo": "Outer ring, BPFO",
    "bpfi": "Inner ring, BPFI",
    "bsf": "Ball, BSF",
}
HEAD = ("Frequency", "Hz", "over the shaft's", "given", "computed less given")


def bearing_words(result: BearingResult) -> str:
    """The bearing in one sentence."""
    angle = number(math.degrees(result.contact_angle)) if result.contact_angle > 1e-6 else "0"
    return (
        f"{result.balls} balls, ball over pitch diameter {number(result.diameter_ratio)}, contact angle "
        f"{angle} deg, shaft at {in_rpm(result.speed)} ({hertz(result.speed)})"
    )


def frequency_rows(result: BearingResult) -> list[tuple[str, ...]]:
    """A row for each frequency: cells of `HEAD`.

    Parameters
    ----------
    result : the answer
    """
    lines = []
    for name, text in NAMES.items():
        order = result.orders[name]
        cells = [text, number(order * result.speed / (2.0 * math.pi)), number(order)]
        if name in result.given:
            off = order / result.given[name] - 1.0
            cells += [number(result.given[name]), f"{100.0 * off:+.2f} %"]
        else:
            cells += ["", ""]
        lines.append(tuple(cells))
    return lines


def rows(result: BearingResult) -> list[tuple[str, str]]:
    """What follows besides the frequencies, and the frequencies: label and value.

    Parameters
    ----------
    result : the answer
    """
    return [
        ("Bearing", bearing_words(result)),
        *((c[0], f"{c[1]} Hz") for c in frequency_rows(result)),
        *more(result),
    ]


def more(result: BearingResult) -> list[tuple[str, str]]:
    """The fit and the slip: label and value.

    Parameters
    ----------
    result : the answer
    """
    found, fit = [], result.fit
    if fit is not None:
        spread = "" if math.isnan(fit.projected_ratio_std) else f" +- {number(fit.projected_ratio_std)}"
        found.append(("d cos(theta)/D", f"{number(fit.projected_ratio)}{spread}"))
        if "bsf" in result.given:
            found.append(("Contact angle", _angle(result)))
        found.append(("Residual, root mean square", f"{100.0 * fit.residual_rms:.2g} %"))
        if fit.next_balls:
            found.append((f"With {fit.next_balls} balls, the second best", f"{100.0 * fit.next_rms:.2g} %"))
    if result.slip is not None:
        found.append(("Slip of the cage", f"{100.0 * result.slip:.3g} %"))
    return found


def _angle(result: BearingResult) -> str:
    """The contact angle, and from where to where it may lie by one standard error of its cosine."""
    fit, angle = result.fit, math.degrees(result.contact_angle)
    assert fit is not None
    if math.isnan(fit.cosine_std):
        return f"{number(angle)} deg" if angle > 1e-4 else "0 deg, the end of its range"
    low, high = (math.degrees(math.acos(min(1.0, fit.cosine + s * fit.cosine_std))) for s in (1.0, -1.0))
    return f"{number(angle)} deg, {number(low)} to {number(high)} deg by one standard error"
