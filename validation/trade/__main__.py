"""`python -m validation.trade`: measure the scenes whose results are kept again, and keep the new ones."""

from __future__ import annotations

import json
import os
import platform
import sys
import time
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

from validation.page import Table
from validation.study import launch
from validation.trade import fingerprint, kept, names

_HERE = Path(__file__).parent
_PACKAGES = ("numba", "scikit-fem")
_MILLI = 1e3


def main(
    examples: Path = Path("examples"),
    only: tuple[str, ...] = (),
    question: str | None = None,
    table: bool = False,
    out: Path | None = None,
) -> Table:
    """Measure scenes (those that are kept by default) or one question of them, keep, and print the table.

    Table: of what is kept, nothing is measured; out: folder for two figures.
    """
    if not table:
        for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
            os.environ[variable] = "1"
        for name in only or names():
            keep(examples / f"{name}.toml", out, question)
    return overview()


def keep(path: Path, out: Path | None = None, question: str | None = None) -> None:
    """Measure one scene, or one question of it, and write its result beside this module.

    RuntimeError where the other questions are kept of another scene or with other versions.
    """
    from leblanc.scene.scene import load_scene
    from validation.trade.results import record_of, trade_json
    from validation.trade.trade import trade_scene

    begin = time.perf_counter()
    record = trade_scene(load_scene(path), only=question)
    if question is not None:
        before = record_of(kept(path.stem))
        now = {comparison.question: comparison for comparison in record.comparisons}
        if before.digest != record.digest:
            raise RuntimeError(f"{path.stem}: the scene has changed; measure all of its questions")
        both = tuple(now.get(comparison.question, comparison) for comparison in before.comparisons)
        record = replace(record, comparisons=both)
    found = trade_json(record)
    found["fingerprint"] = fingerprint(path)
    found["versions"] |= {"python": platform.python_version()}
    found["versions"] |= {name: metadata.version(name) for name in _PACKAGES}
    found["machine"] = (
        f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores, shared with other work"
    )
    if question is not None and found["versions"] != kept(path.stem)["versions"]:
        raise RuntimeError(f"{path.stem}: the others are kept with other versions; measure all questions")
    (_HERE / f"{path.stem}.json").write_text(json.dumps(found, indent=1) + "\n", encoding="utf-8")
    print(f"{path.stem}: {time.perf_counter() - begin:.0f} s", file=sys.stderr, flush=True)
    from leblanc.plotting.page import save_png
    from validation.trade.figure import PICTURED, trade_figure

    if out is not None and path.stem in PICTURED:
        save_png(trade_figure(record), out, f"trade_{path.stem}", "Accuracy against cost")


def overview() -> Table:
    """Default, recommended and best answers kept of each scene and question."""
    lines = []
    for name in names():
        result = kept(name)
        for question in result["questions"]:
            rows = [row for row in result["rows"] if row["question"] == question["question"]]
            lines.append(_line(name, question, rows))
    head = ("default took: error, time", "recommended: error, time", "cheapest: error, time")
    return Table(("scene", "question", "best answer (its own error)", *head), tuple(lines))


def _line(name: str, question: dict[str, Any], rows: list[dict[str, Any]]) -> tuple[str, ...]:
    default = next(row for row in rows if row["default"])
    advised = next((row for row in rows if row["recommended"]), None)
    answered = [row for row in rows if row["error"] is not None]
    cheapest = min(answered, key=lambda row: float(row["time"]))
    own = "exact" if question["reference_error"] <= 1e-11 else f"{question['reference_error']:.1e}"
    return (
        name,
        question["question"],
        f"{question['reference']} ({own})",
        f"{' + '.join(default['used'])}: {_pair(default)}",
        "undecided" if advised is None else f"{_label(advised)}: {_pair(advised)}",
        f"{_label(cheapest)}: {_pair(cheapest)}",
    )


def _label(row: dict[str, Any]) -> str:
    size = "" if row["resolution"] is None else f" {row['resolution']}"
    return f"{row['model']}{size}{', ' + row['variant'] if row['variant'] else ''}"


def _pair(row: dict[str, Any]) -> str:
    """Error and time of a row."""
    error = f"{row['error']:.1e}" if row["resolved"] else "0"
    return f"{error}, {row['time'] * _MILLI:.3g} ms"


if __name__ == "__main__":
    launch(main)
