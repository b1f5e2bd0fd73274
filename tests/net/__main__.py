"""`python -m tests.net check | keep`: all commands beside their kept answers."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from tests.net.answers import Answer, read, write
from tests.net.call import use_checkout
from tests.net.cases import Case, all_cases, missing
from tests.net.compare import Difference, compare
from tests.net.scenes import shake_options
from tests.net.workers import run_all

KEPT = Path(__file__).parent / "kept"
_ACTIONS = {
    "check": "compare with what is kept",
    "keep": "write what differs anew",
    "shake": "compare the answers to inputs changed by rounding, which may use up a tenth of the tolerances",
}
_ENDING = ".json.xz"
_SHOWN = 12  # differences of one command


def main(arguments: Sequence[str] | None = None) -> int:
    """Check or keep.

    Returns
    -------
    exit code: 0 all as kept, 1 differences
    """
    asked = _parser().parse_args(arguments)
    # Before numpy is loaded: small matrices get many times slower when the BLAS spreads them over threads.
    os.environ |= dict.fromkeys(("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    os.environ["MPLBACKEND"] = "Agg"
    cases = [case for case in all_cases() if any(name in case.name for name in asked.only or [""])]
    if asked.list:
        print("\n".join(f"{case.name:28}{' '.join(case.argv)}" for case in cases))
        return 0
    skipped = {case.name: why for case in cases if (why := missing(case.needs))}
    cases = [case for case in cases if case.name not in skipped]
    began = time.perf_counter()
    with tempfile.TemporaryDirectory(prefix="net-") as scratch:
        use_checkout(Path(scratch) / "described")
        code = {"check": _check, "keep": _keep, "shake": _shake}[asked.action](cases, Path(scratch), asked)
    for name, why in skipped.items():
        print(f"skipped {name}: {why}")
    print(f"{len(cases)} commands, {len(skipped)} skipped, {time.perf_counter() - began:.0f} s")
    return code


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(prog="python -m tests.net", description=__doc__)
    parser.add_argument("action", choices=_ACTIONS, help="; ".join(f"{k}: {v}" for k, v in _ACTIONS.items()))
    parser.add_argument(
        "--only",
        nargs="+",
        action="extend",
        default=[],
        metavar="NAME",
        help="commands whose name has one of these in it",
    )
    parser.add_argument("--jobs", type=int, default=2, help="processes [default: 2]")
    parser.add_argument("--list", action="store_true", help="show the commands, run none")
    parser.add_argument("--kept", type=Path, default=KEPT, help="folder of the kept answers")
    parser.add_argument("--times", action="store_true", help="show the processor time of each command")
    return parser


def _check(cases: list[Case], scratch: Path, asked: argparse.Namespace) -> int:
    """Tell every difference."""
    differing = 0
    for case, found, seconds in run_all(cases, scratch, asked.jobs):
        differences = _differences(case, found, asked.kept)
        differing += bool(differences)
        for one in differences[:_SHOWN]:
            print(one, flush=True)
        if len(differences) > _SHOWN:
            print(f"{case.name}: {len(differences) - _SHOWN} more")
        _time(case, seconds, asked)
    if not asked.only:
        for name in _stale(asked.kept):
            differing += 1
            print(f"{name}: kept, but there is no such command")
    print(f"{differing} commands differ from what is kept" if differing else "all as kept")
    return 1 if differing else 0


def _shake(cases: list[Case], scratch: Path, asked: argparse.Namespace) -> int:
    """Tell what rounding of the inputs changes by more than a tenth of its tolerance."""
    differing = 0
    shaken = [replace(case, argv=shake_options(case.argv)) for case in cases]
    for case, found, _ in run_all(shaken, scratch, asked.jobs, shaken=True):
        for one in _differences(case, found, asked.kept, 0.1):
            if one.path.startswith("argv["):
                continue
            differing += 1
            print(one, flush=True)
    return 1 if differing else 0


def _differences(case: Case, found: Answer, kept: Path, share: float = 1.0) -> list[Difference]:
    path = _path(case.name, kept)
    if not path.is_file():
        return [Difference(case.name, "", "nothing", "an answer")]
    return compare(case.name, read(path), found, share)


def _keep(cases: list[Case], scratch: Path, asked: argparse.Namespace) -> int:
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
    return sorted({path.name.removesuffix(_ENDING) for path in kept.glob(f"*{_ENDING}")} - names)


def _path(name: str, kept: Path) -> Path:
    return kept / f"{name}{_ENDING}"


if __name__ == "__main__":
    sys.exit(main())
