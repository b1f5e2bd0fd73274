"""PyClaw (wave propagation of second order) on the long waves of the layer.

Its Riemann solver for these equations is `long_wave_riemann.f90`, compiled by f2py when the benchmarks run; a
numpy version of the same serves PyClaw's Python kernel. The body force enters through the f-waves, friction
by Strang splitting.
"""

from __future__ import annotations

import functools
import importlib.util
import logging
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from validation.benchmarks.leblanc_codes import LayerProblem
from validation.benchmarks.timing import Contestant, Go

CODE, PACKAGE = "PyClaw", "clawpack"
_SOURCE = Path(__file__).with_name("long_wave_riemann.f90")


def layers(problem: LayerProblem, cells: tuple[int, ...], slow: tuple[int, ...] = ()) -> list[Contestant]:
    """Classic solver, monotonised central limiter, on several grids.

    `cells` are of the Fortran kernel (where there is a compiler), `slow` of the Python kernel.
    """
    runs = []
    if shutil.which("gfortran"):
        runs += [
            Contestant(CODE, f"Fortran kernel, {n} cells", _builder(problem, n, True), size=n) for n in cells
        ]
    runs += [Contestant(CODE, f"Python kernel, {n} cells", _builder(problem, n, False), size=n) for n in slow]
    return runs


@functools.cache
def _pyclaw() -> Any:
    """PyClaw; its log file, written where the process stands, goes to a temporary folder."""
    here = Path.cwd()
    folder = tempfile.mkdtemp(prefix="leblanc-pyclaw-")
    os.chdir(folder)
    try:
        from clawpack import pyclaw
    finally:
        os.chdir(here)
    return pyclaw


@functools.cache
def _fortran() -> Any:
    """The Riemann solver as a module that PyClaw takes, built in a temporary folder."""
    folder = Path(tempfile.mkdtemp(prefix="leblanc-riemann-"))
    name = "long_wave_riemann"
    shutil.copy(_SOURCE, folder)
    command = [sys.executable, "-m", "numpy.f2py", "-c", _SOURCE.name, "-m", name, "--f90flags=-O3"]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    built = list(folder.glob(f"{name}*.so"))
    if done.returncode or not built:
        raise RuntimeError(f"f2py failed: {done.stderr[-300:]}")
    spec = importlib.util.spec_from_file_location(name, built[0])
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    shutil.rmtree(folder, ignore_errors=True)
    return module


def _roe(q_l: Any, q_r: Any, aux_l: Any, aux_r: Any, _data: Any) -> tuple[Any, Any, Any, Any]:
    """The Riemann solver of the Fortran file, for all faces at once."""
    (mass_l, flow_l, head_l, u_l), (mass_r, flow_r, head_r, u_r) = _parts(q_l, aux_l), _parts(q_r, aux_r)
    a, u = 0.5 * (q_l[0] + q_r[0]), 0.5 * (u_l + u_r)
    r2 = 1.0 - 2.0 * a
    log = -0.5 * np.log(r2)
    turning = u / r2
    swing = np.sqrt(log * log + log * (1.0 + turning) ** 2)
    s = np.stack([turning + log - swing, turning + log + swing])
    first, second = mass_r - mass_l, flow_r - flow_l + a * (head_r - head_l)
    y = a * (s - turning) / log + u - 2.0 * a
    share = (second - y[0] * first) / (y[1] - y[0])
    wave = np.empty((2, 2, a.size))
    wave[0, 0], wave[0, 1] = first - share, share
    wave[1, 0], wave[1, 1] = (first - share) * y[0], share * y[1]
    down = s < 0.0
    return wave, s, np.sum(wave * down, axis=1), np.sum(wave * ~down, axis=1)


def _parts(q: Any, aux: Any) -> tuple[Any, Any, Any, Any]:
    area = q[0]
    r2 = 1.0 - 2.0 * area
    log, u = -0.5 * np.log(r2), q[1] / area + area
    return u * log, 0.5 * u * u * (log + area / r2), area - np.sqrt(r2) * aux[0], u


def _builder(problem: LayerProblem, cells: int, compiled: bool) -> Callable[[], Callable[[], Go]]:
    def build() -> Callable[[], Go]:
        pyclaw = _pyclaw()
        for name in ("pyclaw", "pyclaw.solver", "pyclaw.controller"):
            logging.getLogger(name).setLevel(logging.ERROR)
        grid = pyclaw.Dimension(0.0, 2.0 * np.pi, cells, name="theta")

        def fresh() -> Go:
            solver = _solver(pyclaw, compiled)
            _drive(solver, problem, cells)
            state = pyclaw.State(pyclaw.Domain([grid]), 2, 1)
            state.q[0, :] = problem.area
            state.q[1, :] = -(problem.area**2)
            state.aux[0, :] = 0.0
            solution = pyclaw.Solution(state, pyclaw.Domain([grid]))
            solver.setup(solution)
            solver.dt = 0.5 * 2.0 * np.pi / cells

            def go() -> Any:
                solver.evolve_to_time(solution, problem.duration)
                return problem.in_whirl_frame(np.array(solution.state.q[0]))

            return go

        return fresh

    return build


def _solver(pyclaw: Any, compiled: bool) -> Any:
    """Second order, monotonised central limiter, Courant number 0.9."""
    solver = pyclaw.ClawSolver1D(_fortran() if compiled else _roe)
    solver.kernel_language = "Fortran" if compiled else "Python"
    solver.num_eqn, solver.num_waves, solver.fwave = 2, 2, True
    solver.limiters = pyclaw.limiters.tvd.MC
    solver.bc_lower[0] = solver.bc_upper[0] = pyclaw.BC.periodic
    solver.aux_bc_lower[0] = solver.aux_bc_upper[0] = pyclaw.BC.periodic
    solver.cfl_desired, solver.cfl_max = 0.9, 1.0
    solver.max_steps, solver.source_split = 100_000_000, 2
    return solver


def _drive(solver: Any, problem: LayerProblem, cells: int) -> None:
    """Body force at the middle of each step; friction as an exact decay of the velocity."""
    middle = 2.0 * np.pi * (np.arange(cells) + 0.5) / cells
    cosine, sine = np.cos(middle), np.sin(middle)

    def before(solver: Any, state: Any) -> None:
        force = problem.force(state.t + 0.5 * solver.dt)
        state.aux[0, :] = force.real * cosine + force.imag * sine

    def rub(_solver: Any, state: Any, dt: float) -> None:
        area = state.q[0]
        square = area * area
        rate = problem.friction * (1.0 - np.sqrt(1.0 - 2.0 * area)) / area
        state.q[1] = (state.q[1] + square) * np.exp(-rate * dt) - square

    solver.before_step = before
    if problem.friction > 0.0:
        solver.step_source = rub
