"""The liquid alone as text: optimal volume, layer under a whirl, modes."""

from __future__ import annotations

import cmath
import math
from collections.abc import Sequence

from leblanc.results.layer import LayerPeriodsResult, LayerResult, Number
from leblanc.results.liquid import ModesResult, VolumeResult
from leblanc.text.numbers import number
from leblanc.units import ML, MM, RPM


def question(result: VolumeResult) -> str:
    """What was understood, in engineers' units."""
    chamber = result.chamber
    inner = f", inner radius {chamber.inner_radius * MM:.6g} mm" if chamber.inner_radius > 0.0 else ""
    return (
        f"Chamber of radius {chamber.radius * MM:.6g} mm{inner}, height {chamber.height * MM:.6g} mm; "
        f"deflection {result.eccentricity * MM:.6g} mm at {result.speed * RPM:.6g} rpm"
    )


def facts(result: VolumeResult) -> list[tuple[str, str]]:
    """The answer: label and value with its unit."""
    rows = [
        ("optimal volume", _volume(result.optimal_volume)),
        ("by finite elements", _volume(result.optimal_volume_fem)),
        ("relative difference", f"{result.fem_error:.2g}"),
        ("as printed, DR18 eq. 18", _volume(result.printed_eq18)),
        ("the same, corrected", _volume(result.corrected_eq18)),
    ]
    surface = result.surface
    if surface is None:
        return rows
    constant = surface.surface_constant
    return [
        *rows,
        ("surface constant", "none" if constant is None else f"{constant:.10g} m"),
        ("unbalance volume", f"{surface.unbalance_volume:.10g} m^4"),
        ("by finite elements", f"{surface.unbalance_volume_fem:.10g} m^4"),
        ("case", f"{surface.case.value}: {surface.case.message}"),
        ("converged", str(surface.converged).lower()),
    ]


def _volume(value: float | None) -> str:
    return "none" if value is None else f"{value * ML:.10g} ml"


def layer_summary(result: LayerResult) -> list[tuple[str, str]]:
    """The main numbers of a layer's answer, as labels and values."""
    return [
        ("Liquid model", result.case.model),
        ("Force ratio", _at_angle(result.force_ratio, 1.0, "")),
        ("Centre of mass", _at_angle(result.offset, MM, " mm")),
        ("Mean rotation in the drum", f"{number(result.mean_rotation)} rad/s"),
        *_validity(result.converged, result.in_range, result.validity),
    ]


def periods_summary(result: LayerPeriodsResult) -> list[tuple[str, str]]:
    """The main numbers of a layer from rest, as labels and values."""
    h = result.history
    if not h.time.size:
        return [("Liquid model", result.case.model), ("Answer", h.reason)]
    return [
        ("Liquid model", result.case.model),
        ("Whirl periods", f"{h.time.size}"),
        ("Force ratio of the last one", _at_angle(complex(h.force_ratio[-1]), 1.0, "")),
        ("Mean rotation in the drum", f"{number(float(h.mean_rotation[-1]))} rad/s"),
        *_validity(result.converged, result.in_range, result.validity),
    ]


def _validity(converged: bool, in_range: bool, numbers: tuple[Number, ...]) -> list[tuple[str, str]]:
    """Whether there is an answer that holds."""
    wrong = "; ".join(str(entry) for entry in numbers if not entry.in_range)
    verdict = "yes" if in_range else wrong or "no"
    return [("Converged", "yes" if converged else "no"), ("Model in range", verdict)]


def _at_angle(value: complex, factor: float, unit: str) -> str:
    """Size and angle from the deflection."""
    if not cmath.isfinite(value):
        return "not found"
    angle = f"{math.degrees(cmath.phase(value)):.0f} deg from the deflection"
    return f"{number(abs(value) * factor)}{unit} at {angle}"


def modes_summary(result: ModesResult) -> list[tuple[str, str]]:
    """The main numbers of some modes, as labels and values."""
    slowest = ", ".join(number(float(sigma)) for sigma in result.frequency[:6])
    return [
        ("Chamber", result.title),
        ("Free surface at", f"{number(result.surface_radius * MM)} mm"),
        ("Slowest modes, seen from the drum", f"{slowest} rad/s"),
        ("Force ratio of a synchronous whirl", number(result.synchronous_force_ratio)),
    ]


def modes_table(result: ModesResult) -> list[str]:
    """The modes as text, equal ones on one line.

    Parameters
    ----------
    result : the modes
    """
    lines = [
        f"{'rad/s':>12}{'times':>7}{'crests':>8}  {'runs':<9}{'exact':>12}{'error':>9}"
        f"{'decay 1/s':>11}{'ratio':>9}"
    ]
    k = 0
    while k < len(result.frequency):
        sigma, same = result.frequency[k], int(result.multiplicity[k])
        exact, error = result.exact[k], result.error_estimate
        cells: Sequence[str] = (
            f"{sigma:12.6g}", f"{same if same > 1 else '':>7}", f"{result.crests[k]:8d}",
            f"  {_runs(sigma, float(result.travelling[k])):<9}",
            f"{'' if exact is None else f'{exact:.6g}':>12}",
            f"{error[k]:>9.1g}",
            f"{result.damping[k]:11.4g}", f"{result.damping_ratio[k]:9.2g}",
        )  # fmt: skip
        lines.append("".join(cells))
        k += same
    return lines


def _runs(frequency: float, travelling: float) -> str:
    """Which way the crests run."""
    if abs(travelling) < 0.5:
        return "stands"
    return "with" if frequency > 0.0 else "against"
