"""Ctrl-C and SIGTERM are heard wherever the process is, and end it with the exit codes that are promised."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from leblanc.cli import exit_code
from leblanc.core.interrupts import INTERRUPTED, TERMINATED, Terminated, heard, held
from solvers.slices import compiled
from tests.mutants import kills

ROOT = Path(__file__).parents[2]

SIGNALS = {signal.SIGINT: (130, "leblanc: interrupted"), signal.SIGTERM: (143, "leblanc: terminated")}


@pytest.fixture(autouse=True)
def _hear_ctrl_c() -> Iterator[None]:
    """As in a terminal: in the background of a shell Ctrl-C is ignored, and children inherit that."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


def ended(code: str, number: int, cwd: Path) -> tuple[int, str, str]:
    """Exit code, output and complaints of a process that gets a signal once it prints a line."""
    process = subprocess.Popen(
        [sys.executable, "-c", code],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=cwd,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
    )
    assert process.stdout is not None
    first = process.stdout.readline()
    process.send_signal(number)
    out, complaints = process.communicate(timeout=120)
    return process.returncode, first + out, complaints


# A call of a library that takes a quarter of an hour and does not come back to Python in between.
DEAF = """
import sys
from leblanc.cli import exit_code
from leblanc.core.files import writing
from leblanc.core.interrupts import heard, leave
from pathlib import Path

def work():
    import numpy as np
    with writing(Path("kept.txt")) as part:
        part.write_text("half of it")
        print("begun", flush=True)
        x = np.ones((20000, 20000))
        x @ x @ x
        np.linalg.eigvals(x)
        print("done")

with heard():
    code = exit_code(work)
leave(code)
sys.exit(code)
"""


@pytest.mark.parametrize("number", SIGNALS)
def test_compiled_code_is_not_waited_for(number: int, tmp_path: Path) -> None:
    (tmp_path / "kept.txt").write_text("the old one")
    code, out, complaints = ended(DEAF, number, tmp_path)
    assert (code, complaints.splitlines()) == (SIGNALS[number][0], [SIGNALS[number][1]])
    assert out == "begun\n"
    assert [path.name for path in tmp_path.iterdir()] == ["kept.txt"]
    assert (tmp_path / "kept.txt").read_text() == "the old one"


def test_a_process_is_ended_though_nobody_reads() -> None:
    """What is to be said cannot be written: the thread that ends the process must not die of it."""
    code = "import os; from leblanc.core.interrupts import _end; os.close(2); _end(15)"
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False).returncode == 143


# The interrupt comes through `exec`, after which Python ends by the signal itself, and threads are at work.
THROUGH_EXEC = """
import sys, threading, time
from leblanc.cli import exit_code
from leblanc.core.interrupts import heard, leave

threading.Thread(target=time.sleep, args=[900.0]).start()
with heard():
    code = exit_code(lambda: exec("print('begun', flush=True)\\nimport time\\ntime.sleep(900.0)"))
leave(code)
sys.exit(code)
"""


@pytest.mark.parametrize("number", SIGNALS)
def test_the_exit_code_is_the_one_promised(number: int, tmp_path: Path) -> None:
    code, out, complaints = ended(THROUGH_EXEC, number, tmp_path)
    assert (code, out) == (SIGNALS[number][0], "begun\n")
    assert complaints.splitlines() == [SIGNALS[number][1]]


class Noisy:
    """Hears a signal while it is destroyed, where Python drops what is raised."""

    def __init__(self, number: int) -> None:
        self.number = number

    def __del__(self) -> None:
        signal.raise_signal(self.number)


@pytest.mark.parametrize(
    ("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, Terminated)]
)
def test_what_python_drops_is_raised_again(number: int, raised: type[BaseException]) -> None:
    before, given_up = signal.getsignal(number), threading.Event()
    patience = threading.Timer(20.0, given_up.set)
    patience.start()
    with pytest.raises(raised), heard():
        Noisy(number)
        given_up.wait()
        pytest.fail("dropped")
    patience.cancel()
    assert not given_up.is_set()  # it ended the wait
    assert signal.getsignal(number) is before
    assert signal.set_wakeup_fd(-1) == -1


def test_a_process_that_ignores_ctrl_c_goes_on_doing_so(monkeypatch: pytest.MonkeyPatch) -> None:
    """As what a shell starts in the background does."""
    before = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        with heard():
            signal.raise_signal(signal.SIGINT)
    finally:
        signal.signal(signal.SIGINT, before)


def test_codes_are_those_of_shells() -> None:
    assert (INTERRUPTED, TERMINATED) == (130, 143)


@pytest.mark.parametrize(
    ("number", "raised"), [(signal.SIGINT, KeyboardInterrupt), (signal.SIGTERM, Terminated)]
)
@kills("leblanc.core.interrupts:heard", "if _Holding.depth:", "if False:")
def test_what_breaks_by_an_interrupt_is_left_first(number: int, raised: type[BaseException]) -> None:
    """VTK crashes, or an import of it fails, where an interrupt is raised inside of it."""
    done = []

    @held()
    def draw() -> None:
        signal.raise_signal(number)
        done.append("inner")

    with heard():
        with pytest.raises(raised), held():
            draw()
            done.append("outer")
        done.append("after")
    assert done == ["inner", "outer", "after"]


def test_an_interrupt_that_compiled_code_hides() -> None:
    """numba says SystemError where a handler has raised while it hands over arguments; other faults stay."""

    def loop(cause: BaseException | None) -> None:
        raise SystemError("returned a result with an exception set") from cause

    for cause in (KeyboardInterrupt(), Terminated(143)):
        with pytest.raises(type(cause)):
            compiled(loop, cause)
        assert exit_code(lambda cause=cause: loop(cause)) == (143 if isinstance(cause, Terminated) else 130)
    with pytest.raises(SystemError):
        compiled(loop, None)
    with pytest.raises(ZeroDivisionError):
        exit_code(lambda: 1 // 0)
