"""`python -m tests.net check | keep`: all commands beside their kept answers."""

from __future__ import annotations

import os

# Before numpy is loaded: small matrices get many times slower when the BLAS spreads them over threads.
for _variable in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[_variable] = "1"
os.environ["MPLBACKEND"] = "Agg"

import argparse
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path

from tests.compiled import use_own_cache
from tests.net.answers import read, write
from tests.net.call import use_checkout
from tests.net.cases import Case, all_cases, missing
from tests.net.compare import Difference, compare
from tests.net.workers import run_all

KEPT = Path(__file__).parent / "kept"
_SHOWN = 12  # differences of one command


def main(arguments: Sequence[str] | None = None) -> int:
    """Check or keep.

    Returns
    -------
    exit code: 0 all as kept, 1 differences
    """
    asked = _parser().parse_args(arguments)
    use_own_cache()
    cases = [case for case in all_cases() if asked.only in case.name]
    if asked.list:
        print("\n".join(f"{case.name:28}{' '.join(case.argv)}" for case in cases))
        return 0
    skipped = {case.name: why for case in cases if (why := missing(case.needs))}
    cases = [case for case in cases if case.name not in skipped]
    began = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="net-") as scratch:
        use_checkout(Path(scratch) / "described")
        told = _keep if asked.action == "keep" else _check
        code = told(cases, skipped, Path(scratch), asked)
    for name, why in skipped.items():
        print(f"skipped {name}: {why}")
    print(f"{len(cases)} commands, {len(skipped)} skipped, {time.perf_counter() - began:.0f} s")
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.net", description=__doc__)
    parser.add_argument("action", choices=("check", "keep"), help="compare with what is kept, or keep anew")
    parser.add_argument("--only", default="", metavar="NAME", help="commands whose name has this in it")
    parser.add_argument("--jobs", type=int, default=2, help="processes [default: 2]")
    parser.add_argument("--list", action="store_true", help="show the commands, run none")
    parser.add_argument("--kept", type=Path, default=KEPT, help="folder of the kept answers")
    parser.add_argument("--times", action="store_true", help="show the processor time of each command")
    return parser


def _check(cases: list[Case], skipped: dict[str, str], scratch: Path, asked: argparse.Namespace) -> int:
    """Tell every difference."""
    differing = 0
    for case, found, seconds in run_all(cases, scratch, asked.jobs):
        differences = _differences(case, found, asked.kept)
        differing += bool(differences)
        for one in differences[:_SHOWN]:
            print(one)
        if len(differences) > _SHOWN:
            print(f"{case.name}: {len(differences) - _SHOWN} more")
        _time(case, seconds, asked)
    if not asked.only:
        for name in _stale(asked.kept):
            differing += 1
            print(f"{name}: kept, but there is no such command")
    print(f"{differing} commands differ from what is kept" if differing else "all as kept")
    return 1 if differing else 0


def _differences(case: Case, found: dict, kept: Path) -> list[Difference]:
    path = _path(case.name, kept)
    if not path.is_file():
        return [Difference(case.name, "", "nothing", "an answer")]
    return compare(case.name, read(path), found)


def _keep(cases: list[Case], skipped: dict[str, str], scratch: Path, asked: argparse.Namespace) -> int:
    """Write what differs from the kept answers; what is within the tolerances stays, byte for byte."""
    for case, found, seconds in run_all(cases, scratch, asked.jobs):
        if _differences(case, found, asked.kept):
            write(_path(case.name, asked.kept), found)
            print(f"kept {case.name}")
        _time(case, seconds, asked)
    if not asked.only:
        for name in _stale(asked.kept):
            _path(name, asked.kept).unlink()
            print(f"dropped {name}")
    return 0


def _time(case: Case, seconds: float, asked: argparse.Namespace) -> None:
    if asked.times:
        print(f"{seconds:7.2f} s {case.name}", file=sys.stderr)


def _stale(kept: Path) -> list[str]:
    """Kept answers without a command."""
    names = {case.name for case in all_cases()}
    return sorted(name for p in kept.glob("*.json.xz") if (name := p.name.removesuffix(".json.xz")) not in names)


def _path(name: str, kept: Path) -> Path:
    return kept / f"{name}.json.xz"


if __name__ == "__main__":
    sys.exit(main())
