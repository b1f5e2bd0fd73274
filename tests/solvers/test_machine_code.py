"""Machine code is kept where nobody else can write, for numba unpickles it; else it is not kept."""

from __future__ import annotations

import importlib
import inspect
import os
import re
import shutil
import stat
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numba
import pytest
from numba.core import codegen
from numba.core.registry import cpu_target

from leblanc.cli import main
from solvers import machine_code as kept
from solvers.machine_code import cache_folder, machine_code, private_folder
from tests.mutants import kills

posix = pytest.mark.skipif(os.name != "posix", reason="needs modes of folders")


@pytest.fixture(autouse=True)
def anew(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The folder is chosen once in a process, from the environment."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", "")
    cache_folder.cache_clear()
    yield
    cache_folder.cache_clear()


@pytest.fixture
def caches(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The user's own caches."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "caches"))
    return tmp_path / "caches"


def twice(number: float) -> float:
    return 2.0 * number


@pytest.mark.skipif(bool(numba.config.DISABLE_JIT), reason="nothing is compiled")
@pytest.mark.parametrize("numba_as_it_is", [True, False])
def test_parts_of_others_have_no_machine_code(
    numba_as_it_is: bool, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    """They are left to their callers, also from the cache; to a numba unknown they are not."""
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path))
    if not numba_as_it_is:
        made: Any = cpu_target.target_context.codegen()
        monkeypatch.setattr(made, "_library_class", codegen.JITCodeLibrary)

    def parts() -> Iterator[tuple[Any, float]]:
        for _ in range(2):
            part: Any = machine_code(**kept.BARE)(twice)

            def four_times(number: float, part: Any = part) -> float:
                found: float = part(part(number))
                return found

            yield part, machine_code()(four_times)(1.5)

    for reads, (part, answer) in enumerate(parts()):
        (found,) = part.overloads.values()
        assert answer == 6.0 and sum(part.stats.cache_hits.values()) == reads
        code = found.library.get_pointer_to_function(found.fndesc.llvm_func_name)
        assert (code == 0) == numba_as_it_is


@posix
def test_the_same_folder_is_found_again(caches: Path) -> None:
    folder = private_folder("machine-code-1")
    assert folder is not None and folder.parent.parent == caches
    assert stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert private_folder("machine-code-1") == folder


@posix
@pytest.mark.parametrize("how", ["open to all", "link", "file"])
def test_a_folder_of_others_is_not_taken(how: str, caches: Path, tmp_path: Path) -> None:
    folder = private_folder("machine-code-1")
    assert folder is not None
    folder.rmdir()
    if how == "open to all":
        folder.mkdir()
        folder.chmod(0o777)
    elif how == "link":
        folder.symlink_to(tmp_path)
    else:
        folder.write_bytes(b"")
    assert private_folder("machine-code-1") is None


