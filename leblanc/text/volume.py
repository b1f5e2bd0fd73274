"""The optimal volume of a chamber in words."""

from __future__ import annotations

from leblanc.results.volume import VolumeResult
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
