"""Figures and tables of the page on the exciter: `python -m validation.figures.exciter.speeds`."""

from __future__ import annotations

import argparse
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from leblanc.figures.drawing.page import Figure, Frame, lay_out, number, save, style
from leblanc.wings.exciter.figure import exciter_figure
from leblanc.wings.exciter.study import answer_exciter
from meshes.arrays import Array
from solvers.rotor.exciter.machine import Dimensionless, Exciter, characteristic_speeds
from solvers.rotor.exciter.motion import Start, critical_speeds, printed_critical_speed
from validation.cases.exciter.speeds import COUNT, sample

_FRAME = Frame(left=0.72, top=0.15, between=0.0, below=0.45)
_APART = 0.6  # inches between two plots side by side
STARTS = (
    ("released, 0.3 rad", Start("released", 0.3), {"color": "C0", "marker": "o", "linestyle": "-"}),
    ("released, together", Start("released", 0.0), {"color": "C4", "marker": "s", "linestyle": "--"}),
    ("rest, 0.3 rad", Start("rest", 0.3), {"color": "C2", "marker": "^", "linestyle": "-."}),
    ("regime, 0.05 rad", Start("regime", 0.05), {"color": "C3", "marker": "D", "linestyle": ":"}),
)
_PRINTED: dict[str, Any] = {"color": "black", "linestyle": (0, (1, 1)), "linewidth": 1.2}


@dataclass(frozen=True)
class Comparison:
    """The printed regression beside time integrations."""

    values: Array  #: eps, b, delta, h of each machine, shape (m, 4)
    computed: Array  #: critical speed by time integration, shape (m,)
    printed: Array  #: by the regression, shape (m,)

    @property
    def error(self) -> Array:
        """Printed over computed, less 1, shape (m,)."""
        return np.asarray(self.printed / self.computed - 1.0)


def compare(count: int = COUNT, workers: int = 2) -> Comparison:
    """Integrate the machines of `sample` in threads and evaluate the regression."""
    values = sample(count)
    computed = critical_speeds([Dimensionless(*row) for row in values.tolist()], workers=workers)
    return Comparison(values, computed, printed_critical_speed(*values.T))


def table(found: Comparison) -> str:
    """Error of the regression by the smallness, in Markdown."""
    lines = [
        "| eps | machines | within 6 % | within 20 % | median error | 5 % to 95 % of the errors |",
        "|---|---|---|---|---|---|",
    ]
    edges = (0.005, 0.01, 0.02, 0.03, 0.05)
    rows = [
        (f"{a:g} to {b:g}", (found.values[:, 0] >= a) & (found.values[:, 0] < b)) for a, b in pairwise(edges)
    ]
    rows.append(("all", np.ones(found.error.shape, dtype=bool)))
    for name, mine in rows:
        error = found.error[mine]
        low, middle, high = np.percentile(error, (5.0, 50.0, 95.0))
        near, fair = (np.mean(np.abs(error) <= most) for most in (0.06, 0.2))
        lines.append(
            f"| {name} | {error.size} | {100 * near:.0f} % | {100 * fair:.0f} % | {100 * middle:+.0f} % "
            f"| {100 * low:+.0f} % to {100 * high:+.0f} % |"
        )
    return "\n".join(lines)


def regression_figure(found: Comparison, directory: Path) -> Path:
    """Printed over computed critical speed, by the smallness."""
    with style():
        figure = Figure()
        axes: Any = figure.add_axes((0, 0, 1, 1))
        edges, marks = (0.005, 0.015, 0.03, 0.0501), "o^s"
        for k in range(3):
            mine = (found.values[:, 0] >= edges[k]) & (found.values[:, 0] < edges[k + 1])
            mine &= (found.printed > 1.0) & (found.printed < 100.0)
            look: dict[str, Any] = {"linestyle": "none", "marker": marks[k], "markerfacecolor": "none"}
            label = f"\N{GREEK SMALL LETTER EPSILON} from {edges[k]:g} to {edges[k + 1]:.2g}"
            axes.plot(found.computed[mine], found.printed[mine], color=f"C{k}", label=label, **look)
        line = np.array([2.0, 100.0])
        axes.plot(line, line, color="0.25", linewidth=1.0, label="equal")
        axes.fill_between(line, 0.94 * line, 1.06 * line, color="0.85", label="6 % of the source")
        for axis in ("x", "y"):
            getattr(axes, f"set_{axis}scale")("log")
            getattr(axes, f"set_{axis}lim")(2.0, 100.0)
            getattr(axes, f"set_{axis}ticks")([2, 5, 10, 20, 50, 100])
            getattr(axes, f"{axis}axis").set_major_formatter(number)
            getattr(axes, f"{axis}axis").set_minor_formatter("")
        axes.set_xlabel("Critical speed by time integration, over the natural frequency (\N{EN DASH})")
        axes.set_ylabel("Printed regression (\N{EN DASH})")
        outside = int(np.sum((found.printed <= 1.0) | (found.printed >= 100.0)))
        text = (
            f"Critical speed of {found.error.size} two-ball exciters over the ranges of YF17, by the "
            "regression printed there and by time integration (released, 0.3 rad apart). "
            f"{outside} printed values lie outside the plot."
        )
        lay_out(figure, [[axes]], [3.2], _FRAME, text)
    return save(figure, directory, "exciter_regression", "Printed regression of the critical speed").png


