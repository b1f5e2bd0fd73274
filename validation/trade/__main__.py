"""`python -m validation.trade`: measure the scenes whose results are kept again, and keep the new ones."""

from __future__ import annotations

import argparse
import json
import os
import platform
import sys
import time
from dataclasses import replace
from importlib import metadata
from pathlib import Path
from typing import Any

from validation.trade import fingerprint, kept, names

_HERE = Path(__file__).parent
_PICTURED = ("runup", "horizontal_rig")
_PACKAGES = ("numba", "scikit-fem")
_MILLI = 1e3


def main(arguments: list[str] | None = None) -> int:
    """Measure, keep, print the table.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code
    """
    parser = argparse.ArgumentParser(prog="python -m validation.trade", description=__doc__)
    parser.add_argument("--examples", type=Path, default=Path("examples"), help="folder of the scenes")
    parser.add_argument("--only", nargs="*", help="stems of scenes [default: those that are kept]")
    parser.add_argument("--question", help="measure this one alone; the others stay as they are kept")
    parser.add_argument(
        "--table", action="store_true", help="print the table of what is kept, measure nothing"
    )
    parser.add_argument("--out", type=Path, help="folder for two figures")
    chosen = parser.parse_args(arguments)
    if not chosen.table:
        for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
            os.environ[variable] = "1"
        for name in chosen.only or names():
            keep(chosen.examples / f"{name}.toml", chosen.out, chosen.question)
    print("\n".join(table()))
    return 0


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
    if out is not None and path.stem in _PICTURED:
        from leblanc.figures.drawing.page import save_png
        from validation.trade.figure import trade_figure

        save_png(trade_figure(record), out, f"trade_{path.stem}", "Accuracy against cost")


def table() -> list[str]:
    """What is kept, as a table in Markdown: default, recommended and best of each scene and question."""
    lines = [
        "| scene | question | best answer (its own error) | default took: error, time "
        "| recommended: error, time | cheapest: error, time |",
        "|---|---|---|---|---|---|",
    ]
    for name in names():
        result = kept(name)
        for question in result["questions"]:
            rows = [row for row in result["rows"] if row["question"] == question["question"]]
            lines.append(_line(name, question, rows))
    return lines


def _line(name: str, question: dict[str, Any], rows: list[dict[str, Any]]) -> str:
    default = next(row for row in rows if row["default"])
    advised = next((row for row in rows if row["recommended"]), None)
    answered = [row for row in rows if row["error"] is not None]
    cheapest = min(answered, key=lambda row: float(row["time"]))
    own = "exact" if question["reference_error"] <= 1e-11 else f"{question['reference_error']:.1e}"
    cells = [
        name,
        question["question"],
        f"{question['reference']} ({own})",
        f"{' + '.join(default['used'])}: {_pair(default)}",
        "undecided" if advised is None else f"{_label(advised)}: {_pair(advised)}",
        f"{_label(cheapest)}: {_pair(cheapest)}",
    ]
    return "| " + " | ".join(cells) + " |"


def _label(row: dict[str, Any]) -> str:
    size = "" if row["resolution"] is None else f" {row['resolution']}"
    return f"{row['model']}{size}{', ' + row['variant'] if row['variant'] else ''}"


def _pair(row: dict[str, Any]) -> str:
    """Error and time of a row."""
    error = f"{row['error']:.1e}" if row["resolved"] else "0"
    return f"{error}, {row['time'] * _MILLI:.3g} ms"


if __name__ == "__main__":
    raise SystemExit(main())
