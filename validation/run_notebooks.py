"""`leblanc notebooks`: the notebooks that come with the package, executed; exit code 1 if one fails.

Without a name those that validate; those for users, in a folder of their own, are asked for by name.

Each runs in an empty folder, in a kernel of its own in which warnings and floating-point faults are errors.
A warning or an error of Python that is printed to the standard error fails it as well; log lines do not.
"""

from __future__ import annotations

import os
import re
import sys
import time
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated, Any

import typer

FOLDER = Path(__file__).parent / "notebooks"
FOR_USERS = (
    *("washing_machine_designed", "centrifuge_without_whirl", "machine_fitted", "uncertain_machine"),
    "own_liquid_model",
)
_SECONDS = 600  # of one cell
_NEEDED = ("jupytext", "nbclient", "ipykernel", "nbconvert")
# The page needs no script, so it asks the network for none. On paper nothing scrolls.
_PAGE = """\
{% extends "index.html.j2" %}
{% block html_head_js %}{% endblock %}
{% block html_head_js_mathjax %}{% endblock %}
{% block html_head_js_mermaidjs %}{% endblock %}
{% block html_head_css %}<style>
pre { white-space: pre-wrap !important; overflow-wrap: anywhere; }
@media screen and (max-width: 40em) {
  body { padding: 8px !important; }
  .jp-InputPrompt, .jp-OutputPrompt { display: none !important; }
  .jp-RenderedHTMLCommon code { overflow-wrap: anywhere; }
}
</style>{% endblock %}
{% block data_png %}<div class="jp-RenderedImage jp-OutputArea-output {{ extra_class }}">
<img src="data:image/png;base64,{{ output.data["image/png"] }}"
width="{{ (output | get_metadata("width", "image/png")) or "" }}"
alt="{{ ((output | get_metadata("alt", "image/png")) or "") | escape_html }}">
</div>{% endblock %}
"""
# A line of Python's own about a warning or an error. What libraries log, on a busy machine that a step took
# long, is none.
_TOLD = re.compile(
    r"^(Traceback \(most|(.*: )?[\w.]*(Warning|Error|Exception|Interrupt|Exit)\b: )", re.MULTILINE
)
# Run first in each kernel and not kept: the reader's own kernel is left as it is.
_STRICT = """\
import warnings
import numpy
warnings.simplefilter("error")
warnings.filterwarnings("default", module="ipykernel")  # what the kernel has to say of itself
numpy.seterr(divide="raise", over="raise", invalid="raise")
"""


def notebooks(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="NAME",
            help="Names of notebooks, or files in their form [default: those that validate]. For users: "
            + ", ".join(FOR_USERS)
            + ".",
        ),
    ] = None,
    out: Annotated[Path, typer.Option(help="Folder for the files.")] = Path("out/notebooks"),
    json: Annotated[bool, typer.Option("--json", help="Print one JSON object instead of words.")] = False,
) -> int:
    """Execute the notebooks that validate, or those named. As .ipynb and HTML; exit code 1 if one fails."""
    from leblanc.core.files import out_dir
    from leblanc.core.terminal import print_json, say

    chosen = [_text(name) for name in names] if names else texts()
    require_jupyter()
    folder = out_dir("notebooks", out)
    found: list[dict[str, Any]] = []
    for path in chosen:
        start = time.perf_counter()
        wrong = execute(path, folder)
        found.append({"name": path.stem, "passed": not wrong, "seconds": time.perf_counter() - start})
        if not json:
            print(f"{path.stem}: {'FAILED' if wrong else 'passed'}, {found[-1]['seconds']:.1f} s", flush=True)
        if wrong:
            say(wrong)
    if json:
        print_json({"notebooks": found})
    else:
        print(f"Pages and executed notebooks are in {folder}")
    return 0 if all(book["passed"] for book in found) else 1


def texts() -> list[Path]:
    """Files of the notebooks that validate, Python in which comments are the text, in their order."""
    return sorted(FOLDER.glob("[0-9]*.py"), key=lambda path: int(path.stem.partition("_")[0]))


