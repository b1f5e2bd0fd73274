"""The path of a run-up: nothing changes by keeping it, and Newton's law holds between floor and momentum."""

from dataclasses import fields

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.tub import Mount, Tub
from solvers.runup.linear import couple_linear
from solvers.runup.long_wave import couple
from solvers.runup.machine import Ramp, RunupModel
from solvers.runup.path import RotorPath
from solvers.runup.runup import RunupHistory, RunupNumerics, run_up
from tests.mutants import kills

TUB = Tub(
    tub_mass=40.0,
    drum_mass=12.0,
    tub_inertia=(1.3, 1.5, 1.3),
    drum_polar_inertia=0.3,
    drum_transverse_inertia=0.2,
    drum_position=(0.0, 0.05, 0.0),
    unbalance=0.02,
    springs=tuple(Mount((x, 0.0, 0.2), along_axes=(6e3, 5e3, 8e3)) for x in (-0.2, 0.2)),
    dampers=tuple(Mount((x, 0.1, -0.2), along_axes=(90.0, 50.0, 90.0)) for x in (-0.2, 0.2)),
)
FILLS = (Fill(Chamber(0.18, 0.04, plane=0.115), Liquid("brine", 1190.0, 1.6e-6), 4e-4),)
RAMP = Ramp(start=20.0, stop=26.0, rate=2.0, duration=2.5)  # without a corner, at which forces jump


def _run(model: RunupModel, follow: bool, samples: int = 1200, cells: int = 32) -> RunupHistory:
    numerics = RunupNumerics(cells=cells, samples=samples, courant=0.4, companion=False)
    friction = Friction(FrictionLaw.STOKES)
    return run_up(TUB.system(), FILLS, RAMP, friction, 9.81, numerics, None, model, follow=follow)


def _unbalanced(history: RunupHistory) -> float:
    """What force on the cabinet and change of all momentum leave, over the force: roots of squares."""
    path = history.path
    assert path is not None
    _, place, rate, _ = path.motion(history.time)
    force, _ = LoadedMachine(TUB, FILLS).on_cabinet(place, rate)
    system = TUB.system()
    heavy = np.real(np.exp(1j * history.angle)[:, None] * system.unbalance)
    moment = (place @ system.mass.T + heavy)[:, [2, 0]]
    liquid = (history.deflection + history.offset)[:, 0] * FILLS[0].mass
    moment += np.stack([liquid.real, liquid.imag], axis=1)
    pushed = RotorPath(history.time, history.angle, moment, np.zeros((0, 3))).motion(history.time)[3]
    left = (force[:, [2, 0]] + pushed)[20:-20]  # the ends of a spline are worse by far
    return float(np.sqrt(np.square(left).mean() / np.square(force).mean()))


@kills("solvers.runup.path:RotorPath.motion", "spline(time, 1)", "spline(time)")
@kills(
    "solvers.rotor.loads.machine:LoadedMachine.holding", "rate @ (holder.damping", "-rate @ (holder.damping"
)
def test_floor_takes_the_momentum() -> None:
    """Force on the cabinet is minus the second derivative of the first moment of all masses."""
    # Splines through samples 2 ms apart leave (Omega dt)^2/12, 2e-4; a step turns the drum by 0.08 and leaves
    # 0.08^2/12, 5e-4.
    assert _unbalanced(_run(couple_linear, follow=True)) < 1e-3


def test_floor_takes_the_momentum_of_long_waves() -> None:
    """The same to what the cells leave of the layer's momentum, a share that falls with them."""
    coarse, fine = (_unbalanced(_run(couple, follow=True, cells=cells)) for cells in (32, 64))
    # The layer has a hundredth of the mass; of its momentum 32 cells know less than all.
    assert coarse < 1e-2
    assert fine < 0.75 * coarse


def test_nothing_changes_by_watching() -> None:
    """Every number of the history is the same to the last bit."""
    for model in (couple_linear, couple):
        plain, followed = _run(model, False, 100), _run(model, True, 100)
        for field in fields(plain):
            value = getattr(plain, field.name)
            if isinstance(value, np.ndarray):
                np.testing.assert_array_equal(value, getattr(followed, field.name))
        assert plain.path is None
        assert followed.path is not None
        # Of works only those since the beginning: the last sample has them all.
        np.testing.assert_array_equal(
            followed.path.work[-1], [plain.audit.unbalance, plain.audit.drive, plain.audit.motor]
        )


def test_path_is_even_and_whole() -> None:
    """It has the last moment, and no two moments are as close as steps can be."""
    history = _run(couple, True, 100)
    path = history.path
    assert path is not None
    assert path.time[0] == 0.0
    assert path.time[-1] == history.time[-1]
    gaps = np.diff(path.time)
    # No two are closer than 0.3 of a part of the phase but the last one, and no gap is longer than two parts.
    assert gaps[:-1].min() > 0.1 * gaps.max()
    _, place, _, _ = path.motion(history.time)
    # h^4/384 of the fourth derivative: a part is 2 pi/128 of a turn; far below what the scheme leaves.
    assert np.abs(place - history.coordinates).max() < 1e-5 * np.abs(history.coordinates).max()
