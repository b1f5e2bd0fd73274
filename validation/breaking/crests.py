"""The crest of a wave at its resonance until it breaks and a little beyond: its shape, kept as JSON.

`python -m tests.breaking` computes it again; `kept` reads what it left. Lengths are over R, times in
1/Omega.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fluid.fill import Fill
from fluid.liquid import Liquid
from meshes.arrays import Array
from meshes.chamber import Chamber
from solvers.liquid_model import Whirl
from solvers.potential.histories import whirl_push
from solvers.potential.in_time import BREAKING, Steps, course
from solvers.potential.steady import linear_detuning
from solvers.potential.unsteady import node_angles, seen, still
from validation.study import stored

KEPT = Path(__file__).parent / "crests.json"
# Layer and whirl over it, nodes at most, and moments, the last of which no number of nodes reaches.
LAYER, SHARE = 0.1, 0.05
MOST = (2048, 4096, 8192)
TIMES = (60.0, 64.0, 65.0, 66.0, 66.5, 67.0)
# Whirl periods over which the whirl grows, and damping of the shortest waves.
RAMP, DAMPING = 0.9, 2.0
FIRST = 128
# Angles of a profile, and how they crowd at the crest.
_ANGLES, _CROWDED = 401, 5.0
_PLACES = 6  # decimals of a depth over R, which no picture shows


@dataclass(frozen=True)
class Crest:
    """A wave with its highest crest at a moment."""

    most: int  #: nodes that it may have
    time: float  #: of the moment
    nodes: int  #: that it has
    state: str  #: what is known of it, and why it is broken
    reason: str
    crest: float  #: greatest depth over h_0
    crest_number: float  #: speed of the liquid at the crest over that of the crest
    slope: float  #: steepest, deg
    drift: float  #: relative change of the volume
    tail: float  #: of the spectrum
    place: float  #: angle of the crest in the drum, rad
    depth: tuple[float, ...]  #: over R at `angles` from the crest


def angles() -> Array:
    """Angles from the crest at which depths are kept, closest at the crest, rad, from -pi to pi."""
    even = np.linspace(-1.0, 1.0, _ANGLES)
    return np.asarray(math.pi * np.sinh(_CROWDED * even) / math.sinh(_CROWDED))


def resonant(layer: float, share: float) -> tuple[Fill, Whirl]:
    """Layer h_0/R, and a whirl w_0/h_0 = share as fast as its small backward natural wave.

    Lengths are over R, times in 1/Omega.
    """
    p = math.sqrt(linear_detuning(layer))
    fill = Fill(Chamber(1.0, 1.0), Liquid("water", 1000.0, 1e-6), math.pi * layer * (2.0 - layer))
    slip = -p / (1.0 + p)
    return fill, Whirl(1.0, 1.0 + slip, share * layer, RAMP * 2.0 * math.pi / abs(slip))


def followed(most: int, times: Sequence[float] = TIMES, breaking: float = BREAKING) -> list[Crest]:
    """Wave from rest through rising moments, the last one where it is broken, with `most` nodes at most.

    `breaking`: crest number from which it may be broken; infinite to follow it as far as its nodes do.
    """
    fill, whirl = resonant(LAYER, SHARE)
    steps = Steps(FIRST, most, DAMPING, breaking=breaking)
    moments = course(still(LAYER, FIRST), np.array(times), whirl_push(fill, whirl), steps)
    found = []
    for moment in moments:
        state, shape = moment.surface.state, moment.extremes
        highest = int(np.argmax(moment.surface.height))
        place = float(node_angles(state)[highest])
        depth = 1.0 - seen(state, place + angles())[0]
        found.append(
            Crest(
                most=most,
                time=moment.time,
                nodes=moment.surface.height.size,
                state=moment.state.value,
                reason=moment.reason,
                crest=shape.crest / LAYER,
                crest_number=shape.crest_number,
                slope=math.degrees(shape.slope),
                drift=shape.drift,
                tail=shape.tail,
                place=place,
                depth=tuple(np.round(depth, _PLACES).tolist()),
            )
        )
    return found


kept, keep = stored(KEPT, tuple[Crest, ...], compact=True)


def computed() -> tuple[Crest, ...]:
    """All that is kept, in a minute."""
    return tuple(row for most in MOST for row in followed(most, breaking=math.inf))
