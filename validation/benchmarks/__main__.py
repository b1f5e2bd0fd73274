"""`python -m validation.benchmarks`: run the benchmarks and write their numbers, tables and figures."""

from __future__ import annotations

import argparse
import json
import os
from dataclasses import asdict
from pathlib import Path

PEERS = ("pypde", "dedalus", "exponax", "pyclaw")
# Before numpy, JAX or Dedalus are loaded: everybody has one thread.
_ONE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
_ONE["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"


def main(arguments: list[str] | None = None) -> int:
    """Run the benchmarks.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code
    """
    parser = argparse.ArgumentParser(prog="python -m validation.benchmarks", description=__doc__)
    parser.add_argument("--peers", nargs="*", choices=PEERS, default=PEERS, help="other codes [default: all]")
    parser.add_argument("--quick", action="store_true", help="few settings and small sizes, seconds in all")
    parser.add_argument(
        "--out", type=Path, required=True, help="folder for results.json, benchmarks.md, figures"
    )
    parser.add_argument("--repeats", type=int, default=5, help="of runs shorter than 20 s [default: 5]")
    parser.add_argument("--keep", action="store_true", help="keep the numbers in the package as well")
    chosen = parser.parse_args(arguments)
    os.environ.update(_ONE)
    from validation.benchmarks.timing import one_core

    core = one_core()
    from validation.benchmarks.report import collect, write

    results = collect(tuple(chosen.peers), chosen.quick, 2 if chosen.quick else chosen.repeats)
    chosen.out.mkdir(parents=True, exist_ok=True)
    (chosen.out / "results.json").write_text(json.dumps(asdict(results), indent=1) + "\n", encoding="utf-8")
    write(results, chosen.out, "one core" if core is not None else "cores not held")
    if chosen.keep:
        from validation.benchmarks.report import keep

        keep(results)
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
