"""Modes of the liquid in words."""

from __future__ import annotations

from collections.abc import Sequence

from leblanc.results.modes import ModesResult
from leblanc.text.numbers import number
from leblanc.units import MM


def summary(result: ModesResult) -> list[tuple[str, str]]:
    """The main numbers of some modes, as labels and values."""
    slowest = ", ".join(number(float(sigma)) for sigma in result.frequency[:6])
    return [
        ("Chamber", result.title),
        ("Free surface at", f"{number(result.surface_radius * MM)} mm"),
        ("Slowest modes, seen from the drum", f"{slowest} rad/s"),
        ("Force ratio of a synchronous whirl", number(result.synchronous_force_ratio)),
    ]


def table_lines(result: ModesResult) -> list[str]:
    """The modes in words, equal ones on one line.

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
