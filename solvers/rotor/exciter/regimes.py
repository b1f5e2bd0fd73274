"""What each ball of an exciter does in the end: at the resonance, at a third speed, or with the shaft."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from meshes.arrays import Array
from meshes.errors import InputError, require_positive
from solvers.rotor.exciter.machine import Dimensionless
from solvers.rotor.exciter.tangent import Followed, follow

# Rate of growth of a disturbance above which a motion is chaotic; regular ones have zero, off by the inverse
# of the time looked at, which is some hundreds.
CHAOTIC_GROWTH = 0.01
_AT_RESONANCE = 1.2  # ball speeds up to this belong to the resonance
_WITH_SHAFT = 1e-3  # relative difference from the shaft up to which a ball turns with it
_UNSETTLED = 2e-3  # change of a mean speed, over that of the shaft, from which a motion is not settled
# Logarithm of a growth that no regular motion has beyond that bound: it grows with the time t, log t - t/100
# being 3.6 at most.
_GROWN = 7.0
_BALANCED = 0.02  # of the vibration that the unbalance alone makes


class Place(StrEnum):
    """How fast a ball turns in the mean."""

    RESONANCE = "resonance"
    THIRD = "third"
    SHAFT = "shaft"


class Kind(StrEnum):
    """What all balls do together."""

    BALANCED = "balanced"
    WITH_SHAFT = "with the shaft"
    STUCK = "stuck"
    PART_STUCK = "part stuck"
    THIRD = "third speed"
    CHAOTIC = "chaotic"
    UNSETTLED = "unsettled"


@dataclass(frozen=True)
class Regime:
    """The last quarter of a motion, in the machine's own units; N balls."""

    #: `balanced`: all balls with the shaft, the platform at less than a fiftieth of what the unbalance alone
    #: makes; `with the shaft`: all of them, not balanced; `stuck`: all at the resonance; `part stuck`: some
    #: there, the others with the shaft; `third speed`: at least one between resonance and shaft; `chaotic`: a
    #: disturbance grows over both quarters of the second half; `unsettled`: mean speeds still change
    kind: Kind
    places: tuple[Place, ...]  #: of each ball by its mean speed
    ball_speed: Array  #: mean speed of each ball, shape (N,)
    growth: float  #: mean rate of growth of a disturbance: the largest exponent of Lyapunov
    vibration: float  #: root mean square of the platform's position
    chaos: float  #: time up to which a disturbance grew as it does in chaos, 0 if it never did
    motion: Followed  #: as followed


def decay_time(machine: Dimensionless) -> float:
    """Time in which the slower of the platform's and of a ball's free motion falls by e."""
    slowest = min(machine.smallness * machine.drag, machine.damping)
    if not slowest > 0.0:
        raise InputError("drag, damping", (machine.drag, machine.damping), "above 0")
    return 1.0 / slowest


def regime(
    machine: Dimensionless,
    speed: float,
    state: Array,
    decays: float = 18.0,
    steps: int = 24,
    samples: int = 0,
) -> Regime:
    """Final motion of the balls from a given start [theory: exciter, eq. 1].

    The run lasts `decays` times `decay_time`; `samples` of the platform's position over its last quarter.
    """
    require_positive("decays", decays)
    time = decays * decay_time(machine)
    motion = follow(machine, speed, state, time, steps=steps, samples=samples)
    blocks = motion.growth.size
    last = slice(blocks - blocks // 4, None)
    speeds = motion.ball_speed[last]
    mean = speeds.mean(axis=0)
    places = tuple(_place(float(value), speed) for value in mean)
    vibration = math.sqrt(float(motion.power[last].mean()))
    return Regime(
        kind=_kind(machine, speed, motion, places, vibration),
        places=places,
        ball_speed=mean,
        growth=float(motion.growth[last].mean()),
        vibration=vibration,
        chaos=_chaotic_up_to(motion.growth, time / blocks),
        motion=motion,
    )


def _chaotic_up_to(growth: Array, block: float) -> float:
    """Time up to which a disturbance has grown by most, beyond what the bound of chaos gives."""
    ahead = np.cumsum(growth - CHAOTIC_GROWTH) * block
    most = int(np.argmax(ahead))
    return (most + 1) * block if ahead[most] > _GROWN else 0.0


def _place(mean: float, speed: float) -> Place:
    """Where a ball of that mean speed is."""
    if abs(mean - speed) <= _WITH_SHAFT * speed:
        return Place.SHAFT
    return Place.RESONANCE if mean <= _AT_RESONANCE else Place.THIRD


def _kind(
    machine: Dimensionless, speed: float, motion: Followed, places: tuple[Place, ...], vibration: float
) -> Kind:
    """Kind of motion of the last half."""
    quarter = motion.growth.size // 4
    quarters = motion.growth[-2 * quarter :].reshape(2, -1).mean(axis=1)
    if np.all(quarters > CHAOTIC_GROWTH):
        return Kind.CHAOTIC
    halves = motion.ball_speed[-quarter:]
    early, late = halves[: quarter // 2].mean(axis=0), halves[quarter // 2 :].mean(axis=0)
    if np.any(np.abs(late - early) > _UNSETTLED * speed):
        return Kind.UNSETTLED
    if Place.THIRD in places:
        return Kind.THIRD
    if Place.SHAFT not in places:
        return Kind.STUCK
    if Place.RESONANCE in places:
        return Kind.PART_STUCK
    bare = machine.unbalance * speed**2 / abs(complex(1.0 - speed**2, 2.0 * machine.damping * speed))
    # Without unbalance, against one of a fiftieth of the balls'.
    return Kind.BALANCED if vibration <= _BALANCED * max(bare, 0.02) / math.sqrt(2.0) else Kind.WITH_SHAFT
