"""Figures of what takes long to measure, drawn from the measurements that are kept with the package.

`python -m validation.figures.kept --out docs/images`. The measurements themselves are made anew by `python -m
validation.trade` and `python -m validation.benchmarks --keep`.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path

# Scenes whose comparison is drawn.
PICTURED = ("runup", "horizontal_rig")


def draw(out: Path) -> list[Path]:
    """Draw all as PNG."""
    from validation.benchmarks.report import accuracy_figure, growth_figure, kept_results
    from validation.trade import again
    from validation.trade.figure import save, trade_figure

    files = []
    for name in PICTURED:
        drawn = save(trade_figure(again.record(name)), out, f"trade_{name}", "Accuracy against cost")
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