def _text(name: str) -> Path:
    """File of a notebook by its name, or that file."""
    from meshes.errors import InputError

    known = {path.stem: path for path in (*texts(), *(FOLDER / "users" / f"{one}.py" for one in FOR_USERS))}
    path = known.get(name, Path(name))
    if not path.is_file():
        raise InputError("notebook", name, f"a file, or one of: {', '.join(known)}")
    return path


def require_jupyter() -> None:
    """Refuse where a library that executes notebooks is not installed."""
    from meshes.errors import InputError

    for name in _NEEDED:
        if find_spec(name) is None:
            raise InputError("notebooks", f"no {name}", "run with the extra: pip install leblanc[notebooks]")


def execute(path: Path, out: Path) -> str:
    """Execute one notebook, write it with its outputs as .ipynb and HTML; return what went wrong, or ""."""
    import jupytext
    from nbclient import NotebookClient
    from nbclient.exceptions import CellExecutionError, CellTimeoutError, DeadKernelError
    from nbformat.v4 import new_code_cell

    book: Any = jupytext.read(path, fmt="py:percent")
    book.cells.insert(0, new_code_cell(_STRICT))
    # Of the kernel's own log the errors alone.
    options = {"kernel_name": "python3", "extra_arguments": ["--log-level=ERROR"]}
    # Small matrices on one thread, modules from where this process takes them, pictures into the page.
    own = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    own["MPLBACKEND"] = "module://matplotlib_inline.backend_inline"
    modules = os.pathsep.join(str(Path(entry).absolute()) for entry in sys.path if entry)
    wrong = ""
    with TemporaryDirectory() as folder:
        client = NotebookClient(book, timeout=_SECONDS, **options)
        try:
            client.execute(cwd=folder, env=os.environ | own | {"PYTHONPATH": modules})
        except (CellExecutionError, CellTimeoutError, DeadKernelError) as error:
            wrong = str(error)
    _without_first(book)
    _describe_pictures(book)
    write_pages(book, path.stem, out)
    return wrong or _complaints(book)


def _without_first(book: Any) -> None:
    """Take the runner's own cell out and count the others from one."""
    del book.cells[0]
    for cell in book.cells:
        if cell.cell_type == "code":
            for part in (cell, *(part for part in cell.outputs if part.output_type == "execute_result")):
                part.execution_count = part.execution_count and part.execution_count - 1


def _describe_pictures(book: Any) -> None:
    """Give pictures without words for those who cannot see them the caption above, "Figure: ..."."""
    caption = ""
    for cell in book.cells:
        if cell.cell_type == "markdown":
            caption = " ".join(cell.source.rpartition("Figure: ")[2].split())
            continue
        for output in cell.outputs:
            if "image/png" in output.get("data", {}):
                output.metadata.setdefault("image/png", {}).setdefault("alt", caption)


def _complaints(book: Any) -> str:
    """What the cells wrote to the standard error, if a warning or an error of Python is in it."""
    outputs = (output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs)
    written = "".join(
        output.text for output in outputs if output.output_type == "stream" and output.name == "stderr"
    )
    return written if _TOLD.search(written) else ""


@cache
def _exporter() -> Any:
    """The writer of pages, which reads and compiles a dozen templates."""
    from nbconvert import HTMLExporter

    return HTMLExporter(raw_template=_PAGE)


def write_pages(book: Any, stem: str, out: Path) -> None:
    """Write a notebook with its outputs as .ipynb and as a page that needs nothing else."""
    import nbformat

    from leblanc.core.files import writing

    out.mkdir(parents=True, exist_ok=True)
    with writing(out / f"{stem}.ipynb") as part:
        nbformat.write(book, part)
    page, _ = _exporter().from_notebook_node(book, {"metadata": {"name": stem}})
    with writing(out / f"{stem}.html") as part:
        part.write_text(page, encoding="utf-8")
