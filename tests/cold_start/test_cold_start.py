"""Where a command's time goes: frames are put to the right call and library, shares make up the whole."""

from __future__ import annotations

import json
import sys
import sysconfig
from pathlib import Path
from types import FrameType
from typing import Any

import pytest

from tests.cold_start import child as cold_child
from tests.cold_start import start as cold_start
from tests.cold_start.start import ColdStart

SITE = sysconfig.get_paths()["purelib"]
OURS = f"{cold_start.ROOT}/{cold_child.FRONT}"


def chain(*steps: tuple[str, str]) -> FrameType:
    """Frame of the last of functions that call one another, each with its file and its name."""
    inner: Any = sys._getframe
    for file, name in reversed(steps):
        space: dict[str, Any] = {"inner": inner}
        exec(compile(f"def {name}():\n    return inner()", file, "exec"), space)
        inner = space[name]
    return inner()


def test_files_belong_to_libraries() -> None:
    assert cold_child.library(f"{SITE}/numpy/linalg/_linalg.py") == "numpy"
    assert cold_child.library(f"{SITE}/six.py") == "six"
    assert cold_child.library(f"{OURS}/cli/run.py") == cold_child.FRONT
    assert cold_child.library(json.__file__) is None and cold_child.library("<string>") is None


def test_work_belongs_to_the_innermost_library_and_to_a_call_of_the_command() -> None:
    command, write = (f"{OURS}/cli/run.py", "run"), (f"{OURS}/netcdf.py", "write")
    other, standard = (f"{SITE}/h5py/group.py", "create"), (json.__file__, "dumps")
    assert cold_child.place(chain(command, write, other), "run") == ("write", "work", "h5py")
    # What a library has the standard library do is its own work.
    assert cold_child.place(chain(command, write, other, standard), "run") == ("write", "work", "h5py")
    assert cold_child.place(chain(command, write), "run") == ("write", "work", cold_child.FRONT)
    assert cold_child.place(chain(command), "run") == (cold_child.START, "work", cold_child.FRONT)
    # The function of another command is not the one that was asked for.
    assert cold_child.place(chain(command, write), "map")[0] == cold_child.START


def test_physics_is_what_is_done_for_the_solvers() -> None:
    command, solver = (f"{OURS}/cli/run.py", "run"), (f"{cold_start.ROOT}/solvers/search.py", "search")
    other, ready = (f"{SITE}/numpy/linalg.py", "solve"), (f"{SITE}/numba/dispatcher.py", "_compile_for_args")
    assert cold_child.place(chain(command, solver), "run") == ("search", "physics", "solvers")
    assert cold_child.place(chain(command, solver, other), "run") == ("search", "physics", "numpy")
    # To get a kernel ready is no answer.
    assert cold_child.place(chain(command, solver, ready), "run") == ("search", "work", "numba")


def test_an_import_belongs_to_what_is_imported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "cold_inner.py").write_text("import cold_outer\ncold_outer.note()\n", encoding="utf-8")
    (tmp_path / "cold_outer.py").write_text("def note():\n    pass\n", encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    import cold_outer

    found: list[tuple[str, str, str]] = []
    monkeypatch.setattr(cold_outer, "note", lambda: found.append(cold_child.place(sys._getframe(), "run")))
    import cold_inner  # noqa: F401

    assert found == [(cold_child.START, "import", "cold_inner")]


def test_shares_make_up_the_whole() -> None:
    notes = {("load", "import", "pint"): 0.25, ("load", "work", "pint"): 0.25, ("draw", "work", "numpy"): 0.5}
    found = ColdStart(("run",), 4.0, 2.0, {"pint": 3}, notes)
    assert found.shares(0) == [("load", 2.0), ("draw", 2.0)]
    assert found.shares(2, where=[(1, "work")]) == [("numpy", 2.0), ("pint", 1.0)]
    assert found.shares(1, 2, where=[(0, "load")]) == [("import pint", 1.0), ("work pint", 1.0)]
    words = cold_start.text(found)
    assert "4.00 s in all" in words and "ratio 2.00" in words and "2.00 s load: import pint 1.00" in words


def test_parts_make_up_the_whole_of_what_is_kept() -> None:
    found = {one.arguments[0]: one for one in cold_start.kept()}
    assert found.keys() >= {"run", "map", "optimise", "explain", "runup"}
    for one in found.values():
        # Shares below 5e-4 are not kept; there are fewer than a hundred of them.
        assert 0.95 * one.total < sum(one.parts().values()) <= 1.001 * one.total
        assert one.parts()["physics"] == pytest.approx(one.physics)
        assert not {"pandas", "xarray", "dask", "pint"} & one.modules.keys()


def test_only_libraries_are_imported_alone() -> None:
    names = ["json", "numpy", "meshes.border", cold_child.FRONT, "scipy.optimize", "__main__"]
    assert cold_start.third_party(names) == ["numpy", "scipy.optimize"]


def test_help_is_measured() -> None:
    found = cold_start.cold_start(["--help"], repeats=1)
    assert found.modules["typer"] > 1 and "numpy" not in found.modules
    assert sum(found.notes.values()) == pytest.approx(1.0) and {key[1] for key in found.notes} <= {
        "import",
        "work",
    }


def test_a_command_that_fails_says_so() -> None:
    with pytest.raises(RuntimeError, match="no-such-scene"):
        cold_start.cold_start(["explain", "no-such-scene.toml"], repeats=1)
