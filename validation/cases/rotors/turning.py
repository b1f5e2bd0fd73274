"""Turning at high speed [ZSK18]: what can be computed of it, and where it contradicts itself."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from meshes.arrays import Array
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
    yield from _modal()
    yield from _modulations()
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


def modal_response(speed: Array, scale: float, resonances: Array, damping: Array) -> Array:
    """Amplitude of modes under one unbalance, each with the same share of it, at speeds in Hz.

    |sum_j s r_j^2/(1 - r_j^2 + 2 i zeta_j r_j)|, r_j the speed over the j-th resonance.
    """
    ratio = speed[:, None] / resonances
    modes = ratio**2 / (1.0 - ratio**2 + 2j * damping * ratio)
    return np.asarray(scale * np.abs(modes.sum(axis=1)))


def modal_fit(speed: Array, amplitude: Array, resonances: Array) -> tuple[float, Array, Array]:
    """Scale, damping ratios and amplitudes of the modes nearest to some amplitudes, by relative errors.

    The scale is the unbalance over the modes' mass: free, so that no mass is needed.
    """
    from scipy.optimize import least_squares

    def apart(logs: Array) -> Array:
        return np.log(modal_response(speed, math.exp(logs[0]), resonances, np.exp(logs[1:])) / amplitude)

    start = np.log([0.05 * float(amplitude.max()), *np.full(resonances.size, 0.04)])
    found = np.exp(least_squares(apart, start, xtol=1e-12, ftol=1e-12, gtol=1e-12).x)
    return float(found[0]), found[1:], modal_response(speed, float(found[0]), resonances, found[1:])


def _modal() -> Iterator[Case]:
    """Three modes with one free scale at the five amplitudes: four unknowns."""
    printed = dict(sorted((_PEAKS | _BETWEEN).items()))
    speed, sizes = np.array([*printed]), np.array([*printed.values()])
    scale, damping, found = modal_fit(speed, sizes, np.array([*_PEAKS]))
    words = {"damping": ", ".join(f"{ratio:.3f}" for ratio in damping), "scale": 1e3 * scale}
    for hertz, size, computed in zip(speed, sizes, found, strict=True):
        yield CLAIMS.case("modal", 1e3 * float(computed), hertz=hertz, printed=1e3 * float(size), **words)


# Depths of modulation, rpm, at a frequency, Hz, about the highest mean speed, rpm [ZSK18, section 5].
_POWER = 1500.0  # W, of the lathe 1700BF30
_DEPTHS = ((150.0, 3.0, 7000.0), (50.0, 5.0, 7000.0))
_RATE = math.pi / 30.0


def power_of_modulation(depth: float, frequency: float, mean: float) -> float:
    """Largest power that a speed mean + depth sin(2 pi f t), rpm, asks for each kg m^2, W.

    J Omega dOmega/dt at its largest, to first order in depth over mean.
    """
    return mean * _RATE * depth * _RATE * 2.0 * math.pi * frequency


def _modulations() -> Iterator[Case]:
    """The depth that inertia and power allow at 5 Hz, by that at 3 Hz; the inertia for each kilowatt."""
    bounds = [_POWER / power_of_modulation(*each) for each in _DEPTHS]
    (first, slow, mean), (second, fast, _) = _DEPTHS
    allowed = _POWER / (min(bounds) * power_of_modulation(1.0, fast, mean))
    words = {"first": first, "slow": slow, "mean": mean, "share": second / allowed}
    words |= {"least": 1e3 * bounds[0], "most": 1e3 * bounds[1]}
    yield CLAIMS.case("depth", f"{allowed:.0f} rpm at most", second <= allowed, **words)
    # For each kilowatt, g m^2; the power of the other lathe is not printed.
    own, other = 1e6 * min(bounds) / _POWER, 1e6 / power_of_modulation(180.0, 4.0, 800.0)
    told = f"{own:.2g} and {other:.2g} g m2 for each kW at most"
    yield CLAIMS.case("inertia", told, other > own)
