"""Figures of what takes long to measure, drawn from the measurements that are kept with the package.

`python -m validation.figures.kept --out docs/images`. The measurements themselves are made anew by `python -m
validation.trade` and `python -m validation.benchmarks --keep`.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from validation.trade.trade import TradeRecord

# Scenes whose comparison is drawn.
PICTURED = ("runup", "horizontal_rig")


def kept_trade(name: str) -> TradeRecord:
    """Kept comparison of a scene.

    Parameters
    ----------
    name : stem of the scene's file
    """
    from validation.trade import kept
    from validation.trade.judge import Comparison, Row
    from validation.trade.trade import TradeRecord

    found = kept(name)
    comparisons = []
    for question in found["questions"]:
        mine = [_numbers(row) for row in found["rows"] if row["question"] == question["question"]]
        for row in mine:
            del row["time_ratio"]
            row |= {"used": tuple(row["used"]), "resolution": _whole(row["resolution"])}
        comparisons.append(
            Comparison(
                question=question["question"],
                about=question["about"],
                reference=question["reference"],
                reference_error=_number(question["reference_error"]),
                order=_number(question["order"]),
                rows=tuple(Row(**row) for row in mine),
                dominated_by=tuple(question["default_dominated_by"]),
                overhead=_number(question["default_overhead"]),
            )
        )
    return TradeRecord(
        name=found["name"],
        source="",
        assumed=tuple(found["assumed"]),
        digest=found["digest"],
        tolerance=found["tolerance"],
        comparisons=tuple(comparisons),
    )


def _number(value: float | None) -> float:
    return math.nan if value is None else float(value)


def _whole(value: float | None) -> int | None:
    return None if value is None or math.isnan(value) else int(value)


def _numbers(row: dict[str, Any]) -> dict[str, Any]:
    """A row in which what is missing is not a number."""
    return {key: math.nan if value is None else value for key, value in row.items()}


def draw(out: Path) -> list[Path]:
    """Draw all as PNG.

    Parameters
    ----------
    out : folder, made if it is missing
    """
    from validation.benchmarks.report import accuracy_figure, growth_figure, kept_results
    from validation.trade.figure import save, trade_figure

    files = []
    for name in PICTURED:
        drawn = save(trade_figure(kept_trade(name)), out, f"trade_{name}", "Accuracy against cost")
        files.append(drawn.png)
    results = kept_results()
    files += [accuracy_figure(section, out) for section in results.sections]
    files.append(growth_figure(results.over_cells, "benchmark_cells", out))
    files.append(growth_figure(results.over_speeds, "benchmark_speeds", out))
    for file in files:
        file.with_suffix(".svg").unlink()
    return files


def main(arguments: Sequence[str] | None = None) -> None:
    """Draw the figures.

    Parameters
    ----------
    arguments : of the command line; None: the process's own
    """
    parser = argparse.ArgumentParser(prog="python -m validation.figures.kept", description=__doc__)
    parser.add_argument("--out", type=Path, required=True, help="folder of the figures")
    for file in draw(parser.parse_args(arguments).out):
        print(file)


if __name__ == "__main__":
    main()
