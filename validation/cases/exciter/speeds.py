"""Numbers and speeds of the exciter against its source [YF17]."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import NDArray

from leblanc.wings.exciter.figure import exciter_figure
from leblanc.wings.exciter.study import answer_exciter
from meshes.arrays import Array
from solvers.rotor.exciter.machine import (
    Dimensionless,
    Exciter,
    characteristic_speeds,
    platform_motion,
    stuck_speeds,
)
from solvers.rotor.exciter.motion import (
    RANGES,
    Start,
    critical_speed,
    critical_speeds,
    integrate,
    printed_critical_speed,
)
from validation.case import Case, Claims, Effect
from validation.page import Figure, Table, logarithmic, page
from validation.study import launch, shown

CLAIMS = Claims("exciter")

# The typical experiment [YF17, section 5.3].
MACHINE = Dimensionless(smallness=0.01, drag=0.4, unbalance=0.25, damping=0.03)

COUNT = 196  # as many machines as the source integrated


def cases() -> Iterator[Case]:
    """Stuck, characteristic and critical speeds, and the worked table [YF17, section 5.2]."""
    stuck = stuck_speeds(5.0, MACHINE)
    for k, value in enumerate((0.9465, 1.0732, 4.61875)):
        yield CLAIMS.case("stuck", float(stuck[k]), number=k + 1, printed=value)
    known = characteristic_speeds(MACHINE)
    yield CLAIMS.case("n1", known.second_pair)
    yield CLAIMS.case("n2", known.through_resonance)
    yield CLAIMS.case("n3", known.merger)
    motion = integrate(MACHINE, 5.0)
    slow, fast = platform_motion(MACHINE, 5.0, motion.stuck_speed)
    off = max(abs(motion.slow / abs(slow) - 1.0), abs(motion.fast / abs(fast) - 1.0))
    together = "balls together: " + ("yes" if motion.holds else "no")
    yield CLAIMS.case("mean-speed", motion.stuck_speed, note=together)
    yield CLAIMS.case("platform", off, off <= 0.01105, difference=f"{100.0 * off:.2f} %")
    # The source's 7.0 beside the critical speed from several starts.
    starts = {"released": Start(), "rest": Start("rest", 0.3), "regime": Start("regime", 0.05)}
    holds = {name: critical_speed(MACHINE, start=start).holds for name, start in starts.items()}
    by = {name: Effect(f"critical speed, {name}", 7.0, speed) for name, speed in holds.items()}
    released, told = holds["released"], ", ".join(f"{name} {speed:.2f}" for name, speed in holds.items())
    yield CLAIMS.case(
        "critical-speed", released, True, difference=7.0 / released - 1.0, effect=by["released"]
    )
    yield CLAIMS.case("critical-speed-by-start", told, True, effect=by["regime"])
    yield CLAIMS.case("regression", float(printed_critical_speed(0.01, 0.4, 0.25, 0.03)))
    printed = {
        "smallness": (0.0126, 0.0051, 0.005),
        "drag": (0.138, 0.537, 0.005),
        "unbalance": (0.22, 0.22, 0.005),
        "damping": (0.032, 0.021, 0.02),
    }
    other = "the printed number belongs to a drag of 0.05 N s/m, not to the printed 0.03"
    for key, (empty, loaded, tolerance) in printed.items():
        for load, mass, value in (("empty", 36.1, empty), ("loaded", 90.1, loaded)):
            computed = float(getattr(vibratory_table(mass).dimensionless(), key))
            words = {"key": key, "load": load, "tolerance": tolerance, "note": other if key == "drag" else ""}
            yield CLAIMS.case("table", computed, printed=value, **words)


def sample(count: int = COUNT) -> Array:
    """Machines spread evenly over the source's ranges, shape (count, 4): Hammersley's points."""
    turns = np.arange(count)
    shares = np.stack([(turns + 0.5) / count, *(_mirrored(turns, base) for base in (2, 3, 5))], axis=-1)
    low, high = np.array(list(RANGES.values())).T
    return np.asarray(low + shares * (high - low))


def _mirrored(numbers: NDArray[np.int_], base: int) -> Array:
    """Digits of each number mirrored at the point, in the middle of what the last digit leaves open."""
    found, rest, weight = np.zeros(numbers.shape), numbers.copy(), 1.0
    while rest.any():
        weight /= base
        found += weight * (rest % base)
        rest //= base
    return found + 0.5 * weight


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


@cache
def regression(count: int = COUNT) -> Comparison:
    """Integrate the machines of `sample` in two threads and evaluate the regression."""
    values = sample(count)
    computed = critical_speeds([Dimensionless(*row) for row in values.tolist()], workers=2)
    return Comparison(values, computed, printed_critical_speed(*values.T))


def regression_table(found: Comparison | None = None) -> Table:
    """Error of the regression by the smallness; None: of all machines."""
    found, edges, rows = found or regression(), (0.005, 0.01, 0.02, 0.03, 0.05), []
    for low, high in (*pairwise(edges), (0.0, 1.0)):
        error = found.error[(found.values[:, 0] >= low) & (found.values[:, 0] < high)]
        least, middle, most = np.percentile(error, (5.0, 50.0, 95.0))
        near, fair = (np.mean(np.abs(error) <= size) for size in (0.06, 0.2))
        rows.append(
            (
                f"{low:g} to {high:g}" if low else "all",
                *(f"{error.size}", f"{100 * near:.0f} %", f"{100 * fair:.0f} %", f"{100 * middle:+.0f} %"),
                f"{100 * least:+.0f} % to {100 * most:+.0f} %",
            )
        )
    head = ("eps", "machines", "within 6 %", "within 20 %", "median error", "5 % to 95 % of the errors")
    return Table(head, tuple(rows))


def regression_figure() -> Figure:
    """Printed regression of the critical speed over that by time integration, by the smallness."""
    found = regression()
    outside = int(np.sum((found.printed <= 1.0) | (found.printed >= 100.0)))
    text = (
        f"Critical speed of {found.error.size} two-ball exciters over the ranges of YF17, by the "
        "regression printed there and by time integration (released, 0.3 rad apart). "
        f"{outside} printed values lie outside the plot."
    )
    with page([3.2], text, below=0.45) as (figure, [[axes]]):
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
        logarithmic(axes, x=[2, 5, 10, 20, 50, 100], y=[2, 5, 10, 20, 50, 100])
        axes.set(xlim=(2.0, 100.0), ylim=(2.0, 100.0))
        axes.set_xlabel("Critical speed by time integration, over the natural frequency (\N{EN DASH})")
        axes.set_ylabel("Printed regression (\N{EN DASH})")
    return figure


def start_figure() -> Figure:
    """Critical speed over the unbalance and over the smallness from several starts."""
    unbalances, small = np.linspace(0.0, 1.0, 6), np.geomspace(0.0005, 0.05, 7)
    left_machines = [Dimensionless(0.01, 0.4, float(d), 0.03) for d in unbalances]
    right_machines = [Dimensionless(float(e), 0.4, 0.25, 0.03) for e in small]
    text = (
        "Shaft speed, over the natural frequency, up to which the dual-frequency motion is "
        "reached or kept, by the start of the motion; two balls, b = 0.4, h = 0.03, no gravity."
    )
    with page([2.6], text, (2,), left=0.6, top=0.12, below=0.62, apart=0.6) as (figure, [[left, right]]):
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
        logarithmic(right, x=[0.0005, 0.001, 0.002, 0.005, 0.01, 0.02, 0.05])
        right.tick_params(axis="x", labelrotation=45)
        left.set_xlabel(
            "Unbalance \N{GREEK SMALL LETTER DELTA} (\N{EN DASH}), \N{GREEK SMALL LETTER EPSILON} = 0.01"
        )
        right.set_xlabel(
            "Smallness \N{GREEK SMALL LETTER EPSILON} (\N{EN DASH}), \N{GREEK SMALL LETTER DELTA} = 0.25"
        )
        left.set_ylabel("Critical speed n (\N{EN DASH})")
    return figure


def vibratory_table(mass: float = 90.1) -> Exciter:
    """Table of [YF17, section 5.2] with its mass, kg, that of the loaded one."""
    return Exciter(mass, 145083.0, 150.0, 0.1 * 0.105, 2, 0.325, 7.0 / 5.0, 0.0735, 0.03)


def table_figure() -> Figure:
    """Stuck speeds and vibration of the worked vibratory table."""
    speed = np.linspace(100.0, 6000.0, 296) * math.pi / 30.0
    of = {"name": "vibratory table", "assumed": ("speeds.start", "speeds.stop")}
    return exciter_figure(answer_exciter(vibratory_table(), speed, checks=8, of=of))


if __name__ == "__main__":
    figures = {"exciter_table": table_figure, "exciter_start": start_figure}
    launch(shown(regression_table, **figures, exciter_regression=regression_figure))
