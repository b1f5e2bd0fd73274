"""Turning at high speed [ZSK18]: what can be computed of it, and where it contradicts itself."""

from __future__ import annotations

import math

from validation.cases.case import MEASURED, Case, compare


def speed(cutting_speed: float, diameter: float) -> float:
    """Speed of a workpiece, turns per second [theory: spindle, eq. 20].

    Parameters
    ----------
    cutting_speed : m/s
    diameter : of the workpiece where it is cut, m
    """
    return cutting_speed / (math.pi * diameter)


def cases() -> list[Case]:
    """Speeds of workpieces, resonances as speeds, the statements on modulation."""
    return [*_speeds(), *_resonances(), *_contradictions()]


def _speeds() -> list[Case]:
    text = "the text says almost 5000, a round number"
    need = speed(500.0 / 60.0, 0.020) * 60.0
    least = speed(500.0 / 60.0, 1.0) * 60.0 / 15_000.0
    return [
        compare(
            "turning/300-m-min",
            "ZSK18, section 2",
            "speed of a workpiece of 20 mm at 300 m/min, rpm",
            5000.0,
            speed(300.0 / 60.0, 0.020) * 60.0,
            tolerance=0.05,
            note=text,
        ),
        Case(
            name="turning/500-m-min",
            source="ZSK18, section 2",
            quantity="speed of a workpiece of 20 mm at 500 m/min, rpm",
            printed="only specialised lathes reach it",
            computed=need,
            difference="in words",
            verdict="agrees" if 6000.0 < need < 10_000.0 else "differs",
            note="usual lathes of the list end at 6000 rpm, those named for it begin at 10 000",
        ),
        Case(
            name="turning/10-mm",
            source="ZSK18, section 2",
            quantity="least diameter that turns at 500 m/min, of a lathe of 15 000 rpm, mm",
            printed="lathes of 10 000 and 15 000 rpm do not reach it on less than 10 mm",
            computed=1e3 * least,
            difference="in words",
            verdict="agrees" if 10.0 <= 1e3 * least < 11.0 else "differs",
            note=f"10 mm need {speed(500.0 / 60.0, 0.010) * 60.0:.0f} rpm",
        ),
    ]


# Amplitudes at resonances and between them, by frequency, Hz and mm [ZSK18, section 5].
_PEAKS = {135.0: 0.013, 152.0: 0.017, 166.0: 0.022}
_BETWEEN = {143.0: 0.009, 160.0: 0.012}


def largest_damping(resonance: float, off: float, share: float) -> float:
    """Damping ratio of one mode whose amplitude off resonance is a share of that at it.

    Parameters
    ----------
    resonance, off : frequencies, the first without damping, Hz
    share : of the amplitudes, below 1
    """
    ratio = (off / resonance) ** 2
    return share * abs(1.0 - ratio) / (2.0 * math.sqrt(1.0 - share**2 * ratio))


def _resonances() -> list[Case]:
    """Whether each of the three is one of its own: its width at half the power below the distance to the next.

    What is seen between two resonances is of both and more, so that the damping of one alone is no larger than
    what would make all of it.
    """
    found = []
    for hertz, amplitude in _PEAKS.items():
        zeta = min(
            largest_damping(hertz, off, size / amplitude)
            for off, size in _BETWEEN.items()
            if abs(off - hertz) < 10.0
        )
        width = 2.0 * zeta * hertz
        gap = min(abs(hertz - other) for other in _PEAKS if other != hertz)
        found.append(
            Case(
                name=f"turning/resonance-{hertz:.0f}",
                source="ZSK18, section 5",
                quantity=f"width of the resonance of {hertz:.0f} Hz at half the power, at most, Hz",
                printed=f"one of three, {gap:.0f} Hz from the next",
                computed=width,
                difference=f"{width / gap:.2f} of the distance",
                verdict="agrees" if width < gap else "differs",
                note=f"damping ratio {zeta:.3f} at most, by the amplitudes printed at it and at 143 and 160 Hz; "
                f"as a speed of the spindle {60.0 * hertz:.0f} rpm; neither mass nor stiffness is given",
                origin=MEASURED,
            )
        )
    return found


def _contradictions() -> list[Case]:
    return [
        Case(
            name="turning/modulation",
            source="ZSK18, section 5 and conclusion 3",
            quantity="does modulating the speed at 1 to 5 Hz smooth the surface at 4500 rpm and more",
            printed="conclusion 3: proved, as a way to the least roughness",
            computed="section 5, lathe 1700BF30: no clear result, within one class and within the "
            "error of the instrument",
            difference="the two statements exclude one another",
            verdict="erratum",
            note="only the lathe 16K20T1 shows it, Ra 1.7 to 0.8 um, at 40 m/min on 60 mm: "
            f"{speed(40.0 / 60.0, 0.060) * 60.0:.0f} rpm, not a high speed",
        ),
        Case(
            name="turning/amplitude",
            source="ZSK18, section 5",
            quantity="amplitude of the tool's vibration over the speed",
            printed="0.005 to 0.01 mm at idle; 0.2 to 0.45 um over tool positions",
            computed=f"a factor of {5.0 / 0.45:.0f} to {10.0 / 0.2:.0f} between two figures of one lathe",
            difference="not explained; different quantities or units",
            verdict="differs",
            note="figures 7 and 9; nothing in the text relates them",
        ),
    ]
