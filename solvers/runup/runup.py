"""Rotor and liquid layers through time: run-up, run-down, hold [theory: coupling]."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fluid.fill import Fill
from fluid.friction import NO_FRICTION, Friction
from meshes.arrays import Array, Complex, Flags
from meshes.errors import InputError
from solvers.rotor.system import RotorSystem
from solvers.runup.drive import Drive, Ramp, torque_curve
from solvers.runup.linear import LinearCoupled, couple_linear, read_linear, switch_linear
from solvers.runup.long_wave import Coupled, couple, fall, reading, switch
from solvers.runup.state import (
    BORES,
    DISAGREED,
    DRIVE,
    FRICTION,
    GRAVITY,
    LAYER_STEPS,
    MOTOR,
    PROFILE,
    STEPS,
    SUPPORT,
    UNBALANCE,
)

_MOST = 200_000_000  # steps between two samples
_THROWN = _AT_AXIS, _NOT_COUPLED = 2, 4
_REASONS = {
    _AT_AXIS: "the surface of a layer came to the axis",
    3: "the time steps ran out",
    _NOT_COUPLED: "rotor and layers did not agree in the shortest steps",
    5: "the motor stands",
}


@dataclass(frozen=True)
class RunupNumerics:
    """How a run-up is resolved.

    Parameters
    ----------
    cells : finite volumes round each wall, from 8
    samples : how many times are recorded, at least 2
    dispersion : add the finite depth's dispersion to the layers [theory: long_wave, eq. 12]
    courant : Courant number of the layers; the rotor turns by at most this share of a cell in a step
    companion : run once more with half the cells, hence twice the steps, to estimate the error; from 16 cells
    """

    cells: int = 128
    samples: int = 2000
    dispersion: bool = False
    courant: float = 0.8
    companion: bool = True

    def __post_init__(self) -> None:
        if not 8 <= self.cells <= 65536:
            raise InputError("cells", self.cells, "from 8 to 65536")
        if not 2 <= self.samples <= 10_000_000:
            raise InputError("samples", self.samples, "from 2 to 10000000")
        if not 0.0 < self.courant <= 0.9:
            raise InputError("courant", self.courant, "above 0, at most 0.9")


@dataclass(frozen=True)
class EnergyAudit:
    """Where the energy went, J [theory: coupling, eq. 9-10].

    Parameters
    ----------
    unbalance, drive, gravity : work of the unbalance, of the drive on the liquid, of gravity on the liquid
    captured : energy that capture and release of the liquid brought in
    change : of the energy of rotor and liquid
    support, friction : heat in the supports and by wall friction
    bores : lost in bores and by the scheme
    profile : missed by the assumed profile of the flow while the spin changes
    motor : work of the motor, 0 for a given speed
    """

    unbalance: float
    drive: float
    gravity: float
    captured: float
    change: float
    support: float
    friction: float
    bores: float
    profile: float
    motor: float

    @property
    def remainder(self) -> float:
        """What the balance leaves, J."""
        gained = self.unbalance + self.drive + self.gravity + self.captured
        return gained - self.change - self.support - self.friction - self.bores - self.profile

    @property
    def closure(self) -> float:
        """The remainder over the larger of the unbalance's work and all that was dissipated.

        What it takes to spin the liquid up as a whole does not count.
        """
        work = max(abs(self.unbalance), self.support + self.friction + self.bores)
        return abs(self.remainder) / work if work > 0.0 else 0.0


@dataclass(frozen=True)
class RunupHistory:
    """A run-up at k times with l layers. Angles are in the drum, from its zero mark, positive with the spin.

    Parameters
    ----------
    time, speed : s and rad/s, shape (k,)
    angle : of rotation, rad, shape (k,)
    coordinates : of the rotor, from the static equilibrium, shape (k, n)
    deflection : of each chamber's axis in the standing frame, complex, m, shape (k, l); without a chamber, of
        the axis at position 0, shape (k, 1)
    offset : of each layer's centre of mass from its chamber's axis, standing frame, complex, m, shape (k, l)
    captured : the layer rides with the drum, shape (k, l)
    depth_min, depth_max : of each layer, m, shape (k, l); nan while it is not captured
    mean_rotation : of each layer relative to its drum, rad/s, shape (k, l)
    layer_mass : kg, shape (l,)
    mass_error : largest relative change of a layer's volume
    error_estimate : of the amplitude, relative to its largest: difference to the run with half the cells and
        twice the steps; nan without that run
    audit : of the energy
    steps, layer_steps : of time, and of single layers within them
    disagreement : largest relative difference left between the accelerations of rotor and layers
    converged : it came to the end
    reason : why not, or empty
    """

    time: Array
    speed: Array
    angle: Array
    coordinates: Array
    deflection: Complex
    offset: Complex
    captured: Flags
    depth_min: Array
    depth_max: Array
    mean_rotation: Array
    layer_mass: Array
    mass_error: float
    error_estimate: float
    audit: EnergyAudit
    steps: int
    layer_steps: int
    disagreement: float
    converged: bool
    reason: str

    @property
    def amplitude(self) -> Array:
        """Modulus of the first deflection, m, shape (k,)."""
        return np.abs(self.deflection[:, 0])

    @property
    def liquid_position(self) -> Complex:
        """Centre of mass of all liquid in the drum frame, from the axis at rest, m, shape (k,)."""
        if self.layer_mass.sum() == 0.0:
            return np.zeros(self.time.shape, dtype=complex)
        places = self.deflection + self.offset
        return np.asarray(places @ self.layer_mass / self.layer_mass.sum() * np.exp(-1j * self.angle))


def run_up(
    system: RotorSystem,
    fills: Sequence[Fill],
    drive: Drive,
    friction: Friction = NO_FRICTION,
    gravity: float = 0.0,
    numerics: RunupNumerics | None = None,
    progress: Callable[[float], None] | None = None,
    model: str = "long_wave",
) -> RunupHistory:
    """Run a rotor with liquid layers through its speeds; at first liquid and rotor are at rest in the drum.

    Parameters
    ----------
    system : the dry rotor
    fills : its chambers with their liquid; empty ones do nothing, full ones are a solid mass
    drive : ramp or motor
    friction : on the walls, none by default; the laminar law takes the frequency of the slower free wave
    gravity : across the axis, against the first direction, m/s^2; below its speed of capture the liquid lies
        at the bottom and moves with the drum as a mass
    numerics : resolution
    progress : called with the share of the time that is done
    model : of the liquid: "long_wave", or "linear" for small waves at a hundredth of the cost

    Returns
    -------
    RunupHistory; what was reached if it did not come to the end

    Raises
    ------
    InputError : a value out of its range
    """
    numerics = numerics or RunupNumerics()
    if model not in MODELS:
        raise InputError("model", model, "one of " + ", ".join(MODELS))
    build = MODELS[model][0]
    start = drive.corners()[1, 0]
    machine = build(system, fills, start, friction, gravity, numerics.cells, numerics.dispersion)
    share = 0.8 if numerics.companion else 1.0
    history = _march(machine, model, drive, numerics, lambda part: progress and progress(share * part))
    if not numerics.companion or not history.converged or numerics.cells < 16:
        return history
    cells = numerics.cells // 2
    coarse = build(system, fills, start, friction, gravity, cells, numerics.dispersion)
    other = _march(coarse, model, drive, replace(numerics, cells=cells), lambda _: None)
    if progress:
        progress(1.0)
    if not other.converged:
        return history
    gap = np.abs(history.amplitude - other.amplitude).max()
    largest = history.amplitude.max()
    return replace(history, error_estimate=float(gap / largest) if largest > 0.0 else 0.0)


def _times(drive: Drive, samples: int) -> tuple[Array, Array]:
    """Sampled times with all corners of the ramp among them, and the rate from each to the next."""
    corners = drive.corners()
    time = np.unique(np.concatenate((np.linspace(0.0, corners[0, -1], samples), corners[0])))
    rate = np.zeros(time.size - 1)
    if isinstance(drive, Ramp):
        slopes = np.diff(corners[1]) / np.diff(corners[0])
        middle = 0.5 * (time[:-1] + time[1:])
        rate = slopes[np.searchsorted(corners[0], middle) - 1]
    return time, rate


# Of each model: what makes its machine, what catches and lets go its liquid, what reads it.
MODELS: dict[str, tuple[Callable[..., Any], Callable[[Any], float], Callable[[Any], dict[str, Any]]]] = {
    "long_wave": (couple, switch, reading),
    "linear": (couple_linear, switch_linear, read_linear),
}


def _march(
    machine: Coupled | LinearCoupled,
    model: str,
    drive: Drive,
    numerics: RunupNumerics,
    progress: Callable[[float], object],
) -> RunupHistory:
    """The run itself, sample by sample."""
    time, rate = _times(drive, numerics.samples)
    machine.drive(torque_curve(drive), 0.0 if isinstance(drive, Ramp) else drive.inertia)
    energy, captured, reason = machine.energy(), 0.0, ""
    _, catch, read = MODELS[model]
    rows = [read(machine)]
    for k, stop in enumerate(time[1:].tolist()):
        try:
            captured += catch(machine)
            status = machine.advance(stop, float(rate[k]), numerics.courant, _MOST)
            while isinstance(machine, Coupled) and status in _THROWN and machine.held_by_spin:
                # Gravity has won: what is thrown about so much lies at the bottom.
                captured += fall(machine)
                status = machine.advance(stop, float(rate[k]), numerics.courant, _MOST)
            reason = _REASONS.get(status, "")
        except KeyboardInterrupt:
            reason = "interrupted"
        if reason:
            reason = f"{reason} at {machine.time:.6g} s, {machine.spin:.6g} rad/s"
            break
        rows.append(read(machine))
        if k % 64 == 0:
            progress((k + 1) / rate.size)
    sums = machine.sums
    audit = EnergyAudit(
        unbalance=float(sums[UNBALANCE]),
        drive=float(sums[DRIVE]),
        gravity=float(sums[GRAVITY]),
        captured=captured,
        change=machine.energy() - energy,
        support=float(sums[SUPPORT]),
        friction=float(sums[FRICTION]),
        bores=float(sums[BORES]),
        profile=float(sums[PROFILE]),
        motor=float(sums[MOTOR]),
    )
    table = {name: np.array([row[name] for row in rows]) for name in rows[0]}
    return RunupHistory(
        **table,
        layer_mass=machine.masses,
        mass_error=machine.mass_error(),
        error_estimate=math.nan,
        audit=audit,
        steps=int(sums[STEPS]),
        layer_steps=int(sums[LAYER_STEPS]),
        disagreement=float(sums[DISAGREED]),
        converged=not reason,
        reason=reason,
    )
