"""The result of a sweep as text."""

from __future__ import annotations

from leblanc.core.notes import one_line
from leblanc.core.units import ANGULAR_SPEED, LENGTH, MASS, Unit, amplitude_sentence, amplitudes_are, unit_for
from leblanc.results.sweep import SweepResult

_SHARED = ("peak_amplitude", "last_amplitude", "peak_growth")  # whose sensitivities are shown


def lines(result: SweepResult) -> list[str]:
    """Statistics and sensitivities for a terminal."""
    found = [f"{'':24}{'mean':>12}{'deviation':>12}{'5 %':>12}{'50 %':>12}{'95 %':>12}  unit"]
    for name, values in result.single.items():
        numbers = [
            float(values.mean[0]),
            float(values.deviation[0]),
            *values.quantiles[0, [0, 2, 4]].tolist(),
        ]
        unit = _unit(result.units[name], numbers)
        cells = "".join(f"{unit.number(x):>12}" for x in numbers)
        found.append(f"{name.replace('_', ' '):24}{cells}  {unit.name}")
    return [*found, amplitude_sentence(result.plane), *_shares(result), f"The data are in {result.store}"]


def _unit(written: str, numbers: list[float]) -> Unit:
    """Unit in which a person would write an output."""
    for dimension in (LENGTH, MASS, ANGULAR_SPEED):
        if written == dimension.unit.replace("rad/s", "rad s-1"):
            return unit_for(dimension, *numbers)
    return Unit(written.replace("s-1", "1/s"), 1.0)


def _shares(result: SweepResult) -> list[str]:
    """Shares of the variance, a line for each field."""
    found = []
    for name in _SHARED:
        indices = result.sensitivities[name]
        if indices is None or (name == "peak_amplitude" and result.speeds == 1):
            continue
        found.append(f"share of the variance of {name.replace('_', ' ')} ({indices.method}):")
        for j, field in enumerate(result.fields):
            line = f"  {field:30} first {indices.first[j]:7.3f}"
            if indices.first_interval is not None:
                line += f" +- {indices.first_interval[j]:.3f}"
            if indices.total is not None and indices.total_interval is not None:
                line += f"   total {indices.total[j]:7.3f} +- {indices.total_interval[j]:.3f}"
            found.append(line)
    return found


def summary(result: SweepResult) -> list[tuple[str, str]]:
    """Main numbers: label and value."""
    rows = [
        ("Scene", one_line(result.scene)),
        ("Samples done", f"{result.done} of {result.samples}, {result.method}, seed {result.seed}"),
        ("Varied", ", ".join(result.fields)),
    ]
    rows.append(amplitudes_are(result.plane))
    if result.speeds > 1:
        rows.append(("Largest amplitude", spread(result, "peak_amplitude")))
        rows.append(("Largest amplitude without liquid", spread(result, "peak_amplitude_dry")))
    rows.append(("Amplitude at the last speed", spread(result, "last_amplitude")))
    rows.append(("The same without liquid", spread(result, "last_amplitude_dry")))
    return rows


def spread(result: SweepResult, name: str) -> str:
    """Median of an amplitude and the range of nine samples in ten."""
    sizes = [float(size) for size in result.single[name].quantiles[0, [0, 2, 4]]]
    unit = unit_for(LENGTH, *sizes)
    low, middle, high = map(unit.number, sizes)
    return f"{middle} {unit.name}, nine in ten from {low} to {high} {unit.name}"


def alt(result: SweepResult) -> str:
    """What the figure shows and the numbers a reader would take from it."""
    if result.speed is not None and result.speed.size > 1:
        what = "Median and ranges of the amplitude over speed; largest amplitude"
        return f"{what}: {spread(result, 'peak_amplitude')}."
    what = "Boxes with the quantiles of the amplitudes and of the growth rate; amplitude at the last speed"
    return f"{what}: {spread(result, 'last_amplitude')}."
