"""`python -m validation.benchmarks`: run the benchmarks and write their numbers, tables and figures."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Literal, get_args

from validation.study import launch

Peer = Literal["pypde", "dedalus", "exponax", "pyclaw"]
PEERS: tuple[Peer, ...] = get_args(Peer)
# Before numpy, JAX or Dedalus are loaded: everybody has one thread.
_ONE = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS"), "1")
_ONE["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false intra_op_parallelism_threads=1"


def main(
    out: Path, peers: tuple[Peer, ...] = PEERS, quick: bool = False, repeats: int = 5, keep: bool = False
) -> None:
    """Run the benchmarks beside other codes into a folder.

    Quick: few settings and small sizes, seconds in all; repeats: of runs shorter than 20 s; keep: the numbers
    in the package as well.
    """
    os.environ.update(_ONE)
    from validation.benchmarks.timing import one_core

    core = one_core()
    from validation.benchmarks import report

    results = report.collect(peers, quick, 2 if quick else repeats)
    out.mkdir(parents=True, exist_ok=True)
    report.keep(results, out)
    report.write(results, out, "one core" if core is not None else "cores not held")
    if keep:
        report.keep(results)


if __name__ == "__main__":
    launch(main)
