"""A run-up as text."""

from __future__ import annotations

from leblanc.results.runup import RunupResult
from leblanc.text.numbers import number
from leblanc.units import MM, RPM


def describe_model(model: str, cells: int, dispersion: bool) -> str:
    """Liquid model of a run-up with its resolution.

    Parameters
    ----------
    model : "long_wave" or "linear"
    cells : round each wall
    dispersion : of the finite depth
    """
    if model == "linear":
        return f"exact linear theory in time, steps as of {cells} cells"
    shallow = "with dispersion" if dispersion else "without dispersion"
    return f"annular long waves in time, {cells} cells, {shallow}"


def moments(result: RunupResult) -> list[tuple[str, int]]:
    """Label and index of the main samples: the largest amplitudes and the end."""
    found = [("Largest on the way up" if result.turns_back else "Largest amplitude", result.peak_index())]
    if result.turns_back:
        found.append(("Largest on the way down", result.peak_index(back=True)))
    return [*found, ("At the end", result.time.size - 1)]


def largest(result: RunupResult) -> str:
    """The largest amplitude on the way up and where it was."""
    k = result.peak_index()
    size, speed = number(float(result.amplitude[k]) * MM), number(float(result.speed[k]) * RPM)
    return f"{size} mm at {speed} rpm"


def summary(result: RunupResult) -> list[tuple[str, str]]:
    """The main numbers of a run-up, as labels and values."""

    def value(k: int) -> str:
        size, speed = number(float(result.amplitude[k]) * MM), number(float(result.speed[k]) * RPM)
        return f"{size} mm at {speed} rpm, after {number(float(result.time[k]))} s"

    return [
        *((label, value(k)) for label, k in moments(result)),
        ("Liquid model", describe_model(result.model, result.cells, result.dispersion)),
        ("End", result.reason or "it came to its end"),
    ]
