"""A rotor with an exact layer let go from a small push: how its whirl grows, and what ends it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fluid.fill import Fill
from fluid.liquid import known_liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.potential.coupled import Ended, ExactMachine, advance, coupled, finer, ramp, rough, shapes
from solvers.rotor.jeffcott import Jeffcott
from tests.exact_whirl.lagging import Circle, lagging_wave

# The machine: radius and height of the drum, m; natural frequency, rad/s. Nothing below depends on them.
RADIUS, HEIGHT, NATURAL = 0.1, 0.02, 100.0
# Tail of a spectrum at which nodes are doubled, and spans of the natural frequency between two looks at it.
_TAIL, _SPAN = 1e-8, 4.0
# Tolerance of a step.
_STEP = 1e-8


@dataclass(frozen=True)
class Setting:
    """A machine with one layer on round supports."""

    layer: float  #: h_0/R
    mass_ratio: float  #: mu, liquid of a full drum over the rotor's mass
    speed: float  #: Omega/omega_n
    damping: float = 0.0  #: zeta of the support
    friction: float = 0.0  #: k/omega_n of the body force on the liquid
    waves: float = 0.0  #: damping of the shortest waves, over the spin


@dataclass(frozen=True)
class Grown:
    """What became of a push."""

    setting: Setting  #: the machine
    nodes: int  #: at the end
    ended: str  #: "done", "broke", "nodes" or "dried"
    time: tuple[float, ...]  #: of the looks, over 1/omega_n
    whirl: tuple[float, ...]  #: deflection at them over h_0
    last: float  #: deflection at the end over h_0
    crest: float  #: depth there over h_0
    slope: float  #: steepest there, deg
    crest_number: float  #: B there


def machine_of(setting: Setting, nodes: int) -> ExactMachine:
    """Rotor with its exact layer of so many surface nodes."""
    volume = math.pi * RADIUS**2 * HEIGHT * setting.layer * (2.0 - setting.layer)
    fill = Fill(Chamber(RADIUS, HEIGHT), known_liquid("water"), volume)
    full = fill.liquid.density * math.pi * RADIUS**2 * HEIGHT
    mass = full / setting.mass_ratio
    rotor = Jeffcott(mass, mass * NATURAL**2, 2.0 * setting.damping * mass * NATURAL, 0.0)
    friction = [setting.friction * NATURAL]
    spin = ramp(setting.speed * NATURAL)
    return coupled(rotor.system(), [fill], spin, friction=friction, nodes=nodes, damping=setting.waves)


def standing(setting: Setting, circle: Circle, nodes: int) -> tuple[ExactMachine, Array]:
    """Machine and its state on a circle, deflected along the first direction; an even number of nodes."""
    machine, size = machine_of(setting, nodes), circle.whirl * setting.layer
    slip = 1.0 - circle.speed / circle.whirl_speed
    wave = lagging_wave(setting.layer, slip, size, setting.friction / circle.whirl_speed)
    state = machine.rest()
    parts = machine.parts(state)
    parts.place[0], parts.rate[1] = size * RADIUS, circle.whirl_speed * NATURAL * size * RADIUS
    rows = np.stack((wave.surface, (circle.whirl_speed / circle.speed - 1.0) * wave.potential))
    even = np.fft.irfft(np.fft.rfft(rows), nodes) * (nodes / wave.surface.size)
    parts.waves[0] = even.ravel()
    return machine, state


def grown(
    setting: Setting,
    push: float,
    duration: float,
    most: int,
    nodes: int = 64,
    begin: Circle | None = None,
) -> Grown:
    """Let the machine go, pushed by a deflection over h_0 with the liquid at rest, or from circle `begin`.

    Over a duration in 1/omega_n unless a wave ends it; nodes are doubled up to `most`.
    """
    machine = machine_of(setting, nodes)
    depth = setting.layer * RADIUS
    state = machine.rest()
    machine.parts(state).place[0] = push * depth
    if begin is not None:
        machine, state = standing(setting, begin, nodes)
        push = begin.whirl
    now, times, whirls, ended = 0.0, [0.0], [push], Ended.DONE
    while now < duration and ended is Ended.DONE:
        after = min(now + _SPAN, duration)
        course = advance(machine, state, (now / NATURAL, after / NATURAL), _STEP)
        wanting = rough(machine, course.state, _TAIL) or course.ended is not Ended.DONE
        if wanting and 2 * machine.nodes <= most:
            # The span again, on more nodes.
            machine, state = finer(machine, state)
            continue
        state, ended, now = course.state.copy(), course.ended, after
        if course.time.size:
            times.append(float(course.time[-1]) * NATURAL)
            whirls.append(float(np.hypot(*course.place[-1])) / depth)
    shape = shapes(machine, times[-1] / NATURAL, state)[0]
    return Grown(
        setting=setting,
        nodes=machine.nodes,
        ended=str(ended),
        time=tuple(times),
        whirl=tuple(whirls),
        last=whirls[-1],
        crest=shape.crest / setting.layer,
        slope=math.degrees(shape.slope),
        crest_number=shape.crest_number,
    )
