"""Execute the notebooks: `python -m validation.run_notebooks --out out/notebooks`, exit code 1 if one fails.

Each runs in a kernel of its own in which warnings and floating-point faults are errors; what is printed to
the standard error fails it as well. Executed notebooks and HTML pages go to the folder; the text is kept.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

FOLDER = Path(__file__).parent / "notebooks"
_SECONDS = 600  # of one cell
# On paper nothing scrolls.
_PRINT = "<style>pre { white-space: pre-wrap !important; overflow-wrap: anywhere; }</style></head>"
# Run first in each kernel and not kept: the reader's own kernel is left as it is.
_STRICT = """\
import warnings
import numpy
warnings.simplefilter("error")
warnings.filterwarnings("default", module="ipykernel")  # what the kernel has to say of itself
numpy.seterr(divide="raise", over="raise", invalid="raise")
"""


def texts(folder: Path = FOLDER) -> list[Path]:
    """The notebooks in their order.

    Parameters
    ----------
    folder : where they are
    """
    return sorted(folder.glob("[0-9]*.py"))


def execute(path: Path, out: Path) -> str:
    """Execute one notebook and write it, with its outputs, as .ipynb and HTML.

    Parameters
    ----------
    path : the text
    out : folder for both files, made if it is missing

    Returns
    -------
    What went wrong; empty if nothing did
    """
    import jupytext
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
    from nbformat.v4 import new_code_cell

    book: Any = jupytext.read(path, fmt="py:percent")
    book.cells.insert(0, new_code_cell(_STRICT))
    resources = {"metadata": {"path": str(path.parent)}}
    # Of the kernel's own log the errors alone.
    options = {"kernel_name": "python3", "extra_arguments": ["--log-level=ERROR"]}
    client = NotebookClient(book, timeout=_SECONDS, resources=resources, **options)
    wrong = ""
    try:
        client.execute()
    except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
        wrong = str(error)
    _without_first(book)
    _write(book, path.stem, out)
    return wrong or _complaints(book)


def _without_first(book: Any) -> None:
    """Take the runner's own cell out and count the others from one."""
    del book.cells[0]
    for cell in book.cells:
        if cell.cell_type == "code":
            for part in (cell, *(part for part in cell.outputs if part.output_type == "execute_result")):
                part.execution_count = part.execution_count and part.execution_count - 1


def _complaints(book: Any) -> str:
    """What the cells wrote to the standard error."""
    outputs = (output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs)
    return "".join(
        output.text for output in outputs if output.output_type == "stream" and output.name == "stderr"
    )


def _write(book: Any, stem: str, out: Path) -> None:
    import nbformat
    from nbconvert import HTMLExporter

    out.mkdir(parents=True, exist_ok=True)
    nbformat.write(book, out / f"{stem}.ipynb")
    page, _ = HTMLExporter().from_notebook_node(book, {"metadata": {"name": stem}})
    page = page.replace("</head>", _PRINT, 1)
    (out / f"{stem}.html").write_text(page, encoding="utf-8")


def main(arguments: Sequence[str] | None = None) -> int:
    """Execute all notebooks or some.

    Parameters
    ----------
    arguments : of the command line; None: the process's own

    Returns
    -------
    Exit code, 1 if a notebook failed
    """
    parser = argparse.ArgumentParser(prog="python -m validation.run_notebooks", description=__doc__)
    parser.add_argument("notebooks", type=Path, nargs="*", help="texts of notebooks [default: all]")
    parser.add_argument("--out", type=Path, default=Path("out/notebooks"), help="folder of what is written")
    chosen = parser.parse_args(arguments)
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
        os.environ[variable] = "1"
    failed, begin = 0, time.perf_counter()
    for path in chosen.notebooks or texts():
        start = time.perf_counter()
        wrong = execute(path, chosen.out)
        took = f"{time.perf_counter() - start:.1f} s"
        print(f"{path.stem}: {'FAILED' if wrong else 'passed'}, {took}", flush=True)
        if wrong:
            failed += 1
            print(wrong, file=sys.stderr, flush=True)
    print(f"all: {time.perf_counter() - begin:.1f} s")
    return 1 if failed else 0


if __name__ == "__main__":
    raise SystemExit(main())
