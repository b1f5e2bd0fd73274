"""The path of a run-up: nothing changes by keeping it, and Newton's law holds between floor and momentum."""

from dataclasses import fields

import numpy as np

from fluid.fill import Fill
from fluid.friction.laws import Friction, FrictionLaw
from fluid.liquid import Liquid
from meshes.chamber import Chamber
from solvers.rotor.loads.bearings import bearing_forces
from solvers.rotor.loads.machine import LoadedMachine
from solvers.rotor.loads.turn import turn_extremes
from solvers.rotor.tub import Mount, Tub
from solvers.rotor.vibration import unbalance_response
from solvers.runup.linear import couple_linear
from solvers.runup.loads import bearing_impulses, path_extremes
from solvers.runup.long_wave import couple
from solvers.runup.machine import Handover, Ramp, RunupModel
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


@kills("solvers.runup.path:RotorPath.motion", "spline(time[part], order)", "spline(time[part], 0)")
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


@kills("solvers.runup.path:RotorPath._piece", "self.time >= begin", "self.time >= -np.inf")
@kills("solvers.runup.path:RotorPath.kicks", "after(time, 1) - before(time, 1)", "before(time, 1)")
@kills("solvers.runup.loads:bearing_impulses", "still, still, kicks)", "still, kicks, still)")
def test_a_blow_is_no_acceleration() -> None:
    """A motion whose velocity jumps, in closed form: its accelerations on both sides, and the impulse."""
    time, jump, kick = np.linspace(0.0, 1.0, 401), 0.5, np.array([1e-3, 2e-3, 0.0, 5e-3, 0.0, -4e-3])
    size = np.array([1.0, 2.0, 3.0, 4.0, 5.0, 6.0]) * 1e-4
    place = np.sin(20.0 * time)[:, None] * size + np.maximum(time - jump, 0.0)[:, None] * kick
    path = RotorPath(time, 20.0 * time, place, np.zeros((2, 3)), np.array([jump]))
    _, found, rate, acceleration = path.motion(time)
    # h omega = 0.05: a cubic spline's second derivative is right to 0.05^2/12, at its ends to ten times that.
    expected = -400.0 * np.sin(20.0 * time)[:, None] * size
    assert np.abs(acceleration - expected).max() < 2.5e-3 * np.abs(expected).max()
    np.testing.assert_allclose(path.kicks()[0], kick, atol=1e-6)
    np.testing.assert_allclose(found, place, atol=1e-12)
    assert np.abs(rate[200] - 20.0 * np.cos(10.0) * size - kick).max() < 1e-6
    # The tub's mass times its kick, shared by the bearings as a force is.
    machine = LoadedMachine(TUB, FILLS, bearings=(-0.05, -0.15))
    (impulse,) = bearing_impulses(machine, path)
    push = np.concatenate([TUB.tub_mass * kick[:3], np.array(TUB.tub_inertia) * kick[3:]])
    shared = np.linalg.norm(bearing_forces(TUB, (-0.05, -0.15), push), axis=-1)
    np.testing.assert_allclose(impulse, shared, rtol=1e-3)


def test_bearing_forces_go_on_through_a_release() -> None:
    """Every interval has them, and the blow is the only thing that they leave out."""
    numerics = RunupNumerics(cells=32, samples=600, companion=False, handover=Handover.RIDING)
    ramp, friction = Ramp(3.0, 20.0, 10.0, 2.0, back=True), Friction("linear", 5.0)
    history = run_up(TUB.system(), FILLS, ramp, friction, 9.81, numerics, None, couple_linear, follow=True)
    transfer = history.transfers[-1]
    assert history.path is not None and not transfer.captured
    np.testing.assert_array_equal(history.path.jumps, [each.time for each in history.transfers])
    machine = LoadedMachine(TUB, FILLS, bearings=(-0.05, -0.15))
    bearing = path_extremes(machine, history.path, history.time).bearing
    k = int(np.searchsorted(history.time, transfer.time))
    around = bearing[k - 3 : k + 4, 0]
    # A spline through the jump would make of an impulse J a force of J over two samples.
    blow = bearing_impulses(machine, history.path)[-1, 0] / (2.0 * np.diff(history.time).max())
    assert np.isfinite(bearing).all()
    # The layer pulls otherwise than liquid at rest does: the force goes on on each side.
    assert np.ptp(around[:3]) < 0.2 * blow and np.ptp(around[3:]) < 0.2 * blow


@kills(
    "solvers.runup.loads:path_extremes",
    "np.add.reduceat(moments**3, starts, axis=0) / count",
    "moments[starts]**3",
)
@kills("solvers.runup.loads:path_extremes", "axis=0) / count", "axis=0)")
def test_mean_load_of_a_path_is_that_of_its_turns() -> None:
    """A steady motion as a path: over whole turns the bearings' cubic mean is the one of `turn_extremes`."""
    machine, spin = LoadedMachine(TUB, FILLS, bearings=(-0.05, -0.15)), 40.0
    moved = unbalance_response(TUB.system(), np.array([spin]))
    time = np.linspace(0.0, 6.0 * np.pi / spin, 1537)
    placed = (moved * np.exp(1j * spin * time)[:, None]).real
    path = RotorPath(time, spin * time, placed, np.zeros((2, 3)))
    # The second and the third turn; a spline's second derivative has 1e-5 at 512 moments a turn.
    found = path_extremes(machine, path, 2.0 * np.pi / spin * np.array([1.0, 2.0])).bearing_mean
    exact = turn_extremes(machine, moved, np.array([spin])).bearing_mean
    np.testing.assert_allclose(found[1], exact[0], rtol=1e-3)
