"""Table of the statements, as docs/evidence.md has it: `python -m validation.cases.published.table`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from validation.command import all_cases
from validation.page import Table
from validation.study import launch


def table(cases: Sequence[Mapping[str, Any]]) -> Table:
    """Cases as `Case.to_json` has them: what a source says, what is computed, and the verdict.

    Numbers by one rule of one source share a line, with the largest of their differences.
    """
    rows, numbers = [], dict[tuple[str, str], list[Mapping[str, Any]]]()
    for case in cases:
        if isinstance(case["printed"], str):
            rows.append(
                (case["printed"], case["source"], f"{case['quantity']}: {case['computed']}", case["verdict"])
            )
            continue
        alike = numbers.setdefault((case["source"], case["origin"]["name"]), [])
        alike.append(case)
        if len(alike) == 1:
            rows.append((case["origin"]["name"], case["source"], "", case["verdict"]))
    found = []
    for statement, source, computed, verdict in rows:
        alike = numbers.get((source, statement), [])
        if alike:
            worst = max(abs(case["difference"]) for case in alike)
            what = alike[0]["quantity"].partition(",")[0]
            computed = (
                f"{what}: {len(alike)} of them, within {worst:.1%}" if worst >= 5e-4 else f"{what}: the same"
            )
        found.append((statement, f"[{source.partition(',')[0].replace('; ', '], [')}]", computed, verdict))
    return Table(("Statement", "Source", "Computed", "Verdict"), tuple(found))


def study() -> Table:
    """Table of the cases as computed now."""
    return table([case.to_json() for case in all_cases("published")])


if __name__ == "__main__":
    launch(study)