def test_a_user_without_a_home_has_no_folder(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Without HOME, or with one that is a file, nothing is written anywhere, least of all here."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "no_folder").write_bytes(b"")
    for place in ("~/caches", str(tmp_path / "no_folder")):
        monkeypatch.setattr("platformdirs.user_cache_path", lambda *_, p=place, **__: Path(p) / "leblanc")
        cache_folder.cache_clear()
        assert cache_folder() is None
        made = machine_code()(twice)
        assert made(4.0) == 8.0 and not made.stats.cache_path
    assert [path.name for path in tmp_path.iterdir()] == ["no_folder"]


def test_each_state_of_the_sources_has_its_own_and_old_ones_go(caches: Path) -> None:
    old, used = (private_folder(f"machine-code-{k}") for k in (1, 2))
    assert old is not None and used is not None
    month = time.time() - 31 * 86400
    os.utime(old, (month, month))
    folder = cache_folder(Path(__file__))
    assert folder is not None and re.fullmatch("machine-code-[0-9a-f]{16}", folder.name)
    assert sorted(caches.joinpath("leblanc").iterdir()) == sorted([used, folder])
    made = machine_code(error_model="numpy")(twice)
    assert made(4.0) == 8.0 and list(folder.rglob("*.nbc"))
    assert numba.config.CACHE_DIR == ""  # for nobody else's functions


KERNELS = ("layer/step", "runup/steps/layer", "cycles/stretch", "statics/kernel", "rotor/exciter/tangent")


CHANGED = {  # module: whose machine code that calls into question
    "fluid/long_wave": {"layer/step", "runup/steps/layer", "cycles/stretch"},
    "fluid/friction/laws": {"layer/step", "runup/steps/layer", "cycles/stretch"},
    "solvers/runup/steps/layer": {"runup/steps/layer"},
    "solvers/statics/wall": {"statics/kernel"},
    "solvers/rotor/exciter/machine": {"rotor/exciter/tangent"},
    "solvers/machine_code": set(KERNELS),
    "fluid/lens": set(),
}


@kills("solvers.machine_code:_reached", "left += new", "left += []")
@kills("solvers.machine_code:_reached", "met, left = {source}", "met, left = set()")
@kills("solvers.machine_code:_imported", "package or module", "module")
@kills("solvers.machine_code:_imported", "(whole, *(", '("fluid", *(')
@kills("solvers.machine_code:_imported", 'f"{whole}.{name}"', "whole")
def test_a_change_of_what_a_kernel_calls_asks_for_new_machine_code(
    caches: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    root = Path(kept.__file__).parent.parent
    for package in ("meshes", "fluid", "solvers"):
        shutil.copytree(root / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    monkeypatch.setattr(kept, "_HERE", tmp_path / "solvers/machine_code.py")
    sources = {kernel: tmp_path / "solvers" / f"{kernel}.py" for kernel in KERNELS}
    for changed, kernels in CHANGED.items():
        before = {kernel: cache_folder(source) for kernel, source in sources.items()}
        with (tmp_path / f"{changed}.py").open("a") as file:
            file.write("\n")
        cache_folder.cache_clear()
        after = {kernel: cache_folder(source) for kernel, source in sources.items()}
        assert {kernel for kernel in KERNELS if after[kernel] != before[kernel]} == kernels


def test_all_that_compiled_functions_call_is_in_their_digests() -> None:
    root = Path(kept.__file__).parent.parent
    sources = [path for path in root.glob("solvers/*/**/*.py") if "machine_code import" in path.read_text()]
    assert len(sources) >= 12
    calls = 0
    for source in sources:
        module = importlib.import_module(".".join(source.relative_to(root).with_suffix("").parts))
        for function in filter(numba.extending.is_jitted, vars(module).values()):
            own = Path(inspect.getfile(function.py_func))
            called = _called(function.py_func)
            calls += len(called)
            assert called <= kept._reached(own)
    assert calls > 100


def _called(function: Any) -> set[Path]:
    """Files of the compiled functions that one names, and of those that they name."""
    met, left = {function}, [function]
    while left:
        one = left.pop()
        named = (one.__globals__.get(name) for name in one.__code__.co_names)
        new = {other.py_func for other in named if numba.extending.is_jitted(other)} - met
        met |= new
        left += new
    return {Path(inspect.getfile(one)) for one in met}


def test_the_users_own_choice_comes_first(
    caches: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(numba.config, "CACHE_DIR", str(tmp_path / "own"))
    assert cache_folder() == tmp_path / "own"
    assert machine_code()(twice)(4.0) == 8.0
    assert list((tmp_path / "own").rglob("*.nbc")) and not caches.exists()


def test_commands_say_that_nothing_is_kept(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("solvers.machine_code.private_folder", lambda name: None)
    arguments = ["volume", "--radius", "0.2", "--height", "0.05", "--eccentricity", "0.01", "--speed", "30"]
    assert main(arguments) == 0
    said = capsys.readouterr().err.splitlines()
    assert sum("compiled for this run alone" in line for line in said) == 1
    monkeypatch.undo()
    cache_folder.cache_clear()
    assert main(arguments) == 0
    assert "compiled for this run alone" not in capsys.readouterr().err
