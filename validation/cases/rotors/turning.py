"""Turning at high speed [ZSK18]: what can be computed of it, and where it contradicts itself."""

from __future__ import annotations

import math
from collections.abc import Iterator

from validation.case import Case, Claims

CLAIMS = Claims("turning")


def speed(cutting_speed: float, diameter: float) -> float:
    """Speed of a workpiece cut at this diameter, m, turns per second [theory: spindle, eq. 20]."""
    return cutting_speed / (math.pi * diameter)


def cases() -> Iterator[Case]:
    """Speeds of workpieces, resonances as speeds, the statements on modulation."""
    yield CLAIMS.case("300-m-min", speed(300.0 / 60.0, 0.020) * 60.0)
    need, least = speed(500.0 / 60.0, 0.020) * 60.0, 1e3 * (speed(500.0 / 60.0, 1.0) * 60.0 / 15_000.0)
    yield CLAIMS.case("500-m-min", need, 6000.0 < need < 10_000.0)
    note = f"10 mm need {speed(500.0 / 60.0, 0.010) * 60.0:.0f} rpm"
    yield CLAIMS.case("10-mm", least, 10.0 <= least < 11.0, note=note)
    yield from _resonances()
    yield CLAIMS.case(
        "modulation",
        note="only the lathe 16K20T1 shows it, Ra 1.7 to 0.8 um, at 40 m/min on 60 mm: "
        f"{speed(40.0 / 60.0, 0.060) * 60.0:.0f} rpm, not a high speed",
    )
    yield CLAIMS.case("amplitude")


# Amplitudes of the idling spindle, mm, by its speed, Hz: at resonances and between them [ZSK18, section 5].
_PEAKS = {135.0: 0.013, 152.0: 0.017, 166.0: 0.022}
_BETWEEN = {143.0: 0.009, 160.0: 0.012}


def single_mode_damping(resonance: float, off: float, share: float) -> float:
    """Damping ratio of the one mode whose unbalance response off resonance (Hz) is a share of that at it.

    The answer over that of a free mass is r^2/|1 - r^2 + 2 i zeta r|, r the speed over the resonance without
    damping; the share lies below 1 and off/resonance.
    """
    ratio = off / resonance
    return share * abs(1.0 - ratio**2) / (2.0 * ratio * math.sqrt(ratio**2 - share**2))


def _resonances() -> Iterator[Case]:
    """Whether the three are told apart: the width of each at half its power is below the way to the next.

    Each is taken as a mode by itself. Its neighbours have a share in what is seen beside it: of the two sides
    the one that asks for less damping counts.
    """
    for hertz, amplitude in _PEAKS.items():
        beside = {off: size for off, size in _BETWEEN.items() if abs(off - hertz) < 10.0}
        ratios = [single_mode_damping(hertz, off, size / amplitude) for off, size in beside.items()]
        width, gap = 2.0 * min(ratios) * hertz, min(abs(hertz - other) for other in _PEAKS if other != hertz)
        yield CLAIMS.case(
            "resonance",
            width,
            width < gap,
            **{"hertz": hertz, "rpm": 60.0 * hertz, "beside": " and ".join(f"{off:.0f}" for off in beside)},
            **{"gap": gap, "share": width / gap, "damping": min(ratios)},
        )
