"""Figures of what takes long to measure, drawn from the measurements that are kept with the package.

`python -m validation.figures.kept --out docs/images`. The measurements themselves are made anew by `python -m
validation.trade` and `python -m validation.benchmarks --keep`.
"""

from __future__ import annotations

from pathlib import Path

from validation.study import launch

# Scenes whose comparison is drawn.
PICTURED = ("runup", "horizontal_rig")


def draw(out: Path) -> list[Path]:
    """Draw all as PNG."""
    from leblanc.figures.drawing.page import save_png
    from validation.benchmarks.report import accuracy_figure, growth_figure, kept_results
    from validation.trade import again
    from validation.trade.figure import trade_figure

    files = []
    for name in PICTURED:
        figure = trade_figure(again.record(name))
        files.append(save_png(figure, out, f"trade_{name}", "Accuracy against cost"))
    results = kept_results()
    files += [accuracy_figure(section, out) for section in results.sections]
    files.append(growth_figure(results.over_cells, "benchmark_cells", out))
    files.append(growth_figure(results.over_speeds, "benchmark_speeds", out))
    return files


if __name__ == "__main__":
    launch(draw)