def start_figure(directory: Path) -> Path:
    """Critical speed over the unbalance and over the smallness from several starts."""
    unbalances, small = np.linspace(0.0, 1.0, 6), np.geomspace(0.0005, 0.05, 7)
    left_machines = [Dimensionless(0.01, 0.4, float(d), 0.03) for d in unbalances]
    right_machines = [Dimensionless(float(e), 0.4, 0.25, 0.03) for e in small]
    with style():
        figure = Figure()
        left: Any = figure.add_axes((0, 0, 1, 1), label="left")
        right: Any = figure.add_axes((0, 0, 1, 1), label="right")
        for label, start, look in STARTS:
            for axes, x, machines in ((left, unbalances, left_machines), (right, small, right_machines)):
                axes.plot(
                    x, critical_speeds(machines, start=start, workers=2), label=label, linewidth=1.2, **look
                )
        fine, inside = np.linspace(0.0, 1.0, 101), np.geomspace(0.005, 0.05, 101)
        left.plot(fine, printed_critical_speed(0.01, 0.4, fine, 0.03), label="printed regression", **_PRINTED)
        right.plot(inside, printed_critical_speed(inside, 0.4, 0.25, 0.03), **_PRINTED)
        known = characteristic_speeds(right_machines[0])
        for axes in (left, right):
            axes.axhline(known.through_resonance, color="0.45", linewidth=0.8, label="n\u2082")
            axes.set_ylim(0.0, 24.0)
        right.set_xscale("log")
        right.set_xticks([0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05])
        right.xaxis.set_major_formatter(number)
        right.xaxis.set_minor_formatter("")
        right.tick_params(axis="x", labelrotation=45)
        left.set_xlabel(
            "Unbalance \N{GREEK SMALL LETTER DELTA} (\N{EN DASH}), \N{GREEK SMALL LETTER EPSILON} = 0.01"
        )
        right.set_xlabel(
            "Smallness \N{GREEK SMALL LETTER EPSILON} (\N{EN DASH}), \N{GREEK SMALL LETTER DELTA} = 0.25"
        )
        left.set_ylabel("Critical speed n (\N{EN DASH})")
        text = (
            "Shaft speed, over the natural frequency, up to which the dual-frequency motion is "
            "reached or kept, by the start of the motion; two balls, b = 0.4, h = 0.03, no gravity."
        )
        lay_out(figure, [[left, right]], [2.6], Frame(left=0.6, top=0.12, between=0.0, below=0.62), text)
        for axes in (left, right):
            box = axes.get_position()
            shift = 0.5 * _APART / 6.3 if axes is right else 0.0
            axes.set_position((box.x0 + shift, box.y0, box.width - 0.5 * _APART / 6.3, box.height))
    return save(figure, directory, "exciter_start", "Critical speed by the start of the motion").png


def vibratory_table(ball_damping: float = 0.03) -> Exciter:
    """Loaded table of [YF17, section 5.2]; drag of the race on a ball, N s/m."""
    return Exciter(90.1, 145083.0, 150.0, 0.1 * 0.105, 2, 0.325, 7.0 / 5.0, 0.0735, ball_damping)


def machine_figure(directory: Path) -> Path:
    """Stuck speeds and vibration of the worked vibratory table."""
    speed = np.linspace(100.0, 6000.0, 296) * math.pi / 30.0
    of = {"name": "vibratory table", "assumed": ("speeds.start", "speeds.stop")}
    record = answer_exciter(vibratory_table(), speed, checks=8, of=of)
    return save(exciter_figure(record), directory, "exciter_table", "Vibratory table").png


def main() -> None:
    """Draw all figures and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("docs/images"))
    parser.add_argument("--count", type=int, default=COUNT)
    options = parser.parse_args()
    found = compare(options.count)
    for path in (
        machine_figure(options.out),
        start_figure(options.out),
        regression_figure(found, options.out),
    ):
        path.with_suffix(".svg").unlink()
        print(path)
    print(table(found))


if __name__ == "__main__":
    main()
